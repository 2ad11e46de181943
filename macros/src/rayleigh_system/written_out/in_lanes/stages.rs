//! A stage of a Gauss rule of several members, in two functions: the rates, and what the momenta that they
//! lead to leave and correct. What the second needs of the first is handed over.

use super::super::super::emit::before_the_run;
use super::super::stages::Anchors;
use super::*;

/// The names of parameters.
const TAKEN: [&str; 9] = ["q", "v", "p", "kept", "fields", "systems", "anchors", "angles", "reciprocals"];

impl Code<'_> {
    /// The functions of `ForcedLagrangianInLanes`, of what `stages` computes: rates, residuals and
    /// corrections, the last two from the momenta `late`.
    pub(in super::super) fn stages_in_lanes(
        &mut self,
        outputs: &[Node],
        late: &[Node],
        anchored: Anchored<'_>,
    ) -> TokenStream {
        let (rates, rest) = outputs.split_at(self.n);
        let handed = self.handed(rest, late);
        let corrections = self.on_members(rest, &TAKEN, &handed, None);
        let first = [rates, &handed].concat();
        let line = self.on_members(&first, &TAKEN, &[], Some(anchored));

        let is_handed = |field: &&Field| handed.contains(&field.node);
        let kept = corrections.fields.iter().filter(is_handed).map(|field| (field.node, field.is_truth));
        let kept = OfMembers::new(self, kept);
        let of_corrections = corrections.fields.iter().filter(|field| !is_handed(field));
        let fields = line.fields.iter().chain(of_corrections).map(|field| (field.node, field.is_truth));
        let fields = OfMembers::new(self, fields);
        let gathered = self.gathered(&fields);

        let (scalar, n, members) = (&self.system.scalar, self.system.degrees.times(1), &fields.members);
        let (of_rates, of_kept) = line.outputs.split_at(self.n);
        let handed_over = kept.value(|node| {
            let place = handed.iter().position(|&other| other == node);
            place.map_or_else(TokenStream::new, |place| of_kept[place].clone())
        });
        let is_timed = self.system.is_timed();
        let apart = fields.read_by(&line, is_timed, "t");
        let of_fields = parameter("fields", apart.is_some());
        let (q, v) = (parameter("q", line.uses_coordinates), parameter("v", line.uses_velocities));
        let (statements, kept_ty) = (&line.statements, kept.ty());
        let anchors = Anchors::new(&line, &quote!(Members<#scalar, #members>), self.system.is_fused);
        let (anchors_ty, of_anchors, anchors_apart) = (&anchors.ty, &anchors.parameter, &anchors.apart);
        let rates = quote! {
            #[inline(always)]
            fn rates_in_lanes<const #members: usize>(
                #of_fields: &Self::Fields<#members>,
                #of_anchors: &mut Self::AnchorsInLanes<#members>,
                #q: &MemberVector<#scalar, #n, #members>,
                #v: &MemberVector<#scalar, #n, #members>,
            ) -> (MemberVector<#scalar, #n, #members>, Self::Kept<#members>) {
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
        let (residuals, of_velocities) = corrections.outputs.split_at(self.n);
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
                #v: &MemberVector<#scalar, #n, #members>,
                #p: &MemberVector<#scalar, #n, #members>,
            ) -> [MemberVector<#scalar, #n, #members>; 2] {
                #apart
                #kept_apart
                #statements
                [[#(#residuals),*], [#(#of_velocities),*]]
            }
        }
    }

    /// The nodes to hand over: `outputs` need them, and the momenta `late` do not change them. Velocities and
    /// values known before the run are at hand, and a product or a negation of those is sooner computed again
    /// than stored.
    fn handed(&self, outputs: &[Node], late: &[Node]) -> Vec<Node> {
        let nodes = self.graph.reachable(outputs.iter().copied());
        let (is_constant, _) = before_the_run(&self.graph, &nodes, &TAKEN);
        let mut is_late = vec![false; self.graph.len()];
        let mut needed = outputs.to_vec();
        for &node in &nodes {
            let operation = self.graph.operation(node);
            is_late[node.index()] =
                late.contains(&node) || operation.arguments().any(|argument| is_late[argument.index()]);
            if is_late[node.index()] {
                needed.extend(operation.arguments());
            }
        }
        let is_at_hand = |node: Node| {
            is_constant[node.index()] || matches!(self.graph.operation(node), Operation::Velocity(_))
        };
        needed.retain(|&node| {
            let operation = self.graph.operation(node);
            let is_product = matches!(operation, Operation::Multiply(..) | Operation::Negate(_));
            let is_short = is_product && operation.arguments().all(is_at_hand);
            !is_late[node.index()] && !is_at_hand(node) && !is_short
        });
        needed.sort_unstable();
        needed.dedup();
        needed
    }
}
