//! An explicit step by the trapezoidal rule, in three functions: the matrix, what v̄ adds to the momenta, and
//! the force.

use super::kernel::Parts;
use super::*;

impl Deriving<'_> {
    /// The functions of an explicit step.
    pub(super) fn explicit(&mut self, parts: &Parts, diagonals: Option<usize>) -> Made<Explicit> {
        let half = self.graph.half_step();
        let matrix = self.matrix(|deriving, i, j| {
            let second =
                [&parts.lagrangian, &parts.rayleigh].map(|of| deriving.second(of, (i, true), (j, true)));
            let drag = second[1].map(|drag| deriving.graph.times(half, drag));
            [second[0], drag].into_iter().flatten().reduce(|a, b| deriving.graph.plus(a, b))
        });
        let matrix = self.in_form(&matrix, diagonals);
        let matrix = self.made(Of::StepMatrix, self.system.home(), &matrix)?;

        let (mut p0, mut p1, mut force) = (Vec::new(), Vec::new(), Vec::new());
        for index in 0..self.n {
            let (v, q) = (self.variable(index, true), self.variable(index, false));
            let l_v = parts.lagrangian.gradient.get(&v).copied();
            let r_v = parts.rayleigh.gradient.get(&v).copied().map(|r_v| self.graph.times(half, r_v));
            let drag = r_v.map(|r_v| self.graph.negated(r_v));
            let terms = [parts.lagrangian.gradient.get(&q).copied(), parts.force.get(index).copied()];
            for (sums, terms) in [(&mut p0, [l_v, r_v]), (&mut p1, [l_v, drag]), (&mut force, terms)] {
                let sum = terms.into_iter().flatten().reduce(|a, b| self.graph.plus(a, b));
                sums.push(self.or_zero(sum));
            }
        }
        let is_in_lanes = self.system.lanes.explicit.is_some();
        let momenta = self.of_step(Of::VelocityMomenta, &[p0, p1].concat(), is_in_lanes)?;
        let force = self.of_step(Of::ConfigurationForce, &force, is_in_lanes)?;
        let in_lanes = is_in_lanes.then(|| self.on_members([&momenta, &force])).flatten();
        Ok(Explicit { matrix, momenta, force, in_lanes })
    }
}
