//! No checker says yes on samples that cannot tell yes from no, nor of a view asked at one time alone; and
//! each says yes of what holds.

use dalembert::derivative::PhaseMatrix;
use dalembert::nalgebra::{Matrix1, SVector, vector};
use dalembert::noether::Generator;
use dalembert::rayleigh::{ConformalStep, structure};
use dalembert::samples::{Finding, Pair, Tolerance, Verdict, segments};
use dalembert::step::Flow;
use dalembert::{Discretise, Lagrangian, Midpoint, State, Trapezoidal, rayleigh_system};

const H: f64 = 0.1;

/// Nothing that is asked of it holds by the midpoint rule: det A depends on the state.
#[rayleigh_system(rule = [midpoint, trapezoidal])]
fn pendulum(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
}

/// All that is asked of it holds.
#[rayleigh_system(rule = [midpoint, trapezoidal])]
fn oscillator(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] - 0.5 * q[0] * q[0], 0.5 * r * v[0] * v[0])
}

/// Springs, friction and a push that may take the time.
struct Aging {
    spring: f64,
    friction: f64,
    push: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl Aging {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2], t: f64) -> f64 {
        let k = 1.0 + self.spring * t.sin();
        0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.5 * k * (q[0] * q[0] + 0.6 * q[0] * q[1] + q[1] * q[1])
    }
    fn rayleigh(&self, v: [f64; 2], t: f64) -> f64 {
        0.1 * (1.0 + self.friction * t * t) * (v[0] * v[0] + v[1] * v[1])
    }
    fn force(&self, _q: [f64; 2], _v: [f64; 2], t: f64) -> [f64; 2] {
        [self.push * t, 0.0]
    }
}

/// How many of the statements that a step is conformally symplectic, and lies on the motion of a linear
/// system, get a yes.
fn yes<L, M, const N: usize>(system: &L, method: M, states: &[State<f64, N>]) -> [bool; 3]
where
    L: Flow<M, N> + Lagrangian<N, Scalar = f64>,
    M: Copy,
{
    let by = system.by(method, H);
    [
        by.conformal_step(states).is_ok_and(|found| found.is_conformal()),
        by.conformal_hamilton_jacobi(states).is_ok(),
        by.modified_linear_system(states).is_ok_and(|found| found.is_rayleigh()),
    ]
}

fn state(q: f64, p: f64) -> State<f64, 1> {
    State { q: vector![q], p: vector![p] }
}

/// Pairs of states that leave a pendulum's nonlinearity unseen, or nearly.
fn poor_pairs() -> Vec<[State<f64, 1>; 2]> {
    let mut pairs = vec![
        [state(0.5, 0.1); 2],
        [state(0.0, 0.0); 2],
        // Mirror images, and a turn apart: A is the same at both.
        [state(0.5, 0.1), state(-0.5, -0.1)],
        [state(0.5, 0.1), state(0.5 + std::f64::consts::TAU, 0.1)],
    ];
    for (q, p) in [(0.5, 0.1), (0.5, 0.0), (0.0, 0.1), (0.0, 0.0), (1e-9, 0.0)] {
        for (dq, dp) in [(1e-12, 0.0), (0.0, 1e-12), (1e-12, -1e-12), (3e-9, 2e-9)] {
            pairs.push([state(q, p), state(q + dq, p + dp)]);
        }
    }
    pairs
}

#[test]
fn a_damped_pendulum_gets_no_yes() {
    let pendulum = Pendulum { r: 0.3 };
    for pair in poor_pairs() {
        assert_eq!(yes(&pendulum, Midpoint, &pair), [false; 3], "{pair:?}");
        // No step of it lies on a linear system's motion; by the trapezoidal rule it is conformal.
        assert!(!yes(&pendulum, Trapezoidal, &pair)[2], "{pair:?}");
    }
    let good = [state(0.5, 0.1), state(-0.2, 0.4)];
    assert_eq!(yes(&pendulum, Midpoint, &good), [false; 3]);
    assert_eq!(yes(&pendulum, Trapezoidal, &good), [true, true, false]);
    // One state twice tells nothing of any system.
    assert_eq!(yes(&Oscillator { r: 0.3 }, Midpoint, &[state(0.5, 0.1); 2]), [false; 3]);
    assert_eq!(yes(&Oscillator { r: 0.3 }, Midpoint, &good), [true; 3]);
    // The unit of q is no one's: what is far apart in its own size tells.
    let small = good.map(|state| State { q: state.q * 1e-11, p: state.p * 1e-11 });
    assert_eq!(yes(&Oscillator { r: 0.3 }, Midpoint, &small), [true; 3]);
}

