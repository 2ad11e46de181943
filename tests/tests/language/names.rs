//! Names that a user may choose although the generated code uses them, or the user does twice.

use super::case;

case! {
    locals_named_like_generated_ones: [2] at [([0.3, -0.8], [1.1, 0.4])]
    definitions {
        pub struct System { m: f64 }
        fn system() -> System { System { m: 1.7 } }
    }
    functions {
        fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
            let d = q[0];
            let lift = d * 2.0;
            let dual = lift + v[0];
            let real = 0.5 * dual;
            let h = real * real;
            let q0 = h - d;
            let lower = q0;
            let lagrangian = lower + self.m;
            let number = 3;
            let integer = number % 2;
            lagrangian * v[1] * v[1] * integer as f64 + number as f64 * dual * self.rayleigh([d, h])
        }
        fn rayleigh(&self, v: [f64; 2]) -> f64 {
            let D = v[0];
            let N = v[1];
            D * D * N
        }
    }
}

// Names in capitals are bindings or constants, as rustc has it, of numbers that are known as well.
case! {
    bindings_in_capitals: [1] at [([0.3], [1.1])]
    definitions {
        const TWO: i32 = 2;
        const THREE: i32 = 3;
        pub struct System { n: i32 }
        fn system() -> System { System { n: 3 } }
    }
    functions {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            let mut sum = 0.0;
            for i in 0..5 {
                sum += match i {
                    1 => q[0],
                    TWO => 3.0 * q[0],
                    Turn @ THREE => Turn as f64 * q[0].sin(),
                    Turn => { if (match true { true => Turn, _ => Turn }) <= 3 { v[0] } else { q[0] * Turn as f64 } }
                };
            }
            sum + match self.n { 1 => q[0], Turns => 0.5 * Turns as f64 * v[0] }
        }
    }
}

case! {
    fields_named_like_parameters_and_locals: [2] at [([0.3, -0.8], [1.1, 0.4])]
    definitions {
        pub struct System { q: f64, v: [f64; 2], k: f64, x: f64, lagrangian: f64, d: f64, dual: f64, lift: f64, rest: f64 }
        fn system() -> System {
            System { q: 1.7, v: [0.2, 0.5], k: 0.3, x: 2.0, lagrangian: 1.5, d: 0.7, dual: 1.1, lift: 0.9, rest: 4.0 }
        }
    }
    functions {
        fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
            let k = self.k * q[0];
            let self_k = k * self.q;
            let self_k_ = self_k + self.v[1];
            let square = |x: f64| x * x * self.x;
            let rest = |rest: f64| rest * self.rest;
            let d = self.d;
            square(v[0]) + square(v[1]) - self_k_ * self.k * self.lagrangian - rest(q[1]) * d * self.dual * self.lift
        }
    }
}

case! {
    a_tuple_field_beside_a_local_of_its_local_name: [1] at [([0.3], [1.1])]
    definitions {
        pub struct System(f64, f64);
        fn system() -> System { System(1.7, 0.3) }
    }
    functions {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            let field_0 = q[0] * 2.0;
            field_0 * self.0 * v[0] * v[0] + self.1 * q[0].sin()
        }
    }
}

case! {
    /// The user's own types and traits of the names that the implementations import, in functions of the same
    /// block.
    types_of_the_user: [1] at [([0.3], [1.1])]
    definitions {
        #[derive(Clone, Copy)]
        #[allow(dead_code)]
        pub enum Direction { Up, Down }
        #[allow(dead_code)]
        pub struct Gradient;
        #[allow(dead_code)]
        pub mod dual { pub struct Momenta; }
        pub struct System { m: f64, g: f64 }
        fn system() -> System { System::new(Direction::Up, 9.81) }
    }
    functions {
        fn new(direction: Direction, g: f64) -> Self {
            let g = match direction { Direction::Up => g, Direction::Down => -g };
            Self { m: 2.0, g }
        }
        #[allow(dead_code)]
        fn gradient(&self, _: Gradient) -> dual::Momenta { dual::Momenta }
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            0.5 * self.m * v[0] * v[0] - self.m * self.g * q[0].sin()
        }
    }
}

case! {
    shadowed_names: [1] at [([0.3], [1.1])]
    definitions {
        pub struct System { m: f64 }
        fn system() -> System { System { m: 2.0 } }
    }
    functions {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            let m = { let m = self.m; m * m };
            let m = if m > 1.0 { let m = m + q[0]; m } else { self.m };
            (|m: f64| m * v[0])(m) * v[0]
        }
    }
}
