//! Names in small letters that the body does not bind: constants and statics of the module, if anything.
//! Whether they are, rustc knows.

use proc_macro2::Ident;
use syn::ExprPath;

use super::class::IntegerType;
use super::value::Value;
use super::written::Written;
use super::{Lowering, Result, refuse};

/// Names of arguments and locals that generated functions have whatever the expressions: no constant can
/// stand beside them.
const LOCALS: [&str; 22] = [
    "_q",
    "_v",
    "anchors",
    "direction",
    "elapsed",
    "evaluate",
    "h",
    "half",
    "kept",
    "minus",
    "momenta",
    "p",
    "plus",
    "q",
    "q0",
    "q1",
    "rate",
    "systems",
    "t",
    "u",
    "v",
    "vector",
];

impl Lowering<'_> {
    /// The constant or static of that path, unless it reads like a misspelled local: rustc knows better which
    /// one was meant, and says so of the user's own body.
    pub fn constant_of_module(&mut self, path: &ExprPath) -> Result<Value> {
        let tokens = self.imported(path);
        let Some(name) = path.path.segments.last().map(|segment| &segment.ident) else {
            return refuse(path, "not a name");
        };
        if let Some(name) = path.path.get_ident() {
            if self.is_like_a_local(name) {
                return refuse(path, not_known(name));
            }
            if LOCALS.iter().any(|local| name == local) {
                return refuse(
                    path,
                    format!("the generated code has a local `{name}`; give the constant another name"),
                );
            }
            // What is generated takes other names: none of its locals can have that of a constant.
            self.graph.reserve(name.to_string());
        } else if path.qself.is_some() || is_of_primitive(path) {
            return refuse(path, not_known(name));
        }
        Ok(Value::Written(Written::leaf(tokens)))
    }

    fn is_like_a_local(&self, name: &Ident) -> bool {
        let name = name.to_string();
        let length = name.chars().count();
        self.locals.iter().any(|(local, _)| {
            let distance = distance(local, &name);
            distance <= length.max(3) / 3 && distance < length.max(local.chars().count())
        })
    }
}

/// `i32::pow`: primitive types have functions of such names, and no constants.
fn is_of_primitive(path: &ExprPath) -> bool {
    let owner = path.path.segments.iter().rev().nth(1).map(|segment| segment.ident.to_string());
    owner.is_some_and(|owner| {
        ["f32", "f64", "bool", "char"].contains(&&*owner) || IntegerType::named(&owner).is_some()
    })
}

/// The refusal of a name that nothing explains.
pub fn not_known(name: &Ident) -> String {
    format!("`{name}` is not known here; use locals, fields, constants and functions of the annotated block")
}

/// How many letters have to be put in, taken out or changed to make one name of the other.
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, letter) in a.chars().enumerate() {
        let mut diagonal = std::mem::replace(&mut row[0], i + 1);
        for (j, other) in b.iter().enumerate() {
            let changed = diagonal + usize::from(letter != *other);
            diagonal = row[j + 1];
            row[j + 1] = changed.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}
