//! The pictures of the scenes: panels of curves, bands and pixels in one style, as SVG.
//!
//! Every panel has its legend above its axes, off the data. Curves differ in dashes or marks as well as in
//! colour. Text stays text in the file, in whatever sans-serif font the viewer has: no font is needed to draw
//! it.

mod axis;
mod panel;
mod raster;
mod svg;

use std::env;
use std::path::{Path, PathBuf};

use anyhow::{Result, ensure};
use plotters::backend::SVGBackend;
use plotters::chart::{ChartBuilder, ChartContext};
use plotters::coord::Shift;
use plotters::coord::cartesian::Cartesian2d;
use plotters::drawing::{DrawingArea, IntoDrawingArea};
use plotters::element::{Circle, EmptyElement, PathElement, Polygon, Rectangle, Text, TriangleMarker};
pub use plotters::style::RGBColor;
use plotters::style::{BLACK, Color, ShapeStyle, TRANSPARENT, WHITE};

use crate::results;
use axis::Ticks;
pub use axis::{Axis, linear, logarithmic};
pub use panel::{Curve, Dash, Mark, Panel};
pub use raster::Raster;

/// Colours that readers with any colour vision tell apart (Okabe and Ito, 2008).
pub mod colour {
    use plotters::style::RGBColor;

