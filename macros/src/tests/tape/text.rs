//! Text evaluated on numbers: expanded functions as rustc would run them, with one lane or one member.

use std::collections::HashMap;

use proc_macro2::TokenStream;
use quote::ToTokens;
use syn::{BinOp, Block, Expr, Lit, Member, Pat, Stmt, UnOp};

use crate::rayleigh_system::graph::interpret::stand_in;
use crate::rayleigh_system::graph::{Function, PairFunction};

/// A value of the text.
#[derive(Clone, Debug)]
pub enum Value {
    Number(f64),
    Truth(bool),
    Many(Vec<Value>),
}

use Value::{Many, Number, Truth};

impl Value {
    pub fn vector(entries: &[f64]) -> Self {
        Many(entries.iter().copied().map(Number).collect())
    }

    /// All numbers in it, in order.
    pub fn flat(&self) -> Vec<f64> {
        match self {
            Number(x) => vec![*x],
            Truth(truth) => vec![f64::from(u8::from(*truth))],
            Many(values) => values.iter().flat_map(Self::flat).collect(),
        }
    }

    pub fn number(&self) -> f64 {
        match self {
            Number(x) => *x,
            // As wrong texts have it.
            Truth(truth) => f64::from(u8::from(*truth)),
            Many(_) => panic!("{self:?} is no number"),
        }
    }

    pub fn is_true(&self) -> bool {
        match self {
            Truth(truth) => *truth,
            other => other.number() != 0.0,
        }
    }

    /// An entry of an array or a tuple.
    pub fn at(&self, index: usize) -> &Self {
        match self {
            Many(values) => &values[index],
            other => panic!("{other:?} has no entries"),
        }
    }
}

/// The names that text can read.
#[derive(Clone)]
pub struct Scope {
    pub names: HashMap<String, Value>,
    /// How many entries vectors and matrices have.
    pub sizes: [usize; 2],
}

/// Tokens without spaces, and fields of the system by one name wherever it is seen from.
fn key(tokens: &impl ToTokens) -> String {
    let text = tokens.to_token_stream().to_string().replace(' ', "");
    let seen = ["self.system.", "system.system.", "system."].iter().find_map(|from| text.strip_prefix(from));
    seen.map_or_else(|| text.clone(), |own| format!("self.{own}"))
}

impl Scope {
    pub fn block(&mut self, block: &Block) -> Value {
        let mut result = Many(Vec::new());
        for statement in &block.stmts {
            match statement {
                Stmt::Local(local) => {
                    let value = self.value(&local.init.as_ref().expect("a value").expr);
                    self.bind(&local.pat, value);
                }
                Stmt::Expr(expression, _) => result = self.value(expression),
                other => panic!("{}", other.to_token_stream()),
            }
        }
        result
    }

    fn bind(&mut self, pattern: &Pat, value: Value) {
        match (pattern, value) {
            (Pat::Ident(name), value) => {
                self.names.insert(name.ident.to_string(), value);
            }
            (Pat::Type(typed), value) => self.bind(&typed.pat, value),
            (Pat::Wild(_) | Pat::Rest(_), _) => {}
            (Pat::Tuple(tuple), Many(values)) => {
                tuple.elems.iter().zip(values).for_each(|(pattern, value)| self.bind(pattern, value));
            }
            (Pat::Slice(slice), Many(values)) => {
                slice.elems.iter().zip(values).for_each(|(pattern, value)| self.bind(pattern, value));
            }
            (pattern, value) => panic!("{} of {value:?}", pattern.to_token_stream()),
        }
    }

    /// The value of tokens.
    pub fn tokens(&self, tokens: TokenStream) -> Value {
        self.clone().value(&syn::parse2(tokens).expect("an expression"))
    }

