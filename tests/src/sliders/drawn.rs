use nalgebra::{Matrix4, SMatrix, SVector, Vector4};

use super::system::{ELEMENTS, MASSES, Sliders};
use crate::draws::Draws;

/// Sliders with a start, drawn from a seed.
pub struct Drawn {
    /// The sliders.
    pub sliders: Sliders,
    /// How many of the masses move.
    pub n: usize,
    /// The start.
    pub q: Vector4<f64>,
    /// Its velocity.
    pub v: Vector4<f64>,
}

impl Drawn {
    /// The sliders of a seed: up to four masses with up to five elements, all on the ground or some on belts.
    #[must_use]
    pub fn of(seed: u64, has_belts: bool) -> Self {
        let mut draws = Draws::new(seed);
        let n = 1 + draws.below(MASSES);
        // Where rows depend on each other, so do their forces at rest.
        let elements = if has_belts { 1 + draws.below(n) } else { n + draws.below(ELEMENTS + 1 - n) };
        let mut spread = || draws.between(-1.0, 1.0);
        let within = |i: usize, j: usize| i < n && j < n;
        let root = Matrix4::from_fn(|i, j| if within(i, j) { spread() } else { 0.0 });
        let springs = Matrix4::from_fn(|i, j| if within(i, j) { spread() } else { 0.0 });
        let dampers = Matrix4::from_fn(|i, j| if within(i, j) { 0.3 * spread() } else { 0.0 });
        let m = root * root.transpose() + Matrix4::identity();
        let k = springs * springs.transpose() * 2.0 + Matrix4::identity() * 0.5;
        let c = dampers * dampers.transpose();
        let mut b = SMatrix::<f64, ELEMENTS, MASSES>::zeros();
        let (mut f, mut belt) = ([0.0; ELEMENTS], [0.0; ELEMENTS]);
        for element in 0..elements {
            // A mass on the ground, two masses on each other, or any combination; without belts each mass
            // stands on the ground, so that all come to rest.
            match draws.below(3) {
                _ if !has_belts && element < n => b[(element, element)] = 1.0,
                0 => b[(element, draws.below(n))] = 1.0,
                1 => {
                    b[(element, draws.below(n))] = 1.0;
                    b[(element, draws.below(n))] -= 1.0;
                }
                _ => (0..n).for_each(|i| b[(element, i)] = draws.between(-1.0, 1.0)),
            }
            f[element] = draws.scale(0.1, 0.8);
            belt[element] = if has_belts && draws.below(2) == 0 { draws.between(-0.5, 0.5) } else { 0.0 };
        }
        let mut moves =
            |size: f64| Vector4::from_fn(|i, _| if i < n { draws.between(-size, size) } else { 0.0 });
        let (q, v, load) = (moves(2.0), moves(1.0), moves(0.5));
        let rows = |matrix: Matrix4<f64>| std::array::from_fn(|i| std::array::from_fn(|j| matrix[(i, j)]));
        let b = std::array::from_fn(|k| std::array::from_fn(|i| b[(k, i)]));
        let sliders = Sliders { m: rows(m), k: rows(k), c: rows(c), load: load.into(), b, belt, f };
        Self { sliders, n, q, v }
    }

    /// At rest, under a load that takes all elements to shares of what they hold, one of them to `most`.
    #[must_use]
    pub fn loaded(seed: u64, most: f64) -> Self {
        let mut drawn = Self::of(seed, false);
        let mut draws = Draws::new(seed ^ 0x10ad);
        let sliders = &mut drawn.sliders;
        sliders.belt = [0.0; ELEMENTS];
        // One element on each mass, so that the load tells what each bears.
        sliders.b = [[0.0; MASSES]; ELEMENTS];
        for (k, row) in sliders.b.iter_mut().enumerate().take(MASSES) {
            row[k] = 1.0;
            sliders.f[k] = draws.scale(0.1, 10.0);
        }
        let least = draws.below(drawn.n);
        let bears = |k: usize| sliders.f[k] * if k == least { most } else { draws.between(-0.9, 0.9) };
        let bears = SVector::<f64, MASSES>::from_iterator((0..MASSES).map(bears));
        // Springs unstretched: the load alone.
        (drawn.q, drawn.v) = (Vector4::zeros(), Vector4::zeros());
        drawn.sliders.load = (bears * draws.sign()).into();
        drawn
    }
}
