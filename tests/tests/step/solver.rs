//! The solver of a step: every error reached on purpose, and the roots that it must find.

use dalembert::nalgebra::{SMatrix, SVector, vector};
use dalembert::run::VelocityHistory;
use dalembert::step::{Fused, Momenta, Quantity, Segment, StepKernel};
use dalembert::system::{ActingForce, Derivatives, Function};
use dalembert::{Discrete, Discretise, Lagrangian, Midpoint, State, StepError, Trapezoidal, rayleigh_system};
use dalembert_tests::systems::{Bead, DoublePendulum, Pendulum};

fn midpoint<S, const N: usize>(
    system: &S,
    q: [f64; N],
    p: [f64; N],
    h: f64,
) -> Result<dalembert::step::Step<f64, N>, StepError>
where
    S: Discrete<Midpoint, N, Scalar = f64>,
{
    system.by(Midpoint, h).step(&State { q: q.into(), p: p.into() })
}

mod refuses {
    use super::*;

    #[test]
    fn a_step_size_that_is_zero_or_not_finite() {
        for h in [0.0, -0.0, f64::INFINITY, f64::NEG_INFINITY] {
            let error = StepError::StepSize { h };
            assert_eq!(midpoint(&Bead::EXAMPLE, [0.1], [0.2], h).unwrap_err(), error);
            let (q0, q1) = (vector![0.1], vector![0.2]);
            let configurations = Bead::EXAMPLE.by(Midpoint, h).step_configurations(&q0, &q1);
            assert_eq!(configurations.unwrap_err(), error);
        }
        let error = midpoint(&Bead::EXAMPLE, [0.1], [0.2], f64::NAN).unwrap_err();
        assert!(matches!(error, StepError::StepSize { h } if h.is_nan()));
        assert!(error.to_string().contains("step size NaN is zero or not finite"), "{error}");
    }

    #[test]
    fn a_state_or_guess_that_is_not_finite_and_says_where() {
        let system = DoublePendulum::EXAMPLE;
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for index in 0..2 {
                let mut broken = [0.1, 0.2];
                broken[index] = bad;
                let non_finite = |quantity| StepError::NonFinite { quantity, index };
                let fine = [0.3, 0.4];
                assert_eq!(
                    midpoint(&system, broken, fine, 0.1).unwrap_err(),
                    non_finite(Quantity::Configuration)
                );
                assert_eq!(midpoint(&system, fine, broken, 0.1).unwrap_err(), non_finite(Quantity::Momentum));
                let state = State { q: fine.into(), p: fine.into() };
                let step = system.by(Midpoint, 0.1).near(&broken.into()).step(&state);
                assert_eq!(step.unwrap_err(), non_finite(Quantity::Velocity));
                for (q0, q1) in [(broken, fine), (fine, broken)] {
                    let step = system.by(Midpoint, 0.1).step_configurations(&q0.into(), &q1.into());
                    assert_eq!(step.unwrap_err(), non_finite(Quantity::Configuration));
                }
                let made = |q: [f64; 2], v: [f64; 2]| State::from_velocity(&system, q, v);
                assert_eq!(made(broken, fine), Err(non_finite(Quantity::Configuration)));
                assert_eq!(made(fine, broken), Err(non_finite(Quantity::Velocity)));
                let velocity =
                    |q: [f64; 2], p: [f64; 2]| State { q: q.into(), p: p.into() }.velocity(&system);
                assert_eq!(velocity(broken, fine), Err(non_finite(Quantity::Configuration)));
                assert_eq!(velocity(fine, broken), Err(non_finite(Quantity::Momentum)));
            }
        }
    }

    #[test]
    fn a_result_that_overflows() {
        // q̄ = 1.6e308 is a number, q1 = 2.2e308 is not.
        let error = midpoint(&FREE, [1e308], [0.7 * 1.2e308], 1.0).unwrap_err();
        assert_eq!(error, StepError::Overflow { quantity: Quantity::Configuration, index: 0 });
        // Neither is.
        let error = midpoint(&FREE, [1.7e308], [1e308], 1.0).unwrap_err();
        assert!(matches!(error, StepError::NonFinite { index: 0, .. }), "{error:?}");
    }
}

