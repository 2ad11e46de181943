//! The modified Lagrangian and Rayleigh function of rules by nodes on the straight line, to O(h⁴): the
//! midpoint and the trapezoidal rule, and self-adjoint ones of one's own.

use nalgebra::{SMatrix, SVector};

use super::criterion::largest_step;
use crate::numbers::{Gradient, Scalar};
use crate::rules::{DisplacementRule, SelfAdjoint, require_positive_definite};
use crate::step::{Discretised, State, invert};
use crate::system::{ActingForce, Damping, SecondOrder};
use crate::theory::rayleigh::modified::ModifiedSystemError;

/// The system on whose motion the rule's run lies to O(h⁴), where its own motion is left at O(h²).
///
/// Of L = ½vᵀMv − V(q) and R = ½vᵀCv with constant M and C, by nodes cᵢ with weights bᵢ, symmetric about ½:
///
/// ```text
/// L̃ = ½vᵀM̃(q)v − V + (h²/24) ∇VᵀM⁻¹∇V       M̃ = M + (h²/12)(wV″ − CM⁻¹C)
/// R̃ = ½vᵀC̃(q)v                              C̃ = C − (h²/12)(CM⁻¹V″ + V″M⁻¹C)
/// Ẽ = v·∂L̃/∂v − L̃ = ½vᵀM̃v + V − (h²/24) ∇VᵀM⁻¹∇V,     dẼ/dt = −2R̃ along its motions
///
/// w = 12σ − 2,  σ = Σ bᵢcᵢ(1 − cᵢ):          1 midpoint, −2 trapezoidal, 0 Simpson's rule
/// ```
///
/// So all rules have one R̃; they differ in the mass alone. For n ≥ 3 there is no such system at order h⁴: in
/// general its equation is that of no L and R (docs/theory.md, section 3).
///
/// **Derivation.** The run satisfies M(q₋ − 2q + q₊)/h² + C(q₊ − q₋)/2h + Σ bᵢ[cᵢ∇V(q − (1 − cᵢ)(q − q₋)) +
/// (1 − cᵢ)∇V(q + cᵢ(q₊ − q))] = 0. For a smooth q(t) with q± = q(t ± h) that is, to O(h⁴),
///
/// ```text
/// Mq̈ + Cq̇ + ∇V + h² [ (1/12) Mq⁗ + (1/6) Cq⃛ + σV″q̈ + ½σV‴[q̇, q̇] ] = 0
/// ```
///
/// In the bracket Mq̈ = −Cq̇ − ∇V may be used: Mq⁗ = −Cq⃛ − V″q̈ − V‴[q̇, q̇], then Cq⃛ = −CM⁻¹(Cq̈ + V″q̇),
/// and the bracket less (1/12) V″M⁻¹(Mq̈ + Cq̇ + ∇V) becomes
///
/// ```text
/// (1/12)(wV″ − CM⁻¹C) q̈ + (w/24) V‴[q̇, q̇] − (1/12) V″M⁻¹∇V − (1/12)(CM⁻¹V″ + V″M⁻¹C) q̇
/// ```
///
/// with which the equation is d/dt ∂L̃/∂v − ∂L̃/∂q + ∂R̃/∂v = 0.
///
/// **The velocity at a node.** p is the mean of the momenta of the two segments that meet there,
/// M(q₊ − q₋)/2h + (1/4) C(q₊ − 2q + q₋) + (h/2) Σ bᵢ[(1 − cᵢ)∇V(q + cᵢ(q₊ − q)) − cᵢ∇V(q − (1 − cᵢ)(q −
/// q₋))], which is Mq̇ + h²[(1/6) Mq⃛ + (1/4) Cq̈ + σV″q̇] + O(h⁴); the same two steps give
///
/// ```text
/// p = M̃v − (h²/12) CM⁻¹∇V + O(h⁴)        v = M̃⁻¹(p + (h²/12) CM⁻¹∇V) + O(h⁴)
/// ```
///
/// p is ∂L̃/∂v up to the covector (h²/12) CM⁻¹∇V, a gradient where CM⁻¹V″ is symmetric: there, and there
/// alone, a gauge makes the two one, which is the condition under which steps of order above 2 have an R_d
/// ([`RayleighStep`](crate::rayleigh::RayleighStep)).
///
/// Of linear systems [`ModifiedLinearSystem`](crate::rayleigh::modified::ModifiedLinearSystem) has all
/// orders. Conservative: M. Vermeeren, Modified equations for variational integrators, Numer. Math. 137,
/// 2017. Of R̃ we found no earlier statement.
///
/// ```
/// use dalembert::{Discretise, Midpoint, State, rayleigh_system};
///
/// #[rayleigh_system]
/// fn pendulum(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
///     (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
/// }
/// let pendulum = Pendulum { r: 0.0 };
/// let by = pendulum.by(Midpoint, 0.2);
/// let modified = by.modified_system()?;
/// let start = State::from_velocity(&pendulum, [1.0], [0.0])?;
/// let energy = |state: &State<f64, 1>| Ok::<_, Box<dyn std::error::Error>>(
///     modified.energy(&state.q, &modified.velocity(state)?)
/// );
/// for step in by.run(start).take(100) {
///     let state = step?.state;
///     assert!((energy(&state)? - energy(&start)?).abs() < 1e-5); // E itself moves by 1e-3
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct ModifiedSystem<'a, L: ActingForce<N>, const N: usize> {
    system: &'a L,
    h: L::Scalar,
    /// w = 12 Σ bᵢcᵢ(1 − cᵢ) − 2 of the rule.
    weight: L::Scalar,
    /// M⁻¹.
    inverse: SMatrix<L::Scalar, N, N>,
    /// M.
    mass: SMatrix<L::Scalar, N, N>,
    /// C.
    damping: SMatrix<L::Scalar, N, N>,
    /// ∂L/∂v at v = 0, of a total derivative in L.
    shift: SVector<L::Scalar, N>,
}

