//! The values of a body's expressions while the body is run.

use std::cell::RefCell;
use std::rc::Rc;

use proc_macro2::TokenStream;
use syn::{Expr, Ident, Pat, Type};

use super::super::graph::{Graph, Node, Operation};
use super::class::Integer;
use super::written::Written;

/// A value of a body.
#[derive(Clone)]
pub enum Value {
    /// A floating-point number.
    Real(Node),
    Truth(Truth),
    /// A known integer.
    Integer(Integer),
    /// Made of fields and constants alone, of a type that the macro cannot know.
    Written(Written),
    /// One of two by a condition, neither a number yet.
    Chosen(Rc<Chosen>),
    /// An array, slice or iterator; its entries are known one by one. Closures change nothing outside
    /// themselves, so that running an adaptor's closure early is running it late.
    Sequence(Vec<Value>),
    Tuple(Vec<Value>),
    Closure(Rc<Closure>),
    /// A function of the block, by name.
    Function(Ident),
    /// `f64::sin` handed on.
    Method(Ident),
    /// The path behind a name that a `use` in the body brings in.
    Import(TokenStream),
    /// `self`.
    System,
    /// A local without a value as yet.
    Unset,
}

/// A value that a condition decides.
pub struct Chosen {
    pub condition: Node,
    pub a: Value,
    pub b: Value,
    pub name: Option<String>,
}

/// A closure and what it sees.
pub struct Closure {
    pub parameters: Vec<Pat>,
    pub result: Option<Type>,
    pub body: Expr,
    pub locals: Vec<(String, Value)>,
    /// The arguments and the result of its last call: the types are those of every call.
    pub last: RefCell<Option<Vec<Value>>>,
}

/// A condition.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Truth {
    Known(bool),
    Where(Node),
}

impl Truth {
    pub fn and(self, graph: &mut Graph, other: Self) -> Self {
        match (self, other) {
            (Self::Known(true), x) | (x, Self::Known(true)) => x,
            (Self::Known(false), _) | (_, Self::Known(false)) => Self::Known(false),
            (Self::Where(a), Self::Where(b)) if a == b => self,
            (Self::Where(a), Self::Where(b)) => Self::Where(graph.node(Operation::And(a, b))),
        }
    }

    pub fn or(self, graph: &mut Graph, other: Self) -> Self {
        match (self, other) {
            (Self::Known(false), x) | (x, Self::Known(false)) => x,
            (Self::Known(true), _) | (_, Self::Known(true)) => Self::Known(true),
            (Self::Where(a), Self::Where(b)) if a == b => self,
            (Self::Where(a), Self::Where(b)) => Self::Where(graph.node(Operation::Or(a, b))),
        }
    }

    pub fn not(self, graph: &mut Graph) -> Self {
        match self {
            Self::Known(truth) => Self::Known(!truth),
            Self::Where(node) => Self::Where(match graph.operation(node) {
                Operation::Not(inner) => inner,
                _ => graph.node(Operation::Not(node)),
            }),
        }
    }

    /// Whether just one of the two holds.
    pub fn differs(self, graph: &mut Graph, other: Self) -> Self {
        let (not_self, not_other) = (self.not(graph), other.not(graph));
        let (first, second) = (self.and(graph, not_other), not_self.and(graph, other));
        first.or(graph, second)
    }
}

impl Value {
    /// No value: that of a block without a tail.
    pub fn unit() -> Self {
        Self::Tuple(Vec::new())
    }

    /// A `None` that stands alone, with the type of what else the value may be; others as they are.
    pub fn none_beside(self, other: &Self) -> Self {
        match &self {
            Self::Written(written) if written.is_none() => {
                other.none_of_its_type().map_or(self, Self::Written)
            }
            _ => self,
        }
    }

    /// A `None` of the type that this value has, where it is one of rustc's.
    fn none_of_its_type(&self) -> Option<Written> {
        match self {
            Self::Written(written) if !written.is_none() => written.none_beside(),
            Self::Chosen(chosen) => chosen.a.none_of_its_type().or_else(|| chosen.b.none_of_its_type()),
            _ => None,
        }
    }

    /// Whether the two are surely equal.
    pub fn same(&self, other: &Self) -> bool {
        let all = |a: &[Self], b: &[Self]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.same(b));
        match (self, other) {
            (Self::Real(a), Self::Real(b)) => a == b,
            (Self::Truth(a), Self::Truth(b)) => a == b,
            (Self::Integer(a), Self::Integer(b)) => a.value == b.value && a.class == b.class,
            (Self::Written(a), Self::Written(b)) => match (a.text(), b.text()) {
                (Ok(a), Ok(b)) => {
                    let none = quote::quote!(_);
                    a.within_arms(&none).to_string() == b.within_arms(&none).to_string()
                }
                _ => false,
            },
            (Self::Chosen(a), Self::Chosen(b)) => {
                Rc::ptr_eq(a, b) || (a.condition == b.condition && a.a.same(&b.a) && a.b.same(&b.b))
            }
            (Self::Sequence(a), Self::Sequence(b)) | (Self::Tuple(a), Self::Tuple(b)) => all(a, b),
            (Self::Closure(a), Self::Closure(b)) => Rc::ptr_eq(a, b),
            (Self::Function(a), Self::Function(b)) | (Self::Method(a), Self::Method(b)) => a == b,
            (Self::Import(a), Self::Import(b)) => a.to_string() == b.to_string(),
            (Self::System, Self::System) | (Self::Unset, Self::Unset) => true,
            _ => false,
        }
    }
}
