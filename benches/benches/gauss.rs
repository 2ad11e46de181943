//! Work against precision of the Gauss rules, beside Dormand–Prince 8(5,3) of ode_solvers: microseconds for one trajectory and
//! the error of its last configuration.
//!
//! `RUSTFLAGS="-C target-cpu=native" cargo bench -p dalembert-benches --bench gauss`
//!
//! The stages are lanes of vector instructions, as wide as the target has them: without `target-cpu=native` x86-64 has two.
//! The peer gets accelerations derived by hand.

use std::hint::black_box;

use dalembert::{Discrete, Gauss, State, Trajectory, rayleigh_system};
use dalembert_benches::interleaved;
use ode_solvers::dop_shared::OutputType;
use ode_solvers::{Dop853, SVector};

/// Particle in the ring potential.
#[rayleigh_system(rule = gauss, derivatives = expanded)]
fn ring(q: [f64; 2], v: [f64; 2], k: f64) -> (f64, f64) {
    let s = q[0] * q[0] + q[1] * q[1];
    (0.5 * (v[0] * v[0] + v[1] * v[1]) - s * (s - 1.0).powi(2), 0.5 * k * (v[0] * v[0] + v[1] * v[1]))
}

/// Double pendulum of point masses, with friction in both joints.
#[rayleigh_system(rule = gauss, derivatives = expanded)]
fn double_pendulum(q: [f64; 2], v: [f64; 2], m: [f64; 2], l: [f64; 2], g: f64, c: [f64; 2]) -> (f64, f64) {
    let total = m[0] + m[1];
    let kinetic = 0.5 * total * l[0] * l[0] * v[0] * v[0]
        + 0.5 * m[1] * l[1] * l[1] * v[1] * v[1]
        + m[1] * l[0] * l[1] * (q[0] - q[1]).cos() * v[0] * v[1];
    let potential = -total * g * l[0] * q[0].cos() - m[1] * g * l[1] * q[1].cos();
    let relative = v[1] - v[0];
    (kinetic - potential, 0.5 * c[0] * v[0] * v[0] + 0.5 * c[1] * relative * relative)
}

/// Masses of the chain.
const MASSES: usize = 8;

/// Fermi–Pasta–Ulam–Tsingou β-chain between walls, with drag.
#[rayleigh_system(rule = gauss, derivatives = expanded)]
fn chain(q: [f64; MASSES], v: [f64; MASSES], beta: f64, drag: f64) -> (f64, f64) {
    let spring = |d: f64| 0.5 * d * d + 0.25 * beta * (d * d) * (d * d);
    let mut lagrangian = -spring(q[0]) - spring(q[MASSES - 1]);
    let mut rayleigh = 0.0;
    for i in 0..MASSES {
        lagrangian += 0.5 * v[i] * v[i];
        rayleigh += 0.5 * drag * v[i] * v[i];
        if i > 0 {
            lagrangian -= spring(q[i] - q[i - 1]);
        }
    }
    (lagrangian, rayleigh)
}

/// A scene: the system, where it starts, for how long, and its accelerations.
struct Scene<'a, L, F, const N: usize> {
    name: &'a str,
    system: &'a L,
    start: State<f64, N>,
    velocity: [f64; N],
    time: f64,
    acceleration: F,
}

/// q̇ = v, v̇ = a(q, v).
struct Equations<'f, F>(&'f F);

impl<F, const N: usize, const M: usize> ode_solvers::System<f64, SVector<f64, M>>
    for Equations<'_, (F, [(); N])>
where
    F: Fn([f64; N], [f64; N]) -> [f64; N],
{
    fn system(&self, _time: f64, y: &SVector<f64, M>, rate: &mut SVector<f64, M>) {
        let (q, v) = (std::array::from_fn(|i| y[i]), std::array::from_fn(|i| y[N + i]));
        let a = (self.0.0)(q, v);
        for i in 0..N {
            rate[i] = v[i];
            rate[N + i] = a[i];
        }
    }
}

