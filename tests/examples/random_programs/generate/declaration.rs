//! Fields with their values, structs, enums, constants.

use super::*;

impl Generator {
    pub fn declarations(&mut self) {
        if self.drawn.contains(&Class::Enumerations) {
            let variants = vec![
                ("Off".to_owned(), Vec::new()),
                ("Linear".to_owned(), vec![Type::Real]),
                ("Both".to_owned(), vec![Type::Real, Type::Integer(Integer::I32)]),
            ];
            let count = 2 + self.random.below(2);
            let enumeration =
                Enumeration { name: "Mode".to_owned(), variants: variants.into_iter().take(count).collect() };
            self.program.enumerations.push(enumeration);
        }
        if self.drawn.contains(&Class::NestedStructures) {
            let integer = Type::Integer(*self.random.choice(&Integer::ALL));
            let inner = Structure {
                name: "Inner".to_owned(),
                fields: vec![
                    ("k".to_owned(), Type::Real),
                    ("on".to_owned(), Type::Bool),
                    ("count".to_owned(), integer),
                ],
            };
            let outer = Structure {
                name: "Outer".to_owned(),
                fields: vec![
                    ("inner".to_owned(), Type::Struct(0)),
                    ("m".to_owned(), Type::Array(Box::new(Type::Real), 2)),
                    ("pair".to_owned(), Type::Tuple(vec![Type::Real, Type::Bool])),
                ],
            };
            self.program.structures.extend([inner, outer]);
        }
        self.fields();
        self.constants();
    }

    fn fields(&mut self) {
        let mut fields =
            vec![("m".to_owned(), Type::Real), ("c".to_owned(), Type::Array(Box::new(Type::Real), 3))];
        let mut add = |name: &str, ty: Type, chance: usize, random: &mut Random| {
            if random.chance(chance) {
                fields.push((name.to_owned(), ty));
            }
        };
        let integer = Type::Integer(*self.random.choice(&Integer::ALL));
        let random = &mut self.random;
        if self.drawn.contains(&Class::Integers) {
            add("count", integer, 60, random);
            add("n", Type::Integer(Integer::I32), 40, random);
            add("order", Type::Array(Box::new(Type::Integer(Integer::USIZE)), 2), 25, random);
        }
        if self.drawn.contains(&Class::KnownIf) {
            add("on", Type::Bool, 60, random);
        }
        if self.drawn.contains(&Class::TupleFields) {
            self.program.classes.insert(Class::TupleFields);
            add("spring", Type::Tuple(vec![Type::Real, Type::Integer(Integer::U32)]), 60, random);
        }
        if self.drawn.contains(&Class::NestedArrays) {
            add("table", Type::Array(Box::new(Type::Array(Box::new(Type::Real), 2)), 2), 60, random);
        }
        if self.drawn.contains(&Class::NestedStructures) {
            self.program.classes.insert(Class::NestedStructures);
            add("outer", Type::Struct(1), 100, random);
        }
        if self.drawn.contains(&Class::Enumerations) {
            add("mode", Type::Enum(0), 100, random);
        }
        if self.drawn.contains(&Class::Options) {
            add("extra", Type::Option(Box::new(Type::Real)), 80, random);
        }
        for (name, ty) in fields {
            let value = self.value(&ty);
            self.program.fields.push((name, ty, value));
        }
    }

    /// A literal of the type.
    fn value(&mut self, ty: &Type) -> Expression {
        match ty {
            Type::Real => {
                let Expression::Real { value, .. } = self.literal(false) else {
                    unreachable!("a literal is one")
                };
                Expression::Real { value, suffixed: false }
            }
            Type::Bool => Expression::Bool(self.random.chance(50)),
            Type::Integer(ty) if *ty == Integer::USIZE => integer(self.random.below(2) as i128, *ty, false),
            Type::Integer(ty) => {
                let value = if self.random.chance(10) { ty.greatest() } else { self.random.below(7) as i128 };
                let value = if ty.signed && self.random.chance(25) { -value } else { value };
                integer(value, *ty, false)
            }
            Type::Array(entry, length) => {
                let entries = (0..*length).map(|_| self.value(entry)).collect();
                Expression::Array(entries)
            }
            Type::Tuple(entries) => {
                let entries = entries.iter().map(|entry| self.value(entry)).collect();
                Expression::Tuple(entries)
            }
            Type::Option(inner) => {
                let some = self.random.chance(60).then(|| boxed(self.value(inner)));
                Expression::Optional(some)
            }
            Type::Enum(of) => {
                let variants = self.program.enumerations[*of].variants.clone();
                let variant = self.random.below(variants.len());
                let data = variants[variant].1.iter().map(|ty| self.value(ty)).collect();
                Expression::Variant { of: *of, variant, data }
            }
            Type::Struct(of) => {
                let fields = self.program.structures[*of].fields.clone();
                let values = fields.iter().map(|(_, ty)| self.value(ty)).collect();
                Expression::Structure { of: *of, values }
            }
            _ => unreachable!("no field has this type"),
        }
    }

    fn constants(&mut self) {
        for (class, in_block) in [(Class::BlockConstants, true), (Class::ModuleConstants, false)] {
            if !self.drawn.contains(&class) {
                continue;
            }
            self.used(class);
            let ty = Type::Integer(if self.random.chance(60) {
                Integer::USIZE
            } else {
                *self.random.choice(&Integer::ALL)
            });
            let suffix = if in_block { "B" } else { "M" };
            for (name, ty) in
                [("SIZE", ty), ("SCALE", Type::Real), ("WEIGHTS", Type::Array(Box::new(Type::Real), 2))]
            {
                if self.random.chance(70) {
                    let value = self.value(&ty);
                    let name = format!("{name}_{suffix}");
                    self.program.constants.push(Constant { name, ty, value, in_block });
                }
            }
        }
    }
}
