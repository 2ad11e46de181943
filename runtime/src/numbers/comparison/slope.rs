//! The slope of a function along a line, against its differences.

/// Widths of the central differences, each a 1024th of the one before: of functions in `f64`, and an eighth
/// in `f32`.
const WIDTHS: [[f64; 3]; 2] =
    [[9.765_625e-4, 9.536_743_164_062_5e-7, 9.313_225_746_154_785e-10], [0.125, 0.015_625, 1.953_125e-3]];

/// The largest coordinates and velocities whose fourth powers are finite.
const LARGEST: [f64; 2] = [1e70, 1e9];

/// How much larger than where it is a coordinate becomes, to see whether a slope is refuted there too.
const FACTORS: [[f64; 3]; 2] = [[1.0, 1e3, 1e6], [1.0, 32.0, 1024.0]];

/// The least difference of slopes that is none of numbers too small to carry their digits.
const LEAST: [f64; 2] = [1e-200, 1e-25];

/// How many times its own uncertainty a difference has to be off.
const CERTAIN: f64 = 16.0;

/// The differences of a function over one width.
#[derive(Clone, Copy)]
struct Differences {
    forward: f64,
    backward: f64,
    /// The loss to rounding.
    rounding: f64,
}

impl Differences {
    fn central(self) -> f64 {
        0.5 * (self.forward + self.backward)
    }

    fn bend(self) -> f64 {
        self.forward - self.backward
    }
}

fn is_single(epsilon: f64) -> bool {
    epsilon > 1e-10
}

/// The largest coordinates and velocities of functions whose slopes can be told.
pub fn largest(epsilon: f64) -> f64 {
    LARGEST[usize::from(is_single(epsilon))]
}

/// The factors of a coordinate at which a partial derivative has to be refuted.
pub fn factors(epsilon: f64) -> [f64; 3] {
    FACTORS[usize::from(is_single(epsilon))]
}

/// The slope by differences, where it is certain that it is another than `slope`; by seven evaluations.
///
/// `function` is along the line, at its argument; `epsilon` the spacing of its numbers at 1, and `size` that
/// of the terms that it adds up. Two pairs of widths have to say so, each with certainty: in a pair, the
/// central differences agree, and the bend of the narrow ones is that of a smooth function, a kink's being as
/// large over any width. Kinks, jumps, noise and scales of the function between the widths leave a pair
/// without a verdict; a ripple far below the narrowest would not be seen.
pub fn refuted(slope: f64, epsilon: f64, size: f64, function: &mut dyn FnMut(f64) -> f64) -> Option<f64> {
    let (widths, least) = (WIDTHS[usize::from(is_single(epsilon))], LEAST[usize::from(is_single(epsilon))]);
    let ratio = widths[0] / widths[1];
    let middle = function(0.0);
    let over = widths.map(|width| {
        let (after, before) = (function(width), function(-width));
        let size = size.max(middle.abs()).max(after.abs()).max(before.abs());
        Differences {
            forward: (after - middle) / width,
            backward: (middle - before) / width,
            rounding: 2.0 * epsilon * size / width,
        }
    });
    let of_pair = |wide: Differences, narrow: Differences| {
        let kink = (narrow.bend() - wide.bend() / ratio).abs();
        let apart = kink + (narrow.central() - wide.central()).abs();
        let is_smooth = apart <= (narrow.forward.abs() + narrow.backward.abs()) / CERTAIN + narrow.rounding;
        let uncertain = 4.0 * apart + narrow.rounding;
        let off = (narrow.central() - slope).abs();
        is_smooth && off > CERTAIN * uncertain && off > least
    };
    // All values are one where the terms cancel, or are too small to be told from 0.
    let is_flat = over.iter().all(|over| over.forward == 0.0 && over.backward == 0.0);
    (!is_flat && of_pair(over[0], over[1]) && of_pair(over[1], over[2])).then(|| over[2].central())
}

