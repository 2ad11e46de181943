//! Derivatives of the step by its input, by parameters and twice: against central differences, closed forms,
//! the other engine and the identities of the step matrix, for all rules, with friction, time and inputs that
//! act nonlinearly.

/// The systems, with the options named.
macro_rules! systems {
    ($($options:tt)*) => {
        use dalembert::rayleigh_system;

        /// A cart on a rail with a pole, pushed by u; q is (position, angle of the pole from below).
        #[derive(Clone, Copy)]
        pub struct CartPole {
            pub m: [f64; 2],
            pub l: f64,
            pub g: f64,
            pub c: [f64; 2],
        }

        #[rayleigh_system(rule = [midpoint, trapezoidal, gauss], step_derivatives = second, $($options)*)]
        impl CartPole {
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let [cart, pole] = self.m;
                let kinetic = 0.5 * (cart + pole) * v[0] * v[0]
                    + pole * self.l * q[1].cos() * v[0] * v[1]
                    + 0.5 * pole * self.l * self.l * v[1] * v[1];
                kinetic + pole * self.g * self.l * q[1].cos()
            }

            fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                0.5 * (self.c[0] * (1.0 + q[0] * q[0]) * v[0] * v[0] + self.c[1] * v[1].powi(4))
            }

            fn force(&self, q: [f64; 2], v: [f64; 2], u: [f64; 2], t: f64) -> [f64; 2] {
                [u[0] * (1.0 + self.m[1] * q[1]) - u[1] * u[1] * v[0], (t + q[0]).sin() * u[1] * v[1] * v[1]]
            }
        }
    };
}

/// Derivatives written out.
mod expanded {
    systems!(derivatives = expanded, parameters = [m[1], l, c[0], c[1]]);
}

/// Derivatives by num-dual.
mod num_dual {
    systems!(derivatives = num_dual);
}

use dalembert::derivative::{PhaseMatrix, StepHessian};
use dalembert::nalgebra::{SMatrix, SVector, matrix, vector};
use dalembert::rules::Quadrature;
use dalembert::step::Flow;
use dalembert::step::{DiscreteDriven, DiscreteParameters, DiscreteRayleigh, DiscreteSecondOrder, Segment};
use dalembert::system::{Parameters, SecondOrder};
use dalembert::{
    Discrete, Discretise, Gauss, Lagrangian, Midpoint, Rayleigh, State, Trapezoidal, rayleigh_system,
};
use dalembert_tests::simpson::Simpson;
use expanded::CartPole;

const CART: CartPole = CartPole { m: [1.2, 0.4], l: 0.7, g: 9.81, c: [0.3, 0.2] };
const U: [f64; 2] = [0.8, -0.6];
const T: f64 = 0.35;
const H: f64 = 0.11;
const Q0: SVector<f64, 2> = vector![0.3, 0.9];
const Q1: SVector<f64, 2> = vector![0.42, 0.75];

/// (q0, p0, u) as one vector.
type Point = SVector<f64, 6>;

/// (q1, p1) from (q0, p0, u).
fn stepped<R>(cart: &CartPole, z: &Point) -> SVector<f64, 4>
where
    for<'a> expanded::DrivenCartPole<'a>: Discrete<R, 2, Scalar = f64>,
{
    let state = State { q: vector![z[0], z[1]], p: vector![z[2], z[3]] };
    let guess = (Q1 - Q0) / H;
    let State { q, p } =
        Flow::<R, 2>::step(&cart.driven([z[4], z[5]], T), &state, H, Some(&guess)).unwrap().state;
    vector![q[0], q[1], p[0], p[1]]
}

/// The point whose step ends at Q1.
fn point<R>(cart: &CartPole, rule: R) -> Point
where
    for<'a> expanded::DrivenCartPole<'a>: Discrete<R, 2, Scalar = f64>,
{
    let driven = cart.driven(U, T);
    let State { q, p } =
        Discretise::by(&driven, rule, H).segment(&Q0, &Q1).unwrap().legendre_minus().unwrap();
    vector![q[0], q[1], p[0], p[1], U[0], U[1]]
}

