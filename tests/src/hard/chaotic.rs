//! Chaotic motions: what can be asked of them is their energy.

use dalembert::{State, rayleigh_system};

/// Two equal pendulums, one hung from the other, mass and length 1, g = 1.
#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
pub fn two_pendulums(q: [f64; 2], v: [f64; 2], r: f64) -> (f64, f64) {
    let kinetic = v[0] * v[0] + 0.5 * v[1] * v[1] + v[0] * v[1] * (q[0] - q[1]).cos();
    (kinetic + 2.0 * q[0].cos() + q[1].cos(), 0.5 * r * (v[0] * v[0] + (v[1] - v[0]).powi(2)))
}

impl TwoPendulums {
    /// The upper arm level, the lower one hanging and thrown sideways at speed 4: E = 7, where both turn
    /// over.
    pub fn high_energy(&self) -> State<f64, 2> {
        State { q: [std::f64::consts::FRAC_PI_2, 0.0].into(), p: [0.0, 4.0].into() }
    }
}

/// L = ½|v|² − ½|q|² − x²y + ⅓y³. At E = 1/6 the motion reaches the saddles of V; almost all of it is
/// chaotic.
#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
pub fn henon_heiles(q: [f64; 2], v: [f64; 2], r: f64) -> (f64, f64) {
    let [x, y] = q;
    let speed = v[0] * v[0] + v[1] * v[1];
    (0.5 * speed - 0.5 * (x * x + y * y) - x * x * y + y * y * y / 3.0, 0.5 * r * speed)
}

impl HenonHeiles {
    /// On the line x = 0 with E = `energy`.
    pub fn start(energy: f64, y: f64, v_y: f64) -> State<f64, 2> {
        let square = 2.0 * energy - v_y * v_y - y * y + 2.0 / 3.0 * y.powi(3);
        State { q: [0.0, y].into(), p: [square.sqrt(), v_y].into() }
    }

    /// E = ½|p|² + V.
    pub fn energy_of(state: &State<f64, 2>) -> f64 {
        let (x, y) = (state.q[0], state.q[1]);
        0.5 * state.p.norm_squared() + 0.5 * (x * x + y * y) + x * x * y - y * y * y / 3.0
    }
}
