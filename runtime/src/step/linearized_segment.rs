//! The equations of a step by formulas, linearised and factored once.

use nalgebra::{SMatrix, SVector};

use crate::step::discrete::explained_on;
use crate::step::{
    Border, BorderParameters, ByFormula, ClosedForm, Discrete, DiscreteObjects, Flow, Formulas,
    LegendreDerivatives, Linearizable, MomentaBy, PhaseMatrix, Segment, State, StateBy, Step, StepError,
};

/// The derivatives of both Legendre transforms on the segment of a step, and what dp0 makes of q1.
pub struct LinearizedSegment<'a, L: ClosedForm<R, N>, R, const N: usize> {
    pub(crate) on: Formulas<'a, L, R, N>,
    pub(crate) k: LegendreDerivatives<L::Scalar, N>,
    /// ∂q1/∂p0: K01⁻¹, on constraints along them.
    pub(crate) q_by_p: SMatrix<L::Scalar, N, N>,
    border: <L::Border as Border<L, R, N>>::Linearized,
}

impl<L: ClosedForm<R, N> + Discrete<R, N>, R, const N: usize> LinearizedSegment<'_, L, R, N> {
    /// The derivatives of (q1, p1) by what moves the momenta so at fixed ends.
    pub(crate) fn answer<const M: usize>(
        &self,
        momenta: &MomentaBy<L::Scalar, N, M>,
    ) -> Result<StateBy<L::Scalar, N, M>, StepError> {
        <L::Border as Border<L, R, N>>::answer(&self.k, &self.q_by_p, &self.border, momenta)
            .map_err(|error| self.explained(error))
    }

    /// [`answer`](Self::answer) where it is an input that moves the momenta, and by `at_end` the forces at
    /// (q, v) of the end.
    pub(crate) fn answer_input<const M: usize>(
        &self,
        momenta: &MomentaBy<L::Scalar, N, M>,
        at_end: impl Fn(&SVector<L::Scalar, N>, &SVector<L::Scalar, N>) -> SMatrix<L::Scalar, N, M>,
    ) -> Result<StateBy<L::Scalar, N, M>, StepError> {
        let (k, border) = (&self.k, &self.border);
        <L::Border as Border<L, R, N>>::answer_input(k, &self.q_by_p, border, momenta, at_end)
            .map_err(|error| self.explained(error))
    }

    /// [`answer`](Self::answer) where it is the parameters that move the momenta.
    pub(crate) fn answer_parameters<const P: usize>(
        &self,
        momenta: &MomentaBy<L::Scalar, N, P>,
    ) -> Result<StateBy<L::Scalar, N, P>, StepError>
    where
        L::Border: BorderParameters<L, R, N, P>,
    {
        let (system, segment) = (self.on.system, self.on.segment());
        <L::Border as BorderParameters<L, R, N, P>>::answer_parameters(
            system,
            segment,
            &self.k,
            &self.q_by_p,
            &self.border,
            momenta,
        )
        .map_err(|error| self.explained(error))
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
        linearized_from(self.on(&Segment { q0: state.q, v: step.velocity, h })?, Some(&state.p))
    }

    fn linearized_on<'a>(on: Formulas<'a, L, R, N>) -> Result<LinearizedSegment<'a, L, R, N>, StepError>
    where
        L: 'a,
    {
        linearized_from(on, None)
    }

    fn by_state(at: &LinearizedSegment<'_, L, R, N>) -> Result<PhaseMatrix<L::Scalar, N>, StepError> {
        <L::Border as Border<L, R, N>>::by_state(&at.k, &at.q_by_p, &at.border)
            .map_err(|error| at.explained(error))
    }
}

/// The equations on a segment; of a step that was taken from the momentum `p0`, if there is one.
fn linearized_from<'a, L, R, const N: usize>(
    on: Formulas<'a, L, R, N>,
    p0: Option<&SVector<L::Scalar, N>>,
) -> Result<LinearizedSegment<'a, L, R, N>, StepError>
where
    R: ByFormula,
    L: ClosedForm<R, N> + Flow<R, N>,
{
    let k = on.legendre_derivatives()?;
    let (q_by_p, border) = <L::Border as Border<L, R, N>>::linearized(on.system, on.segment(), p0, &k)
        .map_err(|error| explained_on::<L, R, N>(on.system, on.segment(), error))?;
    Ok(LinearizedSegment { on, k, q_by_p, border })
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
        .and_then(|k| {
            let (q_by_p, border) =
                <L::Border as Border<L, R, N>>::linearized(system, &segment, Some(&state.p), &k)?;
            <L::Border as Border<L, R, N>>::by_state(&k, &q_by_p, &border)
        })
        .map_err(|error| explained_on::<L, R, N>(system, &segment, error))
}
