//! Cases with friction.

use std::convert::Infallible;
use std::f64::consts::TAU;

use anyhow::Result;
use dalembert::nalgebra::vector;
use dalembert::{
    Discrete, Discretise, Fitted, FittedTrapezoidal, Gauss, Midpoint, OneSided, State, Trapezoidal,
};
use dalembert_examples::picture::{Curve, Dash, Mark, Panel, colour, linear, logarithmic};
use dalembert_tests::hard::{Block, CubicDrag, DampedMass, Effort, Kepler, Progress, drive, drive_composed};
use dalembert_tests::limit_cycle::LimitCycle;

use crate::conservative::{ORDER_6, SPLITTING_6, outcome};
use crate::page::Case;

/// p of a damped free mass after each of `steps` steps, from 1.
fn decay<R: Copy>(rule: R, ratio: f64, steps: usize) -> Result<Vec<f64>>
where
    DampedMass: Discrete<R, 1, Scalar = f64>,
{
    let system = DampedMass { m: 1.0, r: ratio };
    let start = State { q: vector![0.0], p: vector![1.0] };
    let mut momenta = vec![1.0];
    for step in system.by(rule, 1.0).run(start).take(steps) {
        momenta.push(step?.state.p[0]);
    }
    Ok(momenta)
}

/// hr/m from 0.1 to 1e6.
pub fn overdamped() -> Result<Case> {
    let mut rows = Vec::new();
    for ratio in [0.1, 1.0, 1.9, 2.1, 10.0, 1e2, 1e4, 1e6] {
        let midpoint = decay(Midpoint, ratio, 100)?;
        let gauss = decay(Gauss::<3>, ratio, 1)?;
        rows.push(vec![
            format!("{ratio:e}"),
            format!("{:.1e}", (-ratio).exp()),
            format!("{:.4}", midpoint[1]),
            format!("{:.1e}", midpoint[100]),
            format!("{:.4}", gauss[1]),
            format!("{:.1e}", decay(Fitted, ratio, 1)?[1]),
            format!("{:.1e}", decay(OneSided, ratio, 1)?[1]),
        ]);
    }
    let panel = |title, ratio: f64| -> Result<Panel<'static>> {
        let exact = (0..=400).map(|k| f64::from(k) * 0.05).map(|t| (t, (-ratio * t).exp())).collect();
        let points =
            |momenta: Vec<f64>| momenta.into_iter().enumerate().map(|(k, p)| (k as f64, p)).collect();
        let marks = Curve::marks;
        let curves = vec![
            Curve::line("exact", colour::REFERENCE, 2, exact),
            marks("midpoint", colour::VARIATIONAL, Mark::Square, points(decay(Midpoint, ratio, 20)?)),
            marks("fitted", colour::RUNGE_KUTTA, Mark::Disc, points(decay(Fitted, ratio, 20)?)),
            marks("one-sided", colour::EULER, Mark::Triangle, points(decay(OneSided, ratio, 20)?)),
        ];
        Ok(Panel::new(title, linear("steps"), linear("p/p₀ (dimensionless)"), curves))
    };
    Ok(Case {
        title: "Overdamped and stiffly damped motion",
        breaks: "Explicit methods are unstable for hr > 2m. The midpoint rule is stable at any hr, and multiplies the velocity by \
                 (2m − hr)/(2m + hr): past hr = 2m the sign alternates, and for hr ≫ m it hardly decays: **it rings**.",
        ours: "Midpoint and trapezoidal rule ring past hr = 2m, exactly as the formula says, and so do, further out, the Gauss rules, whose factor goes to ±1 as \
               well, and compositions; equilibria and terminal velocities are exact at any \
               hr, q ends where it should, and momenta should not be read. `rule = fitted` decays by e^{−hr/m}, to rounding, at any hr, with q of \
               order 2; `rule = one_sided` by 1/(1 + hr/2m)², for damping that is not linear.",
        head: &[
            "hr/m",
            "exact p after one step",
            "midpoint",
            "midpoint after 100 steps",
            "Gauss, 3 stages",
            "fitted",
            "one-sided",
        ],
        rows,
        panels: vec![
            panel("hr/m = 1.5: all decay, fitted on the curve", 1.5)?,
            panel("hr/m = 20: the midpoint rule rings", 20.0)?,
        ],
        test: "damping.rs",
    })
}

/// A run that shows each state to who watches.
type Run<'a> = dyn Fn(&mut dyn FnMut(Progress<2>)) -> Effort + 'a;

