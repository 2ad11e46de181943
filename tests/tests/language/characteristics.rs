//! `self.drag.at(x)`: value and derivatives of characteristics in L, by each engine, wherever a body reads
//! them; the same in lanes; functions of one's own.

use dalembert::nalgebra::vector;
use dalembert::run::LaneRuns;
use dalembert::system::{Curve, Engine, Table};
use dalembert::{
    Discretise, Force, Gauss, Lagrangian, Midpoint, Rayleigh, State, Trapezoidal, rayleigh_system,
};

use crate::case;

/// A spring of four points.
const CAM: Table<4> = match Table::spline([-3.0, -1.0, 0.5, 3.0], [2.0, 0.4, 0.3, 2.5]) {
    Ok(table) => table,
    Err(_) => panic!("not increasing"),
};

// Points away from knots, where difference quotients would see a jump.
case! {
    /// Fields, entries, members, constants, and one place for several derivatives.
    everywhere: [2] at [([0.3, -0.7], [0.9, 0.2]), ([-1.4, 1.2], [-0.3, 1.1]), ([4.2, 0.6], [0.4, -1.7])]
    definitions {
        use dalembert::system::{Table, TableSlice};
        pub struct Wheel { cam: Table<4>, weight: f64 }
        pub struct System {
            thrust: Table<3>,
            wheels: [Wheel; 2],
            slice: TableSlice<'static>,
            mach: f64,
            is_soft: bool,
        }
        pub const RISE: Table<4> = match Table::monotone([-2.0, 0.0, 1.0, 2.0], [0.0, 0.3, 0.8, 0.9]) {
            Ok(table) => table.straight_beyond(),
            Err(_) => panic!("not increasing"),
        };
        fn system() -> System {
            let cam = Table::spline([-3.0, -1.0, 0.5, 3.0], [2.0, 0.4, 0.3, 2.5]).unwrap();
            let turning = Table::periodic([0.0, 1.0, 2.5, 6.0], [0.3, -0.4, 0.9, 0.3]).unwrap();
            System {
                thrust: Table::linear([-1.0, 0.1, 2.0], [3.0, 1.0, 2.0]).unwrap(),
                wheels: [Wheel { cam, weight: 0.7 }, Wheel { cam: turning, weight: -0.4 }],
                slice: TableSlice::spline(
                    vec![-4.0, 0.0, 1.0, 4.0, 6.0].leak(),
                    &[1.0, 2.0, 0.5, 1.0, 2.0],
                    vec![[0.0; 4]; 5].leak(),
                ).unwrap(),
                mach: 0.4,
                is_soft: true,
            }
        }
    }
    functions {
        fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
            let mut sum = self.thrust.at(q[0]) * v[1] * v[1] + self.thrust.at(q[0] * q[1]);
            for (i, wheel) in [0, 1].into_iter().enumerate() {
                sum += self.wheels[wheel].weight * self.wheels[i].cam.at(q[i] + 0.1 * v[i]);
            }
            let table = &self.slice;
            sum += table.at(table.at(q[0]) - q[1]) * RISE.at(v[0] * q[1]) + RISE.at(self.mach) * v[0] * v[0];
            sum += if self.is_soft { &self.wheels[0].cam } else { &self.wheels[1].cam }.at(q[1]);
            sum + self.lift(q[0] - v[1]) + [q[0], v[1]].iter().map(|x| RISE.at(*x)).sum::<f64>()
        }
        fn lift(&self, x: f64) -> f64 {
            if x > 0.0 { self.slice.at(x) } else { self.slice.at(0.0) + 0.5 * x }
        }
    }
}

/// a·sin(x), known by its derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    a: f64,
}

impl Curve<f64> for Wave {
    fn derivatives(&self, x: f64) -> [f64; 4] {
        let (sine, cosine) = x.sin_cos();
        [sine, cosine, -sine, -cosine].map(|value| self.a * value)
    }
}

/// The same system by each engine; with its sines written out where `SINES` says so.
macro_rules! by_each_engine {
    ($($name:ident by $engine:ident, $sines:literal;)*) => {$(
        mod $name {
            use super::*;

            pub struct Pendulum {
                pub wave: Wave,
                pub drag: Table<4>,
            }

            #[rayleigh_system(rule = [midpoint, gauss], step_derivatives = second, derivatives = $engine)]
            impl Pendulum {
                const SINES: bool = $sines;

                fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                    let mass = 2.0 + self.wave(q[0]);
                    0.5 * (v[0] * v[0] + v[1] * v[1] * mass) - CAM.at(q[1]) + self.wave(q[0] * q[1])
                }
                fn wave(&self, x: f64) -> f64 {
                    if Self::SINES { self.wave.a * x.sin() } else { self.wave.at(x) }
                }
                fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                    0.1 * self.drag.at(q[0]) * v[0] * v[0] + 0.05 * v[1] * v[1]
                }
                fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
                    [self.drag.at(v[0] * q[1]), 0.0]
                }
            }

            pub fn pendulum() -> Pendulum {
                let drag = Table::monotone([-2.0, 0.0, 1.0, 2.0], [0.4, 0.3, 0.8, 0.9]).unwrap();
                Pendulum { wave: Wave { a: 0.4 }, drag }
            }

            /// L, R and f with their derivatives; a step of each rule with its second derivatives.
            pub fn seen() -> Vec<f64> {
                let (system, q, v) = (pendulum(), vector![0.7, -0.4], vector![-0.9, 0.3]);
                let (l, r) = (system.lagrangian_derivatives(&q, &v), system.rayleigh_derivatives(&q, &v));
                let f = system.force_derivatives(&q, &v);
                let mut numbers = vec![l.value, r.value];
                numbers.extend([l.d1, l.d2, r.d1, r.d2, f.value].iter().flatten());
                numbers.extend([l.d11, l.d12, l.d22, r.d11, r.d12, r.d22, f.d1, f.d2].iter().flatten());
                let start = State::from_velocity(&system, [0.7, -0.4], [-0.9, 0.3]).unwrap();
                let covector = State { q: vector![0.3, -0.8], p: vector![0.5, 0.2] };
                let steps = [
                    system.by(Midpoint, 0.1).linearized(&start).unwrap().hessian(&covector).unwrap(),
                    system.by(Gauss::<2>, 0.1).linearized(&start).unwrap().hessian(&covector).unwrap(),
                ];
                for hessian in steps {
                    numbers.extend([hessian.qq, hessian.qp, hessian.pp].iter().flatten());
                }
                numbers
            }
        }
    )*};
}
by_each_engine! {
    auto by auto, false;
    expanded by expanded, false;
    num_dual by num_dual, false;
    written by auto, true;
}

