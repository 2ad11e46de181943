//! Functions that jump: rounding, remainders, bits. Of fields and constants alone they are numbers like any
//! other, written out as they stand; of coordinates they have no derivative.

use proc_macro2::Ident;
use syn::BinOp;

use super::super::syntax::EUCLIDEAN;
use super::operator::literal;
use super::value::Value;
use super::written::Written;
use super::{Lowering, Result, refuse};

impl Lowering<'_> {
    /// The value as an expression of fields and constants alone, where it is one.
    pub fn as_written(&mut self, value: &Value) -> Option<Written> {
        match value {
            Value::Written(written) => Some(written.clone()),
            Value::Real(node) => self.graph.text(*node).map(Written::leaf),
            Value::Integer(integer) => {
                self.beside_field(*integer);
                Some(literal(*integer))
            }
            _ => None,
        }
    }

    /// A method that jumps, of a number of fields and constants alone.
    pub fn rounded(&mut self, method: &Ident, receiver: Value, arguments: &[Value]) -> Result<Value> {
        let no_derivative = format!(
            "`{method}` has no derivative here: it can be of fields and constants alone; choose between smooth cases with `if`"
        );
        // Of a literal alone, rustc would not know the type.
        if matches!(receiver, Value::Real(node) if self.graph.constant_value(node).is_some()) {
            return refuse(method, format!("`{method}` of a number that is written out; write the result"));
        }
        let Some(receiver) = self.as_written(&receiver) else { return refuse(method, no_derivative) };
        let mut written = Vec::new();
        for argument in arguments {
            let Some(argument) = self.as_written(argument) else { return refuse(method, no_derivative) };
            written.push(argument);
        }
        let whole = Written::Method(method.clone(), Box::new(receiver), written);
        self.text(method, &whole)?;
        // Integers have the remainders too, and those may panic.
        let may_panic = EUCLIDEAN.iter().any(|name| method == name);
        Ok(Value::Written(whole.as_text(may_panic)))
    }

    /// `left % right`, of numbers of fields and constants alone.
    pub fn remainder(&mut self, operator: &BinOp, left: &Value, right: &Value) -> Result<Value> {
        match (self.as_written(left), self.as_written(right)) {
            (Some(left), Some(right)) => {
                Ok(Value::Written(Written::Binary(*operator, Box::new(left), Box::new(right))))
            }
            _ => refuse(
                operator,
                "`%` has no derivative here: it can be of fields and constants alone; angles need no wrapping, coordinates live in ℝ",
            ),
        }
    }
}
