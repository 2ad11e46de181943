//! The systems of the collection.

use dalembert::rayleigh_system;

/// L = ½mv² − ½kq², R = ½rv².
#[rayleigh_system(rule = [trapezoidal, gauss])]
pub fn oscillator(q: [f64; 1], v: [f64; 1], m: f64, k: f64, r: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
}

/// L = ½v² + cos q, R = ½rv².
#[rayleigh_system(rule = [trapezoidal, gauss])]
pub fn pendulum(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
}

/// L = ½|v|² + 1/|q|.
#[rayleigh_system(rule = [trapezoidal, gauss])]
pub fn kepler(q: [f64; 2], v: [f64; 2]) -> f64 {
    0.5 * (v[0] * v[0] + v[1] * v[1]) + 1.0 / (q[0] * q[0] + q[1] * q[1]).sqrt()
}

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

/// Two equal links with masses at their ends, angles from the vertical.
#[rayleigh_system(rule = [trapezoidal, gauss])]
pub fn double_pendulum(q: [f64; 2], v: [f64; 2]) -> f64 {
    v[0] * v[0] + 0.5 * v[1] * v[1] + v[0] * v[1] * (q[0] - q[1]).cos() + 2.0 * q[0].cos() + q[1].cos()
}

/// Hénon and Heiles.
#[rayleigh_system(rule = [trapezoidal, gauss])]
pub fn henon_heiles(q: [f64; 2], v: [f64; 2]) -> f64 {
    0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.5 * (q[0] * q[0] + q[1] * q[1]) - q[0] * q[0] * q[1]
        + q[1].powi(3) / 3.0
}

/// Masses of the chain.
pub const LINKS: usize = 6;

/// Fermi, Pasta, Ulam and Tsingou's chain between walls, with damping.
#[rayleigh_system(rule = [trapezoidal, gauss])]
pub fn chain(q: [f64; 6], v: [f64; 6], beta: f64, r: f64) -> (f64, f64) {
    let mut speed = 0.0;
    let mut potential =
        0.5 * q[0] * q[0] + 0.25 * beta * q[0].powi(4) + 0.5 * q[5] * q[5] + 0.25 * beta * q[5].powi(4);
    for v in v {
        speed += v * v;
    }
    for i in 0..5 {
        let d = q[i + 1] - q[i];
        potential += 0.5 * d * d + 0.25 * beta * d.powi(4);
    }
    (0.5 * speed - potential, 0.5 * r * speed)
}

/// A particle on a spring whose stiffness changes with time, k = 1 + a cos Ωt (Mathieu's equation), R = ½rv².
pub struct Mathieu {
    pub a: f64,
    pub frequency: f64,
    pub r: f64,
}

#[rayleigh_system(rule = [trapezoidal, gauss])]
impl Mathieu {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
        0.5 * v[0] * v[0] - 0.5 * (1.0 + self.a * (self.frequency * t).cos()) * q[0] * q[0]
    }
    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.5 * self.r * v[0] * v[0]
    }
}

/// A pendulum with its pivot shaken up and down, y = a cos Ωt (Kapitza's pendulum), R = ½rv².
pub struct ShakenPivot {
    pub a: f64,
    pub frequency: f64,
    pub r: f64,
}

#[rayleigh_system(rule = [trapezoidal, gauss])]
impl ShakenPivot {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
        let speed = -self.a * self.frequency * (self.frequency * t).sin();
        0.5 * v[0] * v[0] + speed * q[0].sin() * v[0] + q[0].cos()
    }
    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.5 * self.r * v[0] * v[0]
    }
}

/// A pendulum of length 1 + b sin Ωt.
pub struct Swing {
    pub b: f64,
    pub frequency: f64,
}

#[rayleigh_system(rule = [trapezoidal, gauss])]
impl Swing {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
        let length = 1.0 + self.b * (self.frequency * t).sin();
        0.5 * length * length * v[0] * v[0] + length * q[0].cos()
    }
}

/// A body that falls through air: L = ½v² − gq, R = ⅓c|v|³.
#[rayleigh_system(rule = [trapezoidal, gauss])]
pub fn falling(q: [f64; 1], v: [f64; 1], g: f64, c: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] - g * q[0], c / 3.0 * v[0].abs().powi(3))
}
