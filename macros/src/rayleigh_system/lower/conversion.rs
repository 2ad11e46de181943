//! Casts, and calls of functions by their path, conversions among them.

use quote::quote;
use syn::spanned::Spanned;
use syn::{Expr, ExprCall, ExprCast, GenericArgument, PathArguments, Type};

use super::super::syntax::{is_plain, simple_name};
use super::class::{Integer, IntegerType};
use super::module::not_known;
use super::value::{Truth, Value};
use super::written::Written;
use super::{Lowering, Result, refuse};

impl Lowering<'_> {
    pub fn cast(&mut self, cast: &ExprCast) -> Result<Value> {
        // Of literals: rustc rounds.
        if is_plain(&cast.expr) && simple_name(&cast.ty).is_none_or(|name| *name != self.scalar) {
            return Ok(Value::Written(Written::leaf(quote!((#cast)))));
        }
        let value = self.expression(&cast.expr)?;
        self.cast_value(cast, value)
    }

    fn cast_value(&mut self, cast: &ExprCast, value: Value) -> Result<Value> {
        let ty = &cast.ty;
        let value = self.of_any_precision(value);
        let is_scalar = simple_name(ty).is_some_and(|name| *name == self.scalar);
        match (value, IntegerType::of(ty)) {
            (Value::Integer(integer), Some(ty)) => self.integer_cast(cast, integer.value, ty),
            (Value::Integer(integer), None) if is_scalar => Ok(self.converted(integer)),
            (Value::Real(node), None) if is_scalar => Ok(Value::Real(node)),
            // Another precision than the system's: rustc rounds.
            (Value::Integer(integer), None)
                if simple_name(ty).is_some_and(|name| name == "f64" || name == "f32") =>
            {
                let digits = format!("{}_i128", integer.value.unsigned_abs());
                let exact = syn::LitInt::new(&digits, cast.span());
                let sign = (integer.value < 0).then(|| quote!(-));
                Ok(Value::Written(Written::leaf(quote!((#sign #exact as #ty)))))
            }
            (Value::Truth(truth), Some(ty)) => {
                let number = |this: &mut Self, truth| this.integer(cast, i128::from(truth), Some(ty));
                match truth {
                    Truth::Known(truth) => number(self, truth),
                    Truth::Where(condition) => {
                        let (one, zero) = (number(self, true)?, number(self, false)?);
                        self.select(cast, condition, one, zero)
                    }
                }
            }
            (Value::Written(written), _) => {
                Ok(Value::Written(written.derived(false, |operand| quote!((#operand as #ty)))))
            }
            (Value::Chosen(chosen), _) => {
                self.distribute(cast, &chosen, |this, value| this.cast_value(cast, value))
            }
            _ => refuse(
                cast,
                "only integers can be cast here, to an integer or to the scalar of the system; to choose between cases, compare: `if q[0] > 0.0 { … } else { … }`",
            ),
        }
    }

    /// The value as text, where it is a number of fields and constants alone: what it is made of may be of
    /// another precision than the system's.
    fn of_any_precision(&self, value: Value) -> Value {
        match &value {
            Value::Real(node) if self.graph.constant_value(*node).is_none() => {
                self.graph.text(*node).map_or(value, |text| Value::Written(Written::leaf(text)))
            }
            _ => value,
        }
    }

    /// The nearest floating-point number.
    pub fn converted(&mut self, integer: Integer) -> Value {
        #[expect(clippy::cast_precision_loss, reason = "this is Rust's `as`")]
        let nearest =
            if self.scalar == "f32" { f64::from(integer.value as f32) } else { integer.value as f64 };
        self.number(nearest)
    }

    pub fn path_call(&mut self, call: &ExprCall, length: Option<usize>) -> Result<Value> {
        if let Expr::Path(path) = &*call.func {
            let segments: Vec<String> =
                path.path.segments.iter().map(|segment| segment.ident.to_string()).collect();
            match segments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
                [.., "mem", "swap"] => return self.swap_places(call),
                [.., "array", "from_fn"] => return self.array_from_fn(call, length),
                ["f64" | "f32", "from"] if call.args.len() == 1 => {
                    let value = self.expression(&call.args[0])?;
                    return self.float_from(call, value);
                }
                [name, "from"] if call.args.len() == 1 && IntegerType::named(name).is_some() => {
                    let value = self.expression(&call.args[0])?;
                    return self.integer_from(call, value, IntegerType::named(name));
                }
                _ => {}
            }
        }
        let function = self.expression(&call.func)?;
        // A function of the module, which the macro cannot see into.
        if let (Value::Written(_), Expr::Path(path)) = (&function, &*call.func)
            && let Some(name) = path.path.segments.last().map(|segment| &segment.ident)
            && name.to_string().starts_with(char::is_lowercase)
        {
            return refuse(path, not_known(name));
        }
        let arguments =
            call.args.iter().map(|argument| self.expression(argument)).collect::<Result<Vec<_>>>()?;
        // `Self::height(self, q)`.
        let arguments = match (&function, arguments.first()) {
            (Value::Function(_), Some(Value::System)) => arguments[1..].to_vec(),
            _ => arguments,
        };
        self.apply(call, &function, arguments)
    }

    /// `f64::from(value)`
    fn float_from(&mut self, call: &ExprCall, value: Value) -> Result<Value> {
        let function = &call.func;
        let value = self.of_any_precision(value);
        let is_scalar = matches!(&**function, Expr::Path(path) if path.path.segments[0].ident == self.scalar);
        match value {
            Value::Written(written) => Ok(Value::Written(self.converted_text(call, function, &written)?)),
            Value::Chosen(chosen) => {
                self.distribute(call, &chosen, |this, value| this.float_from(call, value))
            }
            Value::Integer(integer) if is_scalar => Ok(self.converted(integer)),
            Value::Real(node) if is_scalar => Ok(Value::Real(node)),
            Value::Truth(truth) if is_scalar => {
                let (one, zero) = (self.number(1.0), self.number(0.0));
                match truth {
                    Truth::Known(truth) => Ok(if truth { one } else { zero }),
                    Truth::Where(condition) => self.select(call, condition, one, zero),
                }
            }
            _ => refuse(call, "only numbers can be converted here, to the scalar of the system"),
        }
    }

    /// `i64::from(value)`, which loses nothing.
    fn integer_from(&mut self, call: &ExprCall, value: Value, ty: Option<IntegerType>) -> Result<Value> {
        match value {
            Value::Integer(integer) => self.integer(call, integer.value, ty),
            Value::Truth(Truth::Known(truth)) => self.integer(call, i128::from(truth), ty),
            Value::Truth(Truth::Where(condition)) => {
                let (one, zero) = (self.integer(call, 1, ty)?, self.integer(call, 0, ty)?);
                self.select(call, condition, one, zero)
            }
            Value::Written(written) => Ok(Value::Written(self.converted_text(call, &call.func, &written)?)),
            Value::Chosen(chosen) => {
                self.distribute(call, &chosen, |this, value| this.integer_from(call, value, ty))
            }
            _ => refuse(call, "only integers and conditions can be converted here"),
        }
    }

    /// `function(written)`
    fn converted_text(&mut self, at: &ExprCall, function: &Expr, written: &Written) -> Result<Written> {
        self.text(at, written)?;
        Ok(written.derived(false, |operand| quote!(#function(#operand))))
    }

    fn array_from_fn(&mut self, call: &ExprCall, length: Option<usize>) -> Result<Value> {
        let Some(length) = self.said_length(call)?.or(length) else {
            return refuse(
                call,
                "the length is not known here; give the array a type, as in `let a: [f64; 3] = …`",
            );
        };
        let Some(function) = call.args.first() else { return refuse(call, "called without a function") };
        let function = self.expression(function)?;
        let entries = self.collected(call, length, |this, index| {
            let index = this.integer(call, index as i128, Some(IntegerType::USIZE))?;
            this.apply(call, &function, vec![index])
        })?;
        Ok(Value::Sequence(entries))
    }

    /// `from_fn::<f64, 3, _>`
    fn said_length(&mut self, call: &ExprCall) -> Result<Option<usize>> {
        let Expr::Path(path) = &*call.func else { return Ok(None) };
        let arguments = path.path.segments.last().map(|segment| &segment.arguments);
        let Some(PathArguments::AngleBracketed(arguments)) = arguments else { return Ok(None) };
        match arguments.args.iter().nth(1) {
            Some(GenericArgument::Const(length)) => self.length(length).map(Some),
            Some(GenericArgument::Type(Type::Infer(_))) => Ok(None),
            Some(other) => refuse(other, "this length is not known here; write a literal"),
            None => Ok(None),
        }
    }
}
