//! What `Gauss<S>` keeps: the symplectic form and the momentum maps without force, and with it the identities
//! of the theory.

use dalembert::nalgebra::{SMatrix, SVector};
use dalembert::noether::Generator;
use dalembert::step::Linearizable;
use dalembert::{Discretise, Gauss, State, rayleigh_system, samples};
use dalembert_tests::by_hand::ByHand;
use dalembert_tests::systems::{Bead, Charge, DoublePendulum, Follower};

const H: f64 = 0.3;

fn omega<const M: usize>() -> SMatrix<f64, M, M> {
    let n = M / 2;
    SMatrix::from_fn(|i, j| f64::from(i32::from(j == i + n) - i32::from(i == j + n)))
}

/// The step matrix, by the implicit function theorem, and the segment.
fn step_matrix<L, const N: usize, const M: usize, const S: usize>(
    system: &L,
    q: [f64; N],
    v: [f64; N],
) -> (SMatrix<f64, M, M>, SVector<f64, N>)
where
    L: ByHand<N> + Linearizable<Gauss<S>, N, Scalar = f64>,
{
    let start = State { q: q.into(), p: system.momentum(q, v) };
    let q1 = system.by(Gauss::<S>, H).step(&start).unwrap().state.q;
    (
        system
            .by(Gauss::<S>, H)
            .segment(&start.q, &q1)
            .unwrap()
            .linearized()
            .unwrap()
            .by_state()
            .unwrap()
            .assembled::<M>(),
        q1,
    )
}

/// The same by central differences of order 4 of the step.
fn differenced<L, const N: usize, const M: usize, const S: usize>(
    system: &L,
    q: [f64; N],
    v: [f64; N],
) -> SMatrix<f64, M, M>
where
    L: ByHand<N> + Linearizable<Gauss<S>, N, Scalar = f64>,
{
    let start = State { q: q.into(), p: system.momentum(q, v) };
    let delta = 1e-3;
    let mut a = SMatrix::<f64, M, M>::zeros();
    for column in 0..M {
        let at = |factor: f64| {
            let mut moved = start;
            let entry = if column < N { &mut moved.q[column] } else { &mut moved.p[column - N] };
            *entry += factor * delta;
            let after = system.by(Gauss::<S>, H).step(&moved).unwrap().state;
            SVector::<f64, M>::from_fn(|i, _| if i < N { after.q[i] } else { after.p[i - N] })
        };
        let odd = |factor: f64| at(factor) - at(-factor);
        a.set_column(column, &((odd(1.0) * 8.0 - odd(2.0)) / (12.0 * delta)));
    }
    a
}

fn step_matrices_agree<L, const N: usize, const M: usize, const S: usize>(
    system: &L,
    q: [f64; N],
    v: [f64; N],
    is_symplectic: bool,
) where
    L: ByHand<N> + Linearizable<Gauss<S>, N, Scalar = f64>,
{
    let (exact, _) = step_matrix::<L, N, M, S>(system, q, v);
    let other = differenced::<L, N, M, S>(system, q, v);
    // With force, Df_d alone is a difference, but not its sum with D²L_d.
    assert!((exact - other).amax() < 2e-10, "S = {S}: {:e}", (exact - other).amax());
    let defect = (exact.transpose() * omega::<M>() * exact - omega::<M>()).amax();
    if is_symplectic {
        assert!(defect < 3e-13, "S = {S}: {defect:e}");
    } else {
        assert!(defect > 1e-3, "S = {S}: {defect:e}");
    }
}

macro_rules! for_stages {
    ($check:ident $arguments:tt, $n:literal, $m:literal, $($s:literal)*) => {
        $($check::<_, $n, $m, $s> $arguments;)*
    };
}

#[test]
fn the_step_is_symplectic_without_force_and_only_then() {
    let (q, v) = ([1.1, -0.6], [0.3, 1.2]);
    for_stages!(step_matrices_agree(&DoublePendulum::FREE, q, v, true), 2, 4, 1 2 3 4 5 6 7 8);
    for_stages!(step_matrices_agree(&DoublePendulum::EXAMPLE, q, v, false), 2, 4, 1 2 3 6);
    let (q, v) = ([0.9, -0.4, 0.6], [0.2, 1.1, -0.7]);
    for_stages!(step_matrices_agree(&Charge::FREE, q, v, true), 3, 6, 2 3 4);
    for_stages!(step_matrices_agree(&Charge::EXAMPLE, q, v, false), 3, 6, 2 3 4);
    for_stages!(step_matrices_agree(&Bead::EXAMPLE, [0.8], [1.3], false), 1, 2, 2 4);
    for_stages!(step_matrices_agree(&Follower::EXAMPLE, [0.6, -0.9], [0.8, 0.5], false), 2, 4, 2 4);
}

