//! From the bodies of L, R and f, as the user wrote them, to expressions of a graph.
//!
//! The body is run over symbolic numbers: helpers and closures are called, loops over known ranges run,
//! integers are computed. What depends on a comparison of numbers runs both ways, and every local that
//! differs becomes a selection. What cannot be run is refused with its token and a reason; the caller decides
//! whether that is an error.

mod choice;
mod field;
mod integer;
mod load;
mod method;
mod operator;
mod pattern;
mod place;
mod sequence;
mod statement;
mod value;
mod written;

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;

use proc_macro2::{Span, TokenStream};
use quote::{ToTokens, format_ident, quote};
use syn::{
    Block, Expr, ExprLit, FnArg, GenericParam, Ident, ImplItem, ImplItemFn, Lit, Pat, ReturnType, Type,
};

use super::diagnostics::span_of;
use super::graph::{Graph, Node, Operation};
use super::model::{Part, RayleighArguments, Source, System};
use super::syntax::simple_name;
use integer::{Classes, IntegerType};
pub use load::{Length, Load};
use value::{Chosen, Closure, Truth, Value};
use written::{Clash, Text, Written};

/// Bodies beyond this are left to num-dual.
pub const MAX_NODES: usize = super::graph::MOST_OPERATIONS;

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
    /// Names taken for bindings where a constant of that name would be one: rustc has to agree.
    pub bindings: Vec<Ident>,
    /// What most operations are written by.
    pub heaviest: Option<Load>,
}

/// A token that cannot be lowered, and why.
#[derive(Debug)]
pub struct Refusal {
    pub span: Span,
    /// What stands there, on one line.
    pub token: String,
    pub reason: String,
    /// Whether dual numbers could not follow either.
    pub is_final: bool,
}

impl Refusal {
    pub fn at(tokens: &impl ToTokens, reason: impl Into<String>) -> Self {
        Self {
            span: span_of(tokens),
            token: one_line(&tokens.to_token_stream()),
            reason: reason.into(),
            is_final: false,
        }
    }

