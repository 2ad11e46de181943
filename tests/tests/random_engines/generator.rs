//! Fifty systems as source text, the same on every machine: random bodies made of all that a body may hold.
//!
//! Arguments of functions with a domain are kept inside it, and sizes near 1, so that what the engines
//! compute can be compared to a few roundings.

use std::fmt::Write;

/// How many systems.
pub const SYSTEMS: usize = 50;

/// Coefficients of each system, read as `self.c[k]`.
pub const COEFFICIENTS: usize = 6;

/// Degrees of freedom of system `index`.
pub fn degrees(index: usize) -> usize {
    [1, 2, 1, 2, 1, 3][index % 6]
}

/// What the system has beside L.
pub fn has_rayleigh(index: usize) -> bool {
    index % 5 != 4
}

pub fn has_force(index: usize) -> bool {
    index % 4 == 1
}

/// Every method of a number that has a derivative. System `index` holds number `index`, and others by chance.
pub const METHODS: [&str; 37] = [
    "recip",
    "exp",
    "exp2",
    "exp_m1",
    "ln",
    "log2",
    "log10",
    "ln_1p",
    "sin",
    "cos",
    "tan",
    "asin",
    "acos",
    "atan",
    "sinh",
    "cosh",
    "tanh",
    "asinh",
    "acosh",
    "atanh",
    "sqrt",
    "cbrt",
    "abs",
    "signum",
    "powi",
    "powf",
    "atan2",
    "hypot",
    "copysign",
    "min",
    "max",
    "clamp",
    "mul_add",
    "sin_cos",
    "to_radians",
    "to_degrees",
    "log",
];

/// SplitMix64.
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    fn choice<'a>(&mut self, of: &[&'a str]) -> &'a str {
        of[self.below(of.len())]
    }
}

/// The text of `systems.rs`.
pub fn text() -> String {
    let mut systems = String::new();
    for index in 0..SYSTEMS {
        systems += &Writer::new(index).system();
    }
    let file = syn::parse_file(&systems).expect("the generator writes Rust");
    let systems = prettyplease::unparse(&file).replace("ENGINE", "$engine");
    let mut text = String::from(
        "// Written by generator.rs: `UPDATE_SYSTEMS=1 cargo test -p dalembert-tests --test random_engines`.\n\n\
         /// The systems, with the engine named.\n\
         macro_rules! systems {\n    ($engine:ident) => {\n        use dalembert::rayleigh_system;\n\n",
    );
    for line in systems.lines() {
        let indent = if line.is_empty() { "" } else { "        " };
        writeln!(text, "{indent}{line}").expect("a string takes all");
    }
    text += "    };\n}\n\n/// `$each!(name, n, rayleigh?, force?)` for every system.\nmacro_rules! every_system {\n    ($each:ident) => {\n        [\n";
    for index in 0..SYSTEMS {
        let rayleigh = if has_rayleigh(index) { "rayleigh" } else { "" };
        let force = if has_force(index) { "force" } else { "" };
        writeln!(text, "            $each!(System{index}, {}, [{rayleigh}], [{force}]),", degrees(index))
            .expect("a string takes all");
    }
    text + "        ]\n    };\n}\n"
}

/// The writer of one system.
struct Writer {
    index: usize,
    n: usize,
    random: Random,
    /// Coefficients handed out, each in turn.
    coefficients: usize,
    /// Whether what is written is R, which has no kinks under the midpoint rule.
    is_rayleigh: bool,
}

/// Numbers in scope, as expressions of type `f64`.
type Scope = Vec<String>;

impl Writer {
    fn new(index: usize) -> Self {
        Self {
            index,
            n: degrees(index),
            random: Random(1000 + index as u64),
            coefficients: 0,
            is_rayleigh: false,
        }
    }

    /// `self.c[k]`, every coefficient in turn.
    fn coefficient(&mut self) -> String {
        self.coefficients += 1;
        format!("self.c[{}]", (self.coefficients - 1) % COEFFICIENTS)
    }

    fn literal(&mut self) -> String {
        self.random
            .choice(&["0.5_f64", "1.25_f64", "2.0_f64", "0.3_f64", "1.5_f64", "0.1_f64", "3.0_f64"])
            .to_owned()
    }

    /// A name in scope, a literal or a coefficient.
    fn leaf(&mut self, scope: &Scope) -> String {
        match self.random.below(6) {
            0 => self.literal(),
            1 => self.coefficient(),
            _ => scope[self.random.below(scope.len())].clone(),
        }
    }

