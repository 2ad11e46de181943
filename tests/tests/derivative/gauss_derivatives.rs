//! Derivatives of the Gauss step in closed form, by both engines: of a linear system with input and time,
//! whose step is a Padé approximant of the exponential, and of a chain of integrators, whose step is exact.
//! Central differences stand in `linearization.rs` and `sensitivities.rs`.

/// The systems, with the options named.
macro_rules! systems {
    ($engine:ident $(, $parameters:tt)?) => {
        use dalembert::rayleigh_system;

        /// Linear in q, v, u and t: a mass matrix with coupling, a gyroscopic term, springs, dampers, a
        /// circulatory force.
        #[derive(Clone, Copy)]
        pub struct Linear {
            pub m: [f64; 2],
            pub gyro: f64,
            pub k: [f64; 2],
            pub c: [f64; 2],
            pub curl: f64,
            pub ramp: f64,
        }

        #[rayleigh_system(rule = [midpoint, gauss], step_derivatives = second, derivatives = $engine $(, parameters = $parameters)?)]
        impl Linear {
            pub const COUPLING: f64 = 0.3;

            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                0.5 * (self.m[0] * v[0] * v[0] + self.m[1] * v[1] * v[1])
                    + Self::COUPLING * v[0] * v[1]
                    + self.gyro * q[0] * v[1]
                    - 0.5 * self.k[0] * q[0] * q[0]
                    - 0.5 * self.k[1] * (q[1] - q[0]) * (q[1] - q[0])
            }

            fn rayleigh(&self, v: [f64; 2]) -> f64 {
                0.5 * (self.c[0] * v[0] * v[0] + self.c[1] * (v[1] - v[0]) * (v[1] - v[0]))
            }

            fn force(&self, q: [f64; 2], _v: [f64; 2], u: [f64; 2], t: f64) -> [f64; 2] {
                [self.curl * q[1] + u[0], -self.curl * q[0] + 0.5 * u[0] - 2.0 * u[1] + self.ramp * t]
            }
        }

        /// x is pushed by u, and y by t x².
        pub struct Integrators;

        #[rayleigh_system(rule = gauss, step_derivatives = second, derivatives = $engine)]
        impl Integrators {
            fn lagrangian(&self, _q: [f64; 2], v: [f64; 2]) -> f64 {
                0.5 * (v[0] * v[0] + v[1] * v[1])
            }

            fn force(&self, q: [f64; 2], _v: [f64; 2], u: [f64; 1], t: f64) -> [f64; 2] {
                [u[0], t * q[0] * q[0]]
            }
        }
    };
}

/// Derivatives written out.
mod expanded {
    systems!(expanded, [m[0], c[1], k[1]]);
}

/// Derivatives by num-dual.
mod num_dual {
    systems!(num_dual);
}

use dalembert::derivative::{PhaseMatrix, StateBy, StepHessian, StepTaken};
use dalembert::nalgebra::{DMatrix, DVector, SMatrix, SVector, matrix, vector};
use dalembert::step::{DiscreteDriven, DiscreteSecondOrder, Linearizable};
use dalembert::system::Function;
use dalembert::{Discretise, Gauss, Midpoint, State, StepError, rayleigh_system};

/// A and B of a step.
fn a_and_b<L, R, const M: usize>(taken: &StepTaken<'_, L, R, 2>) -> (PhaseMatrix<f64, 2>, StateBy<f64, 2, M>)
where
    L: DiscreteDriven<R, 2, M, Scalar = f64>,
{
    (taken.by_state().unwrap(), taken.by_input().unwrap())
}

/// The step between two ends.
fn between<'a, L, R>(
    system: &'a L,
    rule: R,
    h: f64,
    [q0, q1]: [&SVector<f64, 2>; 2],
) -> StepTaken<'a, L, R, 2>
where
    L: Linearizable<R, 2, Scalar = f64>,
{
    system.by(rule, h).segment(q0, q1).unwrap().linearized().unwrap()
}

