//! Inputs and time: a force that takes u, and L, R and f that take t, by both rules and both engines, in both
//! precisions.

/// The systems, with the engine named.
macro_rules! systems {
    ($engine:ident) => {
        use dalembert::rayleigh_system;

        /// A cart on a rail with a pole, pushed by u; q is (position, angle of the pole from below).
        pub struct CartPole {
            pub m: [f64; 2],
            pub l: f64,
            pub g: f64,
            pub c: [f64; 2],
        }

        #[rayleigh_system(rule = [midpoint, trapezoidal, gauss], derivatives = $engine)]
        impl CartPole {
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let [cart, pole] = self.m;
                let kinetic = 0.5 * (cart + pole) * v[0] * v[0]
                    + pole * self.l * q[1].cos() * v[0] * v[1]
                    + 0.5 * pole * self.l * self.l * v[1] * v[1];
                kinetic + pole * self.g * self.l * q[1].cos()
            }

            pub fn rayleigh(&self, v: [f64; 2]) -> f64 {
                0.5 * (self.c[0] * v[0] * v[0] + self.c[1] * v[1] * v[1])
            }

            pub fn force(&self, _q: [f64; 2], _v: [f64; 2], u: [f64; 1]) -> [f64; 2] {
                [u[0], 0.0]
            }
        }

        /// Everything depends on time, and the input acts nonlinearly.
        pub struct Storm {
            pub k: f64,
        }

        #[rayleigh_system(rule = [midpoint, trapezoidal, gauss], derivatives = $engine)]
        impl Storm {
            const M: usize = 3;
            const GUST: f64 = 0.3;

            fn lagrangian(&self, q: [f64; 2], v: [f64; 2], t: f64) -> f64 {
                let mass = 1.0 + 0.2 * (2.0 * t).cos() + 0.1 * q[0].sin();
                0.5 * mass * (v[0] * v[0] + v[1] * v[1]) - self.k * (q[0] - q[1] - t.sin()).powi(4)
            }

            fn rayleigh(&self, q: [f64; 2], v: [f64; 2], t: f64) -> f64 {
                Self::drag(q[1], t) * (v[0] * v[0] + v[0] * v[1] + v[1] * v[1])
            }

            fn force(&self, q: [f64; 2], v: [f64; 2], u: [f64; Self::M], t: f64) -> [f64; 2] {
                let valve = if u[2] > 0.0 { u[2] * u[2] } else { 0.0 };
                [u[0] * q[1] + Self::GUST * t * v[1], u[1].sin() * v[0] - valve * (q[0] + t)]
            }

            fn drag(x: f64, t: f64) -> f64 {
                0.1 + x * x / (1.0 + t * t)
            }
        }

        /// Time in R alone.
        #[derive(Clone, Copy)]
        pub struct Worn {
            pub r: f64,
        }

        #[rayleigh_system(rule = [midpoint, trapezoidal, gauss], derivatives = $engine)]
        impl Worn {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                0.5 * v[0] * v[0] + q[0].cos()
            }

            fn rayleigh(&self, v: [f64; 1], t: f64) -> f64 {
                0.5 * self.r * (1.0 + t) * v[0] * v[0]
            }
        }

        /// Single precision, time in the force alone.
        pub struct Shaken {
            pub omega: f32,
        }

        #[rayleigh_system(rule = [midpoint, trapezoidal, gauss], derivatives = $engine)]
        impl Shaken {
            fn lagrangian(&self, q: [f32; 1], v: [f32; 1]) -> f32 {
                0.5 * v[0] * v[0] + q[0].cos()
            }

            fn force(&self, q: [f32; 1], _v: [f32; 1], t: f32) -> [f32; 1] {
                [(self.omega * t).sin() * q[0].cos()]
            }
        }

        /// Single precision, with an input.
        pub struct Pushed {
            pub m: f32,
        }

        #[rayleigh_system(rule = [midpoint, trapezoidal, gauss], derivatives = $engine)]
        impl Pushed {
            fn lagrangian(&self, q: [f32; 1], v: [f32; 1]) -> f32 {
                0.5 * self.m * v[0] * v[0] + q[0].cos()
            }

            fn force(&self, q: [f32; 1], v: [f32; 1], u: [f32; 2]) -> [f32; 1] {
                [u[0] * q[0] - u[1] * u[1] * v[0]]
            }
        }

        /// A free particle under a force that is a function of time: its momentum is a quadrature.
        pub struct Falling;

        #[rayleigh_system(rule = [midpoint, trapezoidal, gauss], derivatives = $engine)]
        impl Falling {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
                0.5 * v[0] * v[0] + q[0] * t.exp()
            }

            fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1], t: f64) -> [f64; 1] {
                [u[0] + t.cos()]
            }
        }
    };
}

