//! Finite group actions beside their generators: where Φ_g leaves L_d alone and maps f_d equivariantly,
//!
//! ```text
//! L_d(gq0, gq1) = L_d(q0, q1),   f_d^±(gq0, gq1)·g = f_d^±(q0, q1),   F(g·(q, p)) = g·F(q, p)
//! ⟨J^±(gq0, gq1), ω⟩ = ⟨J^±(q0, q1), Ad_{g⁻¹} ω⟩          for SO(3): J_ω(gq0, gq1) = J_{gᵀω}(q0, q1)
//! ```
//!
//! (paper, section 3.6). Rotations of space by any angle, of one particle and by every rule.

use dalembert::nalgebra::{Rotation3, SMatrix, SVector, Vector3, vector};
use dalembert::noether::Generator;
use dalembert::{
    Discrete, Discretise, Fitted, FittedTrapezoidal, Gauss, Midpoint, State, Trapezoidal, VectorField,
    rayleigh_system,
};
use dalembert_tests::draws::Draws;

/// In a central potential, with friction of the radial motion and of all motion; `tilt` is what breaks the
/// symmetry of the force, `slope` that of L.
#[derive(Clone, Copy, Debug)]
struct Particle {
    m: f64,
    k: f64,
    r: [f64; 2],
    tilt: f64,
    slope: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
impl Particle {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        let s = q[0] * q[0] + q[1] * q[1] + q[2] * q[2];
        0.5 * self.m * (1.0 + 0.2 * s) * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
            - self.k * s * s
            - self.slope * q[0]
    }

    fn rayleigh(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        let radial = q[0] * v[0] + q[1] * v[1] + q[2] * v[2];
        0.5 * self.r[0] * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
            + 0.5 * self.r[1] * radial * radial
            + 0.5 * self.tilt * v[2] * v[2]
    }
}

/// The same of constant mass and linear friction, for the fitted rules.
#[derive(Clone, Copy, Debug)]
struct Even {
    m: f64,
    k: f64,
    r: f64,
    tilt: f64,
}

#[rayleigh_system(rule = [fitted, fitted_trapezoidal])]
impl Even {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        let s = q[0] * q[0] + q[1] * q[1] + q[2] * q[2];
        0.5 * self.m * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) - self.k * s * s
    }

    fn rayleigh(&self, v: [f64; 3]) -> f64 {
        0.5 * self.r * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) + 0.5 * self.tilt * v[2] * v[2]
    }
}

const H: f64 = 0.2;

/// J_ω is that of the generator q ↦ ω × q.
fn turning(omega: &Vector3<f64>) -> Generator<f64, 3> {
    let [x, y, z] = (*omega).into();
    Generator::rotation(1, 2) * x + Generator::rotation(2, 0) * y + Generator::rotation(0, 1) * z
}

/// What g changes: L_d; f_d beyond equivariance; the step; J beyond the coadjoint action.
fn changes<R: Copy, L>(system: &L, rule: R, draws: &mut Draws) -> [f64; 4]
where
    L: Discrete<R, 3, Scalar = f64>,
{
    let mut worst = [0.0_f64; 4];
    for _ in 0..5 {
        let mut vector = |size: f64| Vector3::from_fn(|_, _| draws.between(-size, size));
        let (q0, shift, omega, p) = (vector(0.8), vector(0.2), vector(1.0), vector(0.6));
        let g: SMatrix<f64, 3, 3> = *Rotation3::from_scaled_axis(vector(2.0)).matrix();
        let q1 = q0 + shift;
        let by = system.by(rule, H);
        let [here, there] = [[q0, q1], [g * q0, g * q1]].map(|[a, b]| by.segment(&a, &b).unwrap());
        let lagrangian = there.discrete_lagrangian().unwrap() - here.discrete_lagrangian().unwrap();
        let [f, f_there] = [&here, &there].map(|at| at.discrete_force().unwrap());
        let force = (g.transpose() * f_there.minus - f.minus).amax().max((f_there.plus - g * f.plus).amax());
        let [turned, plain] =
            [State { q: g * q0, p: g * p }, State { q: q0, p }].map(|state| by.step(&state).unwrap().state);
        let step = (turned.q - g * plain.q).amax().max((turned.p - g * plain.p).amax());
        let j = |at: &SVector<f64, 3>, momentum: &SVector<f64, 3>, omega: &Vector3<f64>| {
            momentum.dot(&turning(omega).vector(at))
        };
        let carried = g.transpose() * omega;
        let map = [true, false].map(|minus| {
            let ends = [&here, &there]
                .map(|at| if minus { at.legendre_minus().unwrap() } else { at.legendre_plus().unwrap() });
            (j(&ends[1].q, &ends[1].p, &omega) - j(&ends[0].q, &ends[0].p, &carried)).abs()
        });
        for (worst, change) in worst.iter_mut().zip([lagrangian.abs(), force, step, map[0].max(map[1])]) {
            *worst = worst.max(change);
        }
    }
    worst
}

