//! A cart with a pole, friction in rail and joint: swung up by iterative LQR, held upright by a discrete LQR,
//! both from the exact derivatives A and B of the generated step, under noise, a fluctuating force and two
//! pushes.
//!
//! SI units. The motion itself is computed by another rule (trapezoidal) with steps ten times finer than the
//! controller's. The sensors have a clock of their own, every 7.3 ms: they measure between the plant's steps,
//! and what the controller knows is up to 7.3 ms old. One step of the model, as long as that, brings it up to
//! date.
//!
//! ```text
//! cargo run --release --example cart_pole [picture.svg]
//! ```

use std::f64::consts::PI;
use std::time::Instant;

use anyhow::{Context, Result, ensure};
use dalembert::derivative::PhaseMatrix;
use dalembert::nalgebra::{SMatrix, SVector, matrix, vector};
use dalembert::{Discretise, State, StepError, Trapezoidal, rayleigh_system};
use dalembert_examples::control::{self, Linearised, Plan, Problem, Quadratic, Regulator, SensorClock};
use dalembert_examples::picture::{self, Curve, Dash, Mark, Panel, colour, linear};
use rand::SeedableRng;
use rand::rngs::StdRng;
use rand_distr::{Distribution, Normal};

/// A pole of mass `pole` at the end of a rod of length `l`, hinged to a cart; q is (position, angle from
/// below).
pub struct CartPole {
    /// Mass of the cart, kg.
    pub cart: f64,
    /// Mass at the pole's end, kg.
    pub pole: f64,
    /// Length of the pole, m.
    pub l: f64,
    /// Friction of the rail, N s/m, and of the joint, N m s.
    pub c: [f64; 2],
}

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl CartPole {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let kinetic = 0.5 * (self.cart + self.pole) * v[0] * v[0]
            + self.pole * self.l * q[1].cos() * v[0] * v[1]
            + 0.5 * self.pole * self.l * self.l * v[1] * v[1];
        kinetic + self.pole * 9.81 * self.l * q[1].cos()
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * (self.c[0] * v[0] * v[0] + self.c[1] * v[1] * v[1])
    }

    fn force(&self, _q: [f64; 2], _v: [f64; 2], u: [f64; 1]) -> [f64; 2] {
        [u[0], 0.0]
    }
}

/// The system of the scene.
pub const PLANT: CartPole = CartPole { cart: 1.0, pole: 0.3, l: 0.5, c: [0.2, 0.002] };
/// The period of the controller, s.
pub const H: f64 = 0.01;
/// Periods of the swing-up, and of the whole run.
pub const SWING: usize = 200;
/// 14 s.
pub const PERIODS: usize = 1400;
/// The first measurement and the time from one to the next, s: never at the end of a step of the plant.
pub const SENSORS: [f64; 2] = [0.00245, 0.0073];
/// When the pole is pushed, in periods, and the angular momentum that each push adds, N m s.
pub const PUSHES: [(usize, f64); 2] = [(500, 0.05), (900, -0.08)];

type Vector = SVector<f64, 4>;

/// Weights of (q, v) in the costs: of the regulator, and at the end of the swing-up.
const HELD: [f64; 4] = [4.0, 20.0, 1.0, 1.0];
const AT_END: [f64; 4] = [200.0, 2000.0, 50.0, 50.0];

fn main() -> Result<()> {
    let clock = Instant::now();
    let (plan, iterations) = swing_up()?;
    let planning = clock.elapsed();
    let force = plan.inputs.iter().fold(0.0_f64, |force, u| force.max(u[0].abs()));
    let end = control::state::<2, 4>(&plan.states[SWING]);
    println!("Swing-up by iterative LQR: {iterations} iterations in {:.1} ms", planning.as_secs_f64() * 1e3);
    println!(
        "  at t = {:.1} s {:.2}° from upright, {:.1} mm from the middle, largest force {force:.1} N",
        SWING as f64 * H,
        (end.q[1] - PI).to_degrees(),
        1e3 * end.q[0]
    );

    let clock = Instant::now();
    let gain = upright_gain()?;
    let regulating = clock.elapsed();
    let upright = control::linearised(&PLANT.driven([0.0]), &target(), H)?;
    let radius = |closed: SMatrix<f64, 4, 4>| {
        closed.complex_eigenvalues().iter().fold(0.0_f64, |radius, value| radius.max(value.norm()))
    };
    println!(
        "LQR upright: largest |eigenvalue| of A {:.4}, of A − BK {:.4}",
        radius(upright.a),
        radius(upright.a - upright.b * gain)
    );

    let run = Run::new(&plan, &gain, true)?;
    let held = run.largest_angle(SWING..PERIODS);
    println!(
        "Held upright for {:.1} s under noise and two pushes: largest angle {:.1}°, largest offset {:.0} mm; largest force of the run {:.1} N",
        (PERIODS - SWING) as f64 * H,
        held.to_degrees(),
        1e3 * run.largest_offset(SWING..PERIODS),
        run.forces.iter().fold(0.0_f64, |force, u| force.max(u.abs())),
    );
    let [planning, regulating] = [planning, regulating].map(|time| time.as_secs_f64());
    println!("What control cost, of {:.0} µs a period:", H * 1e6);
    println!(
        "  before the run: plan and its gains {:.0} µs, gain of the regulator {:.0} µs",
        planning * 1e6,
        regulating * 1e6
    );
    println!(
        "    (one step with its derivatives A and B, of which they are made: {:.2} µs)",
        seconds_of_linearisation(&plan)? * 1e6
    );
    println!(
        "  in each period: {:.2} µs, to make momenta of the sensors' velocities, to step the model over their age and to apply a gain; \
         nothing filters, nothing plans anew",
        run.seconds / PERIODS as f64 * 1e6
    );
    println!(
        "  all of it, shared among {PERIODS} periods: {:.2} µs a period",
        (planning + regulating + run.seconds) / PERIODS as f64 * 1e6
    );
    ensure!(held < 0.5, "the pole fell: {:.1}°", held.to_degrees());
    println!("\nPicture: {}", draw(&plan, &run)?.display());
    Ok(())
}

