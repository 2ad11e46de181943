//! The continuous system: a Lagrangian, and where there is one, a Rayleigh function and a general force.
//!
//! ```text
//! ∂L/∂q − d/dt ∂L/∂v − ∂R/∂v + f = 0
//! ```
//!
//! `#[rayleigh_system]` implements these traits; by hand, the value and the derivatives are enough.

use nalgebra::{SMatrix, SVector};

use crate::numbers::{CovectorDerivatives, Derivatives, Direction, Gradient, Scalar, Variations, dot};
use crate::system::{
    Function, GeneratedDiffers, NoDerivative, Normals, Place, Quantity, Structure, Violation,
};

/// A Lagrangian L(q, v) on TQ, Q = ℝᴺ, with its derivatives.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a Lagrangian system with N = {N}",
    label = "no Lagrangian",
    note = "put `#[rayleigh_system]` on an `impl` block of `{Self}` with `fn lagrangian(&self, q: [f64; {N}], v: [f64; {N}]) -> f64`",
    note = "a system whose L takes the time has its Lagrangian at a time: `system.at_time(t)`, or `system.driven(u, t)` with an input"
)]
pub trait Lagrangian<const N: usize> {
    /// `f64` or `f32`.
    type Scalar: Scalar;

    /// The structure of the system, as known when it is compiled.
    const STRUCTURE: Structure = Structure::UNKNOWN;

    /// Whether constraints hold the motion ([`Constrained`](crate::system::Constrained)): then rules that
    /// know none do not compile for the system.
    const IS_CONSTRAINED: bool = false;

    /// Whether some of them are constraints of velocity, which leave a step without a discrete Lagrangian.
    const IS_NONHOLONOMIC: bool = false;

    /// L(q, v).
    fn lagrangian(&self, q: &SVector<Self::Scalar, N>, v: &SVector<Self::Scalar, N>) -> Self::Scalar;

    /// L with ∂L/∂q, ∂L/∂v and its second derivatives at (q, v).
    fn lagrangian_derivatives(
        &self,
        q: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
    ) -> Derivatives<Self::Scalar, N>;

    /// L with ∂L/∂q and ∂L/∂v at (q, v).
    #[inline]
    fn lagrangian_gradient(
        &self,
        q: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
    ) -> Gradient<Self::Scalar, N> {
        self.lagrangian_derivatives(q, v).gradient()
    }

    /// Derivatives of L along `minus` and `plus`, and the mixed one: all that an implicit step asks for.
    #[inline]
    fn lagrangian_variations(
        &self,
        q: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
        minus: Direction<Self::Scalar>,
        plus: Direction<Self::Scalar>,
    ) -> Variations<Self::Scalar, N> {
        self.lagrangian_derivatives(q, v).variations(minus, plus)
    }

    /// `evaluate` for the system as it is at the time `elapsed` from now.
    ///
    /// Leaves the system as it is unless L, R or f take a time: rules call this so that every node of a
    /// segment sees its own.
    #[inline]
    fn later<T>(&self, elapsed: Self::Scalar, evaluate: impl FnOnce(&Self) -> T) -> T
    where
        Self: Sized,
    {
        let _ = elapsed;
        evaluate(self)
    }

    /// Compares the values of L, R and f that were generated together with their derivatives to those of the
    /// functions as written, at (q, v): bit by bit they are equal
    /// ([`verification`](crate::system::verification)).
    ///
    /// A system written by hand has nothing to compare.
    ///
    /// # Errors
    /// [`GeneratedDiffers`] with the function.
    fn verify_generated(
        &self,
        q: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
    ) -> Result<(), GeneratedDiffers> {
        let _ = (q, v);
        Ok(())
    }

    /// Compares the slopes of L, R and f along a direction in (q, v), from the derivatives generated, to
    /// differences of the functions as written ([`verification`](crate::system::verification)).
    ///
    /// A system written by hand has nothing to compare.
    ///
    /// # Errors
    /// [`GeneratedDiffers`] with the function, where the differences leave no doubt.
    fn verify_slopes(
        &self,
        q: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
    ) -> Result<(), GeneratedDiffers> {
        let _ = (q, v);
        Ok(())
    }

