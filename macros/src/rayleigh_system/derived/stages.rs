//! The equations of motion at the stages of a Gauss rule, in lanes: L, R and f together, each shared
//! expression once.
//!
//! ```text
//! G = ∂L/∂q − ∂R/∂v + f,   residual = P − ∂L/∂v,   correction = (∂²L/∂v²)⁻¹ residual
//! ```
//!
//! The matrix is factored here, M = L D Lᵀ without exchanges, so that its zeros and constants cost nothing. A
//! pivot that is 0 makes the correction infinite, and the runtime takes Newton's method.

#![allow(clippy::needless_range_loop, reason = "one index runs through several arrays together")]

use std::collections::BTreeSet;

use super::super::graph::before_the_run;
use super::*;

/// The equations at a stage.
pub struct Stages {
    pub at_once: Routine,
    /// Of several members: rates, and the corrections of what they lead to.
    pub in_lanes: Option<[Routine; 2]>,
}

const NOT_FACTORED: &str =
    "needs ∂²L/∂v² factored without exchanges, and a pivot is 0 by structure, or the matrix is too large";

pub const CONDITIONAL: &str = "reads all fields before the run, and a body reads one within a condition, where it may panic; read it before the condition";

/// Longer factorisations are left to the runtime.
const MAX_PRODUCTS: usize = 4000;

