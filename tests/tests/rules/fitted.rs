//! The rules fitted to linear damping, and the one-sided one: what mathematics promises of them.

use dalembert::nalgebra::{SMatrix, SVector, matrix, vector};
use dalembert::step::{ClosedForm, DiscreteRayleigh, Segment};
use dalembert::{
    Discrete, Discretise, Fitted, FittedTrapezoidal, Lagrangian, Midpoint, OneSided, State, rayleigh_system,
};
use dalembert_tests::by_hand::{ByHand, Number};
use dalembert_tests::convergence::Convergence;
use dalembert_tests::reference;

/// A covector as a function of both ends.
type Covector<'f, const N: usize> = dyn Fn(&SVector<f64, N>, &SVector<f64, N>) -> SVector<f64, N> + 'f;

/// A pendulum with linear damping and a constant force, in one coordinate.
#[rayleigh_system(rule = [midpoint, fitted, fitted_trapezoidal, one_sided])]
fn pendulum(q: [f64; 1], v: [f64; 1], m: f64, g: f64, f: f64, r: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0] + g * q[0].cos() + f * q[0], 0.5 * r * v[0] * v[0])
}

impl ByHand<1> for Pendulum {
    fn lagrangian_by_hand<D: Number>(&self, [q]: [D; 1], [v]: [D; 1]) -> D {
        v * v * (self.m / 2.0) + q.cos() * self.g + q * self.f
    }

    fn acceleration(&self, [q]: [f64; 1], [v]: [f64; 1]) -> [f64; 1] {
        [(self.f - self.g * q.sin() - self.r * v) / self.m]
    }
}

/// Two coupled masses with damping that is not a multiple of the mass, in an anharmonic potential.
struct Coupled {
    m: [f64; 3],
    c: [f64; 3],
}

#[rayleigh_system(rule = [midpoint, fitted, fitted_trapezoidal])]
impl Coupled {
    fn form(a: [f64; 3], v: [f64; 2]) -> f64 {
        0.5 * (a[0] * v[0] * v[0] + a[2] * v[1] * v[1]) + a[1] * v[0] * v[1]
    }

    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let stretch = q[1] - q[0];
        Self::form(self.m, v) - 0.5 * q[0] * q[0] - 0.6 * stretch * stretch - 0.25 * stretch.powi(4)
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        Self::form(self.c, v)
    }
}

const COUPLED: Coupled = Coupled { m: [1.3, 0.4, 0.9], c: [0.5, -0.2, 0.7] };

impl ByHand<2> for Coupled {
    fn lagrangian_by_hand<D: Number>(&self, _: [D; 2], v: [D; 2]) -> D {
        let [a, b, c] = self.m;
        v[0] * v[0] * (a / 2.0) + v[1] * v[1] * (c / 2.0) + v[0] * v[1] * b
    }

    fn acceleration(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        let ([a, b, d], [e, f, g]) = (self.m, self.c);
        let stretch = q[1] - q[0];
        let pull = 1.2 * stretch + stretch.powi(3);
        let x = -q[0] + pull - e * v[0] - f * v[1];
        let y = -pull - f * v[0] - g * v[1];
        let det = a * d - b * b;
        [(d * x - b * y) / det, (a * y - b * x) / det]
    }
}

/// A particle in the plane, a radial potential and isotropic drag.
#[rayleigh_system(rule = [midpoint, fitted_trapezoidal])]
fn radial(q: [f64; 2], v: [f64; 2], m: f64, a: f64) -> (f64, f64) {
    let s = q[0] * q[0] + q[1] * q[1];
    let speed = v[0] * v[0] + v[1] * v[1];
    (0.5 * m * speed - s * (s - 1.0).powi(2), a * m * speed)
}

/// Largest errors of q and p at time `end`.
fn errors<S, R: Copy, const N: usize>(
    system: &S,
    rule: R,
    q: [f64; N],
    v: [f64; N],
    end: f64,
    h: f64,
) -> [f64; 2]
where
    S: Discrete<R, N, Scalar = f64> + ByHand<N>,
{
    let start = State::from_velocity(system, q, v).unwrap();
    let mut trajectory = system.by(rule, h).run(start);
    for _ in 0..(end / h).round() as u64 {
        trajectory.next().unwrap().unwrap();
    }
    let (q, v) = reference::motion(system, q, v, end);
    let exact = State::from_velocity(system, q, v).unwrap();
    let state = trajectory.state();
    [(state.q - exact.q).amax(), (state.p - exact.p).amax()]
}

