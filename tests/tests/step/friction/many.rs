//! Several elements of friction, drawn at random: v̄ against the least of the objective over all ways to
//! stick and to slide.
//!
//! ```text
//! v̄ = argmin ½vᵀMv − p·v + (h/2) Σ Fₖ |Bₖ v|
//! ```

use dalembert::nalgebra::{Matrix4, SMatrix, SVector, Vector4};
use dalembert::{Discretise, Proximal, State, rayleigh_system};
use dalembert_tests::draws::Draws;

type Rows = SMatrix<f64, 5, 4>;

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

struct Problem {
    m: Matrix4<f64>,
    b: Rows,
    f: SVector<f64, 5>,
    p: Vector4<f64>,
    /// h/2.
    half: f64,
}

impl Problem {
    fn drawn(draws: &mut Draws) -> Self {
        let mut entry = || draws.between(-1.5, 1.5);
        let a = Matrix4::from_fn(|_, _| entry());
        let (b, p) = (Rows::from_fn(|_, _| entry()), Vector4::from_fn(|_, _| 2.0 * entry()));
        let f = SVector::from_fn(|_, _| draws.between(0.1, 2.0));
        let half = [0.01, 0.1, 1.0][draws.below(3)];
        Self { m: a * a.transpose() + Matrix4::identity() * 0.3, b, f, p, half }
    }

    fn objective(&self, v: &Vector4<f64>) -> f64 {
        let friction: f64 = (0..5).map(|k| self.f[k] * (self.b.row(k) * v)[0].abs()).sum();
        0.5 * v.dot(&(self.m * v)) - self.p.dot(v) + self.half * friction
    }

    /// The least objective over all sets: each element slides forwards, backwards or sticks.
    fn least(&self) -> f64 {
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

    fn velocity(&self, has_ball: bool) -> Vector4<f64> {
        let start = State { q: Vector4::zeros(), p: self.p };
        self.system(has_ball).by(Proximal, 2.0 * self.half).step(&start).unwrap().velocity
    }
}

#[test]
fn steps_are_the_least_of_all_sets() {
    let mut draws = Draws::new(5);
    let (mut stuck, mut worst) = (0, 0.0_f64);
    for _ in 0..if cfg!(debug_assertions) { 40 } else { 400 } {
        let problem = Problem::drawn(&mut draws);
        let v = problem.velocity(false);
        stuck += usize::from((0..5).any(|k| (problem.b.row(k) * v)[0].abs() < 1e-14));
        let least = problem.least();
        let over = |v: &Vector4<f64>| (problem.objective(v) - least) / (1.0 + least.abs());
        worst = worst.max(over(&v));
        // Positive control.
        assert!(over(&(v + Vector4::new(1e-5, 0.0, 0.0, 0.0))) > 1e-12);
    }
    assert!(worst < 1e-14 && stuck > 10, "{worst:e}, {stuck} stick");
}

/// A length beside |·|: of its force |s| ≤ 1, along its slip where that is not 0.
#[test]
fn a_length_is_held_by_a_ball() {
    let mut draws = Draws::new(6);
    let mut stuck = 0;
    for _ in 0..if cfg!(debug_assertions) { 40 } else { 400 } {
        let mut problem = Problem::drawn(&mut draws);
        // Beside each other at most as many as coordinates, so that their forces are known.
        problem.f[4] = 0.0;
        problem.f[0] *= 3.0;
        let v = problem.velocity(true);
        let slips = problem.b * v;
        let left = problem.p - problem.m * v;
        // (h/2) Σ F Bᵀs = p − Mv for s by least squares.
        let mut rows = problem.b.fixed_rows::<4>(0).transpose() * problem.half;
        for (k, f) in [problem.f[0], problem.f[0], problem.f[2], problem.f[3]].into_iter().enumerate() {
            rows.column_mut(k).scale_mut(f);
        }
        let s = rows.lu().solve(&left).unwrap();
        let length = slips[0].hypot(slips[1]);
        assert!(s[0].hypot(s[1]) < 1.0 + 1e-9 && s[2].abs() < 1.0 + 1e-9 && s[3].abs() < 1.0 + 1e-9);
        if length > 1e-12 {
            assert!((s[0] - slips[0] / length).abs() < 1e-7 && (s[1] - slips[1] / length).abs() < 1e-7);
        } else {
            stuck += 1;
        }
    }
    assert!(stuck > 5);
}
