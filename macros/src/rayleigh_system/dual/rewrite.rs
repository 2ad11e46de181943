//! Bodies over `Real<D>`: one pass that rewrites what has a meaning there and refuses what has none.
//!
//! | written | becomes |
//! |---|---|
//! | the type `f64` | `Real<D>` |
//! | `0.5` beside an operator, as in `0.5 * x` | itself |
//! | `0.5` elsewhere | `D::real(0.5)` |
//! | `PI`, `Self::G` | `D::lift(PI)`, `D::lift(Self::G)` |
//! | `self.k` | `k`, with `let k = D::lift(self.k);` at the top of the body |
//! | `self.height(q)`, `Self::square(x)` | `self.height_over(q)`, `Self::square_over(x)` |
//! | `f64::sin(x)` | `Real::<D>::sin(x)` |
//! | `i as f64` | `D::number(i)` |
//! | `i as usize`, `i % n` | `dual::integer::<_, usize>(i)`, `dual::remainder(i % n)`: for integers alone |
//! | `f64::from(1.5_f32 * self.c)` | `D::real(f64::from(1.5_f32 * self.c))`: constants alone |
//! | `self.k.curve()`, of a trait or a struct of the user's | `D::lift(self.k.curve())`: of constants alone |
//! | `self.drag.at(x)` | `dual::at(&self.drag, x)` |
//! | `self.k.floor()`, `self.k % 2.0` | `D::lift(self.k.floor())`, `D::lift(self.k % 2.0)`: constants alone |

mod call;
mod cast;
mod doubt;
mod field;
mod method;
mod operand;
mod path;
mod signature;

use std::collections::{BTreeMap, HashSet};

use proc_macro2::{Span, TokenStream};
use quote::{ToTokens, format_ident, quote};
use syn::visit_mut::{self, VisitMut};
use syn::{
    Expr, ExprBinary, ExprField, FnArg, Ident, ImplItemFn, Item, Pat, ReturnType, Stmt, Type, parse_quote,
    parse_quote_spanned,
};

use super::super::diagnostics::{Mistake, Report, span_of};
use super::super::model::{Body, System};
use super::super::scope::bound_names;
use super::super::syntax::{
    Matches, is_assignment, is_float_literal, is_generic_of_std, is_integer, is_of_other_float,
    is_place_of_self, is_plain, is_variant, is_variant_with_fields, real_type, simple_name,
};
pub use method::OwnMethods;
use signature::helper_signature;

/// A function and what it becomes over `Real<D>`.
pub struct Twin {
    /// As the user wrote it.
    pub plain: ImplItemFn,
    pub over: ImplItemFn,
    /// Whether rustc may still refuse it, by types that the body does not tell.
    pub is_doubtful: bool,
    /// Methods that it may call on dual numbers, which have none.
    pub own_methods: OwnMethods,
}

/// L, R, f and, transitively, the functions of the block that they call.
pub fn over_duals(system: &System<'_>, report: &mut Report) -> Vec<Twin> {
    let mut bodies = system.bodies.clone();
    let mut twins: Vec<Twin> = Vec::new();
    while let Some(body) = bodies.get(twins.len()).cloned() {
        let before = report.count();
        let Rewritten { over, functions, is_doubtful, own_methods } = rewrite(system, &body, report);
        let plain = body.function;
        if report.count() > before {
            report.mark_body(&plain.sig.ident);
        }
        let is_doubtful = is_doubtful || doubt::hands_on_fields(&plain);
        twins.push(Twin { plain, over, is_doubtful, own_methods });
        for name in functions {
            let known = bodies.iter().any(|body| body.function.sig.ident == name);
            if !known && let Some(helper) = system.source.functions().find(|f| f.sig.ident == name) {
                let before = report.count();
                helper_signature(helper, &system.scalar, report);
                let has_right_signature = report.count() == before;
                bodies.push(Body { function: helper.clone(), has_right_signature });
            }
        }
    }
    for twin in &twins {
        let name = &twin.over.sig.ident;
        if let Some(taken) = system.source.functions().find(|function| function.sig.ident == *name) {
            report.at(&taken.sig.ident, Mistake::TwinName(name.to_string()));
        }
    }
    twins
}

/// The name of the differentiated twin.
pub fn over(name: &Ident) -> Ident {
    format_ident!("{name}_over", span = name.span())
}

struct Rewritten {
    over: ImplItemFn,
    functions: Vec<Ident>,
    is_doubtful: bool,
    own_methods: OwnMethods,
}

