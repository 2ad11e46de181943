//! The steps that a system's structure allows, against the general one: the same systems with derivatives by
//! num-dual, whose every step is Newton's method with a dense matrix.

/// The systems, with the engine named.
macro_rules! systems {
    ($engine:ident) => {
        use dalembert::rayleigh_system;

        /// Linear by either rule.
        #[rayleigh_system(rule = [midpoint, trapezoidal], derivatives = $engine)]
        pub fn oscillator(q: [f64; 1], v: [f64; 1], m: f64, k: f64, r: f64) -> (f64, f64) {
            (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
        }

        /// Explicit by the trapezoidal rule, with a diagonal matrix.
        #[rayleigh_system(rule = [midpoint, trapezoidal], derivatives = $engine)]
        pub fn ring(q: [f64; 2], v: [f64; 2], k: f64) -> (f64, f64) {
            let s = q[0] * q[0] + q[1] * q[1];
            let r = 0.5 * k * (v[0] * v[0] + v[1] * v[1]);
            (0.5 * (v[0] * v[0] + v[1] * v[1]) - s * (s - 1.0).powi(2), r)
        }

        /// Explicit, with a dense matrix, a part of T that is linear in v, and a force.
        pub struct Coupled {
            pub m: f64,
            pub c: f64,
            pub wind: f64,
        }

        #[rayleigh_system(rule = [midpoint, trapezoidal], derivatives = $engine)]
        impl Coupled {
            fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
                let kinetic = 0.5 * self.m * v[0] * v[0] + 0.7 * v[1] * v[1] + 0.4 * v[2] * v[2];
                kinetic + 0.2 * v[0] * v[1] - 0.1 * v[0] * v[2] + 0.3 * v[1]
                    - (q[0] - q[1]).cosh()
                    - q[2] * q[2] * (1.0 + q[0] * q[0])
            }

            fn rayleigh(&self, v: [f64; 3]) -> f64 {
                0.5 * self.c * (v[0] - v[2]) * (v[0] - v[2])
            }

            fn force(&self, q: [f64; 3], _v: [f64; 3]) -> [f64; 3] {
                [0.0, self.wind * q[0].sin(), -self.wind]
            }
        }

        /// Linear in v̄ by the trapezoidal rule, though L and f hold products of q and v: a charge in a
        /// magnetic field.
        pub struct Charge {
            pub b: f64,
            pub c: f64,
        }

        #[rayleigh_system(rule = [midpoint, trapezoidal], derivatives = $engine)]
        impl Charge {
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                0.5 * (v[0] * v[0] + v[1] * v[1]) + 0.5 * self.b * (q[0] * v[1] - q[1] * v[0])
                    - (q[0] * q[1]).cos()
            }

            fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
                [-self.c * v[0], q[0].sin()]
            }
        }

        /// A kept tridiagonal matrix by the midpoint rule; damping between neighbours makes it so by the
        /// other rule as well.
        pub struct Chain {
            pub beta: f64,
            pub drag: f64,
        }

        #[rayleigh_system(rule = [midpoint, trapezoidal], derivatives = $engine)]
        impl Chain {
            fn lagrangian(&self, q: [f64; 6], v: [f64; 6]) -> f64 {
                let kinetic = v.iter().map(|v| 0.5 * v * v).sum::<f64>();
                let mut energy = kinetic - Self::spring(self.beta, q[0]) - Self::spring(self.beta, q[5]);
                for i in 1..6 {
                    energy -= Self::spring(self.beta, q[i] - q[i - 1]);
                }
                energy
            }

            fn rayleigh(&self, v: [f64; 6]) -> f64 {
                let mut sum = 0.0;
                for i in 1..6 {
                    sum += 0.5 * self.drag * (v[i] - v[i - 1]) * (v[i] - v[i - 1]);
                }
                sum
            }

            fn spring(beta: f64, d: f64) -> f64 {
                let square = d * d;
                0.5 * square + 0.25 * beta * square * square
            }
        }

        /// A mass matrix that depends on q: a kept dense matrix by either rule, and the fused trapezoidal
        /// kernel with all its terms.
        pub struct Spherical {
            pub g: f64,
            pub c: f64,
        }

        #[rayleigh_system(rule = [midpoint, trapezoidal], derivatives = $engine)]
        impl Spherical {
            fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
                let [length, theta, _] = q;
                let across = length * theta.sin() * v[2];
                0.5 * (v[0] * v[0] + length * length * v[1] * v[1] + across * across)
                    + self.g * length * theta.cos()
                    - 5.0 * (length - 1.0).powi(2)
            }

            fn rayleigh(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
                0.5 * self.c * (1.0 + q[1] * q[1]) * v[1] * v[1] + 0.1 * self.c * v[0].powi(4)
            }

            fn force(&self, q: [f64; 3], v: [f64; 3]) -> [f64; 3] {
                [0.0, -0.02 * v[1] * q[0], 0.01 * q[2].cos() - 0.03 * v[2]]
            }
        }
    };
}

