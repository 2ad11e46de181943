use dalembert::rayleigh_system;

struct Pendulum {
    l: f64,
    c: [f64; 2],
}

#[rayleigh_system(step_derivatives = third)]
impl Pendulum {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * self.l * v[0] * v[0] + q[0].cos() * self.c[0]
    }
}

#[rayleigh_system(parameters = [], step_derivatives = [first, second])]
fn nothing_listed(q: [f64; 1], v: [f64; 1]) -> f64 {
    v[0] * v[0] - q[0]
}

#[rayleigh_system(parameters = [m], derivatives = num_dual)]
fn by_num_dual(q: [f64; 1], v: [f64; 1], m: f64) -> f64 {
    0.5 * m * v[0] * v[0] - q[0]
}

struct Hiding {
    l: f64,
    c: [f64; 2],
    order: usize,
}

#[rayleigh_system(parameters = [l, g, c, order])]
impl Hiding {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * self.l * v[0] * v[0] + q[0].cos() * self.order as f64 * self.c[0]
    }
}

fn main() {}
