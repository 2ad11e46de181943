//! Constraints: gradients, rates and curvature.
//!
//! Rows are the constraints gₖ(q, t) = 0, then the velocity constraints ψₖ(q, v, t) = 0. Each row has a rate
//! ρₖ, which is gₖ differentiated by time, or ψₖ; G = ∂ρ/∂v is ∂g/∂q in rows of the first kind.

use super::*;

/// The properties of constraints that their expressions show.
#[derive(Default)]
pub struct Findings {
    /// Whether they move by themselves: in time, or where v is 0.
    pub is_prescribed: bool,
    /// Velocity constraints that are not linear in v.
    pub not_linear: Vec<usize>,
}

/// The rows of constraints while their functions are made.
struct Rows {
    /// gₖ, 0 for a velocity constraint.
    values: Vec<Node>,
    /// Gₖⱼ, by rows.
    gradients: Vec<Vec<Node>>,
    /// ρₖ.
    rates: Vec<Node>,
}

impl Deriving<'_> {
    /// The functions of `Constrained`, but for the constraints as they are written.
    pub(super) fn constraints(&mut self, constraints: &[Vec<Node>; 2]) -> Made<(Vec<Routine>, Findings)> {
        let home = self.system.home_of(Part::Constraints);
        let rows = self.constraint_rows(constraints);
        let mut outputs = rows.values.clone();
        for j in 0..self.n {
            outputs.extend(rows.gradients.iter().map(|row| row[j]));
        }
        let mut functions = vec![self.made(Of::ConstraintGradients, home, &outputs)?];

        let by_q = self.rows(&rows.rates);
        let mut outputs = rows.rates.clone();
        for j in 0..self.n {
            let variable = self.variable(j, false);
            for row in &by_q {
                outputs.push(self.or_zero(row.get(&variable).copied()));
            }
        }
        functions.push(self.made(Of::ConstraintRates, home, &outputs)?);

        let reaction = self.reaction(&rows.gradients);
        let by_q = self.rows(&reaction);
        let outputs = self.matrix(|deriving, i, j| {
            let variable = deriving.variable(j, false);
            by_q[i].get(&variable).copied()
        });
        functions.push(self.made(Of::ConstraintCurvature, home, &outputs)?);
        if !self.system.parameters.is_empty() {
            functions.push(self.constraints_by_parameters(&rows, &reaction)?);
        }
        let of_velocity = rows.gradients[constraints[0].len()..].iter().enumerate();
        let not_linear = of_velocity.filter(|(_, row)| row.iter().any(|&slope| self.reads_velocity(slope)));
        let findings = Findings {
            is_prescribed: Part::CONSTRAINTS.into_iter().any(|part| self.system.takes_time(part))
                || constraints[1].iter().any(|&rate| !self.vanishes_at_rest(rate)),
            not_linear: not_linear.map(|(index, _)| index).collect(),
        };
        Ok((functions, findings))
    }

    fn constraint_rows(&mut self, [holonomic, of_velocity]: &[Vec<Node>; 2]) -> Rows {
        let by_variables = self.rows(holonomic);
        let mut rows = Rows { values: holonomic.clone(), gradients: Vec::new(), rates: Vec::new() };
        for row in by_variables {
            let gradient = self.covector(&row, false);
            let time = self.graph.time(false);
            let mut rate = row.get(&time).copied();
            for (j, &entry) in gradient.iter().enumerate() {
                if self.graph.constant_value(entry) != Some(0.0) {
                    let velocity = self.variable(j, true);
                    let term = self.graph.times(entry, velocity);
                    rate = Some(self.added(rate, term));
                }
            }
            rows.rates.push(self.or_zero(rate));
            rows.gradients.push(gradient);
        }
        for (row, &rate) in self.rows(of_velocity).iter().zip(of_velocity) {
            rows.values.push(self.or_zero(None));
            rows.gradients.push(self.covector(row, true));
            rows.rates.push(rate);
        }
        rows
    }

    /// Gᵀλ.
    fn reaction(&mut self, gradients: &[Vec<Node>]) -> Vec<Node> {
        let entry = |deriving: &mut Self, i: usize| {
            let mut sum = None;
            for (k, row) in gradients.iter().enumerate() {
                if deriving.graph.constant_value(row[i]) != Some(0.0) {
                    let factor = deriving.graph.entry("lambda", k);
                    let term = deriving.graph.times(factor, row[i]);
                    sum = Some(deriving.added(sum, term));
                }
            }
            deriving.or_zero(sum)
        };
        (0..self.n).map(|i| entry(self, i)).collect()
    }

    /// ∂g/∂θ, ∂ρ/∂θ and ∂(Gᵀλ)/∂θ.
    fn constraints_by_parameters(&mut self, rows: &Rows, reaction: &[Node]) -> Made<Routine> {
        let mut outputs = Vec::new();
        for components in [&rows.values[..], &rows.rates, reaction] {
            outputs.extend(self.columns_by_parameters(components));
        }
        self.made(Of::ConstraintsByParameters, self.system.home(), &outputs)
    }

    pub(super) fn reads_velocity(&self, root: Node) -> bool {
        let reached = self.graph.reachable([root]);
        reached.into_iter().any(|node| matches!(self.graph.operation(node), Operation::Velocity(_)))
    }

    /// Whether an expression is 0 by structure where v is.
    pub(super) fn vanishes_at_rest(&self, root: Node) -> bool {
        let mut vanishes = BTreeMap::new();
        for node in self.graph.reachable([root]) {
            let is_zero = |argument: Node| vanishes.get(&argument).copied().unwrap_or_default();
            let at_rest = match self.graph.operation(node) {
                Operation::Velocity(_) => true,
                Operation::Constant(_) => self.graph.constant_value(node) == Some(0.0),
                Operation::Add(a, b) | Operation::Subtract(a, b) | Operation::Select(_, a, b) => {
                    is_zero(a) && is_zero(b)
                }
                Operation::Multiply(a, b) => is_zero(a) || is_zero(b),
                Operation::MultiplyAdd(a, b, c) => (is_zero(a) || is_zero(b)) && is_zero(c),
                Operation::Divide(a, _) | Operation::Negate(a) => is_zero(a),
                _ => false,
            };
            vanishes.insert(node, at_rest);
        }
        vanishes.get(&root).copied().unwrap_or_default()
    }
}
