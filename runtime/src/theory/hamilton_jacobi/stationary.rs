//! The stationary Hamilton–Jacobi equation under friction, of an angle: S = min [c S + G].

mod error;
mod periodic;
mod solution;

use core::iter;

use nalgebra::vector;

use crate::numbers::Scalar;
use crate::step::{Discrete, DiscreteRayleigh};
use crate::system::is_timed;
use crate::theory::rayleigh::ProportionalSplit;
use crate::theory::verdict::Tolerance;

pub use error::StationaryError;
use periodic::Cubic;
pub use periodic::{Jet, PeriodicFunction};
pub use solution::StationarySolution;

/// The map T on functions of an angle, for a conformal pair, and its fixed point S*:
/// [`stationary_equation`](ProportionalSplit::stationary_equation).
///
/// ```text
/// (T S)(q1) = min over q0 of c S(q0) + G(q0, q1),     0 < c < 1,     q0 on the line
/// ```
///
/// **Theorem.** T is a contraction by c in the sup norm: one S* = T S*, and S_k → S* as c^k from any S_0.
/// Where S* is differentiable, (q1, dS*(q1)) is the step's image of (q0, dS*(q0)), q0 the minimiser: the
/// graph of dS* is backward invariant.
///
/// *Proof.* Two minima differ by no more than what they are minima of, here by c|S − S′|. Inside, the
/// minimum has c dS*(q0) = −D1G = c p0 and dS*(q1) = D2G = p1: S*, a minimum of smooth functions, bends down
/// at its kinks, and no minimiser is one. ∎ This is discounted weak KAM theory (discrete: X. Su,
/// P. Thieullen, arXiv:1510.00214) for the G of a pair (L_d, R_d).
///
/// **On the grid** S has values and slopes at N points, dT S(q1) = p1 being known at the minimiser. c S + G
/// is looked at at every point within reach, and beside each of its local minima there as a cubic between
/// points. The error of S* and dS* at the points is of order N⁻⁴ and N⁻³, by measurement. With cubics T need
/// not be a contraction (with constants it is, by c); each solution has the ratio that was found.
pub struct StationaryEquation<'s, 'a, L, R>
where
    L: Discrete<R, 1>,
{
    split: &'s ProportionalSplit<'a, L, R, 1>,
    factor: f64,
    period: f64,
    /// How many points q0 lies from q1 at most.
    reach: usize,
    /// G by q0, from q1 less the reach on, for each q1.
    costs: Vec<Vec<Jet>>,
}

/// Fewest points of a grid.
const FEWEST: usize = 16;
/// Periods within which G has to outgrow c S*.
const PERIODS: usize = 8;
/// Error in S* that ends the iteration, in roundings of its terms.
const ROUNDINGS: f64 = 64.0;