/// As their structure allows.
mod special {
    systems!(expanded);
}

/// By Newton's method with dense matrices.
mod general {
    systems!(num_dual);
}

use dalembert::nalgebra::SVector;
use dalembert::run::VelocityHistory;
use dalembert::step::{Fused, Memory, Quantity};
use dalembert::{Discrete, Discretise, Lagrangian, Midpoint, State, StepError, Trapezoidal, rayleigh_system};

/// The end of a run, and the largest number of iterations of a step after the first few.
fn run<L, R, const N: usize>(
    system: &L,
    rule: R,
    h: f64,
    start: State<f64, N>,
    steps: usize,
) -> (State<f64, N>, u32)
where
    L: Discrete<R, N, Scalar = f64>,
{
    let mut trajectory = system.by(rule, h).run(start);
    let mut most = 0;
    for (index, step) in (&mut trajectory).take(steps).enumerate() {
        let report = step.expect("the scene can be stepped").report;
        assert!(report.residual <= 4.0 * report.floor, "step {index}: {report:?}");
        if index > 4 {
            most = most.max(report.iterations);
        }
    }
    (*trajectory.state(), most)
}

/// The largest difference of q and p after `steps`, both systems from the same state.
fn difference<A, B, R, const N: usize>(
    a: &A,
    b: &B,
    rule: R,
    h: f64,
    q: [f64; N],
    v: [f64; N],
    steps: usize,
) -> (f64, u32)
where
    A: Discrete<R, N, Scalar = f64>,
    B: Discrete<R, N, Scalar = f64>,
    R: Copy,
{
    let start = State::from_velocity(b, q, v).unwrap();
    let ((a, most), (b, _)) = (run(a, rule, h, start, steps), run(b, rule, h, start, steps));
    ((a.q - b.q).amax().max((a.p - b.p).amax()), most)
}

/// Both rules agree to `$tolerance` after `$steps`.
macro_rules! agree {
    ($system:ident { $($fields:tt)* }, $h:expr, $q:expr, $v:expr, $steps:expr, $tolerance:expr) => {{
        let (a, b) = (special::$system { $($fields)* }, general::$system { $($fields)* });
        for h in [$h, -$h] {
            let midpoint = difference(&a, &b, Midpoint, h, $q, $v, $steps);
            let trapezoidal = difference(&a, &b, Trapezoidal, h, $q, $v, $steps);
            assert!(midpoint.0 <= $tolerance, "midpoint, h = {h}: {midpoint:?}");
            assert!(trapezoidal.0 <= $tolerance, "trapezoidal, h = {h}: {trapezoidal:?}");
        }
    }};
}

#[test]
fn linear_systems_go_where_newton_goes() {
    agree!(Oscillator { m: 1.3, k: 2.0, r: 0.1 }, 0.1, [1.0], [0.5], 400, 2e-13);
}

