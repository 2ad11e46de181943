//! The step's equation, fused: L, R and f with the rule's directions folded in, each shared expression once;
//! in the form that the structure of its matrix allows.

use super::structure::Newton;
use super::*;

/// The equation of a step by a rule, and what its structure allows.
pub struct Kernel {
    pub step_kernel: Routine,
    pub momenta: Routine,
    /// The diagonals of a banded Newton matrix.
    pub diagonals: Option<usize>,
    /// The step is one linear solve.
    pub is_linear: bool,
    /// Whether a run keeps the Newton matrix.
    pub keeps_matrix: bool,
    pub explicit: Option<Explicit>,
    /// Components of the kinks that the step takes apart from the rest.
    pub friction: usize,
    /// Both functions of several members at once.
    pub in_lanes: Option<[Routine; 2]>,
}

/// The functions of an explicit step.
pub struct Explicit {
    pub matrix: Routine,
    pub momenta: Routine,
    pub force: Routine,
    /// Momenta and force of several members at once.
    pub in_lanes: Option<[Routine; 2]>,
}

/// L, R and f with their derivatives, as far as there are any.
pub(super) struct Parts {
    pub lagrangian: Derivatives,
    pub rayleigh: Derivatives,
    pub force: Vec<Node>,
    /// The gradient of each component of the force.
    pub rows: Vec<Gradient>,
}

/// p0 and p1 as functions of q0 and v̄, and ∂p0/∂v̄ column by column.
pub(super) struct Equation {
    pub p0: Vec<Node>,
    pub p1: Vec<Node>,
    pub matrix: Vec<Node>,
}

/// From this N on a band is solved faster than the dense matrix that it is part of.
const BANDED_FROM: usize = 4;

/// From this N on a Newton matrix kept from the steps before is faster than a new one.
const KEPT_FROM: usize = 3;

impl Deriving<'_> {
    /// The kernel of a rule, in the form that its structure allows.
    pub(super) fn kernel(&mut self, newton: &Newton, kinks: &Kinks) -> Made<Kernel> {
        let is_apart = newton.rule == Rule::Proximal;
        let rayleigh = if is_apart { kinks.smooth } else { self.rayleigh };
        let force = self.force.unwrap_or_default().to_vec();
        let lagrangian = self.derivation.hessian(&mut self.graph, self.lagrangian, "l");
        let rayleigh =
            rayleigh.map(|root| self.derivation.hessian(&mut self.graph, root, "r")).unwrap_or_default();
        let rows = self.rows(&force);
        let parts = Parts { lagrangian, rayleigh, force, rows };
        let points = newton.rule.entry().points;
        let Equation { p0, p1, matrix } = match points {
            Points::Middle => self.midpoint(&parts),
            Points::Ends => self.trapezoidal(&parts),
        };

        let diagonals = diagonals(self.n, newton.bandwidth);
        let is_in_lanes = newton.rule == Rule::Midpoint && self.system.lanes.midpoint.is_some();
        let kernel = [&p0[..], &self.in_form(&matrix, diagonals)].concat();
        let step_kernel = self.of_step(Of::StepKernel(points), &kernel, is_in_lanes)?;
        let momenta = self.of_step(Of::Momenta(points), &[p0, p1].concat(), is_in_lanes)?;
        let in_lanes = is_in_lanes.then(|| self.on_members([&step_kernel, &momenta])).flatten();
        let explicit = newton.is_explicit.then(|| self.explicit(&parts, diagonals)).transpose()?;
        Ok(Kernel {
            step_kernel,
            momenta,
            diagonals,
            is_linear: newton.constant,
            keeps_matrix: !is_apart && (newton.constant || self.n >= KEPT_FROM),
            explicit,
            friction: if is_apart { kinks.components() } else { 0 },
            in_lanes,
        })
    }

    /// The function on numbers, by the functions of members where members compute it too.
    pub(super) fn of_step(&mut self, of: Of, outputs: &[Node], is_in_lanes: bool) -> Made<Routine> {
        let function = self.made(of, self.system.home(), outputs)?;
        let kind = if is_in_lanes { Kind::NumbersAsMembers } else { Kind::Numbers };
        Ok(Routine { kind, ..function })
    }

    /// The functions on members; nothing where a field is read within a condition, since numbers are read
    /// before.
    pub(super) fn on_members(&self, functions: [&Routine; 2]) -> Option<[Routine; 2]> {
        let outputs = || functions.iter().flat_map(|function| &function.outputs).copied();
        (!self.graph.is_conditional(outputs())).then(|| {
            functions.map(|&Routine { of, home, ref outputs, .. }| {
                let kind = Kind::Members { handed: Vec::new(), reciprocals: None };
                Routine { of, home, kind, outputs: outputs.clone() }
            })
        })
    }

    /// The entries of a matrix, given column by column, that its form keeps: of a band row by row.
    pub(super) fn in_form(&mut self, matrix: &[Node], diagonals: Option<usize>) -> Vec<Node> {
        let n = self.n;
        let Some(diagonals) = diagonals else { return matrix.to_vec() };
        let zero = self.graph.constant(0.0);
        (0..n)
            .flat_map(|row| {
                (0..diagonals)
                    .map(move |k| (row, (row + k).checked_sub(diagonals / 2).filter(|&column| column < n)))
            })
            .map(|(row, column)| column.map_or(zero, |column| matrix[column * n + row]))
            .collect()
    }
}

/// How many diagonals to keep of a Newton matrix; all entries where a band would not pay.
fn diagonals(n: usize, bandwidth: usize) -> Option<usize> {
    let diagonals = 2 * bandwidth + 1;
    let pays = if bandwidth == 0 { n > 1 } else { n >= BANDED_FROM && diagonals < n };
    pays.then_some(diagonals)
}
