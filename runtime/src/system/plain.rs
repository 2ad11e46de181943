//! Types and methods that derivatives are taken of: where a name may be a user's own, rustc has to agree.

use crate::system::Quantity;

/// The number type `S` or `bool`: what a field or constant of a system is where a body computes with it.
///
/// `#[rayleigh_system]` sees the tokens of a body and not its types. A type with operators of its own, or a
/// `Deref`, would be another function than the one that derivatives are taken of: rustc has to find this
/// trait on all that is taken for a number, or for a `bool`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not `{S}`: a reference, or a type that may have operators of its own",
    label = "derivatives are taken as if this were `{S}`",
    note = "take the number out of it where it stands, as in `self.k.0` or `*self.k`"
)]
pub trait Plain<S> {
    /// Whether it is NaN.
    fn is_no_number(&self) -> bool;
}

impl Plain<Self> for f64 {
    fn is_no_number(&self) -> bool {
        self.is_nan()
    }
}

impl Plain<Self> for f32 {
    fn is_no_number(&self) -> bool {
        self.is_nan()
    }
}

impl Plain<Self> for bool {
    fn is_no_number(&self) -> bool {
        false
    }
}

/// The fields and constants that the derivatives of a system take for numbers and truth values, and the
/// methods that they take for those of slices.
pub trait PlainFields {
    /// Uses those that [`first_no_number`](Self::first_no_number) does not. It is there to be checked: with
    /// a parameter, it is never compiled.
    fn plain_fields<Never>(&self) {}

    /// Uses the first numbers among them, by name: the first that is NaN.
    #[cold]
    fn first_no_number(&self) -> Option<(Quantity, usize)> {
        None
    }
}

/// The result of [`SliceMethods`].
#[derive(Clone, Copy, Debug)]
pub struct OfSlice;

/// Methods of arrays that are those of slices, unless a trait in scope has one of that name for arrays: rustc
/// then finds two where generated code calls one of these.
#[allow(missing_docs, clippy::len_without_is_empty, reason = "names of the methods of slices")]
pub trait SliceMethods {
    fn chunks(&self) -> OfSlice {
        OfSlice
    }

    fn chunks_exact(&self) -> OfSlice {
        OfSlice
    }

    fn iter(&self) -> OfSlice {
        OfSlice
    }

    fn len(&self) -> OfSlice {
        OfSlice
    }

    fn windows(&self) -> OfSlice {
        OfSlice
    }
}

impl<T, const N: usize> SliceMethods for [T; N] {}
