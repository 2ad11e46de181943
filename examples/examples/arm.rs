//! A two-link arm whose tip follows a figure eight under a moving-horizon controller at 1 kHz: every
//! millisecond one iteration of iterative LQR over the next 0.2 s, with the generated step as its model, from
//! the state that an extended Kalman filter believes. The encoders give angles alone, and those by a clock of
//! their own, every 1.3 ms: the filter steps its model to when they were read, and from there to the next
//! period.
//!
//! SI units. The motion itself is computed by another rule (trapezoidal) with steps of a quarter of a
//! millisecond; between them the encoders are read.
//!
//! ```text
//! cargo run --release --example arm [picture.svg]
//! ```

use std::f64::consts::TAU;
use std::time::Instant;

use anyhow::{Context, Result, ensure};
use dalembert::nalgebra::{SMatrix, SVector, matrix, vector};
use dalembert::{Discretise, State, StepError, Trapezoidal, rayleigh_system};
use dalembert_examples::control::{self, Estimate, Linearised, Plan, Problem, Quadratic, SensorClock};
use dalembert_examples::picture::{self, Curve, Dash, Panel, colour, linear, logarithmic};
use rand::SeedableRng;
use rand::rngs::StdRng;
use rand_distr::{Distribution, Normal};

/// Two uniform rods in a vertical plane with a motor in each joint; q is (angle of the first from the
/// horizontal, angle of the second from the first).
pub struct Arm {
    /// Masses, kg.
    pub m: [f64; 2],
    /// Lengths, m.
    pub l: [f64; 2],
    /// Friction of each joint, N m s.
    pub c: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl Arm {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let [m1, m2] = self.m;
        let [l1, l2] = self.l;
        let spin = v[0] + v[1];
        let kinetic = m1 * l1 * l1 / 6.0 * v[0] * v[0]
            + m2 * (0.5 * l1 * l1 * v[0] * v[0]
                + l2 * l2 / 6.0 * spin * spin
                + 0.5 * l1 * l2 * q[1].cos() * v[0] * spin);
        let height = (0.5 * m1 + m2) * l1 * q[0].sin() + 0.5 * m2 * l2 * (q[0] + q[1]).sin();
        kinetic - 9.81 * height
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.c * (v[0] * v[0] + v[1] * v[1])
    }

    fn force(&self, _q: [f64; 2], _v: [f64; 2], u: [f64; 2]) -> [f64; 2] {
        u
    }
}

impl Arm {
    /// Where the tip is, m.
    fn tip(&self, q: &SVector<f64, 2>) -> SVector<f64, 2> {
        let (first, second) = (q[0], q[0] + q[1]);
        vector![
            self.l[0] * first.cos() + self.l[1] * second.cos(),
            self.l[0] * first.sin() + self.l[1] * second.sin()
        ]
    }

    /// ∂tip/∂q.
    fn jacobian(&self, q: &SVector<f64, 2>) -> SMatrix<f64, 2, 2> {
        let (first, second) = (q[0], q[0] + q[1]);
        let (dx, dy) = (-self.l[1] * second.sin(), self.l[1] * second.cos());
        matrix![dx - self.l[0] * first.sin(), dx; dy + self.l[0] * first.cos(), dy]
    }

    /// The angles that bring the tip to a point in reach, elbow below.
    fn angles(&self, tip: &SVector<f64, 2>) -> SVector<f64, 2> {
        let [l1, l2] = self.l;
        let elbow = ((tip.norm_squared() - l1 * l1 - l2 * l2) / (2.0 * l1 * l2)).acos();
        vector![tip[1].atan2(tip[0]) - (l2 * elbow.sin()).atan2(l1 + l2 * elbow.cos()), elbow]
    }
}

