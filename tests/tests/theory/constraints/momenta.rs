//! Momentum maps, energy and friction on constraints.

use dalembert::nalgebra::Vector3;
use dalembert::noether::{Generator, SubalgebraError};
use dalembert::rayleigh::dissipation;
use dalembert::samples::{Pair, SampleError, TangentPoint};
use dalembert::{Discretise, EnergyLedger, Midpoint, State, StepError, Trapezoidal, rayleigh_system};

use super::{EVEN, FREE, Spherical, on};

fn rotations() -> [Generator<f64, 3>; 3] {
    [Generator::rotation(0, 1), Generator::rotation(1, 2), Generator::rotation(2, 0)]
}

#[test]
fn friction_and_gravity_decide_which_momenta_stay() -> Result<(), SampleError> {
    let [vertical, level, _] = rotations();
    for (system, friction) in [(FREE, false), (EVEN, true)] {
        let noether = system.by(Midpoint, 0.05).noether();
        let about_the_vertical = noether.symmetry(&vertical, &on(&system, Midpoint))?;
        assert!(about_the_vertical.is_symmetry_of_lagrangian() && about_the_vertical.is_consistent());
        assert_eq!(about_the_vertical.force_does_work(), friction, "{about_the_vertical}");
        assert_eq!(about_the_vertical.is_conserved(), !friction);
        assert!(!noether.symmetry(&level, &on(&system, Midpoint))?.is_symmetry_of_lagrangian());
        let weightless = Spherical { gravity: 0.0, ..system };
        let noether = weightless.by(Trapezoidal, 0.05).noether();
        let about_x = noether.symmetry(&level, &on(&weightless, Trapezoidal))?;
        assert!(about_x.is_symmetry_of_lagrangian() && about_x.is_conserved() != friction);
    }
    Ok(())
}

#[test]
fn what_is_off_the_constraints_or_leaves_them_is_named() -> Result<(), SampleError> {
    let noether = FREE.by(Midpoint, 0.05).noether();
    let [vertical, ..] = rotations();
    let along = Generator::translation("y", [0.0, 1.0, 0.0]);
    let mut segments = on(&FREE, Midpoint);
    let error = noether.symmetry(&along, &segments).unwrap_err();
    assert!(matches!(error, SampleError::LeavesConstraints { generator: 0, index: 0, .. }), "{error}");
    let error = noether.subalgebra(&[vertical.clone(), along], &segments).unwrap_err();
    assert!(matches!(
        error,
        SubalgebraError::Samples(SampleError::LeavesConstraints { generator: 1, index: 0, .. })
    ));
    // |q|² = 1.21: g = 0.105.
    segments[3].q1 = segments[3].q1.normalize() * 1.1;
    let off = |error| match error {
        SampleError::OffConstraint { index: 3, constraint: 0, value } => f64::abs(value - 0.105) < 1e-15,
        _ => false,
    };
    assert!(off(noether.symmetry(&vertical, &segments).unwrap_err()));
    assert!(off(FREE.by(Midpoint, 0.05).rayleigh_structure(&segments).unwrap_err()));
    let back = FREE.by(Midpoint, 0.05).on_constraints(&segments)?;
    assert!((back[3].q1 - segments[3].q1 / 1.1).amax() < 1e-15);
    // No direction leads from the centre to the sphere.
    let centre = [Pair::new([0.0; 3], [0.1, 0.0, 0.0])];
    let lost = FREE.by(Midpoint, 0.05).on_constraints(&centre).unwrap_err();
    assert!(matches!(lost, SampleError::OffConstraint { index: 0, constraint: 0, value: -0.5 }), "{lost}");
    Ok(())
}

#[test]
fn a_subalgebra_is_judged_on_tangent_vectors() -> Result<(), SubalgebraError> {
    let dimensions = |system: Spherical| {
        let noether = system.by(Trapezoidal, 0.05).noether();
        let found = noether.subalgebra(&rotations(), &on(&system, Trapezoidal))?;
        assert!(found.closure.is_closed());
        Ok::<_, SubalgebraError>(
            [&found.lagrangian, &found.conserved, &found.invariant].map(|of| of.dimension()),
        )
    };
    let weightless = Spherical { gravity: 0.0, ..FREE };
    assert_eq!(dimensions(weightless)?, [3, 3, 3]);
    assert_eq!(dimensions(FREE)?, [1, 1, 3]);
    assert_eq!(dimensions(Spherical { gravity: 0.0, ..EVEN })?, [3, 0, 0]);
    // A force that vanishes on N×N is invariant there, where Q×Q would not have it so; one that does not is
    // not.
    assert_eq!(dimensions(Spherical { normal: 0.8, ..weightless })?, [3, 3, 3]);
    assert_eq!(dimensions(Spherical { turning: 0.8, ..weightless })?, [3, 0, 0]);
    Ok(())
}

#[test]
fn the_balance_of_a_run_is_that_of_the_restricted_pair() -> Result<(), StepError> {
    let start = Spherical::states()[0];
    let by = EVEN.by(Midpoint, 0.05);
    let [vertical, level, _] = rotations();
    for generator in [&vertical, &level] {
        let balance = by.noether().balance(generator, &start, by.run(start).take(200))?;
        assert!(balance.is_balanced() && balance.tolerance < 1e-9, "{balance}");
        assert!((balance.end - balance.start).abs() > 0.1);
    }
    // Positive control: reactions do work along a generator that leaves the sphere.
    let along = Generator::translation("y", [0.0, 1.0, 0.0]);
    let unbalanced = by.noether().balance(&along, &start, by.run(start).take(200))?;
    assert!(!unbalanced.is_balanced(), "{unbalanced}");
    Ok(())
}