/// Derivatives written out.
mod expanded {
    systems!(expanded);
}

/// Derivatives by num-dual.
mod num_dual {
    systems!(num_dual);
}

use dalembert::nalgebra::{SMatrix, SVector, vector};
use dalembert::step::{ClosedForm, DiscreteDriven, Fused, NewtonMatrix, Segment};
use dalembert::system::{Blank, Direction, ForcedLagrangian, Lanes, Scalar};
use dalembert::{
    Composition, Discrete, Discretise, EnergyLedger, Force, Gauss, Lagrangian, Midpoint, Rayleigh, State,
    Trapezoidal,
};

/// The largest difference seen, in units of 64 roundings of the largest entry.
#[derive(Default)]
struct Difference(f64);

impl Difference {
    fn of<S: Scalar, const R: usize, const C: usize>(&mut self, a: SMatrix<S, R, C>, b: SMatrix<S, R, C>) {
        let scale = 1.0 + a.iter().chain(b.iter()).fold(0.0_f64, |scale, x| scale.max(x.widen().abs()));
        for (a, b) in a.iter().zip(b.iter()) {
            let difference = (a.widen() - b.widen()).abs() / (64.0 * S::EPSILON.widen() * scale);
            assert!(!difference.is_nan(), "NaN");
            self.0 = self.0.max(difference);
        }
    }
}

/// Points spread over [−1, 1], the same for every run.
fn points<S: Scalar, const N: usize>() -> impl Iterator<Item = (SVector<S, N>, SVector<S, N>)> {
    (0..20_u32).map(|k| {
        let spread = |i: usize, shift: f64| {
            let phase = f64::from(k) * 0.754_877_666 + i as f64 * 0.569_840_291 + shift;
            S::constant(2.0 * phase.fract() - 1.0)
        };
        (SVector::from_fn(|i, _| spread(i, 0.1)), SVector::from_fn(|i, _| spread(i, 0.4)))
    })
}

