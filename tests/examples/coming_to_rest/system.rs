//! A damped system drawn at random.

mod draws;
mod law;
mod text;

use draws::Draws;
use law::Law;
pub use text::Text;

/// Systems of a text that num-dual differentiates at most: a step takes ten times as long.
const BY_NUM_DUAL: u64 = 3;

/// How far from 0 a motion may go, in its unit of length, and how fast, in those of length and time.
const EXTENT: f64 = 3.0;

/// V(Σ cᵢqᵢ − a) with a factor k.
#[derive(Clone)]
pub struct Term {
    law: Law,
    /// A coordinate, and another that is subtracted.
    of: (usize, Option<usize>),
    offset: f64,
    k: f64,
    way: usize,
}

/// The rules that can step a system.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// Any L and R.
    General,
    /// Constant M and C: explicit as well.
    Separable,
}

/// A system, in units of 1 but for its text.
pub struct System {
    pub seed: u64,
    pub n: usize,
    pub kind: Kind,
    /// By which engine.
    pub engine: &'static str,
    terms: Vec<Term>,
    masses: Vec<f64>,
    /// m(q) = m(1 + a sin²q) where a is not 0.
    varying: Vec<f64>,
    /// c of ½cv², of c|v|³/3 and of ¼cv⁴.
    drag: Vec<[f64; 3]>,
    /// ½c(vᵢ − vᵢ₊₁)² between neighbours.
    between: Vec<f64>,
    /// Units of mass, length and time.
    units: [f64; 3],
    /// Whether its constants are fields.
    has_fields: bool,
    /// The step size, in units of time.
    pub h: f64,
    /// Start.
    pub q: Vec<f64>,
    pub v: Vec<f64>,
}

impl System {
    /// Systems that read the same: so many where their constants are fields, one where they are literals.
    pub fn all_of(seed: u64, members: u64) -> Vec<Self> {
        let first = Self::of(seed, 0);
        let members = if first.engine == "num_dual" { members.min(BY_NUM_DUAL) } else { members };
        let others = if first.has_fields { 1..members } else { 1..1 };
        core::iter::once(first).chain(others.map(|member| Self::of(seed, member))).collect()
    }

    /// The system `member` of those that read as `seed` has it.
    fn of(seed: u64, member: u64) -> Self {
        let mut draws = Draws::of(seed, member);
        let n = draws.index(1..7);
        let kind = if draws.chance(0.5) { Kind::Separable } else { Kind::General };
        let engine = if draws.chance(0.3) { "num_dual" } else { "expanded" };
        let mut terms = Vec::new();
        for i in 0..n {
            // Each coordinate is held by something.
            for law in [Law::Spring, draws.choice(&[Law::Spring, Law::Saturating, Law::Cubic])] {
                terms.extend(drawn(law, (i, None), &mut draws));
            }
            if i > 0 && draws.chance(0.8) {
                let law = draws.choice(&[Law::Spring, Law::Pendulum, Law::Attraction]);
                terms.extend(drawn(law, (i, Some(draws.index(0..i))), &mut draws));
            }
            if draws.chance(0.5) {
                let laws = [Law::Pendulum, Law::Attraction, Law::Saturating, Law::Walls, Law::Load];
                terms.extend(drawn(draws.choice(&laws), (i, None), &mut draws));
            }
        }
        // Where a coordinate counts from.
        let origins: Vec<f64> = (0..n)
            .map(|_| match draws.tenth() {
                0..5 => 0.0,
                5..8 => draws.number(-3.0..3.0),
                _ => 10.0_f64.powf(draws.number(0.0..4.0)),
            })
            .collect();
        for Term { of: (i, other), offset, .. } in &mut terms {
            *offset += origins[*i] - other.map_or(0.0, |j: usize| origins[j]);
        }
        let masses: Vec<f64> = (0..n).map(|_| draws.number(0.3..3.0)).collect();
        let varies = kind == Kind::General;
        let mut sometimes = |chance: f64, low: f64, high: f64| {
            if draws.chance(chance) { draws.number(low..high) } else { 0.0 }
        };
        let varying = (0..n).map(|_| if varies { sometimes(0.4, 0.1, 1.0) } else { 0.0 }).collect();
        let drag: Vec<[f64; 3]> = (0..n)
            .map(|_| {
                let linear = sometimes(0.85, 0.05, 0.8);
                let nonlinear = if varies || linear == 0.0 { [0.4, 0.4] } else { [0.0; 2] };
                let nonlinear = if varies { nonlinear } else { [0.0; 2] };
                [linear, sometimes(nonlinear[0], 0.05, 0.5), sometimes(nonlinear[1], 0.05, 0.5)]
            })
            .collect();
        let between = (1..n).map(|_| sometimes(0.4, 0.05, 0.5)).collect();
        let unit = |draws: &mut Draws| 10.0_f64.powf(draws.number(-3.0..3.0));
        let units = if draws.chance(0.5) {
            [1.0; 3]
        } else {
            [unit(&mut draws), unit(&mut draws), 10.0_f64.powf(draws.number(-1.0..1.0))]
        };
        let has_fields = draws.chance(0.5);
        let q = origins.iter().map(|origin| origin + draws.number(-1.0..1.0)).collect();
        let at_rest = draws.chance(0.6);
        let v = (0..n).map(|_| if at_rest { 0.0 } else { draws.number(-1.0..1.0) }).collect();
        let share = 10.0_f64.powf(draws.number(-1.0..0.0));
        let mut system = Self {
            seed,
            n,
            kind,
            engine,
            terms,
            masses,
            varying,
            drag,
            between,
            units,
            has_fields,
            h: 0.0,
            q,
            v,
        };
        system.h = share * system.longest_step(&origins);
        system
    }

