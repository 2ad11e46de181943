//! Where a step by a [`Splitting`](super::Splitting) is: of one run, and of several members.

use nalgebra::SVector;

use crate::numbers::members::{difference, each_coordinate};
use crate::numbers::{Compensated, CompensatedMembers, MemberVector, Members, Scalar};
use crate::step::State;

/// (q, p − ∂L/∂v(0)) on the way through a step.
///
/// With compensated sums they are the sums of where the step began and of what it has added since, which is rounded
/// as the small number that it is; what the last sum loses is added in the next step.
pub(super) struct Underway<T, const N: usize, const COMPENSATED: bool> {
    /// With compensated sums what has been added, otherwise where it is.
    q: SVector<T, N>,
    p: SVector<T, N>,
    start: State<T, N>,
    /// ∂L/∂v at v = 0.
    shift: SVector<T, N>,
}

impl<T: Scalar, const N: usize, const COMPENSATED: bool> Underway<T, N, COMPENSATED> {
    /// At `start`; with what sums have lost if the step before ended there.
    #[inline(always)]
    pub(super) fn new(
        start: &State<T, N>,
        shift: &SVector<T, N>,
        before: Option<&[Compensated<T, N>; 2]>,
    ) -> Self {
        let (mut q, mut p) = (start.q, start.p - shift);
        if COMPENSATED {
            let ended = before.filter(|[q, p]| q.value == start.q && p.value == start.p);
            [q, p] = ended.map_or_else(|| [nalgebra::zero(); 2], |[q, p]| [q.rest, p.rest]);
        }
        Self { q, p, start: *start, shift: *shift }
    }

    #[inline(always)]
    pub(super) fn configuration(&self) -> SVector<T, N> {
        if COMPENSATED { self.start.q + self.q } else { self.q }
    }

    #[inline(always)]
    pub(super) fn momentum(&self) -> SVector<T, N> {
        if COMPENSATED { self.start.p - self.shift + self.p } else { self.p }
    }

    /// Moves q.
    #[inline(always)]
    pub(super) fn drift(&mut self, displacement: &SVector<T, N>) {
        self.q += displacement;
    }

    /// Moves p.
    #[inline(always)]
    pub(super) fn kick(&mut self, impulse: &SVector<T, N>) {
        self.p += impulse;
    }

    /// The state at the end, and what its sums have lost.
    #[inline(always)]
    pub(super) fn end(&self) -> (State<T, N>, Option<[Compensated<T, N>; 2]>) {
        if COMPENSATED {
            let q = Compensated::new(self.start.q).plus(&self.q);
            let p = Compensated::new(self.start.p).plus(&self.p);
            (State { q: q.value, p: p.value }, Some([q, p]))
        } else {
            (State { q: self.q, p: self.p + self.shift }, None)
        }
    }
}

/// [`Underway`] of each member.
pub(super) struct UnderwayInLanes<T, const N: usize, const COMPENSATED: bool, const W: usize> {
    q: MemberVector<T, N, W>,
    p: MemberVector<T, N, W>,
    start: [MemberVector<T, N, W>; 2],
}

impl<T: Scalar, const N: usize, const COMPENSATED: bool, const W: usize>
    UnderwayInLanes<T, N, COMPENSATED, W>
{
    #[inline(always)]
    pub(super) fn new(
        q: &CompensatedMembers<T, N, W>,
        p: &CompensatedMembers<T, N, W>,
        shift: &MemberVector<T, N, W>,
    ) -> Self {
        let start = [q.value, difference(&p.value, shift)];
        let [q, p] = if COMPENSATED { [q.rest, p.rest] } else { start };
        Self { q, p, start }
    }

    #[inline(always)]
    pub(super) fn configuration(&self) -> MemberVector<T, N, W> {
        let mut q = self.q;
        if COMPENSATED {
            each_coordinate!(a => {
                q[a] = self.start[0][a] + q[a];
            });
        }
        q
    }

    /// The entry `a` of p.
    #[inline(always)]
    pub(super) fn momentum(&self, a: usize) -> Members<T, W> {
        if COMPENSATED { self.start[1][a] + self.p[a] } else { self.p[a] }
    }

    /// Moves the coordinate `a` of q.
    #[inline(always)]
    pub(super) fn drift(&mut self, a: usize, displacement: Members<T, W>) {
        self.q[a] = self.q[a] + displacement;
    }

    /// Moves the coordinate `a` of p.
    #[inline(always)]
    pub(super) fn kick(&mut self, a: usize, impulse: Members<T, W>) {
        self.p[a] = self.p[a] + impulse;
    }

    /// Where the step that began at the momenta `start` ends, with what its sums have lost.
    #[inline(always)]
    pub(super) fn end(
        mut self,
        start: &CompensatedMembers<T, N, W>,
        shift: &MemberVector<T, N, W>,
    ) -> [CompensatedMembers<T, N, W>; 2] {
        if COMPENSATED {
            let q = CompensatedMembers::new(self.start[0]).plus(&self.q);
            return [q, CompensatedMembers::new(start.value).plus(&self.p)];
        }
        each_coordinate!(a => {
            self.p[a] = self.p[a] + shift[a];
        });
        [CompensatedMembers::new(self.q), CompensatedMembers::new(self.p)]
    }
}
