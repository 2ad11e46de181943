//! Legendre transforms, discrete Euler–Lagrange equations and the two flows fit together.

use dalembert::nalgebra::{SVector, vector};
use dalembert::step::ClosedForm;
use dalembert::{Discrete, Discretise, Midpoint, State, Trapezoidal, rayleigh_system};
use dalembert_tests::by_hand::ByHand;
use dalembert_tests::systems::{Bead, Chain, Charge, DoublePendulum, Follower};

const H: f64 = 0.2;

/// Along a trajectory: consecutive configurations solve the DEL, the transforms give the momenta, and the
/// flow on Q×Q is that on T*Q.
fn check<S, R: Copy, const N: usize>(system: &S, rule: R, q: [f64; N], v: [f64; N])
where
    S: ByHand<N> + ClosedForm<R, N, Scalar = f64> + Discrete<R, N>,
{
    let by = system.by(rule, H);
    let start = State::from_velocity(system, q, v).unwrap();
    assert!((start.p - system.momentum(q, v)).amax() <= 4.0 * f64::EPSILON * start.p.amax());

    let states: Vec<_> = std::iter::once(start)
        .chain(system.by(rule, H).run(start).take(50).map(|step| step.unwrap().state))
        .collect();
    for window in states.windows(3) {
        let [a, b, c] = [window[0], window[1], window[2]];
        // A configuration is known to ε|q|, a momentum made of two to ε|q|/h times the mass.
        let scale = b.p.amax() + (a.q.amax() + b.q.amax()) / H;
        let tolerance = 1e-14 * scale;
        let residual = by.del_residual(&a.q, &b.q, &c.q);
        assert!(residual.amax() <= tolerance, "{residual}");
        assert!((by.legendre_minus(&a.q, &b.q).p - a.p).amax() <= tolerance);
        assert!((by.legendre_plus(&a.q, &b.q).p - b.p).amax() <= tolerance);
        assert_eq!(by.legendre_minus(&a.q, &b.q).q, a.q);
        assert_eq!(by.legendre_plus(&a.q, &b.q).q, b.q);

        let on_configurations = system.by(rule, H).step_configurations(&a.q, &b.q).unwrap().state;
        assert!((on_configurations.q - c.q).amax() <= tolerance);
        assert!((on_configurations.p - c.p).amax() <= tolerance);

        // Positive control: a configuration off by 1e-9 is no solution.
        let residual = by.del_residual(&a.q, &b.q, &c.q.add_scalar(1e-9));
        assert!(residual.amax() > 10.0 * tolerance, "{residual}");
    }
}

#[test]
fn of_the_midpoint_rule() {
    check(&Bead::EXAMPLE, Midpoint, [0.8], [1.3]);
    check(&DoublePendulum::EXAMPLE, Midpoint, [1.1, -0.6], [0.3, 1.2]);
    check(&Follower::EXAMPLE, Midpoint, [0.6, -0.9], [0.8, 0.5]);
    check(&Charge::EXAMPLE, Midpoint, [0.9, -0.4, 0.6], [0.2, 1.1, -0.7]);
    check(&Chain::EXAMPLE, Midpoint, [0.5, -0.2, 0.7, 0.1, -0.6], [0.0, 0.9, -0.3, 0.4, 0.2]);
}

#[test]
fn of_the_trapezoidal_rule() {
    check(&Bead::EXAMPLE, Trapezoidal, [0.8], [1.3]);
    check(&DoublePendulum::EXAMPLE, Trapezoidal, [1.1, -0.6], [0.3, 1.2]);
    check(&Follower::EXAMPLE, Trapezoidal, [0.6, -0.9], [0.8, 0.5]);
    check(&Charge::EXAMPLE, Trapezoidal, [0.9, -0.4, 0.6], [0.2, 1.1, -0.7]);
    check(&Chain::EXAMPLE, Trapezoidal, [0.5, -0.2, 0.7, 0.1, -0.6], [0.0, 0.9, -0.3, 0.4, 0.2]);
}

/// Both rules are self-adjoint, so a step back undoes a step; without force the flow is reversible besides.
#[test]
fn a_step_back_undoes_a_step_without_force() {
    let system = DoublePendulum::FREE;
    let start = State::from_velocity(&system, [1.1, -0.6], [0.3, 1.2]).unwrap();
    let there = system.by(Midpoint, H).run(start).take(100).last().unwrap().unwrap().state;
    let back = system.by(Midpoint, -H).run(there).take(100).last().unwrap().unwrap().state;
    assert!((there.q - start.q).amax() > 0.1);
    assert!((back.q - start.q).amax() < 1e-12 && (back.p - start.p).amax() < 1e-12, "{back:?}");
}

