//! The attribute macro of dalembert. Use it through the crate `dalembert`, which re-exports it.

use proc_macro::TokenStream;

mod rayleigh_system;

/// Generates the discrete mechanical system of a Lagrangian and a Rayleigh function.
///
/// See the documentation of the crate `dalembert` for what it accepts and generates.
#[proc_macro_attribute]
pub fn rayleigh_system(attribute: TokenStream, item: TokenStream) -> TokenStream {
    rayleigh_system::rayleigh_system(attribute.into(), item.into()).into()
}
