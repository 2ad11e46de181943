//! The ring system of the scene, by the macro, equals the same system written by hand.
//!
//! Both compute the same polynomials, of degree 6 in q, in another order: they may differ by rounding,
//! nothing else.

#[path = "../examples/ring.rs"]
#[expect(dead_code, reason = "of the scene, the system and its start are tested here")]
mod ring;

use dalembert::step::{ClosedForm, DiscreteRayleigh, Fused, Segment};
use dalembert::system::{CovectorDerivatives, Derivatives};
use dalembert::{Discretise, Lagrangian, Midpoint, Rayleigh, State};
use dalembert_examples::by_hand::RingByHand;
use nalgebra::{Matrix2, Vector2, vector};
use ring::Ring;

const K: f64 = 0.3;

/// Points with |q| and |v| up to 2: inside the ring, on it, on its outer wall, and at the centre.
fn points() -> Vec<(Vector2<f64>, Vector2<f64>)> {
    let mut points = vec![(Vector2::zeros(), Vector2::zeros())];
    for i in 0..8 {
        let angle = 0.3 + 0.7 * f64::from(i);
        let (radius, speed) = (0.2 + 0.25 * f64::from(i), 2.0 - 0.2 * f64::from(i));
        points.push((
            radius * vector![angle.cos(), angle.sin()],
            speed * vector![(2.0 * angle).sin(), angle.cos()],
        ));
    }
    points
}

/// Sum of the sizes of all terms in the largest entry, once expanded: ∂²L/∂q² with 30 s² + 24 s + 2, L and
/// ∂L/∂v with |v|² and |v|.
fn terms(q: &Vector2<f64>, v: &Vector2<f64>) -> f64 {
    let s = q.norm_squared();
    30.0 * s * s + 24.0 * s + 2.0 + v.norm_squared() + v.norm()
}

/// The largest |a − b|, in units of the rounding that it may carry: fewer than 8 roundings of ε/2 reach a
/// term, on either side.
struct Comparison {
    unit: f64,
    worst: f64,
}

impl Comparison {
    fn of_terms(sum: f64) -> Self {
        Self { unit: 8.0 * f64::EPSILON * sum, worst: 0.0 }
    }

    fn entries<'n>(&mut self, a: impl IntoIterator<Item = &'n f64>, b: impl IntoIterator<Item = &'n f64>) {
        for (a, b) in a.into_iter().zip(b) {
            let difference = (a - b).abs() / self.unit;
            // NaN counts as different.
            self.worst = if difference <= self.worst { self.worst } else { difference };
        }
    }

    fn derivatives(&mut self, a: &Derivatives<f64, 2>, b: &Derivatives<f64, 2>) {
        self.entries(&[a.value], &[b.value]);
        self.entries(&a.d1, &b.d1);
        self.entries(&a.d2, &b.d2);
        self.entries(&a.d11, &b.d11);
        self.entries(&a.d12, &b.d12);
        self.entries(&a.d22, &b.d22);
    }

    fn covector(&mut self, a: &CovectorDerivatives<f64, 2>, b: &CovectorDerivatives<f64, 2>) {
        self.entries(&a.value, &b.value);
        self.entries(&a.d1, &b.d1);
        self.entries(&a.d2, &b.d2);
    }
}

/// How far L, R and their derivatives differ, in units of rounding.
fn of_functions(a: &impl Rayleigh<2, Scalar = f64>, b: &impl Rayleigh<2, Scalar = f64>) -> f64 {
    points().iter().fold(0.0, |worst: f64, (q, v)| {
        let mut comparison = Comparison::of_terms(terms(q, v));
        comparison.entries(&[a.lagrangian(q, v)], &[b.lagrangian(q, v)]);
        comparison.entries(&[a.rayleigh(q, v)], &[b.rayleigh(q, v)]);
        comparison.entries(&[a.energy(q, v)], &[b.energy(q, v)]);
        comparison.derivatives(&a.lagrangian_derivatives(q, v), &b.lagrangian_derivatives(q, v));
        comparison.derivatives(&a.rayleigh_derivatives(q, v), &b.rayleigh_derivatives(q, v));
        worst.max(comparison.worst)
    })
}

