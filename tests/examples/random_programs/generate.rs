//! Random programs, directed by types: what is written compiles.
//!
//! Borrows are kept apart by three lists: names that may not be read, names that may not be changed, and, for
//! closures and iterators that live on, the rule that they see immutable names alone.

mod chain;
mod choice;
mod declaration;
mod integer;
mod number;
mod pattern;
mod statement;
mod template;

use std::collections::BTreeSet;

use super::class::Class;
use super::random::Random;
use super::syntax::*;
use super::types::{Enumeration, Integer, Structure, Type};

/// Seeds from here on make programs with inputs and time as well.
pub const VIEWS_FROM: u64 = 1_000_000;

/// Seeds from here on make programs with ranges to the bounds of their types as well.
const BOUNDS_FROM: u64 = 20_000_000;

/// Options, enums and `matches!`: drawn where a program may hold them.
pub fn program(seed: u64) -> Program {
    let mut random = Random::new(seed);
    let by_chance =
        |(class, percent): &(Class, usize)| (*percent > 0 && random.chance(*percent)).then_some(*class);
    let mut drawn: BTreeSet<Class> = Class::ALL.iter().filter_map(by_chance).collect();
    // Programs are known by their seeds: the older ones stay what they were.
    let mut apart = Random::new(seed ^ 0x71d3_ab1e);
    let seen = [(Class::Input, 20), (Class::Time, 25)].map(|(class, percent)| (class, apart.chance(percent)));
    drawn.extend(
        seen.into_iter().filter_map(|(class, is_drawn)| (seed >= VIEWS_FROM && is_drawn).then_some(class)),
    );
    let n = *random.choice(&[1, 2, 2, 2, 3]);
    let mut generator = Generator {
        random,
        program: Program {
            seed,
            single: drawn.contains(&Class::SinglePrecision),
            n,
            enumerations: Vec::new(),
            structures: Vec::new(),
            constants: Vec::new(),
            fields: Vec::new(),
            helpers: Vec::new(),
            lagrangian: Block::default(),
            rayleigh: None,
            force: None,
            inputs: 0,
            timed: [false; 3],
            classes: BTreeSet::new(),
            has_cfg: false,
        },
        drawn,
        scope: Vec::new(),
        hidden: Vec::new(),
        locked: Vec::new(),
        only_immutable: false,
        reads: Vec::new(),
        loops: Vec::new(),
        names: 0,
        budget: 0,
        under_numbers: 0,
        result: Type::Real,
        own: 0,
        recursive: None,
    };
    generator.declarations();
    generator.functions();
    if generator.program.single {
        generator.used(Class::SinglePrecision);
    }
    generator.program
}

/// A name in scope.
#[derive(Clone)]
struct Binding {
    name: String,
    ty: Type,
    mutable: bool,
    /// Whether an integer or bool is known when the macro runs: no field and no comparison of numbers
    /// decides it.
    fixed: bool,
    /// An integer below this.
    below: Option<usize>,
    what: What,
}

#[derive(Clone)]
enum What {
    Value,
    Closure { parameters: Vec<Type>, result: Type },
}

/// A loop that can be left.
#[derive(Clone)]
struct Enclosing {
    label: Option<String>,
    /// Integers that decide when.
    counter: Option<String>,
}

struct Generator {
    random: Random,
    program: Program,
    drawn: BTreeSet<Class>,
    scope: Vec<Binding>,
    /// Names that may not be used at all, and those that may not be changed.
    hidden: Vec<String>,
    locked: Vec<String>,
    only_immutable: bool,
    /// Names used since the list was last emptied.
    reads: Vec<String>,
    loops: Vec<Enclosing>,
    names: usize,
    /// Expressions that may still be written.
    budget: i32,
    /// How many comparisons of numbers decide whether this place is reached.
    under_numbers: usize,
    /// What `return` returns.
    result: Type,
    /// Where the names of the innermost closure begin: it changes no others.
    own: usize,
    recursive: Option<usize>,
}

fn name(name: &str) -> Expression {
    Expression::Name(name.to_owned())
}

fn boxed(expression: Expression) -> Box<Expression> {
    Box::new(expression)
}

fn integer(value: i128, ty: Integer, suffixed: bool) -> Expression {
    Expression::Integer { value, ty, suffixed }
}

