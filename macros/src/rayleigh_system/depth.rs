//! How deep the item's expressions are: parsing, running and dropping them calls itself as often.
//!
//! The stages run on a stack of their own that fits the depth. A macro runs on a thread of the compiler's,
//! where a sum of a thousand terms would be the end of the compiler.

use proc_macro2::{Delimiter, Span, TokenStream, TokenTree};

/// Expressions within expressions, at most.
pub const MOST_LEVELS: usize = own_stack::MOST_LEVELS;

/// The stack that a level takes at most, built without optimisation.
const BYTES_OF_LEVEL: usize = 48 << 10;

/// The stack that there is for any item: calls within calls are run one within the other.
const LEAST_BYTES: usize = 128 << 20;

const PRECEDENCES: usize = 10;

/// How deep tokens are.
pub struct Depth {
    levels: usize,
    /// The token behind which there are more levels than are read.
    beyond: Option<Span>,
}

/// A stream that is still to be looked at, and the levels that it stands in.
struct Open {
    tokens: TokenStream,
    levels: usize,
}

/// A statement, or an entry of a list, as far as it was seen.
#[derive(Default)]
struct Statement {
    /// Operators of each precedence since one of a lower.
    runs: [usize; PRECEDENCES],
    /// The longest of those runs.
    longest: [usize; PRECEDENCES],
    groups: Vec<TokenStream>,
    ends_with_block: bool,
}

impl Statement {
    /// In `a + b + c` every operator holds all that stands before it; in `a * b + c * d` those of a term hold
    /// none of the other.
    fn add(&mut self, precedence: usize) {
        self.runs[precedence + 1..].fill(0);
        self.runs[precedence] += 1;
        self.longest[precedence] = self.longest[precedence].max(self.runs[precedence]);
    }

    fn levels(&self) -> usize {
        self.longest.iter().sum()
    }
}

impl Depth {
    /// The depth of the tokens, or more.
    pub fn of(tokens: &TokenStream) -> Self {
        let mut depth = Self { levels: 0, beyond: None };
        let mut open = vec![Open { tokens: tokens.clone(), levels: 0 }];
        while let Some(Open { tokens, levels }) = open.pop() {
            let mut statement = Statement::default();
            let mut end = |statement: &mut Statement| {
                let ended = std::mem::take(statement);
                let levels = levels + ended.levels() + 1;
                open.extend(ended.groups.into_iter().map(|tokens| Open { tokens, levels }));
            };
            for token in tokens {
                let precedence = precedence(&token);
                // Behind a block that nothing continues the statement is at its end.
                if is_separator(&token) || (statement.ends_with_block && precedence.is_none()) {
                    end(&mut statement);
                }
                if let Some(precedence) = precedence {
                    statement.add(precedence);
                }
                let here = levels + statement.levels();
                depth.levels = depth.levels.max(here);
                if here > MOST_LEVELS {
                    depth.beyond = Some(token.span());
                    return depth;
                }
                statement.ends_with_block = false;
                if let TokenTree::Group(group) = token {
                    statement.ends_with_block = group.delimiter() == Delimiter::Brace;
                    statement.groups.push(group.stream());
                }
            }
            end(&mut statement);
        }
        depth
    }

    /// The greater of the two depths.
    pub fn and(self, other: Self) -> Self {
        if self.levels < other.levels { other } else { self }
    }

    /// The token where there are more levels than are read, if there are.
    pub fn beyond(&self) -> Option<Span> {
        self.beyond
    }

    /// Runs the stages on a stack that is large enough for tokens of this depth.
    pub fn on_own_stack<T>(&self, run: impl FnOnce() -> T) -> T {
        own_stack::run(LEAST_BYTES + self.levels * BYTES_OF_LEVEL, run)
    }
}

/// On hosts of which `corosensei` knows the stacks, as in Cargo.toml.
#[cfg(any(
    all(unix, any(target_arch = "x86_64", target_arch = "aarch64")),
    all(windows, target_arch = "x86_64")
))]
mod own_stack {
    use corosensei::{on_stack, stack::DefaultStack};

    pub const MOST_LEVELS: usize = 6_000;

    pub fn run<T>(bytes: usize, run: impl FnOnce() -> T) -> T {
        match DefaultStack::new(bytes) {
            Ok(stack) => on_stack(stack, run),
            // Most items do without.
            Err(_) => run(),
        }
    }
}

/// On others the compiler's stack has to do, of 8 MiB.
#[cfg(not(any(
    all(unix, any(target_arch = "x86_64", target_arch = "aarch64")),
    all(windows, target_arch = "x86_64")
)))]
mod own_stack {
    pub const MOST_LEVELS: usize = 100;

    pub fn run<T>(_bytes: usize, run: impl FnOnce() -> T) -> T {
        run()
    }
}

fn is_separator(token: &TokenTree) -> bool {
    matches!(token, TokenTree::Punct(punct) if [',', ';'].contains(&punct.as_char()))
}

/// Words that stand before the expression that they hold.
const WORDS: [&str; 8] = ["break", "else", "if", "in", "match", "move", "return", "while"];

/// How tightly the token holds what stands beside it, from the loosest, 0; nothing if it makes no expression.
fn precedence(token: &TokenTree) -> Option<usize> {
    match token {
        TokenTree::Punct(punct) => match punct.as_char() {
            '=' | '@' => Some(0),
            '|' => Some(1),
            '&' => Some(2),
            '<' | '>' => Some(3),
            '^' => Some(4),
            '+' | '-' => Some(5),
            '*' | '/' | '%' => Some(6),
            '!' | '~' => Some(8),
            '.' | '?' => Some(9),
            _ => None,
        },
        TokenTree::Ident(word) if word == "as" => Some(7),
        TokenTree::Ident(word) => WORDS.iter().any(|other| word == other).then_some(0),
        TokenTree::Group(_) | TokenTree::Literal(_) => None,
    }
}
