//! Questions on constraints that have no answer, and errors that say why.

use dalembert::nalgebra::SVector;
use dalembert::step::Quantity;
use dalembert::system::Function;
use dalembert::{Discretise, Midpoint, State, StepError, Trapezoidal, rayleigh_system};

use super::{Spherical, on_the_sphere};

#[test]
fn reactions_are_those_of_the_state_and_the_step_size_of_the_step() -> Result<(), StepError> {
    let (q, v) = on_the_sphere();
    let system = Spherical { c: 0.4 };
    let start = State::from_velocity(&system, q, v)?;
    let (by, coarse) = (system.by(Midpoint, 0.01), system.by(Midpoint, 0.02));
    let (step, long) = (by.step(&start)?, coarse.step(&start)?);
    // Positive control: the question of each step itself has an answer, of all steps of a run.
    let answered: [SVector<f64, 1>; 2] = [by.reactions(&start, &step)?, coarse.reactions(&start, &long)?];
    assert!((answered[0] - answered[1]).amax() < 0.2, "{answered:?}");
    let mut state = start;
    for step in by.run(start).take(2_000) {
        let step = step?;
        let _: SVector<f64, 1> = by.reactions(&state, &step)?;
        state = step.state;
    }
    for (by, step, h, taken) in [(by, long, 0.01, 0.02), (coarse, step, 0.02, 0.01)] {
        let error = by.reactions::<1>(&start, &step).unwrap_err();
        let StepError::OtherStep { h: asked, taken: found } = error else { panic!("{error}") };
        assert!(asked == h && (found - taken).abs() < 1e-15, "{error}");
        assert!(error.to_string().contains("with the step size that it was taken with"), "{error}");
    }
    // A step back, one a millionth longer, and one from another state.
    let slightly = system.by(Midpoint, 0.01 * (1.0 + 1e-6)).step(&start)?;
    let later = by.step(&step.state)?;
    for other in [by.with_step(-0.01).step(&start)?, slightly, later] {
        let error = by.reactions::<1>(&start, &other).unwrap_err();
        assert!(matches!(error, StepError::OtherStep { .. }), "{error}");
    }
    let by = system.by(Trapezoidal, 0.01);
    assert!(by.reactions::<1>(&start, &system.by(Trapezoidal, 0.02).step(&start)?).is_err());
    Ok(())
}

/// A point in a plane, at a distance from the axis.
struct Round {
    length: f64,
}

#[rayleigh_system]
impl Round {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) - 9.81 * q[1]
    }

    fn constraints(&self, q: [f64; 3]) -> [f64; 2] {
        [q[2], (q[0] * q[0] + q[1] * q[1]).sqrt() - self.length]
    }
}

/// The errors of the start, the nearest state and the step from there.
fn said_of(system: &Round, q: [f64; 3], v: [f64; 3]) -> [Option<StepError>; 3] {
    let by_hand = State { q: q.into(), p: v.into() };
    [
        State::from_velocity(system, q, v).err(),
        State::nearest(system, q, v).err(),
        system.by(Midpoint, 0.01).step(&by_hand).err(),
    ]
}

fn is_of_constraint(error: &StepError, index: usize) -> bool {
    matches!(error, StepError::NoDerivative { function: Function::Constraint { index: of }, .. } if *of == index)
}

#[test]
fn a_constraint_without_a_gradient_or_a_value_is_named() {
    // On the axis a distance has no gradient.
    for error in said_of(&Round { length: 0.0 }, [0.0; 3], [0.0; 3]).map(Option::unwrap) {
        assert!(is_of_constraint(&error, 1), "{error}");
        let text = error.to_string();
        assert!(
            text.starts_with("the derivative of constraint 1 by coordinate 0 is NaN or infinite"),
            "{text}"
        );
        assert!(text.contains("√s has none at s = 0, in `(q[0] * q[0] + q[1] * q[1]).sqrt()`"), "{text}");
    }
    let (q, v) = ([0.6, 0.8, 0.0], [0.8, -0.6, 0.0]);
    for error in said_of(&Round { length: f64::INFINITY }, q, v).map(Option::unwrap) {
        assert!(is_of_constraint(&error, 1), "{error}");
    }
    for error in said_of(&Round { length: f64::NAN }, q, v).map(Option::unwrap) {
        let length = Quantity::Field { name: "length" };
        assert!(matches!(error, StepError::NonFinite { quantity, .. } if quantity == length), "{error}");
    }
    // Positive control: of the length that it has the point moves; of another it is off, by the constraint.
    assert_eq!(said_of(&Round { length: 1.0 }, q, v), [None; 3]);
    let [start, _, step] = said_of(&Round { length: 1.1 }, q, v);
    for error in [start.unwrap(), step.unwrap()] {
        assert!(matches!(error, StepError::OffConstraint { constraint: 1, .. }), "{error}");
    }
    // A state that is none is to blame itself.
    let error = said_of(&Round { length: 1.0 }, [f64::NAN, 0.0, 0.0], v)[2].unwrap();
    assert!(matches!(error, StepError::NonFinite { quantity: Quantity::Configuration, .. }), "{error}");
}

/// A bead on y = √x, and a cart whose wheel turns the faster the farther it is.
struct Ending;

#[rayleigh_system]
impl Ending {
    fn lagrangian(&self, q: [f64; 4], v: [f64; 4]) -> f64 {
        let _ = q;
        0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + v[3] * v[3])
    }

    fn constraints(&self, q: [f64; 4]) -> [f64; 1] {
        [q[1] - q[0].sqrt()]
    }

    fn velocity_constraints(&self, q: [f64; 4], v: [f64; 4]) -> [f64; 1] {
        [v[2] - q[2].ln() * v[3]]
    }
}

#[test]
fn a_step_beyond_the_end_of_a_constraint_names_it() -> Result<(), StepError> {
    let step =
        |q: [f64; 4], v: [f64; 4], h: f64| Ending.by(Midpoint, h).step(&State::nearest(&Ending, q, v)?);
    let (rolling, wheel) = ([1.0, 1.0, 2.0, 0.0], [0.0, 0.0, -1.0, -1.0 / 2.0_f64.ln()]);
    for (q, v, index) in [([0.01, 0.1, 2.0, 0.0], [-1.0, -5.0, 0.0, 0.0], 0), (rolling, wheel, 1)] {
        step(q, v, 1e-3)?;
        // The guess of the first iterate is beyond the end.
        let error = step(q, v, 5.0).unwrap_err();
        assert!(is_of_constraint(&error, index), "{error}");
    }
    Ok(())
}
