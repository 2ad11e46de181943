//! The functions of a program: helpers, L, R, f.

use super::*;

impl Generator {
    pub fn functions(&mut self) {
        if self.drawn.contains(&Class::Recursion) {
            self.recursion();
        }
        if self.drawn.contains(&Class::Helpers) {
            for _ in 0..1 + self.random.below(2) {
                self.helper();
            }
        }
        self.recursive = None;
        let n = self.program.n;
        let array = Type::Array(Box::new(Type::Real), n);
        let both = [("q", array.clone()), ("v", array.clone())];
        self.budget = 90;
        let given = self.with_time(0, &both);
        self.program.lagrangian = self.function(&given, &Type::Real, 6);
        if self.random.chance(35) {
            let of_both = self.random.chance(50);
            self.budget = 35;
            let given = self.with_time(1, &both[usize::from(!of_both)..]);
            let body = self.function(&given, &Type::Real, 3);
            self.program.rayleigh = Some((of_both, body));
        }
        let is_driven = self.drawn.contains(&Class::Input);
        if self.random.chance(25) || is_driven {
            self.budget = 35;
            let mut given = both.to_vec();
            if is_driven {
                self.used(Class::Input);
                self.program.inputs = 1 + self.random.below(2);
                given.push(("u", Type::Array(Box::new(Type::Real), self.program.inputs)));
            }
            let given = self.with_time(2, &given);
            self.program.force = Some(self.function(&given, &array, 2));
        }
        if self.drawn.contains(&Class::Cfg) {
            self.configure_out();
        }
    }

    /// The parameters of L, R or f, with the time for some.
    fn with_time<'n>(&mut self, part: usize, parameters: &[(&'n str, Type)]) -> Vec<(&'n str, Type)> {
        let mut parameters = parameters.to_vec();
        if self.may(Class::Time, 60) {
            self.used(Class::Time);
            self.program.timed[part] = true;
            parameters.push(("t", Type::Real));
        }
        parameters
    }

    fn function(&mut self, parameters: &[(&str, Type)], result: &Type, statements: usize) -> Block {
        self.scope.clear();
        self.hidden.clear();
        self.locked.clear();
        self.loops.clear();
        self.own = 0;
        self.result = result.clone();
        for (name, ty) in parameters {
            self.bind(name, ty, false, true);
        }
        let mut block = Block::default();
        // Something that side effects can change.
        if self.drawn.contains(&Class::SideEffects) || self.drawn.contains(&Class::IndexEffects) {
            for (ty, value) in [
                (Type::Real, Expression::Real { value: 0.25, suffixed: true }),
                (Type::Integer(Integer::USIZE), integer(0, Integer::USIZE, true)),
            ] {
                let name = self.fresh();
                self.bind(&name, &ty, true, true);
                let pattern = Pattern::Name { name, mutable: true };
                block.statements.push(Statement::Let { pattern, ty: None, value: Some(value) });
            }
        }
        for _ in 0..1 + self.random.below(statements + 1) {
            self.statement(3, &mut block.statements);
        }
        block.tail = Some(boxed(self.last(result)));
        block
    }

    /// The value of a body: of all numbers that it ended with, so that no statement is for nothing.
    fn last(&mut self, result: &Type) -> Expression {
        self.budget = self.budget.max(15);
        let value = self.expression(result, 3);
        if *result != Type::Real {
            return value;
        }
        let locals: Vec<Expression> =
            self.places(&Type::Real, false).into_iter().filter(|place| root_of(place).is_some()).collect();
        let kept = locals.into_iter().take(8);
        kept.fold(value, |total, place| {
            Expression::Arithmetic(Operator::Add, Kind::Real, boxed(total), boxed(place))
        })
    }

    fn helper(&mut self) {
        let index = self.program.helpers.len();
        let with_self = self.random.chance(50);
        let array = Type::Array(Box::new(Type::Real), self.program.n);
        let mut parameters = Vec::new();
        for _ in 0..1 + self.random.below(3) {
            let ty = match self.random.below(7) {
                0 => array.clone(),
                1 => Type::Reference(Box::new(array.clone())),
                2 if self.drawn.contains(&Class::TupleFields) => Type::Tuple(vec![Type::Real, Type::Real]),
                _ => Type::Real,
            };
            self.names += 1;
            let mutable = ty.is_scalar() && self.random.chance(20);
            parameters.push((format!("p{}", self.names), mutable, ty));
        }
        let result = match self.random.below(8) {
            0 => Type::Tuple(vec![Type::Real, Type::Real]),
            1 => array,
            _ => Type::Real,
        };
        let name = format!("helper{index}");
        let helper = Helper {
            name,
            with_self,
            parameters: parameters.clone(),
            result: result.clone(),
            body: Block::default(),
        };
        self.program.helpers.push(helper);
        self.recursive = Some(index);
        self.budget = 25;
        let body = self.function_of(&parameters, &result);
        self.program.helpers[index].body = body;
        self.recursive = None;
    }

    fn function_of(&mut self, parameters: &[(String, bool, Type)], result: &Type) -> Block {
        let named: Vec<(&str, Type)> =
            parameters.iter().map(|(name, _, ty)| (name.as_str(), ty.clone())).collect();
        // Parameters that are `mut` can be changed; the others of `function` cannot.
        self.function(&named, result, 2)
    }

    /// `fn power(x: f64, depth: u32) -> f64 { if depth == 0 { … } else { … Self::power(…, depth - 1) } }`.
    fn recursion(&mut self) {
        self.used(Class::Recursion);
        let index = self.program.helpers.len();
        let ty = if self.random.chance(50) { Integer::U32 } else { *self.random.choice(&Integer::ALL) };
        let parameters =
            vec![("x".to_owned(), false, Type::Real), ("depth".to_owned(), false, Type::Integer(ty))];
        self.program.helpers.push(Helper {
            name: "descend".to_owned(),
            with_self: false,
            parameters,
            result: Type::Real,
            body: Block::default(),
        });
        self.recursive = Some(index);
        self.scope.clear();
        self.bind("x", &Type::Real, false, false);
        self.budget = 12;
        let (end, inner, outer) = (self.number(2), self.number(1), self.number(1));
        self.recursive = None;
        let kind = Kind::Integer(ty);
        let less = Expression::Arithmetic(
            Operator::Subtract,
            kind,
            boxed(name("depth")),
            boxed(integer(1, ty, false)),
        );
        let bounded = Expression::Function { name: "sin", arguments: vec![inner], as_path: false };
        let call = Expression::Call { helper: index, arguments: vec![bounded, less] };
        let again = Expression::Arithmetic(Operator::Add, Kind::Real, boxed(outer), boxed(call));
        let condition =
            Expression::Comparison(Relation::Equal, kind, boxed(name("depth")), boxed(integer(0, ty, false)));
        let choice =
            Expression::If(boxed(condition), super::integer::tail(end), Some(super::integer::tail(again)));
        self.program.helpers[index].body = Block { statements: Vec::new(), tail: Some(boxed(choice)) };
    }

    /// A statement that is configured out, so that the macro must refuse the program.
    fn configure_out(&mut self) {
        self.used(Class::Cfg);
        self.program.has_cfg = true;
        let early = Expression::Return(boxed(Expression::Real { value: 12.5, suffixed: true }));
        let statements = &mut self.program.lagrangian.statements;
        let position = self.random.below(statements.len() + 1);
        statements.insert(position, Statement::ConfiguredOut(Box::new(Statement::Expression(early))));
    }
}
