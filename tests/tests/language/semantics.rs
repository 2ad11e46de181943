//! Rust's own semantics, to the bit: types of integers, casts, order of evaluation, what is run and what is
//! not.

use super::case;

case! {
    integers_wrap_truncate_and_saturate_as_their_types_do: [1] at [([0.3], [1.1])]
    definitions {
        pub struct System { n: i32, m: u8 }
        fn system() -> System { System { n: -7, m: 200 } }
    }
    functions {
        const WIDE: i64 = 70_000;
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            let casts = [300_i32 as u8 as f64, -1_i32 as u8 as f64, 200_u8 as i8 as f64, Self::WIDE as u16 as f64, 3_000_000_000_u32 as i32 as f64];
            let mut sum = 0.0;
            for (i, x) in casts.iter().enumerate() {
                sum += x * q[0] * (i + 1) as f64;
            }
            let signed = 3_i32.saturating_sub(5) as f64 + 3_u32.saturating_sub(5) as f64;
            let wrapped = 250_u8.wrapping_add(10) as f64 + i8::MAX.wrapping_add(1) as f64;
            let shifted = (1_u8 << 7) as f64 + (0x80_u8 << 1) as f64 + (-17_i32 >> 2) as f64;
            let divided = (-7_i32 / 2) as f64 + (-7_i32 % 2) as f64 + (-7_i32).rem_euclid(2) as f64 + (-7_i32).div_euclid(2) as f64;
            let of_literals = 100_u8.wrapping_add(self.m) as f64 + 0_i32.saturating_sub(self.n) as f64 + (-7_i32).min(self.n) as f64;
            let ranged = match self.n { ..=-8 => 1.0, -7.. => 2.0 * q[0] };
            let fields = ranged + of_literals + (self.n.pow(2) + 1) as f64 + self.m.wrapping_mul(2) as f64 + self.n.abs() as f64 + (self.n as u8) as f64;
            let chosen = if q[0] > 0.0 { self.n } else { 2 };
            let number = if v[0] > 1.0 { 3 } else { -4 };
            let rounded = 16_777_217_i32 as f32 as f64;
            let single = 1.1_f32 as f64;
            sum * 1e-9 + signed * v[0] + wrapped + shifted * divided + fields * q[0] + (chosen + 1) as f64 * v[0] + number as f64
                + rounded * single * 1e-7 + f64::from(self.m) + (q[0] > 0.0) as u8 as f64 + !5_i32 as f64
        }
    }
}

case! {
    order_of_evaluation: [1] at [([0.3], [1.1]), ([-0.3], [1.1])]
    definitions {
        pub struct System { flag: bool }
        fn system() -> System { System { flag: true } }
    }
    functions {
        #[allow(unused_assignments)]
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            let mut i = 0;
            let mut a = [q[0], v[0], 3.0 * q[0], 1.0];
            a[{ i += 1; i }] += { i += 1; a[0] };
            let mut x = q[0];
            x += { x = 2.0 * v[0]; x };
            let y = x + { x = q[0] * v[0]; x };
            let mut count = 0.0;
            let right = q[0] > 0.0 && { count += 1.0; v[0] > 1.0 };
            let either = q[0] > 0.0 || { count += 10.0 * v[0]; false };
            let z = a[{ i -= 1; i }];
            let pair = ({ count += 1.0; count }, { count *= 3.0; count });
            let largest = x.max({ x = 5.0; x * v[0] });
            let (mut s, mut t) = (1.0, q[0]);
            (s, t) = (t, s);
            let shadowed = { let x = x * q[0]; let x = x + 1.0; x } + x;
            let mut f = 0.0;
            if right ^ either | self.flag { f += s } else { f -= t }
            y + z + a[2] * i as f64 + count * pair.0 + pair.1 + largest * f + shadowed
        }
    }
}

case! {
    loops_with_labels_and_values: [1] at [([0.3], [1.1])]
    definitions {
        pub struct System;
        fn system() -> System { System }
    }
    functions {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            let mut n = 0;
            let value = loop {
                n += 1;
                if n == 4 { break q[0] * n as f64; }
            };
            let mut sum = 0.0;
            'outer: for i in 0..5 {
                for j in 0..5 {
                    if j > i { continue 'outer; }
                    if i + j == 6 { break 'outer; }
                    sum += (i * 10 + j) as f64 * v[0];
                }
            }
            let mut k = 10;
            while k > 0 { k -= 3; if k == 4 { continue; } sum += k as f64; }
            let found = [2, 5, 7].iter().any(|n| *n == 5) && [1.0, q[0]].iter().all(|x| *x < 2.0);
            let [first, .., last] = [q[0], 2.0, v[0]];
            let tail = match [q[0], v[0], 3.0] { [a, rest @ ..] => a * rest[1] + rest.len() as f64 };
            value + sum + if found { first } else { last } + tail + (1..=3).map(|i| i * i).sum::<i32>() as f64
        }
    }
}

case! {
    names_of_the_user_are_not_those_of_the_library: [1] at [([0.3], [1.1])]
    definitions {
        pub struct System { angle: f64 }
        fn system() -> System { System { angle: 0.4 } }
    }
    functions {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            #[allow(non_snake_case)]
            let PI = 2.0 * q[0];
            let sin = |x: f64| x * x;
            let min = PI.min(v[0]);
            { use std::f64::consts::PI as TURN; sin(TURN * q[0]) * min + self.angle.sin() + Self::cos(v[0]) * PI }
        }
        fn cos(x: f64) -> f64 { x + 1.0 }
    }
}

case! {
    /// Their opposites are not in the type.
    the_least_numbers_are_literals: [1] at [([0.3], [1.1]), ([-0.8], [0.9])]
    definitions {
        pub struct System;
        fn system() -> System { System }
    }
    functions {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            let least = [-128_i8 as f64, -(32_768_i16) as f64, -9_223_372_036_854_775_808_i64 as f64];
            let mut sum = 0.5 * v[0] * v[0];
            for x in least {
                sum += 1e-2 * x.cbrt() * q[0] + !(-128_i8) as f64;
            }
            let widest = -170_141_183_460_469_231_731_687_303_715_884_105_728_i128;
            sum + (3.0 + v[0]).powi(-2147483648) + 1e-38 * (widest as f64) * q[0] * q[0]
        }
    }
}
