//! First and second partial derivatives of each operation by its arguments.
//!
//! Where a derivative does not exist the values are those documented on the runtime's `Real`.

use std::f64::consts::{LN_2, LOG2_E, LOG10_E};

use super::super::graph::{Comparison, Function, Graph, Node, Operation, PairFunction, Predicate};
use super::Order;

/// Partial derivatives of an operation; what is absent is 0 by structure. No argument occurs twice.
#[derive(Default)]
pub struct Partials {
    /// (a, ∂/∂a).
    pub first: Vec<(Node, Node)>,
    /// (a, b, ∂²/∂a∂b), each pair once.
    pub second: Vec<(Node, Node, Node)>,
}

/// The partial derivatives of `node` by those arguments that depend on q or v.
pub fn partials(graph: &mut Graph, node: Node, operation: Operation, order: Order) -> Partials {
    let mut partials = match operation {
        Operation::Add(a, b) if a == b => {
            let two = graph.constant(2.0);
            Partials { first: vec![(a, two)], second: Vec::new() }
        }
        Operation::Add(a, b) => {
            let one = graph.one();
            Partials { first: vec![(a, one), (b, one)], second: Vec::new() }
        }
        Operation::Subtract(a, b) if a != b => {
            let (one, minus) = (graph.one(), graph.constant(-1.0));
            Partials { first: vec![(a, one), (b, minus)], second: Vec::new() }
        }
        Operation::Multiply(a, b) if a == b => {
            let (slope, two) = (graph.scaled(2.0, a), graph.constant(2.0));
            Partials { first: vec![(a, slope)], second: vec![(a, a, two)] }
        }
        // A literal 0 in front leaves nothing that depends on anything.
        Operation::Multiply(a, b)
            if [a, b].iter().any(|&factor| graph.constant_value(factor) == Some(0.0)) =>
        {
            Partials::default()
        }
        Operation::Multiply(a, b) => {
            let one = graph.one();
            Partials { first: vec![(a, b), (b, a)], second: vec![(a, b, one)] }
        }
        Operation::MultiplyAdd(a, b, c) => {
            let product = graph.node(Operation::Multiply(a, b));
            let mut of_product = partials(graph, product, graph.operation(product), order);
            let one = graph.one();
            match of_product.first.iter().position(|&(argument, _)| argument == c) {
                Some(index) => of_product.first[index].1 = graph.plus(of_product.first[index].1, one),
                None => of_product.first.push((c, one)),
            }
            of_product
        }
        Operation::Divide(a, b) if a != b => quotient(graph, node, a, b),
        Operation::Negate(a) => {
            let minus = graph.constant(-1.0);
            Partials { first: vec![(a, minus)], second: Vec::new() }
        }
        Operation::Function(function, x) => {
            let (first, second) = of_function(graph, function, x, node);
            #[cfg(test)]
            let (first, second) = fault::injected(graph, function, first, second);
            Partials {
                first: first.map(|first| (x, first)).into_iter().collect(),
                second: second.map(|second| (x, x, second)).into_iter().collect(),
            }
        }
        Operation::Pair(function, a, b) => of_pair(graph, function, a, b, node),
        Operation::Characteristic(curve, x) => {
            let first = graph.slope(curve, x);
            let second = match graph.operation(first) {
                Operation::Characteristic(slope, _) if order == Order::Second => {
                    vec![(x, x, graph.slope(slope, x))]
                }
                _ => Vec::new(),
            };
            Partials { first: vec![(x, first)], second }
        }
        Operation::Power(x, n) => {
            let exponent = f64::from(n);
            let (first, second) = (graph.power(x, n.saturating_sub(1)), graph.power(x, n.saturating_sub(2)));
            let first = graph.scaled(exponent, first);
            let second = graph.scaled(exponent * (exponent - 1.0), second);
            Partials { first: vec![(x, first)], second: vec![(x, x, second)] }
        }
        // a − a and a/a are constant; truth values have no derivative; selections and variables are the
        // sweep's business.
        _ => Partials::default(),
    };
    partials.first.retain(|(a, _)| graph.depends(*a));
    partials.second.retain(|(a, b, _)| order == Order::Second && graph.depends(*a) && graph.depends(*b));
    partials
}

