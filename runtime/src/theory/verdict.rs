//! One rule for every verdict of every checker: which quantities count as zero, and what was found of them.
//!
//! A quantity counts as zero if it is finite, is held against a finite tolerance, and is within it. What is
//! NaN or infinite on either side proves nothing, and no checker says yes to it. Samples at which nothing
//! could have been found prove nothing either
//! ([`SampleError::Uninformative`](crate::samples::SampleError::Uninformative)).

use core::fmt;

use crate::numbers::Scalar;

/// A checker's answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The statement holds to rounding.
    Yes,
    /// It does not.
    No,
    /// The tolerance is as large as what it is held against: it would hide a no.
    CannotTell,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Yes => "yes",
            Self::No => "no",
            Self::CannotTell => "cannot tell",
        })
    }
}

/// A checker's finding on a quantity that has to vanish: the value furthest above its tolerance, and where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finding<P> {
    /// That value.
    pub value: f64,
    /// The largest magnitude that counts as zero there.
    pub tolerance: f64,
    /// The size of the terms that it is a sum of.
    pub terms: f64,
    /// The place.
    pub at: P,
    /// Whether the tolerance leaves something of the terms.
    tells: bool,
}

impl<P> Finding<P> {
    /// A value held against a share of its terms, which has to leave a digit of them.
    pub fn relative(value: f64, tolerance: Tolerance, at: P) -> Self {
        let tells = (0.0..SHARE).contains(&tolerance.relative);
        Self { value, tolerance: tolerance.bound(), terms: tolerance.scale, at, tells }
    }

    /// A value held against a bound on its errors, which has to leave a digit of the `terms`.
    pub fn bounded(value: f64, tolerance: f64, terms: f64, at: P) -> Self {
        Self { value, tolerance, terms, at, tells: tells(tolerance, terms) }
    }

    /// Whether the value is zero to rounding. What is NaN or infinite is not, nor is anything beside a
    /// tolerance that the terms cannot exceed: it says nothing.
    #[must_use]
    pub fn vanishes(&self) -> bool {
        self.tells && is_zero(self.value, self.tolerance)
    }

    /// Whether the value is zero to rounding, or why not.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        match (self.tells, self.vanishes()) {
            (true, true) => Verdict::Yes,
            (true, false) => Verdict::No,
            (false, _) if self.tolerance.is_finite() && self.excess() > 1.0 => Verdict::No,
            (false, _) => Verdict::CannotTell,
        }
    }

    /// This finding, silent unless its tolerance leaves a digit of `quantity` too.
    pub(crate) fn beside(self, quantity: f64) -> Self {
        Self { tells: self.tells && tells(self.tolerance, quantity.abs()), ..self }
    }

    /// |value| in units of its tolerance.
    pub(crate) fn excess(&self) -> f64 {
        excess(self.value, self.tolerance)
    }

    /// |value| in units of its tolerance, infinite beside a tolerance that says nothing.
    pub(crate) fn excess_or_silence(&self) -> f64 {
        if self.tells { self.excess() } else { f64::INFINITY }
    }

    /// Puts this in the place of what is less bad by `measure`.
    pub(crate) fn keep_if_worse(self, worst: &mut Option<Self>, measure: impl Fn(&Self) -> f64) {
        if worst.as_ref().is_none_or(|known| measure(&self) > measure(known)) {
            *worst = Some(self);
        }
    }
}

impl<P: fmt::Display> fmt::Display for Finding<P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:+.2e}, zero below {:.1e}", self.value, self.tolerance)?;
        match self.verdict() {
            Verdict::Yes => Ok(()),
            Verdict::No => write!(f, ", at {}", self.at),
            Verdict::CannotTell => write!(f, ", which is too coarse to tell, at {}", self.at),
        }
    }
}

/// The bound up to which a quantity counts as zero: `relative` × `scale`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Rounding allowed, relative to the terms that the quantity is a sum of.
    pub relative: f64,
    /// Size of those terms: what the quantity could be if nothing cancelled.
    pub scale: f64,
}

impl Tolerance {
    /// Rounding that a checker allows unless told otherwise, in units of ε: a derivative of L or R takes some
    /// hundreds of roundings.
    pub(super) const ROUNDINGS: f64 = 1024.0;

    /// The default for the scalar type `S`.
    pub(crate) fn rounding<S: Scalar>() -> f64 {
        Self::ROUNDINGS * S::EPSILON.widen()
    }