/// The diagonal Padé approximant of exp(Z) of degree s: what Gauss collocation makes of z' = Z z.
fn pade(s: usize, z: &DMatrix<f64>) -> DMatrix<f64> {
    let (mut numerator, mut denominator) = (DMatrix::identity(z.nrows(), z.nrows()), z * 0.0);
    let (mut power, mut coefficient) = (numerator.clone(), 1.0);
    denominator += &numerator;
    for j in 1..=s {
        coefficient *= (s + 1 - j) as f64 / ((2 * s + 1 - j) * j) as f64;
        power = &power * z;
        numerator += &power * coefficient;
        denominator += &power * if j % 2 == 0 { coefficient } else { -coefficient };
    }
    denominator.lu().solve(&numerator).unwrap()
}

/// The approximant itself: e to the rounding of s = 8, and (1 + z/2)/(1 − z/2).
#[test]
fn the_approximant_is_that_of_the_literature() {
    let of = |s: usize, z: f64| pade(s, &DMatrix::from_element(1, 1, z))[0];
    assert!((of(8, 1.0) - 1.0_f64.exp()).abs() < 1e-15);
    assert!((of(1, 0.3) - 1.15 / 0.85).abs() < 1e-15);
    // Hairer and Wanner, Solving Ordinary Differential Equations II, table IV.3.1.
    let z = 0.7_f64;
    let two = (1.0 + z / 2.0 + z * z / 12.0) / (1.0 - z / 2.0 + z * z / 12.0);
    assert!((of(2, z) - two).abs() < 1e-15);
}

const LINEAR: expanded::Linear =
    expanded::Linear { m: [1.3, 0.8], gyro: 0.7, k: [2.1, 1.4], c: [0.4, 0.6], curl: 0.5, ramp: 0.9 };
const U: [f64; 2] = [0.8, -0.6];
const T: f64 = 0.35;

/// The matrix Z of d/dt (q, p, u, t, 1) = Z (q, p, u, t, 1), and its derivative by m₀, c₁, k₁.
fn linear_flow(system: &expanded::Linear) -> [DMatrix<f64>; 4] {
    type Square = SMatrix<f64, 2, 2>;
    let expanded::Linear { m, gyro, k, c, curl, ramp } = *system;
    let coupling = expanded::Linear::COUPLING;
    // p = M v + G q, ṗ = (Gᵀ − C) v + (N − K) q.
    let inverse = matrix![m[0], coupling; coupling, m[1]].try_inverse().unwrap();
    let g = matrix![0.0, 0.0; gyro, 0.0];
    let pair = matrix![1.0, -1.0; -1.0, 1.0];
    let first = matrix![1.0, 0.0; 0.0, 0.0];
    let drag = g.transpose() - first * c[0] - pair * c[1];
    let spring = matrix![0.0, curl; -curl, 0.0] - first * k[0] - pair * k[1];
    let blocks = |qq: Square, qp: Square, pq: Square, pp: Square| {
        let mut z = DMatrix::zeros(8, 8);
        for (row, column, block) in [(0, 0, qq), (0, 2, qp), (2, 0, pq), (2, 2, pp)] {
            z.view_mut((row, column), (2, 2)).copy_from(&block);
        }
        z
    };
    let mut flow = blocks(-inverse * g, inverse, spring - drag * inverse * g, drag * inverse);
    flow.view_mut((2, 4), (2, 2)).copy_from(&matrix![1.0, 0.0; 0.5, -2.0]);
    (flow[(3, 6)], flow[(6, 7)]) = (ramp, 1.0);
    let by = |inverse_by: Square, drag_by: Square, spring_by: Square| {
        let product = drag_by * inverse + drag * inverse_by;
        blocks(-inverse_by * g, inverse_by, spring_by - product * g, product)
    };
    let zero = Square::zeros();
    [flow, by(-inverse * first * inverse, zero, zero), by(zero, -pair, zero), by(zero, zero, -pair)]
}

