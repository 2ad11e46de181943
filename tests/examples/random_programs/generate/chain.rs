//! Iterator chains, closures, and what consumes them.

use super::*;

/// What is known of an iterator while it is built.
struct Shape {
    item: Type,
    /// Whether its length is exact, and whether it can be run from its end.
    exact: bool,
    double_ended: bool,
    fixed: bool,
}

impl Generator {
    /// A closure over these parameters.
    pub fn closure_of(
        &mut self,
        parameters: &[Type],
        result: &Type,
        depth: usize,
        annotated: bool,
    ) -> Closure {
        self.used(Class::Closure);
        let own = std::mem::replace(&mut self.own, self.scope.len());
        let loops = std::mem::take(&mut self.loops);
        let closure = self.scoped(|this| {
            let mut taken = Vec::new();
            let parameters = parameters
                .iter()
                .map(|ty| {
                    let pattern = loop {
                        let scope = this.scope.len();
                        let pattern = this.irrefutable(ty, true, false);
                        let names: Vec<String> =
                            this.scope[scope..].iter().map(|binding| binding.name.clone()).collect();
                        if names.iter().all(|name| !taken.contains(name)) {
                            taken.extend(names);
                            break pattern;
                        }
                        this.scope.truncate(scope);
                    };
                    (pattern, annotated.then(|| ty.clone()))
                })
                .collect();
            let body = match result {
                Type::Bool => this.known_truth(2),
                ty if this.drawn.contains(&Class::BlockExpressions) && this.random.chance(20) => {
                    Expression::Block(None, this.block(ty, depth, 1))
                }
                Type::Integer(ty) => this.known_integer(*ty, depth),
                ty => this.expression(ty, depth),
            };
            Closure { parameters, body, moves: false }
        });
        self.own = own;
        self.loops = loops;
        closure
    }

    /// `a.map(|x| …)`.
    pub fn mapped_array(&mut self, length: usize, depth: usize) -> Expression {
        let array = Type::Array(Box::new(Type::Real), length);
        let base = match self.place(&array, false) {
            Some(place) => place,
            None => Expression::Repeated(boxed(self.number(0)), length),
        };
        let locked = self.locked.len();
        self.locked.extend(root_of(&base).map(str::to_owned));
        let closure = self.closure_of(&[Type::Real], &Type::Real, depth, false);
        self.locked.truncate(locked);
        Expression::Mapped(boxed(base), Box::new(closure))
    }

    /// A number from items of this type, for the body of a closure.
    fn source(&mut self, of_loop: bool) -> (Source, Shape) {
        let visible: Vec<(String, Type)> = self
            .visible()
            .into_iter()
            .filter(|binding| matches!(binding.what, What::Value))
            .map(|binding| (binding.name, binding.ty))
            .collect();
        let arrays: Vec<(String, Type)> = visible
            .into_iter()
            .filter(|(_, ty)| matches!(ty, Type::Array(entry, length) if *length > 0 && !matches!(**entry, Type::Reference(_))))
            .collect();
        if arrays.is_empty() || self.random.chance(if of_loop { 50 } else { 25 }) {
            let ty = if self.random.chance(75) { Integer::USIZE } else { *self.random.choice(&Integer::ALL) };
            let mut closed = self.random.chance(25);
            let (mut start, mut end) = (self.random.below(2) as i128, 2 + self.random.below(3) as i128);
            if self.program.seed >= BOUNDS_FROM && self.may(Class::IntegerBounds, 25) {
                self.used(Class::IntegerBounds);
                (start, end, closed) = (ty.greatest() - end, ty.greatest(), true);
            }
            let source =
                Source::Range { start: integer(start, ty, true), end: integer(end, ty, false), closed };
            let exact = !closed && (ty.size || ty.bits <= 32);
            return (source, Shape { item: Type::Integer(ty), exact, double_ended: true, fixed: true });
        }
        let (array, ty) = self.random.choice(&arrays).clone();
        let Type::Array(entry, length) = ty else { unreachable!("only arrays are listed") };
        self.locked.push(array.clone());
        self.reads.push(array.clone());
        let shape = |item| Shape { item, exact: true, double_ended: true, fixed: false };
        let array = name(&array);
        if self.may(Class::Windows, 30) {
            self.used(Class::Windows);
            let width = 1 + self.random.below(length.min(2));
            return match self.random.below(3) {
                0 => (Source::Windows(array, width), shape(Type::Slice(entry, width))),
                1 => (Source::Chunks(array, width, true), shape(Type::Slice(entry, width))),
                _ => (Source::Chunks(array, width, false), shape(Type::Slice(entry, 1))),
            };
        }
        match self.random.below(5) {
            0 => (Source::IntoIter(array), shape(*entry)),
            1 if of_loop => (Source::Plain(array), shape(*entry)),
            2 if of_loop => {
                (Source::Plain(Expression::Borrowed(boxed(array))), shape(Type::Reference(entry)))
            }
            _ => (Source::Iter(array), shape(Type::Reference(entry))),
        }
    }

