//! A damped system drawn at random, as the text of a program and as numbers.

use std::fmt::Write as _;

use rand::rngs::StdRng;
use rand::{RngExt as _, SeedableRng as _};

/// How far from 0 a motion may go, in its unit of length, and how fast, in those of length and time.
const EXTENT: f64 = 3.0;

/// A function of one linear form of the coordinates, x.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Law {
    /// ½kx²
    Spring,
    /// ¼kx⁴
    Cubic,
    /// −k cos x
    Pendulum,
    /// −k/√(x² + 1)
    Attraction,
    /// k ln cosh x
    Saturating,
    /// k(eˣ + e⁻ˣ)
    Walls,
    /// −kx
    Load,
}

impl Law {
    /// The largest second derivative where |x| ≤ `extent`, for k = 1.
    fn stiffness(self, extent: f64) -> f64 {
        match self {
            Self::Spring | Self::Pendulum | Self::Saturating => 1.0,
            Self::Attraction => 1.0,
            Self::Cubic => 3.0 * extent * extent,
            Self::Walls => 2.0 * extent.min(6.0).cosh(),
            Self::Load => 0.0,
        }
    }

    /// V as a Rust expression of `x`, a unit of length `l` and a factor `k`, one of several ways of writing
    /// it.
    fn text(self, k: &str, x: &str, l: &str, way: usize) -> String {
        let squared = match way % 3 {
            0 => format!("({x}).powi(2)"),
            1 => format!("({x}) * ({x})"),
            _ => format!("{{ let d = {x}; d * d }}"),
        };
        match self {
            Self::Spring => format!("0.5 * {k} * {squared}"),
            Self::Cubic => format!("0.25 * {k} * ({x}).powi(4) / ({l} * {l})"),
            Self::Pendulum => format!("-{k} * {l} * {l} * (({x}) / {l}).cos()"),
            Self::Attraction => format!("-{k} * {l} * {l} * {l} / ({squared} + {l} * {l}).sqrt()"),
            Self::Saturating => format!("{k} * {l} * {l} * (({x}) / {l}).cosh().ln()"),
            Self::Walls => format!("{k} * {l} * {l} * ((({x}) / {l}).exp() + (-({x}) / {l}).exp())"),
            Self::Load => format!("-{k} * {l} * ({x})"),
        }
    }
}

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
    pub fn of(seed: u64) -> Self {
        let mut random = StdRng::seed_from_u64(seed);
        let n = random.random_range(1..=6);
        let kind = if random.random_bool(0.5) { Kind::Separable } else { Kind::General };
        let engine = if random.random_bool(0.3) { "num_dual" } else { "expanded" };
        let mut terms = Vec::new();
        for i in 0..n {
            // Each coordinate is held by something.
            for law in [Law::Spring, *choice(&mut random, &[Law::Spring, Law::Saturating, Law::Cubic])] {
                terms.extend(drawn(law, (i, None), &mut random));
            }
            if i > 0 && random.random_bool(0.8) {
                let law = *choice(&mut random, &[Law::Spring, Law::Pendulum, Law::Attraction]);
                terms.extend(drawn(law, (i, Some(random.random_range(0..i))), &mut random));
            }
            if random.random_bool(0.5) {
                let laws = [Law::Pendulum, Law::Attraction, Law::Saturating, Law::Walls, Law::Load];
                terms.extend(drawn(*choice(&mut random, &laws), (i, None), &mut random));
            }
        }
        // Where a coordinate counts from.
        let origins: Vec<f64> = (0..n)
            .map(|_| match random.random_range(0..10) {
                0..5 => 0.0,
                5..8 => random.random_range(-3.0..3.0),
                _ => 10.0_f64.powf(random.random_range(0.0..4.0)),
            })
            .collect();
        for Term { of: (i, other), offset, .. } in &mut terms {
            *offset += origins[*i] - other.map_or(0.0, |j: usize| origins[j]);
        }
        let masses: Vec<f64> = (0..n).map(|_| random.random_range(0.3..3.0)).collect();
        let varies = kind == Kind::General;
        let mut sometimes = |chance: f64, low: f64, high: f64| {
            if random.random_bool(chance) { random.random_range(low..high) } else { 0.0 }
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
        let unit = |random: &mut StdRng| 10.0_f64.powf(random.random_range(-3.0..3.0));
        let units = if random.random_bool(0.5) {
            [1.0; 3]
        } else {
            [unit(&mut random), unit(&mut random), 10.0_f64.powf(random.random_range(-1.0..1.0))]
        };
        let has_fields = random.random_bool(0.5);
        let q = origins.iter().map(|origin| origin + random.random_range(-1.0..1.0)).collect();
        let at_rest = random.random_bool(0.6);
        let v = (0..n).map(|_| if at_rest { 0.0 } else { random.random_range(-1.0..1.0) }).collect();
        let share = 10.0_f64.powf(random.random_range(-1.0..0.0));
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

    /// The annotated block of a type `System`, and `SYSTEM`, its value.
    pub fn text(&self, attribute: &str) -> String {
        let [mass, length, time] = self.units;
        let mut constants = Constants { values: Vec::new(), are_fields: self.has_fields };
        let l = constants.named(length);
        let mut potential = Vec::new();
        for Term { law, of: (i, other), offset, k, way } in &self.terms {
            let offset_text = constants.named(offset.abs() * length);
            let sign = if *offset < 0.0 { '+' } else { '-' };
            let x = match (other, *offset == 0.0, way % 2) {
                (None, true, _) => format!("q[{i}]"),
                (None, false, 0) => format!("q[{i}] {sign} {offset_text}"),
                (None, false, _) if *offset < 0.0 => format!("{offset_text} + q[{i}]"),
                (None, false, _) => format!("q[{i}] {sign} {offset_text}"),
                (Some(j), true, _) => format!("q[{i}] - q[{j}]"),
                (Some(j), false, _) => format!("q[{i}] - q[{j}] {sign} {offset_text}"),
            };
            let k = constants.named(k * mass / (time * time));
            potential.push(format!("({})", law.text(&k, &x, &l, *way)));
        }
        let mut kinetic = Vec::new();
        for i in 0..self.n {
            let m = constants.named(self.masses[i] * mass);
            let factor = match self.varying[i] {
                0.0 => String::new(),
                a => format!(" * (1.0 + {} * (q[{i}] / {l}).sin().powi(2))", constants.named(a)),
            };
            kinetic.push(format!("0.5 * {m}{factor} * v[{i}] * v[{i}]"));
        }
        let mut drag = Vec::new();
        for (i, [linear, quadratic, cubic]) in self.drag.iter().enumerate() {
            if *linear != 0.0 {
                drag.push(format!("0.5 * {} * v[{i}] * v[{i}]", constants.named(linear * mass / time)));
            }
            if *quadratic != 0.0 {
                drag.push(format!(
                    "{} * v[{i}].abs().powi(3) / 3.0",
                    constants.named(quadratic * mass / length)
                ));
            }
            if *cubic != 0.0 {
                let c = constants.named(cubic * mass * time / (length * length));
                drag.push(format!("0.25 * {c} * v[{i}].powi(4)"));
            }
        }
        for (i, c) in self.between.iter().enumerate() {
            if *c != 0.0 {
                drag.push(format!(
                    "0.5 * {} * (v[{}] - v[{i}]).powi(2)",
                    constants.named(c * mass / time),
                    i + 1
                ));
            }
        }
        if drag.is_empty() {
            drag.push(format!("0.05 * {} * v[0] * v[0]", constants.named(mass / time)));
        }
        let n = self.n;
        let (declared, value) = constants.written();
        let mut text = String::new();
        write!(
            text,
            "{declared}#[rayleigh_system({attribute})]\nimpl System {{\n\
             fn lagrangian(&self, q: [f64; {n}], v: [f64; {n}]) -> f64 {{\nlet kinetic = {};\nlet potential = {};\n\
             kinetic - potential\n}}\n\
             fn rayleigh(&self, v: [f64; {n}]) -> f64 {{\n{}\n}}\n}}\n{value}",
            kinetic.join("\n+ "),
            potential.join("\n+ "),
            drag.join("\n+ "),
        )
        .expect("a string takes all");
        text
    }
}

/// One element of a list.
fn choice<'a, T>(random: &mut StdRng, of: &'a [T]) -> &'a T {
    &of[random.random_range(0..of.len())]
}

