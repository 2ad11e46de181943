//! The rules fitted to linear damping, where damping is a matrix: the free flow, phase space, and what a run
//! keeps.

use dalembert::nalgebra::{Matrix3, SMatrix, SVector, Vector3, matrix, vector};
use dalembert::step::{ClosedForm, Linearizable, Segment};
use dalembert::{
    Discrete, Discretise, Fitted, FittedTrapezoidal, Midpoint, State, Trapezoidal, rayleigh_system,
};

/// A form of three coordinates: entries 11, 12, 13, 22, 23, 33.
type Form = [f64; 6];

/// Three coordinates with full matrices M and C and an anharmonic potential of strength `k`.
struct Three {
    m: Form,
    c: Form,
    k: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal, fitted, fitted_trapezoidal])]
impl Three {
    fn form(a: [f64; 6], v: [f64; 3]) -> f64 {
        0.5 * (a[0] * v[0] * v[0] + a[3] * v[1] * v[1] + a[5] * v[2] * v[2])
            + a[1] * v[0] * v[1]
            + a[2] * v[0] * v[2]
            + a[4] * v[1] * v[2]
    }

    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        let (a, b) = (q[1] - q[0], q[2] - q[1]);
        Self::form(self.m, v) - self.k * (0.5 * q[0] * q[0] + 0.6 * a * a + 0.25 * a.powi(4) + 0.9 * b.cosh())
    }

    fn rayleigh(&self, v: [f64; 3]) -> f64 {
        Self::form(self.c, v)
    }
}

const M: Form = [1.3, 0.4, -0.2, 0.9, 0.1, 1.7];
const C: Form = [0.5, -0.2, 0.1, 0.7, 0.3, 0.9];

fn full(a: Form) -> Matrix3<f64> {
    matrix![a[0], a[1], a[2]; a[1], a[3], a[4]; a[2], a[4], a[5]]
}

const STATE: State<f64, 3> = State { q: vector![0.7, -0.3, 0.2], p: vector![0.2, 0.9, -0.4] };

fn step<S, R: Copy, const N: usize>(system: &S, _: R, state: &State<f64, N>, h: f64) -> State<f64, N>
where
    S: Discrete<R, N, Scalar = f64>,
{
    system.step(state, h, None).unwrap().state
}

/// Without a potential the step is the flow, p1 = e^{−hCM⁻¹} p0 and q1 = q0 + C⁻¹(p0 − p1), for any C.
/// Exponentials by nalgebra, of the matrix that is not symmetric: nothing of the rules' decomposition.
#[test]
fn a_free_motion_is_the_flow_for_any_damping_matrix() {
    for (share, h) in [(1e-3, 0.3), (1.0, 0.3), (1.0, 2.0), (40.0, 0.5), (-0.5, 0.3)] {
        let c = C.map(|entry| share * entry);
        let system = Three { m: M, c, k: 0.0 };
        let (m, c) = (full(M), full(c));
        let p = (-c * m.try_inverse().unwrap() * h).exp() * STATE.p;
        let q = STATE.q + c.try_inverse().unwrap() * (STATE.p - p);
        let error = |end: State<f64, 3>| (end.q - q).amax().max((end.p - p).amax());
        // C⁻¹ of the expectation loses digits where C is small.
        let rounding = 1e-14 * (1.0 + 1.0 / share.abs());
        assert!(error(step(&system, Fitted, &STATE, h)) < rounding, "{share} {h}");
        assert!(error(step(&system, FittedTrapezoidal, &STATE, h)) < rounding, "{share} {h}");
        // The control: the midpoint rule's is an approximation.
        let by_midpoint = error(step(&system, Midpoint, &STATE, h));
        assert!(by_midpoint > 1e3 * rounding || share == 1e-3, "{share} {h}: {by_midpoint:e}");
    }
}

