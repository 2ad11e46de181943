//! Hamilton–Jacobi theory of conformally symplectic steps: S_{k+1}∘F_k = cS_k + G in two dimensions, Jacobi's
//! constants, and the motion from them.

use dalembert::hamilton_jacobi::{
    ConformalHamiltonJacobi, GeneratingFamily, HamiltonJacobiError, ImplicitEquation,
};
use dalembert::nalgebra::{Matrix1, Matrix2, SMatrix, SVector, Vector1, Vector2, vector};
use dalembert::step::Flow;
use dalembert::{
    Discretise, FittedTrapezoidal, Midpoint, ScalarField, Splitting, State, Trapezoidal, rayleigh_system,
};
use dalembert_tests::damped_oscillator::{CompleteSolution, DAMPED};

/// M = [[1.3, 0.2], [0.2, 0.9]], C = 2aM, V = ¼q₀⁴ + q₁² + sin q₀q₁.
struct Well;

const A: f64 = 0.3;
const H: f64 = 0.2;

#[rayleigh_system(rule = [midpoint, trapezoidal, fitted_trapezoidal])]
impl Well {
    fn kinetic(v: [f64; 2]) -> f64 {
        0.65 * v[0] * v[0] + 0.2 * v[0] * v[1] + 0.45 * v[1] * v[1]
    }
    fn potential(q: [f64; 2]) -> f64 {
        0.25 * q[0] * q[0] * q[0] * q[0] + q[1] * q[1] + (q[0] * q[1]).sin()
    }
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        Self::kinetic(v) - Self::potential(q)
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        2.0 * A * Self::kinetic(v)
    }
}

/// S_0 = ½qᵀBq + λ·q + λ₀λ₁q₀²; with `span` = 0 both parameters do the same.
struct Waves {
    span: f64,
}

const B: Matrix2<f64> = Matrix2::new(0.4, 0.1, 0.1, -0.2);
const LAMBDA: Vector2<f64> = vector![0.3, 0.5];
const LABEL: Vector2<f64> = vector![0.2, 0.4];
const WIDTH: f64 = 0.02;

impl GeneratingFamily<2> for Waves {
    type Scalar = f64;

    fn value(&self, q: &Vector2<f64>, lambda: &Vector2<f64>) -> f64 {
        let linear = lambda[0] * q[0] + lambda[1] * (self.span * q[1] + (1.0 - self.span) * q[0]);
        0.5 * q.dot(&(B * q)) + linear + lambda[0] * lambda[1] * q[0] * q[0]
    }

    fn gradient(&self, q: &Vector2<f64>, lambda: &Vector2<f64>) -> Vector2<f64> {
        let bend = vector![2.0 * lambda[0] * lambda[1] * q[0], 0.0];
        B * q + vector![lambda[0] + (1.0 - self.span) * lambda[1], self.span * lambda[1]] + bend
    }

    fn hessian(&self, _q: &Vector2<f64>, lambda: &Vector2<f64>) -> Matrix2<f64> {
        B + Matrix2::new(2.0 * lambda[0] * lambda[1], 0.0, 0.0, 0.0)
    }

    fn by_parameters(&self, q: &Vector2<f64>, lambda: &Vector2<f64>) -> Vector2<f64> {
        let square = q[0] * q[0];
        vector![q[0] + lambda[1] * square, self.span * q[1] + (1.0 - self.span) * q[0] + lambda[0] * square]
    }

    fn mixed(&self, q: &Vector2<f64>, lambda: &Vector2<f64>) -> Matrix2<f64> {
        let [x, y] = [2.0 * lambda[1] * q[0], 2.0 * lambda[0] * q[0]];
        if self.span == 0.0 {
            return Matrix2::new(1.0, 1.0, 0.0, 0.0);
        }
        Matrix2::new(1.0 + x, y, 0.0, 1.0)
    }
}

/// The member λ of the family.
struct Wave(Vector2<f64>);

impl ScalarField<2> for Wave {
    type Scalar = f64;

    fn value(&self, q: &Vector2<f64>) -> f64 {
        Waves { span: 1.0 }.value(q, &self.0)
    }

    fn gradient(&self, q: &Vector2<f64>) -> Vector2<f64> {
        Waves { span: 1.0 }.gradient(q, &self.0)
    }

