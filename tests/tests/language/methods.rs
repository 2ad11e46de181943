//! Every supported method of `f64`: its value is that of `f64` bit by bit, its derivatives are closed forms
//! to third order of the table below, and at the points where a derivative does not exist it is what the
//! documentation says.

use std::hint::black_box;

use dalembert::generated::dual::{Dual, Real};
use dalembert::nalgebra::{SVector, vector};
use dalembert::{Lagrangian, rayleigh_system};
use num_dual::{Derivative, DualSVec64};

/// One system for each method of one argument: L = f(q).
macro_rules! unary {
    ($($name:ident: $call:expr, $first:expr, $second:expr, [$($x:expr),+];)+) => {
        $(mod $name {
            use super::*;
            pub struct Plain;
            #[rayleigh_system]
            impl Plain {
                fn lagrangian(&self, q: [f64; 1], _v: [f64; 1]) -> f64 {
                    Self::f(q[0])
                }
                fn f(x: f64) -> f64 {
                    let f: fn(f64) -> f64 = $call;
                    f(x)
                }
            }
        })+

        #[test]
        fn methods_of_one_argument() {
            $(for x in [$($x),+] {
                let x: f64 = black_box(x);
                let plain: fn(f64) -> f64 = $call;
                check(stringify!($name), plain(x), &$name::Plain, &[x], &[($first)(x)], &[($second)(x)]);
            })+
        }
    };
}

/// Bits of the value; first and second derivatives to a few units in the last place of their closed form.
fn check<const N: usize>(
    name: &str,
    value: f64,
    system: &impl Lagrangian<N, Scalar = f64>,
    x: &[f64; N],
    first: &[f64; N],
    second: &[f64],
) {
    let q = SVector::from(*x);
    let v = SVector::zeros();
    assert_eq!(system.lagrangian(&q, &v).to_bits(), value.to_bits(), "value of {name} at {x:?}");
    let l = system.lagrangian_derivatives(&q, &v);
    assert_eq!(l.value.to_bits(), value.to_bits(), "value beside derivatives of {name} at {x:?}");
    for i in 0..N {
        assert_near(name, x, first[i], l.d1[i]);
        assert_near(name, x, first[i], system.lagrangian_gradient(&q, &v).d1[i]);
        for j in 0..N {
            assert_near(name, x, second[i * N + j], l.d11[(i, j)]);
        }
    }
}

fn assert_near(name: &str, x: &[f64], expected: f64, actual: f64) {
    let near = (expected - actual).abs() <= 1e-14 * expected.abs() + 1e-300
        || expected == actual
        || (expected.is_nan() && actual.is_nan());
    assert!(near, "{name} at {x:?}: expected {expected}, got {actual}");
}

const LN_2: f64 = std::f64::consts::LN_2;
const LN_10: f64 = std::f64::consts::LN_10;

