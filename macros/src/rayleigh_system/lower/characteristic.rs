//! `self.drag.at(x)`: a field or constant that is a function of one number, with derivatives of its own.

use proc_macro2::Ident;

use super::value::Value;
use super::written::Written;
use super::{Lowering, Result, refuse};

impl Lowering<'_> {
    /// The characteristic that a field or constant is, at its one argument. Whether it is one, rustc says.
    pub fn characteristic(&mut self, method: &Ident, of: &Written, arguments: Vec<Value>) -> Result<Value> {
        let text = self.text(method, of)?;
        if !text.arms.is_empty() {
            return refuse(
                method,
                "a characteristic that a pattern binds; keep it in a field of its own, and choose between values",
            );
        }
        if text.may_panic && self.guard().is_some() {
            return refuse(
                method,
                "the index of this characteristic may panic within the condition; take its value before",
            );
        }
        let mut places = Vec::new();
        for argument in arguments {
            places.push(self.scalar(method, argument)?);
        }
        match places[..] {
            [place] => Ok(Value::Real(self.graph.characteristic(text.tokens, place))),
            _ => refuse(method, "a characteristic is a function of one number"),
        }
    }
}
