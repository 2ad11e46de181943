//! Reference motions: the modified midpoint rule, extrapolated (W. B. Gragg 1965; R. Bulirsch and J. Stoer
//! 1966), in numbers of twice the digits.

use double_double::DoubleDouble;

/// The rows of the extrapolation table: order 2·ROWS.
const ROWS: usize = 10;

/// The local error, in units of the state.
const LOCAL: f64 = 1e-19;

/// A state and its rate: 2N numbers as two arrays.
pub type Phase<const N: usize> = [[DoubleDouble; N]; 2];

/// q̈ from (q, q̇, t).
pub type Acceleration<'a, const N: usize> =
    &'a dyn Fn([DoubleDouble; N], [DoubleDouble; N], DoubleDouble) -> [DoubleDouble; N];

fn plus<const N: usize>(a: Phase<N>, b: Phase<N>, factor: DoubleDouble) -> Phase<N> {
    std::array::from_fn(|i| std::array::from_fn(|j| a[i][j] + b[i][j] * factor))
}

/// The state after `step` in `parts`, by Gragg's rule.
fn midpoint<const N: usize>(
    f: &dyn Fn(Phase<N>, DoubleDouble) -> Phase<N>,
    y: Phase<N>,
    t: DoubleDouble,
    step: DoubleDouble,
    parts: usize,
) -> Phase<N> {
    let h = step / DoubleDouble::from(parts as f64);
    let (mut before, mut here) = (y, plus(y, f(y, t), h));
    for k in 1..parts {
        let rate = f(here, t + h * DoubleDouble::from(k as f64));
        (before, here) = (here, plus(before, rate, h + h));
    }
    let rate = f(here, t + step);
    let both: Phase<N> = plus(here, before, DoubleDouble::from(1.0));
    let both = plus(both, rate, h);
    both.map(|row| row.map(|x| x * DoubleDouble::from(0.5)))
}

/// (q, q̇) at `times`, ascending, of the motion from `start` at time 0; no step is longer than `longest`.
///
/// # Panics
/// If steps become too short.
pub fn extrapolated<const N: usize>(
    acceleration: Acceleration<'_, N>,
    start: Phase<N>,
    times: &[f64],
    longest: f64,
) -> Vec<Phase<N>> {
    let f = |[q, v]: Phase<N>, t: DoubleDouble| [v, acceleration(q, v, t)];
    let (mut y, mut t, mut h) = (start, DoubleDouble::from(0.0), longest.min(0.1));
    let mut states = Vec::with_capacity(times.len());
    for &end in times {
        loop {
            let left = (DoubleDouble::from(end) - t).high;
            if left <= 0.0 {
                break;
            }
            assert!(h > 1e-9, "the reference gets stuck at {}", t.high);
            let is_last = left <= h * 1.0001;
            let step = if is_last { DoubleDouble::from(end) - t } else { DoubleDouble::from(h) };
            let mut rows: Vec<Phase<N>> = Vec::with_capacity(ROWS);
            let mut error = f64::INFINITY;
            for k in 0..ROWS {
                let parts = 2 * (k + 1);
                let mut row = vec![midpoint(&f, y, t, step, parts)];
                for j in 1..=k {
                    let ratio = (parts as f64) / (2 * (k - j + 1)) as f64;
                    let factor = DoubleDouble::from(1.0)
                        / (DoubleDouble::from(ratio) * DoubleDouble::from(ratio) - DoubleDouble::from(1.0));
                    let difference = plus(row[j - 1], rows[j - 1], DoubleDouble::from(-1.0));
                    row.push(plus(row[j - 1], difference, factor));
                }
                if k > 0 {
                    let difference = plus(row[k], row[k - 1], DoubleDouble::from(-1.0));
                    let size = |phase: &Phase<N>| {
                        phase.iter().flatten().fold(0.0_f64, |size, x| size.max(x.high.abs()))
                    };
                    error = size(&difference) / size(&y).max(1e-3);
                }
                rows = row;
            }
            let factor = (0.8 * (LOCAL / error).powf(1.0 / (2 * ROWS - 1) as f64)).clamp(0.1, 2.0);
            if error <= LOCAL * 30.0 {
                y = rows[ROWS - 1];
                t = if is_last { DoubleDouble::from(end) } else { t + step };
            }
            if !is_last || error > LOCAL * 30.0 {
                h = (step.high * factor).min(longest);
            }
        }
        states.push(y);
    }
    states
}
