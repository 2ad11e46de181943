//! The start of a run: whether the system is the one written.

use nalgebra::{ComplexField as _, SVector};

use crate::numbers::{Scalar, linear};
use crate::step::{Discrete, Momenta, State, StepError};
use crate::system::{
    Compared, Function, GeneratedDiffers, Lagrangian, derivatives_apart,
    verification::{around, beside, has_two_values, sizes, slopes_around},
};

impl<S: Scalar, const N: usize> State<S, N> {
    /// Verifies that the derivatives of `system` belong to its functions as written
    /// ([`verification`](crate::system::verification)): values and slopes, here and farther away.
    ///
    /// With the standard library every run does so before its first step; on core alone a program calls it
    /// where it has the time.
    ///
    /// ```
    /// use dalembert::{State, rayleigh_system};
    ///
    /// #[rayleigh_system]
    /// fn oscillator(q: [f64; 1], v: [f64; 1], k: f64) -> f64 {
    ///     0.5 * v[0] * v[0] - 0.5 * k * q[0] * q[0]
    /// }
    ///
    /// let system = Oscillator { k: 4.0 };
    /// let start = State::from_velocity(&system, [0.3], [0.0])?;
    /// start.verify(&system)?;
    /// # Ok::<(), dalembert::StepError>(())
    /// ```
    ///
    /// # Errors
    /// [`StepError::GeneratedDiffers`].
    #[cold]
    #[inline(never)]
    pub fn verify<L: Lagrangian<N, Scalar = S>>(&self, system: &L) -> Result<(), StepError> {
        if !has_two_values(L::STRUCTURE.engine) {
            return Ok(());
        }
        let v = velocity(system, self);
        around(system, &self.q, &v)?;
        Ok(slopes_around(system, &self.q, &v)?)
    }
}

/// Verifies a system where a run starts, `elapsed` after its own time: values, and `with_slopes` slopes too,
/// where there is the standard library.
#[cold]
#[inline(never)]
pub(crate) fn verify_start<L: Lagrangian<N>, const N: usize>(
    system: &L,
    elapsed: f64,
    state: &State<L::Scalar, N>,
    with_slopes: bool,
) -> Result<(), StepError> {
    if !has_two_values(L::STRUCTURE.engine) {
        return Ok(());
    }
    system.later(L::Scalar::constant(elapsed), |system| {
        if cfg!(feature = "std") && with_slopes {
            return state.verify(system);
        }
        Ok(around(system, &state.q, &velocity(system, state))?)
    })
}

/// The velocity of a state, by one Newton iteration for ∂L/∂v(q, v) = p from rest: exact where L is quadratic
/// in v, and a point as good as any elsewhere.
fn velocity<L: Lagrangian<N> + ?Sized, const N: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
) -> SVector<L::Scalar, N> {
    let rest = SVector::zeros();
    let l = derivatives_apart(system, &state.q, &rest);
    let zero = L::Scalar::constant(0.0);
    let is_diagonal = (0..N).all(|i| (0..N).all(|j| (l.d22[(j, i)] != zero) == (i == j)));
    if is_diagonal {
        return (state.p - l.d2).component_div(&l.d22.diagonal());
    }
    linear::solve_apart(&l.d22, &(state.p - l.d2)).unwrap_or(rest)
}

/// Momenta of a segment from q0 with mean velocity v̄, by two ways to compute them.
type TwoWays<'a, S, const N: usize> = &'a dyn Fn(&SVector<S, N>, &SVector<S, N>) -> [Momenta<S, N>; 2];

/// Verifies p0 and p1 of the step from `state`, as `generated`, against the derivatives of L_d and f_d.
///
/// At three points beside the state: at a kink or a jump the two may be on different sides.
#[cold]
#[inline(never)]
pub(crate) fn verify_momenta<L: Discrete<R, N> + ?Sized, R, const N: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
    h: L::Scalar,
    generated: TwoWays<'_, L::Scalar, N>,
) -> Result<(), GeneratedDiffers> {
    // A mass times a step size below these may be none.
    let least = if L::Scalar::EPSILON.widen() > 1e-10 { 1e-12 } else { 1e-100 };
    let is_extreme = !(least..1.0 / least).contains(&h.widen().abs());
    if !L::WRITTEN_OUT || !cfg!(feature = "std") || is_extreme {
        return Ok(());
    }
    let v = velocity(system, state);
    let at = |[of_q, of_v]: [f64; 2]| {
        let (q0, v) = (beside(&state.q, of_q, &sizes(&state.q)), beside(&v, of_v, &sizes(&v)));
        compare_momenta(system, &q0, &v, h, generated(&q0, &v))
    };
    at([0.011, -0.017]).or_else(|_| at([0.013, 0.019])).or_else(|_| at([0.0171, -0.023]))
}

