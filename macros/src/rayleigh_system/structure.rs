//! The structure of a system as its expressions show it, as data and as documentation.
//!
//! Two passes over the graph: polynomial degrees and separation, from the operations as written, and the
//! patterns of the derivatives. Both are conservative: what is found holds for every q, v and field; what
//! cancels only algebraically, such as q − q, is not found. A second derivative that is absent does not make
//! a function quadratic: |v| has none.

mod degree;
mod sentences;

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

pub use degree::Degrees;

use super::differentiate::{Derivatives, Gradient};
use super::graph::{Graph, Node, Operation};
use super::lower::Refusal;
use super::model::System;
use super::parts::Part;
use super::rules::{Pairs, Points, Rule};

/// The engine that makes the derivatives, and why.
pub enum Engine {
    Expanded,
    /// `None` where the attribute asks for num-dual.
    NumDual(Option<Refusal>),
}

/// The statement about a system: its engine, and its structure.
pub struct Structure {
    pub engine: Engine,
    /// `None` where the derivatives are not written out: then the expressions were not looked at.
    pub findings: Option<Findings>,
}

/// The structure that the expressions show.
pub struct Findings {
    /// Degrees of freedom.
    pub n: usize,
    pub constant_mass_matrix: bool,
    pub quadratic_lagrangian: bool,
    pub separable_lagrangian: bool,
    /// Products are rounded with the sums that they stand in.
    pub fused: bool,
    /// ∂L/∂v holds the time.
    pub timed_momenta: bool,
    pub damping: Damping,
    /// How many kinks R has in v.
    pub kinks: usize,
    pub cyclic: Vec<Cyclic>,
    pub newton: Vec<Newton>,
}

/// The kind of force that R makes.
#[derive(Clone, Copy, Debug)]
pub enum Damping {
    /// R takes the time.
    Unknown,
    Absent,
    Linear,
    LinearByConfiguration,
    Nonlinear,
}

/// A coordinate that L does not contain.
#[derive(Clone, Copy)]
pub struct Cyclic {
    pub index: usize,
    /// R contains the coordinate or its velocity.
    pub damped: bool,
    /// The component of f is not 0.
    pub forced: bool,
}

/// The Newton matrix of a rule.
#[derive(Clone, Copy)]
pub struct Newton {
    pub rule: Rule,
    /// p0 is affine in v̄, and the matrix has neither q nor v in it.
    pub constant: bool,
    /// Largest |i − j| of an entry.
    pub bandwidth: usize,
    /// Constant by the trapezoidal rule, and no derivative holds both v and q or the time: a step needs the
    /// force at one point and time.
    pub is_explicit: bool,
}

/// A function with its derivatives.
pub struct Differentiated {
    pub root: Node,
    pub derivatives: Derivatives,
}

/// L, R and f with their derivatives.
pub struct Terms<'t> {
    pub lagrangian: &'t Differentiated,
    pub rayleigh: Option<&'t Differentiated>,
    /// R without its kinks, and how many they are.
    pub smooth: Option<&'t Differentiated>,
    pub kinks: usize,
    /// The components and the gradient of each.
    pub force: &'t [(Node, Gradient)],
}