const START: State<f64, 2> = State { q: vector![0.6, -0.4], p: vector![-0.9, 0.7] };

fn both<const S: usize>(
    view: &(impl DiscreteDriven<Gauss<S>, 2, 2, Scalar = f64> + DiscreteSecondOrder<Gauss<S>, 2, 2>),
    h: f64,
) {
    let exact = pade(S, &(&linear_flow(&LINEAR)[0] * h));
    let end = &exact * DVector::from_column_slice(&[0.6, -0.4, -0.9, 0.7, U[0], U[1], T, 1.0]);
    let taken = view.by(Gauss::<S>, h).linearized(&START).unwrap();
    let (step, of_step) = (*taken.step(), a_and_b(&taken));
    let reached: SVector<f64, 4> = end.fixed_rows::<4>(0).into();
    let found = vector![step.state.q[0], step.state.q[1], step.state.p[0], step.state.p[1]];
    assert!((found - reached).amax() < 1e-14, "S = {S}, h = {h}: {:e}", (found - reached).amax());
    let of_segment = a_and_b(&between(view, Gauss::<S>, h, [&START.q, &step.state.q]));
    for (a, b) in [of_step, of_segment] {
        let a = a.assembled::<4>() - exact.fixed_view::<4, 4>(0, 0);
        let b = b.assembled::<4>() - exact.fixed_view::<4, 2>(0, 4);
        assert!(a.amax() < 4e-15 * (1.0 + exact.amax()), "S = {S}, h = {h}: {:e}", a.amax());
        assert!(b.amax() < 4e-15 * (1.0 + exact.amax()), "S = {S}, h = {h}: {:e}", b.amax());
    }
    // Without its input A as well.
    assert_eq!(view.by(Gauss::<S>, h).linearized_step(&START).unwrap(), (step, of_step.0));
    // A linear step has no second derivatives.
    let second = view
        .by(Gauss::<S>, h)
        .segment(&START.q, &step.state.q)
        .unwrap()
        .linearized()
        .unwrap()
        .hessian(&START)
        .unwrap();
    assert_eq!((second.qq.amax(), second.qp.amax(), second.pp.amax()), (0.0, 0.0, 0.0));
    assert_eq!((second.qu.amax(), second.pu.amax(), second.uu.amax()), (0.0, 0.0, 0.0));
    // Positive control: the approximant of another degree is another matrix, as far as they can be told
    // apart.
    if S < 6 && h > 1.0 {
        let other = pade(S + 1, &(&linear_flow(&LINEAR)[0] * h));
        assert!((other - exact).amax() > 1e-12, "S = {S}, h = {h}");
    }
}

fn parameters<const S: usize>(h: f64) {
    let [flow, by @ ..] = linear_flow(&LINEAR);
    let view = LINEAR.driven(U, T);
    let q1 = view.by(Gauss::<S>, h).step(&START).unwrap().state.q;
    let found =
        view.by(Gauss::<S>, h).segment(&START.q, &q1).unwrap().linearized().unwrap().by_parameters().unwrap();
    let found = found.assembled::<4>();
    let taken = view.by(Gauss::<S>, h).linearized(&START).unwrap();
    let (step, of_step) = (taken.step(), taken.by_parameters().unwrap().assembled::<4>());
    assert!(step.state.q == q1);
    // Between two ends the momentum is what leads to q1: rounding of q1 comes in enlarged, the more the
    // closer to a conjugate point.
    let exact = pade(S, &(&flow * h));
    let enlarged = exact.fixed_view::<2, 2>(0, 2).into_owned().try_inverse().unwrap().amax();
    for (j, by) in by.iter().enumerate() {
        // An analytic function of [Z, Z'; 0, Z] has its derivative along Z' in the corner.
        let mut pair = DMatrix::zeros(16, 16);
        for (row, column, block) in [(0, 0, &flow), (8, 8, &flow), (0, 8, by)] {
            pair.view_mut((row, column), (8, 8)).copy_from(&(block * h));
        }
        let derivative = pade(S, &pair).view((0, 8), (8, 8)).into_owned();
        let moved = &derivative * DVector::from_column_slice(&[0.6, -0.4, -0.9, 0.7, U[0], U[1], T, 1.0]);
        let miss = |of: &SMatrix<f64, 4, 3>| (of.column(j) - moved.fixed_rows::<4>(0)).amax();
        let of_ends = 2.0 * f64::EPSILON * (1.0 + derivative.amax()) * (1.0 + enlarged);
        assert!(miss(&of_step) < 4e-15 && moved.amax() > 1e-3, "S = {S}, h = {h}, {j}: {:e}", miss(&of_step));
        assert!(miss(&found) < of_ends, "S = {S}, h = {h}, {j}: {:e}, {of_ends:e}", miss(&found));
    }
}

