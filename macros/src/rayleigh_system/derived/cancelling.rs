//! Terms that cancel in ∂L/∂v and in G = ∂L/∂q − ∂R/∂v + f, of which the equations of all implicit steps are
//! made: what rounding takes of them where last places of q and v do not show it.
//!
//! At an equilibrium forces cancel. Where they do at q ≠ 0, a last place of q moves them by what they round
//! by; not so at q = 0, where (q − 1) + (q + 1) rounds at ε and q has no places. Three kinds of expressions
//! tell these apart:
//!
//! ```text
//! vanishing    0 with q and v: its rounding is a share of what last places of q and v do         q, k q, sin q, q cos q
//! nonzero      rounded by a share of its own size, or of what last places do                     q − 1, cos q, (q − 1)²
//! cancelling   a sum of two that are nonzero, and what is made of it; sin (q − 1)                 (q − 1) + (q + 1)
//! ```
//!
//! One nonzero term is balanced by p and v, whose rounding is known. Of a component that is cancelling
//! the running error bound is written out, over ε (N. J. Higham, Accuracy and Stability of Numerical
//! Algorithms, 2002, section 3.3): the sizes of what each operation rounds, carried to the result.

use std::collections::HashMap;

use super::super::differentiate::{Order, partials::partials};
use super::super::functions::Zeros;
use super::super::graph::{Function, MOST_EXPRESSIONS, PairFunction};
use super::*;

/// How an expression is rounded: the larger includes the smaller.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Rounding {
    Vanishing,
    Nonzero,
    Cancelling,
}

/// The most operations whose terms are looked at: sizes take up to eight times as many, and no system
/// is to be refused for their length.
const MOST: usize = MOST_OPERATIONS / 8;

impl Rounding {
    fn of_sum(self, other: Self) -> Self {
        if self == Self::Nonzero && other == Self::Nonzero { Self::Cancelling } else { self.max(other) }
    }

    fn of_product(self, other: Self) -> Self {
        if self.max(other) == Self::Cancelling { Self::Cancelling } else { self.min(other) }
    }

    /// Of a function that does not vanish with its argument, and keeps the digits that it has.
    fn not_vanishing(self) -> Self {
        self.max(Self::Nonzero)
    }

    /// Of a function that loses the digits of an argument that does not vanish; `at_zero`: of one that does.
    fn unless_nonzero(self, at_zero: Self) -> Self {
        if self == Self::Vanishing { at_zero } else { Self::Cancelling }
    }
}

