//! The derivatives of a step by state, input and parameters, and its second derivatives, against the step
//! itself: times of interleaved runs and counted instructions, as the tables of `docs/performance.md`.
//!
//! `cargo bench -p dalembert-benches --bench linearization`
//!
//! Instructions are counted where valgrind is installed.

use std::env;
use std::hint::black_box;

use dalembert::nalgebra::{SVector, vector};
use dalembert::run::DrivenTrajectory;
use dalembert::step::{DiscreteDriven, DiscreteParameters, DiscreteSecondOrder, Flow, Linearizable};
use dalembert::system::{Driven, ForcedLagrangian, Parameters};
use dalembert::{Discretise, Gauss, Midpoint, State, rayleigh_system};
use dalembert_benches::instructions::{self, Part};
use dalembert_benches::interleaved::medians;

/// A pendulum with a motor in its joint.
struct Joint {
    c: f64,
}

#[rayleigh_system(rule = [midpoint, gauss], parameters = [c], step_derivatives = second)]
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

#[rayleigh_system(rule = [midpoint, gauss], parameters = [c[0], c[1]], step_derivatives = second)]
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

/// Links of unit mass and length in a plane, angles absolute, with a motor in each joint.
macro_rules! links {
    ($name:ident, $n:literal) => {
        struct $name {
            c: f64,
            g: f64,
        }

        #[rayleigh_system(rule = [midpoint, gauss], parameters = [c, g], step_derivatives = second)]
        impl $name {
            fn lagrangian(&self, q: [f64; $n], v: [f64; $n]) -> f64 {
                let (mut x, mut y) = (0.0, 0.0);
                let mut energy = 0.0;
                let mut height = 0.0;
                for i in 0..$n {
                    x += v[i] * q[i].cos();
                    y += v[i] * q[i].sin();
                    height -= q[i].cos();
                    energy += 0.5 * (x * x + y * y) - self.g * height;
                }
                energy
            }

            fn rayleigh(&self, v: [f64; $n]) -> f64 {
                let mut sum = v[0] * v[0];
                for i in 1..$n {
                    sum += (v[i] - v[i - 1]) * (v[i] - v[i - 1]);
                }
                0.5 * self.c * sum
            }

            fn force(&self, _q: [f64; $n], _v: [f64; $n], u: [f64; $n]) -> [f64; $n] {
                let mut torque = u;
                for i in 1..$n {
                    torque[i - 1] -= u[i];
                }
                torque
            }
        }
    };
}

links!(FourLinks, 4);
links!(SevenLinks, 7);

/// What is measured, in this order.
const WAYS: [&str; 8] = [
    "cold step",
    "step of a run",
    "step with its input",
    "with A",
    "with A, B",
    "with A, B, parameters",
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
        "| scene | rule | cold step, {unit} | of a run, {unit} | with its input, {unit} | with A / with its input | with A, B | with A, B, parameters \
         | A, B of the ends | second derivatives of the ends |"
    );
    println!("|---|---|--:|--:|--:|--:|--:|--:|--:|--:|");
}

fn row(scene: &str, rule: &str, [cold, of_run, with_input, rest @ ..]: [f64; WAYS.len()]) {
    let [a, b, all, ends, second] = rest.map(|way| way / with_input);
    println!(
        "| {scene} | {rule} | {cold:.0} | {of_run:.0} | {with_input:.0} | {a:.2} | {b:.2} | {all:.2} | {ends:.2} | {second:.2} |"
    );
}

/// Inputs of a control loop, one after the other: each a tenth up and down in eight steps.
fn inputs<const M: usize>(u: [f64; M]) -> [[f64; M]; 8] {
    std::array::from_fn(|k| u.map(|u| u * (1.0 + 0.1 * (k as f64 * std::f64::consts::FRAC_PI_4).sin())))
}

fn scenes(visit: Visit<'_>) {
    let joint = Joint { c: 0.1 };
    let views = inputs([0.3]).map(|u| joint.driven(u));
    all::<_, 1, 1, 1>("pendulum, n = 1", &views, vector![0.8], vector![0.4], 0.02, visit);
    let cart = CartPole { c: [0.1, 0.01] };
    let views = inputs([0.3]).map(|u| cart.driven(u));
    all::<_, 2, 1, 2>("cart and pole, n = 2", &views, vector![0.1, 2.8], vector![0.3, -0.4], 0.02, visit);
    let arm = FourLinks { c: 0.1, g: 9.81 };
    let views = inputs([1.0, 0.5, 0.2, -0.1]).map(|u| arm.driven(u));
    let (q, v) = (vector![0.3, 0.5, -0.2, 1.0], vector![0.3, -0.4, 0.7, 0.2]);
    all::<_, 4, 4, 2>("four links, n = 4", &views, q, v, 0.01, visit);
    let arm = SevenLinks { c: 0.1, g: 9.81 };
    let views = inputs([1.0, 0.5, 0.2, -0.1, 0.3, 0.1, -0.2]).map(|u| arm.driven(u));
    let q = SVector::from([0.3, 0.5, -0.2, 1.0, 0.4, -0.1, 0.2]);
    let v = SVector::from([0.3, -0.4, 0.7, 0.2, -0.3, 0.1, 0.5]);
    let view = &views;
    measure::<_, _, 7, 7, 2>(["seven links, n = 7", "midpoint"], Midpoint, view, (q, v), 0.01, visit);
}

