//! Statements.

use super::*;

impl Generator {
    /// One statement, or the few of a template.
    pub fn statement(&mut self, depth: usize, statements: &mut Vec<Statement>) {
        if self.budget <= 0 {
            return;
        }
        let weights = [
            20,
            self.weight(Class::ArrayMutation, 9),
            10,
            self.weight(Class::If, 8),
            self.weight(Class::KnownIf, 6),
            self.weight(Class::For, 9),
            self.weight(Class::ForArray, 9),
            self.weight(Class::While, 6),
            self.weight(Class::Loop, 5),
            self.weight(Class::Return, 3),
            self.weight(Class::Closure, 6),
            self.weight(Class::ChangingClosure, 8),
            self.weight(Class::LateInitialisation, 4),
            self.weight(Class::IteratorLocal, 9),
            self.weight(Class::LetElse, 8),
            self.weight(Class::CompoundEffects, 7),
            self.weight(Class::NestedArrays, 5),
            self.weight(Class::Departure, if self.loops.is_empty() { 0 } else { 10 }),
        ];
        match self.random.weighted(&weights).unwrap_or(0) {
            0 => self.let_statement(depth, statements),
            1 => self.array_statement(depth, statements),
            2 => statements.extend(self.change(depth)),
            3 => self.if_statement(true, depth, statements),
            4 => self.if_statement(false, depth, statements),
            5 | 6 => self.for_statement(depth, statements),
            7 => self.while_statement(depth, statements),
            8 => self.loop_statement(depth, statements),
            9 => self.return_statement(depth, statements),
            10 => self.closure_statement(depth, statements),
            11 => self.changing_closure(depth, statements),
            12 => self.late_initialisation(depth, statements),
            13 => self.iterator_in_parts(statements),
            14 => self.let_else(depth, statements),
            15 => self.compound_effect(depth, statements),
            16 => self.table(depth, statements),
            _ => self.departure(statements),
        }
    }

    /// A type for a local.
    fn local_type(&mut self) -> (Type, bool) {
        let weights = [
            24,
            self.weight(Class::Integers, 9),
            self.weight(Class::KnownIf, 3),
            8,
            self.weight(Class::TupleFields, 6),
            self.weight(Class::Options, 5),
            if self.program.enumerations.is_empty() { 0 } else { 4 },
            if self.program.single { 0 } else { self.weight(Class::OtherFloat, 4) },
            6,
        ];
        match self.random.weighted(&weights).unwrap_or(0) {
            0 => (Type::Real, false),
            1 => (Type::Integer(*self.random.choice(&Integer::ALL)), true),
            2 => (Type::Bool, true),
            3 => {
                let length = 1 + self.random.below(3);
                (Type::Array(Box::new(Type::Real), length), false)
            }
            4 => {
                self.used(Class::TupleFields);
                let third = match self.random.below(3) {
                    0 => Type::Array(Box::new(Type::Real), 2),
                    1 => Type::Tuple(vec![Type::Real, Type::Real]),
                    _ => Type::Real,
                };
                (Type::Tuple(vec![Type::Real, third]), false)
            }
            5 => (Type::Option(Box::new(Type::Real)), false),
            6 => (Type::Enum(self.random.below(self.program.enumerations.len())), false),
            7 => (Type::Single, false),
            _ => (Type::Integer(Integer::USIZE), true),
        }
    }

    fn let_statement(&mut self, depth: usize, statements: &mut Vec<Statement>) {
        let (ty, fixed) = self.local_type();
        let value = match &ty {
            Type::Bool => self.known_truth(depth.min(2)),
            Type::Array(entry, length) if **entry == Type::Real && self.may(Class::Closure, 20) => {
                let index = Type::Integer(Integer::USIZE);
                let closure = self.closure_of(&[index], entry, 1, false);
                let value = Expression::FromFunction(Box::new(closure), *length);
                let name = self.fresh();
                self.bind(&name, &ty, false, false);
                let pattern = Pattern::Name { name, mutable: false };
                return statements.push(Statement::Let { pattern, ty: Some(ty), value: Some(value) });
            }
            ty => self.expression(ty, depth),
        };
        let value = match value {
            Expression::Real { value, .. } => Expression::Real { value, suffixed: true },
            value => value,
        };
        let mutable = self.random.chance(70);
        let pattern = self.irrefutable(&ty, fixed, mutable);
        let holds_none = matches!(ty, Type::Option(_) | Type::Array(..) | Type::Tuple(_));
        let annotated = holds_none || self.random.chance(35);
        statements.push(Statement::Let { pattern, ty: annotated.then_some(ty), value: Some(value) });
    }

