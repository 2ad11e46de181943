//! Coordinates without mass, whose velocity L does not hold: friction determines it.
//!
//! ```text
//! ∂L/∂v = p                      of a coordinate with mass
//! ∂L/∂q + f_L = 0,  p = 0        of one without; its velocity stands in f_L alone, with −∂f_L/∂v regular
//! ```
//!
//! Steps do not ask for them: by rules that step such systems p0(v̄) holds the friction, and its Newton
//! matrix is regular as it is. What is here is asked where ∂²L/∂v² turns out to be singular.

#![expect(
    clippy::needless_range_loop,
    reason = "an iterator is some ten functions to compile, in every program"
)]

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
        let mut massless = Self([!L::IS_CONSTRAINED; N]);
        for (q, v) in at_rest_and_beside(q) {
            if massless.are_any() {
                let l = derivatives_apart(system, &q, &v);
                for i in 0..N {
                    massless.0[i] &= is_absent(&l, i);
                }
            }
        }
        massless
    }

    /// Coordinates of these whose velocity stands in no force that is smooth in it, neither theirs nor
    /// another: dry friction alone holds it, if anything does. `smooth` has all forces but those of kinks.
    #[cold]
    #[inline(never)]
    pub(crate) fn held_by_kinks<S: Scalar>(
        &self,
        q: &SVector<S, N>,
        smooth: impl Fn(&SVector<S, N>, &SVector<S, N>) -> CovectorDerivatives<S, N>,
    ) -> Self {
        let mut held = *self;
        for (q, v) in at_rest_and_beside(q) {
            let by_velocity = smooth(&q, &v).d2.data.0;
            for (j, column) in by_velocity.iter().enumerate() {
                let is_zero = column.iter().all(|entry| *entry == S::zero());
                for (i, (held, entry)) in held.0.iter_mut().zip(column).enumerate() {
                    *held &= *entry == S::zero() && (i != j || is_zero);
                }
            }
        }
        held
    }

    /// Whether there are any.
    pub(crate) fn are_any(&self) -> bool {
        self.first().is_some()
    }

    /// The first of them.
    pub(crate) fn first(&self) -> Option<usize> {
        let mut first = None;
        for i in 0..N {
            if self.0[i] && first.is_none() {
                first = Some(i);
            }
        }
        first
    }

    /// Momenta, or columns of their derivatives, with 0 in these coordinates: what rounding makes of them is
    /// left out.
    pub(crate) fn without<S: Scalar, const K: usize>(&self, p: &SMatrix<S, N, K>) -> SMatrix<S, N, K> {
        let mut held = *p;
        for column in &mut held.data.0 {
            for i in 0..N {
                if self.0[i] {
                    column[i] = S::zero();
                }
            }
        }
        held
    }

    /// These columns of a matrix, and 0 in the others.
    pub(crate) fn columns<S: Scalar, const R: usize>(&self, of: &SMatrix<S, R, N>) -> SMatrix<S, R, N> {
        let mut columns = *of;
        for (column, is_in) in columns.data.0.iter_mut().zip(self.0) {
            if !is_in {
                column.fill(S::zero());
            }
        }
        columns
    }

    /// These rows of a matrix or vector, and 0 in the others.
    pub(crate) fn rows<S: Scalar, const C: usize>(&self, of: &SMatrix<S, N, C>) -> SMatrix<S, N, C> {
        of - self.without(of)
    }

    /// These rows and columns of a matrix, and those of the unit matrix elsewhere.
    pub(crate) fn block<S: Scalar>(&self, of: &SMatrix<S, N, N>) -> SMatrix<S, N, N> {
        self.rows(&self.columns(of)) + self.without(&SMatrix::identity())
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
        let (l_by_v, l_by_q) = (&l.d12.data.0, &l.d11.data.0);
        let (force_by_v, force_by_q) = (&force.d2.data.0, &force.d1.data.0);
        for i in 0..N {
            if self.0[i] {
                balance.value.data.0[0][i] = -(l.d1.data.0[0][i] + force.value.data.0[0][i]) * scale;
                for j in 0..N {
                    balance.by_v.data.0[j][i] = -(l_by_v[j][i] + force_by_v[j][i]) * scale;
                    balance.by_q.data.0[j][i] = -(l_by_q[j][i] + force_by_q[j][i]) * scale;
                }
            }
        }
        balance
    }

    /// The derivatives of [`balance`](Self::balance) by parameters at fixed (q, v), from those of ∂L/∂v and
    /// of ∂L/∂q + f_L.
    pub(crate) fn balance_by<S: Scalar, const P: usize>(
        &self,
        momentum: &SMatrix<S, N, P>,
        forces: impl FnOnce() -> SMatrix<S, N, P>,
        scale: S,
    ) -> SMatrix<S, N, P> {
        let mut balance = *momentum;
        if self.are_any() {
            for (column, forces) in balance.data.0.iter_mut().zip(&forces().data.0) {
                for i in 0..N {
                    if self.0[i] {
                        column[i] = -forces[i] * scale;
                    }
                }
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

    /// The equations for the velocity of a system whose coordinates without mass are at rest.
    pub(crate) fn at_rest<L: Lagrangian<N> + ?Sized>(
        &self,
        system: &L,
        q: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
    ) -> Balance<L::Scalar, N> {
        let mut balance = Balance::of(&derivatives_apart(system, q, v));
        balance.value += self.rows(v);
        balance.by_v += self.rows(&SMatrix::identity());
        balance
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
        require_regular(&self.balance_at(system, q, v, L::Scalar::constant(1.0)).by_v).or_else(|error| {
            match L::STRUCTURE.kinks > 0 && self.are_any() && system.massless_velocity(q, v).is_some() {
                true => Ok(()),
                false => Err(error),
            }
        })
    }
}

/// Points (q, v) that tell whether a velocity stands in a function: at rest, beside it, and beside q.
fn at_rest_and_beside<S: Scalar, const N: usize>(q: &SVector<S, N>) -> [(SVector<S, N>, SVector<S, N>); 3] {
    let rest = nalgebra::zero();
    [(*q, rest), (*q, beside_velocity(&rest)), (beside(q), beside_velocity(&rest))]
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
    let (d22, d12) = (&l.d22.data.0, &l.d12.data.0);
    let mut is_absent = false;
    for j in 0..N {
        if j == of {
            is_absent = l.d2.data.0[0][j] == S::zero();
            for i in 0..N {
                is_absent &= d22[j][i] == S::zero() && d12[j][i] == S::zero();
            }
        }
    }
    is_absent
}
