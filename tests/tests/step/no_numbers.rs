//! NaN among what a step is given: the error says what it is of, and asks for no smaller step.

use dalembert::nalgebra::{SVector, vector};
use dalembert::step::Quantity;
use dalembert::{
    Composition, Discretise, Fitted, Gauss, Lagrangian, Midpoint, Splitting, State, StepError, Trapezoidal,
    rayleigh_system,
};

#[derive(Clone, Copy)]
struct Arm {
    m: f64,
    c: [f64; 2],
    gain: f64,
    limit: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
impl Arm {
    const RATE: f64 = 2.0;

    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * self.m * v[0] * v[0] + q[0].cos()
    }

    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.5 * (self.c[0] + self.c[1] * v[0] * v[0]) * v[0] * v[0]
    }

    fn force(&self, q: [f64; 1], _v: [f64; 1], u: [f64; 2], t: f64) -> [f64; 1] {
        let push = u[0] * q[0].cos() + u[1] + (Self::RATE * t).sin();
        [self.gain * if push < self.limit { push } else { self.limit }]
    }
}

/// Derivatives by dual numbers: fields are not known by name.
#[rayleigh_system(rule = midpoint, derivatives = num_dual)]
fn by_duals(q: [f64; 1], v: [f64; 1], k: f64) -> f64 {
    0.5 * v[0] * v[0] - 0.5 * k * q[0] * q[0]
}

/// Explicit, linear, by splittings and by the fitted rule.
#[rayleigh_system(rule = [trapezoidal, fitted])]
fn linear(q: [f64; 2], v: [f64; 2], m: f64, k: f64, c: f64) -> (f64, f64) {
    (
        0.5 * m * (v[0] * v[0] + v[1] * v[1]) - 0.5 * k * (q[0] * q[0] + q[1] * q[1]),
        0.5 * c * (v[0] * v[0] + v[1] * v[1]),
    )
}

const ARM: Arm = Arm { m: 1.0, c: [0.1, 0.2], gain: 1.0, limit: f64::INFINITY };
const NAN: f64 = f64::NAN;

fn named<T: std::fmt::Debug>(found: Result<T, StepError>, quantity: Quantity, index: usize, word: &str) {
    let error = found.unwrap_err();
    assert_eq!(error, StepError::NonFinite { quantity, index });
    let text = error.to_string();
    assert!(text.contains(word) && !text.contains("smaller step"), "{text}");
}

/// The error of a step by each method, with what is given beside the state.
macro_rules! by_each {
    ($system:expr, $state:expr, [$($method:expr),*], |$found:ident| $check:expr) => {$(
        let $found = $system.by($method, 0.1).step(&$state).map(|step| step.state);
        $check;
        let $found = $system.by($method, 0.1).run($state).next().unwrap().map(|step| step.state);
        $check;
    )*};
}

#[test]
fn an_input_or_a_time_that_is_no_number_is_named() {
    let state = State { q: vector![0.3], p: vector![0.1] };
    assert!(ARM.driven([0.1, 0.2], 0.3).by(Midpoint, 0.1).step(&state).is_ok());
    for (index, u) in
        [[NAN, 0.0], [0.0, NAN], [f64::INFINITY, NAN], [0.0, f64::NEG_INFINITY]].into_iter().enumerate()
    {
        let index = [0, 1, 0, 1][index];
        // A limit that is none is infinite, and to blame for nothing.
        by_each!(ARM.driven(u, 0.3), state, [Midpoint, Trapezoidal, Gauss::<2>], |found| {
            named(found, Quantity::InputEntry, index, &format!("entry {index} of the input u"));
        });
        let bounded = ARM.driven(u, 0.3).by(Midpoint, 0.1).step_within(&state, 4);
        named(bounded, Quantity::InputEntry, index, "the input u");
    }
    by_each!(ARM.driven([0.1, 0.2], NAN), state, [Midpoint, Trapezoidal, Gauss::<2>], |found| {
        named(found, Quantity::Time, 0, "the time given");
    });
}

#[test]
fn a_field_that_is_nan_is_named() {
    let state = State { q: vector![0.3], p: vector![0.1] };
    let broken: [(Arm, &str); 4] = [
        (Arm { m: NAN, ..ARM }, "m"),
        (Arm { c: [NAN, 0.1], ..ARM }, "c[0]"),
        (Arm { c: [0.0, NAN], ..ARM }, "c[1]"),
        (Arm { gain: NAN, ..ARM }, "gain"),
    ];
    for (arm, name) in broken {
        let (quantity, text) = (Quantity::Field { name }, format!("`{name}` of the system is NaN"));
        by_each!(arm.driven([0.1, 0.2], 0.3), state, [Midpoint, Trapezoidal, Gauss::<2>], |found| {
            named(found, quantity, 0, &text);
        });
    }
    named(
        State::from_velocity(&Arm { m: NAN, ..ARM }, [0.3], [0.1]),
        Quantity::Field { name: "m" },
        0,
        "`m`",
    );
    let state = State { q: vector![0.3, 0.1], p: vector![0.1, 0.2] };
    const LINEAR: Linear = Linear { m: 1.0, k: 1.0, c: 0.1 };
    for (system, name) in [
        (Linear { k: NAN, ..LINEAR }, "k"),
        (Linear { m: NAN, ..LINEAR }, "m"),
        (Linear { c: NAN, ..LINEAR }, "c"),
    ] {
        let quantity = Quantity::Field { name };
        by_each!(
            system,
            state,
            [Trapezoidal, Fitted, Splitting::blanes_moan_4(), Composition::kahan_li_6(Trapezoidal)],
            |found| {
                named(found, quantity, 0, name);
            }
        );
    }
}

/// What is not named is asked for before all else.
#[test]
fn where_no_field_can_be_named_they_are_asked_for_first() {
    let system = ByDuals { k: NAN };
    assert_eq!(system.non_finite_value(), None);
    let state = State { q: vector![0.3], p: vector![0.1] };
    let text = system.by(Midpoint, 0.1).step(&state).unwrap_err().to_string();
    let [fields, roots, step] =
        ["fields of the system and its input", "√s", "smaller step"].map(|word| text.find(word));
    assert!(fields < roots && roots < step && fields.is_some(), "{text}");
}

/// A state that is no number is told so, and one that a step leads to.
#[test]
fn a_state_given_is_told_from_one_that_is_reached() {
    let state = State { q: vector![NAN], p: vector![0.1] };
    let given = ARM.driven([0.1, 0.2], 0.3).by(Midpoint, 0.1).step(&state);
    named(given.map(|step| step.state), Quantity::Configuration, 0, "the configuration given is NaN");
    let fast = State { q: SVector::from([1e308]), p: SVector::from([1e308]) };
    let error = ARM.driven([0.1, 0.2], 0.3).by(Trapezoidal, 1e5).step(&fast).unwrap_err();
    let text = error.to_string();
    assert!(!text.contains("given is NaN") && text.contains("smaller step"), "{text}");
}
