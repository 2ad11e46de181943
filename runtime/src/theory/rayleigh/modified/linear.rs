//! The system on whose motion the steps of a linear system lie, from log A.

use core::fmt;

use nalgebra::{SMatrix, SVector};

use super::logarithm::logarithm;
use super::scaled::{ROUNDINGS, assembled, blocks, require_finite, rescaled, scales, widened};
use crate::numbers::Scalar;
use crate::rules::modes;
use crate::step::{PhaseMatrix, State, invert};
use crate::theory::rayleigh::modified::ModifiedLinearSystemError;
use crate::theory::rayleigh::{Asymmetry, Entry};
use crate::theory::verdict::{Finding, Tolerance, Verdict};

/// The modified system of a linear step: the q of its run lie on a motion of M̃q̈ + C̃q̇ + K̃q = 0, exactly.
///
/// **From A alone.** With log A/h = [[a, b], [c, d]] the states of the run are those of ż = (log A/h) z at t
/// = kh, so that p = b⁻¹(q̇ − aq). Put into ṗ = cq + dp this is
///
/// ```text
/// M̃ = b⁻¹,   C̃ = −b⁻¹a − db⁻¹,   K̃ = db⁻¹a − c
/// ```
///
/// with M̃ in the units of p/q̇. Where all three are symmetric the modified system has L̃ = ½vᵀM̃v − ½qᵀK̃q
/// and R̃ = ½vᵀC̃v; an antisymmetric part of C̃ is a gyroscopic force, of K̃ a circulatory one.
///
/// **Theorem.** With the derivatives K00 = ∂p0/∂q0, K01 = ∂p0/∂q1, K10, K11 of the momenta the run satisfies
/// K10 q₀ + (K11 − K00) q₁ − K01 q₂ = 0. Its three matrices are symmetric if and only if M̃, C̃ and K̃ are.
///
/// *Proof.* Let B = [[β, I], [I, 0]] with a symmetric β. If BA is symmetric, then BAᵏ = (Aᵀ)ᵏB is and B log
/// A, since log A is a polynomial in A; if B log A is, so is BA, since A = exp log A. The first means that
/// b_A = K01⁻¹ and K00ᵀb_A K00 + K10 are symmetric and β = −(K00ᵀ + K11), with A = [[−b_A K00, b_A], [K10 −
/// K11 b_A K00, K11 b_A]]: that K01, K10 and K11 − K00 = −β − (K00 + K00ᵀ) are. The second means that b and
/// βa + c are symmetric and d = aᵀ − βb: that M̃, C̃ = β − b⁻¹a − aᵀb⁻¹ and K̃ = aᵀb⁻¹a − βa − c are. ∎
///
/// Of Mq̈ + Cq̇ + Kq = 0 with symmetric matrices and p = Mq̇, let X be the field on (q, p). With β = C the
/// matrix BX is [[−K, 0], [0, M⁻¹]], and BA symmetric for every A = f(hX): the midpoint rule, Gauss rules,
/// their compositions. The kicks and drifts of a splitting have such fields each, [[0, 0], [−K, 0]] and [[0,
/// M⁻¹], [0, −CM⁻¹]], and if SᵀB = BS and TᵀB = BT then (STS)ᵀB = B(STS): the trapezoidal rules and the
/// splittings, which read the same from either end. The one-sided rule has symmetric K00, K01, K10 and K11.
/// The fitted midpoint rule has its R_d, and a modified Rayleigh function, where C is a multiple of M.
///
/// M̃ is fixed by the momentum of the run. (Multiplied by some other matrix from the left, the equations may
/// be symmetric even where these are not: for n = 2 such a matrix exists always, with an indefinite mass in
/// general.)
///
/// Conservative: modified Lagrangians of variational integrators are due to M. Vermeeren (Modified equations
/// for variational integrators, Numer. Math. 137, 2017). With a Rayleigh function we found no earlier
/// statement.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ModifiedLinearSystem<const N: usize> {
    /// log A/h, the field of the motion on (q, p).
    pub field: PhaseMatrix<f64, N>,
    /// M̃.
    pub mass: SMatrix<f64, N, N>,
    /// C̃.
    pub damping: SMatrix<f64, N, N>,
    /// K̃.
    pub stiffness: SMatrix<f64, N, N>,
    /// Of M̃; where it is worst.
    pub of_mass: Asymmetry,
    /// Of C̃: the gyroscopic force.
    pub of_damping: Asymmetry,
    /// Of K̃: the circulatory force.
    pub of_stiffness: Asymmetry,
    /// The least eigenvalue of C̃, 0 where all are positive.
    negative_damping: Finding<()>,
}

