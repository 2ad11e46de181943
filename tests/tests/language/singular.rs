//! Derivatives where they do not exist: what the table of `dalembert::generated::dual::Real` says, the same
//! in both engines.
//!
//! Each case is a function of x = q₀ and y = q₁, as part of L and as a component of f, at its singular
//! points. Expected are its value, gradient and Hessian in closed form, one-sided limits where there is a
//! side; and zeros for whatever does not depend on x or y, however singular the function is.

use dalembert::nalgebra::{SMatrix, SVector};
use dalembert::step::{Fused, NewtonMatrix, Segment};
use dalembert::system::Direction;
use dalembert::{Discretise, Force, Lagrangian, Midpoint};

const INF: f64 = f64::INFINITY;
const NAN: f64 = f64::NAN;

/// What a function of (x, y) is at a point.
struct At {
    point: [f64; 2],
    value: f64,
    gradient: [f64; 2],
    /// By xx, xy, yy.
    hessian: [f64; 3],
}

/// A function of x alone.
fn of_x(x: f64, value: f64, slope: f64, curvature: f64) -> At {
    At { point: [x, 0.7], value, gradient: [slope, 0.0], hessian: [curvature, 0.0, 0.0] }
}

fn at(point: [f64; 2], value: f64, gradient: [f64; 2], hessian: [f64; 3]) -> At {
    At { point, value, gradient, hessian }
}

/// Equal up to rounding, infinities with their sign, NaN with NaN.
fn same(a: f64, b: f64) -> bool {
    let is_near = a.is_finite() && b.is_finite() && (a - b).abs() <= 8.0 * f64::EPSILON * b.abs();
    a == b || (a.is_nan() && b.is_nan()) || is_near
}

fn all_same<const R: usize, const C: usize>(a: &SMatrix<f64, R, C>, b: &SMatrix<f64, R, C>) -> bool {
    a.iter().zip(b.iter()).all(|(a, b)| same(*a, *b))
}

/// Holds one engine against the expected numbers; L = f(x, y) + ½v₀².
fn check<S>(engine: &str, system: &S, expected: &At) -> Result<(), String>
where
    S: Lagrangian<2, Scalar = f64> + Force<2>,
{
    let [x, y] = expected.point;
    let (q, v) = (SVector::from([x, y]), SVector::from([2.0, 0.0]));
    let fail = |what: &str, got: String| Err(format!("{engine}, {what} at {:?}: {got}", expected.point));
    let [xx, xy, yy] = expected.hessian;
    let (d1, d2) = (SVector::from(expected.gradient), v);
    let (d11, d22) = (SMatrix::from([[xx, xy], [xy, yy]]), SMatrix::from([[1.0, 0.0], [0.0, 0.0]]));

    let gradient = system.lagrangian_gradient(&q, &v);
    if !same(gradient.value, expected.value + 2.0) {
        return fail("value", gradient.value.to_string());
    }
    if !all_same(&gradient.d1, &d1) || !all_same(&gradient.d2, &d2) {
        return fail("gradient", format!("{:?} {:?}", gradient.d1, gradient.d2));
    }
    let l = system.lagrangian_derivatives(&q, &v);
    if !all_same(&l.d1, &d1) || !all_same(&l.d2, &d2) {
        return fail("first derivatives", format!("{:?} {:?}", l.d1, l.d2));
    }
    if !all_same(&l.d11, &d11) || !all_same(&l.d12, &SMatrix::zeros()) || !all_same(&l.d22, &d22) {
        return fail("second derivatives", format!("{:?} {:?} {:?}", l.d11, l.d12, l.d22));
    }
    let minus = Direction { first: -0.5, second: 1.0 };
    let plus = Direction { first: 2.0, second: 1.0 };
    let variations = system.lagrangian_variations(&q, &v, minus, plus);
    if !all_same(&variations.minus, &(d1 * minus.first + d2 * minus.second))
        || !all_same(&variations.plus, &(d1 * plus.first + d2 * plus.second))
        || !all_same(
            &variations.mixed,
            &(d11 * (minus.first * plus.first) + d22 * (minus.second * plus.second)),
        )
    {
        return fail("variations", format!("{variations:?}"));
    }
    // The force is (f(x, y), v₁²/2).
    let (v, [gx, gy]) = (SVector::from([2.0, 3.0]), expected.gradient);
    let (fq, fv) = (SMatrix::from([[gx, 0.0], [gy, 0.0]]), SMatrix::from([[0.0, 0.0], [0.0, 3.0]]));
    let force = system.force_derivatives(&q, &v);
    if !same(force.value[0], expected.value) || !all_same(&force.d1, &fq) || !all_same(&force.d2, &fv) {
        return fail("force", format!("{:?} {:?} {:?}", force.value, force.d1, force.d2));
    }
    let (_, along) = system.force_variation(&q, &v, plus);
    if !all_same(&along, &(fq * plus.first + fv * plus.second)) {
        return fail("variation of the force", format!("{along:?}"));
    }
    Ok(())
}

