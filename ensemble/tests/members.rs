//! Members are the trajectories that they would be alone; one that fails stands in the result.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use dalembert::nalgebra::vector;
use dalembert::run::Stop;
use dalembert::{
    Composition, Discretise, Gauss, Midpoint, Splitting, State, StepError, Trapezoidal, rayleigh_system,
};
use dalembert_ensemble::{Ensemble, MemberError, Progress, Record, Slot, Stepping, one_by_one};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::ThreadPoolBuilder;

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
fn ring(q: [f64; 2], v: [f64; 2], r: f64) -> (f64, f64) {
    let s = q[0] * q[0] + q[1] * q[1];
    let speed = v[0] * v[0] + v[1] * v[1];
    (0.5 * speed - s * (s - 1.0) * (s - 1.0), 0.5 * r * speed)
}

/// Members of a study.
const MEMBERS: u64 = if cfg!(debug_assertions) { 150 } else { 600 };

fn random(number: u64) -> Result<(Ring, State<f64, 2>), StepError> {
    let mut random = ChaCha8Rng::seed_from_u64(4);
    random.set_stream(number);
    let mut any = |low: f64, high: f64| random.random_range(low..high);
    let system = Ring { r: any(0.0, 0.1) };
    let start = State::from_velocity(&system, [any(-1.0, 1.0), 1.1], [any(-0.5, 0.5), any(-0.3, 0.3)])?;
    Ok((system, start))
}

#[test]
fn every_member_is_the_trajectory_that_it_is_alone() {
    macro_rules! as_alone {
        ($($method:expr),+) => {$(
            let ends = Ensemble::new(random).by($method, 0.1).steps(25).ends(1000..1000 + MEMBERS).unwrap();
            assert_eq!(ends.len(), MEMBERS as usize);
            for (number, end) in (1000..).zip(&ends) {
                let (system, start) = random(number).unwrap();
                let mut run = system.by($method, 0.1).run(start);
                let alone = run.by_ref().take(25).last().unwrap().unwrap().state;
                let end = end.unwrap();
                assert_eq!((end.number, end.time, end.state), (number, run.time(), alone));
            }
        )+};
    }
    as_alone!(
        Midpoint,
        Trapezoidal,
        Gauss::<3>,
        Splitting::blanes_moan_4(),
        Composition::kahan_li_6(Trapezoidal)
    );
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let sum = |threads: usize| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let study = Ensemble::new(random).by(Trapezoidal, 0.05).steps(20).every(3);
            // A sum whose roundings depend on the order.
            let add =
                |sum: &mut f64, record: &dalembert_ensemble::Record<'_, Ring, 2>| *sum += record.state.q[0];
            study
                .reduce(
                    0..15 * MEMBERS,
                    |_| 0.0,
                    add,
                    0.0,
                    |sum: &mut f64, outcome| *sum += outcome.value / 3.0,
                )
                .unwrap()
        })
    };
    let one = sum(1);
    assert!(one != 0.0 && [2, 3, 7].iter().all(|&threads| sum(threads).to_bits() == one.to_bits()));
}

#[test]
fn records_are_at_the_start_each_stride_and_the_end() {
    let times = |steps, every: Option<u64>| {
        let mut study = Ensemble::new(random).by(Midpoint, 0.5).steps(steps);
        if let Some(stride) = every {
            study = study.every(stride);
        }
        let observe = |times: &mut Vec<(u64, f64)>, record: &dalembert_ensemble::Record<'_, Ring, 2>| {
            times.push((record.steps, record.time));
        };
        study.reduce(5..6, |_| Vec::new(), observe, Vec::new(), |all, outcome| *all = outcome.value).unwrap()
    };
    assert_eq!(times(7, None), [(7, 3.5)]);
    assert_eq!(times(7, Some(3)), [(0, 0.0), (3, 1.5), (6, 3.0), (7, 3.5)]);
    assert_eq!(times(6, Some(3)), [(0, 0.0), (3, 1.5), (6, 3.0)]);
    assert_eq!((times(0, None), times(0, Some(0))), (vec![(0, 0.0)], vec![(0, 0.0)]));
    assert_eq!(times(2, Some(0)).len(), 3);
}