/// The modified system of the midpoint and the trapezoidal rule, and of self-adjoint
/// [`Quadrature`](crate::rules::Quadrature)s.
impl<'a, L, Q, const N: usize> Discretised<'a, L, Q, N>
where
    L: ActingForce<N>,
    Q: DisplacementRule + SelfAdjoint,
{
    /// The system on whose motion the run lies to O(h⁴), of L = ½vᵀMv − V(q) and R = ½vᵀCv with constant M
    /// and C: [`ModifiedSystem`](crate::rayleigh::modified::ModifiedSystem).
    ///
    /// # Errors
    /// A [`ModifiedSystemError`](crate::rayleigh::modified::ModifiedSystemError) where the system is another
    /// one, or is not known to be of this kind: [`Structure`](crate::system::Structure) says what is known.
    pub fn modified_system(&self) -> Result<ModifiedSystem<'a, L, N>, ModifiedSystemError> {
        const { Self::require_unconstrained() };
        ModifiedSystem::of::<Q>(self.system(), self.step_size())
    }
}

impl<'a, L: ActingForce<N>, const N: usize> ModifiedSystem<'a, L, N> {
    fn of<Q: DisplacementRule>(system: &'a L, h: L::Scalar) -> Result<Self, ModifiedSystemError> {
        let found = L::STRUCTURE;
        let h_wide = h.widen();
        if !h_wide.is_finite() || h_wide == 0.0 {
            return Err(ModifiedSystemError::StepSize { h: h_wide });
        }
        if L::HAS_FORCE {
            return Err(ModifiedSystemError::GeneralForce);
        }
        if L::IS_TIMED {
            return Err(ModifiedSystemError::Timed);
        }
        if !(found.constant_mass_matrix && found.separable_lagrangian) {
            return Err(ModifiedSystemError::Lagrangian);
        }
        if L::HAS_RAYLEIGH && found.damping != Damping::Linear {
            return Err(ModifiedSystemError::Friction { damping: found.damping });
        }
        let rest = nalgebra::zero();
        let (l, r) =
            (system.lagrangian_derivatives(&rest, &rest), system.dissipation_derivatives(&rest, &rest));
        if r.d2.iter().any(|thrust| *thrust != L::Scalar::constant(0.0)) {
            return Err(ModifiedSystemError::Thrust);
        }
        require_positive_definite(&l.d22).map_err(ModifiedSystemError::Mass)?;
        let inverse = invert(&l.d22).map_err(ModifiedSystemError::Mass)?;
        let bent: f64 = Q::NODES.iter().map(|node| node.weight * node.position * (1.0 - node.position)).sum();
        let weight = L::Scalar::constant(12.0 * bent - 2.0);
        Ok(Self { system, h, weight, inverse, mass: l.d22, damping: r.d22, shift: l.d2 })
    }