/// A and B side by side.
fn jacobian<R: Copy>(
    cart: &CartPole,
    rule: R,
    u: [f64; 2],
    q0: &SVector<f64, 2>,
    q1: &SVector<f64, 2>,
) -> SMatrix<f64, 4, 6>
where
    for<'a> expanded::DrivenCartPole<'a>: DiscreteDriven<R, 2, 2, Scalar = f64>,
{
    let driven = cart.driven(u, T);
    let step = driven.by(rule, H).segment(q0, q1).unwrap().linearized().unwrap();
    let (a, b) = (step.by_state().unwrap().assembled::<4>(), step.by_input::<2>().unwrap().assembled::<4>());
    SMatrix::from_fn(|i, j| if j < 4 { a[(i, j)] } else { b[(i, j - 4)] })
}

fn check_first<R: Copy>(rule: R)
where
    for<'a> expanded::DrivenCartPole<'a>: DiscreteDriven<R, 2, 2, Scalar = f64>,
{
    let exact = jacobian(&CART, rule, U, &Q0, &Q1);
    let z = point(&CART, rule);
    let width = 1e-5;
    for j in 0..6 {
        let mut shift = Point::zeros();
        shift[j] = width;
        let difference =
            (stepped::<R>(&CART, &(z + shift)) - stepped::<R>(&CART, &(z - shift))) / (2.0 * width);
        // Truncation (1e-5)² times third derivatives, rounding 1e-16/1e-5.
        assert!((exact.column(j) - difference).amax() < 3e-9 * exact.amax(), "{j}: {exact}{difference}");
    }
    // Positive control: B of another input is another matrix.
    assert!((jacobian(&CART, rule, [0.8, -0.5], &Q0, &Q1) - exact).amax() > 1e-3);
}

#[test]
fn a_and_b_are_the_derivatives_of_the_step() {
    check_first(Midpoint);
    check_first(Trapezoidal);
    check_first(Gauss::<1>);
    check_first(Gauss::<2>);
    check_first(Gauss::<4>);
    check_first(Quadrature(Simpson));
}

fn check_second<R: Copy>(rule: R)
where
    for<'a> expanded::DrivenCartPole<'a>:
        DiscreteDriven<R, 2, 2, Scalar = f64> + DiscreteSecondOrder<R, 2, 2>,
{
    let covector = State { q: vector![0.7, -1.1], p: vector![0.4, 0.9] };
    let contracted = |z: &Point| {
        let end = stepped::<R>(&CART, z);
        let (q0, q1, u) = (vector![z[0], z[1]], vector![end[0], end[1]], [z[4], z[5]]);
        jacobian(&CART, rule, u, &q0, &q1).transpose()
            * vector![covector.q[0], covector.q[1], covector.p[0], covector.p[1]]
    };
    let found = CART
        .driven(U, T)
        .by(rule, H)
        .segment(&Q0, &Q1)
        .unwrap()
        .linearized()
        .unwrap()
        .hessian(&covector)
        .unwrap();
    let found = assembled(&found);
    let z = point(&CART, rule);
    let width = 1e-5;
    for j in 0..6 {
        let mut shift = Point::zeros();
        shift[j] = width;
        let difference = (contracted(&(z + shift)) - contracted(&(z - shift))) / (2.0 * width);
        assert!((found.column(j) - difference).amax() < 1e-8 * found.amax(), "{j}: {found}{difference}");
    }
    assert!((found - found.transpose()).amax() < 1e-13 * found.amax());
    // Positive control: every block is there to be wrong.
    for (row, column) in [(0, 0), (0, 2), (2, 2), (0, 4), (2, 4), (4, 4)] {
        assert!(found.fixed_view::<2, 2>(row, column).amax() > 1e-5, "{row} {column} {found}");
    }
}

fn assembled(h: &StepHessian<f64, 2, 2>) -> SMatrix<f64, 6, 6> {
    let mut all = SMatrix::<f64, 6, 6>::zeros();
    for (row, column, block) in
        [(0, 0, h.qq), (0, 2, h.qp), (2, 2, h.pp), (0, 4, h.qu), (2, 4, h.pu), (4, 4, h.uu)]
    {
        all.fixed_view_mut::<2, 2>(row, column).copy_from(&block);
        all.fixed_view_mut::<2, 2>(column, row).copy_from(&block.transpose());
    }
    all
}

#[test]
fn second_derivatives_are_those_of_a_and_b() {
    check_second(Midpoint);
    check_second(Trapezoidal);
    check_second(Gauss::<1>);
    check_second(Gauss::<2>);
    check_second(Gauss::<4>);
    check_second(Quadrature(Simpson));
}

