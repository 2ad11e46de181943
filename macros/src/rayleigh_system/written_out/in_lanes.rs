//! Several members at once: the text of a system's functions on other numbers, so that what every member gets
//! is its own to the last bit.
//!
//! Values made of fields alone are computed for each system by itself, before the run and by the functions of
//! numbers, as they are where one system runs alone.

mod explicit;
mod midpoint;
mod stages;

use quote::ToTokens;

use super::super::emit::{Anchored, Field, number_of_members};
use super::super::syntax::with_words;
use super::*;
use explicit::ExplicitLines;
pub(super) use explicit::TAKEN;
use midpoint::MidpointLines;
pub(super) use midpoint::TAKEN_AT_MIDPOINT;
use stages::StageLines;

/// The code on members, as long as it is not known which fields all of it reads.
#[derive(Default)]
pub(super) struct LinesInLanes {
    pub(super) explicit: Option<ExplicitLines>,
    pub(super) midpoint: Option<MidpointLines>,
    pub(super) stages: Option<StageLines>,
}

/// Numbers and truth values of members, in one value that functions hand on:
/// `([Members<f64, W>; 3], [Mask<W>; 1])`.
struct OfMembers {
    scalar: Ident,
    /// W.
    members: Ident,
    numbers: Vec<Node>,
    truths: Vec<Node>,
}

