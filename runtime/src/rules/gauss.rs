//! Gauss–Galerkin variational integrators, one for each number of stages.

#![allow(clippy::needless_range_loop, reason = "one index runs through several arrays together")]

mod coefficients;
mod curvature;
mod defect;
mod double_double;
mod fixed_point;
mod force;
mod force_work;
mod history;
mod in_lanes;
mod linearised;
mod modes;
mod newton;
mod noise;
mod objects;
mod problem;
mod rounding;
mod segment;
mod sensitivity;
mod simplified;
mod slack;
mod solve;
mod taken;
mod tangent;

use nalgebra::SVector;

use super::SelfAdjoint;
use crate::numbers::{Compensated, Scalar, lanes::splat};
use crate::step::massless::inertia;
use crate::step::{
    Discrete, DiscreteObjects, EquationAt, Flow, LinearizedStep, Quantity, Report, Segment, State, Step,
    StepError, newton::ITERATIONS, of_any_step,
};
use crate::system::ForcedLagrangian;
use coefficients::Coefficients;
pub use history::StageHistory;
pub(crate) use problem::Solver;
use problem::{Problem, Solution};
use segment::SolvedSegment;
pub(crate) use slack::{SLACK, steps_until};
use solve::solve;

/// The Gauss–Galerkin rule of S stages, 1 ≤ S ≤ 8: order 2S, self-adjoint, A-stable; S = 1 is
/// [`Midpoint`](crate::Midpoint) where R does not depend on q, and differs from it by O(h³) a step elsewhere.
///
/// On polynomials q(t) of degree S from q0 to q1, quadrature with the Gauss–Legendre nodes c_i and weights
/// b_i gives L_d = h Σ b_i L(Q_i, V_i). The interior points solve the **forced** equations
///
/// ```text
/// h Σ b_i [(∂L/∂q + f_L) ℓ_ν(c_i) + ∂L/∂v ℓ_ν′(c_i)/h] = 0,   0 < ν < S,   f_L = −∂R/∂v + f
/// f_d^∓ = h Σ b_i f_L·∂Q_i/∂q_{0,1}                            total derivatives, through the interior points
/// p0 = −D1 L_d − f_d⁻,   p1 = D2 L_d + f_d⁺
/// ```
///
/// **Collocation.** That is Gauss collocation on the forced Hamilton equations (Marsden and West 2001,
/// section 2.6, for the unforced ones), and so the step is computed:
///
/// ```text
/// Q_i = q0 + h Σ a_ij V_j,   P_i = p0 + h Σ a_ij G_j,   ∂L/∂v(Q_i, V_i) = P_i,   G = ∂L/∂q + f_L
/// q1 = q0 + h Σ b_j V_j,     p1 = p0 + h Σ b_j G_j
/// ```
///
/// L need not be quadratic in v. The stages come from a fixed-point iteration where it contracts, which is
/// measured. Elsewhere, at large steps and with stiff forces, it is simplified Newton's method, with N
/// equations for each pair of stages, where that contracts, and Newton's method for all S N equations where
/// it does not. Without force the rule is symplectic and keeps the momentum maps of affine generators, ξ(q) =
/// Aq + b, such as translations and rotations; of others to its order. With friction its step has an R_d for
/// n = 1, and for linear systems with CM⁻¹K = KM⁻¹C; for S ≥ 2 in general for no others, not even for a
/// nonlinear V with C = 2aM, where the exact motion has one
/// ([`rayleigh_step`](crate::Discretised::rayleigh_step)).
///
/// Where L does not hold the velocity of a coordinate that friction damps, ∂L/∂v = 0 = P at the stages leaves
/// G = 0 there, and p1 = p0 = 0 to rounding: collocation of what remains, of order 2S in q and in the other
/// momenta. The fixed point does not serve, so that each step is one of the matrices.
///
/// A [`Trajectory`](crate::Trajectory) keeps the stages of the last step ([`StageHistory`]), extrapolates
/// them to those of the next, and adds up q and p with compensation.
///
/// The discrete objects solve for the stages between given end points, by Newton's method:
/// [`segment`](crate::Discretised::segment) says where it finds none.
///
/// Every stage sees its own time t0 + c_i h, and the input that is held. Derivatives of the step
/// ([`StepTaken`](crate::derivative::StepTaken)) are exact, by the matrix of all stages, factored once. From
/// the state that it starts from, [`linearized`](crate::Discretised::linearized) takes them at the stages of
/// the step; between two ends, [`segment`](crate::Discretised::segment) solves for the stages first. They
/// neither allocate nor panic.
///
/// **Stack.** The matrix of all stages has (N S)² entries and lives on the stack. Without optimisation it is
/// copied on its way: a step with its derivatives takes 1 to 8 MiB at N S = 64 there, where a thread has 2
/// MiB unless `RUST_MIN_STACK` says more.
///
/// ```
/// use dalembert::{Discretise, Gauss, State, Trajectory, rayleigh_system};
///
/// #[rayleigh_system(rule = gauss)]
/// fn pendulum(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
///     (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
/// }
///
/// let system = Pendulum { r: 0.0 };
/// let start = State::from_velocity(&system, [1.0], [0.0])?;
/// let end = system.by(Gauss::<4>, 0.5).run(start).take(1000).last().unwrap()?.state;
/// assert!((end.energy(&system)? - start.energy(&system)?).abs() < 1e-8);
/// # Ok::<(), dalembert::StepError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Gauss<const S: usize>;