/// A point of the diagram.
struct Point {
    microseconds: f64,
    error: f64,
    label: String,
}

impl<L, F, const N: usize> Scene<'_, L, (F, [(); N]), N>
where
    L: Discrete<Gauss<8>, N, Scalar = f64>,
    F: Fn([f64; N], [f64; N]) -> [f64; N],
{
    /// The last configuration by 8 stages and short steps.
    fn reference(&self) -> SVector<f64, N> {
        let steps = (self.time / 0.02).ceil();
        let mut run = Trajectory::new(self.system, Gauss::<8>, self.time / steps, self.start);
        run.by_ref().take(steps as usize).for_each(|step| drop(step.expect("the scene can be stepped")));
        run.state().q
    }

    fn by_gauss<const S: usize>(&self, end: &SVector<f64, N>, steps: u32) -> Option<Point>
    where
        L: Discrete<Gauss<S>, N, Scalar = f64>,
    {
        let h = self.time / f64::from(steps);
        let run = || {
            let mut trajectory = Trajectory::new(self.system, Gauss::<S>, h, black_box(self.start));
            let mut iterations = 0;
            for _ in 0..steps {
                iterations += trajectory.next()?.ok()?.report.iterations;
            }
            Some((trajectory.state().q, iterations))
        };
        let (q, iterations) = run()?;
        let [seconds] = interleaved([&|| {
            black_box(run());
        }]);
        let label =
            format!("S = {S}, h = {h:.3}, {:.1} iterations a step", f64::from(iterations) / f64::from(steps));
        Some(Point { microseconds: seconds * 1e6, error: (q - end).norm(), label })
    }

    fn by_dop853<const M: usize>(&self, end: &SVector<f64, N>, tolerance: f64) -> Option<Point> {
        let mut y = SVector::<f64, M>::zeros();
        for i in 0..N {
            (y[i], y[N + i]) = (self.start.q[i], self.velocity[i]);
        }
        let run = || {
            let mut solver = Dop853::from_param(
                Equations(&self.acceleration),
                0.0,
                self.time,
                self.time,
                black_box(y),
                tolerance,
                tolerance,
                0.9,
                0.0,
                0.333,
                6.0,
                self.time,
                0.0,
                1_000_000,
                u32::MAX,
                OutputType::Sparse,
            );
            solver.integrate().ok()?;
            solver.y_out().last().copied()
        };
        let last = run()?;
        let [seconds] = interleaved([&|| {
            black_box(run());
        }]);
        let error = (0..N).map(|i| (last[i] - end[i]).powi(2)).sum::<f64>().sqrt();
        Some(Point { microseconds: seconds * 1e6, error, label: format!("tolerance {tolerance:.0e}") })
    }
}

/// The cheapest point within each error.
fn table(name: &str, points: &[Point]) {
    print!("{name:24}");
    for bound in [1e-3, 1e-6, 1e-8, 1e-10, 1e-12] {
        let least = points.iter().filter(|point| point.error <= bound).map(|point| point.microseconds);
        match least.fold(f64::INFINITY, f64::min) {
            f64::INFINITY => print!("{:>9}", "–"),
            least => print!("{least:9.0}"),
        }
    }
    println!();
}

