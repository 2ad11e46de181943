//! Numbers of mechanisms and their starts at random: lengths are those of a configuration that was drawn.

use super::{Force, ForceValues, Joint, JointValues, Rule, Shape, Values};
use crate::draws::Draws;

/// Why a run is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// Masses, lengths and speeds of order 1.
    Plain,
    /// Units of mass, length and time, and of each constraint.
    Units,
    /// One body, or two, of 10⁻⁹ to 10⁻⁴ of the others' mass.
    Light,
    /// All on a line but for 10⁻⁷ to 10⁻¹ of their distances: stretched arms, loops at their dead points.
    Stretched,
    /// Friction up to 10³ times what overdamps.
    HeavilyDamped,
    /// Steps that turn rods by up to a radian.
    LongSteps,
    /// Until it is at rest.
    ToRest,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Plain,
        Self::Units,
        Self::Light,
        Self::Stretched,
        Self::HeavilyDamped,
        Self::LongSteps,
        Self::ToRest,
    ];

    /// Its name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::Units => "units",
            Self::Light => "light bodies",
            Self::Stretched => "stretched",
            Self::HeavilyDamped => "heavily damped",
            Self::LongSteps => "long steps",
            Self::ToRest => "to rest",
        }
    }
}

/// A run to be made.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// Why.
    pub kind: Kind,
    /// The numbers of the mechanism.
    pub values: Values,
    /// The configuration, on the constraints to rounding.
    pub q: Vec<f64>,
    /// A velocity, not yet along the constraints.
    pub v: Vec<f64>,
    /// The step size.
    pub h: f64,
    /// The rule.
    pub rule: Rule,
    /// Whether steps are composed of those of the rule.
    pub is_composed: bool,
    /// Steps.
    pub steps: usize,
}

/// Units of mass, length and time.
type Units = [f64; 3];

fn units(kind: Kind, draws: &mut Draws) -> Units {
    if kind != Kind::Units {
        return [1.0; 3];
    }
    [draws.scale(1e-6, 1e3), draws.scale(1e-6, 1e3), draws.scale(1e-3, 1e3)]
}

/// Places of bodies, or of the two ends of each bar, drawn near a line if `flat` < 1.
struct Places<'a> {
    shape: &'a Shape,
    along: Vec<f64>,
    flat: f64,
    draws: &'a mut Draws,
}

impl Places<'_> {
    /// A place near the bodies, the coordinates across the line shrunk.
    fn place(&mut self) -> [f64; 3] {
        let space = self.shape.space;
        let mut place = [0.0; 3];
        for x in &mut place[..space] {
            *x = self.draws.between(-1.5, 1.5);
        }
        if self.flat < 1.0 {
            let along: f64 = (0..space).map(|a| place[a] * self.along[a]).sum();
            for (x, of) in place.iter_mut().zip(&self.along) {
                *x = along * of + self.flat * (*x - along * of);
            }
        }
        place
    }

    /// A place that is not too near to any of `others`.
    fn apart(&mut self, others: &[[f64; 3]]) -> [f64; 3] {
        for least in [0.4, 0.3, 0.2, 0.1, 0.05, 0.0] {
            for _ in 0..20 {
                let place = self.place();
                if others.iter().all(|other| distance(&place, other) > least) {
                    return place;
                }
            }
        }
        self.place()
    }
}

fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// Which of the ends 2i and 2i + 1 of the bars are one point: hinges join the far end of a bar to the near
/// end of the next.
fn joined_ends(shape: &Shape, bars: usize) -> Vec<usize> {
    let mut points: Vec<usize> = (0..2 * bars).collect();
    for joint in shape.joints {
        if let Joint::HingeAlong(i, j) = *joint {
            let (kept, gone) = (points[2 * i + 1], points[2 * j]);
            points.iter_mut().filter(|point| **point == gone).for_each(|point| *point = kept);
        }
    }
    points
}

/// Whether a bar is pinned at its far end: the near one is a hinge.
fn is_pinned_far(shape: &Shape, bar: usize) -> bool {
    shape.joints.iter().any(|joint| matches!(joint, Joint::HingeAlong(_, j) if *j == bar))
}

