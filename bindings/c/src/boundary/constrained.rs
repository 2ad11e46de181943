//! The functions of C that a system with constraints has besides, for every such system.
//!
//! The caller promises what it promises in [`calls`](super::calls).

use dalembert::Lagrangian;
use dalembert_face::{Interface, Multipliers};

use super::calls::{Memory, Vector, viewed};
use super::machine::{self, Entered, Filled, Given, Machine, Number};
use super::{both, look, read, seen, write};
use crate::{CViolation, Status};

/// The first constraint that (q, v) violates, and by how much.
///
/// # Safety
/// The caller's promise.
pub unsafe fn violation<C: Entered<N>, const N: usize>(
    parameters: *const Filled<C, N>,
    given: impl FnOnce() -> Result<Given<C, N>, Status>,
    [q, v]: [*const Vector<C, N>; 2],
    violation: *mut CViolation,
) -> Status {
    let find = || {
        seen(violation)?;
        // SAFETY: the caller's promise.
        let (system, q, v) = unsafe { (machine::parameters(&read(parameters)?)?, read(q)?, read(v)?) };
        let at = machine::state(q, v)?;
        let found = viewed::<C, N>(&system, given()?).violation(&at.q, &at.p);
        // SAFETY: the caller's promise.
        unsafe { write(violation, found.into()) }
    };
    find().into()
}

/// The configuration and velocity on all constraints that are nearest to (q, v).
///
/// # Safety
/// The caller's promise.
pub unsafe fn nearest<C: Entered<N>, const N: usize>(
    parameters: *const Filled<C, N>,
    given: impl FnOnce() -> Result<Given<C, N>, Status>,
    [q, v]: [*const Vector<C, N>; 2],
    [nearest_q, nearest_v]: [*mut Vector<C, N>; 2],
) -> Status {
    let find = || {
        seen(nearest_q)?;
        seen(nearest_v)?;
        // SAFETY: the caller's promise.
        let (system, q, v) = unsafe { (machine::parameters(&read(parameters)?)?, read(q)?, read(v)?) };
        let view = viewed::<C, N>(&system, given()?);
        let state = C::Of::nearest(&view, [q, v])?;
        let velocity = state.velocity(&view)?;
        // SAFETY: the caller's promise.
        unsafe { both(nearest_q, state.q.into(), nearest_v, velocity.into()) }
    };
    find().into()
}

/// The multipliers of the last step.
///
/// # Safety
/// The caller's promise.
pub unsafe fn reactions<C: Entered<N>, const N: usize, const M: usize>(
    memory: *const Memory<C, N>,
    lambda: *mut [Number<C, N>; M],
) -> Status {
    let ask = |Machine { system, last, .. }: &Machine<C, N>| {
        seen(lambda)?;
        let (given, made) = <C::Of as Interface<N>>::Multipliers::kept(last).ok_or(Status::NoStep)?;
        let view = viewed::<C, N>(system, *given);
        let found = C::Of::reactions(&view, made)?;
        let found = found.as_ref().try_into().map_err(|_| Status::Other)?;
        // SAFETY: the caller's promise.
        unsafe { write(lambda, found) }
    };
    // SAFETY: the caller's promise.
    unsafe { look(memory, C::SIGNATURE, ask) }.into()
}
