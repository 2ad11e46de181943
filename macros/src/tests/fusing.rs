//! Sums rounded with the products in them: values stay, and how many operations are left.

use std::collections::HashMap;

use quote::quote;

use super::oracle::Random;
use crate::rayleigh_system::graph::{Comparison, Graph, Node, Operation, interpret};
use crate::rayleigh_system::{Runtime, rayleigh_system};

/// A graph with q0 … q3.
struct Expressions {
    graph: Graph,
    q: [Node; 4],
}

impl Expressions {
    fn new() -> Self {
        let mut graph = Graph::default();
        let q = [0, 1, 2, 3].map(|index| graph.node(Operation::Coordinate(index)));
        Self { graph, q }
    }

    /// Sums, differences, products and signs of what is there, often of the same; some of the last are
    /// outputs.
    fn random(&mut self, random: &mut Random, count: usize) -> Vec<Node> {
        let mut all = self.q.to_vec();
        for _ in 0..count {
            let [a, b] = [0, 1].map(|_| {
                let nearby = if random.below(3) == 0 { all.len() } else { 6.min(all.len()) };
                all[all.len() - 1 - random.below(nearby)]
            });
            let operation = match random.below(8) {
                0..=2 => Operation::Multiply(a, b),
                3 | 4 => Operation::Add(a, b),
                5 | 6 => Operation::Subtract(a, b),
                _ => Operation::Negate(a),
            };
            all.push(self.graph.node(operation));
        }
        (0..3).map(|_| all[all.len() - 1 - random.below(8.min(count))]).collect()
    }
}

fn operations(graph: &Graph, outputs: &[Node]) -> HashMap<&'static str, usize> {
    let mut counts = HashMap::new();
    for node in graph.reachable(outputs.iter().copied()) {
        let name = match graph.operation(node) {
            Operation::Multiply(..) => "product",
            Operation::Add(..) | Operation::Subtract(..) => "sum",
            Operation::MultiplyAdd(..) => "both",
            _ => continue,
        };
        *counts.entry(name).or_default() += 1;
    }
    counts
}

/// At integers nothing is rounded, so that not a bit may change; elsewhere the roundings are others.
#[test]
fn random_expressions_keep_their_values() {
    let (mut fused_sums, mut compared, mut otherwise_rounded) = (0, 0, 0);
    for seed in 1..=4000 {
        let (mut e, mut random) = (Expressions::new(), Random(seed));
        let outputs = e.random(&mut random, 14);
        let fused = e.graph.fused(&outputs, 0);
        let (before, after) = (operations(&e.graph, &outputs), operations(&e.graph, &fused));
        let count = |of: &HashMap<_, usize>, name| of.get(name).copied().unwrap_or(0);
        let both = count(&after, "both");
        fused_sums += both;
        let sums = count(&after, "sum") + both;
        assert!(sums <= count(&before, "sum"), "seed {seed}: more sums");
        assert!(count(&after, "product") + usize::from(both > 0) <= count(&before, "product").max(1));
        let points: Vec<Vec<f64>> =
            (0..4).map(|_| (0..4).map(|_| random.below(7) as f64 - 3.0).collect()).collect();
        for point in &points {
            let at = |roots: &[Node], scale: f64| {
                let q: Vec<f64> = point.iter().map(|x| scale * x).collect();
                interpret::values(&e.graph, roots, [&q, &[]], |x| x)
            };
            let [exact, same] = [&outputs, &fused].map(|roots| at(roots, 1.0));
            // Products of products soon leave the integers that are numbers.
            for (exact, same) in exact.iter().zip(&same).filter(|(exact, _)| exact.abs() < 1e9) {
                assert_eq!(exact, same, "seed {seed}");
                compared += 1;
            }
            otherwise_rounded += usize::from(at(&outputs, 0.1) != at(&fused, 0.1));
        }
    }
    assert!(fused_sums > 3000 && compared > 20_000, "{fused_sums} sums, {compared} values");
    assert!(otherwise_rounded > 1000, "{otherwise_rounded}");
}

#[test]
fn of_two_products_one_is_rounded_by_itself() {
    let mut e = Expressions::new();
    let [a, b, c, d] = e.q;
    let products = [(a, b), (c, d)].map(|(x, y)| e.graph.node(Operation::Multiply(x, y)));
    let sum = e.graph.node(Operation::Add(products[0], products[1]));
    let fused = e.graph.fused(&[sum], 0);
    assert_eq!(operations(&e.graph, &fused), HashMap::from([("product", 1), ("both", 1)]));
    // Where one of them is needed elsewhere, the other is taken.
    let fused = e.graph.fused(&[sum, products[0]], 0);
    assert_eq!(fused, [e.graph.node(Operation::MultiplyAdd(c, d, products[0])), products[0]]);
}

#[test]
fn what_the_user_wrote_and_conditions_stay() {
    let mut e = Expressions::new();
    let [a, b, c, d] = e.q;
    let product = e.graph.node(Operation::Multiply(a, b));
    let sum = e.graph.node(Operation::Subtract(c, product));
    let condition = e.graph.node(Operation::Compare(Comparison::Less, sum, d));
    let output = e.graph.node(Operation::Select(condition, c, d));
    assert_eq!(e.graph.fused(&[output], 0), [output]);
    let written = e.graph.len();
    assert_eq!(e.graph.fused(&[sum], written), [sum]);
    // The control: the same as a derivative.
    let opposite = e.graph.negated(a);
    assert_eq!(e.graph.fused(&[sum], 0), [e.graph.node(Operation::MultiplyAdd(opposite, b, c))]);
}

/// q0 q1 − q0 q1 is 0, or NaN where a factor is infinite; what rounding leaves of a product is neither.
#[test]
fn a_product_less_itself_leaves_no_rounding() {
    let mut e = Expressions::new();
    let product = e.graph.node(Operation::Multiply(e.q[0], e.q[1]));
    let nothing = e.graph.node(Operation::Subtract(product, product));
    assert_eq!(e.graph.fused(&[nothing], 0), [nothing]);
}

/// Where no instruction can stand for the operation, the option is refused at its word.
#[test]
fn functions_in_place_of_the_instruction_are_refused() {
    let expansion = |runtime| {
        let system = quote! { fn falling(q: [f64; 1], v: [f64; 1]) -> f64 { 0.5 * v[0] * v[0] - q[0] } };
        rayleigh_system(runtime, quote!(multiply_add = fused), system).to_string()
    };
    for runtime in [Runtime::PORTABLE, Runtime::CORE] {
        assert!(expansion(runtime).contains("a function stands for the instruction"));
    }
    let accepted = expansion(Runtime::STD);
    assert!(accepted.contains("with_fused_multiply_add") && !accepted.contains("compile_error"));
}
