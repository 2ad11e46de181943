//! The splittings of Blanes and his coauthors: the order, what free motion and damping keep, and where they
//! are stable.

use std::f64::consts::PI;

use dalembert::nalgebra::{Matrix2, Matrix4, SMatrix, SVector, matrix, vector};
use dalembert::run::{CompensatedSums, DrivenTrajectory, Explicit, PlainSums, Sums};
use dalembert::step::{Flow, Memory, MethodOf, Quantity};
use dalembert::system::Function;
use dalembert::{
    Composition, Discretise, FittedTrapezoidal, Splitting, State, StepError, Trajectory, Trapezoidal,
    rayleigh_system,
};
use dalembert_tests::by_hand::ByHand;
use dalembert_tests::convergence::orders;
use dalembert_tests::systems::Pendulum;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// The end of so many steps.
fn end<L, const N: usize, const S: usize, C: Sums>(
    splitting: Splitting<S, C>,
    system: &L,
    h: f64,
    start: State<f64, N>,
    steps: usize,
) -> State<f64, N>
where
    L: Explicit<N, Scalar = f64>,
{
    system.by(splitting, h).run(start).take(steps).last().unwrap().unwrap().state
}

fn assert_order<L, const N: usize, const S: usize>(
    system: &L,
    splitting: Splitting<S>,
    time: f64,
    steps: [usize; 6],
    start: [[f64; N]; 2],
) where
    L: ByHand<N> + Explicit<N, Scalar = f64>,
{
    let run = |h, start, steps| end(splitting, system, h, start, steps);
    for (order, of) in orders(system, time, steps, start, 1e-12, run).into_iter().zip(["q", "p"]) {
        let expected = f64::from(splitting.order());
        assert!((order - expected).abs() < 0.35, "order {order:.3} in {of}, not {expected}");
    }
}

#[test]
fn the_order_is_four_six_and_eight() {
    let system = Pendulum { r: 0.05, ..Pendulum::EXAMPLE };
    let swing = [[1.9], [-0.7]];
    assert_order(&system, Splitting::blanes_moan_4(), 6.0, [96, 128, 160, 192, 256, 320], swing);
    assert_order(&system, Splitting::blanes_moan_6(), 6.0, [24, 28, 32, 36, 40, 44], swing);
    let eight = Splitting::blanes_casas_escorihuela_8();
    assert_order(&system, eight, 6.0, [30, 32, 34, 36, 40, 44], swing);
}

/// The step written by hand for a pendulum with friction, from the coefficients.
fn by_hand<const S: usize>([drifts, kicks]: [&[f64; S]; 2], r: f64, h: f64, mut state: [f64; 2]) -> [f64; 2] {
    let kick = |[q, p]: &mut [f64; 2], share: f64| *p -= share * h * q.sin();
    let drift = |[q, p]: &mut [f64; 2], share: f64| {
        let loss = (-r * share * h).exp_m1();
        (*q, *p) = (*q - loss / r * *p, *p + loss * *p);
    };
    for i in 0..S {
        if S == 19 {
            drift(&mut state, drifts[i]);
            kick(&mut state, kicks[i]);
        } else {
            kick(&mut state, kicks[i]);
            drift(&mut state, drifts[i]);
        }
    }
    if S == 19 {
        drift(&mut state, drifts[0]);
    } else {
        kick(&mut state, kicks[0]);
    }
    state
}

#[rayleigh_system(rule = trapezoidal)]
fn swing(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
}