/// The stationary equation of an angle.
impl<'a, S, L, R> ProportionalSplit<'a, L, R, 1>
where
    S: Scalar,
    L: DiscreteRayleigh<R, 1, Scalar = S>,
{
    /// The stationary Hamilton–Jacobi equation on a grid of so many `points` over the `period` of q.
    ///
    /// ```
    /// use std::f64::consts::{PI, TAU};
    ///
    /// use dalembert::{Discretise, Trapezoidal, rayleigh_system, samples};
    ///
    /// #[rayleigh_system(rule = trapezoidal)]
    /// fn pendulum(q: [f64; 1], v: [f64; 1], a: f64) -> (f64, f64) {
    ///     (0.5 * v[0] * v[0] + q[0].cos(), a * v[0] * v[0])
    /// }
    /// let (a, h) = (0.25, 0.2);
    /// let pendulum = Pendulum { a };
    /// let by = pendulum.by(Trapezoidal, h);
    /// let proportion = by.proportion(&samples::segments([-3.0], [3.0], [0.3], 20))?;
    /// let split = by.proportional_split(&proportion, [0.0]).expect("κ = ah is constant");
    /// let stationary = split.stationary_equation(TAU, 64)?.solve()?;
    ///
    /// // It contracts by c; upright nothing moves, and at the bottom both ways up are as good.
    /// assert!((stationary.ratio - (1.0 - a * h) / (1.0 + a * h)).abs() < 1e-10);
    /// assert!(stationary.gradient(PI).abs() < 1e-12);
    /// assert_eq!(stationary.kinks.len(), 1);
    /// assert!(stationary.kinks[0].sin().abs() < 2e-3);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// A [`StationaryError`].
    pub fn stationary_equation(
        &self,
        period: f64,
        points: usize,
    ) -> Result<StationaryEquation<'_, 'a, L, R>, StationaryError> {
        let factor = self.factor().widen();
        if (factor - 1.0).abs() <= Tolerance::rounding::<S>() {
            return Err(StationaryError::NoFriction);
        } else if factor > 1.0 {
            return Err(StationaryError::Growing { factor });
        } else if factor <= 0.0 {
            return Err(StationaryError::Overdamped { factor });
        } else if is_timed(self.by.system) {
            return Err(StationaryError::Timed);
        } else if !(period > 0.0 && period.is_finite()) {
            return Err(StationaryError::Period { period });
        } else if points < FEWEST {
            return Err(StationaryError::TooFewPoints { needed: FEWEST, found: points });
        }
        let mut equation =
            StationaryEquation { split: self, factor, period, reach: points / 8, costs: Vec::new() };
        equation.require_periodic(points)?;
        while equation.reach <= PERIODS * points {
            equation.costs = (0..points).map(|i| equation.costs_to(i, points)).collect::<Result<_, _>>()?;
            if equation.reaches_all() {
                return Ok(equation);
            }
            equation.reach *= 2;
        }
        Err(StationaryError::Unbounded { periods: PERIODS })
    }

    /// G and D1G = −c p0.
    fn cost(&self, q0: f64, q1: f64) -> Jet {
        let [q0, q1] = [q0, q1].map(|q| vector![S::constant(q)]);
        let slope = -self.factor() * self.by.legendre_minus(&q0, &q1).p[0];
        Jet { value: self.generating_function(&q0, &q1).widen(), slope: slope.widen() }
    }
}

