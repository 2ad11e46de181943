//! The implementation with derivatives written out: straight-line code on plain numbers.
//!
//! The user's item stands as it was written; nothing of it is evaluated over other numbers.

mod directions;
mod explicit;
mod kernel;
mod midpoint;
mod sensitivity;
mod stages;
mod trapezoidal;

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use syn::Ident;

use super::differentiate::{Derivatives, Differentiation, Gradient};
use super::emit::{StraightLine, straight_line};
use super::graph::{Graph, MOST_OPERATIONS, Node, Operation};
use super::lower::{Length, Load, Lowered, Refusal};
use super::model::{Degrees, Home, Part, System};
use super::rules::Points;
use super::structure::{self, Differentiated, Findings, Structure, Terms};
use super::write::item::as_written;
use super::write::{self, EngineFunctions, Kernel, view};

/// The whole expansion: the user's item as it stands, and the system with its derivatives.
///
/// `is_portable`: the elementary functions are the runtime's, in the user's bodies too.
pub fn system(system: &System<'_>, written: WrittenOut, is_portable: bool) -> TokenStream {
    let item = as_written(system, &written.run, is_portable);
    let view = view::definition(system);
    let implementation = write::system(system, written.functions);
    quote! {
        #item

        #view

        #implementation
    }
}

/// A system whose derivatives are written out.
pub struct WrittenOut {
    functions: EngineFunctions,
    /// The user's functions that the bodies run.
    run: Vec<Ident>,
}

/// The derivatives of what was lowered, unless they are too long to be written out.
pub fn functions(
    system: &System<'_>,
    lowered: Lowered,
    is_portable: bool,
) -> std::result::Result<WrittenOut, Refusal> {
    let Lowered { graph, n, m, lagrangian, rayleigh, force, functions: run, bindings, heaviest } = lowered;
    let written = graph.len();
    let mut code = Code {
        system,
        graph,
        written,
        n,
        m,
        derivation: Differentiation::default(),
        home: system.home_of(Part::Lagrangian),
        is_portable,
        calls_elementary: false,
        longest: 0,
    };
    let heaviest = heaviest.as_ref();
    let force = force.as_deref();
    let of_lagrangian = code.function("lagrangian", "l", lagrangian);
    code.bounded(heaviest)?;
    code.home = system.home_of(Part::Rayleigh);
    let of_rayleigh = rayleigh.map(|root| code.function("rayleigh", "r", root));
    code.bounded(heaviest)?;
    code.home = system.home();
    let of_force = force.map(|components| code.force(components));
    let by_input =
        force.zip(system.input.as_ref()).map(|(components, input)| code.by_input(components, input));
    code.bounded(heaviest)?;
    let by_parameters = code.all_by_parameters(lagrangian, rayleigh, force);
    let second_order = code.all_along(lagrangian, rayleigh, force);
    code.bounded(heaviest)?;
    let findings = code.findings(lagrangian, rayleigh, force);
    let stages = if system.rules.gauss { code.stages(lagrangian, rayleigh, force) } else { None };
    code.bounded(heaviest)?;
    let mut kernels = Vec::new();
    for newton in &findings.newton {
        // Rules that take L and R together bring their own kernel.
        let is_own = newton.rule.joint().is_none();
        kernels.push(is_own.then(|| code.kernel(newton, lagrangian, rayleigh, force)));
        code.bounded(heaviest)?;
    }
    let names = stages.as_ref().map(names_of_lanes).unwrap_or_default();
    let functions = EngineFunctions {
        structure: Structure { engine: structure::Engine::Expanded, findings: Some(findings) },
        lagrangian: of_lagrangian,
        rayleigh: of_rayleigh,
        force: of_force,
        by_input,
        stages,
        kernels,
        by_parameters,
        second_order,
        names,
        calls_elementary: code.calls_elementary,
        bindings,
    };
    Ok(WrittenOut { functions, run })
}

