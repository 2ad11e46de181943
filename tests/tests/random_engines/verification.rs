//! Derivatives of another function than the one written are an error: where a state is made, where a run
//! starts, and, with `debug_assertions`, at every step.
//!
//! The control is a system whose values as generated are those written times 1 + `off`, function by function.

use dalembert::nalgebra::{Matrix1, SVector, Vector1, matrix, vector};
use dalembert::rules::DisplacementRule;
use dalembert::run::Explicit;
use dalembert::step::{Flow, Fused, Momenta, Segment, StepKernel};
use dalembert::system::verification;
use dalembert::system::{
    ActingForce, Compared, CovectorDerivatives, Derivatives, Engine, ForcedLagrangian, Function,
    GeneratedDiffers, Structure,
};
use dalembert::tolerance::{OffersMethods, ToleranceError, WithGauss};
use dalembert::{
    Composition, Discrete, Discretise, Fitted, FittedTrapezoidal, Force, Gauss, Lagrangian, Midpoint,
    Rayleigh, Splitting, State, StepError, Trajectory, Trapezoidal, rayleigh_system,
};

use super::Spread;

/// L = ½v² − ½q², R = ½ r v², f = −¼q, with wrong values of one of them beside the derivatives.
#[derive(Clone, Copy)]
struct Mutated {
    /// What the values as generated are off by, of L, R and f.
    off: [f64; 3],
    /// What the slopes are off by, of L, R and f.
    bent: [f64; 3],
    /// What second derivatives are off by, of L and R.
    curved: [f64; 2],
    /// What momenta are off by where they are computed at once: p0 of the equation, p0 and p1 of the step,
    /// and the force of the explicit one.
    fused: [f64; 4],
}

type Vector = Vector1<f64>;
type Matrix = Matrix1<f64>;

const DAMPING: f64 = 0.3;

impl Lagrangian<1> for Mutated {
    type Scalar = f64;
    const STRUCTURE: Structure = Structure::UNKNOWN.with_engine(Engine::Expanded);

    fn lagrangian(&self, q: &Vector, v: &Vector) -> f64 {
        0.5 * v[0] * v[0] - 0.5 * q[0] * q[0]
    }

    fn lagrangian_derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<f64, 1> {
        Derivatives {
            value: self.lagrangian(q, v) * (1.0 + self.off[0]),
            d1: -q * (1.0 + self.bent[0]),
            d2: *v,
            d11: matrix![-1.0 - self.curved[0]],
            d12: matrix![0.0],
            d22: matrix![1.0],
        }
    }

    fn verify_generated(&self, q: &Vector, v: &Vector) -> Result<(), GeneratedDiffers> {
        verification::lagrangian(self, q, v)?;
        verification::rayleigh(self, q, v)?;
        verification::force(self, q, v)
    }

    fn verify_slopes(&self, q: &Vector, v: &Vector) -> Result<(), GeneratedDiffers> {
        verification::lagrangian_slope(self, q, v)?;
        verification::rayleigh_slope(self, q, v)?;
        verification::force_slope(self, q, v)
    }
}

impl Rayleigh<1> for Mutated {
    fn rayleigh(&self, _: &Vector, v: &Vector) -> f64 {
        0.5 * DAMPING * v[0] * v[0]
    }

    fn rayleigh_derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<f64, 1> {
        Derivatives {
            value: self.rayleigh(q, v) * (1.0 + self.off[1]),
            d1: vector![0.0],
            d2: v * DAMPING * (1.0 + self.bent[1]),
            d11: matrix![0.0],
            d12: matrix![0.0],
            d22: matrix![DAMPING * (1.0 + self.curved[1])],
        }
    }
}

impl Force<1> for Mutated {
    fn force(&self, q: &Vector, _: &Vector) -> Vector {
        q * -0.25
    }

    fn force_derivatives(&self, q: &Vector, v: &Vector) -> CovectorDerivatives<f64, 1> {
        CovectorDerivatives {
            value: self.force(q, v) * (1.0 + self.off[2]),
            d1: matrix![-0.25 * (1.0 + self.bent[2])],
            d2: matrix![0.0],
        }
    }
}

