//! When friction comes to stick and begins to slip, beside closed forms.

use dalembert::run::stick_slip::{Change, StickSlipEvent};
use dalembert::{Discretise, Proximal, State, StepError, rayleigh_system};
use dalembert_tests::draws::Draws;

/// A mass of 1 on a spring, on a belt that may move, pulled by a force that grows as t².
struct Block {
    k: f64,
    friction: f64,
    belt: f64,
    pull: f64,
}

#[rayleigh_system(rule = proximal)]
impl Block {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - 0.5 * self.k * q[0] * q[0]
    }
    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        self.friction * (v[0] - self.belt).abs()
    }
    fn force(&self, _q: [f64; 1], _v: [f64; 1], t: f64) -> [f64; 1] {
        [self.pull * t * t]
    }
}

const ON_SPRING: Block = Block { k: 1.0, friction: 0.2, belt: 0.0, pull: 0.0 };

type Events = Result<Vec<StickSlipEvent<f64, 1, 1>>, StepError>;

fn events(block: &Block, h: f64, [q, v]: [f64; 2], end: f64) -> Events {
    let view = block.at_time(0.0);
    view.by(Proximal, h).run(State::from_velocity(&view, [q], [v])?).stick_slip(end).collect()
}

#[test]
fn a_block_turns_and_comes_to_rest_when_it_should() -> Result<(), StepError> {
    for (from, turns, at, rest) in
        [([0.9, -0.3], 1, 5.878293520894, 0.161577310586), ([0.5, 0.7], 2, 7.068583470577, -0.010050506339)]
    {
        for h in [0.02, 0.013, 0.005] {
            let events = events(&ON_SPRING, h, from, 20.0)?;
            let count = |change| events.iter().filter(|event| event.change == change).count();
            assert_eq!([count(Change::Sticks), count(Change::Slips)], [turns + 1, turns], "{events:?}");
            let last = events.last().unwrap();
            assert_eq!(last.change, Change::Sticks);
            // A turn within a step is off by half of it at most.
            let most = 0.5 * h * turns as f64;
            assert!((last.time - at).abs() < most, "{h} {:e}", last.time - at);
            assert!((last.state.q[0] - rest).abs() < 0.1 * h * h && last.state.p[0] == 0.0, "{last:?}");
            // It slips on the other way each time, and never before it has stopped.
            for pair in events.windows(2) {
                let [first, then] = pair else { unreachable!() };
                assert!(first.time <= then.time && first.change != then.change);
                let is_turned = first.direction == -then.direction;
                assert_eq!(is_turned, first.change == Change::Sticks);
            }
        }
    }
    Ok(())
}

/// From rest a block goes from q to 2(±μ/k) − q in half a period, until the spring no longer moves it.
#[test]
fn random_blocks_turn_as_often_as_they_should() -> Result<(), StepError> {
    let cases = if cfg!(debug_assertions) { 40 } else { 400 };
    let mut draws = Draws::new(5);
    let (mut compared, mut turned) = (0, 0);
    for case in 0..cases {
        let (k, friction) = (draws.scale(0.3, 3.0), draws.scale(0.05, 0.5));
        let (held, from) = (friction / k, draws.sign() * draws.between(0.1, 8.0) * friction / k);
        let h = draws.between(0.01, 0.06);
        // A step in which it stops is off by an eighth of h² times the acceleration, at most.
        let off = |halves: u32| 0.25 * f64::from(halves + 1) * (k * from.abs() + friction) * h * h;
        let (mut q, mut halves, mut is_clear) = (from, 0, (from.abs() - held).abs() > off(0));
        while q.abs() > held {
            q = 2.0 * held.copysign(q) - q;
            halves += 1;
            is_clear &= (q.abs() - held).abs() > off(halves);
        }
        let half = std::f64::consts::PI / k.sqrt();
        let block = Block { k, friction, belt: 0.0, pull: 0.0 };
        let found = events(&block, h, [from, 0.0], half * f64::from(halves + 3))?;
        if !is_clear {
            continue;
        }
        assert_eq!(found.len(), 2 * halves as usize, "{case}: {found:?}");
        let (mut q, mut side) = (from, -from.signum());
        for (pair, number) in found.chunks(2).zip(1_u32..) {
            assert_eq!([pair[0].change, pair[1].change], [Change::Slips, Change::Sticks], "{case}");
            assert_eq!([pair[0].direction[0], pair[1].direction[0]], [side; 2], "{case}");
            q = 2.0 * held.copysign(q) - q;
            side = -side;
            let late = pair[1].time - half * f64::from(number);
            assert!(late.abs() < 0.5 * f64::from(number) * h + h * h, "{case}: {late:e}");
            assert!((pair[1].state.q[0] - q).abs() < off(number), "{case}");
            turned += 1;
        }
        compared += 1;
    }
    assert!(compared * 10 > cases * 9 && turned > compared, "{compared} {turned}");
    Ok(())
}