/// L_d = (1/2h) dᵀ M Z coth(Z) d, with coth by matrix exponentials; for one coordinate L_d is the action
/// ∫½mv²dt of the damped motion v = v0 e^{−rt/m} from q0 to q1, by quadrature.
#[test]
fn the_discrete_lagrangian_is_the_fitted_mass() {
    let (h, d) = (0.7, vector![0.3, -0.4, 0.5]);
    for share in [0.1, 1.0, 10.0] {
        let c = C.map(|entry| share * entry);
        let z = full(M).try_inverse().unwrap() * full(c) * (0.5 * h);
        let (grown, one) = ((z * 2.0).exp(), Matrix3::identity());
        let mass = full(M) * z * (grown + one) * (grown - one).try_inverse().unwrap();
        let expected = d.dot(&(mass * d)) / (2.0 * h);
        let system = Three { m: M, c, k: 0.0 };
        let (a, b) = (STATE.q, STATE.q + d);
        let values = [
            system.by(Fitted, h).discrete_lagrangian(&a, &b),
            system.by(FittedTrapezoidal, h).discrete_lagrangian(&a, &b),
        ];
        assert!(values.iter().all(|value| (value / expected - 1.0).abs() < 1e-13), "{values:?} {expected}");
        // The control: midpoint's own mass is less.
        let midpoint = system.by(Midpoint, h).discrete_lagrangian(&a, &b);
        assert!((midpoint / expected - 1.0).abs() > 1e-5 * share * share);
    }

    // One direction alone, M and C diagonal: Simpson's rule on the exact motion.
    let (m, r, d) = (1.3, 2.1, 0.6);
    let system = Three { m: [m, 0.0, 0.0, 1.0, 0.0, 1.0], c: [r, 0.0, 0.0, 1.0, 0.0, 1.0], k: 0.0 };
    let rate = r / m;
    let v0 = d * rate / (1.0 - f64::exp(-rate * h));
    let kinetic = |t: f64| 0.5 * m * (v0 * f64::exp(-rate * t)).powi(2);
    let pieces = 2_000;
    let width = h / f64::from(pieces);
    let action: f64 = (0..pieces)
        .map(|i| {
            let t = f64::from(i) * width;
            (kinetic(t) + 4.0 * kinetic(t + 0.5 * width) + kinetic(t + width)) * width / 6.0
        })
        .sum();
    let zero = Vector3::zeros();
    let value = system.by(Fitted, h).discrete_lagrangian(&zero, &vector![d, 0.0, 0.0]);
    assert!((value / action - 1.0).abs() < 1e-12, "{value} {action}");
}

fn linearization<S, R: Copy, const N: usize, const K: usize>(
    system: &S,
    rule: R,
    state: &State<f64, N>,
    h: f64,
) -> SMatrix<f64, K, K>
where
    S: Linearizable<R, N, Scalar = f64>,
{
    let end = step(system, rule, state, h);
    system
        .by(rule, h)
        .segment(&state.q, &end.q)
        .unwrap()
        .linearized()
        .unwrap()
        .by_state()
        .unwrap()
        .assembled::<K>()
}

/// Largest entry of AᵀΩA − sΩ with the s that fits best, and this s.
fn conformal<const K: usize>(a: &SMatrix<f64, K, K>) -> (f64, f64) {
    let half = K / 2;
    let omega = SMatrix::<f64, K, K>::from_fn(|i, j| f64::from(i + half == j) - f64::from(j + half == i));
    let form = a.transpose() * omega * a;
    let share = form.dot(&omega) / omega.norm_squared();
    ((form - omega * share).amax(), share)
}

