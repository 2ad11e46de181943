//! Derivatives of a graph, as expressions of the same graph.
//!
//! Reverse accumulation: from the result down, each node hands its derivative on to its arguments. For second
//! derivatives the same sweep carries the symmetric edges ∂²f/∂a∂b between the nodes still open (R. M. Gower
//! and M. P. Mello, *A new framework for the computation of Hessians*, Optimization Methods and Software 27,
//! 2012): only pairs that interact get an entry, each once. A derivative that vanishes by structure is absent
//! from the maps.
//!
//! A selection stands for the function of q and v that it selects: its branches are differentiated whole, and
//! the selection chooses between the results, so that nothing of a rejected branch is multiplied by anything;
//! and where a variable occurs in one branch alone, neither is the 0 of the other.

mod factor;
pub mod partials;
mod vanishing;

use std::collections::{BTreeMap, HashMap};
use std::rc::Rc;

use super::graph::{Graph, Node, Operation};
use factor::{Factor, Local};
pub use partials::extremum;
use partials::partials;
use vanishing::Vanishing;

/// First derivatives by the variables, where there are any.
pub type Gradient = BTreeMap<Node, Node>;

/// Second derivatives by pairs of variables in order, where there are any.
pub type Hessian = BTreeMap<(Node, Node), Node>;

/// Gradient and Hessian of one node.
#[derive(Clone, Default)]
pub struct Derivatives {
    pub gradient: Gradient,
    pub hessian: Hessian,
}

/// How far to differentiate.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub enum Order {
    First,
    Second,
}

/// How many selections deep branches are differentiated on the way: beyond that they are first, from the
/// inside.
const DEEPEST: u32 = 32;

/// Differentiates nodes of a graph; selections that occur in several are differentiated once.
#[derive(Default)]
pub struct Differentiation {
    /// By root, order and the symbol of what gets names.
    known: HashMap<(Node, Order, Option<String>), Rc<Derivatives>>,
}

impl Differentiation {
    /// ∂root/∂q, ∂root/∂v and ∂root/∂u.
    pub fn gradient(&mut self, graph: &mut Graph, root: Node) -> Gradient {
        self.select_from_inside(graph, root, Order::First);
        self.differentiated(graph, root, Order::First, None).gradient.clone()
    }

    /// First and second derivatives of `root`. Those by the user's named expressions get names: dL/ds is
    /// `dl_ds` where `symbol` is `l`.
    pub fn hessian(&mut self, graph: &mut Graph, root: Node, symbol: &str) -> Derivatives {
        self.select_from_inside(graph, root, Order::Second);
        Derivatives::clone(&self.differentiated(graph, root, Order::Second, Some(symbol)))
    }

    /// Differentiates selections that are nested deeply, so that a chain of thousands needs no deep
    /// recursion.
    fn select_from_inside(&mut self, graph: &mut Graph, root: Node, order: Order) {
        let mut depths: HashMap<Node, u32> = HashMap::new();
        for node in graph.reachable([root]) {
            let operation = graph.operation(node);
            let depth = operation.arguments().map(|argument| depths[&argument]).max().unwrap_or(0);
            depths.insert(
                node,
                match operation {
                    Operation::Select(_, a, b) if depth >= DEEPEST => {
                        for branch in [a, b] {
                            self.differentiated(graph, branch, order, None);
                        }
                        0
                    }
                    Operation::Select(..) => depth + 1,
                    _ => depth,
                },
            );
        }
    }

    /// The derivatives, made once.
    fn differentiated(
        &mut self,
        graph: &mut Graph,
        root: Node,
        order: Order,
        symbol: Option<&str>,
    ) -> Rc<Derivatives> {
        let key = (root, order, symbol.map(str::to_owned));
        if let Some(known) = self.known.get(&key) {
            return Rc::clone(known);
        }
        let derivatives = Rc::new(self.derivatives(graph, root, order, symbol));
        self.known.insert(key, Rc::clone(&derivatives));
        derivatives
    }

    fn derivatives(
        &mut self,
        graph: &mut Graph,
        root: Node,
        order: Order,
        symbol: Option<&str>,
    ) -> Derivatives {
        let mut sweep = Sweep::default();
        if graph.depends(root) {
            let one = graph.one();
            sweep.adjoints.insert(root, one);
        }
        // Derivatives are made of nodes later than the root, and so never met by the sweep.
        let nodes = self.open_nodes(graph, root);
        let vanishing = Vanishing::of(graph, root);
        for node in nodes.into_iter().rev() {
            // Nothing is made of derivatives that are too long: they need not be right, but soon done.
            if graph.is_full() {
                break;
            }
            let Some(&adjoint) = sweep.adjoints.get(&node) else { continue };
            if let Some(symbol) = symbol
                && node != root
                && adjoint > root
                && let Some(name) = graph.name(node).map(str::to_owned)
            {
                graph.give_name(adjoint, &format!("d{symbol}_d{name}"));
            }
            let local = match graph.operation(node) {
                operation if graph.is_variable(operation) => continue,
                Operation::Select(condition, a, b) => self.selected(graph, condition, a, b, order),
                operation => {
                    let mut partials = partials(graph, node, operation, order);
                    vanishing.apply(graph, node, &mut partials);
                    Local::from(partials)
                }
            };
            sweep.adjoints.remove(&node);
            if order == Order::Second {
                sweep.push_edges(graph, node, &local);
                for &(a, b, second) in &local.second {
                    let weight = second.times(graph, adjoint);
                    sweep.add_edge(graph, a, b, weight);
                }
            }
            for &(argument, first) in &local.first {
                let part = first.times(graph, adjoint);
                sweep.add_adjoint(graph, argument, part);
            }
        }
        Derivatives { gradient: sweep.adjoints, hessian: sweep.edges }
    }

