//! Another study of the same type in a folder.

use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use crate::study::{Call, PLAIN, folder_of, kind};
use crate::trials::Trials;

/// Studies that differ in starts, in fields of all members or of one, with and without a column, and in the
/// method. Control: a field of one member in no column, which is not looked at, as the documentation says.
pub fn are_there(tries: u32) -> Trials {
    let mut random = StdRng::seed_from_u64(1);
    let mut trials = Trials::default();
    let studies = [Call { column: true, ..PLAIN }, Call { column: false, ..PLAIN }];
    let with = studies.map(|study| (study, study.files()));
    // Of parts so large that every second member alone is stepped once.
    let large = Call { of_part: 128, members: 128, column: false, ..PLAIN };
    let large_files = large.files();
    for k in 0..tries {
        let (first, files) = &with[usize::from(k % 2 == 1)];
        let some = 10_f64.powf(random.random_range(-6.0..0.0));
        let second = match k % 8 {
            0 | 1 => Call { p: -0.5, ..*first },
            2 | 3 => Call { r: some, ..*first },
            4 | 5 => Call { p: 0.5 + some, ..*first },
            6 => Call { odd: Some((random.random_range(0..first.members), some)), ..*first },
            _ => Call { steps: first.steps + random.random_range(1..9), ..*first },
        };
        let result = second.write(&folder_of(files));
        trials.hear(result.as_ref().map_or_else(kind, |_| "ok"));
        trials.add(result.ok().map(|written| format!("{second:?} found: {written}")));

        let odd = 2 * random.random_range(0..64) + 1;
        let second = Call { odd: Some((odd, some)), ..large };
        trials.add_control(second.write(&folder_of(&large_files)).is_ok_and(|written| written.found == 1));
    }
    trials
}