/// AᵀΩA = e^{−2ah}Ω where C = 2aM, at any state of any V. The midpoint rule and the implicit fitted one scale
/// Ω by another factor, and not all of it alike.
#[test]
fn the_explicit_one_is_conformally_symplectic() {
    for (a, h) in [(0.2, 0.3), (1.5, 0.3), (-0.4, 0.2), (20.0, 0.5)] {
        let system = Three { m: M, c: M.map(|entry| 2.0 * a * entry), k: 2.1 };
        for shift in [0.0, 0.4, -0.7] {
            let state = State { q: STATE.q.add_scalar(shift), ..STATE };
            let (rest, share) =
                conformal(&linearization::<_, _, 3, 6>(&system, FittedTrapezoidal, &state, h));
            let expected = f64::exp(-2.0 * a * h);
            // The entries of A are of the size 10 and less.
            assert!(rest < 1e-13 && (share - expected).abs() < 1e-14, "{a}: {rest:e}, {share} {expected}");
        }
        let by_midpoint = conformal(&linearization::<_, _, 3, 6>(&system, Midpoint, &STATE, h));
        let by_fitted = conformal(&linearization::<_, _, 3, 6>(&system, Fitted, &STATE, h));
        for (rest, share) in [by_midpoint, by_fitted] {
            assert!(rest > 1e-4 && (share - f64::exp(-2.0 * a * h)).abs() > 1e-6, "{a}: {rest:e} {share}");
        }
    }
    // The second control: C that is no multiple of M contracts directions each by its own.
    let system = Three { m: M, c: C, k: 2.1 };
    let (rest, _) = conformal(&linearization::<_, _, 3, 6>(&system, FittedTrapezoidal, &STATE, 0.3));
    assert!(rest > 1e-2, "{rest:e}");
}

/// The determinant of the step is e^{−h tr M⁻¹C}, for any C, at any state: that of the flow. Midpoint's is
/// not.
#[test]
fn the_explicit_one_contracts_volumes_as_the_flow() {
    for (share, h) in [(1.0, 0.3), (10.0, 0.3), (-1.0, 0.2)] {
        let c = C.map(|entry| share * entry);
        let system = Three { m: M, c, k: 2.1 };
        let expected = (-h * (full(M).try_inverse().unwrap() * full(c)).trace()).exp();
        let relative = |a: SMatrix<f64, 6, 6>| (a.determinant() / expected - 1.0).abs();
        let explicit = relative(linearization(&system, FittedTrapezoidal, &STATE, h));
        assert!(explicit < 1e-12, "{explicit:e}");
        assert!(relative(linearization(&system, Midpoint, &STATE, h)) > 1e-3);
    }
}

/// f_d has an R_d for every N where C is a multiple of M: D1 f⁺ = −(D2 f⁻)ᵀ, with D1 f⁻ and D2 f⁺ symmetric.
/// For another C the implicit rule's has none.
#[test]
fn the_force_of_the_implicit_one_is_rayleigh_where_damping_is_proportional() {
    let defect = |c: Form| {
        let system = Three { m: M, c, k: 2.1 };
        let end = vector![0.9, 0.2, -0.1];
        let f = ClosedForm::<Fitted, 3>::discrete_force_derivatives(
            &system,
            &Segment::between(&STATE.q, &end, 0.3),
        );
        let skew = |a: SMatrix<f64, 3, 3>| (a - a.transpose()).amax();
        skew(f.minus.d1).max(skew(f.plus.d2)).max((f.plus.d1 + f.minus.d2.transpose()).amax())
    };
    assert!(defect(M.map(|entry| 0.8 * entry)) < 1e-15);
    assert!(defect(C) > 1e-3);
}

