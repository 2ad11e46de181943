//! Numbers of fields and constants alone, as one expression of plain numbers: for functions that jump, which
//! are no operations of the graph, and for casts, whose operand may be of another precision.

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::{Graph, Node, Operation};

/// Operations of one text: what is used often is written as often.
const LONGEST: usize = 500;

impl Graph {
    /// The expression, each operation in parentheses, or nothing where it changes with q, v, u, t or a
    /// parameter that derivatives are taken by; or where it is long.
    pub fn text(&self, node: Node) -> Option<TokenStream> {
        if self.depends(node) {
            return None;
        }
        let mut left = LONGEST;
        self.text_of(node, &mut left)
    }

    fn text_of(&self, node: Node, left: &mut usize) -> Option<TokenStream> {
        *left = left.checked_sub(1)?;
        let operation = self.operation(node);
        let mut arguments = Vec::new();
        for argument in operation.arguments() {
            arguments.push(self.text_of(argument, left)?);
        }
        Some(match (operation, &arguments[..]) {
            (Operation::Parameter(index), _) if !self.is_time(operation) => self.parameter(index).operand(),
            (Operation::Constant(bits), _) => {
                let value = f64::from_bits(bits);
                if !value.is_finite() {
                    return None;
                }
                let sign = value.is_sign_negative().then(|| quote!(-));
                let size = Literal::f64_unsuffixed(value.abs());
                if sign.is_some() { quote!((#sign #size)) } else { quote!(#size) }
            }
            (Operation::Add(..), [a, b]) => quote!((#a + #b)),
            (Operation::Subtract(..), [a, b]) => quote!((#a - #b)),
            (Operation::Multiply(..), [a, b]) => quote!((#a * #b)),
            (Operation::Divide(..), [a, b]) => quote!((#a / #b)),
            (Operation::Negate(_), [a]) => quote!((-#a)),
            (Operation::Function(function, _), [x]) => method(function.name(), x, &[]),
            (Operation::Pair(function, ..), [x, y]) => method(function.name(), x, std::slice::from_ref(y)),
            (Operation::Characteristic(curve, _), [x]) if curve.order == 0 => {
                let of = self.parameter(curve.parameter).operand();
                quote!(#of.at(#x))
            }
            (Operation::Power(_, n), [x]) => {
                let n = Literal::i32_unsuffixed(n);
                quote!(#x.powi(#n))
            }
            (Operation::MultiplyAdd(..), [x, a, b]) => method("mul_add", x, &[a.clone(), b.clone()]),
            (Operation::Is(predicate, _), [x]) => method(predicate.name(), x, &[]),
            (Operation::Select(..), [condition, a, b]) => {
                quote!((if #condition { #a } else { #b }))
            }
            (Operation::Compare(comparison, ..), [a, b]) => {
                let symbol = comparison.symbol();
                quote!((#a #symbol #b))
            }
            (Operation::Not(_), [a]) => quote!((!#a)),
            (Operation::And(..), [a, b]) => quote!((#a && #b)),
            (Operation::Or(..), [a, b]) => quote!((#a || #b)),
            _ => return None,
        })
    }
}

/// `x.name(arguments)`
fn method(name: &str, x: &TokenStream, arguments: &[TokenStream]) -> TokenStream {
    let name = format_ident!("{name}");
    quote!(#x.#name(#(#arguments),*))
}
