//! Systems with tables in C, and that the headers of others say nothing of them.

use std::fs;
use std::process::Command;

use dalembert::run::DrivenTrajectory;
use dalembert::system::Table;
use dalembert::{Midpoint, State, StepError};

use super::programs::{Lines, printed};
use crate::systems::constrained::{rods, skate, spherical};
use crate::systems::tables::{Bead, Rocket, RocketAtTime, bead, rocket};
use crate::systems::{cart_pole, ring, swing, winch};
use crate::{folder, program, there};

/// The runs in Rust that `programs/tables.c` makes in C, as it prints them.
fn expected() -> Result<String, StepError> {
    let mut lines = Lines(String::new());
    let rail = Table::monotone([0.0, 0.5, 1.0, 2.0, 3.0], [2.0, 1.0, 0.5, 0.75, 1.0]);
    let system = Rocket {
        mass: 2.0,
        thrust: Table::linear([0.0, 0.25, 2.0, 2.25], [0.0, 60.0, 45.0, 0.0]).expect("increasing x"),
        stages: 0,
        rail: rail.expect("increasing x").straight_beyond(),
    };
    let mut t = 0.0;
    let start = State::from_velocity(&system.at_time(t), [0.0], [0.0])?;
    let mut run = DrivenTrajectory::<RocketAtTime<'static>, Midpoint, 1>::new(0.125, start);
    for _ in 0..40 {
        run.advance(&system.at_time(t))?;
        lines.show("rocket q p", [run.state().q[0], run.state().p[0]]);
        t += 0.125;
    }
    let x = [-1.0, -0.5, 0.25, 0.5, 1.0, 2.0];
    let height = Table::spline(x, [1.0, 0.375, 0.125, 0.25, 0.75, 2.0]).and_then(|table| table.single());
    let bead = Bead { height: height.expect("increasing x") };
    let start = State::from_velocity(&bead, [0.25, 0.125], [0.0, 0.0])?;
    let mut run = DrivenTrajectory::<Bead, Midpoint, 2>::new(0.0625, start);
    for _ in 0..20 {
        run.advance(&bead)?;
        lines.show("bead q", run.state().q.iter().map(|x| f64::from(*x)));
    }
    Ok(lines.0)
}

#[test]
fn tables_that_c_gives_have_the_bits_of_those_of_rust() -> Result<(), StepError> {
    let (folder, expected) = (folder("tables"), expected()?);
    for compiler in there(&["gcc", "clang"]) {
        for flags in [["-std=c99", "-O0"], ["-std=c11", "-O2"]] {
            let found = printed(&program(&folder, compiler, "tables.c", &flags));
            for (found, expected) in found.lines().zip(expected.lines()) {
                assert_eq!(found, expected, "{compiler} {flags:?}");
            }
            assert_eq!(found.lines().count(), expected.lines().count());
        }
        // The control: what does not hold is seen.
        let control = program(&folder, compiler, "tables.c", &["-std=c11", "-DWRONG"]);
        assert!(!Command::new(control).output().expect("a program").status.success());
    }
    assert_eq!(expected.lines().count(), 60);
    Ok(())
}

#[test]
fn headers_of_other_systems_say_nothing_of_tables() {
    let says = |header: dalembert_c::Header| {
        let text = header.to_string().to_lowercase();
        ["table", "interpolation", "wrong_point", "dalembert_points"].map(|word| text.contains(word))
    };
    for header in [cart_pole::HEADER, ring::HEADER, swing::HEADER, winch::HEADER] {
        assert_eq!(says(header), [false; 4], "{}", header.prefix);
    }
    for header in [spherical::HEADER, rods::HEADER, skate::HEADER] {
        assert_eq!(says(header), [false; 4], "{}", header.prefix);
    }
    for header in [rocket::HEADER, bead::HEADER] {
        assert_eq!(says(header), [true; 4], "{}", header.prefix);
    }
}

/// In C++ the class has the function too, and tables are plain structs.
#[test]
fn a_wrong_point_is_found_in_cpp() {
    let folder = folder("tables_in_cpp");
    let source = folder.join("wrong_point.cpp");
    let text = r#"
#include "rocket.h"
#include <cstring>
int main()
{
    rocket_parameters parameters{};
    parameters.mass = 1.0;
    for (int k = 0; k < 4; k++)
        parameters.thrust.x[k] = k;
    parameters.thrust.interpolation = DALEMBERT_SPLINE;
    dalembert_wrong_point wrong;
    if (rocket_run::wrong_point(parameters, wrong) != DALEMBERT_OK)
        return 1;
    rocket_run run;
    const bool refused = run.init(parameters, 0.1, 0.0, {0.0}, {0.0}) == DALEMBERT_NO_INTERPOLATION;
    return refused && std::strcmp(wrong.table, "rail") == 0 ? 0 : 2;
}
"#;
    fs::write(&source, text).expect("a source file");
    for compiler in there(&["g++", "clang++"]) {
        let mut command = Command::new(compiler);
        let program = folder.join(compiler.replace('+', "p"));
        command
            .args(crate::WARNINGS)
            .arg("-std=c++17")
            .arg("-I")
            .arg(&folder)
            .arg("-o")
            .arg(&program)
            .arg(&source);
        let built = crate::output(command.arg(crate::library()).args(["-lpthread", "-ldl", "-lm"]));
        assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
        assert!(Command::new(program).status().expect("a program").success(), "{compiler}");
    }
}
