//! A number of the model, and where it is kept.

use super::draft::Draft;
use super::manner::Manner;

const FIELDS: [&str; 14] =
    ["m", "k", "g", "length", "c", "t", "d", "mass", "q", "h", "stiffness", "radius", "rate", "value"];

impl Draft {
    /// An operand that is a number from `low` to `high`.
    pub fn quantity(&mut self, low: f64, high: f64) -> String {
        let value = self.number(low, high);
        let (scalar, value) = (self.scalar, value.as_str());
        let weights = [
            8,
            10,
            10,
            self.weight(Manner::BlockConstants, 10),
            self.weight(Manner::SmallConstants, 8),
            self.weight(Manner::PathConstants, 8),
            self.weight(Manner::Nested, 12),
            self.weight(Manner::Arrays, 8),
            self.weight(Manner::Tuples, 6),
            self.weight(Manner::Newtypes, 8),
            self.weight(Manner::OwnOperators, 8),
            self.weight(Manner::Boxes, 8),
            self.weight(Manner::OtherPrecision, 6),
            self.weight(Manner::Integers, 6),
            self.weight(Manner::StandardConstants, 6),
            self.weight(Manner::ConstGenerics, 6),
            self.weight(Manner::Fragments, 12),
        ];
        match self.random.weighted(&weights).unwrap_or(0) {
            0 => value.to_owned(),
            1 => {
                let name = self.constant();
                self.items.push(format!("pub const {name}: {scalar} = {value};"));
                if self.random.chance(10) { format!("self::{name}") } else { name }
            }
            2 => format!("self.{}", self.field(&FIELDS, scalar, value)),
            3 => {
                self.used.insert(Manner::BlockConstants);
                let name = self.constant();
                self.block.push(format!("const {name}: {scalar} = {value};"));
                format!("{}::{name}", if self.random.chance(80) { "Self" } else { "System" })
            }
            4 => {
                self.used.insert(Manner::SmallConstants);
                let name = self
                    .item(&["g_0", "rho", "mu", "stiff", "t2", "d1", "sin_q0", "q2", "p0", "omega", "eps"]);
                let kind = if self.random.chance(70) { "const" } else { "static" };
                self.items.push(format!("pub {kind} {name}: {scalar} = {value};"));
                name
            }
            5 => self.by_path(value),
            6 => self.in_part(value),
            7 => {
                self.used.insert(Manner::Arrays);
                let second = self.number(low, high);
                let index = self.random.below(2);
                let entries =
                    if index == 0 { format!("[{value}, {second}]") } else { format!("[{second}, {value}]") };
                format!(
                    "self.{}[{index}]",
                    self.field(&["coefficients", "masses", "k", "t"], &format!("[{scalar}; 2]"), &entries)
                )
            }
            8 => {
                self.used.insert(Manner::Tuples);
                let pair = self.field(
                    &["pair", "spring", "d"],
                    &format!("({scalar}, u8)"),
                    &format!("({value}, 3)"),
                );
                format!("self.{pair}.0")
            }
            9 => {
                self.used.insert(Manner::Newtypes);
                let ty =
                    self.shared(Manner::Newtypes, &["Metres", "Kilograms", "Newtons"], |name, scalar| {
                        format!("#[derive(Clone, Copy)]\npub struct {name}(pub {scalar});")
                    });
                format!("self.{}.0", self.field(&FIELDS, &ty, &format!("{ty}({value})")))
            }
            10 => format!("(*self.{})", self.stiff_field(value)),
            11 => {
                self.used.insert(Manner::Boxes);
                match self.random.below(2) {
                    0 => format!(
                        "(*self.{})",
                        self.field(&FIELDS, &format!("Box<{scalar}>"), &format!("Box::new({value})"))
                    ),
                    _ => format!(
                        "(*self.{})",
                        self.field(&FIELDS, &format!("&'static {scalar}"), &format!("&{value}"))
                    ),
                }
            }
            12 => {
                self.used.insert(Manner::OtherPrecision);
                let other = if scalar == "f64" { "f32" } else { "f64" };
                let field = self.field(&FIELDS, other, value);
                if scalar == "f64" && self.random.chance(40) {
                    return format!("f64::from(self.{field})");
                }
                format!("(self.{field} as {scalar})")
            }
            13 => {
                self.used.insert(Manner::Integers);
                let ty = self.one_of(&["i32", "u8", "usize", "i64"]);
                let count = 1 + self.random.below(4);
                let field = self.field(&["count", "teeth", "n", "turns"], &ty, &count.to_string());
                format!("(self.{field} as {scalar})")
            }
            14 => {
                self.used.insert(Manner::StandardConstants);
                let name = self.one_of(&["PI", "TAU", "FRAC_PI_2", "E", "SQRT_2", "LN_2"]);
                if self.may(Manner::Imports, 60) {
                    let name = self.item(&["PI", "TAU", "E"]);
                    let of_std = name.trim_end_matches(char::is_numeric);
                    self.items.push(
                        format!("use std::{scalar}::consts::{of_std} as {name};")
                            .replace(&format!("{name} as {name};"), &format!("{name};")),
                    );
                    return name;
                }
                format!("std::{scalar}::consts::{name}")
            }
            15 => {
                self.used.insert(Manner::ConstGenerics);
                let ty = self.shared(Manner::ConstGenerics, &["Gear", "Stage"], |name, scalar| {
                    format!("pub struct {name}<const N: usize>;\nimpl<const N: usize> {name}<N> {{\n    pub const RATIO: {scalar} = N as {scalar} * 0.5;\n}}")
                });
                format!("{ty}::<{}>::RATIO", 1 + self.random.below(4))
            }
            _ => {
                self.used.insert(Manner::Fragments);
                let second = self.number(0.1, 1.0);
                let sum = match self.random.below(4) {
                    0 => format!("{value} + {second}"),
                    1 => format!("if {second} < 0.5 {{ {value} }} else {{ {second} }}"),
                    2 => format!("-{value} + {second} * 2.0"),
                    _ => value.to_owned(),
                };
                self.fragments.push(sum);
                format!("$e{}", self.fragments.len() - 1)
            }
        }
    }

