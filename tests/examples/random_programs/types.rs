//! Types of the generated programs.

/// A primitive integer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Integer {
    pub bits: u32,
    pub signed: bool,
    /// `usize` and `isize`, of 64 bits on the machines that this study runs on.
    pub size: bool,
}

impl Integer {
    pub const USIZE: Self = Self { bits: 64, signed: false, size: true };
    pub const I32: Self = Self { bits: 32, signed: true, size: false };
    pub const U32: Self = Self { bits: 32, signed: false, size: false };

    /// All twelve.
    pub const ALL: [Self; 12] = [
        Self { bits: 8, signed: true, size: false },
        Self { bits: 16, signed: true, size: false },
        Self { bits: 32, signed: true, size: false },
        Self { bits: 64, signed: true, size: false },
        Self { bits: 128, signed: true, size: false },
        Self { bits: 64, signed: true, size: true },
        Self { bits: 8, signed: false, size: false },
        Self { bits: 16, signed: false, size: false },
        Self { bits: 32, signed: false, size: false },
        Self { bits: 64, signed: false, size: false },
        Self { bits: 128, signed: false, size: false },
        Self { bits: 64, signed: false, size: true },
    ];

    pub fn name(self) -> String {
        let sign = if self.signed { 'i' } else { 'u' };
        if self.size { format!("{sign}size") } else { format!("{sign}{}", self.bits) }
    }

    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|integer| integer.name() == name)
    }

    /// The smallest value.
    pub fn least(self) -> i128 {
        match (self.signed, self.bits) {
            (false, _) => 0,
            (true, 128) => i128::MIN,
            (true, bits) => -(1 << (bits - 1)),
        }
    }

    /// The largest value; of `u128` what an `i128` can hold: programs that go beyond are not tried.
    pub fn greatest(self) -> i128 {
        match (self.signed, self.bits) {
            (_, 128) => i128::MAX,
            (true, bits) => (1 << (bits - 1)) - 1,
            (false, bits) => (1 << bits) - 1,
        }
    }

    pub fn holds(self, value: i128) -> bool {
        self.least() <= value && value <= self.greatest()
    }

    /// The low bits, as `as` and the wrapping methods leave them; nothing where an `i128` cannot hold them.
    pub fn wrapped(self, value: i128) -> Option<i128> {
        match (self.signed, self.bits) {
            (true, 128) => Some(value),
            (false, 128) => (value >= 0).then_some(value),
            (signed, bits) => {
                let low = value & ((1 << bits) - 1);
                Some(if signed && low > self.greatest() { low - (1 << bits) } else { low })
            }
        }
    }
}

/// A type of a local, a field, a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Type {
    /// The system's floating-point number.
    Real,
    /// `f32` in a system of `f64`.
    Single,
    Bool,
    Integer(Integer),
    Array(Box<Type>, usize),
    Tuple(Vec<Type>),
    Option(Box<Type>),
    /// An enum or struct of the module, by its index.
    Enum(usize),
    Struct(usize),
    /// `&T`.
    Reference(Box<Type>),
    /// A slice with at least so many entries, behind a reference.
    Slice(Box<Type>, usize),
}

impl Type {
    pub const UNIT: Self = Self::Tuple(Vec::new());

    /// Whether a value of it is copied on use.
    pub fn is_scalar(&self) -> bool {
        matches!(self, Self::Real | Self::Single | Self::Bool | Self::Integer(_))
    }
}

/// An enum of the module: its name, and variants with the types of their data.
#[derive(Clone, Debug, PartialEq)]
pub struct Enumeration {
    pub name: String,
    pub variants: Vec<(String, Vec<Type>)>,
}

/// A struct of the module.
#[derive(Clone, Debug, PartialEq)]
pub struct Structure {
    pub name: String,
    pub fields: Vec<(String, Type)>,
}
