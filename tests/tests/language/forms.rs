//! Forms of a system: with and without R, both argument lists of R, a general force, both rules, f32, one
//! free function.

use dalembert::nalgebra::{SVector, vector};
use dalembert::step::{Fused, Segment};
use dalembert::{Discretise, Force, Lagrangian, Midpoint, Rayleigh, Trapezoidal, rayleigh_system};

/// Closed forms below are evaluated in another order: a few units in the last place.
const ROUNDING: f64 = 1e-14;

fn assert_close<const N: usize>(expected: &SVector<f64, N>, actual: &SVector<f64, N>) {
    let error = (expected - actual).amax();
    assert!(error <= ROUNDING * (1.0 + expected.amax()), "{expected} {actual}");
}

struct Conservative {
    m: f64,
}

#[rayleigh_system]
impl Conservative {
    fn lagrangian(&self, _q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * self.m * v[0] * v[0]
    }
}

struct Everything {
    c: [f64; 2],
    drive: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl Everything {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + (1.0 + q[0] * q[0]) * v[1] * v[1]) - q[1].cos()
    }
    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (self.c[0] * v[0] * v[0] + self.c[1] * q[0] * q[0] * v[1] * v[1])
    }
    fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        [self.drive * q[1].sin(), v[0] * v[1]]
    }
}

struct OnlyForce;

#[rayleigh_system(rule = trapezoidal)]
impl OnlyForce {
    fn lagrangian(&self, _: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0]
    }
    fn force(&self, q: [f64; 1], _: [f64; 1]) -> [f64; 1] {
        [-q[0].powi(3)]
    }
}

struct Isotropic {
    k: f64,
}

#[rayleigh_system]
impl Isotropic {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.5 * (q[0] * q[0] + q[1] * q[1])
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.k * (v[0] * v[0] + v[1] * v[1])
    }
}

#[test]
fn a_system_without_force_has_none() {
    let system = Conservative { m: 2.0 };
    let f = system.by(Midpoint, 0.1).discrete_force(&vector![0.3], &vector![0.7]);
    assert_eq!((f.minus, f.plus), (vector![0.0], vector![0.0]));
    let p = system.by(Midpoint, 0.1).legendre_minus(&vector![0.3], &vector![0.7]).p;
    assert_close(&vector![2.0 * 4.0], &p);
}

#[test]
fn rayleigh_and_general_force_add_up_by_both_rules() {
    let system = Everything { c: [0.3, 0.7], drive: 1.9 };
    let (q0, q1, h) = (vector![0.3, -0.4], vector![0.5, 0.1], 0.1);
    let v = (q1 - q0) / h;
    // −D2 𝓡 and f_L by hand.
    let minus_d2 = |q: SVector<f64, 2>| vector![-0.3 * v[0], -0.7 * q[0] * q[0] * v[1]];
    let d1 = |q: SVector<f64, 2>| vector![0.7 * q[0] * v[1] * v[1], 0.0];
    let general = |q: SVector<f64, 2>| vector![1.9 * q[1].sin(), v[0] * v[1]];
    let middle = (q0 + q1) / 2.0;

    // R_d = (h²/2) 𝓡(q̄, v̄): f_d⁻ = D1 R_d = −(h/2) D2𝓡 + (h²/4) D1𝓡, f_d⁺ = −D2 R_d = −(h/2) D2𝓡 − (h²/4)
    // D1𝓡.
    let f = system.by(Midpoint, h).discrete_force(&q0, &q1);
    let half = (minus_d2(middle) + general(middle)) * (h / 2.0);
    assert_close(&(half + d1(middle) * (h * h / 4.0)), &f.minus);
    assert_close(&(half - d1(middle) * (h * h / 4.0)), &f.plus);

    // R_d = (h²/4) [𝓡(q0, v̄) + 𝓡(q1, v̄)]: varying q0 moves the first node and v̄, varying q1 the second and
    // v̄.
    let f = system.by(Trapezoidal, h).discrete_force(&q0, &q1);
    let shared = (minus_d2(q0) + minus_d2(q1)) * (h / 4.0);
    assert_close(&(shared + d1(q0) * (h * h / 4.0) + general(q0) * (h / 2.0)), &f.minus);
    assert_close(&(shared - d1(q1) * (h * h / 4.0) + general(q1) * (h / 2.0)), &f.plus);
}

