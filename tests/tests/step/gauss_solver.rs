//! Large steps, stiff forces and what has no solution: where the fixed point of `Gauss<S>` gives way to
//! simplified Newton's method and to Newton's.

use std::cell::Cell;

use allocation_counter::measure;
use dalembert::nalgebra::{SMatrix, SVector, vector};
use dalembert::system::Function;
use dalembert::system::{ActingForce, Derivatives, ForcedLagrangian, LaneVector, Lanes, Stages};
use dalembert::{Discrete, Discretise, Gauss, Lagrangian, State, StepError, rayleigh_system};
use dalembert_tests::systems::DoublePendulum;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// m q̈ + c q̇ + k q = 0, and a weak cubic spring.
#[rayleigh_system(rule = gauss)]
fn oscillator(q: [f64; 1], v: [f64; 1], k: f64, c: f64, cubic: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] - 0.5 * k * q[0] * q[0] - 0.25 * cubic * q[0].powi(4), 0.5 * c * v[0] * v[0])
}

/// The diagonal Padé approximant (s, s) of the exponential of z ∈ ℂ: what Gauss collocation does to y′ = λy,
/// z = hλ.
fn pade(s: u32, (x, y): (f64, f64)) -> (f64, f64) {
    let times = |(a, b): (f64, f64), (c, d): (f64, f64)| (a * c - b * d, a * d + b * c);
    let (mut above, mut below, mut power, mut coefficient) = ((0.0, 0.0), (0.0, 0.0), (1.0, 0.0), 1.0);
    for j in 0..=s {
        let sign = if j % 2 == 0 { 1.0 } else { -1.0 };
        above = (above.0 + coefficient * power.0, above.1 + coefficient * power.1);
        below = (below.0 + sign * coefficient * power.0, below.1 + sign * coefficient * power.1);
        power = times(power, (x, y));
        coefficient *= f64::from(s - j) / (f64::from(2 * s - j) * f64::from(j + 1));
    }
    let size = below.0 * below.0 + below.1 * below.1;
    let (real, imaginary) = times(above, (below.0, -below.1));
    (real / size, imaginary / size)
}

/// (q1, p1) of a step of the linear oscillator, by its two eigenvalues.
fn exact_rational<const S: usize>(k: f64, c: f64, h: f64, q: f64, p: f64) -> (f64, f64) {
    let discriminant = c * c / 4.0 - k;
    assert!(discriminant != 0.0);
    if discriminant < 0.0 {
        // y = p − λ̄ q turns with R(hλ): p1 − λ̄ q1 = R (p − λ̄ q).
        let (a, b) = (-c / 2.0, (-discriminant).sqrt());
        let (r, s) = pade(S as u32, (h * a, h * b));
        let (x, y) = (p - a * q, b * q);
        let (x1, y1) = (r * x - s * y, r * y + s * x);
        let q1 = y1 / b;
        (q1, x1 + a * q1)
    } else {
        let root = discriminant.sqrt();
        let (one, other) = (-c / 2.0 + root, -c / 2.0 - root);
        let of = |own: f64, rest: f64| pade(S as u32, (h * own, 0.0)).0 * (p - rest * q);
        let (x, y) = (of(one, other), of(other, one));
        let q1 = (x - y) / (one - other);
        (q1, x + other * q1)
    }
}

fn stiff_steps<const S: usize>() {
    for (k, c, h) in [
        (1.0, 0.3, 0.2),
        (400.0, 1.0, 0.5),
        (1e4, 3.0, 1.0),
        (2.0, 1e3, 0.7),
        (1e6, 3e3, 0.1),
        (1e8, 1.0, 1.0),
    ] {
        let system = Oscillator { k, c, cubic: 0.0 };
        let start = State { q: vector![0.8], p: vector![-0.3] };
        let step = system.by(Gauss::<S>, h).step(&start).unwrap();
        let (q1, p1) = exact_rational::<S>(k, c, h, 0.8, -0.3);
        // The momenta at the stages are of the size √k.
        let size = 1.0 + k.sqrt() + c;
        let rounding = 1e-15 * (200.0 + h * k.sqrt());
        let (in_q, in_p) = ((step.state.q[0] - q1).abs(), (step.state.p[0] - p1).abs());
        assert!(
            in_q < rounding * (1.0 + size / k.sqrt()) && in_p < rounding * size,
            "S = {S}, k = {k}, c = {c}: {in_q:e} {in_p:e}"
        );
    }
}

