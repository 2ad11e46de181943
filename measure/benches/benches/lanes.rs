//! Many runs at once against one after the other, bit by bit the same: microseconds a trajectory, by the
//! number of lanes, in the instruction set that everything is compiled for and in the widest that the machine
//! has, chosen when it runs.
//!
//! `cargo bench -p dalembert-benches --bench lanes`

#![allow(clippy::needless_range_loop, reason = "one index runs through several arrays together")]

use std::hint::black_box;

use dalembert::nalgebra::{SVector, vector};
use dalembert::run::LaneRuns;
use dalembert::step::FlowInLanes;
use dalembert::{Composition, Discretise, Gauss, Midpoint, Splitting, State, Trapezoidal, rayleigh_system};
use dalembert_benches::interleaved::medians_over;
use multiversion::multiversion;

/// A particle in V = s(s − 1)², s = |q|², with drag.
struct Ring {
    k: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss], lanes = [explicit, midpoint, gauss])]
impl Ring {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let s = q[0] * q[0] + q[1] * q[1];
        0.5 * (v[0] * v[0] + v[1] * v[1]) - s * (s - 1.0).powi(2)
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.k * (v[0] * v[0] + v[1] * v[1])
    }
}

/// A pendulum, for a sine.
struct Pendulum {
    k: f64,
}

#[rayleigh_system(rule = trapezoidal, lanes = explicit)]
impl Pendulum {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] + q[0].cos()
    }

    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.5 * self.k * v[0] * v[0]
    }
}

/// Two pendulums, one at the end of the other, with friction in their joints.
struct DoublePendulum {
    m: [f64; 2],
    l: [f64; 2],
    g: f64,
    c: [f64; 2],
}

#[rayleigh_system(rule = [midpoint, gauss], lanes = [midpoint, gauss])]
impl DoublePendulum {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let total = self.m[0] + self.m[1];
        let turning =
            0.5 * total * self.l[0].powi(2) * v[0] * v[0] + 0.5 * self.m[1] * self.l[1].powi(2) * v[1] * v[1];
        let coupling = self.m[1] * self.l[0] * self.l[1] * (q[0] - q[1]).cos() * v[0] * v[1];
        let fall = total * self.l[0] * q[0].cos() + self.m[1] * self.l[1] * q[1].cos();
        turning + coupling + self.g * fall
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.c[0] * v[0] * v[0] + 0.5 * self.c[1] * (v[1] - v[0]) * (v[1] - v[0])
    }
}

/// Quartic springs between walls.
struct Chain {
    k: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal], lanes = [explicit, midpoint])]
impl Chain {
    fn lagrangian(&self, q: [f64; 8], v: [f64; 8]) -> f64 {
        let (mut l, mut before) = (0.0, 0.0);
        for i in 0..8 {
            let d = q[i] - before;
            l += 0.5 * v[i] * v[i] - 0.5 * d * d - 0.25 * d.powi(4);
            before = q[i];
        }
        l - 0.5 * before * before - 0.25 * before.powi(4)
    }

    fn rayleigh(&self, v: [f64; 8]) -> f64 {
        let mut sum = 0.0;
        for i in 0..8 {
            sum += v[i] * v[i];
        }
        0.5 * self.k * sum
    }
}

