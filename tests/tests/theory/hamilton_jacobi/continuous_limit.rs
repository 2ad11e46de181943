//! The forced Hamilton–Jacobi equation of the continuous system as the limit h → 0 of the W-equation:
//!
//! ```text
//! S_{k+1}∘F_k − S_k = L_d + W_k,   dW_k = f_d⁻ + DF_kᵀ f_d⁺       tends to
//! ∂S/∂t + H(q, dS) = w,            dw = f(q, ∂H/∂p(q, dS))
//! ```

use dalembert::nalgebra::{SMatrix, SVector, vector};
use dalembert::{Discrete, Discretise, Midpoint, ScalarField, Trapezoidal, rayleigh_system};
use dalembert_tests::damped_oscillator::{CompleteSolution, DAMPED};

/// S(t, q) = ½ s q² + λ q of the continuous oscillator, with ∂S/∂t + H = w up to a function of t.
struct Continuous {
    s: f64,
    lambda: f64,
}

impl Continuous {
    /// s = −r/2 − ω tan ϕ, λ = λ_0 e^{−rt/2m} cos ϕ_0/cos ϕ, ϕ = ϕ_0 + ωt/m, ω² = km − r²/4.
    fn at(t: f64, phase: f64, lambda: f64) -> Self {
        let (m, k, r) = (DAMPED.m, DAMPED.k, DAMPED.r);
        let omega = (k * m - r * r / 4.0).sqrt();
        let angle = phase + omega * t / m;
        Self {
            s: -0.5 * r - omega * angle.tan(),
            lambda: lambda * (-0.5 * r * t / m).exp() * phase.cos() / angle.cos(),
        }
    }

    /// w(q), 0 at q = 0: dw = −(r/m) dS.
    fn work(&self, q: f64) -> f64 {
        -DAMPED.r / DAMPED.m * (0.5 * self.s * q * q + self.lambda * q)
    }
}

#[test]
fn the_oscillators_closed_forms_have_the_limit_that_solves_the_continuous_equation() {
    let (phase, lambda, t, q) = (-0.2, 0.7, 1.0, 0.8);
    let at = Continuous::at(t, phase, lambda);
    // The equation, differentiated by q: ∂p/∂t + (p/m) ∂p/∂q + kq = −(r/m) p.
    let momentum = |t: f64| {
        let Continuous { s, lambda } = Continuous::at(t, phase, lambda);
        s * q + lambda
    };
    let (p, e) = (momentum(t), 1e-4);
    let rate = (8.0 * (momentum(t + e) - momentum(t - e)) - momentum(t + 2.0 * e) + momentum(t - 2.0 * e))
        / (12.0 * e);
    let left = rate + p / DAMPED.m * at.s + DAMPED.k * q;
    assert!((left + DAMPED.r / DAMPED.m * p).abs() < 1e-10);
    // The control: without w it is no solution.
    assert!(left.abs() > 1e-2);

    let errors = [20_u32, 40, 80].map(|steps| {
        let (h, k) = (t / f64::from(steps), steps as usize);
        let discrete = CompleteSolution::new(&DAMPED, h, phase, lambda);
        let of_momentum = (discrete.s(k) - at.s).abs() + (discrete.lambda(k) - at.lambda).abs();
        (of_momentum, (discrete.work(k, q) / h - at.work(q)).abs())
    });
    for pair in errors.windows(2) {
        let orders = [pair[0].0 / pair[1].0, pair[0].1 / pair[1].1].map(f64::log2);
        // dS is that of a rule of order 2; W_k/h is w at the start of a step, to order 1.
        assert!((orders[0] - 2.0).abs() < 0.05 && (orders[1] - 1.0).abs() < 0.1, "{orders:?}");
    }
}

/// A pendulum with linear drag.
#[rayleigh_system(rule = [midpoint, trapezoidal])]
fn pendulum(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
}

const R: f64 = 0.4;
/// S_0 = A sin q.
const A: f64 = 0.3;
const TIME: f64 = 1.2;
const LABELS: [f64; 2] = [-0.4, 0.9];

struct Wave;

