//! Programs as trees: what the generator builds, the interpreter runs, the printer writes and the shrinker
//! cuts.

use std::collections::BTreeSet;

use super::class::Class;
use super::types::{Enumeration, Integer, Structure, Type};

/// A scalar type, which decides what an operator does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    Real,
    Single,
    Bool,
    Integer(Integer),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    Add,
    Subtract,
    Multiply,
    Divide,
    Remainder,
    And,
    Or,
    Xor,
    ShiftLeft,
    ShiftRight,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    Equal,
    NotEqual,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Member {
    Named(String, usize),
    Numbered(usize),
}

type Boxed = Box<Expression>;

#[derive(Clone, Debug, PartialEq)]
pub enum Expression {
    /// A literal; without a suffix where another operand gives it its type.
    Real {
        value: f64,
        suffixed: bool,
    },
    /// `1.1_f32`.
    Single(f32),
    Integer {
        value: i128,
        ty: Integer,
        suffixed: bool,
    },
    Bool(bool),
    Name(String),
    System,
    Member(Boxed, Member),
    Index(Boxed, Boxed),
    /// A constant of the program, by its index.
    Constant(usize),
    Dereferenced(Boxed),
    Borrowed(Boxed),
    Negated(Kind, Boxed),
    Not(Kind, Boxed),
    Arithmetic(Operator, Kind, Boxed, Boxed),
    Comparison(Relation, Kind, Boxed, Boxed),
    /// `&&`, `||`.
    Both(Boxed, Boxed),
    Either(Boxed, Boxed),
    /// A method of a real number, or the function `f64::name`.
    Function {
        name: &'static str,
        arguments: Vec<Expression>,
        as_path: bool,
    },
    /// `x.powi(n)`.
    Power(Boxed, Boxed),
    /// A method of an integer.
    IntegerMethod {
        name: &'static str,
        ty: Integer,
        arguments: Vec<Expression>,
        as_path: bool,
    },
    Cast {
        value: Boxed,
        from: Kind,
        to: Kind,
    },
    /// `f64::from(n)`.
    Converted {
        value: Boxed,
        from: Kind,
    },
    Array(Vec<Expression>),
    Repeated(Boxed, usize),
    Tuple(Vec<Expression>),
    /// `None`, `Some(x)`.
    Optional(Option<Boxed>),
    Variant {
        of: usize,
        variant: usize,
        data: Vec<Expression>,
    },
    Structure {
        of: usize,
        values: Vec<Expression>,
    },
    Call {
        helper: usize,
        arguments: Vec<Expression>,
    },
    /// A closure in a local.
    Apply(String, Vec<Expression>),
    Block(Option<String>, Block),
    If(Boxed, Block, Option<Block>),
    IfLet(Pattern, Boxed, Block, Option<Block>),
    Match(Boxed, Vec<Arm>),
    Matches(Boxed, Pattern, Option<Boxed>),
    Loop(Option<String>, Block),
    /// `array.map(|x| …)`.
    Mapped(Boxed, Box<Closure>),
    /// `std::array::from_fn(|i| …)`.
    FromFunction(Box<Closure>, usize),
    Chain(Box<Chain>, Consumer),
    /// `option.map(|x| …)`, `.unwrap_or(x)`, `.map_or(x, |y| …)`.
    OptionMap(Boxed, Box<Closure>),
    UnwrapOr(Boxed, Boxed),
    MapOr(Boxed, Boxed, Box<Closure>),
    Break(Option<String>, Option<Boxed>),
    Continue(Option<String>),
    Return(Boxed),
    Assign(Boxed, Boxed),
    Compound(Operator, Kind, Boxed, Boxed),
}

/// Parameters, and an expression.
#[derive(Clone, Debug, PartialEq)]
pub struct Closure {
    pub parameters: Vec<(Pattern, Option<Type>)>,
    pub body: Expression,
    pub moves: bool,
}

