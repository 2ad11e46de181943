//! What the generated code computes, without compiling it: the body lowered by the macro's own stages, and
//! the graph evaluated.

mod parameter;

use super::computed::Computed;
use super::number::Number;
use super::point::Point;
use super::rayleigh_system::differentiate::Differentiation;
use super::rayleigh_system::graph::{Comparison, Function, Graph, Node, Operation, PairFunction, Predicate};
use super::rayleigh_system::lower::Lowered;
use super::rayleigh_system::{Runtime, attribute, check, diagnostics::Report, lower, parse};
use super::syntax::Program;
use parameter::Known;

/// Functions that the interpreter has no name for end an evaluation.
type Result<T> = std::result::Result<T, String>;

/// The graph of a program with its derivatives.
pub struct Expressions {
    graph: Graph,
    values: Vec<Node>,
    gradients: Vec<Vec<Node>>,
    hessians: Vec<Vec<Node>>,
}

/// The program lowered and differentiated, or why not.
pub fn expressions(program: &Program, block: &str) -> Result<Expressions> {
    let mut report = Report::default();
    let options = attribute::options(Default::default(), Runtime::STD, &mut report);
    let tokens = block.parse().map_err(|_| "no tokens".to_owned())?;
    let source = parse::source(tokens, &mut report).ok_or("no block")?;
    let system = check::system(&source, &options, &mut report).ok_or("no system")?;
    let lowered = lower::system(&system).map_err(|refusal| refusal.reason)?;
    Ok(differentiated(program, lowered))
}

fn differentiated(program: &Program, lowered: Lowered) -> Expressions {
    let Lowered { mut graph, lagrangian, rayleigh, force, .. } = lowered;
    let n = program.n;
    let variables: Vec<Node> = (0..n)
        .map(Operation::Coordinate)
        .chain((0..n).map(Operation::Velocity))
        .map(|operation| graph.node(operation))
        .collect();
    let zero = graph.constant(0.0);
    let scalars: Vec<Node> = [lagrangian].into_iter().chain(rayleigh).collect();
    let components: Vec<Node> = force.into_iter().flatten().collect();
    let written = graph.len();
    let mut differentiation = Differentiation::default();
    let (mut gradients, mut hessians): (Vec<Vec<Node>>, Vec<Vec<Node>>) = (Vec::new(), Vec::new());
    for &root in &scalars {
        let derivatives = differentiation.hessian(&mut graph, root, "l");
        let first = |variable| *derivatives.gradient.get(variable).unwrap_or(&zero);
        gradients.push(variables.iter().map(first).collect());
        let second = |k: usize| {
            let (a, b) = (variables[k / (2 * n)], variables[k % (2 * n)]);
            *derivatives.hessian.get(&(a.min(b), a.max(b))).unwrap_or(&zero)
        };
        hessians.push((0..4 * n * n).map(second).collect());
    }
    for &root in &components {
        let gradient = differentiation.gradient(&mut graph, root);
        gradients.push(variables.iter().map(|variable| *gradient.get(variable).unwrap_or(&zero)).collect());
    }
    let values = scalars.into_iter().chain(components).collect();
    // The generated code computes sums of products in fewer operations.
    let all: Vec<Node> = gradients.iter().chain(&hessians).flatten().copied().collect();
    let all = graph.factored(&all, written);
    let (first, second) = all.split_at(gradients.len() * 2 * n);
    Expressions {
        gradients: first.chunks(2 * n).map(<[Node]>::to_vec).collect(),
        hessians: second.chunks(4 * n * n).map(<[Node]>::to_vec).collect(),
        graph,
        values,
    }
}

