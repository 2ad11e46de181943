//! Explicit steps of several members: the functions of `Explicit` on members.

use super::*;

/// The outputs that `ExplicitInLanes` asks for.
pub(in super::super) struct ExplicitLines {
    /// p0 and p1.
    momenta: StraightLine,
    force: StraightLine,
}

impl Code<'_> {
    /// Code for outputs as `Explicit` computes them, p0 and p1 in `momenta`; nothing where a field is read
    /// within a condition, since fields are read before.
    pub(in super::super) fn explicit_lines(
        &mut self,
        momenta: &[Node],
        force: &[Node],
    ) -> Option<ExplicitLines> {
        if self.graph.is_conditional(force.iter().chain(momenta).copied()) {
            return None;
        }
        let force = self.on_members(force, &TAKEN, &[], None);
        let momenta = self.on_members(momenta, &TAKEN, &[], None);
        Some(ExplicitLines { momenta, force })
    }
}

impl ExplicitLines {
    /// The fields that the code reads.
    pub(super) fn fields(&self) -> impl Iterator<Item = &Field> {
        self.momenta.fields.iter().chain(&self.force.fields)
    }

    /// The functions of `ExplicitInLanes`.
    pub(super) fn written(&self, code: &Code<'_>, fields: &OfMembers) -> TokenStream {
        let Self { momenta, force } = self;
        let is_timed = code.system.timed.any();
        let (scalar, n, members) = (&code.system.scalar, code.system.degrees.times(1), &fields.members);

        let (apart, statements) = (fields.read_by(momenta, is_timed, "t"), &momenta.statements);
        let half = momenta.uses("half").then(|| quote!(let half = 0.5 * h;));
        let of_fields = parameter("fields", apart.is_some());
        let (v, h) =
            (parameter("v", momenta.uses_velocities), parameter("h", half.is_some() || momenta.uses("h")));
        let (p0, p1) = momenta.outputs.split_at(code.n);
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

        let (apart, statements) = (fields.read_by(force, is_timed, "t"), &force.statements);
        let of_fields = parameter("fields", apart.is_some());
        let (q, outputs) = (parameter("q", force.uses_coordinates), &force.outputs);
        quote! {
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
        }
    }
}

/// The names of parameters.
pub(in super::super) const TAKEN: [&str; 6] = ["q", "v", "h", "half", "fields", "systems"];
