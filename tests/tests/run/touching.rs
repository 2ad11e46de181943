//! Functions that touch 0, rest there, jump over it or bend at it: each is told once, and by its name.
//!
//! The motion is straight, q = t, so that any method has it and every root is known. Event functions are
//! random products of factors with one zero each, in steps with many of them or few.

use dalembert::nalgebra::vector;
use dalembert::run::events::{Crossing, Event, EventError, Passage};
use dalembert::step::Flow;
use dalembert::{Composition, Discretise, Gauss, Midpoint, Splitting, State, Trapezoidal, rayleigh_system};
use dalembert_tests::draws::Draws;

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
fn straight(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] - 0.0 * q[0]
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
fn oscillator(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] - 0.5 * q[0] * q[0]
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
fn ball(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] - 9.81 * q[0]
}

/// How a factor is 0 at its place.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// A simple root.
    Simple,
    /// A double root.
    Double,
    /// A triple root.
    Triple,
    /// A corner at 0, from which it turns back.
    Corner,
    /// A jump from one side to the other.
    Jump,
    /// 0 on an interval, and then as before.
    Rest,
    /// 0 on an interval, and then on the other side.
    Across,
}

const KINDS: [Kind; 7] =
    [Kind::Simple, Kind::Double, Kind::Triple, Kind::Corner, Kind::Jump, Kind::Rest, Kind::Across];

#[derive(Clone, Copy, Debug)]
struct Factor {
    kind: Kind,
    at: f64,
    /// Half the length of an interval.
    half: f64,
}

impl Factor {
    fn value(&self, q: f64) -> f64 {
        let x = q - self.at;
        let bounded = |x: f64| x / (1.0 + x * x).sqrt();
        match self.kind {
            Kind::Simple => bounded(x),
            Kind::Double => bounded(x).powi(2),
            Kind::Triple => bounded(x).powi(3),
            Kind::Corner => bounded(x).abs(),
            Kind::Jump => {
                if x < 0.0 {
                    -1.0
                } else {
                    1.0
                }
            }
            Kind::Rest => bounded((x.abs() - self.half).max(0.0)),
            Kind::Across => bounded((x.abs() - self.half).max(0.0)).copysign(x),
        }
    }

