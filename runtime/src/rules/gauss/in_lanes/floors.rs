//! How far the sweeps of several members go to solve their stages to rounding.

use super::seen::Seen;
use crate::numbers::members::coordinate_by_coordinate;
use crate::numbers::{Mask, MemberVector, Members, Scalar};
use crate::rules::gauss::fixed_point::{AT_REST, CHANGED, NEAR, SLUGGISH};
use crate::step::newton::AT_FLOOR;

/// The round-off floor of each coordinate's residual, and residuals of a sweep and the two before in units of
/// it.
pub(super) struct Floors<T, const N: usize, const W: usize> {
    floor: MemberVector<T, N, W>,
    per_floor: MemberVector<T, N, W>,
    before: Members<T, W>,
    last: Members<T, W>,
    size: Members<T, W>,
}

/// How sweeps stand, of the members that were open.
pub(super) struct Verdict<const W: usize> {
    /// Members that are solved.
    pub(super) is_solved: Mask<W>,
    /// Members that apply the last correction too, where they are solved.
    pub(super) is_at_rest: Mask<W>,
    /// Members that are solved or may yet be; the others take the step alone.
    pub(super) is_open: Mask<W>,
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
        Self { floor: zero, per_floor: zero, before: one, last: one, size: one }
    }

    /// Judges members of `open` after sweep `iterations`.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn judge<const S: usize>(
        &mut self,
        iterations: u32,
        open: Mask<W>,
        seen: &Seen<T, N, W>,
        terms: &Terms<'_, T, N, S, W>,
        mass_is_constant: bool,
    ) -> Verdict<W> {
        let largest = &seen.residual;
        if iterations == 1 {
            self.floor = terms.floor(largest);
            self.per_floor = reciprocals(&self.floor);
        }
        self.size = in_units(largest, &self.per_floor);
        let mut is_open = open;
        if iterations == 1 {
            self.last = self.size;
        } else {
            let grows = open & !self.size.less(self.last);
            if grows.0.contains(&true) {
                is_open = is_open & self.rise(grows, &terms.floor(largest), largest);
            }
        }
        // As many of these in a sum would still be finite.
        is_open = is_open & ((seen.sum + self.size) * T::constant(256.0)).is_finite();

        let is_at_rest = self.is_at_rest(iterations, mass_is_constant);
        let has_stopped = if iterations > 1 {
            (self.last * T::constant(SLUGGISH)).less_or_equal(self.size)
        } else {
            Mask::splat(false)
        };
        let mut is_solved = is_open & (is_at_rest | (has_stopped & self.is_at_floor()));
        if iterations > 1 && is_solved.0.contains(&true) {
            is_solved = self.fall(is_solved, is_at_rest, &terms.floor(largest), largest);
        }
        if iterations > 2 {
            // Rounding has to be measured, or Newton's method takes over.
            is_open = is_open & (is_solved | self.size.less(self.before * T::constant(SLUGGISH)));
        }
        (self.before, self.last) = (self.last, self.size);
        Verdict { is_solved, is_at_rest, is_open }
    }

    /// Members whose last correction leaves nothing.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn is_at_rest(&self, iterations: u32, mass_is_constant: bool) -> Mask<W> {
        let (size, small) = (self.size, Members::splat(T::constant(AT_REST)));
        (size * size).less_or_equal(small * self.last)
            & if iterations > 2 {
                (size * self.last).less_or_equal(small * self.before)
            } else if !mass_is_constant {
                size.less_or_equal(small)
            } else if N > 1 {
                size.less_or_equal(Members::splat(T::constant(NEAR)))
            } else {
                Mask::splat(true)
            }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn is_at_floor(&self) -> Mask<W> {
        self.size.less_or_equal(Members::splat(T::constant(AT_FLOOR)))
    }

    /// Raises the floors of members with residuals that grow to those `now`, where they were much lower.
    /// Returns the members that may go on; not those that grow and have floors without an end.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn rise(
        &mut self,
        grows: Mask<W>,
        now: &MemberVector<T, N, W>,
        largest: &MemberVector<T, N, W>,
    ) -> Mask<W> {
        let (mut has_risen, mut goes_on) = (Mask::splat(false), Mask::splat(true));
        coordinate_by_coordinate!(a => {
            has_risen = has_risen | (self.floor[a] * T::constant(CHANGED)).less(now[a]);
            goes_on = goes_on & (!grows | now[a].is_finite());
        });
        let has_risen = grows & has_risen;
        coordinate_by_coordinate!(a => {
            self.floor[a] = Members::select(has_risen, self.floor[a].larger(now[a]), self.floor[a]);
        });
        self.begin_anew(has_risen, largest);
        goes_on
    }

    /// Lowers the floors of solved members to those `now`. Returns the members that are solved by these too.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn fall(
        &mut self,
        is_solved: Mask<W>,
        is_at_rest: Mask<W>,
        now: &MemberVector<T, N, W>,
        largest: &MemberVector<T, N, W>,
    ) -> Mask<W> {
        let changed = Members::splat(T::constant(CHANGED));
        let factor = Members::select(is_at_rest, changed, Members::splat(T::one()));
        let mut has_fallen = Mask::splat(false);
        coordinate_by_coordinate!(a => {
            has_fallen = has_fallen | (now[a] * factor).less(self.floor[a]);
        });
        let has_fallen = is_solved & has_fallen;
        coordinate_by_coordinate!(a => {
            self.floor[a] = Members::select(has_fallen, now[a], self.floor[a]);
        });
        self.begin_anew(has_fallen, largest);
        is_solved & (!has_fallen | (!is_at_rest & self.is_at_floor()))
    }

    /// Measures residuals by the floors as they are now; restarts the sizes before for members of `whose`.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn begin_anew(&mut self, whose: Mask<W>, largest: &MemberVector<T, N, W>) {
        self.per_floor = reciprocals(&self.floor);
        self.size = in_units(largest, &self.per_floor);
        self.before = Members::select(whose, self.size * T::constant(4.0), self.before);
        self.last = Members::select(whose, self.size, self.last);
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
