//! The error asked for, over a random collection of motions: `cargo study tolerance_study` tries more of them.

use dalembert_tests::motions::{Verdict, collection};

#[test]
fn of_random_motions_none_passes_its_error_in_silence() {
    let tolerances = [1e-2, 1e-5, 1e-8, 1e-11];
    let (mut runs, mut passed, mut wrong) = (0, 0, 0);
    for motion in collection(3, 42) {
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
    assert!(wrong * 25 <= runs, "{wrong} of {runs} breaches where the error was kept");
}
