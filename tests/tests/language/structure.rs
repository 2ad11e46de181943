//! What the macro finds of a system's structure: for each finding systems that have it, systems that do not,
//! and systems that have it by algebra alone, of which it must not be stated.

use dalembert::system::{Damping, Engine, Structure};
use dalembert::{Lagrangian, rayleigh_system};

/// A system of this N, L, R and f, and its structure.
macro_rules! structure {
    ($n:literal, |$q:ident, $v:ident| $l:expr $(, R = $r:expr)? $(, f = $f:expr)?) => {{
        #[allow(dead_code)]
        struct System {
            m: f64,
            k: [f64; $n],
            on: bool,
        }
        #[rayleigh_system(rule = [midpoint, trapezoidal], derivatives = expanded)]
        #[allow(unused_variables)]
        impl System {
            fn lagrangian(&self, $q: [f64; $n], $v: [f64; $n]) -> f64 {
                $l
            }
            $(
                fn rayleigh(&self, $q: [f64; $n], $v: [f64; $n]) -> f64 {
                    $r
                }
            )?
            $(
                fn force(&self, $q: [f64; $n], $v: [f64; $n]) -> [f64; $n] {
                    $f
                }
            )?
        }
        System::STRUCTURE
    }};
}

/// The matrix by the rule: whether it is constant, and its bandwidth.
fn newton(structure: &Structure, rule: &str) -> (bool, usize) {
    let matrix = structure.newton_matrix(rule).expect("the rule is listed");
    (matrix.constant, matrix.bandwidth)
}

fn by_midpoint(structure: &Structure) -> (bool, usize) {
    newton(structure, "Midpoint")
}

fn by_trapezoidal(structure: &Structure) -> (bool, usize) {
    newton(structure, "Trapezoidal")
}

#[test]
fn a_mass_matrix_is_constant_where_no_entry_holds_q_or_v() {
    for found in [
        structure!(2, |q, v| 0.5 * MASS * (v[0] * v[0] + v[1] * v[1]) - q[0].cos()),
        structure!(2, |q, v| 0.5 * v[0] * v[0] + v[0] * v[1] + v[1].powi(2)),
        // A gyroscopic term does not change it.
        structure!(2, |q, v| 0.5 * (v[0] * v[0] + v[1] * v[1]) + q[0].sin() * v[1]),
        structure!(1, |q, v| (v[0] + 1.0) * (v[0] - 1.0) / 3.0),
        structure!(1, |q, v| v[0].mul_add(v[0], q[0])),
    ] {
        assert!(found.constant_mass_matrix, "{found:?}");
    }
    for not_found in [
        structure!(2, |q, v| 0.5 * (1.0 + q[0] * q[0]) * v[0] * v[0] + v[1] * v[1]),
        // Constant by algebra alone.
        structure!(1, |q, v| 0.5 * (1.0 + q[0] - q[0]) * v[0] * v[0]),
        structure!(1, |q, v| (q[0].sin().powi(2) + q[0].cos().powi(2)) * v[0] * v[0]),
        structure!(1, |q, v| -(1.0 - v[0] * v[0]).sqrt()),
        structure!(1, |q, v| v[0].powi(4)),
        // No second derivative, and yet not quadratic.
        structure!(1, |q, v| 0.5 * v[0] * v[0] + v[0].abs()),
        structure!(1, |q, v| if v[0] > 0.0 { v[0] * v[0] } else { 2.0 * v[0] * v[0] }),
        structure!(1, |q, v| if q[0] > 0.0 { v[0] * v[0] } else { 2.0 * v[0] * v[0] }),
    ] {
        assert!(!not_found.constant_mass_matrix, "{not_found:?}");
    }
}

/// A constant that the macro cannot see into.
const MASS: f64 = 2.0;