impl<const S: usize> Gauss<S> {
    const COEFFICIENTS: Coefficients<S> = Coefficients::new();

    /// The nodes c_i of the stages, ascending in (0, 1).
    pub(crate) const NODES: [f64; S] = Self::COEFFICIENTS.nodes;
}

/// The step to the stages that were solved for.
#[cfg_attr(not(debug_assertions), inline(always))]
fn completed<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>(
    problem: &Problem<'_, L, N, S>,
    solution: &Solution<T, N, S>,
) -> Result<Completed<T, N>, StepError> {
    let displacement = problem.sum(&solution.v);
    let ends = [problem.q0.plus(&displacement), problem.p0.plus(&problem.sum(&solution.rate))];
    let state = State { q: ends[0].value, p: ends[1].value };
    state.require_reached()?;
    let velocity = displacement / problem.h;
    StepError::require_finite(&velocity, Quantity::Velocity).map_err(StepError::of_reached)?;
    if cfg!(debug_assertions) {
        problem.verify(&solution.v)?;
    }
    Ok((Step { state, velocity, report: solution.report }, ends))
}

impl<T, L, const N: usize, const S: usize> Discrete<Gauss<S>, N> for L
where
    T: Scalar,
    L: ForcedLagrangian<N, Scalar = T>,
{
    type On<'a>
        = SolvedSegment<'a, L, N, S>
    where
        L: 'a;

    const HAS_INTERIOR_POINTS: bool = true;

    fn on<'a>(&'a self, segment: &Segment<T, N>) -> Result<SolvedSegment<'a, L, N, S>, StepError> {
        SolvedSegment::new(self, segment)
    }

    /// The branch by the equations of all stages: ∂p0/∂v̄ = h (∂q1/∂p0)⁻¹ changes sign through infinity at a
    /// conjugate point, which is no fold.
    fn equation_at(
        &self,
        state: &State<T, N>,
        step: &Step<T, N>,
        h: T,
    ) -> Result<EquationAt<T, N>, StepError> {
        let mass = inertia(self, &state.q, &step.velocity, h);
        let equation = |p0, matrix, solved: &SolvedSegment<'_, L, N, S>| EquationAt {
            p0,
            matrix,
            mass,
            on_the_branch_of_the_flow: solved.is_on_the_branch_of_the_flow(),
        };
        // The stages of this very step: several solutions may share its start, or both its ends.
        for guess in [Some(&step.velocity), None] {
            if let Ok((again, solved)) = solved_segment::<_, _, N, S>(self, state, h, guess) {
                let off = step.velocity - again.velocity;
                if off.norm() <= step.velocity.norm() * T::EPSILON.sqrt() {
                    let matrix = solved.variations()?.p0_by_q1 * h;
                    return Ok(equation(state.p + matrix * off, matrix, &solved));
                }
            }
        }
        let solved = SolvedSegment::<'_, L, N, S>::new(self, &Segment { q0: state.q, v: step.velocity, h })?;
        let matrix = solved.variations()?.p0_by_q1 * h;
        Ok(equation(solved.momenta().p0, matrix, &solved))
    }

    /// At the nodes of the segment with the mean velocity: near the stages, which would have to be solved
    /// for. A step verifies its own.
    fn at_nodes(
        &self,
        segment: &Segment<T, N>,
        visit: &mut dyn FnMut(&Self, &SVector<T, N>, &SVector<T, N>),
    ) {
        for node in Gauss::<S>::NODES {
            let share = T::constant(node);
            self.later(segment.h * share, |system| visit(system, &segment.at(share), &segment.v));
        }
    }
}

impl<const S: usize> SelfAdjoint for Gauss<S> {}

impl<T, L, const N: usize, const S: usize> Flow<Gauss<S>, N> for L
where
    T: Scalar,
    L: ForcedLagrangian<N, Scalar = T>,
{
    type RunMemory = StageHistory<T, N, S>;

    const TAKES_MASSLESS: bool = true;

    /// By collocation; `guess` serves all stages.
    fn step(
        &self,
        state: &State<T, N>,
        h: T,
        guess: Option<&SVector<T, N>>,
    ) -> Result<Step<T, N>, StepError> {
        let (problem, solution) = solved::<_, _, N, S>(self, state, h, guess)?;
        match completed(&problem, &solution) {
            Ok((step, _)) => Ok(step),
            Err(error) => by_matrices(&problem, state).map(|(_, (step, _))| step).ok_or(error),
        }
    }

    /// By the stages of the step itself.
    fn linearized_step(
        &self,
        state: &State<T, N>,
        h: T,
        guess: Option<&SVector<T, N>>,
    ) -> Result<LinearizedStep<T, N>, StepError> {
        let (step, solved) = solved_segment::<_, _, N, S>(self, state, h, guess)?;
        Ok((step, solved.by_state()?.matrix()))
    }
}