fn orders<S, R: Copy, const N: usize>(system: &S, rule: R, q: [f64; N], v: [f64; N]) -> [f64; 2]
where
    S: Discrete<R, N, Scalar = f64> + ByHand<N>,
{
    let mut convergence = [Convergence::default(), Convergence::default()];
    for k in 3..9 {
        let h = 0.5_f64.powi(k);
        let errors = errors(system, rule, q, v, 2.0, h);
        convergence.iter_mut().zip(errors).for_each(|(convergence, error)| convergence.push(h, error));
    }
    convergence.map(|convergence| convergence.order(1e-11))
}

#[test]
fn the_fitted_rules_are_of_order_two() {
    let pendulum = Pendulum { m: 1.3, g: 2.1, f: 0.4, r: 0.8 };
    for order in [
        orders(&pendulum, Fitted, [1.1], [0.4]),
        orders(&pendulum, FittedTrapezoidal, [1.1], [0.4]),
        orders(&COUPLED, Fitted, [0.7, -0.3], [0.2, 0.9]),
        orders(&COUPLED, FittedTrapezoidal, [0.7, -0.3], [0.2, 0.9]),
    ]
    .concat()
    {
        assert!((order - 2.0).abs() < 0.06, "{order}");
    }
    for order in orders(&pendulum, OneSided, [1.1], [0.4]) {
        assert!((order - 1.0).abs() < 0.06, "{order}");
    }
}

/// q keeps its order however stiff the damping; the midpoint rule rings. The start is on the slow motion, r
/// v = −V′ to the first two orders.
#[test]
fn q_is_of_order_two_uniformly_in_stiffness() {
    for r in [1e1, 1e3, 1e5] {
        let system = Pendulum { m: 1.0, g: r, f: 0.0, r };
        // In the slow motion q̇ = −sin q (1 + (m/r) cos q …): start there.
        let q = 1.1_f64;
        let v = -q.sin() * (1.0 - system.m / r * q.cos());
        // The slow motion of q at t = 1, to O(m²/r²), by the reference for moderate r, in closed form for
        // stiff damping.
        let exact = if r < 1e2 {
            reference::motion(&system, [q], [v], 1.0).0[0]
        } else {
            // tan(q/2) = tan(q0/2) e^{−t}, and m/r times the first correction, sin q ∫ … = −sin q ln(…)
            2.0 * ((0.5 * q).tan() * (-1.0_f64).exp()).atan()
        };
        let error = |h: f64| {
            let start = State::from_velocity(&system, [q], [v]).unwrap();
            let mut trajectory = system.by(Fitted, h).run(start);
            for _ in 0..(1.0 / h).round() as u64 {
                trajectory.next().unwrap().unwrap();
            }
            trajectory.state().q[0] - exact
        };
        // With the model's error m/r taken out: differences between step sizes.
        let [a, b, c] = [0.1, 0.05, 0.025].map(error);
        let order = ((a - b) / (b - c)).log2();
        assert!((order - 2.0).abs() < 0.25, "r = {r:e}: order {order}");
        assert!(c.abs() < 1e-4 + 2.0 / r, "r = {r:e}: {c:e}");
    }
}

#[test]
fn a_free_mass_decays_exactly() {
    let (m, h) = (1.3, 0.5);
    for z in [1e-6, 0.1, 1.0, 3.0, 10.0] {
        let system = Pendulum { m, g: 0.0, f: 0.0, r: 2.0 * m * z / h };
        let start = State { q: vector![0.2], p: vector![1.0] };
        let travelled = |p: f64| p / system.r * -(-2.0 * z).exp_m1();
        for step in [
            system.by(Fitted, h).step(&start).unwrap(),
            system.by(FittedTrapezoidal, h).step(&start).unwrap(),
        ] {
            // To rounding of the momentum given.
            assert!((step.state.p[0] - (-2.0 * z).exp()).abs() < 4e-16, "{z}: {}", step.state.p[0]);
            assert!((step.state.q[0] - 0.2 - travelled(1.0)).abs() < 4e-16, "{z}: {}", step.state.q[0]);
        }
        let step = system.by(OneSided, h).step(&start).unwrap();
        assert!((step.state.p[0] - (1.0 + z).powi(-2)).abs() < 4e-16, "{z}: {}", step.state.p[0]);
        // The control: the midpoint rule turns back for z > 1.
        let step = system.by(Midpoint, h).step(&start).unwrap();
        assert!((step.state.p[0] - (1.0 - z) / (1.0 + z)).abs() < 4e-16 * (1.0 + z));
    }
}

