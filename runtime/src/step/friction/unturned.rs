//! Steps through which every slip keeps its direction, as most are: friction is a known force then, and the
//! equation one without it.
//!
//! ```text
//! p0 = −D1(L_d + R_d) − f_d⁻ + D s,   p1 = D2(L_d − R_d) + f_d⁺ − D s,   D s = (h/2) Σₖ Fₖ sₖ ∂uₖ/∂v
//! sₖ uₖ > 0 at v̄ and at v1
//! ```
//!
//! A root at which the slips are as they were taken to be solves the equations with kinks. Where one is
//! not, or is near 0, the general way decides. Elements of one component alone: a length turns by itself.

use nalgebra::{SMatrix, SVector};

use super::equation::at_middle;
use crate::numbers::{Factored, NewtonMatrix, Scalar};
use crate::step::equation::{Equation, OfRule, StepEquation};
use crate::step::newton::{QUICK_ITERATIONS, SMALL, quick};
use crate::step::{ClosedForm, Discrete, Momenta, Segment, State, Step, StepKernel};
use crate::system::{DryFriction, Slips};

/// The equation of a step with the forces s of friction known.
struct Unturned<'a, L: DryFriction<N, M>, R, const N: usize, const M: usize> {
    system: &'a L,
    free: OfRule<'a, L, R>,
    forces: SVector<L::Scalar, M>,
    /// D s on the segment of the guess.
    impulse: SVector<L::Scalar, N>,
}

/// The step with the slips of the `guess`; nothing where the general way has to look.
#[inline]
pub(super) fn step<L, R, const N: usize, const M: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
    h: L::Scalar,
    guess: &SVector<L::Scalar, N>,
) -> Option<Step<L::Scalar, N>>
where
    L: ClosedForm<R, N> + Discrete<R, N> + DryFriction<N, M>,
{
    if L::ELEMENTS.len() != M || !L::IS_PROPORTIONAL {
        return None;
    }
    let slips = at_middle(system, &Segment { q0: state.q, v: *guess, h });
    // It stuck.
    if slips.values.iter().any(|slip| *slip == L::Scalar::constant(0.0)) {
        return None;
    }
    let forces = slips.values.map(direction);
    let equation = Unturned::<L, R, N, M> {
        system,
        free: OfRule::new(system),
        forces,
        impulse: impulse(&slips, h, &forces),
    };
    let solution = quick(&equation, state, h, *guess).ok()?;
    let segment = Segment { q0: state.q, v: solution.unknown, h };
    let step = Step::completed(state, h, segment.v, &solution.momenta, solution.report).ok()?;
    equation.holds_on(&segment, &step.state).then_some(step)
}

fn direction<S: Scalar>(slip: S) -> S {
    S::one().copysign(slip)
}

fn half_the_digits<S: Scalar>() -> S {
    S::EPSILON.sqrt()
}

/// D s.
#[inline]
fn impulse<S: Scalar, const N: usize, const M: usize>(
    slips: &Slips<S, N, M>,
    h: S,
    forces: &SVector<S, M>,
) -> SVector<S, N> {
    slips.by_velocity.transpose() * slips.limits.component_mul(forces) * (h * S::constant(0.5))
}

/// Whether all elements slide along these forces, by more than `least`, and none pushes.
#[inline]
fn slides<S: Scalar, const N: usize, const M: usize>(
    slips: &Slips<S, N, M>,
    forces: &SVector<S, M>,
    least: &SVector<S, M>,
    h: S,
) -> bool {
    let mut slides = true;
    for k in 0..M {
        slides &= slips.values[k] * forces[k] > least[k] && slips.limits[k] * h >= S::zero();
    }
    slides
}

impl<L, R, const N: usize, const M: usize> Unturned<'_, L, R, N, M>
where
    L: ClosedForm<R, N> + Discrete<R, N> + DryFriction<N, M>,
{
    #[inline]
    fn impulse(&self, segment: &Segment<L::Scalar, N>) -> SVector<L::Scalar, N> {
        if L::IS_UNIFORM {
            self.impulse
        } else {
            impulse(&at_middle(self.system, segment), segment.h, &self.forces)
        }
    }

    /// Whether the slips at v̄ and at the end are along the forces.
    #[inline]
    fn holds_on(&self, segment: &Segment<L::Scalar, N>, end: &State<L::Scalar, N>) -> bool {
        let Segment { q0, v, h } = segment;
        let half = *h * L::Scalar::constant(0.5);
        let middle = q0 + v * half;
        self.system.later(half, |at_middle| {
            let slips = at_middle.slips(&middle, v);
            // Half the digits of the terms: slips nearer to 0 are looked at with their rounding.
            let least = slips.by_velocity.abs() * v.abs() * half_the_digits::<L::Scalar>();
            slides(&slips, &self.forces, &least, *h)
                && at_middle
                    .later(half, |at_end| velocity(at_end, end, v))
                    .is_some_and(|v| slides(&at_middle.slips(&middle, &v), &self.forces, &least, *h))
        })
    }
}

/// The velocity of a state by Newton's method from `start`, if that finds it.
#[inline]
fn velocity<L, const N: usize, const M: usize>(
    system: &L,
    state: &State<L::Scalar, N>,
    start: &SVector<L::Scalar, N>,
) -> Option<SVector<L::Scalar, N>>
where
    L: DryFriction<N, M>,
{
    let mut v = *start;
    for _ in 0..QUICK_ITERATIONS {
        let l = system.lagrangian_derivatives(&state.q, &v);
        let correction = NewtonMatrix::factored(&l.d22)?.solve(&(l.d2 - state.p));
        v -= correction;
        if L::STRUCTURE.constant_mass_matrix || correction.amax() <= v.amax() * L::Scalar::constant(SMALL) {
            return Some(v);
        }
    }
    None
}

impl<L, R, const N: usize, const M: usize> StepEquation<L::Scalar, N> for Unturned<'_, L, R, N, M>
where
    L: ClosedForm<R, N> + Discrete<R, N> + DryFriction<N, M>,
{
    type Matrix = L::Matrix;

    #[inline]
    fn kernel(&self, segment: &Segment<L::Scalar, N>) -> StepKernel<L::Scalar, N, L::Matrix> {
        let StepKernel { p0, matrix } = self.free.kernel(segment);
        StepKernel { p0: p0 + self.impulse(segment), matrix }
    }

    #[inline]
    fn momenta(&self, segment: &Segment<L::Scalar, N>) -> Momenta<L::Scalar, N> {
        let Momenta { p0, p1 } = self.free.momenta(segment);
        let impulse = self.impulse(segment);
        Momenta { p0: p0 + impulse, p1: p1 - impulse }
    }

    #[inline]
    fn inertia(&self, segment: &Segment<L::Scalar, N>) -> SMatrix<L::Scalar, N, N> {
        self.free.inertia(segment)
    }

    #[inline]
    fn kind(&self) -> Equation {
        if L::IS_UNIFORM { self.free.kind() } else { Equation::General }
    }
}
