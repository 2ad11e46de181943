//! Implicit damping with an R_d and without: all of R at the start of a step, L_d = h L + (h²/2) R with R_d =
//! (h²/2) R, and R at both ends, which [`OneSided`] steps by.
//!
//! The first has its place among discrete Rayleigh systems for any number of coordinates, and a p that no
//! balance of forces asks for.

use dalembert::nalgebra::{SMatrix, vector};
use dalembert::rules::{DisplacementRule, Fused, SolvedForVelocity};
use dalembert::run::VelocityHistory;
use dalembert::step::{
    ClosedForm, DiscreteForce, DiscreteForceDerivatives, DiscreteRayleigh, Free, Momenta, Segment, StepKernel,
};
use dalembert::system::Derivatives;
use dalembert::{Discretise, Midpoint, OneSided, Rayleigh, State, rayleigh_system};
use dalembert_tests::draws::Draws;

#[derive(Clone, Copy, Debug)]
struct Masses {
    c: [f64; 3],
    k: [f64; 3],
    load: f64,
}

#[rayleigh_system(rule = [midpoint, one_sided])]
impl Masses {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let [a, b, c] = self.k;
        0.5 * (v[0] * v[0] + 1.7 * v[1] * v[1])
            - 0.5 * (a * q[0] * q[0] + 2.0 * b * q[0] * q[1] + c * q[1] * q[1])
            + self.load * q[1]
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        let [a, b, c] = self.c;
        0.5 * (a * v[0] * v[0] + 2.0 * b * v[0] * v[1] + c * v[1] * v[1])
    }
}

impl Masses {
    fn random(draws: &mut Draws) -> Self {
        let mut form =
            |off: f64| [draws.between(0.5, 2.0), draws.between(-off, off), draws.between(0.5, 2.0)];
        Self { c: form(0.3), k: form(0.4), load: 0.0 }
    }
}

/// The midpoint rule with all of the damping at the start of the segment, h ∂R/∂v(v̄).
#[derive(Clone, Copy)]
struct AtStart;

impl SolvedForVelocity for AtStart {}

impl Fused<AtStart, 2> for Masses {
    type Matrix = SMatrix<f64, 2, 2>;
    type Memory = VelocityHistory<f64, 2>;
    type Border = Free;

    fn step_kernel(&self, segment: &Segment<f64, 2>) -> StepKernel<f64, 2> {
        let r = self.rayleigh_derivatives(&segment.q0, &segment.v);
        Midpoint::lagrangian_kernel(self, segment) + StepKernel { p0: r.d2, matrix: r.d22 } * segment.h
    }

    fn momenta(&self, segment: &Segment<f64, 2>) -> Momenta<f64, 2> {
        let drag = self.rayleigh_gradient(&segment.q0, &segment.v).d2 * segment.h;
        Midpoint::lagrangian_momenta(self, segment) + Momenta { p0: drag, p1: vector![0.0, 0.0] }
    }
}

impl ClosedForm<AtStart, 2> for Masses {
    fn discrete_lagrangian(&self, segment: &Segment<f64, 2>) -> f64 {
        Midpoint::discrete_lagrangian(self, segment) + Midpoint::discrete_rayleigh(self, segment)
    }

    fn discrete_lagrangian_derivatives(&self, segment: &Segment<f64, 2>) -> Derivatives<f64, 2> {
        Midpoint::discrete_lagrangian_derivatives(self, segment)
            + Midpoint::discrete_rayleigh_derivatives(self, segment)
    }

    fn segment_energy(&self, segment: &Segment<f64, 2>) -> f64 {
        Midpoint::segment_energy(self, segment)
    }

    fn discrete_force(&self, segment: &Segment<f64, 2>) -> DiscreteForce<f64, 2> {
        Midpoint::rayleigh_force(self, segment)
    }

    fn discrete_force_derivatives(&self, segment: &Segment<f64, 2>) -> DiscreteForceDerivatives<f64, 2> {
        Midpoint::rayleigh_force_derivatives(self, segment)
    }
}

impl DiscreteRayleigh<AtStart, 2> for Masses {
    fn discrete_rayleigh(&self, segment: &Segment<f64, 2>) -> f64 {
        Midpoint::discrete_rayleigh(self, segment)
    }

