//! Runs saved as text and read again go on bit by bit, whatever their rule remembers: velocities, stages with compensated sums, a kept
//! matrix, an explicit step's force, one memory for each substep of a composition.

use dalembert::{
    Checkpoint, Composition, Discrete, Gauss, Midpoint, State, Trajectory, Trapezoidal, rayleigh_system,
};
use dalembert_tests::systems::{Chain, DoublePendulum};

/// Explicit by the trapezoidal rule.
#[rayleigh_system(rule = trapezoidal)]
fn ring(q: [f64; 2], v: [f64; 2], k: f64) -> (f64, f64) {
    let s = q[0] * q[0] + q[1] * q[1];
    (0.5 * (v[0] * v[0] + v[1] * v[1]) - s * (s - 1.0).powi(2), 0.5 * k * (v[0] * v[0] + v[1] * v[1]))
}

fn bits<const N: usize>(state: &State<f64, N>) -> Vec<u64> {
    state.q.iter().chain(&state.p).map(|entry| entry.to_bits()).collect()
}

fn start<const N: usize>() -> State<f64, N> {
    let entry = |i: usize| 0.3 + 0.17 * i as f64;
    State {
        q: std::array::from_fn(|i| entry(i) * (-1.0_f64).powi(i as i32)).into(),
        p: std::array::from_fn(entry).into(),
    }
}

fn as_text<const N: usize>(checkpoint: Checkpoint<f64, N>) -> Checkpoint<f64, N> {
    serde_json::from_str(&serde_json::to_string(&checkpoint).unwrap()).unwrap()
}

/// The bits of 300 states: after 100 and 200 steps there is a checkpoint, from which another run goes on if `is_resumed`.
fn by_rule<L, R: Copy, const N: usize>(system: &L, rule: R, h: f64, is_resumed: bool) -> Vec<Vec<u64>>
where
    L: Discrete<R, N, Scalar = f64>,
{
    let mut run = Trajectory::new(system, rule, h, start());
    let mut states = Vec::new();
    for _ in 0..3 {
        states.extend(run.by_ref().take(100).map(|step| bits(&step.unwrap().state)));
        let checkpoint = run.checkpoint();
        if is_resumed {
            run = Trajectory::resume(system, rule, as_text(checkpoint));
        }
    }
    states.push(vec![run.time().to_bits()]);
    states
}

#[test]
fn every_rule_goes_on_bit_by_bit() {
    fn check<L, R: Copy, const N: usize>(system: &L, rule: R, h: f64)
    where
        L: Discrete<R, N, Scalar = f64>,
    {
        assert!(by_rule(system, rule, h, true) == by_rule(system, rule, h, false));
        // The control: the bits are those of this step size.
        assert!(by_rule(system, rule, h, true) != by_rule(system, rule, h.next_up(), false));
    }
    check(&DoublePendulum::EXAMPLE, Midpoint, 0.07);
    check(&DoublePendulum::EXAMPLE, Gauss::<4>, 0.2);
    check(&Chain::EXAMPLE, Midpoint, 0.1);
    check(&Ring { k: 1e-3 }, Trapezoidal, 0.1);
}

/// What a checkpoint makes a run forget is rounding: without it the bits are others, the motion is the same.
#[test]
fn forgetting_changes_no_more_than_rounding() {
    let of = |every: usize| {
        let mut run = Trajectory::new(&DoublePendulum::FREE, Gauss::<4>, 0.1, start());
        for _ in 0..100 / every {
            run.by_ref().take(every).for_each(|step| assert!(step.is_ok()));
            run.checkpoint();
        }
        *run.state()
    };
    let (never, often) = (of(100), of(1));
    assert_ne!(bits(&never), bits(&often));
    assert!((never.q - often.q).amax() < 1e-12, "{}", (never.q - often.q).amax());
}

#[test]
fn compositions_go_on_bit_by_bit() {
    fn states<const S: usize>(method: Composition<Trapezoidal, S>, is_resumed: bool) -> Vec<Vec<u64>> {
        let system = Ring { k: 1e-3 };
        let mut run = method.trajectory(&system, 0.3, start());
        let mut states = Vec::new();
        for _ in 0..3 {
            states.extend(run.by_ref().take(50).map(|state| bits(&state.unwrap())));
            let checkpoint = run.checkpoint();
            if is_resumed {
                run = method.resume(&system, as_text(checkpoint));
            }
        }
        states.push(vec![run.time().to_bits()]);
        states
    }
    let six = Composition::kahan_li_6(Trapezoidal);
    let eight = Composition::kahan_li_8(Trapezoidal);
    assert!(states(six, true) == states(six, false));
    assert!(states(eight, true) == states(eight, false));
    // The control.
    assert!(states(six, true)[149] != states(eight, true)[149]);
}

/// A state that is no state, or text that broke off, is refused.
#[test]
fn broken_text_is_refused() {
    let checkpoint = Trajectory::new(&Ring { k: 0.0 }, Trapezoidal, 0.1, start()).checkpoint();
    let text = serde_json::to_string(&checkpoint).unwrap();
    assert!(serde_json::from_str::<Checkpoint<f64, 2>>(&text).is_ok());
    for wrong in [
        text.replace("0.3", "null"),
        text.replace("\"steps\":0", "\"steps\":-1"),
        text.replace("\"origin\":0.0,", ""),
        text[..text.len() - 1].to_owned(),
    ] {
        assert_ne!(wrong, text);
        assert!(serde_json::from_str::<Checkpoint<f64, 2>>(&wrong).is_err(), "{wrong}");
    }
    // Another number of coordinates.
    assert!(serde_json::from_str::<Checkpoint<f64, 3>>(&text).is_err());
}