impl Drawn {
    /// The run of this number on a mechanism.
    #[must_use]
    pub fn of(shape: &Shape, coordinates: usize, seed: u64) -> Self {
        let mut draws = Draws::new(seed);
        let kind = Kind::ALL[draws.below(Kind::ALL.len())];
        let rule = if draws.below(3) == 0 { Rule::Trapezoidal } else { Rule::Midpoint };
        let is_composed = kind != Kind::HeavilyDamped && draws.below(6) == 0;
        let [mass_unit, length_unit, time_unit] = units(kind, &mut draws);
        let (per, space) = (shape.per_body, shape.space);
        let bodies = coordinates / per;
        let flat = if kind == Kind::Stretched { draws.scale(1e-7, 1e-1) } else { 1.0 };
        let along = {
            let along: Vec<f64> = (0..space).map(|_| draws.between(-1.0, 1.0)).collect();
            let size = along.iter().map(|x| x * x).sum::<f64>().sqrt();
            along.iter().map(|x| x / size).collect()
        };
        let mut places = Places { shape, along, flat, draws: &mut draws };
        let is_bar = per > space;
        let mut points: Vec<[f64; 3]> = Vec::new();
        let ends = joined_ends(shape, if is_bar { bodies } else { 0 });
        for k in 0..if is_bar { 2 * bodies } else { bodies } {
            let point = match ends.get(k) {
                Some(same) if *same < k => points[*same],
                _ => places.apart(&points),
            };
            points.push(point);
        }
        // A hinge may have renamed a point to one behind it.
        for k in 0..ends.len() {
            points[k] = points[ends[k]];
        }
        let mut q = Vec::with_capacity(coordinates);
        for i in 0..bodies {
            if is_bar {
                let [from, to] = [points[2 * i], points[2 * i + 1]];
                q.extend((0..2).map(|a| 0.5 * (from[a] + to[a])));
                q.push((to[1] - from[1]).atan2(to[0] - from[0]));
            } else {
                q.extend_from_slice(&points[i][..space]);
            }
        }
        let half = |i: usize| 0.5 * distance(&points[2 * i], &points[2 * i + 1]);
        let mut joints = Vec::with_capacity(shape.joints.len());
        for joint in shape.joints {
            let mut of = JointValues { unit: 1.0, ..JointValues::default() };
            if kind == Kind::Units {
                of.unit = places.draws.scale(1e-6, 1e6);
            }
            match *joint {
                Joint::Square(i, j) | Joint::Length(i, j) => of.length = distance(&points[i], &points[j]),
                Joint::Ground(i) => {
                    of.place = places.apart(&points);
                    of.length = distance(&points[i], &of.place);
                }
                Joint::Plane(i) => {
                    let normal: Vec<f64> = (0..space).map(|_| places.draws.between(-1.0, 1.0)).collect();
                    of.place[..space].copy_from_slice(&normal);
                    of.length = normal.iter().zip(&points[i]).map(|(a, x)| a * x).sum();
                }
                Joint::HingeAlong(i, j) | Joint::HingeAcross(i, j) => of.along = [half(i), -half(j)],
                Joint::PinAlong(i) | Joint::PinAcross(i) => {
                    let is_far = is_pinned_far(shape, i);
                    of.along[0] = if is_far { half(i) } else { -half(i) };
                    of.place = points[2 * i + usize::from(is_far)];
                }
            }
            joints.push(of);
        }
        let mut forces = Vec::with_capacity(shape.forces.len());
        let friction = match kind {
            Kind::HeavilyDamped => draws.scale(1.0, 1e3),
            Kind::ToRest => draws.scale(0.2, 2.0),
            _ => [0.0, draws.scale(0.02, 1.0)][draws.below(2)],
        };
        for force in shape.forces {
            let stiffness = draws.scale(0.1, 10.0);
            let numbers = match *force {
                Force::Spring(..) => [stiffness, draws.between(0.1, 1.0), friction],
                Force::Tether(_) => [stiffness, draws.scale(0.01, 3.0) * draws.below(2) as f64, 0.0],
                Force::Twist(..) => [stiffness * draws.below(2) as f64, draws.between(-1.0, 1.0), friction],
            };
            let mut of = ForceValues { numbers, ..ForceValues::default() };
            for x in &mut of.place[..space] {
                *x = draws.between(-1.5, 1.5);
            }
            forces.push(of);
        }
        let is_everywhere = matches!(kind, Kind::ToRest | Kind::HeavilyDamped) || draws.below(2) == 0;
        let of_drag = if is_everywhere { friction } else { 0.0 };
        let mut values = Values {
            mass: Vec::new(),
            drag: vec![of_drag; coordinates],
            cubic: vec![of_drag * draws.below(2) as f64; coordinates],
            gravity: [0.0; 3],
            joints,
            forces,
        };
        let light: Vec<usize> = (0..2).map(|_| draws.below(bodies)).collect();
        let lightness = draws.scale(1e-9, 1e-4);
        for i in 0..bodies {
            let is_light = kind == Kind::Light && bodies > 1 && light[..1 + i % 2].contains(&i);
            let mass = draws.scale(0.3, 3.0) * if is_light { lightness } else { 1.0 };
            values.mass.extend(vec![mass; space]);
            if is_bar {
                values.mass.push(mass * half(i).powi(2) / 3.0);
            }
        }
        if draws.below(4) != 0 {
            values.gravity[space - 1] = -9.81;
        }
        let speed = if draws.below(3) == 0 { 0.0 } else { draws.scale(1e-3, 3.0) };
        let v: Vec<f64> = (0..coordinates).map(|_| speed * draws.between(-1.0, 1.0)).collect();
        // A radian takes some third of a unit of time.
        let h = match kind {
            Kind::LongSteps => draws.scale(0.05, 0.35),
            Kind::ToRest => draws.scale(0.02, 0.1),
            _ => draws.scale(1e-4, 0.1),
        };
        let steps = if kind == Kind::ToRest { 4000 } else { 60 };
        let mut drawn = Self { kind, values, q, v, h, rule, is_composed, steps };
        drawn.in_units([mass_unit, length_unit, time_unit], shape);
        drawn
    }

