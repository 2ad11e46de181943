//! Second variations of the motion: D11, D12, D22 of L_d^ex and the Jacobians of f_d^ex.
//!
//! With parameters a, b among q0 and q1, δ_a q the first variations and w = ∂²q/∂a∂b, which vanishes at both
//! ends,
//!
//! ```text
//! ∂_b f_a = ∫ (f_q δ_b q + f_v δ_b v)·δ_a q dt + ∫ f·w dt
//! ∂_a ∂_b L_d^ex = ∫ L″[δ_a, δ_b] dt − ∫ f·w dt
//! ```
//!
//! since (L_q, L_v) along w is a total derivative less f·w. The second variation is carried from zero initial
//! values as (η, ζ) = (δ²q, δ²p); returning its end to zero by a variation of q1 gives ∫ f·w dt = ∫ f·η dt −
//! f_d^ex+·η(h).
//!
//! The sources of (η, ζ) are third derivatives of L and second ones of f along δ_a. [`Lagrangian`] does not
//! give these: they are central differences of order 8 of the second derivatives, along δ_a, with a spacing
//! that the motion itself is asked for: the one whose result changes least when it is halved.

use core::cell::{Cell, RefCell};

use nalgebra::{SMatrix, SVector};

use super::ExactError;
use super::collocation::{Source, unit_of};
use super::mesh::{Question, Visitor};
use super::motion::{Dynamics, Local, Point};
use super::segment::ExactSegment;
use super::work::Breakdown;
use crate::numbers::{CovectorDerivatives, Derivatives};
use crate::step::{DiscreteForce, DiscreteForceDerivatives};
use crate::system::ActingForce;
use crate::theory::verdict::largest;

/// Second derivatives of the exact discrete objects on a segment.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SecondDerivatives<const N: usize> {
    /// L_d^ex with D1, D2, D11, D12, D22.
    pub lagrangian: Derivatives<f64, N>,
    /// f_d^ex± with D1 and D2.
    pub force: DiscreteForceDerivatives<f64, N>,
    /// Absolute error estimate of the entries of D11, D12, D22 of L_d^ex: how much halving the spacing of
    /// the differences changes them, and the relative error of the integration times their size.
    pub lagrangian_error: f64,
    /// Absolute error estimate of the entries of D1, D2 of f_d^ex±, likewise.
    pub force_error: f64,
}

/// Weights of the central difference of order 8, for ±1, ±2, ±3, ±4 spacings.
const WEIGHTS: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];

/// Spacings tried, in powers of 2 of the coordinate's size, narrow ones first.
const SPACINGS: core::ops::Range<i32> = -20..20;

/// A spread so many times the least so far shows that the spacing has outgrown the functions. Wider ones are
/// not tried: their differences may agree again, having stepped over what is to be differenced.
const OUTGROWN: f64 = 1e3;

/// Differences that disagree by more over one spacing, relative to the second derivatives, show that there is
/// no third derivative: those of a jump disagree by about 1 at every spacing.
const ROUGH: f64 = 1e-6;

/// The differences round: the second variations may stop converging at this relative error, which is then
/// reported.
const ROUNDING: f64 = 1e-6;

/// Roundings of the sums along the motion, which two attempts may agree on by chance.
const ROUNDINGS: f64 = 32.0;

/// Derivatives of the second derivatives of L and the first ones of f along one variation.
#[derive(Clone, Copy)]
struct Bend<const N: usize> {
    l: Derivatives<f64, N>,
    f: CovectorDerivatives<f64, N>,
}

/// The variations of one point in a row: those of q0, then those of q1.
struct Columns<const N: usize> {
    q: Vec<SVector<f64, N>>,
    v: Vec<SVector<f64, N>>,
}

impl<const N: usize> Columns<N> {
    fn of(point: &Point<N>, local: &Local<N>) -> Self {
        let families = [&point.minus, &point.plus];
        let q = families.iter().flat_map(|family| family.columns().map(|(q, _)| q)).collect();
        let velocities = families.map(|family| local.velocities(family));
        let v = velocities.iter().flat_map(|family| family.column_iter().map(|column| column.into_owned()));
        Self { q, v: v.collect() }
    }
}

