//! Checkers on constraints: which take them, samples on N = g⁻¹(0), and what is left on N of derivatives.
//!
//! (L_d, R_d) restricted to N×N is a pair again, and dι\*f = ι\*df: every condition that a form be closed is
//! that of Q×Q on vectors tangent to N. With an orthonormal frame ν of the normals, Π = 1 − ννᵀ, in no
//! coordinates of N. Where constraints depend on time, N is another one at the end of a segment.

use nalgebra::{SMatrix, SVector};

use crate::numbers::{CovectorDerivatives, Scalar};
use crate::step::{DiscreteForceDerivatives, Discretised, PhaseMatrix};
use crate::system::{Lagrangian, VectorField, Violation};
use crate::theory::samples::{Pair, SampleError, at_segment, at_several_times, at_time_of};

/// Which checkers take constraints: asked in a `const` block of each function by which they are called, where
/// the compiler says of whom the call is.
impl<L: Lagrangian<N>, R, const N: usize> Discretised<'_, L, R, N> {
    /// Refuses constraints of velocity.
    pub(crate) const fn require_holonomic() {
        assert!(
            !L::IS_NONHOLONOMIC,
            "constraints of velocity leave a step without a discrete Lagrangian, which this checker asks: of such \
             systems ask `dissipation` and `ledger`"
        );
        Self::require_no_friction();
    }

    /// Refuses constraints.
    ///
    /// ```compile_fail
    /// use dalembert::{Discretise, Midpoint, State, rayleigh_system};
    ///
    /// struct Pendulum;
    ///
    /// #[rayleigh_system]
    /// impl Pendulum {
    ///     fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
    ///         0.5 * (v[0] * v[0] + v[1] * v[1]) - q[1]
    ///     }
    ///     fn constraints(&self, q: [f64; 2]) -> [f64; 1] {
    ///         [q[0] * q[0] + q[1] * q[1] - 1.0]
    ///     }
    /// }
    ///
    /// let start = State::nearest(&Pendulum, [1.0, 0.0], [0.0, 1.0]).unwrap();
    /// // `rayleigh_step` compiles.
    /// let _ = Pendulum.by(Midpoint, 0.1).conformal_step(&[start]);
    /// ```
    pub(crate) const fn require_unconstrained() {
        assert!(
            !L::IS_CONSTRAINED,
            "this checker asks systems without constraints: on holonomic ones ask `noether`, `rayleigh_step` and \
             `rayleigh_structure`, on any `dissipation` and `ledger`"
        );
        Self::require_no_friction();
    }

    /// Refuses friction that holds beside L_d and f_d.
    const fn require_no_friction() {
        assert!(
            !L::STRUCTURE.is_held_by_friction(),
            "by `rule = proximal` a step is not one of L_d and f_d alone: of such systems ask `dissipation` and `ledger`"
        );
    }
}

/// Corrections that bring a configuration onto the constraints, at most.
const MOST: u32 = 24;

/// The configuration on N that lies beside `q`, where Newton's method finds one.
pub(crate) fn onto<L: Lagrangian<N>, const N: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
) -> Result<SVector<L::Scalar, N>, Violation> {
    let mut q = *q;
    for _ in 0..MOST {
        let Some(normals) = system.normals(&q) else { return Ok(q) };
        q -= normals.offset;
        let mut entries = normals.offset.iter().zip(&q);
        if entries.all(|(offset, q)| offset.widen().abs() <= q.widen().abs() * L::Scalar::EPSILON.widen()) {
            break;
        }
    }
    require_on(system, &q).map(|()| q)
}

/// Fails where rounding does not explain that q is off N.
fn require_on<L: Lagrangian<N>, const N: usize>(
    system: &L,
    q: &SVector<L::Scalar, N>,
) -> Result<(), Violation> {
    match system.violation(q, &nalgebra::zero()) {
        // Rest leaves constraints that move by themselves.
        None | Some(Violation::Leaving { .. }) => Ok(()),
        Some(violation) => Err(violation),
    }
}

/// The error of the sample of this number.
fn off(index: usize, violation: Violation) -> SampleError {
    match violation {
        Violation::NoDerivative { .. } => SampleError::NonFinite { index },
        Violation::Off { constraint, value } => SampleError::OffConstraint { index, constraint, value },
        Violation::Leaving { constraint, rate } => {
            SampleError::OffConstraint { index, constraint, value: rate }
        }
    }
}