#[test]
fn the_ledger_leaves_what_the_method_adds_on_the_sphere() -> Result<(), StepError> {
    let start = Spherical::states()[0];
    let of = |h: f64, steps| -> Result<EnergyLedger<f64>, StepError> {
        EVEN.by(Midpoint, h).run(start).ledger().take(steps).sum()
    };
    let (coarse, fine) = (of(0.02, 100)?, of(0.01, 200)?);
    let order = (coarse.remainder() / fine.remainder()).abs().log2();
    assert!(coarse.dissipated > 0.5 && (1.8..2.2).contains(&order), "{order}: {coarse:?} {fine:?}");
    // At rest in the end: all of the energy is gone by friction.
    let long = of(0.02, 4_000)?;
    let lost = start.energy(&EVEN)? + EVEN.gravity;
    assert!((long.change + lost).abs() < 1e-10 && (long.dissipated - lost).abs() < 1e-2 * lost, "{long:?}");
    Ok(())
}

#[test]
fn friction_is_judged_at_the_points_given() -> Result<(), SampleError> {
    // Negative friction along z alone: tangent to the sphere at the equator, normal to it at the poles.
    let system = Spherical { c: [0.4, 0.4, -0.1], ..EVEN };
    let at = |q: [f64; 3], v: [f64; 3]| [TangentPoint { q: q.into(), v: v.into() }];
    assert!(dissipation(&system, &at([0.0, 0.0, -1.0], [0.3, 0.2, 0.0]))?.is_dissipative());
    assert!(!dissipation(&system, &at([1.0, 0.0, 0.0], [0.0, 0.1, 0.5]))?.is_dissipative());
    Ok(())
}

/// A disc that rolls on a plane, with friction in its bearing.
struct Coin;

#[rayleigh_system]
impl Coin {
    fn lagrangian(&self, q: [f64; 4], v: [f64; 4]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1] + 0.25 * v[2] * v[2] + 0.5 * v[3] * v[3]) + 1.5 * q[0]
    }

    fn rayleigh(&self, v: [f64; 4]) -> f64 {
        0.1 * (v[2] * v[2] + v[3] * v[3])
    }

    fn velocity_constraints(&self, q: [f64; 4], v: [f64; 4]) -> [f64; 2] {
        [v[0] - q[2].cos() * v[3], v[1] - q[2].sin() * v[3]]
    }
}

#[test]
fn constraints_of_velocity_have_a_ledger_and_no_momentum_maps() -> Result<(), StepError> {
    let start = State::from_velocity(&Coin, [0.0; 4], [0.0, 0.0, 1.0, 0.0])?;
    let of = |h: f64, steps| -> Result<EnergyLedger<f64>, StepError> {
        Coin.by(Midpoint, h).run(start).ledger().take(steps).sum()
    };
    // `noether` does not compile here; code for systems of any kind is told so.
    assert!(Coin.by(Midpoint, 0.02).noether_if_holonomic().is_none());
    assert!(FREE.by(Midpoint, 0.02).noether_if_holonomic().is_some());
    let (coarse, fine) = (of(0.02, 200)?, of(0.01, 400)?);
    let order = (coarse.remainder() / fine.remainder()).abs().log2();
    assert!(coarse.dissipated > 0.05 && (1.8..2.2).contains(&order), "{order}: {coarse:?} {fine:?}");
    Ok(())
}

/// A sphere whose radius follows the time.
struct Breathing;

#[rayleigh_system]
impl Breathing {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) - 9.81 * q[2]
    }

    fn constraints(&self, q: [f64; 3], t: f64) -> [f64; 1] {
        [q[0] * q[0] + q[1] * q[1] + q[2] * q[2] - (1.0 + 0.2 * t.sin()).powi(2)]
    }
}

#[test]
fn a_sphere_that_breathes_is_asked_at_its_own_times() -> Result<(), SampleError> {
    let view = Breathing.at_time(0.3);
    let by = view.by(Midpoint, 0.05);
    let given = [Pair::new([1.0, 0.1, -0.3], [0.9, 0.2, -0.3])];
    let segments = by.on_constraints(&given)?;
    let radius = |time: f64| 1.0 + 0.2 * time.sin();
    assert_eq!(segments.len(), 3);
    for (k, Pair { q0, q1 }) in segments.iter().enumerate() {
        let time = 0.3 + 0.05 * k as f64;
        assert!((q0.norm() - radius(time)).abs() < 1e-15 && (q1.norm() - radius(time + 0.05)).abs() < 1e-15);
    }
    let [vertical, level, _] = rotations();
    assert!(by.noether().symmetry(&vertical, &segments)?.is_conserved());
    assert!(!by.noether().symmetry(&level, &segments)?.is_conserved());
    // Positive control: what is on the sphere of another time is off it.
    let standing: Vec<_> = segments.iter().map(|s| Pair::new(s.q0, s.q1.normalize() * s.q0.norm())).collect();
    let error = by.noether().symmetry(&vertical, &standing).unwrap_err();
    assert!(matches!(error, SampleError::OffConstraint { index: 0, constraint: 0, .. }), "{error}");
    let q: Vector3<f64> = segments[0].q0;
    let v = q.cross(&Vector3::z()) + q * (0.2 * 0.3_f64.cos() / radius(0.3));
    let state = [State::from_velocity(&view, q, v).unwrap()];
    assert!(by.rayleigh_step(&state).unwrap().is_rayleigh());
    Ok(())
}