#[test]
fn a_force_alone_needs_no_rayleigh_function() {
    let f = OnlyForce.by(Trapezoidal, 0.1).discrete_force(&vector![0.5], &vector![2.0]);
    assert_close(&vector![-0.05 * 0.125], &f.minus);
    assert_close(&vector![-0.05 * 8.0], &f.plus);
    assert_eq!(OnlyForce.force([2.0], [0.0]), [-8.0]);
    let derivatives = OnlyForce.force_derivatives(&vector![2.0], &vector![1.0]);
    assert_close(&vector![-12.0], &derivatives.d1);
    assert_close(&vector![0.0], &derivatives.d2);
}

#[test]
fn r_of_v_alone_does_not_depend_on_q() {
    let system = Isotropic { k: 0.3 };
    let r = system.rayleigh_derivatives(&vector![0.3, 9.0], &vector![2.0, -1.0]);
    assert_close(&vector![0.0, 0.0], &r.d1);
    assert_close(&vector![0.6, -0.3], &r.d2);
    assert_eq!(r.d12.amax(), 0.0);
    assert_eq!(system.rayleigh([2.0, -1.0]), 0.75);
    let by = system.by(Midpoint, 0.1);
    let discrete = by.discrete_force(&vector![0.0, 0.0], &vector![0.2, -0.1]).minus;
    assert_close(&(vector![-0.6, 0.3] * 0.05), &discrete);
    let r_d = by.discrete_rayleigh(&vector![0.0, 0.0], &vector![0.2, -0.1]);
    assert_close(&vector![0.005 * 0.75], &vector![r_d]);
}

mod free {
    //! One free function, seen from outside its module.
    use super::rayleigh_system;

    /// L and R of a damped oscillator.
    #[rayleigh_system]
    pub fn damped_oscillator(q: [f64; 1], v: [f64; 1], m: f64, k: f64, r: f64) -> (f64, f64) {
        (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
    }

    #[rayleigh_system(rule = trapezoidal)]
    pub(super) fn chain(
        q: [f64; 3],
        v: [f64; 3],
        masses: [f64; 3],
        power: i32,
        closed: bool,
        pairs: [[usize; 2]; 2],
    ) -> f64 {
        let mut l = 0.0;
        for i in 0..3 {
            l += 0.5 * masses[i] * v[i] * v[i];
        }
        for [i, j] in pairs {
            l -= (q[i] - q[j]).powi(power);
        }
        if closed {
            l -= (q[2] - q[0]).powi(power);
        }
        l
    }

    #[rayleigh_system]
    pub fn pendulum(q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] + q[0].cos()
    }

    #[rayleigh_system]
    fn private(_: [f64; 1], mut v: [f64; 1], mut m: f64) -> f64 {
        m *= 2.0;
        v[0] *= v[0];
        m * v[0]
    }

    pub fn private_mass() -> f64 {
        use dalembert::{Lagrangian, nalgebra::vector};
        Private { m: 3.0 }.lagrangian_derivatives(&vector![0.0], &vector![1.0]).d22[0]
    }
}

#[test]
fn a_free_function_makes_a_struct_of_its_parameters() {
    let system = free::DampedOscillator { m: 2.0, k: 3.0, r: 0.5 };
    let copy = system;
    assert_eq!(system, copy);
    assert_eq!(format!("{system:?}"), "DampedOscillator { m: 2.0, k: 3.0, r: 0.5 }");
    let (q, v) = (vector![0.3], vector![-1.7]);
    let both = free::damped_oscillator([0.3], [-1.7], 2.0, 3.0, 0.5);
    assert_eq!((system.lagrangian(&q, &v), system.rayleigh(&q, &v)), both);
    let l = system.lagrangian_derivatives(&q, &v);
    assert_close(&vector![-0.9, -3.4, -3.0, 2.0], &vector![l.d1[0], l.d2[0], l.d11[0], l.d22[0]]);
    assert_close(&vector![0.5], &vector![system.rayleigh_derivatives(&q, &v).d22[0]]);
    assert_eq!(free::private_mass(), 12.0);
}

