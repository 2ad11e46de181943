//! Splittings of several members at once: the operations of each member's own run, in their order.

#![allow(clippy::needless_range_loop, reason = "one index runs through several arrays together")]

use nalgebra::SMatrix;

use super::underway::UnderwayInLanes;
use super::{Drifts, Prepared, Splitting, Sums};
use crate::numbers::members::{difference, each_coordinate, write_member};
use crate::numbers::{CompensatedMembers, Mask, MemberVector, Members, Scalar};
use crate::rules::Drift;
use crate::run::ExplicitInLanes;
use crate::step::{FlowInLanes, LaneRuns};
use crate::system::{Damping, NewtonStructure, Structure};

/// Values kept of W members on their way by a [`Splitting`].
#[derive(Clone, Copy, Debug)]
pub struct KicksInLanes<T, const N: usize, const S: usize, const W: usize> {
    drifts: DriftsInLanes<T, N, S, W>,
    /// G − ∂R/∂v(0) at q, where kicks come first.
    force: MemberVector<T, N, W>,
    /// bᵢh.
    kicks: [T; S],
    /// ∂L/∂v at v = 0.
    shift: MemberVector<T, N, W>,
    /// ∂R/∂v at v = 0.
    thrust: MemberVector<T, N, W>,
}

/// The drifts of all members: the first half and the middle, with which the others are the same.
#[derive(Clone, Copy, Debug)]
enum DriftsInLanes<T, const N: usize, const S: usize, const W: usize> {
    /// M and C of every member are diagonal, and no member is damped.
    Undamped([Drift<MemberVector<T, N, W>>; S]),
    /// M and C of every member are diagonal.
    Diagonal([Drift<MemberVector<T, N, W>>; S]),
    Full(FullDrifts<T, N, S, W>),
}

/// Matrices, row by row.
#[derive(Clone, Copy, Debug)]
struct FullDrifts<T, const N: usize, const S: usize, const W: usize> {
    drifts: [Drift<[MemberVector<T, N, W>; N]>; S],
    /// Members with diagonal M and C. Off-diagonal products are left out: they would turn −0.0 into 0.0.
    is_diagonal: Mask<W>,
    is_damped: Mask<W>,
}

/// Takes (q, p − ∂L/∂v(0)) through one drift.
trait Drifting<T, const N: usize, const W: usize> {
    /// The i-th of the first half.
    fn drift<C: Sums>(&self, i: usize, at: &mut UnderwayInLanes<'_, T, N, C, W>);
}

/// Drifts of the form [`DriftsInLanes::Undamped`].
struct Undamped<'d, T, const N: usize, const S: usize, const W: usize>(&'d [Drift<MemberVector<T, N, W>>; S]);

impl<T: Scalar, const N: usize, const S: usize, const W: usize> Drifting<T, N, W>
    for Undamped<'_, T, N, S, W>
{
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn drift<C: Sums>(&self, i: usize, at: &mut UnderwayInLanes<'_, T, N, C, W>) {
        let drift = &self.0[i];
        each_coordinate!(a => {
            at.drift(a, drift.displacement[a] * at.momentum(a));
        });
    }
}

/// Drifts of the form [`DriftsInLanes::Diagonal`].
struct Diagonal<'d, T, const N: usize, const S: usize, const W: usize>(&'d [Drift<MemberVector<T, N, W>>; S]);

impl<T: Scalar, const N: usize, const S: usize, const W: usize> Drifting<T, N, W>
    for Diagonal<'_, T, N, S, W>
{
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn drift<C: Sums>(&self, i: usize, at: &mut UnderwayInLanes<'_, T, N, C, W>) {
        let drift = &self.0[i];
        each_coordinate!(a => {
            let p = at.momentum(a);
            at.drift(a, drift.displacement[a] * p);
            at.kick(a, drift.loss[a] * p);
        });
    }
}

