//! Whether the derivatives belong to the functions as written.
//!
//! Derivatives that the macro writes out come with a value, of the operations that it read off the body. It
//! is that of the user's own function, bit by bit; where it is not, the derivatives are those of another
//! function. Each function of this module compares the two at one point. NaN counts as equal to NaN, and 0 to
//! −0.
//!
//! | when | where |
//! |---|---|
//! | [`State::from_velocity`](crate::State::from_velocity) | at (q, v), and at a point beside it where no coordinate is special |
//! | the start of a run: [`Trajectory`](crate::Trajectory), compositions, splittings, [`resume`](crate::Trajectory::resume) | at the state, and beside it |
//! | every step, with `debug_assertions` | at the points where the rule evaluates the step taken |
//!
//! A difference is [`StepError::GeneratedDiffers`](crate::StepError::GeneratedDiffers). Systems written by
//! hand, and those of dual numbers, have one value and nothing to compare. On x86 processors without SSE2
//! nothing is compared: their registers round differently each time.

use core::hint::black_box;

use nalgebra::SVector;

use crate::numbers::Scalar;
use crate::system::{Engine, Force, Function, GeneratedDiffers, Lagrangian, Rayleigh, TimeScale};

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

/// Fails unless the two values are equal, or both NaN.
fn compare<S: Scalar>(function: Function, generated: S, written: S) -> Result<(), GeneratedDiffers> {
    let (generated, written) = (generated.widen(), written.widen());
    if !IS_IEEE || generated == written || (generated.is_nan() && written.is_nan()) {
        Ok(())
    } else {
        Err(GeneratedDiffers { function, generated, written })
    }
}

/// Whether there are two values of each function.
pub(crate) const fn has_two_values(engine: Engine) -> bool {
    matches!(engine, Engine::Expanded)
}

/// Verifies a system at (q, v), and beside it: at rest, and where a coordinate is 0, functions agree by
/// chance.
pub(crate) fn around<L: Lagrangian<N>, const N: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
) -> Result<(), GeneratedDiffers> {
    if !has_two_values(L::STRUCTURE.engine) {
        return Ok(());
    }
    system.verify_generated(q, v)?;
    let beside = |x: &SVector<L::Scalar, N>, direction: f64| {
        SVector::from_fn(|i, _| x[i] + L::Scalar::constant(direction * (1.0 + 0.125 * i as f64)))
    };
    system.verify_generated(&beside(q, 0.75), &beside(v, -1.25))
}
