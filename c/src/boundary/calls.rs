//! The functions of C, for every system: addresses in, a status out.
//!
//! In all of them the caller promises what the header asks: an address that is neither NULL nor misaligned is
//! that of an object of the type declared; the objects of a call do not overlap; nobody else uses them
//! meanwhile.

use dalembert::StepError;
use dalembert::nalgebra::ComplexField;
use dalembert::run::DrivenTrajectory;
use dalembert::step::{Flow, Report, StepTaken};
use dalembert_face::{Interface, require_step_size, start};

use super::{Held, Plain, advance, both, change, look, optional, place, read, seen, write};
use crate::machine::{self, Machine, Plainly};
use crate::{CReport, Status};

type Vector<I, const N: usize> = [<I as Interface<N>>::Scalar; N];

/// u and t of a step.
type Given<I, const N: usize> = (<I as Interface<N>>::Input, <I as Interface<N>>::Scalar);

/// The caller's memory: opaque in C.
pub type Memory<I, const N: usize> = Held<Machine<I, N>>;

fn viewed<I: Interface<N>, const N: usize>(system: &I::System, (u, t): Given<I, N>) -> I::View<'_> {
    I::view(system, u, t)
}

/// Begins a run at (q, v).
///
/// # Safety
/// The caller's promise.
pub unsafe fn init<I: Plainly<N>, const N: usize>(
    memory: *mut Memory<I, N>,
    signature: u64,
    (size, layout): (usize, u64),
    parameters: *const I::System,
    h: I::Scalar,
    given: impl FnOnce() -> Result<Given<I, N>, Status>,
    [q, v]: [*const Vector<I, N>; 2],
) -> Status {
    let begin = || {
        seen(memory)?;
        if layout != signature || size < size_of::<Memory<I, N>>() {
            return Err(Status::WrongMemory);
        }
        // SAFETY: the caller's promise.
        let (system, q, v) = unsafe { (machine::parameters(read(parameters)?)?, read(q)?, read(v)?) };
        let run = start::<I, N>(&system, given()?, h, [q, v])?;
        // SAFETY: the caller's promise.
        unsafe { place(memory, signature, Machine { system, run }) }
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
pub unsafe fn step<I: Plainly<N>, const N: usize>(
    memory: *mut Memory<I, N>,
    signature: u64,
    given: impl FnOnce() -> Result<Given<I, N>, Status>,
    report: *mut CReport,
) -> Status {
    let ask = |Machine { system, run }: &mut Machine<I, N>| {
        let given = given()?;
        optional(report)?;
        // A run that fails here has not been written to: nothing has to be put back.
        let taken = run.advance(&viewed::<I, N>(system, given));
        // SAFETY: the caller's promise.
        unsafe { tell(report, &taken.as_ref()?.report, run) }
    };
    // SAFETY: the caller's promise.
    unsafe { advance(memory, signature, ask) }.into()
}

/// Takes a step, and linearises it.
///
/// # Safety
/// The caller's promise.
pub unsafe fn step_linearized<I: Plainly<N>, D: Plain, const N: usize>(
    memory: *mut Memory<I, N>,
    signature: u64,
    given: impl FnOnce() -> Result<Given<I, N>, Status>,
    report: *mut CReport,
    linearized: *mut D,
    derivatives: impl FnOnce(&StepTaken<'_, I::View<'_>, I::Rule, N>) -> Result<D, StepError>,
) -> Status {
    let ask = |Machine { system, run }: &mut Machine<I, N>| {
        let given = given()?;
        optional(report)?;
        seen(linearized)?;
        let view = viewed::<I, N>(system, given);
        let taken = run.advance_linearized(&view)?;
        let derivatives = derivatives(&taken)?;
        // SAFETY: the caller's promise.
        unsafe {
            tell(report, &taken.step().report, run)?;
            write(linearized, derivatives)
        }
    };
    // SAFETY: the caller's promise.
    unsafe { change(memory, signature, ask) }.into()
}

/// The present (q, p); either may be NULL.
///
/// # Safety
/// The caller's promise.
pub unsafe fn state<I: Plainly<N>, const N: usize>(
    memory: *const Memory<I, N>,
    signature: u64,
    [q, p]: [*mut Vector<I, N>; 2],
) -> Status {
    let ask = |machine: &Machine<I, N>| {
        let at = machine.run.state();
        // SAFETY: the caller's promise.
        unsafe { both(q, at.q.into(), p, at.p.into()) }
    };
    // SAFETY: the caller's promise.
    unsafe { look(memory, signature, ask) }.into()
}

/// The velocity of the present state.
///
/// # Safety
/// The caller's promise.
pub unsafe fn velocity<I: Plainly<N>, const N: usize>(
    memory: *const Memory<I, N>,
    signature: u64,
    given: impl FnOnce() -> Result<Given<I, N>, Status>,
    v: *mut Vector<I, N>,
) -> Status {
    let ask = |Machine { system, run }: &Machine<I, N>| {
        seen(v)?;
        let velocity = run.state().velocity(&viewed::<I, N>(system, given()?))?;
        // SAFETY: the caller's promise.
        unsafe { write(v, velocity.into()) }
    };
    // SAFETY: the caller's promise.
    unsafe { look(memory, signature, ask) }.into()
}

/// The energy of the present state.
///
/// # Safety
/// The caller's promise.
pub unsafe fn energy<I: Plainly<N>, const N: usize>(
    memory: *const Memory<I, N>,
    signature: u64,
    given: impl FnOnce() -> Result<Given<I, N>, Status>,
    energy: *mut I::Scalar,
) -> Status {
    let ask = |Machine { system, run }: &Machine<I, N>| {
        seen(energy)?;
        let value = run.state().energy(&viewed::<I, N>(system, given()?))?;
        if !value.is_finite() {
            return Err(Status::DerivativesNotFinite);
        }
        // SAFETY: the caller's promise.
        unsafe { write(energy, value) }
    };
    // SAFETY: the caller's promise.
    unsafe { look(memory, signature, ask) }.into()
}

/// The time since the start.
///
/// # Safety
/// The caller's promise.
pub unsafe fn time<I: Plainly<N>, const N: usize>(
    memory: *const Memory<I, N>,
    signature: u64,
    time: *mut f64,
) -> Status {
    let ask = |machine: &Machine<I, N>| {
        seen(time)?;
        // SAFETY: the caller's promise.
        unsafe { write(time, machine.run.time()) }
    };
    // SAFETY: the caller's promise.
    unsafe { look(memory, signature, ask) }.into()
}

/// The state some time from now, by one step from the present state, which stays.
///
/// # Safety
/// The caller's promise.
pub unsafe fn state_after<I: Plainly<N>, const N: usize>(
    memory: *const Memory<I, N>,
    signature: u64,
    given: impl FnOnce() -> Result<Given<I, N>, Status>,
    after: I::Scalar,
    [q, p]: [*mut Vector<I, N>; 2],
) -> Status {
    let ask = |Machine { system, run }: &Machine<I, N>| {
        let at =
            machine::state_after::<_, I::Rule, N>(&viewed::<I, N>(system, given()?), after, run.state())?;
        // SAFETY: the caller's promise.
        unsafe { both(q, at.q.into(), p, at.p.into()) }
    };
    // SAFETY: the caller's promise.
    unsafe { look(memory, signature, ask) }.into()
}

/// Goes on from (q, p); the guess for the next step is kept.
///
/// # Safety
/// The caller's promise.
pub unsafe fn set_state<I: Plainly<N>, const N: usize>(
    memory: *mut Memory<I, N>,
    signature: u64,
    [q, p]: [*const Vector<I, N>; 2],
) -> Status {
    let ask = |machine: &mut Machine<I, N>| {
        // SAFETY: the caller's promise.
        let (q, p) = unsafe { (read(q)?, read(p)?) };
        machine.run.correct(machine::state(q, p)?);
        Ok(())
    };
    // SAFETY: the caller's promise.
    unsafe { change(memory, signature, ask) }.into()
}

/// Goes on from the present state and time with other parameters.
///
/// # Safety
/// The caller's promise.
pub unsafe fn set_parameters<I: Plainly<N>, const N: usize>(
    memory: *mut Memory<I, N>,
    signature: u64,
    parameters: *const I::System,
) -> Status {
    let ask = |machine: &mut Machine<I, N>| {
        // SAFETY: the caller's promise.
        let system = machine::parameters(unsafe { read(parameters)? })?;
        *machine = Machine { system, run: DrivenTrajectory::resume(machine.run.present()) };
        Ok(())
    };
    // SAFETY: the caller's promise.
    unsafe { change(memory, signature, ask) }.into()
}

/// Goes on with another step size.
///
/// # Safety
/// The caller's promise.
pub unsafe fn set_step_size<I: Plainly<N>, const N: usize>(
    memory: *mut Memory<I, N>,
    signature: u64,
    h: I::Scalar,
) -> Status {
    let ask = |machine: &mut Machine<I, N>| {
        require_step_size(h)?;
        machine.run.change_step_size(h);
        Ok(())
    };
    // SAFETY: the caller's promise.
    unsafe { change(memory, signature, ask) }.into()
}
