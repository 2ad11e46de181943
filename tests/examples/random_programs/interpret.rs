//! Programs run over any [`Number`], with Rust's semantics: written from the reference, not from the macro,
//! and held to rustc's own plain function to the bit.

mod integer;
mod iterator;
mod matching;

use std::cell::RefCell;
use std::rc::Rc;

use super::number::Number;
use super::syntax::*;
use iterator::Iteration;

/// Expressions evaluated before a program is given up.
const FUEL: usize = 30_000;

/// A value.
#[derive(Clone)]
pub enum Value<S> {
    Real(S),
    Single(f32),
    Bool(bool),
    Integer(i128),
    /// Arrays, slices, tuples, structs.
    Entries(Vec<Value<S>>),
    /// Options (0: `None`, 1: `Some`) and enums.
    Variant(usize, Vec<Value<S>>),
    Closure(Rc<Closed<S>>),
    Iterator(Rc<RefCell<Iteration<S>>>),
}

/// A closure and what it captured.
pub struct Closed<S> {
    closure: Closure,
    scope: Scope<S>,
}

type Scope<S> = Vec<(String, Rc<RefCell<Value<S>>>)>;

/// Why an evaluation does not go on.
#[derive(Clone)]
pub enum Exit<S> {
    Break(Option<String>, Value<S>),
    Continue(Option<String>),
    Return(Value<S>),
    /// The plain function would panic, or run for too long.
    Panic(&'static str),
}

pub type Result<S, T = Value<S>> = std::result::Result<T, Exit<S>>;

/// L, R and f at a point.
pub struct Evaluated<S> {
    pub lagrangian: S,
    pub rayleigh: Option<S>,
    pub force: Option<Vec<S>>,
}

/// One run.
pub struct Interpreter<'p, S> {
    program: &'p Program,
    constants: Vec<Value<S>>,
    system: Value<S>,
    scope: Scope<S>,
    fuel: usize,
    depth: usize,
    /// Largest size met.
    pub size: f64,
    /// About how far (q, v) is from the nearest branch or kink.
    pub distance: f64,
}

impl<S> Value<S> {
    pub const UNIT: Self = Self::Entries(Vec::new());
}

impl<S: Number> Value<S> {
    pub fn real(self) -> S {
        match self {
            Self::Real(x) => x,
            _ => unreachable!("programs are well typed"),
        }
    }

    fn integer(self) -> i128 {
        match self {
            Self::Integer(x) => x,
            _ => unreachable!("programs are well typed"),
        }
    }

    fn truth(self) -> bool {
        match self {
            Self::Bool(x) => x,
            _ => unreachable!("programs are well typed"),
        }
    }

    fn entries(self) -> Vec<Self> {
        match self {
            Self::Entries(entries) => entries,
            _ => unreachable!("programs are well typed"),
        }
    }
}

impl<'p, S: Number> Interpreter<'p, S> {
    /// The program with its constants and fields evaluated.
    pub fn new(program: &'p Program) -> Result<S, Self> {
        let mut this = Self {
            program,
            constants: Vec::new(),
            system: Value::UNIT,
            scope: Vec::new(),
            fuel: FUEL,
            depth: 0,
            size: 0.0,
            distance: f64::INFINITY,
        };
        for constant in &program.constants {
            let value = this.expression(&constant.value)?;
            this.constants.push(value);
        }
        let fields: Result<S, Vec<_>> =
            program.fields.iter().map(|(.., value)| this.expression(value)).collect();
        this.system = Value::Entries(fields?);
        Ok(this)
    }

    /// The values of the fields, and of the constants.
    pub fn known(&self) -> (&Value<S>, &[Value<S>]) {
        (&self.system, &self.constants)
    }

