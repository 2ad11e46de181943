//! The step of `Gauss<S>` is Gauss collocation on the forced Hamilton equations, and satisfies the forced
//! Galerkin equations.

use dalembert::nalgebra::{DMatrix, DVector, SVector, vector};
use dalembert::{Discrete, Discretise, Gauss, Midpoint, State, StepError, rayleigh_system};
use dalembert_tests::by_hand::{ByHand, Continuous, Part, derivatives};
use dalembert_tests::systems::{Bead, Chain, Charge, DoublePendulum, Follower, Pendulum};

/// Nodes, weights and a_ij = ∫₀^{c_i} ℓ_j on [0, 1], from linear systems: nothing of the crate's own
/// coefficients.
struct Collocation {
    c: Vec<f64>,
    b: Vec<f64>,
    a: DMatrix<f64>,
}

/// P_k(x).
fn legendre(k: usize, x: f64) -> f64 {
    let (mut before, mut last) = (1.0, x);
    match k {
        0 => before,
        _ => {
            for j in 1..k {
                let j = j as f64;
                (before, last) = (last, ((2.0 * j + 1.0) * x * last - j * before) / (j + 1.0));
            }
            last
        }
    }
}

impl Collocation {
    /// Nodes are the eigenvalues of the Jacobi matrix (Golub and Welsch), polished by Newton's method;
    /// weights and a_ij integrate the Legendre polynomials of degree below s.
    fn new(s: usize) -> Self {
        let beta = |k: usize| {
            let k = k as f64;
            k / (4.0 * k * k - 1.0).sqrt()
        };
        let jacobi = DMatrix::from_fn(s, s, |i, j| match i.abs_diff(j) {
            1 => beta(i.max(j)),
            _ => 0.0,
        });
        let mut x: Vec<f64> = jacobi.symmetric_eigenvalues().iter().copied().collect();
        x.sort_by(f64::total_cmp);
        for x in &mut x {
            for _ in 0..2 {
                let slope = s as f64 * (*x * legendre(s, *x) - legendre(s - 1, *x)) / (*x * *x - 1.0);
                *x -= legendre(s, *x) / slope;
            }
        }
        let values = DMatrix::from_fn(s, s, |k, j| legendre(k, x[j]));
        // ∫₀ᶜ P_k(2t − 1) dt = (P_{k+1} − P_{k−1})/(2(2k + 1)) at 2c − 1.
        let integrals = |x: f64| {
            DVector::from_fn(s, |k, _| match k {
                0 => (x + 1.0) / 2.0,
                _ => (legendre(k + 1, x) - legendre(k - 1, x)) / (4.0 * k as f64 + 2.0),
            })
        };
        let solver = values.lu();
        let of = |x: f64| solver.solve(&integrals(x)).unwrap();
        let rows: Vec<_> = x.iter().map(|&x| of(x)).collect();
        Self {
            c: x.iter().map(|x| (1.0 + x) / 2.0).collect(),
            b: of(1.0).iter().copied().collect(),
            a: DMatrix::from_fn(s, s, |i, j| rows[i][j]),
        }
    }
}

/// ∂L/∂v and G = ∂L/∂q − ∂R/∂v + f of the hand-written system, by hyper-dual numbers.
fn terms<L: ByHand<N>, const N: usize>(system: &L, q: [f64; N], v: [f64; N]) -> [SVector<f64, N>; 2] {
    let l = derivatives(&Continuous { system, part: Part::Lagrangian }, q, v);
    let r = derivatives(&Continuous { system, part: Part::Rayleigh }, q, v);
    [l.d2, l.d1 - r.d2 + SVector::from(system.force_by_hand(q, v))]
}

/// The forced Hamilton equations q̇ = v(q, p), ṗ = G(q, v(q, p)), with v found by Newton's method.
fn hamilton<L: ByHand<N>, const N: usize>(
    system: &L,
    q: &SVector<f64, N>,
    p: &SVector<f64, N>,
) -> [SVector<f64, N>; 2] {
    let mut v = SVector::<f64, N>::zeros();
    for _ in 0..20 {
        let l = derivatives(&Continuous { system, part: Part::Lagrangian }, (*q).into(), v.into());
        let correction = l.d22.try_inverse().unwrap() * (p - l.d2);
        v += correction;
        if correction.amax() <= 1e-16 * v.amax() {
            break;
        }
    }
    [v, terms(system, (*q).into(), v.into())[1]]
}