/// p0 as the step's equation has it, and both momenta as the step has them.
pub(crate) fn of_equation_and_step<L: Discrete<R, N> + ?Sized, R, const N: usize>(
    system: &L,
    q0: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
    h: L::Scalar,
) -> [Momenta<L::Scalar, N>; 2] {
    let momenta = system.momenta(q0, v, h);
    [Momenta { p0: system.step_kernel(q0, v, h).p0, ..momenta }, momenta]
}

/// Fails where p0 or p1 is off by more than rounding, and by more than it changes with the last half of the
/// digits of q0 and q1.
fn compare_momenta<L: Discrete<R, N> + ?Sized, R, const N: usize>(
    system: &L,
    q0: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
    h: L::Scalar,
    generated: [Momenta<L::Scalar, N>; 2],
) -> Result<(), GeneratedDiffers> {
    let mut q1 = *q0;
    for i in 0..N {
        q1[i] += h * v[i];
    }
    let precision = L::Scalar::EPSILON.sqrt().widen();
    let near = by_derivatives(system, q0, &q1, h);
    // Asked for where they differ alone.
    let far = || by_derivatives(system, &beside(q0, precision, q0), &beside(&q1, -precision, &q1), h);
    for momenta in generated {
        for index in 0..N {
            let sides = [
                (Function::InitialMomentum { index }, momenta.p0[index]),
                (Function::FinalMomentum { index }, momenta.p1[index]),
            ];
            for (side, (function, generated)) in sides.into_iter().enumerate() {
                let (generated, (written, size)) = (generated.widen(), near[index][side]);
                let off = (generated - written).abs();
                if off <= precision * size {
                    continue;
                }
                let tolerance = precision * size + 16.0 * (far()[index][side].0 - written).abs();
                // What overflows on one of two ways tells nothing.
                if off > tolerance
                    && off.is_finite()
                    && is_steady(off, L::Scalar::EPSILON.widen(), &|width| {
                        let near = (beside(q0, width, q0), beside(&q1, 0.6 * width, &q1));
                        (by_derivatives(system, &near.0, &near.1, h)[index][side].0 - written).abs()
                    })
                {
                    let compared = Compared::Value;
                    return Err(GeneratedDiffers { function, compared, generated, written });
                }
            }
        }
    }
    Ok(())
}

/// Whether momenta change by less than a sixteenth of what two ways are `off` by, over widths from one last
/// place to half the digits: in `change`, by the width.
fn is_steady(off: f64, epsilon: f64, change: &dyn Fn(f64) -> f64) -> bool {
    let places = [1.0, 2.0, 3.0, 5.0, 8.0, 13.0, 40.0].map(|places| places * epsilon);
    let half = [0.1, 0.3, 1.0].map(|share| share * epsilon.sqrt());
    places.into_iter().chain(half).all(|width| 16.0 * change(width) < off && 16.0 * change(-width) < off)
}

/// −D1 L_d − f_d⁻ and D2 L_d + f_d⁺, component by component, each with the size of its terms.
fn by_derivatives<L: Discrete<R, N> + ?Sized, R, const N: usize>(
    system: &L,
    q0: &SVector<L::Scalar, N>,
    q1: &SVector<L::Scalar, N>,
    h: L::Scalar,
) -> [[(f64, f64); 2]; N] {
    let (l, f) = (system.discrete_lagrangian_derivatives(q0, q1, h), system.discrete_force(q0, q1, h));
    core::array::from_fn(|i| {
        let [d1, d2, minus, plus] = [l.d1[i], l.d2[i], f.minus[i], f.plus[i]].map(Scalar::widen);
        let size = d1.abs() + d2.abs() + minus.abs() + plus.abs();
        [(-d1 - minus, size), (d2 + plus, size)]
    })
}