/// And so it is wherever CM⁻¹V″ is symmetric: pendula that nothing couples, with damping of their own, also
/// in coordinates turned by an angle, which couples all three matrices. R_d = ¼dᵀCd − hΣ ℒ(z_i)V_i(q̄).
#[test]
fn the_force_of_the_implicit_one_is_rayleigh_where_damping_and_springs_have_common_modes() {
    #[rayleigh_system(rule = fitted)]
    fn pendula(q: [f64; 2], v: [f64; 2], r: [f64; 2], turn: [f64; 2], coupling: f64) -> (f64, f64) {
        let [c, s] = turn;
        let (x, y) = (c * q[0] - s * q[1], s * q[0] + c * q[1]);
        let (u, w) = (c * v[0] - s * v[1], s * v[0] + c * v[1]);
        let potential = -x.cos() - 2.0 * y.cos() + coupling * x * y;
        (0.5 * (u * u + 1.4 * w * w) - potential, 0.5 * (r[0] * u * u + r[1] * w * w))
    }
    let (q0, q1, h) = (vector![0.7, -0.3], vector![0.9, 0.2], 0.3);
    let skew = |a: SMatrix<f64, 2, 2>| (a - a.transpose()).amax();
    for angle in [0.0_f64, 0.6] {
        let defect = |r: [f64; 2], coupling: f64| {
            let system = Pendula { r, turn: [angle.cos(), angle.sin()], coupling };
            let f =
                ClosedForm::<Fitted, 2>::discrete_force_derivatives(&system, &Segment::between(&q0, &q1, h));
            skew(f.minus.d1).max(skew(f.plus.d2)).max((f.plus.d1 + f.minus.d2.transpose()).amax())
        };
        assert!(defect([0.3, 4.0], 0.0) < 1e-15, "{angle}");
        // The controls: a coupling of pendula with different damping, and of pendula with C = 0.3 M.
        assert!(defect([0.3, 4.0], 0.5) > 1e-3, "{angle}");
        assert!(defect([0.3, 0.3 * 1.4], 0.5) < 1e-15, "{angle}");
    }
    let r = [0.3, 4.0];
    let system = Pendula { r, turn: [1.0, 0.0], coupling: 0.0 };
    let potential = |a: &SVector<f64, 2>, b: &SVector<f64, 2>| {
        let (d, q) = (b - a, (a + b) * 0.5);
        let lag = [r[0] * h / 2.0, r[1] * h / 2.8].map(|z| 1.0 / z.tanh() - 1.0 / z);
        0.25 * (r[0] * d[0] * d[0] + r[1] * d[1] * d[1])
            + h * (lag[0] * q[0].cos() + lag[1] * 2.0 * q[1].cos())
    };
    let f = ClosedForm::<Fitted, 2>::discrete_force(&system, &Segment::between(&q0, &q1, h));
    for i in 0..2 {
        let mut e = SVector::<f64, 2>::zeros();
        e[i] = 1e-5;
        let by_q0 = (potential(&(q0 + e), &q1) - potential(&(q0 - e), &q1)) / 2e-5;
        let by_q1 = (potential(&q0, &(q1 + e)) - potential(&q0, &(q1 - e))) / 2e-5;
        assert!((by_q0 - f.minus[i]).abs() < 1e-9 && (by_q1 + f.plus[i]).abs() < 1e-9, "{i}: {f:?}");
    }
}

/// Without damping they are midpoint and trapezoidal rule, and go there as C does.
#[test]
fn they_tend_to_the_plain_rules_without_damping() {
    let differences = [1e-2, 1e-4, 0.0].map(|share| {
        let system = Three { m: M, c: C.map(|entry| share * entry), k: 2.1 };
        let change = |a: State<f64, 3>, b: State<f64, 3>| (a.q - b.q).amax().max((a.p - b.p).amax());
        [
            change(step(&system, Fitted, &STATE, 0.3), step(&system, Midpoint, &STATE, 0.3)),
            change(step(&system, FittedTrapezoidal, &STATE, 0.3), step(&system, Trapezoidal, &STATE, 0.3)),
        ]
    });
    // ℒ(z) is of order z, Z coth Z − 1 of order z².
    for (rule, power) in [(0, 1), (1, 2)] {
        let [large, small, none] = differences.map(|of| of[rule]);
        let ratio = large / small / 100.0_f64.powi(power);
        assert!((0.8..1.25).contains(&ratio) && none < 1e-14, "{large:e} {small:e} {none:e}");
    }
}

