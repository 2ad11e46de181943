//! A number that tells layouts apart.

use dalembert::system::Described;

use crate::{Field, FieldType, Fields};

/// A number that stands for the layout of memory and parameters of a system by a rule: FNV-1a over names,
/// types and offsets, the rule and the version of the library. Header and library of different builds differ
/// in it.
#[must_use]
pub const fn layout<S, const N: usize>(name: &str, rule: &str) -> u64
where
    S: Described<N> + Fields,
    S::Scalar: FieldType,
{
    let words = [name, rule, <S::Scalar as FieldType>::BASE];
    let sizes = [N, S::INPUTS, S::PARAMETERS.len(), S::TAKES_TIME as usize, size_of::<S::Given>()];
    let hash = hashed(S::FIELDS, &words, &sizes);
    let hash = if S::CONSTRAINTS > 0 { with_number(hash, S::CONSTRAINTS) } else { hash };
    if S::OUTPUTS > 0 { with_number(with_text(hash, "outputs"), S::OUTPUTS) } else { hash }
}

const fn hashed(fields: &[Field], words: &[&str], sizes: &[usize]) -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325;
    let mut i = 0;
    while i < fields.len() {
        let Field { name, base, dimensions, is_table, offset, .. } = fields[i];
        hash = with_number(with_text(with_text(hash, name), base), offset);
        hash = with_numbers(hash, dimensions);
        if is_table {
            hash = with_text(hash, "table");
        }
        i += 1;
    }
    let mut i = 0;
    while i < words.len() {
        hash = with_text(hash, words[i]);
        i += 1;
    }
    with_numbers(with_text(hash, env!("CARGO_PKG_VERSION")), sizes)
}

const fn with_text(mut hash: u64, text: &str) -> u64 {
    let bytes = text.as_bytes();
    let mut i = 0;
    while i < bytes.len() {
        hash = (hash ^ bytes[i] as u64).wrapping_mul(0x100_0000_01b3);
        i += 1;
    }
    // A byte that no text has: ("ab", "c") is not ("a", "bc").
    (hash ^ 0xff).wrapping_mul(0x100_0000_01b3)
}

const fn with_number(hash: u64, number: usize) -> u64 {
    (hash ^ number as u64).wrapping_mul(0x100_0000_01b3)
}

const fn with_numbers(mut hash: u64, numbers: &[usize]) -> u64 {
    let mut i = 0;
    while i < numbers.len() {
        hash = with_number(hash, numbers[i]);
        i += 1;
    }
    with_number(hash, numbers.len())
}