/// The arm of the scene.
pub const ARM: Arm = Arm { m: [1.0, 0.8], l: [0.5, 0.4], c: 0.05 };
/// The period of the controller, s.
pub const H: f64 = 1e-3;
/// When the encoders are read first and the time from one reading to the next, s: never at the end of a step
/// of the plant.
pub const ENCODERS: [f64; 2] = [0.37e-3, 1.3e-3];
/// Periods of the run.
pub const PERIODS: usize = 4000;
/// Periods before the errors count: the arm starts at rest.
pub const SETTLED: usize = 500;
/// Steps of the horizon and the length of one, s.
const HORIZON: usize = 20;
const STRIDE: f64 = 0.01;
/// Standard deviations of an encoder, rad, and of the torque that no model knows, N m.
const ENCODER: f64 = 5e-4;
const UNKNOWN: f64 = 0.1;

type Vector = SVector<f64, 4>;

/// Position and velocity of the tip on the figure eight, once around in 2 s.
pub fn reference(t: f64) -> [SVector<f64, 2>; 2] {
    let (phase, rate) = (TAU * t / 2.0, TAU / 2.0);
    [
        vector![0.55 + 0.12 * (2.0 * phase).sin(), 0.1 + 0.2 * phase.sin()],
        vector![0.24 * (2.0 * phase).cos(), 0.2 * phase.cos()] * rate,
    ]
}

/// The state (q, p) on the reference.
fn wanted(t: f64) -> Result<Vector, StepError> {
    let [tip, speed] = reference(t);
    let q = ARM.angles(&tip);
    let v = ARM.jacobian(&q).try_inverse().unwrap_or_default() * speed;
    Ok(control::vector(&State::from_velocity(&ARM, q, v)?))
}

/// To follow the reference from time `t` on.
struct Following {
    wanted: Vec<Vector>,
}

impl Following {
    fn from(t: f64) -> Result<Self, StepError> {
        let wanted = (0..=HORIZON).map(|k| wanted(t + k as f64 * STRIDE)).collect::<Result<_, _>>()?;
        Ok(Self { wanted })
    }
}

impl Problem<4, 2> for Following {
    fn advance(&self, x: &Vector, u: &SVector<f64, 2>) -> Result<Vector, StepError> {
        control::advance(&ARM.driven(*u), x, STRIDE)
    }

    fn linearised(&self, x: &Vector, u: &SVector<f64, 2>) -> Result<Linearised<4, 2>, StepError> {
        control::linearised(&ARM.driven(*u), x, STRIDE)
    }

    fn cost(&self, k: usize, x: &Vector, u: &SVector<f64, 2>) -> Result<Quadratic<4, 2>, StepError> {
        let weights = SMatrix::from_diagonal(&vector![1e4, 1e4, 10.0, 10.0]);
        let effort = 1e-3;
        let miss = x - self.wanted[k];
        let value = 0.5 * miss.dot(&(weights * miss)) + 0.5 * effort * u.norm_squared();
        Ok(Quadratic {
            value,
            x: weights * miss,
            xx: weights,
            u: u * effort,
            uu: SMatrix::identity() * effort,
        })
    }
}

fn main() -> Result<()> {
    let run = Run::new()?;
    let micro = |seconds: &[f64]| {
        let mut sorted = seconds.to_vec();
        sorted.sort_by(f64::total_cmp);
        [sorted.len() / 2, sorted.len() * 99 / 100].map(|index| sorted[index] * 1e6)
    };
    let [median, high] = micro(&run.seconds);
    println!(
        "Figure eight, {:.0} times around in {:.0} s, under torques of {UNKNOWN} N m that the model does not know",
        PERIODS as f64 * H / 2.0,
        PERIODS as f64 * H
    );
    let most = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
    let torque =
        |periods: &[SVector<f64, 2>]| periods.iter().fold(0.0_f64, |largest, u| largest.max(u.amax()));
    let stretches = [("the whole run, from rest", 0), ("settled, without the first 0.5 s", SETTLED)];
    for (stretch, from) in stretches {
        println!("  {stretch}:");
        println!(
            "    tip off its reference: {:.2} mm rms, {:.2} mm at most; largest torque {:.1} N m",
            1e3 * rms(&run.misses[from..]),
            1e3 * most(&run.misses[from..]),
            torque(&run.torques[from..])
        );
        println!(
            "    velocities, rms error: filter {:.3} rad/s, differences of the encoders {:.3} rad/s",
            rms(&run.filter_errors[from..]),
            rms(&run.difference_errors[from..])
        );
    }
    println!(
        "All that a period computes, filter, {HORIZON} steps ahead with derivatives, and the prediction, of 1000 µs: {median:.0} µs in the \
         median, {high:.0} µs at the 99th percentile, {:.0} µs at most",
        most(&run.seconds) * 1e6
    );
    ensure!(rms(&run.misses[SETTLED..]) < 3e-3, "the arm lost its reference");
    println!("\nPicture: {}", draw(&run)?.display());
    Ok(())
}

