//! How expressions depend on q and v, read off their operations as written.

use super::super::graph::{Graph, Node, Operation};

/// The degree of an expression that is no polynomial, or of one above the few that are told apart.
const UNBOUNDED: u8 = u8::MAX;

/// The variables that a node is made of.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Parts {
    /// Neither q nor v.
    Constant,
    /// g(q).
    Coordinates,
    /// g(v).
    Velocities,
    /// g(v) + k(q).
    Separate,
    Mixed,
}

impl Parts {
    /// The parts of a sum.
    fn beside(self, other: Self) -> Self {
        match (self, other) {
            (Self::Constant, x) | (x, Self::Constant) => x,
            (Self::Mixed, _) | (_, Self::Mixed) => Self::Mixed,
            (a, b) if a == b => a,
            _ => Self::Separate,
        }
    }

    /// The parts of any other function of both.
    fn with(self, other: Self) -> Self {
        match self.beside(other) {
            Self::Separate => Self::Mixed,
            parts => parts,
        }
    }
}

/// Degrees and parts of one node.
#[derive(Clone, Copy)]
struct Shape {
    /// Degree as a polynomial in (q, v).
    joint: u8,
    /// Degree as a polynomial in v, with coefficients that depend on q.
    in_velocity: u8,
    parts: Parts,
}

impl Shape {
    const CONSTANT: Self = Self { joint: 0, in_velocity: 0, parts: Parts::Constant };

    fn sum(self, other: Self) -> Self {
        Self {
            joint: self.joint.max(other.joint),
            in_velocity: self.in_velocity.max(other.in_velocity),
            parts: self.parts.beside(other.parts),
        }
    }

    fn product(self, other: Self) -> Self {
        let parts = match (self.parts, other.parts) {
            (Parts::Constant, parts) | (parts, Parts::Constant) => parts,
            (a, b) => a.with(b),
        };
        Self {
            joint: self.joint.saturating_add(other.joint),
            in_velocity: self.in_velocity.saturating_add(other.in_velocity),
            parts,
        }
    }

    /// A function of both that is no polynomial.
    fn function(self, other: Self) -> Self {
        let degree = |degree: u8| if degree == 0 { 0 } else { UNBOUNDED };
        Self {
            joint: degree(self.joint.max(other.joint)),
            in_velocity: degree(self.in_velocity.max(other.in_velocity)),
            parts: self.parts.with(other.parts),
        }
    }
}

/// Degrees of all nodes of a graph.
pub struct Degrees {
    shapes: Vec<Shape>,
}

impl Degrees {
    pub fn of(graph: &Graph) -> Self {
        let mut shapes: Vec<Shape> = Vec::with_capacity(graph.len());
        for node in graph.nodes() {
            let of = |node: Node| shapes[node.index()];
            let shape = match graph.operation(node) {
                Operation::Coordinate(_) => Shape { joint: 1, in_velocity: 0, parts: Parts::Coordinates },
                Operation::Velocity(_) => Shape { joint: 1, in_velocity: 1, parts: Parts::Velocities },
                Operation::Add(a, b) | Operation::Subtract(a, b) => of(a).sum(of(b)),
                Operation::Negate(a) => of(a),
                Operation::Multiply(a, b) => of(a).product(of(b)),
                Operation::MultiplyAdd(a, b, c) => of(a).product(of(b)).sum(of(c)),
                // The parts of a sum over a constant are those of the sum; a variable below is no polynomial
                // in it.
                Operation::Divide(a, b) => {
                    let below = of(b).function(Shape::CONSTANT);
                    of(a).product(below)
                }
                Operation::Power(x, n) if n >= 0 => {
                    let (x, n) = (of(x), u8::try_from(n).unwrap_or(UNBOUNDED));
                    Shape {
                        joint: x.joint.saturating_mul(n),
                        in_velocity: x.in_velocity.saturating_mul(n),
                        ..x.function(Shape::CONSTANT)
                    }
                }
                // Where only the fields decide, whichever branch it is.
                Operation::Select(condition, a, b) if !graph.depends(condition) => of(a).sum(of(b)),
                other => {
                    other.arguments().fold(Shape::CONSTANT, |shape, argument| shape.function(of(argument)))
                }
            };
            shapes.push(shape);
        }
        Self { shapes }
    }

    /// The degree as a polynomial in (q, v).
    pub fn joint(&self, node: Node) -> u8 {
        self.shapes[node.index()].joint
    }

    /// The degree as a polynomial in v, whatever q does.
    pub fn in_velocity(&self, node: Node) -> u8 {
        self.shapes[node.index()].in_velocity
    }

    /// Whether the node is a function of v plus a function of q.
    pub fn is_separable(&self, node: Node) -> bool {
        self.shapes[node.index()].parts != Parts::Mixed
    }
}