/// By hand, with the coefficients, and as a control with two of them changed in the third digit.
#[test]
fn the_step_is_the_product_of_its_kicks_and_drifts() {
    fn check<const S: usize>(splitting: Splitting<S>) {
        let (system, h) = (Swing { r: 0.01 }, 0.7);
        let start = State { q: vector![1.1], p: vector![-0.8] };
        let step = end(splitting, &system, h, start, 1);
        let coefficients = [splitting.drifts(), splitting.kicks()];
        let expected = by_hand(coefficients, system.r, h, [1.1, -0.8]);
        assert!((step.q[0] - expected[0]).abs() < 1e-15 && (step.p[0] - expected[1]).abs() < 1e-15);

        // Against fine steps: the error falls as the order says.
        let order = |coefficients| {
            let run = |steps: usize| {
                let h = 8.0 / steps as f64;
                SVector::from((0..steps).fold([1.1, -0.8], |x, _| by_hand(coefficients, system.r, h, x)))
            };
            let coarse = if S > 6 { 16 } else { 64 };
            let [a, b, c] = [run(coarse), run(2 * coarse), run(4096)];
            ((a - c).norm() / (b - c).norm()).log2()
        };
        let found = order(coefficients);
        assert!((found - f64::from(splitting.order())).abs() < 0.5, "{found}");
        // Still symmetric and of sum 1, but of order 2.
        let mut drifts = *splitting.drifts();
        let changes = if S == 19 {
            vec![(0, 1e-3), (1, -1e-3), (S - 1, -1e-3)]
        } else {
            vec![(0, 1e-3), (1, -1e-3), (S - 1, 1e-3), (S - 2, -1e-3)]
        };
        for (i, change) in changes {
            drifts[i] += change;
        }
        assert!((order([&drifts, splitting.kicks()]) - 2.0).abs() < 0.3);
    }
    check(Splitting::blanes_moan_4());
    check(Splitting::blanes_moan_6());
    check(Splitting::blanes_casas_escorihuela_8());
}

/// Two coordinates with coupled masses and dampers, terms of first degree, and an anharmonic potential of
/// strength k.
struct Two {
    damping: [f64; 3],
    k: f64,
}

#[rayleigh_system(rule = trapezoidal)]
impl Two {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let stretch = q[1] - q[0];
        0.65 * v[0] * v[0] + 0.4 * v[1] * v[1] + 0.3 * v[0] * v[1] + 0.2 * v[0]
            - self.k * (q[0].cosh() + stretch * stretch + 0.25 * stretch.powi(4))
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        let [a, b, c] = self.damping;
        0.5 * (a * v[0] * v[0] + c * v[1] * v[1]) + b * v[0] * v[1] - 0.1 * self.k * v[1]
    }

    fn force(&self, q: [f64; 2], _v: [f64; 2]) -> [f64; 2] {
        // Circulatory: no potential has it.
        [self.k * 0.3 * q[1], -self.k * 0.2 * q[0]]
    }
}

const M: Matrix2<f64> = matrix![1.3, 0.3; 0.3, 0.8];
const START: State<f64, 2> = State { q: vector![0.7, -0.3], p: vector![0.2, 0.9] };

/// Without a force the motion of M v̇ = −C v, p = M v + s, of any size and any damping, negative too: by
/// nalgebra's exponential of the affine field, which knows nothing of modes.
#[test]
fn free_motion_is_exact() {
    fn check<const S: usize>(splitting: Splitting<S>) {
        for ([a, b, c], h) in
            [([0.5, -0.2, 0.7], 0.6), ([5.0, 1.0, 9.0], 2.0), ([0.3, 0.5, 0.2], 1.0), ([0.0; 3], 3.0)]
        {
            let inverse = M.try_inverse().unwrap();
            let drag = -matrix![a, b; b, c] * inverse;
            // d/dt (q, p, 1)
            let mut field = SMatrix::<f64, 5, 5>::zeros();
            let shift = vector![0.2, 0.0];
            field.fixed_view_mut::<2, 2>(0, 2).copy_from(&inverse);
            field.fixed_view_mut::<2, 1>(0, 4).copy_from(&(-inverse * shift));
            field.fixed_view_mut::<2, 2>(2, 2).copy_from(&drag);
            field.fixed_view_mut::<2, 1>(2, 4).copy_from(&(-drag * shift));
            let flow = (field * h).exp();
            let exact = flow * vector![START.q[0], START.q[1], START.p[0], START.p[1], 1.0];
            let found = end(splitting, &Two { damping: [a, b, c], k: 0.0 }, h, START, 1);
            let scale = 1.0 + flow.amax();
            assert!((found.q - exact.fixed_rows::<2>(0)).amax() < 1e-14 * scale, "{a} {b} {c}");
            assert!((found.p - exact.fixed_rows::<2>(2)).amax() < 1e-14 * scale, "{a} {b} {c}");
        }
    }
    check(Splitting::blanes_moan_4());
    check(Splitting::blanes_moan_6());
    check(Splitting::blanes_casas_escorihuela_8());
}

