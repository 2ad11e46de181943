//! The struct of a system's fields, the same in Rust and in other languages.

use core::ffi::CStr;
use core::fmt;

use crate::number::Number;
use crate::wrong_points::{PointsError, WrongPoints};

pub(crate) mod sealed {
    /// The types that are listed here, and no others: those that C reads as they are.
    pub trait Listed: Copy + 'static {}
}

/// A type that a field may have in both languages.
#[diagnostic::on_unimplemented(
    message = "C and Rust do not share the type `{Self}`",
    label = "no field of C's",
    note = "a field is a number, `f64`, `f32`, `i8` … `i64`, `u8` … `u64`, an array of them, of one or two dimensions, or a `Table<K>`"
)]
pub trait FieldType: sealed::Listed {
    /// The type that other languages give in its place: itself, or [`Points`](crate::Points) of a table.
    type Given: FieldType<Given = Self::Given>;
    /// The type before the name of a field in C, or that of a table's numbers.
    const BASE: &'static str;
    /// The dimensions behind the name: `[2][3]`, or nothing; of a table `[2][K]`, the x and the y.
    const DIMENSIONS: &'static [usize];
    /// Whether it is a table.
    const IS_TABLE: bool = false;

    /// 0, or as many as there are; of a table the one that is 0.
    const ZERO: Self;

    /// What other languages would give for this value.
    fn given(&self) -> Self::Given;

    /// The value that is given.
    ///
    /// # Errors
    /// A [`PointsError`], of a table alone.
    fn of(given: &Self::Given) -> Result<Self, PointsError>;

    /// Whether it is NaN, or has a NaN in it.
    fn has_nan(&self) -> bool;

    /// Its number `index`, row by row.
    fn entry(&self, index: usize) -> Option<Number>;

    /// Changes number `index`; whether there is one, of the type of `value`.
    fn change_entry(&mut self, index: usize, value: Number) -> bool;
}

/// What is given is the value itself.
macro_rules! as_it_is {
    () => {
        type Given = Self;

        fn given(&self) -> Self {
            *self
        }

        fn of(given: &Self) -> Result<Self, PointsError> {
            Ok(*given)
        }
    };
}

macro_rules! numbers {
    ($($number:ty, $c:literal, |$value:ident| $nan:expr;)*) => { $(
        impl sealed::Listed for $number {}
        impl<const K: usize> sealed::Listed for [$number; K] {}
        impl<const J: usize, const K: usize> sealed::Listed for [[$number; K]; J] {}

        impl FieldType for $number {
            as_it_is!();
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

        impl<const K: usize> FieldType for [$number; K] {
            as_it_is!();
            const BASE: &'static str = $c;
            const DIMENSIONS: &'static [usize] = &[K];
            const ZERO: Self = [0 as $number; K];

            fn has_nan(&self) -> bool {
                self.iter().any(FieldType::has_nan)
            }

            fn entry(&self, index: usize) -> Option<Number> {
                self.get(index)?.entry(0)
            }

            fn change_entry(&mut self, index: usize, value: Number) -> bool {
                self.get_mut(index).is_some_and(|number| number.change_entry(0, value))
            }
        }

        impl<const J: usize, const K: usize> FieldType for [[$number; K]; J] {
            as_it_is!();
            const BASE: &'static str = $c;
            const DIMENSIONS: &'static [usize] = &[J, K];
            const ZERO: Self = [[0 as $number; K]; J];

            fn has_nan(&self) -> bool {
                self.iter().any(FieldType::has_nan)
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
    /// Its name, as C reads it.
    pub name_for_c: &'static CStr,
    /// Its documentation, a line each.
    pub documentation: &'static [&'static str],
    /// The type before the name in C.
    pub base: &'static str,
    /// The lengths of the arrays behind it; of a table 2, for x and y, and the number of points.
    pub dimensions: &'static [usize],
    /// Whether it is a table.
    pub is_table: bool,
    /// Bytes before it.
    pub offset: usize,
}

/// A system that knows its fields by name and number: a struct that [`fields!`](crate::fields) declares, for
/// whoever fills them in.
#[diagnostic::on_unimplemented(
    message = "the fields of `{Self}` are not known in other languages",
    label = "declared outside `parameters!`",
    note = "declare the struct within `parameters! {{ pub struct {Self} {{ … }} }}`"
)]
pub trait Fields: Copy + 'static {
    /// The struct that other languages fill in, laid out as C does: the fields as they are, and
    /// [`Points`](crate::Points) in place of tables.
    type Given: Fields<Given = Self::Given>;
    /// The documentation of the struct, a line each.
    const DOCUMENTATION: &'static [&'static str];
    /// Its fields, in order.
    const FIELDS: &'static [Field];
    /// The system all of whose fields are 0.
    const ZERO: Self;

    /// What other languages would give for this system.
    fn given(&self) -> Self::Given;

    /// The system that is given.
    ///
    /// # Errors
    /// [`WrongPoints`]: the first table whose points make none.
    fn of(given: &Self::Given) -> Result<Self, WrongPoints>;

    /// Whether a field is NaN, or has a NaN in it.
    fn has_nan(&self) -> bool;

    /// Number `index` of field `field`, arrays row by row.
    fn entry(&self, field: usize, index: usize) -> Option<Number>;

    /// Changes number `index` of field `field`; whether there is one of this type. Points of a table change
    /// in what is [given](Self::given) alone.
    fn change_entry(&mut self, field: usize, index: usize, value: Number) -> bool;

    /// This system with other numbers of field `field`, from its first on.
    ///
    /// # Errors
    /// [`WrongPoints`], of a table alone.
    fn with_field(&self, field: usize, numbers: &[Number]) -> Result<Self, WrongPoints> {
        let mut given = self.given();
        for (index, number) in numbers.iter().enumerate() {
            given.change_entry(field, index, *number);
        }
        Self::of(&given)
    }
}

