//! Powers of sums of squares where the sum is 0: their derivatives with all that multiplies them.
//!
//! ```text
//! s = Σ cᵢ xᵢ²,   y = s^{a}·… of order d in x,   ∂y/∂xᵢ of order d − 1,   ∂²y/∂xᵢ∂xⱼ of order d − 2
//! ```
//!
//! √s has no derivative at s = 0, and the chain rule makes 0·∞ of it even where s√s has one, which is 0. So
//! the order is counted in which each root, power or norm of a sum of squares goes to 0 with all that
//! multiplies it: where it is above 1 its derivative counts as 0 at s = 0, and where it is above 2 its second
//! derivative, too. Otherwise they are what they are, infinite or NaN.

use std::collections::{BTreeSet, HashMap};

use super::super::graph::{Comparison, Function, Graph, Node, Operation, PairFunction};
use super::partials::Partials;

/// The roots, powers and norms below one root that count as 0 at 0, with the order in which they go to 0.
#[derive(Default)]
pub struct Vanishing {
    orders: HashMap<Node, f64>,
}

impl Vanishing {
    /// The ones below `root`.
    pub fn of(graph: &Graph, root: Node) -> Self {
        let nodes = graph.reachable([root]);
        let mut orders = HashMap::new();
        for &node in &nodes {
            let Some(bases) = bases(graph, node) else { continue };
            if let Some(order) = order_below(graph, &nodes, root, node, &bases)
                && order > 1.0
            {
                orders.insert(node, order);
            }
        }
        Self { orders }
    }

    /// Makes derivatives of `node` 0 at 0 where they count as that.
    pub fn apply(&self, graph: &mut Graph, node: Node, partials: &mut Partials) {
        let Some(&order) = self.orders.get(&node) else { return };
        let sum = match graph.operation(node) {
            Operation::Function(_, sum) | Operation::Pair(PairFunction::Powf, sum, _) => sum,
            _ => node,
        };
        let zero = graph.constant(0.0);
        let is_zero = graph.node(Operation::Compare(Comparison::Equal, sum, zero));
        for (_, first) in &mut partials.first {
            *first = graph.select(is_zero, zero, *first);
        }
        for (.., second) in partials.second.iter_mut().filter(|_| order > 2.0) {
            *second = graph.select(is_zero, zero, *second);
        }
    }
}

/// The xᵢ, if `node` is a root or a power of a sum of their squares, or a norm, without derivatives at 0.
fn bases(graph: &Graph, node: Node) -> Option<BTreeSet<Node>> {
    let mut bases = BTreeSet::new();
    let is_one = match graph.operation(node) {
        Operation::Function(Function::Sqrt, sum) => squares(graph, sum, &mut bases),
        Operation::Pair(PairFunction::Powf, sum, exponent) => {
            graph.constant_value(exponent).is_some_and(|exponent| exponent > 0.0)
                && squares(graph, sum, &mut bases)
        }
        Operation::Pair(PairFunction::Hypot, ..) => sides(graph, node, &mut bases),
        _ => false,
    };
    (is_one && graph.depends(node)).then_some(bases)
}

/// Whether a node is a norm; its sides, those of a norm of norms being the sides of all.
fn sides(graph: &Graph, norm: Node, bases: &mut BTreeSet<Node>) -> bool {
    let Operation::Pair(PairFunction::Hypot, a, b) = graph.operation(norm) else { return false };
    for side in [a, b] {
        if !sides(graph, side, bases) {
            bases.insert(side);
        }
    }
    true
}

/// Whether a node is a sum of squares; their bases.
fn squares(graph: &Graph, node: Node, bases: &mut BTreeSet<Node>) -> bool {
    match graph.operation(node) {
        Operation::Add(a, b) => squares(graph, a, bases) && squares(graph, b, bases),
        Operation::MultiplyAdd(a, b, c) => {
            square([a, b].iter().flat_map(|&factor| factors(graph, factor)), graph, bases)
                && squares(graph, c, bases)
        }
        // A sum as a whole with a factor in front: ½(x² + y²).
        Operation::Multiply(a, b) if !graph.depends(a) => squares(graph, b, bases),
        Operation::Multiply(a, b) if !graph.depends(b) => squares(graph, a, bases),
        Operation::Divide(a, b) if !graph.depends(b) => squares(graph, a, bases),
        Operation::Multiply(..) => square(factors(graph, node).into_iter(), graph, bases),
        Operation::Power(x, n) if n > 0 && n % 2 == 0 => {
            bases.insert(x);
            true
        }
        Operation::Constant(bits) => f64::from_bits(bits) == 0.0,
        _ => false,
    }
}

