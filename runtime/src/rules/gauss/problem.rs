//! One step's equations: what the stages' velocities have to satisfy.
//!
//! ```text
//! Q_i = q0 + Σ_j μ_ij (h b_j V_j),   P_i = p0 + Σ_j μ_ij (h b_j G_j),   ∂L/∂v(Q_i, V_i) = P_i,   G = ∂L/∂q + f_L
//! ```

use core::array;

use nalgebra::SVector;

use super::Gauss;
use super::coefficients::Coefficients;
use crate::numbers::{Blank, Compensated, LaneVector, Lanes, Scalar, lanes::lane};
use crate::step::cause::{cause_of, explained};
use crate::step::{Quantity, Report, StepError};
use crate::system::{ForcedLagrangian, GeneratedDiffers, Stages};

/// How many lanes the sweeps of S stages take: as many as vectors hold, where an S in between would be
/// computed in parts. Lanes do not mix, so that numbers stay the same bit by bit.
pub(super) const fn width(stages: usize) -> usize {
    match stages {
        3 => 4,
        5 if cfg!(not(target_feature = "avx")) => 6,
        5..=7 if cfg!(target_feature = "avx") => 8,
        7 => 8,
        _ => stages,
    }
}

/// Calls a function of S stages with their [`width`] for its last parameter.
///
/// The conditions are constants, so that the function is compiled in that width alone.
macro_rules! in_width {
    ($function:ident::<$($type:ty),+; $n:ident, $s:ident>($($argument:expr),*)) => {
        if const { $crate::rules::gauss::problem::width($s) == 4 } {
            $function::<$($type),+, $n, $s, 4>($($argument),*)
        } else if const { $crate::rules::gauss::problem::width($s) == 6 } {
            $function::<$($type),+, $n, $s, 6>($($argument),*)
        } else if const { $crate::rules::gauss::problem::width($s) == 8 } {
            $function::<$($type),+, $n, $s, 8>($($argument),*)
        } else {
            $function::<$($type),+, $n, $s, $s>($($argument),*)
        }
    };
}
pub(super) use in_width;

/// The coefficients of S stages in W lanes.
struct WideCoefficients<const S: usize, const W: usize>;

impl<const S: usize, const W: usize> WideCoefficients<S, W> {
    const NODES: [f64; W] = widened(&Gauss::<S>::COEFFICIENTS.nodes);

    const SHARES: [[f64; W]; S] = {
        let mut shares = [[0.0; W]; S];
        let mut j = 0;
        while j < S {
            shares[j] = widened(&Gauss::<S>::COEFFICIENTS.shares[j]);
            j += 1;
        }
        shares
    };
}

/// The last lane stands for those beyond.
pub(super) const fn widened<const S: usize, const W: usize>(lanes: &[f64; S]) -> [f64; W] {
    let mut wide = [0.0; W];
    let mut i = 0;
    while i < W {
        wide[i] = lanes[if i < S { i } else { S - 1 }];
        i += 1;
    }
    wide
}

/// One step from (q0, p0) with step size h.
pub(super) struct Problem<'a, L: ForcedLagrangian<N>, const N: usize, const S: usize> {
    pub(super) system: &'a L,
    pub(super) q0: Compensated<L::Scalar, N>,
    pub(super) p0: Compensated<L::Scalar, N>,
    pub(super) h: L::Scalar,
    /// h b_j, which sum to h.
    pub(super) steps: [L::Scalar; S],
}

/// h b_j, which sum to h.
#[inline]
pub(super) fn steps<T: Scalar, const S: usize>(h: T) -> [T; S] {
    let mut steps = array::from_fn(|j| T::constant(Gauss::<S>::COEFFICIENTS.weights[j]) * h);
    if S > 2 {
        let inner = steps[1..S - 1].iter().fold(T::zero(), |sum, &step| sum + step);
        steps[0] = (h - inner) * T::constant(0.5);
        steps[S - 1] = steps[0];
    }
    steps
}

/// The method that solved the stages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Solver {
    /// The fixed point, which contracted.
    FixedPoint,
    /// Simplified Newton's method.
    Simplified,
    /// Newton's method.
    Newton,
}

/// The stages of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Solution<T, const N: usize, const S: usize> {
    /// V_i.
    pub(super) v: LaneVector<T, N, S>,
    /// G_i.
    pub(super) rate: LaneVector<T, N, S>,
    pub(super) report: Report<T>,
    pub(super) solver: Solver,
}

impl<'a, T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize> Problem<'a, L, N, S> {
    pub(super) const COEFFICIENTS: &'static Coefficients<S> = &Gauss::<S>::COEFFICIENTS;

    pub(super) fn new(system: &'a L, q0: Compensated<T, N>, p0: Compensated<T, N>, h: T) -> Self {
        Self { system, q0, p0, h, steps: steps(h) }
    }

