//! Forms of the language around a formula: loops, decisions, matrices, functions by path.

use super::draft::Draft;
use super::manner::Manner;

impl Draft {
    /// What an integer or a bool of the system decides.
    pub fn decided(&mut self, x: &str) -> String {
        self.used.insert(Manner::Decisions);
        let (k, c) = (self.quantity(0.3, 2.0), self.number(0.2, 1.0));
        match self.random.below(3) {
            0 => {
                let on = if self.random.chance(60) { "true" } else { "false" };
                let field = self.field(&["on", "is_stiff", "linear"], "bool", on);
                format!("(if self.{field} {{ {k} * ({x}).powi(2) }} else {{ {c} * ({x}).cos() }})")
            }
            1 => {
                let mode = self.random.below(3).to_string();
                let field = self.field(&["mode", "kind", "n"], "u8", &mode);
                format!(
                    "(match self.{field} {{ 0 => {k} * ({x}), 1 | 2 if {k} > {c} => ({x}).powi(2), _ => {c} * ({x}).sin() }})"
                )
            }
            _ => {
                let count = 1 + self.random.below(3);
                let field = self.field(&["power", "order", "n"], "i32", &count.to_string());
                format!("({c} * (1.5 + ({x}) * ({x})).powf(self.{field} as {}))", self.scalar)
            }
        }
    }

    pub fn turned(&mut self, x: &str, lines: &mut Vec<String>) -> String {
        self.used.insert(Manner::Turns);
        let scalar = self.scalar;
        let (sum, i) = (self.local(), self.local());
        let k = self.quantity(0.2, 0.9);
        lines.push(format!("let mut {sum}: {scalar} = {x};"));
        lines.push(match self.random.below(3) {
            0 => format!("let mut {i} = 0;\nwhile {i} < 3 {{\n    {sum} = {sum} - {k} * ({sum}).sin();\n    {i} += 1;\n}}"),
            1 => format!("let mut {i} = 3_u32;\nloop {{\n    if {i} == 0 {{ break; }}\n    {i} -= 1;\n    {sum} = {k} * {sum} + ({x}) / ({i} as {scalar} + 1.0);\n}}"),
            _ => format!(
                "'rows: for {i} in 0..3 {{\n    for j in 0..3 {{\n        if j > {i} {{ continue 'rows; }}\n        {sum} += {k} * ({x}) / (1.0 + ({i} + j) as {scalar});\n    }}\n}}"
            ),
        });
        sum
    }

    pub fn by_path_of_function(&mut self, x: &str) -> String {
        self.used.insert(Manner::FunctionPaths);
        let (scalar, k) = (self.scalar, self.quantity(0.3, 1.5));
        match self.random.below(4) {
            0 => format!("({k} * {scalar}::sin({x}))"),
            1 => format!("{scalar}::max({k} * ({x}), -{k})"),
            2 => format!("[{x}, {k}].map({scalar}::cos).iter().sum::<{scalar}>()"),
            _ => format!("{scalar}::powi({x}, 2)"),
        }
    }

    /// A quadratic form, of a matrix in the body or of the model.
    pub fn quadratic(&mut self, x: &str, lines: &mut Vec<String>) -> String {
        self.used.insert(Manner::Matrices);
        let scalar = self.scalar;
        let (a, b, c) = (self.number(0.5, 2.0), self.number(-0.3, 0.3), self.number(0.5, 2.0));
        let (matrix, w, sum) = (self.local(), self.local(), self.local());
        let entries = format!("[[{a}, {b}], [{b}, {c}]]");
        let value = match self.random.below(3) {
            0 => entries,
            1 => format!(
                "self.{}",
                self.field(&["matrix", "m", "k"], &format!("[[{scalar}; 2]; 2]"), &entries)
            ),
            _ => {
                let name = self.constant();
                self.items.push(format!("pub const {name}: [[{scalar}; 2]; 2] = {entries};"));
                name
            }
        };
        lines.push(format!("let {matrix}: [[{scalar}; 2]; 2] = {value};\nlet {w} = [{x}, 1.0 - ({x})];\nlet mut {sum}: {scalar} = 0.0;"));
        lines.push(match self.random.below(2) {
            0 => format!("for i in 0..2 {{\n    for j in 0..2 {{\n        {sum} += {w}[i] * {matrix}[i][j] * {w}[j];\n    }}\n}}"),
            _ => format!("for (row, left) in {matrix}.iter().zip({w}) {{\n    {sum} += left * row.iter().zip(&{w}).map(|(m, w)| m * w).sum::<{scalar}>();\n}}"),
        });
        format!("(0.5 * {sum})")
    }

    /// A helper of several numbers at once.
    pub fn of_several(&mut self, x: &str, lines: &mut Vec<String>) -> String {
        self.used.insert(Manner::SeveralHelpers);
        let scalar = self.scalar;
        let name = self.item(&["turned", "place", "polar", "dual"]);
        let (a, b) = (self.local(), self.local());
        let k = self.quantity(0.3, 1.2);
        match self.random.below(3) {
            0 => {
                self.block.push(format!("fn {name}(&self, x: {scalar}) -> ({scalar}, {scalar}) {{\n({k} * x.sin(), -{k} * x.cos())\n}}"));
                lines.push(format!("let ({a}, {b}) = self.{name}({x});"));
                format!("({a} * {a} + {b})")
            }
            1 => {
                self.block.push(format!(
                    "fn {name}(x: [{scalar}; 2]) -> [{scalar}; 2] {{\nlet [x, y] = x;\n[x - y, x * y].map(|{b}| {b} * 2.0)\n}}"
                ));
                lines.push(format!("let [{a}, {b}] = Self::{name}([{x}, {k}]);"));
                format!("({a} * {b})")
            }
            _ => {
                self.block.push(format!("fn {name}(&self, w: &[{scalar}; 2], scale: {scalar}) -> {scalar} {{\nscale * w.iter().map(|w| w * w).sum::<{scalar}>()\n}}"));
                lines.push(format!("let {a} = [{x}, {k}];"));
                format!("self.{name}(&{a}, 0.5)")
            }
        }
    }

    /// A struct that the body makes.
    pub fn made(&mut self, x: &str, lines: &mut Vec<String>) -> String {
        self.used.insert(Manner::Literals);
        let (ty, scalar, name) = (self.type_name(&["Place", "Pair"]), self.scalar, self.local());
        self.items.push(format!("pub struct {ty} {{\n    pub x: {scalar},\n    pub y: {scalar},\n}}"));
        lines.push(format!("let {name} = {ty} {{ x: {x}, y: {} }};", self.quantity(0.2, 1.0)));
        format!("({name}.x * {name}.y)")
    }
}