unary! {
    recip: |x| x.recip(), |x: f64| -1.0 / (x * x), |x: f64| 2.0 / (x * x * x), [0.3, -1.7, 1e100];
    exp: |x| x.exp(), |x: f64| x.exp(), |x: f64| x.exp(), [0.3, -1.7, 40.0];
    exp2: |x| x.exp2(), |x: f64| LN_2 * x.exp2(), |x: f64| LN_2 * LN_2 * x.exp2(), [0.3, -1.7, 40.0];
    exp_m1: |x| x.exp_m1(), |x: f64| x.exp(), |x: f64| x.exp(), [0.3, -1.7, 1e-12];
    ln: |x| x.ln(), |x: f64| 1.0 / x, |x: f64| -1.0 / (x * x), [0.3, 1.7, 1e30];
    log2: |x| x.log2(), |x: f64| 1.0 / (x * LN_2), |x: f64| -1.0 / (x * x * LN_2), [0.3, 1.7, 1e30];
    log10: |x| x.log10(), |x: f64| 1.0 / (x * LN_10), |x: f64| -1.0 / (x * x * LN_10), [0.3, 1.7, 1e30];
    ln_1p: |x| x.ln_1p(), |x: f64| 1.0 / (1.0 + x), |x: f64| -1.0 / ((1.0 + x) * (1.0 + x)), [0.3, -0.7, 1e-12];
    sin: |x| x.sin(), |x: f64| x.cos(), |x: f64| -x.sin(), [0.3, -1.7, 40.0];
    cos: |x| x.cos(), |x: f64| -x.sin(), |x: f64| -x.cos(), [0.3, -1.7, 40.0];
    tan: |x| x.tan(), |x: f64| x.cos().powi(-2), |x: f64| 2.0 * x.sin() * x.cos().powi(-3), [0.3, -1.2, 0.0];
    asin: |x| x.asin(), |x: f64| (1.0 - x * x).powf(-0.5), |x: f64| x * (1.0 - x * x).powf(-1.5), [0.3, -0.7, 0.0];
    acos: |x| x.acos(), |x: f64| -(1.0 - x * x).powf(-0.5), |x: f64| -x * (1.0 - x * x).powf(-1.5), [0.3, -0.7, 0.0];
    atan: |x| x.atan(), |x: f64| 1.0 / (1.0 + x * x), |x: f64| -2.0 * x / (1.0 + x * x).powi(2), [0.3, -1.7, 40.0];
    sinh: |x| x.sinh(), |x: f64| x.cosh(), |x: f64| x.sinh(), [0.3, -1.7, 40.0];
    cosh: |x| x.cosh(), |x: f64| x.sinh(), |x: f64| x.cosh(), [0.3, -1.7, 40.0];
    tanh: |x| x.tanh(), |x: f64| x.cosh().powi(-2), |x: f64| -2.0 * x.tanh() * x.cosh().powi(-2), [0.3, -1.7, 300.0];
    asinh: |x| x.asinh(), |x: f64| (1.0 + x * x).powf(-0.5), |x: f64| -x * (1.0 + x * x).powf(-1.5), [0.3, -1.7, 40.0];
    acosh: |x| x.acosh(), |x: f64| (x * x - 1.0).powf(-0.5), |x: f64| -x * (x * x - 1.0).powf(-1.5), [1.3, 1.7, 40.0];
    atanh: |x| x.atanh(), |x: f64| 1.0 / (1.0 - x * x), |x: f64| 2.0 * x / (1.0 - x * x).powi(2), [0.3, -0.7, 0.0];
    sqrt: |x| x.sqrt(), |x: f64| 0.5 / x.sqrt(), |x: f64| -0.25 * x.powf(-1.5), [0.3, 1.7, 1e-200];
    cbrt: |x| x.cbrt(), |x: f64| (x * x).cbrt().recip() / 3.0, |x: f64| -2.0 / 9.0 / (x * (x * x).cbrt()), [0.3, -1.7, 1e-30];
    abs: |x| x.abs(), |x: f64| x.signum(), |_| 0.0, [0.3, -1.7, 0.0, -0.0];
    signum: |x| x.signum(), |_| 0.0, |_| 0.0, [0.3, -1.7, 0.0, -0.0];
    to_radians: |x| x.to_radians(), |_| std::f64::consts::PI / 180.0, |_| 0.0, [0.3, -170.0];
    to_degrees: |x| x.to_degrees(), |_| 180.0 / std::f64::consts::PI, |_| 0.0, [0.3, -1.7];
    powi_0: |x| x.powi(0), |_| 0.0, |_| 0.0, [0.3, 0.0];
    powi_1: |x| x.powi(1), |_| 1.0, |_| 0.0, [0.3, 0.0];
    powi_2: |x| x.powi(2), |x: f64| 2.0 * x, |_| 2.0, [0.3, -1.7, 0.0];
    powi_3: |x| x.powi(3), |x: f64| 3.0 * x * x, |x: f64| 6.0 * x, [0.3, -1.7, 0.0];
    powi_5: |x| x.powi(5), |x: f64| 5.0 * x.powi(4), |x: f64| 20.0 * x.powi(3), [0.3, -1.7, 0.0];
    powi_minus_2: |x| x.powi(-2), |x: f64| -2.0 * x.powi(-3), |x: f64| 6.0 * x.powi(-4), [0.3, -1.7];
    powf_half: |x| x.powf(0.5), |x: f64| 0.5 * x.powf(-0.5), |x: f64| -0.25 * x.powf(-1.5), [0.3, 1.7];
    powf_5_halves: |x| x.powf(2.5), |x: f64| 2.5 * x.powf(1.5), |x: f64| 3.75 * x.powf(0.5), [0.3, 1.7, 0.0];
    powf_2: |x| x.powf(2.0), |x: f64| 2.0 * x, |_| 2.0, [0.3, -1.7, 0.0];
    log_3: |x| x.log(3.0), |x: f64| 1.0 / (x * 3_f64.ln()), |x: f64| -1.0 / (x * x * 3_f64.ln()), [0.3, 1.7];
}

