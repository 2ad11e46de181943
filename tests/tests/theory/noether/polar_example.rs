//! The paper's polar example lacks the factor h before V(…) in L_d: as printed, L_d/h does not tend to L.

use dalembert::{Discretise, Midpoint, rayleigh_system};

#[test]
fn the_polar_example_lacks_h_before_the_potential() {
    struct Polar;
    #[rayleigh_system]
    impl Polar {
        fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
            0.5 * (v[0] * v[0] + q[0] * q[0] * v[1] * v[1]) - (q[0] * q[0] - 1.0).powi(2)
        }
    }
    let (q, v) = ([1.3, 0.4], [0.2, 0.7]);
    let continuous = Polar.lagrangian(q, v);
    for h in [1e-2, 1e-4] {
        let end = [q[0] + h * v[0], q[1] + h * v[1]];
        let mean = 0.5 * (q[0] + end[0]);
        let potential = (mean * mean - 1.0).powi(2);
        let kinetic =
            0.5 * h * ((end[0] - q[0]) / h).powi(2) + 0.5 * h * mean * mean * ((end[1] - q[1]) / h).powi(2);
        let midpoint = Polar.by(Midpoint, h).discrete_lagrangian(&q.into(), &end.into());
        assert!((kinetic - h * potential - midpoint).abs() < 1e-15);
        assert!(((kinetic - h * potential) / h - continuous).abs() < h);
        let printed = (kinetic - potential) / h;
        assert!((printed - continuous + potential * (1.0 / h - 1.0)).abs() < 10.0 * h, "{printed}");
        assert!((printed - continuous).abs() > 10.0);
    }
}
