//! The stationary S* of a damped pendulum.
//!
//! With friction c < 1 the Hamilton–Jacobi equation has one stationary solution on the circle,
//!
//! ```text
//! S*(q1) = min over q0 of c S*(q0) + G(q0, q1)
//! ```
//!
//! to which S_k goes as c^k from any S_0. The graph of dS* is the unstable manifold of the upright position,
//! up to the bottom, where the ways down from both sides meet in a kink of S*. Drawn are S*, dS* with the
//! states of the two motions that fall from upright, and |S_k − S*| from two S_0.
//!
//! ```text
//! cargo run --release --example stationary [picture.svg]
//! ```

use std::f64::consts::{PI, TAU};

use anyhow::{Context, Result};
use dalembert::hamilton_jacobi::{Jet, StationarySolution};
use dalembert::nalgebra::vector;
use dalembert::{Discretise, Discretised, State, Trapezoidal, rayleigh_system, samples};
use dalembert_examples::picture::{self, Curve, Dash, Mark, Panel, colour, linear, logarithmic};

/// Of length, mass and weight 1.
#[rayleigh_system(rule = trapezoidal)]
fn pendulum(q: [f64; 1], v: [f64; 1], a: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] + q[0].cos(), a * v[0] * v[0])
}

type Steps<'a> = Discretised<'a, Pendulum, Trapezoidal, 1>;

/// A name and an S_0.
type Start = (&'static str, fn(f64) -> Jet);

/// S_0 = 0, and one without the pendulum's symmetry.
const STARTS: [Start; 2] = [
    ("S₀ = 0", |_| Jet { value: 0.0, slope: 0.0 }),
    ("S₀ = 9 + 2 sin q", |q| Jet { value: 9.0 + 2.0 * q.sin(), slope: 2.0 * q.cos() }),
];

fn main() -> Result<()> {
    let (a, h) = (0.25, 0.2);
    let pendulum = Pendulum { a };
    let by = pendulum.by(Trapezoidal, h);
    let proportion = by.proportion(&samples::segments([-3.0], [3.0], [0.3], 20))?;
    let split = by.proportional_split(&proportion, [0.0]).context("κ is not constant")?;
    let manifold = Manifold::of(&by)?;

    println!("Damped pendulum, L = v²/2 + cos q, R = a v², a = {a}, trapezoidal rule, h = {h}");
    println!("c = (1 − ah)/(1 + ah) = {:.12}\n", split.factor());
    println!("points   iterations   contraction      S*(π)             kink      largest |dS* − p|");
    for points in [64, 128, 256, 512] {
        let found = split.stationary_equation(TAU, points)?.solve()?;
        let StationarySolution { iterations, ratio, kinks, .. } = &found;
        let kink = kinks.iter().map(|kink| about_0(*kink)).fold(0.0, |_, kink| kink);
        println!(
            "{points:6} {iterations:12}   {ratio:.10} {:16.12} {kink:13.1e} {:15.1e}",
            found.value(PI),
            manifold.distance(&found)
        );
    }
    println!("\nG(π, π)/(1 − c) = S*(π) = −2.1; p: the unstable manifold of the upright position, by steps");

    let equation = split.stationary_equation(TAU, 512)?;
    let found = equation.solve()?;
    let changes = STARTS.map(|(label, start)| {
        let distances = equation.iterates(start).take(231).map(|s| s.distance(&found.function));
        (label, distances.enumerate().map(|(k, distance)| (k as f64, distance)).collect::<Vec<_>>())
    });
    let panels =
        [value_panel(&found), momentum_panel(&found, &manifold), iteration_panel(split.factor(), changes)];
    let path = picture::write("stationary", [1240, 520], 3, &panels)?;
    println!("\nPicture: {}", path.display());
    Ok(())
}

/// The angle in (−π, π].
fn about_0(q: f64) -> f64 {
    PI - (PI - q).rem_euclid(TAU)
}

/// States of motions that fall from the upright position, to the right: (q, p), q from −π on.
struct Manifold {
    /// One motion, a step each.
    motion: Vec<(f64, f64)>,
    /// All of it.
    curve: Vec<(f64, f64)>,
}

impl Manifold {
    /// By steps from near the upright position, along the eigenvector of their derivative there.
    fn of(by: &Steps<'_>) -> Result<Self> {
        let (_, a) = by.linearized_step(&State { q: vector![-PI], p: vector![0.0] })?;
        let [a, b, c, d] = [a.q_by_q, a.q_by_p, a.p_by_q, a.p_by_p].map(|block| block[0]);
        let growth = 0.5 * (a + d) + (0.25 * (a - d) * (a - d) + b * c).sqrt();
        let motion = |near: f64| -> Result<Vec<(f64, f64)>> {
            let start = State { q: vector![near - PI], p: vector![near * (growth - a) / b] };
            let steps = by.run(start).take(160).map(|step| Ok(step?.state));
            steps.map(|state| state.map(|state: State<f64, 1>| (state.q[0], state.p[0]))).collect()
        };
        // A step leads from the first to the last.
        let motions = (0..16).map(|i| motion(1e-6 * growth.powf(f64::from(i) / 16.0)));
        let motions = motions.collect::<Result<Vec<_>>>()?;
        let curve = (0..motions[0].len()).flat_map(|k| motions.iter().map(move |motion| motion[k]));
        Ok(Self { curve: curve.collect(), motion: motions[0].clone() })
    }

    /// The states that are on the graph: before the bottom.
    fn above(states: &[(f64, f64)]) -> impl Iterator<Item = (f64, f64)> {
        states.iter().copied().take_while(|(q, _)| *q < -0.03)
    }

    /// The largest |dS* − p| on it.
    fn distance(&self, found: &StationarySolution) -> f64 {
        Self::above(&self.curve).map(|(q, p)| (found.gradient(q) - p).abs()).fold(0.0, f64::max)
    }
}

/// `of` along the circle, cut at the bottom.
fn halves(of: impl Fn(f64) -> f64) -> [Vec<(f64, f64)>; 2] {
    let half =
        |from: f64| (0..=400).map(|i| from + PI * (0.5 + f64::from(i)) / 401.0).map(|q| (q, of(q))).collect();
    [half(-PI), half(0.0)]
}

fn value_panel(found: &StationarySolution) -> Panel<'static> {
    let values = halves(|q| found.value(q)).concat();
    let kinks = found.kinks.iter().map(|kink| (about_0(*kink), found.value(*kink))).collect();
    let curves = vec![
        Curve::line("S*", colour::VARIATIONAL, 3, values),
        Curve::marks("its kink", colour::RUNGE_KUTTA, Mark::Circle, kinks),
    ];
    Panel::new(
        "S* has a kink at the bottom",
        linear("angle q (rad), 0 at the bottom"),
        linear("S* (dimensionless)"),
        curves,
    )
}

