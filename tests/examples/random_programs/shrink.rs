//! Failing programs cut down: statements dropped, expressions replaced by their parts, while they go on
//! failing.

use std::panic::{AssertUnwindSafe, catch_unwind};

use super::syntax::*;
use super::visit::{self, Visitor};

/// Attempts at most.
const ATTEMPTS: usize = 6000;

/// The smallest program found that still fails.
pub fn shrunk(program: &Program, fails: impl Fn(&Program) -> bool) -> Program {
    let mut smallest = program.clone();
    let mut attempts = 0;
    loop {
        let mut is_smaller = false;
        let mut edit = 0;
        while let Some(candidate) = edited(&smallest, edit) {
            attempts += 1;
            if attempts > ATTEMPTS {
                return smallest;
            }
            // What is cut may leave a name without its meaning: the interpreter then gives up.
            if catch_unwind(AssertUnwindSafe(|| fails(&candidate))).unwrap_or(false) {
                smallest = candidate;
                is_smaller = true;
            } else {
                edit += 1;
            }
        }
        if !is_smaller {
            return smallest;
        }
    }
}

/// Applies the edit of a number; nothing where there are fewer.
fn edited(program: &Program, number: usize) -> Option<Program> {
    let mut program = program.clone();
    let whole = [program.rayleigh.is_some(), program.force.is_some()];
    let mut left = number;
    for (index, present) in whole.into_iter().enumerate() {
        if present {
            if left == 0 {
                match index {
                    0 => {
                        program.rayleigh = None;
                        program.timed[1] = false;
                    }
                    _ => {
                        program.force = None;
                        (program.inputs, program.timed[2]) = (0, false);
                    }
                }
                return Some(program);
            }
            left -= 1;
        }
    }
    let mut editor = Editor { left: Some(left) };
    visit::program(&mut program, &mut editor);
    editor.left.is_none().then_some(program)
}

/// Counts edits down, and makes the one that is reached.
struct Editor {
    left: Option<usize>,
}

impl Editor {
    /// Which of so many edits is to be made here.
    fn turn(&mut self, count: usize) -> Option<usize> {
        let left = self.left?;
        if left < count {
            self.left = None;
            return Some(left);
        }
        self.left = Some(left - count);
        None
    }
}

impl Visitor for Editor {
    fn block(&mut self, block: &mut Block) {
        if let Some(index) = self.turn(block.statements.len()) {
            block.statements.remove(index);
        }
    }

    fn expression(&mut self, expression: &mut Expression) {
        let replacements = replacements(expression);
        if let Some(index) = self.turn(replacements.len()) {
            *expression = replacements[index].clone();
        }
    }
}

/// Smaller expressions of the same type.
fn replacements(expression: &Expression) -> Vec<Expression> {
    let one = Expression::Real { value: 2.0, suffixed: true };
    let alone = |block: &Block| Expression::Block(None, block.clone());
    match expression {
        Expression::Arithmetic(operator, kind, a, b) => {
            let mut smaller = vec![(**a).clone()];
            if !matches!(operator, Operator::ShiftLeft | Operator::ShiftRight) {
                smaller.push((**b).clone());
            }
            if *kind == Kind::Real {
                smaller.push(one);
            }
            // A literal without a suffix has its type from the other operand.
            smaller.into_iter().map(suffixed).collect()
        }
        Expression::Negated(_, inner) | Expression::Not(_, inner) => vec![suffixed((**inner).clone())],
        Expression::Function { arguments, .. } => {
            arguments.iter().cloned().map(suffixed).chain([one]).collect()
        }
        Expression::Power(x, _) => vec![suffixed((**x).clone()), one],
        Expression::IntegerMethod { name, arguments, .. } if !["abs_diff", "count_ones"].contains(name) => {
            vec![arguments[0].clone()]
        }
        Expression::Both(a, b) | Expression::Either(a, b) => vec![(**a).clone(), (**b).clone()],
        Expression::If(condition, then, Some(otherwise)) => {
            let mut smaller = vec![alone(then), alone(otherwise)];
            if !matches!(**condition, Expression::Bool(_)) {
                smaller.push(Expression::If(
                    Box::new(Expression::Bool(true)),
                    then.clone(),
                    Some(otherwise.clone()),
                ));
            }
            smaller
        }
        Expression::Block(None, Block { statements, tail: Some(tail) }) if statements.is_empty() => {
            vec![(**tail).clone()]
        }
        Expression::Match(value, arms) => (0..arms.len().saturating_sub(1))
            .map(|index| {
                let mut arms = arms.clone();
                arms.remove(index);
                Expression::Match(value.clone(), arms)
            })
            .chain(arms.iter().filter(|arm| matches!(arm.pattern, Pattern::Wild)).map(|arm| arm.body.clone()))
            .collect(),
        Expression::Chain(chain, Consumer::Sum(Kind::Real, _) | Consumer::Product(Kind::Real, _)) => {
            let mut smaller = vec![one];
            if let (Source::Range { .. }, [Adaptor::Map(Handed::Closure(closure))]) =
                (&chain.source, &chain.adaptors[..])
            {
                smaller.push(closure.body.clone());
            }
            smaller
        }
        Expression::Apply(..) | Expression::UnwrapOr(..) | Expression::MapOr(..) => vec![one],
        _ => Vec::new(),
    }
}

fn suffixed(expression: Expression) -> Expression {
    match expression {
        Expression::Real { value, .. } => Expression::Real { value, suffixed: true },
        Expression::Integer { value, ty, .. } => Expression::Integer { value, ty, suffixed: true },
        other => other,
    }
}
