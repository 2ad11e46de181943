//! Steps of several members at once: the members, and of steps solved for v̄ the equation as data of all of
//! them, and what a run's memory says of the next.

mod clocks;

pub(crate) mod newton;
mod runs;

use crate::numbers::{EntriesOfMembers, MemberVector, NewtonMatrix};
use crate::step::{ClosedForm, Discrete, Flow, Fused, Memory, State, VelocityHistory};
use crate::system::Gathered;
pub(crate) use runs::Ends;
pub use runs::{FlowInLanes, LaneRuns};

/// A discrete system whose step's equation is known of several members at once: what `lanes = midpoint`
/// generates.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not stepped in lanes by `{R}`",
    label = "the step's equation of `{Self}` is not written for several members at once",
    note = "add `lanes = midpoint` to the attribute: `#[rayleigh_system(rule = midpoint, lanes = midpoint)]`"
)]
pub trait DiscreteInLanes<R, const N: usize>:
    Sized + Gathered<N> + ClosedForm<R, N, Memory: MemoryInLanes<Self, R, N>> + Discrete<R, N>
{
    /// [`step_kernel`](crate::rules::Fused::step_kernel) of each member, p0 and the entries of the matrix, to
    /// the last bit.
    fn step_kernel_in_lanes<'s, const W: usize>(
        fields: &Self::Fields<'s, W>,
        q0: &MemberVector<Self::Scalar, N, W>,
        v: &MemberVector<Self::Scalar, N, W>,
        h: Self::Scalar,
    ) -> KernelOfMembers<Self::Matrix, Self::Scalar, N, W>
    where
        Self: 's;

    /// [`momenta`](crate::rules::Fused::momenta) of each member, p0 and p1, to the last bit.
    fn momenta_in_lanes<'s, const W: usize>(
        fields: &Self::Fields<'s, W>,
        q0: &MemberVector<Self::Scalar, N, W>,
        v: &MemberVector<Self::Scalar, N, W>,
        h: Self::Scalar,
    ) -> [MemberVector<Self::Scalar, N, W>; 2]
    where
        Self: 's;
}

/// p0 of each member, and the entries of its matrix.
type KernelOfMembers<M, S, const N: usize, const W: usize> =
    (MemberVector<S, N, W>, EntriesOfMembers<M, S, N, W>);

/// A matrix that is kept, and its factors.
pub(crate) type KeptOf<'m, L, R, const N: usize> = (
    &'m <L as Fused<R, N>>::Matrix,
    &'m <<L as Fused<R, N>>::Matrix as NewtonMatrix<<L as crate::system::Lagrangian<N>>::Scalar, N>>::Factored,
);

/// The memory of one of several members that step at once by a rule solved for v̄: its velocities are kept
/// with those of the others, all else here.
pub trait MemoryInLanes<L, R, const N: usize>: Memory<L, R, N> + Copy + core::fmt::Debug
where
    L: Fused<R, N> + Flow<R, N>,
{
    /// Whether a matrix may be kept.
    const KEEPS: bool;

    /// The velocities.
    fn history(&mut self) -> &mut VelocityHistory<L::Scalar, N>;

    /// Whether the next step is by Newton's method, and no matrix of it is kept.
    fn is_by_newton(&self) -> bool;

    /// The matrix that the next step of this size is solved with.
    fn kept(&self, h: L::Scalar) -> Option<KeptOf<'_, L, R, N>>;

    /// Takes in a step by Newton's method.
    fn has_paused(&mut self);

    /// Takes in the step from `state` with this mean velocity, made by the matrix kept in so many
    /// corrections; returns whether another matrix is kept from now on, or no matrix.
    fn has_served(
        &mut self,
        system: &L,
        state: &State<L::Scalar, N>,
        step: (nalgebra::SVector<L::Scalar, N>, L::Scalar),
        corrections: u32,
    ) -> bool;
}

impl<L, R, const N: usize> MemoryInLanes<L, R, N> for VelocityHistory<L::Scalar, N>
where
    L: Fused<R, N> + Flow<R, N>,
{
    const KEEPS: bool = false;

    fn history(&mut self) -> &mut VelocityHistory<L::Scalar, N> {
        self
    }

    fn is_by_newton(&self) -> bool {
        true
    }

    fn kept(&self, _h: L::Scalar) -> Option<KeptOf<'_, L, R, N>> {
        None
    }

    fn has_paused(&mut self) {}

    fn has_served(
        &mut self,
        _system: &L,
        _state: &State<L::Scalar, N>,
        _step: (nalgebra::SVector<L::Scalar, N>, L::Scalar),
        _corrections: u32,
    ) -> bool {
        false
    }
}