/// Order 1 in general: it starts from states that have turned within a step. The mean over many step sizes.
#[test]
fn times_of_sticking_are_of_order_one() -> Result<(), StepError> {
    let mean = |h: f64| -> Result<f64, StepError> {
        let mut sum = 0.0;
        for part in 0..16 {
            let h = h * (1.0 + 0.01 * f64::from(part));
            let events = events(&ON_SPRING, h, [0.9, -0.3], 7.0)?;
            sum += (events.last().unwrap().time - 5.878293520894).abs() / 16.0;
        }
        Ok(sum)
    };
    let slope = (mean(0.08)? / mean(0.02)?).log2() / 2.0;
    assert!(slope > 0.7 && slope < 1.6, "{slope}");
    Ok(())
}

#[test]
fn a_load_that_grows_moves_a_block_at_its_limit() -> Result<(), StepError> {
    for (h, pull) in [(0.02, 0.1), (0.01, -0.1), (0.0037, 0.1)] {
        let block = Block { k: 0.0, friction: 0.2, belt: 0.0, pull };
        let found = events(&block, h, [0.3, 0.0], 3.0)?;
        let [slips] = found[..] else { panic!("{found:?}") };
        assert!(slips.change == Change::Slips && slips.element == 0);
        // The force has no error at a block at rest.
        assert!((slips.time - 2.0_f64.sqrt()).abs() < 1e-9 * h, "{:e}", slips.time - 2.0_f64.sqrt());
        assert_eq!((slips.direction[0], slips.state.q[0], slips.state.p[0]), (pull.signum(), 0.3, 0.0));
        // Positive control: before that it holds.
        assert!(events(&block, h, [0.3, 0.0], 1.41)?.is_empty());
    }
    // Beyond its limit from the start.
    let block = Block { k: 1.0, friction: 0.2, belt: 0.0, pull: 0.0 };
    let found = events(&block, 0.01, [0.5, 0.0], 1.0)?;
    assert!(found.len() == 1 && found[0].time == 0.0 && found[0].direction[0] == -1.0, "{found:?}");
    Ok(())
}

#[test]
fn a_belt_carries_a_block_until_the_spring_holds_it_back() -> Result<(), StepError> {
    let block = Block { k: 1.0, friction: 0.2, belt: 0.1, pull: 0.0 };
    for h in [0.02, 0.013] {
        let found = events(&block, h, [0.0, 0.1], 3.0)?;
        let [slips] = found[..] else { panic!("{found:?}") };
        // The spring pulls by 0.2 at q = 0.2.
        assert!((slips.time - 2.0).abs() < h * h && (slips.state.q[0] - 0.2).abs() < h * h, "{slips:?}");
        assert!(slips.change == Change::Slips && slips.direction[0] == -1.0);
    }
    Ok(())
}

struct Two;

#[rayleigh_system(rule = proximal)]
impl Two {
    fn lagrangian(&self, _q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * v[0] * v[0] + v[1] * v[1]
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.3 * (v[0] - v[1]).abs()
    }
}

struct Puck;

#[rayleigh_system(rule = proximal)]
impl Puck {
    fn lagrangian(&self, _q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1])
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.2 * (v[0] * v[0] + v[1] * v[1]).sqrt()
    }
}

#[test]
fn bodies_stick_to_one_another_and_in_the_plane() -> Result<(), StepError> {
    let start = State::from_velocity(&Two, [0.0, 0.0], [1.0, 0.0])?;
    let mut run = Two.by(Proximal, 0.01).run(start);
    let found = run.stick_slip(5.0).collect::<Result<Vec<_>, _>>()?;
    // The slip 1 falls by 0.3 (1 + ½) a second.
    let by_hand = 1.0 / 0.45;
    assert!(found.len() == 1 && (found[0].time - by_hand).abs() < 1e-9, "{found:?}");
    assert!(found[0].change == Change::Sticks && found[0].direction[0] == 1.0);
    // They move on together, and are not told to slip when asked again.
    assert!((run.velocity()?[0] - 1.0 / 3.0).abs() < 1e-14 && run.stick_slip(9.0).next().is_none());
    // The steps are those of the run itself, bit by bit.
    let mut unwatched = Two.by(Proximal, 0.01).run(start);
    unwatched.until(5.0).for_each(|step| assert!(step.is_ok()));
    unwatched.until(9.0).for_each(|step| assert!(step.is_ok()));
    assert_eq!((run.state(), run.time()), (unwatched.state(), unwatched.time()));

    let mut run = Puck.by(Proximal, 0.01).run(State::from_velocity(&Puck, [0.0, 0.0], [0.3, 0.4])?);
    let found = run.stick_slip(5.0).collect::<Result<Vec<_>, _>>()?;
    assert!(found.len() == 1 && (found[0].time - 2.5).abs() < 1e-9, "{found:?}");
    assert!((found[0].direction - dalembert::nalgebra::vector![0.6, 0.8]).amax() < 1e-12);
    Ok(())
}

#[test]
fn an_error_is_the_last_item() -> Result<(), StepError> {
    let block = Block { k: 1.0, friction: -0.2, belt: 0.0, pull: 0.0 };
    let view = block.at_time(0.0);
    let mut run = view.by(Proximal, 0.01).run(State { q: [1.0].into(), p: [0.0].into() });
    let state = *run.state();
    let mut watch = run.stick_slip(1.0);
    assert!(matches!(watch.next(), Some(Err(StepError::NegativeFriction { .. }))));
    assert!(watch.next().is_none() && run.state() == &state);
    Ok(())
}