/// One system for each method of two arguments: L = f(q₀, q₁), with (∂₀, ∂₁) and (∂₀₀, ∂₀₁, ∂₁₁).
macro_rules! binary {
    ($($name:ident: $call:expr, $first:expr, $second:expr, [$($x:expr),+];)+) => {
        $(mod $name {
            use super::*;
            pub struct Plain;
            #[rayleigh_system]
            impl Plain {
                fn lagrangian(&self, q: [f64; 2], _v: [f64; 2]) -> f64 {
                    let f: fn(f64, f64) -> f64 = $call;
                    f(q[0], q[1])
                }
            }
        })+

        #[test]
        fn methods_of_two_arguments() {
            $(for (x, y) in [$($x),+] {
                let (x, y): (f64, f64) = black_box((x, y));
                let plain: fn(f64, f64) -> f64 = $call;
                let [a, b, c]: [f64; 3] = ($second)(x, y);
                check(stringify!($name), plain(x, y), &$name::Plain, &[x, y], &($first)(x, y), &[a, b, b, c]);
            })+
        }
    };
}

type Pair = fn(f64, f64) -> [f64; 2];
type Triple = fn(f64, f64) -> [f64; 3];
const FLAT: Triple = |_, _| [0.0; 3];

binary! {
    atan2: |y, x| y.atan2(x),
        |y: f64, x: f64| [x / (x * x + y * y), -y / (x * x + y * y)],
        |y: f64, x: f64| {
            let s = (x * x + y * y).powi(2);
            [-2.0 * x * y / s, (y - x) * (y + x) / s, 2.0 * x * y / s]
        },
        [(0.3, 0.8), (0.3, -0.8), (-2.3, -0.8), (2.3, 0.0), (-0.0, -1.0), (0.0, -1.0)];
    hypot: |x, y| x.hypot(y),
        |x: f64, y: f64| [x / x.hypot(y), y / x.hypot(y)],
        |x: f64, y: f64| {
            let r = x.hypot(y);
            [(y / r).powi(2) / r, -(x / r) * (y / r) / r, (x / r).powi(2) / r]
        },
        [(0.3, 0.8), (-3.0, 4.0), (2.3, 0.0), (1e200, -1e200), (1e-150, 1e-150)];
    copysign: |x, y| x.copysign(y),
        |x: f64, y: f64| [x.signum() * y.signum(), 0.0], FLAT,
        [(0.3, 0.8), (0.3, -0.8), (-0.3, -0.8), (-0.3, -0.0), (0.3, 0.0)];
    min: |x, y| x.min(y), ((|x, y| if y < x { [0.0, 1.0] } else { [1.0, 0.0] }) as Pair), FLAT,
        [(0.3, 0.8), (0.8, 0.3), (0.5, 0.5)];
    max: |x, y| x.max(y), ((|x, y| if y > x { [0.0, 1.0] } else { [1.0, 0.0] }) as Pair), FLAT,
        [(0.3, 0.8), (0.8, 0.3), (0.5, 0.5)];
    midpoint: |x, y| x.midpoint(y), ((|_, _| [0.5, 0.5]) as Pair), FLAT, [(0.3, 0.8), (f64::MAX, f64::MAX), (1.0, -1.0)];
    mul_add: |x, y| x.mul_add(y, -0.1), ((|x, y| [y, x]) as Pair), ((|_, _| [0.0, 1.0, 0.0]) as Triple),
        [(0.1, 1.0), (0.3, 0.8), (1.0 / 3.0, 3.0)];
    powf: |x, y| x.powf(y),
        |x: f64, y: f64| [y * x.powf(y - 1.0), x.powf(y) * x.ln()],
        |x: f64, y: f64| {
            [y * (y - 1.0) * x.powf(y - 2.0), x.powf(y - 1.0) * (1.0 + y * x.ln()), x.powf(y) * x.ln() * x.ln()]
        },
        [(0.3, 0.8), (1.7, -2.0), (1.7, 3.0)];
    log: |x, y| x.log(y),
        |x: f64, y: f64| [1.0 / (x * y.ln()), -x.ln() / (y * y.ln() * y.ln())],
        |x: f64, y: f64| {
            let (l, m) = (x.ln(), y.ln());
            [-1.0 / (x * x * m), -1.0 / (x * y * m * m), l * (1.0 / (m * m) + 2.0 / (m * m * m)) / (y * y)]
        },
        [(0.3, 2.8), (1.7, 10.0)];
    clamp: |x, y| x.clamp(-0.5, y), ((|x, y| if x > y { [0.0, 1.0] } else if x < -0.5 { [0.0, 0.0] } else { [1.0, 0.0] }) as Pair),
        FLAT, [(0.3, 0.8), (0.9, 0.8), (-0.9, 0.8), (0.8, 0.8)];
}

