//! What steps with friction refuse.

use dalembert::nalgebra::{self, vector};
use dalembert::system::{Function, Quantity};
use dalembert::{Discretise, Proximal, State, StepError, rayleigh_system};

struct Pushed {
    mu: f64,
}

#[rayleigh_system(rule = proximal)]
impl Pushed {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) + 0.1 * q[0] - 0.0 * q[1]
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.1 * v[1].abs() + self.mu * v[0].abs()
    }
}

#[test]
fn a_negative_factor_is_named() {
    let still = State { q: vector![0.0, 0.0], p: vector![0.0, 0.0] };
    let error = Pushed { mu: -0.2 }.by(Proximal, 0.1).step(&still).unwrap_err();
    assert_eq!(error, StepError::NegativeFriction { component: 1, limit: -0.2 });
    assert!(Pushed { mu: 0.0 }.by(Proximal, 0.1).step(&still).is_ok());
}

#[test]
fn a_force_at_its_limit_has_no_derivative() {
    let still = State { q: vector![0.0, 0.0], p: vector![0.0, 0.0] };
    let by_state = |mu: f64| Pushed { mu }.by(Proximal, 0.1).linearized(&still).map(|step| step.by_state());
    assert_eq!(by_state(0.1).unwrap_err(), StepError::AtLimitOfFriction { component: 1 });
    assert!(by_state(0.2).is_ok() && by_state(0.05).is_ok());
}

#[test]
fn friction_has_no_step_back_in_time() {
    let still = State { q: vector![0.0, 0.0], p: vector![0.3, 0.0] };
    let by = Pushed { mu: 0.2 }.by(Proximal, -0.1);
    let error = by.step(&still).unwrap_err();
    assert!(matches!(error, StepError::NotConvex { h: -0.1, enough: 0.05, .. }), "{error}");
    assert!(by.with_step(0.05).step(&still).is_ok());
    // From a guess too, with every element sliding.
    let sliding = State { q: vector![0.0, 0.0], p: vector![3.0, 4.0] };
    let error = by.near(&vector![3.0, 4.0]).step(&sliding).unwrap_err();
    assert!(matches!(error, StepError::NotConvex { .. }), "{error}");
    assert!(by.with_step(0.05).near(&vector![3.0, 4.0]).step(&sliding).is_ok());
}

/// A ball and a beam on dry friction, under a force that its field spoils.
struct Spoiled {
    mu: f64,
    push: f64,
}

#[rayleigh_system(rule = proximal)]
impl Spoiled {
    fn lagrangian(&self, _q: [f64; 3], v: [f64; 3]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
    }

    fn rayleigh(&self, v: [f64; 3]) -> f64 {
        self.mu * (v[0] * v[0] + v[1] * v[1]).sqrt() + 0.1 * v[2].abs()
    }

    fn force(&self, _q: [f64; 3], _v: [f64; 3]) -> [f64; 3] {
        [0.0, 0.0, self.push * self.push]
    }
}

/// The field is named, or the function: of a ball at rest it is not its root, which friction may stand at.
#[test]
fn a_factor_that_is_no_number_is_an_error() {
    let still = State { q: vector![0.0, 0.0], p: vector![0.0, 0.0] };
    let by = |mu| Pushed { mu }.by(Proximal, 0.1).step(&still).unwrap_err();
    let named = |name| StepError::NonFinite { quantity: Quantity::Field { name }, index: 0 };
    assert_eq!(by(f64::NAN), named("mu"));
    let said = |function, coordinate| StepError::NoDerivative { function, coordinate, place: None };
    // Where no operation of the functions can lack a derivative, nothing looks for one.
    let some = StepError::NonFinite { quantity: Quantity::Derivatives, index: 0 };
    assert_eq!(by(f64::INFINITY), some);

    for still in [vector![0.0, 0.0, 0.0], vector![0.3, -0.1, 0.2]].map(|p| State { q: nalgebra::zero(), p }) {
        let by = |mu, push| Spoiled { mu, push }.by(Proximal, 0.1).step(&still);
        assert_eq!(by(f64::NAN, 0.0).unwrap_err(), named("mu"));
        assert_eq!(by(f64::INFINITY, 0.0).unwrap_err(), said(Function::Rayleigh, 0));
        assert_eq!(by(0.2, f64::NAN).unwrap_err(), named("push"));
        assert_eq!(by(0.2, 1e200).unwrap_err(), said(Function::Force { index: 2 }, 2));
        assert!(by(0.2, 0.05).is_ok());
    }
}

