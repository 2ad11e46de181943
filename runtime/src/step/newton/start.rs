//! Where Newton's method starts where rest is a singular point.
//!
//! At v̄ = 0 a drag such as c|v|³ has a Hessian of 0·∞, and a kinetic energy such as |v|⁴ none to solve with.
//! Each coordinate is then moved alone to where its own residual changes sign, to a factor of 2. Powers of 2
//! from the smallest to the largest number: no unit of length, time or mass is preferred.
//!
//! A coordinate whose residual vanishes with its velocity rests in the solution too. Where its derivatives do
//! not exist at rest, it is taken out of the equation, and the solution of the others is held against its
//! residual next to rest.

use nalgebra::{SMatrix, SVector};

use super::{Equations, Reached, Solution, careful};
use crate::numbers::{NewtonMatrix, Scalar};
use crate::step::{Momenta, Report, State, StepError, StepKernel};

/// A residual that grows by this factor where the velocity doubles vanishes at rest: one that is constant
/// next to rest does not grow, drag through a root does by a root of 2.
const VANISHING: f64 = 1.0625;

/// The root that is reached from rest or, where rest is a singular point, from away from it. From `tried`
/// there was `error`.
///
/// # Errors
/// What Newton's method from rest ends with; `error` where it has been there or cannot start there.
#[cold]
#[inline(never)]
pub(crate) fn from_rest<S: Scalar, M: NewtonMatrix<S, N>, const N: usize>(
    of: &Equations<'_, S, M, N>,
    tried: &SVector<S, N>,
    error: StepError,
) -> Result<Solution<S, N>, StepError> {
    let State { q, p } = of.state;
    let rest = nalgebra::zero();
    let residual = |v: &SVector<S, N>| (of.finish)(q, v).p0 - p;
    let at_rest = residual(&rest);
    let from = |v| careful(of, Reached { v, iterations: 0 });
    if at_rest != rest && (of.evaluate)(q, &rest).matrix.solve(&at_rest).is_ok() {
        return if *tried == rest { Err(error) } else { from(rest) };
    }
    let near = near_rest(&residual);
    let resting = vanishing(&residual, p, &rest, &near);
    if resting.iter().all(|rests| *rests) {
        return Ok(rest_itself(of, &near));
    }
    let start = away_from_rest(&residual, &near, &resting);
    if start != *tried
        && let Ok(solution) = from(start)
    {
        return Ok(solution);
    }
    let others = resting.iter().any(|rests| *rests).then(|| without(of, start, &near, &resting));
    others.flatten().ok_or(error)
}

/// Whether the `residual` vanishes with the velocity in every coordinate, so that rest is its root.
#[cold]
pub(crate) fn is_rest<S: Scalar, const N: usize>(
    residual: &dyn Fn(&SVector<S, N>) -> SVector<S, N>,
    p: &SVector<S, N>,
) -> bool {
    vanishing(residual, p, &nalgebra::zero(), &near_rest(residual)).iter().all(|rests| *rests)
}

/// A velocity so small that only what is constant is left of the residual, but at which it is a number in
/// every coordinate. No two entries are alike.
#[cold]
fn near_rest<S: Scalar, const N: usize>(residual: &dyn Fn(&SVector<S, N>) -> SVector<S, N>) -> SVector<S, N> {
    let mut size = S::SMALLEST_NORMAL;
    let mut near = SVector::from_element(size);
    while size < S::EPSILON {
        for i in 0..N {
            near[i] = size * (S::one() + S::constant(i as f64) / S::constant(N as f64));
        }
        if residual(&near).iter().all(|entry| entry.is_finite()) {
            break;
        }
        size *= S::constant(256.0);
    }
    near
}

/// The coordinates whose residual vanishes as they come to rest, the others as in `v`; `near` is next to
/// rest. Where derivatives do not exist at rest, p has to be 0: one that is small beside that of `near` could
/// not be told from it.
#[cold]
fn vanishing<S: Scalar, const N: usize>(
    residual: &dyn Fn(&SVector<S, N>) -> SVector<S, N>,
    p: &SVector<S, N>,
    v: &SVector<S, N>,
    near: &SVector<S, N>,
) -> [bool; N] {
    let exact = residual(v);
    let [once, twice] = [S::one(), S::constant(2.0)]
        .map(|factor| residual(&v.zip_map(near, |v, near| if v == S::zero() { near * factor } else { v })));
    core::array::from_fn(|i| {
        v[i] == S::zero()
            && (exact[i] == S::zero()
                || p[i] == S::zero()
                    && !exact[i].is_finite()
                    && twice[i].abs() >= once[i].abs() * S::constant(VANISHING))
    })
}

