//! Where programs are evaluated.

use super::random::Random;
use super::syntax::Program;

/// Points of a program.
pub const POINTS: usize = 3;

/// (q, v), with the input and the time.
#[derive(Clone, Debug)]
pub struct Point {
    pub q: Vec<f64>,
    pub v: Vec<f64>,
    pub u: Vec<f64>,
    pub t: f64,
}

/// The points of a program, the same for every run of its seed; numbers that an f32 holds.
pub fn points(program: &Program) -> Vec<Point> {
    let mut random = Random::new(program.seed ^ 0x5eed_0f90_1275);
    let mut entries = |n| (0..n).map(|_| f64::from((random.unit() * 2.4 - 0.9) as f32)).collect();
    let points: Vec<_> = (0..POINTS).map(|_| (entries(program.n), entries(program.n))).collect();
    let given = |(q, v)| Point { q, v, u: entries(program.inputs), t: entries(1)[0] };
    points.into_iter().map(given).collect()
}