    /// `x += …`, `x = …`, of numbers and known integers.
    pub fn change(&mut self, depth: usize) -> Option<Statement> {
        if self.random.chance(30) {
            let ty = self.integer_in_scope();
            if let Some(target) = self.changeable(&Type::Integer(ty)) {
                let value = self.known_integer(ty, 1);
                let change = if self.random.chance(60) {
                    let operator =
                        *self.random.choice(&[Operator::Add, Operator::Subtract, Operator::Multiply]);
                    let small = integer(1 + self.random.below(2) as i128, ty, false);
                    Expression::Compound(operator, Kind::Integer(ty), boxed(name(&target)), boxed(small))
                } else {
                    Expression::Assign(boxed(name(&target)), boxed(value))
                };
                return Some(Statement::Expression(change));
            }
        }
        let target = self.changeable(&Type::Real)?;
        let value = self.number(depth.min(2));
        let change = match self.random.below(6) {
            0 => Expression::Assign(boxed(name(&target)), boxed(value)),
            1 => {
                let half = Expression::Real { value: 0.5, suffixed: false };
                Expression::Compound(Operator::Multiply, Kind::Real, boxed(name(&target)), boxed(half))
            }
            2 => Expression::Compound(Operator::Subtract, Kind::Real, boxed(name(&target)), boxed(value)),
            _ => Expression::Compound(Operator::Add, Kind::Real, boxed(name(&target)), boxed(value)),
        };
        Some(Statement::Expression(change))
    }

    /// A mutable array, and its entries changed.
    fn array_statement(&mut self, depth: usize, statements: &mut Vec<Statement>) {
        self.used(Class::ArrayMutation);
        let lengths: Vec<usize> = (1..=3)
            .filter(|&length| self.changeable(&Type::Array(Box::new(Type::Real), length)).is_some())
            .collect();
        let Some(&length) = lengths.first() else {
            let length = 2 + self.random.below(2);
            let ty = Type::Array(Box::new(Type::Real), length);
            let value = self.expression(&ty, depth.min(1));
            let name = self.fresh();
            self.bind(&name, &ty, true, false);
            let pattern = Pattern::Name { name, mutable: true };
            return statements.push(Statement::Let { pattern, ty: Some(ty), value: Some(value) });
        };
        let Some(array) = self.changeable(&Type::Array(Box::new(Type::Real), length)) else { return };
        let value = self.number(depth.min(2));
        let index = if self.may(Class::IndexEffects, 50) { self.changing_index(length) } else { None };
        let index = index.unwrap_or_else(|| self.index(length));
        let place = boxed(Expression::Index(boxed(name(&array)), boxed(index)));
        let change = match self.random.below(4) {
            0 => Expression::Assign(place, boxed(value)),
            1 => Expression::Compound(Operator::Subtract, Kind::Real, place, boxed(value)),
            _ => Expression::Compound(Operator::Add, Kind::Real, place, boxed(value)),
        };
        statements.push(Statement::Expression(change));
    }

    /// `let mut t = [[0.0; 2]; 2]; t[1][0] += …;`
    fn table(&mut self, depth: usize, statements: &mut Vec<Statement>) {
        self.used(Class::NestedArrays);
        let ty = Type::Array(Box::new(Type::Array(Box::new(Type::Real), 2)), 2);
        let value = self.expression(&ty, 1);
        let table = self.fresh();
        let pattern = Pattern::Name { name: table.clone(), mutable: true };
        statements.push(Statement::Let { pattern, ty: Some(ty.clone()), value: Some(value) });
        self.bind(&table, &ty, true, false);
        for _ in 0..1 + self.random.below(2) {
            let value = self.number(depth.min(2));
            let (i, j) = (self.index(2), self.index(2));
            let row = Expression::Index(boxed(name(&table)), boxed(i));
            let place = boxed(Expression::Index(boxed(row), boxed(j)));
            let change = Expression::Compound(Operator::Add, Kind::Real, place, boxed(value));
            statements.push(Statement::Expression(change));
        }
    }

