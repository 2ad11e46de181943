//! Orbits that almost collide, by steps that follow the motion.

use std::f64::consts::TAU;

use anyhow::{Context, Result};
use dalembert::{Discretise, EnergyLedger, Gauss, State, StepError};
use dalembert_tests::hard::{EccentricKepler, Kepler, KeplerOfEnergy};

use crate::page::Case;

/// The rule of all rows.
const RULE: Gauss<8> = Gauss;

/// What a run found: errors so far, at 10 orbits and at the end.
#[derive(Default)]
struct Found {
    steps: u64,
    iterations: u64,
    energy: [f64; 2],
    momentum: f64,
}

impl Found {
    /// Looks at a state of the orbit from `start`, `orbits` later.
    fn look(&mut self, start: &State<f64, 2>, state: &State<f64, 2>, iterations: u32, orbits: f64, k: f64) {
        self.steps += 1;
        self.iterations += u64::from(iterations);
        let energy = (Kepler::energy_of(state) + 0.5).abs();
        if orbits < 10.0 {
            self.energy[0] = self.energy[0].max(energy);
        }
        self.energy[1] = self.energy[1].max(energy);
        let law = Kepler::angular_momentum(start) * (-k * TAU * orbits).exp();
        self.momentum = self.momentum.max((Kepler::angular_momentum(state) / law - 1.0).abs());
    }

    fn row(&self, e: f64, k: f64, way: &str, step: f64, orbits: f64, remainder: Option<f64>) -> Vec<String> {
        let mut row = vec![format!("{e}"), format!("{k}"), way.to_owned(), format!("{step:.3}")];
        row.push(format!("{:.1}", self.steps as f64 / orbits));
        row.push(format!("{:.0}", self.iterations as f64 / orbits));
        match remainder {
            None => row.extend(self.energy.map(|error| format!("{error:.1e}"))),
            Some(remainder) => row.extend(["–".to_owned(), format!("{remainder:.1e} of the balance")]),
        }
        row.push(format!("{:.1e}", self.momentum));
        row
    }
}

/// By steps equal in τ, of the plain system.
fn scaled(e: f64, k: f64, step: f64, orbits: f64) -> Result<Vec<String>> {
    let (start, system) = (Kepler::aphelion(e), EccentricKepler { k });
    let mut run = system.by(RULE, step).run(start).in_scaled_time();
    let (mut found, mut ledger, mut remainder) = (Found::default(), EnergyLedger::default(), 0.0_f64);
    let mut state = start;
    while run.time() < orbits * TAU {
        let taken = run.next().context("the run has ended")??;
        found.look(&start, &taken.state, taken.report.iterations, run.time() / TAU, k);
        if k > 0.0 {
            ledger += system.by(RULE, run.step_size()).ledger(&state, &taken.state)?;
            remainder = remainder.max(ledger.remainder().abs());
        }
        state = taken.state;
    }
    Ok(found.row(e, k, "steps equal in τ", step, orbits, (k > 0.0).then_some(remainder)))
}

/// By steps equal in τ, of the Lagrangian in τ, as many as the plain system needed.
fn transformed(e: f64, step: f64, steps: u64, orbits: f64) -> Result<Vec<String>> {
    let (start, system) = (Kepler::aphelion(e), KeplerOfEnergy { e: -0.5 });
    let mut run = system.by(RULE, step).run(start);
    let mut found = Found::default();
    for index in 0..steps {
        let taken = run.next().context("the run has ended")??;
        let orbit = orbits * index as f64 / steps as f64;
        found.look(&start, &taken.state, taken.report.iterations, orbit, 0.0);
    }
    Ok(found.row(e, 0.0, "Lagrangian in τ", step, orbits, None))
}

/// By as many steps, equal in t: where they get.
fn equal(e: f64, steps: f64, orbits: f64) -> Result<Vec<String>, StepError> {
    let (start, system) = (Kepler::aphelion(e), EccentricKepler { k: 0.0 });
    let mut found = Found::default();
    let mut run = system.by(RULE, TAU / steps).run(start);
    while run.time() < orbits * TAU {
        let Some(taken) = run.next() else { break };
        let taken = match taken {
            Ok(taken) => taken,
            Err(_) => break,
        };
        found.look(&start, &taken.state, taken.report.iterations, run.time() / TAU, 0.0);
    }
    let went = run.time() / TAU;
    let way = if went < orbits { "steps equal in t, ended before the near side" } else { "steps equal in t" };
    Ok(found.row(e, 0.0, way, TAU / steps, went.min(orbits), None))
}

/// Energy and angular momentum over 10⁴ orbits.
pub fn kepler() -> Result<Case> {
    let orbits = 1e4;
    let mut rows = Vec::new();
    // τ of an orbit: ∮ dt / |q|^{3/2}.
    for (e, turn) in [(0.99, 11.46), (0.999, 14.68)] {
        rows.push(equal(e, turn / 0.3, 10.0)?);
        for step in [0.5, 0.4, 0.3] {
            rows.push(scaled(e, 0.0, step, orbits)?);
        }
        for step in [0.7, 0.5, 0.4] {
            rows.push(transformed(e, step, (orbits * turn / step) as u64, orbits)?);
        }
        rows.push(scaled(e, 1e-5, 0.3, orbits)?);
    }
    Ok(Case {
        title: "Kepler orbits that almost collide, by steps that follow them",
        breaks: "A step that is short enough for the near side is 10³ to 10⁵ times too short for the rest of the orbit; steps chosen by an error estimate lose what \
                 steps of one size keep.",
        ours: "`fn time_scale`, σ = \\|q\\|^{3/2}, and `in_scaled_time()`: 20 to 50 steps of the Gauss rule of 8 stages an orbit, each of a size of its own, keep angular momentum to \
               rounding and the energy within what a passage leaves, over 10⁴ orbits. With drag, 10⁴ orbits take half of the angular momentum as J = J₀ e^{−kt} says, and the energy \
               that is lost is what the rule says that friction took, to the figure given. The Lagrangian in τ, σ(q)(L(q, w/σ) + E), stepped by constant Δτ, is symplectic; a step \
               of it is good for more, and costs more sweeps; the rounding of E, divided by σ, is what it leaves. It has no friction. (With (t, −E) for further coordinates it \
               has; its equations are then so much stiffer that a step costs 3 to 300 times as much.)",
        head: &[
            "e",
            "k",
            "by",
            "Δτ, or h",
            "steps an orbit",
            "sweeps an orbit",
            "largest \\|E − E₀\\|, 10 orbits",
            "10⁴ orbits",
            "largest \\|J e^{kt}/J₀ − 1\\|",
        ],
        rows,
        panels: Vec::new(),
        test: "kepler.rs",
    })
}
