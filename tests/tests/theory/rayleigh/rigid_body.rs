//! The damped Moser–Veselov equations: a left-invariant discrete Rayleigh system on SO(3).
//!
//! L_d = −(1/h) tr(W J_d), R_d = −½ tr(W C_d), W = R0ᵀR1: with J^± = J_d ± (h/2)C_d
//!
//! h μ0 = (W J⁺ − J⁺Wᵀ)^∨,   h μ1 = (J⁻W − WᵀJ⁻)^∨

use dalembert::nalgebra::{Matrix3, Rotation3, SMatrix, Vector3, matrix, vector};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

type Matrix = Matrix3<f64>;
type Vector = Vector3<f64>;

const INERTIA: Matrix = matrix![1.0, 0.0, 0.0; 0.0, 1.6, 0.0; 0.0, 0.0, 2.3];
const DAMPING: Matrix = matrix![0.3, 0.1, 0.0; 0.1, 0.2, 0.05; 0.0, 0.05, 0.4];
const START: Vector = vector![1.0, 0.7, -1.2];
const UNITS: [Vector; 3] = [vector![1.0, 0.0, 0.0], vector![0.0, 1.0, 0.0], vector![0.0, 0.0, 1.0]];

/// The vector of A − Aᵀ.
fn vee(a: &Matrix) -> Vector {
    vector![a[(2, 1)] - a[(1, 2)], a[(0, 2)] - a[(2, 0)], a[(1, 0)] - a[(0, 1)]]
}

fn exp(w: &Vector) -> Matrix {
    *Rotation3::new(*w).matrix()
}

/// tr A − A: the inertia of J_d, the friction of C_d.
fn moment(a: &Matrix) -> Matrix {
    Matrix::identity() * a.trace() - a
}

/// J_d and C_d.
struct Body {
    inertia: Matrix,
    damping: Matrix,
}

impl Body {
    fn momenta(&self, w: &Matrix, h: f64) -> [Vector; 2] {
        let half = self.damping * (0.5 * h);
        [vee(&(w * (self.inertia + half))) / h, vee(&((self.inertia - half) * w)) / h]
    }

    /// W and μ1 of a step from μ0, by Newton's method on W exp ξ.
    fn step(&self, start: &Vector, h: f64) -> (Matrix, Vector) {
        let ahead = self.inertia + self.damping * (0.5 * h);
        let mut w = exp(&(moment(&self.inertia).try_inverse().unwrap() * start * h));
        for _ in 0..20 {
            let columns = UNITS.map(|unit| vee(&(w * unit.cross_matrix() * ahead)) / h);
            let left = self.momenta(&w, h)[0] - start;
            let correction = Matrix::from_columns(&columns).try_inverse().unwrap() * left;
            w *= exp(&-correction);
            if correction.amax() < 1e-15 {
                break;
            }
        }
        (w, self.momenta(&w, h)[1])
    }

    /// μ and R after `steps` steps.
    fn run(&self, h: f64, steps: usize) -> (Vector, Matrix) {
        (0..steps).fold((START, Matrix::identity()), |(momentum, rotation), _| {
            let (w, end) = self.step(&momentum, h);
            (end, rotation * w)
        })
    }

    /// The motion Iω̇ = Iω × ω − Cω, Ṙ = Rω̂ from μ, by the classical Runge–Kutta method.
    fn motion(&self, start: &Vector, time: f64, steps: usize) -> (Vector, Matrix) {
        let (inverse, friction) = (moment(&self.inertia).try_inverse().unwrap(), moment(&self.damping));
        let rate = |(momentum, rotation): (Vector, Matrix)| {
            let w = inverse * momentum;
            (momentum.cross(&w) - friction * w, rotation * w.cross_matrix())
        };
        let plus = |a: (Vector, Matrix), b: (Vector, Matrix), s: f64| (a.0 + b.0 * s, a.1 + b.1 * s);
        let h = time / steps as f64;
        (0..steps).fold((*start, Matrix::identity()), |state, _| {
            let a = rate(state);
            let b = rate(plus(state, a, 0.5 * h));
            let c = rate(plus(state, b, 0.5 * h));
            let d = rate(plus(state, c, h));
            [(a, 1.0), (b, 2.0), (c, 2.0), (d, 1.0)]
                .into_iter()
                .fold(state, |sum, (rate, weight)| plus(sum, rate, weight * h / 6.0))
        })
    }
}

const GENERAL: Body = Body { inertia: INERTIA, damping: DAMPING };

/// C = 2aI.
fn even(a: f64) -> Body {
    Body { inertia: INERTIA, damping: INERTIA * (2.0 * a) }
}