#[test]
fn a_wrong_value_or_derivative_is_seen() {
    let seen = |value: f64, first: f64, second: f64| {
        std::panic::catch_unwind(|| check("sin", value, &sin::Plain, &[0.3], &[first], &[second])).is_err()
    };
    let (sine, cosine) = 0.3_f64.sin_cos();
    assert!(!seen(sine, cosine, -sine));
    assert!(seen(sine.next_up(), cosine, -sine));
    assert!(seen(sine, cosine * (1.0 + 1e-13), -sine));
    assert!(seen(sine, cosine, -sine * (1.0 + 1e-13)));
}

/// `f` and its derivative with respect to x.
fn with_derivative(f: impl Fn(Real<Number>) -> Real<Number>, x: f64) -> (f64, f64) {
    let f = f(Real(Number::new(x, Derivative::some(vector![1.0])))).0;
    (f.re, f.eps.0.map_or(0.0, |eps| eps[0]))
}

type Number = DualSVec64<1>;

#[test]
fn special_points_are_as_documented() {
    for zero in [0.0, -0.0] {
        assert_eq!(with_derivative(|x| x.abs(), zero), (0.0, 1_f64.copysign(zero)));
        assert_eq!(with_derivative(|x| x.signum(), zero), (1_f64.copysign(zero), 0.0));
        assert_eq!(with_derivative(|x| x.cbrt(), zero).1, f64::INFINITY);
    }
    assert_eq!(with_derivative(|x| x.sqrt(), 0.0), (0.0, f64::INFINITY));
    assert_eq!(with_derivative(|x| x.powf(0.5.into()), 0.0), (0.0, f64::INFINITY));
    assert_eq!(with_derivative(|x| x.powf(1.5.into()), 0.0), (0.0, 0.0));
    // An argument whose own derivative is 0: ∞ · 0.
    assert!(with_derivative(|x| (x * x).sqrt(), 0.0).1.is_nan());
    let (value, derivative) = with_derivative(|x| x.hypot(0.0.into()), 0.0);
    assert!(value == 0.0 && derivative.is_nan());
    let (value, derivative) = with_derivative(|x| x.atan2(0.0.into()), 0.0);
    assert!(value == 0.0 && derivative.is_nan());
    // Equal numbers: the first.
    assert_eq!(with_derivative(|x| x.min(0.5.into()), 0.5), (0.5, 1.0));
    assert_eq!(with_derivative(|x| x.max(0.5.into()), 0.5), (0.5, 1.0));
    assert_eq!(with_derivative(|x| Real::<_>::from(0.5).max(x), 0.5), (0.5, 0.0));
    // A NaN is dropped by min and max, as by f64.
    assert_eq!(with_derivative(|x| x.min(f64::NAN.into()), 0.5), (0.5, 1.0));
    assert_eq!(with_derivative(|x| x.max(f64::NAN.into()), 0.5), (0.5, 1.0));
    assert_eq!(with_derivative(|_| Real::<_>::from(f64::NAN).max(0.25.into()), 0.5), (0.25, 0.0));
    // Beyond the range where sinh and cosh overflow.
    assert_eq!(with_derivative(|x| x.tanh(), 800.0), (1.0, 0.0));
}

