//! Mutations of source text: of its syntax tree where it has one, of its tokens otherwise, of its bytes now
//! and then.

use libfuzzer_sys::fuzzer_mutate;
use proc_macro2::{Group, TokenStream, TokenTree};
use quote::{ToTokens, quote};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use syn::visit::{self, Visit};
use syn::visit_mut::{self, VisitMut};
use syn::{Block, Expr, ImplItem, Item, Stmt, Type};

use crate::fragments::{EXPRESSIONS, FUNCTIONS, OPTIONS, STATEMENTS, TOKENS, TYPES};

/// Changes the text in `data[..size]`; returns its new size.
pub fn mutated(data: &mut [u8], size: usize, max_size: usize, seed: u32) -> usize {
    let mut random = StdRng::seed_from_u64(seed.into());
    let text = std::str::from_utf8(&data[..size]).ok().and_then(|text| match random.random_range(0..16) {
        0 => None,
        1..=3 => changed_tokens(text, &mut random),
        _ => changed_tree(text, &mut random).or_else(|| changed_tokens(text, &mut random)),
    });
    match text {
        Some(text) if text.len() <= max_size => {
            data[..text.len()].copy_from_slice(text.as_bytes());
            text.len()
        }
        _ => fuzzer_mutate(data, size, max_size),
    }
}

fn one<'a, T>(of: &'a [T], random: &mut StdRng) -> &'a T {
    &of[random.random_range(0..of.len())]
}

/// A fragment, parsed.
fn fragment<T: syn::parse::Parse>(of: &[&str], random: &mut StdRng) -> T {
    let text = one(of, random);
    syn::parse_str(text).unwrap_or_else(|error| panic!("{error} in the fragment {text}"))
}

/// The n-th piece of a kind, handed to `change`; and how many there are.
struct Nth<T, F: FnMut(&mut T)> {
    left: usize,
    count: usize,
    change: F,
    kind: std::marker::PhantomData<T>,
}

impl<T, F: FnMut(&mut T)> Nth<T, F> {
    fn new(left: usize, change: F) -> Self {
        Self { left, count: 0, change, kind: std::marker::PhantomData }
    }

    /// Whether this piece was the one.
    fn meets(&mut self, piece: &mut T) -> bool {
        self.count += 1;
        let is_met = self.count == self.left + 1;
        if is_met {
            (self.change)(piece);
        }
        is_met
    }
}

macro_rules! nth {
    ($kind:ty, $visit:ident) => {
        impl<F: FnMut(&mut $kind)> VisitMut for Nth<$kind, F> {
            fn $visit(&mut self, piece: &mut $kind) {
                if !self.meets(piece) {
                    visit_mut::$visit(self, piece);
                }
            }
        }

        impl Place for $kind {
            fn change_one(item: &mut Item, random: &mut StdRng, change: impl FnMut(&mut Self)) -> Option<()> {
                let mut all = Nth::new(usize::MAX - 1, |_: &mut $kind| ());
                all.visit_item_mut(item);
                let count = all.count;
                (count > 0).then(|| Nth::new(random.random_range(0..count), change).visit_item_mut(item))
            }
        }
    };
}

/// A kind of piece of which one is chosen at random.
trait Place: Sized {
    fn change_one(item: &mut Item, random: &mut StdRng, change: impl FnMut(&mut Self)) -> Option<()>;
}

nth!(Expr, visit_expr_mut);
nth!(Block, visit_block_mut);
nth!(Type, visit_type_mut);

/// All expressions of an item.
#[derive(Default)]
struct Expressions(Vec<Expr>);

impl<'ast> Visit<'ast> for Expressions {
    fn visit_expr(&mut self, expression: &'ast Expr) {
        self.0.push(expression.clone());
        visit::visit_expr(self, expression);
    }
}

fn changed_tree(text: &str, random: &mut StdRng) -> Option<String> {
    let mut item: Item = syn::parse_str(text).ok()?;
    for _ in 0..random.random_range(1..=3) {
        match random.random_range(0..16) {
            0..=8 => change_expression(&mut item, random)?,
            9..=12 => change_statement(&mut item, random)?,
            13 => {
                let mut new = fragment::<Type>(TYPES, random);
                Type::change_one(&mut item, random, |place| std::mem::swap(place, &mut new))?;
            }
            14 => change_functions(&mut item, random),
            _ => change_options(&mut item, random),
        }
    }
    Some(item.into_token_stream().to_string())
}

