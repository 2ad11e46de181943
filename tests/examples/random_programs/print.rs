//! Programs as Rust.

use std::fmt::Write;

use super::engine::options;
use super::syntax::*;
use super::types::Type;

/// The writer of one program.
pub struct Printer<'p> {
    program: &'p Program,
    text: String,
}

/// The annotated block, as the attribute sees it.
pub fn block(program: &Program) -> String {
    let mut printer = Printer { program, text: String::new() };
    printer.system();
    printer.text
}

/// The types, constants and the constructor around the block.
pub fn surroundings(program: &Program) -> String {
    let mut printer = Printer { program, text: String::new() };
    printer.definitions();
    printer.text
}

/// One expression, such as the value of a field.
pub fn expression(program: &Program, expression: &Expression) -> String {
    let mut printer = Printer { program, text: String::new() };
    printer.expression(expression);
    printer.text
}

/// All of it, formatted.
pub fn formatted(program: &Program, engine: &str) -> String {
    let text = format!(
        "{}\n#[dalembert::rayleigh_system({})]\n{}",
        surroundings(program),
        options(engine),
        without_unused(&block(program))
    );
    match syn::parse_file(&text) {
        Ok(file) => prettyplease::unparse(&file),
        Err(error) => format!("// {error}\n{text}"),
    }
}

/// The block without helpers that nothing calls.
fn without_unused(block: &str) -> String {
    let Ok(mut item) = syn::parse_str::<syn::ItemImpl>(block) else { return block.to_owned() };
    loop {
        let text = quote::ToTokens::to_token_stream(&item).to_string();
        let words: Vec<&str> = text.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
        let before = item.items.len();
        item.items.retain(|item| match item {
            syn::ImplItem::Fn(function) => {
                let name = function.sig.ident.to_string();
                ["lagrangian", "rayleigh", "force"].contains(&name.as_str())
                    || words.iter().filter(|word| **word == name).count() > 1
            }
            _ => true,
        });
        if item.items.len() == before {
            return text;
        }
    }
}

fn operator(operator: Operator) -> &'static str {
    match operator {
        Operator::Add => "+",
        Operator::Subtract => "-",
        Operator::Multiply => "*",
        Operator::Divide => "/",
        Operator::Remainder => "%",
        Operator::And => "&",
        Operator::Or => "|",
        Operator::Xor => "^",
        Operator::ShiftLeft => "<<",
        Operator::ShiftRight => ">>",
    }
}

fn relation(relation: Relation) -> &'static str {
    match relation {
        Relation::Less => "<",
        Relation::LessOrEqual => "<=",
        Relation::Greater => ">",
        Relation::GreaterOrEqual => ">=",
        Relation::Equal => "==",
        Relation::NotEqual => "!=",
    }
}

