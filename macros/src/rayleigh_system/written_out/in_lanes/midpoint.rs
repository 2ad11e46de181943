//! The midpoint rule's equation of several members: `step_kernel` and `momenta` on members.

use super::*;

/// The outputs that `DiscreteInLanes` asks for, as `Discrete` computes them.
pub(in super::super) struct MidpointOutputs<'o> {
    /// p0, and the entries of its matrix in the form that they are kept in.
    pub kernel: &'o [Node],
    /// p0 and p1.
    pub momenta: &'o [Node],
    pub diagonals: Option<usize>,
}

/// The names of parameters, and of what the frame declares.
pub(in super::super) const TAKEN_AT_MIDPOINT: [&str; 7] = ["q", "q0", "v", "h", "half", "fields", "systems"];

impl Code<'_> {
    /// The functions of `DiscreteInLanes`; nothing where a field is read within a condition, since fields are
    /// read before.
    pub(in super::super) fn midpoint_in_lanes(
        &mut self,
        outputs: &MidpointOutputs<'_>,
    ) -> Option<TokenStream> {
        let MidpointOutputs { kernel, momenta, diagonals } = *outputs;
        if self.graph.is_conditional(kernel.iter().chain(momenta).copied()) {
            return None;
        }
        let kernel = self.on_members(kernel, &TAKEN_AT_MIDPOINT, &[], None);
        let momenta = self.on_members(momenta, &TAKEN_AT_MIDPOINT, &[], None);
        let fields = OfMembers::fields_of(self, [&kernel, &momenta]);
        let is_timed = self.system.is_timed();
        let timed = is_timed.then(|| {
            quote!(
                const IS_TIMED: bool = true;
            )
        });
        let gathered = self.gathered(&fields);
        let (scalar, n, members) = (&self.system.scalar, self.system.degrees.times(1), &fields.members);
        let width = diagonals
            .map_or_else(|| n.clone(), |diagonals| Literal::usize_unsuffixed(diagonals).to_token_stream());

        let function = |name: &str, line: &StraightLine, result: TokenStream, ty: TokenStream| {
            let apart = fields.read_by(line, is_timed, "now");
            let of_fields = parameter("fields", apart.is_some());
            let name = format_ident!("{name}");
            let body = self.at_midpoint(line, &quote!(now), unused, result);
            quote! {
                #[inline(always)]
                fn #name<const #members: usize>(
                    #of_fields: &Self::Fields<#members>,
                    q0: &MemberVector<#scalar, #n, #members>,
                    v: &MemberVector<#scalar, #n, #members>,
                    h: #scalar,
                ) -> #ty {
                    #apart
                    #body
                }
            }
        };
        let vector = quote!(MemberVector<#scalar, #n, #members>);
        let (p0, entries) = kernel.outputs.split_at(self.n);
        let rows: Vec<TokenStream> = match diagonals {
            Some(diagonals) => entries.chunks(diagonals).map(|row| quote!([#(#row),*])).collect(),
            None => (0..self.n)
                .map(|i| {
                    let row = (0..self.n).map(|j| &entries[j * self.n + i]);
                    quote!([#(#row),*])
                })
                .collect(),
        };
        let result = quote!(([#(#p0),*], [#(#rows),*]));
        let ty = quote!((#vector, [MemberVector<#scalar, #width, #members>; #n]));
        let step_kernel = function("step_kernel_in_lanes", &kernel, result, ty);
        let (p0, p1) = momenta.outputs.split_at(self.n);
        let result = quote!([[#(#p0),*], [#(#p1),*]]);
        let momenta = function("momenta_in_lanes", &momenta, result, quote!([#vector; 2]));
        Some(quote! {
            #timed

            #gathered

            #step_kernel

            #momenta
        })
    }
}
