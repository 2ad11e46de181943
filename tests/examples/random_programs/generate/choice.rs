//! Expressions that choose or hold statements: `if`, `match`, blocks, Options, side effects in operands.

use super::integer::tail;
use super::*;

impl Generator {
    /// `if` on numbers: both branches are run by the macro.
    pub fn if_on_numbers(&mut self, ty: &Type, depth: usize) -> Expression {
        self.used(Class::If);
        let condition = self.condition_on_numbers(depth.min(2));
        self.under_numbers += 1;
        let then = self.block(ty, depth, 1);
        let otherwise = if self.random.chance(20) && depth > 0 {
            tail(self.if_on_numbers(ty, depth - 1))
        } else {
            self.block(ty, depth, 1)
        };
        self.under_numbers -= 1;
        Expression::If(boxed(condition), then, Some(otherwise))
    }

    /// `if` on what is known, on fields, or on numbers.
    pub fn if_expression(&mut self, ty: &Type, depth: usize) -> Expression {
        self.used(Class::KnownIf);
        let is_known = self.random.chance(60);
        let condition = if is_known { self.known_truth(2) } else { self.truth(2) };
        self.under_numbers += usize::from(!is_known);
        let (then, otherwise) = (self.block(ty, depth, 1), self.block(ty, depth, 1));
        self.under_numbers -= usize::from(!is_known);
        Expression::If(boxed(condition), then, Some(otherwise))
    }

    /// A block with this type.
    pub fn block(&mut self, ty: &Type, depth: usize, statements: usize) -> Block {
        self.scoped(|this| {
            let mut block = Block::default();
            if depth > 0 && this.budget > 0 {
                for _ in 0..this.random.below(statements + 1) {
                    this.statement(depth.min(2), &mut block.statements);
                }
            }
            block.tail = Some(boxed(this.expression(ty, depth)));
            block
        })
    }

    pub fn block_expression(&mut self, ty: &Type, depth: usize) -> Expression {
        self.used(Class::BlockExpressions);
        Expression::Block(None, self.block(ty, depth - 1, 2))
    }

    /// A mutable local of the type that may be changed here.
    pub fn changeable(&mut self, ty: &Type) -> Option<String> {
        // Where numbers decide, integers are left alone, most of the time.
        if self.under_numbers > 0 && matches!(ty, Type::Integer(_) | Type::Bool) && !self.random.chance(4) {
            return None;
        }
        let found: Vec<String> = self
            .visible()
            .into_iter()
            .filter(|binding| {
                binding.mutable
                    && binding.ty == *ty
                    && matches!(binding.what, What::Value)
                    && !self.locked.contains(&binding.name)
                    && self.scope[self.own.min(self.scope.len())..].iter().any(|own| own.name == binding.name)
            })
            .map(|binding| binding.name)
            .collect();
        (!found.is_empty() && !self.only_immutable).then(|| self.random.choice(&found).clone())
    }

    /// `{ x += 1.0; y }`: what comes after sees the change.
    pub fn effect(&mut self, ty: &Type, depth: usize) -> Expression {
        let integer_ty = self.integer_in_scope();
        let target = if self.random.chance(50) { Type::Integer(integer_ty) } else { Type::Real };
        let Some(changed) = self.changeable(&target) else {
            return match ty {
                Type::Bool => self.known_truth(0),
                Type::Integer(ty) => self.known_integer(*ty, 0),
                ty => self.expression(ty, 0),
            };
        };
        self.used(Class::SideEffects);
        let change = match target {
            Type::Integer(ty) => Expression::Compound(
                Operator::Add,
                Kind::Integer(ty),
                boxed(name(&changed)),
                boxed(integer(1 + self.random.below(2) as i128, ty, false)),
            ),
            _ => {
                let by = self.number(depth.min(1));
                let operator = *self.random.choice(&[Operator::Add, Operator::Subtract]);
                Expression::Compound(operator, Kind::Real, boxed(name(&changed)), boxed(by))
            }
        };
        let value = if target == *ty && self.random.chance(50) {
            name(&changed)
        } else {
            match ty {
                Type::Bool if self.random.chance(60) || self.under_numbers == 0 => {
                    self.known_truth(depth.min(1))
                }
                Type::Bool => self.truth(depth.min(1)),
                Type::Integer(ty) => self.known_integer(*ty, depth.min(1)),
                ty => self.expression(ty, depth.min(1)),
            }
        };
        Expression::Block(
            None,
            Block { statements: vec![Statement::Expression(change)], tail: Some(boxed(value)) },
        )
    }

