//! Steps that were taken, held against the equations.

use double_double::DoubleDouble;

use super::elimination::{Factors, Rows};
use super::oracle::{Curve, Equations, Problem, Root, independent};
use crate::rounded::Rounded;

/// u = ε/2.
const UNIT: f64 = 0.5 * f64::EPSILON;

/// A violation is beyond this many units of rounding: 4 floors of 4ε, and what results are rounded by
/// (`tests/examples/verdicts`).
pub const MOST: f64 = 36.0;

/// Roundings of its terms that a constraint may be off.
pub const MOST_OFF: f64 = 10.0;

/// How far a step is from the root, each in units of what rounding the equation by u in each of its
/// operations may move it.
#[derive(Clone, Copy, Debug)]
pub struct Judged {
    /// v̄; nothing where no root is next to it.
    pub velocity: Option<f64>,
    /// p1.
    pub momentum: f64,
    /// v̄ beside |v̄|, as it is.
    pub relative: f64,
}

/// How far q is off each constraint, the most in roundings ε of its terms.
#[must_use]
pub fn off((shape, values): (&super::Shape, &super::Values), q: &[f64]) -> f64 {
    let q: Vec<Rounded> = q.iter().map(|q| Rounded::input(*q)).collect();
    let (g, _) = shape.constraints(values, &q);
    g.iter().fold(0.0, |most, g| {
        let roundings = g.value.high.abs() / (2.0 * g.error);
        if roundings.is_nan() { f64::INFINITY } else { roundings.max(most) }
    })
}

fn inputs(of: &[f64]) -> Vec<Rounded> {
    of.iter().map(|x| Rounded::input(*x)).collect()
}

fn worst(found: &[f64], root: &[DoubleDouble], bound: &[f64]) -> f64 {
    found.iter().zip(root).zip(bound).fold(0.0, |most, ((found, root), bound)| {
        let ratio = (DoubleDouble::new(*found) - *root).high.abs() / (bound + f64::MIN_POSITIVE);
        if ratio.is_nan() { f64::INFINITY } else { ratio.max(most) }
    })
}

impl Problem<'_> {
    /// Where the roots lead from h = 0.
    #[must_use]
    pub fn followed(self) -> Curve {
        Equations::of(self).followed()
    }

    /// Whether `v` is the root to which the curve from h = 0 leads, of the lengths as they are or as rounding
    /// leaves them at both ends of the step.
    #[must_use]
    pub fn is_followed(self, v: &[f64]) -> bool {
        let is_led_to = |equations: Equations<'_>| {
            let curve = equations.followed();
            matches!(curve, Curve::Root(root) if self.is_root(&root, v))
        };
        let is_rounded = || self.is_on_constraints(v) && is_led_to(Equations::of(self).with_rounding(v));
        is_led_to(Equations::of(self)) || is_rounded()
    }

    fn is_on_constraints(self, v: &[f64]) -> bool {
        let end: Vec<f64> = self.q.iter().zip(v).map(|(q, v)| q + self.h * v).collect();
        off((self.shape, self.values), &end) <= MOST_OFF
    }

    /// Whether `v` is this root, and no other: to a millionth, or to rounding.
    fn is_root(self, root: &Root, v: &[f64]) -> bool {
        let bound = Equations::of(self).bound(root);
        let of = root.velocity();
        let largest = of.iter().fold(0.0_f64, |size, v| size.max(v.abs()));
        let mut all = v.iter().zip(&of).zip(bound);
        all.all(|((v, root), bound)| (v - root).abs() <= 1e-6 * largest + 100.0 * bound)
    }

    /// Holds a step with the velocity `v`, which ends with the momentum `p1`, against the root next to it: of
    /// the lengths as they are, or where that is another, or there is none, as rounding leaves them: what
    /// they know to a percent is beyond the first order of the bound.
    #[must_use]
    pub fn judged(self, v: &[f64], p1: &[f64]) -> Judged {
        let exact = Equations::of(self).judged(v, p1);
        if exact.velocity.is_some_and(|velocity| velocity.max(exact.momentum) <= MOST) {
            return exact;
        }
        if !self.is_on_constraints(v) {
            return exact;
        }
        let rounded = Equations::of(self).with_rounding(v).judged(v, p1);
        if rounded.velocity.is_some() { rounded } else { exact }
    }
}