/// Rest, with the momenta that it has in the limit.
#[cold]
fn rest_itself<S: Scalar, M, const N: usize>(
    of: &Equations<'_, S, M, N>,
    near: &SVector<S, N>,
) -> Solution<S, N> {
    let State { q, p } = of.state;
    let Momenta { p0, p1 } = (of.finish)(q, &nalgebra::zero());
    let change = if p0 == *p { p1 - p0 } else { change_at_rest(of, near, &-near) };
    let (residual, last_correction) = (S::zero(), S::zero());
    let report = Report { iterations: 0, damped: 0, residual, floor: S::SMALLEST_NORMAL, last_correction };
    Solution { unknown: nalgebra::zero(), momenta: Momenta { p0: *p, p1: p + change }, report }
}

/// p1 − p0 at rest, as the mean of both sides: what is odd in the velocity vanishes there.
#[cold]
fn change_at_rest<S: Scalar, M, const N: usize>(
    of: &Equations<'_, S, M, N>,
    one: &SVector<S, N>,
    other: &SVector<S, N>,
) -> SVector<S, N> {
    let change = |v: &SVector<S, N>| {
        let Momenta { p0, p1 } = (of.finish)(&of.state.q, v);
        p1 - p0
    };
    (change(one) + change(other)) * S::constant(0.5)
}

/// The solution in which the coordinates `resting` rest: they are held, the equations of the others are
/// solved from `start`.
#[cold]
#[inline(never)]
fn without<S: Scalar, M: NewtonMatrix<S, N>, const N: usize>(
    of: &Equations<'_, S, M, N>,
    start: SVector<S, N>,
    near: &SVector<S, N>,
    resting: &[bool; N],
) -> Option<Solution<S, N>> {
    let State { p, .. } = of.state;
    let moved = |v: &SVector<S, N>, sign: S| {
        let mut moved = *v;
        for (i, &rests) in resting.iter().enumerate() {
            if rests && let (Some(entry), Some(near)) = (moved.get_mut(i), near.get(i)) {
                *entry = *near * sign;
            }
        }
        moved
    };
    let held = |covector: SVector<S, N>| {
        SVector::<S, N>::from_fn(|i, _| if resting.get(i) == Some(&true) { p[i] } else { covector[i] })
    };
    let evaluate = |q: &SVector<S, N>, v: &SVector<S, N>| {
        let StepKernel { p0, matrix } = (of.evaluate)(q, v);
        let rests = |i: usize| resting.get(i) == Some(&true);
        let matrix = SMatrix::<S, N, N>::from_fn(|i, j| match (rests(i) || rests(j), i == j) {
            (false, _) => matrix.entry(i, j),
            (true, true) => S::one(),
            (true, false) => S::zero(),
        });
        StepKernel { p0: held(p0), matrix }
    };
    let finish = |q: &SVector<S, N>, v: &SVector<S, N>| {
        let Momenta { p0, p1 } = (of.finish)(q, v);
        let change = change_at_rest(of, &moved(v, S::one()), &moved(v, -S::one()));
        let p1 =
            SVector::from_fn(|i, _| if resting.get(i) == Some(&true) { p[i] + change[i] } else { p1[i] });
        Momenta { p0: held(p0), p1 }
    };
    let Equations { inertia, cancelling, state, h, .. } = *of;
    let others = Equations { evaluate: &evaluate, finish: &finish, inertia, cancelling, state, h };
    let solution = careful(&others, Reached { v: start, iterations: 0 }).ok()?;
    let found = vanishing(&|v| (of.finish)(&of.state.q, v).p0 - p, p, &solution.unknown, near);
    resting.iter().zip(found).all(|(rests, found)| !rests || found).then_some(solution)
}

