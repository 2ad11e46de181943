//! What the scenes `four_bar`, `fekete`, `rolling` and `stick_slip` claim, against computations that share no
//! code with them.

mod belt;
mod cart;
#[path = "../../examples/fekete.rs"]
#[expect(dead_code, reason = "of the scene, what it computes is tested here, not what it prints")]
mod fekete;
#[path = "../../examples/four_bar.rs"]
#[expect(dead_code, reason = "of the scene, what it computes is tested here, not what it prints")]
mod four_bar;
#[path = "../../examples/rolling.rs"]
#[expect(dead_code, reason = "of the scene, what it computes is tested here, not what it prints")]
mod rolling;
#[path = "../../examples/stick_slip.rs"]
#[expect(dead_code, reason = "of the scene, what it computes is tested here, not what it prints")]
mod stick_slip;

use std::f64::consts::TAU;

use dalembert::nalgebra::{SMatrix, SVector, Vector3};
use dalembert::system::Constrained;
use dalembert::{Composition, Discretise, Midpoint, State};
use dalembert_scenes::four_bar::{COMBINATION, G, GROUND, LENGTHS, MASSES, Redundant};
use fekete::{DRAG, Fekete, N, POINTS};
use four_bar::{FRICTION, H};

/// Angles of coupler and rocker by that of the crank, from the triangle of its end and the joint opposite.
fn closed(crank: f64) -> [f64; 3] {
    let [r, coupler, rocker] = LENGTHS;
    let end = [r * crank.cos(), r * crank.sin()];
    let to = [GROUND - end[0], -end[1]];
    let across = to[0].hypot(to[1]);
    let inner = ((coupler * coupler + across * across - rocker * rocker) / (2.0 * coupler * across)).acos();
    let second = to[1].atan2(to[0]) + inner;
    let joint = [end[0] + coupler * second.cos(), end[1] + coupler * second.sin()];
    [crank, second, joint[1].atan2(joint[0] - GROUND)]
}

/// The potential by the angle of the crank, J.
fn potential(crank: f64) -> f64 {
    let [first, second, third] = closed(crank);
    let [r, coupler, rocker] = LENGTHS;
    let heights =
        [0.5 * r * first.sin(), r * first.sin() + 0.5 * coupler * second.sin(), 0.5 * rocker * third.sin()];
    heights.iter().zip(MASSES).map(|(height, mass)| G * mass * height).sum()
}

#[test]
#[cfg_attr(debug_assertions, ignore = "long without optimisation: cargo test --release")]
fn the_linkage_goes_from_rest_to_rest_once_around() {
    let motion = four_bar::drive(H).unwrap();
    let [start, end] = [motion[0], *motion.last().unwrap()];
    // At the least potential, by halving: its slope by differences of the fourth order.
    let slope = |at: f64| {
        let by = |d: f64| potential(at + d) - potential(at - d);
        (8.0 * by(1e-3) - by(2e-3)) / 12e-3
    };
    let (mut low, mut high) = (-2.2, -1.5);
    assert!(slope(low) < 0.0 && slope(high) > 0.0);
    while high - low > 1e-14 {
        let middle = 0.5 * (low + high);
        *(if slope(middle) < 0.0 { &mut low } else { &mut high }) = middle;
    }
    let rest = closed(low);
    for (bar, angle) in rest.into_iter().enumerate() {
        assert!((start.q[3 * bar + 2] - angle).abs() < 1e-11, "{bar}: {:e}", start.q[3 * bar + 2] - angle);
    }
    assert!((end.q[2] - start.q[2] - TAU).abs() < 1e-5);
    assert!(motion.iter().all(|moment| moment.off < 16.0 * f64::EPSILON));

    // The loop stays closed as the angles say.
    for moment in &motion {
        let angles = closed(moment.q[2]);
        for (bar, angle) in angles.into_iter().enumerate() {
            let off = (moment.q[3 * bar + 2] - angle).rem_euclid(TAU);
            assert!(off.min(TAU - off) < 1e-13, "{bar}: {off:e}");
        }
    }

    // At rest the pivots carry the weight.
    let weight = G * MASSES.iter().sum::<f64>();
    // To the force of what is left of the motion.
    assert!((end.reactions[1] + end.reactions[7] - weight).abs() < 1e-8);
    assert!((end.reactions[0] + end.reactions[6]).abs() < 1e-5);
    // Positive control: while it turns they do not.
    let turning = motion[motion.len() / 10];
    assert!((turning.reactions[1] + turning.reactions[7] - weight).abs() > 1.0);
}

