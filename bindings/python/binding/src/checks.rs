//! Checks of a system by one of its rules: its symmetries, and where its energy goes.

use dalembert::nalgebra::{SMatrix, SVector};
use dalembert::noether::{Contribution, Generator};
use dalembert::run::Stop;
use dalembert::samples::{SampleError, segments};
use dalembert::step::{Discrete, ForceWork};
use dalembert::{Discretise, EnergyLedger, Lagrangian, State};

use crate::motion::Given;
use crate::record::Failure;
use crate::refusal::Refusal;
use crate::system::System;
use crate::watch::Watch;

/// A generator ξ(q) = A q + b of a group.
#[derive(Clone, Debug)]
pub struct Affine {
    /// The name of the generator in reports.
    pub name: String,
    /// A, row by row.
    pub linear: Vec<f64>,
    /// b.
    pub constant: Vec<f64>,
    /// Whether it is left out where it leaves the constraints, and not an error.
    pub is_optional: bool,
}

/// Where symmetries are looked for: segments that begin in a box.
#[derive(Clone, Copy, Debug)]
pub struct Region<'a> {
    /// Lower ends.
    pub low: &'a [f64],
    /// Upper ends.
    pub high: &'a [f64],
    /// Largest displacement of each coordinate.
    pub reach: &'a [f64],
    /// How many segments.
    pub samples: usize,
}

/// The findings on a generator.
#[derive(Clone, Debug)]
pub struct Symmetry {
    /// Its name.
    pub generator: String,
    /// Whether it is a symmetry of L_d.
    pub is_symmetry_of_lagrangian: bool,
    /// Whether the discrete force does work along it.
    pub force_does_work: bool,
    /// Whether its momentum is conserved.
    pub is_conserved: bool,
    /// Whether the momenta are those of L_d and f_d.
    pub is_consistent: bool,
    /// ξ(L_d), f_d(ξ) and their sum: the largest value, beside what counts as zero, and what counts.
    pub findings: [[f64; 2]; 3],
    /// The report in words.
    pub text: String,
}

/// Where the energy of a run went.
#[derive(Clone, Copy, Debug)]
pub struct Ledger {
    /// E at the end less E at the start.
    pub change: f64,
    /// Energy that friction took.
    pub dissipated: f64,
    /// Energy that the general force brought.
    pub work: f64,
    /// The largest remainder of a step, by size.
    pub largest: f64,
    /// Energy that the method added: change + dissipated − work.
    pub remainder: f64,
}

/// The checks of a system by one rule.
pub trait Checks<S: System<N>, const N: usize>: Send + Sync {
    /// The effect of each generator on L_d, on the force and on its momentum, at samples that are moved onto
    /// the constraints.
    ///
    /// # Errors
    /// [`Refusal::NotHolonomic`]; that the samples say nothing, or the watcher.
    fn symmetries(
        &self,
        fields: &S::Fields,
        given: Given<'_>,
        h: f64,
        generators: &[Affine],
        region: &Region<'_>,
        watch: &Watch<'_>,
    ) -> Result<Vec<Symmetry>, Refusal>;

    /// Where the energy of a run of so many steps went.
    ///
    /// # Errors
    /// The step that failed, or the watcher.
    fn ledger(
        &self,
        fields: &S::Fields,
        given: Given<'_>,
        h: f64,
        start: &State<f64, N>,
        steps: u64,
        watch: &Watch<'_>,
    ) -> Result<Ledger, Refusal>;
}

/// A rule.
pub struct ByRule<M>(pub M);

impl<S, M, const N: usize> Checks<S, N> for ByRule<M>
where
    S: System<N>,
    for<'a> S::View<'a>: Discrete<M, N> + ForceWork<M, N>,
    M: Copy + Send + Sync + 'static,
{
    fn symmetries(
        &self,
        fields: &S::Fields,
        given: Given<'_>,
        h: f64,
        generators: &[Affine],
        region: &Region<'_>,
        watch: &Watch<'_>,
    ) -> Result<Vec<Symmetry>, Refusal> {
        let system = S::view(fields, given.inputs, given.time);
        let is_called_off = || watch.is_called_off();
        let by = system.by(self.0, h).stopped_by(Stop::when(&is_called_off));
        let noether = by.noether_if_holonomic().ok_or(Refusal::NotHolonomic)?;
        let vector = SVector::<f64, N>::from_column_slice;
        let Region { low, high, reach, samples } = *region;
        let segments = by.on_constraints(&segments(vector(low), vector(high), vector(reach), samples))?;
        let judged = |(number, Affine { name, linear, constant, is_optional }): (usize, &Affine)| {
            let generator = Generator::affine(
                name.clone(),
                SMatrix::<f64, N, N>::from_row_slice(linear),
                vector(constant),
            );
            let found = match noether.symmetry(&generator, &segments) {
                Err(SampleError::LeavesConstraints { .. }) if *is_optional => return Ok(None),
                Err(SampleError::LeavesConstraints { index, share, .. }) => {
                    return Err(SampleError::LeavesConstraints { generator: number, index, share }.into());
                }
                found => found?,
            };
            let pair = |finding: &Contribution<N>| [finding.value, finding.tolerance];
            Ok(Some(Symmetry {
                generator: found.generator.clone(),
                is_symmetry_of_lagrangian: found.is_symmetry_of_lagrangian(),
                force_does_work: found.force_does_work(),
                is_conserved: found.is_conserved(),
                is_consistent: found.is_consistent(),
                findings: [pair(&found.lagrangian), pair(&found.force), pair(&found.defect)],
                text: found.to_string(),
            }))
        };
        generators.iter().enumerate().map(judged).filter_map(Result::transpose).collect()
    }

    fn ledger(
        &self,
        fields: &S::Fields,
        given: Given<'_>,
        h: f64,
        start: &State<f64, N>,
        steps: u64,
        watch: &Watch<'_>,
    ) -> Result<Ledger, Refusal> {
        let system = S::view(fields, given.inputs, given.time);
        ledger((&system, self.0, h), given.time, start, steps, watch)
    }
}

/// Where the energy of a run of so many steps went, which begins at `origin`.
fn ledger<L, M, const N: usize>(
    (system, method, h): (&L, M, f64),
    origin: f64,
    start: &State<f64, N>,
    steps: u64,
    watch: &Watch<'_>,
) -> Result<Ledger, Refusal>
where
    L: Discrete<M, N> + ForceWork<M, N> + Lagrangian<N, Scalar = f64>,
    M: Copy,
{
    let by = system.by(method, h);
    let (mut total, mut largest) = (EnergyLedger::default(), 0.0_f64);
    let (mut run, mut state) = (by.run(*start), *start);
    for step in 0..steps {
        if step.is_multiple_of(Stop::STRIDE) && watch.pass(Some((step, steps))).is_break() {
            return Err(Refusal::CalledOff);
        }
        let time = run.time();
        let of_step = |state: &State<f64, N>, next: &State<f64, N>| {
            system.later(time, |system| system.by(method, h).ledger(state, next))
        };
        let failed = |error| {
            let state = [state.q, state.p].map(|vector| vector.as_slice().to_vec());
            Refusal::Start(Failure { error, step, time: origin + time, state })
        };
        let Some(next) = run.next() else { break };
        let next = next.map_err(failed)?.state;
        let ledger = of_step(&state, &next).map_err(failed)?;
        largest = largest.max(ledger.remainder().abs());
        total += ledger;
        state = next;
    }
    let EnergyLedger { change, dissipated, work } = total;
    Ok(Ledger { change, dissipated, work, largest, remainder: total.remainder() })
}
