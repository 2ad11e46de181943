use core::fmt;

use nalgebra::{DMatrix, SVector};

use super::closure::Fields;
use super::rank::{Conditions, null_space};
use super::{Closure, Generator, Noether, RankDecision, Terms, moves_an_end};
use crate::numbers::Scalar;
use crate::step::Discrete;
use crate::theory::{
    restriction::at_segment_on_constraints,
    samples::{
        Pair, SampleError, Sizes, at_several_times, different, require_informative, require_step_size,
    },
    verdict::largest,
};

/// Which combinations of some generators are symmetries. See [`Noether::subalgebra`].
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Subalgebra {
    /// Names of the generators, in the order of the coefficients.
    pub generators: Vec<String>,
    /// Number of segments looked at.
    pub samples: usize,
    /// Closure of the span of all generators, which should be a Lie algebra 𝔤.
    pub closure: Closure,
    /// { ξ : ξ(L_d) = 0 }, the symmetries of L_d. The paper's theorem supposes that this is all of 𝔤.
    pub lagrangian: Subspace,
    /// { ξ : ξ(L_d) + f_d(ξ) = 0 }, the largest subspace that keeps J. It need not be a subalgebra.
    pub conserved: Subspace,
    /// 𝔤_{f_d} = { ξ : f_d(ξ) = 0 and ι_ξ df_d = 0 }, the subalgebra of the paper's theorem: the force does
    /// no work along ξ and is carried into itself.
    pub invariant: Subspace,
}

/// A subspace of combinations of generators.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Subspace {
    /// A basis in reduced row echelon form: the coefficients of each element, its pivot 1.
    pub basis: Vec<Vec<f64>>,
    /// How its dimension was decided.
    pub decision: RankDecision,
    /// Whether the bracket leads out of it.
    pub closure: Closure,
}

impl Subspace {
    /// The dimension.
    #[must_use]
    pub fn dimension(&self) -> usize {
        self.basis.len()
    }
}

impl Subalgebra {
    /// Whether L_d is invariant under all generators, the premise of the paper's theorem: decided with a
    /// clear gap.
    #[must_use]
    pub fn premise_holds(&self) -> bool {
        self.lagrangian.dimension() == self.generators.len() && self.lagrangian.decision.is_clear()
    }
}

/// Why the subalgebra cannot be decided.
#[derive(Clone, PartialEq)]
#[non_exhaustive]
pub enum SubalgebraError {
    /// The samples do not decide.
    Samples(SampleError),
    /// A combination of the generators vanishes at all sampled points: there is one too many.
    DependentGenerators {
        /// The coefficients of that combination.
        relation: Vec<f64>,
    },
}

impl From<SampleError> for SubalgebraError {
    fn from(error: SampleError) -> Self {
        Self::Samples(error)
    }
}

impl fmt::Display for SubalgebraError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Samples(error) => error.fmt(f),
            Self::DependentGenerators { relation } => write!(
                f,
                "the generators are linearly dependent at the samples: the combination {relation:.3?} vanishes; leave one \
                 out, or sample a larger region"
            ),
        }
    }
}

debug_by_display!(SubalgebraError);

impl core::error::Error for SubalgebraError {}

/// The contributions of one generator at one segment.
struct Row {
    lagrangian: (f64, f64),
    force: (f64, f64),
    total: (f64, f64),
    /// ι_ξ df_d, component by component: N at q0, then N at q1; at stages, where the rule has them.
    contraction: Vec<(f64, f64)>,
}

