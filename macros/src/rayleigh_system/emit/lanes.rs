//! The differences in code where values are lanes: comparisons give masks, selections take both branches,
//! and numbers among the arguments of a method are spread over the lanes.

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use syn::Ident;

use super::super::graph::{Comparison, Node, Operation};
use super::expression::{Binding, Writer, Written};

impl Writer<'_> {
    /// A name of the runtime, noted for the imports.
    pub(super) fn runtime(&self, name: &'static str) -> Ident {
        self.runtime.borrow_mut().insert(name);
        format_ident!("{name}")
    }

    /// The value, in lanes also where it is a number.
    pub(super) fn lanes(&self, node: Node) -> TokenStream {
        let written = self.expression(node);
        if self.is_lanes[node.index()] {
            written.tokens
        } else {
            let lanes = self.runtime(self.lanes);
            let (scalar, stages, value) = (self.scalar, &self.stages, written.tokens);
            quote!(#lanes::<#scalar, #stages>::splat(#value))
        }
    }

    /// The value in lanes, as what a method is called on.
    pub(super) fn lane_receiver(&self, node: Node) -> TokenStream {
        if self.is_lanes[node.index()] {
            self.expression(node).within(Binding::Atom)
        } else {
            self.lanes(node)
        }
    }

    /// The truth value in lanes.
    fn mask(&self, node: Node) -> TokenStream {
        let written = self.expression(node);
        if self.is_lanes[node.index()] {
            written.within(Binding::Atom)
        } else {
            let (mask, stages, value) = (self.runtime("Mask"), &self.stages, written.tokens);
            quote!(#mask::<#stages>::splat(#value))
        }
    }

    /// The operation, if its form on lanes is another one than on numbers.
    pub(super) fn operation_on_lanes(&self, node: Node) -> Option<Written> {
        let (tokens, binding) = match self.graph.operation(node) {
            Operation::Pair(function, a, b) => {
                let (a, b, name) =
                    (self.lane_receiver(a), self.lanes(b), format_ident!("{}", function.name()));
                (quote!(#a.#name(#b)), Binding::Atom)
            }
            Operation::MultiplyAdd(a, b, c) => {
                let (a, b, c) = (self.lane_receiver(a), self.lanes(b), self.lanes(c));
                (quote!(#a.mul_add(#b, #c)), Binding::Atom)
            }
            Operation::Power(x, n) => {
                let (x, n) = (self.lane_receiver(x), Literal::i32_unsuffixed(n));
                (quote!(#x.powi(#n)), Binding::Atom)
            }
            Operation::Select(condition, a, b) => {
                let (a, b) = (self.lanes(a), self.lanes(b));
                if self.is_lanes[condition.index()] {
                    let condition = self.mask(condition);
                    if self.lanes == "Members" {
                        let members = self.runtime(self.lanes);
                        (quote!(#members::select(#condition, #a, #b)), Binding::Atom)
                    } else {
                        (quote!(#condition.select(#a, #b)), Binding::Atom)
                    }
                } else {
                    let condition = self.expression(condition).tokens;
                    (quote!(if #condition { #a } else { #b }), Binding::Or)
                }
            }
            Operation::Compare(comparison, a, b) => {
                let (a, b, name) = match comparison {
                    Comparison::Less => (a, b, "less"),
                    Comparison::LessOrEqual => (a, b, "less_or_equal"),
                    Comparison::Greater => (b, a, "less"),
                    Comparison::GreaterOrEqual => (b, a, "less_or_equal"),
                    Comparison::Equal | Comparison::NotEqual => (a, b, "equal"),
                };
                let (a, b, name) = (self.lane_receiver(a), self.lanes(b), format_ident!("{name}"));
                match comparison {
                    Comparison::NotEqual => (quote!(!#a.#name(#b)), Binding::Sign),
                    _ => (quote!(#a.#name(#b)), Binding::Atom),
                }
            }
            Operation::And(a, b) => {
                let (a, b) = (self.mask(a), self.mask(b));
                (quote!(#a & #b), Binding::Or)
            }
            Operation::Or(a, b) => {
                let (a, b) = (self.mask(a), self.mask(b));
                (quote!(#a | #b), Binding::Or)
            }
            _ => return None,
        };
        Some(Written::new(tokens, binding))
    }
}
