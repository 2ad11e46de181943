//! Expressions of fields and constants: what they are, rustc knows.

use std::rc::Rc;

use proc_macro2::{Ident, TokenStream, TokenTree};
use quote::{ToTokens, quote};
use syn::{BinOp, Index, Type, UnOp};

use super::indexed;

/// An expression of fields and constants. Its type shows in its use: as a number it becomes nodes of the
/// graph, as an index, integer or condition it is written out.
#[derive(Clone)]
pub enum Written {
    Leaf(Leaf),
    Named(String, Box<Written>),
    /// `&x`, which patterns see and arithmetic does not.
    Reference(Box<Written>),
    Unary(UnOp, Box<Written>),
    Binary(BinOp, Box<Written>, Box<Written>),
    /// A method that numbers and integers share.
    Method(Ident, Box<Written>, Vec<Written>),
}

/// The user's tokens, or such as they would be.
#[derive(Clone)]
pub struct Leaf {
    pub tokens: TokenStream,
    /// Arms whose bindings the tokens name, outermost first.
    pub arms: Vec<Rc<Arm>>,
    /// Whether the evaluation may panic: it must not run where the user's would not.
    pub may_panic: bool,
    /// Bound by a pattern: it may be a reference to the value.
    pub is_bound: bool,
}

/// A pattern of the user's that rustc matches.
pub struct Arm {
    pub scrutinee: TokenStream,
    pub pattern: TokenStream,
    pub names: Vec<String>,
}

/// Tokens of a whole expression, to stand within `arms`.
pub struct Text {
    pub tokens: TokenStream,
    pub arms: Vec<Rc<Arm>>,
    pub may_panic: bool,
}

impl Text {
    /// The tokens where the arms are taken, else the default.
    pub fn within_arms(self, default: &TokenStream) -> TokenStream {
        self.arms.iter().rev().fold(self.tokens, |inner, arm| {
            let Arm { scrutinee, pattern, .. } = &**arm;
            quote!(match #scrutinee { #pattern => #inner, _ => #default })
        })
    }
}

/// Two patterns that bind one name.
pub struct Clash(pub String);

impl Written {
    /// A field or constant.
    pub fn leaf(tokens: TokenStream) -> Self {
        Self::Leaf(Leaf { tokens, arms: Vec::new(), may_panic: false, is_bound: false })
    }

    /// Tokens that are an expression of this one.
    pub fn derived(&self, may_panic: bool, tokens: impl FnOnce(TokenStream) -> TokenStream) -> Self {
        let leaf = self.as_leaf();
        Self::Leaf(Leaf {
            tokens: tokens(leaf.tokens),
            arms: leaf.arms,
            may_panic: leaf.may_panic || may_panic,
            is_bound: false,
        })
    }

    /// `array[index]`.
    pub fn entry(&self, index: usize) -> Self {
        self.derived(false, |base| indexed(&base, index))
    }

