//! Whatever the tokens are, the pipeline answers with items: either the expansion or the user's item with
//! diagnostics.

use proc_macro2::{Delimiter, Group, Ident, Literal, Punct, Spacing, Span, TokenStream, TokenTree};

use crate::rayleigh_system::{Runtime, differentiable, rayleigh_system};

/// The messages of the `compile_error!` in the answer, which must be a sequence of items.
fn messages(answer: &TokenStream) -> Vec<String> {
    let file: syn::File =
        syn::parse2(answer.clone()).unwrap_or_else(|error| panic!("no items: {error}\n{answer}"));
    file.items
        .iter()
        .filter_map(|item| match item {
            syn::Item::Macro(item) => match &*item.mac.path.segments.last()?.ident.to_string() {
                "described" => None,
                name => {
                    assert_eq!(name, "compile_error");
                    Some(syn::parse2::<syn::LitStr>(item.mac.tokens.clone()).unwrap().value())
                }
            },
            _ => None,
        })
        .collect()
}

fn system(attribute: &str, item: &str) -> Vec<String> {
    messages(&rayleigh_system(Runtime::STD, attribute.parse().unwrap(), item.parse().unwrap()))
}

const SIGNATURE: &str = "(&self, q: [f64; 1], v: [f64; 1]) -> f64";

/// A system with this body.
fn body(body: &str) -> Vec<String> {
    system("", &format!("impl System {{ fn lagrangian{SIGNATURE} {{ {body} }} }}"))
}

#[test]
fn odd_but_right_systems_expand() {
    let right = [
        "impl r#struct { fn lagrangian(&self, r#in: [f64; 1], r#type: [f64; 1]) -> f64 { r#in[0] * self.r#fn * self.r#move(r#type) }
            fn r#move(&self, x: [f64; 1]) -> f64 { x[0] } }",
        "#[cfg(test)] #[allow(unused)] impl System { #![allow(clippy::all)] #[inline] #[doc = \"L\"] #[must_use] #[expect(unused)]
            fn lagrangian(&self, #[allow(unused)] q: [f64; 1], v: [f64; 1],) -> f64 { v[0] } }",
        "fn _1(q: [f64; 1], v: [f64; 1]) -> f64 { q[0] * v[0] }",
        "fn __(q: [f64; 1], v: [f64; 1]) -> f64 { q[0] * v[0] }",
        "fn r#match(q: [f64; 1], v: [f64; 1], r#type: f64) -> f64 { q[0] * v[0] * r#type }",
        "fn r#struct(_: [f64; 1], _: [f64; 1]) -> f64 { 0.0 }",
        "pub(crate) fn größe(q: [f64; 1], v: [f64; 1], ω: f64) -> f64 { ω * q[0] * v[0] }",
        "fn ALL_CAPITALS(q: [f64; 0x1_usize], v: [f64; 0x1_usize]) -> f64 { q[0] * v[0] }",
        "fn braces(q: [f64; { 1 + 1 }], v: [f64; { 1 + 1 }]) -> f64 { q[0] * v[1] }",
        "fn group(q: [(f64); 1], v: [f64; 1]) -> (f64) { q[0] * v[0] }",
        // At the start of a block these would be statements.
        "fn f(q: [f64; if true { 1 } else { 2 } + 1], v: [f64; if true { 1 } else { 2 } + 1]) -> f64 { q[0] * v[1] }",
        "fn f(q: [f64; { 1 } << 1], v: [f64; { 1 } << 1]) -> f64 { q[0] * v[1] }",
        // Lengths that rustc refuses.
        "fn f(q: [f64; 1u8], v: [f64; 1u8]) -> f64 { 0.0 }",
        "fn f(q: [f64; 99999999999999999999999999], v: [f64; 99999999999999999999999999]) -> f64 { 0.0 }",
        // Empty and wrong bodies are for rustc, which has the types.
        "impl System { fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {} }",
        "impl System { fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 { return } }",
        // Recursion, and helpers that call each other.
        "impl System { fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 { self.a(q[0]) }
            fn a(&self, x: f64) -> f64 { self.b(x) } fn b(&self, x: f64) -> f64 { self.a(x) + self.lagrangian([x], [x]) } }",
    ];
    for item in right {
        assert_eq!(system("", item), Vec::<String>::new(), "{item}");
    }
    // Twice the largest length is beyond all lengths.
    let longest = format!("fn f(q: [f64; {0}], v: [f64; {0}]) -> f64 {{ 0.0 }}", usize::MAX);
    for attribute in ["", "step_derivatives = second", "rule = gauss", "derivatives = num_dual"] {
        assert_eq!(system(attribute, &longest), Vec::<String>::new(), "{attribute}");
    }
}

