//! Every message of the macro, and where they are collected.
//!
//! A message says what is wrong at the token and what to write instead.

use std::fmt::Display;

use proc_macro2::{Span, TokenStream};
use quote::ToTokens;
use syn::spanned::Spanned;
use syn::{Error, Ident};

use super::rules::{GAUSS, Rule};

/// The mistakes found, in order of discovery; shown all in one compile.
#[derive(Default)]
pub struct Report {
    errors: Option<Error>,
    count: usize,
    /// How many of them are none where derivatives are written out.
    of_duals: usize,
    /// Functions whose bodies hold mistakes.
    bodies: Vec<String>,
}

impl Report {
    pub fn is_empty(&self) -> bool {
        self.errors.is_none()
    }

    /// How many mistakes there are so far.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Notes that the body of `function` holds mistakes: rustc shall not speak of them too.
    pub fn mark_body(&mut self, function: &Ident) {
        self.bodies.push(function.to_string());
    }

    /// Whether the body of `function` was marked.
    pub fn has_mistakes_in(&self, function: &Ident) -> bool {
        self.bodies.iter().any(|body| function == body)
    }

    /// Whether all mistakes are none where derivatives are written out.
    pub fn is_limit_of_duals(&self) -> bool {
        self.count > 0 && self.of_duals == self.count
    }

    /// Records `mistake` at `tokens`.
    pub fn at(&mut self, tokens: &impl ToTokens, mistake: Mistake) {
        self.of_duals += usize::from(mistake.is_of_duals());
        self.error(Error::new_spanned(tokens, mistake));
    }

    /// Records `mistake` at `span`.
    pub fn at_span(&mut self, span: Span, mistake: Mistake) {
        self.error(Error::new(span, mistake));
    }

    /// Records an error of syn's own.
    pub fn error(&mut self, error: Error) {
        self.count += 1;
        match &mut self.errors {
            Some(errors) => errors.combine(error),
            None => self.errors = Some(error),
        }
    }

    /// `compile_error!` for each mistake.
    pub fn to_tokens(&self) -> TokenStream {
        self.errors.as_ref().map(Error::to_compile_error).unwrap_or_default()
    }
}

