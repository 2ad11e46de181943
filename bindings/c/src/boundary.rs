//! The way between C's pointers and Rust's references: all `unsafe` of the crate.
//!
//! C passes addresses. Each is held against what can be seen of it, NULL and alignment, and what it points at
//! is copied or, for the caller's memory, borrowed for one call after its signature has been found there.
//! What cannot be seen stays the caller's to promise, and the header says so: an address that is not NULL is
//! that of an object of the type declared, and no two threads use one memory at a time.

#![allow(unsafe_code)]

use core::hint::black_box;
use core::mem::{MaybeUninit, needs_drop};
use core::ptr::copy_nonoverlapping;

use dalembert_face::Fields;

use crate::{CReport, CViolation, CWrongPoint, Status};

pub mod calls;
pub mod constrained;
pub mod machine;
pub mod tables;

unsafe extern "C" {
    /// Defined nowhere: a program that can reach a panic does not link. See [`no_panic!`](crate::no_panic).
    pub safe fn a_panic_is_left_in_the_program() -> !;
}

/// Types every pattern of bits of which is a value, without padding that is read: numbers, arrays of them,
/// and structs of such fields as [`parameters!`](crate::parameters) declares, tables by their points.
///
/// # Safety
/// Every initialised pattern of bits is a value of the type.
pub unsafe trait Plain: Copy + 'static {}

macro_rules! plain {
    ($($number:ty)*) => { $(
        // SAFETY: a number of the machine has a value for every pattern of bits.
        unsafe impl Plain for $number {}
    )* };
}

plain!(f64 f32 i8 i16 i32 i64 u8 u16 u32 u64);

// SAFETY: numbers alone, and as many bytes as they have.
unsafe impl Plain for CReport {}

// SAFETY: as CReport.
unsafe impl Plain for CViolation {}

// SAFETY: as CReport, and an address, which is read nowhere.
unsafe impl Plain for CWrongPoint {}

const _: () = assert!(size_of::<CReport>() == 32 && size_of::<CViolation>() == 16);

// SAFETY: an array has no more than its elements.
unsafe impl<T: Plain, const K: usize> Plain for [T; K] {}

/// A system whose fields C can fill in: a struct that [`parameters!`](crate::parameters) declares.
#[diagnostic::on_unimplemented(
    message = "C does not know the fields of `{Self}`",
    note = "declare the struct in `dalembert_c::parameters! {{ … }}`"
)]
pub trait CParameters: Fields<Given: Plain> {}

impl<P: Fields<Given: Plain>> CParameters for P {}

/// Copies the value at `address`.
///
/// # Errors
/// [`Status::NullPointer`], [`Status::Misaligned`].
///
/// # Safety
/// An address that is neither NULL nor misaligned is that of a `T` that nobody writes meanwhile.
pub unsafe fn read<T: Plain>(address: *const T) -> Result<T, Status> {
    seen(address)?;
    // SAFETY: not NULL, aligned, and by the promise above a T.
    Ok(unsafe { address.read() })
}

/// Whether [`write`] may be asked to write there: what is looked at before anything is changed.
///
/// # Errors
/// [`Status::NullPointer`], [`Status::Misaligned`].
pub fn seen<T>(address: *const T) -> Result<(), Status> {
    if address.is_null() {
        return Err(refused(Status::NullPointer));
    }
    if address.is_aligned() { Ok(()) } else { Err(refused(Status::Misaligned)) }
}

/// `status`, for a call that is refused: apart, and opaque, so that calls that are not do not prepare for it.
#[cold]
#[inline(never)]
pub fn refused(status: Status) -> Status {
    black_box(status)
}

/// Writes `value` to `address`, or nothing to NULL.
///
/// # Errors
/// [`Status::Misaligned`].
///
/// # Safety
/// An address that is neither NULL nor misaligned has room for a `T` that nobody uses meanwhile.
pub unsafe fn write<T: Plain>(address: *mut T, value: T) -> Result<(), Status> {
    match seen(address) {
        Err(Status::NullPointer) => Ok(()),
        Err(other) => Err(other),
        Ok(()) => {
            // SAFETY: not NULL, aligned, and by the promise above room for a T.
            unsafe { address.write(value) };
            Ok(())
        }
    }
}

/// Whether [`write`] may be asked to write there, where NULL asks for nothing.
///
/// # Errors
/// [`Status::Misaligned`].
pub fn optional<T>(address: *const T) -> Result<(), Status> {
    if address.is_null() { Ok(()) } else { seen(address) }
}

