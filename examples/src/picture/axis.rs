//! Axes: where values stand, and which of them have a tick and a name.

use std::ops::Range;

use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};

/// One axis of a panel.
#[derive(Clone, Copy, Debug)]
pub struct Axis<'a> {
    /// What it shows, with its unit.
    pub(super) label: &'a str,
    scale: Scale,
    shown: Option<(f64, f64)>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Scale {
    Linear,
    Logarithmic {
        /// What stands for 0 and all below it.
        floor: Option<f64>,
    },
}

/// An axis of even divisions.
pub fn linear(label: &str) -> Axis<'_> {
    Axis { label, scale: Scale::Linear, shown: None }
}

/// An axis of even decades. Values that are not positive are left out, unless there is a
/// [floor](Axis::with_floor).
pub fn logarithmic(label: &str) -> Axis<'_> {
    Axis { label, scale: Scale::Logarithmic { floor: None }, shown: None }
}

impl Axis<'_> {
    /// Values at or below `floor`, a power of ten, are drawn there, and its tick says so: "≤ 10⁻¹⁸".
    #[must_use]
    pub fn with_floor(mut self, floor: f64) -> Self {
        self.scale = Scale::Logarithmic { floor: Some(floor) };
        self
    }

    /// From `low` to `high`, whatever the values.
    #[must_use]
    pub fn from_to(mut self, low: f64, high: f64) -> Self {
        self.shown = Some((low, high));
        self
    }

    /// Where a value stands: itself, or its decadic logarithm.
    pub(super) fn place(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => value,
            Scale::Logarithmic { floor: Some(floor) } => value.max(floor).log10(),
            Scale::Logarithmic { floor: None } if value > 0.0 => value.log10(),
            Scale::Logarithmic { floor: None } => f64::NAN,
        }
    }

    /// The range of `values`, wider by the share `margin` at both ends, with at most `most` ticks.
    pub(super) fn ticks(&self, values: impl Iterator<Item = f64>, margin: f64, most: usize) -> Ticks {
        let range = match self.shown {
            Some((low, high)) => self.place(low)..self.place(high),
            None => extent(values.map(|value| self.place(value)), margin),
        };
        Ticks { points: Vec::new(), range, scale: self.scale, most, step: 1.0 }.divided()
    }
}

/// The part of an axis that is shown, with its ticks.
#[derive(Clone, Debug)]
pub(super) struct Ticks {
    range: Range<f64>,
    points: Vec<f64>,
    scale: Scale,
    most: usize,
    /// From tick to tick.
    step: f64,
}

impl Ticks {
    pub fn width(&self) -> f64 {
        self.range.end - self.range.start
    }

    /// Ticks at multiples of 1, 2 or 5 times a power of ten, of whole decades where the axis has some.
    fn divided(mut self) -> Self {
        let width = self.width();
        let is_logarithmic = self.scale != Scale::Linear;
        let smallest = if is_logarithmic { 1.0 } else { 0.0 };
        let rough = f64::max(width / self.most as f64, smallest);
        let power = 10.0_f64.powf(rough.log10().floor());
        // Thousands, too, are round as powers of ten.
        let factors: &[f64] = if is_logarithmic { &[1.0, 2.0, 3.0, 5.0] } else { &[1.0, 2.0, 5.0] };
        let step = factors.iter().map(|factor| factor * power).find(|step| *step >= rough * (1.0 - 1e-9));
        self.step = step.unwrap_or(10.0 * power);
        let whole = |value: f64| value / self.step;
        let (first, last) = (whole(self.range.start).ceil() as i64, whole(self.range.end).floor() as i64);
        self.points = (first..=last).map(|k| k as f64 * self.step).collect();
        if is_logarithmic && self.points.len() < 3 {
            // Within two decades: their parts too.
            let decades = self.range.start.floor() as i64..=self.range.end.floor() as i64;
            let parts =
                decades.flat_map(|decade| [1.0, 2.0, 5.0].map(|part: f64| decade as f64 + part.log10()));
            self.points = parts.filter(|place| self.range.contains(place)).collect();
        }
        if let Scale::Logarithmic { floor: Some(floor) } = self.scale {
            let floor = floor.log10();
            self.points.retain(|place| *place >= floor + 0.7 * self.step);
            self.points.insert(0, floor);
        }
        self
    }

    /// The name of the tick at `place`.
    pub fn name(&self, place: f64) -> String {
        match self.scale {
            Scale::Linear => number(place, self.step),
            Scale::Logarithmic { floor } => {
                let power = power_of_ten(place.floor() as i32);
                let part = 10.0_f64.powf(place - place.floor());
                let power = match (part.round() as i32, place.floor() as i32) {
                    (1, _) => power_of_ten(place.round() as i32),
                    (part, 0) => part.to_string(),
                    (part, _) => format!("{part}·{power}"),
                };
                let is_floor = floor.is_some_and(|floor| (floor.log10() - place).abs() < 1e-9);
                if is_floor { format!("≤ {power}") } else { power }
            }
        }
    }
}

