//! 𝔤_{f_d} of the paper's theorem, with its dimension, its elements and its closure, against subalgebras
//! known by hand.

use dalembert::nalgebra::matrix;
use dalembert::noether::{Generator, Subalgebra, SubalgebraError};
use dalembert::samples::{Pair, SampleError};
use dalembert::{Discrete, Discretise, Midpoint, rayleigh_system, samples};

/// A particle in a central potential, with drag along the axis n = (1, 2, 2)/3, and isotropic drag.
#[derive(Clone, Copy)]
struct Particle {
    stiffness: f64,
    along_axis: f64,
    isotropic: f64,
}

#[rayleigh_system]
impl Particle {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        let s = q[0] * q[0] + q[1] * q[1] + q[2] * q[2];
        0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) - self.stiffness * s * s
    }
    fn rayleigh(&self, v: [f64; 3]) -> f64 {
        let along = (v[0] + 2.0 * v[1] + 2.0 * v[2]) / 3.0;
        0.5 * self.along_axis * along * along
            + 0.5 * self.isotropic * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
    }
}

/// Rotations about the three axes.
fn so3() -> Vec<Generator<f64, 3>> {
    vec![
        Generator::rotation(1, 2).named("about x"),
        Generator::rotation(2, 0).named("about y"),
        Generator::rotation(0, 1).named("about z"),
    ]
}

fn translations() -> Vec<Generator<f64, 3>> {
    vec![
        Generator::translation("x", [1.0, 0.0, 0.0]),
        Generator::translation("y", [0.0, 1.0, 0.0]),
        Generator::translation("z", [0.0, 0.0, 1.0]),
    ]
}

fn space() -> Vec<Pair<f64, 3>> {
    samples::segments([-1.0; 3], [1.0; 3], [0.3; 3], 60)
}

fn subalgebra<L: Discrete<Midpoint, 3, Scalar = f64>>(
    system: &L,
    generators: &[Generator<f64, 3>],
) -> Subalgebra {
    system.by(Midpoint, 0.1).noether().subalgebra(generators, &space()).unwrap()
}

fn assert_close(vector: &[f64], expected: &[f64]) {
    assert!(vector.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-10), "{vector:?} {expected:?}");
}

/// so(3) under drag along n leaves the rotations about n.
#[test]
fn friction_about_one_axis_leaves_one_dimension() {
    let system = Particle { stiffness: 0.5, along_axis: 1e-3, isotropic: 0.0 };
    let report = subalgebra(&system, &so3());
    assert!(report.premise_holds() && report.closure.is_closed(), "{report}");
    for subspace in [&report.conserved, &report.invariant] {
        assert_eq!(subspace.dimension(), 1, "{report}");
        assert!(subspace.decision.is_clear(), "{report}");
        let v = &subspace.basis[0];
        assert_close(&[v[0] / v[1], v[2] / v[1]], &[0.5, 1.0]);
    }
    // The momentum of that element is conserved, that of one beside it is not.
    let about = |c: [f64; 3]| {
        let [x, y, z]: [Generator<f64, 3>; 3] = so3().try_into().unwrap();
        let combination = x * c[0] + y * c[1] + z * c[2];
        system.by(Midpoint, 0.1).noether().symmetry(&combination, &space()).unwrap()
    };
    assert!(about([1.0, 2.0, 2.0]).is_conserved(), "{}", about([1.0, 2.0, 2.0]));
    assert!(!about([1.0, 2.0, 2.0 + 1e-6]).is_conserved());
}

/// Positive controls: no friction leaves all of so(3), isotropic friction nothing.
#[test]
fn no_friction_leaves_all_and_isotropic_friction_nothing() {
    let dimensions = |along_axis, isotropic| {
        let system = Particle { stiffness: 0.5, along_axis, isotropic };
        let report = subalgebra(&system, &so3());
        (report.conserved.dimension(), report.invariant.dimension())
    };
    assert_eq!(dimensions(0.0, 0.0), (3, 3));
    assert_eq!(dimensions(1e-3, 1e-6), (0, 0));
    assert_eq!(dimensions(0.0, 1e-9), (0, 0));
}

/// Rigid motions of space under drag along n: those of the plane across n, a three-dimensional subalgebra.
#[test]
fn rigid_motions_of_the_plane_across_the_drag() {
    let generators: Vec<_> = translations().into_iter().chain(so3()).collect();
    let free = Particle { stiffness: 0.0, along_axis: 0.2, isotropic: 0.0 };
    let report = subalgebra(&free, &generators);
    assert!(report.premise_holds() && report.closure.is_closed(), "{report}");
    assert_eq!((report.conserved.dimension(), report.invariant.dimension()), (3, 3), "{report}");
    assert!(report.conserved.closure.is_closed() && report.invariant.closure.is_closed(), "{report}");
    assert!(report.invariant.closure.tolerance < 1e-9, "{report}");
    // Each element moves across n only: translation part b ⟂ n, rotation part ω ∥ n.
    for c in &report.invariant.basis {
        assert_close(&[c[0] + 2.0 * c[1] + 2.0 * c[2]], &[0.0]);
        assert_close(&[2.0 * c[3], c[5]], &[c[4], c[4]]);
    }
    // A potential leaves the premise unfulfilled, and says so.
    let bound = Particle { stiffness: 0.5, ..free };
    let report = subalgebra(&bound, &generators);
    assert!(!report.premise_holds() && report.lagrangian.dimension() == 3, "{report}");
    assert_eq!((report.conserved.dimension(), report.invariant.dimension()), (1, 3), "{report}");
}

