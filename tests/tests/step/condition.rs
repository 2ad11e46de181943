//! The condition number that a step's certificate states, against condition numbers computed otherwise.
//!
//! The Newton matrix comes from its closed form, from Padé's approximation of the exponential, or from
//! differences of the momentum; its inverse and its singular values from nalgebra. Dense, banded and Gauss
//! systems of 1 to 8 coordinates.

use dalembert::nalgebra::{DMatrix, SMatrix, SVector, vector};
use dalembert::step::{Fused, NewtonMatrix, Segment};
use dalembert::system::Function;
use dalembert::{
    Discrete, Discretise, Fitted, Gauss, Lagrangian, Midpoint, State, StepError, Trapezoidal, rayleigh_system,
};

/// ‖DAD‖₁ ‖(DAD)⁻¹‖₁ with D = diag(1/√mᵢ).
fn condition<const N: usize>(matrix: &SMatrix<f64, N, N>, masses: &SVector<f64, N>) -> f64 {
    let scaled = DMatrix::from_fn(N, N, |i, j| matrix[(i, j)] / (masses[i] * masses[j]).sqrt());
    // By singular values, so that no elimination is repeated.
    let inverse = scaled.clone().pseudo_inverse(0.0).unwrap();
    let norm = |a: &DMatrix<f64>| a.column_iter().map(|column| column.lp_norm(1)).fold(0.0, f64::max);
    norm(&scaled) * norm(&inverse)
}

fn certified<S, R: Copy, const N: usize>(system: &S, rule: R, state: &State<f64, N>, h: f64) -> f64
where
    S: Discrete<R, N, Scalar = f64>,
{
    let step = system.by(rule, h).step(state).unwrap();
    system.by(rule, h).certificate(state, &step).unwrap().condition
}

/// ∂p0/∂v̄ by central differences of the momentum, which no step kernel computes.
fn by_differences<S, R: Copy, const N: usize>(
    system: &S,
    rule: R,
    q: &SVector<f64, N>,
    v: &SVector<f64, N>,
    h: f64,
) -> SMatrix<f64, N, N>
where
    S: Discrete<R, N, Scalar = f64>,
{
    let e = 1e-5;
    SMatrix::from_fn(|i, j| {
        let at = |change: f64| {
            let mut v = *v;
            v[j] += change;
            system.by(rule, h).segment(q, &(q + v * h)).unwrap().momenta().unwrap().p0[i]
        };
        (at(e) - at(-e)) / (2.0 * e)
    })
}

/// The step of Gauss' rule of `stages` stages for ẏ = By is Padé's approximation of e^{hB}.
fn pade<const K: usize>(b: &SMatrix<f64, K, K>, stages: u32) -> SMatrix<f64, K, K> {
    let (mut above, mut below) = (SMatrix::<f64, K, K>::zeros(), SMatrix::<f64, K, K>::zeros());
    let (mut coefficient, mut power) = (1.0, SMatrix::<f64, K, K>::identity());
    for k in 0..=stages {
        let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
        above += power * coefficient;
        below += power * (sign * coefficient);
        power *= b;
        coefficient *= f64::from(stages - k) / f64::from((2 * stages - k) * (k + 1));
    }
    below.try_inverse().unwrap() * above
}

