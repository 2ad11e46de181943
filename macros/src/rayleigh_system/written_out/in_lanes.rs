//! The force of an explicit system, of several members at once: the text of `configuration_force` on other
//! numbers, so that every member's force is its own to the last bit.

use super::super::emit::{Field, number_of_members, on_members};
use super::super::syntax::regrouped;
use super::*;
use proc_macro2::TokenTree;

impl Code<'_> {
    /// What `ExplicitInLanes` asks for, of the force as `configuration_force` computes it; nothing where a
    /// field is read within a condition, since fields are read before.
    pub(super) fn explicit_in_lanes(&mut self, force: &[Node]) -> Option<TokenStream> {
        if self.graph.is_conditional(force.iter().copied()) {
            return None;
        }
        let scalar = &self.system.scalar;
        let line = on_members(&self.graph, scalar, force, &["q", "fields", "systems"], self.is_portable);
        let (n, members) = (self.system.degrees.times(1), number_of_members(&self.graph));
        let (numbers, truths): (Vec<&Field>, Vec<&Field>) =
            line.fields.iter().partition(|field| !field.is_truth);
        let read = |field: &&Field| {
            let read = seen_from_member(field.tokens.clone());
            quote!(systems.map(|system| #read))
        };
        let of_numbers = Group {
            ty: quote!(Members<#scalar, #members>),
            values: numbers.iter().map(read).map(|read| quote!(Members(#read))).collect(),
            names: numbers.iter().map(|field| &field.name).collect(),
        };
        let of_truths = Group {
            ty: quote!(Mask<#members>),
            values: truths.iter().map(read).map(|read| quote!(Mask(#read))).collect(),
            names: truths.iter().map(|field| &field.name).collect(),
        };
        let groups: Vec<Group> =
            [of_numbers, of_truths].into_iter().filter(|group| !group.names.is_empty()).collect();
        let ty = tuple(groups.iter().map(Group::array_type));
        let values = tuple(groups.iter().map(Group::array));
        let names = tuple(groups.iter().map(Group::pattern));
        let taken_apart = (!groups.is_empty()).then(|| quote!(let #names = *fields;));
        let (fields, systems) =
            (parameter("fields", !groups.is_empty()), parameter("systems", !groups.is_empty()));
        let (q, statements, outputs) =
            (parameter("q", line.uses_coordinates), &line.statements, &line.outputs);
        Some(quote! {
            type Fields<const #members: usize> = #ty;

            fn fields<const #members: usize>(#systems: [&Self; #members]) -> Self::Fields<#members> {
                #values
            }

            #[inline(always)]
            fn configuration_force_in_lanes<const #members: usize>(
                #fields: &Self::Fields<#members>,
                #q: &MemberVector<#scalar, #n, #members>,
            ) -> MemberVector<#scalar, #n, #members> {
                #taken_apart
                #statements
                [#(#outputs),*]
            }
        })
    }
}

/// Fields of one type.
struct Group<'l> {
    ty: TokenStream,
    values: Vec<TokenStream>,
    names: Vec<&'l Ident>,
}

impl Group<'_> {
    fn array_type(&self) -> TokenStream {
        let (ty, length) = (&self.ty, Literal::usize_unsuffixed(self.names.len()));
        quote!([#ty; #length])
    }

    fn array(&self) -> TokenStream {
        let values = &self.values;
        quote!([#(#values),*])
    }

    fn pattern(&self) -> TokenStream {
        let names = &self.names;
        quote!([#(#names),*])
    }
}

/// `()`, the one, or all of them in brackets.
fn tuple(parts: impl Iterator<Item = TokenStream>) -> TokenStream {
    let parts: Vec<TokenStream> = parts.collect();
    match &parts[..] {
        [one] => one.clone(),
        parts => quote!((#(#parts),*)),
    }
}

/// The tokens with `system` for `self`.
fn seen_from_member(tokens: TokenStream) -> TokenStream {
    tokens
        .into_iter()
        .map(|token| match token {
            TokenTree::Ident(word) if word == "self" => Ident::new("system", word.span()).into(),
            TokenTree::Group(group) => regrouped(&group, seen_from_member(group.stream())),
            other => other,
        })
        .collect()
}
