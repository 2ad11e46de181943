//! Functions on a circle, by values and slopes at points evenly spread.

/// Value and slope of a function at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Jet {
    /// The value.
    pub value: f64,
    /// The derivative.
    pub slope: f64,
}

/// A function of an angle, between two points of its grid the cubic of their values and slopes.
///
/// A minimum of smooth functions has kinks where its slope falls at once. Between two points whose slope
/// falls by more than N^{−1/2} of all that it varies by, the function is that of the tangents, error N⁻².
#[derive(Clone, Debug, PartialEq)]
pub struct PeriodicFunction {
    period: f64,
    nodes: Vec<Jet>,
    /// The fall of the slope between two points that makes a kink.
    fall: f64,
}

impl PeriodicFunction {
    pub(super) fn new(period: f64, nodes: Vec<Jet>) -> Self {
        let slopes = || nodes.iter().map(|node| node.slope);
        let range = slopes().fold(f64::MIN, f64::max) - slopes().fold(f64::MAX, f64::min);
        let fall = range / (nodes.len() as f64).sqrt();
        Self { period, nodes, fall }
    }

    /// The value and the slope at `q`.
    #[must_use]
    pub fn at(&self, q: f64) -> Jet {
        let spacing = self.spacing();
        let place = (q / spacing).rem_euclid(self.nodes.len() as f64);
        let (cell, share) = (place as usize % self.nodes.len(), place.fract());
        let [left, right] = self.ends(cell);
        match self.kink(cell) {
            Some(kink) if share < kink => left.tangent(share * spacing),
            Some(_) => right.tangent((share - 1.0) * spacing),
            None => Cubic::between(left, right, spacing).at(share, spacing),
        }
    }

    /// Values and slopes at the points of the grid: 0, P/N, 2P/N, …
    #[must_use]
    pub fn nodes(&self) -> &[Jet] {
        &self.nodes
    }

    /// Distance of two points of the grid.
    #[must_use]
    pub fn spacing(&self) -> f64 {
        self.period / self.nodes.len() as f64
    }

    /// The largest difference to `other` at the points of the grid.
    #[must_use]
    pub fn distance(&self, other: &Self) -> f64 {
        let difference = |(i, node): (usize, &Jet)| node.value - other.at(i as f64 * self.spacing()).value;
        self.nodes.iter().enumerate().map(difference).fold(0.0, |most, by| by.abs().max(most))
    }

    /// The smallest and the largest of this less `before`, on the same grid.
    pub(super) fn change(&self, before: &Self) -> [f64; 2] {
        let changes = self.nodes.iter().zip(&before.nodes).map(|(node, before)| node.value - before.value);
        changes.fold([f64::MAX, f64::MIN], |[low, high], by| [low.min(by), high.max(by)])
    }

    /// Where the slope falls at once, in [0, P].
    #[must_use]
    pub fn kinks(&self) -> Vec<f64> {
        let found = |cell| Some((cell as f64 + self.kink(cell)?) * self.spacing());
        (0..self.nodes.len()).filter_map(found).collect()
    }

    /// Where the tangents of both ends meet, as a share of the cell, if it has a kink.
    fn kink(&self, cell: usize) -> Option<f64> {
        let ([left, right], spacing) = (self.ends(cell), self.spacing());
        let fall = left.slope - right.slope;
        let share = ((right.value - left.value) / spacing - right.slope) / fall;
        (fall > self.fall).then_some(share.clamp(0.0, 1.0))
    }

    fn ends(&self, cell: usize) -> [Jet; 2] {
        [self.nodes[cell], self.nodes[(cell + 1) % self.nodes.len()]]
    }

    pub(super) fn raised(mut self, by: f64) -> Self {
        for node in &mut self.nodes {
            node.value += by;
        }
        self
    }
}

impl Jet {
    fn tangent(self, by: f64) -> Self {
        Self { value: self.value + self.slope * by, ..self }
    }
}

/// a + bt + ct² + dt³, 0 ≤ t ≤ 1.
pub(super) struct Cubic([f64; 4]);

impl Cubic {
    /// The cubic of both ends of a cell.
    pub(super) fn between(left: Jet, right: Jet, spacing: f64) -> Self {
        let (rise, from, to) = (right.value - left.value, left.slope * spacing, right.slope * spacing);
        Self([left.value, from, 3.0 * rise - 2.0 * from - to, from + to - 2.0 * rise])
    }

    fn at(&self, t: f64, spacing: f64) -> Jet {
        let Self([a, b, c, d]) = self;
        Jet { value: a + t * (b + t * (c + t * d)), slope: (b + t * (2.0 * c + 3.0 * t * d)) / spacing }
    }

    /// Where it is least, and its value, if its slope rises through 0.
    pub(super) fn least(&self) -> Option<(f64, f64)> {
        let Self([_, b, c, d]) = self;
        let t = -b / (c + (c * c - 3.0 * b * d).sqrt());
        (0.0..=1.0).contains(&t).then(|| (t, self.at(t, 1.0).value))
    }
}
