//! Members that are watched in lanes: the records of those that are watched one by one.

use dalembert::{Midpoint, Splitting, State, rayleigh_system};
use dalembert_ensemble::{Ensemble, Outcome, Record};

/// A particle in the Hénon–Heiles potential with drag, watched for a circle and for where its radius turns.
struct Star {
    r: f64,
    radius: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal], lanes = [explicit, midpoint])]
impl Star {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let [x, y] = q;
        0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.5 * (x * x + y * y) - x * x * y + y * y * y / 3.0
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.r * (v[0] * v[0] + v[1] * v[1])
    }

    fn events(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        [q[0].hypot(q[1]) - self.radius, q[0] * v[0] + q[1] * v[1]]
    }
}

/// The numbers of members are those of points of a lattice: some stay, some pass the circle, some leave to
/// infinity.
fn member(number: u64) -> Result<(Star, State<f64, 2>), dalembert::StepError> {
    let share = |k: u64| (k as f64 * 0.618_033_988_749_894_9).fract() - 0.5;
    let start = State {
        q: [share(number), share(3 * number + 1)].into(),
        p: [share(7 * number), share(5 * number)].into(),
    };
    Ok((Star { r: 0.01 * share(number).abs(), radius: 0.9 }, start))
}

/// Number, steps, time, q and event of each record of the members, or their last state and error.
type Rows = Vec<(u64, u64, f64, [f64; 2], Option<usize>, Option<String>)>;

macro_rules! rows {
    ($study:expr) => {{
        let observe = |rows: &mut Rows, record: &Record<'_, Star, 2>| {
            let Record { number, steps, time, state, event, .. } = *record;
            rows.push((number, steps, time, state.q.into(), event, None));
        };
        let add = |all: &mut Rows, outcome: Outcome<Rows, f64, 2>| {
            all.extend(outcome.value);
            if let Some(failure) = outcome.failure {
                let last = failure.last.unwrap();
                all.push((
                    failure.number,
                    0,
                    last.time,
                    last.state.q.into(),
                    None,
                    Some(failure.error.to_string()),
                ));
            }
        };
        let mut rows = $study.reduce(0..MEMBERS, |_| Vec::new(), observe, Vec::new(), add).unwrap();
        rows.sort_by_key(|row| row.0);
        rows
    }};
}

const MEMBERS: u64 = 48;

/// How many records are of an event, after they were compared.
fn same(h: f64, lanes: &Rows, alone: &Rows) -> usize {
    assert_eq!(lanes.len(), alone.len());
    for (lane, alone) in lanes.iter().zip(alone) {
        let ((number, steps, t, q, event, error), found) = (alone, lane);
        assert_eq!((found.0, found.1, found.4, &found.5), (*number, *steps, *event, error));
        let off = (found.2 - t).abs().max((found.3[0] - q[0]).abs()).max((found.3[1] - q[1]).abs());
        // Steps to the last bit; events, and the ends that they are, to rounding.
        let is_step = event.is_none() && *t == h * *steps as f64;
        assert!(if is_step { off == 0.0 } else { off < 1e-9 }, "{found:?} {alone:?}");
    }
    alone.iter().filter(|row| row.4.is_some()).count()
}

#[test]
fn events_in_lanes_are_those_of_members_one_by_one() {
    let terminal = [true, false];
    let study = || Ensemble::new(member).by(Splitting::blanes_moan_6(), 0.2).steps(60).every(7);
    let alone = rows!(study().watch(|at| at.events(), terminal));
    let lanes = rows!(study().in_lanes().watch(|at| at.events(), terminal));
    let ended = same(0.2, &lanes, &alone);
    let study = || Ensemble::new(member).by(Midpoint, 0.1).steps(60);
    let alone = rows!(study().watch(|at| at.events(), [false; 2]));
    let lanes = rows!(study().in_lanes().watch(|at| at.events(), [false; 2]));
    let events = same(0.1, &lanes, &alone);
    assert!(ended > 60 && events > 60, "{ended} {events}");
    // The control: another radius has other events.
    let other = |number| member(number).map(|(star, start)| (Star { radius: 0.8, ..star }, start));
    let alone =
        rows!(Ensemble::new(member).by(Midpoint, 0.1).steps(60).watch(|at| at.events(), [true, false]));
    let lanes = rows!(
        Ensemble::new(other).by(Midpoint, 0.1).steps(60).in_lanes().watch(|at| at.events(), [true, false])
    );
    assert_ne!(lanes.len(), alone.len());
}

/// A panic of `g` in a lane is the failure of its member alone.
#[test]
fn a_panic_in_a_lane_is_that_of_one_member() {
    let study = Ensemble::new(member).by(Splitting::blanes_moan_6(), 0.2).steps(30).in_lanes();
    let rows = rows!(
        study
            .watch(|at| [if at.q == member(37).unwrap().1.q { panic!("for the test") } else { 1.0 }], [true])
    );
    let panicked = rows.iter().filter(|row| row.5.as_ref().is_some_and(|error| error.contains("panic")));
    let failed: Vec<_> = panicked.map(|row| row.0).collect();
    assert_eq!(failed, [37]);
    assert_eq!(rows.len(), MEMBERS as usize);
}
