//! Generated derivatives agree with num-dual called directly on L_d, R_d and f_d written by hand, and those
//! agree with central differences. N = 1, 2, 3, and an N given by a constant.

use dalembert::nalgebra::{SMatrix, SVector};
use dalembert::step::{ClosedForm, DiscreteRayleigh, NewtonMatrix, Segment};
use dalembert::system::{Derivatives, Direction};
use dalembert::{Discretise, Force, Midpoint, Rayleigh, Trapezoidal};
use dalembert_tests::by_hand::{ByHand, Continuous, Discretised, Part, Rule, TwoPoints, derivatives};
use dalembert_tests::systems::{Bead, Chain, Charge, DoublePendulum, Follower, FreePendulum, Pendulum};

/// Both sides are exact but for rounding; their terms differ in order and cancel (m/h against h V″).
const ROUNDING: f64 = 200.0 * f64::EPSILON;

const H: f64 = 0.23;

/// The largest of some errors; NaN if one of them is.
fn largest(errors: impl IntoIterator<Item = f64>) -> f64 {
    errors.into_iter().fold(0.0, |most, error| if most.is_nan() || error <= most { most } else { error })
}

/// Largest deviation of `a` from `b`, in units of `b`'s largest entry.
fn deviation<const M: usize, const N: usize>(a: &SMatrix<f64, M, N>, b: &SMatrix<f64, M, N>) -> f64 {
    let difference = largest((a - b).abs().iter().copied());
    if difference == 0.0 { 0.0 } else { difference / b.amax() }
}

/// The same over value and all derivatives.
fn deviation_of<const N: usize>(a: &Derivatives<f64, N>, b: &Derivatives<f64, N>) -> f64 {
    let value = if a.value == b.value { 0.0 } else { ((a.value - b.value) / b.value).abs() };
    largest([
        value,
        deviation(&a.d1, &b.d1),
        deviation(&a.d2, &b.d2),
        deviation(&a.d11, &b.d11),
        deviation(&a.d12, &b.d12),
        deviation(&a.d22, &b.d22),
    ])
}

fn assert_same<const N: usize>(what: &str, generated: &Derivatives<f64, N>, by_hand: &Derivatives<f64, N>) {
    let deviation = deviation_of(generated, by_hand);
    assert!(deviation <= ROUNDING, "{what}: {deviation:e}\n{generated:?}\n{by_hand:?}");
}

fn assert_same_matrix<const M: usize, const N: usize>(
    what: &str,
    generated: &SMatrix<f64, M, N>,
    by_hand: &SMatrix<f64, M, N>,
) {
    let deviation = deviation(generated, by_hand);
    assert!(deviation <= ROUNDING, "{what}: {deviation:e}{generated}{by_hand}");
}

/// f_d with D1 and D2, by hand: R's part from the derivatives of R_d, the general force by component.
struct ForceByHand<const N: usize> {
    minus: [SMatrix<f64, N, N>; 2],
    plus: [SMatrix<f64, N, N>; 2],
    values: [SVector<f64, N>; 2],
}

fn force_by_hand<S: ByHand<N>, const N: usize>(
    system: &S,
    rule: Rule,
    q0: [f64; N],
    q1: [f64; N],
) -> ForceByHand<N> {
    let of = |part| derivatives(&Discretised { system, rule, h: H, part }, q0, q1);
    let r = of(Part::Rayleigh);
    let minus: [_; N] = std::array::from_fn(|i| of(Part::ForceMinus(i)));
    let plus: [_; N] = std::array::from_fn(|i| of(Part::ForcePlus(i)));
    ForceByHand {
        minus: [
            SMatrix::from_fn(|i, j| minus[i].d1[j]) + r.d11,
            SMatrix::from_fn(|i, j| minus[i].d2[j]) + r.d12,
        ],
        plus: [
            SMatrix::from_fn(|i, j| plus[i].d1[j]) - r.d12.transpose(),
            SMatrix::from_fn(|i, j| plus[i].d2[j]) - r.d22,
        ],
        values: [
            SVector::from_fn(|i, _| minus[i].value) + r.d1,
            SVector::from_fn(|i, _| plus[i].value) - r.d2,
        ],
    }
}

