//! The struct of a system's parameters, the same in Rust and in C.

use core::fmt;

use crate::Number;
use crate::boundary::Plain;

/// A type that a field may have in both languages.
#[diagnostic::on_unimplemented(
    message = "C and Rust do not share the type `{Self}`",
    label = "no field of C's",
    note = "a field is a number, `f64`, `f32`, `i8` … `i64`, `u8` … `u64`, or an array of them, of one or two dimensions"
)]
pub trait CType: Plain {
    /// The type before the name of a field in C.
    const BASE: &'static str;
    /// The dimensions behind the name: `[2][3]`, or nothing.
    const DIMENSIONS: &'static [usize];

    /// 0, or as many as there are.
    const ZERO: Self;

    /// Whether it is NaN, or has a NaN in it.
    fn has_nan(&self) -> bool;

    /// Its number `index`, row by row.
    fn entry(&self, index: usize) -> Option<Number>;

    /// Changes number `index`; whether there is one, of the type of `value`.
    fn change_entry(&mut self, index: usize, value: Number) -> bool;
}

macro_rules! numbers {
    ($($number:ty, $c:literal, |$value:ident| $nan:expr;)*) => { $(
        impl CType for $number {
            const BASE: &'static str = $c;
            const DIMENSIONS: &'static [usize] = &[];
            const ZERO: Self = 0 as $number;

            fn has_nan(&self) -> bool {
                let $value = *self;
                $nan
            }

            fn entry(&self, index: usize) -> Option<Number> {
                (index == 0).then_some((*self).into())
            }

            fn change_entry(&mut self, index: usize, value: Number) -> bool {
                match (index, value.try_into()) {
                    (0, Ok(value)) => *self = value,
                    _ => return false,
                }
                true
            }
        }

        impl<const K: usize> CType for [$number; K] {
            const BASE: &'static str = $c;
            const DIMENSIONS: &'static [usize] = &[K];
            const ZERO: Self = [0 as $number; K];

            fn has_nan(&self) -> bool {
                self.iter().any(CType::has_nan)
            }

            fn entry(&self, index: usize) -> Option<Number> {
                self.get(index)?.entry(0)
            }

            fn change_entry(&mut self, index: usize, value: Number) -> bool {
                self.get_mut(index).is_some_and(|number| number.change_entry(0, value))
            }
        }

        impl<const J: usize, const K: usize> CType for [[$number; K]; J] {
            const BASE: &'static str = $c;
            const DIMENSIONS: &'static [usize] = &[J, K];
            const ZERO: Self = [[0 as $number; K]; J];

            fn has_nan(&self) -> bool {
                self.iter().any(CType::has_nan)
            }

            fn entry(&self, index: usize) -> Option<Number> {
                self.as_flattened().get(index)?.entry(0)
            }

            fn change_entry(&mut self, index: usize, value: Number) -> bool {
                self.as_flattened_mut().get_mut(index).is_some_and(|number| number.change_entry(0, value))
            }
        }
    )* };
}

numbers! {
    f64, "double", |value| value.is_nan();
    f32, "float", |value| value.is_nan();
    i8, "int8_t", |_value| false;
    i16, "int16_t", |_value| false;
    i32, "int32_t", |_value| false;
    i64, "int64_t", |_value| false;
    u8, "uint8_t", |_value| false;
    u16, "uint16_t", |_value| false;
    u32, "uint32_t", |_value| false;
    u64, "uint64_t", |_value| false;
}

/// One field, as the header declares it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// Its name.
    pub name: &'static str,
    /// Its documentation, a line each.
    pub documentation: &'static [&'static str],
    /// The type before the name in C.
    pub base: &'static str,
    /// The lengths of the arrays behind it.
    pub dimensions: &'static [usize],
    /// Bytes before it.
    pub offset: usize,
}

/// A system that knows its fields by name and number: a struct that [`fields!`](crate::fields) declares, for
/// whoever fills them in.
pub trait Fields: Copy + 'static {
    /// The documentation of the struct, a line each.
    const DOCUMENTATION: &'static [&'static str];
    /// Its fields, in order.
    const FIELDS: &'static [Field];
    /// The system all of whose fields are 0.
    const ZERO: Self;

    /// Whether a field is NaN, or has a NaN in it.
    fn has_nan(&self) -> bool;

    /// Number `index` of field `field`, arrays row by row.
    fn entry(&self, field: usize, index: usize) -> Option<Number>;

    /// Changes number `index` of field `field`; whether there is one of this type.
    fn change_entry(&mut self, field: usize, index: usize, value: Number) -> bool;
}

/// A system whose fields C can fill in: a struct that [`parameters!`](crate::parameters) declares.
#[diagnostic::on_unimplemented(
    message = "C does not know the fields of `{Self}`",
    note = "declare the struct in `dalembert_c::parameters! {{ … }}`"
)]
pub trait CParameters: Fields + Plain {}

