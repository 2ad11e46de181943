//! The paper's worked oscillator example: its sums, its coefficients of γ⁻, its 𝔽⁻, and its flow (which is
//! right).

use dalembert::nalgebra::vector;
use dalembert::{Discretise, Midpoint};
use dalembert_tests::damped_oscillator::{DAMPED, H, Oscillator, trajectory};

/// The example's discrete action and G_d, printed with q_{j+1}, q_j inside the sum over k, and with the index
/// put right.
struct Example<'a> {
    system: &'a Oscillator,
    q: &'a [f64],
}

impl Example<'_> {
    fn potential(&self, a: f64, b: f64) -> f64 {
        0.5 * H * self.system.k * (0.5 * (a + b)).powi(2)
    }

    fn kinetic(&self, a: f64, b: f64) -> f64 {
        0.5 * H * self.system.m * ((b - a) / H).powi(2)
    }

    /// Σ_{k<j} [kinetic(q_k, q_{k+1}) − potential(q_{j+1}, q_j)] as printed.
    fn action_printed(&self, j: usize) -> f64 {
        (0..j)
            .map(|k| self.kinetic(self.q[k], self.q[k + 1]) - self.potential(self.q[j + 1], self.q[j]))
            .sum()
    }

    /// D1 G_d at (q_j, q_{j+1}) with the coefficients given: of q_j, q_{j+1}, q_{j−1}.
    fn gamma_minus(&self, j: usize, [here, next, last]: [f64; 3]) -> f64 {
        here * self.q[j]
            + next * self.q[j + 1]
            + last * self.q[j - 1]
            + 0.5 * self.system.r * (self.q[j + 1] - self.q[j])
    }
}

#[test]
fn the_examples_printed_coefficients_and_indices_are_wrong() {
    let q = trajectory(&DAMPED, H, 0.0, 1.0, 12);
    let plain: Vec<f64> = q.iter().map(|q| q[0]).collect();
    let example = Example { system: &DAMPED, q: &plain };
    let (m, k, r, h) = (DAMPED.m, DAMPED.k, DAMPED.r, H);
    let theory = DAMPED.by(Midpoint, H).hamilton_jacobi();
    for j in 2..11 {
        // The action: its sum runs over k, the printed potential does not.
        let action = theory.discrete_action(&q[..=j]);
        let corrected: f64 = (0..j)
            .map(|k| example.kinetic(plain[k], plain[k + 1]) - example.potential(plain[k], plain[k + 1]))
            .sum();
        assert!((action - corrected).abs() < 1e-14 && (action - example.action_printed(j)).abs() > 1e-3);

        // D1 G_d, G_d = S_j + S_{j+1} − R_d with the actions along the trajectory, by differences in q_j (G_d
        // is quadratic, so that central differences are exact).
        let generating = |shift: f64| {
            let mut moved = q.clone();
            moved[j][0] += shift;
            let d = moved[j + 1][0] - moved[j][0];
            theory.discrete_action(&moved[..=j]) + theory.discrete_action(&moved[..=j + 1]) - r * d * d / 4.0
        };
        let gamma = (generating(0.5) - generating(-0.5)) / 1.0;
        let corrected = [3.0 * m / h - 0.75 * k * h, -(m / h + 0.25 * k * h), -(2.0 * m / h + 0.5 * k * h)];
        let printed = [m / h - 0.75 * k * h, -(m / h - 0.5 * k * h), -(2.0 * m / h + 0.5 * k * h)];
        assert!((example.gamma_minus(j, corrected) - gamma).abs() < 1e-12, "j = {j}");
        assert!((example.gamma_minus(j, printed) - gamma).abs() > 1e-3, "j = {j}");
        // Even so it is not the momentum: it misses by r (q_{j+1} − q_{j−1}), twice the net force.
        let p = DAMPED.by(Midpoint, h).legendre_minus(&q[j], &q[j + 1]).p[0];
        assert!((gamma - p - r * (plain[j + 1] - plain[j - 1])).abs() < 1e-12, "j = {j}");
    }
}

/// 𝔽⁻ has m/h, not (m − r)/h; the printed flow is right.
#[test]
fn the_examples_minus_transform_has_m_over_h() {
    let (m, k, r, h) = (DAMPED.m, DAMPED.k, DAMPED.r, H);
    let (q0, q1) = (0.3, 0.5);
    let start = DAMPED.by(Midpoint, h).legendre_minus(&vector![q0], &vector![q1]);
    let of = |mass: f64| mass / h * (q1 - q0) + 0.25 * k * h * (q1 + q0) + 0.5 * r * (q1 - q0);
    assert!((start.p[0] - of(m)).abs() < 1e-15);
    assert!((start.p[0] - of(m - r) - r / h * (q1 - q0)).abs() < 1e-15);

    let end = DAMPED.by(Midpoint, h).step(&start).unwrap().state;
    let (q, p, d) = (q0, start.p[0], 4.0 * m + h * h * k + 2.0 * h * r);
    assert!((end.q[0] - (-h * h * k * q + 4.0 * h * p + 2.0 * h * q * r + 4.0 * m * q) / d).abs() < 1e-15);
    assert!(
        (end.p[0] + (h * h * k * p + 4.0 * h * k * m * q + 2.0 * h * p * r - 4.0 * m * p) / d).abs() < 1e-15
    );
}

