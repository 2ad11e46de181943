//! What is measured: every scene stepped in every way, from one state with one step size.

use std::hint::black_box;
use std::rc::Rc;

use dalembert::nalgebra::SVector;
use dalembert::step::{ClosedForm, Flow, Segment};
use dalembert::{Discretise, Midpoint, State};
use dalembert_scenes::{
    Arm, DoublePendulum, EccentricKepler, FputChain8, FputChain32, HenonHeiles, Kepler, Oscillator,
    PendulumChain16, Ring, SpringChain8, SpringChain16, SpringChain32, num_dual,
};

use crate::by_hand::{self, ByHand};
use crate::stripped;

/// How a step's derivatives are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// Derived and written by hand, on the runtime's solver.
    ByHand,
    /// Written out by the attribute.
    Generated,
    /// By dual numbers when the program runs.
    NumDual,
    /// By hand, in a loop of its own that leaves out what the runtime's step checks and reports.
    Stripped,
}

impl Way {
    /// Every one.
    pub const ALL: [Self; 4] = [Self::ByHand, Self::Generated, Self::NumDual, Self::Stripped];

    /// A word for it.
    pub fn name(self) -> &'static str {
        match self {
            Self::ByHand => "by-hand",
            Self::Generated => "generated",
            Self::NumDual => "num-dual",
            Self::Stripped => "stripped",
        }
    }
}

/// Runs a number of steps from the scene's start; the end as q, then p.
type Run = Box<dyn Fn(usize) -> Vec<f64>>;

/// Evaluates a number of times.
type Evaluation = Box<dyn Fn(usize)>;

/// A scene, and the ways in which it can be stepped.
pub struct Scene {
    /// What it is called.
    pub name: &'static str,
    /// Degrees of freedom.
    pub degrees: usize,
    ways: Vec<(Way, Run)>,
    evaluations: Vec<(Way, Evaluation)>,
    starts: Vec<(Way, Evaluation)>,
}

/// After how many steps the ways of one scene are compared.
const COMPARED: usize = if cfg!(debug_assertions) { 30 } else { 200 };

/// Largest relative difference of two ways after [`COMPARED`] steps.
const TOLERANCE: f64 = 1e-12;

impl Scene {
    fn new(name: &'static str, degrees: usize) -> Self {
        Self { name, degrees, ways: Vec::new(), evaluations: Vec::new(), starts: Vec::new() }
    }

    /// Adds a way on the runtime's trajectory.
    fn with<L, const N: usize>(mut self, way: Way, system: L, start: Start<N>) -> Self
    where
        L: ClosedForm<Midpoint, N, Scalar = f64> + 'static,
    {
        let Start { q, v, h } = start;
        let start = State::from_velocity(&system, q, v).expect("the scene is regular");
        let system = Rc::new(system);
        let checked = Rc::clone(&system);
        let verify = move |times: usize| {
            for _ in 0..times {
                let (system, start) = black_box((&*checked, &start));
                start.verify(system).expect("the scene is as written");
                Flow::<Midpoint, N>::verify_momenta(system, start, h).expect("the scene's step is");
            }
        };
        self.starts.push((way, Box::new(verify)));
        self.evaluations.push((way, Box::new(evaluations(Rc::clone(&system), start.q, v.into(), h))));
        let run = move |steps: usize| {
            let mut trajectory = black_box(&*system).by(Midpoint, h).run(black_box(start));
            for step in (&mut trajectory).take(steps) {
                black_box(step.expect("the scene can be stepped"));
            }
            let State { q, p } = trajectory.state();
            [q.as_slice(), p.as_slice()].concat()
        };
        self.ways.push((way, Box::new(run)));
        self
    }

    /// Adds the stripped loop, from the state that `system` gives the start.
    fn with_stripped<L>(
        mut self,
        system: &L,
        start: Start<2>,
        run: impl Fn([f64; 2], [f64; 2], u32) -> ([f64; 2], [f64; 2]) + 'static,
    ) -> Self
    where
        L: ClosedForm<Midpoint, 2, Scalar = f64>,
    {
        let state = State::from_velocity(system, start.q, start.v).expect("the scene is regular");
        let run = move |steps: usize| {
            let steps = u32::try_from(steps).expect("a benchmark is short");
            let (q, p) = run(black_box(state.q.into()), black_box(state.p.into()), steps);
            [q, p].concat()
        };
        self.ways.push((Way::Stripped, Box::new(run)));
        self
    }

