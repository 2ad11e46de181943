//! Which discrete equations of motion have an R_d: of the configurations alone, whatever the momenta.

use core::fmt;

use nalgebra::SMatrix;

use super::rayleigh_step::{Asymmetry, Entry, RayleighStepError};
use crate::numbers::Scalar;
use crate::step::{Discretised, Flow, PhaseMatrix, State, invert};
use crate::theory::samples::{Sizes, Stopped, around, at_segment};
use crate::theory::verdict::{Finding, Tolerance, largest};

/// Whether the equation of motion of a method, in configurations, is that of some (L_d, R_d):
/// [`rayleigh_equation`](crate::Discretised::rayleigh_equation).
///
/// A method on (q, p) whose ends tell its step moves q by
///
/// ```text
/// E(q_{k−1}, q_k, q_{k+1}) = p1(q_{k−1}, q_k) − p0(q_k, q_{k+1}) = 0
/// ```
///
/// **Theorem** (discrete Helmholtz conditions). E(x, y, z) is, as an expression, D2L_d⁻(x, y) + D1L_d⁺(y,
/// z) of some L_d^± = L_d ± R_d if and only if ∂²E/∂x∂z = 0 and ∂E/∂y is symmetric.
///
/// *Proof.* E = α(x, y) + β(y, z), and as ∂α/∂y + ∂β/∂y is symmetric for all x and z, the antisymmetric
/// part of ∂α/∂y depends on y alone. It is that of a covector α(x₀, y), which taken from α and given to β
/// leaves D2L_d⁻ and D1L_d⁺. The converse is clear. ∎
///
/// Here ∂²E/∂x∂z = 0, and ∂E/∂y = K11 − K00 with K11 = ∂p1/∂q1 = d b⁻¹ of the step before the node and K00
/// = ∂p0/∂q0 = −b⁻¹a of the one behind it. A [`RayleighStep`](super::RayleighStep) has both symmetric; here
/// their antisymmetric parts may agree, and the momenta of (L_d, R_d) then differ from the method's by a
/// covector of q. For n = 1 every equation is one.
///
/// **What follows of the paper's conjecture.** Of M q̈ + C q̇ + Kq = 0 with symmetric matrices the exact
/// q(kh) have an R_d in this sense for every damping, and so have the methods that are functions of the
/// field. Of a nonlinear V the exact motion has, with M = I and the velocity v at the node,
///
/// ```text
/// ∂E/∂y − (∂E/∂y)ᵀ = −(h³/15) [C, V‴(v)] + O(h⁴)
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct RayleighEquation {
    /// How many pairs of steps were looked at.
    pub samples: usize,
    /// Of K11 − K00 at the node between two steps.
    pub at_node: Asymmetry,
}

/// The derivatives of two steps that meet at a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeSteps<S, const N: usize> {
    /// Of the step that ends there.
    pub before: PhaseMatrix<S, N>,
    /// Of a step that starts there, with any momentum.
    pub after: PhaseMatrix<S, N>,
}

impl<S: Scalar, const N: usize> NodeSteps<S, N> {
    /// The asymmetry of d b⁻¹ + b⁻¹a that is worst, 0 for n = 1; none where b is singular.
    fn asymmetry(&self, sample: usize, relative: f64) -> Option<Asymmetry> {
        let before = invert(&self.before.q_by_p).ok()?;
        let after = invert(&self.after.q_by_p).ok()?;
        let k11 = self.before.p_by_p * before;
        let k00 = -(after * self.after.q_by_q);
        // An inverse is known to the rounding of |b⁻¹||b||b⁻¹|.
        let size = |matrix: &SMatrix<S, N, N>| matrix.map(|entry| entry.abs());
        let known =
            |inverse: &SMatrix<S, N, N>, b: &SMatrix<S, N, N>| size(inverse) * size(b) * size(inverse);
        let terms = size(&self.before.p_by_p) * known(&before, &self.before.q_by_p)
            + known(&after, &self.after.q_by_p) * size(&self.after.q_by_q);
        let mut worst = None;
        for i in 0..N {
            for j in 0..i {
                let entry = |i, j| k11[(i, j)].widen() - k00[(i, j)].widen();
                let scale = terms[(i, j)].widen() + terms[(j, i)].widen();
                let found = entry(i, j) - entry(j, i);
                Finding::relative(found, Tolerance { relative, scale }, Entry { entry: (i, j), sample })
                    .keep_if_worse(&mut worst, Finding::excess);
            }
        }
        let none = Tolerance { relative, scale: 1.0 };
        Some(worst.unwrap_or_else(|| Finding::relative(0.0, none, Entry { entry: (0, 0), sample })))
    }

    fn is_finite(&self) -> bool {
        let entries = |a: &PhaseMatrix<S, N>| {
            largest(
                [&a.q_by_q, &a.q_by_p, &a.p_by_q, &a.p_by_p].into_iter().flatten().map(|entry| entry.widen()),
            )
        };
        entries(&self.before).is_finite() && entries(&self.after).is_finite()
    }
}

