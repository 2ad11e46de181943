//! Steps in parts: the root that Newton's method misses from the state alone.
//!
//! The root of a step is a curve v̄(h) that starts at the velocity of the state; the step continues the
//! motion if it lies on it. Where no iteration from the state leads to the root, h grows part by part, each
//! solved from the root before: a short homotopy (E. L. Allgower and K. Georg, Numerical Continuation
//! Methods, 1990, chapter 2). It ends where the curve turns back, and then there is no such root.

use super::careful::{MAX_ITERATIONS, careful};
use super::equations::{Equations, Root, Solved, Unsolved, Way};
use super::noise::{Left, add_noise};
use super::start::{from_rest, is_rest};
use super::vectors::{Room, copy};
use crate::numbers::Precision;

/// The first part of h, from which parts double.
const FIRST: f64 = 1.0 / 1024.0;

/// The least part beside the share of h that is reached: where the curve turns back, shorter ones lead no
/// further.
const LEAST_BESIDE: f64 = FIRST;

/// The least part: drag on a light body may turn its velocity over as early.
const LEAST: f64 = FIRST * FIRST * FIRST;

/// Parts that are tried.
const PARTS: u32 = 128;

/// Iterations for each: what needs more has left the root.
pub(crate) const ITERATIONS: u32 = 10;

/// Functions that are compiled once for each scalar type, in this crate, and not in each program that has a
/// system.
pub trait AtLength: Sized {
    /// The solution of the equation by this way; `root` has the velocity to start from.
    ///
    /// # Errors
    /// The error that the damped method ends with, or that it ends with from rest.
    fn at_length(
        of: Equations<'_, Self>,
        way: Way<'_, Self>,
        root: Root<'_, Self>,
        room: Room<'_, Self>,
    ) -> Result<Solved<Self>, Unsolved<Self>>;