#[test]
fn the_struct_is_named_after_the_function() {
    for (function, name) in [
        ("damped_oscillator", "struct DampedOscillator"),
        ("r#match", "struct Match"),
        ("_1", "struct System1"),
        ("__", "struct System"),
        ("x2y", "struct X2y"),
        ("midpoint", "struct Midpoint"),
    ] {
        let item = format!("fn {function}(q: [f64; 1], v: [f64; 1]) -> f64 {{ q[0] * v[0] }}");
        let answer = rayleigh_system(Runtime::STD, TokenStream::new(), item.parse().unwrap()).to_string();
        assert!(answer.contains(&format!("{name} ;")), "{function}: {answer}");
    }
}

#[test]
fn wrong_attributes_say_what_is_right() {
    let item = format!("impl System {{ fn lagrangian{SIGNATURE} {{ self.k * q[0] * v[0] }} }}");
    for right in [
        "",
        "rule = midpoint",
        "rule = trapezoidal,",
        "rule = [midpoint, trapezoidal]",
        "rule = [trapezoidal,]",
        "rule = gauss",
        "rule = [gauss, midpoint]",
    ] {
        assert_eq!(system(right, &item), Vec::<String>::new(), "{right}");
    }
    let unknown = "unknown option; write `rule = midpoint`, `trapezoidal` or `gauss`";
    for (attribute, expected) in [
        ("midpoint", unknown),
        ("rule", unknown),
        ("rule =", unknown),
        ("rule = 3", unknown),
        ("rule = \"midpoint\"", unknown),
        ("rule: midpoint", unknown),
        ("= midpoint", unknown),
        (",", unknown),
        ("rule = [midpoint", unknown),
        ("rules = midpoint", unknown),
        ("rule = r#midpoint", "unknown rule"),
        (
            "rule = simpson",
            "unknown rule `simpson`; the rules are `midpoint`, `trapezoidal`, `gauss`, `fitted`",
        ),
        ("rule = []", "no rule is listed"),
        ("rule = [midpoint, midpoint]", "rule `midpoint` is listed twice"),
        ("rule = [gauss, gauss]", "rule `gauss` is listed twice"),
        ("rule = midpoint, rule = midpoint", "`rule` is given twice; write one list"),
        ("rule = midpoint, rule = gauss", "`rule` is given twice; write one list"),
        ("derivatives = auto, rule = gauss, derivatives = auto", "`derivatives` is given twice; remove one"),
        ("parameters = [k], parameters = m", "`parameters` is given twice; write one list"),
        ("crate = a, crate = b", "`crate` is given twice; remove one"),
    ] {
        let Ok(tokens) = attribute.parse::<TokenStream>() else { continue };
        let answer = messages(&rayleigh_system(Runtime::STD, tokens, item.parse().unwrap()));
        assert_eq!(answer.len(), 1, "{attribute}: {answer:?}");
        assert!(answer[0].starts_with(expected), "{attribute}: {answer:?}");
    }
}

#[test]
fn odd_items_are_answered() {
    for item in [
        "",
        ";",
        "struct System;",
        "impl System {}",
        "impl Trait for System {}",
        "impl<'a> System<'a> {}",
        "impl [f64; 2] {}",
        "impl (System) {}",
        "impl System { const N: usize = 2; type T = f64; macro_rules! x {} }",
        "fn f();",
        "fn f() {}",
        "fn f(q: [f64; 1]) {}",
        "fn f(&self, q: [f64; 1], v: [f64; 1]) -> f64 {}",
        "fn f(q: [f64; 1], v: [f64; 1], ...) {}",
        "fn f(q: impl Copy, v: [f64; 1]) -> impl Copy {}",
        "fn f<T>(q: [T; 1], v: [T; 1]) -> T { q[0] }",
        "mod m {}",
        "x",
        "impl System { fn lagrangian() {} }",
        "impl System { fn lagrangian(&self) {} fn rayleigh() {} fn force() {} }",
        "impl System { fn lagrangian(self: &Self, q: [f64; 1], v: [f64; 1]) -> f64 { 0.0 } }",
        "impl System { fn lagrangian(&'a self, q: [f64; _], v: [f64; 1]) -> ! { loop {} } }",
        "fn f(q: [f64; 0], v: [f64; 0]) -> f64 { 0.0 }",
    ] {
        // What is no item for syn comes back as it is, beside the message.
        let tokens: TokenStream = item.parse().unwrap();
        for attribute in [TokenStream::new(), quote::quote!(rule = midpoint)] {
            rayleigh_system(Runtime::STD, attribute.clone(), tokens.clone());
            let answer = differentiable(Runtime::STD, attribute, tokens.clone()).to_string();
            assert!(answer.contains("compile_error"), "{item}: {answer}");
        }
    }
}

