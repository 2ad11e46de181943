//! The mechanisms with their multipliers solved for, as peers integrate them: accelerations derived by hand.
//!
//! ```text
//! q̈ = M⁻¹(F − Gᵀλ),   G M⁻¹Gᵀ λ = G M⁻¹F + Ġv + 2α Gv + α² g
//! ```
//!
//! α = 0 reduces the index and no more; α > 0 is Baumgarte's stabilisation with critical damping.

use dalembert_scenes::four_bar;

use super::systems::{G, LENGTHS, MASSES};
use crate::scenes::Accelerated;

/// The spherical pendulum.
#[derive(Clone, Copy)]
pub struct OnSphere {
    pub drag: f64,
    pub alpha: f64,
}

impl Accelerated<3> for OnSphere {
    #[inline]
    fn acceleration(&self, q: &[f64; 3], v: &[f64; 3]) -> [f64; 3] {
        let force = [-self.drag * v[0], -self.drag * v[1], -self.drag * v[2] - G];
        let (square, rate) = (dot(q, q), dot(q, v));
        let off = 0.5 * (square - 1.0);
        let wanted = dot(v, v) + dot(q, &force) + self.alpha * (2.0 * rate + self.alpha * off);
        let lambda = wanted / square;
        std::array::from_fn(|i| force[i] - lambda * q[i])
    }
}

/// The two rods.
#[derive(Clone, Copy)]
pub struct OnRods {
    pub alpha: f64,
}

impl Accelerated<4> for OnRods {
    #[inline]
    fn acceleration(&self, q: &[f64; 4], v: &[f64; 4]) -> [f64; 4] {
        let [first, second] = [1.0 / MASSES[0], 1.0 / MASSES[1]];
        let [a, va] = [[q[0], q[1]], [v[0], v[1]]];
        let [b, vb] = [[q[2] - q[0], q[3] - q[1]], [v[2] - v[0], v[3] - v[1]]];
        let stabilised = |r: &[f64; 2], w: &[f64; 2], square: f64, length: f64| {
            self.alpha * (2.0 * dot(r, w) + self.alpha * 0.5 * (square - length * length))
        };
        let (aa, ab, bb) = (dot(&a, &a), dot(&a, &b), dot(&b, &b));
        let right = [
            dot(&va, &va) - G * a[1] + stabilised(&a, &va, aa, LENGTHS[0]),
            dot(&vb, &vb) + stabilised(&b, &vb, bb, LENGTHS[1]),
        ];
        let [s, t, u] = [aa * first, -ab * first, bb * (first + second)];
        let inverse = 1.0 / (s * u - t * t);
        let lambda = [(u * right[0] - t * right[1]) * inverse, (s * right[1] - t * right[0]) * inverse];
        [
            (lambda[1] * b[0] - lambda[0] * a[0]) * first,
            (lambda[1] * b[1] - lambda[0] * a[1]) * first - G,
            -lambda[1] * b[0] * second,
            -lambda[1] * b[1] * second - G,
        ]
    }
}

/// The four-bar linkage with 8 constraints, or with 9.
#[derive(Clone, Copy)]
pub struct OnBars<const M: usize> {
    pub friction: f64,
    pub alpha: f64,
}

/// The constraints of each bar's ends, the near one first: of x, before that of y; and with what sign.
const ENDS: [[(usize, f64); 2]; 3] = [[(0, 1.0), (2, 1.0)], [(2, -1.0), (4, 1.0)], [(6, 1.0), (4, -1.0)]];

impl<const M: usize> OnBars<M> {
    /// How many constraints hold a bar.
    const HELD: usize = if M > 8 { 5 } else { 4 };
}

impl<const M: usize> Accelerated<9> for OnBars<M> {
    #[inline]
    fn acceleration(&self, q: &[f64; 9], v: &[f64; 9]) -> [f64; 9] {
        let joints = [v[2], v[5] - v[2], v[8] - v[5], -v[8]];
        let (mut s, mut right) = ([[0.0; M]; M], [0.0; M]);
        right[6] = -self.alpha * self.alpha * four_bar::GROUND;
        if M > 8 {
            right[8] = right[6];
        }
        let mut arms = [[0.0; 5]; 3];
        let mut torques = [0.0; 3];
        for bar in 0..3 {
            let (mass, length) = (four_bar::MASSES[bar], four_bar::LENGTHS[bar]);
            let [lightness, ease] = [1.0 / mass, 12.0 / (mass * length * length)];
            let (sine, cosine) = q[3 * bar + 2].sin_cos();
            let (along, up, turn) = (0.5 * length * cosine, 0.5 * length * sine, v[3 * bar + 2]);
            let torque = self.friction * (joints[bar + 1] - joints[bar]);
            torques[bar] = torque * ease;
            // By the angle; the fifth is the loop along x.
            let round = if bar == 2 { -2.0 } else { 2.0 };
            arms[bar] = [up, -along, -up, along, -round * up];
            let places = [
                q[3 * bar] - along,
                q[3 * bar + 1] - up,
                q[3 * bar] + along,
                q[3 * bar + 1] + up,
                round * along,
            ];
            let bends = [along, up, -along, -up, -round * along];
            let held = rows(bar);
            let held = &held[..Self::HELD];
            for (k, &(row, sign)) in held.iter().enumerate() {
                let arm = arms[bar][k];
                // Of the centre's motion along x or y, which the loop does not hold.
                let (speed, pull) = match k {
                    4 => (0.0, 0.0),
                    _ => (v[3 * bar + k % 2], if k % 2 == 1 { -G } else { 0.0 }),
                };
                let rate = speed + arm * turn;
                let wanted = bends[k] * turn * turn + pull + arm * torques[bar];
                right[row] += sign * (wanted + self.alpha * (2.0 * rate + self.alpha * places[k]));
                for (l, &(column, other)) in held.iter().enumerate() {
                    let together = if k < 4 && l < 4 && k % 2 == l % 2 { lightness } else { 0.0 };
                    s[row][column] += sign * other * (together + arm * arms[bar][l] * ease);
                }
            }
        }
        let lambda = solve(&mut s, right);
        let mut acceleration = [0.0, -G, torques[0], 0.0, -G, torques[1], 0.0, -G, torques[2]];
        for bar in 0..3 {
            let (mass, length) = (four_bar::MASSES[bar], four_bar::LENGTHS[bar]);
            let [lightness, ease] = [1.0 / mass, 12.0 / (mass * length * length)];
            for (k, &(row, sign)) in rows(bar)[..Self::HELD].iter().enumerate() {
                let reaction = sign * lambda[row];
                if k < 4 {
                    acceleration[3 * bar + k % 2] -= reaction * lightness;
                }
                acceleration[3 * bar + 2] -= reaction * arms[bar][k] * ease;
            }
        }
        acceleration
    }
}