impl ActingForce<1> for Mutated {
    const HAS_RAYLEIGH: bool = true;
    const HAS_FORCE: bool = true;

    fn general_force_derivatives(&self, q: &Vector, v: &Vector) -> CovectorDerivatives<f64, 1> {
        let value = self.force(q, v) - v * DAMPING;
        CovectorDerivatives { value, d1: matrix![-0.25], d2: matrix![-DAMPING] }
    }
}

impl ForcedLagrangian<1> for Mutated {
    type Anchors<const S: usize> = ();
}

macro_rules! discrete {
    ($($rule:ident $memory:ident),*) => {
        $(
            impl Fused<$rule, 1> for Mutated {
                type Matrix = Matrix;
                type Memory = dalembert::run::$memory<f64, Matrix, 1>;
                type Border = dalembert::step::Free;
                const WRITTEN_OUT: bool = true;

                fn step_kernel(&self, segment: &Segment<f64, 1>) -> StepKernel<f64, 1> {
                    let kernel = <$rule as DisplacementRule>::lagrangian_kernel(self, segment)
                        + <$rule as DisplacementRule>::rayleigh_kernel(self, segment)
                        + <$rule as DisplacementRule>::force_kernel(self, segment);
                    StepKernel { p0: kernel.p0 * (1.0 + self.fused[0]), ..kernel }
                }

                fn momenta(&self, segment: &Segment<f64, 1>) -> Momenta<f64, 1> {
                    let momenta = <$rule as DisplacementRule>::lagrangian_momenta(self, segment)
                        + <$rule as DisplacementRule>::rayleigh_momenta(self, segment)
                        + <$rule as DisplacementRule>::force_momenta(self, segment);
                    let [_, off_p0, off_p1, _] = self.fused;
                    Momenta { p0: momenta.p0 * (1.0 + off_p0), p1: momenta.p1 * (1.0 + off_p1) }
                }
            }
        )*
    };
}

discrete!(Midpoint KeptMatrix, Trapezoidal ExplicitMemory);

impl OffersMethods<1> for Mutated {
    type Methods = WithGauss<Trapezoidal>;
}

impl Explicit<1> for Mutated {
    fn step_matrix(&self, h: f64) -> Matrix {
        matrix![1.0 + 0.5 * h * DAMPING]
    }

    fn velocity_momenta(&self, v: &Vector, h: f64) -> Momenta<f64, 1> {
        let loss = v * (0.5 * h * DAMPING);
        Momenta { p0: v + loss, p1: v - loss }
    }

    fn configuration_force(&self, q: &Vector) -> Vector {
        q * (-1.25 * (1.0 + self.fused[3]))
    }
}

const RIGHT: Mutated = Mutated { off: [0.0; 3], bent: [0.0; 3], curved: [0.0; 2], fused: [0.0; 4] };

/// L, R or f wrong by one rounding.
fn wrong() -> [(Mutated, Function); 3] {
    let functions = [Function::Lagrangian, Function::Rayleigh, Function::Force { index: 0 }];
    std::array::from_fn(|i| {
        let mut off = [0.0; 3];
        off[i] = f64::EPSILON;
        (Mutated { off, ..RIGHT }, functions[i])
    })
}

/// The function that an error names, of one that was found.
fn named<T>(result: Result<T, StepError>) -> Option<Function> {
    match result {
        Err(StepError::GeneratedDiffers { function, .. }) => Some(function),
        _ => None,
    }
}

const START: State<f64, 1> = State { q: Vector::new(0.5), p: Vector::new(-0.25) };
const H: f64 = 0.1;