    /// L, R and f at (q, v), with the input and the time.
    pub fn evaluate(&mut self, [q, v, u]: [&[S]; 3], t: S) -> Result<S, Evaluated<S>> {
        let array = |x: &[S]| Value::Entries(x.iter().copied().map(Value::Real).collect());
        let program = self.program;
        let both = [("q", array(q)), ("v", array(v))];
        let timed = |part: usize, given: &[(&'static str, Value<S>)]| {
            let time = program.timed[part].then_some(("t", Value::Real(t)));
            given.iter().cloned().chain(time).collect::<Vec<_>>()
        };
        let lagrangian = self.body(&program.lagrangian, &timed(0, &both))?.real();
        let rayleigh = match &program.rayleigh {
            None => None,
            Some((of_both, body)) => Some(self.body(body, &timed(1, &both[usize::from(!of_both)..]))?.real()),
        };
        let force = match &program.force {
            None => None,
            Some(body) => {
                let input = (program.inputs > 0).then(|| ("u", array(u)));
                let given: Vec<_> = both.iter().cloned().chain(input).collect();
                Some(self.body(body, &timed(2, &given))?.entries().into_iter().map(Value::real).collect())
            }
        };
        Ok(Evaluated { lagrangian, rayleigh, force })
    }

    fn body(&mut self, body: &'p Block, parameters: &[(&str, Value<S>)]) -> Result<S> {
        let scope = parameters.iter().map(|(name, value)| (*name, value.clone())).collect();
        self.function(body, scope)
    }

    fn function(&mut self, body: &Block, parameters: Vec<(&str, Value<S>)>) -> Result<S> {
        self.depth += 1;
        if self.depth > 40 {
            return Err(Exit::Panic("calls without end"));
        }
        let parameters =
            parameters.into_iter().map(|(name, value)| (name.to_owned(), Rc::new(RefCell::new(value))));
        let outside = std::mem::replace(&mut self.scope, parameters.collect());
        let result = match self.block(body) {
            Err(Exit::Return(value)) => Ok(value),
            other => other,
        };
        self.scope = outside;
        self.depth -= 1;
        result
    }

    fn declare(&mut self, name: &str, value: Value<S>) {
        self.scope.push((name.to_owned(), Rc::new(RefCell::new(value))));
    }

    fn slot(&self, name: &str) -> Rc<RefCell<Value<S>>> {
        let found = self.scope.iter().rev().find(|(known, _)| known == name);
        found.map(|(_, slot)| slot.clone()).unwrap_or_else(|| unreachable!("`{name}` is in scope"))
    }

    fn real(&mut self, x: S) -> Result<S> {
        let size = x.size();
        // A size that is no number is one that says nothing.
        self.size = if size.is_nan() { f64::INFINITY } else { self.size.max(size) };
        Ok(Value::Real(x))
    }

    fn near(&mut self, a: S, b: S) {
        self.distance = self.distance.min(a.distance(b));
    }

    fn many(&mut self, expressions: &[Expression]) -> Result<S, Vec<Value<S>>> {
        expressions.iter().map(|expression| self.expression(expression)).collect()
    }

    pub fn block(&mut self, block: &Block) -> Result<S> {
        let outside = self.scope.len();
        let result = self.statements(block);
        self.scope.truncate(outside);
        result
    }

    fn statements(&mut self, block: &Block) -> Result<S> {
        for statement in &block.statements {
            self.statement(statement)?;
        }
        match &block.tail {
            Some(tail) => self.expression(tail),
            None => Ok(Value::UNIT),
        }
    }

    fn statement(&mut self, statement: &Statement) -> Result<S, ()> {
        match statement {
            Statement::Let { pattern, value, .. } => match (value, pattern) {
                (Some(value), pattern) => {
                    let value = self.expression(value)?;
                    self.matches(pattern, &value);
                }
                (None, Pattern::Name { name, .. }) => self.declare(name, Value::UNIT),
                (None, _) => {}
            },
            Statement::LetElse { pattern, value, otherwise } => {
                let value = self.expression(value)?;
                let outside = self.scope.len();
                if !self.matches(pattern, &value) {
                    // What was bound before the pattern failed is not seen.
                    self.scope.truncate(outside);
                    self.block(otherwise)?;
                }
            }
            Statement::LetClosure { name, closure, .. } => {
                let value = self.closed(closure);
                self.declare(name, value);
            }
            Statement::LetIterator { name, chain } => {
                let iteration = self.chain(chain)?;
                self.declare(name, Value::Iterator(Rc::new(RefCell::new(iteration))));
            }
            Statement::Expression(expression) => {
                self.expression(expression)?;
            }
            Statement::For { label, pattern, chain, body } => {
                let mut iteration = self.chain(chain)?;
                while let Some(item) = iteration.next(self)? {
                    let outside = self.scope.len();
                    self.matches(pattern, &item);
                    let turn = self.block(body);
                    self.scope.truncate(outside);
                    if left(turn, label)?.is_some() {
                        break;
                    }
                }
            }
            Statement::While { label, condition, body } => {
                while self.expression(condition)?.truth() {
                    let turn = self.block(body);
                    if left(turn, label)?.is_some() {
                        break;
                    }
                }
            }
            Statement::ConfiguredOut(_) => {}
        }
        Ok(())
    }

    fn closed(&self, closure: &Closure) -> Value<S> {
        let scope = if closure.moves {
            let copied = |(name, slot): &(String, Rc<RefCell<Value<S>>>)| {
                (name.clone(), Rc::new(RefCell::new(slot.borrow().clone())))
            };
            self.scope.iter().map(copied).collect()
        } else {
            self.scope.clone()
        };
        Value::Closure(Rc::new(Closed { closure: closure.clone(), scope }))
    }

    fn handed(&self, handed: &Handed) -> Value<S> {
        match handed {
            Handed::Closure(closure) => self.closed(closure),
            // A closure that calls it.
            Handed::Method(_) | Handed::Helper(_) => {
                let argument = Expression::Name("x".to_owned());
                let body = match handed {
                    Handed::Method(name) => {
                        Expression::Function { name, arguments: vec![argument], as_path: true }
                    }
                    Handed::Helper(helper) => Expression::Call { helper: *helper, arguments: vec![argument] },
                    Handed::Closure(_) => argument,
                };
                let parameter = Pattern::Name { name: "x".to_owned(), mutable: false };
                self.closed(&Closure { parameters: vec![(parameter, None)], body, moves: false })
            }
        }
    }

    pub fn apply(&mut self, closure: &Value<S>, arguments: Vec<Value<S>>) -> Result<S> {
        let Value::Closure(closed) = closure else { unreachable!("programs are well typed") };
        self.depth += 1;
        if self.depth > 40 {
            return Err(Exit::Panic("calls without end"));
        }
        let outside = std::mem::replace(&mut self.scope, closed.scope.clone());
        for ((pattern, _), argument) in closed.closure.parameters.iter().zip(arguments) {
            self.matches(pattern, &argument);
        }
        let result = match self.expression(&closed.closure.body) {
            Err(Exit::Return(value)) => Ok(value),
            other => other,
        };
        self.scope = outside;
        self.depth -= 1;
        result
    }

    pub fn expression(&mut self, expression: &Expression) -> Result<S> {
        self.fuel = self.fuel.checked_sub(1).ok_or(Exit::Panic("too long"))?;
        Ok(match expression {
            Expression::Real { value, .. } => {
                let value = if self.program.single { f64::from(*value as f32) } else { *value };
                return self.real(S::constant(value));
            }
            Expression::Single(value) => Value::Single(*value),
            Expression::Integer { value, .. } => Value::Integer(*value),
            Expression::Bool(truth) => Value::Bool(*truth),
            Expression::Name(name) => self.slot(name).borrow().clone(),
            Expression::System => self.system.clone(),
            Expression::Member(base, member) => {
                let (Member::Named(_, index) | Member::Numbered(index)) = member;
                self.expression(base)?.entries().swap_remove(*index)
            }
            Expression::Index(base, index) => {
                // A place is read when all its indices are known.
                if root(expression).is_some() {
                    let mut steps = Vec::new();
                    let name = self.steps(expression, &mut steps)?;
                    let mut value = self.slot(&name).borrow().clone();
                    for step in steps {
                        let entry = value.entries().into_iter().nth(step);
                        value = entry.ok_or(Exit::Panic("an index out of bounds"))?;
                    }
                    return Ok(value);
                }
                let (base, index) = (self.expression(base)?, self.expression(index)?.integer());
                let entry =
                    usize::try_from(index).ok().and_then(|index| base.entries().into_iter().nth(index));
                entry.ok_or(Exit::Panic("an index out of bounds"))?
            }
            Expression::Constant(index) => self.constants[*index].clone(),
            Expression::Dereferenced(inner) | Expression::Borrowed(inner) => self.expression(inner)?,
            Expression::Negated(kind, inner) => match (kind, self.expression(inner)?) {
                (_, Value::Real(x)) => return self.real(x.negated()),
                (_, Value::Single(x)) => Value::Single(-x),
                (Kind::Integer(ty), Value::Integer(x)) => Value::Integer(
                    x.checked_neg().filter(|x| ty.holds(*x)).ok_or(Exit::Panic("an overflow"))?,
                ),
                _ => unreachable!("programs are well typed"),
            },
            Expression::Not(kind, inner) => match (kind, self.expression(inner)?) {
                (_, Value::Bool(x)) => Value::Bool(!x),
                (Kind::Integer(ty), Value::Integer(x)) => {
                    Value::Integer(ty.wrapped(!x).ok_or(Exit::Panic("beyond an i128"))?)
                }
                _ => unreachable!("programs are well typed"),
            },
            Expression::Arithmetic(operator, kind, a, b) => {
                let (a, b) = (self.expression(a)?, self.expression(b)?);
                return self.operate(*operator, *kind, a, b);
            }
            Expression::Comparison(relation, _, a, b) => {
                let (a, b) = (self.expression(a)?, self.expression(b)?);
                Value::Bool(self.compare(*relation, &a, &b))
            }
            Expression::Both(a, b) => Value::Bool(self.expression(a)?.truth() && self.expression(b)?.truth()),
            Expression::Either(a, b) => {
                Value::Bool(self.expression(a)?.truth() || self.expression(b)?.truth())
            }
            Expression::Function { name, arguments, .. } => {
                let arguments = self.many(arguments)?.into_iter().map(Value::real).collect::<Vec<_>>();
                return self.method(name, &arguments);
            }
            Expression::Power(x, n) => {
                let (x, n) = (self.expression(x)?.real(), self.expression(n)?.integer());
                return self.real(x.powi(n as i32));
            }
            Expression::IntegerMethod { name, ty, arguments, .. } => {
                let arguments = self.many(arguments)?.into_iter().map(Value::integer).collect::<Vec<_>>();
                integer::method(name, *ty, &arguments)?
            }
            Expression::Cast { value, to, .. } => {
                let value = self.expression(value)?;
                self.cast(value, *to)?
            }
            Expression::Converted { value, .. } => {
                let value = self.expression(value)?;
                self.cast(value, Kind::Real)?
            }
            Expression::Array(entries)
            | Expression::Tuple(entries)
            | Expression::Structure { values: entries, .. } => Value::Entries(self.many(entries)?),
            Expression::Repeated(entry, length) => Value::Entries(vec![self.expression(entry)?; *length]),
            Expression::Optional(None) => Value::Variant(0, Vec::new()),
            Expression::Optional(Some(inner)) => Value::Variant(1, vec![self.expression(inner)?]),
            Expression::Variant { variant, data, .. } => Value::Variant(*variant, self.many(data)?),
            Expression::Call { helper, arguments } => {
                let arguments = self.many(arguments)?;
                let helper = &self.program.helpers[*helper];
                let names = helper.parameters.iter().map(|(name, ..)| name.as_str());
                return self.function(&helper.body, names.zip(arguments).collect());
            }
            Expression::Apply(name, arguments) => {
                let arguments = self.many(arguments)?;
                let closure = self.slot(name).borrow().clone();
                return self.apply(&closure, arguments);
            }
            Expression::Block(label, block) => {
                let result = self.block(block);
                match (label, result) {
                    (Some(label), Err(Exit::Break(Some(to), value))) if *label == to => value,
                    (_, result) => return result,
                }
            }
            Expression::If(condition, then, otherwise) => {
                if self.expression(condition)?.truth() {
                    return self.block(then);
                }
                return otherwise.as_ref().map_or(Ok(Value::UNIT), |otherwise| self.block(otherwise));
            }
            Expression::IfLet(pattern, value, then, otherwise) => {
                let value = self.expression(value)?;
                let outside = self.scope.len();
                if self.matches(pattern, &value) {
                    let result = self.block(then);
                    self.scope.truncate(outside);
                    return result;
                }
                self.scope.truncate(outside);
                return otherwise.as_ref().map_or(Ok(Value::UNIT), |otherwise| self.block(otherwise));
            }
            Expression::Match(value, arms) => {
                let value = self.expression(value)?;
                for arm in arms {
                    let outside = self.scope.len();
                    let is_taken = self.matches(&arm.pattern, &value)
                        && match &arm.guard {
                            Some(guard) => self.expression(guard)?.truth(),
                            None => true,
                        };
                    let result = is_taken.then(|| self.expression(&arm.body));
                    self.scope.truncate(outside);
                    if let Some(result) = result {
                        return result;
                    }
                }
                unreachable!("the last arm matches everything")
            }
            Expression::Matches(value, pattern, guard) => {
                let value = self.expression(value)?;
                let outside = self.scope.len();
                let matches = self.matches(pattern, &value)
                    && match guard {
                        Some(guard) => self.expression(guard)?.truth(),
                        None => true,
                    };
                self.scope.truncate(outside);
                Value::Bool(matches)
            }
            Expression::Loop(label, body) => loop {
                let turn = self.block(body);
                if let Some(value) = left(turn, label)? {
                    return Ok(value);
                }
            },
            Expression::Mapped(array, closure) => {
                let entries = self.expression(array)?.entries();
                let closure = self.closed(closure);
                let mapped: Result<S, _> =
                    entries.into_iter().map(|entry| self.apply(&closure, vec![entry])).collect();
                Value::Entries(mapped?)
            }
            Expression::FromFunction(closure, length) => {
                let closure = self.closed(closure);
                let entries: Result<S, _> =
                    (0..*length).map(|i| self.apply(&closure, vec![Value::Integer(i as i128)])).collect();
                Value::Entries(entries?)
            }
            Expression::Chain(chain, consumer) => {
                let iteration = self.chain(chain)?;
                return self.consume(iteration, consumer);
            }
            Expression::OptionMap(value, closure) => match self.expression(value)? {
                Value::Variant(1, data) => {
                    let closure = self.closed(closure);
                    Value::Variant(1, vec![self.apply(&closure, data)?])
                }
                none => none,
            },
            Expression::UnwrapOr(value, default) => {
                let (value, default) = (self.expression(value)?, self.expression(default)?);
                match value {
                    Value::Variant(1, mut data) => data.remove(0),
                    _ => default,
                }
            }
            Expression::MapOr(value, default, closure) => {
                let (value, default) = (self.expression(value)?, self.expression(default)?);
                match value {
                    Value::Variant(1, data) => {
                        let closure = self.closed(closure);
                        self.apply(&closure, data)?
                    }
                    _ => default,
                }
            }
            Expression::Break(label, value) => {
                let value = value.as_ref().map_or(Ok(Value::UNIT), |value| self.expression(value))?;
                return Err(Exit::Break(label.clone(), value));
            }
            Expression::Continue(label) => return Err(Exit::Continue(label.clone())),
            Expression::Return(value) => {
                let value = self.expression(value)?;
                return Err(Exit::Return(value));
            }
            Expression::Assign(place, value) => {
                let value = self.expression(value)?;
                self.change(place, |_, old| {
                    *old = value;
                    Ok(())
                })?;
                Value::UNIT
            }
            Expression::Compound(operator, kind, place, value) => {
                // Of primitive types the right side comes first.
                let value = self.expression(value)?;
                self.change(place, |this, old| {
                    *old = this.operate(*operator, *kind, old.clone(), value)?;
                    Ok(())
                })?;
                Value::UNIT
            }
        })
    }

    /// Changes a place, whose indices are evaluated here.
    fn change(
        &mut self,
        place: &Expression,
        by: impl FnOnce(&mut Self, &mut Value<S>) -> Result<S, ()>,
    ) -> Result<S, ()> {
        let mut steps = Vec::new();
        let name = self.steps(place, &mut steps)?;
        let slot = self.slot(&name);
        let mut target = slot.borrow().clone();
        let mut entry = &mut target;
        for step in steps {
            entry = match entry {
                Value::Entries(entries) => {
                    entries.get_mut(step).ok_or(Exit::Panic("an index out of bounds"))?
                }
                _ => unreachable!("programs are well typed"),
            };
        }
        by(self, entry)?;
        *slot.borrow_mut() = target;
        Ok(())
    }

    fn steps(&mut self, place: &Expression, steps: &mut Vec<usize>) -> Result<S, String> {
        match place {
            Expression::Name(name) => Ok(name.clone()),
            Expression::Dereferenced(inner) => self.steps(inner, steps),
            Expression::Index(base, index) => {
                let name = self.steps(base, steps)?;
                let index = self.expression(index)?.integer();
                steps.push(usize::try_from(index).map_err(|_| Exit::Panic("an index out of bounds"))?);
                Ok(name)
            }
            Expression::Member(base, Member::Named(_, index) | Member::Numbered(index)) => {
                let name = self.steps(base, steps)?;
                steps.push(*index);
                Ok(name)
            }
            _ => unreachable!("the generator writes only places here"),
        }
    }

    pub fn operate(&mut self, operator: Operator, kind: Kind, a: Value<S>, b: Value<S>) -> Result<S> {
        Ok(match (kind, a, b) {
            (_, Value::Real(a), Value::Real(b)) => {
                return self.real(match operator {
                    Operator::Add => a.plus(b),
                    Operator::Subtract => a.minus(b),
                    Operator::Multiply => a.times(b),
                    Operator::Divide => a.over(b),
                    _ => unreachable!("programs are well typed"),
                });
            }
            (_, Value::Single(a), Value::Single(b)) => Value::Single(match operator {
                Operator::Add => a + b,
                Operator::Subtract => a - b,
                Operator::Multiply => a * b,
                Operator::Divide => a / b,
                _ => unreachable!("programs are well typed"),
            }),
            (_, Value::Bool(a), Value::Bool(b)) => Value::Bool(match operator {
                Operator::And => a & b,
                Operator::Or => a | b,
                Operator::Xor => a ^ b,
                _ => unreachable!("programs are well typed"),
            }),
            (Kind::Integer(ty), Value::Integer(a), Value::Integer(b)) => {
                integer::operate(operator, ty, a, b)?
            }
            _ => unreachable!("programs are well typed"),
        })
    }

    pub fn compare(&mut self, relation: Relation, a: &Value<S>, b: &Value<S>) -> bool {
        let (less, equal, greater) = match (a, b) {
            (Value::Real(a), Value::Real(b)) => {
                self.near(*a, *b);
                (a.less(*b), a.equal(*b), b.less(*a))
            }
            (Value::Single(a), Value::Single(b)) => (a < b, a == b, a > b),
            (Value::Integer(a), Value::Integer(b)) => (a < b, a == b, a > b),
            (Value::Bool(a), Value::Bool(b)) => (!a & b, a == b, a & !b),
            (a, b) => {
                let equal = self.same(a, b);
                (false, equal, false)
            }
        };
        match relation {
            Relation::Less => less,
            Relation::LessOrEqual => less || equal,
            Relation::Greater => greater,
            Relation::GreaterOrEqual => greater || equal,
            Relation::Equal => equal,
            Relation::NotEqual => !equal,
        }
    }

    fn method(&mut self, name: &str, arguments: &[S]) -> Result<S> {
        let zero = S::constant(0.0);
        let result = match (name, arguments) {
            ("mul_add", &[x, a, b]) => x.mul_add(a, b),
            ("clamp", &[x, low, high]) => {
                self.near(x, low);
                self.near(x, high);
                if high.less(low) {
                    return Err(Exit::Panic("clamp"));
                }
                if x.less(low) {
                    low
                } else if high.less(x) {
                    high
                } else {
                    x
                }
            }
            ("min" | "max", &[x, y]) => {
                self.near(x, y);
                x.pair(name, y)
            }
            ("copysign", &[x, y]) => {
                self.near(x, zero);
                self.near(y, zero);
                x.pair(name, y)
            }
            (_, &[x, y]) => x.pair(name, y),
            (_, &[x]) => {
                if ["abs", "signum", "cbrt", "sqrt"].contains(&name) {
                    self.near(x, zero);
                    // 0/v is 0 everywhere, and the root of it still has no derivative.
                    if x.value() == 0.0 {
                        self.distance = 0.0;
                    }
                }
                x.function(name)
            }
            _ => unreachable!("the generator writes no method `{name}`"),
        };
        self.real(result)
    }

    pub fn cast(&mut self, value: Value<S>, to: Kind) -> Result<S> {
        Ok(match (value, to) {
            (Value::Integer(x), Kind::Integer(ty)) => {
                Value::Integer(ty.wrapped(x).ok_or(Exit::Panic("beyond an i128"))?)
            }
            (Value::Bool(x), Kind::Integer(_)) => Value::Integer(i128::from(x)),
            // An f32 is rounded once.
            (Value::Integer(x), Kind::Real) if self.program.single => {
                Value::Real(S::constant(f64::from(x as f32)))
            }
            (Value::Integer(x), Kind::Real) => Value::Real(S::constant(x as f64)),
            (Value::Integer(x), Kind::Single) => Value::Single(x as f32),
            (Value::Single(x), Kind::Real) => Value::Real(S::constant(f64::from(x))),
            (Value::Single(x), Kind::Integer(ty)) => Value::Integer(integer::truncated(f64::from(x), ty)?),
            (Value::Single(x), Kind::Single) => Value::Single(x),
            (Value::Real(x), Kind::Real) => Value::Real(x),
            (Value::Real(x), Kind::Integer(ty)) => Value::Integer(integer::truncated(x.value(), ty)?),
            (Value::Real(x), Kind::Single) => Value::Single(x.value() as f32),
            _ => unreachable!("programs are well typed"),
        })
    }
}

/// The local that a place belongs to.
fn root(place: &Expression) -> Option<&str> {
    match place {
        Expression::Name(name) => Some(name),
        Expression::Index(base, _) | Expression::Member(base, _) | Expression::Dereferenced(base) => {
            root(base)
        }
        _ => None,
    }
}

/// What a turn of a loop does to it: nothing where it goes on, the value where it ends.
fn left<S>(turn: Result<S>, label: &Option<String>) -> Result<S, Option<Value<S>>> {
    let is_own = |to: &Option<String>| to.is_none() || to == label;
    match turn {
        Ok(_) => Ok(None),
        Err(Exit::Break(to, value)) if is_own(&to) => Ok(Some(value)),
        Err(Exit::Continue(to)) if is_own(&to) => Ok(None),
        Err(exit) => Err(exit),
    }
}
