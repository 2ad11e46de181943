//! The rules of discretisation. One entry holds all that the macro knows of a rule; the others read it.

use quote::format_ident;
use syn::Ident;

/// The rules that the attribute lists.
#[derive(Clone, Default)]
pub struct Rules {
    /// Rules that the system implements, those of `joint` among them.
    pub of_displacement: Vec<Rule>,
    /// Rules of `of_displacement` that take L and R together, each with its word in the attribute.
    pub joint: Vec<(Ident, Rule)>,
    /// The word of the rule that takes kinks of R apart, if it is listed.
    pub proximal: Option<Ident>,
    /// The words of the rules that do not.
    pub others: Vec<Ident>,
    /// Whether the rules of Gauss are listed, which the runtime implements for every forced Lagrangian.
    pub gauss: bool,
}

impl Rules {
    /// Whether one asks for the sizes of terms that cancel.
    pub fn ask_for_cancelling_terms(&self) -> bool {
        self.gauss || self.of_displacement.iter().any(|rule| rule.asks_for_cancelling_terms())
    }

    /// Whether one asks for derivatives of L along its directions; other kernels have them folded in.
    pub fn ask_for_variations(&self) -> bool {
        let asks = |rule: &Rule| rule.joint().is_some_and(|joint| joint.asks_for_variations);
        self.of_displacement.iter().any(asks)
    }
}

/// The word for the rules of Gauss in the attribute.
pub const GAUSS: &str = "gauss";

/// A rule that the macro implements for the system; the rules of Gauss are the runtime's alone.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Rule {
    Midpoint,
    Trapezoidal,
    Fitted,
    FittedTrapezoidal,
    OneSided,
    Proximal,
}

/// All that the macro knows of a rule.
pub struct Entry {
    /// Its word in the attribute.
    pub word: &'static str,
    /// Its type in the runtime.
    pub name: &'static str,
    /// Where it sees forces.
    pub points: Points,
    /// Which second derivatives its Newton matrix holds.
    pub matrix: Pairs,
    pub terms: Terms,
    /// Whether a step back is the step of −h, which compositions rest on.
    pub is_self_adjoint: bool,
}

/// Where a rule sees the forces on a segment.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Points {
    Middle,
    Ends,
}

/// Pairs of variables, each a coordinate or a velocity.
#[derive(Clone, Copy)]
pub enum Pairs {
    All,
    /// At least one is a velocity.
    WithVelocity,
    /// Both are velocities.
    Velocities,
}

impl Pairs {
    /// Whether the pair is one of them, told by which of its variables are velocities.
    pub fn hold(self, a: bool, b: bool) -> bool {
        match self {
            Self::All => true,
            Self::WithVelocity => a || b,
            Self::Velocities => a && b,
        }
    }
}

/// How a rule takes L, R and f.
pub enum Terms {
    /// A term for each, which an engine may fuse into one kernel.
    Separate {
        /// Whether a step may need the force at one point only.
        may_be_explicit: bool,
    },
    /// L and R in one, by the functions of the runtime's `JointRule`.
    Joint(Joint),
}

/// A rule that takes L and R together: what it asks of the system, and what its steps are made with.
#[derive(Clone, Copy)]
pub struct Joint {
    /// Whether it is fitted to free damped motion: it needs constant mass and damping matrices, and a
    /// function of M⁻¹C is full.
    pub is_fitted: bool,
    pub asks_for_variations: bool,
    /// The type of the runtime that holds its steps.
    pub border: &'static str,
    /// Whether one correction solves its step.
    pub is_linear: bool,
    /// The type of the runtime that a run keeps from step to step.
    pub memory: &'static str,
}

impl Rule {
    /// In the order in which messages name them.
    pub const ALL: [Self; 6] = [
        Self::Midpoint,
        Self::Trapezoidal,
        Self::Fitted,
        Self::FittedTrapezoidal,
        Self::OneSided,
        Self::Proximal,
    ];

    /// The rule of that word in the attribute.
    pub fn named(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|rule| rule.entry().word == word)
    }

    /// All that is known of it.
    pub fn entry(self) -> Entry {
        match self {
            Self::Midpoint => Entry {
                word: "midpoint",
                name: "Midpoint",
                points: Points::Middle,
                matrix: Pairs::All,
                terms: Terms::Separate { may_be_explicit: false },
                is_self_adjoint: true,
            },
            Self::Trapezoidal => Entry {
                word: "trapezoidal",
                name: "Trapezoidal",
                points: Points::Ends,
                matrix: Pairs::WithVelocity,
                terms: Terms::Separate { may_be_explicit: true },
                is_self_adjoint: true,
            },
            Self::Fitted => Entry {
                word: "fitted",
                name: "Fitted",
                points: Points::Middle,
                matrix: Pairs::All,
                terms: Terms::Joint(Joint {
                    is_fitted: true,
                    asks_for_variations: false,
                    border: "Free",
                    is_linear: false,
                    memory: "DriftMemory",
                }),
                is_self_adjoint: true,
            },
            Self::FittedTrapezoidal => Entry {
                word: "fitted_trapezoidal",
                name: "FittedTrapezoidal",
                points: Points::Ends,
                matrix: Pairs::Velocities,
                terms: Terms::Joint(Joint {
                    is_fitted: true,
                    asks_for_variations: false,
                    border: "Free",
                    // With a constant matrix and the potential at the ends.
                    is_linear: true,
                    memory: "ExplicitDriftMemory",
                }),
                is_self_adjoint: true,
            },
            Self::OneSided => Entry {
                word: "one_sided",
                name: "OneSided",
                points: Points::Middle,
                matrix: Pairs::All,
                terms: Terms::Joint(Joint {
                    is_fitted: false,
                    asks_for_variations: true,
                    border: "BothEnds",
                    is_linear: false,
                    memory: "VelocityHistory",
                }),
                is_self_adjoint: false,
            },
            Self::Proximal => Entry {
                word: "proximal",
                name: "Proximal",
                points: Points::Middle,
                matrix: Pairs::All,
                terms: Terms::Separate { may_be_explicit: false },
                is_self_adjoint: false,
            },
        }
    }

    /// Its type in the runtime.
    pub fn ident(self) -> Ident {
        format_ident!("{}", self.entry().name)
    }

    /// The entry's [`Joint`], if the rule takes L and R together.
    pub fn joint(self) -> Option<Joint> {
        match self.entry().terms {
            Terms::Joint(joint) => Some(joint),
            Terms::Separate { .. } => None,
        }
    }

    /// Whether its step may be one that needs the force at one point only.
    pub fn may_be_explicit(self) -> bool {
        matches!(self.entry().terms, Terms::Separate { may_be_explicit: true, .. })
    }

    /// Whether its equation has forces that change with v̄: those at the ends do not.
    pub fn asks_for_cancelling_terms(self) -> bool {
        self.entry().points == Points::Middle
    }
}
