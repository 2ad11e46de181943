//! Whether the derivatives belong to the functions as written.
//!
//! Derivatives that the macro makes, written out or by dual numbers, come with a value, of the operations
//! that it read off the body. It is that of the user's own function, bit by bit; where it is not, the
//! derivatives are those of another function. NaN counts as equal to NaN, and 0 to −0. And they are the
//! slopes of the function as written, along a direction with a part in every coordinate and velocity: by its
//! differences at seven points, as far as those can tell. Each function of this module compares at one point.
//!
//! | when | what | where |
//! |---|---|---|
//! | [`State::from_velocity`] | values | at (q, v), and beside it where no coordinate is special |
//! | the start of a run, or of one that is resumed | values, with `std` slopes | at the state, and beside it |
//! | that start, with `std` | p0 and p1 of the step against those of L_d and f_d | beside the state |
//! | [`State::verify`] | values and slopes | at the state, and beside it |
//! | with slopes, if `debug_assertions` are on | second derivatives along two directions | there |
//! | every step, with `debug_assertions` | values | at the points where the rule evaluates it |
//! | a step, with `debug_assertions` | slopes | near one such point of 64 |
//!
//! Slopes are those near the state: at the point itself a body may take a way of its own, as at 0. Where
//! differences cannot tell, as of a wave far shorter than they are wide, nothing is said.
//! Of members in lanes they are looked at in the first lane, and not again where a run changes its step size.
//!
//! [`State::from_velocity`]: crate::State::from_velocity
//! [`State::verify`]: crate::State::verify
//!
//! A difference is [`StepError::GeneratedDiffers`](crate::StepError::GeneratedDiffers). Systems written by
//! hand have one value and nothing to compare. On x86 processors without SSE2 no values are compared: their
//! registers round differently each time.

mod along;

pub use along::{force_slope, lagrangian_slope, rayleigh_slope};

use core::hint::black_box;

use nalgebra::SVector;

use crate::numbers::{Scalar, comparison::Unit};
use crate::system::{
    Compared, Constrained, Engine, Force, Function, GeneratedDiffers, Lagrangian, Rayleigh, TimeScale,
};

/// Whether the same operations give the same bits.
const IS_IEEE: bool = cfg!(not(all(target_arch = "x86", not(target_feature = "sse2"))));

/// L as generated against L as written.
///
/// # Errors
/// [`GeneratedDiffers`].
#[cold]
#[inline(never)]
pub fn lagrangian<L: Lagrangian<N>, const N: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
) -> Result<(), GeneratedDiffers> {
    // Neither side knows more of its arguments than the other: a constant folded by the compiler on one side
    // alone, with the elementary functions of another machine, would differ.
    let (system, q, v) = black_box((system, q, v));
    compare(Function::Lagrangian, system.lagrangian_gradient(q, v).value, system.lagrangian(q, v))
}

/// R as generated against R as written.
///
/// # Errors
/// [`GeneratedDiffers`].
#[cold]
#[inline(never)]
pub fn rayleigh<L: Rayleigh<N>, const N: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
) -> Result<(), GeneratedDiffers> {
    let (system, q, v) = black_box((system, q, v));
    compare(Function::Rayleigh, system.rayleigh_gradient(q, v).value, system.rayleigh(q, v))
}

/// f as generated against f as written, component by component.
///
/// # Errors
/// [`GeneratedDiffers`].
#[cold]
#[inline(never)]
pub fn force<L: Force<N>, const N: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
) -> Result<(), GeneratedDiffers> {
    let (system, q, v) = black_box((system, q, v));
    let generated = system.force_derivatives(q, v).value;
    let written = system.force(q, v);
    for (index, (generated, written)) in generated.iter().zip(written.iter()).enumerate() {
        compare(Function::Force { index }, *generated, *written)?;
    }
    Ok(())
}

/// σ as generated against σ as written.
///
/// # Errors
/// [`GeneratedDiffers`].
#[cold]
#[inline(never)]
pub fn time_scale<L: TimeScale<N>, const N: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
) -> Result<(), GeneratedDiffers> {
    let (system, q) = black_box((system, q));
    compare(Function::TimeScale, system.time_scale_gradient(q).0, system.time_scale(q))
}

