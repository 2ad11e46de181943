//! The equations of mechanisms, written down a second time: slopes of L, R and g by hand, over any number.

use std::ops::{Add, Div, Mul, Neg, Sub};

use double_double::DoubleDouble;

use super::{Force, Joint, Shape, Values};
use crate::rounded::Rounded;

/// A number that equations are evaluated over.
pub trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// A number of the system or of its state.
    fn given(value: f64) -> Self;

    /// A constant of a formula.
    fn exact(value: f64) -> Self;

    /// √x.
    #[must_use]
    fn root(self) -> Self;

    /// cos x and sin x.
    #[must_use]
    fn on_circle(self) -> [Self; 2];
}

impl Number for DoubleDouble {
    fn given(value: f64) -> Self {
        Self::new(value)
    }
    fn exact(value: f64) -> Self {
        Self::new(value)
    }
    fn root(self) -> Self {
        self.sqrt()
    }
    fn on_circle(self) -> [Self; 2] {
        let (sine, cosine) = self.sin_cos();
        [cosine, sine]
    }
}

impl Number for Rounded {
    fn given(value: f64) -> Self {
        Self::input(value)
    }
    fn exact(value: f64) -> Self {
        Self::exact(value)
    }
    fn root(self) -> Self {
        self.sqrt()
    }
    fn on_circle(self) -> [Self; 2] {
        let (sine, cosine) = self.sin_cos();
        [cosine, sine]
    }
}

/// ∂L/∂q, ∂L/∂v, ∂R/∂q, ∂R/∂v at a point.
pub(super) struct Slopes<T> {
    pub(super) l_q: Vec<T>,
    pub(super) l_v: Vec<T>,
    pub(super) r_q: Vec<T>,
    pub(super) r_v: Vec<T>,
}

/// g, and the rows of G.
pub(super) type Constraints<T> = (Vec<T>, Vec<Vec<T>>);

impl Shape {
    pub(super) fn slopes<T: Number>(&self, values: &Values, q: &[T], v: &[T]) -> Slopes<T> {
        let (per, space) = (self.per_body, self.space);
        let given = |of: &[f64], i: usize| T::given(of[i]);
        let zero = T::exact(0.0);
        let mut l_q = vec![zero; q.len()];
        let mut r_q = l_q.clone();
        let l_v: Vec<T> = v.iter().enumerate().map(|(i, v)| given(&values.mass, i) * *v).collect();
        let drag = |i: usize, v: T| given(&values.drag, i) * v + given(&values.cubic, i) * v * v * v;
        let mut r_v: Vec<T> = v.iter().enumerate().map(|(i, v)| drag(i, *v)).collect();
        for (i, slope) in l_q.iter_mut().enumerate().filter(|(i, _)| i % per < space) {
            *slope = given(&values.mass, i) * T::given(values.gravity[i % per]);
        }
        for (force, numbers) in self.forces.iter().zip(&values.forces) {
            let [k, r, c] = numbers.numbers.map(T::given);
            match *force {
                Force::Spring(i, j) => {
                    let between = |of: &[T]| -> Vec<T> {
                        (0..space).map(|a| of[per * i + a] - of[per * j + a]).collect()
                    };
                    let (d, w) = (between(q), between(v));
                    let (square, rate) = (dot(&d, &d), dot(&d, &w));
                    let length = square.root();
                    let pull = k * (length - r) / length;
                    let share = rate / square;
                    for a in 0..space {
                        let along =
                            [-(pull * d[a]), c * share * w[a] - c * share * share * d[a], c * share * d[a]];
                        for (slopes, along) in [&mut l_q, &mut r_q, &mut r_v].into_iter().zip(along) {
                            slopes[per * i + a] = slopes[per * i + a] + along;
                            slopes[per * j + a] = slopes[per * j + a] - along;
                        }
                    }
                }
                Force::Tether(i) => {
                    let d: Vec<T> = (0..space).map(|a| q[per * i + a] - T::given(numbers.place[a])).collect();
                    let pull = k + r * dot(&d, &d);
                    for a in 0..space {
                        l_q[per * i + a] = l_q[per * i + a] - pull * d[a];
                    }
                }
                Force::Twist(i, j) => {
                    let (i, j) = (per * i + 2, per * j + 2);
                    let (torque, friction) = (k * (q[i] - q[j] - r), c * (v[i] - v[j]));
                    (l_q[i], l_q[j]) = (l_q[i] - torque, l_q[j] + torque);
                    (r_v[i], r_v[j]) = (r_v[i] + friction, r_v[j] - friction);
                }
            }
        }
        Slopes { l_q, l_v, r_q, r_v }
    }

