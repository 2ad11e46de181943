//! The cart of the scene `rolling`, against a closed form and a program that shares no code with this.

use dalembert::nalgebra::SVector;
use dalembert::{Composition, Discretise, Midpoint};

use crate::rolling::{self, AHEAD, Cart, HALF_TRACK, MASS, RADIUS, START, WHEEL};

/// Place, heading and angles of the wheels, speed and turning, and the force across the wheels, at time t on
/// the floor. Friction takes both momenta at one rate, so that the cart goes its way without friction in a
/// time s that ends.
fn exact_cart(friction: f64, t: f64) -> (SVector<f64, 5>, [f64; 2], f64) {
    let mass = MASS + 2.0 * WHEEL / (RADIUS * RADIUS);
    let rate = 2.0 * friction / (RADIUS * RADIUS * mass);
    let (left, s) = if rate > 0.0 { ((-rate * t).exp(), -(-rate * t).exp_m1() / rate) } else { (1.0, t) };
    let fastest = START[0].hypot(START[1]);
    let pace = MASS * AHEAD * fastest / (mass * HALF_TRACK * HALF_TRACK);
    let from = (START[0] / fastest).atanh();
    let turn_at =
        |x: f64| 2.0 * fastest / (pace * HALF_TRACK) * ((0.5 * x).tanh().atan() - (0.5 * from).tanh().atan());
    // Simpson's rule along the way.
    let parts = 4000;
    let place: SVector<f64, 2> = (0..=parts)
        .map(|k| {
            let x = from + pace * s * f64::from(k) / f64::from(parts);
            let weight = if k % parts == 0 { 1.0 } else { f64::from(2 + 2 * (k % 2)) };
            let (sin, cos) = turn_at(x).sin_cos();
            SVector::from([cos, sin]) * (fastest * x.tanh() * weight * s / (3.0 * f64::from(parts)))
        })
        .sum();
    let to = from + pace * s;
    let (way, heading) = (fastest / pace * (to.cosh() / from.cosh()).ln(), turn_at(to));
    let q = [
        place[0],
        place[1],
        heading,
        (way - HALF_TRACK * heading) / RADIUS,
        (way + HALF_TRACK * heading) / RADIUS,
    ];
    let [speed, turning] = [left * fastest * to.tanh(), left * fastest / to.cosh()];
    let omega = turning / HALF_TRACK;
    let slowing = MASS * AHEAD / (mass * HALF_TRACK * HALF_TRACK) * speed * omega + rate * omega;
    (q.into(), [speed, turning], MASS * (speed * omega - AHEAD * slowing))
}

#[test]
fn a_cart_rolls_as_the_closed_form_says() {
    for friction in [0.0, rolling::FRICTION] {
        let cart = Cart { ahead: AHEAD, friction, bowl: 0.0 };
        let (q, speeds, across) = exact_cart(friction, 3.0);
        let errors = [0.04, 0.02].map(|h| {
            let at = *cart.motion(h, 3.0).unwrap().last().unwrap();
            assert!(at.slip < 16.0 * f64::EPSILON, "{:e}", at.slip);
            assert!((at.speeds[0] - speeds[0]).abs().max((at.speeds[1] - speeds[1]).abs()) < h * h);
            // The reaction is that of half a step later.
            assert!((at.across - across).abs() < 0.4 * h, "{} {across}", at.across);
            (at.q - q).amax()
        });
        let order = (errors[0] / errors[1]).log2();
        assert!((order - 2.0).abs() < 0.05, "{errors:?}");
        let by = cart.by(Composition::kahan_li_8(Midpoint), 0.05);
        let end = by.run(cart.pushed_off().unwrap()).nth(59).unwrap().unwrap().state;
        assert!((end.q - q).amax() < 1e-9, "{:e}", (end.q - q).amax());
    }
    // Positive control: with the load on the axle it does not turn about.
    let straight = Cart { ahead: 0.0, friction: 0.0, bowl: 0.0 }.motion(0.02, 3.0).unwrap();
    assert!(straight.iter().all(|at| (at.speeds[0] - START[0]).abs() < 1e-12));
}

#[test]
fn a_cart_comes_to_rest_where_the_closed_form_ends() {
    let friction = rolling::FRICTION;
    let errors = [0.08, 0.04].map(|h| {
        let motion = Cart { ahead: AHEAD, friction, bowl: 0.0 }.motion(h, 40.0).unwrap();
        let end = motion.last().unwrap();
        let (q, speeds, _) = exact_cart(friction, 40.0);
        assert!(end.speeds[0].abs() < 1e-6 && speeds[0].abs() < 1e-6);
        (end.q - q).amax()
    });
    assert!(((errors[0] / errors[1]).log2() - 2.0).abs() < 0.05, "{errors:?}");
}

/// From the origin of q, where the size of q tells nothing of the motion.
#[test]
fn an_error_asked_for_of_a_cart_is_kept() {
    let friction = rolling::FRICTION;
    let cart = Cart { ahead: AHEAD, friction, bowl: 0.0 };
    let (exact, start) = (exact_cart(friction, 3.0).0, cart.pushed_off().unwrap());
    for tolerance in [1e-3, 1e-6, 1e-9] {
        let reached = cart.to_error(tolerance).until(3.0).end(&start).unwrap();
        let error = (reached.state.q - exact).amax();
        assert!(error <= tolerance && reached.expected <= tolerance, "{tolerance:e}: {error:e}");
        // By a composition: by the midpoint rule alone an error of 1e-9 takes a million steps.
        assert!(reached.evaluations < 5e4, "{}", reached.evaluations);
    }
}

/// By a program that shares no code with this, to 11 digits: the drift is the method's.
#[test]
fn the_energy_of_a_cart_drifts_with_the_load_ahead_alone() {
    let [drifting, staying, by_order_8] =
        rolling::in_the_bowl(30.0).unwrap().map(|gained| gained.last().unwrap().1);
    assert!((drifting + 0.003822806556668).abs() < 1e-11, "{drifting:e}");
    assert!((staying - 4.41580893880e-5).abs() < 1e-11, "{staying:e}");
    assert!(by_order_8.abs() < 1e-7, "{by_order_8:e}");
}
