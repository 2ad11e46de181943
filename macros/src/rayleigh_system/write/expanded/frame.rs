//! The frames of bodies: parameters, and what is declared in front.

use super::*;

impl StraightLine {
    /// `let half = 0.5 * h;`, where it is read.
    pub(super) fn half(&self) -> Option<TokenStream> {
        self.uses("half").then(|| quote!(let half = 0.5 * h;))
    }

    /// `let t = self.t;`, where it is read.
    pub(super) fn present(&self) -> Option<TokenStream> {
        self.uses("t").then(|| quote!(let t = self.t;))
    }
}

impl Text<'_> {
    /// The body of a function on the segment that `of` sees at one point or at both ends.
    pub(super) fn framed(&self, of: Of, line: &StraightLine, result: TokenStream) -> TokenStream {
        match of {
            Of::StepKernel(Points::Ends) | Of::Momenta(Points::Ends) => self.at_both_ends(line, result),
            _ => self.at_midpoint(line, &quote!(self.t), of_segment, result),
        }
    }

    /// The code with h/2 and q̄ in front, as far as it reads them; `now` is the time at the start of the
    /// step.
    pub(super) fn at_midpoint(
        &self,
        line: &StraightLine,
        now: &TokenStream,
        given: fn([(bool, &str); 3]) -> Option<TokenStream>,
        result: TokenStream,
    ) -> TokenStream {
        let uses_time = line.uses("t");
        let half =
            (line.uses_coordinates || line.uses("half") || uses_time).then(|| quote!(let half = 0.5 * h;));
        let t = uses_time.then(|| quote!(let t = #now + half;));
        let q = line.uses_coordinates.then(|| {
            let index = (0..self.derived.n).map(Literal::usize_unsuffixed);
            let entries = index.map(|index| quote!(q0[#index] + half * v[#index]));
            quote!(let q = [#(#entries),*];)
        });
        let given = given([
            (q.is_some(), "q0"),
            (q.is_some() || line.uses_velocities, "v"),
            (half.is_some() || line.uses("h"), "h"),
        ]);
        let statements = &line.statements;
        quote! {
            #given
            #half
            #q
            #t
            #statements
            #result
        }
    }

    /// The code with h/2 and q1 in front, as far as it reads them.
    fn at_both_ends(&self, line: &StraightLine, result: TokenStream) -> TokenStream {
        let half = line.half();
        let q1 = line.uses("q1").then(|| {
            let index = (0..self.derived.n).map(Literal::usize_unsuffixed);
            let entries = index.map(|index| quote!(q0[#index] + h * v[#index]));
            quote!(let q1 = [#(#entries),*];)
        });
        let t = line.present();
        let t_end = line.uses("t_end").then(|| quote!(let t_end = self.t + h;));
        let given = of_segment([
            (q1.is_some() || line.uses("q0"), "q0"),
            (q1.is_some() || line.uses_velocities, "v"),
            (q1.is_some() || half.is_some() || t_end.is_some() || line.uses("h"), "h"),
        ]);
        let statements = &line.statements;
        quote! {
            #given
            #half
            #q1
            #t
            #t_end
            #statements
            #result
        }
    }
}

/// A parameter of a function, marked where the body does not use it.
pub fn parameter(name: &str, is_used: bool) -> Ident {
    if is_used { format_ident!("{name}") } else { format_ident!("_{name}") }
}

/// `let (q0, h) = (&segment.q0, segment.h);` for what a body reads of its segment.
pub fn of_segment(parameters: [(bool, &str); 3]) -> Option<TokenStream> {
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
pub fn unused(parameters: [(bool, &str); 3]) -> Option<TokenStream> {
    let unused: Vec<Ident> =
        parameters.iter().filter(|(is_used, _)| !is_used).map(|(_, name)| format_ident!("{name}")).collect();
    (!unused.is_empty()).then(|| quote!(let _ = (#(#unused),*);))
}

/// `()`, the one, or all of them in brackets.
pub fn tuple(parts: impl Iterator<Item = TokenStream>) -> TokenStream {
    let parts: Vec<TokenStream> = parts.collect();
    match &parts[..] {
        [one] => one.clone(),
        parts => quote!((#(#parts),*)),
    }
}
