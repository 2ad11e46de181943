//! Fields: numbers, bools, arrays of them, arrays of arrays, tuples; named and unnamed.

use super::case;

case! {
    scalars: [2] at [([0.3, -0.8], [1.1, 0.4])]
    definitions {
        pub struct System { m: f64, n: i32, count: usize, small: u8, twice: bool }
        fn system() -> System { System { m: 1.7, n: 3, count: 2, small: 5, twice: true } }
    }
    functions {
        fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
            let factor = if self.twice { 2.0 } else { 1.0 };
            let mut kinetic = 0.0;
            for i in 0..self.count {
                kinetic += self.m * v[i] * v[i] / self.small as f64;
            }
            kinetic - factor * q[0].powi(self.n) + f64::from(self.small) * q[1] * q[0]
        }
    }
}

case! {
    arrays: [3] at [([0.3, -0.8, 0.2], [1.1, 0.4, -0.6])]
    definitions {
        pub struct System { masses: [f64; 3], order: [usize; 3], fixed: [bool; 3], k: [[f64; 3]; 3] }
        fn system() -> System {
            System {
                masses: [1.0, 2.5, 0.7],
                order: [2, 0, 1],
                fixed: [false, true, false],
                k: [[1.0, 0.1, 0.2], [0.1, 3.0, -0.4], [0.2, -0.4, 2.0]],
            }
        }
    }
    functions {
        fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
            let mut l = 0.0;
            for i in 0..3 {
                if !self.fixed[i] {
                    l += 0.5 * self.masses[self.order[i]] * v[i] * v[i];
                }
                for j in 0..3 {
                    l -= 0.5 * self.k[i][j] * q[i] * q[j] * (1.0 + q[i] * q[i]);
                }
            }
            l
        }
    }
}

case! {
    a_tuple_struct: [1] at [([0.3], [1.1])]
    definitions {
        pub struct System(f64, [f64; 2], i64, bool);
        fn system() -> System { System(1.3, [0.4, 2.0], 4, false) }
    }
    functions {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            let potential = if self.3 { 0.0 } else { self.1[0] * q[0].cos() + self.1[1] * q[0] };
            0.5 * self.0 * v[0] * v[0] * (2.0 + q[0].sin()) - potential * self.2 as f64
        }
    }
}

case! {
    tuples_as_fields: [1] at [([0.3], [1.1])]
    definitions {
        pub struct System { spring: (f64, u32), points: [(f64, bool); 2] }
        fn system() -> System { System { spring: (1.3, 4), points: [(0.5, true), (2.5, false)] } }
    }
    functions {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            let (k, n) = self.spring;
            let shift: f64 = self.points.iter().map(|&(x, on)| if on { x } else { -x }).sum();
            0.5 * v[0].powi(2) - k * (q[0] - shift).powi(n as i32) + self.spring.0 * q[0] * v[0].sin()
        }
    }
}

case! {
    a_unit_struct: [1] at [([0.3], [1.1])]
    definitions {
        pub struct System;
        fn system() -> System { System }
    }
    functions {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 { 0.5 * v[0] * v[0] - q[0].cosh() }
    }
}

case! {
    raw_names: [1] at [([0.3], [1.1])]
    definitions {
        pub struct System { r#type: f64, r#match: [f64; 2] }
        fn system() -> System { System { r#type: 1.3, r#match: [0.4, 2.0] } }
    }
    functions {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            let r#fn = self.r#type * v[0];
            0.5 * r#fn * r#fn - self.r#move(q[0]) * self.r#match[1]
        }
        fn r#move(&self, r#in: f64) -> f64 { r#in.sin() * r#in * self.r#match[0] }
    }
}

case! {
    /// A field that is not used by L may be of any type.
    data_of_other_types: [1] at [([0.3], [1.1])]
    definitions {
        pub struct System { m: f64, name: String }
        fn system() -> System { System { m: 2.0, name: "pendulum".to_owned() } }
    }
    functions {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 { 0.5 * self.m * v[0] * v[0] - q[0].cos() * self.m }
        #[allow(dead_code)]
        fn name(&self) -> &str { &self.name }
    }
}