/// Finds the structure of the terms, and of the Newton matrix of each rule.
pub fn findings(graph: &Graph, system: &System<'_>, n: usize, terms: &Terms<'_>) -> Findings {
    let degrees = Degrees::of(graph);
    let Terms { lagrangian, rayleigh, smooth, force, .. } = terms;
    let damping = match rayleigh {
        None => Damping::Absent,
        Some(_) if system.takes_time(Part::Rayleigh) => Damping::Unknown,
        Some(r) if degrees.in_velocity(r.root) > 2 => Damping::Nonlinear,
        Some(r) if contains(graph, r.root, |operation| matches!(operation, Operation::Coordinate(_))) => {
            Damping::LinearByConfiguration
        }
        Some(_) => Damping::Linear,
    };
    let of_pairs = |of: &Derivatives, meant: Pairs| -> Vec<(usize, usize, Node)> {
        let pairs = of.hessian.iter().filter_map(|(&(a, b), &entry)| {
            let ((i, a), (j, b)) = (variable(graph, a)?, variable(graph, b)?);
            meant.hold(a, b).then_some((i, j, entry))
        });
        pairs.collect()
    };
    // In time as well; an input counts as what changes.
    let is_constant = |entries: &[(usize, usize, Node)]| {
        entries.iter().all(|&(.., entry)| {
            !graph.depends(entry) && !contains(graph, entry, |operation| graph.is_time(operation))
        })
    };
    let mass = of_pairs(&lagrangian.derivatives, Pairs::Velocities);
    let timed_momenta = lagrangian.derivatives.gradient.iter().any(|(&by, &entry)| {
        let is_velocity = matches!(graph.operation(by), Operation::Velocity(_));
        is_velocity && contains(graph, entry, |operation| graph.is_time(operation))
    });

    let cyclic = (0..n).filter_map(|index| {
        let is_own = |operation: Operation| operation == Operation::Coordinate(index);
        let acts = |operation: Operation| is_own(operation) || operation == Operation::Velocity(index);
        (!contains(graph, lagrangian.root, is_own)).then(|| Cyclic {
            index,
            damped: rayleigh.is_some_and(|r| contains(graph, r.root, acts)),
            forced: force.get(index).is_some_and(|&(f, _)| graph.constant_value(f) != Some(0.0)),
        })
    });

    let newton = system.rules.of_displacement.iter().map(|&rule| {
        let pairs = rule.entry().matrix;
        let rayleigh = if rule == Rule::Proximal { smooth } else { rayleigh };
        let mut entries = of_pairs(&lagrangian.derivatives, pairs);
        if let Some(r) = rayleigh {
            entries.extend(of_pairs(&r.derivatives, pairs));
        }
        for (i, (_, row)) in force.iter().enumerate() {
            entries.extend(row.iter().filter_map(|(&by, &entry)| {
                let (j, is_velocity) = variable(graph, by)?;
                pairs.hold(is_velocity, false).then_some((i, j, entry))
            }));
        }
        // p0 holds ∂L/∂v at both ends, and ∂L/∂q and f where the trapezoidal rule sees q0 alone.
        let is_affine = |entry: Node, by_velocity: bool| match rule.entry().points {
            Points::Ends if !by_velocity => degrees.in_velocity(entry) <= 1,
            _ => degrees.joint(entry) <= 1,
        };
        let gradients = [Some(*lagrangian), *rayleigh].into_iter().flatten();
        let momenta = gradients.flat_map(|of| &of.derivatives.gradient).filter_map(|(&by, &entry)| {
            let (_, by_velocity) = variable(graph, by)?;
            Some((entry, by_velocity))
        });
        let constant = is_constant(&entries)
            && momenta.clone().all(|(entry, by_velocity)| is_affine(entry, by_velocity))
            && force.iter().all(|&(component, _)| is_affine(component, false));
        let bandwidth = entries.iter().map(|&(i, j, _)| i.abs_diff(j)).max().unwrap_or(0);
        // A function of M⁻¹C is full, unless both are diagonal.
        let is_fitted = rule.joint().is_some_and(|joint| joint.is_fitted);
        let bandwidth = if is_fitted && bandwidth > 0 { n - 1 } else { bandwidth };
        // The force at a point has nothing but q, the input, the time and fields in it, what v adds to the
        // momenta nothing but v and fields.
        let is_apart = |entry: Node, by_velocity: bool| {
            !contains(graph, entry, |operation| match operation {
                Operation::Coordinate(_) => by_velocity,
                Operation::Velocity(_) => !by_velocity,
                time if graph.is_time(time) => by_velocity,
                Operation::Input(_) | Operation::Parameter(_) | Operation::Constant(_) => false,
                other => other.arguments().next().is_none(),
            })
        };
        let is_explicit = constant
            && rule.may_be_explicit()
            && momenta.clone().all(|(entry, by_velocity)| is_apart(entry, by_velocity))
            && rayleigh.is_none_or(|r| !contains(graph, r.root, |o| matches!(o, Operation::Coordinate(_))))
            && force.iter().all(|&(component, _)| is_apart(component, false));
        Newton { rule, constant, bandwidth, is_explicit }
    });

    Findings {
        n,
        constant_mass_matrix: degrees.in_velocity(lagrangian.root) <= 2 && is_constant(&mass),
        quadratic_lagrangian: degrees.joint(lagrangian.root) <= 2,
        separable_lagrangian: degrees.is_separable(lagrangian.root),
        fused: system.fused.is_some(),
        timed_momenta,
        damping,
        kinks: terms.kinks,
        cyclic: cyclic.collect(),
        newton: newton.collect(),
    }
}