macro_rules! chains {
    ($($module:ident $n:literal)*) => {
        $(#[allow(clippy::reversed_empty_ranges, reason = "one mass has no neighbours")]
        mod $module {
            use super::*;

            const N: usize = $n;

            /// Masses m(i + 1) and springs between walls, with friction between neighbours: banded from some
            /// n on.
            #[rayleigh_system(rule = [midpoint, trapezoidal, gauss, fitted])]
            pub fn springs(q: [f64; $n], v: [f64; $n], m: f64, k: f64, c: f64) -> (f64, f64) {
                let mut l = -0.5 * k * (q[0] * q[0] + q[$n - 1] * q[$n - 1]);
                let mut r = 0.5 * c * v[0] * v[0];
                for i in 0..$n {
                    l += 0.5 * m * (1.0 + i as f64) * v[i] * v[i];
                }
                for i in 1..$n {
                    l -= 0.5 * k * (q[i] - q[i - 1]) * (q[i] - q[i - 1]);
                    r += 0.5 * c * (v[i] - v[i - 1]) * (v[i] - v[i - 1]);
                }
                (l, r)
            }

            /// A full mass matrix that depends on q.
            #[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
            pub fn full(q: [f64; $n], v: [f64; $n], k: f64) -> f64 {
                let total: f64 = v.iter().zip(q).map(|(v, q)| v * q.cos()).sum();
                let mut l = 0.5 * total * total;
                for i in 0..$n {
                    l += (0.5 + i as f64) * v[i] * v[i] + k * (q[i] + 0.1 * i as f64).cos();
                }
                l
            }

            fn springs_matrices(m: f64, k: f64, c: f64) -> [SMatrix<f64, N, N>; 3] {
                let mut laplacian = SMatrix::<f64, N, N>::zeros();
                for i in 1..N {
                    laplacian[(i, i)] += 1.0;
                    laplacian[(i - 1, i - 1)] += 1.0;
                    laplacian[(i, i - 1)] -= 1.0;
                    laplacian[(i - 1, i)] -= 1.0;
                }
                let (mut stiffness, mut damping) = (laplacian * k, laplacian * c);
                stiffness[(0, 0)] += k;
                stiffness[(N - 1, N - 1)] += k;
                damping[(0, 0)] += c;
                let masses = SVector::<f64, N>::from_fn(|i, _| m * (1.0 + i as f64));
                [SMatrix::from_diagonal(&masses), stiffness, damping]
            }

            fn state() -> State<f64, N> {
                State {
                    q: SVector::from_fn(|i, _| 0.3 - 0.2 * i as f64),
                    p: SVector::from_fn(|i, _| 0.4 + 0.3 * i as f64),
                }
            }

            /// M + (h/2)C + (h²/4)K by the midpoint rule, M + (h/2)C by the trapezoidal one.
            #[test]
            fn of_a_chain_of_springs() {
                for (m, h, k, c) in [(1.3, 0.1, 2.0, 0.3), (1e-9, 0.1, 1e5, 0.0), (2.0, 0.5, 1e9, 1e3)] {
                    let system = Springs { m, k, c };
                    let [mass, stiffness, damping] = springs_matrices(m, k, c);
                    let drag = mass + damping * (0.5 * h);
                    let midpoint = drag + stiffness * (0.25 * h * h);
                    let masses = mass.diagonal();
                    for (found, exact) in [
                        (certified(&system, Midpoint, &state(), h), condition(&midpoint, &masses)),
                        (certified(&system, Trapezoidal, &state(), h), condition(&drag, &masses)),
                    ] {
                        // Rounding of a matrix enters its condition number times as large.
                        assert!((found / exact - 1.0).abs() < 1e-13 * exact + 1e-12, "{found:e} {exact:e}");
                    }
                    // A norm's choice matters by N at most: κ₂/N ≤ κ₁ ≤ N κ₂.
                    let found = certified(&system, Midpoint, &state(), h);
                    let values = DMatrix::from_fn(N, N, |i, j| midpoint[(i, j)] / (masses[i] * masses[j]).sqrt())
                        .singular_values();
                    let spectral = values.max() / values.min();
                    assert!(found <= 1.0001 * N as f64 * spectral && 1.0001 * found * N as f64 >= spectral);
                }
            }

            /// The stages eliminated: ∂p0/∂v̄ = h (∂q1/∂p0)⁻¹ of Padé's approximation.
            #[test]
            fn of_gauss_on_the_chain() {
                for (h, k, c) in [(0.1, 2.0, 0.3), (0.5, 40.0, 5.0)] {
                    let system = Springs { m: 1.3, k, c };
                    let [mass, stiffness, damping] = springs_matrices(1.3, k, c);
                    let inverse = mass.try_inverse().unwrap();
                    let mut b = SMatrix::<f64, { 2 * $n }, { 2 * $n }>::zeros();
                    b.fixed_view_mut::<N, N>(0, N).copy_from(&(inverse * h));
                    b.fixed_view_mut::<N, N>(N, 0).copy_from(&(stiffness * -h));
                    b.fixed_view_mut::<N, N>(N, N).copy_from(&(damping * inverse * -h));
                    let exact = |stages| {
                        let step = pade(&b, stages);
                        let q1_by_p0: SMatrix<f64, N, N> = step.fixed_view::<N, N>(0, N).into_owned();
                        condition(&(q1_by_p0.try_inverse().unwrap() * h), &mass.diagonal())
                    };
                    for (found, exact) in [
                        (certified(&system, Gauss::<2>, &state(), h), exact(2)),
                        (certified(&system, Gauss::<3>, &state(), h), exact(3)),
                    ] {
                        assert!((found / exact - 1.0).abs() < 1e-10, "{found} {exact}");
                    }
                }
            }

            /// Where L is not quadratic, by differences of the momentum.
            #[test]
            fn of_a_full_mass_matrix() {
                fn both<R: Copy>(rule: R, h: f64, k: f64)
                where
                    Full: Discrete<R, N, Scalar = f64>,
                {
                    let system = Full { k };
                    let step = system.by(rule, h).step(&state()).unwrap();
                    let found = system.by(rule, h).certificate(&state(), &step).unwrap().condition;
                    let matrix = by_differences(&system, rule, &state().q, &step.velocity, h);
                    let masses = system.lagrangian_derivatives(&state().q, &step.velocity).d22.diagonal();
                    let exact = condition(&matrix, &masses);
                    assert!((found / exact - 1.0).abs() < 1e-6 * exact, "{found} {exact}");
                }
                for (h, k) in [(0.05, 0.3), (0.2, 3.0)] {
                    both(Midpoint, h, k);
                    both(Trapezoidal, h, k);
                    both(Gauss::<2>, h, k);
                }
            }

            /// The fitted rule's matrix, by differences.
            #[test]
            fn of_a_fitted_rule() {
                let (system, h) = (Springs { m: 1.3, k: 20.0, c: 30.0 }, 0.3);
                let step = system.by(Fitted, h).step(&state()).unwrap();
                let matrix = by_differences(&system, Fitted, &state().q, &step.velocity, h);
                let exact = condition(&matrix, &springs_matrices(1.3, 0.0, 0.0)[0].diagonal());
                let found = system.by(Fitted, h).certificate(&state(), &step).unwrap().condition;
                assert!((found / exact - 1.0).abs() < 1e-7 * exact, "{found} {exact}");
            }
        })*
    };
}

