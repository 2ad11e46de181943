//! High order from a self-adjoint rule of order 2: symmetric compositions.

use core::array;

use crate::numbers::Scalar;
use crate::rules::SelfAdjoint;
use crate::run::{Checkpoint, ComposedStep, ComposedTrajectory};
use crate::step::{Discrete, Memory, State, StepError};

/// A composition of S substeps γ₁h, …, γ_S h of rule `R`, symmetric (γᵢ = γ_{S+1−i}) and of high order.
///
/// **Derivation.** A self-adjoint rule of order 2, Φ_h = Φ_{−h}⁻¹, is the flow of a modified vector field in
/// even powers of h: Φ_h = exp(h X₁ + h³ X₃ + h⁵ X₅ + …), where X₁ is the motion's own field. Hence
///
/// ```text
/// Φ_{γ_S h} ∘ … ∘ Φ_{γ₁ h} = ∏ᵢ exp(γᵢ h X₁ + γᵢ³ h³ X₃ + γᵢ⁵ h⁵ X₅ + …)
/// ```
///
/// and the order is p if this is exp(h X₁) up to h^{p+1}, whatever the fields are, which need not commute:
///
/// ```text
/// Σ γᵢ = 1,   Σ γᵢ³ = 0,   Σ γᵢ⁵ = 0,   …            and the conditions on products of γᵢ, γⱼ³, … in the order of substeps
/// ```
///
/// Symmetry satisfies those of even order. The coefficients are those that W. Kahan and R.-C. Li (Composition
/// constants for raising the orders of unconventional schemes for ordinary differential equations, Math.
/// Comp. 66, 1997, 1089–1099) found to have small errors among all solutions; with more digits in E. Hairer,
/// C. Lubich and G. Wanner, Geometric Numerical Integration, 2006, equations V.3.11 and V.3.13.
///
/// **Structure.** Every substep is the flow of a discrete Lagrangian system with force, so the composition is
/// too: its L_d is the sum of the substeps' along the way, at step γᵢh. Without force it is symplectic, and
/// it keeps what the substeps keep. Where [`Trapezoidal`](crate::Trapezoidal) is explicit (constant mass,
/// damping linear in v), so is the composition.
///
/// **Damping and negative substeps.** A composition of order above 2 steps backwards at times (Sheng 1989),
/// and backwards friction excites. A substep of either rule multiplies the velocity of a free mass with
/// damping r by (2m − γhr)/(2m + γhr), which is above 1 for γ < 0; the whole step still damps for
///
/// | | free mass decays | ... without ringing | oscillator, r = 0 (trapezoidal) |
/// |---|---|---|---|
/// | order 6 | 0 < hr/m < 2.727 | hr/m < 2.504 | h²k/m < 2.533² |
/// | order 8 | 0 < hr/m < 3.299 | hr/m < 3.299 | h²k/m < 3.096² |
///
/// Beyond, it grows without bound: no error tells, since every substep has its solution. Stiff damping (hr/m
/// near 2 or above) is the business of [`Midpoint`](crate::Midpoint) itself or of implicit rules of high
/// order.
///
/// ```
/// use dalembert::{Composition, State, Trapezoidal, rayleigh_system};
///
/// #[rayleigh_system(rule = trapezoidal)]
/// fn pendulum(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
///     (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
/// }
///
/// let system = Pendulum { r: 0.0 };
/// let start = State::from_velocity(&system, [1.0], [0.0])?;
/// let mut run = Composition::kahan_li_8(Trapezoidal).trajectory(&system, 0.2, start);
/// let end = run.by_ref().take(5000).last().unwrap()?;
/// assert!((end.energy(&system)? - start.energy(&system)?).abs() < 1e-10);
/// assert_eq!(run.time(), 1000.0);
/// # Ok::<(), dalembert::StepError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Composition<R, const S: usize> {
    rule: R,
    shares: [f64; S],
    order: u32,
}

impl<R> Composition<R, 1> {
    /// The rule itself.
    pub(crate) const fn alone(rule: R) -> Self {
        Self { rule, shares: [1.0], order: 2 }
    }
}

impl<R: SelfAdjoint> Composition<R, 9> {
    /// Order 6 in 9 substeps of a self-adjoint `rule` of order 2 (Kahan and Li 1997).
    #[must_use]
    #[expect(clippy::excessive_precision, reason = "the digits published")]
    pub const fn kahan_li_6(rule: R) -> Self {
        let half = [
            0.392_161_444_007_314_139_279_250_56,
            0.332_599_136_789_359_438_599_748_64,
            -0.706_246_172_557_639_359_809_964_82,
            0.082_213_596_293_550_800_231_490_45,
            0.798_543_990_934_829_963_398_950_35,
        ];
        Self { rule, shares: symmetric(&half), order: 6 }
    }
}

