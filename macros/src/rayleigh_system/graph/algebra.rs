//! The algebra of derivatives: sums and products that need not keep a user's order.

use super::{Graph, Node, Operation};

impl Graph {
    pub fn one(&mut self) -> Node {
        self.constant(1.0)
    }

    /// a + b.
    pub fn plus(&mut self, a: Node, b: Node) -> Node {
        if a == b {
            return self.scaled(2.0, a);
        }
        if let (Some(x), Some(y)) = (self.constant_value(a), self.constant_value(b))
            && let Some(sum) = exact(x + y, &[x, y])
        {
            return self.constant(sum);
        }
        match (self.operation(a), self.operation(b)) {
            (_, Operation::Negate(b)) => self.minus(a, b),
            (Operation::Negate(a), _) => self.minus(b, a),
            _ => self.node(Operation::Add(a, b)),
        }
    }

    /// a − b.
    pub fn minus(&mut self, a: Node, b: Node) -> Node {
        if let (Some(x), Some(y)) = (self.constant_value(a), self.constant_value(b))
            && let Some(difference) = exact(x - y, &[x, y])
        {
            return self.constant(difference);
        }
        match (self.operation(a), self.operation(b)) {
            (_, Operation::Negate(b)) => self.plus(a, b),
            (Operation::Negate(a), _) => {
                let sum = self.plus(a, b);
                self.negated(sum)
            }
            _ => self.node(Operation::Subtract(a, b)),
        }
    }

    /// −a.
    pub fn negated(&mut self, a: Node) -> Node {
        match self.operation(a) {
            Operation::Negate(a) => a,
            Operation::Constant(bits) => self.constant(-f64::from_bits(bits)),
            _ => self.node(Operation::Negate(a)),
        }
    }

    /// a b, signs and constants in front.
    pub fn times(&mut self, a: Node, b: Node) -> Node {
        for (a, b) in [(a, b), (b, a)] {
            if let Operation::Negate(a) = self.operation(a) {
                let product = self.times(a, b);
                return self.negated(product);
            }
            if let Some(factor) = self.constant_value(a) {
                return self.scaled(factor, b);
            }
        }
        // Constant factors of both sides meet: (½ k)(2 v) = k v.
        if let (Some((x, a)), Some((y, b))) = (self.coefficient(a), self.coefficient(b))
            && let Some(product) = exact(x * y, &[x, y])
        {
            let rest = self.times(a, b);
            return self.scaled(product, rest);
        }
        self.regrouped(a, b).unwrap_or_else(|| self.node(Operation::Multiply(a, b)))
    }

    /// a b with three factors grouped so that two of them are a product that is there already.
    fn regrouped(&mut self, a: Node, b: Node) -> Option<Node> {
        if self.known(Operation::Multiply(a, b)).is_some() {
            return None;
        }
        let mut grouped = None;
        for (single, product) in [(a, b), (b, a)] {
            let Operation::Multiply(x, y) = self.operation(product) else { continue };
            for (x, y) in [(x, y), (y, x)] {
                let Some(pair) = self.known(Operation::Multiply(single, x)) else { continue };
                if let Some(whole) = self.known(Operation::Multiply(pair, y)) {
                    return Some(whole);
                }
                grouped = grouped.or(Some((pair, y)));
            }
        }
        grouped.map(|(pair, rest)| self.node(Operation::Multiply(pair, rest)))
    }

    /// factor × a.
    pub fn scaled(&mut self, factor: f64, a: Node) -> Node {
        if factor == 1.0 {
            return a;
        }
        if let Some(x) = self.constant_value(a)
            && let Some(product) = exact(factor * x, &[factor, x])
        {
            return self.constant(product);
        }
        if factor < 0.0 {
            let product = self.scaled(-factor, a);
            return self.negated(product);
        }
        // A sign is exact, whatever the factor.
        match self.constant_value(a) {
            Some(1.0) => return self.constant(factor),
            Some(x) if x < 0.0 => {
                let opposite = self.constant(-x);
                let product = self.scaled(factor, opposite);
                return self.negated(product);
            }
            _ => {}
        }
        if let Operation::Negate(a) = self.operation(a) {
            let product = self.scaled(factor, a);
            return self.negated(product);
        }
        if let Some((x, rest)) = self.coefficient(a)
            && let Some(product) = exact(factor * x, &[factor, x])
        {
            return self.scaled(product, rest);
        }
        let factor = self.constant(factor);
        self.node(Operation::Multiply(factor, a))
    }

    /// 1/a.
    pub fn reciprocal(&mut self, a: Node) -> Node {
        if let Some(x) = self.constant_value(a)
            && let Some(r) = exact(1.0 / x, &[x])
            && r * x == 1.0
        {
            return self.constant(r);
        }
        let one = self.one();
        self.node(Operation::Divide(one, a))
    }

    /// a/b.
    pub fn over(&mut self, a: Node, b: Node) -> Node {
        match self.operation(a) {
            Operation::Negate(a) => {
                let quotient = self.over(a, b);
                self.negated(quotient)
            }
            _ => self.node(Operation::Divide(a, b)),
        }
    }

    /// The constant factor in front, and what it multiplies.
    fn coefficient(&self, a: Node) -> Option<(f64, Node)> {
        match self.operation(a) {
            Operation::Multiply(x, y) => match (self.constant_value(x), self.constant_value(y)) {
                (Some(x), None) => Some((x, y)),
                (None, Some(y)) => Some((y, x)),
                _ => None,
            },
            _ => None,
        }
    }
}

/// The result, if it and its operands are numbers of `f32` as well: then it is exact in both precisions.
pub(super) fn exact(result: f64, operands: &[f64]) -> Option<f64> {
    let fits = |x: f64| x.is_finite() && f64::from(x as f32) == x;
    (fits(result) && operands.iter().all(|&x| fits(x))).then_some(result)
}