impl<S, L, R> StationaryEquation<'_, '_, L, R>
where
    S: Scalar,
    L: DiscreteRayleigh<R, 1, Scalar = S>,
{
    /// S_0, with its slope, and S_{k+1} = T S_k: minima over the q0 within reach of each q1, which S* has its
    /// minimisers in.
    pub fn iterates(&self, start: impl Fn(f64) -> Jet) -> impl Iterator<Item = PeriodicFunction> {
        iter::successors(Some(self.function(start)), |s| Some(self.minimised(s).0))
    }

    /// S*, from S_0 = 0.
    ///
    /// # Errors
    /// [`StationaryError::NotConverged`].
    pub fn solve(&self) -> Result<StationarySolution, StationaryError> {
        self.solve_from(|_| Jet::default())
    }

    /// S*, from another S_0.
    ///
    /// T keeps the order of functions, and moves c·const with const: if low ≤ S_{k+1} − S_k ≤ high, S* is
    /// between S_{k+1} + c low/(1 − c) and S_{k+1} + c high/(1 − c), and their middle is returned.
    ///
    /// # Errors
    /// [`StationaryError::NotConverged`].
    pub fn solve_from(&self, start: impl Fn(f64) -> Jet) -> Result<StationarySolution, StationaryError> {
        let share = self.factor / (1.0 - self.factor);
        // c^k of them is below rounding.
        let most = ((1.0 - self.factor) * S::EPSILON.widen()).ln() / self.factor.ln();
        let (mut s, mut before, mut error) = (self.function(start), f64::NAN, f64::INFINITY);
        let mut ratio = f64::NAN;
        for iterations in 1..=most as usize {
            let (next, minimisers) = self.minimised(&s);
            let [low, high] = next.change(&s);
            let size = next.nodes().iter().map(|node| node.value.abs()).fold(0.0, f64::max);
            error = 0.5 * share * (high - low);
            let change = high.abs().max(low.abs());
            if change > S::EPSILON.widen().cbrt() * size {
                ratio = change / before;
            }
            if error <= ROUNDINGS * S::EPSILON.widen() * (1.0 + share) * size {
                let function = next.raised(0.5 * share * (high + low));
                let kinks = function.kinks();
                return Ok(StationarySolution { function, minimisers, kinks, iterations, ratio, error });
            }
            (s, before) = (next, change);
        }
        Err(StationaryError::NotConverged { iterations: most as usize, error })
    }

    fn function(&self, of: impl Fn(f64) -> Jet) -> PeriodicFunction {
        let points = self.costs.len();
        let nodes = (0..points).map(|i| of(i as f64 * self.period / points as f64)).collect();
        PeriodicFunction::new(self.period, nodes)
    }

    /// T S and the minimisers.
    fn minimised(&self, s: &PeriodicFunction) -> (PeriodicFunction, Vec<f64>) {
        let (points, spacing) = (self.costs.len(), s.spacing());
        let mut terms = Vec::with_capacity(2 * self.reach + 1);
        let (nodes, minimisers) = (0..points)
            .map(|i| {
                let first = i + PERIODS * points - self.reach;
                terms.clear();
                terms.extend(self.costs[i].iter().enumerate().map(|(j, cost)| {
                    let Jet { value, slope } = s.nodes()[(first + j) % points];
                    Jet { value: self.factor * value + cost.value, slope: self.factor * slope + cost.slope }
                }));
                let (place, value) = least(&terms, spacing);
                let q1 = i as f64 * spacing;
                let q0 = q1 + (place - self.reach as f64) * spacing;
                (Jet { value, slope: self.momentum(q0, q1) }, q0)
            })
            .unzip();
        (PeriodicFunction::new(self.period, nodes), minimisers)
    }

    /// p1 = D2G.
    fn momentum(&self, q0: f64, q1: f64) -> f64 {
        let [q0, q1] = [q0, q1].map(|q| vector![S::constant(q)]);
        self.split.by.legendre_plus(&q0, &q1).p[0].widen()
    }

    fn costs_to(&self, i: usize, points: usize) -> Result<Vec<Jet>, StationaryError> {
        let (spacing, reach) = (self.period / points as f64, self.reach as isize);
        let cost = |j: isize| {
            let (q0, q1) = ((i as isize + j) as f64 * spacing, i as f64 * spacing);
            let cost = self.split.cost(q0, q1);
            let is_finite = cost.value.is_finite() && cost.slope.is_finite();
            if is_finite { Ok(cost) } else { Err(StationaryError::NonFinite { q0, q1 }) }
        };
        (-reach..=reach).map(cost).collect()
    }

    /// Whether both ends are out of question for every q1. With m the least G, T S varies by no more than m
    /// and c S, so that S* varies by no more than that of m by 1 − c.
    fn reaches_all(&self) -> bool {
        let least = |costs: &Vec<Jet>| costs.iter().map(|cost| cost.value).fold(f64::MAX, f64::min);
        let [high, low] = self
            .costs
            .iter()
            .map(least)
            .fold([f64::MIN, f64::MAX], |[high, low], value| [high.max(value), low.min(value)]);
        let variation = (high - low) / (1.0 - self.factor);
        self.costs.iter().all(|costs| {
            let beyond = least(costs) + self.factor * variation;
            [costs[0], costs[costs.len() - 1]].iter().all(|end| end.value > beyond)
        })
    }

    fn require_periodic(&self, points: usize) -> Result<(), StationaryError> {
        for i in 0..points {
            let [q, further] = [i, i + points].map(|i| i as f64 * self.period / points as f64);
            for [start, start_further] in [[q, further], [0.0, self.period]] {
                let [here, there] =
                    [(start, q), (start_further, further)].map(|(q0, q1)| self.split.cost(q0, q1));
                let terms = here.value.abs() + self.split.cost(q, further).value.abs();
                let change = there.value - here.value;
                if change.abs() > Tolerance::rounding::<S>() * terms {
                    return Err(StationaryError::NotPeriodic { q, change });
                }
            }
        }
        Ok(())
    }
}

/// Where the terms are least, in cells from the first, and how much.
fn least(terms: &[Jet], spacing: f64) -> (f64, f64) {
    let minimum = |j: usize| {
        let own = (j as f64, terms[j].value);
        let cell = if terms[j].slope < 0.0 { j } else { j - 1 };
        let within = Cubic::between(terms[cell], terms[cell + 1], spacing).least();
        within.map_or(own, |(share, value)| (cell as f64 + share, value))
    };
    let is_local = |j: &usize| {
        let [before, at, after] = [j - 1, *j, j + 1].map(|j| terms[j].value);
        at <= before && at <= after
    };
    let by_value = |a: &(f64, f64), b: &(f64, f64)| a.1.total_cmp(&b.1);
    let ends = [0, terms.len() - 1].map(|j| (j as f64, terms[j].value));
    (1..terms.len() - 1).filter(is_local).map(minimum).chain(ends).min_by(by_value).expect("there are ends")
}
