//! One equation computed in two ways, which differ by rounding.

use super::equations::Equations;
use super::noise::shift;
use super::vectors::{Room, subtract};
use crate::numbers::Precision;

/// Moves in corrections: over these, what rounds differs as much as over none, and what is another function
/// as much as they are long.
static LENGTHS: [f64; 6] = [64.0, 4096.0, 262_144.0, 16_777_216.0, 1e9, 6.4e10];

/// By how much rounding may be larger at other places than at the point and over the shortest moves, of which
/// any one may round little by chance.
const ALIKE: f64 = 64.0;

/// How many of the moves are short: another function shows over the longer ones.
const SHORT: usize = 2;

/// The residual by the momenta of a step, and by the kernel with the matrix.
pub(super) struct Twice<'a, S> {
    pub(super) momenta: &'a [S],
    pub(super) kernel: &'a [S],
}

/// Whether both ways are one function but for rounding, although they differ by more than the `floor` at
/// `at`: over moves of the correction the difference changes, and does not grow.
#[cold]
#[inline(never)]
pub(super) fn is_rounded_twice<S: Precision>(
    of: &mut Equations<'_, S>,
    (at, correction): (&[S], &[S]),
    found: &Twice<'_, S>,
    floor: &[S],
    mut room: Room<'_, S>,
) -> bool {
    let [v, q, kernel, momenta] = room.vectors();
    let [changes, most] = [room.zeros(), room.zeros()];
    for (direction, length) in LENGTHS.iter().enumerate() {
        for (i, ((v, at), correction)) in v.iter_mut().zip(at).zip(correction).enumerate() {
            *v = *at + *correction * S::nearest(*length * shift(direction, i));
        }
        move_alike(q, of.q, of.h, v, at);
        of.evaluate.kernel(q, v, of.h, of.held, kernel);
        of.p0(q, v, momenta, room.inner());
        subtract(momenta, kernel);
        let written = momenta.iter().zip(changes.iter_mut().zip(most.iter_mut()));
        for (((own, kernel), floor), (now, (changes, most))) in
            found.momenta.iter().zip(found.kernel).zip(floor).zip(written)
        {
            let before = (*own - *kernel).abs();
            if before <= *floor {
                *changes = S::one();
                continue;
            }
            if direction < SHORT {
                *most = most.max(now.abs()).max(before);
            }
            // What is no number fails the comparison.
            let is_alike = now.abs() <= *most * S::nearest(ALIKE);
            if !is_alike {
                return false;
            }
            let is_other = (*now - (*own - *kernel)).abs() * S::nearest(2.0) >= before;
            if is_other {
                *changes = S::one();
            }
        }
    }
    changes.iter().all(|changes| *changes != S::zero())
}

/// Moves configurations as the velocities `v` are moved from `at`, over the time h, but for shares: what does
/// not depend on v rounds as well.
pub(super) fn move_alike<S: Precision>(moved: &mut [S], q: &[S], h: S, v: &[S], at: &[S]) {
    for (i, ((moved, q), (v, at))) in moved.iter_mut().zip(q).zip(v.iter().zip(at)).enumerate() {
        *moved = *q + (*v - *at) * h * S::nearest(shift(0, i + 1));
    }
}

#[cfg(test)]
mod tests {
    use super::super::equations::{Evaluate, Values};
    use super::*;

    /// Whether two ways are the same but for rounding, at the root of the kernel by v, from q: a momentum of
    /// mass 1, and a kernel of slope 1 in v that computes it in a way of its own.
    fn is_rounded(kernel: impl Fn(f64, f64) -> f64, a: f64, q: f64) -> bool {
        let v = -kernel(q, 0.0);
        let mut two = Values {
            momentum: |q: &[f64], v: &[f64], p0: &mut [f64]| p0[0] = v[0] + 0.3 * ((q[0] - a) + (q[0] + a)),
            kernel: |q: &[f64], v: &[f64], p0: &mut [f64]| p0[0] = kernel(q[0], v[0]),
        };
        let (mut momenta, mut own) = ([0.0], [0.0]);
        two.momenta(&[q], &[v], 0.1, &mut momenta, &mut [0.0]);
        two.kernel(&[q], &[v], 0.1, &[], &mut own);
        let found = Twice { momenta: &momenta, kernel: &own };
        let mut of = Equations { evaluate: &mut two, q: &[q], p: &[0.0], h: 0.1, held: &[] };
        let floor = [f64::EPSILON * 4.0 * v.abs() + f64::MIN_POSITIVE];
        is_rounded_twice(&mut of, (&[v], &momenta), &found, &floor, Room::new(&mut [0.0; 8], 1))
    }

    #[test]
    fn two_ways_of_rounding_are_one_function() {
        for a in [1e-6, 1.0, 3e5] {
            let states = (1..400).map(|k| a * f64::EPSILON * 0.37 * f64::from(k));
            let that_differ: Vec<f64> = states.filter(|q| (q - a) + (q + a) != 2.0 * q).collect();
            let missed = that_differ.iter().filter(|&&q| !is_rounded(|q, v| v + 0.6 * q, a, q)).count();
            // Of the few whose moves are all rounded alike the scatter tells.
            assert!(that_differ.len() > 100 && missed < that_differ.len() / 20, "{a}: {missed}");
        }
    }

    /// The control: a kernel that is another function, by its slope, a constant or a factor.
    #[test]
    fn two_functions_are_not() {
        for q in [1.0, -3e-5, 1e-12] {
            for wrong in [1e-1, 1e-3, -1e-6] {
                assert!(!is_rounded(|q, v| v + 0.6 * q * (1.0 + wrong), 1e-30, q), "{q} {wrong}");
                assert!(!is_rounded(|q, v| v + 0.6 * q + wrong, 1e-30, q), "{q} {wrong}");
                assert!(!is_rounded(|q, v| v * (1.0 + wrong) + 0.6 * q, 1e-30, q), "{q} {wrong}");
                // Of 1e-12 the square is below the floor.
                let q = q.max(1e-6);
                assert!(!is_rounded(|q, v| v + 0.6 * q + wrong * v * v, 1e-30, q), "{q} {wrong}");
            }
        }
    }
}