    /// The first of L, R and f with a derivative that is NaN or infinite at (q, v); none where all are
    /// finite.
    ///
    /// First and second derivatives, as steps and their derivatives take them. With the standard library a
    /// step that fails asks for it where it evaluated the system, and says so in its error
    /// ([`StepError::NoDerivative`](crate::StepError::NoDerivative)); without it the caller does.
    ///
    /// Generated where L, R or f can lack a derivative, and by num-dual; none otherwise. A system written by
    /// hand makes it of the functions of [`missing`](crate::system::missing). Constraints are asked by
    /// [`violation`](Self::violation).
    ///
    /// ```
    /// use dalembert::{Lagrangian, nalgebra::vector, rayleigh_system};
    ///
    /// #[rayleigh_system(rule = midpoint)]
    /// fn wedge(q: [f64; 1], v: [f64; 1], g: f64) -> f64 {
    ///     0.5 * v[0] * v[0] - g * (q[0] * q[0]).sqrt()
    /// }
    ///
    /// let found = Wedge { g: 9.81 }.without_derivative(&vector![0.0], &vector![1.0]);
    /// assert_eq!(
    ///     found.unwrap().to_string(),
    ///     "the derivative of L by coordinate 0 is NaN or infinite: √s has none at s = 0, \
    ///      in `(q[0] * q[0]).sqrt()`; write √(s + ε²)"
    /// );
    /// assert_eq!(Wedge { g: 9.81 }.without_derivative(&vector![1e-3], &vector![1.0]), None);
    /// ```
    #[cold]
    fn without_derivative(
        &self,
        q: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
    ) -> Option<NoDerivative> {
        let _ = (q, v);
        None
    }

    /// The first operation of L, R, a component of f or a constraint that has no derivative at (q, v), such
    /// as √s at s = 0.
    ///
    /// Generated where derivatives are written out and the function has such operations; none otherwise. An
    /// error of a step asks for it, no step does: [`without_derivative`](Self::without_derivative).
    #[cold]
    fn place_without_derivative(
        &self,
        function: Function,
        q: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
    ) -> Option<Place> {
        let _ = (function, q, v);
        None
    }

    /// The first of the values beside q and v that is no number: an entry of the input or the time held that
    /// is NaN or infinite, with its index, or a field that is NaN. A field may well be infinite, as a limit
    /// that is none.
    ///
    /// Generated; of fields where derivatives are written out, and of the first 64 of those that L, R and f
    /// read. An error of a step asks for it, no step does.
    ///
    /// ```
    /// use dalembert::step::Quantity;
    /// use dalembert::{Lagrangian, rayleigh_system};
    ///
    /// #[rayleigh_system(rule = midpoint)]
    /// fn oscillator(q: [f64; 1], v: [f64; 1], k: f64) -> f64 {
    ///     0.5 * v[0] * v[0] - 0.5 * k * q[0] * q[0]
    /// }
    ///
    /// let found = Oscillator { k: f64::NAN }.non_finite_value();
    /// assert_eq!(found, Some((Quantity::Field { name: "k" }, 0)));
    /// ```
    #[cold]
    fn non_finite_value(&self) -> Option<(Quantity, usize)> {
        None
    }

    /// The first constraint that is NaN or infinite at (q, v), or has such a gradient; else the first one
    /// that (q, v) violates by more than rounding explains, if there are constraints. Generated where the
    /// system has some.
    #[cold]
    fn violation(&self, q: &SVector<Self::Scalar, N>, v: &SVector<Self::Scalar, N>) -> Option<Violation> {
        let _ = (q, v);
        None
    }

    /// The normals of the holonomic constraints at q; none where there are no constraints. Generated where
    /// the system has constraints; checkers ask for it, no step does.
    #[cold]
    fn normals(&self, q: &SVector<Self::Scalar, N>) -> Option<Normals<Self::Scalar, N>> {
        let _ = q;
        None
    }

    /// f_L = −∂R/∂v + f with its derivatives at (q, v), to determine velocities of coordinates without mass
    /// ([`State::velocity`](crate::State::velocity)); nothing where it takes an input or a time that a view
    /// of the system holds.
    ///
    /// Generated where there is R or f. A system written by hand that has such a coordinate hands on its
    /// [`acting_force_derivatives`](crate::system::ActingForce::acting_force_derivatives). Asked where
    /// ∂²L/∂v² is singular; no step asks for it.
    #[cold]
    fn massless_force(
        &self,
        q: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
    ) -> Option<CovectorDerivatives<Self::Scalar, N>> {
        let _ = (q, v);
        Some(CovectorDerivatives::zero())
    }

