//! What an expression of a body is while the body is run.

use std::rc::Rc;

use proc_macro2::{TokenStream, TokenTree};
use quote::{ToTokens, quote};
use syn::{BinOp, Expr, Ident, Index, Pat};

use super::super::graph::{Graph, Node, Operation};
use super::indexed;

/// A value of a body.
#[derive(Clone)]
pub enum Value {
    /// A floating-point number.
    Real(Node),
    Truth(Truth),
    /// A known integer.
    Integer(i128),
    /// Made of fields and constants alone, of a type that the macro cannot know.
    Written(Written),
    /// An array, slice or iterator; its entries are known one by one.
    Sequence(Vec<Value>),
    Tuple(Vec<Value>),
    Closure(Rc<Closure>),
    /// A function of the block, by name.
    Function(Ident),
    /// `f64::sin` handed on.
    Method(Ident),
    /// `self`.
    System,
}

/// A closure and what it sees.
pub struct Closure {
    pub parameters: Vec<Pat>,
    pub body: Expr,
    pub locals: Vec<(String, Value)>,
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
}

impl Value {
    /// No value: that of a block without a tail.
    pub fn unit() -> Self {
        Self::Tuple(Vec::new())
    }

    /// Whether the two are surely equal.
    pub fn same(&self, other: &Self) -> bool {
        let all = |a: &[Self], b: &[Self]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.same(b));
        match (self, other) {
            (Self::Real(a), Self::Real(b)) => a == b,
            (Self::Truth(a), Self::Truth(b)) => a == b,
            (Self::Integer(a), Self::Integer(b)) => a == b,
            (Self::Written(a), Self::Written(b)) => a.tokens().to_string() == b.tokens().to_string(),
            (Self::Sequence(a), Self::Sequence(b)) | (Self::Tuple(a), Self::Tuple(b)) => all(a, b),
            (Self::Closure(a), Self::Closure(b)) => Rc::ptr_eq(a, b),
            (Self::Function(a), Self::Function(b)) | (Self::Method(a), Self::Method(b)) => a == b,
            (Self::System, Self::System) => true,
            _ => false,
        }
    }
}

/// An expression of fields and constants. Its type shows in its use: as a number it becomes nodes of the graph, as an
/// index, integer or condition it is written out.
#[derive(Clone)]
pub enum Written {
    Leaf(TokenStream),
    Named(String, Box<Written>),
    Negative(Box<Written>),
    Binary(BinOp, Box<Written>, Box<Written>),
}

impl Written {
    pub fn leaf(tokens: TokenStream) -> Self {
        Self::Leaf(tokens)
    }

    /// `array[index]`.
    pub fn entry(&self, index: usize) -> Self {
        Self::Leaf(indexed(&self.operand(), index))
    }

    /// `tuple.index`.
    pub fn member(&self, index: usize) -> Self {
        let (base, index) = (self.operand(), Index::from(index));
        Self::Leaf(quote!(#base.#index))
    }

    pub fn tokens(&self) -> TokenStream {
        match self {
            Self::Leaf(tokens) => tokens.clone(),
            Self::Named(_, inner) => inner.tokens(),
            Self::Negative(inner) => {
                let inner = inner.operand();
                quote!(-#inner)
            }
            Self::Binary(operator, a, b) => {
                let (a, b) = (a.operand(), b.operand());
                quote!(#a #operator #b)
            }
        }
    }

    /// The tokens, in parentheses where they are more than one operand.
    pub fn operand(&self) -> TokenStream {
        match self {
            Self::Leaf(tokens) => tokens.clone(),
            Self::Named(_, inner) => inner.operand(),
            Self::Negative(_) | Self::Binary(..) => {
                let tokens = self.tokens();
                quote!((#tokens))
            }
        }
    }

    /// The expression as a floating-point number.
    pub fn scalar(&self, graph: &mut Graph) -> Node {
        match self {
            Self::Leaf(tokens) => {
                let node = graph.written(tokens.clone());
                if let Some(name) = name_of(tokens) {
                    graph.give_name(node, &name);
                }
                node
            }
            Self::Named(name, inner) => {
                if let Self::Leaf(tokens) = &**inner {
                    let node = graph.written(tokens.clone());
                    graph.give_name(node, name);
                    return node;
                }
                let node = inner.scalar(graph);
                graph.give_name(node, name);
                node
            }
            Self::Negative(inner) => {
                let inner = inner.scalar(graph);
                graph.node(Operation::Negate(inner))
            }
            Self::Binary(operator, a, b) => {
                let (a, b) = (a.scalar(graph), b.scalar(graph));
                match operator {
                    BinOp::Add(_) => graph.add(a, b),
                    BinOp::Sub(_) => graph.node(Operation::Subtract(a, b)),
                    BinOp::Mul(_) => graph.node(Operation::Multiply(a, b)),
                    BinOp::Div(_) => graph.node(Operation::Divide(a, b)),
                    // Remainders and shifts of integers; whole, and whatever type it has.
                    _ => graph.written(self.operand()),
                }
            }
        }
    }
}

/// `self.m[0]` → `m_0`, `Self::G` → `g`.
fn name_of(tokens: &TokenStream) -> Option<String> {
    fn collect(tokens: TokenStream, words: &mut Vec<String>) {
        for token in tokens {
            match token {
                TokenTree::Group(group) => collect(group.stream(), words),
                TokenTree::Ident(ident) => {
                    words.push(ident.to_string().trim_start_matches("r#").to_lowercase())
                }
                TokenTree::Literal(literal) => {
                    let literal: String =
                        literal.to_string().chars().filter(char::is_ascii_alphanumeric).collect();
                    words.push(literal);
                }
                TokenTree::Punct(_) => {}
            }
        }
    }
    let mut all = Vec::new();
    collect(tokens.to_token_stream(), &mut all);
    const SILENT: [&str; 8] = ["self", "std", "core", "f64", "f32", "consts", "as", "from"];
    all.retain(|word| !SILENT.contains(&word.as_str()));
    let name = all.join("_");
    (name.starts_with(char::is_alphabetic) && name.len() < 30).then_some(name)
}
