//! Derivatives in fewer operations: how many are left, and that values stay.

use crate::rayleigh_system::graph::{Comparison, Function, Graph, Node, Operation, interpret};

/// A graph with q and v of three entries each.
struct Expressions {
    graph: Graph,
    q: [Node; 3],
    v: [Node; 3],
}

impl Expressions {
    fn new() -> Self {
        let mut graph = Graph::default();
        let q = [0, 1, 2].map(|index| graph.node(Operation::Coordinate(index)));
        let v = [0, 1, 2].map(|index| graph.node(Operation::Velocity(index)));
        Self { graph, q, v }
    }

    fn product(&mut self, factors: &[Node]) -> Node {
        let mut factors = factors.iter().copied();
        let first = factors.next().expect("a factor");
        factors.fold(first, |product, factor| self.graph.node(Operation::Multiply(product, factor)))
    }

    fn sum(&mut self, a: Node, b: Node) -> Node {
        self.graph.node(Operation::Add(a, b))
    }

    /// The outputs rewritten, after a check that they have the same values, and how many operations they
    /// take.
    fn factored(&mut self, outputs: &[Node], written: usize) -> (Vec<Node>, usize) {
        let factored = self.graph.factored(outputs, written);
        let point = [&[0.3, -1.7, 2.9][..], &[0.11, 5.3, -0.7]];
        let [before, after] =
            [outputs, &factored].map(|roots| interpret::values(&self.graph, roots, point, |x| x));
        for (before, after) in before.iter().zip(&after) {
            assert!((before - after).abs() <= 4.0 * f64::EPSILON * before.abs(), "{before} became {after}");
        }
        let operations = self
            .graph
            .reachable(factored.iter().copied())
            .into_iter()
            .filter(|&node| self.graph.operation(node).arguments().next().is_some())
            .count();
        (factored, operations)
    }
}

#[test]
fn constants_meet() {
    let mut e = Expressions::new();
    let [half, two] = [0.5, 2.0].map(|value| e.graph.constant(value));
    // 2 ((½ q0) v0) = q0 v0.
    let inner = e.product(&[half, e.q[0], e.v[0]]);
    let output = e.product(&[two, inner]);
    let (factored, operations) = e.factored(&[output], 0);
    assert_eq!(operations, 1);
    assert_eq!(factored[0], e.graph.node(Operation::Multiply(e.q[0], e.v[0])));
    // t + t with t = (½ q1) v1, shared with nothing else.
    let t = e.product(&[half, e.q[1], e.v[1]]);
    let output = e.sum(t, t);
    assert_eq!(e.factored(&[output], 0).1, 1);
}

#[test]
fn constants_that_do_not_meet_exactly_stay_apart() {
    let mut e = Expressions::new();
    let [a, b] = [0.1, 0.3].map(|value| e.graph.constant(value));
    let output = e.product(&[a, e.q[0], b]);
    assert_eq!(e.factored(&[output], 0).1, 2);
}

#[test]
fn common_factors_stand_once() {
    let mut e = Expressions::new();
    // q0 v0 v2 + q0 v1 v2 = q0 v2 (v0 + v1): three operations, not five.
    let (a, b) = (e.product(&[e.q[0], e.v[0], e.v[2]]), e.product(&[e.q[0], e.v[1], e.v[2]]));
    let output = e.sum(a, b);
    assert_eq!(e.factored(&[output], 0).1, 3);
    // q0² + q0 q1 + q0 q2 − q1 q2, one product apart.
    let square = e.product(&[e.q[0], e.q[0]]);
    let (b, c) = (e.product(&[e.q[0], e.q[1]]), e.product(&[e.q[0], e.q[2]]));
    let d = e.product(&[e.q[1], e.q[2]]);
    let sum = e.sum(square, b);
    let sum = e.sum(sum, c);
    let output = e.graph.node(Operation::Subtract(sum, d));
    assert!(e.factored(&[output], 0).1 <= 5);
}

#[test]
fn a_sum_takes_up_a_constant_that_costs_nothing_there() {
    let mut e = Expressions::new();
    let [half, two] = [0.5, 2.0].map(|value| e.graph.constant(value));
    // 2 (½ + ½ q0) v0 = (1 + q0) v0.
    let scaled = e.product(&[half, e.q[0]]);
    let sum = e.sum(half, scaled);
    let output = e.product(&[two, sum, e.v[0]]);
    assert_eq!(e.factored(&[output], 0).1, 2);
}

#[test]
fn what_is_used_twice_stays_one_expression() {
    let mut e = Expressions::new();
    let shared = e.product(&[e.q[0], e.v[0]]);
    let with_first = e.product(&[shared, e.v[1]]);
    let with_second = e.product(&[shared, e.v[2]]);
    let sum = e.sum(with_first, with_second);
    let (_, operations) = e.factored(&[sum, shared], 0);
    // q0 v0, v1 + v2, and their product.
    assert_eq!(operations, 3);
}

