//! Kahan and Li's compositions: the order conditions, the order measured, what negative substeps do to
//! damping.

use dalembert::rules::SelfAdjoint;
use dalembert::{
    Composition, Discrete, Discretise, Midpoint, State, StepError, Trapezoidal, rayleigh_system,
};
use dalembert_tests::by_hand::ByHand;
use dalembert_tests::convergence::orders;
use dalembert_tests::systems::{Bead, Chain, DoublePendulum, Pendulum};

/// The order conditions, for vector fields that do not commute: the product ∏ exp(γᵢX₁ + γᵢ³X₃ + γᵢ⁵X₅ + …)
/// has to agree with exp(X₁) in the coefficient of every word in X₁, X₃, X₅, … whose weight is at most the
/// order.
mod order_conditions {
    use super::*;
    use std::collections::BTreeMap;

    /// Coefficients of words in the letters 1, 3, 5, …, each letter of that weight.
    type Series = BTreeMap<Vec<u32>, f64>;

    fn product(a: &Series, b: &Series, weight: u32) -> Series {
        let mut product = Series::new();
        for (left, x) in a {
            for (right, y) in b {
                let word = [left.as_slice(), right].concat();
                if word.iter().sum::<u32>() <= weight {
                    *product.entry(word).or_default() += x * y;
                }
            }
        }
        product
    }

    /// exp of Σ γ^w X_w over the odd weights w.
    fn exponential(gamma: f64, weight: u32) -> Series {
        let field: Series = (1..=weight).step_by(2).map(|w| (vec![w], gamma.powi(w as i32))).collect();
        let mut power = Series::from([(vec![], 1.0)]);
        let mut sum = power.clone();
        for k in 1..=weight {
            power = product(&power, &field, weight);
            power.values_mut().for_each(|x| *x /= f64::from(k));
            for (word, x) in &power {
                *sum.entry(word.clone()).or_default() += x;
            }
        }
        sum
    }

    /// The largest coefficient of weight up to `weight` that the composition has wrong.
    fn defect(shares: &[f64], weight: u32) -> f64 {
        let composed = shares.iter().fold(Series::from([(vec![], 1.0)]), |sum, &gamma| {
            product(&exponential(gamma, weight), &sum, weight)
        });
        composed
            .iter()
            .map(|(word, x)| {
                let motion = word.iter().all(|&letter| letter == 1);
                let factorial: f64 = (1..=word.len()).map(|k| k as f64).product();
                (x - if motion { 1.0 / factorial } else { 0.0 }).abs()
            })
            .fold(0.0, f64::max)
    }

    fn hold<const S: usize>(composition: Composition<Trapezoidal, S>) {
        let order = composition.order();
        let defect_at = |weight| defect(composition.shares(), weight);
        assert!(defect_at(order) < 1e-14, "order {order}: {:e}", defect_at(order));
        // Positive controls: not of the next order but one, and no longer of its own after a change of one
        // digit.
        assert!(defect_at(order + 1) > 1e-4, "order {order}: {:e}", defect_at(order + 1));
        let mut altered = *composition.shares();
        (altered[0], altered[S - 1]) = (altered[0] + 1e-6, altered[S - 1] + 1e-6);
        altered[S / 2] -= 2e-6;
        assert!(defect(&altered, order) > 1e-7);
        assert!(defect(&altered, 2) < 1e-14, "still consistent and symmetric");
    }

    #[test]
    fn of_order_6() {
        hold(Composition::kahan_li_6(Trapezoidal));
    }

    #[test]
    fn of_order_8() {
        hold(Composition::kahan_li_8(Trapezoidal));
    }

    #[test]
    fn a_known_composition_has_its_known_order() {
        // Suzuki 1990: five substeps, order 4.
        let outer = 1.0 / (4.0 - 4.0_f64.cbrt());
        let shares = [outer, outer, 1.0 - 4.0 * outer, outer, outer];
        assert!(defect(&shares, 4) < 1e-15);
        assert!(defect(&shares, 5) > 1e-3);
    }
}

/// Errors below this are rounding and the reference's.
const PLATEAU: f64 = 3e-12;

/// Holds the order observed over steps of time/`steps` against the composition's.
fn assert_order<L, R, const N: usize, const S: usize>(
    system: &L,
    composition: Composition<R, S>,
    time: f64,
    steps: [usize; 6],
    [q, v]: [[f64; N]; 2],
) where
    L: ByHand<N> + Discrete<R, N, Scalar = f64>,
    R: SelfAdjoint + Copy,
{
    let run =
        |h, start, steps| system.by(composition, h).run(start).take(steps).last().unwrap().unwrap().state;
    for (order, of) in orders(system, time, steps, [q, v], PLATEAU, run).into_iter().zip(["q", "p"]) {
        let expected = f64::from(composition.order());
        assert!((order - expected).abs() < 0.35, "order {order:.3} in {of}, not {expected}");
    }
}