/// With R as well: 𝔽⁻ at −h is 𝔽⁺ at h, also where R depends on q.
#[test]
fn a_step_back_undoes_a_step_with_force() {
    fn round_trip<S, R, const N: usize>(system: &S, q: [f64; N], v: [f64; N]) -> f64
    where
        S: Discrete<R, N, Scalar = f64>,
    {
        let start = State::from_velocity(system, q, v).unwrap();
        let there = system.step(&start, H, None).unwrap().state;
        let back = system.step(&there, -H, None).unwrap().state;
        ((back.q - start.q).amax()).max((back.p - start.p).amax())
    }
    for off in [
        round_trip::<_, Midpoint, 1>(&Bead::EXAMPLE, [0.8], [1.3]),
        round_trip::<_, Trapezoidal, 1>(&Bead::EXAMPLE, [0.8], [1.3]),
        round_trip::<_, Midpoint, 3>(&Charge::EXAMPLE, [0.9, -0.4, 0.6], [0.2, 1.1, -0.7]),
        round_trip::<_, Trapezoidal, 3>(&Charge::EXAMPLE, [0.9, -0.4, 0.6], [0.2, 1.1, -0.7]),
    ] {
        assert!(off < 1e-14, "{off:e}");
    }
}

/// A relativistic particle: L is not quadratic in v, and not defined beyond the speed of light.
#[rayleigh_system]
fn relativistic(q: [f64; 2], v: [f64; 2], m: f64, c: f64) -> f64 {
    let beta_squared = (v[0] * v[0] + v[1] * v[1]) / (c * c);
    -m * c * c * (1.0 - beta_squared).sqrt() - q[0]
}

#[test]
fn velocity_and_momentum_are_inverse_where_l_is_not_quadratic() {
    let system = Relativistic { m: 1.3, c: 2.0 };
    for speed in [0.0, 1e-8, 0.5, 1.9, 1.9999] {
        let v = vector![0.6 * speed, -0.8 * speed];
        let state = State::from_velocity(&system, [0.1, 0.2], v).unwrap();
        // p = γ m v
        let gamma = 1.0 / ((1.0 - speed / 2.0) * (1.0 + speed / 2.0)).sqrt();
        assert!((state.p - v * (1.3 * gamma)).amax() <= 1e-11 * state.p.amax());
        let velocity = state.velocity(&system).unwrap();
        assert!((velocity - v).amax() <= 1e-12 * speed, "{velocity} {v}");
    }
}

/// From rest the first Newton step for p = 10⁴ m c leads to 10⁴ times the speed of light: only shorter ones
/// help.
#[test]
fn velocity_is_found_where_newton_steps_leave_the_domain() {
    let (m, c) = (1.3, 2.0);
    let system = Relativistic { m, c };
    for factor in [0.5, 3.0, 1e2, 1e4] {
        let p = factor * m * c;
        let state = State { q: SVector::zeros(), p: vector![p, 0.0] };
        // v = p/√(m² + p²/c²), well conditioned in p.
        let expected = p / (m * m + (p / c).powi(2)).sqrt();
        let velocity = state.velocity(&system).unwrap();
        assert!((velocity[0] - expected).abs() <= 1e-14 * expected, "{factor}: {velocity}");
        assert_eq!(velocity[1], 0.0);
    }
}

/// L = ¼v⁴ − ½q² has velocities and steps, and order 2 as long as it does not come to rest. Through the
/// turning point, where v = p^{1/3} has no derivative, the error falls about as h^{4/3}, and not evenly.
#[test]
fn a_mass_that_vanishes_at_rest_has_no_order_through_turning_points() {
    #[rayleigh_system]
    fn quartic(q: [f64; 1], v: [f64; 1]) -> f64 {
        0.25 * v[0].powi(4) - 0.5 * q[0] * q[0]
    }
    let start = State { q: vector![0.0], p: vector![1.0] };
    // v = p^{1/3} falls from 1 to 0 at t = 1.2.
    let end = |time: f64, steps: usize| {
        let run = Quartic {}.by(Midpoint, time / steps as f64).run(start);
        run.take(steps).last().unwrap().unwrap().state
    };
    let order = |time: f64| {
        let exact = end(time, 40_000);
        assert_eq!(exact.p[0] < 0.0, time > 1.5);
        let error = |steps: usize| {
            let found = end(time, steps);
            (found.q - exact.q).amax().max((found.p - exact.p).amax())
        };
        (error(20) / error(320)).log2() / 4.0
    };
    let [before, through] = [order(0.5), order(2.0)];
    assert!((before - 2.0).abs() < 0.02 && through < 1.7, "{before} {through}");
}
