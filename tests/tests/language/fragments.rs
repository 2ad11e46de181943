//! Expressions that `macro_rules` hands on stay whole, in the derivatives and in the user's own
//! function.

use dalembert::nalgebra::vector;
use dalembert::{Lagrangian, State};

/// Systems around expressions: `$mass` before an operator of higher precedence, `$slope` before a method,
/// `$stiffness` behind a minus, `$count` before a cast.
macro_rules! springs {
    ($engine:ident: $($name:ident { $mass:expr, $stiffness:expr, $slope:expr, $count:expr })*) => {
        pub mod $engine {$(
            pub struct $name;

            #[dalembert::rayleigh_system(derivatives = $engine)]
            impl $name {
                pub fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                    let mass = $mass * 0.5;
                    mass * v[0] * v[0] - $stiffness * q[0] * q[0] - $slope.powi(2) * q[0] + $count as f64 * v[0]
                }
            }
        )*}
    };
}

/// The cases, by either engine.
macro_rules! by {
    ($($engine:ident)*) => {$(
        springs! {
            $engine:
                Sums { 1.0 + 2.0, 0.5 + 0.25, 1.0 - 3.0_f64, 2 + 3 }
                Signs { 4.0 - 1.0, -1.0 + 1.75, -2.0_f64, -3 + 8 }
                Choices { if 2 > 1 { 3.0 } else { 1.0 }, match 2 { 1 => 2.0, _ => 0.75 }, 1.0 + 1.0_f64, 11 & 5 ^ 4 }
                Products { 1.5 * 2.0, 3.0 / 4.0, &2.0_f64, 10 / 2 }
        }
    )*};
}

by! { expanded num_dual }

/// L = 1.5 v² − 0.75 q² − 4 q + 5 v, and its gradient; the plain function has the same value.
fn is_right<L: Lagrangian<1, Scalar = f64>>(system: &L, plain: f64) {
    let (q, v) = (0.7, -0.4);
    let expected = 1.5 * v * v - 0.75 * q * q - 4.0 * q + 5.0 * v;
    let found = system.lagrangian_derivatives(&vector![q], &vector![v]);
    assert!((plain - expected).abs() < 1e-15 && (found.value - expected).abs() < 1e-15, "{plain} {expected}");
    assert!((found.d1[0] + 1.5 * q + 4.0).abs() < 1e-15 && (found.d2[0] - 3.0 * v - 5.0).abs() < 1e-15);
    let state = State::from_velocity(system, [q], [v]).unwrap();
    assert!((state.p[0] - 3.0 * v - 5.0).abs() < 1e-15);
}

#[test]
fn expressions_of_fragments_stay_whole() {
    let at = ([0.7], [-0.4]);
    is_right(&expanded::Sums, expanded::Sums.lagrangian(at.0, at.1));
    is_right(&expanded::Signs, expanded::Signs.lagrangian(at.0, at.1));
    is_right(&expanded::Choices, expanded::Choices.lagrangian(at.0, at.1));
    is_right(&expanded::Products, expanded::Products.lagrangian(at.0, at.1));
    is_right(&num_dual::Sums, num_dual::Sums.lagrangian(at.0, at.1));
    is_right(&num_dual::Signs, num_dual::Signs.lagrangian(at.0, at.1));
    is_right(&num_dual::Choices, num_dual::Choices.lagrangian(at.0, at.1));
    is_right(&num_dual::Products, num_dual::Products.lagrangian(at.0, at.1));
}

/// Parentheses that the user did not write are not warned of, wherever the fragment stands.
#[deny(unused_parens)]
mod quiet {
    macro_rules! system {
        ($sum:expr, $truth:expr, $range:expr, $function:expr, $pattern:pat, $engine:ident) => {
            pub mod $engine {
                pub struct System;
                #[dalembert::rayleigh_system(derivatives = $engine)]
                impl System {
                    pub fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                        let sum = $sum;
                        let mut l = Self::half(v[0] * v[0] + v[1] * v[1]);
                        for i in $range {
                            l -= q[i];
                        }
                        if $truth {
                            l -= q.iter().map($function).sum::<f64>();
                        }
                        match 2 {
                            $pattern => l * sum,
                            _ => l,
                        }
                    }
                    fn half(x: f64) -> f64 {
                        return $sum * 0.5 * x;
                    }
                }
            }
        };
    }
    system!(0.5 + 0.5, 1 < 2, 0..2, |x| 2.0 * x, 1..=3, expanded);
    system!(0.5 + 0.5, 1 < 2, 0..2, |x| 2.0 * x, 1..=3, num_dual);

    #[test]
    fn its_value_is_right() {
        let (q, v) = ([0.5, 0.25], [1.0, 2.0]);
        assert_eq!((expanded::System.lagrangian(q, v), num_dual::System.lagrangian(q, v)), (0.25, 0.25));
    }
}

/// Positive control: without the group `1.0 + 2.0 * 0.5` is 2, not 1.5.
#[test]
fn the_fragments_do_bind_weaker_than_what_stands_beside_them() {
    macro_rules! halved {
        ($sum:expr) => {
            $sum * 0.5
        };
    }
    assert_eq!(halved!(1.0 + 2.0), 1.5);
}
