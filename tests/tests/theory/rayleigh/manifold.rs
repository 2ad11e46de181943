//! On a Riemannian manifold, L = ½g(v, v) − V and R = ½C(v, v): the exact step is a Rayleigh step for all
//! small h only if C is a Codazzi tensor, (∇_X C)(Y, v) = (∇_Y C)(X, v).

use dalembert::exact::{Exact, ExactSegment};
use dalembert::nalgebra::{Matrix2, SMatrix, SVector, Vector2, matrix, vector};
use dalembert::rayleigh_system;
use dalembert::system::ActingForce;

/// A surface with g = I + `curved`·[[y², 0.2x], [0.2x, 0.5 + sin²x]], and a sum of frictions.
#[derive(Clone, Copy, Default)]
struct Surface {
    curved: f64,
    /// Of [[0.3 + 0.2y², 0.1x], [0.1x, 0.4 + 0.3 sin x]].
    general: f64,
    /// Of the Hessian of 0.15x² + 0.2y² + x⁴/24 + x²y²/12.
    hessian: f64,
    /// Of g, and of xg.
    even: [f64; 2],
}

#[rayleigh_system]
impl Surface {
    fn metric(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let ([x, y], bent) = (q, self.curved);
        (1.0 + bent * y * y) * v[0] * v[0]
            + 0.4 * bent * x * v[0] * v[1]
            + (1.0 + bent * (0.5 + x.sin() * x.sin())) * v[1] * v[1]
    }
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let [x, y] = q;
        0.5 * self.metric(q, v) - (0.25 * x.powi(4) + 0.4 * x * y + 1.5 * y * y)
    }
    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let ([x, y], [u, w]) = (q, v);
        let general = (0.3 + 0.2 * y * y) * u * u + 0.2 * x * u * w + (0.4 + 0.3 * x.sin()) * w * w;
        let hessian = (0.3 + 0.5 * x * x + y * y / 6.0) * u * u
            + 2.0 / 3.0 * x * y * u * w
            + (0.4 + x * x / 6.0) * w * w;
        let even = (self.even[0] + self.even[1] * x) * self.metric(q, v);
        0.5 * (self.general * general + self.hessian * hessian + even)
    }
}

impl Surface {
    /// g with its derivatives by x and y, on paper.
    fn g(&self, [x, y]: [f64; 2]) -> [Matrix2<f64>; 3] {
        let bent = self.curved;
        [
            matrix![1.0 + bent * y * y, 0.2 * bent * x; 0.2 * bent * x, 1.0 + bent * (0.5 + x.sin().powi(2))],
            matrix![0.0, 0.2; 0.2, (2.0 * x).sin()] * bent,
            matrix![2.0 * y, 0.0; 0.0, 0.0] * bent,
        ]
    }

    /// C with its derivatives by x and y, on paper.
    fn c(&self, q: [f64; 2]) -> [Matrix2<f64>; 3] {
        let ([x, y], g, [even, tilt]) = (q, self.g(q), self.even);
        let general = [
            matrix![0.3 + 0.2 * y * y, 0.1 * x; 0.1 * x, 0.4 + 0.3 * x.sin()],
            matrix![0.0, 0.1; 0.1, 0.3 * x.cos()],
            matrix![0.4 * y, 0.0; 0.0, 0.0],
        ];
        let hessian = [
            matrix![0.3 + 0.5 * x * x + y * y / 6.0, x * y / 3.0; x * y / 3.0, 0.4 + x * x / 6.0],
            matrix![x, y / 3.0; y / 3.0, x / 3.0],
            matrix![y / 3.0, x / 3.0; x / 3.0, 0.0],
        ];
        let mut sum = [0, 1, 2]
            .map(|i| general[i] * self.general + hessian[i] * self.hessian + g[i] * (even + tilt * x));
        sum[1] += g[0] * tilt;
        sum
    }

    /// (∇₁C)(∂₂, v) − (∇₂C)(∂₁, v).
    fn codazzi(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let ([g, g1, g2], [c, c1, c2]) = (self.g(q), self.c(q));
        let (inverse, by) = (g.try_inverse().unwrap(), [g1, g2]);
        // ∇_v ∂ₘ = Γᵐ: its components.
        let carried = |m: usize| {
            let lower = Vector2::from_fn(|l, _| {
                (0..2).map(|j| 0.5 * v[j] * (by[m][(l, j)] + by[j][(m, l)] - by[l][(m, j)])).sum()
            });
            inverse * lower
        };
        let v = Vector2::from(v);
        (c1.row(1) * v - c2.row(0) * v)[0] - c.row(1).transpose().dot(&carried(0))
            + c.row(0).transpose().dot(&carried(1))
    }
}

/// The exact segment from `q` to q + hv.
fn segment<L, const N: usize>(system: &L, q: [f64; N], v: [f64; N], h: f64) -> ExactSegment<N>
where
    L: ActingForce<N, Scalar = f64>,
{
    let q = SVector::from(q);
    Exact::new(system).segment(q, q + SVector::from(v) * h, h).unwrap()
}

/// N − Nᵀ of N = ∂p1/∂q1 at the end of a segment, and of ∂p0/∂q0 at its start.
fn asymmetries<const N: usize>(segment: &ExactSegment<N>) -> [SMatrix<f64, N, N>; 2] {
    [segment.p1.d2, segment.p0.d1].map(|n| n - n.transpose())
}