    /// v with the velocities that dry friction leaves to coordinates without mass, where it acts; nothing
    /// where they do not follow.
    ///
    /// Generated where R has kinks that a rule takes. Asked beside [`massless_force`](Self::massless_force);
    /// no step asks for it.
    #[cold]
    fn massless_velocity(
        &self,
        q: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
    ) -> Option<SVector<Self::Scalar, N>> {
        let _ = (q, v);
        None
    }

    /// E_L(q, v) = v·∂L/∂v − L, the energy. Along the motion dE_L/dt = v·f_L.
    #[inline]
    fn energy(&self, q: &SVector<Self::Scalar, N>, v: &SVector<Self::Scalar, N>) -> Self::Scalar {
        let l = self.lagrangian_gradient(q, v);
        dot(v, &l.d2) - l.value
    }
}

/// Whether L, R or f take a time: a system without is handed on itself.
pub(crate) fn is_timed<L: Lagrangian<N>, const N: usize>(system: &L) -> bool {
    system.later(L::Scalar::constant(1.0), |later| !core::ptr::eq(later, system))
}

/// [`lagrangian_derivatives`](Lagrangian::lagrangian_derivatives) out of line: each place that inlines them
/// is one more copy of all their operations to compile.
#[inline(never)]
pub(crate) fn derivatives_apart<L: Lagrangian<N> + ?Sized, const N: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
) -> Derivatives<L::Scalar, N> {
    system.lagrangian_derivatives(q, v)
}

/// A Rayleigh function R(q, v), with the force −∂R/∂v.
///
/// Normalise R(q, 0) = 0: adding g(q) leaves the continuous system as it is, but shifts the discrete forces
/// by ±(h²/4)∇g.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no Rayleigh function",
    label = "this needs R, and `{Self}` has none",
    note = "add `fn rayleigh(&self, v: [f64; {N}]) -> f64` to the `#[rayleigh_system]` block; `Discrete` holds all that exists without R"
)]
pub trait Rayleigh<const N: usize>: Lagrangian<N> {
    /// R(q, v).
    fn rayleigh(&self, q: &SVector<Self::Scalar, N>, v: &SVector<Self::Scalar, N>) -> Self::Scalar;

    /// R with its first and second derivatives at (q, v).
    fn rayleigh_derivatives(
        &self,
        q: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
    ) -> Derivatives<Self::Scalar, N>;

    /// R with ∂R/∂q and ∂R/∂v at (q, v).
    #[inline]
    fn rayleigh_gradient(
        &self,
        q: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
    ) -> Gradient<Self::Scalar, N> {
        self.rayleigh_derivatives(q, v).gradient()
    }

    /// Derivatives of R along `minus` and `plus`, and the mixed one.
    #[inline]
    fn rayleigh_variations(
        &self,
        q: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
        minus: Direction<Self::Scalar>,
        plus: Direction<Self::Scalar>,
    ) -> Variations<Self::Scalar, N> {
        self.rayleigh_derivatives(q, v).variations(minus, plus)
    }
}

/// A general force f(q, v), a covector at q, that need not come from a Rayleigh function.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no general force",
    label = "this needs `force`, and `{Self}` has none",
    note = "add `fn force(&self, q: [f64; {N}], v: [f64; {N}]) -> [f64; {N}]` to the `#[rayleigh_system]` block"
)]
pub trait Force<const N: usize>: Lagrangian<N> {
    /// f(q, v).
    fn force(&self, q: &SVector<Self::Scalar, N>, v: &SVector<Self::Scalar, N>) -> SVector<Self::Scalar, N>;

    /// f with ∂f/∂q and ∂f/∂v at (q, v).
    fn force_derivatives(
        &self,
        q: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
    ) -> CovectorDerivatives<Self::Scalar, N>;

    /// f and its derivative along `direction`: entry (i, j) differentiates fᵢ along eⱼ.
    #[inline]
    fn force_variation(
        &self,
        q: &SVector<Self::Scalar, N>,
        v: &SVector<Self::Scalar, N>,
        direction: Direction<Self::Scalar>,
    ) -> (SVector<Self::Scalar, N>, SMatrix<Self::Scalar, N, N>) {
        let f = self.force_derivatives(q, v);
        (f.value, f.along(direction))
    }
}
