//! One language for all engines: what `auto` writes out, `expanded` does, and `num_dual` takes.

use dalembert::nalgebra::SVector;
use dalembert::system::Engine;
use dalembert::{Discrete, Discretise, Lagrangian, Midpoint, Rayleigh, State};

/// The same system by each engine.
macro_rules! by_each_engine {
    ($($engine:ident),*) => {$(
        mod $engine {
            #[derive(Clone, Copy)]
            pub enum Friction {
                None,
                Linear(f64),
                Quadratic { c: f64 },
                Table([f64; 2]),
            }

            pub struct Slider {
                pub law: Friction,
                pub k3: Option<f64>,
            }

            #[dalembert::rayleigh_system(rule = [midpoint, gauss], derivatives = $engine)]
            impl Slider {
                fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                    let mut potential = 0.5 * q[0] * q[0];
                    if let Some(k) = self.k3 {
                        potential += 0.25 * k * q[0].powi(4);
                    }
                    0.5 * v[0] * v[0] - potential
                }
                fn rayleigh(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                    Self::dissipation(self.law, v[0]) * if matches!(self.law, Friction::Table(_)) { q[0].cos() } else { 1.0 }
                }
                fn dissipation(law: Friction, v: f64) -> f64 {
                    match law {
                        Friction::None => 0.0,
                        Friction::Linear(c) => 0.5 * c * v * v,
                        Friction::Quadratic { c } => c * v.abs().powi(3) / 3.0,
                        Friction::Table([a, b]) => a * v * v + b * v.powi(4),
                    }
                }
            }

            pub fn all() -> Vec<Slider> {
                let laws = [
                    Friction::None,
                    Friction::Linear(0.7),
                    Friction::Quadratic { c: 0.6 },
                    Friction::Table([0.2, 0.1]),
                ];
                laws.into_iter().flat_map(|law| [None, Some(0.8)].map(|k3| Slider { law, k3 })).collect()
            }
        }
    )*};
}
by_each_engine!(auto, expanded, num_dual);

type Vector = SVector<f64, 1>;

/// L, R, their derivatives and a step.
fn seen<S>(system: &S) -> Vec<f64>
where
    S: Lagrangian<1, Scalar = f64> + Rayleigh<1> + Discrete<Midpoint, 1>,
{
    let (q, v) = (Vector::new(0.7), Vector::new(-0.9));
    let (l, r) = (system.lagrangian_derivatives(&q, &v), system.rayleigh_derivatives(&q, &v));
    let start = State::from_velocity(system, [0.7], [-0.9]).expect("a regular start");
    let step = system.by(Midpoint, 0.1).step(&start).expect("a short step");
    let numbers = [l, r].map(|d| [d.value, d.d1[0], d.d2[0], d.d11[0], d.d12[0], d.d22[0]]).concat();
    numbers.into_iter().chain([step.state.q[0], step.state.p[0]]).collect()
}

#[test]
fn friction_by_an_enum_and_optional_terms_are_those_of_every_engine() {
    for ((auto, expanded), by_duals) in auto::all().iter().zip(&expanded::all()).zip(&num_dual::all()) {
        let numbers = seen(auto);
        assert_eq!(numbers, seen(expanded));
        for (a, b) in numbers.iter().zip(seen(by_duals)) {
            assert!((a - b).abs() <= 4.0 * f64::EPSILON * (1.0 + b.abs()), "{a} {b}");
        }
        // Closed forms.
        let v = -0.9_f64;
        let expected = match auto.law {
            auto::Friction::None => 0.0,
            auto::Friction::Linear(c) => c * v,
            auto::Friction::Quadratic { c } => c * v * v.abs(),
            auto::Friction::Table([a, b]) => (2.0 * a * v + 4.0 * b * v.powi(3)) * 0.7_f64.cos(),
        };
        assert!((numbers[8] - expected).abs() < 1e-15, "{} {expected}", numbers[8]);
    }
    // The laws differ: a first arm that is always taken would not be seen otherwise.
    let forces: Vec<f64> = auto::all().iter().map(|system| seen(system)[8]).collect();
    assert!(forces.windows(3).step_by(2).all(|three| three[0] != three[2]), "{forces:?}");
}

#[test]
fn nothing_falls_back_to_dual_numbers() {
    let engine = |structure: dalembert::system::Structure| structure.engine;
    assert!(matches!(engine(auto::Slider::STRUCTURE), Engine::Expanded));
    assert!(!matches!(engine(num_dual::Slider::STRUCTURE), Engine::Expanded));
}

