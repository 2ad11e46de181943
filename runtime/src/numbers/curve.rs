//! Functions of one number, as data or code of the user's, with the derivatives that steps take.

use crate::numbers::{Lanes, Members, members::each_member};

/// A function of one number with its derivatives: a characteristic, such as thrust over time, drag over the
/// Mach number or the lift of a cam over its angle.
///
/// In L, R, f and constraints of a system `self.drag.at(x)` is the curve of the field `drag` at any
/// expression x, and so is `DRAG.at(x)` of a constant. Derivatives are written out: a curve is asked once for
/// its value and all derivatives at one x.
///
/// A [`Table`](crate::system::Table) is one. A function of one's own is another:
///
/// ```
/// use dalembert::nalgebra::vector;
/// use dalembert::system::Curve;
/// use dalembert::{Lagrangian, rayleigh_system};
///
/// /// a x⁴.
/// struct Quartic {
///     a: f64,
/// }
///
/// impl Curve<f64> for Quartic {
///     fn derivatives(&self, x: f64) -> [f64; 4] {
///         [x.powi(4), 4.0 * x.powi(3), 12.0 * x * x, 24.0 * x].map(|value| self.a * value)
///     }
/// }
///
/// struct Oscillator {
///     potential: Quartic,
/// }
///
/// #[rayleigh_system]
/// impl Oscillator {
///     fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
///         0.5 * v[0] * v[0] - self.potential.at(q[0])
///     }
/// }
///
/// let oscillator = Oscillator { potential: Quartic { a: 0.25 } };
/// assert_eq!(oscillator.lagrangian_gradient(&vector![2.0], &vector![0.0]).d1, vector![-8.0]);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is no curve over `{T}`",
    label = "neither a table of this precision nor a type that implements `Curve`",
    note = "`field.at(x)` in L, R, f or a constraint reads a `Table`, or a type with `impl Curve<{T}>`, which gives the derivatives",
    note = "another function of one's own stands in the annotated block, `fn height(x: f64) -> f64`, and is called by `Self::height(x)`"
)]
pub trait Curve<T> {
    /// f, f′, f″ and f‴ at x, in the units of f over powers of those of x.
    ///
    /// A step takes the first two derivatives, `step_derivatives = second` the third one.
    fn derivatives(&self, x: T) -> [T; 4];

    /// f(x).
    #[inline]
    #[must_use]
    fn at(&self, x: T) -> T {
        let [value, ..] = self.derivatives(x);
        value
    }
}

impl<T, C: Curve<T> + ?Sized> Curve<T> for &C {
    #[inline]
    fn derivatives(&self, x: T) -> [T; 4] {
        (**self).derivatives(x)
    }
}

impl<T: Copy, const S: usize> Lanes<T, S> {
    /// The derivatives of a curve, lane by lane.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn on(self, curve: &(impl Curve<T> + ?Sized)) -> [Self; 4] {
        let mut all = [self; 4];
        for (lane, &x) in self.0.iter().enumerate() {
            let [f, f1, f2, f3] = curve.derivatives(x);
            (all[0].0[lane], all[1].0[lane], all[2].0[lane], all[3].0[lane]) = (f, f1, f2, f3);
        }
        all
    }
}

impl<T: Copy, const W: usize> Members<T, W> {
    /// The derivatives of a curve, member by member.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn on(self, curve: &(impl Curve<T> + ?Sized)) -> [Self; 4] {
        self.of_member(|_, x| curve.derivatives(x))
    }

    /// The derivatives of a curve of each system's own, member by member.
    #[cfg_attr(not(debug_assertions), inline(always))]
    #[must_use]
    pub fn on_each<L>(self, systems: &[&L; W], derivatives: impl Fn(&L, T) -> [T; 4]) -> [Self; 4] {
        self.of_member(|i, x| derivatives(systems[i], x))
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn of_member(self, derivatives: impl Fn(usize, T) -> [T; 4]) -> [Self; 4] {
        let mut all = [self; 4];
        each_member!(i => {
            let [f, f1, f2, f3] = derivatives(i, self.0[i]);
            (all[0].0[i], all[1].0[i], all[2].0[i], all[3].0[i]) = (f, f1, f2, f3);
        });
        all
    }
}
