//! A cart with a pole, whose force is given from outside.

use dalembert::rayleigh_system;

crate::parameters! {
    /// A rod hinged to a cart on a rail; q is (position in m, angle from upright in rad), u the force on the cart in N.
    pub struct CartPole {
        /// Mass of the cart, kg.
        pub cart: f64,
        /// Mass of the rod, kg.
        pub rod: f64,
        /// Half the length of the rod, m.
        pub half_length: f64,
        /// Friction of the rail, N s/m, and of the hinge, N m s.
        pub friction: [f64; 2],
    }
}

#[rayleigh_system]
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
}