/// Terms of first degree in L and R, coupled masses, and a force that has no potential, to the order.
#[test]
fn forces_of_every_kind_keep_the_order() {
    let system = Two { damping: [0.5, -0.2, 0.7], k: 1.0 };
    fn order<const S: usize>(splitting: Splitting<S>, system: &Two, steps: usize) -> f64 {
        let run = |steps: usize| end(splitting, system, 4.0 / steps as f64, START, steps).q;
        let fine = run(16 * steps);
        ((run(steps) - fine).amax() / (run(2 * steps) - fine).amax()).log2()
    }
    let [four, six] =
        [order(Splitting::blanes_moan_4(), &system, 40), order(Splitting::blanes_moan_6(), &system, 20)];
    assert!((four - 4.0).abs() < 0.3 && (six - 6.0).abs() < 0.4, "{four} {six}");
    let eight = order(Splitting::blanes_casas_escorihuela_8(), &system, 20);
    assert!((eight - 8.0).abs() < 0.4, "{eight}");
    // And to the motion: M v̇ = G − r − C v by hand, with steps of another method.
    let rate = |y: SVector<f64, 4>| {
        let (q, v) = ([y[0], y[1]], [y[2], y[3]]);
        let stretch = q[1] - q[0];
        let pull = 2.0 * stretch + stretch.powi(3);
        let force = vector![
            -q[0].sinh() + pull + 0.3 * q[1] - 0.5 * v[0] + 0.2 * v[1],
            -pull - 0.2 * q[0] + 0.2 * v[0] - 0.7 * v[1] + 0.1
        ];
        let a = M.try_inverse().unwrap() * force;
        vector![v[0], v[1], a[0], a[1]]
    };
    let v = M.try_inverse().unwrap() * (START.p - vector![0.2, 0.0]);
    let (mut y, h) = (vector![START.q[0], START.q[1], v[0], v[1]], 4.0 / 4000.0);
    for _ in 0..4000 {
        let a = rate(y);
        let b = rate(y + a * (h / 2.0));
        let c = rate(y + b * (h / 2.0));
        let d = rate(y + c * h);
        y += (a + (b + c) * 2.0 + d) * (h / 6.0);
    }
    for found in [
        end(Splitting::blanes_moan_6(), &system, 0.02, START, 200),
        end(Splitting::blanes_casas_escorihuela_8(), &system, 0.02, START, 200),
    ] {
        assert!((found.q - y.fixed_rows::<2>(0)).amax() < 1e-10, "{} {y}", found.q);
    }
}

/// ∂(q1, p1)/∂(q0, p0) by differences of order 4.
fn jacobian<L, const S: usize>(
    splitting: Splitting<S>,
    system: &L,
    h: f64,
    start: &State<f64, 2>,
) -> Matrix4<f64>
where
    L: Explicit<2, Scalar = f64>,
{
    let moved = |column: usize, by: f64| {
        let mut start = *start;
        if column < 2 {
            start.q[column] += by;
        } else {
            start.p[column - 2] += by;
        }
        let end = end(splitting, system, h, start, 1);
        vector![end.q[0], end.q[1], end.p[0], end.p[1]]
    };
    let d = 1e-3;
    let column = |j| {
        (moved(j, d) - moved(j, -d)) * (2.0 / (3.0 * d))
            - (moved(j, 2.0 * d) - moved(j, -2.0 * d)) / (12.0 * d)
    };
    Matrix4::from_columns(&[0, 1, 2, 3].map(column))
}

#[rayleigh_system(rule = trapezoidal)]
fn ring(q: [f64; 2], v: [f64; 2], k: f64) -> (f64, f64) {
    let s = q[0] * q[0] + q[1] * q[1];
    (0.5 * (v[0] * v[0] + v[1] * v[1]) - s * (s - 1.0).powi(2), 0.5 * k * (v[0] * v[0] + v[1] * v[1]))
}