    fn hessian(&self, q: &Vector2<f64>) -> Matrix2<f64> {
        Waves { span: 1.0 }.hessian(q, &self.0)
    }
}

const STATES: [State<f64, 2>; 2] = [
    State { q: vector![0.1, 0.2], p: vector![0.0, 0.3] },
    State { q: vector![-0.5, 0.4], p: vector![0.7, -0.2] },
];

fn theory<M>(method: M) -> ConformalHamiltonJacobi<'static, Well, M, 2>
where
    Well: Flow<M, 2, Scalar = f64>,
{
    Well.by(method, H).conformal_hamilton_jacobi(&STATES).unwrap()
}

/// The state after `steps` steps from LABEL.
fn stepped<M: Copy>(method: M, steps: usize) -> State<f64, 2>
where
    Well: Flow<M, 2, Scalar = f64>,
{
    let start = State { q: LABEL, p: Waves { span: 1.0 }.gradient(&LABEL, &LAMBDA) };
    (0..steps).fold(start, |state, _| Well.by(method, H).step(&state).unwrap().state)
}

/// c^{−k} ∂S_k/∂λ is constant, and q_k, p_k are found from it and λ to 1e-12, from a label that is far off.
#[test]
fn the_family_integrates_the_motion_in_two_dimensions() {
    fn check<M: Copy>(name: &str, method: M, c: f64, constant: usize, integrated: &[usize])
    where
        Well: Flow<M, 2, Scalar = f64>,
    {
        let (theory, waves) = (theory(method), Waves { span: 1.0 });
        assert!((theory.factor() - c).abs() < 1e-14, "{name}: {}", theory.factor());
        let constants = theory.jacobi_constants(&waves, &LAMBDA, &LABEL, constant, WIDTH).unwrap();
        // ∂S_0/∂λ at the label.
        let b = vector![0.2 + 0.5 * 0.04, 0.4 + 0.3 * 0.04];
        assert_eq!(constants.values.len(), constant + 1);
        for (k, value) in constants.values.iter().enumerate() {
            assert!((value - b).amax() < 1e-12, "{name}, k = {k}: {value} {b}");
        }
        assert!(constants.drift() < 1e-12 && constants.difference_error < 1e-11, "{name}: {constants:?}");
        // The control: what is not divided by c^k falls.
        assert!((constants.values[constant] * c.powi(constant as i32) - b).amax() > 0.02);
        for &steps in integrated {
            let near = LABEL + vector![0.15, -0.1];
            let found = theory.integrate(&waves, (&LAMBDA, &b), steps, &near, WIDTH).unwrap();
            let expected = stepped(method, steps);
            let miss = (found.q - expected.q).amax().max((found.p - expected.p).amax());
            assert!(miss < 1e-12, "{name}, {steps} steps: {miss:e}");
        }
        // Other constants, another motion.
        let off = b + vector![1e-6, 0.0];
        let other = theory.integrate(&waves, (&LAMBDA, &off), 1, &LABEL, WIDTH).unwrap();
        assert!((other.q - stepped(method, 1).q).amax() > 1e-8);
    }
    let (z, exact) = (A * H, (-2.0 * A * H).exp());
    // Without optimisation eight steps take half a minute.
    let all = !cfg!(debug_assertions);
    let (constant, integrated): (usize, &[usize]) = if all { (8, &[1, 4, 8]) } else { (2, &[2]) };
    check("trapezoidal", Trapezoidal, (1.0 - z) / (1.0 + z), constant, integrated);
    check(
        "fitted trapezoidal",
        FittedTrapezoidal,
        exact,
        if all { 8 } else { 1 },
        if all { &[2] } else { &[1] },
    );
    check("Blanes–Moan 6", Splitting::blanes_moan_6(), exact, if all { 4 } else { 1 }, &[1]);
}

