//! An explicit system of several members at once: the text of the functions of `Explicit` on other numbers, so
//! that what every member gets is its own to the last bit.

use super::super::emit::{Field, number_of_members, on_members};
use super::super::syntax::regrouped;
use super::*;
use proc_macro2::TokenTree;
use quote::ToTokens;

/// What `ExplicitInLanes` asks for, as `Explicit` computes it.
pub(super) struct ExplicitOutputs<'o> {
    pub force: &'o [Node],
    pub p0: &'o [Node],
    pub p1: &'o [Node],
}

impl Code<'_> {
    /// The functions of `ExplicitInLanes`; nothing where a field is read within a condition, since fields are
    /// read before.
    pub(super) fn explicit_in_lanes(&mut self, outputs: &ExplicitOutputs<'_>) -> Option<TokenStream> {
        let ExplicitOutputs { force, p0, p1 } = outputs;
        let momenta = [*p0, *p1].concat();
        if self.graph.is_conditional(force.iter().chain(&momenta).copied()) {
            return None;
        }
        let scalar = &self.system.scalar;
        let taken = ["q", "v", "h", "half", "fields", "systems"];
        let written = |outputs: &[Node]| {
            let mut line = on_members(&self.graph, scalar, outputs, &taken, self.is_portable);
            if self.home == Home::View {
                let seen = |tokens| view::seen_from_view(tokens, &self.system.name);
                line.statements = seen(line.statements);
                line.outputs = line.outputs.into_iter().map(seen).collect();
                // The view itself holds the input.
                let is_input =
                    |field: &Field| matches!(self.graph.operation(field.node), Operation::Input(_));
                for field in line.fields.iter_mut().filter(|field| !is_input(field)) {
                    field.tokens = seen(field.tokens.clone());
                }
            }
            line
        };
        let (force, momenta) = (written(force), written(&momenta));
        let mut read: Vec<&Field> = force.fields.iter().chain(&momenta.fields).collect();
        read.sort_by_key(|field| (field.is_truth, field.node));
        read.dedup_by_key(|field| field.node);

        let (n, members) = (self.system.degrees.times(1), number_of_members(&self.graph));
        let number = Group { ty: quote!(Members), argument: quote!(#scalar,), of_truths: false };
        let truth = Group { ty: quote!(Mask), argument: TokenStream::new(), of_truths: true };
        let groups: Vec<Group> =
            [number, truth].into_iter().filter(|group| group.fields(&read).next().is_some()).collect();
        let ty = tuple(groups.iter().map(|group| {
            let (ty, argument) = (&group.ty, &group.argument);
            let length = Literal::usize_unsuffixed(group.fields(&read).count());
            quote!([#ty<#argument #members>; #length])
        }));
        let values = tuple(groups.iter().map(|group| {
            let ty = &group.ty;
            let tokens = group.fields(&read).map(|field| seen_from_member(field.tokens.clone()));
            quote!([#(#ty(systems.map(|system| #tokens))),*])
        }));
        // `let [k, _] = *fields;`
        let taken_apart = |line: &StraightLine| {
            let pattern = tuple(groups.iter().map(|group| {
                let names = group.fields(&read).map(|field| {
                    let own = line.fields.iter().find(|own| own.node == field.node);
                    own.map_or_else(|| quote!(_), |own| own.name.to_token_stream())
                });
                quote!([#(#names),*])
            }));
            (!line.fields.is_empty()).then(|| quote!(let #pattern = *fields;))
        };
        let of_fields = |line: &StraightLine| parameter("fields", !line.fields.is_empty());
        let systems = parameter("systems", !groups.is_empty());
        let gathered = quote! {
            type Fields<const #members: usize> = #ty;

            fn fields<const #members: usize>(#systems: [&Self; #members]) -> Self::Fields<#members> {
                #values
            }
        };

        let (fields, apart, statements) = (of_fields(&momenta), taken_apart(&momenta), &momenta.statements);
        let half = momenta.uses("half").then(|| quote!(let half = 0.5 * h;));
        let (v, h) =
            (parameter("v", momenta.uses_velocities), parameter("h", half.is_some() || momenta.uses("h")));
        let (p0, p1) = momenta.outputs.split_at(self.n);
        let velocity_momenta = quote! {
            #[inline(always)]
            fn velocity_momenta_in_lanes<const #members: usize>(
                #fields: &Self::Fields<#members>,
                #v: &MemberVector<#scalar, #n, #members>,
                #h: #scalar,
            ) -> [MemberVector<#scalar, #n, #members>; 2] {
                #apart
                #half
                #statements
                [[#(#p0),*], [#(#p1),*]]
            }
        };

        let (fields, apart, statements) = (of_fields(&force), taken_apart(&force), &force.statements);
        let (q, outputs) = (parameter("q", force.uses_coordinates), &force.outputs);
        Some(quote! {
            #gathered

            #velocity_momenta

            #[inline(always)]
            fn configuration_force_in_lanes<const #members: usize>(
                #fields: &Self::Fields<#members>,
                #q: &MemberVector<#scalar, #n, #members>,
            ) -> MemberVector<#scalar, #n, #members> {
                #apart
                #statements
                [#(#outputs),*]
            }
        })
    }
}

/// Fields of one type.
struct Group {
    ty: TokenStream,
    argument: TokenStream,
    of_truths: bool,
}

impl Group {
    fn fields<'f>(&self, read: &[&'f Field]) -> impl Iterator<Item = &'f Field> {
        read.iter().copied().filter(|field| field.is_truth == self.of_truths)
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
