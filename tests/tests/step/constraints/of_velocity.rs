//! Constraints of velocity, beside an independent program, exact motions and constraints of both kinds.

use dalembert::nalgebra::{SVector, Vector3};
use dalembert::step::Flow;
use dalembert::{
    Composition, Discretise, Lagrangian, Midpoint, State, StepError, Trapezoidal, rayleigh_system,
};

/// A skate on a slope of acceleration `a`, its direction q₂.
struct KnifeEdge {
    a: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl KnifeEdge {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) + self.a * q[0]
    }

    fn velocity_constraints(&self, q: [f64; 3], v: [f64; 3]) -> [f64; 1] {
        [q[2].sin() * v[0] - q[2].cos() * v[1]]
    }
}

const SKATE: KnifeEdge = KnifeEdge { a: 1.7 };
const TURN: f64 = 0.9;

/// q at time t from rest at the origin, turning.
fn exact_skate(t: f64) -> Vector3<f64> {
    let (scale, angle) = (SKATE.a / (2.0 * TURN * TURN), TURN * t);
    Vector3::new(scale * angle.sin().powi(2), scale * (angle - 0.5 * (2.0 * angle).sin()), angle)
}

fn end<L, M>(system: &L, method: M, start: State<f64, 3>, steps: usize, time: f64) -> State<f64, 3>
where
    M: Copy,
    L: Flow<M, 3> + Lagrangian<3, Scalar = f64>,
{
    system.by(method, time / steps as f64).run(start).nth(steps - 1).unwrap().unwrap().state
}

#[test]
fn a_skate_goes_as_the_reference_and_with_the_order_of_its_rule() -> Result<(), StepError> {
    let start = State::from_velocity(&SKATE, [0.0; 3], [0.0, 0.0, TURN])?;
    let last = end(&SKATE, Midpoint, start, 40, 2.0);
    assert!((last.q - Vector3::new(0.995884790070672, 2.12186998136126, 1.8)).amax() < 1e-13);
    assert!((last.p - Vector3::new(-0.417865445146874, 1.79108064268445, 0.9)).amax() < 1e-13);

    let error = |state: State<f64, 3>| (state.q - exact_skate(5.0)).amax();
    let slope = |coarse: f64, fine: f64| (coarse / fine).log2();
    let midpoint = [50, 100].map(|steps| error(end(&SKATE, Midpoint, start, steps, 5.0)));
    let trapezoidal = [50, 100].map(|steps| error(end(&SKATE, Trapezoidal, start, steps, 5.0)));
    for [coarse, fine] in [midpoint, trapezoidal] {
        assert!((1.97..2.03).contains(&slope(coarse, fine)), "{coarse:e} {fine:e}");
    }
    let [coarse, fine] =
        [20, 40].map(|steps| error(end(&SKATE, Composition::kahan_li_6(Midpoint), start, steps, 5.0)));
    assert!((5.7..6.4).contains(&slope(coarse, fine)), "{coarse:e} {fine:e}");
    Ok(())
}

#[test]
fn a_skate_keeps_its_edge_and_its_energy_does_not_drift() -> Result<(), StepError> {
    let start = State::from_velocity(&SKATE, [0.0; 3], [0.0, 0.0, TURN])?;
    let steps = if cfg!(debug_assertions) { 4_000 } else { 100_000 };
    let mut errors = [0.0_f64; 2];
    for (index, step) in SKATE.by(Midpoint, 0.05).run(start).take(steps).enumerate() {
        let state = step?.state;
        let across = SKATE.velocity_constraints(state.q.into(), state.velocity(&SKATE)?.into())[0];
        assert!(across.abs() < 1e-15 * (4.0 + state.p.amax()));
        let half = usize::from(2 * index >= steps);
        errors[half] = errors[half].max(f64::abs(state.energy(&SKATE)? - start.energy(&SKATE)?));
    }
    assert!((errors[1] / errors[0] - 1.0).abs() < 0.02 && errors[0] < 2e-3, "{errors:?}");
    // The step is its own adjoint.
    let there = SKATE.by(Midpoint, 0.05).step(&start)?.state;
    let back = SKATE.by(Midpoint, -0.05).step(&there)?.state;
    assert!((back.q - start.q).amax() < 1e-15 && (back.p - start.p).amax() < 1e-15);
    Ok(())
}

