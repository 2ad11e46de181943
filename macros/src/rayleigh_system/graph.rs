//! Expressions as a graph: every operation stands once, its arguments before it.
//!
//! Two ways to add a node. The operation as it stands ([`Graph::add`] and its like) keeps what the user
//! wrote: same operations, same order, same rounding. The algebra of derivatives ([`Graph::plus`],
//! [`Graph::times`], …) may choose its own order: it drops factors 1, moves signs outwards and joins
//! constants whose product is exact. A derivative that is 0 because nothing depends on the variable is
//! absent, never a factor 0: no NaN or infinity is hidden by a product.

mod algebra;
mod angles;
mod before;
mod characteristic;
mod combination;
mod curve;
mod factor;
mod fused;
mod operation;
mod replaced;
mod spelled;
mod text;
mod zeros;

#[cfg(test)]
pub mod interpret;

use std::collections::{BTreeMap, BTreeSet, HashMap};

use proc_macro2::{Ident, Literal, Span, TokenStream, TokenTree};
use quote::{ToTokens, format_ident, quote};
use syn::Expr;

use super::hygiene::{MARK, unmarked};
use super::syntax::regrouped;

pub use super::functions::{Function, PairFunction, Predicate};
pub use before::before_the_run;
pub use curve::Curve;
pub use operation::{Comparison, Operation};

/// An expression of a [`Graph`]. Arguments are smaller than what is made of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Node(u32);

impl Node {
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// Something the macro cannot see into: a field, a constant, the step size; written out where it is needed.
#[derive(Clone)]
pub struct Parameter {
    /// The user's tokens.
    pub tokens: TokenStream,
    /// The tokens as text: equal texts are one parameter.
    text: String,
    /// An entry of a local array, such as `q1[0]`.
    is_entry: bool,
    /// Whether derivatives are taken by it.
    is_listed: bool,
    /// Whether it is a `match`, which reads best behind a `let`.
    is_block: bool,
    /// Whether its evaluation may panic where the user's code does not evaluate it: it stays within the
    /// condition.
    stays: bool,
    /// The type that the user's body has it in, as far as the macro sees.
    taken_for: Option<Taken>,
}

/// A type that the macro takes something for that it cannot see into.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Taken {
    Number,
    Truth,
}

impl Parameter {
    /// Whether it is a local already, such as `half` or `q1[0]`.
    pub fn is_local(&self) -> bool {
        self.is_entry || self.tokens.clone().into_iter().count() == 1
    }

    /// Whether it is an entry of a local array.
    pub fn is_entry(&self) -> bool {
        self.is_entry
    }

    /// Whether it is written where it is used, however often.
    pub fn is_in_place(&self) -> bool {
        self.stays || self.is_local()
    }

    /// Whether it is written behind a `let`, however seldom it is used.
    pub fn is_apart(&self) -> bool {
        self.is_block && !self.stays
    }

    /// Whether it is read of the system, not a constant.
    pub fn reads_self(&self) -> bool {
        mentions(&self.text, "self")
    }

