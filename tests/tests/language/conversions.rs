//! Numbers of another precision, integers and bools, converted to the system's scalar by `from` and `into`:
//! the value is that of the plain function, whichever engine makes the derivatives.

const SINGLE: f32 = 0.1;
#[allow(non_upper_case_globals)]
const small: u16 = 40;

/// L = ½v² − c q with c as written, for each name by each engine; and its slope against c.
macro_rules! converted {
    ($($name:ident by $($engine:ident)*: |$system:ident| $factor:expr => $expected:expr;)*) => {$(
        #[allow(dead_code, unused_imports, reason = "each body reads some of the fields and constants")]
        mod $name {
            use super::*;
            use dalembert::nalgebra::vector;
            use dalembert::{Lagrangian, rayleigh_system};

            $(mod $engine {
                use super::*;

                pub struct System {
                    pub c: f32,
                    pub k: f64,
                    pub n: u8,
                    pub wide: [u32; 2],
                    pub signed: (i8, i16, i32),
                    pub on: bool,
                    pub table: [f32; 3],
                    pub pairs: [(f32, u16); 2],
                }

                #[rayleigh_system(derivatives = $engine)]
                impl System {
                    const HALF: f32 = 0.55;

                    fn lagrangian(&$system, q: [f64; 1], v: [f64; 1]) -> f64 {
                        0.5 * v[0] * v[0] - q[0] * $factor
                    }

                    fn twice(&self, x: f64) -> f64 {
                        2.0 * x * f64::from(self.c)
                    }

                    fn widened(&self) -> f64 {
                        f64::from(self.table[1]) + f64::from(Self::HALF)
                    }
                }
            })*

            #[test]
            fn is_converted() {
                let (q, v) = (1.9, -0.4);
                let expected: f64 = $expected;
                $(
                    let system = $engine::System {
                        c: 0.7,
                        k: 1.3,
                        n: 3,
                        wide: [5, 7],
                        signed: (-2, -30, 400),
                        on: true,
                        table: [0.3, -0.9, 1.1],
                        pairs: [(0.6, 2), (1.7, 9)],
                    };
                    let of = system.lagrangian_derivatives(&vector![q], &vector![v]);
                    let name = stringify!($engine);
                    assert_eq!(of.value, 0.5 * v * v - q * expected, "{name}");
                    assert_eq!(of.d1[0], -expected, "{name}");
                    assert_eq!((of.d2[0], of.d11[(0, 0)], of.d22[(0, 0)]), (v, 0.0, 1.0), "{name}");
                )*
            }
        }
    )*};
}

/// 0.7 in single precision is another number.
const C: f64 = 0.7_f32 as f64;

converted! {
    a_field by num_dual expanded auto: |self| f64::from(self.c) => C;
    a_constant by num_dual expanded auto: |self| f64::from(SINGLE) => 0.1_f32.into();
    a_constant_in_small_letters by num_dual expanded auto: |self| f64::from(small) => 40.0;
    a_constant_of_the_block by num_dual expanded auto: |self| f64::from(Self::HALF) => 0.55_f32.into();
    integers by num_dual expanded auto:
        |self| f64::from(self.n) * f64::from(self.wide[1]) + f64::from(self.on) => 22.0;
    signed_integers by num_dual expanded auto:
        |self| f64::from(self.signed.0) + f64::from(self.signed.1) + f64::from(self.signed.2) => 368.0;
    arithmetic by num_dual expanded auto:
        |self| f64::from(1.1_f32 * self.c + 0.3) => (1.1_f32 * 0.7 + 0.3).into();
    a_negated_field by num_dual expanded auto: |self| f64::from(-self.c) => -C;
    a_method by num_dual expanded auto: |self| f64::from(self.c.max(0.9)) => 0.9_f32.into();
    a_method_of_an_entry by num_dual expanded auto: |self| {
        let mut sum = 0.0;
        for i in 0..3 {
            sum += f64::from(self.table[i].max(0.5));
        }
        sum
    } => f64::from(0.5_f32) * 2.0 + f64::from(1.1_f32);
    a_closure by num_dual expanded auto: |self| {
        let times = |x: f64| x * f64::from(self.c);
        times(2.0)
    } => 2.0 * C;
    helpers by num_dual expanded auto: |self| (self.twice(3.0) + self.widened())
        => 6.0 * C + (f64::from(-0.9_f32) + f64::from(0.55_f32));
    a_local by num_dual expanded auto: |self| { let c = self.c; f64::from(c) } => C;
    a_closure_of_single_precision by num_dual expanded auto: |self| {
        let widened = |c: f32| f64::from(c);
        widened(self.c)
    } => C;
    a_choice by num_dual expanded auto: |self| f64::from(if self.on { self.c } else { 1.5 }) => C;
    entries by num_dual expanded auto: |self| {
        let mut sum = 0.0;
        for i in 0..2 {
            sum += f64::from(self.pairs[i].0) + f64::from(self.pairs[i].1);
        }
        sum
    } => f64::from(0.6_f32) + 2.0 + (f64::from(1.7_f32) + 9.0);
    rounded by num_dual expanded auto: |self| f64::from(self.c * 4.0).floor() => 2.0;
    a_cast by num_dual expanded auto: |self| (self.table[2] as f64) => 1.1_f32.into();
    // What follows is left to dual numbers by `auto`.
    entries_in_a_loop by num_dual auto: |self| {
        let mut sum = 0.0;
        for c in self.table {
            sum += f64::from(c);
        }
        sum
    } => f64::from(0.3_f32) - f64::from(0.9_f32) + f64::from(1.1_f32);
    entries_by_an_iterator by num_dual auto:
        |self| self.table.iter().map(|c| f64::from(*c)).fold(0.0, |sum, c| sum + c)
        => f64::from(0.3_f32) - f64::from(0.9_f32) + f64::from(1.1_f32);
    a_function_handed_on by num_dual auto: |self| self.table.map(f64::from)[1] => (-0.9_f32).into();
    casts_in_a_loop by num_dual auto: |self| self.table.iter().map(|c| *c as f64).fold(0.0, |sum, c| sum + c)
        => f64::from(0.3_f32) - f64::from(0.9_f32) + f64::from(1.1_f32);
    into_of_a_local by num_dual auto: |self| { let c: f64 = self.c.into(); c } => C;
    into_of_an_argument by num_dual auto: |self| self.k.mul_add(self.c.into(), 0.25) => 1.3_f64.mul_add(C, 0.25);
    into_of_a_method by num_dual auto: |self| {
        let (c, n): (f64, f64) = (self.c.max(0.9).into(), self.n.min(2).into());
        c * n
    } => 2.0 * f64::from(0.9_f32);
    into_an_integer by num_dual auto: |self| { let n: u64 = self.n.into(); n as f64 } => 3.0;
    of_the_type by num_dual: |self| (<f64>::from(self.c) + <f64 as From<u8>>::from(self.n)) => C + 3.0;
}

/// The control: a conversion left out, or made at another place, would be seen.
#[test]
fn numbers_of_single_precision_are_others() {
    for (single, double) in
        [(0.7_f32, 0.7), (0.1, 0.1), (0.55, 0.55), (0.9, 0.9), (1.1_f32 * 0.7 + 0.3, 1.07)]
    {
        assert!((f64::from(single) - double).abs() > 1e-9, "{single}");
    }
}