    fn body(&mut self, depth: usize, count: usize) -> Block {
        self.scoped(|this| {
            let mut block = Block::default();
            // A body that changes nothing says nothing.
            block.statements.extend(this.change(depth));
            for _ in 0..this.random.below(count + 1) {
                this.statement(depth.saturating_sub(1), &mut block.statements);
            }
            block
        })
    }

    fn if_statement(&mut self, on_numbers: bool, depth: usize, statements: &mut Vec<Statement>) {
        self.used(if on_numbers { Class::If } else { Class::KnownIf });
        let is_known = !on_numbers && self.random.chance(60);
        let condition = match (on_numbers, is_known) {
            (true, _) => self.condition_on_numbers(depth.min(2)),
            (_, true) => self.known_truth(2),
            _ => self.truth(2),
        };
        self.under_numbers += usize::from(!is_known);
        let then = self.body(depth, 1);
        let otherwise = self.random.chance(50).then(|| self.body(depth, 1));
        self.under_numbers -= usize::from(!is_known);
        statements.push(Statement::Expression(Expression::If(boxed(condition), then, otherwise)));
    }

    fn label(&mut self) -> Option<String> {
        self.may(Class::Label, 60).then(|| {
            self.names += 1;
            format!("l{}", self.names)
        })
    }

    fn for_statement(&mut self, depth: usize, statements: &mut Vec<Statement>) {
        let locked = self.locked.len();
        let (chain, item, fixed, below) = self.chain_of_loop();
        let is_range = matches!(chain.source, Source::Range { .. }) && chain.adaptors.is_empty();
        self.used(if is_range { Class::For } else { Class::ForArray });
        let label = self.label();
        let (pattern, body) = self.scoped(|this| {
            let pattern = this.irrefutable(&item, fixed, false);
            if let (Some(below), Some(binding)) = (below, this.scope.last_mut()) {
                binding.below = Some(below);
            }
            this.loops.push(Enclosing { label: label.clone(), counter: None });
            let body = this.body(depth.min(2), 2);
            this.loops.pop();
            (pattern, body)
        });
        self.locked.truncate(locked);
        statements.push(Statement::For { label, pattern, chain, body });
    }

    /// `let mut k = 0; while k < 3 { k += 1; … }`.
    fn while_statement(&mut self, depth: usize, statements: &mut Vec<Statement>) {
        self.used(Class::While);
        let ty = if self.random.chance(60) { Integer::USIZE } else { *self.random.choice(&Integer::ALL) };
        self.names += 1;
        let counter = format!("k{}", self.names);
        let end = 1 + self.random.below(3) as i128;
        statements.push(Statement::Let {
            pattern: Pattern::Name { name: counter.clone(), mutable: true },
            ty: None,
            value: Some(integer(0, ty, true)),
        });
        // Changed by its loop alone.
        self.bind(&counter, &Type::Integer(ty), false, true);
        let kind = Kind::Integer(ty);
        let mut condition = Expression::Comparison(
            Relation::Less,
            kind,
            boxed(name(&counter)),
            boxed(integer(end, ty, false)),
        );
        if self.may(Class::ShortCircuit, 40) {
            self.used(Class::ShortCircuit);
            let effect = self.effect(&Type::Bool, 1);
            condition = Expression::Both(boxed(condition), boxed(effect));
        }
        let label = self.label();
        self.loops.push(Enclosing { label: label.clone(), counter: Some(counter.clone()) });
        let mut body = self.body(depth.min(2), 2);
        self.loops.pop();
        let step =
            Expression::Compound(Operator::Add, kind, boxed(name(&counter)), boxed(integer(1, ty, false)));
        body.statements.insert(0, Statement::Expression(step));
        statements.push(Statement::While { label, condition, body });
    }

