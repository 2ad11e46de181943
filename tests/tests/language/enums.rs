//! Enums and options of the user's that choose among laws: `match`, `if let`, `let … else`, `matches!`,
//! methods of `Option`.

use super::case;

case! {
    friction_by_an_enum: [2] at [([0.3, 0.8], [1.1, 0.4]), ([0.3, 0.8], [-1.1, 0.0])]
    definitions {
        #[derive(Clone, Copy)]
        pub enum Friction { None, Linear(f64), Quadratic { c: f64 }, Table([f64; 2]) }
        pub struct System { laws: [Friction; 4] }
        fn system() -> System {
            let laws = [Friction::None, Friction::Linear(0.7), Friction::Quadratic { c: 1.3 }, Friction::Table([0.2, 0.9])];
            System { laws }
        }
    }
    functions {
        fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
            let mut total = 0.5 * (v[0] * v[0] + v[1] * v[1]);
            for i in 0..4 {
                let law = self.laws[i];
                total -= (i + 1) as f64 * match law {
                    Friction::None => 0.0,
                    Friction::Linear(c) => 0.5 * c * v[0] * v[0],
                    Friction::Quadratic { c } => c * v[0] * v[0] * v[0] * q[1],
                    Friction::Table([a, b]) => a * q[0] + b * v[1] * v[1],
                };
            }
            total
        }
    }
}

case! {
    optional_terms: [1] at [([0.3], [1.1]), ([-0.3], [1.1])]
    definitions {
        pub struct System { some: Option<f64>, none: Option<f64>, n: Option<i32> }
        fn system() -> System { System { some: Some(2.5), none: None, n: Some(3) } }
    }
    functions {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            let mut potential = 0.0;
            if let Some(k) = self.some {
                potential += 0.5 * k * q[0] * q[0];
            }
            if let Some(k) = &self.none {
                potential += 0.25 * k * q[0].powi(4);
            } else {
                potential += *self.some.as_ref().unwrap_or(&0.5) * q[0];
            }
            if let Some(n) = &self.n && *n > 2 {
                potential += *n as f64 * q[0].sin();
            }
            potential += self.some.unwrap_or(0.0) * q[0] + self.none.unwrap_or(q[0]) * v[0];
            potential += self.some.map_or(0.0, |k| k * q[0].cos()) + self.none.map_or(q[0], |k| k / q[0]);
            if self.some.is_some() && self.none.is_none() {
                potential += Self::cubic(self.some, q[0]);
            }
            0.5 * v[0] * v[0] - potential - self.quartic(q[0])
        }
        fn cubic(k: Option<f64>, x: f64) -> f64 {
            let Some(k) = k else { return 1.0 };
            k * x * x * x
        }
        fn quartic(&self, x: f64) -> f64 {
            let Some(k) = self.none else { return x };
            k * x.powi(4) / k
        }
    }
}

// A `None` alone has the type that is written beside it, or that of what else a value may be.
case! {
    nothing_of_a_type: [1] at [([0.4], [1.1]), ([-0.3], [1.1])]
    definitions {
        pub struct System { k: Option<f64>, is_off: bool }
        fn system() -> System { System { k: Some(0.7), is_off: true } }
    }
    functions {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            let _unused: Option<f64> = None;
            let alone: Option<f64> = None;
            let potential = match alone { Some(k) => k * q[0], None => q[0] };
            let beside = if q[0] > 0.3 { self.k } else { None };
            let potential = potential + match beside { Some(k) => k * q[0], None => 2.0 * q[0] };
            let before = if self.is_off { None } else { self.k };
            let potential = potential + if before.is_some() { q[0] } else { 3.0 * q[0] };
            let one_of_three = if q[0] > 0.6 { None } else if q[0] > 0.3 { self.k } else { None };
            let potential = potential + match one_of_three { Some(k) => k * q[0], None => 4.0 * q[0] };
            let mut later = None;
            if q[0] > 0.1 { later = self.k; }
            let potential = potential + match later { Some(k) => k * q[0] * q[0], None => 0.5 * q[0] };
            0.5 * v[0] * v[0] - potential - Self::of(None, q[0]) - Self::of(self.k, q[0])
        }
        fn of(k: Option<f64>, x: f64) -> f64 {
            match k { Some(k) => k * x * x, None => x }
        }
    }
}

