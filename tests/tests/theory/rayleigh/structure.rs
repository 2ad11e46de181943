//! For n > 1 a discrete force is Rayleigh iff three conditions hold; the one that the paper prints, D1 f⁺ =
//! −D2 f⁻ (section 3.4), is fulfilled by forces without any potential.

use dalembert::nalgebra::{SMatrix, SVector, vector};
use dalembert::rayleigh::{Potential, structure};
use dalembert::rules::SolvedForVelocity;
use dalembert::run::VelocityHistory;
use dalembert::samples::{self, Pair};
use dalembert::step::{
    ClosedForm, DiscreteForce, DiscreteForceDerivatives, Fused, Momenta, Segment, StepKernel,
};
use dalembert::system::{ActingForce, CovectorDerivatives, Derivatives};
use dalembert::{Lagrangian, Midpoint, Trapezoidal, rayleigh_system};

/// Linear drag with any matrix, f = −C v.
#[derive(Clone, Copy)]
struct LinearDrag {
    c: [[f64; 2]; 2],
}

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl LinearDrag {
    fn lagrangian(&self, _q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1])
    }
    fn force(&self, _q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        [-self.c[0][0] * v[0] - self.c[0][1] * v[1], -self.c[1][0] * v[0] - self.c[1][1] * v[1]]
    }
}

fn plane() -> Vec<Pair<f64, 2>> {
    samples::segments([-1.0; 2], [1.0; 2], [0.3; 2], 50)
}

#[test]
fn linear_drag_is_rayleigh_iff_its_matrix_is_symmetric() {
    for (c, expected) in [
        ([[1.0, 0.3], [0.3, 2.0]], true),
        ([[1.0, 0.3], [0.3 + 1e-9, 2.0]], false),
        ([[1.0, 0.3], [-0.3, 2.0]], false),
    ] {
        let drag = LinearDrag { c };
        let midpoint = structure(&drag, Midpoint, 0.1, &plane()).unwrap();
        let trapezoidal = structure(&drag, Trapezoidal, 0.1, &plane()).unwrap();
        assert_eq!(midpoint.is_rayleigh(), expected, "{midpoint}");
        assert_eq!(trapezoidal.is_rayleigh(), expected, "{trapezoidal}");
        assert_eq!(midpoint.allows_resplit(), expected, "{midpoint}");
    }
}

/// The printed condition holds for every C, while the circulation of the would-be dR_d is that of a rotation:
/// ∮ f⁻·dq0 = ½(C₂₁ − C₁₂) × area, at fixed q1.
#[test]
fn the_printed_condition_lets_a_force_without_potential_pass() {
    let (c12, c21) = (0.3, -0.3);
    let drag = LinearDrag { c: [[1.0, c12], [c21, 2.0]] };
    for segment in plane() {
        let f = ClosedForm::<Midpoint, 2>::discrete_force_derivatives(
            &drag,
            &Segment::between(&segment.q0, &segment.q1, 0.1),
        );
        assert!((f.plus.d1 + f.minus.d2).amax() < 1e-15, "the printed condition");
        assert!((f.minus.d1 - f.minus.d1.transpose()).amax() > 0.2, "the missing condition");
    }
    // Straight to (q0, q1) = (e1 + e2, 0) and along the edges by way of e1: a triangle of area ½.
    let origin = SVector::zeros();
    let potential = Potential::new(&drag, Midpoint, 0.1, Pair::new(origin, origin));
    let recovery = potential.check(&[Pair::new(vector![1.0, 1.0], origin)]).unwrap();
    let expected = -0.5 * (c21 - c12) * 0.5;
    assert!((recovery.path_dependence.value - expected).abs() < 1e-15, "{recovery}");
    assert!(!recovery.exists() && !recovery.path_dependence.vanishes(), "{recovery}");
}

/// Friction that grows with q: as a midpoint force it has no potential, as a Rayleigh function it has one by
/// construction.
#[derive(Clone, Copy)]
struct Rough {
    as_force: bool,
}

#[rayleigh_system]
impl Rough {
    fn lagrangian(&self, _q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0]
    }
    fn rayleigh(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        if self.as_force { 0.0 } else { 0.5 * (1.0 + q[0] * q[0]) * v[0] * v[0] }
    }
    fn force(&self, q: [f64; 1], v: [f64; 1]) -> [f64; 1] {
        if self.as_force { [-(1.0 + q[0] * q[0]) * v[0]] } else { [0.0] }
    }
}

#[test]
fn a_midpoint_force_that_depends_on_q_is_not_rayleigh() {
    let segments = samples::segments([-1.0], [1.0], [0.3], 50);
    let as_force = structure(&Rough { as_force: true }, Midpoint, 0.1, &segments).unwrap();
    assert!(!as_force.is_rayleigh() && as_force.allows_resplit(), "{as_force}");
    let as_function = structure(&Rough { as_force: false }, Midpoint, 0.1, &segments).unwrap();
    assert!(as_function.is_rayleigh(), "{as_function}");
}

/// A force at q0 alone, f⁻ = g(q0), f⁺ = 0: both mixed blocks vanish.
struct AtStart<G>(G);

trait Covector {
    fn at(&self, q: &SVector<f64, 2>) -> CovectorDerivatives<f64, 2>;
}

