//! A model that was edited since its parts were written.

use dalembert::{Midpoint, State, rayleigh_system};
use dalembert_ensemble::{Ends, Ensemble};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use crate::study::{OF_PART, folder, kind};
use crate::trials::Trials;

/// A pendulum as it was written first, and as edited: another from an angle or a speed on. No column and no
/// start shows it.
#[derive(Clone, Copy, Debug, Default)]
struct Pendulum {
    potential: Edit,
    friction: Edit,
    force: Edit,
}

/// By how much, and from where on.
#[derive(Clone, Copy, Debug, Default)]
struct Edit {
    by: f64,
    from: f64,
}

#[rayleigh_system]
impl Pendulum {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        let beyond = (q[0] - self.potential.from).max(0.0);
        0.5 * v[0] * v[0] + q[0].cos() - self.potential.by * beyond * beyond
    }
    fn rayleigh(&self, _q: [f64; 1], v: [f64; 1]) -> f64 {
        let beyond = (v[0] - self.friction.from).max(0.0);
        0.01 * v[0] * v[0] + self.friction.by * beyond * beyond * beyond
    }
    fn force(&self, q: [f64; 1], _v: [f64; 1]) -> [f64; 1] {
        [if q[0] > self.force.from { self.force.by } else { 0.0 }]
    }
}

/// Parts of the model before are found, or gone on with beside. Control: the ends of all members are the same
/// bits by both, so that neither starts nor first steps tell.
pub fn are_there(tries: u32) -> Trials {
    let mut random = StdRng::seed_from_u64(7);
    let mut trials = Trials::default();
    for k in 0..tries {
        let mut within = |from: f64, to: f64| random.random_range(from..to);
        let (by, mut edited) = (within(0.01, 1.0), Pendulum::default());
        match k % 3 {
            0 => edited.potential = Edit { by, from: within(0.5, 3.0) },
            1 => edited.friction = Edit { by, from: within(0.5, 3.0) },
            _ => edited.force = Edit { by, from: within(0.5, 3.0) },
        }
        let member = |model: Pendulum| {
            move |number: u64| Ok((model, State { q: [1e-3 * number as f64].into(), p: [0.1].into() }))
        };
        let study = |model| Ensemble::new(member(model)).by(Midpoint, 0.1).steps(5);
        let folder = folder();
        let write = |model, parts: std::ops::Range<u64>| {
            let numbers = OF_PART * parts.start..OF_PART * parts.end;
            study(model).parts(&folder).members_per_part(OF_PART).write(numbers)
        };
        write(Pendulum::default(), 0..2).unwrap();
        // The same members, or others.
        let (from, to) = if k % 2 == 0 { (0, 2) } else { (2, 4) };
        let result = write(edited, from..to);
        trials.hear(result.as_ref().map_or_else(kind, |_| "ok"));
        trials.add(result.ok().map(|written| format!("{edited:?}: {written}")));
        trials.add_control(ends(&study(Pendulum::default())) == ends(&study(edited)));
        // As it was it goes on.
        let before = write(Pendulum::default(), 0..3);
        assert!(before.as_ref().is_ok_and(|written| written.found == 2), "{before:?}");
    }
    trials
}

fn ends<F, M>(study: &dalembert_ensemble::Study<'_, F, M, Pendulum, 1>) -> Ends<f64, 1>
where
    F: Fn(u64) -> Result<(Pendulum, State<f64, 1>), dalembert::StepError> + Sync,
    M: dalembert_ensemble::Stepping<Pendulum, 1>,
{
    study.ends(0..4 * OF_PART).unwrap()
}
