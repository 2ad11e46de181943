use dalembert::rayleigh_system;
use nalgebra::{SMatrix, SVector};

/// Coordinates.
pub const MASSES: usize = 4;
/// Elements of friction.
pub const ELEMENTS: usize = 5;

/// L = ½vᵀMv − ½qᵀKq + load·q and R = ½vᵀCv + Σ fₖ |bₖ·v − beltₖ|.
#[derive(Clone, Copy, Debug)]
pub struct Sliders {
    /// M.
    pub m: [[f64; MASSES]; MASSES],
    /// K.
    pub k: [[f64; MASSES]; MASSES],
    /// C.
    pub c: [[f64; MASSES]; MASSES],
    /// Constant forces.
    pub load: [f64; MASSES],
    /// Rows bₖ.
    pub b: [[f64; MASSES]; ELEMENTS],
    /// Velocities of belts.
    pub belt: [f64; ELEMENTS],
    /// Friction of each element.
    pub f: [f64; ELEMENTS],
}

#[rayleigh_system(rule = proximal)]
#[allow(clippy::needless_range_loop, reason = "indices as in the formula")]
impl Sliders {
    fn lagrangian(&self, q: [f64; 4], v: [f64; 4]) -> f64 {
        let mut sum = 0.0;
        for i in 0..4 {
            sum += self.load[i] * q[i];
            for j in 0..4 {
                sum += 0.5 * (self.m[i][j] * v[i] * v[j] - self.k[i][j] * q[i] * q[j]);
            }
        }
        sum
    }

    fn rayleigh(&self, v: [f64; 4]) -> f64 {
        let mut sum = 0.0;
        for i in 0..4 {
            for j in 0..4 {
                sum += 0.5 * self.c[i][j] * v[i] * v[j];
            }
        }
        for k in 0..5 {
            let mut slip = -self.belt[k];
            for i in 0..4 {
                slip += self.b[k][i] * v[i];
            }
            sum += self.f[k] * slip.abs();
        }
        sum
    }
}

/// A matrix of rows.
pub(super) fn matrix<const R: usize, const C: usize>(rows: &[[f64; C]; R]) -> SMatrix<f64, R, C> {
    SMatrix::from_fn(|i, j| rows[i][j])
}

impl Sliders {
    /// bₖ·v − beltₖ.
    #[must_use]
    pub fn slips(&self, v: &SVector<f64, MASSES>) -> SVector<f64, ELEMENTS> {
        matrix(&self.b) * v - SVector::from(self.belt)
    }
}
