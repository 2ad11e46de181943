//! The functions of C, for every system: addresses in, a status out.
//!
//! In all of them the caller promises what the header asks: an address that is neither NULL nor misaligned is
//! that of an object of the type declared; the objects of a call do not overlap; nobody else uses them
//! meanwhile.

use dalembert::nalgebra::ComplexField;
use dalembert::run::DrivenTrajectory;
use dalembert::step::{Flow, Report};

use super::{Held, advance, both, change, look, optional, place, read, seen, write};
use crate::machine::{self, Interface, Machine};
use crate::{CReport, Status};

type Vector<I, const N: usize> = [<I as Interface<N>>::Scalar; N];

/// The caller's memory: opaque in C.
pub type Memory<I, const N: usize> = Held<Machine<I, N>>;

/// Begins a run at (q, v).
///
/// # Safety
/// The caller's promise.
pub unsafe fn init<I: Interface<N>, const N: usize>(
    memory: *mut Memory<I, N>,
    (size, layout): (usize, u64),
    parameters: *const I::Parameters,
    h: I::Scalar,
    given: impl FnOnce() -> Result<I::Given, Status>,
    [q, v]: [*const Vector<I, N>; 2],
) -> Status {
    let begin = || {
        seen(memory)?;
        if layout != I::SIGNATURE || size < size_of::<Memory<I, N>>() {
            return Err(Status::WrongMemory);
        }
        // SAFETY: the caller's promise.
        let (system, q, v) = unsafe { (machine::parameters(read(parameters)?)?, read(q)?, read(v)?) };
        let run = machine::start::<I, N>(&system, given()?, h, [q, v])?;
        // SAFETY: the caller's promise.
        unsafe { place(memory, I::SIGNATURE, Machine { system, run }) }
    };
    begin().into()
}

/// Writes how a step of `run` went, unless nobody asks: the time is a product in double precision, which
/// costs where that is software.
///
/// # Errors
/// Those of [`write`].
///
/// # Safety
/// The caller's promise.
unsafe fn tell<V: Flow<M, N>, M, const N: usize>(
    to: *mut CReport,
    report: &Report<V::Scalar>,
    run: &DrivenTrajectory<V, M, N>,
) -> Result<(), Status> {
    if to.is_null() {
        return Ok(());
    }
    // SAFETY: the caller's promise.
    unsafe { write(to, CReport::new(report, run.time())) }
}

/// Takes a step.
///
/// # Safety
/// The caller's promise.
pub unsafe fn step<I: Interface<N>, const N: usize>(
    memory: *mut Memory<I, N>,
    given: impl FnOnce() -> Result<I::Given, Status>,
    report: *mut CReport,
) -> Status {
    let ask = |Machine { system, run }: &mut Machine<I, N>| {
        let given = given()?;
        optional(report)?;
        // A run that fails here has not been written to: nothing has to be put back.
        let taken = run.advance(&I::view(system, given));
        // SAFETY: the caller's promise.
        unsafe { tell(report, &taken.as_ref()?.report, run) }
    };
    // SAFETY: the caller's promise.
    unsafe { advance(memory, I::SIGNATURE, ask) }.into()
}

/// Takes a step, and linearises it.
///
/// # Safety
/// The caller's promise.
pub unsafe fn step_linearized<I: Interface<N>, const N: usize>(
    memory: *mut Memory<I, N>,
    given: impl FnOnce() -> Result<I::Given, Status>,
    report: *mut CReport,
    linearized: *mut I::Linearized,
) -> Status {
    let ask = |Machine { system, run }: &mut Machine<I, N>| {
        let given = given()?;
        optional(report)?;
        seen(linearized)?;
        let view = I::view(system, given);
        let taken = run.advance_linearized(&view)?;
        let derivatives = I::linearized(&taken)?;
        // SAFETY: the caller's promise.
        unsafe {
            tell(report, &taken.step().report, run)?;
            write(linearized, derivatives)
        }
    };
    // SAFETY: the caller's promise.
    unsafe { change(memory, I::SIGNATURE, ask) }.into()
}

/// The present (q, p); either may be NULL.
///
/// # Safety
/// The caller's promise.
pub unsafe fn state<I: Interface<N>, const N: usize>(
    memory: *const Memory<I, N>,
    [q, p]: [*mut Vector<I, N>; 2],
) -> Status {
    let ask = |machine: &Machine<I, N>| {
        let at = machine.run.state();
        // SAFETY: the caller's promise.
        unsafe { both(q, at.q.into(), p, at.p.into()) }
    };
    // SAFETY: the caller's promise.
    unsafe { look(memory, I::SIGNATURE, ask) }.into()
}

