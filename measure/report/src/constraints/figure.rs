//! The picture: errors against time for three of the mechanisms.

use anyhow::Result;
use dalembert_examples::picture::{self, Curve, Dash, Mark, Panel, RGBColor, colour, logarithmic};

use super::page::{QUANTITIES, Quantity, label};
use super::{HORIZONS, Record};
use crate::frontier::{Point, unbeaten_by_finer};

const PEER: RGBColor = RGBColor(90, 90, 90);

/// What is shown, and how.
const SHOWN: [(&str, RGBColor, Dash, Mark); 9] = [
    ("midpoint", colour::VARIATIONAL, Dash::Solid, Mark::Disc),
    ("midpoint, Kahan–Li 6", colour::EULER, Dash::Solid, Mark::Square),
    ("midpoint, Kahan–Li 8", colour::RUNGE_KUTTA, Dash::Solid, Mark::Circle),
    ("ode_solvers Dop853", colour::REFERENCE, Dash::Solid, Mark::Cross),
    ("ode_solvers Dop853, stabilised", colour::REFERENCE, Dash::Dotted, Mark::Cross),
    ("diffsol tsit45, stabilised", PEER, Dash::DashDotted, Mark::Triangle),
    ("heyoka", PEER, Dash::Dotted, Mark::Disc),
    ("MuJoCo, implicitfast", colour::FOURTH, Dash::Dashed, Mark::Triangle),
    ("MuJoCo, RK4", colour::FIFTH, Dash::Dashed, Mark::Square),
];

const MECHANISMS: [&str; 3] = ["spherical pendulum", "two rods", "four-bar"];

/// The least value that the picture shows.
const FLOOR: f64 = 1e-17;

/// A row a mechanism: q after the short time, energy and constraints after the longest measured.
///
/// # Errors
/// A picture that cannot be drawn.
pub fn svg(records: &[Record]) -> Result<String> {
    let [_, energy, _, position] = QUANTITIES;
    let shown: Vec<_> = MECHANISMS
        .iter()
        .flat_map(|&name| {
            let times = records.iter().filter(|run| run.mechanism == name).map(|run| run.horizon);
            let longest = times.fold(HORIZONS[0].time, f64::max);
            [
                (name, (position, HORIZONS[0].time, "error of q at T (m or rad)")),
                (name, (energy, longest, "largest error of the energy (J)")),
                (name, (QUANTITIES[0], longest, "largest distance off (m)")),
            ]
        })
        .collect();
    let titles: Vec<String> =
        shown.iter().map(|(name, (_, time, _))| format!("{name}, T = {time} s")).collect();
    let panels: Vec<_> = shown
        .iter()
        .zip(&titles)
        .map(|(&(name, (quantity, time, axis)), title)| {
            let of: Vec<_> =
                records.iter().filter(|run| run.mechanism == name && run.horizon == time).collect();
            let y = logarithmic(axis).with_floor(FLOOR).from_to(FLOOR, 10.0);
            Panel::new(title, logarithmic("processor time a second of motion (µs)"), y, curves(&of, quantity))
        })
        .collect();
    picture::svg([1500, 1500], 3, &panels)
}

fn curves<'a>(runs: &[&Record], (_, value): Quantity) -> Vec<Curve<'a>> {
    let curve = |(method, colour, dash, mark): (&'a str, _, _, _)| {
        let mut points: Vec<Point> = runs
            .iter()
            .filter(|run| label(run) == method)
            .filter_map(|run| Some(Point { seconds: run.seconds * 1e6, error: value(run)? }))
            .collect();
        // Rates of stabilisation apart: of all runs those that none beats in time and in error.
        points.sort_by(|a, b| b.seconds.total_cmp(&a.seconds));
        let unbeaten = unbeaten_by_finer(points).into_iter().map(|point| (point.seconds, point.error));
        Curve::line(method, colour, 3, unbeaten.collect()).dashed(dash).marked(mark, 1)
    };
    SHOWN.map(curve).into_iter().collect()
}