/// The unordered pairs of 2N parameters, a ≤ b.
fn pairs<const N: usize>() -> impl Iterator<Item = (usize, usize)> {
    (0..2 * N).flat_map(|a| (a..2 * N).map(move |b| (a, b)))
}

/// Of a segment that was followed from q0 on, its motion being that of `dynamics`.
pub(super) fn second_derivatives<L, const N: usize>(
    dynamics: Dynamics<'_, L, N>,
    segment: &ExactSegment<N>,
) -> Result<SecondDerivatives<N>, ExactError>
where
    L: ActingForce<N, Scalar = f64>,
{
    let spacings = spacings(dynamics, segment)?;
    let halved: Vec<f64> = spacings.iter().map(|spacing| spacing / 2.0).collect();
    let (lagrangian, force, integration) = carry(dynamics, segment, &spacings)?;
    let (other, ..) = carry(dynamics, segment, &halved)?;
    // The differences enter both through ∫ f·w dt alone.
    let hessian = |l: &Derivatives<f64, N>| [l.d11, l.d12, l.d22];
    let most = |blocks: &[SMatrix<f64, N, N>]| largest(blocks.iter().flat_map(|block| block.iter().copied()));
    let jacobian = [force.minus.d1, force.minus.d2, force.plus.d1, force.plus.d2];
    let apart = hessian(&lagrangian)
        .iter()
        .zip(&hessian(&other))
        .map(|(wide, narrow)| wide - narrow)
        .collect::<Vec<_>>();
    let spread = most(&apart);
    let relative = largest([integration, segment.report.error(), ROUNDINGS * f64::EPSILON]);
    Ok(SecondDerivatives {
        lagrangian_error: spread + relative * most(&hessian(&lagrangian)),
        force_error: spread + relative * most(&jacobian),
        lagrangian,
        force,
    })
}

impl<const N: usize> SecondDerivatives<N> {
    /// The derivatives of the segment from q1 back to q0; see [`ExactSegment::reversed`].
    pub(super) fn reversed(self) -> Self {
        let Derivatives { value, d1, d2, d11, d12, d22 } = self.lagrangian;
        let turned =
            |f: CovectorDerivatives<f64, N>| CovectorDerivatives { value: -f.value, d1: -f.d2, d2: -f.d1 };
        Self {
            lagrangian: Derivatives {
                value: -value,
                d1: -d2,
                d2: -d1,
                d11: -d22,
                d12: -d12.transpose(),
                d22: -d11,
            },
            force: DiscreteForceDerivatives {
                minus: turned(self.force.plus),
                plus: turned(self.force.minus),
            },
            ..self
        }
    }
}

