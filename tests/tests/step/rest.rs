//! Damped motion to its end: forces that cancel at q = 0 round by their own size, of which last places of q,
//! v and p show nothing there.

use dalembert::nalgebra::{Vector2, Vector3, matrix, vector};
use dalembert::step::{Flow, Fused, Segment};
use dalembert::system::ActingForce;
use dalembert::{Discretise, Fitted, Midpoint, OneSided, State, StepError, rayleigh_system};
use dalembert_tests::draws::Draws;

/// A mass between two springs.
#[rayleigh_system]
fn springs(q: [f64; 1], v: [f64; 1]) -> (f64, f64) {
    (0.5 * v[0] * v[0] - 0.5 * (q[0] - 1.0).powi(2) - 0.5 * (q[0] + 1.0).powi(2), 0.25 * v[0] * v[0])
}

/// A mass between two points that attract it.
#[rayleigh_system(rule = [midpoint, one_sided, fitted])]
fn wells(q: [f64; 1], v: [f64; 1], a: f64) -> (f64, f64) {
    let (left, right) = (q[0] + a, q[0] - a);
    (
        0.5 * v[0] * v[0] + 1.0 / (left * left + 1.0).sqrt() + 1.0 / (right * right + 1.0).sqrt(),
        0.1 * v[0] * v[0],
    )
}

/// [`springs`] as one would write them who has done the sum: nothing cancels.
#[rayleigh_system]
fn spring(q: [f64; 1], v: [f64; 1]) -> (f64, f64) {
    (0.5 * v[0] * v[0] - q[0] * q[0], 0.25 * v[0] * v[0])
}

/// A pair of springs far from one another, whose equilibrium is the origin, and two masses in them.
#[rayleigh_system]
fn pair(q: [f64; 2], v: [f64; 2], a: f64) -> (f64, f64) {
    let between = q[1] - q[0];
    (
        0.5 * (v[0] * v[0] + v[1] * v[1])
            - 0.5 * (q[0] - a).powi(2)
            - 0.5 * (q[0] + a).powi(2)
            - 0.5 * (between - 3.0 * a).powi(2)
            - 0.5 * (between + 3.0 * a).powi(2),
        0.2 * (v[0] * v[0] + v[1] * v[1]),
    )
}

/// Masses that two laws hold in two ways each, by dual numbers: what rounds is carried with the derivatives.
macro_rules! held {
    ($name:ident $engine:ident) => {
        mod $name {
            use dalembert::rayleigh_system;
            #[derive(Debug)]
            pub struct Held {
                pub a: [f64; 3],
                pub k: [f64; 3],
                pub r: f64,
            }
            #[rayleigh_system(rule = midpoint, derivatives = $engine)]
            impl Held {
                fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
                    let mut l = 0.0;
                    for i in 0..3 {
                        l += 0.5 * v[i] * v[i] * (1.0 + 0.3 * (q[i] / 400.0).sin().powi(2))
                            - 0.5 * self.k[i] * (q[i] - self.a[i]).powi(2)
                            - 0.5 * self.k[i] * (q[i] + self.a[i]) * (self.a[i] + q[i])
                            - 1e4 * ((q[i] + 300.0) / 400.0).cosh().ln()
                            + 1e4 * ((q[i] - self.a[i] * 1e-3) / 400.0).cos();
                    }
                    l - 0.1 * (q[1] - q[0] - 700.0).powi(2) + 1e5 / ((q[2] - q[1]).powi(2) + 4e4).sqrt()
                }
                fn rayleigh(&self, v: [f64; 3]) -> f64 {
                    0.5 * self.r * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
                        + 1e-3 * v[0].abs().powi(3)
                        + 0.2 * (v[1] - v[0]).powi(2)
                }
            }
        }
    };
}
held!(written_out expanded);
held!(by_num_dual num_dual);

/// Fifty starts between rest and rest: each step is that of the rule in closed form, to rounding of the
/// forces.
#[test]
fn a_mass_between_two_springs_comes_to_rest() {
    const H: f64 = 0.1;
    // v̄ = (p0 − (h/2) k q0)/(1 + (h/2) c + (h²/4) k), q1 = q0 + h v̄, p1 = 2 m v̄ − p0 − h c v̄ − …: by k =
    // 2, c = ½.
    let inverse = 1.0 / (1.0 + 0.25 * H + 0.5 * H * H);
    let v = vector![-H * inverse, inverse].transpose();
    let q = vector![1.0, 0.0].transpose() + v * H;
    let p = v * (1.0 - 0.25 * H) - (vector![1.0, 0.0].transpose() + q) * (0.5 * H);
    let step = matrix![q[0], q[1]; p[0], p[1]];
    for start in 30..80 {
        let mut expected: Vector2<f64> = vector![f64::from(start) / 100.0, 0.0];
        let state = State { q: vector![expected[0]], p: vector![0.0] };
        let mut run = Springs {}.by(Midpoint, H).run(state);
        for index in 0..1500 {
            let taken = run.next().unwrap().unwrap_or_else(|error| panic!("{start}, step {index}: {error}"));
            expected = step * expected;
            let off = vector![taken.state.q[0], taken.state.p[0]] - expected;
            assert!(off.amax() < 1e-14, "{start}, step {index}: {off:e}");
        }
        assert!(run.state().q[0].abs() < 1e-14);
    }
}

