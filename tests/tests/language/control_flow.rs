//! `for`, `while`, `loop`, `if`, `match`, early return, closures.

use super::case;

case! {
    loops: [2] at [([0.3, 0.8], [1.1, 0.4])]
    definitions {
        pub struct System { n: usize }
        fn system() -> System { System { n: 5 } }
    }
    functions {
        fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
            let mut sum = 0.0;
            for i in 0..self.n {
                sum += (i as f64 * q[0]).sin() / (1 + i) as f64;
            }
            for i in (1..=3).rev().step_by(2) {
                sum -= q[1].powi(i);
            }
            for (i, x) in q.iter().enumerate() {
                sum += *x * v[i];
            }
            for x in v {
                sum += x * x;
            }
            for x in &q {
                sum *= 1.0 + x * x;
            }
            let mut n = 0;
            while n < 3 {
                sum += q[n % 2] * v[(n + 1) % 2];
                n += 1;
            }
            'outer: loop {
                loop {
                    n -= 1;
                    if n == 1 {
                        break 'outer;
                    }
                    continue 'outer;
                }
            }
            sum * n as f64
        }
    }
}

case! {
    conditions_on_values: [2] at [
        ([0.3, 0.8], [1.1, 0.4]),
        ([-0.3, 0.8], [1.1, 0.4]),
        ([2.3, -0.8], [1.1, 3.4]),
        ([0.3, 1.8], [1.1, 0.4]),
    ]
    definitions {
        pub struct System { wall: f64 }
        fn system() -> System { System { wall: 1.5 } }
    }
    functions {
        fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
            if q[1] > self.wall && q[0] != 0.0 {
                return q[1] * v[0] * v[1];
            }
            let contact = if q[0] < 0.0 {
                q[0] * q[0]
            } else if self.wall <= q[0] {
                (q[0] - self.wall).powi(3)
            } else {
                0.0
            };
            let near = (q[1] - 1.0).abs() < 0.5;
            let inside = (-1.0..1.0).contains(&q[0]);
            let drag = match (near, inside) {
                (true, _) => v[0],
                (false, true) => 2.0 * v[1],
                (false, false) => v[0] * v[1],
            };
            0.5 * v[0] * v[0] * if v[1] > 1.0 { q[1] } else { 1.0 } - contact + drag * drag
        }
    }
}

case! {
    matches_on_integers: [1] at [([0.3], [1.1])]
    definitions {
        pub struct System { kind: u8 }
        fn system() -> System { System { kind: 2 } }
    }
    functions {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            let potential = |kind: u8| match kind {
                0 => 0.0,
                1 | 2 if self.kind > 5 => q[0],
                1..=2 => q[0].powi(2) * 0.5,
                other => -(other as f64),
            };
            0.5 * v[0] * v[0] - potential(self.kind) * potential(7)
        }
    }
}

case! {
    closures: [2] at [([0.3, 0.8], [1.1, 0.4])]
    definitions {
        pub struct System { k: f64 }
        fn system() -> System { System { k: 2.5 } }
    }
    functions {
        fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
            let square = |x: f64| x * x;
            let spring = |x| 0.5 * self.k * square(x);
            let typed = |i: usize, x: &[f64; 2]| -> f64 { x[i] * (i + 1) as f64 };
            let mut total = 0.0;
            let mut add = |x| total += x;
            add(square(v[0]) + square(v[1]));
            add(-spring(q[0] - q[1]));
            add(typed(1, &q) * typed(0, &v));
            total
        }
    }
}

case! {
    a_newton_iteration: [1] at [([0.3], [1.1])]
    definitions {
        pub struct System;
        fn system() -> System { System }
    }
    functions {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            0.5 * v[0] * v[0] - Self::kepler(q[0])
        }
        /// E − e sin E = M.
        fn kepler(mean: f64) -> f64 {
            let e = 0.4;
            let mut x = mean;
            for _ in 0..20 {
                x -= (x - e * x.sin() - mean) / (1.0 - e * x.cos());
            }
            x
        }
    }
}