    /// A way of the scene, as a function of the number of steps.
    pub fn way(&self, way: Way) -> Option<impl Fn(usize) + '_> {
        let (_, run) = self.ways.iter().find(|(known, _)| *known == way)?;
        Some(|steps| {
            black_box(run(steps));
        })
    }

    /// What a step evaluates, alone: a number of times the step's equation with its matrix, and both momenta.
    pub fn evaluations(&self, way: Way) -> Option<&dyn Fn(usize)> {
        let (_, run) = self.evaluations.iter().find(|(known, _)| *known == way)?;
        Some(&**run)
    }

    /// What a run verifies before its first step, alone: a number of times.
    pub fn starts(&self, way: Way) -> Option<&dyn Fn(usize)> {
        let (_, run) = self.starts.iter().find(|(known, _)| *known == way)?;
        Some(&**run)
    }

    /// Asserts that all ways end in one state: to 1e-12 of the largest coordinate and of the largest
    /// momentum.
    pub fn assert_agreement(&self) {
        let ends: Vec<_> = self.ways.iter().map(|(way, run)| (way, run(COMPARED))).collect();
        let (_, reference) = &ends[0];
        for (way, end) in &ends[1..] {
            let difference = relative_difference(reference, end);
            assert!(
                difference <= TOLERANCE,
                "{}, {}: {difference:e} off after {COMPARED} steps",
                self.name,
                way.name()
            );
        }
    }
}

fn evaluations<L, const N: usize>(
    system: Rc<L>,
    q: SVector<f64, N>,
    v: SVector<f64, N>,
    h: f64,
) -> impl Fn(usize)
where
    L: ClosedForm<Midpoint, N, Scalar = f64>,
{
    move |times| {
        let system = black_box(&*system);
        for _ in 0..times {
            black_box(system.step_kernel(&Segment {
                q0: *black_box(&q),
                v: *black_box(&v),
                h: black_box(h),
            }));
            black_box(system.momenta(&Segment { q0: *black_box(&q), v: *black_box(&v), h: black_box(h) }));
        }
    }
}

/// The larger of the relative differences of q and of p, in the largest entry.
fn relative_difference(a: &[f64], b: &[f64]) -> f64 {
    let half = a.len() / 2;
    [0..half, half..a.len()]
        .map(|range| {
            let (a, b) = (&a[range.clone()], &b[range]);
            let size = a.iter().fold(0.0_f64, |size, a| size.max(a.abs()));
            a.iter().zip(b).fold(0.0_f64, |worst, (a, b)| worst.max((a - b).abs())) / size
        })
        .into_iter()
        .fold(0.0, f64::max)
}

/// Where a scene starts, and its step size.
#[derive(Clone, Copy)]
struct Start<const N: usize> {
    q: [f64; N],
    v: [f64; N],
    h: f64,
}

/// Scenes that nobody has stepped by hand here.
pub fn others() -> Vec<Scene> {
    let (oscillator, k) = (Oscillator { m: 1.0, k: 4.0, r: 0.1 }, 1e-3);
    let beside_the_well = Start { q: [0.3, 0.1], v: [0.2, -0.1], h: 0.1 };
    let [wide, narrow] = [1.1, 0.6].map(|speed| Start { q: [1.0, 0.0], v: [0.0, speed], h: 0.05 });
    vec![
        Scene::new("oscillator", 1).with(Way::Generated, oscillator, Start { q: [1.0], v: [0.0], h: 0.05 }),
        Scene::new("Hénon–Heiles", 2).with(Way::Generated, HenonHeiles {}, beside_the_well),
        Scene::new("Kepler", 2).with(Way::Generated, Kepler { k }, wide),
        Scene::new("Kepler in scaled time", 2).with(Way::Generated, EccentricKepler { k }, narrow),
    ]
}

/// Every scene that is stepped by hand as well.
pub fn scenes() -> Vec<Scene> {
    vec![ring(), double_pendulum(), fput_chain(), spring_chain(), pendulum_chain(), arm()]
}

