//! Several members at once: the text of a system's functions on other numbers, so that what every member gets
//! is its own to the last bit.
//!
//! Values made of fields alone are computed for each system by itself, before the run and by the functions of
//! numbers, as they are where one system runs alone. Fields that are curves stay where they are: the systems
//! are at hand where a function takes a value of one.

mod explicit;
mod midpoint;
mod stages;

use quote::ToTokens;

use super::super::super::emit::{Field, number_of_members};
use super::super::super::syntax::with_words;
use super::*;
use stages::StageLines;

/// Numbers and truth values of members, and the members, in one value that functions hand on:
/// `([Members<f64, W>; 3], [Mask<W>; 1], [&'s Self; W])`, without what is not needed.
struct OfMembers<'t> {
    text: &'t Text<'t>,
    /// W.
    members: Ident,
    numbers: Vec<Node>,
    truths: Vec<Node>,
    /// Whether the systems are in it.
    has_systems: bool,
}

impl<'t> OfMembers<'t> {
    fn new<'f>(text: &'t Text<'t>, fields: impl IntoIterator<Item = &'f Field>, has_systems: bool) -> Self {
        let fields = fields.into_iter().map(|field| (field.node, field.is_truth));
        let mut all: Vec<(Node, bool)> = fields.collect();
        all.sort_unstable();
        all.dedup();
        let of =
            |truths: bool| all.iter().filter(move |(_, is_truth)| *is_truth == truths).map(|(node, _)| *node);
        Self {
            text,
            members: number_of_members(&text.derived.graph),
            numbers: of(false).collect(),
            truths: of(true).collect(),
            has_systems,
        }
    }

    fn is_empty(&self) -> bool {
        self.numbers.is_empty() && self.truths.is_empty() && !self.has_systems
    }

    fn groups(&self) -> impl Iterator<Item = (&[Node], &'static str)> {
        [(&self.numbers[..], "Members"), (&self.truths[..], "Mask")]
            .into_iter()
            .filter(|(nodes, _)| !nodes.is_empty())
    }

    /// The type, with the number of members as parameter.
    fn ty(&self) -> TokenStream {
        let (scalar, members) = (&self.text.system.scalar, &self.members);
        let of_nodes = self.groups().map(|(nodes, name)| {
            let (length, ty) = (Literal::usize_unsuffixed(nodes.len()), self.text.name(name));
            let scalar = (name == "Members").then(|| quote!(#scalar,));
            quote!([#ty<#scalar #members>; #length])
        });
        tuple(of_nodes.chain(self.has_systems.then(|| quote!([&'s Self; #members]))))
    }

    /// The type of vectors of members.
    fn vector(&self, length: &impl ToTokens) -> TokenStream {
        let (name, scalar, members) =
            (self.text.name("MemberVector"), &self.text.system.scalar, &self.members);
        quote!(#name<#scalar, #length, #members>)
    }

    /// The value made of one for each node, and of the systems.
    fn value(&self, of: impl Fn(Node) -> TokenStream, systems: TokenStream) -> TokenStream {
        let of_nodes = self.groups().map(|(nodes, _)| {
            let values = nodes.iter().map(|&node| of(node));
            quote!([#(#values),*])
        });
        tuple(of_nodes.chain(self.has_systems.then_some(systems)))
    }

    /// `let [k, _] = *kept;`, the names being those of the line; nothing where it uses none.
    fn taken_apart(&self, name: &str, line: &StraightLine) -> Option<TokenStream> {
        let name = format_ident!("{name}");
        self.pattern(line).map(|pattern| quote!(let #pattern = *#name;))
    }

    /// `let ([k, _], t) = *fields;`, with the present time by the name `time`, where the system has one and
    /// the line reads it; nothing where it reads neither.
    fn read_by(&self, line: &StraightLine, is_timed: bool, time: &str) -> Option<TokenStream> {
        let (pattern, reads_time) = (self.pattern(line), line.uses("t"));
        (pattern.is_some() || reads_time).then(|| {
            let known = pattern.unwrap_or_else(|| quote!(_));
            let time = if reads_time { format_ident!("{time}") } else { format_ident!("_") };
            if is_timed { quote!(let (#known, #time) = *fields;) } else { quote!(let #known = *fields;) }
        })
    }

    /// The names of the line, in the places of their values; nothing where it uses none.
    fn pattern(&self, line: &StraightLine) -> Option<TokenStream> {
        let own = |node: Node| line.fields.iter().find(|field| field.node == node);
        let is_used = [&self.numbers, &self.truths].into_iter().flatten().any(|&node| own(node).is_some());
        let systems = if line.reads_systems { quote!(systems) } else { quote!(_) };
        let name = |node| own(node).map_or_else(|| quote!(_), |own| own.name.to_token_stream());
        (is_used || line.reads_systems).then(|| self.value(name, systems))
    }
}

impl Text<'_> {
    /// The functions of several members at once, as far as they are asked for; the fields that any of them
    /// reads are gathered once.
    pub(super) fn lane_functions(&self) -> Option<LaneFunctions> {
        let kernels = || self.derived.kernels.iter().flatten();
        let lines = |functions: &[Routine; 2]| functions.each_ref().map(|function| self.line(function));
        let explicit = kernels().find_map(|kernel| kernel.explicit.as_ref()?.in_lanes.as_ref()).map(lines);
        let midpoint =
            kernels().find_map(|kernel| Some((lines(kernel.in_lanes.as_ref()?), kernel.diagonals)));
        let stages = match &self.derived.stages {
            Some(Ok(stages)) => stages.in_lanes.as_ref(),
            _ => None,
        };
        let stages = stages.map(|functions| StageLines::new(lines(functions), self.handed_over(functions)));
        let kernel_lines = || explicit.iter().chain(midpoint.iter().map(|(lines, _)| lines)).flatten();
        let of_kernels = kernel_lines().flat_map(|line| &line.fields);
        let reads_systems = kernel_lines().any(|line| line.reads_systems)
            || stages.as_ref().is_some_and(StageLines::reads_systems);
        let of_stages = stages.iter().flat_map(StageLines::fields);
        let fields = OfMembers::new(self, of_kernels.chain(of_stages), reads_systems);
        let is_any = explicit.is_some() || midpoint.is_some() || stages.is_some();
        is_any.then(|| LaneFunctions {
            gathered: self.gathered(&fields),
            explicit: explicit.map(|lines| self.explicit_in_lanes(&lines, &fields)),
            midpoint: midpoint.map(|(lines, diagonals)| self.midpoint_in_lanes(&lines, &fields, diagonals)),
            stages: stages.map(|lines| self.stages_in_lanes(&lines, &fields)),
        })
    }

    /// `type Fields` and the function that fills it; where there is a time, with the present one beside what
    /// is known, and the function that moves it.
    fn gathered(&self, fields: &OfMembers<'_>) -> TokenStream {
        let (ty, members) = (fields.ty(), &fields.members);
        let (scalar, is_timed) = (&self.system.scalar, self.system.is_timed());
        let home = self.system.home();
        let of_view = if home == Home::View { OF_VIEW } else { &[] };
        let taken = [&["systems", "system"], of_view].concat();
        let of_each = |(nodes, group): (&[Node], &'static str)| {
            let line = self.seen(home, self.writing(&taken).numbers(nodes), None);
            let group = self.name(group);
            let outputs = line.outputs.into_iter().map(seen_from_member);
            let statements = seen_from_member(line.statements);
            let outputs = quote!([#(#outputs),*]);
            let outputs = if statements.is_empty() { outputs } else { quote!({ #statements #outputs }) };
            quote!(#group::of_each(systems.map(|system| #outputs)))
        };
        let systems = fields.has_systems.then(|| quote!(systems));
        let values = tuple(fields.groups().map(of_each).chain(systems));
        let systems = parameter("systems", is_timed || !fields.is_empty());
        if is_timed {
            let of = self.name("Members");
            return quote! {
                type Fields<'s, const #members: usize> = (#ty, #of<#scalar, #members>) where Self: 's;

                fn fields<const #members: usize>(#systems: [&Self; #members]) -> Self::Fields<'_, #members> {
                    (#values, #of(systems.map(|system| system.t)))
                }

                #[inline(always)]
                fn later_in_lanes<'s, const #members: usize>(
                    fields: &Self::Fields<'s, #members>,
                    elapsed: &#of<#scalar, #members>,
                ) -> Self::Fields<'s, #members>
                where
                    Self: 's,
                {
                    let (known, t) = *fields;
                    (known, t + *elapsed)
                }
            };
        }
        quote! {
            type Fields<'s, const #members: usize> = #ty where Self: 's;

            fn fields<const #members: usize>(#systems: [&Self; #members]) -> Self::Fields<'_, #members> {
                #values
            }
        }
    }
}

/// The tokens with `system` for `self`.
pub(super) fn seen_from_member(tokens: TokenStream) -> TokenStream {
    with_words(tokens, &|word| {
        (word == "self").then(|| Ident::new("system", word.span()).into_token_stream())
    })
}
