//! Poincaré sections of the Hénon–Heiles system at three energies: where orbits pass the plane x = 0 with ẋ >
//! 0, in y and its momentum. At 1/12 all lie on curves; at 1/8 a sea of chaos surrounds islands; at 1/6,
//! where the potential opens, little but the sea is left (M. Hénon and C. Heiles, Astron. J. 69, 1964).
//!
//! 144 000 crossings, each a root of x along the run to rounding. An orbit is chaotic if a tangent carried
//! along it grows exponentially. All quantities are dimensionless; nothing is random.
//!
//! ```text
//! cargo run --release --example poincare -- [--crossings 1500] [picture.svg]
//! ```

use std::path::PathBuf;
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, ensure};
use dalembert::nalgebra::{SVector, vector};
use dalembert::run::events::{Crossing, Watched};
use dalembert::{Discretise, Gauss, Splitting, State, rayleigh_system};
use dalembert_examples::picture::{self, Panel, RGBColor, Raster, colour, linear};
use lexopt::Arg;

/// A star in a galaxy, with the potential ½|q|² + x²y − y³/3.
#[rayleigh_system(rule = [trapezoidal, gauss])]
pub fn henon_heiles(q: [f64; 2], v: [f64; 2]) -> f64 {
    let [x, y] = q;
    0.5 * (v[0] * v[0] + v[1] * v[1]) - (0.5 * (x * x + y * y) + x * x * y - y * y * y / 3.0)
}

/// The energies, and what they are called.
pub const ENERGIES: [(&str, f64); 3] = [("1/12", 1.0 / 12.0), ("1/8", 1.0 / 8.0), ("1/6", 1.0 / 6.0)];
/// The step size.
pub const H: f64 = 0.25;
/// Orbits of each energy.
pub const ORBITS: usize = 32;
/// The logarithm of a tangent's growth from which an orbit is chaotic. On a curve the tangent grows as the
/// time, and its logarithm comes to some 10, next to a separatrix to some 40.
const GROWTH: f64 = 60.0;

/// What is seen of one orbit.
pub struct Orbit {
    /// (y, p_y) at its crossings.
    pub points: Vec<[f64; 2]>,
    /// The largest change of the energy at a crossing, and the largest |x| there.
    pub off: [f64; 2],
    /// The logarithm of a tangent's growth.
    pub growth: f64,
}

impl Orbit {
    /// Whether it is chaotic.
    pub fn is_chaotic(&self) -> bool {
        self.growth > GROWTH
    }
}

fn main() -> Result<()> {
    let (crossings, path) = arguments()?;
    let begun = Instant::now();
    let sections: Vec<Vec<Orbit>> =
        ENERGIES.iter().map(|&(_, energy)| section(energy, crossings)).collect::<Result<_>>()?;
    print(&sections, begun.elapsed());
    println!("\nPicture: {}", draw(&sections, path)?.display());
    Ok(())
}

fn arguments() -> Result<(usize, Option<PathBuf>)> {
    let (mut crossings, mut picture) = (1500, None);
    let mut arguments = lexopt::Parser::from_env();
    while let Some(argument) = arguments.next()? {
        match argument {
            Arg::Long("crossings") => {
                let text = arguments.value()?.into_string().unwrap_or_default();
                crossings = text.parse().context("--crossings takes a number, such as 5000")?;
                ensure!(crossings > 0, "--crossings takes a number above 0");
            }
            Arg::Value(path) if picture.is_none() => picture = Some(PathBuf::from(path)),
            other => return Err(other.unexpected().into()),
        }
    }
    Ok((crossings, picture))
}

/// p_x² on the plane x = 0, at y and p_y: negative where the energy does not reach.
fn reach(energy: f64, y: f64, p: f64) -> f64 {
    2.0 * energy - p * p - y * y + 2.0 / 3.0 * y * y * y
}

/// The ends of the interval of y that the energy reaches at rest.
fn interval(energy: f64) -> [f64; 2] {
    [-1.0, 1.0].map(|outer| {
        let (mut inside, mut outside) = (0.0, outer);
        for _ in 0..60 {
            let middle = 0.5 * (inside + outside);
            *(if reach(energy, middle, 0.0) > 0.0 { &mut inside } else { &mut outside }) = middle;
        }
        inside
    })
}

/// The starts of an energy: on the axis p_y = 0, and on y = 0 with p_y of both signs, which the system
/// mirrors.
pub fn starts(energy: f64) -> Vec<State<f64, 2>> {
    let [low, high] = interval(energy);
    let on_axis = ORBITS / 2;
    (0..ORBITS)
        .map(|number| {
            let [y, p] = if number < on_axis {
                [low + (high - low) * (number as f64 + 0.5) / on_axis as f64, 0.0]
            } else {
                let share = ((number - on_axis) as f64 + 0.5) / (ORBITS - on_axis) as f64;
                [0.0, (2.0 * share - 1.0) * (2.0 * energy).sqrt()]
            };
            State { q: vector![0.0, y], p: vector![reach(energy, y, p).sqrt(), p] }
        })
        .collect()
}

/// The orbits of an energy, on all cores.
pub fn section(energy: f64, crossings: usize) -> Result<Vec<Orbit>> {
    let starts = starts(energy);
    let threads = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        let chunks = starts.chunks(starts.len().div_ceil(threads));
        let workers: Vec<_> = chunks
            .map(|chunk| {
                scope.spawn(move || {
                    chunk.iter().map(|start| orbit(start, crossings)).collect::<Result<Vec<_>>>()
                })
            })
            .collect();
        let mut orbits = Vec::new();
        for worker in workers {
            orbits.extend(worker.join().expect("no orbit panics")?);
        }
        Ok(orbits)
    })
}

