//! `let`, `mut`, tuples, arrays, references, iterators, casts, literals, helpers.

use super::case;

case! {
    lets: [2] at [([0.3, 0.8], [1.1, 0.4])]
    definitions {
        pub struct System { k: f64 }
        fn system() -> System { System { k: 2.5 } }
    }
    functions {
        fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
            let a = q[0];
            let b: f64 = q[1];
            let c;
            c = a * b;
            let (d, e): (f64, f64) = (a + c, b - c);
            let [f, g] = v;
            let [mut m, n]: [f64; 2] = [f * f, g];
            m += 1.0;
            m -= d;
            m *= e;
            m /= 2.0 + self.k;
            let (mut i, x) = (2_usize, 1.5_f64);
            i += 1;
            i = i % 2;
            i %= 5;
            let a = a + x * q[i];
            let pair: ([f64; 2], i32) = ([a, n], 3);
            let nested = ((pair.0[0], m), pair.0[1] * (pair.1 as f64));
            let _ = nested;
            let _unused: f64 = 0.0;
            let Some(y) = Some(nested.1) else { return 0.0 };
            let block = {
                let z = y * y;
                z + nested.0.0
            };
            -block + nested.0.1 - -a + 1.0_f64.min(3.0) * n
        }
    }
}

case! {
    arrays: [3] at [([0.3, 0.8, -0.5], [1.1, 0.4, 0.9])]
    definitions {
        pub struct System { matrix: [[f64; 3]; 3] }
        fn system() -> System { System { matrix: [[2.0, 0.1, 0.3], [0.1, 1.0, 0.2], [0.3, 0.2, 1.5]] } }
    }
    functions {
        fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
            let mut product = [0.0; 3];
            for i in 0..3 {
                for j in 0..3 {
                    product[i] += self.matrix[i][j] * v[j];
                }
            }
            let mut table = [[0.0_f64; 2]; 3];
            table[1][0] = q[0] * q[1];
            table[2][1] += q[2].sin();
            let scaled: [f64; 3] = std::array::from_fn(|i| q[i] * (i as f64 + 0.5));
            let squares = scaled.map(|x| x * x);
            let mut copy = q;
            copy[0] = 0.0;
            copy.swap(0, 2);
            let [first, rest @ ..] = squares;
            0.5 * Self::dot(&product, &v) - first - rest[0] * rest[1] + table[1][0] + table[2][1] * copy[0]
        }
        fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
            a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
        }
    }
}

case! {
    iterators: [4] at [([0.3, 0.8, -0.5, 0.1], [1.1, 0.4, 0.9, -0.7])]
    definitions {
        pub struct System { masses: [f64; 4] }
        fn system() -> System { System { masses: [1.0, 2.0, 0.5, 1.5] } }
    }
    functions {
        fn lagrangian(&self, q: [f64; 4], v: [f64; 4]) -> f64 {
            let kinetic: f64 = self.masses.iter().zip(v).map(|(m, v)| 0.5 * m * v * v).sum();
            let referenced: f64 = q.iter().zip(v.iter()).map(|(q, v)| q * v).sum();
            let springs = q.windows(2).map(|pair| (pair[1] - pair[0]).powi(2)).sum::<f64>();
            let chunks: f64 = q.chunks(2).map(|c| c[0] * c[1]).sum();
            let folded = q.iter().fold(1.0, |product, x| product * (1.0 + x * x));
            let weighted: f64 = v.iter().enumerate().map(|(i, v)| i as f64 * v * v).sum();
            let product: f64 = q.iter().product();
            let copied = q.iter().copied().map(f64::sin).sum::<f64>() + q.map(f64::cos)[0];
            let largest = q.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let filtered: f64 = q.into_iter().filter(|x| *x > 0.0).map(|x| x * x * x).sum();
            let total = (0..4).map(|i| q[i] * v[3 - i]).sum::<f64>();
            let first = q.first().copied().unwrap_or(0.0) + q.iter().rev().skip(1).take(2).sum::<f64>();
            let empty: f64 = q[..0].iter().sum();
            kinetic - referenced * springs + chunks * folded - weighted * product + copied + largest * filtered + total * first + empty
        }
    }
}

