//! The time that a method needs to reach an error, from runs at several settings.

use crate::study::Record;

/// A run: what it cost and how wrong it was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    pub seconds: f64,
    pub error: f64,
}

/// The seconds at which a method's error passes below `error`, given its runs from the coarsest to the
/// finest; between two, as log time over log error.
///
/// A run counts only if the next finer one is below as well: one that is right by accident, where an error
/// changes its sign, reaches nothing. The coarsest runs of a method that iterates may cost more than finer
/// ones. `None` if no run counts.
pub fn time_to_reach(error: f64, points: impl IntoIterator<Item = Point>) -> Option<f64> {
    let points: Vec<Point> = points.into_iter().collect();
    let is_below = |point: &Point| point.error <= error;
    let times = points.iter().enumerate().filter_map(|(i, within)| {
        if !is_below(within) || points.get(i + 1).is_some_and(|next| !is_below(next)) {
            return None;
        }
        let before = i.checked_sub(1).map(|i| points[i]);
        let Some(without) = before.filter(|before| before.error > error && before.seconds < within.seconds)
        else {
            return Some(within.seconds);
        };
        let share = (error / without.error).ln() / (within.error / without.error).ln();
        Some(without.seconds * (within.seconds / without.seconds).powf(share))
    });
    times.min_by(f64::total_cmp)
}

/// Runs from the coarsest to the finest, without those that a finer one beats in cost and in error.
pub fn unbeaten_by_finer(points: impl IntoIterator<Item = Point>) -> Vec<Point> {
    let points: Vec<Point> = points.into_iter().collect();
    let beats = |finer: &Point, point: &Point| finer.seconds <= point.seconds && finer.error <= point.error;
    let unbeaten = points
        .iter()
        .enumerate()
        .filter(|(i, point)| !points[i + 1..].iter().any(|finer| beats(finer, point)));
    unbeaten.map(|(_, point)| *point).collect()
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
    fn a_coarse_run_that_costs_more_than_finer_ones_hides_none_of_them() {
        let runs = [(9.0, 1e-1), (2.0, 1e-2), (4.0, 1e-6), (8.0, 1e-9), (16.0, 1e-12)];
        assert_eq!(time_to_reach(1e-6, points(&runs)), Some(4.0));
        assert_eq!(time_to_reach(0.2, points(&runs)), Some(2.0));
        assert_eq!(time_to_reach(1e-12, points(&runs)), Some(16.0));
    }

    #[test]
    fn runs_that_a_finer_one_beats_are_left_out_and_no_others() {
        let runs = [(9.0, 1e-1), (2.0, 1e-2), (4.0, 1e-6), (8.0, 1e-5), (16.0, f64::NAN)];
        let kept: Vec<f64> = unbeaten_by_finer(points(&runs)).iter().map(|point| point.seconds).collect();
        assert_eq!(kept, [2.0, 4.0, 8.0, 16.0]);
    }

    #[test]
    fn an_error_that_is_no_number_is_not_below() {
        assert_eq!(time_to_reach(1.0, points(&[(1.0, f64::NAN)])), None);
    }
}