/// A step and both ends.
type Completed<T, const N: usize> = (Step<T, N>, [Compensated<T, N>; 2]);

/// The stages and the step without the fixed point, which corrects by masses alone: where a residual is 0 in
/// a coordinate that has none, by 0/0.
#[cold]
#[inline(never)]
fn by_matrices<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>(
    problem: &Problem<'_, L, N, S>,
    state: &State<T, N>,
) -> Option<(Solution<T, N, S>, Completed<T, N>)> {
    let solution = solve::by_matrices(problem, &state.velocity(problem.system).ok()?).ok()?;
    let completed = completed(problem, &solution).ok()?;
    Some((solution, completed))
}

/// The stages of the step from `state`; `guess` serves all of them.
#[inline]
fn solved<'a, T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>(
    system: &'a L,
    state: &State<T, N>,
    h: T,
    guess: Option<&SVector<T, N>>,
) -> Result<(Problem<'a, L, N, S>, Solution<T, N, S>), StepError> {
    crate::step::require_step_size(h)?;
    StepError::require_finite(&state.q, Quantity::Configuration)?;
    StepError::require_finite(&state.p, Quantity::Momentum)?;
    let problem = Problem::new(system, Compensated::new(state.q), Compensated::new(state.p), h);
    let solution = match guess {
        Some(v) => {
            StepError::require_finite(v, Quantity::Velocity)?;
            solve(&problem, v).map_err(|error| of_any_step(system, state, true, error))?
        }
        None => solved_from(&problem, state)?,
    };
    Ok((problem, solution))
}

/// The stages from the velocity of the `state`.
#[inline]
fn solved_from<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>(
    problem: &Problem<'_, L, N, S>,
    state: &State<T, N>,
) -> Result<Solution<T, N, S>, StepError> {
    let v = state.velocity(problem.system)?;
    match solve(problem, &v) {
        Err(error @ (StepError::NonFinite { .. } | StepError::NoDerivative { .. })) => {
            from_singular(problem, state, &v).ok_or(error)
        }
        Err(error) => in_parts(problem, &v).ok_or(error),
        solved => solved,
    }
}

/// The stages that those of shorter steps lead to, from the velocity `v` at the start
/// ([`along_h`](crate::numbers::nonlinear::AtLength::along_h)).
#[cold]
#[inline(never)]
fn in_parts<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>(
    problem: &Problem<'_, L, N, S>,
    v: &SVector<T, N>,
) -> Option<Solution<T, N, S>> {
    let Problem { system, q0, p0, h, .. } = *problem;
    let mut stages = splat(v);
    let is_reached = T::along_h(&mut |share| {
        let part = Problem::<'_, L, N, S>::new(system, q0, p0, h * share);
        let found = newton::solve(&part, &stages, ITERATIONS);
        stages = found.map_or(stages, |solution| solution.v);
        found.is_ok()
    });
    if is_reached { newton::solve(problem, &stages, newton::MAX_ITERATIONS).ok() } else { None }
}

/// Where forces do not exist at `v`, as drag at rest may not: the stages from the velocity half a step later
/// without drag; rest itself, where the equations hold next to it.
#[cold]
#[inline(never)]
fn from_singular<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>(
    problem: &Problem<'_, L, N, S>,
    state: &State<T, N>,
    v: &SVector<T, N>,
) -> Option<Solution<T, N, S>> {
    let force = problem.system.lagrangian_gradient(&state.q, v).d1;
    let rest = nalgebra::zero();
    if *v == rest && force == rest {
        let residual =
            |v: &SVector<T, N>| problem.stages(&splat(v)).residual.map(|stages| stages.amax()).into();
        let v = splat(&rest);
        let report = Report { floor: T::SMALLEST_NORMAL, ..Report::of_no_equation() };
        let is_rest = crate::step::newton::is_rest(&residual, &state.p);
        return is_rest.then_some(Solution { v, rate: v, report, solver: Solver::Newton });
    }
    let later = State { q: state.q, p: state.p + force * (problem.h * T::constant(0.5)) };
    solve(problem, &later.velocity(problem.system).ok()?).ok()
}

/// The step from `state`, with its equations linearised at the stages.
fn solved_segment<'a, T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>(
    system: &'a L,
    state: &State<T, N>,
    h: T,
    guess: Option<&SVector<T, N>>,
) -> Result<(Step<T, N>, SolvedSegment<'a, L, N, S>), StepError> {
    let (problem, mut solution) = solved(system, state, h, guess)?;
    let step = match completed(&problem, &solution) {
        Ok((step, _)) => step,
        Err(error) => {
            let (again, (step, _)) = by_matrices(&problem, state).ok_or(error)?;
            solution = again;
            step
        }
    };
    Ok((step, SolvedSegment::of_stages(problem, solution.v)?))
}