#[test]
fn phase_space_contracts_as_by_the_motion() {
    let omega = matrix![0.0, 0.0, 1.0, 0.0; 0.0, 0.0, 0.0, 1.0; -1.0, 0.0, 0.0, 0.0; 0.0, -1.0, 0.0, 0.0];
    let h = 0.3;
    // Any damping matrix, and a circulatory force: det = e^{−h tr M⁻¹C}.
    let system = Two { damping: [0.5, -0.2, 0.7], k: 1.0 };
    let trace = (M.try_inverse().unwrap() * matrix![0.5, -0.2; -0.2, 0.7]).trace();
    for a in [
        jacobian(Splitting::blanes_moan_6(), &system, h, &START),
        jacobian(Splitting::blanes_casas_escorihuela_8(), &system, h, &START),
    ] {
        assert!((a.determinant() - (-h * trace).exp()).abs() < 1e-10, "{:e}", a.determinant());
        assert!(
            (a.transpose() * omega * a - omega * (-h * trace / 2.0).exp()).amax() > 1e-2,
            "but it is not conformal"
        );
    }
    // C = k M: conformally symplectic; k = 0: symplectic.
    for k in [0.8, 0.0] {
        let start = State { q: vector![0.9, 0.3], p: vector![-0.4, 0.7] };
        for a in [
            jacobian(Splitting::blanes_moan_4(), &Ring { k }, h, &start),
            jacobian(Splitting::blanes_moan_6(), &Ring { k }, h, &start),
            jacobian(Splitting::blanes_casas_escorihuela_8(), &Ring { k }, h, &start),
        ] {
            let miss = (a.transpose() * omega * a - omega * (-k * h).exp()).amax();
            assert!(miss < 1e-8 && (a - Matrix4::identity()).amax() > 0.1, "{k}: {miss:e}");
        }
    }
}

/// Where errors are small; and as a control that long steps are order 6's.
#[test]
fn order_8_has_the_smaller_error_for_the_same_gradients() {
    let start = State { q: vector![1.1, 0.0], p: vector![0.2, 0.9] };
    let system = Ring { k: 0.02 };
    let fine = end(Splitting::blanes_casas_escorihuela_8(), &system, 0.01, start, 2000);
    let errors = |gradients: usize| {
        let of = |found: State<f64, 2>| (found.q - fine.q).amax();
        let (six, eight) = (gradients / 11, gradients / 19);
        [
            of(end(Splitting::blanes_moan_6(), &system, 20.0 / six as f64, start, six)),
            of(end(Splitting::blanes_casas_escorihuela_8(), &system, 20.0 / eight as f64, start, eight)),
        ]
    };
    let [six, eight] = errors(11 * 19 * 25);
    assert!(eight < 0.6 * six && six < 1e-10, "{six:e} {eight:e}");
    let [six, eight] = errors(11 * 19 * 4);
    assert!(six < eight, "{six:e} {eight:e}");
}

#[test]
fn an_angular_momentum_falls_as_it_does_along_the_motion() {
    let (system, h) = (Ring { k: 0.01 }, 0.3);
    let start = State { q: vector![1.1, 0.0], p: vector![0.2, 0.9] };
    let j = |state: &State<f64, 2>| state.q[0] * state.p[1] - state.q[1] * state.p[0];
    for (end, steps) in [
        (end(Splitting::blanes_moan_4(), &system, h, start, 500), 500.0),
        (end(Splitting::blanes_moan_6(), &system, h, start, 500), 500.0),
        (end(Splitting::blanes_casas_escorihuela_8(), &system, h, start, 500), 500.0),
    ] {
        let expected = j(&start) * (-0.01 * h * steps).exp();
        assert!((j(&end) / expected - 1.0).abs() < 1e-13, "{:e}", j(&end) / expected - 1.0);
    }
}

