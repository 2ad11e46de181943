//! Programs under other names: every name of the user's a word that generated code has.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::{Group, Ident, TokenStream, TokenTree};
use syn::visit::{self, Visit};

use super::random::Random;
use super::rayleigh_system::hygiene::GENERATED;

/// Words for constants: temporaries have them in small letters.
const CONSTANTS: [&str; 2] = ["D", "T"];

const CONSTANTS_IN_SMALL: [&str; 2] = ["d", "t"];

/// Locals and arguments of generated code, beside the names that it brings into scope.
const LOCALS: [&str; 34] = [
    "q0",
    "q1",
    "q2",
    "h",
    "half",
    "p0",
    "p1",
    "t1",
    "t2",
    "t3",
    "t4",
    "sin_q0",
    "cos_q0",
    "u",
    "v0",
    "self_k",
    "value",
    "d1",
    "d2",
    "d11",
    "d12",
    "d22",
    "minus",
    "plus",
    "matrix",
    "momenta",
    "lane",
    "stages",
    "angles",
    "reciprocals",
    "elapsed",
    "system",
    "dl_dt1",
    "held",
];

/// Another text of a program, by its seed.
type Rename = fn(&str, u64) -> String;

/// The new names that an engine of the study says.
pub fn by(engine: &str) -> Option<Rename> {
    match engine {
        "renamed" => Some(text),
        "one_word" => Some(one_word),
        _ => None,
    }
}

/// The text, its names drawn anew by the seed: those that it declares within itself.
fn text(text: &str, seed: u64) -> String {
    let Some(own) = Own::of(text) else { return text.to_owned() };
    let mut random = Random::new(seed ^ 0x6e61_6d65);
    let words = words().filter(|word| !CONSTANTS.contains(word) && !CONSTANTS_IN_SMALL.contains(word));
    let mut map = drawn(own.constants.iter(), [own.free(CONSTANTS), Vec::new()], &mut random);
    let others = [own.free(CONSTANTS_IN_SMALL), own.free(words)];
    map.extend(drawn(own.others.iter(), others, &mut random));
    own.keep_places(&mut map);
    renamed(own.tokens, &map).to_string()
}

/// The text with one of its names under the word that the seed stands for: each of them in turn.
fn one_word(text: &str, seed: u64) -> String {
    let Some(own) = Own::of(text) else { return text.to_owned() };
    let index = usize::try_from(seed).expect("a seed of a study") % words().count();
    let word = own.free(words().skip(index).take(1));
    let is_constant = word.first().is_some_and(|word| CONSTANTS.contains(word));
    let mut names: Vec<&String> = if is_constant { &own.constants } else { &own.others }.iter().collect();
    let mut random = Random::new(seed ^ 0x776f_7264);
    if !names.is_empty() {
        let drawn = random.below(names.len());
        names.swap(0, drawn);
    }
    let mut map = drawn(names.into_iter(), [word, Vec::new()], &mut random);
    own.keep_places(&mut map);
    renamed(own.tokens, &map).to_string()
}

/// All words, each once.
fn words() -> impl Iterator<Item = &'static str> {
    let generated = GENERATED.iter().copied().filter(|word| !CONSTANTS.contains(word));
    CONSTANTS.into_iter().chain(CONSTANTS_IN_SMALL).chain(LOCALS).chain(generated)
}

/// A program, and the names that are its own.
struct Own {
    tokens: TokenStream,
    /// All words of the text.
    taken: BTreeSet<String>,
    constants: BTreeSet<String>,
    others: BTreeSet<String>,
    /// Arguments of L, R and f.
    arguments: BTreeSet<String>,
}

impl Own {
    fn of(text: &str) -> Option<Self> {
        let (file, tokens) = (syn::parse_file(text).ok()?, text.parse().ok()?);
        let mut names = Names::default();
        names.visit_file(&file);
        let words = text.split(|c: char| !c.is_alphanumeric() && c != '_');
        Some(Self {
            tokens,
            taken: words.map(str::to_owned).collect(),
            // Where a body does not name a constant of the module, the macro cannot know of it.
            constants: names.constants.intersection(&names.mentioned).cloned().collect(),
            others: names.declared.difference(&names.in_short).cloned().collect(),
            arguments: names.arguments,
        })
    }

    /// Leaves an argument its name where another would be that of another place: the time is called `t`, and
    /// nothing else is, nor `u`.
    fn keep_places(&self, map: &mut BTreeMap<String, &'static str>) {
        map.retain(|name, word| !self.arguments.contains(name) || name != "t" && !["t", "u"].contains(word));
    }

