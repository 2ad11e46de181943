//! Velocities of coordinates without mass in which dry friction acts.
//!
//! ```text
//! F(q, v) ∈ ∂R_k(q, v)        F = ∂L/∂q − ∂R_s/∂v + f, in coordinates without mass
//! ```
//!
//! Where R_s or f holds the velocity, that determines it. Where the kinks alone do, in coordinates Y, it says
//! what sticks, and leaves open how fast an element slides whose force is at its limit. There the forces
//! stay in balance along the motion: of F(q + τv, t + τ) ∈ ∂R_k(q + τv, v) the limit τ → 0,
//!
//! ```text
//! ∂F/∂q v + ∂F/∂t = d(D s)/dt in Y,   u = 0 of what sticks,   ds/dt = 0 of what slides
//! ```
//!
//! A short τ tells what sticks; the velocities are those of the limit. The end of a spring that slides
//! follows its beginning. Of F that takes the velocity of a mass, the change with that is left out.

use nalgebra::{SMatrix, SVector};

use super::balanced::{OF_FORCES, balanced};
use super::element::elements;
use super::end::{forces, light_among, terms};
use super::line::Line as Bordered;
use super::root::{Line, root};
use super::set::Held;
use super::sliding::direction_of;
use super::sticking::sticking_in;
use crate::numbers::{NewtonMatrix, Scalar};
use crate::step::massless::Massless;
use crate::system::{DryFriction, Slips, is_timed, sizes};

/// The longest time over which a force is seen to change; each next one is half as long.
const LONGEST: f64 = 1.0 / 4096.0;

/// How often it is halved.
const HALVINGS: u32 = 60;

/// The change of a force over such a time, of the force: beyond it differences are no derivatives.
const CHANGE: f64 = 1e-5;

/// v with the velocities that dry friction leaves to coordinates without mass; nothing where they do not
/// follow. Generated implementations of
/// [`Lagrangian::massless_velocity`](crate::Lagrangian::massless_velocity) call it.
#[cold]
#[inline(never)]
pub fn massless_velocity<L, const N: usize, const M: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
) -> Option<SVector<L::Scalar, N>>
where
    L: DryFriction<N, M>,
{
    let massless = Massless::of(system, q);
    let light = light_among(&massless, system, q);
    let start = massless.without(v);
    let q = if light.are_any() { at_once(system, &light, q, &start)? } else { *q };
    let mut motion = Motion { system, massless, light, q, v: start, forces: nalgebra::zero() };
    let mut found = motion.found()?;
    if light.are_any() && (!L::IS_UNIFORM || is_timed(system)) {
        // What friction itself changes by, with the forces known.
        motion.forces = found.1.forces;
        found = motion.found()?;
    }
    let (v, held) = found;
    let v = if light.are_any() { motion.in_the_limit(&v, &held).unwrap_or(v) } else { v };
    Some(massless.rows(&sticking_in(&light, &motion.slips(&start), &v, &held)) + start)
}

/// The places to which the coordinates `light` jump where no friction bears the forces at (q, v): with
/// a little friction that is smooth they would be there before anything else has moved, belts neither.
fn at_once<L, const N: usize, const M: usize>(
    system: &L,
    light: &Massless<N>,
    q: &SVector<L::Scalar, N>,
    v: &SVector<L::Scalar, N>,
) -> Option<SVector<L::Scalar, N>>
where
    L: DryFriction<N, M>,
{
    let slips = |q: &SVector<L::Scalar, N>, v: &SVector<L::Scalar, N>| {
        let slips: Slips<_, N, M> = system.slips(q, v);
        Slips { values: slips.by_velocity * v, ..slips }
    };
    let rest = nalgebra::zero();
    let one = L::Scalar::constant(1.0);
    balanced(system, light, (q, one), (&rest, v), slips).ok().map(|at| at.q)
}

/// Where the velocities without mass are looked for.
struct Motion<'a, L: DryFriction<N, M>, const N: usize, const M: usize> {
    system: &'a L,
    massless: Massless<N>,
    light: Massless<N>,
    q: SVector<L::Scalar, N>,
    /// With rest in coordinates without mass.
    v: SVector<L::Scalar, N>,
    /// s, as far as it is known.
    forces: SVector<L::Scalar, M>,
}

