//! Right and wrong calls through the C functions, against the run in Rust that they stand for.
//!
//! `cargo +nightly miri test -p dalembert-c --test boundary` runs the same under Miri, with
//! MIRIFLAGS="-Zmiri-deterministic-floats -Zmiri-disable-isolation".
#![allow(unsafe_code, clippy::undocumented_unsafe_blocks)]

mod boundary {
    mod constrained;
    mod failed_steps;
    mod massless;
    mod random_calls;
    mod tables;
    mod wrong_calls;
}
#[allow(dead_code)]
mod systems;

use core::mem::{MaybeUninit, size_of};

use dalembert_c::Status;
use dalembert_c::face::Fields;
use systems::{CartPole, cart_pole};

/// What C gets from `static cart_pole_memory memory;`.
type Memory = MaybeUninit<cart_pole::CMemory>;

const PARAMETERS: CartPole = CartPole { cart: 1.0, rod: 0.3, half_length: 0.4, friction: [0.3, 0.004] };

/// `cart_pole_init` of the header.
fn init(memory: &mut Memory, parameters: &CartPole, h: f64, q: [f64; 2], v: [f64; 2]) -> Status {
    let (size, layout) = (size_of::<Memory>(), cart_pole::HEADER.layout);
    unsafe { cart_pole::init_with(memory.as_mut_ptr(), size, layout, &parameters.given(), h, &q, &v) }
}

/// The present (q, p), bit by bit.
fn bits(memory: &Memory) -> Result<[u64; 4], Status> {
    let (mut q, mut p) = ([0.0; 2], [0.0; 2]);
    match unsafe { cart_pole::state(memory.as_ptr(), &mut q, &mut p) } {
        Status::Ok => Ok([q[0], q[1], p[0], p[1]].map(f64::to_bits)),
        other => Err(other),
    }
}

/// All bytes of an object, as C sees them. Padding has no value that Miri would allow to look at.
fn bytes<T>(object: &T) -> Vec<u8> {
    if cfg!(miri) {
        return Vec::new();
    }
    let start = core::ptr::from_ref(object).cast::<u8>();
    (0..size_of::<T>()).map(|i| unsafe { start.add(i).read_volatile() }).collect()
}
