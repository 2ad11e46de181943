//! Models: their coordinates, and what L is made of.

use super::draft::Draft;
use super::manner::Manner;

/// A model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scene {
    Pendulum,
    DoublePendulum,
    CartPole,
    Chain,
    Particle,
    Motor,
    Track,
    Satellite,
    Duffing,
    Beam,
}

impl Scene {
    pub const ALL: [Self; 10] = [
        Self::Pendulum,
        Self::DoublePendulum,
        Self::CartPole,
        Self::Chain,
        Self::Particle,
        Self::Motor,
        Self::Track,
        Self::Satellite,
        Self::Duffing,
        Self::Beam,
    ];

    pub fn coordinates(self) -> usize {
        match self {
            Self::Pendulum | Self::Track | Self::Duffing => 1,
            Self::DoublePendulum | Self::CartPole | Self::Particle | Self::Motor | Self::Satellite => 2,
            Self::Chain => 3,
            Self::Beam => 4,
        }
    }

    /// Displacements that potentials are of, with what they need before.
    pub fn displacements(self, draft: &mut Draft, q: &[String], lines: &mut Vec<String>) -> Vec<String> {
        let scalar = draft.scalar;
        match self {
            Self::Pendulum | Self::Track | Self::Duffing => vec![q[0].clone()],
            Self::DoublePendulum => vec![q[0].clone(), format!("{} - {}", q[0], q[1])],
            Self::CartPole => vec![q[1].clone(), q[0].clone()],
            Self::Motor => {
                let ratio = draft.factor(1.0, 4.0);
                vec![format!("{ratio} * {} - {}", q[0], q[1]), q[1].clone()]
            }
            Self::Particle | Self::Satellite => {
                let r = draft.local();
                lines.push(match draft.random.below(3) {
                    0 => format!("let {r} = {}.hypot({});", q[0], q[1]),
                    1 => format!("let {r} = ({0} * {0} + {1} * {1} + 0.25).sqrt();", q[0], q[1]),
                    _ => format!("let {r} = {0}.powi(2) + {1}.powi(2);", q[0], q[1]),
                });
                if draft.random.chance(30) {
                    let angle = draft.local();
                    lines.push(format!("let {angle}: {scalar} = {}.atan2({} + 3.0);", q[1], q[0]));
                    return vec![r, angle];
                }
                vec![r, q[1].clone()]
            }
            Self::Chain | Self::Beam => {
                let n = q.len();
                let stretch = draft.local();
                let m = n - 1;
                lines.push(match draft.random.below(3) {
                    0 => format!("let mut {stretch}: [{scalar}; {m}] = [0.0; {m}];\nfor i in 0..{m} {{\n    {stretch}[i] = q[i + 1] - q[i];\n}}"),
                    1 => format!("let {stretch}: [{scalar}; {m}] = std::array::from_fn(|i| q[i + 1] - q[i]);"),
                    _ => {
                        let entries: Vec<String> = (0..m).map(|i| format!("{} - {}", q[i + 1], q[i])).collect();
                        format!("let {stretch} = [{}];", entries.join(", "))
                    }
                });
                (0..m).map(|i| format!("{stretch}[{i}]")).chain([q[0].clone()]).collect()
            }
        }
    }

    /// What couples the velocities, beside a sum of squares.
    pub fn coupling(self, draft: &mut Draft, q: &[String], v: &[String]) -> Option<String> {
        if matches!(
            self,
            Self::Pendulum | Self::Chain | Self::Particle | Self::Motor | Self::Duffing | Self::Beam
        ) {
            return None;
        }
        // Drawn where it is read: the macro cannot know of a constant that no body names.
        let k = draft.quantity(0.1, 0.6);
        Some(match self {
            Self::DoublePendulum => format!("{k} * {} * {} * ({} - {}).cos()", v[0], v[1], q[0], q[1]),
            Self::CartPole => format!("{k} * {} * {} * {}.cos()", v[0], v[1], q[1]),
            Self::Satellite => format!("0.5 * {k} * {0} * {0} * {1} * {1}", q[0], v[1]),
            _ => format!("0.5 * {k} * ({} * {}.cos()).powi(2)", v[0], q[0]),
        })
    }
}