    /// What may stand left of `*` and a number: operators of a type's own too.
    pub fn factor(&mut self, low: f64, high: f64) -> String {
        if self.may(Manner::OwnOperators, 40) {
            let value = self.number(low, high);
            return format!("self.{}", self.stiff_field(&value));
        }
        if self.may(Manner::Boxes, 20) {
            let value = self.number(low, high);
            return format!(
                "self.{}",
                self.field(&FIELDS, &format!("&'static {}", self.scalar), &format!("&{value}"))
            );
        }
        self.quantity(low, high)
    }

    /// A field that dereferences to a number; times a number it is more than what it holds.
    fn stiff_field(&mut self, value: &str) -> String {
        self.used.insert(Manner::OwnOperators);
        let ty = self.shared(Manner::OwnOperators, &["Stiffness", "Scaled", "Damping"], |name, scalar| {
            format!(
                "#[derive(Clone, Copy)]\npub struct {name}(pub {scalar});\n\
                 impl std::ops::Deref for {name} {{\n    type Target = {scalar};\n    fn deref(&self) -> &{scalar} {{ &self.0 }}\n}}\n\
                 impl std::ops::Mul<{scalar}> for {name} {{\n    type Output = {scalar};\n    fn mul(self, other: {scalar}) -> {scalar} {{ 3.0 * self.0 * other }}\n}}\n\
                 impl std::ops::Add<{scalar}> for {name} {{\n    type Output = {scalar};\n    fn add(self, other: {scalar}) -> {scalar} {{ 2.0 * self.0 + other }}\n}}"
            )
        });
        self.field(&FIELDS, &ty, &format!("{ty}({value})"))
    }

    fn by_path(&mut self, value: &str) -> String {
        self.used.insert(Manner::PathConstants);
        let scalar = self.scalar;
        let name = self.constant();
        match self.random.below(3) {
            0 => {
                let module = self.item(&["physics", "dual", "earth"]);
                self.items
                    .push(format!("pub mod {module} {{\n    pub const {name}: {scalar} = {value};\n}}"));
                format!("{module}::{name}")
            }
            1 => {
                let ty = self.type_name(&["Earth", "Steel", "Rope"]);
                self.items.push(format!(
                    "pub struct {ty};\nimpl {ty} {{\n    pub const {name}: {scalar} = {value};\n}}"
                ));
                format!("{ty}::{name}")
            }
            _ => {
                let module = self.item(&["units", "world"]);
                self.items.push(format!(
                    "pub mod {module} {{\n    pub const {name}: {scalar} = {value};\n}}\n#[allow(unused_imports)]\npub use {module}::{name};"
                ));
                name
            }
        }
    }

    /// A member of a struct that is a field.
    pub fn in_part(&mut self, value: &str) -> String {
        self.used.insert(Manner::Nested);
        let index = if self.parts.is_empty() || self.random.chance(30) {
            let ty = self.item(&["Arm", "Rod", "Wheel", "Motor", "Rail"]);
            self.parts.push((ty, Vec::new()));
            self.parts.len() - 1
        } else {
            self.random.below(self.parts.len())
        };
        let (ty, members) = &mut self.parts[index];
        let name = FIELDS[members.len() % FIELDS.len()];
        members.push((name.to_owned(), self.scalar.to_owned(), value.to_owned()));
        format!("self.{}.{name}", ty.to_lowercase())
    }
}
