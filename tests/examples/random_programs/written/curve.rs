//! Functions of one variable: potentials, and what else a body computes from a displacement.

use super::draft::Draft;
use super::manner::Manner;

impl Draft {
    /// An operand that is some function of `x`; what it needs before goes to `lines`.
    pub fn curve(&mut self, x: &str, lines: &mut Vec<String>) -> String {
        if self.may(Manner::Helpers, 40) {
            return self.in_helper(x);
        }
        if self.may(Manner::Closures, 35) {
            return self.in_closure(x, lines);
        }
        self.scoped(|draft| draft.written_out(x, lines))
    }

    /// The same in a function of the block.
    fn in_helper(&mut self, x: &str) -> String {
        let scalar = self.scalar;
        let name =
            self.item(&["potential", "height", "spring", "energy", "shape", "d", "lift", "value", "real"]);
        let live = std::mem::take(&mut self.live);
        let parameter = self.local();
        let mut body = Vec::new();
        let is_early = self.may(Manner::EarlyReturns, 50);
        if is_early {
            let (bound, result) = (self.number(-2.0, 2.0), self.quantity(0.0, 1.0));
            body.push(format!("if {parameter} < {bound} {{ return {result} * {parameter}; }}"));
        }
        let value = self.written_out(&parameter, &mut body);
        self.live = live;
        let body = body.join("\n");
        self.block
            .push(format!("fn {name}(&self, {parameter}: {scalar}) -> {scalar} {{\n{body}\n{value}\n}}"));
        format!("self.{name}({x})")
    }

    fn in_closure(&mut self, x: &str, lines: &mut Vec<String>) -> String {
        let scalar = self.scalar;
        let name = self.local();
        let value = self.scoped(|draft| {
            let parameter = draft.local();
            let mut body = Vec::new();
            let value = draft.written_out(&parameter, &mut body);
            let value = if body.is_empty() { value } else { format!("{{\n{}\n{value}\n}}", body.join("\n")) };
            format!("|{parameter}: {scalar}| {value}")
        });
        lines.push(format!("let {name} = {value};"));
        if self.random.chance(30) {
            let scalar = self.scalar;
            return format!("({{ let pair: [{scalar}; 1] = [{x}].map({name}); pair[0] }})");
        }
        format!("{name}({x})")
    }

    fn written_out(&mut self, x: &str, lines: &mut Vec<String>) -> String {
        let weights = [
            10,
            self.weight(Manner::Tables, 45),
            self.weight(Manner::Laws, 25),
            self.weight(Manner::Options, 20),
            self.weight(Manner::StructArrays, 30),
            self.weight(Manner::Contacts, 20),
            self.weight(Manner::Recursion, 15),
            self.weight(Manner::FreeFunctions, 30),
            self.weight(Manner::StructMethods, 30),
            self.weight(Manner::OwnMethods, 30),
            self.weight(Manner::Decisions, 20),
            self.weight(Manner::Turns, 25),
            self.weight(Manner::FunctionPaths, 15),
            self.weight(Manner::Matrices, 20),
            self.weight(Manner::SeveralHelpers, 20),
            self.weight(Manner::Literals, 30),
        ];
        match self.random.weighted(&weights).unwrap_or(0) {
            0 => self.formula(x, lines),
            1 => self.table(x, lines),
            2 => self.law(x, lines),
            3 => self.stop(x),
            4 => self.springs(x, lines),
            5 => self.contact(x, lines),
            6 => self.recursive(x),
            7 => {
                self.used.insert(Manner::FreeFunctions);
                let (name, scalar) = (self.item(&["square", "cubed"]), self.scalar);
                self.items.push(format!("pub fn {name}(x: {scalar}) -> {scalar} {{ x * x }}"));
                format!("{name}({x})")
            }
            8 => {
                self.used.insert(Manner::StructMethods);
                let part = self.in_part("0.5");
                let scalar = self.scalar;
                let (ty, members) = &self.parts[self.parts.len() - 1];
                let (ty, member) = (ty.clone(), members[0].0.clone());
                let method = self.item(&["inertia", "stretch"]);
                self.items.push(format!("impl {ty} {{\n    pub fn {method}(&self, x: {scalar}) -> {scalar} {{ self.{member} * x * x }}\n}}"));
                format!("({part} + self.{}.{method}({x}))", ty.to_lowercase())
            }
            10 => self.decided(x),
            11 => self.turned(x, lines),
            12 => self.by_path_of_function(x),
            13 => self.quadratic(x, lines),
            14 => self.of_several(x, lines),
            15 => self.made(x, lines),
            _ => {
                self.used.insert(Manner::OwnMethods);
                self.shared(Manner::OwnMethods, &["Squared", "Powers"], |name, scalar| {
                    format!(
                        "pub trait {name} {{ fn squared(self) -> Self; fn len(&self) -> {scalar}; }}\n\
                         impl {name} for {scalar} {{\n    fn squared(self) -> {scalar} {{ self * self }}\n    fn len(&self) -> {scalar} {{ self.abs() }}\n}}"
                    )
                });
                format!("({x}).{}()", self.one_of(&["squared", "len"]))
            }
        }
    }

