//! The cubics through points: slopes at the knots by each interpolation, and coefficients of these.
//!
//! ```text
//! hᵢ = xᵢ₊₁ − xᵢ,   mᵢ = (yᵢ₊₁ − yᵢ)/hᵢ,   dᵢ the slope at xᵢ
//! spline     hᵢ dᵢ₋₁ + 2(hᵢ₋₁ + hᵢ)dᵢ + hᵢ₋₁ dᵢ₊₁ = 3(hᵢ mᵢ₋₁ + hᵢ₋₁ mᵢ)
//! not-a-knot h₁d₀ + (h₀ + h₁)d₁ = ((3h₀ + 2h₁)h₁m₀ + h₀²m₁)/(h₀ + h₁), and so at the other end
//! monotone   (w + w′)/dᵢ = w/mᵢ₋₁ + w′/mᵢ,  w = hᵢ₋₁ + 2hᵢ,  w′ = 2hᵢ₋₁ + hᵢ;  0 where mᵢ₋₁mᵢ ≤ 0
//! cubic      c₀ = yᵢ,  c₁ = dᵢ,  c₂ = (3mᵢ − 2dᵢ − dᵢ₊₁)/hᵢ,  c₃ = (dᵢ + dᵢ₊₁ − 2mᵢ)/hᵢ²
//! ```
//!
//! Each piece holds, while slopes are solved for, what elimination leaves in its row: no memory but that of
//! the pieces is needed. No row needs a pivot: what is left of a row's diagonal is above its neighbour.
//!
//! All is inlined: where the lengths are compared every index is seen to be within bounds, and no panic is
//! left where C gives the points.
//!
//! F. N. Fritsch and J. Butland, A method for constructing local monotone piecewise cubic interpolants, SIAM
//! Journal on Scientific and Statistical Computing 5, 1984.

use super::{Interpolation, TableError};

/// Writes the cubics.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) const fn fill(
    of: Interpolation,
    x: &[f64],
    y: &[f64],
    pieces: &mut [[f64; 4]],
) -> Result<(), TableError> {
    if let Err(error) = checked(of, x, y, pieces.len()) {
        return Err(error);
    }
    match of {
        Interpolation::Linear => linear(x, y, pieces),
        Interpolation::Spline => spline(x, y, pieces),
        Interpolation::Monotone => monotone(x, y, pieces),
        Interpolation::Periodic => periodic(x, y, pieces),
    }
    if !matches!(of, Interpolation::Linear) {
        cubics(x, y, pieces);
    }
    if matches!(of, Interpolation::Periodic) {
        let last = x.len() - 1;
        pieces[last] = pieces[0];
    }
    let mut i = 0;
    while i < x.len() {
        let [a, b, c, d] = pieces[i];
        if !(a.is_finite() && b.is_finite() && c.is_finite() && d.is_finite()) {
            return Err(TableError::TooSteep { of, index: i });
        }
        i += 1;
    }
    Ok(())
}

#[cfg_attr(not(debug_assertions), inline(always))]
const fn checked(of: Interpolation, x: &[f64], y: &[f64], pieces: usize) -> Result<(), TableError> {
    let points = x.len();
    if y.len() != points || pieces != points {
        return Err(TableError::Lengths { x: points, y: y.len(), pieces });
    }
    if points < of.fewest() {
        return Err(TableError::TooShort { of, points });
    }
    let mut index = 0;
    while index < points {
        if !(x[index] - x[0]).is_finite() {
            return Err(TableError::KnotNotFinite { of, index });
        }
        if !y[index].is_finite() {
            return Err(TableError::ValueNotFinite { of, index });
        }
        if index > 0 && x[index] <= x[index - 1] {
            return Err(TableError::NotIncreasing { of, index, before: x[index - 1], x: x[index] });
        }
        index += 1;
    }
    let (first, last) = (y[0], y[points - 1]);
    if matches!(of, Interpolation::Periodic) && first != last {
        return Err(TableError::NotPeriodic { first, last });
    }
    Ok(())
}

#[cfg_attr(not(debug_assertions), inline(always))]
const fn width(x: &[f64], i: usize) -> f64 {
    x[i + 1] - x[i]
}

/// mᵢ.
#[cfg_attr(not(debug_assertions), inline(always))]
const fn secant(x: &[f64], y: &[f64], i: usize) -> f64 {
    (y[i + 1] - y[i]) / width(x, i)
}

/// The pieces of straight lines; the one at the last point goes on by the slope before.
#[cfg_attr(not(debug_assertions), inline(always))]
const fn linear(x: &[f64], y: &[f64], pieces: &mut [[f64; 4]]) {
    let last = x.len() - 1;
    let mut i = 0;
    while i < last {
        pieces[i] = [y[i], secant(x, y, i), 0.0, 0.0];
        i += 1;
    }
    pieces[last] = [y[last], pieces[last - 1][1], 0.0, 0.0];
}

