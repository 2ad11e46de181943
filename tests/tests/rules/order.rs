//! Both rules are of order 2 in q and in p, also where masses, friction and force depend on q.
//!
//! Reference: another method (Dormand–Prince 8(5,3)) on accelerations derived on paper.

use dalembert::nalgebra::{SMatrix, SVector};
use dalembert::rules::DisplacementRule;
use dalembert::rules::SolvedForVelocity;
use dalembert::run::VelocityHistory;
use dalembert::step::{ClosedForm, Fused, Momenta, Segment, StepKernel};
use dalembert::system::{ActingForce, Derivatives};
use dalembert::{Discrete, Discretise, Lagrangian, Midpoint, Rayleigh, State, Trapezoidal};
use dalembert_tests::by_hand::ByHand;
use dalembert_tests::convergence::Convergence;
use dalembert_tests::reference;
use dalembert_tests::systems::{Bead, Chain, Charge, DoublePendulum, Follower, Pendulum, SITES};

/// Errors below this are rounding and the reference's.
const PLATEAU: f64 = 1e-10;

/// Observed orders in q and in p at `time`, over steps from time/16 to time/1024.
fn orders<S, L, R, const N: usize>(
    reference: &S,
    system: &L,
    rule: R,
    q: [f64; N],
    v: [f64; N],
    time: f64,
) -> [f64; 2]
where
    S: ByHand<N>,
    L: Discrete<R, N, Scalar = f64>,
    R: Copy,
{
    let (q_end, v_end) = reference::motion(reference, q, v, time);
    let p_end = reference.momentum(q_end, v_end);
    let start = State { q: q.into(), p: reference.momentum(q, v) };
    let (mut in_q, mut in_p) = (Convergence::default(), Convergence::default());
    for steps in [16, 32, 64, 128, 256, 512, 1024] {
        let h = time / f64::from(steps);
        let mut trajectory = system.by(rule, h).run(start);
        let last = trajectory.by_ref().take(steps as usize).last().unwrap().unwrap().state;
        in_q.push(h, (last.q - SVector::from(q_end)).norm());
        in_p.push(h, (last.p - p_end).norm());
    }
    [in_q.order(PLATEAU), in_p.order(PLATEAU)]
}

fn assert_order_2<S, R, const N: usize>(system: &S, rule: R, q: [f64; N], v: [f64; N])
where
    S: ByHand<N> + Discrete<R, N, Scalar = f64>,
    R: Copy,
{
    for (order, of) in orders(system, system, rule, q, v, 1.5).into_iter().zip(["q", "p"]) {
        assert!((order - 2.0).abs() <= 0.05, "order {order:.3} in {of}");
    }
}

macro_rules! order_2 {
    ($($name:ident: $system:expr, $q:expr, $v:expr;)*) => {$(
        mod $name {
            use super::*;

            #[test]
            fn midpoint() {
                assert_order_2(&$system, Midpoint, $q, $v);
            }

            #[test]
            fn trapezoidal() {
                assert_order_2(&$system, Trapezoidal, $q, $v);
            }
        }
    )*};
}
order_2! {
    pendulum: Pendulum::EXAMPLE, [1.9], [-0.7];
    bead_with_mass_and_friction_that_depend_on_q: Bead::EXAMPLE, [0.8], [1.3];
    double_pendulum: DoublePendulum::EXAMPLE, [1.1, -0.6], [0.3, 1.2];
    charge_with_friction_and_general_force: Charge::EXAMPLE, [0.9, -0.4, 0.6], [0.2, 1.1, -0.7];
    follower_with_general_force_alone: Follower::EXAMPLE, [0.6, -0.9], [0.8, 0.5];
    chain: Chain::EXAMPLE, [0.5, -0.2, 0.7, 0.1, -0.6], [0.0, 0.9, -0.3, 0.4, 0.2];
}

/// Positive controls: discretisations that are wrong in one place, from the same terms.
mod wrong {
    use super::*;

    /// A system whose Rayleigh function enters wrongly.
    struct Altered<S>(S);

    impl<S: Lagrangian<N, Scalar = f64>, const N: usize> Lagrangian<N> for Altered<S> {
        type Scalar = f64;

        fn lagrangian(&self, q: &SVector<f64, N>, v: &SVector<f64, N>) -> f64 {
            self.0.lagrangian(q, v)
        }

        fn lagrangian_derivatives(&self, q: &SVector<f64, N>, v: &SVector<f64, N>) -> Derivatives<f64, N> {
            self.0.lagrangian_derivatives(q, v)
        }
    }

    /// The midpoint rule with R's share of p0 and of p1 multiplied by what `factors` gives.
    trait Alteration: Copy {
        fn factors(h: f64) -> [f64; 2];
    }

    /// R_d = (h/2) R, as the paper prints it: 1/h times what it should be.
    #[derive(Clone, Copy)]
    struct Printed;
    impl Alteration for Printed {
        fn factors(h: f64) -> [f64; 2] {
            [1.0 / h, 1.0 / h]
        }
    }

    /// The whole force at q0, none at q1: f_d⁺ = 0.
    #[derive(Clone, Copy)]
    struct OneSided;
    impl Alteration for OneSided {
        fn factors(_: f64) -> [f64; 2] {
            [2.0, 0.0]
        }
    }

