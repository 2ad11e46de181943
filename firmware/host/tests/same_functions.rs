//! With the features `std` and `libm`, every way to a value takes the runtime's elementary functions, none
//! the platform's.

use dalembert::nalgebra::SVector;
use dalembert::{Elementary, Force, Lagrangian, Rayleigh, rayleigh_system};
use firmware_scenes::language::{Double, Single};

/// The same body by both engines: one sum of functions in which libm and the platform's library differ
/// somewhere.
macro_rules! both_engines {
    ($expanded:ident $by_num_dual:ident $float:ident) => {
        both_engines!(@engine $expanded expanded $float);
        both_engines!(@engine $by_num_dual num_dual $float);
    };
    (@engine $name:ident $engine:ident $float:ident) => {
        struct $name;

        #[rayleigh_system(derivatives = $engine)]
        impl $name {
            fn lagrangian(&self, q: [$float; 1], v: [$float; 1]) -> $float {
                0.5 * v[0] * v[0] + q[0].sin() + q.iter().map(|x| x.cos()).sum::<$float>() + Self::more(q[0])
            }

            fn more(x: $float) -> $float {
                $float::tan(x) + x.exp() + $float::powf(2.0 + x.tanh(), 0.3) + x.mul_add(2.0, x.asinh())
            }
        }
    };
}
both_engines!(Expanded ByNumDual f64);
both_engines!(ExpandedSingle ByNumDualSingle f32);

/// What the bodies above say, by functions of the runtime named one by one.
fn explicit<S: Elementary>(x: S, v: S) -> S {
    let [half, two, exponent] = [0.5, 2.0, 0.3].map(S::constant);
    let more = Elementary::tan(x)
        + Elementary::exp(x)
        + Elementary::powf(two + Elementary::tanh(x), exponent)
        + Elementary::mul_add(x, two, Elementary::asinh(x));
    half * v * v + Elementary::sin(x) + Elementary::cos(x) + more
}

fn points() -> impl Iterator<Item = f64> {
    (0..2000).map(|i| -9.0 + 0.009_013 * f64::from(i))
}

#[test]
fn both_engines_and_the_plain_function_are_the_runtimes() {
    let mut differs = 0;
    for x in points() {
        let expected = explicit(x, 0.3);
        let (q, v) = (SVector::from([x]), SVector::from([0.3]));
        assert_eq!(Expanded.lagrangian([x], [0.3]), expected);
        assert_eq!(Lagrangian::lagrangian(&Expanded, &q, &v), expected);
        assert_eq!(Expanded.lagrangian_gradient(&q, &v).value, expected);
        assert_eq!(Expanded.lagrangian_derivatives(&q, &v).value, expected);
        assert_eq!(ByNumDual.lagrangian([x], [0.3]), expected);
        assert_eq!(ByNumDual.lagrangian_gradient(&q, &v).value, expected);
        // Positive control: the platform's functions give other bits somewhere.
        let more = x.tan() + x.exp() + f64::powf(2.0 + x.tanh(), 0.3) + x.mul_add(2.0, x.asinh());
        differs += u32::from(0.5 * 0.3 * 0.3 + x.sin() + x.cos() + more != expected);
    }
    assert!(differs > 0);
}

#[test]
fn so_they_are_in_single_precision() {
    for x in points().map(|x| x as f32) {
        let expected = explicit(x, 0.3);
        let (q, v) = (SVector::from([x]), SVector::from([0.3]));
        assert_eq!(ExpandedSingle.lagrangian([x], [0.3]), expected);
        assert_eq!(ExpandedSingle.lagrangian_gradient(&q, &v).value, expected);
        assert_eq!(ByNumDualSingle.lagrangian([x], [0.3]), expected);
    }
}

#[test]
fn every_way_to_call_a_function_gives_one_value() {
    macro_rules! one_value {
        ($system:expr, $float:ident) => {
            for x in points().map(|x| x as $float) {
                let (q, v) = ([x, 0.4 - x], [0.2, -0.7]);
                let (at, moving) = (SVector::from(q), SVector::from(v));
                let plain = $system.lagrangian(q, v);
                assert!(plain.is_finite());
                assert_eq!(plain, $system.lagrangian_gradient(&at, &moving).value);
                assert_eq!(plain, $system.lagrangian_derivatives(&at, &moving).value);
                assert_eq!($system.rayleigh(q, v), $system.rayleigh_gradient(&at, &moving).value);
                assert_eq!(SVector::from($system.force(q, v)), $system.force_derivatives(&at, &moving).value);
            }
        };
    }
    one_value!(Double { k: 1.5 }, f64);
    one_value!(Single { k: 1.5 }, f32);
}

#[test]
fn sine_and_cosine_together_are_those_alone() {
    for x in points() {
        assert_eq!(Elementary::sin_cos(x), (Elementary::sin(x), Elementary::cos(x)));
        let x = x as f32;
        assert_eq!(Elementary::sin_cos(x), (Elementary::sin(x), Elementary::cos(x)));
    }
}
