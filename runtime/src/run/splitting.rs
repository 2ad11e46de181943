//! High order from kicks and exact drifts: Runge–Kutta–Nyström splittings.

mod force_work;
mod lanes;

use nalgebra::{SMatrix, SVector};

use crate::numbers::Scalar;
use crate::rules::{Drift, modes, require_positive_definite};
use crate::run::{Explicit, composition::symmetric};
use crate::step::{
    Flow, Linearization, Memory, PhaseMatrix, Quantity, Report, State, StateBy, Step, StepError, StepWith,
};

/// A splitting of the motion into kicks by the potential and damped free motions between, S of them,
/// symmetric and of high order: for L = ½vᵀMv − V(q) and R = ½vᵀCv with constant M, positive definite, and C,
/// and a force f(q).
///
/// **Derivation.** The motion's vector field is A + B, with flows that are known exactly:
///
/// ```text
/// A:  q̇ = v,  ṗ = −Cv,  p = Mv          q += M⁻¹ϕ(τCM⁻¹) τ p,  p ← exp(−τCM⁻¹) p,    ϕ(z) = (1 − e⁻ᶻ)/z
/// B:  q̇ = 0,  ṗ = G(q) = −∇V(q) + f(q)  p += τ G(q)
/// step = B(b₁h) A(a₁h) B(b₂h) … A(a_S h) B(b₁h),                  aᵢ = a_{S+1−i},  Σ aᵢ = Σ bᵢ = 1
/// ```
///
/// B lowers the degree in p of a field by one, A raises it by one at most, with damping as without. So
/// brackets with two B more than A are 0: `[B,[B,[B,A]]]`, and of five letters those that A and B make with
/// it. Without damping no others of up to five vanish, and a symmetric step of order 6 looks no further: the
/// conditions of its order are those without damping, fewer than for fields of any kind. The coefficients are
/// those of S. Blanes and P. C. Moan (Practical symplectic partitioned Runge–Kutta and Runge–Kutta–Nyström
/// methods, J. Comput. Appl. Math. 142, 2002, 313–330). A step costs S gradients and no equation is solved.
///
/// **Structure.** Each kick with the drift after it is the flow of a discrete Lagrangian system with force.
/// Self-adjoint. Symplectic where C = 0. The determinant of the step is e^{−h tr M⁻¹C}, that of the flow, for
/// every V; where C = 2aM, AᵀΩA = e^{−2ah}Ω, and an angular momentum of a radial V falls by e^{−2ah} a step,
/// exactly.
///
/// **Stability.** A free mass decays as its motion does, for any hr/m and without ringing, although some
/// drifts lead backwards: those are undone exactly. With ω² = k/m, the powers of the step are bounded for an
/// oscillator without damping for
///
/// | | | but for resonances near hω = π, 2π, where they grow |
/// |---|---|---|
/// | order 4 | hω < 5.026 | 3.1634 < hω < 3.1686, by 0.24 % a step at most |
/// | order 6 | hω < 9.073 | 3.1414 < hω < 3.1424, 6.3478 < hω < 6.3493, by 0.07 % a step at most |
///
/// and decay up to hω = 5 and 9 with damping of 0.01 ≤ hr/m ≤ 10. Where damping is stiff the error falls more
/// slowly than the order says, as by all splittings; there [`Fitted`](crate::Fitted) and
/// [`Gauss`](crate::Gauss) rules serve.
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
pub struct Splitting<const S: usize> {
    made: (),
}

impl Splitting<6> {
    /// Order 4 with 6 gradients a step (Blanes and Moan 2002, SRKN₆ᵇ).
    #[must_use]
    pub const fn blanes_moan_4() -> Self {
        Self { made: () }
    }
}

impl Splitting<11> {
    /// Order 6 with 11 gradients a step (Blanes and Moan 2002, SRKN₁₁ᵇ).
    #[must_use]
    pub const fn blanes_moan_6() -> Self {
        Self { made: () }
    }
}

/// a₁ … and b₁ …, the coefficients published; the last of each follows from the sums.
type Published = (&'static [f64], &'static [f64]);

