//! Simpson's rule, as a rule of one's own.

use dalembert::rules::{DisplacementRule, Node, SelfAdjoint};

/// The nodes 0, ½ and 1, of which `Quadrature` makes all that the attribute's rules have.
#[derive(Clone, Copy, Debug)]
pub struct Simpson;

impl DisplacementRule for Simpson {
    const NODES: &'static [Node] = &[
        Node { position: 0.0, weight: 1.0 / 6.0 },
        Node { position: 0.5, weight: 2.0 / 3.0 },
        Node { position: 1.0, weight: 1.0 / 6.0 },
    ];
}

impl SelfAdjoint for Simpson {}