/// A velocity of the order of the root's, with the directions in which the `residual` at rest falls; those
/// `resting` stay.
#[cold]
#[inline(never)]
fn away_from_rest<S: Scalar, const N: usize>(
    residual: &dyn Fn(&SVector<S, N>) -> SVector<S, N>,
    near: &SVector<S, N>,
    resting: &[bool; N],
) -> SVector<S, N> {
    // 2, 2², 2⁴, …, 2⁵¹²; infinite where the type has no such numbers.
    let mut factors = [S::one() + S::one(); 10];
    let mut power = S::one() + S::one();
    for factor in &mut factors {
        *factor = power;
        power *= power;
    }
    let at_rest = residual(near);
    let mut start: SVector<S, N> = nalgebra::zero();
    for (i, &rests) in resting.iter().enumerate() {
        let Some(&first) = at_rest.get(i) else { continue };
        if rests || !first.is_finite() || first == S::zero() {
            continue;
        }
        let falls = first > S::zero();
        let signed = |size: S| if falls { -size } else { size };
        let is_before = |size: S| {
            let mut v = SVector::<S, N>::zeros();
            if let Some(entry) = v.get_mut(i) {
                *entry = signed(size);
            }
            let value = residual(&v).get(i).copied().unwrap_or_else(S::zero);
            value.is_finite() && value != S::zero() && (value > S::zero()) == falls
        };
        let mut size = S::SMALLEST_NORMAL;
        // The factors thrice each lead from the smallest number to the largest.
        for &factor in factors.iter().rev().flat_map(|factor| [factor; 3]) {
            let larger = size * factor;
            if larger.is_finite() && is_before(larger) {
                size = larger;
            }
        }
        // Where no sign changes another coordinate has to move, or there is no root.
        if (size * S::constant(4.0)).is_finite()
            && let Some(entry) = start.get_mut(i)
        {
            *entry = signed(size);
        }
    }
    start
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::vector;

    #[test]
    fn each_coordinate_is_moved_to_the_order_of_its_root() {
        for scale in [1e-90, 1e-3, 1.0, 1e90] {
            let residual = |v: &SVector<f64, 3>| {
                vector![v[0].powi(3) * scale - 8.0, v[1] + 1e-200, (v[2] * v[2]).sqrt() * v[2]]
            };
            let near = near_rest(&residual);
            let resting = vanishing(&residual, &SVector::zeros(), &SVector::zeros(), &near);
            assert_eq!(resting, [false, false, true]);
            let found = away_from_rest(&residual, &near, &resting);
            let root = 2.0 / scale.cbrt();
            assert!(found[0] <= root && found[0] > 0.49 * root, "{found}");
            assert!(found[1] < 0.0 && found[1] >= -1e-200 && found[1] < -0.49e-200, "{found}");
            assert_eq!(found[2], 0.0);
        }
    }

    #[test]
    fn what_has_no_root_stays_at_rest() {
        let found = away_from_rest(&|_: &SVector<f64, 1>| vector![-1.0], &vector![1e-300], &[false]);
        assert_eq!(found, vector![0.0]);
        // In single precision as well.
        let found =
            away_from_rest(&|v: &SVector<f32, 1>| vector![v[0].powi(3) - 8e-9], &vector![1e-30], &[false]);
        assert!(found[0] > 0.9e-3 && found[0] <= 2e-3, "{found}");
    }

    /// v/|v| is no number at rest; |v|v vanishes there, 1 + |v|v does not.
    #[test]
    fn a_residual_vanishes_with_the_velocity_or_does_not() {
        let residual = |v: &SVector<f64, 2>| {
            let signs = v.map(|v| v * (v / (v * v).sqrt()).powi(2));
            vector![signs[0], 1.0 + signs[1]]
        };
        let near = near_rest(&residual);
        assert!(near.amax() < 1e-100 && residual(&SVector::zeros())[0].is_nan());
        let (rest, small) = (SVector::zeros(), vector![-1e-200, 0.0]);
        assert_eq!(vanishing(&residual, &rest, &rest, &near), [true, false]);
        // A momentum below that of `near` is not taken for 0.
        assert_eq!(vanishing(&residual, &small, &rest, &near), [false, false]);
    }
}