/// S_k by the closed form G = (1 − κ)L_d + cκ(h/2)V(q0) − κ(h/2)V(q1), written out here, and by quadrature:
/// the same differences between labels. p = ∂S_k/∂q by differences of order 8.
#[test]
fn the_carried_values_are_those_of_the_closed_form() {
    let theory = theory(Trapezoidal);
    let kappa = A * H;
    let c = (1.0 - kappa) / (1.0 + kappa);
    let potential = |q: &Vector2<f64>| Well::potential([q[0], q[1]]);
    let g = |q0: &Vector2<f64>, q1: &Vector2<f64>| {
        let v = (q1 - q0) / H;
        let l = H * Well::kinetic([v[0], v[1]]) - 0.5 * H * (potential(q0) + potential(q1));
        (1.0 - kappa) * l + 0.5 * H * kappa * (c * potential(q0) - potential(q1))
    };
    let wave = Wave(LAMBDA);
    let gap = |label: Vector2<f64>| {
        let carried = theory.carry(&wave, &label, 8).unwrap();
        assert!(carried.quadrature_error < 1e-12);
        let states = &carried.characteristic.states;
        let own = (0..8).fold(wave.value(&label), |s, k| c * s + g(&states[k].q, &states[k + 1].q));
        (carried.value() - own, own)
    };
    let (first, value) = gap(LABEL);
    for label in [vector![-0.3, 0.2], vector![0.6, 0.5], vector![0.0, -0.4]] {
        let (other, own) = gap(label);
        assert!((other - first).abs() < 1e-14, "{other} {first}");
        assert!((own - value).abs() > 1e-2);
    }
    let end = theory.carry(&wave, &LABEL, 8).unwrap().end();
    let s = |q: Vector2<f64>| theory.through(&wave, 8, &q, &LABEL).unwrap().value();
    for i in 0..2 {
        let weights = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];
        let mut slope = 0.0;
        for (m, weight) in weights.iter().enumerate() {
            let mut shift = Vector2::zeros();
            shift[i] = 0.01 * (m + 1) as f64;
            slope += weight * (s(end.q + shift) - s(end.q - shift)) / 0.01;
        }
        assert!((slope - end.p[i]).abs() < 1e-11, "{slope} {}", end.p[i]);
    }
}

/// R = ½γq² exerts no force; by the trapezoidal rule R_d = (h²/8)γ(q0² + q1²) = α(q0) + β(q1): κ = 0, c = 1,
/// and momenta that differ from those without R. S_1∘F_0 = S_0 + L_d, the equation without force, does not
/// give p1; with G = L_d + α − β it does, and with γ = 0 both do.
#[test]
fn kappa_0_alone_is_not_the_unforced_equation() {
    #[rayleigh_system(rule = trapezoidal)]
    fn gauged(q: [f64; 1], v: [f64; 1], gamma: f64) -> (f64, f64) {
        (0.5 * v[0] * v[0] - 0.5 * q[0] * q[0], 0.5 * gamma * q[0] * q[0])
    }
    let misses = |gamma: f64| {
        let system = Gauged { gamma };
        let by = system.by(Trapezoidal, H);
        let start = |q: f64| State { q: vector![q], p: vector![0.4 * q + 0.7] };
        let step = |q: f64| by.step(&start(q)).unwrap().state;
        let found = by.conformal_step(&[start(0.3), start(-0.8)]).unwrap();
        assert!(found.is_conformal() && (found.factor - 1.0).abs() < 1e-14, "{found}");
        let alpha = |q: f64| H * H / 8.0 * gamma * q * q;
        // p1·DF_0 against the derivative of S_1∘F_0 by the label; all is quadratic, and differences exact.
        let (label, d) = (0.3, 0.5);
        let slope = |of: &dyn Fn(f64) -> f64| (of(label + d) - of(label - d)) / (2.0 * d);
        let s = |q: f64| 0.2 * q * q + 0.7 * q;
        let l = |q: f64| by.discrete_lagrangian(&vector![q], &step(q).q);
        let by_label = step(label).p[0] * slope(&|q| step(q).q[0]);
        [
            (slope(&|q| s(q) + l(q)) - by_label).abs(),
            (slope(&|q| s(q) + l(q) + alpha(q) - alpha(step(q).q[0])) - by_label).abs(),
        ]
    };
    let [unforced, whole] = misses(2.0);
    assert!(unforced > 1e-3 && whole < 1e-14, "{unforced:e} {whole:e}");
    assert!(misses(0.0).iter().all(|miss| *miss < 1e-14));
}

