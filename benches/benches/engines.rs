//! One midpoint step with derivatives written out, against the same with num-dual, interleaved in one run.
//!
//! `cargo bench -p dalembert-benches --bench engines`

use std::hint::black_box;

use dalembert::{Discrete, Midpoint, State, Trajectory};
use dalembert_benches::interleaved;

/// The systems, with the engine named.
macro_rules! systems {
    ($engine:ident) => {
        use dalembert::rayleigh_system;

        pub struct Ring {
            pub k: f64,
        }

        #[rayleigh_system(derivatives = $engine)]
        impl Ring {
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let s = q[0] * q[0] + q[1] * q[1];
                0.5 * (v[0] * v[0] + v[1] * v[1]) - s * (s - 1.0).powi(2)
            }

            fn rayleigh(&self, v: [f64; 2]) -> f64 {
                0.5 * self.k * (v[0] * v[0] + v[1] * v[1])
            }
        }

        /// The Fermi–Pasta–Ulam–Tsingou β-chain between walls.
        pub struct Chain {
            pub beta: f64,
            pub drag: f64,
        }

        #[rayleigh_system(derivatives = $engine)]
        impl Chain {
            fn lagrangian(&self, q: [f64; 8], v: [f64; 8]) -> f64 {
                let mut energy = 0.0;
                for v in &v {
                    energy += 0.5 * v * v;
                }
                energy -= Self::spring(self.beta, q[0]) + Self::spring(self.beta, q[7]);
                for i in 1..8 {
                    energy -= Self::spring(self.beta, q[i] - q[i - 1]);
                }
                energy
            }

            fn rayleigh(&self, v: [f64; 8]) -> f64 {
                0.5 * self.drag * v.iter().map(|v| v * v).sum::<f64>()
            }

            fn spring(beta: f64, d: f64) -> f64 {
                let square = d * d;
                0.5 * square + 0.25 * beta * square * square
            }
        }
    };
}

mod expanded {
    systems!(expanded);
}

mod num_dual {
    systems!(num_dual);
}

fn main() {
    let (a, b) = (expanded::Ring { k: 1e-3 }, num_dual::Ring { k: 1e-3 });
    compare("ring, n = 2", &a, &b, 0.2, [0.0, 1.15549918674982], [0.5, 0.0], 20_000);
    let (a, b) = (expanded::Chain { beta: 0.7, drag: 1e-3 }, num_dual::Chain { beta: 0.7, drag: 1e-3 });
    let q = std::array::from_fn(|i| (i as f64 * 0.7).sin());
    compare("FPUT chain, n = 8", &a, &b, 0.05, q, [0.0; 8], 500);
}

/// Times both after checking that they compute the same trajectory.
fn compare<A, B, const N: usize>(name: &str, a: &A, b: &B, h: f64, q: [f64; N], v: [f64; N], steps: usize)
where
    A: Discrete<Midpoint, N, Scalar = f64>,
    B: Discrete<Midpoint, N, Scalar = f64>,
{
    let (end_a, end_b) = (run(a, h, q, v, 200), run(b, h, q, v, 200));
    let difference = (end_a.q - end_b.q).amax();
    assert!(difference < 1e-11, "{name}: the engines differ by {difference:e} after 200 steps");
    let [expanded, dual] = interleaved([
        &|| {
            black_box(run(a, h, q, v, steps));
        },
        &|| {
            black_box(run(b, h, q, v, steps));
        },
    ]);
    let per_step = |time: f64| time / steps as f64 * 1e9;
    println!(
        "{name:18} expanded {:8.1} ns   num-dual {:8.1} ns   ratio {:.1}",
        per_step(expanded),
        per_step(dual),
        dual / expanded
    );
}

fn run<L, const N: usize>(system: &L, h: f64, q: [f64; N], v: [f64; N], steps: usize) -> State<f64, N>
where
    L: Discrete<Midpoint, N, Scalar = f64>,
{
    let start = State::from_velocity(system, q, v).expect("the scene is regular");
    let mut trajectory = Trajectory::new(system, Midpoint, h, black_box(start));
    for step in (&mut trajectory).take(steps) {
        black_box(step.expect("the scene can be stepped"));
    }
    *trajectory.state()
}
