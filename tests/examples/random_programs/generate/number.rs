//! Real numbers: literals, places, arithmetic, elementary functions inside their domains, and all that ends
//! in a number.

use super::*;

/// Functions that any number may be given to.
const EVERYWHERE: [&str; 9] = ["sin", "cos", "atan", "tanh", "asinh", "abs", "signum", "to_radians", "cbrt"];

impl Generator {
    pub fn literal(&mut self, suffixed: bool) -> Expression {
        const VALUES: [f64; 12] = [0.5, 1.25, 2.0, 0.3, 1.5, 0.1, 3.0, 0.75, 1.0, 0.0, 1e-3, 12.5];
        Expression::Real { value: *self.random.choice(&VALUES), suffixed }
    }

    fn leaf(&mut self) -> Expression {
        if self.random.chance(15) {
            return self.literal(true);
        }
        match self.place(&Type::Real, false) {
            Some(place) => place,
            None => self.literal(true),
        }
    }

    /// Two operands; a literal beside something else may go without its suffix.
    fn operands(&mut self, depth: usize) -> (Expression, Expression) {
        let (mut a, mut b) = (self.number(depth), self.number(depth));
        let is_literal = |x: &Expression| matches!(x, Expression::Real { .. });
        let may_be_bare = is_literal(&a) != is_literal(&b);
        for operand in [&mut a, &mut b] {
            if let Expression::Real { suffixed, .. } = operand
                && may_be_bare
            {
                *suffixed = self.random.chance(20);
            }
        }
        (a, b)
    }

    fn arithmetic(&mut self, operator: Operator, a: Expression, b: Expression) -> Expression {
        Expression::Arithmetic(operator, Kind::Real, boxed(a), boxed(b))
    }

    /// 1.5 + x².
    fn positive(&mut self, depth: usize) -> Expression {
        let x = self.number(depth);
        let square = Expression::Power(boxed(x), boxed(integer(2, Integer::I32, false)));
        let offset = Expression::Real { value: 1.5, suffixed: false };
        self.arithmetic(Operator::Add, offset, square)
    }

    /// A number between −size and size.
    fn bounded(&mut self, size: f64, depth: usize) -> Expression {
        let x = self.number(depth);
        let name = if self.random.chance(50) { "sin" } else { "cos" };
        let wave = Expression::Function { name, arguments: vec![x], as_path: self.random.chance(20) };
        self.arithmetic(Operator::Multiply, Expression::Real { value: size, suffixed: false }, wave)
    }

    fn named_function(&mut self, name: &'static str, arguments: Vec<Expression>) -> Expression {
        self.used(Class::Functions);
        Expression::Function { name, arguments, as_path: self.random.chance(10) }
    }

    fn elementary(&mut self, depth: usize) -> Expression {
        match self.random.below(9) {
            0 => {
                let name = *self.random.choice(&["recip", "sqrt", "ln", "log2", "log10", "acosh", "cbrt"]);
                let x = self.positive(depth);
                self.named_function(name, vec![x])
            }
            1 => {
                let name = *self.random.choice(&["asin", "acos", "atanh", "ln_1p", "tan"]);
                let x = self.bounded(0.6, depth);
                self.named_function(name, vec![x])
            }
            2 => {
                let name = *self.random.choice(&["exp", "exp2", "exp_m1", "sinh", "cosh"]);
                let x = self.bounded(1.5, depth);
                self.named_function(name, vec![x])
            }
            3 => {
                let name = *self.random.choice(&["min", "max", "copysign"]);
                let (x, y) = (self.number(depth), self.number(depth));
                self.named_function(name, vec![x, y])
            }
            4 => {
                let (name, x, y) = match self.random.below(4) {
                    0 => ("atan2", self.number(depth), self.positive(depth)),
                    1 => ("hypot", self.number(depth), self.positive(depth)),
                    2 => ("powf", self.positive(depth), self.bounded(1.5, depth)),
                    _ => ("log", self.positive(depth), {
                        let x = self.positive(depth);
                        self.arithmetic(Operator::Add, x, Expression::Real { value: 1.0, suffixed: false })
                    }),
                };
                self.named_function(name, vec![x, y])
            }
            5 => {
                let [x, a, b] = [0; 3].map(|_| self.number(depth));
                self.named_function("mul_add", vec![x, a, b])
            }
            6 => {
                let x = self.number(depth);
                let low =
                    Expression::Negated(Kind::Real, boxed(Expression::Real { value: 0.75, suffixed: true }));
                self.named_function("clamp", vec![x, low, Expression::Real { value: 0.875, suffixed: true }])
            }
            _ => {
                let name = *self.random.choice(&EVERYWHERE);
                let x = self.number(depth);
                self.named_function(name, vec![x])
            }
        }
    }