/// The names of the runtime that code in lanes uses.
fn names_of_lanes(stages: &TokenStream) -> Vec<&'static str> {
    let text = stages.to_string();
    let occurs = |name: &str| text.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == name);
    ["LaneVector", "Lanes", "Mask", "Stages"].into_iter().filter(|name| occurs(name)).collect()
}

/// A system while its code is written.
struct Code<'s> {
    system: &'s System<'s>,
    graph: Graph,
    /// How many expressions the user wrote.
    written: usize,
    n: usize,
    /// Entries of the input.
    m: usize,
    derivation: Differentiation,
    /// What the function being written stands on.
    home: Home,
    is_portable: bool,
    /// Whether any function written calls one of the runtime's elementary functions.
    calls_elementary: bool,
    /// Operations of the longest function.
    longest: usize,
}

impl Code<'_> {
    /// Refuses what is too long, at the loop that writes most of it.
    fn bounded(&self, heaviest: Option<&Load>) -> Result<(), Refusal> {
        let length = match self.longest {
            longest if longest > MOST_OPERATIONS => Length::Function(longest),
            _ if self.graph.is_full() => Length::Unknown,
            _ => return Ok(()),
        };
        Err(match heaviest {
            Some(heaviest) => heaviest.refusal(length),
            None => length.of(self.system.source.name()),
        })
    }

    /// What the expressions show of the system's structure.
    fn findings(&mut self, lagrangian: Node, rayleigh: Option<Node>, force: Option<&[Node]>) -> Findings {
        let mut differentiated = |root: Node, symbol: &str| Differentiated {
            root,
            derivatives: self.derivation.hessian(&mut self.graph, root, symbol),
        };
        let lagrangian = differentiated(lagrangian, "l");
        let rayleigh = rayleigh.map(|root| differentiated(root, "r"));
        let components = force.unwrap_or_default();
        let force: Vec<_> = components.iter().copied().zip(self.rows(components)).collect();
        let terms = Terms { lagrangian: &lagrangian, rayleigh: rayleigh.as_ref(), force: &force };
        structure::findings(&self.graph, self.system, self.n, &terms)
    }

    /// Gradient and derivatives of L or R, and variations where they are asked for.
    fn function(&mut self, function: &str, symbol: &str, root: Node) -> TokenStream {
        let scalar = &self.system.scalar;
        let n = self.system.degrees.times(1);
        let [gradient, derivatives] =
            ["_gradient", "_derivatives"].map(|suffix| format_ident!("{function}{suffix}"));
        let first = self.derivation.gradient(&mut self.graph, root);
        let second = self.derivation.hessian(&mut self.graph, root, symbol);

        let outputs = [vec![root], self.covector(&first, false), self.covector(&first, true)];
        let line = self.code(&outputs.concat());
        let [value_of, d1, d2] = self.parts(&line.outputs, [Shape::Scalar, Shape::Vector, Shape::Vector]);
        let (q, v, statements) =
            (parameter("q", line.uses_coordinates), parameter("v", line.uses_velocities), &line.statements);
        let gradient = quote! {
            #[inline]
            fn #gradient(&self, #q: &Vector, #v: &Vector) -> Gradient<#scalar, #n> {
                #statements
                Gradient { value: #value_of, d1: #d1, d2: #d2 }
            }
        };

        let outputs = [
            vec![root],
            self.covector(&second.gradient, false),
            self.covector(&second.gradient, true),
            self.block(&second, false, false),
            self.block(&second, false, true),
            self.block(&second, true, true),
        ];
        let line = self.code(&outputs.concat());
        let [value_of, d1, d2, d11, d12, d22] = self.parts(
            &line.outputs,
            [Shape::Scalar, Shape::Vector, Shape::Vector, Shape::Matrix, Shape::Matrix, Shape::Matrix],
        );
        let (q, v, statements) =
            (parameter("q", line.uses_coordinates), parameter("v", line.uses_velocities), &line.statements);
        let derivatives = quote! {
            #[inline]
            fn #derivatives(&self, #q: &Vector, #v: &Vector) -> Derivatives<#scalar, #n> {
                #statements
                Derivatives { value: #value_of, d1: #d1, d2: #d2, d11: #d11, d12: #d12, d22: #d22 }
            }
        };

        let variations = (function == "lagrangian" && self.system.rules.ask_for_variations())
            .then(|| self.variations(&second));
        quote! {
            #gradient

            #derivatives

            #variations
        }
    }

    /// Derivatives of f.
    fn force(&mut self, components: &[Node]) -> TokenStream {
        let scalar = &self.system.scalar;
        let n = self.system.degrees.times(1);
        let rows = self.rows(components);
        let by = |code: &mut Self, velocity| {
            code.matrix(|code, i, j| {
                let variable = code.variable(j, velocity);
                rows[i].get(&variable).copied()
            })
        };
        let outputs = [components.to_vec(), by(self, false), by(self, true)].concat();
        let line = self.code(&outputs);
        let [value, d1, d2] = self.parts(&line.outputs, [Shape::Vector, Shape::Matrix, Shape::Matrix]);
        let (q, v, statements) =
            (parameter("q", line.uses_coordinates), parameter("v", line.uses_velocities), &line.statements);
        quote! {
            #[inline]
            fn force_derivatives(&self, #q: &Vector, #v: &Vector) -> CovectorDerivatives<#scalar, #n> {
                #statements
                CovectorDerivatives { value: #value, d1: #d1, d2: #d2 }
            }
        }
    }

    /// `force_by_input`
    fn by_input(&mut self, components: &[Node], input: &Degrees) -> TokenStream {
        let scalar = &self.system.scalar;
        let (n, m) = (self.system.degrees.times(1), input.times(1));
        let rows = self.rows(components);
        let mut outputs = Vec::new();
        for j in 0..self.m {
            let variable = self.graph.node(Operation::Input(j));
            for row in &rows {
                outputs.push(self.or_zero(row.get(&variable).copied()));
            }
        }
        let line = self.code(&outputs);
        let matrix = matrix(&line.outputs, self.n);
        let (q, v, statements) =
            (parameter("q", line.uses_coordinates), parameter("v", line.uses_velocities), &line.statements);
        quote! {
            #[inline]
            fn force_by_input(&self, #q: &Vector, #v: &Vector) -> SMatrix<#scalar, #n, #m> {
                #statements
                #matrix
            }
        }
    }

    /// The gradient of each component.
    fn rows(&mut self, components: &[Node]) -> Vec<Gradient> {
        components.iter().map(|&component| self.derivation.gradient(&mut self.graph, component)).collect()
    }

    fn variable(&mut self, index: usize, velocity: bool) -> Node {
        self.graph.node(if velocity { Operation::Velocity(index) } else { Operation::Coordinate(index) })
    }

    fn or_zero(&mut self, node: Option<Node>) -> Node {
        node.unwrap_or_else(|| self.graph.constant(0.0))
    }

    /// ∂f/∂q or ∂f/∂v, entry by entry.
    fn covector(&mut self, gradient: &Gradient, velocity: bool) -> Vec<Node> {
        (0..self.n)
            .map(|index| {
                let variable = self.variable(index, velocity);
                self.or_zero(gradient.get(&variable).copied())
            })
            .collect()
    }

    /// ∂²f by the variable `row` and the variable `column`, if it is not 0 by structure.
    fn second(&mut self, of: &Derivatives, row: (usize, bool), column: (usize, bool)) -> Option<Node> {
        let (a, b) = (self.variable(row.0, row.1), self.variable(column.0, column.1));
        of.hessian.get(&(a.min(b), a.max(b))).copied()
    }

    /// A block of the Hessian, column by column.
    fn block(&mut self, of: &Derivatives, row_velocity: bool, column_velocity: bool) -> Vec<Node> {
        self.matrix(|code, i, j| code.second(of, (i, row_velocity), (j, column_velocity)))
    }

    /// The code for `outputs` at (q, v), and at the view's own input and time.
    fn code(&mut self, outputs: &[Node]) -> StraightLine {
        self.code_taking(outputs, &[])
    }

    /// The same in a function with further parameters.
    fn code_taking(&mut self, outputs: &[Node], parameters: &[&str]) -> StraightLine {
        let mut line = self.code_at_node(outputs, parameters);
        if line.uses("t") {
            let statements = &line.statements;
            line.statements = quote!(let t = self.t; #statements);
        }
        line
    }

    /// The same, with the time left to the caller.
    fn code_at_node(&mut self, outputs: &[Node], parameters: &[&str]) -> StraightLine {
        let mut taken = vec!["q", "v", "h", "half", "q0", "q1", "minus", "plus"];
        // Without a view, u and t are free for the user's own names.
        if self.home == Home::View {
            taken.extend(["u", "t", "t_end"]);
        }
        taken.extend(parameters);
        let outputs = if self.graph.is_full() {
            vec![self.graph.constant(0.0); outputs.len()]
        } else {
            self.graph.factored(outputs, self.written)
        };
        let operations = self.graph.operations(outputs.iter().copied());
        self.longest = self.longest.max(operations);
        let outputs = if operations > MOST_OPERATIONS {
            vec![self.graph.constant(0.0); outputs.len()]
        } else {
            outputs
        };
        let mut line = straight_line(&self.graph, &self.system.scalar, &outputs, &taken, self.is_portable);
        if self.home == Home::View {
            let seen = |tokens: TokenStream| view::seen_from_view(tokens, &self.system.name);
            let statements = seen(line.statements);
            let input = line.uses_inputs.then(|| quote!(let u = self.u;));
            line.statements = quote!(#input #statements);
            line.outputs = line.outputs.into_iter().map(seen).collect();
        }
        self.calls_elementary |= line.calls_elementary;
        line
    }

    /// Splits outputs into scalars, vectors and matrices.
    fn parts<const K: usize>(&self, outputs: &[TokenStream], shapes: [Shape; K]) -> [TokenStream; K] {
        let mut rest = outputs;
        shapes.map(|shape| {
            let (own, after) = rest.split_at(match shape {
                Shape::Scalar => 1,
                Shape::Vector => self.n,
                Shape::Matrix => self.n * self.n,
            });
            rest = after;
            match shape {
                Shape::Scalar => own[0].clone(),
                Shape::Vector if are_zeros(own) => quote!(SVector::zeros()),
                Shape::Vector => quote!(SVector::from([#(#own),*])),
                Shape::Matrix => matrix(own, self.n),
            }
        })
    }
}

/// The shape of an output.
#[derive(Clone, Copy)]
enum Shape {
    Scalar,
    Vector,
    Matrix,
}

/// The matrix of these entries, column by column.
fn matrix(entries: &[TokenStream], rows: usize) -> TokenStream {
    if are_zeros(entries) {
        return quote!(SMatrix::zeros());
    }
    let columns = entries.chunks(rows).map(|column| quote!([#(#column),*]));
    quote!(SMatrix::from([#(#columns),*]))
}

/// Whether all entries are the constant 0.
fn are_zeros(entries: &[TokenStream]) -> bool {
    entries.iter().all(|entry| entry.to_string() == "0.0")
}

/// A parameter of a function, marked where the body does not use it.
fn parameter(name: &str, is_used: bool) -> Ident {
    if is_used { format_ident!("{name}") } else { format_ident!("_{name}") }
}

/// `let _ = (q0, h);` for the parameters that a body does not read.
fn unused<const K: usize>(parameters: [(bool, &str); K]) -> Option<TokenStream> {
    let unused: Vec<Ident> =
        parameters.iter().filter(|(is_used, _)| !is_used).map(|(_, name)| format_ident!("{name}")).collect();
    (!unused.is_empty()).then(|| quote!(let _ = (#(#unused),*);))
}
