//! Controllers of the scenes with a closed loop, for states x = (q, p) and a model that gives its step with A
//! and B: the linear-quadratic regulator, iterative LQR over a horizon, and the extended Kalman filter; and
//! the clock of a sensor.

mod regulator;

use anyhow::{Context, Result};
use dalembert::nalgebra::{SMatrix, SVector};
use dalembert::step::DiscreteDriven;
use dalembert::{Discrete, Discretise, Midpoint, State, StepError};

pub use regulator::Regulator;

/// A step of the model with its derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Linearised<const X: usize, const M: usize> {
    /// x₁ = (q1, p1).
    pub next: SVector<f64, X>,
    /// ∂x₁/∂x₀.
    pub a: SMatrix<f64, X, X>,
    /// ∂x₁/∂u.
    pub b: SMatrix<f64, X, M>,
}

/// x = (q, p); X = 2N.
pub fn vector<const N: usize, const X: usize>(state: &State<f64, N>) -> SVector<f64, X> {
    const { assert!(X == 2 * N) };
    SVector::from_fn(|i, _| if i < N { state.q[i] } else { state.p[i - N] })
}

/// (q, p) of x; X = 2N.
pub fn state<const N: usize, const X: usize>(x: &SVector<f64, X>) -> State<f64, N> {
    const { assert!(X == 2 * N) };
    State { q: SVector::from_fn(|i, _| x[i]), p: SVector::from_fn(|i, _| x[N + i]) }
}

/// The midpoint step from `x` of a system with its input held.
///
/// # Errors
/// Those of [`Discretised::step`](dalembert::Discretised::step).
pub fn advance<L, const N: usize, const X: usize>(
    system: &L,
    x: &SVector<f64, X>,
    h: f64,
) -> Result<SVector<f64, X>, StepError>
where
    L: Discrete<Midpoint, N, Scalar = f64>,
{
    Ok(vector(&system.by(Midpoint, h).step(&state(x))?.state))
}

/// The same with A and B.
///
/// # Errors
/// Those of [`Discretised::step`](dalembert::Discretised::step).
pub fn linearised<L, const N: usize, const M: usize, const X: usize>(
    system: &L,
    x: &SVector<f64, X>,
    h: f64,
) -> Result<Linearised<X, M>, StepError>
where
    L: DiscreteDriven<Midpoint, N, M, Scalar = f64>,
{
    let step = system.by(Midpoint, h).linearized(&state(x))?;
    let (a, b) = (step.by_state()?.assembled(), step.by_input()?.assembled());
    Ok(Linearised { next: vector(&step.step().state), a, b })
}

/// A cost near a point, to second order: ½ δxᵀ(xx)δx + x·δx, and the same for u.
#[derive(Clone, Copy, Debug)]
pub struct Quadratic<const X: usize, const M: usize> {
    /// The cost at the point.
    pub value: f64,
    /// Its gradient by x.
    pub x: SVector<f64, X>,
    /// Its Hessian by x, or the Gauss–Newton part of it.
    pub xx: SMatrix<f64, X, X>,
    /// Its gradient by u.
    pub u: SVector<f64, M>,
    /// Its Hessian by u.
    pub uu: SMatrix<f64, M, M>,
}

/// A problem of optimal control over a horizon of steps.
pub trait Problem<const X: usize, const M: usize> {
    /// The model's step.
    ///
    /// # Errors
    /// Those of [`Discretised::step`](dalembert::Discretised::step).
    fn advance(&self, x: &SVector<f64, X>, u: &SVector<f64, M>) -> Result<SVector<f64, X>, StepError>;

    /// The model's step with its derivatives.
    ///
    /// # Errors
    /// Those of [`Discretised::step`](dalembert::Discretised::step).
    fn linearised(&self, x: &SVector<f64, X>, u: &SVector<f64, M>) -> Result<Linearised<X, M>, StepError>;

    /// The cost of being at `x` and using `u` in step `k`; at the end of the horizon u is 0 and costs
    /// nothing.
    ///
    /// # Errors
    /// Those of [`State::velocity`].
    fn cost(&self, k: usize, x: &SVector<f64, X>, u: &SVector<f64, M>) -> Result<Quadratic<X, M>, StepError>;
}

/// States and inputs over a horizon, with the feedback that corrects what goes another way.
#[derive(Clone, Debug)]
pub struct Plan<const X: usize, const M: usize> {
    /// x₀ … x_K.
    pub states: Vec<SVector<f64, X>>,
    /// u₀ … u_{K−1}.
    pub inputs: Vec<SVector<f64, M>>,
    /// G₀ … G_{K−1}: u = uₖ + Gₖ (x − xₖ).
    pub gains: Vec<SMatrix<f64, M, X>>,
    /// The cost of it all.
    pub cost: f64,
}

impl<const X: usize, const M: usize> Plan<X, M> {
    /// What the model does from `start` under `inputs`.
    ///
    /// # Errors
    /// Those of [`Discretised::step`](dalembert::Discretised::step).
    pub fn new(
        problem: &impl Problem<X, M>,
        start: SVector<f64, X>,
        inputs: Vec<SVector<f64, M>>,
    ) -> Result<Self, StepError> {
        let gains = vec![SMatrix::zeros(); inputs.len()];
        let states = vec![start; inputs.len() + 1];
        let open_loop = Self { states, inputs, gains, cost: 0.0 };
        open_loop.followed(problem, start, &vec![SVector::zeros(); open_loop.inputs.len()], 1.0)
    }