/// One step of the method by fixed-point iteration on the stages' slopes (k_q, k_p), and the stages (Q_i,
/// V_i).
fn collocated<L: ByHand<N>, const N: usize>(
    system: &L,
    method: &Collocation,
    q: SVector<f64, N>,
    p: SVector<f64, N>,
    h: f64,
) -> ([SVector<f64, N>; 2], Vec<[SVector<f64, N>; 2]>) {
    let s = method.c.len();
    let (mut slopes, mut before) = (vec![hamilton(system, &q, &p); s], f64::INFINITY);
    for _ in 0..200 {
        let next: Vec<_> = (0..s)
            .map(|i| {
                let at = |part: usize, start: SVector<f64, N>| {
                    (0..s).fold(start, |sum, j| sum + slopes[j][part] * (h * method.a[(i, j)]))
                };
                hamilton(system, &at(0, q), &at(1, p))
            })
            .collect();
        let change: f64 =
            next.iter().zip(&slopes).map(|(a, b)| (a[0] - b[0]).amax() + (a[1] - b[1]).amax()).sum();
        slopes = next;
        // Rounding alone is left where it falls no more.
        if change < 1e-17 || (change < 1e-13 && change >= before) {
            break;
        }
        before = change;
    }
    let end = |part: usize, start: SVector<f64, N>| {
        (0..s).fold(start, |sum, j| sum + slopes[j][part] * (h * method.b[j]))
    };
    let stages = (0..s)
        .map(|i| {
            let q = (0..s).fold(q, |sum, j| sum + slopes[j][0] * (h * method.a[(i, j)]));
            [q, slopes[i][0]]
        })
        .collect();
    ([end(0, q), end(1, p)], stages)
}

fn is_collocation<L, const N: usize, const S: usize>(system: &L, q: [f64; N], v: [f64; N], h: f64)
where
    L: ByHand<N> + Discrete<Gauss<S>, N, Scalar = f64>,
{
    let start = State { q: q.into(), p: system.momentum(q, v) };
    let step = system.by(Gauss::<S>, h).step(&start).unwrap();
    let ([q1, p1], _) = collocated(system, &Collocation::new(S), start.q, start.p, h);
    let (in_q, in_p) = ((step.state.q - q1).amax(), (step.state.p - p1).amax());
    assert!(in_q < 1e-14 && in_p < 2e-14, "S = {S}, h = {h}: {in_q:e} {in_p:e}");
    assert!((start.q + step.velocity * h - step.state.q).amax() < 1e-15 * (1.0 + q1.amax()));
}

macro_rules! for_stages {
    ($check:ident $arguments:tt, $n:literal, $($s:literal)*) => {
        $($check::<_, $n, $s> $arguments;)*
    };
}

#[test]
fn its_step_is_collocation_on_the_forced_hamilton_equations() {
    for &h in &[0.1, -0.2, 0.3][..if cfg!(debug_assertions) { 2 } else { 3 }] {
        for_stages!(is_collocation(&Bead::EXAMPLE, [0.8], [1.3], h), 1, 1 2 3 4 5 6 7 8);
        for_stages!(is_collocation(&DoublePendulum::EXAMPLE, [1.1, -0.6], [0.3, 1.2], h), 2, 1 2 3 4 5 6 7 8);
        for_stages!(is_collocation(&Follower::EXAMPLE, [0.6, -0.9], [0.8, 0.5], h), 2, 2 3 4);
        for_stages!(is_collocation(&Charge::EXAMPLE, [0.9, -0.4, 0.6], [0.2, 1.1, -0.7], h), 3, 1 2 3 4 5 6 7 8);
    }
    for_stages!(
        is_collocation(&Chain::EXAMPLE, [0.5, -0.2, 0.7, 0.1, -0.6], [0.0, 0.9, -0.3, 0.4, 0.2], 0.1),
        5,
        1 2 3 4 8
    );
}

/// Positive control: forces left out, or a coefficient changed, are seen.
#[test]
fn another_method_is_not_taken_for_it() {
    let (system, q, v, h) = (Charge::EXAMPLE, [0.9, -0.4, 0.6], [0.2, 1.1, -0.7], 0.3);
    let start = State { q: q.into(), p: system.momentum(q, v) };
    let step = system.by(Gauss::<3>, h).step(&start).unwrap();
    let unforced = collocated(&Charge::FREE, &Collocation::new(3), start.q, start.p, h).0;
    assert!((step.state.q - unforced[0]).amax() > 1e-3);
    let mut changed = Collocation::new(3);
    changed.a[(0, 2)] += 1e-10;
    let changed = collocated(&system, &changed, start.q, start.p, h).0;
    assert!((step.state.q - changed[0]).amax() > 1e-12);
}

