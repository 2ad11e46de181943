//! The systems of the collection that it alone has.

use dalembert::rayleigh_system;

/// Two oscillators of frequencies 1 and κ, along axes turned by an angle with cosine c and sine s.
#[rayleigh_system(rule = [trapezoidal, gauss])]
pub fn pair(q: [f64; 2], v: [f64; 2], kappa: f64, c: f64, s: f64) -> f64 {
    let (slow, fast) = (c * q[0] + s * q[1], c * q[1] - s * q[0]);
    0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.5 * slow * slow - 0.5 * kappa * kappa * fast * fast
}

/// A mass between springs of stiffness 1 on the left and k on the right.
#[rayleigh_system(rule = [trapezoidal, gauss])]
pub fn two_springs(q: [f64; 1], v: [f64; 1], k: f64) -> f64 {
    let stiffness = if q[0] > 0.0 { k } else { 1.0 };
    0.5 * v[0] * v[0] - 0.5 * stiffness * q[0] * q[0]
}

/// A pendulum that a pulse of force hits.
pub struct Struck {
    pub r: f64,
    pub force: f64,
    pub at: f64,
    pub width: f64,
}

#[rayleigh_system(rule = [trapezoidal, gauss])]
impl Struck {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] + q[0].cos()
    }
    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.5 * self.r * v[0] * v[0]
    }
    fn force(&self, _q: [f64; 1], _v: [f64; 1], t: f64) -> [f64; 1] {
        let x = (t - self.at) / self.width;
        [self.force * (-x * x).exp()]
    }
}

/// A pendulum under a periodic force.
pub struct Forced {
    pub r: f64,
    pub force: f64,
    pub frequency: f64,
}

#[rayleigh_system(rule = [trapezoidal, gauss])]
impl Forced {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] + q[0].cos()
    }
    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.5 * self.r * v[0] * v[0]
    }
    fn force(&self, _q: [f64; 1], _v: [f64; 1], t: f64) -> [f64; 1] {
        [self.force * (self.frequency * t).cos()]
    }
}