#[test]
fn explicit_steps_go_where_newton_goes() {
    agree!(Ring { k: 0.01 }, 0.05, [0.0, 1.1], [0.5, 0.1], 200, 1e-11);
    agree!(Coupled { m: 1.5, c: 0.2, wind: 0.3 }, 0.05, [0.3, -0.2, 0.4], [0.1, 0.5, -0.3], 200, 1e-11);
    agree!(Charge { b: 1.5, c: 0.1 }, 0.05, [0.3, -0.8], [0.4, 0.2], 200, 1e-11);
}

#[test]
fn kept_matrices_lead_where_newton_goes() {
    let q = std::array::from_fn(|i| (i as f64 * 0.7).sin());
    agree!(Chain { beta: 0.7, drag: 0.05 }, 0.05, q, [0.0; 6], 400, 1e-11);
    agree!(Spherical { g: 9.81, c: 0.1 }, 0.01, [1.1, 0.6, 0.2], [0.0, 0.3, 1.0], 200, 1e-11);
}

/// The control: a parameter off by one part in 10⁹ leads elsewhere.
#[test]
fn another_parameter_leads_elsewhere() {
    let (a, b) = (special::Ring { k: 0.01 }, general::Ring { k: 0.01 * (1.0 + 1e-7) });
    assert!(difference(&a, &b, Trapezoidal, 0.05, [0.0, 1.1], [0.5, 0.1], 400).0 > 1e-11);
    let (a, b) =
        (special::Chain { beta: 0.7, drag: 0.05 }, general::Chain { beta: 0.7 * (1.0 + 1e-9), drag: 0.05 });
    let q = std::array::from_fn(|i| (i as f64 * 0.7).sin());
    assert!(difference(&a, &b, Midpoint, 0.05, q, [0.0; 6], 400).0 > 1e-11);
}

/// What the paths are is known before a step is taken.
#[test]
fn paths_are_chosen_by_structure() {
    fn is_linear<L: Fused<R, N>, R, const N: usize>(_: &L, _: R) -> bool {
        L::LINEAR
    }
    let (oscillator, ring) = (special::Oscillator { m: 1.0, k: 1.0, r: 0.1 }, special::Ring { k: 0.1 });
    let (charge, chain) = (special::Charge { b: 1.0, c: 0.1 }, special::Chain { beta: 0.7, drag: 0.1 });
    assert!(is_linear(&oscillator, Midpoint) && is_linear(&oscillator, Trapezoidal));
    assert!(!is_linear(&ring, Midpoint) && is_linear(&ring, Trapezoidal));
    assert!(!is_linear(&charge, Midpoint) && is_linear(&charge, Trapezoidal));
    assert!(!is_linear(&chain, Midpoint) && is_linear(&chain, Trapezoidal));
    assert!(!is_linear(&general::Ring { k: 0.1 }, Trapezoidal));
    assert_eq!(special::Chain::STRUCTURE.newton_matrix("Midpoint").map(|matrix| matrix.bandwidth), Some(1));

    // One solve a step, each of them.
    let start = |q: [f64; 2]| State { q: q.into(), p: SVector::from([0.1, 0.2]) };
    assert_eq!(run(&ring, Trapezoidal, 0.05, start([0.0, 1.0]), 50).1, 1);
    assert_eq!(run(&charge, Trapezoidal, 0.05, start([0.0, 1.0]), 50).1, 1);
    let start = State { q: [0.7].into(), p: [0.3].into() };
    assert_eq!(run(&oscillator, Midpoint, 0.05, start, 50).1, 1);
    assert_eq!(run(&oscillator, Trapezoidal, 0.05, start, 50).1, 1);
}