/// V radial and C = 2aM are not enough: the rotation has to leave M as it is.
#[test]
fn an_angular_momentum_follows_no_law_where_masses_differ() {
    #[rayleigh_system(rule = [trapezoidal, fitted_trapezoidal])]
    fn uneven(q: [f64; 2], v: [f64; 2], m: f64, a: f64) -> (f64, f64) {
        let (s, kinetic) = (q[0] * q[0] + q[1] * q[1], 0.5 * (v[0] * v[0] + m * v[1] * v[1]));
        (kinetic - s * (s - 1.0).powi(2), 2.0 * a * kinetic)
    }
    let (a, h) = (0.05, 0.1);
    let j = |state: &State<f64, 2>| state.q[0] * state.p[1] - state.q[1] * state.p[0];
    let start = State { q: vector![1.1, 0.0], p: vector![0.2, 0.9] };
    for (m, low, high) in [(1.0, 0.0, 1e-14), (2.0, 1e-3, 1.0)] {
        let system = Uneven { m, a };
        for state in [
            end(Splitting::blanes_moan_4(), &system, h, start, 1),
            end(Splitting::blanes_moan_6(), &system, h, start, 1),
            system.by(FittedTrapezoidal, h).step(&start).unwrap().state,
        ] {
            let off = (j(&state) / j(&start) - (-2.0 * a * h).exp()).abs();
            assert!((low..high).contains(&off), "{m}: {off:e}");
        }
    }
}

#[test]
fn a_step_back_undoes_a_step_with_damping_too() {
    let system = Two { damping: [0.5, -0.2, 0.7], k: 1.0 };
    fn check<const S: usize>(splitting: Splitting<S>, system: &Two) {
        let there = end(splitting, system, 0.3, START, 20);
        let back = end(splitting, system, -0.3, there, 20);
        assert!((there.q - START.q).amax() > 0.1);
        assert!((back.q - START.q).amax() < 1e-12 && (back.p - START.p).amax() < 1e-12);
    }
    check(Splitting::blanes_moan_6(), &system);
    check(Splitting::blanes_casas_escorihuela_8(), &system);
}

/// Steps so short that rounding alone is left of the error of the energy: of random starts, by each method.
#[test]
fn compensated_sums_keep_what_rounding_takes() {
    let mut random = StdRng::seed_from_u64(31);
    let starts: Vec<State<f64, 2>> = (0..if cfg!(debug_assertions) { 8 } else { 24 })
        .map(|_| {
            let mut any = || random.random_range(-1.0..1.0);
            State { q: vector![any(), any()], p: vector![any(), any()] }
        })
        .collect();
    let system = Ring { k: 0.0 };
    let lost = |end: &dyn Fn(State<f64, 2>) -> State<f64, 2>| {
        let squares = starts.iter().map(|start| {
            let [before, after] = [*start, end(*start)].map(|state| state.energy(&system).unwrap());
            (after - before).powi(2)
        });
        (squares.sum::<f64>() / starts.len() as f64).sqrt()
    };
    let h = 1.0 / 128.0;
    let six = Splitting::blanes_moan_6();
    let eight = Splitting::blanes_casas_escorihuela_8();
    let compensated = [
        lost(&|start| end(six.compensated(), &system, h, start, 4000)),
        lost(&|start| end(eight.compensated(), &system, h, start, 4000)),
    ];
    let rounded = [
        lost(&|start| end(six, &system, h, start, 4000)),
        lost(&|start| end(eight, &system, h, start, 4000)),
    ];
    assert!(compensated.iter().all(|&lost| lost < 1e-15), "{compensated:?}, else {rounded:?}");
    assert!(rounded.iter().all(|&lost| lost > 1e-14), "{rounded:?}");
}

/// With terms of first degree in L and R, coupled masses and damping, the same motion to rounding; and a run
/// that is taken up at its state, which knows nothing of what its sums have lost, to a rounding.
#[test]
fn compensated_sums_are_of_the_same_step() {
    let system = Two { damping: [0.5, -0.2, 0.7], k: 1.0 };
    let six = Splitting::blanes_moan_6();
    let plain = end(six, &system, 0.02, START, 200);
    let compensated = end(six.compensated(), &system, 0.02, START, 200);
    let half = end(six.compensated(), &system, 0.02, START, 100);
    let resumed = end(six.compensated(), &system, 0.02, half, 100);
    let apart = |a: State<f64, 2>, b: State<f64, 2>| (a.q - b.q).amax().max((a.p - b.p).amax());
    assert!(plain != compensated && apart(plain, compensated) < 1e-13, "{:e}", apart(plain, compensated));
    assert!(apart(resumed, compensated) < 5e-16, "{:e}", apart(resumed, compensated));
    assert_eq!(six.compensated().order(), 6);
    // Its derivative, which is that of the same maps.
    let (step, by) = system.by(six.compensated(), 0.3).linearized_step(&START).unwrap();
    let (plain, by_plain) = system.by(six, 0.3).linearized_step(&START).unwrap();
    assert!(apart(step.state, plain.state) < 1e-15);
    assert_eq!(by, by_plain);
}