/// A mistake in an annotated item.
pub enum Mistake {
    // The attribute.
    UnknownOption,
    RepeatedOption(String),
    UnknownRule(String),
    RepeatedRule(String),
    NoRule,
    JointRule { rule: String, lacks: &'static str },
    Constrained { lacks: &'static str },
    Kinks { lacks: &'static str },
    Kink { fault: &'static str },
    KinkByOther { rule: String },
    ConstraintCount { constraints: usize, coordinates: usize },
    ConstraintOnceMore { other: usize, factor: f64 },
    ConstraintWithoutCoordinate,
    ConstraintWithoutVelocity,
    NotLinearInVelocity,
    UnknownEngine(String),
    UnknownOrder,
    UnknownLanes,
    RepeatedLanes(String),
    Lanes { word: String, lacks: &'static str },
    UnknownMultiplyAdd,
    FusedByNumDual,
    FusedByLibm,
    NoParameters,
    ParametersByNumDual,
    NoSuchParameter(String),
    HiddenParameter { parameter: String, within: String },
    NotLowered { reason: String, by_duals: bool },
    NeedsDuals(String),
    NumDualWithoutStd,
    NotLoweredWithoutStd(String),
    FieldWithoutStd,
    // The item.
    TooDeep { most: usize },
    WrongItem,
    WrongField,
    FieldOption,
    TraitImpl,
    GenericBlock,
    UnnamedType,
    Condition(String),
    NoLagrangian,
    RayleighWithoutLagrangian,
    // Signatures.
    Qualifier(&'static str),
    Receiver(&'static str),
    Parameters { function: &'static str, expected: &'static str },
    OtherPlace { name: String, known: &'static str, place: &'static str },
    NoConstant(String),
    TimeByAnotherName(String),
    NotAnArray(&'static str),
    NotAScalar,
    ZeroDegrees,
    NotATime { scalar: String },
    NotAnInput { scalar: String },
    InputOfFunction,
    OtherInput { expected: String },
    NoInputs,
    GeneratedFunction(String),
    OtherDegrees { expected: String },
    OtherScalar { expected: String },
    Returns { function: &'static str, expected: String },
    FunctionParameters { scalar: &'static str },
    FunctionReturns { scalar: String },
    FieldParameters,
    FieldReturns { scalar: String, degrees: String },
    ParameterPattern,
    ParameterType,
    ParameterSlice { scalar: String },
    ParameterChanged,
    FieldByReference,
    GenericHelper,
    HelperReturnsReference,
    // Bodies.
    TypeAlias,
    NestedItem,
    LocalConst,
    Macro,
    VariantByDuals,
    StructByDuals,
    OutsideFunction { path: String, name: String },
    OutsideMethod(String),
    OutsideOfFunction { path: String, name: String, scalar: String },
    WithoutSelf { name: String, call: String },
    MethodAsFunction { method: String, scalar: String },
    TwinName(String),
    BareSelf,
    FieldAssignment,
    FieldBorrowedMutably,
    Rounding(String),
    OtherFloat { expected: String },
    FloatPattern,
    Unsafe,
    Async,
}

impl Mistake {
    /// Whether it is one for dual numbers alone.
    fn is_of_duals(&self) -> bool {
        matches!(
            self,
            Self::ParameterPattern
                | Self::ParameterType
                | Self::ParameterSlice { .. }
                | Self::HelperReturnsReference
                | Self::VariantByDuals
                | Self::StructByDuals
        )
    }
}

impl Display for Mistake {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::UnknownOption => f.write_str("unknown option; write `rule = midpoint`, `trapezoidal` or `gauss`, a list `rule = [midpoint, trapezoidal]`, `derivatives = auto`, `expanded`, `num_dual`, `parameters = [m, k]`, `step_derivatives = second`, `lanes = explicit`, `midpoint`, `gauss`, `multiply_add = fused`, or `crate = path`"),
            Self::RepeatedOption(option) => {
                write!(f, "`{option}` is given twice; ")?;
                match &**option {
                    "rule" => f.write_str("write one list, such as `rule = [midpoint, gauss]`"),
                    "lanes" => f.write_str("write one list, such as `lanes = [explicit, gauss]`"),
                    "parameters" => f.write_str("write one list, such as `parameters = [m, k]`"),
                    _ => f.write_str("remove one"),
                }
            }
            Self::UnknownRule(rule) => {
                let [first, second, others @ .., last] = Rule::ALL.map(|rule| rule.entry().word);
                let others = others.join("`, `");
                write!(f, "unknown rule `{rule}`; the rules are `{first}`, `{second}`, `{GAUSS}`, `{others}` and `{last}`; one of your own is not listed: `system.by(Quadrature(rule), h)` steps by it")
            }
            Self::RepeatedRule(rule) => write!(f, "rule `{rule}` is listed twice; remove one"),
            Self::JointRule { rule, lacks } => write!(f, "`rule = {rule}` {lacks}; use `midpoint`, `trapezoidal` or `gauss`"),
            Self::Constrained { lacks } => write!(f, "constraints {lacks}"),
            Self::Kinks { lacks } => write!(f, "`rule = proximal` {lacks}"),
            Self::Kink { fault } => f.write_str(fault),
            Self::KinkByOther { rule } => write!(f, "`rule = {rule}` has no step where R has a kink and the motion stops; leave it out: `proximal` takes all of R"),
            Self::ConstraintCount { constraints: 0, .. } => f.write_str("there is no constraint in the array; remove the function"),
            Self::ConstraintCount { constraints, coordinates } => write!(f, "{constraints} constraints on {coordinates} coordinates leave no motion; write fewer"),
            Self::ConstraintOnceMore { other, factor: 1.0 } => write!(f, "this is constraint {other} once more, counted from 0; remove it"),
            Self::ConstraintOnceMore { other, factor } => write!(f, "this is constraint {other} times {factor}, counted from 0: it holds nothing more; remove it"),
            Self::ConstraintWithoutCoordinate => f.write_str("no coordinate stands in this constraint: it holds nothing; remove it, or write it in `q`"),
            Self::ConstraintWithoutVelocity => f.write_str("no velocity stands in this constraint; write it as one of `constraints`, or remove it"),
            Self::NotLinearInVelocity => f.write_str("a velocity constraint is linear in `v`, as A(q) v = 0 or A(q) v = b(q, t), and this one is not"),
            Self::NoRule => f.write_str("no rule is listed; write at least one, or leave the option out for `midpoint`"),
            Self::UnknownEngine(engine) if engine.is_empty() => f.write_str("write one of `derivatives = auto`, `expanded`, `num_dual`"),
            Self::UnknownEngine(engine) => write!(f, "unknown engine `{engine}`; write `derivatives = auto`, `expanded` or `num_dual`"),
            Self::UnknownOrder => f.write_str("write `step_derivatives = first` or `step_derivatives = second`"),
            Self::UnknownLanes => f.write_str("write `lanes = explicit`, `lanes = midpoint`, `lanes = gauss` or a list, `lanes = [explicit, gauss]`, or leave the option out where members are not stepped in lanes"),
            Self::RepeatedLanes(word) => write!(f, "`{word}` is listed twice; remove one"),
            Self::Lanes { word, lacks } => write!(f, "`lanes = {word}` {lacks}; or leave the option out"),
            Self::UnknownMultiplyAdd => f.write_str("write `multiply_add = fused`, or leave the option out: products and sums are then rounded apart"),
            Self::FusedByNumDual => f.write_str("sums are fused where derivatives are written out; use `derivatives = expanded` with it, or leave the option out"),
            Self::FusedByLibm => f.write_str("without `std` and with the feature `libm` a function stands for the instruction, many times as slow; leave the option out, or take the platform's functions"),
            Self::NoParameters => f.write_str("no parameter is listed; write fields of the system, such as `parameters = [m, k]`, or leave the option out"),
            Self::ParametersByNumDual => f.write_str("derivatives by parameters are written out at compile time; use `derivatives = expanded` with them"),
            Self::NoSuchParameter(parameter) => write!(f, "neither L, R, f nor a constraint reads the number `self.{parameter}`; list fields that they read, entries of an array one by one, such as `c[0]`"),
            Self::HiddenParameter { parameter, within } => write!(f, "`{within}` hides how it depends on `{parameter}`; read the number itself, such as `self.{parameter}`"),
            Self::NotLowered { reason, by_duals: true } => write!(f, "derivatives cannot be written out: {reason}; or leave the derivatives to `derivatives = num_dual`"),
            Self::NotLowered { reason, by_duals: false } => write!(f, "derivatives cannot be written out: {reason}"),
            Self::NeedsDuals(reason) => write!(f, "dual numbers would have to stand in, since derivatives cannot be written out: {reason}"),

            Self::NumDualWithoutStd => f.write_str("num-dual needs the standard library; use `derivatives = expanded`, or the feature `std` of dalembert"),
            Self::NotLoweredWithoutStd(reason) => write!(f, "derivatives cannot be written out: {reason}; num-dual would need the feature `std` of dalembert"),
            Self::FieldWithoutStd => f.write_str("`#[differentiable]` takes its derivatives from num-dual, which needs the feature `std` of dalembert; put `#[cfg(feature = …)]` on the function where it is built without"),

            Self::TooDeep { most } => write!(f, "more than {most} operators and brackets stand one within the other up to here; give parts of the expression names with `let`, or compute it in a loop"),
            Self::WrongItem => f.write_str("`#[rayleigh_system]` goes on an `impl` block with `fn lagrangian`, or on one free function of (q, v, parameters…)"),
            Self::WrongField => f.write_str("`#[differentiable]` goes on one free function of (q, parameters…)"),
            Self::FieldOption => f.write_str("`#[differentiable]` has no options but `crate = path`; remove this"),
            Self::TraitImpl => f.write_str("`#[rayleigh_system]` goes on an inherent `impl` block; remove the trait"),
            Self::GenericBlock => f.write_str("a system cannot be generic; write a struct of concrete numbers, such as `struct System { m: f64 }`"),
            Self::UnnamedType => f.write_str("the system must be a plain named type, without type arguments and lifetimes; write a struct that owns its numbers"),
            Self::Condition(word) => write!(f, "`#[{word}]` is not decided yet where `#[rayleigh_system]` reads this: configured-out code would be differentiated; put the condition on the whole item and write one item for each case, or choose with `if` by a constant"),
            Self::NoLagrangian => f.write_str("no Lagrangian; add `fn lagrangian(&self, q: [f64; N], v: [f64; N]) -> f64`"),
            Self::RayleighWithoutLagrangian => f.write_str("a Rayleigh function alone is no system; put `fn lagrangian(&self, q: [f64; N], v: [f64; N]) -> f64` into the same block"),

            Self::Qualifier(word) => write!(f, "remove `{word}`: the function is evaluated over dual numbers as well"),
            Self::Receiver(function) => write!(f, "`{function}` takes `&self` as its first parameter"),
            Self::Parameters { function, expected } => write!(f, "`{function}` takes {expected}"),
            Self::NotAnArray(name) => write!(f, "`{name}` must be an array whose length is the number of degrees of freedom, such as `[f64; 2]`; write the array type out, an alias hides its length"),
            Self::NotAScalar => f.write_str("coordinates are `f64` or `f32`"),
            Self::ZeroDegrees => f.write_str("a system has at least one degree of freedom"),
            Self::NotATime { scalar } => write!(f, "the time is one number; write `t: {scalar}`"),
            Self::NotAnInput { scalar } => write!(f, "an input is an array that comes before the time, such as `u: [{scalar}; 1]`; a time is `t: {scalar}`"),
            Self::InputOfFunction => f.write_str("inputs act through `force`: take the input there, as `fn force(&self, q: [f64; N], v: [f64; N], u: [f64; M])`; L and R may take a time `t: f64`"),
            Self::OtherInput { expected } => write!(f, "this length differs from that of the input of `force`, which is `{expected}`"),
            Self::NoInputs => f.write_str("an input has at least one entry; leave it out if there is none"),
            Self::GeneratedFunction(name) => write!(f, "the generated code adds a function `{name}`; choose another name for this one"),
            Self::OtherDegrees { expected } => write!(f, "this length differs from that of `q`, which is `{expected}`"),
            Self::OtherScalar { expected } => write!(f, "the system is written in `{expected}`; use it here too"),
            Self::Returns { function, expected } => write!(f, "`{function}` returns {expected}"),
            Self::NoConstant(name) => write!(f, "`{name}` would become a constant, a field of the generated struct; a system with an input or a time is an `impl` block, whose functions take `u: [f64; M]` and `t: f64` after v; give a constant another name"),
            Self::OtherPlace { name, known, place } => write!(f, "arguments go by their place, and at this one is {place}, while `{name}` is the name of {known}; change the order, or the name"),
            Self::TimeByAnotherName(name) => write!(f, "a number after v is the time, and that is called `t`; if `{name}` is an input, write an array such as `[f64; 1]`, if it is a constant, a field of the system"),
            Self::FunctionParameters { scalar } => write!(f, "a system takes `q: [{scalar}; N]` and `v: [{scalar}; N]` first, then its parameters"),
            Self::FunctionReturns { scalar } => write!(f, "a system returns `{scalar}` for L alone, or `({scalar}, {scalar})` for L and the Rayleigh function"),
            Self::FieldParameters => f.write_str("a differentiable function takes `q: [f64; N]` first, then its parameters"),
            Self::FieldReturns { scalar, degrees } => write!(f, "a differentiable function returns `[{scalar}; {degrees}]` for a vector field, or `{scalar}` for a scalar one"),
            Self::ParameterPattern => f.write_str("write a plain name here, and take the pattern apart with `let` in the body"),
            Self::ParameterType => f.write_str("a parameter is a number, a bool, or an array, tuple or reference of them; write the type out, an alias hides it"),
            Self::ParameterSlice { scalar } => write!(f, "a slice hides its length; write a reference to an array, such as `&[{scalar}; 2]`"),
            Self::FieldByReference => f.write_str("this parameter becomes a field of the generated struct; take it by value"),
            Self::ParameterChanged => f.write_str("a differentiated function cannot change its argument; take the value and return the new one"),
            Self::GenericHelper => f.write_str("a function that L, R or the force call cannot be generic; write the concrete types"),
            Self::HelperReturnsReference => f.write_str("return the value, not a reference: the plain function and the differentiated one share this body"),

            Self::TypeAlias => f.write_str("write the type out, such as `[f64; 2]`: an alias hides where `f64` stands"),
            Self::NestedItem => f.write_str("no items inside a differentiated body; make it a function or constant of the annotated block"),
            Self::LocalConst => f.write_str("no `const` or `static` inside a differentiated body; use `let`, or a constant of the annotated block"),
            Self::Macro => f.write_str("macros hide what they compute from the differentiation; write the expression out"),
            Self::VariantByDuals => f.write_str("dual numbers cannot follow values that are no numbers, such as an enum; choose by an integer or an `Option` here"),
            Self::StructByDuals => f.write_str("dual numbers cannot follow a struct; read its numbers from `self`, as in `self.spring.k`"),
            Self::OutsideFunction { path, name } => write!(f, "`{path}` is outside the annotated block and cannot be differentiated; move it into the block and call `Self::{name}`"),
            Self::OutsideOfFunction { path, name, scalar } => write!(f, "`{path}` is another function and cannot be differentiated; write it as a closure in this body, such as `let {name} = |x: {scalar}| …;`"),
            Self::OutsideMethod(name) => write!(f, "`{name}` is not a function of the annotated block and cannot be differentiated; move it into the block"),
            Self::WithoutSelf { name, call } => write!(f, "`{name}` is a function of the annotated block; call it as `{call}`"),
            Self::MethodAsFunction { method, scalar } => {
                let (one, all) = match &**method {
                    "clamp" | "mul_add" => ("a, b", "x, a, b"),
                    "atan2" | "copysign" | "hypot" | "log" | "max" | "min" | "powf" => ("y", "x, y"),
                    "powi" => ("n", "x, n"),
                    _ => ("", "x"),
                };
                write!(f, "`{method}` is a method; write `x.{method}({one})` or `{scalar}::{method}({all})`")
            }
            Self::TwinName(name) => write!(f, "`{name}` is the name of the differentiated twin of a function of this block; choose another one"),
            Self::BareSelf => f.write_str("use `self` only as `self.field` or `self.function(…)`"),
            Self::FieldAssignment => f.write_str("L, R and forces are functions: they cannot assign to a field; copy it to a local with `let mut`"),
            Self::FieldBorrowedMutably => f.write_str("L, R and forces are functions: they cannot borrow a field mutably; copy it to a local with `let mut`"),
            Self::Rounding(method) => write!(f, "`{method}` has no derivative, unless it is of fields and constants alone; leave it out, or choose between smooth cases with `if`"),
            Self::OtherFloat { expected } => write!(f, "this system is written in `{expected}`; a detour through another precision would lose digits and derivatives"),
            Self::FloatPattern => f.write_str("a floating-point number cannot be matched by a pattern here; compare it with `if`"),
            Self::Unsafe => f.write_str("no `unsafe` inside a differentiated body"),
            Self::Async => f.write_str("no `async` inside a differentiated body"),
        }
    }
}

/// A message about dual numbers, beside the mistakes.
pub enum Note {
    /// Dual numbers make the derivatives, and nobody asked for them.
    DualNumbers { system: String, reason: String },
    /// A step by dual numbers would overflow the stack.
    TooManyForDualNumbers { most: usize },
    /// Each fused sum is a call.
    FusedByCalls,
}

impl Display for Note {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::DualNumbers { system, reason } => write!(
                f,
                "the derivatives of `{system}` are made by dual numbers when the program runs, because {reason}. A step then takes twice as long for two coordinates, and hundreds of times as long for nine. Either rewrite what is marked, so that the derivatives can be written out; or say that dual numbers are meant, with `derivatives = num_dual`; or make this an error, with `derivatives = expanded`"
            ),
            Self::TooManyForDualNumbers { most } => write!(
                f,
                "with more than {most} coordinates dual numbers can overflow the stack of a thread; have the derivatives written out: `derivatives = expanded` says what stands in the way"
            ),
            Self::FusedByCalls => f.write_str(
                "this build is for processors without an instruction for fused sums: each is the call of a function, and a step takes up to 9 times as long. Build for your processor, `RUSTFLAGS=\"-C target-cpu=native\"`, or with `-C target-feature=+fma`; or leave the option out"
            ),
        }
    }
}

/// The span of anything that has tokens.
pub fn span_of(tokens: &impl ToTokens) -> Span {
    tokens.to_token_stream().span()
}