    /// An expression of size about 1, which stands as one operand.
    fn expression(&mut self, scope: &Scope, depth: usize) -> String {
        if depth == 0 {
            return self.leaf(scope);
        }
        let method = METHODS[self.random.below(METHODS.len())];
        let [a, b] = [0; 2].map(|_| self.expression(scope, depth - 1));
        match self.random.below(10) {
            0..=1 => format!("({a} + {b})"),
            2 => format!("({a} - {b})"),
            3 => format!("({a} * {b})"),
            4 => format!("({a} / (2.0 + {b} * {b}))"),
            5 => format!("(-{a})"),
            _ => self.method(method, &a, &b),
        }
    }

    /// The method applied to a, or to a and b, inside its domain.
    fn method(&mut self, method: &str, a: &str, b: &str) -> String {
        match method {
            "recip" | "sqrt" | "ln" | "log2" | "log10" => format!("(1.5 + {a} * {a}).{method}()"),
            "cbrt" => format!("(2.5 + {a}.sin()).cbrt()"),
            "ln_1p" => format!("(0.4 * {a}.cos()).ln_1p()"),
            "asin" | "acos" | "atanh" => format!("(0.6 * {a}.sin()).{method}()"),
            "acosh" => format!("(1.7 + {a} * {a}).acosh()"),
            "tan" | "exp" | "exp2" | "exp_m1" | "sinh" | "cosh" => format!("(0.7 * {a}.sin()).{method}()"),
            "powi" => {
                let n = self.random.choice(&["2", "3", "-1", "5", "-2", "4", "1", "0"]);
                format!("(1.6 + 0.5 * {a}.cos()).powi({n})")
            }
            "powf" => match self.random.below(3) {
                0 => format!("(1.2 + {a} * {a}).powf(0.75)"),
                1 => format!("(1.2 + {a} * {a}).powf({})", self.coefficient()),
                _ => format!("(1.3 + {a} * {a}).powf({b}.sin())"),
            },
            "atan2" => format!("{a}.atan2(2.0 + {b} * {b})"),
            "hypot" => format!("{a}.hypot(1.0 + {b} * {b})"),
            "abs" if self.is_rayleigh => format!("({a} * {a}.abs())"),
            "copysign" => format!("{a}.copysign({b})"),
            "min" | "max" => format!("{a}.{method}({b})"),
            "clamp" => format!("{a}.clamp(-0.8, 0.9)"),
            "mul_add" => format!("{a}.mul_add({b}, {})", self.coefficient()),
            "sin_cos" => format!("({{ let (s, c) = {a}.sin_cos(); s * {b} + c }})"),
            "to_degrees" => format!("(0.02 * {a}.to_degrees())"),
            "to_radians" => format!("(20.0 * {a}.to_radians())"),
            "log" => format!("(1.4 + {a} * {a}).log(3.0 + {b} * {b})"),
            // sin, cos, atan, tanh, asinh, abs, signum.
            _ => format!("{a}.{method}()"),
        }
    }

    /// The entries of the arrays in scope.
    fn entries(&self, arrays: &[&str]) -> Scope {
        arrays.iter().flat_map(|array| (0..self.n).map(move |i| format!("{array}[{i}]"))).collect()
    }

    /// Statements and a tail: what the body sums up to.
    fn body(&mut self, arrays: &[&str], featured: &str) -> String {
        let mut scope = self.entries(arrays);
        let mut body = String::new();
        for index in 0..1 + self.random.below(2) {
            let name = format!("t{index}");
            let statement = self.statement(&scope, arrays, &name);
            body += &statement;
            scope.push(name);
        }
        // Of variables alone: a method of coefficients has no derivative.
        let [a, b] = [0; 2].map(|_| scope[self.random.below(scope.len())].clone());
        let featured = self.method(featured, &a, &b);
        let tail = self.expression(&scope, 1);
        let (last, coefficient) = (&scope[scope.len() - 1], self.coefficient());
        writeln!(body, "{featured} + {coefficient} * {tail} + {last}").expect("a string takes all");
        body
    }

