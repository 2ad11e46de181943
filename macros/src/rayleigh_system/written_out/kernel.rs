//! The step's equation, fused: L, R and f with the rule's directions folded in, each shared expression once;
//! in the form that the structure of its matrix allows.

use super::super::write::Memory;
use super::in_lanes::TAKEN_AT_MIDPOINT;
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
    ) -> Written<Kernel> {
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
            Points::Middle => code.at_midpoint(line, &quote!(self.t), of_segment, result),
            Points::Ends => code.at_both_ends(line, result),
        };

        let diagonals = diagonals(self.n, newton.bandwidth);
        let is_in_lanes = points == Points::Middle && self.system.lanes.midpoint.is_some();
        let kernel = [&p0[..], &self.in_form(&matrix, diagonals)].concat();
        let kernel = self.shortened(&kernel)?;
        let line = self.members_code(&kernel, &TAKEN_AT_MIDPOINT, is_in_lanes);
        let matrix = self.matrix_in_form(&line.outputs[self.n..], diagonals);
        let [value] = self.parts(&line.outputs[..self.n], [Shape::Vector]);
        let step_kernel = framed(self, &line, quote!(StepKernel { p0: #value, matrix: #matrix }));

        let both = self.shortened(&[p0, p1].concat())?;
        let line = self.members_code(&both, &TAKEN_AT_MIDPOINT, is_in_lanes);
        let [p0, p1] = self.parts(&line.outputs, [Shape::Vector, Shape::Vector]);
        let momenta = framed(self, &line, quote!(Momenta { p0: #p0, p1: #p1 }));

        if is_in_lanes {
            self.in_lanes.midpoint = self.midpoint_lines(&kernel, &both, diagonals);
        }
        let explicit = newton.is_explicit.then(|| self.explicit(&parts, diagonals)).transpose()?;
        let memory = match () {
            () if newton.is_explicit => Memory::Explicit,
            () if newton.constant || self.n >= KEPT_FROM => Memory::Matrix,
            () => Memory::Velocities,
        };
        Ok(Kernel { step_kernel, momenta, diagonals, is_linear: newton.constant, memory, explicit })
    }

    /// The code of a matrix, given column by column, in the form that its diagonals allow.
    pub(super) fn newton_matrix(
        &mut self,
        matrix: &[Node],
        diagonals: Option<usize>,
    ) -> Written<(StraightLine, TokenStream)> {
        let entries = self.in_form(matrix, diagonals);
        let entries = self.shortened(&entries)?;
        let line = self.code_as_it_stands(self.system.home(), &entries, &[]);
        let matrix = self.matrix_in_form(&line.outputs, diagonals);
        Ok((line, matrix))
    }

    /// The entries of a matrix, given column by column, that its form keeps: of a band row by row.
    fn in_form(&mut self, matrix: &[Node], diagonals: Option<usize>) -> Vec<Node> {
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

    /// The matrix of the entries that its form keeps.
    fn matrix_in_form(&self, entries: &[TokenStream], diagonals: Option<usize>) -> TokenStream {
        let Some(diagonals) = diagonals else { return body::matrix(entries, self.n) };
        let rows = entries.chunks(diagonals).map(|row| quote!([#(#row),*]));
        quote!(::dalembert::generated::Banded { rows: [#(#rows),*] })
    }
}

/// How many diagonals to keep of a Newton matrix; all entries where a band would not pay.
fn diagonals(n: usize, bandwidth: usize) -> Option<usize> {
    let diagonals = 2 * bandwidth + 1;
    let pays = if bandwidth == 0 { n > 1 } else { n >= BANDED_FROM && diagonals < n };
    pays.then_some(diagonals)
}
