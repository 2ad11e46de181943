//! A stage of a Gauss rule of several members, in two functions: the rates, and what the momenta that they
//! lead to leave and correct. What the second needs of the first is handed over.

use super::super::stages::Anchors;
use super::*;

impl Text<'_> {
    /// The functions of `ForcedLagrangianInLanes`.
    pub(in super::super) fn stages_in_lanes(&self, functions: &[Routine; 2]) -> TokenStream {
        let [line, corrections] = functions.each_ref().map(|function| self.line(function));
        let handed = &functions[0].outputs[self.derived.n..];

        let is_handed = |field: &&Field| handed.contains(&field.node);
        let kept = corrections.fields.iter().filter(is_handed).map(|field| (field.node, field.is_truth));
        let kept = OfMembers::new(self, kept);
        let of_corrections = corrections.fields.iter().filter(|field| !is_handed(field));
        let fields = line.fields.iter().chain(of_corrections).map(|field| (field.node, field.is_truth));
        let fields = OfMembers::new(self, fields);
        let gathered = self.gathered(&fields);

        let (scalar, members) = (&self.system.scalar, &fields.members);
        let vector = fields.vector(&self.system.degrees.times(1));
        let (of_rates, of_kept) = line.outputs.split_at(self.derived.n);
        let handed_over = kept.value(|node| {
            let place = handed.iter().position(|&other| other == node);
            place.map_or_else(TokenStream::new, |place| of_kept[place].clone())
        });
        let is_timed = self.system.timed.any();
        let apart = fields.read_by(&line, is_timed, "t");
        let of_fields = parameter("fields", apart.is_some());
        let (q, v) = (parameter("q", line.uses_coordinates), parameter("v", line.uses_velocities));
        let (statements, kept_ty) = (&line.statements, kept.ty());
        let of_members = || {
            let of = self.name("Members");
            quote!(#of<#scalar, #members>)
        };
        let anchors = Anchors::new(&line, of_members, self.system.is_fused);
        let (anchors_ty, of_anchors, anchors_apart) = (&anchors.ty, &anchors.parameter, &anchors.apart);
        let rates = quote! {
            #[inline(always)]
            fn rates_in_lanes<const #members: usize>(
                #of_fields: &Self::Fields<#members>,
                #of_anchors: &mut Self::AnchorsInLanes<#members>,
                #q: &#vector,
                #v: &#vector,
            ) -> (#vector, Self::Kept<#members>) {
                #apart
                #anchors_apart
                #statements
                ([#(#of_rates),*], #handed_over)
            }
        };

        let (apart, kept_apart) =
            (fields.read_by(&corrections, is_timed, "t"), kept.taken_apart("kept", &corrections));
        let (of_fields, of_kept) =
            (parameter("fields", apart.is_some()), parameter("kept", !kept.is_empty()));
        let (v, p) = (parameter("v", corrections.uses_velocities), parameter("p", corrections.uses("p")));
        let (residuals, of_velocities) = corrections.outputs.split_at(self.derived.n);
        let statements = &corrections.statements;
        quote! {
            #gathered

            type Kept<const #members: usize> = #kept_ty;

            type AnchorsInLanes<const #members: usize> = #anchors_ty;

            #rates

            #[inline(always)]
            fn corrections_in_lanes<const #members: usize>(
                #of_fields: &Self::Fields<#members>,
                #of_kept: &Self::Kept<#members>,
                #v: &#vector,
                #p: &#vector,
            ) -> [#vector; 2] {
                #apart
                #kept_apart
                #statements
                [[#(#residuals),*], [#(#of_velocities),*]]
            }
        }
    }
}
