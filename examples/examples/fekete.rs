//! Twenty points on a sphere that repel each other, with drag, from rest to rest: Fekete's points. In
//! coordinates of space they are 60, held by 20 constraints |q|² = 1. Two points at the distance r repel each
//! other by 1/r.
//!
//! It is the problem "fekete" of the Test Set for Initial Value Problem Solvers (Mazzia and Magherini, Bari),
//! with its start. At t = 150 the points are at rest to rounding; the test set ends at t = 1000, which is ten
//! thousand steps. All quantities are dimensionless.
//!
//! ```text
//! cargo run --release --example fekete -- [--time 200] [picture.svg]
//! ```

use std::f64::consts::PI;
use std::iter;
use std::path::PathBuf;

use anyhow::{Context, Result, ensure};
use dalembert::nalgebra::{SVector, Vector3};
use dalembert::{Discretise, Midpoint, State, rayleigh_system};
use dalembert_examples::picture::{self, Curve, Mark, Panel, colour, linear, logarithmic};
use lexopt::Arg;

/// The number of points.
pub const POINTS: usize = 20;
/// Three coordinates for each.
pub const N: usize = 3 * POINTS;

/// Points of unit mass on the unit sphere.
pub struct Fekete {
    /// The drag on each.
    pub drag: f64,
}

#[rayleigh_system]
impl Fekete {
    fn lagrangian(&self, q: [f64; 60], v: [f64; 60]) -> f64 {
        let mut sum = 0.0;
        for i in 0..20 {
            sum += 0.5 * self.square([v[3 * i], v[3 * i + 1], v[3 * i + 2]]);
            for j in 0..i {
                let between = [q[3 * i] - q[3 * j], q[3 * i + 1] - q[3 * j + 1], q[3 * i + 2] - q[3 * j + 2]];
                sum += 0.5 * self.square(between).ln();
            }
        }
        sum
    }

    fn rayleigh(&self, v: [f64; 60]) -> f64 {
        let mut sum = 0.0;
        for rate in v {
            sum += 0.5 * self.drag * rate * rate;
        }
        sum
    }

    fn constraints(&self, q: [f64; 60]) -> [f64; 20] {
        let mut off = [0.0; 20];
        for i in 0..20 {
            off[i] = 0.5 * (self.square([q[3 * i], q[3 * i + 1], q[3 * i + 2]]) - 1.0);
        }
        off
    }

    fn square(&self, x: [f64; 3]) -> f64 {
        x[0] * x[0] + x[1] * x[1] + x[2] * x[2]
    }
}

/// The drag of the test set.
pub const DRAG: f64 = 0.5;
/// The step size.
const H: f64 = 0.1;

/// The start of the test set: rings of 3, 7, 6 and 4 points, at rest.
pub fn start() -> SVector<f64, N> {
    // Turn and latitude of each ring, and the number of its first point.
    let rings = [
        (3, 1, PI / 13.0, 3.0 * PI / 8.0),
        (7, 1, PI / 29.0, PI / 8.0),
        (6, 1, PI / 7.0, -2.0 * PI / 15.0),
        (4, 0, PI / 17.0, -3.0 * PI / 10.0),
    ];
    let points = rings.into_iter().flat_map(|(count, first, turn, latitude)| {
        (first..first + count).map(move |k| {
            let longitude = 2.0 * PI * f64::from(k) / f64::from(count) + turn;
            [longitude.cos() * latitude.cos(), longitude.sin() * latitude.cos(), latitude.sin()]
        })
    });
    SVector::from_iterator(points.flatten())
}

/// Point `i`.
pub fn point(q: &SVector<f64, N>, i: usize) -> Vector3<f64> {
    Vector3::new(q[3 * i], q[3 * i + 1], q[3 * i + 2])
}

/// The points at one time.
#[derive(Clone, Copy)]
pub struct Moment {
    /// The time.
    pub time: f64,
    /// The state.
    pub state: State<f64, N>,
    /// The energy.
    pub energy: f64,
    /// By how much it has grown in the step that led here.
    pub growth: f64,
    /// The largest ||q|² − 1|.
    pub off: f64,
}

