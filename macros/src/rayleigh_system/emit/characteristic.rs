//! Characteristics: one call for the value and all derivatives that are needed at one place.

use proc_macro2::{Literal, Span, TokenStream};
use quote::{ToTokens, quote, quote_spanned};

use super::super::graph::{Curve, Node, Operation};
use super::expression::Writer;

impl Writer<'_> {
    /// `let [drag, drag_slope, ..] = Curve::<f64>::derivatives(&self.drag, x);`
    ///
    /// Of what is in `nodes` and has no local as yet.
    pub fn characteristic(&mut self, curve: Curve, x: Node, nodes: &[Node]) -> TokenStream {
        let mut names = Vec::new();
        for curve in curve.all() {
            let node = self.graph.known(Operation::Characteristic(curve, x));
            let is_open =
                |node: &Node| nodes.binary_search(node).is_ok() && self.locals[node.index()].is_none();
            names.push(node.filter(is_open).map(|node| {
                let name = self.names.of(self.graph, node, &self.locals);
                self.locals[node.index()] = Some(name.clone());
                name
            }));
        }
        let call = self.call(curve, x);
        if self.is_dual {
            // The number carries its derivatives.
            let value = names.iter().flatten();
            return quote!(let #(#value)* = #call;);
        }
        let rest = names.iter().rposition(Option::is_some).map_or(0, |last| last + 1);
        let dots = (rest < names.len()).then(|| quote!(..));
        let names = names[..rest]
            .iter()
            .map(|name| name.as_ref().map_or_else(|| quote!(_), ToTokens::to_token_stream));
        let names = names.chain(dots);
        quote!(let [#(#names),*] = #call;)
    }

    /// One derivative, where no local holds it.
    pub fn derivative_of(&self, curve: Curve, x: Node) -> TokenStream {
        let (call, order) = (self.call(curve, x), Literal::u8_unsuffixed(curve.order));
        if self.is_dual { call } else { quote!(#call[#order]) }
    }

    /// The value and all derivatives.
    fn call(&self, curve: Curve, x: Node) -> TokenStream {
        let of = self.graph.parameter(curve.parameter).operand();
        if self.is_dual {
            let x = self.expression(x).tokens;
            quote!(dual::at(&#of, #x))
        } else if self.is_of_each_member(curve) {
            let (x, derivatives) = (self.lane_receiver(x), self.derivatives(of, quote!(x)));
            quote!(#x.on_each(&systems, |system, x| #derivatives))
        } else if self.is_lanes[x.index()] {
            let x = self.lane_receiver(x);
            quote!(#x.on(&#of))
        } else {
            self.derivatives(of, self.expression(x).tokens)
        }
    }

    /// Whether each member has a curve of its own.
    pub fn is_of_each_member(&self, curve: Curve) -> bool {
        self.lanes == "Members" && self.graph.parameter(curve.parameter).reads_self()
    }

    /// `Curve::<f64>::derivatives(&self.drag, x)`
    fn derivatives(&self, of: TokenStream, x: TokenStream) -> TokenStream {
        let (mut name, scalar) = (self.runtime("Curve"), self.scalar);
        // Where the field is no characteristic, rustc says so there.
        let span = of.clone().into_iter().last().map_or_else(Span::call_site, |token| token.span());
        let span = Span::call_site().located_at(span);
        name.set_span(span);
        let of = quote_spanned!(span=> &#of);
        quote_spanned!(span=> #name::<#scalar>::derivatives(#of, #x))
    }
}
