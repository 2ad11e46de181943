//! Fifty random systems, compiled with derivatives written out and with num-dual, agree to rounding: value,
//! gradient, Hessian and the step's kernel.
//!
//! How much rounding can do at a point is measured: q, v and the coefficients are moved by about an ulp at
//! random, and what the two engines may differ by is 40 times the spread that this makes, with 64 ulps of the
//! largest result.

mod generator;

use std::path::Path;

use dalembert::nalgebra::{SMatrix, SVector};
use dalembert::step::{Fused, NewtonMatrix, Segment};
use dalembert::system::Derivatives;
use dalembert::{Force, Lagrangian, Midpoint, Rayleigh};

use generator::COEFFICIENTS;

include!("systems.rs");

mod many_coordinates;
mod scales;
mod values;
mod verification;

/// Derivatives written out.
#[allow(unused, clippy::all, reason = "random text")]
mod expanded {
    systems!(expanded);
}

/// Derivatives by num-dual.
#[allow(unused, clippy::all, reason = "random text")]
mod num_dual {
    systems!(num_dual);
}

/// What an engine computes at a point: values, gradients, Hessians, the step's kernel.
type Results = [Vec<f64>; 4];

const GROUPS: [&str; 4] = ["value", "gradient", "Hessian", "step kernel"];

/// q, v and the coefficients.
type Point = Vec<f64>;

/// One system by both engines, from a point to what each computes.
struct System {
    name: &'static str,
    n: usize,
    expanded: fn(&[f64]) -> Results,
    num_dual: fn(&[f64]) -> Results,
}

fn push<const R: usize, const C: usize>(to: &mut Vec<f64>, entries: SMatrix<f64, R, C>) {
    to.extend(entries.iter());
}

fn push_derivatives<const N: usize>(to: &mut Results, derivatives: Derivatives<f64, N>) {
    let Derivatives { value, d1, d2, d11, d12, d22 } = derivatives;
    to[0].push(value);
    push(&mut to[1], d1);
    push(&mut to[1], d2);
    push(&mut to[2], d11);
    push(&mut to[2], d12);
    push(&mut to[2], d22);
}

fn of_lagrangian<S, const N: usize>(system: &S, q: &SVector<f64, N>, v: &SVector<f64, N>) -> Results
where
    S: Lagrangian<N, Scalar = f64> + Fused<Midpoint, N>,
{
    let mut results = Results::default();
    results[0].push(system.lagrangian(q, v));
    push_derivatives(&mut results, system.lagrangian_derivatives(q, v));
    let kernel = system.step_kernel(&Segment { q0: *q, v: *v, h: 0.1 });
    push(&mut results[3], kernel.p0);
    push(&mut results[3], kernel.matrix.dense());
    results
}

fn add_rayleigh<S, const N: usize>(to: &mut Results, system: &S, q: &SVector<f64, N>, v: &SVector<f64, N>)
where
    S: Lagrangian<N, Scalar = f64> + Rayleigh<N>,
{
    push_derivatives(to, system.rayleigh_derivatives(q, v));
}

fn add_force<S, const N: usize>(to: &mut Results, system: &S, q: &SVector<f64, N>, v: &SVector<f64, N>)
where
    S: Lagrangian<N, Scalar = f64> + Force<N>,
{
    let force = system.force_derivatives(q, v);
    push(&mut to[0], force.value);
    push(&mut to[1], force.d1);
    push(&mut to[1], force.d2);
}

/// `(name, n, [rayleigh], [force])` to a `System`.
macro_rules! entry {
    ($name:ident, $n:literal, [$($rayleigh:ident)?], [$($force:ident)?]) => {
        System {
            name: stringify!($name),
            n: $n,
            expanded: entry!(evaluate expanded $name $n [$($rayleigh)?] [$($force)?]),
            num_dual: entry!(evaluate num_dual $name $n [$($rayleigh)?] [$($force)?]),
        }
    };
    (evaluate $engine:ident $name:ident $n:literal [$($rayleigh:ident)?] [$($force:ident)?]) => {
        |at| {
            let system = $engine::$name { c: std::array::from_fn(|k| at[2 * $n + k]) };
            let (q, v) = (SVector::from_fn(|i, _| at[i]), SVector::from_fn(|i, _| at[$n + i]));
            #[allow(unused_mut)]
            let mut results = of_lagrangian::<_, $n>(&system, &q, &v);
            $(entry!(add $rayleigh)(&mut results, &system, &q, &v);)?
            $(entry!(add $force)(&mut results, &system, &q, &v);)?
            results
        }
    };
    (add rayleigh) => { add_rayleigh };
    (add force) => { add_force };
}

fn systems() -> [System; generator::SYSTEMS] {
    every_system!(entry)
}

/// Numbers spread over [0, 1), the same for every run: SplitMix64.
struct Spread(u64);

