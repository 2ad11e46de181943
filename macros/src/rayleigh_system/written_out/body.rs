//! Bodies of functions: the code for their results, and the results in vectors and matrices.

use super::*;

impl Code<'_> {
    /// The code for `outputs` at (q, v), and at the view's own input and time, in a function of `home`.
    pub(super) fn code(&mut self, home: Home, outputs: &[Node]) -> Written<StraightLine> {
        self.code_taking(home, outputs, &[])
    }

    /// [`code`](Self::code) for a function with further parameters.
    pub(super) fn code_taking(
        &mut self,
        home: Home,
        outputs: &[Node],
        parameters: &[&str],
    ) -> Written<StraightLine> {
        let outputs = self.shortened(outputs)?;
        let mut line = self.code_as_it_stands(home, &outputs, parameters);
        if line.uses("t") {
            let statements = &line.statements;
            line.statements = quote!(let t = self.t; #statements);
        }
        Ok(line)
    }

    /// [`code_taking`](Self::code_taking) for outputs that are shortened already, without `let t = self.t`.
    pub(super) fn code_as_it_stands(
        &mut self,
        home: Home,
        outputs: &[Node],
        parameters: &[&str],
    ) -> StraightLine {
        let mut taken = vec!["q", "v", "h", "half", "q0", "q1", "minus", "plus"];
        // Without a view, u and t are free for the user's own names.
        if home == Home::View {
            taken.extend(["u", "t", "t_end"]);
        }
        taken.extend(parameters);
        let line = self.writing(&taken).numbers(outputs);
        self.calls_elementary |= line.calls_elementary;
        self.seen(home, line)
    }

    /// The graph to be written beside the names `taken`.
    pub(super) fn writing<'t>(&'t self, taken: &'t [&'t str]) -> Writing<'t> {
        Writing { graph: &self.graph, scalar: &self.system.scalar, taken, is_portable: self.is_portable }
    }

    /// The line as it stands in a function of `home`.
    pub(super) fn seen(&self, home: Home, mut line: StraightLine) -> StraightLine {
        if home == Home::View {
            let seen = |tokens: TokenStream| view::seen_from_view(tokens, &self.system.name);
            let statements = seen(line.statements);
            let input = line.uses_inputs.then(|| quote!(let u = self.u;));
            line.statements = quote!(#input #statements);
            line.outputs = line.outputs.into_iter().map(seen).collect();
        }
        line
    }

    /// Rewrites `outputs` in few operations, unless they are too long to be written.
    pub(super) fn shortened(&mut self, outputs: &[Node]) -> Written<Vec<Node>> {
        let shortened = self.rounded(outputs)?;
        match self.graph.operations(shortened.iter().copied()) {
            operations if operations > MOST_OPERATIONS => Err(self.too_long(Length::Function(operations))),
            _ => Ok(shortened),
        }
    }

    /// Rewrites `outputs` in fewer operations, rounded as the attribute says.
    pub(super) fn rounded(&mut self, outputs: &[Node]) -> Written<Vec<Node>> {
        self.complete()?;
        let factored = self.graph.factored(outputs, self.written);
        let rounded =
            if self.system.fused.is_some() { self.graph.fused(&factored, self.written) } else { factored };
        self.complete()?;
        Ok(rounded)
    }

    /// Refuses a graph that had no room for all expressions: those in it are not the system's then.
    pub(super) fn complete(&self) -> Written<()> {
        if self.graph.is_full() { Err(self.too_long(Length::Unknown)) } else { Ok(()) }
    }

    /// The refusal of what is too long, at the loop that writes most of it.
    fn too_long(&self, length: Length) -> Refusal {
        match &self.heaviest {
            Some(heaviest) => heaviest.refusal(length),
            None => length.of(self.system.source.name()),
        }
    }

    /// Splits outputs into scalars, vectors and matrices.
    pub(super) fn parts<const K: usize>(
        &self,
        outputs: &[TokenStream],
        shapes: [Shape; K],
    ) -> [TokenStream; K] {
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
pub(super) enum Shape {
    Scalar,
    Vector,
    Matrix,
}

/// The matrix of these entries, column by column.
pub(super) fn matrix(entries: &[TokenStream], rows: usize) -> TokenStream {
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
pub(super) fn parameter(name: &str, is_used: bool) -> Ident {
    if is_used { format_ident!("{name}") } else { format_ident!("_{name}") }
}

/// `let (q0, h) = (&segment.q0, segment.h);` for what a body reads of its segment.
pub(super) fn of_segment(parameters: [(bool, &str); 3]) -> Option<TokenStream> {
    let used = parameters.iter().filter(|(is_used, _)| *is_used);
    let (names, values): (Vec<Ident>, Vec<TokenStream>) = used
        .map(|(_, name)| {
            let field = format_ident!("{name}");
            let value = if *name == "h" { quote!(segment.h) } else { quote!(&segment.#field) };
            (field, value)
        })
        .unzip();
    Some(match (&names[..], &values[..]) {
        ([], _) => quote!(let _ = segment;),
        ([name], [value]) => quote!(let #name = #value;),
        _ => quote!(let (#(#names),*) = (#(#values),*);),
    })
}

/// `let _ = (q0, h);` for the parameters that a body does not read.
pub(super) fn unused(parameters: [(bool, &str); 3]) -> Option<TokenStream> {
    let unused: Vec<Ident> =
        parameters.iter().filter(|(is_used, _)| !is_used).map(|(_, name)| format_ident!("{name}")).collect();
    (!unused.is_empty()).then(|| quote!(let _ = (#(#unused),*);))
}
