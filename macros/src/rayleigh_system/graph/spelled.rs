//! Expressions as text for people: as the user wrote them, as far as the graph knows.

use super::{Graph, Node, Operation};

/// The longest text of an argument: of a longer one stands an ellipsis.
const LONGEST: usize = 60;

/// How tightly the operation of a text binds.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Binding {
    Sum,
    Product,
    Sign,
    Whole,
}

impl Graph {
    /// The operation with its arguments, which stand by their names where they have one; without the `self`
    /// of fields, where `is_function`: those are parameters there.
    pub fn spelled(&self, node: Node, is_function: bool) -> String {
        let text = self.operation_spelled(node, is_function, 8).0;
        if is_function { text.replace("self.", "") } else { text }
    }

    fn argument(&self, node: Node, is_function: bool, left: u32) -> (String, Binding) {
        // A field has its own name, and is clearer as it is written.
        let is_field = matches!(self.operation(node), Operation::Parameter(_));
        if let Some(name) = self.name(node).filter(|_| !is_field) {
            return (name.to_owned(), Binding::Whole);
        }
        let (text, binding) = match left.checked_sub(1) {
            Some(left) => self.operation_spelled(node, is_function, left),
            None => ("…".to_owned(), Binding::Whole),
        };
        if text.chars().count() > LONGEST { ("…".to_owned(), Binding::Whole) } else { (text, binding) }
    }

    fn written_out(&self, parameter: usize) -> String {
        let text = self.parameter(parameter).tokens.to_string();
        text.replace(" . ", ".").replace(" :: ", "::").replace(" [", "[")
    }

    fn operation_spelled(&self, node: Node, is_function: bool, left: u32) -> (String, Binding) {
        let bound = |node: Node, least: Binding| {
            let (text, binding) = self.argument(node, is_function, left);
            if binding < least { format!("({text})") } else { text }
        };
        let plain = |node: Node| self.argument(node, is_function, left).0;
        let pair = |a, symbol: &str, b, binding, least| {
            (format!("{} {symbol} {}", bound(a, binding), bound(b, least)), binding)
        };
        let method = |x, name: &str, arguments: &[Node]| {
            let arguments: Vec<_> = arguments.iter().map(|&node| plain(node)).collect();
            (format!("{}.{name}({})", bound(x, Binding::Whole), arguments.join(", ")), Binding::Whole)
        };
        match self.operation(node) {
            Operation::Coordinate(i) => (format!("q[{i}]"), Binding::Whole),
            Operation::Velocity(i) => (format!("v[{i}]"), Binding::Whole),
            Operation::Input(i) => (format!("u[{i}]"), Binding::Whole),
            Operation::Parameter(index) => (self.written_out(index), Binding::Whole),
            Operation::Constant(bits) => {
                let value = f64::from_bits(bits);
                let binding = if value.is_sign_negative() { Binding::Sign } else { Binding::Whole };
                (format!("{value:?}"), binding)
            }
            Operation::Add(a, b) => pair(a, "+", b, Binding::Sum, Binding::Sum),
            Operation::Subtract(a, b) => pair(a, "-", b, Binding::Sum, Binding::Product),
            Operation::Multiply(a, b) => pair(a, "*", b, Binding::Product, Binding::Product),
            Operation::Divide(a, b) => pair(a, "/", b, Binding::Product, Binding::Sign),
            Operation::Negate(a) => (format!("-{}", bound(a, Binding::Whole)), Binding::Sign),
            Operation::Function(function, x) => method(x, function.name(), &[]),
            Operation::Pair(function, x, y) => method(x, function.name(), &[y]),
            Operation::Characteristic(curve, x) => {
                let primes = "′".repeat(curve.order.into());
                (format!("{}.at{primes}({})", self.written_out(curve.parameter), plain(x)), Binding::Whole)
            }
            Operation::Power(x, n) => (format!("{}.powi({n})", bound(x, Binding::Whole)), Binding::Whole),
            Operation::MultiplyAdd(x, a, b) => method(x, "mul_add", &[a, b]),
            _ => ("…".to_owned(), Binding::Whole),
        }
    }
}