/// The step's functions, of which both engines must say the same; at v = 0, so that q̄ is the point itself.
fn agree<A, B>(a: &A, b: &B, point: [f64; 2]) -> Result<(), String>
where
    A: Fused<Midpoint, 2, Scalar = f64>,
    B: Fused<Midpoint, 2, Scalar = f64>,
{
    let (q, v) = (SVector::from(point), SVector::zeros());
    let (ka, kb) =
        (a.step_kernel(&Segment { q0: q, v, h: 0.25 }), b.step_kernel(&Segment { q0: q, v, h: 0.25 }));
    let (ka, kb) = ((ka.p0, ka.matrix.dense()), (kb.p0, kb.matrix.dense()));
    // Sums of infinite terms are infinite or NaN by their order, which is the engine's own.
    let lost = |a: f64, b: f64| !a.is_finite() && !b.is_finite();
    let alike = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(&a, &b)| same(a, b) || lost(a, b));
    if !alike(ka.0.as_slice(), kb.0.as_slice()) || !alike(ka.1.as_slice(), kb.1.as_slice()) {
        return Err(format!("step kernel at {point:?}: {ka:?}, num-dual {kb:?}"));
    }
    let (ma, mb) = (a.momenta(&Segment { q0: q, v, h: 0.25 }), b.momenta(&Segment { q0: q, v, h: 0.25 }));
    if !all_same(&ma.p0, &mb.p0) || !all_same(&ma.p1, &mb.p1) {
        return Err(format!("momenta at {point:?}: {ma:?}, num-dual {mb:?}"));
    }
    Ok(())
}

/// The same system with the engine named.
macro_rules! system {
    ($engine:ident, $x:ident, $y:ident, $body:expr) => {
        pub mod $engine {
            use dalembert::rayleigh_system;

            pub struct System;

            #[rayleigh_system(derivatives = $engine)]
            impl System {
                fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                    Self::function(q[0], q[1]) + 0.5 * v[0] * v[0]
                }

                fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
                    [Self::function(q[0], q[1]), 0.5 * v[1] * v[1]]
                }

                fn function($x: f64, $y: f64) -> f64 {
                    let _ = $y;
                    $body
                }
            }
        }
    };
}

/// `name: |x, y| function; [what it is at its points]`
macro_rules! cases {
    ($($name:ident: |$x:ident, $y:ident| $body:expr; [$($expected:expr),* $(,)?])*) => {
        $(
            mod $name {
                system!(expanded, $x, $y, $body);
                system!(num_dual, $x, $y, $body);
            }
        )*

        #[test]
        fn singular_points_are_as_documented_in_both_engines() {
            let mut failures = Vec::new();
            $(
                let (a, b) = ($name::expanded::System, $name::num_dual::System);
                for expected in [$($expected),*] {
                    for result in [
                        check("written out", &a, &expected),
                        check("num-dual", &b, &expected),
                        agree(&a, &b, expected.point),
                    ] {
                        failures.extend(result.err().map(|failure| format!("{}: {failure}", stringify!($name))));
                    }
                }
            )*
            assert!(failures.is_empty(), "{}", failures.join("\n"));
        }
    };
}

use std::f64::consts::{FRAC_PI_2, LN_2, LN_10, PI};