/// A free mass.
const FREE: Oscillator = Oscillator { m: 0.7, k: 0.0, r: 0.0 };

#[rayleigh_system]
fn oscillator(q: [f64; 1], v: [f64; 1], m: f64, k: f64, r: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
}

/// ½v² + (1 − q)^a: not defined for q > 1. Slope at the wall: 0 for a > 1, infinite for a < 1.
#[rayleigh_system]
fn wall(q: [f64; 1], v: [f64; 1], strength: f64, a: f64) -> f64 {
    0.5 * v[0] * v[0] + strength * (1.0 - q[0]).powf(a)
}

mod at_the_edge_of_the_domain {
    use super::*;

    fn assert_named(error: StepError) {
        let is_named =
            matches!(error, StepError::NoDerivative { function: Function::Lagrangian, place: Some(_), .. });
        assert!(is_named && error.to_string().contains("(1.0 - q[0]).powf(a)"), "{error}");
    }

    #[test]
    fn a_state_outside_is_non_finite_and_not_degenerate() {
        let system = Wall { strength: 1.0, a: 1.5 };
        assert_named(midpoint(&system, [1.5], [0.1], 0.1).unwrap_err());
        let state = State { q: vector![1.5], p: vector![0.1] };
        let guessed = system.by(Midpoint, 0.1).near(&vector![0.0]).step(&state);
        assert_named(guessed.unwrap_err());
        // The Legendre transform asks for ∂L/∂v = v alone, which q does not enter.
        assert_eq!(state.velocity(&system), Ok(vector![0.1]));
        assert_eq!(State::from_velocity(&system, [1.5], [0.1]), Ok(state));
    }

    /// Moving fast through the wall, where the gradient goes to 0: nothing inside solves the step.
    #[test]
    fn a_root_outside_is_non_finite() {
        let system = Wall { strength: 1.0, a: 2.5 };
        assert_named(midpoint(&system, [0.5], [10.0], 1.0).unwrap_err());
        // Positive control: a shorter step stays inside.
        midpoint(&system, [0.5], [10.0], 0.05).unwrap();
    }

    /// A wall that repels, −(1 − q)^½ with an infinite slope: the full Newton step from rest leaves the
    /// domain, a root exists inside.
    #[test]
    fn a_root_inside_is_found_though_newton_steps_leave_the_domain() {
        let (h, p) = (0.5, 30.0);
        let step = midpoint(&Wall { strength: 1.0, a: 0.5 }, [0.9], [p], h).unwrap();
        assert!(step.report.damped > 0, "{:?}", step.report);
        // p = v + (h/4)(1 − q̄)^(−½) with q̄ = q0 + hv/2
        let v = step.velocity[0];
        let q = 0.9 + 0.5 * h * v;
        assert!(q < 1.0);
        // Close to the wall 1 − q̄ carries few digits, and the slope magnifies them.
        let sensitivity = h / 8.0 * (1.0 - q).powf(-1.5) * f64::EPSILON;
        assert!((v + 0.25 * h / (1.0 - q).sqrt() - p).abs() < 8.0 * sensitivity + 1e-13, "{v}");
    }
}

/// V = −½kq² turns over at h = 2√(m/k): the Newton matrix m − h²k/4 is 0.
#[test]
fn a_singular_newton_matrix() {
    let system = Oscillator { m: 1.0, k: -1.0, r: 0.0 };
    let error = midpoint(&system, [0.5], [1.0], 2.0).unwrap_err();
    assert_eq!(error, StepError::SingularNewtonMatrix { iteration: 0, column: 0 });
    assert!(error.to_string().contains("Newton matrix singular at iteration 0"), "{error}");
    midpoint(&system, [0.5], [1.0], 1.999).unwrap();
    midpoint(&system, [0.5], [1.0], 2.001).unwrap();
}