fn check_engines<R: Copy>(rule: R)
where
    for<'a> expanded::DrivenCartPole<'a>:
        DiscreteDriven<R, 2, 2, Scalar = f64> + DiscreteSecondOrder<R, 2, 2>,
    for<'a> num_dual::DrivenCartPole<'a>:
        DiscreteDriven<R, 2, 2, Scalar = f64> + DiscreteSecondOrder<R, 2, 2>,
{
    let CartPole { m, l, g, c } = CART;
    let oracle = num_dual::CartPole { m, l, g, c };
    let covector = State { q: vector![0.7, -1.1], p: vector![0.4, 0.9] };
    let (a, b) = (CART.driven(U, T), oracle.driven(U, T));
    let first = (
        a.by(rule, H).segment(&Q0, &Q1).unwrap().linearized().unwrap(),
        b.by(rule, H).segment(&Q0, &Q1).unwrap().linearized().unwrap(),
    );
    let by_state =
        first.0.by_state().unwrap().assembled::<4>() - first.1.by_state().unwrap().assembled::<4>();
    let by_input = first.0.by_input::<2>().unwrap() + first.1.by_input::<2>().unwrap() * -1.0;
    assert!(by_state.amax() < 1e-13 && by_input.assembled::<4>().amax() < 1e-14);
    let second = [
        assembled(
            &a.by(rule, H).segment(&Q0, &Q1).unwrap().linearized().unwrap().hessian(&covector).unwrap(),
        ),
        assembled(
            &b.by(rule, H).segment(&Q0, &Q1).unwrap().linearized().unwrap().hessian(&covector).unwrap(),
        ),
    ];
    assert!((second[0] - second[1]).amax() < 1e-13 * second[0].amax());
    let later = CART.driven(U, T + 1e-6);
    let later = assembled(
        &later.by(rule, H).segment(&Q0, &Q1).unwrap().linearized().unwrap().hessian(&covector).unwrap(),
    );
    assert!((second[1] - later).amax() > 1e-12 * later.amax(), "positive control");
}

#[test]
fn the_engines_agree() {
    check_engines(Midpoint);
    check_engines(Trapezoidal);
    check_engines(Gauss::<1>);
    check_engines(Gauss::<2>);
    check_engines(Gauss::<4>);
    // The contracted Hessians themselves.
    let CartPole { m, l, g, c } = CART;
    let oracle = num_dual::CartPole { m, l, g, c };
    let (a, b, vector_a, vector_b) =
        (CART.driven(U, T), oracle.driven(U, T), vector![0.3, -0.8], vector![1.1, 0.2]);
    let pairs = [
        (
            a.lagrangian_along(&Q0, &Q1, &vector_a, &vector_b),
            b.lagrangian_along(&Q0, &Q1, &vector_a, &vector_b),
        ),
        (a.rayleigh_along(&Q0, &Q1, &vector_a, &vector_b), b.rayleigh_along(&Q0, &Q1, &vector_a, &vector_b)),
        (a.force_along(&Q0, &Q1, &vector_a), b.force_along(&Q0, &Q1, &vector_a)),
    ];
    for (a, b) in pairs {
        for (a, b) in
            [(a.d11, b.d11), (a.d12, b.d12), (a.d22, b.d22), (a.d1u, b.d1u), (a.d2u, b.d2u), (a.duu, b.duu)]
        {
            assert!((a - b).amax() < 1e-14 * (1.0 + a.amax()), "{a}{b}");
        }
    }
}

fn check_parameters<R: Copy>(rule: R)
where
    for<'a> expanded::DrivenCartPole<'a>: DiscreteParameters<R, 2, 4, Scalar = f64>,
{
    let z = point(&CART, rule);
    let exact = CART
        .driven(U, T)
        .by(rule, H)
        .segment(&Q0, &Q1)
        .unwrap()
        .linearized()
        .unwrap()
        .by_parameters()
        .unwrap()
        .assembled::<4>();
    let moved = |index: usize, shift: f64| {
        let mut cart = CART;
        match index {
            0 => cart.m[1] += shift,
            1 => cart.l += shift,
            index => cart.c[index - 2] += shift,
        }
        stepped::<R>(&cart, &z)
    };
    let width = 1e-5;
    for j in 0..4 {
        let difference = (moved(j, width) - moved(j, -width)) / (2.0 * width);
        assert!((exact.column(j) - difference).amax() < 1e-9 * exact.amax(), "{j}: {exact}{difference}");
        // Positive control.
        assert!(exact.column(j).amax() > 1e-5 && (exact.column((j + 1) % 4) - difference).amax() > 1e-5);
    }
}

