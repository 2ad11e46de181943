//! The memory of a run of steps by a Gauss rule.

use core::array;

use nalgebra::SVector;

use super::coefficients::Coefficients;
use super::problem::{Problem, Solution, Solver};
use super::slack::{Allowance, Slack, Swept, sweep};
use super::solve::solve;
use super::{Completed, Gauss, by_matrices, completed, fixed_point, solved_from};
use crate::numbers::{
    Compensated, LaneVector, Lanes, Scalar,
    lanes::{lane, splat, write_lane},
};
use crate::step::{Memory, Quantity, State, Step, StepError};
use crate::system::ForcedLagrangian;

/// The stages of the last step, and what rounding has taken from q and p.
///
/// The polynomial through the stages' velocities, one step on, is the guess for the next. The rests of q and
/// p are added before they are forgotten (W. Kahan 1965); they are used only where the run goes on from the
/// very state that they belong to.
#[derive(Clone, Copy, Debug)]
pub struct StageHistory<T, const N: usize, const S: usize> {
    /// The velocities V_i of the last step.
    pub(super) v: LaneVector<T, N, S>,
    /// Its step size; 0 before the first step.
    h: T,
    /// The method that solved it.
    solver: Solver,
    q: Compensated<T, N>,
    p: Compensated<T, N>,
    /// The error that stages may be left with; `None` where they are solved to rounding.
    slack: Option<Slack<T>>,
    /// The velocity to start from before the first step.
    suggested: Option<SVector<T, N>>,
    /// Whether the next step starts near the end of the last.
    is_corrected: bool,
}

impl<T: Scalar, const N: usize, const S: usize> Default for StageHistory<T, N, S> {
    fn default() -> Self {
        let zero = SVector::zeros();
        Self {
            v: splat(&zero),
            h: T::zero(),
            solver: Solver::Newton,
            q: Compensated::new(zero),
            p: Compensated::new(zero),
            slack: None,
            suggested: None,
            is_corrected: false,
        }
    }
}

impl<T: Scalar, const N: usize, const S: usize> StageHistory<T, N, S> {
    /// The last two coefficients, of all coordinates the largest, of the velocity over the last step in
    /// Legendre polynomials: what is left of a smooth motion, and where it is not smooth, of its kinks.
    pub(crate) fn unresolved(&self) -> [f64; 2] {
        let coefficients = &Gauss::<S>::COEFFICIENTS;
        let (mut last, mut before) = ([0.0; S], [0.0; S]);
        for j in 0..S {
            let (x, mut p) = (2.0 * coefficients.nodes[j] - 1.0, (0.0, 1.0));
            for k in 0..S - 1 {
                let k = k as f64;
                p = (p.1, ((2.0 * k + 1.0) * x * p.1 - k * p.0) / (k + 1.0));
            }
            last[j] = (2 * S - 1) as f64 * coefficients.weights[j] * p.1;
            before[j] = (2 * S) as f64 * coefficients.weights[j] * p.0;
        }
        let sum = |a: usize, weights: &[f64; S]| {
            let terms = weights.iter().zip(&self.v[a].0);
            nalgebra::ComplexField::abs(terms.map(|(weight, v)| weight * v.widen()).sum::<f64>())
        };
        [before, last].map(|weights| (0..N).fold(0.0, |largest, a| sum(a, &weights).max(largest)))
    }

    /// The method that solved the last step; Newton's before the first.
    pub(crate) fn solver(&self) -> Solver {
        self.solver
    }

    /// The memory of a step with velocities `v` that led to `ends`, q and p.
    pub(super) fn of_step(
        v: &[SVector<T, N>; S],
        h: T,
        solver: Solver,
        ends: [Compensated<T, N>; 2],
    ) -> Self {
        let [q, p] = ends;
        let mut history = Self { h, solver, q, p, ..Self::default() };
        for (i, v) in v.iter().enumerate() {
            write_lane(&mut history.v, i, v);
        }
        history
    }

    /// q and p at the end of the last step.
    pub(super) fn ends(&self) -> [Compensated<T, N>; 2] {
        [self.q, self.p]
    }