impl Deriving<'_> {
    /// The equations at a stage, or the reason why they are left to the runtime.
    pub(super) fn stages(&mut self) -> Made<Result<Stages, &'static str>> {
        let of_lagrangian = self.derivation.hessian(&mut self.graph, self.lagrangian, "l");
        let rates = self.rates(&of_lagrangian.gradient);
        let momenta = self.covector(&of_lagrangian.gradient, true);
        // What the closure returns is known after the rates.
        let late: Vec<Node> = (0..self.n).map(|index| self.graph.entry("p", index)).collect();
        let residuals: Vec<Node> = late
            .iter()
            .zip(momenta)
            .enumerate()
            .map(|(index, (&p, momentum))| {
                let residual = self.graph.minus(p, momentum);
                self.graph.give_name(residual, &format!("residual{index}"));
                residual
            })
            .collect();
        let Some(corrections) = self.solved(&of_lagrangian, &residuals) else {
            return Ok(Err(NOT_FACTORED));
        };

        let outputs = [rates, residuals, corrections].concat();
        self.complete()?;
        let outputs = self.graph.with_fewer_angles(&outputs);
        let outputs = self.rounded(&outputs)?;
        // Lanes take both ways of a selection.
        if self.graph.is_conditional(outputs.iter().copied()) {
            return Ok(Err(CONDITIONAL));
        }
        let reciprocals = self.of_corrections_alone(&outputs);
        let home = self.system.home();
        let in_lanes = self.system.lanes.gauss.is_some().then(|| {
            let (rates, rest) = outputs.split_at(self.n);
            let handed = self.handed(rest, &late);
            let kind = Kind::Members { handed: Vec::new(), reciprocals: Some(reciprocals.clone()) };
            let rates = Routine { of: Of::Rates, home, kind, outputs: [rates, &handed].concat() };
            let kind = Kind::Members { handed, reciprocals: None };
            [rates, Routine { of: Of::Corrections, home, kind, outputs: rest.to_vec() }]
        });
        let kind = Kind::Lanes { late, reciprocals };
        Ok(Ok(Stages { at_once: Routine { of: Of::Stages, home, kind, outputs }, in_lanes }))
    }

    /// The nodes to hand over: `outputs` need them, and the momenta `late` do not change them. Velocities and
    /// values known before the run are at hand, and a product or a negation of those is sooner computed again
    /// than stored.
    fn handed(&self, outputs: &[Node], late: &[Node]) -> Vec<Node> {
        let nodes = self.graph.reachable(outputs.iter().copied());
        let (is_constant, _) = before_the_run(&self.graph, &nodes, Of::Corrections.arguments(&Kind::Numbers));
        let mut is_late = vec![false; self.graph.len()];
        let mut needed = outputs.to_vec();
        for &node in &nodes {
            let operation = self.graph.operation(node);
            is_late[node.index()] =
                late.contains(&node) || operation.arguments().any(|argument| is_late[argument.index()]);
            if is_late[node.index()] {
                needed.extend(operation.arguments());
            }
        }
        let is_at_hand = |node: Node| {
            is_constant[node.index()] || matches!(self.graph.operation(node), Operation::Velocity(_))
        };
        needed.retain(|&node| {
            let operation = self.graph.operation(node);
            let is_product = matches!(operation, Operation::Multiply(..) | Operation::Negate(_));
            let is_short = is_product && operation.arguments().all(is_at_hand);
            !is_late[node.index()] && !is_at_hand(node) && !is_short
        });
        needed.sort_unstable();
        needed.dedup();
        needed
    }

    /// G = ∂L/∂q − ∂R/∂v + f.
    pub(super) fn rates(&mut self, of_lagrangian: &Gradient) -> Vec<Node> {
        let of_rayleigh =
            self.rayleigh.map(|root| self.derivation.gradient(&mut self.graph, root)).unwrap_or_default();
        (0..self.n)
            .map(|index| {
                let (q, v) = (self.variable(index, false), self.variable(index, true));
                let mut rate = of_lagrangian.get(&q).copied();
                if let Some(&friction) = of_rayleigh.get(&v) {
                    let opposite = self.graph.negated(friction);
                    rate = Some(self.added(rate, opposite));
                }
                let component = self.force.map(|components| components[index]);
                if let Some(component) = component.filter(|&f| self.graph.constant_value(f) != Some(0.0)) {
                    rate = Some(self.added(rate, component));
                }
                self.or_zero(rate)
            })
            .collect()
    }

    /// The reciprocals that corrections need and nothing else does: what they are off by, the next sweep
    /// sees.
    fn of_corrections_alone(&self, outputs: &[Node]) -> Vec<Node> {
        let (others, corrections) = outputs.split_at(2 * self.n);
        let others: BTreeSet<Node> = self.graph.reachable(others.iter().copied()).into_iter().collect();
        let is_reciprocal = |node: &Node| match self.graph.operation(*node) {
            Operation::Divide(one, _) => self.graph.constant_value(one) == Some(1.0),
            _ => false,
        };
        let mut alone = self.graph.reachable(corrections.iter().copied());
        alone.retain(|node| is_reciprocal(node) && !others.contains(node));
        alone
    }

    /// M⁻¹ `right`, M = ∂²L/∂v².
    fn solved(&mut self, of: &Derivatives, right: &[Node]) -> Option<Vec<Node>> {
        let n = self.n;
        if self.products(of) > MAX_PRODUCTS {
            return None;
        }
        // W = L D below the diagonal, and 1/D.
        let mut lower: Vec<Vec<Option<Node>>> = vec![vec![None; n]; n];
        let mut scaled = lower.clone();
        let mut reciprocals = Vec::new();
        for j in 0..n {
            for i in j..n {
                let mut entry = self.second(of, (i, true), (j, true));
                for k in 0..j {
                    if let (Some(a), Some(b)) = (lower[i][k], scaled[j][k]) {
                        let product = self.graph.times(a, b);
                        let opposite = self.graph.negated(product);
                        entry = Some(self.added(entry, opposite));
                    }
                }
                if i == j {
                    reciprocals.push(self.graph.reciprocal(entry?));
                } else {
                    scaled[i][j] = entry;
                    lower[i][j] = entry.map(|entry| self.graph.times(entry, reciprocals[j]));
                }
            }
        }
        let mut x = right.to_vec();
        for i in 0..n {
            for j in 0..i {
                x[i] = self.reduced(x[i], lower[i][j], x[j]);
            }
        }
        for (x, reciprocal) in x.iter_mut().zip(reciprocals) {
            *x = self.graph.times(reciprocal, *x);
        }
        for i in (0..n).rev() {
            for j in i + 1..n {
                x[i] = self.reduced(x[i], lower[j][i], x[j]);
            }
        }
        Some(x)
    }

    /// x − factor y.
    fn reduced(&mut self, x: Node, factor: Option<Node>, y: Node) -> Node {
        match factor {
            Some(factor) => {
                let product = self.graph.times(factor, y);
                self.graph.minus(x, product)
            }
            None => x,
        }
    }

    /// How many products the factorisation takes, with what fills in.
    fn products(&mut self, of: &Derivatives) -> usize {
        let mut below: Vec<BTreeSet<usize>> = (0..self.n)
            .map(|j| (j + 1..self.n).filter(|&i| self.second(of, (i, true), (j, true)).is_some()).collect())
            .collect();
        let mut products = 0;
        for k in 0..self.n {
            let column = below[k].clone();
            products += column.len() * column.len();
            for &j in &column {
                let filled = column.iter().copied().filter(|&i| i > j);
                below[j].extend(filled);
            }
        }
        products
    }
}
