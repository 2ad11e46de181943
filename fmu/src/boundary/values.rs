//! Getting and setting variables, by type.

use dalembert_c::Number;

use super::{Instance, Status, array, with, write};
use crate::refusal::Refusal;
use crate::variables::type_name;

/// The values of variables, all of type T.
///
/// # Safety
/// The importer's promise.
unsafe fn values<T: Copy + TryFrom<Number, Error = Number>>(
    instance: *mut Instance,
    references: *const u32,
    references_length: usize,
    values: *mut T,
    length: usize,
) -> Status {
    let call = |instance: &mut Instance| {
        // SAFETY: the importer's promise.
        let references = unsafe { array(references, references_length, "valueReferences")? };
        let model = &instance.model;
        let read = || {
            let typed = |(&reference, number): (&u32, Number)| {
                let of_another = |number| Refusal::AnotherType {
                    name: format!("the variable with the value reference {reference}"),
                    kind: type_name(number),
                };
                T::try_from(number).map_err(of_another)
            };
            references.iter().zip(model.values(references)?).map(typed).collect()
        };
        // SAFETY: the importer's promise.
        unsafe { write(values, length, "values", read) }
    };
    // SAFETY: the importer's promise.
    unsafe { with(instance, call) }
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
            unsafe { values(instance, references, references_length, into, length) }
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