/// What every discretised system has.
fn check_discrete<S, R, const N: usize>(system: &S, rule: Rule, q0: [f64; N], q1: [f64; N])
where
    S: ByHand<N> + ClosedForm<R, N, Scalar = f64>,
{
    let (a, b) = (&SVector::from(q0), &SVector::from(q1));
    let l = derivatives(&Discretised { system, rule, h: H, part: Part::Lagrangian }, q0, q1);
    assert_same("L_d", &system.discrete_lagrangian_derivatives(&Segment::between(a, b, H)), &l);
    let value = system.discrete_lagrangian(&Segment::between(a, b, H));
    assert!((value - l.value).abs() <= ROUNDING * l.value.abs(), "L_d alone: {value}, {}", l.value);

    let force = force_by_hand(system, rule, q0, q1);
    let generated = system.discrete_force_derivatives(&Segment::between(a, b, H));
    assert_same_matrix("f_d⁻", &generated.minus.value, &force.values[0]);
    assert_same_matrix("D1 f_d⁻", &generated.minus.d1, &force.minus[0]);
    assert_same_matrix("D2 f_d⁻", &generated.minus.d2, &force.minus[1]);
    assert_same_matrix("f_d⁺", &generated.plus.value, &force.values[1]);
    assert_same_matrix("D1 f_d⁺", &generated.plus.d1, &force.plus[0]);
    assert_same_matrix("D2 f_d⁺", &generated.plus.d2, &force.plus[1]);
    assert_same_matrix(
        "f_d⁻ alone",
        &system.discrete_force(&Segment::between(a, b, H)).minus,
        &force.values[0],
    );
    assert_same_matrix(
        "f_d⁺ alone",
        &system.discrete_force(&Segment::between(a, b, H)).plus,
        &force.values[1],
    );

    // Momenta and Newton matrix: p0 = −D1 L_d − f_d⁻, p1 = D2 L_d + f_d⁺, ∂p0/∂v̄ = h ∂p0/∂q1.
    let p0 = -l.d1 - force.values[0];
    let p1 = l.d2 + force.values[1];
    let v = (b - a) / H;
    let momenta = system.momenta(&Segment { q0: *a, v, h: H });
    assert_same_matrix("p0", &momenta.p0, &p0);
    assert_same_matrix("p1", &momenta.p1, &p1);
    let kernel = system.step_kernel(&Segment { q0: *a, v, h: H });
    assert_same_matrix("p0 of the kernel", &kernel.p0, &p0);
    assert_same_matrix("Newton matrix", &kernel.matrix.dense(), &(-(l.d12 + force.minus[1]) * H));

    // The continuous system, which all of this is made from.
    let continuous = derivatives(&Continuous { system, part: Part::Lagrangian }, q0, q1);
    assert_same("L", &system.lagrangian_derivatives(a, b), &continuous);
    let gradient = system.lagrangian_gradient(a, b);
    assert_same_matrix("∂L/∂q", &gradient.d1, &continuous.d1);
    assert_same_matrix("∂L/∂v", &gradient.d2, &continuous.d2);
    let (minus, plus) = (Direction { first: -0.7, second: 1.3 }, Direction { first: 0.4, second: 0.9 });
    let variations = system.lagrangian_variations(a, b, minus, plus);
    assert_same_matrix("L along minus", &variations.minus, &(continuous.d1 * -0.7 + continuous.d2 * 1.3));
    assert_same_matrix("L along plus", &variations.plus, &(continuous.d1 * 0.4 + continuous.d2 * 0.9));
    let mixed = continuous.d11 * (-0.7 * 0.4)
        + continuous.d12 * (-0.7 * 0.9)
        + continuous.d12.transpose() * (1.3 * 0.4)
        + continuous.d22 * (1.3 * 0.9);
    assert_same_matrix("L along both", &variations.mixed, &mixed);
    let energy = b.dot(&continuous.d2) - continuous.value;
    assert!((system.energy(a, b) - energy).abs() <= ROUNDING * energy.abs().max(continuous.value.abs()));
}

