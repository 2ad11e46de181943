//! False claims of steps by their derivatives, on poisoned derivatives, states, segments and tolerances.

use dalembert::derivative::PhaseMatrix;
use dalembert::nalgebra::vector;
use dalembert::rayleigh::modified::ModifiedLinearSystem;
use dalembert::rayleigh::{ConformalStep, NodeSteps, RayleighEquation, RayleighStep};
use dalembert::samples::{Pair, segments};
use dalembert::{Discretise, Midpoint, State, Trapezoidal, rayleigh_system};

/// Linear, and nothing that is asked of it holds: friction that drives, and unevenly; a force that
/// circulates.
#[derive(Clone, Copy)]
struct Driven {
    friction: [f64; 2],
    circulating: f64,
    k: [f64; 3],
}

#[rayleigh_system(rule = trapezoidal)]
impl Driven {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let [a, b, c] = self.k;
        0.5 * (v[0] * v[0] + 1.3 * v[1] * v[1])
            - 0.5 * (a * q[0] * q[0] + 2.0 * b * q[0] * q[1] + c * q[1] * q[1])
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * (self.friction[0] * v[0] * v[0] + self.friction[1] * v[1] * v[1])
    }

    fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        let s = self.circulating;
        [s * (q[1] + 0.6 * v[1]), -s * (q[0] + 0.6 * v[0])]
    }
}

const WRONG: Driven = Driven { friction: [-0.9, -0.2], circulating: 0.7, k: [1.0, 0.4, 2.0] };
const RIGHT: Driven = Driven { friction: [0.2, 0.26], circulating: 0.0, ..WRONG };
const H: f64 = 0.3;

const POISON: [f64; 10] =
    [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, -1e200, 1e160, 1e80, 5e-324, 1e-200, -1e-160];

type Derivative = PhaseMatrix<f64, 2>;

fn states() -> [State<f64, 2>; 2] {
    [
        State { q: vector![0.3, -0.2], p: vector![0.1, 0.4] },
        State { q: vector![-0.5, 0.1], p: vector![0.2, -0.6] },
    ]
}

fn derivative(system: &Driven, h: f64) -> Derivative {
    system.by(Trapezoidal, h).linearized_step(&states()[0]).unwrap().1
}

/// Names and answers. Errors are no yes.
fn of_derivatives(derivatives: &[Derivative], h: f64, relative: Option<f64>) -> Vec<(&'static str, bool)> {
    let rayleigh = RayleighStep::of(derivatives, relative);
    let conformal = ConformalStep::of(derivatives, relative);
    let nodes: Vec<_> =
        derivatives.iter().map(|&before| NodeSteps { before, after: derivatives[0] }).collect();
    let equation = RayleighEquation::of(&nodes, relative);
    let mut answers = vec![
        ("equation, is_rayleigh", equation.is_ok_and(|found| found.is_rayleigh())),
        ("equation, in words", equation.is_ok_and(|found| found.to_string().starts_with("an equation"))),
        ("is_rayleigh", rayleigh.is_ok_and(|found| found.is_rayleigh())),
        ("a Rayleigh step", rayleigh.is_ok_and(|found| found.to_string().contains("a Rayleigh step"))),
        ("is_conformal", conformal.is_ok_and(|found| found.is_conformal())),
    ];
    for derivative in derivatives {
        let modified = ModifiedLinearSystem::of(derivative, h, relative);
        answers.push(("modified, is_rayleigh", modified.is_ok_and(|found| found.is_rayleigh())));
        answers.push(("modified, is_dissipative", modified.is_ok_and(|found| found.is_dissipative())));
    }
    answers
}

