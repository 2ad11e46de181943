//! A program while it is composed: its items, the fields of its system, and the names that are taken.

use std::collections::BTreeSet;

use super::super::random::Random;
use super::manner::Manner;

/// A member of a struct: name, type and value.
pub type Member = (String, String, String);

pub struct Draft {
    pub random: Random,
    /// `f64` or `f32`.
    pub scalar: &'static str,
    pub n: usize,
    drawn: BTreeSet<Manner>,
    pub used: BTreeSet<Manner>,
    /// Items of the module.
    pub items: Vec<String>,
    /// Constants and helpers of the block.
    pub block: Vec<String>,
    pub fields: Vec<Member>,
    /// Fields that are structs of their own: type and members.
    pub parts: Vec<(String, Vec<Member>)>,
    /// Items that are there once: what they are for, and their names.
    shared: Vec<(Manner, String)>,
    /// Expressions that the caller of a `macro_rules` hands on.
    pub fragments: Vec<String>,
    /// Locals of the caller, each with an expression of it.
    pub callers: Vec<(String, String)>,
    taken: BTreeSet<String>,
    /// Locals that may not be hidden here.
    pub live: Vec<String>,
}

/// Names of locals, which constants and temporaries of generated code have too.
const LOCALS: [&str; 26] = [
    "a", "b", "c", "d", "e", "f", "g", "h", "i1", "k", "l", "m", "p", "r", "s", "t", "w", "x", "y", "z",
    "q0", "t1", "half", "value", "cos_q0", "rest",
];

const WORDS: [&str; 12] = [
    "GRAVITY",
    "STIFFNESS",
    "LENGTH",
    "MASS",
    "DAMPING",
    "SPAN",
    "RATE",
    "GAIN",
    "OFFSET",
    "DEPTH",
    "WIDTH",
    "LOSS",
];

impl Draft {
    pub fn new(seed: u64) -> Self {
        let mut random = Random::new(seed ^ 0x7772_6974_7465_6e00);
        let drawn: BTreeSet<Manner> = Manner::ALL
            .iter()
            .filter(|(_, percent)| random.chance(*percent))
            .map(|(manner, _)| *manner)
            .collect();
        let single = drawn.contains(&Manner::Single);
        let mut draft = Self {
            random,
            scalar: if single { "f32" } else { "f64" },
            n: 1,
            drawn,
            used: BTreeSet::new(),
            items: Vec::new(),
            block: Vec::new(),
            fields: Vec::new(),
            parts: Vec::new(),
            shared: Vec::new(),
            fragments: Vec::new(),
            callers: Vec::new(),
            taken: ["q", "v", "u", "System", "self"].map(str::to_owned).into(),
            live: Vec::new(),
        };
        if single {
            draft.used.insert(Manner::Single);
        }
        draft
    }

    /// Whether the program may be written so, and now by chance is.
    pub fn may(&mut self, manner: Manner, percent: usize) -> bool {
        let is_so = self.drawn.contains(&manner) && self.random.chance(percent);
        if is_so {
            self.used.insert(manner);
        }
        is_so
    }

    /// The weight of a choice.
    pub fn weight(&self, manner: Manner, weight: usize) -> usize {
        if self.drawn.contains(&manner) { weight } else { 0 }
    }

    pub fn one_of(&mut self, texts: &[&str]) -> String {
        (*self.random.choice(texts)).to_owned()
    }

    /// A literal from `low` to `high`.
    pub fn number(&mut self, low: f64, high: f64) -> String {
        let x = low + self.random.unit() * (high - low);
        format!("{x:.2}")
    }

    /// A name that no item has yet, such as these.
    pub fn item(&mut self, names: &[&str]) -> String {
        let name = self.one_of(names);
        let mut free = name.clone();
        let mut count = 2;
        while !self.taken.insert(free.clone()) {
            free = format!("{name}{count}");
            count += 1;
        }
        free
    }

    /// The name of a constant.
    pub fn constant(&mut self) -> String {
        if self.may(Manner::OneLetter, 70) {
            const LETTERS: [&str; 20] = [
                "T", "D", "G", "K", "M", "T", "D", "L", "R", "A", "C", "N", "S", "E", "P", "W", "H", "Q",
                "V", "J",
            ];
            return self.item(&LETTERS);
        }
        self.item(&WORDS)
    }

    /// The name of a type; now and then one that generated code has too.
    pub fn type_name(&mut self, names: &[&str]) -> String {
        if self.may(Manner::GeneratedNames, 70) {
            const GENERATED: [&str; 10] = [
                "Force", "Real", "Dual", "Midpoint", "Gradient", "Lanes", "Mask", "Vector", "Stages",
                "Driven",
            ];
            return self.item(&GENERATED);
        }
        self.item(names)
    }

    /// A local that hides nothing that is read later: often the small letter of a constant.
    pub fn local(&mut self) -> String {
        let letters: Vec<String> =
            self.taken.iter().filter(|name| name.len() == 1).map(|name| name.to_lowercase()).collect();
        for _ in 0..20 {
            let name = if !letters.is_empty() && self.random.chance(50) {
                self.random.choice(&letters).clone()
            } else {
                self.one_of(&LOCALS)
            };
            if !self.taken.contains(&name) && !self.live.contains(&name) {
                self.live.push(name.clone());
                return name;
            }
        }
        let name = format!("x{}", self.live.len());
        self.live.push(name.clone());
        name
    }

    /// A local: the small letter of that constant, where it is free.
    pub fn small_letter(&mut self, constant: &str) -> String {
        let name = constant.to_lowercase();
        if self.taken.contains(&name) || self.live.contains(&name) {
            return self.local();
        }
        self.live.push(name.clone());
        name
    }

    /// Takes a name for good.
    pub fn take(&mut self, name: &str) {
        self.taken.insert(name.to_owned());
    }

    pub fn field(&mut self, names: &[&str], ty: &str, value: &str) -> String {
        let name = self.one_of(names);
        let is_there = |draft: &Self, name: &str| {
            draft.fields.iter().any(|(known, ..)| known == name)
                || draft.parts.iter().any(|(part, _)| part.to_lowercase() == name)
        };
        let mut free = name.clone();
        let mut count = 2;
        while is_there(self, &free) {
            free = format!("{name}{count}");
            count += 1;
        }
        self.fields.push((free.clone(), ty.to_owned(), value.to_owned()));
        free
    }

    /// The item for this manner, written where it is first asked for.
    pub fn shared(
        &mut self,
        manner: Manner,
        names: &[&str],
        item: impl FnOnce(&str, &str) -> String,
    ) -> String {
        if let Some((_, name)) = self.shared.iter().find(|(known, _)| *known == manner) {
            return name.clone();
        }
        let name = self.type_name(names);
        let item = item(&name, self.scalar);
        self.items.push(item);
        self.shared.push((manner, name.clone()));
        name
    }

    /// What `inside` writes, after which its locals may be hidden.
    pub fn scoped<T>(&mut self, inside: impl FnOnce(&mut Self) -> T) -> T {
        let live = self.live.len();
        let result = inside(self);
        self.live.truncate(live);
        result
    }
}
