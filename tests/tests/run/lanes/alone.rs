//! Members in lanes beside each alone.

use dalembert::nalgebra::SVector;
use dalembert::run::LaneRuns;
use dalembert::step::FlowInLanes;
use dalembert::{Discretise, State, StepError};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// The bits of a state: −0 is not 0.
pub fn bits<const N: usize>(state: &State<f64, N>) -> Vec<u64> {
    state.q.iter().chain(&state.p).map(|entry| entry.to_bits()).collect()
}

/// The state after so many steps, alone.
pub fn alone<L, M, const N: usize>(
    method: M,
    system: &L,
    start: State<f64, N>,
    h: f64,
    steps: u64,
) -> Result<State<f64, N>, StepError>
where
    L: FlowInLanes<M, N, Scalar = f64>,
{
    let mut run = system.by(method, h).run(start);
    for _ in 0..steps {
        if let Some(Err(error)) = run.next() {
            return Err(error);
        }
    }
    Ok(*run.state())
}

/// Runs on by so many steps: one copy of what is inlined wherever it is called, and long to compile.
#[inline(never)]
pub fn forward<L, M, const N: usize, const W: usize>(runs: &mut LaneRuns<'_, L, M, N, W>, steps: u64)
where
    L: FlowInLanes<M, N>,
{
    runs.advance(steps);
}

/// Steps of [`agree`] after the third.
const MORE: u64 = if cfg!(debug_assertions) { 6 } else { 18 };

/// Members in W lanes beside each alone, after 1, 3 and more steps; how many members had an end.
pub fn agree<L, M, const N: usize, const W: usize>(method: M, members: &[(L, State<f64, N>)], h: f64) -> usize
where
    L: FlowInLanes<M, N, Scalar = f64>,
    M: Copy,
{
    let mut ends = 0;
    for chunk in members.chunks(W) {
        // The last chunk is filled with its first member.
        let member = |lane: usize| chunk.get(lane).unwrap_or(&chunk[0]);
        let systems: [&L; W] = std::array::from_fn(|lane| &member(lane).0);
        let starts: [State<f64, N>; W] = std::array::from_fn(|lane| member(lane).1);
        let mut runs = LaneRuns::new(method, systems, &starts, h);
        let mut at_once = runs;
        forward(&mut at_once, 3 + MORE);
        let mut steps = 0;
        for more in [0, 1, 2, MORE] {
            forward(&mut runs, more);
            steps += more;
            for lane in 0..W {
                match (runs.state(lane), alone(method, systems[lane], starts[lane], h, steps)) {
                    (Some(in_lanes), Ok(alone)) => {
                        assert_eq!(bits(&in_lanes), bits(&alone), "lane {lane}, h = {h}");
                    }
                    // At its start no run has failed yet; it does in its first step.
                    (None, Ok(_)) => {
                        let next = alone(method, systems[lane], starts[lane], h, 1);
                        assert!(steps == 0 && next.is_err(), "lane {lane} has no state, its run has");
                    }
                    (None, Err(_)) => {}
                    (Some(_), Err(error)) => panic!("lane {lane} has a state; its run: {error}"),
                }
            }
        }
        for lane in 0..W {
            assert_eq!(runs.state(lane).map(|of| bits(&of)), at_once.state(lane).map(|of| bits(&of)));
            ends += usize::from(lane < chunk.len() && runs.state(lane).is_some());
        }
        assert_eq!(runs.state(W), None);
    }
    ends
}

/// In every number of lanes.
pub fn agree_in_all<L, M, const N: usize>(method: M, members: &[(L, State<f64, N>)], h: f64) -> usize
where
    L: FlowInLanes<M, N, Scalar = f64>,
    M: Copy,
{
    let ends = [
        agree::<L, M, N, 1>(method, members, h),
        agree::<L, M, N, 2>(method, members, h),
        agree::<L, M, N, 8>(method, members, h),
        agree::<L, M, N, 32>(method, members, h),
    ];
    assert_eq!(ends, [agree_in_two(method, members, h); 4]);
    ends[0]
}

/// In an odd number of lanes and in an even one: each is another copy of the step to compile.
pub fn agree_in_two<L, M, const N: usize>(method: M, members: &[(L, State<f64, N>)], h: f64) -> usize
where
    L: FlowInLanes<M, N, Scalar = f64>,
    M: Copy,
{
    let ends = [agree::<L, M, N, 3>(method, members, h), agree::<L, M, N, 16>(method, members, h)];
    assert_eq!(ends[0], ends[1]);
    ends[0]
}

pub fn start<const N: usize>(random: &mut StdRng) -> State<f64, N> {
    let mut entry = |_, _| random.random_range(-1.2..1.2);
    State { q: SVector::from_fn(&mut entry), p: SVector::from_fn(&mut entry) }
}

/// So many members, of fields and states at random.
pub fn members<L, const N: usize>(
    count: usize,
    seed: u64,
    system: impl Fn(&mut StdRng) -> L,
) -> Vec<(L, State<f64, N>)> {
    let mut random = StdRng::seed_from_u64(seed);
    (0..count).map(|_| (system(&mut random), start(&mut random))).collect()
}

/// 0 for a third of the members, −0 for some.
pub fn damping(random: &mut StdRng) -> f64 {
    match random.random_range(0..9) {
        0..2 => 0.0,
        2 => -0.0,
        _ => random.random_range(1e-3..0.8),
    }
}

/// Members put into lanes at random moments, each until a step of its own; how many had an end.
pub fn refilled<L, M, const N: usize, const W: usize>(
    method: M,
    members: &[(L, State<f64, N>)],
    h: f64,
    seed: u64,
) -> usize
where
    L: FlowInLanes<M, N, Scalar = f64>,
    M: Copy,
{
    let mut random = StdRng::seed_from_u64(seed);
    let mut waiting = members.iter().skip(W);
    let mut lanes: [_; W] = std::array::from_fn(|lane| (&members[lane], 0, random.random_range(0..12)));
    let (systems, starts) = (lanes.map(|(member, ..)| &member.0), lanes.map(|(member, ..)| member.1));
    let mut runs = LaneRuns::new(method, systems, &starts, h);
    let (mut ends, mut seen) = (0, 0);
    while seen < members.len() {
        let (mut arriving, mut from) = ([None; W], starts);
        for (lane, (of, steps, end)) in lanes.iter_mut().enumerate() {
            if steps < end {
                continue;
            }
            let (system, start) = *of;
            match alone(method, system, *start, h, *steps) {
                Ok(alone) if runs.state(lane).is_some() => {
                    assert_eq!(
                        runs.state(lane).map(|of| bits(&of)),
                        Some(bits(&alone)),
                        "lane {lane}, {steps}"
                    );
                    ends += 1;
                }
                // At its start no run has failed yet.
                Ok(_) => assert!(*steps == 0 && alone(method, system, *start, h, 1).is_err(), "lane {lane}"),
                Err(error) => assert_eq!(runs.state(lane), None, "lane {lane}: {error}"),
            }
            seen += 1;
            // A lane without another member runs on.
            (*steps, *end) = (0, u64::MAX);
            if let Some(next) = waiting.next() {
                (*of, *end) = (next, random.random_range(0..12));
                (arriving[lane], from[lane]) = (Some(&next.0), next.1);
            }
        }
        runs.refill(arriving, &from);
        let part =
            random.random_range(1..4).min(lanes.iter().map(|(_, steps, end)| end - steps).min().unwrap());
        forward(&mut runs, part);
        lanes.iter_mut().for_each(|(_, steps, _)| *steps += part);
    }
    ends
}
