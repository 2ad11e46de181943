//! (L_d + φ, R_d + χ) is equivalent to (L_d, R_d) for χ = ψ(q0) + φ1(q1) − φ0(q0) + ψ(q1); with the printed
//! −φ1(q1) (section 3.3) the equations differ.

use dalembert::nalgebra::{SMatrix, SVector, matrix, vector};
use dalembert::rayleigh::Comparison;
use dalembert::rules::SolvedForVelocity;
use dalembert::run::VelocityHistory;
use dalembert::samples::{self, Pair};
use dalembert::step::{
    ClosedForm, DiscreteForce, DiscreteForceDerivatives, Fused, Momenta, Segment, StepKernel,
};
use dalembert::system::{ActingForce, Derivatives};
use dalembert::{Discretise, Lagrangian, Midpoint, State, Trapezoidal, rayleigh_system};

type Vector = SVector<f64, 2>;

#[derive(Clone, Copy)]
struct Pendulums {
    r: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl Pendulums {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        v[0] * v[0] + 0.5 * v[1] * v[1] + v[0] * v[1] * (q[0] - q[1]).cos() + q[0].cos() + 0.5 * q[1].cos()
    }
    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * self.r * (1.0 + q[0] * q[0]) * (v[0] * v[0] + (v[1] - v[0]).powi(2))
    }
}

/// ψ = sin x + x y², φ0 = x³ − y, φ1 = cos(x + 2y): gradient and second derivatives.
fn psi(q: &Vector) -> (f64, Vector, SMatrix<f64, 2, 2>) {
    let (x, y) = (q[0], q[1]);
    (x.sin() + x * y * y, vector![x.cos() + y * y, 2.0 * x * y], matrix![-x.sin(), 2.0 * y; 2.0 * y, 2.0 * x])
}

fn phi0(q: &Vector) -> (f64, Vector, SMatrix<f64, 2, 2>) {
    (q[0].powi(3) - q[1], vector![3.0 * q[0] * q[0], -1.0], matrix![6.0 * q[0], 0.0; 0.0, 0.0])
}

fn phi1(q: &Vector) -> (f64, Vector, SMatrix<f64, 2, 2>) {
    let angle = q[0] + 2.0 * q[1];
    let (sin, cos) = angle.sin_cos();
    (cos, vector![-sin, -2.0 * sin], matrix![-cos, -2.0 * cos; -2.0 * cos, -4.0 * cos])
}

/// The system with φ and χ added; χ = ψ(q0) + `sign` φ1(q1) − φ0(q0) + ψ(q1).
struct Regauged {
    system: Pendulums,
    sign: f64,
}

impl Lagrangian<2> for Regauged {
    type Scalar = f64;
    fn lagrangian(&self, q: &Vector, v: &Vector) -> f64 {
        Lagrangian::lagrangian(&self.system, q, v)
    }
    fn lagrangian_derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<f64, 2> {
        self.system.lagrangian_derivatives(q, v)
    }
}

/// A rule of one's own, whose discrete objects are the system's.
#[derive(Clone, Copy)]
struct ByHand;

impl SolvedForVelocity for ByHand {}

impl ActingForce<2> for Regauged {}

impl Fused<ByHand, 2> for Regauged {
    type Matrix = SMatrix<f64, 2, 2>;
    type Memory = VelocityHistory<f64, 2>;
    type Border = dalembert::step::Free;
    fn step_kernel(&self, segment: &Segment<f64, 2>) -> StepKernel<f64, 2> {
        let kernel = Fused::<Midpoint, 2>::step_kernel(&self.system, segment);
        StepKernel { p0: kernel.p0 - psi(&segment.q0).1 * 2.0, ..kernel }
    }
    fn momenta(&self, segment: &Segment<f64, 2>) -> Momenta<f64, 2> {
        let momenta = Fused::<Midpoint, 2>::momenta(&self.system, segment);
        let q1 = segment.end();
        Momenta {
            p0: momenta.p0 - psi(&segment.q0).1 * 2.0,
            p1: momenta.p1 - psi(&q1).1 * 2.0 + phi1(&q1).1 * (1.0 - self.sign),
        }
    }
}

impl ClosedForm<ByHand, 2> for Regauged {
    fn discrete_lagrangian(&self, segment: &Segment<f64, 2>) -> f64 {
        let q1 = &segment.end();
        ClosedForm::<Midpoint, 2>::discrete_lagrangian(&self.system, segment)
            + (psi(&segment.q0).0 + phi1(q1).0 + phi0(&segment.q0).0 - psi(q1).0)
    }
    fn discrete_lagrangian_derivatives(&self, segment: &Segment<f64, 2>) -> Derivatives<f64, 2> {
        let q1 = &segment.end();
        let mut l = ClosedForm::<Midpoint, 2>::discrete_lagrangian_derivatives(&self.system, segment);
        l.value = ClosedForm::<ByHand, 2>::discrete_lagrangian(self, segment);
        l.d1 += psi(&segment.q0).1 + phi0(&segment.q0).1;
        l.d2 += phi1(q1).1 - psi(q1).1;
        l.d11 += psi(&segment.q0).2 + phi0(&segment.q0).2;
        l.d22 += phi1(q1).2 - psi(q1).2;
        l
    }
    fn discrete_force(&self, segment: &Segment<f64, 2>) -> DiscreteForce<f64, 2> {
        let q1 = &segment.end();
        let mut f = ClosedForm::<Midpoint, 2>::discrete_force(&self.system, segment);
        f.minus += psi(&segment.q0).1 - phi0(&segment.q0).1;
        f.plus -= phi1(q1).1 * self.sign + psi(q1).1;
        f
    }
    fn discrete_force_derivatives(&self, segment: &Segment<f64, 2>) -> DiscreteForceDerivatives<f64, 2> {
        let q1 = &segment.end();
        let mut f = ClosedForm::<Midpoint, 2>::discrete_force_derivatives(&self.system, segment);
        f.minus.d1 += psi(&segment.q0).2 - phi0(&segment.q0).2;
        f.plus.d2 -= phi1(q1).2 * self.sign + psi(q1).2;
        f
    }
    fn segment_energy(&self, segment: &Segment<f64, 2>) -> f64 {
        ClosedForm::<Midpoint, 2>::segment_energy(&self.system, segment)
    }
}

