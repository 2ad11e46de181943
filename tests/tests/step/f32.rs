//! Systems written in f32 step in f32 and are as accurate as f32 allows.

use dalembert::nalgebra::{SVector, vector};
use dalembert::{Discrete, Discretise, Midpoint, State, StepError, Trapezoidal, rayleigh_system};
use dalembert_tests::systems::Bead;

/// The bead of the shared systems, in f32.
struct SingleBead {
    m: f32,
    g: f32,
    k: f32,
    r: f32,
    c: f32,
}

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl SingleBead {
    fn lagrangian(&self, q: [f32; 1], v: [f32; 1]) -> f32 {
        let c = q[0].cos();
        0.5 * self.m * (1.0 + c * c) * v[0] * v[0] - self.m * self.g * q[0].sin() - 0.5 * self.k * q[0] * q[0]
    }

    fn rayleigh(&self, q: [f32; 1], v: [f32; 1]) -> f32 {
        0.5 * self.r * (2.0 + q[0].sin()) * v[0].powi(2) + 0.25 * self.c * (1.0 + q[0] * q[0]) * v[0].powi(4)
    }
}

const SINGLE: SingleBead = SingleBead { m: 0.7, g: 1.3, k: 2.1, r: 0.3, c: 0.2 };

/// The same in f64, with the parameters that f32 rounded.
fn double() -> Bead {
    let SingleBead { m, g, k, r, c } = SINGLE;
    Bead { m: m.into(), g: g.into(), k: k.into(), r: r.into(), c: c.into() }
}

/// Largest difference between the two runs over 1000 steps.
fn difference<R: Copy>(rule: R) -> f64
where
    SingleBead: Discrete<R, 1, Scalar = f32>,
    Bead: Discrete<R, 1, Scalar = f64>,
{
    let bead = double();
    let single = SINGLE.by(rule, 0.0625).run(State::from_velocity(&SINGLE, [0.75], [1.25]).unwrap());
    let double = bead.by(rule, 0.0625).run(State::from_velocity(&bead, [0.75], [1.25]).unwrap());
    single.zip(double).take(1000).fold(0.0, |largest, (single, double)| {
        let (single, double) = (single.unwrap(), double.unwrap());
        let off = |a: &SVector<f32, 1>, b: &SVector<f64, 1>| (f64::from(a[0]) - b[0]).abs();
        largest.max(off(&single.state.q, &double.state.q)).max(off(&single.state.p, &double.state.p))
    })
}

#[test]
fn they_are_as_accurate_as_f32_allows() {
    for difference in [difference(Midpoint), difference(Trapezoidal)] {
        // A damped motion forgets its roundings: some units of the last place, f32::EPSILON = 1.2e-7, stay.
        assert!(difference < 3e-6, "{difference:e}");
        // Positive control: the steps were taken in f32.
        assert!(difference > 1e-8, "{difference:e}");
    }
}

#[test]
fn their_discrete_objects_are_f32() {
    let (q0, q1) = (vector![0.75_f32], vector![0.875_f32]);
    let r: f32 = SINGLE.by(Midpoint, 0.125).discrete_rayleigh(&q0, &q1);
    let expected = double().by(Midpoint, 0.125).discrete_rayleigh(&vector![0.75], &vector![0.875]);
    assert!((f64::from(r) / expected - 1.0).abs() < 4.0 * f64::from(f32::EPSILON));
}

#[test]
fn their_errors_are_those_of_f64() {
    let state = State { q: vector![0.1_f32], p: vector![f32::NAN] };
    assert!(matches!(SINGLE.by(Midpoint, 0.1).step(&state), Err(StepError::NonFinite { index: 0, .. })));
    let state = State { q: vector![0.1_f32], p: vector![0.0] };
    assert_eq!(SINGLE.by(Midpoint, 0.0).step(&state).unwrap_err(), StepError::StepSize { h: 0.0 });
}

/// Coordinates in units that differ by 24 decades.
#[rayleigh_system]
fn scaled(q: [f32; 2], v: [f32; 2], unit: [f32; 2]) -> (f32, f32) {
    let (x, y) = (q[0] * unit[0], q[1] * unit[1]);
    let (u, w) = (v[0] * unit[0], v[1] * unit[1]);
    (0.5 * u * u + 0.75 * w * w + x.cos() * y.cos(), 0.1 * u * u + 0.1 * w * w)
}

#[test]
fn bad_scaling_does_not_matter() {
    // Powers of 2: scaling rounds nothing, so that the runs are equal to the last bit.
    let unit = [2.0_f32.powi(-40), 2.0_f32.powi(40)];
    let (plain, scaled) = (Scaled { unit: [1.0, 1.0] }, Scaled { unit });
    let start = State::from_velocity(&plain, [0.9, -0.4], [0.3, 0.8]).unwrap();
    let in_units = |state: &State<f32, 2>| State {
        q: vector![state.q[0] / unit[0], state.q[1] / unit[1]],
        p: vector![state.p[0] * unit[0], state.p[1] * unit[1]],
    };
    let a = plain.by(Midpoint, 0.1).run(start);
    let b = scaled.by(Midpoint, 0.1).run(in_units(&start));
    for (a, b) in a.zip(b).take(300) {
        assert_eq!(in_units(&a.unwrap().state), b.unwrap().state);
    }
}

#[test]
fn a_motion_comes_to_rest_without_error() {
    let mut trajectory = SINGLE.by(Midpoint, 0.1).run(State::from_velocity(&SINGLE, [0.75], [1.25]).unwrap());
    let last = trajectory.sample_every(20_000).next().unwrap().unwrap();
    // m g cos q + k q = 0 at rest.
    let force = SINGLE.m * SINGLE.g * last.state.q[0].cos() + SINGLE.k * last.state.q[0];
    assert!(force.abs() < 1e-5, "{force:e}");
}