impl Spread {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// q and v in [−0.9, 0.9], coefficients in [0.2, 1].
    fn point(&mut self, n: usize) -> Point {
        let mut point: Point = (0..2 * n).map(|_| 1.8 * self.next() - 0.9).collect();
        point.extend((0..COEFFICIENTS).map(|_| 0.2 + 0.8 * self.next()));
        point
    }

    /// The point with each number moved by up to an ulp.
    fn moved(&mut self, point: &Point) -> Point {
        point.iter().map(|x| x * (1.0 + (2.0 * self.next() - 1.0) * f64::EPSILON)).collect()
    }
}

/// The largest difference of each group in units of its tolerance, or nothing where the point is too
/// sensitive: at a kink.
fn differences(
    a: impl Fn(&[f64]) -> Results,
    b: impl Fn(&[f64]) -> Results,
    point: &Point,
) -> Option<[f64; 4]> {
    let (at_a, at_b) = (a(point), b(point));
    let mut spreads = at_a.each_ref().map(|group| vec![0.0_f64; group.len()]);
    let mut random = Spread(7);
    for _ in 0..6 {
        let moved = random.moved(point);
        for (exact, moved) in [(&at_a, a(&moved)), (&at_b, b(&moved))] {
            for (spreads, (exact, moved)) in spreads.iter_mut().zip(exact.iter().zip(&moved)) {
                for (spread, (exact, moved)) in spreads.iter_mut().zip(exact.iter().zip(moved)) {
                    *spread = spread.max((exact - moved).abs());
                }
            }
        }
    }
    let scale = at_a.iter().flatten().fold(1.0_f64, |scale, x| scale.max(x.abs()));
    if spreads.iter().flatten().any(|&spread| spread > 1e-9 * scale) {
        return None;
    }
    Some(std::array::from_fn(|group| {
        let pairs = at_a[group].iter().zip(&at_b[group]).zip(&spreads[group]);
        pairs.fold(0.0_f64, |largest, ((a, b), spread)| {
            let difference = (a - b).abs() / (40.0 * spread + 64.0 * f64::EPSILON * scale);
            // A NaN is farther off than anything.
            largest.max(if difference.is_nan() { f64::INFINITY } else { difference })
        })
    }))
}

const POINTS: usize = 40;

#[test]
fn both_engines_agree_to_rounding() {
    let (mut compared, mut failures) = (0, Vec::new());
    for (index, system) in systems().iter().enumerate() {
        let mut random = Spread(index as u64);
        for _ in 0..POINTS {
            let point = random.point(system.n);
            let Some(differences) = differences(system.expanded, system.num_dual, &point) else { continue };
            compared += 1;
            for (group, difference) in GROUPS.iter().zip(differences) {
                if difference > 1.0 {
                    failures.push(format!("{}, {group}, {difference:.1} at {point:?}", system.name));
                }
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    let all = generator::SYSTEMS * POINTS;
    println!("{compared} of {all} points compared");
    assert!(compared * 100 >= all * 98, "{compared} of {all} points compared");
}

/// The control: in every system and every group, a coefficient that is wrong by one part in 10⁹ is found.
#[test]
fn a_wrong_coefficient_is_found() {
    for (index, system) in systems().iter().enumerate() {
        let mut found = [false; 4];
        let mut random = Spread(index as u64);
        for k in 0..COEFFICIENTS {
            for _ in 0..4 {
                let point = random.point(system.n);
                let wrong = |at: &[f64]| {
                    let mut at = at.to_vec();
                    at[2 * system.n + k] *= 1.0 + 1e-9;
                    (system.num_dual)(&at)
                };
                if let Some(differences) = differences(system.expanded, wrong, &point) {
                    found = std::array::from_fn(|group| found[group] || differences[group] > 1.0);
                }
            }
        }
        assert_eq!(found, [true; 4], "{}: {GROUPS:?}", system.name);
    }
}

/// `UPDATE_SYSTEMS=1` writes the file anew.
#[test]
fn the_systems_are_those_of_the_generator() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/random_engines/systems.rs");
    let text = generator::text();
    if std::env::var_os("UPDATE_SYSTEMS").is_some() {
        std::fs::write(&path, &text).expect("the tests may write beside their sources");
    }
    let written = std::fs::read_to_string(&path).expect("the file is there");
    assert!(written == text, "systems.rs is not what generator.rs writes; run with UPDATE_SYSTEMS=1");
    for method in generator::METHODS {
        assert!(text.contains(&format!(".{method}(")), "no system has `{method}`");
    }
    for form in
        ["for ", "if ", "else", ".map(|", ".fold(", "return ", "self.hill(", "let scale = |", ".powf(self.c["]
    {
        assert!(text.contains(form), "no system has `{form}`");
    }
}
