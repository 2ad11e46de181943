//! What a program must compute at a point: values in the arithmetic of its own numbers, derivatives by
//! num-dual and by central differences in 32 digits.

use double_double::DoubleDouble;

use super::interpret::{Evaluated, Exit, Interpreter, Result};
use super::number::{Dual, Number, VARIABLES};
use super::point::Point;
use super::syntax::Program;

/// Steps of the difference quotients: their errors are about h⁴ times a derivative of order 5 or 6.
const STEP: f64 = 1e-6;

/// Points nearer to a branch or a kink than this many steps say nothing about derivatives.
const MARGIN: f64 = 100.0 * STEP;

/// Where a derivative of anything on the way is larger than this, rounding says more than the program.
const LARGEST: f64 = 1e7;

/// A function of (q, v): its value, gradient and the Hessian, row by row; f has one for each component.
#[derive(Clone)]
pub struct Derived {
    pub gradient: Vec<f64>,
    pub hessian: Vec<f64>,
}

/// Why derivatives are not compared at a point.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Skipped {
    NearBranch,
    TooLarge,
}

/// What is expected at a point.
pub struct Expected {
    /// L, R and f, in this order, as far as there are any.
    pub values: Vec<f64>,
    pub derivatives: std::result::Result<Derivatives, Skipped>,
}

pub struct Derivatives {
    /// num-dual's own where no differences are taken.
    pub by_differences: Vec<Derived>,
    pub by_num_dual: Vec<Derived>,
    /// The largest number on the way, which rounding errors are measured by.
    pub scale: f64,
}

fn all<S: Copy>(evaluated: &Evaluated<S>) -> Vec<S> {
    let force = evaluated.force.iter().flatten().copied();
    [evaluated.lagrangian].into_iter().chain(evaluated.rayleigh).chain(force).collect()
}

/// L, R and f over any number, with the largest size met and the distance from the nearest branch.
fn evaluated<S: Number>(program: &Program, point: &Point, q: &[S], v: &[S]) -> Result<S, (Vec<S>, f64, f64)> {
    let mut interpreter = Interpreter::new(program)?;
    let u: Vec<S> = point.u.iter().copied().map(S::constant).collect();
    let evaluated = interpreter.evaluate([q, v, &u], S::constant(point.t))?;
    Ok((all(&evaluated), interpreter.size, interpreter.distance))
}

/// The values at a point; nothing where the plain function would panic.
pub fn values(program: &Program, point: &Point) -> Option<Vec<f64>> {
    let by_scalar = |is_single: bool| -> std::result::Result<Vec<f64>, ()> {
        if is_single {
            let single = |x: &[f64]| x.iter().map(|x| *x as f32).collect::<Vec<_>>();
            let (values, ..) =
                evaluated(program, point, &single(&point.q), &single(&point.v)).map_err(|_: Exit<f32>| ())?;
            Ok(values.into_iter().map(f64::from).collect())
        } else {
            Ok(evaluated(program, point, &point.q, &point.v).map_err(|_: Exit<f64>| ())?.0)
        }
    };
    by_scalar(program.single).ok()
}

/// Everything at the points of a program, or nothing where its plain functions panic. Differences are taken
/// at the first point that has derivatives; num-dual speaks for the others.
pub fn all_points(program: &Program, points: &[Point]) -> Option<Vec<Expected>> {
    let mut is_first = true;
    points
        .iter()
        .map(|point| {
            let values = values(program, point)?;
            let derivatives = derivatives(program, point, is_first);
            is_first &= derivatives.is_err();
            Some(Expected { values, derivatives })
        })
        .collect()
}