/// A memory of another state or step size leads nowhere else.
#[test]
fn memories_follow_the_state_and_the_step_size() {
    fn check<L, R, const N: usize>(system: &L, states: [State<f64, N>; 2])
    where
        L: Discrete<R, N, Scalar = f64>,
    {
        let mut memory = L::RunMemory::default();
        for (state, h) in [(0, 0.05), (0, 0.05), (1, 0.05), (1, 0.02), (0, 0.02), (0, -0.05), (1, 0.05)] {
            for _ in 0..3 {
                let remembered = memory.advance(system, &states[state], h).unwrap();
                let fresh = L::RunMemory::default().advance(system, &states[state], h).unwrap();
                let general = VelocityHistory::default().advance(system, &states[state], h).unwrap();
                for other in [fresh, general] {
                    let change = remembered.state.q - other.state.q;
                    assert!(change.amax() < 1e-14, "{change}");
                    assert!((remembered.state.p - other.state.p).amax() < 1e-13);
                }
            }
        }
    }
    let states = [[0.3, -0.8], [1.1, 0.2]].map(|q| State { q: q.into(), p: [0.4, -0.1].into() });
    check::<_, Trapezoidal, 2>(&special::Ring { k: 0.1 }, states);
    check::<_, Trapezoidal, 2>(&special::Charge { b: 1.0, c: 0.1 }, states);
    let states = [0.3, 0.9]
        .map(|scale| State { q: SVector::from_fn(|i, _| scale * (i as f64).cos()), p: [0.1; 6].into() });
    check::<_, Midpoint, 6>(&special::Chain { beta: 0.7, drag: 0.1 }, states);
    check::<_, Trapezoidal, 6>(&special::Chain { beta: 0.7, drag: 0.1 }, states);
}

/// Where the corrections do not shrink, Newton's method takes the step: a chain so stiff that the matrix of
/// one step is none for the next.
#[test]
fn newton_takes_over_where_a_kept_matrix_is_far_off() {
    let (a, b) = (special::Chain { beta: 500.0, drag: 0.05 }, general::Chain { beta: 500.0, drag: 0.05 });
    let q = std::array::from_fn(|i| (i as f64 * 1.3).sin());
    let (difference, most) = difference(&a, &b, Midpoint, 0.1, q, [0.0; 6], 12);
    assert!(difference < 1e-8 && most > 3, "{difference:e}, {most} iterations");
}

/// Every path names what is wrong, and leaves the state alone.
#[test]
fn errors_are_those_of_the_general_step() {
    fn check<L, R, const N: usize>(system: &L, q: [f64; N], p: [f64; N])
    where
        L: Discrete<R, N, Scalar = f64>,
    {
        let good = State { q: SVector::from(q), p: SVector::from(p) };
        let with = |of_q: bool, value: f64| {
            let mut state = good;
            if of_q {
                state.q[0] = value
            } else {
                state.p[N - 1] = value
            }
            state
        };
        // Without a memory, and with one that has settled.
        for settled in [0, 8] {
            let mut memory = L::RunMemory::default();
            let mut state = good;
            for _ in 0..settled {
                state = memory.advance(system, &state, 0.05).unwrap().state;
            }
            for h in [0.0, f64::NAN, f64::INFINITY] {
                let error = memory.advance(system, &state, h).unwrap_err();
                assert!(matches!(error, StepError::StepSize { .. }), "{error:?}");
            }
            for value in [f64::NAN, f64::INFINITY] {
                let of_q = StepError::NonFinite { quantity: Quantity::Configuration, index: 0 };
                assert_eq!(memory.advance(system, &with(true, value), 0.05), Err(of_q));
                let of_p = StepError::NonFinite { quantity: Quantity::Momentum, index: N - 1 };
                assert_eq!(memory.advance(system, &with(false, value), 0.05), Err(of_p));
            }
            assert!(memory.advance(system, &state, 0.05).is_ok());
        }
    }
    let q = std::array::from_fn(|i| (i as f64 * 0.7).sin());
    check::<_, Midpoint, 1>(&special::Oscillator { m: 1.0, k: 2.0, r: 0.1 }, [0.3], [0.2]);
    check::<_, Trapezoidal, 1>(&special::Oscillator { m: 1.0, k: 2.0, r: 0.1 }, [0.3], [0.2]);
    check::<_, Trapezoidal, 2>(&special::Ring { k: 0.1 }, [0.3, 0.4], [0.2, 0.1]);
    check::<_, Trapezoidal, 2>(&special::Charge { b: 1.0, c: 0.1 }, [0.3, 0.4], [0.2, 0.1]);
    check::<_, Trapezoidal, 3>(
        &special::Coupled { m: 1.0, c: 0.1, wind: 0.1 },
        [0.3, 0.4, 0.1],
        [0.2, 0.1, 0.0],
    );
    check::<_, Midpoint, 6>(&special::Chain { beta: 0.7, drag: 0.1 }, q, [0.1; 6]);
    check::<_, Midpoint, 3>(&special::Spherical { g: 9.81, c: 0.1 }, [1.1, 0.6, 0.2], [0.0, 0.3, 1.0]);
}