const H: f64 = 0.1;

fn plane() -> Vec<Pair<f64, 2>> {
    samples::segments([-1.0; 2], [1.0; 2], [0.3; 2], if cfg!(debug_assertions) { 10 } else { 40 })
}

#[test]
fn the_corrected_gauge_keeps_the_equations_and_is_recovered() {
    let system = Pendulums { r: 0.3 };
    let corrected = Regauged { system, sign: 1.0 };
    let base = vector![0.2, -0.3];
    let comparison = Comparison::new((&system, Midpoint), (&corrected, ByHand), H, base);
    let report = comparison.check(&plane()).unwrap();
    assert!(report.has_same_equations() && report.is_gauge(), "{report}");
    // ψ up to its value at the base; φ0 and φ1 up to what the choices ψ(a) = 0 and χ(a, a) = 0 fix:
    // φ0 ↦ φ0 + ψ(a) + κ, φ1 ↦ φ1 − ψ(a) − κ + …, so their differences between points are compared.
    for segment in plane() {
        let q = segment.q0;
        let recovered = comparison.psi(&q);
        assert!((recovered.value - (psi(&q).0 - psi(&base).0)).abs() < 1e-13, "{recovered:?}");
        for (recovered, at_base, function) in [
            (comparison.phi0(&q), comparison.phi0(&base), phi0 as fn(&Vector) -> _),
            (comparison.phi1(&q), comparison.phi1(&base), phi1),
        ] {
            let difference = recovered.value - at_base.value;
            assert!((difference - (function(&q).0 - function(&base).0)).abs() < 1e-12, "{recovered:?}");
        }
    }
}

#[test]
fn the_printed_gauge_changes_the_equations() {
    let system = Pendulums { r: 0.3 };
    let printed = Regauged { system, sign: -1.0 };
    let report =
        Comparison::new((&system, Midpoint), (&printed, ByHand), H, [0.2, -0.3]).check(&plane()).unwrap();
    assert!(!report.has_same_equations() && !report.is_gauge(), "{report}");
    // By 2 dφ1 at the middle configuration, exactly.
    for Pair { q0, q1 } in plane() {
        let q2 = q1 + vector![0.1, 0.05];
        let difference = printed.by(ByHand, H).del_residual(&q0, &q1, &q2)
            - system.by(Midpoint, H).del_residual(&q0, &q1, &q2);
        assert!((difference - phi1(&q1).1 * 2.0).amax() < 1e-12);
    }
}

/// Re-gauging leaves trajectories as they are and moves momenta by −2 dψ; the printed version leaves the
/// trajectory.
#[test]
fn trajectories_are_unchanged_and_momenta_shift_by_a_gradient() {
    let system = Pendulums { r: 0.3 };
    let start = State::from_velocity(&system, [0.9, -0.4], [0.2, 0.5]).unwrap();
    let distance = |sign: f64| {
        let regauged = Regauged { system, sign };
        let shifted = State { q: start.q, p: start.p - psi(&start.q).1 * 2.0 };
        let ours = system.by(Midpoint, H).run(start);
        let theirs = regauged.by(ByHand, H).run(shifted);
        ours.zip(theirs).take(200).fold((0.0_f64, 0.0_f64), |(q, p), (ours, theirs)| {
            let (Ok(ours), Ok(theirs)) = (ours, theirs) else { return (f64::INFINITY, f64::INFINITY) };
            let momentum = theirs.state.p - (ours.state.p - psi(&ours.state.q).1 * 2.0);
            (q.max((theirs.state.q - ours.state.q).amax()), p.max(momentum.amax()))
        })
    };
    let (q, p) = distance(1.0);
    assert!(q < 1e-11 && p < 1e-11, "{q} {p}");
    assert!(distance(-1.0).0 > 0.1);
}

/// The same continuous system by two rules is two different discrete systems.
#[test]
fn another_rule_is_not_equivalent() {
    let system = Pendulums { r: 0.3 };
    let report =
        Comparison::new((&system, Midpoint), (&system, Trapezoidal), H, [0.0; 2]).check(&plane()).unwrap();
    assert!(!report.has_same_equations(), "{report}");
    let same =
        Comparison::new((&system, Midpoint), (&system, Midpoint), H, [0.0; 2]).check(&plane()).unwrap();
    assert!(same.is_gauge(), "{same}");
    let other = Pendulums { r: 0.3 * (1.0 + 1e-9) };
    let other =
        Comparison::new((&system, Midpoint), (&other, Midpoint), H, [0.0; 2]).check(&plane()).unwrap();
    assert!(!other.has_same_equations(), "{other}");
}