/// The velocity of the present state.
///
/// # Safety
/// The caller's promise.
pub unsafe fn velocity<I: Interface<N>, const N: usize>(
    memory: *const Memory<I, N>,
    given: impl FnOnce() -> Result<I::Given, Status>,
    v: *mut Vector<I, N>,
) -> Status {
    let ask = |Machine { system, run }: &Machine<I, N>| {
        seen(v)?;
        let velocity = run.state().velocity(&I::view(system, given()?))?;
        // SAFETY: the caller's promise.
        unsafe { write(v, velocity.into()) }
    };
    // SAFETY: the caller's promise.
    unsafe { look(memory, I::SIGNATURE, ask) }.into()
}

/// The energy of the present state.
///
/// # Safety
/// The caller's promise.
pub unsafe fn energy<I: Interface<N>, const N: usize>(
    memory: *const Memory<I, N>,
    given: impl FnOnce() -> Result<I::Given, Status>,
    energy: *mut I::Scalar,
) -> Status {
    let ask = |Machine { system, run }: &Machine<I, N>| {
        seen(energy)?;
        let value = run.state().energy(&I::view(system, given()?))?;
        if !value.is_finite() {
            return Err(Status::DerivativesNotFinite);
        }
        // SAFETY: the caller's promise.
        unsafe { write(energy, value) }
    };
    // SAFETY: the caller's promise.
    unsafe { look(memory, I::SIGNATURE, ask) }.into()
}

/// The time since the start.
///
/// # Safety
/// The caller's promise.
pub unsafe fn time<I: Interface<N>, const N: usize>(memory: *const Memory<I, N>, time: *mut f64) -> Status {
    let ask = |machine: &Machine<I, N>| {
        seen(time)?;
        // SAFETY: the caller's promise.
        unsafe { write(time, machine.run.time()) }
    };
    // SAFETY: the caller's promise.
    unsafe { look(memory, I::SIGNATURE, ask) }.into()
}

/// The state some time from now, by one step from the present state, which stays.
///
/// # Safety
/// The caller's promise.
pub unsafe fn state_after<I: Interface<N>, const N: usize>(
    memory: *const Memory<I, N>,
    given: impl FnOnce() -> Result<I::Given, Status>,
    after: I::Scalar,
    [q, p]: [*mut Vector<I, N>; 2],
) -> Status {
    let ask = |Machine { system, run }: &Machine<I, N>| {
        let at = machine::state_after::<_, I::Rule, N>(&I::view(system, given()?), after, run.state())?;
        // SAFETY: the caller's promise.
        unsafe { both(q, at.q.into(), p, at.p.into()) }
    };
    // SAFETY: the caller's promise.
    unsafe { look(memory, I::SIGNATURE, ask) }.into()
}

/// Goes on from (q, p); the guess for the next step is kept.
///
/// # Safety
/// The caller's promise.
pub unsafe fn set_state<I: Interface<N>, const N: usize>(
    memory: *mut Memory<I, N>,
    [q, p]: [*const Vector<I, N>; 2],
) -> Status {
    let ask = |machine: &mut Machine<I, N>| {
        // SAFETY: the caller's promise.
        let (q, p) = unsafe { (read(q)?, read(p)?) };
        machine.run.correct(machine::state(q, p)?);
        Ok(())
    };
    // SAFETY: the caller's promise.
    unsafe { change(memory, I::SIGNATURE, ask) }.into()
}

/// Goes on from the present state and time with other parameters.
///
/// # Safety
/// The caller's promise.
pub unsafe fn set_parameters<I: Interface<N>, const N: usize>(
    memory: *mut Memory<I, N>,
    parameters: *const I::Parameters,
) -> Status {
    let ask = |machine: &mut Machine<I, N>| {
        // SAFETY: the caller's promise.
        let system = machine::parameters(unsafe { read(parameters)? })?;
        *machine = Machine { system, run: DrivenTrajectory::resume(machine.run.present()) };
        Ok(())
    };
    // SAFETY: the caller's promise.
    unsafe { change(memory, I::SIGNATURE, ask) }.into()
}

/// Goes on with another step size.
///
/// # Safety
/// The caller's promise.
pub unsafe fn set_step_size<I: Interface<N>, const N: usize>(
    memory: *mut Memory<I, N>,
    h: I::Scalar,
) -> Status {
    let ask = |machine: &mut Machine<I, N>| {
        machine::require_step_size(h)?;
        machine.run.change_step_size(h);
        Ok(())
    };
    // SAFETY: the caller's promise.
    unsafe { change(memory, I::SIGNATURE, ask) }.into()
}
