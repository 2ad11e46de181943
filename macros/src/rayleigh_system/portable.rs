//! Bodies whose elementary functions are the runtime's: where there is no standard library, or its functions
//! are not wanted.
//!
//! | written | becomes |
//! |---|---|
//! | `x.sin()` | `x.elementary().sin()` |
//! | `f64::sin(x)`, `.map(f64::sin)` | `<f64 as ::dalembert::generated::Elementary>::sin(x)` |
//!
//! Methods of `f64` itself come before those of a trait: an import alone would leave `x.sin()` to the
//! standard library wherever there is one.

use proc_macro2::{TokenStream, TokenTree};
use quote::{ToTokens, quote};
use syn::visit_mut::{self, VisitMut};
use syn::{Block, Expr, ExprMethodCall, ExprPath, Ident, ImplItem, ItemFn, ItemImpl, parse_quote};
use syn::{parse_quote_spanned, spanned::Spanned};

use super::functions::is_elementary;

/// The user's block, `functions` of it with the runtime's elementary functions.
pub fn block(item: &ItemImpl, functions: &[Ident]) -> ItemImpl {
    let mut item = item.clone();
    for function in &mut item.items {
        if let ImplItem::Fn(function) = function
            && functions.contains(&function.sig.ident)
        {
            body(&mut function.block);
        }
    }
    item
}

/// The user's function with the runtime's elementary functions.
pub fn function(item: &ItemFn) -> ItemFn {
    let mut item = item.clone();
    body(&mut item.block);
    item
}

/// The expression with the runtime's elementary functions, if it calls one.
pub fn text(expression: &TokenStream) -> Option<TokenStream> {
    if !mentions_elementary(expression.clone()) {
        return None;
    }
    let mut expression: Expr = syn::parse2(expression.clone()).ok()?;
    let mut portable = Portable { calls_method: false };
    portable.visit_expr_mut(&mut expression);
    portable.calls_method.then(|| expression.into_token_stream())
}

fn mentions_elementary(tokens: TokenStream) -> bool {
    tokens.into_iter().any(|token| match token {
        TokenTree::Ident(word) => is_elementary(&word.to_string()),
        TokenTree::Group(group) => mentions_elementary(group.stream()),
        _ => false,
    })
}

fn body(block: &mut Block) {
    let mut portable = Portable { calls_method: false };
    portable.visit_block_mut(block);
    if portable.calls_method {
        block.stmts.insert(
            0,
            parse_quote!(
                use ::dalembert::generated::Elementary as _;
            ),
        );
    }
}

struct Portable {
    calls_method: bool,
}

impl VisitMut for Portable {
    fn visit_expr_method_call_mut(&mut self, call: &mut ExprMethodCall) {
        visit_mut::visit_expr_method_call_mut(self, call);
        if is_elementary(&call.method.to_string()) {
            self.calls_method = true;
            let receiver = &call.receiver;
            *call.receiver = parse_quote_spanned!(call.method.span()=> #receiver.elementary());
        }
    }

    fn visit_expr_mut(&mut self, expression: &mut Expr) {
        visit_mut::visit_expr_mut(self, expression);
        if let Expr::Path(path) = expression
            && let Some(replacement) = function_of_scalar(path)
        {
            *expression = replacement;
        }
    }
}

/// `f64::sin` → `<f64 as ::dalembert::generated::Elementary>::sin`.
fn function_of_scalar(path: &ExprPath) -> Option<Expr> {
    let mut segments = path.path.segments.iter().rev();
    let (function, scalar) = (segments.next()?, segments.next()?);
    // `core::primitive::f64::sin`, or no module at all.
    let in_module = segments.next().is_some_and(|module| module.ident != "primitive");
    let is_scalar = scalar.ident == "f64" || scalar.ident == "f32";
    if in_module || !is_scalar || !is_elementary(&function.ident.to_string()) {
        return None;
    }
    let (function, scalar) = (&function.ident, &scalar.ident);
    let owner = quote!(<#scalar as ::dalembert::generated::Elementary>);
    Some(parse_quote_spanned!(path.span()=> #owner::#function))
}
