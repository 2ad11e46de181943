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

/// A number, or an array of them, seen as its numbers in order, row by row.
pub trait Entries {
    /// Number `index`.
    fn entry(&self, index: usize) -> Option<Number>;

    /// Changes number `index`; whether there is one, of the type of `value`.
    fn change_entry(&mut self, index: usize, value: Number) -> bool;
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

        impl Entries for $number {
            fn entry(&self, index: usize) -> Option<Number> {
                (index == 0).then_some(Number::$variant(*self))
            }

            fn change_entry(&mut self, index: usize, value: Number) -> bool {
                let Number::$variant(value) = value else { return false };
                if index == 0 {
                    *self = value;
                }
                index == 0
            }
        }

        impl<const K: usize> Entries for [$number; K] {
            fn entry(&self, index: usize) -> Option<Number> {
                self.get(index)?.entry(0)
            }

            fn change_entry(&mut self, index: usize, value: Number) -> bool {
                self.get_mut(index).is_some_and(|number| number.change_entry(0, value))
            }
        }

        impl<const J: usize, const K: usize> Entries for [[$number; K]; J] {
            fn entry(&self, index: usize) -> Option<Number> {
                self.as_flattened().get(index)?.entry(0)
            }

            fn change_entry(&mut self, index: usize, value: Number) -> bool {
                self.as_flattened_mut().get_mut(index).is_some_and(|number| number.change_entry(0, value))
            }
        }
    )* };
}

numbers! { f64 F64 f32 F32 i8 I8 i16 I16 i32 I32 i64 I64 u8 U8 u16 U16 u32 U32 u64 U64 }