impl Expressions {
    /// What the generated code computes at the point; `plain` stands for what rustc's function computes.
    pub fn computed(&self, program: &Program, point: &Point, plain: &[f64]) -> Result<Computed> {
        let scalars = self.hessians.len();
        let values = if program.single {
            let single = |x: &[f64]| x.iter().map(|x| *x as f32).collect::<Vec<_>>();
            self.evaluated(program, &self.values, point, &single(&point.q), &single(&point.v))?
        } else {
            self.evaluated(program, &self.values, point, &point.q, &point.v)?
        };
        let all: Vec<Node> = self.gradients.iter().chain(&self.hessians).flatten().copied().collect();
        let derivatives = self.evaluated(program, &all, point, &point.q, &point.v)?;
        let size = 2 * program.n;
        let (first, second) = derivatives.split_at(self.gradients.len() * size);
        let mut told: Vec<(&'static str, Vec<f64>)> = Vec::new();
        for value in &values[..scalars] {
            told.push(("derivatives", vec![*value]));
        }
        if values.len() > scalars {
            told.push(("force", values[scalars..].to_vec()));
        }
        Ok(Computed {
            plain: Some(plain.to_vec()),
            values: told,
            gradients: first.chunks(size).map(<[f64]>::to_vec).collect(),
            hessians: second.chunks(size * size).map(<[f64]>::to_vec).collect(),
            ..Computed::default()
        })
    }

    fn evaluated<S: Number>(
        &self,
        program: &Program,
        roots: &[Node],
        point: &Point,
        q: &[S],
        v: &[S],
    ) -> Result<Vec<f64>> {
        let truth = |truth: bool| S::constant(f64::from(u8::from(truth)));
        let mut values = vec![S::constant(f64::NAN); self.graph.len()];
        for node in self.graph.reachable(roots.iter().copied()) {
            let at = |node: Node| values[node.index()];
            let holds = |node: Node| values[node.index()].value() != 0.0;
            let value = match self.graph.operation(node) {
                Operation::Coordinate(i) => q[i],
                Operation::Velocity(i) => v[i],
                Operation::Input(i) => S::constant(point.u[i]),
                operation if self.graph.is_time(operation) => S::constant(point.t),
                Operation::Parameter(i) => {
                    let tokens = &self.graph.parameter(i).tokens;
                    match parameter::evaluate::<S>(program, tokens.clone())? {
                        Known::Real(x) => x,
                        Known::Bool(x) => truth(x),
                        Known::Other => return Err(format!("`{tokens}` is no number")),
                    }
                }
                Operation::Constant(bits) if program.single => {
                    S::constant(f64::from(f64::from_bits(bits) as f32))
                }
                Operation::Constant(bits) => S::constant(f64::from_bits(bits)),
                Operation::Add(a, b) => at(a).plus(at(b)),
                Operation::Subtract(a, b) => at(a).minus(at(b)),
                Operation::Multiply(a, b) => at(a).times(at(b)),
                Operation::Divide(a, b) => at(a).over(at(b)),
                Operation::Negate(a) => at(a).negated(),
                Operation::Function(function, x) => at(x).function(Function::name(function)),
                Operation::Pair(function, a, b) => at(a).pair(PairFunction::name(function), at(b)),
                Operation::Characteristic(..) => {
                    return Err(String::from("a characteristic, which no program drawn here has"));
                }
                Operation::MultiplyAdd(a, b, c) => at(a).mul_add(at(b), at(c)),
                Operation::Power(x, n) => at(x).powi(n),
                Operation::Select(condition, a, b) => {
                    if holds(condition) {
                        at(a)
                    } else {
                        at(b)
                    }
                }
                Operation::Compare(comparison, a, b) => {
                    let (a, b) = (at(a), at(b));
                    let (less, equal, greater) = (a.less(b), a.equal(b), b.less(a));
                    truth(match comparison {
                        Comparison::Less => less,
                        Comparison::LessOrEqual => less || equal,
                        Comparison::Greater => greater,
                        Comparison::GreaterOrEqual => greater || equal,
                        Comparison::Equal => equal,
                        Comparison::NotEqual => !equal,
                    })
                }
                Operation::Is(predicate, x) => truth(Predicate::method(predicate)(at(x).value())),
                Operation::Not(a) => truth(!holds(a)),
                Operation::And(a, b) => truth(holds(a) && holds(b)),
                Operation::Or(a, b) => truth(holds(a) || holds(b)),
            };
            values[node.index()] = value;
        }
        Ok(roots.iter().map(|root| values[root.index()].value()).collect())
    }
}