const BLANES_MOAN_4: Published = {
    const A: [f64; 2] = [0.245_298_957_184_271, 0.604_872_665_711_080];
    const B: [f64; 3] = [0.082_984_406_417_405_2, 0.396_309_801_498_368, -0.039_056_304_922_348_6];
    (&[A[0], A[1], 0.5 - (A[0] + A[1])], &[B[0], B[1], B[2], 1.0 - 2.0 * (B[0] + B[1] + B[2])])
};

const BLANES_MOAN_6: Published = {
    const A: [f64; 5] = [
        0.123_229_775_946_271,
        0.290_553_797_799_558,
        -0.127_049_212_625_417,
        -0.246_331_761_062_075,
        0.357_208_872_795_928,
    ];
    const B: [f64; 5] = [
        0.041_464_998_518_262_4,
        0.198_128_671_918_067,
        -0.040_006_192_104_153_3,
        0.075_253_984_301_580_7,
        -0.011_511_387_420_687_9,
    ];
    (
        &[A[0], A[1], A[2], A[3], A[4], 1.0 - 2.0 * (A[0] + A[1] + A[2] + A[3] + A[4])],
        &[B[0], B[1], B[2], B[3], B[4], 0.5 - (B[0] + B[1] + B[2] + B[3] + B[4])],
    )
};

/// b₁ … b_S of S + 1 kicks that read the same from either end.
const fn kicks<const S: usize>(half: &[f64]) -> [f64; S] {
    let mut kicks = [0.0; S];
    let mut i = 0;
    while i < S {
        kicks[i] = half[if i < half.len() { i } else { S - i }];
        i += 1;
    }
    kicks
}

impl<const S: usize> Splitting<S> {
    const PUBLISHED: Published = match S {
        6 => BLANES_MOAN_4,
        11 => BLANES_MOAN_6,
        _ => panic!("no such splitting is made"),
    };

    const DRIFTS: [f64; S] = symmetric(Self::PUBLISHED.0);
    const KICKS: [f64; S] = kicks(Self::PUBLISHED.1);

    /// a₁ … a_S: the drifts as shares of the step. They sum to 1; some are negative.
    #[must_use]
    pub const fn drifts(&self) -> &'static [f64; S] {
        &Self::DRIFTS
    }

    /// b₁ … b_S: the kick before each drift. The one after the last is b₁ again, and with it they sum to 1.
    #[must_use]
    pub const fn kicks(&self) -> &'static [f64; S] {
        &Self::KICKS
    }

    /// The order p: on a fixed interval the error falls as h^p.
    #[must_use]
    pub const fn order(&self) -> u32 {
        if S == 6 { 4 } else { 6 }
    }
}

impl<L, const N: usize, const S: usize> Flow<Splitting<S>, N> for L
where
    L: Explicit<N>,
{
    type RunMemory = Kicks<L::Scalar, N, S>;

    /// No equation is solved: no guess serves.
    #[inline]
    fn step(
        &self,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
        _guess: Option<&SVector<L::Scalar, N>>,
    ) -> Result<Step<L::Scalar, N>, StepError> {
        Memory::<L, Splitting<S>, N>::advance(&mut Kicks::default(), self, state, h)
    }

    /// The product of the kicks' and drifts' derivatives.
    fn linearized_step(
        &self,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
        _guess: Option<&SVector<L::Scalar, N>>,
    ) -> Result<StepWith<L::Scalar, N, Linearization<L::Scalar, N>>, StepError> {
        let prepared = Prepared::<L::Scalar, N, S>::new(self, h)?;
        let mut kicks = Kicks { prepared: Some(prepared), force: None };
        let step = Memory::<L, Splitting<S>, N>::advance(&mut kicks, self, state, h)?;
        Ok((step, Linearization { a: prepared.derivative(self, state)?, b: StateBy::zero() }))
    }
}

/// The kicks and drifts of a [`Splitting`].
///
/// What the drifts do is worked out in the first step of a size. The force at the end of a step is that at
/// the start of the next. It belongs to one system.
#[derive(Clone, Copy, Debug)]
pub struct Kicks<T, const N: usize, const S: usize> {
    prepared: Option<Prepared<T, N, S>>,
    /// A configuration, and G − ∂R/∂v(0) there.
    force: Option<(SVector<T, N>, SVector<T, N>)>,
}