/// The cubics of slopes, which stand in the second place of each piece.
#[cfg_attr(not(debug_assertions), inline(always))]
const fn cubics(x: &[f64], y: &[f64], pieces: &mut [[f64; 4]]) {
    let last = x.len() - 1;
    let mut i = 0;
    while i < last {
        let (h, m) = (width(x, i), secant(x, y, i));
        let (d, next) = (pieces[i][1], pieces[i + 1][1]);
        pieces[i] = [y[i], d, (3.0 * m - 2.0 * d - next) / h, (d + next - 2.0 * m) / h / h];
        i += 1;
    }
    // The last cubic as it is seen from its end.
    let ([.., c2, c3], h) = (pieces[last - 1], width(x, last - 1));
    pieces[last] = [y[last], pieces[last][1], c2 + 3.0 * c3 * h, c3];
}

/// The slopes of a parabola through three points, at the first; `h` and `m` from there on.
#[cfg_attr(not(debug_assertions), inline(always))]
const fn end_slope(h: [f64; 2], m: [f64; 2]) -> f64 {
    ((2.0 * h[0] + h[1]) * m[0] - h[0] * m[1]) / (h[0] + h[1])
}

#[cfg_attr(not(debug_assertions), inline(always))]
const fn spline(x: &[f64], y: &[f64], pieces: &mut [[f64; 4]]) {
    let last = x.len() - 1;
    if last == 1 {
        (pieces[0][1], pieces[1][1]) = (secant(x, y, 0), secant(x, y, 0));
        return;
    }
    let (h, m) = ([width(x, 0), width(x, 1)], [secant(x, y, 0), secant(x, y, 1)]);
    let (k, n) = ([width(x, last - 1), width(x, last - 2)], [secant(x, y, last - 1), secant(x, y, last - 2)]);
    if last == 2 {
        pieces[0][1] = end_slope(h, m);
        pieces[1][1] = (h[1] * m[0] + h[0] * m[1]) / (h[0] + h[1]);
        pieces[2][1] = end_slope(k, n);
        return;
    }
    // Downwards: the right side in the second place, what multiplies the next slope in the third.
    eliminate(pieces, 0, [0.0, h[1], h[0] + h[1]], at_end(h, m));
    let mut i = 1;
    while i < last {
        let (before, after) = (width(x, i - 1), width(x, i));
        let right = 3.0 * (after * secant(x, y, i - 1) + before * secant(x, y, i));
        eliminate(pieces, i, [after, 2.0 * (before + after), before], right);
        i += 1;
    }
    eliminate(pieces, last, [k[0] + k[1], k[1], 0.0], at_end(k, n));
    substitute(pieces, last, 1);
}

/// The right side of a not-a-knot end; `h` and `m` from the end on.
#[cfg_attr(not(debug_assertions), inline(always))]
const fn at_end(h: [f64; 2], m: [f64; 2]) -> f64 {
    let whole = h[0] + h[1];
    (3.0 * h[0] + 2.0 * h[1]) * (h[1] / whole) * m[0] + h[0] * (h[0] / whole) * m[1]
}

/// One row of elimination: row · (dᵢ₋₁, dᵢ, dᵢ₊₁) = right.
#[cfg_attr(not(debug_assertions), inline(always))]
const fn eliminate(pieces: &mut [[f64; 4]], i: usize, row: [f64; 3], right: f64) {
    let before = if i == 0 { [0.0; 4] } else { pieces[i - 1] };
    let pivot = row[1] - row[0] * before[2];
    pieces[i][1] = (right - row[0] * before[1]) / pivot;
    pieces[i][2] = row[2] / pivot;
}

/// Back from the unknown `last`, in this place of the pieces.
#[cfg_attr(not(debug_assertions), inline(always))]
const fn substitute(pieces: &mut [[f64; 4]], last: usize, place: usize) {
    let mut i = last;
    while i > 0 {
        i -= 1;
        pieces[i][place] -= pieces[i][2] * pieces[i + 1][place];
    }
}

