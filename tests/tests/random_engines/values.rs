//! The values of L, R and f as generated are those of the functions as written, bit by bit, at whatever
//! optimisation level the two are compiled: `--config 'profile.test.package.dalembert-tests.opt-level=0'` and
//! the like. Their slopes are not refuted by differences of the functions as written, and are where they are
//! those of another system. The momenta of their steps are those of L_d and f_d.

use dalembert::rules::SolvedForVelocity;
use dalembert::run::VelocityHistory;
use dalembert::step::{ClosedForm, DiscreteForce, Flow, Fused, Momenta, Segment, StepKernel};
use dalembert::system::{ActingForce, Derivatives, Structure, verification};
use dalembert::{Lagrangian, Midpoint, State, StepError};
use nalgebra::SVector;

use super::{Spread, expanded, generator, num_dual};

/// `verify_generated` at a point, q, v and the coefficients, and what a run verifies that starts at
/// (q, p = v), by both engines; and the momenta of its step by the midpoint rule.
type Verify = fn(&[f64]) -> [Result<(), StepError>; 5];

macro_rules! verify {
    ($name:ident, $n:literal, [$($rayleigh:ident)?], [$($force:ident)?]) => {
        ($n, |at| {
            let c = std::array::from_fn(|k| at[2 * $n + k]);
            let (q, v) = (SVector::from_fn(|i, _| at[i]), SVector::from_fn(|i, _| at[$n + i]));
            let (expanded, num_dual) = (expanded::$name { c }, num_dual::$name { c });
            let state = State { q, p: v };
            [
                expanded.verify_generated(&q, &v).map_err(StepError::from),
                state.verify(&expanded),
                num_dual.verify_generated(&q, &v).map_err(StepError::from),
                state.verify(&num_dual),
                Flow::<Midpoint, $n>::verify_momenta(&expanded, &state, step_size(at))
                    .map_err(StepError::from),
            ]
        })
    };
}

fn every_verification() -> [(usize, Verify); generator::SYSTEMS] {
    every_system!(verify)
}

/// One of many step sizes, as the last places of the point have it.
fn step_size(at: &[f64]) -> f64 {
    const SIZES: [f64; 12] = [1e-9, 1e-6, 1e-4, 1e-3, 0.01, 0.1, 0.3, -0.1, 1.0, 10.0, 1e3, 1e-300];
    let bits = at.iter().fold(0_u64, |bits, x| bits.rotate_left(7) ^ x.to_bits());
    SIZES[(bits.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32) as usize % SIZES.len()]
}

/// Numbers at which operations are special.
const SPECIAL: [f64; 16] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    -2.0,
    1e-300,
    -1e-300,
    1e300,
    -1e300,
    5e-324,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
    f64::MIN_POSITIVE,
    -0.75,
];

#[test]
fn generated_values_are_those_written_to_the_bit() {
    let (mut tried, rounds) = (0, if cfg!(debug_assertions) { 160 } else { 400 });
    for (index, (n, verify)) in every_verification().into_iter().enumerate() {
        let mut random = Spread(1000 + index as u64);
        for round in 0..rounds {
            let mut point = random.point(n);
            if round >= rounds / 4 {
                // One to all of q, v and the coefficients at special values.
                let share = 0.25 * f64::from(1 + round % 4);
                for x in &mut point {
                    if random.next() < share {
                        *x = SPECIAL[(random.next() * SPECIAL.len() as f64) as usize];
                    }
                }
            }
            let mut verdict = verify(&point);
            // The sine of 1e300 q is no function that differences could follow.
            if point.iter().any(|x| x.abs() > 1e9) {
                (verdict[1], verdict[3]) = (Ok(()), Ok(()));
            }
            assert!(verdict.iter().all(Result::is_ok), "System{index} at {point:?}: {verdict:?}");
            tried += 1;
        }
    }
    println!("{tried} points of {} systems", generator::SYSTEMS);
}

/// A system with the derivatives of another.
struct Mixed<S> {
    written: S,
    derivatives: S,
}

impl<S: Lagrangian<N>, const N: usize> Lagrangian<N> for Mixed<S> {
    type Scalar = S::Scalar;

    const STRUCTURE: Structure = S::STRUCTURE;