#[test]
fn stiff_steps_are_those_of_the_pade_approximant() {
    stiff_steps::<1>();
    stiff_steps::<2>();
    stiff_steps::<3>();
    stiff_steps::<4>();
    stiff_steps::<6>();
    stiff_steps::<8>();
}

/// M q̈ + C q̇ + K q = 0 with any M, C, K.
#[derive(Clone, Copy, Debug)]
struct Linear {
    m: [[f64; 3]; 3],
    c: [[f64; 3]; 3],
    k: [[f64; 3]; 3],
}

#[rayleigh_system(rule = gauss)]
impl Linear {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        let mut l = 0.0;
        for a in 0..3 {
            for b in 0..3 {
                l += 0.5 * v[a] * self.m[a][b] * v[b] - 0.5 * q[a] * self.k[a][b] * q[b];
            }
        }
        l
    }

    fn rayleigh(&self, v: [f64; 3]) -> f64 {
        let mut r = 0.0;
        for a in 0..3 {
            for b in 0..3 {
                r += 0.5 * v[a] * self.c[a][b] * v[b];
            }
        }
        r
    }
}

/// The diagonal Padé approximant (s, s) of exp Z, times y.
fn pade_of_matrix(s: u32, z: SMatrix<f64, 6, 6>, y: SVector<f64, 6>) -> SVector<f64, 6> {
    let (mut above, mut below) = (SMatrix::<f64, 6, 6>::zeros(), SMatrix::<f64, 6, 6>::zeros());
    let (mut power, mut coefficient) = (SMatrix::<f64, 6, 6>::identity(), 1.0);
    for j in 0..=s {
        above += power * coefficient;
        below += power * if j % 2 == 0 { coefficient } else { -coefficient };
        power *= z;
        coefficient *= f64::from(s - j) / (f64::from(2 * s - j) * f64::from(j + 1));
    }
    below.full_piv_lu().solve(&(above * y)).unwrap()
}

/// The largest error of the stiff steps of random linear systems by S stages, in units of what they start
/// from.
fn worst_of_stiff_linear_systems<const S: usize>(random: &mut StdRng, steps: u32) -> f64 {
    let mut worst = 0.0_f64;
    for _ in 0..steps {
        let mut matrix = || SMatrix::<f64, 3, 3>::from_fn(|_, _| random.random_range(-1.0..1.0));
        let (m, c, k) = (matrix(), matrix(), matrix());
        // In units of h: far beyond where the fixed point contracts, near enough for Padé's polynomials.
        let mass = m * m.transpose() + SMatrix::identity();
        let stiffness = (k * k.transpose() + SMatrix::identity()) * random.random_range(10.0..60.0);
        let friction = c * c.transpose() * random.random_range(0.0..10.0);
        let h = 10.0_f64.powf(random.random_range(-3.0..0.0));
        let system = Linear { m: mass.into(), c: (friction / h).into(), k: (stiffness / (h * h)).into() };
        let q = SVector::<f64, 3>::from_fn(|_, _| random.random_range(-1.0..1.0));
        let p = SVector::<f64, 3>::from_fn(|_, _| random.random_range(-1.0..1.0)) / h;
        let step = system.by(Gauss::<S>, h).step(&State { q, p }).unwrap();

        let per_mass = mass.try_inverse().unwrap();
        let mut z = SMatrix::<f64, 6, 6>::zeros();
        z.fixed_view_mut::<3, 3>(0, 3).copy_from(&per_mass);
        z.fixed_view_mut::<3, 3>(3, 0).copy_from(&-stiffness);
        z.fixed_view_mut::<3, 3>(3, 3).copy_from(&(-friction * per_mass));
        let stacked = |q: &SVector<f64, 3>, p: &SVector<f64, 3>| {
            SVector::<f64, 6>::from_fn(|a, _| if a < 3 { q[a] } else { p[a - 3] * h })
        };
        let exact = pade_of_matrix(S as u32, z, stacked(&q, &p));
        let error = stacked(&step.state.q, &step.state.p) - exact;
        worst = worst.max(error.amax() / (stiffness.amax() * (1.0 + exact.amax())));
    }
    worst
}

