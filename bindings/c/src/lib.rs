//! The step of a system in C: the functions, and the header that declares them.
//!
//! In a crate of its own, `crate-type = ["staticlib"]`, [`parameters!`] declares the struct of the system's
//! fields and [`c_api!`] names the system, its rule and a prefix. C gets
//!
//! | function | what it does |
//! |---|---|
//! | `p_init(memory, parameters, h, t, q, v)` | begins a run |
//! | `p_step(memory, u, t, report)` | takes a step with input u, from time t |
//! | `p_step_linearized(memory, u, t, report, linearized)` | also A, B and derivatives by parameters, row by row |
//! | `p_state(memory, q, p)`, `p_velocity(memory, t, v)`, `p_energy(memory, t, energy)`, `p_time(memory, time)` | what the run has come to |
//! | `p_state_after(memory, u, t, after, q, p)` | a look ahead, or between steps: by one step of another length; the run stays |
//! | `p_set_state`, `p_set_parameters`, `p_set_step_size` | go on from there |
//! | `p_text(status)` | what happened and what to do |
//!
//! A system with constraints has besides
//!
//! | function | what it does |
//! |---|---|
//! | `p_violation(parameters, t, q, v, violation)` | which constraint (q, v) violates, and by how much |
//! | `p_nearest(parameters, t, q, v, nearest_q, nearest_v)` | the nearest state on all constraints |
//! | `p_reactions(memory, lambda)` | λ of the last step |
//!
//! A system with a [`Table`](dalembert::system::Table) has, beside what is filled in for it,
//!
//! | function | what it does |
//! |---|---|
//! | `p_wrong_point(parameters, wrong)` | which point of which table is wrong |
//!
//! u is there where the force takes an input, t where L, R or f take the time. The chapter *In C* of
//! `docs/embedding.md` is a control loop from the model to the numbers, and `examples/c/` the template.
//!
//! On a microcontroller, without the feature `std`, [`no_panic!`] makes the linker prove that no call panics;
//! `examples/firmware-c/` is the template.
//!
//! The memory is the caller's: a static or a local variable of the type that the header declares. There is no
//! allocation, no global state and no thread. A call that returns anything but `DALEMBERT_OK` has changed
//! nothing, byte for byte. NULL, misaligned addresses, memory of another system or of none, layouts of
//! another build and numbers that are NaN are refused. What cannot be seen of an address the header asks its
//! caller to promise.
//!
//! Events are not passed on: a function of C's that is called from within the search for a root could not be
//! held to these promises. Between steps `p_state_after` is what one would look for it with.

#![no_std]

#[cfg(feature = "std")]
extern crate std;

#[doc(hidden)]
pub use dalembert;
#[doc(hidden)]
pub use dalembert_face as face;

mod api;
#[doc(hidden)]
pub mod boundary;
mod header;
mod no_panic;
mod parameters;
mod report;
mod status;

pub use boundary::CParameters;
pub use header::Header;
pub use report::{CReport, CViolation, CWrongPoint};
pub use status::{Status, text};
