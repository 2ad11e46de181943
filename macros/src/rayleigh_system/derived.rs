//! The functions of a system as data: gradients, Hessians and the kernels of steps, as outputs on one graph.
//!
//! Rust is written of it by [`write`](super::write) alone, and a tape can run it as it is.

mod cancelling;
mod constraints;
mod derivatives;
mod directions;
mod entries;
mod explicit;
mod kernel;
mod kinks;
mod length;
mod midpoint;
mod missing;
mod routine;
mod sensitivity;
mod stages;
mod trapezoidal;

use std::collections::{BTreeMap, HashMap};

use proc_macro2::{Span, TokenStream};
use quote::format_ident;
use syn::Ident;

use super::differentiate::{Derivatives, Differentiation, Gradient};
use super::graph::{Graph, MOST_OPERATIONS, Node, Operation, Taken};
use super::lower::{Length, Load, Lowered, Refusal};
use super::model::{Home, System};
use super::parts::Part;
pub use super::rules::Points;
use super::rules::Rule;
use super::structure::{self, Differentiated, Findings, Terms};
pub use kernel::{Explicit, Kernel};
pub use kinks::{Fault, Kinks};
pub use missing::Places;
pub use routine::{Kind, Of, Routine};
pub use stages::{CONDITIONAL, Stages};

/// The functions of a system whose derivatives are written out.
pub struct Derived {
    pub graph: Graph,
    pub n: usize,
    /// Entries of the input.
    pub m: usize,
    /// The structure that the expressions show.
    pub findings: Findings,
    /// Functions of the traits, but for those of steps.
    pub functions: Vec<Routine>,
    pub constraints: constraints::Findings,
    /// The kinks of R.
    pub kinks: Kinks,
    /// Operations without a derivative: of the system and of its view.
    pub places: [Vec<Places>; 2],
    /// The equations at a stage of Gauss rules, or why they are left to the runtime.
    pub stages: Option<Result<Stages, &'static str>>,
    /// The kernel of each rule of displacement, but for rules that bring their own.
    pub kernels: Vec<Option<Kernel>>,
    /// The user's functions that the bodies run.
    pub run: Vec<Ident>,
    /// Names that rustc has to agree are bindings.
    pub bindings: Vec<Ident>,
    /// The fields and constants that are taken for numbers, and those taken for truth values.
    pub of_types: [(Ident, Vec<(TokenStream, bool)>); 2],
    /// Methods taken for those of slices.
    pub of_arrays: Vec<(Ident, usize)>,
}

impl Derived {
    /// Whether there are explicit steps of several members at once.
    pub fn has_explicit_lanes(&self) -> bool {
        let mut explicit = self.kernels.iter().flatten().filter_map(|kernel| kernel.explicit.as_ref());
        explicit.any(|explicit| explicit.in_lanes.is_some())
    }

    /// Whether there are midpoint steps of several members at once.
    pub fn has_midpoint_lanes(&self) -> bool {
        self.kernels.iter().flatten().any(|kernel| kernel.in_lanes.is_some())
    }
}

/// The derivatives of what was lowered, unless they are too long to be written out.
pub fn functions(system: &System<'_>, lowered: Lowered) -> Result<Derived, Refusal> {
    let Lowered {
        graph,
        n,
        m,
        lagrangian,
        rayleigh,
        force,
        time_scale,
        constraints,
        functions: run,
        of_arrays,
        bindings,
        heaviest,
        methods,
    } = lowered;
    let written = graph.len();
    let components = force.iter().chain(&constraints).flatten().copied();
    let roots: Vec<_> =
        [lagrangian].into_iter().chain(rayleigh).chain(components).chain(time_scale).collect();
    let of_types = [(system.scalar.clone(), Taken::Number), (format_ident!("bool"), Taken::Truth)]
        .map(|(ty, taken)| (ty, graph.taken_for(taken, roots.iter().copied())));
    let (derivation, force) = (Differentiation::default(), force.as_deref());
    let mut deriving =
        Deriving { system, graph, written, n, m, lagrangian, rayleigh, force, derivation, heaviest, methods };
    let mut functions = deriving.function(Part::Lagrangian, "l", lagrangian)?;
    if let Some(root) = rayleigh {
        functions.extend(deriving.function(Part::Rayleigh, "r", root)?);
    }
    functions.extend(force.map(|components| deriving.force(components)).transpose()?);
    functions.extend(time_scale.map(|root| deriving.time_scale(root)).transpose()?);
    let held = system.is_constrained().then(|| deriving.constraints(&constraints)).transpose()?;
    let (of_constraints, held) = held.unwrap_or_default();
    functions.extend(of_constraints);
    let driven = force.filter(|_| system.input.is_some());
    functions.extend(driven.map(|components| deriving.by_input(components)).transpose()?);
    let kinks = deriving.find_kinks();
    let are_apart = kinks.components() > 0 && system.rules.proximal.is_some();
    functions.extend(deriving.all_by_parameters(if are_apart { kinks.smooth } else { rayleigh })?);
    functions.extend(deriving.all_along()?);
    if are_apart {
        functions.extend(deriving.kinks(&kinks)?);
    }
    let findings = deriving.findings(&kinks);
    let stages = system.rules.gauss.then(|| deriving.stages()).transpose()?;
    let mut kernels = Vec::new();
    for newton in &findings.newton {
        // Rules that take L and R together bring their own kernel.
        let is_own = newton.rule.joint().is_none();
        kernels.push(is_own.then(|| deriving.kernel(newton, &kinks)).transpose()?);
    }
    deriving.complete()?;
    if system.rules.ask_for_cancelling_terms() {
        functions.extend(deriving.cancelling_terms());
    }
    functions.extend(deriving.constraint_rounding(&constraints));
    let places = deriving.places(&constraints);
    let graph = deriving.graph;
    Ok(Derived {
        graph,
        n,
        m,
        findings,
        functions,
        constraints: held,
        kinks,
        places,
        stages,
        kernels,
        run,
        bindings,
        of_types,
        of_arrays,
    })
}

/// A function, or the refusal of what is too long.
type Made<T> = Result<T, Refusal>;

/// A system while its functions are made.
struct Deriving<'s> {
    system: &'s System<'s>,
    graph: Graph,
    /// How many expressions the user wrote.
    written: usize,
    n: usize,
    /// Entries of the input.
    m: usize,
    lagrangian: Node,
    rayleigh: Option<Node>,
    force: Option<&'s [Node]>,
    derivation: Differentiation,
    /// The loop that writes most, if there is any.
    heaviest: Option<Load>,
    /// The names of the methods that gave numbers, those of R first.
    methods: HashMap<Node, Span>,
}

impl Deriving<'_> {
    /// Finds the system's structure in its expressions.
    fn findings(&mut self, kinks: &Kinks) -> Findings {
        let mut differentiated = |root: Node, symbol: &str| Differentiated {
            root,
            derivatives: self.derivation.hessian(&mut self.graph, root, symbol),
        };
        let lagrangian = differentiated(self.lagrangian, "l");
        let rayleigh = self.rayleigh.map(|root| differentiated(root, "r"));
        let smooth = kinks.smooth.map(|root| differentiated(root, "r"));
        let components = self.force.unwrap_or_default();
        let force: Vec<_> = components.iter().copied().zip(self.rows(components)).collect();
        let (rayleigh, smooth) = (rayleigh.as_ref(), smooth.as_ref());
        let kinks = kinks.sizes().len();
        let terms = Terms { lagrangian: &lagrangian, rayleigh, smooth, kinks, force: &force };
        structure::findings(&self.graph, self.system, self.n, &terms)
    }
}