/// The motion to `time` in steps of `h`.
///
/// # Errors
/// Those of steps.
pub fn motion(h: f64, time: f64) -> Result<Vec<Moment>> {
    let system = Fekete { drag: DRAG };
    let state = State::from_velocity(&system, start(), [0.0; N])?;
    let off = |state: &State<f64, N>| {
        (0..POINTS).map(|i| (point(&state.q, i).norm_squared() - 1.0).abs()).fold(0.0, f64::max)
    };
    let energy = state.energy(&system)?;
    let mut moments = vec![Moment { time: 0.0, state, energy, growth: f64::NEG_INFINITY, off: off(&state) }];
    let mut before = state;
    for (k, step) in system.by(Midpoint, h).run(state).take((time / h).round() as usize).enumerate() {
        let state = step?.state;
        moments.push(Moment {
            time: (k + 1) as f64 * h,
            state,
            energy: state.energy(&system)?,
            growth: growth(&before, &state),
            off: off(&state),
        });
        before = state;
    }
    Ok(moments)
}

/// How much the energy grows from one state to the next, pair by pair: 190 logarithms, added up and then
/// subtracted, would leave their rounding, ten times what a step at rest does. Each point counts as on the
/// sphere that is off it by rounding.
fn growth(from: &State<f64, N>, to: &State<f64, N>) -> f64 {
    let mut sum = 0.5 * (to.p - from.p).dot(&(to.p + from.p));
    for i in 0..POINTS {
        let rise = point(&(to.q - from.q), i).dot(&point(&(to.q + from.q), i));
        sum += 0.25 * (POINTS - 1) as f64 * rise;
        for j in 0..i {
            let between = |q: &SVector<f64, N>| point(q, i) - point(q, j);
            let [a, b] = [between(&from.q), between(&to.q)];
            sum -= 0.5 * ((b - a).dot(&(b + a)) / a.norm_squared()).ln_1p();
        }
    }
    sum
}

/// The largest force along the sphere that is left at `q`.
pub fn force_left(q: &SVector<f64, N>) -> f64 {
    let along = |i: usize| {
        let at = point(q, i);
        let others = (0..POINTS).filter(|&j| j != i).map(|j| at - point(q, j));
        let force: Vector3<f64> = others.map(|between| between / between.norm_squared()).sum();
        (force - at * force.dot(&at)).norm()
    };
    (0..POINTS).map(along).fold(0.0, f64::max)
}

fn main() -> Result<()> {
    let (time, picture) = arguments()?;
    let moments = motion(H, time)?;
    println!("{POINTS} points from rest in steps of {H}, by the midpoint rule\n");
    println!("time      energy            momentum   off the sphere");
    for share in [0.0, 0.001, 0.01, 0.1, 0.2, 0.5, 1.0] {
        let Moment { time, state, energy, off, .. } = moments[(share * (moments.len() - 1) as f64) as usize];
        println!("{time:6.1} {energy:18.12} {:12.1e} {off:12.1e}", state.p.amax());
    }
    let largest = |value: fn(&Moment) -> f64| moments.iter().map(value).fold(f64::NEG_INFINITY, f64::max);
    let last = moments.last().context("a motion")?;
    println!("\nThe energy grows by {:.1e} at most in a step.", largest(|moment| moment.growth));
    println!("||q|² − 1| is {:.1e} at most.", largest(|moment| moment.off));
    println!(
        "Force along the sphere at the end: {:.1e}; V = {:.13}.",
        force_left(&last.state.q),
        last.energy
    );
    println!("\nPicture: {}", draw(&moments, picture)?.display());
    Ok(())
}

fn arguments() -> Result<(f64, Option<PathBuf>)> {
    let (mut time, mut picture) = (200.0, None);
    let mut arguments = lexopt::Parser::from_env();
    while let Some(argument) = arguments.next()? {
        match argument {
            Arg::Long("time") => {
                let text = arguments.value()?.into_string().unwrap_or_default();
                time = text.parse().context("--time takes a number, such as 1000")?;
                ensure!((1.0..1e6).contains(&time), "--time takes a number from 1 to a million");
            }
            Arg::Value(path) if picture.is_none() => picture = Some(PathBuf::from(path)),
            other => return Err(other.unexpected().into()),
        }
    }
    Ok((time, picture))
}

/// What the sphere is seen by: an orthonormal frame, the last towards the viewer.
fn seen(point: &Vector3<f64>) -> (f64, f64, f64) {
    let (turn, tilt) = (0.5_f64, 0.35_f64);
    let (x, y) = (turn.cos() * point.x + turn.sin() * point.y, turn.cos() * point.y - turn.sin() * point.x);
    (x, tilt.cos() * point.z + tilt.sin() * y, tilt.sin() * point.z - tilt.cos() * y)
}