impl Printer<'_> {
    fn put(&mut self, text: &str) {
        self.text.push_str(text);
    }

    fn scalar(&self) -> &'static str {
        if self.program.single { "f32" } else { "f64" }
    }

    fn kind(&self, kind: Kind) -> String {
        match kind {
            Kind::Real => self.scalar().to_owned(),
            Kind::Single => "f32".to_owned(),
            Kind::Bool => "bool".to_owned(),
            Kind::Integer(ty) => ty.name(),
        }
    }

    fn ty(&self, ty: &Type) -> String {
        match ty {
            Type::Real => self.scalar().to_owned(),
            Type::Single => "f32".to_owned(),
            Type::Bool => "bool".to_owned(),
            Type::Integer(integer) => integer.name(),
            Type::Array(entry, length) => format!("[{}; {length}]", self.ty(entry)),
            Type::Tuple(entries) => {
                let entries: String = entries.iter().map(|entry| self.ty(entry) + ", ").collect();
                format!("({entries})")
            }
            Type::Option(inner) => format!("Option<{}>", self.ty(inner)),
            Type::Enum(index) => self.program.enumerations[*index].name.clone(),
            Type::Struct(index) => self.program.structures[*index].name.clone(),
            Type::Reference(inner) => format!("&{}", self.ty(inner)),
            Type::Slice(entry, _) => format!("&[{}]", self.ty(entry)),
        }
    }

    fn definitions(&mut self) {
        let program = self.program;
        for enumeration in &program.enumerations {
            let variants: Vec<String> = enumeration
                .variants
                .iter()
                .map(|(name, data)| {
                    let data: Vec<String> = data.iter().map(|ty| self.ty(ty)).collect();
                    if data.is_empty() { name.clone() } else { format!("{name}({})", data.join(", ")) }
                })
                .collect();
            let name = &enumeration.name;
            writeln!(
                self.text,
                "#[derive(Clone, Copy, PartialEq)]\npub enum {name} {{ {} }}",
                variants.join(", ")
            )
            .expect("a string takes all");
        }
        for structure in &program.structures {
            let fields: String =
                structure.fields.iter().map(|(name, ty)| format!("pub {name}: {}, ", self.ty(ty))).collect();
            let name = &structure.name;
            writeln!(self.text, "#[derive(Clone, Copy)]\npub struct {name} {{ {fields} }}")
                .expect("a string takes all");
        }
        for constant in program.constants.iter().filter(|constant| !constant.in_block) {
            self.constant(constant);
        }
        let fields: String =
            program.fields.iter().map(|(name, ty, _)| format!("pub {name}: {}, ", self.ty(ty))).collect();
        let values: String = program
            .fields
            .iter()
            .map(|(name, _, value)| format!("{name}: {}, ", expression(program, value)))
            .collect();
        writeln!(
            self.text,
            "pub struct System {{ {fields} }}\npub fn system() -> System {{ System {{ {values} }} }}"
        )
        .expect("a string takes all");
    }

    fn constant(&mut self, constant: &Constant) {
        let ty = self.ty(&constant.ty);
        write!(self.text, "const {}: {ty} = ", constant.name).expect("a string takes all");
        self.expression(&constant.value);
        self.put(";\n");
    }

    fn system(&mut self) {
        let (program, n, scalar) = (self.program, self.program.n, self.scalar());
        self.put("impl System {\n");
        for constant in program.constants.iter().filter(|constant| constant.in_block) {
            self.constant(constant);
        }
        let time =
            program.timed.map(|is_timed| if is_timed { format!(", t: {scalar}") } else { String::new() });
        write!(
            self.text,
            "pub fn lagrangian(&self, q: [{scalar}; {n}], v: [{scalar}; {n}]{}) -> {scalar} ",
            time[0]
        )
        .expect("a string takes all");
        self.block(&program.lagrangian);
        if let Some((of_both, body)) = &program.rayleigh {
            let q = if *of_both { format!("q: [{scalar}; {n}], ") } else { String::new() };
            write!(self.text, "\npub fn rayleigh(&self, {q}v: [{scalar}; {n}]{}) -> {scalar} ", time[1])
                .expect("a string takes all");
            self.block(body);
        }
        if let Some(body) = &program.force {
            let input = match program.inputs {
                0 => String::new(),
                m => format!(", u: [{scalar}; {m}]"),
            };
            write!(
                self.text,
                "\npub fn force(&self, q: [{scalar}; {n}], v: [{scalar}; {n}]{input}{}) -> [{scalar}; {n}] ",
                time[2]
            )
            .expect("a string takes all");
            self.block(body);
        }
        for helper in &program.helpers {
            let receiver = if helper.with_self { "&self, " } else { "" };
            let parameters: String = helper
                .parameters
                .iter()
                .map(|(name, mutable, ty)| {
                    format!("{}{name}: {}, ", if *mutable { "mut " } else { "" }, self.ty(ty))
                })
                .collect();
            let result = self.ty(&helper.result);
            write!(self.text, "\nfn {}({receiver}{parameters}) -> {result} ", helper.name)
                .expect("a string takes all");
            self.block(&helper.body);
        }
        self.put("\n}\n");
    }

    fn block(&mut self, block: &Block) {
        self.put("{\n");
        for statement in &block.statements {
            self.statement(statement);
        }
        if let Some(tail) = &block.tail {
            self.tail(tail);
        }
        self.put("\n}");
    }

    /// An expression that a block could end with: what starts with a block would end there.
    fn tail(&mut self, tail: &Expression) {
        self.expression(tail);
    }

    fn statement(&mut self, statement: &Statement) {
        match statement {
            Statement::Let { pattern, ty, value } => {
                self.put("let ");
                self.pattern(pattern);
                if let Some(ty) = ty {
                    let ty = self.ty(ty);
                    write!(self.text, ": {ty}").expect("a string takes all");
                }
                if let Some(value) = value {
                    self.put(" = ");
                    self.expression(value);
                }
                self.put(";\n");
            }
            Statement::LetElse { pattern, value, otherwise } => {
                self.put("let ");
                self.pattern(pattern);
                self.put(" = ");
                self.operand(value);
                self.put(" else ");
                self.block(otherwise);
                self.put(";\n");
            }
            Statement::LetClosure { name, mutable, closure } => {
                self.put(if *mutable { "let mut " } else { "let " });
                self.put(name);
                self.put(" = ");
                self.closure(closure);
                self.put(";\n");
            }
            Statement::LetIterator { name, chain } => {
                self.put("let mut ");
                self.put(name);
                self.put(" = ");
                self.chain(chain);
                self.put(";\n");
            }
            Statement::Expression(expression) => {
                self.expression(expression);
                self.put(";\n");
            }
            Statement::For { label, pattern, chain, body } => {
                self.label(label);
                self.put("for ");
                self.pattern(pattern);
                self.put(" in ");
                self.chain(chain);
                self.put(" ");
                self.block(body);
                self.put("\n");
            }
            Statement::While { label, condition, body } => {
                self.label(label);
                self.put("while ");
                self.expression(condition);
                self.put(" ");
                self.block(body);
                self.put("\n");
            }
            Statement::ConfiguredOut(inner) => {
                self.put("#[cfg(any())]\n");
                self.statement(inner);
            }
        }
    }

    fn label(&mut self, label: &Option<String>) {
        if let Some(label) = label {
            write!(self.text, "'{label}: ").expect("a string takes all");
        }
    }

    fn closure(&mut self, closure: &Closure) {
        self.put(if closure.moves { "move |" } else { "|" });
        for (index, (pattern, ty)) in closure.parameters.iter().enumerate() {
            if index > 0 {
                self.put(", ");
            }
            self.pattern(pattern);
            if let Some(ty) = ty {
                let ty = self.ty(ty);
                write!(self.text, ": {ty}").expect("a string takes all");
            }
        }
        self.put("| ");
        self.expression(&closure.body);
    }

    fn handed(&mut self, handed: &Handed) {
        match handed {
            Handed::Closure(closure) => self.closure(closure),
            Handed::Method(name) => {
                let scalar = self.scalar();
                write!(self.text, "{scalar}::{name}").expect("a string takes all");
            }
            Handed::Helper(helper) => {
                let name = &self.program.helpers[*helper].name;
                write!(self.text, "Self::{name}").expect("a string takes all");
            }
        }
    }

    fn chain(&mut self, chain: &Chain) {
        match &chain.source {
            Source::Iter(array) => {
                self.operand(array);
                self.put(".iter()");
            }
            Source::IntoIter(array) => {
                self.operand(array);
                self.put(".into_iter()");
            }
            Source::Plain(array) => self.expression(array),
            Source::Range { start, end, closed } => {
                self.put("(");
                self.operand(start);
                self.put(if *closed { "..=" } else { ".." });
                self.operand(end);
                self.put(")");
            }
            Source::Windows(array, width) => {
                self.operand(array);
                write!(self.text, ".windows({width})").expect("a string takes all");
            }
            Source::Chunks(array, width, exact) => {
                self.operand(array);
                let name = if *exact { "chunks_exact" } else { "chunks" };
                write!(self.text, ".{name}({width})").expect("a string takes all");
            }
            Source::Local(name) => self.put(name),
            Source::ByReference(name) => {
                self.put(name);
                self.put(".by_ref()");
            }
        }
        for adaptor in &chain.adaptors {
            self.adaptor(adaptor);
        }
    }

    fn adaptor(&mut self, adaptor: &Adaptor) {
        let (name, handed) = match adaptor {
            Adaptor::Map(handed) => ("map", handed),
            Adaptor::Filter(handed) => ("filter", handed),
            Adaptor::FlatMap(handed) => ("flat_map", handed),
            Adaptor::Zip(other, _) | Adaptor::Linked(other) => {
                self.put(if matches!(adaptor, Adaptor::Zip(..)) { ".zip(" } else { ".chain(" });
                self.chain(other);
                return self.put(")");
            }
            Adaptor::Enumerate => return self.put(".enumerate()"),
            Adaptor::Reversed => return self.put(".rev()"),
            Adaptor::Copied => return self.put(".copied()"),
            Adaptor::Skip(count) => return self.put(&format!(".skip({count})")),
            Adaptor::Take(count) => return self.put(&format!(".take({count})")),
            Adaptor::StepBy(count) => return self.put(&format!(".step_by({count})")),
        };
        self.put(&format!(".{name}("));
        self.handed(handed);
        self.put(")");
    }

    fn separated(&mut self, expressions: &[Expression]) {
        for (index, expression) in expressions.iter().enumerate() {
            if index > 0 {
                self.put(", ");
            }
            self.expression(expression);
        }
    }

    /// An expression as an operand, in parentheses where it is more than one token tree.
    fn operand(&mut self, expression: &Expression) {
        let is_atom = match expression {
            Expression::Name(_)
            | Expression::System
            | Expression::Member(..)
            | Expression::Index(..)
            | Expression::Constant(_)
            | Expression::Bool(_)
            | Expression::Function { .. }
            | Expression::Power(..)
            | Expression::Call { .. }
            | Expression::Apply(..)
            | Expression::Array(_)
            | Expression::Tuple(_)
            | Expression::Chain(..)
            | Expression::IntegerMethod { .. }
            | Expression::Converted { .. }
            | Expression::Mapped(..)
            | Expression::OptionMap(..)
            | Expression::UnwrapOr(..)
            | Expression::MapOr(..)
            | Expression::Optional(_)
            | Expression::Variant { .. }
            | Expression::Single(_) => true,
            Expression::Real { value, .. } => *value >= 0.0,
            Expression::Integer { value, .. } => *value >= 0,
            _ => false,
        };
        if is_atom {
            self.expression(expression);
        } else {
            self.put("(");
            self.expression(expression);
            self.put(")");
        }
    }

    fn infix(&mut self, a: &Expression, symbol: &str, b: &Expression) {
        self.operand(a);
        self.put(&format!(" {symbol} "));
        self.operand(b);
    }

    fn method(&mut self, receiver: &Expression, name: &str, arguments: &[Expression]) {
        self.operand(receiver);
        self.put(&format!(".{name}("));
        self.separated(arguments);
        self.put(")");
    }

    fn call(&mut self, function: &str, arguments: &[Expression]) {
        self.put(&format!("{function}("));
        self.separated(arguments);
        self.put(")");
    }

    fn expression(&mut self, expression: &Expression) {
        match expression {
            Expression::Real { value, suffixed } => {
                let text =
                    if self.program.single { format!("{:?}", *value as f32) } else { format!("{value:?}") };
                let suffix = if *suffixed { format!("_{}", self.scalar()) } else { String::new() };
                self.put(&(text + &suffix));
            }
            Expression::Single(value) => self.put(&format!("{value:?}_f32")),
            Expression::Integer { value, ty, suffixed } => {
                let suffix = if *suffixed { format!("_{}", ty.name()) } else { String::new() };
                self.put(&format!("{value}{suffix}"));
            }
            Expression::Bool(truth) => self.put(&truth.to_string()),
            Expression::Name(name) => self.put(name),
            Expression::System => self.put("self"),
            Expression::Member(base, member) => {
                self.operand(base);
                match member {
                    Member::Named(name, _) => self.put(&format!(".{name}")),
                    Member::Numbered(index) => self.put(&format!(".{index}")),
                }
            }
            Expression::Index(base, index) => {
                self.operand(base);
                self.put("[");
                self.expression(index);
                self.put("]");
            }
            Expression::Constant(index) => {
                let constant = &self.program.constants[*index];
                let path = if constant.in_block { "Self::" } else { "" };
                self.put(&format!("{path}{}", constant.name));
            }
            Expression::Dereferenced(inner) => {
                self.put("*");
                self.operand(inner);
            }
            Expression::Borrowed(inner) => {
                self.put("&");
                self.operand(inner);
            }
            Expression::Negated(_, inner) => {
                self.put("-");
                self.operand(inner);
            }
            Expression::Not(_, inner) => {
                self.put("!");
                self.operand(inner);
            }
            Expression::Arithmetic(symbol, _, a, b) => self.infix(a, operator(*symbol), b),
            Expression::Comparison(symbol, _, a, b) => self.infix(a, relation(*symbol), b),
            Expression::Both(a, b) => self.infix(a, "&&", b),
            Expression::Either(a, b) => self.infix(a, "||", b),
            Expression::Function { name, arguments, as_path } => {
                if *as_path {
                    let scalar = self.scalar();
                    self.call(&format!("{scalar}::{name}"), arguments);
                } else {
                    self.method(&arguments[0], name, &arguments[1..]);
                }
            }
            Expression::Power(x, n) => self.method(x, "powi", std::slice::from_ref(&**n)),
            Expression::IntegerMethod { name, ty, arguments, as_path } => {
                if *as_path {
                    self.call(&format!("{}::{name}", ty.name()), arguments);
                } else {
                    self.method(&arguments[0], name, &arguments[1..]);
                }
            }
            Expression::Cast { value, to, .. } => {
                self.operand(value);
                let to = self.kind(*to);
                self.put(&format!(" as {to}"));
            }
            Expression::Converted { value, .. } => {
                let scalar = self.scalar();
                self.call(&format!("{scalar}::from"), std::slice::from_ref(&**value));
            }
            Expression::Array(entries) => {
                self.put("[");
                self.separated(entries);
                self.put("]");
            }
            Expression::Repeated(entry, length) => {
                self.put("[");
                self.expression(entry);
                self.put(&format!("; {length}]"));
            }
            Expression::Tuple(entries) => {
                self.put("(");
                for entry in entries {
                    self.expression(entry);
                    self.put(", ");
                }
                self.put(")");
            }
            Expression::Optional(None) => self.put("None"),
            Expression::Optional(Some(inner)) => self.call("Some", std::slice::from_ref(&**inner)),
            Expression::Variant { of, variant, data } => {
                let enumeration = &self.program.enumerations[*of];
                self.put(&format!("{}::{}", enumeration.name, enumeration.variants[*variant].0));
                if !data.is_empty() {
                    self.call("", data);
                }
            }
            Expression::Structure { of, values } => {
                let structure = &self.program.structures[*of];
                self.put(&format!("{} {{ ", structure.name));
                for ((name, _), value) in structure.fields.iter().zip(values) {
                    self.put(&format!("{name}: "));
                    self.expression(value);
                    self.put(", ");
                }
                self.put("}");
            }
            Expression::Call { helper, arguments } => {
                let helper = &self.program.helpers[*helper];
                let receiver = if helper.with_self { "self." } else { "Self::" };
                self.call(&format!("{receiver}{}", helper.name), arguments);
            }
            Expression::Apply(name, arguments) => self.call(name, arguments),
            Expression::Block(label, block) => {
                self.label(label);
                self.block(block);
            }
            Expression::If(condition, then, otherwise) => {
                self.put("if ");
                self.expression(condition);
                self.put(" ");
                self.block(then);
                self.otherwise(otherwise);
            }
            Expression::IfLet(pattern, value, then, otherwise) => {
                self.put("if let ");
                self.pattern(pattern);
                self.put(" = ");
                self.operand(value);
                self.put(" ");
                self.block(then);
                self.otherwise(otherwise);
            }
            Expression::Match(value, arms) => {
                self.put("match ");
                self.operand(value);
                self.put(" {\n");
                for arm in arms {
                    self.pattern(&arm.pattern);
                    if let Some(guard) = &arm.guard {
                        self.put(" if ");
                        self.expression(guard);
                    }
                    self.put(" => ");
                    self.expression(&arm.body);
                    self.put(",\n");
                }
                self.put("}");
            }
            Expression::Matches(value, pattern, guard) => {
                self.put("matches!(");
                self.expression(value);
                self.put(", ");
                self.pattern(pattern);
                if let Some(guard) = guard {
                    self.put(" if ");
                    self.expression(guard);
                }
                self.put(")");
            }
            Expression::Loop(label, body) => {
                self.label(label);
                self.put("loop ");
                self.block(body);
            }
            Expression::Mapped(array, closure) | Expression::OptionMap(array, closure) => {
                self.operand(array);
                self.put(".map(");
                self.closure(closure);
                self.put(")");
            }
            Expression::FromFunction(closure, _) => {
                self.put("std::array::from_fn(");
                self.closure(closure);
                self.put(")");
            }
            Expression::Chain(chain, consumer) => {
                self.chain(chain);
                self.consumer(consumer);
            }
            Expression::UnwrapOr(value, default) => {
                self.method(value, "unwrap_or", std::slice::from_ref(&**default));
            }
            Expression::MapOr(value, default, closure) => {
                self.operand(value);
                self.put(".map_or(");
                self.expression(default);
                self.put(", ");
                self.closure(closure);
                self.put(")");
            }
            Expression::Break(label, value) => {
                self.put("break");
                self.to(label);
                if let Some(value) = value {
                    self.put(" ");
                    self.operand(value);
                }
            }
            Expression::Continue(label) => {
                self.put("continue");
                self.to(label);
            }
            Expression::Return(value) => {
                self.put("return ");
                self.expression(value);
            }
            Expression::Assign(place, value) => {
                self.expression(place);
                self.put(" = ");
                self.expression(value);
            }
            Expression::Compound(symbol, _, place, value) => {
                self.expression(place);
                self.put(&format!(" {}= ", operator(*symbol)));
                self.expression(value);
            }
        }
    }

    fn to(&mut self, label: &Option<String>) {
        if let Some(label) = label {
            self.put(&format!(" '{label}"));
        }
    }

    fn otherwise(&mut self, otherwise: &Option<Block>) {
        let Some(otherwise) = otherwise else { return };
        self.put(" else ");
        // `else if`, where the block holds nothing else.
        match otherwise {
            Block { statements, tail: Some(tail) }
                if statements.is_empty() && matches!(**tail, Expression::If(..) | Expression::IfLet(..)) =>
            {
                self.expression(tail);
            }
            block => self.block(block),
        }
    }

    fn consumer(&mut self, consumer: &Consumer) {
        match consumer {
            Consumer::Sum(kind, turbofish) | Consumer::Product(kind, turbofish) => {
                self.put(if matches!(consumer, Consumer::Sum(..)) { ".sum" } else { ".product" });
                if *turbofish {
                    let kind = self.kind(*kind);
                    self.put(&format!("::<{kind}>"));
                }
                self.put("()");
            }
            Consumer::Fold(start, handed) => {
                self.put(".fold(");
                self.expression(start);
                self.put(", ");
                self.handed(handed);
                self.put(")");
            }
            Consumer::Count => self.put(".count()"),
            Consumer::Next => self.put(".next()"),
        }
    }

    fn patterns(&mut self, patterns: &[Pattern], separator: &str) {
        for (index, pattern) in patterns.iter().enumerate() {
            if index > 0 {
                self.put(separator);
            }
            self.pattern(pattern);
        }
    }

    fn pattern(&mut self, pattern: &Pattern) {
        match pattern {
            Pattern::Wild => self.put("_"),
            Pattern::Name { name, mutable } => {
                self.put(if *mutable { "mut " } else { "" });
                self.put(name);
            }
            Pattern::At(name, inner) => {
                self.put(&format!("{name} @ ("));
                self.pattern(inner);
                self.put(")");
            }
            Pattern::Tuple(patterns) => {
                self.put("(");
                for pattern in patterns {
                    self.pattern(pattern);
                    self.put(", ");
                }
                self.put(")");
            }
            Pattern::Slice(before, rest, after) => {
                self.put("[");
                for pattern in before {
                    self.pattern(pattern);
                    self.put(", ");
                }
                match rest {
                    Some(Some(name)) => self.put(&format!("{name} @ .., ")),
                    Some(None) => self.put(".., "),
                    None => {}
                }
                self.patterns(after, ", ");
                self.put("]");
            }
            Pattern::Integer(value) => self.put(&value.to_string()),
            Pattern::Bool(truth) => self.put(&truth.to_string()),
            Pattern::Range(low, high, closed) => {
                if let Some(low) = low {
                    self.put(&low.to_string());
                }
                self.put(if *closed { "..=" } else { ".." });
                if let Some(high) = high {
                    self.put(&high.to_string());
                }
            }
            Pattern::Or(patterns) => {
                self.put("(");
                self.patterns(patterns, " | ");
                self.put(")");
            }
            Pattern::Reference(inner) => {
                self.put("&");
                self.pattern(inner);
            }
            Pattern::Constant(index) => {
                let constant = &self.program.constants[*index];
                let path = if constant.in_block { "Self::" } else { "" };
                self.put(&format!("{path}{}", constant.name));
            }
            Pattern::Optional(None) => self.put("None"),
            Pattern::Optional(Some(inner)) => {
                self.put("Some(");
                self.pattern(inner);
                self.put(")");
            }
            Pattern::Variant { of, variant, data, rest } => {
                let enumeration = &self.program.enumerations[*of];
                self.put(&format!("{}::{}", enumeration.name, enumeration.variants[*variant].0));
                if *rest {
                    self.put("(..)");
                } else if !data.is_empty() {
                    self.put("(");
                    self.patterns(data, ", ");
                    self.put(")");
                }
            }
        }
    }
}
