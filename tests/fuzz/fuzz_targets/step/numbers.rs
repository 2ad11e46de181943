//! Numbers from bytes: mostly those of ordinary problems, often enough those that break things.

use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// Zeros, the ends of all ranges, and what is no number.
const ODD: [f64; 20] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    5e-324,
    -1e-310,
    f64::MIN_POSITIVE,
    1e-200,
    -1e-160,
    f64::EPSILON,
    1e-8,
    1e8,
    1e77,
    -1e103,
    1e154,
    -1e200,
    f64::MAX,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
];

/// The input, byte by byte; after its end a random sequence that it determines, so that short inputs say as
/// much as long ones.
pub struct Bytes<'a> {
    given: std::slice::Iter<'a, u8>,
    after: StdRng,
}

impl<'a> Bytes<'a> {
    pub fn new(given: &'a [u8]) -> Self {
        let hash = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x100_0000_01b3);
        let seed = given.iter().fold(0xcbf2_9ce4_8422_2325, hash);
        Self { given: given.iter(), after: StdRng::seed_from_u64(seed) }
    }

    pub fn byte(&mut self) -> u8 {
        self.given.next().copied().unwrap_or_else(|| self.after.random())
    }

    fn bytes<const K: usize>(&mut self) -> [u8; K] {
        std::array::from_fn(|_| self.byte())
    }

    /// A number.
    pub fn number(&mut self) -> f64 {
        match self.byte() % 64 {
            0 => f64::from_bits(u64::from_le_bytes(self.bytes())),
            1 | 2 => ODD[usize::from(self.byte()) % ODD.len()],
            // Over many decades.
            3..=9 => {
                let digits = f64::from(i16::from_le_bytes(self.bytes()));
                digits * 2_f64.powi(i32::from(i8::from_le_bytes(self.bytes())) / 2)
            }
            // Within ±8.
            _ => f64::from(i16::from_le_bytes(self.bytes())) / 4096.0,
        }
    }

    /// As many as asked for.
    pub fn numbers<const K: usize>(&mut self) -> [f64; K] {
        std::array::from_fn(|_| self.number())
    }
}