#[test]
fn a_lagrangian_is_quadratic_where_its_degree_is_two() {
    for found in [
        structure!(1, |q, v| 0.5 * MASS * v[0] * v[0] - 0.5 * q[0] * q[0]),
        structure!(2, |q, v| v[0] * v[1] + q[0] * v[1] - (q[0] - q[1]).powi(2) + q[1]),
        structure!(1, |q, v| (v[0] + q[0]) * (v[0] - q[0]) / MASS),
    ] {
        assert!(found.quadratic_lagrangian, "{found:?}");
    }
    for not_found in [
        structure!(1, |q, v| 0.5 * v[0] * v[0] - q[0].cos()),
        structure!(1, |q, v| 0.5 * v[0] * v[0] - q[0].powi(3)),
        structure!(1, |q, v| 0.5 * v[0] * v[0] - q[0] * q[0] * v[0]),
        structure!(1, |q, v| 0.5 * v[0] * v[0] - q[0].abs()),
        structure!(1, |q, v| 0.5 * v[0] * v[0] - 1.0 / q[0]),
        structure!(1, |q, v| 0.5 * v[0] * v[0] - q[0] * q[0] * q[0] / q[0]),
    ] {
        assert!(!not_found.quadratic_lagrangian, "{not_found:?}");
    }
}

#[test]
fn a_lagrangian_is_separable_where_no_term_holds_both() {
    for found in [
        structure!(1, |q, v| v[0].cosh() - q[0].abs()),
        structure!(2, |q, v| MASS * (0.5 * v[0] * v[0] + v[1] * v[1] - q[0].hypot(q[1])) / 3.0),
        structure!(1, |q, v| {
            let kinetic = 0.5 * v[0] * v[0];
            -(q[0].sin() - kinetic)
        }),
    ] {
        assert!(found.separable_lagrangian, "{found:?}");
    }
    for not_found in [
        structure!(1, |q, v| v[0] * v[0] + q[0] * v[0]),
        structure!(1, |q, v| (v[0] + q[0]).sin()),
        structure!(1, |q, v| (v[0] * v[0] - q[0]).powi(2)),
        // No mixed second derivative, and yet not separable.
        structure!(1, |q, v| if q[0] > 0.0 { v[0] * v[0] } else { 2.0 * v[0] * v[0] }),
        // By algebra alone.
        structure!(1, |q, v| v[0] * v[0] + q[0] * v[0] - v[0] * q[0]),
    ] {
        assert!(!not_found.separable_lagrangian, "{not_found:?}");
    }
}

#[test]
fn damping_is_told_apart() {
    let none = structure!(1, |q, v| 0.5 * v[0] * v[0]);
    let linear = [
        structure!(2, |q, v| v[0] * v[0] + v[1] * v[1], R = 0.5 * v[0] * v[0] + (v[0] - v[1]).powi(2)),
        structure!(1, |q, v| v[0] * v[0], R = 0.5 * MASS * v[0] * v[0] + v[0]),
    ];
    let by_configuration = [
        structure!(1, |q, v| v[0] * v[0], R = 0.5 * (1.0 + q[0] * q[0]) * v[0] * v[0]),
        structure!(1, |q, v| v[0] * v[0], R = 0.5 * (1.0 + q[0] - q[0]) * v[0] * v[0]),
        structure!(1, |q, v| v[0] * v[0], R = v[0] * v[0] + q[0]),
    ];
    let nonlinear = [
        structure!(1, |q, v| v[0] * v[0], R = v[0].abs().powi(3)),
        structure!(1, |q, v| v[0] * v[0], R = v[0].cosh()),
        structure!(1, |q, v| v[0] * v[0], R = v[0] * v[0] * v[0] / v[0]),
    ];
    assert_eq!(none.damping, Damping::Absent);
    assert!(linear.iter().all(|found| found.damping == Damping::Linear), "{linear:?}");
    assert!(by_configuration.iter().all(|found| found.damping == Damping::LinearByConfiguration));
    assert!(nonlinear.iter().all(|found| found.damping == Damping::Nonlinear), "{nonlinear:?}");
}