impl Generator {
    /// Whether the class is drawn, and now by chance.
    fn may(&mut self, class: Class, percent: usize) -> bool {
        self.drawn.contains(&class) && self.random.chance(percent)
    }

    /// The weight of a choice of the class.
    fn weight(&self, class: Class, weight: usize) -> usize {
        if self.drawn.contains(&class) { weight } else { 0 }
    }

    fn used(&mut self, class: Class) {
        self.program.classes.insert(class);
    }

    fn fresh(&mut self) -> String {
        const POOL: [&str; 10] = ["a", "b", "c", "d", "x", "y", "z", "s", "t", "w"];
        let plain = *self.random.choice(&POOL);
        if self.may(Class::Shadowing, 60) {
            if self.scope.iter().any(|binding| binding.name == plain) {
                self.used(Class::Shadowing);
            }
            // What is hidden or locked under this name must stay distinguishable.
            let is_free = !self.hidden.iter().chain(&self.locked).any(|name| name == plain);
            let is_counter = self.loops.iter().any(|l| l.counter.as_deref() == Some(plain));
            if is_free && !is_counter {
                return plain.to_owned();
            }
        }
        self.names += 1;
        format!("{plain}{}", self.names)
    }

    fn bind(&mut self, name: &str, ty: &Type, mutable: bool, fixed: bool) {
        self.scope.push(Binding {
            name: name.to_owned(),
            ty: ty.clone(),
            mutable,
            fixed,
            below: None,
            what: What::Value,
        });
    }

    /// What a name means here, innermost first, without what may not be used.
    fn visible(&self) -> Vec<Binding> {
        let mut seen = BTreeSet::new();
        let mut visible = Vec::new();
        for binding in self.scope.iter().rev() {
            if seen.insert(&binding.name)
                && !self.hidden.contains(&binding.name)
                && !(self.only_immutable && binding.mutable)
            {
                visible.push(binding.clone());
            }
        }
        visible
    }

    /// Runs `inside` and forgets the names bound there.
    fn scoped<T>(&mut self, inside: impl FnOnce(&mut Self) -> T) -> T {
        let (scope, locked, hidden) = (self.scope.len(), self.locked.len(), self.hidden.len());
        let result = inside(self);
        self.scope.truncate(scope);
        self.locked.truncate(locked);
        self.hidden.truncate(hidden);
        result
    }

    /// Places of the type: locals, their entries and members, fields, constants.
    fn places(&mut self, ty: &Type, fixed: bool) -> Vec<Expression> {
        let mut places = Vec::new();
        for binding in self.visible() {
            if matches!(binding.what, What::Value) && (!fixed || binding.fixed) {
                self.descend(name(&binding.name), &binding.ty, ty, &mut places);
            }
        }
        if !fixed && self.recursive.is_none_or(|helper| self.program.helpers[helper].with_self) {
            for (index, (field, field_ty, _)) in self.program.fields.clone().into_iter().enumerate() {
                let base = Expression::Member(boxed(Expression::System), Member::Named(field, index));
                self.descend(base, &field_ty, ty, &mut places);
            }
        }
        for (index, constant) in self.program.constants.clone().into_iter().enumerate() {
            // Module constants are read when the code runs; integers of the block when the macro does.
            if !fixed || (constant.in_block && matches!(constant.ty, Type::Integer(_))) {
                self.descend(Expression::Constant(index), &constant.ty, ty, &mut places);
            }
        }
        places
    }

    fn descend(&mut self, base: Expression, from: &Type, to: &Type, places: &mut Vec<Expression>) {
        if from == to {
            places.push(base);
            return;
        }
        match from {
            Type::Array(entry, length) | Type::Slice(entry, length) if *length > 0 => {
                let index = self.index(*length);
                self.descend(Expression::Index(boxed(base), boxed(index)), entry, to, places);
            }
            Type::Tuple(entries) => {
                for (index, entry) in entries.clone().iter().enumerate() {
                    let member = Expression::Member(boxed(base.clone()), Member::Numbered(index));
                    self.descend(member, entry, to, places);
                }
            }
            Type::Struct(of) => {
                let fields = self.program.structures[*of].fields.clone();
                for (index, (field, ty)) in fields.into_iter().enumerate() {
                    let member = Member::Named(field, index);
                    self.descend(Expression::Member(boxed(base.clone()), member), &ty, to, places);
                }
            }
            Type::Reference(inner) if **inner == *to => {
                places.push(Expression::Dereferenced(boxed(base)));
            }
            Type::Reference(inner) => self.descend(base, inner, to, places),
            _ => {}
        }
    }

