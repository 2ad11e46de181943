//! Explicit steps of several members at once, and their compositions: the operations of each member's own
//! run, in their order.
//!
//! The first step is each member's own, as it is of a run. From then on a member whose residual is above its
//! floor, where its own run would look closer, has no state.

#![allow(clippy::needless_range_loop, reason = "one index runs through several arrays together")]

use core::ops::Range;

use crate::numbers::members::{difference, each_coordinate, write_member};
use crate::numbers::{
    CompensatedMembers, Mask, MatricesOfMembers, MemberVector, Members, NewtonMatrix, Scalar,
};
use crate::rules::Trapezoidal;
use crate::run::{Composition, ExplicitInLanes};
use crate::step::in_lanes::newton::MatricesOf;
use crate::step::newton::AT_FLOOR;
use crate::step::{Ends, Flow, FlowInLanes, LaneRuns};
use crate::system::Lagrangian;

/// Values kept of W members on their way by explicit substeps, S in a step.
#[derive(Clone, Copy, Debug)]
pub struct SubstepsInLanes<T, A, const N: usize, const S: usize, const W: usize> {
    /// G(q), from the end of the first step on.
    force: MemberVector<T, N, W>,
    /// The first half and the middle, with which the others are the same.
    substeps: [Substep<T, A, N, W>; S],
}

/// A substep's size, and the values that depend on it alone.
#[derive(Clone, Copy, Debug)]
struct Substep<T, A, const N: usize, const W: usize> {
    h: T,
    /// P = ∂²L/∂v² + (h/2) ∂²R/∂v².
    matrices: A,
    /// ∂L/∂v + (h/2) ∂R/∂v at v̄ = 0.
    at_rest: MemberVector<T, N, W>,
}

/// [`SubstepsInLanes`] of the system type `L`.
type Of<L, const N: usize, const S: usize, const W: usize> =
    SubstepsInLanes<<L as Lagrangian<N>>::Scalar, MatricesOf<L, Trapezoidal, N, W>, N, S, W>;

/// The values kept of no member yet, each substep this share of h.
fn kept<T: Scalar, A: MatricesOfMembers<T, N, W>, const N: usize, const S: usize, const W: usize>(
    h: T,
    shares: &[f64; S],
) -> SubstepsInLanes<T, A, N, S, W> {
    let zero = [Members::splat(T::zero()); N];
    let substep = |share| Substep { h: T::constant(share) * h, matrices: A::zero(), at_rest: zero };
    SubstepsInLanes { force: zero, substeps: shares.map(substep) }
}

/// Factors the matrices of one member; whether they can be.
fn put<L, M, const N: usize, const S: usize, const W: usize>(
    runs: &mut LaneRuns<'_, L, M, N, W>,
    lane: usize,
) -> bool
where
    L: ExplicitInLanes<N> + FlowInLanes<M, N, Kept<W> = Of<L, N, S, W>>,
{
    let system = runs.systems[lane];
    for substep in &mut runs.kept.substeps {
        let matrix = system.step_matrix(substep.h);
        let Some(factored) = matrix.factored() else { return false };
        substep.matrices.write(lane, &matrix, &factored);
        let at_rest = system.velocity_momenta(&nalgebra::zero(), substep.h).p0;
        write_member(&mut substep.at_rest, lane, &at_rest);
    }
    true
}

/// q and p of the members, and which of them have not failed.
type Standing<T, const N: usize, const W: usize> =
    (CompensatedMembers<T, N, W>, CompensatedMembers<T, N, W>, Mask<W>);

/// The first step of each member that is new, its own; `start` is where they stood before the others went on.
#[cold]
#[inline(never)]
fn first_steps<L: FlowInLanes<M, N>, M, const N: usize, const W: usize>(
    runs: &mut LaneRuns<'_, L, M, N, W>,
    (q, p, is_sound): &Standing<L::Scalar, N, W>,
) {
    let is_new = runs.is_new;
    runs.q.replace(true, is_new, q);
    runs.p.replace(true, is_new, p);
    runs.is_new = Mask::splat(false);
    runs.is_sound = (runs.is_sound & !is_new) | (*is_sound & is_new);
    runs.step_alone(*is_sound & is_new, 0);
}

/// The first step of one member.
fn alone<L, M, const N: usize, const S: usize, const W: usize>(
    runs: &mut LaneRuns<'_, L, M, N, W>,
    lane: usize,
) -> Option<Ends<L::Scalar, N>>
where
    L: ExplicitInLanes<N> + FlowInLanes<M, N, Kept<W> = Of<L, N, S, W>>,
{
    let (system, mut state, mut elapsed) = (runs.systems[lane], runs.values(lane), 0.0);
    for substep in &runs.kept.substeps {
        let step = system.later(L::Scalar::constant(elapsed), |system| {
            Flow::<Trapezoidal, N>::step(system, &state, substep.h, None)
        });
        state = step.ok()?.state;
        elapsed += substep.h.widen();
    }
    if !L::IS_TIMED {
        write_member(&mut runs.kept.force, lane, &system.configuration_force(&state.q));
    }
    Some(state.into())
}