/// All that a rule offers of two systems.
fn compare<A, B, R, const N: usize>(a: &A, b: &B, difference: &mut Difference)
where
    A: ClosedForm<R, N> + Force<N>,
    B: ClosedForm<R, N, Scalar = A::Scalar> + Force<N>,
{
    let constant = A::Scalar::constant;
    let h = constant(0.15);
    let direction = Direction { first: constant(-0.3), second: constant(1.1) };
    for (q, v) in points::<A::Scalar, N>() {
        let (la, lb) = (a.lagrangian_derivatives(&q, &v), b.lagrangian_derivatives(&q, &v));
        difference.of(la.d1, lb.d1);
        difference.of(la.d12, lb.d12);
        difference.of(la.d22, lb.d22);
        difference.of(a.force(&q, &v), b.force(&q, &v));
        let (fa, fb) = (a.force_derivatives(&q, &v), b.force_derivatives(&q, &v));
        difference.of(fa.d1, fb.d1);
        difference.of(fa.d2, fb.d2);
        difference.of(a.force_variation(&q, &v, direction).1, b.force_variation(&q, &v, direction).1);
        let (ka, kb) = (a.step_kernel(&Segment { q0: q, v, h }), b.step_kernel(&Segment { q0: q, v, h }));
        difference.of(ka.p0, kb.p0);
        difference.of(ka.matrix.dense(), kb.matrix.dense());
        let (ma, mb) = (a.momenta(&Segment { q0: q, v, h }), b.momenta(&Segment { q0: q, v, h }));
        difference.of(ma.p0, mb.p0);
        difference.of(ma.p1, mb.p1);
        let q1 = q + v * h;
        let (da, db) = (
            a.discrete_lagrangian_derivatives(&Segment::between(&q, &q1, h)),
            b.discrete_lagrangian_derivatives(&Segment::between(&q, &q1, h)),
        );
        difference.of(vector![da.value], vector![db.value]);
        difference.of(vector![da.value], vector![a.discrete_lagrangian(&Segment::between(&q, &q1, h))]);
        difference.of(da.d11, db.d11);
        let (fa, fb) = (
            a.discrete_force_derivatives(&Segment::between(&q, &q1, h)),
            b.discrete_force_derivatives(&Segment::between(&q, &q1, h)),
        );
        difference.of(fa.plus.value, fb.plus.value);
        difference.of(fa.minus.d2, fb.minus.d2);
        // Written out by hand from L_d and f_d, the momenta are the kernel's.
        difference.of(-da.d1 - fa.minus.value, ma.p0);
        difference.of(da.d2 + fa.plus.value, ma.p1);
        difference.of(-(da.d12 + fa.minus.d2) * h, ka.matrix.dense());
        difference.of(
            vector![a.segment_energy(&Segment::between(&q, &q1, h))],
            vector![b.segment_energy(&Segment::between(&q, &q1, h))],
        );
    }
}

fn compare_inputs<A, B, R, const N: usize, const M: usize>(a: &A, b: &B, difference: &mut Difference)
where
    A: ClosedForm<R, N> + DiscreteDriven<R, N, M>,
    B: ClosedForm<R, N> + DiscreteDriven<R, N, M, Scalar = A::Scalar>,
    R: Default,
{
    compare::<A, B, R, N>(a, b, difference);
    let h = A::Scalar::constant(0.15);
    for (q, v) in points::<A::Scalar, N>() {
        difference.of(a.force_by_input(&q, &v), b.force_by_input(&q, &v));
        let q1 = q + v * h;
        let (by_a, by_b) = (a.by(R::default(), h), b.by(R::default(), h));
        let (a, b) = (by_a.segment(&q, &q1).unwrap(), by_b.segment(&q, &q1).unwrap());
        let (a, b) = (a.linearized().unwrap(), b.linearized().unwrap());
        let (a, b) = (a.by_input::<M>().unwrap(), b.by_input::<M>().unwrap());
        difference.of(a.q, b.q);
        difference.of(a.p, b.p);
    }
}