/// Cubic drag R = r v³/3, one step from d = q1 − q0: with x = rd/m the next displacement d′ solves
/// (r/2m) d′² + d′ = d − (r/2m) d², which is real iff 1 − √2 ≤ x ≤ 1 + √2.
mod cubic_drag {
    use super::*;

    #[rayleigh_system]
    fn cubic(q: [f64; 1], v: [f64; 1], m: f64, r: f64) -> (f64, f64) {
        (0.5 * m * v[0] * v[0] - 0.0 * q[0], r * v[0].powi(3) / 3.0)
    }

    const SYSTEM: Cubic = Cubic { m: 1.3, r: 0.6 };
    const H: f64 = 0.4;

    fn after(x: f64) -> Result<dalembert::step::Step<f64, 1>, StepError> {
        let d = x * SYSTEM.m / SYSTEM.r;
        SYSTEM.by(Midpoint, H).step_configurations(&vector![0.0], &vector![d])
    }

    #[test]
    fn has_a_real_step_within_its_fold_and_none_beyond() {
        let (low, high) = (1.0 - 2.0_f64.sqrt(), 1.0 + 2.0_f64.sqrt());
        for inside in
            [low + 1e-9, low + 1e-3, -0.2, -1e-6, 0.0, 0.3, 1.0, 1.999, 2.001, high - 1e-3, high - 1e-9]
        {
            let step = after(inside).unwrap_or_else(|error| panic!("{inside}: {error}"));
            let x = SYSTEM.r / SYSTEM.m * H * step.velocity[0];
            // The root that goes to 0 with the step: the other one is the numerical branch. Rounding ε of the
            // square becomes ε/√ of its root near the fold.
            let root = (1.0 + 2.0 * inside - inside * inside).sqrt();
            let expected = root - 1.0;
            assert!((x - expected).abs() <= 1e-14 + 4e-15 / root, "{inside}: {x} {expected}");
            assert_eq!(x < 0.0, !(0.0..=2.0).contains(&inside), "turns back when rd > 2m");
        }
        for outside in [low - 1e-9, low - 1e-3, -1.0, -1e3, high + 1e-9, high + 1e-3, 4.0, 1e3] {
            let error = after(outside).unwrap_err();
            assert!(matches!(error, StepError::NoRealSolution { .. }), "{outside}: {error:?}");
            let text = error.to_string();
            assert!(
                text.contains("no real solution in reach") && text.contains("try a smaller step"),
                "{text}"
            );
        }
    }

    #[test]
    fn leaves_the_state_and_passes_with_a_smaller_step() {
        let start = State { q: vector![0.2], p: vector![-4.0] };
        let state = start;
        assert!(SYSTEM.by(Midpoint, H).step(&state).is_err_and(|error| matches!(
            error,
            StepError::NoRealSolution { residual, .. } if residual > 0.1
        )));
        assert_eq!(state, start);
        let mut h = H;
        while SYSTEM.by(Midpoint, h).step(&state).is_err() {
            h *= 0.5;
        }
        // Real iff m² + 2hrp ≥ 0.
        assert!(h <= 1.69 / (2.0 * 0.6 * 4.0) && 2.0 * h > 1.69 / (2.0 * 0.6 * 4.0), "{h}");
    }

    /// Drag on several coordinates: one fold among them is found as well.
    #[rayleigh_system]
    fn cubic_plane(q: [f64; 2], v: [f64; 2], r: f64) -> (f64, f64) {
        let kinetic = 0.5 * (v[0] * v[0] + 2.0 * v[1] * v[1] + v[0] * v[1]);
        (kinetic - 0.1 * q[0] * q[1], r * (v[0].powi(3) + v[1].powi(3)) / 3.0)
    }

