//! Expressions as a graph: every operation stands once, its arguments before it.
//!
//! Two ways to add a node. The operation as it stands ([`Graph::add`] and its like) keeps what the user wrote: same
//! operations, same order, same rounding. The algebra of derivatives ([`Graph::plus`], [`Graph::times`], …) may choose its
//! own order: it drops factors 1, moves signs outwards and joins constants whose product is exact. A derivative that is 0
//! because nothing depends on the variable is absent, never a factor 0: no NaN or infinity is hidden by a product.

mod algebra;
mod factor;
mod operation;

#[cfg(test)]
pub mod interpret;

use std::collections::{BTreeMap, HashMap};

use proc_macro2::{Group, Ident, Literal, Span, TokenStream, TokenTree};
use quote::{format_ident, quote};
use syn::Expr;

pub use operation::{Comparison, Function, Operation, PairFunction, Predicate};

/// An expression of a [`Graph`]. Arguments are smaller than what is made of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Node(u32);

impl Node {
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// Something the macro cannot see into: a field, a constant, the step size; written out where it is needed.
pub struct Parameter {
    /// The user's tokens.
    pub tokens: TokenStream,
    /// The same as text: equal texts are one parameter.
    text: String,
    /// An entry of a local array, such as `q1[0]`.
    is_entry: bool,
    /// Whether derivatives are taken by it.
    is_listed: bool,
}

impl Parameter {
    /// Whether it is a local already, such as `half` or `q1[0]`.
    pub fn is_local(&self) -> bool {
        self.is_entry || self.tokens.clone().into_iter().count() == 1
    }
}

/// The time, a local of functions whose bodies read it.
const TIME: &str = "t";

/// The expressions of one system.
#[derive(Default)]
pub struct Graph {
    operations: Vec<Operation>,
    depends: Vec<bool>,
    nodes: HashMap<Operation, Node>,
    parameters: Vec<Parameter>,
    names: BTreeMap<Node, String>,
}

impl Graph {
    /// How many expressions there are.
    pub fn len(&self) -> usize {
        self.operations.len()
    }

    /// All expressions, arguments first.
    pub fn nodes(&self) -> impl Iterator<Item = Node> + use<> {
        (0..u32::try_from(self.operations.len()).unwrap_or(u32::MAX)).map(Node)
    }

    pub fn operation(&self, node: Node) -> Operation {
        self.operations[node.index()]
    }

    pub fn parameter(&self, index: usize) -> &Parameter {
        &self.parameters[index]
    }

    /// Whether a parameter is written with this word.
    pub fn mentions(&self, word: &str) -> bool {
        let is_name = |c: char| c.is_alphanumeric() || c == '_';
        self.parameters.iter().any(|known| known.text.split(|c| !is_name(c)).any(|other| other == word))
    }

    /// Whether the value changes with q, v or u.
    pub fn depends(&self, node: Node) -> bool {
        self.depends[node.index()]
    }

    /// The name that `let` gave to the expression.
    pub fn name(&self, node: Node) -> Option<&str> {
        self.names.get(&node).map(String::as_str)
    }

    /// Names an expression, unless it has a name or needs none.
    pub fn give_name(&mut self, node: Node, name: &str) {
        let needs_none = self.operation(node).is_literal();
        if !needs_none {
            self.names.entry(node).or_insert_with(|| name.trim_start_matches('_').to_owned());
        }
    }

    /// The expression, as it stands.
    pub fn node(&mut self, operation: Operation) -> Node {
        let operation = operation.ordered();
        if let Some(&node) = self.nodes.get(&operation) {
            return node;
        }
        let node = Node(u32::try_from(self.operations.len()).expect("graphs are limited to far fewer nodes"));
        let depends =
            self.is_variable(operation) || operation.arguments().any(|argument| self.depends(argument));
        self.operations.push(operation);
        self.depends.push(depends);
        self.nodes.insert(operation, node);
        node
    }

    /// The node of an operation that occurs already.
    pub fn known(&self, operation: Operation) -> Option<Node> {
        self.nodes.get(&operation.ordered()).copied()
    }

    pub fn constant(&mut self, value: f64) -> Node {
        self.node(Operation::Constant(value.to_bits()))
    }