impl Draft {
    /// Names of the entries of an argument: as they stand, or taken apart.
    pub fn entries(&mut self, of: &str, lines: &mut Vec<String>) -> Vec<String> {
        let n = self.n;
        if self.random.chance(35) {
            let names: Vec<String> = (0..n).map(|_| self.local()).collect();
            lines.push(match self.random.below(2) {
                0 => format!("let [{}] = {of};", names.join(", ")),
                _ => {
                    let entries: Vec<String> = (0..n).map(|i| format!("{of}[{i}]")).collect();
                    format!("let ({},) = ({},);", names.join(", "), entries.join(", "))
                }
            });
            return names;
        }
        (0..n).map(|i| format!("{of}[{i}]")).collect()
    }

    /// Half of the squares of the velocities, each times a mass.
    pub fn kinetic(&mut self, v: &[String], lines: &mut Vec<String>) -> String {
        let (n, scalar) = (self.n, self.scalar);
        let masses: Vec<String> = (0..n).map(|_| self.number(0.5, 2.0)).collect();
        let masses = format!("[{}]", masses.join(", "));
        match self.random.below(6) {
            0 => {
                let array = self.array(&masses, n, lines);
                let sum = self.local();
                lines.push(format!("let mut {sum}: {scalar} = 0.0;\nfor i in 0..{n} {{\n    {sum} += 0.5 * {array}[i] * v[i] * v[i];\n}}"));
                sum
            }
            1 => {
                let local = self.local();
                let array = self.array(&masses, n, lines);
                lines.push(format!("let {local}: [{scalar}; {n}] = {array};"));
                let (w, m) = (self.local(), self.local());
                format!("v.iter().zip({local}).map(|({w}, {m})| 0.5 * {m} * {w} * {w}).sum::<{scalar}>()")
            }
            2 => {
                let w = self.local();
                let m = self.quantity(0.5, 2.0);
                format!("(v.iter().map(|{w}| {w}.powi(2)).sum::<{scalar}>() * {m} / 2.0)")
            }
            3 => {
                let name = self.item(&["kinetic", "squares", "minus"]);
                self.block.push(format!("fn {name}(v: &[{scalar}; {n}]) -> {scalar} {{\n    let mut sum = 0.0;\n    for w in v {{ sum += w * w; }}\n    sum\n}}"));
                format!("(0.5 * {} * Self::{name}(&v))", self.quantity(0.5, 2.0))
            }
            _ => {
                let squares: Vec<String> =
                    v.iter().map(|w| format!("{} * {w} * {w}", self.factor(0.5, 2.0))).collect();
                format!("(0.5 * ({}))", squares.join(" + "))
            }
        }
    }

    /// A method of a trait whose name is that of one of slices'.
    pub fn by_slice_name(&mut self, lines: &mut Vec<String>) -> String {
        let (n, scalar) = (self.n, self.scalar);
        let k = self.quantity(0.1, 0.5);
        let sum = self.local();
        let (declared, defined, used) = match self.random.below(4) {
            0 => (
                "fn len(&self) -> usize;".to_owned(),
                format!("fn len(&self) -> usize {{ {} }}", n + 2),
                format!("{k} * q.len() as {scalar} * q[0]"),
            ),
            1 => (
                format!("fn iter(&self) -> std::slice::Iter<'_, {scalar}>;"),
                format!("fn iter(&self) -> std::slice::Iter<'_, {scalar}> {{ self[..1].iter() }}"),
                format!("{k} * q.iter().map(|x| x * x).sum::<{scalar}>()"),
            ),
            2 => (
                format!("fn first(&self) -> Option<&{scalar}>;"),
                format!("fn first(&self) -> Option<&{scalar}> {{ self[..].last() }}"),
                format!("{k} * q.first().map_or(0.0, |x| x * x)"),
            ),
            _ => (
                format!(
                    "fn windows(&self, n: usize) -> std::slice::Windows<'_, {scalar}>;\nfn chunks(&self) -> {scalar};"
                ),
                format!(
                    "fn windows(&self, _: usize) -> std::slice::Windows<'_, {scalar}> {{ self[..].windows(1) }}\nfn chunks(&self) -> {scalar} {{ self[0] }}"
                ),
                format!("{k} * q.windows(1).map(|w| w[0] * w[0]).sum::<{scalar}>()"),
            ),
        };
        self.shared(Manner::SliceNames, &["Longer", "Walk"], |name, _| {
            format!("pub trait {name} {{ {declared} }}\nimpl {name} for [{scalar}; {n}] {{ {defined} }}")
        });
        lines.push(format!("let {sum} = {used};"));
        sum
    }
}