/// The asymmetry of a bilinear form that is worst, in (x, x) coordinates, as it is in (q, q) ones;
/// `quantity` is what a tolerance has to leave a digit of.
fn asymmetry<const N: usize>(
    form: &SMatrix<f64, N, N>,
    s: &SVector<f64, N>,
    relative: f64,
    [size, quantity]: [f64; 2],
) -> Asymmetry {
    let mut worst = None;
    for i in 0..N {
        for j in 0..i {
            let unit = 1.0 / (s[i] * s[j]);
            let tolerance = Tolerance { relative, scale: size * unit };
            let value = (form[(i, j)] - form[(j, i)]) * unit;
            let at = Entry { entry: (i, j), sample: 0 };
            Finding::relative(value, tolerance, at)
                .beside(quantity * unit)
                .keep_if_worse(&mut worst, Finding::excess_or_silence);
        }
    }
    worst.unwrap_or_else(|| {
        let at = Entry { entry: (0, 0), sample: 0 };
        Finding::relative(0.0, Tolerance { relative, scale: 1.0 }, at)
    })
}

/// A form as small as this beside the others is as good as none: what a tolerance leaves no digit of is then
/// below their digits too.
const SMALL: f64 = 1e-5;

/// For each of M̃, C̃ and K̃, in units of h: its size, or [`SMALL`] in units of the motion, whose rate the
/// others tell.
fn quantities<const N: usize>([m, c, k]: [&SMatrix<f64, N, N>; 3], is_free: bool) -> [f64; 3] {
    let [m, c, k] = [m, c, k].map(|form| form.norm());
    // No springs give a rate, only the step.
    let by_step = if is_free { m } else { 0.0 };
    [m, c.max(SMALL * (m * k).sqrt().max(by_step)), k.max(SMALL * (c * c / m).max(by_step))]
}

impl<const N: usize> ModifiedLinearSystem<N> {
    /// Of the step of size `h` with this derivative, such as one written by hand, by the principal logarithm:
    /// with eigenvalues turned by less than π a step. An asymmetry counts as zero within `relative` of the
    /// terms it is the sum of, or 1024 ε unless said.
    ///
    /// At an equilibrium of a system that is not linear this is the modified system of the linearised steps.
    ///
    /// # Errors
    /// A [`ModifiedLinearSystemError`] that says which hypothesis fails.
    pub fn of<S: Scalar>(
        derivative: &PhaseMatrix<S, N>,
        h: f64,
        relative: Option<f64>,
    ) -> Result<Self, ModifiedLinearSystemError> {
        let relative = relative.unwrap_or_else(Tolerance::rounding::<S>);
        if !h.is_finite() || h == 0.0 {
            return Err(ModifiedLinearSystemError::StepSize { h });
        }
        let a = widened(derivative);
        require_finite(&a, 0)?;
        let epsilon = S::EPSILON.widen();
        let s = scales(&a, epsilon);
        let scaled = rescaled(&a, &s.map(f64::recip));
        let is_free = scaled.p_by_q.amax() <= ROUNDINGS * epsilon * scaled.q_by_p.amax();
        let x = blocks::<N>(&logarithm(&assembled(&scaled))?);
        let PhaseMatrix { q_by_q: a, q_by_p: b, p_by_q: c, p_by_p: d } = &x;
        let m = invert(b).map_err(|_| ModifiedLinearSystemError::Degenerate)?;
        // In units of h; ṗ of y.
        let (damping, stiffness) = (-(m * a + d * m), d * m * a - c);
        // An error of 1 in each entry of the logarithm moves the three by these, and one of ∂p1/∂q0 as a
        // step's ends make it.
        let [of_a, of_d, of_m] = [a, d, &m].map(|block| block.norm());
        let size_of_mass = of_m * of_m;
        let size_of_damping = 2.0 * of_m + (of_a + of_d) * size_of_mass;
        let of_ends = of_m * ROUNDINGS / Tolerance::ROUNDINGS;
        let size_of_stiffness = of_ends.max(1.0) + (of_a + of_d) * of_m + of_a * of_d * size_of_mass;
        let symmetric = (damping + damping.transpose()) * 0.5;
        let (.., eigenvalues) = modes(&SMatrix::identity(), &symmetric);
        let least = eigenvalues.min();
        let to_form = |form: &SMatrix<f64, N, N>, unit: f64| {
            form.map_with_location(|i, j, entry| entry * unit / (s[i] * s[j]))
        };
        let [mass_size, damping_size, stiffness_size] = quantities([&m, &damping, &stiffness], is_free);
        let found = |form: &SMatrix<f64, N, N>, sizes: [f64; 2], power: i32| {
            asymmetry(&(form * h.powi(power)), &s, relative, sizes.map(|size| size * h.powi(power).abs()))
        };
        let field = rescaled(&x, &s);
        Ok(Self {
            field: PhaseMatrix {
                q_by_q: field.q_by_q / h,
                q_by_p: field.q_by_p / h,
                p_by_q: field.p_by_q / h,
                p_by_p: field.p_by_p / h,
            },
            mass: to_form(&m, h),
            damping: to_form(&damping, 1.0),
            stiffness: to_form(&stiffness, 1.0 / h),
            of_mass: found(&m, [size_of_mass, mass_size], 1),
            of_damping: found(&damping, [size_of_damping, damping_size], 0),
            of_stiffness: found(&stiffness, [size_of_stiffness, stiffness_size], -1),
            negative_damping: Finding::relative(
                if least > 0.0 { 0.0 } else { least },
                Tolerance { relative, scale: size_of_damping },
                (),
            )
            .beside(damping_size),
        })
    }

