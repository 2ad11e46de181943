//! The pictures of the scenes: panels of curves in one style, as SVG.
//!
//! Text stays text in the file, in whatever sans-serif font the viewer has: no font is needed to draw it.

use std::env;
use std::ops::Range;
use std::path::{Path, PathBuf};

use anyhow::Result;
use plotters::backend::SVGBackend;
use plotters::chart::{ChartBuilder, ChartContext, SeriesLabelPosition};
use plotters::coord::Shift;
use plotters::coord::cartesian::Cartesian2d;
use plotters::coord::types::RangedCoordf64;
use plotters::drawing::{DrawingArea, IntoDrawingArea};
use plotters::element::{Circle, Drawable, EmptyElement, PathElement, PointCollection, TriangleMarker};
use plotters::series::LineSeries;
pub use plotters::style::RGBColor;
use plotters::style::{BLACK, Color, TRANSPARENT, WHITE};

use crate::results;

/// Colours that readers with any colour vision tell apart (Okabe and Ito, 2008).
pub mod colour {
    use plotters::style::RGBColor;

    /// Exact solutions and references.
    pub const REFERENCE: RGBColor = RGBColor(0, 0, 0);
    /// The variational integrator.
    pub const VARIATIONAL: RGBColor = RGBColor(0, 114, 178);
    /// The classical Runge–Kutta method.
    pub const RUNGE_KUTTA: RGBColor = RGBColor(213, 94, 0);
    /// Explicit Euler.
    pub const EULER: RGBColor = RGBColor(0, 158, 115);
}

/// How a curve is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// A line of this many pixels.
    Line(u32),
    /// A dot of one pixel at each point.
    Dot,
    /// A disc at each point.
    Disc,
    /// An open circle at each point.
    Circle,
    /// A triangle at each point.
    Triangle,
}

/// Points drawn in one way.
#[derive(Clone, Debug)]
pub struct Curve<'a> {
    /// Its line in the legend; empty, it has none.
    pub label: &'a str,
    /// One of [`colour`].
    pub colour: RGBColor,
    /// Line or points.
    pub mark: Mark,
    /// The points.
    pub points: Vec<(f64, f64)>,
}

/// A pair of axes that show all of the curves, the first at the bottom.
#[derive(Clone, Debug)]
pub struct Panel<'a> {
    /// The heading.
    pub title: &'a str,
    /// The label of the horizontal axis.
    pub x: &'a str,
    /// The label of the vertical axis.
    pub y: &'a str,
    /// Where the legend covers nothing.
    pub legend: Corner,
    /// What is shown.
    pub curves: Vec<Curve<'a>>,
}

/// A corner of a panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Corner {
    /// Top left.
    UpperLeft,
    /// Top right.
    UpperRight,
    /// Bottom left.
    LowerLeft,
    /// Bottom right.
    LowerRight,
}

type Chart<'a> = ChartContext<'a, SVGBackend<'a>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

const FONT: &str = "sans-serif";

/// Units of the drawing to a pixel: plotters rounds coordinates to whole units, which shows as steps in thin lines.
const PIXEL: i32 = 8;

