//! What the macro generates warns of nothing: this module denies all warnings, those of clippy, pedantic and
//! nursery among them, and rustc's stricter ones.
//!
//! The systems are private and hardly used, so that generated code that nothing calls would be dead code.
//! Public ones, which need documentation, are in this package's library.
#![deny(warnings)]
#![deny(missing_docs, missing_debug_implementations, unused, nonstandard_style)]
#![deny(unused_qualifications, unused_lifetimes, single_use_lifetimes, trivial_casts)]
#![deny(trivial_numeric_casts, let_underscore_drop, missing_copy_implementations, redundant_imports)]
#![deny(elided_lifetimes_in_paths, explicit_outlives_requirements, unit_bindings, variant_size_differences)]
#![deny(clippy::all, clippy::pedantic, clippy::nursery)]
#![allow(clippy::suboptimal_flops, reason = "the bodies are the user's own, and stand as written")]

use dalembert::rayleigh_system;
use dalembert_tests::documented;

/// Private, never constructed but in a test: no warning of dead code for its functions.
#[derive(Debug, Clone, Copy)]
struct Private {
    k: f64,
    n: usize,
}

#[rayleigh_system(rule = [midpoint, trapezoidal], derivatives = num_dual)]
impl Private {
    const G: f64 = 9.81;
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let mut sum = 0.0;
        for i in 0..self.n {
            sum += v[i % 2] * v[i % 2] - Self::G * self.height(&q);
        }
        sum * f64::from(u8::from(q[0] > 1.0))
    }
    fn rayleigh(&self, _q: [f64; 2], v: [f64; 2]) -> f64 {
        self.k * v[0] * v[0]
    }
    #[allow(clippy::unused_self, reason = "forces take the system")]
    fn force(&self, q: [f64; 2], _: [f64; 2]) -> [f64; 2] {
        [Self::quiet(q[0], 1), q[1]]
    }
    fn height(&self, q: &[f64; 2]) -> f64 {
        q[0] * self.k
    }
    const fn unrelated(self) -> usize {
        self.n
    }
    #[allow(clippy::missing_const_for_fn, reason = "differentiated functions are not `const`")]
    #[expect(unused_variables, reason = "lint levels follow the body")]
    fn quiet(x: f64, n: usize) -> f64 {
        x
    }
}

#[rayleigh_system(derivatives = num_dual)]
fn private_function(q: [f64; 1], v: [f64; 1], m: f64, n: i32) -> (f64, f64) {
    (m * v[0] * v[0] - q[0].powi(n), v[0] * v[0])
}

#[rayleigh_system]
fn lagrangian_alone(q: [f64; 1], v: [f64; 1]) -> f64 {
    v[0].mul_add(v[0], -q[0])
}

#[test]
#[allow(clippy::float_cmp, clippy::suboptimal_flops, reason = "exact values, as written")]
fn systems_that_warn_of_nothing_work() {
    use dalembert::{Discretise, Lagrangian, Midpoint, nalgebra::vector};
    let private = Private { k: 1.0, n: 2 };
    assert_eq!(private.unrelated(), 2);
    let p = private.by(Midpoint, 0.1).legendre_minus(&vector![2.0, 0.0], &vector![2.0, 0.1]).p;
    // p = 2 v̄ − (h/2) f at q̄ = (2, 0.05), v̄ = (0, 1).
    assert!((p[1] - (2.0 - 0.05 * 0.05)).abs() < 1e-14, "{p}");
    assert_eq!(documented::oscillator([1.0], [2.0], 3.0, 4.0, 0.5), (4.0, 1.0));
    assert_eq!(
        documented::Oscillator { m: 3.0, k: 4.0, r: 0.5 }.lagrangian(&vector![1.0], &vector![2.0]),
        4.0
    );
    assert_eq!(documented::Free.lagrangian([0.0], [2.0]), 2.0);
    assert_eq!(PrivateFunction { m: 3.0, n: 2 }.lagrangian(&vector![1.0], &vector![2.0]), 11.0);
    assert_eq!(LagrangianAlone.lagrangian(&vector![1.0], &vector![2.0]), 3.0);
}
