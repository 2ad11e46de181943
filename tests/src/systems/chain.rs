//! A chain of masses: the number of degrees of freedom is a constant.

use dalembert::rayleigh_system;

use crate::by_hand::{ByHand, Number};

/// Masses in the chain.
pub const SITES: usize = 5;

/// Masses m, 2m, 3m, … between two walls, springs with a cubic term and dampers between neighbours.
///
/// With q₀ = q_{N+1} = 0 and dᵢ = q_{i+1} − qᵢ: V = Σ ½dᵢ² + ¼αdᵢ⁴ and R = Σ ½r ḋᵢ².
#[derive(Clone, Copy, Debug)]
pub struct Chain {
    /// Mass of the first site.
    pub m: f64,
    /// Strength of the cubic term of the springs.
    pub alpha: f64,
    /// Coefficient of the dampers.
    pub r: f64,
}

impl Chain {
    /// Parameters without accidental coincidences.
    pub const EXAMPLE: Self = Self { m: 0.6, alpha: 1.7, r: 0.2 };
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss], derivatives = num_dual)]
impl Chain {
    fn spring(&self, stretch: f64) -> f64 {
        0.5 * stretch.powi(2) + 0.25 * self.alpha * stretch.powi(4)
    }

    fn lagrangian(&self, q: [f64; SITES], v: [f64; SITES]) -> f64 {
        let mut lagrangian = -self.spring(q[0]) - self.spring(q[SITES - 1]);
        for i in 0..SITES {
            lagrangian += 0.5 * self.m * (1.0 + i as f64) * v[i] * v[i];
            if i > 0 {
                lagrangian -= self.spring(q[i] - q[i - 1]);
            }
        }
        lagrangian
    }

    fn rayleigh(&self, v: [f64; SITES]) -> f64 {
        let ends = v[0].powi(2) + v[SITES - 1].powi(2);
        let inner: f64 = v.windows(2).map(|pair| (pair[1] - pair[0]).powi(2)).sum();
        0.5 * self.r * (ends + inner)
    }
}

impl ByHand<SITES> for Chain {
    fn lagrangian_by_hand<D: Number>(&self, q: [D; SITES], v: [D; SITES]) -> D {
        let mut sum = D::zero();
        for i in 0..=SITES {
            let left = if i == 0 { D::zero() } else { q[i - 1] };
            let right = if i == SITES { D::zero() } else { q[i] };
            let square = (right - left) * (right - left);
            sum = sum - square / 2.0 - square * square * (self.alpha / 4.0);
            if i < SITES {
                sum += v[i] * v[i] * (self.m * (i as f64 + 1.0) / 2.0);
            }
        }
        sum
    }

    fn rayleigh_by_hand<D: Number>(&self, _: [D; SITES], v: [D; SITES]) -> D {
        let mut sum = D::zero();
        for i in 0..=SITES {
            let left = if i == 0 { D::zero() } else { v[i - 1] };
            let right = if i == SITES { D::zero() } else { v[i] };
            sum += (right - left) * (right - left) * (self.r / 2.0);
        }
        sum
    }

    fn acceleration(&self, q: [f64; SITES], v: [f64; SITES]) -> [f64; SITES] {
        let tension = |i: usize| {
            let at = |x: &[f64; SITES], j: usize| if j == 0 || j > SITES { 0.0 } else { x[j - 1] };
            let (stretch, rate) = (at(&q, i + 1) - at(&q, i), at(&v, i + 1) - at(&v, i));
            stretch + self.alpha * stretch.powi(3) + self.r * rate
        };
        std::array::from_fn(|i| (tension(i + 1) - tension(i)) / (self.m * (i as f64 + 1.0)))
    }
}