/// The crossings of one orbit, with its tangent.
pub fn orbit(start: &State<f64, 2>, crossings: usize) -> Result<Orbit> {
    let system = HenonHeiles {};
    let energy = start.energy(&system)?;
    let tangent_steps = system.by(Splitting::blanes_moan_6(), H);
    let mut run = system.by(Gauss::<8>, H).run(*start);
    let mut watch = run.watch(|at| [at.q[0]]).crossing([Crossing::Rising]);
    let mut orbit = Orbit { points: Vec::with_capacity(crossings), off: [0.0; 2], growth: 0.0 };
    let (mut state, mut tangent) = (*start, SVector::<f64, 4>::new(1.0, 0.7, -0.4, 0.2).normalize());
    while orbit.points.len() < crossings {
        match watch.advance().context("a run without end")?? {
            Watched::Event(event) => {
                let State { q, p } = event.state;
                orbit.points.push([q[1], p[1]]);
                let change = (event.state.energy(&system)? - energy).abs();
                orbit.off = [orbit.off[0].max(change), orbit.off[1].max(q[0].abs())];
            }
            Watched::Step(step) => {
                let (_, a) = tangent_steps.linearized_step(&state)?;
                let carried = a.assembled::<4>() * tangent;
                orbit.growth += carried.norm().ln();
                tangent = carried.normalize();
                state = step.state;
            }
        }
    }
    Ok(orbit)
}

fn print(sections: &[Vec<Orbit>], elapsed: Duration) {
    println!("{ORBITS} orbits of each energy by Gauss<8>, h = {H}.\n");
    println!("energy   crossings   chaotic orbits   largest change of the energy   largest |x|");
    for ((name, _), orbits) in ENERGIES.iter().zip(sections) {
        let crossings: usize = orbits.iter().map(|orbit| orbit.points.len()).sum();
        let chaotic = orbits.iter().filter(|orbit| orbit.is_chaotic()).count();
        let largest = |k: usize| orbits.iter().map(|orbit| orbit.off[k]).fold(0.0, f64::max);
        println!("{name:>6} {crossings:>11} {chaotic:>16} {:>30.1e} {:>13.1e}", largest(0), largest(1));
    }
    println!("\n{:.1} s with the tangents, on all cores.", elapsed.as_secs_f64());
}

/// What the plane shows: y from and to, p_y from and to.
const SHOWN: [f64; 4] = [-0.6, 1.05, -0.62, 0.62];
/// Pixels across.
const COLUMNS: usize = 1120;

/// One panel for each energy.
fn draw(sections: &[Vec<Orbit>], path: Option<PathBuf>) -> Result<PathBuf> {
    let classes: [(&str, RGBColor); 3] = [
        ("orbits on curves", colour::VARIATIONAL),
        ("chaotic orbits", colour::RUNGE_KUTTA),
        ("as far as the energy reaches", colour::REFERENCE),
    ];
    let titles = [
        "E = 1/12: all orbits lie on curves",
        "E = 1/8: chaos surrounds islands of regular motion",
        "E = 1/6, that of escape: chaos, and islands (white where no orbit starts)",
    ];
    let panels: Vec<Panel<'_>> = (sections.iter().zip(ENERGIES).zip(titles))
        .map(|((orbits, (_, energy)), title)| {
            let (y, p) =
                (linear("y at x = 0, ẋ > 0 (dimensionless)"), linear("momentum of y (dimensionless)"));
            Panel::of_raster(title, y, p, raster(orbits, energy), &classes).to_equal_scale()
        })
        .collect();
    picture::write_to(path, "poincare", [1000, 2340], 1, &panels)
}

/// A pixel where an orbit passes, the chaotic ones below; and where the energy ends.
fn raster(orbits: &[Orbit], energy: f64) -> Raster {
    let [left, right, low, high] = SHOWN;
    let scale = COLUMNS as f64 / (right - left);
    let rows = ((high - low) * scale).round() as usize;
    let mut pixels = vec![None; rows * COLUMNS];
    let mut set = |[y, p]: [f64; 2], class: u8| {
        let (column, row) = (((y - left) * scale) as usize, ((high - p) * scale) as usize);
        if y > left && p < high && column < COLUMNS && row < rows {
            pixels[row * COLUMNS + column] = Some(class);
        }
    };
    for chaotic in [true, false] {
        for orbit in orbits.iter().filter(|orbit| orbit.is_chaotic() == chaotic) {
            for &[y, p] in &orbit.points {
                // Two pixels wide and high: points, not dust.
                for [dy, dp] in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]] {
                    set([y + dy / scale, p + dp / scale], u8::from(chaotic));
                }
            }
        }
    }
    let [from, to] = interval(energy);
    for k in 0..=20_000 {
        // Denser at the ends, where the limit is steep.
        let y =
            0.5 * (from + to) - 0.5 * (to - from) * (f64::from(k) / 20_000.0 * std::f64::consts::PI).cos();
        let p = reach(energy, y, 0.0).max(0.0).sqrt();
        for p in [p, -p] {
            set([y, p], 2);
            set([y, p + 1.0 / scale], 2);
        }
    }
    Raster { columns: COLUMNS, x: [left, right], y: [high - rows as f64 / scale, high], pixels }
}