    /// Formulas of physics.
    fn formula(&mut self, x: &str, lines: &mut Vec<String>) -> String {
        match self.random.below(16) {
            0 => format!("({} * {x} * {x})", self.factor(0.5, 3.0)),
            1 => format!("(0.5 * {} * ({x}).powi(2))", self.quantity(0.5, 4.0)),
            2 => {
                let (k, c) = (self.factor(0.2, 2.0), self.quantity(0.1, 0.9));
                format!("({k} * ({x}).powi(2) / 2.0 + 0.25 * {c} * ({x}).powi(4))")
            }
            3 => {
                let (m, g, length) =
                    (self.factor(0.5, 2.0), self.quantity(1.0, 9.0), self.quantity(0.3, 1.5));
                format!("({m} * {g} * {length} * (1.0 - ({x}).cos()))")
            }
            4 => {
                let (a, d) = (self.quantity(0.3, 1.2), self.quantity(0.5, 2.0));
                let local = self.local();
                lines.push(format!("let {local} = 1.0 - (-{a} * ({x})).exp();"));
                format!("({d} * {local} * {local})")
            }
            5 => {
                let (sine, cosine) = (self.local(), self.local());
                lines.push(format!("let ({sine}, {cosine}) = ({x}).sin_cos();"));
                format!("({sine} * {cosine} * {})", self.quantity(0.2, 2.0))
            }
            6 => format!("({} * ({x}).hypot({}))", self.factor(0.2, 2.0), self.number(0.5, 2.0)),
            7 => format!("({x}).atan2({}).powi(2)", self.quantity(1.5, 3.0)),
            8 => format!("(({x}) * ({x}) + {}).powf({})", self.quantity(0.2, 1.0), self.number(0.5, 1.8)),
            9 => format!(
                "({x}).mul_add({}, {} * ({x}).powi(3))",
                self.quantity(0.5, 2.0),
                self.quantity(0.1, 0.5)
            ),
            10 => self.polynomial(x, lines),
            11 => format!("({} * (({x}) / {}).tanh())", self.factor(0.5, 2.0), self.quantity(0.5, 2.0)),
            12 => format!("{} * (1.0 + ({x}) * ({x})).sqrt().ln_1p()", self.factor(0.5, 2.0)),
            13 => format!("(-{} / (({x}).abs() + {}))", self.quantity(0.5, 2.0), self.quantity(0.5, 1.0)),
            14 => self.waves(x),
            _ => {
                let (y, scalar) = (self.local(), self.scalar);
                lines.push(format!("let {y}: {scalar} = {x};"));
                if self.may(Manner::Shadowing, 70) {
                    lines.push(format!("let {y} = {y} - {};", self.quantity(0.1, 0.5)));
                    lines.push(format!("let {y} = {y} * {y};"));
                }
                format!("({} * {y} - {y}.sin())", self.factor(0.2, 1.0))
            }
        }
    }

    fn polynomial(&mut self, x: &str, lines: &mut Vec<String>) -> String {
        let scalar = self.scalar;
        let entries =
            format!("[{}, {}, {}]", self.number(-1.0, 1.0), self.number(0.1, 1.0), self.number(-0.3, 0.3));
        let coefficients = self.array(&entries, 3, lines);
        let (sum, entry) = (self.local(), self.local());
        let turn = match self.random.below(3) {
            0 => format!(
                "for {entry} in {coefficients}.iter().rev() {{ {sum} = {sum}.mul_add({x}, *{entry}); }}"
            ),
            1 => format!("for &{entry} in &{coefficients} {{ {sum} = {sum} * ({x}) + {entry}; }}"),
            _ => format!("for i in 0..3 {{ {sum} += {coefficients}[i] * ({x}).powi(i as i32 + 1); }}"),
        };
        lines.push(format!("let mut {sum}: {scalar} = 0.0;"));
        let turn = if turn.contains("for i") { turn } else { self.followed(&coefficients, 3, &turn, lines) };
        lines.push(turn);
        sum
    }

    fn waves(&mut self, x: &str) -> String {
        let (scalar, amplitude) = (self.scalar, self.quantity(0.1, 1.0));
        let i = self.scoped(Self::local);
        match self.random.below(2) {
            0 => format!(
                "(1..=3).map(|{i}| {amplitude} / {i} as {scalar} * ({i} as {scalar} * ({x})).cos()).sum::<{scalar}>()"
            ),
            _ => format!(
                "(1..4).fold(0.0, |sum: {scalar}, {i}| sum + {amplitude} * (({x}) * ({i} as {scalar})).sin())"
            ),
        }
    }

    fn recursive(&mut self, x: &str) -> String {
        self.used.insert(Manner::Recursion);
        let scalar = self.scalar;
        let name = self.item(&["power", "series"]);
        let last = self.quantity(0.5, 1.0);
        self.block.push(format!(
            "fn {name}(&self, x: {scalar}, n: u32) -> {scalar} {{\nif n == 0 {{ {last} }} else {{ x * self.{name}(x, n - 1) / n as {scalar} }}\n}}"
        ));
        format!("self.{name}({x}, {})", 1 + self.random.below(3))
    }

    /// A contact that pushes from some place on.
    fn contact(&mut self, x: &str, lines: &mut Vec<String>) -> String {
        self.used.insert(Manner::Contacts);
        let (k, wall) = (self.quantity(2.0, 9.0), self.quantity(-0.5, 0.5));
        let depth = self.local();
        match self.random.below(4) {
            0 => {
                lines.push(format!("let {depth} = {wall} - ({x});"));
                format!("(if {depth} > 0.0 {{ 0.5 * {k} * {depth} * {depth} }} else {{ 0.0 }})")
            }
            1 => {
                lines.push(format!("let {depth} = (({x}) - {wall}).max(0.0);"));
                format!("(0.5 * {k} * {depth}.powi(2))")
            }
            2 => {
                let scalar = self.scalar;
                lines.push(format!("let mut {depth}: {scalar} = 0.0;\nif ({x}) < {wall} {{\n    {depth} += {k} * (({x}) - {wall}).powi(2);\n}}"));
                depth
            }
            _ => {
                lines.push(format!("let {depth} = ({x}).abs().min(1.5);"));
                format!("({k} * {depth} * {depth} * (({x}) - {wall}).clamp(-1.0, 1.0))")
            }
        }
    }
}