#[test]
fn the_engines_agree() {
    let mut difference = Difference::default();
    let (m, l, g, c) = ([1.0, 0.3], 0.5, 9.81, [0.1, 0.02]);
    let (a, b) = (expanded::CartPole { m, l, g, c }, num_dual::CartPole { m, l, g, c });
    compare_inputs::<_, _, Midpoint, 2, 1>(&a.driven([0.7]), &b.driven([0.7]), &mut difference);
    compare_inputs::<_, _, Trapezoidal, 2, 1>(&a.driven([0.7]), &b.driven([0.7]), &mut difference);
    let (a, b) = (expanded::Storm { k: 0.4 }, num_dual::Storm { k: 0.4 });
    for valve in [0.8, -0.8] {
        let u = [0.5, -1.2, valve];
        compare_inputs::<_, _, Midpoint, 2, 3>(&a.driven(u, 0.6), &b.driven(u, 0.6), &mut difference);
        compare_inputs::<_, _, Trapezoidal, 2, 3>(&a.driven(u, 0.6), &b.driven(u, 0.6), &mut difference);
    }
    let (a, b) = (expanded::Shaken { omega: 3.0 }, num_dual::Shaken { omega: 3.0 });
    compare::<_, _, Midpoint, 1>(&a.at_time(0.6), &b.at_time(0.6), &mut difference);
    compare::<_, _, Trapezoidal, 1>(&a.at_time(0.6), &b.at_time(0.6), &mut difference);
    let (a, b) = (expanded::Pushed { m: 1.5 }, num_dual::Pushed { m: 1.5 });
    compare_inputs::<_, _, Midpoint, 1, 2>(&a.driven([0.3, 0.2]), &b.driven([0.3, 0.2]), &mut difference);
    compare_inputs::<_, _, Trapezoidal, 1, 2>(&a.driven([0.3, 0.2]), &b.driven([0.3, 0.2]), &mut difference);
    assert!(difference.0 <= 1.0, "{} times the tolerance", difference.0);

    // Positive control: a time that is off by 1e-9 is told apart.
    let (a, b) = (expanded::Storm { k: 0.4 }, num_dual::Storm { k: 0.4 });
    compare_inputs::<_, _, Midpoint, 2, 3>(
        &a.driven([0.5; 3], 0.6),
        &b.driven([0.5; 3], 0.6 + 1e-9),
        &mut difference,
    );
    assert!(difference.0 > 1.0);
}

/// p1 − p0 = h Σ bᵢ (eᵗ + u + cos t) at t0 + cᵢ h, in closed form: every node sees its own time, for L and
/// for f.
#[test]
fn every_node_sees_its_own_time() {
    let (t, h, u) = (0.4_f64, 0.3, 0.25);
    let acceleration = |t: f64| t.exp() + t.cos() + u;
    let midpoint = h * acceleration(t + h / 2.0);
    let trapezoidal = h / 2.0 * (acceleration(t) + acceleration(t + h));
    let state = State { q: vector![0.2], p: vector![1.0] };
    fn impulse<R, L: Discrete<R, 1, Scalar = f64>>(system: &L, state: &State<f64, 1>, h: f64) -> f64 {
        system.step(state, h, None).unwrap().state.p[0] - state.p[0]
    }
    let a = expanded::Falling.driven([u], t);
    let b = num_dual::Falling.driven(vector![u], t);
    for (found, expected) in [
        (impulse::<Midpoint, _>(&a, &state, h), midpoint),
        (impulse::<Midpoint, _>(&b, &state, h), midpoint),
        (impulse::<Trapezoidal, _>(&a, &state, h), trapezoidal),
        (impulse::<Trapezoidal, _>(&b, &state, h), trapezoidal),
    ] {
        assert!((found - expected).abs() < 4e-16, "{found} {expected}");
    }
    // Nodes and weights of Gauss and Legendre on [0, 1], from tables: ½ ∓ √3/6, ½ ∓ √15/10.
    let (two, three) = (3.0_f64.sqrt() / 6.0, 15.0_f64.sqrt() / 10.0);
    let two = h / 2.0 * (acceleration(t + h * (0.5 - two)) + acceleration(t + h * (0.5 + two)));
    let outer = acceleration(t + h * (0.5 - three)) + acceleration(t + h * (0.5 + three));
    let three = h / 18.0 * (5.0 * outer + 8.0 * acceleration(t + h / 2.0));
    for (found, expected) in [
        (impulse::<Gauss<1>, _>(&a, &state, h), midpoint),
        (impulse::<Gauss<1>, _>(&b, &state, h), midpoint),
        (impulse::<Gauss<2>, _>(&a, &state, h), two),
        (impulse::<Gauss<2>, _>(&b, &state, h), two),
        (impulse::<Gauss<3>, _>(&a, &state, h), three),
        (impulse::<Gauss<3>, _>(&b, &state, h), three),
    ] {
        assert!((found - expected).abs() < 4e-16, "{found} {expected}");
    }
    // By the eighth, the integral itself.
    let integral = (t + h).exp() - t.exp() + (t + h).sin() - t.sin() + u * h;
    assert!((impulse::<Gauss<8>, _>(&a, &state, h) - integral).abs() < 4e-16);
    assert!((two - midpoint).abs() > 1e-4 && (two - three).abs() > 1e-8, "positive control");
    // Positive control: the start's time for all nodes, or that of the other rule, is another number.
    assert!((h * acceleration(t) - midpoint).abs() > 1e-2 && (midpoint - trapezoidal).abs() > 1e-3);
}