impl<T: Scalar, const N: usize, const S: usize, const W: usize> Drifting<T, N, W>
    for &FullDrifts<T, N, S, W>
{
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn drift<C: Sums>(&self, i: usize, at: &mut UnderwayInLanes<'_, T, N, C, W>) {
        let drift = &self.drifts[i];
        let mut before = [Members::splat(T::zero()); N];
        for a in 0..N {
            before[a] = at.momentum(a);
        }
        for a in 0..N {
            at.drift(a, self.product(&drift.displacement[a], &before, a));
            // Nothing, with the sign that leaves a zero as it is.
            let none = Members::splat(T::constant(-0.0));
            at.kick(a, Members::select(self.is_damped, self.product(&drift.loss[a], &before, a), none));
        }
    }
}

impl<T: Scalar, const N: usize, const S: usize, const W: usize> FullDrifts<T, N, S, W> {
    /// The a-th row times p, column by column as matrices are multiplied.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn product(&self, row: &MemberVector<T, N, W>, p: &MemberVector<T, N, W>, a: usize) -> Members<T, W> {
        let mut sum = row[0] * p[0];
        for b in 1..N {
            sum = row[b] * p[b] + sum;
        }
        Members::select(self.is_diagonal, row[a] * p[a], sum)
    }
}

/// q, p and the force of all members.
type Carried<T, const N: usize, const W: usize> =
    (CompensatedMembers<T, N, W>, CompensatedMembers<T, N, W>, MemberVector<T, N, W>);

/// As many steps, with the force −∇V(q) + f(q) of all members.
#[cfg_attr(not(debug_assertions), inline(always))]
fn carry<L, D, const N: usize, const S: usize, C: Sums, const W: usize>(
    runs: &LaneRuns<'_, L, Splitting<S, C>, N, W>,
    steps: u64,
    drifts: D,
) -> Carried<L::Scalar, N, W>
where
    L: ExplicitInLanes<N>,
    D: Drifting<L::Scalar, N, W>,
{
    // Locals, so that they stay in registers.
    let (fields, h) = (&runs.fields, runs.h);
    let KicksInLanes { kicks, shift, thrust, .. } = &runs.kept;
    let (mut q, mut p, mut force) = (runs.q, runs.p, runs.kept.force);
    let mut sum = [Members::splat(nalgebra::zero()); N];
    for step in 0..steps {
        let present;
        let mut now = fields;
        if L::IS_TIMED {
            present = L::later_in_lanes(fields, &runs.clocks.elapsed(step, h));
            now = &present;
        }
        let mut at = UnderwayInLanes::<L::Scalar, N, C, W>::new(&mut q, &mut p, shift);
        if Splitting::<S>::DRIFTS_FIRST {
            drifts.drift(0, &mut at);
            for i in 0..S {
                force = difference(&force_after::<L, N, S, W>(now, i, h, at.configuration(&mut sum)), thrust);
                for a in 0..N {
                    at.kick(a, force[a] * kicks[i]);
                }
                drifts.drift(if i < S - 1 - i { i + 1 } else { S - 1 - i }, &mut at);
            }
            at.end();
            continue;
        }
        if L::IS_TIMED {
            force = difference(&L::configuration_force_in_lanes(now, at.configuration(&mut sum)), thrust);
        }
        each_coordinate!(a => {
            at.kick(a, force[a] * kicks[0]);
        });
        for i in 0..S {
            drifts.drift(if i < S - i { i } else { S - 1 - i }, &mut at);
            force = difference(&force_after::<L, N, S, W>(now, i, h, at.configuration(&mut sum)), thrust);
            let kick = kicks[if i + 1 < S { i + 1 } else { 0 }];
            each_coordinate!(a => {
                at.kick(a, force[a] * kick);
            });
        }
        at.end();
    }
    (q, p, force)
}

