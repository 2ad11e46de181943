//! Types with operators, methods and a `Deref` of their own, and two locals of one name under different
//! hygiene: the function that rustc compiles, its value and its derivatives are one.

use std::ops::{Deref, Mul};

use dalembert::nalgebra::{Vector1, vector};
use dalembert::system::{Compared, Function};
use dalembert::{Discretise, Lagrangian, Midpoint, State, StepError, rayleigh_system};

/// Dereferences to what it holds; times a number, it is three times as stiff.
#[derive(Clone, Copy)]
struct Stiffness(f64);

impl Deref for Stiffness {
    type Target = f64;
    fn deref(&self) -> &f64 {
        &self.0
    }
}

impl Mul<f64> for Stiffness {
    type Output = f64;
    fn mul(self, other: f64) -> f64 {
        3.0 * self.0 * other
    }
}

struct Held {
    k: Stiffness,
    boxed: Box<f64>,
    each: [Stiffness; 2],
}

#[rayleigh_system(derivatives = expanded)]
impl Held {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        let mut sum = *self.k * q[0] + (*self.boxed) * q[0] * q[0];
        for i in 0..2 {
            sum += *self.each[i] * v[0];
        }
        0.5 * v[0] * v[0] - sum - { *self.k } * 2.0
    }
}

/// References, read with `*`.
struct Borrowing {
    k: &'static f64,
    twice: &'static &'static f64,
    on: &'static bool,
}

#[rayleigh_system(derivatives = expanded)]
impl Borrowing {
    const C: &'static f64 = &0.25;

    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        let push = if *self.on { *Self::C * q[0] } else { 0.0 };
        0.5 * v[0] * v[0] - 0.5 * *self.k * q[0] * q[0] - **self.twice * q[0] - push
    }
}

/// References in an array that is a constant.
struct Listed;

#[rayleigh_system(derivatives = expanded)]
impl Listed {
    const EACH: [&'static f64; 2] = [&0.5, &0.125];

    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] + *Self::EACH[0] * q[0] + (*Self::EACH[1]) * v[0]
    }
}

#[test]
fn what_is_dereferenced_is_what_it_holds() {
    let (q, v) = (vector![0.7], vector![-0.4]);
    let held = Held { k: Stiffness(2.0), boxed: Box::new(1.5), each: [Stiffness(0.1), Stiffness(0.2)] };
    let of = held.lagrangian_derivatives(&q, &v);
    assert!((of.d1[0] + 2.0 + 3.0 * q[0]).abs() < 1e-15 && (of.d2[0] - v[0] + 0.3).abs() < 1e-15);
    assert_eq!(Lagrangian::lagrangian(&held, &q, &v), of.value);
    let borrowing = Borrowing { k: &2.0, twice: &&0.5, on: &true };
    let of = borrowing.lagrangian_derivatives(&q, &v);
    assert!((of.d1[0] + 2.0 * q[0] + 0.5 + 0.25).abs() < 1e-15);
    assert_eq!(Lagrangian::lagrangian(&borrowing, &q, &v), of.value);
    let of = Listed.lagrangian_derivatives(&q, &v);
    assert_eq!((of.d1[0], of.d2[0]), (0.5, v[0] + 0.125));
}

/// `len` of arrays, two more than they have entries; before the one of slices.
trait Longer {
    fn len(&self) -> usize;
}

impl<const N: usize> Longer for [f64; N] {
    fn len(&self) -> usize {
        N + 2
    }
}

struct Counted;

/// Over dual numbers the length is that of a slice: rustc does not tell, the comparison of values does.
#[rayleigh_system(derivatives = num_dual)]
impl Counted {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q.len() as f64 * q[0]
    }
}

