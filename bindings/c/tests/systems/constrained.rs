//! Systems on constraints: on a sphere; two rods with an input, by lengths; a skate that the clock turns.

use dalembert::{Midpoint, Trapezoidal, rayleigh_system};

dalembert_c::parameters! {
    /// A bob on the unit sphere, with drag; q in m.
    pub struct Spherical {
        /// Mass, kg.
        pub m: f64,
        /// Drag, N s/m.
        pub c: f64,
    }
}

#[rayleigh_system]
impl Spherical {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        0.5 * self.m * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) - self.m * 9.81 * q[2]
    }

    fn rayleigh(&self, v: [f64; 3]) -> f64 {
        0.5 * self.c * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
    }

    fn constraints(&self, q: [f64; 3]) -> [f64; 1] {
        [0.5 * (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] - 1.0)]
    }
}

dalembert_c::c_api! { spherical: Spherical, rule: Midpoint }

dalembert_c::parameters! {
    /// Two bobs in a plane on massless rods of 1 m and 0.8 m; u in N pushes the second, q are places in m.
    pub struct Rods {
        /// Masses, kg.
        pub m: [f64; 2],
    }
}

#[rayleigh_system(rule = trapezoidal, parameters = [m[0], m[1]])]
impl Rods {
    fn lagrangian(&self, q: [f64; 4], v: [f64; 4]) -> f64 {
        let mut sum = 0.0;
        for i in 0..2 {
            sum += 0.5 * self.m[i] * (v[2 * i] * v[2 * i] + v[2 * i + 1] * v[2 * i + 1]);
            sum -= self.m[i] * 9.81 * q[2 * i + 1];
        }
        sum
    }

    fn force(&self, _q: [f64; 4], _v: [f64; 4], u: [f64; 2]) -> [f64; 4] {
        [0.0, 0.0, u[0], u[1]]
    }

    fn constraints(&self, q: [f64; 4]) -> [f64; 2] {
        let (x, y) = (q[2] - q[0], q[3] - q[1]);
        [(q[0] * q[0] + q[1] * q[1]).sqrt() - 1.0, (x * x + y * y).sqrt() - 0.8]
    }
}

dalembert_c::c_api! { rods: Rods, rule: Trapezoidal }

dalembert_c::parameters! {
    /// A skate on ice; q is its place in m and its direction in rad.
    pub struct Skate {
        /// Mass, kg.
        pub m: f32,
        /// How fast the clock turns it, rad/s.
        pub omega: f32,
    }
}

#[rayleigh_system]
impl Skate {
    fn lagrangian(&self, _q: [f32; 3], v: [f32; 3]) -> f32 {
        0.5 * self.m * (v[0] * v[0] + v[1] * v[1]) + 0.05 * v[2] * v[2]
    }

    fn constraints(&self, q: [f32; 3], t: f32) -> [f32; 1] {
        [q[2] - self.omega * t]
    }

    fn velocity_constraints(&self, q: [f32; 3], v: [f32; 3]) -> [f32; 1] {
        [v[1] * q[2].cos() - v[0] * q[2].sin()]
    }
}

dalembert_c::c_api! { skate: Skate, rule: Midpoint }
