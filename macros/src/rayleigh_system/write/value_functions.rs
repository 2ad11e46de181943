//! Functions whose values alone are asked for, as the user wrote them: `EventFunctions`, `OutputFunctions`.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::super::model::{Home, System};
use super::super::parts::Part;
use super::view::{subject, value};

/// `impl EventFunctions<2, 1> for Ring`, and for its view if it has one; nothing where the block has none.
pub fn value_functions(system: &System<'_>) -> TokenStream {
    Part::VALUES.into_iter().filter_map(|part| implemented(system, part)).collect()
}

fn implemented(system: &System<'_>, part: Part) -> Option<TokenStream> {
    let count = system.value_count(part)?;
    let of_trait = match part {
        Part::Events => quote!(::dalembert::generated::EventFunctions),
        _ => quote!(::dalembert::generated::OutputFunctions),
    };
    let (scalar, n) = (&system.scalar, system.degrees.times(1));
    let (function, home) = (format_ident!("{}", part.name()), system.home_of(part));
    let of = |home, value| {
        let subject = subject(system, home);
        quote! {
            #[automatically_derived]
            impl #of_trait<#n, #count> for #subject {
                #[inline]
                fn #function(&self, q: &Vector, v: &Vector) -> [#scalar; #count] {
                    #value
                }
            }
        }
    };
    let own = of(home, value(system, part));
    let of_view = (home == Home::System && system.has_view())
        .then(|| of(Home::View, quote!(#of_trait::#function(self.system, q, v))));
    Some(quote!(#own #of_view))
}
