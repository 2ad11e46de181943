//! The structure of a system, as known when it is compiled.

/// Findings about a system, as data: `Ring::STRUCTURE`, an associated constant of
/// [`Lagrangian`](crate::Lagrangian).
///
/// `#[rayleigh_system]` finds them on the expressions of L, R and f as they are written. They are
/// conservative: what is stated holds for every q, v and value of the fields; what cancels algebraically but
/// not as written (q − q) is not found. A system written by hand has [`Structure::UNKNOWN`], unless it says
/// more:
///
/// ```
/// use dalembert::system::{Damping, Engine, Structure};
/// use dalembert::{Lagrangian, rayleigh_system};
///
/// #[rayleigh_system(rule = trapezoidal)]
/// fn oscillator(q: [f64; 1], v: [f64; 1], m: f64, k: f64, r: f64) -> (f64, f64) {
///     (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
/// }
///
/// const FOUND: Structure = Oscillator::STRUCTURE;
/// assert_eq!(FOUND.engine, Engine::Expanded);
/// assert!(FOUND.constant_mass_matrix && FOUND.quadratic_lagrangian && FOUND.separable_lagrangian);
/// assert_eq!(FOUND.damping, Damping::Linear);
/// assert!(FOUND.newton_matrix("Trapezoidal").is_some_and(|matrix| matrix.constant && matrix.bandwidth == 0));
/// assert!(FOUND.cyclic.is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Structure {
    /// The source of the derivatives.
    pub engine: Engine,
    /// ∂²L/∂v² depends neither on q nor on v.
    pub constant_mass_matrix: bool,
    /// L is a polynomial of degree at most 2 in (q, v).
    pub quadratic_lagrangian: bool,
    /// L(q, v) = T(v) − V(q).
    pub separable_lagrangian: bool,
    /// Products are rounded with the sums that they stand in, `multiply_add = fused`: in the derivatives and
    /// in the sums over stages of Gauss rules.
    pub fused_multiply_add: bool,
    /// The kind of the force −∂R/∂v.
    pub damping: Damping,
    /// How many kinks R has in v, such as |v|, at which friction holds ([`Proximal`](crate::Proximal)).
    pub kinks: usize,
    /// Coordinates on which L does not depend.
    pub cyclic: &'static [CyclicCoordinate],
    /// The Newton matrix ∂p0/∂v̄ by each rule that the attribute lists.
    pub newton_matrices: &'static [NewtonStructure],
}

/// The source of a system's derivatives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Engine {
    /// The author of the system.
    ByHand,
    /// The macro, as straight-line code.
    Expanded,
    /// Dual numbers, when the program runs.
    NumDual {
        /// The token that could not be written out; `None` where the attribute says `derivatives = num_dual`.
        refusal: Option<Refusal>,
    },
}

/// The first token that could not be written out as straight-line code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Refusal {
    /// The token.
    pub token: &'static str,
    /// Its line in the source file, from 1.
    pub line: Option<u32>,
    /// Why.
    pub reason: &'static str,
}

/// The kind of force that the Rayleigh function makes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Damping {
    /// Not looked for.
    Unknown,
    /// There is no R.
    Absent,
    /// R is a polynomial of degree at most 2 in v alone: the force is −C v + c, with C and c constant.
    Linear,
    /// R is a polynomial of degree at most 2 in v with coefficients that depend on q: the force is −C(q) v +
    /// c(q).
    LinearByConfiguration,
    /// Any other.
    Nonlinear,
}

/// A coordinate on which L does not depend: p = ∂L/∂v of it is conserved where neither R nor f acts on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct CyclicCoordinate {
    /// Its index in q.
    pub index: usize,
    /// R depends on this coordinate or on its velocity.
    pub damped: bool,
    /// This component of f is not 0 as written.
    pub forced: bool,
}

/// The Newton matrix ∂p0/∂v̄ of a rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct NewtonStructure {
    /// The rule's type, such as `"Midpoint"`.
    pub rule: &'static str,
    /// p0 is affine in v̄ and the matrix depends on h and the fields alone: a step is one linear solve.
    pub constant: bool,
    /// Largest |i − j| of an entry that is not 0 as written: 0 is a diagonal matrix, 1 a tridiagonal one.
    pub bandwidth: usize,
}