#[test]
fn equilibria_and_terminal_velocities_are_exact() {
    for r in [0.1, 10.0, 1e5] {
        let falling = Pendulum { m: 1.3, g: 0.0, f: 0.7, r };
        let start = State::from_velocity(&falling, [0.3], [0.7 / r]).unwrap();
        // By the explicit rule the same velocity has the momentum z coth z m v.
        let z = 0.25 * r / 1.3;
        let explicit = State { p: start.p * (z / z.tanh()), ..start };
        for (step, p) in [
            (falling.by(Fitted, 0.5).step(&start).unwrap(), start.p[0]),
            (falling.by(FittedTrapezoidal, 0.5).step(&explicit).unwrap(), explicit.p[0]),
        ] {
            assert!((step.velocity[0] * r / 0.7 - 1.0).abs() < 1e-14, "{r}: {step:?}");
            // The rounding of the impulses hf/2 on both ends.
            assert!((step.state.p[0] - p).abs() < 4.0 * f64::EPSILON * (p + 0.35), "{r}: {step:?} {p}");
        }
        // sin q = f/g
        let resting = Pendulum { m: 1.3, g: 1.4, f: 0.7, r };
        let start = State { q: vector![0.5_f64.asin()], p: vector![0.0] };
        for step in [
            resting.by(Fitted, 0.5).step(&start).unwrap(),
            resting.by(FittedTrapezoidal, 0.5).step(&start).unwrap(),
        ] {
            assert!((step.state.q - start.q).amax() < 1e-15 && step.state.p.amax() < 1e-15, "{step:?}");
        }
    }
}

#[test]
fn without_damping_they_are_the_plain_rules() {
    let system = Pendulum { m: 1.3, g: 2.1, f: 0.4, r: 0.0 };
    let start = State::from_velocity(&system, [1.1], [0.4]).unwrap();
    let a = system.by(Fitted, 0.3).step(&start).unwrap().state;
    for b in [
        system.by(Midpoint, 0.3).step(&start).unwrap().state,
        system.by(OneSided, 0.3).step(&start).unwrap().state,
    ] {
        assert!((a.q - b.q).amax() < 1e-15 && (a.p - b.p).amax() < 1e-15, "{a:?} {b:?}");
    }
}

fn returns<S, R: Copy, const N: usize>(system: &S, _: R, start: State<f64, N>, h: f64) -> f64
where
    S: Discrete<R, N, Scalar = f64>,
{
    let there = system.step(&start, h, None).unwrap().state;
    let back = system.step(&there, -h, None).unwrap().state;
    (back.q - start.q).amax().max((back.p - start.p).amax())
}

#[test]
fn they_are_self_adjoint() {
    let pendulum = Pendulum { m: 1.3, g: 2.1, f: 0.4, r: 0.8 };
    let start = State { q: vector![1.1], p: vector![0.5] };
    assert!(returns(&pendulum, Fitted, start, 0.3) < 2e-15);
    assert!(returns(&pendulum, FittedTrapezoidal, start, 0.3) < 2e-15);
    // The control: the one-sided rule is not.
    assert!(returns(&pendulum, OneSided, start, 0.3) > 1e-3);
    let start = State { q: vector![0.7, -0.3], p: vector![0.2, 0.9] };
    assert!(returns(&COUPLED, Fitted, start, 0.3) < 4e-15);
    assert!(returns(&COUPLED, FittedTrapezoidal, start, 0.3) < 4e-15);
}

