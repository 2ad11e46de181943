//! A model that was edited while its run was saved: the run does not go on with another.

use std::{env, fmt, fs};

use dalembert::{Midpoint, State, rayleigh_system};
use dalembert_examples::saved_run::{SavedRun, Schedule};
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

use crate::folder;

/// A pendulum as it was written first, and as edited: another from an angle or a speed on.
#[derive(Clone, Copy, Default)]
struct Pendulum {
    potential: Edit,
    friction: Edit,
    force: Edit,
}

/// By how much, and from where on.
#[derive(Clone, Copy, Default)]
struct Edit {
    by: f64,
    from: f64,
}

/// An edit changes neither a type nor what it prints.
impl fmt::Debug for Pendulum {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Pendulum")
    }
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

/// The run of 16 steps before the edit shows nothing: it moves from 0.1 by less than 0.02 at a speed of less
/// than 0.2.
#[test]
fn a_model_that_was_edited_does_not_go_on() {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let go = |system: &Pendulum, folder: &std::path::Path, end: u64| {
        let schedule = Schedule { row: 10, rows_to_checkpoint: 10, end };
        let start = State { q: [0.1].into(), p: [0.1].into() };
        let row = |time: f64, state: &State<f64, 1>| format!("{time},{}", state.q[0]);
        SavedRun::in_folder(folder).run((system, Midpoint), (0.01, start), schedule, row)
    };
    let mut edits = [0; 3];
    let tries = env::var("FAULTS").map_or(24, |tries| tries.parse().unwrap());
    for _ in 0..tries {
        let mut within = |from: f64, to: f64| random.random_range(from..to);
        let (which, by) = (within(0.0, 3.0) as usize, within(0.01, 1.0));
        let mut edited = Pendulum::default();
        match which {
            0 => edited.potential = Edit { by, from: within(0.13, 1.0) },
            1 => edited.friction = Edit { by, from: within(0.2, 1.0) },
            _ => edited.force = Edit { by, from: within(0.13, 3.0) },
        }
        let folder = folder("edited");
        let end = go(&Pendulum::default(), &folder, 200).unwrap();
        let error = go(&edited, &folder, 400).unwrap_err();
        assert!(error.to_string().contains("holds another run"), "{error}");
        edits[which] += 1;
        // The control: unedited it goes on, and the edit shows in no step so far.
        assert!(go(&Pendulum::default(), &folder, 400).is_ok());
        fs::remove_dir_all(&folder).unwrap();
        let anew = go(&edited, &folder, 16).unwrap();
        fs::remove_dir_all(&folder).unwrap();
        assert_eq!(anew, go(&Pendulum::default(), &folder, 16).unwrap());
        fs::remove_dir_all(&folder).unwrap();
        assert!(end.q[0].is_finite());
    }
    println!("edits of L, R and f: {edits:?}");
    assert!(edits.iter().all(|&count| count > 0), "{edits:?}");
}
