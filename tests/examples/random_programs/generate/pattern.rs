//! Patterns of a type, with the names that they bind.

use super::*;

impl Generator {
    fn named(&mut self, taken: &mut Vec<String>) -> String {
        loop {
            let name = self.fresh();
            if !taken.contains(&name) {
                taken.push(name.clone());
                return name;
            }
        }
    }

    /// A pattern that matches every value.
    pub fn irrefutable(&mut self, ty: &Type, fixed: bool, mutable: bool) -> Pattern {
        let mut taken = Vec::new();
        let mut bound = Vec::new();
        let pattern = self.whole(ty, mutable, &mut taken, &mut bound);
        self.bind_all(bound, fixed);
        pattern
    }

    fn bind_all(&mut self, bound: Vec<(String, Type, bool)>, fixed: bool) {
        for (name, ty, mutable) in bound {
            self.bind(&name, &ty, mutable, fixed);
        }
    }

    fn whole(
        &mut self,
        ty: &Type,
        mutable: bool,
        taken: &mut Vec<String>,
        bound: &mut Vec<(String, Type, bool)>,
    ) -> Pattern {
        match ty {
            Type::Tuple(entries) if !entries.is_empty() && self.may(Class::TuplePattern, 85) => {
                self.used(Class::TuplePattern);
                let patterns = entries.iter().map(|entry| self.whole(entry, mutable, taken, bound)).collect();
                return Pattern::Tuple(patterns);
            }
            Type::Array(entry, length) if *length > 0 && self.may(Class::SlicePattern, 40) => {
                self.used(Class::SlicePattern);
                let (mut before, mut rest, mut after) = (Vec::new(), None, Vec::new());
                if self.may(Class::RestPattern, 50) {
                    self.used(Class::RestPattern);
                    let split = self.random.below(*length);
                    let last = self.random.below(*length - split + 1);
                    for _ in 0..split {
                        before.push(self.whole(entry, mutable, taken, bound));
                    }
                    for _ in 0..last {
                        after.push(self.whole(entry, mutable, taken, bound));
                    }
                    let between = *length - split - last;
                    rest = Some(if self.random.chance(50) && between > 0 {
                        let name = self.named(taken);
                        bound.push((name.clone(), Type::Array(entry.clone(), between), false));
                        Some(name)
                    } else {
                        None
                    });
                } else {
                    for _ in 0..*length {
                        before.push(self.whole(entry, mutable, taken, bound));
                    }
                }
                return Pattern::Slice(before, rest, after);
            }
            Type::Reference(inner) if inner.is_scalar() && self.may(Class::ReferencePattern, 50) => {
                self.used(Class::ReferencePattern);
                return Pattern::Reference(Box::new(self.whole(inner, false, taken, bound)));
            }
            _ => {}
        }
        if self.random.chance(5) {
            return Pattern::Wild;
        }
        let name = self.named(taken);
        let mutable =
            mutable && !matches!(ty, Type::Reference(_) | Type::Slice(..)) && self.random.chance(60);
        bound.push((name.clone(), ty.clone(), mutable));
        Pattern::Name { name, mutable }
    }

    /// A pattern that may not match.
    pub fn refutable(&mut self, ty: &Type, fixed: bool) -> Pattern {
        let (mut taken, mut bound) = (Vec::new(), Vec::new());
        let pattern = self.part(ty, &mut taken, &mut bound);
        self.bind_all(bound, fixed);
        pattern
    }