/// What a closure argument is written as.
#[derive(Clone, Debug, PartialEq)]
pub enum Handed {
    Closure(Box<Closure>),
    /// `f64::sin`.
    Method(&'static str),
    /// `Self::square`.
    Helper(usize),
}

#[derive(Clone, Debug, PartialEq)]
pub struct Chain {
    pub source: Source,
    pub adaptors: Vec<Adaptor>,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// `.iter()`.
    Iter(Expression),
    /// `.into_iter()`.
    IntoIter(Expression),
    Range {
        start: Expression,
        end: Expression,
        closed: bool,
    },
    Windows(Expression, usize),
    Chunks(Expression, usize, bool),
    /// An iterator in a local, moved.
    Local(String),
    /// `name.by_ref()`.
    ByReference(String),
    /// `&array`, `array` in a `for`.
    Plain(Expression),
}

#[derive(Clone, Debug, PartialEq)]
pub enum Adaptor {
    Map(Handed),
    Filter(Handed),
    FlatMap(Handed),
    Zip(Box<Chain>, bool),
    Linked(Box<Chain>),
    Enumerate,
    Reversed,
    Skip(usize),
    Take(usize),
    StepBy(usize),
    Copied,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Consumer {
    Sum(Kind, bool),
    Product(Kind, bool),
    Fold(Box<Expression>, Handed),
    Count,
    Next,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Arm {
    pub pattern: Pattern,
    pub guard: Option<Expression>,
    pub body: Expression,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Pattern {
    Wild,
    Name {
        name: String,
        mutable: bool,
    },
    At(String, Box<Pattern>),
    Tuple(Vec<Pattern>),
    /// Entries before the rest, the rest (perhaps named), entries after it.
    Slice(Vec<Pattern>, Option<Option<String>>, Vec<Pattern>),
    Integer(i128),
    Bool(bool),
    Range(Option<i128>, Option<i128>, bool),
    Or(Vec<Pattern>),
    Reference(Box<Pattern>),
    Constant(usize),
    Optional(Option<Box<Pattern>>),
    Variant {
        of: usize,
        variant: usize,
        data: Vec<Pattern>,
        rest: bool,
    },
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Block {
    pub statements: Vec<Statement>,
    pub tail: Option<Box<Expression>>,
}

#[derive(Clone, Debug, PartialEq)]
pub enum Statement {
    Let {
        pattern: Pattern,
        ty: Option<Type>,
        value: Option<Expression>,
    },
    LetElse {
        pattern: Pattern,
        value: Expression,
        otherwise: Block,
    },
    LetClosure {
        name: String,
        mutable: bool,
        closure: Closure,
    },
    LetIterator {
        name: String,
        chain: Chain,
    },
    Expression(Expression),
    For {
        label: Option<String>,
        pattern: Pattern,
        chain: Chain,
        body: Block,
    },
    While {
        label: Option<String>,
        condition: Expression,
        body: Block,
    },
    /// `#[cfg(any())]` before a statement, which is then none.
    ConfiguredOut(Box<Statement>),
}

#[derive(Clone, Debug, PartialEq)]
pub struct Helper {
    pub name: String,
    pub with_self: bool,
    pub parameters: Vec<(String, bool, Type)>,
    pub result: Type,
    pub body: Block,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Constant {
    pub name: String,
    pub ty: Type,
    pub value: Expression,
    pub in_block: bool,
}

/// A system, with the values of its fields.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    pub seed: u64,
    pub single: bool,
    pub n: usize,
    pub enumerations: Vec<Enumeration>,
    pub structures: Vec<Structure>,
    pub constants: Vec<Constant>,
    /// The fields of the system, with their values.
    pub fields: Vec<(String, Type, Expression)>,
    pub helpers: Vec<Helper>,
    pub lagrangian: Block,
    /// Whether R takes q as well.
    pub rayleigh: Option<(bool, Block)>,
    pub force: Option<Block>,
    /// Entries of the input that f takes; 0 where it takes none.
    pub inputs: usize,
    /// Whether L, R and f take the time.
    pub timed: [bool; 3],
    /// What occurs in it.
    pub classes: BTreeSet<Class>,
    /// Holds an attribute `cfg`, so that it must be refused.
    pub has_cfg: bool,
}

impl Program {
    /// The expression that holds the input and the time, where there are any.
    pub fn view(&self) -> Option<&'static str> {
        view(self.inputs > 0, self.timed.contains(&true))
    }
}

/// The call that makes the view of a system with the input `u` and the time `t`, where it takes them.
pub fn view(is_driven: bool, is_timed: bool) -> Option<&'static str> {
    match (is_driven, is_timed) {
        (true, true) => Some("driven(u, t)"),
        (true, false) => Some("driven(u)"),
        (false, true) => Some("at_time(t)"),
        (false, false) => None,
    }
}
