//! Systems with constraints in C, and that the headers of others say nothing of them.

use dalembert::run::DrivenTrajectory;
use dalembert::{Discretise, Midpoint, State, StepError, Trapezoidal};

use super::programs::{Lines, printed};
use crate::systems::constrained::{DrivenRods, Rods, Skate, SkateAtTime, Spherical, rods, skate, spherical};
use crate::systems::{cart_pole, ring, swing, winch};
use crate::{folder, program, there};

/// The runs in Rust that `programs/constrained.c` makes in C, as it prints them.
fn expected() -> Result<String, StepError> {
    let mut lines = Lines(String::new());
    of_sphere(&mut lines)?;
    of_rods(&mut lines)?;
    of_skate(&mut lines)?;
    Ok(lines.0)
}

fn of_sphere(lines: &mut Lines) -> Result<(), StepError> {
    let system = Spherical { m: 1.3, c: 0.4 };
    let nearest = State::nearest(&system, [1.0, 0.1, 0.0], [0.1, 1.0, 0.0])?;
    let start = State::from_velocity(&system, nearest.q, nearest.velocity(&system)?)?;
    let mut run = DrivenTrajectory::<Spherical, Midpoint, 3>::new(0.05, start);
    for _ in 0..50 {
        let before = *run.state();
        let step = run.advance(&system)?;
        lines.show("spherical q", run.state().q.iter().copied());
        let lambda = system.by(Midpoint, 0.05).reactions::<1>(&before, &step)?;
        lines.show("spherical lambda", lambda.iter().copied());
    }
    let before = *run.state();
    let taken = run.advance_linearized(&system)?;
    lines.by_state("spherical A", &taken.by_state()?);
    let lambda = system.by(Midpoint, 0.05).reactions::<1>(&before, taken.step())?;
    lines.show("spherical lambda", lambda.iter().copied());
    Ok(())
}

fn of_rods(lines: &mut Lines) -> Result<(), StepError> {
    let system = Rods { m: [1.0, 0.7] };
    let start = State::from_velocity(&system.driven([0.0; 2]), [0.6, -0.8, 0.6, -1.6], [0.0; 4])?;
    let mut run = DrivenTrajectory::<DrivenRods<'static>, Trapezoidal, 4>::new(0.01, start);
    let mut u = [0.0, 2.0];
    for k in 0..50 {
        u[0] = 0.25 * f64::from(k % 3);
        let (before, driven) = (*run.state(), system.driven(u));
        let step = run.advance(&driven)?;
        lines.show("rods q", run.state().q.iter().copied());
        let lambda = driven.by(Trapezoidal, 0.01).reactions::<2>(&before, &step)?;
        lines.show("rods lambda", lambda.iter().copied());
    }
    let driven = system.driven(u);
    let taken = run.advance_linearized(&driven)?;
    lines.by("rods B", &taken.by_input::<2>()?);
    lines.by("rods by m", &taken.by_parameters::<2>()?);
    Ok(())
}

fn of_skate(lines: &mut Lines) -> Result<(), StepError> {
    let (system, mut t) = (Skate { m: 2.0, omega: 0.5 }, 0.5);
    let at = system.at_time(t);
    let nearest = State::nearest(&at, [0.0, 0.0, 0.25], [3.0, 0.0, 0.0])?;
    let start = State::from_velocity(&at, nearest.q, nearest.velocity(&at)?)?;
    let mut run = DrivenTrajectory::<SkateAtTime<'static>, Midpoint, 3>::new(0.0625, start);
    for _ in 0..50 {
        let (before, at) = (*run.state(), system.at_time(t));
        let step = run.advance(&at)?;
        lines.show("skate q", run.state().q.iter().map(|x| f64::from(*x)));
        let lambda = at.by(Midpoint, 0.0625).reactions::<2>(&before, &step)?;
        lines.show("skate lambda", lambda.iter().map(|x| f64::from(*x)));
        t += 0.0625;
    }
    Ok(())
}

#[test]
fn constrained_systems_in_c_have_the_bits_of_the_run_in_rust() -> Result<(), StepError> {
    let (folder, expected) = (folder("constrained"), expected()?);
    for compiler in there(&["gcc", "clang"]) {
        for flags in [["-std=c99", "-O0"], ["-std=c11", "-O2"]] {
            let found = printed(&program(&folder, compiler, "constrained.c", &flags));
            for (found, expected) in found.lines().zip(expected.lines()) {
                assert_eq!(found, expected, "{compiler} {flags:?}");
            }
            assert_eq!(found.lines().count(), expected.lines().count());
        }
        // The control: what does not hold is seen.
        let control = program(&folder, compiler, "constrained.c", &["-std=c11", "-DWRONG"]);
        assert!(!std::process::Command::new(control).output().expect("a program").status.success());
    }
    assert!(expected.lines().count() > 300);
    Ok(())
}

#[test]
fn headers_of_other_systems_say_nothing_of_constraints() {
    let says = |header: dalembert_c::Header| {
        let text = header.to_string().to_lowercase();
        ["constraint", "violation", "nearest", "reactions"].map(|word| text.contains(word))
    };
    for header in [cart_pole::HEADER, ring::HEADER, swing::HEADER, winch::HEADER] {
        assert_eq!(says(header), [false; 4], "{}", header.prefix);
    }
    for header in [spherical::HEADER, rods::HEADER, skate::HEADER] {
        assert_eq!(says(header), [true; 4], "{}", header.prefix);
    }
}
