//! Warnings at the user's tokens.
//!
//! Stable Rust has no warnings of macros; a deprecated constant, used at a token, makes rustc print one.

use proc_macro2::{Span, TokenStream};
use quote::{format_ident, quote, quote_spanned};
use syn::Ident;

use super::super::diagnostics::Note;
use super::super::model::System;
use super::item::{conditions, lint_levels};

/// The warning `note` at a token, which stands for a constant of this name.
pub fn warning(system: &System<'_>, name: &str, note: &Note, span: Span) -> TokenStream {
    let (conditions, levels) = (conditions(system.source), lint_levels(system.source));
    let (name, text) = (format_ident!("{name}"), note.to_string());
    let read = Ident::new(&name.to_string(), span);
    let read = quote_spanned!(span=> #read);
    quote! {
        #(#conditions)*
        #(#levels)*
        const _: () = {
            #[allow(non_upper_case_globals)]
            #[deprecated(note = #text)]
            const #name: () = ();
            #read
        };
    }
}

/// The warning that fused sums are calls of a function, where the target of the user's crate has no
/// instruction for them. None with lanes: a caller compiles those for what the machine has.
pub fn fused_by_calls(system: &System<'_>) -> Option<TokenStream> {
    let word = system.fused.as_ref().filter(|_| system.lanes.words().next().is_none())?;
    let warning = warning(system, "sums_fused_by_calls", &Note::FusedByCalls, word.span());
    Some(quote! {
        #[cfg(all(any(target_arch = "x86", target_arch = "x86_64"), not(target_feature = "fma")))]
        #warning
    })
}