/// The edges of the convex hull, each once.
fn edges(q: &SVector<f64, N>) -> Vec<(usize, usize)> {
    let mut edges = Vec::new();
    for i in 0..POINTS {
        for j in i + 1..POINTS {
            let is_face = |k: usize| {
                let [a, b, c] = [i, j, k].map(|index| point(q, index));
                let normal = (b - a).cross(&(c - a));
                let sides = (0..POINTS).filter(|&l| l != i && l != j && l != k);
                let mut sides = sides.map(|l| normal.dot(&(point(q, l) - a)) > 0.0);
                let first = sides.next();
                sides.all(|side| Some(side) == first)
            };
            if (0..POINTS).any(|k| k != i && k != j && is_face(k)) {
                edges.push((i, j));
            }
        }
    }
    edges
}

/// A label for the first of several curves.
fn once(label: &str) -> impl Iterator<Item = &str> {
    iter::once(label).chain(iter::repeat(""))
}

/// The sphere on the left, energy and distance from the sphere on the right.
fn draw(moments: &[Moment], path: Option<PathBuf>) -> Result<PathBuf> {
    let (start, end) = (&moments[0], moments.last().context("a motion")?);
    let flat = |point: &Vector3<f64>| {
        let (x, y, _) = seen(point);
        (x, y)
    };
    let is_near = |point: &Vector3<f64>| seen(point).2 >= 0.0;
    let circle = (0..=360).map(|degree| f64::from(degree).to_radians().sin_cos()).collect();
    let mut curves = vec![Curve::line("", colour::REFERENCE, 2, circle)];
    let at_end = |i: usize| point(&end.state.q, i);
    let edges = edges(&end.state.q);
    // What lies behind first.
    for (near, label, colour) in
        [(false, "neighbours behind", colour::SEVENTH), (true, "neighbours in front", colour::SIXTH)]
    {
        let seen = edges.iter().filter(|(i, j)| is_near(&(at_end(*i) + at_end(*j))) == near);
        let label = once(label);
        curves.extend(
            seen.zip(label).map(|(&(i, j), label)| {
                Curve::line(label, colour, 2, vec![flat(&at_end(i)), flat(&at_end(j))])
            }),
        );
    }
    let mut label = once("ways");
    for i in 0..POINTS {
        let way: Vec<_> = moments.iter().take(2000).map(|moment| point(&moment.state.q, i)).collect();
        let parts = way.chunk_by(|a, b| is_near(a) == is_near(b)).filter(|part| is_near(&part[0]));
        curves.extend(parts.zip(&mut label).map(|(part, label)| {
            Curve::line(label, colour::RUNGE_KUTTA, 2, part.iter().map(flat).collect())
        }));
    }
    let shown = |moment: &Moment, near: bool| -> Vec<_> {
        let points = (0..POINTS).map(|i| point(&moment.state.q, i));
        points.filter(|at| is_near(at) == near).map(|at| flat(&at)).collect()
    };
    curves.push(Curve::marks("start, in front", colour::RUNGE_KUTTA, Mark::Circle, shown(start, true)));
    curves.push(Curve::marks("end, in front", colour::VARIATIONAL, Mark::Disc, shown(end, true)));
    curves.push(Curve::marks("end, behind", colour::GREY, Mark::Circle, shown(end, false)));

    let early = moments.iter().filter(|moment| moment.time > 0.0 && moment.time <= 100.0);
    let energy = early.clone().map(|moment| (moment.time, moment.energy - end.energy)).collect();
    let off = moments
        .iter()
        .filter(|moment| moment.time > 0.0)
        .map(|moment| (moment.time, moment.off / f64::EPSILON))
        .collect();
    let time = linear("time t (dimensionless)");
    let panels = [
        Panel::new(
            "Twenty charges slide to a state of rest",
            linear("x, turned (dimensionless)"),
            linear("z, turned (dimensionless)"),
            curves,
        )
        .to_equal_scale(),
        Panel::new(
            "Their energy falls to that of the end",
            time,
            logarithmic("energy above the end's (dimensionless)"),
            vec![Curve::line("", colour::VARIATIONAL, 3, energy)],
        ),
        Panel::new(
            "All stay on the sphere to a few roundings",
            logarithmic("time t (dimensionless)"),
            linear("||q|² − 1|, largest of twenty (2.2·10⁻¹⁶)"),
            vec![Curve::line("", colour::VARIATIONAL, 1, off)],
        ),
    ];
    picture::write_to(path, "fekete", [1860, 660], 3, &panels)
}