    #[test]
    fn of_two_coordinates() {
        let error = midpoint(&CubicPlane { r: 1.0 }, [0.1, 0.2], [0.3, -9.0], 1.0).unwrap_err();
        assert!(matches!(error, StepError::NoRealSolution { .. }), "{error:?}");
        midpoint(&CubicPlane { r: 1.0 }, [0.1, 0.2], [0.3, -9.0], 0.05).unwrap();
    }
}

/// A kinetic energy whose momentum is v⁹: at p = 0 a ninefold root, to which Newton's method converges
/// linearly.
#[rayleigh_system]
fn flat(q: [f64; 1], v: [f64; 1]) -> f64 {
    v[0].powi(10) / 10.0 - 0.0 * q[0]
}

#[test]
fn not_converged() {
    let state = State { q: vector![0.0], p: vector![0.0] };
    let error = Flat.by(Midpoint, 0.1).near(&vector![1.0]).step(&state).unwrap_err();
    let StepError::NotConverged { iterations, residual, floor } = error else { panic!("{error:?}") };
    // Each iteration multiplies v by 8/9.
    let expected = (8.0_f64 / 9.0).powi(9 * 100);
    assert_eq!(iterations, 100);
    assert!((residual / expected - 1.0).abs() < 1e-10 && floor < residual, "{error:?}");
    assert!(error.to_string().contains("not converged after 100 iterations"), "{error}");
}

/// A mass whose momentum comes out of a table with steps of 1e-9, everywhere or at v = ½ alone: digits are
/// lost where no rounding of q or v shows it.
struct Quantised {
    is_everywhere: bool,
}

const STEP: f64 = 1e-9;

impl Lagrangian<1> for Quantised {
    type Scalar = f64;

    fn lagrangian(&self, _: &SVector<f64, 1>, v: &SVector<f64, 1>) -> f64 {
        0.5 * v[0] * v[0]
    }

    fn lagrangian_derivatives(&self, q: &SVector<f64, 1>, v: &SVector<f64, 1>) -> Derivatives<f64, 1> {
        let second = SMatrix::zeros();
        Derivatives {
            value: self.lagrangian(q, v),
            d1: SVector::zeros(),
            d2: vector![match self.is_everywhere {
                true => (v[0] / STEP).round() * STEP,
                false => v[0] + 0.3_f64.copysign(v[0] - 0.5) * STEP,
            }],
            d11: second,
            d12: second,
            d22: SMatrix::identity(),
        }
    }
}

impl ActingForce<1> for Quantised {}

impl Fused<Midpoint, 1> for Quantised {
    type Matrix = SMatrix<f64, 1, 1>;
    type Memory = VelocityHistory<f64, 1>;
    type Border = dalembert::step::Free;

    fn step_kernel(&self, segment: &Segment<f64, 1>) -> StepKernel<f64, 1> {
        let l = self.lagrangian_derivatives(&segment.q0, &segment.v);
        StepKernel { p0: l.d2, matrix: l.d22 }
    }

    fn momenta(&self, segment: &Segment<f64, 1>) -> Momenta<f64, 1> {
        let p = self.lagrangian_derivatives(&segment.q0, &segment.v).d2;
        Momenta { p0: p, p1: p }
    }
}

#[test]
fn lost_precision() {
    let error = midpoint(&Quantised { is_everywhere: false }, [0.0], [0.5], 0.1).unwrap_err();
    let StepError::LostPrecision { residual, floor } = error else { panic!("{error:?}") };
    // Left of the jump, or right of it.
    let is_near = |steps: f64| (residual / STEP - steps).abs() < 1e-6;
    assert!((is_near(0.3) || is_near(0.6)) && floor < 1e-14, "{error:?}");
    assert!(error.to_string().contains("digits cancel"), "{error}");
    // Positive control: beside the jump there is a root.
    midpoint(&Quantised { is_everywhere: false }, [0.0], [0.5 + STEP], 0.1).unwrap();
}