/// Writes the picture to the path that the command line gives, or else to `target/<name>.svg`, and returns the path.
///
/// # Errors
/// The file cannot be written; then the picture is where the error says ([`results::save`]).
pub fn write(name: &str, size: [u32; 2], columns: usize, panels: &[Panel<'_>]) -> Result<PathBuf> {
    let svg = svg(size, columns, panels)?;
    let path = match env::args_os().nth(1) {
        Some(path) => PathBuf::from(path),
        None => {
            Path::new(env!("CARGO_MANIFEST_DIR")).with_file_name("target").join(name).with_extension("svg")
        }
    };
    results::save(&path, &svg)?;
    Ok(path)
}

/// The picture, `size` pixels wide and high, with its panels in rows of `columns`.
///
/// # Errors
/// A picture that cannot be drawn.
pub fn svg(size: [u32; 2], columns: usize, panels: &[Panel<'_>]) -> Result<String> {
    let mut svg = String::new();
    let units = size.map(|pixels| pixels * PIXEL as u32);
    {
        let root = SVGBackend::with_string(&mut svg, units.into()).into_drawing_area();
        root.fill(&WHITE)?;
        let areas = root.split_evenly((panels.len().div_ceil(columns), columns));
        for (area, panel) in areas.iter().zip(panels) {
            draw(area, panel)?;
        }
        root.present()?;
    }
    // Attributes that say what holds anyway are half of a picture of many points.
    for default in [" opacity=\"1\"", " stroke=\"none\" stroke-width=\"1\""] {
        svg = svg.replace(default, "");
    }
    // The size becomes one in pixels; the view box stays in units.
    let header = |[width, height]: [u32; 2]| format!("<svg width=\"{width}\" height=\"{height}\"");
    Ok(svg.replacen(&header(units), &header(size), 1))
}

fn draw<'a>(area: &DrawingArea<SVGBackend<'a>, Shift>, panel: &Panel<'_>) -> Result<()> {
    let all = || panel.curves.iter().flat_map(|curve| &curve.points);
    let (x, y) = (extent(all().map(|point| point.0), 0.02), extent(all().map(|point| point.1), 0.05));
    let pixel = (x.end - x.start) / f64::from(area.dim_in_pixel().0) * f64::from(PIXEL);
    let mut chart = ChartBuilder::on(area)
        .caption(panel.title, (FONT, 24 * PIXEL))
        .margin(14 * PIXEL)
        .margin_right(36 * PIXEL)
        .x_label_area_size(52 * PIXEL)
        .y_label_area_size(94 * PIXEL)
        .build_cartesian_2d(x, y)?;
    chart
        .configure_mesh()
        .x_desc(panel.x)
        .y_desc(panel.y)
        .x_labels(8)
        .y_labels(8)
        .x_label_formatter(&|x| number(*x))
        .y_label_formatter(&|y| number(*y))
        .label_style((FONT, 19 * PIXEL))
        .axis_desc_style((FONT, 21 * PIXEL))
        .light_line_style(TRANSPARENT)
        .bold_line_style(RGBColor(225, 225, 225).stroke_width(PIXEL as u32))
        .axis_style(BLACK.stroke_width(PIXEL as u32))
        .set_all_tick_mark_size(5 * PIXEL)
        .draw()?;
    for curve in &panel.curves {
        let colour = curve.colour;
        let stroke = move |width: u32| colour.stroke_width(width * PIXEL as u32);
        match curve.mark {
            Mark::Line(width) => {
                let series = LineSeries::new(thinned(&curve.points, pixel), stroke(width));
                let sample = stroke(width.max(2));
                let drawn = chart.draw_series(series)?;
                if !curve.label.is_empty() {
                    drawn
                        .label(curve.label)
                        .legend(move |(x, y)| PathElement::new([(x, y), (x + 24 * PIXEL, y)], sample));
                }
            }
            Mark::Dot => draw_points(&mut chart, curve, move |at| Circle::new(at, PIXEL, colour.filled()))?,
            Mark::Disc => {
                draw_points(&mut chart, curve, move |at| Circle::new(at, 3 * PIXEL, colour.filled()))?
            }
            Mark::Circle => draw_points(&mut chart, curve, move |at| Circle::new(at, 5 * PIXEL, stroke(2)))?,
            Mark::Triangle => {
                draw_points(&mut chart, curve, move |at| {
                    TriangleMarker::new(at, 6 * PIXEL, colour.filled())
                })?;
            }
        }
    }
    if panel.curves.iter().all(|curve| curve.label.is_empty()) {
        return Ok(());
    }
    let position = match panel.legend {
        Corner::UpperLeft => SeriesLabelPosition::UpperLeft,
        Corner::UpperRight => SeriesLabelPosition::UpperRight,
        Corner::LowerLeft => SeriesLabelPosition::LowerLeft,
        Corner::LowerRight => SeriesLabelPosition::LowerRight,
    };
    chart
        .configure_series_labels()
        .position(position)
        .margin(8 * PIXEL)
        .legend_area_size(32 * PIXEL)
        .label_font((FONT, 19 * PIXEL))
        .background_style(WHITE.mix(0.85))
        .draw()?;
    Ok(())
}

/// A series of one shape, given by what draws it at a pixel.
fn draw_points<'a, E>(
    chart: &mut Chart<'a>,
    curve: &Curve<'_>,
    shape: impl Fn((i32, i32)) -> E + 'a,
) -> Result<()>
where
    E: Drawable<SVGBackend<'a>> + 'a,
    for<'b> &'b E: PointCollection<'b, (i32, i32)>,
{
    let drawn =
        chart.draw_series(curve.points.iter().map(|&point| EmptyElement::at(point) + shape((0, 0))))?;
    if !curve.label.is_empty() {
        drawn.label(curve.label).legend(move |(x, y)| shape((x + 12 * PIXEL, y)));
    }
    Ok(())
}

