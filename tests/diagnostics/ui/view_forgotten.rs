//! A system that takes an input or the time, without them.

use dalembert::{Discretise, Composition, Gauss, Midpoint, State, Trapezoidal, rayleigh_system};

struct Cart {
    m: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
impl Cart {
    fn lagrangian(&self, _q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * self.m * v[0] * v[0]
    }

    fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
        u
    }
}

struct Clock;

#[rayleigh_system]
impl Clock {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
        0.5 * v[0] * v[0] - t * q[0]
    }
}

fn main() {
    let cart = Cart { m: 1.0 };
    let start = State::from_velocity(&cart, [0.0], [1.0]).unwrap();
    let _ = cart.by(Midpoint, 0.1).step(&start);
    let _ = cart.by(Midpoint, 0.1).run(start);
    let _ = cart.by(Gauss::<2>, 0.1).run(start);
    let _ = cart.by(Composition::kahan_li_6(Trapezoidal), 0.1).run(start);
    let _ = cart.by(Midpoint, 0.1).segment(&start.q, &start.q);

    let start = State::from_velocity(&Clock, [0.0], [1.0]).unwrap();
    let _ = Clock.by(Midpoint, 0.1).step(&start);
    let _ = Clock.by(Midpoint, 0.1).run(start);
}