/// A run, which keeps what depends on h alone, goes where single steps go; also over changes of h, and from
/// another state.
#[test]
fn a_run_goes_where_single_steps_go() {
    fn same<R: Copy>(system: &Three, rule: R, sizes: [f64; 4])
    where
        Three: Discrete<R, 3, Scalar = f64>,
    {
        let mut run = system.by(rule, 0.1).run(STATE);
        let mut state = STATE;
        for h in sizes {
            run.change_step_size(h);
            for _ in 0..30 {
                let single = step(system, rule, &state, h);
                state = run.next().unwrap().unwrap().state;
                let away = (single.q - state.q).amax().max((single.p - state.p).amax());
                assert!(away < 1e-14 * (1.0 + state.p.amax()), "{h}: {away:e}");
            }
        }
        // The control: what is kept for one h is not what another one needs.
        let other = step(system, rule, &STATE, 0.1001);
        let end = step(system, rule, &STATE, 0.1);
        assert!((other.p - end.p).amax() > 1e-6);
    }
    let (mild, stiff) =
        (Three { m: M, c: C, k: 2.1 }, Three { m: M, c: C.map(|entry| 30.0 * entry), k: 2.1 });
    same(&mild, Fitted, [0.1, 0.05, -0.1, 0.1]);
    same(&mild, FittedTrapezoidal, [0.1, 0.05, -0.1, 0.1]);
    same(&stiff, Fitted, [0.1, 0.05, 0.02, 0.1]);
    same(&stiff, FittedTrapezoidal, [0.1, 0.05, 0.02, 0.1]);
}

/// With a bound on its iterations a step is the same where the bound suffices, and says so where it does not.
#[test]
fn steps_within_a_bound() {
    let system = Three { m: M, c: C, k: 2.1 };
    let whole = step(&system, Fitted, &STATE, 0.3);
    let bounded = system.by(Fitted, 0.3).step_within(&STATE, 8).unwrap();
    assert!(bounded.converged && (bounded.step.state.q - whole.q).amax() < 1e-15);
    assert!(!system.by(Fitted, 0.3).step_within(&STATE, 1).unwrap().converged);
    // One correction solves the explicit one.
    let once = system.by(FittedTrapezoidal, 0.3).step_within(&STATE, 1).unwrap();
    assert!(once.converged);
}

/// What is not finite, or has no positive definite mass, is named; the run then goes on from its last state.
#[test]
fn faults_are_named() {
    let odd = Three { m: [1.0, 2.0, 0.0, 1.0, 0.0, 1.0], c: C, k: 0.0 };
    assert!(odd.by(Fitted, 0.1).step(&STATE).is_err());
    let system = Three { m: M, c: C, k: 2.1 };
    for h in [0.0, f64::NAN, f64::INFINITY] {
        let mut run = system.by(FittedTrapezoidal, 0.1).run(STATE);
        assert!(run.by_ref().take(3).all(|step| step.is_ok()));
        let before = *run.state();
        run.change_step_size(h);
        assert!(matches!(run.next(), Some(Err(dalembert::StepError::StepSize { .. }))));
        assert_eq!(*run.state(), before);
        run.change_step_size(0.1);
        let (next, expected) =
            (run.next().unwrap().unwrap().state, step(&system, FittedTrapezoidal, &before, 0.1));
        assert!((next.q - expected.q).amax() < 1e-15 && (next.p - expected.p).amax() < 1e-15);
    }
}

/// No damping at all in one direction, stiff damping in another: Z with eigenvalues 0 and 1e4, and M full.
#[test]
fn singular_damping_matrices() {
    // C = u uᵀ
    let u = vector![0.5, -0.2, 0.8];
    let c = u * u.transpose() * 1e4;
    let c = [c[(0, 0)], c[(0, 1)], c[(0, 2)], c[(1, 1)], c[(1, 2)], c[(2, 2)]];
    let system = Three { m: M, c, k: 0.0 };
    let end = step(&system, Fitted, &STATE, 0.5);
    // Momentum along vectors w with w·u = 0 is kept; the velocity along u is gone.
    for w in [vector![0.2, 0.5, 0.0], vector![0.8, 0.0, -0.5]] {
        assert!((w.dot(&end.p) - w.dot(&STATE.p)).abs() < 1e-10, "{}", w.dot(&end.p));
    }
    let v: SVector<f64, 3> = full(M).try_inverse().unwrap() * end.p;
    assert!(u.dot(&v).abs() < 1e-10, "{}", u.dot(&v));
    // The control: by the midpoint rule it is not.
    let v = full(M).try_inverse().unwrap() * step(&system, Midpoint, &STATE, 0.5).p;
    assert!(u.dot(&v).abs() > 1e-2);
}