    /// The tokens as an operand.
    pub fn operand(&self) -> TokenStream {
        let tokens = &self.tokens;
        if self.is_block && self.stays { quote!((#tokens)) } else { tokens.clone() }
    }
}

/// Where expressions are moved to.
pub struct Point {
    /// The suffix of names there.
    name: &'static str,
    coordinates: Vec<Node>,
    time: Option<Node>,
    /// Expressions that have been moved there, by those that they were.
    moved: HashMap<Node, Node>,
}

impl Point {
    pub fn new(name: &'static str, coordinates: Vec<Node>, time: Option<Node>) -> Self {
        Self { name, coordinates, time, moved: HashMap::new() }
    }
}

/// The time, a local of functions whose bodies read it.
const TIME: &str = "t";

/// The most expressions of a system, with all that is made on the way to its functions: beyond them the macro
/// would take seconds.
pub const MOST_EXPRESSIONS: usize = 100_000;

/// The most operations of one generated function, and of what the user wrote: beyond them rustc would take
/// minutes.
pub const MOST_OPERATIONS: usize = 20_000;

/// The expressions of one system.
#[derive(Clone, Default)]
pub struct Graph {
    operations: Vec<Operation>,
    depends: Vec<bool>,
    nodes: HashMap<Operation, Node>,
    parameters: Vec<Parameter>,
    /// Parameters by their text.
    places: HashMap<String, usize>,
    names: BTreeMap<Node, String>,
    /// Whether sums keep the 0 that they start from.
    keeps_zeros: bool,
    /// Sums that have lost theirs, as they are without it.
    without_zero: Vec<Node>,
    /// The name of the user's system, and those of constants in small letters.
    reserved: BTreeSet<String>,
    /// Half the step size and the step size, where they occur.
    step_size: Option<[Node; 2]>,
}

impl Graph {
    /// How many expressions there are.
    pub fn len(&self) -> usize {
        self.operations.len()
    }

    /// Whether there are more expressions than one run of the macro should make.
    pub fn is_full(&self) -> bool {
        self.len() > MOST_EXPRESSIONS
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
        self.parameters.iter().any(|known| mentions(&known.text, word))
    }

    /// Keeps a name from what is generated.
    pub fn reserve(&mut self, name: String) {
        self.reserved.insert(name);
    }

    /// The names that are kept from what is generated.
    pub fn reserved(&self) -> impl Iterator<Item = &String> {
        self.reserved.iter()
    }

    /// Whether the name is kept from what is generated.
    pub fn is_reserved(&self, name: &str) -> bool {
        self.reserved.contains(name)
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
    ///
    /// A name of the user's loses its mark here, before names are told apart: two that differ by the mark
    /// alone would become one where marks are taken off, in the finished text.
    pub fn give_name(&mut self, node: Node, name: &str) {
        let needs_none = match self.operation(node) {
            Operation::Parameter(index) => self.parameters[index].stays,
            operation => operation.is_literal(),
        };
        if !needs_none {
            // `let Midpoint = …` would be the rule of that name, under whatever other name it has.
            let name = if name.contains(MARK) { unmarked(name).to_lowercase() } else { name.to_owned() };
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

    /// [`written`](Self::written) tokens of the user's; `is_block` if they are a `match`.
    pub fn written_as(&mut self, tokens: TokenStream, is_block: bool, taken_for: Taken) -> Node {
        let node = self.parameter_of(tokens, false);
        if let Operation::Parameter(index) = self.operation(node) {
            let parameter = &mut self.parameters[index];
            (parameter.is_block, parameter.taken_for) = (is_block, Some(taken_for));
        }
        node
    }

    /// The user's tokens that the expressions take for a type, and whether they can be read anywhere.
    pub fn taken_for(&self, taken: Taken, roots: impl IntoIterator<Item = Node>) -> Vec<(TokenStream, bool)> {
        let parameters = self.reachable(roots).into_iter().filter_map(|node| match self.operation(node) {
            Operation::Parameter(index) => Some(&self.parameters[index]),
            _ => None,
        });
        parameters
            .filter(|known| known.taken_for == Some(taken))
            .map(|known| (known.tokens.clone(), !known.stays && !known.is_block))
            .collect()
    }

    /// Leaves the parameter within the conditions that it stands in.
    pub fn keep_in_place(&mut self, node: Node) {
        if let Operation::Parameter(index) = self.operation(node) {
            self.parameters[index].stays = true;
        }
    }

    /// Whether any of the expressions needs a parameter that stays within conditions.
    pub fn is_conditional(&self, roots: impl IntoIterator<Item = Node>) -> bool {
        self.reachable(roots).into_iter().any(|node| match self.operation(node) {
            Operation::Parameter(index) => self.parameters[index].stays,
            _ => false,
        })
    }

    /// `array[index]`, an entry of a local array.
    pub fn entry(&mut self, array: &str, index: usize) -> Node {
        let (array, index) = (format_ident!("{array}"), Literal::usize_unsuffixed(index));
        self.parameter_of(quote!(#array[#index]), true)
    }

    /// `value.member`, of a local.
    pub fn member(&mut self, value: &str, member: &str) -> Node {
        let [value, member] = [value, member].map(|name| format_ident!("{name}"));
        self.written(quote!(#value.#member))
    }

    /// The time at the end of a step.
    pub fn end_time(&mut self) -> Node {
        self.written(quote!(t_end))
    }

    fn parameter_of(&mut self, tokens: TokenStream, is_entry: bool) -> Node {
        let tokens = with_own_self(tokens);
        self.placed(tokens, is_entry, false)
    }

    fn placed(&mut self, tokens: TokenStream, is_entry: bool, is_listed: bool) -> Node {
        let index = self.place(tokens, is_entry, is_listed);
        self.node(Operation::Parameter(index))
    }

    /// The place of the parameter that is written as these tokens.
    fn place(&mut self, tokens: TokenStream, is_entry: bool, is_listed: bool) -> usize {
        let text = tokens.to_string();
        self.places.get(&text).copied().unwrap_or_else(|| {
            self.places.insert(text.clone(), self.parameters.len());
            self.parameters.push(Parameter {
                tokens,
                text,
                is_entry,
                is_listed,
                is_block: false,
                stays: false,
                taken_for: None,
            });
            self.parameters.len() - 1
        })
    }

    /// The parameter `self.m` for the expression `m`, from now on one that derivatives are taken by.
    pub fn listed(&mut self, expression: &Expr) -> Node {
        self.placed(with_own_self(quote!(self.#expression)), false, true)
    }

    /// `half`, of a step size `h`.
    pub fn half_step(&mut self) -> Node {
        let [half, whole] =
            ["half", "h"].map(|name| self.written(format_ident!("{name}").into_token_stream()));
        self.step_size = Some([half, whole]);
        half
    }

    /// The step size, where `a` and `b` are 2 and half of it.
    pub fn as_step_size(&self, a: Node, b: Node) -> Option<Node> {
        let [half, whole] = self.step_size?;
        let is_two = |node| self.constant_value(node) == Some(2.0);
        ((a == half && is_two(b)) || (b == half && is_two(a))).then_some(whole)
    }

    /// The time, and whether derivatives are taken by it.
    pub fn time(&mut self, is_variable: bool) -> Node {
        let time = format_ident!("{TIME}");
        self.placed(quote!(#time), false, is_variable)
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

    /// The expression with the coordinates replaced, and the time if it is given; names say where.
    pub fn at(&mut self, root: Node, point: &mut Point) -> Node {
        let mut new = BTreeSet::new();
        let mut open = vec![root];
        while let Some(node) = open.pop() {
            if !point.moved.contains_key(&node) && new.insert(node) {
                open.extend(self.operation(node).arguments());
            }
        }
        for node in new {
            let operation = self.operation(node);
            let replacement = match operation {
                Operation::Coordinate(index) => point.coordinates[index],
                Operation::Parameter(index) if self.parameters[index].text == TIME => {
                    point.time.unwrap_or(node)
                }
                _ => {
                    let replacement = self.node(operation.with_arguments(|argument| point.moved[&argument]));
                    if let Some(name) = self.names.get(&node).cloned() {
                        self.give_name(replacement, &format!("{name}_{}", point.name));
                    }
                    replacement
                }
            };
            point.moved.insert(node, replacement);
        }
        point.moved[&root]
    }

    /// How many operations compute `roots`.
    pub fn operations(&self, roots: impl IntoIterator<Item = Node>) -> usize {
        let is_computed = |node: &Node| self.operation(*node).arguments().next().is_some();
        self.reachable(roots).iter().filter(|node| is_computed(node)).count()
    }

    /// Everything that `roots` need, arguments first.
    pub fn reachable(&self, roots: impl IntoIterator<Item = Node>) -> Vec<Node> {
        self.reachable_before(roots, |_| false)
    }

    /// [`reachable`](Self::reachable) without what is behind nodes that are `known`.
    pub fn reachable_before(
        &self,
        roots: impl IntoIterator<Item = Node>,
        is_known: impl Fn(Node) -> bool,
    ) -> Vec<Node> {
        let mut seen = vec![false; self.len()];
        let mut open: Vec<Node> = roots.into_iter().collect();
        let mut reached = Vec::new();
        while let Some(node) = open.pop() {
            if !std::mem::replace(&mut seen[node.index()], true) {
                if !is_known(node) {
                    open.extend(self.operation(node).arguments());
                }
                reached.push(node);
            }
        }
        reached.sort_unstable();
        reached
    }
}

/// Whether a text is written with this word.
fn mentions(text: &str, word: &str) -> bool {
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    text.split(|c| !is_name(c)).any(|other| other == word)
}

/// The tokens with `self` that of the generated function: the user's is another variable where a
/// `macro_rules!` wrote the attribute.
fn with_own_self(tokens: TokenStream) -> TokenStream {
    tokens
        .into_iter()
        .map(|token| match token {
            TokenTree::Ident(word) if word == "self" => {
                TokenTree::Ident(Ident::new("self", Span::call_site().located_at(word.span())))
            }
            TokenTree::Group(group) => regrouped(&group, with_own_self(group.stream())),
            other => other,
        })
        .collect()
}
