//! The problem that one step is, with several elements of friction, and its least over all ways to stick and
//! to slide.

use dalembert::{Discretise, Proximal, State, StepError, rayleigh_system};
use nalgebra::{DMatrix, DVector, Matrix4, SMatrix, SVector, Vector4};

use crate::draws::Draws;

type Rows = SMatrix<f64, 5, 4>;

/// L = ½vᵀMv and R = Σ Fₖ |Bₖ v|.
struct Many {
    m: [[f64; 4]; 4],
    b: [[f64; 4]; 5],
    f: [f64; 5],
    /// Whether the first two rows are one length.
    has_ball: bool,
}

#[rayleigh_system(rule = proximal)]
impl Many {
    fn lagrangian(&self, _q: [f64; 4], v: [f64; 4]) -> f64 {
        let mut sum = 0.0;
        for i in 0..4 {
            for j in 0..4 {
                sum += 0.5 * self.m[i][j] * v[i] * v[j];
            }
        }
        sum
    }

    #[allow(clippy::needless_range_loop, reason = "indices as in the formula")]
    fn rayleigh(&self, v: [f64; 4]) -> f64 {
        let mut u = [0.0; 5];
        for k in 0..5 {
            for i in 0..4 {
                u[k] += self.b[k][i] * v[i];
            }
        }
        let pair = if self.has_ball { 0.0 } else { 1.0 };
        let ball = (1.0 - pair) * self.f[0] * u[0].hypot(u[1]);
        let two = pair * (self.f[0] * u[0].abs() + self.f[1] * u[1].abs());
        ball + two + self.f[2] * u[2].abs() + self.f[3] * u[3].abs() + self.f[4] * u[4].abs()
    }
}

/// The problem that a step is: v̄ is its least.
pub struct Problem {
    /// M.
    pub m: Matrix4<f64>,
    /// Rows Bₖ.
    pub b: Rows,
    /// Fₖ.
    pub f: SVector<f64, 5>,
    /// The momentum.
    pub p: Vector4<f64>,
    /// h/2.
    pub half: f64,
}

impl Problem {
    /// One at random.
    #[must_use]
    pub fn drawn(draws: &mut Draws) -> Self {
        let mut entry = || draws.between(-1.5, 1.5);
        let a = Matrix4::from_fn(|_, _| entry());
        let (b, p) = (Rows::from_fn(|_, _| entry()), Vector4::from_fn(|_, _| 2.0 * entry()));
        let f = SVector::from_fn(|_, _| draws.between(0.1, 2.0));
        let half = [0.01, 0.1, 1.0][draws.below(3)];
        Self { m: a * a.transpose() + Matrix4::identity() * 0.3, b, f, p, half }
    }

    /// ½vᵀMv − p·v + (h/2) Σ Fₖ |Bₖ v|.
    #[must_use]
    pub fn objective(&self, v: &Vector4<f64>) -> f64 {
        let friction: f64 = (0..5).map(|k| self.f[k] * (self.b.row(k) * v)[0].abs()).sum();
        0.5 * v.dot(&(self.m * v)) - self.p.dot(v) + self.half * friction
    }

    /// The least objective over all sets: each element slides forwards, backwards or sticks.
    #[must_use]
    pub fn least(&self) -> f64 {
        let mut least = self.objective(&Vector4::zeros());
        for code in 0..3_i32.pow(5) {
            let states: [i32; 5] = std::array::from_fn(|k| code / 3_i32.pow(k as u32) % 3 - 1);
            let mut matrix = SMatrix::<f64, 9, 9>::identity();
            let mut right = SVector::<f64, 9>::zeros();
            matrix.fixed_view_mut::<4, 4>(0, 0).copy_from(&self.m);
            right.fixed_rows_mut::<4>(0).copy_from(&self.p);
            for (k, &state) in states.iter().enumerate() {
                let row = self.b.row(k).transpose();
                if state == 0 {
                    matrix[(4 + k, 4 + k)] = 0.0;
                    matrix.fixed_view_mut::<1, 4>(4 + k, 0).copy_from(&row.transpose());
                    matrix.fixed_view_mut::<4, 1>(0, 4 + k).copy_from(&row);
                } else {
                    let mut top = right.fixed_rows_mut::<4>(0);
                    top -= row * (self.half * self.f[k] * f64::from(state));
                }
            }
            if let Some(solution) = matrix.lu().solve(&right) {
                let value = self.objective(&solution.fixed_rows::<4>(0).into_owned());
                least = if value < least { value } else { least };
            }
        }
        least
    }

    fn system(&self, has_ball: bool) -> Many {
        Many {
            m: std::array::from_fn(|i| std::array::from_fn(|j| self.m[(i, j)])),
            b: std::array::from_fn(|k| std::array::from_fn(|i| self.b[(k, i)])),
            f: self.f.into(),
            has_ball,
        }
    }

    /// v̄ of the step; of the first two rows together the length, or each by itself.
    ///
    /// # Errors
    /// Those of the step.
    pub fn velocity(&self, has_ball: bool) -> Result<Vector4<f64>, StepError> {
        let start = State { q: Vector4::zeros(), p: self.p };
        Ok(self.system(has_ball).by(Proximal, 2.0 * self.half).step(&start)?.velocity)
    }

    /// By how much the objective of v, with the length of the first two rows, exceeds the largest of the dual
    /// problem that the forces at v show, in units of 1 + |objective|: −½ (p − Bᵀσ)ᵀM⁻¹(p − Bᵀσ) with σ
    /// within its limits.
    #[must_use]
    pub fn gap(&self, v: &Vector4<f64>) -> f64 {
        let slips = self.b * v;
        let friction =
            self.f[0] * slips[0].hypot(slips[1]) + self.f[2] * slips[2].abs() + self.f[3] * slips[3].abs();
        let primal = 0.5 * v.dot(&(self.m * v)) - self.p.dot(v) + self.half * friction;
        let rows = self.b.fixed_rows::<4>(0);
        // What slides is at its limit; what sticks bears what is left, as far as it can.
        let length = slips[0].hypot(slips[1]);
        let most = [self.f[0], self.f[0], self.f[2], self.f[3]].map(|f| self.half * f);
        let ways = [slips[0] / length, slips[1] / length, slips[2].signum(), slips[3].signum()];
        let slides = [length, length, slips[2].abs(), slips[3].abs()].map(|size| size > 1e-12);
        let mut forces = Vector4::from_fn(|k, _| if slides[k] { most[k] * ways[k] } else { 0.0 });
        let left = self.p - self.m * v - rows.transpose() * forces;
        let stuck: Vec<usize> = (0..4).filter(|&k| !slides[k]).collect();
        if !stuck.is_empty() {
            let columns = DMatrix::from_fn(4, stuck.len(), |i, k| rows[(stuck[k], i)]);
            let inverse = columns.pseudo_inverse(1e-13).expect("a tolerance that is positive");
            let bears = inverse * DVector::from_column_slice(left.as_slice());
            stuck.iter().zip(bears.iter()).for_each(|(&k, &force)| forces[k] = force);
        }
        let length = forces[0].hypot(forces[1]);
        let within = if length > most[0] { most[0] / length } else { 1.0 };
        (forces[0], forces[1]) = (forces[0] * within, forces[1] * within);
        (forces[2], forces[3]) = (forces[2].clamp(-most[2], most[2]), forces[3].clamp(-most[3], most[3]));
        let left = self.p - rows.transpose() * forces;
        let dual = -0.5 * left.dot(&self.m.lu().solve(&left).expect("masses"));
        (primal - dual) / (1.0 + primal.abs())
    }
}