impl<G> Lagrangian<2> for AtStart<G> {
    type Scalar = f64;
    fn lagrangian(&self, _q: &SVector<f64, 2>, v: &SVector<f64, 2>) -> f64 {
        0.5 * v.norm_squared()
    }
    fn lagrangian_derivatives(&self, _q: &SVector<f64, 2>, v: &SVector<f64, 2>) -> Derivatives<f64, 2> {
        let identity = SMatrix::identity();
        Derivatives { value: 0.5 * v.norm_squared(), d2: *v, d22: identity, ..Derivatives::zero() }
    }
}

/// A rule of one's own, whose discrete objects are the system's.
#[derive(Clone, Copy)]
struct ByHand;

impl SolvedForVelocity for ByHand {}

impl<G> ActingForce<2> for AtStart<G> {}

impl<G: Covector> Fused<ByHand, 2> for AtStart<G> {
    type Matrix = SMatrix<f64, 2, 2>;
    type Memory = VelocityHistory<f64, 2>;
    type Border = dalembert::step::Free;
    fn step_kernel(&self, segment: &Segment<f64, 2>) -> StepKernel<f64, 2> {
        StepKernel { p0: segment.v - self.0.at(&segment.q0).value, matrix: SMatrix::identity() }
    }
    fn momenta(&self, segment: &Segment<f64, 2>) -> Momenta<f64, 2> {
        Momenta { p0: segment.v - self.0.at(&segment.q0).value, p1: segment.v }
    }
}

impl<G: Covector> ClosedForm<ByHand, 2> for AtStart<G> {
    fn discrete_lagrangian(&self, segment: &Segment<f64, 2>) -> f64 {
        segment.v.norm_squared() * (segment.h / 2.0)
    }
    fn discrete_lagrangian_derivatives(&self, segment: &Segment<f64, 2>) -> Derivatives<f64, 2> {
        let (v, m) = (segment.v, SMatrix::identity() / segment.h);
        let value = ClosedForm::<ByHand, 2>::discrete_lagrangian(self, segment);
        Derivatives { value, d1: -v, d2: v, d11: m, d12: -m, d22: m }
    }
    fn segment_energy(&self, segment: &Segment<f64, 2>) -> f64 {
        ClosedForm::<ByHand, 2>::discrete_lagrangian(self, segment) / segment.h
    }
    fn discrete_force(&self, segment: &Segment<f64, 2>) -> DiscreteForce<f64, 2> {
        DiscreteForce { minus: self.0.at(&segment.q0).value, plus: SVector::zeros() }
    }
    fn discrete_force_derivatives(&self, segment: &Segment<f64, 2>) -> DiscreteForceDerivatives<f64, 2> {
        DiscreteForceDerivatives { minus: self.0.at(&segment.q0), plus: CovectorDerivatives::zero() }
    }
}

/// (−y, 0): no gradient.
struct Turning;

impl Covector for Turning {
    fn at(&self, q: &SVector<f64, 2>) -> CovectorDerivatives<f64, 2> {
        let mut g = CovectorDerivatives::zero();
        g.value[0] = -q[1];
        g.d1[(0, 1)] = -1.0;
        g
    }
}

/// d(angle) = (−y, x)/r²: the conditions hold everywhere but at the origin, and yet it has no potential
/// around it.
struct Vortex;

impl Covector for Vortex {
    fn at(&self, q: &SVector<f64, 2>) -> CovectorDerivatives<f64, 2> {
        let (x, y, s) = (q[0], q[1], q.norm_squared());
        let mut g = CovectorDerivatives::zero();
        g.value = vector![-y / s, x / s];
        g.d1 = dalembert::nalgebra::matrix![
            2.0 * x * y / (s * s), (y * y - x * x) / (s * s);
            (y * y - x * x) / (s * s), -2.0 * x * y / (s * s)
        ];
        g
    }
}

/// A hand-written system; the mixed condition holds, also with the transpose, and the missing one fails.
#[test]
fn the_mixed_condition_alone_is_not_enough() {
    let report = structure(&AtStart(Turning), ByHand, 0.1, &plane()).unwrap();
    assert!(report.mixed.holds() && report.plus.holds() && !report.minus.holds(), "{report}");
    assert_eq!(report.minus.worst.value.abs(), 1.0);
}

/// The conditions are local: around a hole they hold without a potential, and the two paths show it.
#[test]
fn around_a_hole_the_paths_tell() {
    let start = Pair::new(vector![1.0, 0.1], vector![0.0, 0.0]);
    let potential = Potential::new(&AtStart(Vortex), ByHand, 0.1, start);
    // Straight across above the origin, or along the edges by way of (−1, 0.1), (−1, −0.3): the same
    // half-plane x < 0.
    let same_side = [Pair::new(vector![-1.0, 0.4], vector![0.2, 0.2])];
    let recovery = potential.check(&same_side).unwrap();
    assert!(recovery.exists(), "{recovery}");
    // The straight line passes below the origin, the edges above and around it.
    let around = [Pair::new(vector![-1.0, -0.3], vector![0.2, 0.2])];
    let recovery = potential.check(&around).unwrap();
    assert!(recovery.structure.is_rayleigh() && !recovery.exists(), "{recovery}");
    let winding = recovery.path_dependence.value.abs() / std::f64::consts::TAU;
    assert!((winding - 1.0).abs() < 1e-12, "{recovery}");
}