cases! {
    sqrt: |x, y| x.sqrt(); [
        of_x(0.0, 0.0, INF, -INF), of_x(-0.0, 0.0, -INF, -INF), of_x(-1.0, NAN, NAN, NAN), of_x(4.0, 2.0, 0.25, -1.0 / 32.0),
    ]
    cbrt: |x, y| x.cbrt(); [
        of_x(0.0, 0.0, INF, -INF), of_x(-0.0, 0.0, INF, INF), of_x(-8.0, -2.0, 1.0 / 12.0, 1.0 / 144.0),
    ]
    ln: |x, y| x.ln(); [of_x(0.0, -INF, INF, -INF), of_x(-2.0, NAN, -0.5, -0.25)]
    log2: |x, y| x.log2(); [of_x(0.0, -INF, INF, -INF), of_x(-2.0, NAN, -0.5 / LN_2, -0.25 / LN_2)]
    log10: |x, y| x.log10(); [of_x(0.0, -INF, INF, -INF), of_x(-2.0, NAN, -0.5 / LN_10, -0.25 / LN_10)]
    ln_1p: |x, y| x.ln_1p(); [of_x(-1.0, -INF, INF, -INF), of_x(-3.0, NAN, -0.5, -0.25)]
    recip: |x, y| x.recip(); [of_x(0.0, INF, -INF, INF), of_x(-0.0, -INF, -INF, -INF)]
    asin: |x, y| x.asin(); [
        of_x(1.0, FRAC_PI_2, INF, INF), of_x(-1.0, -FRAC_PI_2, INF, -INF), of_x(2.0, NAN, NAN, NAN),
    ]
    acos: |x, y| x.acos(); [
        of_x(1.0, 0.0, -INF, -INF), of_x(-1.0, PI, -INF, INF), of_x(2.0, NAN, NAN, NAN),
    ]
    acosh: |x, y| x.acosh(); [of_x(1.0, 0.0, INF, -INF), of_x(0.5, NAN, NAN, NAN)]
    atanh: |x, y| x.atanh(); [of_x(1.0, INF, INF, INF), of_x(-1.0, -INF, INF, -INF)]
    abs: |x, y| x.abs(); [
        of_x(0.0, 0.0, 1.0, 0.0), of_x(-0.0, 0.0, -1.0, 0.0), of_x(-3.0, 3.0, -1.0, 0.0),
    ]
    signum: |x, y| x.signum(); [of_x(0.0, 1.0, 0.0, 0.0), of_x(-0.0, -1.0, 0.0, 0.0)]
    copysign: |x, y| x.copysign(y); [
        at([0.0, -1.0], 0.0, [-1.0, 0.0], [0.0; 3]), at([-0.0, -1.0], 0.0, [1.0, 0.0], [0.0; 3]),
        at([2.0, -0.0], -2.0, [-1.0, 0.0], [0.0; 3]),
    ]
    powi_0: |x, y| x.powi(0); [of_x(0.0, 1.0, 0.0, 0.0)]
    powi_1: |x, y| x.powi(1); [of_x(0.0, 0.0, 1.0, 0.0)]
    powi_2: |x, y| x.powi(2); [of_x(0.0, 0.0, 0.0, 2.0)]
    powi_3: |x, y| x.powi(3); [of_x(0.0, 0.0, 0.0, 0.0)]
    powi_4: |x, y| x.powi(4); [of_x(0.0, 0.0, 0.0, 0.0)]
    powi_negative: |x, y| x.powi(-1); [of_x(0.0, INF, -INF, INF), of_x(-0.0, -INF, -INF, -INF)]
    powi_negative_even: |x, y| x.powi(-2); [of_x(0.0, INF, -INF, INF), of_x(-0.0, INF, INF, INF)]
    powf_0: |x, y| x.powf(0.0); [of_x(0.0, 1.0, 0.0, 0.0), of_x(-2.0, 1.0, 0.0, 0.0)]
    powf_half: |x, y| x.powf(0.5); [of_x(0.0, 0.0, INF, -INF), of_x(-1.0, NAN, NAN, NAN)]
    powf_1: |x, y| x.powf(1.0); [of_x(0.0, 0.0, 1.0, 0.0), of_x(-2.0, -2.0, 1.0, 0.0)]
    powf_one_and_a_half: |x, y| x.powf(1.5); [of_x(0.0, 0.0, 0.0, INF), of_x(-1.0, NAN, NAN, NAN)]
    powf_2: |x, y| x.powf(2.0); [of_x(0.0, 0.0, 0.0, 2.0), of_x(-3.0, 9.0, -6.0, 2.0)]
    powf_two_and_a_half: |x, y| x.powf(2.5); [of_x(0.0, 0.0, 0.0, 0.0)]
    powf_3: |x, y| x.powf(3.0); [of_x(0.0, 0.0, 0.0, 0.0), of_x(-2.0, -8.0, 12.0, -12.0)]
    powf_negative: |x, y| x.powf(-1.0); [of_x(0.0, INF, -INF, INF), of_x(-2.0, -0.5, -0.25, -0.25)]
    powf_of_both: |x, y| x.powf(y); [
        at([0.0, 2.0], 0.0, [0.0, NAN], [2.0, NAN, NAN]), at([0.0, 0.5], 0.0, [INF, NAN], [-INF, NAN, NAN]),
        at([-1.0, 2.0], 1.0, [-2.0, NAN], [2.0, NAN, NAN]),
        at([2.0, 3.0], 8.0, [12.0, 8.0 * LN_2], [12.0, 4.0 + 12.0 * LN_2, 8.0 * LN_2 * LN_2]),
    ]
    power_of_a_constant: |x, y| 0.0_f64.powf(x); [of_x(2.0, 0.0, NAN, NAN)]
    log: |x, y| x.log(2.0); [of_x(0.0, -INF, INF, -INF)]
    min: |x, y| x.min(y); [
        at([1.0, 1.0], 1.0, [1.0, 0.0], [0.0; 3]), at([NAN, 1.0], 1.0, [0.0, 1.0], [0.0; 3]),
        at([1.0, NAN], 1.0, [1.0, 0.0], [0.0; 3]), at([2.0, 1.0], 1.0, [0.0, 1.0], [0.0; 3]),
    ]
    max: |x, y| x.max(y); [
        at([1.0, 1.0], 1.0, [1.0, 0.0], [0.0; 3]), at([NAN, 1.0], 1.0, [0.0, 1.0], [0.0; 3]),
        at([1.0, NAN], 1.0, [1.0, 0.0], [0.0; 3]), at([2.0, 1.0], 2.0, [1.0, 0.0], [0.0; 3]),
    ]
    clamp: |x, y| x.clamp(-1.0, 1.0); [
        of_x(1.0, 1.0, 1.0, 0.0), of_x(-1.0, -1.0, 1.0, 0.0), of_x(2.0, 1.0, 0.0, 0.0), of_x(-2.0, -1.0, 0.0, 0.0),
    ]
    clamp_between: |x, y| x.clamp(y, 3.0); [
        at([1.0, 1.0], 1.0, [1.0, 0.0], [0.0; 3]), at([0.0, 1.0], 1.0, [0.0, 1.0], [0.0; 3]),
    ]
    atan2: |x, y| x.atan2(y); [
        at([0.0, 0.0], 0.0, [NAN, NAN], [NAN, NAN, NAN]), at([0.0, -1.0], PI, [-1.0, 0.0], [0.0, -1.0, 0.0]),
        at([-0.0, -1.0], -PI, [-1.0, 0.0], [0.0, -1.0, 0.0]), at([1.0, 0.0], FRAC_PI_2, [0.0, -1.0], [0.0, 1.0, 0.0]),
    ]
    atan2_of_one: |x, y| x.atan2(0.0); [of_x(0.0, 0.0, NAN, NAN), of_x(2.0, FRAC_PI_2, 0.0, 0.0)]
    hypot: |x, y| x.hypot(y); [
        at([0.0, 0.0], 0.0, [NAN, NAN], [NAN, NAN, NAN]), at([0.0, 2.0], 2.0, [0.0, 1.0], [0.5, 0.0, 0.0]),
        // Second derivatives of 1/r, where 1/r² overflows or is none.
        at([1e-300, 0.0], 1e-300, [1.0, 0.0], [0.0, 0.0, 1e300]), at([0.0, -1e-300], 1e-300, [0.0, -1.0], [1e300, 0.0, 0.0]),
        at([3e-160, 4e-160], 5e-160, [0.6, 0.8], [1.28e159, -9.6e158, 7.2e158]),
        at([3e160, -4e160], 5e160, [0.6, -0.8], [1.28e-161, 9.6e-162, 7.2e-162]),
        at([1e-160, 1.0], 1.0, [1e-160, 1.0], [1.0, -1e-160, 1e-320]),
        at([1e-190, 1e-40], 1e-40, [1e-150, 1.0], [1e40, -1e-110, 1e-260]),
    ]
    hypot_of_one: |x, y| x.hypot(0.0); [of_x(0.0, 0.0, NAN, NAN), of_x(-2.0, 2.0, -1.0, 0.0)]
    root_of_squares: |x, y| (x * x + y * y).sqrt(); [at([0.0, 0.0], 0.0, [NAN, NAN], [NAN, NAN, NAN])]
    quotient: |x, y| x / y; [
        at([1.0, 0.0], INF, [INF, -INF], [0.0, -INF, INF]), at([0.0, 0.0], NAN, [INF, NAN], [0.0, -INF, NAN]),
    ]
    // Singular in x alone: y keeps its derivatives.
    sum_with_a_root: |x, y| x.sqrt() + y * y; [at([0.0, 2.0], 4.0, [INF, 4.0], [-INF, 0.0, 2.0])]
    product_with_a_root: |x, y| x.sqrt() * y; [
        at([0.0, 2.0], 0.0, [INF, 0.0], [-INF, INF, 0.0]), at([0.0, 0.0], 0.0, [NAN, 0.0], [NAN, INF, 0.0]),
    ]
    rejected_root: |x, y| if x > 0.0 { x.sqrt() } else { 0.0 }; [
        of_x(0.0, 0.0, 0.0, 0.0), of_x(-1.0, 0.0, 0.0, 0.0), of_x(4.0, 2.0, 0.25, -1.0 / 32.0),
    ]
    root_of_a_choice: |x, y| (if y > 0.0 { x * y } else { x }).sqrt(); [
        at([0.0, -1.0], 0.0, [INF, 0.0], [-INF, 0.0, 0.0]), at([4.0, -1.0], 2.0, [0.25, 0.0], [-1.0 / 32.0, 0.0, 0.0]),
    ]
}