/// A struct that owns a run says by the type how its sums are made.
#[test]
fn sums_are_named_in_types() {
    struct Machine<C: Sums> {
        system: Two,
        run: DrivenTrajectory<Two, Splitting<19, C>, 2>,
    }
    fn led<C: Sums>() -> State<f64, 2> {
        let system = Two { damping: [0.5, -0.2, 0.7], k: 1.0 };
        let mut machine = Machine::<C> { system, run: DrivenTrajectory::new(0.02, START) };
        for _ in 0..200 {
            machine.run.advance(&machine.system).unwrap();
        }
        *machine.run.state()
    }
    let (system, eight) =
        (Two { damping: [0.5, -0.2, 0.7], k: 1.0 }, Splitting::blanes_casas_escorihuela_8());
    let [plain, compensated] = [led::<PlainSums>(), led::<CompensatedSums>()];
    assert_eq!(plain, end(eight, &system, 0.02, START, 200));
    assert_eq!(compensated, end(eight.compensated(), &system, 0.02, START, 200));
    assert_ne!(plain, compensated);
}

/// Without damping momenta do not drift: free ones, with a mass matrix that has to be decomposed, and an
/// angular one over 1e6 steps.
#[test]
fn rounding_does_not_drift() {
    let system = Two { damping: [0.0; 3], k: 0.0 };
    // Free: the momenta are kept bit by bit.
    let free = end(Splitting::blanes_moan_6(), &system, 0.3, START, 1000);
    assert!((free.p - START.p).amax() < 1e-16);
    let ring = Ring { k: 0.0 };
    let start = State { q: vector![1.1, 0.0], p: vector![0.2, 0.9] };
    let j = |state: &State<f64, 2>| state.q[0] * state.p[1] - state.q[1] * state.p[0];
    // 2.2e7 products, each with half a rounding: a random walk of 5e-13, a drift of 2.4e-9.
    let steps = if cfg!(debug_assertions) { 20_000 } else { 1_000_000 };
    let turned = end(Splitting::blanes_moan_6(), &ring, 0.1, start, steps);
    assert!((j(&turned) / j(&start) - 1.0).abs() < 2e-12, "{:e}", j(&turned) / j(&start) - 1.0);
}

#[rayleigh_system(rule = trapezoidal)]
fn oscillator(q: [f64; 1], v: [f64; 1], k: f64, r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
}

#[test]
fn oscillators_are_stable_up_to_the_bound_and_not_beyond() {
    fn left_after<const S: usize>(steps: usize, splitting: Splitting<S>, omega: f64, r: f64) -> f64 {
        let system = Oscillator { k: omega * omega, r };
        let start = State { q: vector![0.0], p: vector![1.0] };
        // Infinite where it has grown beyond all numbers.
        let end = system.by(splitting, 1.0).run(start).take(steps).last().unwrap();
        end.map_or(f64::INFINITY, |end| end.state.p[0].abs().max(end.state.q[0].abs() * omega))
    }
    let four = |omega| left_after(5000, Splitting::blanes_moan_4(), omega, 0.0);
    assert!(four(3.163) < 30.0 && four(3.169) < 100.0 && four(5.02) < 100.0 && four(5.03) > 1e3);
    let six = |omega| left_after(5000, Splitting::blanes_moan_6(), omega, 0.0);
    assert!(
        six(3.139) < 30.0 && six(3.143) < 100.0 && six(6.35) < 100.0 && six(9.07) < 100.0 && six(9.08) > 1e3
    );
    let eight = |omega| left_after(5000, Splitting::blanes_casas_escorihuela_8(), omega, 0.0);
    assert!(eight(3.138) < 30.0 && eight(3.144) < 100.0 && eight(5.96) < 300.0 && eight(5.97) > 1e3);
    // By 0.15 % a step: e^(5000 × 0.0015).
    assert!((1e2..1e4).contains(&eight(3.1413)), "{:e}", eight(3.1413));
    // The resonances, whose growth is slow: e^(5000 × 0.0023), e^(5000 × 0.0004).
    assert!((1e4..1e6).contains(&four(3.166)), "{:e}", four(3.166));
    let resonant = PI + 4e-4;
    assert!((2.0..20.0).contains(&six(resonant)), "{:e}", six(resonant));
    let frictions: &[f64] = if cfg!(debug_assertions) { &[0.01, 3.0] } else { &[0.01, 0.1, 1.0, 3.0, 10.0] };
    let steps = if cfg!(debug_assertions) { 1000 } else { 5000 };
    let omegas = [0.1, 3.0, PI, 3.166, 5.0, 0.5, 1.0, 2.0, 4.0];
    for &r in frictions {
        for &omega in &omegas[..if cfg!(debug_assertions) { 5 } else { 9 }] {
            let four = left_after(steps, Splitting::blanes_moan_4(), omega, r);
            let six = left_after(steps, Splitting::blanes_moan_6(), 1.8 * omega, r);
            let eight = left_after(steps, Splitting::blanes_casas_escorihuela_8(), 1.18 * omega, r);
            assert!(four < 1.0 && six < 1.0 && eight < 1.0, "{omega} {r}: {four:e} {six:e} {eight:e}");
        }
    }
}