/// Characteristics, frames and caustics are those of the theory of pairs (L_d, f_d), and sections stay
/// closed.
#[test]
fn caustics_are_reported_as_of_every_carried_section() {
    let wave = Wave(vector![-0.6, -0.4]);
    let (conformal, pairs) = (theory(Trapezoidal), Well.by(Trapezoidal, H).hamilton_jacobi());
    let mut caustics = 0;
    for label in [vector![0.9, -0.6], vector![-0.7, 0.8], LABEL] {
        let carried = conformal.carry(&wave, &label, 40).unwrap();
        let other = pairs.carry(&wave, &label, 40).unwrap();
        caustics += other.caustics.len();
        assert_eq!(carried.characteristic.caustics.len(), other.caustics.len());
        for (one, other) in carried.characteristic.caustics.iter().zip(&other.caustics) {
            let apart = one.step as f64 + one.fraction - other.step as f64 - other.fraction;
            assert!(apart.abs() < 1e-9 && (one.q - other.q).amax() < 1e-9, "{one}; {other}");
        }
        let report = pairs.characteristics_report(&[carried.characteristic]).unwrap();
        assert!(report.closed.unwrap().holds(), "{report}");
    }
    assert!(caustics > 3, "{caustics}");
}

/// n = 1, midpoint, V quadratic: the complete solution's family, δ its factor.
#[test]
fn jacobis_constants_of_the_damped_oscillator() {
    struct Lines(f64);
    impl GeneratingFamily<1> for Lines {
        type Scalar = f64;
        fn value(&self, q: &Vector1<f64>, lambda: &Vector1<f64>) -> f64 {
            0.5 * self.0 * q[0] * q[0] + lambda[0] * q[0]
        }
        fn gradient(&self, q: &Vector1<f64>, lambda: &Vector1<f64>) -> Vector1<f64> {
            q * self.0 + lambda
        }
        fn hessian(&self, _q: &Vector1<f64>, _lambda: &Vector1<f64>) -> Matrix1<f64> {
            Matrix1::new(self.0)
        }
        fn by_parameters(&self, q: &Vector1<f64>, _lambda: &Vector1<f64>) -> Vector1<f64> {
            *q
        }
        fn mixed(&self, _q: &Vector1<f64>, _lambda: &Vector1<f64>) -> Matrix1<f64> {
            Matrix1::new(1.0)
        }
    }
    let (h, q) = (0.25, vector![0.4]);
    let closed = CompleteSolution::new(&DAMPED, h, -0.2, 0.7);
    let states = [State { q, p: vector![0.3] }, State { q: vector![-1.0], p: vector![0.2] }];
    let theory = DAMPED.by(Midpoint, h).conformal_hamilton_jacobi(&states).unwrap();
    assert!((theory.factor() - closed.delta).abs() < 1e-15);
    let lines = Lines(closed.s(0));
    let constants = theory.jacobi_constants(&lines, &vector![0.7], &q, 5, 0.1).unwrap();
    assert!(constants.drift() < 1e-13, "{}", constants.drift());
    // S_k is that of the closed form: p_k = s_k q_k + λ_k, by the label.
    let end = constants.characteristic.states[5];
    assert!((end.p[0] - closed.s(5) * end.q[0] - closed.lambda(5)).abs() < 1e-14);
    let found = theory.integrate(&lines, (&vector![0.7], &q), 5, &vector![-1.0], 0.1).unwrap();
    assert!((found.q - end.q).amax() < 1e-13 && (found.p - end.p).amax() < 1e-13);
}

/// Of a system at a time t0 step k is that of t0 + k h.
#[test]
fn the_theory_follows_the_time_of_a_view() {
    struct Shaken;
    #[rayleigh_system(rule = trapezoidal)]
    impl Shaken {
        fn lagrangian(&self, q: [f64; 2], v: [f64; 2], t: f64) -> f64 {
            0.5 * (v[0] * v[0] + v[1] * v[1]) - q[0] * q[0] * q[1] * q[1] + q[0] * (3.0 * t).cos()
        }
        fn rayleigh(&self, v: [f64; 2]) -> f64 {
            A * (v[0] * v[0] + v[1] * v[1])
        }
    }
    let view = Shaken.at_time(0.7);
    let by = view.by(Trapezoidal, H);
    let theory = by.conformal_hamilton_jacobi(&STATES).unwrap();
    let carried = theory.carry(&Wave(LAMBDA), &LABEL, 6).unwrap();
    let start = carried.characteristic.states[0];
    let end = by.run(start).take(6).last().unwrap().unwrap().state;
    assert!((carried.end().q - end.q).amax() < 1e-15);
    let constants = theory.jacobi_constants(&Waves { span: 1.0 }, &LAMBDA, &LABEL, 3, WIDTH).unwrap();
    assert!(constants.drift() < 1e-12, "{}", constants.drift());
    // The control: at another time it is another motion.
    let other = Shaken.at_time(0.0);
    assert!(
        (other.by(Trapezoidal, H).run(start).take(6).last().unwrap().unwrap().state.q - end.q).amax() > 1e-3
    );
}

