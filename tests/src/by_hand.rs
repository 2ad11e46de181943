//! Systems and their discrete objects written by hand over any number, differentiated pair by pair with
//! num-dual's hyper-dual numbers: shares nothing with the derivatives that the crate generates but num-dual's
//! arithmetic.

use dalembert::system::Derivatives;
use nalgebra::{SMatrix, SVector};
use num_dual::{DualNum, HyperDual64};

/// A plain number, or one that carries derivatives.
pub trait Number: DualNum<Primitive = f64> + Copy {}
impl<D: DualNum<Primitive = f64> + Copy> Number for D {}

/// A system written by hand, apart from the macro.
pub trait ByHand<const N: usize> {
    /// L(q, v).
    fn lagrangian_by_hand<D: Number>(&self, q: [D; N], v: [D; N]) -> D;

    /// R(q, v); 0 unless written.
    fn rayleigh_by_hand<D: Number>(&self, _q: [D; N], _v: [D; N]) -> D {
        D::zero()
    }

    /// f(q, v); 0 unless written.
    fn force_by_hand<D: Number>(&self, _q: [D; N], _v: [D; N]) -> [D; N] {
        [D::zero(); N]
    }

    /// q̈ from (q, q̇), derived on paper.
    fn acceleration(&self, q: [f64; N], v: [f64; N]) -> [f64; N];

    /// ∂L/∂v(q, v).
    fn momentum(&self, q: [f64; N], v: [f64; N]) -> SVector<f64, N>
    where
        Self: Sized,
    {
        derivatives(&Continuous { system: self, part: Part::Lagrangian }, q, v).d2
    }
}

/// A function of two points of ℝᴺ, over any number.
pub trait TwoPoints<const N: usize> {
    /// The value at (x, y).
    fn at<D: Number>(&self, x: [D; N], y: [D; N]) -> D;
}

/// Which function of a system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Part {
    /// L or L_d.
    Lagrangian,
    /// R or R_d.
    Rayleigh,
    /// L_d⁺ = L_d + R_d; of the continuous system L + R.
    Plus,
    /// L_d⁻ = L_d − R_d; of the continuous system L − R.
    Minus,
    /// A component of f_d⁻, R's and the general force together; of the continuous system of f.
    ForceMinus(usize),
    /// A component of f_d⁺; of the continuous system of f.
    ForcePlus(usize),
}

/// A function of (q, v).
pub struct Continuous<'a, S> {
    /// The system.
    pub system: &'a S,
    /// Its function.
    pub part: Part,
}

impl<S: ByHand<N>, const N: usize> TwoPoints<N> for Continuous<'_, S> {
    fn at<D: Number>(&self, q: [D; N], v: [D; N]) -> D {
        let l = || self.system.lagrangian_by_hand(q, v);
        let r = || self.system.rayleigh_by_hand(q, v);
        match self.part {
            Part::Lagrangian => l(),
            Part::Rayleigh => r(),
            Part::Plus => l() + r(),
            Part::Minus => l() - r(),
            Part::ForceMinus(i) | Part::ForcePlus(i) => self.system.force_by_hand(q, v)[i],
        }
    }
}

/// A rule, by its formula.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rule {
    /// L_d = h L(q̄, v̄), R_d = (h²/2) R(q̄, v̄), f_d^± = (h/2) f(q̄, v̄).
    Midpoint,
    /// L_d = (h/2)(L(q0, v̄) + L(q1, v̄)), R_d = (h²/4)(R(q0, v̄) + R(q1, v̄)), f_d⁻ = (h/2) f(q0, v̄), f_d⁺
    /// = (h/2) f(q1, v̄).
    Trapezoidal,
}

/// A function of (q0, q1).
pub struct Discretised<'a, S> {
    /// The system.
    pub system: &'a S,
    /// The rule.
    pub rule: Rule,
    /// The step size.
    pub h: f64,
    /// The function.
    pub part: Part,
}

impl<S, const N: usize> TwoPoints<N> for Discretised<'_, S>
where
    S: ByHand<N>,
{
    fn at<D: Number>(&self, q0: [D; N], q1: [D; N]) -> D {
        let Self { system, rule, h, part } = *self;
        let v: [D; N] = std::array::from_fn(|i| (q1[i] - q0[i]) / h);
        let middle: [D; N] = std::array::from_fn(|i| (q0[i] + q1[i]) / 2.0);
        let of = |part: Part| Discretised { system, rule, h, part }.at(q0, q1);
        match part {
            Part::Lagrangian => match rule {
                Rule::Midpoint => system.lagrangian_by_hand(middle, v) * h,
                Rule::Trapezoidal => {
                    (system.lagrangian_by_hand(q0, v) + system.lagrangian_by_hand(q1, v)) * (h / 2.0)
                }
            },
            Part::Rayleigh => match rule {
                Rule::Midpoint => system.rayleigh_by_hand(middle, v) * (h * h / 2.0),
                Rule::Trapezoidal => {
                    (system.rayleigh_by_hand(q0, v) + system.rayleigh_by_hand(q1, v)) * (h * h / 4.0)
                }
            },
            Part::Plus => of(Part::Lagrangian) + of(Part::Rayleigh),
            Part::Minus => of(Part::Lagrangian) - of(Part::Rayleigh),
            // The general force alone: R's part needs derivatives, see `force_derivatives`.
            Part::ForceMinus(i) => match rule {
                Rule::Midpoint => system.force_by_hand(middle, v)[i] * (h / 2.0),
                Rule::Trapezoidal => system.force_by_hand(q0, v)[i] * (h / 2.0),
            },
            Part::ForcePlus(i) => match rule {
                Rule::Midpoint => system.force_by_hand(middle, v)[i] * (h / 2.0),
                Rule::Trapezoidal => system.force_by_hand(q1, v)[i] * (h / 2.0),
            },
        }
    }
}

/// Value and derivatives of `f` at (x, y) by hyper-dual numbers, one pair of variables at a time.
pub fn derivatives<F: TwoPoints<N>, const N: usize>(f: &F, x: [f64; N], y: [f64; N]) -> Derivatives<f64, N> {
    // Variables 0..N are x, N..2N are y.
    let along = |a: usize, b: usize| {
        let seeded = |value: f64, index: usize| {
            HyperDual64::new(value, f64::from(u8::from(index == a)), f64::from(u8::from(index == b)), 0.0)
        };
        f.at(std::array::from_fn(|i| seeded(x[i], i)), std::array::from_fn(|i| seeded(y[i], N + i)))
    };
    Derivatives {
        value: f.at(x, y),
        d1: SVector::from_fn(|i, _| along(i, i).eps1),
        d2: SVector::from_fn(|i, _| along(N + i, N + i).eps1),
        d11: SMatrix::from_fn(|i, j| along(i, j).eps1eps2),
        d12: SMatrix::from_fn(|i, j| along(i, N + j).eps1eps2),
        d22: SMatrix::from_fn(|i, j| along(N + i, N + j).eps1eps2),
    }
}
