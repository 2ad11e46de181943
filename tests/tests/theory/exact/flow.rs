//! The discrete flow of the exact objects is the continuous flow: points and momenta along a motion solve the
//! forced discrete Euler–Lagrange equations and both Legendre transforms.
//!
//! The motion comes from equations of motion written by hand and a Runge–Kutta method of the test's own.

use dalembert::State;
use dalembert::exact::Exact;
use dalembert::nalgebra::{SVector, Vector4, vector};
use dalembert::rayleigh_system;

/// A particle in polar coordinates (ρ, θ) with air drag, drag that grows with ρ, and a torque.
struct Particle {
    drag: f64,
    torque: f64,
}

#[rayleigh_system]
impl Particle {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + q[0] * q[0] * v[1] * v[1]) - 0.25 * (q[0] * q[0] - 1.0).powi(2)
            + 0.3 * q[1].cos()
    }

    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * self.drag * (1.0 + q[0]) * (v[0] * v[0] + q[0] * q[0] * v[1] * v[1])
    }

    fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        [0.2 * v[1], self.torque * q[0]]
    }
}

const SYSTEM: Particle = Particle { drag: 0.4, torque: 0.6 };

/// (ρ, θ, ρ′, θ′)′ by hand.
fn rate(y: Vector4<f64>) -> Vector4<f64> {
    let [rho, theta, rho_rate, theta_rate] = [y[0], y[1], y[2], y[3]];
    let drag = SYSTEM.drag * (1.0 + rho);
    let radial = rho * theta_rate.powi(2) - rho * (rho * rho - 1.0) - drag * rho_rate + 0.2 * theta_rate;
    let moment = -0.3 * theta.sin() - drag * rho * rho * theta_rate + SYSTEM.torque * rho;
    let angular = (moment - 2.0 * rho * rho_rate * theta_rate) / (rho * rho);
    vector![rho_rate, theta_rate, radial, angular]
}

/// The classical Runge–Kutta method with small steps: about 1e-14 here.
fn advance(mut y: Vector4<f64>, h: f64) -> Vector4<f64> {
    let steps = 1000;
    let step = h / f64::from(steps);
    for _ in 0..steps {
        let k1 = rate(y);
        let k2 = rate(y + k1 * (step / 2.0));
        let k3 = rate(y + k2 * (step / 2.0));
        let k4 = rate(y + k3 * step);
        y += (k1 + (k2 + k3) * 2.0 + k4) * (step / 6.0);
    }
    y
}

fn configuration(y: &Vector4<f64>) -> SVector<f64, 2> {
    vector![y[0], y[1]]
}

/// ∂L/∂v by hand.
fn momentum(y: &Vector4<f64>) -> SVector<f64, 2> {
    vector![y[2], y[0] * y[0] * y[3]]
}

fn motion(h: f64) -> [Vector4<f64>; 3] {
    let y0 = vector![1.3, 0.2, -0.3, 0.9];
    let y1 = advance(y0, h);
    [y0, y1, advance(y1, h)]
}

#[test]
fn points_of_the_motion_solve_the_discrete_equations() {
    let exact = Exact::new(&SYSTEM);
    for h in [0.1, 0.7] {
        let [y0, y1, y2] = motion(h);
        let first = exact.segment(configuration(&y0), configuration(&y1), h).unwrap();
        let second = exact.segment(configuration(&y1), configuration(&y2), h).unwrap();
        // D2 L_d + f+ on the first segment, D1 L_d + f− on the second: integrals, not ends of the motion.
        let residual = first.lagrangian.d2 + first.force.plus + second.lagrangian.d1 + second.force.minus;
        assert!(residual.amax() < 2e-13 / h, "{h}: {residual}");
        // Positive control: without f_d the equations are not solved.
        let unforced = first.lagrangian.d2 + second.lagrangian.d1;
        assert!(unforced.amax() > 0.03 * h, "{h}: {unforced}");
        assert!(first.report.error() < 1e-12 && second.report.error() < 1e-12, "{first}\n{second}");
    }
}

#[test]
fn the_legendre_transforms_give_the_momenta_of_the_motion() {
    let exact = Exact::new(&SYSTEM);
    for h in [0.1, 0.7] {
        let [y0, y1, _] = motion(h);
        let segment = exact.segment(configuration(&y0), configuration(&y1), h).unwrap();
        let p0 = -segment.lagrangian.d1 - segment.force.minus;
        let p1 = segment.lagrangian.d2 + segment.force.plus;
        assert!((p0 - momentum(&y0)).amax() < 2e-13 / h, "{h}: {p0}");
        assert!((p1 - momentum(&y1)).amax() < 2e-13 / h, "{h}: {p1}");
        // Positive control: without force the motion is another one.
        let other = Exact::unforced(&SYSTEM).segment(configuration(&y0), configuration(&y1), h).unwrap();
        assert!((other.p0.value - momentum(&y0)).amax() > 1e-3);
    }
}

#[test]
fn the_flow_is_that_of_the_equations_of_motion() {
    let exact = Exact::new(&SYSTEM);
    let [y0, y1, _] = motion(0.7);
    let start = State { q: configuration(&y0), p: momentum(&y0) };
    let end = exact.flow(&start, 0.7).unwrap();
    assert!((end.q - configuration(&y1)).amax() < 1e-13, "{end:?}");
    assert!((end.p - momentum(&y1)).amax() < 1e-13, "{end:?}");
    // Backwards.
    let back = exact.flow(&end, -0.7).unwrap();
    assert!((back.q - start.q).amax() < 1e-13 && (back.p - start.p).amax() < 1e-13, "{back:?}");
}

#[test]
fn a_segment_backwards_is_the_segment_with_opposite_sign() {
    // L_d(q1, q0, −h) = −L_d(q0, q1, h), f_d−(q1, q0, −h) = −f_d+(q0, q1, h).
    let exact = Exact::new(&SYSTEM);
    let (q0, q1, h) = (vector![1.1, 0.1], vector![1.2, 0.6], 0.5);
    let forwards = exact.segment(q0, q1, h).unwrap();
    let backwards = exact.segment(q1, q0, -h).unwrap();
    assert!((forwards.lagrangian.value + backwards.lagrangian.value).abs() < 1e-14);
    assert!((forwards.force.plus + backwards.force.minus).amax() < 1e-14);
    assert!((forwards.force.minus + backwards.force.plus).amax() < 1e-14);
    // Positive control: the force does tell forwards from backwards.
    assert!((forwards.force.minus - forwards.force.plus).amax() > 1e-3);
}

#[test]
fn unforced_curves_through_the_points_do_not_join() {
    // The paper's "solutions of the Euler–Lagrange equations for L" between the nodes must be those of (L,
    // f_L).
    let h = 0.7;
    let [y0, y1, y2] = motion(h);
    let points = [configuration(&y0), configuration(&y1), configuration(&y2)];
    let unforced = Exact::unforced(&SYSTEM);
    let before = unforced.segment(points[0], points[1], h).unwrap();
    let after = unforced.segment(points[1], points[2], h).unwrap();
    assert!((before.v1 - after.v0).amax() > 0.1, "{before}\n{after}");
    let forced = Exact::new(&SYSTEM);
    let before = forced.segment(points[0], points[1], h).unwrap();
    let after = forced.segment(points[1], points[2], h).unwrap();
    assert!((before.v1 - after.v0).amax() < 1e-12, "{before}\n{after}");
}
