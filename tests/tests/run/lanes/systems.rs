//! Systems that are stepped in lanes.

use dalembert::rayleigh_system;

/// The ring potential of the examples.
#[derive(Clone, Debug)]
pub struct Ring {
    pub k: f64,
    pub height: f64,
}

#[rayleigh_system(rule = trapezoidal, lanes = explicit)]
impl Ring {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let s = q[0] * q[0] + q[1] * q[1];
        0.5 * (v[0] * v[0] + v[1] * v[1]) - self.height * s * (s - 1.0).powi(2)
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.k * (v[0] * v[0] + v[1] * v[1])
    }
}

/// No field at all.
#[derive(Clone, Debug)]
pub struct HenonHeiles;

#[rayleigh_system(rule = [midpoint, trapezoidal], lanes = explicit)]
impl HenonHeiles {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let potential = 0.5 * (q[0] * q[0] + q[1] * q[1]) + q[0] * q[0] * q[1] - q[1].powi(3) / 3.0;
        0.5 * (v[0] * v[0] + v[1] * v[1]) - potential
    }
}

/// Masses of their own, a tilted floor, friction that pushes at rest: nothing of the matrices is 1 or 0.
#[derive(Clone, Debug)]
pub struct Pendulums {
    pub m: [f64; 2],
    pub g: f64,
    pub spring: f64,
    /// Of ∂L/∂v at rest.
    pub drift: f64,
    /// Of ∂R/∂v at rest.
    pub thrust: f64,
    pub r: f64,
}

#[rayleigh_system(rule = trapezoidal, lanes = explicit)]
impl Pendulums {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let mut l = self.drift * v[0];
        for i in 0..2 {
            l += 0.5 * self.m[i] * v[i] * v[i] + self.m[i] * self.g * q[i].cos();
        }
        l - self.spring * (1.0 - (q[0] - q[1]).cos() * (0.1 * q[0].sin()).exp())
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.r * (v[0] * v[0] + 2.0 * v[1] * v[1]) + self.thrust * v[1]
    }
}

/// Six masses, each coupled to every other by inertia and friction.
#[derive(Clone, Debug)]
pub struct Coupled {
    pub mass: [[f64; 6]; 6],
    pub damping: [[f64; 6]; 6],
    pub spring: f64,
}

#[rayleigh_system(rule = trapezoidal, lanes = explicit)]
impl Coupled {
    fn lagrangian(&self, q: [f64; 6], v: [f64; 6]) -> f64 {
        let mut l = 0.0;
        for i in 0..6 {
            for j in 0..6 {
                l += 0.5 * self.mass[i][j] * v[i] * v[j];
            }
        }
        for i in 0..5 {
            let d = q[i + 1] - q[i];
            l -= self.spring * (0.5 * d * d + 0.25 * d.powi(4));
        }
        l - 0.5 * q[0] * q[0]
    }

    fn rayleigh(&self, v: [f64; 6]) -> f64 {
        let mut r = 0.0;
        for i in 0..6 {
            for j in 0..6 {
                r += 0.5 * self.damping[i][j] * v[i] * v[j];
            }
        }
        r
    }
}

/// A wall, a ramp, and fields that are no numbers.
#[derive(Clone, Debug)]
pub struct Branchy {
    pub floor: Floor,
    pub has_wall: bool,
    pub teeth: u32,
    pub wind: Option<f64>,
}

#[derive(Clone, Copy, Debug)]
pub enum Floor {
    Flat,
    Ramp(f64),
}

#[rayleigh_system(rule = trapezoidal, lanes = explicit)]
impl Branchy {
    const STIFFNESS: f64 = 3.0;

    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        let mut potential = match self.floor {
            Floor::Flat => 0.0,
            Floor::Ramp(slope) => slope * q[0],
        };
        if self.has_wall && q[0] > 1.0 {
            potential += Self::STIFFNESS * (q[0] - 1.0).powi(2);
        } else if q[0].abs() < 0.3 || q[0] < -1.5 {
            potential += 0.1 * (3.0 * q[0]).sin() - 0.7 * q[0].min(-1.6);
        }
        0.5 * v[0] * v[0] - potential - 0.2 * q[0].powi(4) + (f64::from(self.teeth) * q[0]).cos()
    }

    fn force(&self, q: [f64; 1], _v: [f64; 1]) -> [f64; 1] {
        [if q[0].is_sign_negative() { self.wind.unwrap_or(0.0) } else { -0.1 }]
    }
}

/// Every function, comparison and question that a body may hold.
#[derive(Clone, Debug)]
pub struct Everything {
    pub k: f64,
    pub is_on: bool,
}

