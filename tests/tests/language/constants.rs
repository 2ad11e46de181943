//! Constants: of the standard library, of the module, of the block; and N itself.

use super::case;

case! {
    of_the_standard_library: [1] at [([0.3], [1.1])]
    definitions {
        use std::f64::consts::PI;
        pub struct System;
        fn system() -> System { System }
    }
    functions {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            use std::f64::consts::{FRAC_PI_2, TAU};
            let big = if q[0] < f64::MAX && f64::EPSILON < 1.0 { f64::MIN_POSITIVE } else { f64::INFINITY };
            PI * v[0] * v[0] - (TAU * q[0]).sin() - FRAC_PI_2 * q[0].powi(2) * std::f64::consts::E + big
        }
    }
}

case! {
    of_the_module: [2] at [([0.3, 0.4], [1.1, -0.2])]
    definitions {
        const G: f64 = 9.81;
        const WEIGHTS: [f64; 2] = [0.25, 0.75];
        static OFFSET: f64 = 0.125;
        mod physics {
            pub const LENGTH: f64 = 0.7;
            pub const STEPS: usize = 2;
        }
        pub struct System;
        fn system() -> System { System }
    }
    functions {
        fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
            let mut l = 0.0;
            for i in 0..physics::STEPS {
                l += WEIGHTS[i] * v[i] * v[i] - G * physics::LENGTH * (1.0 - q[i].cos()) * (q[i] - OFFSET);
            }
            l * self::G
        }
    }
}

case! {
    of_the_block: [2] at [([0.3, 0.4], [1.1, -0.2])]
    definitions {
        pub struct System;
        fn system() -> System { System }
    }
    functions {
        const G: f64 = 9.81;
        const POWER: i32 = 3;
        const MASSES: [f64; 2] = [1.0, 2.0];
        const UP: bool = true;
        fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
            let sign = if Self::UP { 1.0 } else { -1.0 };
            Self::MASSES[0] * v[0] * v[0] + System::MASSES[1] * v[1] * v[1] * q[0] - sign * Self::G * q[1].powi(Self::POWER)
        }
    }
}

case! {
    n_of_the_module: [3] at [([0.3, 0.4, -0.1], [1.1, -0.2, 0.6])]
    definitions {
        const N: usize = 3;
        pub struct System { k: f64 }
        fn system() -> System { System { k: 1.5 } }
    }
    functions {
        fn lagrangian(&self, q: [f64; N], v: [f64; N]) -> f64 {
            let mut l = 0.0;
            for i in 0..N {
                l += 0.5 * v[i] * v[i] - self.k * (q[i] - q[(i + 1) % N]).cos();
            }
            l
        }
    }
}

case! {
    n_of_the_block: [3] at [([0.3, 0.4, -0.1], [1.1, -0.2, 0.6])]
    definitions {
        pub struct System { k: [f64; 2] }
        fn system() -> System { System { k: [1.5, 0.3] } }
    }
    functions {
        const N: usize = 3;
        fn lagrangian(&self, q: [f64; Self::N], v: [f64; Self::N]) -> f64 {
            let kinetic: f64 = v.iter().map(|v| 0.5 * v * v).sum();
            let mut stretch = [0.0; Self::N - 1];
            for i in 0..Self::N - 1 {
                stretch[i] = q[i + 1] - q[i];
            }
            kinetic - self.potential(&stretch)
        }
        fn potential(&self, stretch: &[f64; Self::N - 1]) -> f64 {
            stretch.iter().zip(&self.k).map(|(d, k)| 0.5 * k * d * d + 0.25 * d.powi(4)).sum()
        }
    }
}