    /// Nothing altered: shows that the alterations are what loses the order.
    #[derive(Clone, Copy)]
    struct Unaltered;
    impl Alteration for Unaltered {
        fn factors(_: f64) -> [f64; 2] {
            [1.0, 1.0]
        }
    }

    /// The rule that is altered.
    #[derive(Clone, Copy)]
    struct By<A>(A);

    impl<A> SolvedForVelocity for By<A> {}

    impl<S: Lagrangian<N, Scalar = f64>, const N: usize> ActingForce<N> for Altered<S> {}

    impl<S, A: Alteration, const N: usize> Fused<By<A>, N> for Altered<S>
    where
        S: Rayleigh<N, Scalar = f64>,
    {
        type Matrix = SMatrix<f64, N, N>;
        type Memory = VelocityHistory<f64, N>;
        type Border = dalembert::step::Free;

        fn step_kernel(&self, segment: &Segment<f64, N>) -> StepKernel<f64, N> {
            Midpoint::lagrangian_kernel(&self.0, segment)
                + Midpoint::rayleigh_kernel(&self.0, segment) * A::factors(segment.h)[0]
        }

        fn momenta(&self, segment: &Segment<f64, N>) -> Momenta<f64, N> {
            let r = Midpoint::rayleigh_momenta(&self.0, segment);
            let [minus, plus] = A::factors(segment.h);
            Midpoint::lagrangian_momenta(&self.0, segment) + Momenta { p0: r.p0 * minus, p1: r.p1 * plus }
        }
    }

    impl<S, A: Alteration, const N: usize> ClosedForm<By<A>, N> for Altered<S>
    where
        S: Rayleigh<N, Scalar = f64>,
    {
        fn discrete_lagrangian(&self, segment: &Segment<f64, N>) -> f64 {
            Midpoint::discrete_lagrangian(&self.0, segment)
        }

        fn discrete_lagrangian_derivatives(&self, segment: &Segment<f64, N>) -> Derivatives<f64, N> {
            Midpoint::discrete_lagrangian_derivatives(&self.0, segment)
        }

        fn segment_energy(&self, segment: &Segment<f64, N>) -> f64 {
            Midpoint::segment_energy(&self.0, segment)
        }
    }

    fn pendulum<A: Alteration>(rule: A) -> [f64; 2] {
        orders(&Pendulum::EXAMPLE, &Altered(Pendulum::EXAMPLE), By(rule), [1.9], [-0.7], 1.5)
    }

    fn bead<A: Alteration>(rule: A) -> [f64; 2] {
        orders(&Bead::EXAMPLE, &Altered(Bead::EXAMPLE), By(rule), [0.8], [1.3], 1.5)
    }

    #[test]
    fn the_printed_rayleigh_function_loses_all_order() {
        for order in [pendulum(Printed), bead(Printed)].as_flattened() {
            assert!(*order < 0.5, "{order}");
        }
    }

    #[test]
    fn a_one_sided_force_is_of_order_1() {
        for order in [pendulum(OneSided), bead(OneSided)].as_flattened() {
            assert!((order - 1.0).abs() < 0.1, "{order}");
        }
    }

    #[test]
    fn unaltered_they_are_of_order_2() {
        for order in [pendulum(Unaltered), bead(Unaltered)].as_flattened() {
            assert!((order - 2.0).abs() <= 0.05, "{order}");
        }
    }
}

/// The hand-derived accelerations agree with the Euler–Lagrange equations of the hand-written L, R and f, so
/// that the reference integrates the system that it should.
#[test]
fn accelerations_derived_on_paper_solve_the_equations_of_motion() {
    use dalembert_tests::by_hand::{Continuous, Part, derivatives};

    fn defect<S: ByHand<N>, const N: usize>(system: &S, q: [f64; N], v: [f64; N]) -> f64 {
        let l = derivatives(&Continuous { system, part: Part::Lagrangian }, q, v);
        let r = derivatives(&Continuous { system, part: Part::Rayleigh }, q, v);
        let f = SVector::from(system.force_by_hand(q, v));
        let a = SVector::from(system.acceleration(q, v));
        (l.d22 * a + l.d12.transpose() * SVector::from(v) - l.d1 + r.d2 - f).amax() / (l.d22 * a).amax()
    }

    let chain = ([0.5, -0.2, 0.7, 0.1, -0.6], [0.0, 0.9, -0.3, 0.4, 0.2]);
    let defects = [
        defect(&Pendulum::EXAMPLE, [1.9], [-0.7]),
        defect(&Bead::EXAMPLE, [0.8], [1.3]),
        defect(&DoublePendulum::EXAMPLE, [1.1, -0.6], [0.3, 1.2]),
        defect(&Charge::EXAMPLE, [0.9, -0.4, 0.6], [0.2, 1.1, -0.7]),
        defect(&Follower::EXAMPLE, [0.6, -0.9], [0.8, 0.5]),
        defect::<_, SITES>(&Chain::EXAMPLE, chain.0, chain.1),
    ];
    assert!(defects.iter().all(|defect| *defect < 1e-14), "{defects:?}");
}