    /// hω ≤ 1 and hr ≤ m, by bounds of stiffness and drag by row.
    fn longest_step(&self, origins: &[f64]) -> f64 {
        let mut stiffness = vec![0.0_f64; self.n];
        for Term { law, of: (i, other), offset, k, .. } in &self.terms {
            let rows = if other.is_some() { 2.0 } else { 1.0 };
            let middle = origins[*i] - other.map_or(0.0, |j| origins[j]);
            let bound = k * law.stiffness(rows * EXTENT + (offset - middle).abs()) * rows;
            stiffness[*i] += bound;
            if let Some(j) = other {
                stiffness[*j] += bound;
            }
        }
        let mut longest = f64::INFINITY;
        for (i, (&[linear, quadratic, cubic], stiffness)) in self.drag.iter().zip(&stiffness).enumerate() {
            let neighbours = [i.checked_sub(1), Some(i)].into_iter().flatten();
            let between: f64 = neighbours.filter_map(|k| self.between.get(k)).sum();
            let r = linear + 2.0 * quadratic * EXTENT + 3.0 * cubic * EXTENT * EXTENT + 2.0 * between;
            longest = longest.min((self.masses[i] / stiffness).sqrt()).min(self.masses[i] / r.max(1e-3));
        }
        longest
    }

    /// The state and the step size, in the units of the text.
    pub fn start(&self) -> (Vec<f64>, Vec<f64>, f64) {
        let [_, length, time] = self.units;
        let scaled = |of: &[f64], unit: f64| of.iter().map(|x| x * unit).collect();
        (scaled(&self.q, length), scaled(&self.v, length / time), self.h * time)
    }
}

/// One term, or two of which the forces cancel at a point between.
fn drawn(law: Law, of: (usize, Option<usize>), draws: &mut Draws) -> Vec<Term> {
    let k = 10.0_f64.powf(draws.number(-1.0..0.3));
    let way = draws.index(0..6);
    let stiff = matches!(law, Law::Cubic | Law::Walls);
    let [shared_offset, offset] = match draws.tenth() {
        0 | 1 => [0.0; 2],
        2 if !stiff && ![Law::Load, Law::Saturating].contains(&law) => {
            draws.both(0.0..4.0).map(|power| 10.0_f64.powf(power))
        }
        _ => draws.both(-1.5..1.5),
    };
    let first = Term { law, of, offset, k, way };
    if (draws.chance(0.5) || shared_offset > 2.0) && law != Law::Load {
        let middle = if draws.chance(0.6) { 0.0 } else { draws.number(-1.0..1.0) };
        let other = Term { offset: 2.0 * middle - offset, way: way + 3, ..first };
        return vec![first, other];
    }
    vec![first]
}