/// What finds a wrong value: the name of the place, and the function that its error names.
type Finding = (&'static str, Option<Function>);

/// In every build.
fn at_a_start(system: &Mutated) -> Vec<Finding> {
    let checkpoint = dalembert::Checkpoint::new(H, START);
    vec![
        ("from velocity", named(State::from_velocity(system, START.q, [0.3]))),
        ("from rest at 0, where every value is 0", named(State::from_velocity(system, [0.0], [0.0]))),
        ("trajectory, midpoint", named(system.by(Midpoint, H).run(START).next().unwrap())),
        ("trajectory, trapezoidal", named(system.by(Trapezoidal, H).run(START).next().unwrap())),
        ("trajectory, Gauss", named(system.by(Gauss::<3>, H).run(START).next().unwrap())),
        ("resumed", named(Trajectory::resume(system, Midpoint, checkpoint).next().unwrap())),
        ("in parts", named(system.by(Midpoint, H).run(START).next_in_parts(3))),
        ("composition", named(system.by(Composition::kahan_li_6(Midpoint), H).run(START).next().unwrap())),
        ("splitting", named(system.by(Splitting::blanes_moan_4(), H).run(START).next().unwrap())),
        (
            "resumed splitting",
            named(Trajectory::resume(system, Splitting::blanes_moan_6(), checkpoint).next().unwrap()),
        ),
        ("samples", named(system.by(Midpoint, H).run(START).sample_every(5).next().unwrap())),
        (
            "for a tolerance, and so its runs",
            match system.to_error(1e-3).until(1.0).choice(&START) {
                Err(ToleranceError::Step(error)) => named::<()>(Err(error)),
                _ => None,
            },
        ),
    ]
}

/// With `debug_assertions`.
fn at_a_step(system: &Mutated) -> Vec<Finding> {
    let midpoint = |guess| Flow::<Midpoint, 1>::step(system, &START, H, guess);
    vec![
        ("midpoint", named(midpoint(None))),
        ("midpoint from a guess", named(midpoint(Some(&vector![0.3])))),
        ("trapezoidal", named(system.by(Trapezoidal, H).step(&START))),
        ("Gauss, 1 stage", named(system.by(Gauss::<1>, H).step(&START))),
        ("Gauss, 4 stages", named(system.by(Gauss::<4>, H).step(&START))),
        ("linearised", named(system.by(Gauss::<2>, H).linearized_step(&START))),
        ("within", named(system.by(Midpoint, H).step_within(&START, 3))),
        ("configurations", named(system.by(Midpoint, H).step_configurations(&START.q, &vector![0.51]))),
    ]
}

#[test]
fn a_wrong_value_is_an_error_that_names_the_function_wherever_a_run_starts() {
    for (system, function) in wrong() {
        for (place, found) in at_a_start(&system) {
            assert_eq!(found, Some(function), "{place}");
        }
    }
    for (place, found) in at_a_start(&RIGHT) {
        assert_eq!(found, None, "{place}");
    }
}

#[test]
fn a_wrong_slope_is_an_error_that_names_the_function_where_a_run_starts() {
    let functions = [Function::Lagrangian, Function::Rayleigh, Function::Force { index: 0 }];
    for (i, function) in functions.into_iter().enumerate() {
        let mut bent = [0.0; 3];
        bent[i] = 0.01;
        let system = Mutated { bent, ..RIGHT };
        for (place, found) in at_a_start(&system) {
            // A state is made of values alone.
            let is_a_state = place.starts_with("from");
            assert_eq!(found, (!is_a_state).then_some(function), "{place}");
        }
        let told = START.verify(&system);
        assert!(matches!(told, Err(StepError::GeneratedDiffers { compared: Compared::Derivative, .. })));
        // Another step size does not get past it.
        let mut run = system.by(Midpoint, H).run(START);
        run.change_step_size(0.5 * H);
        assert!(run.next().unwrap().is_err());
        run.change_step_size(H);
        assert!(run.next().unwrap().is_err());
    }
    assert_eq!(START.verify(&RIGHT), Ok(()));
}

#[test]
fn wrong_momenta_are_an_error_where_a_run_starts_that_computes_them() {
    let (initial, last) = (Function::InitialMomentum { index: 0 }, Function::FinalMomentum { index: 0 });
    let names = ["trajectory, midpoint", "trajectory, trapezoidal", "composition", "splitting"];
    // By the midpoint rule, the trapezoidal one, a composition of midpoints, and a splitting.
    let expected = [
        [Some(initial), Some(initial), Some(initial), None],
        [Some(initial), Some(initial), Some(initial), None],
        [Some(last), Some(last), Some(last), None],
        [None, Some(initial), None, Some(initial)],
    ];
    for (i, expected) in expected.into_iter().enumerate() {
        let mut fused = [0.0; 4];
        fused[i] = 1e-4;
        let found = at_a_start(&Mutated { fused, ..RIGHT });
        for (name, expected) in names.into_iter().zip(expected) {
            let [(place, found)] = found.iter().filter(|(place, _)| *place == name).collect::<Vec<_>>()[..]
            else {
                panic!("{name}")
            };
            assert_eq!(*found, expected, "{place}, {i}");
        }
    }
}

#[test]
fn with_debug_assertions_second_derivatives_are_compared_where_a_run_starts() {
    for (i, function) in [Function::Lagrangian, Function::Rayleigh].into_iter().enumerate() {
        let mut curved = [0.0; 2];
        curved[i] = 0.01;
        let error = START.verify(&Mutated { curved, ..RIGHT });
        let found = match error {
            Err(StepError::GeneratedDiffers { function, compared, .. }) => Some((function, compared)),
            _ => None,
        };
        let told = Some((function, Compared::SecondDerivative));
        assert_eq!(found, told.filter(|_| cfg!(debug_assertions)));
    }
}

/// At rest, at the origin and next to either a wrong slope is as small as the right one.
#[test]
fn a_wrong_slope_is_told_from_the_origin_and_next_to_rest() {
    for q in [0.0, 1e-17, -1e-9, 0.3] {
        for p in [0.0, -1e-17, 1e-9, 0.3] {
            let start = State { q: vector![q], p: vector![p] };
            for i in 0..3 {
                let mut bent = [0.0; 3];
                bent[i] = 0.01;
                assert!(start.verify(&Mutated { bent, ..RIGHT }).is_err(), "{start:?}, {i}");
            }
            assert_eq!(start.verify(&RIGHT), Ok(()));
        }
    }
}

#[test]
fn with_debug_assertions_steps_compare_slopes_at_some_of_their_points() {
    let bent = Mutated { bent: [0.01, 0.0, 0.0], ..RIGHT };
    let found = |system: &Mutated| {
        let states = (0..640).map(|i| State { q: vector![0.5 + 1e-3 * f64::from(i)], ..START });
        states.filter(|state| named(system.by(Midpoint, H).step(state)).is_some()).count()
    };
    let found_bent = found(&bent);
    let expected = if cfg!(debug_assertions) { 1..=40 } else { 0..=0 };
    assert!(expected.contains(&found_bent), "{found_bent}");
    assert_eq!(found(&RIGHT), 0);
}

#[test]
fn with_debug_assertions_every_step_verifies_the_points_that_it_evaluates() {
    for (system, function) in wrong() {
        for (place, found) in at_a_step(&system) {
            assert_eq!(found, cfg!(debug_assertions).then_some(function), "{place}");
        }
    }
    for (place, found) in at_a_step(&RIGHT) {
        assert_eq!(found, None, "{place}");
    }
}

#[test]
fn a_run_that_fails_at_its_start_stays_where_it_is() {
    let [(system, _), ..] = wrong();
    let mut run = system.by(Midpoint, H).run(START);
    assert!(run.next().unwrap().is_err() && run.next().is_none());
    assert_eq!((*run.state(), run.time()), (START, 0.0));
    // Another step size does not get past it.
    run.change_step_size(0.5 * H);
    assert!(run.next().unwrap().is_err());
    let mut composed = system.by(Composition::kahan_li_6(Midpoint), H).run(START);
    assert!(composed.next().unwrap().is_err() && composed.next().is_none());
    assert_eq!((*composed.state(), composed.time()), (START, 0.0));
}

#[test]
fn the_message_says_what_to_do() {
    let [.., (system, _)] = wrong();
    let error = State::from_velocity(&system, START.q, [0.3]).unwrap_err().to_string();
    for part in ["component 0 of f", "as written", "as generated", "report it"] {
        assert!(error.contains(part), "{error}");
    }
}

/// A cart with an input and a clock; damped, so that L, R and f all stand in its view.
struct Cart {
    m: f64,
    c: f64,
}

#[rayleigh_system(derivatives = expanded, rule = [midpoint, trapezoidal, gauss])]
impl Cart {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2], t: f64) -> f64 {
        0.5 * self.m * (v[0] * v[0] + v[1] * v[1]) - (q[0] - t.sin()).powi(4) * q[1].cosh()
    }

    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * self.c * (1.0 + q[0] * q[0]) * (v[0] * v[0] + v[1] * v[1])
    }

    fn force(&self, q: [f64; 2], _v: [f64; 2], u: [f64; 1], t: f64) -> [f64; 2] {
        [u[0] * q[1].cos() * (3.0 * t).exp(), -u[0] / (1.0 + t)]
    }
}