/// How far the discrete objects differ, in units of rounding.
fn of_discrete_objects<A, B>(a: &A, b: &B) -> f64
where
    A: DiscreteRayleigh<Midpoint, 2, Scalar = f64, Matrix = Matrix2<f64>>,
    B: DiscreteRayleigh<Midpoint, 2, Scalar = f64, Matrix = Matrix2<f64>>,
{
    let h = ring::H;
    points().iter().fold(0.0, |worst: f64, (q0, v)| {
        let q1 = &(q0 + v * h);
        // The largest entry is in h D11 L/4 + D22 L/h, D12 L being 0.
        let mut comparison = Comparison::of_terms(h * terms(&((q0 + q1) / 2.0), v) + (1.0 + K) / h);
        comparison.entries(
            &[a.discrete_lagrangian(&Segment::between(q0, q1, h))],
            &[b.discrete_lagrangian(&Segment::between(q0, q1, h))],
        );
        comparison.entries(
            &[a.discrete_rayleigh(&Segment::between(q0, q1, h))],
            &[b.discrete_rayleigh(&Segment::between(q0, q1, h))],
        );
        comparison.entries(
            &[a.segment_energy(&Segment::between(q0, q1, h))],
            &[b.segment_energy(&Segment::between(q0, q1, h))],
        );
        comparison.derivatives(
            &a.discrete_lagrangian_derivatives(&Segment::between(q0, q1, h)),
            &b.discrete_lagrangian_derivatives(&Segment::between(q0, q1, h)),
        );
        comparison.derivatives(
            &a.discrete_rayleigh_derivatives(&Segment::between(q0, q1, h)),
            &b.discrete_rayleigh_derivatives(&Segment::between(q0, q1, h)),
        );
        let [f, g] =
            [a.discrete_force(&Segment::between(q0, q1, h)), b.discrete_force(&Segment::between(q0, q1, h))];
        comparison.entries(f.minus.iter().chain(&f.plus), g.minus.iter().chain(&g.plus));
        let [f, g] = [
            a.discrete_force_derivatives(&Segment::between(q0, q1, h)),
            b.discrete_force_derivatives(&Segment::between(q0, q1, h)),
        ];
        comparison.covector(&f.minus, &g.minus);
        comparison.covector(&f.plus, &g.plus);
        let [f, g] =
            [a.step_kernel(&Segment { q0: *q0, v: *v, h }), b.step_kernel(&Segment { q0: *q0, v: *v, h })];
        comparison.entries(f.p0.iter().chain(&f.matrix), g.p0.iter().chain(&g.matrix));
        let [f, g] = [a.momenta(&Segment { q0: *q0, v: *v, h }), b.momenta(&Segment { q0: *q0, v: *v, h })];
        comparison.entries(f.p0.iter().chain(&f.p1), g.p0.iter().chain(&g.p1));
        worst.max(comparison.worst)
    })
}

#[test]
fn the_functions_and_their_derivatives_are_equal() {
    let worst = of_functions(&Ring { k: K }, &RingByHand { k: K });
    assert!(worst <= 1.0, "{worst} units of rounding");
}

/// How far the states after a step differ, in units of what the solver may leave.
///
/// Newton's method stops where p0 is met to some roundings, 16 · 4ε (|p0| + |J||v̄|) with J = ∂p0/∂v̄. Then
/// v̄ is off by |J⁻¹| times that, on either side, and p1 by |∂p1/∂v̄| times more. Here ∂p1/∂v̄ = 2 − J and
/// |J⁻¹| < 1.1, as h²/4 ∂²V/∂q² > −0.05.
fn of_steps<A, B>(a: &A, b: &B) -> f64
where
    A: ClosedForm<Midpoint, 2, Scalar = f64, Matrix = Matrix2<f64>>,
    B: ClosedForm<Midpoint, 2, Scalar = f64, Matrix = Matrix2<f64>>,
{
    points().iter().fold(0.0, |worst: f64, (q, v)| {
        let state = State { q: *q, p: *v };
        let [f, g] =
            [a.by(Midpoint, ring::H).step(&state).unwrap(), b.by(Midpoint, ring::H).step(&state).unwrap()];
        let j = a.step_kernel(&Segment { q0: *q, v: f.velocity, h: ring::H }).matrix.norm();
        let left = 16.0 * 4.0 * f64::EPSILON * (state.p.norm() + j * f.velocity.norm());
        let unit = (2.0 * left * 1.1 * (2.0 + j)).max(f64::MIN_POSITIVE);
        let mut comparison = Comparison { unit, worst };
        comparison.entries(f.state.q.iter().chain(&f.state.p), g.state.q.iter().chain(&g.state.p));
        comparison.worst
    })
}

#[test]
fn the_steps_are_equal() {
    let worst = of_steps(&Ring { k: K }, &RingByHand { k: K });
    assert!(worst <= 1.0, "{worst} units of what the solver leaves");
}

