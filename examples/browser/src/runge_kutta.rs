//! The classical Runge–Kutta method of order 4, beside which the page shows the rules. It knows nothing of L
//! and R but the equations of motion:
//!
//! ```text
//! q̇ = v,   (∂²L/∂v²) v̇ = ∂L/∂q − (∂²L/∂v∂q) v − ∂R/∂v
//! ```

use dalembert::Rayleigh;
use dalembert::nalgebra::SMatrix;

/// The columns q and v.
pub type Motion<const N: usize> = SMatrix<f64, N, 2>;

/// Where a step of size `h` leads; not finite where the mass matrix is singular or the motion leaves the
/// numbers.
pub fn runge_kutta_4<L: Rayleigh<N, Scalar = f64>, const N: usize>(
    system: &L,
    h: f64,
    motion: &Motion<N>,
) -> Motion<N> {
    let k1 = rate(system, motion);
    let k2 = rate(system, &(motion + 0.5 * h * k1));
    let k3 = rate(system, &(motion + 0.5 * h * k2));
    let k4 = rate(system, &(motion + h * k3));
    motion + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
}

/// The columns q̇ and v̇.
fn rate<L: Rayleigh<N, Scalar = f64>, const N: usize>(system: &L, motion: &Motion<N>) -> Motion<N> {
    let (q, v) = (motion.column(0).into(), motion.column(1).into());
    let l = system.lagrangian_derivatives(&q, &v);
    let force = l.d1 - l.d12.transpose() * v - system.rayleigh_gradient(&q, &v).d2;
    let mut rate = Motion::<N>::repeat(f64::NAN);
    rate.set_column(0, &v);
    if let Some(inverse) = l.d22.try_inverse() {
        rate.set_column(1, &(inverse * force));
    }
    rate
}
