//! Momenta of a step, as it has them, against the derivatives of L_d and f_d.

use nalgebra::ComplexField;

use super::places::{Unit, beside};
use crate::numbers::Precision;
use crate::numbers::nonlinear::Room;

/// Four vectors of a segment, from two that say which, written to the slices.
type OfSegment<'f, S> = dyn Fn(&[S], &[S], [&mut [S]; 4]) + 'f;

/// Both momenta of a segment by two ways.
pub struct TwoWays<'f, S> {
    /// p0 and p1 from q0 with mean velocity v̄, as the step's equation has them, and as the step has them.
    pub(crate) generated: &'f OfSegment<'f, S>,
    /// D1 L_d, D2 L_d, f_d⁻ and f_d⁺ at (q0, q1).
    pub(crate) derivatives: &'f OfSegment<'f, S>,
}

/// A momentum by which two ways differ.
#[derive(Clone, Copy)]
pub struct Apart {
    /// Its coordinate.
    pub(crate) index: usize,
    /// Whether it is one of p1.
    pub(crate) is_final: bool,
    /// The momentum as the step has it.
    pub(crate) generated: f64,
    /// The momentum by derivatives.
    pub(crate) written: f64,
}

/// Compares at three points: at a kink or a jump the two may be on different sides.
pub(super) fn apart<S: Precision>(
    q: &[S],
    v: &[S],
    h: S,
    of: &TwoWays<'_, S>,
    mut room: Room<'_, S>,
) -> Option<Apart> {
    let mut found = None;
    for [of_q, of_v] in [[0.011, -0.017], [0.013, 0.019], [0.0171, -0.023]] {
        let mut room = room.inner();
        let [q0, v0] = room.vectors();
        beside(q, of_q, Unit::Size, q0);
        beside(v, of_v, Unit::Size, v0);
        found = compared(q0, v0, h, of, room);
        if found.is_none() {
            break;
        }
    }
    found
}

/// A momentum that is off by more than rounding, and by more than it changes with the last half of the
/// digits of q0 and q1.
fn compared<S: Precision>(
    q0: &[S],
    v: &[S],
    h: S,
    of: &TwoWays<'_, S>,
    mut room: Room<'_, S>,
) -> Option<Apart> {
    let [q1, p0_of_equation, p1_of_equation, p0, p1] = room.vectors();
    for ((q1, q0), v) in q1.iter_mut().zip(q0).zip(v) {
        *q1 = *q0 + h * *v;
    }
    (of.generated)(q0, v, [p0_of_equation, p1_of_equation, p0, p1]);
    let epsilon = S::SPACING.widened();
    let precision = S::SPACING.sqrt().widened();
    let [d1, d2, minus, plus] = room.vectors();
    (of.derivatives)(q0, q1, [d1, d2, minus, plus]);
    let near = [d1, d2, minus, plus].map(|of| &*of);
    let [moved_q0, moved_q1, d1, d2, minus, plus] = room.vectors();
    // Asked for where they differ alone.
    let mut moved = |widths: [f64; 2], index: usize, side: usize| {
        beside(q0, widths[0], Unit::Own, moved_q0);
        beside(q1, widths[1], Unit::Own, moved_q1);
        (of.derivatives)(moved_q0, moved_q1, [d1, d2, minus, plus]);
        momentum([d1, d2, minus, plus], index, side).0
    };
    for momenta in [[&*p0_of_equation, &*p1_of_equation], [&*p0, &*p1]] {
        for index in 0..q0.len() {
            for (side, momenta) in momenta.into_iter().enumerate() {
                let generated = widened(momenta, index);
                let (written, size) = momentum(near, index, side);
                let off = (generated - written).abs();
                if off <= precision * size {
                    continue;
                }
                let far = moved([precision, -precision], index, side);
                let tolerance = precision * size + 16.0 * (far - written).abs();
                // What overflows on one of two ways tells nothing.
                if off > tolerance
                    && off.is_finite()
                    && is_steady(off, epsilon, &mut |width| {
                        (moved([width, 0.6 * width], index, side) - written).abs()
                    })
                {
                    return Some(Apart { index, is_final: side == 1, generated, written });
                }
            }
        }
    }
    None
}

/// Whether momenta change by less than a sixteenth of what two ways are `off` by, over widths from one last
/// place to half the digits: in `change`, by the width.
fn is_steady(off: f64, epsilon: f64, change: &mut dyn FnMut(f64) -> f64) -> bool {
    let places = [1.0, 2.0, 3.0, 5.0, 8.0, 13.0, 40.0].map(|places| places * epsilon);
    let half = [0.1, 0.3, 1.0].map(|share| share * ComplexField::sqrt(epsilon));
    places.into_iter().chain(half).all(|width| 16.0 * change(width) < off && 16.0 * change(-width) < off)
}

/// −D1 L_d − f_d⁻ or D2 L_d + f_d⁺, with the size of the terms of both.
fn momentum<S: Precision>(derivatives: [&[S]; 4], index: usize, side: usize) -> (f64, f64) {
    let [d1, d2, minus, plus] = derivatives.map(|of| widened(of, index));
    let size = d1.abs() + d2.abs() + minus.abs() + plus.abs();
    (if side == 0 { -d1 - minus } else { d2 + plus }, size)
}

fn widened<S: Precision>(of: &[S], index: usize) -> f64 {
    of.get(index).map_or(f64::NAN, |entry| entry.widened())
}