/// The constraints that hold a bar, with their signs: of the near end, of the far end, of the loop.
#[inline]
fn rows(bar: usize) -> [(usize, f64); 5] {
    let [(near, plus), (far, minus)] = ENDS[bar];
    [(near, plus), (near + 1, plus), (far, minus), (far + 1, minus), (8, 1.0)]
}

/// A pivot of less than this of its diagonal is rounding: its constraint follows from those before it.
const DEPENDENT: f64 = 1e-10;

/// s⁻¹ right by LDLᵀ within the band of the joints, in place; the multiplier of a dependent constraint is 0.
#[inline]
fn solve<const M: usize>(s: &mut [[f64; M]; M], mut right: [f64; M]) -> [f64; M] {
    // A joint shares bars with the next one and no other; the loop has all of them.
    let first = |row: usize| if row < 8 { row.saturating_sub(3) } else { 0 };
    let mut inverses = [0.0; M];
    for i in 0..M {
        let diagonal = s[i][i];
        let mut pivot = diagonal;
        for j in first(i)..i {
            let mut entry = s[i][j];
            let shared = first(i).max(first(j))..j;
            for (left, lower) in s[i][shared.clone()].iter().zip(&s[j][shared]) {
                entry -= left * lower;
            }
            // Until here L D, from here on L.
            s[i][j] = entry;
        }
        for j in first(i)..i {
            let entry = s[i][j];
            s[i][j] = entry * inverses[j];
            pivot -= entry * s[i][j];
        }
        inverses[i] = if pivot > DEPENDENT * diagonal { 1.0 / pivot } else { 0.0 };
        for j in first(i)..i {
            right[i] -= s[i][j] * right[j];
        }
    }
    for i in (0..M).rev() {
        right[i] *= inverses[i];
        for k in i + 1..M {
            if i >= first(k) {
                right[i] -= s[k][i] * right[k];
            }
        }
    }
    right
}

fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use anyhow::Result;

    use super::*;
    use crate::peers::methods;
    use crate::reference;

    /// The error of `ode_solvers` Dop853 after ten seconds.
    fn error<const N: usize, const M: usize>(motion: &str, reduced: impl Accelerated<N>) -> Result<f64> {
        let reference = reference::of(&format!("{motion}, T = 10"))?;
        let start: [f64; M] = [&reference.start_q[..], &reference.start_v].concat().as_slice().try_into()?;
        let (_, dop853) = methods::<_, N, M>()[0];
        let end = dop853(&reduced, &start, reference.time, 1e-13)?;
        Ok(end.iter().zip(&reference.end_q).map(|(found, end)| (found - end).abs()).fold(0.0, f64::max))
    }

    #[test]
    fn without_multipliers_the_motion_is_that_in_angles() -> Result<()> {
        for alpha in [0.0, 1.0] {
            assert!(error::<3, 6>("spherical pendulum, drag", OnSphere { drag: 1e-3, alpha })? < 1e-9);
            assert!(error::<4, 8>("two rods", OnRods { alpha })? < 1e-9);
            let bars = OnBars::<8> { friction: 5e-6, alpha };
            assert!(error::<9, 18>("four-bar, friction", bars)? < 1e-8);
            // The ninth constraint is dropped.
            assert!(error::<9, 18>("four-bar", OnBars::<9> { friction: 0.0, alpha })? < 1e-8);
        }
        // Positive control: other friction is seen.
        assert!(error::<3, 6>("spherical pendulum", OnSphere { drag: 1e-3, alpha: 0.0 })? > 1e-4);
        assert!(error::<9, 18>("four-bar", OnBars::<8> { friction: 5e-6, alpha: 0.0 })? > 1e-4);
        Ok(())
    }
}