fn rewrite(system: &System<'_>, body: &Body, report: &mut Report) -> Rewritten {
    let mut over_function = body.function.clone();
    let mut rewriter = Rewriter {
        system,
        report,
        bound: bound_names(&over_function),
        numbers: method::numbers(&over_function),
        fields: BTreeMap::new(),
        functions: Vec::new(),
        is_doubtful: false,
        own_methods: OwnMethods::default(),
    };
    // Docs and lints of the plain function would be said twice.
    over_function.attrs.clear();
    over_function.vis = syn::Visibility::Inherited;
    let scalar = system.scalar.clone();
    let signature = &mut over_function.sig;
    signature.ident = over(&signature.ident);
    signature.generics = parse_quote!(<D: Dual<#scalar>>);
    // What is wrong with a signature would be said again.
    if body.has_right_signature {
        for parameter in &mut signature.inputs {
            if let FnArg::Typed(parameter) = parameter {
                rewriter.visit_type_mut(&mut parameter.ty);
            }
        }
        if let ReturnType::Type(_, ty) = &mut signature.output {
            rewriter.visit_type_mut(ty);
        }
    }
    rewriter.visit_block_mut(&mut over_function.block);
    let Rewriter { fields, functions, is_doubtful, own_methods, .. } = rewriter;
    let prologue = fields.into_values().map(|field| -> Stmt {
        let Field { local, access } = field;
        // One span for all tokens: a field of a wrong type is then reported once.
        let span = local.span();
        let ExprField { base, member, .. } = access;
        let member = respanned(member.into_token_stream(), span);
        let base = respanned(base.into_token_stream(), span);
        parse_quote_spanned!(span=> let #local = D::lift(#base.#member);)
    });
    let statements = std::mem::take(&mut over_function.block.stmts);
    over_function.block.stmts = prologue.chain(statements).collect();
    Rewritten { over: over_function, functions, is_doubtful, own_methods }
}

/// The tokens, all seen at `span` but resolved where they were.
fn respanned(tokens: TokenStream, span: Span) -> TokenStream {
    tokens
        .into_iter()
        .map(|mut token| {
            token.set_span(span.resolved_at(token.span()));
            token
        })
        .collect()
}

/// A field of the system, or of a struct within it: the local that holds it, and the user's tokens.
struct Field {
    local: Ident,
    access: ExprField,
}

struct Rewriter<'r> {
    system: &'r System<'r>,
    report: &'r mut Report,
    bound: HashSet<String>,
    /// Locals that are numbers, as far as their form tells.
    numbers: HashSet<Ident>,
    /// By the members on the way from `self`.
    fields: BTreeMap<Vec<String>, Field>,
    functions: Vec<Ident>,
    /// Whether a number is converted whose precision only its literals may tell.
    is_doubtful: bool,
    own_methods: OwnMethods,
}

impl VisitMut for Rewriter<'_> {
    fn visit_expr_mut(&mut self, expression: &mut Expr) {
        if is_plain(expression) {
            let span = span_of(expression);
            if is_of_other_float(expression, &self.system.scalar) {
                let expected = self.system.scalar.to_string();
                self.report.at(expression, Mistake::OtherFloat { expected });
            }
            *expression = parse_quote_spanned!(span=> D::real(#expression));
            return;
        }
        if let Some(replacement) = self.constant_that_jumps(expression) {
            *expression = replacement;
            return;
        }
        match expression {
            Expr::Binary(binary) => {
                if let Some(replacement) = self.binary(binary) {
                    *expression = replacement;
                }
            }
            Expr::Assign(assignment) => {
                self.refuse_assignment_to_field(&assignment.left);
                visit_mut::visit_expr_assign_mut(self, assignment);
            }
            Expr::Reference(reference) => {
                if reference.mutability.is_some() && is_place_of_self(&reference.expr) {
                    self.report.at(reference, Mistake::FieldBorrowedMutably);
                    return;
                }
                self.visit_expr_mut(&mut reference.expr);
            }
            Expr::Field(field) => match self.field_access(field) {
                Some(replacement) => *expression = replacement,
                None => self.visit_expr_mut(&mut field.base),
            },
            Expr::MethodCall(call) => match self.of_constants(call) {
                Some(replacement) => *expression = replacement,
                None => match self.characteristic(call) {
                    Some(replacement) => *expression = replacement,
                    None => self.method_call(call, true),
                },
            },
            Expr::Call(call) => match self.conversion(call) {
                Some(replacement) => *expression = replacement,
                None => self.call(call),
            },
            Expr::Path(path) => {
                if let Some(replacement) = self.path(path) {
                    *expression = replacement;
                }
            }
            Expr::Cast(cast) => {
                if let Some(replacement) = self.cast(cast) {
                    *expression = replacement;
                }
            }
            // The length of `[x; N]` is a constant of the type system.
            Expr::Repeat(repeat) => self.visit_expr_mut(&mut repeat.expr),
            Expr::Macro(invocation) if invocation.mac.path.is_ident("matches") => {
                match invocation.mac.parse_body::<Matches>() {
                    Ok(Matches { value, pattern, guard }) => {
                        let guard = guard.map(|guard| quote!(if #guard));
                        *expression = parse_quote!((match #value { #pattern #guard => true, _ => false }));
                        visit_mut::visit_expr_mut(self, expression);
                    }
                    Err(_) => self.report.at(expression, Mistake::Macro),
                }
            }
            Expr::Struct(literal) => self.report.at(&literal.path, Mistake::StructByDuals),
            Expr::Macro(_) => self.report.at(expression, Mistake::Macro),
            Expr::Unsafe(block) => self.report.at(&block.unsafe_token, Mistake::Unsafe),
            Expr::Async(block) => self.report.at(&block.async_token, Mistake::Async),
            Expr::Await(future) => self.report.at(&future.await_token, Mistake::Async),
            _ => visit_mut::visit_expr_mut(self, expression),
        }
    }

    fn visit_stmt_mut(&mut self, statement: &mut Stmt) {
        match statement {
            Stmt::Item(Item::Use(_)) => {}
            Stmt::Item(item @ (Item::Const(_) | Item::Static(_))) => {
                self.report.at(item, Mistake::LocalConst)
            }
            Stmt::Item(item) => self.report.at(item, Mistake::NestedItem),
            // What is called for what it changes has no value to differentiate.
            Stmt::Expr(Expr::MethodCall(call), Some(_)) if self.of_constants(call).is_none() => {
                self.method_call(call, false);
            }
            Stmt::Macro(statement) => self.report.at(&statement.mac, Mistake::Macro),
            _ => visit_mut::visit_stmt_mut(self, statement),
        }
    }

    fn visit_pat_mut(&mut self, pattern: &mut Pat) {
        match pattern {
            Pat::Lit(literal) => {
                if is_float_literal(&literal.lit) {
                    self.report.at(literal, Mistake::FloatPattern);
                }
            }
            Pat::Range(range) => {
                let is_float = |bound: &Option<Box<Expr>>| bound.as_deref().is_some_and(is_plain);
                if is_float(&range.start) || is_float(&range.end) {
                    self.report.at(range, Mistake::FloatPattern);
                }
            }
            Pat::Macro(_) => self.report.at(pattern, Mistake::Macro),
            Pat::TupleStruct(inner) if is_variant_with_fields(&inner.path) => {
                self.report.at(&inner.path, Mistake::VariantByDuals);
            }
            Pat::Struct(inner) if is_variant_with_fields(&inner.path) => {
                self.report.at(&inner.path, Mistake::VariantByDuals);
            }
            Pat::Path(inner) if is_variant(&inner.path) => self.report.at(inner, Mistake::VariantByDuals),
            Pat::Ident(inner) if is_variant(&inner.ident.clone().into()) => {
                self.report.at(inner, Mistake::VariantByDuals);
            }
            Pat::Const(_) | Pat::Path(_) => {}
            _ => visit_mut::visit_pat_mut(self, pattern),
        }
    }

    fn visit_type_mut(&mut self, ty: &mut Type) {
        match ty {
            // The length is a constant of the type system.
            Type::Array(array) => self.visit_type_mut(&mut array.elem),
            Type::Path(path) if is_generic_of_std(&path.path) => visit_mut::visit_type_path_mut(self, path),
            Type::Path(_) => match simple_name(ty) {
                Some(name) if *name == self.system.scalar => *ty = real_type(name.span()),
                Some(name) if name == "f64" || name == "f32" => {
                    let expected = self.system.scalar.to_string();
                    self.report.at(ty, Mistake::OtherFloat { expected });
                }
                Some(name) if name == "bool" || name == "char" => {}
                _ if is_integer(ty) => {}
                _ => self.report.at(ty, Mistake::TypeAlias),
            },
            Type::Macro(_) => self.report.at(ty, Mistake::Macro),
            _ => visit_mut::visit_type_mut(self, ty),
        }
    }
}

impl Rewriter<'_> {
    /// Literals beside an operator stay as they are: `0.5 * x` is defined for `Real<D>`.
    fn binary(&mut self, binary: &mut ExprBinary) -> Option<Expr> {
        if is_assignment(&binary.op) {
            self.refuse_assignment_to_field(&binary.left);
        }
        let is_still = self.is_still(&binary.left) && self.is_still(&binary.right);
        if !is_plain(&binary.left) {
            self.visit_expr_mut(&mut binary.left);
        }
        if !is_plain(&binary.right) {
            self.visit_expr_mut(&mut binary.right);
        }
        self.operator(binary, is_still)
    }

    fn refuse_assignment_to_field(&mut self, place: &Expr) {
        match place {
            // `(self.k, x) = …`
            Expr::Tuple(places) => {
                places.elems.iter().for_each(|place| self.refuse_assignment_to_field(place))
            }
            Expr::Array(places) => {
                places.elems.iter().for_each(|place| self.refuse_assignment_to_field(place))
            }
            place if is_place_of_self(place) => self.report.at(place, Mistake::FieldAssignment),
            _ => {}
        }
    }
}