fn change_expression(item: &mut Item, random: &mut StdRng) -> Option<()> {
    let mut present = Expressions::default();
    present.visit_item(item);
    let mut other = if present.0.is_empty() || random.random_ratio(1, 2) {
        fragment(EXPRESSIONS, random)
    } else {
        one(&present.0, random).clone()
    };
    let choice = random.random_range(0..24);
    Expr::change_one(item, random, |place| {
        let here = place.clone();
        let tokens = match choice {
            0..=9 => return std::mem::swap(place, &mut other),
            10 => quote!(-#here),
            11 => quote!((#here) * (#other)),
            12 => quote!((#here) + (#other)),
            13 => quote!((#here) / (#other)),
            14 => quote!({ let x = #here; #other }),
            15 => quote!(if (#other) > 0.0 { #here } else { #other }),
            16 => quote!((#here).powf(#other)),
            17 => quote!((#here).max(#other)),
            18 => quote!([#here, #other]),
            19 => quote!((|x| #here)(#other)),
            20 => quote!((#here)[#other]),
            21 => quote!((#here) as f64),
            22 => quote!(match #here { x if x > 0.0 => #other, _ => #here }),
            _ => quote!(self.helper(#here)),
        };
        if let Ok(made) = syn::parse2(tokens) {
            *place = made;
        }
    })
}

fn change_statement(item: &mut Item, random: &mut StdRng) -> Option<()> {
    let new: Block = syn::parse_str(&format!("{{ {} }}", one(STATEMENTS, random))).ok()?;
    let (choice, at, to) =
        (random.random_range(0..6), random.random::<u32>() as usize, random.random::<u32>() as usize);
    Block::change_one(item, random, |block| {
        let count = block.stmts.len();
        match choice {
            0 if count > 0 => drop(block.stmts.remove(at % count)),
            1 if count > 1 => block.stmts.swap(at % count, to % count),
            2 if count > 0 => {
                let again = block.stmts[at % count].clone();
                block.stmts.insert(to % count, again);
            }
            3 if count > 0 => {
                let inner: Vec<Stmt> = block.stmts.split_off(at % count);
                if let Ok(wrapped) = syn::parse2(quote!({ #(#inner)* })) {
                    block.stmts.push(Stmt::Expr(wrapped, None));
                }
            }
            _ => {
                let at = at % (count + 1);
                block.stmts.splice(at..at, new.stmts.clone());
            }
        }
    })
}

/// Adds a function to a block, takes one away, or renames one.
fn change_functions(item: &mut Item, random: &mut StdRng) {
    let Item::Impl(block) = item else { return };
    let count = block.items.len();
    match random.random_range(0..3) {
        0 if count > 0 => drop(block.items.remove(random.random_range(0..count))),
        1 if count > 1 => block.items.swap(0, random.random_range(0..count)),
        _ => block.items.push(fragment::<ImplItem>(FUNCTIONS, random)),
    }
}

fn change_options(item: &mut Item, random: &mut StdRng) {
    let options: TokenStream = one(OPTIONS, random).parse().unwrap_or_default();
    let attributes = match item {
        Item::Impl(item) => &mut item.attrs,
        Item::Fn(item) => &mut item.attrs,
        _ => return,
    };
    if attributes.is_empty() {
        attributes.push(syn::parse_quote!(#[rayleigh_system]));
    }
    attributes[0] = match random.random_range(0..8) {
        0 => syn::parse_quote!(#[differentiable]),
        _ => syn::parse_quote!(#[rayleigh_system(#options)]),
    };
}

fn changed_tokens(text: &str, random: &mut StdRng) -> Option<String> {
    let mut tokens: TokenStream = text.parse().ok()?;
    for _ in 0..random.random_range(1..=3) {
        let count = size(&tokens);
        let mut at = random.random_range(0..count.max(1));
        tokens = changed_at(tokens, &mut at, random);
    }
    Some(tokens.to_string())
}

fn size(tokens: &TokenStream) -> usize {
    let of = |tree| 1 + if let TokenTree::Group(group) = tree { size(&group.stream()) } else { 0 };
    tokens.clone().into_iter().map(of).sum()
}

/// Changes the token `at`, counted through all groups.
fn changed_at(tokens: TokenStream, at: &mut usize, random: &mut StdRng) -> TokenStream {
    let mut changed = TokenStream::new();
    let mut before: Option<TokenTree> = None;
    for tree in tokens {
        let is_met = *at == 0;
        *at = at.wrapping_sub(1);
        if is_met {
            let new: TokenStream = one(TOKENS, random).parse().unwrap_or_default();
            match random.random_range(0..4) {
                0 => {}
                1 => changed.extend([tree.clone(), tree.clone()]),
                2 => changed.extend(new),
                _ => {
                    changed.extend(before.clone());
                    changed.extend(new);
                    changed.extend([tree.clone()]);
                }
            }
        } else if let TokenTree::Group(group) = &tree {
            changed.extend([TokenTree::from(Group::new(
                group.delimiter(),
                changed_at(group.stream(), at, random),
            ))]);
        } else {
            changed.extend([tree.clone()]);
        }
        before = Some(tree);
    }
    changed
}