#[test]
fn views_are_asked_at_several_times() {
    let states = [[0.3, -0.2, 0.1, 0.4], [-0.5, 0.1, 0.2, -0.6], [0.2, 0.6, -0.3, 0.1]]
        .map(|[a, b, c, d]| State { q: vector![a, b], p: vector![c, d] });
    let of = |spring, friction, push| Aging { spring, friction, push };
    for count in [1, 2, 3] {
        let states = &states[..count];
        let linear = count > 1;
        for (aging, conformal, is_linear) in [
            (of(0.0, 0.0, 0.0), true, true),
            (of(0.3, 0.0, 0.0), true, false),
            (of(0.0, 0.3, 0.0), false, false),
            (of(0.0, 0.0, 0.5), true, false),
        ] {
            for t0 in [0.0, 0.7] {
                let found = yes(&aging.at_time(t0), Trapezoidal, states);
                let expected = [conformal, conformal, is_linear && linear];
                assert_eq!(found, expected, "{count} states at {t0}");
            }
        }
    }
    let segments = segments([-1.0; 2], [1.0; 2], [0.1; 2], 5);
    for count in [1, 2, 5] {
        for (friction, constant) in [(0.0, true), (0.3, false)] {
            let aging = of(0.2, friction, 0.0);
            let found = aging.at_time(0.0).by(Trapezoidal, H).proportion(&segments[..count]);
            assert_eq!(found.is_ok_and(|found| found.is_constant()), constant, "{count}: {found:?}");
        }
    }
}

#[test]
fn one_sided_proportions_get_no_yes() {
    let (pendulum, oscillator) = (Pendulum { r: 0.3 }, Oscillator { r: 0.3 });
    let constant = |system: &Pendulum, segments: &[Pair<f64, 1>]| {
        system.by(Midpoint, H).proportion(segments).is_ok_and(|found| found.is_constant())
    };
    let segment = |q: f64, d: f64| Pair::new([q], [q + d]);
    for poor in [
        [segment(0.5, 0.02); 2],
        [segment(0.5, 0.02), segment(0.5 + 1e-12, 0.02)],
        [segment(0.5, 0.02), segment(0.5, 0.02 + 1e-13)],
        [segment(0.5, 0.02), segment(-0.5, -0.02)],
    ] {
        assert!(!constant(&pendulum, &poor), "{poor:?}");
    }
    let good = [segment(0.5, 0.02), segment(-0.2, 0.05)];
    assert!(!constant(&pendulum, &good));
    assert!(oscillator.by(Midpoint, H).proportion(&good).is_ok_and(|found| found.is_constant()));
}

/// θ is cyclic; its friction is no multiple of its inertia, unless `even`.
#[rayleigh_system]
fn turning(q: [f64; 2], v: [f64; 2], friction: f64, even: f64) -> (f64, f64) {
    let inertia = 1.0 + q[0] * q[0];
    let twice_kinetic = v[0] * v[0] + inertia * v[1] * v[1];
    let drag = (1.0 - even) + even * inertia;
    (0.5 * twice_kinetic - 0.5 * q[0] * q[0], 0.5 * friction * drag * v[1] * v[1])
}

/// Friction that grows with time, a multiple of the inertia at each.
struct Slowing {
    growth: f64,
}

#[rayleigh_system]
impl Slowing {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + (1.0 + q[0] * q[0]) * v[1] * v[1]) - 0.5 * q[0] * q[0]
    }
    fn rayleigh(&self, q: [f64; 2], v: [f64; 2], t: f64) -> f64 {
        0.1 * (1.0 + self.growth * t) * (v[0] * v[0] + (1.0 + q[0] * q[0]) * v[1] * v[1])
    }
}

#[test]
fn reductions_are_seen_at_several_shapes_and_times() {
    let segment = |x: f64, d: f64| Pair::new([x, 0.2], [x + d, 0.3]);
    let good = [segment(0.5, 0.02), segment(0.9, 0.05), segment(-0.7, 0.01)];
    for (even, friction, reducible) in [(0.0, 0.4, false), (1.0, 0.4, true), (0.0, 0.0, true)] {
        let by = Turning { friction, even };
        let reduces = |segments: &[Pair<f64, 2>]| by.by(Midpoint, H).routh::<1>(1, segments).is_ok();
        assert_eq!(reduces(&good), reducible);
        for poor in [
            [segment(0.5, 0.02); 2],
            [segment(0.5, 0.02), segment(0.5 + 1e-13, 0.02)],
            [segment(0.5, 0.02), segment(-0.5, -0.02)],
        ] {
            assert!(reducible || !reduces(&poor), "{poor:?}");
        }
    }
    for (growth, reducible) in [(0.0, true), (0.5, false)] {
        let slowing = Slowing { growth };
        assert_eq!(slowing.at_time(0.2).by(Midpoint, H).routh::<1>(1, &good).is_ok(), reducible);
    }
}

