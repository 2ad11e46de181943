//! Expressions, paths and types told by their form alone: literals, places of `self`, names of the standard
//! library.

use proc_macro2::{Group, Span, TokenStream, TokenTree};
use quote::quote;
use syn::parse::{Parse, ParseStream};
use syn::visit_mut::VisitMut;
use syn::{
    BinOp, Expr, ExprLit, Ident, Lit, Pat, Path, PathArguments, Token, Type, UnOp, parse_quote_spanned,
};

/// Parentheses that a function's argument does not need, and that would warn there.
pub fn without_parentheses(expression: &Expr) -> &Expr {
    match expression {
        Expr::Paren(inner) => without_parentheses(&inner.expr),
        _ => expression,
    }
}

/// An expression of floating-point literals alone.
pub fn is_plain(expression: &Expr) -> bool {
    match expression {
        Expr::Lit(ExprLit { lit, .. }) => is_float_literal(lit),
        Expr::Unary(unary) => matches!(unary.op, UnOp::Neg(_)) && is_plain(&unary.expr),
        Expr::Paren(inner) => is_plain(&inner.expr),
        Expr::Group(inner) => is_plain(&inner.expr),
        Expr::Binary(binary) => {
            is_arithmetic(&binary.op) && is_plain(&binary.left) && is_plain(&binary.right)
        }
        _ => false,
    }
}

pub fn is_float_literal(literal: &Lit) -> bool {
    match literal {
        Lit::Float(_) => true,
        Lit::Int(integer) => matches!(integer.suffix(), "f64" | "f32"),
        _ => false,
    }
}

/// Whether a plain expression names a precision that is not `scalar`.
pub fn is_of_other_float(expression: &Expr, scalar: &Ident) -> bool {
    match expression {
        Expr::Lit(ExprLit { lit: Lit::Float(number), .. }) => {
            !number.suffix().is_empty() && scalar != number.suffix()
        }
        Expr::Lit(ExprLit { lit: Lit::Int(number), .. }) => scalar != number.suffix(),
        Expr::Unary(unary) => is_of_other_float(&unary.expr, scalar),
        Expr::Paren(inner) => is_of_other_float(&inner.expr, scalar),
        Expr::Group(inner) => is_of_other_float(&inner.expr, scalar),
        Expr::Binary(binary) => {
            is_of_other_float(&binary.left, scalar) || is_of_other_float(&binary.right, scalar)
        }
        _ => false,
    }
}

pub fn is_arithmetic(operator: &BinOp) -> bool {
    matches!(operator, BinOp::Add(_) | BinOp::Sub(_) | BinOp::Mul(_) | BinOp::Div(_))
}

pub fn is_assignment(operator: &BinOp) -> bool {
    matches!(
        operator,
        BinOp::AddAssign(_)
            | BinOp::SubAssign(_)
            | BinOp::MulAssign(_)
            | BinOp::DivAssign(_)
            | BinOp::RemAssign(_)
            | BinOp::BitAndAssign(_)
            | BinOp::BitOrAssign(_)
            | BinOp::BitXorAssign(_)
            | BinOp::ShlAssign(_)
            | BinOp::ShrAssign(_)
    )
}

pub fn is_self(expression: &Expr) -> bool {
    matches!(expression, Expr::Path(path) if path.path.is_ident("self"))
}

/// `self.field`, `self.field[i]`, `self.field.0`.
pub fn is_place_of_self(expression: &Expr) -> bool {
    match expression {
        Expr::Field(field) => is_self(&field.base) || is_place_of_self(&field.base),
        Expr::Index(index) => is_place_of_self(&index.expr),
        Expr::Paren(inner) => is_place_of_self(&inner.expr),
        _ => false,
    }
}

/// Names in capitals are constants.
pub fn is_constant_name(name: &Ident) -> bool {
    let name = name.to_string();
    name.contains(char::is_uppercase) && !name.contains(char::is_lowercase)
}

/// A path such as `Law::Linear`, unless it is one of the standard library's that bodies may hold.
pub fn is_variant(path: &Path) -> bool {
    path.segments.last().is_some_and(|last| last.ident.to_string().contains(char::is_lowercase))
        && is_variant_with_fields(path)
}

/// [`is_variant`] of a path with fields behind it: `Law::A(k)` may be in capitals, and is no constant.
pub fn is_variant_with_fields(path: &Path) -> bool {
    let Some(last) = path.segments.last() else { return false };
    let name = last.ident.to_string();
    let of_std = ["Option", "Ordering", "Result"].iter().any(|ty| path.segments[0].ident == ty)
        || ["Some", "None", "Ok", "Err"].iter().any(|variant| name == *variant)
        || ["std", "core"].iter().any(|root| path.segments[0].ident == root)
        || path.is_ident("Self");
    !of_std && name.starts_with(char::is_uppercase)
}

/// Methods whose argument is often a function's name.
pub fn takes_function(method: &Ident) -> bool {
    const METHODS: &[&str] = &[
        "map",
        "for_each",
        "filter_map",
        "flat_map",
        "fold",
        "reduce",
        "scan",
        "map_while",
        "inspect",
        "filter",
        "any",
        "all",
        "position",
        "and_then",
        "unwrap_or_else",
        "map_or",
        "zip_with",
    ];
    METHODS.iter().any(|known| method == known)
}

/// Methods that floating-point numbers alone have, and that have no derivative.
pub const ROUNDING: &[&str] =
    &["ceil", "floor", "fract", "next_down", "next_up", "round", "round_ties_even", "to_bits", "trunc"];

/// Remainders that floating-point numbers and integers share.
pub const EUCLIDEAN: &[&str] = &["div_euclid", "rem_euclid"];

