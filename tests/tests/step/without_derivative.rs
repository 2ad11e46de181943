//! Errors of derivatives that do not exist: they name the function, the place and the cure.

use dalembert::nalgebra::{SVector, vector};
use dalembert::step::{Discretised, Linearizable, PhaseMatrix};
use dalembert::system::{Function, Operation};
use dalembert::{Discretise, Gauss, Midpoint, Splitting, State, StepError, Trapezoidal, rayleigh_system};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// A of the segment that stays at `q`.
fn between<L, R, const N: usize>(
    by: Discretised<'_, L, R, N>,
    q: &SVector<f64, N>,
) -> Result<PhaseMatrix<f64, N>, StepError>
where
    L: Linearizable<R, N, Scalar = f64>,
{
    by.segment(q, q)?.linearized()?.by_state()
}

/// One system with both engines: `$written` and `$dual`.
macro_rules! both {
    ($written:ident $dual:ident { $($field:ident)* } $($functions:item)*) => {
        #[derive(Clone, Copy)]
        struct $written { $($field: f64),* }
        #[derive(Clone, Copy)]
        struct $dual { $($field: f64),* }

        #[rayleigh_system(rule = [midpoint, trapezoidal, gauss], derivatives = expanded)]
        impl $written { $($functions)* }

        #[rayleigh_system(rule = [midpoint, trapezoidal, gauss], derivatives = num_dual)]
        impl $dual { $($functions)* }
    };
}

both! { DryFriction DryFrictionByDuals { c softened }
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - q[0] + 0.5 * q[1] * q[1]
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        self.c * (v[0] * v[0] + v[1] * v[1] + self.softened * self.softened).sqrt()
    }
}

both! { Attraction AttractionByDuals { k softened }
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q[0] - self.k * (q[0] * q[0] + self.softened * self.softened).sqrt()
    }
}

both! { Thrust ThrustByDuals { k softened }
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - q[0] - q[1]
    }

    fn force(&self, _q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        let speed = (v[0] * v[0] + v[1] * v[1] + self.softened * self.softened).sqrt();
        [-self.k * v[0], -self.k * speed]
    }
}

/// Checks the errors at rest at q = 0: of a step by each method, and of derivatives, where the function is
/// `$function`; and of the system with ε that there is none.
macro_rules! check {
    ($at:expr, $smooth:expr, $n:literal, $sticks:literal, $function:expr, $text:expr, [$($method:expr),*]) => {$(
        let zero: SVector<f64, $n> = dalembert::nalgebra::zero();
        let rest = State { q: zero, p: zero };
        let named = |error: StepError| {
            let StepError::NoDerivative { function, place, .. } = error else { panic!("{error:?}") };
            assert_eq!(function, $function);
            let text: Option<&str> = $text;
            assert_eq!(place.map(|place| (place.written.operation, place.written.text, place.argument)), text.map(|text| (Operation::SquareRoot, text, 0.0)));
            let message = error.to_string();
            assert!(message.contains(&$function.to_string()) && message.contains("√(s + ε²)"), "{message}");
            assert!(text.is_none() || message.contains("√s has none at s = 0"), "{message}");
        };
        named(between($at.by($method, 0.1), &zero).unwrap_err());
        if $sticks {
            named($at.by($method, 0.1).step(&rest).unwrap_err());
            named($at.by($method, 0.1).linearized_step(&rest).unwrap_err());
            named($at.by($method, 0.1).run(rest).take(3).find_map(Result::err).unwrap());
        }
        assert!($smooth.by($method, 0.1).step(&rest).is_ok());
        assert!($smooth.by($method, 0.1).linearized_step(&rest).is_ok());
        assert!(between($smooth.by($method, 0.1), &zero).is_ok());
    )*};
}

#[test]
fn the_function_and_the_place_are_named() {
    const FRICTION: &str = "(v[0] * v[0] + v[1] * v[1] + self.softened * self.softened).sqrt()";
    const ATTRACTION: &str = "(q[0] * q[0] + self.softened * self.softened).sqrt()";
    macro_rules! of {
        ($n:literal $sticks:literal $field:ident $written:ident $dual:ident $function:expr, $text:expr, $methods:tt) => {
            let (at, smooth) =
                ($written { $field: 3.0, softened: 0.0 }, $written { $field: 3.0, softened: 0.1 });
            check!(at, smooth, $n, $sticks, $function, Some($text), $methods);
            let (at, smooth) = ($dual { $field: 3.0, softened: 0.0 }, $dual { $field: 3.0, softened: 0.1 });
            check!(at, smooth, $n, $sticks, $function, None, $methods);
        };
    }
    of!(2 true c DryFriction DryFrictionByDuals Function::Rayleigh, FRICTION, [Midpoint, Trapezoidal, Gauss::<1>, Gauss::<3>]);
    of!(1 true k Attraction AttractionByDuals Function::Lagrangian, ATTRACTION, [Midpoint, Trapezoidal, Gauss::<1>]);
    // The force moves it off, whatever its derivatives at rest.
    of!(2 false k Thrust ThrustByDuals Function::Force { index: 1 }, FRICTION, [Midpoint, Trapezoidal, Gauss::<3>]);
}

