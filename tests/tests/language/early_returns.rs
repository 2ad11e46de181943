//! Tables that are read by early returns, as deep as they are long: each way out has its own value, and what
//! a return reads is read where it is taken alone.

use dalembert::nalgebra::SVector;
use dalembert::{Force, rayleigh_system};

/// Bounds and values, of a coordinate's table and of a field's.
const BOUNDS: [f64; 24] = bounds();
const VALUES: [f64; 24] = values();

const fn bounds() -> [f64; 24] {
    let (mut bounds, mut i) = ([0.0; 24], 0);
    while i < 24 {
        bounds[i] = 0.25 * i as f64;
        i += 1;
    }
    bounds
}

const fn values() -> [f64; 24] {
    let (mut values, mut i) = ([0.0; 24], 0);
    while i < 24 {
        values[i] = ((7 * i) % 24) as f64;
        i += 1;
    }
    values
}

struct Looked {
    m: f64,
    table: Vec<f64>,
    place: usize,
}

#[rayleigh_system(derivatives = expanded)]
impl Looked {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * v[0] * v[0] + 0.5 * v[1] * v[1] + q[0]
    }
    fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        for i in 0..24 {
            if q[0] < BOUNDS[i] {
                return [VALUES[i], v[1]];
            }
        }
        if self.place < 2 {
            // Beyond it there is none.
            return [self.table[self.place], q[1] * v[0]];
        }
        for i in 0..24 {
            if self.m < BOUNDS[i] {
                return [VALUES[i], v[0] * v[0]];
            }
        }
        [q[0], q[1]]
    }
}

/// By hand.
fn expected(system: &Looked, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
    if let Some(i) = BOUNDS.iter().position(|bound| q[0] < *bound) {
        return [VALUES[i], v[1]];
    }
    if let Some(value) = system.table.get(system.place) {
        return [*value, q[1] * v[0]];
    }
    match BOUNDS.iter().position(|bound| system.m < *bound) {
        Some(i) => [VALUES[i], v[0] * v[0]],
        None => q,
    }
}

#[test]
fn tables_read_by_early_returns_have_the_values_of_each() {
    let mut seen = std::collections::BTreeSet::new();
    for place in [0, 1, 2, 7] {
        for m in (0..30).map(|i| 0.25 * f64::from(i) - 0.1) {
            let system = Looked { m, table: vec![5.5, 6.5], place };
            for x in (0..30).map(|i| 0.25 * f64::from(i) - 0.125) {
                let (q, v) = ([x, 0.3], [1.25, -0.5]);
                let force = system.force_derivatives(&SVector::from(q), &SVector::from(v));
                let expected = expected(&system, q, v);
                assert_eq!(<[f64; 2]>::from(force.value), expected, "{place} {m} {x}");
                seen.insert(expected.map(f64::to_bits));
            }
        }
    }
    // Every way out was taken.
    assert!(seen.len() > 24 + 2 + 24, "{}", seen.len());
}