    /// `loop { k += 1; if k > 2 { break; } … }`.
    fn loop_statement(&mut self, depth: usize, statements: &mut Vec<Statement>) {
        self.used(Class::Loop);
        let ty = Integer::I32;
        self.names += 1;
        let counter = format!("k{}", self.names);
        statements.push(Statement::Let {
            pattern: Pattern::Name { name: counter.clone(), mutable: true },
            ty: None,
            value: Some(integer(0, ty, true)),
        });
        self.bind(&counter, &Type::Integer(ty), false, true);
        let kind = Kind::Integer(ty);
        let condition = Expression::Comparison(
            Relation::Greater,
            kind,
            boxed(name(&counter)),
            boxed(integer(1 + self.random.below(2) as i128, ty, false)),
        );
        let label = self.label();
        self.loops.push(Enclosing { label: label.clone(), counter: Some(counter.clone()) });
        let mut body = self.body(depth.min(2), 2);
        self.loops.pop();
        let then =
            Block { statements: vec![Statement::Expression(Expression::Break(None, None))], tail: None };
        let step =
            Expression::Compound(Operator::Add, kind, boxed(name(&counter)), boxed(integer(1, ty, false)));
        body.statements.insert(0, Statement::Expression(Expression::If(boxed(condition), then, None)));
        body.statements.insert(0, Statement::Expression(step));
        statements.push(Statement::Expression(Expression::Loop(label, body)));
    }

    /// `if i == 2 { continue; }`, to a loop around it.
    fn departure(&mut self, statements: &mut Vec<Statement>) {
        self.used(Class::Departure);
        let inner = self.loops.len() - 1;
        let target =
            if self.drawn.contains(&Class::Label) { self.random.below(self.loops.len()) } else { inner };
        let label = self.loops[target].label.clone();
        let label = if target == inner && self.random.chance(50) { None } else { label };
        if target != inner && label.is_none() {
            return;
        }
        if label.is_some() {
            self.used(Class::Label);
        }
        let condition = if self.random.chance(96) { self.known_truth(2) } else { self.truth(1) };
        let departure =
            if self.random.chance(50) { Expression::Break(label, None) } else { Expression::Continue(label) };
        let then = Block { statements: vec![Statement::Expression(departure)], tail: None };
        statements.push(Statement::Expression(Expression::If(boxed(condition), then, None)));
    }

    fn return_statement(&mut self, depth: usize, statements: &mut Vec<Statement>) {
        // A closure has another result.
        if self.own > 0 {
            return;
        }
        self.used(Class::Return);
        let condition =
            if self.random.chance(50) { self.condition_on_numbers(1) } else { self.known_truth(2) };
        let result = self.result.clone();
        let value = self.expression(&result, depth.min(2));
        let departure = Statement::Expression(Expression::Return(boxed(value)));
        let then = Block { statements: vec![departure], tail: None };
        statements.push(Statement::Expression(Expression::If(boxed(condition), then, None)));
    }

    /// A closure in a local.
    fn closure_statement(&mut self, depth: usize, statements: &mut Vec<Statement>) {
        let parameters: Vec<Type> = (0..1 + self.random.below(2))
            .map(|_| if self.random.chance(80) { Type::Real } else { Type::Array(Box::new(Type::Real), 2) })
            .collect();
        let moves = self.random.chance(20);
        // What it sees must not change while it lives, unless it has its own copy.
        let only_immutable = std::mem::replace(&mut self.only_immutable, !moves);
        let mut closure = self.closure_of(&parameters, &Type::Real, depth.min(2), true);
        self.only_immutable = only_immutable;
        closure.moves = moves;
        let closure_name = self.fresh();
        self.scope.push(Binding {
            name: closure_name.clone(),
            ty: Type::UNIT,
            mutable: false,
            fixed: false,
            below: None,
            what: What::Closure { parameters, result: Type::Real },
        });
        statements.push(Statement::LetClosure { name: closure_name, mutable: false, closure });
    }