/// Steps everywhere are the noise of the function: it is solved as far as it tells, and the report says how
/// far.
#[test]
fn a_momentum_with_noise_is_solved_to_that() {
    let noisy = Quantised { is_everywhere: true };
    let step = midpoint(&noisy, [0.0], [0.5 + 0.3 * STEP], 0.1).unwrap();
    // On either side of the step that the momentum lies in.
    let is_near = |steps: f64| (step.report.residual / STEP - steps).abs() < 1e-6;
    assert!(is_near(0.3) || is_near(0.7), "{:?}", step.report);
    assert!((0.1 * STEP..100.0 * STEP).contains(&step.report.floor), "{:?}", step.report);
    // A momentum that the table holds is reached.
    let step = midpoint(&noisy, [0.0], [0.5], 0.1).unwrap();
    assert!(step.report.residual < 1e-15, "{:?}", step.report);
}

mod finds {
    use super::*;

    /// Momentum v + v³ (with mass 1), sinh v, v/√(1 + v²): steep, steeper, and flat far out.
    #[rayleigh_system]
    fn steep(q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] + 0.25 * v[0].powi(4) - 0.0 * q[0]
    }

    #[rayleigh_system]
    fn steeper(q: [f64; 1], v: [f64; 1]) -> f64 {
        v[0].cosh() - 0.0 * q[0]
    }

    #[rayleigh_system]
    fn saturating(q: [f64; 1], v: [f64; 1]) -> f64 {
        (1.0 + v[0] * v[0]).sqrt() - 0.0 * q[0]
    }

    fn velocity<S: Discrete<Midpoint, 1, Scalar = f64>>(system: &S, p: f64, guess: f64) -> f64 {
        let state = State { q: vector![0.0], p: vector![p] };
        let step = system.step(&state, 0.1, Some(&vector![guess]));
        step.unwrap_or_else(|error| panic!("p = {p:e} from {guess:e}: {error}")).velocity[0]
    }

    #[test]
    fn a_root_far_from_the_guess() {
        for p in [1e-3, 1.0, 1e6, 1e12] {
            for guess in [0.0, 1.0, -1.0, 1e3, -1e3, 1e8] {
                let v = velocity(&Steep, p, guess);
                assert!(((v + v * v * v) / p - 1.0).abs() < 1e-14, "{p:e} {guess:e} {v}");
            }
            for guess in [0.0, 1.0, -1.0, 20.0, -20.0] {
                let v = velocity(&Steeper, p, guess);
                // sinh multiplies the error of v by cosh v / sinh v · v.
                assert!((v - p.asinh()).abs() < 1e-14 * (1.0 + v), "{p:e} {guess:e} {v}");
            }
        }
        for p in [0.0, 0.1, 0.9, -0.99] {
            for guess in [0.0, 1.0, -2.0, 5.0] {
                let v = velocity(&Saturating, p, guess);
                let expected = p / ((1.0 - p) * (1.0 + p)).sqrt();
                // v moves by (1 + v²)^{3/2} for a unit of p.
                let tolerance = 1e-15 * (1.0 + expected * expected).powf(1.5);
                assert!((v - expected).abs() < tolerance, "{p} {guess} {v} {expected}");
            }
        }
    }

    /// Positive control: from 5 the full Newton step for p = 0 leads to v = −5³, further away.
    #[test]
    fn a_root_by_damping() {
        let state = State { q: vector![0.0], p: vector![0.0] };
        let step = Saturating.by(Midpoint, 0.1).near(&vector![5.0]).step(&state).unwrap();
        assert!(step.report.damped > 0, "{:?}", step.report);
    }

    /// No velocity has p = 1.1.
    #[test]
    fn no_root_where_there_is_none() {
        let error = midpoint(&Saturating, [0.0], [1.1], 0.1).unwrap_err();
        assert!(matches!(error, StepError::NoVelocity { .. }), "{error:?}");
    }

    /// The double pendulum in units of 1e-12 and 1e12: the same motion, coordinate by coordinate.
    struct Scaled {
        plain: [f64; 2],
    }

    #[rayleigh_system]
    impl Scaled {
        fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
            let [a, b] = self.plain;
            let (x, y, u, w) = (q[0] * a, q[1] * b, v[0] * a, v[1] * b);
            0.5 * (1.9 * u * u + 0.7 * w * w) + 0.6 * u * w * (x - y).cos() + 3.9 * x.cos() + 1.5 * y.cos()
        }

        fn rayleigh(&self, v: [f64; 2]) -> f64 {
            let (u, w) = (v[0] * self.plain[0], v[1] * self.plain[1]);
            0.1 * u * u + 0.05 * (w - u).powi(2)
        }
    }

    #[test]
    fn its_roots_in_badly_scaled_coordinates() {
        let (plain, scaled) = (Scaled { plain: [1.0, 1.0] }, Scaled { plain: [1e12, 1e-12] });
        let start = State::from_velocity(&plain, [1.1, -0.6], [0.3, 1.2]).unwrap();
        let in_units = |s: &State<f64, 2>| State {
            q: vector![s.q[0] / scaled.plain[0], s.q[1] / scaled.plain[1]],
            p: vector![s.p[0] * scaled.plain[0], s.p[1] * scaled.plain[1]],
        };
        let a = plain.by(Midpoint, 0.1).run(start);
        let b = scaled.by(Midpoint, 0.1).run(in_units(&start));
        for (a, b) in a.zip(b).take(200) {
            let (a, b) = (a.unwrap(), b.unwrap());
            let expected = in_units(&a.state);
            for i in 0..2 {
                assert!((b.state.q[i] - expected.q[i]).abs() < 1e-11 / scaled.plain[i]);
                assert!((b.state.p[i] - expected.p[i]).abs() < 1e-11 * scaled.plain[i]);
            }
            assert!(b.report.residual <= 4.0 * b.report.floor, "{:?}", b.report);
            assert!(b.report.iterations <= a.report.iterations + 2, "{:?} {:?}", a.report, b.report);
        }
    }

    #[test]
    fn a_step_of_any_size() {
        let system = Pendulum::EXAMPLE;
        let Pendulum { m, l, g, r } = system;
        let (q, v) = (0.9_f64, 0.4);
        let start = State::from_velocity(&system, [q], [v]).unwrap();
        let acceleration = -g / l * q.sin() - r / (m * l * l) * v;
        for exponent in -300..=0 {
            let h = 10.0_f64.powi(exponent);
            for h in [h, -h] {
                let step = system.by(Midpoint, h).step(&start).unwrap();
                let p_rate = m * l * l * acceleration;
                let tolerance = 2.0 * f64::EPSILON + 10.0 * h * h;
                assert!((step.state.q[0] - (q + h * v)).abs() <= tolerance, "{h:e}");
                assert!((step.state.p[0] - (start.p[0] + h * p_rate)).abs() <= 4.0 * tolerance, "{h:e}");
            }
        }
    }

    /// The oscillator's equation is linear: solvable for every h, in one iteration.
    #[test]
    fn a_step_of_any_size_where_the_equation_is_linear() {
        let system = Oscillator { m: 1.3, k: 0.7, r: 0.4 };
        for exponent in -150..=150 {
            let h = 10.0_f64.powi(exponent);
            let step = midpoint(&system, [0.9], [0.4], h).unwrap();
            assert!(step.report.iterations <= 2, "{h:e}: {:?}", step.report);
            // For h → ∞ the midpoint rule reflects: q1 = −q0.
            if exponent > 20 {
                assert!((step.state.q[0] + 0.9).abs() < 1e-15, "{h:e}");
            }
        }
    }

    /// A large step of a nonlinear system: a root, or an error; never a wrong answer.
    #[test]
    fn a_root_or_an_error_for_large_steps() {
        let mut solved = 0;
        for h in [1.0, 2.0, 5.0, 10.0, 100.0, 1e4, 1e8] {
            for (q, p) in [(0.9, 0.4), (3.0, -2.0), (-2.0, 7.0)] {
                if let Ok(step) = midpoint(&Pendulum::EXAMPLE, [q], [p], h) {
                    solved += 1;
                    let Pendulum { m, l, g, r } = Pendulum::EXAMPLE;
                    let v = step.velocity[0];
                    let terms =
                        [m * l * l * v, 0.5 * h * m * g * l * (q + 0.5 * h * v).sin(), 0.5 * h * r * v];
                    // The sine is known to ε times the angle.
                    let angle = q.abs() + (0.5 * h * v).abs();
                    let size = p.abs() + terms[0].abs() + terms[2].abs() + 0.5 * h * m * g * l * angle;
                    assert!((terms.iter().sum::<f64>() - p).abs() <= 1e-15 * size, "{h} {q} {p} {v}");
                }
            }
        }
        assert!(solved >= 12, "{solved}");
    }
}

