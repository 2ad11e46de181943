//! Single steps: the least of all ways to stick and to slide, lengths by their duality gap, loads at the
//! edge, and what stands for ten million steps.

use anyhow::{Result, ensure};
use dalembert::nalgebra::Vector4;
use dalembert::{Discretise, Proximal, State};
use dalembert_tests::draws::Draws;
use dalembert_tests::sliders::{Drawn, Problem};

/// Steps refused, and the largest excess of the others.
pub struct Found {
    /// How many were tried.
    pub tried: usize,
    /// How many were refused.
    pub refused: usize,
    /// How many have an element that sticks.
    pub stuck: usize,
    /// The largest excess of the objective over the least, in units of 1 + |objective|.
    pub worst: f64,
}

/// Five |·| beside each other, by all 243 ways; or a length and two |·|, by the duality gap.
pub fn least(tried: usize, has_ball: bool) -> Found {
    let mut draws = Draws::new(if has_ball { 6 } else { 5 });
    let mut found = Found { tried, refused: 0, stuck: 0, worst: 0.0 };
    for _ in 0..tried {
        let mut problem = Problem::drawn(&mut draws);
        if has_ball {
            problem.f[4] = 0.0;
            problem.f[0] *= 3.0;
        }
        let Ok(v) = problem.velocity(has_ball) else {
            found.refused += 1;
            continue;
        };
        let slips = problem.b * v;
        found.stuck += usize::from((0..4).any(|k| slips[k].abs() < 1e-14));
        let least = if has_ball { 0.0 } else { problem.least() };
        let excess =
            if has_ball { problem.gap(&v) } else { (problem.objective(&v) - least) / (1.0 + least.abs()) };
        found.worst = found.worst.max(excess);
    }
    found
}

/// Of so many sliders at rest how many hold under a load of 1 − 10⁻¹² and of 1 + 10⁻¹² times what they hold.
pub fn at_the_edge(tried: u64) -> Result<[usize; 2]> {
    let mut held = [0; 2];
    for seed in 0..tried {
        for (held, most) in held.iter_mut().zip([1.0 - 1e-12, 1.0 + 1e-12]) {
            let drawn = Drawn::loaded(seed, most);
            let start = State { q: drawn.q, p: Vector4::zeros() };
            let h = Draws::new(seed).scale(1e-4, 0.3);
            *held += usize::from(drawn.sliders.by(Proximal, h).step(&start)?.state == start);
        }
    }
    Ok(held)
}

/// Steps for which sliders under nine tenths of what they hold have stood to the last bit.
pub fn stands(steps: usize) -> Result<usize> {
    let drawn = Drawn::loaded(1, 0.9);
    let start = State { q: drawn.q, p: Vector4::zeros() };
    let mut run = drawn.sliders.by(Proximal, 0.01).run(start);
    for _ in 0..steps {
        let Some(step) = run.next() else { break };
        ensure!(step?.state == start, "it has moved");
    }
    Ok(steps)
}