/// The drift of Jacobi's constants of plane waves behind a hollow, which focuses them.
fn drift_near_a_caustic(width: f64) -> Result<f64, HamiltonJacobiError> {
    #[rayleigh_system(rule = trapezoidal)]
    fn hollow(q: [f64; 2], v: [f64; 2], a: f64) -> (f64, f64) {
        let kinetic = 0.5 * (v[0] * v[0] + v[1] * v[1]);
        (kinetic + (-2.0 * ((q[0] - 1.0) * (q[0] - 1.0) + q[1] * q[1])).exp(), 2.0 * a * kinetic)
    }
    struct Plane;
    impl GeneratingFamily<2> for Plane {
        type Scalar = f64;
        fn value(&self, q: &Vector2<f64>, lambda: &Vector2<f64>) -> f64 {
            lambda.dot(q)
        }
        fn gradient(&self, _q: &Vector2<f64>, lambda: &Vector2<f64>) -> Vector2<f64> {
            *lambda
        }
        fn hessian(&self, _q: &Vector2<f64>, _lambda: &Vector2<f64>) -> Matrix2<f64> {
            Matrix2::zeros()
        }
        fn by_parameters(&self, q: &Vector2<f64>, _lambda: &Vector2<f64>) -> Vector2<f64> {
            *q
        }
        fn mixed(&self, _q: &Vector2<f64>, _lambda: &Vector2<f64>) -> Matrix2<f64> {
            Matrix2::identity()
        }
    }
    let hollow = Hollow { a: 0.1 };
    let lambda = vector![1.5, 0.0];
    let states = [State { q: vector![0.0, 0.0], p: lambda }];
    let theory = hollow.by(Trapezoidal, 0.4).conformal_hamilton_jacobi(&states)?;
    Ok(theory.jacobi_constants(&Plane, &lambda, &vector![0.0, 0.4], 3, width)?.drift())
}

/// Spacings so wide that S_k is another branch: an error, or the right value once halved, no other.
#[test]
fn no_spacing_takes_another_branch_for_the_right_one() {
    let drifts = [0.02, 200.0].map(drift_near_a_caustic);
    for drift in drifts {
        match drift {
            Ok(drift) => assert!(drift < 1e-10, "{drift:e}"),
            Err(error) => assert!(
                matches!(
                    error,
                    HamiltonJacobiError::Unsettled { .. }
                        | HamiltonJacobiError::Caustic { .. }
                        | HamiltonJacobiError::NoLabel { .. }
                ),
                "{error}"
            ),
        }
    }
    assert!(drifts[0].is_ok() && drifts[1].is_err(), "{drifts:?}");
}

