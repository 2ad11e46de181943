use dalembert::{Discretise, Midpoint, State, rayleigh_system};

/// A particle in the potential s(s − 1)², s = |q|², with weak drag.
struct Ring {
    k: f64,
}

#[rayleigh_system]
impl Ring {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let s = q[0] * q[0] + q[1] * q[1];
        0.5 * (v[0] * v[0] + v[1] * v[1]) - s * (s - 1.0).powi(2)
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.k * (v[0] * v[0] + v[1] * v[1])
    }
}

fn main() -> Result<(), dalembert::StepError> {
    let ring = Ring { k: 1e-3 };
    let start = State::from_velocity(&ring, [0.0, 1.15549918674982], [0.5, 0.0])?;
    let mut trajectory = ring.by(Midpoint, 0.2).run(start);
    for sample in trajectory.sample_every(2000).take(5) {
        let sample = sample?;
        println!("t = {:6.1}   E = {:.4}", sample.time, sample.energy(&ring)?);
    }
    Ok(())
}
