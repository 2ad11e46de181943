//! Getting and setting variables, by type.

use dalembert_face::Number;

use super::{Instance, Status, array, with, write};
use crate::refusal::Refusal;
use crate::variables::type_name;

/// An array of the importer's: its address, its length and what FMI calls it.
pub(super) type Array<P> = (P, usize, &'static str);

/// The values of variables, each as `seen`.
///
/// # Safety
/// The importer's promise.
pub(super) unsafe fn values<T: Copy>(
    instance: *mut Instance,
    (references, number, named): Array<*const u32>,
    (into, length, called): Array<*mut T>,
    seen: impl Fn(Number) -> Option<T>,
) -> Status {
    let call = |instance: &mut Instance| {
        // SAFETY: the importer's promise.
        let references = unsafe { array(references, number, named)? };
        let read = || {
            let numbers = instance.model.values(references)?.into_iter();
            let typed = |(number, &of)| seen(number).ok_or_else(|| of_another_type(of, number));
            numbers.zip(references).map(typed).collect()
        };
        // SAFETY: the importer's promise.
        unsafe { write(into, length, called, read) }
    };
    // SAFETY: the importer's promise.
    unsafe { with(instance, call) }
}

pub(super) fn of_another_type(reference: u32, number: Number) -> Refusal {
    let name = format!("the variable with the value reference {reference}");
    Refusal::AnotherType { name, kind: type_name(number) }
}

/// Sets variables, all of type T.
///
/// # Safety
/// The importer's promise.
unsafe fn set_values<T: Copy + Into<Number>>(
    instance: *mut Instance,
    references: *const u32,
    references_length: usize,
    values: *const T,
    length: usize,
) -> Status {
    let call = |instance: &mut Instance| {
        // SAFETY: the importer's promise.
        let references = unsafe { array(references, references_length, "valueReferences")? };
        // SAFETY: the importer's promise.
        let values: Vec<Number> =
            unsafe { array(values, length, "values")? }.iter().map(|&v| v.into()).collect();
        instance.model.set_values(references, &values)
    };
    // SAFETY: the importer's promise.
    unsafe { with(instance, call) }
}

macro_rules! types {
    ($($of:ty: $get:ident $set:ident;)*) => { $(
        #[doc = concat!("Gets variables of the type ", stringify!($of), ".")]
        ///
        /// # Safety
        /// The importer's promise.
        #[unsafe(no_mangle)]
        #[allow(non_snake_case)]
        pub unsafe extern "C" fn $get(
            instance: *mut Instance,
            references: *const u32,
            references_length: usize,
            into: *mut $of,
            length: usize,
        ) -> Status {
            // SAFETY: the importer's promise.
            unsafe {
                let references = (references, references_length, "valueReferences");
                values(instance, references, (into, length, "values"), |number| <$of>::try_from(number).ok())
            }
        }

        #[doc = concat!("Sets variables of the type ", stringify!($of), ".")]
        ///
        /// # Safety
        /// The importer's promise.
        #[unsafe(no_mangle)]
        #[allow(non_snake_case)]
        pub unsafe extern "C" fn $set(
            instance: *mut Instance,
            references: *const u32,
            references_length: usize,
            from: *const $of,
            length: usize,
        ) -> Status {
            // SAFETY: the importer's promise.
            unsafe { set_values(instance, references, references_length, from, length) }
        }
    )* };
}

types! {
    f64: fmi3GetFloat64 fmi3SetFloat64;
    f32: fmi3GetFloat32 fmi3SetFloat32;
    i8: fmi3GetInt8 fmi3SetInt8;
    i16: fmi3GetInt16 fmi3SetInt16;
    i32: fmi3GetInt32 fmi3SetInt32;
    i64: fmi3GetInt64 fmi3SetInt64;
    u8: fmi3GetUInt8 fmi3SetUInt8;
    u16: fmi3GetUInt16 fmi3SetUInt16;
    u32: fmi3GetUInt32 fmi3SetUInt32;
    u64: fmi3GetUInt64 fmi3SetUInt64;
}
