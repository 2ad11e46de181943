//! Constraints that hold nothing, stand twice or are too many, and what they do not go with.

use dalembert::rayleigh_system;

struct Twice;

#[rayleigh_system]
impl Twice {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - q[1]
    }
    fn constraints(&self, q: [f64; 2]) -> [f64; 2] {
        let s = q[0] * q[0] + q[1] * q[1];
        [s - 1.0, s - 1.0]
    }
}

struct Nothing {
    length: f64,
}

#[rayleigh_system]
impl Nothing {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - q[1]
    }
    fn constraints(&self, _q: [f64; 2]) -> [f64; 1] {
        [self.length - 1.0]
    }
}

struct TooMany;

#[rayleigh_system]
impl TooMany {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q[0]
    }
    fn constraints(&self, q: [f64; 1]) -> [f64; 2] {
        [q[0] - 1.0, q[0] * q[0] - 1.0]
    }
}

struct Signature;

#[rayleigh_system]
impl Signature {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q[0]
    }
    fn constraints(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        q[0] * v[0]
    }
}

struct OfVelocity;

#[rayleigh_system]
impl OfVelocity {
    fn lagrangian(&self, q: [f64; 5], v: [f64; 5]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + v[3] * v[3] + v[4] * v[4]) - q[1]
    }
    fn constraints(&self, q: [f64; 5], t: f64) -> [f64; 1] {
        [t - 1.0 + 0.0 * q[0].sin().powi(0)]
    }
    fn velocity_constraints(&self, q: [f64; 5], v: [f64; 5]) -> [f64; 4] {
        [q[0] * v[1] - v[0], q[0] * v[1] - v[0], v[2] * v[2] - v[3], q[4] - 1.0]
    }
}

struct TooManyTogether;

#[rayleigh_system]
impl TooManyTogether {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q[0]
    }
    fn constraints(&self, q: [f64; 1]) -> [f64; 1] {
        [q[0] - 1.0]
    }
    fn velocity_constraints(&self, _q: [f64; 1], v: [f64; 1], t: f64) -> [f64; 1] {
        [v[0] - t]
    }
}

struct Asked {
    length: f64,
}

#[rayleigh_system(rule = [midpoint, gauss], lanes = midpoint, step_derivatives = second, parameters = [length, width])]
impl Asked {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - q[1]
    }
    fn constraints(&self, q: [f64; 2]) -> [f64; 1] {
        [q[0] * q[0] + q[1] * q[1] - self.length * self.length]
    }
}

struct ByDuals;

#[rayleigh_system(derivatives = num_dual)]
impl ByDuals {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - q[1]
    }
    fn constraints(&self, q: [f64; 2]) -> [f64; 1] {
        [q[0] * q[0] + q[1] * q[1] - 1.0]
    }
    fn time_scale(&self, q: [f64; 2]) -> f64 {
        q[0] * q[0] + 1.0
    }
}

struct OnceMore {
    l: f64,
}

#[rayleigh_system]
impl OnceMore {
    fn lagrangian(&self, q: [f64; 6], v: [f64; 6]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + v[3] * v[3]) - q[1]
    }
    fn constraints(&self, q: [f64; 6]) -> [f64; 4] {
        // Of the last the factor is a field: it may be any number.
        [q[0] - self.l, self.l - q[0], -0.5 * q[0] + self.l / 2.0, self.l * (q[0] - self.l)]
    }
    fn velocity_constraints(&self, q: [f64; 6], v: [f64; 6]) -> [f64; 2] {
        let s = q[2].sin();
        [s * v[0] - v[1], 3.0 * (v[1] - s * v[0] + 0.0 * q[1])]
    }
}

fn main() {
    // A view that constraints alone ask for is no second message.
    let _ = OfVelocity.at_time(0.0);
}