/// y = a/b: ∂y/∂a = 1/b, ∂y/∂b = −y/b.
fn quotient(graph: &mut Graph, y: Node, a: Node, b: Node) -> Partials {
    let r = graph.reciprocal(b);
    if !graph.depends(b) {
        return Partials { first: vec![(a, r)], second: Vec::new() };
    }
    let by_b = graph.times(y, r);
    let square = graph.times(r, r);
    let curvature = graph.times(by_b, r);
    let curvature = graph.scaled(2.0, curvature);
    let (by_b, mixed) = (graph.negated(by_b), graph.negated(square));
    Partials { first: vec![(a, r), (b, by_b)], second: vec![(a, b, mixed), (b, b, curvature)] }
}

/// g′(x) and g″(x) where y = g(x).
fn of_function(graph: &mut Graph, function: Function, x: Node, y: Node) -> (Option<Node>, Option<Node>) {
    let one = graph.one();
    let (first, second) = match function {
        Function::Exp => (y, y),
        Function::Exp2 => {
            let first = graph.scaled(LN_2, y);
            (first, graph.scaled(LN_2, first))
        }
        Function::ExpM1 => {
            let exp = graph.function(Function::Exp, x);
            (exp, exp)
        }
        Function::Ln => logarithm(graph, x, 1.0),
        Function::Log2 => logarithm(graph, x, LOG2_E),
        Function::Log10 => logarithm(graph, x, LOG10_E),
        Function::Ln1p => {
            let shifted = graph.plus(one, x);
            logarithm(graph, shifted, 1.0)
        }
        Function::Recip => {
            let square = graph.times(y, y);
            let cube = graph.times(square, y);
            (graph.negated(square), graph.scaled(2.0, cube))
        }
        Function::Sin => (graph.function(Function::Cos, x), graph.negated(y)),
        Function::Cos => {
            let sine = graph.function(Function::Sin, x);
            (graph.negated(sine), graph.negated(y))
        }
        Function::Tan => {
            let square = graph.times(y, y);
            let slope = graph.plus(one, square);
            let product = graph.times(y, slope);
            (slope, graph.scaled(2.0, product))
        }
        Function::Asin | Function::Acos => {
            let (less, more) = (graph.minus(one, x), graph.plus(one, x));
            let (first, second) = inverse_root(graph, less, more, x);
            if function == Function::Asin {
                (first, second)
            } else {
                (graph.negated(first), graph.negated(second))
            }
        }
        Function::Atan => {
            let square = graph.times(x, x);
            let sum = graph.plus(one, square);
            let first = graph.reciprocal(sum);
            let square = graph.times(first, first);
            let second = graph.times(x, square);
            (first, graph.scaled(-2.0, second))
        }
        Function::Sinh => (graph.function(Function::Cosh, x), y),
        Function::Cosh => (graph.function(Function::Sinh, x), y),
        Function::Tanh => {
            // 1 − y² = 4d/(1 + d)² with d = e^(−2|x|), which keeps its digits where y is close to 1.
            let size = graph.function(Function::Abs, x);
            let exponent = graph.scaled(-2.0, size);
            let decay = graph.function(Function::Exp, exponent);
            let sum = graph.plus(one, decay);
            let square = graph.times(sum, sum);
            let numerator = graph.scaled(4.0, decay);
            let slope = graph.over(numerator, square);
            let second = graph.times(y, slope);
            (slope, graph.scaled(-2.0, second))
        }
        Function::Asinh => {
            let square = graph.times(x, x);
            let sum = graph.plus(one, square);
            let (first, second) = inverse_root(graph, sum, one, x);
            (first, graph.negated(second))
        }
        Function::Acosh => {
            let (less, more) = (graph.minus(x, one), graph.plus(x, one));
            let (first, second) = inverse_root(graph, less, more, x);
            (first, graph.negated(second))
        }
        Function::Atanh => {
            let (less, more) = (graph.minus(one, x), graph.plus(one, x));
            let product = graph.times(less, more);
            let first = graph.reciprocal(product);
            let square = graph.times(first, first);
            let second = graph.times(x, square);
            (first, graph.scaled(2.0, second))
        }
        Function::Sqrt => {
            let half = graph.constant(0.5);
            let first = graph.over(half, y);
            let slope = graph.over(first, x);
            (first, graph.scaled(-0.5, slope))
        }
        Function::Cbrt => {
            let square = graph.times(y, y);
            let triple = graph.scaled(3.0, square);
            let first = graph.reciprocal(triple);
            let (numerator, denominator) = (graph.scaled(-2.0, first), graph.scaled(3.0, x));
            (first, graph.over(numerator, denominator))
        }
        Function::Abs => return (Some(graph.function(Function::Signum, x)), None),
        Function::Signum => return (None, None),
    };
    (Some(first), Some(second))
}