/// A field has its derivatives from num-dual alone; they follow the same table.
mod fields {
    use dalembert::differentiable;

    /// √q₀ + q₁².
    #[differentiable]
    pub fn bowl(q: [f64; 2]) -> f64 {
        q[0].sqrt() + q[1] * q[1]
    }

    /// (√q₀, q₁²).
    #[differentiable]
    pub fn stretch(q: [f64; 2]) -> [f64; 2] {
        [q[0].sqrt(), q[1] * q[1]]
    }
}

#[test]
fn fields_keep_what_exists() {
    use dalembert::{ScalarField, VectorField};
    let q = SVector::from([0.0, 3.0]);
    let bowl = fields::Bowl;
    assert_eq!(bowl.gradient(&q), SVector::from([INF, 6.0]));
    assert_eq!(bowl.hessian(&q), SMatrix::from([[-INF, 0.0], [0.0, 2.0]]));
    assert_eq!(fields::Stretch.jacobian(&q), SMatrix::from([[INF, 0.0], [0.0, 6.0]]));
}

/// The control: a wrong expectation of any kind is found.
#[test]
fn wrong_expectations_are_found() {
    let system = sqrt::expanded::System;
    for wrong in [
        of_x(0.0, 1.0, INF, -INF),
        of_x(0.0, 0.0, 0.0, -INF),
        of_x(0.0, 0.0, -INF, -INF),
        of_x(0.0, 0.0, INF, INF),
        of_x(0.0, 0.0, INF, NAN),
        of_x(4.0, 2.0, 0.25 * (1.0 + 1e-14), -1.0 / 32.0),
        at([0.0, 0.7], 0.0, [INF, NAN], [-INF, 0.0, 0.0]),
    ] {
        assert!(check("written out", &system, &wrong).is_err());
    }
    assert!(agree(&system, &abs::num_dual::System, [0.0, 0.7]).is_err());
}