    /// A closure that changes what it captured, called two or three times.
    fn changing_closure(&mut self, depth: usize, statements: &mut Vec<Statement>) {
        let Some(target) = self.changeable(&Type::Real) else { return };
        self.used(Class::ChangingClosure);
        let argument = self.fresh();
        let only_immutable = std::mem::replace(&mut self.only_immutable, true);
        let body = self.scoped(|this| {
            this.bind(&argument, &Type::Real, false, false);
            let by = this.number(depth.min(1));
            let change = Expression::Compound(Operator::Add, Kind::Real, boxed(name(&target)), boxed(by));
            let value = if this.random.chance(50) { name(&target) } else { this.number(1) };
            Block { statements: vec![Statement::Expression(change)], tail: Some(boxed(value)) }
        });
        self.only_immutable = only_immutable;
        self.names += 1;
        let closure_name = format!("add{}", self.names);
        let pattern = Pattern::Name { name: argument, mutable: false };
        let closure = Closure {
            parameters: vec![(pattern, Some(Type::Real))],
            body: Expression::Block(None, body),
            moves: self.random.chance(25),
        };
        let moves = closure.moves;
        statements.push(Statement::LetClosure { name: closure_name.clone(), mutable: true, closure });
        // What it holds cannot be used while it lives.
        if !moves {
            self.hidden.push(target);
        }
        for _ in 0..2 {
            let argument = self.number(1);
            let call = Expression::Apply(closure_name.clone(), vec![argument]);
            self.names += 1;
            let result = format!("r{}", self.names);
            let pattern = Pattern::Name { name: result.clone(), mutable: false };
            statements.push(Statement::Let { pattern, ty: None, value: Some(call) });
            self.bind(&result, &Type::Real, false, false);
        }
        if !moves {
            self.hidden.pop();
        }
    }

    /// `let x; if c { x = a; } else { x = b; }`.
    fn late_initialisation(&mut self, depth: usize, statements: &mut Vec<Statement>) {
        self.used(Class::LateInitialisation);
        self.names += 1;
        let late = format!("late{}", self.names);
        let pattern = Pattern::Name { name: late.clone(), mutable: false };
        statements.push(Statement::Let { pattern, ty: Some(Type::Real), value: None });
        let assign = |value| Statement::Expression(Expression::Assign(boxed(name(&late)), boxed(value)));
        let value = self.number(depth.min(2));
        if self.random.chance(50) {
            statements.push(assign(value));
        } else {
            let other = self.number(depth.min(1));
            let condition = self.truth(1);
            let block = |statement| Block { statements: vec![statement], tail: None };
            let (then, otherwise) = (block(assign(value)), block(assign(other)));
            statements.push(Statement::Expression(Expression::If(boxed(condition), then, Some(otherwise))));
        }
        self.bind(&late, &Type::Real, false, false);
    }

    fn let_else(&mut self, depth: usize, statements: &mut Vec<Statement>) {
        if self.own > 0 {
            return;
        }
        self.used(Class::LetElse);
        let option = Type::Option(Box::new(Type::Real));
        let (value, ty, fixed) = if self.drawn.contains(&Class::Options) && self.random.chance(60) {
            match self.place(&option, false) {
                Some(place) => (place, option, false),
                None => (Expression::Optional(Some(boxed(self.number(1)))), option, false),
            }
        } else {
            let ty = self.integer_in_scope();
            (self.known_integer(ty, 1), Type::Integer(ty), true)
        };
        let result = self.result.clone();
        let early = self.expression(&result, depth.min(1));
        let departure = Statement::Expression(Expression::Return(boxed(early)));
        let otherwise = Block { statements: vec![departure], tail: None };
        let pattern = self.refutable(&ty, fixed);
        statements.push(Statement::LetElse { pattern, value, otherwise });
    }

    /// `x += { y += 1.0; y }`, `a[i] *= { i += 1; 2.0 }`.
    fn compound_effect(&mut self, depth: usize, statements: &mut Vec<Statement>) {
        let Some(target) = self.changeable(&Type::Real) else {
            return self.let_statement(depth, statements);
        };
        self.used(Class::CompoundEffects);
        let value = self.effect(&Type::Real, depth.min(1));
        let operator = *self.random.choice(&[Operator::Add, Operator::Subtract]);
        let array = self.changeable(&Type::Array(Box::new(Type::Real), 2));
        let place = match array {
            Some(array) if self.random.chance(60) => {
                let index = self.changing_index(2).unwrap_or_else(|| self.index(2));
                Expression::Index(boxed(name(&array)), boxed(index))
            }
            _ => name(&target),
        };
        let change = Expression::Compound(operator, Kind::Real, boxed(place), boxed(value));
        statements.push(Statement::Expression(change));
    }
}
