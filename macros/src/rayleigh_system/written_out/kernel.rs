//! The step's equation, fused: L, R and f with the rule's directions folded in, each shared expression once;
//! in the form that the structure of its matrix allows.

use super::super::write::Memory;
use super::structure::Newton;
use super::*;

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

impl Code<'_> {
    /// `step_kernel`, `momenta` and what the structure allows.
    pub(super) fn kernel(
        &mut self,
        newton: &Newton,
        lagrangian: Node,
        rayleigh: Option<Node>,
        force: Option<&[Node]>,
    ) -> Kernel {
        let force = force.unwrap_or_default().to_vec();
        let lagrangian = self.derivation.hessian(&mut self.graph, lagrangian, "l");
        let rayleigh =
            rayleigh.map(|root| self.derivation.hessian(&mut self.graph, root, "r")).unwrap_or_default();
        let rows = self.rows(&force);
        let parts = Parts { lagrangian, rayleigh, force, rows };
        let points = newton.rule.entry().points;
        let Equation { p0, p1, matrix } = match points {
            Points::Middle => self.midpoint(&parts),
            Points::Ends => self.trapezoidal(&parts),
        };
        let framed = |code: &Self, line: &StraightLine, result: TokenStream| match points {
            Points::Middle => code.at_midpoint(line, result),
            Points::Ends => code.at_both_ends(line, result),
        };

        let diagonals = diagonals(self.n, newton.bandwidth);
        let (line, matrix) = self.newton_matrix(&p0, &matrix, diagonals);
        let [value] = self.parts(&line.outputs[..self.n], [Shape::Vector]);
        let step_kernel = framed(self, &line, quote!(StepKernel { p0: #value, matrix: #matrix }));

        let line = self.code_at_node(&[p0, p1].concat(), &[]);
        let [p0, p1] = self.parts(&line.outputs, [Shape::Vector, Shape::Vector]);
        let momenta = framed(self, &line, quote!(Momenta { p0: #p0, p1: #p1 }));

        let (explicit, in_lanes) = newton.is_explicit.then(|| self.explicit(&parts, diagonals)).unzip();
        let memory = match () {
            () if newton.is_explicit => Memory::Explicit,
            () if newton.constant || self.n >= KEPT_FROM => Memory::Matrix,
            () => Memory::Velocities,
        };
        Kernel {
            step_kernel,
            momenta,
            diagonals,
            is_linear: newton.constant,
            memory,
            explicit,
            in_lanes: in_lanes.flatten(),
        }
    }

    /// The code of `before` and of a matrix, given column by column, in the form that its diagonals allow.
    pub(super) fn newton_matrix(
        &mut self,
        before: &[Node],
        matrix: &[Node],
        diagonals: Option<usize>,
    ) -> (StraightLine, TokenStream) {
        let n = self.n;
        let Some(diagonals) = diagonals else {
            let line = self.code_at_node(&[before, matrix].concat(), &[]);
            let [matrix] = self.parts(&line.outputs[before.len()..], [Shape::Matrix]);
            return (line, matrix);
        };
        let zero = self.graph.constant(0.0);
        let band: Vec<Node> = (0..n)
            .flat_map(|row| {
                (0..diagonals)
                    .map(move |k| (row, (row + k).checked_sub(diagonals / 2).filter(|&column| column < n)))
            })
            .map(|(row, column)| column.map_or(zero, |column| matrix[column * n + row]))
            .collect();
        let line = self.code_at_node(&[before, &band].concat(), &[]);
        let rows = line.outputs[before.len()..].chunks(diagonals).map(|row| quote!([#(#row),*]));
        let matrix = quote!(::dalembert::generated::Banded { rows: [#(#rows),*] });
        (line, matrix)
    }
}

/// How many diagonals to keep of a Newton matrix; all entries where a band would not pay.
fn diagonals(n: usize, bandwidth: usize) -> Option<usize> {
    let diagonals = 2 * bandwidth + 1;
    let pays = if bandwidth == 0 { n > 1 } else { n >= BANDED_FROM && diagonals < n };
    pays.then_some(diagonals)
}