fn check<R: Copy, L>(systems: [&L; 2], rule: R, draws: &mut Draws)
where
    L: Discrete<R, 3, Scalar = f64>,
{
    let [even, tilted] = systems;
    assert!(changes(even, rule, draws).iter().all(|change| *change < 1e-13));
    // Control: with friction that has an axis, all but L_d may be changed, and are.
    let [lagrangian, others @ ..] = changes(tilted, rule, draws);
    assert!(others.iter().all(|change| *change > 1e-4), "{lagrangian} {others:?}");
}

#[test]
fn a_rotation_by_any_angle_maps_the_discrete_objects() {
    let mut draws = Draws::new(34);
    for _ in 0..3 {
        let mut of = |low, high| draws.between(low, high);
        let even = Particle {
            m: of(0.5, 2.0),
            k: of(0.1, 1.0),
            r: [of(0.1, 1.0), of(0.1, 1.0)],
            tilt: 0.0,
            slope: 0.0,
        };
        let tilted = Particle { tilt: of(0.3, 1.0), ..even };
        check([&even, &tilted], Midpoint, &mut draws);
        check([&even, &tilted], Trapezoidal, &mut draws);
        check([&even, &tilted], Gauss::<2>, &mut draws);
        // L_d of these rules knows nothing of the force.
        assert!(changes(&tilted, Midpoint, &mut draws)[0] < 1e-13);
        // Control: a potential with a direction changes L_d, and not f_d.
        let sloped = Particle { slope: 0.5, ..even };
        let [lagrangian, force, ..] = changes(&sloped, Midpoint, &mut draws);
        assert!(lagrangian > 1e-3 && force < 1e-13);

        let mut of = |low, high| draws.between(low, high);
        let even = Even { m: of(0.5, 2.0), k: of(0.1, 1.0), r: of(0.1, 1.0), tilt: 0.0 };
        let tilted = Even { tilt: of(0.3, 1.0), ..even };
        check([&even, &tilted], Fitted, &mut draws);
        check([&even, &tilted], FittedTrapezoidal, &mut draws);
    }
}

/// An element of 𝔤_{f_d} leaves f_d as a whole, a one-form on Q×Q, where it is: friction along the axis alone
/// is of every rotation about it, by whatever angle, and keeps its momentum. About another axis neither
/// holds.
#[test]
fn the_group_of_the_subalgebra_keeps_the_force() {
    let axial = Particle { m: 1.3, k: 0.4, r: [0.0, 0.0], tilt: 0.7, slope: 0.0 };
    let by = axial.by(Midpoint, H);
    let (q0, q1) = (vector![0.5, -0.2, 0.3], vector![0.6, -0.1, 0.45]);
    let moved = |axis: Vector3<f64>| {
        let g = *Rotation3::from_scaled_axis(axis).matrix();
        let [f, there] = [by.discrete_force(&q0, &q1), by.discrete_force(&(g * q0), &(g * q1))];
        (g.transpose() * there.minus - f.minus).amax().max((g.transpose() * there.plus - f.plus).amax())
    };
    let defect = |axis| by.noether().defect(&turning(&axis), &q0, &q1).total().abs();
    for angle in [0.3, 1.7, -2.9] {
        assert!(moved(vector![0.0, 0.0, angle]) < 1e-15);
        assert!(moved(vector![angle, 0.0, 0.0]) > 1e-3);
    }
    assert!(defect(vector![0.0, 0.0, 1.0]) < 1e-15 && defect(vector![1.0, 0.0, 0.0]) > 1e-3);
}

#[rayleigh_system]
fn on_a_line(q: [f64; 1], v: [f64; 1], even: f64, odd: f64) -> f64 {
    0.5 * v[0] * v[0] - even * q[0].powi(2) - odd * q[0].powi(3)
}

/// G = {±1} has no generators: nothing is asked of ξ(L_d), and L_d is invariant or not.
#[test]
fn no_generator_sees_a_reflection() {
    let change = |odd: f64| {
        let system = OnALine { even: 0.7, odd };
        let of = |sign: f64| {
            system.by(Midpoint, H).discrete_lagrangian(&vector![0.4 * sign], &vector![0.6 * sign])
        };
        (of(-1.0) - of(1.0)).abs()
    };
    assert!(change(0.0) == 0.0 && change(1.0) > 1e-2);
}