    /// V_i, the velocities at the stages of the last step: at q0 + h Σ a_ij V_j its equations of motion hold.
    /// 0 before the first.
    pub fn velocities(&self) -> [SVector<T, N>; S] {
        array::from_fn(|i| lane(&self.v, i))
    }

    /// Solves the stages as far as an error of `error` after so many steps needs, and to rounding from there
    /// on. `weight` is what an error of p counts beside one of q before the first step; 0 if not known.
    pub(crate) fn leave(&mut self, error: f64, steps: u64, weight: f64) {
        self.slack = Some(Slack::new(error, steps, weight));
    }

    /// This memory with another slack for the steps to come.
    pub(super) fn with_slack(self, slack: Option<Slack<T>>) -> Self {
        Self { slack, ..self }
    }

    /// The error that the steps to come may leave; `None` where they are solved to rounding.
    pub(super) fn slack(&self) -> Option<Slack<T>> {
        self.slack
    }

    /// Lets go of the last step, but not of what the steps to come may leave unsolved.
    pub(crate) fn forget(&mut self) {
        *self = Self { slack: self.slack, ..Self::default() };
    }

    /// Q_i and V_i of the last step, from q0 by h.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn visit_stages(
        &self,
        q0: &SVector<T, N>,
        h: T,
        mut visit: impl FnMut(usize, &SVector<T, N>, &SVector<T, N>),
    ) {
        let Coefficients { weights, shares, .. } = &Gauss::<S>::COEFFICIENTS;
        let steps = Lanes::constants(weights) * h;
        let mut q = self.v;
        for a in 0..N {
            let terms = self.v[a] * steps;
            let mut sums = [Lanes::splat(T::zero()); 2];
            for j in 0..S {
                sums[j % 2] = Lanes::constants(&shares[j]).times_plus(false, terms.0[j], sums[j % 2]);
            }
            q[a] = (sums[0] + sums[1]) + q0[a];
        }
        for i in 0..S {
            visit(i, &lane(&q, i), &lane(&self.v, i));
        }
    }

    /// (q, v) at a share τ of the last step: v = Σ ℓ_j(τ) V_j and q = q0 + h Σ V_j ∫ℓ_j, by the series in
    /// Legendre polynomials that the coefficients come from.
    fn polynomial(&self, q0: &SVector<T, N>, h: T, share: f64) -> [SVector<T, N>; 2] {
        let Coefficients { nodes, weights, .. } = &Gauss::<S>::COEFFICIENTS;
        let x = 2.0 * share - 1.0;
        let [mut q, mut v] = [nalgebra::zero::<SVector<T, N>>(); 2];
        for j in 0..S {
            let at_node = 2.0 * nodes[j] - 1.0;
            // P_{k−1}, P_k at the node and at x.
            let (mut of_node, mut of_x) = ((0.0, 1.0), (0.0, 1.0));
            let (mut value, mut integral) = (0.0, share);
            for k in 0..S {
                let degree = k as f64;
                let next = |x: f64, (before, p): (f64, f64)| {
                    (p, ((2.0 * degree + 1.0) * x * p - degree * before) / (degree + 1.0))
                };
                value += (2.0 * degree + 1.0) * of_node.1 * of_x.1;
                let following = next(x, of_x);
                if k > 0 {
                    integral += 0.5 * of_node.1 * (following.1 - of_x.0);
                }
                (of_node, of_x) = (next(at_node, of_node), following);
            }
            let velocity: SVector<T, N> = lane(&self.v, j);
            v += velocity * T::constant(weights[j] * value);
            q += velocity * T::constant(weights[j] * integral);
        }
        [q0 + q * h, v]
    }

    /// The velocities at the stages of a step that is the beginning of the last, its `share`: of the
    /// polynomial.
    fn of_beginning(&self, share: T) -> LaneVector<T, N, S> {
        let Coefficients { nodes, legendre, .. } = &Gauss::<S>::COEFFICIENTS;
        let one = Lanes::splat(T::one());
        let x = Lanes::constants(nodes) * (share + share) + (T::zero() - T::one());
        // P_{k−1} and P_k at all stages.
        let (mut before, mut p) = (Lanes::splat(T::zero()), one);
        let mut v = splat(&SVector::zeros());
        for (k, row) in legendre.iter().enumerate() {
            for (v, of_step) in v.iter_mut().zip(&self.v) {
                let terms = row.iter().zip(&of_step.0).map(|(&factor, &v)| T::constant(factor) * v);
                let coefficient = terms.fold(T::zero(), |sum, term| sum + term);
                *v = p.times_plus(false, coefficient, *v);
            }
            let k = k as f64;
            let [along, back] = [(2.0 * k + 1.0) / (k + 1.0), k / (k + 1.0)].map(T::constant);
            (before, p) = (p, (x * p) * along - before * back);
        }
        v
    }

    fn extrapolation(&self, is_fused: bool) -> LaneVector<T, N, S> {
        let columns = &Gauss::<S>::COEFFICIENTS.extrapolation;
        let mut extrapolated = self.v;
        for a in 0..N {
            let mut sums = [Lanes::splat(T::zero()); 2];
            for j in 0..S {
                sums[j % 2] = Lanes::constants(&columns[j]).times_plus(is_fused, self.v[a].0[j], sums[j % 2]);
            }
            extrapolated[a] = sums[0] + sums[1];
        }
        extrapolated
    }

    /// The extrapolation, moved by what the velocity `v` at the start of the next step differs from that at
    /// the end of the last.
    #[cold]
    #[inline(never)]
    fn moved_extrapolation(&self, is_fused: bool, v: &SVector<T, N>) -> LaneVector<T, N, S> {
        let coefficients = &Gauss::<S>::COEFFICIENTS;
        // ℓ_j(1) = b_j Σ (2k + 1) P_k(2c_j − 1).
        let at_end: [T; S] = array::from_fn(|j| {
            let (x, mut p, mut sum) = (2.0 * coefficients.nodes[j] - 1.0, (0.0, 1.0), 0.0);
            for k in 0..S {
                let k = k as f64;
                sum += (2.0 * k + 1.0) * p.1;
                p = (p.1, ((2.0 * k + 1.0) * x * p.1 - k * p.0) / (k + 1.0));
            }
            T::constant(coefficients.weights[j] * sum)
        });
        let mut moved = self.extrapolation(is_fused);
        for a in 0..N {
            let end = (0..S).fold(T::zero(), |end, j| end + at_end[j] * self.v[a].0[j]);
            moved[a] = moved[a] + (v[a] - end);
        }
        moved
    }
}