/// Derivatives of scale × ln x.
fn logarithm(graph: &mut Graph, x: Node, scale: f64) -> (Node, Node) {
    let r = graph.reciprocal(x);
    let first = graph.scaled(scale, r);
    let second = graph.times(first, r);
    (first, graph.negated(second))
}

/// 1/√(ab) and x/√(ab)³.
fn inverse_root(graph: &mut Graph, a: Node, b: Node, x: Node) -> (Node, Node) {
    let product = graph.times(a, b);
    let square = graph.reciprocal(product);
    let first = graph.function(Function::Sqrt, square);
    let cube = graph.times(first, square);
    (first, graph.times(x, cube))
}

fn of_pair(graph: &mut Graph, function: PairFunction, a: Node, b: Node, y: Node) -> Partials {
    match function {
        PairFunction::Powf if graph.depends(b) => power_of_both(graph, a, b, y),
        PairFunction::Powf => {
            let (first, second) = real_power(graph, a, b);
            Partials {
                first: first.map(|first| (a, first)).into_iter().collect(),
                second: second.map(|second| (a, a, second)).into_iter().collect(),
            }
        }
        PairFunction::Copysign => {
            let (own, other) = (graph.function(Function::Signum, a), graph.function(Function::Signum, b));
            let sign = graph.times(own, other);
            Partials { first: vec![(a, sign)], second: Vec::new() }
        }
        // √2 |a|, straight on both sides; and an angle that does not change.
        PairFunction::Hypot if a == b => {
            let slope = graph.over(a, y);
            let slope = graph.scaled(2.0, slope);
            Partials { first: vec![(a, slope)], second: Vec::new() }
        }
        PairFunction::Atan2 if a == b => Partials::default(),
        PairFunction::Hypot => {
            // r = √(a² + b²): (a, b)/r, and the curvature of the circle across.
            let (cosine, sine) = (graph.over(a, y), graph.over(b, y));
            // Divided before they are multiplied: squares of a sine that is small could be none.
            let (cosine_over, sine_over) = (graph.over(cosine, y), graph.over(sine, y));
            let (aa, ab, bb) = (
                graph.times(sine, sine_over),
                graph.times(cosine, sine_over),
                graph.times(cosine, cosine_over),
            );
            let ab = graph.negated(ab);
            Partials { first: vec![(a, cosine), (b, sine)], second: vec![(a, a, aa), (a, b, ab), (b, b, bb)] }
        }
        PairFunction::Atan2 => {
            // The angle of (b, a): (b da − a db)/r².
            let r = graph.node(Operation::Pair(PairFunction::Hypot, a, b));
            let (sine, cosine) = (graph.over(a, r), graph.over(b, r));
            let (by_a, by_b) = (graph.over(cosine, r), graph.over(sine, r));
            let product = graph.times(by_a, by_b);
            let product = graph.scaled(2.0, product);
            let (aa, bb) = (graph.times(by_a, by_a), graph.times(by_b, by_b));
            let mixed = graph.minus(bb, aa);
            let (by_b, negated) = (graph.negated(by_b), graph.negated(product));
            Partials {
                first: vec![(a, by_a), (b, by_b)],
                second: vec![(a, a, negated), (a, b, mixed), (b, b, product)],
            }
        }
    }
}

