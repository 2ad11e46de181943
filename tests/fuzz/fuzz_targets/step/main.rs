//! Any state, step size, guess and parameters: a step, or an error with a name. No panic, bounded work,
//! nothing lost on an error, nothing infinite called a step, no residual beyond what the solver promises.

#![no_main]

mod exercise;
mod numbers;
mod promise;
mod systems;

use std::sync::OnceLock;

use dalembert::{Fitted, FittedTrapezoidal, Gauss, Midpoint, OneSided, Trapezoidal};
use dalembert_scenes::{DoublePendulum, Kepler, Oscillator, SpringChain8};
use libfuzzer_sys::fuzz_target;

use exercise::Exercise;
use numbers::Bytes;
use systems::{ByDualNumbers, Cart, Counted, Coupled, Degenerate, Relativistic, Ring, Rubbing, Single};

/// Stepped by each of the rules; the promise on the residual is that of [`promise`] or, for several stages,
/// of the report.
macro_rules! by_rules {
    ($exercise:ident, $choice:ident: $($system:expr, $n:literal, [$($rule:expr),*], [$($stages:expr),*];)*) => {
        let mut left = $choice;
        $(
            $(
                if left == 0 {
                    $exercise.composed::<_, $n>(&$system);
                    return $exercise.by_rule::<_, _, $n>(&$system, $rule);
                }
                left -= 1;
            )*
            $(
                if left == 0 {
                    $exercise.by_any_rule::<_, _, $n>(&$system, $stages);
                    return;
                }
                left -= 1;
            )*
        )*
        assert_eq!(left, 0);
    };
}

fuzz_target!(|data: &[u8]| run(data));

static SHOW: OnceLock<bool> = OnceLock::new();

fn run(data: &[u8]) {
    let bytes = &mut Bytes::new(data);
    let choice = bytes.byte();
    let [a, b, c, d] = bytes.numbers();
    let exercise = Exercise::new(bytes);
    // What an input means: `FUZZ_SHOW=1 tests/fuzz/target/…/step tests/fuzz/artifacts/step/crash-…`.
    if SHOW.get_or_init(|| std::env::var_os("FUZZ_SHOW").is_some()) == &true {
        eprintln!("pair {} of a system and a rule, parameters {:?}, {exercise:?}", choice % 40, [a, b, c, d]);
    }
    // 39 pairs of a system and a rule, and one system that counts.
    let choice = choice % 40;
    by_rules!(exercise, choice:
        Oscillator { m: a, k: b, r: c }, 1, [Midpoint, Trapezoidal, Fitted, FittedTrapezoidal, OneSided], [Gauss::<1>, Gauss::<3>];
        Rubbing { m: a, r: b, e: c, c: d }, 1, [Midpoint, Trapezoidal, OneSided], [Gauss::<2>];
        DoublePendulum { m: [1.0, a], l: [1.0, b], g: c, c: [d; 2] }, 2, [Midpoint, Trapezoidal], [Gauss::<2>, Gauss::<4>];
        Ring { a, k: b }, 2, [Midpoint, Trapezoidal, Fitted, FittedTrapezoidal], [Gauss::<2>];
        SpringChain8 { m: [a; 8], stiffness: 1.0, hardening: b, friction: c }, 8, [Midpoint, Trapezoidal], [];
        Coupled { m: a, a: b, r: c }, 3, [Midpoint], [Gauss::<2>];
        Kepler { k: a }, 2, [Midpoint, Trapezoidal], [Gauss::<3>];
        Relativistic { m: a, k: b }, 1, [Midpoint], [Gauss::<2>];
        ByDualNumbers { m: a, k: b, r: c }, 2, [Midpoint, Trapezoidal], [];
        Degenerate { m: a }, 2, [Midpoint, Trapezoidal], [Gauss::<2>];
        Single { m: a as f32, r: b as f32 }, 2, [Midpoint, Trapezoidal], [Gauss::<2>];
        Cart { m: a, c: b }.driven([c], d), 1, [Midpoint, Trapezoidal], [];
    );
    exercise.bounded_work(&Counted { m: a, a: b, c });
}