/// The derivative of a function of the vector x at 0, by differences of order 4.
fn derivative(f: impl Fn(Vector) -> Vector) -> Matrix {
    let spacing = 1e-3;
    Matrix::from_columns(&UNITS.map(|unit| {
        let at = |k: f64| f(unit * (k * spacing));
        (at(-2.0) - at(2.0) + (at(1.0) - at(-1.0)) * 8.0) / (12.0 * spacing)
    }))
}

#[test]
fn momentum_and_attitude_are_of_order_two() {
    for body in [GENERAL, even(0.1)] {
        let (momentum, rotation) = body.motion(&START, 2.0, 400);
        let errors = [20, 40, 80].map(|steps| {
            let found = body.run(2.0 / steps as f64, steps);
            [(found.0 - momentum).amax(), (found.1 - rotation).amax()]
        });
        println!("{errors:?}");
        for pair in errors.windows(2) {
            for (coarse, fine) in pair[0].into_iter().zip(pair[1]) {
                assert!(((coarse / fine).log2() - 2.0).abs() < 0.05, "{coarse} {fine}");
            }
        }
        // The control: the motion without friction is another one.
        let free = Body { damping: Matrix::zeros(), ..body };
        assert!((free.motion(&START, 2.0, 400).0 - momentum).amax() > 0.1);
    }
}

/// A step of −h undoes a step of h.
#[test]
fn the_step_is_self_adjoint() {
    let (w, end) = GENERAL.step(&START, 0.2);
    let (back, start) = GENERAL.step(&end, -0.2);
    assert!((start - START).amax() < 1e-14 && (back * w - Matrix::identity()).amax() < 1e-14);
    // With all of the friction at one end it does not.
    let one_sided = |momentum: &Vector, h: f64| {
        let body = Body { inertia: INERTIA - DAMPING * (0.5 * h), damping: DAMPING };
        body.step(momentum, h).1
    };
    assert!((one_sided(&one_sided(&START, 0.2), -0.2) - START).amax() > 1e-3);
}

/// C_d = 2aJ_d, R_d = ahL_d: |μ| falls by c = (1 − ah)/(1 + ah) exactly, on whatever orbit.
#[test]
fn the_coadjoint_orbit_shrinks_by_the_same_factor_each_step() {
    let (a, h, steps) = (0.1, 0.1, 50);
    let ratio = |body: &Body| body.run(h, steps).0.norm() / START.norm();
    let expected = ((1.0 - a * h) / (1.0 + a * h)).powi(steps as i32);
    println!("{:.16} {expected:.16}", ratio(&even(a)));
    assert!((ratio(&even(a)) / expected - 1.0).abs() < 1e-13);
    // μ1 = cWᵀμ0: the spatial momentum Rμ keeps its direction.
    let (momentum, rotation) = even(a).run(h, steps);
    assert!((rotation * momentum - START * expected).amax() < 1e-13);
    // The control: of another C it does not, nor is the motion's own factor e^{−2aT} this one.
    let (momentum, rotation) = GENERAL.run(h, steps);
    assert!((rotation * momentum).cross(&START).norm() > 0.1 * momentum.norm() * START.norm());
    assert!((f64::exp(-2.0 * a * h * steps as f64) / expected - 1.0).abs() > 1e-5);
}

/// d⟨μ1, W⁻¹dW⟩ and d⟨μ0, dW W⁻¹⟩ on pairs of unit vectors, from the derivatives of μ1 by W exp x and of μ0
/// by (exp x)W.
fn closedness([by_left, by_right]: [&Matrix; 2], [start, end]: [&Vector; 2]) -> [Matrix; 2] {
    let bracket = |momentum: &Vector| momentum.cross_matrix().transpose();
    [by_left.transpose() - by_left - bracket(end), by_right.transpose() - by_right + bracket(start)]
}

/// The two 1-forms are closed; with a gyroscopic force besides they are not.
#[test]
fn the_one_forms_of_the_step_are_closed() {
    let (h, w) = (0.2, exp(&vector![0.3, -0.2, 0.4]));
    let largest = |body: &Body, gyroscopic: f64| {
        let momenta = |w: &Matrix| {
            body.momenta(w, h).map(|momentum| momentum + vector![0.1, 0.2, 0.3].cross(&vee(w)) * gyroscopic)
        };
        let by_left = derivative(|x| momenta(&(w * exp(&x)))[1]);
        let by_right = derivative(|x| momenta(&(exp(&x) * w))[0]);
        let [start, end] = momenta(&w);
        closedness([&by_left, &by_right], [&start, &end]).map(|form| form.amax())
    };
    for body in [GENERAL, even(0.1)] {
        assert!(largest(&body, 0.0).iter().all(|form| *form < 1e-10));
        assert!(largest(&body, 1.0).iter().all(|form| *form > 0.1), "{:?}", largest(&body, 1.0));
    }
}

