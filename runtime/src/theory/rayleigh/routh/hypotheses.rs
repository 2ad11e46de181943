//! The hypotheses of a reduction, on a segment.

use nalgebra::SVector;

use crate::numbers::Scalar;
use crate::step::{Discrete, LegendreDerivatives};
use crate::system::is_timed;
use crate::theory::rayleigh::routh::{Routh, RouthError};
use crate::theory::samples::{Pair, at_segment};
use crate::theory::verdict::{Finding, Tolerance};

/// Hypotheses on one segment.
impl<L, R, const N: usize, const K: usize> Routh<'_, L, R, N, K>
where
    L: Discrete<R, N>,
{
    /// Fails where a momentum is another one when the segment is asked later.
    pub(super) fn require_no_time(
        &self,
        sample: usize,
        segment: &Pair<L::Scalar, N>,
    ) -> Result<(), RouthError> {
        if !is_timed(self.by.system) {
            return Ok(());
        }
        let momenta = |k: usize| {
            at_segment(&self.by, k, |by| {
                let k = by.objects(&segment.q0, &segment.q1).legendre();
                [k.momenta.p0, k.momenta.p1].map(|p| p.map(Scalar::widen))
            })
        };
        let now = momenta(0)?;
        let relative = Tolerance::rounding::<L::Scalar>();
        for steps in [1, 2, sample] {
            for (now, later) in now.iter().zip(momenta(steps)?) {
                let tolerance = Tolerance { relative, scale: now.amax().max(later.amax()) };
                let changes = |value: f64| !Finding::relative(value, tolerance, sample).vanishes();
                if (later - now).iter().any(|value| changes(*value)) {
                    return Err(RouthError::Timed { sample, steps });
                }
            }
        }
        Ok(())
    }

    /// Whether θ has a momentum on the segment, where the conditions hold.
    pub(super) fn check(&self, sample: usize, segment: &Pair<L::Scalar, N>) -> Result<bool, RouthError> {
        let theta = self.cyclic;
        let k = at_segment(&self.by, 0, |by| by.objects(&segment.q0, &segment.q1).legendre())?;
        for (momentum, by_q0, by_q1) in
            [(k.momenta.p0, k.p0_by_q0, k.p0_by_q1), (k.momenta.p1, k.p1_by_q0, k.p1_by_q1)]
        {
            for i in 0..N {
                let (at_start, at_end) = (by_q0[(i, theta)].widen(), by_q1[(i, theta)].widen());
                if !(at_start.is_finite() && at_end.is_finite() && momentum[i].widen().is_finite()) {
                    return Err(RouthError::NonFinite { sample });
                }
                let scale = (0..N).map(|j| by_q0[(i, j)].widen().abs() + by_q1[(i, j)].widen().abs()).sum();
                let tolerance = Tolerance { relative: Tolerance::rounding::<L::Scalar>(), scale };
                let found = Finding::relative(at_start + at_end, tolerance, sample);
                if !found.vanishes() {
                    return Err(RouthError::NotCyclic { sample, defect: found.value });
                }
            }
        }
        let before = k.momenta.p0[theta];
        let terms = self.require_condition(&k, before, [&segment.q0, &segment.q1])?;
        Ok(before.widen().abs() > Tolerance::rounding::<L::Scalar>() * terms)
    }

    /// That p1_θ is g(p0_θ), `before`, on the segment between `ends`, whose derivatives are `k`; the terms of
    /// these momenta, which are differences of configurations.
    pub(super) fn require_condition(
        &self,
        k: &LegendreDerivatives<L::Scalar, N>,
        before: L::Scalar,
        [q0, q1]: [&SVector<L::Scalar, N>; 2],
    ) -> Result<f64, RouthError> {
        let theta = self.cyclic;
        let (found, expected) = (k.momenta.p1[theta], self.next_momentum(before)?);
        let [found, expected, before] = [found, expected, before].map(Scalar::widen);
        let size = |a: L::Scalar, b: L::Scalar| (a * b).widen().abs();
        let terms = (0..N)
            .map(|j| {
                let at_start = size(k.p0_by_q0[(theta, j)], q0[j]) + size(k.p0_by_q1[(theta, j)], q1[j]);
                at_start + size(k.p1_by_q0[(theta, j)], q0[j]) + size(k.p1_by_q1[(theta, j)], q1[j])
            })
            .sum::<f64>();
        let scale = found.abs() + expected.abs() + before.abs() + terms;
        let tolerance = Tolerance { relative: Tolerance::rounding::<L::Scalar>(), scale };
        let held = Finding::relative(found - expected, tolerance, ());
        if held.vanishes() {
            Ok(terms)
        } else {
            Err(RouthError::NotReducible { momentum: before, found, expected })
        }
    }
}
