//! The functions of FMI 3.0 that the unit offers.
//!
//! In all of them the importer promises what FMI asks, as said in [`boundary`](super).

#![allow(non_snake_case, clippy::missing_safety_doc)]

use core::ffi::c_char;
use core::ptr;
use std::panic::{AssertUnwindSafe, catch_unwind};

use super::{Instance, Status, array, text, with, write};
use crate::description::CATEGORIES;
use crate::model::Model;
use crate::refusal::Refusal;

/// A saved state, opaque to the importer.
pub struct Saved(Box<dyn Model>);

#[unsafe(no_mangle)]
#[doc = "The version of FMI."]
pub extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

#[unsafe(no_mangle)]
#[doc = "Turns categories of the log on or off; all of them where none is named."]
pub unsafe extern "C" fn fmi3SetDebugLogging(
    instance: *mut Instance,
    on: bool,
    length: usize,
    categories: *const *const c_char,
) -> Status {
    let call = |instance: &mut Instance| {
        // SAFETY: the importer's promise.
        let categories = unsafe { array(categories, length, "categories")? };
        let mut now = instance.log.on;
        if categories.is_empty() {
            now = [on; CATEGORIES.len()];
        }
        for &category in categories {
            // SAFETY: the importer's promise.
            let name = unsafe { text(category) };
            let known = CATEGORIES.iter().position(|(known, _)| Some(*known) == name);
            now[known.ok_or(Refusal::Category)?] = on;
        }
        instance.log.on = now;
        Ok(())
    };
    // SAFETY: the importer's promise.
    unsafe { with(instance, call) }
}

#[unsafe(no_mangle)]
#[doc = "Frees an instance."]
pub unsafe extern "C" fn fmi3FreeInstance(instance: *mut Instance) {
    if !instance.is_null() {
        // SAFETY: by the promise `instantiate` made it of a Box, and nobody uses it from now on.
        let instance = unsafe { Box::from_raw(instance) };
        // Nothing unwinds into C.
        let _ = catch_unwind(AssertUnwindSafe(|| drop(instance)));
    }
}

#[unsafe(no_mangle)]
#[doc = "Into initialization mode."]
pub unsafe extern "C" fn fmi3EnterInitializationMode(
    instance: *mut Instance,
    _tolerance_defined: bool,
    _tolerance: f64,
    start_time: f64,
    _stop_time_defined: bool,
    _stop_time: f64,
) -> Status {
    // SAFETY: the importer's promise.
    unsafe { with(instance, |instance| instance.model.enter_initialization(start_time)) }
}

#[unsafe(no_mangle)]
#[doc = "Begins the run."]
pub unsafe extern "C" fn fmi3ExitInitializationMode(instance: *mut Instance) -> Status {
    // SAFETY: the importer's promise.
    unsafe { with(instance, |instance| instance.model.exit_initialization()) }
}

#[unsafe(no_mangle)]
#[doc = "Takes the steps of a communication step."]
pub unsafe extern "C" fn fmi3DoStep(
    instance: *mut Instance,
    point: f64,
    size: f64,
    _no_state_is_set_before: bool,
    event_handling_needed: *mut bool,
    terminate_simulation: *mut bool,
    early_return: *mut bool,
    last_successful_time: *mut f64,
) -> Status {
    let call = |instance: &mut Instance| {
        let stepped = instance.model.step(point, size);
        let never = || Ok(vec![false]);
        let answers = [event_handling_needed, terminate_simulation, early_return];
        for answer in answers.into_iter().filter(|answer| !answer.is_null()) {
            // SAFETY: the importer's promise.
            unsafe { write(answer, 1, "an answer of fmi3DoStep", never)? };
        }
        if !last_successful_time.is_null() {
            let time = || Ok(vec![instance.model.time()]);
            // SAFETY: the importer's promise.
            unsafe { write(last_successful_time, 1, "lastSuccessfulTime", time)? };
        }
        stepped
    };
    // SAFETY: the importer's promise.
    unsafe { with(instance, call) }
}

#[unsafe(no_mangle)]
#[doc = "Ends the run."]
pub unsafe extern "C" fn fmi3Terminate(instance: *mut Instance) -> Status {
    // SAFETY: the importer's promise.
    unsafe { with(instance, |instance| instance.model.terminate()) }
}

#[unsafe(no_mangle)]
#[doc = "Back to what was instantiated."]
pub unsafe extern "C" fn fmi3Reset(instance: *mut Instance) -> Status {
    let call = |instance: &mut Instance| {
        instance.model.reset();
        Ok(())
    };
    // SAFETY: the importer's promise.
    unsafe { with(instance, call) }
}

/// Saves `model`, into a new state or one that was saved before.
///
/// # Safety
/// The importer's promise.
unsafe fn save(model: Box<dyn Model>, into: *mut *mut Saved) -> Result<(), Refusal> {
    // SAFETY: the importer's promise.
    let old = unsafe { array(into, 1, "FMUState")? }[0];
    // SAFETY: NULL, or by the promise a state that was made here and not freed.
    if let Some(old) = unsafe { old.as_mut() } {
        old.0 = model;
        return Ok(());
    }
    let new = Box::into_raw(Box::new(Saved(model)));
    // SAFETY: looked at above.
    unsafe { write(into, 1, "FMUState", || Ok(vec![new])) }
}