impl Deriving<'_> {
    /// Sizes of the terms that cancel; nothing where none can, or where the equations are long.
    pub(super) fn cancelling_terms(&mut self) -> Option<Routine> {
        let of_lagrangian = self.derivation.hessian(&mut self.graph, self.lagrangian, "l").gradient;
        let momenta = self.covector(&of_lagrangian, true);
        let terms = [momenta, self.rates(&of_lagrangian)].concat();
        let sizes = self.sizes_of_cancelling(&terms)?;
        self.made(Of::CancellingTerms, self.system.home(), &sizes).ok()
    }

    /// Sizes of the terms that cancel, for each of `roots`.
    fn sizes_of_cancelling(&mut self, roots: &[Node]) -> Option<Vec<Node>> {
        let kinds = self.kinds(roots);
        let may_cancel = |root: &Node| kinds[root] == Rounding::Cancelling;
        let has_room = self.graph.len() < MOST_EXPRESSIONS / 2;
        if !roots.iter().any(may_cancel) || !has_room || self.graph.operations(roots.iter().copied()) > MOST {
            return None;
        }
        let cancelling = roots.iter().copied().filter(may_cancel);
        let sizes = self.sizes_rounded(cancelling, |node| kinds[&node] != Rounding::Vanishing);
        let of = |root: &Node| sizes.get(root).filter(|_| may_cancel(root)).copied();
        Some(roots.iter().map(|root| self.or_zero(of(root))).collect())
    }

    /// The rounding of each constraint, over ε; nothing where they are long.
    pub(super) fn constraint_rounding(&mut self, constraints: &[Vec<Node>; 2]) -> Option<Routine> {
        let [holonomic, of_velocity] = constraints;
        let has_room = self.graph.len() < MOST_EXPRESSIONS / 2;
        if holonomic.is_empty() || !has_room || self.graph.operations(holonomic.iter().copied()) > MOST {
            return None;
        }
        let sizes = self.sizes_rounded(holonomic.iter().copied(), |_| true);
        let mut outputs: Vec<Node> =
            holonomic.iter().map(|root| self.or_zero(sizes.get(root).copied())).collect();
        outputs.extend(of_velocity.iter().map(|_| self.or_zero(None)));
        self.made(Of::ConstraintRounding, self.system.home_of(Part::Constraints), &outputs).ok()
    }

    /// The rounding of all that `roots` are made of, over ε, as far as it counts.
    fn sizes_rounded(
        &mut self,
        roots: impl Iterator<Item = Node>,
        counts: impl Fn(Node) -> bool,
    ) -> HashMap<Node, Node> {
        let mut sizes = HashMap::new();
        for node in self.graph.reachable(roots) {
            if counts(node)
                && let Some(size) = self.rounded_in(node, &sizes)
            {
                sizes.insert(node, size);
            }
        }
        sizes
    }

    /// The kinds of all that `roots` are made of.
    fn kinds(&self, roots: &[Node]) -> HashMap<Node, Rounding> {
        let mut kinds = HashMap::new();
        for node in self.graph.reachable(roots.iter().copied()) {
            kinds.insert(node, self.kind(node, |argument| kinds[&argument]));
        }
        kinds
    }

    fn kind(&self, node: Node, of: impl Fn(Node) -> Rounding) -> Rounding {
        use Rounding::{Nonzero, Vanishing};
        match self.graph.operation(node) {
            Operation::Coordinate(_) | Operation::Velocity(_) => Vanishing,
            _ if !self.graph.depends(node) => Nonzero,
            Operation::Add(a, b) | Operation::Subtract(a, b) => of(a).of_sum(of(b)),
            Operation::Multiply(a, b) => of(a).of_product(of(b)),
            Operation::MultiplyAdd(a, b, c) => of(a).of_product(of(b)).of_sum(of(c)),
            // 1/b does not vanish, and sin q/q does not either.
            Operation::Divide(a, b) if of(b) == Vanishing => of(a).not_vanishing(),
            Operation::Divide(a, b) => of(a).of_product(of(b)),
            Operation::Negate(a) => of(a),
            Operation::Power(a, n) if n > 0 => of(a),
            Operation::Power(a, _) => of(a).not_vanishing(),
            Operation::Function(function, x) => match function.zeros() {
                Zeros::OfRoot => of(x),
                Zeros::Nowhere => of(x).not_vanishing(),
                Zeros::Elsewhere => of(x).unless_nonzero(Nonzero),
                Zeros::AtZero => of(x).unless_nonzero(Vanishing),
            },
            Operation::Pair(PairFunction::Hypot, a, b) | Operation::Select(_, a, b) => of(a).max(of(b)),
            Operation::Pair(PairFunction::Copysign, a, _) => of(a),
            Operation::Pair(PairFunction::Powf, a, b) if !self.graph.depends(b) => {
                let vanishes = self.graph.constant_value(b).is_some_and(|exponent| exponent > 0.0);
                if vanishes { of(a) } else { of(a).not_vanishing() }
            }
            Operation::Characteristic(_, x) => of(x).unless_nonzero(Nonzero),
            Operation::Pair(_, a, b) => of(a).max(of(b)).unless_nonzero(Nonzero),
            // An input; truth values have no size.
            _ => Nonzero,
        }
    }

    /// The rounding of the expression, over ε, given that of its arguments; nothing where it takes
    /// nothing.
    fn rounded_in(&mut self, node: Node, sizes: &HashMap<Node, Node>) -> Option<Node> {
        let operation = self.graph.operation(node);
        if !self.graph.depends(node) || operation.is_literal() || operation.is_truth() {
            return None;
        }
        match operation {
            Operation::Negate(a) => return sizes.get(&a).copied(),
            Operation::Select(condition, a, b) => {
                let [a, b] = [a, b].map(|branch| sizes.get(&branch).copied());
                if a.is_none() && b.is_none() {
                    return None;
                }
                let [a, b] = [a, b].map(|size| self.or_zero(size));
                return Some(self.graph.select(condition, a, b));
            }
            _ => {}
        }
        let mut size = self.graph.function(Function::Abs, node);
        for (argument, slope) in partials(&mut self.graph, node, operation, Order::First).first {
            if let Some(&of_argument) = sizes.get(&argument) {
                let carried = match self.graph.constant_value(slope) {
                    Some(slope) => self.graph.scaled(slope.abs(), of_argument),
                    None => {
                        let slope = self.graph.function(Function::Abs, slope);
                        self.graph.times(slope, of_argument)
                    }
                };
                size = self.graph.plus(size, carried);
            }
        }
        Some(size)
    }
}
