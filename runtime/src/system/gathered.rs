//! The fields of several members: numbers side by side, and the members themselves where curves of theirs
//! are read.

use crate::numbers::{Elementary, Members};
use crate::system::Lagrangian;

/// A system whose functions can be asked of several members at once: their fields are gathered before. The
/// option `lanes` of the attribute generates it, once for all kinds of lanes.
pub trait Gathered<const N: usize>: Lagrangian<N, Scalar: Elementary> {
    /// The fields of W systems that their functions in lanes read, and terms that depend on these alone;
    /// where they read curves that are fields, the systems, each of which has its own.
    type Fields<'s, const W: usize>: Copy
    where
        Self: 's;

    /// Gathers the [`Fields`](Self::Fields) of the systems.
    fn fields<const W: usize>(systems: [&Self; W]) -> Self::Fields<'_, W>;

    /// The fields at the time `elapsed` after each system's own: [`later`](Lagrangian::later) of each.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn later_in_lanes<'s, const W: usize>(
        fields: &Self::Fields<'s, W>,
        elapsed: &Members<Self::Scalar, W>,
    ) -> Self::Fields<'s, W>
    where
        Self: 's,
    {
        let _ = elapsed;
        *fields
    }
}