#[test]
fn one_stage_is_the_midpoint_rule() {
    fn check<L, const N: usize>(system: &L, q: [f64; N], v: [f64; N])
    where
        L: ByHand<N> + Discrete<Gauss<1>, N, Scalar = f64> + Discrete<Midpoint, N, Scalar = f64>,
    {
        for h in [0.05, 0.4] {
            let start = State { q: q.into(), p: system.momentum(q, v) };
            let gauss = system.by(Gauss::<1>, h).step(&start).unwrap().state;
            let midpoint = system.by(Midpoint, h).step(&start).unwrap().state;
            assert!((gauss.q - midpoint.q).amax() < 1e-15 * (1.0 + midpoint.q.amax()));
            assert!((gauss.p - midpoint.p).amax() < 2e-15 * (1.0 + midpoint.p.amax()));
            let (q0, q1) = (start.q, midpoint.q);
            let l = |l: f64, m: f64| assert!((l - m).abs() < 1e-14 * (1.0 + m.abs()), "{l} {m}");
            l(
                system.by(Gauss::<1>, h).segment(&q0, &q1).unwrap().discrete_lagrangian().unwrap(),
                system.by(Midpoint, h).segment(&q0, &q1).unwrap().discrete_lagrangian().unwrap(),
            );
            l(
                system.by(Gauss::<1>, h).segment(&q0, &q1).unwrap().energy().unwrap(),
                system.by(Midpoint, h).segment(&q0, &q1).unwrap().energy().unwrap(),
            );
        }
    }
    // R does not depend on q: there the midpoint's R_d gives the same force.
    check(&DoublePendulum::EXAMPLE, [1.1, -0.6], [0.3, 1.2]);
    check(&Pendulum::EXAMPLE, [1.9], [-0.7]);
    check(&Follower::EXAMPLE, [0.6, -0.9], [0.8, 0.5]);
    check(&Chain::EXAMPLE, [0.5, -0.2, 0.7, 0.1, -0.6], [0.0, 0.9, -0.3, 0.4, 0.2]);
}

/// R(q, v): the midpoint rule's R_d differentiates R by q too, and p0 and p1 differ by (h²/4)∂R/∂q, q1 by
/// O(h³).
#[test]
fn one_stage_is_not_the_midpoint_rule_where_r_depends_on_q() {
    #[rayleigh_system(rule = [midpoint, gauss])]
    fn thickening(q: [f64; 1], v: [f64; 1], share: f64) -> (f64, f64) {
        let r = 0.3 * (1.0 + share * q[0] * q[0]);
        (0.5 * v[0] * v[0] - 0.5 * q[0] * q[0], 0.5 * r * v[0] * v[0])
    }
    let apart = |share: f64, h: f64| {
        let system = Thickening { share };
        let start = State::from_velocity(&system, [1.0], [0.7]).unwrap();
        let gauss = system.by(Gauss::<1>, h).step(&start).unwrap().state;
        let midpoint = system.by(Midpoint, h).step(&start).unwrap().state;
        (gauss.q - midpoint.q).amax().max((gauss.p - midpoint.p).amax())
    };
    assert!(apart(0.0, 0.1) < 1e-15);
    let [wide, narrow] = [apart(1.0, 0.1), apart(1.0, 0.05)];
    assert!(wide > 1e-5 && ((wide / narrow).log2() - 3.0).abs() < 0.2, "{wide:e} {narrow:e}");
}

/// The Lagrange basis on the control points k/s, k = 0…s, with its derivative.
fn basis(s: usize, nu: usize, x: f64) -> [f64; 2] {
    let node = |k: usize| k as f64 / s as f64;
    let others: Vec<usize> = (0..=s).filter(|&k| k != nu).collect();
    let factor = |k: &usize| (x - node(*k)) / (node(nu) - node(*k));
    let value = others.iter().map(factor).product();
    let slope = others
        .iter()
        .map(|m| {
            let rest: f64 = others.iter().filter(|k| *k != m).map(factor).product();
            rest / (node(nu) - node(*m))
        })
        .sum();
    [value, slope]
}