    /// Exact solutions and references.
    pub const REFERENCE: RGBColor = RGBColor(0, 0, 0);
    /// The variational integrator.
    pub const VARIATIONAL: RGBColor = RGBColor(0, 114, 178);
    /// The classical Runge–Kutta method.
    pub const RUNGE_KUTTA: RGBColor = RGBColor(213, 94, 0);
    /// Euler's methods.
    pub const EULER: RGBColor = RGBColor(0, 158, 115);
    /// A fourth.
    pub const FOURTH: RGBColor = RGBColor(204, 121, 167);
    /// A fifth.
    pub const FIFTH: RGBColor = RGBColor(230, 159, 0);
    /// A sixth, light.
    pub const SIXTH: RGBColor = RGBColor(86, 180, 233);
    /// A seventh, lighter: for areas.
    pub const SEVENTH: RGBColor = RGBColor(240, 228, 66);
    /// What stands in the background.
    pub const GREY: RGBColor = RGBColor(120, 120, 120);
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<Ticks, Ticks>>;

const FONT: &str = "sans-serif";

/// Units of the drawing to a pixel: plotters rounds coordinates to whole units, which shows as steps in thin
/// lines.
const PIXEL: i32 = 8;

/// Sizes in pixels.
const TITLE: i32 = 24;
const TEXT: i32 = 19;
const LEGEND_ROW: i32 = 28;
const SAMPLE: i32 = 44;
const MARGIN: i32 = 14;
const RIGHT: i32 = 36;
const X_LABELS: i32 = 60;
const Y_LABELS: i32 = 104;

/// What `draw` does with the shape of a mark around the origin: each is a type of its own.
macro_rules! with_shape {
    ($mark:expr, $colour:expr, |$shape:ident| $draw:expr) => {{
        let (filled, open): (ShapeStyle, ShapeStyle) =
            ($colour.filled(), $colour.stroke_width(2 * PIXEL as u32));
        let (near, far) = (5 * PIXEL, -5 * PIXEL);
        match $mark {
            Mark::Dot => {
                let $shape = Circle::new((0, 0), PIXEL * 3 / 2, filled);
                $draw;
            }
            Mark::Disc => {
                let $shape = Circle::new((0, 0), 4 * PIXEL, filled);
                $draw;
            }
            Mark::Circle => {
                let $shape = Circle::new((0, 0), 5 * PIXEL, open);
                $draw;
            }
            Mark::Triangle => {
                let $shape = TriangleMarker::new((0, 0), 6 * PIXEL, filled);
                $draw;
            }
            Mark::Square => {
                let $shape =
                    PathElement::new([(far, far), (near, far), (near, near), (far, near), (far, far)], open);
                $draw;
            }
            Mark::Cross => {
                let $shape =
                    PathElement::new([(far, far), (near, near), (0, 0), (near, far), (far, near)], open);
                $draw;
            }
            Mark::Block => {
                let $shape =
                    Rectangle::new([(3 * far / 2, 3 * far / 2), (3 * near / 2, 3 * near / 2)], filled);
                $draw;
            }
        }
    }};
}

/// Writes the picture to the path that the command line gives, or else to `target/<name>.svg`, and returns
/// the path.
///
/// # Errors
/// The file cannot be written; then the picture is where the error says ([`results::save`]).
pub fn write(name: &str, size: [u32; 2], columns: usize, panels: &[Panel<'_>]) -> Result<PathBuf> {
    write_to(env::args_os().nth(1).map(PathBuf::from), name, size, columns, panels)
}

/// The same for a scene whose command line says more: to `path` or else to `target/<name>.svg`.
///
/// # Errors
/// As [`write()`].
pub fn write_to(
    path: Option<PathBuf>,
    name: &str,
    size: [u32; 2],
    columns: usize,
    panels: &[Panel<'_>],
) -> Result<PathBuf> {
    let svg = svg(size, columns, panels)?;
    let path = path.unwrap_or_else(|| {
        Path::new(env!("CARGO_MANIFEST_DIR")).with_file_name("target").join(name).with_extension("svg")
    });
    results::save(&path, &svg)?;
    Ok(path)
}

/// The picture, `size` pixels wide and high, with its panels in rows of `columns`. Panels that tell the same
/// curves apart have one legend above all.
///
/// # Errors
/// A picture that cannot be drawn: also words that do not fit.
pub fn svg(size: [u32; 2], columns: usize, panels: &[Panel<'_>]) -> Result<String> {
    let mut svg = String::new();
    let units = size.map(|pixels| pixels * PIXEL as u32);
    {
        let root = SVGBackend::with_string(&mut svg, units.into()).into_drawing_area();
        root.fill(&WHITE)?;
        let common = common_legend(panels);
        let entries = common.map_or_else(Vec::new, |panel| legend(panel, size[0] as i32));
        let above = if entries.is_empty() { 0 } else { MARGIN + LEGEND_ROW * entries.len() as i32 };
        let (head, body) = root.split_vertically(above * PIXEL);
        draw_legend(&head, &entries, MARGIN, size[0] as i32)?;
        let areas = body.split_evenly((panels.len().div_ceil(columns), columns));
        for (areas, panels) in areas.chunks(columns).zip(panels.chunks(columns)) {
            let width = areas[0].dim_in_pixel().0 as i32 / PIXEL;
            let own = |panel| if common.is_none() { legend(panel, width) } else { Vec::new() };
            let legends: Vec<_> = panels.iter().map(own).collect();
            // Axes side by side are as high as each other.
            let rows = legends.iter().map(|rows| rows.len()).max().unwrap_or(0);
            for ((area, panel), legend) in areas.iter().zip(panels).zip(legends) {
                draw(area, panel, &legend, rows)?;
            }
        }
        root.present()?;
    }
    let images = panels.iter().filter_map(|panel| {
        let colours: Vec<_> = panel.curves.iter().map(|class| class.colour).collect();
        panel.raster.as_ref().map(|raster| raster.address(&colours))
    });
    Ok(svg::finished(svg, size, PIXEL as u32, &images.collect::<Result<Vec<_>>>()?))
}

/// The panel whose legend holds the entries of every other, if each has some: one legend tells all apart.
fn common_legend<'p, 'a>(panels: &'p [Panel<'a>]) -> Option<&'p Panel<'a>> {
    let entries = |panel: &'p Panel<'a>| panel.curves.iter().filter(|curve| !curve.label.is_empty());
    let is_told = |panel, curve: &Curve<'_>| entries(panel).any(|entry| entry.has_the_look_of(curve));
    let most = panels.iter().max_by_key(|panel| entries(panel).count())?;
    let is_common =
        |panel| entries(panel).next().is_some() && entries(panel).all(|curve| is_told(most, curve));
    (panels.len() > 1 && panels.iter().all(is_common)).then_some(most)
}

/// How wide a text is, in pixels, for all that is known without a font. (plotters writes sizes that are
/// smaller by 1.24.)
fn width_of(text: &str, size: i32) -> i32 {
    let narrow = text.chars().filter(|letter| "iljt.,:;|()[]'1 ".contains(*letter)).count() as i32;
    let marks = text.chars().filter(|letter| ('\u{300}'..'\u{370}').contains(letter)).count() as i32;
    let all = text.chars().count() as i32;
    ((all - marks - narrow) * 50 + narrow * 30) * size / 100
}

/// The entries of a legend that stand side by side, row by row, each with its distance from the left.
fn legend<'p>(panel: &'p Panel<'_>, width: i32) -> Vec<Vec<(i32, &'p Curve<'p>)>> {
    let mut rows: Vec<Vec<_>> = Vec::new();
    let mut left = i32::MAX;
    for curve in panel.curves.iter().filter(|curve| !curve.label.is_empty()) {
        let entry = SAMPLE + width_of(curve.label, TEXT) + 18;
        if left.saturating_add(entry) > width - RIGHT {
            rows.push(Vec::new());
            left = MARGIN + Y_LABELS;
        }
        if let Some(row) = rows.last_mut() {
            row.push((left, curve));
        }
        left += entry;
    }
    rows
}

fn draw<'a>(
    area: &Area<'a>,
    panel: &Panel<'_>,
    legend: &[Vec<(i32, &Curve<'_>)>],
    legend_rows: usize,
) -> Result<()> {
    let [width, height] = [area.dim_in_pixel().0, area.dim_in_pixel().1].map(|units| units as i32 / PIXEL);
    let above = MARGIN + TITLE + 16 + LEGEND_ROW * legend_rows as i32;
    let [across, up] = [width - MARGIN - Y_LABELS - RIGHT, height - above - X_LABELS - MARGIN];
    check_width(panel.title, TITLE, width - MARGIN - RIGHT)?;
    check_width(panel.x.label, TEXT, across + Y_LABELS)?;
    check_width(panel.y.label, TEXT, height)?;
    let (head, body) = area.split_vertically(above * PIXEL);
    let centre = (width + Y_LABELS + MARGIN - RIGHT) / 2 - width_of(panel.title, TITLE) / 2;
    text(&head, panel.title, (centre.max(MARGIN), MARGIN), TITLE)?;
    draw_legend(&head, legend, MARGIN + TITLE + 12, width)?;
    let corners = panel.raster.iter().flat_map(|raster| [0, 1].map(|k| (raster.x[k], raster.y[k])));
    let points: Vec<_> =
        panel.curves.iter().flat_map(|curve| &curve.points).copied().chain(corners).collect();
    let values = |axis: fn(&(f64, f64)) -> f64| points.iter().map(axis);
    let (mut x, mut y) = (panel.x.ticks(values(|p| p.0), 0.02, 8), panel.y.ticks(values(|p| p.1), 0.05, 8));
    if panel.is_equal {
        axis::equalise(&mut x, &mut y, f64::from(across) / f64::from(up));
    }
    let pixel = x.width() / f64::from(across);
    let mut chart = ChartBuilder::on(&body)
        .margin(MARGIN * PIXEL)
        .margin_top(0)
        .margin_right(RIGHT * PIXEL)
        .x_label_area_size(X_LABELS * PIXEL)
        .y_label_area_size(Y_LABELS * PIXEL)
        .build_cartesian_2d(x.clone(), y.clone())?;
    chart
        .configure_mesh()
        .x_desc(panel.x.label)
        .y_desc(panel.y.label)
        .x_labels(32)
        .y_labels(32)
        .x_label_formatter(&|at| x.name(*at))
        .y_label_formatter(&|at| y.name(*at))
        .label_style((FONT, TEXT * PIXEL))
        .axis_desc_style((FONT, (TEXT + 2) * PIXEL))
        .light_line_style(TRANSPARENT)
        .bold_line_style(RGBColor(225, 225, 225).stroke_width(PIXEL as u32))
        .axis_style(BLACK.stroke_width(PIXEL as u32))
        .set_all_tick_mark_size(5 * PIXEL)
        .draw()?;
    if let Some(Raster { x: [left, right], y: [below, above], .. }) = panel.raster {
        chart.draw_series([Rectangle::new([(left, above), (right, below)], svg::image())])?;
    }
    for curve in &panel.curves {
        let points = curve.points.iter().map(|&(at, value)| (panel.x.place(at), panel.y.place(value)));
        let points: Vec<_> = points.filter(|point| point.0.is_finite() && point.1.is_finite()).collect();
        if let Some((width, dash)) = curve.line
            && !points.is_empty()
        {
            let style = svg::stroke(curve.colour, width, dash, PIXEL);
            chart.draw_series([PathElement::new(thinned(&points, pixel), style)])?;
        }
        if curve.is_area {
            chart.draw_series([Polygon::new(points, curve.colour.filled())])?;
        } else if let Some((mark, stride)) = curve.mark {
            marks(&mut chart, mark, curve.colour, points.into_iter().step_by(stride))?;
        }
    }
    Ok(())
}

/// That words fit in so many pixels.
fn check_width(words: &str, size: i32, room: i32) -> Result<()> {
    ensure!(width_of(words, size) <= room, "{words:?} is too wide for {room} pixels");
    Ok(())
}

/// The rows of a legend, the first from `top` on.
fn draw_legend(area: &Area<'_>, legend: &[Vec<(i32, &Curve<'_>)>], top: i32, width: i32) -> Result<()> {
    for (row, entries) in legend.iter().enumerate() {
        let middle = top + LEGEND_ROW * row as i32 + LEGEND_ROW / 2;
        for (left, curve) in entries {
            check_width(curve.label, TEXT, width - left - SAMPLE)?;
            sample(area, curve, (*left, middle))?;
            text(area, curve.label, (left + SAMPLE, middle - TEXT / 2 - 1), TEXT)?;
        }
    }
    Ok(())
}

fn text(area: &Area<'_>, words: &str, (x, y): (i32, i32), size: i32) -> Result<()> {
    Ok(area.draw(&Text::new(words.to_owned(), (x * PIXEL, y * PIXEL), (FONT, size * PIXEL)))?)
}

/// The entry's piece of line and mark.
fn sample(area: &Area<'_>, curve: &Curve<'_>, (left, middle): (i32, i32)) -> Result<()> {
    let [from, to, middle] = [left, left + SAMPLE - 10, middle].map(|pixels| pixels * PIXEL);
    if let Some((width, dash)) = curve.line {
        let style = svg::stroke(curve.colour, width.max(2), dash, PIXEL);
        area.draw(&PathElement::new([(from, middle), (to, middle)], style))?;
    }
    if let Some((mark, _)) = curve.mark {
        // A dot alone would hardly be seen.
        let mark = if mark == Mark::Dot { Mark::Disc } else { mark };
        with_shape!(mark, curve.colour, |shape| area
            .draw(&(EmptyElement::at(((from + to) / 2, middle)) + shape))?);
    }
    Ok(())
}

/// A series of marks.
fn marks(
    chart: &mut Chart<'_, '_>,
    mark: Mark,
    colour: RGBColor,
    points: impl Iterator<Item = (f64, f64)>,
) -> Result<()> {
    for at in points {
        with_shape!(mark, colour, |shape| {
            chart.draw_series([EmptyElement::at(at) + shape])?;
        });
    }
    Ok(())
}

/// The same line from fewer points: of those within one `pixel` of x the first, the lowest, the highest and
/// the last.
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

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(title: &str) -> Result<String> {
        let points = vec![(0.0, -1.0), (1.0, 1.0)];
        let curve = Curve::line("a line", colour::REFERENCE, 1, points).dashed(Dash::Dashed);
        svg([400, 300], 1, &[Panel::new(title, linear("time t"), linear("q"), vec![curve])])
    }