#[test]
fn a_newton_matrix_is_constant_where_a_step_is_linear() {
    let linear = structure!(1, |q, v| 0.5 * MASS * v[0] * v[0] - 0.5 * q[0] * q[0], R = 0.5 * v[0] * v[0]);
    assert_eq!((by_midpoint(&linear), by_trapezoidal(&linear)), ((true, 0), (true, 0)));
    // Any potential, and any force that does not depend on v, are explicit by the trapezoidal rule.
    for explicit in [
        structure!(1, |q, v| 0.5 * MASS * v[0] * v[0] - q[0].cos(), R = 0.5 * v[0] * v[0]),
        structure!(1, |q, v| 0.5 * v[0] * v[0] - q[0].abs(), f = [q[0].sin() - 0.5 * v[0]]),
        structure!(1, |q, v| 0.5 * v[0] * v[0] + 3.0 * q[0] * v[0] - q[0].powi(4)),
    ] {
        assert!(by_trapezoidal(&explicit).0, "{explicit:?}");
        assert!(!by_midpoint(&explicit).0, "{explicit:?}");
    }
    for neither in [
        structure!(1, |q, v| 0.5 * (1.0 + q[0] * q[0]) * v[0] * v[0]),
        structure!(1, |q, v| 0.5 * v[0] * v[0] + q[0] * q[0] * v[0]),
        structure!(1, |q, v| 0.5 * v[0] * v[0] + v[0].abs()),
        structure!(1, |q, v| 0.5 * v[0] * v[0], R = v[0].abs().powi(3)),
        structure!(1, |q, v| 0.5 * v[0] * v[0], R = 0.5 * (1.0 + q[0] * q[0]) * v[0] * v[0]),
        structure!(1, |q, v| 0.5 * v[0] * v[0], f = [-q[0].cos() * v[0]]),
        structure!(1, |q, v| 0.5 * v[0] * v[0], f = [-v[0].abs()]),
        // By algebra alone.
        structure!(1, |q, v| 0.5 * (1.0 + q[0] - q[0]) * v[0] * v[0]),
    ] {
        assert!(!by_midpoint(&neither).0 && !by_trapezoidal(&neither).0, "{neither:?}");
    }
    // A spring with a stop has no second derivative beside the constant one, and a matrix that jumps.
    let stop = structure!(1, |q, v| 0.5 * v[0] * v[0] - q[0].max(0.0));
    assert!(!by_midpoint(&stop).0);
}

#[test]
fn the_bandwidth_is_that_of_the_widest_entry() {
    let chain = structure!(5, |q, v| {
        let mut energy = 0.0;
        for v in v {
            energy += 0.5 * v * v;
        }
        for i in 1..5 {
            energy -= (q[i] - q[i - 1]).powi(4);
        }
        energy
    });
    // The potential is not seen by ∂p0/∂v̄ of the trapezoidal rule.
    assert_eq!((by_midpoint(&chain).1, by_trapezoidal(&chain).1), (1, 0));
    let ring = structure!(4, |q, v| {
        let kinetic = v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + v[3] * v[3];
        kinetic - (q[3] - q[0]).powi(4)
    });
    assert_eq!(by_midpoint(&ring).1, 3);
    let damped = structure!(
        4,
        |q, v| v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + v[3] * v[3],
        R = (v[2] - v[0]).powi(2)
    );
    assert_eq!((by_midpoint(&damped).1, by_trapezoidal(&damped).1), (2, 2));
    let follower = structure!(3, |q, v| v[0] * v[0] + v[1] * v[1] + v[2] * v[2], f = [0.0, 0.0, -q[1]]);
    assert_eq!((by_midpoint(&follower).1, by_trapezoidal(&follower).1), (1, 0));
}