    /// A chain; what it ends with is the caller's.
    fn build(&mut self, of_loop: bool, adaptors: usize) -> (Chain, Shape) {
        let (source, mut shape) = self.source(of_loop);
        let mut chain = Chain { source, adaptors: Vec::new() };
        if matches!(chain.source, Source::Plain(_)) {
            return (chain, shape);
        }
        for _ in 0..adaptors {
            self.adapt(&mut chain, &mut shape);
        }
        (chain, shape)
    }

    fn adapt(&mut self, chain: &mut Chain, shape: &mut Shape) {
        let is_real = matches!(shape.item, Type::Real);
        let of_reals = matches!(&shape.item, Type::Reference(inner) if **inner == Type::Real);
        let known = matches!(shape.item, Type::Integer(_)) && shape.fixed;
        let weights = [
            self.weight(Class::Map, 10),
            self.weight(Class::Zip, 8),
            self.weight(Class::Enumerate, 6),
            if shape.double_ended { self.weight(Class::Reversed, 8) } else { 0 },
            self.weight(Class::SkipTake, 9),
            self.weight(Class::Linked, if is_real || of_reals { 5 } else { 0 }),
            self.weight(Class::Filter, if known { 12 } else { 2 }),
            self.weight(Class::FlatMap, 4),
            if of_reals { 4 } else { 0 },
        ];
        let Some(choice) = self.random.weighted(&weights) else { return };
        let adaptor = match choice {
            0 => {
                self.used(Class::Map);
                if is_real && self.may(Class::FunctionHanded, 50) {
                    self.used(Class::FunctionHanded);
                    let helpers: Vec<usize> = self
                        .callable(&Type::Real)
                        .into_iter()
                        .filter(|&helper| {
                            let helper = &self.program.helpers[helper];
                            let parameters: Vec<&Type> =
                                helper.parameters.iter().map(|(.., ty)| ty).collect();
                            !helper.with_self && parameters == [&Type::Real]
                        })
                        .collect();
                    if !helpers.is_empty() && self.random.chance(60) {
                        Adaptor::Map(Handed::Helper(*self.random.choice(&helpers)))
                    } else {
                        Adaptor::Map(Handed::Method(
                            self.random.choice::<&'static str>(&["sin", "cos", "tanh", "abs"]),
                        ))
                    }
                } else {
                    let result = match self.random.below(8) {
                        0 => Type::Tuple(vec![Type::Real, Type::Real]),
                        1 if known => shape.item.clone(),
                        _ => Type::Real,
                    };
                    let closure = self.closure_of(std::slice::from_ref(&shape.item), &result, 2, false);
                    shape.fixed = known && result == shape.item;
                    shape.item = result;
                    Adaptor::Map(Handed::Closure(Box::new(closure)))
                }
            }
            1 => {
                self.used(Class::Zip);
                let adaptors = usize::from(self.random.chance(30));
                let (other, of_other) = self.build(false, adaptors);
                shape.item = Type::Tuple(vec![shape.item.clone(), of_other.item]);
                shape.exact &= of_other.exact;
                shape.double_ended &= of_other.double_ended && shape.exact;
                shape.fixed &= of_other.fixed;
                Adaptor::Zip(Box::new(other), false)
            }
            2 => {
                self.used(Class::Enumerate);
                shape.item = Type::Tuple(vec![Type::Integer(Integer::USIZE), shape.item.clone()]);
                shape.double_ended &= shape.exact;
                Adaptor::Enumerate
            }
            3 => {
                self.used(Class::Reversed);
                Adaptor::Reversed
            }
            4 => {
                self.used(Class::SkipTake);
                shape.double_ended &= shape.exact;
                match self.random.below(3) {
                    0 => Adaptor::Skip(self.random.below(3)),
                    1 => Adaptor::Take(self.random.below(4)),
                    _ => Adaptor::StepBy(1 + self.random.below(3)),
                }
            }
            5 => {
                self.used(Class::Linked);
                let Some(other) = self.place_of_array() else { return };
                shape.exact = false;
                let source = if is_real { Source::IntoIter(other) } else { Source::Iter(other) };
                Adaptor::Linked(Box::new(Chain { source, adaptors: Vec::new() }))
            }
            6 => {
                self.used(Class::Filter);
                // The closure sees a reference to the item.
                let seen = Type::Reference(Box::new(shape.item.clone()));
                let closure = self.closure_of(&[seen], &Type::Bool, 1, false);
                shape.exact = false;
                Adaptor::Filter(Handed::Closure(Box::new(closure)))
            }
            7 => {
                self.used(Class::FlatMap);
                let result = Type::Array(Box::new(Type::Real), 2);
                let closure = self.closure_of(std::slice::from_ref(&shape.item), &result, 1, false);
                *shape = Shape { item: Type::Real, exact: false, double_ended: false, fixed: false };
                Adaptor::FlatMap(Handed::Closure(Box::new(closure)))
            }
            _ => {
                shape.item = Type::Real;
                Adaptor::Copied
            }
        };
        chain.adaptors.push(adaptor);
    }