#[test]
fn the_discrete_objects_are_equal() {
    let worst = of_discrete_objects(&Ring { k: K }, &RingByHand { k: K });
    assert!(worst <= 1.0, "{worst} units of rounding");
}

/// The discrete objects of the macro against the midpoint rule written out for this system.
#[test]
fn the_discrete_objects_are_those_of_the_midpoint_rule() {
    let (ring, h) = (Ring { k: K }, ring::H);
    for (q0, v) in points() {
        let q1 = q0 + v * h;
        let mean = (q0 + q1) / 2.0;
        let s = mean.norm_squared();
        let slope = 2.0 * (s - 1.0) * (3.0 * s - 1.0) * mean;
        let mut comparison = Comparison::of_terms(terms(&mean, &v));

        let lagrangian = h * (0.5 * v.norm_squared() - s * (s - 1.0).powi(2));
        comparison.entries(&[ring.by(Midpoint, h).discrete_lagrangian(&q0, &q1)], &[lagrangian]);
        let rayleigh = h * h / 2.0 * 0.5 * K * v.norm_squared();
        comparison.entries(&[ring.by(Midpoint, h).discrete_rayleigh(&q0, &q1)], &[rayleigh]);
        let momenta = Fused::<Midpoint, 2>::momenta(&ring, &Segment { q0, v, h });
        comparison.entries(&momenta.p0, &(v + h / 2.0 * slope + K * h / 2.0 * v));
        comparison.entries(&momenta.p1, &(v - h / 2.0 * slope - K * h / 2.0 * v));
        assert!(comparison.worst <= 1.0, "{} units of rounding at q0 = {q0}, v = {v}", comparison.worst);
    }
}

/// Changes a derivative of L or of R.
type Mistake = fn(&mut Derivatives<f64, 2>, &mut Derivatives<f64, 2>);

/// The system by hand with one mistake.
struct Wrong {
    mistake: Mistake,
}

impl Wrong {
    const RIGHT: RingByHand = RingByHand { k: K };
}

impl Lagrangian<2> for Wrong {
    type Scalar = f64;

    fn lagrangian(&self, q: &Vector2<f64>, v: &Vector2<f64>) -> f64 {
        Self::RIGHT.lagrangian(q, v)
    }

    fn lagrangian_derivatives(&self, q: &Vector2<f64>, v: &Vector2<f64>) -> Derivatives<f64, 2> {
        let mut l = Self::RIGHT.lagrangian_derivatives(q, v);
        (self.mistake)(&mut l, &mut Derivatives::zero());
        l
    }
}

impl Rayleigh<2> for Wrong {
    fn rayleigh(&self, q: &Vector2<f64>, v: &Vector2<f64>) -> f64 {
        Self::RIGHT.rayleigh(q, v)
    }

    fn rayleigh_derivatives(&self, q: &Vector2<f64>, v: &Vector2<f64>) -> Derivatives<f64, 2> {
        let mut r = Self::RIGHT.rayleigh_derivatives(q, v);
        (self.mistake)(&mut Derivatives::zero(), &mut r);
        r
    }
}

/// Positive control: one derivative wrong by one part in 10¹⁰ is found, whichever it is.
#[test]
fn a_wrong_derivative_is_found() {
    const OFF: f64 = 1.0 + 1e-10;
    let right = Wrong { mistake: |_, _| {} };
    assert!(of_functions(&Ring { k: K }, &right) <= 1.0);
    let mistakes: [Mistake; 6] = [
        |l, _| l.d1 *= OFF,
        |l, _| l.d2 *= OFF,
        |l, _| l.d11 *= OFF,
        |l, _| l.d22 *= OFF,
        |_, r| r.d2 *= OFF,
        |_, r| r.d22 *= OFF,
    ];
    for (index, mistake) in mistakes.into_iter().enumerate() {
        let worst = of_functions(&Ring { k: K }, &Wrong { mistake });
        assert!(worst > 1.0, "mistake {index} passed: {worst} units of rounding");
    }
}

/// Positive control: a drag wrong by one part in 10⁹ is found in the discrete objects and after a step.
#[test]
fn a_wrong_drag_is_found() {
    let (wrong, right) = (Ring { k: K * (1.0 + 1e-9) }, RingByHand { k: K });
    let worst = of_discrete_objects(&wrong, &right);
    assert!(worst > 1.0, "discrete objects: {worst} units of rounding");
    let worst = of_steps(&wrong, &right);
    assert!(worst > 1.0, "steps: {worst} units of what the solver leaves");
}
