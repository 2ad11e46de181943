//! What plotters cannot say in SVG: dashes, and images of another resolution than the drawing; and what it
//! says needlessly.

use plotters::style::{Color, RGBColor, ShapeStyle};

use super::Dash;

/// Opacities that no picture has otherwise: they stand for dashes until the picture is finished.
const STAND_INS: [(f64, Dash, [u32; 4]); 3] = [
    (0.991, Dash::Dashed, [12, 6, 12, 6]),
    (0.992, Dash::Dotted, [2, 5, 2, 5]),
    (0.993, Dash::DashDotted, [12, 5, 2, 5]),
];

/// The same for images.
const IMAGE: f64 = 0.994;

/// The style of a rectangle that stands for an image until the picture is finished.
pub fn image() -> ShapeStyle {
    RGBColor(0, 0, 0).mix(IMAGE).filled()
}

/// The style of a line `width` pixels wide, of `pixel` units each.
pub fn stroke(colour: RGBColor, width: u32, dash: Dash, pixel: i32) -> ShapeStyle {
    let stand_in = STAND_INS.iter().find(|(_, of, _)| *of == dash).map_or(1.0, |(opacity, ..)| *opacity);
    colour.mix(stand_in).stroke_width(width * pixel as u32)
}

/// The picture as it ships, `size` pixels of `pixel` units each, with the `images` at these addresses in the
/// order in which they were drawn.
pub fn finished(mut svg: String, size: [u32; 2], pixel: u32, images: &[String]) -> String {
    for address in images {
        let style = format!(" opacity=\"{IMAGE}\" fill=\"#000000\" stroke=\"none\"/>");
        let image = format!(" preserveAspectRatio=\"none\" href=\"{address}\"/>");
        if let Some(at) = svg.find(&style) {
            svg.replace_range(at..at + style.len(), &image);
            if let Some(tag) = svg[..at].rfind("<rect") {
                svg.replace_range(tag..tag + "<rect".len(), "<image");
            }
        }
    }
    for (opacity, _, lengths) in STAND_INS {
        let lengths = lengths.map(|length| (length * pixel).to_string()).join(" ");
        svg = svg.replace(&format!(" opacity=\"{opacity}\""), &format!(" stroke-dasharray=\"{lengths}\""));
    }
    // Attributes that say what holds anyway are half of a picture of many points.
    for default in [" opacity=\"1\"", " stroke=\"none\" stroke-width=\"1\""] {
        svg = svg.replace(default, "");
    }
    // The size becomes one in pixels; the view box stays in units.
    let header = |[width, height]: [u32; 2]| format!("<svg width=\"{width}\" height=\"{height}\"");
    svg.replacen(&header(size.map(|pixels| pixels * pixel)), &header(size), 1)
}