    /// h²/`divisor`.
    fn share(&self, divisor: f64) -> L::Scalar {
        self.h * self.h / L::Scalar::constant(divisor)
    }

    /// ∇V and V″.
    fn potential(&self, q: &SVector<L::Scalar, N>) -> (SVector<L::Scalar, N>, SMatrix<L::Scalar, N, N>) {
        let l = self.system.lagrangian_derivatives(q, &nalgebra::zero());
        (-l.d1, -l.d11)
    }

    fn mass_of(&self, hessian: &SMatrix<L::Scalar, N, N>) -> SMatrix<L::Scalar, N, N> {
        self.mass + (hessian * self.weight - self.damping * self.inverse * self.damping) * self.share(12.0)
    }

    fn damping_of(&self, hessian: &SMatrix<L::Scalar, N, N>) -> SMatrix<L::Scalar, N, N> {
        let product = self.damping * self.inverse * hessian;
        self.damping - (product + product.transpose()) * self.share(12.0)
    }

    /// M̃(q) = ∂²L̃/∂v².
    #[must_use]
    pub fn mass(&self, q: &SVector<L::Scalar, N>) -> SMatrix<L::Scalar, N, N> {
        self.mass_of(&self.potential(q).1)
    }

    /// C̃(q) = ∂²R̃/∂v².
    #[must_use]
    pub fn damping(&self, q: &SVector<L::Scalar, N>) -> SMatrix<L::Scalar, N, N> {
        self.damping_of(&self.potential(q).1)
    }

    /// L̃(q, v).
    #[must_use]
    pub fn lagrangian(&self, q: &SVector<L::Scalar, N>, v: &SVector<L::Scalar, N>) -> L::Scalar {
        let (gradient, hessian) = self.potential(q);
        let added = self.mass_of(&hessian) - self.mass;
        self.system.lagrangian(q, v)
            + v.dot(&(added * v)) * L::Scalar::constant(0.5)
            + gradient.dot(&(self.inverse * gradient)) * self.share(24.0)
    }

    /// ∂L̃/∂v.
    #[must_use]
    pub fn momentum(&self, q: &SVector<L::Scalar, N>, v: &SVector<L::Scalar, N>) -> SVector<L::Scalar, N> {
        self.shift + self.mass(q) * v
    }

    /// R̃(q, v). Friction takes 2R̃ = v·∂R̃/∂v in unit time.
    #[must_use]
    pub fn rayleigh(&self, q: &SVector<L::Scalar, N>, v: &SVector<L::Scalar, N>) -> L::Scalar {
        v.dot(&self.friction(q, v)) * L::Scalar::constant(0.5)
    }

    /// ∂R̃/∂v.
    #[must_use]
    pub fn friction(&self, q: &SVector<L::Scalar, N>, v: &SVector<L::Scalar, N>) -> SVector<L::Scalar, N> {
        self.damping(q) * v
    }

    /// Ẽ(q, v) = v·∂L̃/∂v − L̃, which falls at the rate 2R̃.
    #[must_use]
    pub fn energy(&self, q: &SVector<L::Scalar, N>, v: &SVector<L::Scalar, N>) -> L::Scalar {
        v.dot(&self.momentum(q, v)) - self.lagrangian(q, v)
    }

