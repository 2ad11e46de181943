//! What is asked for and what is returned have names: a user keeps both in types of their own, and writes
//! functions of them.

use dalembert::rules::SolvedForVelocity;
use dalembert::step::{BoundedStep, ClosedForm, LinearizedStep, StepTaken};
use dalembert::tolerance::{GuardedTrajectory, OffersMethods, TimedRequest};
use dalembert::{Discretise, Midpoint, State, StepError, rayleigh_system};

#[rayleigh_system(parameters = [k])]
fn spring(q: [f64; 1], v: [f64; 1], k: f64) -> f64 {
    0.5 * v[0] * v[0] - 0.5 * k * q[0] * q[0]
}

const START: State<f64, 1> =
    State { q: dalembert::nalgebra::Vector1::new(1.0), p: dalembert::nalgebra::Vector1::new(0.0) };
const H: f64 = 0.1;

type Offered = <Spring as OffersMethods<1>>::Methods;

struct Bench<'a> {
    asked: TimedRequest<'a, Spring, Offered>,
    run: GuardedTrajectory<'a, Spring, Offered, 1>,
    step: StepTaken<'a, Spring, Midpoint, 1>,
    with_a: LinearizedStep<f64, 1>,
}

fn bounded<R: SolvedForVelocity>(system: &Spring, rule: R) -> Result<BoundedStep<f64, 1>, StepError>
where
    Spring: ClosedForm<R, 1, Scalar = f64>,
{
    system.by(rule, H).step_within(&START, 2)
}

#[test]
fn results_are_kept_in_a_struct_and_steps_bounded_for_any_rule_that_can() {
    let spring = Spring { k: 4.0 };
    let asked = spring.to_error(1e-6).until(1.0);
    let mut bench = Bench {
        asked,
        run: asked.run(START).unwrap(),
        step: spring.by(Midpoint, H).linearized(&START).unwrap(),
        with_a: spring.by(Midpoint, H).linearized_step(&START).unwrap(),
    };
    bench.run.next().unwrap().unwrap();
    assert_eq!(bench.asked.choice(&START).unwrap().step_size(), bench.run.time());

    let within = bounded(&spring, Midpoint).unwrap();
    assert!(within.converged);
    assert_eq!(bench.step.step().state, within.step.state);
    assert_eq!(bench.with_a, (*bench.step.step(), bench.step.by_state().unwrap()));
    // The midpoint rule's q1 = (1 − x)/(1 + x), x = h²k/4, by k.
    let x = 0.25 * H * H * spring.k;
    let expected = -0.5 * H * H / ((1.0 + x) * (1.0 + x));
    assert!((bench.step.by_parameters().unwrap().q[0] - expected).abs() < 1e-15);
}