    fn part(&mut self, ty: &Type, taken: &mut Vec<String>, bound: &mut Vec<(String, Type, bool)>) -> Pattern {
        match ty {
            Type::Bool => Pattern::Bool(self.random.chance(50)),
            Type::Integer(integer) => self.integer_pattern(*integer, taken, bound),
            Type::Tuple(entries) if !entries.is_empty() => {
                let patterns = entries.iter().map(|entry| self.part(entry, taken, bound)).collect();
                self.used(Class::TuplePattern);
                Pattern::Tuple(patterns)
            }
            Type::Option(inner) => {
                self.used(Class::Options);
                let some = self.random.chance(65);
                Pattern::Optional(some.then(|| Box::new(self.whole(inner, false, taken, bound))))
            }
            Type::Enum(of) => {
                self.used(Class::Enumerations);
                let variants = self.program.enumerations[*of].variants.clone();
                let variant = self.random.below(variants.len());
                let data = &variants[variant].1;
                let rest = !data.is_empty() && self.random.chance(15);
                let data = if rest {
                    Vec::new()
                } else {
                    data.iter().map(|ty| self.whole(ty, false, taken, bound)).collect()
                };
                Pattern::Variant { of: *of, variant, data, rest }
            }
            ty => self.whole(ty, false, taken, bound),
        }
    }

    fn integer_pattern(
        &mut self,
        ty: Integer,
        taken: &mut Vec<String>,
        bound: &mut Vec<(String, Type, bool)>,
    ) -> Pattern {
        let literal = |this: &mut Self| {
            let value = this.random.below(8) as i128;
            if ty.signed && this.random.chance(20) { -value } else { value }
        };
        if self.may(Class::ConstantPattern, 50) {
            let constants: Vec<usize> = (0..self.program.constants.len())
                .filter(|&index| self.program.constants[index].ty == Type::Integer(ty))
                .collect();
            if !constants.is_empty() {
                self.used(Class::ConstantPattern);
                return Pattern::Constant(*self.random.choice(&constants));
            }
        }
        if self.may(Class::AtPattern, 40) {
            self.used(Class::AtPattern);
            let name = self.named(taken);
            let low = literal(self);
            bound.push((name.clone(), Type::Integer(ty), false));
            return Pattern::At(name, Box::new(Pattern::Range(Some(low), Some(low + 4), true)));
        }
        if self.may(Class::OrPattern, 40) {
            self.used(Class::OrPattern);
            let patterns = (0..2 + self.random.below(2)).map(|_| Pattern::Integer(literal(self))).collect();
            return Pattern::Or(patterns);
        }
        if self.may(Class::RangePattern, 50) {
            self.used(Class::RangePattern);
            let low = literal(self);
            return match self.random.below(4) {
                0 => Pattern::Range(Some(low), Some(low + 3), false),
                1 => Pattern::Range(Some(low), None, false),
                2 if low > 0 => Pattern::Range(None, Some(low), self.random.chance(50)),
                _ => Pattern::Range(Some(low), Some(low + 2), true),
            };
        }
        Pattern::Integer(literal(self))
    }

    /// Arms whose last one takes all that is left.
    pub fn arms(&mut self, of: &Type, ty: &Type, depth: usize, fixed: bool) -> Vec<Arm> {
        let count = 1 + self.random.below(3);
        let mut arms = Vec::new();
        for index in 0..=count {
            let arm = self.scoped(|this| {
                let is_last = index == count;
                let pattern = match of {
                    _ if is_last && this.random.chance(60) => Pattern::Wild,
                    of if is_last => {
                        let name = this.fresh();
                        this.bind(&name, of, false, fixed);
                        Pattern::Name { name, mutable: false }
                    }
                    of => this.refutable(of, fixed),
                };
                let guard = (!is_last && this.may(Class::Guard, 40)).then(|| {
                    this.used(Class::Guard);
                    let only_immutable = std::mem::replace(&mut this.only_immutable, true);
                    let guard = if this.random.chance(70) { this.known_truth(1) } else { this.truth(1) };
                    this.only_immutable = only_immutable;
                    guard
                });
                let body = match ty {
                    Type::Integer(integer) => this.known_integer(*integer, depth.min(1)),
                    ty if depth > 0 && this.random.chance(25) => {
                        Expression::Block(None, this.block(ty, depth, 1))
                    }
                    ty => this.expression(ty, depth),
                };
                Arm { pattern, guard, body }
            });
            arms.push(arm);
        }
        arms
    }
}