/// D²L_d^ex and Df_d^ex with these spacings, and the relative error of the integration.
fn carry<L, const N: usize>(
    dynamics: Dynamics<'_, L, N>,
    segment: &ExactSegment<N>,
    spacings: &[f64],
) -> Result<(Derivatives<f64, N>, DiscreteForceDerivatives<f64, N>, f64), ExactError>
where
    L: ActingForce<N, Scalar = f64>,
{
    let count = pairs::<N>().count();
    let own = 4 * N * N;
    // Beside the motion: ∫ (f′ δ_b)·δ_a, ∫ f·η, ∫ L″[δ_a, δ_b]. The first two make up one Jacobian and are
    // judged together; η and ζ are not judged, as they matter through ∫ f·η alone.
    let breakdown = Cell::new(None);
    let ends = RefCell::new(Vec::new());
    let visitor = || -> Box<Visitor<'_, N>> {
        let (breakdown, ends) = (&breakdown, &ends);
        let mut seconds = vec![(SVector::zeros(), SVector::zeros()); count];
        Box::new(move |step, varied, sums| {
            let mut sources: Vec<Source<N>> = vec![Vec::new(); count];
            for (i, stage) in step.stages.iter().enumerate() {
                let Local { l, f } = &stage.local;
                let along: Vec<_> = varied.iter().map(|varied| varied.stages[i]).collect();
                let bends = along.iter().zip(spacings).map(|((x, y), spacing)| {
                    bend(dynamics, stage.time, [&stage.q, &stage.v], [x, y], *spacing).unwrap_or_else(
                        |found| {
                            breakdown.set(Some((stage.time, found)));
                            Bend { l: Derivatives::zero(), f: CovectorDerivatives::zero() }
                        },
                    )
                });
                let bends: Vec<Bend<N>> = bends.collect();
                for (index, (a, b)) in pairs::<N>().enumerate() {
                    let ((xa, va), (xb, vb)) = (along[a], along[b]);
                    let third = &bends[a];
                    let to_momentum = third.l.d12.tr_mul(&xb) + third.l.d22 * vb;
                    let to_rate = (third.l.d11 + third.f.d1) * xb + (third.l.d12 + third.f.d2) * vb;
                    sources[index].push((to_momentum, to_rate));
                    let bilinear =
                        xa.dot(&(l.d11 * xb + l.d12 * vb)) + va.dot(&(l.d12.tr_mul(&xb) + l.d22 * vb));
                    sums.add(own + count + index, stage.weight * bilinear);
                }
                for (a, (xa, _)) in along.iter().enumerate() {
                    for (b, (xb, vb)) in along.iter().enumerate() {
                        sums.add(a * 2 * N + b, stage.weight * xa.dot(&(f.d1 * xb + f.d2 * vb)));
                    }
                }
            }
            let followed = step.vary(&seconds, Some(&sources));
            for (index, followed) in followed.iter().enumerate() {
                for (stage, (eta, _)) in step.stages.iter().zip(&followed.stages) {
                    sums.add(own + index, stage.weight * stage.local.f.value.dot(eta));
                }
                seconds[index] = followed.end;
            }
            *ends.borrow_mut() = seconds.iter().map(|(eta, _)| *eta).collect();
        })
    };
    let question = Question { blocks: &[own + count, count], visitor: &visitor, rounding: ROUNDING };
    let resolved = dynamics.resolve(&segment.course.quarters[0], segment.h, &question);
    if let Some((time, found)) = breakdown.get() {
        let found: Breakdown = found;
        return Err(found.at(time, dynamics.work));
    }
    let resolved = resolved?;

    let (own_work, rest) = resolved.sums.split_at(own);
    let (work, hessian) = rest.split_at(count);
    let etas: Vec<SVector<f64, N>> = ends.into_inner();
    let mut by_pair = vec![(0.0, 0.0); own];
    for (index, (a, b)) in pairs::<N>().enumerate() {
        let of_w = work[index] - segment.force.plus.dot(&etas[index]);
        by_pair[a * 2 * N + b] = (of_w, hessian[index] - of_w);
        by_pair[b * 2 * N + a] = by_pair[a * 2 * N + b];
    }
    let block = |row: usize, column: usize, entry: &dyn Fn(usize) -> f64| {
        SMatrix::<f64, N, N>::from_fn(|i, j| entry((row + i) * 2 * N + column + j))
    };
    let hessian = |at: usize| by_pair[at].1;
    let jacobian = |at: usize| own_work[at] + by_pair[at].0;
    let lagrangian = Derivatives {
        value: segment.lagrangian.value,
        d1: segment.lagrangian.d1,
        d2: segment.lagrangian.d2,
        d11: block(0, 0, &hessian),
        d12: block(0, N, &hessian),
        d22: block(N, N, &hessian),
    };
    let DiscreteForce { minus, plus } = segment.force;
    let force = DiscreteForceDerivatives {
        minus: CovectorDerivatives { value: minus, d1: block(0, 0, &jacobian), d2: block(0, N, &jacobian) },
        plus: CovectorDerivatives { value: plus, d1: block(N, 0, &jacobian), d2: block(N, N, &jacobian) },
    };
    Ok((lagrangian, force, resolved.difference))
}

