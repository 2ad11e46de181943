use core::fmt;
use core::ops::Add;

use nalgebra::SVector;

use super::{Defect, Generator, Noether};
use crate::numbers::Scalar;
use crate::step::{Discrete, State, Step, StepError};
use crate::system::VectorField;
use crate::theory::{samples::at_time_of, verdict::Finding};

/// The account of a momentum map along a trajectory: J_N − J_0 = Σ ξ(L_d) + Σ f_d(ξ). See
/// [`Noether::balance`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Balance {
    /// Name of the generator.
    pub generator: String,
    /// Steps N.
    pub steps: u64,
    /// J at the start, ⟨p₀, ξ(q₀)⟩.
    pub start: f64,
    /// J at the end, ⟨p_N, ξ(q_N)⟩.
    pub end: f64,
    /// Σ ξ(L_d) and Σ f_d(ξ) over the segments; at the stages of rules with interior points.
    pub accumulated: Defect<f64>,
    /// Largest |J_{k+1} − J_k − defect| of one step, and the number of that step, from 0.
    pub worst_step: (f64, u64),
    /// Bound on J_N − J_0 − Σ defect from rounding and from the residuals that the solver left.
    pub tolerance: f64,
    /// The sum of the sizes of all terms of the account.
    pub terms: f64,
}

impl Balance {
    /// J_N − J_0 − Σ defect: 0 to rounding, whether J is conserved or not.
    #[must_use]
    pub fn residual(&self) -> f64 {
        self.end - self.start - self.accumulated.total()
    }

    /// Whether the account, of at least one step, is balanced to rounding, in total and at each step. If not,
    /// the trajectory is not the system's, or its steps are solved so badly that their residuals exceed
    /// the terms.
    #[must_use]
    pub fn is_balanced(&self) -> bool {
        // A step that goes astray and comes back leaves the sum as it is.
        let vanishes = |value| Finding::bounded(value, self.tolerance, self.terms, ()).vanishes();
        self.steps > 0 && vanishes(self.residual()) && vanishes(self.worst_step.0)
    }
}

/// Two stretches of one trajectory, the second following the first.
impl Add for Balance {
    type Output = Self;
    fn add(self, next: Self) -> Self {
        let later = (next.worst_step.0, self.steps + next.worst_step.1);
        Self {
            generator: self.generator,
            steps: self.steps + next.steps,
            start: self.start,
            end: next.end,
            accumulated: Defect {
                lagrangian: self.accumulated.lagrangian + next.accumulated.lagrangian,
                force: self.accumulated.force + next.accumulated.force,
                interior: self.accumulated.interior + next.accumulated.interior,
            },
            // A NaN must not hide behind a comparison.
            worst_step: if later.0 > self.worst_step.0 || later.0.is_nan() { later } else { self.worst_step },
            tolerance: self.tolerance + next.tolerance + f64::EPSILON * (self.end - next.start).abs(),
            terms: self.terms + next.terms,
        }
    }
}

/// Roundings of one term of a step's account, in units of ε: products and sums over coordinates, and those
/// inside L and f.
const ROUNDINGS: f64 = 16.0;

