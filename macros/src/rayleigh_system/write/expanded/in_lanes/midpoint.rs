//! The midpoint rule's equation of several members: `step_kernel` and `momenta` on members.

use super::*;

impl Text<'_> {
    /// The functions of `DiscreteInLanes`.
    pub(super) fn midpoint_in_lanes(
        &self,
        [kernel, momenta]: &[StraightLine; 2],
        fields: &OfMembers<'_>,
        diagonals: Option<usize>,
    ) -> TokenStream {
        let is_timed = self.system.is_timed();
        let (scalar, n, members) = (&self.system.scalar, self.system.degrees.times(1), &fields.members);
        let vector = fields.vector(&n);
        let row = diagonals.map(|diagonals| fields.vector(&Literal::usize_unsuffixed(diagonals)));
        let row = row.as_ref().unwrap_or(&vector);

        let function = |name: &str, line: &StraightLine, result: TokenStream, ty: TokenStream| {
            let apart = fields.read_by(line, is_timed, "now");
            let of_fields = parameter("fields", apart.is_some());
            let name = format_ident!("{name}");
            let body = self.at_midpoint(line, &quote!(now), unused, result);
            quote! {
                #[inline(always)]
                fn #name<'s, const #members: usize>(
                    #of_fields: &Self::Fields<'s, #members>,
                    q0: &#vector,
                    v: &#vector,
                    h: #scalar,
                ) -> #ty
                where
                    Self: 's,
                {
                    #apart
                    #body
                }
            }
        };
        let (p0, entries) = kernel.outputs.split_at(self.derived.n);
        let rows: Vec<TokenStream> = match diagonals {
            Some(diagonals) => entries.chunks(diagonals).map(|row| quote!([#(#row),*])).collect(),
            None => (0..self.derived.n)
                .map(|i| {
                    let row = (0..self.derived.n).map(|j| &entries[j * self.derived.n + i]);
                    quote!([#(#row),*])
                })
                .collect(),
        };
        let result = quote!(([#(#p0),*], [#(#rows),*]));
        let ty = quote!((#vector, [#row; #n]));
        let step_kernel = function("step_kernel_in_lanes", kernel, result, ty);
        let (p0, p1) = momenta.outputs.split_at(self.derived.n);
        let result = quote!([[#(#p0),*], [#(#p1),*]]);
        let momenta = function("momenta_in_lanes", momenta, result, quote!([#vector; 2]));
        quote! {
            #step_kernel

            #momenta
        }
    }
}