/// (∇_X C)(Y, v) − (∇_Y C)(X, v) on pairs of unit vectors, of the left-invariant metric I with ∇_X Y = ½X × Y
/// + ½I⁻¹(X × IY + Y × IX).
fn codazzi(inertia: &Matrix, friction: &Matrix, v: &Vector) -> Matrix {
    let inverse = inertia.try_inverse().unwrap();
    let carried = |x: &Vector, y: &Vector| {
        (x.cross(y) + inverse * (x.cross(&(inertia * y)) + y.cross(&(inertia * x)))) * 0.5
    };
    let of = |a: &Vector, b: &Vector| a.dot(&(friction * b));
    Matrix::from_fn(|i, j| {
        let (x, y) = (&UNITS[i], &UNITS[j]);
        of(x, &carried(y, v)) - of(y, &carried(x, v)) - of(&x.cross(y), v)
    })
}

/// The exact step of the damped body has an R_d for C = 2aI; of another C its first form is −(h/3)[(∇_X C)(Y,
/// ω) − (∇_Y C)(X, ω)] + O(h²), the Codazzi form of the left-invariant metric.
#[test]
fn the_exact_step_has_an_r_d_where_friction_is_proportional_to_inertia() {
    let form = |body: &Body, h: f64| {
        let (end, w) = body.motion(&START, h, 32);
        let by_start = derivative(|x| body.motion(&(START + x), h, 32).0);
        // (sin |ξ|/|ξ|) ξ of exp ξ, whose derivative at ξ = 0 is that of ξ.
        let turned = derivative(|x| vee(&(w.transpose() * body.motion(&(START + x), h, 32).1)) * 0.5);
        let by_left = by_start * turned.try_inverse().unwrap();
        (closedness([&by_left, &Matrix::zeros()], [&Vector::zeros(), &end])[0], end)
    };
    for h in [0.4, 0.1] {
        let even = form(&even(0.1), h).0.amax();
        println!("C = 2aI, h = {h}: {even:.1e}");
        assert!(even < 1e-9);
    }
    let codazzi = |body: &Body, momentum: &Vector| {
        let inertia = moment(&body.inertia);
        codazzi(&inertia, &moment(&body.damping), &(inertia.try_inverse().unwrap() * momentum))
    };
    // C = 1, and a general one.
    let round = Body { damping: Matrix::identity() * 0.15, ..GENERAL };
    for body in [round, GENERAL] {
        let [coarse, fine] = [0.04, 0.02].map(|h| {
            let (found, end) = form(&body, h);
            (found / h, codazzi(&body, &end) / -3.0)
        });
        let limit = fine.0 * 2.0 - coarse.0;
        let expected = fine.1 * 2.0 - coarse.1;
        println!("{:.5} {:.1e}", expected.amax(), (limit - expected).amax());
        assert!(expected.amax() > 1e-2 && (limit - expected).amax() < 2e-3 * expected.amax());
    }
}

/// Of a body, I₁ ≤ I₂ + I₃ and so on, no friction but C = 2aI is a Codazzi tensor. The control is no body:
/// √I₃ = √I₁ + √I₂.
#[test]
fn the_codazzi_tensors_of_a_body_are_the_multiples_of_its_inertia() {
    let mut random = StdRng::seed_from_u64(31);
    let mut masses = || {
        vector![random.random_range(0.0..1.0), random.random_range(0.1..1.0), random.random_range(0.1..1.0)]
    };
    let kernel = |inertia: &Matrix| {
        // The form is linear in C, v and the pair.
        let columns: [SMatrix<f64, 9, 1>; 6] =
            [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)].map(|(i, j)| {
                let mut friction = Matrix::zeros();
                (friction[(i, j)], friction[(j, i)]) = (1.0, 1.0);
                let forms = UNITS.map(|v| codazzi(inertia, &friction, &v));
                SMatrix::from_fn(|at, _| [(0, 1), (0, 2), (1, 2)].map(|pair| forms[at / 3][pair])[at % 3])
            });
        let found = SMatrix::<f64, 9, 6>::from_columns(&columns).singular_values();
        found.iter().filter(|value| **value < 1e-12 * found.max()).count()
    };
    for _ in 0..40 {
        // Of second moments of mass; one of them is 0 of a lamina.
        let turn = exp(&masses());
        let inertia = turn * moment(&Matrix::from_diagonal(&masses())) * turn.transpose();
        assert_eq!(kernel(&inertia), 1);
        assert!(UNITS.iter().all(|v| codazzi(&inertia, &inertia, v).amax() < 1e-14));
    }
    assert_eq!(kernel(&moment(&Matrix::from_diagonal(&vector![0.0, 1.0, 2.0]))), 1);
    assert_eq!(kernel(&Matrix::from_diagonal(&vector![4.0, 9.0, 25.0])), 2);
}