#[test]
fn a_linear_step_and_its_derivatives_are_pade_approximants() {
    let expanded::Linear { m, gyro, k, c, curl, ramp } = LINEAR;
    let oracle = num_dual::Linear { m, gyro, k, c, curl, ramp };
    macro_rules! for_stages {
        ($($s:literal)*) => {$(
            for h in [0.2, 1.5, -0.3] {
                both::<$s>(&LINEAR.driven(U, T), h);
                both::<$s>(&oracle.driven(U, T), h);
                parameters::<$s>(h);
            }
        )*};
    }
    for_stages!(1 2 3 4 5 6 7 8);
}

/// x = x₀ + p τ + u τ²/2 is a polynomial of the stages' degree, and ∫ t x² dt within the quadrature's, from
/// S = 4 on.
#[test]
fn second_derivatives_of_exact_integrators() {
    let (h, t0) = (0.8_f64, 0.3);
    // ∫ (t0 + τ) τᵏ dτ, and the same under h − τ.
    let moment = |k: i32| t0 * h.powi(k + 1) / f64::from(k + 1) + h.powi(k + 2) / f64::from(k + 2);
    let lever = |k: i32| h * moment(k) - moment(k + 1);
    let covector = State { q: vector![5.0, 0.7], p: vector![-3.0, 1.1] };
    let m = |k: i32| covector.q[1] * lever(k) + covector.p[1] * moment(k);
    let (q0, p, u) = (vector![0.4, -0.2], 0.9, 0.6);
    let state = State { q: q0, p: vector![p, 0.5] };
    fn check<D>(view: &D, state: &State<f64, 2>, h: f64, covector: &State<f64, 2>, m: impl Fn(i32) -> f64)
    where
        D: DiscreteDriven<Gauss<4>, 2, 1, Scalar = f64> + DiscreteSecondOrder<Gauss<4>, 2, 1>,
    {
        let taken = view.by(Gauss::<4>, h).linearized(state).unwrap();
        let (step, of_step) = (taken.step(), taken.hessian(covector).unwrap());
        let found = view
            .by(Gauss::<4>, h)
            .segment(&state.q, &step.state.q)
            .unwrap()
            .linearized()
            .unwrap()
            .hessian(covector)
            .unwrap();
        for (a, b) in [(of_step.qq, found.qq), (of_step.qp, found.qp), (of_step.pp, found.pp)] {
            assert!((a - b).amax() < 1e-14);
        }
        assert!((of_step.qu - found.qu).amax() < 1e-14 && (of_step.uu - found.uu).amax() < 1e-14);
        for (found, expected) in [
            (found.qq[(0, 0)], 2.0 * m(0)),
            (found.qp[(0, 0)], 2.0 * m(1)),
            (found.pp[(0, 0)], 2.0 * m(2)),
            (found.qu[(0, 0)], m(2)),
            (found.pu[(0, 0)], m(3)),
            (found.uu[(0, 0)], 0.5 * m(4)),
        ] {
            assert!((found - expected).abs() < 1e-15 && expected.abs() > 1e-3, "{found} {expected}");
        }
        // y and its momentum enter linearly.
        let rest = [found.qq[(0, 1)], found.qq[(1, 1)], found.qp[(0, 1)], found.pp[(1, 1)], found.qu[(1, 0)]];
        assert!(rest.iter().all(|entry| entry.abs() < 1e-16), "{rest:?}");
    }
    check(&expanded::Integrators.driven([u], t0), &state, h, &covector, m);
    check(&num_dual::Integrators.driven([u], t0), &state, h, &covector, m);
}

