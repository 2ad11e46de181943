//! Where a step by a [`Splitting`](super::Splitting) is: of one run, and of several members.

use core::marker::PhantomData;

use nalgebra::SVector;

use super::Sums;
use crate::numbers::members::{difference, each_coordinate};
use crate::numbers::{Compensated, CompensatedMembers, MemberVector, Members, Scalar};
use crate::step::State;

/// (q, p − ∂L/∂v(0)) on the way through a step.
///
/// With compensated sums they are the sums of where the step began and of what it has added since, which is
/// rounded as the small number that it is; what the last sum loses is added in the next step.
pub(super) struct Underway<T, const N: usize, C: Sums> {
    /// With compensated sums what has been added, otherwise where it is.
    q: SVector<T, N>,
    p: SVector<T, N>,
    start: State<T, N>,
    /// ∂L/∂v at v = 0.
    shift: SVector<T, N>,
    sums: PhantomData<C>,
}

impl<T: Scalar, const N: usize, C: Sums> Underway<T, N, C> {
    /// At `start`; with what sums have lost if the step before ended there.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn new(
        start: &State<T, N>,
        shift: &SVector<T, N>,
        before: Option<&[Compensated<T, N>; 2]>,
    ) -> Self {
        let (mut q, mut p) = (start.q, start.p - shift);
        if C::ARE_COMPENSATED {
            let ended = before.filter(|[q, p]| q.value == start.q && p.value == start.p);
            [q, p] = ended.map_or_else(|| [nalgebra::zero(); 2], |[q, p]| [q.rest, p.rest]);
        }
        Self { q, p, start: *start, shift: *shift, sums: PhantomData }
    }

    /// q, itself or as the sum that is put into `sum`.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn configuration<'s>(&'s self, sum: &'s mut SVector<T, N>) -> &'s SVector<T, N> {
        if C::ARE_COMPENSATED {
            *sum = self.start.q + self.q;
            sum
        } else {
            &self.q
        }
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn momentum(&self) -> SVector<T, N> {
        if C::ARE_COMPENSATED { self.start.p - self.shift + self.p } else { self.p }
    }

    /// Moves q.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn drift(&mut self, displacement: &SVector<T, N>) {
        self.q += displacement;
    }

    /// Moves p.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn kick(&mut self, impulse: &SVector<T, N>) {
        self.p += impulse;
    }

    /// The state at the end, and what its sums have lost.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn end(&self) -> (State<T, N>, Option<[Compensated<T, N>; 2]>) {
        if C::ARE_COMPENSATED {
            let q = Compensated::new(self.start.q).plus(&self.q);
            let p = Compensated::new(self.start.p).plus(&self.p);
            (State { q: q.value, p: p.value }, Some([q, p]))
        } else {
            (State { q: self.q, p: self.p + self.shift }, None)
        }
    }
}

/// [`Underway`] of each member: with compensated sums what is added joins what they have lost, otherwise the
/// values themselves move.
pub(super) struct UnderwayInLanes<'s, T, const N: usize, C: Sums, const W: usize> {
    q: &'s mut CompensatedMembers<T, N, W>,
    p: &'s mut CompensatedMembers<T, N, W>,
    /// p − ∂L/∂v(0) at the start; only of compensated sums.
    start: MemberVector<T, N, W>,
    shift: &'s MemberVector<T, N, W>,
    sums: PhantomData<C>,
}

impl<'s, T: Scalar, const N: usize, C: Sums, const W: usize> UnderwayInLanes<'s, T, N, C, W> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn new(
        q: &'s mut CompensatedMembers<T, N, W>,
        p: &'s mut CompensatedMembers<T, N, W>,
        shift: &'s MemberVector<T, N, W>,
    ) -> Self {
        let start = difference(&p.value, shift);
        if !C::ARE_COMPENSATED {
            p.value = start;
        }
        Self { q, p, start, shift, sums: PhantomData }
    }

    /// q, itself or as the sum that is put into `sum`.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn configuration<'a>(
        &'a self,
        sum: &'a mut MemberVector<T, N, W>,
    ) -> &'a MemberVector<T, N, W> {
        if !C::ARE_COMPENSATED {
            return &self.q.value;
        }
        each_coordinate!(a => {
            sum[a] = self.q.value[a] + self.q.rest[a];
        });
        sum
    }

    /// The entry `a` of p.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn momentum(&self, a: usize) -> Members<T, W> {
        if C::ARE_COMPENSATED { self.start[a] + self.p.rest[a] } else { self.p.value[a] }
    }

    /// Moves the coordinate `a` of q.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn drift(&mut self, a: usize, displacement: Members<T, W>) {
        let moved = if C::ARE_COMPENSATED { &mut self.q.rest[a] } else { &mut self.q.value[a] };
        *moved = *moved + displacement;
    }

    /// Moves the coordinate `a` of p.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn kick(&mut self, a: usize, impulse: Members<T, W>) {
        let moved = if C::ARE_COMPENSATED { &mut self.p.rest[a] } else { &mut self.p.value[a] };
        *moved = *moved + impulse;
    }

    /// Leaves the members where the step ends.
    #[cfg_attr(not(debug_assertions), inline(always))]
    pub(super) fn end(self) {
        let Self { q, p, shift, .. } = self;
        if C::ARE_COMPENSATED {
            *q = CompensatedMembers::new(q.value).plus(&q.rest);
            *p = CompensatedMembers::new(p.value).plus(&p.rest);
        } else {
            each_coordinate!(a => {
                p.value[a] = p.value[a] + shift[a];
            });
        }
    }
}
