//! The figures: error against time for some scenes, and the long run.

use std::path::Path;

use anyhow::Result;
use dalembert_examples::picture::{self, Curve, Dash, Mark, Panel, RGBColor, colour, linear, logarithmic};
use dalembert_examples::results;

use crate::frontier::{Point, points, unbeaten_by_finer};
use crate::long_run;
use crate::measured::{BATCH, Measured, QUANTITIES};

/// How a method looks in every figure.
type Look = (&'static str, RGBColor, Dash, Mark);

const PEER: RGBColor = RGBColor(90, 90, 90);

/// What the figures show, more than which no eye tells apart: of this project's methods one of each kind, in
/// colour; of the others the fastest of each kind.
const SHOWN: [Look; 9] = [
    ("midpoint", colour::VARIATIONAL, Dash::Solid, Mark::Disc),
    ("Gauss, 8 stages", colour::EULER, Dash::Solid, Mark::Square),
    ("Gauss, 8 stages, to an error", colour::FIFTH, Dash::Solid, Mark::Triangle),
    ("Gauss, 8 stages, in scaled time", colour::EULER, Dash::Dotted, Mark::Circle),
    ("Blanes–Moan 6", colour::RUNGE_KUTTA, Dash::Solid, Mark::Circle),
    ("ode_solvers Dop853", colour::REFERENCE, Dash::Dashed, Mark::Cross),
    ("diffsol tsit45", PEER, Dash::DashDotted, Mark::Triangle),
    ("heyoka", PEER, Dash::Dotted, Mark::Disc),
    (BATCH, PEER, Dash::Dashed, Mark::Square),
];

/// The scenes of the figure, with their titles: the others are in the tables.
const DRAWN: [(&str, &str); 4] = [
    ("ring", "Ring: lower left is better"),
    ("double pendulum", "Double pendulum: lower left is better"),
    ("FPUT chain", "FPUT chain: lower left is better"),
    ("Kepler, e = 0.99", "Kepler, e = 0.99: lower left is better"),
];

/// The smallest errors shown: of states, and of the energy along the long run.
const FLOORS: [f64; 2] = [1e-15, 1e-12];

/// Writes all figures into `folder`.
///
/// # Errors
/// A file cannot be written.
pub fn write(folder: &Path, measured: &Measured<'_>) -> Result<()> {
    let [(quantity, error), ..] = QUANTITIES;
    let label = format!("error of the {quantity} at the end (dimensionless)");
    let panels = DRAWN.map(|(scene, title)| {
        let curves = curves(&SHOWN, |method| {
            let finer = unbeaten_by_finer(points(measured.records, scene, method, error));
            finer.into_iter().map(|p| (p.seconds * 1e6, p.error)).collect()
        });
        let floored = logarithmic(&label).with_floor(FLOORS[0]).from_to(FLOORS[0], 1.0);
        Panel::new(title, logarithmic("time of one trajectory (µs)"), floored, curves)
    });
    let svg = picture::svg([1240, 1240], 2, &panels)?;
    results::save(&folder.join(quantity).with_extension("svg"), &svg)?;
    if measured.long.is_empty() {
        return Ok(());
    }
    let energy = |label| logarithmic(label).with_floor(FLOORS[1]).from_to(FLOORS[1], 1.0);
    let title = format!("Energy error of the run nearest to {} ms", long_run::SHOWN * 1e3);
    let is_run = |look: &Look| measured.long.iter().any(|record| record.method == look.0);
    let shown: Vec<_> = SHOWN.into_iter().filter(is_run).collect();
    let along = curves(&shown, |method| {
        let mut largest = 0.0_f64;
        let samples = measured.samples.iter().filter(|sample| sample.method == method);
        let largest = samples.map(|sample| {
            largest = largest.max(sample.energy_error);
            (sample.time, largest)
        });
        largest.collect()
    });
    // The line alone: it has hundreds of points.
    let along = along.into_iter().map(|curve| curve.marked_rarely(40)).collect();
    let cost = curves(&shown, |method| {
        let runs = measured.long.iter().filter(|record| record.method == method);
        let runs = runs.map(|run| Point { seconds: run.seconds, error: run.error_to_20000 });
        unbeaten_by_finer(runs).into_iter().map(|run| (run.seconds * 1e3, run.error)).collect()
    });
    let panels = [
        Panel::new(
            &title,
            linear("time t (dimensionless)"),
            energy("largest |E − E reference| so far (dimensionless)"),
            along,
        ),
        Panel::new(
            "Its largest value up to t = 20 000, over cost",
            logarithmic("time of the whole run (ms)"),
            energy("largest |E − E reference| (dimensionless)"),
            cost,
        ),
    ];
    results::save(&folder.join("long-run.svg"), &picture::svg([1240, 640], 2, &panels)?)
}

/// The curves of methods, those without points too: one legend does for all panels.
fn curves(methods: &[Look], points: impl Fn(&str) -> Vec<(f64, f64)>) -> Vec<Curve<'static>> {
    let curve = |&(method, colour, dash, mark): &Look| {
        let mut points = points(method);
        points.retain(|point| point.0.is_finite() && point.1.is_finite());
        Curve::line(method, colour, 2, points).dashed(dash).marked(mark, 1)
    };
    methods.iter().map(curve).collect()
}
