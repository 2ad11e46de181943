//! The functions of FMI 2.0, co-simulation, over the same instances.
//!
//! In all of them the importer promises what FMI asks, as said in [`boundary`](super). Real variables are
//! those of `f64` and `f32`, Integer ones those of the integers that fit.

#![allow(non_snake_case, clippy::missing_safety_doc, clippy::too_many_arguments)]

use core::ffi::{c_char, c_void};

use dalembert_face::Number;

use super::functions::{self, Saved};
use super::values::{of_another_type, values};
use super::{Instance, Status, array, with, write};
use crate::refusal::Refusal;

/// `fmi2CallbackLogger`: the message is a format for the arguments behind it.
pub type LogMessage2 =
    unsafe extern "C" fn(*mut c_void, *const c_char, Status, *const c_char, *const c_char, ...);

/// `fmi2CallbackFunctions`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Callbacks {
    /// The log.
    pub log: Option<LogMessage2>,
    /// Not used: Rust has an allocator.
    pub allocate: Option<unsafe extern "C" fn()>,
    /// Not used.
    pub free: Option<unsafe extern "C" fn()>,
    /// Not used: steps are finished when the call returns.
    pub step_finished: Option<unsafe extern "C" fn()>,
    /// The first argument of the log.
    pub environment: *mut c_void,
}

#[unsafe(no_mangle)]
#[doc = "The sizes of types."]
pub extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

#[unsafe(no_mangle)]
#[doc = "The version of FMI."]
pub extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

macro_rules! same {
    ($($name:ident($($argument:ident: $of:ty),*) = $other:ident($($given:expr),*);)*) => { $(
        #[unsafe(no_mangle)]
        #[doc = concat!("As `", stringify!($other), "`.")]
        pub unsafe extern "C" fn $name(instance: *mut Instance, $($argument: $of),*) -> Status {
            // SAFETY: the same promise.
            unsafe { functions::$other(instance, $($given),*) }
        }
    )* };
}

same! {
    fmi2SetDebugLogging(on: i32, length: usize, categories: *const *const c_char)
        = fmi3SetDebugLogging(on != 0, length, categories);
    fmi2ExitInitializationMode() = fmi3ExitInitializationMode();
    fmi2Terminate() = fmi3Terminate();
    fmi2Reset() = fmi3Reset();
    fmi2GetFMUstate(into: *mut *mut Saved) = fmi3GetFMUState(into);
    fmi2SetFMUstate(saved: *const Saved) = fmi3SetFMUState(saved);
    fmi2FreeFMUstate(saved: *mut *mut Saved) = fmi3FreeFMUState(saved);
    fmi2SerializedFMUstateSize(saved: *const Saved, size: *mut usize) = fmi3SerializedFMUStateSize(saved, size);
    fmi2SerializeFMUstate(saved: *const Saved, bytes: *mut u8, size: usize)
        = fmi3SerializeFMUState(saved, bytes, size);
    fmi2DeSerializeFMUstate(bytes: *const u8, size: usize, into: *mut *mut Saved)
        = fmi3DeserializeFMUState(bytes, size, into);
    fmi2GetDirectionalDerivative(
        unknowns: *const u32,
        unknowns_length: usize,
        knowns: *const u32,
        knowns_length: usize,
        seed: *const f64,
        sensitivity: *mut f64
    ) = fmi3GetDirectionalDerivative(
        unknowns, unknowns_length, knowns, knowns_length, seed, knowns_length, sensitivity, unknowns_length
    );
}

#[unsafe(no_mangle)]
#[doc = "Frees an instance."]
pub unsafe extern "C" fn fmi2FreeInstance(instance: *mut Instance) {
    // SAFETY: the same promise.
    unsafe { functions::fmi3FreeInstance(instance) }
}

#[unsafe(no_mangle)]
#[doc = "Says when the run begins."]
pub unsafe extern "C" fn fmi2SetupExperiment(
    instance: *mut Instance,
    _tolerance_defined: i32,
    _tolerance: f64,
    start_time: f64,
    _stop_time_defined: i32,
    _stop_time: f64,
) -> Status {
    let call = |instance: &mut Instance| {
        instance.start_time = start_time;
        Ok(())
    };
    // SAFETY: the importer's promise.
    unsafe { with(instance, call) }
}

#[unsafe(no_mangle)]
#[doc = "Into initialization mode."]
pub unsafe extern "C" fn fmi2EnterInitializationMode(instance: *mut Instance) -> Status {
    // SAFETY: the importer's promise.
    unsafe { with(instance, |instance| instance.model.enter_initialization(instance.start_time)) }
}

