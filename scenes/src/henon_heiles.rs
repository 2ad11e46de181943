//! M. Hénon and C. Heiles' potential (1964): chaotic up to the energy of escape, 1/6.

/// L = ½|v|² − ½(x² + y²) − x²y + ⅓y³; no dissipation, so R is absent.
#[dalembert::rayleigh_system(rule = [midpoint, trapezoidal, gauss], lanes = [explicit, gauss])]
#[must_use]
pub fn henon_heiles(q: [f64; 2], v: [f64; 2]) -> f64 {
    let [x, y] = q;
    let potential = 0.5 * (x * x + y * y) + x * x * y - y * y * y / 3.0;
    0.5 * (v[0] * v[0] + v[1] * v[1]) - potential
}
