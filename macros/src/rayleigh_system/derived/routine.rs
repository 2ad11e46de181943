//! A routine: a function of one of the traits as data.

use super::*;

/// A function of one of the runtime's traits.
pub struct Routine {
    pub of: Of,
    /// The type that it is a function of.
    pub home: Home,
    pub kind: Kind,
    /// The values that it computes, in the order that [`Of`] names them in.
    pub outputs: Vec<Node>,
}

/// The numbers that a function computes with.
pub enum Kind {
    Numbers,
    /// Numbers, by the functions of members, so that both compute the same.
    NumbersAsMembers,
    /// Numbers over `Real<D>`, as are q, v, u and the time; fields and constants are lifted.
    Duals,
    /// Lanes, as are q, v and the time; the parameters `late` are known only after the statements that do not
    /// need them. Sines, cosines and these reciprocals start from those of the sweep before.
    Lanes {
        late: Vec<Node>,
        reciprocals: Vec<Node>,
    },
    /// Numbers of several members, as are q, v and what is made of fields alone; and what is handed over,
    /// which is not computed again.
    Members {
        handed: Vec<Node>,
        reciprocals: Option<Vec<Node>>,
    },
}

/// The values of a function: vectors by entry, matrices column by column.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Of {
    /// f, ∂f/∂q and ∂f/∂v of L or R.
    Gradient(Part),
    /// [`Gradient`](Self::Gradient), and the blocks qq, qv and vv of the Hessian.
    Derivatives(Part),
    /// ∂L along two directions, and the second derivative along both.
    Variations,
    /// f, ∂f/∂q and ∂f/∂v of the force.
    ForceDerivatives,
    /// σ and ∇σ.
    TimeScaleGradient,
    /// g and G, of all rows.
    ConstraintGradients,
    /// The rounding of g, over ε.
    ConstraintRounding,
    /// ρ and ∂ρ/∂q.
    ConstraintRates,
    /// ∂(Gᵀλ)/∂q.
    ConstraintCurvature,
    /// ∂g/∂θ, ∂ρ/∂θ and ∂(Gᵀλ)/∂θ.
    ConstraintsByParameters,
    /// u, ∂u/∂v, ∂u/∂q and F of the kinks of R.
    Slips,
    /// ∂/∂q of Σ F s·∂u/∂v.
    SlipCurvature,
    /// ∂u/∂θ, and ∂/∂θ of Σ F s·∂u/∂v.
    SlipsByParameters,
    /// R without its kinks, as [`Derivatives`](Self::Derivatives).
    SmoothRayleigh,
    /// ∂f/∂u.
    ForceByInput,
    /// ∂²/∂q∂θ and ∂²/∂v∂θ of L or R, ∂f/∂θ.
    ByParameters(Part),
    /// Blocks qq, qv and vv of the Hessian of a·∂/∂q + b·∂/∂v of L or R; of a covector's product with f, with
    /// columns of those by (q, v, u) and each entry of u.
    Along(Part),
    /// Sizes of terms in ∂L/∂v and in G.
    CancellingTerms,
    /// Arguments of operations that have no derivative at some of them, in L, R, a component of f or a
    /// constraint.
    Arguments(Part),
    /// p0, and the entries that the form of ∂p0/∂v̄ keeps.
    StepKernel(Points),
    /// p0 and p1.
    Momenta(Points),
    /// The entries that the form of ∂p0/∂v̄ keeps.
    StepMatrix,
    /// The shares of v̄ in p0 and p1.
    VelocityMomenta,
    /// ∂L/∂q + f.
    ConfigurationForce,
    /// G, residuals and corrections at a stage.
    Stages,
    /// G, and the nodes handed to [`Corrections`](Self::Corrections).
    Rates,
    /// Residuals and corrections.
    Corrections,
}

impl Of {
    /// The parameters and what is declared of them; what is computed has none of these names.
    pub fn arguments(self, kind: &Kind) -> &'static [&'static str] {
        let of_members = !matches!(kind, Kind::Numbers);
        match self {
            Self::StepKernel(_) | Self::Momenta(_) if of_members => {
                &["q", "q0", "v", "h", "half", "fields", "systems"]
            }
            Self::VelocityMomenta | Self::ConfigurationForce if of_members => {
                &["q", "v", "h", "half", "fields", "systems"]
            }
            Self::Stages => &["q", "v", "p", "rate", "momenta", "anchors", "angles", "reciprocals"],
            Self::Rates | Self::Corrections => {
                &["q", "v", "p", "kept", "fields", "systems", "anchors", "angles", "reciprocals"]
            }
            Self::Along(Part::Force) => &["q", "v", "h", "half", "q0", "q1", "minus", "plus", "vector"],
            Self::ConstraintCurvature | Self::ConstraintsByParameters => {
                &["q", "v", "h", "half", "q0", "q1", "minus", "plus", "lambda"]
            }
            Self::SlipCurvature | Self::SlipsByParameters => {
                &["q", "v", "h", "half", "q0", "q1", "minus", "plus", "forces"]
            }
            Self::Along(_) => &["q", "v", "h", "half", "q0", "q1", "minus", "plus", "a", "b"],
            _ => &["q", "v", "h", "half", "q0", "q1", "minus", "plus"],
        }
    }
}