#[test]
fn stiff_steps_of_random_linear_systems_are_those_of_the_pade_approximant() {
    let mut random = StdRng::seed_from_u64(71);
    // (S, S) of the exponential of matrices with eigenvalues up to some tens: its own rounding grows with S.
    assert!(worst_of_stiff_linear_systems::<1>(&mut random, 60) < 1e-14);
    assert!(worst_of_stiff_linear_systems::<2>(&mut random, 60) < 1e-14);
    assert!(worst_of_stiff_linear_systems::<3>(&mut random, 60) < 1e-14);
    assert!(worst_of_stiff_linear_systems::<4>(&mut random, 60) < 1e-13);
    assert!(worst_of_stiff_linear_systems::<5>(&mut random, 60) < 1e-13);
    assert!(worst_of_stiff_linear_systems::<6>(&mut random, 60) < 1e-13);
    assert!(worst_of_stiff_linear_systems::<7>(&mut random, 60) < 1e-13);
    assert!(worst_of_stiff_linear_systems::<8>(&mut random, 60) < 1e-13);
}

#[test]
fn long_runs_at_large_steps_keep_the_energy_bounded() {
    // hω = 3: some hundred steps of a fixed point that would not contract.
    let system = Oscillator { k: 900.0, c: 0.0, cubic: 50.0 };
    let start = State { q: vector![1.0], p: vector![0.0] };
    let energy = start.energy(&system).unwrap();
    let mut iterations = 0;
    for step in system.by(Gauss::<3>, 0.1).run(start).take(2000) {
        let step = step.unwrap();
        iterations += step.report.iterations;
        assert!((step.state.energy(&system).unwrap() / energy - 1.0).abs() < 0.2);
        assert!(step.report.residual <= step.report.floor * 8.0);
    }
    assert!(iterations < 2000 * 40, "{iterations}");
    // The double pendulum, over the top.
    let system = DoublePendulum::FREE;
    let start = State::from_velocity(&system, [2.5, -2.0], [3.0, -2.0]).unwrap();
    let energy = start.energy(&system).unwrap();
    for step in system.by(Gauss::<8>, 0.25).run(start).take(1000) {
        assert!((step.unwrap().state.energy(&system).unwrap() - energy).abs() < 0.05 * energy.abs());
    }
}

/// Unit masses between walls, on unit springs.
macro_rules! masses {
    ($name:ident, $n:literal) => {
        #[rayleigh_system(rule = gauss)]
        fn $name(q: [f64; $n], v: [f64; $n]) -> f64 {
            let (mut kinetic, mut springs, mut before) = (0.0, 0.0, 0.0);
            for i in 0..$n {
                kinetic += v[i] * v[i];
                springs += (q[i] - before).powi(2);
                before = q[i];
            }
            0.5 * kinetic - 0.5 * (springs + before * before)
        }
    };
}

masses!(three_masses, 3);
masses!(many_masses, 24);

