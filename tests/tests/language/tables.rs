//! Tables: values and derivatives against SciPy's and against the equations that define them, points that are
//! refused, ends, and NaN.

mod reference;

use dalembert::system::{Curve, Interpolation, Table, TableError, TableSlice};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use reference::CASES;

/// A curve of SciPy's at six places.
struct Case {
    of: Interpolation,
    x: &'static [f64],
    y: &'static [f64],
    seen: [[f64; 5]; 6],
}

/// The table through the points, in memory that stays.
fn table(of: Interpolation, x: &[f64], y: &[f64]) -> Result<TableSlice<'static>, TableError> {
    TableSlice::through(of, x.to_vec().leak(), y, vec![[0.0; 4]; x.len()].leak())
}

const ALL: [Interpolation; 4] = Interpolation::ALL;

/// The largest difference from SciPy's, over the largest derivative of its order, or what rounding a y makes
/// of it.
fn from_scipy(case: &Case, factor: f64) -> f64 {
    let y: Vec<f64> = case.y.iter().map(|y| y * factor).collect();
    let table = table(case.of, case.x, &y).expect("increasing x");
    let differs = |order: usize| {
        let closest = case.x.windows(2).map(|two| two[1] - two[0]).fold(f64::INFINITY, f64::min);
        let size =
            case.seen.iter().map(|row| row[order + 1].abs()).fold(closest.powi(-(order as i32)), f64::max);
        let differences =
            case.seen.iter().map(|row| (table.derivatives(row[0])[order] - row[order + 1]).abs() / size);
        differences.fold(0.0, f64::max)
    };
    (0..4).map(differs).fold(0.0, f64::max)
}

#[test]
fn values_and_derivatives_are_scipy_s() {
    for case in &CASES {
        let error = from_scipy(case, 1.0);
        assert!(error < 1e-13, "{} of {} points: {error:e}", case.of, case.x.len());
        assert!(from_scipy(case, 1.0 + 1e-12) > 1e-13, "a difference is not seen");
    }
}

/// Random points; every x above the one before by 1/50 to 2.
fn points(random: &mut StdRng, count: usize) -> [Vec<f64>; 2] {
    let mut x = vec![random.random_range(-3.0..3.0)];
    while x.len() < count {
        x.push(x[x.len() - 1] + random.random_range(0.02..2.0));
    }
    [x, (0..count).map(|_| random.random_range(-2.0..2.0)).collect()]
}

/// The jumps of f, f′, f″ and f‴, over their sizes, at all knots but the first; with the last if the first
/// follows on it.
fn jumps(table: &TableSlice<'_>, is_turn: bool) -> Vec<[f64; 4]> {
    let knots = table.knots();
    let end = knots.len() - usize::from(!is_turn);
    let jump = |(&knot, &before): (&f64, &f64)| {
        // The cubic before, by its derivatives in the middle, carried to the knot.
        let middle = 0.5 * (before + knot);
        let (s, [f, f1, f2, f3]) = (knot - middle, table.derivatives(middle));
        let left =
            [f + s * (f1 + s * (f2 / 2.0 + s * f3 / 6.0)), f1 + s * (f2 + s * f3 / 2.0), f2 + s * f3, f3];
        let right = table.derivatives(knot);
        [0, 1, 2, 3]
            .map(|order| (left[order] - right[order]) / (1.0 + right[order].abs() + left[order].abs()))
    };
    knots[1..end].iter().zip(knots).map(jump).collect()
}

/// The spline and the periodic one are the only curves of cubics with these properties; the others have what
/// is said of them.
#[test]
fn pieces_meet_as_smoothly_as_is_said_through_all_points() {
    let mut random = StdRng::seed_from_u64(7);
    let cases = if cfg!(debug_assertions) { 200 } else { 4000 };
    let mut rough = [0.0_f64; 4];
    for case in 0..cases {
        let of = ALL[case % 4];
        let count = random.random_range(3..20);
        let [x, mut y] = points(&mut random, count);
        if of == Interpolation::Periodic {
            y[count - 1] = y[0];
        }
        let table = table(of, &x, &y).expect("good points");
        for (&x, &y) in x.iter().zip(&y) {
            let seen = table.at(x);
            // A periodic table sees its last knot as its first, a rounding off.
            let slack = if of == Interpolation::Periodic { 1e-12 } else { 0.0 };
            assert!((seen - y).abs() <= slack, "{of}: {seen} at a point of {y}");
        }
        let jumps = jumps(&table, of == Interpolation::Periodic);
        let smooth = match of {
            Interpolation::Linear => 1,
            Interpolation::Monotone => 2,
            _ => 3,
        };
        for jump in &jumps {
            for (order, jump) in jump.iter().enumerate().take(smooth) {
                assert!(jump.abs() < 1e-9, "{of}: order {order} jumps by {jump}");
            }
        }
        let next = jumps.iter().map(|jump| jump[smooth].abs()).fold(0.0, f64::max);
        rough[case % 4] = rough[case % 4].max(next);
        if of == Interpolation::Spline && count > 3 {
            let (first, last) = (jumps[0][3], jumps[count - 3][3]);
            assert!(first.abs() < 1e-8 && last.abs() < 1e-8, "a knot at the end: {first} {last}");
        }
        if of == Interpolation::Periodic {
            let (x, period) = (0.3 * x[0] + 0.7 * x[1], x[count - 1] - x[0]);
            let [here, there] = [x, x - 3.0 * period].map(|x| table.derivatives(x));
            for order in 0..3 {
                assert!((here[order] - there[order]).abs() < 1e-9 * (1.0 + here[order].abs()));
            }
        }
    }
    // A jump would be seen.
    assert!(rough.iter().all(|&jump| jump > 0.1), "{rough:?}");
}

