//! The start of a run: whether the system is the one written.

use nalgebra::SVector;

use crate::numbers::comparison::{self, Apart, MOMENTA};
use crate::numbers::nonlinear::Room;
use crate::numbers::slices::{vector, write};
use crate::numbers::{Derivatives, Scalar, linear};
use crate::step::cause::of_violation;
use crate::step::{ClosedForm, Fused, Momenta, Segment, State, StepError};
use crate::system::{
    Compared, Function, GeneratedDiffers, Lagrangian, Violation, derivatives_apart,
    verification::{around, has_two_values, slopes_around},
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
        if L::IS_CONSTRAINED
            && let Some(violation) = system.violation(&state.q, &nalgebra::zero())
            // Rest may leave constraints that move by themselves.
            && !matches!(violation, Violation::Leaving { .. })
        {
            return Err(of_violation(system, &state.q, &nalgebra::zero(), violation));
        }
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
    corrected(&derivatives_apart(system, &state.q, &SVector::zeros()), &state.p)
}

/// The velocity that one iteration leads to from rest, where L has these derivatives.
#[cold]
#[inline(never)]
fn corrected<S: Scalar, const N: usize>(at_rest: &Derivatives<S, N>, p: &SVector<S, N>) -> SVector<S, N> {
    let (mut v, right) = (SVector::<S, N>::zeros(), p - at_rest.d2);
    if S::is_solved_by_diagonal(at_rest.d22.as_slice(), right.as_slice(), v.as_mut_slice()) {
        return v;
    }
    linear::solve_apart(&at_rest.d22, &right).unwrap_or(v)
}

/// Momenta of a segment, by two ways to compute them.
type TwoWays<'a, S, const N: usize> = &'a dyn Fn(&Segment<S, N>) -> [Momenta<S, N>; 2];

/// D1 L_d, D2 L_d, f_d⁻ and f_d⁺ on a segment.
type ByDerivatives<'a, S, const N: usize> = &'a dyn Fn(&Segment<S, N>) -> [SVector<S, N>; 4];

/// Verifies p0 and p1 of the step from `state`, as `generated`, against the derivatives of L_d and f_d.
#[cold]
#[inline(never)]
pub(crate) fn verify_momenta<L: ClosedForm<R, N> + ?Sized, R, const N: usize>(
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
    compare_momenta(&state.q, &velocity(system, state), h, generated, &|segment| {
        let (l, f) = (system.discrete_lagrangian_derivatives(segment), system.discrete_force(segment));
        [l.d1, l.d2, f.minus, f.plus]
    })
}

/// p0 as the step's equation has it, and both momenta as the step has them.
pub(crate) fn of_equation_and_step<L: Fused<R, N> + ?Sized, R, const N: usize>(
    system: &L,
    segment: &Segment<L::Scalar, N>,
) -> [Momenta<L::Scalar, N>; 2] {
    let momenta = system.momenta(segment);
    [Momenta { p0: system.step_kernel(segment).p0, ..momenta }, momenta]
}

/// Fails where p0 or p1 is off beside (q, v): [`momenta_apart`](crate::numbers::comparison::Compares), for
/// systems of one size.
#[cold]
#[inline(never)]
fn compare_momenta<S: Scalar, const N: usize>(
    q: &SVector<S, N>,
    v: &SVector<S, N>,
    h: S,
    generated: TwoWays<'_, S, N>,
    derivatives: ByDerivatives<'_, S, N>,
) -> Result<(), GeneratedDiffers> {
    let ways = comparison::TwoWays {
        generated: &|q0, v, momenta| {
            let [of_equation, of_step] = generated(&Segment { q0: vector(q0), v: vector(v), h });
            write_each(momenta, &[of_equation.p0, of_equation.p1, of_step.p0, of_step.p1]);
        },
        derivatives: &|q0, q1, found| {
            write_each(found, &derivatives(&Segment::between(&vector(q0), &vector(q1), h)));
        },
    };
    let mut buffer = [[S::constant(0.0); N]; MOMENTA];
    let room = Room::new(buffer.as_flattened_mut(), N);
    match S::momenta_apart(q.as_slice(), v.as_slice(), h, &ways, room) {
        None => Ok(()),
        Some(Apart { index, is_final, generated, written }) => {
            let function = if is_final {
                Function::FinalMomentum { index }
            } else {
                Function::InitialMomentum { index }
            };
            Err(GeneratedDiffers { function, compared: Compared::Value, generated, written })
        }
    }
}

fn write_each<S: Scalar, const N: usize>(to: [&mut [S]; 4], from: &[SVector<S, N>; 4]) {
    let [first, second, third, fourth] = to;
    write(first, &from[0]);
    write(second, &from[1]);
    write(third, &from[2]);
    write(fourth, &from[3]);
}