fn yes(answers: &[(&'static str, bool)]) -> Vec<&'static str> {
    answers.iter().filter(|(_, yes)| *yes).map(|(name, _)| *name).collect()
}

#[test]
fn poisoned_derivatives_get_no_yes() {
    let (right, wrong) = (derivative(&RIGHT, H), derivative(&WRONG, H));
    // Positive control, on both sides.
    assert_eq!(yes(&of_derivatives(&[right], H, None)).len(), 7);
    assert!(yes(&of_derivatives(&[wrong], H, None)).is_empty());
    assert!(ModifiedLinearSystem::of(&wrong, H, None).is_ok());
    let none = of_derivatives(&[], H, None);
    assert!(yes(&none).is_empty());

    let mut tried = 0;
    for poison in POISON {
        for block in 0..4 {
            for entry in 0..4 {
                let mut one = wrong;
                let blocks = [&mut one.q_by_q, &mut one.q_by_p, &mut one.p_by_q, &mut one.p_by_p];
                blocks.into_iter().nth(block).unwrap()[entry] = poison;
                for derivatives in [vec![one], vec![wrong, one], vec![one, wrong]] {
                    let found = yes(&of_derivatives(&derivatives, H, None));
                    assert!(found.is_empty(), "{poison:e} at {block}, {entry}: {found:?}, {one:?}");
                    tried += 1;
                }
                // Beside one of which all holds: what is NaN, infinite or lost in its neighbours says
                // nothing.
                let mut one = right;
                let blocks = [&mut one.q_by_q, &mut one.q_by_p, &mut one.p_by_q, &mut one.p_by_p];
                blocks.into_iter().nth(block).unwrap()[entry] = poison;
                if !poison.is_finite() {
                    assert!(yes(&of_derivatives(&[one], H, None)).is_empty(), "{poison} at {block}, {entry}");
                }
            }
        }
    }
    println!("{tried} poisoned derivatives");
}

#[test]
fn tolerances_and_step_sizes_that_say_nothing_get_no_yes() {
    for relative in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 1.0, 2.0, 1e300, f64::MAX] {
        for system in [RIGHT, WRONG] {
            let found = yes(&of_derivatives(&[derivative(&system, H)], H, Some(relative)));
            assert!(found.is_empty(), "{relative:e}: {found:?}");
        }
    }
    for h in [0.0, -0.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 5e-324, 1e-310, 1e200, f64::MAX] {
        let found = yes(&of_derivatives(&[derivative(&WRONG, H)], h, None));
        assert!(found.is_empty(), "{h:e}: {found:?}");
        let by = WRONG.by(Trapezoidal, h);
        assert!(!by.rayleigh_step(&states()).is_ok_and(|found| found.is_rayleigh()), "{h:e}");
        assert!(!by.rayleigh_equation(&states()).is_ok_and(|found| found.is_rayleigh()), "{h:e}");
        assert!(!by.conformal_step(&states()).is_ok_and(|found| found.is_conformal()), "{h:e}");
        assert!(by.conformal_hamilton_jacobi(&states()).is_err(), "{h:e}");
        let modified = by.modified_linear_system(&states());
        assert!(!modified.is_ok_and(|found| found.is_rayleigh() || found.is_dissipative()), "{h:e}");
    }
}

#[test]
fn poisoned_states_get_no_yes() {
    for system in [RIGHT, WRONG] {
        let by = system.by(Trapezoidal, H);
        let answers = |states: &[State<f64, 2>]| {
            [
                by.rayleigh_step(states).is_ok_and(|found| found.is_rayleigh()),
                by.rayleigh_equation(states).is_ok_and(|found| found.is_rayleigh()),
                by.conformal_step(states).is_ok_and(|found| found.is_conformal()),
                by.conformal_hamilton_jacobi(states).is_ok(),
                by.modified_linear_system(states).is_ok_and(|found| found.is_rayleigh()),
                by.modified_linear_system(states).is_ok_and(|found| found.is_dissipative()),
            ]
        };
        let is_right = system.circulating == 0.0;
        assert_eq!(answers(&states()), [is_right; 6]);
        assert_eq!(answers(&[]), [false; 6]);
        for poison in POISON {
            for part in 0..4 {
                let mut states = states();
                let state = &mut states[part % 2];
                if part < 2 {
                    state.q[0] = poison
                } else {
                    state.p[1] = poison
                };
                let found = answers(&states);
                // Far out and close to 0 a linear system is what it is.
                if !is_right || !poison.is_finite() {
                    assert_eq!(found, [false; 6], "{poison:e}, part {part}");
                }
            }
        }
    }
}

/// θ of `Turning` is cyclic where `spring` is 0, and no reduction takes its `friction`.
#[rayleigh_system]
fn turning(q: [f64; 2], v: [f64; 2], friction: f64, spring: f64) -> (f64, f64) {
    let twice_kinetic = v[0] * v[0] + (1.0 + q[0] * q[0]) * v[1] * v[1];
    (0.5 * twice_kinetic - 0.5 * q[0] * q[0] - spring * q[1].cos(), 0.5 * friction * v[1] * v[1])
}

#[test]
fn poisoned_segments_get_no_yes() {
    let clean = segments([0.5, -1.0], [1.5, 1.0], [0.1, 0.2], 12);
    let wrong = [Turning { friction: 0.4, spring: 0.0 }, Turning { friction: 0.0, spring: 0.3 }];
    let answers = |system: &Turning, h: f64, segments: &[Pair<f64, 2>]| {
        let by = system.by(Midpoint, h);
        [by.routh::<1>(1, segments).is_ok(), by.proportion(segments).is_ok_and(|found| found.is_constant())]
    };
    // Positive control: without friction R_d = 0·L_d, and θ can be left out.
    let right = Turning { friction: 0.0, spring: 0.0 };
    assert_eq!(answers(&right, H, &clean), [true; 2]);
    for system in &wrong {
        let is_proportional = system.friction == 0.0;
        assert_eq!(answers(system, H, &clean), [false, is_proportional]);
        for h in [0.0, f64::NAN, f64::INFINITY, 5e-324, 1e200, f64::MAX] {
            assert_eq!(answers(system, h, &clean), [false; 2], "{h:e}");
        }
        for poison in POISON {
            for part in 0..4 {
                let put = |segment: &mut Pair<f64, 2>| match part {
                    0 => segment.q0[0] = poison,
                    1 => segment.q0[1] = poison,
                    2 => segment.q1[0] = poison,
                    _ => segment.q1[1] = poison,
                };
                let mut one = clean.clone();
                put(&mut one[5]);
                let found = answers(system, H, &one);
                assert!(!found[0] && (is_proportional || !found[1]), "{poison:e}, part {part}: {found:?}");
                if !poison.is_finite() {
                    assert_eq!(answers(&right, H, &one), [false; 2], "{poison:e}, part {part}");
                }
            }
        }
    }
    for none in [vec![], vec![Pair::new([1.0, 0.0], [1.0, 0.0])], vec![clean[0]; 5]] {
        assert!(wrong.iter().all(|system| !answers(system, H, &none)[0]));
    }
}

#[test]
fn no_step_size_is_safe_by_what_is_not_finite() {
    let largest = |friction: [f64; 2], k: [f64; 3]| {
        let system = Rubbed { friction, k };
        let modified = system.by(Midpoint, 0.1).modified_system();
        modified.ok().and_then(|modified| modified.largest_step(&vector![0.0, 0.0]).ok())
    };
    // Positive control: friction and springs set a finite step size.
    let (friction, k) = (RIGHT.friction, RIGHT.k);
    assert!(largest(friction, k).is_some_and(|h| h > 1.0 && h < 10.0));
    assert_eq!(largest(WRONG.friction, k), None);
    for poison in POISON {
        for part in 0..5 {
            let (mut friction, mut k) = (friction, k);
            match part {
                0 | 1 => friction[part] = poison,
                _ => k[part - 2] = poison,
            }
            // The springs left set a bound, whatever the others are.
            let found = largest(friction, k);
            let says_all = found.is_some_and(|h| h.is_nan() || h > 1e3);
            assert!(!says_all, "{poison:e}, part {part}: {found:?}");
        }
    }
}

#[rayleigh_system]
fn rubbed(q: [f64; 2], v: [f64; 2], friction: [f64; 2], k: [f64; 3]) -> (f64, f64) {
    let potential = 0.5 * (k[0] * q[0] * q[0] + 2.0 * k[1] * q[0] * q[1] + k[2] * q[1] * q[1]);
    let kinetic = 0.5 * (v[0] * v[0] + 1.3 * v[1] * v[1]);
    (kinetic - potential, 0.5 * (friction[0] * v[0] * v[0] + friction[1] * v[1] * v[1]))
}
