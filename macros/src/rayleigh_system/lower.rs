//! From the bodies of L, R and f, as the user wrote them, to expressions of a graph.
//!
//! The body is run over symbolic numbers: helpers and closures are called, loops over known ranges run, integers are
//! computed. What depends on a comparison of numbers runs both ways, and every local that differs becomes a selection.
//! What cannot be run is refused with its token and a reason; the caller decides whether that is an error.

mod method;
mod operator;
mod pattern;
mod statement;
mod value;

use std::rc::Rc;

use proc_macro2::{Delimiter, Span, TokenStream, TokenTree};
use quote::{ToTokens, format_ident, quote};
use syn::{Block, Expr, ExprLit, FnArg, Ident, ImplItem, ImplItemFn, Lit, Pat, ReturnType, Type};

use super::diagnostics::{Mistake, Report, span_of};
use super::graph::{Graph, Node, Operation};
use super::model::{Part, RayleighArguments, Source, System};
use value::{Closure, Truth, Value, Written};

/// Graphs beyond this are left to num-dual: their straight-line code would compile for minutes.
pub const MAX_NODES: usize = 20_000;

/// Statements and expressions run before a body is given up: an unrolled loop may be long, but not endless.
const MAX_EVALUATIONS: usize = 400_000;

/// Calls within calls.
const MAX_DEPTH: usize = 64;

/// L, R and f as expressions.
pub struct Lowered {
    pub graph: Graph,
    pub n: usize,
    /// Entries of the input.
    pub m: usize,
    pub lagrangian: Node,
    pub rayleigh: Option<Node>,
    pub force: Option<Vec<Node>>,
    /// The functions of the block that were run.
    pub functions: Vec<Ident>,
}

/// A token that cannot be lowered, and why.
#[derive(Debug)]
pub struct Refusal {
    pub span: Span,
    /// What stands there, on one line.
    pub token: String,
    pub reason: String,
}

impl Refusal {
    pub fn at(tokens: &impl ToTokens, reason: impl Into<String>) -> Self {
        Self { span: span_of(tokens), token: one_line(&tokens.to_token_stream()), reason: reason.into() }
    }

    /// The line of the source file, from 1; 0 where there is none.
    pub fn line(&self) -> usize {
        self.span.start().line
    }
}

/// The tokens as text, cut where they are long.
fn one_line(tokens: &TokenStream) -> String {
    const LONGEST: usize = 60;
    let text = tokens.to_string();
    let line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    match line.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{} …", &line[..end]),
        None => line,
    }
}

type Result<T> = std::result::Result<T, Refusal>;

fn refuse<T>(tokens: &impl ToTokens, reason: impl Into<String>) -> Result<T> {
    Err(Refusal::at(tokens, reason))
}

