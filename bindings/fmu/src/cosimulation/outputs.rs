//! Outputs of the block: values at the state and the input of the communication point.

use dalembert::nalgebra::SVector;
use dalembert::system::Scalar;
use dalembert_face::Interface;

use super::CoSimulation;
use crate::model::Model;
use crate::refusal::Refusal;
use crate::variables::Variable;

impl<I: Interface<N>, const N: usize> CoSimulation<I, N> {
    /// All outputs at (q, v), with the input as it is, now.
    pub(super) fn outputs(&self, q: &SVector<I::Scalar, N>, v: &SVector<I::Scalar, N>) -> Vec<I::Scalar> {
        let (input, now) = Self::given(&self.input, self.time());
        I::outputs(&I::view(&self.system, input, now), q, v).as_ref().to_vec()
    }

    /// The value of an output, if it is a number.
    pub(super) fn output(&self, of: &Variable, value: I::Scalar) -> Result<I::Scalar, Refusal> {
        let wide = value.widen();
        if wide.is_finite() {
            Ok(value)
        } else {
            Err(Refusal::Output { name: of.name.clone(), value: wide, time: self.time() })
        }
    }
}
