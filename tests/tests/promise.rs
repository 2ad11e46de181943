//! The tolerance, over a random collection of motions: `cargo study tolerance_study` tries more of
//! them.

use dalembert_tests::motions::{Verdict, collection, driven};

#[test]
fn of_random_motions_none_passes_its_error_in_silence() {
    let tolerances = [1e-2, 1e-5, 1e-8, 1e-11];
    let (mut runs, mut passed, mut wrong) = (0, 0, 0);
    for motion in collection(3, if cfg!(debug_assertions) { 20 } else { 42 }) {
        for tolerance in tolerances {
            let outcome = motion.ask(tolerance);
            runs += 1;
            let what = || format!("{}, {}, {tolerance:e}: {outcome:?}", motion.family, motion.what);
            assert!(outcome.verdict != Verdict::Silent || outcome.error <= 2.0, "{}", what());
            passed += usize::from(outcome.error > 2.0);
            wrong += usize::from(outcome.is_false_breach());
        }
    }
    // Positive control: with the guard switched off these would have passed it in silence.
    assert!(passed >= runs / 10, "{passed} of {runs}");
    assert!(wrong * 50 <= runs, "{wrong} of {runs} breaches where the error was kept");
}

#[test]
fn what_has_been_missed_or_reported_for_nothing_once_is_not_again() {
    // Seed, place and tolerance: what the reason was.
    let passed = [
        // One J for angles up to a radian, and local errors of few looks, by Gauss methods of long steps
        // where motions part.
        (4711, 166, 1e-10),
        (4711, 124, 1e-10),
        // Local errors were weighed as at their looks, where a fast mode's are those of its coordinate.
        (777_013, 5, 2e-10),
        (777_013, 145, 1e-8),
        // Of six coordinates the growth of an error was not followed: by a splitting, and by a Gauss method.
        (4711, 181, 1e-2),
        (777_013, 265, 1e-10),
        // The force was asked for in the middle of steps alone: a pulse at the end of one stayed unseen.
        (90_211, 217, 1e-4),
        // An error that was no number counted as none.
        (777_013, 88, 1e-2),
    ];
    let kept = [
        // What the error is not known to was given an energy that it cannot have.
        (4711, 4, 1e-2),
        (4711, 4, 1e-4),
        // J at looks that meet the same phase of an orbit was taken for constant.
        (1, 240, 1e-2),
        (4711, 72, 1e-4),
        // Rounding grew as an error of another direction did.
        (4711, 89, 1e-12),
    ];
    let ask = |seed: u64, place: usize, tolerance: f64| {
        let motion = collection(seed, place + 1).pop().unwrap();
        (format!("{}, {}, {tolerance:e}", motion.family, motion.what), motion.ask(tolerance))
    };
    for (seed, place, tolerance) in passed {
        let (what, outcome) = ask(seed, place, tolerance);
        // Positive control: the error is passed.
        assert!(outcome.error > 1.0, "{what}: {outcome:?}");
        assert_ne!(outcome.verdict, Verdict::Silent, "{what}: {outcome:?}");
    }
    for (seed, place, tolerance) in kept {
        let (what, outcome) = ask(seed, place, tolerance);
        assert!(outcome.verdict == Verdict::Silent && outcome.error <= 1.0, "{what}: {outcome:?}");
        // Positive control: an error there is.
        assert!(outcome.error > 1e-3, "{what}: {outcome:?}");
    }
}

#[test]
fn the_cheapest_fixed_choice_is_no_accident() {
    // A pendulum that is at rest long before the end, where one step over the whole time leads to by
    // accident.
    let motion = collection(4711, 4).pop().unwrap();
    assert!(motion.what.starts_with("r 0.785"), "{}", motion.what);
    for cheapest in motion.cheapest(&[1e-2, 1e-6, 1e-10]) {
        assert!(cheapest.unwrap().0 > 100.0, "{cheapest:?}");
    }
}

#[test]
fn the_end_asked_for_is_one_whose_error_was_kept() {
    let (mut asked, mut without, mut breached, mut runs) = (0, 0, 0, 0);
    for motion in collection(17, if cfg!(debug_assertions) { 10 } else { 42 }) {
        for tolerance in [1e-3, 1e-7, 1e-11] {
            let (outcome, tried) = motion.reach(tolerance);
            let what = || format!("{}, {}, {tolerance:e}: {outcome:?}", motion.family, motion.what);
            assert!(!matches!(outcome.verdict, Verdict::Breach(_)), "{}", what());
            assert!(outcome.error <= 2.0, "{}", what());
            asked += 1;
            without += usize::from(outcome.verdict == Verdict::Refused && motion.family != "kink");
            breached += usize::from(matches!(motion.ask(tolerance).verdict, Verdict::Breach(_)));
            runs += tried;
        }
    }
    // Where nothing is smooth no step is short enough; elsewhere an end is found, as a rule by the second
    // run.
    assert!(without * 20 <= asked, "{without} of {asked}");
    assert!(runs <= 2 * asked as u32, "{runs} runs for {asked}");
    // Positive control: the first choice alone would have passed many errors.
    assert!(breached * 10 >= asked, "{breached} of {asked}");
}

#[test]
fn drives_of_l_are_followed_whatever_their_frequency() {
    let (mut kept, mut runs) = (0, 0);
    for motion in driven(91, 20) {
        for tolerance in [1e-4, 1e-9] {
            let (outcome, _) = motion.reach(tolerance);
            let what = || format!("{}, {}, {tolerance:e}: {outcome:?}", motion.family, motion.what);
            assert!(outcome.verdict != Verdict::Silent || outcome.error <= 2.0, "{}", what());
            runs += 1;
            kept += usize::from(outcome.verdict == Verdict::Silent);
        }
    }
    // Before drives were followed, half of Mathieu's equations were said to have passed an error that they
    // kept.
    assert!(kept * 20 >= runs * 19, "{kept} of {runs}");
}