/// Work, heat and energy add up to an error of the step's order, and the joints took what the motor gave.
#[test]
#[cfg_attr(debug_assertions, ignore = "long without optimisation: cargo test --release")]
fn the_energy_of_the_linkage_is_accounted_for() {
    let remainder = |h: f64| {
        let account = four_bar::drive(h).unwrap().last().unwrap().account;
        assert!(account.work > 10.0 && account.change.abs() < 1e-8, "{account:?}");
        account.remainder()
    };
    let order = (remainder(2.0 * H) / remainder(H)).log2();
    assert!((order - 2.0).abs() < 0.1, "{order}");
}

#[test]
#[cfg_attr(debug_assertions, ignore = "long without optimisation: cargo test --release")]
fn a_ninth_constraint_changes_multipliers_alone() {
    let (eight, nine) = (four_bar::drive(H).unwrap(), four_bar::drive_once_more(H).unwrap());
    let found = four_bar::compare(&eight, &nine);
    assert!(found.q < 1e-12 && found.forces < 1e-10 && found.taken_over > 1.0, "{}", found.forces);

    // Of least Σ Sₖₖλₖ² among those of the same forces: λ + c·n with Σ nₖgₖ = 0.
    let mut w: SMatrix<f64, 9, 9> = SMatrix::zeros();
    for bar in 0..3 {
        w[(3 * bar, 3 * bar)] = MASSES[bar];
        w[(3 * bar + 1, 3 * bar + 1)] = MASSES[bar];
        w[(3 * bar + 2, 3 * bar + 2)] = MASSES[bar] * LENGTHS[bar] * LENGTHS[bar] / 12.0;
    }
    for (a, b) in [(None, 2), (Some(2), 5), (Some(5), 8), (Some(8), 9)] {
        let mut turn: SVector<f64, 9> = SVector::zeros();
        if b < 9 {
            turn[b] += 1.0;
        }
        if let Some(a) = a {
            turn[a] -= 1.0;
        }
        w += turn * turn.transpose() * (0.5 * H * FRICTION);
    }
    let inverse = w.try_inverse().unwrap();
    let linkage = Redundant { friction: FRICTION };
    let system = linkage.driven([0.0]);
    let n = SVector::from(COMBINATION);
    let (mut weighted, mut plain) = (0.0_f64, 0.0_f64);
    for pair in nine[..nine.len() / 10].windows(2) {
        let gradients = [0, 1].map(|end| system.constraint_gradients(&pair[end].q.into()).1);
        assert!((gradients[0].transpose() * n).amax() < 1e-15);
        let s = (gradients[1] * inverse * gradients[0].transpose()).diagonal();
        let lambda = SVector::from(pair[0].reactions);
        weighted = weighted.max((s.component_mul(&n).dot(&lambda) / s.component_mul(&lambda).norm()).abs());
        plain = plain.max((n.dot(&lambda) / lambda.norm()).abs());
    }
    // S + ε stands in for S, with ε = 16u^⅔, u the rounding unit: a rounding beside it is u^⅓/16 = 4e-7, and
    // a sum of nine terms, refined, has some ten.
    assert!(weighted < 1e-5, "{weighted:e}");
    // Positive control: not of least Σ λₖ².
    assert!(plain > 0.1, "{plain}");
}

