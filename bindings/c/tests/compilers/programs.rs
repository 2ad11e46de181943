//! Programs in C and C++, run.

use std::path::Path;
use std::process::Command;

use dalembert::run::DrivenTrajectory;
use dalembert::step::{PhaseMatrix, StateBy};
use dalembert::system::Scalar;
use dalembert::{Discretise, Gauss, Midpoint, State, StepError, Trapezoidal};

use crate::systems::{CartPole, DrivenCartPole, DrivenWinch, Ring, Swing, SwingAtTime, Winch};
use crate::{folder, output, program, there, those_that};

/// The run in Rust that `programs/bits.c` makes in C, as it prints it.
pub(super) struct Lines(pub(super) String);

impl Lines {
    pub(super) fn show(&mut self, name: &str, values: impl IntoIterator<Item = f64>) {
        self.0.push_str(name);
        values.into_iter().for_each(|value| self.0.push_str(&format!(" {:016x}", value.to_bits())));
        self.0.push('\n');
    }

    pub(super) fn by_state<S: Scalar + Into<f64>, const N: usize>(
        &mut self,
        name: &str,
        a: &PhaseMatrix<S, N>,
    ) {
        let upper = (0..N)
            .map(|i| a.q_by_q.row(i).iter().chain(a.q_by_p.row(i).iter()).map(|x| (*x).into()).collect());
        let lower = (0..N)
            .map(|i| a.p_by_q.row(i).iter().chain(a.p_by_p.row(i).iter()).map(|x| (*x).into()).collect());
        self.show(name, upper.chain(lower).collect::<Vec<Vec<f64>>>().concat());
    }

    pub(super) fn by<S: Scalar + Into<f64>, const N: usize, const K: usize>(
        &mut self,
        name: &str,
        b: &StateBy<S, N, K>,
    ) {
        let rows = b.q.row_iter().chain(b.p.row_iter()).map(|row| row.iter().map(|x| (*x).into()).collect());
        self.show(name, rows.collect::<Vec<Vec<f64>>>().concat());
    }

    fn cart_pole(&mut self) -> Result<(), StepError> {
        let mut system = CartPole { cart: 1.0, rod: 0.3, half_length: 0.4, friction: [0.3, 0.004] };
        let start = State::from_velocity(&system.driven([0.0]), [0.1, 0.2], [0.0, -0.3])?;
        let mut run = DrivenTrajectory::<DrivenCartPole<'static>, Midpoint, 2>::new(0.01, start);
        let mut u = [0.0];
        for k in 0..50 {
            u = [0.25 * f64::from(k % 5) - 0.5];
            run.advance(&system.driven(u))?;
            self.show("cart_pole q", run.state().q.iter().copied());
            self.show("cart_pole p", run.state().p.iter().copied());
            self.show("cart_pole time", [run.time()]);
        }
        let driven = system.driven(u);
        let taken = run.advance_linearized(&driven)?;
        self.by_state("cart_pole A", &taken.by_state()?);
        self.by("cart_pole B", &taken.by_input::<1>()?);
        let copied = taken.step().state;
        system.rod = 0.35;
        let mut run = DrivenTrajectory::<DrivenCartPole<'static>, Midpoint, 2>::resume(run.present());
        run.change_step_size(0.02);
        run.advance(&system.driven(u))?;
        self.show("cart_pole v", run.state().velocity(&system.driven([0.0]))?.iter().copied());
        self.show("cart_pole energy", [run.state().energy(&system.driven([0.0]))?]);
        let before = system.driven(u).by(Midpoint, -0.01).step(run.state())?.state;
        self.show("cart_pole before", before.q.iter().copied());
        run.correct(before);
        run.advance(&system.driven(u))?;
        self.show("cart_pole corrected", run.state().q.iter().copied());
        self.show("cart_pole time", [run.time()]);
        self.show("cart_pole copy", copied.q.iter().copied());
        Ok(())
    }

    fn ring(&mut self) -> Result<(), StepError> {
        let weights = [[1.0, 0.0, 0.0], [0.0, 0.0, 0.125]];
        let ring = Ring { name: 1, k: 0.01, weights, turns: [1, 2, 3] };
        let start = State::from_velocity(&ring, [0.0, 1.155], [0.5, 0.0])?;
        let mut run = DrivenTrajectory::<Ring, Midpoint, 2>::new(0.125, start);
        for _ in 0..50 {
            run.advance(&ring)?;
            self.show("ring q", run.state().q.iter().map(|x| f64::from(*x)));
        }
        let taken = run.advance_linearized(&ring)?;
        self.by_state("ring A", &taken.by_state()?);
        self.by("ring by k", &taken.by_parameters::<1>()?);
        Ok(())
    }

