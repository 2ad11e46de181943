//! A million starts of the Hénon–Heiles system above its threshold: through which of the three openings of
//! the potential each leaves, and when. The boundary between the three is fractal, and common to all three
//! (the property of Wada). Three islands of regular motion stay inside.
//!
//! Starts lie in the plane of positions, with energy 1/5 and the velocity across the radius, anticlockwise
//! (Aguirre, Vallejo and Sanjuán, Wada basins and chaotic invariant sets in the Hénon–Heiles system, 2001).
//! Positions that the energy does not allow stay blank. A rotation by 120° turns potential and starts into
//! themselves and each opening into the next, so that the three shares are equal. Nothing is random. All
//! quantities are dimensionless.
//!
//! ```text
//! cargo run --release --example escape -- [--columns 1608] [picture.svg]
//! ```
//!
//! 1608 columns of pixels are a million members, 402 a sixteenth of that. They are stepped in lanes.

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, ensure};
use dalembert::nalgebra::{SVector, vector};
use dalembert::{Splitting, State, rayleigh_system};
use dalembert_ensemble::{Ensemble, Progress, Record};
use dalembert_examples::picture::{self, Axis, Panel, RGBColor, Raster, colour, linear};
use indicatif::ProgressBar;
use lexopt::Arg;

/// A star in a galaxy, with the potential ½|q|² + x²y − y³/3.
#[rayleigh_system(rule = trapezoidal, lanes = explicit)]
pub fn henon_heiles(q: [f64; 2], v: [f64; 2]) -> f64 {
    let [x, y] = q;
    0.5 * (v[0] * v[0] + v[1] * v[1]) - (0.5 * (x * x + y * y) + x * x * y - y * y * y / 3.0)
}

/// The energy of the starts. The openings are open above 1/6, the potential at its three saddles.
pub const ENERGY: f64 = 0.2;
/// The step size.
pub const H: f64 = 0.25;
/// Where a member that has not left is given up.
pub const END: f64 = 300.0;

/// The distance s from the centre, along an opening, from which a member that moves outwards has left.
///
/// Of its energy E ≤ 1/5 none turns back there: with w across the opening, V = ½s² − s³/3 + (½ + s) w² ≤ E
/// bounds w, and the force along it, s² − s − w², is positive where ⅔s³ − ½s > E. That is from s = 1.05 on;
/// the saddles are at s = 1.
pub const GONE: f64 = 1.1;

/// The part of the plane that the picture shows: x from and to, y from and to.
const SHOWN: [f64; 4] = [-1.05, 1.05, -0.7, 1.1];

/// The openings: what they are called, and which way they lead.
const OPENINGS: [(&str, [f64; 2]); 3] = [
    ("above", [0.0, 1.0]),
    ("on the right", [0.866_025_403_784_438_6, -0.5]),
    ("on the left", [-0.866_025_403_784_438_6, -0.5]),
];

/// The times that the picture tells apart, each up to the next.
const TIMES: [f64; 6] = [0.0, 5.0, 15.0, 30.0, 60.0, 120.0];

fn main() -> Result<()> {
    let (columns, picture) = arguments()?;
    let plane = Plane::new(columns, ENERGY);
    let bar = ProgressBar::new(plane.starts.len() as u64);
    let begun = Instant::now();
    let fates = fates(&plane, &bar)?;
    bar.finish_and_clear();
    print(&fates, begun.elapsed());
    println!("\nPicture: {}", draw(&plane, &fates, picture)?.display());
    Ok(())
}

fn arguments() -> Result<(usize, Option<PathBuf>)> {
    let (mut columns, mut picture) = (1608, None);
    let mut arguments = lexopt::Parser::from_env();
    while let Some(argument) = arguments.next()? {
        match argument {
            Arg::Long("columns") => {
                let text = arguments.value()?.into_string().unwrap_or_default();
                columns = text.parse().context("--columns takes a number of pixels, such as 400")?;
                ensure!((2..=20_000).contains(&columns), "--columns takes 2 to 20000 pixels, not {columns}");
            }
            Arg::Value(path) if picture.is_none() => picture = Some(PathBuf::from(path)),
            other => return Err(other.unexpected().into()),
        }
    }
    Ok((columns, picture))
}

