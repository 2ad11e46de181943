//! The motion over steps of unequal length, until shorter ones change nothing but rounding.
//!
//! A mesh is found by the motion alone: a step is taken whole and in halves, and is short enough when they
//! agree to [`AGREEMENT`]; the halves are then right to rounding. What is asked for is carried over the mesh
//! and over the mesh with every step halved, and the difference is the error estimate.

use nalgebra::SVector;

use super::ExactError;
use super::collocation::{Phase, Step, Varied, unit_of};
use super::motion::{Dynamics, Family, Point};
use super::work::Breakdown;
use crate::system::ActingForce;
use crate::theory::verdict::largest;

/// How far a step and its halves may differ, relative to the largest of the motion. At order 15 the halves
/// are right to 2⁻¹⁵ of it.
const AGREEMENT: f64 = 1e-12;

/// Differences up to here are what rounding leaves.
const RIGHT: f64 = 1e-13;

/// Order 15 divides a difference by thousands when the steps are halved; less than this, and rounding holds
/// it up.
const FALLING: f64 = 16.0;

/// A momentum that grows so much in the last tenth of the time, in which steps become ever shorter, escapes.
const ESCAPE: f64 = 1e5;

/// Differences that are larger than this have to go on falling.
pub(super) const ROUNDING: f64 = 1e-10;

/// The times at which steps end, from 0 to h, with the quarters of h among them.
pub(super) struct Mesh(Vec<f64>);

impl Mesh {
    fn halved(&self) -> Self {
        let halves = self.0.windows(2).flat_map(|pair| [pair[0], 0.5 * (pair[0] + pair[1])]);
        Self(halves.chain(self.0.last().copied()).collect())
    }
}

/// A motion carried over a mesh.
pub(super) struct Carried<const N: usize> {
    pub(super) end: Point<N>,
    /// Largest magnitude on the way of each number of a point.
    pub(super) largest: Vec<f64>,
    /// The points at 0, h/4, h/2, 3h/4 and h.
    pub(super) quarters: [Point<N>; 5],
}

/// Sums along the motion, with those of the magnitudes of their terms.
pub(super) struct Sums {
    pub(super) values: Vec<f64>,
    sizes: Vec<f64>,
}

impl Sums {
    pub(super) fn add(&mut self, index: usize, term: f64) {
        self.values[index] += term;
        self.sizes[index] += term.abs();
    }
}

/// A function called at each step, with the variations by q0 and q1 (or p0) along it, to add to the sums.
pub(super) type Visitor<'v, const N: usize> = dyn FnMut(&Step<N>, &[Varied<N>], &mut Sums) + 'v;

/// The sums that are to be found along a motion.
pub(super) struct Question<'q, const N: usize> {
    /// Lengths of consecutive runs of sums that share a unit.
    pub(super) blocks: &'q [usize],
    /// Makes the visitor that adds the sums up, one for each time that the motion is followed.
    pub(super) visitor: &'q dyn Fn() -> Box<Visitor<'q, N>>,
    /// Relative differences that may be rounding, once they have stopped falling.
    pub(super) rounding: f64,
}

/// The answer.
pub(super) struct Resolved<const N: usize> {
    pub(super) carried: Carried<N>,
    pub(super) sums: Vec<f64>,
    /// Integration steps.
    pub(super) steps: usize,
    /// Largest difference to half as many steps, relative to the largest of the block.
    pub(super) difference: f64,
}