fn derivatives(
    program: &Program,
    point: &Point,
    with_differences: bool,
) -> std::result::Result<Derivatives, Skipped> {
    let n = program.n;
    let entry = |index: usize, value: f64| {
        let mut entry = Dual::constant(value);
        let mut direction = nalgebra::SVector::<f64, VARIABLES>::zeros();
        direction[index] = 1.0;
        entry.v1 = num_dual::Derivative::some(direction.transpose());
        entry
    };
    let q: Vec<Dual> = point.q.iter().enumerate().map(|(i, q)| entry(i, *q)).collect();
    let v: Vec<Dual> = point.v.iter().enumerate().map(|(i, v)| entry(n + i, *v)).collect();
    let (duals, scale, distance) = evaluated(program, point, &q, &v).map_err(|_| Skipped::TooLarge)?;
    // A NaN is not in reach of any comparison.
    if distance <= MARGIN || distance.is_nan() {
        return Err(Skipped::NearBranch);
    }
    if scale >= LARGEST || scale.is_nan() {
        return Err(Skipped::TooLarge);
    }
    let of_dual = |dual: &Dual| {
        let first = dual.v1.0.unwrap_or_default();
        let second = dual.v2.0.unwrap_or_default();
        Derived {
            gradient: (0..2 * n).map(|i| first[i]).collect(),
            hessian: (0..4 * n * n).map(|k| second[(k / (2 * n), k % (2 * n))]).collect(),
        }
    };
    let by_num_dual: Vec<Derived> = duals.iter().map(of_dual).collect();
    let by_differences = if with_differences {
        differences(program, point).ok_or(Skipped::TooLarge)?
    } else {
        by_num_dual.clone()
    };
    Ok(Derivatives { by_differences, by_num_dual, scale: scale.max(1.0) })
}

/// Central differences of order 4.
fn differences(program: &Program, point: &Point) -> Option<Vec<Derived>> {
    let n = program.n;
    let size = 2 * n;
    let shifted = |shifts: &[(usize, i32)]| -> Option<Vec<DoubleDouble>> {
        let mut x: Vec<DoubleDouble> = point.q.iter().chain(&point.v).map(|x| (*x).into()).collect();
        for &(index, by) in shifts {
            x[index] = x[index] + DoubleDouble::from(STEP) * f64::from(by).into();
        }
        let (q, v) = x.split_at(n);
        evaluated(program, point, q, v).ok().map(|(values, ..)| values)
    };
    let combined = |terms: Vec<(f64, Vec<DoubleDouble>)>, divisor: f64| -> Vec<f64> {
        let count = terms[0].1.len();
        let sum = |k: usize| {
            terms
                .iter()
                .fold(DoubleDouble::from(0.0), |sum, (weight, values)| sum + values[k] * (*weight).into())
        };
        (0..count).map(|k| (sum(k) / divisor.into()).high).collect()
    };
    // f'(0) ≈ Σ wₖ f(kh)/12h, the weights of order 4.
    const WEIGHTS: [(i32, f64); 4] = [(-2, 1.0), (-1, -8.0), (1, 8.0), (2, -1.0)];
    const SECOND: [(i32, f64); 5] = [(-2, -1.0), (-1, 16.0), (0, -30.0), (1, 16.0), (2, -1.0)];
    let mut gradients = Vec::new();
    for i in 0..size {
        let terms: Option<Vec<_>> =
            WEIGHTS.iter().map(|&(k, weight)| Some((weight, shifted(&[(i, k)])?))).collect();
        gradients.push(combined(terms?, 12.0 * STEP));
    }
    let mut hessians = vec![Vec::new(); size * size];
    for i in 0..size {
        for j in 0..=i {
            let second = if i == j {
                let terms: Option<Vec<_>> =
                    SECOND.iter().map(|&(k, weight)| Some((weight, shifted(&[(i, k)])?))).collect();
                combined(terms?, 12.0 * STEP * STEP)
            } else {
                let mut terms = Vec::new();
                for &(k, a) in &WEIGHTS {
                    for &(l, b) in &WEIGHTS {
                        terms.push((a * b, shifted(&[(i, k), (j, l)])?));
                    }
                }
                combined(terms, 144.0 * STEP * STEP)
            };
            hessians[j * size + i].clone_from(&second);
            hessians[i * size + j] = second;
        }
    }
    let count = gradients[0].len();
    let derived = |k: usize| Derived {
        gradient: gradients.iter().map(|entry| entry[k]).collect(),
        hessian: hessians.iter().map(|entry| entry[k]).collect(),
    };
    Some((0..count).map(derived).collect())
}
