//! Methods that are none of the standard library's: of a trait of one's own, or of a struct of the system.

use std::collections::{BTreeMap, HashSet};

use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::visit::{self, Visit};
use syn::{Expr, ExprMethodCall, Ident, ImplItemFn, Local, Pat, PatSlice, PatType};

use crate::rayleigh_system::functions::is_known;
use crate::rayleigh_system::syntax::{jumps, simple_name, without_parentheses};

/// Methods of the standard library on what bodies are made of. A name that is left out costs the way below
/// for a constant whose method hands out references, and nothing else.
const OF_STD: &[&str] = &[
    "add",
    "add_assign",
    "all",
    "and",
    "and_then",
    "any",
    "as_array",
    "as_chunks",
    "as_deref",
    "as_flattened",
    "as_mut",
    "as_ref",
    "as_slice",
    "binary_search",
    "binary_search_by",
    "binary_search_by_key",
    "borrow",
    "by_ref",
    "chain",
    "chunk_by",
    "chunks",
    "chunks_exact",
    "classify",
    "clone",
    "clone_from",
    "cloned",
    "cmp",
    "collect",
    "concat",
    "contains",
    "copied",
    "count",
    "cycle",
    "deref",
    "div",
    "div_assign",
    "each_mut",
    "each_ref",
    "ends_with",
    "enumerate",
    "eq",
    "expect",
    "extend",
    "fill",
    "filter",
    "filter_map",
    "find",
    "find_map",
    "first",
    "first_chunk",
    "flat_map",
    "flatten",
    "fmt",
    "fold",
    "for_each",
    "fuse",
    "ge",
    "get",
    "get_mut",
    "get_or_insert",
    "gt",
    "index",
    "insert",
    "inspect",
    "into",
    "into_iter",
    "is_empty",
    "is_finite",
    "is_infinite",
    "is_nan",
    "is_negative",
    "is_none",
    "is_none_or",
    "is_normal",
    "is_positive",
    "is_sign_negative",
    "is_sign_positive",
    "is_some",
    "is_some_and",
    "is_sorted",
    "is_sorted_by",
    "is_sorted_by_key",
    "is_subnormal",
    "isqrt",
    "iter",
    "iter_mut",
    "join",
    "last",
    "last_chunk",
    "last_mut",
    "le",
    "len",
    "lt",
    "map",
    "map_or",
    "map_or_default",
    "map_or_else",
    "map_while",
    "max_by",
    "max_by_key",
    "midpoint",
    "min_by",
    "min_by_key",
    "mul",
    "mul_assign",
    "ne",
    "neg",
    "next",
    "next_back",
    "not",
    "nth",
    "nth_back",
    "ok_or",
    "or",
    "or_else",
    "partial_cmp",
    "partition",
    "partition_point",
    "peek",
    "peekable",
    "pop",
    "position",
    "pow",
    "product",
    "push",
    "rchunks",
    "rchunks_exact",
    "reduce",
    "rem",
    "rem_assign",
    "repeat",
    "replace",
    "rev",
    "reverse",
    "rfold",
    "rotate_left",
    "rotate_right",
    "rposition",
    "rsplit",
    "scan",
    "skip",
    "skip_while",
    "sort",
    "sort_by",
    "sort_by_key",
    "sort_unstable",
    "sort_unstable_by",
    "sort_unstable_by_key",
    "split",
    "split_at",
    "split_at_mut",
    "split_first",
    "split_inclusive",
    "split_last",
    "splitn",
    "starts_with",
    "step_by",
    "strip_prefix",
    "strip_suffix",
    "sub",
    "sub_assign",
    "sum",
    "swap",
    "take",
    "take_while",
    "then",
    "then_some",
    "to_owned",
    "to_vec",
    "total_cmp",
    "try_fold",
    "try_from",
    "try_into",
    "unsigned_abs",
    "unwrap",
    "unwrap_or",
    "unwrap_or_default",
    "unwrap_or_else",
    "unzip",
    "windows",
    "xor",
    "zip",
];

/// Methods among them that numbers have.
const ON_NUMBERS: &[&str] = &[
    "add",
    "add_assign",
    "borrow",
    "classify",
    "clone",
    "clone_from",
    "cmp",
    "div",
    "div_assign",
    "eq",
    "ge",
    "gt",
    "into",
    "is_finite",
    "is_infinite",
    "is_nan",
    "is_normal",
    "is_sign_negative",
    "is_sign_positive",
    "is_subnormal",
    "le",
    "lt",
    "midpoint",
    "mul",
    "mul_assign",
    "ne",
    "neg",
    "partial_cmp",
    "rem",
    "rem_assign",
    "sub",
    "sub_assign",
    "to_owned",
    "total_cmp",
    "try_into",
];