/// Root mean square.
pub fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

/// What happened, period by period.
#[derive(Default)]
pub struct Run {
    /// Where the tip was, m.
    pub tips: Vec<SVector<f64, 2>>,
    /// Its distance from the reference, m.
    pub misses: Vec<f64>,
    /// Torques of the controller, N m.
    pub torques: Vec<SVector<f64, 2>>,
    /// Velocity of the second joint: true, believed by the filter, and from differences of the encoder,
    /// rad/s.
    pub velocities: Vec<[f64; 3]>,
    /// Error of the filter's velocities, rad/s.
    pub filter_errors: Vec<f64>,
    /// Error of velocities by differences of the encoders, rad/s.
    pub difference_errors: Vec<f64>,
    /// Time spent in filter and controller, s.
    pub seconds: Vec<f64>,
}

impl Run {
    /// The run, from rest at the start of the reference.
    pub fn new() -> Result<Self> {
        let mut random = StdRng::seed_from_u64(2);
        let (encoder, unknown) = (Normal::new(0.0, ENCODER)?, Normal::new(0.0, UNKNOWN)?);
        let state = State::from_velocity(&ARM, ARM.angles(&reference(0.0)[0]), [0.0, 0.0])?;
        let mut estimate = Estimate {
            x: control::vector(&state),
            covariance: SMatrix::from_diagonal(&vector![1e-4, 1e-4, 1e-2, 1e-2]),
        };
        let angles_of_state = SMatrix::<f64, 2, 4>::identity();
        let noise_of_encoders = SMatrix::<f64, 2, 2>::identity() * ENCODER.powi(2);
        let mut plant = ARM.driven([0.0; 2]).by(Trapezoidal, H / 4.0).run_with_inputs(state);
        let mut clock = SensorClock::new(ENCODERS[0], ENCODERS[1]);
        let mut inputs = vec![SVector::zeros(); HORIZON];
        let mut readings: Vec<(f64, SVector<f64, 2>)> = Vec::new();
        let (mut last, mut by_differences) = ((0.0, state.q), SVector::zeros());
        let mut u = SVector::zeros();
        let mut run = Self::default();
        for k in 0..PERIODS {
            let now = k as f64 * H;
            let stopwatch = Instant::now();
            // To each reading since the last period and from there to now, under the input that was held.
            let mut reached = (k as f64 - 1.0).max(0.0) * H;
            for (time, measured) in &readings {
                estimate = predicted(&estimate, &u, time - reached)?;
                estimate = estimate.corrected(measured, &angles_of_state, &noise_of_encoders)?;
                reached = *time;
            }
            if k > 0 {
                estimate = predicted(&estimate, &u, now - reached)?;
            }
            let problem = Following::from(now)?;
            let plan = Plan::new(&problem, estimate.x, inputs)?;
            let plan = plan.improved(&problem, estimate.x, 0.0)?.unwrap_or(plan);
            u = plan.inputs[0];
            // The horizon's steps are ten periods long: its inputs slide by a tenth of a step.
            inputs = plan.inputs;
            for index in 0..HORIZON - 1 {
                inputs[index] = inputs[index].lerp(&inputs[index + 1], H / STRIDE);
            }
            run.seconds.push(stopwatch.elapsed().as_secs_f64());

            for (time, measured) in readings.drain(..) {
                by_differences = (measured - last.1) / (time - last.0);
                last = (time, measured);
            }
            let state = *plant.state();
            let v = state.velocity(&ARM)?;
            let believed = control::state::<2, 4>(&estimate.x).velocity(&ARM)?;
            run.velocities.push([v[1], believed[1], by_differences[1]]);
            run.filter_errors.push((believed - v).norm());
            run.difference_errors.push((by_differences - v).norm());
            run.tips.push(ARM.tip(&state.q));
            run.misses.push((ARM.tip(&state.q) - reference(now)[0]).norm());
            run.torques.push(u);

            let driven = ARM.driven(u + SVector::from_fn(|_, _| unknown.sample(&mut random)));
            let mut period = plant.hold(&driven);
            for sample in period.sample_at(clock.times_before(now + H)) {
                let sample = sample?;
                let error = SVector::from_fn(|_, _| encoder.sample(&mut random));
                readings.push((sample.time, sample.state.q + error));
            }
            while period.time() < now + 0.9 * H {
                period.next().context("a run goes on")??;
            }
        }
        Ok(run)
    }
}