    /// The largest magnitude that counts as zero.
    #[must_use]
    pub fn bound(&self) -> f64 {
        self.relative * self.scale
    }

    /// Whether a displacement by `value` leaves no digit beside the tolerance.
    pub(crate) fn hides(&self, value: f64) -> bool {
        value.abs() * SHARE <= self.bound()
    }
}

impl fmt::Display for Tolerance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.1e} = {:.1e} × {:.3e}, the size of the terms", self.bound(), self.relative, self.scale)
    }
}

/// Whether `value` counts as zero.
pub(crate) fn is_zero(value: f64, tolerance: f64) -> bool {
    value.is_finite() && tolerance.is_finite() && value.abs() <= tolerance
}

/// |`value`| in units of its tolerance: above 1 if and only if it does not count as zero.
pub(crate) fn excess(value: f64, tolerance: f64) -> f64 {
    if is_zero(value, tolerance) {
        if value == 0.0 { 0.0 } else { value.abs() / tolerance }
    } else {
        // A quotient of what is not finite would be small or NaN.
        let ratio = value.abs() / tolerance;
        if value.is_finite() && tolerance.is_finite() && ratio > 1.0 { ratio } else { f64::INFINITY }
    }
}

/// A tolerance of this share of the terms leaves one digit of them.
const SHARE: f64 = 0.1;

/// Whether a tolerance says anything: it leaves a digit of the terms that the quantity is a sum of, or
/// nothing is to be forgiven.
pub(crate) fn tells(tolerance: f64, terms: f64) -> bool {
    tolerance < SHARE * terms || tolerance == 0.0
}

/// The largest magnitude; NaN if there is a NaN, which `max` and `amax` pass over. 0 of nothing.
pub(crate) fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0_f64, |largest, value| {
        if value.abs() > largest || value.is_nan() { value.abs() } else { largest }
    })
}

/// The size of the terms that each sample's value is held against: its own, but no less than what half of the
/// samples exceed.
///
/// Terms that happen to be small at one sample are themselves rounded like their larger parts. The largest of
/// all would let one sample far out excuse every other.
pub(crate) fn scales(sizes: &[f64]) -> Vec<f64> {
    let median = median(sizes.iter().copied());
    sizes.iter().map(|&size| if size > median || size.is_nan() { size } else { median }).collect()
}

/// A size that half of the sizes that are not 0 exceed; 1 where all are 0.
pub(crate) fn typical(sizes: impl Iterator<Item = f64>) -> f64 {
    match median(sizes.filter(|size| *size != 0.0)) {
        0.0 => 1.0,
        size => size,
    }
}

/// The lower median, 0 of nothing.
fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut all: Vec<f64> = values.collect();
    if all.is_empty() {
        return 0.0;
    }
    let middle = (all.len() - 1) / 2;
    *all.select_nth_unstable_by(middle, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    const POISON: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

    #[test]
    fn nothing_infinite_counts_as_zero() {
        for poison in POISON {
            for other in [0.0, 1.0, f64::MAX, f64::NAN, f64::INFINITY] {
                assert!(!is_zero(poison, other) && !is_zero(other, poison), "{poison} {other}");
                assert!(excess(poison, other) > 1.0 && excess(other, poison) > 1.0, "{poison} {other}");
            }
        }
        // Positive control.
        assert!(is_zero(0.0, 0.0) && is_zero(-1e-14, 2e-14) && excess(-1e-14, 2e-14) == 0.5);
        assert!(!is_zero(5e-324, 0.0) && excess(5e-324, 0.0) > 1.0);
    }

    #[test]
    fn a_tolerance_beyond_the_terms_says_nothing() {
        assert!(tells(1e-14, 1.0) && tells(0.0, 0.0));
        assert!(!tells(0.5, 1.0) && !tells(f64::NAN, 1.0) && !tells(1.0, f64::NAN) && !tells(1e-3, 0.0));
    }

    #[test]
    fn the_largest_of_numbers_with_a_nan_is_nan() {
        assert!(largest([1.0, f64::NAN, 2.0]).is_nan() && largest([f64::NAN]).is_nan());
        assert_eq!(largest([1.0, -3.0, 2.0]), 3.0);
        assert_eq!(largest([]), 0.0);
    }

    #[test]
    fn one_sample_far_out_excuses_itself_alone() {
        assert_eq!(scales(&[1.0, 2.0, 1e200, 0.0]), [1.0, 2.0, 1e200, 1.0]);
        assert!(scales(&[1.0, f64::NAN, 2.0])[1].is_nan());
    }
}