    /// Whether the modified system is a Rayleigh system: M̃, C̃ and K̃ are symmetric, to rounding.
    #[must_use]
    pub fn is_rayleigh(&self) -> bool {
        self.verdict() == Verdict::Yes
    }

    /// Whether that is so, or cannot be told: where h is so small that the rounding of A is as large as M̃,
    /// C̃ or K̃.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        let found = [&self.of_mass, &self.of_damping, &self.of_stiffness].map(Finding::verdict);
        if found.contains(&Verdict::No) {
            Verdict::No
        } else if found.contains(&Verdict::CannotTell) {
            Verdict::CannotTell
        } else {
            Verdict::Yes
        }
    }

    /// Whether R̃ = ½vᵀC̃v ≥ 0 for every v, to rounding.
    ///
    /// **Theorem.** By the midpoint rule and by both trapezoidal rules R̃ ≥ 0 wherever M > 0, C ≥ 0 and log A
    /// is defined: for every h at which no mode rings.
    ///
    /// *Proof.* Let Z(s) = Ms² + Cs + K, so that Z(s)⁻¹ is the block q by p of (s − X)⁻¹, and Z̃ likewise of
    /// log A/h = f(X), f(z) = (2/h) artanh(hz/2). By Cauchy's formula for 1/(iω − f(z)), 0 < ω < π/h, the
    /// contour drawn from the spectrum to the pole iω₀ = (2i/h) tan(hω/2) and the cuts |x| ≥ 2/h of f,
    ///
    /// ```text
    /// Z̃(iω)⁻¹ = (1 + h²ω₀²/4) Z(iω₀)⁻¹ + ∫_{2/h}^∞ ρ(x) Z(x)⁻¹ + ρ̄(x) Z(−x)⁻¹ dx,
    /// ρ = (1/h)/(π²/h² + u² − ω² − 2iωu),   u = (2/h) arcoth(hx/2)
    /// ```
    ///
    /// Im ρ > 0. On the cuts Z(±x) > 0: it is for large x, and singular nowhere there, where A would have a
    /// negative eigenvalue. Z(x) ≥ Z(−x), so that Z(x)⁻¹ ≤ Z(−x)⁻¹, and Im Z(iω₀)⁻¹ ≤ 0: hence Im Z̃(iω)⁻¹ ≤
    /// 0, and ωC̃ = Im Z̃(iω) ≥ 0.
    ///
    /// The trapezoidal rule's M(q₋ − 2q + q₊)/h² + C(q₊ − q₋)/2h + Kq = 0 is the midpoint rule's equation
    /// with M′ = M − (h²/4)K in the place of M, and its p that rule's up to a matrix times q, which leaves Z̃
    /// as it is. M′ ≥ 0: Z(2/h) = (4/h²)(M + hC/2) > 0 with M′, and Z is singular nowhere beyond. For the
    /// fitted one take MZ coth Z for M. ∎
    ///
    /// By Gauss rules of order 4 and above R̃ has either sign, however small the step, where friction acts on
    /// some coordinates only; where C > 0 it is positive for small h by every method. We found no earlier
    /// statement.
    #[must_use]
    pub fn is_dissipative(&self) -> bool {
        self.negative_damping.vanishes()
    }

    /// q̇ of the motion at a state of the run: aq + bp. It differs from that of [`State::velocity`], at the
    /// same q.
    ///
    /// q and p are measured from the equilibrium.
    #[must_use]
    pub fn velocity(&self, state: &State<f64, N>) -> SVector<f64, N> {
        self.field.q_by_q * state.q + self.field.q_by_p * state.p
    }

    /// Ẽ = ½vᵀM̃v + ½qᵀK̃q, which falls at the rate 2R̃ along the motion, if this is a Rayleigh system.
    #[must_use]
    pub fn energy(&self, q: &SVector<f64, N>, v: &SVector<f64, N>) -> f64 {
        0.5 * (v.dot(&(self.mass * v)) + q.dot(&(self.stiffness * q)))
    }

    /// R̃ = ½vᵀC̃v.
    #[must_use]
    pub fn rayleigh(&self, v: &SVector<f64, N>) -> f64 {
        0.5 * v.dot(&(self.damping * v))
    }
}

impl<const N: usize> fmt::Display for ModifiedLinearSystem<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let answer = |yes: bool| if yes { "yes" } else { "no" };
        writeln!(
            f,
            "the modified system is {}",
            match self.verdict() {
                Verdict::Yes => "a Rayleigh system",
                Verdict::No => "not a Rayleigh system",
                Verdict::CannotTell => "not told from one that is no Rayleigh system: take a larger step",
            }
        )?;
        for (name, found) in [
            ("M̃ is symmetric", &self.of_mass),
            ("C̃ is symmetric", &self.of_damping),
            ("K̃ is symmetric", &self.of_stiffness),
        ] {
            writeln!(f, "  {name}: {}: {found}", found.verdict())?;
        }
        write!(f, "  R̃ ≥ 0: {}", answer(self.is_dissipative()))
    }
}
