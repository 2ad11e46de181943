//! Points themselves as a curve of straight lines: an array of plain data.

use crate::numbers::{Curve, Scalar};

/// The straight lines through points (x, y), which hold their value beyond the ends: for numbers that are
/// plain data, and may change one by one. A [`Table`](crate::system::Table) is looked at once, when it is
/// made.
///
/// Every evaluation looks at all points: where their x do not increase f is NaN, and a step an error that
/// names the function.
///
/// ```
/// use dalembert::system::Curve;
///
/// let thrust = [[0.0, 10.0], [1.0, 30.0], [4.0, 0.0]];
/// assert_eq!([thrust.at(0.5), thrust.at(2.5), thrust.at(9.0)], [20.0, 15.0, 0.0]);
/// ```
impl<T: Scalar, const K: usize> Curve<T> for [[T; 2]; K] {
    fn derivatives(&self, x: T) -> [T; 4] {
        let zero = T::zero();
        let is_increasing = self.windows(2).all(|two| matches!(two, [[a, _], [b, _]] if a < b));
        let passed = if is_increasing { self.partition_point(|[knot, _]| *knot <= x) } else { K + 1 };
        match (self.get(passed.wrapping_sub(1)), self.get(passed)) {
            (Some(&[before, low]), Some(&[after, high])) if before <= x && x < after => {
                let slope = (high - low) / (after - before);
                [low + slope * (x - before), slope, zero, zero]
            }
            (Some(&[last, value]), None) if last <= x => [value, zero, zero, zero],
            (None, Some(&[first, value])) if x < first => [value, zero, zero, zero],
            _ => [T::constant(f64::NAN); 4],
        }
    }
}
