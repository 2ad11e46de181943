//! Derivatives along directions: those that a rule passes when the program runs, and those folded into a
//! kernel.

use super::*;

impl Deriving<'_> {
    /// Derivatives of L along the directions `minus` and `plus`.
    pub(super) fn variations(&mut self, of: &Derivatives) -> Made<Routine> {
        let [minus, plus] = ["minus", "plus"].map(|name| Along::parameters(&mut self.graph, name));
        let first = [minus, plus].map(|along| self.along(&of.gradient, along));
        let mixed = self.matrix(|deriving, i, j| deriving.mixed(of, (i, minus), (j, plus)));
        let outputs = [first.concat(), mixed].concat();
        self.made(Of::Variations, self.system.home_of(Part::Lagrangian), &outputs)
    }

    /// Entry i: first ∂f/∂qᵢ + second ∂f/∂vᵢ.
    pub(super) fn along(&mut self, gradient: &Gradient, along: Along) -> Vec<Node> {
        (0..self.n)
            .map(|index| {
                let terms = [(along.second, true), (along.first, false)].map(|(factor, velocity)| {
                    let variable = self.variable(index, velocity);
                    (factor, gradient.get(&variable).copied())
                });
                let sum = self.sum(terms);
                self.or_zero(sum)
            })
            .collect()
    }

    /// The second derivative along both directions.
    pub(super) fn mixed(
        &mut self,
        of: &Derivatives,
        (i, minus): (usize, Along),
        (j, plus): (usize, Along),
    ) -> Option<Node> {
        let mut terms: Vec<(Option<Node>, Option<Node>)> = Vec::new();
        // Velocities first: the mass matrix leads.
        for (factor_i, velocity_i) in [(minus.second, true), (minus.first, false)] {
            for (factor_j, velocity_j) in [(plus.second, true), (plus.first, false)] {
                let (Some(a), Some(b)) = (factor_i, factor_j) else { continue };
                let factor = self.graph.times(a, b);
                let second = self.second(of, (i, velocity_i), (j, velocity_j));
                let opposite = self.graph.negated(factor);
                // On the diagonal the two orders are one derivative; opposite factors leave nothing of it.
                match terms.iter().position(|&term| second.is_some() && term == (Some(opposite), second)) {
                    Some(cancelled) => drop(terms.remove(cancelled)),
                    None => terms.push((Some(factor), second)),
                }
            }
        }
        self.sum(terms)
    }

    /// Σ factor × term over those that are there.
    fn sum(&mut self, terms: impl IntoIterator<Item = (Option<Node>, Option<Node>)>) -> Option<Node> {
        let mut sum = None;
        for (factor, term) in terms {
            let (Some(factor), Some(term)) = (factor, term) else { continue };
            let product = self.graph.times(factor, term);
            sum = Some(self.added(sum, product));
        }
        sum
    }
}

/// A direction in (q, v), factors that are 0 by structure absent.
#[derive(Clone, Copy)]
pub(super) struct Along {
    pub first: Option<Node>,
    pub second: Option<Node>,
}

impl Along {
    /// `minus.first`, `minus.second`.
    fn parameters(graph: &mut Graph, name: &str) -> Self {
        let [first, second] = ["first", "second"].map(|part| {
            let node = graph.member(name, part);
            graph.give_name(node, &format!("{name}_{part}"));
            Some(node)
        });
        Self { first, second }
    }
}