/// The index of a variable, and whether it is a velocity.
fn variable(graph: &Graph, node: Node) -> Option<(usize, bool)> {
    match graph.operation(node) {
        Operation::Coordinate(index) => Some((index, false)),
        Operation::Velocity(index) => Some((index, true)),
        _ => None,
    }
}

/// Whether the expression is made of something of this kind.
fn contains(graph: &Graph, root: Node, is_meant: impl Fn(Operation) -> bool) -> bool {
    graph.reachable([root]).into_iter().any(|node| is_meant(graph.operation(node)))
}

impl Structure {
    /// `/// …` for each finding.
    pub fn documentation(&self) -> TokenStream {
        let sentences = sentences::of(self);
        let lines = sentences.iter().map(|sentence| format!(" {sentence}"));
        quote!(#(#[doc = #lines])*)
    }

    /// `const STRUCTURE: Structure = …;`
    pub fn constant(&self) -> TokenStream {
        let engine = match &self.engine {
            Engine::Expanded => quote!(Expanded),
            Engine::NumDual(None) => quote!(NumDual { refusal: ::core::option::Option::None }),
            Engine::NumDual(Some(refusal)) => {
                let (token, reason) = (&refusal.token, &refusal.reason);
                let line = Literal::usize_unsuffixed(refusal.line());
                quote!(NumDual {
                    refusal: ::core::option::Option::Some(::dalembert::generated::Refusal::new(#token, #line, #reason)),
                })
            }
        };
        let findings = self.findings.as_ref().map(|findings| {
            let found = [
                (findings.constant_mass_matrix, "with_constant_mass_matrix"),
                (findings.quadratic_lagrangian, "with_quadratic_lagrangian"),
                (findings.separable_lagrangian, "with_separable_lagrangian"),
                (findings.fused, "with_fused_multiply_add"),
            ];
            let found =
                found.iter().filter(|(is_found, _)| *is_found).map(|(_, name)| format_ident!("{name}"));
            let damping = format_ident!("{}", format!("{:?}", findings.damping));
            let kinks = (findings.kinks > 0).then(|| {
                let count = Literal::usize_unsuffixed(findings.kinks);
                quote!(.with_kinks(#count))
            });
            let cyclic = findings.cyclic.iter().map(|&Cyclic { index, damped, forced }| {
                let index = Literal::usize_unsuffixed(index);
                quote!(::dalembert::generated::CyclicCoordinate::new(#index, #damped, #forced))
            });
            let cyclic = (!findings.cyclic.is_empty()).then(|| quote!(.with_cyclic(&[#(#cyclic),*])));
            let newton = findings.newton.iter().map(|&Newton { rule, constant, bandwidth, .. }| {
                let (rule, bandwidth) = (rule.entry().name, Literal::usize_unsuffixed(bandwidth));
                quote!(::dalembert::generated::NewtonStructure::new(#rule, #constant, #bandwidth))
            });
            quote! {
                #(.#found())*
                .with_damping(::dalembert::generated::Damping::#damping)
                #kinks
                #cyclic
                .with_newton_matrices(&[#(#newton),*])
            }
        });
        quote! {
            const STRUCTURE: ::dalembert::generated::Structure =
                ::dalembert::generated::Structure::UNKNOWN.with_engine(::dalembert::generated::Engine::#engine) #findings;
        }
    }
}