    fn value(&mut self, expression: &Expr) -> Value {
        if let Expr::Path(_) | Expr::Field(_) = expression
            && let Some(value) = self.names.get(&key(expression))
        {
            return value.clone();
        }
        match expression {
            Expr::Lit(literal) => match &literal.lit {
                Lit::Float(x) => Number(x.base10_parse().expect("a number")),
                Lit::Int(x) => Number(x.base10_parse().expect("a number")),
                Lit::Bool(truth) => Truth(truth.value),
                other => panic!("{}", other.to_token_stream()),
            },
            Expr::Path(path) => {
                let name = path.path.segments.last().expect("a name").ident.to_string();
                match &*name {
                    "LN_2" => Number(std::f64::consts::LN_2),
                    "LOG2_E" => Number(std::f64::consts::LOG2_E),
                    "LOG10_E" => Number(std::f64::consts::LOG10_E),
                    "INFINITY" => Number(f64::INFINITY),
                    "NAN" => Number(f64::NAN),
                    // A characteristic, and systems that have one; parameters by which lanes start, with
                    // nothing from a sweep before.
                    "CAM" | "systems" | "segment" | "anchors" | "angles" | "reciprocals" => Many(Vec::new()),
                    name => panic!("{name} is not known"),
                }
            }
            Expr::Paren(inner) => self.value(&inner.expr),
            Expr::Group(inner) => self.value(&inner.expr),
            Expr::Reference(inner) => self.value(&inner.expr),
            Expr::Block(inner) => self.clone().block(&inner.block),
            Expr::Array(array) => Many(array.elems.iter().map(|entry| self.value(entry)).collect()),
            Expr::Tuple(tuple) => Many(tuple.elems.iter().map(|entry| self.value(entry)).collect()),
            Expr::Struct(value) => Many(value.fields.iter().map(|field| self.value(&field.expr)).collect()),
            Expr::Field(field) => match &field.member {
                Member::Unnamed(index) => self.value(&field.base).at(index.index as usize).clone(),
                Member::Named(_) => panic!("{} is not known", field.to_token_stream()),
            },
            Expr::Index(index) => {
                let at = self.value(&index.index).number() as usize;
                self.value(&index.expr).at(at).clone()
            }
            Expr::Unary(unary) => match (&unary.op, self.value(&unary.expr)) {
                (UnOp::Deref(_), value) => value,
                (UnOp::Neg(_), value) => Number(-value.number()),
                (_, value) => Truth(!value.is_true()),
            },
            Expr::If(chosen) => {
                if self.value(&chosen.cond).is_true() {
                    self.clone().block(&chosen.then_branch)
                } else {
                    self.value(&chosen.else_branch.as_ref().expect("another branch").1)
                }
            }
            Expr::Binary(binary) => {
                let (a, b) = (self.value(&binary.left), self.value(&binary.right));
                operation(&binary.op, &a, &b)
            }
            Expr::Call(call) => {
                let arguments: Vec<Value> =
                    call.args.iter().map(|argument| self.argument(argument)).collect();
                let path = key(&call.func);
                match (path.rsplit("::").next().expect("a name"), &arguments[..]) {
                    ("zeros", []) => {
                        let size = self.sizes[usize::from(path.starts_with("SMatrix"))];
                        Value::vector(&vec![0.0; size])
                    }
                    ("from" | "splat" | "of_each" | "Members", [value]) => value.clone(),
                    ("select", [mask, a, b]) => (if mask.is_true() { a } else { b }).clone(),
                    ("derivatives", [_, x]) => Value::vector(&stand_in(x.number())),
                    ("momenta", [_]) => self.names["momenta"].clone(),
                    (name, _) => panic!("{name} is not known"),
                }
            }
            Expr::MethodCall(call) => {
                let (name, own) = (call.method.to_string(), &call.receiver);
                if name == "on_each" {
                    // `q[0].on_each(&systems, |system, x| …)`
                    return Value::vector(&stand_in(self.value(own).number()));
                }
                let arguments: Vec<Value> =
                    call.args.iter().map(|argument| self.argument(argument)).collect();
                // `systems.map(|system| …)`, `angles[0].sin_cos(x)`, `reciprocals[0].of(x)`
                match (&*name, &arguments[..]) {
                    ("map", [value]) => value.clone(),
                    ("sin_cos", [x]) => Many(vec![Number(x.number().sin()), Number(x.number().cos())]),
                    ("of", [x]) => Number(1.0 / x.number()),
                    ("on", [_]) => Value::vector(&stand_in(self.value(own).number())),
                    _ => method(&name, &self.value(own), &arguments),
                }
            }
            other => panic!("{}", other.to_token_stream()),
        }
    }

    /// The value of an argument; of a closure that of its body.
    fn argument(&mut self, argument: &Expr) -> Value {
        match argument {
            Expr::Closure(closure) => self.value(&closure.body),
            argument => self.value(argument),
        }
    }
}

fn operation(operator: &BinOp, a: &Value, b: &Value) -> Value {
    match operator {
        BinOp::Add(_) => Number(a.number() + b.number()),
        BinOp::Sub(_) => Number(a.number() - b.number()),
        BinOp::Mul(_) => Number(a.number() * b.number()),
        BinOp::Div(_) => Number(a.number() / b.number()),
        BinOp::And(_) | BinOp::BitAnd(_) => Truth(a.is_true() && b.is_true()),
        BinOp::Or(_) | BinOp::BitOr(_) => Truth(a.is_true() || b.is_true()),
        BinOp::Lt(_) => Truth(a.number() < b.number()),
        BinOp::Le(_) => Truth(a.number() <= b.number()),
        BinOp::Gt(_) => Truth(a.number() > b.number()),
        BinOp::Ge(_) => Truth(a.number() >= b.number()),
        BinOp::Eq(_) => Truth(a.number() == b.number()),
        BinOp::Ne(_) => Truth(a.number() != b.number()),
        other => panic!("{}", other.to_token_stream()),
    }
}

fn method(name: &str, own: &Value, arguments: &[Value]) -> Value {
    let second = || arguments[0].number();
    match name {
        "branch_free" | "elementary" => own.clone(),
        "sin_cos" => Many(vec![Number(own.number().sin()), Number(own.number().cos())]),
        "select" => (if own.is_true() { &arguments[0] } else { &arguments[1] }).clone(),
        "less" => Truth(own.number() < second()),
        "less_or_equal" => Truth(own.number() <= second()),
        "equal" => Truth(own.number() == second()),
        "powi" => Number(own.number().powi(second() as i32)),
        "mul_add" => Number(own.number().mul_add(second(), arguments[1].number())),
        "is_nan" => Truth(own.number().is_nan()),
        name => Number(match (Function::named(name), PairFunction::named(name)) {
            (Some(function), _) => function.method()(own.number()),
            (_, Some(function)) => function.method()(own.number(), second()),
            _ => panic!("{name} is not known"),
        }),
    }
}