impl<T, const N: usize, const S: usize> Default for Kicks<T, N, S> {
    fn default() -> Self {
        Self { prepared: None, force: None }
    }
}

/// What depends on the step size alone.
#[derive(Clone, Copy, Debug)]
struct Prepared<T, const N: usize, const S: usize> {
    h: T,
    /// bᵢh.
    kicks: [T; S],
    drifts: Drifts<T, N, S>,
    /// Without damping no drift changes p.
    is_damped: bool,
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
            shift: l.d2,
            thrust: r.d2,
        })
    }

    /// The step with `drift` for the i-th drift of (q, p − ∂L/∂v(0)), from where the force is `force`; the
    /// force at its end.
    #[inline(always)]
    fn carried<L: Explicit<N, Scalar = T>, D>(
        &self,
        system: &L,
        state: &State<T, N>,
        mut force: SVector<T, N>,
        drifts: &[D; S],
        drift: impl Fn(&D, &mut SVector<T, N>, &mut SVector<T, N>),
    ) -> (State<T, N>, SVector<T, N>) {
        let (mut q, mut p) = (state.q, state.p - self.shift);
        for (&kick, of) in self.kicks.iter().zip(drifts) {
            p += force * kick;
            drift(of, &mut q, &mut p);
            force = system.configuration_force(&q) - self.thrust;
        }
        let closing = self.kicks.first().map_or(T::zero(), |&kick| kick);
        (State { q, p: p + force * closing + self.shift }, force)
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
        for i in 0..=S {
            let slope =
                system.lagrangian_derivatives(&q, &rest).d11 + system.general_force_derivatives(&q, &rest).d1;
            let kick = self.kicks[i % S];
            a.p_by_q += slope * a.q_by_q * kick;
            a.p_by_p += slope * a.q_by_p * kick;
            if i == S {
                break;
            }
            p += (system.configuration_force(&q) - self.thrust) * kick;
            let Drift { displacement, loss } = self.drift(i);
            a.q_by_q += displacement * a.p_by_q;
            a.q_by_p += displacement * a.p_by_p;
            a.p_by_q = (identity + loss) * a.p_by_q;
            a.p_by_p = (identity + loss) * a.p_by_p;
            q += displacement * p;
            p += loss * p;
        }
        let entries = [&a.q_by_q, &a.q_by_p, &a.p_by_q, &a.p_by_p];
        entries.into_iter().try_for_each(|block| StepError::require_finite(block, Quantity::Derivatives))?;
        Ok(a)
    }
}

/// The drifts over times that read the same from either end, each of them once.
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
        for (of, same) in second.iter_mut().rev().zip(first) {
            *of = *same;
        }
    }
    Ok(drifts)
}

impl<L, const N: usize, const S: usize> Memory<L, Splitting<S>, N> for Kicks<L::Scalar, N, S>
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
            other => other.insert(Prepared::new(system, h)?),
        };
        let force = match self.force {
            Some((q, force)) if q == state.q => force,
            _ => {
                state.require_finite()?;
                system.configuration_force(&state.q) - prepared.thrust
            }
        };
        let (end, force) = match (&prepared.drifts, prepared.is_damped) {
            (Drifts::Diagonal(drifts), true) => {
                prepared.carried(system, state, force, drifts, |drift, q, p| {
                    *q += drift.displacement.component_mul(p);
                    *p += drift.loss.component_mul(p);
                })
            }
            (Drifts::Diagonal(drifts), false) => {
                prepared.carried(system, state, force, drifts, |drift, q, p| {
                    *q += drift.displacement.component_mul(p);
                })
            }
            (Drifts::Full(drifts), true) => prepared.carried(system, state, force, drifts, |drift, q, p| {
                *q += drift.displacement * *p;
                *p += drift.loss * *p;
            }),
            (Drifts::Full(drifts), false) => prepared.carried(system, state, force, drifts, |drift, q, p| {
                *q += drift.displacement * *p;
            }),
        };
        end.require_finite()?;
        let velocity = (end.q - state.q) / h;
        if cfg!(debug_assertions) {
            system.verify_segment(&state.q, &velocity, h)?;
        }
        self.force = Some((end.q, force));
        Ok(Step { state: end, velocity, report: Report::of_no_equation() })
    }
}
