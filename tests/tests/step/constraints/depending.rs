//! Steps that are refused beside constraints that depend on one another: the error says whether a smaller
//! step helps.

use dalembert::{Discretise, Midpoint, State, StepError, rayleigh_system};
use dalembert_tests::draws::Draws;
use dalembert_tests::mechanism;
use dalembert_tests::mechanisms::{Curve, Drawn, Kind, Mechanism, Problem, Rule, start};

mechanism! {
    /// A braced square with one rod too many.
    Braced: 8 coordinates, 2 of a body in 2, 7 joints, 2 forces,
    square [(0: 0 1)(1: 1 2)(2: 0 3)(3: 1 3)(4: 2 3)] length [(5: 0 2)] ground [(6: 0)] plane [] hinge [] pin []
    spring [(0: 0 2)] tether [(1: 3)] twist []
}
mechanism! {
    /// A row of points of which the first is held twice, by a square and by a length.
    Doubled: 6 coordinates, 2 of a body in 2, 4 joints, 1 forces,
    square [(0: 0 1)(1: 1 2)] length [(2: 0 1)] ground [(3: 0)] plane [] hinge [] pin []
    spring [] tether [(0: 2)] twist []
}
mechanism! {
    /// A rope of four rods between two places of the ground.
    Rope: 6 coordinates, 2 of a body in 2, 4 joints, 1 forces,
    square [(0: 0 1)(1: 1 2)] length [] ground [(2: 0)(3: 2)] plane [] hinge [] pin []
    spring [] tether [(0: 1)] twist []
}

/// Of so many refused steps of which a part of h is a step by the second program, how many were refused by
/// the name of a constraint.
fn too_long<L, const N: usize, const M: usize>(refused: usize) -> Result<usize, StepError>
where
    L: dalembert_tests::mechanisms::JudgedSystem<N, M>,
{
    let (mut found, mut by_name, mut seed) = (0, 0, 0);
    while found < refused {
        seed += 1;
        let mut drawn = Drawn::of(&L::SHAPE, N, seed);
        if !matches!(drawn.kind, Kind::Plain | Kind::LongSteps) {
            continue;
        }
        let mut draws = Draws::new(seed);
        drawn.h = draws.scale(0.1, 10.0);
        let system = L::of(&drawn.values);
        let state = start::<L, N, M>(&system, &drawn)?;
        let Err(error) = system.by(Midpoint, drawn.h).step(&state) else { continue };
        let problem = Problem {
            shape: &L::SHAPE,
            values: &drawn.values,
            rule: Rule::Midpoint,
            q: state.q.as_slice(),
            p: state.p.as_slice(),
            h: drawn.h / 256.0,
        };
        if matches!(problem.followed(), Curve::Root(_)) {
            found += 1;
            by_name += usize::from(matches!(error, StepError::DependentConstraints { .. }));
        }
    }
    Ok(by_name)
}

#[test]
fn beside_redundant_constraints_a_step_that_is_too_long_asks_for_a_smaller_one() -> Result<(), StepError> {
    let refused = if cfg!(debug_assertions) { 2 } else { 15 };
    assert_eq!([too_long::<Braced, 8, 7>(refused)?, too_long::<Doubled, 6, 4>(refused)?], [0; 2]);
    Ok(())
}

/// No place but one is on all rods of a taut rope, and nothing holds its weight there. Over less than 10⁻³ of
/// a unit of time it sags by less than rounding shows.
#[test]
fn a_taut_rope_asks_for_no_smaller_step() -> Result<(), StepError> {
    let mut draws = Draws::new(7);
    for seed in 0..if cfg!(debug_assertions) { 6 } else { 60 } {
        let mut drawn = Drawn::of(&Rope::SHAPE, 6, seed);
        drawn.values.gravity = [0.0, -9.81, 0.0];
        drawn.values.forces[0].numbers = [0.0; 3];
        let (turn, at) = (draws.between(-1.3, 1.3), [draws.between(-1.0, 1.0), draws.between(-1.0, 1.0)]);
        let mut along = 0.0;
        let mut next = |length: f64| {
            along += length;
            [at[0] + along * f64::cos(turn), at[1] + along * f64::sin(turn)]
        };
        drawn.values.joints[2].place = [at[0], at[1], 0.0];
        drawn.q.clear();
        for joint in [2, 0, 1] {
            let length = draws.scale(0.1, 3.0);
            drawn.values.joints[joint].length = length;
            drawn.q.extend(next(length));
        }
        let length = draws.scale(0.1, 3.0);
        let [x, y] = next(length);
        (drawn.values.joints[3].length, drawn.values.joints[3].place) = (length, [x, y, 0.0]);
        drawn.v = vec![0.0; 6];
        let system = Rope::of(&drawn.values);
        let state = start::<Rope, 6, 4>(&system, &drawn)?;
        for h in [1e-3, 1e-2, 1.0] {
            let error = system.by(Midpoint, h).step(&state).unwrap_err();
            assert!(matches!(error, StepError::DependentConstraints { .. }), "{seed}, {h}: {error}");
        }
    }
    Ok(())
}

/// A bob on a rod whose length is said twice, 1 + aᵢ t² or 1 + aᵢ t³.
struct Rod {
    rates: [f64; 2],
    is_cubic: f64,
    units: [f64; 2],
}

#[rayleigh_system]
impl Rod {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - 9.81 * q[1]
    }

    fn constraints(&self, q: [f64; 2], t: f64) -> [f64; 2] {
        let square = q[0] * q[0] + q[1] * q[1];
        let power = t * t * (1.0 - self.is_cubic + self.is_cubic * t);
        let (first, second) = (1.0 + self.rates[0] * power, 1.0 + self.rates[1] * power);
        [self.units[0] * (square - first * first), self.units[1] * (square - second * second)]
    }
}

#[test]
fn lengths_that_contradict_each_other_in_time_ask_for_no_smaller_step() -> Result<(), StepError> {
    let mut draws = Draws::new(11);
    for _ in 0..if cfg!(debug_assertions) { 20 } else { 200 } {
        let cubic = draws.below(2);
        let first = draws.between(-1.0, 1.0);
        // At h/256 they differ by some thousand roundings at least.
        let second = first + [-1.0, 1.0][draws.below(2)] * draws.scale(0.1, 1.0);
        let h = draws.scale([1e-3, 1e-1][cubic], 0.3);
        let units = [draws.scale(1e-3, 1e3), draws.scale(1e-3, 1e3)];
        let angle = draws.between(-3.0, 3.0);
        let q = [f64::sin(angle), -f64::cos(angle)];
        let system = Rod { rates: [first, second], is_cubic: cubic as f64, units };
        let start = State::nearest(&system.at_time(0.0), q, [q[1] * 0.3, -q[0] * 0.3])?;
        let error = system.at_time(0.0).by(Midpoint, h).step(&start).unwrap_err();
        assert!(matches!(error, StepError::DependentConstraints { .. }), "{cubic}, {h}: {error}");
        // Positive control: of the same lengths, which are redundant.
        let system = Rod { rates: [first; 2], ..system };
        assert!(system.at_time(0.0).by(Midpoint, 0.01).step(&start).is_ok());
    }
    Ok(())
}
