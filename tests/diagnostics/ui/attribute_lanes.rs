//! What `lanes = explicit`, `lanes = midpoint` and `lanes = gauss` ask of a system is said at the word.

use dalembert::rayleigh_system;

#[rayleigh_system(rule = trapezoidal, lanes = implicit)]
fn unknown(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] - q[0] * q[0]
}

#[rayleigh_system(lanes = explicit)]
fn by_midpoint(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] - q[0] * q[0]
}

#[rayleigh_system(rule = trapezoidal, lanes = explicit, derivatives = num_dual)]
fn by_duals(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] - q[0] * q[0]
}

#[rayleigh_system(rule = trapezoidal, lanes = explicit)]
fn mass(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * (1.0 + q[0] * q[0]) * v[0] * v[0]
}

#[rayleigh_system(rule = trapezoidal, lanes = explicit)]
fn quadratic_drag(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] - q[0] * q[0], r * v[0].powi(3))
}

#[rayleigh_system(rule = trapezoidal, lanes = explicit)]
fn gyroscopic(q: [f64; 2], v: [f64; 2]) -> f64 {
    0.5 * (v[0] * v[0] + v[1] * v[1]) + q[0] * v[1]
}

struct Pushed;

#[rayleigh_system(rule = trapezoidal, lanes = explicit)]
impl Pushed {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q[0]
    }

    fn force(&self, q: [f64; 1], v: [f64; 1]) -> [f64; 1] {
        [-q[0] * v[0]]
    }
}

struct Driven;

#[rayleigh_system(rule = trapezoidal, lanes = explicit)]
impl Driven {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
        0.5 * v[0] * v[0] - t * q[0] + t * v[0]
    }

    fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1], t: f64) -> [f64; 1] {
        [u[0] * t]
    }
}

struct Table {
    stiffness: [f64; 3],
    row: usize,
}

#[rayleigh_system(rule = trapezoidal, lanes = explicit)]
impl Table {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        let k = if q[0] > 0.0 { self.stiffness[self.row] } else { 1.0 };
        0.5 * v[0] * v[0] - k * q[0] * q[0]
    }
}

#[rayleigh_system(rule = trapezoidal, lanes = explicit)]
fn rounded(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] - q[0].floor()
}

#[rayleigh_system(rule = trapezoidal, lanes = [explicit, gauss, explicit])]
fn twice(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] - q[0] * q[0]
}

#[rayleigh_system(rule = trapezoidal, lanes = [explicit, gauss])]
fn without_gauss(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] - q[0] * q[0]
}

#[rayleigh_system(rule = gauss, lanes = gauss)]
fn exchanged(q: [f64; 2], v: [f64; 2]) -> f64 {
    v[0] * v[1] - q[0] * q[1]
}

#[rayleigh_system(rule = trapezoidal, lanes = midpoint)]
fn without_midpoint(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] - q[0] * q[0]
}

#[rayleigh_system(lanes = [midpoint, mid_point])]
fn misspelt(q: [f64; 1], v: [f64; 1]) -> f64 {
    0.5 * v[0] * v[0] - q[0] * q[0]
}

struct Rows {
    stiffness: [f64; 3],
    row: usize,
}

#[rayleigh_system(lanes = midpoint)]
impl Rows {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        let k = if q[0] > 0.0 { self.stiffness[self.row] } else { 1.0 };
        0.5 * v[0] * v[0] - k * q[0] * q[0]
    }
}

struct Plain;

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
impl Plain {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q[0] * q[0]
    }
}

fn main() {
    use dalembert::nalgebra::vector;
    use dalembert::{Splitting, State, run::LaneRuns};
    let start = State { q: vector![0.0], p: vector![1.0] };
    let _ = LaneRuns::new(Splitting::blanes_moan_6(), [&Plain], &[start], 0.1);
    let _ = LaneRuns::new(dalembert::Gauss::<4>, [&Plain], &[start], 0.1);
    let _ = LaneRuns::new(dalembert::Midpoint, [&Plain], &[start], 0.1);
    // No second message where a first one has said what is wrong.
    let _ = LaneRuns::new(Splitting::blanes_moan_6(), [&Mass {}], &[start], 0.1);
    let _ = LaneRuns::new(dalembert::Trapezoidal, [&Rounded {}], &[start], 0.1);
    let _ = LaneRuns::new(Splitting::blanes_moan_6(), [&ByMidpoint {}], &[start], 0.1);
    let _ = LaneRuns::new(dalembert::Gauss::<4>, [&WithoutGauss {}], &[start], 0.1);
    let _ = LaneRuns::new(dalembert::Midpoint, [&WithoutMidpoint {}], &[start], 0.1);
    let _ = LaneRuns::new(dalembert::Midpoint, [&Misspelt {}], &[start], 0.1);
    let driven = Driven;
    let _ = LaneRuns::new(Splitting::blanes_moan_6(), [&driven.driven([1.0], 0.0)], &[start], 0.1);
}