#[test]
fn a_coordinate_that_is_absent_from_l_is_cyclic() {
    let conserved = |structure: &Structure| -> Vec<(usize, bool)> {
        structure.cyclic.iter().map(|coordinate| (coordinate.index, coordinate.is_conserved())).collect()
    };
    // Polar coordinates: the angle is cyclic, the radius is not.
    let polar = structure!(2, |q, v| 0.5 * (v[0] * v[0] + q[0] * q[0] * v[1] * v[1]) - q[0].powi(4));
    assert_eq!(conserved(&polar), [(1, true)]);
    // Dissipation on the angle, by its velocity or by itself.
    let drag = structure!(2, |q, v| v[0] * v[0] + q[0] * q[0] * v[1] * v[1], R = 0.5 * v[1] * v[1]);
    assert_eq!(conserved(&drag), [(1, false)]);
    let wall = structure!(2, |q, v| v[0] * v[0] + q[0] * q[0] * v[1] * v[1], R = q[1].cos() * v[0] * v[0]);
    assert_eq!(conserved(&wall), [(1, false)]);
    assert!(wall.cyclic[0].damped && !wall.cyclic[0].forced);
    // On the radius alone it leaves the angular momentum.
    let radial = structure!(2, |q, v| v[0] * v[0] + q[0] * q[0] * v[1] * v[1], R = 0.5 * v[0] * v[0]);
    assert_eq!(conserved(&radial), [(1, true)]);
    // A force.
    let pushed = structure!(2, |q, v| v[0] * v[0] + q[0] * v[1] * v[1], f = [0.0, 1.0]);
    assert_eq!(conserved(&pushed), [(1, false)]);
    assert!(pushed.cyclic[0].forced && !pushed.cyclic[0].damped);
    let pulled = structure!(2, |q, v| v[0] * v[0] + q[0] * v[1] * v[1], f = [1.0, 0.0]);
    assert_eq!(conserved(&pulled), [(1, true)]);
    // Absent by algebra alone, or from the derivative alone: not stated.
    assert_eq!(structure!(1, |q, v| v[0] * v[0] + q[0] - q[0]).cyclic, []);
    assert_eq!(structure!(1, |q, v| v[0] * v[0] + if q[0] > 0.0 { 1.0 } else { 0.0 }).cyclic, []);
}

/// L depends on the fields in whichever way: the findings are about q and v.
#[test]
fn conditions_on_fields_alone_keep_the_structure() {
    let found = structure!(1, |q, v| MASS * v[0] * v[0] - if MASS > 1.0 { q[0] * q[0] } else { q[0] });
    assert!(found.quadratic_lagrangian && found.separable_lagrangian && by_midpoint(&found).0);
}

#[rayleigh_system]
fn by_asking(q: [f64; 1], v: [f64; 1]) -> f64 {
    v[0] * v[0] - q[0]
}

struct Wrapped {
    turns: usize,
}

#[allow(deprecated, reason = "dual numbers are what is tested")]
#[rayleigh_system]
impl Wrapped {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        let mut energy = v[0] * v[0];
        for _ in 0..self.turns {
            energy -= q[0] * q[0];
        }
        energy
    }
}

#[rayleigh_system(derivatives = num_dual)]
fn by_dual_numbers(q: [f64; 1], v: [f64; 1]) -> f64 {
    v[0] * v[0] - q[0]
}

/// Each turn doubles the work of the derivatives.
#[allow(deprecated, reason = "dual numbers are what is tested")]
#[rayleigh_system]
fn long(q: [f64; 2], v: [f64; 2]) -> f64 {
    let mut x = q[0];
    let mut y = q[1];
    for i in 0..6000 {
        let before = x;
        x = (x * y + f64::from(i)).sin();
        y = (before - y).exp().cos();
    }
    v[0] * v[0] + v[1] * v[1] - x * y
}

#[test]
fn the_engine_is_stated_with_what_stood_in_its_way() {
    assert_eq!(ByAsking::STRUCTURE.engine, Engine::Expanded);
    assert_eq!(ByDualNumbers::STRUCTURE.engine, Engine::NumDual { refusal: None });

    let Engine::NumDual { refusal: Some(refusal) } = Wrapped::STRUCTURE.engine else {
        panic!("{:?}", Wrapped::STRUCTURE.engine);
    };
    let line =
        include_str!("structure.rs").lines().position(|line| line.trim() == "for _ in 0..self.turns {");
    assert_eq!((refusal.token, refusal.line), ("self.turns", line.map(|line| line as u32 + 1)));
    assert!(line.is_some());
    assert!(refusal.reason.contains("not known at compile time"), "{}", refusal.reason);

    let Engine::NumDual { refusal: Some(refusal) } = Long::STRUCTURE.engine else {
        panic!("{:?}", Long::STRUCTURE.engine);
    };
    assert_eq!(refusal.token, "0 .. 6000");
    assert!(refusal.reason.contains("20000"), "{}", refusal.reason);

    // Nothing is stated of what was not looked at.
    for unknown in [Wrapped::STRUCTURE, Long::STRUCTURE, ByDualNumbers::STRUCTURE] {
        assert_eq!(unknown.with_engine(Engine::ByHand), Structure::UNKNOWN);
    }
}
