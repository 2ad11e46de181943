//! A block on a belt, held back by a spring: it sticks to the belt until the spring pulls by more than the
//! friction at rest, slips back, and sticks again. From rest and from a push it comes to one limit cycle.
//! SI units.
//!
//! Friction falls with the velocity w over the belt, F(w) = F_c + (F_s − F_c) exp(−(w/w_s)²) (Stribeck). R is
//! its integral, with a kink where w is 0: `rule = proximal` takes it as it stands. Beside it friction with
//! the kink rounded off, F(w) tanh(w/ε): what should stand creeps, however small ε is.
//!
//! ```text
//! cargo run --release --example stick_slip [picture.svg]
//! ```

use std::path::PathBuf;

use anyhow::{Context, Result};
use dalembert::step::Flow;
use dalembert::system::{self, Curve as _};
use dalembert::{Discretise, Lagrangian, Midpoint, Proximal, State, StepError, rayleigh_system};
use dalembert_examples::picture::{self, Curve, Dash, Panel, colour, linear};

/// F(w), as the derivative of its integral over w ≥ 0.
#[derive(Clone, Copy)]
pub struct Stribeck {
    /// At rest, N.
    pub at_rest: f64,
    /// Of fast sliding, N.
    pub sliding: f64,
    /// The velocity by which it falls, m/s.
    pub width: f64,
}

/// That of the scene: 6 N fall to 3 N within some 5 cm/s.
pub const FRICTION: Stribeck = Stribeck { at_rest: 6.0, sliding: 3.0, width: 0.05 };

impl system::Curve<f64> for Stribeck {
    fn derivatives(&self, w: f64) -> [f64; 4] {
        let (x, fall) = (w / self.width, self.at_rest - self.sliding);
        let bell = fall * (-x * x).exp();
        let half_root_of_pi = 0.5 * std::f64::consts::PI.sqrt();
        [
            self.sliding * w + fall * self.width * half_root_of_pi * libm::erf(x),
            self.sliding + bell,
            -2.0 * x * bell / self.width,
            (4.0 * x * x - 2.0) * bell / (self.width * self.width),
        ]
    }
}

/// Mass of the block, kg, and stiffness of the spring, N/m.
pub const MASS: f64 = 1.0;
/// Stiffness of the spring, N/m.
pub const STIFFNESS: f64 = 100.0;

/// The block; q is how far the spring is stretched.
pub struct Block {
    /// Friction between block and belt.
    pub friction: Stribeck,
    /// Speed of the belt, m/s.
    pub belt: f64,
    /// A weight that pulls, N.
    pub load: f64,
    /// Stiffness of the spring, N/m.
    pub k: f64,
}

#[rayleigh_system(rule = proximal)]
impl Block {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * MASS * v[0] * v[0] - 0.5 * self.k * q[0] * q[0] + self.load * q[0]
    }

    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        self.friction.at((v[0] - self.belt).abs())
    }
}

/// The block with the kink rounded off.
pub struct Rounded {
    /// All but the kink.
    pub block: Block,
    /// The velocity within which friction turns, m/s.
    pub epsilon: f64,
}

#[rayleigh_system(rule = midpoint)]
impl Rounded {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * MASS * v[0] * v[0] - 0.5 * self.block.k * q[0] * q[0] + self.block.load * q[0]
    }

    fn force(&self, _q: [f64; 1], v: [f64; 1]) -> [f64; 1] {
        let w = v[0] - self.block.belt;
        let x = w / self.block.friction.width;
        let friction = &self.block.friction;
        let size = friction.sliding + (friction.at_rest - friction.sliding) * (-x * x).exp();
        [-size * (w / self.epsilon).tanh()]
    }
}

/// The step size, s, and the time, s.
pub const H: f64 = 1e-3;
/// The time on the belt, s.
pub const END: f64 = 6.0;
/// Speed of the belt, m/s.
pub const BELT: f64 = 0.1;
/// A weight below the friction at rest, N, on a belt that stands.
pub const LOAD: f64 = 5.0;
/// How long it hangs, s.
pub const HANGS: f64 = 60.0;
/// Widths of the rounded kink, m/s.
pub const EPSILONS: [f64; 2] = [1e-3, 1e-4];

/// The block on the belt: times, stretch and velocity, from a stretch and a velocity.
///
/// # Errors
/// Those of steps.
pub fn on_the_belt(start: [f64; 2], h: f64, time: f64) -> Result<Vec<(f64, f64, f64)>, StepError> {
    let block = Block { friction: FRICTION, belt: BELT, load: 0.0, k: STIFFNESS };
    let start = State::from_velocity(&block, [start[0]], [start[1]])?;
    let steps = block.by(Proximal, h).run(start).take((time / h).round() as usize);
    let mut points = vec![(0.0, start.q[0], start.p[0] / MASS)];
    for (k, step) in steps.enumerate() {
        let state = step?.state;
        points.push(((k + 1) as f64 * h, state.q[0], state.p[0] / MASS));
    }
    Ok(points)
}

/// Times at which the block breaks loose, where the spring pulls by the friction at rest.
pub fn slips(points: &[(f64, f64, f64)]) -> Vec<f64> {
    let sticks = |point: &(f64, f64, f64)| point.2 == BELT;
    points.windows(2).filter(|pair| sticks(&pair[0]) && !sticks(&pair[1])).map(|pair| pair[0].0).collect()
}

