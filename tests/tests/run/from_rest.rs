//! A tolerance from rest at the origin, where the state has no size: the choice is that of the motion,
//! as from anywhere else.

use dalembert::{Discretise, State, rayleigh_system};
use dalembert_tests::draws::Draws;

/// ½mv² − mgq − ½k(q − q₀)² + A q sin ωt, friction c v²/2 + r|v|³/3; q is counted from `origin`.
#[derive(Clone, Copy, Debug)]
struct Fall {
    mass: f64,
    gravity: f64,
    spring: f64,
    drag: [f64; 2],
    drive: [f64; 2],
    origin: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
impl Fall {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        let x = q[0] - self.origin;
        0.5 * self.mass * v[0] * v[0] - self.mass * self.gravity * x - 0.5 * self.spring * x * x
    }

    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.5 * self.drag[0] * v[0] * v[0] + self.drag[1] / 3.0 * v[0].abs().powi(3)
    }

    fn force(&self, _q: [f64; 1], _v: [f64; 1], t: f64) -> [f64; 1] {
        [self.drive[0] * (self.drive[1] * t).sin()]
    }
}

/// The evaluations that the choice expects of the run from rest at the origin.
fn cost(fall: Fall, tolerance: f64, time: f64) -> f64 {
    let view = fall.at_time(0.0);
    let start = State { q: [fall.origin].into(), p: [0.0].into() };
    let choice = view.to_error(tolerance).until(time).choice(&start);
    let choice = choice.unwrap_or_else(|error| panic!("{fall:?} to {tolerance:e}: {error}"));
    let trial = choice.trials().find(|trial| trial.method == choice.method()).expect("it was tried");
    trial.evaluations * trial.step_size / choice.step_size()
}

#[test]
fn where_the_origin_lies_does_not_matter() {
    let mut draws = Draws::new(40);
    let systems = if cfg!(debug_assertions) { 60 } else { 2000 };
    let mut dearest = 0.0_f64;
    for _ in 0..systems {
        let [has_drag, has_spring, is_driven] = [(); 3].map(|()| draws.below(2) == 0);
        let fall = Fall {
            mass: draws.scale(0.1, 10.0),
            gravity: draws.scale(0.1, 30.0),
            spring: if has_spring { draws.scale(0.1, 10.0) } else { 0.0 },
            drag: [if has_drag { draws.scale(1e-3, 1.0) } else { 0.0 }, draws.scale(1e-4, 0.1)],
            drive: [if is_driven { draws.scale(0.1, 10.0) } else { 0.0 }, draws.scale(0.3, 3.0)],
            origin: 0.0,
        };
        let (tolerance, time) = (draws.scale(1e-9, 1e-3), draws.between(2.0, 20.0));
        let away = cost(Fall { origin: draws.sign(), ..fall }, tolerance, time);
        let ratio = cost(fall, tolerance, time) / away;
        dearest = dearest.max(ratio);
        assert!((0.3..3.0).contains(&ratio), "{ratio} of {away}: {fall:?} to {tolerance:e}, {time}");
    }
    println!("{systems} systems, at the origin at most {dearest:.2} times as dear as one away");
}

/// A fall under air drag, to 10⁻⁶ in 76 772 midpoint steps once, where 10 of Gauss rules do; its end is
/// −(m/r) ln cosh(t √(gr/m)).
#[test]
fn a_fall_takes_a_few_steps() {
    let fall =
        Fall { mass: 1.0, gravity: 10.0, spring: 0.0, drag: [0.0, 0.01], drive: [0.0, 1.0], origin: 0.0 };
    let exact = -100.0 * 10.0_f64.sqrt().cosh().ln();
    for (tolerance, most) in [(1e-3, 20), (1e-6, 20), (1e-10, 40)] {
        let view = fall.at_time(0.0);
        let start = State { q: [0.0].into(), p: [0.0].into() };
        let request = view.to_error(tolerance).until(10.0);
        let choice = request.choice(&start).unwrap();
        assert!(choice.steps() <= most, "{tolerance:e}: {} steps", choice.steps());
        let end = request.end(&start).unwrap();
        assert!((end.state.q[0] - exact).abs() < tolerance, "{tolerance:e}: {:?}", end.state);
    }
}