/// The root's domain ends at q = 1.
#[rayleigh_system(rule = [midpoint, trapezoidal], derivatives = expanded)]
fn edge(q: [f64; 2], v: [f64; 2], m: f64, c: f64) -> (f64, f64) {
    let kinetic = 0.5 * m * v[0] * v[0] + 0.5 * v[1] * v[1];
    (kinetic - (1.0 - q[0]).sqrt(), 0.5 * c * v[0] * v[0])
}

#[test]
fn a_force_that_is_no_number_has_a_name() {
    let edge = Edge { m: 1.0, c: 0.0 };
    let mut memory = <Edge as Fused<Trapezoidal, 2>>::Memory::default();
    let mut state = State { q: SVector::from([0.9, 0.0]), p: [0.5, 0.0].into() };
    let error = (0..1000).find_map(|_| {
        match Memory::<_, Trapezoidal, 2>::advance(&mut memory, &edge, &state, 0.02) {
            Ok(step) => state = step.state,
            Err(error) => return Some(error),
        }
        None
    });
    let error = error.expect("the edge is reached");
    assert!(matches!(error, StepError::NoDerivative { place: Some(_), .. }), "{error:?}");
    assert!(state.q[0] < 1.0 && state.q[0] > 0.95 && state.p[0].is_finite(), "{state:?}");
}

#[test]
fn singular_matrices_have_names() {
    // No mass, no damping: momenta do not determine velocities.
    let state = State { q: SVector::from([0.5, 0.0]), p: [0.5, 0.0].into() };
    let massless = Edge { m: 0.0, c: 0.0 };
    let mut memory = <Edge as Fused<Trapezoidal, 2>>::Memory::default();
    let error = Memory::<_, Trapezoidal, 2>::advance(&mut memory, &massless, &state, 0.1).unwrap_err();
    assert_eq!(error, StepError::DegenerateLagrangian { column: 0 });
    // Damping makes the step's matrix regular; the Lagrangian stays degenerate.
    let damped = Edge { m: 0.0, c: 1.0 };
    let error = Memory::<_, Trapezoidal, 2>::advance(&mut memory, &damped, &state, 0.1).unwrap_err();
    assert_eq!(error, StepError::DegenerateLagrangian { column: 0 });
    // Mass and negative damping that cancel at one step size: m + hc/2 = 0.
    let cancelling = Edge { m: 1.0, c: -4.0 };
    let error = Memory::<_, Trapezoidal, 2>::advance(&mut memory, &cancelling, &state, 0.5).unwrap_err();
    assert!(matches!(error, StepError::SingularNewtonMatrix { column: 0, .. }), "{error:?}");
    // The control: at another one it can be stepped, and then the singular one is still named.
    assert!(Memory::<_, Trapezoidal, 2>::advance(&mut memory, &cancelling, &state, 0.1).is_ok());
    let error = Memory::<_, Trapezoidal, 2>::advance(&mut memory, &cancelling, &state, 0.5).unwrap_err();
    assert!(matches!(error, StepError::SingularNewtonMatrix { column: 0, .. }), "{error:?}");
}
