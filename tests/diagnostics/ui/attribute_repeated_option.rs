use dalembert::rayleigh_system;

struct System { k: f64 }

#[rayleigh_system(
    rule = midpoint,
    rule = gauss,
    derivatives = auto,
    derivatives = expanded,
    parameters = k,
    parameters = [k],
    step_derivatives = first,
    step_derivatives = second,
    lanes = explicit,
    lanes = gauss,
    multiply_add = fused,
    multiply_add = fused,
    crate = dalembert,
    crate = dalembert
)]
impl System {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - 0.5 * self.k * q[0] * q[0]
    }
}

fn main() {}
