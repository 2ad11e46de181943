//! Explicit steps of several members at once, and their compositions: the operations of each member's own
//! run, in their order.
//!
//! The first step is each member's own, as it is of a run. From then on a member whose residual is above its
//! floor, where its own run would look closer, has no state.

#![allow(clippy::needless_range_loop, reason = "one index runs through several arrays together")]

use super::{begins, state_if_sound};
use crate::numbers::members::{difference, each_coordinate, member, write_member};
use crate::numbers::{Mask, MatricesOfMembers, MemberVector, Members, NewtonMatrix, Scalar};
use crate::rules::Trapezoidal;
use crate::run::{Composition, ExplicitInLanes, FlowInLanes};
use crate::step::in_lanes::clocks::Clocks;
use crate::step::newton::AT_FLOOR;
use crate::step::{Flow, State};

/// W members on their way by explicit substeps, S in a step.
#[derive(Clone, Copy, Debug)]
pub struct ExplicitSteps<T, F, A, const N: usize, const S: usize, const W: usize> {
    /// Members that have not failed: their q and p equal those of their own runs.
    is_sound: Mask<W>,
    /// Members that take their first step next.
    is_new: Mask<W>,
    h: T,
    /// Kept where the force takes the time.
    clocks: Clocks<W>,
    fields: F,
    q: MemberVector<T, N, W>,
    p: MemberVector<T, N, W>,
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

/// [`ExplicitSteps`] of the system type `L`.
type Of<L, const N: usize, const S: usize, const W: usize> = ExplicitSteps<
    <L as crate::system::Lagrangian<N>>::Scalar,
    <L as ExplicitInLanes<N>>::Fields<W>,
    <<L as crate::step::Fused<Trapezoidal, N>>::Matrix as NewtonMatrix<
        <L as crate::system::Lagrangian<N>>::Scalar,
        N,
    >>::OfMembers<W>,
    N,
    S,
    W,
>;

/// The members at their starts.
fn started<L: ExplicitInLanes<N>, const N: usize, const S: usize, const W: usize>(
    systems: [&L; W],
    starts: &[State<L::Scalar, N>; W],
    h: L::Scalar,
    shares: &[f64; S],
) -> Of<L, N, S, W> {
    let zero = [Members::splat(L::Scalar::constant(0.0)); N];
    let mut steps = Of::<L, N, S, W> {
        is_sound: Mask::splat(false),
        is_new: Mask::splat(false),
        h,
        clocks: Clocks::new(),
        fields: L::fields(systems),
        q: zero,
        p: zero,
        force: zero,
        substeps: shares.map(|share| Substep {
            h: L::Scalar::constant(share) * h,
            matrices: MatricesOfMembers::zero(),
            at_rest: zero,
        }),
    };
    for (lane, (system, start)) in systems.into_iter().zip(starts).enumerate() {
        put(&mut steps, lane, system, start, h);
    }
    steps
}

/// Puts a member into a lane, at its start.
fn put<L: ExplicitInLanes<N>, const N: usize, const S: usize, const W: usize>(
    steps: &mut Of<L, N, S, W>,
    lane: usize,
    system: &L,
    start: &State<L::Scalar, N>,
    h: L::Scalar,
) {
    steps.is_sound.0[lane] = begins(lane, system, start, h) && prepare(steps, lane, system);
    steps.is_new.0[lane] = true;
    steps.clocks.restart(lane);
    write_member(&mut steps.q, lane, &start.q);
    write_member(&mut steps.p, lane, &start.p);
}

/// Members put into the lanes that have a start.
fn refill<L: ExplicitInLanes<N>, const N: usize, const S: usize, const W: usize>(
    steps: &mut Of<L, N, S, W>,
    systems: [&L; W],
    starts: &[Option<State<L::Scalar, N>>; W],
    h: L::Scalar,
) {
    steps.fields = L::fields(systems);
    for (lane, (system, start)) in systems.into_iter().zip(starts).enumerate() {
        if let Some(start) = start {
            put(steps, lane, system, start, h);
        }
    }
}

/// Factors the matrices of one member; whether they can be.
fn prepare<L: ExplicitInLanes<N>, const N: usize, const S: usize, const W: usize>(
    steps: &mut Of<L, N, S, W>,
    lane: usize,
    system: &L,
) -> bool {
    for substep in &mut steps.substeps {
        let matrix = system.step_matrix(substep.h);
        let Some(factored) = matrix.factored() else { return false };
        substep.matrices.write(lane, &matrix, &factored);
        let at_rest = system.velocity_momenta(&nalgebra::zero(), substep.h).p0;
        write_member(&mut substep.at_rest, lane, &at_rest);
    }
    true
}

/// q and p of the members, and which of them have not failed.
type Standing<T, const N: usize, const W: usize> = (MemberVector<T, N, W>, MemberVector<T, N, W>, Mask<W>);

/// The first step of each member that is new, its own; `start` is where they stood before the others went on.
#[cold]
#[inline(never)]
fn first_steps<L: ExplicitInLanes<N>, const N: usize, const S: usize, const W: usize>(
    steps: &mut Of<L, N, S, W>,
    systems: [&L; W],
    (q, p, is_sound): &Standing<L::Scalar, N, W>,
) {
    for (lane, system) in systems.into_iter().enumerate() {
        if !steps.is_new.0[lane] {
            continue;
        }
        let mut state = State { q: member(q, lane), p: member(p, lane) };
        steps.is_sound.0[lane] = is_sound.0[lane];
        let mut elapsed = 0.0;
        for substep in &steps.substeps {
            if !steps.is_sound.0[lane] {
                break;
            }
            let step = system.later(L::Scalar::constant(elapsed), |system| {
                Flow::<Trapezoidal, N>::step(system, &state, substep.h, None)
            });
            match step {
                Ok(step) => state = step.state,
                Err(_) => steps.is_sound.0[lane] = false,
            }
            elapsed += substep.h.widen();
        }
        write_member(&mut steps.q, lane, &state.q);
        write_member(&mut steps.p, lane, &state.p);
        if !L::IS_TIMED {
            write_member(&mut steps.force, lane, &system.configuration_force(&state.q));
        }
        steps.clocks.restart(lane);
        steps.clocks.follow_one(lane);
        steps.is_new.0[lane] = false;
    }
}

#[cfg_attr(not(debug_assertions), inline(always))]
fn advance<L: ExplicitInLanes<N>, const N: usize, const S: usize, const W: usize>(
    steps: &mut Of<L, N, S, W>,
    systems: [&L; W],
    mut count: u64,
) {
    if count > 0 && steps.is_new.0.contains(&true) {
        let start = (steps.q, steps.p, steps.is_sound);
        if steps.is_new.0.contains(&false) {
            carry::<L, N, S, W>(steps, 1);
        }
        first_steps::<L, N, S, W>(steps, systems, &start);
        count -= 1;
    }
    carry::<L, N, S, W>(steps, count);
}

/// Steps of all members alike.
#[cfg_attr(not(debug_assertions), inline(always))]
fn carry<L: ExplicitInLanes<N>, const N: usize, const S: usize, const W: usize>(
    steps: &mut Of<L, N, S, W>,
    count: u64,
) {
    // Locals, so that they stay in registers.
    let (fields, substeps) = (&steps.fields, &steps.substeps);
    let (mut q, mut p, mut force) = (steps.q, steps.p, steps.force);
    let mut is_sound = steps.is_sound;
    for _ in 0..count {
        let mut elapsed = Members::<f64, W>::splat(0.0);
        if L::IS_TIMED {
            elapsed = steps.clocks.times(steps.h);
            steps.clocks.follow(Mask::splat(true));
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
            is_sound = is_sound & substep.take::<L, _>(fields, &mut q, &mut p, &mut force);
        }
    }
    (steps.q, steps.p, steps.force, steps.is_sound) = (q, p, force, is_sound);
}

impl<T: Scalar, A, const N: usize, const W: usize> Substep<T, A, N, W> {
    /// Takes the substep, with `fields` at its end. Returns the members for which v solves its equation.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn take<L, F>(
        &self,
        fields: &F,
        q: &mut MemberVector<T, N, W>,
        p: &mut MemberVector<T, N, W>,
        force: &mut MemberVector<T, N, W>,
    ) -> Mask<W>
    where
        L: ExplicitInLanes<N, Scalar = T, Fields<W> = F>,
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

impl<L, const N: usize> FlowInLanes<Trapezoidal, N> for L
where
    L: ExplicitInLanes<N>,
{
    type Lanes<const W: usize> = Of<L, N, 1, W>;

    fn in_lanes<const W: usize>(
        systems: [&Self; W],
        starts: &[State<L::Scalar, N>; W],
        h: L::Scalar,
    ) -> Self::Lanes<W> {
        started(systems, starts, h, &[1.0])
    }

    fn refill_lanes<const W: usize>(
        lanes: &mut Self::Lanes<W>,
        systems: [&Self; W],
        starts: &[Option<State<L::Scalar, N>>; W],
        h: L::Scalar,
    ) {
        refill::<L, N, 1, W>(lanes, systems, starts, h);
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn advance_in_lanes<const W: usize>(lanes: &mut Self::Lanes<W>, systems: [&Self; W], steps: u64) {
        advance::<L, N, 1, W>(lanes, systems, steps);
    }

    #[inline]
    fn state_of_lane<const W: usize>(lanes: &Self::Lanes<W>, lane: usize) -> Option<State<L::Scalar, N>> {
        state_if_sound(&lanes.q, &lanes.p, lanes.is_sound, lane)
    }
}

impl<L, const N: usize, const S: usize> FlowInLanes<Composition<Trapezoidal, S>, N> for L
where
    L: ExplicitInLanes<N>,
{
    type Lanes<const W: usize> = Of<L, N, S, W>;

    fn in_lanes<const W: usize>(
        systems: [&Self; W],
        starts: &[State<L::Scalar, N>; W],
        h: L::Scalar,
    ) -> Self::Lanes<W> {
        started(systems, starts, h, &Composition::<Trapezoidal, S>::SHARES)
    }

    fn refill_lanes<const W: usize>(
        lanes: &mut Self::Lanes<W>,
        systems: [&Self; W],
        starts: &[Option<State<L::Scalar, N>>; W],
        h: L::Scalar,
    ) {
        refill::<L, N, S, W>(lanes, systems, starts, h);
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn advance_in_lanes<const W: usize>(lanes: &mut Self::Lanes<W>, systems: [&Self; W], steps: u64) {
        advance::<L, N, S, W>(lanes, systems, steps);
    }

    #[inline]
    fn state_of_lane<const W: usize>(lanes: &Self::Lanes<W>, lane: usize) -> Option<State<L::Scalar, N>> {
        state_if_sound(&lanes.q, &lanes.p, lanes.is_sound, lane)
    }
}
