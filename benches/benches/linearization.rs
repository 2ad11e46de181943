//! The derivatives A and B of a step, and its second derivatives, against the step itself, interleaved in one run.
//!
//! `cargo bench -p dalembert-benches --bench linearization`

use std::hint::black_box;

use dalembert::nalgebra::{SVector, vector};
use dalembert::{
    DiscreteDriven, DiscreteSecondOrder, Driven, ForcedLagrangian, Gauss, Linearization, Midpoint, State,
    StepHessian, rayleigh_system,
};
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

fn main() {
    let joint = Joint { c: 0.1 };
    all("pendulum, n = 1, m = 1", &joint.driven([0.3]), vector![0.8], vector![0.4], 0.02);
    let cart = CartPole { c: [0.1, 0.01] };
    all("cart and pole, n = 2, m = 1", &cart.driven([0.3]), vector![0.1, 2.8], vector![0.3, -0.4], 0.02);
    let arm = Arm { c: 0.1 };
    let (q, v) = (vector![0.3, 0.5, -0.2, 1.0], vector![0.3, -0.4, 0.7, 0.2]);
    all("four links, n = 4, m = 4", &arm.driven([1.0, 0.5, 0.2, -0.1]), q, v, 0.01);
}

/// By the midpoint rule, and with two and three stages.
fn all<L, const N: usize, const M: usize>(
    name: &str,
    system: &L,
    q: SVector<f64, N>,
    v: SVector<f64, N>,
    h: f64,
) where
    L: DiscreteDriven<Midpoint, N, M, Scalar = f64>
        + DiscreteSecondOrder<Midpoint, N, M>
        + ForcedLagrangian<N>
        + Driven<N, M>,
{
    println!("{name}");
    measure("midpoint", Midpoint, system, q, v, h);
    measure("Gauss, S = 2", Gauss::<2>, system, q, v, h);
    measure("Gauss, S = 3", Gauss::<3>, system, q, v, h);
}

fn measure<R: Copy, L, const N: usize, const M: usize>(
    name: &str,
    rule: R,
    system: &L,
    q: SVector<f64, N>,
    v: SVector<f64, N>,
    h: f64,
) where
    L: DiscreteDriven<R, N, M, Scalar = f64> + DiscreteSecondOrder<R, N, M>,
{
    let state = State::from_velocity(system, q, v).expect("the scene is regular");
    let first = system.step(&state, h, None).expect("the scene can be stepped");
    // In a loop of control the last velocity is the guess.
    let guess = Some(&first.velocity);
    let next = system.step(&first.state, h, guess).expect("the scene can be stepped");
    let covector = State { q: v, p: q };
    let times = medians(&[
        &|repeats| {
            for _ in 0..repeats {
                let _ = black_box(system.step(black_box(&first.state), h, guess));
            }
        },
        &|repeats| {
            for _ in 0..repeats {
                let state = black_box(&first.state);
                let _ = black_box(Linearization::of_driven_step(system, rule, state, h, guess));
            }
        },
        &|repeats| {
            for _ in 0..repeats {
                let (q0, q1) = (black_box(&first.state.q), black_box(&next.state.q));
                let _ = black_box(Linearization::of_driven_segment(system, rule, q0, q1, h));
            }
        },
        &|repeats| {
            for _ in 0..repeats {
                let (q0, q1) = (black_box(&first.state.q), black_box(&next.state.q));
                let _ = black_box(StepHessian::of_driven_segment(system, rule, q0, q1, h, &covector));
            }
        },
    ]);
    let [step, with_step, segment, second] = std::array::from_fn(|i| times[i] * 1e9);
    println!(
        "  {name:12} step {step:8.1} ns ({} iterations)   with A, B {with_step:8.1} ns, {:5.2} steps   \
         A, B of the ends {segment:8.1} ns, {:5.2} steps   second {second:8.1} ns, {:5.2} steps",
        next.report.iterations,
        with_step / step,
        segment / step,
        second / step
    );
}
