//! Rules whose interior points are eliminated by forced equations: what L and the force do to a momentum map
//! is seen at the stages.

use dalembert::nalgebra::{SMatrix, SVector, matrix, vector};
use dalembert::noether::{Generator, Symmetry};
use dalembert::samples::{self, Pair};
use dalembert::step::Defect;
use dalembert::{Discretise, Gauss, State, VectorField, rayleigh_system};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// A central potential, and a force radial + turning about the origin.
#[rayleigh_system(rule = gauss)]
impl Central {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let s = q[0] * q[0] + q[1] * q[1];
        0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.5 * s - 0.25 * s * s - self.uneven * q[0] * q[0] * q[0]
    }
    fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        let radial = 0.3 * q[0] + 0.2 * v[1];
        [radial * q[0] - self.turning * q[1], radial * q[1] + self.turning * q[0]]
    }
}

struct Central {
    uneven: f64,
    turning: f64,
}

fn segments() -> Vec<Pair<f64, 2>> {
    samples::segments([-1.0, -1.0], [1.0, 1.0], [0.15, 0.15], 20)
}

fn report<const S: usize>(system: &Central) -> Symmetry<2> {
    system.by(Gauss::<S>, 0.1).noether().symmetry(&Generator::rotation(0, 1), &segments()).unwrap()
}

#[test]
fn a_radial_force_does_no_work_along_a_rotation() {
    let radial = Central { uneven: 0.0, turning: 0.0 };
    let controls = [Central { turning: 1e-6, ..radial }, Central { uneven: 1e-6, ..radial }];
    for report in [report::<2>, report::<3>, report::<4>] {
        let kept = report(&radial);
        assert!(kept.is_symmetry_of_lagrangian() && !kept.force_does_work() && kept.is_conserved(), "{kept}");
        assert!(kept.is_consistent() && kept.interior.vanishes(), "{kept}");
        // The controls: each cause is found where it is, and there alone.
        let [turned, uneven] = controls.each_ref().map(report);
        assert!(
            turned.is_symmetry_of_lagrangian() && turned.force_does_work() && !turned.is_conserved(),
            "{turned}"
        );
        assert!(
            !uneven.is_symmetry_of_lagrangian() && !uneven.force_does_work() && !uneven.is_conserved(),
            "{uneven}"
        );
    }
    assert!(report::<3>(&radial).to_string().contains("h Σ bf·ξ"));
}

#[test]
fn along_a_run_the_causes_add_up() {
    let rotation = Generator::rotation(0, 1);
    let balance = |system: &Central| {
        let start = State::from_velocity(system, [0.8, 0.0], [0.1, 0.7]).unwrap();
        let by = system.by(Gauss::<3>, 0.1);
        by.noether().balance(&rotation, &start, by.run(start).take(40)).unwrap()
    };
    let radial = Central { uneven: 0.0, turning: 0.0 };
    let kept = balance(&radial);
    assert!(kept.is_balanced() && (kept.end - kept.start).abs() < 1e-13, "{kept}");
    assert!(kept.accumulated.lagrangian.abs() < 1e-14 && kept.accumulated.force.abs() < 1e-14, "{kept}");
    let lost = balance(&Central { turning: 0.1, ..radial });
    assert!(lost.is_balanced() && (lost.accumulated.force - (lost.end - lost.start)).abs() < 1e-12, "{lost}");
    assert!(lost.accumulated.force > 0.1 && lost.accumulated.lagrangian.abs() < 1e-14, "{lost}");
}

/// A pair of masses with every kind of term, one generator of no symmetry: J₁ − J₀ is what the stages say.
#[rayleigh_system(rule = gauss)]
impl Mixed {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (1.0 + self.a * q[1] * q[1]) * v[0] * v[0] + 0.5 * v[1] * v[1] + self.b * q[0] * v[1]
            - (q[0] - 0.5 * q[1]).powi(4)
    }
    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * self.c * (1.0 + q[0] * q[0]) * (v[0] - v[1]) * (v[0] - v[1])
    }
    fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        [self.d * q[1] * v[1], -self.d * q[0] - 0.1 * v[0] * v[0] * v[0]]
    }
}

struct Mixed {
    a: f64,
    b: f64,
    c: f64,
    d: f64,
}

