//! The step matrix A = ∂(q1, p1)/∂(q0, p0): its determinant and what it does to Ω.
//!
//! ```text
//! det A = det(D1D2 L_d⁻)/det(D1D2 L_d⁺)
//! AᵀΩA = Ω without force;   AᵀΩA − Ω = Tᵀ(F − Fᵀ)T with,   Ω = [[0, I], [−I, 0]]
//! F = ∂(f⁻, f⁺)/∂(q0, q1),   T = ∂(q0, q1)/∂(q0, p0)
//! ```
//!
//! A and T come from differences of the step; L_d^± and F from the hand-written system.

use dalembert::nalgebra::{DMatrix, DVector, SVector};
use dalembert::system::Derivatives;
use dalembert::{Discrete, Midpoint, State, Trapezoidal};
use dalembert_tests::by_hand::{ByHand, Discretised, Part, Rule, derivatives};
use dalembert_tests::systems::{Bead, Chain, Charge, DoublePendulum, Follower, FreePendulum, Pendulum};

const H: f64 = 0.3;

/// What the differences leave: O(δ⁶) truncation, and rounding ε/δ.
const DIFFERENCES: f64 = 1e-10;

/// A, T, and the segment (q0, q1).
struct StepMatrix<const N: usize> {
    a: DMatrix<f64>,
    t: DMatrix<f64>,
    q0: [f64; N],
    q1: [f64; N],
}

/// By central differences of sixth order.
fn step_matrix<S, R, const N: usize>(system: &S, q: [f64; N], p: [f64; N]) -> StepMatrix<N>
where
    S: Discrete<R, N, Scalar = f64>,
{
    let image = |x: &DVector<f64>| {
        let state = State {
            q: SVector::<f64, N>::from_fn(|i, _| x[i]),
            p: SVector::<f64, N>::from_fn(|i, _| x[N + i]),
        };
        let after = system.step(&state, H, None).unwrap().state;
        DVector::from_fn(2 * N, |i, _| if i < N { after.q[i] } else { after.p[i - N] })
    };
    let start = DVector::from_iterator(2 * N, q.into_iter().chain(p));
    let delta = 4e-3;
    let mut a = DMatrix::zeros(2 * N, 2 * N);
    for column in 0..2 * N {
        let at = |factor: f64| {
            let mut moved = start.clone();
            moved[column] += factor * delta;
            image(&moved)
        };
        let odd = |factor: f64| at(factor) - at(-factor);
        a.set_column(column, &((odd(1.0) * 45.0 - odd(2.0) * 9.0 + odd(3.0)) / (60.0 * delta)));
    }
    let mut t = DMatrix::identity(2 * N, 2 * N);
    t.rows_mut(N, N).copy_from(&a.rows(0, N));
    let q1 = image(&start);
    StepMatrix { a, t, q0: q, q1: std::array::from_fn(|i| q1[i]) }
}

fn omega(n: usize) -> DMatrix<f64> {
    DMatrix::from_fn(2 * n, 2 * n, |i, j| f64::from(i32::from(j == i + n) - i32::from(i == j + n)))
}

/// AᵀΩA − Ω.
fn symplectic_defect<const N: usize>(matrix: &StepMatrix<N>) -> DMatrix<f64> {
    matrix.a.transpose() * omega(N) * &matrix.a - omega(N)
}

/// F of the hand-written system, R's part and the general force together.
fn force_matrix<S: ByHand<N>, const N: usize>(
    system: &S,
    rule: Rule,
    q0: [f64; N],
    q1: [f64; N],
) -> DMatrix<f64> {
    let of = |part| derivatives(&Discretised { system, rule, h: H, part }, q0, q1);
    let r = of(Part::Rayleigh);
    let minus: [Derivatives<f64, N>; N] = std::array::from_fn(|i| of(Part::ForceMinus(i)));
    let plus: [Derivatives<f64, N>; N] = std::array::from_fn(|i| of(Part::ForcePlus(i)));
    DMatrix::from_fn(2 * N, 2 * N, |row, column| {
        let (i, j) = (row % N, column % N);
        match (row < N, column < N) {
            (true, true) => minus[i].d1[j] + r.d11[(i, j)],
            (true, false) => minus[i].d2[j] + r.d12[(i, j)],
            (false, true) => plus[i].d1[j] - r.d12[(j, i)],
            (false, false) => plus[i].d2[j] - r.d22[(i, j)],
        }
    })
}

