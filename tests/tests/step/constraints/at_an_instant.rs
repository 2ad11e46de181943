//! Reactions of the motion through a state, beside closed forms and the reactions of short steps.

use dalembert::nalgebra::SVector;
use dalembert::{Discretise, Midpoint, State, StepError, rayleigh_system};
use dalembert_tests::draws::Draws;
use dalembert_tests::systems::{Hoist, rope};

use super::Spherical;

/// A mass of 2 in polar coordinates on the spiral r = 3 φ, with drag on the angle.
struct Spiral;

#[rayleigh_system]
impl Spiral {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        v[0] * v[0] + q[0] * q[0] * v[1] * v[1]
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.35 * v[1] * v[1]
    }
    fn constraints(&self, q: [f64; 2]) -> [f64; 1] {
        [q[0] - 3.0 * q[1]]
    }
}

/// A knife edge of mass 2.
struct Skate;

#[rayleigh_system]
impl Skate {
    fn lagrangian(&self, _q: [f64; 3], v: [f64; 3]) -> f64 {
        v[0] * v[0] + v[1] * v[1] + 0.15 * v[2] * v[2]
    }
    fn velocity_constraints(&self, q: [f64; 3], v: [f64; 3]) -> [f64; 1] {
        [v[0] * q[2].sin() - v[1] * q[2].cos()]
    }
}

#[test]
fn reactions_are_those_of_the_equations_of_motion() -> Result<(), StepError> {
    let mut draws = Draws::new(3);
    for _ in 0..20 {
        let mut draw = |size: f64| draws.between(-size, size);
        // m g z − m v², with the unit vector for its gradient.
        let bob = Spherical { c: 0.4 };
        let at = State::nearest(&bob, [draw(1.0), draw(1.0), -1.0], [draw(2.0), draw(2.0), draw(2.0)])?;
        let by_hand = 1.3 * 9.81 * at.q[2] - at.p.norm_squared() / 1.3;
        assert!((at.reactions(&bob)?[0] - by_hand).abs() < 1e-12);

        // The angle alone: L = 9 (1 + φ²) φ̇², so that 18 ((1 + φ²) φ̈ + φ φ̇²) = −0.7 φ̇.
        let (angle, rate) = (2.0 + draw(1.0), draw(2.0));
        let at = State::from_velocity(&Spiral, [3.0 * angle, angle], [3.0 * rate, rate])?;
        let curved = -(angle * rate * rate + 0.7 * rate / 18.0) / (1.0 + angle * angle);
        let by_hand = 2.0 * (3.0 * curved - 3.0 * angle * rate * rate);
        assert!((at.reactions(&Spiral)?[0] - by_hand).abs() < 1e-11);

        // It turns at ω with speed s, by a force 2 s ω to the left.
        let (heading, speed, turn) = (draw(3.0), draw(2.0), draw(2.0));
        let v = [speed * heading.cos(), speed * heading.sin(), turn];
        let at = State::from_velocity(&Skate, [0.1, 0.2, heading], v)?;
        assert!((at.reactions(&Skate)?[0] + 2.0 * speed * turn).abs() < 1e-13);

        // A rope that is pulled in: its tension beside weight, drag and what the length does by itself.
        let (time, angle, rate) = (1.5 + draw(1.5), draw(1.0), draw(0.5));
        let (view, (s, c), [length, pulled]) = (Hoist.at_time(time), angle.sin_cos(), rope(time));
        let v = [pulled * s + length * rate * c, -pulled * c + length * rate * s];
        let at = State::from_velocity(&view, [length * s, -length * c], v)?;
        let along = 0.245 * (0.7 * time).sin() - length * rate * rate;
        let by_hand = (1.5 * (along - 9.81 * c) + 0.3 * pulled) / (2.0 * length);
        let found = at.reactions(&view)?[0];
        assert!((found - by_hand).abs() < 1e-10, "{found} {by_hand}");
    }
    Ok(())
}

/// The limit of those of steps, of first order in h.
#[test]
fn short_steps_have_nearly_these_reactions() -> Result<(), StepError> {
    let bob = Spherical { c: 0.4 };
    let at = State::nearest(&bob, [0.3, 0.4, -0.8], [1.0, 0.5, 0.2])?;
    let exact: SVector<f64, 1> = at.reactions(&bob)?;
    let off = |h: f64| -> Result<f64, StepError> {
        let by = bob.by(Midpoint, h);
        Ok((by.reactions(&at, &by.step(&at)?)? - exact).amax())
    };
    let (coarse, fine) = (off(1e-3)?, off(5e-4)?);
    assert!(fine > 1e-6 && (coarse / fine - 2.0).abs() < 0.05, "{coarse:e} {fine:e}");
    Ok(())
}
