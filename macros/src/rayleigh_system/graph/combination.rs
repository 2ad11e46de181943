//! Expressions as sums of others with numbers for factors.

use std::collections::BTreeMap;

use super::{Graph, Node, Operation};

/// An expression as Σ cᵢ xᵢ + c, as far as sums, signs and factors that are numbers lead: the numbers by the
/// expressions that they multiply, and one by none.
pub struct Combination(BTreeMap<Option<Node>, f64>);

impl Graph {
    /// The expression as a combination of others.
    pub fn combination(&self, root: Node) -> Combination {
        let mut shares = BTreeMap::from([(root, 1.0)]);
        let mut numbers = BTreeMap::new();
        // What an expression is part of comes before it: its share is complete.
        for node in self.reachable([root]).into_iter().rev() {
            let Some(share) = shares.remove(&node) else { continue };
            let mut add = |of: Node, factor: f64| *shares.entry(of).or_insert(0.0) += factor * share;
            let factor = |of: Node| self.constant_value(of).filter(|factor| factor.is_finite());
            match self.operation(node) {
                Operation::Add(a, b) => [a, b].into_iter().for_each(|of| add(of, 1.0)),
                Operation::Subtract(a, b) => [(a, 1.0), (b, -1.0)].into_iter().for_each(|(of, c)| add(of, c)),
                Operation::Negate(a) => add(a, -1.0),
                Operation::Constant(bits) => {
                    *numbers.entry(None).or_insert(0.0) += share * f64::from_bits(bits);
                }
                Operation::Multiply(a, b) => match (factor(a), factor(b)) {
                    (Some(factor), _) => add(b, factor),
                    (_, Some(factor)) => add(a, factor),
                    _ => _ = numbers.insert(Some(node), share),
                },
                Operation::Divide(a, b) => match factor(b) {
                    Some(factor) if factor != 0.0 => add(a, 1.0 / factor),
                    _ => _ = numbers.insert(Some(node), share),
                },
                _ => _ = numbers.insert(Some(node), share),
            }
        }
        numbers.retain(|_, number| *number != 0.0);
        Combination(numbers)
    }
}

impl Combination {
    /// The number by which this is a multiple of `other`, if it is one; none of what is a number itself.
    pub fn multiple_of(&self, other: &Self) -> Option<f64> {
        let (Self(own), Self(others)) = (self, other);
        let (&of, &first) = own.last_key_value().filter(|(of, _)| of.is_some())?;
        let other = *others.get(&of)?;
        let is_multiple = |(of, number): (&Option<Node>, &f64)| {
            others.get(of).is_some_and(|others| number * other == others * first)
        };
        (own.len() == others.len() && own.iter().all(is_multiple)).then_some(first / other)
    }
}
