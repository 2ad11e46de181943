//! Second variations of the motion: D11, D12, D22 of L_d^ex and the Jacobians of f_d^ex.
//!
//! With parameters a, b among q0 and q1, δ_a q the first variations and w = ∂²q/∂a∂b, which vanishes at both ends,
//!
//! ```text
//! ∂_b f_a = ∫ (f_q δ_b q + f_v δ_b v)·δ_a q dt + ∫ f·w dt
//! ∂_a ∂_b L_d^ex = ∫ L″[δ_a, δ_b] dt − ∫ f·w dt
//! ```
//!
//! since (L_q, L_v) along w is a total derivative less f·w. The second variation is carried from zero initial values as
//! (η, ζ) = (δ²q, δ²p); returning its end to zero by a variation of q1 gives ∫ f·w dt = ∫ f·η dt − f_d^ex+·η(h).
//!
//! The sources of (η, ζ) are third derivatives of L and second ones of f along δ_a. [`Lagrangian`] does not give these:
//! they are central differences of order 8 of the second derivatives, along δ_a, with a spacing that the motion itself is
//! asked for: the one whose result changes least when it is halved.

use nalgebra::{SMatrix, SVector};

use super::motion::{Dynamics, Local, Point, Reader, Writer};
use super::resolve::{Breakdown, Problem};
use super::segment::Segment;
use super::{ActingForce, ExactError};
use crate::{CovectorDerivatives, Derivatives, DiscreteForce, DiscreteForceDerivatives, Lagrangian};

/// Second derivatives of the exact discrete objects on a segment.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SecondDerivatives<const N: usize> {
    /// L_d^ex with D1, D2, D11, D12, D22.
    pub lagrangian: Derivatives<f64, N>,
    /// f_d^ex± with D1 and D2.
    pub force: DiscreteForceDerivatives<f64, N>,
    /// Absolute error estimate of the entries of D11, D12, D22 of L_d^ex: how much halving the spacing of the differences
    /// changes them, and the relative error of the integration times their size.
    pub lagrangian_error: f64,
    /// Absolute error estimate of the entries of D1, D2 of f_d^ex±, likewise.
    pub force_error: f64,
}

/// Weights of the central difference of order 8, for ±1, ±2, ±3, ±4 spacings.
const WEIGHTS: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];

/// Spacings tried, in powers of 2 of the coordinate's size, narrow ones first.
const SPACINGS: core::ops::Range<i32> = -20..20;

/// A spread so many times the least so far shows that the spacing has outgrown the functions. Wider ones are not tried:
/// their differences may agree again, having stepped over what is to be differenced.
const OUTGROWN: f64 = 1e3;

/// Differences that disagree by more over one spacing, relative to the second derivatives, show that there is no third
/// derivative: those of a jump disagree by about 1 at every spacing.
const ROUGH: f64 = 1e-6;

/// The differences round: the second variations may stop converging at this relative error, which is then reported.
const ROUNDING: f64 = 1e-6;

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
        let q = families.iter().flat_map(|family| family.q.column_iter().map(|column| column.into_owned()));
        let velocities = families.map(|family| local.velocities(family));
        let v = velocities.iter().flat_map(|family| family.column_iter().map(|column| column.into_owned()));
        Self { q: q.collect(), v: v.collect() }
    }
}

/// The unordered pairs of 2N parameters, a ≤ b.
fn pairs<const N: usize>() -> impl Iterator<Item = (usize, usize)> {
    (0..2 * N).flat_map(|a| (a..2 * N).map(move |b| (a, b)))
}

pub(super) fn second_derivatives<L, F, const N: usize>(
    dynamics: Dynamics<'_, L, F, N>,
    segment: &Segment<N>,
) -> Result<SecondDerivatives<N>, ExactError>
where
    L: Lagrangian<N, Scalar = f64>,
    F: ActingForce<L, N>,
{
    let spacings = spacings(dynamics, segment)?;
    let halved: Vec<f64> = spacings.iter().map(|spacing| spacing / 2.0).collect();
    let (lagrangian, force, integration) = carry(dynamics, segment, &spacings)?;
    let (other, ..) = carry(dynamics, segment, &halved)?;
    // The differences enter both through ∫ f·w dt alone.
    let hessian = |l: &Derivatives<f64, N>| [l.d11, l.d12, l.d22];
    let largest = |blocks: &[SMatrix<f64, N, N>]| blocks.iter().map(SMatrix::amax).fold(0.0, f64::max);
    let jacobian = [force.minus.d1, force.minus.d2, force.plus.d1, force.plus.d2];
    let spread = hessian(&lagrangian)
        .iter()
        .zip(&hessian(&other))
        .map(|(wide, narrow)| (wide - narrow).amax())
        .fold(0.0, f64::max);
    let relative = integration.max(segment.report.error());
    Ok(SecondDerivatives {
        lagrangian_error: spread + relative * largest(&hessian(&lagrangian)),
        force_error: spread + relative * largest(&jacobian),
        lagrangian,
        force,
    })
}

