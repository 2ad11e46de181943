use core::fmt;

use nalgebra::SVector;

use super::{Generator, Noether, Terms, moves_an_end};
use crate::numbers::Scalar;
use crate::step::{Discrete, Momenta};
use crate::system::VectorField;
use crate::theory::{
    samples::{
        Pair, SampleError, at_segment, at_several_times, require_informative, require_step_size, worst,
    },
    verdict::{Finding, scales},
};

/// One of the quantities of Noether's theorem over the samples.
pub type Contribution<const N: usize> = Finding<Pair<f64, N>>;

/// The effect of a generator on L_d, the force and J, over a set of segments. See [`Noether::symmetry`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Symmetry<const N: usize> {
    /// Name of the generator.
    pub generator: String,
    /// The step size.
    pub h: f64,
    /// Number of segments looked at.
    pub samples: usize,
    /// Whether the causes are taken at the stages, as those of rules with interior points are:
    /// [`Defect`](super::Defect).
    pub at_stages: bool,
    /// ξ(L_d), or ξ(L) at the stages.
    pub lagrangian: Contribution<N>,
    /// f_d(ξ), or f_L·ξ at the stages.
    pub force: Contribution<N>,
    /// The contribution of interior points; 0 where there are none.
    pub interior: Contribution<N>,
    /// The defect, the sum of the three.
    pub defect: Contribution<N>,
    /// (J⁺ − J⁻) − (ξ(L_d) + f_d(ξ)), an identity: where it fails, the system's momenta do not belong to its
    /// L_d and f_d.
    pub identity: Contribution<N>,
    /// Rounding allowed, relative to the terms.
    pub tolerance: f64,
}

impl<const N: usize> Symmetry<N> {
    /// Whether ξ is a symmetry of L_d, or of L at the stages.
    #[must_use]
    pub fn is_symmetry_of_lagrangian(&self) -> bool {
        self.lagrangian.vanishes()
    }

    /// Whether the discrete force does work along ξ, or the force at the stages.
    #[must_use]
    pub fn force_does_work(&self) -> bool {
        !self.force.vanishes()
    }

    /// Whether J is conserved: the defect vanishes.
    #[must_use]
    pub fn is_conserved(&self) -> bool {
        self.defect.vanishes()
    }

    /// Whether the momenta that the step uses are those of L_d and f_d, as they must be.
    #[must_use]
    pub fn is_consistent(&self) -> bool {
        self.identity.vanishes()
    }
}