/// D1, D2 of L_d against central differences of L_d; p0 = −D1 L_d − f_d⁻ and p1 = D2 L_d + f_d⁺ with the
/// stages' own momenta; and AᵀΩA − Ω = Tᵀ(F − Fᵀ)T, which needs Df_d by itself.
fn identities_hold<L, const N: usize, const M: usize, const S: usize>(system: &L, q: [f64; N], v: [f64; N])
where
    L: ByHand<N> + Linearizable<Gauss<S>, N, Scalar = f64>,
{
    let (a, q1) = step_matrix::<L, N, M, S>(system, q, v);
    let q0 = SVector::from(q);
    let l = system.by(Gauss::<S>, H).segment(&q0, &q1).unwrap().discrete_lagrangian_derivatives().unwrap();
    let f = system.by(Gauss::<S>, H).segment(&q0, &q1).unwrap().discrete_force_derivatives().unwrap();
    let value = |q0: &SVector<f64, N>, q1: &SVector<f64, N>| {
        system.by(Gauss::<S>, H).segment(q0, q1).unwrap().discrete_lagrangian().unwrap()
    };
    let delta = 1e-3;
    for coordinate in 0..N {
        for (slope, at_end) in [(l.d1[coordinate], false), (l.d2[coordinate], true)] {
            let at = |factor: f64| {
                let (mut q0, mut q1) = (q0, q1);
                let moved = if at_end { &mut q1 } else { &mut q0 };
                moved[coordinate] += factor * delta;
                value(&q0, &q1)
            };
            let odd = |factor: f64| at(factor) - at(-factor);
            let difference = (odd(1.0) * 8.0 - odd(2.0)) / (12.0 * delta);
            assert!((slope - difference).abs() < 1e-9, "S = {S}: {slope} {difference}");
        }
    }
    let k = system.by(Gauss::<S>, H).segment(&q0, &q1).unwrap().legendre_derivatives().unwrap();
    assert!((k.momenta.p0 + l.d1 + f.minus.value).amax() < 1e-12, "S = {S}");
    assert!((k.momenta.p1 - l.d2 - f.plus.value).amax() < 1e-12, "S = {S}");
    assert!(
        (l.d11 - l.d11.transpose()).amax() < 1e-9 && (l.d22 - l.d22.transpose()).amax() < 1e-9,
        "S = {S}"
    );

    let mut t = SMatrix::<f64, M, M>::zeros();
    let mut force = SMatrix::<f64, M, M>::zeros();
    for i in 0..N {
        t[(i, i)] = 1.0;
        for j in 0..M {
            t[(N + i, j)] = a[(i, j)];
            force[(i, j)] = if j < N { f.minus.d1[(i, j)] } else { f.minus.d2[(i, j - N)] };
            force[(N + i, j)] = if j < N { f.plus.d1[(i, j)] } else { f.plus.d2[(i, j - N)] };
        }
    }
    let defect = a.transpose() * omega::<M>() * a - omega::<M>();
    let of_force = t.transpose() * (force - force.transpose()) * t;
    assert!((defect - of_force).amax() < 1e-9, "S = {S}: {:e}", (defect - of_force).amax());
}

#[test]
fn the_discrete_objects_fit_together() {
    let (q, v) = ([1.1, -0.6], [0.3, 1.2]);
    for_stages!(identities_hold(&DoublePendulum::EXAMPLE, q, v), 2, 4, 1 2 3 4);
    for_stages!(identities_hold(&DoublePendulum::FREE, q, v), 2, 4, 2 3);
    for_stages!(identities_hold(&Charge::EXAMPLE, [0.9, -0.4, 0.6], [0.2, 1.1, -0.7]), 3, 6, 2 3);
    for_stages!(identities_hold(&Bead::EXAMPLE, [0.8], [1.3]), 1, 2, 2 3);
}

/// A central force, with friction in the radial direction only where `radial` is set: it keeps the angular
/// momentum.
#[rayleigh_system(rule = gauss)]
fn central(q: [f64; 2], v: [f64; 2], isotropic: f64, radial: f64) -> (f64, f64) {
    let square = q[0] * q[0] + q[1] * q[1];
    let along = q[0] * v[0] + q[1] * v[1];
    (
        0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.25 * square * square,
        0.5 * isotropic * (v[0] * v[0] + v[1] * v[1]) + 0.5 * radial * along * along,
    )
}

/// Largest change of the angular momentum over a run.
fn drift<const S: usize>(system: &Central) -> f64 {
    let start = State::from_velocity(system, [0.9, -0.3], [0.4, 1.1]).unwrap();
    let angular = |state: &State<f64, 2>| state.q[0] * state.p[1] - state.q[1] * state.p[0];
    let run = system.by(Gauss::<S>, H).run(start).take(if cfg!(debug_assertions) { 500 } else { 2000 });
    run.map(|step| (angular(&step.unwrap().state) - angular(&start)).abs()).fold(0.0, f64::max)
}

#[test]
fn momentum_maps_are_kept_to_rounding() {
    for (isotropic, radial) in [(0.0, 0.0), (0.0, 0.2)] {
        let system = Central { isotropic, radial };
        let drifts = [
            drift::<1>(&system),
            drift::<2>(&system),
            drift::<3>(&system),
            drift::<5>(&system),
            drift::<8>(&system),
        ];
        assert!(drifts.iter().all(|&drift| drift < 2e-14), "{drifts:?}");
    }
    // Positive control.
    assert!(drift::<3>(&Central { isotropic: 1e-6, radial: 0.0 }) > 1e-5);
}

#[test]
fn the_checkers_see_it() {
    let segments = samples::segments([-1.0, -1.0], [1.0, 1.0], [0.1, 0.1], 20);
    let generator = Generator::rotation(0, 1);
    let kept = Central { isotropic: 0.0, radial: 0.2 };
    let report = kept.by(Gauss::<2>, 0.1).noether().symmetry(&generator, &segments).unwrap();
    assert!(report.is_symmetry_of_lagrangian() && report.is_conserved(), "{report}");
    let lost = Central { isotropic: 0.1, radial: 0.0 };
    let report = lost.by(Gauss::<2>, 0.1).noether().symmetry(&generator, &segments).unwrap();
    assert!(!report.is_conserved(), "{report}");
}