/// A damped oscillator for the rules that take L and R together.
#[rayleigh_system(derivatives = expanded, rule = [fitted, fitted_trapezoidal, one_sided])]
fn joint(q: [f64; 1], v: [f64; 1], m: f64, k: f64, r: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
}

#[test]
fn views_and_joint_rules_are_verified_at_their_own_input_and_time() -> anyhow::Result<()> {
    let cart = Cart { m: 1.3, c: 0.2 };
    let driven = cart.driven([0.7], 2.5);
    let (q, v) = (vector![0.3, -0.2], vector![1.1, 0.4]);
    driven.verify_generated(&q, &v)?;
    let start = State::from_velocity(&driven, q, v)?;
    Discrete::<Midpoint, 2>::verify_segment(&driven, &Segment { q0: q, v, h: 0.1 })?;
    Discrete::<Trapezoidal, 2>::verify_segment(&driven, &Segment { q0: q, v, h: 0.1 })?;
    Discrete::<Gauss<5>, 2>::verify_segment(&driven, &Segment { q0: q, v, h: 0.1 })?;
    for step in driven.by(Gauss::<2>, 0.05).run(start).take(20) {
        step?;
    }
    let joint = Joint { m: 1.0, k: 2.0, r: 0.5 };
    let (q, v) = (SVector::from([0.3]), SVector::from([0.4]));
    Discrete::<Fitted, 1>::verify_segment(&joint, &Segment { q0: q, v, h: 0.1 })?;
    Discrete::<FittedTrapezoidal, 1>::verify_segment(&joint, &Segment { q0: q, v, h: 0.1 })?;
    Discrete::<dalembert::OneSided, 1>::verify_segment(&joint, &Segment { q0: q, v, h: 0.1 })?;
    Ok(())
}

