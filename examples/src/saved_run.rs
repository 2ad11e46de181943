//! A run that can be interrupted at any moment and goes on from where it was, bit by bit as if nothing had
//! happened.
//!
//! Its folder holds `rows.csv`, one row each time it is looked at, and `checkpoint.json`, written after every
//! few rows: which run this is, where it stands, and what the rows were by then. Rows after the checkpoint
//! are computed again; a row that broke off is cut away. What does not fit together, or is another run's, is
//! refused.

mod files;

use std::any::type_name;
use std::fmt::Debug;
use std::path::PathBuf;

use anyhow::{Context, Result, bail, ensure};
use dalembert::nalgebra::SVector;
use dalembert::system::{ActingForce, sampled_forces};
use dalembert::{Checkpoint, Discrete, Discretise, State, Trajectory};

use files::{Digest, Files, ROWS, Saved};

/// When a run looks at its state, saves it, and ends; in steps.
#[derive(Clone, Copy, Debug)]
pub struct Schedule {
    /// Steps to a row.
    pub row: u64,
    /// Rows to a checkpoint.
    pub rows_to_checkpoint: u64,
    /// Steps of the run, no more and no fewer: the last row may be of fewer steps than the others.
    pub end: u64,
}

/// The files of a run.
pub struct SavedRun {
    folder: PathBuf,
}

impl SavedRun {
    /// The run in `folder`, which need not exist yet.
    pub fn in_folder(folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into() }
    }

    /// The file of rows.
    pub fn rows(&self) -> PathBuf {
        self.folder.join(ROWS)
    }

    /// Runs to the end of the schedule, from the checkpoint if there is one. `row` writes what a row says of
    /// a time and a state.
    ///
    /// Every checkpoint makes the run forget what its rule remembers; since they come after fixed numbers of
    /// steps, neither how often nor when a run was interrupted shows in any bit. A run that was kept goes
    /// on to a later end as well.
    ///
    /// # Errors
    /// A file cannot be read or written, or is not this run's: of another system, rule, step size, start or
    /// schedule, or changed since. A step fails. The files then hold the run as far as the error says.
    pub fn run<L, R, const N: usize>(
        &self,
        (system, rule): (&L, R),
        (h, start): (f64, State<f64, N>),
        schedule: Schedule,
        row: impl Fn(f64, &State<f64, N>) -> String,
    ) -> Result<State<f64, N>>
    where
        L: Discrete<R, N, Scalar = f64> + ActingForce<N> + Debug,
        R: Copy,
    {
        let Schedule { row: to_row, rows_to_checkpoint, end } = schedule;
        let to_checkpoint = to_row.checked_mul(rows_to_checkpoint).filter(|steps| *steps > 0);
        let to_checkpoint =
            to_checkpoint.with_context(|| format!("there is no such schedule: {schedule:?}"))?;
        let identity = identity((system, rule), (h, start), schedule, &row(0.0, &start));

        let mut files = Files::open(&self.folder)?;
        let at = match files.saved::<N>()? {
            None => Checkpoint::new(h, start),
            Some(Saved { identity: of, run, .. }) => {
                let folder = self.folder.display();
                ensure!(
                    of == identity,
                    "{folder} holds another run; remove it, or take another folder\n  there: {of}\n  here:  {identity}"
                );
                if run.steps > end {
                    bail!(
                        "{folder} holds this run up to step {}, beyond its end at {end}; remove it, or run on",
                        run.steps
                    );
                }
                run
            }
        };
        files.cut_to_checkpoint()?;

        let mut taken = at.steps;
        let mut run = Trajectory::resume(system, rule, at);
        while taken < end {
            let checkpoint = end.min(taken.saturating_add(to_checkpoint));
            while taken < checkpoint {
                let next = checkpoint.min(taken.saturating_add(to_row));
                while taken < next {
                    let step = run.next().context("a run ends with an error alone")?;
                    step.with_context(|| format!("after {taken} steps; {}", files.as_far_as()))?;
                    taken += 1;
                }
                files.append(row(run.time(), run.state()) + "\n")?;
            }
            // An end between two checkpoints has none: a run to a later end has none there either.
            if taken.is_multiple_of(to_checkpoint) {
                files.save(&identity, run.checkpoint())?;
            }
        }
        files.finish()?;
        Ok(*run.state())
    }
}

/// States at which a system is asked for its forces, to tell it from others.
const SAMPLES: usize = 2048;

/// Which run this is, in words. What words do not tell of the system shows in its first steps and in its
/// forces at states and times around the start, and what rows say in the one of the start.
fn identity<L, R, const N: usize>(
    (system, rule): (&L, R),
    (h, start): (f64, State<f64, N>),
    Schedule { row, rows_to_checkpoint, .. }: Schedule,
    first_row: &str,
) -> String
where
    L: Discrete<R, N, Scalar = f64> + ActingForce<N> + Debug,
{
    let mut digest = Digest::default();
    digest.add(first_row.as_bytes());
    for step in system.by(rule, h).run(start).take(16) {
        match step {
            Ok(step) => step
                .state
                .q
                .iter()
                .chain(&step.state.p)
                .for_each(|entry| digest.add(&entry.to_bits().to_le_bytes())),
            Err(error) => digest.add(format!("{error:?}").as_bytes()),
        }
    }
    let around = start.velocity(system).unwrap_or_else(|_| SVector::zeros());
    sampled_forces(system, (&start.q, &around), 6, SAMPLES)
        .for_each(|entry| digest.add(&entry.to_bits().to_le_bytes()));
    format!(
        "{} = {system:?} by {}, h = {h:?}, from q = {:?}, p = {:?}; a row every {row} steps, a checkpoint every {rows_to_checkpoint} rows; \
         first steps and forces {digest}",
        type_name::<L>(),
        type_name::<R>(),
        start.q.as_slice(),
        start.p.as_slice(),
    )
}
