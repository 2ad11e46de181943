//! Explicit steps of several members: the functions of `Explicit` on members.

use super::*;

/// The outputs that `ExplicitInLanes` asks for, as `Explicit` computes them.
pub(in super::super) struct ExplicitOutputs<'o> {
    pub force: &'o [Node],
    pub p0: &'o [Node],
    pub p1: &'o [Node],
}

impl Code<'_> {
    /// The functions of `ExplicitInLanes`; nothing where a field is read within a condition, since fields are
    /// read before.
    pub(in super::super) fn explicit_in_lanes(
        &mut self,
        outputs: &ExplicitOutputs<'_>,
    ) -> Option<TokenStream> {
        let ExplicitOutputs { force, p0, p1 } = outputs;
        let momenta = [*p0, *p1].concat();
        if self.graph.is_conditional(force.iter().chain(&momenta).copied()) {
            return None;
        }
        let force = self.on_members(force, &TAKEN, &[], None);
        let momenta = self.on_members(&momenta, &TAKEN, &[], None);
        let fields = OfMembers::fields_of(self, [&force, &momenta]);
        let is_timed = self.system.is_timed();
        let gathered = self.gathered(&fields);
        let (scalar, n, members) = (&self.system.scalar, self.system.degrees.times(1), &fields.members);

        let (apart, statements) = (fields.read_by(&momenta, is_timed, "t"), &momenta.statements);
        let half = momenta.uses("half").then(|| quote!(let half = 0.5 * h;));
        let of_fields = parameter("fields", apart.is_some());
        let (v, h) =
            (parameter("v", momenta.uses_velocities), parameter("h", half.is_some() || momenta.uses("h")));
        let (p0, p1) = momenta.outputs.split_at(self.n);
        let velocity_momenta = quote! {
            #[inline(always)]
            fn velocity_momenta_in_lanes<const #members: usize>(
                #of_fields: &Self::Fields<#members>,
                #v: &MemberVector<#scalar, #n, #members>,
                #h: #scalar,
            ) -> [MemberVector<#scalar, #n, #members>; 2] {
                #apart
                #half
                #statements
                [[#(#p0),*], [#(#p1),*]]
            }
        };

        let (apart, statements) = (fields.read_by(&force, is_timed, "t"), &force.statements);
        let of_fields = parameter("fields", apart.is_some());
        let (q, outputs) = (parameter("q", force.uses_coordinates), &force.outputs);
        Some(quote! {
            #gathered

            #velocity_momenta

            #[inline(always)]
            fn configuration_force_in_lanes<const #members: usize>(
                #of_fields: &Self::Fields<#members>,
                #q: &MemberVector<#scalar, #n, #members>,
            ) -> MemberVector<#scalar, #n, #members> {
                #apart
                #statements
                [#(#outputs),*]
            }
        })
    }
}

/// The names of parameters.
pub(in super::super) const TAKEN: [&str; 6] = ["q", "v", "h", "half", "fields", "systems"];
