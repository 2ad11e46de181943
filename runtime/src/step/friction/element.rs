//! The components of one element of friction among those of all: none is looked up by an index that could be
//! outside.

use nalgebra::SVector;

use crate::numbers::Scalar;

/// The elements that have so many components each.
pub(super) fn elements(sizes: &[usize]) -> impl Iterator<Item = Element> + Clone {
    sizes.iter().scan(0, |next, &size| {
        let first = *next;
        *next += size;
        Some(Element { first, size })
    })
}

/// An element: its first component, and how many it has.
#[derive(Clone, Copy)]
pub(super) struct Element {
    pub(super) first: usize,
    pub(super) size: usize,
}

impl Element {
    /// The entries of its components.
    pub(super) fn of<T>(self, entries: &[T]) -> impl Iterator<Item = &T> + Clone {
        entries.iter().skip(self.first).take(self.size)
    }

    pub(super) fn of_mut<T>(self, entries: &mut [T]) -> impl Iterator<Item = &mut T> {
        entries.iter_mut().skip(self.first).take(self.size)
    }

    pub(super) fn dot<S: Scalar, const M: usize>(self, a: &SVector<S, M>, b: &SVector<S, M>) -> S {
        let products = self.of(a.as_slice()).zip(self.of(b.as_slice()));
        products.fold(S::zero(), |sum, (a, b)| sum + *a * *b)
    }

    pub(super) fn length<S: Scalar, const M: usize>(self, a: &SVector<S, M>) -> S {
        self.dot(a, a).sqrt()
    }

    /// The first of its entries.
    pub(super) fn head<T: Copy>(self, entries: &[T]) -> Option<T> {
        entries.get(self.first).copied()
    }

    pub(super) fn write_head<T>(self, entries: &mut [T], value: T) {
        if let Some(entry) = entries.get_mut(self.first) {
            *entry = value;
        }
    }

    pub(super) fn divide<S: Scalar, const M: usize>(self, a: &mut SVector<S, M>, by: S) {
        self.of_mut(a.as_mut_slice()).for_each(|entry| *entry /= by);
    }

    /// The vector on its components alone.
    pub(super) fn part<S: Scalar, const M: usize>(self, of: &SVector<S, M>) -> SVector<S, M> {
        let mut part: SVector<S, M> = nalgebra::zero();
        self.of_mut(part.as_mut_slice()).zip(self.of(of.as_slice())).for_each(|(part, of)| *part = *of);
        part
    }
}
