//! The implementation with derivatives written out: straight-line code on plain numbers.
//!
//! The user's item stands as it was written; nothing of it is evaluated over other numbers.

mod body;
mod cancelling;
mod derivatives;
mod directions;
mod entries;
mod explicit;
mod in_lanes;
mod kernel;
mod midpoint;
mod missing;
mod sensitivity;
mod stages;
mod trapezoidal;

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use syn::Ident;

use super::differentiate::{Derivatives, Differentiation, Gradient};
use super::emit::{StraightLine, Writing, inlined};
use super::graph::{Graph, MOST_OPERATIONS, Node, Operation, Taken};
use super::lower::{Length, Load, Lowered, Refusal};
use super::model::{Degrees, Home, Part, System};
use super::rules::Points;
use super::structure::{self, Differentiated, Findings, Structure, Terms};
use super::write::item::{are_plain, as_written};
use super::write::{self, EngineFunctions, Kernel, LaneFunctions, view};
use body::{Shape, matrix, of_segment, parameter, unused};
use in_lanes::LinesInLanes;
pub use stages::CONDITIONAL;
use stages::StagesWritten;

/// The whole expansion: the user's item as it stands, and the system with its derivatives.
///
/// `is_portable`: the elementary functions are the runtime's, in the user's bodies too.
pub fn system(system: &System<'_>, written: WrittenOut, is_portable: bool) -> TokenStream {
    let item = as_written(system, &written.run, is_portable);
    let (view, description) = (view::definition(system), view::description(system));
    let implementation = write::system(system, written.functions);
    let warning = write::notice::fused_by_calls(system);
    quote! {
        #item

        #warning

        #view

        #description

        #implementation
    }
}

/// A system whose derivatives are written out.
pub struct WrittenOut {
    functions: EngineFunctions,
    /// The user's functions that the bodies run.
    run: Vec<Ident>,
    /// Why `stages` are not written, if they were to be.
    lacks_stages: Option<&'static str>,
}

impl WrittenOut {
    /// The structure that the expressions show.
    pub fn findings(&self) -> Option<&Findings> {
        self.functions.structure.findings.as_ref()
    }

    /// Whether explicit steps of several members at once are written.
    pub fn has_explicit_lanes(&self) -> bool {
        self.functions.in_lanes.as_ref().is_some_and(|of| of.explicit.is_some())
    }

    /// Whether midpoint steps of several members at once are written.
    pub fn has_midpoint_lanes(&self) -> bool {
        self.functions.in_lanes.as_ref().is_some_and(|of| of.midpoint.is_some())
    }

    /// Why Gauss steps of several members at once are not written, if they are not.
    pub fn lacks_gauss_lanes(&self) -> Option<&'static str> {
        self.lacks_stages
    }
}

/// The derivatives of what was lowered, unless they are too long to be written out.
pub fn functions(system: &System<'_>, lowered: Lowered, is_portable: bool) -> Result<WrittenOut, Refusal> {
    let Lowered {
        graph,
        n,
        m,
        lagrangian,
        rayleigh,
        force,
        time_scale,
        functions: run,
        of_arrays,
        bindings,
        heaviest,
    } = lowered;
    let written = graph.len();
    let components = force.iter().flatten().copied();
    let roots: Vec<_> =
        [lagrangian].into_iter().chain(rayleigh).chain(components).chain(time_scale).collect();
    let plain = [(system.scalar.clone(), Taken::Number), (format_ident!("bool"), Taken::Truth)]
        .map(|(ty, taken)| (ty, graph.taken_for(taken, roots.iter().copied())));
    let mut code = Code {
        system,
        graph,
        written,
        n,
        m,
        derivation: Differentiation::default(),
        heaviest,
        is_portable,
        calls_elementary: false,
        in_lanes: LinesInLanes::default(),
    };
    let force = force.as_deref();
    let of_lagrangian = code.function(Part::Lagrangian, "l", lagrangian)?;
    let of_rayleigh = rayleigh.map(|root| code.function(Part::Rayleigh, "r", root)).transpose()?;
    let of_force = force.map(|components| code.force(components)).transpose()?;
    let time_scale = time_scale.map(|root| code.time_scale(root)).transpose()?;
    let by_input = force
        .zip(system.input.as_ref())
        .map(|(components, input)| code.by_input(components, input))
        .transpose()?;
    let by_parameters = code.all_by_parameters(lagrangian, rayleigh, force)?;
    let second_order = code.all_along(lagrangian, rayleigh, force)?;
    let findings = code.findings(lagrangian, rayleigh, force);
    let StagesWritten { function: stages, lacks: lacks_stages } =
        system.rules.gauss.then(|| code.stages(lagrangian, rayleigh, force)).transpose()?.unwrap_or_default();
    let mut kernels = Vec::new();
    for newton in &findings.newton {
        // Rules that take L and R together bring their own kernel.
        let is_own = newton.rule.joint().is_none();
        kernels.push(is_own.then(|| code.kernel(newton, lagrangian, rayleigh, force)).transpose()?);
    }
    code.complete()?;
    let cancelling_terms = system
        .rules
        .ask_for_cancelling_terms()
        .then(|| code.cancelling_terms(lagrangian, rayleigh, force))
        .flatten();
    let places = code.places(lagrangian, rayleigh, force);
    let in_lanes = code.lane_functions();
    let names = names_of_lanes(stages.iter().chain(in_lanes.iter().flat_map(LaneFunctions::all)));
    let functions = EngineFunctions {
        structure: Structure { engine: structure::Engine::Expanded, findings: Some(findings) },
        lagrangian: of_lagrangian,
        rayleigh: of_rayleigh,
        force: of_force,
        time_scale,
        by_input,
        cancelling_terms,
        places,
        stages,
        kernels,
        in_lanes,
        by_parameters,
        second_order,
        names,
        calls_elementary: code.calls_elementary,
        bindings,
        plain: are_plain(system, plain, &of_arrays),
    };
    Ok(WrittenOut { functions, run, lacks_stages })
}

/// The names of the runtime that code in lanes uses.
fn names_of_lanes<'c>(code: impl Iterator<Item = &'c TokenStream>) -> Vec<&'static str> {
    let text: Vec<String> = code.map(TokenStream::to_string).collect();
    let occurs = |name: &str| {
        let mut words = text.iter().flat_map(|text| text.split(|c: char| !c.is_alphanumeric() && c != '_'));
        words.any(|word| word == name)
    };
    let names = ["LaneVector", "Lanes", "Mask", "MemberVector", "Members", "Stages"];
    names.into_iter().filter(|name| occurs(name)).collect()
}

/// Code, or the refusal of what is too long.
type Written<T> = Result<T, Refusal>;

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
    /// The loop that writes most, if there is any.
    heaviest: Option<Load>,
    is_portable: bool,
    /// Whether any function written calls one of the runtime's elementary functions.
    calls_elementary: bool,
    in_lanes: LinesInLanes,
}

impl Code<'_> {
    /// Finds the system's structure in its expressions.
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
}