    /// An index below `length`.
    fn index(&mut self, length: usize) -> Expression {
        let counters: Vec<Binding> = self
            .visible()
            .into_iter()
            .filter(|binding| {
                binding.ty == Type::Integer(Integer::USIZE)
                    && binding.below.is_some_and(|below| below <= length)
            })
            .collect();
        if !counters.is_empty() && self.random.chance(60) {
            return name(&self.random.choice(&counters).name);
        }
        integer(self.random.below(length) as i128, Integer::USIZE, false)
    }

    /// Some place of the type.
    fn place(&mut self, ty: &Type, fixed: bool) -> Option<Expression> {
        let places = self.places(ty, fixed);
        if places.is_empty() {
            return None;
        }
        // Locals half of the time: fields and constants are many.
        let local: Vec<&Expression> = places.iter().filter(|place| root_of(place).is_some()).collect();
        let chosen = if !local.is_empty() && self.random.chance(70) {
            (*self.random.choice(&local)).clone()
        } else {
            self.random.choice(&places).clone()
        };
        if let Some(root) = root_of(&chosen) {
            self.reads.push(root.to_owned());
        }
        Some(chosen)
    }

    /// An expression of any type.
    fn expression(&mut self, ty: &Type, depth: usize) -> Expression {
        self.budget -= 1;
        match ty {
            Type::Real => self.number(depth),
            Type::Single => self.single(),
            Type::Bool => self.truth(depth),
            Type::Integer(integer) => self.known_integer(*integer, depth),
            _ => self.composite(ty, depth),
        }
    }

    fn composite(&mut self, ty: &Type, depth: usize) -> Expression {
        if self.random.chance(40)
            && let Some(place) = self.place(ty, false)
        {
            return place;
        }
        if depth > 1 && self.budget > 0 {
            if self.may(Class::BlockExpressions, 15) {
                return self.block_expression(ty, depth);
            }
            if self.may(Class::KnownIf, 10) {
                return self.if_expression(ty, depth - 1);
            }
        }
        let inner = depth.saturating_sub(1);
        match ty {
            Type::Array(entry, length) => {
                if self.random.chance(15) {
                    return Expression::Repeated(boxed(self.expression(entry, inner)), *length);
                }
                if **entry == Type::Real && self.may(Class::Closure, 25) {
                    return self.mapped_array(*length, inner);
                }
                let entries = (0..*length).map(|_| self.expression(entry, inner)).collect();
                Expression::Array(entries)
            }
            Type::Tuple(entries) => {
                let entries = entries.iter().map(|entry| self.expression(entry, inner)).collect();
                Expression::Tuple(entries)
            }
            Type::Option(of) => {
                self.used(Class::Options);
                let some = self.random.chance(60).then(|| boxed(self.expression(of, inner)));
                Expression::Optional(some)
            }
            Type::Enum(of) => {
                self.used(Class::Enumerations);
                let variants = self.program.enumerations[*of].variants.clone();
                let variant = self.random.below(variants.len());
                let data = variants[variant].1.iter().map(|ty| self.expression(ty, inner)).collect();
                Expression::Variant { of: *of, variant, data }
            }
            Type::Reference(of) => match self.place(of, false) {
                Some(place) => {
                    if let Some(root) = root_of(&place) {
                        self.locked.push(root.to_owned());
                    }
                    Expression::Borrowed(boxed(place))
                }
                None => Expression::Borrowed(boxed(self.expression(of, 0))),
            },
            _ => unreachable!("no expression of this type is asked for"),
        }
    }
}

/// The local that a place belongs to.
fn root_of(place: &Expression) -> Option<&str> {
    match place {
        Expression::Name(name) => Some(name),
        Expression::Index(base, _)
        | Expression::Member(base, _)
        | Expression::Dereferenced(base)
        | Expression::Borrowed(base) => root_of(base),
        _ => None,
    }
}
