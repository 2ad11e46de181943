//! Steps of mechanisms in twice the precision: Newton's method for v̄ and all multipliers at once, and the
//! curve of roots from h = 0.
//!
//! ```text
//! p0(v̄) + G(q0)ᵀκ = p        g(q1) = 0        q1 = q0 + h v̄
//! ```
//!
//! Of redundant constraints those are left out whose gradients depend on the others' at q0: the motion
//! depends on N alone.

use double_double::DoubleDouble;

use super::elimination::{Factors, Rows};
use super::equations::{Rule, dot};
use super::{Shape, Values};

/// Share of a gradient that the others leave, below which its constraint is redundant.
const REDUNDANT: f64 = 1e-12;

/// Newton corrections of a root.
const CORRECTIONS: u32 = 14;

/// The least part of h that the curve is followed by.
const LEAST_PART: f64 = 1e-9;

/// A step to be taken.
#[derive(Clone, Copy)]
pub struct Problem<'a> {
    /// What it is made of.
    pub shape: &'a Shape,
    /// Its numbers.
    pub values: &'a Values,
    /// The rule.
    pub rule: Rule,
    /// q0.
    pub q: &'a [f64],
    /// p.
    pub p: &'a [f64],
    /// h.
    pub h: f64,
}

/// A root of the equations.
pub struct Root {
    n: usize,
    /// v̄, then κ of the constraints that count.
    pub(super) x: Vec<DoubleDouble>,
    pub(super) factors: Factors,
}

impl Root {
    /// v̄, rounded.
    #[must_use]
    pub fn velocity(&self) -> Vec<f64> {
        self.x[..self.n].iter().map(|x| x.high).collect()
    }

    /// The smallest pivot of the equations beside its row: 0 at a singular point.
    #[must_use]
    pub fn least_pivot(&self) -> f64 {
        self.factors.least
    }
}

/// Where the curve of roots leads from h = 0.
pub enum Curve {
    /// To the whole of h.
    Root(Root),
    /// It ends before.
    Ends(End),
}

/// Where a curve of roots ends.
#[derive(Clone, Copy, Debug)]
pub struct End {
    /// The share of h.
    pub share: f64,
    /// The smallest pivot there: next to nothing where the curve turns back.
    pub pivot: f64,
}

/// Equations of a step, of a share of its h.
pub(super) struct Equations<'a> {
    pub(super) of: Problem<'a>,
    pub(super) n: usize,
    pub(super) q: Vec<DoubleDouble>,
    pub(super) p: Vec<DoubleDouble>,
    /// Constraints that count.
    pub(super) counted: Vec<usize>,
    /// g(q0) and G(q0), of the constraints that count.
    pub(super) g0: Vec<DoubleDouble>,
    pub(super) directions: Rows,
    /// g at the end: 0, or what rounding leaves.
    end: Vec<DoubleDouble>,
    /// Units of v̄.
    units: Vec<f64>,
}

pub(super) fn numbers(of: &[f64]) -> Vec<DoubleDouble> {
    of.iter().map(|x| DoubleDouble::new(*x)).collect()
}

/// The places of rows that are independent in the metric of the mass.
pub(super) fn independent(rows: &Rows, mass: &[f64]) -> Vec<usize> {
    let metric: Vec<DoubleDouble> =
        mass.iter().map(|m| DoubleDouble::new(1.0) / DoubleDouble::new(m.sqrt())).collect();
    let (mut basis, mut places): (Rows, Vec<usize>) = (Vec::new(), Vec::new());
    for (k, row) in rows.iter().enumerate() {
        let mut left: Vec<DoubleDouble> = row.iter().zip(&metric).map(|(x, m)| *x * *m).collect();
        let size = dot(&left, &left).high.sqrt();
        for _ in 0..2 {
            for of in &basis {
                let share = dot(of, &left);
                left.iter_mut().zip(of).for_each(|(x, of)| *x = *x - share * *of);
            }
        }
        let rest = dot(&left, &left).sqrt();
        if rest.high > REDUNDANT * size {
            basis.push(left.iter().map(|x| *x / rest).collect());
            places.push(k);
        }
    }
    places
}

