//! The equations of motion at several stages at once.
//!
//! ```text
//! d/dt ∂L/∂v = g,   g = ∂L/∂q + f_L
//! ```

use nalgebra::SVector;

use crate::numbers::{
    Blank, LaneVector, Lanes, MemberVector, NewtonMatrix, Scalar,
    lanes::{lane, splat, write_lane},
};
use crate::system::{ActingForce, Gathered};

/// The equations of motion at S stages at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stages<T, const N: usize, const S: usize> {
    /// g = ∂L/∂q + f_L.
    pub rate: LaneVector<T, N, S>,
    /// p − ∂L/∂v, with the momenta p that were asked for.
    pub residual: LaneVector<T, N, S>,
    /// (∂²L/∂v²)⁻¹ (p − ∂L/∂v), a Newton step of v towards these momenta; not finite where the matrix is
    /// singular.
    pub correction: LaneVector<T, N, S>,
}

/// A Lagrangian L with the force f_L that acts, at all stages of a Gauss rule at once.
///
/// `#[rayleigh_system(rule = gauss)]` writes it; by hand the `impl` alone serves.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no step as it stands here",
    label = "no step",
    note = "if its force takes an input, write `system.driven(u)` where `system` stands; if L, R or f take the time, `system.at_time(t)`, with an input `system.driven(u, t)`",
    note = "otherwise list the rule in the attribute: `#[rayleigh_system(rule = [midpoint, gauss])]`"
)]
pub trait ForcedLagrangian<const N: usize>: ActingForce<N> {
    /// Values that the equations at all stages keep from one sweep to the next, blank before the first:
    /// sines, cosines and reciprocals to start from, or `()`.
    type Anchors<const S: usize>: Blank;

    /// The equations of motion at all stages, now. `momenta` gives the stages' momenta from their rates g.
    fn stages<const S: usize>(
        &self,
        _anchors: &mut Self::Anchors<S>,
        q: &LaneVector<Self::Scalar, N, S>,
        v: &LaneVector<Self::Scalar, N, S>,
        momenta: impl FnOnce(&LaneVector<Self::Scalar, N, S>) -> LaneVector<Self::Scalar, N, S>,
    ) -> Stages<Self::Scalar, N, S>
    where
        Self: Sized,
    {
        one_by_one(self, &Lanes::splat(nalgebra::zero()), q, v, momenta)
    }

    /// Evaluates the stages with each at its own time, `elapsed` from now.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn stages_in_time<const S: usize>(
        &self,
        anchors: &mut Self::Anchors<S>,
        elapsed: &Lanes<Self::Scalar, S>,
        q: &LaneVector<Self::Scalar, N, S>,
        v: &LaneVector<Self::Scalar, N, S>,
        momenta: impl FnOnce(&LaneVector<Self::Scalar, N, S>) -> LaneVector<Self::Scalar, N, S>,
    ) -> Stages<Self::Scalar, N, S>
    where
        Self: Sized,
    {
        if Self::IS_TIMED {
            one_by_one(self, elapsed, q, v, momenta)
        } else {
            self.stages(anchors, q, v, momenta)
        }
    }
}

/// A system whose equations of motion are known of several members at once: what `lanes = gauss` generates.
///
/// One stage at a time, in two functions, between which the momenta of all stages follow from the rates.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not stepped in lanes by Gauss rules",
    label = "the equations of `{Self}` are not written for several members at once",
    note = "add `lanes = gauss` to the attribute: `#[rayleigh_system(rule = gauss, lanes = gauss)]`"
)]
pub trait ForcedLagrangianInLanes<const N: usize>: Gathered<N> + ForcedLagrangian<N> {
    /// Values of [`rates_in_lanes`](Self::rates_in_lanes) that corrections need.
    type Kept<const W: usize>: Blank;

    /// [`Anchors`](ForcedLagrangian::Anchors) of each member at one stage.
    type AnchorsInLanes<const W: usize>: Blank;

    /// g = ∂L/∂q + f_L of each member at one stage, whose time `fields` has, and what its correction needs:
    /// as in [`stages_in_time`](ForcedLagrangian::stages_in_time), to the last bit.
    fn rates_in_lanes<'s, const W: usize>(
        fields: &Self::Fields<'s, W>,
        anchors: &mut Self::AnchorsInLanes<W>,
        q: &MemberVector<Self::Scalar, N, W>,
        v: &MemberVector<Self::Scalar, N, W>,
    ) -> (MemberVector<Self::Scalar, N, W>, Self::Kept<W>)
    where
        Self: 's;

    /// p − ∂L/∂v and (∂²L/∂v²)⁻¹ (p − ∂L/∂v) of each member at the stage that `kept` is of, to the last bit.
    fn corrections_in_lanes<'s, const W: usize>(
        fields: &Self::Fields<'s, W>,
        kept: &Self::Kept<W>,
        v: &MemberVector<Self::Scalar, N, W>,
        p: &MemberVector<Self::Scalar, N, W>,
    ) -> [MemberVector<Self::Scalar, N, W>; 2]
    where
        Self: 's;
}

/// The stages one after the other.
fn one_by_one<L: ForcedLagrangian<N>, const N: usize, const S: usize>(
    system: &L,
    elapsed: &Lanes<L::Scalar, S>,
    q: &LaneVector<L::Scalar, N, S>,
    v: &LaneVector<L::Scalar, N, S>,
    momenta: impl FnOnce(&LaneVector<L::Scalar, N, S>) -> LaneVector<L::Scalar, N, S>,
) -> Stages<L::Scalar, N, S> {
    let zero = splat(&SVector::zeros());
    let mut stages = Stages { rate: zero, residual: zero, correction: zero };
    let mut masses = [nalgebra::zero(); S];
    let mut own = zero;
    for (i, mass) in masses.iter_mut().enumerate() {
        let (q, v) = (lane(q, i), lane(v, i));
        let (l, force) = system.later(elapsed.0[i], |system| {
            let force = if L::IS_FORCED { system.acting_force(&q, &v) } else { nalgebra::zero() };
            (system.lagrangian_derivatives(&q, &v), force)
        });
        write_lane(&mut stages.rate, i, &(l.d1 + force));
        write_lane(&mut own, i, &l.d2);
        *mass = l.d22;
    }
    let momenta = momenta(&stages.rate);
    for a in 0..N {
        stages.residual[a] = momenta[a] - own[a];
    }
    for (i, mass) in masses.iter().enumerate() {
        let not_a_number = SVector::repeat(L::Scalar::constant(f64::NAN));
        let correction = mass.solve(&lane(&stages.residual, i)).unwrap_or(not_a_number);
        write_lane(&mut stages.correction, i, &correction);
    }
    stages
}