/// Motions that end: v and p go to 0 while forces away from q = 0 cancel, or everything goes to 0 together.
mod comes_to_rest {
    use super::*;

    /// Two masses on nonlinear springs, whose equilibrium is nowhere near 0 and not a machine number.
    #[rayleigh_system(rule = [midpoint, trapezoidal])]
    fn springs(q: [f64; 2], v: [f64; 2], k: f64, offset: f64, r: f64) -> (f64, f64) {
        let (x, y) = (q[0] - offset, q[1] - q[0] - 2.0 * offset);
        let potential = 0.5 * k * (x * x + y * y) + 0.25 * k * (x * x * x * x + y * y * y * y);
        let gravity = 0.9 * q[0] + 1.7 * q[1];
        (
            0.5 * (1.3 * v[0] * v[0] + 0.6 * v[1] * v[1]) - potential - gravity,
            0.5 * r * (v[0] * v[0] + v[1] * v[1]),
        )
    }

    fn residual_force(system: &Springs, q: &SVector<f64, 2>) -> f64 {
        system.lagrangian_gradient(q, &SVector::zeros()).d1.amax()
    }

    fn rest<R: Copy>(rule: R, system: &Springs, h: f64)
    where
        Springs: Discrete<R, 2, Scalar = f64>,
    {
        let start =
            State { q: vector![system.offset + 0.3, 3.0 * system.offset - 0.2], p: vector![0.3, -0.2] };
        let mut trajectory = system.by(rule, h).run(start);
        let mut most = 0;
        let steps = 5_000;
        for step in 0..steps {
            let taken = trajectory.next().unwrap();
            let report =
                taken.unwrap_or_else(|error| panic!("{system:?} h = {h}, step {step}: {error:?}")).report;
            most = most.max(report.iterations);
            assert!(report.residual <= 4.0 * report.floor, "{report:?}");
        }
        let state = trajectory.state();
        let force = residual_force(system, &state.q);
        // Positions are known to ε|q|, so that forces are to kε|q|.
        let tolerance = 50.0 * system.k * f64::EPSILON * (1.0 + state.q.amax());
        assert!(
            force <= tolerance && state.p.amax() <= tolerance * (1.0 + h),
            "{system:?} {h}: {force:e} {state:?}"
        );
        assert!(residual_force(system, &start.q) > 0.1, "it started elsewhere");
        assert!(most <= 30, "{most} iterations");
    }

