//! Integers and bools that are known when the macro runs, and conditions on numbers and fields.

use super::*;

const METHODS: [&str; 9] =
    ["pow", "min", "max", "abs_diff", "rem_euclid", "abs", "signum", "div_euclid", "count_ones"];
const WRAPPING: [&str; 6] =
    ["wrapping_add", "wrapping_sub", "wrapping_mul", "saturating_add", "saturating_sub", "saturating_mul"];

impl Generator {
    fn integer_literal(&mut self, ty: Integer, suffixed: bool) -> Expression {
        let value = if self.may(Class::IntegerBounds, 30) {
            self.used(Class::IntegerBounds);
            let small = self.random.below(4) as i128;
            if self.random.chance(50) { ty.greatest() - small } else { ty.least() + small }
        } else if ty.signed && self.random.chance(30) {
            -(self.random.below(12) as i128)
        } else {
            self.random.below(12) as i128
        };
        integer(value, ty, suffixed)
    }

    fn integer_leaf(&mut self, ty: Integer) -> Expression {
        if self.random.chance(55)
            && let Some(place) = self.place(&Type::Integer(ty), true)
        {
            return place;
        }
        self.integer_literal(ty, true)
    }

    /// An integer that no field and no comparison of numbers decides.
    pub fn known_integer(&mut self, ty: Integer, depth: usize) -> Expression {
        self.budget -= 1;
        if depth == 0 || self.budget <= 0 {
            return self.integer_leaf(ty);
        }
        let below = depth - 1;
        let kind = Kind::Integer(ty);
        let weights = [
            10,
            14,
            self.weight(Class::IntegerMethods, 8),
            self.weight(Class::WrappingMethods, 10),
            self.weight(Class::IntegerCasts, 12),
            self.weight(Class::Shift, 8),
            self.weight(Class::BoolCasts, 4),
            self.weight(Class::KnownIf, 4),
            self.weight(Class::SideEffects, 4),
            self.weight(Class::Match, 4),
            self.weight(Class::FloatCasts, 5),
            if ty == Integer::USIZE { self.weight(Class::Chains, 4) } else { 0 },
        ];
        match self.random.weighted(&weights).unwrap_or(0) {
            0 => self.integer_leaf(ty),
            1 => {
                let a = self.known_integer(ty, below);
                let operator = *self.random.choice(&[
                    Operator::Add,
                    Operator::Subtract,
                    Operator::Multiply,
                    Operator::Divide,
                    Operator::Remainder,
                ]);
                let b = match operator {
                    Operator::Divide | Operator::Remainder => {
                        let size = 1 + self.random.below(6) as i128;
                        let value = if ty.signed && self.random.chance(25) { -size } else { size };
                        integer(value, ty, self.random.chance(50))
                    }
                    Operator::Multiply => integer(self.random.below(5) as i128, ty, self.random.chance(50)),
                    _ => self.known_integer(ty, below),
                };
                if ty.signed && self.random.chance(8) {
                    return Expression::Negated(kind, boxed(a));
                }
                Expression::Arithmetic(operator, kind, boxed(a), boxed(b))
            }
            2 => {
                self.used(Class::IntegerMethods);
                let name = *self.random.choice(&METHODS);
                self.integer_method(name, ty, below)
            }
            3 => {
                self.used(Class::WrappingMethods);
                let name = *self.random.choice(&WRAPPING);
                self.integer_method(name, ty, below)
            }
            4 => {
                self.used(Class::IntegerCasts);
                let from = *self.random.choice(&Integer::ALL);
                let value = self.known_integer(from, below);
                Expression::Cast { value: boxed(value), from: Kind::Integer(from), to: kind }
            }
            5 => {
                self.used(Class::Shift);
                let a = self.known_integer(ty, below);
                match self.random.below(6) {
                    0 => Expression::Not(kind, boxed(a)),
                    1 | 2 => {
                        let operator =
                            if self.random.chance(50) { Operator::ShiftLeft } else { Operator::ShiftRight };
                        let by =
                            integer(self.random.below(ty.bits.min(32) as usize) as i128, Integer::U32, true);
                        Expression::Arithmetic(operator, kind, boxed(a), boxed(by))
                    }
                    _ => {
                        let b = self.known_integer(ty, below);
                        let operator = *self.random.choice(&[Operator::And, Operator::Or, Operator::Xor]);
                        Expression::Arithmetic(operator, kind, boxed(a), boxed(b))
                    }
                }
            }
            6 => {
                self.used(Class::BoolCasts);
                let truth = self.known_truth(below);
                Expression::Cast { value: boxed(truth), from: Kind::Bool, to: kind }
            }
            7 => {
                self.used(Class::KnownIf);
                let condition = self.known_truth(1);
                let (a, b) = (self.known_integer(ty, below), self.known_integer(ty, below));
                Expression::If(boxed(condition), tail(a), Some(tail(b)))
            }
            8 => self.effect(&Type::Integer(ty), below),
            9 => self.match_expression(&Type::Integer(ty), below),
            10 => {
                self.used(Class::FloatCasts);
                let value = *self.random.choice(&[2.7, 300.5, 0.5, 1e10, 255.9]);
                let value = Expression::Real { value, suffixed: true };
                let value = if self.random.chance(40) {
                    Expression::Negated(Kind::Real, boxed(value))
                } else {
                    value
                };
                Expression::Cast { value: boxed(value), from: Kind::Real, to: kind }
            }
            _ => self.count_of_chain(),
        }
    }