#[unsafe(no_mangle)]
#[doc = "Saves the state, into a new one or one that was saved before."]
pub unsafe extern "C" fn fmi3GetFMUState(instance: *mut Instance, into: *mut *mut Saved) -> Status {
    // SAFETY: the importer's promise.
    unsafe { with(instance, |instance| save(instance.model.copy(), into)) }
}

#[unsafe(no_mangle)]
#[doc = "Goes on from a saved state."]
pub unsafe extern "C" fn fmi3SetFMUState(instance: *mut Instance, saved: *const Saved) -> Status {
    let call = |instance: &mut Instance| {
        // SAFETY: the importer's promise.
        let saved = unsafe { array(saved, 1, "FMUState")? };
        instance.model = saved[0].0.copy();
        Ok(())
    };
    // SAFETY: the importer's promise.
    unsafe { with(instance, call) }
}

#[unsafe(no_mangle)]
#[doc = "Frees a saved state, and makes its address NULL."]
pub unsafe extern "C" fn fmi3FreeFMUState(instance: *mut Instance, saved: *mut *mut Saved) -> Status {
    let call = |_: &mut Instance| {
        if saved.is_null() {
            return Ok(());
        }
        // SAFETY: the importer's promise.
        let old = unsafe { array(saved, 1, "FMUState")? }[0];
        // SAFETY: looked at above.
        unsafe { write(saved, 1, "FMUState", || Ok(vec![ptr::null_mut()]))? };
        if !old.is_null() {
            // SAFETY: by the promise it was made here of a Box and is not used any more.
            drop(unsafe { Box::from_raw(old) });
        }
        Ok(())
    };
    // SAFETY: the importer's promise.
    unsafe { with(instance, call) }
}

#[unsafe(no_mangle)]
#[doc = "How many bytes a saved state has."]
pub unsafe extern "C" fn fmi3SerializedFMUStateSize(
    instance: *mut Instance,
    saved: *const Saved,
    size: *mut usize,
) -> Status {
    let call = |_: &mut Instance| {
        // SAFETY: the importer's promise.
        let saved = unsafe { array(saved, 1, "FMUState")? };
        // SAFETY: the importer's promise.
        unsafe { write(size, 1, "size", || Ok(vec![saved[0].0.bytes().len()])) }
    };
    // SAFETY: the importer's promise.
    unsafe { with(instance, call) }
}

#[unsafe(no_mangle)]
#[doc = "Writes a saved state as bytes."]
pub unsafe extern "C" fn fmi3SerializeFMUState(
    instance: *mut Instance,
    saved: *const Saved,
    bytes: *mut u8,
    size: usize,
) -> Status {
    let call = |_: &mut Instance| {
        // SAFETY: the importer's promise.
        let saved = unsafe { array(saved, 1, "FMUState")? };
        // SAFETY: the importer's promise.
        unsafe { write(bytes, size, "serializedState", || Ok(saved[0].0.bytes())) }
    };
    // SAFETY: the importer's promise.
    unsafe { with(instance, call) }
}

#[unsafe(no_mangle)]
#[doc = "Makes a saved state of bytes."]
pub unsafe extern "C" fn fmi3DeserializeFMUState(
    instance: *mut Instance,
    bytes: *const u8,
    size: usize,
    into: *mut *mut Saved,
) -> Status {
    let call = |instance: &mut Instance| {
        // SAFETY: the importer's promise.
        let bytes = unsafe { array(bytes, size, "serializedState")? };
        // SAFETY: the importer's promise.
        unsafe { save(instance.model.of_bytes(bytes)?, into) }
    };
    // SAFETY: the importer's promise.
    unsafe { with(instance, call) }
}

#[unsafe(no_mangle)]
#[doc = "The sum of ∂unknown/∂known seed, for each unknown."]
pub unsafe extern "C" fn fmi3GetDirectionalDerivative(
    instance: *mut Instance,
    unknowns: *const u32,
    unknowns_length: usize,
    knowns: *const u32,
    knowns_length: usize,
    seed: *const f64,
    seed_length: usize,
    sensitivity: *mut f64,
    sensitivity_length: usize,
) -> Status {
    let call = |instance: &mut Instance| {
        // SAFETY: the importer's promise.
        let unknowns = unsafe { array(unknowns, unknowns_length, "unknowns")? };
        // SAFETY: the importer's promise.
        let knowns = unsafe { array(knowns, knowns_length, "knowns")? };
        // SAFETY: the importer's promise.
        let seed = unsafe { array(seed, seed_length, "seed")? };
        let along = || instance.model.directional_derivative(unknowns, knowns, seed);
        // SAFETY: the importer's promise.
        unsafe { write(sensitivity, sensitivity_length, "sensitivity", along) }
    };
    // SAFETY: the importer's promise.
    unsafe { with(instance, call) }
}