/// Iterations of the first step and the most of one after it, the masses starting at rest with the first
/// alone displaced; all positions are held against the normal modes, sin(jkπ/(n+1)) cos(ω_k t), ω_k = 2
/// sin(kπ/(2n+2)).
fn iterations_of_a_front<L, const N: usize>(system: &L) -> [u32; 2]
where
    L: Discrete<Gauss<8>, N, Scalar = f64>,
{
    let mut start = State { q: SVector::zeros(), p: SVector::zeros() };
    start.q[0] = 1.0;
    let mut run = system.by(Gauss::<8>, 0.1).run(start);
    let mut iterations = [0, 0];
    for step in 1..=20_u32 {
        let taken = run.next().unwrap().unwrap();
        let most = &mut iterations[usize::from(step > 1)];
        *most = taken.report.iterations.max(*most);
        for j in 0..N {
            let mode = |k: usize| {
                let angle = k as f64 * core::f64::consts::PI / (N + 1) as f64;
                let shape = angle.sin() * ((j + 1) as f64 * angle).sin();
                2.0 / (N + 1) as f64 * shape * (2.0 * (0.5 * angle).sin() * 0.1 * f64::from(step)).cos()
            };
            let exact: f64 = (1..=N).map(mode).sum();
            assert!((taken.state.q[j] - exact).abs() < 1e-14, "{j} at step {step}");
        }
    }
    iterations
}

/// At the start there is neither momentum nor force for those far from the first, and so no size to hold
/// their residuals against.
#[test]
fn coordinates_start_to_move_one_after_the_other() {
    let [first, most] = iterations_of_a_front(&ThreeMasses {});
    assert!(first <= 20 && most <= 20, "{first}, {most}");
    // An iteration goes from each mass to the next: Newton's method, with its matrix of 192² entries, would
    // need few.
    let [first, most] = iterations_of_a_front(&ManyMasses {});
    assert!((23..=60).contains(&first) && most <= 60, "{first}, {most}");
}

/// Cubic drag, R = r v³/3: accelerates for v < 0, without bound.
#[rayleigh_system(rule = gauss)]
fn cubic_drag(q: [f64; 1], v: [f64; 1], m: f64, r: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0] - 0.0 * q[0], r * v[0].powi(3) / 3.0)
}

#[test]
fn what_has_no_solution_says_so() {
    // v̇ = −v²: from v = −2 the velocity is infinite at t = ½. One stage: v = p − hv²/2 has a root iff p ≥
    // −1/(2h).
    let system = CubicDrag { m: 1.0, r: 1.0 };
    let state = State { q: vector![0.0], p: vector![-2.0] };
    let mut trajectory = system.by(Gauss::<1>, 1.0).run(state);
    let error = trajectory.next().unwrap().unwrap_err();
    assert!(
        matches!(error, StepError::NoRealSolution { .. } | StepError::SingularNewtonMatrix { .. }),
        "{error}"
    );
    assert_eq!(trajectory.state(), &state);
    // Positive control: a step that the blow-up is beyond, v = v0/(1 + v0 t).
    trajectory.change_step_size(0.05);
    let mut state = state;
    for _ in 0..5 {
        state = trajectory.next().unwrap().unwrap().state;
    }
    assert!((state.p[0] + 2.0 / (1.0 - 2.0 * 0.25)).abs() < 0.1);
    let mut fine = system.by(Gauss::<6>, 0.05).run(State { q: vector![0.0], p: vector![-2.0] });
    let state = fine.by_ref().take(5).last().unwrap().unwrap().state;
    assert!((state.p[0] + 4.0).abs() < 1e-10, "{}", state.p[0]);
}

/// No kinetic energy in the second coordinate.
#[rayleigh_system(rule = gauss)]
fn degenerate(q: [f64; 2], v: [f64; 2]) -> f64 {
    0.5 * v[0] * v[0] - 0.5 * (q[0] * q[0] + q[1] * q[1])
}

/// A root: no number beyond the wall at q = 0.
#[rayleigh_system(rule = gauss)]
fn wall(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] + q[0].sqrt()
}

#[test]
fn every_failure_has_its_name() {
    let state = State { q: vector![0.3, 0.1], p: vector![0.2, 0.0] };
    let error = Degenerate {}.by(Gauss::<2>, 0.1).step(&state).unwrap_err();
    assert!(matches!(error, StepError::DegenerateLagrangian { column: 1 }), "{error}");
    let state = State { q: vector![-0.3], p: vector![0.2] };
    let error = Wall {}.by(Gauss::<2>, 0.1).step(&state).unwrap_err();
    assert!(
        matches!(error, StepError::NoDerivative { function: Function::Lagrangian, coordinate: 0, .. }),
        "{error}"
    );
    // Positive control.
    let state = State { q: vector![0.3], p: vector![0.2] };
    assert!(Wall {}.by(Gauss::<2>, 0.1).step(&state).is_ok());
}

