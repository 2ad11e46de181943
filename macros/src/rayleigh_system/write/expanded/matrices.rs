//! Outputs in vectors and matrices.

use super::*;

impl Text<'_> {
    /// Splits outputs into scalars, vectors and matrices.
    pub(super) fn parts<const K: usize>(
        &self,
        outputs: &[TokenStream],
        shapes: [Shape; K],
    ) -> [TokenStream; K] {
        let mut rest = outputs;
        shapes.map(|shape| {
            let (own, after) = rest.split_at(match shape {
                Shape::Scalar => 1,
                Shape::Vector => self.derived.n,
                Shape::Matrix => self.derived.n * self.derived.n,
            });
            rest = after;
            match shape {
                Shape::Scalar => own[0].clone(),
                Shape::Vector if are_zeros(own) => quote!(SVector::zeros()),
                Shape::Vector => quote!(SVector::from([#(#own),*])),
                Shape::Matrix => matrix(own, self.derived.n),
            }
        })
    }

    /// The matrix of the entries that its form keeps.
    pub(super) fn matrix_in_form(&self, entries: &[TokenStream], diagonals: Option<usize>) -> TokenStream {
        let Some(diagonals) = diagonals else { return matrix(entries, self.derived.n) };
        let rows = entries.chunks(diagonals).map(|row| quote!([#(#row),*]));
        quote!(::dalembert::generated::Banded { rows: [#(#rows),*] })
    }
}

/// The shape of an output.
#[derive(Clone, Copy)]
pub enum Shape {
    Scalar,
    Vector,
    Matrix,
}

/// The matrix of these entries, column by column.
pub fn matrix(entries: &[TokenStream], rows: usize) -> TokenStream {
    if are_zeros(entries) {
        return quote!(SMatrix::zeros());
    }
    let columns = entries.chunks(rows).map(|column| quote!([#(#column),*]));
    quote!(SMatrix::from([#(#columns),*]))
}

/// Whether all entries are the constant 0.
fn are_zeros(entries: &[TokenStream]) -> bool {
    entries.iter().all(|entry| entry.to_string() == "0.0")
}