#[test]
fn affine_generators_of_random_systems_leave_nothing_to_the_interior() {
    let mut random = StdRng::seed_from_u64(12);
    for _ in 0..30 {
        let mut any = || random.random_range(-0.6..0.6);
        let system = Mixed { a: any(), b: any(), c: any() + 0.7, d: any() };
        let xi = Generator::affine("any", matrix![any(), any(); any(), any()], vector![any(), any()]);
        let segment = [Pair { q0: vector![any(), any()], q1: vector![any(), any()] }];
        let segment = [Pair { q1: segment[0].q0 + segment[0].q1 * 0.3, ..segment[0] }];
        macro_rules! adds_up {
            ($($stages:literal),+) => {$(
                let found = system.by(Gauss::<$stages>, 0.2).noether().symmetry(&xi, &segment).unwrap();
                assert!(found.interior.vanishes() && found.is_consistent(), "{found}");
                assert!(!found.is_symmetry_of_lagrangian() && found.force_does_work(), "{found}");
                // At the momenta of the step itself.
                let start = State { q: segment[0].q0, p: vector![0.3, -0.2] };
                let end = system.by(Gauss::<$stages>, 0.2).step(&start).unwrap().state;
                let noether = system.by(Gauss::<$stages>, 0.2).noether();
                let Defect { lagrangian, force, .. } = noether.defect(&xi, &start.q, &end.q);
                let change = end.p.dot(&xi.vector(&end.q)) - start.p.dot(&xi.vector(&start.q));
                assert!((change - lagrangian - force).abs() < 1e-13, "{change:e} {lagrangian:e} {force:e}");
            )+};
        }
        adds_up!(1, 2, 3, 5);
    }
}

/// Geodesics of the half plane, and the field (x² − y², 2xy) along which it is carried into itself.
#[rayleigh_system(rule = gauss)]
fn half_plane(q: [f64; 2], v: [f64; 2]) -> f64 {
    0.5 * (v[0] * v[0] + v[1] * v[1]) / (q[1] * q[1])
}

struct Killing;

impl VectorField<2> for Killing {
    type Scalar = f64;
    fn vector(&self, q: &SVector<f64, 2>) -> SVector<f64, 2> {
        vector![q[0] * q[0] - q[1] * q[1], 2.0 * q[0] * q[1]]
    }
    fn jacobian(&self, q: &SVector<f64, 2>) -> SMatrix<f64, 2, 2> {
        matrix![2.0 * q[0], -2.0 * q[1]; 2.0 * q[1], 2.0 * q[0]]
    }
}

#[test]
fn what_a_field_that_is_not_affine_loses_the_rule_has_done() {
    let xi = Generator::from_field("special", Killing);
    let start = State::from_velocity(&HalfPlane {}, [0.2, 1.0], [0.5, 0.3]).unwrap();
    let interior = |h: f64| {
        let by = HalfPlane {}.by(Gauss::<2>, h);
        let end = by.step(&start).unwrap().state;
        let found = by.noether().symmetry(&xi, &[Pair { q0: start.q, q1: end.q }]).unwrap();
        assert!(
            found.is_symmetry_of_lagrangian() && !found.is_conserved() && !found.interior.vanishes(),
            "{found}"
        );
        assert!((found.interior.value - found.defect.value).abs() < 1e-14, "{found}");
        found.interior.value.abs()
    };
    let order = (interior(0.4) / interior(0.2)).log2();
    assert!((order - 5.0).abs() < 0.3, "{order}");
    // Scaling is affine.
    let scaling = Generator::affine("scaling", matrix![1.0, 0.0; 0.0, 1.0], vector![0.0, 0.0]);
    let kept = HalfPlane {}.by(Gauss::<2>, 0.4).noether();
    let kept = kept.symmetry(&scaling, &[Pair { q0: start.q, q1: vector![0.4, 1.1] }]).unwrap();
    assert!(kept.is_conserved() && kept.interior.vanishes(), "{kept}");
}

/// The largest subspaces: of rotation and both translations, in a central potential with drag towards the
/// origin alone, the rotation is kept, by every rule; the force is carried into itself along it.
#[test]
fn subalgebras_are_decided_at_the_stages() {
    let radial = Central { uneven: 0.0, turning: 0.0 };
    let generators = [
        Generator::translation("x", [1.0, 0.0]),
        Generator::rotation(0, 1),
        Generator::translation("y", [0.0, 1.0]),
    ];
    let found = radial.by(Gauss::<2>, 0.1).noether().subalgebra(&generators, &segments()).unwrap();
    assert_eq!(found.lagrangian.basis, [vec![0.0, 1.0, 0.0]], "{found}");
    assert_eq!(found.conserved.basis, [vec![0.0, 1.0, 0.0]], "{found}");
    // f·ξ = 0, and yet 0.2 v_y is not carried into itself by a rotation.
    assert_eq!(found.invariant.dimension(), 0, "{found}");
}
