//! Another study of the same type in a folder.

use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use crate::study::{Call, OF_PART, PLAIN, folder_of, kind};
use crate::trials::Trials;

/// Studies that differ in starts, in fields of all members or of one, with and without a column, and in the
/// method. Control: a field of R of one member, in no column, which is not looked at, as the documentation
/// says.
pub fn are_there(tries: u32) -> Trials {
    let mut random = StdRng::seed_from_u64(1);
    let mut trials = Trials::default();
    // A part so large that every second member alone is stepped once.
    let large = Call { of_part: 128, members: 128, column: false, ..PLAIN };
    let studies = [Call { column: true, ..PLAIN }, Call { column: false, ..PLAIN }, large];
    let studies = studies.map(|study| (study, study.files()));
    for k in 0..tries {
        let (first, files) = &studies[k as usize % 3];
        let some = 10_f64.powf(random.random_range(-6.0..0.0));
        let any = random.random_range(0..first.members);
        let between = 2 * random.random_range(0..64) + 1;
        let second = match (k / 3) % 6 {
            0 => Call { p: -0.5, ..*first },
            1 => Call { r: some, ..*first },
            2 => Call { p: 0.5 + some, ..*first },
            3 => Call { odd: Some((any, [some, 0.0])), ..*first },
            4 if first.of_part < 64 => Call { odd: Some((any, [0.0, some])), ..*first },
            4 => Call { odd: Some((between - 1, [0.0, some])), ..*first },
            _ => Call { steps: first.steps + random.random_range(1..9), ..*first },
        };
        let result = second.write(&folder_of(files));
        trials.hear(result.as_ref().map_or_else(kind, |_| "ok"));
        trials.add(result.ok().map(|written| format!("{second:?} found: {written}")));

        let second = Call { odd: Some((between, [0.0, some])), ..large };
        trials.add_control(second.write(&folder_of(&studies[2].1)).is_ok_and(|written| written.found == 1));
    }
    trials
}

/// Studies of equal metadata that differ in starts or fields of all members, of which the second has other
/// members. Control: a call over the members of both sees that they are of two.
pub fn goes_on(tries: u32) -> Trials {
    let mut random = StdRng::seed_from_u64(8);
    let mut trials = Trials::default();
    let halves = [Call { members: 3 * OF_PART, ..PLAIN }, Call { from: 3 * OF_PART, ..PLAIN }];
    let whole = PLAIN.files();
    let files = halves.map(|half| half.files());
    for k in 0..tries {
        let [there, here] = if k % 2 == 0 { [0, 1] } else { [1, 0] };
        let some = 10_f64.powf(random.random_range(-6.0..0.0));
        let second = match (k / 2) % 3 {
            0 => Call { p: -0.5, ..halves[here] },
            1 => Call { r: some, ..halves[here] },
            _ => Call { p: 0.5 + some, ..halves[here] },
        };
        let folder = folder_of(&files[there]);
        let result = second.write(&folder);
        trials.hear(result.as_ref().map_or_else(kind, |_| "ok"));
        trials.add(result.ok().map(|written| format!("{second:?} went on: {written}")));
        // The study itself goes on.
        let own = halves[here].write(&folder);
        let is_whole = own.is_ok() && crate::study::files(&folder) == whole;
        trials.add((!is_whole).then(|| format!("{:?} did not go on", halves[here])));

        let mut both = files[there].clone();
        both.extend(second.files());
        trials.add_control(PLAIN.write(&folder_of(&both)).is_err());
    }
    trials
}
