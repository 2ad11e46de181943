//! A cart with a pole, and the C functions of its step, in single precision.
#![cfg_attr(target_os = "none", no_std)]

use dalembert::{Midpoint, rayleigh_system};

dalembert_c::parameters! {
    /// A rod hinged to a cart on a rail; q is (position in m, angle from upright in rad), u the force on the cart in N.
    pub struct CartPole {
        /// Mass of the cart, kg.
        pub cart: f32,
        /// Mass of the rod, kg.
        pub rod: f32,
        /// Half the length of the rod, m.
        pub half_length: f32,
        /// Friction of the rail, N s/m, and of the hinge, N m s.
        pub friction: [f32; 2],
    }
}

#[rayleigh_system]
impl CartPole {
    fn lagrangian(&self, q: [f32; 2], v: [f32; 2]) -> f32 {
        let (sine, cosine) = q[1].sin_cos();
        let spin = self.half_length * v[1];
        let (x, y) = (v[0] + cosine * spin, -sine * spin);
        let kinetic = 0.5 * self.cart * v[0] * v[0] + self.rod * (0.5 * (x * x + y * y) + spin * spin / 6.0);
        kinetic - self.rod * 9.81 * self.half_length * cosine
    }

    fn rayleigh(&self, v: [f32; 2]) -> f32 {
        0.5 * (self.friction[0] * v[0] * v[0] + self.friction[1] * v[1] * v[1])
    }

    fn force(&self, _q: [f32; 2], _v: [f32; 2], u: [f32; 1]) -> [f32; 2] {
        [u[0], 0.0]
    }
}

dalembert_c::c_api! { cart_pole: CartPole, rule: Midpoint }

dalembert_c::no_panic!();
