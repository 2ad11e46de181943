//! Functions that jump, rounding and remainders, of fields and constants alone; and arithmetic of another
//! precision than the system's.

use dalembert::nalgebra::SVector;
use dalembert::{Force, Lagrangian};

use super::case;

/// L and its first derivatives at q = 0.3, v = −1.1.
fn seen<S: Lagrangian<1>>(system: &S, q: S::Scalar, v: S::Scalar) -> [S::Scalar; 3] {
    let gradient = system.lagrangian_derivatives(&SVector::from([q]), &SVector::from([v]));
    [gradient.value, gradient.d1[0], gradient.d2[0]]
}

macro_rules! by_each_engine {
    ($($name:ident: $engine:ident of $scalar:ident;)*) => {$(
        mod $name {
            use std::$scalar::consts::TAU;

            pub struct Rounded {
                pub k: $scalar,
                pub phase: $scalar,
                pub steps: i32,
            }

            #[dalembert::rayleigh_system(derivatives = $engine)]
            impl Rounded {
                const G: $scalar = 9.81;
                fn lagrangian(&self, q: [$scalar; 1], v: [$scalar; 1]) -> $scalar {
                    let turns = (self.phase / TAU).floor();
                    let wrapped = (self.phase / TAU).fract() + self.phase.rem_euclid(2.0);
                    let odd = self.k % 2.0 + $scalar::trunc(self.k * 1.5) + (self.k + 0.25) % self.phase;
                    let count = (self.steps % 4) as $scalar + self.steps.rem_euclid(3) as $scalar;
                    let table = [1.0, 2.0, 4.0];
                    Self::G.round() * q[0] + turns * v[0] * v[0] + (wrapped + odd) * q[0] * q[0] * v[0]
                        + count * v[0] + table[2] * self.k.ceil() * q[0].cos()
                }
                fn force(&self, q: [$scalar; 1], _v: [$scalar; 1]) -> [$scalar; 1] {
                    [if self.k.fract() > 0.25 { -self.k.floor() * q[0] } else { 0.0 }]
                }
            }

            pub fn system() -> Rounded {
                Rounded { k: 3.5, phase: 20.0, steps: -6 }
            }
        }
    )*};
}
by_each_engine! {
    auto: auto of f64;
    expanded: expanded of f64;
    num_dual: num_dual of f64;
    single: expanded of f32;
    single_by_duals: num_dual of f32;
}

/// The closed form, in f64: ⌊20/2π⌋ = 3.
fn expected(q: f64, v: f64) -> [f64; 3] {
    let wrapped = 20.0 / std::f64::consts::TAU - 3.0;
    // 3.5 % 2 + ⌊5.25⌋ + 3.75 % 20, and the remainder of 20 by 2, which is 0.
    let c = wrapped + 1.5 + 5.0 + 3.75;
    // −6 % 4 + (−6).rem_euclid(3)
    let count = -2.0;
    [
        10.0 * q + 3.0 * v * v + c * q * q * v + count * v + 16.0 * q.cos(),
        10.0 + 2.0 * c * q * v - 16.0 * q.sin(),
        6.0 * v + c * q * q + count,
    ]
}

#[test]
fn rounding_and_remainders_of_fields_are_numbers_in_every_engine() {
    let expected = expected(0.3, -1.1);
    let of_double = [
        seen(&auto::system(), 0.3, -1.1),
        seen(&expanded::system(), 0.3, -1.1),
        seen(&num_dual::system(), 0.3, -1.1),
    ];
    for seen in of_double {
        for (seen, expected) in seen.iter().zip(expected) {
            assert!((seen - expected).abs() < 1e-14 * (1.0 + expected.abs()), "{seen} {expected}");
        }
    }
    for seen in [seen(&single::system(), 0.3, -1.1), seen(&single_by_duals::system(), 0.3, -1.1)] {
        for (seen, expected) in seen.iter().zip(expected) {
            assert!((f64::from(*seen) - expected).abs() < 4e-6 * (1.0 + expected.abs()), "{seen} {expected}");
        }
    }
    let (q, v) = (SVector::from([0.3]), SVector::from([-1.1]));
    assert_eq!(auto::system().force(&q, &v)[0], -3.0 * 0.3);
    assert_eq!(num_dual::system().force_derivatives(&q, &v).d1[0], -3.0);
}

