//! Re-gauging (L_d, R_d) leaves the motion as it is and changes momenta by a known gradient.
//!
//! ```text
//! L_d + φ, φ = ψ(q0) + φ1(q1) + φ0(q0) − ψ(q1)
//! R_d + χ, χ = ψ(q0) + φ1(q1) − φ0(q0) + ψ(q1)
//! ```
//!
//! Then L_d⁺ gains 2ψ(q0) + 2φ1(q1) and L_d⁻ gains 2φ0(q0) − 2ψ(q1): both momenta change by −2∇ψ. The paper
//! prints −φ1(q1) in χ.

use dalembert::nalgebra::{Matrix2, Vector2};
use dalembert::rules::SolvedForVelocity;
use dalembert::run::VelocityHistory;
use dalembert::step::{
    ClosedForm, DiscreteForce, DiscreteForceDerivatives, DiscreteRayleigh, Fused, Momenta, Segment,
    StepKernel,
};
use dalembert::system::{ActingForce, Derivatives};
use dalembert::{Discretise, Lagrangian, Midpoint, State, Trapezoidal};
use dalembert_tests::systems::DoublePendulum;

/// A function on Q with its gradient and second derivatives.
#[derive(Clone, Copy)]
struct Function {
    value: fn(&Vector2<f64>) -> f64,
    gradient: fn(&Vector2<f64>) -> Vector2<f64>,
    hessian: fn(&Vector2<f64>) -> Matrix2<f64>,
}

/// ψ = 0.3 sin x cos y.
const PSI: Function = Function {
    value: |q| 0.3 * q[0].sin() * q[1].cos(),
    gradient: |q| Vector2::new(0.3 * q[0].cos() * q[1].cos(), -0.3 * q[0].sin() * q[1].sin()),
    hessian: |q| {
        let (same, mixed) = (-0.3 * q[0].sin() * q[1].cos(), -0.3 * q[0].cos() * q[1].sin());
        Matrix2::new(same, mixed, mixed, same)
    },
};

/// φ0 = 0.2 x²y.
const PHI_0: Function = Function {
    value: |q| 0.2 * q[0] * q[0] * q[1],
    gradient: |q| Vector2::new(0.4 * q[0] * q[1], 0.2 * q[0] * q[0]),
    hessian: |q| Matrix2::new(0.4 * q[1], 0.4 * q[0], 0.4 * q[0], 0.0),
};

/// φ1 = 0.4 eˣ + 0.1 y³.
const PHI_1: Function = Function {
    value: |q| 0.4 * q[0].exp() + 0.1 * q[1].powi(3),
    gradient: |q| Vector2::new(0.4 * q[0].exp(), 0.3 * q[1] * q[1]),
    hessian: |q| Matrix2::new(0.4 * q[0].exp(), 0.0, 0.0, 0.6 * q[1]),
};

/// The double pendulum with (L_d + φ, R_d + χ) by the rule `R`; `sign` is φ1's in χ: +1, or the paper's −1.
struct Regauged<R> {
    system: DoublePendulum,
    rule: std::marker::PhantomData<R>,
    sign: f64,
}

impl<R> Regauged<R> {
    fn new(sign: f64) -> Self {
        Self { system: DoublePendulum::EXAMPLE, rule: std::marker::PhantomData, sign }
    }

    /// a(q0) + b(q1) with derivatives, for a = Σ factor·function and b likewise.
    fn separated(
        segment: &Segment<f64, 2>,
        a: [(f64, Function); 2],
        b: [(f64, Function); 2],
    ) -> Derivatives<f64, 2> {
        let sum = |terms: [(f64, Function); 2], q: &Vector2<f64>| {
            terms.iter().fold(
                (0.0, Vector2::zeros(), Matrix2::zeros()),
                |(value, gradient, hessian), (factor, f)| {
                    (
                        value + factor * (f.value)(q),
                        gradient + (f.gradient)(q) * *factor,
                        hessian + (f.hessian)(q) * *factor,
                    )
                },
            )
        };
        let ((a, d1, d11), (b, d2, d22)) = (sum(a, &segment.q0), sum(b, &segment.end()));
        Derivatives { value: a + b, d1, d2, d11, d12: Matrix2::zeros(), d22 }
    }

    fn phi(&self, segment: &Segment<f64, 2>) -> Derivatives<f64, 2> {
        Self::separated(segment, [(1.0, PSI), (1.0, PHI_0)], [(1.0, PHI_1), (-1.0, PSI)])
    }

    fn chi(&self, segment: &Segment<f64, 2>) -> Derivatives<f64, 2> {
        Self::separated(segment, [(1.0, PSI), (-1.0, PHI_0)], [(self.sign, PHI_1), (1.0, PSI)])
    }
}

impl<R> Lagrangian<2> for Regauged<R> {
    type Scalar = f64;

    fn lagrangian(&self, q: &Vector2<f64>, v: &Vector2<f64>) -> f64 {
        Lagrangian::lagrangian(&self.system, q, v)
    }

    fn lagrangian_derivatives(&self, q: &Vector2<f64>, v: &Vector2<f64>) -> Derivatives<f64, 2> {
        self.system.lagrangian_derivatives(q, v)
    }
}

