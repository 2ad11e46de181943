//! Explicit steps of several members: the functions of `Explicit` on members.

use super::*;

impl Text<'_> {
    /// The functions of `ExplicitInLanes`.
    pub(super) fn explicit_in_lanes(&self, lines: &[StraightLine; 2], fields: &OfMembers<'_>) -> TokenStream {
        let [momenta, force] = lines;
        let is_timed = self.system.is_timed();
        let (scalar, members) = (&self.system.scalar, &fields.members);
        let vector = fields.vector(&self.system.degrees.times(1));

        let (apart, statements) = (fields.read_by(momenta, is_timed, "t"), &momenta.statements);
        let half = momenta.half();
        let of_fields = parameter("fields", apart.is_some());
        let (v, h) =
            (parameter("v", momenta.uses_velocities), parameter("h", half.is_some() || momenta.uses("h")));
        let (p0, p1) = momenta.outputs.split_at(self.derived.n);
        let velocity_momenta = quote! {
            #[inline(always)]
            fn velocity_momenta_in_lanes<'s, const #members: usize>(
                #of_fields: &Self::Fields<'s, #members>,
                #v: &#vector,
                #h: #scalar,
            ) -> [#vector; 2]
            where
                Self: 's,
            {
                #apart
                #half
                #statements
                [[#(#p0),*], [#(#p1),*]]
            }
        };

        let (apart, statements) = (fields.read_by(force, is_timed, "t"), &force.statements);
        let of_fields = parameter("fields", apart.is_some());
        let (q, outputs) = (parameter("q", force.uses_coordinates), &force.outputs);
        quote! {
            #velocity_momenta

            #[inline(always)]
            fn configuration_force_in_lanes<'s, const #members: usize>(
                #of_fields: &Self::Fields<'s, #members>,
                #q: &#vector,
            ) -> #vector
            where
                Self: 's,
            {
                #apart
                #statements
                [#(#outputs),*]
            }
        }
    }
}