    /// The value of a constant node.
    pub fn constant_value(&self, node: Node) -> Option<f64> {
        match self.operation(node) {
            Operation::Constant(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    /// The parameter written as `tokens`.
    pub fn written(&mut self, tokens: TokenStream) -> Node {
        self.parameter_of(tokens, false)
    }

    /// `array[index]`, an entry of a local array.
    pub fn entry(&mut self, array: &str, index: usize) -> Node {
        let (array, index) = (format_ident!("{array}"), Literal::usize_unsuffixed(index));
        self.parameter_of(quote!(#array[#index]), true)
    }

    fn parameter_of(&mut self, tokens: TokenStream, is_entry: bool) -> Node {
        let tokens = with_own_self(tokens);
        let text = tokens.to_string();
        let index = self.parameters.iter().position(|known| known.text == text).unwrap_or_else(|| {
            self.parameters.push(Parameter { tokens, text, is_entry, is_listed: false });
            self.parameters.len() - 1
        });
        self.node(Operation::Parameter(index))
    }

    /// The parameter `self.m` for the expression `m`, from now on one that derivatives are taken by.
    pub fn listed(&mut self, expression: &Expr) -> Node {
        let tokens = with_own_self(quote!(self.#expression));
        let text = tokens.to_string();
        let index = self.parameters.iter().position(|known| known.text == text).unwrap_or_else(|| {
            self.parameters.push(Parameter { tokens, text, is_entry: false, is_listed: true });
            self.parameters.len() - 1
        });
        self.node(Operation::Parameter(index))
    }

    /// The time.
    pub fn time(&mut self) -> Node {
        let time = format_ident!("{TIME}");
        self.written(quote!(#time))
    }

    /// Whether the operation is the time.
    pub fn is_time(&self, operation: Operation) -> bool {
        matches!(operation, Operation::Parameter(index) if self.parameters[index].text == TIME)
    }

    /// Whether the operation is what derivatives are taken by.
    pub fn is_variable(&self, operation: Operation) -> bool {
        match operation {
            Operation::Coordinate(_) | Operation::Velocity(_) | Operation::Input(_) => true,
            Operation::Parameter(index) => self.parameters[index].is_listed,
            _ => false,
        }
    }

    /// The tokens of all parameters that occur.
    pub fn parameters(&self) -> impl Iterator<Item = &TokenStream> {
        self.parameters.iter().map(|parameter| &parameter.tokens)
    }

    /// a + b as written, without an initial 0 that the sum of a loop starts from (which changes no more than the sign of
    /// a zero).
    pub fn add(&mut self, a: Node, b: Node) -> Node {
        match (self.constant_value(a), self.constant_value(b)) {
            (Some(0.0), None) => b,
            (None, Some(0.0)) => a,
            _ => self.node(Operation::Add(a, b)),
        }
    }

    pub fn function(&mut self, function: Function, argument: Node) -> Node {
        self.node(Operation::Function(function, argument))
    }

    /// xⁿ; squares and cubes as products, which is what they are compiled to.
    pub fn power(&mut self, x: Node, n: i32) -> Node {
        match n {
            0 => self.constant(1.0),
            1 => x,
            2 => self.node(Operation::Multiply(x, x)),
            3 => {
                let square = self.node(Operation::Multiply(x, x));
                self.node(Operation::Multiply(square, x))
            }
            _ => self.node(Operation::Power(x, n)),
        }
    }

    /// `if condition { a } else { b }`.
    pub fn select(&mut self, condition: Node, a: Node, b: Node) -> Node {
        if a == b { a } else { self.node(Operation::Select(condition, a, b)) }
    }

    /// The expressions with the coordinates replaced, and the time if it is given; names kept.
    pub fn at(&mut self, roots: &[Node], configuration: &[Node], time: Option<Node>) -> Vec<Node> {
        let mut moved: HashMap<Node, Node> = HashMap::new();
        for node in self.reachable(roots.iter().copied()) {
            let operation = self.operation(node);
            let replacement = match operation {
                Operation::Coordinate(index) => configuration[index],
                Operation::Parameter(index) if self.parameters[index].text == TIME => time.unwrap_or(node),
                _ => {
                    let replacement = self.node(operation.with_arguments(|argument| moved[&argument]));
                    if let Some(name) = self.names.get(&node).cloned() {
                        self.give_name(replacement, &name);
                    }
                    replacement
                }
            };
            moved.insert(node, replacement);
        }
        roots.iter().map(|root| moved[root]).collect()
    }

    /// Everything that `roots` need, arguments first.
    pub fn reachable(&self, roots: impl IntoIterator<Item = Node>) -> Vec<Node> {
        let mut seen = vec![false; self.len()];
        let mut open: Vec<Node> = roots.into_iter().collect();
        while let Some(node) = open.pop() {
            if !std::mem::replace(&mut seen[node.index()], true) {
                open.extend(self.operation(node).arguments());
            }
        }
        (0..).zip(seen).filter(|(_, seen)| *seen).map(|(index, _)| Node(index)).collect()
    }
}

/// The tokens with `self` that of the generated function: the user's is another variable where a `macro_rules!` wrote the
/// attribute.
fn with_own_self(tokens: TokenStream) -> TokenStream {
    tokens
        .into_iter()
        .map(|token| match token {
            TokenTree::Ident(word) if word == "self" => {
                TokenTree::Ident(Ident::new("self", Span::call_site().located_at(word.span())))
            }
            TokenTree::Group(group) => {
                let mut own = Group::new(group.delimiter(), with_own_self(group.stream()));
                own.set_span(group.span());
                TokenTree::Group(own)
            }
            other => other,
        })
        .collect()
}