    /// The plan followed from `start`, its inputs changed by `share` × `changes` and by the feedback.
    fn followed(
        &self,
        problem: &impl Problem<X, M>,
        start: SVector<f64, X>,
        changes: &[SVector<f64, M>],
        share: f64,
    ) -> Result<Self, StepError> {
        let mut next = Self { states: vec![start], inputs: Vec::new(), gains: self.gains.clone(), cost: 0.0 };
        let mut x = start;
        for (k, change) in changes.iter().enumerate() {
            let u = self.inputs[k] + change * share + self.gains[k] * (x - self.states[k]);
            next.cost += problem.cost(k, &x, &u)?.value;
            x = problem.advance(&x, &u)?;
            next.states.push(x);
            next.inputs.push(u);
        }
        next.cost += problem.cost(changes.len(), &x, &SVector::zeros())?.value;
        Ok(next)
    }

    /// One iteration of iterative LQR from `start`: linearise along the plan, solve the linear-quadratic
    /// problem backwards, follow its answer forwards with the longest share of 1, ½, ¼ … that lowers the
    /// cost. Nothing if none does.
    ///
    /// # Errors
    /// Those of [`Discretised::step`](dalembert::Discretised::step) along the plan itself; a trial that
    /// cannot be stepped is a share too long.
    pub fn improved(
        &self,
        problem: &impl Problem<X, M>,
        start: SVector<f64, X>,
        damping: f64,
    ) -> Result<Option<Self>, StepError> {
        let end = problem.cost(self.inputs.len(), &self.states[self.inputs.len()], &SVector::zeros())?;
        let (mut slope, mut curvature) = (end.x, end.xx);
        let mut changes = vec![SVector::zeros(); self.inputs.len()];
        let mut following = self.clone();
        for k in (0..self.inputs.len()).rev() {
            let (x, u) = (&self.states[k], &self.inputs[k]);
            let cost = problem.cost(k, x, u)?;
            let Linearised { a, b, .. } = problem.linearised(x, u)?;
            let damped = curvature + SMatrix::identity() * damping;
            let by_u = cost.u + b.transpose() * slope;
            let uu = cost.uu + b.transpose() * damped * b;
            let ux = b.transpose() * damped * a;
            let Some(factor) = uu.cholesky() else { return Ok(None) };
            let (change, gain) = (-factor.solve(&by_u), -factor.solve(&ux));
            let exact_uu = cost.uu + b.transpose() * curvature * b;
            let exact_ux = b.transpose() * curvature * a;
            slope = cost.x
                + a.transpose() * slope
                + gain.transpose() * (exact_uu * change + by_u)
                + exact_ux.transpose() * change;
            curvature = cost.xx
                + a.transpose() * curvature * a
                + gain.transpose() * exact_uu * gain
                + gain.transpose() * exact_ux
                + exact_ux.transpose() * gain;
            curvature = (curvature + curvature.transpose()) * 0.5;
            changes[k] = change;
            following.gains[k] = gain;
        }
        for halvings in 0..8 {
            let share = 0.5_f64.powi(halvings);
            if let Ok(next) = following.followed(problem, start, &changes, share)
                && next.cost < self.cost
            {
                return Ok(Some(next));
            }
        }
        Ok(None)
    }
}

/// The estimate of an extended Kalman filter.
#[derive(Clone, Copy, Debug)]
pub struct Estimate<const X: usize> {
    /// The state believed.
    pub x: SVector<f64, X>,
    /// Its covariance.
    pub covariance: SMatrix<f64, X, X>,
}

impl<const X: usize> Estimate<X> {
    /// The estimate one step on, `noise` being the covariance of what the model does not know.
    pub fn predicted<const M: usize>(&self, model: &Linearised<X, M>, noise: &SMatrix<f64, X, X>) -> Self {
        Self { x: model.next, covariance: model.a * self.covariance * model.a.transpose() + noise }
    }

    /// The estimate after a measurement `y` = `c` x + noise.
    ///
    /// # Errors
    /// The covariance of the innovation is not positive definite.
    pub fn corrected<const Y: usize>(
        &self,
        y: &SVector<f64, Y>,
        c: &SMatrix<f64, Y, X>,
        noise: &SMatrix<f64, Y, Y>,
    ) -> Result<Self> {
        let spread = c * self.covariance * c.transpose() + noise;
        let factor = spread.cholesky().context("the innovation has no positive covariance")?;
        let gain = factor.solve(&(c * self.covariance)).transpose();
        // Joseph's form stays symmetric and positive.
        let rest = SMatrix::<f64, X, X>::identity() - gain * c;
        let covariance = rest * self.covariance * rest.transpose() + gain * noise * gain.transpose();
        Ok(Self { x: self.x + gain * (y - c * self.x), covariance })
    }
}

/// A sensor that measures at times of its own, whatever the steps of the plant and the periods of the
/// controller.
#[derive(Clone, Copy, Debug)]
pub struct SensorClock {
    /// The time of the first measurement.
    pub first: f64,
    /// The time from one to the next.
    pub every: f64,
    count: u32,
}

impl SensorClock {
    /// A clock of which no time has passed.
    #[must_use]
    pub fn new(first: f64, every: f64) -> Self {
        Self { first, every, count: 0 }
    }

    /// The times before `end` that have not passed yet; they pass.
    pub fn times_before(&mut self, end: f64) -> impl Iterator<Item = f64> {
        std::iter::from_fn(move || {
            let time = self.first + self.every * f64::from(self.count);
            (time < end).then(|| {
                self.count += 1;
                time
            })
        })
    }
}
