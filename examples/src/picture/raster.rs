//! Pictures made of pixels, as PNG inside the SVG.

use anyhow::{Result, anyhow, ensure};
use base64::prelude::{BASE64_STANDARD, Engine};
use png::{BitDepth, ColorType, Compression, Encoder, Filter};

use super::RGBColor;

/// Pixels of a few classes, each class with a colour of its own.
#[derive(Clone, Debug)]
pub struct Raster {
    /// Pixels in a row.
    pub columns: usize,
    /// Where the left edge of the first column and the right edge of the last are.
    pub x: [f64; 2],
    /// Where the lower edge of the last row and the upper edge of the first are.
    pub y: [f64; 2],
    /// The class of each pixel, row by row from above. Those without stay blank.
    pub pixels: Vec<Option<u8>>,
}

impl Raster {
    /// The picture as the address of an `<image>`: a PNG with one entry of its palette for each class, after
    /// that of blank pixels.
    pub(super) fn address(&self, classes: &[RGBColor]) -> Result<String> {
        let rows = self.pixels.len() / self.columns.max(1);
        ensure!(rows * self.columns == self.pixels.len(), "rows of unequal length");
        let palette: Vec<u8> = [[255; 3]]
            .into_iter()
            .chain(classes.iter().map(|class| [class.0, class.1, class.2]))
            .flatten()
            .collect();
        let mut file = Vec::new();
        let mut encoder = Encoder::new(&mut file, self.columns.try_into()?, rows.try_into()?);
        encoder.set_color(ColorType::Indexed);
        encoder.set_depth(BitDepth::Eight);
        encoder.set_palette(palette);
        encoder.set_trns(vec![0]);
        encoder.set_compression(Compression::High);
        // Differences of palette entries say nothing.
        encoder.set_filter(Filter::NoFilter);
        let entry = |pixel: &Option<u8>| match pixel {
            Some(class) if usize::from(*class) < classes.len() => Ok(class + 1),
            Some(class) => Err(anyhow!("a pixel of class {class}, of {}", classes.len())),
            None => Ok(0),
        };
        let entries: Vec<u8> = self.pixels.iter().map(entry).collect::<Result<_>>()?;
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&entries)?;
        writer.finish()?;
        Ok(format!("data:image/png;base64,{}", BASE64_STANDARD.encode(&file)))
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;
    use crate::picture::{Panel, linear, svg};

    const CLASSES: [(&str, RGBColor); 2] = [("one", RGBColor(1, 2, 3)), ("two", RGBColor(4, 5, 6))];

    fn raster(pixels: Vec<Option<u8>>) -> Raster {
        Raster { columns: 3, x: [0.0, 3.0], y: [0.0, 2.0], pixels }
    }

    fn picture(pixels: Vec<Option<u8>>) -> Result<String> {
        let panel = Panel::of_raster("Title", linear("x"), linear("y"), raster(pixels), &CLASSES);
        svg([500, 400], 1, &[panel])
    }

    /// Where the picture shows the corners of the raster, in units: x, y, width and height.
    fn frame(svg: &str) -> Option<[f64; 4]> {
        let tag = svg.split("<image").nth(1)?.split("/>").next()?;
        let value = |name: &str| tag.split(&format!(" {name}=\"")).nth(1)?.split('"').next()?.parse().ok();
        Some([value("x")?, value("y")?, value("width")?, value("height")?])
    }

    #[test]
    fn the_picture_holds_the_pixels_where_the_axes_say() -> Result<()> {
        let svg = picture(vec![Some(0), None, Some(1), Some(1), Some(1), Some(0)])?;
        let address = svg.split("base64,").nth(1).and_then(|rest| rest.split('"').next()).unwrap_or_default();
        let mut decoder = png::Decoder::new(Cursor::new(BASE64_STANDARD.decode(address)?));
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info()?;
        let mut pixels = vec![0; reader.output_buffer_size().unwrap_or(0)];
        let info = reader.next_frame(&mut pixels)?;
        assert_eq!((info.width, info.height), (3, 2));
        let [one, two, blank] = [[1, 2, 3, 255], [4, 5, 6, 255], [255, 255, 255, 0]];
        assert_eq!(pixels, [one, blank, two, two, two, one].concat());
        // In the area of the axes, and most of it: the margins of values are small.
        let [x, y, width, height] = frame(&svg).unwrap_or_default();
        assert!(x > 0.0 && x + width < 8.0 * 500.0 && width > 8.0 * 300.0, "{x} {width}");
        assert!(y > 0.0 && y + height < 8.0 * 400.0 && height > 8.0 * 200.0, "{y} {height}");
        Ok(())
    }

    #[test]
    fn pixels_of_no_class_and_rows_cut_short_are_errors() {
        let error = |pixels| picture(pixels).map(|_| ()).unwrap_err().to_string();
        assert!(error(vec![Some(2); 6]).contains("class 2, of 2"));
        assert!(error(vec![None; 5]).contains("unequal"));
    }
}
