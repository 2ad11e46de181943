//! Digests of members as they start: by them a part is told from that of other starts or fields.

use std::ops::Range;

use dalembert::system::Scalar;
use dalembert::{Lagrangian, State, StepError};
use twox_hash::XxHash3_128;

use crate::member::caught;

/// Members of a part whose motion is looked at, at most: evenly spread.
const SAMPLED: u64 = 64;

/// States at which the forces of those members are asked, in all or a few more.
const STATES: u64 = 2048;

/// At how many states a member of `part` is asked for its forces, if its motion is looked at.
pub(super) fn sampled(part: &Range<u64>, number: u64) -> Option<usize> {
    let members = part.end - part.start;
    let stride = members.div_ceil(SAMPLED).max(1);
    let states = STATES.div_ceil(members.div_ceil(stride).max(1)) as usize;
    (number - part.start).is_multiple_of(stride).then_some(states)
}

/// The digest of a member: its start and the derivatives of L there, or why it has none, and other numbers
/// that tell it apart; or that it panics.
pub(super) fn of_member<L: Lagrangian<N>, const N: usize>(
    start: &Result<(L, State<L::Scalar, N>), StepError>,
    others: impl FnOnce(&L, &State<L::Scalar, N>) -> Vec<f64>,
    own: Option<u128>,
) -> u128 {
    let mut hash = XxHash3_128::new();
    match start {
        Ok((system, state)) => {
            let entries = state.q.iter().chain(&state.p).map(|entry| entry.widen());
            let of_system = caught(|| {
                let of_l = state.velocity(system).map(|v| system.lagrangian_gradient(&state.q, &v));
                let of_l = of_l.iter().flat_map(|of_l| of_l.d1.iter().chain(&of_l.d2));
                of_l.map(|entry| entry.widen()).chain(others(system, state)).collect::<Vec<_>>()
            });
            match of_system {
                Ok(of_system) => {
                    let numbers = entries.chain(of_system);
                    // The sign of a NaN is that of the machine.
                    let numbers = numbers.map(|number| if number.is_nan() { f64::NAN } else { number });
                    numbers.for_each(|number| hash.write(&number.to_le_bytes()));
                }
                Err(panicked) => {
                    entries.for_each(|number| hash.write(&number.to_le_bytes()));
                    hash.write(panicked.to_string().as_bytes());
                }
            }
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
