//! The function of C that a system with tables has besides, for every such system.
//!
//! The caller promises what it promises in [`calls`](super::calls).

use dalembert_face::Fields;

use super::machine::{Entered, Filled, System};
use super::{read, seen, write};
use crate::{CWrongPoint, Status};

/// The first table whose points make none, and which of them is wrong.
///
/// # Safety
/// The caller's promise.
pub unsafe fn wrong_point<C: Entered<N>, const N: usize>(
    parameters: *const Filled<C, N>,
    wrong: *mut CWrongPoint,
) -> Status {
    let find = || {
        seen(wrong)?;
        // SAFETY: the caller's promise.
        let found = System::<C, N>::of(&unsafe { read(parameters)? }).err();
        // SAFETY: the caller's promise.
        unsafe { write(wrong, CWrongPoint::new(System::<C, N>::FIELDS, found)) }
    };
    find().into()
}