impl<L: ActingForce<N, Scalar = f64>, const N: usize> Dynamics<'_, L, N> {
    /// Follows the motion until halving the steps changes nothing but rounding.
    pub(super) fn resolve(
        &self,
        start: &Point<N>,
        h: f64,
        question: &Question<'_, N>,
    ) -> Result<Resolved<N>, ExactError> {
        let mut mesh = self.mesh(start, h)?;
        let follow = |mesh: &Mesh| {
            let count = question.blocks.iter().sum();
            let mut sums = Sums { values: vec![0.0; count], sizes: vec![0.0; count] };
            let mut visitor = (question.visitor)();
            let carried = self.carry(start, mesh, &mut |step, varied| visitor(step, varied, &mut sums))?;
            Ok((carried, sums))
        };
        let mut coarse = follow(&mesh)?;
        let mut previous = f64::INFINITY;
        let mut stagnant = 0;
        loop {
            mesh = mesh.halved();
            let fine = follow(&mesh)?;
            let difference = difference(question.blocks, &coarse, &fine);
            let falls = difference <= previous / FALLING;
            if difference <= RIGHT || (difference <= question.rounding && !falls && previous.is_finite()) {
                let (carried, sums) = fine;
                return Ok(Resolved { carried, sums: sums.values, steps: mesh.0.len() - 1, difference });
            }
            stagnant += usize::from(!falls && previous.is_finite());
            if stagnant > 2 || !difference.is_finite() {
                return Err(ExactError::Unresolved { steps: mesh.0.len() - 1, difference });
            }
            (coarse, previous) = (fine, difference);
        }
    }

    /// The motion with both families of variations over a mesh.
    pub(super) fn carry(
        &self,
        start: &Point<N>,
        mesh: &Mesh,
        visit: &mut dyn FnMut(&Step<N>, &[Varied<N>]),
    ) -> Result<Carried<N>, ExactError> {
        let mut at = *start;
        let mut most = at.numbers();
        let mut quarters = [*start; 5];
        let h = *mesh.0.last().unwrap_or(&0.0);
        for pair in mesh.0.windows(2) {
            let [from, to] = [pair[0], pair[1]];
            let phase = Phase { q: at.q, p: at.p, v: at.v };
            let step =
                self.step(from, &phase, to - from).map_err(|breakdown| breakdown.at(from, self.work))?;
            let columns: Vec<_> = at.minus.columns().chain(at.plus.columns()).collect();
            let varied = step.vary(&columns, None);
            visit(&step, &varied);
            let Phase { q, p, v } = step.end();
            let family = |first: usize| Family::of_columns(|j| varied[first + j].end);
            at = Point { q, p, v, minus: family(0), plus: family(N) };
            for (most, number) in most.iter_mut().zip(at.numbers()) {
                *most = largest([*most, number]);
            }
            for (k, quarter) in quarters.iter_mut().enumerate().skip(1) {
                if to == quarter_of(h, k) {
                    *quarter = at;
                }
            }
        }
        if !most.iter().all(|number| number.is_finite()) {
            return Err(ExactError::MotionNotFinite { time: h });
        }
        Ok(Carried { end: at, largest: most, quarters })
    }

    /// A mesh that resolves the motion from `start`.
    pub(super) fn mesh(&self, start: &Point<N>, h: f64) -> Result<Mesh, ExactError> {
        let local = self.local(0.0, &start.q, &start.v).map_err(|breakdown| breakdown.at(0.0, self.work))?;
        // In units in which every coordinate has mass 1.
        let unit = SVector::from_fn(|a, _| unit_of(&local, a));
        let size = |phase: &Phase<N>| {
            [
                largest(phase.q.component_mul(&unit).iter().copied()),
                largest(phase.p.component_div(&unit).iter().copied()),
            ]
        };
        let mut at = Phase { q: start.q, p: start.p, v: start.v };
        let mut scale = size(&at);
        let mut times = vec![0.0];
        let mut momenta = vec![scale[1]];
        let (mut time, mut length) = (0.0_f64, h / 8.0);
        let mut failure = (Breakdown::NotSolved, f64::INFINITY);
        for k in 1..=4 {
            let goal = quarter_of(h, k);
            while time != goal {
                let rest = goal - time;
                let ends = length.abs() * (1.0 + 1e-6) >= rest.abs();
                let tried = if ends { rest } else { length };
                match self.whole_and_halves(time, &at, tried) {
                    Ok((whole, halves)) => {
                        let apart =
                            size(&Phase { q: whole.q - halves.q, p: whole.p - halves.p, v: halves.v });
                        let reached = size(&halves);
                        let scales = [largest([scale[0], reached[0]]), largest([scale[1], reached[1]])];
                        let error = (0..2).map(|i| if apart[i] == 0.0 { 0.0 } else { apart[i] / scales[i] });
                        let error = largest(error);
                        let factor = (0.9 * (AGREEMENT / error).powf(1.0 / 16.0)).min(4.0);
                        if error <= AGREEMENT {
                            times.push(time + 0.5 * tried);
                            time = if ends { goal } else { time + tried };
                            times.push(time);
                            (at, scale) = (halves, scales);
                            momenta.extend([reached[1]; 2]);
                            // A step cut short by a quarter says little of the next.
                            length = if ends {
                                length.abs().max((tried * factor).abs()).copysign(h)
                            } else {
                                tried * factor
                            };
                        } else {
                            failure = (Breakdown::NotSolved, error);
                            length = tried * if error.is_finite() { factor.clamp(0.1, 0.7) } else { 0.1 };
                        }
                    }
                    Err(Breakdown::Exhausted) => return Err(Breakdown::Exhausted.at(time, self.work)),
                    Err(breakdown) => {
                        failure = (breakdown, f64::INFINITY);
                        length = 0.25 * tried;
                    }
                }
                if time + 0.5 * length == time || length.abs() < f64::EPSILON * h.abs() {
                    let escapes = |from: usize| largest(momenta[..from].iter().copied()) * ESCAPE < scale[1];
                    let before = times.partition_point(|earlier| earlier.abs() <= 0.9 * time.abs());
                    return Err(match failure {
                        (Breakdown::NotSolved, _) if before > 0 && escapes(before) => {
                            ExactError::MotionNotFinite { time }
                        }
                        (Breakdown::NotSolved, difference) => {
                            ExactError::Unresolved { steps: times.len(), difference }
                        }
                        (breakdown, _) => breakdown.at(time, self.work),
                    });
                }
            }
        }
        Ok(Mesh(times))
    }

    fn whole_and_halves(
        &self,
        time: f64,
        at: &Phase<N>,
        length: f64,
    ) -> Result<(Phase<N>, Phase<N>), Breakdown> {
        let whole = self.step(time, at, length)?.end();
        let half = self.step(time, at, 0.5 * length)?.end();
        Ok((whole, self.step(time + 0.5 * length, &half, 0.5 * length)?.end()))
    }
}

fn quarter_of(h: f64, k: usize) -> f64 {
    h * (0.25 * k as f64)
}

/// Largest difference, relative to the largest of the block on the way.
fn difference<const N: usize>(
    sums: &[usize],
    (coarse, coarse_sums): &(Carried<N>, Sums),
    (fine, fine_sums): &(Carried<N>, Sums),
) -> f64 {
    let points = relative(&Point::<N>::BLOCKS, &coarse.end.numbers(), &fine.end.numbers(), &fine.largest);
    largest([points, relative(sums, &coarse_sums.values, &fine_sums.values, &fine_sums.sizes)])
}

fn relative(blocks: &[usize], coarse: &[f64], fine: &[f64], sizes: &[f64]) -> f64 {
    let mut worst = 0.0_f64;
    let mut first = 0;
    for &length in blocks {
        let block = first..first + length;
        first += length;
        let scale = largest(block.clone().map(|i| sizes[i]));
        let apart = largest(block.map(|i| fine[i] - coarse[i]));
        if apart != 0.0 {
            worst = largest([worst, apart / scale]);
        }
    }
    worst
}