/// Whether the `slope` that is refuted is one over the narrowest width, to a quarter of what it is off by.
///
/// A function that changes far below it, as sin(q/1e-20) does, has no steady slope, nor has one that is
/// mostly rounding: differences cannot tell it.
pub fn is_steady(slope: f64, written: f64, epsilon: f64, slope_at: &mut dyn FnMut(f64) -> f64) -> bool {
    /// Shares of the width, spread without a pattern.
    const PLACES: u32 = 24;
    let narrowest = WIDTHS[usize::from(is_single(epsilon))][2];
    let off = 0.25 * (slope - written).abs();
    (1..=PLACES).all(|place| {
        let turns = f64::from(place) * 0.618_033_988_749_895;
        // Without the whole turns: core has no `fract`.
        let share = (turns - f64::from(turns as u32)) * 2.0 - 1.0;
        (slope_at(share * narrowest) - slope).abs() <= off
    })
}

#[cfg(test)]
mod tests {
    use super::refuted;

    /// A smooth function, its slope at 0, and the wrong slopes that are told.
    #[test]
    fn slopes_of_others_are_told_and_its_own_is_not() {
        type Of = fn(f64) -> f64;
        let functions: [(Of, f64); 6] = [
            (|s| (1.3 + s).sin(), 1.3_f64.cos()),
            (|s| (0.7 * s).exp() * 1e3, 700.0),
            (|s| (1.0 + s).powi(7) - 10.0, 7.0),
            (|s| 1e-12 * (2.0 + 3.0 * s).sqrt(), 1e-12 * 1.5 / 2.0_f64.sqrt()),
            (|s| 0.5 * s * s, 0.0),
            (|s| 4.0 - 2.0 * s, -2.0),
        ];
        for (index, (function, slope)) in functions.into_iter().enumerate() {
            assert_eq!(refuted(slope, f64::EPSILON, 0.0, &mut { function }), None, "{index}");
            for wrong in [slope * 1.01 + 1e-3, -slope - 1.0, slope + 0.1 * (1.0 + slope.abs())] {
                let by_differences = refuted(wrong, f64::EPSILON, 0.0, &mut { function });
                assert!(
                    by_differences.is_some_and(|by| (by - slope).abs() < 1e-4 * (1.0 + slope.abs())),
                    "{index}"
                );
            }
        }
    }

    /// One side's slope at a kink, or any at a jump, and no noise nor number that is none makes a verdict.
    #[test]
    fn kinks_jumps_and_noise_are_no_verdict() {
        type Of = fn(f64) -> f64;
        let at: [f64; 9] = [0.0, 1e-12, -1e-9, 3e-7, -1e-6, 2e-5, -1e-4, 4e-3, 1e-2];
        let bent: [(Of, [f64; 2]); 4] = [
            (|s| s.abs(), [-1.0, 1.0]),
            (|s| s.max(3.0 * s), [1.0, 3.0]),
            (|s| if s < 0.0 { 1.0 } else { 2.0 + s }, [0.0, 1.0]),
            (|s| 5.0 * s.max(0.0).powi(2) + s.abs().sqrt(), [f64::INFINITY, f64::NAN]),
        ];
        for (function, slopes) in bent {
            for at in at {
                // Left of it, right of it, or either, where it is at the point.
                for slope in slopes {
                    let is_there = at == 0.0 || slope.is_finite() && (slope == slopes[0]) == (at > 0.0);
                    let by = refuted(slope, f64::EPSILON, 0.0, &mut |s| function(s - at));
                    assert!(!is_there || by.is_none(), "{slope} at {at:e}: {by:?}");
                }
            }
        }
        let mut hash = 1_u64;
        let mut noise = |_| {
            hash = hash.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (hash >> 40) as f64 * 1e-7
        };
        assert!((0..1000).all(|_| refuted(0.3, f64::EPSILON, 0.0, &mut noise).is_none()));
        assert_eq!(refuted(1.0, f64::EPSILON, 0.0, &mut |_| f64::NAN), None);
        assert_eq!(refuted(1.0, f64::EPSILON, 0.0, &mut |s| 1.0 / s), None);
        // Far below the widths.
        for scale in [1e-10_f64, 1e-8, 1e-6, 1e-5] {
            assert_eq!(refuted(-scale.powi(-2), f64::EPSILON, 0.0, &mut |s| 1.0 / (s + scale)), None);
            assert_eq!(refuted(1.0 / scale, f64::EPSILON, 0.0, &mut |s| (s / scale).tanh()), None);
        }
    }
}
