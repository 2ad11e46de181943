//! How soon an arm settles when its friction and its payload are known roughly: twenty thousand arms, each
//! with a friction and a payload of its own, make the same move under the same controller. Percentiles of the
//! tip's height against time, and of the time to settle.
//!
//! The controller is a spring to the angles wanted, a damper, and the torque that holds the payload expected:
//! so it is part of L and R, and the arm ends where the spring holds the payload that it has. Both joints'
//! friction is lognormal, its logarithm with the standard deviation ln 2; the payload is uniform, 0 to 1 kg.
//! SI units; the seed is 7, with one stream of random numbers for each arm.
//!
//! ```text
//! cargo run --release --example settling -- [--members 20000] [picture.svg]
//! ```
//!
//! Heights are counted in bins of a millimetre, so that memory does not grow with the number of arms.

use std::f64::consts::{FRAC_PI_2, LN_2};
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, ensure};
use dalembert::{Midpoint, State, StepError, rayleigh_system};
use dalembert_ensemble::{Ensemble, Progress, Record};
use dalembert_examples::picture::{self, Curve, Dash, Panel, colour, linear};
use indicatif::ProgressBar;
use lexopt::Arg;
use nalgebra::SVector;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, LogNormal, Uniform};

/// Two uniform rods in a vertical plane, with a payload at the tip, a controller, and friction in the joints;
/// q is (angle of the first from the horizontal, angle of the second from the first).
pub struct Arm {
    /// Mass of the payload, kg.
    pub payload: f64,
    /// Friction of each joint, N m s.
    pub friction: [f64; 2],
    /// What the controller adds to spring and damper, N m.
    pub holding: [f64; 2],
}

/// Masses of the rods, kg.
pub const M: [f64; 2] = [1.0, 0.8];
/// Their lengths, m.
pub const L: [f64; 2] = [0.5, 0.4];
/// Acceleration of gravity, m/s².
pub const G: f64 = 9.81;
/// The angles wanted.
pub const WANTED: [f64; 2] = [0.6, 0.5];
/// Gains of the controller: N m, and N m s.
pub const STIFFNESS: [f64; 2] = [60.0, 25.0];
const DAMPING: [f64; 2] = [5.0, 1.5];
/// The payload that the controller expects, kg.
pub const EXPECTED: f64 = 0.5;
/// The largest, kg.
pub const LARGEST: f64 = 1.0;
/// The medians of the friction of both joints, N m s.
const FRICTION: [f64; 2] = [4.0, 1.2];

#[rayleigh_system]
impl Arm {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let ([m1, m2], [l1, l2]) = (M, L);
        let spin = v[0] + v[1];
        // Of the first rod, of what is carried at its end, of the second rod and the payload about that.
        let kinetic = m1 * l1 * l1 / 6.0 * v[0] * v[0]
            + 0.5 * (m2 + self.payload) * l1 * l1 * v[0] * v[0]
            + 0.5 * (m2 / 3.0 + self.payload) * l2 * l2 * spin * spin
            + (0.5 * m2 + self.payload) * l1 * l2 * q[1].cos() * v[0] * spin;
        let first = (0.5 * m1 + m2 + self.payload) * l1;
        let second = (0.5 * m2 + self.payload) * l2;
        let weight = G * (first * q[0].sin() + second * (q[0] + q[1]).sin());
        let a = q[0] - WANTED[0];
        let b = q[1] - WANTED[1];
        let spring = 0.5 * STIFFNESS[0] * a * a + 0.5 * STIFFNESS[1] * b * b;
        kinetic - weight - spring + self.holding[0] * q[0] + self.holding[1] * q[1]
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * (self.friction[0] + DAMPING[0]) * v[0] * v[0]
            + 0.5 * (self.friction[1] + DAMPING[1]) * v[1] * v[1]
    }
}

/// ∂weight/∂q with a payload: what holds the arm at rest.
pub fn holding(q: [f64; 2], payload: f64) -> [f64; 2] {
    let first = (0.5 * M[0] + M[1] + payload) * L[0] * q[0].cos();
    let second = (0.5 * M[1] + payload) * L[1] * (q[0] + q[1]).cos();
    [G * (first + second), G * second]
}

/// Where the tip is, m.
pub fn tip(q: [f64; 2]) -> SVector<f64, 2> {
    let (first, second) = (q[0], q[0] + q[1]);
    SVector::from([L[0] * first.cos() + L[1] * second.cos(), L[0] * first.sin() + L[1] * second.sin()])
}

