//! Digests of members as they start: by them a part is told from that of other starts or fields.

use std::ops::Range;

use dalembert::system::Scalar;
use dalembert::{Lagrangian, State, StepError};
use twox_hash::XxHash3_128;

/// Members of a part whose motion is looked at, at most: evenly spread.
const SAMPLED: u64 = 64;

/// Whether the motion of a member of `part` is looked at.
pub(super) fn is_sampled(part: &Range<u64>, number: u64) -> bool {
    let stride = (part.end - part.start).div_ceil(SAMPLED).max(1);
    (number - part.start).is_multiple_of(stride)
}

/// The digest of a member: its start and the derivatives of L there, or why it has none, and other numbers
/// that tell it apart.
pub(super) fn of_member<L: Lagrangian<N>, const N: usize>(
    start: &Result<(L, State<L::Scalar, N>), StepError>,
    others: impl FnOnce(&L, &State<L::Scalar, N>) -> Vec<f64>,
    own: Option<u128>,
) -> u128 {
    let mut hash = XxHash3_128::new();
    match start {
        Ok((system, state)) => {
            let of_l = state.velocity(system).map(|v| system.lagrangian_gradient(&state.q, &v));
            let of_l = of_l.iter().flat_map(|of_l| of_l.d1.iter().chain(&of_l.d2));
            let entries = state.q.iter().chain(&state.p).chain(of_l).map(|entry| entry.widen());
            let numbers = entries.chain(others(system, state));
            // The sign of a NaN is that of the machine.
            let numbers = numbers.map(|number| if number.is_nan() { f64::NAN } else { number });
            numbers.for_each(|number| hash.write(&number.to_le_bytes()));
        }
        Err(error) => hash.write(error.to_string().as_bytes()),
    }
    if let Some(own) = own {
        hash.write(&own.to_le_bytes());
    }
    hash.finish_128()
}

/// The digest of members one after the other.
pub(super) fn of_all(members: &[u128]) -> u128 {
    let mut hash = XxHash3_128::new();
    members.iter().for_each(|member| hash.write(&member.to_le_bytes()));
    hash.finish_128()
}
