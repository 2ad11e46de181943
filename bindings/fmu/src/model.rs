//! Instances of any system: the boundary calls [`Model`] and knows nothing of systems.

use dalembert_face::Number;

use crate::refusal::Refusal;

/// An instance behind the functions of FMI. A call that fails has changed nothing.
pub trait Model {
    /// The time.
    fn time(&self) -> f64;
    /// A number of the type of each of these variables.
    fn kinds(&self, references: &[u32]) -> Result<Vec<Number>, Refusal>;
    /// The values of these variables.
    fn values(&self, references: &[u32]) -> Result<Vec<Number>, Refusal>;
    /// Sets variables.
    fn set_values(&mut self, references: &[u32], values: &[Number]) -> Result<(), Refusal>;
    /// Into initialization mode.
    fn enter_initialization(&mut self, start_time: f64) -> Result<(), Refusal>;
    /// Begins the run.
    fn exit_initialization(&mut self) -> Result<(), Refusal>;
    /// Steps from `point` over `size`.
    fn step(&mut self, point: f64, size: f64) -> Result<(), Refusal>;
    /// Ends the run.
    fn terminate(&mut self) -> Result<(), Refusal>;
    /// As it was instantiated.
    fn reset(&mut self);
    /// Σ ∂unknown/∂known seed, for each unknown.
    fn directional_derivative(
        &self,
        unknowns: &[u32],
        knowns: &[u32],
        seed: &[f64],
    ) -> Result<Vec<f64>, Refusal>;
    /// A copy, which goes on as this would.
    fn copy(&self) -> Box<dyn Model>;
    /// The state as bytes.
    fn bytes(&self) -> Vec<u8>;
    /// The state of these bytes.
    fn of_bytes(&self, bytes: &[u8]) -> Result<Box<dyn Model>, Refusal>;
}