/// Declares the struct of a system, with its fields by name and number, and the struct that is filled in for
/// it, laid out as C does.
///
/// Fields are numbers (`f64`, `f32`, `i8` … `u64`), arrays of them, of one or two dimensions, or
/// [`Table`](dalembert::system::Table)s.
#[macro_export]
macro_rules! fields {
    (
        $(@plain $plain:path;)?
        $(#[doc = $doc:expr])*
        $vis:vis struct $name:ident { $($(#[doc = $field_doc:expr])* pub $field:ident: $kind:ty),* $(,)? }
    ) => {
        $(#[doc = $doc])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[repr(C)]
        $vis struct $name {
            $($(#[doc = $field_doc])* pub $field: $kind,)*
        }

        #[allow(non_camel_case_types, trivial_bounds)]
        const _: () = {
            /// Filled in by other languages.
            #[derive(Clone, Copy, Debug, PartialEq)]
            #[repr(C)]
            pub struct Given<$($field),*> {
                $(pub $field: $field,)*
            }

            impl<$($field: $crate::FieldType<Given = $field>),*> $crate::Fields for Given<$($field),*> {
                type Given = Self;
                const DOCUMENTATION: &'static [&'static str] = &[$($doc),*];
                const FIELDS: &'static [$crate::Field] = &[$($crate::Field {
                    name: stringify!($field),
                    name_for_c: match core::ffi::CStr::from_bytes_with_nul(concat!(stringify!($field), "\0").as_bytes()) {
                        Ok(name) => name,
                        Err(_) => unreachable!(),
                    },
                    documentation: &[$($field_doc),*],
                    base: <$field as $crate::FieldType>::BASE,
                    dimensions: <$field as $crate::FieldType>::DIMENSIONS,
                    is_table: <$field as $crate::FieldType>::IS_TABLE,
                    offset: core::mem::offset_of!(Self, $field),
                }),*];
                $crate::fields! { @implemented $($field: $field;)* }
            }

            $crate::fields! { @is_plain [$($plain)?] $($field)* }

            // With the bounds a wrong type is said of the whole, not of each use.
            impl $crate::Fields for $name
            where
                $($kind: $crate::FieldType),*
            {
                type Given = Given<$(<$kind as $crate::FieldType>::Given),*>;
                const DOCUMENTATION: &'static [&'static str] = &[$($doc),*];
                const FIELDS: &'static [$crate::Field] = <Self::Given as $crate::Fields>::FIELDS;
                $crate::fields! { @implemented $($field: $kind;)* }
            }
        };
    };
    (@is_plain [] $($field:ident)*) => {};
    // Of the struct by its name: what another crate says of its own types is known to be none of it.
    (@is_plain [$plain:path] $($field:ident)*) => {
        // SAFETY: repr(C), and each field is what a FieldType is given as; bytes between fields are not read.
        #[allow(unsafe_code)]
        unsafe impl<$($field: $crate::FieldType<Given = $field>),*> $plain for Given<$($field),*> {}
    };
    (@implemented $($field:ident: $kind:ty;)*) => {
        const ZERO: Self = Self { $($field: <$kind as $crate::FieldType>::ZERO,)* };

        fn given(&self) -> Self::Given {
            Given { $($field: <$kind as $crate::FieldType>::given(&self.$field),)* }
        }

        fn of(given: &Self::Given) -> Result<Self, $crate::WrongPoints> {
            Ok(Self { $(
                $field: match <$kind as $crate::FieldType>::of(&given.$field) {
                    Ok(field) => field,
                    Err(error) => {
                        let name = stringify!($field);
                        let field = Self::FIELDS.iter().position(|field| field.name == name).unwrap_or(0);
                        return Err($crate::WrongPoints { field, name, error });
                    }
                },
            )* })
        }

        fn has_nan(&self) -> bool {
            false $(|| <$kind as $crate::FieldType>::has_nan(&self.$field))*
        }

        fn entry(&self, field: usize, index: usize) -> Option<$crate::Number> {
            let name = Self::FIELDS.get(field)?.name;
            None $(.or_else(|| if name == stringify!($field) { <$kind as $crate::FieldType>::entry(&self.$field, index) } else { None }))*
        }

        fn change_entry(&mut self, field: usize, index: usize, value: $crate::Number) -> bool {
            let name = Self::FIELDS.get(field).map(|field| field.name);
            false $(|| name == Some(stringify!($field)) && <$kind as $crate::FieldType>::change_entry(&mut self.$field, index, value))*
        }
    };
}

impl fmt::Display for Field {
    /// As C declares it: `double c[2]`; of a table its points, `double drag[2][8]`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.base, self.name)?;
        self.dimensions.iter().try_for_each(|length| write!(f, "[{length}]"))
    }
}