    /// `a[{ i += 1; i % 3 }]`.
    pub fn indexed_with_effect(&mut self) -> Option<Expression> {
        let arrays: Vec<Binding> = self
            .visible()
            .into_iter()
            .filter(|binding| matches!(&binding.ty, Type::Array(entry, _) if **entry == Type::Real))
            .collect();
        if arrays.is_empty() {
            return None;
        }
        let array = self.random.choice(&arrays).clone();
        let Type::Array(_, length) = array.ty else { return None };
        let index = self.changing_index(length)?;
        self.reads.push(array.name.clone());
        Some(Expression::Index(boxed(name(&array.name)), boxed(index)))
    }

    /// `{ i += 1; i % n }`.
    pub fn changing_index(&mut self, length: usize) -> Option<Expression> {
        let counter = self.changeable(&Type::Integer(Integer::USIZE))?;
        self.used(Class::IndexEffects);
        let kind = Kind::Integer(Integer::USIZE);
        let change = Expression::Compound(
            Operator::Add,
            kind,
            boxed(name(&counter)),
            boxed(integer(1, Integer::USIZE, false)),
        );
        let value = Expression::Arithmetic(
            Operator::Remainder,
            kind,
            boxed(name(&counter)),
            boxed(integer(length as i128, Integer::USIZE, false)),
        );
        Some(Expression::Block(
            None,
            Block { statements: vec![Statement::Expression(change)], tail: Some(boxed(value)) },
        ))
    }

    /// `match` on something that is known.
    pub fn match_expression(&mut self, ty: &Type, depth: usize) -> Expression {
        self.used(Class::Match);
        let (scrutinee, of) = self.scrutinee(depth);
        let locked = self.locked.len();
        if let Some(root) = root_of(&scrutinee) {
            self.locked.push(root.to_owned());
        }
        let arms = self.arms(&of, ty, depth, true);
        self.locked.truncate(locked);
        Expression::Match(boxed(scrutinee), arms)
    }

    fn scrutinee(&mut self, depth: usize) -> (Expression, Type) {
        match self.random.below(6) {
            0 => (self.known_truth(depth.min(1)), Type::Bool),
            1 if self.drawn.contains(&Class::TuplePattern) => {
                let ty = self.integer_in_scope();
                let second = if self.random.chance(50) { Type::Bool } else { Type::Real };
                let a = self.known_integer(ty, 1);
                let b = match second {
                    Type::Bool => self.known_truth(1),
                    _ => self.number(1),
                };
                (Expression::Tuple(vec![a, b]), Type::Tuple(vec![Type::Integer(ty), second]))
            }
            2 if self.drawn.contains(&Class::SlicePattern) => {
                let array = Type::Array(Box::new(Type::Real), self.program.n);
                (self.expression(&array, 1), array)
            }
            _ => {
                let ty = self.integer_in_scope();
                let scrutinee = if self.may(Class::SideEffects, 40) {
                    self.effect(&Type::Integer(ty), 1)
                } else {
                    self.known_integer(ty, depth.min(2))
                };
                (scrutinee, Type::Integer(ty))
            }
        }
    }

    /// `match` on a field, an Option or an enum.
    pub fn match_field(&mut self, ty: &Type, depth: usize) -> Expression {
        let (scrutinee, of) = match self.scrutinee_of_choice() {
            Some(found) => found,
            None => {
                let integer = *self.random.choice(&Integer::ALL);
                match self.place(&Type::Integer(integer), false) {
                    Some(place) => (place, Type::Integer(integer)),
                    None => return self.expression(ty, 0),
                }
            }
        };
        self.used(Class::MatchField);
        let locked = self.locked.len();
        if let Some(root) = root_of(&scrutinee) {
            self.locked.push(root.to_owned());
        }
        self.under_numbers += 1;
        let arms = self.arms(&of, ty, depth, false);
        self.under_numbers -= 1;
        self.locked.truncate(locked);
        Expression::Match(boxed(scrutinee), arms)
    }

    /// An Option or an enum in a local or a field.
    fn scrutinee_of_choice(&mut self) -> Option<(Expression, Type)> {
        let mut types = Vec::new();
        if self.drawn.contains(&Class::Options) {
            types.push(Type::Option(Box::new(Type::Real)));
        }
        types.extend((0..self.program.enumerations.len()).map(Type::Enum));
        if types.is_empty() {
            return None;
        }
        let ty = self.random.choice(&types).clone();
        let place = self.place(&ty, false)?;
        self.used(if matches!(ty, Type::Option(_)) { Class::Options } else { Class::Enumerations });
        Some((place, ty))
    }