    fn place_of_array(&mut self) -> Option<Expression> {
        let array = Type::Array(Box::new(Type::Real), self.program.n);
        let place = self.places(&array, false).into_iter().find(|place| root_of(place).is_some())?;
        self.locked.extend(root_of(&place).map(str::to_owned));
        Some(place)
    }

    fn adaptors(&mut self) -> usize {
        self.random.below(4)
    }

    /// The chain with a closure at its end, where its items are no numbers.
    fn end_in_numbers(&mut self, chain: &mut Chain, shape: &mut Shape) {
        if shape.item == Type::Real || shape.item == Type::Reference(Box::new(Type::Real)) {
            return;
        }
        self.used(Class::Map);
        let closure = self.closure_of(std::slice::from_ref(&shape.item), &Type::Real, 2, false);
        shape.item = Type::Real;
        chain.adaptors.push(Adaptor::Map(Handed::Closure(Box::new(closure))));
    }

    pub fn number_of_chain(&mut self, depth: usize) -> Expression {
        self.used(Class::Chains);
        let locked = self.locked.len();
        let adaptors = self.adaptors();
        let (mut chain, mut shape) = self.build(false, adaptors);
        let result = if self.may(Class::Fold, 40) {
            self.used(Class::Fold);
            let start = match self.number(depth.min(1)) {
                Expression::Real { value, .. } => Expression::Real { value, suffixed: true },
                start => start,
            };
            let closure = self.closure_of(&[Type::Real, shape.item], &Type::Real, 2, false);
            Expression::Chain(
                Box::new(chain),
                Consumer::Fold(boxed(start), Handed::Closure(Box::new(closure))),
            )
        } else {
            self.end_in_numbers(&mut chain, &mut shape);
            let consumer = if self.random.chance(80) {
                Consumer::Sum(Kind::Real, true)
            } else {
                Consumer::Product(Kind::Real, true)
            };
            Expression::Chain(Box::new(chain), consumer)
        };
        self.locked.truncate(locked);
        result
    }