impl Equations<'_> {
    fn judged(&self, v: &[f64], p1: &[f64]) -> Judged {
        let Some(root) = self.root_next_to(v) else {
            return Judged { velocity: None, momentum: f64::NAN, relative: f64::NAN };
        };
        let bound = self.bound(&root);
        let largest = root.velocity().iter().fold(0.0_f64, |size, v| size.max(v.abs()));
        let off = v.iter().zip(root.velocity()).fold(0.0_f64, |off, (v, of)| off.max((v - of).abs()));
        Judged {
            velocity: Some(worst(v, &root.x[..v.len()], &bound)),
            momentum: self.momentum(&root, &bound, p1),
            relative: if largest > 0.0 { off / largest } else { off },
        }
    }

    /// The most by which v̄ and κ may be off, if the equations are rounded.
    fn bound(&self, root: &Root) -> Vec<f64> {
        let Problem { shape, values, rule, q, p, h } = self.of;
        let (n, h) = (q.len(), Rounded::input(h));
        let (q, v) = (inputs(q), inputs(&root.velocity()));
        let [p0, _] = rule.momenta((shape, values), &q, &v, h);
        let (_, directions) = shape.constraints(values, &q);
        let mut errors: Vec<f64> = p0.iter().zip(inputs(p)).map(|(p0, p)| (*p0 - p).error).collect();
        for (k, kappa) in self.counted.iter().zip(&root.x[n..]) {
            for (error, entry) in errors.iter_mut().zip(&directions[*k]) {
                *error += (*entry * Rounded::input(kappa.high)).error;
            }
        }
        let end: Vec<Rounded> = q.iter().zip(&v).map(|(q, v)| *q + h * *v).collect();
        let (g, _) = shape.constraints(values, &end);
        errors.extend(self.counted.iter().map(|k| g[*k].error / h.size()));
        root.factors.bound(&errors)
    }

    /// How far p1 is off, of a root where v̄ may be off by the `bound`.
    fn momentum(&self, root: &Root, bound: &[f64], p1: &[f64]) -> f64 {
        let Problem { shape, values, rule, q, h, .. } = self.of;
        let (n, v) = (q.len(), &root.x[..q.len()]);
        let (_, all) = shape.constraints(values, &self.end(v, 1.0));
        let counted = independent(&all, &values.mass);
        let gradients: Rows = counted.iter().map(|k| all[*k].clone()).collect();
        let m = gradients.len();
        // p1 + Gᵀμ = p before it is projected, GM⁻¹p1 = 0.
        let mut rows = vec![vec![DoubleDouble::ZERO; n + m]; n + m];
        for i in 0..n {
            rows[i][i] = DoubleDouble::new(1.0);
            for (k, gradient) in gradients.iter().enumerate() {
                rows[i][n + k] = gradient[i];
                rows[n + k][i] = gradient[i] / DoubleDouble::new(values.mass[i]);
            }
        }
        let Some(factors) = Factors::of(rows) else { return f64::INFINITY };
        let [_, mut right] = self.momenta(v, 1.0);
        let raw = rule.momenta((shape, values), &inputs(q), &inputs(&root.velocity()), Rounded::input(h));
        right.resize(n + m, DoubleDouble::ZERO);
        let found = factors.solve(&right);
        let mut errors: Vec<f64> = raw[1].iter().map(|p| p.error + 2.0 * UNIT * p.size()).collect();
        // p1 = p + (p1 − p0).
        errors.iter_mut().zip(&raw[0]).for_each(|(error, p0)| *error += p0.error);
        let [_, slopes] = self.slopes(v, 1.0);
        for (column, bound) in slopes.iter().zip(bound) {
            errors.iter_mut().zip(column).for_each(|(error, entry)| *error += entry.high.abs() * bound);
        }
        let end: Vec<Rounded> = root
            .velocity()
            .iter()
            .zip(q)
            .map(|(v, q)| Rounded::input(*q) + Rounded::input(h) * Rounded::input(*v))
            .collect();
        let (_, rounded) = shape.constraints(values, &end);
        for (k, of) in counted.into_iter().enumerate() {
            let mut of_row = 0.0;
            for (i, entry) in rounded[of].iter().enumerate() {
                let error = entry.error + 4.0 * UNIT * entry.size();
                errors[i] += error * found[n + k].high.abs();
                of_row += error * found[i].high.abs() / values.mass[i];
            }
            errors.push(of_row);
        }
        worst(p1, &found[..n], &factors.bound(&errors))
    }
}
