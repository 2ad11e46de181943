//! A stage of a Gauss rule of several members, in two functions: the rates, and what the momenta that they
//! lead to leave and correct. What the second needs of the first is handed over.

use super::super::stages::Anchors;
use super::*;

/// Both lines, and the nodes that the first hands over.
pub(super) struct StageLines {
    rates: StraightLine,
    corrections: StraightLine,
    handed: Vec<Node>,
}

impl StageLines {
    pub(super) fn new([rates, corrections]: [StraightLine; 2], handed: Vec<Node>) -> Self {
        Self { rates, corrections, handed }
    }

    /// The fields that the code reads.
    pub(super) fn fields(&self) -> impl Iterator<Item = &Field> {
        let of_corrections = self.corrections.fields.iter().filter(|field| !self.hands(field));
        self.rates.fields.iter().chain(of_corrections)
    }

    /// Whether the code reads curves of the systems.
    pub(super) fn reads_systems(&self) -> bool {
        self.rates.reads_systems || self.corrections.reads_systems
    }

    fn hands(&self, field: &Field) -> bool {
        self.handed.contains(&field.node)
    }
}

impl Text<'_> {
    /// The nodes that the rates hand to the corrections.
    pub(super) fn handed_over(&self, [rates, _]: &[Routine; 2]) -> Vec<Node> {
        rates.outputs[self.derived.n..].to_vec()
    }

    /// The functions of `ForcedLagrangianInLanes`.
    pub(super) fn stages_in_lanes(&self, lines: &StageLines, fields: &OfMembers<'_>) -> TokenStream {
        let StageLines { rates: line, corrections, handed } = lines;
        let kept = OfMembers::new(self, corrections.fields.iter().filter(|field| lines.hands(field)), false);

        let (scalar, members) = (&self.system.scalar, &fields.members);
        let vector = fields.vector(&self.system.degrees.times(1));
        let (of_rates, of_kept) = line.outputs.split_at(self.derived.n);
        let of_node = |node| {
            let place = handed.iter().position(|&other| other == node);
            place.map_or_else(TokenStream::new, |place| of_kept[place].clone())
        };
        let handed_over = kept.value(of_node, TokenStream::new());
        let is_timed = self.system.is_timed();
        let apart = fields.read_by(line, is_timed, "t");
        let of_fields = parameter("fields", apart.is_some());
        let (q, v) = (parameter("q", line.uses_coordinates), parameter("v", line.uses_velocities));
        let (statements, kept_ty) = (&line.statements, kept.ty());
        let of_members = || {
            let of = self.name("Members");
            quote!(#of<#scalar, #members>)
        };
        let anchors = Anchors::new(line, of_members, self.system.fused.is_some());
        let (anchors_ty, of_anchors, anchors_apart) = (&anchors.ty, &anchors.parameter, &anchors.apart);
        let rates = quote! {
            #[inline(always)]
            fn rates_in_lanes<'s, const #members: usize>(
                #of_fields: &Self::Fields<'s, #members>,
                #of_anchors: &mut Self::AnchorsInLanes<#members>,
                #q: &#vector,
                #v: &#vector,
            ) -> (#vector, Self::Kept<#members>)
            where
                Self: 's,
            {
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
        let (residuals, of_velocities) = corrections.outputs.split_at(self.derived.n);
        let statements = &corrections.statements;
        quote! {
            type Kept<const #members: usize> = #kept_ty;

            type AnchorsInLanes<const #members: usize> = #anchors_ty;

            #rates

            #[inline(always)]
            fn corrections_in_lanes<'s, const #members: usize>(
                #of_fields: &Self::Fields<'s, #members>,
                #of_kept: &Self::Kept<#members>,
                #v: &#vector,
                #p: &#vector,
            ) -> [#vector; 2]
            where
                Self: 's,
            {
                #apart
                #kept_apart
                #statements
                [[#(#residuals),*], [#(#of_velocities),*]]
            }
        }
    }
}