    pub fn count_of_chain(&mut self) -> Expression {
        self.used(Class::Chains);
        let locked = self.locked.len();
        let adaptors = self.adaptors();
        let (chain, shape) = self.build(false, adaptors);
        self.locked.truncate(locked);
        let consumer = match shape.item {
            Type::Integer(ty) if ty == Integer::USIZE && shape.fixed && self.random.chance(60) => {
                Consumer::Sum(Kind::Integer(ty), true)
            }
            _ => Consumer::Count,
        };
        Expression::Chain(Box::new(chain), consumer)
    }

    /// What a `for` runs over: the chain, its items, whether they are known, and a bound of an index.
    pub fn chain_of_loop(&mut self) -> (Chain, Type, bool, Option<usize>) {
        let adaptors = if self.drawn.contains(&Class::ForArray) { self.random.below(3) } else { 0 };
        // Its closures live as long as the loop, whose body may change what is mutable.
        let only_immutable = std::mem::replace(&mut self.only_immutable, true);
        let (chain, shape) = self.build(true, adaptors);
        self.only_immutable = only_immutable;
        let below = match &chain.source {
            Source::Range { end: Expression::Integer { value, .. }, closed, .. }
                if chain.adaptors.is_empty() =>
            {
                Some((*value as usize).saturating_add(usize::from(*closed)))
            }
            _ => None,
        };
        let fixed = shape.fixed || matches!(shape.item, Type::Tuple(_));
        (chain, shape.item, fixed, below)
    }

    /// An iterator of numbers in a local, and statements that consume it in parts.
    pub fn iterator_in_parts(&mut self, statements: &mut Vec<Statement>) {
        self.used(Class::IteratorLocal);
        let only_immutable = std::mem::replace(&mut self.only_immutable, true);
        let locked = self.locked.len();
        let adaptors = self.random.below(3);
        let (mut chain, mut shape) = self.build(false, adaptors);
        self.end_in_numbers(&mut chain, &mut shape);
        if shape.item != Type::Real {
            chain.adaptors.push(Adaptor::Copied);
        }
        self.only_immutable = only_immutable;
        self.locked.truncate(locked);
        self.names += 1;
        let iterator = format!("items{}", self.names);
        statements.push(Statement::LetIterator { name: iterator.clone(), chain });
        let parts = 2 + self.random.below(2);
        for part in 0..parts {
            let is_last = part + 1 == parts;
            let source = if is_last && self.random.chance(60) {
                Source::Local(iterator.clone())
            } else {
                Source::ByReference(iterator.clone())
            };
            let adaptors = if is_last && self.random.chance(50) {
                Vec::new()
            } else {
                vec![Adaptor::Take(1 + self.random.below(2))]
            };
            let part = Chain { source, adaptors };
            let variable = self.fresh();
            let value = if self.may(Class::Options, 40) {
                let next = Expression::Chain(
                    Box::new(Chain { source: Source::ByReference(iterator.clone()), adaptors: Vec::new() }),
                    Consumer::Next,
                );
                Expression::UnwrapOr(boxed(next), boxed(Expression::Real { value: 0.5, suffixed: true }))
            } else {
                Expression::Chain(Box::new(part), Consumer::Sum(Kind::Real, true))
            };
            statements.push(Statement::Let {
                pattern: Pattern::Name { name: variable.clone(), mutable: false },
                ty: None,
                value: Some(value),
            });
            self.bind(&variable, &Type::Real, false, false);
        }
    }
}