    /// The velocity of the motion at a state of the run: M̃⁻¹(p + (h²/12) CM⁻¹∇V), to O(h⁴).
    ///
    /// # Errors
    /// [`ModifiedSystemError::Singular`] where M̃(q) is singular: h is too large for it;
    /// [`ModifiedSystemError::NonFinite`] of a state or V that is not finite.
    pub fn velocity(
        &self,
        state: &State<L::Scalar, N>,
    ) -> Result<SVector<L::Scalar, N>, ModifiedSystemError> {
        let (gradient, hessian) = self.potential(&state.q);
        let inverse = invert(&self.mass_of(&hessian)).map_err(|_| ModifiedSystemError::Singular)?;
        let between = self.damping * self.inverse * gradient * self.share(12.0);
        let velocity = inverse * (state.p - self.shift + between);
        if velocity.iter().all(|entry| entry.widen().is_finite()) {
            Ok(velocity)
        } else {
            Err(ModifiedSystemError::NonFinite)
        }
    }

    /// The largest step size up to which the R̃ of these formulas is ≥ 0 at q, for every v; infinite where it
    /// always is.
    ///
    /// With M = WWᵀ, C = W diag(c) Wᵀ and A = W⁻¹V″W⁻ᵀ the condition is that diag(c) − (h²/12)((cᵢ + cⱼ)Aᵢⱼ)
    /// is positive semidefinite: h² ≤ 12/λ, λ the largest eigenvalue of ((cᵢ + cⱼ)Aᵢⱼ/√(cᵢcⱼ)) over
    /// coordinates with cᵢ > 0. That is √(6m/V″) for n = 1, √6/ω for C a multiple of M. It is 0 where
    /// friction acts on some coordinates only, cⱼ = 0, and V″ couples them to others.
    ///
    /// A criterion for h, of the terms up to h²: within it friction takes energy at every velocity, by these
    /// formulas. Beyond it they say nothing: of linear systems R̃ to all orders is ≥ 0 at every h without
    /// ringing ([`is_dissipative`](crate::rayleigh::modified::ModifiedLinearSystem::is_dissipative)).
    ///
    /// # Errors
    /// [`ModifiedSystemError::NotDissipative`] where R itself is not ≥ 0; [`ModifiedSystemError::NonFinite`]
    /// where V″ is not finite, or overflows beside M and C.
    pub fn largest_step(&self, q: &SVector<L::Scalar, N>) -> Result<L::Scalar, ModifiedSystemError> {
        largest_step(&self.mass, &self.damping, &self.potential(q).1)
    }
}

/// Functions that take third derivatives of V: `#[rayleigh_system(step_derivatives = second)]`.
impl<L: ActingForce<N> + SecondOrder<N, 0>, const N: usize> ModifiedSystem<'_, L, N> {
    /// ∇(½vᵀV″v) = ½V‴[v, v].
    fn third(&self, q: &SVector<L::Scalar, N>, v: &SVector<L::Scalar, N>) -> SVector<L::Scalar, N> {
        let rest = nalgebra::zero();
        -(self.system.lagrangian_along(q, &rest, v, &rest).d11 * v) * L::Scalar::constant(0.5)
    }

    /// L̃ with ∂L̃/∂q and ∂L̃/∂v.
    #[must_use]
    pub fn lagrangian_gradient(
        &self,
        q: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
    ) -> Gradient<L::Scalar, N> {
        let (gradient, hessian) = self.potential(q);
        let added = self.third(q, v) * self.weight + hessian * self.inverse * gradient;
        Gradient {
            value: self.lagrangian(q, v),
            d1: added * self.share(12.0) - gradient,
            d2: self.momentum(q, v),
        }
    }

    /// q̈ of the motion through (q, v): d/dt ∂L̃/∂v = ∂L̃/∂q − ∂R̃/∂v solved for it.
    ///
    /// # Errors
    /// [`ModifiedSystemError::Singular`] where M̃(q) is singular: h is too large for it.
    pub fn acceleration(
        &self,
        q: &SVector<L::Scalar, N>,
        v: &SVector<L::Scalar, N>,
    ) -> Result<SVector<L::Scalar, N>, ModifiedSystemError> {
        let inverse = invert(&self.mass(q)).map_err(|_| ModifiedSystemError::Singular)?;
        // d/dt M̃(q) v = M̃q̈ + (h²/12)wV‴[v, v].
        let carried = self.third(q, v) * self.weight * self.share(6.0);
        Ok(inverse * (self.lagrangian_gradient(q, v).d1 - self.friction(q, v) - carried))
    }
}