/// The motion of the time-dependent system by the classical Runge–Kutta method with very small steps.
fn reference(
    system: &expanded::Storm,
    u: [f64; 3],
    t0: f64,
    q: SVector<f64, 2>,
    v: SVector<f64, 2>,
    end: f64,
) -> SVector<f64, 2> {
    // d/dt ∂L/∂v = ∂L/∂q − ∂R/∂v + f, with p for ∂L/∂v: ṗ and q̇ of (q, p).
    let flow = |t: f64, q: SVector<f64, 2>, p: SVector<f64, 2>| {
        let view = system.driven(u, t);
        let v = State { q, p }.velocity(&view).unwrap();
        let slope =
            view.lagrangian_gradient(&q, &v).d1 - view.rayleigh_gradient(&q, &v).d2 + view.force(&q, &v);
        (v, slope)
    };
    let steps = 4000;
    let h = (end - t0) / f64::from(steps);
    let mut state = State::from_velocity(&system.driven(u, t0), q, v).unwrap();
    for k in 0..steps {
        let t = t0 + h * f64::from(k);
        let (q, p) = (state.q, state.p);
        let (q1, p1) = flow(t, q, p);
        let (q2, p2) = flow(t + h / 2.0, q + q1 * (h / 2.0), p + p1 * (h / 2.0));
        let (q3, p3) = flow(t + h / 2.0, q + q2 * (h / 2.0), p + p2 * (h / 2.0));
        let (q4, p4) = flow(t + h, q + q3 * h, p + p3 * h);
        state.q = q + (q1 + (q2 + q3) * 2.0 + q4) * (h / 6.0);
        state.p = p + (p1 + (p2 + p3) * 2.0 + p4) * (h / 6.0);
    }
    state.q
}

fn end_of_trajectory<R: Copy, L>(
    system: &L,
    rule: R,
    steps: u32,
    start: State<f64, 2>,
    length: f64,
) -> SVector<f64, 2>
where
    L: Discrete<R, 2, Scalar = f64>,
{
    let mut trajectory = system.by(rule, length / f64::from(steps)).run(start);
    for step in trajectory.by_ref().take(steps as usize) {
        step.unwrap();
    }
    assert!((trajectory.time() - length).abs() < 1e-14);
    trajectory.state().q
}

/// Input of the storm, and the time from which it is driven.
const WIND: [f64; 3] = [0.5, -1.2, 0.8];
const START: f64 = 0.3;

/// The storm from then on, its state there, and where it is 1.5 later.
fn storm() -> (expanded::DrivenStorm<'static>, State<f64, 2>, SVector<f64, 2>) {
    static STORM: expanded::Storm = expanded::Storm { k: 0.4 };
    let (q, v) = (vector![0.4, -0.3], vector![0.2, 0.5]);
    let view = STORM.driven(WIND, START);
    let exact = reference(&STORM, WIND, START, q, v, START + 1.5);
    (view, State::from_velocity(&view, q, v).unwrap(), exact)
}