#[test]
fn bodies_of_every_kind_of_expression_are_answered() {
    for (text, mistakes) in [
        ("let x = |f64: f64| f64; x(q[0])", 0),
        ("'a: loop { break 'a q[0]; }", 0),
        ("let Some(x) = Some(q[0]) else { return v[0] }; x", 0),
        ("if let Some(x) = Some(q[0]) && x > 0.0 { x } else { v[0] }", 0),
        ("match q { [x @ ..] => x[0], }", 0),
        ("let ref x = q[0]; *x", 0),
        ("(|| { return q[0]; })()", 0),
        ("q[..][0] + q[0..=0][0] + v[{ 0 }]", 0),
        ("self.0.1[2].k + self.x.y", 0),
        ("(self).k", 0),
        ("{ self }.k", 0),
        ("<f64 as Trait>::sin(q[0])", 1),
        ("<f64>::sin(q[0])", 1),
        ("::std::f64::consts::PI * q[0]", 0),
        ("r#try(q[0])", 1),
        ("q[0] + const { 1.0 }", 0),
        ("(async || q[0])().await", 1),
        ("q[0]?", 0),
        ("yield q[0]", 0),
        ("static X: f64 = 1.0; X", 1),
        ("use std::f64::consts::*; PI", 0),
        ("use std::f64::consts::{PI as π}; π * q[0]", 0),
        ("macro_rules! m { () => {} } 0.0", 1),
        ("extern crate std; 0.0", 1),
        ("let x = m!{}; m![]; x", 2),
        ("let m!() = 1; 0.0", 1),
        ("let x: m!() = 1; 0.0", 0),
        ("let x: dyn Fn(f64) -> f64; let y: fn(f64) -> f64; let z: *const f64; 0.0", 0),
        ("self.f()()(q)", 1),
        ("self.a.b.c(q[0]).d()", 0),
        ("Self { k: q[0] }.k", 2),
        ("-(-(-1.0))", 0),
        ("1.0..2.0; ..=3.0; ..; q[0]", 0),
        ("self.k = self.k = 1.0; 0.0", 2),
        ("(self.k, self.l) = (1.0, 2.0); 0.0", 2),
        ("&raw const self.k; 0.0", 0),
        ("q[0] as T as f64 as u8 as [f64; 1]", 1),
        ("1 as f64 + 'a' as u32 as f64 + true as u8 as f64", 0),
        ("q[0] %= 2.0; q[0] % 2.0 % 3.0", 0),
    ] {
        syn::parse_str::<syn::Block>(&format!("{{ {text} }}"))
            .unwrap_or_else(|error| panic!("{text}: {error}"));
        let answer = body(text);
        assert_eq!(answer.len(), mistakes, "{text}: {answer:#?}");
    }
}

/// Tokens without sense, from a fixed linear congruential sequence.
#[test]
fn random_tokens_are_answered() {
    let words = [
        "impl",
        "fn",
        "self",
        "Self",
        "lagrangian",
        "rayleigh",
        "force",
        "q",
        "v",
        "f64",
        "f32",
        "System",
        "let",
        "mut",
        "if",
        "else",
        "for",
        "in",
        "match",
        "return",
        "as",
        "usize",
        "const",
        "use",
        "unsafe",
        "async",
        "move",
        "loop",
        "_",
        "PI",
    ];
    let mut state = 1_u64;
    let mut next = move |n: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % n
    };
    fn tokens(next: &mut impl FnMut(usize) -> usize, words: &[&str], depth: usize) -> TokenStream {
        (0..next(8))
            .map(|_| -> TokenTree {
                match next(if depth == 0 { 8 } else { 12 }) {
                    0..=3 => Ident::new(words[next(words.len())], Span::call_site()).into(),
                    4 => Literal::f64_unsuffixed(0.5).into(),
                    5 => Literal::usize_unsuffixed(next(3)).into(),
                    6 | 7 => {
                        let spacing = if next(2) == 0 { Spacing::Alone } else { Spacing::Joint };
                        Punct::new(
                            ['.', ',', ';', ':', '=', '+', '-', '*', '&', '<', '>', '|', '%', '#'][next(14)],
                            spacing,
                        )
                        .into()
                    }
                    shape => {
                        let delimiter =
                            [Delimiter::Parenthesis, Delimiter::Brace, Delimiter::Bracket, Delimiter::None]
                                [shape - 8];
                        Group::new(delimiter, tokens(next, words, depth - 1)).into()
                    }
                }
            })
            .collect()
    }
    let mut parsed = 0;
    let count = if cfg!(debug_assertions) { 3_000 } else { 20_000 };
    for _ in 0..count {
        let noise = tokens(&mut next, &words, 3);
        rayleigh_system(Runtime::STD, noise.clone(), noise.clone());
        differentiable(Runtime::STD, TokenStream::new(), noise.clone());
        // As a body, some of it is a program.
        let item =
            quote::quote!(impl System { fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 { #noise } });
        if syn::parse2::<syn::ItemImpl>(item.clone()).is_ok() {
            parsed += 1;
            messages(&rayleigh_system(Runtime::STD, TokenStream::new(), item));
        }
    }
    assert!(parsed > count / 20, "only {parsed} bodies parse: the noise tests nothing");
}
