//! Runs one scene for a number of steps, for a profiler that counts instructions:
//!
//! ```sh
//! cargo build --release -p dalembert-benches --example instructions
//! for steps in 10000 20000; do
//!     valgrind --tool=callgrind --callgrind-out-file=/dev/null target/release/examples/instructions fput8 $steps
//! done
//! ```
//!
//! The difference of the two counts, divided by 10 000, is that of one step.

use std::hint::black_box;

use dalembert::nalgebra::SVector;
use dalembert::{
    Banded, Discrete, Factored, Midpoint, NewtonMatrix, State, Trajectory, Trapezoidal, rayleigh_system,
};

#[rayleigh_system(rule = [midpoint, trapezoidal])]
fn oscillator(q: [f64; 1], v: [f64; 1], m: f64, k: f64, r: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
}

/// Ring potential V = s(s − 1)², s = |q|², with isotropic drag.
#[rayleigh_system(rule = [midpoint, trapezoidal])]
fn ring(q: [f64; 2], v: [f64; 2], k: f64) -> (f64, f64) {
    let s = q[0] * q[0] + q[1] * q[1];
    (0.5 * (v[0] * v[0] + v[1] * v[1]) - s * (s - 1.0).powi(2), 0.5 * k * (v[0] * v[0] + v[1] * v[1]))
}

/// FPUT β-chain of N masses between walls, with drag.
macro_rules! chain {
    ($name:ident, $n:literal) => {
        struct $name {
            beta: f64,
            drag: f64,
        }

        #[rayleigh_system(rule = [midpoint, trapezoidal])]
        impl $name {
            fn lagrangian(&self, q: [f64; $n], v: [f64; $n]) -> f64 {
                let mut energy = 0.0;
                for v in &v {
                    energy += 0.5 * v * v;
                }
                energy -= Self::spring(self.beta, q[0]) + Self::spring(self.beta, q[$n - 1]);
                for i in 1..$n {
                    energy -= Self::spring(self.beta, q[i] - q[i - 1]);
                }
                energy
            }

            fn rayleigh(&self, v: [f64; $n]) -> f64 {
                0.5 * self.drag * v.iter().map(|v| v * v).sum::<f64>()
            }

            fn spring(beta: f64, d: f64) -> f64 {
                let square = d * d;
                0.5 * square + 0.25 * beta * square * square
            }
        }
    };
}

chain!(Fput3, 3);
chain!(Fput4, 4);
chain!(Fput8, 8);
chain!(Fput32, 32);

fn run<L, R, const N: usize>(system: &L, rule: R, h: f64, q: [f64; N], v: [f64; N], steps: usize)
where
    L: Discrete<R, N, Scalar = f64>,
{
    let start = State::from_velocity(system, q, v).expect("the scene is regular");
    let mut trajectory = Trajectory::new(system, rule, h, black_box(start));
    let mut iterations = 0;
    for step in (&mut trajectory).take(steps) {
        iterations += step.expect("the scene can be stepped").report.iterations;
    }
    println!(
        "{:.3} iterations a step, q = {:?}",
        f64::from(iterations) / steps as f64,
        black_box(trajectory.state().q[0])
    );
}

/// Factors and solves the same system of N unknowns, in the form M.
fn solves<M: NewtonMatrix<f64, N>, const N: usize>(matrix: M, times: usize) {
    let mut x = SVector::<f64, N>::from_element(1.0);
    for _ in 0..times {
        x = black_box(black_box(matrix).factored().expect("the diagonal dominates").solve(&x));
    }
    println!("0 iterations a step, x = {:?}", x[0]);
}

/// A band of W diagonals in N rows.
fn band<const N: usize, const W: usize>() -> Banded<f64, N, W> {
    let entry = |i: usize, k: usize| {
        let inside = (i + k).checked_sub(W / 2).is_some_and(|column| column < N);
        if k == W / 2 {
            2.0 * W as f64
        } else if inside {
            ((3 * i + 7 * k) as f64).sin()
        } else {
            0.0
        }
    };
    Banded { rows: std::array::from_fn(|i| std::array::from_fn(|k| entry(i, k))) }
}

fn wave<const N: usize>() -> [f64; N] {
    std::array::from_fn(|i| (i as f64 * 0.7).sin())
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    let scene = arguments.next().unwrap_or_default();
    let steps = arguments.next().and_then(|steps| steps.parse().ok()).unwrap_or(10_000);
    let oscillator = Oscillator { m: 1.0, k: 1.0, r: 0.01 };
    let ring = Ring { k: 1e-3 };
    let (start, velocity) = ([0.0, 1.15549918674982], [0.5, 0.0]);
    let (beta, drag) = (0.7, 1e-3);
    match scene.as_str() {
        "oscillator" => run(&oscillator, Midpoint, 0.1, [1.0], [0.0], steps),
        "oscillator-trapezoidal" => run(&oscillator, Trapezoidal, 0.1, [1.0], [0.0], steps),
        "ring" => run(&ring, Midpoint, 0.2, start, velocity, steps),
        "ring-trapezoidal" => run(&ring, Trapezoidal, 0.2, start, velocity, steps),
        "fput3" => run(&Fput3 { beta, drag }, Midpoint, 0.05, wave(), [0.0; 3], steps),
        "fput4" => run(&Fput4 { beta, drag }, Midpoint, 0.05, wave(), [0.0; 4], steps),
        "fput8" => run(&Fput8 { beta, drag }, Midpoint, 0.05, wave(), [0.0; 8], steps),
        "fput8-coarse" => run(&Fput8 { beta, drag }, Midpoint, 0.3, wave(), [0.0; 8], steps),
        "fput32" => run(&Fput32 { beta, drag }, Midpoint, 0.05, wave(), [0.0; 32], steps),
        "fput8-trapezoidal" => run(&Fput8 { beta, drag }, Trapezoidal, 0.05, wave(), [0.0; 8], steps),
        "fput32-trapezoidal" => run(&Fput32 { beta, drag }, Trapezoidal, 0.05, wave(), [0.0; 32], steps),
        "dense4" => solves(band::<4, 3>().dense(), steps),
        "band4-3" => solves(band::<4, 3>(), steps),
        "dense6" => solves(band::<6, 3>().dense(), steps),
        "band6-3" => solves(band::<6, 3>(), steps),
        "band6-5" => solves(band::<6, 5>(), steps),
        "dense8" => solves(band::<8, 3>().dense(), steps),
        "band8-3" => solves(band::<8, 3>(), steps),
        "band8-5" => solves(band::<8, 5>(), steps),
        "band8-7" => solves(band::<8, 7>(), steps),
        other => println!("no scene `{other}`"),
    }
}