/// V of a state of the points.
fn potential_of_points(state: &State<f64, N>) -> f64 {
    state.energy(&Fekete { drag: DRAG }).unwrap() - 0.5 * state.p.norm_squared()
}

/// By a program that shares no code with this, to 14 digits.
#[test]
fn steps_of_the_points_are_those_of_another_program() {
    let moments = fekete::motion(0.05, 2.0).unwrap();
    assert!((moments[0].energy + 53.421588075879).abs() < 1e-12);
    let last = moments.last().unwrap().state;
    let place = [-0.30473918985483, 0.36146460411685, 0.88117953116109];
    assert!((fekete::point(&last.q, 0) - SVector::from(place)).amax() < 2e-14);
    assert!((potential_of_points(&last) + 53.7906527020342).abs() < 1e-12);
}

/// By DOP853 along the sphere.
#[test]
#[cfg_attr(debug_assertions, ignore = "long without optimisation: cargo test --release")]
fn a_composition_moves_the_points_as_an_adaptive_method_does() {
    let system = Fekete { drag: DRAG };
    let start = State::from_velocity(&system, fekete::start(), [0.0; N]).unwrap();
    let by = system.by(Composition::kahan_li_8(Midpoint), 0.1);
    let end = by.run(start).nth(19).unwrap().unwrap().state;
    let place = [-0.3047283672633, 0.3613632157016, 0.8812248569593];
    assert!((fekete::point(&end.q, 0) - SVector::from(place)).amax() < 2e-11);
    assert!((potential_of_points(&end) + 53.790891620520).abs() < 1e-10);
}

/// From the Test Set for Initial Value Problem Solvers: the first two points at t = 1000, by RADAU5.
const AT_THE_END: [f64; 6] = [
    -0.4070263380333202,
    0.3463758772791802,
    0.8451942450030429,
    0.0775293475252155,
    -0.2628662719972299,
    0.9617122871829146,
];

#[test]
#[cfg_attr(debug_assertions, ignore = "long without optimisation: cargo test --release")]
fn the_points_come_to_rest_where_the_test_set_has_them() {
    let mut turned = 0.0_f64;
    let errors = [0.2, 0.1].map(|h| {
        let moments = fekete::motion(h, 200.0).unwrap();
        let last = moments.last().unwrap();
        // The energy falls in each step, and the points stay on the sphere.
        assert!(moments.iter().all(|moment| moment.growth < 1e-14 && moment.off < 16.0 * f64::EPSILON));
        assert!((last.energy + 54.0111299745842).abs() < 1e-12, "{}", last.energy);
        assert!(last.state.p.amax() < 1e-14 && fekete::force_left(&last.state.q) < 1e-13);
        // Drag alone turns the points as a whole: a step takes from Σ q×p what it has of drag.
        let sum = |of: &dyn Fn(usize) -> Vector3<f64>| (0..POINTS).map(of).sum::<Vector3<f64>>();
        for pair in moments.windows(2) {
            let [a, b] = [pair[0].state, pair[1].state];
            let momentum = |state: &State<f64, N>| {
                sum(&|i| fekete::point(&state.q, i).cross(&fekete::point(&state.p, i)))
            };
            let drag = sum(&|i| fekete::point(&a.q, i).cross(&fekete::point(&b.q, i))) * DRAG;
            assert!((momentum(&b) - momentum(&a) + drag).amax() < 1e-14);
            turned = turned.max(drag.amax());
        }
        (last.state.q.fixed_rows::<6>(0) - SVector::from(AT_THE_END)).amax()
    });
    let order = (errors[0] / errors[1]).log2();
    // Positive control: it does take some.
    assert!(turned > 1e-6, "{turned:e}");
    assert!(errors[1] < 3e-5 && (order - 2.0).abs() < 0.05, "{errors:?} {order}");
}