/// Beginnings of methods of integers.
const OF_INTEGERS: &[&str] = &[
    "abs_diff",
    "checked_",
    "count_",
    "ilog",
    "leading_",
    "overflowing_",
    "saturating_",
    "trailing_",
    "wrapping_",
];

/// Whether a method may be one of the user's: the standard library has none of the name.
pub fn may_be_of_ones_own(name: &Ident) -> bool {
    let text = name.to_string();
    !jumps(name)
        && !is_known(&text)
        && !OF_STD.iter().any(|known| text == *known)
        && !OF_INTEGERS.iter().any(|start| text.starts_with(start))
}

/// Whether the receiver is a number rather than an array, by its form.
fn is_number(receiver: &Expr, numbers: &HashSet<Ident>) -> bool {
    match without_parentheses(receiver) {
        Expr::Index(_) | Expr::Binary(_) | Expr::Unary(_) | Expr::Lit(_) => true,
        Expr::Path(path) => path.path.get_ident().is_some_and(|name| numbers.contains(name)),
        Expr::MethodCall(call) => is_known(&call.method.to_string()),
        _ => false,
    }
}

/// The names in a body that are bound to numbers, by the form of what they are bound to.
pub fn numbers(function: &ImplItemFn) -> HashSet<Ident> {
    let mut numbers = Numbers(HashSet::new());
    numbers.visit_impl_item_fn(function);
    numbers.0
}

struct Numbers(HashSet<Ident>);

impl Numbers {
    /// `let x = q[0];` and `let (x, y) = (q[0], q[1]);`
    fn bind(&mut self, pattern: &Pat, value: &Expr) {
        match (pattern, without_parentheses(value)) {
            (Pat::Ident(name), value) if is_number(value, &self.0) => {
                self.0.insert(name.ident.clone());
            }
            (Pat::Tuple(names), Expr::Tuple(values)) if names.elems.len() == values.elems.len() => {
                for (name, value) in names.elems.iter().zip(&values.elems) {
                    self.bind(name, value);
                }
            }
            _ => {}
        }
    }
}

impl<'ast> Visit<'ast> for Numbers {
    fn visit_local(&mut self, local: &'ast Local) {
        if let Some(init) = &local.init {
            self.bind(&local.pat, &init.expr);
        }
        visit::visit_local(self, local);
    }

    fn visit_pat_type(&mut self, pattern: &'ast PatType) {
        if let (Pat::Ident(name), Some(ty)) = (&*pattern.pat, simple_name(&pattern.ty))
            && (ty == "f64" || ty == "f32")
        {
            self.0.insert(name.ident.clone());
        }
    }

    /// `let [x, y] = q;`
    fn visit_pat_slice(&mut self, pattern: &'ast PatSlice) {
        let names = pattern.elems.iter().filter_map(|entry| match entry {
            Pat::Ident(name) => Some(name.ident.clone()),
            _ => None,
        });
        self.0.extend(names);
    }
}

/// Methods of the user's, with their number of arguments.
#[derive(Default)]
pub struct OwnMethods(BTreeMap<Ident, usize>);

impl OwnMethods {
    /// Notes a call on what may depend on q or v: of a method of the standard library's name, on a number.
    pub fn note(&mut self, call: &ExprMethodCall, numbers: &HashSet<Ident>) {
        let name = &call.method;
        let is_of_numbers =
            jumps(name) || is_known(&name.to_string()) || ON_NUMBERS.iter().any(|known| name == known);
        let is_own = may_be_of_ones_own(name) || !is_of_numbers && is_number(&call.receiver, numbers);
        if call.turbofish.is_none() && is_own {
            self.0.entry(name.clone()).or_insert(call.args.len());
        }
    }

    pub fn extend(&mut self, others: &Self) {
        self.0.extend(others.0.iter().map(|(name, arguments)| (name.clone(), *arguments)));
    }

    /// A trait by which rustc says of these methods that dual numbers have none, and what to do. It is the
    /// last that is looked at: whatever has a method of the name by itself, or by a trait, keeps it.
    pub fn told(&self) -> Option<TokenStream> {
        let methods = self.0.iter().map(|(name, arguments)| {
            let types: Vec<_> = (0..*arguments).map(|i| format_ident!("A{i}")).collect();
            let generics = (*arguments > 0).then(|| quote!(<#(#types),*>));
            let name = Ident::new(&name.to_string(), proc_macro2::Span::call_site());
            quote! {
                fn #name #generics (self, #(_: #types),*) -> Real<D>
                where
                    Self: dual::Differentiated,
                {
                    ::core::unreachable!()
                }
            }
        });
        // trait OwnMethods<D>: Sized { fn curve(self) -> Real<D> where Self: dual::Differentiated { … } }
        (!self.0.is_empty()).then(|| {
            quote! {
                trait OwnMethods<D>: Sized { #(#methods)* }
                impl<D> OwnMethods<D> for &mut Real<D> {}
            }
        })
    }
}