/// a = b, when it is compiled.
const fn is_equal(a: &[u8], b: &[u8]) -> bool {
    let mut i = 0;
    while i < a.len() && i < b.len() && a[i] == b[i] {
        i += 1;
    }
    i == a.len() && i == b.len()
}

impl Structure {
    /// The structure of a system written by hand: nothing is known.
    pub const UNKNOWN: Self = Self {
        engine: Engine::ByHand,
        constant_mass_matrix: false,
        quadratic_lagrangian: false,
        separable_lagrangian: false,
        fused_multiply_add: false,
        damping: Damping::Unknown,
        kinks: 0,
        cyclic: &[],
        newton_matrices: &[],
    };

    /// The Newton matrix by the rule of this name; `None` where nothing is known of it.
    #[must_use]
    pub const fn newton_matrix(&self, rule: &str) -> Option<&'static NewtonStructure> {
        let mut i = 0;
        while i < self.newton_matrices.len() {
            if is_equal(self.newton_matrices[i].rule.as_bytes(), rule.as_bytes()) {
                return Some(&self.newton_matrices[i]);
            }
            i += 1;
        }
        None
    }

    /// Whether friction holds the system at kinks of R beside L_d and f_d: it is stepped by
    /// [`Proximal`](crate::Proximal).
    pub(crate) const fn is_held_by_friction(&self) -> bool {
        self.kinks > 0 && self.newton_matrix("Proximal").is_some()
    }

    /// This structure, with derivatives by `engine`.
    #[must_use]
    pub const fn with_engine(self, engine: Engine) -> Self {
        Self { engine, ..self }
    }

    /// This structure, of a system whose ∂²L/∂v² is constant.
    #[must_use]
    pub const fn with_constant_mass_matrix(self) -> Self {
        Self { constant_mass_matrix: true, ..self }
    }

    /// This structure, of a system whose L is of degree 2.
    #[must_use]
    pub const fn with_quadratic_lagrangian(self) -> Self {
        Self { quadratic_lagrangian: true, ..self }
    }

    /// This structure, of a system whose L is T(v) − V(q).
    #[must_use]
    pub const fn with_separable_lagrangian(self) -> Self {
        Self { separable_lagrangian: true, ..self }
    }

    /// This structure, of a system whose products are rounded with the sums that they stand in.
    #[must_use]
    pub const fn with_fused_multiply_add(self) -> Self {
        Self { fused_multiply_add: true, ..self }
    }

    /// This structure, with a force of R of this kind.
    #[must_use]
    pub const fn with_damping(self, damping: Damping) -> Self {
        Self { damping, ..self }
    }

    /// This structure, of a system whose R has so many kinks in v.
    #[must_use]
    pub const fn with_kinks(self, kinks: usize) -> Self {
        Self { kinks, ..self }
    }

    /// This structure, of a system whose L holds none of these coordinates.
    #[must_use]
    pub const fn with_cyclic(self, cyclic: &'static [CyclicCoordinate]) -> Self {
        Self { cyclic, ..self }
    }

    /// This structure, with these Newton matrices.
    #[must_use]
    pub const fn with_newton_matrices(self, newton_matrices: &'static [NewtonStructure]) -> Self {
        Self { newton_matrices, ..self }
    }
}

impl Refusal {
    /// A token that cannot be written out; line 0 is none.
    #[must_use]
    pub const fn new(token: &'static str, line: u32, reason: &'static str) -> Self {
        Self { token, line: if line == 0 { None } else { Some(line) }, reason }
    }
}

impl CyclicCoordinate {
    /// The coordinate `index`, on which R and f act as said.
    #[must_use]
    pub const fn new(index: usize, damped: bool, forced: bool) -> Self {
        Self { index, damped, forced }
    }

    /// Whether the momentum is conserved, along the motion and by every rule: neither R nor f acts on it.
    #[must_use]
    pub const fn is_conserved(&self) -> bool {
        !self.damped && !self.forced
    }
}

impl NewtonStructure {
    /// The Newton matrix by `rule`, constant or not, of this bandwidth.
    #[must_use]
    pub const fn new(rule: &'static str, constant: bool, bandwidth: usize) -> Self {
        Self { rule, constant, bandwidth }
    }
}