impl<P: Fields + Plain> CParameters for P {}

/// Declares the struct of a system whose fields C is to fill in, and lays it out as C does.
///
/// Fields are numbers (`f64`, `f32`, `i8` … `u64`) or arrays of them, of one or two dimensions; their
/// documentation goes into the header. There is at least one, as C has no empty struct.
///
/// ```
/// dalembert_c::parameters! {
///     /// A pole hinged on a cart.
///     pub struct CartPole {
///         /// Mass of the cart in kg.
///         pub cart: f64,
///         /// Friction of the cart in N s/m, and of the hinge in N m s.
///         pub friction: [f64; 2],
///     }
/// }
/// ```
#[macro_export]
macro_rules! parameters {
    (
        $(#[doc = $doc:expr])*
        $vis:vis struct $name:ident { $($(#[doc = $field_doc:expr])* pub $field:ident: $kind:ty),+ $(,)? }
    ) => {
        $crate::fields! {
            $(#[doc = $doc])*
            $vis struct $name { $($(#[doc = $field_doc])* pub $field: $kind),+ }
        }

        // SAFETY: repr(C), and each field is a CType, so Plain; bytes between fields are not read.
        #[allow(unsafe_code)]
        unsafe impl $crate::boundary::Plain for $name {}
    };
}

/// Declares the struct of a system as [`parameters!`](crate::parameters) does, for languages that fill it in
/// by name: with no word about its bytes, and maybe without a field.
#[macro_export]
macro_rules! fields {
    (
        $(#[doc = $doc:expr])*
        $vis:vis struct $name:ident { $($(#[doc = $field_doc:expr])* pub $field:ident: $kind:ty),* $(,)? }
    ) => {
        $(#[doc = $doc])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[repr(C)]
        $vis struct $name {
            $($(#[doc = $field_doc])* pub $field: $kind,)*
        }

        impl $crate::Fields for $name {
            const DOCUMENTATION: &'static [&'static str] = &[$($doc),*];
            const FIELDS: &'static [$crate::Field] = &[$($crate::Field {
                name: stringify!($field),
                documentation: &[$($field_doc),*],
                base: <$kind as $crate::CType>::BASE,
                dimensions: <$kind as $crate::CType>::DIMENSIONS,
                offset: core::mem::offset_of!($name, $field),
            }),*];
            const ZERO: Self = Self { $($field: <$kind as $crate::CType>::ZERO,)* };

            fn has_nan(&self) -> bool {
                false $(|| <$kind as $crate::CType>::has_nan(&self.$field))*
            }

            fn entry(&self, field: usize, index: usize) -> Option<$crate::Number> {
                let name = Self::FIELDS.get(field)?.name;
                None $(.or_else(|| if name == stringify!($field) { <$kind as $crate::CType>::entry(&self.$field, index) } else { None }))*
            }

            fn change_entry(&mut self, field: usize, index: usize, value: $crate::Number) -> bool {
                let name = Self::FIELDS.get(field).map(|field| field.name);
                false $(|| name == Some(stringify!($field)) && <$kind as $crate::CType>::change_entry(&mut self.$field, index, value))*
            }
        }
    };
}

impl fmt::Display for Field {
    /// As C declares it: `double c[2]`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.base, self.name)?;
        self.dimensions.iter().try_for_each(|length| write!(f, "[{length}]"))
    }
}

/// A number that stands for the layout of memory and parameters: FNV-1a over names, types and offsets, the
/// method and the version of the library. Header and library of different builds differ in it.
#[must_use]
pub const fn layout(fields: &[Field], words: &[&str], sizes: &[usize]) -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325;
    let mut i = 0;
    while i < fields.len() {
        let Field { name, base, dimensions, offset, .. } = fields[i];
        hash = with_number(with_text(with_text(hash, name), base), offset);
        hash = with_numbers(hash, dimensions);
        i += 1;
    }
    let mut i = 0;
    while i < words.len() {
        hash = with_text(hash, words[i]);
        i += 1;
    }
    with_numbers(with_text(hash, env!("CARGO_PKG_VERSION")), sizes)
}

const fn with_text(mut hash: u64, text: &str) -> u64 {
    let bytes = text.as_bytes();
    let mut i = 0;
    while i < bytes.len() {
        hash = (hash ^ bytes[i] as u64).wrapping_mul(0x100_0000_01b3);
        i += 1;
    }
    // A byte that no text has: ("ab", "c") is not ("a", "bc").
    (hash ^ 0xff).wrapping_mul(0x100_0000_01b3)
}

const fn with_number(hash: u64, number: usize) -> u64 {
    (hash ^ number as u64).wrapping_mul(0x100_0000_01b3)
}

const fn with_numbers(mut hash: u64, numbers: &[usize]) -> u64 {
    let mut i = 0;
    while i < numbers.len() {
        hash = with_number(hash, numbers[i]);
        i += 1;
    }
    with_number(hash, numbers.len())
}