/// Writes both or neither; nothing to NULL.
///
/// # Errors
/// [`Status::Misaligned`].
///
/// # Safety
/// As [`write`], of either.
pub unsafe fn both<T: Plain>(first: *mut T, one: T, second: *mut T, other: T) -> Result<(), Status> {
    optional(first)?;
    optional(second)?;
    // SAFETY: the same promise.
    unsafe {
        write(first, one)?;
        write(second, other)
    }
}

/// The beginning of the caller's memory once it is initialised.
#[repr(C)]
pub struct Held<T> {
    signature: u64,
    held: MaybeUninit<T>,
}

/// Places `value` into `memory`, to be found under `signature`.
///
/// # Errors
/// [`Status::NullPointer`], [`Status::Misaligned`]: nothing is written.
///
/// # Safety
/// An address that is neither NULL nor misaligned has room for a `Held<T>` that nobody uses meanwhile.
pub unsafe fn place<T: 'static>(memory: *mut Held<T>, signature: u64, value: T) -> Result<(), Status> {
    const { assert!(!needs_drop::<T>(), "the memory is the caller's: what is held there is never dropped") };
    seen(memory)?;
    // SAFETY: not NULL, aligned, and by the promise above room for a Held<T>.
    unsafe { memory.write(Held { signature, held: MaybeUninit::new(value) }) };
    Ok(())
}

/// Does `with` what [`place`] has placed into `memory` under `signature`, all of it or nothing: where `with`
/// fails, every byte is put back as it was.
///
/// # Errors
/// [`Status::NullPointer`], [`Status::Misaligned`], [`Status::NotInitialised`] where another signature stands
/// there, and those of `with`.
///
/// # Safety
/// An address that is neither NULL nor misaligned is that of a memory of this type, which nobody uses
/// meanwhile; its bytes are of one [`place`], moved as a whole or not at all, or do not begin with
/// `signature`.
pub unsafe fn change<T: 'static, R>(
    memory: *mut Held<T>,
    signature: u64,
    with: impl FnOnce(&mut T) -> Result<R, Status>,
) -> Result<R, Status> {
    let all_or_nothing = |held: &mut T| {
        let held = core::ptr::from_mut(held);
        let mut before = MaybeUninit::<T>::uninit();
        // SAFETY: both are size_of::<T>() bytes, and `before` is nobody else's. As bytes, so that padding is
        // copied too.
        unsafe { copy_nonoverlapping(held.cast::<u8>(), before.as_mut_ptr().cast::<u8>(), size_of::<T>()) };
        // SAFETY: the T that was borrowed.
        let done = with(unsafe { &mut *held });
        if done.is_err() {
            // SAFETY: as above, the other way.
            unsafe { copy_nonoverlapping(before.as_ptr().cast::<u8>(), held.cast::<u8>(), size_of::<T>()) };
        }
        done
    };
    // SAFETY: the same promise.
    unsafe { advance(memory, signature, all_or_nothing) }
}

/// As [`change`], where `with` itself changes all or nothing: no copy is kept.
///
/// # Errors
/// Those of [`change`].
///
/// # Safety
/// As [`change`].
#[inline]
pub unsafe fn advance<T: 'static, R>(
    memory: *mut Held<T>,
    signature: u64,
    with: impl FnOnce(&mut T) -> Result<R, Status>,
) -> Result<R, Status> {
    // SAFETY: the same promise.
    unsafe { signed(memory, signature) }?;
    // SAFETY: the signature is written by `place` alone, together with a T, which the caller alone could have
    // changed. The borrow ends with `with`.
    with(unsafe { (*memory).held.assume_init_mut() })
}

/// Asks `of` what [`place`] has placed into `memory` under `signature`.
///
/// # Errors
/// Those of [`change`].
///
/// # Safety
/// As [`change`], except that others may look too.
pub unsafe fn look<T: 'static, R>(
    memory: *const Held<T>,
    signature: u64,
    of: impl FnOnce(&T) -> Result<R, Status>,
) -> Result<R, Status> {
    // SAFETY: the same promise.
    unsafe { signed(memory, signature) }?;
    // SAFETY: the signature is written by `place` alone, together with a T, which the caller alone could have
    // changed. The borrow ends with this call.
    of(unsafe { (*memory).held.assume_init_ref() })
}

/// Whether `memory` begins with `signature`.
///
/// # Safety
/// An address that is neither NULL nor misaligned is that of 8 bytes that nobody writes meanwhile.
unsafe fn signed<T>(memory: *const Held<T>, signature: u64) -> Result<(), Status> {
    seen(memory)?;
    // SAFETY: not NULL, aligned, and by the promise above readable. Volatile: no compiler reasons about what
    // a caller that never initialised it has there.
    let found = unsafe { (&raw const (*memory).signature).read_volatile() };
    if found == signature { Ok(()) } else { Err(refused(Status::NotInitialised)) }
}