/// Samples on constraints.
impl<L: Lagrangian<N>, R, const N: usize> Discretised<'_, L, R, N> {
    /// The `segments` with both ends moved onto the holonomic constraints, for checkers, which refuse what is
    /// off them: by Newton's method along the normals. Without constraints they stay as they are.
    ///
    /// Of a view the k-th starts k h after its time and ends a step later, as checkers ask it; fewer than
    /// three are repeated at later times.
    ///
    /// ```
    /// use dalembert::noether::Generator;
    /// use dalembert::{Discretise, Midpoint, rayleigh_system, samples};
    ///
    /// struct Spherical;
    ///
    /// #[rayleigh_system]
    /// impl Spherical {
    ///     fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
    ///         0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) - 9.81 * q[2]
    ///     }
    ///     fn constraints(&self, q: [f64; 3]) -> [f64; 1] {
    ///         [q[0] * q[0] + q[1] * q[1] + q[2] * q[2] - 1.0]
    ///     }
    /// }
    ///
    /// let by = Spherical.by(Midpoint, 0.05);
    /// let segments = by.on_constraints(&samples::segments([-1.0; 3], [1.0; 3], [0.1; 3], 20))?;
    /// let vertical = by.noether().symmetry(&Generator::rotation(0, 1), &segments)?;
    /// let level = by.noether().symmetry(&Generator::rotation(1, 2), &segments)?;
    /// assert!(vertical.is_conserved() && !level.is_conserved());
    /// # Ok::<(), dalembert::samples::SampleError>(())
    /// ```
    ///
    /// # Errors
    /// [`SampleError::OffConstraint`] of the first segment that has no configuration beside it on all
    /// constraints.
    pub fn on_constraints(
        &self,
        segments: &[Pair<L::Scalar, N>],
    ) -> Result<Vec<Pair<L::Scalar, N>>, SampleError> {
        let moved = |(k, Pair { q0, q1 }): (usize, &Pair<L::Scalar, N>)| {
            at_time_of(self, k, |by| {
                let q0 = onto(by.system, q0)?;
                let q1 = by.system.later(by.h, |system| onto(system, q1))?;
                Ok(Pair { q0, q1 })
            })
            .map_err(|violation| off(k, violation))
        };
        at_several_times(self, segments).iter().enumerate().map(moved).collect()
    }
}

