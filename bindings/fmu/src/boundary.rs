//! The way between FMI's pointers and Rust's references: all `unsafe` of the crate.
//!
//! The importer promises what FMI asks of it: an instance is NULL or one that [`instantiate`] made and that
//! has not been freed; an array that is not NULL is of the length given; nobody else uses either during the
//! call. NULL, misaligned arrays and lengths that no memory has are refused.

#![allow(unsafe_code)]

use core::ffi::{CStr, c_char, c_void};
use std::ffi::CString;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::slice;

use dalembert_face::Interface;

use crate::Unit;
use crate::cosimulation::CoSimulation;
use crate::description::CATEGORIES;
use crate::model::Model;
use crate::refusal::Refusal;

mod absent;
mod functions;
mod two;
mod values;

pub use two::{Callbacks, LogMessage2};

/// How a call ended: `fmi3Status`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum Status {
    /// Done.
    Ok = 0,
    /// Not used.
    Warning = 1,
    /// The call has changed nothing; another may do.
    Discard = 2,
    /// The call has changed nothing.
    Error = 3,
    /// The instance is of no use any more.
    Fatal = 4,
}

/// `fmi3LogMessageCallback`.
pub type LogMessage = unsafe extern "C" fn(*mut c_void, Status, *const c_char, *const c_char);

/// The callback of the importer's log.
enum Call {
    /// Of FMI 3.0.
    Three(LogMessage),
    /// Of FMI 2.0, which is told the name of the instance.
    Two(LogMessage2, CString),
}

/// The importer's log.
pub struct Log {
    call: Option<Call>,
    environment: *mut c_void,
    /// Of each of [`CATEGORIES`], whether it is on.
    on: [bool; 3],
}

impl Log {
    /// A log of FMI 3.0, all of it on or off.
    #[must_use]
    pub fn new(call: Option<LogMessage>, environment: *mut c_void, on: bool) -> Self {
        Self { call: call.map(Call::Three), environment, on: [on; 3] }
    }

    fn say(&self, status: Status, message: &str) {
        let category = match status {
            Status::Discard => 0,
            Status::Fatal => 2,
            _ => 1,
        };
        let Some(call) = self.call.as_ref().filter(|_| self.on[category]) else { return };
        // A zero byte would end the text; in FMI 2.0 it is a format, in which variables are named between #.
        let message = message.replace('\0', " ");
        let message =
            if let Call::Two(..) = call { message.replace('%', "%%").replace('#', "##") } else { message };
        let (Ok(name), Ok(message)) = (CString::new(CATEGORIES[category].0), CString::new(message)) else {
            return;
        };
        let (name, message) = (name.as_ptr(), message.as_ptr());
        match call {
            // SAFETY: the importer's callback, with the environment that it gave for it; the texts end with a
            // zero byte and live until the call has returned.
            Call::Three(call) => unsafe { call(self.environment, status, name, message) },
            // SAFETY: as above; the format asks for no arguments.
            Call::Two(call, of) => unsafe { call(self.environment, of.as_ptr(), status, name, message) },
        }
    }
}

/// An instance, opaque to the importer.
pub struct Instance {
    model: Box<dyn Model>,
    log: Log,
    /// The start time, which FMI 2.0 sets before it enters initialization mode.
    start_time: f64,
    /// A panic has left the model in a state that nobody knows.
    dead: bool,
}

/// Makes an instance, or NULL, and says why.
///
/// # Safety
/// The importer's promise: texts are NULL or end with a zero byte.
pub unsafe fn instantiate<I: Interface<N>, const N: usize>(
    unit: &'static Unit<I, N>,
    name: *const c_char,
    token: *const c_char,
    event_mode_used: bool,
    log: Log,
) -> *mut Instance {
    // SAFETY: the same promise.
    let (name, token) = unsafe { (text(name), text(token)) };
    let refused = match (name, token) {
        (None, _) | (_, None) => "the name of the instance or its token is NULL or not UTF-8".into(),
        (_, Some(token)) if token != unit.token() => format!(
            "the description has the token {token} and the library {}: they are of different builds, pack the unit again",
            unit.token()
        ),
        _ if event_mode_used => "the unit has no event mode".into(),
        _ => {
            let made = catch_unwind(AssertUnwindSafe(|| Box::new(CoSimulation::new(unit))));
            return match made {
                Ok(model) => Box::into_raw(Box::new(Instance { model, log, start_time: 0.0, dead: false })),
                Err(_) => core::ptr::null_mut(),
            };
        }
    };
    log.say(Status::Error, &refused);
    core::ptr::null_mut()
}