/// The matrices of the step from the transforms: p0 = −D1 L_d − f_d⁻ and p1 = D2 L_d + f_d⁺, and R_d where
/// there is one.
#[test]
fn discrete_objects_and_transforms_agree() {
    fn agree<S, R: Copy, const N: usize>(system: &S, _: R, q0: SVector<f64, N>, q1: SVector<f64, N>)
    where
        S: ClosedForm<R, N, Scalar = f64>,
    {
        let h = 0.3;
        let l = system.discrete_lagrangian_derivatives(&Segment::between(&q0, &q1, h));
        let f = system.discrete_force_derivatives(&Segment::between(&q0, &q1, h));
        let momenta = system.momenta(&Segment::between(&q0, &q1, h));
        let kernel = system.step_kernel(&Segment::between(&q0, &q1, h));
        assert!((l.value - system.discrete_lagrangian(&Segment::between(&q0, &q1, h))).abs() < 1e-15);
        assert!(
            (-l.d1 - f.minus.value - momenta.p0).amax() < 1e-14 && (kernel.p0 - momenta.p0).amax() < 1e-14
        );
        assert!((l.d2 + f.plus.value - momenta.p1).amax() < 1e-14);
        let force = system.discrete_force(&Segment::between(&q0, &q1, h));
        assert!((force.minus - f.minus.value).amax() < 1e-15 && (force.plus - f.plus.value).amax() < 1e-15);
        let e = 1e-5;
        for j in 0..N {
            let mut step = SVector::<f64, N>::zeros();
            step[j] = e;
            let by = |g: &Covector<'_, N>| {
                [
                    (g(&(q0 + step), &q1) - g(&(q0 - step), &q1)) / (2.0 * e),
                    (g(&q0, &(q1 + step)) - g(&q0, &(q1 - step))) / (2.0 * e),
                ]
            };
            let minus = by(&|a, b| system.discrete_force(&Segment::between(a, b, h)).minus);
            let plus = by(&|a, b| system.discrete_force(&Segment::between(a, b, h)).plus);
            let d1 = by(&|a, b| system.discrete_lagrangian_derivatives(&Segment::between(a, b, h)).d1);
            let value = |a: &SVector<f64, N>, b: &SVector<f64, N>| {
                system.discrete_lagrangian(&Segment::between(a, b, h))
            };
            assert!(
                (minus[0] - f.minus.d1.column(j)).amax() < 1e-8
                    && (minus[1] - f.minus.d2.column(j)).amax() < 1e-8
            );
            assert!(
                (plus[0] - f.plus.d1.column(j)).amax() < 1e-8
                    && (plus[1] - f.plus.d2.column(j)).amax() < 1e-8
            );
            assert!((d1[0] - l.d11.column(j)).amax() < 1e-8 && (d1[1] - l.d12.column(j)).amax() < 1e-8);
            assert!(
                ((value(&q0, &(q1 + step)) - value(&q0, &(q1 - step))) / (2.0 * e) - l.d2[j]).abs() < 1e-8
            );
            let p0 = by(&|a, b| system.momenta(&Segment::between(a, b, h)).p0);
            assert!((p0[1] * h - SMatrix::<f64, N, N>::from(kernel.matrix_dense()).column(j)).amax() < 1e-8);
        }
    }
    trait Dense<const N: usize> {
        fn matrix_dense(&self) -> SMatrix<f64, N, N>;
    }
    impl<const N: usize, M: dalembert::step::NewtonMatrix<f64, N>> Dense<N>
        for dalembert::step::StepKernel<f64, N, M>
    {
        fn matrix_dense(&self) -> SMatrix<f64, N, N> {
            self.matrix.dense()
        }
    }
    let pendulum = Pendulum { m: 1.3, g: 2.1, f: 0.4, r: 4.8 };
    let (a, b) = (vector![0.4], vector![0.9]);
    agree(&pendulum, Fitted, a, b);
    agree(&pendulum, FittedTrapezoidal, a, b);
    agree(&pendulum, OneSided, a, b);
    let (c, d) = (vector![0.4, 0.1], vector![0.9, -0.3]);
    agree(&COUPLED, Fitted, c, d);
    agree(&COUPLED, FittedTrapezoidal, c, d);

    fn rayleigh<S, R: Copy, const N: usize>(system: &S, _: R, q0: SVector<f64, N>, q1: SVector<f64, N>)
    where
        S: DiscreteRayleigh<R, N, Scalar = f64>,
    {
        let r = system.discrete_rayleigh_derivatives(&Segment::between(&q0, &q1, 0.3));
        let f = system.discrete_force(&Segment::between(&q0, &q1, 0.3));
        assert!((r.d1 - f.minus).amax() < 1e-14 && (r.d2 + f.plus).amax() < 1e-14);
        let mut step = SVector::<f64, N>::zeros();
        step[0] = 1e-5;
        let value =
            |a: &SVector<f64, N>, b: &SVector<f64, N>| system.discrete_rayleigh(&Segment::between(a, b, 0.3));
        assert!(((value(&(q0 + step), &q1) - value(&(q0 - step), &q1)) / 2e-5 - r.d1[0]).abs() < 1e-9);
        assert!(((value(&q0, &(q1 + step)) - value(&q0, &(q1 - step))) / 2e-5 - r.d2[0]).abs() < 1e-9);
        assert!((value(&q0, &q1) - r.value).abs() < 1e-15);
    }
    rayleigh(&pendulum, Fitted, a, b);
    rayleigh(&pendulum, FittedTrapezoidal, a, b);
    rayleigh(&COUPLED, FittedTrapezoidal, c, d);
}