#[test]
fn parameters_move_the_step_as_differences_say() {
    check_parameters(Midpoint);
    check_parameters(Trapezoidal);
    check_parameters(Gauss::<1>);
    check_parameters(Gauss::<2>);
    check_parameters(Gauss::<4>);
    check_parameters(Quadrature(Simpson));
    assert_eq!(<expanded::DrivenCartPole as Parameters<2, 4>>::PARAMETERS, ["m[1]", "l", "c[0]", "c[1]"]);
}

/// The parameters as further coordinates: num-dual differentiates by them as by any other.
#[rayleigh_system(derivatives = num_dual)]
fn extended(q: [f64; 6], v: [f64; 6], cart: f64, g: f64) -> (f64, f64) {
    let [pole, l] = [q[2], q[3]];
    let kinetic = 0.5 * (cart + pole) * v[0] * v[0]
        + pole * l * q[1].cos() * v[0] * v[1]
        + 0.5 * pole * l * l * v[1] * v[1];
    let drag = 0.5 * (q[4] * (1.0 + q[0] * q[0]) * v[0] * v[0] + q[5] * v[1].powi(4));
    (kinetic + pole * g * l * q[1].cos(), drag)
}

#[test]
fn derivatives_by_parameters_are_those_of_num_dual() {
    let CartPole { m, l, g, c } = CART;
    let oracle = Extended { cart: m[0], g };
    let v = vector![-0.7, 1.3];
    let (q_all, v_all) =
        (vector![Q0[0], Q0[1], m[1], l, c[0], c[1]], vector![v[0], v[1], 0.0, 0.0, 0.0, 0.0]);
    let driven = CART.driven(U, T);
    for (found, oracle) in [
        (driven.lagrangian_by_parameters(&Q0, &v), oracle.lagrangian_derivatives(&q_all, &v_all)),
        (driven.rayleigh_by_parameters(&Q0, &v), oracle.rayleigh_derivatives(&q_all, &v_all)),
    ] {
        let by_q: SMatrix<f64, 2, 4> = oracle.d11.fixed_view::<2, 4>(0, 2).into();
        let by_v: SMatrix<f64, 2, 4> = oracle.d12.fixed_view::<4, 2>(2, 0).transpose();
        assert!((found.d1 - by_q).amax() < 1e-14 && (found.d2 - by_v).amax() < 1e-14, "{}{by_q}", found.d1);
        assert!(by_q.amax() > 0.01 && by_v.amax() > 0.01, "positive control");
    }
    // f₀ = u₀ (1 + m₁ q₁) + …
    let expected = matrix![U[0] * Q0[1], 0.0, 0.0, 0.0; 0.0, 0.0, 0.0, 0.0];
    assert_eq!(driven.force_by_parameters(&Q0, &v), expected);
}

/// m q̈ + r q̇ + k q = u, in closed form.
struct Oscillator {
    m: f64,
    k: f64,
    r: f64,
}

#[rayleigh_system(parameters = [m, k, r], step_derivatives = second)]
impl Oscillator {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * self.m * v[0] * v[0] - 0.5 * self.k * q[0] * q[0]
    }

    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.5 * self.r * v[0] * v[0]
    }

    fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
        u
    }
}

