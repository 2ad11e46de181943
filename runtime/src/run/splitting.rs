//! High order from kicks and exact drifts: Runge–Kutta–Nyström splittings.

mod coefficients;
mod force_work;
mod lanes;
mod sums;
mod underway;

use core::marker::PhantomData;

use nalgebra::{SMatrix, SVector};

use coefficients::Part;
pub use sums::{CompensatedSums, PlainSums, Sums};
use underway::Underway;

use crate::numbers::{Compensated, Scalar};
use crate::rules::{Drift, modes, require_positive_definite};
use crate::run::Explicit;
use crate::run::memory::verify_explicit;
use crate::step::cause::{cause_of, explained};
use crate::step::{
    Flow, LinearizedStep, Memory, PhaseMatrix, Quantity, Report, Segment, State, Step, StepError, invert,
};
use crate::system::GeneratedDiffers;

/// A splitting of the motion into kicks by the potential and damped free motions between, S of them,
/// symmetric and of high order: for L = ½vᵀMv − V(q) and R = ½vᵀCv with constant M, positive definite, and C,
/// and a force f(q), or f(q, u) with an input held. V and f may take the time.
///
/// **Derivation.** The motion's vector field is A + B, with flows that are known exactly:
///
/// ```text
/// A:  q̇ = v,  ṗ = −Cv,  p = Mv          q += M⁻¹ϕ(τCM⁻¹) τ p,  p ← exp(−τCM⁻¹) p,    ϕ(z) = (1 − e⁻ᶻ)/z
/// B:  q̇ = 0,  ṗ = G(q) = −∇V(q) + f(q)  p += τ G(q)
/// step = B(b₁h) A(a₁h) B(b₂h) … A(a_S h) B(b₁h)        of order 4 and 6,        Σ aᵢ = Σ bᵢ = 1
///        A(a₁h) B(b₁h) A(a₂h) … B(b_S h) A(a₁h)        of order 8,    the same from either end
/// ```
///
/// B lowers the degree in p of a field by one, A raises it by one at most, with damping as without. So
/// brackets with two B more than A are 0, `[B,[B,[B,A]]]` first, and those with one more are forces of q
/// alone, which commute. Without damping nothing else vanishes in brackets of up to eight letters (they span
/// 2, 1, 2, 2, 4, 5, 10, 14 dimensions by R. I. McLachlan and B. Ryland, The algebraic entropy of classical
/// mechanics, J. Math. Phys. 44, 2003, and there are as many conditions). So the conditions of these orders
/// are those without damping, fewer than for fields of any kind: 8 of order 6, 18 of order 8. The
/// coefficients are those of S. Blanes and P. C. Moan (Practical symplectic partitioned Runge–Kutta and
/// Runge–Kutta–Nyström methods, J. Comput. Appl. Math. 142, 2002, 313–330) and of S. Blanes, F. Casas and A.
/// Escorihuela-Tomàs (Runge–Kutta–Nyström symplectic splitting methods of order 8, Appl. Numer. Math. 2022,
/// arXiv:2202.01541). A step costs S gradients and no equation is solved.
///
/// **Time.** With t as one more coordinate A adds ṫ = 1, so that t moves with the drifts and stands still in
/// kicks, whose forces are then functions of (q, t): brackets vanish as before, and the conditions are the
/// same. The kick after the drifts a₁ … aᵢ sees the time t + (a₁ + … + aᵢ)h. Order 4 and 6 then cost one
/// gradient more, since the next step's clock starts at a rounding of its own.
///
/// **Structure.** Each kick with the drift after it is the flow of a discrete Lagrangian system with force.
/// Self-adjoint. Symplectic where C = 0. The determinant of the step is e^{−h tr M⁻¹C}, that of the flow, for
/// every V; where C = 2aM, AᵀΩA = e^{−2ah}Ω, and an angular momentum falls by e^{−2ah} a step, exactly, where
/// the rotation leaves V and M as they are.
///
/// **Stability.** A free mass decays as its motion does, for any hr/m and without ringing, although some
/// drifts lead backwards: those are undone exactly. With ω² = k/m, the powers of the step are bounded for an
/// oscillator without damping for
///
/// | | | but for resonances near hω = π, 2π, where they grow |
/// |---|---|---|
/// | order 4 | hω < 5.026 | 3.1634 < hω < 3.1686, by 0.24 % a step at most |
/// | order 6 | hω < 9.073 | 3.1414 < hω < 3.1424, 6.3478 < hω < 6.3493, by 0.07 % a step at most |
/// | order 8 | hω < 5.962 | 3.1398 < hω < 3.1429, by 0.16 % a step at most |
///
/// and decay up to hω = 5, 9 and 5.9 with damping of 0.01 ≤ hr/m ≤ 10. Where damping is stiff the error falls
/// more slowly than the order says, as by all splittings; there [`Fitted`](crate::Fitted) and
/// [`Gauss`](crate::Gauss) rules serve.
///
/// **Rounding.** A step rounds q and p once for each drift and kick, and those roundings add up over a run:
/// for errors of some 1e-11 and below more steps do not help. With [`compensated`](Self::compensated) a step
/// sums what it adds apart from where it starts, and what the sum of both loses is added in the next step, as
/// in [`Gauss`](crate::Gauss) rules (E. Hairer, C. Lubich and G. Wanner, Geometric Numerical Integration,
/// 2006, VIII.5).
///
/// **Errors.** [`StepError::MassNotPositiveDefinite`]; [`StepError::NonFinite`], of derivatives where damping
/// overflows over a drift backwards, of the state where it overflows; [`StepError::StepSize`].
///
/// ```
/// use dalembert::{Discretise, Splitting, State, rayleigh_system};
///
/// #[rayleigh_system(rule = trapezoidal)]
/// fn pendulum(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
///     (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
/// }
///
/// let system = Pendulum { r: 0.0 };
/// let start = State::from_velocity(&system, [1.0], [0.0])?;
/// let mut run = system.by(Splitting::blanes_moan_6(), 0.5).run(start);
/// let end = run.by_ref().take(2000).last().unwrap()?.state;
/// assert!((end.energy(&system)? - start.energy(&system)?).abs() < 1e-8);
/// assert_eq!(run.time(), 1000.0);
/// # Ok::<(), dalembert::StepError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Splitting<const S: usize, C: Sums = PlainSums> {
    sums: PhantomData<C>,
}

