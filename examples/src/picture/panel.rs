//! What a picture is made of: panels of curves, bands and pixels.

use super::{Axis, RGBColor, Raster};

/// The pattern of a line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Dash {
    /// Unbroken.
    #[default]
    Solid,
    /// Long dashes.
    Dashed,
    /// Dots.
    Dotted,
    /// Dashes and dots in turn.
    DashDotted,
}

/// The shape of a mark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// A small dot, for thousands of points.
    Dot,
    /// A disc.
    Disc,
    /// An open circle.
    Circle,
    /// A triangle.
    Triangle,
    /// An open square.
    Square,
    /// A diagonal cross.
    Cross,
    /// A filled square: what stands for an area in the legend.
    Block,
}

/// Points drawn in one way.
#[derive(Clone, Debug)]
pub struct Curve<'a> {
    pub(super) label: &'a str,
    pub(super) colour: RGBColor,
    pub(super) line: Option<(u32, Dash)>,
    pub(super) mark: Option<(Mark, usize)>,
    pub(super) is_area: bool,
    pub(super) points: Vec<(f64, f64)>,
}

impl<'a> Curve<'a> {
    /// A line through `points`, `width` pixels wide. Without a label it has no entry in the legend.
    pub fn line(label: &'a str, colour: RGBColor, width: u32, points: Vec<(f64, f64)>) -> Self {
        Self { label, colour, line: Some((width, Dash::Solid)), mark: None, is_area: false, points }
    }

    /// A mark at each of `points`.
    pub fn marks(label: &'a str, colour: RGBColor, mark: Mark, points: Vec<(f64, f64)>) -> Self {
        Self { label, colour, line: None, mark: Some((mark, 1)), is_area: false, points }
    }

    /// The area between two lines over the same x: at each of `points` x, and y from and to.
    pub fn band(label: &'a str, colour: RGBColor, points: &[(f64, [f64; 2])]) -> Self {
        let below = points.iter().map(|&(x, [from, _])| (x, from));
        let above = points.iter().rev().map(|&(x, [_, to])| (x, to));
        let points = below.chain(above).collect();
        Self { label, colour, line: None, mark: Some((Mark::Block, 1)), is_area: true, points }
    }

    /// Whether one entry of a legend does for both.
    pub(super) fn has_the_look_of(&self, other: &Curve<'_>) -> bool {
        let mark = |curve: &Curve<'_>| curve.mark.map(|(mark, _)| mark);
        let look = |curve: &Curve<'_>| (curve.colour, curve.line, curve.is_area);
        self.label == other.label && look(self) == look(other) && mark(self) == mark(other)
    }

    /// The line broken.
    #[must_use]
    pub fn dashed(mut self, dash: Dash) -> Self {
        self.line = self.line.map(|(width, _)| (width, dash));
        self
    }

    /// A mark at every `stride`-th point as well.
    #[must_use]
    pub fn marked(mut self, mark: Mark, stride: usize) -> Self {
        self.mark = Some((mark, stride.max(1)));
        self
    }

    /// Its marks at every `stride`-th point alone.
    #[must_use]
    pub fn marked_rarely(mut self, stride: usize) -> Self {
        self.mark = self.mark.map(|(mark, _)| (mark, stride.max(1)));
        self
    }
}

/// A pair of axes that show all of the curves, the first at the bottom.
#[derive(Clone, Debug)]
pub struct Panel<'a> {
    pub(super) title: &'a str,
    pub(super) x: Axis<'a>,
    pub(super) y: Axis<'a>,
    pub(super) is_equal: bool,
    pub(super) raster: Option<Raster>,
    pub(super) curves: Vec<Curve<'a>>,
}

impl<'a> Panel<'a> {
    /// The panel of `curves`, whose legend has their order.
    pub fn new(title: &'a str, x: Axis<'a>, y: Axis<'a>, curves: Vec<Curve<'a>>) -> Self {
        Self { title, x, y, is_equal: false, raster: None, curves }
    }

    /// The panel of `raster`, whose `classes` are called so in the legend and have these colours.
    pub fn of_raster(
        title: &'a str,
        x: Axis<'a>,
        y: Axis<'a>,
        raster: Raster,
        classes: &[(&'a str, RGBColor)],
    ) -> Self {
        let entry = |&(label, colour): &(&'a str, _)| Curve::marks(label, colour, Mark::Block, Vec::new());
        let curves = classes.iter().map(entry).collect();
        Self { title, x, y, is_equal: false, raster: Some(raster), curves }
    }

    /// Both axes to the same scale.
    #[must_use]
    pub fn to_equal_scale(mut self) -> Self {
        self.is_equal = true;
        self
    }
}
