//! The fixed point of the stationary equation.

use super::PeriodicFunction;

/// The fixed point S* on a grid: [`StationaryEquation::solve`](super::StationaryEquation::solve).
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct StationarySolution {
    /// S* and dS*.
    pub function: PeriodicFunction,
    /// The minimiser q0 of every q1 of the grid: the configuration a step before, on the line.
    pub minimisers: Vec<f64>,
    /// Where dS* falls at once, since two q0 are as good.
    pub kinks: Vec<f64>,
    /// How often T was applied.
    pub iterations: usize,
    /// sup|S_{k+1} − S_k| / sup|S_k − S_{k−1}|, the last that rounding leaves its digits: c. NaN where S_0
    /// was as near as that.
    pub ratio: f64,
    /// Distance of S* from that of this grid, at most, but for rounding. That of the grid itself is not in
    /// it: compare with a finer one.
    pub error: f64,
}

impl StationarySolution {
    /// S*(q).
    #[must_use]
    pub fn value(&self, q: f64) -> f64 {
        self.function.at(q).value
    }

    /// dS*(q), the momentum.
    #[must_use]
    pub fn gradient(&self, q: f64) -> f64 {
        self.function.at(q).slope
    }
}