/// One stage is the midpoint rule, with all of its derivatives.
#[test]
fn one_stage_has_the_derivatives_of_the_midpoint_rule() {
    let view = LINEAR.driven(U, T);
    let (q0, q1, h) = (START.q, vector![0.7, -0.1], 0.4);
    let gauss = a_and_b::<_, _, 2>(&between(&view, Gauss::<1>, h, [&q0, &q1]));
    let midpoint = a_and_b::<_, _, 2>(&between(&view, Midpoint, h, [&q0, &q1]));
    assert!((gauss.0.assembled::<4>() - midpoint.0.assembled::<4>()).amax() < 2e-15);
    assert!((gauss.1.assembled::<4>() - midpoint.1.assembled::<4>()).amax() < 2e-15);
    let state = view.by(Midpoint, h).legendre_minus(&q0, &q1);
    let (step, gauss) = view.by(Gauss::<1>, h).linearized_step(&state).unwrap();
    let (other, midpoint) = view.by(Midpoint, h).linearized_step(&state).unwrap();
    assert!((step.state.p - other.state.p).amax() < 2e-15 && (step.state.q - q1).amax() < 2e-15);
    assert!((gauss.assembled::<4>() - midpoint.assembled::<4>()).amax() < 2e-15);
    let gauss =
        view.by(Gauss::<1>, h).segment(&q0, &q1).unwrap().linearized().unwrap().by_parameters().unwrap();
    let midpoint =
        view.by(Midpoint, h).segment(&q0, &q1).unwrap().linearized().unwrap().by_parameters().unwrap();
    assert!((gauss.assembled::<4>() - midpoint.assembled::<4>()).amax() < 2e-15);
    // Positive control: two stages are another rule.
    let two =
        view.by(Gauss::<2>, h).segment(&q0, &q1).unwrap().linearized().unwrap().by_parameters().unwrap();
    assert!((two.assembled::<4>() - midpoint.assembled::<4>()).amax() > 1e-3);
}

/// A pendulum on a moving pivot, with a drag that depends on q, pushed by a torque that depends on its angle.
struct Swing;

#[rayleigh_system(rule = [midpoint, gauss], step_derivatives = second)]
impl Swing {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2], t: f64) -> f64 {
        0.5 * (1.2 + q[0].sin() * 0.3) * v[0] * v[0]
            + 0.6 * v[1] * v[1]
            + 0.2 * q[1].cos() * v[0] * v[1]
            + (1.0 + 0.3 * (2.0 * t).sin()) * (q[0] - 0.4 * q[1]).cos()
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.3 * v[0] * v[0] + 0.1 * v[1].powi(4)
    }

    fn force(&self, q: [f64; 2], v: [f64; 2], u: [f64; 1], t: f64) -> [f64; 2] {
        [u[0] * u[0] * q[1].sin() + t * v[1], u[0] * v[0] - 0.5 * q[0] * q[0] * v[1]]
    }
}

