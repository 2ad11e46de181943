//! A system that takes an input or the time, without them.

use dalembert::{
    Composition, Discrete, Gauss, Linearization, Midpoint, State, Trajectory, Trapezoidal, rayleigh_system,
};

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
    let _ = cart.step(&start, 0.1, None);
    let _ = Trajectory::new(&cart, Midpoint, 0.1, start);
    let _ = Trajectory::new(&cart, Gauss::<2>, 0.1, start);
    let _ = Composition::kahan_li_6(Trapezoidal).trajectory(&cart, 0.1, start);
    let _ = Linearization::of_segment(&cart, Midpoint, &start.q, &start.q, 0.1);

    let start = State::from_velocity(&Clock, [0.0], [1.0]).unwrap();
    let _ = Clock.step(&start, 0.1, None);
    let _ = Trajectory::new(&Clock, Midpoint, 0.1, start);
}