/// The derivatives of D²L and Df along (x, y), by central differences.
fn bend<L, const N: usize>(
    dynamics: Dynamics<'_, L, N>,
    time: f64,
    [q, v]: [&SVector<f64, N>; 2],
    [x, y]: [&SVector<f64, N>; 2],
    spacing: f64,
) -> Result<Bend<N>, Breakdown>
where
    L: ActingForce<N, Scalar = f64>,
{
    let mut sum = Bend { l: Derivatives::zero(), f: CovectorDerivatives::zero() };
    for (index, weight) in WEIGHTS.into_iter().enumerate() {
        let shift = spacing * (index + 1) as f64;
        for (shift, weight) in [(shift, weight / spacing), (-shift, -weight / spacing)] {
            let (l, f) = dynamics.derivatives(time, &(q + x * shift), &(v + y * shift))?;
            sum = Bend { l: sum.l + l * weight, f: sum.f + f * weight };
        }
    }
    Ok(sum)
}

/// For each variation the spacing at which halving it changes the differences least, over the quarters of the
/// motion.
///
/// From narrow to wide the spread first falls, as rounding does, and then rises as truncation does.
fn spacings<L, const N: usize>(
    dynamics: Dynamics<'_, L, N>,
    segment: &ExactSegment<N>,
) -> Result<Vec<f64>, ExactError>
where
    L: ActingForce<N, Scalar = f64>,
{
    let mut points = Vec::with_capacity(segment.course.quarters.len());
    for (k, point) in segment.course.quarters.iter().enumerate() {
        let time = segment.h * (0.25 * k as f64);
        let local = dynamics
            .local(time, &point.q, &point.v)
            .map_err(|breakdown| breakdown.at(time, dynamics.work))?;
        points.push(((time, point), Columns::of(point, &local), local));
    }
    // Weights by the masses take the units of the coordinates out of what is compared.
    let unit = SVector::from_fn(|i, _| largest(points.iter().map(|(.., at)| unit_of(at, i))));

    (0..2 * N)
        .map(|a| {
            let index = a % N;
            let reach = segment.q0[index].abs().max(segment.q1[index].abs());
            let size = if reach > 0.0 { reach } else { 1.0 };
            let differences = |spacing: f64| -> Option<Vec<Bend<N>>> {
                let along = points.iter().map(|((time, point), columns, _)| {
                    bend(dynamics, *time, [&point.q, &point.v], [&columns.q[a], &columns.v[a]], spacing).ok()
                });
                along.collect()
            };
            let mut best: Option<(f64, f64)> = None;
            let mut narrow: Option<Vec<Bend<N>>> = None;
            for power in SPACINGS {
                let spacing = size * 2.0_f64.powi(power);
                let wide = differences(spacing);
                if let (Some(narrow), Some(wide)) = (&narrow, &wide) {
                    // Differences that agree by chance are no better than rounding.
                    let spread =
                        points.iter().zip(wide.iter().zip(narrow)).map(|((.., at), (wide, narrow))| {
                            let at = Bend { l: at.l, f: at.f };
                            spread(&unit, [&at, wide, narrow], spacing)
                        });
                    let spread = largest(spread.chain([f64::EPSILON / spacing]));
                    match best {
                        Some((least, _)) if spread > OUTGROWN * least => break,
                        Some((least, _)) if spread >= least => {}
                        _ => best = Some((spread, spacing)),
                    }
                }
                narrow = wide;
            }
            match best {
                Some((spread, spacing)) if spread * spacing <= ROUGH => Ok(spacing),
                _ => Err(ExactError::NotDifferentiable { index }),
            }
        })
        .collect()
}

/// Largest disagreement of two differences, relative to the derivatives that were differenced, in
/// mass-weighted coordinates.
fn spread<const N: usize>(unit: &SVector<f64, N>, [at, wide, narrow]: [&Bend<N>; 3], spacing: f64) -> f64 {
    let matrices = |bend: &Bend<N>| {
        [bend.l.d11, bend.l.d12, bend.l.d22, bend.f.d1, bend.f.d2]
            .map(|matrix| SMatrix::<f64, N, N>::from_fn(|i, j| matrix[(i, j)] / (unit[i] * unit[j])))
    };
    let mut worst = 0.0_f64;
    for ((at, wide), narrow) in matrices(at).iter().zip(matrices(wide)).zip(matrices(narrow)) {
        let size = |matrix: &SMatrix<f64, N, N>| largest(matrix.iter().copied());
        let apart = size(&(wide - narrow));
        if apart != 0.0 {
            worst = largest([worst, apart / size(at).max(spacing * size(&narrow))]);
        }
    }
    worst
}