#[test]
fn an_equilibrium_of_large_forces_is_a_step() {
    // Forces cancel at q = 1000: rounding of the spring's force is what is left.
    #[rayleigh_system(rule = gauss)]
    fn hanging(q: [f64; 1], v: [f64; 1], k: f64, g: f64) -> f64 {
        0.5 * v[0] * v[0] - 0.5 * k * q[0] * q[0] + g * q[0]
    }
    let system = Hanging { k: 0.7, g: 700.0 };
    let start = State { q: vector![1000.0], p: vector![0.0] };
    for step in system.by(Gauss::<4>, 0.3).run(start).take(100) {
        let step = step.unwrap();
        assert!((step.state.q[0] - 1000.0).abs() < 1e-10 && step.report.iterations < 30, "{step:?}");
    }
}

#[test]
fn neither_a_step_nor_a_run_allocates() {
    let start = State::from_velocity(&DoublePendulum::EXAMPLE, [1.1, -0.6], [0.3, 1.2]).unwrap();
    let stiff = Oscillator { k: 900.0, c: 0.0, cubic: 50.0 };
    let drag = CubicDrag { m: 1.0, r: 1.0 };
    let count = measure(|| {
        for step in DoublePendulum::EXAMPLE.by(Gauss::<4>, 0.1).run(start).take(100) {
            step.unwrap();
        }
        let oscillating = State { q: vector![1.0], p: vector![0.0] };
        let by_newton = stiff.by(Gauss::<6>, 0.5).run(oscillating).take(10);
        for step in by_newton {
            step.unwrap();
        }
        let failing = State { q: vector![0.0], p: vector![-2.0] };
        drag.by(Gauss::<1>, 1.0).step(&failing).unwrap_err();
        let step = DoublePendulum::EXAMPLE.by(Gauss::<3>, 0.1).step(&start).unwrap();
        let by = DoublePendulum::EXAMPLE.by(Gauss::<3>, 0.1);
        by.segment(&start.q, &step.state.q).unwrap().momenta().unwrap();
    });
    assert_eq!((count.count_total, count.bytes_total), (0, 0));
}

/// The double pendulum, lane by lane: what a lane holds can depend on no other.
struct OneByOne {
    /// The most lanes asked for, and whether those beyond the stages were copies of the last.
    seen: Cell<(usize, bool)>,
    stages: usize,
}

impl Lagrangian<2> for OneByOne {
    type Scalar = f64;

    fn lagrangian(&self, q: &SVector<f64, 2>, v: &SVector<f64, 2>) -> f64 {
        Lagrangian::lagrangian(&DoublePendulum::EXAMPLE, q, v)
    }

    fn lagrangian_derivatives(&self, q: &SVector<f64, 2>, v: &SVector<f64, 2>) -> Derivatives<f64, 2> {
        DoublePendulum::EXAMPLE.lagrangian_derivatives(q, v)
    }
}

impl ActingForce<2> for OneByOne {
    const HAS_RAYLEIGH: bool = true;

    fn dissipation_derivatives(&self, q: &SVector<f64, 2>, v: &SVector<f64, 2>) -> Derivatives<f64, 2> {
        DoublePendulum::EXAMPLE.dissipation_derivatives(q, v)
    }
}

impl ForcedLagrangian<2> for OneByOne {
    type Anchors<const S: usize> = [<DoublePendulum as ForcedLagrangian<2>>::Anchors<1>; S];