#[test]
fn what_cannot_be_stepped_has_a_name_and_leaves_the_state() {
    let start = State { q: vector![0.3], p: vector![1.0] };
    let error = |h, start| {
        let system = Oscillator { k: 1.0, r: 0.1 };
        let mut run = system.by(Splitting::blanes_moan_4(), h).run(start);
        let error = run.next().unwrap().unwrap_err();
        assert!(run.next().is_none() && run.time() == 0.0);
        error
    };
    assert_eq!(error(0.0, start), StepError::StepSize { h: 0.0 });
    assert!(matches!(error(f64::NAN, start), StepError::StepSize { .. }));
    let of = |quantity, index| StepError::NonFinite { quantity, index };
    assert_eq!(error(0.1, State { p: vector![f64::NAN], ..start }), of(Quantity::Momentum, 0));
    assert_eq!(error(0.1, State { q: vector![f64::INFINITY], ..start }), of(Quantity::Configuration, 0));

    // A mass matrix that is not positive definite: alone, and among coordinates.
    #[rayleigh_system(rule = trapezoidal)]
    fn hyperbolic(q: [f64; 2], v: [f64; 2], coupling: f64) -> f64 {
        0.5 * (v[0] * v[0] - 0.5 * v[1] * v[1]) + coupling * v[0] * v[1] - q[0] * q[0]
    }
    for coupling in [0.0, 0.3] {
        let system = Hyperbolic { coupling };
        let start = State { q: vector![0.1, 0.2], p: vector![0.3, 0.4] };
        let found = system.by(Splitting::blanes_moan_6(), 0.1).run(start).next().unwrap();
        assert_eq!(found, Err(StepError::MassNotPositiveDefinite { column: 1 }), "{coupling}");
    }

    // The square root of what has become negative.
    #[rayleigh_system(rule = trapezoidal)]
    fn wall(q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q[0].sqrt()
    }
    let start = State::from_velocity(&Wall {}, [10.0], [-5.0]).unwrap();
    let mut run = Wall {}.by(Splitting::blanes_moan_6(), 0.5).run(start);
    let error = run.by_ref().take(10).find_map(Result::err).expect("the mass meets the wall");
    let is_named = matches!(error, StepError::NoDerivative { function: Function::Lagrangian, .. });
    assert!(is_named, "{error}");
    assert!(run.time() > 1.0 && run.state().q[0] > 0.0 && run.state().p[0].is_finite());
    assert!(run.next().is_none());
}

#[test]
fn a_run_that_is_resumed_goes_on_bit_by_bit() {
    let system = Ring { k: 0.01 };
    let start = State { q: vector![1.1, 0.0], p: vector![0.2, 0.9] };
    let method = Splitting::blanes_moan_4();
    let mut run = system.by(method, 0.1).run(start);
    run.by_ref().take(50).for_each(|state| assert!(state.is_ok()));
    let resumed = Trajectory::resume(&system, method, run.checkpoint());
    assert!(resumed.time() == run.time() && resumed.take(50).eq(run.take(50)));
}