    /// `let name = …;` in one of the ways that a body may compute a number.
    fn statement(&mut self, scope: &Scope, arrays: &[&str], name: &str) -> String {
        let array = arrays[self.random.below(arrays.len())];
        let mut own = scope.clone();
        let coefficient = self.coefficient();
        match self.random.below(9) {
            0 => format!("let {name} = {};\n", self.expression(scope, 2)),
            1 => {
                own.push(format!("{array}[i]"));
                let term = self.expression(&own, 1);
                format!(
                    "let mut {name} = 0.0;\nfor i in 0..{} {{ {name} += {coefficient} * {term} * {array}[i] / (i as f64 + 1.0); }}\n",
                    self.n
                )
            }
            2 => {
                own.push("x".to_owned());
                let term = self.expression(&own, 1);
                format!(
                    "let mut {name} = {coefficient};\nfor (i, &x) in {array}.iter().enumerate() {{ if i % 2 == 0 {{ {name} += x * {term}; }} else {{ {name} -= 0.5 * x; }} }}\n"
                )
            }
            3 => {
                let other = arrays[arrays.len() - 1];
                format!(
                    "let {name}: f64 = {array}.iter().zip({other}.iter()).map(|(a, b)| {coefficient} * a * b).sum();\n"
                )
            }
            4 => {
                let [a, b, c] = [1; 3].map(|depth| self.expression(scope, depth));
                format!("let {name} = if {a} < {coefficient} {{ {b} }} else {{ {coefficient} * {c} }};\n")
            }
            5 => {
                let [a, b] = [1; 2].map(|depth| self.expression(scope, depth));
                format!("let {name} = self.hill({a}, {b});\n")
            }
            6 => {
                let a = self.expression(scope, 1);
                format!(
                    "let scale = |x: f64| x * {coefficient} + {a};\nlet {name} = scale({array}[0]) * 0.5;\n"
                )
            }
            7 => format!(
                "let {name} = {coefficient} * {array}.iter().fold(0.25, |total, x| total + x * x) + Self::square({array}[{}]);\n",
                self.n - 1
            ),
            _ => {
                let [a, b] = [1; 2].map(|depth| self.expression(scope, depth));
                format!(
                    "let mut {name} = {a};\nif {name} > {coefficient} && {array}[0] < 0.6 {{ {name} *= 0.5; {name} += {b}; }}\n"
                )
            }
        }
    }

    fn system(&mut self) -> String {
        let (index, n) = (self.index, self.n);
        let featured = METHODS[index % METHODS.len()];
        let mut kinetic = String::new();
        for i in 0..n {
            let (coefficient, term) =
                (self.coefficient(), self.expression(&vec![format!("q[{}]", (i + 1) % n)], 1));
            writeln!(kinetic, "let m{i} = 1.0 + {coefficient} + Self::square({term});")
                .expect("a string takes all");
        }
        let energy: Vec<_> = (0..n).map(|i| format!("0.5 * m{i} * v[{i}] * v[{i}]")).collect();
        let potential = self.body(&["q", "v"], featured);
        let mut text = format!(
            "
        pub struct System{index} {{ pub c: [f64; {COEFFICIENTS}] }}

        #[rayleigh_system(derivatives = ENGINE)]
        impl System{index} {{
            fn lagrangian(&self, q: [f64; {n}], v: [f64; {n}]) -> f64 {{
                {kinetic}{} - {{ {potential} }}
            }}
",
            energy.join(" + ")
        );
        if has_rayleigh(index) {
            let of_both = self.random.below(2) == 0;
            let arrays: &[&str] = if of_both { &["q", "v"] } else { &["v"] };
            let parameters = arrays.iter().map(|array| format!("{array}: [f64; {n}]"));
            self.is_rayleigh = true;
            let body = self.body(arrays, METHODS[(index + 17) % METHODS.len()]);
            self.is_rayleigh = false;
            write!(
                text,
                "
            fn rayleigh(&self, {}) -> f64 {{
                {body}
            }}
",
                parameters.collect::<Vec<_>>().join(", ")
            )
            .expect("a string takes all");
        }
        if has_force(index) {
            let scope = self.entries(&["q", "v"]);
            let components: Vec<_> = (0..n).map(|_| self.expression(&scope, 2)).collect();
            write!(
                text,
                "
            fn force(&self, q: [f64; {n}], v: [f64; {n}]) -> [f64; {n}] {{
                [{}]
            }}
",
                components.join(", ")
            )
            .expect("a string takes all");
        }
        text + "
            fn square(x: f64) -> f64 { x * x }

            fn hill(&self, x: f64, y: f64) -> f64 {
                if x * y > self.c[0] {
                    return self.c[1] * x;
                }
                let size = 1.0 + Self::square(x) + y.powi(2);
                self.c[2] / size.sqrt()
            }
        }
"
    }
}
