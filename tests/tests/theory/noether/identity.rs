//! J⁺ − J⁻ = ξ(L_d) + f_d(ξ) for every vector field, system and rule, symmetry or not.

use dalembert::nalgebra::{SMatrix, SVector, matrix, vector};
use dalembert::noether::Generator;
use dalembert::rules::SolvedForVelocity;
use dalembert::run::VelocityHistory;
use dalembert::samples::{self, SampleError};
use dalembert::step::{ClosedForm, DiscreteForce, Fused, Momenta, Segment, StepKernel};
use dalembert::system::{ActingForce, Derivatives};
use dalembert::{Discrete, Discretise, Lagrangian, Midpoint, Trapezoidal, VectorField, rayleigh_system};

/// Mass and friction depend on q; the force has no potential.
#[derive(Clone, Copy)]
struct Involved {
    k: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl Involved {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (1.0 + q[1] * q[1]) * v[0] * v[0] + v[1] * v[1] + 0.3 * q[0] * v[1] - (q[0] * q[1]).cos()
    }
    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * self.k * (1.0 + q[0].sin()) * (v[0] * v[0] + 0.5 * v[1].powi(4))
    }
    fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        [q[1] - 0.2 * v[1], 0.4 * v[0]]
    }
}

/// ξ(q) = (sin y, x²): no symmetry of anything.
struct Shear;

impl VectorField<2> for Shear {
    type Scalar = f64;
    fn vector(&self, q: &SVector<f64, 2>) -> SVector<f64, 2> {
        vector![q[1].sin(), q[0] * q[0]]
    }
    fn jacobian(&self, q: &SVector<f64, 2>) -> SMatrix<f64, 2, 2> {
        matrix![0.0, q[1].cos(); 2.0 * q[0], 0.0]
    }
}

fn generators() -> [Generator<f64, 2>; 3] {
    let shear = Generator::from_field("shear", Shear);
    let rotation = Generator::rotation(0, 1);
    [shear.clone(), rotation.clone() * 0.5 - shear, rotation]
}

fn identity_holds<R: Copy>(rule: R)
where
    Involved: Discrete<R, 2, Scalar = f64>,
{
    let system = Involved { k: 0.7 };
    let segments = samples::segments([-2.0; 2], [2.0; 2], [0.5; 2], 200);
    let noether = system.by(rule, 0.1).noether();
    for generator in generators() {
        let report = noether.symmetry(&generator, &segments).unwrap();
        assert!(report.is_consistent(), "{report}");
        assert!(!report.is_symmetry_of_lagrangian() && report.force_does_work(), "{report}");
        assert!(!report.is_conserved(), "{report}");
        // The worst place named is where the value is taken.
        let at = &report.defect.at;
        let defect = noether.defect(&generator, &at.q0, &at.q1).total();
        assert_eq!(defect, report.defect.value);
    }
}

#[test]
fn the_identity_holds_for_any_vector_field() {
    identity_holds(Midpoint);
    identity_holds(Trapezoidal);
}

/// The same system with a mistake of one part in a million in p1.
struct Mistaken(Involved);

impl Lagrangian<2> for Mistaken {
    type Scalar = f64;
    fn lagrangian(&self, q: &SVector<f64, 2>, v: &SVector<f64, 2>) -> f64 {
        Lagrangian::lagrangian(&self.0, q, v)
    }
    fn lagrangian_derivatives(&self, q: &SVector<f64, 2>, v: &SVector<f64, 2>) -> Derivatives<f64, 2> {
        self.0.lagrangian_derivatives(q, v)
    }
}

/// A rule of one's own, whose discrete objects are the system's.
#[derive(Clone, Copy)]
struct ByHand;

impl SolvedForVelocity for ByHand {}

impl ActingForce<2> for Mistaken {}