#[cfg_attr(not(debug_assertions), inline(always))]
fn advance<L, M, const N: usize, const S: usize, const W: usize>(
    runs: &mut LaneRuns<'_, L, M, N, W>,
    steps: u64,
) where
    L: ExplicitInLanes<N> + FlowInLanes<M, N, Kept<W> = Of<L, N, S, W>>,
{
    let mut taken = 0;
    if steps > 0 && runs.is_new.0.contains(&true) {
        let start = (runs.q, runs.p, runs.is_sound);
        if runs.is_new.0.contains(&false) {
            carry(runs, 0..1);
        }
        first_steps(runs, &start);
        taken = 1;
    }
    carry(runs, taken..steps);
}

/// Steps of all members alike.
#[cfg_attr(not(debug_assertions), inline(always))]
fn carry<L, M, const N: usize, const S: usize, const W: usize>(
    runs: &mut LaneRuns<'_, L, M, N, W>,
    steps: Range<u64>,
) where
    L: ExplicitInLanes<N> + FlowInLanes<M, N, Kept<W> = Of<L, N, S, W>>,
{
    // Locals, so that they stay in registers.
    let (fields, substeps) = (&runs.fields, &runs.kept.substeps);
    let (mut q, mut p, mut force) = (runs.q.value, runs.p.value, runs.kept.force);
    let mut is_sound = runs.is_sound;
    for step in steps {
        let mut elapsed = Members::<f64, W>::splat(0.0);
        if L::IS_TIMED {
            elapsed = runs.clocks.times(step, runs.h);
        }
        for i in 0..S {
            let substep = &substeps[if i < S - i { i } else { S - 1 - i }];
            let end;
            let mut fields = fields;
            if L::IS_TIMED {
                let start = L::later_in_lanes(fields, &Members(elapsed.0.map(L::Scalar::constant)));
                force = L::configuration_force_in_lanes(&start, &q);
                end = L::later_in_lanes(&start, &Members::<_, W>::splat(substep.h));
                fields = &end;
                elapsed = elapsed + substep.h.widen();
            }
            is_sound = is_sound & substep.take::<L>(fields, &mut q, &mut p, &mut force);
        }
    }
    (runs.q.value, runs.p.value, runs.kept.force, runs.is_sound) = (q, p, force, is_sound);
}

impl<T: Scalar, A, const N: usize, const W: usize> Substep<T, A, N, W> {
    /// Takes the substep, with `fields` at its end. Returns the members for which v solves its equation.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn take<L>(
        &self,
        fields: &L::Fields<'_, W>,
        q: &mut MemberVector<T, N, W>,
        p: &mut MemberVector<T, N, W>,
        force: &mut MemberVector<T, N, W>,
    ) -> Mask<W>
    where
        L: ExplicitInLanes<N, Scalar = T>,
        A: MatricesOfMembers<T, N, W>,
    {
        let half = self.h * T::constant(0.5);
        let (mut kick, mut right) = (*force, *p);
        each_coordinate!(i => {
            kick[i] = force[i] * half;
            right[i] = p[i] + kick[i];
        });
        let v = self.matrices.solve(&difference(&right, &self.at_rest));
        each_coordinate!(i => {
            q[i] = q[i] + v[i] * self.h;
        });
        *force = L::configuration_force_in_lanes(fields, q);
        let [p0, p1] = L::velocity_momenta_in_lanes(fields, &v, self.h);

        let unit = T::EPSILON * T::constant(4.0);
        let mut scaled = v;
        each_coordinate!(i => {
            scaled[i] = v[i] * unit;
        });
        let magnitudes = self.matrices.magnitudes(&scaled);
        let mut is_root = Mask::splat(true);
        each_coordinate!(i => {
            let floor = magnitudes[i] + (p[i].abs() * unit + T::SMALLEST_NORMAL);
            let most = floor * T::constant(AT_FLOOR);
            let residual = p0[i] - right[i];
            is_root = is_root & residual.abs().less_or_equal(most) & most.is_finite();
            p[i] = p[i] + (kick[i] + force[i] * half + (p1[i] - p0[i]));
        });
        is_root
    }
}

/// `impl FlowInLanes<method, N>`: steps of so many substeps, each this share of h.
macro_rules! by_substeps {
    ($method:ty: $substeps:tt, $shares:expr $(, const $s:ident)?) => {
        impl<L: ExplicitInLanes<N>, const N: usize $(, const $s: usize)?> FlowInLanes<$method, N> for L {
            type Kept<const W: usize> = Of<L, N, $substeps, W>;

            fn kept<const W: usize>(h: L::Scalar) -> Self::Kept<W> {
                kept(h, &$shares)
            }

            fn put<const W: usize>(runs: &mut LaneRuns<'_, L, $method, N, W>, lane: usize) -> bool {
                put(runs, lane)
            }

            #[cfg_attr(not(debug_assertions), inline(always))]
            fn advance_in_lanes<const W: usize>(
                runs: &mut LaneRuns<'_, L, $method, N, W>,
                steps: u64,
            ) {
                advance(runs, steps);
            }

            fn alone<const W: usize>(
                runs: &mut LaneRuns<'_, L, $method, N, W>,
                lane: usize,
                _elapsed: L::Scalar,
            ) -> Option<Ends<L::Scalar, N>> {
                alone(runs, lane)
            }
        }
    };
}
by_substeps!(Trapezoidal: 1, [1.0]);
by_substeps!(Composition<Trapezoidal, S>: S, Composition::<Trapezoidal, S>::SHARES, const S);
