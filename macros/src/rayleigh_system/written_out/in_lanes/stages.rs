//! A stage of a Gauss rule of several members, in two functions: the rates, and what the momenta that they
//! lead to leave and correct. What the second needs of the first is handed over.

use super::super::super::emit::before_the_run;
use super::super::stages::Anchors;
use super::*;

/// The names of parameters.
const TAKEN: [&str; 9] = ["q", "v", "p", "kept", "fields", "systems", "anchors", "angles", "reciprocals"];

/// The outputs that `ForcedLagrangianInLanes` asks for.
pub(in super::super) struct StageLines {
    /// The rates, and the values handed over.
    rates: StraightLine,
    corrections: StraightLine,
    handed: Vec<Node>,
}

impl Code<'_> {
    /// Code for what `stages` computes: rates, residuals and corrections, the last two from the momenta
    /// `late`.
    pub(in super::super) fn stage_lines(
        &mut self,
        outputs: &[Node],
        late: &[Node],
        anchored: Anchored<'_>,
    ) -> StageLines {
        let (rates, rest) = outputs.split_at(self.n);
        let handed = self.handed(rest, late);
        let corrections = self.on_members(rest, &TAKEN, &handed, None);
        let rates = [rates, &handed].concat();
        let rates = self.on_members(&rates, &TAKEN, &[], Some(anchored));
        StageLines { rates, corrections, handed }
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

impl StageLines {
    /// The fields that the code reads; those of the corrections that are not handed over.
    pub(super) fn fields(&self) -> impl Iterator<Item = &Field> {
        let of_corrections = self.corrections.fields.iter();
        self.rates.fields.iter().chain(of_corrections.filter(|field| !self.handed.contains(&field.node)))
    }

    /// The functions of `ForcedLagrangianInLanes`.
    pub(super) fn written(&self, code: &Code<'_>, fields: &OfMembers) -> TokenStream {
        let Self { rates: line, corrections, handed } = self;
        let kept = corrections.fields.iter().filter(|field| handed.contains(&field.node));
        let kept = OfMembers::new(code, kept);
        let (scalar, n, members) = (&code.system.scalar, code.system.degrees.times(1), &fields.members);
        let (of_rates, of_kept) = line.outputs.split_at(code.n);
        let handed_over = kept.value(|node| {
            let place = handed.iter().position(|&other| other == node);
            place.map_or_else(TokenStream::new, |place| of_kept[place].clone())
        });
        let is_timed = code.system.timed.any();
        let apart = fields.read_by(line, is_timed, "t");
        let of_fields = parameter("fields", apart.is_some());
        let (q, v) = (parameter("q", line.uses_coordinates), parameter("v", line.uses_velocities));
        let (statements, kept_ty) = (&line.statements, kept.ty());
        let anchors = Anchors::new(line, &quote!(Members<#scalar, #members>), code.system.fused.is_some());
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
            (fields.read_by(corrections, is_timed, "t"), kept.taken_apart("kept", corrections));
        let (of_fields, of_kept) =
            (parameter("fields", apart.is_some()), parameter("kept", !kept.is_empty()));
        let (v, p) = (parameter("v", corrections.uses_velocities), parameter("p", corrections.uses("p")));
        let (residuals, of_velocities) = corrections.outputs.split_at(code.n);
        let statements = &corrections.statements;
        quote! {
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
}