    /// The words that the program does not have already: one could be another name's.
    fn free(&self, words: impl IntoIterator<Item = &'static str>) -> Vec<&'static str> {
        words.into_iter().filter(|word| !self.taken.contains(*word)).collect()
    }
}

/// A word for each name, of the first words until they are used up; none where there are no more.
fn drawn<'n>(
    names: impl Iterator<Item = &'n String>,
    mut words: [Vec<&'static str>; 2],
    random: &mut Random,
) -> BTreeMap<String, &'static str> {
    let word = |name: &String| {
        let words = words.iter_mut().find(|words| !words.is_empty())?;
        Some((name.clone(), words.swap_remove(random.below(words.len()))))
    };
    names.map_while(word).collect()
}

/// The names that a program declares.
#[derive(Default)]
struct Names {
    declared: BTreeSet<String>,
    /// Names that stand for a field and a local at once.
    in_short: BTreeSet<String>,
    /// Constants of the module and of the block.
    constants: BTreeSet<String>,
    /// Names in paths.
    mentioned: BTreeSet<String>,
    /// Names of arguments of L, R and f.
    arguments: BTreeSet<String>,
}

impl<'ast> Visit<'ast> for Names {
    fn visit_item_struct(&mut self, item: &'ast syn::ItemStruct) {
        if item.ident == "System" {
            self.declared
                .extend(item.fields.iter().filter_map(|field| field.ident.as_ref()).map(Ident::to_string));
        }
    }

    fn visit_impl_item_fn(&mut self, function: &'ast syn::ImplItemFn) {
        let name = function.sig.ident.to_string();
        if ["lagrangian", "rayleigh", "force"].contains(&name.as_str()) {
            let names = function.sig.inputs.iter().filter_map(|input| match input {
                syn::FnArg::Typed(argument) => match &*argument.pat {
                    syn::Pat::Ident(pattern) => Some(pattern.ident.to_string()),
                    _ => None,
                },
                syn::FnArg::Receiver(_) => None,
            });
            self.arguments.extend(names);
        } else {
            self.declared.insert(name);
        }
        visit::visit_impl_item_fn(self, function);
    }

    fn visit_impl_item_const(&mut self, constant: &'ast syn::ImplItemConst) {
        self.constants.insert(constant.ident.to_string());
    }

    fn visit_item_const(&mut self, constant: &'ast syn::ItemConst) {
        self.constants.insert(constant.ident.to_string());
    }

    fn visit_expr_path(&mut self, path: &'ast syn::ExprPath) {
        self.mentioned.extend(path.path.segments.last().map(|name| name.ident.to_string()));
    }

    fn visit_pat_ident(&mut self, pattern: &'ast syn::PatIdent) {
        let name = pattern.ident.to_string();
        // `None`, and constants: they bind nothing.
        if !name.starts_with(char::is_uppercase) {
            self.declared.insert(name);
        }
        visit::visit_pat_ident(self, pattern);
    }

    fn visit_field_pat(&mut self, field: &'ast syn::FieldPat) {
        if let (None, syn::Member::Named(name)) = (&field.colon_token, &field.member) {
            self.in_short.insert(name.to_string());
        }
        visit::visit_field_pat(self, field);
    }

    fn visit_field_value(&mut self, field: &'ast syn::FieldValue) {
        if let (None, syn::Member::Named(name)) = (&field.colon_token, &field.member) {
            self.in_short.insert(name.to_string());
        }
        visit::visit_field_value(self, field);
    }
}

fn renamed(tokens: TokenStream, map: &BTreeMap<String, &str>) -> TokenStream {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let is = |at: Option<usize>, mark: char| {
        at.and_then(|at| tokens.get(at)).is_some_and(|token| token.to_string() == mark.to_string())
    };
    let renamed = tokens.iter().enumerate().map(|(index, token)| match token {
        TokenTree::Ident(name) => {
            // `.count()` is a method; `self.count` is a field, and `self.helper(x)` a function of the block.
            let is_method = is(index.checked_sub(1), '.')
                && matches!(tokens.get(index + 1), Some(TokenTree::Group(group)) if group.delimiter() == proc_macro2::Delimiter::Parenthesis)
                && tokens.get(index.wrapping_sub(2)).is_none_or(|owner| owner.to_string() != "self");
            match map.get(&name.to_string()) {
                Some(word) if !is_method => TokenTree::Ident(Ident::new(word, name.span())),
                _ => token.clone(),
            }
        }
        TokenTree::Group(group) => {
            TokenTree::Group(Group::new(group.delimiter(), renamed(group.stream(), map)))
        }
        other => other.clone(),
    });
    renamed.collect()
}