#[test]
fn what_the_user_wrote_stays() {
    let mut e = Expressions::new();
    let (a, b) = (e.product(&[e.q[0], e.v[0]]), e.product(&[e.q[0], e.v[1]]));
    let output = e.sum(a, b);
    let written = e.graph.len();
    assert_eq!(e.factored(&[output], written).0, [output]);
    // The control: the same as a derivative.
    assert_ne!(e.factored(&[output], 0).0, [output]);
}

#[test]
fn conditions_choose_as_they_were_written() {
    let mut e = Expressions::new();
    let (a, b) = (e.product(&[e.q[0], e.v[0]]), e.product(&[e.q[0], e.v[1]]));
    let sum = e.sum(a, b);
    let condition = e.graph.node(Operation::Compare(Comparison::Less, sum, e.q[1]));
    let output = e.graph.node(Operation::Select(condition, e.q[0], e.q[1]));
    assert_eq!(e.factored(&[output], 0).0, [output]);
    // The control: the same sum outside a condition.
    assert_ne!(e.factored(&[sum], 0).0, [sum]);
}

#[test]
fn nothing_is_cancelled() {
    let mut e = Expressions::new();
    // q0 v0 − v0 q0 is NaN where q0 is infinite, and has to stay so.
    let product = e.product(&[e.q[0], e.v[0]]);
    let output = e.graph.node(Operation::Subtract(product, product));
    let (factored, _) = e.factored(&[output], 0);
    let point = [&[f64::INFINITY, 0.0, 0.0][..], &[1.0, 0.0, 0.0]];
    assert!(interpret::values(&e.graph, &factored, point, |x| x)[0].is_nan());
}

#[test]
fn what_cancelled_is_no_common_factor() {
    let mut e = Expressions::new();
    let zero = e.graph.constant(0.0);
    // q0 (0 v0 + 0 v1): the constant that the terms share cannot be divided by.
    let (a, b) = (e.product(&[zero, e.q[0], e.v[0]]), e.product(&[zero, e.q[0], e.v[1]]));
    let output = e.sum(a, b);
    e.factored(&[output], 0);
}

/// Sines and cosines left in what `outputs` become, after a check that they have the same values.
fn angles(e: &mut Expressions, outputs: &[Node]) -> usize {
    let fewer = e.graph.with_fewer_angles(outputs);
    for point in [[[0.3, -1.7, 2.9], [0.11, 5.3, -0.7]], [[-4.1, 0.6, 1.2], [0.9, -2.2, 0.4]]] {
        let point = [&point[0][..], &point[1]];
        let [before, after] = [outputs, &fewer].map(|roots| interpret::values(&e.graph, roots, point, |x| x));
        for (before, after) in before.iter().zip(&after) {
            assert!((before - after).abs() <= 8.0 * f64::EPSILON, "{before} became {after}");
        }
    }
    let angle = |node: Node| match e.graph.operation(node) {
        Operation::Function(Function::Sin | Function::Cos, angle) => Some(angle),
        _ => None,
    };
    let mut angles: Vec<Node> = e.graph.reachable(fewer).into_iter().filter_map(angle).collect();
    angles.sort_unstable();
    angles.dedup();
    angles.len()
}

#[test]
fn sums_of_angles_need_none_of_their_own() {
    let mut e = Expressions::new();
    let [a, b, c] = e.q;
    let (difference, sum) = (e.graph.minus(a, b), e.graph.plus(a, b));
    let all = e.graph.plus(sum, c);
    let sine = |e: &mut Expressions, x| e.graph.function(Function::Sin, x);
    let cosine = |e: &mut Expressions, x| e.graph.function(Function::Cos, x);
    // The sum of all comes before the sum of two that it is made of.
    let compound =
        [sine(&mut e, all), cosine(&mut e, sum), sine(&mut e, difference), cosine(&mut e, difference)];
    let nested = sine(&mut e, compound[2]);
    let of_each = [sine(&mut e, a), cosine(&mut e, b)];
    let together = [&compound[..], &of_each, &[nested]].concat();
    // a, b, c + (a + b), of which c has none, and the sine of a sine.
    assert_eq!(angles(&mut e, &together), 4);
    let of_last = cosine(&mut e, c);
    assert_eq!(angles(&mut e, &[&together[..], &[of_last]].concat()), 4);
    // The control: where one of the two has none, it stays.
    assert_eq!(angles(&mut e, &[compound[1], compound[3], of_each[0]]), 3);
    // What a condition is made of stays.
    let condition = e.graph.node(Operation::Compare(Comparison::Less, compound[2], c));
    let chosen = e.graph.select(condition, compound[3], c);
    assert_eq!(angles(&mut e, &[chosen, of_each[0], of_each[1]]), 3);
}