    /// The same where dual numbers could not follow either.
    fn for_all(mut self) -> Self {
        self.is_final = true;
        self
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
    let lowered = on_graph(system, Graph::default())?;
    if lowered.graph.shows_zeros_left_out() { on_graph(system, Graph::with_zeros()) } else { Ok(lowered) }
}

fn on_graph(system: &System<'_>, graph: Graph) -> Result<Lowered> {
    let mut lowering = Lowering {
        source: system.source,
        scalar: system.scalar.clone(),
        graph,
        locals: Vec::new(),
        captured: 0,
        returned: Returned::Never,
        leaving: None,
        guards: Vec::new(),
        depth: 0,
        evaluations: 0,
        integers: Classes::default(),
        bindings: BTreeMap::new(),
        heaviest: None,
        is_weighed: false,
        part: None,
        functions: Vec::new(),
    };
    lowering.graph.reserve(system.name.to_string());
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
            let fields = function.fields().map(|(name, _)| Value::Written(Written::leaf(quote!(self.#name))));
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
    lowering.integers.settled()?;
    let bindings = lowering.bindings.into_values().collect();
    let (functions, heaviest) = (lowering.functions, lowering.heaviest);
    Ok(Lowered { graph: lowering.graph, n, m, lagrangian, rayleigh, force, functions, bindings, heaviest })
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
#[derive(Clone)]
struct Leaving {
    is_break: bool,
    label: Option<String>,
    value: Value,
}

/// The state of one symbolic run of a body.
struct Lowering<'s> {
    source: &'s Source,
    /// `f64` or `f32`.
    scalar: Ident,
    graph: Graph,
    /// Innermost last; a later one of the same name hides the earlier.
    locals: Vec<(String, Value)>,
    /// Locals before this index belong to the surroundings of a closure: it can read, but not change them.
    captured: usize,
    returned: Returned,
    leaving: Option<Leaving>,
    /// Conditions, and which way they were decided, under which the code being run is reached.
    guards: Vec<(Node, bool)>,
    depth: usize,
    evaluations: usize,
    integers: Classes,
    bindings: BTreeMap<String, Ident>,
    functions: Vec<Ident>,
    heaviest: Option<Load>,
    /// Whether a loop or call is running whose operations are counted.
    is_weighed: bool,
    /// The function being run, as it was called from outside.
    part: Option<Ident>,
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

    /// An integer constant of the annotated block, if its value can be computed here.
    fn block_constant(&mut self, name: &Ident) -> Option<Value> {
        let Source::Block(block) = self.source else { return None };
        let constant = block.item.items.iter().find_map(|item| match item {
            ImplItem::Const(constant) if constant.ident == *name => Some(constant),
            _ => None,
        })?;
        IntegerType::of(&constant.ty)?;
        let (expression, ty) = (constant.expr.clone(), constant.ty.clone());
        // No local is in scope there.
        let outside = self.enter(name, Vec::new()).ok()?;
        let value = self.expression(&expression);
        let is_known = value.is_ok();
        let value = self.leave(name, outside, value.unwrap_or(Value::Unset)).ok().filter(|_| is_known)?;
        match self.shaped(value, &ty) {
            Ok(value @ Value::Integer(_)) => Some(value),
            _ => None,
        }
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
        let is_lifetime = |parameter: &&GenericParam| matches!(parameter, GenericParam::Lifetime(_));
        if let Some(parameter) = signature.generics.params.iter().find(|parameter| !is_lifetime(parameter)) {
            return refuse(parameter, "a function that L, R or the force call cannot be generic here");
        }
        if !self.functions.contains(&signature.ident) {
            self.functions.push(signature.ident.clone());
        }
        if self.depth == 0 {
            self.part = Some(signature.ident.clone());
        }
        let outside = self.enter(at, Vec::new())?;
        for ((pattern, ty), argument) in parameters.iter().zip(arguments) {
            let argument = self.shaped(argument, ty)?;
            self.bind(pattern, argument)?;
        }
        match &signature.output {
            ReturnType::Type(_, ty) => {
                let result = self.block_of_type(body, ty)?;
                let result = self.leave(at, outside, result)?;
                self.shaped(result, ty)
            }
            ReturnType::Default => {
                let result = self.block(body)?;
                self.leave(at, outside, result)
            }
        }
    }

    /// Calls a closure, or a function handed on by its name.
    fn apply(&mut self, at: &impl ToTokens, function: &Value, arguments: Vec<Value>) -> Result<Value> {
        match function {
            Value::Closure(closure) => {
                if closure.parameters.len() != arguments.len() {
                    return refuse(at, "called with another number of arguments than it has parameters");
                }
                let mut now = arguments.clone();
                let outside = self.enter(at, closure.locals.clone())?;
                self.captured = self.locals.len();
                for (pattern, argument) in closure.parameters.iter().zip(arguments) {
                    self.bind(pattern, argument)?;
                }
                let result = match &closure.result {
                    Some(ty) => self.expression_of_type(&closure.body, ty)?,
                    None => self.expression(&closure.body)?,
                };
                let result = self.leave(at, outside, result)?;
                now.push(result.clone());
                if let Some(last) = closure.last.borrow().as_ref() {
                    last.iter().zip(&now).try_for_each(|(a, b)| self.unify_values(a, b))?;
                }
                closure.last.replace(Some(now));
                Ok(result)
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
                    Some(receiver) => self.value_method(name, receiver, arguments.collect(), None),
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
            guards: self.guards.len(),
        })
    }

    /// Ends a body; its value is what it returned on the way, or `tail`.
    fn leave(&mut self, at: &impl ToTokens, outside: Outside, tail: Value) -> Result<Value> {
        self.depth -= 1;
        self.locals = outside.locals;
        self.captured = outside.captured;
        self.leaving = outside.leaving;
        self.guards.truncate(outside.guards);
        match std::mem::replace(&mut self.returned, outside.returned) {
            Returned::Never => Ok(tail),
            Returned::Always(value) => Ok(value),
            Returned::Where(condition, value) => self.select(at, condition, value, tail),
        }
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
        let at_length = length;
        match self.expression(length)? {
            Value::Integer(length) if (0..=4096).contains(&length.value) => self.size(at_length, length),
            _ => refuse(
                length,
                "this length is not known here; write a literal, or a constant of the annotated block",
            ),
        }
    }

    /// The value with what its type says of it: an array's length, an integer's type.
    fn shaped(&mut self, value: Value, ty: &Type) -> Result<Value> {
        match (value, ty) {
            (value, Type::Reference(reference)) => self.shaped(value, &reference.elem),
            (value, Type::Paren(inner)) => self.shaped(value, &inner.elem),
            (value, Type::Group(inner)) => self.shaped(value, &inner.elem),
            (Value::Integer(integer), ty) => {
                match (IntegerType::of(ty), ty) {
                    (Some(ty), _) => self.of_type(integer.class, ty)?,
                    (None, Type::Infer(_)) => {}
                    // An alias.
                    (None, _) => self.beside_field(integer),
                }
                Ok(Value::Integer(integer))
            }
            (Value::Real(node), ty) if is_of_scalar(ty, &self.scalar) => Ok(Value::Real(node)),
            (Value::Real(_), ty) => refuse(
                ty,
                format!("this system is written in `{}`; write the type out, an alias hides it", self.scalar),
            ),
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
            (Value::Sequence(entries), Type::Array(ty)) => entries
                .into_iter()
                .map(|entry| self.shaped(entry, &ty.elem))
                .collect::<Result<_>>()
                .map(Value::Sequence),
            (Value::Sequence(entries), Type::Slice(ty)) => entries
                .into_iter()
                .map(|entry| self.shaped(entry, &ty.elem))
                .collect::<Result<_>>()
                .map(Value::Sequence),
            (Value::Tuple(entries), Type::Tuple(ty)) if entries.len() == ty.elems.len() => {
                let entries = entries.into_iter().zip(&ty.elems);
                entries.map(|(entry, ty)| self.shaped(entry, ty)).collect::<Result<_>>().map(Value::Tuple)
            }
            (Value::Chosen(chosen), ty) => {
                let a = self.shaped(chosen.a.clone(), ty)?;
                let b = self.shaped(chosen.b.clone(), ty)?;
                Ok(Value::Chosen(Rc::new(Chosen {
                    condition: chosen.condition,
                    a,
                    b,
                    name: chosen.name.clone(),
                })))
            }
            // What is left of a block that has returned.
            (Value::Tuple(entries), _) if entries.is_empty() => Ok(Value::unit()),
            (Value::Sequence(_) | Value::Tuple(_), Type::Path(_) | Type::Macro(_)) => {
                refuse(ty, "write the type out, such as `[f64; 2]`: an alias hides it")
            }
            (value, _) => Ok(value),
        }
    }

    /// The value as a number.
    fn scalar(&mut self, at: &impl ToTokens, value: Value) -> Result<Node> {
        match value {
            Value::Real(node) => Ok(node),
            Value::Written(written) => self.written_scalar(at, &written),
            Value::Chosen(chosen) => {
                let Chosen { condition, a, b, name } = &*chosen;
                let a = self.under(*condition, true, |this| this.scalar(at, a.clone()))?;
                let b = self.under(*condition, false, |this| this.scalar(at, b.clone()))?;
                let node = self.graph.select(*condition, a, b);
                if let Some(name) = name {
                    self.graph.give_name(node, name);
                }
                Ok(node)
            }
            Value::Integer(_) => refuse(at, "an integer stands where a floating-point number is needed"),
            Value::Unset => {
                refuse(at, "this local has no value on every way here; give it one where it is declared")
            }
            _ => refuse(at, "this is not a single number; take the entries of an array one by one"),
        }
    }

    /// The value as a condition.
    fn truth(&mut self, at: &impl ToTokens, value: Value) -> Result<Truth> {
        match value {
            Value::Truth(truth) => Ok(truth),
            Value::Written(written) => self.written_truth(at, &written).map(Truth::Where),
            Value::Chosen(chosen) => {
                let Chosen { condition, a, b, .. } = &*chosen;
                let a = self.under(*condition, true, |this| this.truth(at, a.clone()))?;
                let b = self.under(*condition, false, |this| this.truth(at, b.clone()))?;
                match self.select(at, *condition, Value::Truth(a), Value::Truth(b))? {
                    Value::Truth(truth) => Ok(truth),
                    _ => refuse(at, "this is not a condition that can be followed here"),
                }
            }
            _ => refuse(at, "this is not a condition that can be followed here"),
        }
    }

    /// Runs what is reached where the condition is `way`.
    fn under<T>(
        &mut self,
        condition: Node,
        way: bool,
        run: impl FnOnce(&mut Self) -> Result<T>,
    ) -> Result<T> {
        let outside = self.guards.len();
        self.guards.push((condition, way));
        let value = run(self);
        self.guards.truncate(outside);
        value
    }

    /// The condition under which the code being run is reached, if it is one.
    fn guard(&mut self) -> Option<Node> {
        let mut guard = Truth::Known(true);
        for (node, way) in self.guards.clone() {
            let condition = Truth::Where(node);
            let condition = if way { condition } else { condition.not(&mut self.graph) };
            guard = guard.and(&mut self.graph, condition);
        }
        match guard {
            Truth::Where(node) => Some(node),
            Truth::Known(_) => None,
        }
    }

    /// The expression as it is written out.
    fn text(&mut self, at: &impl ToTokens, written: &Written) -> Result<Text> {
        written.text().or_else(|Clash(name)| {
            refuse(
                at,
                format!("two patterns bind `{name}`, and this needs both; give one of them another name"),
            )
        })
    }

    /// `a` where the condition holds, else `b`.
    fn select(&mut self, at: &impl ToTokens, condition: Node, a: Value, b: Value) -> Result<Value> {
        if a.same(&b) {
            return Ok(a);
        }
        self.unify_values(&a, &b)?;
        match (a, b) {
            (Value::Truth(a), Value::Truth(b)) => {
                let positive = a.and(&mut self.graph, Truth::Where(condition));
                let negated = Truth::Where(condition).not(&mut self.graph);
                let negative = b.and(&mut self.graph, negated);
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
            (Value::Integer(a), Value::Integer(b)) if a.value == b.value => Ok(Value::Integer(a)),
            // Integers, or fields that may be.
            (
                a @ (Value::Integer(_) | Value::Written(_) | Value::Chosen(_)),
                b @ (Value::Integer(_) | Value::Written(_) | Value::Chosen(_)),
            ) => Ok(Value::Chosen(Rc::new(Chosen { condition, a, b, name: None }))),
            (Value::Unset, _) | (_, Value::Unset) => Ok(Value::Unset),
            (a, b) => {
                let a = self.under(condition, true, |this| this.scalar(at, a))?;
                let b = self.under(condition, false, |this| this.scalar(at, b))?;
                Ok(Value::Real(self.graph.select(condition, a, b)))
            }
        }
    }

    /// What an operation makes of either of the two that a value may be.
    fn distribute(
        &mut self,
        at: &impl ToTokens,
        chosen: &Chosen,
        mut run: impl FnMut(&mut Self, Value) -> Result<Value>,
    ) -> Result<Value> {
        self.count(at)?;
        let a = self.under(chosen.condition, true, |this| run(this, chosen.a.clone()))?;
        let b = self.under(chosen.condition, false, |this| run(this, chosen.b.clone()))?;
        self.select(at, chosen.condition, a, b)
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

    fn is_too_long(&self) -> bool {
        self.evaluations > MAX_EVALUATIONS || self.graph.len() > MAX_NODES
    }

    /// Counts work, so that no loop runs without end.
    fn count(&mut self, at: &impl ToTokens) -> Result<()> {
        self.evaluations += 1;
        if self.is_too_long() {
            return refuse(at, "the loops, written out, are too long for straight-line code");
        }
        Ok(())
    }

    fn closure(&self, closure: &syn::ExprClosure) -> Value {
        Value::Closure(Rc::new(Closure {
            parameters: closure.inputs.iter().cloned().collect(),
            result: match &closure.output {
                ReturnType::Type(_, ty) => Some((**ty).clone()),
                ReturnType::Default => None,
            },
            body: (*closure.body).clone(),
            locals: self.locals.clone(),
            last: RefCell::new(None),
        }))
    }
}

/// Whether a floating-point number of the body can have this type.
fn is_of_scalar(ty: &Type, scalar: &Ident) -> bool {
    matches!(ty, Type::Infer(_) | Type::ImplTrait(_)) || simple_name(ty).is_some_and(|name| name == scalar)
}

/// What surrounds a body that is called.
struct Outside {
    locals: Vec<(String, Value)>,
    captured: usize,
    returned: Returned,
    leaving: Option<Leaving>,
    guards: usize,
}

/// The tokens of a field with an index or member behind it.
fn indexed(base: &TokenStream, index: usize) -> TokenStream {
    let index = syn::Index::from(index);
    quote!(#base[#index])
}
