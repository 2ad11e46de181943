//! Characteristics: functions of one number that a field or constant of the user's is, known by their
//! derivatives when the program runs.

use proc_macro2::{TokenStream, TokenTree};

use super::curve::{Curve, HIGHEST};
use super::{Graph, Node, Operation, with_own_self};

impl Graph {
    /// The characteristic that `tokens` are, at an argument.
    pub fn characteristic(&mut self, tokens: TokenStream, argument: Node) -> Node {
        let parameter = self.place(with_own_self(tokens), false, false);
        self.node(Operation::Characteristic(Curve { parameter, order: 0 }, argument))
    }

    /// The derivative of a derivative of a characteristic. The fourth, which nothing takes, is NaN.
    pub fn slope(&mut self, curve: Curve, argument: Node) -> Node {
        if curve.order == HIGHEST {
            return self.constant(f64::NAN);
        }
        self.node(Operation::Characteristic(Curve { order: curve.order + 1, ..curve }, argument))
    }

    /// `cam` of `self.wheels[2].cam`, `cam_slope` of its derivative, and so on.
    pub fn name_of_curve(&self, curve: Curve) -> Option<String> {
        let tokens = self.parameters[curve.parameter].tokens.clone();
        let last = tokens.into_iter().filter_map(|token| match token {
            TokenTree::Ident(word) => Some(word.to_string().trim_start_matches("r#").to_lowercase()),
            _ => None,
        });
        let suffix = ["", "_slope", "_curvature", "_third"][usize::from(curve.order)];
        last.last().map(|word| format!("{word}{suffix}"))
    }
}
