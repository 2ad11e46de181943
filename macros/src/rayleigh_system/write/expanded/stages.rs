//! The equations of motion at the stages of a Gauss rule, in lanes.

use super::super::super::emit::{inlined_on_lanes, number_of_stages};
use super::*;

/// The parameter by which code in sweeps keeps angles and reciprocals from one sweep to the next.
pub struct Anchors {
    pub ty: TokenStream,
    /// The name of the parameter.
    pub parameter: Ident,
    /// `let (angles, reciprocals) = anchors;`
    pub apart: Option<TokenStream>,
}

impl Anchors {
    /// Of values of the type that `lanes` writes.
    pub fn new(line: &StraightLine, lanes: impl Fn() -> TokenStream, is_fused: bool) -> Self {
        let fused = is_fused.then(|| quote!(, true));
        let groups: Vec<_> = [("Angle", "angles"), ("Reciprocal", "reciprocals")]
            .into_iter()
            .zip(line.anchors)
            .filter(|&(_, count)| count > 0)
            .map(|((ty, name), count)| {
                let (ty, name, count) =
                    (format_ident!("{ty}"), format_ident!("{name}"), Literal::usize_unsuffixed(count));
                let lanes = lanes();
                (quote!([::dalembert::generated::#ty<#lanes #fused>; #count]), name)
            })
            .collect();
        let ty = tuple(groups.iter().map(|(ty, _)| ty.clone()));
        match &groups[..] {
            [(_, name)] => Self { ty, parameter: name.clone(), apart: None },
            groups => {
                let names = tuple(groups.iter().map(|(_, name)| quote!(#name)));
                let apart = (!groups.is_empty()).then(|| quote!(let #names = anchors;));
                Self { ty, parameter: parameter("anchors", apart.is_some()), apart }
            }
        }
    }
}

impl Text<'_> {
    /// `stages`, or `stages_in_time`.
    pub(super) fn stages(&self, routine: &Routine) -> TokenStream {
        let line = self.line(routine);
        let (rates, rest) = line.outputs.split_at(self.derived.n);
        let (residuals, corrections) = rest.split_at(self.derived.n);
        let (scalar, n) = (&self.system.scalar, self.system.degrees.times(1));
        let (q, v) = (parameter("q", line.uses_coordinates), parameter("v", line.uses_velocities));
        let (statements, later, stages) =
            (&line.statements, &line.later, number_of_stages(&self.derived.graph));
        let [lane_vector, of_stages] = ["LaneVector", "Stages"].map(|name| self.name(name));
        let lanes = || {
            let lanes = self.name("Lanes");
            quote!(#lanes<#scalar, #stages>)
        };
        let vector = quote!(#lane_vector<#scalar, #n, #stages>);
        let (function, text, elapsed) = if self.system.is_timed() {
            let (elapsed, lanes) = (parameter("elapsed", line.uses("t")), lanes());
            let text = " G, P − ∂L/∂v and (∂²L/∂v²)⁻¹ (P − ∂L/∂v) at all stages, each at its own time.";
            (format_ident!("stages_in_time"), text, Some(quote!(#elapsed: &#lanes,)))
        } else {
            (format_ident!("stages"), " G, P − ∂L/∂v and (∂²L/∂v²)⁻¹ (P − ∂L/∂v) at all stages.", None)
        };
        let Anchors { ty, parameter: anchors, apart } =
            Anchors::new(&line, lanes, self.system.fused.is_some());
        let inline = inlined_on_lanes(&quote!(#statements #later));
        quote! {
            type Anchors<const #stages: usize> = #ty;

            #[doc = #text]
            #inline
            fn #function<const #stages: usize>(
                &self,
                #anchors: &mut Self::Anchors<#stages>,
                #elapsed
                #q: &#vector,
                #v: &#vector,
                momenta: impl FnOnce(&#vector) -> #vector,
            ) -> #of_stages<#scalar, #n, #stages> {
                #apart
                #statements
                let rate = [#(#rates),*];
                let p = momenta(&rate);
                #later
                #of_stages { rate, residual: [#(#residuals),*], correction: [#(#corrections),*] }
            }
        }
    }
}