impl<'a> Equations<'a> {
    pub(super) fn of(problem: Problem<'a>) -> Self {
        let Problem { shape, values, q, p, .. } = problem;
        let (n, q) = (q.len(), numbers(q));
        let (g, rows) = shape.constraints(values, &q);
        let counted = independent(&rows, &values.mass);
        let g0 = counted.iter().map(|k| g[*k]).collect();
        let directions: Rows = counted.iter().map(|k| rows[*k].clone()).collect();
        let end = vec![DoubleDouble::ZERO; counted.len()];
        let lengths = q.iter().fold(0.0_f64, |size, q| size.max(q.high.abs()));
        let speeds = p.iter().zip(&values.mass).fold(0.0_f64, |size, (p, m)| size.max((p / m).abs()));
        let unit = speeds.max(lengths / problem.h.abs() * 1e-3).max(f64::MIN_POSITIVE);
        Self { of: problem, n, q, p: numbers(p), counted, g0, directions, end, units: vec![unit; n] }
    }

    /// With the constraints at the end as the velocity `v` leaves them: of lengths that differ by rounding,
    /// which [`off`](super::off) holds against it. Those of a mechanism that is flat to 10⁻⁷ know its height
    /// to a few percent: as they are rounded they may belong to none.
    pub(super) fn with_rounding(self, v: &[f64]) -> Self {
        let Problem { shape, values, .. } = self.of;
        let (g, _) = shape.constraints(values, &self.end(&numbers(v), 1.0));
        Self { end: self.counted.iter().map(|k| g[*k]).collect(), ..self }
    }

    fn h(&self, share: f64) -> DoubleDouble {
        DoubleDouble::new(self.of.h) * DoubleDouble::new(share)
    }

    pub(super) fn momenta(&self, v: &[DoubleDouble], share: f64) -> [Vec<DoubleDouble>; 2] {
        self.of.rule.momenta((self.of.shape, self.of.values), &self.q, v, self.h(share))
    }

    pub(super) fn end(&self, v: &[DoubleDouble], share: f64) -> Vec<DoubleDouble> {
        self.q.iter().zip(v).map(|(q, v)| *q + self.h(share) * *v).collect()
    }

    /// The residual of `x`, and G(q1).
    fn residual(&self, x: &[DoubleDouble], share: f64) -> (Vec<DoubleDouble>, Rows) {
        let (v, kappa) = x.split_at(self.n);
        let [p0, _] = self.momenta(v, share);
        let mut residual: Vec<DoubleDouble> = p0.iter().zip(&self.p).map(|(p0, p)| *p0 - *p).collect();
        for (row, kappa) in self.directions.iter().zip(kappa) {
            residual.iter_mut().zip(row).for_each(|(sum, entry)| *sum = *sum + *entry * *kappa);
        }
        let (g, rows) = self.of.shape.constraints(self.of.values, &self.end(v, share));
        let gradients: Rows = self.counted.iter().map(|k| rows[*k].clone()).collect();
        // What q0 is off by rounding is no speed of a short step.
        let left = DoubleDouble::new(1.0 - share);
        for ((k, g0), end) in self.counted.iter().zip(&self.g0).zip(&self.end) {
            residual.push((g[*k] - *end - left * (*g0 - *end)) / self.h(share));
        }
        (residual, gradients)
    }