/// A metric on ℝ³ invariant under ∂x, ∂y + x ∂z and ∂z, and a force along dz − x dy, which does no work along
/// the first two although they do not leave it invariant.
#[derive(Clone, Copy)]
struct Heisenberg {
    k: f64,
}

#[rayleigh_system]
impl Heisenberg {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1] + (v[2] - q[1] * v[0]).powi(2))
    }
    fn force(&self, q: [f64; 3], v: [f64; 3]) -> [f64; 3] {
        let along = -self.k * (v[2] - q[1] * v[0]);
        [0.0, -q[0] * along, along]
    }
}

/// The subspace that keeps J is not always a subalgebra, 𝔤_{f_d} is: [∂x, ∂y + x ∂z] = ∂z loses momentum.
#[test]
fn what_keeps_j_need_not_be_closed() {
    let shear = matrix![0.0, 0.0, 0.0; 0.0, 0.0, 0.0; 1.0, 0.0, 0.0];
    let generators = [
        Generator::translation("∂x", [1.0, 0.0, 0.0]),
        Generator::affine("∂y + x∂z", shear, [0.0, 1.0, 0.0]),
        Generator::translation("∂z", [0.0, 0.0, 1.0]),
    ];
    let report = subalgebra(&Heisenberg { k: 0.3 }, &generators);
    assert!(report.premise_holds() && report.closure.is_closed(), "{report}");
    assert_eq!((report.conserved.dimension(), report.invariant.dimension()), (2, 0), "{report}");
    assert!(!report.conserved.closure.is_closed() && report.conserved.closure.residual > 0.1, "{report}");
    assert_eq!(report.conserved.closure.pair, Some((0, 1)), "{report}");
    // Positive control: without the force it is the whole algebra, closed.
    let report = subalgebra(&Heisenberg { k: 0.0 }, &generators);
    assert_eq!((report.conserved.dimension(), report.invariant.dimension()), (3, 3), "{report}");
    assert!(report.conserved.closure.is_closed(), "{report}");
}

/// A central potential given as a force: f_d = −h dU(q̄) is closed, so that ι_ξ df_d = 0 although f_d varies
/// along ξ.
#[derive(Clone, Copy)]
struct Attracted {
    off_centre: f64,
}

#[rayleigh_system]
impl Attracted {
    fn lagrangian(&self, _q: [f64; 3], v: [f64; 3]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
    }
    fn force(&self, q: [f64; 3], _v: [f64; 3]) -> [f64; 3] {
        let s = q[0] * q[0] + q[1] * q[1] + q[2] * q[2];
        [-s * q[0], -s * q[1], -s * q[2] - self.off_centre]
    }
}

#[test]
fn a_closed_central_force_leaves_all_rotations() {
    let report = subalgebra(&Attracted { off_centre: 0.0 }, &so3());
    assert_eq!((report.conserved.dimension(), report.invariant.dimension()), (3, 3), "{report}");
    // Positive control: a uniform pull along z leaves the rotations about z.
    let report = subalgebra(&Attracted { off_centre: 0.1 }, &so3());
    assert_eq!(report.conserved.basis, [[0.0, 0.0, 1.0]], "{report}");
    assert_eq!(report.invariant.basis, [[0.0, 0.0, 1.0]], "{report}");
}

/// A dimension that hangs on rounding is announced.
#[test]
fn a_rank_without_a_gap_says_so() {
    let decision = |isotropic| {
        let system = Particle { stiffness: 0.5, along_axis: 0.0, isotropic };
        subalgebra(&system, &so3()).conserved.decision
    };
    let doubtful = decision(1e-10);
    assert!(!doubtful.is_clear(), "{doubtful}");
    assert!(doubtful.to_string().contains("NO CLEAR GAP"));
    assert!(decision(1e-3).is_clear() && decision(0.0).is_clear());
}

#[test]
fn generators_and_samples_that_decide_nothing_are_refused() {
    let system = Particle { stiffness: 0.5, along_axis: 0.1, isotropic: 0.0 };
    let noether = system.by(Midpoint, 0.1).noether();
    let [x, y, z]: [Generator<f64, 3>; 3] = so3().try_into().unwrap();
    let dependent = [x.clone(), y.clone(), x.clone() * 2.0 - y.clone()];
    match noether.subalgebra(&dependent, &space()).unwrap_err() {
        SubalgebraError::DependentGenerators { relation } => {
            assert_close(&[relation[0] / relation[2], relation[1] / relation[2]], &[-2.0, 1.0]);
        }
        other => panic!("{other}"),
    }
    let error = noether.subalgebra(&[x, y, z], &space()[..5]).unwrap_err();
    assert_eq!(error, SubalgebraError::Samples(SampleError::TooFew { given: 5, needed: 6 }));
}