/// Order 2 along a trajectory whose time advances; a step that forgot its time would leave an error of order
/// 0.
#[test]
fn a_trajectory_carries_the_time_on() {
    let (view, start, exact) = storm();
    let error = |by_midpoint: bool, steps: u32| {
        let found = if by_midpoint {
            end_of_trajectory(&view, Midpoint, steps, start, 1.5)
        } else {
            end_of_trajectory(&view, Trapezoidal, steps, start, 1.5)
        };
        (found - exact).amax()
    };
    for by_midpoint in [true, false] {
        let (coarse, fine) = (error(by_midpoint, 60), error(by_midpoint, 240));
        let order = (coarse / fine).log2() / 2.0;
        assert!((order - 2.0).abs() < 0.05, "{order}: {coarse} {fine}");
        assert!(fine < 1e-4);
    }
}

/// Order 2S along a trajectory in time.
#[test]
fn gauss_rules_keep_their_order_in_time() {
    let (view, start, exact) = storm();
    fn error<const S: usize>(
        view: &impl Discrete<Gauss<S>, 2, Scalar = f64>,
        steps: u32,
        start: State<f64, 2>,
        exact: SVector<f64, 2>,
    ) -> f64 {
        (end_of_trajectory(view, Gauss::<S>, steps, start, 1.5) - exact).amax()
    }
    for (order, coarse, fine) in [
        (2.0, error::<1>(&view, 60, start, exact), error::<1>(&view, 120, start, exact)),
        (4.0, error::<2>(&view, 24, start, exact), error::<2>(&view, 48, start, exact)),
        (6.0, error::<3>(&view, 12, start, exact), error::<3>(&view, 24, start, exact)),
    ] {
        let found = (coarse / fine).log2();
        assert!((found - order).abs() < 0.15, "{order}: {found}, {coarse:e} {fine:e}");
        assert!(fine < 1e-4 && fine > 1e-11);
    }
    // By num-dual the same steps.
    let oracle = num_dual::Storm { k: 0.4 };
    let other = end_of_trajectory(&oracle.driven(WIND, START), Gauss::<3>, 24, start, 1.5);
    let one = end_of_trajectory(&view, Gauss::<3>, 24, start, 1.5);
    assert!((one - other).amax() < 1e-14, "{one}{other}");
    // Positive control: with its time held, the system moves elsewhere.
    let (mut held, h) = (start, 1.5 / 24.0);
    for _ in 0..24 {
        held = view.by(Gauss::<3>, h).step(&held).unwrap().state;
    }
    assert!((held.q - one).amax() > 1e-3);
}

/// Stages in lanes, each at its own time, are those that num-dual gives one by one; in both precisions, with
/// inputs.
#[test]
fn stages_see_their_own_time_in_both_engines() {
    let elapsed = Lanes([0.0, 0.05, 0.2]);
    let (q, v) = (
        [Lanes([0.3, -0.4, 0.1]), Lanes([-0.8, 0.2, 0.6])],
        [Lanes([0.5, 0.9, -0.7]), Lanes([1.1, -0.3, 0.4])],
    );
    let momenta = |rate: &[Lanes<f64, 3>; 2]| [rate[0] * 0.1 + 0.3, rate[1] * 0.2 - 0.4];
    for valve in [0.8, -0.8] {
        let u = [0.5, -1.2, valve];
        let (a, b) = (expanded::Storm { k: 0.4 }, num_dual::Storm { k: 0.4 });
        let of = |t: f64| a.driven(u, t).stages_in_time(&mut Blank::blank(), &elapsed, &q, &v, momenta);
        let (a, b) =
            (of(0.6), b.driven(u, 0.6).stages_in_time(&mut Blank::blank(), &elapsed, &q, &v, momenta));
        for (a, b) in [(a.rate, b.rate), (a.residual, b.residual), (a.correction, b.correction)] {
            for (a, b) in a.iter().flat_map(|a| a.0).zip(b.iter().flat_map(|b| b.0)) {
                assert!((a - b).abs() < 4e-15 * (1.0 + b.abs()), "{a} {b}");
            }
        }
        assert!((of(0.6 + 1e-9).rate[0].0[1] - a.rate[0].0[1]).abs() > 1e-12, "positive control");
    }
    let state = State { q: vector![0.4_f32], p: vector![-0.3] };
    let (a, b) = (expanded::Pushed { m: 1.5 }, num_dual::Pushed { m: 1.5 });
    let a = a.driven([0.3, 0.2]).by(Gauss::<3>, 0.1).step(&state).unwrap().state;
    let b = b.driven([0.3, 0.2]).by(Gauss::<3>, 0.1).step(&state).unwrap().state;
    assert!((a.q - b.q).amax() < 1e-6 && (a.p - b.p).amax() < 1e-6);
    let (a, b) = (expanded::Shaken { omega: 3.0 }, num_dual::Shaken { omega: 3.0 });
    let a = a.at_time(0.6).by(Gauss::<3>, 0.1).step(&state).unwrap().state;
    let b = b.at_time(0.6).by(Gauss::<3>, 0.1).step(&state).unwrap().state;
    assert!((a.q - b.q).amax() < 1e-6 && (a.p - b.p).amax() < 1e-6);
}