/// `evaluate` of a discretised system at the start of the k-th segment, with the normals at the ends of this,
/// where there are constraints.
///
/// # Errors
/// [`SampleError::OffConstraint`]; [`SampleError::Stopped`].
pub(crate) fn at_segment_on_constraints<L: Lagrangian<N>, R, T, const N: usize>(
    by: &Discretised<'_, L, R, N>,
    k: usize,
    segment: &Pair<L::Scalar, N>,
    evaluate: impl FnOnce(&Discretised<'_, L, R, N>, Option<&Ends<L::Scalar, N>>) -> T,
) -> Result<T, SampleError> {
    let evaluated = at_segment(by, k, |by| match Ends::of(by, &segment.q0, &segment.q1) {
        Ok(ends) => Ok(evaluate(by, ends.as_ref())),
        Err(violation) => Err(off(k, violation)),
    });
    evaluated?
}

/// The frames ν of the normals at the two ends of a segment.
pub(crate) struct Ends<S, const N: usize>([SMatrix<S, N, N>; 2]);

/// x less ν νᵀ x.
fn tangential<S: Scalar, const N: usize, const C: usize>(
    frame: &SMatrix<S, N, N>,
    x: &SMatrix<S, N, C>,
) -> SMatrix<S, N, C> {
    x - frame * frame.tr_mul(x)
}

/// The sizes of the terms of [`tangential`], of those of x.
fn terms<S: Scalar, const N: usize, const C: usize>(
    frame: &SMatrix<S, N, N>,
    sizes: &SMatrix<S, N, C>,
) -> SMatrix<S, N, C> {
    let frame = frame.abs();
    sizes + frame * frame.tr_mul(sizes)
}

impl<S: Scalar, const N: usize> Ends<S, N> {
    /// Of a segment that starts now; none without constraints.
    pub(crate) fn of<L: Lagrangian<N, Scalar = S>, R>(
        by: &Discretised<'_, L, R, N>,
        q0: &SVector<S, N>,
        q1: &SVector<S, N>,
    ) -> Result<Option<Self>, Violation> {
        if !L::IS_CONSTRAINED {
            return Ok(None);
        }
        let normals = |system: &L, q| require_on(system, q).map(|()| system.normals(q));
        let (start, end) = (normals(by.system, q0)?, by.system.later(by.h, |system| normals(system, q1))?);
        Ok(start.zip(end).map(|(start, end)| Self([start.frame, end.frame])))
    }

    /// The derivative of a step on N, in the coordinates of Q: a, c and d between tangent vectors, and b
    /// beside that with the normals at q0 carried to those at q1, so that it is as regular as that on N.
    ///
    /// The symmetry of a bᵀ and bᵀd is that on N: coordinates of N add −b H bᵀ and bᵀH b to them, H a matrix
    /// of second derivatives, and normals nothing.
    pub(crate) fn restricted(&self, a: &PhaseMatrix<S, N>) -> PhaseMatrix<S, N> {
        let Self([start, end]) = self;
        let on = |x: &SMatrix<S, N, N>| tangential(start, &tangential(end, x).transpose()).transpose();
        // In the unit of b, beside which it is no more than its rounding.
        let between = end * start.transpose() * a.q_by_p.amax();
        PhaseMatrix {
            q_by_q: on(&a.q_by_q),
            q_by_p: on(&a.q_by_p) + between,
            p_by_q: on(&a.p_by_q),
            p_by_p: on(&a.p_by_p),
        }
    }

    /// The derivatives of f_d on N, and the sizes of their terms.
    pub(crate) fn restricted_force(
        &self,
        f: &DiscreteForceDerivatives<S, N>,
    ) -> [DiscreteForceDerivatives<S, N>; 2] {
        let size = |f: &CovectorDerivatives<S, N>| CovectorDerivatives {
            value: f.value.abs(),
            d1: f.d1.abs(),
            d2: f.d2.abs(),
        };
        let sizes = DiscreteForceDerivatives { minus: size(&f.minus), plus: size(&f.plus) };
        [self.by_both_sides(tangential, f), self.by_both_sides(terms, &sizes)]
    }

    /// Rows and columns of the derivatives as `of` makes them by the frame of their end.
    fn by_both_sides(
        &self,
        of: fn(&SMatrix<S, N, N>, &SMatrix<S, N, N>) -> SMatrix<S, N, N>,
        f: &DiscreteForceDerivatives<S, N>,
    ) -> DiscreteForceDerivatives<S, N> {
        let Self([start, end]) = self;
        let both = |rows: &_, columns: &_, x: &_| of(columns, &of(rows, x).transpose()).transpose();
        let covector = |rows: &_, f: &CovectorDerivatives<S, N>| CovectorDerivatives {
            value: f.value,
            d1: both(rows, start, &f.d1),
            d2: both(rows, end, &f.d2),
        };
        DiscreteForceDerivatives { minus: covector(start, &f.minus), plus: covector(end, &f.plus) }
    }

    /// A covector on Q×Q and the sizes of its terms, component by component, those at q0 first: on N×N.
    pub(crate) fn restrict_covector(&self, components: &mut [(S, S)]) {
        for (frame, components) in self.0.iter().zip(components.chunks_exact_mut(N)) {
            let (value, size) =
                (SVector::from_fn(|i, _| components[i].0), SVector::from_fn(|i, _| components[i].1));
            let (value, size) = (tangential(frame, &value), terms(frame, &size));
            components.iter_mut().zip(value.iter().zip(&size)).for_each(|(to, (a, b))| *to = (*a, *b));
        }
    }

    /// Whether ξ leaves N at an end by more than `relative` of its terms: by how much of them.
    pub(crate) fn outward(
        &self,
        generator: &impl VectorField<N, Scalar = S>,
        segment: &Pair<S, N>,
        relative: f64,
    ) -> Option<f64> {
        let shares = self.0.iter().zip([&segment.q0, &segment.q1]).flat_map(|(frame, q)| {
            let xi = generator.vector(q);
            let (value, size) = (frame.tr_mul(&xi), frame.abs().tr_mul(&xi.abs()));
            let shares = value.iter().zip(&size).map(|(value, size)| value.widen().abs() / size.widen());
            shares.collect::<Vec<_>>()
        });
        // 0 of 0 is no share.
        shares.filter(|share| *share > relative).max_by(f64::total_cmp)
    }
}