/// Compiled for several instruction sets.
#[multiversion(targets(
    "x86_64+avx512f+avx512dq+avx512vl+avx512bw+avx2+fma",
    "x86_64+avx2+fma",
    "aarch64+neon"
))]
fn advance_versioned<L, M, const N: usize, const W: usize>(runs: &mut LaneRuns<'_, L, M, N, W>, steps: u64)
where
    L: FlowInLanes<M, N>,
{
    runs.advance(steps);
}

#[inline(never)]
fn advance_as_compiled<L, M, const N: usize, const W: usize>(runs: &mut LaneRuns<'_, L, M, N, W>, steps: u64)
where
    L: FlowInLanes<M, N>,
{
    runs.advance(steps);
}

/// Gathers W members, runs them to the end and looks at the ends.
fn in_lanes<L, M, const N: usize, const W: usize>(
    advance: fn(&mut LaneRuns<'_, L, M, N, W>, u64),
    method: M,
    system: &L,
    start: State<f64, N>,
    [h, steps]: [f64; 2],
) -> [Option<State<f64, N>>; W]
where
    L: FlowInLanes<M, N, Scalar = f64>,
{
    let (systems, starts) = (black_box([system; W]), black_box([start; W]));
    let mut runs = LaneRuns::new(method, systems, &starts, h);
    advance(&mut runs, steps as u64);
    std::array::from_fn(|lane| runs.state(lane))
}

fn row<L, M, const N: usize>(name: &str, method: M, system: &L, start: State<f64, N>, [time, steps]: [f64; 2])
where
    L: FlowInLanes<M, N, Scalar = f64>,
    M: Copy,
{
    let of = [time / steps, steps];
    let alone = || {
        let (system, start) = (black_box(system), black_box(start));
        let mut run = system.by(method, of[0]).run(start);
        run.by_ref().take(steps as usize).for_each(|step| assert!(step.is_ok()));
        *run.state()
    };
    let end = alone();
    let bits = |state: State<f64, N>| state.q.iter().chain(&state.p).map(|x| x.to_bits()).collect::<Vec<_>>();
    macro_rules! candidates {
        ($($advance:ident $width:literal),*) => {{
            $(
                for state in in_lanes::<L, M, N, $width>($advance, method, system, start, of) {
                    assert_eq!(state.map(bits), Some(bits(end)), "{name}, {} lanes", $width);
                }
            )*
            let mut candidates: Vec<(f64, Box<dyn Fn(usize)>)> =
                vec![(1.0, Box::new(|runs| (0..runs).for_each(|_| { black_box(alone()); })))];
            $(candidates.push((f64::from($width), Box::new(|runs| {
                for _ in 0..runs {
                    black_box(in_lanes::<L, M, N, $width>($advance, method, system, start, of));
                }
            })));)*
            candidates
        }};
    }
    let candidates = candidates! {
        advance_as_compiled 8, advance_as_compiled 16,
        advance_versioned 8, advance_versioned 16, advance_versioned 32
    };
    let functions: Vec<&dyn Fn(usize)> = candidates.iter().map(|(_, function)| &**function).collect();
    let times = medians_over(&functions, &vec![1; functions.len()]);
    let times: Vec<f64> =
        times.iter().zip(&candidates).map(|(time, (lanes, _))| time / lanes * 1e6).collect();
    let best = times.iter().copied().fold(f64::INFINITY, f64::min);
    let cells: Vec<String> = times.iter().map(|time| format!("{time:.1}")).collect();
    println!("| {name} | {N} | {} | {:.3} |", cells.join(" | "), best / times[0]);
}

fn main() {
    println!("Microseconds a trajectory.\n");
    println!("| scene | n | alone | 8 | 16 | 8, versioned | 16 | 32 | best / alone |");
    println!("|---|--:|--:|--:|--:|--:|--:|--:|--:|");
    let ring = State { q: vector![0.1, 1.1], p: vector![0.5, 0.0] };
    let of = [100.0, 1132.0];
    row("ring, Blanes–Moan 6", Splitting::blanes_moan_6(), &Ring { k: 1e-3 }, ring, of);
    row("ring without drag, Blanes–Moan 6", Splitting::blanes_moan_6(), &Ring { k: 0.0 }, ring, of);
    row("ring, Störmer–Verlet", Trapezoidal, &Ring { k: 1e-3 }, ring, [100.0, 10_000.0]);
    row("ring, Kahan–Li 8", Composition::kahan_li_8(Trapezoidal), &Ring { k: 1e-3 }, ring, of);
    let pendulum = State { q: vector![1.0], p: vector![0.0] };
    row(
        "pendulum, Blanes–Moan 6",
        Splitting::blanes_moan_6(),
        &Pendulum { k: 1e-3 },
        pendulum,
        [100.0, 300.0],
    );
    let p = SVector::from_fn(|i, _| if i == 0 { 1.0 } else { 0.0 });
    let chain = State { q: SVector::zeros(), p };
    row("chain, Blanes–Moan 6", Splitting::blanes_moan_6(), &Chain { k: 1e-3 }, chain, [100.0, 400.0]);
    row("chain, Störmer–Verlet", Trapezoidal, &Chain { k: 1e-3 }, chain, [100.0, 4000.0]);
    row("ring, Gauss 8", Gauss::<8>, &Ring { k: 1e-3 }, ring, [100.0, 220.0]);
    let pendulums = DoublePendulum { m: [1.0, 0.7], l: [1.0, 0.8], g: 9.81, c: [0.05, 0.03] };
    let start = State { q: vector![1.2, 0.5], p: vector![0.0, 0.0] };
    row("ring, midpoint", Midpoint, &Ring { k: 1e-3 }, ring, [100.0, 2000.0]);
    row("double pendulum, midpoint", Midpoint, &pendulums, start, [20.0, 2000.0]);
    row("chain, midpoint", Midpoint, &Chain { k: 1e-3 }, chain, [100.0, 2000.0]);
    row("double pendulum, Gauss 4", Gauss::<4>, &pendulums, start, [20.0, 200.0]);
    row("double pendulum, Gauss 6", Gauss::<6>, &pendulums, start, [20.0, 120.0]);
    row("double pendulum, Gauss 8", Gauss::<8>, &pendulums, start, [20.0, 110.0]);
}