#[test]
fn parameters_may_be_arrays_integers_and_bools() {
    let system = free::Chain { masses: [1.0, 2.0, 3.0], power: 4, closed: true, pairs: [[0, 1], [1, 2]] };
    let (q, v) = ([0.1, 0.4, -0.3], [1.0, 2.0, 3.0]);
    let value = free::chain(q, v, system.masses, system.power, system.closed, system.pairs);
    assert_eq!(value, system.lagrangian(&q.into(), &v.into()));
    let l = system.lagrangian_gradient(&q.into(), &v.into());
    let cube = |x: f64| 4.0 * x.powi(3);
    assert_close(&vector![-cube(-0.3) + cube(-0.4), cube(-0.3) - cube(0.7), cube(0.7) - cube(-0.4)], &l.d1);
    assert_close(&vector![1.0, 4.0, 9.0], &l.d2);
    assert!(system.by(Trapezoidal, 0.1).discrete_lagrangian(&q.into(), &v.into()).is_finite());
}

#[test]
fn a_function_without_parameters_makes_a_unit_struct() {
    let l = free::Pendulum.lagrangian_gradient(&vector![0.3], &vector![2.0]);
    assert_close(&vector![-0.3_f64.sin(), 2.0], &vector![l.d1[0], l.d2[0]]);
    assert_eq!(free::pendulum([0.3], [2.0]), l.value);
}

struct Single {
    m: f32,
    n: i32,
    powers: [f32; 2],
}

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl Single {
    const G: f32 = 9.81;
    fn lagrangian(&self, q: [f32; 1], v: [f32; 1]) -> f32 {
        let half = 0.5;
        half * self.m * v[0].powi(2) - Self::G * q[0].sin() * self.n as f32
            + 2.0 * f32::cos(q[0]) * std::f32::consts::PI
            + self.powers.iter().map(|p| p * q[0]).sum::<f32>()
    }
    fn rayleigh(&self, v: [f32; 1]) -> f32 {
        self.square(&v, 1) * 0.1
    }
    fn square(&self, v: &[f32; 1], _n: u8) -> f32 {
        v[0] * v[0]
    }
    fn force(&self, q: [f32; 1], _v: [f32; 1]) -> [f32; 1] {
        q.map(f32::sin)
    }
}

#[rayleigh_system]
fn single_oscillator(q: [f32; 1], v: [f32; 1], k: f32) -> (f32, f32) {
    (0.5 * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.25 * v[0] * v[0])
}

#[test]
fn f32_systems_stay_in_f32() {
    let system = Single { m: 2.0, n: 3, powers: [0.5, 0.25] };
    let (q, v) = (0.3_f32, 1.25_f32);
    let by_hand = 0.5 * 2.0 * v.powi(2) - 9.81 * q.sin() * 3.0
        + 2.0 * q.cos() * std::f32::consts::PI
        + [0.5, 0.25].iter().map(|p| p * q).sum::<f32>();
    assert_eq!(system.lagrangian([q], [v]).to_bits(), by_hand.to_bits());
    let l = system.lagrangian_derivatives(&vector![q], &vector![v]);
    // The closed form in f64, rounded once; sums of terms of order 30 in f32.
    let (q, v) = (f64::from(q), f64::from(v));
    let d1 = -f64::from(9.81_f32) * q.cos() * 3.0 - std::f64::consts::TAU * q.sin() + 0.75;
    let d11 = f64::from(9.81_f32) * q.sin() * 3.0 - std::f64::consts::TAU * q.cos();
    for (expected, actual) in
        [(d1, l.d1[0]), (2.0 * v, l.d2[0]), (d11, l.d11[0]), (2.0, l.d22[0]), (0.0, l.d12[0])]
    {
        assert!(
            (expected - f64::from(actual)).abs() < 4.0 * f64::from(f32::EPSILON) * 30.0,
            "{expected} {actual}"
        );
    }
    let step = Fused::<Midpoint, 1>::step_kernel(
        &SingleOscillator { k: 4.0 },
        &Segment { q0: vector![1.0], v: vector![2.0], h: 0.5 },
    );
    // p0 = v̄ + (h/2)(k q̄ + r v̄), ∂p0/∂v̄ = 1 + (h/2)(k h/2 + r): q̄ = 1.5, r = ½.
    assert_eq!((step.p0[0], step.matrix[0]), (2.0 + 0.25 * (6.0 + 1.0), 1.0 + 0.25 * (1.0 + 0.5)));
}
