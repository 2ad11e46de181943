//! A tape: graphs evaluated on numbers, which is what the emitted code computes, without compiling it.

use super::{Comparison, Function, Graph, Node, Operation, PairFunction, Predicate};

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
            Operation::Function(function, x) => elementary(function, at(x)),
            Operation::Pair(PairFunction::Powf, a, b) => at(a).powf(at(b)),
            Operation::Pair(PairFunction::Atan2, a, b) => at(a).atan2(at(b)),
            Operation::Pair(PairFunction::Hypot, a, b) => at(a).hypot(at(b)),
            Operation::Pair(PairFunction::Copysign, a, b) => at(a).copysign(at(b)),
            Operation::MultiplyAdd(a, b, c) => at(a).mul_add(at(b), at(c)),
            Operation::Power(x, n) => at(x).powi(n),
            Operation::Select(condition, a, b) => {
                if at(condition) != 0.0 {
                    at(a)
                } else {
                    at(b)
                }
            }
            Operation::Compare(comparison, a, b) => {
                let (a, b) = (at(a), at(b));
                truth(match comparison {
                    Comparison::Less => a < b,
                    Comparison::LessOrEqual => a <= b,
                    Comparison::Greater => a > b,
                    Comparison::GreaterOrEqual => a >= b,
                    Comparison::Equal => a == b,
                    Comparison::NotEqual => a != b,
                })
            }
            Operation::Is(predicate, x) => {
                let x = at(x);
                truth(match predicate {
                    Predicate::Nan => x.is_nan(),
                    Predicate::Finite => x.is_finite(),
                    Predicate::Infinite => x.is_infinite(),
                    Predicate::SignNegative => x.is_sign_negative(),
                    Predicate::SignPositive => x.is_sign_positive(),
                })
            }
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

/// The elementary function at x.
pub fn elementary(function: Function, x: f64) -> f64 {
    match function {
        Function::Recip => x.recip(),
        Function::Exp => x.exp(),
        Function::Exp2 => x.exp2(),
        Function::ExpM1 => x.exp_m1(),
        Function::Ln => x.ln(),
        Function::Log2 => x.log2(),
        Function::Log10 => x.log10(),
        Function::Ln1p => x.ln_1p(),
        Function::Sin => x.sin(),
        Function::Cos => x.cos(),
        Function::Tan => x.tan(),
        Function::Asin => x.asin(),
        Function::Acos => x.acos(),
        Function::Atan => x.atan(),
        Function::Sinh => x.sinh(),
        Function::Cosh => x.cosh(),
        Function::Tanh => x.tanh(),
        Function::Asinh => x.asinh(),
        Function::Acosh => x.acosh(),
        Function::Atanh => x.atanh(),
        Function::Sqrt => x.sqrt(),
        Function::Cbrt => x.cbrt(),
        Function::Abs => x.abs(),
        Function::Signum => x.signum(),
    }
}