impl<T: Scalar, const N: usize, const S: usize> StageHistory<T, N, S> {
    /// Keeps what a step of size `h` from `state` leaves for the next.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn follow_to(
        &mut self,
        state: &State<T, N>,
        solution: &Solution<T, N, S>,
        h: T,
        (step, [q, p]): Completed<T, N>,
    ) -> Step<T, N> {
        (self.v, self.h, self.solver) = (solution.v, h, solution.solver);
        (self.q, self.p, self.suggested, self.is_corrected) = (q, p, None, false);
        if let Some(slack) = &mut self.slack {
            slack.follow(state, &step.state);
        }
        step
    }

    /// The step without the fixed point.
    #[cold]
    #[inline(never)]
    fn advance_by_matrices<L: ForcedLagrangian<N, Scalar = T>>(
        &mut self,
        problem: &Problem<'_, L, N, S>,
        state: &State<T, N>,
    ) -> Option<Step<T, N>> {
        let (solution, completed) = by_matrices(problem, state)?;
        Some(self.follow_to(state, &solution, problem.h, completed))
    }
}

impl<T, L, const N: usize, const S: usize> Memory<L, Gauss<S>, N> for StageHistory<T, N, S>
where
    T: Scalar,
    L: ForcedLagrangian<N, Scalar = T>,
{
    #[inline]
    fn advance(&mut self, system: &L, state: &State<T, N>, h: T) -> Result<Step<T, N>, StepError> {
        crate::step::require_step_size(h)?;
        let goes_on = self.h != T::zero() && self.q.value == state.q && self.p.value == state.p;
        let (q0, p0) = if goes_on {
            (self.q, self.p)
        } else {
            StepError::require_finite(&state.q, Quantity::Configuration)?;
            StepError::require_finite(&state.p, Quantity::Momentum)?;
            (Compensated::new(state.q), Compensated::new(state.p))
        };
        let problem = Problem::<'_, L, N, S>::new(system, q0, p0, h);
        let is_fused = L::STRUCTURE.fused_multiply_add;
        let guess = match h == self.h && self.solver == Solver::FixedPoint {
            true if goes_on => Some(self.extrapolation(is_fused)),
            true if self.is_corrected => Some(self.moved_extrapolation(is_fused, &state.velocity(system)?)),
            _ => None,
        };
        let swept = if let Some(allowance) = self.slack.and_then(|slack| slack.allowance(h, &p0.value)) {
            let guess = match guess {
                Some(guess) => guess,
                None => splat(&state.velocity(system)?),
            };
            within(&problem, &guess, &allowance)
        } else {
            guess.and_then(|guess| fixed_point::iterate(&problem, &guess))
        };
        let solution = match swept {
            Some(solution) => solution,
            None => {
                let near = self.suggested.and_then(|v| solve(&problem, &v).ok());
                near.map_or_else(|| solved_from(&problem, state), Ok)?
            }
        };
        match completed(&problem, &solution) {
            Ok(completed) => Ok(self.follow_to(state, &solution, h, completed)),
            Err(error) => self.advance_by_matrices(&problem, state).ok_or(error),
        }
    }

    fn suggest(&mut self, velocity: &SVector<T, N>, _h: T) {
        self.suggested = Some(*velocity);
    }

    /// The polynomial of the velocities is but a guess, of any input.
    fn change_input(&mut self) {}

    fn change_state(&mut self) {
        self.is_corrected = true;
    }

    fn leave_unsolved(&mut self, error: f64, steps: u64) {
        self.leave(error, steps, 0.0);
    }

    const NODES: &'static [f64] = &Gauss::<S>::NODES;

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn at_nodes(&self, q0: &SVector<T, N>, h: T, visit: impl FnMut(usize, &SVector<T, N>, &SVector<T, N>)) {
        self.visit_stages(q0, h, visit);
    }

    fn beginning(&self, system: &L, state: &State<T, N>, h: T, elapsed: T) -> Option<State<T, N>> {
        if self.h != h || h == T::zero() || self.solver != Solver::FixedPoint {
            return None;
        }
        let [q, p] = [state.q, state.p].map(Compensated::new);
        let problem = Problem::<'_, L, N, S>::new(system, q, p, elapsed);
        let solution = fixed_point::iterate(&problem, &self.of_beginning(elapsed / h))?;
        completed(&problem, &solution).ok().map(|(step, _)| step.state)
    }

    fn between(&self, q0: &SVector<T, N>, h: T, share: f64) -> Option<[SVector<T, N>; 2]> {
        Some(self.polynomial(q0, h, share))
    }
}

/// The stages from the velocities `guess`, solved as far as they have to be, if the sweeps contract.
///
/// Apart, so that the loop of runs without slack is compiled as if there were none.
#[inline(never)]
fn within<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>(
    problem: &Problem<'_, L, N, S>,
    guess: &LaneVector<T, N, S>,
    allowance: &Allowance<T>,
) -> Option<Solution<T, N, S>> {
    match sweep(problem, guess, allowance) {
        Swept::Within(solution) => Some(solution),
        Swept::Slow(v, sweeps) => to_rounding(problem, &v, sweeps),
        Swept::Lost => None,
    }
}

/// The stages to rounding from velocities that so many sweeps have led to.
#[cold]
#[inline(never)]
fn to_rounding<T: Scalar, L: ForcedLagrangian<N, Scalar = T>, const N: usize, const S: usize>(
    problem: &Problem<'_, L, N, S>,
    v: &LaneVector<T, N, S>,
    sweeps: u32,
) -> Option<Solution<T, N, S>> {
    let mut solution = fixed_point::iterate(problem, v)?;
    solution.report.iterations += sweeps;
    Some(solution)
}