impl<R: SelfAdjoint> Composition<R, 17> {
    /// Order 8 in 17 substeps of a self-adjoint `rule` of order 2 (Kahan and Li 1997).
    #[must_use]
    #[expect(clippy::excessive_precision, reason = "the digits published")]
    pub const fn kahan_li_8(rule: R) -> Self {
        let half = [
            0.130_202_483_088_890_080_878_817_63,
            0.561_162_981_775_108_384_561_964_41,
            -0.389_474_962_644_847_286_408_078_60,
            0.158_841_906_555_155_600_896_210_75,
            -0.395_903_894_133_237_577_336_231_54,
            0.184_539_640_978_315_707_091_832_54,
            0.258_374_387_686_322_047_293_979_11,
            0.295_011_723_609_310_298_870_966_24,
            -0.605_508_533_830_034_511_698_921_08,
        ];
        Self { rule, shares: symmetric(&half), order: 8 }
    }
}

/// γ₁ … γ_S from its first half and the middle.
pub(crate) const fn symmetric<const S: usize>(half: &[f64]) -> [f64; S] {
    let mut shares = [0.0; S];
    let mut i = 0;
    while i < S {
        shares[i] = half[if i < half.len() { i } else { S - 1 - i }];
        i += 1;
    }
    shares
}

impl<R, const S: usize> Composition<R, S> {
    /// γ₁ … γ_S: the substeps as shares of the step. They sum to 1; some are negative.
    #[must_use]
    pub const fn shares(&self) -> &[f64; S] {
        &self.shares
    }

    /// The order p: on a fixed interval the error falls as h^p.
    #[must_use]
    pub const fn order(&self) -> u32 {
        self.order
    }

    /// The trajectory of `system` with step size `h` from `state`, at time 0.
    pub fn trajectory<L, const N: usize>(
        self,
        system: &L,
        h: L::Scalar,
        state: State<L::Scalar, N>,
    ) -> ComposedTrajectory<'_, L, Substeps<L, R, N, S>, N>
    where
        L: Discrete<R, N>,
    {
        self.resume(system, Checkpoint::new(h, state))
    }

    /// The run that `checkpoint` was taken of, by this same composition ([`ComposedTrajectory::checkpoint`]).
    pub fn resume<L, const N: usize>(
        self,
        system: &L,
        checkpoint: Checkpoint<L::Scalar, N>,
    ) -> ComposedTrajectory<'_, L, Substeps<L, R, N, S>, N>
    where
        L: Discrete<R, N>,
    {
        ComposedTrajectory::new(system, Substeps::new(&self, checkpoint.step_size), checkpoint)
    }
}

/// The S substeps of a [`Composition`].
///
/// Each remembers the same substep of the steps before ([`Memory`]): those are a step apart; what is known of
/// the state between two substeps is handed on. Where L, R or f take the time, each substep sees its own.
pub struct Substeps<L, R, const N: usize, const S: usize>
where
    L: Discrete<R, N>,
{
    sizes: [L::Scalar; S],
    memories: [L::Memory; S],
}

impl<L, R, const N: usize, const S: usize> Substeps<L, R, N, S>
where
    L: Discrete<R, N>,
{
    pub(crate) fn new(composition: &Composition<R, S>, h: L::Scalar) -> Self {
        Self {
            sizes: composition.shares.map(|share| L::Scalar::constant(share) * h),
            memories: array::from_fn(|_| L::Memory::default()),
        }
    }

    /// The step; `count` is told the iterations of every substep.
    #[inline]
    pub(crate) fn advance_counted(
        &mut self,
        system: &L,
        mut elapsed: f64,
        state: &State<L::Scalar, N>,
        mut count: impl FnMut(u32),
    ) -> Result<State<L::Scalar, N>, StepError> {
        let mut state = *state;
        for (i, &h) in self.sizes.iter().enumerate() {
            let (before, rest) = self.memories.split_at_mut(i);
            let Some((memory, after)) = rest.split_first_mut() else { break };
            // The substep before; of the first, the last of the step before.
            if let Some(previous) = before.last().or(after.last()) {
                memory.follow(previous);
            }
            let step = memory.advance_later(system, elapsed, &state, h)?;
            count(step.report.iterations);
            state = step.state;
            elapsed += h.widen();
        }
        Ok(state)
    }
}

impl<L, R, const N: usize, const S: usize> ComposedStep<L, N> for Substeps<L, R, N, S>
where
    L: Discrete<R, N>,
{
    #[inline]
    fn advance(
        &mut self,
        system: &L,
        elapsed: f64,
        state: &State<L::Scalar, N>,
    ) -> Result<State<L::Scalar, N>, StepError> {
        self.advance_counted(system, elapsed, state, |_| {})
    }

    fn forget(&mut self) {
        self.memories = array::from_fn(|_| L::Memory::default());
    }
}