    fn is_passed(&self) -> bool {
        matches!(self.kind, Kind::Simple | Kind::Triple | Kind::Jump | Kind::Across)
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    functions: u32,
    events: u32,
    refused: u32,
    /// Functions of which an event is missing, is not one, or is called by another name; and those of them
    /// that are smooth.
    wrong: u32,
    wrong_smooth: u32,
    /// Functions that change their sign another number of times than they have events.
    hidden_from_signs: u32,
}

/// An event: when, by how much that may be off, and its passage.
type Expected = (f64, f64, Passage);

/// The events of a product of `factors` that starts on one `side`.
fn expected(factors: &[Factor], mut side: f64) -> Vec<Expected> {
    let mut events = Vec::new();
    for factor in factors {
        let Factor { kind, at, half } = *factor;
        let after = if factor.is_passed() { -side } else { side };
        let passing = if after > 0.0 { Passage::Rising } else { Passage::Falling };
        match kind {
            Kind::Simple | Kind::Jump => events.push((at, 1e-12, passing)),
            Kind::Triple => events.push((at, 1e-4, passing)),
            Kind::Double | Kind::Corner => events.push((at, 1e-6, Passage::Touching)),
            Kind::Rest => events.push((at - half, 1e-6, Passage::Touching)),
            Kind::Across => {
                events.push((at - half, 1e-6, Passage::Touching));
                events.push((at + half, 1e-6, passing));
            }
        }
        side = after;
    }
    events
}

/// Watches a straight motion for a random product of factors.
fn trial<M: Copy>(method: M, draws: &mut Draws, tally: &mut Tally)
where
    Straight: Flow<M, 1, Scalar = f64>,
{
    let h = draws.scale(0.01, 0.7);
    let (mut factors, mut at) = (Vec::new(), 0.02);
    for _ in 0..1 + draws.below(4) {
        at += draws.scale(0.03, 0.5);
        let kind = KINDS[draws.below(KINDS.len())];
        let half = if matches!(kind, Kind::Rest | Kind::Across) { draws.scale(1e-3, 0.3) } else { 0.0 };
        // On the grid at times.
        let middle = at + half;
        let placed = if draws.below(3) == 0 { (middle / h).ceil() * h } else { middle };
        factors.push(Factor { kind, at: placed, half });
        at = placed + half;
    }
    let end = at + 0.02 + draws.between(0.0, h);
    let size = draws.sign() * draws.scale(1e-6, 1e6);
    let g = |q: f64| size * factors.iter().map(|factor| factor.value(q)).product::<f64>();
    let all = expected(&factors, g(0.0).signum());
    for crossing in [Crossing::Either, Crossing::Rising, Crossing::Falling] {
        let counts = |passage: Passage| match crossing {
            Crossing::Either => true,
            Crossing::Rising => passage == Passage::Rising,
            Crossing::Falling => passage == Passage::Falling,
        };
        let expected: Vec<_> = all.iter().filter(|event| counts(event.2)).collect();
        let mut run = Straight {}.by(method, h).run(State { q: vector![0.0], p: vector![1.0] });
        let found: Result<Vec<_>, EventError> =
            run.watch(|at| [g(at.q[0])]).crossing([crossing]).until(end).collect();
        assert!(found.is_err() || run.time() == end);
        tally.functions += 1;
        tally.events += expected.len() as u32;
        let is_same = |(event, expected): (&Event<f64, 1>, &&Expected)| {
            (event.time - expected.0).abs() <= expected.1 && event.passage == expected.2
        };
        match found {
            Err(error) => {
                println!("{error}: h {h} {crossing:?} {factors:?} {}", std::any::type_name::<M>());
                tally.refused += 1;
            }
            Ok(found) if found.len() == expected.len() && found.iter().zip(&expected).all(is_same) => {}
            Ok(found) => {
                let told: Vec<_> = found.iter().map(|event| (event.time, event.passage)).collect();
                println!("wrong: h {h} {crossing:?} {factors:?} {}", std::any::type_name::<M>());
                println!("  found {told:?}\n  expected {expected:?}");
                tally.wrong += 1;
                let is_smooth =
                    |factor: &Factor| matches!(factor.kind, Kind::Simple | Kind::Double | Kind::Triple);
                tally.wrong_smooth += u32::from(factors.iter().all(is_smooth));
            }
        }
    }
    let steps = (end / h).ceil() as u32;
    let signs: Vec<_> = (0..=steps).map(|step| g(h * f64::from(step)) < 0.0).collect();
    let changes = signs.windows(2).filter(|pair| pair[0] != pair[1]).count();
    tally.hidden_from_signs += 3 * u32::from(changes != all.len());
}

fn trials(numbers: impl IntoIterator<Item = u64>) -> Tally {
    let mut tally = Tally::default();
    for number in numbers {
        let mut draws = Draws::new(number * 7919);
        match draws.below(7) {
            0 => trial(Midpoint, &mut draws, &mut tally),
            1 => trial(Trapezoidal, &mut draws, &mut tally),
            2 => trial(Gauss::<2>, &mut draws, &mut tally),
            3 => trial(Gauss::<4>, &mut draws, &mut tally),
            4 => trial(Gauss::<8>, &mut draws, &mut tally),
            5 => trial(Splitting::blanes_moan_6(), &mut draws, &mut tally),
            _ => trial(Composition::kahan_li_6(Midpoint), &mut draws, &mut tally),
        }
    }
    println!("{tally:?}");
    tally
}

/// No smooth one is told wrongly. Of those with jumps and corners some are, one of a hundred at most, where
/// several in one step hide one another; and one of five hundred at most is refused.
fn assert_told(tally: Tally) {
    assert_eq!(tally.wrong_smooth, 0, "{tally:?}");
    assert!(tally.refused * 500 <= tally.functions && tally.wrong * 100 <= tally.functions, "{tally:?}");
    // Positive control: signs at the ends of steps tell few of them.
    assert!(tally.hidden_from_signs * 2 > tally.functions, "{tally:?}");
}

#[test]
fn functions_of_all_kinds_are_told_once() {
    assert_told(trials(0..if cfg!(debug_assertions) { 60 } else { 300 }));
}

/// 60 000 watches, for the counts that the documentation has.
#[test]
#[ignore = "minutes: cargo test --release -p dalembert-tests --test run sixty_thousand -- --ignored"]
fn sixty_thousand_functions_are_told_once() {
    let threads = std::thread::available_parallelism().map_or(1, |threads| threads.get() as u64);
    let share = |k: u64| 1000 + 20_000 * k / threads;
    std::thread::scope(|scope| {
        let all: Vec<_> = (0..threads).map(|k| scope.spawn(move || trials(share(k)..share(k + 1)))).collect();
        let all: Vec<_> = all.into_iter().map(|one| one.join().unwrap()).collect();
        all.into_iter().for_each(assert_told);
    });
}

/// A ball thrown to its ceiling, and an oscillator that comes back to its start ten times: touched once each
/// time, in neither direction, whatever rounding makes of the root.
#[test]
fn a_motion_that_turns_at_zero_touches_it_once() {
    fn check<L, M: Copy>(
        system: &L,
        method: M,
        h: f64,
        start: State<f64, 1>,
        level: f64,
        end: f64,
        times: usize,
    ) where
        L: Flow<M, 1, Scalar = f64>,
    {
        for (crossing, expected) in [(Crossing::Either, times), (Crossing::Rising, 0), (Crossing::Falling, 0)]
        {
            let mut run = system.by(method, h).run(start);
            let found: Vec<_> = run
                .watch(|at| [at.q[0] - level])
                .crossing([crossing])
                .until(end)
                .map(Result::unwrap)
                .collect();
            assert_eq!(found.len(), expected, "{h} {level} {crossing:?} {found:?}");
            assert!(found.iter().all(|event| event.passage == Passage::Touching), "{found:?}");
        }
    }
    let thrown = State { q: vector![0.0], p: vector![19.62_f64.sqrt()] };
    for h in [0.01, 0.03, 0.1, 0.37] {
        check(&Ball {}, Midpoint, h, thrown, 1.0, 1.0, 1);
        check(&Ball {}, Trapezoidal, h, thrown, 1.0, 1.0, 1);
        check(&Ball {}, Gauss::<2>, h, thrown, 1.0, 1.0, 1);
        check(&Ball {}, Composition::kahan_li_6(Midpoint), h, thrown, 1.0, 1.0, 1);
        check(&Ball {}, Splitting::blanes_moan_6(), h, thrown, 1.0, 1.0, 1);
    }
    let drawn = State { q: vector![1.0], p: vector![0.0] };
    for h in [0.03, 0.1, 0.25, 0.7] {
        // Gauss rules keep the amplitude to rounding.
        for level in [1.0, 1.0 - 1e-15] {
            check(&Oscillator {}, Gauss::<4>, h, drawn, level, 63.0, 10);
            check(&Oscillator {}, Gauss::<8>, h, drawn, level, 63.0, 10);
        }
    }
    // Positive control: a level that is passed by more than rounding is passed twice.
    let mut run = Oscillator {}.by(Gauss::<8>, 0.25).run(drawn);
    let watch = run.watch(|at| [at.q[0] - (1.0 - 1e-10)]);
    let passages: Vec<_> = watch.until(63.0).map(|event| event.unwrap().passage).collect();
    let count = |passage| passages.iter().filter(|&&found| found == passage).count();
    assert_eq!((count(Passage::Rising), count(Passage::Falling), count(Passage::Touching)), (10, 11, 0));
}

/// A ball that loses speed at each impact, or all of it, is told to rest where it does: the run stands on the
/// floor at the time when all flights are over.
#[test]
fn a_ball_that_comes_to_rest_on_its_floor_stays_there() {
    fn check<M: Copy>(method: M, h: f64, restitution: f64, least: u32)
    where
        Ball: Flow<M, 1, Scalar = f64>,
    {
        let mut run = Ball {}.by(method, h).run(State { q: vector![1.0], p: vector![0.0] });
        let mut watch = run.watch(|at| [at.q[0]]).crossing([Crossing::Falling]).terminal([true]).until(1e3);
        let mut impacts = 0;
        let error = loop {
            match watch.next().expect("it rests before") {
                Ok(event) => watch.restart(State { q: event.state.q, p: event.state.p * -restitution }),
                Err(error) => break error,
            }
            impacts += 1;
        };
        assert!(matches!(error, EventError::Chattering { .. }), "{error}");
        assert!(impacts >= least, "{restitution} {h}: {impacts}");
        // √(2/g) (1 + 2e + 2e² + …)
        let rest = (2.0_f64 / 9.81).sqrt() * (1.0 + restitution) / (1.0 - restitution);
        let (time, state) = (watch.run().time(), *watch.run().state());
        assert!((time - rest).abs() < 1e-9, "{restitution} {h}: {time} for {rest}");
        assert!(state.q[0].abs() < 1e-16 && state.p[0].abs() < 1e-11, "{restitution} {h}: {state:?}");
        assert!(watch.next().is_none());
    }
    for (restitution, least) in [(0.0, 1), (0.2, 20), (0.5, 50), (0.9, 250)] {
        check(Midpoint, 0.01, restitution, least);
        check(Trapezoidal, 0.003, restitution, least);
        check(Gauss::<2>, 0.1, restitution, least);
        check(Gauss::<8>, 0.01, restitution, least);
        check(Splitting::blanes_moan_6(), 0.05, restitution, least);
    }
    // Positive control: a push through the plane is none, nor is a motion that goes on.
    for factor in [1.0, 1.5] {
        let mut run = Ball {}.by(Gauss::<2>, 0.1).run(State { q: vector![1.0], p: vector![0.0] });
        let mut watch = run.watch(|at| [at.q[0]]).terminal([true]).until(1.0);
        let event = watch.next().unwrap().unwrap();
        watch.restart(State { q: event.state.q, p: event.state.p * factor });
        assert!(watch.next().is_none() && run.state().q[0] < -1.0 && run.time() == 1.0);
    }
}