macro_rules! other_precision {
    ($($name:ident: $engine:ident of $scalar:ident from $other:ident;)*) => {$(
        mod $name {
            pub struct Mixed {
                pub k: $other,
                pub c: [$other; 2],
            }

            #[dalembert::rayleigh_system(derivatives = $engine)]
            impl Mixed {
                fn lagrangian(&self, q: [$scalar; 1], v: [$scalar; 1]) -> $scalar {
                    let stiffness = (self.k * 0.1) as $scalar;
                    let mixed = ((self.k + 1.0) / self.c[0] - self.c[1]) as $scalar;
                    let root = self.k.sqrt() as $scalar + (2.0 * self.c[0]).sin() as $scalar;
                    let n = (self.k * 2.5) as i32;
                    0.5 * v[0] * v[0] + mixed * q[0] * v[0] - 0.5 * stiffness * q[0] * q[0]
                        + root * q[0] + n as $scalar * v[0]
                }
            }

            pub fn system() -> Mixed {
                Mixed { k: 1.7, c: [0.3, 0.9] }
            }
        }
    )*};
}
other_precision! {
    single_fields: auto of f64 from f32;
    single_fields_written_out: expanded of f64 from f32;
    single_fields_by_duals: num_dual of f64 from f32;
    double_fields: expanded of f32 from f64;
}

#[test]
fn arithmetic_of_another_precision_is_rounded_as_rust_rounds_it() {
    let (q, v) = (0.3_f64, -1.1_f64);
    let (k, c) = (1.7_f32, [0.3_f32, 0.9]);
    let [stiffness, mixed, root] = [k * 0.1, (k + 1.0) / c[0] - c[1], k.sqrt()].map(f64::from);
    let root = root + f64::from((2.0 * c[0]).sin());
    let expected = [
        0.5 * v * v + mixed * q * v - 0.5 * stiffness * q * q + root * q + 4.0 * v,
        mixed * v - stiffness * q + root,
        v + mixed * q + 4.0,
    ];
    // The two precisions differ by more than what is allowed.
    assert!((stiffness - 0.17).abs() > 1e-9);
    let systems = [seen(&single_fields::system(), q, v), seen(&single_fields_written_out::system(), q, v)];
    for seen in systems {
        for (seen, expected) in seen.iter().zip(expected) {
            assert!((seen - expected).abs() < 1e-15 * (1.0 + expected.abs()), "{seen} {expected}");
        }
    }
    for (seen, expected) in seen(&single_fields_by_duals::system(), q, v).iter().zip(expected) {
        assert!((seen - expected).abs() < 1e-15 * (1.0 + expected.abs()), "{seen} {expected}");
    }
    let k = (1.7_f64 * 0.1) as f32;
    let slope = seen(&double_fields::system(), 0.0, 0.0);
    let expected = 1.7_f64.sqrt() as f32 + 0.6_f64.sin() as f32;
    assert_eq!(slope[1], expected);
    let second = double_fields::system().lagrangian_derivatives(&SVector::from([0.3]), &SVector::from([0.0]));
    assert_eq!(second.d11[(0, 0)], -k);
}

case! {
    rounding_in_conditions_and_indices: [1] at [([0.3], [1.1]), ([-0.3], [1.1])]
    definitions {
        pub struct System { phase: f64, law: Option<f64>, table: [f64; 4] }
        fn system() -> System { System { phase: 7.75, law: Some(2.6), table: [0.5, 0.7, 1.1, 1.3] } }
    }
    functions {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            let cell = (self.phase / 2.5).floor() as usize;
            let mut phase = self.phase;
            phase %= 2.0;
            let law = match self.law { Some(k) if k.fract() > 0.5 => k.round(), Some(k) => k, None => 0.0 };
            let half = if self.phase % 2.0 > 1.0 { 0.5 } else { q[0] };
            self.table[cell] * v[0] * v[0] + phase * q[0] + law * q[0].powi(3) + half
        }
    }
}
