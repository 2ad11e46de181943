//! The methods that the scenes compare with: Runge–Kutta methods of the crate `differential-equations`.

use anyhow::{Context, Result, anyhow};
use dalembert::{Rayleigh, State};
use differential_equations::prelude::{ExplicitRungeKutta, IVP, ImplicitRungeKutta, ODE};
use nalgebra::SMatrix;

/// A standard method for first-order equations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// Explicit Euler, order 1, one step from state to state.
    Euler,
    /// Implicit Euler, order 1, one step from state to state.
    ImplicitEuler,
    /// The classical Runge–Kutta method, order 4, one step from state to state.
    RungeKutta4,
    /// Dormand–Prince 8(5,3) with as many steps from state to state as this relative and absolute tolerance
    /// asks for.
    DormandPrince853(f64),
}

/// The states at t = h, 2h, 3h, … of the motion that starts at `start`, by `method`.
///
/// The equations of motion come from the same L and R as the variational step:
///
/// ```text
/// q̇ = v,   (∂²L/∂v²) v̇ = ∂L/∂q − (∂²L/∂v∂q) v − ∂R/∂v
/// ```
///
/// # Errors
/// The start has no velocity; later, that the method gave up or left the finite numbers.
pub fn states<L: Rayleigh<N, Scalar = f64>, const N: usize>(
    system: &L,
    method: Method,
    h: f64,
    start: State<f64, N>,
) -> Result<impl Iterator<Item = Result<State<f64, N>>>> {
    let mut y = SMatrix::from_columns(&[start.q, start.velocity(system)?]);
    let motion = Motion(system);
    Ok(std::iter::repeat_with(move || {
        // Interval by interval: every state is one that the method reached, none is interpolated.
        let interval = IVP::ode(&motion, 0.0, h, y);
        let solution = match method {
            Method::Euler => interval.method(ExplicitRungeKutta::euler(h)).solve(),
            // Newton's method to rounding, so that what remains is the method's.
            Method::ImplicitEuler => interval
                .method(ImplicitRungeKutta::backward_euler(h).newton_tol(1e-14).max_newton_iter(50))
                .solve(),
            Method::RungeKutta4 => interval.method(ExplicitRungeKutta::rk4(h)).solve(),
            Method::DormandPrince853(tolerance) => {
                interval.method(ExplicitRungeKutta::dop853()).rtol(tolerance).atol(tolerance).solve()
            }
        };
        let solution = solution.map_err(|error| anyhow!("{method:?}: {error:?}"))?;
        y = *solution.y.last().context("an interval without a state")?;
        Ok(State::from_velocity(system, y.column(0), y.column(1))?)
    }))
}

/// The equations of motion for the matrix with the columns q and v.
struct Motion<'a, L>(&'a L);

impl<L: Rayleigh<N, Scalar = f64>, const N: usize> ODE<f64, SMatrix<f64, N, 2>> for Motion<'_, L> {
    fn diff(&self, _time: f64, y: &SMatrix<f64, N, 2>, rate: &mut SMatrix<f64, N, 2>) {
        let (q, v) = (y.column(0).into(), y.column(1).into());
        let l = self.0.lagrangian_derivatives(&q, &v);
        let force = l.d1 - l.d12.transpose() * v - self.0.rayleigh_gradient(&q, &v).d2;
        rate.set_column(0, &v);
        match l.d22.try_inverse() {
            Some(inverse) => rate.set_column(1, &(inverse * force)),
            // Nothing can be returned from here; the state that follows is refused because it is not finite.
            None => rate.fill(f64::NAN),
        }
    }
}
