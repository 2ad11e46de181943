//! A cart with a pole, as a functional mock-up unit.

use dalembert::{Midpoint, rayleigh_system};

dalembert_fmu::parameters! {
    /// A rod hinged to a cart on a rail.
    ///
    /// - `q[0]`: position of the cart. Unit: m
    /// - `q[1]`: angle of the rod from upright. Unit: rad
    /// - `p[0]`: Unit: N.s
    /// - `u[0]`: force on the cart. Unit: N
    pub struct CartPole {
        /// Mass of the cart.
        /// Unit: kg
        pub cart: f64,
        /// Mass of the rod.
        /// Unit: kg
        pub rod: f64,
        /// Half the length of the rod.
        /// Unit: m
        pub half_length: f64,
        /// Friction of the rail and of the hinge.
        /// Unit: N.s/m, N.m.s
        pub friction: [f64; 2],
    }
}

#[rayleigh_system(parameters = [cart, rod])]
impl CartPole {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let (sine, cosine) = q[1].sin_cos();
        let spin = self.half_length * v[1];
        let (x, y) = (v[0] + cosine * spin, -sine * spin);
        let kinetic = 0.5 * self.cart * v[0] * v[0] + self.rod * (0.5 * (x * x + y * y) + spin * spin / 6.0);
        kinetic - self.rod * 9.81 * self.half_length * cosine
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * (self.friction[0] * v[0] * v[0] + self.friction[1] * v[1] * v[1])
    }

    fn force(&self, _q: [f64; 2], _v: [f64; 2], u: [f64; 1]) -> [f64; 2] {
        [u[0], 0.0]
    }

    /// - `y[0]` tip: place of the rod's end along the rail. Unit: m
    /// - `y[1]` height: of the rod's end over the hinge. Unit: m
    fn outputs(&self, q: [f64; 2], _v: [f64; 2]) -> [f64; 2] {
        let (sine, cosine) = q[1].sin_cos();
        [q[0] + 2.0 * self.half_length * sine, 2.0 * self.half_length * cosine]
    }
}

dalembert_fmu::fmu! {
    cart_pole: CartPole,
    rule: Midpoint,
    step_size: 0.01,
    parameters: CartPole { cart: 1.0, rod: 0.1, half_length: 0.25, friction: [0.1, 0.002] },
    q: [0.0, 0.1],
    v: [0.0, 0.0],
}
