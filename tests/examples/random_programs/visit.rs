//! Every block and expression of a program, for the shrinker.

use super::syntax::*;

/// What is done to each; blocks before what they hold, expressions after.
pub trait Visitor {
    fn block(&mut self, block: &mut Block);
    fn expression(&mut self, expression: &mut Expression);
}

pub fn program(program: &mut Program, visitor: &mut dyn Visitor) {
    block(&mut program.lagrangian, visitor);
    if let Some((_, body)) = &mut program.rayleigh {
        block(body, visitor);
    }
    if let Some(body) = &mut program.force {
        block(body, visitor);
    }
    for helper in &mut program.helpers {
        block(&mut helper.body, visitor);
    }
}

fn block(of: &mut Block, visitor: &mut dyn Visitor) {
    visitor.block(of);
    for inner in &mut of.statements {
        statement(inner, visitor);
    }
    if let Some(tail) = &mut of.tail {
        expression(tail, visitor);
    }
}

fn statement(of: &mut Statement, visitor: &mut dyn Visitor) {
    match of {
        Statement::Let { value, .. } => value.iter_mut().for_each(|value| expression(value, visitor)),
        Statement::LetElse { value, otherwise, .. } => {
            expression(value, visitor);
            block(otherwise, visitor);
        }
        Statement::LetClosure { closure, .. } => expression(&mut closure.body, visitor),
        Statement::LetIterator { chain: of, .. } => chain(of, visitor),
        Statement::Expression(inner) => expression(inner, visitor),
        Statement::For { chain: over, body, .. } => {
            chain(over, visitor);
            block(body, visitor);
        }
        Statement::While { condition, body, .. } => {
            expression(condition, visitor);
            block(body, visitor);
        }
        Statement::ConfiguredOut(_) => {}
    }
}

fn chain(of: &mut Chain, visitor: &mut dyn Visitor) {
    match &mut of.source {
        Source::Iter(array)
        | Source::IntoIter(array)
        | Source::Plain(array)
        | Source::Windows(array, _)
        | Source::Chunks(array, ..) => expression(array, visitor),
        Source::Range { start, end, .. } => {
            expression(start, visitor);
            expression(end, visitor);
        }
        Source::Local(_) | Source::ByReference(_) => {}
    }
    for adaptor in &mut of.adaptors {
        match adaptor {
            Adaptor::Map(handed) | Adaptor::Filter(handed) | Adaptor::FlatMap(handed) => {
                self::handed(handed, visitor);
            }
            Adaptor::Zip(other, _) | Adaptor::Linked(other) => chain(other, visitor),
            _ => {}
        }
    }
}

fn handed(of: &mut Handed, visitor: &mut dyn Visitor) {
    if let Handed::Closure(closure) = of {
        expression(&mut closure.body, visitor);
    }
}

fn expression(of: &mut Expression, visitor: &mut dyn Visitor) {
    match of {
        Expression::Member(inner, _)
        | Expression::Dereferenced(inner)
        | Expression::Borrowed(inner)
        | Expression::Negated(_, inner)
        | Expression::Not(_, inner)
        | Expression::Cast { value: inner, .. }
        | Expression::Converted { value: inner, .. }
        | Expression::Repeated(inner, _)
        | Expression::Optional(Some(inner))
        | Expression::Return(inner)
        | Expression::Break(_, Some(inner)) => expression(inner, visitor),
        Expression::Index(a, b)
        | Expression::Arithmetic(_, _, a, b)
        | Expression::Comparison(_, _, a, b)
        | Expression::Both(a, b)
        | Expression::Either(a, b)
        | Expression::Power(a, b)
        | Expression::UnwrapOr(a, b)
        | Expression::Assign(a, b)
        | Expression::Compound(_, _, a, b) => {
            expression(a, visitor);
            expression(b, visitor);
        }
        Expression::Function { arguments, .. }
        | Expression::IntegerMethod { arguments, .. }
        | Expression::Array(arguments)
        | Expression::Tuple(arguments)
        | Expression::Variant { data: arguments, .. }
        | Expression::Structure { values: arguments, .. }
        | Expression::Call { arguments, .. }
        | Expression::Apply(_, arguments) => {
            arguments.iter_mut().for_each(|argument| expression(argument, visitor));
        }
        Expression::Block(_, body) | Expression::Loop(_, body) => block(body, visitor),
        Expression::If(condition, then, otherwise) | Expression::IfLet(_, condition, then, otherwise) => {
            expression(condition, visitor);
            block(then, visitor);
            otherwise.iter_mut().for_each(|otherwise| block(otherwise, visitor));
        }
        Expression::Match(value, arms) => {
            expression(value, visitor);
            for arm in arms {
                arm.guard.iter_mut().for_each(|guard| expression(guard, visitor));
                expression(&mut arm.body, visitor);
            }
        }
        Expression::Matches(value, _, guard) => {
            expression(value, visitor);
            guard.iter_mut().for_each(|guard| expression(guard, visitor));
        }
        Expression::Mapped(value, closure) | Expression::OptionMap(value, closure) => {
            expression(value, visitor);
            expression(&mut closure.body, visitor);
        }
        Expression::MapOr(value, default, closure) => {
            expression(value, visitor);
            expression(default, visitor);
            expression(&mut closure.body, visitor);
        }
        Expression::FromFunction(closure, _) => expression(&mut closure.body, visitor),
        Expression::Chain(over, consumer) => {
            chain(over, visitor);
            if let Consumer::Fold(start, closure) = consumer {
                expression(start, visitor);
                handed(closure, visitor);
            }
        }
        Expression::Real { .. }
        | Expression::Single(_)
        | Expression::Integer { .. }
        | Expression::Bool(_)
        | Expression::Name(_)
        | Expression::System
        | Expression::Constant(_)
        | Expression::Optional(None)
        | Expression::Break(_, None)
        | Expression::Continue(_) => {}
    }
    visitor.expression(of);
}