fn momentum_panel(found: &StationarySolution, manifold: &Manifold) -> Panel<'static> {
    let mirrored = |points: &[(f64, f64)]| points.iter().map(|(q, p)| (-q, -p)).collect::<Vec<_>>();
    let [left, right] = halves(|q| found.gradient(q));
    let motion: Vec<_> = Manifold::above(&manifold.motion).filter(|(q, _)| *q > 0.2 - PI).collect();
    let goes_on: Vec<_> = manifold.curve.iter().copied().skip_while(|(q, _)| *q < 0.0).collect();
    let both = [motion.clone(), mirrored(&motion)].concat();
    let goes_on_mirrored = mirrored(&goes_on);
    let curves = vec![
        Curve::line("dS*/dq", colour::VARIATIONAL, 3, left),
        Curve::line("", colour::VARIATIONAL, 3, right),
        Curve::marks("motion from upright", colour::RUNGE_KUTTA, Mark::Circle, both),
        Curve::line("as it goes on", colour::GREY, 2, goes_on).dashed(Dash::Dotted),
        Curve::line("", colour::GREY, 2, goes_on_mirrored).dashed(Dash::Dotted),
    ];
    Panel::new(
        "dS* is the unstable manifold",
        linear("angle q (rad), 0 at the bottom"),
        linear("momentum p (dimensionless)"),
        curves,
    )
}

fn iteration_panel(c: f64, changes: [(&'static str, Vec<(f64, f64)>); 2]) -> Panel<'static> {
    let power = (0..=230).map(|k| (f64::from(k), c.powi(k))).collect();
    let mut curves = vec![Curve::line("c^k", colour::GREY, 2, power)];
    let styles = [(colour::VARIATIONAL, Dash::Solid), (colour::RUNGE_KUTTA, Dash::Dashed)];
    for ((label, points), (colour, dash)) in changes.into_iter().zip(styles) {
        curves.push(Curve::line(label, colour, 3, points).dashed(dash));
    }
    Panel::new(
        "S_k tends to S* as c^k",
        linear("iteration k"),
        logarithmic("sup |S_k − S*| (dimensionless)"),
        curves,
    )
}