/// G(q) of each after the i-th drift of the step, from the time that `fields` has.
#[cfg_attr(not(debug_assertions), inline(always))]
fn force_after<L: ExplicitInLanes<N>, const N: usize, const S: usize, const W: usize>(
    fields: &L::Fields<'_, W>,
    i: usize,
    h: L::Scalar,
    q: &MemberVector<L::Scalar, N, W>,
) -> MemberVector<L::Scalar, N, W> {
    let in_time;
    let mut now = fields;
    if L::IS_TIMED {
        let elapsed = Members::<_, W>::splat(L::Scalar::constant(Splitting::<S>::NODES[i]) * h);
        in_time = L::later_in_lanes(fields, &elapsed);
        now = &in_time;
    }
    L::configuration_force_in_lanes(now, q)
}

impl<T: Scalar, const N: usize, const S: usize, const W: usize> DriftsInLanes<T, N, S, W> {
    /// Writes those of one member, in a form that serves it and all others.
    fn write(&mut self, lane: usize, of: &Prepared<T, N, S>) {
        if let Drifts::Full(_) = of.drifts {
            self.fill();
        }
        match self {
            Self::Full(full) => full.write(lane, of),
            Self::Undamped(drifts) if of.is_damped => {
                let mut drifts = *drifts;
                write_diagonals(&mut drifts, lane, of);
                *self = Self::Diagonal(drifts);
            }
            Self::Undamped(drifts) | Self::Diagonal(drifts) => write_diagonals(drifts, lane, of),
        }
    }

    /// Takes the form [`Full`](Self::Full).
    fn fill(&mut self) {
        let (Self::Undamped(diagonals) | Self::Diagonal(diagonals)) = *self else { return };
        let zero = [[Members::splat(T::zero()); N]; N];
        let mut drifts = [Drift { displacement: zero, loss: zero }; S];
        for (drift, diagonal) in drifts.iter_mut().zip(&diagonals) {
            for a in 0..N {
                drift.displacement[a][a] = diagonal.displacement[a];
                drift.loss[a][a] = diagonal.loss[a];
            }
        }
        // A loss of 0 leaves every p as it is.
        let (is_diagonal, is_damped) = (Mask::splat(true), Mask::splat(true));
        *self = Self::Full(FullDrifts { drifts, is_diagonal, is_damped });
    }
}

impl<T: Scalar, const N: usize, const S: usize, const W: usize> FullDrifts<T, N, S, W> {
    /// Writes those of one member.
    fn write(&mut self, lane: usize, of: &Prepared<T, N, S>) {
        self.is_diagonal.0[lane] = matches!(of.drifts, Drifts::Diagonal(_));
        self.is_damped.0[lane] = of.is_damped;
        for (i, drift) in self.drifts.iter_mut().enumerate() {
            let Drift { displacement, loss } = of.drift(i);
            write_rows(&mut drift.displacement, lane, &displacement);
            write_rows(&mut drift.loss, lane, &loss);
        }
    }
}

/// Writes the drifts of one member, which are diagonal.
fn write_diagonals<T: Scalar, const N: usize, const S: usize, const W: usize>(
    drifts: &mut [Drift<MemberVector<T, N, W>>; S],
    lane: usize,
    of: &Prepared<T, N, S>,
) {
    let Drifts::Diagonal(of_member) = &of.drifts else { return };
    for (drift, of_member) in drifts.iter_mut().zip(of_member) {
        write_member(&mut drift.displacement, lane, &of_member.displacement);
        // Without damping the loss is 0 with the sign that leaves every p as it is, −0 too.
        let loss = if of.is_damped { of_member.loss } else { nalgebra::zero() };
        write_member(&mut drift.loss, lane, &loss);
    }
}

/// Writes the matrix of one member.
fn write_rows<T: Scalar, const N: usize, const W: usize>(
    rows: &mut [MemberVector<T, N, W>; N],
    lane: usize,
    matrix: &SMatrix<T, N, N>,
) {
    for (a, row) in rows.iter_mut().enumerate() {
        write_member(row, lane, &matrix.row(a).transpose());
    }
}