/// The estimate some time on, under an input that is held, with what unknown torques add: they change from
/// period to period, so that their share in the covariance grows with the time.
fn predicted(estimate: &Estimate<4>, u: &SVector<f64, 2>, elapsed: f64) -> Result<Estimate<4>, StepError> {
    let model = control::linearised::<_, 2, 2, 4>(&ARM.driven(*u), &estimate.x, elapsed)?;
    let noise = model.b * model.b.transpose() * (UNKNOWN.powi(2) * H / elapsed);
    Ok(estimate.predicted(&model, &noise))
}

fn draw(run: &Run) -> Result<std::path::PathBuf> {
    let over_time = |values: &dyn Fn(usize) -> f64, range: std::ops::Range<usize>| -> Vec<_> {
        range.map(|k| (k as f64 * H, values(k))).collect()
    };
    let all = 0..PERIODS;
    let path = (0..=2000).map(|k| reference(k as f64 * H)[0]).map(|tip| (tip[0], tip[1])).collect();
    let tips = run.tips.iter().map(|tip| (tip[0], tip[1])).collect();
    let window = 1000..1200;
    let velocity = |index: usize| over_time(&|k| run.velocities[k][index], window.clone());
    let torque = |joint: usize| over_time(&|k| run.torques[k][joint], all.clone());
    let time = linear("time t (s)");
    let counted = SETTLED as f64 * H;
    let largest = run.misses[SETTLED..].iter().copied().fold(0.0, f64::max);
    let settled = format!("Once settled the tip is within {:.1} mm", 1e3 * largest);
    let panels = [
        Panel::new(
            "From rest the tip joins its figure eight",
            linear("x (m)"),
            linear("y (m)"),
            vec![
                Curve::line("tip, from rest", colour::VARIATIONAL, 5, tips),
                Curve::line("reference", colour::REFERENCE, 2, path).dashed(Dash::Dashed),
            ],
        )
        .to_equal_scale(),
        Panel::new(
            &settled,
            time,
            logarithmic("distance from the reference (mm)").with_floor(1e-3).from_to(1e-3, 10.0),
            vec![
                Curve::line("tip", colour::VARIATIONAL, 2, over_time(&|k| 1e3 * run.misses[k], all.clone())),
                Curve::line(
                    "settled from here on",
                    colour::RUNGE_KUTTA,
                    2,
                    vec![(counted, 1e-3), (counted, 10.0)],
                )
                .dashed(Dash::Dashed),
            ],
        ),
        Panel::new(
            "Most torque goes into the start",
            time,
            linear("torque (N m)"),
            vec![
                Curve::line("first joint", colour::VARIATIONAL, 3, torque(0)),
                Curve::line("second joint", colour::RUNGE_KUTTA, 1, torque(1)),
            ],
        ),
        Panel::new(
            "The filter finds the velocity in the noise",
            time,
            linear("velocity of the second joint (rad/s)"),
            vec![
                Curve::line("differences of the encoder", colour::EULER, 1, velocity(2)),
                Curve::line("true", colour::REFERENCE, 4, velocity(0)),
                Curve::line("filter", colour::FIFTH, 2, velocity(1)).dashed(Dash::Dashed),
            ],
        ),
    ];
    picture::write("arm", [1240, 1160], 2, &panels)
}
