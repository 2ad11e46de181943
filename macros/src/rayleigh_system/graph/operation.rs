//! The operations that nodes compute.

use proc_macro2::TokenStream;
use quote::quote;

use super::curve::Curve;
use super::{Function, Node, PairFunction, Predicate};

/// An operation on earlier nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Operation {
    /// qᵢ.
    Coordinate(usize),
    /// vᵢ.
    Velocity(usize),
    /// uᵢ, an entry of the input.
    Input(usize),
    /// See [`Parameter`](super::Parameter).
    Parameter(usize),
    /// A number, by its bits in `f64`.
    Constant(u64),
    Add(Node, Node),
    Subtract(Node, Node),
    Multiply(Node, Node),
    Divide(Node, Node),
    Negate(Node),
    Function(Function, Node),
    Pair(PairFunction, Node, Node),
    Characteristic(Curve, Node),
    Power(Node, i32),
    Select(Node, Node, Node),
    /// a b + c, rounded once.
    MultiplyAdd(Node, Node, Node),
    // Truth values.
    Compare(Comparison, Node, Node),
    Is(Predicate, Node),
    Not(Node),
    And(Node, Node),
    Or(Node, Node),
}

impl Operation {
    /// Whether it is written where it is used, as `q[0]` or a number.
    pub fn is_literal(self) -> bool {
        matches!(self, Self::Coordinate(_) | Self::Velocity(_) | Self::Input(_) | Self::Constant(_))
    }

    /// Puts the arguments of a sum or product in order: its value stays equal to the last bit.
    pub fn ordered(self) -> Self {
        match self {
            Self::Add(a, b) if b < a => Self::Add(b, a),
            Self::Multiply(a, b) if b < a => Self::Multiply(b, a),
            other => other,
        }
    }

    /// The argument that a method is called on.
    pub fn receiver(self) -> Option<Node> {
        match self {
            Self::Function(_, x)
            | Self::Pair(_, x, _)
            | Self::Power(x, _)
            | Self::MultiplyAdd(x, ..)
            | Self::Is(_, x) => Some(x),
            _ => None,
        }
    }

    /// Whether the result is a truth value.
    pub fn is_truth(self) -> bool {
        matches!(self, Self::Compare(..) | Self::Is(..) | Self::Not(_) | Self::And(..) | Self::Or(..))
    }

    /// Applies `of` to each argument.
    pub fn with_arguments(self, mut of: impl FnMut(Node) -> Node) -> Self {
        match self {
            Self::Coordinate(_)
            | Self::Velocity(_)
            | Self::Input(_)
            | Self::Parameter(_)
            | Self::Constant(_) => self,
            Self::Add(a, b) => Self::Add(of(a), of(b)),
            Self::Subtract(a, b) => Self::Subtract(of(a), of(b)),
            Self::Multiply(a, b) => Self::Multiply(of(a), of(b)),
            Self::Divide(a, b) => Self::Divide(of(a), of(b)),
            Self::Negate(a) => Self::Negate(of(a)),
            Self::Function(function, a) => Self::Function(function, of(a)),
            Self::Pair(function, a, b) => Self::Pair(function, of(a), of(b)),
            Self::Characteristic(curve, a) => Self::Characteristic(curve, of(a)),
            Self::Power(a, n) => Self::Power(of(a), n),
            Self::Select(condition, a, b) => Self::Select(of(condition), of(a), of(b)),
            Self::MultiplyAdd(a, b, c) => Self::MultiplyAdd(of(a), of(b), of(c)),
            Self::Compare(comparison, a, b) => Self::Compare(comparison, of(a), of(b)),
            Self::Is(predicate, a) => Self::Is(predicate, of(a)),
            Self::Not(a) => Self::Not(of(a)),
            Self::And(a, b) => Self::And(of(a), of(b)),
            Self::Or(a, b) => Self::Or(of(a), of(b)),
        }
    }

    pub fn arguments(self) -> impl Iterator<Item = Node> {
        let arguments = match self {
            Self::Coordinate(_)
            | Self::Velocity(_)
            | Self::Input(_)
            | Self::Parameter(_)
            | Self::Constant(_) => [None; 3],
            Self::Negate(a)
            | Self::Function(_, a)
            | Self::Characteristic(_, a)
            | Self::Power(a, _)
            | Self::Is(_, a)
            | Self::Not(a) => [Some(a), None, None],
            Self::Add(a, b)
            | Self::Subtract(a, b)
            | Self::Multiply(a, b)
            | Self::Divide(a, b)
            | Self::Pair(_, a, b)
            | Self::Compare(_, a, b)
            | Self::And(a, b)
            | Self::Or(a, b) => [Some(a), Some(b), None],
            Self::Select(a, b, c) | Self::MultiplyAdd(a, b, c) => [Some(a), Some(b), Some(c)],
        };
        arguments.into_iter().flatten()
    }
}

/// Comparisons of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Comparison {
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    Equal,
    NotEqual,
}

impl Comparison {
    /// The operator as it is written.
    pub fn symbol(self) -> TokenStream {
        match self {
            Self::Less => quote!(<),
            Self::LessOrEqual => quote!(<=),
            Self::Greater => quote!(>),
            Self::GreaterOrEqual => quote!(>=),
            Self::Equal => quote!(==),
            Self::NotEqual => quote!(!=),
        }
    }

    /// Whether it holds.
    pub fn holds(self, a: f64, b: f64) -> bool {
        match self {
            Self::Less => a < b,
            Self::LessOrEqual => a <= b,
            Self::Greater => a > b,
            Self::GreaterOrEqual => a >= b,
            Self::Equal => a == b,
            Self::NotEqual => a != b,
        }
    }
}