#[test]
fn every_engine_and_the_function_written_out_have_the_same_derivatives() {
    let seen = auto::seen();
    assert_eq!(seen, expanded::seen());
    for others in [num_dual::seen(), written::seen()] {
        for (index, (a, b)) in seen.iter().zip(others).enumerate() {
            assert!((a - b).abs() <= 1e-14 * (1.0 + b.abs()), "{index}: {a} {b}");
        }
    }
    assert!(matches!(auto::Pendulum::STRUCTURE.engine, Engine::Expanded));
    assert!(!matches!(num_dual::Pendulum::STRUCTURE.engine, Engine::Expanded));
    // The third derivatives of the wave are in there.
    let plain = State::from_velocity(&auto::pendulum(), [0.7, -0.4], [-0.9, 0.3]).unwrap();
    assert!(plain.p.norm() > 0.5 && seen[seen.len() - 12..].iter().all(|entry| entry.abs() > 1e-6));
}

/// A free function has curves as parameters, and its structure is none of a polynomial.
#[test]
fn what_a_characteristic_gives_is_what_is_taken() {
    #[rayleigh_system]
    fn hill(q: [f64; 1], v: [f64; 1], height: Wave) -> f64 {
        0.5 * v[0] * v[0] - height.at(q[0])
    }
    let hill = Hill { height: Wave { a: 2.0 } };
    let slope = hill.lagrangian_derivatives(&vector![0.4], &vector![1.0]);
    assert_eq!([slope.d1[0], slope.d11[0]], [-2.0 * 0.4_f64.cos(), 2.0 * 0.4_f64.sin()]);
    let structure = Hill::STRUCTURE;
    assert!(!structure.quadratic_lagrangian && structure.constant_mass_matrix);
}

/// A constant table in lanes: every member has the bits of its own run. Fields of it stand before the run.
#[test]
fn members_in_lanes_have_their_own_bits() {
    struct Follower {
        k: f64,
        lift: Table<4>,
    }

    #[rayleigh_system(rule = [midpoint, trapezoidal, gauss], lanes = [explicit, midpoint, gauss])]
    impl Follower {
        fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
            0.5 * (v[0] * v[0] + v[1] * v[1]) - self.k * CAM.at(q[0] - q[1]) - self.lift.at(self.k) * q[1]
        }
        fn rayleigh(&self, v: [f64; 2]) -> f64 {
            0.05 * v[0] * v[0]
        }
    }

    let systems: [Follower; 5] = std::array::from_fn(|i| Follower { k: 0.5 + 0.3 * i as f64, lift: CAM });
    let starts: [State<f64, 2>; 5] = std::array::from_fn(|i| State {
        q: vector![0.3 * i as f64 - 0.7, -0.2],
        p: vector![0.4, -0.1 * i as f64],
    });
    macro_rules! compare {
        ($($method:expr),*) => {$(
            let mut runs = LaneRuns::new($method, systems.each_ref(), &starts, 0.05);
            runs.advance(40);
            for (lane, system) in systems.iter().enumerate() {
                let alone = system.by($method, 0.05).run(starts[lane]).nth(39).unwrap().unwrap().state;
                let state = runs.state(lane).unwrap();
                assert!(state.q == alone.q && state.p == alone.p, "{lane}");
                assert!((state.q - starts[lane].q).norm() > 0.1);
            }
        )*};
    }
    compare!(Midpoint, Trapezoidal, Gauss::<3>);
}

/// Single precision, with the table's own.
#[test]
fn systems_of_single_precision_take_tables_of_theirs() {
    #[rayleigh_system]
    fn slope(q: [f32; 1], v: [f32; 1], height: Table<4, f32>) -> f32 {
        0.5 * v[0] * v[0] - height.at(q[0])
    }
    let slope = Slope { height: CAM.single().unwrap() };
    let seen = slope.lagrangian_gradient(&vector![0.25], &vector![0.0]).d1[0];
    assert!((f64::from(seen) + CAM.derivatives(0.25)[1]).abs() < 1e-6);
}