    fn integer_method(&mut self, name: &'static str, ty: Integer, depth: usize) -> Expression {
        let name = if !ty.signed && ["abs", "signum"].contains(&name) { "min" } else { name };
        let receiver = match (name, self.known_integer(ty, depth)) {
            // A bare literal has no methods.
            (_, Expression::Integer { value, .. }) => integer(value, ty, true),
            (_, receiver) => receiver,
        };
        let mut arguments = vec![receiver];
        let mut result = ty;
        match name {
            "abs" | "signum" => {}
            "count_ones" => result = Integer::U32,
            "pow" => arguments.push(integer(self.random.below(4) as i128, Integer::U32, false)),
            "rem_euclid" | "div_euclid" => {
                let size = 1 + self.random.below(6) as i128;
                arguments.push(integer(
                    if ty.signed && self.random.chance(25) { -size } else { size },
                    ty,
                    false,
                ));
            }
            _ => arguments.push(self.known_integer(ty, depth)),
        }
        if name == "abs_diff" {
            result = Integer { signed: false, ..ty };
        }
        let as_path = self.random.chance(3);
        let call = Expression::IntegerMethod { name, ty, arguments, as_path };
        if result == ty {
            call
        } else {
            Expression::Cast { value: boxed(call), from: Kind::Integer(result), to: Kind::Integer(ty) }
        }
    }

    /// A condition that is known when the macro runs.
    pub fn known_truth(&mut self, depth: usize) -> Expression {
        self.budget -= 1;
        if depth == 0 || self.budget <= 0 {
            if self.random.chance(50)
                && let Some(place) = self.place(&Type::Bool, true)
            {
                return place;
            }
            return Expression::Bool(self.random.chance(50));
        }
        let below = depth - 1;
        match self.random.below(10) {
            0 => {
                let a = self.known_truth(below);
                Expression::Not(Kind::Bool, boxed(a))
            }
            1 => {
                let a = self.known_truth(below);
                let b = if self.may(Class::ShortCircuit, 70) {
                    self.used(Class::ShortCircuit);
                    self.effect(&Type::Bool, below)
                } else {
                    self.known_truth(below)
                };
                let (a, b) = (boxed(a), boxed(b));
                if self.random.chance(50) { Expression::Both(a, b) } else { Expression::Either(a, b) }
            }
            2 if self.drawn.contains(&Class::Shift) => {
                let (a, b) = (self.known_truth(below), self.known_truth(below));
                let operator = *self.random.choice(&[Operator::And, Operator::Or, Operator::Xor]);
                Expression::Arithmetic(operator, Kind::Bool, boxed(a), boxed(b))
            }
            3 if self.drawn.contains(&Class::Matches) => self.matches_macro(),
            _ => {
                let ty = self.integer_in_scope();
                let a = self.known_integer(ty, below);
                // One side tells the type of the other.
                let b = match self.known_integer(ty, 0) {
                    Expression::Integer { value, ty, .. } if !matches!(a, Expression::Integer { .. }) => {
                        integer(value, ty, self.random.chance(30))
                    }
                    b => b,
                };
                Expression::Comparison(self.relation(), Kind::Integer(ty), boxed(a), boxed(b))
            }
        }
    }