impl<const S: usize> Splitting<S> {
    /// This splitting with compensated sums: for errors near rounding, and for energies and momenta that
    /// roundings do not move in long runs. In lanes a step of order 8 takes 1.15 to 1.2 times as long, of
    /// order 4 and 6 up to 1.8 times.
    ///
    /// Kepler's problem with e = 0.6 over 16 revolutions, by 5 000 steps of order 8: off by 4e-13, else by
    /// 2e-11.
    ///
    /// ```
    /// use dalembert::{Discretise, Splitting, State, rayleigh_system};
    ///
    /// #[rayleigh_system(rule = trapezoidal)]
    /// fn pendulum(q: [f64; 1], v: [f64; 1]) -> f64 {
    ///     0.5 * v[0] * v[0] + q[0].cos()
    /// }
    /// let start = State { q: [1.0].into(), p: [0.0].into() };
    /// let energy = start.energy(&Pendulum {})?;
    /// let splitting = Splitting::blanes_casas_escorihuela_8();
    /// let end = Pendulum {}.by(splitting.compensated(), 0.03).run(start).take(10_000).last().unwrap()?;
    /// assert!((end.state.energy(&Pendulum {})? - energy).abs() < 1e-15);
    /// let end = Pendulum {}.by(splitting, 0.03).run(start).take(10_000).last().unwrap()?;
    /// assert!((end.state.energy(&Pendulum {})? - energy).abs() > 3e-15);
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    #[must_use]
    pub const fn compensated(self) -> Splitting<S, CompensatedSums> {
        Splitting { sums: PhantomData }
    }
}

impl<L, const N: usize, const S: usize, C: Sums> Flow<Splitting<S, C>, N> for L
where
    L: Explicit<N>,
{
    type RunMemory = Kicks<L::Scalar, N, S, C>;

    /// No equation is solved: no guess serves.
    #[inline]
    fn step(
        &self,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
        _guess: Option<&SVector<L::Scalar, N>>,
    ) -> Result<Step<L::Scalar, N>, StepError> {
        Memory::<L, Splitting<S, C>, N>::advance(&mut Kicks::default(), self, state, h)
    }

    /// The product of the kicks' and drifts' derivatives.
    fn linearized_step(
        &self,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
        _guess: Option<&SVector<L::Scalar, N>>,
    ) -> Result<LinearizedStep<L::Scalar, N>, StepError> {
        let prepared = Prepared::<L::Scalar, N, S>::new(self, h)?;
        let mut kicks = Kicks { prepared: Some(prepared), ..Kicks::default() };
        let step = Memory::<L, Splitting<S, C>, N>::advance(&mut kicks, self, state, h)?;
        Ok((step, prepared.derivative(self, state)?))
    }

    fn verify_momenta(&self, state: &State<L::Scalar, N>, h: L::Scalar) -> Result<(), GeneratedDiffers> {
        verify_explicit(self, state, h)
    }
}