const SEED: u64 = 7;
/// The step size, s.
const H: f64 = 5e-3;
/// Steps from one record to the next.
const STRIDE: u64 = 4;
/// Records after the start: 4 s.
pub const RECORDS: usize = 200;
/// An arm has settled when its tip stays this near to where it ends, m.
const SETTLED: f64 = 0.01;

fn main() -> Result<()> {
    let (members, picture) = arguments()?;
    let bar = ProgressBar::new(members);
    let begun = Instant::now();
    let study = study(members, &bar)?;
    bar.finish_and_clear();
    study.print(begun.elapsed());
    println!("\nPicture: {}", draw(&study, picture)?.display());
    Ok(())
}

fn arguments() -> Result<(u64, Option<PathBuf>)> {
    let (mut members, mut picture) = (20_000, None);
    let mut arguments = lexopt::Parser::from_env();
    while let Some(argument) = arguments.next()? {
        match argument {
            Arg::Long("members") => {
                let text = arguments.value()?.into_string().unwrap_or_default();
                members = text.parse().context("--members takes a number, such as 100000")?;
                ensure!(members > 0, "--members takes a number above 0");
            }
            Arg::Value(path) if picture.is_none() => picture = Some(PathBuf::from(path)),
            other => return Err(other.unexpected().into()),
        }
    }
    Ok((members, picture))
}

/// Arm `number`, hanging at rest.
pub fn member(number: u64) -> Result<(Arm, State<f64, 2>), StepError> {
    let mut random = ChaCha8Rng::seed_from_u64(SEED);
    random.set_stream(number);
    let payload = Uniform::new(0.0, LARGEST).expect("0 < LARGEST").sample(&mut random);
    let scatter = LogNormal::new(0.0, LN_2).expect("a finite deviation");
    let friction = FRICTION.map(|median| median * scatter.sample(&mut random));
    let arm = Arm { payload, friction, holding: holding(WANTED, EXPECTED) };
    let start = State::from_velocity(&arm, [-FRAC_PI_2, 0.0], [0.0, 0.0])?;
    Ok((arm, start))
}

/// How many values lie in each bin of equal width.
#[derive(Clone, Debug)]
pub struct Histogram {
    from: f64,
    width: f64,
    counts: Vec<u64>,
}

impl Histogram {
    /// Bins of `width` between two values.
    fn between(from: f64, to: f64, width: f64) -> Self {
        Self { from, width, counts: vec![0; ((to - from) / width).ceil() as usize] }
    }

    /// Counts a value; one outside, or NaN, in the bin nearest to it.
    fn add(&mut self, value: f64) {
        let bin = ((value - self.from) / self.width) as usize;
        let last = self.counts.len() - 1;
        self.counts[bin.min(last)] += 1;
    }

    /// The value that a `share` of all is below, as if a bin's values were spread evenly over it.
    pub fn percentile(&self, share: f64) -> f64 {
        let wanted = share * self.counts.iter().sum::<u64>() as f64;
        let mut below = 0.0;
        for (bin, &count) in self.counts.iter().enumerate() {
            let count = count as f64;
            if count > 0.0 && below + count >= wanted {
                return self.from + self.width * (bin as f64 + (wanted - below) / count);
            }
            below += count;
        }
        f64::NAN
    }
}

/// What is kept of all arms.
#[derive(Clone, Debug)]
pub struct Study {
    /// Heights of the tips at each record, m.
    pub heights: Vec<Histogram>,
    /// The records at which arms have settled.
    pub settled: Histogram,
    /// How far tips rise above their ends, m.
    pub overshoot: Histogram,
    /// How far tips move between the last two records, m.
    pub last_moves: Histogram,
    /// The number of arms.
    pub members: u64,
}

/// The times of the records, s.
pub fn time(record: usize) -> f64 {
    record as f64 * STRIDE as f64 * H
}

/// The arms by the variational midpoint rule.
pub fn study(members: u64, bar: &ProgressBar) -> Result<Study> {
    let reach = L[0] + L[1];
    let none = Study {
        heights: vec![Histogram::between(-reach, reach, 1e-3); RECORDS + 1],
        settled: Histogram::between(0.0, RECORDS as f64 + 1.0, 1.0),
        overshoot: Histogram::between(0.0, 2.0 * reach, 1e-3),
        last_moves: Histogram::between(0.0, 0.1, 1e-5),
        members: 0,
    };
    let runs =
        Ensemble::new(member).by(Midpoint, H).steps(STRIDE * RECORDS as u64).every(STRIDE).on_progress(
            |Progress { done, .. }| {
                bar.set_position(done);
                ControlFlow::Continue(())
            },
        );
    let study = runs.reduce(
        0..members,
        |_| Vec::with_capacity(RECORDS + 1),
        |tips, record: &Record<'_, Arm, 2>| tips.push(tip(record.state.q.into())),
        Ok(none),
        |study, outcome| match (outcome.failure, study) {
            (None, Ok(study)) => study.add(&outcome.value),
            (Some(failure), study @ Ok(_)) => *study = Err(failure),
            (_, Err(_)) => {}
        },
    )?;
    Ok(study?)
}

