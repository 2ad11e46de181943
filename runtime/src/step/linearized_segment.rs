//! The equations of a step by formulas, linearised and factored once.

use nalgebra::SMatrix;

use crate::step::discrete::explained_on;
use crate::step::{
    ByFormula, ClosedForm, Discrete, DiscreteObjects, Flow, Formulas, LegendreDerivatives, Linearizable,
    MomentaBy, PhaseMatrix, Segment, State, StateBy, Step, StepError, invert,
};

/// The derivatives of both Legendre transforms on the segment of a step, and what dp0 makes of q1.
pub struct LinearizedSegment<'a, L: ClosedForm<R, N>, R, const N: usize> {
    pub(crate) on: Formulas<'a, L, R, N>,
    pub(crate) k: LegendreDerivatives<L::Scalar, N>,
    /// K01⁻¹.
    pub(crate) q_by_p: SMatrix<L::Scalar, N, N>,
}

impl<L: ClosedForm<R, N> + Discrete<R, N>, R, const N: usize> LinearizedSegment<'_, L, R, N> {
    /// The derivatives of (q1, p1) by what moves the momenta so at fixed ends.
    pub(crate) fn answer<const M: usize>(
        &self,
        momenta: &MomentaBy<L::Scalar, N, M>,
    ) -> Result<StateBy<L::Scalar, N, M>, StepError> {
        self.k.answer(&self.q_by_p, momenta).map_err(|error| self.explained(error))
    }

    fn explained(&self, error: StepError) -> StepError {
        explained_on::<L, R, N>(self.on.system, self.on.segment(), error)
    }
}

impl<L, R, const N: usize> Linearizable<R, N> for L
where
    R: ByFormula,
    L: ClosedForm<R, N> + Flow<R, N>,
{
    type Linearized<'a>
        = LinearizedSegment<'a, L, R, N>
    where
        L: 'a;

    fn linearized<'a>(
        &'a self,
        _: &Self::RunMemory,
        state: &State<L::Scalar, N>,
        step: &Step<L::Scalar, N>,
        h: L::Scalar,
    ) -> Result<LinearizedSegment<'a, L, R, N>, StepError> {
        Self::linearized_on(self.on(&Segment { q0: state.q, v: step.velocity, h })?)
    }

    fn linearized_on<'a>(on: Formulas<'a, L, R, N>) -> Result<LinearizedSegment<'a, L, R, N>, StepError>
    where
        L: 'a,
    {
        const {
            assert!(
                !L::IS_CONSTRAINED,
                "of a step on constraints there is the derivative by its state: `by.linearized_step(&state)`"
            );
        }
        let k = on.legendre_derivatives()?;
        let q_by_p =
            invert(&k.p0_by_q1).map_err(|error| explained_on::<L, R, N>(on.system, on.segment(), error))?;
        Ok(LinearizedSegment { on, k, q_by_p })
    }

    fn by_state(at: &LinearizedSegment<'_, L, R, N>) -> Result<PhaseMatrix<L::Scalar, N>, StepError> {
        at.k.step_matrix_with(&at.q_by_p).map_err(|error| at.explained(error))
    }
}

/// A of a step by a rule that has formulas.
pub(crate) fn step_matrix<L, R, const N: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
    step: &Step<L::Scalar, N>,
    h: L::Scalar,
) -> Result<PhaseMatrix<L::Scalar, N>, StepError>
where
    L: ClosedForm<R, N> + Discrete<R, N> + ?Sized,
{
    let segment = Segment { q0: state.q, v: step.velocity, h };
    system
        .on(&segment)?
        .legendre_derivatives()
        .and_then(|k| k.step_matrix())
        .map_err(|error| explained_on::<L, R, N>(system, &segment, error))
}