    pub(super) fn constraints<T: Number>(&self, values: &Values, q: &[T]) -> Constraints<T> {
        let (per, space) = (self.per_body, self.space);
        let (zero, half) = (T::exact(0.0), T::exact(0.5));
        let of = self.joints.iter().zip(&values.joints).map(|(joint, numbers)| {
            let (unit, length) = (T::given(numbers.unit), T::given(numbers.length));
            let place = numbers.place.map(T::given);
            let [first, second] = numbers.along.map(T::given);
            let mut row = vec![zero; q.len()];
            let bar = |i: usize, line: usize, along: T| {
                let [cosine, sine] = q[per * i + 2].on_circle();
                let [reach, slope] = [[cosine, -sine], [sine, cosine]][line];
                [q[per * i + line] + along * reach, along * slope]
            };
            let mut rod = |d: Vec<T>, is_length: bool, ends: [Option<usize>; 2]| {
                let square = dot(&d, &d);
                let (value, share) = if is_length {
                    (square.root() - length, unit / square.root())
                } else {
                    (half * (square - length * length), unit)
                };
                for (sign, end) in [T::exact(1.0), T::exact(-1.0)].into_iter().zip(ends) {
                    for (a, d) in d.iter().enumerate() {
                        if let Some(i) = end {
                            row[per * i + a] = sign * share * *d;
                        }
                    }
                }
                unit * value
            };
            let between = |i: usize, j: usize| (0..space).map(|a| q[per * i + a] - q[per * j + a]).collect();
            let value = match *joint {
                Joint::Square(i, j) => rod(between(i, j), false, [Some(i), Some(j)]),
                Joint::Length(i, j) => rod(between(i, j), true, [Some(i), Some(j)]),
                Joint::Ground(i) => {
                    let d = (0..space).map(|a| q[per * i + a] - place[a]).collect();
                    rod(d, false, [Some(i), None])
                }
                Joint::Plane(i) => {
                    let sum = (0..space).fold(-length, |sum, a| sum + place[a] * q[per * i + a]);
                    (0..space).for_each(|a| row[per * i + a] = unit * place[a]);
                    unit * sum
                }
                Joint::HingeAlong(i, j) | Joint::HingeAcross(i, j) => {
                    let line = usize::from(matches!(joint, Joint::HingeAcross(..)));
                    let ([at, turn], [other, other_turn]) = (bar(i, line, first), bar(j, line, second));
                    (row[per * i + line], row[per * j + line]) = (unit, -unit);
                    (row[per * i + 2], row[per * j + 2]) = (unit * turn, -(unit * other_turn));
                    unit * (at - other)
                }
                Joint::PinAlong(i) | Joint::PinAcross(i) => {
                    let line = usize::from(matches!(joint, Joint::PinAcross(_)));
                    let [at, turn] = bar(i, line, first);
                    (row[per * i + line], row[per * i + 2]) = (unit, unit * turn);
                    unit * (at - place[line])
                }
            };
            (value, row)
        });
        of.unzip()
    }
}

pub(super) fn dot<T: Number>(a: &[T], b: &[T]) -> T {
    a.iter().zip(b).fold(T::exact(0.0), |sum, (a, b)| sum + *a * *b)
}

/// A rule of one stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// One node in the middle.
    Midpoint,
    /// One at each end.
    Trapezoidal,
}

impl Rule {
    /// Positions and weights of the nodes.
    fn nodes(self) -> &'static [[f64; 2]] {
        match self {
            Self::Midpoint => &[[0.5, 1.0]],
            Self::Trapezoidal => &[[0.0, 0.5], [1.0, 0.5]],
        }
    }

    /// p0 and p1 of a segment without its constraints, by
    ///
    /// ```text
    /// p0 = Σ bᵢ [∂ᵥ(L + ½hR) − (1 − cᵢ)h ∂_q(L + ½hR)]        p1 = Σ bᵢ [∂ᵥ(L − ½hR) + cᵢh ∂_q(L − ½hR)]
    /// ```
    pub(super) fn momenta<T: Number>(
        self,
        (shape, values): (&Shape, &Values),
        q0: &[T],
        v: &[T],
        h: T,
    ) -> [Vec<T>; 2] {
        let mut ends = [vec![T::exact(0.0); v.len()], vec![T::exact(0.0); v.len()]];
        let half = h * T::exact(0.5);
        for [position, weight] in self.nodes() {
            let share = h * T::exact(*position);
            let q: Vec<T> = q0.iter().zip(v).map(|(q, v)| *q + share * *v).collect();
            let at = shape.slopes(values, &q, v);
            for (end, p) in ends.iter_mut().enumerate() {
                let (sign, lever) =
                    if end == 0 { (half, h * T::exact(position - 1.0)) } else { (-half, share) };
                for (i, p) in p.iter_mut().enumerate() {
                    let of_v = at.l_v[i] + sign * at.r_v[i];
                    let of_q = at.l_q[i] + sign * at.r_q[i];
                    *p = *p + T::exact(*weight) * (of_v + lever * of_q);
                }
            }
        }
        ends
    }
}