/// V = |q| + |q|^{3/2}: at q = 0 the slope has two sides and the curvature is infinite. A trapezoidal step
/// sees V″ at its ends alone where q1 moves them: the first node stays.
mod kink {
    macro_rules! kink {
        ($engine:ident) => {
            pub mod $engine {
                #[dalembert::rayleigh_system(rule = trapezoidal, derivatives = $engine)]
                pub fn kink(q: [f64; 2], v: [f64; 2], c: f64) -> (f64, f64) {
                    let kinetic = 0.5 * (v[0] * v[0] + v[1] * v[1]);
                    let potential = q[0].abs() + q[0].abs().powf(1.5) + 0.5 * (q[1] - q[0]) * (q[1] - q[0]);
                    (kinetic - potential, 0.5 * c * (v[0] * v[0] + v[1] * v[1]))
                }
            }
        };
    }
    kink!(expanded);
    kink!(num_dual);
}

#[test]
fn both_engines_take_trapezoidal_steps_from_singular_points() {
    use dalembert::{State, Trapezoidal};
    for (q, p) in [([0.0, 0.5], [0.3, -0.2]), ([0.0, 0.0], [-0.1, 0.0]), ([0.0, 0.0], [0.0, 1.0])] {
        let start = State { q: q.into(), p: p.into() };
        for h in [0.1, -0.02, 1e-3] {
            let a = kink::expanded::Kink { c: 0.3 }.by(Trapezoidal, h).step(&start);
            let b = kink::num_dual::Kink { c: 0.3 }.by(Trapezoidal, h).step(&start);
            let (a, b) = (a.unwrap().state, b.unwrap().state);
            assert!((a.q - b.q).amax() < 1e-15 && (a.p - b.p).amax() < 1e-15, "{start:?} {h}: {a:?} {b:?}");
            // p = (1 + hc/2) v̄ + (h/2) V′(q0).
            let pull = q[0] - q[1];
            let slope = SVector::from([1.0_f64.copysign(q[0]) + pull, -pull]);
            let v = (start.p - slope * (0.5 * h)) / (1.0 + 0.15 * h);
            assert!((a.q - start.q - v * h).amax() < 1e-15, "{start:?} {h}");
        }
    }
}