/// Where the forces are not linear, the rest of a run is known: the origin.
#[test]
fn a_mass_between_two_attracting_points_comes_to_rest() {
    for a in [0.3, 0.6] {
        for start in 0..6 {
            let wells = Wells { a };
            let state = State { q: vector![0.01 + f64::from(start) / 9.0], p: vector![0.0] };
            let mut run = wells.by(Midpoint, 0.1).run(state);
            for index in 0..4000 {
                if let Some(Err(error)) = run.next() {
                    panic!("{a}, {start}, step {index}: {error}");
                }
            }
            assert!(run.state().q[0].abs() < 1e-13, "{:e}", run.state().q[0]);
        }
    }
}

/// Springs some 10⁶ as long as the motion: rounding of the forces is far above that of p and v.
#[test]
fn masses_come_to_rest_by_dual_numbers_too() {
    let mut draws = Draws::new(41);
    let (all, steps) = if cfg!(debug_assertions) { (2, 600) } else { (60, 3000) };
    for _ in 0..all {
        let a = [0; 3].map(|_| 10_f64.powf(draws.between(5.0, 6.5)));
        let k = [0; 3].map(|_| draws.between(0.1, 1.0));
        let (r, h) = (draws.between(0.3, 0.8), draws.between(0.1, 0.3));
        let held = by_num_dual::Held { a, k, r };
        let start = State { q: [0; 3].map(|_| draws.between(-300.0, 300.0)).into(), p: Vector3::zeros() };
        let same = written_out::Held { a, k, r };
        let (mut run, mut other) = (held.by(Midpoint, h).run(start), same.by(Midpoint, h).run(start));
        let mut apart = 0.0_f64;
        for index in 0..steps {
            let ends = run.next().and_then(Result::ok).zip(other.next().and_then(Result::ok));
            let Some((end, other)) = ends else { panic!("{held:?} {h}, step {index}") };
            apart = apart.max((end.state.q - other.state.q).amax());
        }
        // No more than what the forces round by, which friction forgets.
        let rounding = f64::EPSILON * a.iter().copied().fold(0.0, f64::max);
        assert!(apart < 100.0 * rounding && apart > 0.0, "{apart:e} {rounding:e}");
        // Of each spring at least, and as many as those that are written out but for a few.
        let (q, v) = (run.state().q, Vector3::repeat(1e-9));
        let carried = ActingForce::cancelling_terms(&held, &q, &v);
        let written = ActingForce::cancelling_terms(&same, &q, &v);
        for i in 0..3 {
            let share = carried.rate[i] / written.rate[i];
            assert!(carried.rate[i] >= 2.0 * k[i] * a[i] && (0.5..3.0).contains(&share), "{share}");
        }
    }
}

/// By the rules that take L and R together: points between which the forces cancel exactly, nearly, and that
/// are far apart.
/// A bob over three magnets: away from the axis it rests where the forces of two of them cancel.
#[rayleigh_system(rule = midpoint)]
fn magnets(q: [f64; 2], v: [f64; 2], r: f64) -> (f64, f64) {
    let to = |x: f64, y: f64| ((q[0] - x) * (q[0] - x) + (q[1] - y) * (q[1] - y) + 0.04).sqrt();
    let (a, b, c) = (to(1.0, 0.0), to(-0.5, 0.866), to(-0.5, -0.866));
    let (speed, radius) = (v[0] * v[0] + v[1] * v[1], q[0] * q[0] + q[1] * q[1]);
    (0.5 * speed - 0.1 * radius + 1.0 / a + 1.0 / b + 1.0 / c, 0.5 * r * speed)
}

