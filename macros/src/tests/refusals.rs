//! `derivatives = expanded`: what cannot be written out is refused at its token; auto leaves it to num-dual.

use proc_macro2::TokenStream;
use quote::quote;

use crate::rayleigh_system::{Runtime, rayleigh_system};

/// A system of one line whose L is `body`.
fn system(body: TokenStream) -> TokenStream {
    quote! {
        impl System {
            const COUNT: usize = 2;
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 { #body }
            fn square(x: f64) -> f64 { x * x }
            fn tower(&self, x: f64) -> f64 { self.tower(x) }
        }
    }
}

fn expansion(engine: &str, body: &TokenStream) -> String {
    let engine: TokenStream = engine.parse().expect("one word");
    rayleigh_system(Runtime::STD, quote!(derivatives = #engine), system(body.clone())).to_string()
}

#[test]
fn what_cannot_be_written_out_is_an_error_that_says_why() {
    let cases = [
        (quote!(self.m.iter().sum::<f64>()), "length is not known"),
        (quote!(q.iter().zip(self.m).map(|(q, m)| q * m).sum()), "zipped with is not known"),
        (quote!(q[self.i] * v[0]), "not known at compile time"),
        (quote!(let mut x = q[0]; while x > 1.0 { x *= 0.5; } x), "numbers decide"),
        (quote!(q[0].floor()), "no derivative here"),
        (quote!(q[0] % 2.0), "no derivative"),
        (quote!(helper(q[0])), "`helper` is not known here"),
        (quote!(self.tower(q[0])), "nested too deeply"),
        (quote!(let mut s = 0.0; for x in q { if x < 0.0 { break; } s += x; } s), "numbers decide to leave"),
        (quote!(println!("{}", q[0]); q[0]), "macros hide"),
        (quote!(q[0].powi(self.n)), "use `powf`"),
    ];
    for (body, reason) in cases {
        let expanded = expansion("expanded", &body);
        assert!(expanded.contains("compile_error"), "{body} was accepted");
        assert!(expanded.contains(reason), "{body}: {expanded}");
        assert!(expanded.contains("num_dual"), "no way out is named: {expanded}");
    }
}

#[test]
fn what_can_be_written_out_does_without_dual_numbers() {
    let cases = [
        quote!(q.iter().zip(&v).map(|(q, v)| q * v).sum()),
        quote!(let mut s = 0.0; for i in 0..Self::COUNT { s += q[i] * v[Self::COUNT - 1 - i]; } s),
        quote!((0..q.len()).map(|i| Self::square(q[i])).fold(0.0, |a, b| a + b)),
        quote!(q.windows(2).map(|w| (w[1] - w[0]).powi(2)).sum::<f64>() * self.k),
        quote!(if q[0] < 0.0 { return v[0]; } let [a, b] = q; a * b),
        quote!(let m: [f64; 2] = self.m; m.iter().zip(v).map(|(m, v)| 0.5 * m * v * v).sum()),
        quote!(let mut a = [[0.0; 2]; 2]; a[1][0] = q[0]; a[1][0] *= 2.0; a[1][0] - a[0][0]),
        quote!(let square = |x: f64| x * x; square(q[0]) + i32::pow as usize as f64 * 0.0),
    ];
    for body in &cases[..7] {
        let expanded = expansion("expanded", body);
        assert!(!expanded.contains("compile_error"), "{body}: {expanded}");
        assert!(!expanded.contains("Real"), "{body} needs dual numbers");
        assert_eq!(expanded, expansion("auto", body));
    }
    assert!(expansion("expanded", &cases[7]).contains("compile_error"));
}

#[test]
fn auto_leaves_the_rest_to_num_dual() {
    let body = quote!(self.m.iter().sum::<f64>() * v[0] * v[0] + q[0]);
    let expanded = expansion("auto", &body);
    assert!(!expanded.contains("compile_error") && expanded.contains("lagrangian_over"), "{expanded}");
    // The same code, but for what the structure says of the reason.
    let code =
        |expansion: &str| expansion.split_once("fn lagrangian_gradient").map(|(_, code)| code.to_owned());
    assert!(code(&expanded).is_some());
    assert_eq!(code(&expanded), code(&expansion("num_dual", &body)));
    assert!(expanded.contains(r#"Refusal :: new ("iter" , 1 , "the method `iter`"#), "{expanded}");
    // The control: num-dual on what could be written out.
    assert!(expansion("num_dual", &quote!(q[0] * v[0])).contains("lagrangian_over"));
}

#[test]
fn an_unknown_engine_is_named() {
    let expanded = expansion("symbolic", &quote!(q[0] * v[0]));
    assert!(expanded.contains("unknown engine `symbolic`"), "{expanded}");
}