/// Compares the values of the constraints at q, as [`lagrangian`] does.
///
/// # Errors
/// [`GeneratedDiffers`].
#[cold]
#[inline(never)]
pub fn constraints<L: Constrained<N, M>, const N: usize, const M: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
) -> Result<(), GeneratedDiffers> {
    let (system, q, v) = black_box((system, q, v));
    let (mut generated, mut written) = (system.constraint_gradients(q).0, system.constraints(q));
    let (rates, of_velocity) = (system.constraint_rates(q, v).0, system.velocity_constraints(q, v));
    for k in M - L::OF_VELOCITY.min(M)..M {
        (generated[k], written[k]) = (rates[k], of_velocity[k]);
    }
    (0..M).try_for_each(|index| compare(Function::Constraint { index }, generated[index], written[index]))
}

/// Fails unless the two values are equal, or both NaN.
fn compare<S: Scalar>(function: Function, generated: S, written: S) -> Result<(), GeneratedDiffers> {
    let (generated, written) = (generated.widen(), written.widen());
    if !IS_IEEE || generated == written || (generated.is_nan() && written.is_nan()) {
        Ok(())
    } else {
        Err(GeneratedDiffers { function, compared: Compared::Value, generated, written })
    }
}

/// Whether there are two values of each function.
pub(crate) const fn has_two_values(engine: Engine) -> bool {
    matches!(engine, Engine::Expanded | Engine::NumDual { .. })
}

/// Verifies values at (q, v), and beside it: at rest, and where a coordinate is 0, functions agree by chance.
pub(crate) fn around<L: Lagrangian<N>, const N: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
) -> Result<(), GeneratedDiffers> {
    if !has_two_values(L::STRUCTURE.engine) {
        return Ok(());
    }
    system.verify_generated(q, v)?;
    let [q, v] = place(q, v, [0.75, -1.25], Unit::One);
    system.verify_generated(&q, &v)
}

/// Verifies slopes near (q, v) and farther away: at the point itself a body may take a way of its own, as at
/// 0.
#[cold]
#[inline(never)]
pub(crate) fn slopes_around<L: Lagrangian<N> + ?Sized, const N: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
) -> Result<(), GeneratedDiffers> {
    slopes_at_places(q, v, &|q, v| system.verify_slopes(q, v))
}

#[cold]
#[inline(never)]
#[expect(clippy::type_complexity, reason = "a function, in full: an alias would hide its lifetime")]
fn slopes_at_places<S: Scalar, const N: usize>(
    q: &SVector<S, N>,
    v: &SVector<S, N>,
    verify: &dyn Fn(&SVector<S, N>, &SVector<S, N>) -> Result<(), GeneratedDiffers>,
) -> Result<(), GeneratedDiffers> {
    let at = |distances, unit| {
        let [q, v] = place(q, v, distances, unit);
        verify(&q, &v)
    };
    at([0.011, -0.017], Unit::Size)?;
    at([0.75, -1.25], Unit::Size)?;
    // Where lengths are 1e-20, or velocities, nothing at 1 is smooth.
    if S::has_tiny(q.as_slice()) || S::has_tiny(v.as_slice()) {
        at([0.011, -0.017], Unit::Own)?;
    }
    Ok(())
}

/// Verifies values at a node of a step, and slopes near one of 64.
pub(crate) fn verify_node<L: Lagrangian<N> + ?Sized, const N: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
) -> Result<(), GeneratedDiffers> {
    system.verify_generated(q, v)?;
    if cfg!(debug_assertions) && has_two_values(L::STRUCTURE.engine) && is_one_of_64(q) {
        slopes_around(system, q, v)?;
    }
    Ok(())
}

/// Whether a point is one of some 64, as its last places have it.
fn is_one_of_64<S: Scalar, const N: usize>(point: &SVector<S, N>) -> bool {
    let mut hash = 1_u64;
    for i in 0..N {
        hash = (hash ^ point[i].widen().to_bits()).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29);
    }
    hash & 63 == 0
}

/// A place at these distances from (q, v), in no special direction.
#[cold]
#[inline(never)]
fn place<S: Scalar, const N: usize>(
    q: &SVector<S, N>,
    v: &SVector<S, N>,
    distances: [f64; 2],
    unit: Unit,
) -> [SVector<S, N>; 2] {
    let mut place = [*q, *v];
    S::beside(q.as_slice(), distances[0], unit, place[0].as_mut_slice());
    S::beside(v.as_slice(), distances[1], unit, place[1].as_mut_slice());
    place
}