/// n xⁿ⁻¹ and n(n−1) xⁿ⁻² for a constant n; 0 where the factor vanishes, also where the power itself is
/// infinite.
fn real_power(graph: &mut Graph, x: Node, n: Node) -> (Option<Node>, Option<Node>) {
    let mut factor = graph.one();
    let mut exponent = n;
    let mut terms = [None; 2];
    for term in &mut terms {
        factor = graph.times(factor, exponent);
        if graph.constant_value(factor) == Some(0.0) {
            break;
        }
        let one = graph.one();
        exponent = graph.minus(exponent, one);
        let power = graph.node(Operation::Pair(PairFunction::Powf, x, exponent));
        let product = graph.times(factor, power);
        *term = Some(if graph.constant_value(factor).is_some() {
            product
        } else {
            let zero = graph.constant(0.0);
            let vanishes = graph.node(Operation::Compare(Comparison::Equal, factor, zero));
            graph.select(vanishes, factor, product)
        });
    }
    (terms[0], terms[1])
}

/// y = xⁿ with n depending on q or v: by x as if n were constant, by n as e^(n ln x).
fn power_of_both(graph: &mut Graph, x: Node, n: Node, y: Node) -> Partials {
    let one = graph.one();
    let two = graph.constant(2.0);
    let (less, twice_less) = (graph.minus(n, one), graph.minus(n, two));
    let [power, next] =
        [less, twice_less].map(|exponent| graph.node(Operation::Pair(PairFunction::Powf, x, exponent)));
    let log = graph.function(Function::Ln, x);
    let (by_x, by_n) = (graph.times(n, power), graph.times(y, log));
    let falling = graph.times(n, less);
    let xx = graph.times(falling, next);
    let product = graph.times(n, by_n);
    let sum = graph.plus(product, y);
    let xn = graph.over(sum, x);
    let nn = graph.times(by_n, log);
    if x == n {
        // xˣ: the sums over both places.
        let first = graph.plus(by_x, by_n);
        let twice = graph.scaled(2.0, xn);
        let second = graph.plus(xx, twice);
        let second = graph.plus(second, nn);
        return Partials { first: vec![(x, first)], second: vec![(x, x, second)] };
    }
    Partials { first: vec![(x, by_x), (n, by_n)], second: vec![(x, x, xx), (x, n, xn), (n, n, nn)] }
}

/// The smaller or larger of two numbers as the runtime's `Real` has it: the first of equal ones, NaN only
/// where both are.
pub fn extremum(graph: &mut Graph, comparison: Comparison, a: Node, b: Node) -> Node {
    let wins = graph.node(Operation::Compare(comparison, b, a));
    let missing = graph.node(Operation::Is(Predicate::Nan, a));
    let other = graph.node(Operation::Or(wins, missing));
    graph.select(other, b, a)
}

/// A wrong rule on purpose: the control of the tests that compare derivatives.
#[cfg(test)]
pub mod fault {
    use std::cell::Cell;

    use super::{Function, Graph, Node};

    thread_local! {
        /// The function whose first (0) or second (1) derivative is off by one part in 10⁹.
        pub static FAULT: Cell<Option<(Function, usize)>> = const { Cell::new(None) };
    }

    pub fn injected(
        graph: &mut Graph,
        function: Function,
        first: Option<Node>,
        second: Option<Node>,
    ) -> (Option<Node>, Option<Node>) {
        let mut wrong = |node| graph.scaled(1.0 + 1e-9, node);
        match FAULT.get() {
            Some((faulty, 0)) if faulty == function => (first.map(&mut wrong), second),
            Some((faulty, 1)) if faulty == function => (first, second.map(&mut wrong)),
            _ => (first, second),
        }
    }
}