/// What systems with R have besides.
fn check_rayleigh<S, R, const N: usize>(system: &S, rule: Rule, q0: [f64; N], q1: [f64; N])
where
    S: ByHand<N> + DiscreteRayleigh<R, N, Scalar = f64>,
{
    let (a, b) = (&SVector::from(q0), &SVector::from(q1));
    let of = |part| derivatives(&Discretised { system, rule, h: H, part }, q0, q1);
    let (r, plus, minus) = (of(Part::Rayleigh), of(Part::Plus), of(Part::Minus));
    assert_same("R_d", &system.discrete_rayleigh_derivatives(&Segment::between(a, b, H)), &r);
    assert_same("L_d⁺", &system.modified_plus_derivatives(&Segment::between(a, b, H)), &plus);
    assert_same("L_d⁻", &system.modified_minus_derivatives(&Segment::between(a, b, H)), &minus);
    for (value, by_hand) in [
        (system.discrete_rayleigh(&Segment::between(a, b, H)), r.value),
        (system.modified_plus(&Segment::between(a, b, H)), plus.value),
        (system.modified_minus(&Segment::between(a, b, H)), minus.value),
    ] {
        assert!((value - by_hand).abs() <= ROUNDING * by_hand.abs().max(r.value.abs()), "{value}, {by_hand}");
    }

    let continuous = derivatives(&Continuous { system, part: Part::Rayleigh }, q0, q1);
    assert_same("R", &system.rayleigh_derivatives(a, b), &continuous);
    let gradient = system.rayleigh_gradient(a, b);
    assert_same_matrix("∂R/∂q", &gradient.d1, &continuous.d1);
    assert_same_matrix("∂R/∂v", &gradient.d2, &continuous.d2);
    let (minus, plus) = (Direction { first: -0.7, second: 1.3 }, Direction { first: 0.4, second: 0.9 });
    let generated = Rayleigh::rayleigh_variations(system, a, b, minus, plus);
    let expected = system.rayleigh_derivatives(a, b).variations(minus, plus);
    assert_same_matrix("R along minus", &generated.minus, &expected.minus);
    assert_same_matrix("R along plus", &generated.plus, &expected.plus);
    assert_same_matrix("R along both", &generated.mixed, &expected.mixed);
}

/// What systems with a general force have besides.
fn check_force<S: ByHand<N> + Force<N, Scalar = f64>, const N: usize>(system: &S, q: [f64; N], v: [f64; N]) {
    let (a, b) = (&SVector::from(q), &SVector::from(v));
    let components: [_; N] =
        std::array::from_fn(|i| derivatives(&Continuous { system, part: Part::ForceMinus(i) }, q, v));
    let value = SVector::from_fn(|i, _| components[i].value);
    let by_q = SMatrix::from_fn(|i, j| components[i].d1[j]);
    let by_v = SMatrix::from_fn(|i, j| components[i].d2[j]);
    let generated = system.force_derivatives(a, b);
    assert_same_matrix("f", &system.force(a, b), &value);
    assert_same_matrix("f with derivatives", &generated.value, &value);
    assert_same_matrix("∂f/∂q", &generated.d1, &by_q);
    assert_same_matrix("∂f/∂v", &generated.d2, &by_v);
    let (varied, along) = system.force_variation(a, b, Direction { first: 0.4, second: 0.9 });
    assert_same_matrix("f of the variation", &varied, &value);
    assert_same_matrix("f along", &along, &(by_q * 0.4 + by_v * 0.9));
}

macro_rules! both_rules {
    ($check:ident, $system:expr, $q0:expr, $q1:expr) => {
        $check::<_, Midpoint, _>($system, Rule::Midpoint, $q0, $q1);
        $check::<_, Trapezoidal, _>($system, Rule::Trapezoidal, $q0, $q1);
    };
}

#[test]
fn of_one_degree_of_freedom() {
    both_rules!(check_discrete, &Pendulum::EXAMPLE, [0.7], [1.1]);
    both_rules!(check_rayleigh, &Pendulum::EXAMPLE, [0.7], [1.1]);
    both_rules!(check_discrete, &Bead::EXAMPLE, [0.7], [0.4]);
    both_rules!(check_rayleigh, &Bead::EXAMPLE, [0.7], [0.4]);
}