/// Angular momentum under drag on orbits that almost collide.
pub fn kepler_drag() -> Result<Case> {
    let k = 0.05;
    let system = Kepler { k };
    let mut rows = Vec::new();
    for e in [0.9, 0.99, 0.999] {
        let start = Kepler::aphelion(e);
        for steps in [1_000_u64, 10_000, 100_000] {
            let h = TAU / steps as f64;
            let mut row = |name: &str, run: &Run<'_>| {
                let mut worst = 0.0_f64;
                let effort = run(&mut |at| {
                    let exact = Kepler::angular_momentum(&start) * (-k * at.time).exp();
                    worst = worst.max((Kepler::angular_momentum(&at.state) / exact - 1.0).abs());
                });
                rows.push(vec![
                    format!("{e}"),
                    format!("{steps}"),
                    name.to_owned(),
                    format!("{worst:.1e}"),
                    outcome(&effort),
                ]);
            };
            let count = [10 * steps, 1];
            row("midpoint", &|look| drive(&system, Midpoint, h, start, count, look));
            row("trapezoidal", &|look| drive(&system, Trapezoidal, h, start, count, look));
            row("fitted", &|look| drive(&system, Fitted, h, start, count, look));
            row("fitted, trapezoidal", &|look| drive(&system, FittedTrapezoidal, h, start, count, look));
            row("Gauss, 3 stages", &|look| drive(&system, Gauss::<3>, h, start, count, look));
            row("composition, order 6", &|look| {
                drive_composed(system.by(ORDER_6, h).run(start), 10 * steps, look)
            });
            row("splitting, order 6", &|look| {
                drive_composed(system.by(SPLITTING_6, h).run(start), 10 * steps, look)
            });
        }
    }
    Ok(Case {
        title: "Kepler orbits that almost collide, with drag",
        breaks: "R = ½k|v|², k = 0.05, takes angular momentum, J(t) = J(0) e^{−kt} on every orbit, and the near side comes closer each time.",
        ours: "The explicit fitted rule and the splitting have the law exactly, at every step size, even where the orbit itself is wrong, to the rounding of q × p where a \
               body is thrown far out; the trapezoidal rule has its own, ((2 − hk)/(2 + hk))ⁿ, exactly. The others are right to their order until the \
               near side is no longer resolved, where implicit steps have no real solution and say so.",
        head: &["e", "steps an orbit", "rule", "largest \\|J e^{kt}/J₀ − 1\\|, 10 periods", "stopped"],
        rows,
        panels: Vec::new(),
        test: "methods.rs",
    })
}

/// Regularised Coulomb friction.
pub fn stick_slip() -> Result<Case> {
    let (k, mu, u, h) = (1.0, 1.0, 0.1, 1e-2);
    let mut rows = Vec::new();
    let mut curves = Vec::new();
    for (label, epsilon, colour, dash) in [
        ("ε = 10⁻¹", 1e-1, colour::RUNGE_KUTTA, Dash::Dotted),
        ("ε = 10⁻²", 1e-2, colour::EULER, Dash::Dashed),
        ("ε = 10⁻⁶", 1e-6, colour::VARIATIONAL, Dash::Solid),
    ] {
        let system = Block { k, mu, u, epsilon };
        let start = State { q: vector![0.0], p: vector![-u] };
        let (mut points, mut slip, mut iterations, mut most, mut damped) = (vec![(0.0, 0.0)], None, 0, 0, 0);
        let mut trajectory = system.by(Midpoint, h).run(start);
        for _ in 0..4_000 {
            let Some(step) = trajectory.next().transpose()? else { break };
            points.push((trajectory.time(), step.state.q[0]));
            iterations += step.report.iterations;
            most = most.max(step.report.iterations);
            damped += step.report.damped;
            if slip.is_none() && step.velocity[0] + u > 0.5 * u {
                slip = Some(trajectory.time());
            }
        }
        let lowest = points.iter().map(|point| point.1).fold(0.0, f64::min);
        rows.push(vec![
            format!("{epsilon:.0e}"),
            format!("{:.0e}", h * mu / epsilon),
            slip.map_or("–".to_owned(), |t| format!("{t:.2}")),
            format!("{lowest:.5}"),
            format!("{:.2}, at most {most}", f64::from(iterations) / 4_000.0),
            format!("{damped}"),
        ]);
        curves.push(Curve::line(label, colour, 3, points).dashed(dash));
    }
    Ok(Case {
        title: "Dry friction, regularised: stick and slip",
        breaks: "Friction −μ tanh(v/ε) has the slope μ/ε at rest, 1e6 and more, and none elsewhere: Newton's method jumps across, \
                 explicit methods need h < 2ε/μ.",
        ours: "One or two iterations a step at every ε; damping of the Newton step catches the jump when the block starts to slip. With ε → 0: \
               slip at t = μ/(ku) = 10, half the speed u after another π/3, and the lowest point −μ/k − u = −1.1. Written as ln cosh the \
               friction overflows, and written as x + ln(1 + e^{−2x}) it loses its digits at rest: both return a named `StepError`. \
               Without ε, as μ|v|, `rule = proximal` takes it: [at random](evidence/dry-friction.md), [beside SciPy](evidence/friction-beside-scipy.md).",
        head: &["ε", "hμ/ε", "slips at", "lowest q", "Newton iterations a step", "shortened"],
        rows,
        panels: vec![Panel::new(
            "Friction −μ tanh(v/ε): no stick and slip at ε = 10⁻¹",
            linear("time t (dimensionless)"),
            linear("place of the block q (dimensionless)"),
            curves,
        )],
        test: "damping.rs",
    })
}