impl<L, R, const N: usize> Noether<'_, L, R, N>
where
    L: Discrete<R, N>,
{
    /// Follows J along `steps`, which start at `start`: usually
    /// `noether.balance(&generator, &start, trajectory.by_ref().take(n))`. Step k is taken to start k h after
    /// the time of the system given: the second stretch of a run is that of the system at its own start.
    ///
    /// The defects come from the derivatives of L_d and f_d at the configurations reached, J from the momenta
    /// of the states, so that the balance tests the flow and not itself. Its tolerance is a bound, summed
    /// over the steps:
    ///
    /// ```text
    /// |residual|·|ξ(q_k)| + 16 ε Σ |ξᵢ| (|∂ᵢL_d| + |f_dᵢ| + Σⱼ (|∂ᵢ∂ⱼL_d| + |∂ⱼf_dᵢ|) |qⱼ|)
    /// ```
    ///
    /// what the solver left, the rounding of each term, and what rounding the configurations themselves does
    /// to it. Of a rule with interior points pᵢ and ∂pᵢ stand for the terms of L_d and f_d.
    ///
    /// On constraints ξ has to be tangent to them: of another the account lacks what reactions do.
    ///
    /// # Errors
    /// The first error among `steps`.
    pub fn balance(
        &self,
        generator: &Generator<L::Scalar, N>,
        start: &State<L::Scalar, N>,
        steps: impl IntoIterator<Item = Result<Step<L::Scalar, N>, StepError>>,
    ) -> Result<Balance, StepError> {
        let momentum_map = |state: &State<L::Scalar, N>| state.p.dot(&generator.vector(&state.q)).widen();
        let mut at = *start;
        let mut j = momentum_map(start);
        let mut balance = Balance {
            generator: generator.name().to_owned(),
            steps: 0,
            start: j,
            end: j,
            accumulated: Defect { lagrangian: 0.0, force: 0.0, interior: 0.0 },
            worst_step: (0.0, 0),
            tolerance: ROUNDINGS * L::Scalar::EPSILON.widen() * j.abs(),
            terms: j.abs(),
        };
        let (mut lagrangian, mut force, mut interior) = (Sum::default(), Sum::default(), Sum::default());
        for step in steps {
            let step = step?;
            let k = balance.steps as usize;
            let defect = at_time_of(&self.by, k, |by| by.objects(&at.q, &step.state.q).defect(generator).0);
            let next = momentum_map(&step.state);
            let off = (next - j - defect.total().widen()).abs();
            // A NaN must not hide behind a comparison.
            if off > balance.worst_step.0 || off.is_nan() {
                balance.worst_step = (off, balance.steps);
            }
            lagrangian.add(defect.lagrangian.widen());
            force.add(defect.force.widen());
            interior.add(defect.interior.widen());
            let (tolerance, terms) = self.rounding_of_step(k, generator, &at.q, &step);
            balance.tolerance += tolerance;
            balance.terms += terms;
            balance.steps += 1;
            (at, j) = (step.state, next);
        }
        balance.end = j;
        balance.accumulated =
            Defect { lagrangian: lagrangian.value(), force: force.value(), interior: interior.value() };
        Ok(balance)
    }

    /// The bound documented at [`Noether::balance`], and the terms that it is a share of.
    fn rounding_of_step(
        &self,
        k: usize,
        generator: &Generator<L::Scalar, N>,
        q0: &SVector<L::Scalar, N>,
        step: &Step<L::Scalar, N>,
    ) -> (f64, f64) {
        let q1 = &step.state.q;
        let (xi0, xi1) = (generator.vector(q0).abs(), generator.vector(q1).abs());
        let (size0, size1) = (q0.abs(), q1.abs());
        let (at_q0, at_q1) = at_time_of(&self.by, k, |by| {
            let objects = by.objects(q0, q1);
            if L::HAS_INTERIOR_POINTS {
                // Of its derivatives the sums alone are exact, and cheap.
                let of = objects.legendre();
                return (
                    of.momenta.p0.abs() + of.p0_by_q0.abs() * size0 + of.p0_by_q1.abs() * size1,
                    of.momenta.p1.abs() + of.p1_by_q0.abs() * size0 + of.p1_by_q1.abs() * size1,
                );
            }
            let (l, f) = (objects.lagrangian_derivatives(), objects.force_derivatives());
            (
                l.d1.abs()
                    + f.minus.value.abs()
                    + (l.d11.abs() + f.minus.d1.abs()) * size0
                    + (l.d12.abs() + f.minus.d2.abs()) * size1,
                l.d2.abs()
                    + f.plus.value.abs()
                    + (l.d12.transpose().abs() + f.plus.d1.abs()) * size0
                    + (l.d22.abs() + f.plus.d2.abs()) * size1,
            )
        });
        let rounding = ROUNDINGS * L::Scalar::EPSILON.widen();
        let terms = (at_q0.dot(&xi0) + at_q1.dot(&xi1)).widen();
        (terms * rounding + (step.report.residual * xi0.sum()).widen(), terms)
    }
}

/// A sum whose rounding does not grow with the number of terms (Neumaier).
#[derive(Default)]
struct Sum {
    sum: f64,
    lost: f64,
}

impl Sum {
    fn add(&mut self, term: f64) {
        let sum = self.sum + term;
        self.lost +=
            if self.sum.abs() >= term.abs() { (self.sum - sum) + term } else { (term - sum) + self.sum };
        self.sum = sum;
    }

    fn value(&self) -> f64 {
        self.sum + self.lost
    }
}

impl fmt::Display for Balance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}: balance of J over {} steps", self.generator, self.steps)?;
        writeln!(f, "  J_0               {:>18.10e}", self.start)?;
        writeln!(f, "  + Σ ξ(L_d)        {:>18.10e}", self.accumulated.lagrangian)?;
        writeln!(f, "  + Σ f_d(ξ)        {:>18.10e}", self.accumulated.force)?;
        if self.accumulated.interior != 0.0 {
            writeln!(f, "  + interior points {:>18.10e}", self.accumulated.interior)?;
        }
        writeln!(f, "  − J_N             {:>18.10e}", -self.end)?;
        write!(
            f,
            "  = {:.2e}, {} {:.1e}, the bound on rounding and on the solver's residuals; worst step {}: {:.1e}",
            -self.residual(),
            if self.is_balanced() { "within" } else { "OUTSIDE" },
            self.tolerance,
            self.worst_step.1,
            self.worst_step.0,
        )
    }
}