/// By the midpoint rule, and with two and three stages.
fn all<L, const N: usize, const M: usize, const P: usize>(
    scene: &str,
    views: &[L; 8],
    q: SVector<f64, N>,
    v: SVector<f64, N>,
    h: f64,
    visit: Visit<'_>,
) where
    L: DiscreteDriven<Midpoint, N, M, Scalar = f64>
        + DiscreteParameters<Midpoint, N, P>
        + DiscreteSecondOrder<Midpoint, N, M>
        + Linearizable<Midpoint, N>
        + ForcedLagrangian<N>
        + Parameters<N, P>
        + Driven<N, M>,
{
    measure::<_, _, N, M, P>([scene, "midpoint"], Midpoint, views, (q, v), h, visit);
    measure::<_, _, N, M, P>([scene, "Gauss, S = 2"], Gauss::<2>, views, (q, v), h, visit);
    measure::<_, _, N, M, P>([scene, "Gauss, S = 3"], Gauss::<3>, views, (q, v), h, visit);
}

/// So many steps of runs of a hundred, each with its input, and what is asked of each.
fn of_runs<R: Copy, L, const N: usize>(
    (rule, h): (R, f64),
    views: &[L; 8],
    start: State<f64, N>,
    times: usize,
    mut take: impl FnMut(&mut DrivenTrajectory<L, R, N>, &L),
) where
    L: Flow<R, N, Scalar = f64>,
{
    let mut left = times;
    while left > 0 {
        // Not so far that the motion becomes another.
        let some = left.min(100);
        let mut run = views[0].by(rule, h).run_with_inputs(start);
        for view in views.iter().cycle().take(some) {
            take(&mut run, view);
        }
        left -= some;
    }
}

fn measure<R: Copy, L, const N: usize, const M: usize, const P: usize>(
    [scene, name]: [&str; 2],
    rule: R,
    views: &[L; 8],
    (q, v): (SVector<f64, N>, SVector<f64, N>),
    h: f64,
    visit: Visit<'_>,
) where
    L: DiscreteDriven<R, N, M, Scalar = f64>
        + DiscreteParameters<R, N, P>
        + DiscreteSecondOrder<R, N, M>
        + Linearizable<R, N>,
{
    let system = &views[0];
    let state = State::from_velocity(system, q, v).expect("the scene is regular");
    let by = system.by(rule, h);
    let first = by.step(&state).expect("the scene can be stepped");
    let next = by.near(&first.velocity).step(&first.state).expect("the scene can be stepped");
    let covector = State { q: v, p: q };
    visit(
        scene,
        name,
        [
            &|times| {
                for _ in 0..times {
                    let _ = black_box(by.step(black_box(&first.state)));
                }
            },
            &|times| {
                let mut left = times;
                while left > 0 {
                    let some = left.min(100);
                    for step in by.run(first.state).take(some) {
                        let _ = black_box(step);
                    }
                    left -= some;
                }
            },
            &|times| {
                of_runs((rule, h), views, first.state, times, |run, view| {
                    let _ = black_box(run.advance(view));
                });
            },
            &|times| {
                of_runs((rule, h), views, first.state, times, |run, view| {
                    let Ok(taken) = run.advance_linearized(view) else { return };
                    let _ = black_box(taken.by_state());
                });
            },
            &|times| {
                of_runs((rule, h), views, first.state, times, |run, view| {
                    let Ok(taken) = run.advance_linearized(view) else { return };
                    let _ = black_box((taken.by_state(), taken.by_input::<M>()));
                });
            },
            &|times| {
                of_runs((rule, h), views, first.state, times, |run, view| {
                    let Ok(taken) = run.advance_linearized(view) else { return };
                    let _ = black_box((taken.by_state(), taken.by_input::<M>(), taken.by_parameters::<P>()));
                });
            },
            &|times| {
                for _ in 0..times {
                    let (q0, q1) = (black_box(&first.state.q), black_box(&next.state.q));
                    let step = by.segment(q0, q1).and_then(|segment| segment.linearized());
                    let _ = black_box(step.map(|step| (step.by_state(), step.by_input::<M>())));
                }
            },
            &|times| {
                for _ in 0..times {
                    let (q0, q1) = (black_box(&first.state.q), black_box(&next.state.q));
                    let step = by.segment(q0, q1).and_then(|segment| segment.linearized());
                    let _ = black_box(step.map(|step| step.hessian::<M>(&covector)));
                }
            },
        ],
    );
}