    /// start + Σ_j μ_ij (h b_j x_j) at every stage i, in W ≥ S lanes.
    ///
    /// Loops, not `array::from_fn`, whose closures are calls; two sums, for each of which the other's
    /// products need not wait.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn at_stages<const W: usize>(
        &self,
        start: &Compensated<T, N>,
        x: &LaneVector<T, N, W>,
    ) -> LaneVector<T, N, W> {
        let steps = Lanes::<T, W>(array::from_fn(|i| self.steps[i.min(S - 1)]));
        let columns = &WideCoefficients::<S, W>::SHARES;
        let is_fused = L::STRUCTURE.fused_multiply_add;
        let mut at = *x;
        for a in 0..N {
            let mut sums = [Lanes::splat(start.rest[a]), Lanes::splat(T::zero())];
            let terms = x[a] * steps;
            for j in 0..S {
                sums[j % 2] = Lanes::constants(&columns[j]).times_plus(is_fused, terms.0[j], sums[j % 2]);
            }
            at[a] = (sums[0] + sums[1]) + start.value[a];
        }
        at
    }

    /// Q_i.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn configurations<const W: usize>(&self, v: &LaneVector<T, N, W>) -> LaneVector<T, N, W> {
        self.at_stages(&self.q0, v)
    }

    /// P_i.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn momenta<const W: usize>(&self, rate: &LaneVector<T, N, W>) -> LaneVector<T, N, W> {
        self.at_stages(&self.p0, rate)
    }

    /// The equations of motion at the stages with velocities `v`, where that is seldom asked for: out of
    /// line.
    #[cold]
    pub(super) fn stages(&self, v: &LaneVector<T, N, S>) -> Stages<T, N, S> {
        self.stages_at(&self.configurations(v), v)
    }

    /// [`stages`](Self::stages) at configurations of their own.
    #[cold]
    #[inline(never)]
    pub(super) fn stages_at(&self, q: &LaneVector<T, N, S>, v: &LaneVector<T, N, S>) -> Stages<T, N, S> {
        self.next_stages_at(&mut Blank::blank(), q, v)
    }

    /// The equations of motion at the stages with velocities `v`, with the `anchors` that the sweeps before
    /// have left.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn next_stages<const W: usize>(
        &self,
        anchors: &mut L::Anchors<W>,
        v: &LaneVector<T, N, W>,
    ) -> Stages<T, N, W> {
        self.next_stages_at(anchors, &self.configurations(v), v)
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn next_stages_at<const W: usize>(
        &self,
        anchors: &mut L::Anchors<W>,
        q: &LaneVector<T, N, W>,
        v: &LaneVector<T, N, W>,
    ) -> Stages<T, N, W> {
        let elapsed = Lanes(array::from_fn(|i| T::constant(WideCoefficients::<S, W>::NODES[i]) * self.h));
        self.system.stages_in_time(anchors, &elapsed, q, v, |rate| self.momenta(rate))
    }

    /// c_i h, the time of a stage from the start of the step.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn elapsed(&self, i: usize) -> T {
        T::constant(Self::COEFFICIENTS.nodes[i]) * self.h
    }

    /// Verifies the system at the stages with velocities `v`.
    pub(super) fn verify(&self, v: &LaneVector<T, N, S>) -> Result<(), GeneratedDiffers> {
        let q = self.configurations(v);
        (0..S).try_for_each(|i| {
            self.system.later(self.elapsed(i), |system| system.verify_generated(&lane(&q, i), &lane(v, i)))
        })
    }

    /// The error of the equations at stages with velocities `v`, whose coordinate `index` is not finite.
    #[cfg_attr(feature = "std", cold)]
    #[cfg_attr(not(feature = "std"), inline(always))]
    pub(super) fn not_finite(&self, index: usize, v: &LaneVector<T, N, S>) -> StepError {
        explained(StepError::NonFinite { quantity: Quantity::Derivatives, index }, &|| {
            let q = self.configurations(v);
            // A loop: an iterator's would be many functions more to compile for each system.
            for i in 0..S {
                let (q, v) = (lane(&q, i), lane(v, i));
                let found = self.system.later(self.elapsed(i), |at| at.without_derivative(&q, &v));
                if found.is_some() {
                    return cause_of(self.system, found);
                }
            }
            cause_of(self.system, None)
        })
    }

    /// h a_ij.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn share(&self, i: usize, j: usize) -> T {
        T::constant(Self::COEFFICIENTS.shares[j][i]) * self.steps[j]
    }

    /// Σ_j h b_j x_j.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn sum(&self, x: &LaneVector<T, N, S>) -> SVector<T, N> {
        SVector::from_fn(|a, _| {
            let mut sum = T::zero();
            for j in 0..S {
                sum += self.steps[j] * x[a].0[j];
            }
            sum
        })
    }

    /// The round-off floor of the momentum equations: 4ε (|p0| + |h| max |G_i| + max |P_i − ∂L/∂v|),
    /// coordinate by coordinate.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn floor<const W: usize>(
        &self,
        rate: &LaneVector<T, N, W>,
        residual: &LaneVector<T, N, W>,
    ) -> SVector<T, N> {
        let unit = T::EPSILON * T::constant(4.0);
        SVector::from_fn(|a, _| {
            let terms = self.p0.value[a].abs() + residual[a].amax();
            let size = terms * unit + (self.h * unit).abs() * rate[a].amax();
            size + T::SMALLEST_NORMAL
        })
    }
}

/// The largest residual in units of its floor; not finite where one is not.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn in_units_of<T: Scalar, const N: usize, const S: usize>(
    residual: &LaneVector<T, N, S>,
    floor: &SVector<T, N>,
) -> T {
    in_units(residual, &reciprocals(floor))
}

/// 1/floor; not a number where the floor is none, so that no residual is small beside it.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn reciprocals<T: Scalar, const N: usize>(floor: &SVector<T, N>) -> SVector<T, N> {
    floor.map(|floor| T::one() / floor + floor * T::zero())
}

/// As [`in_units_of`], with the reciprocals of the floors.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) fn in_units<T: Scalar, const N: usize, const S: usize>(
    residual: &LaneVector<T, N, S>,
    per_floor: &SVector<T, N>,
) -> T {
    let mut largest = Lanes::<T, S>::splat(T::zero());
    let mut sum = largest;
    for a in 0..N {
        let units = residual[a].abs() * per_floor[a];
        largest = largest.larger(units);
        // In the sum NaN and infinity stay.
        sum = sum + units;
    }
    largest.largest_unless(sum)
}
