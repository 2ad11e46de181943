//! Directional derivatives.
//!
//! A communication step is k steps with one input: from A_i, B_i and C_i of each, by state, input and
//! parameters, the differential (dq, dp) is carried from the beginning of the communication step to its end,
//!
//! ```text
//! d ← A_i d + B_i du + C_i dθ.
//! ```
//!
//! At the end dv = ∂v/∂q dq + ∂v/∂p dp, and, as ∂E/∂q = −∂L/∂q and ∂E/∂p = v at constant p and q, dE = v·dp −
//! ∂L/∂q·dq.

use dalembert::nalgebra::SVector;
use dalembert::step::PhaseMatrix;
use dalembert::system::Scalar;
use dalembert::{Lagrangian, State, StepError};
use dalembert_face::{Described, Interface, by_state};

use super::CoSimulation;
use crate::model::Model;
use crate::refusal::{Mode, Refusal};
use crate::variables::{Place, Variable};

/// Differentials of what variables are known by.
struct Differential<I: Interface<N>, const N: usize> {
    q: SVector<I::Scalar, N>,
    v: SVector<I::Scalar, N>,
    p: SVector<I::Scalar, N>,
    input: Vec<I::Scalar>,
    parameters: Vec<I::Scalar>,
}

/// Σ ∂unknown/∂known seed, for each unknown.
pub fn along<I: Interface<N>, const N: usize>(
    of: &CoSimulation<I, N>,
    unknowns: &[u32],
    knowns: &[u32],
    seed: &[f64],
) -> Result<Vec<f64>, Refusal> {
    if knowns.len() != seed.len() {
        return Err(Refusal::Lengths { asked: knowns.len(), given: seed.len() });
    }
    let variables = |references: &[u32]| -> Result<Vec<&Variable>, Refusal> {
        references.iter().map(|&reference| of.variable(reference)).collect()
    };
    let (unknowns, knowns) = (variables(unknowns)?, variables(knowns)?);
    for known in &knowns {
        for unknown in &unknowns {
            if !is_derived(of, unknown, known) {
                let (unknown, known) = (unknown.name.clone(), known.name.clone());
                return Err(Refusal::NoDerivative { unknown, known });
            }
        }
    }
    let given = sown(of, &knowns, seed);
    let failed = |error| Refusal::Step { error, time: of.time() };
    let (state, v) = of.motion()?;
    let (dq, dv, dp) = match of.mode {
        Mode::Initialization => {
            let to_momentum = PhaseMatrix::from_velocity(&of.undriven(), &state.q, &v);
            (given.q, given.v, to_momentum.p_by_q * given.q + to_momentum.p_by_p * given.v)
        }
        Mode::Step => {
            let State { q: dq, p: dp } = carried(of, &given)?;
            let to_velocity = PhaseMatrix::to_velocity(&of.undriven(), &state.q, &v).map_err(failed)?;
            (dq, to_velocity.p_by_q * dq + to_velocity.p_by_p * dp, dp)
        }
        other => return Err(Refusal::NotNow(other)),
    };
    let by_energy = |State { q, .. }: &State<I::Scalar, N>| {
        v.dot(&dp) - of.undriven().lagrangian_gradient(q, &v).d1.dot(&dq)
    };
    let sensitivities: Vec<f64> = unknowns
        .iter()
        .map(|unknown| match unknown.place {
            Place::Configuration(i) => dq[i].widen(),
            Place::Velocity(i) => dv[i].widen(),
            Place::Momentum(i) => dp[i].widen(),
            _ => by_energy(&state).widen(),
        })
        .collect();
    match sensitivities.iter().position(|value| !value.is_finite()) {
        Some(index) => {
            Err(failed(StepError::NonFinite { quantity: dalembert::step::Quantity::Derivatives, index }))
        }
        None => Ok(sensitivities),
    }
}

/// Where a parameter stands among those that the system is derived by.
fn listed<I: Interface<N>, const N: usize>(known: &Variable) -> Option<usize> {
    I::System::PARAMETERS.iter().position(|name| *name == known.name)
}

fn is_derived<I: Interface<N>, const N: usize>(
    of: &CoSimulation<I, N>,
    unknown: &Variable,
    known: &Variable,
) -> bool {
    use Place::{Configuration, Energy, Input, Momentum, Parameter, Velocity};
    match (of.mode, unknown.place, known.place) {
        // On constraints q and v are guesses, which the nearest state stands in for.
        (Mode::Initialization, Momentum(_) | Energy, Configuration(_) | Velocity(_)) => {
            I::System::CONSTRAINTS == 0
        }
        (Mode::Initialization, ..) => false,
        // v and E hang on the parameters at constant (q, p) too.
        (_, Configuration(_) | Momentum(_), Parameter { .. }) => listed::<I, N>(known).is_some(),
        (
            _,
            Configuration(_) | Momentum(_) | Velocity(_) | Energy,
            Input(_) | Configuration(_) | Momentum(_),
        ) => true,
        _ => false,
    }
}

fn sown<I: Interface<N>, const N: usize>(
    of: &CoSimulation<I, N>,
    knowns: &[&Variable],
    seed: &[f64],
) -> Differential<I, N> {
    let zero = I::Scalar::constant(0.0);
    let nothing = SVector::<I::Scalar, N>::from_element(zero);
    let mut given = Differential {
        q: nothing,
        v: nothing,
        p: nothing,
        input: vec![zero; of.input.len()],
        parameters: vec![zero; I::System::PARAMETERS.len()],
    };
    for (known, &seed) in knowns.iter().zip(seed) {
        let into = match known.place {
            Place::Configuration(i) => &mut given.q[i],
            Place::Velocity(i) => &mut given.v[i],
            Place::Momentum(i) => &mut given.p[i],
            Place::Input(i) => &mut given.input[i],
            _ => match listed::<I, N>(known) {
                Some(i) => &mut given.parameters[i],
                None => continue,
            },
        };
        *into += I::Scalar::constant(seed);
    }
    given
}

/// (dq, dp) at the end of the last communication step.
fn carried<I: Interface<N>, const N: usize>(
    of: &CoSimulation<I, N>,
    given: &Differential<I, N>,
) -> Result<State<I::Scalar, N>, Refusal> {
    let last = of.last.as_ref().ok_or(Refusal::NoStep)?;
    let (mut dq, mut dp) = (given.q, given.p);
    let mut run = last.before.clone();
    for length in last.lengths.each() {
        if length != run.step_size() {
            run.change_step_size(length);
        }
        let time = of.start_time + run.time();
        let failed = |error| Refusal::Step { error, time };
        let (input, now) = CoSimulation::<I, N>::given(&last.input, time);
        let view = I::view(&last.system, input, now);
        let taken = run.advance_linearized(&view).map_err(failed)?;
        let by_state = by_state(&taken.by_state().map_err(failed)?);
        let by_input = I::by_input(&taken).map_err(failed)?;
        let by_parameters = I::by_parameters(&taken).map_err(failed)?;
        let columns = by_state.as_flattened().iter().chain(by_input.as_ref()).chain(by_parameters.as_ref());
        let along = dq.iter().chain(&dp).chain(&given.input).chain(&given.parameters).copied();
        let zero = SVector::from_element(I::Scalar::constant(0.0));
        let sum = |[q, p]: [SVector<_, N>; 2], (by, along): (&[SVector<_, N>; 2], I::Scalar)| {
            [q + by[0] * along, p + by[1] * along]
        };
        [dq, dp] = columns.zip(along.collect::<Vec<_>>()).fold([zero; 2], sum);
    }
    Ok(State { q: dq, p: dp })
}