    #[test]
    fn the_picture_has_its_size_in_pixels_and_its_words() -> Result<()> {
        let svg = picture("Title")?;
        assert!(
            svg.starts_with("<svg width=\"400\" height=\"300\" viewBox=\"0 0 3200 2400\""),
            "{}",
            &svg[..80]
        );
        for word in ["Title", "time t", "q", "a line", "−0.5"] {
            assert!(svg.lines().any(|line| line == word), "{word}");
        }
        assert!(svg.contains("stroke-dasharray"));
        Ok(())
    }

    #[test]
    fn panels_of_the_same_curves_have_one_legend() -> Result<()> {
        let line = |label, colour| Curve::line(label, colour, 1, vec![(0.0, -1.0), (1.0, 1.0)]);
        let names = |second: Vec<Curve<'_>>| -> Result<usize> {
            let first = vec![line("a line", colour::REFERENCE), line("another", colour::EULER)];
            let panels = [first, second].map(|curves| Panel::new("Title", linear("t"), linear("q"), curves));
            let svg = svg([800, 300], 2, &panels)?;
            Ok(svg.lines().filter(|word| *word == "a line").count())
        };
        assert_eq!(names(vec![line("a line", colour::REFERENCE)])?, 1);
        assert_eq!(names(vec![line("a line", colour::EULER)])?, 2, "another colour");
        assert_eq!(names(vec![line("", colour::REFERENCE)])?, 1, "no legend in the second");
        Ok(())
    }

    #[test]
    fn words_that_do_not_fit_are_an_error() {
        let error = picture("A title that is by far too long for a panel of 400 pixels").unwrap_err();
        assert!(error.to_string().contains("too wide"), "{error}");
    }

    #[test]
    fn a_thinned_line_keeps_its_extremes_and_its_order() {
        let points = [(0.1, 0.0), (0.2, 5.0), (0.3, 1.0), (0.4, -5.0), (0.5, 2.0), (1.1, 3.0)];
        assert_eq!(thinned(&points, 1.0), [(0.1, 0.0), (0.2, 5.0), (0.4, -5.0), (0.5, 2.0), (1.1, 3.0)]);
        assert_eq!(thinned(&points, 0.01), points);
    }
}