    fn discrete_rayleigh_derivatives(&self, segment: &Segment<f64, 2>) -> Derivatives<f64, 2> {
        Midpoint::discrete_rayleigh_derivatives(self, segment)
    }
}

fn states(draws: &mut Draws) -> [State<f64, 2>; 3] {
    [(); 3].map(|()| {
        let [a, b, c, d] = [(); 4].map(|()| draws.between(-1.0, 1.0));
        State { q: vector![a, b], p: vector![c, d] }
    })
}

#[test]
fn damping_at_one_end_has_an_r_d_and_at_both_ends_none() {
    let mut draws = Draws::new(71);
    for _ in 0..20 {
        let (masses, states) = (Masses::random(&mut draws), states(&mut draws));
        let at_start = masses.by(AtStart, 0.1).rayleigh_step(&states).unwrap();
        assert!(at_start.is_rayleigh(), "{masses:?}\n{at_start}");
        let at_both = masses.by(OneSided, 0.1).rayleigh_step(&states).unwrap();
        assert!(!at_both.is_rayleigh(), "{masses:?}\n{at_both}");
        assert!(at_both.to_string().starts_with("no R_d for any L_d"), "{at_both}");
    }
    // Where friction and springs commute, mode by mode, there is one again.
    let even = Masses { c: [0.4, 0.0, 0.68], k: [1.3, 0.4, 0.9], load: 0.0 };
    let found = even.by(OneSided, 0.1).rayleigh_step(&states(&mut draws)).unwrap();
    assert!(found.is_rayleigh(), "{found}");
}

/// Both momenta of the first are those of L_d^± = L_d ± R_d.
#[test]
fn the_pair_with_an_r_d_steps_as_its_transforms_say() {
    let mut draws = Draws::new(72);
    let masses = Masses::random(&mut draws);
    for state in states(&mut draws) {
        let step = masses.by(AtStart, 0.3).step(&state).unwrap();
        let segment = Segment { q0: state.q, v: step.velocity, h: 0.3 };
        let l = ClosedForm::<AtStart, 2>::discrete_lagrangian_derivatives(&masses, &segment);
        let r = DiscreteRayleigh::<AtStart, 2>::discrete_rayleigh_derivatives(&masses, &segment);
        assert!((-l.d1 - r.d1 - state.p).amax() < 1e-14 && (l.d2 - r.d2 - step.state.p).amax() < 1e-14);
        // The control: without R in it, L_d has other momenta.
        let bare = Midpoint::discrete_lagrangian_derivatives(&masses, &segment);
        assert!((-bare.d1 - r.d1 - state.p).amax() > 1e-3);
    }
}

/// Two masses on stiff dashpots C v = F − K q under a load: where they creep, p is M C⁻¹(F − K q), and the
/// first leaves (h/2)(F − K q), however stiff they are.
#[test]
fn only_damping_at_both_ends_leaves_the_momentum_of_the_balance() {
    let h = 0.1;
    for stiff in [1e4, 1e6, 1e8] {
        let masses = Masses { c: [2.0, -1.0, 1.5].map(|c| c * stiff), k: [1.0, -0.3, 0.8], load: 2.0 };
        let state = State { q: vector![0.2, -0.1], p: vector![0.0, 0.0] };
        let net = vector![0.0 - (0.2 + 0.03), 2.0 - (-0.06 - 0.08)];
        // C⁻¹ = [[1.5, 1], [1, 2]]/(2 · 1.5 − 1)
        let v = vector![1.5 * net[0] + net[1], net[0] + 2.0 * net[1]] / (2.0 * stiff);
        let expected = vector![v[0], 1.7 * v[1]];
        let both = masses.by(OneSided, h).step(&state).unwrap().state;
        assert!(
            (both.p - expected).amax() < 20.0 / stiff * expected.amax() / h,
            "{stiff:e}: {both:?} {expected}"
        );
        let one = masses.by(AtStart, h).step(&state).unwrap().state;
        assert!((one.p - net * (0.5 * h)).amax() < 20.0 / stiff, "{stiff:e}: {one:?}");
    }
}
