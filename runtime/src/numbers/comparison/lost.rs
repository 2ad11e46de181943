//! Derivatives that are NaN or infinite.

use crate::numbers::Precision;

pub(super) fn coordinate<S: Precision>(by_one: [&[S]; 2], by_two: [&[S]; 3]) -> Option<usize> {
    let size = by_one[0].len();
    let row = |i: usize| (0..size).map(move |j| i + size * j);
    let column = |i: usize| (0..size).map(move |j| size * i + j);
    (0..size).find(|&i| {
        by_one.into_iter().any(|of| is_lost(of, i))
            || by_two.into_iter().any(|of| row(i).any(|entry| is_lost(of, entry)))
            || column(i).any(|entry| is_lost(by_two[1], entry))
    })
}

pub(super) fn component<S: Precision>(value: &[S], by_one: [&[S]; 2]) -> Option<(usize, usize)> {
    let size = value.len();
    let coordinate = |i: usize| {
        let first = (0..by_one[0].len() / size.max(1))
            .find(|&j| by_one.into_iter().any(|of| is_lost(of, i + size * j)));
        first.or(if is_lost(value, i) { Some(i) } else { None })
    };
    (0..size).find_map(|i| Some((i, coordinate(i)?)))
}

pub(super) fn are_finite<S: Precision>(entries: &[S]) -> bool {
    entries.iter().all(|entry| entry.is_finite())
}

fn is_lost<S: Precision>(of: &[S], entry: usize) -> bool {
    of.get(entry).is_some_and(|entry| !entry.is_finite())
}
