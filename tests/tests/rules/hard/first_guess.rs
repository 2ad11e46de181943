//! The first step, without a guess: from any velocity and from rest, where Hessians at v = 0 are singular or
//! do not exist.

use dalembert::nalgebra::SVector;
use dalembert::{
    Discrete, Discretise, Gauss, Lagrangian, Midpoint, Rayleigh, State, StepError, Trapezoidal,
    rayleigh_system,
};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// Quadratic air drag, R = c|v|³/3, in one of four spellings, with gravity g on the last coordinate.
macro_rules! spelling {
    ($module:ident, |$v:ident| $cube:expr) => {
        mod $module {
            use dalembert::rayleigh_system;

            #[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
            pub fn shot(q: [f64; 2], v: [f64; 2], m: f64, g: f64, c: f64) -> (f64, f64) {
                let $v = v;
                let cube: f64 = $cube;
                (0.5 * m * (v[0] * v[0] + v[1] * v[1]) - m * g * q[1] - 0.0 * q[0], c * cube / 3.0)
            }
        }
    };
}

spelling!(root_cubed, |v| (v[0] * v[0] + v[1] * v[1]).sqrt().powi(3));
spelling!(power, |v| (v[0] * v[0] + v[1] * v[1]).powf(1.5));
spelling!(hypotenuse_cubed, |v| v[0].hypot(v[1]).powi(3));
spelling!(root_times, |v| (v[0] * v[0] + v[1] * v[1]) * (v[0] * v[0] + v[1] * v[1]).sqrt());

/// The speed along one line: m v + (h/2) c v² = p − (h/2) m g by the midpoint rule and the trapezoidal rule
/// alike.
fn along_a_line([m, g, c]: [f64; 3], p: f64, h: f64) -> f64 {
    let push = p - 0.5 * h * m * g;
    let (half, size) = (0.5 * m, push.abs());
    let root = size / (half + (half * half + 0.5 * h * c * size).sqrt());
    root.copysign(push)
}

fn drag_steps<S>(name: &str, system: &S, [m, g, c]: [f64; 3])
where
    S: Discrete<Midpoint, 2, Scalar = f64>
        + Discrete<Trapezoidal, 2>
        + dalembert::system::ForcedLagrangian<2, Scalar = f64>
        + Rayleigh<2>,
{
    let h = 0.1;
    for v in [[5.0, 3.0], [5.0, 0.0], [0.0, 3.0], [0.0, -1e-200], [1e-3, 1e9], [0.0, 0.0]] {
        let start = State { q: [0.3, 0.7].into(), p: SVector::from(v) * m };
        // Without gravity, a velocity whose square vanishes has no drag to evaluate: an error, and never
        // rest.
        if g == 0.0 && v[1] == -1e-200 {
            let step = system.by(Midpoint, h).step(&start);
            assert!(step.is_err() || step.is_ok_and(|step| step.velocity[1] < 0.0), "{name}");
            continue;
        }
        let midpoint = system.by(Midpoint, h).step(&start);
        let trapezoidal = system.by(Trapezoidal, h).step(&start);
        let steps =
            [midpoint, trapezoidal].map(|step| step.unwrap_or_else(|error| panic!("{name} {v:?}: {error}")));
        for step in steps {
            let u = step.velocity;
            let p = u * (m + 0.5 * h * c * u.norm()) + SVector::from([0.0, 0.5 * h * m * g]);
            let off = (p - start.p).amax();
            assert!(off <= 1e-14 * (start.p.amax() + 0.5 * h * m * g), "{name} {v:?}: {off:e} {step:?}");
            if v[0] == 0.0 {
                let exact = along_a_line([m, g, c], m * v[1], h);
                assert!(
                    (u[1] - exact).abs() <= 1e-14 * exact.abs() && u[0] == 0.0,
                    "{name} {v:?}: {u} {exact}"
                );
            }
        }
        // Squares that vanish leave stages no drag to evaluate, but at rest itself.
        if start.p.amax() > 1e-100 * m || v == [0.0, 0.0] {
            let step = system
                .by(Gauss::<2>, h)
                .step(&start)
                .unwrap_or_else(|error| panic!("{name}, Gauss, {v:?}: {error}"));
            let is_at_rest = step.state == start && step.velocity.amax() == 0.0;
            assert_eq!(is_at_rest, v == [0.0, 0.0] && g == 0.0, "{name} {v:?} {step:?}");
        }
    }
}