#[test]
fn in_single_precision_too() {
    #[rayleigh_system(rule = trapezoidal)]
    fn single(q: [f32; 1], v: [f32; 1], r: f32) -> (f32, f32) {
        (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
    }
    let start = State { q: vector![1.1_f32], p: vector![-0.8] };
    let found =
        Single { r: 0.4 }.by(Splitting::blanes_moan_6(), 0.1).run(start).take(50).last().unwrap().unwrap();
    let start = State { q: vector![1.1], p: vector![-0.8] };
    let exact = end(Splitting::blanes_moan_6(), &Swing { r: 0.4 }, 0.1, start, 50);
    assert!(
        (f64::from(found.state.q[0]) - exact.q[0]).abs() < 2e-6
            && (f64::from(found.state.p[0]) - exact.p[0]).abs() < 2e-6
    );
}

/// A pendulum that is pushed.
struct Pushed {
    r: f64,
}

#[rayleigh_system(rule = trapezoidal)]
impl Pushed {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] + q[0].cos()
    }

    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.5 * self.r * v[0] * v[0]
    }

    fn force(&self, q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
        [u[0] * (1.0 + 0.1 * q[0])]
    }
}

#[test]
fn a_held_input_acts_and_what_is_remembered_serves_the_next() {
    // With an input held the force is a function of q: to the motion, with a cosine more in the potential.
    let exact = |u: f64| {
        let rate = |[q, v]: [f64; 2]| [v, -q.sin() - 0.3 * v + u * (1.0 + 0.1 * q)];
        let (mut y, h) = ([0.4, 0.1], 1e-3);
        let along = |y: [f64; 2], k: [f64; 2], s: f64| [y[0] + s * k[0], y[1] + s * k[1]];
        for _ in 0..4000 {
            let a = rate(y);
            let b = rate(along(y, a, h / 2.0));
            let c = rate(along(y, b, h / 2.0));
            let d = rate(along(y, c, h));
            y = [0, 1].map(|i| y[i] + h / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]));
        }
        y
    };
    let (system, start) = (Pushed { r: 0.3 }, State { q: vector![0.4], p: vector![0.1] });
    for u in [0.7, -0.4] {
        let [q, v] = exact(u);
        let view = system.driven([u]);
        for end in [
            end(Splitting::blanes_moan_6(), &view, 0.05, start, 80),
            end(Splitting::blanes_casas_escorihuela_8(), &view, 0.05, start, 80),
        ] {
            assert!((end.q[0] - q).abs() < 1e-10 && (end.p[0] - v).abs() < 1e-10, "{end:?} {q} {v}");
        }
    }

    // A memory that saw another input leads nowhere else, once it is told.
    fn astray<'a, M>(method: M, system: &'a Pushed, start: State<f64, 1>, is_told: bool) -> f64
    where
        DrivenPushed<'a>: Flow<M, 1, Scalar = f64>,
        M: Copy + MethodOf<DrivenPushed<'a>, 1>,
    {
        let mut memory = <DrivenPushed<'a> as Flow<M, 1>>::RunMemory::default();
        let (mut state, mut alone) = (start, start);
        let mut worst = 0.0_f64;
        for k in 0..40 {
            let view = system.driven([f64::from(k % 5) - 2.0]);
            if is_told {
                Memory::<DrivenPushed<'a>, M, 1>::change_input(&mut memory);
            }
            state = memory.advance(&view, &state, 0.1).unwrap().state;
            alone = view.by(method, 0.1).step(&alone).unwrap().state;
            worst = worst.max((state.q - alone.q).amax()).max((state.p - alone.p).amax());
        }
        worst
    }
    for (is_told, range) in [(true, 0.0..1e-13), (false, 1e-3..1e3)] {
        for worst in [
            astray(Trapezoidal, &system, start, is_told),
            astray(Splitting::blanes_moan_4(), &system, start, is_told),
            astray(Composition::kahan_li_6(Trapezoidal), &system, start, is_told),
        ] {
            assert!(range.contains(&worst), "{worst:e}");
        }
    }
}