impl ScalarField<1> for Wave {
    type Scalar = f64;
    fn value(&self, q: &SVector<f64, 1>) -> f64 {
        A * q[0].sin()
    }
    fn gradient(&self, q: &SVector<f64, 1>) -> SVector<f64, 1> {
        vector![A * q[0].cos()]
    }
    fn hessian(&self, q: &SVector<f64, 1>) -> SMatrix<f64, 1, 1> {
        SMatrix::from_element(-A * q[0].sin())
    }
}

/// q, p, ∂q/∂x and ∂p/∂x along the characteristic of the continuous system from the label x, at the nodes of
/// `steps` steps of RK4.
fn characteristic(x: f64, steps: usize) -> Vec<[f64; 4]> {
    let field = |[q, p, dq, dp]: [f64; 4]| [p, -q.sin() - R * p, dp, -q.cos() * dq - R * dp];
    let step = TIME / steps as f64;
    let along = |z: [f64; 4], k: [f64; 4], share: f64| core::array::from_fn(|i| z[i] + share * step * k[i]);
    let mut nodes = vec![[x, A * x.cos(), 1.0, -A * x.sin()]];
    for k in 0..steps {
        let z = nodes[k];
        let k1 = field(z);
        let k2 = field(along(z, k1, 0.5));
        let k3 = field(along(z, k2, 0.5));
        let k4 = field(along(z, k3, 1.0));
        nodes.push(core::array::from_fn(|i| z[i] + step / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i])));
    }
    nodes
}

fn simpson(values: &[f64], length: f64) -> f64 {
    let last = values.len() - 1;
    let weight = |k| {
        if k == 0 || k == last {
            1.0
        } else if k % 2 == 1 {
            4.0
        } else {
            2.0
        }
    };
    length / (3 * last) as f64 * values.iter().enumerate().map(|(k, value)| weight(k) * value).sum::<f64>()
}

/// S(t, q(t; x)) − S_0(x) = ∫ L + w dt at the second label, and the share of w in it; w = 0 along the
/// characteristic of the first label, and ∂w/∂x = f ∂q/∂x.
fn action() -> (f64, f64) {
    const STEPS: usize = 200;
    let labels = LABELS[1] - LABELS[0];
    let between: Vec<_> =
        (0..=40).map(|i| characteristic(LABELS[0] + labels * f64::from(i) / 40.0, STEPS)).collect();
    let at = |k: usize| {
        let work: Vec<f64> = between.iter().map(|nodes| -R * nodes[k][1] * nodes[k][2]).collect();
        simpson(&work, labels)
    };
    let work: Vec<f64> = (0..=STEPS).map(at).collect();
    let lagrangian: Vec<f64> = between[40].iter().map(|[q, p, ..]| 0.5 * p * p + q.cos()).collect();
    (simpson(&lagrangian, TIME) + simpson(&work, TIME), simpson(&work, TIME))
}

/// S along the characteristics of the discrete theory tends to the solution of the continuous equation.
#[test]
fn carried_values_of_a_pendulum_have_the_limit_of_the_continuous_characteristics() {
    fn converges<M: Copy>(rule: M)
    where
        Pendulum: Discrete<M, 1, Scalar = f64>,
    {
        let ((expected, of_work), system) = (action(), Pendulum { r: R });
        let errors = [12_u32, 24, 48].map(|steps| {
            let theory = system.by(rule, TIME / f64::from(steps)).hamilton_jacobi();
            let [reference, label] = LABELS.map(|x| vector![x]);
            let nodes = 8.try_into().unwrap();
            let carried =
                theory.carried_generating_function(&Wave, &reference, &label, steps as usize, nodes).unwrap();
            let change = carried.values[steps as usize] - carried.values[0];
            [change - expected, change - (expected - of_work)].map(f64::abs)
        });
        for pair in errors.windows(2) {
            let order = (pair[0][0] / pair[1][0]).log2();
            assert!((order - 2.0).abs() < 0.1, "{errors:?}");
        }
        // The control: the equation without w has another solution.
        assert!(errors[2][1] > 100.0 * errors[2][0], "{errors:?}");
    }
    converges(Midpoint);
    converges(Trapezoidal);
}
