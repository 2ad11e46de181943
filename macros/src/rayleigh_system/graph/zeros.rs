//! The sign of a zero: whether leaving out the 0 that a sum starts from can be seen.
//!
//! 0 + x is x, unless x is −0. Most sums go where a zero has no sign; where one is divided by, or asked for
//! its sign, the 0 stays.

use super::{Function, Graph, Node, Operation, PairFunction, Predicate};

impl Graph {
    /// A graph whose sums keep the 0 that they start from.
    pub fn with_zeros() -> Self {
        Self { keeps_zeros: true, ..Self::default() }
    }

    /// a + b as written, without an initial 0 that the sum of a loop starts from.
    pub fn add(&mut self, a: Node, b: Node) -> Node {
        let rest = match (self.constant_value(a), self.constant_value(b)) {
            (Some(0.0), None) => b,
            (None, Some(0.0)) => a,
            _ => return self.node(Operation::Add(a, b)),
        };
        if !self.can_be_negative_zero(rest) {
            return rest;
        }
        if self.keeps_zeros {
            return self.node(Operation::Add(a, b));
        }
        self.without_zero.push(rest);
        rest
    }

    /// Whether a value can tell that a 0 was left out.
    pub fn shows_zeros_left_out(&self) -> bool {
        let mut differs = vec![false; self.len()];
        for node in &self.without_zero {
            differs[node.index()] = true;
        }
        for node in self.nodes() {
            let operation = self.operation(node);
            let of = |node: Node| differs[node.index()];
            let shows = match operation {
                Operation::Divide(_, b) => of(b),
                Operation::Function(Function::Recip | Function::Signum, a) => of(a),
                Operation::Pair(PairFunction::Powf | PairFunction::Atan2 | PairFunction::Copysign, a, b) => {
                    of(a) || of(b)
                }
                Operation::Power(a, n) => n < 0 && of(a),
                Operation::Is(Predicate::SignNegative | Predicate::SignPositive, a) => of(a),
                _ => false,
            };
            if shows {
                return true;
            }
            let keeps_sign = match operation {
                Operation::Multiply(a, b) => a != b,
                // A zero added to one that is not negative is not negative.
                Operation::Add(a, b) => {
                    (of(a) && of(b))
                        || (of(a) && self.can_be_negative_zero(b))
                        || (of(b) && self.can_be_negative_zero(a))
                }
                Operation::Pair(PairFunction::Hypot, ..)
                | Operation::Function(Function::Abs | Function::Cos | Function::Cosh | Function::Exp, _)
                | Operation::Compare(..)
                | Operation::Is(..) => false,
                _ => true,
            };
            differs[node.index()] |= keeps_sign && operation.arguments().any(of);
        }
        false
    }

    /// Whether the value can be −0, as far as the operation shows.
    fn can_be_negative_zero(&self, node: Node) -> bool {
        match self.operation(node) {
            Operation::Constant(bits) => bits == (-0.0_f64).to_bits(),
            Operation::Multiply(a, b) => a != b,
            Operation::Power(_, n) => n % 2 != 0,
            Operation::Pair(PairFunction::Hypot, ..)
            | Operation::Function(Function::Abs | Function::Cosh | Function::Exp | Function::Exp2, _) => {
                false
            }
            _ => true,
        }
    }
}