    #[test]
    fn away_from_zero() {
        for offset in [0.1_f64.sqrt(), 17.3, 1234.567] {
            for k in [1.0, 40.0] {
                for h in [0.02, 0.1] {
                    let system = Springs { k, offset, r: 3.0 };
                    rest(Midpoint, &system, h);
                    rest(Trapezoidal, &system, h);
                }
            }
        }
    }

    /// A pendulum far from the origin of its angle, a rigid body that has turned many times.
    #[test]
    fn after_many_turns() {
        let system = Pendulum { m: 1.7, l: 0.8, g: 3.1, r: 2.0 };
        let steps = if cfg!(debug_assertions) { 5_000 } else { 20_000 };
        for turns in [1.0, 1e3, 1e6] {
            let q = std::f64::consts::TAU * turns + 0.5;
            let start = State { q: vector![q], p: vector![0.2] };
            for h in [0.01, 0.1, 0.5] {
                let midpoint = system.by(Midpoint, h).run(start).take(steps);
                let trapezoidal = system.by(Trapezoidal, h).run(start).take(steps);
                for (step, taken) in midpoint.enumerate().chain(trapezoidal.enumerate()) {
                    if let Err(error) = taken {
                        panic!("{turns} turns, h = {h}, step {step}: {error:?}");
                    }
                }
            }
        }
    }