/// Inertia that no rotation keeps, and a force with a curl.
struct Uneven;

#[rayleigh_system]
impl Uneven {
    fn lagrangian(&self, _q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + 2.0 * v[1] * v[1])
    }
    fn force(&self, _q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        [-0.1 * v[0], -0.1 * v[1]]
    }
}

#[test]
fn segments_that_hardly_move_tell_no_symmetry() {
    let noether = Uneven.by(Midpoint, H).noether();
    let rotation = Generator::rotation(0, 1);
    let at = SVector::<f64, 2>::new(0.7, -0.4);
    for size in [0.0, 1e-17, 1e-16, 3e-15, 1e-13] {
        let hardly: Vec<_> =
            (0..6).map(|k| Pair::new(at, at + vector![size, -0.3 * size] * f64::from(k))).collect();
        let judged = noether.symmetry(&rotation, &hardly);
        assert!(!judged.is_ok_and(|found| found.is_symmetry_of_lagrangian()), "{size:e}");
        let found = noether.subalgebra(&[rotation.clone(), Generator::translation("x", [1.0, 0.0])], &hardly);
        assert!(!found.is_ok_and(|found| found.premise_holds()), "{size:e}");
        if size < 1e-12 {
            assert!(structure(&Uneven, Midpoint, H, &hardly).is_err(), "{size:e}");
        }
    }
}

/// Springs of size `k`, friction `r` of one coordinate, a gyroscopic force `g`.
struct Slow {
    k: f64,
    r: f64,
    g: f64,
}

#[rayleigh_system]
impl Slow {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + 0.4 * v[0] * v[1] + v[1] * v[1])
            - 0.5 * self.k * (q[0] * q[0] + 2.0 * q[1] * q[1])
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.r * v[0] * v[0]
    }
    fn force(&self, _q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        [self.g * v[1], -self.g * v[0]]
    }
}

#[test]
fn steps_too_short_for_their_digits_tell_nothing() {
    let states = [[0.3, -0.2, 0.1, 0.4], [-0.5, 0.1, 0.2, -0.6]]
        .map(|[a, b, c, d]| State { q: vector![a, b], p: vector![c, d] });
    for (k, r, g) in [
        (1.0, 0.3, 0.0),
        (1.0, 0.0, 0.0),
        (0.0, 0.3, 0.0),
        (0.0, 0.0, 0.0),
        (1e-3, 0.0, 0.0),
        (1.0, 1e-3, 1e-3),
        (0.0, 1e-3, 1e-3),
    ] {
        for h in [0.1, 1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13] {
            let found = Slow { k, r, g }.by(Midpoint, h).modified_linear_system(&states);
            let verdict = found.map_or(Verdict::CannotTell, |found| found.verdict());
            let truth = if g == 0.0 { Verdict::Yes } else { Verdict::No };
            let is_told = h > 1e-4;
            assert!(verdict == truth || !is_told && verdict == Verdict::CannotTell, "{k} {r} {g} {h:e}");
        }
    }
}

#[test]
fn a_tolerance_as_large_as_what_it_is_for_cannot_tell() {
    // Strong friction that depends on q: c = e^{−hr(q)} differs from state to state, below all rounding.
    let forgetful = |c: f64| PhaseMatrix {
        q_by_q: Matrix1::new(1.0),
        q_by_p: Matrix1::new(0.3),
        p_by_q: Matrix1::new(-0.3),
        p_by_p: Matrix1::new(c - 0.09),
    };
    let of = |a: f64, b: f64| ConformalStep::of(&[forgetful(a), forgetful(b)], None).unwrap();
    for (a, b, verdict) in [
        (0.5, 0.5, Verdict::Yes),
        (0.5, 0.4, Verdict::No),
        (1e-10, 1e-10, Verdict::Yes),
        (1e-14, 1e-14, Verdict::CannotTell),
        (1e-14, 4e-14, Verdict::CannotTell),
    ] {
        assert_eq!(of(a, b).verdict(), verdict, "{a:e} {b:e}: {}", of(a, b));
        assert_eq!(of(a, b).is_conformal(), verdict == Verdict::Yes);
    }
    assert!(of(1e-14, 4e-14).to_string().contains("cannot be told"));
    // A tolerance of half the terms is none.
    let finding = |value, relative| Finding::relative(value, Tolerance { relative, scale: 1.0 }, 0).verdict();
    assert_eq!(finding(0.4, 0.5), Verdict::CannotTell);
    assert_eq!(finding(0.6, 0.5), Verdict::No);
    assert_eq!([finding(1e-13, 1e-12), finding(1e-11, 1e-12)], [Verdict::Yes, Verdict::No]);
}
