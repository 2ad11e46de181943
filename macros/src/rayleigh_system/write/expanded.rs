//! Functions that are derived, as Rust: straight-line code on plain numbers.
//!
//! The user's item stands as it was written; nothing of it is evaluated over other numbers.

mod frame;
mod functions;
mod in_lanes;
mod matrices;
mod places;
mod stages;
mod steps;

use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};
use syn::Ident;

use super::super::derived::{self, Derived, Kind, Kinks, Of, Routine};
use super::super::emit::{StraightLine, Writing, inlined};
use super::super::graph::Node;
use super::super::model::{Home, System};
use super::super::parts::Part;
use super::super::rules::Points;
use super::super::structure::{Engine, Structure};
use super::item::{are_plain, as_written};
use super::{EngineFunctions, Friction, Kernel, LaneFunctions, Memory, notice, view};
use frame::{parameter, tuple, unused};
use in_lanes::seen_from_member;
use matrices::Shape;

/// The whole expansion: the user's item as it stands, and the system with its derivatives.
///
/// `is_portable`: the elementary functions are the runtime's, in the user's bodies too.
pub fn system(system: &System<'_>, derived: Derived, is_portable: bool) -> TokenStream {
    let item = as_written(system, &derived.run, is_portable);
    let (view, description) = (view::definition(system), view::description(system));
    let fused_by_calls = notice::fused_by_calls(system);
    let implementation = super::system(system, functions(system, derived, is_portable));
    quote! {
        #item

        #fused_by_calls

        #view

        #description

        #implementation
    }
}

/// The functions of the traits.
fn functions(system: &System<'_>, derived: Derived, is_portable: bool) -> EngineFunctions {
    let (calls_elementary, names) = (Cell::new(false), RefCell::default());
    let text = Text { system, derived: &derived, is_portable, calls_elementary, names };
    let lagrangian = text.functions_of(|of| {
        matches!(of, Of::Gradient(Part::Lagrangian) | Of::Derivatives(Part::Lagrangian) | Of::Variations)
    });
    let rayleigh =
        text.functions_of(|of| matches!(of, Of::Gradient(Part::Rayleigh) | Of::Derivatives(Part::Rayleigh)));
    let kernels = derived.kernels.iter().map(|kernel| kernel.as_ref().map(|kernel| text.kernel(kernel)));
    let kernels = kernels.collect();
    let stages = match &derived.stages {
        Some(Ok(stages)) => Some(text.stages(&stages.at_once)),
        _ => None,
    };
    let in_lanes = text.lane_functions();
    let [force, time_scale, by_input, cancelling_terms] =
        [Of::ForceDerivatives, Of::TimeScaleGradient, Of::ForceByInput, Of::CancellingTerms]
            .map(|asked| text.functions_of(|of| of == asked));
    let constraints = text.functions_of(|of| {
        matches!(
            of,
            Of::ConstraintGradients | Of::ConstraintRates | Of::ConstraintCurvature | Of::ConstraintRounding
        )
    });
    let constraints = constraints.map(|functions| (functions, derived.constraints.is_prescribed));
    let friction = text.functions_of(|of| matches!(of, Of::Slips | Of::SlipCurvature)).map(|functions| {
        let kinks @ &Kinks { is_uniform, is_proportional, .. } = &derived.kinks;
        Friction {
            sizes: kinks.sizes(),
            is_uniform,
            is_proportional,
            functions,
            by_parameters: text.functions_of(|of| of == Of::SlipsByParameters),
            smooth: text.functions_of(|of| of == Of::SmoothRayleigh),
        }
    });
    let constraints_by_parameters = text.functions_of(|of| of == Of::ConstraintsByParameters);
    let by_parameters = text.functions_of(|of| matches!(of, Of::ByParameters(_)));
    let second_order = text.functions_of(|of| matches!(of, Of::Along(_)));
    let places = [0, 1].map(|home| text.places(&derived.places[home]));
    let (names, calls_elementary) = (text.names.into_inner(), text.calls_elementary.get());
    EngineFunctions {
        structure: Structure { engine: Engine::Expanded, findings: Some(derived.findings) },
        lagrangian: lagrangian.unwrap_or_default(),
        rayleigh,
        force,
        time_scale,
        constraints,
        constraints_by_parameters,
        friction,
        by_input,
        cancelling_terms,
        places,
        stages,
        kernels,
        in_lanes,
        by_parameters,
        second_order,
        names: names.into_iter().collect(),
        calls_elementary,
        bindings: derived.bindings,
        plain: are_plain(system, derived.of_types, &derived.of_arrays),
    }
}

/// A system while its functions are written.
struct Text<'d> {
    system: &'d System<'d>,
    derived: &'d Derived,
    is_portable: bool,
    /// Whether any function written calls one of the runtime's elementary functions.
    calls_elementary: Cell<bool>,
    /// Names of the runtime that are written.
    names: RefCell<BTreeSet<&'static str>>,
}

impl Text<'_> {
    /// A name of the runtime, to be imported.
    fn name(&self, name: &'static str) -> Ident {
        self.names.borrow_mut().insert(name);
        format_ident!("{name}")
    }

    /// The code of the function, where its home is.
    fn line(&self, function: &Routine) -> StraightLine {
        let (of_view, time): (&[&str], _) = match function.kind {
            Kind::Numbers | Kind::Duals => (&["u", "t", "t_end"], None),
            Kind::Lanes { .. } => (&["u", "t", "elapsed"], Some(quote!(let t = *elapsed + self.t;))),
            Kind::NumbersAsMembers | Kind::Members { .. } => (OF_VIEW, None),
        };
        // Without a view, u and t are free for the user's own names.
        let of_view = if function.home == Home::View { of_view } else { &[] };
        let taken = [function.of.arguments(&function.kind), of_view].concat();
        let mut line = self.writing(&taken).written(&function.outputs, &function.kind);
        line.fields.sort_by_key(|field| (field.is_truth, field.node));
        let time = time.filter(|_| line.uses("t"));
        let mut line = self.seen(function.home, line, time);
        if line.reads_systems {
            // What is left of `self` there is the curves of each member.
            line.statements = seen_from_member(line.statements);
            line.outputs = line.outputs.into_iter().map(seen_from_member).collect();
        }
        line
    }

    /// [`line`](Self::line) at the view's own time.
    fn line_at_present(&self, function: &Routine) -> StraightLine {
        let mut line = self.line(function);
        let (time, statements) = (line.present(), &line.statements);
        line.statements = quote!(#time #statements);
        line
    }

    /// The graph to be written beside the names `taken`.
    fn writing<'t>(&'t self, taken: &'t [&'t str]) -> Writing<'t> {
        let (graph, scalar) = (&self.derived.graph, &self.system.scalar);
        Writing { graph, scalar, taken, is_portable: self.is_portable }
    }

    /// The line as it stands in a function of `home`.
    fn seen(&self, home: Home, mut line: StraightLine, time: Option<TokenStream>) -> StraightLine {
        self.calls_elementary.set(self.calls_elementary.get() || line.calls_elementary);
        self.names.borrow_mut().extend(&line.names);
        if home == Home::View {
            let seen = |tokens: TokenStream| view::seen_from_view(tokens, &self.system.name);
            let statements = seen(line.statements);
            let input = line.uses_inputs.then(|| quote!(let u = self.u;));
            line.statements = quote!(#input #time #statements);
            line.later = seen(line.later);
            line.outputs = line.outputs.into_iter().map(seen).collect();
        }
        line
    }
}

/// Names that functions of a view on members declare.
const OF_VIEW: &[&str] = &["u", "t", "now", "elapsed"];