/// Whether a method of floating-point numbers jumps: of fields and constants alone it is a number.
pub fn jumps(method: &Ident) -> bool {
    ROUNDING.iter().chain(EUCLIDEAN).any(|name| method == name)
}

/// Functions of the standard library that work on any type, by their last two segments; and those of
/// integers.
pub fn is_function_of_std(path: &Path) -> bool {
    const GENERIC: &[(&str, &str)] = &[
        ("array", "from_fn"),
        ("iter", "empty"),
        ("iter", "from_fn"),
        ("iter", "once"),
        ("iter", "repeat"),
        ("iter", "repeat_n"),
        ("iter", "successors"),
        ("iter", "zip"),
        ("mem", "replace"),
        ("mem", "swap"),
        ("mem", "take"),
        ("Default", "default"),
        ("Vec", "new"),
        ("Vec", "with_capacity"),
    ];
    let mut segments = path.segments.iter().rev();
    let (Some(last), Some(module)) = (segments.next(), segments.next()) else { return false };
    let integer: Type =
        Type::Path(syn::TypePath { attrs: Vec::new(), qself: None, path: module.ident.clone().into() });
    is_integer(&integer) || GENERIC.iter().any(|(from, name)| module.ident == from && last.ident == name)
}

/// Types of the standard library that hold others.
pub fn is_generic_of_std(path: &Path) -> bool {
    path.segments.last().is_some_and(|segment| {
        ["Option", "Vec", "Result", "Box"].iter().any(|name| segment.ident == name)
            && matches!(segment.arguments, PathArguments::AngleBracketed(_))
    })
}

pub fn real_type(span: Span) -> Type {
    parse_quote_spanned!(span=> Real<D>)
}

/// An identifier, raw where the name is a keyword.
pub fn identifier(name: &str, span: Span) -> Ident {
    match name.strip_prefix("r#") {
        Some(raw) => Ident::new_raw(raw, span),
        None => Ident::new(name, span),
    }
}

/// The arguments of `matches!`.
pub struct Matches {
    pub value: Expr,
    pub pattern: Pat,
    pub guard: Option<Expr>,
}

impl Parse for Matches {
    fn parse(input: ParseStream) -> syn::Result<Self> {
        let value = input.parse()?;
        input.parse::<Token![,]>()?;
        let pattern = Pat::parse_multi_with_leading_vert(input)?;
        let guard = if input.peek(Token![if]) {
            input.parse::<Token![if]>()?;
            Some(input.parse()?)
        } else {
            None
        };
        input.parse::<Option<Token![,]>>()?;
        Ok(Self { value, pattern, guard })
    }
}

/// A group of other tokens in the place of `group`.
pub fn regrouped(group: &Group, tokens: TokenStream) -> TokenTree {
    let mut own = Group::new(group.delimiter(), tokens);
    own.set_span(group.span());
    TokenTree::Group(own)
}

/// The tokens, with others for words that `by` has some for. `self` that begins a path, as in `self::G`, is
/// not asked for: it is no receiver.
pub fn with_words(tokens: TokenStream, by: &dyn Fn(&Ident) -> Option<TokenStream>) -> TokenStream {
    let mut replaced = TokenStream::new();
    let mut tokens = tokens.into_iter().peekable();
    while let Some(token) = tokens.next() {
        let begins_path = matches!(tokens.peek(), Some(TokenTree::Punct(mark)) if mark.as_char() == ':');
        match token {
            TokenTree::Ident(word) if !(word == "self" && begins_path) => {
                replaced.extend(by(&word).unwrap_or_else(|| quote!(#word)));
            }
            TokenTree::Group(group) => replaced.extend([regrouped(&group, with_words(group.stream(), by))]),
            other => replaced.extend([other]),
        }
    }
    replaced
}

/// The name of a type that is one plain identifier.
pub fn simple_name(ty: &Type) -> Option<&Ident> {
    match ty {
        Type::Path(path) if path.qself.is_none() => path.path.get_ident(),
        Type::Group(group) => simple_name(&group.elem),
        Type::Paren(paren) => simple_name(&paren.elem),
        _ => None,
    }
}

/// Whether the type is a primitive integer.
pub fn is_integer(ty: &Type) -> bool {
    const INTEGERS: [&str; 12] =
        ["i8", "i16", "i32", "i64", "i128", "isize", "u8", "u16", "u32", "u64", "u128", "usize"];
    simple_name(ty).is_some_and(|name| INTEGERS.iter().any(|integer| name == integer))
}

/// Whether a value of the type holds floating-point numbers; others are the same in both worlds.
pub fn has_floats(ty: &Type) -> bool {
    match ty {
        Type::Array(array) => has_floats(&array.elem),
        Type::Tuple(tuple) => tuple.elems.iter().any(has_floats),
        Type::Reference(reference) => has_floats(&reference.elem),
        Type::Paren(inner) => has_floats(&inner.elem),
        Type::Group(inner) => has_floats(&inner.elem),
        ty => simple_name(ty).is_some_and(|name| name == "f64" || name == "f32"),
    }
}

/// `Self` replaced by the name of the system: impl headers do not know it.
pub fn with_self_named(length: &Expr, system: &Ident) -> Expr {
    struct Named<'n>(&'n Ident);
    impl VisitMut for Named<'_> {
        fn visit_ident_mut(&mut self, ident: &mut Ident) {
            if ident == "Self" {
                *ident = Ident::new(&self.0.to_string(), ident.span());
            }
        }
    }
    let mut length = length.clone();
    Named(system).visit_expr_mut(&mut length);
    length
}
