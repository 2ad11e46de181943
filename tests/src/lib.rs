//! What the tests share. Each claim is one file of a folder of `tests/`, and each folder one program.

pub mod by_hand;
#[cfg(feature = "all-claims")]
pub mod convergence;
pub mod damped_oscillator;
pub mod documented;
pub mod draws;
#[cfg(feature = "all-claims")]
pub mod hard;
pub mod hysteresis;
pub mod limit_cycle;
pub mod mechanisms;
#[cfg(feature = "studies")]
pub mod motions;
#[cfg(feature = "all-claims")]
pub mod reference;
pub mod rounded;
pub mod sections;
pub mod simpson;
pub mod sliders;
pub mod systems;

/// What crates.io shows of `dalembert`: its code is run.
#[cfg(doctest)]
#[doc = include_str!("../../runtime/CRATE.md")]
struct CratePage;