/// The kicks and drifts of a [`Splitting`].
///
/// The drifts are worked out in the first step of a size. Where kicks come first, the force at the end
/// of a step is that at the start of the next, unless an input is held, which may be another by then, or the
/// force takes the time. It belongs to one system.
#[derive(Clone, Copy, Debug)]
pub struct Kicks<T, const N: usize, const S: usize, C: Sums> {
    prepared: Option<Prepared<T, N, S>>,
    /// A configuration, and G − ∂R/∂v(0) there.
    force: Option<(SVector<T, N>, SVector<T, N>)>,
    /// The end of the last step, and what its sums have lost; only of compensated sums.
    end: Option<[Compensated<T, N>; 2]>,
    sums: PhantomData<C>,
}

impl<T, const N: usize, const S: usize, C: Sums> Default for Kicks<T, N, S, C> {
    fn default() -> Self {
        Self { prepared: None, force: None, end: None, sums: PhantomData }
    }
}

/// A step size, and the values that depend on it alone.
#[derive(Clone, Copy, Debug)]
struct Prepared<T, const N: usize, const S: usize> {
    h: T,
    /// bᵢh.
    kicks: [T; S],
    drifts: Drifts<T, N, S>,
    /// Without damping no drift changes p.
    is_damped: bool,
    /// M⁻¹, if elimination finds it.
    inverse_mass: Option<SMatrix<T, N, N>>,
    /// ∂L/∂v at v = 0.
    shift: SVector<T, N>,
    /// ∂R/∂v at v = 0.
    thrust: SVector<T, N>,
}

/// The drifts, in the form that the matrices have.
#[derive(Clone, Copy, Debug)]
enum Drifts<T, const N: usize, const S: usize> {
    /// M and C are diagonal.
    Diagonal([Drift<SVector<T, N>>; S]),
    Full([Drift<SMatrix<T, N, N>>; S]),
}

impl<T: Scalar, const N: usize, const S: usize> Prepared<T, N, S> {
    #[cold]
    #[inline(never)]
    fn new<L: Explicit<N, Scalar = T>>(system: &L, h: T) -> Result<Self, StepError> {
        crate::step::require_step_size(h)?;
        let rest = nalgebra::zero();
        let (l, r) =
            (system.lagrangian_derivatives(&rest, &rest), system.dissipation_derivatives(&rest, &rest));
        let (mass, damping) = (l.d22, r.d22);
        let is_diagonal =
            [mass, damping].iter().all(|matrix| *matrix == SMatrix::from_diagonal(&matrix.diagonal()));
        let times = Splitting::<S>::DRIFTS.map(|share| T::constant(share) * h);
        let drifts = if is_diagonal {
            let (mass, damping) = (mass.diagonal(), damping.diagonal());
            if let Some(column) = mass.iter().position(|&mass| mass <= T::zero()) {
                return Err(StepError::MassNotPositiveDefinite { column });
            }
            Drifts::Diagonal(once_each(&times, |time| Drift::of_diagonal(&mass, &damping, time))?)
        } else {
            require_positive_definite(&mass)?;
            let modes = modes(&mass, &damping);
            Drifts::Full(once_each(&times, |time| Drift::of_modes(&modes, time))?)
        };
        Ok(Self {
            h,
            kicks: Splitting::<S>::KICKS.map(|share| T::constant(share) * h),
            drifts,
            is_damped: damping.iter().any(|entry| *entry != T::zero()),
            inverse_mass: invert(&mass).ok(),
            shift: l.d2,
            thrust: r.d2,
        })
    }