case! {
    laws_within_laws: [1] at [([0.3], [1.1]), ([-0.3], [1.1])]
    definitions {
        pub enum Power { Square, Any(i32) }
        pub enum Law { A, B(f64, Power), C { power: Power, k: Option<f64>, #[allow(dead_code)] table: Vec<f64> } }
        const FIRST: i32 = 3;
        #[allow(non_upper_case_globals)]
        const lower: i32 = 7;
        pub struct System { a: Law, b: Law, c: Law, kind: i32 }
        fn system() -> System {
            let c = Law::C { power: Power::Square, k: Some(1.5), table: vec![0.0; 3] };
            System { a: Law::A, b: Law::B(0.4, Power::Any(3)), c, kind: 3 }
        }
    }
    functions {
        const SECOND: i32 = 5;
        #[allow(non_upper_case_globals)]
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            let x = q[0];
            let kind = match self.kind {
                Self::SECOND => 5.0,
                FIRST => 3.0,
                other => other as f64 + x,
            };
            let lowered = match self.kind { lower => 1.0, 3 => 2.0, _ => 3.0 };
            let guarded = match self.kind {
                n if n > 3 => 1.0,
                n @ 1..=3 if x > 0.0 => n as f64 * x,
                i32::MIN..=0 | 3 => x * x,
                _ => 0.0,
            };
            let flags = if matches!(self.a, Law::A | Law::B(..)) && !matches!(self.b, Law::B(c, _) if c > 1.0) { x } else { 0.0 };
            self.energy(&self.a, x) + self.energy(&self.b, x) + self.energy(&self.c, x) + kind * lowered * guarded + flags
                + v[0] * v[0]
        }
        fn energy(&self, law: &Law, x: f64) -> f64 {
            match law {
                Law::A => x,
                Law::B(c, power) => c * match power {
                    Power::Square => x * x,
                    Power::Any(n) => *n as f64 * x.sin(),
                },
                Law::C { power: Power::Any(_), .. } => 1.0,
                Law::C { power: Power::Square, k: Some(k), .. } => *k * x.exp(),
                Law::C { power: Power::Square, k: None, .. } => 0.0,
            }
        }
    }
}

case! {
    what_is_not_taken_is_not_evaluated: [1] at [([0.3], [1.1]), ([-0.3], [1.1])]
    definitions {
        #[allow(dead_code)]
        pub enum Law { Off, Entry(usize), Ratio(i32, i32) }
        pub struct System { law: Law, table: [f64; 2], index: usize, count: u32 }
        fn system() -> System { System { law: Law::Off, table: [0.5, 0.7], index: 7, count: 0 } }
    }
    functions {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            let by_law = match self.law {
                Law::Off => q[0],
                Law::Entry(i) => self.table[i] * q[0],
                Law::Ratio(a, b) => (a / b) as f64 * q[0],
            };
            let by_index = if self.index < 2 { self.table[self.index] * v[0] } else { v[0] };
            let by_count = if self.count > 0 { (self.count - 1) as f64 } else { 2.0 };
            let shared = self.index < 2 && self.table[self.index] > 0.6;
            let early = self.early(q[0]);
            by_law + by_index * by_count * v[0] + if shared { 1.0 } else { q[0] } + early
        }
        fn early(&self, x: f64) -> f64 {
            if self.count == 0 { return x; }
            self.table[(10 / self.count) as usize] * x
        }
    }
}

case! {
    cases_that_bind: [1] at [([0.3], [1.1]), ([-0.3], [1.1])]
    definitions {
        #[derive(Clone, Copy)]
        #[allow(dead_code)]
        pub enum Law { A(f64), B(f64), C, D { c: f64, n: i32 }, E(Option<f64>) }
        pub struct System { laws: [Law; 5], k: Option<f64>, pair: (Option<f64>, Option<f64>), n: i32, entry: (i32, f64) }
        fn system() -> System {
            let laws = [Law::A(0.7), Law::B(1.3), Law::C, Law::D { c: 0.4, n: 2 }, Law::E(Some(2.5))];
            System { laws, k: Some(0.9), pair: (Some(-1.0), Some(2.0)), n: 3, entry: (2, 0.6) }
        }
    }
    functions {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            let mut total = v[0] * v[0];
            for i in 0..5 {
                let law = self.laws[i];
                let weight = (i + 1) as f64;
                total += weight * match law {
                    Law::A(k) | Law::B(k) => k * q[0],
                    Law::C => 0.0,
                    Law::D { c, .. } | Law::E(Some(c)) => c * v[0] * q[0],
                    Law::E(None) => 1.0,
                };
                total += weight * match (law, 2) {
                    (Law::A(k) | Law::B(k), 1) | (Law::E(Some(k)), 2) => k * q[0].sin(),
                    _ => 0.0,
                };
                total += if let Law::D { c: k, n: 1 | 2 } | Law::A(k) = law { k * v[0] } else { q[0] };
                total -= Self::squared(law, q[0]);
            }
            // Both cases match, and the guard holds for the second alone.
            total += match self.pair { (Some(k), _) | (_, Some(k)) if k > 0.0 => k * q[0].powi(3), _ => v[0] };
            total += match &self.k { Some(k) | Some(k) if *k > 1.0 => *k, Some(k) => 2.0 * k * q[0], None => 0.0 };
            total += match (self.n, q[0]) {
                (1, x) | (2, x) => x * q[0],
                (n @ 3, x) | (n @ 4, x) => x * n as f64,
                _ => 0.0,
            };
            total += match 3 { n @ 1 | n @ 3 => n as f64 * q[0], _ => 0.0 };
            total += match self.entry { (1, x) | (2, x) => x * q[0], (_, x) => x };
            let chosen = if q[0] > 0.0 { self.laws[0] } else { self.laws[3] };
            total += match chosen { Law::A(k) | Law::D { c: k, .. } => k * q[0].exp(), _ => 0.0 };
            total + match (q[0] > 0.0, v[0] > 0.0, q[0]) { (true, _, x) | (_, true, x) => x * v[0], _ => q[0] }
        }
        fn squared(law: Law, x: f64) -> f64 {
            let (Law::A(k) | Law::B(k)) = law else { return x };
            k * k * x
        }
    }
}