/// One term, or two of which the forces cancel at a point between.
fn drawn(law: Law, of: (usize, Option<usize>), random: &mut StdRng) -> Vec<Term> {
    let k = 10.0_f64.powf(random.random_range(-1.0..0.3));
    let way = random.random_range(0..6);
    let stiff = matches!(law, Law::Cubic | Law::Walls);
    let offset: f64 = match random.random_range(0..10) {
        0 | 1 => 0.0,
        2 if !stiff && ![Law::Load, Law::Saturating].contains(&law) => {
            10.0_f64.powf(random.random_range(0.0..4.0))
        }
        _ => random.random_range(-1.5..1.5),
    };
    let first = Term { law, of, offset, k, way };
    if (random.random_bool(0.5) || offset > 2.0) && law != Law::Load {
        let middle = if random.random_bool(0.6) { 0.0 } else { random.random_range(-1.0..1.0) };
        let other = Term { offset: 2.0 * middle - offset, way: way + 3, ..first };
        return vec![first, other];
    }
    vec![first]
}

/// The constants of a text.
struct Constants {
    values: Vec<f64>,
    are_fields: bool,
}

impl Constants {
    /// The constant as an expression.
    fn named(&mut self, value: f64) -> String {
        if !self.are_fields {
            return format!("{value:?}");
        }
        let known = self.values.iter().position(|known| known.to_bits() == value.to_bits());
        let index = known.unwrap_or_else(|| {
            self.values.push(value);
            self.values.len() - 1
        });
        format!("self.c[{index}]")
    }

    /// The type that holds them, and its value.
    fn written(&self) -> (String, String) {
        if !self.are_fields {
            return ("pub struct System;\n".into(), "pub const SYSTEM: System = System;\n".into());
        }
        let (count, values) = (self.values.len(), &self.values);
        (
            format!("pub struct System {{ c: [f64; {count}] }}\n"),
            format!("pub const SYSTEM: System = System {{ c: {values:?} }};\n"),
        )
    }
}