#[test]
fn of_two_degrees_of_freedom() {
    both_rules!(check_discrete, &DoublePendulum::EXAMPLE, [0.7, -0.3], [1.1, 0.2]);
    both_rules!(check_rayleigh, &DoublePendulum::EXAMPLE, [0.7, -0.3], [1.1, 0.2]);
    both_rules!(check_discrete, &Follower::EXAMPLE, [0.7, -0.3], [1.1, 0.2]);
    check_force(&Follower::EXAMPLE, [0.7, -0.3], [1.1, 0.2]);
}

#[test]
fn of_three_degrees_of_freedom() {
    both_rules!(check_discrete, &Charge::EXAMPLE, [0.7, -0.3, 0.5], [0.9, 0.2, 0.3]);
    both_rules!(check_rayleigh, &Charge::EXAMPLE, [0.7, -0.3, 0.5], [0.9, 0.2, 0.3]);
    check_force(&Charge::EXAMPLE, [0.7, -0.3, 0.5], [0.9, 0.2, 0.3]);
}

#[test]
fn of_a_constant_number_of_degrees_of_freedom() {
    let (q0, q1) = ([0.5, -0.2, 0.7, 0.1, -0.6], [0.4, 0.1, 0.5, 0.3, -0.2]);
    both_rules!(check_discrete, &Chain::EXAMPLE, q0, q1);
    both_rules!(check_rayleigh, &Chain::EXAMPLE, q0, q1);
}

#[test]
fn of_a_free_function() {
    both_rules!(check_discrete, &FreePendulum { m: 1.3, g: 2.1 }, [0.7], [1.1]);
}

/// Positive control: another rule, or one part in 10¹¹ of one coefficient, is seen.
#[test]
fn the_comparison_sees_what_is_wrong() {
    let (q0, q1) = ([0.7], [0.4]);
    let system = Bead::EXAMPLE;
    let segment = system.by(Midpoint, H).segment(&q0.into(), &q1.into()).unwrap();
    let generated = segment.discrete_lagrangian_derivatives().unwrap();
    let by_hand = |system: &Bead, rule| {
        derivatives(&Discretised { system, rule, h: H, part: Part::Lagrangian }, q0, q1)
    };
    assert!(deviation_of(&generated, &by_hand(&system, Rule::Midpoint)) <= ROUNDING);
    assert!(deviation_of(&generated, &by_hand(&system, Rule::Trapezoidal)) > 1e-3);
    let other = Bead { m: system.m * (1.0 + 1e-11), ..system };
    assert!(deviation_of(&generated, &by_hand(&other, Rule::Midpoint)) > ROUNDING);
    let wrong = Derivatives { value: f64::NAN, d11: generated.d11 * f64::NAN, ..generated };
    assert!(deviation_of(&wrong, &by_hand(&system, Rule::Midpoint)).is_nan());
}

/// Central differences of a function, with a bound of their error.
mod differences {
    use super::*;

    /// Estimate and error bound.
    #[derive(Clone, Copy, Debug)]
    struct Bounded {
        value: f64,
        error: f64,
    }

    impl Bounded {
        /// From the differences at step δ and 2δ, their truncation errors cδ² + O(δ⁴) and 4cδ² + O(δ⁴): the
        /// difference of the two is 3cδ², three times the error, which leaves room for O(δ⁴).
        /// `rounding` bounds that of the quotient.
        fn of(at_step: f64, at_double: f64, rounding: f64) -> Self {
            Self { value: at_step, error: (at_double - at_step).abs() + rounding }
        }

        /// How far `exact` is off, in units of the bound.
        fn units(self, exact: f64) -> f64 {
            let off = (self.value - exact).abs();
            if off == 0.0 { 0.0 } else { off / self.error }
        }
    }