/// Order 6 by a composition, each substep of which has its own time; one that forgot it would have order 0.
#[test]
fn a_composition_carries_the_time_on() {
    let (view, start, exact) = storm();
    let error = |steps: u32| {
        let h = 1.5 / f64::from(steps);
        let run = view.by(Composition::kahan_li_6(Midpoint), h).run(start);
        (run.take(steps as usize).last().unwrap().unwrap().state.q - exact).amax()
    };
    let (coarse, fine) = (error(6), error(12));
    let order = (coarse / fine).log2();
    assert!((order - 6.0).abs() < 0.5 && fine < 1e-6, "{order}: {coarse} {fine}");
}

/// A step of a run, whole or in parts, sees its own time.
#[test]
fn steps_in_parts_see_their_time() {
    let worn = expanded::Worn { r: 0.8 };
    let view = worn.at_time(0.4);
    let start = State::from_velocity(&view, [0.3], [0.9]).unwrap();
    let run = || view.by(Midpoint, 0.1).run(start);
    let (mut whole, mut parted) = (run(), run());
    for _ in 0..20 {
        assert_eq!(whole.next().unwrap().unwrap(), parted.next_in_parts(0).unwrap().step);
    }
}

/// The ledger takes each step's friction in its middle: what it leaves unexplained falls as h². Taken at the
/// start of the step, friction that grows with time would leave what falls as h.
#[test]
fn the_ledger_sees_the_time_within_a_step() {
    let worn = expanded::Worn { r: 0.8 };
    let remainder = |steps: u32| {
        let h = 2.0 / f64::from(steps);
        let start = State::from_velocity(&worn.at_time(0.4), [0.3], [0.9]).unwrap();
        let (mut ledger, mut state) = (EnergyLedger::default(), start);
        for k in 0..steps {
            let view = worn.at_time(0.4 + h * f64::from(k));
            let by = view.by(Midpoint, h);
            let next = by.step(&state).unwrap().state;
            ledger += by.ledger(&state, &next).unwrap();
            state = next;
        }
        ledger.remainder()
    };
    let order = (remainder(40) / remainder(80)).log2();
    assert!((order - 2.0).abs() < 0.1, "{order}");
}