/// Upright at rest in the middle.
pub fn target() -> Vector {
    vector![0.0, PI, 0.0, 0.0]
}

/// ½ Σ w (·)² of the distance of (q, v) from the target, as a function of (q, p).
fn distance(x: &Vector, weights: [f64; 4]) -> Result<(f64, Vector, SMatrix<f64, 4, 4>), StepError> {
    let state = control::state(x);
    let v = state.velocity(&PLANT)?;
    let by_state = PhaseMatrix::to_velocity(&PLANT, &state.q, &v)?.assembled::<4>();
    let weights = SMatrix::from_diagonal(&Vector::from(weights));
    let miss = vector![state.q[0], state.q[1], v[0], v[1]] - target();
    let slope = by_state.transpose() * weights * miss;
    Ok((0.5 * miss.dot(&(weights * miss)), slope, by_state.transpose() * weights * by_state))
}

/// To the target at the end, with little force on the way.
struct SwingUp;

impl Problem<4, 1> for SwingUp {
    fn advance(&self, x: &Vector, u: &SVector<f64, 1>) -> Result<Vector, StepError> {
        control::advance(&PLANT.driven(*u), x, H)
    }

    fn linearised(&self, x: &Vector, u: &SVector<f64, 1>) -> Result<Linearised<4, 1>, StepError> {
        control::linearised(&PLANT.driven(*u), x, H)
    }

    fn cost(&self, k: usize, x: &Vector, u: &SVector<f64, 1>) -> Result<Quadratic<4, 1>, StepError> {
        let weights = if k == SWING { AT_END } else { HELD.map(|weight| 0.1 * weight * H) };
        let (value, by_x, xx) = distance(x, weights)?;
        let effort = 0.05 * H;
        Ok(Quadratic {
            value: value + 0.5 * effort * u[0] * u[0],
            x: by_x,
            xx,
            u: u * effort,
            uu: matrix![effort],
        })
    }
}

/// The plan from hanging at rest, and the iterations that it took.
pub fn swing_up() -> Result<(Plan<4, 1>, usize)> {
    let inputs = (0..SWING).map(|k| vector![2.0 * (2.0 * PI * k as f64 * H).sin()]).collect();
    let mut plan = Plan::new(&SwingUp, Vector::zeros(), inputs)?;
    let mut damping = 1.0;
    let mut iterations = 0;
    while iterations < 500 && damping < 1e6 {
        iterations += 1;
        match plan.improved(&SwingUp, plan.states[0], damping)? {
            Some(next) => {
                let gained = plan.cost - next.cost;
                plan = next;
                damping = f64::max(damping / 3.0, 1e-9);
                if gained < 1e-7 * plan.cost {
                    break;
                }
            }
            None => damping *= 10.0,
        }
    }
    Ok((plan, iterations))
}

/// K of u = −K (x − target).
pub fn upright_gain() -> Result<SMatrix<f64, 1, 4>> {
    let model = control::linearised(&PLANT.driven([0.0]), &target(), H)?;
    let (_, _, weights) = distance(&target(), HELD)?;
    Ok(Regulator::of(&model, &weights, &matrix![0.05])?.gain)
}

/// What happened, period by period.
pub struct Run {
    /// The true states.
    pub states: Vec<State<f64, 2>>,
    /// The forces of the controller.
    pub forces: Vec<f64>,
    /// Time spent in the controller, s.
    pub seconds: f64,
}