#[test]
fn air_drag_takes_its_first_step_however_it_is_written() {
    for parameters in [[1.3, 9.8, 0.2], [1e-60, 9.8, 1e-61], [1.3, 0.0, 0.2]] {
        let [m, g, c] = parameters;
        drag_steps("root cubed", &root_cubed::Shot { m, g, c }, parameters);
        drag_steps("power", &power::Shot { m, g, c }, parameters);
        drag_steps("hypotenuse", &hypotenuse_cubed::Shot { m, g, c }, parameters);
        drag_steps("root times", &root_times::Shot { m, g, c }, parameters);
    }
}

/// A homogeneous kinetic energy (Σ mᵢvᵢ²)^{a/2}/a, or Σ mᵢ|vᵢ|^a/a, with a drag of the same kind.
macro_rules! homogeneous {
    ($name:ident, $n:literal) => {
        #[derive(Clone, Copy, Debug)]
        struct $name {
            /// Whether each coordinate has a power of its own.
            apart: bool,
            a: f64,
            b: f64,
            m: [f64; $n],
            c: f64,
            g: f64,
        }

        #[rayleigh_system(rule = [midpoint, trapezoidal])]
        impl $name {
            fn lagrangian(&self, q: [f64; $n], v: [f64; $n]) -> f64 {
                let (mut square, mut apart, mut fall) = (0.0, 0.0, 0.0);
                for i in 0..$n {
                    square += self.m[i] * v[i] * v[i];
                    apart += self.m[i] * v[i].abs().powf(self.a) / self.a;
                    fall += self.g * q[i];
                }
                let together = square.powf(0.5 * self.a) / self.a;
                (if self.apart { apart } else { together }) - fall
            }

            fn rayleigh(&self, v: [f64; $n]) -> f64 {
                let (mut square, mut apart) = (0.0, 0.0);
                for i in 0..$n {
                    square += self.m[i] * v[i] * v[i];
                    apart += self.m[i] * v[i].abs().powf(self.b) / self.b;
                }
                let together = square.powf(0.5 * self.b) / self.b;
                self.c * if self.apart { apart } else { together }
            }
        }

        impl $name {
            /// v with ∂L/∂v + (h/2) ∂R/∂v = p, in closed form for h = 0 and by bisection of the size
            /// otherwise: both are monotone.
            fn velocity(&self, p: [f64; $n], h: f64) -> [f64; $n] {
                let size = |p: f64| {
                    // s^{a−1} + (h/2) c s^{b−1} = p
                    let (mut low, mut high) = (0.0_f64, p.powf(1.0 / (self.a - 1.0)));
                    for _ in 0..1100 {
                        let s = 0.5 * (low + high);
                        let value = s.powf(self.a - 1.0) + 0.5 * h * self.c * s.powf(self.b - 1.0);
                        if value > p { high = s } else { low = s }
                    }
                    high
                };
                if self.apart {
                    return std::array::from_fn(|i| size((p[i] / self.m[i]).abs()).copysign(p[i]));
                }
                // p = M v |v|_M^{a−2} …: its size in the metric of M⁻¹ is that of v in M to the power a − 1.
                let norm = (0..$n).map(|i| p[i] * p[i] / self.m[i]).sum::<f64>().sqrt();
                let speed = if norm > 0.0 { size(norm) } else { 0.0 };
                std::array::from_fn(|i| if norm > 0.0 { p[i] / self.m[i] * (speed / norm) } else { 0.0 })
            }

            fn check(random: &mut StdRng) -> u32 {
                let mut power = |low: f64, high: f64| 10.0_f64.powf(random.random_range(low..high));
                let mut system = Self {
                    apart: false,
                    a: 0.0,
                    b: 0.0,
                    m: std::array::from_fn(|_| power(-1.0, 1.0)),
                    c: power(-1.0, 1.0),
                    g: 0.0,
                };
                system.a = [2.0, 2.5, 3.0, 4.0][random.random_range(0..4)];
                system.b = [2.0, 2.5, 3.0, 4.0][random.random_range(0..4)];
                system.apart = random.random_bool(0.5);
                let moving = random.random_range(0..=$n);
                let p: [f64; $n] =
                    std::array::from_fn(|i| if i < moving { random.random_range(-3.0..3.0) } else { 0.0 });
                let (h, start) = (0.1, State { q: [0.0; $n].into(), p: p.into() });
                let context = format!("{system:?} {p:?}");
                let close = |found: &SVector<f64, $n>, h: f64| {
                    let expected = SVector::from(system.velocity(p, h));
                    // A root of order a − 1 has its digits.
                    let off = (found - expected).amax();
                    assert!(off <= 1e-12 * expected.amax(), "{context} {h}: {found} {expected}");
                };
                close(&start.velocity(&system).unwrap_or_else(|error| panic!("{context}: {error}")), 0.0);
                assert!(start.energy(&system).unwrap().is_finite());
                let step = system.by(Midpoint, h).step(&start);
                close(&step.unwrap_or_else(|error| panic!("midpoint {context}: {error}")).velocity, h);
                let step = system.by(Trapezoidal, h).step(&start);
                close(&step.unwrap_or_else(|error| panic!("trapezoidal {context}: {error}")).velocity, h);
                // Under a force it leaves rest, and p = ∂L/∂v + (h/2)(∂R/∂v + g).
                system.g = -0.7;
                let pushed = p.map(|p| p + 0.5 * h * 0.7);
                let step = system.by(Midpoint, h).step(&start);
                let found = step.unwrap_or_else(|error| panic!("pushed {context}: {error}")).velocity;
                let expected = SVector::from(system.velocity(pushed, h));
                assert!(
                    (found - expected).amax() <= 1e-12 * expected.amax(),
                    "{context}: {found} {expected}"
                );
                4
            }
        }
    };
}

