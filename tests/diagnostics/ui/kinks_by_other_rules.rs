//! Kinks of R under rules that have no step where the motion stops; and R whose forces have no jump.

use dalembert::rayleigh_system;

struct ByDefault;

#[rayleigh_system]
impl ByDefault {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.5 * q[0] * q[1].abs() + 0.1 * v[0].abs().powi(3)
    }
    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.1 * v[0].abs() + (1.0 + q[0] * q[0]) * v[0].hypot(v[1]) + (v[0] - v[1]).max(-v[0]) + self.drag(v)
    }
    fn drag(&self, v: [f64; 2]) -> f64 {
        (v[0] * v[0] + (v[1] - 0.1).powi(2)).sqrt() + f64::abs(v[1])
    }
}

#[rayleigh_system(rule = [trapezoidal, gauss], lanes = [explicit, gauss])]
fn block(q: [f64; 1], v: [f64; 1], mu: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] - 0.5 * q[0] * q[0], mu * v[0].abs())
}

struct BesideTheRule {
    mu: f64,
}

#[rayleigh_system(rule = [midpoint, proximal, gauss])]
impl BesideTheRule {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - 0.5 * q[0] * q[0]
    }
    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        self.mu * v[0].abs()
    }
}

struct Written;

#[rayleigh_system]
impl Written {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - q[1]
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        (4.0 * v[0] * v[0] + 0.5 * v[1] * v[1]).sqrt()
            + (v[0] * v[0] + v[0] * v[1] + v[1] * v[1]).powf(0.5)
            + v[0] * v[0].signum()
            + v[1].copysign(1.0)
    }
}

struct Branches;

#[rayleigh_system]
impl Branches {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q[0]
    }
    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        if v[0] > 0.0 { 0.2 * v[0] } else { -0.1 * v[0] }
    }
}

struct Held;

#[rayleigh_system]
impl Held {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - q[1]
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        v[0].abs()
    }
    fn constraints(&self, q: [f64; 2]) -> [f64; 1] {
        [q[0] * q[0] + q[1] * q[1] - 1.0]
    }
}

/// Nothing from here on is refused.
macro_rules! sound {
    ($($name:ident: |$q:ident, $v:ident, $c:ident| $r:expr;)*) => {$(
        #[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
        fn $name($q: [f64; 2], $v: [f64; 2], $c: f64) -> (f64, f64) {
            (0.5 * ($v[0] * $v[0] + $v[1] * $v[1]) - 0.5 * $q[0].abs() * $q[1].max($q[0]), $r)
        }
    )*};
}

sound! {
    cubed: |q, v, c| c * v[0].abs().powi(3) + c * v[0].abs().powf(1.5);
    times_square: |q, v, c| c * v[0] * v[0] * v[0].abs();
    times_itself: |q, v, c| c * v[0] * v[0].abs();
    of_a_slip: |q, v, c| { let u = v[0] - c * v[1]; u * u * u.abs() };
    length_cubed: |q, v, c| v[0].hypot(v[1]) * (c * v[0] * v[0] + c * v[1] * v[1]);
    regular: |q, v, c| (v[0] * v[0] + c * c).sqrt() + v[1].hypot(c);
    ln_cosh: |q, v, c| {
        let x = ((v[0] + q[0]) / c).abs();
        c * if x < 1.0 { x.cosh().ln() } else { x + (-2.0 * x).exp().ln_1p() - 0.6931471805599453 }
    };
    ln_cosh_at_once: |q, v, c| { let x = (v[0] / c).abs(); c * (x + (-2.0 * x).exp().ln_1p()) };
    of_coordinates: |q, v, c| c * q[0].abs() * v[0] * v[0] + q[0].hypot(q[1]) * v[1] * v[1];
    by_side: |q, v, c| if v[0] > 0.0 { c * v[0] * v[0] } else { 2.0 * c * v[0] * v[0] };
    times_its_sign: |q, v, c| c * v[0] * v[0] * v[0] * v[0].signum();
    form_cubed: |q, v, c| (v[0] * v[0] + c * v[0] * v[1] + v[1] * v[1]).powf(1.5);
    form_beside: |q, v, c| (v[0] * v[0] + c * v[0] * v[1] + v[1] * v[1] + c * c).sqrt();
    of_squares: |q, v, c| (c * v[0].powi(4) + v[1].powi(4)).sqrt();
    turning: |q, v, c| if q[0] > 0.0 { c * v[0] } else { -c * v[0] };
    huber: |q, v, c| { let x = v[0].abs(); c * if x < 1.0 { 0.5 * x * x } else { x - 0.5 } };
    // Smooth where c is a width above 0.
    huber_by_field: |q, v, c| { let x = v[0].abs(); if x < c { 0.5 * x * x / c } else { x - 0.5 * c } };
    huber_by_branch: |q, v, c| {
        let x = if v[0] > 0.0 { v[0] } else { -v[0] };
        if x < c { 0.5 * x * x / c } else { x - 0.5 * c }
    };
    huber_of_form: |q, v, c| {
        let x = (v[0] * v[0] + v[0] * v[1] + v[1] * v[1]).sqrt();
        if x < c { 0.5 * x * x / c } else { x - 0.5 * c }
    };
    // Of no kink that another rule would take.
    not_linear: |q, v, c| c * (v[0] * v[0] - 1.0).abs();
    not_apart: |q, v, c| c * v[0].abs() * (1.0 + v[1] * v[1]);
}

struct Forced;

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
impl Forced {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - q[0].abs() + 0.1 * v[0] * v[0].abs()
    }
    fn force(&self, q: [f64; 1], v: [f64; 1]) -> [f64; 1] {
        [-v[0].abs() * v[0] - q[0].abs().max(v[0])]
    }
}

fn main() {}
