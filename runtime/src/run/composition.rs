//! High order from a self-adjoint rule of order 2: symmetric compositions.

use core::array;

use nalgebra::SVector;

use crate::numbers::Scalar;
use crate::rules::SelfAdjoint;
use crate::step::{
    EnergyExchange, Flow, ForceWork, LinearizedStep, Memory, PhaseMatrix, Report, State, Step, StepError,
};
use crate::system::GeneratedDiffers;

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
/// use dalembert::{Composition, Discretise, State, Trapezoidal, rayleigh_system};
///
/// #[rayleigh_system(rule = trapezoidal)]
/// fn pendulum(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
///     (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
/// }
///
/// let system = Pendulum { r: 0.0 };
/// let start = State::from_velocity(&system, [1.0], [0.0])?;
/// let mut run = system.by(Composition::kahan_li_8(Trapezoidal), 0.2).run(start);
/// let end = run.by_ref().take(5000).last().unwrap()?.state;
/// assert!((end.energy(&system)? - start.energy(&system)?).abs() < 1e-10);
/// assert_eq!(run.time(), 1000.0);
/// # Ok::<(), dalembert::StepError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Composition<R, const S: usize> {
    rule: R,
}

impl<R: SelfAdjoint> Composition<R, 9> {
    /// Order 6 in 9 substeps of a self-adjoint `rule` of order 2 (Kahan and Li 1997).
    #[must_use]
    pub const fn kahan_li_6(rule: R) -> Self {
        Self { rule }
    }
}

impl<R: SelfAdjoint> Composition<R, 17> {
    /// Order 8 in 17 substeps of a self-adjoint `rule` of order 2 (Kahan and Li 1997).
    #[must_use]
    pub const fn kahan_li_8(rule: R) -> Self {
        Self { rule }
    }
}

/// γ₁ … γ₅ of order 6.
#[expect(clippy::excessive_precision, reason = "the digits published")]
const KAHAN_LI_6: [f64; 5] = [
    0.392_161_444_007_314_139_279_250_56,
    0.332_599_136_789_359_438_599_748_64,
    -0.706_246_172_557_639_359_809_964_82,
    0.082_213_596_293_550_800_231_490_45,
    0.798_543_990_934_829_963_398_950_35,
];

/// γ₁ … γ₉ of order 8.
#[expect(clippy::excessive_precision, reason = "the digits published")]
const KAHAN_LI_8: [f64; 9] = [
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
    pub(crate) const SHARES: [f64; S] = match S {
        9 => symmetric(&KAHAN_LI_6),
        17 => symmetric(&KAHAN_LI_8),
        _ => panic!("no such composition is made"),
    };

    /// γ₁ … γ_S: the substeps as shares of the step. They sum to 1; some are negative.
    #[must_use]
    pub const fn shares(&self) -> &'static [f64; S] {
        &Self::SHARES
    }

    /// The order p: on a fixed interval the error falls as h^p.
    #[must_use]
    pub const fn order(&self) -> u32 {
        if S == 9 { 6 } else { 8 }
    }
}

impl<L, R, const N: usize, const S: usize> Flow<Composition<R, S>, N> for L
where
    R: SelfAdjoint,
    L: Flow<R, N>,
{
    type RunMemory = Substeps<L, R, N, S>;

    /// `guess` is one for the first substep's.
    #[inline]
    fn step(
        &self,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
        guess: Option<&SVector<L::Scalar, N>>,
    ) -> Result<Step<L::Scalar, N>, StepError> {
        let mut substeps = Substeps::<L, R, N, S>::default();
        if let Some(velocity) = guess {
            substeps.suggest(velocity, h);
        }
        substeps.advance(self, state, h)
    }

    /// The product of the substeps' derivatives.
    fn linearized_step(
        &self,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
        guess: Option<&SVector<L::Scalar, N>>,
    ) -> Result<LinearizedStep<L::Scalar, N>, StepError> {
        let mut summary = Summary::new();
        let (mut end, mut elapsed, mut guess) = (*state, L::Scalar::constant(0.0), guess.copied());
        let mut a = PhaseMatrix::identity();
        for share in Composition::<R, S>::SHARES {
            let part = L::Scalar::constant(share) * h;
            let (step, by) = self
                .later(elapsed, |system| Flow::<R, N>::linearized_step(system, &end, part, guess.as_ref()))?;
            summary.add(&step.report);
            a = by * a;
            (end, guess) = (step.state, Some(step.velocity));
            elapsed += part;
        }
        Ok((summary.step(state, &end, h), a))
    }
}