impl<L, R, const N: usize> Noether<'_, L, R, N>
where
    L: Discrete<R, N>,
{
    /// Judges one generator on `segments`.
    ///
    /// A value counts as zero below `tolerance` × the size of its terms, Σ|D L_d||ξ| and Σ|f_d||ξ|: at its
    /// own sample, or as half of the samples exceed it, if that is more. A sum cannot be known better
    /// than its terms are rounded.
    ///
    /// **Segments it needs.** One that moves by more than rounding, with ξ ≠ 0 at an end. Each is judged by
    /// itself: the answer is about the segments given. Fewer than three of a view are asked again at later
    /// times.
    ///
    /// # Errors
    /// [`SampleError`] if there is no segment, none that moves with ξ ≠ 0, or a value is not finite.
    pub fn symmetry(
        &self,
        generator: &Generator<L::Scalar, N>,
        segments: &[Pair<L::Scalar, N>],
    ) -> Result<Symmetry<N>, SampleError> {
        self.symmetry_up_to(generator, |_| L::Scalar::constant(0.0), segments)
    }

    /// Judges one generator on `segments`, up to the difference of a function F of the configuration:
    ///
    /// ```text
    /// ξ(L_d) + f_d(ξ) = F(q1) − F(q0)     keeps     J − F
    /// ```
    ///
    /// In the answer F(q1) − F(q0) is taken from ξ(L_d), or from ξ(L) at the stages, and from J⁺ − J⁻; *J is
    /// conserved* says that J − F is.
    ///
    /// Linear drag alone keeps p + rq, so that a sled with momentum p stops p/r further on:
    ///
    /// ```
    /// use dalembert::noether::Generator;
    /// use dalembert::{Discretise, Midpoint, rayleigh_system, samples};
    ///
    /// #[rayleigh_system]
    /// fn sled(_q: [f64; 1], v: [f64; 1], m: f64, r: f64) -> (f64, f64) {
    ///     (0.5 * m * v[0] * v[0], 0.5 * r * v[0] * v[0])
    /// }
    ///
    /// let sled = Sled { m: 2.0, r: 0.3 };
    /// let noether = sled.by(Midpoint, 0.1).noether();
    /// let along = Generator::translation("x", [1.0]);
    /// let segments = samples::segments([-1.0], [1.0], [0.1], 20);
    /// assert!(!noether.symmetry(&along, &segments)?.is_conserved());
    /// assert!(noether.symmetry_up_to(&along, |q| -sled.r * q[0], &segments)?.is_conserved());
    /// # Ok::<(), dalembert::samples::SampleError>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`symmetry`](Self::symmetry).
    pub fn symmetry_up_to(
        &self,
        generator: &Generator<L::Scalar, N>,
        function: impl Fn(&SVector<L::Scalar, N>) -> L::Scalar,
        segments: &[Pair<L::Scalar, N>],
    ) -> Result<Symmetry<N>, SampleError> {
        require_step_size(self.by.h)?;
        require_informative(segments, |segment| segment.moves() && moves_an_end(generator, segment))?;
        let segments = &at_several_times(&self.by, segments)[..];
        let ends = |segment: &Pair<L::Scalar, N>| [&segment.q0, &segment.q1].map(|q| function(q).widen());
        let ends: Vec<_> = segments.iter().map(ends).collect();
        let terms = segments.iter().enumerate().map(|(k, segment)| {
            let mut terms = self.terms(k, 0, generator, segment)?;
            let [from, to] = ends[k];
            terms.defect.lagrangian -= to - from;
            terms.size.lagrangian += from.abs() + to.abs();
            Ok::<_, SampleError>(terms)
        });
        let terms: Vec<Terms> = terms.collect::<Result<_, _>>()?;
        let sizes = |scale: fn(&Terms) -> f64| scales(&terms.iter().map(scale).collect::<Vec<_>>());
        let of_lagrangian = sizes(|terms| terms.size.lagrangian);
        let of_force = sizes(|terms| terms.size.force);
        let of_all = sizes(|terms| terms.size.total());
        let contribution =
            |value: &dyn Fn(usize) -> f64, scales: &[f64]| worst(segments, self.tolerance, scales, value);
        let identity = |(k, Pair { q0, q1 }): (usize, &Pair<L::Scalar, N>)| {
            let [from, to] = ends[k];
            let jump = at_segment(&self.by, k, |by| {
                let Momenta { p0, p1 } = by.objects(q0, q1).momenta();
                p1.dot(&generator.vector(q1)) - p0.dot(&generator.vector(q0))
            });
            jump.map(|jump| jump.widen() - (to - from) - terms[k].defect.total())
        };
        let identities: Vec<f64> = segments.iter().enumerate().map(identity).collect::<Result<_, _>>()?;
        Ok(Symmetry {
            generator: generator.name().to_owned(),
            h: self.by.h.widen(),
            samples: segments.len(),
            at_stages: L::HAS_INTERIOR_POINTS,
            lagrangian: contribution(&|k| terms[k].defect.lagrangian, &of_lagrangian)?,
            force: contribution(&|k| terms[k].defect.force, &of_force)?,
            interior: contribution(&|k| terms[k].defect.interior, &of_all)?,
            defect: contribution(&|k| terms[k].defect.total(), &of_all)?,
            identity: contribution(&|k| identities[k], &of_all)?,
            tolerance: self.tolerance,
        })
    }
}

impl<const N: usize> fmt::Display for Symmetry<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict =
            |yes, affirmative: &str, negative: &str| if yes { affirmative } else { negative }.to_owned();
        writeln!(f, "{}: {} segments, h = {}", self.generator, self.samples, self.h)?;
        let (of_lagrangian, of_force, lagrangian) =
            if self.at_stages { ("h Σ bξ(L)", "h Σ bf·ξ", "L") } else { ("ξ(L_d)", "f_d(ξ)", "L_d") };
        let symmetry = verdict(self.is_symmetry_of_lagrangian(), "symmetry of", "no symmetry of");
        let rows = [
            (of_lagrangian, &self.lagrangian, format!("{symmetry} {lagrangian}")),
            (
                of_force,
                &self.force,
                verdict(
                    self.force_does_work(),
                    "the force does work along it",
                    "the force does no work along it",
                ),
            ),
            (
                "interior",
                &self.interior,
                verdict(self.interior.vanishes(), "the rule adds nothing", "added by the rule"),
            ),
            ("defect", &self.defect, verdict(self.is_conserved(), "J is conserved", "J is not conserved")),
        ];
        for (name, contribution, verdict) in
            rows.into_iter().filter(|(name, ..)| self.at_stages || *name != "interior")
        {
            writeln!(
                f,
                "  {name:<10}{:>12.3e}   zero below {:.1e}   {verdict}",
                contribution.value, contribution.tolerance
            )?;
            if !contribution.vanishes() {
                writeln!(f, "          there: {}", contribution.at)?;
            }
        }
        write!(
            f,
            "  tolerance: {:.1e} × the terms' size ({:.2e} of {lagrangian}, {:.2e} of the force), the rounding of their derivatives",
            self.tolerance, self.lagrangian.terms, self.force.terms
        )?;
        if !self.is_consistent() {
            write!(
                f,
                "\n  INCONSISTENT SYSTEM: J⁺ − J⁻ differs from ξ(L_d) + f_d(ξ) by {:+.3e} at {}; its momenta are not those of its \
                 L_d and f_d",
                self.identity.value, self.identity.at
            )?;
        }
        Ok(())
    }
}
