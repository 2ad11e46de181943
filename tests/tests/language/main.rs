//! The language of `#[rayleigh_system]`: what works as written in Rust works as written under the attribute.
//!
//! Each case is compiled twice from the same tokens, with and without the attribute. The value of the
//! annotated function must equal that of the plain one bit by bit, first derivatives must agree with
//! difference quotients of the plain function, second derivatives with difference quotients of the first
//! ones.

#![allow(deprecated, reason = "some cases are left to dual numbers, which is warned of")]

mod characteristics;
mod constants;
mod control_flow;
mod conversions;
mod derivatives;
mod differentiable;
mod early_returns;
mod engines;
mod enums;
mod fields;
mod forms;
mod found_by_fuzzing;
mod fragments;
mod gauss_engines;
mod hygiene;
mod jumps;
mod methods;
mod names;
mod own_methods;
mod own_types;
mod quiet;
mod semantics;
mod singular;
mod statements;
mod structure;
mod tables;
mod three_engines;
mod user_functions;
mod who_takes_time;

use dalembert::nalgebra::SVector;
use dalembert::system::{Derivatives, Gradient};

/// One case: `definitions` and the functions of the system, compiled plain and annotated.
///
/// Definitions hold `struct System` and `fn system() -> System`. The points are (q, v).
macro_rules! case {
    (
        $(#[$doc:meta])*
        $case:ident: [$n:literal] at [$(($q:expr, $v:expr)),+ $(,)?]
        definitions { $($definitions:tt)* }
        functions { $($functions:tt)* }
    ) => {
        $(#[$doc])*
        mod $case {
            mod plain {
                #![allow(non_snake_case, reason = "a local may be named like a generated type")]
                #![allow(dead_code, reason = "the annotated twin uses all of it")]
                #![allow(clippy::all, reason = "cases spell out forms that users write")]
                $($definitions)*
                impl System { $($functions)* }
                pub fn value(q: [f64; $n], v: [f64; $n]) -> f64 {
                    system().lagrangian(q, v)
                }
            }

            mod annotated {
                #![allow(non_snake_case, reason = "a local may be named like a generated type")]
                #![allow(clippy::all, reason = "cases spell out forms that users write")]
                use dalembert::Lagrangian as _;
                $($definitions)*
                #[dalembert::rayleigh_system]
                impl System { $($functions)* }
                pub fn value(q: [f64; $n], v: [f64; $n]) -> f64 {
                    system().lagrangian(q, v)
                }
                pub fn gradient(q: &$crate::Vector<$n>, v: &$crate::Vector<$n>) -> dalembert::system::Gradient<f64, $n> {
                    system().lagrangian_gradient(q, v)
                }
                pub fn derivatives(q: &$crate::Vector<$n>, v: &$crate::Vector<$n>) -> dalembert::system::Derivatives<f64, $n> {
                    system().lagrangian_derivatives(q, v)
                }
            }

            #[test]
            fn value_and_derivatives_are_those_of_the_plain_function() {
                $(
                    let (q, v): ([f64; $n], [f64; $n]) = ($q, $v);
                    let (plain, annotated) = (plain::value(q, v), annotated::value(q, v));
                    assert_eq!(plain.to_bits(), annotated.to_bits(), "{plain} {annotated} at {q:?} {v:?}");
                    $crate::assert_derivatives(
                        |q, v| plain::value((*q).into(), (*v).into()),
                        annotated::gradient,
                        annotated::derivatives,
                        &q.into(),
                        &v.into(),
                    );
                )+
            }
        }
    };
}
pub(crate) use case;

pub(crate) type Vector<const N: usize> = SVector<f64, N>;

/// Fourth-order central difference of `f` along the i-th unit vector; error of the order of ε^(4/5).
fn difference(f: impl Fn(f64) -> f64) -> f64 {
    const H: f64 = 1e-3;
    (8.0 * (f(H) - f(-H)) - (f(2.0 * H) - f(-2.0 * H))) / (12.0 * H)
}

/// Largest error of the first derivatives against difference quotients of `value`, and of the second
/// derivatives against difference quotients of `gradient`, relative to 1 + |derivative|.
pub(crate) fn derivative_error<const N: usize>(
    value: impl Fn(&Vector<N>, &Vector<N>) -> f64,
    gradient: impl Fn(&Vector<N>, &Vector<N>) -> Gradient<f64, N>,
    derivatives: impl Fn(&Vector<N>, &Vector<N>) -> Derivatives<f64, N>,
    q: &Vector<N>,
    v: &Vector<N>,
) -> f64 {
    let (first, second) = (gradient(q, v), derivatives(q, v));
    let mut worst = 0.0_f64;
    let mut compare = |expected: f64, actual: f64| {
        let error = (actual - expected).abs() / (1.0 + expected.abs());
        worst = if error.is_nan() { f64::INFINITY } else { worst.max(error) };
    };
    compare(first.value, second.value);
    let shifted = |x: &Vector<N>, i: usize, by: f64| {
        let mut x = *x;
        x[i] += by;
        x
    };
    for i in 0..N {
        let by_q = difference(|s| value(&shifted(q, i, s), v));
        let by_v = difference(|s| value(q, &shifted(v, i, s)));
        compare(by_q, first.d1[i]);
        compare(by_v, first.d2[i]);
        compare(by_q, second.d1[i]);
        compare(by_v, second.d2[i]);
        for j in 0..N {
            compare(difference(|s| gradient(&shifted(q, j, s), v).d1[i]), second.d11[(i, j)]);
            compare(difference(|s| gradient(q, &shifted(v, j, s)).d1[i]), second.d12[(i, j)]);
            compare(difference(|s| gradient(q, &shifted(v, j, s)).d2[i]), second.d22[(i, j)]);
        }
    }
    worst
}

/// Difference quotients with H = 1e-3 reach 1e-10 on functions of order 1.
const TOLERANCE: f64 = 1e-9;

pub(crate) fn assert_derivatives<const N: usize>(
    value: impl Fn(&Vector<N>, &Vector<N>) -> f64,
    gradient: impl Fn(&Vector<N>, &Vector<N>) -> Gradient<f64, N>,
    derivatives: impl Fn(&Vector<N>, &Vector<N>) -> Derivatives<f64, N>,
    q: &Vector<N>,
    v: &Vector<N>,
) {
    let error = derivative_error(value, gradient, derivatives, q, v);
    assert!(error < TOLERANCE, "derivatives differ by {error:e} at {q:?} {v:?}");
}

/// The check itself must see a wrong derivative: each one scaled by 1 + 1e-6 in turn.
#[test]
fn a_wrong_derivative_is_seen() {
    let value = |q: &Vector<1>, v: &Vector<1>| q[0].sin() * v[0] * v[0];
    let gradient = |q: &Vector<1>, v: &Vector<1>| Gradient {
        value: value(q, v),
        d1: [q[0].cos() * v[0] * v[0]].into(),
        d2: [2.0 * q[0].sin() * v[0]].into(),
    };
    let right = |q: &Vector<1>, v: &Vector<1>| Derivatives {
        value: value(q, v),
        d1: gradient(q, v).d1,
        d2: gradient(q, v).d2,
        d11: [-q[0].sin() * v[0] * v[0]].into(),
        d12: [2.0 * q[0].cos() * v[0]].into(),
        d22: [2.0 * q[0].sin()].into(),
    };
    let (q, v) = ([0.7].into(), [1.3].into());
    assert!(derivative_error(value, gradient, right, &q, &v) < TOLERANCE);
    for wrong in 0..6 {
        let derivatives = |q: &Vector<1>, v: &Vector<1>| {
            let mut d = right(q, v);
            let factor = 1.0 + 1e-6;
            match wrong {
                0 => d.value *= factor,
                1 => d.d1 *= factor,
                2 => d.d2 *= factor,
                3 => d.d11 *= factor,
                4 => d.d12 *= factor,
                _ => d.d22 *= factor,
            }
            d
        };
        assert!(derivative_error(value, gradient, derivatives, &q, &v) > TOLERANCE, "{wrong}");
    }
}