fn satisfies_galerkin<L, const N: usize, const S: usize>(system: &L, q: [f64; N], v: [f64; N])
where
    L: ByHand<N> + Discrete<Gauss<S>, N, Scalar = f64>,
{
    let h = 0.3;
    let method = Collocation::new(S);
    let start = State { q: q.into(), p: system.momentum(q, v) };
    let (_, stages) = collocated(system, &method, start.q, start.p, h);
    let end = system.by(Gauss::<S>, h).step(&start).unwrap().state;
    let sum = |nu: usize| {
        let mut size = 0.0;
        let sum = (0..S).fold(SVector::<f64, N>::zeros(), |sum, i| {
            let [momentum, rate] = terms(system, stages[i][0].into(), stages[i][1].into());
            let [value, slope] = basis(S, nu, method.c[i]);
            let term = (rate * value + momentum * (slope / h)) * (h * method.b[i]);
            size += term.amax();
            sum + term
        });
        (sum, 1e-15 * (size + 10.0))
    };
    let ends = [(sum(0), -start.p), (sum(S), end.p)];
    let inner = (1..S).map(|nu| (sum(nu), SVector::zeros()));
    for ((sum, tolerance), expected) in ends.into_iter().chain(inner) {
        assert!((sum - expected).amax() < tolerance, "S = {S}: {sum} {expected} {tolerance:e}");
    }
    // The Legendre transforms of the segment give the same momenta.
    let momenta = system.by(Gauss::<S>, h).segment(&start.q, &end.q).unwrap().momenta().unwrap();
    assert!((momenta.p0 - start.p).amax() < 1e-13 && (momenta.p1 - end.p).amax() < 1e-13, "S = {S}");
}

#[test]
fn the_forced_galerkin_equations_hold() {
    for_stages!(satisfies_galerkin(&Bead::EXAMPLE, [0.8], [1.3]), 1, 1 2 3 4 5 6);
    for_stages!(satisfies_galerkin(&Charge::EXAMPLE, [0.9, -0.4, 0.6], [0.2, 1.1, -0.7]), 3, 1 2 3 4 5 6);
    for_stages!(satisfies_galerkin(&DoublePendulum::EXAMPLE, [1.1, -0.6], [0.3, 1.2]), 2, 1 2 3 4 5 6);
}

/// L is not quadratic in v: L = −m√(1 − v²) − ½kq².
#[rayleigh_system(rule = gauss)]
fn relativistic(q: [f64; 1], v: [f64; 1], m: f64, k: f64, r: f64) -> (f64, f64) {
    (-m * (1.0 - v[0] * v[0]).sqrt() - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
}

#[test]
fn the_lagrangian_need_not_be_quadratic_in_v() {
    let system = Relativistic { m: 1.3, k: 2.0, r: 0.0 };
    let start = State::from_velocity(&system, [0.9], [0.5]).unwrap();
    let energy = start.energy(&system).unwrap();
    let mut fastest = 0.0_f64;
    for step in system.by(Gauss::<5>, 0.2).run(start).take(500) {
        let step = step.unwrap();
        fastest = fastest.max(step.velocity[0].abs());
        assert!((step.state.energy(&system).unwrap() - energy).abs() < 1e-9);
    }
    assert!(fastest > 0.7, "slow enough for a quadratic L");
}

#[test]
fn a_trajectory_takes_the_steps_of_the_flow() {
    let system = DoublePendulum::EXAMPLE;
    let mut state = State::from_velocity(&system, [1.1, -0.6], [0.3, 1.2]).unwrap();
    let mut extrapolated = 0;
    let mut alone = 0;
    for step in system.by(Gauss::<4>, 0.1).run(state).take(100) {
        let step = step.unwrap();
        let single = system.by(Gauss::<4>, 0.1).step(&state).unwrap();
        assert!(
            (single.state.q - step.state.q).amax() < 1e-14 && (single.state.p - step.state.p).amax() < 1e-14
        );
        extrapolated += step.report.iterations;
        alone += single.report.iterations;
        state = step.state;
    }
    assert!(extrapolated < alone * 9 / 10, "extrapolation saves iterations: {extrapolated} {alone}");
}

#[test]
fn mistakes_have_names_and_leave_the_state() {
    let system = DoublePendulum::EXAMPLE;
    let start = State::from_velocity(&system, [1.1, -0.6], [0.3, 1.2]).unwrap();
    let step = |state: &State<f64, 2>, h: f64| system.by(Gauss::<3>, h).step(state);
    assert!(matches!(step(&start, 0.0), Err(StepError::StepSize { .. })));
    assert!(matches!(step(&start, f64::NAN), Err(StepError::StepSize { .. })));
    let broken = State { q: vector![f64::NAN, 0.0], p: start.p };
    assert!(matches!(step(&broken, 0.1), Err(StepError::NonFinite { .. })));
    let mut trajectory = system.by(Gauss::<3>, 0.1).run(start);
    trajectory.next().unwrap().unwrap();
    let before = *trajectory.state();
    trajectory.change_step_size(f64::INFINITY);
    assert!(trajectory.next().unwrap().is_err());
    assert_eq!(trajectory.state(), &before);
    trajectory.change_step_size(0.1);
    let after = trajectory.next().unwrap().unwrap().state;
    let mut undisturbed = system.by(Gauss::<3>, 0.1).run(start);
    assert_eq!(undisturbed.by_ref().take(2).last().unwrap().unwrap().state, after);
}
