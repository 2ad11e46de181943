//! Sums of squares of velocities under a root, with factors in front, as the numbers that are squared.

use super::super::super::graph::{Function, Node, Operation, PairFunction};
use super::super::*;

/// A factor without v: a number, what it is multiplied by, and what it is divided by.
#[derive(Clone)]
struct Factor {
    number: f64,
    over: Vec<Node>,
    under: Vec<Node>,
}

impl Factor {
    fn one() -> Self {
        Self { number: 1.0, over: Vec::new(), under: Vec::new() }
    }

    fn times(&self, other: Self) -> Self {
        let both = |a: &[Node], b: Vec<Node>| a.iter().copied().chain(b).collect();
        Self {
            number: self.number * other.number,
            over: both(&self.over, other.over),
            under: both(&self.under, other.under),
        }
    }
}

impl Deriving<'_> {
    /// The xᵢ of √(Σ xᵢ²), or of that to the power of a half; nothing of another root.
    pub(super) fn squared(&mut self, root: Operation) -> Option<Vec<Node>> {
        self.squares(self.under_root(root)?)
    }

    /// The node under a root.
    fn under_root(&self, root: Operation) -> Option<Node> {
        match root {
            Operation::Function(Function::Sqrt, sum) => Some(sum),
            Operation::Pair(PairFunction::Powf, sum, half)
                if self.graph.constant_value(half) == Some(0.5) =>
            {
                Some(sum)
            }
            _ => None,
        }
    }

    /// The velocities under a root of a form that is 0 with them and quadratic in them there: the root has
    /// a kink.
    pub(super) fn quadratic_under(&mut self, root: Operation) -> Option<Vec<Node>> {
        let form = self.under_root(root)?;
        if !self.vanishes_at_rest(form) {
            return None;
        }
        let velocities = self.velocities();
        let slopes = self.derivation.gradient(&mut self.graph, form);
        let zero = self.graph.constant(0.0);
        let rest: HashMap<Node, Node> = velocities.iter().map(|&v| (v, zero)).collect();
        let mut is_quadratic = false;
        for slope in velocities.iter().filter_map(|v| slopes.get(v)) {
            let second = self.derivation.gradient(&mut self.graph, *slope);
            for entry in velocities.iter().filter_map(|v| second.get(v)) {
                let at_rest = self.graph.replaced(*entry, rest.clone());
                is_quadratic |=
                    self.graph.constant_value(at_rest).is_none_or(|value| value.is_finite() && value != 0.0);
            }
        }
        is_quadratic.then(|| velocities.into_iter().filter(|&v| self.reads(form, v)).collect())
    }

    /// The numbers whose squares are added; nothing where a term is no square, or has no v in it.
    fn squares(&mut self, sum: Node) -> Option<Vec<Node>> {
        let (mut open, mut found) = (vec![(sum, Factor::one())], Vec::new());
        while let Some((node, front)) = open.pop() {
            match self.graph.operation(node) {
                Operation::Add(a, b) => open.extend([(b, front.clone()), (a, front)]),
                Operation::MultiplyAdd(a, b, c) => {
                    open.push((c, front.clone()));
                    self.product(&[a, b], front, &mut open, &mut found)?;
                }
                _ if self.graph.constant_value(node) == Some(0.0) => {}
                _ => self.product(&[node], front, &mut open, &mut found)?,
            }
        }
        Some(found)
    }

    /// A product as a square, or as a sum with a factor in front, which stays open.
    fn product(
        &mut self,
        factors: &[Node],
        front: Factor,
        open: &mut Vec<(Node, Factor)>,
        found: &mut Vec<Node>,
    ) -> Option<()> {
        if let [node] = factors
            && let Operation::Multiply(a, b) = self.graph.operation(*node)
            && a == b
            && self.reads_velocity(a)
        {
            // As it is written.
            found.push(self.rooted(front, a)?);
            return Some(());
        }
        let (mut moving, mut own, mut left) = (Vec::new(), Factor::one(), factors.to_vec());
        while let Some(node) = left.pop() {
            match self.graph.operation(node) {
                Operation::Multiply(a, b) => left.extend([b, a]),
                Operation::Divide(a, b) if !self.reads_velocity(b) => {
                    left.push(a);
                    match self.graph.constant_value(b) {
                        Some(number) => own.number /= number,
                        None => own.under.push(b),
                    }
                }
                Operation::Power(x, n @ 1..=8) => left.extend((0..n).map(|_| x)),
                _ if self.reads_velocity(node) => moving.push(node),
                _ => match self.graph.constant_value(node) {
                    Some(number) => own.number *= number,
                    None => own.over.push(node),
                },
            }
        }
        let factor = front.times(own);
        match moving[..] {
            [a, b] if a == b => found.push(self.rooted(factor, a)?),
            [sum] => match self.graph.operation(sum) {
                Operation::Add(..) | Operation::MultiplyAdd(..) => open.push((sum, factor)),
                _ => return None,
            },
            _ => return None,
        }
        Some(())
    }

    /// x times the root of a factor, of which pairs are taken as they are; nothing if its number is not
    /// positive.
    fn rooted(&mut self, factor: Factor, x: Node) -> Option<Node> {
        if factor.number.is_nan() || factor.number <= 0.0 {
            return None;
        }
        let mut root = self.graph.scaled(factor.number.sqrt(), x);
        for (of, is_over) in [(factor.over, true), (factor.under, false)] {
            let mut odd: Vec<Node> = Vec::new();
            for node in of {
                let paired = odd.iter().position(|&other| other == node);
                let by = match paired {
                    Some(at) => odd.remove(at),
                    None => {
                        odd.push(node);
                        continue;
                    }
                };
                root = if is_over { self.graph.times(by, root) } else { self.graph.over(root, by) };
            }
            for node in odd {
                let by = self.graph.function(Function::Sqrt, node);
                root = if is_over { self.graph.times(by, root) } else { self.graph.over(root, by) };
            }
        }
        Some(root)
    }
}