/// D²L_d^ex and Df_d^ex with these spacings, and the relative error of the integration.
fn carry<L, F, const N: usize>(
    dynamics: Dynamics<'_, L, F, N>,
    segment: &Segment<N>,
    spacings: &[f64],
) -> Result<(Derivatives<f64, N>, DiscreteForceDerivatives<f64, N>, f64), ExactError>
where
    L: Lagrangian<N, Scalar = f64>,
    F: ActingForce<L, N>,
{
    let h = segment.h;
    let count = pairs::<N>().count();
    let (motion, variations) = (Point::<N>::LENGTH, 2 * N * count);
    let own = 4 * N * N;
    // Beside the motion: ∫ (f′ δ_b)·δ_a, ∫ f·η, ∫ L″[δ_a, δ_b], then η of all pairs and ζ of all pairs. The first two make up
    // one Jacobian and are judged together; η and ζ are not judged, as they matter through ∫ f·η alone.
    let blocks: Vec<usize> = Point::<N>::BLOCKS.into_iter().chain([own + count, count]).collect();
    let mut numbers = vec![0.0; motion + own + 2 * count + variations];
    segment.start.write(&mut numbers);

    let rate = |y: &[f64], rate: &mut [f64]| {
        let (point, local) = dynamics.point_rate(y, &mut rate[..motion], h)?;
        let Local { l, f, .. } = &local;
        let along = Columns::of(&point, &local);
        let mut bends = Vec::with_capacity(2 * N);
        for ((x, y), spacing) in along.q.iter().zip(&along.v).zip(spacings) {
            bends.push(bend(dynamics, &point, x, y, *spacing)?);
        }

        let (own_rates, rest) = rate[motion..].split_at_mut(own);
        let (work_rates, rest) = rest.split_at_mut(count);
        let (hessian_rates, rest) = rest.split_at_mut(count);
        let (eta_rates, zeta_rates) = rest.split_at_mut(N * count);
        let (etas, zetas) = y[motion + own + 2 * count..].split_at(N * count);
        let (mut etas, mut zetas) = (Reader(etas), Reader(zetas));
        let (mut eta_rates, mut zeta_rates) = (Writer(eta_rates), Writer(zeta_rates));
        for (index, (a, b)) in pairs::<N>().enumerate() {
            let (xa, va, xb, vb) = (&along.q[a], &along.v[a], &along.q[b], &along.v[b]);
            let third = &bends[a];
            let to_momentum = third.l.d12.tr_mul(xb) + third.l.d22 * vb;
            let to_rate = (third.l.d11 + third.f.d1) * xb + (third.l.d12 + third.f.d2) * vb;
            let (eta, zeta) = (etas.vector::<N>(), zetas.vector::<N>());
            let w = local.velocity(&eta, &zeta, &to_momentum);
            eta_rates.put((w * h).as_slice());
            zeta_rates.put(((local.momentum_rates(&eta, &w) + to_rate) * h).as_slice());
            work_rates[index] = f.value.dot(&eta) * h;
            hessian_rates[index] =
                (xa.dot(&(l.d11 * xb + l.d12 * vb)) + va.dot(&(l.d12.tr_mul(xb) + l.d22 * vb))) * h;
        }
        for a in 0..2 * N {
            for b in 0..2 * N {
                own_rates[a * 2 * N + b] = along.q[a].dot(&(f.d1 * along.q[b] + f.d2 * along.v[b])) * h;
            }
        }
        Ok(())
    };
    let resolved = Problem { start: numbers, blocks: &blocks, rate, h, rounding: ROUNDING }.resolve(0.0)?;

    let (own_work, rest) = resolved.end[motion..].split_at(own);
    let (work, rest) = rest.split_at(count);
    let (hessian, etas) = rest.split_at(count);
    let mut etas = Reader(etas);
    let mut by_pair = vec![(0.0, 0.0); own];
    for (index, (a, b)) in pairs::<N>().enumerate() {
        let of_w = work[index] - segment.force.plus.dot(&etas.vector::<N>());
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
fn bend<L, F, const N: usize>(
    dynamics: Dynamics<'_, L, F, N>,
    point: &Point<N>,
    x: &SVector<f64, N>,
    y: &SVector<f64, N>,
    spacing: f64,
) -> Result<Bend<N>, Breakdown>
where
    L: Lagrangian<N, Scalar = f64>,
    F: ActingForce<L, N>,
{
    let mut sum = Bend { l: Derivatives::zero(), f: CovectorDerivatives::zero() };
    for (index, weight) in WEIGHTS.into_iter().enumerate() {
        let shift = spacing * (index + 1) as f64;
        for (shift, weight) in [(shift, weight / spacing), (-shift, -weight / spacing)] {
            let (l, f) = dynamics.derivatives(&(point.q + x * shift), &(point.v + y * shift))?;
            sum = Bend { l: sum.l + l * weight, f: sum.f + f * weight };
        }
    }
    Ok(sum)
}

/// For each variation the spacing at which halving it changes the differences least, over the quarters of the motion.
///
/// From narrow to wide the spread first falls, as rounding does, and then rises as truncation does.
fn spacings<L, F, const N: usize>(
    dynamics: Dynamics<'_, L, F, N>,
    segment: &Segment<N>,
) -> Result<Vec<f64>, ExactError>
where
    L: Lagrangian<N, Scalar = f64>,
    F: ActingForce<L, N>,
{
    let start = |_| ExactError::MotionNotFinite { time: 0.0 };
    let mut points = Vec::with_capacity(segment.quarters.len());
    for point in &segment.quarters {
        let local = dynamics.local(&point.q, &point.v).map_err(start)?;
        points.push((point, Columns::of(point, &local), Bend { l: local.l, f: local.f }));
    }
    // Weights by the masses take the units of the coordinates out of what is compared.
    let unit = SVector::from_fn(|i, _| {
        let row = |at: &Bend<N>| match at.l.d22[(i, i)].abs() {
            0.0 => at.l.d22.row(i).amax(),
            own => own,
        };
        points.iter().map(|(.., at)| row(at)).fold(0.0, f64::max).sqrt()
    });

    (0..2 * N)
        .map(|a| {
            let index = a % N;
            let reach = segment.q0[index].abs().max(segment.q1[index].abs());
            let size = if reach > 0.0 { reach } else { 1.0 };
            let differences = |spacing: f64| -> Option<Vec<Bend<N>>> {
                let along = points.iter().map(|(p, c, _)| bend(dynamics, p, &c.q[a], &c.v[a], spacing).ok());
                along.collect()
            };
            let mut best: Option<(f64, f64)> = None;
            let mut narrow: Option<Vec<Bend<N>>> = None;
            for power in SPACINGS {
                let spacing = size * 2.0_f64.powi(power);
                let wide = differences(spacing);
                if let (Some(narrow), Some(wide)) = (&narrow, &wide) {
                    // Differences that agree by chance are no better than rounding.
                    let spread = points
                        .iter()
                        .zip(wide.iter().zip(narrow))
                        .map(|((.., at), (wide, narrow))| spread(&unit, [at, wide, narrow], spacing))
                        .fold(f64::EPSILON / spacing, f64::max);
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

/// Largest disagreement of two differences, relative to the derivatives that were differenced, in mass-weighted coordinates.
fn spread<const N: usize>(unit: &SVector<f64, N>, [at, wide, narrow]: [&Bend<N>; 3], spacing: f64) -> f64 {
    let matrices = |bend: &Bend<N>| {
        [bend.l.d11, bend.l.d12, bend.l.d22, bend.f.d1, bend.f.d2]
            .map(|matrix| SMatrix::<f64, N, N>::from_fn(|i, j| matrix[(i, j)] / (unit[i] * unit[j])))
    };
    let mut worst = 0.0_f64;
    for ((at, wide), narrow) in matrices(at).iter().zip(matrices(wide)).zip(matrices(narrow)) {
        let apart = (wide - narrow).amax();
        if apart > 0.0 {
            worst = worst.max(apart / at.amax().max(spacing * narrow.amax()));
        }
    }
    worst
}
