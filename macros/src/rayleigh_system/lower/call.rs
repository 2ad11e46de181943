//! Calls: functions of the annotated block and closures, run with their arguments.

use std::cell::RefCell;
use std::rc::Rc;

use quote::ToTokens;
use syn::{Block, FnArg, GenericParam, Ident, ImplItem, ImplItemFn, Pat, ReturnType, Type};

use super::super::model::Source;
use super::class::IntegerType;
use super::value::{Closure, Value};
use super::{Leaving, Lowering, Result, Returned, refuse};

/// Calls within calls.
const MAX_DEPTH: usize = 64;

/// The state of the caller while a body that it calls is run.
struct Outside {
    locals: Vec<(String, Value)>,
    captured: usize,
    returned: Returned,
    leaving: Option<Leaving>,
    guards: usize,
}

impl Lowering<'_> {
    /// A function of the annotated block.
    pub fn function(&self, name: &Ident) -> Option<&'_ ImplItemFn> {
        self.source.functions().find(|function| function.sig.ident == *name)
    }

    /// An integer constant of the annotated block, if its value can be computed here.
    pub fn block_constant(&mut self, name: &Ident) -> Option<Value> {
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
    pub fn call(
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
    pub fn apply(&mut self, at: &impl ToTokens, function: &Value, arguments: Vec<Value>) -> Result<Value> {
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

    pub fn closure(&self, closure: &syn::ExprClosure) -> Value {
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
