//! How far the sweeps of several members go to solve their stages to rounding.

use super::seen::Seen;
use crate::numbers::members::coordinate_by_coordinate;
use crate::numbers::{Mask, MemberVector, Members, Scalar};
use crate::rules::gauss::fixed_point::{AT_REST, CHANGED, NEAR, SLUGGISH};
use crate::step::newton::AT_FLOOR;

/// The round-off floor of each coordinate's residual, and residuals of the last two sweeps in units of it.
pub(super) struct Floors<T, const N: usize, const W: usize> {
    floor: MemberVector<T, N, W>,
    per_floor: MemberVector<T, N, W>,
    before: Members<T, W>,
    last: Members<T, W>,
}

/// The terms that the floor of a step is made of.
pub(super) struct Terms<'a, T, const N: usize, const S: usize, const W: usize> {
    pub(super) h: T,
    pub(super) p: &'a MemberVector<T, N, W>,
    pub(super) rate: &'a [MemberVector<T, N, W>; S],
}

impl<T: Scalar, const N: usize, const S: usize, const W: usize> Terms<'_, T, N, S, W> {
    /// [`Problem::floor`](crate::rules::gauss::problem::Problem::floor) of each, with the `largest` residual
    /// of each coordinate.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn floor(&self, largest: &MemberVector<T, N, W>) -> MemberVector<T, N, W> {
        let unit = T::EPSILON * T::constant(4.0);
        let of_rate = (self.h * unit).abs();
        let mut floor = *largest;
        coordinate_by_coordinate!(a => {
            let mut largest_rate = self.rate[0][a].abs();
            for i in 1..S {
                largest_rate = largest_rate.larger(self.rate[i][a].abs());
            }
            let terms = self.p[a].abs() + largest[a];
            // Not a number where the largest would not be that of a finite sum.
            let poison = largest_rate * T::constant(256.0) * T::zero();
            floor[a] = terms * unit + largest_rate * of_rate + T::SMALLEST_NORMAL + poison;
        });
        floor
    }
}

impl<T: Scalar, const N: usize, const W: usize> Floors<T, N, W> {
    /// Before the first sweep.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn new() -> Self {
        let zero = [Members::splat(T::zero()); N];
        let one = Members::splat(T::one());
        Self { floor: zero, per_floor: zero, before: one, last: one }
    }

    /// Which members of `whose` are solved after sweep `iterations`, and where these apply the last
    /// correction too. Clears `is_open` for members of `whose` that have to take the step alone.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn solved<const S: usize>(
        &mut self,
        iterations: u32,
        (is_open, whose): (&mut Mask<W>, Mask<W>),
        seen: &Seen<T, N, W>,
        terms: &Terms<'_, T, N, S, W>,
        mass_is_constant: bool,
    ) -> [Mask<W>; 2] {
        let constant = T::constant;
        let largest = &seen.residual;
        if iterations == 1 {
            self.floor = terms.floor(largest);
            self.per_floor = reciprocals(&self.floor);
        }
        let mut size = in_units(largest, &self.per_floor);
        if iterations == 1 {
            self.last = size;
        } else {
            let grows = *is_open & whose & !size.less(self.last);
            if grows.0.contains(&true) {
                let now = terms.floor(largest);
                let mut has_risen = Mask::splat(false);
                coordinate_by_coordinate!(a => {
                    has_risen = has_risen | (self.floor[a] * constant(CHANGED)).less(now[a]);
                    *is_open = *is_open & (!grows | now[a].is_finite());
                });
                let has_risen = grows & has_risen;
                coordinate_by_coordinate!(a => {
                    self.floor[a] = Members::select(has_risen, self.floor[a].larger(now[a]), self.floor[a]);
                });
                size = self.begin_anew(has_risen, largest);
            }
        }
        // As many of these in a sum would still be finite.
        *is_open = *is_open & (!whose | ((seen.sum + size) * constant(256.0)).is_finite());

        let small = Members::splat(constant(AT_REST));
        let is_at_rest = (size * size).less_or_equal(small * self.last)
            & if iterations > 2 {
                (size * self.last).less_or_equal(small * self.before)
            } else if !mass_is_constant {
                size.less_or_equal(small)
            } else if N > 1 {
                size.less_or_equal(Members::splat(constant(NEAR)))
            } else {
                Mask::splat(true)
            };
        let mut has_stopped = Mask::splat(false);
        if iterations > 1 {
            has_stopped = (self.last * constant(SLUGGISH)).less_or_equal(size);
        }
        let at_floor = size.less_or_equal(Members::splat(constant(AT_FLOOR)));
        let mut is_done = *is_open & whose & (is_at_rest | (has_stopped & at_floor));
        if iterations > 1 && is_done.0.contains(&true) {
            let now = terms.floor(largest);
            let factor =
                Members::select(is_at_rest, Members::splat(constant(CHANGED)), Members::splat(T::one()));
            let mut has_fallen = Mask::splat(false);
            coordinate_by_coordinate!(a => {
                has_fallen = has_fallen | (now[a] * factor).less(self.floor[a]);
            });
            let has_fallen = is_done & has_fallen;
            coordinate_by_coordinate!(a => {
                self.floor[a] = Members::select(has_fallen, now[a], self.floor[a]);
            });
            size = self.begin_anew(has_fallen, largest);
            let at_floor = size.less_or_equal(Members::splat(constant(AT_FLOOR)));
            is_done = is_done & (!has_fallen | (!is_at_rest & at_floor));
        }
        if iterations > 2 {
            // Rounding has to be measured, or Newton's method takes over.
            *is_open = *is_open & (!whose | is_done | size.less(self.before * constant(SLUGGISH)));
        }
        (self.before, self.last) = (self.last, size);
        [is_done, is_at_rest]
    }

    /// Measures residuals by the floors as they are now; restarts the sizes before for members of `whose`.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn begin_anew(&mut self, whose: Mask<W>, largest: &MemberVector<T, N, W>) -> Members<T, W> {
        self.per_floor = reciprocals(&self.floor);
        let size = in_units(largest, &self.per_floor);
        self.before = Members::select(whose, size * T::constant(4.0), self.before);
        self.last = Members::select(whose, size, self.last);
        size
    }
}

/// [`reciprocals`](crate::rules::gauss::problem::reciprocals) of each.
#[cfg_attr(not(debug_assertions), inline(always))]
fn reciprocals<T: Scalar, const N: usize, const W: usize>(
    floor: &MemberVector<T, N, W>,
) -> MemberVector<T, N, W> {
    let mut reciprocals = *floor;
    coordinate_by_coordinate!(a => {
        reciprocals[a] = Members::splat(T::one()) / floor[a] + floor[a] * T::zero();
    });
    reciprocals
}

/// [`in_units`](crate::rules::gauss::problem::in_units) of each, of the `largest` residual of each
/// coordinate; not finite where a floor is not.
#[cfg_attr(not(debug_assertions), inline(always))]
fn in_units<T: Scalar, const N: usize, const W: usize>(
    largest: &MemberVector<T, N, W>,
    per_floor: &MemberVector<T, N, W>,
) -> Members<T, W> {
    let (mut size, mut poison) = (Members::splat(T::zero()), Members::splat(T::zero()));
    coordinate_by_coordinate!(a => {
        let units = largest[a] * per_floor[a];
        size = size.larger(units);
        poison = poison + units * T::zero();
    });
    size + poison
}
