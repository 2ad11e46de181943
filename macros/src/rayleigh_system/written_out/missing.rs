//! Operations of L, R and f that have no derivative at some arguments, for the errors of steps.
//!
//! The arguments are written out, each with the condition that its operation stands under: what a rejected
//! branch holds is no cause.

use std::collections::HashMap;

use super::super::graph::{Function, PairFunction};
use super::*;

/// The most operations of functions that are looked at: no system is to be refused for the length of what an
/// error asks for.
const MOST: usize = MOST_OPERATIONS / 8;

/// The most operations that one function is asked about.
const MOST_PLACES: usize = 64;

/// An operation that has no derivative at some arguments.
struct Singular {
    /// Its name in the runtime.
    name: &'static str,
    argument: Node,
    second: Option<Node>,
    /// An argument at which it has one.
    regular: f64,
}

impl Code<'_> {
    /// `Lagrangian::place_without_derivative`, of the system and of its view if that has more functions;
    /// nothing where no operation can lack a derivative.
    pub(super) fn places(
        &mut self,
        lagrangian: Node,
        rayleigh: Option<Node>,
        force: Option<&[Node]>,
    ) -> [Option<TokenStream>; 2] {
        [Home::System, Home::View].map(|home| {
            let has = |part: Part| home == Home::View || self.system.home_of(part) == home;
            if home == Home::View && !self.system.has_view() {
                return None;
            }
            let [of_lagrangian, of_rayleigh, of_force] =
                [Part::Lagrangian, Part::Rayleigh, Part::Force].map(has);
            let mut functions = Vec::new();
            functions.extend(of_lagrangian.then(|| (quote!(Lagrangian), lagrangian)));
            functions.extend(rayleigh.filter(|_| of_rayleigh).map(|root| (quote!(Rayleigh), root)));
            for (i, &root) in force.filter(|_| of_force).unwrap_or_default().iter().enumerate() {
                let index = Literal::usize_unsuffixed(i);
                functions.push((quote!(Force { index: #index }), root));
            }
            self.places_of(home, &functions)
        })
    }

    fn places_of(&mut self, home: Home, functions: &[(TokenStream, Node)]) -> Option<TokenStream> {
        let (mut uses_coordinates, mut uses_velocities) = (false, false);
        let mut arms = Vec::new();
        for (function, root) in functions {
            let (written, outputs) = self.singular_operations(*root);
            if written.is_empty() {
                continue;
            }
            let Ok(line) = self.code(home, &outputs) else { continue };
            uses_coordinates |= line.uses_coordinates;
            uses_velocities |= line.uses_velocities;
            let mut values = line.outputs.iter();
            let places = written.iter().filter_map(|(name, text, has_second)| {
                let (name, s) = (format_ident!("{name}"), values.next()?);
                let second = if *has_second { values.next()?.clone() } else { quote!(0.0) };
                let written = quote! {
                    &::dalembert::generated::Written {
                        operation: ::dalembert::generated::Operation::#name,
                        text: #text,
                    }
                };
                Some(quote!((#written, [#s, #second])))
            });
            let statements = &line.statements;
            arms.push(quote! {
                ::dalembert::generated::Function::#function => {
                    #statements
                    ::dalembert::generated::Place::first(&[#(#places),*])
                }
            });
        }
        if arms.is_empty() {
            return None;
        }
        let (q, v) = (parameter("q", uses_coordinates), parameter("v", uses_velocities));
        Some(quote! {
            /// The first operation that has no derivative there, as √s at s = 0.
            #[cold]
            fn place_without_derivative(
                &self,
                function: ::dalembert::generated::Function,
                #q: &Vector,
                #v: &Vector,
            ) -> ::core::option::Option<::dalembert::generated::Place> {
                match function {
                    #(#arms)*
                    _ => ::core::option::Option::None,
                }
            }
        })
    }

    /// The operations that can lack a derivative, arguments first: their names, texts, and whether they have
    /// two arguments; and the arguments.
    fn singular_operations(&mut self, root: Node) -> (Vec<(&'static str, String, bool)>, Vec<Node>) {
        let (mut written, mut outputs) = (Vec::new(), Vec::new());
        if self.graph.is_full() || self.graph.operations([root]) > MOST {
            return (written, outputs);
        }
        let is_function = matches!(self.system.source, super::super::model::Source::Function(_));
        let nodes = self.graph.reachable([root]);
        let singular: Vec<_> =
            nodes.iter().filter_map(|&node| Some((node, self.singular(node)?))).take(MOST_PLACES).collect();
        if singular.is_empty() {
            return (written, outputs);
        }
        let conditions = self.conditions(root, &nodes);
        for (node, Singular { name, argument, second, regular }) in singular {
            // Nothing where only conditions hold it: those are not differentiated.
            let Some(&condition) = conditions.get(&node) else { continue };
            let argument = match condition {
                None => argument,
                Some(condition) => {
                    let regular = self.graph.constant(regular);
                    self.graph.select(condition, argument, regular)
                }
            };
            let own = [argument].into_iter().chain(second);
            if !self.graph.is_conditional(own.clone()) {
                outputs.extend(own);
                written.push((name, self.graph.spelled(node, is_function), second.is_some()));
            }
        }
        (written, outputs)
    }

    /// The operation, if it can lack a derivative by q, v or u.
    fn singular(&self, node: Node) -> Option<Singular> {
        let of = |name, argument, regular| Singular { name, argument, second: None, regular };
        let found = match self.graph.operation(node) {
            Operation::Function(function, s) => match function {
                Function::Sqrt => of("SquareRoot", s, 1.0),
                Function::Cbrt => of("CubeRoot", s, 1.0),
                Function::Ln | Function::Log2 | Function::Log10 => of("Logarithm", s, 1.0),
                Function::Ln1p => of("LogarithmOfSum", s, 1.0),
                Function::Recip => of("Division", s, 1.0),
                Function::Asin | Function::Acos => of("ArcSine", s, 0.0),
                Function::Acosh => of("AreaCosine", s, 2.0),
                Function::Atanh => of("AreaTangent", s, 0.0),
                _ => return None,
            },
            Operation::Divide(_, s) => of("Division", s, 1.0),
            Operation::Pair(PairFunction::Powf, s, y) => {
                let is_smooth = |y: f64| y >= 0.0 && y % 1.0 == 0.0;
                if self.graph.constant_value(y).is_some_and(is_smooth) {
                    return None;
                }
                Singular { second: Some(y), ..of("Power", s, 1.0) }
            }
            Operation::Pair(PairFunction::Atan2, y, x) => Singular { second: Some(x), ..of("Angle", y, 1.0) },
            Operation::Pair(PairFunction::Hypot, x, y) => {
                Singular { second: Some(y), ..of("Length", x, 1.0) }
            }
            Operation::Power(s, n) if n < 0 => of("Division", s, 1.0),
            _ => return None,
        };
        let depends = |node: Node| self.graph.depends(node);
        (depends(found.argument) || found.second.is_some_and(depends)).then_some(found)
    }

    /// The conditions that `nodes`, all that `root` is made of, stand under; nothing for those that are
    /// always computed. Absent where only conditions need them.
    fn conditions(&mut self, root: Node, nodes: &[Node]) -> HashMap<Node, Option<Node>> {
        let mut conditions: HashMap<Node, Option<Node>> = HashMap::from([(root, None)]);
        for &node in nodes.iter().rev() {
            let Some(&own) = conditions.get(&node) else { continue };
            let operation = self.graph.operation(node);
            let needed = match operation {
                Operation::Select(condition, a, b) => {
                    let otherwise = self.graph.node(Operation::Not(condition));
                    let mut under = |branch: Node| match own {
                        None => branch,
                        Some(own) => self.graph.node(Operation::And(own, branch)),
                    };
                    vec![(a, Some(under(condition))), (b, Some(under(otherwise)))]
                }
                operation if operation.is_truth() => Vec::new(),
                operation => operation.arguments().map(|argument| (argument, own)).collect(),
            };
            for (argument, condition) in needed {
                let both = match (conditions.get(&argument), condition) {
                    (None, condition) => condition,
                    (Some(Some(other)), Some(own)) if *other == own => Some(own),
                    (Some(Some(other)), Some(own)) => Some(self.graph.node(Operation::Or(*other, own))),
                    _ => None,
                };
                conditions.insert(argument, both);
            }
        }
        conditions
    }
}
