//! The time that a method needs to reach an error, from runs at several settings.

use crate::study::Record;

/// A run: what it cost and how wrong it was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    pub seconds: f64,
    pub error: f64,
}

/// The seconds at which a method's error passes below `error`, between its runs as log time over log error.
///
/// A run counts only if the next dearer one is below as well: one that is right by accident, where an error changes its sign,
/// reaches nothing. `None` if no run counts.
pub fn time_to_reach(error: f64, points: impl IntoIterator<Item = Point>) -> Option<f64> {
    let mut points: Vec<Point> = points.into_iter().collect();
    points.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
    let first = (0..points.len())
        .find(|&i| points[i].error <= error && points.get(i + 1).is_none_or(|next| next.error <= error))?;
    let within = points[first];
    let Some(without) = points[..first].last().filter(|before| before.error > error) else {
        return Some(within.seconds);
    };
    let share = (error / without.error).ln() / (within.error / without.error).ln();
    Some(without.seconds * (within.seconds / without.seconds).powf(share))
}

/// Errors and times of the runs of one method on one scene.
pub fn points<'a>(
    records: &'a [Record],
    scene: &'a str,
    method: &'a str,
    error: impl Fn(&Record) -> f64 + 'a,
) -> impl Iterator<Item = Point> + 'a {
    records
        .iter()
        .filter(move |record| record.scene == scene && record.method == method)
        .map(move |record| Point { seconds: record.seconds, error: error(record) })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(values: &[(f64, f64)]) -> impl Iterator<Item = Point> {
        values.iter().map(|&(seconds, error)| Point { seconds, error })
    }

    #[test]
    fn a_power_law_is_found_between_its_points() {
        // error = time⁻⁴
        let runs: Vec<_> = [1.0_f64, 2.0, 4.0, 8.0].map(|time| (time, time.powi(-4))).to_vec();
        let time = time_to_reach(1e-2, points(&runs)).unwrap();
        assert!((time - 1e-2_f64.powf(-0.25)).abs() < 1e-12, "{time}");
        assert_eq!(time_to_reach(1e-9, points(&runs)), None);
        assert_eq!(time_to_reach(2.0, points(&runs)), Some(1.0));
    }

    #[test]
    fn a_run_that_is_right_by_accident_does_not_count() {
        let runs = [(1.0, 1e-1), (2.0, 1e-9), (4.0, 1e-3), (8.0, 1e-5), (16.0, 1e-7)];
        assert!(time_to_reach(1e-6, points(&runs)).unwrap() > 8.0);
        // Positive control: without the run that shows it to be an accident, it counts.
        assert!(time_to_reach(1e-6, points(&runs[..2])).unwrap() < 2.0);
    }

    #[test]
    fn an_error_that_is_no_number_is_not_below() {
        assert_eq!(time_to_reach(1.0, points(&[(1.0, f64::NAN)])), None);
    }
}
