//! Gradients and second derivatives of L and R, derivatives of f.

use super::*;

impl Deriving<'_> {
    /// Gradient and derivatives of L or R, and variations where they are asked for.
    pub(super) fn function(&mut self, part: Part, symbol: &str, root: Node) -> Made<Vec<Routine>> {
        let home = self.system.home_of(part);
        let first = self.derivation.gradient(&mut self.graph, root);
        let second = self.derivation.hessian(&mut self.graph, root, symbol);

        let outputs = [vec![root], self.covector(&first, false), self.covector(&first, true)];
        let mut functions = vec![self.made(Of::Gradient(part), home, &outputs.concat())?];

        functions.push(self.derivatives(Of::Derivatives(part), home, root, symbol)?);

        if part == Part::Lagrangian && self.system.rules.ask_for_variations() {
            functions.push(self.variations(&second)?);
        }
        Ok(functions)
    }

    /// `root` with its first and second derivatives.
    pub(super) fn derivatives(&mut self, of: Of, home: Home, root: Node, symbol: &str) -> Made<Routine> {
        let second = self.derivation.hessian(&mut self.graph, root, symbol);
        let outputs = [
            vec![root],
            self.covector(&second.gradient, false),
            self.covector(&second.gradient, true),
            self.blocks(&second),
        ];
        self.made(of, home, &outputs.concat())
    }

    /// Derivatives of f.
    pub(super) fn force(&mut self, components: &[Node]) -> Made<Routine> {
        let rows = self.rows(components);
        let by = |deriving: &mut Self, velocity| {
            deriving.matrix(|deriving, i, j| {
                let variable = deriving.variable(j, velocity);
                rows[i].get(&variable).copied()
            })
        };
        let outputs = [components.to_vec(), by(self, false), by(self, true)].concat();
        self.made(Of::ForceDerivatives, self.system.home(), &outputs)
    }

    /// σ and ∇σ.
    pub(super) fn time_scale(&mut self, root: Node) -> Made<Routine> {
        let gradient = self.derivation.gradient(&mut self.graph, root);
        let outputs = [vec![root], self.covector(&gradient, false)].concat();
        self.made(Of::TimeScaleGradient, self.system.home(), &outputs)
    }

    /// ∂f/∂u.
    pub(super) fn by_input(&mut self, components: &[Node]) -> Made<Routine> {
        let rows = self.rows(components);
        let mut outputs = Vec::new();
        for j in 0..self.m {
            let variable = self.graph.node(Operation::Input(j));
            for row in &rows {
                outputs.push(self.or_zero(row.get(&variable).copied()));
            }
        }
        self.made(Of::ForceByInput, self.system.home(), &outputs)
    }
}