    fn winch(&mut self) -> Result<(), StepError> {
        let winch = Winch { c: 0.1, a: 0.25 };
        let mut t = 2.0;
        let start = State::from_velocity(&winch.driven([0.0; 2], t), [0.3], [0.1])?;
        let mut run = DrivenTrajectory::<DrivenWinch<'static>, Gauss<2>, 1>::new(0.125, start);
        for k in 0..50 {
            let driven = winch.driven([0.25 * f64::from(k % 3), -0.125 * f64::from(k % 4)], t);
            let taken = run.advance_linearized(&driven)?;
            self.show("winch q", [taken.step().state.q[0]]);
            self.by("winch by u", &taken.by_input::<2>()?);
            self.by("winch by c, a", &taken.by_parameters::<2>()?);
            t += 0.125;
        }
        self.show("winch energy", [run.state().energy(&winch.driven([0.0; 2], t))?]);
        Ok(())
    }

    fn swing(&mut self) -> Result<(), StepError> {
        let swing = Swing { c: 0.1 };
        let start = State::from_velocity(&swing.at_time(0.0), [0.3], [0.1])?;
        let mut run = DrivenTrajectory::<SwingAtTime<'static>, Trapezoidal, 1>::new(0.125, start);
        for k in 0..50 {
            run.advance(&swing.at_time(0.125 * f64::from(k)))?;
            self.show("swing q", [run.state().q[0]]);
        }
        Ok(())
    }
}

fn expected() -> Result<String, StepError> {
    let mut lines = Lines(String::new());
    lines.cart_pole()?;
    lines.ring()?;
    lines.winch()?;
    lines.swing()?;
    Ok(lines.0)
}

pub(super) fn printed(program: &Path) -> String {
    let ended = output(&mut Command::new(program));
    assert!(ended.status.success(), "{}", String::from_utf8_lossy(&ended.stderr));
    String::from_utf8(ended.stdout).expect("text")
}

#[test]
fn programs_in_c_have_the_bits_of_the_run_in_rust() -> Result<(), StepError> {
    let (folder, expected) = (folder("bits"), expected()?);
    for compiler in there(&["gcc", "clang"]) {
        for flags in [["-std=c99", "-O0"], ["-std=c11", "-O2"]] {
            let found = printed(&program(&folder, compiler, "bits.c", &flags));
            for (found, expected) in found.lines().zip(expected.lines()) {
                assert_eq!(found, expected, "{compiler} {flags:?}");
            }
            assert_eq!(found.lines().count(), expected.lines().count());
        }
    }
    assert!(expected.lines().count() > 400);
    Ok(())
}

#[test]
fn wrong_uses_from_c_are_refused() {
    let folder = folder("misuse");
    for compiler in there(&["gcc", "clang"]) {
        for flags in [["-std=c99", "-O0"], ["-std=c11", "-O2"]] {
            assert_eq!(
                printed(&program(&folder, compiler, "misuse.c", &flags)),
                "0 wrong uses were not refused\n"
            );
        }
    }
}

/// The C side looks at every byte that it uses, valgrind at every byte that Rust uses.
#[test]
fn no_byte_is_used_beyond_what_c_declared() {
    let folder = folder("sanitizers");
    let sanitized = ["-std=c11", "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"];
    // clang's sanitizers are a package of their own.
    let sanitizes = |compiler: &str| {
        let mut command = Command::new(compiler);
        command.args(sanitized).arg("-o").arg(folder.join("sanitized"));
        let nothing = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/programs/nothing.c");
        command.arg(nothing).output().is_ok_and(|built| built.status.success())
    };
    for compiler in those_that(&["gcc", "clang"], "have the sanitizers", sanitizes) {
        printed(&program(&folder, compiler, "bits.c", &sanitized));
        printed(&program(&folder, compiler, "misuse.c", &sanitized));
        printed(&program(&folder, compiler, "constrained.c", &sanitized));
        let control = program(&folder, compiler, "bits.c", &[&sanitized[..], &["-DBEYOND"]].concat());
        let said = output(&mut Command::new(control));
        assert!(
            String::from_utf8_lossy(&said.stderr).contains("heap-buffer-overflow"),
            "the sanitizer sees nothing"
        );
    }
    for valgrind in there(&["valgrind"]) {
        let checked = |flags: &[&str]| {
            let mut command = Command::new(valgrind);
            command.args(["--error-exitcode=9", "--leak-check=no", "--quiet"]);
            output(command.arg(program(&folder, "gcc", "bits.c", flags)))
        };
        let said = checked(&["-std=c11", "-O0", "-g"]);
        assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
        assert_eq!(
            checked(&["-std=c11", "-O0", "-g", "-DSHORT"]).status.code(),
            Some(9),
            "valgrind sees nothing"
        );
    }
}

#[test]
fn the_class_has_the_numbers_of_the_functions() {
    let folder = folder("class");
    for compiler in there(&["g++", "clang++"]) {
        for flags in [["-std=c++17", "-O0"], ["-std=c++20", "-O2"]] {
            assert_eq!(printed(&program(&folder, compiler, "wrapper.cpp", &flags)), "as in C\n");
        }
    }
}
