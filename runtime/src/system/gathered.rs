//! The fields of several members, as numbers side by side.

use crate::numbers::{Elementary, Members};
use crate::system::Lagrangian;

/// A system whose functions can be asked of several members at once: their fields are gathered before. The
/// option `lanes` of the attribute generates it, once for all kinds of lanes.
pub trait Gathered<const N: usize>: Lagrangian<N, Scalar: Elementary> {
    /// The fields of W systems that their functions in lanes read, and terms that depend on these alone.
    type Fields<const W: usize>: Copy + core::fmt::Debug;

    /// Gathers the [`Fields`](Self::Fields) of the systems.
    fn fields<const W: usize>(systems: [&Self; W]) -> Self::Fields<W>;

    /// The fields at the time `elapsed` after each system's own: [`later`](Lagrangian::later) of each.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn later_in_lanes<const W: usize>(
        fields: &Self::Fields<W>,
        elapsed: &Members<Self::Scalar, W>,
    ) -> Self::Fields<W> {
        let _ = elapsed;
        *fields
    }
}