    /// The step from where `at` is, with `drift` for its drifts, from where the force is `force`; the force
    /// at its end. One that drifts first asks for no force at its ends.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn carry<L: Explicit<N, Scalar = T>, D, C: Sums>(
        &self,
        system: &L,
        at: &mut Underway<T, N, C>,
        mut force: SVector<T, N>,
        drifts: &[D; S],
        drift: impl Fn(&D, &mut Underway<T, N, C>),
    ) -> SVector<T, N> {
        let mut sum = nalgebra::zero();
        if Splitting::<S>::DRIFTS_FIRST {
            if let Some((outer, inner)) = drifts.split_first() {
                drift(outer, at);
                for ((&kick, of), share) in
                    self.kicks.iter().zip(inner.iter().chain([outer])).zip(Splitting::<S>::NODES)
                {
                    at.kick(
                        &((force_after(system, share, self.h, at.configuration(&mut sum)) - self.thrust)
                            * kick),
                    );
                    drift(of, at);
                }
            }
            return force;
        }
        for ((&kick, of), share) in self.kicks.iter().zip(drifts).zip(Splitting::<S>::NODES) {
            at.kick(&(force * kick));
            drift(of, at);
            force = force_after(system, share, self.h, at.configuration(&mut sum)) - self.thrust;
        }
        let closing = self.kicks.first().map_or(T::zero(), |&kick| kick);
        at.kick(&(force * closing));
        force
    }

    /// The matrices of the i-th drift.
    fn drift(&self, i: usize) -> Drift<SMatrix<T, N, N>> {
        match &self.drifts {
            Drifts::Full(drifts) => drifts[i],
            Drifts::Diagonal(drifts) => Drift {
                displacement: SMatrix::from_diagonal(&drifts[i].displacement),
                loss: SMatrix::from_diagonal(&drifts[i].loss),
            },
        }
    }

    /// ∂(q1, p1)/∂(q0, p0) of the step from `state`.
    fn derivative<L: Explicit<N, Scalar = T>>(
        &self,
        system: &L,
        state: &State<T, N>,
    ) -> Result<PhaseMatrix<T, N>, StepError> {
        let rest = nalgebra::zero();
        let identity = SMatrix::<T, N, N>::identity();
        let (mut q, mut p) = (state.q, state.p - self.shift);
        let mut a = PhaseMatrix::identity();
        for part in Splitting::<S>::parts() {
            match part {
                Part::Kick(i, share) => {
                    let kick = self.kicks[i];
                    let (slope, force) = system.later(T::constant(share) * self.h, |system| {
                        let slope = system.lagrangian_derivatives(&q, &rest).d11
                            + system.general_force_derivatives(&q, &rest).d1;
                        (slope, system.configuration_force(&q))
                    });
                    a.p_by_q += slope * a.q_by_q * kick;
                    a.p_by_p += slope * a.q_by_p * kick;
                    p += (force - self.thrust) * kick;
                }
                Part::Drift(i) => {
                    let Drift { displacement, loss } = self.drift(i);
                    a.q_by_q += displacement * a.p_by_q;
                    a.q_by_p += displacement * a.p_by_p;
                    a.p_by_q = (identity + loss) * a.p_by_q;
                    a.p_by_p = (identity + loss) * a.p_by_p;
                    q += displacement * p;
                    p += loss * p;
                }
            }
        }
        let entries = [&a.q_by_q, &a.q_by_p, &a.p_by_q, &a.p_by_p];
        let finite =
            entries.into_iter().try_for_each(|of| StepError::require_finite(of, Quantity::Derivatives));
        finite.map(|()| a).map_err(|error| self.explained(system, state, error))
    }

    /// The `error` of numbers that are not finite on the way from `state`, or in place of it the function
    /// that has no derivative where a kick evaluates it.
    #[cfg_attr(feature = "std", cold)]
    #[cfg_attr(not(feature = "std"), inline(always))]
    fn explained<L: Explicit<N, Scalar = T>>(
        &self,
        system: &L,
        state: &State<T, N>,
        error: StepError,
    ) -> StepError {
        if !cfg!(feature = "std") {
            return error;
        }
        let (mut q, mut p) = (state.q, state.p - self.shift);
        for part in Splitting::<S>::parts() {
            match part {
                Part::Kick(i, share) => {
                    let found = system.later(T::constant(share) * self.h, |system| {
                        p += (system.configuration_force(&q) - self.thrust) * self.kicks[i];
                        system.without_derivative(&q, &nalgebra::zero())
                    });
                    if found.is_some() {
                        return cause_of(system, found).unwrap_or(error);
                    }
                }
                Part::Drift(i) => {
                    let Drift { displacement, loss } = self.drift(i);
                    q += displacement * p;
                    p += loss * p;
                }
            }
        }
        cause_of(system, None).unwrap_or(error)
    }
}

