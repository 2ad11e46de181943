//! Every message of the macro, and where they are collected.
//!
//! A message says what is wrong at the token and what to write instead.

use std::fmt::Display;

use proc_macro2::{Span, TokenStream};
use quote::ToTokens;
use syn::Error;
use syn::spanned::Spanned;

/// The mistakes found, in order of discovery; shown all in one compile.
#[derive(Default)]
pub struct Report {
    errors: Option<Error>,
}

impl Report {
    pub fn is_empty(&self) -> bool {
        self.errors.is_none()
    }

    /// Records `mistake` at `tokens`.
    pub fn at(&mut self, tokens: &impl ToTokens, mistake: Mistake) {
        self.error(Error::new_spanned(tokens, mistake));
    }

    /// Records `mistake` at `span`.
    pub fn at_span(&mut self, span: Span, mistake: Mistake) {
        self.error(Error::new(span, mistake));
    }

    /// Records an error of syn's own.
    pub fn error(&mut self, error: Error) {
        match &mut self.errors {
            Some(errors) => errors.combine(error),
            None => self.errors = Some(error),
        }
    }

    /// `compile_error!` for each mistake.
    pub fn into_tokens(self) -> TokenStream {
        self.errors.map(|errors| errors.into_compile_error()).unwrap_or_default()
    }
}

