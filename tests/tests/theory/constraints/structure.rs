//! Whether f_d is a Rayleigh force on N.

use dalembert::nalgebra::Vector3;
use dalembert::rayleigh::structure;
use dalembert::samples::SampleError;
use dalembert::{Discretise, Midpoint, Trapezoidal, rayleigh_system};

use super::{EVEN, Spherical, on};

spherical!(Off);
spherical!(
    Twice,
    q,
    2,
    [q[0] * q[0] + q[1] * q[1] + q[2] * q[2] - 1.0, 1e6 * (q[0] * q[0] + q[1] * q[1] + q[2] * q[2]).ln()]
);

/// The fields of one system in another.
macro_rules! of {
    ($name:ident, $system:expr) => {{
        let Spherical { gravity, springs, c, turning, normal } = $system;
        $name { gravity, springs, c, turning, normal }
    }};
}

/// By the midpoint and the trapezoidal rule: of forces, and of the step.
const CASES: [(Spherical, [bool; 2]); 4] = [
    (EVEN, [true, true]),
    // On a tangent plane the matrix of e_z × v is q_z times a quarter turn.
    (Spherical { turning: 0.5, ..EVEN }, [false, false]),
    // Normal to the sphere at both ends by the trapezoidal rule; at q̄ it is not.
    (Spherical { normal: 0.5, ..EVEN }, [false, true]),
    (Spherical { turning: 1e-8, ..EVEN }, [false, false]),
];

#[test]
fn a_force_is_rayleigh_where_its_asymmetry_is_normal_to_the_constraints() -> Result<(), SampleError> {
    for (system, expected) in CASES {
        let midpoint = structure(&system, Midpoint, 0.05, &on(&system, Midpoint))?;
        let trapezoidal = structure(&system, Trapezoidal, 0.05, &on(&system, Trapezoidal))?;
        assert_eq!(
            [midpoint.is_rayleigh(), trapezoidal.is_rayleigh()],
            expected,
            "{midpoint}\n{trapezoidal}"
        );
        // Positive control: with no sphere to be normal to the last one is no Rayleigh force.
        let off = of!(Off, system);
        let off = structure(&off, Trapezoidal, 0.05, &on(&system, Trapezoidal))?;
        assert_eq!(off.is_rayleigh(), system.turning == 0.0 && system.normal == 0.0, "{off}");
    }
    Ok(())
}

#[test]
fn the_step_says_so_too() {
    let states = Spherical::states();
    for (system, expected) in CASES {
        let midpoint = system.by(Midpoint, 0.05).rayleigh_step(&states).unwrap();
        let trapezoidal = system.by(Trapezoidal, 0.05).rayleigh_step(&states).unwrap();
        // A force of 1e-8 is within what a step's derivative resolves.
        if system.turning != 1e-8 {
            let found = [midpoint.is_rayleigh(), trapezoidal.is_rayleigh()];
            assert_eq!(found, expected, "{midpoint}\n{trapezoidal}");
        }
    }
}

#[test]
fn a_redundant_constraint_changes_no_verdict() {
    for (system, expected) in CASES {
        let twice = of!(Twice, system);
        let found = structure(&twice, Trapezoidal, 0.05, &on(&twice, Trapezoidal)).unwrap();
        assert_eq!(found.is_rayleigh(), expected[1], "{found}");
        let states = Spherical::states();
        let found = twice.by(Trapezoidal, 0.05).rayleigh_step(&states).unwrap();
        assert!(found.is_rayleigh() == expected[1] || system.turning == 1e-8, "{found}");
    }
    let normals = dalembert::Lagrangian::normals(&of!(Twice, EVEN), &Vector3::new(0.6, 0.0, -0.8)).unwrap();
    assert!((normals.frame.column(0).abs() - Vector3::new(0.6, 0.0, 0.8)).amax() < 1e-15);
    assert!(normals.frame.columns(1, 2).amax() == 0.0 && normals.offset.amax() < 1e-15);
    assert!(dalembert::Lagrangian::normals(&of!(Off, EVEN), &Vector3::zeros()).is_none());
}