/// L and R of a cart that is not driven are its own; they are the view's too.
#[test]
fn what_needs_no_input_stands_on_the_system() {
    let cart = expanded::CartPole { m: [1.0, 0.3], l: 0.5, g: 9.81, c: [0.1, 0.02] };
    let (q, v) = (vector![0.1, 0.4], vector![-0.3, 0.8]);
    let state = State::from_velocity(&cart, q, v).unwrap();
    assert_eq!(state, State::from_velocity(&cart.driven([3.0]), q, v).unwrap());
    assert_eq!(state.energy(&cart).unwrap(), state.energy(&cart.driven([3.0])).unwrap());
    assert_eq!(Rayleigh::rayleigh(&cart, &q, &v), Rayleigh::rayleigh(&cart.driven([3.0]), &q, &v));
    assert_eq!(cart.force([0.0; 2], [0.0; 2], [3.0]), [3.0, 0.0]);
    // The discrete Rayleigh function of a driven system is that of its R.
    let driven = cart.driven([3.0]);
    let r_d = driven.by(Midpoint, 0.1).discrete_rayleigh(&q, &(q + v * 0.1));
    assert!((r_d - 0.005 * cart.rayleigh([-0.3, 0.8])).abs() < 1e-16);
}

/// R with a time on a system whose L has none: r(t) = r (1 + t) at the midpoint.
#[test]
fn friction_may_change_with_time() {
    let (t, h, r) = (0.7, 0.2, 0.3);
    for view in [
        expanded::Worn { r }.at_time(t).momenta_of_midpoint(h),
        num_dual::Worn { r }.at_time(t).momenta_of_midpoint(h),
    ] {
        let (v, q) = (0.5, 0.1 + 0.5 * 0.1);
        let (drag, pull) = (h / 2.0 * r * (1.0 + t + h / 2.0) * v, h / 2.0 * f64::sin(q));
        assert!((view[0] - (v + drag + pull)).abs() < 2e-16 && (view[1] - (v - drag - pull)).abs() < 2e-16);
    }
}

/// Momenta of the midpoint rule on the segment from q = 0.1 with velocity 0.5.
trait MomentaOfMidpoint {
    fn momenta_of_midpoint(&self, h: f64) -> [f64; 2];
}

impl<L: Fused<Midpoint, 1, Scalar = f64>> MomentaOfMidpoint for L {
    fn momenta_of_midpoint(&self, h: f64) -> [f64; 2] {
        let momenta = self.momenta(&Segment { q0: vector![0.1], v: vector![0.5], h });
        [momenta.p0[0], momenta.p1[0]]
    }
}

/// Linear in v̄ and, but for the time, explicit by the trapezoidal rule: what a run keeps must not keep an
/// old force.
struct Rocking;

#[dalembert::rayleigh_system(rule = [midpoint, trapezoidal])]
impl Rocking {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - 2.0 * q[0] * q[0] - q[0] * q[1] - q[1] * q[1]
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.1 * v[0] * v[0]
    }

    fn force(&self, _q: [f64; 2], _v: [f64; 2], u: [f64; 1], t: f64) -> [f64; 2] {
        [u[0] + (3.0 * t).sin(), t]
    }
}

#[test]
fn a_run_of_a_linear_system_keeps_no_old_force() {
    fn check<R: Copy>(rule: R)
    where
        for<'a> DrivenRocking<'a>: Discrete<R, 2, Scalar = f64>,
    {
        let h = 0.1;
        let mut state = State { q: vector![0.3, -0.2], p: vector![0.1, 0.4] };
        let view = Rocking.driven([0.5], 0.2);
        let mut trajectory = view.by(rule, h).run(state);
        for k in 0..30 {
            let end = trajectory.next().unwrap().unwrap().state;
            state = Rocking.driven([0.5], 0.2 + h * f64::from(k)).by(rule, h).step(&state).unwrap().state;
            assert!((end.q - state.q).amax() < 1e-13 && (end.p - state.p).amax() < 1e-13, "step {k}");
        }
        // Positive control: the force of the first step, kept, leads elsewhere.
        let mut held = State { q: vector![0.3, -0.2], p: vector![0.1, 0.4] };
        for _ in 0..30 {
            held = view.by(rule, h).step(&held).unwrap().state;
        }
        assert!((held.q - state.q).amax() > 0.1);
    }
    check(Midpoint);
    check(Trapezoidal);
}
