//! Coordinates without mass, whose velocity L does not hold: friction determines it.
//!
//! ```text
//! ∂L/∂v = p                      of a coordinate with mass
//! ∂L/∂q + f_L = 0,  p = 0        of one without; its velocity stands in f_L alone, with −∂f_L/∂v regular
//! ```
//!
//! Steps do not ask for them: by rules that step such systems p0(v̄) holds the friction, and its Newton
//! matrix is regular as it is. What is here is asked where ∂²L/∂v² turns out to be singular.

use nalgebra::{SMatrix, SVector};

use crate::numbers::{CovectorDerivatives, Derivatives, Scalar};
use crate::step::StepError;
use crate::step::regular::{beside, beside_velocity, require_regular};
use crate::system::{Lagrangian, derivatives_apart};

/// Coordinates without mass: their velocities stand in L nowhere.
#[derive(Clone, Copy)]
pub(crate) struct Massless<const N: usize>([bool; N]);

/// The equations for the velocity at (q, v): their left side without p, and its derivatives.
pub(crate) struct Balance<S, const N: usize> {
    /// ∂L/∂v; −(∂L/∂q + f_L) of a coordinate without mass.
    pub(crate) value: SVector<S, N>,
    pub(crate) by_v: SMatrix<S, N, N>,
    pub(crate) by_q: SMatrix<S, N, N>,
}

impl<S: Scalar, const N: usize> Balance<S, N> {
    /// The equations of a system all of whose coordinates have mass.
    #[inline]
    pub(crate) fn of(l: &Derivatives<S, N>) -> Self {
        Self { value: l.d2, by_v: l.d22, by_q: l.d12.transpose() }
    }
}

impl<const N: usize> Massless<N> {
    /// No coordinate.
    #[inline]
    pub(crate) fn none() -> Self {
        Self([false; N])
    }

    /// The coordinates of the system as its fields are. A coordinate without mass at q alone, as the azimuth
    /// at a pole is, or at rest alone, as by |v|⁴, is none of them. On constraints there are none.
    #[cold]
    #[inline(never)]
    pub(crate) fn of<L: Lagrangian<N> + ?Sized>(system: &L, q: &SVector<L::Scalar, N>) -> Self {
        let mut massless = [!L::IS_CONSTRAINED; N];
        let rest = nalgebra::zero();
        for (q, v) in [(*q, rest), (*q, beside_velocity(&rest)), (beside(q), beside_velocity(&rest))] {
            if massless.contains(&true) {
                let l = derivatives_apart(system, &q, &v);
                massless.iter_mut().enumerate().for_each(|(i, is_massless)| *is_massless &= is_absent(&l, i));
            }
        }
        Self(massless)
    }

    /// Whether there are any.
    pub(crate) fn are_any(&self) -> bool {
        self.0.contains(&true)
    }

    /// The first of them.
    pub(crate) fn first(&self) -> Option<usize> {
        self.0.iter().position(|is_massless| *is_massless)
    }

    /// Momenta, or columns of their derivatives, with 0 in these coordinates: what rounding makes of them is
    /// left out.
    pub(crate) fn without<S: Scalar, const K: usize>(&self, p: &SMatrix<S, N, K>) -> SMatrix<S, N, K> {
        SMatrix::from_fn(|i, j| if self.0[i] { S::zero() } else { p[(i, j)] })
    }

    /// The equations for the velocity, where L and the force have these derivatives; those of coordinates
    /// without mass times `scale`.
    pub(crate) fn balance<S: Scalar>(
        &self,
        l: &Derivatives<S, N>,
        force: impl FnOnce() -> CovectorDerivatives<S, N>,
        scale: S,
    ) -> Balance<S, N> {
        let mut balance = Balance::of(l);
        if !self.are_any() {
            return balance;
        }
        let force = force();
        for i in (0..N).filter(|&i| self.0[i]) {
            balance.value[i] = -(l.d1[i] + force.value[i]) * scale;
            for j in 0..N {
                balance.by_v[(i, j)] = -(l.d12[(i, j)] + force.d2[(i, j)]) * scale;
                balance.by_q[(i, j)] = -(l.d11[(i, j)] + force.d1[(i, j)]) * scale;
            }
        }
        balance
    }

    /// [`balance`](Self::balance) at (q, v), where the system is told which force acts.
    #[cold]
    #[inline(never)]
    pub(crate) fn balance_at<L: Lagrangian<N> + ?Sized>(
        &self,
        system: &L,
        q: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
        scale: L::Scalar,
    ) -> Balance<L::Scalar, N> {
        let force = || system.massless_force(q, v).unwrap_or_else(CovectorDerivatives::zero);
        self.balance(&derivatives_apart(system, q, v), force, scale)
    }

    /// Fails where momenta and friction do not determine the velocity at (q, v). Where the system is not told
    /// which force acts, its view will say.
    #[cold]
    #[inline(never)]
    pub(crate) fn require_determined<L: Lagrangian<N> + ?Sized>(
        &self,
        system: &L,
        q: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
    ) -> Result<(), StepError> {
        if self.are_any() && system.massless_force(q, v).is_none() {
            return Ok(());
        }
        require_regular(&self.balance_at(system, q, v, L::Scalar::constant(1.0)).by_v)
    }
}

/// ∂²L/∂v² at (q, v), with ½h times the friction in its place in coordinates without mass: what the Newton
/// matrix ∂p0/∂v̄ is for small h.
#[cold]
#[inline(never)]
pub(crate) fn inertia<L: Lagrangian<N> + ?Sized, const N: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
    h: L::Scalar,
) -> SMatrix<L::Scalar, N, N> {
    let mass = derivatives_apart(system, q, v).d22;
    if require_regular(&mass).is_ok() {
        return mass;
    }
    Massless::of(system, q).balance_at(system, q, v, h * L::Scalar::constant(0.5)).by_v
}

/// Whether L does not hold the velocity of this coordinate, as far as these derivatives tell.
fn is_absent<S: Scalar, const N: usize>(l: &Derivatives<S, N>, of: usize) -> bool {
    let is_zero = |column: &[S; N]| column.iter().all(|entry| *entry == S::zero());
    l.d2.iter().skip(of).take(1).all(|entry| *entry == S::zero())
        && l.d22.data.0.get(of).is_some_and(is_zero)
        && l.d12.data.0.get(of).is_some_and(is_zero)
}