    /// Largest deviation of `derivatives` from central differences of `f`, in units of the differences' error
    /// bound.
    fn deviation<F: TwoPoints<N>, const N: usize>(
        f: &F,
        x: [f64; N],
        y: [f64; N],
        exact: &Derivatives<f64, N>,
    ) -> f64 {
        let moved = |a: usize, by_a: f64, b: usize, by_b: f64| {
            let (mut x, mut y) = (x, y);
            for (index, by) in [(a, by_a), (b, by_b)] {
                if index < N { x[index] += by } else { y[index - N] += by }
            }
            f.at(x, y)
        };
        // Terms of f are up to this large where f itself cancels; each evaluation rounds a few dozen times.
        let magnitude = exact.value.abs() + exact.d1.amax() + exact.d2.amax() + exact.d11.amax();
        let noise = 64.0 * f64::EPSILON * magnitude;

        let first = |a: usize| {
            let step = 1e-5;
            let quotient = |d: f64| (moved(a, d, a, 0.0) - moved(a, -d, a, 0.0)) / (2.0 * d);
            Bounded::of(quotient(step), quotient(2.0 * step), noise / step)
        };
        let second = |a: usize, b: usize| {
            let step = 3e-4;
            let quotient = |d: f64| {
                (moved(a, d, b, d) - moved(a, d, b, -d) - moved(a, -d, b, d) + moved(a, -d, b, -d))
                    / (4.0 * d * d)
            };
            Bounded::of(quotient(step), quotient(2.0 * step), noise / (step * step))
        };
        let firsts = (0..N).flat_map(|i| [first(i).units(exact.d1[i]), first(N + i).units(exact.d2[i])]);
        let seconds = (0..N * N).flat_map(|k| {
            let (i, j) = (k / N, k % N);
            [
                second(i, j).units(exact.d11[(i, j)]),
                second(i, N + j).units(exact.d12[(i, j)]),
                second(N + i, N + j).units(exact.d22[(i, j)]),
            ]
        });
        largest(firsts.chain(seconds))
    }

    fn check<S: ByHand<N>, const N: usize>(system: &S, q0: [f64; N], q1: [f64; N]) {
        for rule in [Rule::Midpoint, Rule::Trapezoidal] {
            for part in [Part::Lagrangian, Part::Rayleigh, Part::ForceMinus(0), Part::ForcePlus(N - 1)] {
                let f = Discretised { system, rule, h: H, part };
                let exact = derivatives(&f, q0, q1);
                let units = deviation(&f, q0, q1, &exact);
                assert!(units <= 1.0, "{rule:?} {part:?}: {units} bounds");
            }
        }
    }

    #[test]
    fn agree_with_num_dual() {
        check(&Pendulum::EXAMPLE, [0.7], [1.1]);
        check(&Bead::EXAMPLE, [0.7], [0.4]);
        check(&DoublePendulum::EXAMPLE, [0.7, -0.3], [1.1, 0.2]);
        check(&Follower::EXAMPLE, [0.7, -0.3], [1.1, 0.2]);
        check(&Charge::EXAMPLE, [0.7, -0.3, 0.5], [0.9, 0.2, 0.3]);
        check(&Chain::EXAMPLE, [0.5, -0.2, 0.7, 0.1, -0.6], [0.4, 0.1, 0.5, 0.3, -0.2]);
    }

    /// Positive control: the bound is tight enough to see one part in 10⁶ of the first and of the second
    /// derivatives.
    #[test]
    fn see_what_is_wrong() {
        let f = Discretised { system: &Bead::EXAMPLE, rule: Rule::Midpoint, h: H, part: Part::Lagrangian };
        let exact = derivatives(&f, [0.7], [0.4]);
        let off = 1.0 + 1e-6;
        let not_a_number = exact.d22 * f64::NAN;
        for wrong in [
            Derivatives { d22: not_a_number, ..exact },
            Derivatives { d1: exact.d1 * off, ..exact },
            Derivatives { d2: exact.d2 * off, ..exact },
            Derivatives { d11: exact.d11 * off, ..exact },
            Derivatives { d12: exact.d12 * off, ..exact },
            Derivatives { d22: exact.d22 * off, ..exact },
        ] {
            let units = deviation(&f, [0.7], [0.4], &wrong);
            assert!(units.is_nan() || units > 1.0, "{units}");
        }
    }
}