impl Fused<ByHand, 2> for Mistaken {
    type Matrix = SMatrix<f64, 2, 2>;
    type Memory = VelocityHistory<f64, 2>;
    type Border = dalembert::step::Free;
    fn step_kernel(&self, segment: &Segment<f64, 2>) -> StepKernel<f64, 2> {
        Fused::<Midpoint, 2>::step_kernel(&self.0, segment)
    }
    fn momenta(&self, segment: &Segment<f64, 2>) -> Momenta<f64, 2> {
        let momenta = Fused::<Midpoint, 2>::momenta(&self.0, segment);
        Momenta { p0: momenta.p0, p1: momenta.p1 * (1.0 + 1e-6) }
    }
}

impl ClosedForm<ByHand, 2> for Mistaken {
    fn discrete_lagrangian(&self, segment: &Segment<f64, 2>) -> f64 {
        ClosedForm::<Midpoint, 2>::discrete_lagrangian(&self.0, segment)
    }
    fn discrete_lagrangian_derivatives(&self, segment: &Segment<f64, 2>) -> Derivatives<f64, 2> {
        ClosedForm::<Midpoint, 2>::discrete_lagrangian_derivatives(&self.0, segment)
    }
    fn discrete_force(&self, segment: &Segment<f64, 2>) -> DiscreteForce<f64, 2> {
        ClosedForm::<Midpoint, 2>::discrete_force(&self.0, segment)
    }
    fn segment_energy(&self, segment: &Segment<f64, 2>) -> f64 {
        ClosedForm::<Midpoint, 2>::segment_energy(&self.0, segment)
    }
}

/// Positive control: momenta that are not those of L_d and f_d are reported.
#[test]
fn a_mistake_in_the_momenta_is_reported() {
    let system = Mistaken(Involved { k: 0.7 });
    let segments = samples::segments([-2.0; 2], [2.0; 2], [0.5; 2], 200);
    for generator in generators() {
        let report = system.by(ByHand, 0.1).noether().symmetry(&generator, &segments).unwrap();
        assert!(!report.is_consistent(), "{report}");
        assert!(report.to_string().contains("INCONSISTENT"), "{report}");
    }
}

#[test]
fn samples_that_decide_nothing_are_refused() {
    let system = Involved { k: 0.7 };
    let noether = system.by(Midpoint, 0.1).noether();
    let [shear, ..] = generators();
    assert_eq!(noether.symmetry(&shear, &[]).unwrap_err(), SampleError::TooFew { given: 0, needed: 1 });
    let mut segments = samples::segments([-2.0; 2], [2.0; 2], [0.5; 2], 5);
    segments[3].q1[0] = f64::NAN;
    assert_eq!(noether.symmetry(&shear, &segments).unwrap_err(), SampleError::NonFinite { index: 3 });
}

/// The same in single precision.
#[derive(Clone, Copy)]
struct Single {
    k: f32,
}

#[rayleigh_system]
impl Single {
    fn lagrangian(&self, q: [f32; 2], v: [f32; 2]) -> f32 {
        let s = q[0] * q[0] + q[1] * q[1];
        0.5 * (v[0] * v[0] + v[1] * v[1]) - s * s
    }
    fn rayleigh(&self, v: [f32; 2]) -> f32 {
        0.5 * self.k * (v[0] * v[0] + v[1] * v[1])
    }
}

/// Tolerances follow the scalar type: f32 rounding is no loss of a symmetry, and drag is still seen.
#[test]
fn single_precision_is_judged_by_its_own_rounding() {
    let segments = samples::segments([-1.0_f32; 2], [1.0; 2], [0.1; 2], 100);
    let verdict = |k| {
        let system = Single { k };
        system.by(Midpoint, 0.1).noether().symmetry(&Generator::rotation(0, 1), &segments).unwrap()
    };
    let free = verdict(0.0);
    assert!(free.is_conserved() && free.is_consistent() && free.defect.value.abs() > 1e-10, "{free}");
    assert!(!verdict(0.1).is_conserved());
}
