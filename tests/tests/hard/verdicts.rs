//! No step is taken that does not solve its equations: a part of the study of the example `verdicts`, and what it can see.

use dalembert::nalgebra::SVector;
use dalembert::{Discrete, Gauss, Memory, Midpoint, StageHistory, State, Trapezoidal};

#[path = "../../examples/verdicts/study/mod.rs"]
#[allow(dead_code, reason = "the example steps all systems of the study")]
mod study;

use study::equations::{OneStage, gauss, one_stage};
use study::steps::{Job, Tally, study, study_all};
use study::systems::{Exponential, KeplerDrag, LennardJones, Pendulum, Studied, Units};
use study::tableau::Tableau;

const ONE: Units = Units { action: 1.0, length: 1.0, speed: 1.0, rate: 1.0 };

fn state<const N: usize>(q: [f64; N], p: [f64; N]) -> State<f64, N> {
    State { q: q.into(), p: p.into() }
}

#[test]
fn no_step_of_any_rule_violates_its_equations() {
    const JOBS: [Job; 4] = [
        study::<Pendulum, 1, 2, 5>,
        study::<LennardJones, 1, 1, 3>,
        study::<Exponential, 1, 1, 4>,
        study::<KeplerDrag, 3, 1, 2>,
    ];
    let rows = study_all(&JOBS, 500, 2024);
    let sum = rows.iter().flat_map(|(_, _, tallies)| tallies).fold(Tally::NONE, |sum, of| sum.plus(*of));
    assert_eq!(sum.violations, 0, "{sum:?}");
    assert!(sum.asked > 30_000 && sum.taken > sum.asked * 3 / 5 && sum.beyond < sum.taken / 100, "{sum:?}");
}

/// The control: a step that is off by some 10⁻¹² of its velocity is seen, by the equations of each rule.
#[test]
fn a_step_that_is_off_is_seen() {
    let system = Pendulum::new(1.3, 0.2, ONE);
    let start = state([0.7], [0.4]);
    let off = |v: SVector<f64, 1>| v * (1.0 + 1e-12);
    let mut step = Discrete::<Midpoint, 1>::step(&system, &start, 0.3, None).unwrap();
    assert!(!one_stage(OneStage::Midpoint, &system, &start, 0.3, &step).is_violation());
    // Another rule's equations are not those.
    assert!(one_stage(OneStage::Trapezoidal, &system, &start, 0.3, &step).is_violation());
    step.velocity = off(step.velocity);
    assert!(one_stage(OneStage::Midpoint, &system, &start, 0.3, &step).is_violation());
    let mut step = Discrete::<Trapezoidal, 1>::step(&system, &start, 0.3, None).unwrap();
    assert!(!one_stage(OneStage::Trapezoidal, &system, &start, 0.3, &step).is_violation());
    step.state.p *= 1.0 + 1e-12;
    assert!(one_stage(OneStage::Trapezoidal, &system, &start, 0.3, &step).is_violation());
    let mut memory = StageHistory::<f64, 1, 3>::default();
    let step = Memory::<_, Gauss<3>, 1>::advance(&mut memory, &system, &start, 0.3).unwrap();
    let (tableau, mut v) = (Tableau::new(3), memory.velocities());
    assert!(!gauss(&tableau, &system, &start, 0.3, &v, &step.state).is_violation());
    v[1] = off(v[1]);
    assert!(gauss(&tableau, &system, &start, 0.3, &v, &step.state).is_violation());
    // A number that is none is not judged, and that is counted.
    v[1][0] = f64::NAN;
    assert!(gauss(&tableau, &system, &start, 0.3, &v, &step.state).is_beyond);
}

/// The floor of the guess, next to the wall of 10⁶⁰, was taken for that of the root: q1 = 8.35e6, with a last correction of 1.5e7.
#[test]
fn a_wall_at_the_guess_does_not_lower_the_demands() {
    let system = LennardJones::new(1.0, 0.0, ONE);
    let (start, h) = (state([0.891_896_227_692_668_9], [-2.987_401_675_911_929_3]), 0.550_108_962_073_416_6);
    let mut memory = StageHistory::<f64, 1, 1>::default();
    if let Ok(step) = Memory::<_, Gauss<1>, 1>::advance(&mut memory, &system, &start, h) {
        let judged = gauss(&Tableau::new(1), &system, &start, h, &memory.velocities(), &step.state);
        assert!(!judged.is_violation() && step.state.q.amax() < 10.0, "{step:?} {judged:?}");
    }
}

/// A measured rounding that overflows explained any residual: p1 = 2.8e307.
#[test]
fn rounding_that_overflows_explains_no_residual() {
    let system = Exponential::new(3.013_205_946_524_166_7, 0.0, ONE);
    let (start, h) = (state([8.978_349_375_816_547], [-23.327_069_555_445_46]), 20.794_962_731_357_785);
    for (rule, step) in [
        (OneStage::Midpoint, Discrete::<Midpoint, 1>::step(&system, &start, h, None)),
        (OneStage::Trapezoidal, Discrete::<Trapezoidal, 1>::step(&system, &start, h, None)),
    ] {
        if let Ok(step) = step {
            assert!(step.state.p.amax() < 1e6, "{step:?}");
            let judged = one_stage(rule, &system, &start, h, &step);
            assert!(!judged.is_violation() && !judged.is_beyond, "{step:?} {judged:?}");
        }
    }
    // The control: a shorter step is taken.
    assert!(Discrete::<Midpoint, 1>::step(&system, &start, 0.1, None).is_ok());
}