    /// The type of an integer that is known here, or any.
    pub fn integer_in_scope(&mut self) -> Integer {
        let known: Vec<Integer> = self
            .visible()
            .iter()
            .filter_map(|binding| match binding.ty {
                Type::Integer(ty) if binding.fixed && matches!(binding.what, What::Value) => Some(ty),
                _ => None,
            })
            .collect();
        if !known.is_empty() && self.random.chance(75) {
            *self.random.choice(&known)
        } else if self.random.chance(60) {
            Integer::USIZE
        } else {
            *self.random.choice(&Integer::ALL)
        }
    }

    fn relation(&mut self) -> Relation {
        *self.random.choice(&[
            Relation::Less,
            Relation::LessOrEqual,
            Relation::Greater,
            Relation::GreaterOrEqual,
            Relation::Equal,
            Relation::NotEqual,
        ])
    }

    /// A comparison of numbers, of fields, or something known.
    pub fn truth(&mut self, depth: usize) -> Expression {
        self.budget -= 1;
        let below = depth.saturating_sub(1);
        match self.random.below(12) {
            0..=4 => self.condition_on_numbers(below.min(2)),
            5 => {
                if let Some(place) = self.place(&Type::Bool, false) {
                    return place;
                }
                self.condition_on_numbers(below.min(1))
            }
            6 => {
                let ty = *self.random.choice(&Integer::ALL);
                match self.place(&Type::Integer(ty), false) {
                    Some(place) => {
                        let b = integer(self.random.below(6) as i128, ty, false);
                        Expression::Comparison(self.relation(), Kind::Integer(ty), boxed(place), boxed(b))
                    }
                    None => self.known_truth(below),
                }
            }
            7 if depth > 0 && self.budget > 0 => {
                let a = self.truth(below);
                let b = if self.may(Class::ShortCircuit, 60) {
                    self.used(Class::ShortCircuit);
                    self.under_numbers += 1;
                    let effect = self.effect(&Type::Bool, below);
                    self.under_numbers -= 1;
                    effect
                } else {
                    self.truth(below)
                };
                let (a, b) = (boxed(a), boxed(b));
                if self.random.chance(50) { Expression::Both(a, b) } else { Expression::Either(a, b) }
            }
            8 if depth > 0 => {
                let a = self.truth(below);
                Expression::Not(Kind::Bool, boxed(a))
            }
            _ => self.known_truth(below),
        }
    }

    pub fn condition_on_numbers(&mut self, depth: usize) -> Expression {
        let relation = *self.random.choice(&[
            Relation::Less,
            Relation::LessOrEqual,
            Relation::Greater,
            Relation::GreaterOrEqual,
        ]);
        let a = self.number(depth);
        let b = match self.number(depth.min(1)) {
            Expression::Real { value, .. } if !matches!(a, Expression::Real { .. }) => {
                Expression::Real { value, suffixed: self.random.chance(20) }
            }
            b => b,
        };
        Expression::Comparison(relation, Kind::Real, boxed(a), boxed(b))
    }
}

/// A block of its tail alone.
pub fn tail(expression: Expression) -> Block {
    Block { statements: Vec::new(), tail: Some(boxed(expression)) }
}
