//! Methods of a trait or a struct of one's own, over dual numbers: of fields and constants alone they are
//! left to rustc; on a coordinate they have a derivative where the trait has one over any number.

use std::ops::{AddAssign, Mul};

use dalembert::nalgebra::vector;
use dalembert::{Lagrangian, rayleigh_system};

/// Of plain numbers alone.
trait Curve: Sized {
    fn curve(self) -> f64;
    fn bent(&self, by: f64) -> f64;
}

impl Curve for f64 {
    fn curve(self) -> f64 {
        self * self + 1.0
    }
    fn bent(&self, by: f64) -> f64 {
        self.min(by) - 0.25
    }
}

impl Curve for f32 {
    fn curve(self) -> f64 {
        f64::from(self) + 2.0
    }
    fn bent(&self, by: f64) -> f64 {
        f64::from(*self) * by
    }
}

/// Of any number that can be multiplied: dual ones among them.
trait Powers: Sized {
    fn squared(self) -> Self;
    fn cubed(&self) -> Self;
    fn double(&mut self);
}

impl<T: Copy + Mul<Output = T> + AddAssign> Powers for T {
    fn squared(self) -> T {
        self * self
    }
    fn cubed(&self) -> T {
        *self * *self * *self
    }
    fn double(&mut self) {
        *self += *self;
    }
}

struct Gains {
    low: f64,
    high: f64,
}

impl Gains {
    fn total(&self) -> f64 {
        self.low + self.high
    }
    fn pair(&self) -> [f64; 2] {
        [self.low, self.high]
    }
    fn is_steep(&self) -> bool {
        self.high > 2.0 * self.low
    }
}

enum Law {
    Soft,
    Hard(f64),
}

impl Law {
    fn stiffness(&self) -> f64 {
        match self {
            Self::Soft => 0.5,
            Self::Hard(k) => *k,
        }
    }
}

const G: f64 = 1.5;

macro_rules! by {
    ($($engine:ident)*) => {$(
        mod $engine {
            use super::*;

            pub struct Track {
                pub k: f64,
                pub c: f32,
                pub heights: [f64; 3],
                pub gains: Gains,
                pub laws: [Law; 2],
            }

            #[rayleigh_system(derivatives = $engine)]
            impl Track {
                fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                    let mut sum = self.k.curve() * q[0] + self.k.bent(G) + G.curve().sin() * q[0];
                    for i in 0..3 {
                        sum += self.heights[i].curve() * q[0];
                    }
                    sum += self.k.curve().floor() + f64::from(self.c.max(0.5)) + self.c.curve() * q[0];
                    let steep = if self.gains.is_steep() { 3.0 } else { 4.0 };
                    sum += self.gains.total() * q[0] * steep + self.gains.pair()[1] * v[0];
                    sum += self.laws[1].stiffness() * q[0] + self.laws[0].stiffness();
                    sum += q[0].squared() + q[0].cubed() + q.iter().map(|x| x.squared()).sum::<f64>();
                    let mut twice = q[0];
                    twice.double();
                    0.5 * v[0] * v[0] - sum - twice - self.weight()
                }

                fn weight(&self) -> f64 {
                    self.k.bent(0.5)
                }
            }
        }
    )*};
}

by! { num_dual auto }

#[test]
fn methods_of_constants_are_rustc_s_and_those_of_any_number_have_derivatives() {
    let (q, v) = (0.7_f64, -0.3);
    let linear = 1.69
        + 1.0
        + 3.25_f64.sin()
        + 3.0
        + (0.04 + 1.44 + 0.25)
        + 2.0
        + f64::from(0.7_f32)
        + 3.0 * 3.5
        + 7.0
        + 2.0;
    let squares = 2.0 * 2.0 * q + 3.0 * q * q;
    macro_rules! check {
        ($($engine:ident)*) => {$(
            let system = $engine::Track {
                k: 1.3,
                c: 0.7,
                heights: [0.2, 1.2, -0.5],
                gains: Gains { low: 1.0, high: 2.5 },
                laws: [Law::Soft, Law::Hard(7.0)],
            };
            let of = system.lagrangian_derivatives(&vector![q], &vector![v]);
            assert_eq!(of.value, Lagrangian::lagrangian(&system, &vector![q], &vector![v]));
            assert!((of.d1[0] + linear + squares).abs() < 1e-14, "{} {}", of.d1[0], linear + squares);
            assert!((of.d2[0] - v + 2.5).abs() < 1e-15);
            assert!((of.d11[(0, 0)] + 4.0 + 6.0 * q).abs() < 1e-14);
        )*};
    }
    check!(num_dual auto);
}
