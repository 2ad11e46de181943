//! The numbers of a field, one by one.

/// A number of one of the types that a field may have.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub enum Number {
    F64(f64),
    F32(f32),
    I8(i8),
    I16(i16),
    I32(i32),
    I64(i64),
    U8(u8),
    U16(u16),
    U32(u32),
    U64(u64),
}

macro_rules! numbers {
    ($($number:ident $variant:ident)*) => { $(
        impl From<$number> for Number {
            fn from(value: $number) -> Self {
                Self::$variant(value)
            }
        }

        /// The number, if it is of this type.
        impl TryFrom<Number> for $number {
            type Error = Number;

            fn try_from(value: Number) -> Result<Self, Number> {
                if let Number::$variant(value) = value { Ok(value) } else { Err(value) }
            }
        }
    )* };
}

numbers! { f64 F64 f32 F32 i8 I8 i16 I16 i32 I32 i64 I64 u8 U8 u16 U16 u32 U32 u64 U64 }
