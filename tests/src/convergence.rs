//! The order of a method, from errors over step sizes.

use dalembert::State;
use nalgebra::SVector;

use crate::by_hand::ByHand;
use crate::reference;

/// Errors against step sizes, the largest step first.
#[derive(Clone, Debug, Default)]
pub struct Convergence {
    errors: Vec<(f64, f64)>,
}

/// Points that a slope is fitted to.
const POINTS: usize = 4;

impl Convergence {
    /// Adds the error at step size `h`.
    pub fn push(&mut self, h: f64, error: f64) {
        self.errors.push((h, error));
    }

    /// Slope of log error over log h by least squares, on the four smallest steps whose error is above
    /// `plateau`, the level that rounding and the reference's own error keep up.
    ///
    /// # Panics
    /// If fewer than four errors are above the plateau.
    pub fn order(&self, plateau: f64) -> f64 {
        let above: Vec<_> =
            self.errors.iter().filter(|(_, error)| *error > plateau || error.is_nan()).collect();
        assert!(above.len() >= POINTS, "too few errors above the plateau {plateau:e}: {self:?}");
        let points: Vec<_> =
            above[above.len() - POINTS..].iter().map(|(h, error)| (h.ln(), error.ln())).collect();
        let mean = |f: fn(&(f64, f64)) -> f64| points.iter().map(f).sum::<f64>() / POINTS as f64;
        let (x, y) = (mean(|point| point.0), mean(|point| point.1));
        let covariance: f64 = points.iter().map(|point| (point.0 - x) * (point.1 - y)).sum();
        let variance: f64 = points.iter().map(|point| (point.0 - x).powi(2)).sum();
        covariance / variance
    }
}

/// The orders observed in q and in p, of what `run` makes of a step size, a start and a number of steps, over
/// steps of `time`/`steps`.
pub fn orders<L: ByHand<N>, const N: usize>(
    system: &L,
    time: f64,
    steps: [usize; 6],
    [q, v]: [[f64; N]; 2],
    plateau: f64,
    run: impl Fn(f64, State<f64, N>, usize) -> State<f64, N>,
) -> [f64; 2] {
    let (q_end, v_end) = reference::motion(system, q, v, time);
    let p_end = system.momentum(q_end, v_end);
    let start = State { q: q.into(), p: system.momentum(q, v) };
    let (mut in_q, mut in_p) = (Convergence::default(), Convergence::default());
    for steps in steps {
        let h = time / steps as f64;
        let end = run(h, start, steps);
        in_q.push(h, (end.q - SVector::from(q_end)).norm());
        in_p.push(h, (end.p - p_end).norm());
    }
    [in_q.order(plateau), in_p.order(plateau)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_exponent_of_a_power_and_leaves_the_plateau_out() {
        let mut convergence = Convergence::default();
        for k in 0..12 {
            let h = 0.5_f64.powi(k);
            convergence.push(h, (0.3 * h.powf(2.5)).max(1e-6));
        }
        assert!((convergence.order(1e-5) - 2.5).abs() < 1e-12);
        // Positive control: with the plateau in, the slope is 0.
        assert!(convergence.order(1e-7).abs() < 0.1);
    }

    #[test]
    fn an_error_that_is_no_number_gives_no_order() {
        let mut convergence = Convergence::default();
        for k in 0..6 {
            convergence.push(0.5_f64.powi(k), if k == 5 { f64::NAN } else { 1.0 });
        }
        assert!(convergence.order(0.0).is_nan());
    }
}