impl OfMembers {
    fn new<'f>(code: &Code<'_>, fields: impl IntoIterator<Item = &'f Field>) -> Self {
        let fields = fields.into_iter().map(|field| (field.node, field.is_truth));
        let mut all: Vec<(Node, bool)> = fields.collect();
        all.sort_unstable();
        all.dedup();
        let of =
            |truths: bool| all.iter().filter(move |(_, is_truth)| *is_truth == truths).map(|(node, _)| *node);
        Self {
            scalar: code.system.scalar.clone(),
            members: number_of_members(&code.graph),
            numbers: of(false).collect(),
            truths: of(true).collect(),
        }
    }

    fn is_empty(&self) -> bool {
        self.numbers.is_empty() && self.truths.is_empty()
    }

    fn groups(&self) -> impl Iterator<Item = (&[Node], &'static str)> {
        [(&self.numbers[..], "Members"), (&self.truths[..], "Mask")]
            .into_iter()
            .filter(|(nodes, _)| !nodes.is_empty())
    }

    /// The type, with the number of members as parameter.
    fn ty(&self) -> TokenStream {
        let (scalar, members) = (&self.scalar, &self.members);
        tuple(self.groups().map(|(nodes, ty)| {
            let length = Literal::usize_unsuffixed(nodes.len());
            if ty == "Mask" {
                quote!([Mask<#members>; #length])
            } else {
                quote!([Members<#scalar, #members>; #length])
            }
        }))
    }

    /// The value made of one for each node.
    fn value(&self, of: impl Fn(Node) -> TokenStream) -> TokenStream {
        tuple(self.groups().map(|(nodes, _)| {
            let values = nodes.iter().map(|&node| of(node));
            quote!([#(#values),*])
        }))
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
        is_used
            .then(|| self.value(|node| own(node).map_or_else(|| quote!(_), |own| own.name.to_token_stream())))
    }
}

impl Code<'_> {
    /// The code on members for `outputs`, in a function with parameters of these names.
    fn on_members(
        &mut self,
        outputs: &[Node],
        taken: &[&str],
        handed: &[Node],
        anchored: Option<Anchored<'_>>,
    ) -> StraightLine {
        let taken = self.taken_with(taken);
        let line = self.writing(&taken).members(outputs, handed, anchored);
        let mut line = self.seen(self.system.home(), line);
        line.fields.sort_by_key(|field| (field.is_truth, field.node));
        self.calls_elementary |= line.calls_elementary;
        line
    }

    /// The names of parameters, and what a view declares.
    fn taken_with<'t>(&self, taken: &[&'t str]) -> Vec<&'t str> {
        let of_view: &[&str] =
            if self.system.home() == Home::View { &["u", "t", "now", "elapsed"] } else { &[] };
        taken.iter().chain(of_view).copied().collect()
    }

    /// The code on numbers for `outputs`, which members compute too where they are stepped in lanes.
    pub(super) fn members_code(
        &mut self,
        outputs: &[Node],
        taken: &[&str],
        is_in_lanes: bool,
    ) -> StraightLine {
        if !is_in_lanes {
            return self.code_as_it_stands(self.system.home(), outputs, &[]);
        }
        let taken = self.taken_with(taken);
        let line = self.writing(&taken).numbers_as_members(outputs);
        self.calls_elementary |= line.calls_elementary;
        self.seen(self.system.home(), line)
    }

    /// The functions of several members at once, as far as they are asked for; the fields that any of them
    /// reads are gathered once.
    pub(super) fn lane_functions(&mut self) -> Option<LaneFunctions> {
        let LinesInLanes { explicit, midpoint, stages } = core::mem::take(&mut self.in_lanes);
        let lines = explicit.iter().flat_map(ExplicitLines::fields);
        let lines = lines.chain(midpoint.iter().flat_map(MidpointLines::fields));
        let fields = OfMembers::new(self, lines.chain(stages.iter().flat_map(StageLines::fields)));
        let is_any = explicit.is_some() || midpoint.is_some() || stages.is_some();
        is_any.then(|| LaneFunctions {
            gathered: self.gathered(&fields),
            explicit: explicit.map(|lines| lines.written(self, &fields)),
            midpoint: midpoint.map(|lines| lines.written(self, &fields)),
            stages: stages.map(|lines| lines.written(self, &fields)),
        })
    }

    /// `type Fields` and the function that fills it; where there is a time, with the present one beside what
    /// is known, and the function that moves it.
    fn gathered(&mut self, fields: &OfMembers) -> TokenStream {
        let (ty, members) = (fields.ty(), &fields.members);
        let (scalar, is_timed) = (self.system.scalar.clone(), self.system.timed.any());
        let mut of_each = |(nodes, group): (&[Node], &str)| {
            let line = self.writing(&self.taken_with(&["systems", "system"])).numbers(nodes);
            self.calls_elementary |= line.calls_elementary;
            let line = self.seen(self.system.home(), line);
            let group = format_ident!("{group}");
            let outputs = line.outputs.into_iter().map(seen_from_member);
            let statements = seen_from_member(line.statements);
            let outputs = quote!([#(#outputs),*]);
            let outputs = if statements.is_empty() { outputs } else { quote!({ #statements #outputs }) };
            quote!(#group::of_each(systems.map(|system| #outputs)))
        };
        let values = tuple(fields.groups().map(&mut of_each));
        let systems = parameter("systems", is_timed || !fields.is_empty());
        if is_timed {
            return quote! {
                type Fields<const #members: usize> = (#ty, Members<#scalar, #members>);

                fn fields<const #members: usize>(#systems: [&Self; #members]) -> Self::Fields<#members> {
                    (#values, Members(systems.map(|system| system.t)))
                }

                #[inline(always)]
                fn later_in_lanes<const #members: usize>(
                    fields: &Self::Fields<#members>,
                    elapsed: &Members<#scalar, #members>,
                ) -> Self::Fields<#members> {
                    let (known, t) = *fields;
                    (known, t + *elapsed)
                }
            };
        }
        quote! {
            type Fields<const #members: usize> = #ty;

            fn fields<const #members: usize>(#systems: [&Self; #members]) -> Self::Fields<#members> {
                #values
            }
        }
    }
}

/// `()`, the one, or all of them in brackets.
pub(super) fn tuple(parts: impl Iterator<Item = TokenStream>) -> TokenStream {
    let parts: Vec<TokenStream> = parts.collect();
    match &parts[..] {
        [one] => one.clone(),
        parts => quote!((#(#parts),*)),
    }
}

/// The tokens with `system` for `self`.
fn seen_from_member(tokens: TokenStream) -> TokenStream {
    with_words(tokens, &|word| {
        (word == "self").then(|| Ident::new("system", word.span()).into_token_stream())
    })
}
