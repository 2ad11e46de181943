//! Simplified Newton's method for all stages: sweeps that every stage corrects by one and the same matrix.
//!
//! With M, B, K, C of one point in the middle of the step the stages' equations linearised are
//!
//! ```text
//! I ⊗ M + h A ⊗ (B − C) − h² A² ⊗ K
//! ```
//!
//! and the modes of A take them apart: for each eigenvalue λ the N equations of M + hλ (B − C) − (hλ)² K (J.
//! Butcher 1976; E. Hairer, G. Wanner, *Solving Ordinary Differential Equations II*, section IV.8). That is
//! N³ operations for each pair of stages instead of (S N)³ for all. The sweeps contract where the second
//! derivatives change little in the course of a step, however large they are.
//!
//! Modes stand side by side and are eliminated together, without exchanges of rows. Turned by the angle of λ,
//! the real part of M − (hλ)² K is positive definite where masses and stiffnesses −K are, so that no pivot
//! vanishes. What elimination loses elsewhere is contraction, and Newton's method takes over.

use nalgebra::SVector;

use super::Gauss;
use super::fixed_point::{Corrector, iterate_by};
use super::linearised::Local;
use super::modes::{Mode, modes, number_of_modes};
use super::problem::{Problem, Solution, Solver, widened};
use super::rounding::is_decided;
use crate::numbers::{LaneVector, Lanes, Scalar, lanes::splat};
use crate::system::{ForcedLagrangian, Stages};

/// Solves for the stages from the one velocity `v`, if the sweeps contract.
#[cold]
#[inline(never)]
pub(super) fn iterate<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>(
    problem: &Problem<'_, L, N, S>,
    v: &SVector<T, N>,
) -> Option<Solution<T, N, S>> {
    // Constants, so that it is compiled for the one number of modes.
    if const { number_of_modes(S) == 1 } {
        iterate_by_modes::<T, L, N, S, 1>(problem, v)
    } else if const { number_of_modes(S) == 2 } {
        iterate_by_modes::<T, L, N, S, 2>(problem, v)
    } else if const { number_of_modes(S) == 3 } {
        iterate_by_modes::<T, L, N, S, 3>(problem, v)
    } else {
        iterate_by_modes::<T, L, N, S, 4>(problem, v)
    }
}

fn iterate_by_modes<T, L, const N: usize, const S: usize, const M: usize>(
    problem: &Problem<'_, L, N, S>,
    v: &SVector<T, N>,
) -> Option<Solution<T, N, S>>
where
    T: Scalar,
    L: ForcedLagrangian<N, Scalar = T>,
{
    let half = problem.h * T::constant(0.5);
    let middle = problem.q0.value + v * half;
    let local = problem.system.later(half, |system| Local::new(system, &middle, v));
    let factored = Factored::<T, N, S, M>::new(&local, problem.h)?;
    let solution = iterate_by(problem, &splat(v), &factored)?;
    let floor = problem.floor(&solution.rate, &splat(&SVector::zeros()));
    is_decided(problem, &solution.v, &floor).then_some(solution)
}

/// The modes of S stages side by side, and how stages in W lanes follow from them.
struct WideModes<const S: usize, const M: usize, const W: usize>;

impl<const S: usize, const M: usize, const W: usize> WideModes<S, M, W> {
    const MODES: [Mode<S>; S] = modes(&Gauss::<S>::COEFFICIENTS);

    const EIGENVALUES: [[f64; M]; 2] = {
        let mut parts = [[0.0; M]; 2];
        let mut k = 0;
        while k < M && k < S {
            [parts[0][k], parts[1][k]] = Self::MODES[k].eigenvalue;
            k += 1;
        }
        parts
    };

    /// `LEFT[i]`: the share of stage i in every mode.
    const LEFT: [[[f64; M]; 2]; S] = {
        let mut left = [[[0.0; M]; 2]; S];
        let mut i = 0;
        while i < S {
            let mut k = 0;
            while k < M && k < S {
                [left[i][0][k], left[i][1][k]] = Self::MODES[k].left[i];
                k += 1;
            }
            i += 1;
        }
        left
    };

    /// `RIGHT[k]`: the share of mode k in every stage; the last stage stands in the lanes beyond.
    const RIGHT: [[[f64; W]; 2]; M] = {
        let mut right = [[[0.0; W]; 2]; M];
        let mut k = 0;
        while k < M && k < S {
            let mut parts = [[0.0; S]; 2];
            let mut i = 0;
            while i < S {
                [parts[0][i], parts[1][i]] = Self::MODES[k].right[i];
                i += 1;
            }
            right[k] = [widened(&parts[0]), widened(&parts[1])];
            k += 1;
        }
        right
    };
}

