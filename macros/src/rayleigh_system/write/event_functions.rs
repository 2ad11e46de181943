//! Event functions, as the user wrote them: `EventFunctions`.

use proc_macro2::TokenStream;
use quote::quote;

use super::super::model::{Home, System};
use super::super::parts::Part;
use super::view::{subject, value};

/// `impl EventFunctions<2, 1> for Ring`, and for its view if it has one; nothing where the block has none.
pub fn event_functions(system: &System<'_>) -> Option<TokenStream> {
    let count = system.events.as_ref()?.times(1);
    let (scalar, n) = (&system.scalar, system.degrees.times(1));
    let home = system.home_of(Part::Events);
    let of_trait = quote!(::dalembert::generated::EventFunctions);
    let implemented = |home, value| {
        let subject = subject(system, home);
        quote! {
            #[automatically_derived]
            impl #of_trait<#n, #count> for #subject {
                #[inline]
                fn events(&self, q: &Vector, v: &Vector) -> [#scalar; #count] {
                    #value
                }
            }
        }
    };
    let own = implemented(home, value(system, Part::Events));
    let of_view = (home == Home::System && system.has_view())
        .then(|| implemented(Home::View, quote!(#of_trait::events(self.system, q, v))));
    Some(quote!(#own #of_view))
}