#[test]
fn a_method_of_a_trait_that_dual_numbers_have_not_is_told() {
    assert_eq!(Lagrangian::lagrangian(&Counted, &vector![1.0], &vector![0.0]), -3.0);
    let told = |error| {
        matches!(
            error,
            StepError::GeneratedDiffers { function: Function::Lagrangian, compared: Compared::Value, .. }
        )
    };
    assert!(State::from_velocity(&Counted, [1.0], [0.0]).is_err_and(told));
    let start = State { q: Vector1::new(1.0), p: Vector1::new(0.0) };
    assert!(Counted.by(Midpoint, 0.1).run(start).next().unwrap().is_err_and(told));
    assert!(start.verify(&Counted).is_err_and(told));
}

/// A local of the macro, `k`, around statements of the caller, which have a `k` of their own in the same
/// scope.
macro_rules! around {
    ($engine:ident: $($name:ident $inner:ident { $($statements:tt)* })*) => {
        pub mod $engine {$(
            pub struct $name {
                pub k: f64,
            }

            #[dalembert::rayleigh_system(derivatives = $engine)]
            impl $name {
                fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                    let k = self.k * q[0];
                    $($statements)*
                    let k = k * k;
                    0.5 * v[0] * v[0] - k - $inner * q[0]
                }
            }
        )*}
    };
}

macro_rules! by {
    ($($engine:ident)*) => {$(
        around! {
            $engine:
                Shadowing inner { let k = 3.0; let k = k * 1.5; let inner = k; }
                Closure inner { let k = |k: f64| k * 1.5; let inner = k(3.0); }
                Looped k { let mut k = 0.0; for i in 1..3 { let k_of = |k: f64| k * i as f64; k += k_of(1.5); } }
                Ranged inner { let k = 3; let inner = (0..k).map(|i| i as f64 * 1.5).sum::<f64>(); }
            Matched k { let (k, _) = match (2, 4.5) { (2, k) => (k, 0.0), _ => (1.0, 1.0) }; }
        }
    )*};
}

by! { expanded num_dual }

#[test]
fn names_of_a_macro_and_of_its_caller_are_two() {
    // L = ½v² − 4q² − 4.5 q
    fn is_right<L: Lagrangian<1, Scalar = f64>>(system: &L) {
        let (q, v) = (0.7, -0.4);
        let of = system.lagrangian_derivatives(&vector![q], &vector![v]);
        let expected = 0.5 * v * v - 4.0 * q * q - 4.5 * q;
        assert!((of.value - expected).abs() < 1e-14 && (of.d1[0] + 8.0 * q + 4.5).abs() < 1e-14, "{of:?}");
        assert_eq!(system.lagrangian(&vector![q], &vector![v]), of.value);
    }
    is_right(&expanded::Shadowing { k: 2.0 });
    is_right(&expanded::Closure { k: 2.0 });
    is_right(&expanded::Looped { k: 2.0 });
    is_right(&expanded::Ranged { k: 2.0 });
    is_right(&expanded::Matched { k: 2.0 });
    is_right(&num_dual::Shadowing { k: 2.0 });
    is_right(&num_dual::Closure { k: 2.0 });
    is_right(&num_dual::Looped { k: 2.0 });
    is_right(&num_dual::Ranged { k: 2.0 });
    is_right(&num_dual::Matched { k: 2.0 });
}

/// Locals with the names of rules and types of generated code.
#[allow(non_snake_case)]
mod named_like_rules {
    #[dalembert::rayleigh_system(derivatives = expanded)]
    pub fn named(q: [f64; 1], v: [f64; 1]) -> f64 {
        let Midpoint = q[0] * q[0] * q[0];
        let Momenta = Midpoint * Midpoint + v[0];
        0.5 * v[0] * v[0] - Midpoint - Momenta * Momenta
    }
}

#[test]
fn locals_are_not_the_rules_of_their_names() {
    let (q, v) = (0.7_f64, -0.4);
    let of = named_like_rules::Named {}.lagrangian_gradient(&vector![q], &vector![v]);
    let sum = q.powi(6) + v;
    assert!((of.d1[0] + 3.0 * q * q + 12.0 * sum * q.powi(5)).abs() < 1e-14);
    assert!((of.d2[0] - v + 2.0 * sum).abs() < 1e-14);
}