    /// `array[index]`, with the index written as `text`, within the arms of both.
    pub fn entry_at(&self, index: &Self, text: &TokenStream) -> Self {
        let Leaf { tokens, arms, .. } = self.as_leaf();
        let arms = [arms, index.as_leaf().arms].concat();
        Self::Leaf(Leaf { tokens: quote!(#tokens[#text]), arms, may_panic: true, is_bound: false })
    }

    /// `tuple.index`.
    pub fn member(&self, index: usize) -> Self {
        let index = Index::from(index);
        self.derived(false, |base| quote!(#base.#index))
    }

    /// The expression as one leaf, in parentheses where it is more than one operand. Names that clash are
    /// told by [`Written::text`].
    fn as_leaf(&self) -> Leaf {
        match self {
            Self::Leaf(leaf) => leaf.clone(),
            Self::Named(_, inner) | Self::Reference(inner) => inner.as_leaf(),
            _ => {
                let mut leaves = Vec::new();
                self.leaves(&mut leaves);
                Leaf {
                    tokens: self.operand(),
                    arms: leaves.iter().flat_map(|leaf| leaf.arms.clone()).collect(),
                    may_panic: self.may_panic(),
                    is_bound: false,
                }
            }
        }
    }

    /// The expression as it stands: no operation of it becomes one of the graph.
    pub fn as_text(&self, may_panic: bool) -> Self {
        Self::Leaf(Leaf { may_panic: may_panic || self.parts_may_panic(), ..self.as_leaf() })
    }

    /// `*x`: what a pattern bound may be a reference, anything else is one for patterns alone.
    pub fn dereferenced(self) -> Self {
        match self {
            Self::Reference(inner) => *inner,
            Self::Named(_, inner) if matches!(*inner, Self::Reference(_)) => inner.dereferenced(),
            bound if bound.is_bound() => {
                let mut leaf = bound.as_leaf();
                leaf.tokens = {
                    let tokens = leaf.tokens;
                    quote!((*#tokens))
                };
                Self::Leaf(leaf)
            }
            other => other,
        }
    }

    /// Whether it is what a pattern bound, by value or by reference.
    pub fn is_bound(&self) -> bool {
        match self {
            Self::Leaf(leaf) => leaf.is_bound,
            Self::Named(_, inner) => inner.is_bound(),
            _ => false,
        }
    }

    /// Whether it is a `None` that stands alone, of which rustc is not told of what type it is.
    pub fn is_none(&self) -> bool {
        match self {
            Self::Leaf(leaf) => leaf.tokens.to_string() == "None",
            Self::Named(_, inner) => inner.is_none(),
            _ => false,
        }
    }

    /// `<Option<f64>>::None` for a `None` that stands alone, of the type that is written beside it.
    pub fn none_of_type(self, ty: &Type) -> Self {
        if self.is_none() { Self::leaf(quote!(<#ty>::None)) } else { self }
    }

    /// `if true { None } else { self.k }`: a `None` that has the type of this expression; nothing where it
    /// stands within arms.
    pub fn none_beside(&self) -> Option<Self> {
        let Leaf { tokens, arms, .. } = self.as_leaf();
        arms.is_empty().then(|| Self::leaf(quote!((if true { None } else { #tokens }))))
    }

    fn leaves<'w>(&'w self, leaves: &mut Vec<&'w Leaf>) {
        match self {
            Self::Leaf(leaf) => leaves.push(leaf),
            Self::Named(_, inner) | Self::Reference(inner) | Self::Unary(_, inner) => inner.leaves(leaves),
            Self::Binary(_, a, b) => {
                a.leaves(leaves);
                b.leaves(leaves);
            }
            Self::Method(_, receiver, arguments) => {
                receiver.leaves(leaves);
                arguments.iter().for_each(|argument| argument.leaves(leaves));
            }
        }
    }

    /// Whether the evaluation, of integers, may panic.
    fn may_panic(&self) -> bool {
        match self {
            Self::Leaf(leaf) => leaf.may_panic,
            Self::Named(_, inner) | Self::Reference(inner) => inner.may_panic(),
            Self::Unary(operator, inner) => matches!(operator, UnOp::Neg(_)) || inner.may_panic(),
            Self::Binary(operator, a, b) => {
                let is_safe = matches!(
                    operator,
                    BinOp::Lt(_)
                        | BinOp::Le(_)
                        | BinOp::Gt(_)
                        | BinOp::Ge(_)
                        | BinOp::Eq(_)
                        | BinOp::Ne(_)
                        | BinOp::BitAnd(_)
                        | BinOp::BitOr(_)
                        | BinOp::BitXor(_)
                );
                !is_safe || a.may_panic() || b.may_panic()
            }
            Self::Method(..) => true,
        }
    }

    /// Whether what it is made of may panic.
    fn parts_may_panic(&self) -> bool {
        let mut leaves = Vec::new();
        self.leaves(&mut leaves);
        leaves.iter().any(|leaf| leaf.may_panic)
    }

    fn tokens(&self) -> TokenStream {
        match self {
            Self::Leaf(leaf) => leaf.tokens.clone(),
            Self::Named(_, inner) => inner.tokens(),
            Self::Reference(inner) => {
                let inner = inner.operand();
                quote!(&#inner)
            }
            Self::Unary(operator, inner) => {
                let inner = inner.operand();
                quote!(#operator #inner)
            }
            Self::Binary(operator, a, b) => {
                let (a, b) = (a.operand(), b.operand());
                quote!(#a #operator #b)
            }
            Self::Method(method, receiver, arguments) => {
                let receiver = receiver.operand();
                let arguments = arguments.iter().map(Self::tokens);
                quote!(#receiver.#method(#(#arguments),*))
            }
        }
    }

    /// The tokens, in parentheses where they are more than one operand.
    fn operand(&self) -> TokenStream {
        match self {
            Self::Leaf(_) | Self::Method(..) => self.tokens(),
            Self::Named(_, inner) => inner.operand(),
            Self::Reference(_) | Self::Unary(..) | Self::Binary(..) => {
                let tokens = self.tokens();
                quote!((#tokens))
            }
        }
    }

    /// The expression as written, with all arms that it stands in.
    pub fn text(&self) -> Result<Text, Clash> {
        let mut leaves = Vec::new();
        self.leaves(&mut leaves);
        let mut arms: Vec<Rc<Arm>> = Vec::new();
        for arm in leaves.iter().flat_map(|leaf| &leaf.arms) {
            let is_same = |other: &Rc<Arm>| {
                other.pattern.to_string() == arm.pattern.to_string()
                    && other.scrutinee.to_string() == arm.scrutinee.to_string()
            };
            if arms.iter().any(is_same) {
                continue;
            }
            if let Some(name) =
                arm.names.iter().find(|&name| arms.iter().any(|other| other.names.contains(name)))
            {
                return Err(Clash(name.clone()));
            }
            arms.push(arm.clone());
        }
        // Nothing is moved out of what only a reference was taken to.
        let tokens = match self {
            Self::Reference(_) => self.tokens(),
            _ => self.operand(),
        };
        Ok(Text { tokens, arms, may_panic: self.may_panic() })
    }

    /// The user's name, or one made of the tokens.
    pub fn name(&self) -> Option<String> {
        match self {
            Self::Leaf(leaf) => name_of(&leaf.tokens),
            Self::Named(name, _) => Some(name.clone()),
            Self::Reference(inner) => inner.name(),
            _ => None,
        }
    }
}

/// `self.m[0]` → `m_0`, `Self::G` → `g`.
fn name_of(tokens: &TokenStream) -> Option<String> {
    fn collect(tokens: TokenStream, words: &mut Vec<String>) {
        for token in tokens {
            match token {
                TokenTree::Group(group) => collect(group.stream(), words),
                TokenTree::Ident(ident) => {
                    words.push(ident.to_string().trim_start_matches("r#").to_lowercase())
                }
                TokenTree::Literal(literal) => {
                    let literal: String =
                        literal.to_string().chars().filter(char::is_ascii_alphanumeric).collect();
                    words.push(literal);
                }
                TokenTree::Punct(_) => {}
            }
        }
    }
    let mut all = Vec::new();
    collect(tokens.to_token_stream(), &mut all);
    const SILENT: [&str; 8] = ["self", "std", "core", "f64", "f32", "consts", "as", "from"];
    all.retain(|word| !SILENT.contains(&word.as_str()));
    let name = all.join("_");
    (name.starts_with(char::is_alphabetic) && name.len() < 30).then_some(name)
}