/// Differences of numbers that are almost equal: near rest they round to 0, or to a few last places of 1.
struct Cancelling {
    epsilon: f64,
    c: f64,
}

#[rayleigh_system(derivatives = expanded)]
impl Cancelling {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let springs =
            (1.0 + q[0] * q[0]) - 1.0 + (self.epsilon * self.epsilon + q[1].powi(3)) - self.epsilon.powi(2);
        0.5 * self.c * (v[0] * v[0] + v[1] * v[1])
            - springs
            - (1.0 - (q[0] - q[1]).cos())
            - 0.5 * self.c * q[0] * q[0]
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        let epsilon = self.epsilon;
        let dry = |v: f64| (v * v + epsilon * epsilon).sqrt() - epsilon;
        0.5 * self.c * v[0] * v[0] + dry(v[0]) + (v[1] / epsilon).cosh().ln() * epsilon + 0.1 * v[1] * v[1]
    }

    fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        [(1.0 + v[0]) - 1.0 - 0.1 * v[0], (self.epsilon + q[1]) - self.epsilon + self.c * q[1]]
    }
}

/// A run that starts where another came to rest.
#[test]
fn rounding_near_rest_is_no_difference() {
    let (mut random, mut tried) = (Spread(77), 0);
    for exponent in 0..=18 {
        for _ in 0..50 {
            let mut small = |least: i32| {
                let size = 10.0_f64.powi(least) * (0.2 + random.next());
                if random.next() < 0.5 { size } else { -size }
            };
            let (q, p) =
                (vector![small(-exponent), small(-exponent)], vector![small(-exponent), small(-exponent)]);
            let system = Cancelling { epsilon: small(-(exponent % 7)).abs(), c: small(0).abs() };
            let start = State { q, p };
            assert_eq!(start.verify(&system), Ok(()), "{start:?} ε = {} c = {}", system.epsilon, system.c);
            assert_eq!(Flow::<Midpoint, 2>::verify_momenta(&system, &start, 0.01), Ok(()), "{start:?}");
            tried += 1;
        }
    }
    println!("{tried} starts");
}