/// The rule that is regauged.
struct Again<R>(R);

impl<R> SolvedForVelocity for Again<R> {}

impl<R> ActingForce<2> for Regauged<R> {}

impl<R: SolvedForVelocity> Fused<Again<R>, 2> for Regauged<R>
where
    DoublePendulum: DiscreteRayleigh<R, 2, Scalar = f64>,
{
    type Matrix = Matrix2<f64>;
    type Memory = VelocityHistory<f64, 2>;
    type Border = dalembert::step::Free;

    fn step_kernel(&self, segment: &Segment<f64, 2>) -> StepKernel<f64, 2> {
        let l = ClosedForm::<Again<R>, 2>::discrete_lagrangian_derivatives(self, segment);
        let force = ClosedForm::<Again<R>, 2>::discrete_force_derivatives(self, segment);
        StepKernel { p0: -l.d1 - force.minus.value, matrix: -(l.d12 + force.minus.d2) * segment.h }
    }

    fn momenta(&self, segment: &Segment<f64, 2>) -> Momenta<f64, 2> {
        let l = ClosedForm::<Again<R>, 2>::discrete_lagrangian_derivatives(self, segment);
        let force = ClosedForm::<Again<R>, 2>::discrete_force(self, segment);
        Momenta { p0: -l.d1 - force.minus, p1: l.d2 + force.plus }
    }
}

impl<R: SolvedForVelocity> ClosedForm<Again<R>, 2> for Regauged<R>
where
    DoublePendulum: DiscreteRayleigh<R, 2, Scalar = f64>,
{
    fn discrete_lagrangian(&self, segment: &Segment<f64, 2>) -> f64 {
        ClosedForm::<R, 2>::discrete_lagrangian(&self.system, segment) + self.phi(segment).value
    }

    fn discrete_lagrangian_derivatives(&self, segment: &Segment<f64, 2>) -> Derivatives<f64, 2> {
        ClosedForm::<R, 2>::discrete_lagrangian_derivatives(&self.system, segment) + self.phi(segment)
    }

    fn discrete_force(&self, segment: &Segment<f64, 2>) -> DiscreteForce<f64, 2> {
        let force = ClosedForm::<Again<R>, 2>::discrete_force_derivatives(self, segment);
        DiscreteForce { minus: force.minus.value, plus: force.plus.value }
    }

    fn discrete_force_derivatives(&self, segment: &Segment<f64, 2>) -> DiscreteForceDerivatives<f64, 2> {
        let (mut force, chi) =
            (ClosedForm::<R, 2>::discrete_force_derivatives(&self.system, segment), self.chi(segment));
        force.minus.value += chi.d1;
        force.minus.d1 += chi.d11;
        force.plus.value -= chi.d2;
        force.plus.d2 -= chi.d22;
        force
    }

    fn segment_energy(&self, segment: &Segment<f64, 2>) -> f64 {
        self.system.segment_energy(segment)
    }
}

/// Largest difference of the two motions over some steps in q, and in p once −2∇ψ is taken out.
fn differences<R>(rule: R, sign: f64, steps: usize) -> [f64; 2]
where
    R: SolvedForVelocity + Copy,
    DoublePendulum: DiscreteRayleigh<R, 2, Scalar = f64>,
{
    let (system, regauged) = (DoublePendulum::EXAMPLE, Regauged::<R>::new(sign));
    let start = State::from_velocity(&system, [1.1, -0.6], [0.3, 1.2]).unwrap();
    let shifted = |state: State<f64, 2>| State { p: state.p - (PSI.gradient)(&state.q) * 2.0, ..state };
    let plain = system.by(rule, 0.1).run(start);
    let other = regauged.by(Again(rule), 0.1).run(shifted(start));
    plain.zip(other).take(steps).fold([0.0, 0.0], |[in_q, in_p]: [f64; 2], (a, b)| {
        let (a, b) = (a.unwrap().state, b.unwrap().state);
        [in_q.max((a.q - b.q).amax()), in_p.max((shifted(a).p - b.p).amax())]
    })
}

#[test]
fn regauged_systems_move_alike() {
    for [in_q, in_p] in [differences(Midpoint, 1.0, 100), differences(Trapezoidal, 1.0, 100)] {
        // The regauged momenta are differences of L_d's derivatives, which carry 1/h: rounding grows over 100
        // steps.
        assert!(in_q < 1e-11 && in_p < 1e-11, "{in_q:e} {in_p:e}");
    }
}

/// Positive control: with the sign that the paper prints the motions differ at once.
#[test]
fn with_the_printed_sign_they_do_not() {
    let [in_q, _] = differences(Midpoint, -1.0, 2);
    assert!(in_q > 1e-2, "{in_q:e}");
}

/// Positive control: the momenta do change, so that leaving −2∇ψ out would be seen.
#[test]
fn momenta_change() {
    let start = State::from_velocity(&DoublePendulum::EXAMPLE, [1.1, -0.6], [0.3, 1.2]).unwrap();
    assert!((PSI.gradient)(&start.q).amax() > 0.05);
}