    fn lagrangian(&self, q: &SVector<S::Scalar, N>, v: &SVector<S::Scalar, N>) -> S::Scalar {
        self.written.lagrangian(q, v)
    }

    fn lagrangian_derivatives(
        &self,
        q: &SVector<S::Scalar, N>,
        v: &SVector<S::Scalar, N>,
    ) -> Derivatives<S::Scalar, N> {
        self.derivatives.lagrangian_derivatives(q, v)
    }
}

/// A rule whose discrete objects are those of the one, and its equation and momenta of the other.
struct Apart;

impl SolvedForVelocity for Apart {}

impl<S: Lagrangian<N>, const N: usize> ActingForce<N> for Mixed<S> {}

impl<S: ClosedForm<Midpoint, N>, const N: usize> Fused<Apart, N> for Mixed<S> {
    type Matrix = S::Matrix;
    type Memory = VelocityHistory<S::Scalar, N>;
    type Border = dalembert::step::Free;

    const WRITTEN_OUT: bool = true;

    fn step_kernel(&self, segment: &Segment<S::Scalar, N>) -> StepKernel<S::Scalar, N, S::Matrix> {
        self.derivatives.step_kernel(segment)
    }

    fn momenta(&self, segment: &Segment<S::Scalar, N>) -> Momenta<S::Scalar, N> {
        self.derivatives.momenta(segment)
    }
}

impl<S: ClosedForm<Midpoint, N>, const N: usize> ClosedForm<Apart, N> for Mixed<S> {
    fn discrete_lagrangian(&self, segment: &Segment<S::Scalar, N>) -> S::Scalar {
        self.written.discrete_lagrangian(segment)
    }

    fn discrete_lagrangian_derivatives(&self, segment: &Segment<S::Scalar, N>) -> Derivatives<S::Scalar, N> {
        self.written.discrete_lagrangian_derivatives(segment)
    }

    fn discrete_force(&self, segment: &Segment<S::Scalar, N>) -> DiscreteForce<S::Scalar, N> {
        self.written.discrete_force(segment)
    }

    fn segment_energy(&self, segment: &Segment<S::Scalar, N>) -> S::Scalar {
        self.written.segment_energy(segment)
    }
}

/// Whether slopes refute the derivatives of a system that has its coefficients changed by so much, and the
/// derivatives of L_d and f_d the momenta of a step.
type Refute = fn(&[f64], f64) -> [bool; 2];

macro_rules! refute {
    ($name:ident, $n:literal, [$($rayleigh:ident)?], [$($force:ident)?]) => {
        ($n, |at, change| {
            let c = std::array::from_fn(|k| at[2 * $n + k]);
            let (q, v) = (SVector::from_fn(|i, _| at[i]), SVector::from_fn(|i, _| at[$n + i]));
            let (written, derivatives) =
                (expanded::$name { c }, expanded::$name { c: c.map(|c| c * (1.0 + change)) });
            let mixed = Mixed { written, derivatives };
            [
                verification::lagrangian_slope(&mixed, &q, &v).is_err(),
                Flow::<Apart, $n>::verify_momenta(&mixed, &State { q, p: v }, 0.1).is_err(),
            ]
        })
    };
}

/// The control, and what slopes can tell: coefficients that are off by a share.
#[test]
fn derivatives_of_another_system_are_refuted() {
    let systems: [(usize, Refute); generator::SYSTEMS] = every_system!(refute);
    let told = |change: f64| {
        let mut told = [0, 0];
        for (index, &(n, refute)) in systems.iter().enumerate() {
            let mut random = Spread(2000 + index as u64);
            for _ in 0..20 {
                let refuted = refute(&random.point(n), change);
                told = [0, 1].map(|i| told[i] + usize::from(refuted[i]));
            }
        }
        told
    };
    let told = [0.0, 1e-4, 1e-2, 0.5].map(told);
    println!(
        "coefficients off by 0, 1e-4, 0.01 and a half: slopes and momenta refute {told:?} of 1000 points"
    );
    assert_eq!(told[0], [0, 0]);
    assert!(told[2][0] > 800 && told[3][0] > 900 && told[2][1] > 900 && told[3][1] > 900, "{told:?}");
}