    /// A damped free mass slows down by the same factor each step, through the subnormal numbers down to 0.
    #[test]
    fn down_to_the_smallest_numbers() {
        let system = Oscillator { m: 1.3, k: 0.0, r: 0.9 };
        let mut trajectory = system.by(Midpoint, 0.5).run(State { q: vector![0.0], p: vector![1.0] });
        for step in 0..5_000 {
            let taken = trajectory.next().unwrap();
            taken.unwrap_or_else(|error| panic!("step {step}: {error:?}"));
        }
        assert!(trajectory.state().p[0].abs() < f64::MIN_POSITIVE);
    }

    /// The same with a spring: both q and p decay.
    #[test]
    fn down_to_the_smallest_numbers_on_a_spring() {
        let system = Oscillator { m: 1.3, k: 2.0, r: 0.9 };
        let mut trajectory = system.by(Midpoint, 0.5).run(State { q: vector![0.4], p: vector![1.0] });
        for step in 0..10_000 {
            let taken = trajectory.next().unwrap();
            taken.unwrap_or_else(|error| panic!("step {step}: {error:?}"));
        }
        assert!(trajectory.state().p[0].abs() < f64::MIN_POSITIVE);
    }
}

/// What a report says is so: the residual is that of the step returned, in units of a floor that rounding
/// explains.
#[test]
fn reports_state_the_residual_of_the_solution() {
    let system = DoublePendulum::EXAMPLE;
    let start = State::from_velocity(&system, [1.1, -0.6], [0.3, 1.2]).unwrap();
    let mut state = start;
    for _ in 0..200 {
        let step = system.by(Midpoint, 0.1).step(&state).unwrap();
        let p0 =
            Fused::<Midpoint, 2>::momenta(&system, &Segment { q0: state.q, v: step.velocity, h: 0.1 }).p0;
        let residual = (p0 - state.p).abs();
        assert!(residual.iter().any(|r| *r == step.report.residual), "{residual} {:?}", step.report);
        assert!(step.report.residual <= 4.0 * step.report.floor, "{:?}", step.report);
        assert!(step.report.floor < 1e-13 && step.report.iterations <= 6, "{:?}", step.report);
        state = step.state;
    }
}

/// A force that jumps at q = 0.
#[rayleigh_system]
fn dented(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] - q[0].abs() - 0.5 * q[0].cos()
}

/// p0 = v̄ + (h/2)(sgn q̄ − ½ sin q̄) has no root where p0 lies within the jump, which is no noise.
#[test]
fn a_jump_of_the_force_is_not_taken_for_rounding() {
    let (q, h) = (-0.05, 0.1);
    let mut solved = [0; 2];
    for k in 0..200 {
        let p = 0.9 + 0.001 * (f64::from(k) + 0.5);
        let step = Dented {}.by(Midpoint, h).step(&State { q: vector![q], p: vector![p] });
        let is_within = (p - 1.0).abs() < 0.05;
        match step {
            Ok(step) => {
                let v = step.velocity[0];
                let middle = q + 0.5 * h * v;
                let left = v + 0.5 * h * (middle.signum() - 0.5 * middle.sin()) - p;
                assert!(left.abs() < 1e-15 && !is_within, "p = {p}: {left:e}");
                solved[usize::from(p > 1.0)] += 1;
            }
            Err(error) => {
                assert!(matches!(error, StepError::NoRealSolution { .. }) && is_within, "p = {p}: {error}")
            }
        }
    }
    assert_eq!(solved, [50, 50]);
}