/// Makes an instance of FMI 2.0, or NULL, and says why.
///
/// # Safety
/// The importer's promise: texts are NULL or end with a zero byte, `callbacks` is NULL or FMI's.
pub unsafe fn instantiate_two<I: Interface<N>, const N: usize>(
    unit: &'static Unit<I, N>,
    name: *const c_char,
    kind: i32,
    token: *const c_char,
    callbacks: *const Callbacks,
    logging_on: bool,
) -> *mut Instance {
    // SAFETY: the same promise.
    let (callbacks, own_name) = unsafe { (array(callbacks, 1, "functions"), text(name)) };
    let callbacks = callbacks.ok().and_then(|callbacks| callbacks.first());
    let own_name = CString::new(own_name.unwrap_or_default()).unwrap_or_default();
    let log = Log {
        call: callbacks.and_then(|callbacks| callbacks.log).map(|call| Call::Two(call, own_name)),
        environment: callbacks.map_or(core::ptr::null_mut(), |callbacks| callbacks.environment),
        on: [logging_on; 3],
    };
    if kind != 1 {
        log.say(Status::Error, "the unit is for co-simulation, not for model exchange");
        return core::ptr::null_mut();
    }
    // SAFETY: the same promise.
    unsafe { instantiate(unit, name, token, false, log) }
}

/// Does `call` with the instance. What is refused, or panics, is said to its log.
///
/// # Safety
/// The importer's promise.
unsafe fn with(instance: *mut Instance, call: impl FnOnce(&mut Instance) -> Result<(), Refusal>) -> Status {
    // SAFETY: NULL, or by the promise an instance that nobody else uses meanwhile.
    let Some(instance) = (unsafe { instance.as_mut() }) else {
        return Status::Error;
    };
    if instance.dead {
        return Status::Fatal;
    }
    let ended = catch_unwind(AssertUnwindSafe(|| call(&mut *instance)));
    let (status, said) = match ended {
        Ok(Ok(())) => return Status::Ok,
        Ok(Err(refusal)) => {
            // FMI 2.0 calls a communication step that was not carried out at all an error.
            let is_two = matches!(instance.log.call, Some(Call::Two(..)));
            let discards = matches!(refusal, Refusal::CommunicationStep(_)) && !is_two;
            (if discards { Status::Discard } else { Status::Error }, refusal.to_string())
        }
        Err(panic) => {
            instance.dead = true;
            let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
            let text = text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default();
            (Status::Fatal, format!("the model panicked: {text}"))
        }
    };
    instance.log.say(status, &said);
    status
}

/// The text at `address`.
///
/// # Safety
/// NULL, or text that ends with a zero byte and that nobody changes while the result is used.
unsafe fn text<'a>(address: *const c_char) -> Option<&'a str> {
    if address.is_null() {
        return None;
    }
    // SAFETY: not NULL, and by the promise text that ends with a zero byte.
    unsafe { CStr::from_ptr(address) }.to_str().ok()
}

/// Whether an array of this length can be at `address`.
fn require_array<T>(address: *const T, length: usize, name: &'static str) -> Result<(), Refusal> {
    let fits = size_of::<T>().checked_mul(length).is_some_and(|bytes| bytes <= isize::MAX as usize);
    if address.is_null() || !address.is_aligned() || !fits { Err(Refusal::Address(name)) } else { Ok(()) }
}

/// The array at `address`; NULL is an array of nothing.
///
/// # Safety
/// An address that is neither NULL nor misaligned is that of `length` values that nobody changes while the
/// result is used.
unsafe fn array<'a, T>(address: *const T, length: usize, name: &'static str) -> Result<&'a [T], Refusal> {
    if length == 0 {
        return Ok(&[]);
    }
    require_array(address, length, name)?;
    // SAFETY: not NULL, aligned, of a length that memory has, and by the promise an array.
    Ok(unsafe { slice::from_raw_parts(address, length) })
}

/// Writes values to `address`.
///
/// # Safety
/// An address that is neither NULL nor misaligned has room for `length` values that nobody uses meanwhile.
unsafe fn write<T: Copy>(
    address: *mut T,
    length: usize,
    name: &'static str,
    values: impl FnOnce() -> Result<Vec<T>, Refusal>,
) -> Result<(), Refusal> {
    if length > 0 {
        require_array(address, length, name)?;
    }
    let values = values()?;
    if values.len() != length {
        return Err(Refusal::Lengths { asked: values.len(), given: length });
    }
    // SAFETY: as many values as there is room for by the promise; not NULL and aligned, or none. They are of
    // our own making, so they do not overlap.
    unsafe { core::ptr::copy_nonoverlapping(values.as_ptr(), address, length) };
    Ok(())
}
