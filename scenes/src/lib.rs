//! Mechanical systems that more than one package of the workspace steps, each written once, one file a scene
//! with its formula and its parameters.
//!
//! A scene that is wanted in several sizes, in `f32` or by the other engine is a macro, to which this file gives
//! the name, these choices and the rules.

#![no_std]

#[macro_use]
mod arm;
#[macro_use]
mod double_pendulum;
#[cfg(feature = "mechanisms")]
pub mod four_bar;
#[macro_use]
mod fput_chain;
mod henon_heiles;
mod kepler;
mod oscillator;
#[macro_use]
mod pendulum_chain;
#[macro_use]
mod ring;
#[macro_use]
mod spring_chain;

pub use henon_heiles::{HenonHeiles, henon_heiles};
pub use kepler::{EccentricKepler, Kepler, kepler};
pub use oscillator::{Oscillator, oscillator};

ring!(Ring: expanded, [midpoint, trapezoidal, gauss], lanes = [explicit, gauss]);
double_pendulum!(DoublePendulum: f64, expanded, [midpoint, trapezoidal, gauss], lanes = [gauss]);
fput_chain!(FputChain2: 2, expanded, [midpoint, trapezoidal, gauss]);
fput_chain!(FputChain4: 4, expanded, [midpoint, trapezoidal, gauss]);
fput_chain!(FputChain6: 6, expanded, [trapezoidal, gauss]);
fput_chain!(FputChain8: 8, expanded, [midpoint, trapezoidal, gauss], lanes = [explicit]);
fput_chain!(FputChain16: 16, expanded, [midpoint, trapezoidal, gauss]);
fput_chain!(FputChain32: 32, expanded, [midpoint, trapezoidal, gauss]);
spring_chain!(SpringChain8: 8, expanded, [midpoint, trapezoidal]);
spring_chain!(SpringChain16: 16, expanded, [midpoint]);
spring_chain!(SpringChain32: 32, expanded, [midpoint]);
pendulum_chain!(PendulumChain16: 16, expanded, [midpoint]);
arm!(Arm: expanded, [midpoint]);

/// In single precision.
pub mod single {
    double_pendulum!(DoublePendulum: f32, expanded, [midpoint]);
}

/// With sums rounded with the products in them.
#[cfg(feature = "fused")]
pub mod fused {
    double_pendulum!(DoublePendulum: f64, expanded, [gauss], lanes = [gauss], multiply_add = fused);
}

/// By dual numbers when the program runs; above, derivatives are written out when it is compiled.
#[cfg(feature = "num-dual")]
pub mod num_dual {
    ring!(Ring: num_dual, [midpoint, trapezoidal]);
    double_pendulum!(DoublePendulum: f64, num_dual, [midpoint]);
    fput_chain!(FputChain8: 8, num_dual, [midpoint]);
    spring_chain!(SpringChain16: 16, num_dual, [midpoint]);
    pendulum_chain!(PendulumChain16: 16, num_dual, [midpoint]);
    arm!(Arm: num_dual, [midpoint]);
}