/// What can be wrong with an annotated item.
pub enum Mistake {
    // The attribute.
    UnknownOption,
    UnknownRule(String),
    RepeatedRule(String),
    NoRule,
    UnknownEngine(String),
    NotLowered(String),
    TooLong,
    // The item.
    WrongItem,
    TraitImpl,
    GenericBlock,
    UnnamedType,
    ReservedName(String),
    NoLagrangian,
    RayleighWithoutLagrangian,
    // Signatures.
    Qualifier(&'static str),
    Receiver(&'static str),
    Parameters { function: &'static str, expected: &'static str },
    NotAnArray(&'static str),
    NotAScalar,
    ZeroDegrees,
    OtherDegrees { expected: String },
    OtherScalar { expected: String },
    Returns { function: &'static str, expected: String },
    ParameterPattern,
    ParameterType,
    GenericHelper,
    HelperReturnsReference,
    // Bodies.
    TypeAlias,
    NestedItem,
    LocalConst,
    Macro,
    OutsideFunction(String),
    OutsideMethod(String),
    BareSelf,
    FieldAssignment,
    FieldBorrowedMutably,
    OtherFloat { expected: String },
    FloatPattern,
    Unsafe,
    Async,
}

impl Display for Mistake {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::UnknownOption => f.write_str("unknown option; write `rule = midpoint`, `rule = trapezoidal` a list `rule = [midpoint, trapezoidal]`, or `derivatives = auto`, `expanded`, `num_dual`"),
            Self::UnknownRule(rule) => write!(f, "unknown rule `{rule}`; the rules are `midpoint` and `trapezoidal`"),
            Self::RepeatedRule(rule) => write!(f, "rule `{rule}` is listed twice; remove one"),
            Self::NoRule => f.write_str("no rule is listed; write at least one, or leave the option out for `midpoint`"),
            Self::UnknownEngine(engine) if engine.is_empty() => f.write_str("write one of `derivatives = auto`, `expanded`, `num_dual`"),
            Self::UnknownEngine(engine) => write!(f, "unknown engine `{engine}`; write `derivatives = auto`, `expanded` or `num_dual`"),
            Self::NotLowered(reason) => write!(f, "derivatives cannot be written out: {reason}; or leave the derivatives to `derivatives = num_dual`"),
            Self::TooLong => f.write_str("the derivatives are too long to be written out; use `derivatives = num_dual`"),

            Self::WrongItem => f.write_str("`#[rayleigh_system]` goes on an `impl` block with `fn lagrangian`, or on one free function of (q, v, parameters…)"),
            Self::TraitImpl => f.write_str("`#[rayleigh_system]` goes on an inherent `impl` block; remove the trait"),
            Self::GenericBlock => f.write_str("a system cannot be generic; write the concrete type, one block for each"),
            Self::UnnamedType => f.write_str("the system must be a named struct of this crate"),
            Self::ReservedName(name) => write!(f, "`{name}` is a name that the generated code uses; give the system another one"),
            Self::NoLagrangian => f.write_str("no Lagrangian; add `fn lagrangian(&self, q: [f64; N], v: [f64; N]) -> f64`"),
            Self::RayleighWithoutLagrangian => f.write_str("a Rayleigh function alone is no system; put `fn lagrangian(&self, q: [f64; N], v: [f64; N]) -> f64` into the same block"),

            Self::Qualifier(word) => write!(f, "remove `{word}`: the function is evaluated over dual numbers as well"),
            Self::Receiver(function) => write!(f, "`{function}` takes `&self` as its first parameter"),
            Self::Parameters { function, expected } => write!(f, "`{function}` takes {expected}"),
            Self::NotAnArray(name) => write!(f, "`{name}` must be an array whose length is the number of degrees of freedom, such as `[f64; 2]`; write the array type out, an alias hides its length"),
            Self::NotAScalar => f.write_str("coordinates are `f64` or `f32`"),
            Self::ZeroDegrees => f.write_str("a system has at least one degree of freedom"),
            Self::OtherDegrees { expected } => write!(f, "this length differs from that of `lagrangian`'s `q`, which is `{expected}`"),
            Self::OtherScalar { expected } => write!(f, "the system is written in `{expected}`; use it here too"),
            Self::Returns { function, expected } => write!(f, "`{function}` returns {expected}"),
            Self::ParameterPattern => f.write_str("write a plain name here, and take the pattern apart with `let` in the body"),
            Self::ParameterType => f.write_str("a parameter is a number, a bool, or an array, tuple or reference of them; write the type out, an alias hides it"),
            Self::GenericHelper => f.write_str("a function that L, R or the force call cannot be generic; write the concrete types"),
            Self::HelperReturnsReference => f.write_str("return the value, not a reference: the plain function and the differentiated one share this body"),

            Self::TypeAlias => f.write_str("write the type out, such as `[f64; 2]`: an alias hides where `f64` stands"),
            Self::NestedItem => f.write_str("no items inside a differentiated body; make it a function or constant of the annotated block"),
            Self::LocalConst => f.write_str("no `const` or `static` inside a differentiated body; use `let`, or a constant of the annotated block"),
            Self::Macro => f.write_str("macros hide what they compute from the differentiation; write the expression out"),
            Self::OutsideFunction(name) => write!(f, "`{name}` is outside the annotated block and cannot be differentiated; move it into the block and call `Self::{name}`"),
            Self::OutsideMethod(name) => write!(f, "`{name}` is not a function of the annotated block and cannot be differentiated; move it into the block"),
            Self::BareSelf => f.write_str("use `self` only as `self.field` or `self.function(…)`"),
            Self::FieldAssignment => f.write_str("L, R and forces are functions: they cannot assign to a field; copy it to a local with `let mut`"),
            Self::FieldBorrowedMutably => f.write_str("L, R and forces are functions: they cannot borrow a field mutably; copy it to a local with `let mut`"),
            Self::OtherFloat { expected } => write!(f, "this system is written in `{expected}`; a detour through another precision would lose digits and derivatives"),
            Self::FloatPattern => f.write_str("a floating-point number cannot be matched by a pattern here; compare it with `if`"),
            Self::Unsafe => f.write_str("no `unsafe` inside a differentiated body"),
            Self::Async => f.write_str("no `async` inside a differentiated body"),
        }
    }
}

/// The span of anything that has tokens.
pub fn span_of(tokens: &impl ToTokens) -> Span {
    tokens.to_token_stream().span()
}