    /// Goes over to units of mass, length and time.
    fn in_units(&mut self, [mass, length, time]: Units, shape: &Shape) {
        let (per, space) = (shape.per_body, shape.space);
        let is_angle = |i: usize| i % per >= space;
        let of = |i: usize| if is_angle(i) { 1.0 } else { length };
        let Values { mass: masses, drag, cubic, gravity, joints, forces } = &mut self.values;
        for i in 0..self.q.len() {
            self.q[i] *= of(i);
            self.v[i] *= of(i) / time;
            let action = mass * length * length / (of(i) * of(i));
            masses[i] *= action;
            drag[i] *= action / time;
            cubic[i] *= action * time / (of(i) * of(i));
        }
        gravity.iter_mut().for_each(|g| *g *= length / (time * time));
        for (joint, numbers) in shape.joints.iter().zip(joints) {
            // Of a plane the place is a direction.
            numbers.length *= length;
            numbers.along.iter_mut().for_each(|s| *s *= length);
            if !matches!(joint, Joint::Plane(_)) {
                numbers.place.iter_mut().for_each(|x| *x *= length);
            }
        }
        for (force, numbers) in shape.forces.iter().zip(forces) {
            let stiffness = mass / (time * time);
            let scales = match force {
                Force::Spring(..) => [stiffness, length, mass / time],
                Force::Tether(_) => [stiffness, stiffness / (length * length), 1.0],
                Force::Twist(..) => [stiffness * length * length, 1.0, mass * length * length / time],
            };
            numbers.numbers.iter_mut().zip(scales).for_each(|(x, scale)| *x *= scale);
            numbers.place.iter_mut().for_each(|x| *x *= length);
        }
        self.h *= time;
    }
}