/// Structs within the system, operands that change what others read, casts of constants: the same system by
/// each engine, with a body that can be written out, and with a loop that numbers end, which cannot.
macro_rules! nested_by_each_engine {
    ($($name:ident by $engine:ident with $speed:ident [$($more:tt)*]),*) => {$(
        mod $name {
            #[derive(Clone, Copy)]
            pub struct Spring {
                pub k: f64,
                pub count: u8,
            }

            pub struct Outer {
                pub inner: Spring,
                pub pair: (f64, Spring),
            }

            pub struct Nested {
                pub outer: Outer,
                pub springs: [Spring; 2],
            }

            #[dalembert::rayleigh_system(derivatives = $engine)]
            impl Nested {
                fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                    let mut x = q[0];
                    x += {
                        x -= 1.0;
                        x * q[1]
                    };
                    let mut y = q[1];
                    let was_less = y < {
                        y += 0.25;
                        y
                    };
                    let (mut i, mut sums) = (0, [0.0, 0.0]);
                    sums[{
                        i -= 1;
                        i
                    }] += {
                        i += 1;
                        self.springs[i].k * q[0] * q[0]
                    };
                    sums[i] += self.outer.pair.1.k * q[1] * q[1];
                    let c = 1.1_f32 as f64;
                    let n = 2.7_f64 as u8 + (self.outer.pair.0 as u8 - self.springs[1].count);
                    let cubic = if was_less { c * q[0] * q[0] * n as f64 * y } else { 0.0 };
                    let potential = 0.5 * self.outer.inner.k * x * x + 0.5 * (sums[0] + sums[1]) + cubic;
                    let mut $speed = 0.5 * (v[0] * v[0] + v[1] * v[1]);
                    $($more)*
                    $speed - potential
                }
            }

            pub fn nested() -> Nested {
                let spring = |k, count| Spring { k, count };
                let outer = Outer { inner: spring(0.7, 1), pair: (2.9, spring(1.3, 4)) };
                Nested { outer, springs: [spring(9.0, 3), spring(0.4, 2)] }
            }
        }
    )*};
}
nested_by_each_engine! {
    nested_auto by auto with speed [speed += 0.0;],
    nested_expanded by expanded with speed [speed += 0.0;],
    nested_num_dual by num_dual with speed [speed += 0.0;],
    fallen_back by auto with speed [while speed > 1e6 { speed *= 0.5; }],
    asked_for by num_dual with speed [while speed > 1e6 { speed *= 0.5; }]
}

/// L and its gradient by q.
fn slopes<S: Lagrangian<2, Scalar = f64>>(system: &S) -> [f64; 3] {
    let gradient = system.lagrangian_gradient(&[0.3, -0.6].into(), &[0.9, -0.2].into());
    [gradient.value, gradient.d1[0], gradient.d1[1]]
}

#[test]
fn structs_and_effects_within_operands_are_those_of_every_engine() {
    let (a, b) = (0.3_f64, -0.6_f64);
    let (x, y, c) = ((a - 1.0) * (1.0 + b), b + 0.25, f64::from(1.1_f32));
    // The casts give 2 + (2 − 2).
    let potential = 0.35 * x * x + 0.5 * (0.4 * a * a + 1.3 * b * b) + 2.0 * c * a * a * y;
    let expected = [
        0.5 * (0.9 * 0.9 + 0.2 * 0.2) - potential,
        -(0.7 * x * (1.0 + b) + 0.4 * a + 4.0 * c * a * y),
        -(0.7 * x * (a - 1.0) + 1.3 * b + 2.0 * c * a * a),
    ];
    let all = [
        slopes(&nested_auto::nested()),
        slopes(&nested_expanded::nested()),
        slopes(&nested_num_dual::nested()),
        slopes(&fallen_back::nested()),
        slopes(&asked_for::nested()),
    ];
    for seen in all {
        for (seen, expected) in seen.iter().zip(expected) {
            assert!((seen - expected).abs() < 1e-15 * (1.0 + expected.abs()), "{seen} {expected}");
        }
    }
    // The loop keeps the derivatives from being written out.
    assert!(matches!(nested_auto::Nested::STRUCTURE.engine, Engine::Expanded));
    assert!(!matches!(fallen_back::Nested::STRUCTURE.engine, Engine::Expanded));
}
