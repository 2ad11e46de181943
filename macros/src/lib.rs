//! The attribute macros of dalembert. Use them through the crate `dalembert`, which re-exports them.

use proc_macro::TokenStream;

mod rayleigh_system;
#[cfg(test)]
mod tests;

#[allow(
    missing_docs,
    reason = "documented where `dalembert` re-exports it, beside the types that the examples use"
)]
#[proc_macro_attribute]
pub fn rayleigh_system(attribute: TokenStream, item: TokenStream) -> TokenStream {
    rayleigh_system::rayleigh_system(attribute.into(), item.into()).into()
}

#[allow(
    missing_docs,
    reason = "documented where `dalembert` re-exports it, beside the types that the examples use"
)]
#[proc_macro_attribute]
pub fn differentiable(attribute: TokenStream, item: TokenStream) -> TokenStream {
    rayleigh_system::differentiable(attribute.into(), item.into()).into()
}
