//! How many operations each loop writes: what is too long is shown at the loop that makes it so.

use std::fmt;

use proc_macro2::Span;
use quote::ToTokens;
use syn::{Expr, Ident};

use super::super::graph::{MOST_EXPRESSIONS, MOST_OPERATIONS};
use super::value::Value;
use super::{Lowering, MAX_NESTING, Refusal, Result, refuse};

/// The operations that one loop or call writes.
#[derive(Clone, Debug)]
pub struct Load {
    /// The range of the loop, or the name of the method.
    at: (Span, String),
    /// The function that it belongs to.
    part: Ident,
    operations: usize,
}

/// How long the code would be.
#[derive(Clone, Copy)]
pub enum Length {
    /// Operations of one generated function.
    Function(usize),
    /// Of all functions together, more than are looked at.
    Unknown,
}

impl Length {
    /// The refusal of a system without loops.
    pub fn of(self, system: &Ident) -> Refusal {
        Refusal::at(system, self.to_string())
    }
}

impl fmt::Display for Length {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Function(operations) => write!(
                f,
                "with its derivatives one function of straight-line code is {operations} operations long; it may have {MOST_OPERATIONS}"
            ),
            Self::Unknown => write!(
                f,
                "the derivatives take more than {MOST_EXPRESSIONS} operations, more than are looked at; one function may have {MOST_OPERATIONS}"
            ),
        }
    }
}

impl Load {
    /// The refusal of derivatives that are too long.
    pub fn refusal(&self, length: Length) -> Refusal {
        let written =
            format!("written out, this is {} of the operations of `{}`", self.operations, self.part);
        self.with_advice(&format!("{written}, and {length}"))
    }

    fn with_advice(&self, what: &str) -> Refusal {
        let (span, token) = self.at.clone();
        let reason = format!("{what}; let it run over fewer terms, such as those of neighbours alone");
        Refusal { span, token, reason, is_final: false }
    }
}

/// The tokens that a loop or method call is shown at; `None` for other expressions.
fn shown(expression: &Expr) -> Option<&dyn ToTokens> {
    match expression {
        Expr::ForLoop(each) => Some(&*each.expr),
        Expr::While(repeated) => Some(&*repeated.cond),
        Expr::Loop(endless) => Some(&endless.loop_token),
        Expr::MethodCall(call) => Some(&call.method),
        _ => None,
    }
}

impl Lowering<'_> {
    /// Runs an expression within those that are being run.
    fn nested(&mut self, expression: &Expr) -> Result<Value> {
        if self.nesting == MAX_NESTING {
            return refuse(expression, "calls and expressions are nested too deeply here");
        }
        self.nesting += 1;
        let value = self.evaluated(expression);
        self.nesting -= 1;
        value
    }

    /// The value of an expression; the operations of a loop that is in no other are counted.
    pub fn expression(&mut self, expression: &Expr) -> Result<Value> {
        let Some(at) = shown(expression).filter(|_| !self.is_weighed) else {
            return self.nested(expression);
        };
        let before = self.graph.len();
        self.is_weighed = true;
        let value = self.nested(expression);
        self.is_weighed = false;
        let operations = self.graph.len() - before;
        if self.heaviest.as_ref().is_none_or(|heaviest| heaviest.operations < operations)
            && let Some(part) = self.part.clone()
        {
            let Refusal { span, token, .. } = Refusal::at(&at, "");
            self.heaviest = Some(Load { at: (span, token), part, operations });
        }
        match (&self.heaviest, value) {
            (Some(heaviest), Err(_)) if self.is_too_long() => {
                let Load { operations, part, .. } = heaviest;
                Err(heaviest.with_advice(&format!(
                    "written out, this is {operations} of the operations of `{part}`, before any derivative, and goes on: too long for straight-line code, which may have {MOST_OPERATIONS}"
                )))
            }
            (_, value) => value,
        }
    }
}