#[test]
fn the_linear_oscillator_in_closed_form() {
    let (m, k, r, h, u) = (1.3, 2.1, 0.4, 0.2, 0.7);
    let system = Oscillator { m, k, r };
    let driven = system.driven([u]);
    let state = State { q: vector![0.6], p: vector![-0.9] };
    let (q, p) = (state.q[0], state.p[0]);
    let q1 = driven.by(Midpoint, h).step(&state).unwrap().state.q;
    let step = driven.by(Midpoint, h).segment(&state.q, &q1).unwrap().linearized().unwrap();
    let found = (step.by_state().unwrap().assembled::<2>(), step.by_input::<1>().unwrap().assembled::<2>());
    // mathematics: q1 = (4hp + (4m − kh² + 2hr) q + 2h² u)/D and p1 = p − h(k q̄ + r v̄ − u).
    let d = 4.0 * m + h * h * k + 2.0 * h * r;
    let a = matrix![4.0 * m - k * h * h + 2.0 * h * r, 4.0 * h; -4.0 * h * k * m, 4.0 * m - h * h * k - 2.0 * h * r]
        / d;
    let b = vector![2.0 * h * h / d, h - h * (k * h / 2.0 + r) * 2.0 * h / d];
    assert!((found.0 - a).amax() < 4e-16, "{}", found.0 - a);
    assert!((found.1 - b).amax() < 4e-16);

    // By m, k, r: v̄ = (p − (h/2)(k q − u))/(D/4), q1 = q + h v̄, p1 = p − h(k (q + h v̄/2) + r v̄ − u).
    let v = (p - h / 2.0 * (k * q - u)) * 4.0 / d;
    let v_by = vector![-4.0 * v / d, -(h / 2.0 * q + h * h / 4.0 * v) * 4.0 / d, -h / 2.0 * v * 4.0 / d];
    let by = step.by_parameters().unwrap();
    for j in 0..3 {
        let direct = [0.0, -h * (q + h * v / 2.0), -h * v][j];
        let p_by = direct - h * (k * h / 2.0 + r) * v_by[j];
        assert!((by.q[j] - h * v_by[j]).abs() < 1e-15 && (by.p[j] - p_by).abs() < 1e-15, "{j}");
    }
    // A linear step has no second derivatives.
    let second = step.hessian(&state).unwrap();
    assert_eq!((second.qq[0], second.qp[0], second.pp[0], second.uu[0]), (0.0, 0.0, 0.0, 0.0));
}

/// AᵀΩA = Ω without friction, whatever the input: a force that is constant is a potential one.
#[test]
fn an_input_alone_leaves_the_step_symplectic() {
    let omega = matrix![0.0, 1.0; -1.0, 0.0];
    for r in [0.0, 0.5] {
        let system = Oscillator { m: 1.3, k: 2.1, r };
        let pushed = system.driven([0.7]);
        let segment = pushed.by(Midpoint, 0.2).segment(&vector![0.1], &vector![0.2]).unwrap();
        let a = segment.linearized().unwrap().by_state().unwrap().assembled::<2>();
        let defect = (a.transpose() * omega * a - omega).amax();
        assert_eq!(defect > 1e-2, r > 0.0, "{defect}");
        assert!(r > 0.0 || defect < 1e-15);
        // det A = det(D1D2 L_d⁻)/det(D1D2 L_d⁺), the input's force having no derivative by q.
        let driven = system.driven([0.7]);
        let segment = Segment::between(&vector![0.1], &vector![0.2], 0.2);
        let plus = DiscreteRayleigh::<Midpoint, 1>::modified_plus_derivatives(&driven, &segment).d12[0];
        let minus = DiscreteRayleigh::<Midpoint, 1>::modified_minus_derivatives(&driven, &segment).d12[0];
        assert!((a.determinant() - minus / plus).abs() < 1e-15);
    }
}

/// A system without u or t has second derivatives and parameters of its own.
struct Plain {
    k: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal], parameters = k, step_derivatives = second)]
impl Plain {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * (1.0 + q[0] * q[0]) * v[0] * v[0] - self.k.sqrt() * q[0].powi(4)
    }
}

#[test]
fn systems_without_inputs_have_second_derivatives_too() {
    let (system, h) = (Plain { k: 2.0 }, 0.1);
    let covector = State { q: vector![0.3], p: vector![1.1] };
    let state = system.by(Trapezoidal, h).legendre_minus(&vector![0.5], &vector![0.45]);
    let slope = |system: &Plain, q: f64, p: f64| {
        let moved = State { q: vector![q], p: vector![p] };
        let q1 = system.by(Trapezoidal, h).step(&moved).unwrap().state.q;
        let a = system
            .by(Trapezoidal, h)
            .segment(&moved.q, &q1)
            .unwrap()
            .linearized()
            .unwrap()
            .by_state()
            .unwrap();
        a.q_by_p[0] * covector.q[0] + a.p_by_p[0] * covector.p[0]
    };
    let found = system
        .by(Trapezoidal, h)
        .segment(&vector![0.5], &vector![0.45])
        .unwrap()
        .linearized()
        .unwrap()
        .hessian(&covector)
        .unwrap();
    let (q, p, width) = (state.q[0], state.p[0], 1e-5);
    let by_q = (slope(&system, q + width, p) - slope(&system, q - width, p)) / (2.0 * width);
    let by_p = (slope(&system, q, p + width) - slope(&system, q, p - width)) / (2.0 * width);
    assert!((found.qp[0] - by_q).abs() < 1e-9, "{} {by_q}", found.qp[0]);
    assert!((found.pp[0] - by_p).abs() < 1e-9, "{} {by_p}", found.pp[0]);
    let end = |k: f64| Plain { k }.by(Trapezoidal, h).step(&state).unwrap().state.p[0];
    let by_k = system
        .by(Trapezoidal, h)
        .segment(&vector![0.5], &vector![0.45])
        .unwrap()
        .linearized()
        .unwrap()
        .by_parameters()
        .unwrap()
        .p[0];
    let difference = (end(2.0 + width) - end(2.0 - width)) / (2.0 * width);
    assert!((by_k - difference).abs() < 1e-9 && by_k.abs() > 1e-3);
}

