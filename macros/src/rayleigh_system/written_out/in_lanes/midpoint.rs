//! The midpoint rule's equation of several members: `step_kernel` and `momenta` on members.

use super::*;

/// The outputs that `DiscreteInLanes` asks for.
pub(in super::super) struct MidpointLines {
    /// p0, and the entries of its matrix in the form that they are kept in.
    kernel: StraightLine,
    /// p0 and p1.
    momenta: StraightLine,
    diagonals: Option<usize>,
}

/// The names of parameters, and of what the frame declares.
pub(in super::super) const TAKEN_AT_MIDPOINT: [&str; 7] = ["q", "q0", "v", "h", "half", "fields", "systems"];

impl Code<'_> {
    /// Code for outputs as `Fused` computes them, the matrix with so many diagonals; nothing where a field is
    /// read within a condition, since fields are read before.
    pub(in super::super) fn midpoint_lines(
        &mut self,
        kernel: &[Node],
        momenta: &[Node],
        diagonals: Option<usize>,
    ) -> Option<MidpointLines> {
        if self.graph.is_conditional(kernel.iter().chain(momenta).copied()) {
            return None;
        }
        let kernel = self.on_members(kernel, &TAKEN_AT_MIDPOINT, &[], None);
        let momenta = self.on_members(momenta, &TAKEN_AT_MIDPOINT, &[], None);
        Some(MidpointLines { kernel, momenta, diagonals })
    }
}

impl MidpointLines {
    /// The fields that the code reads.
    pub(super) fn fields(&self) -> impl Iterator<Item = &Field> {
        self.kernel.fields.iter().chain(&self.momenta.fields)
    }

    /// The functions of `DiscreteInLanes`.
    pub(super) fn written(&self, code: &Code<'_>, fields: &OfMembers) -> TokenStream {
        let Self { kernel, momenta, diagonals } = self;
        let is_timed = code.system.timed.any();
        let (scalar, n, members) = (&code.system.scalar, code.system.degrees.times(1), &fields.members);
        let width = diagonals
            .map_or_else(|| n.clone(), |diagonals| Literal::usize_unsuffixed(diagonals).to_token_stream());

        let function = |name: &str, line: &StraightLine, result: TokenStream, ty: TokenStream| {
            let apart = fields.read_by(line, is_timed, "now");
            let of_fields = parameter("fields", apart.is_some());
            let name = format_ident!("{name}");
            let body = code.at_midpoint(line, &quote!(now), unused, result);
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
        let (p0, entries) = kernel.outputs.split_at(code.n);
        let rows: Vec<TokenStream> = match diagonals {
            Some(diagonals) => entries.chunks(*diagonals).map(|row| quote!([#(#row),*])).collect(),
            None => (0..code.n)
                .map(|i| {
                    let row = (0..code.n).map(|j| &entries[j * code.n + i]);
                    quote!([#(#row),*])
                })
                .collect(),
        };
        let result = quote!(([#(#p0),*], [#(#rows),*]));
        let ty = quote!((#vector, [MemberVector<#scalar, #width, #members>; #n]));
        let step_kernel = function("step_kernel_in_lanes", kernel, result, ty);
        let (p0, p1) = momenta.outputs.split_at(code.n);
        let result = quote!([[#(#p0),*], [#(#p1),*]]);
        let momenta = function("momenta_in_lanes", momenta, result, quote!([#vector; 2]));
        quote! {
            #step_kernel

            #momenta
        }
    }
}