    /// ∂(p0, p1)/∂v̄ by columns, by differences that are good to some 20 digits.
    pub(super) fn slopes(&self, v: &[DoubleDouble], share: f64) -> [Rows; 2] {
        let mut columns = [Vec::new(), Vec::new()];
        for j in 0..self.n {
            let by = 1e-10 * self.units[j].max(v[j].high.abs());
            let moved = |by: f64| {
                let mut moved = v.to_vec();
                moved[j] = moved[j] + DoubleDouble::new(by);
                self.momenta(&moved, share)
            };
            let (after, before) = (moved(by), moved(-by));
            for (columns, (after, before)) in columns.iter_mut().zip(after.iter().zip(&before)) {
                let twice = DoubleDouble::new(2.0) * DoubleDouble::new(by);
                columns.push(after.iter().zip(before).map(|(a, b)| (*a - *b) / twice).collect());
            }
        }
        columns
    }

    fn factored(&self, v: &[DoubleDouble], gradients: &Rows, share: f64) -> Option<Factors> {
        let [slopes, _] = self.slopes(v, share);
        let m = self.directions.len();
        let mut rows = vec![vec![DoubleDouble::ZERO; self.n + m]; self.n + m];
        for (i, row) in rows.iter_mut().enumerate() {
            if i < self.n {
                (0..self.n).for_each(|j| row[j] = slopes[j][i]);
                (0..m).for_each(|k| row[self.n + k] = self.directions[k][i]);
            } else {
                row[..self.n].copy_from_slice(&gradients[i - self.n]);
            }
        }
        Factors::of(rows)
    }

    fn size(&self, correction: &[DoubleDouble]) -> f64 {
        correction[..self.n]
            .iter()
            .zip(&self.units)
            .fold(0.0, |size, (x, unit)| size.max(x.high.abs() / unit))
    }

    /// The root next to `x`, by corrections of which each is at most a quarter of the one before.
    fn next_to(&self, mut x: Vec<DoubleDouble>, share: f64, is_near: bool) -> Option<Root> {
        let mut last = f64::INFINITY;
        let enough = if share < 1.0 { 1e-14 } else { 1e-25 };
        for iteration in 0..CORRECTIONS {
            let (residual, gradients) = self.residual(&x, share);
            let factors = self.factored(&x[..self.n], &gradients, share)?;
            let correction = factors.solve(&residual);
            let size = self.size(&correction);
            x.iter_mut().zip(&correction).for_each(|(x, by)| *x = *x - *by);
            let is_done = size < enough || iteration > 2 && size < 1e-18 && size > 0.01 * last;
            if is_done {
                return Some(Root { n: self.n, x, factors });
            }
            if !size.is_finite() || is_near && size > 0.25 * last {
                return None;
            }
            last = size;
        }
        None
    }

    /// The root next to the velocity of a step.
    pub(super) fn root_next_to(&self, v: &[f64]) -> Option<Root> {
        let mut x = numbers(v);
        x.resize(self.n + self.counted.len(), DoubleDouble::ZERO);
        self.next_to(x, 1.0, false)
    }

    /// Follows the root from h = 0.
    pub(super) fn followed(&self) -> Curve {
        let mut x: Vec<DoubleDouble> =
            self.p.iter().zip(&self.of.values.mass).map(|(p, m)| *p / DoubleDouble::new(*m)).collect();
        x.resize(self.n + self.counted.len(), DoubleDouble::ZERO);
        let (mut reached, mut part, mut pivot) = (0.0, 1.0 / 64.0, f64::NAN);
        let mut before: Option<(f64, Vec<DoubleDouble>)> = None;
        while part > LEAST_PART {
            let share = if reached + part >= 1.0 { 1.0 } else { reached + part };
            let guess = match &before {
                None => x.clone(),
                Some((from, at)) => {
                    let factor = DoubleDouble::new((share - reached) / (reached - from));
                    x.iter().zip(at).map(|(x, at)| *x + (*x - *at) * factor).collect()
                }
            };
            match self.next_to(guess, share, true) {
                Some(root) if share == 1.0 => return Curve::Root(root),
                Some(root) => {
                    before = Some((reached, x));
                    pivot = root.least_pivot();
                    x = root.x;
                    reached = share;
                    part *= 2.0;
                }
                None => part *= 0.25,
            }
        }
        Curve::Ends(End { share: reached, pivot })
    }
}