/// Constants and statics in small letters, by each engine.
macro_rules! in_small_letters {
    ($($name:ident: $engine:ident of $scalar:ident;)*) => {$(
        #[allow(non_upper_case_globals)]
        mod $name {
            const g: $scalar = 9.81;
            static damping: $scalar = 0.1;
            const half_of_it: f32 = 0.25;
            static count: usize = 3;
            // What a temporary would be called.
            const cos_q0: $scalar = 2.0;
            pub mod physics {
                pub const k: $scalar = 0.3;
                pub static c: [$scalar; 2] = [0.1, 0.2];
            }
            pub struct Small {
                pub m: $scalar,
            }

            #[dalembert::rayleigh_system(derivatives = $engine)]
            impl Small {
                fn lagrangian(&self, q: [$scalar; 1], v: [$scalar; 1]) -> $scalar {
                    let weight = g;
                    let slope = if q[0] > 0.0 { damping } else { q[0] };
                    0.5 * self.m * v[0] * v[0] - self.m * weight * q[0] * cos_q0 + slope * q[0] * v[0]
                        + (half_of_it * 2.0) as $scalar * q[0].cos() + q[0] * q[0].cos()
                        - self::physics::k * q[0] * q[0] + physics::c[1] * v[0] * count as $scalar
                }
                fn rayleigh(&self, v: [$scalar; 1]) -> $scalar {
                    0.5 * damping * v[0] * v[0]
                }
            }
        }
    )*};
}
in_small_letters! {
    small_auto: auto of f64;
    small_expanded: expanded of f64;
    small_num_dual: num_dual of f64;
    small_single: expanded of f32;
}

#[test]
fn constants_in_small_letters_are_those_of_the_module() {
    use dalembert::nalgebra::SVector;
    use dalembert::system::Engine;
    use dalembert::{Lagrangian, Rayleigh};

    let (q, v) = (0.3_f64, -1.1_f64);
    let value = v * v - 2.0 * 9.81 * q * 2.0 + 0.1 * q * v + (0.5 + q) * q.cos() - 0.3 * q * q + 0.6 * v;
    let by_q = -2.0 * 9.81 * 2.0 + 0.1 * v - (0.5 + q) * q.sin() + q.cos() - 0.6 * q;
    let by_v = 2.0 * v + 0.1 * q + 0.6;
    macro_rules! check {
        ($($name:ident within $error:literal),*) => {$(
            let system = $name::Small { m: 2.0 };
            let (q, v) = (SVector::from([0.3]), SVector::from([-1.1]));
            let seen = system.lagrangian_derivatives(&q, &v);
            for (seen, expected) in [(seen.value, value), (seen.d1[0], by_q), (seen.d2[0], by_v)] {
                let error = (f64::from(seen) - expected).abs();
                assert!(error < $error * (1.0 + expected.abs()), "{}: {seen} {expected}", stringify!($name));
            }
            let force = f64::from(system.rayleigh_gradient(&q, &v).d2[0]);
            assert!((force + 0.11).abs() < $error, "{force}");
        )*};
    }
    check!(small_auto within 1e-15, small_expanded within 1e-15, small_num_dual within 1e-15);
    check!(small_single within 1e-6);
    assert!(matches!(small_auto::Small::STRUCTURE.engine, Engine::Expanded));
}

/// `self::G` in functions that take an input or the time, and in lanes: the module, not the receiver.
#[test]
fn a_path_from_the_module_is_not_the_receiver() {
    use dalembert::nalgebra::vector;
    use dalembert::{Force, Lagrangian, Rayleigh};

    macro_rules! by {
        ($($name:ident: $engine:ident $(, $option:ident = $value:ident)*;)*) => {$(
            mod $name {
                const G: f64 = 2.0;
                pub struct Seen {
                    pub k: f64,
                }

                #[dalembert::rayleigh_system(derivatives = $engine $(, $option = $value)*)]
                impl Seen {
                    fn lagrangian(&self, q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
                        0.5 * v[0] * v[0] - self::G * self.k * q[0] * t
                    }
                    fn rayleigh(&self, v: [f64; 1], t: f64) -> f64 {
                        self::G * v[0] * v[0] * t
                    }
                    fn force(&self, q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
                        [self::G * q[0] * u[0]]
                    }
                }
            }
            let (q, v) = (vector![0.7], vector![-0.4]);
            let system = $name::Seen { k: 3.0 };
            let system = system.driven([5.0], 0.5);
            let slopes = (
                system.lagrangian_gradient(&q, &v).d1[0],
                system.rayleigh_gradient(&q, &v).d2[0],
                system.force_derivatives(&q, &v).d1[0],
            );
            assert_eq!(slopes, (-3.0, -0.8, 10.0));
        )*};
    }
    by! {
        written_out: expanded;
        over_duals: num_dual;
        in_lanes: expanded, rule = gauss, lanes = gauss;
    }
}