/// det ∂(q1, p1)/∂(q0, p0) = e^{−h tr M⁻¹C}, for every V and any C.
#[test]
fn the_explicit_one_contracts_phase_space_as_the_flow() {
    let h = 0.3;
    let state = State { q: vector![0.7, -0.3], p: vector![0.2, 0.9] };
    let step = COUPLED.by(FittedTrapezoidal, h).step(&state).unwrap().state;
    let a = COUPLED
        .by(FittedTrapezoidal, h)
        .segment(&state.q, &step.q)
        .unwrap()
        .linearized()
        .unwrap()
        .by_state()
        .unwrap()
        .assembled::<4>();
    let (m, c) = (matrix![1.3, 0.4; 0.4, 0.9], matrix![0.5, -0.2; -0.2, 0.7]);
    let trace = (m.try_inverse().unwrap() * c).trace();
    let det = a.determinant();
    assert!((det / (-h * trace).exp() - 1.0).abs() < 1e-13, "{det}");
}

/// J falls by e^{−2ah} a step, exactly, in a radial potential with isotropic drag.
#[test]
fn the_explicit_one_keeps_the_law_of_angular_momentum() {
    let (m, a, h) = (1.3, 0.2, 0.1);
    let system = Radial { m, a };
    let start = State::from_velocity(&system, [0.0, 1.15], [0.5, 0.0]).unwrap();
    let mut j = start.q.perp(&start.p);
    for step in system.by(FittedTrapezoidal, h).run(start).take(200) {
        let state = step.unwrap().state;
        let next = state.q.perp(&state.p);
        assert!((next / j - (-2.0 * a * h).exp()).abs() < 1e-13, "{next} {j}");
        j = next;
    }
    // The control: by the midpoint rule it falls by another factor, which depends on the place.
    let by_midpoint = system.by(Midpoint, h).step(&start).unwrap().state;
    let ratio = by_midpoint.q.perp(&by_midpoint.p) / start.q.perp(&start.p);
    assert!((ratio - (-2.0 * a * h).exp()).abs() > 1e-7, "{ratio}");
}

/// Stable iff h²k/m < 4φ(z), φ = z coth z.
#[test]
fn the_explicit_one_is_stable_up_to_its_bound() {
    for z in [0.1_f64, 2.0, 20.0] {
        let (m, h) = (1.0, 1.0);
        let bound = 4.0 * z / z.tanh();
        let grows = |share: f64| {
            // V = −g cos q is ½gq² near 0.
            let system = Pendulum { m, g: share * bound, f: 0.0, r: 2.0 * z };
            let start = State { q: vector![1e-8], p: vector![0.0] };
            let last = system.by(FittedTrapezoidal, h).run(start).take(2_000).last().unwrap().unwrap();
            last.state.q[0].abs() > 1e-7
        };
        assert!(!grows(0.98) && grows(1.02), "{z}");
    }
}

/// The energy of the fitted rule falls in an overdamped motion at every step; that of the midpoint rule's
/// momentum rings.
#[test]
fn it_does_not_ring() {
    let system = Pendulum { m: 1.0, g: 1.0, f: 0.0, r: 1e4 };
    let start = State::from_velocity(&system, [1.0], [1.0]).unwrap();
    let changes = |signs: Vec<bool>| signs.windows(2).filter(|pair| pair[0] != pair[1]).count();
    let fitted = system.by(Fitted, 0.1).run(start).take(100).map(|s| s.unwrap().state.p[0] > 0.0).collect();
    let midpoint =
        system.by(Midpoint, 0.1).run(start).take(100).map(|s| s.unwrap().state.p[0] > 0.0).collect();
    assert!(changes(fitted) <= 1 && changes(midpoint) > 90);
    assert!(system.energy(&vector![1.0], &vector![0.0]) < 0.0);
}