/// The maps to and from velocities are inverse to each other, and those of the states.
#[test]
fn velocities_and_momenta_have_their_jacobians() {
    let (q, v) = (Q0, vector![-0.7, 1.3]);
    let there = PhaseMatrix::from_velocity(&CART, &q, &v).assembled::<4>();
    let back = PhaseMatrix::to_velocity(&CART, &q, &v).unwrap().assembled::<4>();
    assert!((there * back - SMatrix::<f64, 4, 4>::identity()).amax() < 1e-14);
    let p = State::from_velocity(&CART, q, v).unwrap().p;
    let width = 1e-6;
    for j in 0..4 {
        let moved = |shift: f64| {
            let mut x = vector![q[0], q[1], p[0], p[1]];
            x[j] += shift;
            let state = State { q: vector![x[0], x[1]], p: vector![x[2], x[3]] };
            let v = state.velocity(&CART).unwrap();
            vector![x[0], x[1], v[0], v[1]]
        };
        let difference = (moved(width) - moved(-width)) / (2.0 * width);
        assert!((back.column(j) - difference).amax() < 1e-8, "{j} {back}{difference}");
    }
    // Positive control: the mass depends on q.
    assert!(back.fixed_view::<2, 2>(2, 0).amax() > 0.1);
    // A coordinate without a mass has no velocity.
    struct Massless;
    #[rayleigh_system]
    impl Massless {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            q[0] * v[0]
        }
    }
    assert!(matches!(
        PhaseMatrix::to_velocity(&Massless, &vector![1.0], &vector![0.0]),
        Err(dalembert::StepError::DegenerateLagrangian { column: 0 })
    ));
}

/// The oscillator in single precision.
struct Single {
    m: f32,
    k: f32,
    r: f32,
}

#[rayleigh_system(rule = [midpoint, trapezoidal], parameters = [m, k, r], step_derivatives = second)]
impl Single {
    fn lagrangian(&self, q: [f32; 1], v: [f32; 1]) -> f32 {
        0.5 * self.m * v[0] * v[0] - 0.5 * self.k * q[0] * q[0]
    }

    fn rayleigh(&self, v: [f32; 1]) -> f32 {
        0.5 * self.r * v[0] * v[0]
    }

    fn force(&self, q: [f32; 1], _v: [f32; 1], u: [f32; 1]) -> [f32; 1] {
        [u[0] * (1.0 + 0.0 * q[0])]
    }
}

#[test]
fn single_precision_has_them_too() {
    let (m, k, r, h, u) = (1.3, 2.1, 0.4, 0.2, 0.7);
    let (single, double) = (Single { m, k, r }, Oscillator { m: 1.3, k: 2.1, r: 0.4 });
    let (single, double) = (single.driven([u]), double.driven([0.7]));
    let a = single.by(Midpoint, h).segment(&vector![0.6], &vector![0.5]).unwrap().linearized().unwrap();
    let b = double.by(Midpoint, 0.2).segment(&vector![0.6], &vector![0.5]).unwrap().linearized().unwrap();
    let by_state = b.by_state().unwrap().assembled::<2>();
    assert!((a.by_state().unwrap().assembled::<2>().cast::<f64>() - by_state).amax() < 1e-6);
    let by_input = b.by_input::<1>().unwrap().assembled::<2>();
    assert!((a.by_input::<1>().unwrap().assembled::<2>().cast::<f64>() - by_input).amax() < 1e-7);
    let (a, b) = (a.by_parameters().unwrap(), b.by_parameters().unwrap());
    assert!((a.assembled::<2>().cast::<f64>() - b.assembled::<2>()).amax() < 1e-7);
}