/// One wrong number in good points, of each kind at any place, is the error that says so; good points make a
/// table.
#[test]
fn what_is_wrong_with_points_is_said_at_its_place() {
    let mut random = StdRng::seed_from_u64(8);
    for case in 0..400 {
        let of = ALL[case % 4];
        let count = random.random_range(3..12);
        let [x, mut y] = points(&mut random, count);
        if of == Interpolation::Periodic {
            y[count - 1] = y[0];
        }
        assert!(table(of, &x, &y).is_ok());
        let index = random.random_range(1..count - 1);
        let with = |mut numbers: Vec<f64>, number: f64| {
            numbers[index] = number;
            numbers
        };
        for wrong in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let error = table(of, &with(x.clone(), wrong), &y).unwrap_err();
            assert!(
                matches!(error, TableError::KnotNotFinite { of: o, index: i } if (o, i) == (of, index)),
                "{error}"
            );
            let error = table(of, &x, &with(y.clone(), wrong)).unwrap_err();
            assert!(
                matches!(error, TableError::ValueNotFinite { of: o, index: i } if (o, i) == (of, index)),
                "{error}"
            );
        }
        for (number, at) in [(x[index - 1], index), (x[index - 1] - 1.0, index), (x[index + 1], index + 1)] {
            let error = table(of, &with(x.clone(), number), &y).unwrap_err();
            assert!(matches!(error, TableError::NotIncreasing { index: i, .. } if i == at), "{error}");
            let text = error.to_string();
            assert!(text.contains(&format!("`Table::{of}`: x[{at}] = ")), "{text}");
        }
        let error = table(of, &x, &y[1..]).unwrap_err();
        assert!(matches!(error, TableError::Lengths { x, y, .. } if (x, y) == (count, count - 1)), "{error}");
    }
}

#[test]
fn few_points_open_turns_and_steep_ones_are_refused() {
    for of in ALL {
        let fewest = if of == Interpolation::Periodic { 3 } else { 2 };
        for count in 0..4 {
            let x: Vec<f64> = (0..count).map(f64::from).collect();
            let made = table(of, &x, &vec![0.5; x.len()]);
            assert_eq!(made.is_ok(), x.len() >= fewest, "{made:?}");
        }
    }
    let open = Table::periodic([0.0, 1.0, 2.0], [0.0, 1.0, 0.5]);
    assert_eq!(open, Err(TableError::NotPeriodic { first: 0.0, last: 0.5 }));
    let steep = Table::linear([0.0, 1.0, 1.0 + f64::EPSILON], [0.0, 1e300, 0.0]);
    assert_eq!(steep, Err(TableError::TooSteep { of: Interpolation::Linear, index: 1 }));
    let wide = Table::linear([-1e308, 0.0, 1e308], [0.0, 1.0, 2.0]);
    assert_eq!(wide, Err(TableError::KnotNotFinite { of: Interpolation::Linear, index: 2 }));
}

/// A table of points that rise rises, also between them: by less than rounding it may fall.
#[test]
fn a_monotone_table_is_monotone_and_a_spline_need_not_be() {
    let mut random = StdRng::seed_from_u64(9);
    let fall = |of, x: &[f64], y: &[f64]| {
        let table = table(of, x, y).expect("good points");
        let (start, width) = (x[0], x[x.len() - 1] - x[0]);
        let values: Vec<f64> = (0..=500).map(|i| table.at(start + width * f64::from(i) / 500.0)).collect();
        values.windows(2).map(|two| two[0] - two[1]).fold(f64::NEG_INFINITY, f64::max)
    };
    let mut of_splines = f64::NEG_INFINITY;
    for _ in 0..100 {
        let count = random.random_range(2..12);
        let [x, mut y] = points(&mut random, count);
        y.sort_by(f64::total_cmp);
        let size = y.iter().fold(0.0_f64, |size, y| size.max(y.abs()));
        assert!(fall(Interpolation::Monotone, &x, &y) <= 8.0 * f64::EPSILON * size);
        of_splines = of_splines.max(fall(Interpolation::Spline, &x, &y));
    }
    assert!(of_splines > 1e-3, "{of_splines:e}");
}

