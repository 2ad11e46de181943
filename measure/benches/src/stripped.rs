//! Midpoint steps with derivatives derived by hand, as one would write them for one system over a week.
//!
//! Unknown v̄; residual r = ∂L/∂v − (h/2) G − p0 with G = ∂L/∂q − ∂R/∂v at (q0 + h v̄/2, v̄); p1 = p0 + h G.

type Pair = [f64; 2];

/// Cubic extrapolation of v̄ from the last four, rising from order 0.
struct Guess {
    last: [Pair; 4],
    known: u32,
}

impl Guess {
    fn next(&self) -> Pair {
        let [a, b, c, d] = self.last;
        std::array::from_fn(|i| match self.known {
            0 => 0.0,
            1 => a[i],
            2 => 2.0 * a[i] - b[i],
            3 => 3.0 * (a[i] - b[i]) + c[i],
            _ => 4.0 * (a[i] + c[i]) - 6.0 * b[i] - d[i],
        })
    }

    fn push(&mut self, v: Pair) {
        let [a, b, c, _] = self.last;
        self.last = [v, a, b, c];
        self.known += 1;
    }
}

/// Steps with `evaluate(q̄, v̄)` giving ∂L/∂v, G and their Jacobians by v̄ (`by_v` of ∂L/∂v and of G, along
/// q̄ = q0 + h v̄/2).
#[inline(always)]
fn run(
    h: f64,
    mut q: Pair,
    mut p: Pair,
    steps: u32,
    evaluate: impl Fn(Pair, Pair) -> (Pair, Pair, [Pair; 2], [Pair; 2]),
) -> (Pair, Pair) {
    let mut guess = Guess { last: [[0.0; 2]; 4], known: 0 };
    for _ in 0..steps {
        let mut v = guess.next();
        let mut contraction = 1.0_f64;
        let mut size = f64::INFINITY;
        for _ in 0..20 {
            let middle = [q[0] + 0.5 * h * v[0], q[1] + 0.5 * h * v[1]];
            let (momentum, g, momentum_by_v, g_by_v) = evaluate(middle, v);
            let r = [momentum[0] - 0.5 * h * g[0] - p[0], momentum[1] - 0.5 * h * g[1] - p[1]];
            let j: [Pair; 2] = std::array::from_fn(|i| {
                std::array::from_fn(|k| momentum_by_v[i][k] - 0.5 * h * g_by_v[i][k])
            });
            let inverse = 1.0 / (j[0][0] * j[1][1] - j[0][1] * j[1][0]);
            let d =
                [(j[1][1] * r[0] - j[0][1] * r[1]) * inverse, (j[0][0] * r[1] - j[1][0] * r[0]) * inverse];
            v = [v[0] - d[0], v[1] - d[1]];
            let before = size;
            size = r[0].abs().max(r[1].abs());
            if before.is_finite() && before > 0.0 {
                contraction = size / before;
            }
            let floor = 4.0 * f64::EPSILON * (p[0].abs().max(p[1].abs()) + v[0].abs().max(v[1].abs()));
            // The correction just made leaves |r|·contraction² (quadratic convergence).
            if size <= floor || contraction * contraction * size <= floor {
                let g1 = [
                    g[0] - g_by_v[0][0] * d[0] - g_by_v[0][1] * d[1],
                    g[1] - g_by_v[1][0] * d[0] - g_by_v[1][1] * d[1],
                ];
                p = [p[0] + h * g1[0], p[1] + h * g1[1]];
                break;
            }
        }
        q = [q[0] + h * v[0], q[1] + h * v[1]];
        guess.push(v);
    }
    (q, p)
}

/// The ring: G = −V′ − k v, V = s(s − 1)².
pub fn ring(k: f64, h: f64, q: [f64; 2], p: [f64; 2], steps: u32) -> ([f64; 2], [f64; 2]) {
    run(h, q, p, steps, |q, v| {
        let s = q[0] * q[0] + q[1] * q[1];
        // dV/ds = (s − 1)(3s − 1), d²V/ds² = 6s − 4.
        let slope = (s - 1.0) * (3.0 * s - 1.0);
        let curvature = 6.0 * s - 4.0;
        let g = [-2.0 * slope * q[0] - k * v[0], -2.0 * slope * q[1] - k * v[1]];
        let (xx, xy, yy) = (
            2.0 * slope + 4.0 * curvature * q[0] * q[0],
            4.0 * curvature * q[0] * q[1],
            2.0 * slope + 4.0 * curvature * q[1] * q[1],
        );
        let half = 0.5 * h;
        (v, g, [[1.0, 0.0], [0.0, 1.0]], [[-half * xx - k, -half * xy], [-half * xy, -half * yy - k]])
    })
}

/// The double pendulum, with C = cos(q0 − q1), S = sin(q0 − q1).
#[expect(clippy::too_many_arguments, reason = "the parameters of one machine")]
pub fn double_pendulum(
    m: [f64; 2],
    l: [f64; 2],
    g: f64,
    c: [f64; 2],
    h: f64,
    q: [f64; 2],
    p: [f64; 2],
    steps: u32,
) -> ([f64; 2], [f64; 2]) {
    let (a, b, d) = ((m[0] + m[1]) * l[0] * l[0], m[1] * l[1] * l[1], m[1] * l[0] * l[1]);
    let (e, f) = ((m[0] + m[1]) * g * l[0], m[1] * g * l[1]);
    let half = 0.5 * h;
    run(h, q, p, steps, |q, v| {
        let (sine, cosine) = (q[0] - q[1]).sin_cos();
        let ((s0, c0), (s1, c1)) = (q[0].sin_cos(), q[1].sin_cos());
        let (ds, dc) = (d * sine, d * cosine);
        let momentum = [a * v[0] + dc * v[1], dc * v[0] + b * v[1]];
        let coupling = ds * v[0] * v[1];
        let relative = c[1] * (v[1] - v[0]);
        let force = [-coupling - e * s0 - c[0] * v[0] + relative, coupling - f * s1 - relative];
        // Along v̄ the point moves by half h: ∂/∂v̄ = ∂/∂v + half ∂/∂q.
        let (x, y) = (half * ds, half * dc * v[0] * v[1]);
        let momentum_by_v = [[a - x * v[1], dc + x * v[1]], [dc - x * v[0], b + x * v[0]]];
        let force_by_v = [
            [-ds * v[1] - y - half * e * c0 - c[0] - c[1], -ds * v[0] + y + c[1]],
            [ds * v[1] + y + c[1], ds * v[0] - y - half * f * c1 - c[1]],
        ];
        (momentum, force, momentum_by_v, force_by_v)
    })
}