/// Cubic drag, which excites where v < 0: no real step from some states.
#[rayleigh_system]
fn cubic(q: [f64; 1], v: [f64; 1]) -> (f64, f64) {
    (0.5 * v[0] * v[0] - 0.0 * q[0], v[0].powi(3) / 3.0)
}

#[test]
fn a_member_that_fails_stands_in_the_result_and_stops_no_other() {
    let members = |number: u64| {
        if number % 100 == 7 {
            return Err(StepError::StepSize { h: 0.0 });
        }
        let p = if number % 100 == 3 { f64::NAN } else { 0.1 - 0.02 * (number % 100) as f64 };
        Ok((Cubic {}, State { q: vector![0.0], p: vector![p] }))
    };
    let ends = Ensemble::new(members).by(Midpoint, 1.0).steps(4).ends(0..300).unwrap();
    let mut failed = 0;
    for (number, end) in (0..).zip(&ends) {
        let alone = members(number).map(|(system, start)| {
            let mut run = system.by(Midpoint, 1.0).run(start);
            let error = run.by_ref().take(4).find_map(Result::err);
            (run.time(), *run.state(), error)
        });
        match (end, alone) {
            (Ok(end), Ok((time, state, None))) => assert_eq!((end.time, end.state), (time, state)),
            (Err(failure), Ok((time, state, Some(error)))) => {
                failed += 1;
                let last = failure.last.unwrap();
                assert_eq!((failure.number, failure.error), (number, MemberError::Step(error)));
                assert!(last.time == time && format!("{:?}", last.state) == format!("{state:?}"));
            }
            (Err(failure), Err(error)) => {
                failed += 1;
                assert_eq!((failure.error, failure.last), (MemberError::Step(error), None));
                assert!(failure.to_string().contains("no start"), "{failure}");
            }
            (end, alone) => panic!("{number}: {end:?} {alone:?}"),
        }
    }
    // Every kind was there.
    assert!(
        failed > 100 && failed < 290 && ends[7].is_err() && ends[3].is_err() && ends[0].is_ok(),
        "{failed}"
    );
}

#[test]
fn progress_is_told_and_may_cancel() {
    let told = AtomicU64::new(0);
    let watch = |progress: Progress| {
        told.fetch_add(1, Ordering::Relaxed);
        if progress.done >= 5000 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let pool = ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let study = Ensemble::new(random).by(Trapezoidal, 0.1).steps(1).on_progress(watch);
    let cancelled = pool.install(|| study.ends(0..1_000_000)).unwrap_err();
    assert!(cancelled.progress.done >= 5000 && cancelled.progress.done < 20_000, "{cancelled}");
    assert_eq!(cancelled.total.len() as u64, cancelled.progress.done);
    assert_eq!(cancelled.progress.members, 1_000_000);
    // To the end there is nothing to cancel, and the last call tells of all.
    let all = pool.install(|| study.ends(0..4000)).unwrap();
    assert!(all.len() == 4000 && told.load(Ordering::Relaxed) >= 4);
    #[expect(clippy::reversed_empty_ranges, reason = "no members")]
    let none = study.ends(3..1).unwrap();
    assert!(none.is_empty());
}

#[test]
fn an_error_may_be_asked_for() {
    let study = Ensemble::new(random).to_error(1e-6, 3.0);
    let ends = study.ends(0..20).unwrap();
    for (number, end) in (0..).zip(&ends) {
        let (system, start) = random(number).unwrap();
        let exact = system.by(Gauss::<8>, 0.05).run(start).nth(59).unwrap().unwrap().state;
        let end = end.unwrap();
        assert!(end.time == 3.0 && (end.state.q - exact.q).amax() < 1e-6, "{number}");
    }
    let impossible = Ensemble::new(random).to_error(-1.0, 3.0).ends(0..3).unwrap();
    assert!(impossible.iter().all(|end| matches!(
        end.unwrap_err(),
        dalembert_ensemble::Failure { error: MemberError::Tolerance(_), last: Some(_), .. }
    )));
}

/// A cart that is pushed by an input and shaken in time.
struct Cart {
    m: f64,
    r: f64,
}

#[rayleigh_system(rule = [midpoint, gauss])]
impl Cart {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
        0.5 * self.m * v[0] * v[0] + (1.0 + 0.2 * (3.0 * t).sin()) * q[0].cos()
    }

    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.5 * self.r * v[0] * v[0]
    }

    fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1], t: f64) -> [f64; 1] {
        [u[0] * t.cos()]
    }
}