const Q: [f64; 2] = [0.5, -0.3];
const V: [f64; 2] = [0.9, 0.4];

/// The entry (∂x, ∂y) at both ends.
fn of_surface(surface: &Surface, h: f64) -> [f64; 2] {
    asymmetries(&segment(surface, Q, V, h)).map(|n| n[(0, 1)])
}

/// Limits for h → 0 from values at h, h/2, h/4, by Richardson.
fn limits<const K: usize>([a, b, c]: [SVector<f64, K>; 3]) -> SVector<f64, K> {
    let once = [b * 2.0 - a, c * 2.0 - b];
    (once[1] * 4.0 - once[0]) / 3.0
}

const STEPS: [f64; 3] = [0.04, 0.02, 0.01];

/// N − Nᵀ = ±(h/3)[(∇_X C)(Y, v) − (∇_Y C)(X, v)] + O(h²), + at the end of a step and − at its start.
#[test]
fn the_first_asymmetry_is_a_third_of_the_codazzi_form() {
    let flat = Surface { general: 1.0, ..Surface::default() };
    let curved = Surface { curved: 1.0, hessian: 1.5, ..flat };
    let uneven = Surface { curved: 1.0, even: [0.4, 0.4], ..Surface::default() };
    for surface in [flat, curved, uneven] {
        let found = limits(STEPS.map(|h| {
            let segment = segment(&surface, Q, V, h);
            let forms = [(segment.q1, segment.v1), (segment.q0, segment.v0)]
                .map(|(q, v)| surface.codazzi(q.into(), v.into()));
            assert!(forms.iter().all(|form| form.abs() > 0.05));
            let [end, start] = asymmetries(&segment).map(|n| n[(0, 1)] / h);
            vector![end / forms[0], start / forms[1]]
        }));
        println!("{found}");
        assert!((found - vector![1.0, -1.0] / 3.0).amax() < 1e-4);
    }
}

/// A Codazzi tensor leaves O(h²): on the plane the Hessian of any function. C = 2ag leaves nothing.
#[test]
fn codazzi_tensors_leave_no_first_order() {
    let hessian = Surface { hessian: 1.0, ..Surface::default() };
    assert!(hessian.codazzi(Q, V).abs() < 1e-15);
    let [coarse, fine] = [0.04, 0.02].map(|h| of_surface(&hessian, h));
    println!("C = Hess φ: {coarse:?} {fine:?}");
    for (coarse, fine) in coarse.into_iter().zip(fine) {
        assert!(((coarse / fine).log2() - 2.0).abs() < 0.1 && fine.abs() > 1e-8);
    }
    // On the curved surface the same functions make no Codazzi tensor.
    let bent = Surface { curved: 1.0, ..hessian };
    assert!(bent.codazzi(Q, V).abs() > 0.01 && of_surface(&bent, 0.02)[0].abs() > 1e-4);

    let even = Surface { curved: 1.0, even: [0.4, 0.0], ..Surface::default() };
    assert!(even.codazzi(Q, V).abs() < 1e-15);
    for h in [0.5, 0.1, 0.02] {
        let found = of_surface(&even, h);
        println!("C = 2ag, h = {h}: {found:?}");
        assert!(found.iter().all(|asymmetry| asymmetry.abs() < 1e-13));
    }
}

/// A sphere, θ and φ, by a line: C = 2a₁g₁ + 2a₂dz² is parallel. `bond` couples them by V.
struct Product {
    bond: f64,
}

#[rayleigh_system]
impl Product {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        let [theta, phi, z] = q;
        let sphere = v[0] * v[0] + theta.sin() * theta.sin() * v[1] * v[1];
        let height = theta.cos();
        0.5 * (sphere + v[2] * v[2])
            - (height + 0.3 * theta.sin() * phi.cos() * height + 0.25 * z.powi(4) + self.bond * z * height)
    }
    fn rayleigh(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        let sphere = v[0] * v[0] + q[0].sin() * q[0].sin() * v[1] * v[1];
        0.2 * sphere + 0.5 * v[2] * v[2]
    }
}

/// Where ∇C = 0 the exact step is a Rayleigh step if and only if C and Hess V commute; the first asymmetry is
/// that of a plane, (h²/12)(C g⁻¹Hess V − Hess V g⁻¹C).
#[test]
fn parallel_friction_has_to_commute_with_the_hessian() {
    let (q, v) = ([0.8, 0.3, 0.2], [0.6, -0.5, 0.4]);
    let free = asymmetries(&segment(&Product { bond: 0.0 }, q, v, 0.4));
    assert!(free.iter().all(|asymmetry| asymmetry.amax() < 1e-12));
    // Hess V(∂θ, ∂z) = −bond sin θ is all that joins the eigenspaces of 0.4 and 1.
    let bond = 0.5;
    let [coarse, fine] = [0.02, 0.01].map(|h| {
        let segment = segment(&Product { bond }, q, v, h);
        let [end, start] = asymmetries(&segment).map(|n| n / (h * h));
        let expected = [segment.q1, segment.q0].map(|q| (0.4 - 1.0) * -bond * q[0].sin() / 12.0);
        vector![end[(0, 2)] / expected[0], start[(0, 2)] / expected[1], end[(0, 1)], end[(1, 2)]]
    });
    let found = fine * 2.0 - coarse;
    println!("{found}");
    assert!((found - vector![1.0, 1.0, 0.0, 0.0]).amax() < 1e-3);
}