#[unsafe(no_mangle)]
#[doc = "Takes the steps of a communication step."]
pub unsafe extern "C" fn fmi2DoStep(
    instance: *mut Instance,
    point: f64,
    size: f64,
    _no_state_is_set_before: i32,
) -> Status {
    // SAFETY: the importer's promise.
    match unsafe { with(instance, |instance| instance.model.step(point, size)) } {
        // Where there is no log to tell the version.
        Status::Discard => Status::Error,
        other => other,
    }
}

/// Sets variables, each to a number of its own type that is `made` of the value.
///
/// # Safety
/// The importer's promise.
unsafe fn set_values<T: Copy>(
    instance: *mut Instance,
    references: *const u32,
    length: usize,
    from: *const T,
    made: impl Fn(Number, T) -> Option<Number>,
) -> Status {
    let call = |instance: &mut Instance| {
        // SAFETY: the importer's promise.
        let (references, given) =
            unsafe { (array(references, length, "vr")?, array(from, length, "value")?) };
        let kinds = instance.model.kinds(references)?;
        let numbers = kinds.into_iter().zip(references.iter().zip(given));
        let numbers =
            numbers.map(|(kind, (&of, &value))| made(kind, value).ok_or_else(|| of_another_type(of, kind)));
        instance.model.set_values(references, &numbers.collect::<Result<Vec<_>, _>>()?)
    };
    // SAFETY: the importer's promise.
    unsafe { with(instance, call) }
}

fn real(number: Number) -> Option<f64> {
    match number {
        Number::F64(value) => Some(value),
        Number::F32(value) => Some(value.into()),
        _ => None,
    }
}

fn of_real(kind: Number, value: f64) -> Option<Number> {
    match kind {
        Number::F64(_) => Some(value.into()),
        Number::F32(_) => Some((value as f32).into()),
        _ => None,
    }
}

fn integer(number: Number) -> Option<i32> {
    match number {
        Number::I8(value) => Some(value.into()),
        Number::I16(value) => Some(value.into()),
        Number::I32(value) => Some(value),
        Number::U8(value) => Some(value.into()),
        Number::U16(value) => Some(value.into()),
        _ => None,
    }
}

fn of_integer(kind: Number, value: i32) -> Option<Number> {
    match kind {
        Number::I8(_) => i8::try_from(value).ok().map(Number::I8),
        Number::I16(_) => i16::try_from(value).ok().map(Number::I16),
        Number::I32(_) => Some(Number::I32(value)),
        Number::U8(_) => u8::try_from(value).ok().map(Number::U8),
        Number::U16(_) => u16::try_from(value).ok().map(Number::U16),
        _ => None,
    }
}

macro_rules! types {
    ($($of:ty: $get:ident $set:ident $seen:ident $made:ident;)*) => { $(
        #[unsafe(no_mangle)]
        #[doc = "Gets variables."]
        pub unsafe extern "C" fn $get(i: *mut Instance, vr: *const u32, length: usize, into: *mut $of) -> Status {
            // SAFETY: the importer's promise.
            unsafe { values(i, (vr, length, "vr"), (into, length, "value"), $seen) }
        }

        #[unsafe(no_mangle)]
        #[doc = "Sets variables."]
        pub unsafe extern "C" fn $set(i: *mut Instance, vr: *const u32, length: usize, from: *const $of) -> Status {
            // SAFETY: the importer's promise.
            unsafe { set_values(i, vr, length, from, $made) }
        }
    )* };
}

types! {
    f64: fmi2GetReal fmi2SetReal real of_real;
    i32: fmi2GetInteger fmi2SetInteger integer of_integer;
}

/// `fmi2StatusKind`s that are known without a step that goes on in the background.
const LAST_SUCCESSFUL_TIME: i32 = 2;
const TERMINATED: i32 = 3;

#[unsafe(no_mangle)]
#[doc = "The time that the unit has come to."]
pub unsafe extern "C" fn fmi2GetRealStatus(instance: *mut Instance, kind: i32, into: *mut f64) -> Status {
    let call = |instance: &mut Instance| match kind {
        // SAFETY: the importer's promise.
        LAST_SUCCESSFUL_TIME => unsafe { write(into, 1, "value", || Ok(vec![instance.model.time()])) },
        _ => Err(Refusal::Absent("this kind of fmi2GetRealStatus")),
    };
    // SAFETY: the importer's promise.
    unsafe { with(instance, call) }
}

#[unsafe(no_mangle)]
#[doc = "Whether the unit wants to end the run: never."]
pub unsafe extern "C" fn fmi2GetBooleanStatus(instance: *mut Instance, kind: i32, into: *mut i32) -> Status {
    let call = |_: &mut Instance| match kind {
        // SAFETY: the importer's promise.
        TERMINATED => unsafe { write(into, 1, "value", || Ok(vec![0])) },
        _ => Err(Refusal::Absent("this kind of fmi2GetBooleanStatus")),
    };
    // SAFETY: the importer's promise.
    unsafe { with(instance, call) }
}