#[test]
fn hypotheses_that_fail_have_names() {
    // The midpoint rule is not conformally symplectic on this V.
    let refused = |states: &[State<f64, 2>]| {
        Well.by(Midpoint, H).conformal_hamilton_jacobi(states).map(|_| ()).unwrap_err()
    };
    let error = refused(&STATES);
    assert!(
        matches!(error, HamiltonJacobiError::NotConformal { step: None, report } if !report.is_conformal()),
        "{error}"
    );
    assert!(matches!(refused(&[]), HamiltonJacobiError::States(_)));
    let lost = State { q: vector![f64::NAN, 0.0], p: vector![0.0, 0.0] };
    assert!(matches!(refused(&[lost]), HamiltonJacobiError::States(_)));

    // ∂²S_0/∂q∂λ of two parameters that do the same.
    let theory = theory(Trapezoidal);
    let degenerate = Waves { span: 0.0 };
    let error = theory.jacobi_constants(&degenerate, &LAMBDA, &LABEL, 2, WIDTH).unwrap_err();
    assert_eq!(error, HamiltonJacobiError::DegenerateFamily);
    let error = theory.integrate(&degenerate, (&LAMBDA, &LABEL), 2, &LABEL, WIDTH).unwrap_err();
    assert_eq!(error, HamiltonJacobiError::DegenerateFamily);
    let error = theory.carry(&Wave(LAMBDA), &vector![f64::NAN, 0.0], 2).unwrap_err();
    assert!(
        matches!(error, HamiltonJacobiError::Implicit { equation: ImplicitEquation::Step, step: 0, .. }),
        "{error}"
    );

    // A free mass, ah = 3: c = −½ and ∂q1/∂p0 = 1/8, so that p = −8q meets in one point after a step.
    #[rayleigh_system(rule = trapezoidal)]
    fn free(q: [f64; 2], v: [f64; 2], a: f64) -> (f64, f64) {
        let kinetic = 0.5 * (v[0] * v[0] + v[1] * v[1]);
        (kinetic - 0.0 * q[0], 2.0 * a * kinetic)
    }
    struct Converging;
    impl ScalarField<2> for Converging {
        type Scalar = f64;
        fn value(&self, q: &SVector<f64, 2>) -> f64 {
            -4.0 * q.dot(q)
        }
        fn gradient(&self, q: &SVector<f64, 2>) -> SVector<f64, 2> {
            q * -8.0
        }
        fn hessian(&self, _q: &SVector<f64, 2>) -> SMatrix<f64, 2, 2> {
            Matrix2::identity() * -8.0
        }
    }
    let mass = Free { a: 6.0 };
    let stiff = mass.by(Trapezoidal, 0.5).conformal_hamilton_jacobi(&STATES).unwrap();
    assert_eq!(stiff.factor(), -0.5);
    let carried = stiff.carry(&Converging, &LABEL, 2).unwrap();
    assert_eq!(carried.characteristic.caustics[0].multiplicity, 2);
    let error = stiff.through(&Converging, 1, &LABEL, &LABEL).unwrap_err();
    assert_eq!(error, HamiltonJacobiError::Caustic { step: 1 });

    // ah = 1: no momentum is left after a step, c = 0.
    let mass = Free { a: 2.0 };
    let error = mass.by(Trapezoidal, 0.5).conformal_hamilton_jacobi(&STATES).map(|_| ()).unwrap_err();
    assert_eq!(error, HamiltonJacobiError::VanishingFactor);

    // Quadratic for q < 1 alone, where the states are: the characteristic leaves.
    #[rayleigh_system]
    fn kinked(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
        let beyond = (q[0] - 1.0).max(0.0);
        (0.5 * v[0] * v[0] - 0.5 * q[0] * q[0] - beyond.powi(4), 0.5 * r * v[0] * v[0])
    }
    struct Fast;
    impl ScalarField<1> for Fast {
        type Scalar = f64;
        fn value(&self, q: &Vector1<f64>) -> f64 {
            4.0 * q[0]
        }
        fn gradient(&self, _q: &Vector1<f64>) -> Vector1<f64> {
            vector![4.0]
        }
        fn hessian(&self, _q: &Vector1<f64>) -> Matrix1<f64> {
            Matrix1::zeros()
        }
    }
    let states = [State { q: vector![0.0], p: vector![0.0] }, State { q: vector![0.2], p: vector![0.1] }];
    let kinked = Kinked { r: 0.3 };
    let theory = kinked.by(Midpoint, 0.1).conformal_hamilton_jacobi(&states).unwrap();
    assert!(theory.carry(&Fast, &vector![0.0], 2).is_ok());
    let error = theory.carry(&Fast, &vector![0.0], 6).unwrap_err();
    // 0.4 a step at most: beyond 1 from step 2 on.
    assert!(matches!(error, HamiltonJacobiError::NotConformal { step: Some(2..=3), .. }), "{error}");
    // A point that no characteristic reaches: q stays where V is high.
    let error = theory.through(&Fast, 2, &vector![f64::NAN], &vector![0.0]).unwrap_err();
    assert!(!error.to_string().is_empty());
}
