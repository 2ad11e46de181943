//! How far the sweeps of several members go where an error is asked for at an end.

use super::seen::Seen;
use crate::numbers::members::coordinate_by_coordinate;
use crate::numbers::{Mask, MemberVector, Members, Scalar};
use crate::rules::gauss::slack::{ROUNDINGS, Slack, remaining};

/// The [`Slack`] of each member, but for `of_step`, which all members share.
#[derive(Clone, Copy, Debug)]
pub(super) struct SlackOfMembers<T, const W: usize> {
    pub(super) steps: [u64; W],
    pub(super) change: [Members<T, W>; 2],
}

impl<T: Scalar, const W: usize> SlackOfMembers<T, W> {
    /// No steps that may leave anything unsolved.
    pub(super) fn none() -> Self {
        Self { steps: [0; W], change: [Members::splat(T::zero()); 2] }
    }

    pub(super) fn write(&mut self, lane: usize, slack: Slack<T>) {
        self.steps[lane] = slack.steps;
        for (change, of_member) in self.change.iter_mut().zip(slack.change) {
            change.0[lane] = of_member;
        }
    }

    /// [`Slack::follow`] of the members that have stepped, from and to these coordinates and momenta.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn follow<const N: usize>(
        &mut self,
        has_stepped: Mask<W>,
        steps: [[&MemberVector<T, N, W>; 2]; 2],
    ) {
        for (change, [from, to]) in self.change.iter_mut().zip(steps) {
            let mut largest = *change;
            coordinate_by_coordinate!(a => {
                largest = largest.larger((to[a] - from[a]).abs());
            });
            change.replace(true, has_stepped, largest);
        }
        for lane in 0..W {
            self.steps[lane] = self.steps[lane].saturating_sub(u64::from(has_stepped.0[lane]));
        }
    }
}

/// The [`Allowance`](crate::rules::gauss::slack::Allowance) of each member for the sweeps of one step; not
/// known of members with stages that are solved to rounding.
pub(super) struct Allowances<T, const W: usize> {
    pub(super) are_known: Mask<W>,
    per_correction: T,
    per_residual: Members<T, W>,
    /// The size of the last sweep but one and, in `last`, of the last, in units of the allowance.
    before: Members<T, W>,
    last: Members<T, W>,
}

impl<T: Scalar, const W: usize> Allowances<T, W> {
    /// [`Slack::allowance`] of each, for a step of size `h` from the momenta `p`; without a slack, known of
    /// no member.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn new<const N: usize>(
        slack: Option<Slack<T>>,
        of_members: &SlackOfMembers<T, W>,
        h: T,
        p: &MemberVector<T, N, W>,
    ) -> Self {
        let none = Members::splat(T::zero());
        let Some(Slack { of_step, .. }) = slack else {
            let are_known = Mask::splat(false);
            return Self { are_known, per_correction: h, per_residual: none, before: none, last: none };
        };
        let SlackOfMembers { steps, change: [q_change, p_change] } = *of_members;
        let mut largest = none;
        coordinate_by_coordinate!(a => {
            largest = largest.larger(p[a].abs());
        });
        let rounding = largest * (T::EPSILON * T::constant(ROUNDINGS)) * q_change;
        let mut are_known = Mask(steps.map(|steps| steps > 0));
        are_known = are_known & none.less(q_change) & rounding.less(p_change * of_step);
        let per_residual = q_change / (p_change * of_step);
        Self { are_known, per_correction: h.abs() / of_step, per_residual, before: none, last: none }
    }

    /// Which members with a known allowance are solved after sweep `iterations`. Clears `is_open` where their
    /// sweeps do not contract or numbers are not finite.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn solved<const N: usize>(
        &mut self,
        iterations: u32,
        is_open: &mut Mask<W>,
        seen: &Seen<T, N, W>,
    ) -> Mask<W> {
        let mut now = seen.correction * self.per_correction;
        coordinate_by_coordinate!(a => {
            now = now.larger(seen.residual[a] * self.per_residual);
        });
        let is_finite = ((seen.sum + now) * T::constant(256.0)).is_finite();
        *is_open = *is_open & (!self.are_known | is_finite);
        let mut is_within = Mask::splat(false);
        if iterations > 2 {
            let mut share = now;
            for lane in 0..W {
                share.0[lane] = remaining([self.before.0[lane], self.last.0[lane], now.0[lane]]);
            }
            is_within = self.are_known & (now * share).less_or_equal(Members::splat(T::one()));
            *is_open = *is_open & (!self.are_known | is_within | share.is_finite());
        }
        (self.before, self.last) = (self.last, now);
        *is_open & is_within
    }
}
