use dalembert::{Discrete, Lagrangian, Midpoint, rayleigh_system};
use dalembert::system::Driven;

struct Cart;

#[rayleigh_system]
impl Cart {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        v[0] * v[0] - q[0]
    }
    fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
        u
    }
}

struct Swing;

#[rayleigh_system]
impl Swing {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
        v[0] * v[0] - q[0] * t
    }
}

fn discrete(_: &impl Discrete<Midpoint, 1>) {}
fn lagrangian(_: &impl Lagrangian<1>) {}
fn driven(_: &impl Driven<1, 1>) {}

fn main() {
    discrete(&Cart.driven([0.3]));
    driven(&Cart.driven([0.3]));
    lagrangian(&Cart);
    discrete(&Cart);
    discrete(&Swing.at_time(0.0));
    lagrangian(&Swing);
    driven(&Swing.at_time(0.0));
}