    pub fn if_let(&mut self, ty: &Type, depth: usize) -> Expression {
        self.used(Class::IfLet);
        let (scrutinee, of, fixed) = match self.scrutinee_of_choice() {
            Some((place, of)) => (place, of, false),
            None => {
                let (scrutinee, of) = self.scrutinee(depth);
                (scrutinee, of, true)
            }
        };
        let locked = self.locked.len();
        if let Some(root) = root_of(&scrutinee) {
            self.locked.push(root.to_owned());
        }
        self.under_numbers += usize::from(!fixed);
        let (pattern, then) = self.scoped(|this| {
            let pattern = this.refutable(&of, fixed);
            (pattern, this.block(ty, depth, 1))
        });
        let otherwise = self.block(ty, depth, 1);
        self.under_numbers -= usize::from(!fixed);
        self.locked.truncate(locked);
        Expression::IfLet(pattern, boxed(scrutinee), then, Some(otherwise))
    }

    /// `matches!(n, 1..=3 | 5)`.
    pub fn matches_macro(&mut self) -> Expression {
        self.used(Class::Matches);
        let ty = self.integer_in_scope();
        let value = self.known_integer(ty, 1);
        let pattern = self.scoped(|this| this.refutable(&Type::Integer(ty), true));
        Expression::Matches(boxed(value), pattern, None)
    }

    /// A number from an Option.
    pub fn number_of_option(&mut self, depth: usize) -> Expression {
        self.used(Class::Options);
        let ty = Type::Option(Box::new(Type::Real));
        let option = match self.place(&ty, false) {
            Some(place) if self.random.chance(70) => place,
            _ => {
                let inner = self.number(depth);
                Expression::Optional(Some(boxed(inner)))
            }
        };
        match self.random.below(3) {
            0 => {
                let default = self.number(depth.min(1));
                Expression::UnwrapOr(boxed(option), boxed(default))
            }
            1 => {
                let default = self.number(depth.min(1));
                let closure = self.closure_of(&[Type::Real], &Type::Real, depth.min(1), false);
                Expression::MapOr(boxed(option), boxed(default), Box::new(closure))
            }
            _ => {
                let closure = self.closure_of(&[Type::Real], &Type::Real, depth.min(1), false);
                let mapped = Expression::OptionMap(boxed(option), Box::new(closure));
                let default = self.literal(true);
                Expression::UnwrapOr(boxed(mapped), boxed(default))
            }
        }
    }

    /// `'label: { if c { break 'label x; } y }`.
    pub fn labelled_block(&mut self, ty: &Type, depth: usize) -> Expression {
        self.used(Class::Label);
        self.names += 1;
        let label = format!("block{}", self.names);
        let condition = self.known_truth(2);
        let early = self.expression(ty, depth.min(1));
        let late = self.expression(ty, depth);
        let departure = Expression::Break(Some(label.clone()), Some(boxed(early)));
        let then = Block { statements: vec![Statement::Expression(departure)], tail: None };
        let choice = Expression::If(boxed(condition), then, None);
        Expression::Block(
            Some(label),
            Block { statements: vec![Statement::Expression(choice)], tail: Some(boxed(late)) },
        )
    }

    /// `{ let mut k = 0; loop { k += 1; if k > 3 { break x; } … } }`.
    pub fn loop_with_value(&mut self, depth: usize) -> Expression {
        self.used(Class::BreakValue);
        self.names += 1;
        let counter = format!("k{}", self.names);
        self.scoped(|this| {
            let ty = Integer::I32;
            let start = Statement::Let {
                pattern: Pattern::Name { name: counter.clone(), mutable: true },
                ty: None,
                value: Some(integer(0, ty, true)),
            };
            this.bind(&counter, &Type::Integer(ty), false, true);
            let value = this.number(depth.min(2));
            let departure = Expression::Break(None, Some(boxed(value)));
            let condition = Expression::Comparison(
                Relation::Greater,
                Kind::Integer(ty),
                boxed(name(&counter)),
                boxed(integer(this.random.below(3) as i128, ty, false)),
            );
            let then = Block { statements: vec![Statement::Expression(departure)], tail: None };
            let step = Expression::Compound(
                Operator::Add,
                Kind::Integer(ty),
                boxed(name(&counter)),
                boxed(integer(1, ty, false)),
            );
            let mut body = vec![
                Statement::Expression(step),
                Statement::Expression(Expression::If(boxed(condition), then, None)),
            ];
            if let Some(change) = this.change(1) {
                body.push(change);
            }
            let repeated = Expression::Loop(None, Block { statements: body, tail: None });
            Expression::Block(None, Block { statements: vec![start], tail: Some(boxed(repeated)) })
        })
    }
}
