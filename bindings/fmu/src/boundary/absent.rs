//! The functions of FMI that a unit has to export and that this one has no use for: each says so.

#![allow(non_snake_case, clippy::missing_safety_doc, clippy::too_many_arguments)]

use core::ffi::{c_char, c_void};
use core::ptr;

use super::{Instance, Log, LogMessage, Status, with};
use crate::refusal::Refusal;

type References = *const u32;

macro_rules! absent {
    ($($name:ident($($of:ty),*);)*) => { $(
        #[unsafe(no_mangle)]
        #[doc = "Refused: the unit has no such thing."]
        pub unsafe extern "C" fn $name(instance: *mut Instance, $(_: $of),*) -> Status {
            // SAFETY: the importer's promise.
            unsafe { with(instance, |_| Err(Refusal::Absent(stringify!($name)))) }
        }
    )* };
}

absent! {
    fmi3EnterEventMode();
    fmi3EnterStepMode();
    fmi3EnterConfigurationMode();
    fmi3ExitConfigurationMode();
    fmi3EnterContinuousTimeMode();
    fmi3EvaluateDiscreteStates();
    fmi3UpdateDiscreteStates(*mut bool, *mut bool, *mut bool, *mut bool, *mut bool, *mut f64);
    fmi3CompletedIntegratorStep(bool, *mut bool, *mut bool);
    fmi3SetTime(f64);
    fmi3SetContinuousStates(*const f64, usize);
    fmi3GetContinuousStateDerivatives(*mut f64, usize);
    fmi3GetEventIndicators(*mut f64, usize);
    fmi3GetContinuousStates(*mut f64, usize);
    fmi3GetNominalsOfContinuousStates(*mut f64, usize);
    fmi3GetNumberOfEventIndicators(*mut usize);
    fmi3GetNumberOfContinuousStates(*mut usize);
    fmi3GetOutputDerivatives(References, usize, *const i32, *mut f64, usize);
    fmi3ActivateModelPartition(u32, f64);
    fmi3GetNumberOfVariableDependencies(u32, *mut usize);
    fmi3GetVariableDependencies(u32, *mut usize, *mut u32, *mut usize, *mut i32, usize);
    fmi3GetAdjointDerivative(References, usize, References, usize, *const f64, usize, *mut f64, usize);
    fmi3GetIntervalDecimal(References, usize, *mut f64, *mut i32);
    fmi3GetIntervalFraction(References, usize, *mut u64, *mut u64, *mut i32);
    fmi3GetShiftDecimal(References, usize, *mut f64);
    fmi3GetShiftFraction(References, usize, *mut u64, *mut u64);
    fmi3SetIntervalDecimal(References, usize, *const f64);
    fmi3SetIntervalFraction(References, usize, *const u64, *const u64);
    fmi3SetShiftDecimal(References, usize, *const f64);
    fmi3SetShiftFraction(References, usize, *const u64, *const u64);
    fmi2SetRealInputDerivatives(References, usize, *const i32, *const f64);
    fmi2GetRealOutputDerivatives(References, usize, *const i32, *mut f64);
    fmi2CancelStep();
    fmi2GetStatus(i32, *mut i32);
    fmi2GetIntegerStatus(i32, *mut i32);
    fmi2GetStringStatus(i32, *mut *const c_char);
}

macro_rules! types {
    ($($name:ident $kind:literal ($($of:ty),*);)*) => { $(
        #[unsafe(no_mangle)]
        #[doc = "Refused, unless no variable is asked for: the unit has none of this type."]
        pub unsafe extern "C" fn $name(instance: *mut Instance, _: References, length: usize, $(_: $of),*) -> Status {
            let call = |_: &mut Instance| if length == 0 { Ok(()) } else { Err(Refusal::NoSuchType($kind)) };
            // SAFETY: the importer's promise.
            unsafe { with(instance, call) }
        }
    )* };
}

types! {
    fmi3GetBoolean "Boolean" (*mut bool, usize);
    fmi3SetBoolean "Boolean" (*const bool, usize);
    fmi3GetString "String" (*mut *const c_char, usize);
    fmi3SetString "String" (*const *const c_char, usize);
    fmi3GetBinary "Binary" (*mut usize, *mut *const u8, usize);
    fmi3SetBinary "Binary" (*const usize, *const *const u8, usize);
    fmi3GetClock "Clock" (*mut bool);
    fmi3SetClock "Clock" (*const bool);
    fmi2GetBoolean "Boolean" (*mut i32);
    fmi2SetBoolean "Boolean" (*const i32);
    fmi2GetString "String" (*mut *const c_char);
    fmi2SetString "String" (*const *const c_char);
}

macro_rules! instantiate {
    ($($name:ident $kind:literal ($($of:ty),*);)*) => { $(
        #[unsafe(no_mangle)]
        #[doc = "Refused: the unit is for co-simulation."]
        pub unsafe extern "C" fn $name(
            _: *const c_char,
            _: *const c_char,
            _: *const c_char,
            _: bool,
            on: bool,
            environment: *mut c_void,
            log: Option<LogMessage>,
            $(_: $of),*
        ) -> *mut Instance {
            Log::new(log, environment, on)
                .say(Status::Error, concat!("the unit is for co-simulation, not for ", $kind));
            ptr::null_mut()
        }
    )* };
}

/// A callback that is not called.
type Callback = Option<unsafe extern "C" fn()>;

instantiate! {
    fmi3InstantiateModelExchange "model exchange" ();
    fmi3InstantiateScheduledExecution "scheduled execution" (Callback, Callback, Callback);
}