/// How far along each opening a point lies.
pub fn along(q: &SVector<f64, 2>) -> [f64; 3] {
    OPENINGS.map(|(_, [x, y])| x * q[0] + y * q[1])
}

/// The opening through which a member in this state has left.
pub fn left_through(state: &State<f64, 2>) -> Option<usize> {
    let (place, speed) = (along(&state.q), along(&state.p));
    (0..3).find(|&k| place[k] > GONE && speed[k] > 0.0)
}

/// ½|q|² + x²y − y³/3.
fn potential([x, y]: [f64; 2]) -> f64 {
    0.5 * (x * x + y * y) + x * x * y - y * y * y / 3.0
}

/// The pixels of the plane, and the starts among them.
pub struct Plane {
    columns: usize,
    rows: usize,
    /// The pixel of each start, row by row from above.
    starts: Vec<usize>,
    energy: f64,
}

impl Plane {
    /// As many columns of pixels as said; starts are those inside that the energy allows.
    pub fn new(columns: usize, energy: f64) -> Self {
        let [left, right, below, above] = SHOWN;
        let rows = ((above - below) / (right - left) * columns as f64).round() as usize;
        let mut plane = Self { columns, rows, starts: Vec::new(), energy };
        let is_inside = |&pixel: &usize| {
            let q = plane.place(pixel);
            potential(q) < energy && q != [0.0; 2] && along(&q.into()).iter().all(|&s| s < GONE)
        };
        plane.starts = (0..columns * rows).filter(is_inside).collect();
        plane
    }

    /// How many starts there are.
    pub fn members(&self) -> u64 {
        self.starts.len() as u64
    }

    /// The middle of a pixel.
    fn place(&self, pixel: usize) -> [f64; 2] {
        let [left, right, below, above] = SHOWN;
        let share = |index: usize, of: usize| (index as f64 + 0.5) / of as f64;
        let (column, row) = (pixel % self.columns, pixel / self.columns);
        [left + (right - left) * share(column, self.columns), above - (above - below) * share(row, self.rows)]
    }

    /// Start `number`: across the radius, with the speed that the energy leaves.
    pub fn start(&self, number: u64) -> State<f64, 2> {
        let [x, y] = self.place(self.starts[number as usize]);
        let rate = (2.0 * (self.energy - potential([x, y]))).sqrt() / x.hypot(y);
        // The mass is 1.
        State { q: vector![x, y], p: rate * vector![-y, x] }
    }
}

/// What became of a member.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fate {
    /// The opening through which it left, if it did.
    pub opening: Option<usize>,
    /// When it was first seen to have left, or the end.
    pub time: f64,
    /// The largest change of its energy until then.
    pub energy_error: f64,
}

/// What becomes of each start.
pub fn fates(plane: &Plane, bar: &ProgressBar) -> Result<Vec<Fate>> {
    let observe = |fate: &mut Fate, record: &Record<'_, HenonHeiles, 2>| {
        let State { q, p } = &record.state;
        let energy = 0.5 * p.norm_squared() + potential((*q).into());
        *fate = Fate {
            opening: left_through(&record.state),
            time: record.time,
            energy_error: fate.energy_error.max((energy - plane.energy).abs()),
        };
    };
    let study = Ensemble::new(|number| Ok((HenonHeiles {}, plane.start(number))))
        .by(Splitting::blanes_moan_6(), H)
        .steps((END / H) as u64)
        .every(1)
        .in_lanes()
        .stop_when(|record| left_through(&record.state).is_some())
        .on_progress(|Progress { done, .. }| {
            bar.set_position(done);
            ControlFlow::Continue(())
        });
    let fates = study.reduce(
        0..plane.members(),
        |_| Fate { opening: None, time: 0.0, energy_error: 0.0 },
        observe,
        Ok(Vec::with_capacity(plane.starts.len())),
        |fates, outcome| match (outcome.failure, fates) {
            (None, Ok(fates)) => fates.push(outcome.value),
            (Some(failure), fates @ Ok(_)) => *fates = Err(failure),
            (_, Err(_)) => {}
        },
    )?;
    Ok(fates?)
}