/// A complex number of every mode.
#[derive(Clone, Copy)]
struct Complex<T, const M: usize> {
    re: Lanes<T, M>,
    im: Lanes<T, M>,
}

impl<T: Scalar, const M: usize> Complex<T, M> {
    fn zero() -> Self {
        Self { re: Lanes::splat(T::zero()), im: Lanes::splat(T::zero()) }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn times(self, other: Self) -> Self {
        Self { re: self.re * other.re - self.im * other.im, im: self.re * other.im + self.im * other.re }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn minus(self, other: Self) -> Self {
        Self { re: self.re - other.re, im: self.im - other.im }
    }

    fn reciprocal(self) -> Self {
        let square = self.re * self.re + self.im * self.im;
        Self { re: self.re / square, im: -self.im / square }
    }
}

/// M + hλ (B − C) − (hλ)² K of every mode, as L U; the diagonal holds reciprocals of the pivots.
struct Factored<T, const N: usize, const S: usize, const M: usize> {
    rows: [[Complex<T, M>; N]; N],
}

impl<T: Scalar, const N: usize, const S: usize, const M: usize> Factored<T, N, S, M> {
    /// Factors the matrix of every mode; `None` where a pivot is 0 or not finite.
    fn new(local: &Local<T, N>, h: T) -> Option<Self> {
        let [re, im] = &WideModes::<S, M, S>::EIGENVALUES;
        let along = Complex { re: Lanes::constants(re) * h, im: Lanes::constants(im) * h };
        let square = along.times(along);
        let mut rows = [[Complex::zero(); N]; N];
        for a in 0..N {
            for b in 0..N {
                let by_v = local.momentum_by_q[(a, b)] - local.rate_by_v[(a, b)];
                let by_q = local.rate_by_q[(a, b)];
                rows[a][b] = Complex {
                    re: (along.re * by_v - square.re * by_q) + local.mass[(a, b)],
                    im: along.im * by_v - square.im * by_q,
                };
            }
        }
        let mut is_regular = true;
        for a in 0..N {
            let pivot = rows[a][a].reciprocal();
            rows[a][a] = pivot;
            is_regular &= (pivot.re.abs() + pivot.im.abs()).amax().is_finite();
            let upper = rows[a];
            for row in &mut rows[a + 1..] {
                let factor = row[a].times(pivot);
                row[a] = factor;
                for b in a + 1..N {
                    row[b] = row[b].minus(factor.times(upper[b]));
                }
            }
        }
        is_regular.then_some(Self { rows })
    }

    /// z with A z = `right`.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn solve(&self, right: [Complex<T, M>; N]) -> [Complex<T, M>; N] {
        let mut z = right;
        for a in 0..N {
            for b in 0..a {
                z[a] = z[a].minus(self.rows[a][b].times(z[b]));
            }
        }
        for a in (0..N).rev() {
            for b in a + 1..N {
                z[a] = z[a].minus(self.rows[a][b].times(z[b]));
            }
            z[a] = z[a].times(self.rows[a][a]);
        }
        z
    }
}

impl<T: Scalar, const N: usize, const S: usize, const M: usize> Corrector<T, N> for Factored<T, N, S, M> {
    const SOLVER: Solver = Solver::Simplified;
    const LEAVES_RATES: bool = false;

    /// Σ Re(u z), A z = Σ w r for each mode with matrix A and vectors w and u.
    #[inline]
    fn correction<const W: usize>(&self, stages: &Stages<T, N, W>) -> LaneVector<T, N, W> {
        let mut share = [Complex::zero(); N];
        for a in 0..N {
            for i in 0..S {
                let [re, im] = &WideModes::<S, M, W>::LEFT[i];
                let residual = stages.residual[a].0[i.min(W - 1)];
                share[a].re = Lanes::constants(re).times_plus(false, residual, share[a].re);
                share[a].im = Lanes::constants(im).times_plus(false, residual, share[a].im);
            }
        }
        let z = self.solve(share);
        let mut correction = splat::<T, N, W>(&SVector::zeros());
        for a in 0..N {
            for k in 0..M {
                let [re, im] = &WideModes::<S, M, W>::RIGHT[k];
                correction[a] = Lanes::constants(re).times_plus(false, z[a].re.0[k], correction[a]);
                correction[a] = Lanes::constants(im).times_plus(false, -z[a].im.0[k], correction[a]);
            }
        }
        correction
    }
}
