//! A segment (q0, q1) of a discretised system: what is asked of it, or why it has none.

use nalgebra::{SMatrix, SVector};

use crate::numbers::{CovectorDerivatives, Derivatives, Scalar};
use crate::step::discrete::explained_on;
use crate::step::{
    Discrete, DiscreteForce, DiscreteForceDerivatives, DiscreteObjects, DiscreteRayleigh,
    LegendreDerivatives, Linearizable, Momenta, Report, Segment, State, Step, StepError, StepTaken,
    require_step_size,
};
use crate::system::Quantity;

/// A segment (q0, q1) of a discretised system, by any rule: [`segment`](crate::Discretised::segment).
///
/// Each object is asked for when it is needed, and is an error where it is not finite: derivatives may not
/// exist where values do.
pub struct DiscreteSegment<'a, L, R, const N: usize>
where
    L: Discrete<R, N>,
{
    system: &'a L,
    q1: SVector<L::Scalar, N>,
    on: L::On<'a>,
}

impl<'a, L, R, const N: usize> DiscreteSegment<'a, L, R, N>
where
    L: Discrete<R, N>,
{
    pub(super) fn between(
        system: &'a L,
        q0: &SVector<L::Scalar, N>,
        q1: &SVector<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<Self, StepError> {
        require_step_size(h)?;
        StepError::require_finite(q0, Quantity::Configuration)?;
        StepError::require_finite(q1, Quantity::Configuration)?;
        Ok(Self { system, q1: *q1, on: system.on(&Segment::between(q0, q1, h))? })
    }

    /// L_d(q0, q1).
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    pub fn discrete_lagrangian(&self) -> Result<L::Scalar, StepError> {
        self.required(Ok(self.on.discrete_lagrangian()), |value| number(*value))
    }

    /// L_d with D1, D2, D11, D12, D22.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    pub fn discrete_lagrangian_derivatives(&self) -> Result<Derivatives<L::Scalar, N>, StepError> {
        self.required(self.on.discrete_lagrangian_derivatives(), derivatives)
    }

    /// f_d = (f_d⁻, f_d⁺); 0 where no force acts.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    pub fn discrete_force(&self) -> Result<DiscreteForce<L::Scalar, N>, StepError> {
        self.required(self.on.discrete_force(), |force| finite(&force.minus).and(finite(&force.plus)))
    }

    /// f_d with its derivatives by q0 and q1.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    pub fn discrete_force_derivatives(&self) -> Result<DiscreteForceDerivatives<L::Scalar, N>, StepError> {
        let force = self.on.discrete_force_derivatives();
        self.required(force, |force| covector(&force.minus).and(covector(&force.plus)))
    }

    /// p0 = −D1 L_d − f_d⁻ and p1 = D2 L_d + f_d⁺.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    pub fn momenta(&self) -> Result<Momenta<L::Scalar, N>, StepError> {
        self.required(Ok(self.on.momenta()), |momenta| finite(&momenta.p0).and(finite(&momenta.p1)))
    }

    /// 𝔽⁻: (q0, −D1 L_d − f_d⁻).
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    pub fn legendre_minus(&self) -> Result<State<L::Scalar, N>, StepError> {
        Ok(State { q: self.on.segment().q0, p: self.momenta()?.p0 })
    }

    /// 𝔽⁺: (q1, D2 L_d + f_d⁺).
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    pub fn legendre_plus(&self) -> Result<State<L::Scalar, N>, StepError> {
        Ok(State { q: self.q1, p: self.momenta()?.p1 })
    }

    /// Both momenta with their derivatives by q0 and q1.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    pub fn legendre_derivatives(&self) -> Result<LegendreDerivatives<L::Scalar, N>, StepError> {
        self.required(self.on.legendre_derivatives(), |k| {
            let blocks = [&k.p0_by_q0, &k.p0_by_q1, &k.p1_by_q0, &k.p1_by_q1];
            finite(&k.momenta.p0)?;
            finite(&k.momenta.p1)?;
            blocks.into_iter().try_for_each(finite)
        })
    }

    /// Energy on the segment: E_L at the points and velocities that the rule sees.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    pub fn energy(&self) -> Result<L::Scalar, StepError> {
        self.required(Ok(self.on.energy()), |energy| number(*energy))
    }

    /// R_d with D1, D2, D11, D12, D22.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    pub fn discrete_rayleigh_derivatives(&self) -> Result<Derivatives<L::Scalar, N>, StepError>
    where
        L: DiscreteRayleigh<R, N>,
    {
        self.required(Ok(self.system.discrete_rayleigh_derivatives(self.on.segment())), derivatives)
    }

    /// The step that leads from q0 to q1, linearised: A, B, derivatives by parameters and second ones.
    ///
    /// By [`Gauss`](crate::Gauss) [`Discretised::linearized`](crate::Discretised::linearized) costs less:
    /// this solves for the stages anew, and two ends need not determine a segment.
    ///
    /// ```
    /// use dalembert::nalgebra::vector;
    /// use dalembert::{Discretise, Midpoint, rayleigh_system};
    ///
    /// #[rayleigh_system(parameters = [r])]
    /// fn oscillator(q: [f64; 1], v: [f64; 1], m: f64, k: f64, r: f64) -> (f64, f64) {
    ///     (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
    /// }
    /// let (m, k, r, h) = (1.0, 1.0, 0.5, 0.25);
    /// let oscillator = Oscillator { m, k, r };
    /// let step = oscillator.by(Midpoint, h).segment(&vector![0.0], &vector![0.2])?.linearized()?;
    /// let determinant = (4.0 * m + h * h * k - 2.0 * h * r) / (4.0 * m + h * h * k + 2.0 * h * r);
    /// assert!((step.by_state()?.assembled::<2>().determinant() - determinant).abs() < 1e-15);
    /// assert!(step.by_parameters()?.q[0] < 0.0); // with more friction it comes less far
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    ///
    /// # Errors
    /// [`StepError::SingularNewtonMatrix`] if ∂p0/∂q1 is singular: there the step has no derivative.
    pub fn linearized(self) -> Result<StepTaken<'a, L, R, N>, StepError>
    where
        L: Linearizable<R, N>,
    {
        let velocity = self.on.segment().v;
        let state = State { q: self.q1, p: self.on.momenta().p1 };
        StepTaken::on(self.on, Step { state, velocity, report: Report::of_no_equation() })
    }

    fn required<T>(
        &self,
        found: Result<T, StepError>,
        check: impl FnOnce(&T) -> Result<(), StepError>,
    ) -> Result<T, StepError> {
        let value = found?;
        match check(&value) {
            Ok(()) => Ok(value),
            Err(error) => Err(explained_on::<L, R, N>(self.system, self.on.segment(), error)),
        }
    }
}

fn number<S: Scalar>(value: S) -> Result<(), StepError> {
    finite(&SVector::<S, 1>::new(value))
}

fn finite<S: Scalar, const N: usize, const K: usize>(block: &SMatrix<S, N, K>) -> Result<(), StepError> {
    StepError::require_finite(block, Quantity::Derivatives)
}

fn derivatives<S: Scalar, const N: usize>(of: &Derivatives<S, N>) -> Result<(), StepError> {
    number(of.value)?;
    finite(&of.d1)?;
    finite(&of.d2)?;
    [&of.d11, &of.d12, &of.d22].into_iter().try_for_each(finite)
}

fn covector<S: Scalar, const N: usize>(of: &CovectorDerivatives<S, N>) -> Result<(), StepError> {
    finite(&of.value)?;
    [&of.d1, &of.d2].into_iter().try_for_each(finite)
}