/// Cubic drag and its fold.
pub fn fold() -> Result<Case> {
    let (m, r, h) = (1.3, 0.6, 0.4);
    let system = CubicDrag { m, r };
    let fold = -m * m / (2.0 * h * r);
    let mut rows = Vec::new();
    let mut found = Vec::new();
    for k in -120..=400 {
        let p = fold * f64::from(k) * 0.01;
        let state = State { q: vector![0.0], p: vector![p] };
        let step = system.by(Midpoint, h).step(&state);
        if let Ok(step) = &step {
            found.push((p, step.velocity[0]));
        }
        if [-100, 50, 99, 101, 200].contains(&k) {
            let answer = match step {
                Ok(step) => format!("v̄ = {:.6}", step.velocity[0]),
                Err(error) => error.to_string(),
            };
            let exact = m * m + 2.0 * h * r * p;
            let exact =
                if exact < 0.0 { "none".to_owned() } else { format!("{:.6}", (exact.sqrt() - m) / (h * r)) };
            rows.push(vec![format!("{:.2}", p / fold), exact, answer]);
        }
    }
    let branch = |sign: f64| {
        (0..=400)
            .map(|k| f64::from(k) * 0.0072)
            .map(|x| (fold + x * x, (sign * (2.0 * h * r).sqrt() * x - m) / (h * r)))
            .collect()
    };
    let curves = vec![
        Curve::line("root of the flow", colour::REFERENCE, 3, branch(1.0)),
        Curve::line("other root", colour::RUNGE_KUTTA, 3, branch(-1.0)).dashed(Dash::Dashed),
        Curve::marks("found", colour::VARIATIONAL, Mark::Disc, found.into_iter().step_by(10).collect()),
    ];
    Ok(Case {
        title: "Cubic drag past its fold",
        breaks: "R = r v³/3 accelerates for v < 0, and p = m v̄ + (h/2) r v̄² has two roots, or none for p < −m²/(2hr). A solver that \
                 returns its last iterate, or the other root, goes on with nonsense.",
        ours: "The root found is the one that goes to 0 with the step; beyond the fold the error is `NoRealSolution`, the state is \
               untouched, and a smaller step passes.",
        head: &["p, in units of the fold's", "exact v̄", "found"],
        rows,
        panels: vec![Panel::new(
            "Roots v̄ of p = m v̄ + (h/2) r v̄²: none left of the fold",
            linear("momentum p (dimensionless)"),
            linear("mean velocity v̄ (dimensionless)"),
            curves,
        )],
        test: "damping.rs",
    })
}

/// The mean energy of a limit cycle under a force that goes to 0.
pub fn limit_cycle() -> Result<Case> {
    let h = 0.2;
    let mut rows = Vec::new();
    let [mut by_midpoint, mut by_runge_kutta] = [const { Vec::new() }; 2];
    for epsilon in [0.1, 0.03, 0.01, 0.003, 0.001] {
        let system = LimitCycle { epsilon };
        let own = system.mean_energy(h, |state| system.step(Midpoint, h, state))?;
        let other = system.mean_energy(h, |state| Ok::<_, Infallible>(system.runge_kutta(h, state)))?;
        rows.push(vec![format!("{epsilon}"), format!("{own:.3}"), format!("{other:.3}")]);
        by_midpoint.push((epsilon, own));
        by_runge_kutta.push((epsilon, other));
    }
    let exact = LimitCycle::energy_without_friction();
    let of_motion = vec![(0.001, exact), (0.1, exact)];
    let curves = vec![
        Curve::line("motion, ε → 0", colour::REFERENCE, 2, of_motion).dashed(Dash::Dashed),
        Curve::line("midpoint", colour::VARIATIONAL, 3, by_midpoint).marked(Mark::Square, 1),
        Curve::line("Runge–Kutta 4", colour::RUNGE_KUTTA, 3, by_runge_kutta).marked(Mark::Disc, 1),
    ];
    Ok(Case {
        title: "A limit cycle under a small force",
        breaks: "q̈ + q + q³ = ε(1 − q²)q̇ has a limit cycle of energy 5.378 + O(ε). A method that is not symplectic at ε = 0 has a drift of \
                 its own, which the force has to make up for: the smaller ε, the further off the cycle.",
        ours: "At ε = 0 a step keeps a modified energy, and the cycle has a limit that is off by h² alone. (At ε = 0.1 Runge–Kutta 4 is the nearer.) \
               The limit at h = 0.2 is 6.126, where the discrete Melnikov function, made of steps with ε = 0, changes sign.",
        head: &["ε", "mean energy by midpoint, h = 0.2", "Runge–Kutta 4, h = 0.2"],
        rows,
        panels: vec![Panel::new(
            "h = 0.2: Runge–Kutta 4 loses the cycle as ε → 0",
            logarithmic("size of the force ε (dimensionless)"),
            linear("mean energy of the cycle (dimensionless)"),
            curves,
        )],
        test: "theory/rayleigh/small_friction.rs",
    })
}