/// G(q) when this share of a step of size `h` has passed.
#[cfg_attr(not(debug_assertions), inline(always))]
fn force_after<L: Explicit<N>, const N: usize>(
    system: &L,
    share: f64,
    h: L::Scalar,
    q: &SVector<L::Scalar, N>,
) -> SVector<L::Scalar, N> {
    system.later(L::Scalar::constant(share) * h, |system| system.configuration_force(q))
}

/// The drifts of a step, each length of them once.
fn once_each<T: Scalar, const N: usize, const C: usize, const S: usize>(
    times: &[T; S],
    drift: impl Fn(T) -> Drift<SMatrix<T, N, C>>,
) -> Result<[Drift<SMatrix<T, N, C>>; S], StepError> {
    let mut drifts = [Drift { displacement: nalgebra::zero(), loss: nalgebra::zero() }; S];
    if let Some((first, second)) = drifts.split_at_mut_checked(S.div_ceil(2)) {
        for (of, &time) in first.iter_mut().zip(times) {
            *of = drift(time);
            StepError::require_finite(&of.displacement, Quantity::Derivatives)?;
            StepError::require_finite(&of.loss, Quantity::Derivatives)?;
        }
        // Of S + 1 drifts the last stands at the front.
        let at_the_front = usize::from(Splitting::<S>::DRIFTS_FIRST);
        for (of, same) in second.iter_mut().rev().zip(first.iter().skip(at_the_front)) {
            *of = *same;
        }
    }
    Ok(drifts)
}

impl<L, const N: usize, const S: usize, C: Sums> Memory<L, Splitting<S, C>, N> for Kicks<L::Scalar, N, S, C>
where
    L: Explicit<N>,
{
    #[inline]
    fn advance(
        &mut self,
        system: &L,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<Step<L::Scalar, N>, StepError> {
        let prepared = match &mut self.prepared {
            Some(prepared) if prepared.h == h => prepared,
            other => other.insert(
                Prepared::new(system, h).map_err(|error| explained(error, &|| cause_of(system, None)))?,
            ),
        };
        let force = match self.force {
            Some((q, force)) if q == state.q && !L::IS_TIMED => force,
            _ => {
                state.require_finite()?;
                if Splitting::<S>::DRIFTS_FIRST {
                    nalgebra::zero()
                } else {
                    system.configuration_force(&state.q) - prepared.thrust
                }
            }
        };
        let mut at = Underway::<_, N, C>::new(state, &prepared.shift, self.end.as_ref());
        let at_end = match (&prepared.drifts, prepared.is_damped) {
            (Drifts::Diagonal(drifts), true) => {
                prepared.carry(system, &mut at, force, drifts, |drift, at| {
                    let p = at.momentum();
                    at.drift(&drift.displacement.component_mul(&p));
                    at.kick(&drift.loss.component_mul(&p));
                })
            }
            (Drifts::Diagonal(drifts), false) => {
                prepared.carry(system, &mut at, force, drifts, |drift, at| {
                    at.drift(&drift.displacement.component_mul(&at.momentum()));
                })
            }
            (Drifts::Full(drifts), true) => prepared.carry(system, &mut at, force, drifts, |drift, at| {
                let p = at.momentum();
                at.drift(&(drift.displacement * p));
                at.kick(&(drift.loss * p));
            }),
            (Drifts::Full(drifts), false) => prepared.carry(system, &mut at, force, drifts, |drift, at| {
                at.drift(&(drift.displacement * at.momentum()));
            }),
        };
        let (end, rests) = at.end();
        end.require_reached().map_err(|error| prepared.explained(system, state, error))?;
        let velocity = (end.q - state.q) / h;
        if cfg!(debug_assertions) {
            system.verify_segment(&Segment { q0: state.q, v: velocity, h })?;
        }
        (self.force, self.end) = (Some((end.q, at_end)), rests);
        Ok(Step { state: end, velocity, report: Report::of_no_equation() })
    }

    fn change_input(&mut self) {
        self.force = None;
    }

    /// A force is kept for its configuration.
    fn change_state(&mut self) {}

    #[inline]
    fn velocity(&self, state: &State<L::Scalar, N>) -> Option<SVector<L::Scalar, N>> {
        let prepared = self.prepared.as_ref()?;
        Some(prepared.inverse_mass? * (state.p - prepared.shift))
    }
}
