//! Lines of words and numbers for the host, without the formatting machinery of `core`.

use crate::machine;

/// A line under way; longer ones are cut.
pub struct Line {
    text: [u8; 160],
    length: usize,
}

impl Line {
    pub fn new(word: &str) -> Self {
        Self { text: [0; 160], length: 0 }.word(word)
    }

    fn byte(mut self, byte: u8) -> Self {
        // The last byte stays zero: it ends the text.
        if let Some((_, place)) =
            self.text.split_last_mut().and_then(|(last, rest)| Some((last, rest.get_mut(self.length)?)))
        {
            *place = byte;
            self.length += 1;
        }
        self
    }

    pub fn word(self, word: &str) -> Self {
        let line = word.bytes().fold(self, Self::byte);
        line.byte(b' ')
    }

    /// In hexadecimal digits.
    pub fn bits(self, bits: u64) -> Self {
        let digit = |shift: u32| {
            let digit = (bits >> shift) as u8 & 0xf;
            if digit < 10 { b'0' + digit } else { b'a' + digit - 10 }
        };
        let line = (0..16).rev().fold(self, |line, place| line.byte(digit(4 * place)));
        line.byte(b' ')
    }

    /// In decimal digits.
    pub fn number(self, number: u32) -> Self {
        let mut power: u32 = 1_000_000_000;
        let mut line = self;
        while power > 0 {
            let digit = (number / power % 10) as u8;
            if number >= power || power == 1 {
                line = line.byte(b'0' + digit);
            }
            power /= 10;
        }
        line.byte(b' ')
    }

    pub fn write(self) {
        machine::write(&self.byte(b'\n').text);
    }
}