impl<L, S, const N: usize, const M: usize> Motion<'_, L, N, M>
where
    L: DryFriction<N, M, Scalar = S>,
    S: Scalar,
{
    /// The velocities by a short τ, with what sticks.
    fn found(&self) -> Option<(SVector<S, N>, Held<S, M>)> {
        let (stiffness, by_time) = (self.stiffness(), self.by_time());
        let tau = self.short(&stiffness, &by_time);
        let found = root(L::ELEMENTS, &self.v, S::constant(OF_FORCES), |v| {
            let forces = forces(self.system, &self.q, v);
            let ahead = self.light.rows(&(stiffness * v + by_time)) * tau;
            let left = ahead - self.massless.rows(&forces.value);
            let by_velocity = self.light.without(&-forces.d2) + self.light.rows(&stiffness) * tau;
            let Some(factored) = self.massless.block(&by_velocity).factored() else { return Ok(None) };
            let beside = self.massless.rows(&terms(&forces, &self.q));
            Ok(Some(Line { left, factored, slips: self.slips(v), beside, is_linear: false }))
        });
        found.ok().map(|root| (root.x, root.held))
    }

    /// The slips of motions in coordinates without mass, beside the others.
    fn slips(&self, v: &SVector<S, N>) -> Slips<S, N, M> {
        let slips = self.system.slips(&self.q, v);
        Slips { by_velocity: self.massless.columns(&slips.by_velocity), ..slips }
    }

    /// −∂F/∂q + ∂(D s)/∂q.
    fn stiffness(&self) -> SMatrix<S, N, N> {
        let springs = -forces(self.system, &self.q, &self.v).d1;
        if L::IS_UNIFORM { springs } else { springs + self.system.slip_curvature(&self.q, &self.forces) }
    }

    /// −∂F/∂t + ∂(D s)/∂t in Y, by differences.
    fn by_time(&self) -> SVector<S, N> {
        if !self.light.are_any() || !is_timed(self.system) {
            return nalgebra::zero();
        }
        let at = |elapsed: S| {
            self.system.later(elapsed, |system| {
                let slips: Slips<_, N, M> = system.slips(&self.q, &self.v);
                let friction = slips.by_velocity.transpose() * slips.limits.component_mul(&self.forces);
                let forces = forces(system, &self.q, &self.v).value;
                (self.light.rows(&(friction - forces)), self.light.rows(&forces).amax())
            })
        };
        let mut over = S::constant(LONGEST);
        for _ in 0..HALVINGS {
            let ((ahead, size_ahead), (behind, size_behind)) = (at(over), at(-over));
            let change = ahead - behind;
            if change.amax() <= (size_ahead + size_behind) * S::constant(CHANGE) {
                return change / (over * S::constant(2.0));
            }
            over *= S::constant(0.5);
        }
        nalgebra::zero()
    }

    /// A time in which the forces in Y change by few of their digits beside friction's limits.
    fn short(&self, stiffness: &SMatrix<S, N, N>, by_time: &SVector<S, N>) -> S {
        let slips = self.slips(&self.v);
        let mut most = self.light.rows(&(slips.by_velocity.abs().transpose() * slips.limits.abs())).amax();
        if most == S::constant(0.0) {
            most = self.light.rows(&(stiffness.abs() * self.q.abs())).amax();
        }
        let speeds = self.v.abs().add_scalar(slips.values.amax());
        let change = self.light.rows(&(stiffness.abs() * speeds + by_time.abs())).amax();
        let tau = most / change * S::EPSILON.sqrt();
        if tau.is_finite() && tau > S::constant(0.0) { tau } else { S::constant(1.0) }
    }

    /// The velocities in Y of the limit τ → 0, where what sticks and slides is known.
    fn in_the_limit(&self, v: &SVector<S, N>, held: &Held<S, M>) -> Option<SVector<S, N>> {
        let others = self.light.without(v);
        let slips: Slips<_, N, M> = self.system.slips(&self.q, &others);
        let in_light = Slips { by_velocity: self.light.columns(&slips.by_velocity), ..slips };
        let mut line = Released {
            directions: direction_of(&in_light, S::constant(OF_FORCES)).ok()?,
            rows: in_light.by_velocity,
            slip: -slips.values,
            sticks: held.sticks,
        };
        line.release(L::ELEMENTS, &held.forces);
        let stiffness = self.stiffness();
        let bordered =
            Bordered::of(&self.light.block(&stiffness), &line.directions, &line.rows, &line.sticks);
        let right = -self.light.rows(&(stiffness * others + self.by_time()));
        Some(others + self.light.rows(&bordered.ok()?.solve(&right, &line.slip)))
    }
}

/// Equations u = 0 of what sticks, and of what slides those across its way.
struct Released<S, const N: usize, const M: usize> {
    /// Column by column, the forces.
    directions: SMatrix<S, N, M>,
    /// Row by row, the slips.
    rows: SMatrix<S, M, N>,
    /// The slips that are asked for.
    slip: SVector<S, M>,
    sticks: [bool; M],
}

impl<S: Scalar, const N: usize, const M: usize> Released<S, N, M> {
    /// Releases what slides, along the forces s: across its way a length neither slips nor bears less.
    fn release(&mut self, components: &[usize], forces: &SVector<S, M>) {
        let sticks = self.sticks;
        for element in elements(components).filter(|element| element.head(&sticks) == Some(false)) {
            if element.size > 1 {
                let s = element.part(forces);
                self.directions -= self.directions * s * s.transpose();
                self.rows -= s * (s.transpose() * self.rows);
                self.slip -= s * s.dot(&self.slip);
                element.of_mut(&mut self.sticks).for_each(|stick| *stick = true);
            }
        }
        // What moves nothing here is no equation.
        let moved = sizes(&self.rows, &SVector::repeat(S::one()));
        let idle = self.sticks.iter_mut().zip(moved.as_slice()).filter(|(_, size)| **size == S::zero());
        idle.for_each(|(stick, _)| *stick = false);
        let open = self.slip.as_mut_slice().iter_mut().zip(&self.sticks).filter(|(_, stick)| !**stick);
        open.for_each(|(slip, _)| *slip = S::zero());
    }
}
