//! Forces at states drawn around one, of all sizes: by them a model is told from one that was edited.

use nalgebra::SVector;

use crate::numbers::Scalar;
use crate::numbers::random::Random;
use crate::system::ActingForce;

/// Powers of two that states are away from the one given, and that times are.
const REACH: [i32; 2] = [-10, 10];
const TIMES: [i32; 2] = [-10, 20];

/// Numbers ∂L/∂q, ∂L/∂v and f_L of a system at `count` states and times, drawn by `seed` around (q, v): from
/// a thousandth to a thousand from them, and at times from a thousandth to a million.
///
/// Whoever goes on with a system from a file compares them with those that it began with: after an edit of a
/// body of L, R or f some differ, unless it acts in a small share of all these states alone. A NaN is the
/// same on every machine; a sine may be rounded otherwise on another.
///
/// ```
/// use dalembert::nalgebra::vector;
/// use dalembert::rayleigh_system;
/// use dalembert::system::sampled_forces;
///
/// #[rayleigh_system]
/// fn pendulum(q: [f64; 1], v: [f64; 1], stop: f64) -> f64 {
///     let beyond = (q[0] - stop).max(0.0);
///     0.5 * v[0] * v[0] + q[0].cos() - beyond * beyond
/// }
/// let forces = |stop: f64| {
///     sampled_forces(&Pendulum { stop }, (&vector![0.1], &vector![0.0]), 1, 100).collect::<Vec<_>>()
/// };
/// assert_eq!(forces(3.0), forces(3.0));
/// assert_ne!(forces(3.0), forces(3.5));
/// ```
pub fn sampled_forces<L: ActingForce<N>, const N: usize>(
    system: &L,
    (q, v): (&SVector<L::Scalar, N>, &SVector<L::Scalar, N>),
    seed: u64,
    count: usize,
) -> impl Iterator<Item = f64> {
    let (q, v) = (*q, *v);
    // Seeds that follow one another begin far apart; 0 would stay 0.
    let mut random = Random::new(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
    (0..count).flat_map(move |_| {
        let size = |random: &mut Random, [least, most]: [i32; 2]| {
            let power = least + (random.unit() * f64::from(most - least + 1)) as i32;
            f64::from_bits(((1023 + power) as u64) << 52)
        };
        let near = |center: &SVector<L::Scalar, N>, random: &mut Random| {
            let reach = size(random, REACH);
            center.map(|entry| entry + L::Scalar::constant(reach * random.sign()))
        };
        let (q, v) = (near(&q, &mut random), near(&v, &mut random));
        let time = L::Scalar::constant(size(&mut random, TIMES));
        let (of_l, force) =
            system.later(time, |system| (system.lagrangian_gradient(&q, &v), system.acting_force(&q, &v)));
        let vectors = [of_l.d1, of_l.d2, force];
        (0..3 * N).map(move |at| {
            let number = vectors[at / N][at % N].widen();
            // Its sign and digits are those of the machine.
            if number.is_nan() { f64::NAN } else { number }
        })
    })
}
