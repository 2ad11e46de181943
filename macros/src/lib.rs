//! The attribute macros of dalembert. Use them through the crate `dalembert`, which re-exports them.

use proc_macro::TokenStream;

mod rayleigh_system;
#[cfg(test)]
mod tests;

use rayleigh_system::Runtime;

#[allow(
    missing_docs,
    reason = "documented where `dalembert` re-exports it, beside the types that the examples use"
)]
#[proc_macro_attribute]
pub fn rayleigh_system(attribute: TokenStream, item: TokenStream) -> TokenStream {
    rayleigh_system::rayleigh_system(Runtime::STD, attribute.into(), item.into()).into()
}

#[allow(
    missing_docs,
    reason = "documented where `dalembert` re-exports it, beside the types that the examples use"
)]
#[proc_macro_attribute]
pub fn differentiable(attribute: TokenStream, item: TokenStream) -> TokenStream {
    rayleigh_system::differentiable(Runtime::STD, attribute.into(), item.into()).into()
}

/// `rayleigh_system` of a runtime with the features `std` and `libm`.
#[doc(hidden)]
#[proc_macro_attribute]
pub fn rayleigh_system_portable(attribute: TokenStream, item: TokenStream) -> TokenStream {
    rayleigh_system::rayleigh_system(Runtime::PORTABLE, attribute.into(), item.into()).into()
}

/// `rayleigh_system` of a runtime without the feature `std`.
#[doc(hidden)]
#[proc_macro_attribute]
pub fn rayleigh_system_core(attribute: TokenStream, item: TokenStream) -> TokenStream {
    rayleigh_system::rayleigh_system(Runtime::CORE, attribute.into(), item.into()).into()
}

/// `differentiable` of a runtime without the feature `std`.
#[doc(hidden)]
#[proc_macro_attribute]
pub fn differentiable_core(attribute: TokenStream, item: TokenStream) -> TokenStream {
    rayleigh_system::differentiable(Runtime::CORE, attribute.into(), item.into()).into()
}