/// A splitting evaluates the potential at its kicks.
#[test]
fn a_splitting_names_the_potential() {
    let rest = State { q: vector![0.0], p: vector![0.0] };
    let named = |error: StepError| {
        let is_named =
            matches!(error, StepError::NoDerivative { function: Function::Lagrangian, place: Some(_), .. });
        assert!(is_named && error.to_string().contains("√s has none at s = 0"), "{error}");
    };
    let (rough, smooth) = (Attraction { k: 3.0, softened: 0.0 }, Attraction { k: 3.0, softened: 0.1 });
    named(rough.by(Splitting::blanes_casas_escorihuela_8(), 0.1).step(&rest).unwrap_err());
    named(rough.by(Splitting::blanes_casas_escorihuela_8(), 0.1).linearized_step(&rest).unwrap_err());
    named(rough.by(Splitting::blanes_casas_escorihuela_8(), 0.1).run(rest).find_map(Result::err).unwrap());
    assert!(smooth.by(Splitting::blanes_casas_escorihuela_8(), 0.1).linearized_step(&rest).is_ok());
}

/// Where all derivatives are finite, no function is named, whatever else fails.
#[test]
fn no_function_is_named_falsely() {
    let system = Attraction { k: -3.0, softened: 0.1 };
    let (mut failed, mut random) = (0, StdRng::seed_from_u64(7));
    for _ in 0..300 {
        let state =
            State { q: vector![random.random_range(-3.0..3.0)], p: vector![random.random_range(-9.0..9.0)] };
        for h in [0.1, 3.0, 1e3, 1e200] {
            for step in [system.by(Midpoint, h).step(&state), system.by(Gauss::<2>, h).step(&state)] {
                if let Err(error) = step {
                    failed += 1;
                    let is_lost = matches!(error, StepError::NoDerivative { place: Some(_), .. });
                    assert!(!is_lost, "{error} from {state:?} by {h}");
                }
            }
        }
    }
    assert!(failed > 100, "{failed}");
}

// One operation at rest, in the function and of the kind that the fields say: every other stands in a branch
// that is not taken.
both! { Switched SwitchedByDuals { function kind exponent factor x y }
    fn term(&self, function: f64, x: f64, y: f64) -> f64 {
        let s = x * x + y * y;
        let term = if self.kind == 0.0 {
            s.sqrt()
        } else if self.kind == 1.0 {
            s.powf(self.exponent)
        } else if self.kind == 2.0 {
            s.ln()
        } else if self.kind == 3.0 {
            x.hypot(y)
        } else if self.kind == 4.0 {
            1.0 / s
        } else {
            s.cbrt()
        };
        if self.function == function { self.factor * term } else { 0.0 }
    }

    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let potential = 0.5 * q[0] * q[0] + q[1] + self.term(0.0, q[0] - self.x, q[1] - self.y);
        0.5 * (v[0] * v[0] + v[1] * v[1]) - potential
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.1 * (v[0] * v[0] + v[1] * v[1]) + self.term(1.0, v[0] + v[0] * v[0] * v[0], v[1])
    }

    fn force(&self, _q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        [-0.1 * v[1] + self.term(2.0, v[0], v[1]), 0.1 * v[0] + self.term(3.0, v[0], v[1])]
    }
}

const OPERATIONS: [Operation; 6] = [
    Operation::SquareRoot,
    Operation::Power,
    Operation::Logarithm,
    Operation::Length,
    Operation::Division,
    Operation::CubeRoot,
];

#[test]
fn of_random_systems_the_function_with_the_operation_is_named() {
    let functions = [
        Function::Lagrangian,
        Function::Rayleigh,
        Function::Force { index: 0 },
        Function::Force { index: 1 },
    ];
    let mut random = StdRng::seed_from_u64(31);
    let (mut tried, mut refused) = (0_u32, 0_u32);
    for case in 0..if cfg!(debug_assertions) { 96 } else { 20_000 } {
        let (function, kind) = (case % 4, case / 4 % 6);
        let [x, y] = [random.random_range(-2.0..2.0), random.random_range(-2.0..2.0)];
        let (exponent, factor) = (random.random_range(0.1..0.9), random.random_range(0.1..1.0));
        let h = random.random_range(0.01..0.2);
        let rest = State { q: vector![x, y], p: vector![0.0, 0.0] };
        let mut check = |place: Option<Operation>, found: Option<StepError>| {
            tried += 1;
            match found {
                Some(StepError::NoDerivative { function: named, place: at, .. }) => {
                    refused += 1;
                    assert_eq!(named, functions[function], "kind {kind}");
                    assert_eq!(at.map(|at| at.written.operation), place, "{at:?} of {named}");
                }
                // Next to rest the equations may hold, so that the mass rests or moves off.
                None => {}
                Some(other) => panic!("{function} {kind} {place:?}: {other:?}"),
            }
        };
        macro_rules! check {
            ($system:ident, $place:expr) => {
                let (x, y) = (rest.q[0], rest.q[1]);
                let (function, kind) = (function as f64, kind as f64);
                let system = $system { function, kind, exponent, factor, x, y };
                check($place, system.by(Midpoint, h).step(&rest).err());
                check($place, between(system.by(Midpoint, h), &rest.q).err());
                check($place, system.by(Midpoint, h).step_within(&rest, 3).err());
                check($place, system.by(Trapezoidal, h).step(&rest).err());
                check($place, system.by(Trapezoidal, h).linearized_step(&rest).err());
                check($place, system.by(Gauss::<2>, h).step(&rest).err());
                // Control: without the operation all is well.
                let smooth = $system { function: 4.0, ..system };
                assert!(smooth.by(Midpoint, h).step(&rest).is_ok());
                assert!(smooth.by(Trapezoidal, h).linearized_step(&rest).is_ok());
                assert!(smooth.by(Gauss::<2>, h).step(&rest).is_ok());
            };
        }
        check!(Switched, Some(OPERATIONS[kind]));
        check!(SwitchedByDuals, None);
    }
    println!("{refused} of {tried} refused, each with its function");
    assert!(refused * 2 > tried, "{refused} of {tried}");
}
