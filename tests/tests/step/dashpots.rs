//! Light bodies in a row with strong dashpots between them, on a constraint and on a rough floor: the Newton
//! matrix is a band whose rows have to be exchanged beyond it.

use dalembert::nalgebra::{SMatrix, SVector};
use dalembert::{Discretise, Midpoint, Proximal, State, rayleigh_system};

const H: f64 = 0.05;
const FRICTION: f64 = 0.1;

struct Row {
    m: f64,
    c: f64,
}

/// L and R of the row, without what holds it.
#[rayleigh_system]
impl Row {
    fn lagrangian(&self, q: [f64; 5], v: [f64; 5]) -> f64 {
        let mut sum = 0.0;
        for i in 0..5 {
            sum += 0.5 * self.m * v[i] * v[i] - 0.5 * q[i] * q[i];
        }
        sum
    }

    fn rayleigh(&self, v: [f64; 5]) -> f64 {
        let mut sum = 0.0;
        for i in 1..5 {
            sum += 0.5 * self.c * (v[i] - v[i - 1]) * (v[i] - v[i - 1]);
        }
        sum
    }

    fn constraints(&self, q: [f64; 5]) -> [f64; 1] {
        [q[0] - 0.5]
    }
}

struct Rough {
    m: f64,
    c: f64,
}

#[rayleigh_system(rule = proximal)]
impl Rough {
    fn lagrangian(&self, q: [f64; 5], v: [f64; 5]) -> f64 {
        let mut sum = 0.0;
        for i in 0..5 {
            sum += 0.5 * self.m * v[i] * v[i] - 0.5 * q[i] * q[i];
        }
        sum
    }

    fn rayleigh(&self, v: [f64; 5]) -> f64 {
        let mut sum = 0.1 * v[0].abs();
        for i in 1..5 {
            sum += 0.5 * self.c * (v[i] - v[i - 1]) * (v[i] - v[i - 1]);
        }
        sum
    }
}

/// v̄ of p = M v̄ + (h/2)(K q̄ + C v̄) + (h/2) e₀ λ, dense: where q0 stands still, and where λ is given.
fn by_hand(m: f64, c: f64, state: &State<f64, 5>, lambda: Option<f64>) -> SVector<f64, 5> {
    let mut matrix = SMatrix::<f64, 6, 6>::identity();
    let mut right = SVector::<f64, 6>::zeros();
    for i in 0..5 {
        matrix[(i, i)] = m + 0.25 * H * H;
        right[i] = state.p[i] - 0.5 * H * state.q[i];
    }
    for i in 1..5 {
        for (j, k, sign) in [(i, i, 1.0), (i - 1, i - 1, 1.0), (i, i - 1, -1.0), (i - 1, i, -1.0)] {
            matrix[(j, k)] += 0.5 * H * c * sign;
        }
    }
    match lambda {
        Some(lambda) => right[0] -= 0.5 * H * lambda,
        None => {
            (matrix[(0, 5)], matrix[(5, 0)], matrix[(5, 5)]) = (0.5 * H, 1.0, 0.0);
            right[5] = (0.5 - state.q[0]) / H;
        }
    }
    // Rows exchanged as full pivoting likes.
    matrix.full_piv_lu().solve(&right).unwrap().fixed_rows::<5>(0).into_owned()
}

#[test]
fn strong_dashpots_between_light_bodies_are_solved_for() {
    let q = [0.5, 0.1, -0.2, 0.3, 0.9];
    for c in [1.0, 1e2, 1e3, 1e4, 1e6, 1e8] {
        for m in [1.0, 1e-3, 1e-6] {
            let row = Row { m, c };
            let held = State::nearest(&row, q, [0.0, 0.1, -0.1, 0.2, 0.0]).unwrap();
            let rough = Rough { m, c };
            let sliding = State::from_velocity(&rough, q, [3.0; 5]).unwrap();
            // Controls: a thousandth less of the dashpots, or of the friction, is seen where it acts.
            let (a, less) = (by_hand(m, c, &held, None), by_hand(m, 0.999 * c, &held, None));
            let slides = [FRICTION, -FRICTION].map(|force| (force, by_hand(m, c, &sliding, Some(force))));
            let b = slides.into_iter().find(|(force, v)| force * v[0] > 0.0);
            let b = b.map_or_else(|| by_hand(m, c, &sliding, None), |(_, v)| v);
            let none = by_hand(m, c, &sliding, Some(0.0));
            let ways =
                [(row.by(Midpoint, H).step(&held), a, less), (rough.by(Proximal, H).step(&sliding), b, none)];
            for (step, expected, other) in ways {
                let found = step.unwrap_or_else(|error| panic!("{c} {m}: {error}")).velocity;
                let off = |other: SVector<f64, 5>| (other - expected).amax() / expected.amax();
                // The condition of the matrix, times rounding.
                let rounding = 1e-15 * (1.0 + c * H / (m + 0.25 * H * H));
                assert!(off(found) < 10.0 * rounding, "{c} {m}: {:e}", off(found));
                assert!(off(other) > 100.0 * rounding, "{c} {m}: {:e}", off(other));
            }
        }
    }
}
