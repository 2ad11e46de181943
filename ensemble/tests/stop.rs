//! Studies end soon after they are told to, however long their members are.

use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, available_parallelism};
use std::time::{Duration, Instant};

use dalembert::{Discretise, Gauss, Midpoint, Splitting, State, StepError, rayleigh_system};
use dalembert_ensemble::{Cancelled, Ends, Ensemble};

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss], lanes = [explicit, midpoint, gauss])]
fn pendulum(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
}

/// More steps than any machine takes in a day.
const FOR_EVER: u64 = 1 << 50;

/// When the flag is set.
const AFTER: Duration = Duration::from_millis(50);

/// How soon after it all has to have ended.
const SOON: Duration = Duration::from_secs(1);

fn member(number: u64) -> Result<(Pendulum, State<f64, 1>), StepError> {
    Ok((Pendulum { r: 1e-12 * number as f64 }, State { q: [1.0].into(), p: [0.0].into() }))
}

/// What a study comes to whose flag is set after [`AFTER`].
fn flagged<T>(study: impl FnOnce(&AtomicBool) -> T) -> T {
    let flag = AtomicBool::new(false);
    let begun = Instant::now();
    thread::scope(|scope| {
        scope.spawn(|| {
            thread::sleep(AFTER);
            flag.store(true, Ordering::Relaxed);
        });
        let result = study(&flag);
        let taken = begun.elapsed();
        // Control: it would not have ended by itself.
        assert!(taken >= AFTER && taken < AFTER + SOON, "{taken:?}");
        result
    })
}

#[track_caller]
fn has_no_ends(ends: Result<Ends<f64, 1>, Cancelled<Ends<f64, 1>>>) {
    let cancelled = ends.expect_err("the flag was set");
    assert!(cancelled.total.is_empty() && cancelled.progress.done == 0, "{cancelled}");
}

#[test]
fn long_members_end_on_their_way() {
    let members = 0..3 * available_parallelism().map_or(1, NonZeroUsize::get) as u64;
    macro_rules! end {
        ($($method:expr),+) => {$(
            let study = || Ensemble::new(member).by($method, 0.1).steps(FOR_EVER);
            has_no_ends(flagged(|flag| study().cancelled_by(flag).ends(members.clone())));
            has_no_ends(flagged(|flag| study().every(7).cancelled_by(flag).ends(members.clone())));
            has_no_ends(flagged(|flag| study().in_lanes().cancelled_by(flag).ends(members.clone())));
            has_no_ends(flagged(|flag| study().every(7).in_lanes().cancelled_by(flag).ends(members.clone())));
        )+};
    }
    end!(Midpoint, Gauss::<3>, Splitting::blanes_moan_4());
}

#[test]
fn members_to_a_tolerance_end_on_their_way() {
    has_no_ends(flagged(|flag| Ensemble::new(member).to_error(1e-9, 5e6).cancelled_by(flag).ends(0..4)));
}

/// A flag that is not set changes nothing, however often it is looked at.
#[test]
fn a_flag_that_is_not_set_changes_no_bit() {
    let flag = AtomicBool::new(false);
    for steps in [0, 64, 65, 513] {
        let study = |stride| Ensemble::new(member).by(Midpoint, 0.1).steps(steps).every(stride);
        for stride in [1, 64, 100] {
            let ends = study(stride).ends(0..9).unwrap();
            assert_eq!(study(stride).cancelled_by(&flag).ends(0..9).unwrap(), ends);
            assert_eq!(study(stride).in_lanes().cancelled_by(&flag).ends(0..9).unwrap(), ends);
            let (system, start) = member(7).unwrap();
            let alone = system.by(Midpoint, 0.1).run(start).take(steps as usize).last();
            assert_eq!(ends[7].unwrap().state, alone.map_or(start, |step| step.unwrap().state));
        }
    }
}
