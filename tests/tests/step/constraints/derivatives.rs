//! Derivatives of steps on constraints, beside differences of the step that the nearest state extends.

use dalembert::nalgebra::{SMatrix, SVector};
use dalembert::{Discretise, Midpoint, State, StepError, Trapezoidal, rayleigh_system};

/// A mass that depends on q, a force with an input, a rod whose length depends on time, and rolling: all that
/// derivatives meet.
struct Everything {
    m: f64,
    length: f64,
    radius: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal], parameters = [m, length, radius])]
impl Everything {
    fn lagrangian(&self, q: [f64; 4], v: [f64; 4], t: f64) -> f64 {
        let mass = self.m * (1.0 + 0.3 * q[0] * q[0]);
        0.5 * (mass * v[0] * v[0] + self.m * v[1] * v[1] + 0.4 * v[2] * v[2] + 0.7 * v[3] * v[3])
            + 0.2 * q[3].cos() * v[0] * v[2]
            - 3.0 * q[1]
            + 0.1 * q[2] * t.sin()
    }

    fn rayleigh(&self, q: [f64; 4], v: [f64; 4]) -> f64 {
        0.1 * (1.0 + q[1] * q[1]) * v[1] * v[1] + 0.05 * v[3] * v[3]
    }

    fn force(&self, q: [f64; 4], v: [f64; 4], u: [f64; 2]) -> [f64; 4] {
        [u[0] * q[1].cos(), 0.0, u[1] - 0.1 * v[2], 0.2 * u[0] * u[1]]
    }

    fn constraints(&self, q: [f64; 4], t: f64) -> [f64; 1] {
        let length = self.length * (1.0 + 0.1 * t);
        [q[0] * q[0] + q[1] * q[1] + 0.1 * q[3] - length * length]
    }

    fn velocity_constraints(&self, q: [f64; 4], v: [f64; 4], t: f64) -> [f64; 1] {
        [v[2] - self.radius * q[3].cos() * v[3] - 0.1 * t]
    }
}

const PLACE: [f64; 4] = [0.7, -0.8, 0.3, 0.4];
const PACE: [f64; 4] = [0.4, 0.2, 0.5, -0.3];
const INPUT: [f64; 2] = [0.6, -0.4];
const TIME: f64 = 0.9;

/// All that the step is differentiated by: q0, p0, u and θ.
type Everywhere = SVector<f64, 13>;

/// The end of the step from the nearest state.
macro_rules! end {
    ($rule:expr, $x:expr) => {{
        let x: &Everywhere = $x;
        let system = Everything { m: x[10], length: x[11], radius: x[12] };
        let view = system.driven([x[8], x[9]], TIME);
        let at = State { q: x.fixed_rows::<4>(0).into(), p: x.fixed_rows::<4>(4).into() };
        let v = at.velocity(&view)?;
        let start = State::nearest(&view, at.q, v)?;
        let end = view.by($rule, 0.08).step(&start)?.state;
        SVector::<f64, 8>::from_fn(|i, _| if i < 4 { end.q[i] } else { end.p[i - 4] })
    }};
}

/// Differences of the fourth order of the end.
macro_rules! slopes {
    ($rule:expr, $x:expr) => {{
        let mut slopes = SMatrix::<f64, 8, 13>::zeros();
        for j in 0..13 {
            let by = |places: f64| -> Result<SVector<f64, 8>, StepError> {
                let mut moved = *$x;
                moved[j] += places * 2e-4;
                Ok(end!($rule, &moved))
            };
            let slope = ((by(1.0)? - by(-1.0)?) * 8.0 - (by(2.0)? - by(-2.0)?)) / 24e-4;
            slopes.set_column(j, &slope);
        }
        slopes
    }};
}

/// A, B and the derivatives by parameters, of the step and of its segment.
macro_rules! verify {
    ($rule:expr) => {{
        let system = Everything { m: 1.2, length: 0.9, radius: 0.5 };
        let view = system.driven(INPUT, TIME);
        let start = State::nearest(&view, PLACE, PACE)?;
        let fields = [INPUT[0], INPUT[1], system.m, system.length, system.radius];
        let x = Everywhere::from_fn(|i, _| match i {
            0..4 => start.q[i],
            4..8 => start.p[i - 4],
            _ => fields[i - 8],
        });
        let slopes = slopes!($rule, &x);
        let by = view.by($rule, 0.08);
        let step = by.step(&start)?;
        let taken = by.linearized(&start)?;
        let on_segment = by.segment(&start.q, &step.state.q)?.linearized()?;
        for of in [taken, on_segment] {
            let a: SMatrix<f64, 8, 8> = of.by_state()?.assembled();
            let b: SMatrix<f64, 8, 2> = of.by_input()?.assembled();
            let theta: SMatrix<f64, 8, 3> = of.by_parameters()?.assembled();
            for j in 0..13 {
                let column = match j {
                    0..8 => a.column(j),
                    8..10 => b.column(j - 8),
                    _ => theta.column(j - 10),
                };
                let error = (slopes.column(j) - column).amax();
                assert!(error < 2e-10, "{j}: {error:e}");
            }
        }
    }};
}

#[test]
fn a_b_and_derivatives_by_parameters_are_those_of_differences() -> Result<(), StepError> {
    verify!(Midpoint);
    verify!(Trapezoidal);
    Ok(())
}