#[test]
fn members_may_be_driven_and_start_at_a_time_of_their_own() {
    let number = |number: u64, size: f64| {
        let mut random = ChaCha8Rng::seed_from_u64(9);
        random.set_stream(number);
        random.random_range(0.1..size)
    };
    let carts: Vec<Cart> =
        (0..70).map(|member| Cart { m: 1.0 + number(member, 1.0), r: number(member, 0.5) }).collect();
    let driven = |member: u64| carts[member as usize].driven([number(member, 2.0)], number(member, 7.0));
    let start = State { q: vector![0.3], p: vector![-0.1] };
    let ends = |threads| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let study = Ensemble::new(|member| Ok((driven(member), start))).by(Midpoint, 0.1).steps(30);
        pool.install(|| study.ends(0..70)).unwrap()
    };
    let one = ends(1);
    assert_eq!(one, ends(3));
    for (member, end) in (0..).zip(&one) {
        let view = driven(member);
        let alone = view.by(Midpoint, 0.1).run(start).nth(29).unwrap().unwrap().state;
        assert_eq!(end.unwrap().state, alone);
        // Input and time are seen.
        for other in [carts[member as usize].driven([0.0], 0.0), carts[member as usize].driven([3.0], 1.0)] {
            let other = other.by(Midpoint, 0.1).run(start).nth(29).unwrap().unwrap().state;
            assert!((other.q - alone.q).amax() > 1e-6);
        }
    }
    // To an error, each by the method that serves it.
    let near = Ensemble::new(|member| Ok((driven(member), start))).to_error(1e-8, 3.0).ends(0..5).unwrap();
    for (member, end) in (0..).zip(&near) {
        let exact = driven(member).by(Gauss::<8>, 0.05).run(start).nth(59).unwrap().unwrap().state;
        assert!((end.unwrap().state.q - exact.q).amax() < 1e-8);
    }
}

/// Members that wait for each other, so long: whether two have met.
struct Meeting<'m> {
    at_once: u64,
    patience: Duration,
    there: AtomicU64,
    have_met: &'m AtomicBool,
}

impl Stepping<Ring, 2> for Meeting<'_> {
    fn advance<V>(
        &self,
        members: &mut [Slot<Ring, V, 2>],
        _: &impl Fn(&mut V, &Record<'_, Ring, 2>) -> ControlFlow<()>,
        _: Stop<'_>,
    ) -> ControlFlow<()> {
        one_by_one(members, |_, _, _, _| {
            if self.there.fetch_add(1, Ordering::SeqCst) == 1 {
                self.have_met.store(true, Ordering::SeqCst);
            }
            let since = Instant::now();
            while !self.have_met.load(Ordering::SeqCst) && since.elapsed() < self.patience {
                thread::yield_now();
            }
            self.there.fetch_sub(1, Ordering::SeqCst);
            ControlFlow::Continue(None)
        })
    }

    fn at_once(&self) -> u64 {
        self.at_once
    }

    fn description(&self) -> String {
        "a meeting".to_owned()
    }
}

#[test]
fn few_members_that_take_long_are_stepped_by_all_threads() {
    let have_met = |at_once, patience| {
        let (there, have_met) = (AtomicU64::new(0), AtomicBool::new(false));
        let meeting = Meeting { at_once, patience, there, have_met: &have_met };
        let study = Ensemble::new(random).stepped(meeting);
        let pool = ThreadPoolBuilder::new().num_threads(2).build().unwrap();
        // None of them has a record.
        let members = |count: &mut u64, _| *count += 1;
        assert_eq!(pool.install(|| study.reduce(0..2, |_| (), |(), _| (), 0, members)).unwrap(), 2);
        have_met.load(Ordering::SeqCst)
    };
    assert!(have_met(1, Duration::from_secs(20)));
    // Control: one thread takes both.
    assert!(!have_met(64, Duration::from_millis(100)));
}
