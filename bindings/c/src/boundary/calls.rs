//! The functions of C, for every system: addresses in, a status out.
//!
//! In all of them the caller promises what the header asks: an address that is neither NULL nor misaligned is
//! that of an object of the type declared; the objects of a call do not overlap; nobody else uses them
//! meanwhile.

use dalembert::nalgebra::ComplexField;
use dalembert::run::DrivenTrajectory;
use dalembert::step::{Flow, Report, require_step_size};
use dalembert_face::{Interface, Multipliers, StepMade, start};

use super::machine::{self, Entered, Filled, Given, Lambda, Machine, Number, Rule, System, View};
use super::{Held, advance, both, change, look, optional, place, read, seen, write};
use crate::{CReport, Status};

/// N numbers of a system.
pub type Vector<C, const N: usize> = [Number<C, N>; N];

/// The caller's memory: opaque in C.
pub type Memory<C, const N: usize> = Held<Machine<C, N>>;

/// The system with its input and time.
pub fn viewed<C: Entered<N>, const N: usize>(system: &System<C, N>, (u, t): Given<C, N>) -> View<'_, C, N> {
    C::Of::view(system, u, t)
}

/// Begins a run at (q, v).
///
/// # Safety
/// The caller's promise.
pub unsafe fn init<C: Entered<N>, const N: usize>(
    memory: *mut Memory<C, N>,
    (size, layout): (usize, u64),
    parameters: *const Filled<C, N>,
    h: Number<C, N>,
    given: impl FnOnce() -> Result<Given<C, N>, Status>,
    [q, v]: [*const Vector<C, N>; 2],
) -> Status {
    const { assert!(align_of::<Memory<C, N>>() <= 8, "the header aligns the memory to 8 bytes") };
    let begin = || {
        seen(memory)?;
        if layout != C::SIGNATURE || size < size_of::<Memory<C, N>>() {
            return Err(Status::WrongMemory);
        }
        // SAFETY: the caller's promise.
        let (system, q, v) = unsafe { (machine::parameters(&read(parameters)?)?, read(q)?, read(v)?) };
        let run = start::<C::Of, N>(&system, given()?, h, [q, v])?;
        // SAFETY: the caller's promise.
        unsafe { place(memory, C::SIGNATURE, Machine::begun(system, run)) }
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
pub unsafe fn step<C: Entered<N>, const N: usize>(
    memory: *mut Memory<C, N>,
    given: impl FnOnce() -> Result<Given<C, N>, Status>,
    report: *mut CReport,
) -> Status {
    let ask = |Machine { system, run, last }: &mut Machine<C, N>| {
        let given = given()?;
        optional(report)?;
        let (h, state) = (run.step_size(), *run.state());
        // A run that fails here has not been written to: nothing has to be put back.
        let taken = run.advance(&viewed::<C, N>(system, given));
        let step = taken.as_ref()?;
        *last = Lambda::<C, N>::keep(|| (given, StepMade { h, state, step: *step }));
        // SAFETY: the caller's promise.
        unsafe { tell(report, &step.report, run) }
    };
    // SAFETY: the caller's promise.
    unsafe { advance(memory, C::SIGNATURE, ask) }.into()
}

/// Takes a step, and linearises it.
///
/// # Safety
/// The caller's promise.
pub unsafe fn step_linearized<C: Entered<N>, const N: usize>(
    memory: *mut Memory<C, N>,
    given: impl FnOnce() -> Result<Given<C, N>, Status>,
    report: *mut CReport,
    linearized: *mut C::Linearized,
) -> Status {
    let ask = |Machine { system, run, last }: &mut Machine<C, N>| {
        let given = given()?;
        optional(report)?;
        seen(linearized)?;
        let (h, state) = (run.step_size(), *run.state());
        let view = viewed::<C, N>(system, given);
        let taken = run.advance_linearized(&view)?;
        let derivatives = C::linearized(&taken)?;
        *last = Lambda::<C, N>::keep(|| (given, StepMade { h, state, step: *taken.step() }));
        // SAFETY: the caller's promise.
        unsafe {
            tell(report, &taken.step().report, run)?;
            write(linearized, derivatives)
        }
    };
    // SAFETY: the caller's promise.
    unsafe { change(memory, C::SIGNATURE, ask) }.into()
}

/// The present (q, p); either may be NULL.
///
/// # Safety
/// The caller's promise.
pub unsafe fn state<C: Entered<N>, const N: usize>(
    memory: *const Memory<C, N>,
    [q, p]: [*mut Vector<C, N>; 2],
) -> Status {
    let ask = |machine: &Machine<C, N>| {
        let at = machine.run.state();
        // SAFETY: the caller's promise.
        unsafe { both(q, at.q.into(), p, at.p.into()) }
    };
    // SAFETY: the caller's promise.
    unsafe { look(memory, C::SIGNATURE, ask) }.into()
}

/// The velocity of the present state.
///
/// # Safety
/// The caller's promise.
pub unsafe fn velocity<C: Entered<N>, const N: usize>(
    memory: *const Memory<C, N>,
    given: impl FnOnce() -> Result<Given<C, N>, Status>,
    v: *mut Vector<C, N>,
) -> Status {
    let ask = |Machine { system, run, .. }: &Machine<C, N>| {
        seen(v)?;
        let velocity = run.state().velocity(&viewed::<C, N>(system, given()?))?;
        // SAFETY: the caller's promise.
        unsafe { write(v, velocity.into()) }
    };
    // SAFETY: the caller's promise.
    unsafe { look(memory, C::SIGNATURE, ask) }.into()
}

/// The energy of the present state.
///
/// # Safety
/// The caller's promise.
pub unsafe fn energy<C: Entered<N>, const N: usize>(
    memory: *const Memory<C, N>,
    given: impl FnOnce() -> Result<Given<C, N>, Status>,
    energy: *mut Number<C, N>,
) -> Status {
    let ask = |Machine { system, run, .. }: &Machine<C, N>| {
        seen(energy)?;
        let value = run.state().energy(&viewed::<C, N>(system, given()?))?;
        if !value.is_finite() {
            return Err(Status::DerivativesNotFinite);
        }
        // SAFETY: the caller's promise.
        unsafe { write(energy, value) }
    };
    // SAFETY: the caller's promise.
    unsafe { look(memory, C::SIGNATURE, ask) }.into()
}

/// The time since the start.
///
/// # Safety
/// The caller's promise.
pub unsafe fn time<C: Entered<N>, const N: usize>(memory: *const Memory<C, N>, time: *mut f64) -> Status {
    let ask = |machine: &Machine<C, N>| {
        seen(time)?;
        // SAFETY: the caller's promise.
        unsafe { write(time, machine.run.time()) }
    };
    // SAFETY: the caller's promise.
    unsafe { look(memory, C::SIGNATURE, ask) }.into()
}

/// The state some time from now, by one step from the present state, which stays.
///
/// # Safety
/// The caller's promise.
pub unsafe fn state_after<C: Entered<N>, const N: usize>(
    memory: *const Memory<C, N>,
    given: impl FnOnce() -> Result<Given<C, N>, Status>,
    after: Number<C, N>,
    [q, p]: [*mut Vector<C, N>; 2],
) -> Status {
    let ask = |Machine { system, run, .. }: &Machine<C, N>| {
        let at =
            machine::state_after::<_, Rule<C, N>, N>(&viewed::<C, N>(system, given()?), after, run.state())?;
        // SAFETY: the caller's promise.
        unsafe { both(q, at.q.into(), p, at.p.into()) }
    };
    // SAFETY: the caller's promise.
    unsafe { look(memory, C::SIGNATURE, ask) }.into()
}

/// Goes on from (q, p); the guess for the next step is kept.
///
/// # Safety
/// The caller's promise.
pub unsafe fn set_state<C: Entered<N>, const N: usize>(
    memory: *mut Memory<C, N>,
    [q, p]: [*const Vector<C, N>; 2],
) -> Status {
    let ask = |machine: &mut Machine<C, N>| {
        // SAFETY: the caller's promise.
        let (q, p) = unsafe { (read(q)?, read(p)?) };
        machine.run.correct(machine::state(q, p)?);
        Ok(())
    };
    // SAFETY: the caller's promise.
    unsafe { change(memory, C::SIGNATURE, ask) }.into()
}

/// Goes on from the present state and time with other parameters.
///
/// # Safety
/// The caller's promise.
pub unsafe fn set_parameters<C: Entered<N>, const N: usize>(
    memory: *mut Memory<C, N>,
    parameters: *const Filled<C, N>,
) -> Status {
    let ask = |machine: &mut Machine<C, N>| {
        // SAFETY: the caller's promise.
        let system = machine::parameters(&unsafe { read(parameters)? })?;
        *machine = Machine::begun(system, DrivenTrajectory::resume(machine.run.present()));
        Ok(())
    };
    // SAFETY: the caller's promise.
    unsafe { change(memory, C::SIGNATURE, ask) }.into()
}

/// Goes on with another step size.
///
/// # Safety
/// The caller's promise.
pub unsafe fn set_step_size<C: Entered<N>, const N: usize>(
    memory: *mut Memory<C, N>,
    h: Number<C, N>,
) -> Status {
    let ask = |machine: &mut Machine<C, N>| {
        require_step_size(h)?;
        machine.run.change_step_size(h);
        Ok(())
    };
    // SAFETY: the caller's promise.
    unsafe { change(memory, C::SIGNATURE, ask) }.into()
}