impl Run {
    /// The motion from hanging under noise and pushes: the plan with its gains first, then the regulator.
    /// Without `feedback` the plan's forces alone, then none.
    pub fn new(plan: &Plan<4, 1>, gain: &SMatrix<f64, 1, 4>, feedback: bool) -> Result<Self> {
        let mut random = StdRng::seed_from_u64(1);
        let sensor = [1e-3, 2e-3, 2e-2, 2e-2].map(|deviation| Normal::new(0.0, deviation));
        let gust = Normal::new(0.0, 0.5)?;
        let start = State { q: vector![0.0, 0.0], p: vector![0.0, 0.0] };
        let mut plant = PLANT.driven([0.0]).by(Trapezoidal, H / 10.0).run_with_inputs(start);
        let mut clock = SensorClock::new(SENSORS[0], SENSORS[1]);
        let mut run = Self { states: vec![start], forces: Vec::new(), seconds: 0.0 };
        // What was measured last, and when: at first that it hangs at rest.
        let (mut measured, mut since, mut u) = ([0.0; 4], 0.0, vector![0.0]);
        for k in 0..PERIODS {
            let now = k as f64 * H;
            let stopwatch = Instant::now();
            let [x, angle, speed, rate] = measured;
            let then = control::vector::<2, 4>(&State::from_velocity(&PLANT, [x, angle], [speed, rate])?);
            let believed =
                if now > since { control::advance(&PLANT.driven(u), &then, now - since)? } else { then };
            u = match (k < SWING, feedback) {
                (true, true) => plan.inputs[k] + plan.gains[k] * (believed - plan.states[k]),
                (true, false) => plan.inputs[k],
                (false, true) => -gain * (believed - target()),
                (false, false) => vector![0.0],
            };
            run.seconds += stopwatch.elapsed().as_secs_f64();
            if let Some((_, push)) = PUSHES.iter().find(|(when, _)| *when == k) {
                let mut pushed = *plant.state();
                pushed.p[1] += push;
                plant.correct(pushed);
            }
            let driven = PLANT.driven([u[0] + gust.sample(&mut random)]);
            let mut period = plant.hold(&driven);
            for sample in period.sample_at(clock.times_before(now + H)) {
                let sample = sample?;
                // Positions and velocities, each with its error.
                let v = sample.state.velocity(&PLANT)?;
                (measured, since) = ([sample.state.q[0], sample.state.q[1], v[0], v[1]], sample.time);
                for (value, error) in measured.iter_mut().zip(sensor) {
                    *value += error?.sample(&mut random);
                }
            }
            while period.time() < now + 0.95 * H {
                period.next().context("a run goes on")??;
            }
            run.states.push(*plant.state());
            run.forces.push(u[0]);
        }
        Ok(run)
    }

    /// The largest angle from upright within some periods.
    pub fn largest_angle(&self, periods: std::ops::Range<usize>) -> f64 {
        self.states[periods].iter().fold(0.0, |largest, state| f64::max(largest, (state.q[1] - PI).abs()))
    }

    /// The largest distance of the cart from the middle within some periods.
    pub fn largest_offset(&self, periods: std::ops::Range<usize>) -> f64 {
        self.states[periods].iter().fold(0.0, |largest, state| f64::max(largest, state.q[0].abs()))
    }
}

/// Seconds of one step with its derivatives, over the steps of the plan.
fn seconds_of_linearisation(plan: &Plan<4, 1>) -> Result<f64> {
    let clock = Instant::now();
    for (x, u) in plan.states.iter().zip(&plan.inputs) {
        let step = control::linearised::<_, 2, 1, 4>(&PLANT.driven(*u), x, H);
        std::hint::black_box(step.context("the plan can be stepped")?);
    }
    Ok(clock.elapsed().as_secs_f64() / SWING as f64)
}

fn draw(plan: &Plan<4, 1>, run: &Run) -> Result<std::path::PathBuf> {
    let planned = |index: usize| -> Vec<_> {
        plan.states.iter().enumerate().map(|(k, x)| (k as f64 * H, x[index])).collect()
    };
    let moved = |index: usize| -> Vec<_> {
        run.states.iter().enumerate().map(|(k, state)| (k as f64 * H, state.q[index])).collect()
    };
    let pushes = |level: f64| {
        let points = PUSHES.iter().map(|(k, _)| (*k as f64 * H, level)).collect();
        Curve::marks("push", colour::RUNGE_KUTTA, Mark::Triangle, points)
    };
    let time = linear("time t (s)");
    let curves = |index: usize, pushed: f64| {
        vec![
            Curve::line("motion", colour::VARIATIONAL, 4, moved(index)),
            Curve::line("plan of the swing-up", colour::REFERENCE, 2, planned(index)).dashed(Dash::Dashed),
            pushes(pushed),
        ]
    };
    let forces = run.forces.iter().enumerate().map(|(k, u)| (k as f64 * H, *u)).collect();
    let close =
        moved(1).into_iter().skip(SWING + 50).map(|(t, angle)| (t, (angle - PI).to_degrees())).collect();
    let panels = [
        Panel::new("The pole is swung up, then held", time, linear("angle from below (rad)"), curves(1, PI)),
        Panel::new("The cart comes back after each push", time, linear("position (m)"), curves(0, 0.0)),
        Panel::new(
            "A push tilts the held pole by a few degrees",
            time,
            linear("angle from upright (°)"),
            vec![Curve::line("motion", colour::VARIATIONAL, 2, close), pushes(0.0)],
        ),
        Panel::new(
            "The swing-up takes the largest force",
            time,
            linear("force on the cart (N)"),
            vec![Curve::line("force", colour::VARIATIONAL, 1, forces), pushes(0.0)],
        ),
    ];
    picture::write("cart_pole", [1240, 1160], 2, &panels)
}
