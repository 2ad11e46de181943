//! The free mass with cubic Rayleigh function R = r v³/3 has an exact discrete Rayleigh system in closed
//! form:
//!
//! ```text
//! L_d^ex = (m³/r²h)(cosh(rd/m) − 1),   R_d^ex = (m²/rh)[(m/r) sinh(rd/m) − d],   d = q1 − q0
//! ```

use dalembert::exact::{Exact, ExistenceVerdict};
use dalembert::nalgebra::vector;
use dalembert::rayleigh_system;

#[rayleigh_system]
fn cubic_drag(_q: [f64; 1], v: [f64; 1], m: f64, r: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0], r * v[0].powi(3) / 3.0)
}

const SYSTEM: CubicDrag = CubicDrag { m: 1.4, r: 0.9 };

/// Forwards, far forwards, and backwards, where the drag accelerates.
const DISPLACEMENTS: [f64; 4] = [0.2, 1.0, 2.5, -0.4];

#[test]
fn the_pair_is_the_exact_one() {
    let CubicDrag { m, r } = SYSTEM;
    let exact = Exact::new(&SYSTEM);
    for (d, hs) in DISPLACEMENTS.into_iter().zip([[0.1, 0.8], [0.8, 0.1], [0.1, 0.8], [0.8, 0.1]]) {
        for &h in &hs[..if cfg!(debug_assertions) { 1 } else { 2 }] {
            let segment = exact.segment(vector![0.3], vector![0.3 + d], h).unwrap();
            let u = r * d / m;
            let lagrangian = m.powi(3) / (r * r * h) * (u.cosh() - 1.0);
            let by_d = m * m / (r * h) * u.sinh();
            // D2 R_d = −D1 R_d.
            let rayleigh_by_d = m * m / (r * h) * (u.cosh() - 1.0);
            let close = |value: f64, expected: f64, size: f64| {
                assert!((value - expected).abs() <= 5e-14 * size, "{d} {h}: {value:.16e} {expected:.16e}");
            };
            let momentum = by_d.abs() + rayleigh_by_d;
            close(segment.lagrangian.value, lagrangian, lagrangian);
            close(segment.lagrangian.d1[0], -by_d, momentum);
            close(segment.lagrangian.d2[0], by_d, momentum);
            close(segment.force.minus[0], -rayleigh_by_d, momentum);
            close(segment.force.plus[0], -rayleigh_by_d, momentum);
            // v0 = (m/rh)(e^{rd/m} − 1), from q = q0 + (m/r) ln(1 + (r/m) v0 t).
            close(segment.p0.value[0], m * m / (r * h) * u.exp_m1(), momentum * u.abs().exp());

            let second = exact.second_derivatives(&segment).unwrap();
            let (cosh, sinh) = (m / h * u.cosh(), m / h * u.sinh());
            for (value, expected) in [
                (second.lagrangian.d11[0], cosh),
                (second.lagrangian.d12[0], -cosh),
                (second.lagrangian.d22[0], cosh),
                (second.force.minus.d1[0], sinh),
                (second.force.minus.d2[0], -sinh),
                (second.force.plus.d1[0], sinh),
                (second.force.plus.d2[0], -sinh),
            ] {
                assert!((value - expected).abs() < 2e-12 * cosh, "{d} {h}: {value:.16e} {expected:.16e}");
            }
        }
    }
}

#[test]
fn its_force_is_rayleigh_though_not_linear() {
    let exact = Exact::new(&SYSTEM);
    let existence = exact.existence(vector![0.0], vector![1.0], 0.8).unwrap();
    assert_eq!(existence.verdict(), ExistenceVerdict::Holds, "{existence}");
    // Positive control: the two terms that cancel are far above what counts as 0.
    let segment = exact.segment(vector![0.0], vector![1.0], 0.8).unwrap();
    let second = exact.second_derivatives(&segment).unwrap();
    assert!(second.force.plus.d1[0].abs() > 1e6 * existence.tolerance);
}

#[test]
fn the_midpoint_objects_are_not_the_exact_ones() {
    // Positive control of the first test: what it calls equal tells a rule of order 2 from the exact objects.
    let CubicDrag { m, r } = SYSTEM;
    let (d, h) = (0.2_f64, 0.8);
    let segment = Exact::new(&SYSTEM).segment(vector![0.0], vector![d], h).unwrap();
    let midpoint = 0.5 * m * d * d / h;
    let apart = (segment.lagrangian.value - midpoint).abs() / midpoint;
    // cosh u − 1 = u²/2 + u⁴/24 + …: relative difference u²/12.
    assert!((apart / ((r * d / m).powi(2) / 12.0) - 1.0).abs() < 1e-2, "{apart}");
}
