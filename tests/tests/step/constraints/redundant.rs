//! Constraints of which some depend on others: redundant ones, nearly dependent ones beside them, and
//! contradictions.

use dalembert::nalgebra::Vector3;
use dalembert::{Discretise, Midpoint, State, StepError, rayleigh_system};

/// A bob on a circle: the sphere twice, in units of their own, and the plane.
struct Twice {
    first: f64,
    second: f64,
}

#[rayleigh_system]
impl Twice {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) - 9.81 * q[2]
    }

    fn constraints(&self, q: [f64; 3]) -> [f64; 3] {
        let g = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] - 1.0;
        [self.first * g, self.second * g, q[1]]
    }
}

#[test]
fn redundant_constraints_may_have_any_units() -> Result<(), StepError> {
    let units = [1e-6, 1e-3, 1.0, 1e3, 1e6];
    let end = |first, second| -> Result<Vector3<f64>, StepError> {
        let system = Twice { first, second };
        let start = State::nearest(&system, [0.8, 0.0, -0.6], [0.0; 3])?;
        Ok(system.by(Midpoint, 0.01).run(start).nth(99).unwrap()?.state.q)
    };
    let expected = end(1.0, 1.0)?;
    for (first, second) in units.into_iter().flat_map(|first| units.map(|second| (first, second))) {
        assert!((end(first, second)? - expected).amax() < 1e-12, "{first}, {second}");
    }
    Ok(())
}

/// The reaction is shared so that each of the two has the same part of it, whatever their units.
#[test]
fn redundant_constraints_share_their_reaction() -> Result<(), StepError> {
    let reactions = |first, second| -> Result<Vector3<f64>, StepError> {
        let system = Twice { first, second };
        let start = State::nearest(&system, [0.8, 0.0, -0.6], [0.0, 0.0, 0.0])?;
        let by = system.by(Midpoint, 0.01);
        by.reactions(&start, &by.step(&start)?)
    };
    let alone = reactions(1.0, 0.0)?[0];
    for (first, second) in [(1.0, 1.0), (1.0, 3.0), (1e-6, 0.7), (1e3, 1e-3)] {
        let lambda = reactions(first, second)?;
        for (unit, lambda) in [(first, lambda[0]), (second, lambda[1])] {
            assert!((unit * lambda / alone - 0.5).abs() < 1e-12, "{unit}: {lambda}");
        }
    }
    // Positive control: a weight that is the first's alone would be seen.
    assert!(alone.abs() > 1.0);
    Ok(())
}

/// A mass that three constraints on two lines hold at (1, 1) of the plane across which it moves; the lines
/// make an angle of some `sine`.
struct Nearly {
    sine: f64,
    /// The third constraint is so many times the first.
    times: f64,
}

/// The first line and what is across it.
const ALONG: [[f64; 2]; 2] = [[0.6, 0.8], [-0.8, 0.6]];

#[rayleigh_system]
impl Nearly {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        let across = ALONG[1][0] * q[0] + ALONG[1][1] * q[1];
        0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) - across
    }

    fn constraints(&self, q: [f64; 3]) -> [f64; 3] {
        let along = ALONG[0][0] * (q[0] - 1.0) + ALONG[0][1] * (q[1] - 1.0);
        let across = ALONG[1][0] * (q[0] - 1.0) + ALONG[1][1] * (q[1] - 1.0);
        [along, along + self.sine * across, self.times * along]
    }
}

/// S has the square of the sine, and once 10⁻⁵ of it counted as redundant beside the third constraint.
#[test]
fn a_nearly_dependent_constraint_holds_beside_a_redundant_one() -> Result<(), StepError> {
    let h = 0.01;
    let step = |sine: f64| {
        let system = Nearly { sine, times: 3.0 };
        let start = State::nearest(&system, [1.0, 1.0, 0.0], [0.0, 0.0, 0.7])?;
        let by = system.by(Midpoint, h);
        let step = by.step(&start)?;
        Ok::<_, StepError>((step.state, by.reactions::<3>(&start, &step)?))
    };
    for k in 1..=11 {
        let sine = 10.0_f64.powi(-k);
        let rounding = 1e-14 + 20.0 * f64::EPSILON / sine;
        let (State { q, p }, lambda) = step(sine)?;
        assert!((q - Vector3::new(1.0, 1.0, 0.7 * h)).amax() < rounding, "{sine:e}: {q}");
        assert!((p - Vector3::new(0.0, 0.0, 0.7)).amax() < rounding, "{sine:e}: {p}");
        // λ₂ holds the weight, and what it has along the line is shared by the others: λ₁ + λ₂ + 3λ₃ = 0.
        for (lambda, expected) in lambda.iter().zip([-0.5, 1.0, -1.0 / 6.0]) {
            assert!((lambda * sine - expected).abs() < rounding / (h * h), "{sine:e}: {lambda}");
        }
    }
    // Positive control: without the angle nothing holds it.
    let (State { q, .. }, _) = step(0.0)?;
    let fallen = ALONG[1][0] * (q[0] - 1.0) + ALONG[1][1] * (q[1] - 1.0);
    assert!((fallen + 0.5 * h * h).abs() < 1e-15, "{fallen:e}");
    Ok(())
}

