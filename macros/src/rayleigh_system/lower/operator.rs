//! Operators.

use proc_macro2::Span;
use quote::{ToTokens, quote};
use syn::{BinOp, Expr, ExprBinary, ExprLit, ExprUnary, Lit, UnOp};

use super::super::diagnostics::span_of;
use super::super::graph::{Comparison, Operation};
use super::super::syntax::without_parentheses;
use super::class::Integer;
use super::value::{Truth, Value};
use super::written::Written;
use super::{Lowering, Node, Result, refuse};

/// Where an operation and its two sides are written, as errors tell.
#[derive(Clone, Copy)]
pub struct Operands<'a> {
    pub whole: &'a dyn ToTokens,
    pub left: &'a dyn ToTokens,
    pub right: &'a dyn ToTokens,
}

impl<'a> Operands<'a> {
    fn of(binary: &'a ExprBinary) -> Self {
        Self { whole: binary, left: &binary.left, right: &binary.right }
    }
}

impl Lowering<'_> {
    pub fn unary(&mut self, unary: &ExprUnary) -> Result<Value> {
        if let (UnOp::Neg(_), Expr::Lit(ExprLit { lit: Lit::Int(literal), .. })) =
            (&unary.op, without_parentheses(&unary.expr))
            && let Some(value) = self.negative_literal(unary, literal)
        {
            return value;
        }
        let value = self.expression(&unary.expr)?;
        // What is written `*self.k` or `*Self::C` is a reference, or a type with a `Deref` of its own.
        if let (UnOp::Deref(_), Value::Written(place)) = (&unary.op, &value)
            && self.is_outside(&unary.expr)
        {
            return Ok(Value::Written(place.derived(false, |place| quote!((*#place)))));
        }
        self.apply_unary(unary, value)
    }

    /// Whether it is a place of the system, or a constant: `self.k[0]`, `*self.k`, `Self::C`.
    fn is_outside(&self, place: &Expr) -> bool {
        match place {
            Expr::Paren(inner) => self.is_outside(&inner.expr),
            Expr::Unary(inner) if matches!(inner.op, UnOp::Deref(_)) => self.is_outside(&inner.expr),
            Expr::Field(field) => self.is_outside(&field.base),
            Expr::Index(index) => self.is_outside(&index.expr),
            Expr::Path(path) => {
                let local = path.path.get_ident().and_then(|name| self.local(name));
                matches!(local, None | Some(Value::Import(_)))
            }
            _ => false,
        }
    }

    fn apply_unary(&mut self, unary: &ExprUnary, value: Value) -> Result<Value> {
        match (&unary.op, value) {
            (UnOp::Deref(_), Value::Written(written)) => Ok(Value::Written(written.dereferenced())),
            (UnOp::Deref(_), value) => Ok(value),
            (UnOp::Neg(_), Value::Integer(integer)) => self.negated(unary, integer),
            (UnOp::Not(_), Value::Integer(integer)) => self.complement(unary, integer),
            (operator, Value::Written(written)) => {
                Ok(Value::Written(Written::Unary(*operator, Box::new(written))))
            }
            (_, Value::Chosen(chosen)) => {
                self.distribute(unary, &chosen, |this, value| this.apply_unary(unary, value))
            }
            (UnOp::Neg(_), value) => {
                let node = self.scalar(unary, value)?;
                Ok(Value::Real(match self.graph.constant_value(node) {
                    Some(value) => self.graph.constant(-value),
                    None => self.graph.node(Operation::Negate(node)),
                }))
            }
            (UnOp::Not(_), Value::Truth(truth)) => Ok(Value::Truth(truth.not(&mut self.graph))),
            _ => refuse(unary, "this operator cannot be followed at compile time"),
        }
    }

    pub fn binary(&mut self, binary: &ExprBinary) -> Result<Value> {
        let ExprBinary { left, op, right, .. } = binary;
        if let BinOp::And(_) | BinOp::Or(_) = op {
            let left_value = self.expression(left)?;
            let is_and = matches!(op, BinOp::And(_));
            let right_side = |this: &mut Self| {
                let value = this.expression(right)?;
                this.truth(right, value).map(Value::Truth)
            };
            return match self.truth(left, left_value)? {
                // The right side of a decided condition is not run.
                Truth::Known(a) if a != is_and => {
                    self.integers.has_dead_code = true;
                    Ok(Value::Truth(Truth::Known(a)))
                }
                Truth::Known(_) => right_side(self),
                Truth::Where(a) => {
                    let decided = |_: &mut Self| Ok(Value::Truth(Truth::Known(!is_and)));
                    self.both(binary, a, is_and, right_side, decided)
                }
            };
        }
        if let Some(operator) = plain(op) {
            // Rust evaluates the right side of a compound assignment to a number first.
            let right_value = self.expression(right)?;
            let place = self.place(left)?;
            let left_value = self.read(left, &place)?;
            let value = self.operate(Operands::of(binary), &operator, left_value, right_value)?;
            return self.write(left, &place, value);
        }
        let (left, right) = (self.expression(left)?, self.expression(right)?);
        self.operate(Operands::of(binary), op, left, right)
    }

    /// `left && right` or `left || right`, where numbers decide whether the right side is run.
    fn both(
        &mut self,
        at: &ExprBinary,
        left: Node,
        is_and: bool,
        right: impl FnOnce(&mut Self) -> Result<Value>,
        decided: impl FnOnce(&mut Self) -> Result<Value>,
    ) -> Result<Value> {
        // As written, and not as a selection between `true` and the other.
        let value = if is_and {
            self.branch_values(at, left, right, decided)?.0
        } else {
            self.branch_values(at, left, decided, right)?.1
        };
        let Value::Truth(right) = value else { return refuse(at, "this is not a condition") };
        let (left, graph) = (Truth::Where(left), &mut self.graph);
        Ok(Value::Truth(if is_and { left.and(graph, right) } else { left.or(graph, right) }))
    }

    /// `left operator right`.
    pub fn operate(
        &mut self,
        at: Operands<'_>,
        operator: &BinOp,
        left: Value,
        right: Value,
    ) -> Result<Value> {
        match (left, right) {
            (Value::Integer(a), Value::Integer(b)) => self.integers(&at.whole, operator, a, b),
            (Value::Truth(a), Value::Truth(b)) => self.truths(at, operator, a, b),
            (Value::Truth(a), Value::Written(b)) => {
                let b = self.written_truth(&at.right, &b)?;
                self.truths(at, operator, a, Truth::Where(b))
            }
            (Value::Written(a), Value::Truth(b)) => {
                let a = self.written_truth(&at.left, &a)?;
                self.truths(at, operator, Truth::Where(a), b)
            }
            // Fields and constants alone: what they are, rustc knows.
            (Value::Written(a), Value::Written(b)) => {
                Ok(Value::Written(Written::Binary(*operator, Box::new(a), Box::new(b))))
            }
            (Value::Written(a), Value::Integer(b)) => {
                let b = Box::new(self.literal_of(b, operator));
                Ok(Value::Written(Written::Binary(*operator, Box::new(a), b)))
            }
            (Value::Integer(a), Value::Written(b)) => {
                let a = Box::new(self.literal_of(a, operator));
                Ok(Value::Written(Written::Binary(*operator, a, Box::new(b))))
            }
            (Value::Chosen(a), b @ (Value::Integer(_) | Value::Written(_) | Value::Chosen(_))) => {
                self.distribute(&at.whole, &a, |this, a| this.operate(at, operator, a, b.clone()))
            }
            (a @ (Value::Integer(_) | Value::Written(_)), Value::Chosen(b)) => {
                self.distribute(&at.whole, &b, |this, b| this.operate(at, operator, a.clone(), b))
            }
            (left, right) if matches!(operator, BinOp::Rem(_)) => self.remainder(operator, &left, &right),
            (left, right) => {
                let (a, b) = (self.scalar(&at.left, left)?, self.scalar(&at.right, right)?);
                let operation = match operator {
                    BinOp::Add(_) => return Ok(Value::Real(self.graph.add(a, b))),
                    BinOp::Sub(_) => Operation::Subtract(a, b),
                    BinOp::Mul(_) => Operation::Multiply(a, b),
                    BinOp::Div(_) => Operation::Divide(a, b),
                    _ => {
                        let comparison = match operator {
                            BinOp::Lt(_) => Comparison::Less,
                            BinOp::Le(_) => Comparison::LessOrEqual,
                            BinOp::Gt(_) => Comparison::Greater,
                            BinOp::Ge(_) => Comparison::GreaterOrEqual,
                            BinOp::Eq(_) => Comparison::Equal,
                            BinOp::Ne(_) => Comparison::NotEqual,
                            _ => {
                                return refuse(operator, "this operator is none of floating-point numbers");
                            }
                        };
                        let node = self.graph.node(Operation::Compare(comparison, a, b));
                        return Ok(Value::Truth(Truth::Where(node)));
                    }
                };
                Ok(Value::Real(self.graph.node(operation)))
            }
        }
    }

    /// An operator of bools that evaluates both sides.
    fn truths(&mut self, at: Operands<'_>, operator: &BinOp, a: Truth, b: Truth) -> Result<Value> {
        let graph = &mut self.graph;
        let truth = match operator {
            BinOp::BitAnd(_) => a.and(graph, b),
            BinOp::BitOr(_) => a.or(graph, b),
            BinOp::BitXor(_) | BinOp::Ne(_) => a.differs(graph, b),
            BinOp::Eq(_) => a.differs(graph, b).not(graph),
            _ => return refuse(&at.whole, "combine conditions with `&&`, `||`, `!`, `==` and `!=`"),
        };
        Ok(Value::Truth(truth))
    }

    /// An integer beside a field: its type is the field's.
    fn literal_of(&mut self, integer: Integer, operator: &BinOp) -> Written {
        if !matches!(operator, BinOp::Shl(_) | BinOp::Shr(_)) {
            self.beside_field(integer);
        }
        literal(integer)
    }

    /// The integer with its type, which rustc must know before it finds a method.
    pub fn typed_literal(&self, integer: Integer) -> Written {
        match self.integers.type_of(integer.class) {
            Some(ty) => {
                let digits =
                    syn::LitInt::new(&format!("{}_{ty}", integer.value.unsigned_abs()), Span::call_site());
                Written::leaf(if integer.value < 0 { quote!((-#digits)) } else { quote!(#digits) })
            }
            None => literal(integer),
        }
    }
}

/// The integer as it is written.
pub fn literal(integer: Integer) -> Written {
    let digits = proc_macro2::Literal::u128_unsuffixed(integer.value.unsigned_abs());
    Written::leaf(if integer.value < 0 { quote!((-#digits)) } else { quote!(#digits) })
}

/// The operator of a compound assignment.
fn plain(operator: &BinOp) -> Option<BinOp> {
    let span = span_of(operator);
    Some(match operator {
        BinOp::AddAssign(_) => BinOp::Add(syn::Token![+](span)),
        BinOp::SubAssign(_) => BinOp::Sub(syn::Token![-](span)),
        BinOp::MulAssign(_) => BinOp::Mul(syn::Token![*](span)),
        BinOp::DivAssign(_) => BinOp::Div(syn::Token![/](span)),
        BinOp::RemAssign(_) => BinOp::Rem(syn::Token![%](span)),
        BinOp::BitAndAssign(_) => BinOp::BitAnd(syn::Token![&](span)),
        BinOp::BitOrAssign(_) => BinOp::BitOr(syn::Token![|](span)),
        BinOp::BitXorAssign(_) => BinOp::BitXor(syn::Token![^](span)),
        BinOp::ShlAssign(_) => BinOp::Shl(syn::Token![<<](span)),
        BinOp::ShrAssign(_) => BinOp::Shr(syn::Token![>>](span)),
        _ => return None,
    })
}
