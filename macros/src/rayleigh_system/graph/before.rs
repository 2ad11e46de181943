//! Expressions that are known before a run.

use super::{Graph, Node, Operation};

/// Which expressions neither change with q, v and t nor hold a parameter of the function, whose names are
/// `taken`; and which of them read a field or the input, which is held.
pub fn before_the_run(graph: &Graph, nodes: &[Node], taken: &[&str]) -> (Vec<bool>, Vec<bool>) {
    let (mut is_constant, mut reads) = (vec![false; graph.len()], vec![false; graph.len()]);
    for &node in nodes {
        let operation = graph.operation(node);
        let (own_constant, own_reads) = match operation {
            Operation::Parameter(index) => {
                let parameter = graph.parameter(index);
                let first = parameter.tokens.clone().into_iter().next().map(|word| word.to_string());
                let is_taken = first.is_some_and(|word| taken.contains(&word.as_str()));
                (!is_taken && !graph.is_time(operation), parameter.reads_self())
            }
            Operation::Characteristic(curve, _) => (true, graph.parameter(curve.parameter).reads_self()),
            Operation::Input(_) => (true, true),
            Operation::Coordinate(_) | Operation::Velocity(_) => (false, false),
            _ => (true, false),
        };
        is_constant[node.index()] =
            own_constant && operation.arguments().all(|argument| is_constant[argument.index()]);
        reads[node.index()] = own_reads || operation.arguments().any(|argument| reads[argument.index()]);
    }
    (is_constant, reads)
}
