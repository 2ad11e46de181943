//! A mass on springs with Coulomb sliders in series, several in parallel: W. D. Iwan's model of hysteresis
//! (1966), and its motion from event to event, in closed form between them.

use dalembert::rayleigh_system;
use nalgebra::{SVector, Vector4};

use crate::draws::Draws;

/// Springs with a slider.
pub const SLIDERS: usize = 3;

/// A mass q₀ on a spring, under a constant load, beside nodes q₁ … q₃ without mass, each between a spring and
/// a slider.
#[derive(Clone, Copy, Debug)]
pub struct Iwan {
    /// The mass, its own spring, the load on it, and its drag.
    pub m: f64,
    /// The spring of the mass to the ground.
    pub k0: f64,
    /// The load on the mass.
    pub load: f64,
    /// The spring of each node.
    pub k: [f64; SLIDERS],
    /// The limit of each slider.
    pub mu: [f64; SLIDERS],
    /// 1 where the spring is at the mass and the slider on the ground, 0 the other way round.
    pub at_mass: [f64; SLIDERS],
}

#[rayleigh_system(rule = proximal, parameters = [m, k0, load, k[0], k[1], mu[0], mu[1]])]
impl Iwan {
    fn lagrangian(&self, q: [f64; 4], v: [f64; 4]) -> f64 {
        let mut sum = 0.5 * self.m * v[0] * v[0] - 0.5 * self.k0 * q[0] * q[0] + self.load * q[0];
        for j in 0..3 {
            let stretch = self.at_mass[j] * q[0] - q[j + 1];
            sum -= 0.5 * self.k[j] * stretch * stretch;
        }
        sum
    }

    fn rayleigh(&self, v: [f64; 4]) -> f64 {
        let mut sum = 0.0;
        for j in 0..3 {
            sum += self.mu[j] * ((1.0 - self.at_mass[j]) * v[0] - v[j + 1]).abs();
        }
        sum
    }
}

impl Iwan {
    /// One at random, with nodes of both kinds.
    #[must_use]
    pub fn drawn(draws: &mut Draws) -> Self {
        Self {
            m: draws.between(0.5, 2.0),
            k0: [0.0, draws.between(0.0, 1.0)][draws.below(2)],
            load: draws.between(-0.5, 0.5),
            k: std::array::from_fn(|_| draws.between(0.2, 4.0)),
            mu: std::array::from_fn(|_| draws.between(0.05, 1.0)),
            at_mass: std::array::from_fn(|_| draws.below(2) as f64),
        }
    }

    /// The force of each slider on the mass against its motion, in a state of the system.
    #[must_use]
    pub fn forces(&self, q: &Vector4<f64>) -> [f64; SLIDERS] {
        std::array::from_fn(|j| {
            let stretch = self.at_mass[j] * q[0] - q[j + 1];
            // A spring on the ground is stretched by what its slider holds.
            self.k[j] * if self.at_mass[j] == 1.0 { stretch } else { -stretch }
        })
    }
}

/// The motion of the mass, with the force of each slider.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    /// The system.
    pub iwan: Iwan,
    /// The place and the velocity of the mass.
    pub q: f64,
    /// Its velocity.
    pub v: f64,
    /// The forces of the sliders against it.
    pub forces: [f64; SLIDERS],
    /// Which of them slide.
    pub slides: [bool; SLIDERS],
    /// What friction took.
    pub dissipated: f64,
    /// How often a slider has begun to slide or come to stick.
    pub events: usize,
}

impl Motion {
    /// From rest of the sliders: their forces within their limits.
    #[must_use]
    pub fn new(iwan: Iwan, q: f64, v: f64, forces: [f64; SLIDERS]) -> Self {
        Self { iwan, q, v, forces, slides: [false; SLIDERS], dissipated: 0.0, events: 0 }
    }

    /// The place and velocity after a time as long as what slides goes on, and the forces.
    fn after(&self, time: f64) -> (f64, f64, [f64; SLIDERS]) {
        let s = &self.iwan;
        let springs = (0..SLIDERS).filter(|&j| !self.slides[j]);
        let k = s.k0 + springs.clone().map(|j| s.k[j]).sum::<f64>();
        let force = s.load - s.k0 * self.q - self.forces.iter().sum::<f64>();
        let (x, v) = if k > 0.0 {
            let (frequency, shift) = ((k / s.m).sqrt(), force / k);
            let (sine, cosine) = (frequency * time).sin_cos();
            let x = shift * (1.0 - cosine) + self.v / frequency * sine;
            (x, shift * frequency * sine + self.v * cosine)
        } else {
            (self.v * time + 0.5 * force / s.m * time * time, self.v + force / s.m * time)
        };
        let forces =
            std::array::from_fn(
                |j| {
                    if self.slides[j] { self.forces[j] } else { self.forces[j] + s.k[j] * x }
                },
            );
        (self.q + x, v, forces)
    }

    /// Whether something goes on otherwise by a time.
    fn changes(&self, time: f64) -> bool {
        let (_, v, forces) = self.after(time);
        (0..SLIDERS).any(|j| match self.slides[j] {
            true => v * self.forces[j] < 0.0,
            false => forces[j].abs() > self.iwan.mu[j] && v * forces[j] > 0.0,
        })
    }

    /// Goes on by a time, by looks of a thousandth of the fastest period.
    pub fn advance(&mut self, mut left: f64) {
        let s = self.iwan;
        let look = 2e-3 * (s.m / (s.k0 + s.k.iter().sum::<f64>())).sqrt();
        while left > 0.0 {
            let mut time = look.min(left);
            let is_event = self.changes(time);
            if is_event {
                let (mut low, mut high) = (0.0, time);
                while high - low > 1e-16 {
                    let middle = 0.5 * (low + high);
                    if middle <= low || middle >= high {
                        break;
                    }
                    if self.changes(middle) { high = middle } else { low = middle }
                }
                time = high;
            }
            let (q, v, forces) = self.after(time);
            for j in 0..SLIDERS {
                if self.slides[j] {
                    self.dissipated += self.forces[j] * (q - self.q);
                }
            }
            let before = *self;
            (self.q, self.v, self.forces) = (q, v, forces);
            left -= time;
            if is_event {
                for (j, force) in forces.into_iter().enumerate() {
                    let slides = match before.slides[j] {
                        true => v * force >= 0.0,
                        false => force.abs() > s.mu[j] && v * force > 0.0,
                    };
                    if slides && !before.slides[j] {
                        self.forces[j] = s.mu[j].copysign(force);
                    }
                    self.events += usize::from(slides != before.slides[j]);
                    self.slides[j] = slides;
                }
            }
        }
    }

    /// The state of the system with these forces.
    #[must_use]
    pub fn place(&self) -> SVector<f64, 4> {
        let s = &self.iwan;
        let node = |j: usize| match s.at_mass[j] == 1.0 {
            true => self.q - self.forces[j] / s.k[j],
            false => self.forces[j] / s.k[j],
        };
        Vector4::new(self.q, node(0), node(1), node(2))
    }
}