/// The same line from fewer points: of those within one `pixel` of x the first, the lowest, the highest and the last.
fn thinned(points: &[(f64, f64)], pixel: f64) -> Vec<(f64, f64)> {
    let column = |point: &(f64, f64)| (point.0 / pixel).floor();
    points
        .chunk_by(|a, b| column(a) == column(b))
        .flat_map(|points| {
            let by_height = |&a: &usize, &b: &usize| points[a].1.total_cmp(&points[b].1);
            let lowest = (0..points.len()).min_by(by_height).unwrap_or(0);
            let highest = (0..points.len()).max_by(by_height).unwrap_or(0);
            let mut kept = vec![0, lowest, highest, points.len() - 1];
            kept.sort_unstable();
            kept.dedup();
            kept.into_iter().map(|index| points[index])
        })
        .collect()
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

/// A tick's number, without the rounding that made it.
fn number(value: f64) -> String {
    let rounded = (value * 1e6).round() / 1e6 + 0.0;
    rounded.to_string().replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_picture_has_its_size_in_pixels_and_its_words() -> Result<()> {
        let points = vec![(0.0, -1.0), (1.0, 1.0)];
        let curves = vec![Curve { label: "a line", colour: colour::REFERENCE, mark: Mark::Line(1), points }];
        let panel = Panel { title: "Title", x: "time t", y: "q", legend: Corner::UpperLeft, curves };
        let svg = svg([400, 300], 1, &[panel])?;
        assert!(
            svg.starts_with("<svg width=\"400\" height=\"300\" viewBox=\"0 0 3200 2400\""),
            "{}",
            &svg[..80]
        );
        for word in ["Title", "time t", "q", "a line", "−0.5"] {
            assert!(svg.lines().any(|line| line == word), "{word}");
        }
        Ok(())
    }

    #[test]
    fn a_thinned_line_keeps_its_extremes_and_its_order() {
        let points = [(0.1, 0.0), (0.2, 5.0), (0.3, 1.0), (0.4, -5.0), (0.5, 2.0), (1.1, 3.0)];
        assert_eq!(thinned(&points, 1.0), [(0.1, 0.0), (0.2, 5.0), (0.4, -5.0), (0.5, 2.0), (1.1, 3.0)]);
        assert_eq!(thinned(&points, 0.01), points);
    }

    #[test]
    fn numbers_are_rounded_and_have_a_minus() {
        assert_eq!([0.1 + 0.2, -0.05, -0.0, 2000.0].map(number), ["0.3", "−0.05", "0", "2000"]);
    }

    #[test]
    fn an_extent_without_width_is_widened() {
        assert_eq!(extent([1.0, 3.0, f64::NAN].into_iter(), 0.5), 0.0..4.0);
        assert_eq!(extent([2.0, 2.0].into_iter(), 0.5), 1.0..3.0);
        assert_eq!(extent([].into_iter(), 0.5), -1.0..1.0);
    }
}
