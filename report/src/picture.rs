//! Figures on logarithmic axes, as SVG.

use std::path::Path;

use anyhow::Result;
use dalembert_examples::results;
use plotters::prelude::*;

/// One method's points, in the colour and with the mark that it has in every figure.
pub struct Curve<'a> {
    pub method: &'a str,
    pub points: Vec<(f64, f64)>,
}

/// What a panel shows.
pub struct Panel<'a> {
    pub title: String,
    pub x: &'a str,
    pub y: &'a str,
    /// Whether the horizontal axis is linear; the vertical one never is.
    pub linear: bool,
    pub y_range: std::ops::Range<f64>,
    pub curves: Vec<Curve<'a>>,
}

/// Colours that readers with any colour vision tell apart (Okabe and Ito, 2008), dark enough for lines on white.
const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    RGBColor(0, 0, 0),
];

const FONT: &str = "sans-serif";
const PANEL: [u32; 2] = [560, 430];
const LEGEND: u32 = 30;

/// Writes panels in rows of `columns`, with one legend below for the `methods` in their order.
///
/// # Errors
/// The file cannot be written.
pub fn write(path: &Path, columns: usize, methods: &[&str], panels: &[Panel<'_>]) -> Result<()> {
    let rows = panels.len().div_ceil(columns);
    let legend_rows = methods.len().div_ceil(3) as u32;
    let (width, height) = (PANEL[0] * columns as u32, PANEL[1] * rows as u32);
    let mut svg = String::new();
    let size = (width, height + LEGEND * legend_rows + 10);
    let root = SVGBackend::with_string(&mut svg, size).into_drawing_area();
    root.fill(&WHITE)?;
    let (above, below) = root.split_vertically(height);
    for (area, panel) in above.split_evenly((rows, columns)).iter().zip(panels) {
        if panel.linear {
            let end = panel.curves.iter().flat_map(|c| &c.points).map(|p| p.0).fold(0.0, f64::max);
            let mut chart = builder(area, &panel.title)
                .build_cartesian_2d(0.0..end, panel.y_range.clone().log_scale())?;
            chart
                .configure_mesh()
                .x_desc(panel.x)
                .y_desc(panel.y)
                .x_labels(6)
                .y_label_formatter(&|y| power(*y))
                .label_style((FONT, 15))
                .axis_desc_style((FONT, 16))
                .light_line_style(TRANSPARENT)
                .bold_line_style(RGBColor(225, 225, 225))
                .draw()?;
            for curve in &panel.curves {
                let (stroke, place) = (colour(methods, curve.method), index(methods, curve.method));
                chart.draw_series(LineSeries::new(curve.points.clone(), stroke.stroke_width(2)))?;
                // Marks now and then, of each curve at other times.
                let marked = curve.points.iter().skip(2 * place).step_by(40);
                chart.draw_series(
                    marked.map(|&at| EmptyElement::at(at) + marker((0, 0), stroke, place / COLOURS.len())),
                )?;
            }
        } else {
            let (low, high) = decades(panel.curves.iter().flat_map(|c| &c.points).map(|p| p.0));
            let mut chart = builder(area, &panel.title)
                .build_cartesian_2d((low..high).log_scale(), panel.y_range.clone().log_scale())?;
            chart
                .configure_mesh()
                .x_desc(panel.x)
                .y_desc(panel.y)
                .x_label_formatter(&|x| power(*x))
                .y_label_formatter(&|y| power(*y))
                .label_style((FONT, 15))
                .axis_desc_style((FONT, 16))
                .light_line_style(TRANSPARENT)
                .bold_line_style(RGBColor(225, 225, 225))
                .draw()?;
            for curve in &panel.curves {
                let (stroke, mark) =
                    (colour(methods, curve.method), index(methods, curve.method) / COLOURS.len());
                chart.draw_series(LineSeries::new(curve.points.clone(), stroke.stroke_width(2)))?;
                chart.draw_series(
                    curve.points.iter().map(|&at| EmptyElement::at(at) + marker((0, 0), stroke, mark)),
                )?;
            }
        }
    }
    for (i, method) in methods.iter().enumerate() {
        let (column, row) = (i as i32 % 3, i as i32 / 3);
        let x = 40 + column * (width as i32 / 3);
        let y = row * LEGEND as i32 + 12;
        let stroke = colour(methods, method);
        below.draw(&PathElement::new([(x, y), (x + 36, y)], stroke.stroke_width(2)))?;
        below.draw(&marker((x + 18, y), stroke, i / COLOURS.len()))?;
        below.draw(&Text::new((*method).to_owned(), (x + 46, y - 9), (FONT, 17)))?;
    }
    root.present()?;
    drop((root, above, below));
    results::save(path, &svg)
}

fn builder<'a, 'b>(
    area: &'a DrawingArea<SVGBackend<'b>, plotters::coord::Shift>,
    title: &str,
) -> ChartBuilder<'a, 'b, SVGBackend<'b>> {
    let mut builder = ChartBuilder::on(area);
    builder
        .caption(title, (FONT, 20))
        .margin(10)
        .margin_right(24)
        .x_label_area_size(44)
        .y_label_area_size(66);
    builder
}

/// A disc, a circle for the methods after the seventh, a dot for those after the fourteenth: colours repeat, marks tell them apart.
fn marker(at: (i32, i32), stroke: RGBColor, kind: usize) -> Circle<(i32, i32), i32> {
    match kind {
        0 => Circle::new(at, 4, stroke.filled()),
        1 => Circle::new(at, 4, stroke.stroke_width(2)),
        _ => Circle::new(at, 2, stroke.filled()),
    }
}

fn index(methods: &[&str], method: &str) -> usize {
    methods.iter().position(|name| *name == method).unwrap_or(0)
}

fn colour(methods: &[&str], method: &str) -> RGBColor {
    COLOURS[index(methods, method) % COLOURS.len()]
}

/// The powers of ten around the values.
fn decades(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values
        .filter(|value| *value > 0.0)
        .fold((f64::INFINITY, 0.0), |(low, high): (f64, f64), value| (low.min(value), high.max(value)));
    if low > high { (0.1, 1.0) } else { (10_f64.powf(low.log10().floor()), 10_f64.powf(high.log10().ceil())) }
}

/// A power of ten as such, any other number in full.
fn power(value: f64) -> String {
    let exponent = value.log10().round();
    if (value / 10_f64.powf(exponent) - 1.0).abs() > 1e-6 {
        return format!("{value}");
    }
    let digits = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        c => char::from_u32('⁰' as u32 + c.to_digit(10).unwrap_or(0)).unwrap_or(c),
    };
    match exponent as i32 {
        0 => "1".into(),
        1 => "10".into(),
        exponent => format!("10{}", exponent.to_string().chars().map(digits).collect::<String>()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_powers_of_ten() {
        assert_eq!([1e-12, 1e-3, 1.0, 10.0, 1e4, 20.0].map(power), ["10⁻¹²", "10⁻³", "1", "10", "10⁴", "20"]);
    }

    #[test]
    fn an_axis_ends_at_powers_of_ten() {
        assert_eq!(decades([0.0, 3.0, 47.0].into_iter()), (1.0, 100.0));
        assert_eq!(decades([].into_iter()), (0.1, 1.0));
    }
}