#[test]
fn questions_see_the_value_alone() {
    let real = <f64 as Dual<f64>>::real;
    assert!(real(f64::NAN).is_nan() && !real(1.0).is_nan());
    assert!(real(1.0).is_finite() && !real(f64::INFINITY).is_finite() && !real(f64::NAN).is_finite());
    assert!(real(f64::NEG_INFINITY).is_infinite() && !real(f64::NAN).is_infinite());
    assert!(real(0.0).is_sign_positive() && real(-0.0).is_sign_negative());
    assert!(real(1.0).is_normal() && !real(0.0).is_normal() && real(1e-310).is_subnormal());
    assert_eq!(real(-0.0).total_cmp(&real(0.0)), std::cmp::Ordering::Less);
    assert_eq!(real(1.0).partial_cmp(&real(f64::NAN)), None);
}

/// Sums and products of `f64` start from −0 and 1.
#[test]
fn the_sum_of_nothing_is_that_of_f64() {
    let real = <f64 as Dual<f64>>::real;
    let none: [f64; 0] = [];
    assert_eq!(
        std::iter::empty::<Real<f64>>().sum::<Real<f64>>().0.to_bits(),
        none.iter().sum::<f64>().to_bits()
    );
    assert_eq!([real(-0.0)].iter().sum::<Real<f64>>().0.to_bits(), [-0.0_f64].iter().sum::<f64>().to_bits());
    assert_eq!(none.iter().product::<f64>(), std::iter::empty::<Real<f64>>().product::<Real<f64>>().0);
}

/// The same for `f32`, whose constants differ from rounded `f64` ones.
#[test]
fn f32_methods_give_the_bits_of_f32() {
    let real = <f32 as Dual<f32>>::real;
    for x in [0.3_f32, 1.7, 12.5, 0.77, 123.4] {
        let x = black_box(x);
        assert_eq!(real(x).to_radians().0.to_bits(), x.to_radians().to_bits());
        assert_eq!(real(x).to_degrees().0.to_bits(), x.to_degrees().to_bits());
        assert_eq!(real(x).sin().0.to_bits(), x.sin().to_bits());
        assert_eq!(real(x).powi(7).0.to_bits(), x.powi(7).to_bits());
        assert_eq!(real(x).powf(real(1.3)).0.to_bits(), x.powf(1.3).to_bits());
        assert_eq!(real(x).mul_add(real(3.3), real(-0.1)).0.to_bits(), x.mul_add(3.3, -0.1).to_bits());
        assert_eq!(real(x).hypot(real(2.0)).0.to_bits(), x.hypot(2.0).to_bits());
        assert_eq!(real(x).log(real(3.0)).0.to_bits(), x.log(3.0).to_bits());
        assert_eq!(real(x).midpoint(real(3.0)).0.to_bits(), x.midpoint(3.0).to_bits());
    }
}