impl<L, R, const N: usize> Noether<'_, L, R, N>
where
    L: Discrete<R, N>,
{
    /// The largest subspaces of the span of `generators` that keep L_d, J and f_d, judged on `segments`.
    ///
    /// Every condition is linear in ξ and becomes rows of a matrix, one a segment (2N for ι_ξ df_d = (F −
    /// Fᵀ)(ξ(q0), ξ(q1)), F = ∂(f_d⁻, f_d⁺)/∂(q0, q1); 2N for each stage of a rule with interior points,
    /// where all are taken at the stages: [`Defect`](super::Defect)); the subspace is its null space, its
    /// dimension a [`RankDecision`]. Brackets [ξ, η] = Dη ξ − Dξ η are taken at the ends of the segments and
    /// fitted by the span.
    ///
    /// **Segments it needs.** Two for each generator that move by more than rounding and lie apart
    /// ([`samples`](crate::samples)).
    ///
    /// # Errors
    /// [`SubalgebraError`] if there are fewer, a value is not finite, or the generators are linearly
    /// dependent.
    pub fn subalgebra(
        &self,
        generators: &[Generator<L::Scalar, N>],
        segments: &[Pair<L::Scalar, N>],
    ) -> Result<Subalgebra, SubalgebraError> {
        require_step_size(self.by.h)?;
        require_informative(segments, |segment| {
            segment.moves() && generators.iter().any(|xi| moves_an_end(xi, segment))
        })?;
        let needed = (2 * generators.len()).max(1);
        let moving: Vec<_> = segments.iter().filter(|segment| segment.moves()).copied().collect();
        let given = different(&moving, &Sizes::of(moving.iter().copied()), needed);
        if given < needed {
            return Err(SampleError::TooFew { given, needed }.into());
        }
        let segments = &at_several_times(&self.by, segments)[..];
        let rows: Vec<Vec<Row>> = segments
            .iter()
            .enumerate()
            .map(|(k, segment)| generators.iter().enumerate().map(|xi| self.row(k, xi, segment)).collect())
            .collect::<Result<_, SampleError>>()?;
        let points: Vec<SVector<L::Scalar, N>> =
            segments.iter().flat_map(|segment| [segment.q0, segment.q1]).collect();
        let fields = Fields::at(generators, &points);
        require_finite(&rows, &fields)?;
        let (independence, relations) = null_space(&fields.conditions(), self.tolerance);
        if let Some(relation) = relations.into_iter().next() {
            return Err(SubalgebraError::DependentGenerators { relation });
        }

        let block = |entry: &dyn Fn(&Row) -> (f64, f64)| {
            let matrix = |part: fn((f64, f64)) -> f64| {
                DMatrix::from_fn(rows.len(), generators.len(), |i, j| part(entry(&rows[i][j])))
            };
            Conditions { values: matrix(|(value, _)| value), sizes: matrix(|(_, size)| size) }
        };
        let components = rows.first().and_then(|row| row.first()).map_or(0, |row| row.contraction.len());
        let contractions: Vec<_> =
            (0..components).map(|component| block(&|row| row.contraction[component])).collect();
        // Norms of entries that could be squared are not sure to be finite.
        let size = |block: &Conditions| largest(block.sizes.iter().copied());
        let most = largest(contractions.iter().map(size));
        let mut invariance = vec![block(&|row| row.force)];
        // A component of df_d that is nothing but rounding beside the others is no condition.
        invariance.extend(contractions.into_iter().filter(|block| size(block) > self.tolerance * most));

        let subspace = |conditions: &[Conditions]| {
            let (decision, basis) = null_space(conditions, self.tolerance);
            let closure = fields.closure(&basis, self.tolerance + decision.uncertainty());
            Subspace { basis, decision, closure }
        };
        let unit = |i| (0..generators.len()).map(|j| f64::from(u8::from(i == j))).collect();
        let all: Vec<Vec<f64>> = (0..generators.len()).map(unit).collect();
        Ok(Subalgebra {
            generators: generators.iter().map(|xi| xi.name().to_owned()).collect(),
            samples: segments.len(),
            closure: fields.closure(&all, self.tolerance + independence.uncertainty()),
            lagrangian: subspace(&[block(&|row| row.lagrangian)]),
            conserved: subspace(&[block(&|row| row.total)]),
            invariant: subspace(&invariance),
        })
    }

    fn row(
        &self,
        k: usize,
        (number, xi): (usize, &Generator<L::Scalar, N>),
        segment: &Pair<L::Scalar, N>,
    ) -> Result<Row, SampleError> {
        let Terms { defect, size } = self.terms(k, number, xi, segment)?;
        let contraction = at_segment_on_constraints(&self.by, k, segment, |by, ends| {
            let mut components = Vec::new();
            let mut component = |value: L::Scalar, size: L::Scalar| components.push((value, size));
            by.objects(&segment.q0, &segment.q1).force_contraction(xi, &mut component);
            if let Some(ends) = ends {
                ends.restrict_covector(&mut components);
            }
            components.iter().map(|(value, size)| (value.widen(), size.widen())).collect()
        })?;
        Ok(Row {
            lagrangian: (defect.lagrangian, size.lagrangian),
            force: (defect.force, size.force),
            total: (defect.total(), size.total()),
            contraction,
        })
    }
}

fn require_finite(rows: &[Vec<Row>], fields: &Fields) -> Result<(), SampleError> {
    let finite = |row: &Row| {
        row.lagrangian.1.is_finite()
            && row.force.1.is_finite()
            && row.total.1.is_finite()
            && row.contraction.iter().all(|(_, size)| size.is_finite())
    };
    let rows = rows.iter().position(|row| !row.iter().all(finite));
    let points = fields.first_non_finite().map(|point| point / 2);
    match rows.into_iter().chain(points).min() {
        Some(index) => Err(SampleError::NonFinite { index }),
        None => Ok(()),
    }
}

impl fmt::Display for Subalgebra {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "span of {} ({} segments): {}", self.generators.join(", "), self.samples, self.closure)?;
        for (name, subspace) in [
            ("symmetries of L_d, ξ(L_d) = 0", &self.lagrangian),
            ("J kept, ξ(L_d) + f_d(ξ) = 0", &self.conserved),
            ("𝔤_{f_d}, f_d(ξ) = 0 and ι_ξ df_d = 0", &self.invariant),
        ] {
            writeln!(f, "  {name}: dimension {}", subspace.dimension())?;
            for vector in &subspace.basis {
                writeln!(f, "    {}", combination(vector, &self.generators))?;
            }
            writeln!(f, "    {}", subspace.decision)?;
            writeln!(f, "    {}", subspace.closure)?;
        }
        write!(
            f,
            "  premise of the theorem, L_d invariant under all generators: {}",
            if self.premise_holds() { "holds" } else { "does not hold" }
        )
    }
}

/// "1·x + 0.5·rotation(0, 1)", without the terms that are 0.
fn combination(coefficients: &[f64], names: &[String]) -> String {
    let terms = coefficients.iter().zip(names).filter(|(c, _)| **c != 0.0);
    let mut text = String::new();
    for (c, name) in terms {
        let sign = match (text.is_empty(), *c < 0.0) {
            (true, false) => "",
            (true, true) => "−",
            (false, false) => " + ",
            (false, true) => " − ",
        };
        let digits = format!("{:.6}", c.abs());
        let factor = match digits.trim_end_matches('0').trim_end_matches('.') {
            "1" => String::new(),
            digits => format!("{digits}·"),
        };
        text.push_str(&format!("{sign}{factor}{name}"));
    }
    text
}