/// Both chains, of 8 and of 32 masses, for what a degree of freedom costs.
pub fn chains() -> [[Scene; 2]; 2] {
    fn scene<L, const N: usize>(name: &'static str, system: L) -> Scene
    where
        L: ClosedForm<Midpoint, N, Scalar = f64> + 'static,
    {
        let start = Start { q: displacements(), v: [0.0; N], h: 0.05 };
        Scene::new(name, N).with(Way::Generated, system, start)
    }
    let [stiffness, hardening, friction] = SPRINGS;
    let spring_chain_of_8 = SpringChain8 { m: masses(), stiffness, hardening, friction };
    let spring_chain_of_32 = SpringChain32 { m: masses(), stiffness, hardening, friction };
    [
        [scene("FPUT chain of 8", FputChain8::MEASURED), scene("FPUT chain of 32", FputChain32::MEASURED)],
        [scene("spring chain of 8", spring_chain_of_8), scene("spring chain of 32", spring_chain_of_32)],
    ]
}

/// Stiffness, hardening and friction of the spring chain.
const SPRINGS: [f64; 3] = [40.0, 8.0, 0.3];

fn ring() -> Scene {
    let start = Start { q: [0.0, 1.15549918674982], v: [0.5, 0.0], h: 0.2 };
    let generated = Ring::MEASURED;
    Scene::new("ring", 2)
        .with(Way::ByHand, ByHand(by_hand::Ring::from(generated)), start)
        .with(Way::Generated, generated, start)
        .with(Way::NumDual, num_dual::Ring::MEASURED, start)
        .with_stripped(&generated, start, move |q, p, steps| {
            stripped::ring(generated.k, start.h, q, p, steps)
        })
}

fn double_pendulum() -> Scene {
    let start = Start { q: [0.8, -0.4], v: [0.0, 0.5], h: 0.01 };
    let generated @ DoublePendulum { m, l, g, c } = DoublePendulum::MEASURED;
    Scene::new("double pendulum", 2)
        .with(Way::ByHand, ByHand(by_hand::DoublePendulum::from(generated)), start)
        .with(Way::Generated, generated, start)
        .with(Way::NumDual, num_dual::DoublePendulum::MEASURED, start)
        .with_stripped(&generated, start, move |q, p, steps| {
            stripped::double_pendulum(m, l, g, c, start.h, q, p, steps)
        })
}

fn fput_chain() -> Scene {
    let start = Start { q: displacements(), v: [0.0; 8], h: 0.05 };
    let generated = FputChain8::MEASURED;
    Scene::new("FPUT chain", 8)
        .with(Way::ByHand, ByHand(by_hand::FputChain::from(generated)), start)
        .with(Way::Generated, generated, start)
        .with(Way::NumDual, num_dual::FputChain8::MEASURED, start)
}

fn spring_chain() -> Scene {
    let start = Start { q: displacements(), v: [0.0; 16], h: 0.05 };
    let (m, [stiffness, hardening, friction]) = (masses(), SPRINGS);
    let generated = SpringChain16 { m, stiffness, hardening, friction };
    let by_hand = by_hand::SpringChain { generated, m, stiffness, hardening, friction };
    Scene::new("spring chain", 16)
        .with(Way::ByHand, ByHand(by_hand), start)
        .with(Way::Generated, generated, start)
        .with(Way::NumDual, num_dual::SpringChain16 { m, stiffness, hardening, friction }, start)
}

fn pendulum_chain() -> Scene {
    let start = Start { q: displacements(), v: [0.0; 16], h: 0.005 };
    let (m, l, g, c) = (masses(), 0.25, 9.81, 0.02);
    let generated = PendulumChain16 { m, l, g, c };
    Scene::new("pendulum chain", 16)
        .with(Way::ByHand, ByHand(by_hand::PendulumChain::from(generated)), start)
        .with(Way::Generated, generated, start)
        .with(Way::NumDual, num_dual::PendulumChain16 { m, l, g, c }, start)
}

fn arm() -> Scene {
    let start = Start { q: [0.2, 0.9, -1.1], v: [1.5, 0.0, 0.4], h: 0.01 };
    let (base, m, l, payload, g, c) = (0.05, [2.0, 1.2], [0.4, 0.35], 0.5, 9.81, [0.02, 0.02, 0.01]);
    let generated = Arm { base, m, l, payload, g, c };
    Scene::new("arm", 3)
        .with(Way::ByHand, ByHand(by_hand::Arm::from(generated)), start)
        .with(Way::Generated, generated, start)
        .with(Way::NumDual, num_dual::Arm { base, m, l, payload, g, c }, start)
}

/// Masses that differ.
fn masses<const N: usize>() -> [f64; N] {
    std::array::from_fn(|i| 1.0 + 0.5 * (i as f64).cos())
}

fn displacements<const N: usize>() -> [f64; N] {
    std::array::from_fn(|i| (i as f64 * 0.7).sin())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_way_of_a_scene_computes_the_same_trajectory() {
        for scene in scenes() {
            scene.assert_agreement();
        }
    }

    #[test]
    #[cfg_attr(debug_assertions, should_panic(expected = "off after 30 steps"))]
    #[cfg_attr(not(debug_assertions), should_panic(expected = "off after 200 steps"))]
    fn another_system_is_noticed() {
        let start = Start { q: [0.0, 1.15549918674982], v: [0.5, 0.0], h: 0.2 };
        Scene::new("ring", 2)
            .with(Way::ByHand, Ring { k: 1e-3 }, start)
            .with(Way::Generated, Ring { k: 1e-3 + 1e-13 }, start)
            .assert_agreement();
    }
}