/// Whether factors make a square, with what is constant in front.
fn square(factors: impl Iterator<Item = Node>, graph: &Graph, bases: &mut BTreeSet<Node>) -> bool {
    let mut counts: HashMap<Node, u32> = HashMap::new();
    for factor in factors.filter(|&factor| graph.depends(factor)) {
        *counts.entry(factor).or_default() += 1;
    }
    let is_square = !counts.is_empty() && counts.values().all(|count| count % 2 == 0);
    bases.extend(counts.into_keys());
    is_square
}

/// The factors of a product.
fn factors(graph: &Graph, node: Node) -> Vec<Node> {
    let (mut open, mut factors) = (vec![node], Vec::new());
    while let Some(node) = open.pop() {
        match graph.operation(node) {
            Operation::Multiply(a, b) => open.extend([a, b]),
            _ => factors.push(node),
        }
    }
    factors
}

/// The least order in which `node` goes to 0 with the bases, with all that multiplies it on a way to `root`.
fn order_below(graph: &Graph, nodes: &[Node], root: Node, node: Node, bases: &BTreeSet<Node>) -> Option<f64> {
    let orders = orders(graph, nodes, bases);
    let order = |node: Node| orders.get(&node).copied().unwrap_or(0.0);
    // Of what multiplies a node.
    let mut beside: HashMap<Node, f64> = HashMap::from([(root, 0.0)]);
    for &above in nodes.iter().rev() {
        let Some(&known) = beside.get(&above) else { continue };
        if above == node {
            return Some(known + order(node));
        }
        let mut least = |argument: Node, more: f64| {
            let entry = beside.entry(argument).or_insert(f64::INFINITY);
            *entry = entry.min(known + more);
        };
        match graph.operation(above) {
            Operation::Multiply(a, b) => {
                least(a, order(b));
                least(b, order(a));
            }
            Operation::MultiplyAdd(a, b, c) => {
                least(a, order(b));
                least(b, order(a));
                least(c, 0.0);
            }
            Operation::Divide(a, b) => {
                least(a, -order(b));
                least(b, order(a) - 2.0 * order(b));
            }
            Operation::Power(x, n) if n > 0 => least(x, f64::from(n - 1) * order(x)),
            Operation::Pair(PairFunction::Powf, x, exponent) => {
                if let Some(exponent) = graph.constant_value(exponent) {
                    least(x, (exponent - 1.0) * order(x));
                } else {
                    least(x, f64::NEG_INFINITY);
                }
            }
            Operation::Function(Function::Sqrt | Function::Cbrt | Function::Ln, x) => {
                // Not smooth at 0: what is below has no order of its own there.
                least(x, if order(x) > 0.0 { f64::NEG_INFINITY } else { 0.0 });
            }
            operation => operation.arguments().for_each(|argument| least(argument, 0.0)),
        }
    }
    None
}

/// The least orders in which nodes go to 0 with the bases; none where they need not.
fn orders(graph: &Graph, nodes: &[Node], bases: &BTreeSet<Node>) -> HashMap<Node, f64> {
    let mut orders: HashMap<Node, f64> = HashMap::new();
    for &node in nodes {
        let of = |node: &Node| orders.get(node).copied().unwrap_or(0.0);
        let order = if bases.contains(&node) {
            1.0
        } else {
            match graph.operation(node) {
                Operation::Constant(bits) if f64::from_bits(bits) == 0.0 => f64::INFINITY,
                Operation::Add(a, b) | Operation::Subtract(a, b) | Operation::Select(_, a, b) => {
                    of(&a).min(of(&b))
                }
                Operation::Multiply(a, b) => of(&a) + of(&b),
                Operation::MultiplyAdd(a, b, c) => (of(&a) + of(&b)).min(of(&c)),
                Operation::Divide(a, b) => of(&a) - of(&b),
                Operation::Negate(a) | Operation::Function(Function::Abs, a) => of(&a),
                Operation::Function(Function::Sqrt, a) => 0.5 * of(&a),
                Operation::Pair(PairFunction::Hypot, a, b) => of(&a).min(of(&b)),
                Operation::Pair(PairFunction::Copysign, a, _) => of(&a),
                Operation::Power(x, n) => f64::from(n) * of(&x),
                Operation::Pair(PairFunction::Powf, x, exponent) => {
                    graph.constant_value(exponent).map_or(0.0, |exponent| exponent * of(&x))
                }
                _ => 0.0,
            }
        };
        if order != 0.0 && !order.is_nan() {
            orders.insert(node, order);
        }
    }
    orders
}
