//! Marsaglia's xorshift (2003): where looks fall, what an error may be besides, at which states models are
//! compared.

/// A sequence of numbers without a period that a motion could have.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Random(u64);

impl Random {
    /// From a seed that is not 0.
    pub(crate) const fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next one, of all 64 bits but 0.
    pub(crate) fn draw(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    /// The next one, between 0 and 1.
    pub(crate) fn unit(&mut self) -> f64 {
        (self.draw() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// The next one, between −1 and 1.
    pub(crate) fn sign(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }
}