/// Widens one of two ranges so that a unit is as long on both; the first axis is `shape` times as long as the
/// second.
pub(super) fn equalise(x: &mut Ticks, y: &mut Ticks, shape: f64) {
    let widen = |ticks: &mut Ticks, width: f64| {
        let by = (width - ticks.width()) / 2.0;
        ticks.range = ticks.range.start - by..ticks.range.end + by;
    };
    if x.width() < y.width() * shape {
        widen(x, y.width() * shape)
    } else {
        widen(y, x.width() / shape)
    }
    *x = x.clone().divided();
    *y = y.clone().divided();
}

impl Ranged for Ticks {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (from, to): (i32, i32)) -> i32 {
        let share = (value - self.range.start) / self.width();
        from + (share * f64::from(to - from)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _hint: Hint) -> Vec<f64> {
        self.points.clone()
    }

    fn range(&self) -> Range<f64> {
        self.range.clone()
    }
}

/// From the smallest to the largest finite value, wider by the share `margin` of that at both ends.
fn extent(values: impl Iterator<Item = f64>, margin: f64) -> Range<f64> {
    let (low, high) = values
        .filter(|value| value.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)));
    if low < high {
        let margin = margin * (high - low);
        low - margin..high + margin
    } else {
        // Nothing to show, or one value: any range around it.
        let middle = if low == high { low } else { 0.0 };
        middle - 1.0..middle + 1.0
    }
}

/// A number with as many places as ticks `step` apart need; very large or small ones by a power of ten.
fn number(value: f64, step: f64) -> String {
    if value.abs() < 1e-9 * step {
        return "0".to_owned();
    }
    let text = if !(1e-4..1e5).contains(&step) {
        let exponent = value.abs().log10().floor() as i32;
        let places = (f64::from(exponent) - step.log10().floor()).max(0.0) as usize;
        format!("{:.places$}·{}", value / 10.0_f64.powi(exponent), power_of_ten(exponent))
    } else {
        let places = (-step.log10().floor()).max(0.0) as usize;
        let text = format!("{value:.places$}");
        if places > 0 { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
    };
    text.replace('-', "−")
}

/// 10⁻⁶ for −6.
fn power_of_ten(exponent: i32) -> String {
    let raised = |character| match character {
        '-' => '⁻',
        digit => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][digit.to_digit(10).unwrap_or(0) as usize],
    };
    match exponent {
        0 => "1".to_owned(),
        1 => "10".to_owned(),
        exponent => format!("10{}", exponent.to_string().chars().map(raised).collect::<String>()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_places_of_their_step_and_a_minus() {
        assert_eq!(number(0.1 + 0.2, 0.1), "0.3");
        assert_eq!(number(-0.05, 0.05), "−0.05");
        assert_eq!([number(-0.0, 1.0), number(2000.0, 500.0), number(5000.0, 1000.0)], ["0", "2000", "5000"]);
        assert_eq!([number(-2e-5, 1e-5), number(1.5e-9, 5e-10)], ["−2·10⁻⁵", "1.5·10⁻⁹"]);
    }

    #[test]
    fn decades_are_powers_of_ten_and_a_floor_says_that_it_is_one() {
        let ticks = logarithmic("").with_floor(1e-18).ticks([0.0, 100.0].into_iter(), 0.0, 12);
        let names: Vec<_> = ticks.points.iter().map(|place| ticks.name(*place)).collect();
        assert_eq!(names.first().map(String::as_str), Some("≤ 10⁻¹⁸"));
        assert_eq!(names.last().map(String::as_str), Some("10²"));
        assert_eq!([power_of_ten(-12), power_of_ten(0), power_of_ten(1)], ["10⁻¹²", "1", "10"]);
        // Less than two decades.
        let ticks = logarithmic("").ticks([1.5, 30.0].into_iter(), 0.0, 8);
        let names: Vec<_> = ticks.points.iter().map(|place| ticks.name(*place)).collect();
        assert_eq!(names, ["2", "5", "10", "2·10"]);
    }

    #[test]
    fn an_extent_without_width_is_widened() {
        assert_eq!(extent([1.0, 3.0, f64::NAN].into_iter(), 0.5), 0.0..4.0);
        assert_eq!(extent([2.0, 2.0].into_iter(), 0.5), 1.0..3.0);
        assert_eq!(extent([].into_iter(), 0.5), -1.0..1.0);
    }

    #[test]
    fn equal_scales_widen_the_shorter_axis() {
        let ticks = |high| linear("").ticks([0.0, high].into_iter(), 0.0, 8);
        let (mut x, mut y) = (ticks(1.0), ticks(2.0));
        equalise(&mut x, &mut y, 1.5);
        assert_eq!((x.range.clone(), y.range.clone()), (-1.0..2.0, 0.0..2.0));
    }
}