/// How far a block on a belt that stands has moved under [`LOAD`] at `time`: held by friction as it is, and
/// with its kink rounded off.
///
/// # Errors
/// Those of steps.
pub fn hanging(h: f64, time: f64) -> Result<[Vec<(f64, f64)>; 3], StepError> {
    let block = || Block { friction: FRICTION, belt: 0.0, load: LOAD, k: 0.0 };
    let steps = (time / h).round() as u64;
    let [wide, narrow] =
        EPSILONS.map(|epsilon| moved(&Rounded { block: block(), epsilon }, Midpoint, h, steps));
    Ok([moved(&block(), Proximal, h, steps)?, wide?, narrow?])
}

/// Times and places from rest, a hundred of them.
fn moved<L, M: Copy>(system: &L, method: M, h: f64, steps: u64) -> Result<Vec<(f64, f64)>, StepError>
where
    L: Lagrangian<1, Scalar = f64> + Flow<M, 1>,
{
    let start = State { q: [0.0].into(), p: [0.0].into() };
    let mut run = system.by(method, h).run(start);
    let samples = run.sample_every((steps / 100).max(1)).take(100);
    samples.map(|sample| sample.map(|at| (at.time, at.state.q[0]))).collect()
}

fn main() -> Result<()> {
    let cycle = on_the_belt([0.0, 0.0], H, END)?;
    let pushed = on_the_belt([0.02, 0.5], H, END)?;
    let loose = slips(&cycle);
    let period = loose.windows(2).last().context("two slips")?;
    println!(
        "From rest the block breaks loose at {:.3} s, then every {:.4} s.",
        loose[0],
        period[1] - period[0]
    );
    let pushed_period = slips(&pushed).windows(2).last().map(|pair| pair[1] - pair[0]);
    println!("Pushed it comes to the same cycle: every {:.4} s.", pushed_period.context("two slips")?);
    let stretch = |from: &[(f64, f64, f64)]| {
        let late = from.iter().filter(|point| point.0 > 3.0).map(|point| point.1);
        late.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], q| [low.min(q), high.max(q)])
    };
    let [low, high] = stretch(&cycle);
    println!("The spring is stretched by {:.4} to {:.4} m.\n", low, high);

    let hung = hanging(H, HANGS)?;
    println!(
        "A belt that stands, a load of {LOAD} N below the friction of {} N, after {HANGS} s:",
        FRICTION.at_rest
    );
    for (name, moved) in
        ["friction as it is", "tanh(w/ε), ε = 1e-3 m/s", "tanh(w/ε), ε = 1e-4 m/s"].iter().zip(&hung)
    {
        println!("{name:26} moved by {:8.1e} m", moved.last().context("a run")?.1);
    }
    println!("\nPicture: {}", draw(&cycle, &pushed, &hung)?.display());
    Ok(())
}

fn draw(
    cycle: &[(f64, f64, f64)],
    pushed: &[(f64, f64, f64)],
    hung: &[Vec<(f64, f64)>; 3],
) -> Result<PathBuf> {
    let portrait = |points: &[(f64, f64, f64)]| points.iter().map(|&(_, q, v)| (q, v)).collect::<Vec<_>>();
    let span = |points: &[(f64, f64, f64)]| {
        let places = points.iter().map(|point| point.1);
        places.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], q| [low.min(q), high.max(q)])
    };
    let [low, high] = span(pushed);
    let phases = vec![
        Curve::line("from rest", colour::VARIATIONAL, 3, portrait(cycle)),
        Curve::line("pushed", colour::RUNGE_KUTTA, 2, portrait(pushed)).dashed(Dash::Dashed),
        Curve::line("speed of the belt", colour::GREY, 2, vec![(low, BELT), (high, BELT)])
            .dashed(Dash::Dotted),
    ];
    let over_time = |points: &[(f64, f64, f64)]| points.iter().map(|&(t, q, _)| (t, q)).collect::<Vec<_>>();
    let stretch = vec![
        Curve::line("from rest", colour::VARIATIONAL, 3, over_time(cycle)),
        Curve::line("pushed", colour::RUNGE_KUTTA, 2, over_time(pushed)).dashed(Dash::Dashed),
        Curve::line(
            "F_s/k",
            colour::GREY,
            2,
            vec![(0.0, FRICTION.at_rest / STIFFNESS), (END, FRICTION.at_rest / STIFFNESS)],
        )
        .dashed(Dash::Dotted),
    ];
    let [held, wide, narrow] = hung;
    let millimetres = |moved: &[(f64, f64)]| moved.iter().map(|&(t, q)| (t, 1e3 * q)).collect::<Vec<_>>();
    let creeping = vec![
        Curve::line("tanh(w/ε), ε = 1 mm/s", colour::RUNGE_KUTTA, 3, millimetres(wide)).dashed(Dash::Dashed),
        Curve::line("tanh(w/ε), ε = 0.1 mm/s", colour::EULER, 3, millimetres(narrow))
            .dashed(Dash::DashDotted),
        Curve::line("friction with its kink", colour::VARIATIONAL, 3, millimetres(held)),
    ];
    let panels = [
        Panel::new(
            "Stick and slip: both starts reach one limit cycle",
            linear("stretch of the spring (m)"),
            linear("velocity of the block (m/s)"),
            phases,
        ),
        Panel::new(
            "It sticks until the spring pulls by F_s",
            linear("time t (s)"),
            linear("stretch of the spring (m)"),
            stretch,
        ),
        Panel::new(
            "A load below the friction: the block stands, rounded it creeps",
            linear("time t (s)"),
            linear("moved (mm)"),
            creeping,
        ),
    ];
    picture::write("stick_slip", [1000, 1500], 1, &panels)
}