macro_rules! measured {
    ($scene:expr, $dimension:literal, [$($s:literal)*]) => {{
        let scene = $scene;
        let end = scene.reference();
        let all = std::env::args().any(|argument| argument == "--all");
        println!("\n{}, T = {}: microseconds to an error of", scene.name, scene.time);
        println!("{:24}{:>9}{:>9}{:>9}{:>9}{:>9}", "", "1e-3", "1e-6", "1e-8", "1e-10", "1e-12");
        $({
            let step_sizes = (0..16).map(|k| 1.2 * 0.8_f64.powi(k));
            let points: Vec<Point> = step_sizes
                .filter_map(|h| scene.by_gauss::<$s>(&end, (scene.time / h).ceil() as u32))
                .collect();
            table(&format!("Gauss, S = {}", $s), &points);
            if all {
                for Point { microseconds, error, label } in &points {
                    println!("    {microseconds:9.1} µs  error {error:.1e}  {label}");
                }
            }
        })*
        let points: Vec<Point> =
            (6..30).filter_map(|k| scene.by_dop853::<$dimension>(&end, 10_f64.powf(-0.5 * f64::from(k)))).collect();
        table("ode_solvers, Dop853", &points);
    }};
}

fn main() {
    let k = 1e-3;
    let ring = Ring { k };
    let (q, velocity) = ([0.0, 1.15549918674982], [0.5, 0.0]);
    measured!(
        Scene {
            name: "ring",
            system: &ring,
            start: State::from_velocity(&ring, q, velocity).expect("regular"),
            velocity,
            time: 100.0,
            acceleration: (
                |q: [f64; 2], v: [f64; 2]| {
                    let s = q[0] * q[0] + q[1] * q[1];
                    let slope = 2.0 * (s - 1.0) * (3.0 * s - 1.0);
                    [-slope * q[0] - k * v[0], -slope * q[1] - k * v[1]]
                },
                [(); 2]
            ),
        },
        4,
        [2 4 6 8]
    );

    let (m, l, g, c) = ([1.0, 0.7], [1.0, 0.8], 9.81, [0.05, 0.03]);
    let pendulum = DoublePendulum { m, l, g, c };
    let (q, velocity) = ([0.8, -0.4], [0.0, 0.5]);
    measured!(
        Scene {
            name: "double pendulum",
            system: &pendulum,
            start: State::from_velocity(&pendulum, q, velocity).expect("regular"),
            velocity,
            time: 20.0,
            acceleration: (
                |q: [f64; 2], v: [f64; 2]| {
                    let (sine, cosine) = (q[0] - q[1]).sin_cos();
                    let (a, b, d) =
                        ((m[0] + m[1]) * l[0] * l[0], m[1] * l[0] * l[1] * cosine, m[1] * l[1] * l[1]);
                    let coupling = m[1] * l[0] * l[1] * sine;
                    let relative = c[1] * (v[1] - v[0]);
                    let first = -coupling * v[1] * v[1] - (m[0] + m[1]) * g * l[0] * q[0].sin() - c[0] * v[0] + relative;
                    let second = coupling * v[0] * v[0] - m[1] * g * l[1] * q[1].sin() - relative;
                    let determinant = a * d - b * b;
                    [(d * first - b * second) / determinant, (a * second - b * first) / determinant]
                },
                [(); 2]
            ),
        },
        4,
        [2 4 6 8]
    );

    let (beta, drag) = (1.0, 0.01);
    let chain = Chain { beta, drag };
    let q: [f64; MASSES] = std::array::from_fn(|i| (std::f64::consts::PI * (i + 1) as f64 / 9.0).sin());
    let velocity = [0.0; MASSES];
    measured!(
        Scene {
            name: "FPUT chain, n = 8",
            system: &chain,
            start: State::from_velocity(&chain, q, velocity).expect("regular"),
            velocity,
            time: 100.0,
            acceleration: (
                |q: [f64; MASSES], v: [f64; MASSES]| {
                    let mut acceleration = [0.0; MASSES];
                    let mut before = q[0] + beta * q[0] * q[0] * q[0];
                    for i in 0..MASSES {
                        let stretch = if i + 1 < MASSES { q[i + 1] - q[i] } else { -q[i] };
                        let after = stretch + beta * stretch * stretch * stretch;
                        acceleration[i] = after - before - drag * v[i];
                        before = after;
                    }
                    acceleration
                },
                [(); MASSES]
            ),
        },
        16,
        [2 4 6 8]
    );
}