    /// `x.powi(n)`, with an exponent that is known.
    fn power(&mut self, depth: usize) -> Expression {
        let x = self.number(depth);
        if self.random.chance(25) {
            let x = self.bounded(0.9, 0);
            let n = self.known_integer(Integer::I32, 1);
            // Kept small.
            let n = Expression::Arithmetic(
                Operator::Remainder,
                Kind::Integer(Integer::I32),
                boxed(n),
                boxed(integer(4, Integer::I32, false)),
            );
            let shifted = self.arithmetic(Operator::Add, x, Expression::Real { value: 1.5, suffixed: false });
            return Expression::Power(boxed(shifted), boxed(n));
        }
        let n = *self.random.choice(&[2, 3, 1, 0, 2, 3]);
        Expression::Power(boxed(x), boxed(integer(n, Integer::I32, false)))
    }

    pub fn number(&mut self, depth: usize) -> Expression {
        self.budget -= 1;
        if depth == 0 || self.budget <= 0 {
            return self.leaf();
        }
        let below = depth - 1;
        let closures = self.closures(&Type::Real);
        let helpers = self.callable(&Type::Real);
        let deep = usize::from(depth > 1);
        let weights = [
            14,
            30,
            self.weight(Class::Functions, 12),
            self.weight(Class::Functions, 5),
            self.weight(Class::Integers, 7),
            self.weight(Class::If, 7) * deep,
            self.weight(Class::KnownIf, 5) * deep,
            self.weight(Class::BlockExpressions, 5) * deep,
            if helpers.is_empty() { 0 } else { 12 },
            if closures.is_empty() { 0 } else { 20 },
            self.weight(Class::Chains, 9) * deep,
            self.weight(Class::Match, 6) * deep,
            self.weight(Class::SideEffects, 6) * deep,
            self.weight(Class::IndexEffects, 6) * deep,
            self.weight(Class::Options, 6) * deep,
            self.weight(Class::OtherFloat, 6),
            self.weight(Class::BoolCasts, 4),
            self.weight(Class::Label, 3) * deep,
            self.weight(Class::MatchField, 8) * deep,
            self.weight(Class::IfLet, 6) * deep,
            self.weight(Class::BreakValue, 5) * deep,
        ];
        match self.random.weighted(&weights).unwrap_or(0) {
            0 => self.leaf(),
            1 => {
                let (a, b) = self.operands(below);
                match self.random.below(8) {
                    0..=2 => self.arithmetic(Operator::Add, a, b),
                    3..=4 => self.arithmetic(Operator::Subtract, a, b),
                    5 => {
                        let a = match a {
                            Expression::Real { value, .. } => Expression::Real { value, suffixed: true },
                            a => a,
                        };
                        Expression::Negated(Kind::Real, boxed(a))
                    }
                    6 => {
                        let b = self.positive(below);
                        self.arithmetic(Operator::Divide, a, b)
                    }
                    _ => {
                        // One factor bounded, lest sizes run away.
                        let b = if self.random.chance(50) { self.bounded(1.0, 0) } else { self.leaf() };
                        self.arithmetic(Operator::Multiply, a, b)
                    }
                }
            }
            2 => self.elementary(below),
            3 => self.power(below),
            4 => self.number_of_integer(below),
            5 => self.if_on_numbers(&Type::Real, below),
            6 => self.if_expression(&Type::Real, below),
            7 => self.block_expression(&Type::Real, depth),
            8 => {
                let helper = *self.random.choice(&helpers);
                self.call(helper, below)
            }
            9 => {
                let (closure, parameters) = self.random.choice(&closures).clone();
                self.used(Class::Closure);
                let arguments = parameters.iter().map(|ty| self.expression(ty, below)).collect();
                Expression::Apply(closure, arguments)
            }
            10 => self.number_of_chain(below),
            11 => self.match_expression(&Type::Real, below),
            12 => self.effect(&Type::Real, below),
            13 => self.indexed_with_effect().unwrap_or_else(|| self.leaf()),
            14 => self.number_of_option(below),
            15 => self.other_float(),
            16 => {
                self.used(Class::BoolCasts);
                let truth = self.known_truth(1);
                let ty = Integer::I32;
                let count = Expression::Cast { value: boxed(truth), from: Kind::Bool, to: Kind::Integer(ty) };
                Expression::Cast { value: boxed(count), from: Kind::Integer(ty), to: Kind::Real }
            }
            17 => self.labelled_block(&Type::Real, below),
            18 => self.match_field(&Type::Real, below),
            19 => self.if_let(&Type::Real, below),
            _ => self.loop_with_value(below),
        }
    }

