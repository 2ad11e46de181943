//! Derivatives of characteristics, by their numbers.

/// The highest derivative that a characteristic has.
pub const HIGHEST: u8 = 3;

/// A derivative of a characteristic, from the 0th on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Curve {
    /// The field or constant, a parameter that is no number.
    pub parameter: usize,
    pub order: u8,
}

impl Curve {
    /// Every derivative of the characteristic.
    pub fn all(self) -> impl Iterator<Item = Self> {
        (0..=HIGHEST).map(move |order| Self { order, ..self })
    }
}