/// The sum over the substeps. One backwards gives back what friction would have taken on the way.
impl<L, R, const N: usize, const S: usize> ForceWork<Composition<R, S>, N> for L
where
    R: SelfAdjoint,
    L: ForceWork<R, N>,
{
    fn energy_exchange(
        &self,
        from: &State<L::Scalar, N>,
        _to: &State<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<EnergyExchange<L::Scalar>, StepError> {
        if !L::IS_FORCED {
            return Ok(EnergyExchange::zero());
        }
        let (mut at, mut elapsed, mut guess) = (*from, L::Scalar::constant(0.0), None);
        let mut sum = EnergyExchange::zero();
        for share in Composition::<R, S>::SHARES {
            let part = L::Scalar::constant(share) * h;
            let (step, exchange) = self.later(elapsed, |system| {
                let step = Flow::<R, N>::step(system, &at, part, guess.as_ref())?;
                ForceWork::<R, N>::energy_exchange(system, &at, &step.state, part).map(|of| (step, of))
            })?;
            sum = sum + exchange;
            (at, guess) = (step.state, Some(step.velocity));
            elapsed += part;
        }
        Ok(sum)
    }
}

/// The S substeps of a [`Composition`].
///
/// Each remembers the same substep of the steps before ([`Memory`]): those are a step apart; what is known of
/// the state between two substeps is handed on. Where L, R or f take the time, each substep sees its own.
pub struct Substeps<L, R, const N: usize, const S: usize>
where
    L: Flow<R, N>,
{
    memories: [L::RunMemory; S],
}

impl<L: Flow<R, N>, R, const N: usize, const S: usize> Default for Substeps<L, R, N, S> {
    fn default() -> Self {
        Self { memories: array::from_fn(|_| L::RunMemory::default()) }
    }
}

impl<L, R, const N: usize, const S: usize> Memory<L, Composition<R, S>, N> for Substeps<L, R, N, S>
where
    R: SelfAdjoint,
    L: Flow<R, N>,
{
    #[inline]
    fn advance(
        &mut self,
        system: &L,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<Step<L::Scalar, N>, StepError> {
        self.advance_later(system, 0.0, state, h)
    }

    fn verify_momenta(system: &L, state: &State<L::Scalar, N>, h: L::Scalar) -> Result<(), GeneratedDiffers> {
        <L::RunMemory as Memory<L, R, N>>::verify_momenta(system, state, h)
    }

    fn suggest(&mut self, velocity: &SVector<L::Scalar, N>, h: L::Scalar) {
        for (memory, share) in self.memories.iter_mut().zip(Composition::<R, S>::SHARES) {
            memory.suggest(velocity, L::Scalar::constant(share) * h);
        }
    }

    fn change_input(&mut self) {
        self.memories.iter_mut().for_each(Memory::<L, R, N>::change_input);
    }

    fn change_state(&mut self) {
        self.memories.iter_mut().for_each(Memory::<L, R, N>::change_state);
    }

    #[inline]
    fn advance_later(
        &mut self,
        system: &L,
        elapsed: f64,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<Step<L::Scalar, N>, StepError> {
        let found = self.taken(system, elapsed, state, h);
        // On constraints a guess may lead to another root than the state, from where the next substep has
        // none.
        if L::IS_CONSTRAINED && found.is_err() {
            *self = Self::default();
            return self.taken(system, elapsed, state, h);
        }
        found
    }
}

impl<L: Flow<R, N>, R, const N: usize, const S: usize> Substeps<L, R, N, S> {
    #[inline]
    fn taken(
        &mut self,
        system: &L,
        mut elapsed: f64,
        state: &State<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<Step<L::Scalar, N>, StepError> {
        let mut summary = Summary::new();
        let mut end = *state;
        for (i, share) in Composition::<R, S>::SHARES.into_iter().enumerate() {
            let part = L::Scalar::constant(share) * h;
            let (before, rest) = self.memories.split_at_mut(i);
            let Some((memory, after)) = rest.split_first_mut() else { break };
            // The substep before; of the first, the last of the step before.
            if let Some(previous) = before.last().or(after.last()) {
                memory.follow(previous);
            }
            let step = memory.advance_later(system, elapsed, &end, part)?;
            summary.add(&step.report);
            end = step.state;
            elapsed += part.widen();
        }
        Ok(summary.step(state, &end, h))
    }
}

/// How the substeps of a step went: iterations added up, the residual that is worst in units of its floor.
struct Summary<S> {
    report: Report<S>,
}

impl<T: Scalar> Summary<T> {
    #[inline]
    fn new() -> Self {
        Self { report: Report::of_no_equation() }
    }

    #[inline]
    fn add(&mut self, of: &Report<T>) {
        let Report { iterations, damped, residual, floor, last_correction } = &mut self.report;
        *iterations += of.iterations;
        *damped += of.damped;
        if of.residual * *floor >= *residual * of.floor {
            (*residual, *floor) = (of.residual, of.floor);
        }
        *last_correction = of.last_correction;
    }

    #[inline]
    fn step<const N: usize>(self, start: &State<T, N>, end: &State<T, N>, h: T) -> Step<T, N> {
        Step { state: *end, velocity: (end.q - start.q) / h, report: self.report }
    }
}