impl Study {
    /// Counts an arm by the places of its tip.
    fn add(&mut self, tips: &[SVector<f64, 2>]) {
        let end = tips[RECORDS];
        for (heights, tip) in self.heights.iter_mut().zip(tips) {
            heights.add(tip.y);
        }
        let highest = tips.iter().map(|tip| tip.y).fold(end.y, f64::max);
        self.overshoot.add(highest - end.y);
        let is_away = |tip: &SVector<f64, 2>| (tip - end).norm() > SETTLED;
        self.settled.add(tips.iter().rposition(is_away).map_or(0.0, |last| last as f64 + 1.0));
        self.last_moves.add((end - tips[RECORDS - 1]).norm());
        self.members += 1;
    }

    /// When a `share` of the arms has settled, s: the record from which they are seen to have.
    pub fn settling_time(&self, share: f64) -> f64 {
        time(self.settled.percentile(share).floor() as usize)
    }

    fn print(&self, run: Duration) {
        println!("{} arms, h = {H} s, payload 0 to {LARGEST} kg, friction × or ÷ 2.\n", self.members);
        println!("height of the tip, m     5 %     50 %     95 %   from 5 to 95 %");
        for record in (0..=RECORDS).step_by(RECORDS / 10) {
            let [low, middle, high] = SHARES.map(|share| self.heights[record].percentile(share));
            println!(
                "t = {:.1} s         {low:10.3} {middle:8.3} {high:8.3} {:16.3}",
                time(record),
                high - low
            );
        }
        let [early, middle, late] = SHARES.map(|share| self.settling_time(share));
        println!("\nsettled to 1 cm, s  {early:8.2} {middle:8.2} {late:8.2} {:16.2}", late - early);
        let [low, middle, high] = SHARES.map(|share| self.overshoot.percentile(share));
        println!("overshoot, m        {low:8.3} {middle:8.3} {high:8.3} {:16.3}", high - low);
        println!(
            "\nWanted is {:.3} m. In the last {:.0} ms 99 % of the tips move less than {:.2} mm.",
            tip(WANTED).y,
            1e3 * (time(1) - time(0)),
            1e3 * self.last_moves.percentile(0.99),
        );
        let seconds = run.as_secs_f64();
        println!(
            "{seconds:.1} s: {:.0} µs an arm, on all cores together.",
            1e6 * seconds / self.members as f64
        );
    }
}

/// What is shown of all.
const SHARES: [f64; 3] = [0.05, 0.5, 0.95];

/// Heights on the left, settling on the right.
fn draw(study: &Study, path: Option<PathBuf>) -> Result<PathBuf> {
    let at = |share: f64| {
        let heights = study.heights.iter().enumerate();
        heights.map(|(record, heights)| (time(record), heights.percentile(share))).collect::<Vec<_>>()
    };
    let between = |low, high| -> Vec<_> {
        at(low).into_iter().zip(at(high)).map(|((t, low), (_, high))| (t, [low, high])).collect()
    };
    let wanted = tip(WANTED).y;
    let heights = vec![
        Curve::band("5 to 95 % of the arms", colour::SIXTH, &between(0.05, 0.95)),
        Curve::band("25 to 75 %", colour::VARIATIONAL, &between(0.25, 0.75)),
        Curve::line("median", colour::REFERENCE, 2, at(0.5)),
        Curve::line("wanted", colour::RUNGE_KUTTA, 2, vec![(0.0, wanted), (time(RECORDS), wanted)])
            .dashed(Dash::Dashed),
    ];
    let mut settled = 0;
    let shares = study.settled.counts.iter().enumerate().map(|(record, count)| {
        settled += count;
        (time(record), 100.0 * settled as f64 / study.members as f64)
    });
    let shares = vec![Curve::line("", colour::VARIATIONAL, 3, shares.collect())];
    let settled = format!("Within 1 cm of its own end: 95 % by {:.1} s", study.settling_time(0.95));
    let panels = [
        Panel::new(
            "Unknown payloads leave tips centimetres off",
            linear("time t (s)"),
            linear("height of the tip (m)"),
            heights,
        ),
        Panel::new(&settled, linear("time t (s)"), linear("arms within 1 cm of their end (%)"), shares),
    ];
    picture::write_to(path, "settling", [1240, 560], 2, &panels)
}