#[test]
fn one_stage_has_the_second_derivatives_of_the_midpoint_rule() {
    let (view, h) = (Swing.driven([0.7], 0.4), 0.3);
    let (q0, q1) = (vector![0.5, -0.8], vector![0.8, -0.5]);
    let covector = State { q: vector![0.7, -1.1], p: vector![0.4, 0.9] };
    let of = |h: StepHessian<f64, 2, 1>| {
        let mut all = SMatrix::<f64, 5, 5>::zeros();
        all.fixed_view_mut::<2, 2>(0, 0).copy_from(&h.qq);
        all.fixed_view_mut::<2, 2>(0, 2).copy_from(&h.qp);
        all.fixed_view_mut::<2, 2>(2, 2).copy_from(&h.pp);
        all.fixed_view_mut::<2, 1>(0, 4).copy_from(&h.qu);
        all.fixed_view_mut::<2, 1>(2, 4).copy_from(&h.pu);
        all[(4, 4)] = h.uu[0];
        all
    };
    let gauss = of(view
        .by(Gauss::<1>, h)
        .segment(&q0, &q1)
        .unwrap()
        .linearized()
        .unwrap()
        .hessian(&covector)
        .unwrap());
    let midpoint =
        of(view.by(Midpoint, h).segment(&q0, &q1).unwrap().linearized().unwrap().hessian(&covector).unwrap());
    assert!((gauss - midpoint).amax() < 1e-14 * midpoint.amax(), "{gauss}{midpoint}");
    assert!(midpoint.iter().filter(|entry| entry.abs() > 1e-6).count() == 17, "positive control: {midpoint}");
}

/// By every rule `of_step` is the step with what `of_segment` says of it.
#[test]
fn of_step_is_of_the_segment_that_the_step_takes() {
    fn close<const R: usize, const C: usize>(a: SMatrix<f64, R, C>, b: SMatrix<f64, R, C>) {
        assert!((a - b).amax() < 1e-13 * (1.0 + a.amax()) && a.amax() > 1e-3, "{a}{b}");
    }
    fn check<R: Copy>(rule: R)
    where
        for<'a> DrivenSwing<'a>: DiscreteDriven<R, 2, 1, Scalar = f64> + DiscreteSecondOrder<R, 2, 1>,
    {
        let (view, h) = (Swing.driven([0.7], 0.4), 0.3);
        let state = State { q: vector![0.5, -0.8], p: vector![0.9, 0.4] };
        let of_step = view.by(rule, h).linearized(&state).unwrap();
        let step = of_step.step();
        assert_eq!(*step, view.by(rule, h).step(&state).unwrap());
        let of_ends = between(&view, rule, h, [&state.q, &step.state.q]);
        let (a, b) = (a_and_b(&of_step), a_and_b(&of_ends));
        close(a.0.assembled::<4>(), b.0.assembled::<4>());
        close(a.1.assembled::<4>(), b.1.assembled::<4>());
        close(view.by(rule, h).linearized_step(&state).unwrap().1.assembled::<4>(), b.0.assembled());
        let (a, b) = (of_step.hessian(&state).unwrap(), of_ends.hessian(&state).unwrap());
        close(a.qq, b.qq);
        close(a.qp, b.qp);
        close(a.pu, b.pu);
        close(a.uu, b.uu);
    }
    check(Midpoint);
    check(Gauss::<1>);
    check(Gauss::<3>);
}