/// 𝓕⁻ in closed form, right as printed: it is π ∘ F_d^H ∘ γ⁺ of the printed γ⁺ and F_d^H, and the flow on
/// Q×Q.
#[test]
fn the_examples_closed_form_of_the_flow_is_right() {
    for (m, k, r, h) in [(1.0, 1.0, 0.5, 0.25), (0.7, 2.3, 1.1, 0.4), (2.1, 0.4, 0.0, 0.9)] {
        let system = Oscillator { m, k, r };
        let d = h * h * k + 2.0 * h * r + 4.0 * m;
        let printed = |q0: f64, q1: f64, r: f64| {
            (-h * h * k * (q0 + 2.0 * q1) + 2.0 * h * q0 * r - 4.0 * m * (q0 - 2.0 * q1)) / d
        };
        for (q0, q1) in [(0.3, 0.5), (-1.2, 0.7), (0.9, 0.2)] {
            let step = system.by(Midpoint, h).step_configurations(&vector![q0], &vector![q1]).unwrap();
            assert!((printed(q0, q1, r) - step.state.q[0]).abs() < 1e-14);
            let gamma_plus = m / h * (q1 - q0) - 0.25 * k * h * (q0 + q1) - r * (q1 - q0) / 2.0;
            let flow = (-h * h * k * q1 + 4.0 * h * gamma_plus + 2.0 * h * q1 * r + 4.0 * m * q1) / d;
            assert!((printed(q0, q1, r) - flow).abs() < 1e-14);
            // Controls: friction of the other sign in the numerator; 𝔽⁻ as printed, with m − r, gives no such
            // flow.
            assert!(r == 0.0 || (printed(q0, q1, -r) - step.state.q[0]).abs() > 1e-2);
            let by_printed_minus = {
                // (q1, γ⁺) = 𝔽⁻(q1, q2) solved for q2.
                let (mass, spring, drag) = ((m - r) / h, 0.25 * k * h, 0.5 * r);
                (gamma_plus + (mass - spring + drag) * q1) / (mass + spring + drag)
            };
            assert!(r == 0.0 || (by_printed_minus - step.state.q[0]).abs() > 1e-2);
        }
    }
}

/// G_d = S_d^j + S_d^{j+1} − R_d counts the terms k ≤ j − 2 twice, as it does the term k = j − 1; the printed
/// first sum has no factor 2. γ^±, derivatives by q_j and q_{j+1}, do not see it.
#[test]
fn the_examples_generating_function_lacks_a_factor_two() {
    let q = trajectory(&DAMPED, H, 0.2, 0.9, 9);
    let plain: Vec<f64> = q.iter().map(|q| q[0]).collect();
    let theory = DAMPED.by(Midpoint, H).hamilton_jacobi();
    // L_d(q_k, q_{k+1}), and G_d with the given factor of its first sum, the index put right.
    let l = |q: &[f64], k: usize| {
        let (a, b) = (q[k], q[k + 1]);
        0.5 * H * DAMPED.m * ((b - a) / H).powi(2) - 0.5 * H * DAMPED.k * (0.5 * (a + b)).powi(2)
    };
    let g = |q: &[f64], j: usize, factor: f64| {
        let first: f64 = (0..j - 1).map(|k| factor * l(q, k)).sum();
        first + 2.0 * l(q, j - 1) + l(q, j) - DAMPED.r * (0.5 * (q[j + 1] - q[j])).powi(2)
    };
    for j in 2..8 {
        let difference = q[j + 1][0] - q[j][0];
        let definition = theory.discrete_action(&q[..=j]) + theory.discrete_action(&q[..=j + 1])
            - DAMPED.r * difference * difference / 4.0;
        assert!((g(&plain, j, 2.0) - definition).abs() < 1e-14);
        let missing: f64 = (0..j - 1).map(|k| l(&plain, k)).sum();
        assert!((g(&plain, j, 1.0) + missing - definition).abs() < 1e-14 && missing.abs() > 1e-3);
        // By q_j and q_{j+1} both vary alike.
        for at in [j, j + 1] {
            let vary = |factor: f64| {
                let mut moved = plain.clone();
                moved[at] += 0.5;
                let up = g(&moved, j, factor);
                moved[at] -= 1.0;
                up - g(&moved, j, factor)
            };
            assert!((vary(1.0) - vary(2.0)).abs() < 1e-13 && vary(2.0).abs() > 1e-3);
        }
    }
}
