//! One step: the discrete system, its states, and the solver of its equation.
//!
//! Uses numbers and systems. What rules there are, it does not know.

pub(crate) mod cause;
mod defect;
mod discrete;
mod discrete_force;
mod discrete_rayleigh;
mod discretised;
mod driven;
mod error;
pub(crate) mod flow;
mod force_work;
pub(crate) mod in_lanes;
mod kernel;
mod legendre;
mod linearization;
pub(crate) mod newton;
mod outcome;
mod parameters;
mod second_order;
mod segment;
mod solve;
mod solved_for_velocity;
mod start;
mod state;
mod taken;
mod velocity_history;

pub use crate::numbers::{Banded, NewtonMatrix, Singular};
pub use defect::Defect;
pub(crate) use defect::Pairing;
pub use discrete::Discrete;
pub use discrete_force::{DiscreteForce, DiscreteForceDerivatives};
pub use discrete_rayleigh::DiscreteRayleigh;
pub use discretised::{Discretised, MethodOf};
pub use driven::DiscreteDriven;
pub use error::{Quantity, StepError};
pub use flow::{BoundedFlow, Flow, Memory};
pub use force_work::{EnergyExchange, ForceWork};
pub use in_lanes::DiscreteInLanes;
pub(crate) use in_lanes::{KeptOf, MemoryInLanes};
pub use kernel::{Momenta, MomentaBy, StepKernel};
pub(crate) use legendre::require_regular;
pub(crate) use linearization::invert;
pub use linearization::{LegendreDerivatives, Linearization, PhaseMatrix, StateBy};
pub(crate) use outcome::EquationAt;
pub use outcome::{BoundedStep, Report, Step, StepWith};
pub use parameters::DiscreteParameters;
pub use second_order::{DiscreteSecondOrder, StartByInput, StepHessian};
pub use segment::DiscreteSegment;
pub(crate) use solve::{or_without_guess, require_step_size, step_by, step_within_by};
pub(crate) use solved_for_velocity::ClosedForm;
pub use solved_for_velocity::SolvedForVelocity;
pub(crate) use start::{of_equation_and_step, verify_momenta, verify_start};
pub use state::State;
pub use taken::{Linearizable, StepTaken};
pub use velocity_history::VelocityHistory;