impl RayleighEquation {
    /// Of steps with these derivatives, such as some written by hand. An asymmetry counts as zero within
    /// `relative` of the terms it is the sum of, or 1024 ε unless said.
    ///
    /// # Errors
    /// A [`RayleighStepError`] that says which hypothesis fails.
    pub fn of<S: Scalar, const N: usize>(
        nodes: &[NodeSteps<S, N>],
        relative: Option<f64>,
    ) -> Result<Self, RayleighStepError> {
        let relative = relative.unwrap_or_else(Tolerance::rounding::<S>);
        let mut at_node = None;
        for (sample, node) in nodes.iter().enumerate() {
            if !node.is_finite() {
                return Err(RayleighStepError::NonFinite { sample });
            }
            let found = node.asymmetry(sample, relative).ok_or(RayleighStepError::Degenerate { sample })?;
            found.keep_if_worse(&mut at_node, Finding::excess);
        }
        let at_node = at_node.ok_or(RayleighStepError::NoSamples)?;
        Ok(Self { samples: nodes.len(), at_node })
    }

    /// Whether some L_d and R_d have the method's equation of motion, in a simply connected region like that
    /// sampled.
    #[must_use]
    pub fn is_rayleigh(&self) -> bool {
        self.at_node.vanishes()
    }
}

/// Rayleigh equations.
impl<L, M, const N: usize> Discretised<'_, L, M, N>
where
    L: Flow<M, N>,
{
    /// Whether the q_k of this method follow a discrete Rayleigh system, by the derivatives of its steps:
    /// of a rule, a composition or a splitting alike. See
    /// [`RayleighEquation`](crate::rayleigh::RayleighEquation).
    ///
    /// **States it needs.** One. From each a step is taken, and from its end n + 1 more: with the momentum
    /// that it has there, and with each component of that changed by its own size, so that the two segments
    /// at the node are independent. Of a view the k-th state is asked k h after its time, the node a step
    /// later. The answer is about these.
    ///
    /// ```
    /// use dalembert::nalgebra::vector;
    /// use dalembert::{Discretise, Gauss, State, rayleigh_system};
    ///
    /// /// Friction of one coordinate, springs that couple it to the other, and a quartic one: CK ≠ KC.
    /// #[rayleigh_system(rule = gauss)]
    /// fn pair(q: [f64; 2], v: [f64; 2], quartic: f64) -> (f64, f64) {
    ///     let springs = 0.5 * (q[0] * q[0] + q[1] * q[1] + q[0] * q[1]);
    ///     let bent = 0.25 * quartic * (q[0] - q[1]).powi(4);
    ///     (0.5 * (v[0] * v[0] + v[1] * v[1]) - springs - bent, 0.25 * v[0] * v[0])
    /// }
    /// let states = [State { q: vector![0.3, -0.2], p: vector![0.1, 0.4] }];
    /// // As a map of (q, p) Gauss with two stages has no R_d, as its equation for q it has one …
    /// let linear = Pair { quartic: 0.0 };
    /// assert!(!linear.by(Gauss::<2>, 0.5).rayleigh_step(&states)?.is_rayleigh());
    /// assert!(linear.by(Gauss::<2>, 0.5).rayleigh_equation(&states)?.is_rayleigh());
    /// // … where the potential is quadratic.
    /// let bent = Pair { quartic: 1.0 };
    /// assert!(!bent.by(Gauss::<2>, 0.5).rayleigh_equation(&states)?.is_rayleigh());
    /// # Ok::<(), dalembert::rayleigh::RayleighStepError>(())
    /// ```
    ///
    /// # Errors
    /// A [`RayleighStepError`](crate::rayleigh::RayleighStepError) that says which hypothesis fails.
    pub fn rayleigh_equation(
        &self,
        states: &[State<L::Scalar, N>],
    ) -> Result<RayleighEquation, RayleighStepError> {
        const { Self::require_unconstrained() };
        let mut nodes = Vec::new();
        let mut moves = states.is_empty();
        for (sample, state) in states.iter().enumerate() {
            let failed = |error| RayleighStepError::Step { sample, error };
            let stopped = |Stopped| RayleighStepError::Stopped;
            let step = |by: &Discretised<'_, L, M, N>, state: &_| by.linearized_step(state);
            let (taken, before) =
                at_segment(self, sample, |by| step(by, state)).map_err(stopped)?.map_err(failed)?;
            let node = taken.state;
            let sizes = Sizes::of([*state, node]);
            moves |= sizes.are_apart(state, &node);
            // Changes of q come first.
            let beside = around(&[node], &sizes, [1.0, 1.0]).split_off(N);
            for (k, from) in core::iter::once(&node).chain(&beside).enumerate() {
                let after = at_segment(self, sample + 1, |by| step(by, from)).map_err(stopped)?;
                match after {
                    Ok((_, after)) => nodes.push(NodeSteps { before, after }),
                    Err(error) if k == 0 => return Err(failed(error)),
                    // Beside the states given a system may end.
                    Err(_) => {}
                }
            }
        }
        if !moves {
            return Err(RayleighStepError::AtRest);
        }
        RayleighEquation::of(&nodes, None)
    }
}

impl fmt::Display for RayleighEquation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (verdict, answer) = if self.is_rayleigh() {
            ("an equation of motion with an R_d", "yes")
        } else {
            ("no R_d for any L_d, whatever the momenta", "no")
        };
        writeln!(f, "{verdict}, by pairs of steps: {}", self.samples)?;
        write!(f, "  K11 − K00 is symmetric at the node between them   {answer}: {}", self.at_node)
    }
}