homogeneous!(One, 1);
homogeneous!(Two, 2);
homogeneous!(Three, 3);
homogeneous!(Four, 4);

/// In 1 to 4 coordinates, with all, some or none of them moving.
#[test]
fn homogeneous_energies_and_drags_take_their_first_step() {
    let mut random = StdRng::seed_from_u64(5);
    let (all, mut checked) = (if cfg!(debug_assertions) { 150 } else { 500 }, 0);
    for _ in 0..all {
        checked += One::check(&mut random)
            + Two::check(&mut random)
            + Three::check(&mut random)
            + Four::check(&mut random);
    }
    assert_eq!(checked, 16 * all);
}

/// L = ¼|v|⁴ has no Hessian to solve with at rest, and is regular everywhere else.
#[rayleigh_system(rule = [midpoint, trapezoidal])]
fn quartic(q: [f64; 2], v: [f64; 2]) -> f64 {
    let square = v[0] * v[0] + v[1] * v[1];
    0.25 * square * square - 0.0 * q[0]
}

#[test]
fn a_quartic_energy_has_a_velocity_and_an_energy() {
    for v in [[5.0, 3.0], [5.0, 0.0], [0.0, 0.0], [1e-40, -1e-40]] {
        let v = SVector::from(v);
        let state = State::from_velocity(&Quartic, [0.1, 0.2], v).unwrap();
        let found = state.velocity(&Quartic).unwrap();
        assert!((found - v).amax() <= 1e-13 * v.amax(), "{v} {found}");
        let energy = 0.75 * v.norm_squared() * v.norm_squared();
        assert!((state.energy(&Quartic).unwrap() - energy).abs() <= 1e-12 * energy);
        let step = Quartic.by(Trapezoidal, 0.1).step(&state).unwrap();
        assert!((step.velocity - v).amax() <= 1e-13 * v.amax());
    }
}

/// The controls: what has no velocity and what is degenerate everywhere is refused by its name.
#[test]
fn what_has_no_first_step_has_a_name() {
    #[rayleigh_system]
    fn saturating(q: [f64; 1], v: [f64; 1]) -> f64 {
        (1.0 + v[0] * v[0]).sqrt() - 0.0 * q[0]
    }
    for p in [1.1, -2.0] {
        let state = State { q: [0.0].into(), p: [p].into() };
        let error = state.velocity(&Saturating).unwrap_err();
        let is_named = matches!(error, StepError::NoVelocity { .. } | StepError::DegenerateLagrangian { .. });
        assert!(is_named && !error.to_string().contains("smaller step"), "{error}");
        // No step size enters: neither a step nor one from a guess asks for a smaller one.
        for step in [Saturating.by(Midpoint, 0.1), Saturating.by(Midpoint, 0.1).near(&[0.5].into())] {
            assert_eq!(step.step(&state).unwrap_err(), error);
        }
    }
    #[rayleigh_system]
    fn aligned(q: [f64; 2], v: [f64; 2]) -> f64 {
        (v[0] + 2.0 * v[1]).powi(4) - 0.0 * q[0]
    }
    for p in [[0.0, 0.0], [1.0, 2.0]] {
        let state = State { q: [0.0, 0.0].into(), p: p.into() };
        let error = state.velocity(&Aligned).unwrap_err();
        assert!(matches!(error, StepError::DegenerateLagrangian { .. }), "{error}");
        assert_eq!(Aligned.by(Midpoint, 0.1).step(&state).unwrap_err(), error);
    }
    let _ = Aligned.lagrangian(&SVector::zeros(), &SVector::zeros());
}
