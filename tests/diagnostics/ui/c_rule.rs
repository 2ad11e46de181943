use dalembert::{Trapezoidal, rayleigh_system};

dalembert_c::parameters! {
    /// A cart.
    pub struct Cart {
        /// Mass.
        pub m: f64,
    }
}

#[rayleigh_system]
impl Cart {
    fn lagrangian(&self, _q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * self.m * v[0] * v[0]
    }
    fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
        u
    }
}

dalembert_c::c_api! { cart: Cart, rule: Trapezoidal }

fn main() {}
