//! J is kept iff the defect vanishes, also where neither ξ(L_d) nor f_d(ξ) does: Noether's theorem asks for
//! the sum alone.

use dalembert::noether::Generator;
use dalembert::{Discretise, Midpoint, State, rayleigh_system, samples};

/// A weight on a rope that is pulled with just that force.
#[derive(Clone, Copy)]
struct Weight {
    g: f64,
    pull: f64,
}

#[rayleigh_system]
impl Weight {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - self.g * q[0]
    }
    fn force(&self, _q: [f64; 1], _v: [f64; 1]) -> [f64; 1] {
        [self.pull]
    }
}

#[test]
fn a_force_that_balances_the_potential_keeps_the_momentum() {
    let segments = samples::segments([-1.0], [1.0], [0.3], 50);
    let up = Generator::translation("up", [1.0]);
    let balanced = Weight { g: 9.81, pull: 9.81 };
    let report = balanced.by(Midpoint, 0.1).noether().symmetry(&up, &segments).unwrap();
    assert!(
        !report.is_symmetry_of_lagrangian() && report.force_does_work() && report.is_conserved(),
        "{report}"
    );
    let start = State::from_velocity(&balanced, [0.0], [0.7]).unwrap();
    let end = balanced.by(Midpoint, 0.1).run(start).take(100).last().unwrap().unwrap();
    assert!((end.state.p[0] - 0.7).abs() < 1e-13);

    // Positive control: one part in 1e9 too little.
    let sinking = Weight { g: 9.81, pull: 9.81 * (1.0 - 1e-9) };
    let report = sinking.by(Midpoint, 0.1).noether().symmetry(&up, &segments).unwrap();
    assert!(!report.is_conserved(), "{report}");
    assert!((report.defect.value + 9.81e-10).abs() < 1e-14, "{report}");
}
