//! The numbers that a system is drawn from.

use core::ops::Range;

use rand::rngs::StdRng;
use rand::{RngExt as _, SeedableRng as _};

/// Two streams: what decides how a system reads is drawn from the first, which all systems of one text share,
/// and its numbers from a second of its own. The first system of a text has its numbers from the first too.
pub struct Draws {
    shared: StdRng,
    own: Option<StdRng>,
}

impl Draws {
    pub fn of(seed: u64, member: u64) -> Self {
        let own = (member > 0).then(|| StdRng::seed_from_u64(seed ^ member << 48));
        Self { shared: StdRng::seed_from_u64(seed), own }
    }

    pub fn chance(&mut self, probability: f64) -> bool {
        self.shared.random_bool(probability)
    }

    pub fn index(&mut self, range: Range<usize>) -> usize {
        self.shared.random_range(range)
    }

    pub fn tenth(&mut self) -> i32 {
        self.shared.random_range(0..10)
    }

    /// One element of a list.
    pub fn choice<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.index(0..of.len())]
    }

    /// A number.
    pub fn number(&mut self, range: Range<f64>) -> f64 {
        self.both(range)[1]
    }

    /// A number of the first system, and of this one.
    pub fn both(&mut self, range: Range<f64>) -> [f64; 2] {
        let first = self.shared.random_range(range.clone());
        [first, self.own.as_mut().map_or(first, |own| own.random_range(range))]
    }
}
