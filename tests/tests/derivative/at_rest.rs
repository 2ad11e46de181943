//! Derivatives at rest of drag that grows as |v|² and |v|³ do: there they are those without drag, however the
//! drag is written; and a friction that has none there says so.

use dalembert::nalgebra::{SVector, vector};
use dalembert::system::Function;
use dalembert::{Discretise, Gauss, Midpoint, State, StepError, Trapezoidal, rayleigh_system};

/// The drag of this module's systems, as `$r` of `self.c` and v, beside a spring and an input.
macro_rules! body {
    ($name:ident, |$this:ident, $v:ident| $r:expr) => {
        struct $name {
            c: f64,
        }

        #[rayleigh_system(rule = [midpoint, trapezoidal, gauss], parameters = [c])]
        impl $name {
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                0.5 * (v[0] * v[0] + 2.0 * v[1] * v[1]) - 0.5 * q[0] * q[0] - q[1] * q[1]
            }
            fn rayleigh(&$this, $v: [f64; 2]) -> f64 {
                $r
            }
            fn force(&self, _q: [f64; 2], _v: [f64; 2], u: [f64; 1]) -> [f64; 2] {
                [u[0], 0.0]
            }
        }
    };
}
body!(Without, |self, v| 0.0 * self.c * v[0] * v[1]);
body!(RootTimesSum, |self, v| {
    let s = v[0] * v[0] + v[1] * v[1];
    self.c / 3.0 * s * s.sqrt()
});
body!(Power, |self, v| {
    let s = v[0] * v[0] + v[1] * v[1];
    self.c / 3.0 * s.powf(1.5)
});
body!(NormCubed, |self, v| self.c / 3.0 * v[0].hypot(v[1]).powi(3));
body!(NormTimesSquares, |self, v| self.c / 3.0 * v[0].hypot(v[1]) * (v[0] * v[0] + v[1].powi(2)));
body!(RootCubed, |self, v| {
    let speed = (v[0].powi(2) + 2.0 * v[1] * v[1]).sqrt();
    self.c * speed * speed * speed
});
body!(Loop, |self, v| {
    let mut s = 0.0;
    for x in v {
        s += x * x;
    }
    self.c * (0.5 * s).powf(1.25)
});
// Dry friction, which has no derivative at rest, of what is not linear in v: of no kink for `proximal`.
body!(Dry, |self, v| self.c * (v[0] * v[0] + (v[1] + v[1].powi(3)).powi(2)).sqrt());

/// Drag as a force, −c |v| v.
struct Forced {
    c: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss], parameters = [c])]
impl Forced {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + 2.0 * v[1] * v[1]) - 0.5 * q[0] * q[0] - q[1] * q[1]
    }
    fn force(&self, _q: [f64; 2], v: [f64; 2], u: [f64; 1]) -> [f64; 2] {
        let speed = (v[0] * v[0] + v[1] * v[1]).sqrt();
        [u[0] - self.c * speed * v[0], -self.c * speed * v[1]]
    }
}

const REST: State<f64, 2> = State { q: vector![0.0, 0.0], p: vector![0.0, 0.0] };

macro_rules! derivatives {
    ($system:expr, $method:expr, $at:expr) => {{
        let system = $system;
        let driven = system.driven([0.0]);
        let by = driven.by($method, 0.1);
        by.linearized(&$at).and_then(|taken| {
            let (a, b) = (taken.by_state()?, taken.by_input()?);
            Ok((*taken.step(), a, b, taken.by_parameters::<1>()))
        })
    }};
}

#[test]
fn drag_that_grows_faster_has_the_derivatives_of_none_at_rest() {
    macro_rules! check {
        ($method:expr, $($system:ident)*) => {
            let (_, a, b, _) = derivatives!(Without { c: 0.7 }, $method, REST).unwrap();
            $(
                let (step, own, input, by_drag) = derivatives!($system { c: 0.7 }, $method, REST).unwrap();
                assert_eq!(step.state, REST, stringify!($system));
                let off = (own.assembled::<4>() - a.assembled::<4>()).amax();
                let off = off.max((input.assembled::<4>() - b.assembled::<4>()).amax());
                assert!(off < 1e-15, "{}: {off}", stringify!($system));
                assert_eq!(by_drag.unwrap().assembled::<4>(), SVector::<f64, 4>::zeros(), stringify!($system));
                // Away from it they are those of differences, and others than those without drag.
                let from = State { q: vector![0.2, -0.1], p: vector![0.5, 0.4] };
                let (_, own, ..) = derivatives!($system { c: 0.7 }, $method, from).unwrap();
                let moved = |by: f64| {
                    let from = State { p: from.p + vector![by, 0.0], ..from };
                    $system { c: 0.7 }.driven([0.0]).by($method, 0.1).step(&from).unwrap().state
                };
                let slope = (moved(1e-5).p - moved(-1e-5).p) / 2e-5;
                assert!((own.p_by_p.column(0) - slope).amax() < 1e-9, "{}", stringify!($system));
                let (_, none, ..) = derivatives!(Without { c: 0.7 }, $method, from).unwrap();
                assert!((own.p_by_p - none.p_by_p).amax() > 1e-3);
            )*
        };
    }
    check!(Midpoint, RootTimesSum Power NormCubed NormTimesSquares RootCubed Loop Forced);
    check!(Trapezoidal, RootTimesSum Power NormCubed NormTimesSquares RootCubed Loop Forced);
    check!(Gauss::<2>, RootTimesSum Power NormCubed NormTimesSquares RootCubed Loop Forced);
    check!(Gauss::<4>, RootTimesSum Power NormCubed NormTimesSquares RootCubed Loop Forced);
}

/// Dry friction has no derivative at rest, and the error says that it is R that has none, and what to write.
#[test]
fn a_friction_without_derivatives_at_rest_says_so() {
    macro_rules! check {
        ($method:expr) => {
            let error = derivatives!(Dry { c: 0.7 }, $method, REST).unwrap_err();
            let is_named =
                matches!(error, StepError::NoDerivative { function: Function::Rayleigh, place: Some(_), .. });
            assert!(is_named && error.to_string().contains("√(s + ε²)"), "{error}");
            // Positive control: it has some where it moves.
            let moving = State { q: vector![0.0, 0.0], p: vector![1.0, 2.0] };
            assert!(derivatives!(Dry { c: 0.7 }, $method, moving).is_ok());
        };
    }
    check!(Midpoint);
    check!(Trapezoidal);
    check!(Gauss::<2>);
}
