//! The potential of M. Hénon and C. Heiles (1964). At E = 1/6 the motion reaches the saddles of V; almost all
//! of it is chaotic.

use dalembert::{Elementary, State, rayleigh_system};

/// L = ½|v|² − ½(x² + y²) − x²y + ⅓y³; no dissipation, so R is absent.
#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
#[must_use]
pub fn henon_heiles(q: [f64; 2], v: [f64; 2]) -> f64 {
    let [x, y] = q;
    let potential = 0.5 * (x * x + y * y) + x * x * y - y * y * y / 3.0;
    0.5 * (v[0] * v[0] + v[1] * v[1]) - potential
}

impl HenonHeiles {
    /// On the line x = 0 with E = `energy`.
    #[must_use]
    pub fn start(energy: f64, y: f64, v_y: f64) -> State<f64, 2> {
        let square = 2.0 * energy - v_y * v_y - y * y + 2.0 / 3.0 * (y * y * y);
        State { q: [0.0, y].into(), p: [Elementary::sqrt(square), v_y].into() }
    }

    /// E = ½|p|² + V.
    #[must_use]
    pub fn energy_of(state: &State<f64, 2>) -> f64 {
        let (x, y) = (state.q[0], state.q[1]);
        0.5 * state.p.norm_squared() + 0.5 * (x * x + y * y) + x * x * y - y * y * y / 3.0
    }
}
