//! Gauss rules keep the momentum maps of affine generators alone, to rounding; of others to their order.
//!
//! Geodesics of the half-plane, L = ½(ẋ² + ẏ²)/y², with its Killing fields (1, 0), (x, y) and (x² − y², 2xy).

use dalembert::nalgebra::{SVector, vector};
use dalembert::{Discrete, Discretise, Gauss, Midpoint, State, Trapezoidal, rayleigh_system};

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
fn half_plane(q: [f64; 2], v: [f64; 2]) -> f64 {
    0.5 * (v[0] * v[0] + v[1] * v[1]) / (q[1] * q[1])
}

/// The momenta of the three fields.
fn momenta(state: &State<f64, 2>) -> [f64; 3] {
    let [x, y] = [state.q[0], state.q[1]];
    let fields: [SVector<f64, 2>; 3] =
        [vector![1.0, 0.0], vector![x, y], vector![x * x - y * y, 2.0 * x * y]];
    fields.map(|field| state.p.dot(&field))
}

/// The largest change of each on the way to t = 4.
fn drift<R: Copy>(rule: R, steps: u32) -> [f64; 3]
where
    HalfPlane: Discrete<R, 2, Scalar = f64>,
{
    let system = HalfPlane {};
    let start = State::from_velocity(&system, [0.2, 1.0], [0.5, 0.6]).unwrap();
    let at_start = momenta(&start);
    let mut worst = [0.0_f64; 3];
    for step in system.by(rule, 4.0 / f64::from(steps)).run(start).take(steps as usize) {
        for ((worst, now), then) in worst.iter_mut().zip(momenta(&step.unwrap().state)).zip(at_start) {
            *worst = worst.max((now - then).abs());
        }
    }
    worst
}

#[test]
fn a_gauss_rule_keeps_affine_momenta_to_rounding_and_others_to_its_order() {
    let [coarse, fine] = [20, 40].map(|steps| drift(Gauss::<2>, steps));
    for of in [coarse, fine] {
        assert!(of[0] < 1e-13 && of[1] < 1e-13, "{of:?}");
    }
    let order = (coarse[2] / fine[2]).log2();
    assert!((order - 4.0).abs() < 0.1 && fine[2] > 1e-9, "{order} {coarse:?} {fine:?}");
    // More stages, higher order; the midpoint rule has order 2, Gauss with one stage.
    let order = (drift(Gauss::<3>, 10)[2] / drift(Gauss::<3>, 20)[2]).log2();
    assert!((order - 6.0).abs() < 0.3, "{order}");
    let [coarse, fine] = [40, 80].map(|steps| drift(Midpoint, steps));
    let order = (coarse[2] / fine[2]).log2();
    assert!(fine[0] < 1e-13 && fine[1] < 1e-13 && (order - 2.0).abs() < 0.1, "{order} {fine:?}");
    let [coarse, fine] = [40, 80].map(|steps| drift(Trapezoidal, steps));
    let order = (coarse[2] / fine[2]).log2();
    assert!(fine[0] < 1e-13 && fine[1] < 1e-13 && (order - 2.0).abs() < 0.1, "{order} {fine:?}");
}