#[test]
fn a_step_at_rest_takes_as_many_iterations_as_one_in_motion() {
    for q in [[0.9, 0.7], [0.3, -0.2], [-1.2, 0.5], [0.4, 0.0], [-0.2, -1.1]] {
        let bob = Magnets { r: 0.2 };
        let mut run = bob.by(Midpoint, 0.05).run(State::from_velocity(&bob, q, [0.0; 2]).unwrap());
        let mut iterations_of = |steps: usize| {
            run.by_ref().take(steps).map(|step| step.unwrap().report.iterations).sum::<u32>() as f64
                / steps as f64
        };
        let (in_motion, _, at_rest) = (iterations_of(400), iterations_of(20_000), iterations_of(1_000));
        assert!(at_rest <= in_motion && in_motion < 3.5, "{q:?}: {in_motion} {at_rest}");
    }
}

#[test]
fn a_mass_comes_to_rest_by_rules_that_take_the_damping_in_their_own_way() {
    fn refused<M: Copy>(wells: &Wells, method: M, h: f64, q: f64) -> Option<String>
    where
        Wells: Flow<M, 1, Scalar = f64>,
    {
        let mut run = wells.by(method, h).run(State { q: vector![q], p: vector![0.0] });
        (0..2000).find_map(|index| run.next()?.err().map(|error| format!("step {index}: {error}")))
    }
    let mut draws = Draws::new(40);
    for _ in 0..if cfg!(debug_assertions) { 10 } else { 400 } {
        let wells = Wells { a: draws.between(0.1, 0.7) };
        let (h, q) = (draws.between(0.05, 0.5), draws.between(-1.0, 1.0));
        for refused in [refused(&wells, OneSided, h, q), refused(&wells, Fitted, h, q)] {
            assert_eq!(refused, None, "{wells:?} {h} {q}");
        }
    }
}

fn cancelling_terms<L, const N: usize>(system: &L, q: [f64; N], v: [f64; N]) -> [f64; N]
where
    L: Fused<Midpoint, N, Scalar = f64>,
{
    Fused::<Midpoint, N>::cancelling_terms(system, &Segment { q0: q.into(), v: v.into(), h: 0.1 }).into()
}

#[test]
fn the_terms_are_those_that_cancel_and_there_are_none_where_none_do() {
    // h/2 times the length of a spring at least, and of both at most with all sums that they are in.
    let [size] = cancelling_terms(&Springs {}, [1e-9], [1e-9]);
    assert!((0.05..=0.2).contains(&size), "{size}");
    assert_eq!(cancelling_terms(&Spring {}, [1e-9], [1e-9]), [0.0]);
    // As much as the springs are long, times h/2.
    for size in cancelling_terms(&Pair { a: 1e6 }, [0.0, 0.0], [0.0, 0.0]) {
        assert!((0.05e6..2e6).contains(&size), "{size}");
    }
}

/// The rounding of lengths that are 10⁶ times the motion explains no residual that is larger: the solver does
/// not take what a short guess leaves.
#[test]
fn what_terms_do_not_explain_is_solved_for() {
    let pair = Pair { a: 1e6 };
    let state = State { q: vector![1e-3, -2e-3], p: vector![0.0, 0.0] };
    let step = pair.by(Midpoint, 0.1).near(&vector![1.0, -1.0]).step(&state).unwrap();
    // 6 and 4 in place of (q ± a) + …: the same springs without their lengths, solved on paper.
    let stiffness = matrix![4.0, -2.0; -2.0, 2.0];
    let mass = matrix![1.0 + 0.5 * 0.1 * 0.4, 0.0; 0.0, 1.0 + 0.5 * 0.1 * 0.4] + stiffness * (0.25 * 0.01);
    let expected = mass.lu().solve(&(stiffness * state.q * -0.05)).unwrap();
    assert!((step.velocity - expected).amax() < 4.0 * f64::EPSILON * 1e6 * 0.1 * 6.0);
    assert!((step.velocity - expected).amax() < 1e-3 * expected.amax());
}

/// The control: p0 = v − v² + … is at most ¼ and some, however large the terms are that cancel in it. No
/// velocity has the momentum 1 then.
#[test]
fn a_step_without_a_root_is_refused_as_before() {
    #[rayleigh_system]
    fn bounded(q: [f64; 1], v: [f64; 1], a: f64) -> f64 {
        0.5 * v[0] * v[0] - v[0].powi(3) / 3.0 - 0.5 * (q[0] - a).powi(2) - 0.5 * (q[0] + a).powi(2)
    }
    for a in [1.0, 1e6] {
        let state = State { q: vector![0.0], p: vector![1.0] };
        let error = Bounded { a }.by(Midpoint, 0.1).step(&state).unwrap_err();
        assert!(matches!(error, StepError::NoVelocity { .. }), "{error}");
    }
}