#[test]
fn a_start_across_the_edge_is_refused_and_the_nearest_keeps_its_place() -> Result<(), StepError> {
    let error = State::from_velocity(&SKATE, [0.3, -2.0, 0.5], [0.0, 1.0, 0.0]).unwrap_err();
    let across = -0.5_f64.cos();
    assert!(
        matches!(error, StepError::LeavesConstraint { constraint: 0, rate } if (rate - across).abs() < 1e-15)
    );
    let nearest = State::nearest(&SKATE, [0.3, -2.0, 0.5], [0.0, 1.0, 0.2])?;
    assert_eq!(nearest.q, Vector3::new(0.3, -2.0, 0.5));
    // Along the edge remains what v has of it.
    let along = 0.5_f64.sin();
    let expected = Vector3::new(along * 0.5_f64.cos(), along * along, 0.2);
    assert!((nearest.p - expected).amax() < 1e-15);
    Ok(())
}

/// A cylinder on a plank that is pulled by w = sin t: position of the cylinder and its angle.
struct OnAPlank;

const RADIUS: f64 = 0.4;
const INERTIA: f64 = 0.3;

#[rayleigh_system]
impl OnAPlank {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let _ = q;
        0.5 * (2.0 * v[0] * v[0] + INERTIA * v[1] * v[1])
    }

    fn velocity_constraints(&self, _q: [f64; 2], v: [f64; 2], t: f64) -> [f64; 1] {
        [v[0] - RADIUS * v[1] - t.sin()]
    }
}

/// v₀ = s sin t from rest, s the share of the plank's velocity that the inertia takes.
#[test]
fn a_cylinder_rolls_on_a_plank_that_is_pulled() -> Result<(), StepError> {
    let share = INERTIA / (INERTIA + 2.0 * RADIUS * RADIUS);
    let view = OnAPlank.at_time(0.0);
    let start = State::from_velocity(&view, [0.0; 2], [0.0; 2])?;
    let error = |steps: usize| {
        let state = view.by(Midpoint, 3.0 / steps as f64).run(start).nth(steps - 1).unwrap().unwrap().state;
        f64::abs(state.q[0] - share * (1.0 - 3.0_f64.cos()))
            .max(f64::abs(state.p[0] - 2.0 * share * 3.0_f64.sin()))
    };
    let (coarse, fine) = (error(30), error(60));
    assert!((1.97..2.03).contains(&(coarse / fine).log2()), "{coarse:e} {fine:e}");
    // At another time the plank moves.
    let moving = State::from_velocity(&OnAPlank.at_time(1.0), [0.0; 2], [0.0; 2]).unwrap_err();
    assert!(matches!(moving, StepError::LeavesConstraint { rate, .. } if rate == -1.0_f64.sin()));
    Ok(())
}

/// A coin that rolls down a slope, upright: its centre, its heading and its angle. It touches the plane, and
/// does not slide along it.
struct Coin;

#[rayleigh_system]
impl Coin {
    fn lagrangian(&self, q: [f64; 5], v: [f64; 5]) -> f64 {
        let _ = q;
        0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + 0.25 * v[3] * v[3] + 0.5 * v[4] * v[4]) + 1.3 * q[0]
            - 9.0 * q[2]
    }

    fn constraints(&self, q: [f64; 5]) -> [f64; 1] {
        [q[2] - 1.0]
    }

    fn velocity_constraints(&self, q: [f64; 5], v: [f64; 5]) -> [f64; 2] {
        [v[0] - q[3].cos() * v[4], v[1] - q[3].sin() * v[4]]
    }
}

/// Rolling adds ½ to the mass: the coin goes as a skate whose slope is 1.3/1.5.
#[test]
fn constraints_of_both_kinds_hold_a_coin() -> Result<(), StepError> {
    let start = State::from_velocity(&Coin, [0.0, 0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, TURN, 0.0])?;
    let skate = KnifeEdge { a: 1.3 / 1.5 };
    let of_skate = State::from_velocity(&skate, [0.0; 3], [0.0, 0.0, TURN])?;
    let by = Composition::kahan_li_8(Midpoint);
    let coins = Coin.by(by, 0.05).run(start);
    for (coin, skate) in coins.zip(skate.by(by, 0.05).run(of_skate)).take(100) {
        let (coin, skate) = (coin?.state, skate?.state);
        let same = [coin.q[0] - skate.q[0], coin.q[1] - skate.q[1], coin.q[3] - skate.q[2]];
        assert!(SVector::from(same).amax() < 1e-10 && coin.q[2] == 1.0, "{coin:?} {skate:?}");
    }
    // The plane bears the weight.
    let by = Coin.by(Midpoint, 0.05);
    let reactions: SVector<f64, 3> = by.reactions(&start, &by.step(&start)?)?;
    assert!((reactions[0] - 9.0).abs() < 1e-13, "{reactions}");
    Ok(())
}
