//! A mass matrix that is singular at one configuration: the error says that the coordinates are singular
//! there, and not that L lacks a kinetic energy.

use dalembert::derivative::PhaseMatrix;
use dalembert::nalgebra::{SVector, vector};
use dalembert::{Discretise, Gauss, Midpoint, OneSided, State, StepError, Trapezoidal, rayleigh_system};

/// A spherical pendulum in polar angle and azimuth: θ = 0 is a pole.
#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
fn sphere(q: [f64; 2], v: [f64; 2], g: f64) -> (f64, f64) {
    let turning = q[0].sin() * v[1];
    (0.5 * (v[0] * v[0] + turning * turning) - g * q[0].cos(), 0.0 * v[0])
}

/// One with friction, by a rule that takes L and R together.
#[rayleigh_system(rule = one_sided)]
fn damped_sphere(q: [f64; 2], v: [f64; 2], c: f64) -> (f64, f64) {
    let turning = q[0].sin() * v[1];
    (0.5 * (v[0] * v[0] + turning * turning) - q[0].cos(), 0.5 * c * (v[0] * v[0] + v[1] * v[1]))
}

/// A point in the plane in polar coordinates, in a disc of this radius alone: beside it L is not defined.
#[rayleigh_system(rule = [midpoint, gauss])]
fn disc(q: [f64; 2], v: [f64; 2], radius: f64) -> f64 {
    0.5 * (v[0] * v[0] + q[0] * q[0] * v[1] * v[1]) - (radius * radius - q[0] * q[0]).sqrt()
}

/// A rigid body in Euler angles (φ, θ, ψ): θ = 0 is gimbal lock.
#[rayleigh_system(rule = [midpoint, gauss], derivatives = num_dual)]
fn body(q: [f64; 3], v: [f64; 3], a: f64, b: f64, c: f64) -> f64 {
    let x = v[0] * q[1].sin() * q[2].sin() + v[1] * q[2].cos();
    let y = v[0] * q[1].sin() * q[2].cos() - v[1] * q[2].sin();
    let z = v[0] * q[1].cos() + v[2];
    0.5 * (a * x * x + b * y * y + c * z * z)
}

/// The azimuth of a spherical pendulum in single precision.
#[rayleigh_system(rule = midpoint)]
fn single(q: [f32; 2], v: [f32; 2], m: f32) -> f32 {
    let turning = q[0].sin() * v[1];
    0.5 * m * (v[0] * v[0] + turning * turning)
}

/// The kinetic energy is of the fourth order in v, and falls with q beside.
#[rayleigh_system(rule = midpoint)]
fn quartic(q: [f64; 1], v: [f64; 1], a: f64) -> f64 {
    0.25 * a * q[0] * q[0] * v[0] * v[0] * v[0] * v[0]
}

/// No kinetic energy of the second coordinate, wherever the first one is: rank 1 at every q.
#[rayleigh_system(rule = [midpoint, gauss])]
fn folded(q: [f64; 2], v: [f64; 2], c: f64) -> f64 {
    let speed = q[0].cos() * v[0] + c * q[1].exp() * v[1];
    0.5 * speed * speed - 0.5 * (q[0] * q[0] + q[1] * q[1])
}

fn singular<T: std::fmt::Debug>(found: Result<T, StepError>, at: usize) {
    let error = found.unwrap_err();
    assert_eq!(error, StepError::SingularCoordinates { column: at });
    let text = error.to_string();
    assert!(text.contains("regular beside it") && text.contains("start away"), "{text}");
    assert!(!text.contains("kinetic energy") && !text.contains("smaller step"), "{text}");
}

#[test]
fn at_a_pole_the_coordinates_are_singular() {
    let zero = SVector::<f64, 2>::zeros();
    for pole in [0.0, -0.0] {
        let system = Sphere { g: 9.81 };
        let (q, state) = (vector![pole, 0.3], State { q: vector![pole, 0.3], p: vector![0.1, 0.0] });
        singular(State::from_velocity(&system, q, [0.2, 0.1]), 1);
        singular(state.velocity(&system), 1);
        singular(state.energy(&system), 1);
        singular(PhaseMatrix::to_velocity(&system, &q, &zero), 1);
        singular(system.by(Midpoint, 0.01).step(&state), 1);
        singular(system.by(Trapezoidal, 0.01).step(&state), 1);
        singular(system.by(Gauss::<2>, 0.01).step(&state), 1);
        singular(system.by(Midpoint, 0.01).run(state).next().unwrap(), 1);
        singular(DampedSphere { c: 0.1 }.by(OneSided, 0.01).step(&state), 1);
        // Away from the pole there is a step.
        let beside = State::from_velocity(&system, [pole + 1e-3, 0.3], [0.2, 0.1]).unwrap();
        assert!(system.by(Midpoint, 0.01).step(&beside).is_ok());
    }
}

#[test]
fn so_they_are_at_the_centre_and_in_gimbal_lock() {
    for radius in [1.0, 1e-2, 1e3] {
        singular(State::from_velocity(&Disc { radius }, [0.0, 0.3], [0.0, 1.0]), 1);
        let state = State { q: vector![0.0, 0.3], p: vector![0.1, 0.0] };
        singular(Disc { radius }.by(Gauss::<3>, 0.01).step(&state), 1);
    }
    let body = Body { a: 1.0, b: 2.0, c: 3.0 };
    let locked = State { q: vector![0.4, 0.0, 0.2], p: vector![0.1, 0.2, 0.1] };
    assert!(matches!(locked.velocity(&body), Err(StepError::SingularCoordinates { .. })));
    let step = body.by(Midpoint, 0.01).step(&locked);
    assert!(matches!(step, Err(StepError::SingularCoordinates { .. })), "{step:?}");
    singular(State::from_velocity(&Single { m: 2.0 }, [0.0, 0.3], [0.1, 0.2]), 1);
    // Where the velocity alone is singular, there is nothing wrong with the coordinates.
    assert!(State::from_velocity(&Quartic { a: 1.0 }, [1.0], [0.0]).is_ok());
    singular(State::from_velocity(&Quartic { a: 1.0 }, [0.0], [0.0]), 0);
}

/// Positive control: a matrix that is singular everywhere keeps its text, whatever rounding makes of it.
#[test]
fn a_lagrangian_that_is_degenerate_everywhere_is_told_so() {
    for k in 0..200 {
        let x = 0.1 + 0.013 * f64::from(k);
        for c in [1.0, -0.3, 7.0] {
            let found = State::from_velocity(&Folded { c }, [x, 1.0 - x], [0.2, 0.1]);
            let Err(error @ StepError::DegenerateLagrangian { .. }) = found else { panic!("{x}: {found:?}") };
            assert!(error.to_string().contains("a kinetic energy of its own"), "{error}");
        }
    }
}