/// Deviation of det A from det(D1D2 L_d⁻)/det(D1D2 L_d⁺), relative.
fn determinant_defect<S: ByHand<N>, const N: usize>(system: &S, rule: Rule, matrix: &StepMatrix<N>) -> f64 {
    let determinant = |part| {
        let d12 = derivatives(&Discretised { system, rule, h: H, part }, matrix.q0, matrix.q1).d12;
        DMatrix::from_fn(N, N, |i, j| d12[(i, j)]).determinant()
    };
    (matrix.a.determinant() / (determinant(Part::Minus) / determinant(Part::Plus)) - 1.0).abs()
}

/// The identities on a system whose force comes from R alone.
fn check_rayleigh<S, const N: usize>(system: &S, q: [f64; N], p: [f64; N])
where
    S: ByHand<N> + Discrete<Midpoint, N, Scalar = f64> + Discrete<Trapezoidal, N>,
{
    for (rule, matrix) in [
        (Rule::Midpoint, step_matrix::<_, Midpoint, N>(system, q, p)),
        (Rule::Trapezoidal, step_matrix::<_, Trapezoidal, N>(system, q, p)),
    ] {
        let defect = determinant_defect(system, rule, &matrix);
        assert!(defect <= DIFFERENCES, "{rule:?}: det A off by {defect:e}");
        // Positive control: without friction det A would be 1.
        assert!((matrix.a.determinant() - 1.0).abs() > 1e-2, "{}", matrix.a.determinant());
    }
}

/// The identity on Ω, on any system.
fn check_omega<S, const N: usize>(system: &S, q: [f64; N], p: [f64; N])
where
    S: ByHand<N> + Discrete<Midpoint, N, Scalar = f64> + Discrete<Trapezoidal, N>,
{
    for (rule, matrix) in [
        (Rule::Midpoint, step_matrix::<_, Midpoint, N>(system, q, p)),
        (Rule::Trapezoidal, step_matrix::<_, Trapezoidal, N>(system, q, p)),
    ] {
        let f = force_matrix(system, rule, matrix.q0, matrix.q1);
        let expected = matrix.t.transpose() * (&f - f.transpose()) * &matrix.t;
        let defect = symplectic_defect(&matrix);
        let off = (&defect - &expected).amax();
        assert!(off <= DIFFERENCES, "{rule:?}: AᵀΩA − Ω off by {off:e}{defect}{expected}");
        // Positive control: the force does change Ω.
        assert!(defect.amax() > 1e-2, "{defect}");
    }
}

/// AᵀΩA = Ω and det A = 1 on a system without force.
fn check_symplectic<S, const N: usize>(system: &S, q: [f64; N], p: [f64; N])
where
    S: Discrete<Midpoint, N, Scalar = f64> + Discrete<Trapezoidal, N>,
{
    for matrix in
        [step_matrix::<_, Midpoint, N>(system, q, p), step_matrix::<_, Trapezoidal, N>(system, q, p)]
    {
        let defect = symplectic_defect(&matrix).amax();
        assert!(defect <= DIFFERENCES, "{defect:e}");
        assert!((matrix.a.determinant() - 1.0).abs() <= DIFFERENCES);
    }
}

#[test]
fn its_determinant_is_that_of_the_modified_lagrangians() {
    check_rayleigh(&Pendulum::EXAMPLE, [1.9], [-0.7]);
    check_rayleigh(&Bead::EXAMPLE, [0.8], [1.3]);
    check_rayleigh(&DoublePendulum::EXAMPLE, [1.1, -0.6], [0.3, 0.5]);
    check_rayleigh(&Chain::EXAMPLE, [0.5, -0.2, 0.7, 0.1, -0.6], [0.0, 0.9, -0.3, 0.4, 0.2]);
}

#[test]
fn it_changes_the_symplectic_form_by_the_force() {
    check_omega(&Pendulum::EXAMPLE, [1.9], [-0.7]);
    check_omega(&Bead::EXAMPLE, [0.8], [1.3]);
    check_omega(&DoublePendulum::EXAMPLE, [1.1, -0.6], [0.3, 0.5]);
    check_omega(&Follower::EXAMPLE, [0.6, -0.9], [0.8, 0.5]);
    check_omega(&Charge::EXAMPLE, [0.9, -0.4, 0.6], [0.2, 1.1, -0.7]);
    check_omega(&Chain::EXAMPLE, [0.5, -0.2, 0.7, 0.1, -0.6], [0.0, 0.9, -0.3, 0.4, 0.2]);
}