#[rayleigh_system(rule = trapezoidal, lanes = explicit)]
impl Everything {
    const IS_MEANT: bool = true;

    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let x = 0.3 * q[0].sin();
        let y = 1.5 + 0.5 * q[1].cos();
        let roots =
            y.sqrt() + y.cbrt() + y.recip() + y.powi(5) + y.powi(-3) + y.powf(self.k) + self.k.powf(x);
        let exponentials = x.exp() + x.exp2() + x.exp_m1() + y.ln() + y.log2() + y.log10() + x.ln_1p();
        let circular = x.tan() + x.asin() + x.acos() + x.atan() + x.atan2(y) + y.atan2(self.k);
        let hyperbolic = x.sinh() + x.cosh() + x.tanh() + x.asinh() + (1.5 + y).acosh() + x.atanh();
        let pieces = x.abs() + x.signum() * y + y.copysign(x) + x.min(0.1) + x.max(-0.1) + x.clamp(-0.2, 0.2);
        let pairs = x.hypot(self.k) + x.mul_add(y, self.k) + y.log(3.0) + 2.0_f64.powf(x) + 0.5_f64.hypot(y);
        let mut potential = 0.05 * (roots + exponentials + circular + hyperbolic + pieces + pairs);
        if (x.is_nan() || y.is_infinite()) && !self.is_on {
            potential += 1.0;
        }
        if x.is_finite() && (q[0].is_sign_positive() || q[1] != 0.5) && q[0] >= -2.0 {
            potential += 0.1 * x * x;
        }
        if self.k <= 1.0 || (self.is_on && q[1].is_sign_negative()) {
            potential -= 0.2 * y;
        }
        if Self::IS_MEANT && self.k == 1.0 {
            potential += x;
        }
        0.5 * (v[0] * v[0] + v[1] * v[1]) - potential - 0.5 * (q[0] * q[0] + q[1] * q[1])
    }
}

/// More coordinates than are unrolled, a band of three: at rest but for the first, floors rise as the others
/// begin to move.
#[derive(Clone, Debug)]
pub struct Chain {
    pub k: f64,
    pub r: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss], lanes = [explicit, gauss, midpoint])]
impl Chain {
    fn lagrangian(&self, q: [f64; 18], v: [f64; 18]) -> f64 {
        let (mut l, mut before) = (0.0, 0.0);
        for i in 0..18 {
            let d = q[i] - before;
            l += 0.5 * v[i] * v[i] - self.k * (0.5 * d * d + 0.25 * d.powi(4));
            before = q[i];
        }
        l
    }

    fn rayleigh(&self, v: [f64; 18]) -> f64 {
        let mut r = 0.0;
        for v in v {
            r += 0.5 * self.r * v * v;
        }
        r
    }
}

/// Neighbours coupled by inertia: a matrix with a band of three.
#[derive(Clone, Debug)]
pub struct Band {
    pub coupling: f64,
    pub r: f64,
}

#[rayleigh_system(rule = trapezoidal, lanes = explicit)]
impl Band {
    fn lagrangian(&self, q: [f64; 5], v: [f64; 5]) -> f64 {
        let mut l = 0.0;
        for i in 0..5 {
            l += 0.5 * v[i] * v[i] + q[i].cos();
        }
        for i in 0..4 {
            l += self.coupling * v[i] * v[i + 1];
        }
        l
    }

    fn rayleigh(&self, v: [f64; 5]) -> f64 {
        0.5 * self.r * (v[0] * v[0] + (v[1] - v[2]) * (v[1] - v[2]))
    }
}

/// Pushed by an input, in a way of its own.
#[derive(Clone, Debug)]
pub struct Pushed {
    pub m: f64,
    pub r: f64,
    pub is_blunt: bool,
}

#[rayleigh_system(rule = [midpoint, trapezoidal], lanes = explicit)]
impl Pushed {
    const GAIN: f64 = 0.7;

    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * self.m * v[0] * v[0] + 0.5 * v[1] * v[1] + self.m * q[0].cos() - 0.5 * (q[0] - q[1]).powi(2)
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.r * (v[0] * v[0] + v[1] * v[1])
    }

    fn force(&self, q: [f64; 2], _v: [f64; 2], u: [f64; 2]) -> [f64; 2] {
        let turned = if self.is_blunt { u[1].abs() } else { u[1] };
        [Self::GAIN * u[0] - self.m * u[1] * q[1], turned * q[0].sin()]
    }
}

/// In single precision.
#[rayleigh_system(rule = trapezoidal, lanes = explicit)]
pub fn single(q: [f32; 1], v: [f32; 1], m: f32, k: f32, r: f32) -> (f32, f32) {
    (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
}