/// L, R and f of the system, or the first token that cannot be lowered.
pub fn system(system: &System<'_>) -> Result<Lowered> {
    let mut lowering = Lowering {
        source: system.source,
        graph: Graph::default(),
        locals: Vec::new(),
        captured: 0,
        returned: Returned::Never,
        leaving: None,
        depth: 0,
        evaluations: 0,
        expected: None,
        functions: Vec::new(),
    };
    // Known before the bodies read them.
    for parameter in &system.parameters {
        lowering.graph.listed(parameter);
    }
    let n = lowering.length(&system.degrees.length)?;
    let coordinates = (0..n).map(|i| Value::Real(lowering.graph.node(Operation::Coordinate(i)))).collect();
    let velocities = (0..n).map(|i| Value::Real(lowering.graph.node(Operation::Velocity(i)))).collect();
    let (q, v) = (Value::Sequence(coordinates), Value::Sequence(velocities));
    let m = match &system.input {
        None => 0,
        Some(input) => lowering.length(&input.length)?,
    };
    let u = system.input.as_ref().map(|_| {
        Value::Sequence((0..m).map(|i| Value::Real(lowering.graph.node(Operation::Input(i)))).collect())
    });
    // A local of the generated function.
    let t = system.timed.any().then(|| Value::Real(lowering.graph.time()));
    let timed = |part| t.clone().filter(|_| system.timed.of(part));

    let (lagrangian, rayleigh, force) = match system.source {
        Source::Block(_) => {
            let arguments = [q.clone(), v.clone()].into_iter().chain(timed(Part::Lagrangian)).collect();
            let lagrangian = lowering.root("lagrangian", arguments)?;
            let rayleigh = match system.rayleigh {
                None => None,
                Some(arguments) => {
                    let q = (arguments == RayleighArguments::ConfigurationAndVelocity).then(|| q.clone());
                    let arguments = q.into_iter().chain([v.clone()]).chain(timed(Part::Rayleigh)).collect();
                    Some(lowering.root("rayleigh", arguments)?)
                }
            };
            let force = if system.has_force {
                let arguments = [q, v].into_iter().chain(u).chain(timed(Part::Force)).collect();
                Some(lowering.root("force", arguments)?)
            } else {
                None
            };
            (lagrangian, rayleigh, force)
        }
        Source::Function(function) => {
            let fields = super::expand::parameters(function)
                .map(|(name, _)| Value::Written(Written::leaf(quote!(self.#name))));
            let arguments = [q, v].into_iter().chain(fields).collect();
            let signature = &function.item.sig;
            let result = lowering.call(&signature.ident, signature, &function.item.block, arguments)?;
            match (system.rayleigh, result) {
                (Some(_), Value::Tuple(mut pair)) if pair.len() == 2 => {
                    let rayleigh = pair.pop();
                    (pair.remove(0), rayleigh, None)
                }
                (_, value) => (value, None, None),
            }
        }
    };
    let at = &system.name;
    let lagrangian = lowering.scalar(at, lagrangian)?;
    let rayleigh = rayleigh.map(|value| lowering.scalar(at, value)).transpose()?;
    let force = match force {
        Some(Value::Sequence(components)) => {
            Some(components.into_iter().map(|value| lowering.scalar(at, value)).collect::<Result<Vec<_>>>()?)
        }
        Some(_) => return refuse(at, "the force is not an array whose entries can be told apart"),
        None => None,
    };
    Ok(Lowered { graph: lowering.graph, n, m, lagrangian, rayleigh, force, functions: lowering.functions })
}

/// Reports parameters that nothing reads, and those that are read where no derivative reaches them.
pub fn parameters(system: &System<'_>, lowered: &Lowered, report: &mut Report) {
    let graph = &lowered.graph;
    let force = lowered.force.iter().flatten().copied();
    let roots = [lowered.lagrangian].into_iter().chain(lowered.rayleigh).chain(force);
    let read: Vec<String> = graph
        .reachable(roots)
        .into_iter()
        .filter_map(|node| match graph.operation(node) {
            Operation::Parameter(index) => Some(graph.parameter(index).tokens.to_string()),
            _ => None,
        })
        .collect();
    for parameter in &system.parameters {
        let root = first_word(parameter.to_token_stream());
        let hides =
            |tokens: &&TokenStream| !is_entry((*tokens).clone()) && reads_field((*tokens).clone(), &root);
        if let Some(within) = graph.parameters().find(hides) {
            let (parameter_text, within) =
                (parameter.to_token_stream().to_string(), within.to_string().replace(" . ", "."));
            report.at(parameter, Mistake::HiddenParameter { parameter: parameter_text, within });
        } else if !read.contains(&quote!(self.#parameter).to_string()) {
            report.at(parameter, Mistake::NoSuchParameter(parameter.to_token_stream().to_string()));
        }
    }
}

fn first_word(tokens: TokenStream) -> String {
    tokens.into_iter().next().map(|word| word.to_string()).unwrap_or_default()
}

/// Whether the tokens are `self.c[0].1`: one entry, told by literals.
fn is_entry(tokens: TokenStream) -> bool {
    tokens.into_iter().all(|token| match token {
        TokenTree::Ident(_) | TokenTree::Literal(_) => true,
        TokenTree::Punct(punct) => punct.as_char() == '.',
        TokenTree::Group(group) => {
            let mut index = group.stream().into_iter();
            group.delimiter() == Delimiter::Bracket
                && matches!((index.next(), index.next()), (Some(TokenTree::Literal(_)), None))
        }
    })
}

/// Whether `self.field` stands anywhere among the tokens.
fn reads_field(tokens: TokenStream, field: &str) -> bool {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let here = tokens.windows(3).any(|three| match three {
        [TokenTree::Ident(owner), TokenTree::Punct(_), TokenTree::Ident(name)] => {
            owner == "self" && name == field
        }
        _ => false,
    });
    here || tokens.into_iter().any(|token| match token {
        TokenTree::Group(group) => reads_field(group.stream(), field),
        _ => false,
    })
}

/// Whether the function has returned.
#[derive(Clone)]
enum Returned {
    Never,
    /// Where the condition holds.
    Where(Node, Value),
    Always(Value),
}

/// `break` or `continue` on its way to a loop.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Leaving {
    Break,
    Continue,
}

/// A body on the run.
struct Lowering<'s> {
    source: &'s Source,
    graph: Graph,
    /// Innermost last; a later one of the same name hides the earlier.
    locals: Vec<(String, Value)>,
    /// Locals before this index belong to the surroundings of a closure: it can read, but not change them.
    captured: usize,
    returned: Returned,
    leaving: Option<Leaving>,
    depth: usize,
    evaluations: usize,
    /// The length that the context gives to an array, for `array::from_fn`.
    expected: Option<usize>,
    functions: Vec<Ident>,
}

impl Lowering<'_> {
    fn root(&mut self, name: &str, arguments: Vec<Value>) -> Result<Value> {
        let Some(function) = self.function(&format_ident!("{name}")).cloned() else {
            return refuse(&self.source.name(), format!("`{name}` is missing"));
        };
        self.call(&function.sig.ident, &function.sig, &function.block, arguments)
    }

    /// A function of the annotated block.
    fn function(&self, name: &Ident) -> Option<&'_ ImplItemFn> {
        self.source.functions().find(|function| function.sig.ident == *name)
    }

    /// An integer constant of the annotated block, as written.
    fn block_constant(&self, name: &Ident) -> Option<Expr> {
        let Source::Block(block) = self.source else { return None };
        block.item.items.iter().find_map(|item| match item {
            ImplItem::Const(constant)
                if constant.ident == *name && super::model::is_integer(&constant.ty) =>
            {
                Some(constant.expr.clone())
            }
            _ => None,
        })
    }

    /// Calls a function of the block: its body is run with the arguments in place of the parameters.
    fn call(
        &mut self,
        at: &impl ToTokens,
        signature: &syn::Signature,
        body: &Block,
        arguments: Vec<Value>,
    ) -> Result<Value> {
        let parameters: Vec<(Pat, Type)> = signature
            .inputs
            .iter()
            .filter_map(|parameter| match parameter {
                FnArg::Typed(parameter) => Some(((*parameter.pat).clone(), (*parameter.ty).clone())),
                FnArg::Receiver(_) => None,
            })
            .collect();
        if parameters.len() != arguments.len() {
            return refuse(at, "called with another number of arguments than it has parameters");
        }
        if !self.functions.contains(&signature.ident) {
            self.functions.push(signature.ident.clone());
        }
        let outside = self.enter(at, Vec::new())?;
        for ((pattern, ty), argument) in parameters.iter().zip(arguments) {
            let argument = self.shaped(argument, ty)?;
            self.bind(pattern, argument)?;
        }
        let (result, ty) = match &signature.output {
            ReturnType::Type(_, ty) => (self.with_expected(ty, |this| this.block(body))?, Some(ty)),
            ReturnType::Default => (self.block(body)?, None),
        };
        let result = self.leave(at, outside, result)?;
        match ty {
            Some(ty) => self.shaped(result, ty),
            None => Ok(result),
        }
    }

    /// Calls a closure, or a function handed on by its name.
    fn apply(&mut self, at: &impl ToTokens, function: &Value, arguments: Vec<Value>) -> Result<Value> {
        match function {
            Value::Closure(closure) => {
                if closure.parameters.len() != arguments.len() {
                    return refuse(at, "called with another number of arguments than it has parameters");
                }
                let outside = self.enter(at, closure.locals.clone())?;
                self.captured = self.locals.len();
                for (pattern, argument) in closure.parameters.iter().zip(arguments) {
                    self.bind(pattern, argument)?;
                }
                let result = self.expression(&closure.body)?;
                self.leave(at, outside, result)
            }
            Value::Function(name) => {
                let Some(function) = self.function(name).cloned() else {
                    return refuse(at, format!("`{name}` is no function of the annotated block"));
                };
                self.call(at, &function.sig, &function.block, arguments)
            }
            Value::Method(name) => {
                let mut arguments = arguments.into_iter();
                match arguments.next() {
                    Some(receiver) => self.value_method(name, receiver, arguments.collect()),
                    None => refuse(at, "called without an argument"),
                }
            }
            _ => refuse(at, "only closures and functions of the annotated block can be called here"),
        }
    }

    /// Starts a body with its own locals; what was there is kept.
    fn enter(&mut self, at: &impl ToTokens, locals: Vec<(String, Value)>) -> Result<Outside> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return refuse(at, "calls are nested too deeply, or without end");
        }
        Ok(Outside {
            locals: std::mem::replace(&mut self.locals, locals),
            captured: std::mem::replace(&mut self.captured, 0),
            returned: std::mem::replace(&mut self.returned, Returned::Never),
            leaving: self.leaving.take(),
            expected: self.expected.take(),
        })
    }

    /// Ends a body; its value is what it returned on the way, or `tail`.
    fn leave(&mut self, at: &impl ToTokens, outside: Outside, tail: Value) -> Result<Value> {
        self.depth -= 1;
        self.locals = outside.locals;
        self.captured = outside.captured;
        self.leaving = outside.leaving;
        self.expected = outside.expected;
        match std::mem::replace(&mut self.returned, outside.returned) {
            Returned::Never => Ok(tail),
            Returned::Always(value) => Ok(value),
            Returned::Where(condition, value) => self.select(at, condition, value, tail),
        }
    }

    /// Runs `body` where an array is expected to have the length that `ty` says.
    fn with_expected(&mut self, ty: &Type, body: impl FnOnce(&mut Self) -> Result<Value>) -> Result<Value> {
        let expected = match ty {
            Type::Array(array) => Some(self.length(&array.len)?),
            _ => None,
        };
        let outer = std::mem::replace(&mut self.expected, expected);
        let value = body(self);
        self.expected = outer;
        value
    }

    /// A length in a type: a literal, a constant of the block, or arithmetic on them.
    fn length(&mut self, length: &Expr) -> Result<usize> {
        if let Expr::Lit(ExprLit { lit: Lit::Int(literal), .. }) = length
            && let Ok(length) = literal.base10_parse()
        {
            if length > MAX_NODES {
                return refuse(literal, "so long an array is too much for straight-line code");
            }
            return Ok(length);
        }
        match self.expression(length)? {
            Value::Integer(length) if (0..=4096).contains(&length) => Ok(length as usize),
            _ => refuse(
                length,
                "this length is not known here; write a literal, or a constant of the annotated block",
            ),
        }
    }

    /// A field whose type says that it is an array, as its entries.
    fn shaped(&mut self, value: Value, ty: &Type) -> Result<Value> {
        match (value, ty) {
            (value, Type::Reference(reference)) => self.shaped(value, &reference.elem),
            (Value::Written(array), Type::Array(ty)) => {
                let length = self.length(&ty.len)?;
                let entries = (0..length).map(|index| Value::Written(array.entry(index)));
                entries.map(|entry| self.shaped(entry, &ty.elem)).collect::<Result<_>>().map(Value::Sequence)
            }
            (Value::Written(tuple), Type::Tuple(ty)) => {
                let entries = ty.elems.iter().enumerate();
                entries
                    .map(|(index, ty)| self.shaped(Value::Written(tuple.member(index)), ty))
                    .collect::<Result<_>>()
                    .map(Value::Tuple)
            }
            (value, _) => Ok(value),
        }
    }

    /// The value as a number.
    fn scalar(&mut self, at: &impl ToTokens, value: Value) -> Result<Node> {
        match value {
            Value::Real(node) => Ok(node),
            Value::Written(written) => Ok(written.scalar(&mut self.graph)),
            Value::Integer(_) => refuse(at, "an integer stands where a floating-point number is needed"),
            _ => refuse(at, "this is not a single number; take the entries of an array one by one"),
        }
    }

    /// The value as a condition.
    fn truth(&mut self, at: &impl ToTokens, value: Value) -> Result<Truth> {
        match value {
            Value::Truth(truth) => Ok(truth),
            Value::Written(written) => Ok(Truth::Where(self.graph.written(written.operand()))),
            _ => refuse(at, "this is not a condition that can be followed here"),
        }
    }

    /// `a` where the condition holds, else `b`.
    fn select(&mut self, at: &impl ToTokens, condition: Node, a: Value, b: Value) -> Result<Value> {
        if a.same(&b) {
            return Ok(a);
        }
        match (a, b) {
            (Value::Truth(a), Value::Truth(b)) => {
                let positive = a.and(&mut self.graph, Truth::Where(condition));
                let negated = self.graph.node(Operation::Not(condition));
                let negative = b.and(&mut self.graph, Truth::Where(negated));
                Ok(Value::Truth(positive.or(&mut self.graph, negative)))
            }
            (Value::Sequence(a), Value::Sequence(b)) if a.len() == b.len() => {
                self.select_all(at, condition, a, b).map(Value::Sequence)
            }
            (Value::Tuple(a), Value::Tuple(b)) if a.len() == b.len() => {
                self.select_all(at, condition, a, b).map(Value::Tuple)
            }
            (Value::Sequence(a), Value::Written(b)) => {
                let b = (0..a.len()).map(|index| Value::Written(b.entry(index))).collect();
                self.select_all(at, condition, a, b).map(Value::Sequence)
            }
            (Value::Written(a), Value::Sequence(b)) => {
                let a = (0..b.len()).map(|index| Value::Written(a.entry(index))).collect();
                self.select_all(at, condition, a, b).map(Value::Sequence)
            }
            (Value::Integer(_), Value::Integer(_)) => refuse(
                at,
                "an integer that depends on a comparison of numbers; choose between the results with `if` instead",
            ),
            (a, b) => {
                let (a, b) = (self.scalar(at, a)?, self.scalar(at, b)?);
                Ok(Value::Real(self.graph.select(condition, a, b)))
            }
        }
    }

    fn select_all(
        &mut self,
        at: &impl ToTokens,
        condition: Node,
        a: Vec<Value>,
        b: Vec<Value>,
    ) -> Result<Vec<Value>> {
        a.into_iter().zip(b).map(|(a, b)| self.select(at, condition, a, b)).collect()
    }

    fn local(&self, name: &Ident) -> Option<&Value> {
        let name = name.to_string();
        self.locals.iter().rev().find(|(known, _)| *known == name).map(|(_, value)| value)
    }

    /// Counts work, so that no loop runs without end.
    fn count(&mut self, at: &impl ToTokens) -> Result<()> {
        self.evaluations += 1;
        if self.evaluations > MAX_EVALUATIONS || self.graph.len() > MAX_NODES {
            return refuse(at, "the loops, written out, are too long for straight-line code");
        }
        Ok(())
    }

    fn closure(&self, closure: &syn::ExprClosure) -> Value {
        Value::Closure(Rc::new(Closure {
            parameters: closure.inputs.iter().cloned().collect(),
            body: (*closure.body).clone(),
            locals: self.locals.clone(),
        }))
    }
}

/// What surrounds a body that is called.
struct Outside {
    locals: Vec<(String, Value)>,
    captured: usize,
    returned: Returned,
    leaving: Option<Leaving>,
    expected: Option<usize>,
}

/// The tokens of a field with an index or member behind it.
fn indexed(base: &TokenStream, index: usize) -> TokenStream {
    let index = syn::Index::from(index);
    quote!(#base[#index])
}