/// How many members left through each opening.
pub fn left(fates: &[Fate]) -> [usize; 3] {
    [0, 1, 2].map(|k| fates.iter().filter(|fate| fate.opening == Some(k)).count())
}

fn print(fates: &[Fate], run: Duration) {
    let members = fates.len() as f64;
    println!("Hénon–Heiles, {members} members, E = {ENERGY}, h = {H}; all is dimensionless.\n");
    println!("left                  members    share, %   median time");
    let left = left(fates);
    for (k, ((name, _), left)) in OPENINGS.into_iter().zip(left).enumerate() {
        let mut times: Vec<f64> =
            fates.iter().filter(|fate| fate.opening == Some(k)).map(|fate| fate.time).collect();
        times.sort_by(f64::total_cmp);
        let median = times.get(times.len() / 2).copied().unwrap_or(f64::NAN);
        println!("{name:20} {left:8} {:11.3} {median:13.2}", 100.0 * left as f64 / members);
    }
    let all: usize = left.iter().sum();
    let inside = fates.len() - all;
    println!("{:20} {inside:8} {:11.3}", format!("inside at t = {END}"), 100.0 * inside as f64 / members);
    let expected = all as f64 / 3.0;
    let worst = left.iter().map(|&left| (left as f64 - expected).abs()).fold(0.0, f64::max);
    println!(
        "\nBy symmetry the three are equal. They differ from a third of all by {worst:.0} members at most: a grid of\n\
         squares does not turn into itself, and next to the boundary it samples at random. If all members were\n\
         drawn at random, the standard deviation would be {:.0}.",
        (2.0 / 3.0 * expected).sqrt(),
    );
    let energy_error = fates.iter().map(|fate| fate.energy_error).fold(0.0, f64::max);
    println!("The largest change of energy of any member on its way: {energy_error:.1e}.");
    let seconds = run.as_secs_f64();
    println!("{seconds:.1} s: {:.1} µs a member, on all cores together.", 1e6 * seconds / members);
}

/// On the left the openings, on the right the times.
fn draw(plane: &Plane, fates: &[Fate], path: Option<PathBuf>) -> Result<PathBuf> {
    let [left, right, below, above] = SHOWN;
    let panel = |title, classes: &[(&'static str, RGBColor)], class: &dyn Fn(&Fate) -> usize| {
        let mut pixels = vec![None; plane.columns * plane.rows];
        for (&pixel, fate) in plane.starts.iter().zip(fates) {
            pixels[pixel] = Some(class(fate) as u8);
        }
        let raster = Raster { columns: plane.columns, x: [left, right], y: [below, above], pixels };
        let axis = |label: &'static str| -> Axis<'static> { linear(label) };
        Panel::of_raster(title, axis("x (dimensionless)"), axis("y (dimensionless)"), raster, classes)
            .to_equal_scale()
    };
    let openings = panel(
        "Hénon–Heiles: three basins, one fractal boundary",
        &[
            ("above", colour::VARIATIONAL),
            ("on the right", colour::FIFTH),
            ("on the left", colour::SEVENTH),
            ("not by t = 300", colour::REFERENCE),
        ],
        &|fate| fate.opening.unwrap_or(3),
    );
    let times = panel(
        "Near the boundary stars stay for long",
        // Even steps of lightness and a change of hue, for readers with any colour vision and in grey
        // (viridis; van der Walt and Smith, 2015).
        &[
            ("t < 5", RGBColor(253, 231, 37)),
            ("5 … 15", RGBColor(122, 209, 81)),
            ("15 … 30", RGBColor(34, 168, 132)),
            ("30 … 60", RGBColor(42, 120, 142)),
            ("60 … 120", RGBColor(65, 68, 135)),
            ("120 … 300", RGBColor(68, 1, 84)),
            ("not by t = 300", colour::REFERENCE),
        ],
        &|fate| match fate.opening {
            Some(_) => TIMES.iter().rposition(|&from| fate.time >= from).unwrap_or(0),
            None => TIMES.len(),
        },
    );
    picture::write_to(path, "escape", [1240, 640], 2, &[openings, times])
}