/// Values are those at the ends, or go on by the slope there; the derivatives are those of what is seen.
#[test]
fn beyond_its_ends_a_table_holds_or_goes_on() {
    let held = Table::spline([0.0, 1.0, 2.0, 4.0], [1.0, 3.0, 2.0, -5.0]).unwrap();
    let straight = held.straight_beyond();
    for (end, value, away) in [(0.0, 1.0, -1.0), (4.0, -5.0, 1.0)] {
        let slope = held.derivatives(end)[1];
        assert!(slope.abs() > 0.5, "{slope}");
        for distance in [1e-9, 0.5, 1e3] {
            let x = end + away * distance;
            assert_eq!(held.derivatives(x), [value, 0.0, 0.0, 0.0]);
            let [f, f1, f2, f3] = straight.derivatives(x);
            assert!((f - value - slope * (x - end)).abs() <= 1e-15 * f.abs(), "{f}");
            assert_eq!([f1, f2, f3], [slope, 0.0, 0.0]);
        }
        let infinite = away * f64::INFINITY;
        assert_eq!([held.at(infinite), straight.at(infinite)], [value, slope * infinite]);
    }
}

#[test]
fn nan_gives_nan() {
    let points = ([0.0, 1.0, 2.0, 4.0], [1.0, 3.0, 2.0, 1.0]);
    let all = [
        Table::linear(points.0, points.1),
        Table::spline(points.0, points.1),
        Table::monotone(points.0, points.1),
        Table::periodic(points.0, points.1),
        Table::linear(points.0, points.1).map(Table::straight_beyond),
    ];
    for table in all {
        let [f, f1, ..] = table.unwrap().derivatives(f64::NAN);
        assert!(f.is_nan() && f1.is_nan());
    }
}

/// In single precision the same points are the same curve, to its rounding.
#[test]
fn tables_of_single_precision_are_those_of_double() {
    let (x, y) = ([0.0, 0.5, 1.25, 2.0, 3.5], [0.5, 1.0, 0.25, -1.0, 0.5]);
    let all = [Table::linear(x, y), Table::spline(x, y), Table::monotone(x, y), Table::periodic(x, y)];
    for wide in all.map(Result::unwrap) {
        let narrow: Table<5, f32> = wide.single().unwrap();
        assert_eq!(narrow.knots().map(f64::from), x);
        for i in -10..50_i8 {
            let x = f64::from(i) / 8.0;
            let (expected, seen) = (wide.derivatives(x), narrow.derivatives(x as f32));
            for (expected, seen) in expected.iter().zip(seen) {
                assert!((expected - f64::from(seen)).abs() < 2e-5, "{expected} {seen} at {x}");
            }
        }
    }
    let close = Table::linear([1.0, 1.0 + 1e-9], [0.0, 1.0]).unwrap().single();
    assert_eq!(close, Err(TableError::SinglePrecision { index: 1 }));
    let large = Table::linear([0.0, 1.0], [0.0, 1e39]).unwrap().single();
    assert_eq!(large, Err(TableError::SinglePrecision { index: 0 }));
}

/// Points are the lines of the table through them, and NaN everywhere where they do not increase.
#[test]
fn points_are_a_linear_table() {
    let mut random = StdRng::seed_from_u64(10);
    for _ in 0..50 {
        let [x, y] = points(&mut random, 6);
        let table = table(Interpolation::Linear, &x, &y).unwrap();
        let array: [[f64; 2]; 6] = std::array::from_fn(|i| [x[i], y[i]]);
        for _ in 0..20 {
            let place = random.random_range(x[0] - 1.0..x[5] + 1.0);
            let (lines, of_points) = (table.derivatives(place), array.derivatives(place));
            for (a, b) in lines.iter().zip(of_points) {
                assert!((a - b).abs() <= 1e-14 * (1.0 + b.abs()), "{a} {b} at {place}");
            }
        }
        assert!(array.at(f64::NAN).is_nan());
    }
    let falling = [[0.0, 1.0], [2.0, 2.0], [1.0, 3.0], [4.0, 5.0]];
    assert!((-1..60).all(|i| falling.at(0.1 * f64::from(i)).is_nan()));
    let missing = [[0.0, 1.0], [f64::NAN, 2.0], [1.0, 3.0]];
    assert!((-1..60).all(|i| missing.at(0.1 * f64::from(i)).is_nan()));
}