    /// Whether the `residual`, a function of v that is written to the second slice, vanishes with the
    /// velocity in every coordinate, so that rest is its root.
    fn is_rest(residual: &mut dyn FnMut(&[Self], &mut [Self]), p: &[Self], room: Room<'_, Self>) -> bool;

    /// The floor with the noise of the residual, a `function` that writes to the second slice; whether that
    /// explains what is left.
    fn add_noise(
        function: &mut dyn FnMut(&[Self], &mut [Self]),
        left: &Left<'_, Self>,
        floor: &mut [Self],
        room: Room<'_, Self>,
    ) -> bool;

    /// Whether the root is reached for the whole of h, part by part; `root` goes on to the root of this share
    /// of h from that of another, if it is near.
    fn along_h(root: &mut dyn FnMut(Self) -> bool) -> bool;
}

macro_rules! compiled_for {
    ($($scalar:ty)*) => {$(
        impl AtLength for $scalar {
            #[cold]
            #[inline(never)]
            fn at_length(
                mut of: Equations<'_, Self>,
                way: Way<'_, Self>,
                mut root: Root<'_, Self>,
                room: Room<'_, Self>,
            ) -> Result<Solved<Self>, Unsolved<Self>> {
                solved(&mut of, way, &mut root, room)
            }

            #[cold]
            #[inline(never)]
            fn is_rest(
                residual: &mut dyn FnMut(&[Self], &mut [Self]),
                p: &[Self],
                room: Room<'_, Self>,
            ) -> bool {
                is_rest(residual, p, room)
            }

            #[cold]
            #[inline(never)]
            fn add_noise(
                function: &mut dyn FnMut(&[Self], &mut [Self]),
                left: &Left<'_, Self>,
                floor: &mut [Self],
                room: Room<'_, Self>,
            ) -> bool {
                add_noise(function, left, floor, room)
            }

            #[cold]
            #[inline(never)]
            fn along_h(root: &mut dyn FnMut(Self) -> bool) -> bool {
                along_h(root)
            }
        }
    )*};
}
compiled_for!(f64 f32);

fn solved<S: Precision>(
    of: &mut Equations<'_, S>,
    way: Way<'_, S>,
    root: &mut Root<'_, S>,
    mut room: Room<'_, S>,
) -> Result<Solved<S>, Unsolved<S>> {
    match way {
        Way::Damped { iterations } => careful(of, iterations, root, room),
        Way::FromRest { error } => {
            let rest = room.zeros();
            from_rest(of, rest, error, root, room)
        }
        Way::Every { iterations, start } => careful(of, iterations, root, room.inner())
            .or_else(|error| from_rest(of, start, error, root, room.inner()))
            .or_else(|error| in_parts(of, start, root, room).ok_or(error)),
    }
}

/// The root for the whole of h, from `start` part by part: each from where a parabola through the last three
/// leads. Where constraints nearly depend on one another, Newton's method leads to the root from next to it
/// alone.
#[inline(never)]
fn in_parts<S: Precision>(
    of: &mut Equations<'_, S>,
    start: &[S],
    root: &mut Root<'_, S>,
    mut room: Room<'_, S>,
) -> Option<Solved<S>> {
    let [at, slope, curvature] = room.vectors();
    copy(at, start);
    slope.fill(S::zero());
    curvature.fill(S::zero());
    let (h, held) = (of.h, of.held);
    // The share of h that is reached, and the last part of it.
    let (mut reached, mut last) = (S::zero(), S::zero());
    let is_reached = along_h(&mut |share| {
        let part = share - reached;
        let of_curvature = part * (part + last);
        let terms = at.iter().zip(slope.iter()).zip(curvature.iter());
        for (v, ((at, slope), curvature)) in root.v.iter_mut().zip(terms) {
            *v = *at + *slope * part + *curvature * of_curvature;
        }
        let found = careful(&mut of.with(h * share, held), MAX_ITERATIONS - ITERATIONS, root, room.inner());
        if found.is_ok() {
            let terms = at.iter_mut().zip(slope.iter_mut()).zip(curvature.iter_mut());
            for (v, ((at, slope), curvature)) in root.v.iter().zip(terms) {
                let next = (*v - *at) / part;
                *curvature = if last > S::zero() { (next - *slope) / (part + last) } else { S::zero() };
                (*at, *slope) = (*v, next);
            }
            (last, reached) = (part, share);
        }
        found.is_ok()
    });
    copy(root.v, at);
    if is_reached { careful(of, 0, root, room).ok() } else { None }
}

fn along_h<S: Precision>(root: &mut dyn FnMut(S) -> bool) -> bool {
    let (mut reached, mut part) = (S::zero(), S::nearest(FIRST));
    for _ in 0..PARTS {
        let share = if reached + part < S::one() { reached + part } else { S::one() };
        if root(share) {
            if share == S::one() {
                return true;
            }
            reached = share;
            part += part;
        } else if part <= reached * S::nearest(LEAST_BESIDE) || part <= S::nearest(LEAST) {
            return false;
        } else {
            part *= S::nearest(0.25);
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether the whole of h is reached, and by how many roots, where one leads on to another by parts of
    /// at most this much of the share reached, and at first by `first`, up to the end of the curve.
    fn is_reached(first: f64, at_once: f64, end: f64) -> (bool, u32) {
        let (mut reached, mut asked) = (0.0, 0);
        let is_whole = along_h(&mut |share: f64| {
            asked += 1;
            let is_near = share <= end && share - reached <= at_once * reached + first;
            reached = if is_near { share } else { reached };
            is_near
        });
        (is_whole, asked)
    }

    #[test]
    fn a_root_is_followed_from_parts_of_any_length() {
        for first in [1.0, 1e-3, 1e-5, 1e-8] {
            for at_once in [10.0, 1.0] {
                let (is_whole, asked) = is_reached(first, at_once, 1.0);
                assert!(is_whole && asked <= PARTS, "{first:e}, {at_once}: {asked}");
            }
        }
        // Positive control: of what has no motion at all.
        assert!(!is_reached(0.0, 10.0, 1.0).0);
    }

    #[test]
    fn a_curve_that_ends_is_left() {
        for end in [0.0, 1e-6, 0.3, 0.999] {
            let (is_whole, asked) = is_reached(1.0, 1.0, end);
            assert!(!is_whole && asked < PARTS, "{end}: {asked}");
        }
    }
}