chains! { one 1 two 2 three 3 four 4 five 5 six 6 seven 7 eight 8 }

/// The chains of more than a few springs are banded, as said.
#[test]
fn the_chains_are_of_both_forms() {
    fn width<M: NewtonMatrix<f64, 8>>(_: &M) -> usize {
        size_of::<M>() / (8 * size_of::<f64>())
    }
    let at_rest = SVector::<f64, 8>::zeros();
    let kernel = Fused::<Midpoint, 8>::step_kernel(
        &eight::Springs { m: 1.0, k: 1.0, c: 0.0 },
        &Segment { q0: at_rest, v: at_rest, h: 0.1 },
    );
    assert_eq!(width(&kernel.matrix), 3);
    let kernel = Fused::<Midpoint, 8>::step_kernel(
        &eight::Full { k: 1.0 },
        &Segment { q0: at_rest, v: at_rest, h: 0.1 },
    );
    assert_eq!(width(&kernel.matrix), 8);
}

/// Masses on the off-diagonal alone: no unit to measure in, and the condition is 1.
#[rayleigh_system]
fn crossed(q: [f64; 2], v: [f64; 2]) -> f64 {
    v[0] * v[1] - 0.0 * (q[0] + q[1])
}

#[rayleigh_system]
fn nearly_singular(q: [f64; 2], v: [f64; 2], m: f64) -> f64 {
    0.5 * (v[0] + v[1]) * (v[0] + v[1]) + 0.5 * m * v[1] * v[1] - 0.0 * (q[0] + q[1])
}

#[rayleigh_system]
fn wall(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] - q[0].abs().powf(1.5)
}

#[test]
fn at_the_edges() {
    let state = State { q: vector![0.1, 0.2], p: vector![0.3, 0.4] };
    assert_eq!(certified(&Crossed {}, Midpoint, &state, 0.1), 1.0);
    // [[1, 1], [1, 1 + m]] in units of its diagonal: det = m, so that κ ≈ 4/m.
    for m in [1e-2, 1e-4, 1e-8] {
        let found = certified(&NearlySingular { m }, Midpoint, &state, 0.1);
        assert!((found * m / 4.0 - 1.0).abs() < m + 1e-6, "{m}: {found:e}");
    }
    // Derivatives that do not exist return a named `StepError`: at q̄ = 0, exactly, the curvature is
    // infinite.
    let state = State { q: vector![1.0], p: vector![0.3] };
    let mut step = Wall {}.by(Midpoint, 0.5).step(&state).unwrap();
    assert!(Wall {}.by(Midpoint, 0.5).certificate(&state, &step).is_ok());
    step.velocity = vector![-4.0];
    let found = Wall {}.by(Midpoint, 0.5).certificate(&state, &step);
    assert!(
        matches!(found, Err(StepError::NoDerivative { function: Function::Lagrangian, .. })),
        "{found:?}"
    );
}

/// So many digits are lost, and hardly more: v̄ of a step in `f64` against its exact value, for conditions up
/// to 1e12.
#[test]
fn the_digits_lost_are_those_it_says() {
    let mut worst = 0.0_f64;
    for exponent in [2, 4, 6, 8, 10, 12] {
        let m = 10.0_f64.powi(-exponent);
        let system = NearlySingular { m };
        for k in 0..40 {
            let x = 0.1 + 0.0371 * f64::from(k);
            let state = State { q: vector![0.0, 0.0], p: vector![x, 0.7 * x] };
            let step = system.by(Midpoint, 0.1).step(&state).unwrap();
            let condition = system.by(Midpoint, 0.1).certificate(&state, &step).unwrap().condition;
            // v₁ + v₂ = p₁, m v₂ = p₂ − p₁; the difference of two neighbours is exact.
            let exact = (state.p[1] - state.p[0]) / m;
            let error = ((step.velocity[1] - exact) / exact).abs();
            assert!(error < condition * f64::EPSILON, "{m:e}: {error:e} {condition:e}");
            worst = worst.max(error / (condition * f64::EPSILON));
        }
    }
    // It is no empty bound.
    assert!(worst > 1e-3, "{worst:e}");
}
