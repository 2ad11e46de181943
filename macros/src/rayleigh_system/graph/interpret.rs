//! A tape: graphs evaluated on numbers, which is what the emitted code computes, without compiling it.

use super::{Graph, Node, Operation};

/// The values of `roots` at (q, v), each operation's result passed through `rounded`. Truth values are 1 and
/// 0.
pub fn values(
    graph: &Graph,
    roots: &[Node],
    [q, v]: [&[f64]; 2],
    rounded: impl FnMut(f64) -> f64,
) -> Vec<f64> {
    let given = |operation| match operation {
        Operation::Coordinate(i) => q[i],
        Operation::Velocity(i) => v[i],
        other => panic!("{other:?} has no value here"),
    };
    values_of(graph, roots, given, rounded)
}

/// [`values`] where what is no computation has the value that is `given`.
pub fn values_of(
    graph: &Graph,
    roots: &[Node],
    given: impl Fn(Operation) -> f64,
    mut rounded: impl FnMut(f64) -> f64,
) -> Vec<f64> {
    let mut values = vec![f64::NAN; graph.len()];
    for node in graph.reachable(roots.iter().copied()) {
        let at = |node: Node| values[node.index()];
        let truth = |truth: bool| f64::from(u8::from(truth));
        values[node.index()] = match graph.operation(node) {
            given_one @ (Operation::Coordinate(_)
            | Operation::Velocity(_)
            | Operation::Input(_)
            | Operation::Parameter(_)) => given(given_one),
            Operation::Constant(bits) => f64::from_bits(bits),
            Operation::Add(a, b) => at(a) + at(b),
            Operation::Subtract(a, b) => at(a) - at(b),
            Operation::Multiply(a, b) => at(a) * at(b),
            Operation::Divide(a, b) => at(a) / at(b),
            Operation::Negate(a) => -at(a),
            Operation::Function(function, x) => function.method()(at(x)),
            Operation::Pair(function, a, b) => function.method()(at(a), at(b)),
            Operation::Characteristic(curve, x) => stand_in(at(x))[usize::from(curve.order)],
            Operation::MultiplyAdd(a, b, c) => at(a).mul_add(at(b), at(c)),
            Operation::Power(x, n) => at(x).powi(n),
            Operation::Select(condition, a, b) => {
                if at(condition) != 0.0 {
                    at(a)
                } else {
                    at(b)
                }
            }
            Operation::Compare(comparison, a, b) => truth(comparison.holds(at(a), at(b))),
            Operation::Is(predicate, x) => truth(predicate.method()(at(x))),
            Operation::Not(a) => truth(at(a) == 0.0),
            Operation::And(a, b) => truth(at(a) != 0.0 && at(b) != 0.0),
            Operation::Or(a, b) => truth(at(a) != 0.0 || at(b) != 0.0),
        };
        let is_computed = !matches!(
            graph.operation(node),
            Operation::Coordinate(_)
                | Operation::Velocity(_)
                | Operation::Input(_)
                | Operation::Parameter(_)
                | Operation::Constant(_)
                | Operation::Select(..)
        );
        if is_computed {
            values[node.index()] = rounded(values[node.index()]);
        }
    }
    roots.iter().map(|root| values[root.index()]).collect()
}

/// A function in place of any characteristic, which has none here, with its derivatives: the sine.
pub fn stand_in(x: f64) -> [f64; 4] {
    let (sine, cosine) = x.sin_cos();
    [sine, cosine, -sine, -cosine]
}