macro_rules! orders {
    ($($name:ident: $order:ident, $system:expr, $time:expr, $steps:expr, $start:expr;)*) => {$(
        #[test]
        fn $name() {
            assert_order(&$system, Composition::$order(Trapezoidal), $time, $steps, $start);
            assert_order(&$system, Composition::$order(Midpoint), $time, $steps, $start);
        }
    )*};
}
// Order 8 shows between steps so long that the next order weighs in, and round-off: on motions long enough to
// leave room.
orders! {
    order_6_pendulum: kahan_li_6, Pendulum::EXAMPLE, 1.5, [8, 12, 16, 24, 32, 48], [[1.9], [-0.7]];
    order_6_mass_and_friction_that_depend_on_q: kahan_li_6, Bead::EXAMPLE, 1.5, [8, 12, 16, 24, 32, 48], [[0.8], [1.3]];
    order_6_double_pendulum:
        kahan_li_6, DoublePendulum::EXAMPLE, 1.5, [12, 16, 24, 32, 48, 64], [[1.1, -0.6], [0.3, 1.2]];
    order_6_chain:
        kahan_li_6, Chain::EXAMPLE, 1.5, [8, 12, 16, 24, 32, 48], [[0.5, -0.2, 0.7, 0.1, -0.6], [0.0, 0.9, -0.3, 0.4, 0.2]];
    order_8_pendulum: kahan_li_8, Pendulum::EXAMPLE, 12.0, [32, 40, 48, 56, 64, 72], [[1.9], [-0.7]];
    order_8_mass_and_friction_that_depend_on_q: kahan_li_8, Bead::EXAMPLE, 6.0, [32, 40, 48, 56, 64, 72], [[0.8], [1.3]];
    order_8_chain:
        kahan_li_8, Chain::EXAMPLE, 1.5, [4, 6, 8, 10, 12, 16], [[0.5, -0.2, 0.7, 0.1, -0.6], [0.0, 0.9, -0.3, 0.4, 0.2]];
}

/// A free mass, or an oscillator, with damping.
#[rayleigh_system(rule = [midpoint, trapezoidal])]
fn oscillator(q: [f64; 1], v: [f64; 1], k: f64, r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
}

/// The larger of |p| and ω|q| after steps of size 1 from momentum 1, mass 1.
fn left<R: SelfAdjoint + Copy, const S: usize>(
    composition: Composition<R, S>,
    [k, r]: [f64; 2],
    steps: usize,
) -> f64
where
    Oscillator: Discrete<R, 1, Scalar = f64>,
{
    let system = Oscillator { k, r };
    let start = State::from_velocity(&system, [0.0], [1.0]).unwrap();
    let end = system.by(composition, 1.0).run(start).take(steps).last().unwrap().unwrap().state;
    end.p[0].abs().max(end.q[0].abs() * k.sqrt())
}

#[test]
fn damping_survives_negative_substeps_up_to_the_bound_and_not_beyond() {
    // hr/m on both sides of the documented bounds.
    assert!(left(Composition::kahan_li_6(Trapezoidal), [0.0, 2.70], 100) < 1e-2);
    assert!(left(Composition::kahan_li_6(Trapezoidal), [0.0, 2.75], 100) > 1e2);
    assert!(left(Composition::kahan_li_6(Midpoint), [0.0, 2.70], 100) < 1e-2);
    assert!(left(Composition::kahan_li_6(Midpoint), [0.0, 2.75], 100) > 1e2);
    assert!(left(Composition::kahan_li_8(Trapezoidal), [0.0, 3.295], 100) < 1e-2);
    assert!(left(Composition::kahan_li_8(Trapezoidal), [0.0, 3.301], 100) > 1e2);
    // The rule alone damps at any hr/m: it is the composition that does not.
    let system = Oscillator { k: 0.0, r: 10.0 };
    let start = State::from_velocity(&system, [0.0], [1.0]).unwrap();
    let step = system.by(Trapezoidal, 1.0).step(&start).unwrap();
    assert!(step.state.p[0].abs() < 0.7);
}

#[test]
fn the_explicit_rule_is_stable_up_to_the_bound_and_not_beyond() {
    let six = |omega: f64| left(Composition::kahan_li_6(Trapezoidal), [omega * omega, 0.0], 1000);
    assert!(six(2.53) < 30.0 && six(2.55) > 1e6, "{:e}, {:e}", six(2.53), six(2.55));
    let eight = |omega: f64| left(Composition::kahan_li_8(Trapezoidal), [omega * omega, 0.0], 1000);
    assert!(eight(3.09) < 30.0 && eight(3.12) > 1e6, "{:e}, {:e}", eight(3.09), eight(3.12));
}

#[test]
fn a_conservative_composition_undoes_itself_backwards() {
    let system = Pendulum { r: 0.0, ..Pendulum::EXAMPLE };
    let start = State::from_velocity(&system, [1.2], [0.4]).unwrap();
    let there = system
        .by(Composition::kahan_li_8(Trapezoidal), 0.3)
        .run(start)
        .take(50)
        .last()
        .unwrap()
        .unwrap()
        .state;
    let back = system
        .by(Composition::kahan_li_8(Trapezoidal), -0.3)
        .run(there)
        .take(50)
        .last()
        .unwrap()
        .unwrap()
        .state;
    assert!((there.q - start.q).amax() > 0.1);
    assert!((back.q - start.q).amax() < 1e-12 && (back.p - start.p).amax() < 1e-12);
}

#[test]
fn an_error_leaves_the_last_good_state_and_ends_the_run() {
    // The square root of a negative argument once the mass has crossed 0: no step leads across.
    #[rayleigh_system(rule = trapezoidal)]
    fn wall(q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q[0].sqrt()
    }
    let system = Wall {};
    let start = State::from_velocity(&system, [10.0], [-5.0]).unwrap();
    let mut run = system.by(Composition::kahan_li_6(Trapezoidal), 0.5).run(start);
    let error = run.by_ref().take(10).find_map(Result::err).expect("the mass meets the wall");
    let place = "√s has none at s";
    assert!(matches!(error, StepError::NoDerivative { .. }) && error.to_string().contains(place), "{error}");
    assert!(run.time() > 1.0 && run.state().q[0] > 0.0 && run.state().p[0].is_finite());
    assert!(run.next().is_none());
}
