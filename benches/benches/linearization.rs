//! The derivatives A and B of a step, and its second derivatives, against the step itself: times of
//! interleaved runs and counted instructions, as the tables of `docs/performance.md`.
//!
//! `cargo bench -p dalembert-benches --bench linearization`
//!
//! Instructions are counted where valgrind is installed.

use std::env;
use std::hint::black_box;

use dalembert::nalgebra::{SVector, vector};
use dalembert::step::{DiscreteDriven, DiscreteSecondOrder};
use dalembert::system::{Driven, ForcedLagrangian};
use dalembert::{Discretise, Discretised, Gauss, Midpoint, State, rayleigh_system};
use dalembert_benches::instructions::{self, Part};
use dalembert_benches::interleaved::medians;

/// A pendulum with a motor in its joint.
struct Joint {
    c: f64,
}

#[rayleigh_system(rule = [midpoint, gauss], step_derivatives = second)]
impl Joint {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] + q[0].cos()
    }

    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.5 * self.c * v[0] * v[0]
    }

    fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
        u
    }
}

/// A cart with a pole, pushed.
struct CartPole {
    c: [f64; 2],
}

#[rayleigh_system(rule = [midpoint, gauss], step_derivatives = second)]
impl CartPole {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.65 * v[0] * v[0] + 0.15 * q[1].cos() * v[0] * v[1] + 0.0375 * v[1] * v[1] + 1.4715 * q[1].cos()
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * (self.c[0] * v[0] * v[0] + self.c[1] * v[1] * v[1])
    }

    fn force(&self, _q: [f64; 2], _v: [f64; 2], u: [f64; 1]) -> [f64; 2] {
        [u[0], 0.0]
    }
}

/// Four links of unit mass and length in a plane, angles absolute, with a motor in each joint.
struct Arm {
    c: f64,
}

#[rayleigh_system(rule = [midpoint, gauss], step_derivatives = second)]
impl Arm {
    fn lagrangian(&self, q: [f64; 4], v: [f64; 4]) -> f64 {
        let (mut x, mut y) = (0.0, 0.0);
        let mut energy = 0.0;
        let mut height = 0.0;
        for i in 0..4 {
            x += v[i] * q[i].cos();
            y += v[i] * q[i].sin();
            height -= q[i].cos();
            energy += 0.5 * (x * x + y * y) - 9.81 * height;
        }
        energy
    }

    fn rayleigh(&self, v: [f64; 4]) -> f64 {
        let mut sum = v[0] * v[0];
        for i in 1..4 {
            sum += (v[i] - v[i - 1]) * (v[i] - v[i - 1]);
        }
        0.5 * self.c * sum
    }

    fn force(&self, _q: [f64; 4], _v: [f64; 4], u: [f64; 4]) -> [f64; 4] {
        [u[0] - u[1], u[1] - u[2], u[2] - u[3], u[3]]
    }
}

/// What is measured, in this order.
const WAYS: [&str; 6] = [
    "cold step",
    "step with a guess",
    "step of a run",
    "step with A, B",
    "A, B of the ends",
    "second derivatives of the ends",
];

/// Is shown a scene, a rule and the [`WAYS`], each to be run so many times.
type Visit<'a> = &'a mut dyn FnMut(&str, &str, [&dyn Fn(usize); WAYS.len()]);

fn main() {
    let arguments: Vec<String> = env::args().collect();
    if let Some(at) = arguments.iter().position(|argument| argument == instructions::COUNTED) {
        return counted(&arguments[at + 1..]);
    }
    head("ns");
    scenes(&mut |scene, rule, ways| {
        let seconds = medians(&ways);
        row(scene, rule, std::array::from_fn(|way| seconds[way] * 1e9));
    });
    println!();
    head("instructions");
    scenes(&mut |scene, rule, _| {
        let key = format!("{scene}/{rule}");
        let counts = WAYS.map(|way| instructions::each(&key, way, Part::Step, 200));
        if counts.iter().all(Option::is_some) {
            row(scene, rule, counts.map(Option::unwrap_or_default));
        }
    });
}

/// The run that valgrind watches.
fn counted(arguments: &[String]) {
    let [key, way, _, times] = arguments else { panic!("a scene, a way, a part and a number of times") };
    let times = times.parse().expect("a number of times");
    scenes(&mut |scene, rule, ways| {
        if format!("{scene}/{rule}") == *key {
            let way = WAYS.iter().position(|name| name == way).expect("a way");
            ways[way](times);
        }
    });
}