case! {
    casts: [1] at [([0.3], [1.1])]
    definitions {
        pub struct System { n: u32, up: bool }
        fn system() -> System { System { n: 300, up: true } }
    }
    functions {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            let wrapped = self.n as u8 as f64;
            let index = self.n as usize % 7;
            let sign = (self.up as i32 * 2 - 1) as f64;
            let literal = 3 as f64 + 2_i32 as f64;
            let identity = q[0] as f64;
            let count = -4_i64 as f64;
            wrapped * v[0] * v[0] - sign * identity.powi(index as i32) * literal + count * q[0]
        }
    }
}

case! {
    references: [2] at [([0.3, 0.8], [1.1, 0.4])]
    definitions {
        pub struct System { k: f64, l: [f64; 2] }
        fn system() -> System { System { k: 2.5, l: [0.5, 1.5] } }
    }
    functions {
        fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
            let x = &q[0];
            let k = &self.k;
            let l = &self.l;
            let mut sum = 0.0;
            let target = &mut sum;
            *target += x * k;
            *target -= 2.0 * x;
            *target += *x * 2.0 + x;
            let swapped = Self::swapped(&q, &(v[0], 3));
            sum + x * x - l[0] * -x + v[1] * v[1] * swapped[0] + (0.5 * k - x) * (x / k) + Self::norm(&self.l) * (x - 1.0)
        }
        fn swapped(q: &[f64; 2], pair: &(f64, i32)) -> [f64; 2] {
            [q[1] * pair.0, q[0].powi(pair.1)]
        }
        fn norm(x: &[f64; 2]) -> f64 { f64::hypot(x[0], x[1]) }
    }
}

case! {
    literals: [1] at [([0.3], [1.1])]
    definitions {
        pub struct System;
        fn system() -> System { System }
    }
    functions {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            let a = 2.;
            let b = 1e-1;
            let c = (0.5 + 0.25) * 4.0 - 1.0 / 3.0;
            let d = 2f64;
            let e = -1.5;
            let f = 2.0_f64.sqrt() * -0.5_f64.abs();
            let g = [1.0, 2.0][1] + (3.0, 4).0;
            a * v[0] * v[0] - b * (q[0] * c).cos() + d * q[0] - e * f * q[0] + 1_000.5 * q[0] * g
        }
    }
}

case! {
    functions_and_methods: [2] at [([0.3, 0.8], [1.1, 0.4])]
    definitions {
        pub struct System;
        fn system() -> System { System }
    }
    functions {
        fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
            f64::sin(q[0]) + q[0].sin() * f64::powi(v[0], 2) - f64::atan2(q[0], q[1]) + f64::exp(-q[1]) + v[1].mul_add(q[0], 0.5)
                - i32::pow(2, 3) as f64 * usize::min(1, 2) as f64 + f64::from(3_u8) + core::primitive::f64::cos(q[0])
        }
    }
}

case! {
    /// By value, by reference, through `self` and `Self`, handed on, recursive, with integers and tuples,
    /// without arguments.
    helpers: [2] at [([0.3, 0.8], [1.1, 0.4])]
    definitions {
        pub struct System { k: f64, l: [f64; 2] }
        fn system() -> System { System { k: 2.5, l: [0.5, 1.5] } }
    }
    functions {
        fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
            let (kinetic, potential) = self.parts(q, &v);
            kinetic - potential * self.scale() + Self::unit() + v.map(Self::cube)[0] + Self::power(q[0], 4)
                - System::cube(q[1]) + q.iter().map(|x| self.weighted(1, *x)).sum::<f64>()
        }
        fn parts(&self, q: [f64; 2], v: &[f64; 2]) -> (f64, f64) {
            (Self::energy(self, v), self.height(q[0], true) + self.height(q[1], false))
        }
        fn energy(&self, v: &[f64; 2]) -> f64 { 0.5 * (v[0] * v[0] + v[1] * v[1]) * self.k }
        fn height(&self, mut x: f64, up: bool) -> f64 {
            x *= self.l[0];
            if up { x.sin() } else { Self::cube(x) }
        }
        fn weighted(&self, i: usize, x: f64) -> f64 { self.l[i] * Self::cube(x) }
        fn cube(x: f64) -> f64 { x * x * x }
        fn power(x: f64, n: u32) -> f64 { if n == 0 { 1.0 } else { x * Self::power(x, n - 1) } }
        fn scale(&self) -> f64 { self.k * 0.5 }
        fn unit() -> f64 { 1.0 }
    }
}
