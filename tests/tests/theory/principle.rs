//! The discrete Lagrange–d'Alembert principle, of which all else is a consequence.

mod configurations;
mod phase_space;

/// f′(0) from values of f at eight places: central differences of order 8.
fn slope(width: f64, f: impl Fn(f64) -> f64) -> f64 {
    let weights = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];
    let pairs = weights.iter().zip(1..).map(|(weight, k)| {
        let at = width * f64::from(k);
        weight * (f(at) - f(-at))
    });
    pairs.sum::<f64>() / width
}
