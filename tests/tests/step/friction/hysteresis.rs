//! Springs and sliders in series: coordinates without mass that dry friction alone holds.

use dalembert::nalgebra::{Vector4, vector};
use dalembert::{Discretise, Proximal, State, rayleigh_system};
use dalembert_tests::draws::Draws;
use dalembert_tests::hysteresis::{Iwan, Motion, SLIDERS};

/// A mass on a spring that ends in a slider.
const JENKIN: Iwan = Iwan {
    m: 1.0,
    k0: 0.0,
    load: 0.0,
    k: [4.0, 0.0, 0.0],
    mu: [0.7, 0.0, 0.0],
    at_mass: [1.0; SLIDERS],
};

#[test]
fn explore() {
    let mut draws = Draws::new(1);
    let mut worst = [0.0_f64; 3];
    for number in 0..20 {
        let mut iwan = Iwan::drawn(&mut draws);
        if let Ok(k) = std::env::var("KIND") { iwan.at_mass = [k.parse().unwrap(); 3]; }
        let (q, v) = (draws.between(-1.0, 1.0), draws.between(-2.0, 2.0));
        let forces = std::array::from_fn(|j| iwan.mu[j] * draws.between(-1.0, 1.0));
        let mut motion = Motion::new(iwan, q, v, forces);
        let start = State { q: motion.place(), p: vector![iwan.m * v, 0.0, 0.0, 0.0] };
        let time = 5.0;
        motion.advance(time);
        let errors: Vec<f64> = [100, 200, 400, 800].iter().map(|&steps: &usize| {
            let end = iwan.by(Proximal, time / steps as f64).run(start).nth(steps - 1).unwrap();
            match end { Ok(step) => (step.state.q[0] - motion.q).abs().max((step.state.p[0] / iwan.m - motion.v).abs()).max(
              iwan.forces(&step.state.q).iter().zip(motion.forces).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)),
              Err(e) => {println!("{e}"); f64::NAN} }
        }).collect();
        println!("{number} {:?} events {} {errors:.1e?}", iwan.at_mass, motion.events);
    }
}