fn head(unit: &str) {
    println!(
        "| scene | rule | cold step, {unit} | with a guess, {unit} | of a run, {unit} | step with A, B / of a run | A, B of the ends / of a run \
         | A, B of the ends / cold | second derivatives / of a run |"
    );
    println!("|---|---|--:|--:|--:|--:|--:|--:|--:|");
}

fn row(scene: &str, rule: &str, [cold, guessed, of_run, with_step, ends, second]: [f64; WAYS.len()]) {
    println!(
        "| {scene} | {rule} | {cold:.0} | {guessed:.0} | {of_run:.0} | {:.2} | {:.2} | {:.2} | {:.2} |",
        with_step / of_run,
        ends / of_run,
        ends / cold,
        second / of_run
    );
}

fn scenes(visit: Visit<'_>) {
    let joint = Joint { c: 0.1 };
    all("pendulum, n = 1", &joint.driven([0.3]), vector![0.8], vector![0.4], 0.02, visit);
    let cart = CartPole { c: [0.1, 0.01] };
    all("cart and pole, n = 2", &cart.driven([0.3]), vector![0.1, 2.8], vector![0.3, -0.4], 0.02, visit);
    let arm = Arm { c: 0.1 };
    let (q, v) = (vector![0.3, 0.5, -0.2, 1.0], vector![0.3, -0.4, 0.7, 0.2]);
    all("four links, n = 4", &arm.driven([1.0, 0.5, 0.2, -0.1]), q, v, 0.01, visit);
}

/// By the midpoint rule, and with two and three stages.
fn all<L, const N: usize, const M: usize>(
    scene: &str,
    system: &L,
    q: SVector<f64, N>,
    v: SVector<f64, N>,
    h: f64,
    visit: Visit<'_>,
) where
    L: DiscreteDriven<Midpoint, N, M, Scalar = f64>
        + DiscreteSecondOrder<Midpoint, N, M>
        + ForcedLagrangian<N>
        + Driven<N, M>,
{
    measure([scene, "midpoint"], Midpoint, system, (q, v), h, visit);
    measure([scene, "Gauss, S = 2"], Gauss::<2>, system, (q, v), h, visit);
    measure([scene, "Gauss, S = 3"], Gauss::<3>, system, (q, v), h, visit);
}

fn measure<R: Copy, L, const N: usize, const M: usize>(
    [scene, name]: [&str; 2],
    rule: R,
    system: &L,
    (q, v): (SVector<f64, N>, SVector<f64, N>),
    h: f64,
    visit: Visit<'_>,
) where
    L: DiscreteDriven<R, N, M, Scalar = f64> + DiscreteSecondOrder<R, N, M>,
{
    let state = State::from_velocity(system, q, v).expect("the scene is regular");
    let by = system.by(rule, h);
    let first = by.step(&state).expect("the scene can be stepped");
    // In a loop of control the last velocity is the guess.
    let near = by.near(&first.velocity);
    let next = near.step(&first.state).expect("the scene can be stepped");
    let covector = State { q: v, p: q };
    let step = |by: &Discretised<L, R, N>, times| {
        for _ in 0..times {
            let _ = black_box(by.step(black_box(&first.state)));
        }
    };
    visit(
        scene,
        name,
        [
            &|times| step(&by, times),
            &|times| step(&near, times),
            &|times| {
                // Not so far that the motion becomes another.
                let mut left = times;
                while left > 0 {
                    let some = left.min(100);
                    let run = by.run(first.state);
                    for step in run.take(some) {
                        let _ = black_box(step);
                    }
                    left -= some;
                }
            },
            &|times| {
                for _ in 0..times {
                    let state = black_box(&first.state);
                    let _ = black_box(near.linearized_step_with_input(state));
                }
            },
            &|times| {
                for _ in 0..times {
                    let (q0, q1) = (black_box(&first.state.q), black_box(&next.state.q));
                    let _ = black_box(by.linearization_with_input(q0, q1));
                }
            },
            &|times| {
                for _ in 0..times {
                    let (q0, q1) = (black_box(&first.state.q), black_box(&next.state.q));
                    let _ = black_box(by.step_hessian(q0, q1, &covector));
                }
            },
        ],
    );
}