#[test]
fn it_keeps_the_symplectic_form_without_force() {
    check_symplectic(&FreePendulum { m: 1.3, g: 2.1 }, [1.9], [-0.7]);
    check_symplectic(&DoublePendulum::FREE, [1.1, -0.6], [0.3, 0.5]);
    check_symplectic(&Charge::FREE, [0.9, -0.4, 0.6], [0.2, 1.1, -0.7]);
}

/// Positive control: the matrix of one explicit Euler step of the pendulum is seen not to be symplectic.
#[test]
fn explicit_euler_does_not_keep_the_symplectic_form() {
    let FreePendulum { m, g } = FreePendulum { m: 1.3, g: 2.1 };
    let q = 1.9_f64;
    let a = DMatrix::from_row_slice(2, 2, &[1.0, H / m, -H * m * g * q.cos(), 1.0]);
    let matrix = StepMatrix { a, t: DMatrix::identity(2, 2), q0: [q], q1: [q] };
    assert!(symplectic_defect(&matrix).amax() > 1e-2);
}

/// Thirty bodies on a line with a Lennard-Jones potential between each two: 435 pairs, written out.
mod pairs {
    use dalembert::nalgebra::SVector;
    use dalembert::{Discretise, Lagrangian, Midpoint, State, rayleigh_system};

    struct Bodies {
        m: f64,
    }

    #[rayleigh_system(derivatives = expanded, rule = midpoint)]
    impl Bodies {
        fn lagrangian(&self, q: [f64; 30], v: [f64; 30]) -> f64 {
            let mut l = 0.0;
            for i in 0..30 {
                l += 0.5 * self.m * v[i] * v[i];
                for j in 0..i {
                    let s = 1.0 / (q[i] - q[j]).powi(6);
                    l -= 4.0 * (s * s - s);
                }
            }
            l
        }
    }

    /// The force by hand, over the pairs up to `reach` bodies apart.
    fn force(q: &SVector<f64, 30>, reach: usize) -> SVector<f64, 30> {
        SVector::from_fn(|i, _| {
            let others = (0..30).filter(|&j| j != i && i.abs_diff(j) <= reach);
            others
                .map(|j| {
                    let r = q[i] - q[j];
                    24.0 * (2.0 * r.powi(-12) - r.powi(-6)) / r
                })
                .sum()
        })
    }

    #[test]
    fn a_sum_over_435_pairs_steps_by_the_force_written_by_hand() {
        let (system, h) = (Bodies { m: 1.7 }, 0.01);
        let q = SVector::<f64, 30>::from_fn(|i, _| 1.15 * i as f64 + 0.05 * (2.0 * i as f64).sin());
        let v = SVector::<f64, 30>::from_fn(|i, _| 0.3 * (1.3 * i as f64).cos());
        let start = State::from_velocity(&system, q, v).unwrap();
        let (mut own, mut without_far) = (0.0_f64, 0.0_f64);
        let mut last = start;
        for state in system.by(Midpoint, h).run(start).take(50) {
            let state = state.unwrap().state;
            let (middle, change) = (0.5 * (last.q + state.q), state.p - last.p);
            let largest = force(&middle, 29).amax();
            own = own.max((change / h - force(&middle, 29)).amax() / largest);
            without_far = without_far.max((change / h - force(&middle, 28)).amax() / largest);
            let drift = (state.q - last.q) / h - 0.5 * (last.p + state.p) / system.m;
            assert!(drift.amax() < 1e-11, "{drift}");
            last = state;
        }
        assert!((last.q - start.q).amax() > 0.05);
        assert!(own < 1e-10, "{own:e}");
        // One pair of 435 fewer is seen, by far.
        assert!(without_far > 10.0 * own, "{without_far:e} {own:e}");

        // The Hessian by central differences of the force by hand.
        let hessian = system.lagrangian_derivatives(&last.q, &v).d11;
        let d = 1e-5;
        for j in 0..30 {
            let mut shift = SVector::<f64, 30>::zeros();
            shift[j] = d;
            let column = (force(&(last.q + shift), 29) - force(&(last.q - shift), 29)) / (2.0 * d);
            assert!((hessian.column(j) - column).amax() < 1e-6 * hessian.amax(), "{j}");
        }
    }
}