    fn stages<const S: usize>(
        &self,
        anchors: &mut Self::Anchors<S>,
        q: &LaneVector<f64, 2, S>,
        v: &LaneVector<f64, 2, S>,
        momenta: impl FnOnce(&LaneVector<f64, 2, S>) -> LaneVector<f64, 2, S>,
    ) -> Stages<f64, 2, S> {
        let lane = |lanes: &LaneVector<f64, 2, S>, i: usize| [Lanes([lanes[0].0[i]]), Lanes([lanes[1].0[i]])];
        let last = self.stages.min(S) - 1;
        let are_copies = (last..S).all(|i| lane(q, i) == lane(q, last) && lane(v, i) == lane(v, last));
        let (most, all) = self.seen.get();
        self.seen.set((most.max(S), all && are_copies));
        let at = |i: usize, anchors: &mut _, p: LaneVector<f64, 2, 1>| {
            DoublePendulum::EXAMPLE.stages::<1>(anchors, &lane(q, i), &lane(v, i), |_| p)
        };
        let none = [Lanes([0.0; S]); 2];
        let mut all = Stages { rate: none, residual: none, correction: none };
        for (i, mut anchors) in anchors.iter().copied().enumerate() {
            let rate = at(i, &mut anchors, [Lanes([0.0]); 2]).rate;
            all.rate.iter_mut().zip(rate).for_each(|(all, one)| all.0[i] = one.0[0]);
        }
        let p = momenta(&all.rate);
        for (i, anchors) in anchors.iter_mut().enumerate() {
            let one = at(i, anchors, lane(&p, i));
            for a in 0..2 {
                all.residual[a].0[i] = one.residual[a].0[0];
                all.correction[a].0[i] = one.correction[a].0[0];
            }
        }
        all
    }
}

fn lanes_do_not_mix<const S: usize>() {
    let start = State::from_velocity(&DoublePendulum::EXAMPLE, [0.8, -0.4], [0.0, 0.5]).unwrap();
    let alone = OneByOne { seen: Cell::new((0, true)), stages: S };
    for h in [0.02, 0.2] {
        for factor in [0.0, 1e-4] {
            let time = h * 30.0;
            let together = DoublePendulum::EXAMPLE.by(Gauss::<S>, h).run(start).solved_for(factor, time);
            let alone = alone.by(Gauss::<S>, h).run(start).solved_for(factor, time);
            for (one, other) in together.zip(alone).take(30) {
                assert_eq!(one.unwrap().state, other.unwrap().state, "{S} {h}");
            }
        }
    }
    let (most, are_copies) = alone.seen.get();
    // As many as vectors hold, and nothing of a stage's own in those beyond.
    assert!(
        are_copies && (S..=8).contains(&most) && most.is_multiple_of(if S > 1 { 2 } else { 1 }),
        "{S} {most}"
    );
}

#[test]
fn stages_in_more_lanes_than_there_are_stages_are_the_same_bit_by_bit() {
    lanes_do_not_mix::<3>();
    lanes_do_not_mix::<4>();
    lanes_do_not_mix::<5>();
    lanes_do_not_mix::<6>();
    lanes_do_not_mix::<7>();
}

/// Steps far below what the motion asks for, down to where h v is no last place of q.
#[test]
fn the_smallest_steps_are_taken() {
    let mut random = StdRng::seed_from_u64(41);
    for _ in 0..60 {
        let mut within = |range: f64| random.random_range(-range..range);
        let system = DoublePendulum::FREE;
        let start =
            State::from_velocity(&system, [within(2.0), within(2.0)], [within(6.0), within(6.0)]).unwrap();
        let size = start.q.amax().max(start.p.amax());
        for h in [1e-10, 1e-12, 1e-13, 1e-14, 1e-15, 1e-16, 1e-18, 1e-30] {
            let ends = [
                system.by(Gauss::<1>, h).run(start).nth(19),
                system.by(Gauss::<2>, h).run(start).nth(19),
                system.by(Gauss::<4>, h).run(start).nth(19),
                system.by(Gauss::<8>, h).run(start).nth(19),
            ];
            for end in ends {
                let end = end.unwrap().unwrap_or_else(|error| panic!("{h:e}, {start:?}: {error}")).state;
                // 20 steps move q and p by no more than rounding and the rate of this motion.
                let moved = (end.q - start.q).amax().max((end.p - start.p).amax());
                assert!(moved <= 20.0 * (200.0 * h + 4.0 * f64::EPSILON * size), "{h:e}: {moved:e}");
            }
        }
    }
}