/// Whether there may be an R.
const fn may_be_damped(structure: &Structure) -> bool {
    !matches!(structure.damping, Damping::Absent)
}

/// Whether M or C may have entries off their diagonals: the trapezoidal rule's matrix has those of both.
const fn may_be_full<const N: usize>(structure: &Structure) -> bool {
    let of_both = structure.newton_matrix("Trapezoidal");
    N > 1 && !matches!(of_both, Some(NewtonStructure { bandwidth: 0, .. }))
}

impl<L, const N: usize, const S: usize, C: Sums> FlowInLanes<Splitting<S, C>, N> for L
where
    L: ExplicitInLanes<N>,
{
    type Kept<const W: usize> = KicksInLanes<L::Scalar, N, S, W>;

    fn kept<const W: usize>(h: L::Scalar) -> Self::Kept<W> {
        let zero = [Members::splat(nalgebra::zero()); N];
        KicksInLanes {
            drifts: DriftsInLanes::Undamped([Drift { displacement: zero, loss: zero }; S]),
            force: zero,
            kicks: Splitting::<S>::KICKS.map(|share| L::Scalar::constant(share) * h),
            shift: zero,
            thrust: zero,
        }
    }

    fn put<const W: usize>(runs: &mut LaneRuns<'_, L, Splitting<S, C>, N, W>, lane: usize) -> bool {
        let system = runs.systems[lane];
        let Ok(prepared) = Prepared::new(system, runs.h) else { return false };
        let q = runs.values(lane).q;
        let kept = &mut runs.kept;
        kept.drifts.write(lane, &prepared);
        write_member(&mut kept.shift, lane, &prepared.shift);
        write_member(&mut kept.thrust, lane, &prepared.thrust);
        if !Splitting::<S>::DRIFTS_FIRST && !L::IS_TIMED {
            write_member(&mut kept.force, lane, &(system.configuration_force(&q) - prepared.thrust));
        }
        true
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn advance_in_lanes<const W: usize>(runs: &mut LaneRuns<'_, L, Splitting<S, C>, N, W>, steps: u64) {
        (runs.q, runs.p, runs.kept.force) = match &runs.kept.drifts {
            DriftsInLanes::Undamped(drifts) => carry(runs, steps, Undamped(drifts)),
            DriftsInLanes::Diagonal(drifts) if const { may_be_damped(&L::STRUCTURE) } => {
                carry(runs, steps, Diagonal(drifts))
            }
            DriftsInLanes::Full(drifts) if const { may_be_full::<N>(&L::STRUCTURE) } => {
                carry(runs, steps, drifts)
            }
            // Of no system with this structure: if it is wrong, each member is left to a run of its own.
            DriftsInLanes::Diagonal(_) | DriftsInLanes::Full(_) => {
                runs.is_sound = Mask::splat(false);
                return;
            }
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Drifts that no member can have are not compiled; where nothing is known, all are.
    #[test]
    fn drifts_are_those_that_the_structure_allows() {
        const DIAGONAL: NewtonStructure =
            NewtonStructure { rule: "Trapezoidal", constant: true, bandwidth: 0 };
        const BAND: NewtonStructure = NewtonStructure { bandwidth: 1, ..DIAGONAL };
        const OTHER: NewtonStructure = NewtonStructure { rule: "Midpoint", ..DIAGONAL };
        let unknown = Structure::UNKNOWN;
        assert!(may_be_damped(&unknown) && may_be_damped(&unknown.with_damping(Damping::Linear)));
        assert!(!may_be_damped(&unknown.with_damping(Damping::Absent)));
        assert!(may_be_full::<2>(&unknown) && !may_be_full::<1>(&unknown));
        assert!(!may_be_full::<2>(&unknown.with_newton_matrices(&[OTHER, DIAGONAL])));
        assert!(may_be_full::<2>(&unknown.with_newton_matrices(&[OTHER, BAND])));
        assert!(may_be_full::<2>(&unknown.with_newton_matrices(&[OTHER])));
    }
}