/// x = 1 and x = 1 + d; and a constraint without a gradient, (x − 1)².
struct Contradiction {
    d: f64,
    power: i32,
}

#[rayleigh_system]
impl Contradiction {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - q[1]
    }

    fn constraints(&self, q: [f64; 2]) -> [f64; 2] {
        let second = q[0] - 1.0 - self.d;
        [q[0] - 1.0, if self.power == 1 { second } else { second * second }]
    }
}

#[test]
fn contradictions_and_constraints_without_a_gradient_are_dependent() -> Result<(), StepError> {
    let contradicting = Contradiction { d: 1.0, power: 1 };
    let error = State::nearest(&contradicting, [1.0, 0.0], [0.0, 1.0]).unwrap_err();
    assert!(matches!(error, StepError::DependentConstraints { .. }), "{error}");
    let without_gradient = Contradiction { d: 0.0, power: 2 };
    let start = State::from_velocity(&without_gradient, [1.0, 0.0], [0.0, 1.0])?;
    let step = without_gradient.by(Midpoint, 0.1).step(&start);
    // Redundant beside x = 1, which holds the motion.
    assert!(step.is_ok_and(|step| step.state.q[0] == 1.0));
    Ok(())
}

#[test]
fn what_rounding_contradicts_is_shared() -> Result<(), StepError> {
    let contradicting = Contradiction { d: 8.0 * f64::EPSILON, power: 1 };
    let state = State::nearest(&contradicting, [1.0, 0.0], [0.0, 1.0])?;
    assert_eq!(state.q[0] - 1.0, 4.0 * f64::EPSILON);
    Ok(())
}

/// Crank .3, coupler .9, rocker .7 on pivots at (0, 0) and (1, 0): a loop of three bars, nine coordinates.
macro_rules! four_bar {
    ($name:ident, $count:literal, $q:ident, [$($once_more:expr)?]) => {
        struct $name;

        #[rayleigh_system]
        impl $name {
            fn lagrangian(&self, q: [f64; 9], v: [f64; 9]) -> f64 {
                let (lengths, masses) = ([0.3, 0.9, 0.7], [0.5, 0.9, 0.6]);
                let mut sum = 0.0;
                for i in 0..3 {
                    sum += 0.5 * masses[i] * (v[3 * i].powi(2) + v[3 * i + 1].powi(2));
                    sum += masses[i] * lengths[i] * lengths[i] / 24.0 * v[3 * i + 2].powi(2);
                    sum -= masses[i] * 9.81 * q[3 * i + 1];
                }
                sum
            }

            fn constraints(&self, $q: [f64; 9]) -> [f64; $count] {
                let c = [$q[2].cos(), $q[5].cos(), $q[8].cos()];
                let s = [$q[2].sin(), $q[5].sin(), $q[8].sin()];
                [
                    $q[0] - 0.15 * c[0],
                    $q[1] - 0.15 * s[0],
                    $q[0] + 0.15 * c[0] - $q[3] + 0.45 * c[1],
                    $q[1] + 0.15 * s[0] - $q[4] + 0.45 * s[1],
                    $q[3] + 0.45 * c[1] - $q[6] - 0.35 * c[2],
                    $q[4] + 0.45 * s[1] - $q[7] - 0.35 * s[2],
                    $q[6] - 0.35 * c[2] - 1.0,
                    $q[7] - 0.35 * s[2],
                    $($once_more)?
                ]
            }
        }
    };
}
four_bar!(FourBar, 8, q, []);
// The loop once more.
four_bar!(Redundant, 9, q, [0.3 * q[2].cos() + 0.9 * q[5].cos() - 0.7 * q[8].cos() - 1.0]);

#[test]
fn a_redundant_constraint_changes_no_motion() -> Result<(), StepError> {
    // By the angle of the crank; `nearest` closes the loop.
    let q = [0.11, 0.1, 0.7, 0.64, 0.42, 0.5, 0.84, 0.34, 1.8];
    let start = State::nearest(&FourBar, q, [0.0; 9])?;
    let once_more = State::nearest(&Redundant, start.q, [0.0; 9])?;
    assert!((once_more.q - start.q).amax() < 1e-15);
    let energy = start.energy(&FourBar)?;
    let steps = if cfg!(debug_assertions) { 300 } else { 5_000 };
    let runs = FourBar.by(Midpoint, 0.01).run(start).zip(Redundant.by(Midpoint, 0.01).run(once_more));
    for (index, (one, other)) in runs.take(steps).enumerate() {
        let (one, other) = (one?.state, other?.state);
        assert!(Redundant.constraints(other.q.into()).iter().all(|g| g.abs() < 20.0 * f64::EPSILON));
        assert!(f64::abs(one.energy(&FourBar)? - energy) < 0.05);
        // As far as the motion, which is chaotic, keeps a difference small.
        assert!(index > 100 || (one.q - other.q).amax() < 1e-12);
    }
    Ok(())
}