    /// The nodes that the sweep visits, arguments first: not the branches of selections, which it
    /// differentiates whole.
    fn open_nodes(&self, graph: &Graph, root: Node) -> Vec<Node> {
        let mut seen = std::collections::BTreeSet::new();
        let mut open = vec![root];
        while let Some(node) = open.pop() {
            if !graph.depends(node) || !seen.insert(node) {
                continue;
            }
            match graph.operation(node) {
                // Derivatives by the variables themselves, whichever they are.
                Operation::Select(_, a, b) => open.extend(
                    graph
                        .reachable([a, b])
                        .into_iter()
                        .filter(|&node| graph.is_variable(graph.operation(node))),
                ),
                operation => open.extend(operation.arguments()),
            }
        }
        seen.into_iter().collect()
    }

    /// A selection as a function of the variables.
    fn selected(&mut self, graph: &mut Graph, condition: Node, a: Node, b: Node, order: Order) -> Local {
        let [a, b] = [a, b].map(|branch| self.differentiated(graph, branch, order, None));
        let mut local = Local::default();
        for &variable in union(a.gradient.keys(), b.gradient.keys()) {
            let branches = [&a, &b].map(|branch| branch.gradient.get(&variable).copied());
            local.first.extend(Factor::selected(graph, condition, branches).map(|first| (variable, first)));
        }
        for &(i, j) in union(a.hessian.keys(), b.hessian.keys()) {
            let branches = [&a, &b].map(|branch| branch.hessian.get(&(i, j)).copied());
            local.second.extend(Factor::selected(graph, condition, branches).map(|second| (i, j, second)));
        }
        local
    }
}

/// The keys of both maps, each once, in order.
fn union<'k, K: Ord>(a: impl Iterator<Item = &'k K>, b: impl Iterator<Item = &'k K>) -> Vec<&'k K> {
    a.chain(b).collect::<std::collections::BTreeSet<_>>().into_iter().collect()
}

/// The state of a sweep: derivatives of the root by the nodes still open.
#[derive(Default)]
struct Sweep {
    adjoints: Gradient,
    /// Second derivatives, the smaller node first.
    edges: Hessian,
    /// The partners of each node.
    partners: BTreeMap<Node, std::collections::BTreeSet<Node>>,
}

impl Sweep {
    fn add_adjoint(&mut self, graph: &mut Graph, node: Node, part: Node) {
        let sum = match self.adjoints.get(&node) {
            Some(&known) => graph.plus(known, part),
            None => part,
        };
        self.adjoints.insert(node, sum);
    }

    /// Adds to ∂²f/∂a∂b.
    fn add_edge(&mut self, graph: &mut Graph, a: Node, b: Node, part: Node) {
        let pair = if a <= b { (a, b) } else { (b, a) };
        let sum = match self.edges.get(&pair) {
            Some(&known) => graph.plus(known, part),
            None => part,
        };
        self.edges.insert(pair, sum);
        self.partners.entry(a).or_default().insert(b);
        self.partners.entry(b).or_default().insert(a);
    }

    /// Replaces the edges of `node` by edges of its arguments.
    fn push_edges(&mut self, graph: &mut Graph, node: Node, local: &Local) {
        for partner in self.partners.remove(&node).unwrap_or_default() {
            let pair = if partner <= node { (partner, node) } else { (node, partner) };
            let Some(weight) = self.edges.remove(&pair) else { continue };
            if partner == node {
                for (index, &(a, first_a)) in local.first.iter().enumerate() {
                    for &(b, first_b) in &local.first[index..] {
                        // The pair (a, b) and the pair (b, a) are one edge; if a and b are the same node,
                        // both count.
                        if let Some(part) = first_a.times_both(graph, weight, first_b) {
                            self.add_edge(graph, a, b, part);
                        }
                    }
                }
                continue;
            }
            if let Some(others) = self.partners.get_mut(&partner) {
                others.remove(&node);
            }
            for &(argument, first) in &local.first {
                let mut part = first.times(graph, weight);
                if argument == partner {
                    part = graph.scaled(2.0, part);
                }
                self.add_edge(graph, argument, partner, part);
            }
        }
    }
}