#[cfg_attr(not(debug_assertions), inline(always))]
const fn monotone(x: &[f64], y: &[f64], pieces: &mut [[f64; 4]]) {
    let last = x.len() - 1;
    if last == 1 {
        (pieces[0][1], pieces[1][1]) = (secant(x, y, 0), secant(x, y, 0));
        return;
    }
    let mut i = 1;
    while i < last {
        let (h, m) = ([width(x, i - 1), width(x, i)], [secant(x, y, i - 1), secant(x, y, i)]);
        let weights = [h[0] + 2.0 * h[1], 2.0 * h[0] + h[1]];
        pieces[i][1] = if have_one_sign(m[0], m[1]) {
            (weights[0] + weights[1]) / (weights[0] / m[0] + weights[1] / m[1])
        } else {
            0.0
        };
        i += 1;
    }
    pieces[0][1] = one_sided([width(x, 0), width(x, 1)], [secant(x, y, 0), secant(x, y, 1)]);
    pieces[last][1] =
        one_sided([width(x, last - 1), width(x, last - 2)], [secant(x, y, last - 1), secant(x, y, last - 2)]);
}

/// The slope at an end that keeps the first piece monotone: that of the parabola, within bounds.
#[cfg_attr(not(debug_assertions), inline(always))]
const fn one_sided(h: [f64; 2], m: [f64; 2]) -> f64 {
    let slope = end_slope(h, m);
    if !have_one_sign(slope, m[0]) {
        0.0
    } else if !have_one_sign(m[0], m[1]) && slope.abs() > 3.0 * m[0].abs() {
        3.0 * m[0]
    } else {
        slope
    }
}

/// Whether both are above 0, or both below.
#[cfg_attr(not(debug_assertions), inline(always))]
const fn have_one_sign(a: f64, b: f64) -> bool {
    (a > 0.0 && b > 0.0) || (a < 0.0 && b < 0.0)
}

/// The slopes of the cyclic equations: those of the rows but the last one as a line in the last
/// slope, u + w t, and t of the last row.
#[cfg_attr(not(debug_assertions), inline(always))]
const fn periodic(x: &[f64], y: &[f64], pieces: &mut [[f64; 4]]) {
    let unknowns = x.len() - 1;
    let last = unknowns - 1;
    let mut i = 0;
    while i < last {
        let (row, right) = cyclic(x, y, i);
        let is_end = i + 1 == last;
        // The last slope goes to the right side: of both neighbours where one row alone is left.
        let mut of_last = if i == 0 { -row[0] } else { 0.0 };
        if is_end {
            of_last -= row[2];
        }
        let below = if i == 0 { 0.0 } else { row[0] };
        let before = if i == 0 { [0.0; 4] } else { pieces[i - 1] };
        let pivot = row[1] - below * before[2];
        pieces[i][1] = (right - below * before[1]) / pivot;
        pieces[i][2] = if is_end { 0.0 } else { row[2] / pivot };
        pieces[i][3] = (of_last - below * before[3]) / pivot;
        i += 1;
    }
    substitute(pieces, last - 1, 1);
    substitute(pieces, last - 1, 3);
    let (row, right) = cyclic(x, y, last);
    let constant = right - row[0] * pieces[last - 1][1] - row[2] * pieces[0][1];
    let t = constant / (row[1] + row[0] * pieces[last - 1][3] + row[2] * pieces[0][3]);
    let mut i = 0;
    while i < last {
        pieces[i][1] += pieces[i][3] * t;
        i += 1;
    }
    pieces[last][1] = t;
    pieces[unknowns][1] = pieces[0][1];
}

/// A row of the cyclic equations, and its right side.
#[cfg_attr(not(debug_assertions), inline(always))]
const fn cyclic(x: &[f64], y: &[f64], i: usize) -> ([f64; 3], f64) {
    let j = if i == 0 { x.len() - 2 } else { i - 1 };
    let (before, after) = (width(x, j), width(x, i));
    let right = 3.0 * (after * secant(x, y, j) + before * secant(x, y, i));
    ([after, 2.0 * (before + after), before], right)
}

/// Rounds knots and cubics to single precision.
#[cfg_attr(not(debug_assertions), inline(always))]
pub(super) const fn round(
    (x, pieces): (&[f64], &[[f64; 4]]),
    (to_x, to_pieces): (&mut [f32], &mut [[f32; 4]]),
) -> Result<(), TableError> {
    let points = x.len();
    if to_x.len() != points || to_pieces.len() != points {
        return Err(TableError::Lengths { x: to_x.len(), y: points, pieces: to_pieces.len() });
    }
    let mut index = 0;
    while index < points {
        let [a, b, c, d] = pieces[index];
        let [a, b, c, d] = [a as f32, b as f32, c as f32, d as f32];
        (to_x[index], to_pieces[index]) = (x[index] as f32, [a, b, c, d]);
        let is_above = index == 0 || to_x[index] > to_x[index - 1];
        let is_finite = a.is_finite() && b.is_finite() && c.is_finite() && d.is_finite();
        if !(is_above && is_finite && (to_x[index] - to_x[0]).is_finite()) {
            return Err(TableError::SinglePrecision { index });
        }
        index += 1;
    }
    Ok(())
}