/// A motor with play in its gears, and a load on dry friction that falls with the speed by `fall`.
struct Geared {
    fall: f64,
}

const PLAY: f64 = 0.01;

#[rayleigh_system(rule = proximal)]
impl Geared {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let beyond = ((q[0] - q[1]).abs() - PLAY).max(0.0);
        0.5 * (2e-4 * v[0] * v[0] + 2e-3 * v[1] * v[1]) - 30.0 * beyond * beyond - 0.06 * q[0]
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        let speed = v[1].abs();
        0.006 * v[0].abs() + 0.02 * speed + 0.05 * self.fall * (1.0 - (-20.0 * speed).exp())
    }
}

/// The teeth begin to press a load that holds: beside the little that they press by, roundings are large,
/// beside what friction holds they are none.
#[test]
fn what_holds_may_be_touched() {
    let mut draws = dalembert_tests::draws::Draws::new(7);
    let mut held = 0;
    for _ in 0..if cfg!(debug_assertions) { 300 } else { 3000 } {
        let system = Geared { fall: [0.0, 0.01][draws.below(2)] };
        let (speed, h) = (draws.between(-3.0, 0.0), draws.scale(1e-5, 1e-3));
        // The end of the play lies within the step.
        let gap = draws.between(0.0, 1.0) * h * speed.abs();
        let state = State { q: vector![0.5 - PLAY + gap, 0.5], p: vector![2e-4 * speed, 0.0] };
        let step =
            system.by(Proximal, h).step(&state).unwrap_or_else(|error| panic!("{state:?}, h = {h}: {error}"));
        held += usize::from(step.state.q[1] == 0.5 && step.state.p[1] == 0.0);
    }
    assert!(held > 100, "{held}");
}

/// A block whose friction falls from `hold` to `slide` about the velocity `speed`.
struct Stribeck {
    hold: f64,
    slide: f64,
    speed: f64,
}

#[rayleigh_system(rule = proximal)]
impl Stribeck {
    fn lagrangian(&self, _q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0]
    }

    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        let speed = v[0].abs();
        self.slide * speed + (self.hold - self.slide) * self.speed * (speed / self.speed).tanh()
    }
}

/// The objective ½v² − pv + (h/2)R, looked at everywhere: with several minima no step is one of them by
/// chance, and where it is convex none is refused.
#[test]
fn a_step_is_refused_where_friction_has_several() {
    let mut draws = dalembert_tests::draws::Draws::new(5);
    let (mut several, mut convex) = (0, 0);
    for _ in 0..if cfg!(debug_assertions) { 2_000 } else { 100_000 } {
        let (h, slide) = (draws.scale(1e-3, 0.1), draws.between(0.1, 1.1));
        let system = Stribeck { slide, hold: slide + draws.between(0.0, 2.0), speed: draws.scale(1e-3, 0.1) };
        let p = draws.between(-1.5, 1.5) * h * system.hold;
        let slope = |v: f64| {
            let fallen = (v / system.speed).tanh().powi(2);
            v - p.abs() + 0.5 * h * (system.hold - (system.hold - slide) * fallen)
        };
        let slopes = (0..=500).map(|i| slope(p.abs() * f64::from(i) / 500.0));
        let minima = slopes.fold((0, f64::NEG_INFINITY), |(minima, before), slope| {
            (minima + usize::from(before < 0.0 && slope >= 0.0), slope)
        });
        // The steepest fall is 4/(3√3) of (hold − slide)/speed.
        let fall = 4.0 / 27.0_f64.sqrt() * (system.hold - slide) / system.speed;
        let step = system.by(Proximal, h).step(&State { q: vector![0.0], p: vector![p] });
        let is_refused = matches!(step, Err(StepError::NotConvex { .. }));
        assert!(is_refused || step.is_ok(), "{step:?}");
        assert!(!is_refused || 0.5 * h * fall >= 1.0, "h = {h}, fall {fall}, p = {p}");
        assert!(is_refused || minima.0 < 2, "h = {h}, fall {fall}, p = {p}: {step:?}");
        several += usize::from(minima.0 > 1);
        convex += usize::from(0.5 * h * fall < 1.0);
    }
    assert!(several > 20 && convex > 1_000, "{several} with several minima, {convex} convex");
}
