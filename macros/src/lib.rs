//! The attribute macro of dalembert. Use it through the crate `dalembert`, which re-exports it.

use proc_macro::TokenStream;

/// x
#[proc_macro_attribute]
pub fn rayleigh_system(attribute: TokenStream, item: TokenStream) -> TokenStream {
    let _ = attribute;
    item
}