    /// A number of the other precision, cast.
    fn other_float(&mut self) -> Expression {
        if self.program.single {
            return self.leaf();
        }
        self.used(Class::OtherFloat);
        let value = self.single();
        Expression::Cast { value: boxed(value), from: Kind::Single, to: Kind::Real }
    }

    pub fn single(&mut self) -> Expression {
        const VALUES: [f32; 6] = [1.1, 0.3, 0.1, 2.5, 0.7, 1e-3];
        if self.random.chance(40)
            && let Some(place) = self.place(&Type::Single, false)
        {
            return place;
        }
        let a = Expression::Single(*self.random.choice(&VALUES));
        if self.random.chance(40) {
            let b = Expression::Single(*self.random.choice(&VALUES));
            let operator = *self.random.choice(&[Operator::Add, Operator::Multiply, Operator::Divide]);
            return Expression::Arithmetic(operator, Kind::Single, boxed(a), boxed(b));
        }
        a
    }

    /// An integer as a number.
    fn number_of_integer(&mut self, depth: usize) -> Expression {
        self.used(Class::Integers);
        let ty = *self.random.choice(&Integer::ALL);
        if self.random.chance(30)
            && let Some(place) = self.place(&Type::Integer(ty), false)
        {
            return Expression::Cast { value: boxed(place), from: Kind::Integer(ty), to: Kind::Real };
        }
        if self.random.chance(15) {
            let ty = Integer { bits: 8, signed: self.random.chance(50), size: false };
            let value = self.known_integer(ty, depth.min(2));
            return Expression::Converted { value: boxed(value), from: Kind::Integer(ty) };
        }
        let value = self.known_integer(ty, depth.min(3));
        if ty.bits > 16 && self.random.chance(60) {
            // A remainder shows every digit, at a size near 1.
            let rest = Expression::Arithmetic(
                Operator::Remainder,
                Kind::Integer(ty),
                boxed(value),
                boxed(integer(1009, ty, false)),
            );
            let number = Expression::Cast { value: boxed(rest), from: Kind::Integer(ty), to: Kind::Real };
            return self.arithmetic(
                Operator::Divide,
                number,
                Expression::Real { value: 512.0, suffixed: false },
            );
        }
        let number = Expression::Cast { value: boxed(value), from: Kind::Integer(ty), to: Kind::Real };
        if ty.bits > 16 {
            let size = Expression::Function { name: "abs", arguments: vec![number], as_path: false };
            return Expression::Function { name: "ln_1p", arguments: vec![size], as_path: false };
        }
        self.arithmetic(Operator::Divide, number, Expression::Real { value: 64.0, suffixed: false })
    }

    /// Closures in locals with this result.
    pub fn closures(&self, ty: &Type) -> Vec<(String, Vec<Type>)> {
        let visible = self.visible().into_iter();
        visible
            .filter_map(|binding| match binding.what {
                What::Closure { parameters, result } if result == *ty => Some((binding.name, parameters)),
                _ => None,
            })
            .collect()
    }

    /// Helpers with this result that can be called here.
    pub fn callable(&self, ty: &Type) -> Vec<usize> {
        let all = 0..self.recursive.unwrap_or(self.program.helpers.len());
        let inside = self.recursive.map(|helper| self.program.helpers[helper].with_self).unwrap_or(true);
        all.filter(|&helper| {
            let helper = &self.program.helpers[helper];
            helper.result == *ty && (inside || !helper.with_self)
        })
        .collect()
    }

    pub fn call(&mut self, helper: usize, depth: usize) -> Expression {
        self.used(Class::Helpers);
        let parameters = self.program.helpers[helper].parameters.clone();
        let locked = self.locked.len();
        let arguments = parameters
            .iter()
            .map(|(name, _, ty)| match ty {
                // The depth of a recursion.
                Type::Integer(ty) if name == "depth" => integer(1 + self.random.below(3) as i128, *ty, false),
                ty => self.expression(ty, depth.min(2)),
            })
            .collect();
        self.locked.truncate(locked);
        Expression::Call { helper, arguments }
    }
}
