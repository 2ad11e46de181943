//! Runs whose steps follow a time scale of the motion.

use crate::run::Trajectory;
use crate::run::pace::Pace;
use crate::step::Flow;
use crate::system::TimeScale;

/// Steps that follow the motion.
impl<L, M, const N: usize> Trajectory<'_, L, M, N>
where
    L: Flow<M, N>,
{
    /// Lets the steps follow the time scale σ(q) of the system: they are equal in τ, dt = σ dτ. The step size
    /// that the run was given is Δτ; a run that has begun goes on from its last step.
    ///
    /// ```text
    /// λ = ∇σ·v / σ,   1/h_½ = 1/(σ Δτ) − ½ λ(q_0, v_0),   1/h_{n+½} = 1/h_{n−½} − λ(q_n, v_n)
    /// ```
    ///
    /// since d(1/σ)/dτ = −λ along the motion (E. Hairer and G. Söderlind, SIAM J. Sci. Comput. 26, 2005).
    ///
    /// **What is kept.** Each step is one of the method, with a size of its own: momentum maps are kept to
    /// rounding, and forces take what the rule says they take, at any Δτ and with any σ, whatever its
    /// symmetry. By a self-adjoint method the steps lead back from the state and the 1/h that a run ends
    /// with: with −1/h for any L, R and f, and with p reversed and that 1/h where L is even in v and no
    /// friction acts. A run begun anew from σ takes other steps. Reversibility keeps the error of the energy
    /// small over long times without friction; the map of a step is not symplectic, as its h depends on the
    /// state.
    ///
    /// **Why not in τ.** σ(q)(L(q, w/σ(q)) + E) is the Lagrangian, in τ with w = dq/dτ, of the motions of
    /// energy E (H. Poincaré's transformation); its steps of one size are symplectic. It can be written as a
    /// system of its own. Measured on orbits of eccentricity 0.99 and 0.999 over 10⁴ rounds, with σ =
    /// |q|^{3/2}, at equal cost: what is here has less error of the energy, by 30 and 80 times, as no
    /// rounding of E is divided by σ; it needs no E, has forces, and keeps momentum maps that σ does not.
    /// With (t, −E) for coordinates, s L(q, w/s) + (s/σ − 1)²/2c, s = dt/dτ, it has forces too, and costs 3
    /// to 100 times as much, by c.
    ///
    /// [`step_size`](Trajectory::step_size) is that of the last step, and the time the sum of all, with
    /// compensation. Errors: [`StepError::TimeScale`](crate::StepError::TimeScale) besides those of the
    /// steps.
    ///
    /// An orbit of eccentricity 0.99, whose speeds differ by a factor of 199:
    ///
    /// ```
    /// use dalembert::{Discretise, Gauss, State, rayleigh_system};
    ///
    /// struct Kepler;
    ///
    /// #[rayleigh_system(rule = gauss)]
    /// impl Kepler {
    ///     fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
    ///         0.5 * (v[0] * v[0] + v[1] * v[1]) + 1.0 / (q[0] * q[0] + q[1] * q[1]).sqrt()
    ///     }
    ///     fn time_scale(&self, q: [f64; 2]) -> f64 {
    ///         (q[0] * q[0] + q[1] * q[1]).powf(0.75)
    ///     }
    /// }
    /// let start = State { q: [1.99, 0.0].into(), p: [0.0, (0.01_f64 / 1.99).sqrt()].into() };
    /// let mut run = Kepler.by(Gauss::<8>, 0.3).run(start).in_scaled_time();
    /// let mut steps = 0;
    /// while run.time() < std::f64::consts::TAU {
    ///     run.next().unwrap()?;
    ///     steps += 1;
    /// }
    /// assert_eq!(steps, 38);
    /// assert!((run.state().energy(&Kepler)? + 0.5).abs() < 1e-11);
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    #[must_use = "the run given is consumed"]
    pub fn in_scaled_time(mut self) -> Self
    where
        L: TimeScale<N>,
    {
        self.pace = Some(Pace::new(&self.run.at));
        self
    }
}