/// det A = det K10 / det(−K01), K10 and K01 from L_d and f_d, whose derivatives are differences of order 8.
#[test]
fn the_determinant_is_that_of_the_discrete_objects() {
    fn check<const S: usize>() {
        let (view, h) = (Swing.driven([0.7], 0.4), 0.3);
        let (q0, q1) = (vector![0.5, -0.8], vector![0.8, -0.5]);
        let segment = || view.by(Gauss::<S>, h).segment(&q0, &q1).unwrap();
        let a = segment().linearized().unwrap().by_state().unwrap();
        let l = segment().discrete_lagrangian_derivatives().unwrap();
        let f = segment().discrete_force_derivatives().unwrap();
        let (p1_by_q0, p1_by_q1) = (l.d12.transpose() + f.plus.d1, l.d22 + f.plus.d2);
        let expected = p1_by_q0.determinant() / (l.d12 + f.minus.d2).determinant();
        let determinant = a.assembled::<4>().determinant();
        assert!((determinant - expected).abs() < 1e-10, "S = {S}: {determinant} {expected}");
        // The exact blocks are those of the differences.
        let exact = segment().legendre_derivatives().unwrap();
        assert!((exact.p1_by_q0 - p1_by_q0).amax() < 1e-9 && (exact.p1_by_q1 - p1_by_q1).amax() < 1e-9);
        // Positive control: friction, and a ratio upside down.
        assert!((determinant - 1.0).abs() > 0.05 && (determinant - 1.0 / expected).abs() > 0.05);
    }
    check::<1>();
    check::<2>();
    check::<3>();
    check::<4>();
}

/// m q̈ + r q̇ + k q = 0.
#[rayleigh_system(rule = gauss)]
fn oscillator(q: [f64; 1], v: [f64; 1], m: f64, k: f64, r: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
}

/// Where the end does not move with p0, the step has its derivative, though its ends do not determine it: at
/// (ωh)² = 12 two stages turn the oscillator by half a turn, A = −1.
#[test]
fn a_step_has_a_derivative_where_its_ends_do_not_determine_it() {
    let oscillator = Oscillator { m: 1.0, k: 1.0, r: 0.0 };
    let (h, state) = (12.0_f64.sqrt(), State { q: vector![0.3], p: vector![-0.2] });
    let (step, a) = oscillator.by(Gauss::<2>, h).linearized_step(&state).unwrap();
    assert!((a.assembled::<2>() + SMatrix::<f64, 2, 2>::identity()).amax() < 1e-14);
    assert!((step.state.q + state.q).amax() < 1e-14);
    // Another momentum leads to the same end.
    let other = State { p: vector![5.0], ..state };
    let other = oscillator.by(Gauss::<2>, h).step(&other).unwrap().state;
    assert!((other.q + state.q).amax() < 1e-14 && (other.p + vector![5.0]).amax() < 1e-13);
}

/// Cubic drag: −p0 d + … has no real solution for some ends; what is asked of them is an error, not NaN.
#[test]
fn failures_have_names() {
    #[rayleigh_system(rule = gauss)]
    fn drag(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
        (0.5 * v[0] * v[0] - q[0].abs().powf(1.5), r * v[0] * v[0])
    }
    let (system, q0) = (Drag { r: 0.1 }, vector![0.0]);
    let zero_step = system.by(Gauss::<2>, 0.0).segment(&q0, &vector![0.1]).err();
    assert_eq!(zero_step, Some(StepError::StepSize { h: 0.0 }));
    let not_finite = system.by(Gauss::<2>, 0.1).segment(&q0, &vector![f64::NAN]).err();
    assert!(matches!(not_finite, Some(StepError::NonFinite { index: 0, .. })), "{not_finite:?}");
    // At rest at q = 0, where V'' is infinite, the step exists and its derivative does not.
    let rest = State { q: q0, p: vector![0.0] };
    assert!(system.by(Gauss::<2>, 0.1).step(&rest).is_ok());
    let cusp = system.by(Gauss::<2>, 0.1).linearized_step(&rest);
    assert!(
        matches!(cusp, Err(StepError::NoDerivative { function: Function::Lagrangian, coordinate: 0, .. })),
        "{cusp:?}"
    );
    // M − h²K/12 … singular: V = −12 q²/2 (s = 1: M + h²K/4 = 0 at k = −4/h²).
    let repelled = Oscillator { m: 1.0, k: -16.0, r: 0.0 };
    let singular = repelled.by(Gauss::<1>, 0.5).segment(&q0, &vector![0.2]).err();
    assert!(matches!(singular, Some(StepError::SingularNewtonMatrix { column: 0, .. })), "{singular:?}");
}
