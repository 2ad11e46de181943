//! M. Hénon and C. Heiles' potential (1964): chaotic up to the energy of escape, 1/6.

use dalembert::rayleigh_system;

crate::parameters! {
    /// A star of unit mass in the potential ½(x² + y²) + x²y − ⅓y³, without friction; q = (x, y). Dimensionless.
    pub struct HenonHeiles {}
}

#[rayleigh_system(rule = [trapezoidal, gauss], lanes = explicit)]
impl HenonHeiles {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let [x, y] = q;
        0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.5 * (x * x + y * y) - x * x * y + y * y * y / 3.0
    }
}
