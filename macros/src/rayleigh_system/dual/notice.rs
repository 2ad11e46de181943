//! Notices about dual numbers: a warning where nobody asked for them, an error where they cannot run.
//!
//! Neither changes what is generated.

use proc_macro2::{Literal, TokenStream};
use quote::{quote, quote_spanned};

use super::super::diagnostics::{Note, span_of};
use super::super::lower::Refusal;
use super::super::model::System;
use super::super::write::item::conditions;
use super::super::write::notice;

/// The most coordinates that a step by dual numbers has the stack for, on a thread of 2 MiB, the least of
/// Rust's defaults.
///
/// Measured without optimisation, by the midpoint, the trapezoidal and a Gauss rule: 48 coordinates step, 64
/// overflow it. What fills it are matrices of (2n)² entries.
const MOST_COORDINATES: usize = 32;

/// The most where third derivatives are asked for: their numbers hold (2n)² entries themselves, and 2n of
/// them are arguments.
const MOST_OF_THIRD: usize = 8;

/// The warning at the token that could not be followed.
pub fn warning(system: &System<'_>, refusal: &Refusal) -> TokenStream {
    let note = Note::DualNumbers { system: system.name.to_string(), reason: refusal.reason.clone() };
    notice::warning(system, "derivatives_by_dual_numbers", &note, refusal.span)
}

/// The error where the stack would not do.
pub fn bound(system: &System<'_>) -> TokenStream {
    let conditions = conditions(system.source);
    let n = system.degrees.times(1);
    let most = if system.second { MOST_OF_THIRD } else { MOST_COORDINATES };
    let text = Note::TooManyForDualNumbers { most }.to_string();
    let most = Literal::usize_unsuffixed(most);
    let assertion = quote_spanned!(span_of(&system.degrees.length)=> ::core::assert!(#n <= #most, #text));
    quote! {
        #(#conditions)*
        const _: () = #assertion;
    }
}
