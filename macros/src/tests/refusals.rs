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
        (quote!((self.k * q[0]).floor()), "of fields and constants alone"),
        (quote!(self.k % v[0]), "of fields and constants alone"),
        (quote!(v[0].rem_euclid(self.k)), "of fields and constants alone"),
        (quote!(self.k.div_euclid(v[0])), "of fields and constants alone"),
        (quote!(self.cam.at(q[0], v[0])), "the method `at` has no derivative here"),
        (quote!(self.grid.at(3) * q[0]), "the method `at` has no derivative here"),
        (
            quote!(match self.law {
                Law::Cam(cam) => cam.at(q[0]),
                _ => 0.0,
            }),
            "that a pattern binds",
        ),
        (quote!(if q[0] > 0.0 { self.cams[self.i].at(q[0]) } else { 0.0 }), "may panic within the condition"),
        (quote!(q[0] * 2.5_f64.floor()), "write the result"),
        (quote!(helper(q[0])), "`helper` is not known here"),
        (quote!(self.tower(q[0])), "nested too deeply"),
        (quote!(let mut s = 0.0; for x in q { if x < 0.0 { break; } s += x; } s), "numbers decide to leave"),
        (quote!(println!("{}", q[0]); q[0]), "macros hide"),
        (quote!(q[0].powi(self.n)), "use `powf`"),
        (
            quote!(let mut x = q[0]; 'a: { x = v[0]; if x > 0.0 { break 'a; } x = 1.0; } x),
            "a block with a label",
        ),
        (quote!(let mut a = q; for x in a.iter_mut().rev() { *x *= 2.0; } a[0]), "the method `iter_mut`"),
        (quote!(let a = [[[q[0]; 1000]; 1000]; 1000]; a[0][0][0]), "too many for straight-line code"),
        (
            quote!(let a: [[[f64; 1000]; 1000]; 1000] = self.a; a[0][0][0] * q[0]),
            "too many for straight-line code",
        ),
        (
            quote!(let a = [q[0]; 10000]; let b = a.map(|x| [x; 1000]); b[0][0]),
            "too many for straight-line code",
        ),
        (
            quote!(let a = [q[0]; 10000]; a.windows(5000).map(|w| w[0]).sum::<f64>()),
            "too many for straight-line code",
        ),
        (
            quote!(let mut a = (q[0], v[0]); let b = (a, a, a, a, a, a, a, a); let c = [b; 1000]; let d = [c, c, c]; d[0][0].0.0),
            "too many for straight-line code",
        ),
        (
            quote!(match self.pair {
                (1, (Some(k), _) | (_, Some(k))) if k > 0.0 => k * q[0],
                _ => v[0],
            }),
            "write an arm for each",
        ),
        (
            quote!(let mut s = q[0]; for i in i128::MAX - 1..=i128::MAX { s += i as f64; } s),
            "not known at compile time",
        ),
        (
            quote!(let mut s = q[0]; for i in 170141183460469231731687303715884105726..=170141183460469231731687303715884105727_i128 { s += i as f64; } s),
            "to the largest integer",
        ),
        (
            quote!(let mut s = q[0]; for i in -170141183460469231731687303715884105728..170141183460469231731687303715884105727_i128 { s += i as f64; } s),
            "too long for straight-line code",
        ),
    ];
    for (body, reason) in cases {
        let expanded = expansion("expanded", &body);
        assert!(expanded.contains("compile_error"), "{body} was accepted");
        assert!(expanded.contains(reason), "{body}: {expanded}");
        // The way out that is named is one.
        let is_named = expanded.contains("or leave the derivatives to `derivatives = num_dual`");
        let by_duals = expansion("num_dual", &body);
        assert_eq!(is_named, !by_duals.contains("compile_error"), "{body}: {expanded}");
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
        quote!(let mut a = q; a.swap(0, 1); for (i, x) in a.iter_mut().enumerate() { *x *= i as f64; } a[1]),
        quote!(let y = 'a: { if q[0] > 0.0 { break 'a v[0]; } q[1] }; y + q.into_iter().reduce(f64::max).unwrap()
        ),
        quote!(let mut a = [[0.0; 2]; 2]; a[1][0] = q[0]; a[1][0] *= 2.0; a[1][0] - a[0][0]),
        quote!(let square = |x: f64| x * x; square(q[0]) + i32::pow as usize as f64 * 0.0),
    ];
    for body in &cases[..9] {
        let expanded = expansion("expanded", body);
        assert!(!expanded.contains("compile_error"), "{body}: {expanded}");
        assert!(!expanded.contains("Real"), "{body} needs dual numbers");
        assert_eq!(expanded, expansion("auto", body));
    }
    assert!(expansion("expanded", &cases[9]).contains("compile_error"));
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

#[test]
fn conditions_inside_the_block_are_refused_at_their_tokens() {
    let inside = [
        quote!(
            #[cfg(any())]
            fn rayleigh(&self, v: [f64; 1]) -> f64 {
                0.0
            }
        ),
        quote!(
            #[cfg(any())]
            const K: usize = 3;
        ),
        quote!(
            fn helper(#[cfg(any())] x: f64) -> f64 {
                1.0
            }
        ),
        quote!(
            fn helper(x: f64) -> f64 {
                #[cfg(any())]
                let x = 2.0;
                x
            }
        ),
        quote!(
            fn helper(x: f64) -> f64 {
                #[cfg_attr(any(), allow(unused))]
                let x = 2.0;
                x
            }
        ),
        quote!(
            fn helper(n: u8) -> f64 {
                match n {
                    #[cfg(any())]
                    0 => 1.0,
                    _ => 2.0,
                }
            }
        ),
        quote!(
            fn helper(x: f64) -> f64 {
                [
                    #[cfg(any())]
                    1.0,
                    x,
                ][0]
            }
        ),
        quote!(
            fn helper(x: f64) -> f64 {
                Pair {
                    #[cfg(any())]
                    x: 1.0,
                    x,
                }
                .x
            }
        ),
        quote!(
            fn helper(p: Pair) -> f64 {
                let Pair {
                    #[cfg(any())]
                    x,
                    y,
                } = p;
                y
            }
        ),
        quote!(
            fn helper(x: f64) -> f64 {
                x.max(
                    #[cfg(any())]
                    1.0,
                )
            }
        ),
    ];
    let expanded = |inside: TokenStream, engine: TokenStream| {
        let block = quote! {
            impl System {
                fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 { q[0] * v[0] }
                #inside
            }
        };
        rayleigh_system(Runtime::STD, quote!(derivatives = #engine), block).to_string()
    };
    for inside in &inside {
        for engine in [quote!(auto), quote!(expanded), quote!(num_dual)] {
            assert!(expanded(inside.clone(), engine).contains("is not decided yet"), "{inside}");
        }
    }
    // The control: other attributes, and a condition on the whole item.
    let other = expanded(
        quote!(
            #[inline]
            #[allow(unused)]
            fn helper() {}
        ),
        quote!(auto),
    );
    assert!(!other.contains("compile_error"), "{other}");
    let whole = quote! {
        #[cfg(any())]
        impl System { fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 { q[0] * v[0] } }
    };
    let whole = rayleigh_system(Runtime::STD, TokenStream::new(), whole).to_string();
    assert!(!whole.contains("compile_error"), "{whole}");
}

#[test]
fn rustc_decides_what_a_name_in_a_pattern_is() {
    let cases = [
        (
            quote!(match self.law {
                None => 0.0,
                Some(k) => k,
            }),
            "matches ! (self . law , None)",
        ),
        (
            quote!(match self.n {
                FIRST => 0.0,
                _ => 1.0,
            }),
            "matches ! (self . n , FIRST)",
        ),
        (
            quote!(match 2 {
                FIRST => 0.0,
                _ => q[0],
            }),
            "matches ! (2 , FIRST)",
        ),
        (
            quote!(match self.n {
                linear if linear > 3 => 0.0,
                _ => 1.0,
            }),
            "matches ! (self . n , linear)",
        ),
        (
            quote!(match Self::COUNT {
                linear if linear > 3 => 0.0,
                _ => q[0],
            }),
            "let linear = Binding",
        ),
        (
            quote!({
                use crate::Law::Linear;
                match self.law {
                    Linear(k) => k,
                    _ => 1.0,
                }
            }),
            "crate :: Law :: Linear (k)",
        ),
    ];
    for (body, emitted) in cases {
        let expanded = expansion("expanded", &quote!(q[0] * #body));
        assert!(expanded.contains(emitted) && !expanded.contains("compile_error"), "{body}: {expanded}");
    }
    // Nothing decides on numbers.
    for arms in [quote!(FIRST => 0.0, _ => 1.0), quote!(1.0 => 0.0, _ => 1.0)] {
        assert!(expansion("expanded", &quote!(match q[0] { #arms })).contains("compile_error"), "{arms}");
    }
}

#[test]
fn methods_that_numbers_do_not_have_are_named_without_dual_numbers() {
    for engine in ["auto", "expanded"] {
        let expanded = expansion(engine, &quote!(q[0].square() * v[0]));
        assert!(expanded.contains("`square` is no method of floating-point numbers"), "{expanded}");
        assert!(!expanded.contains("num_dual"), "{expanded}");
    }
    // The control: one that dual numbers have.
    assert!(!expansion("auto", &quote!(q[0].midpoint(v[0]))).contains("compile_error"));
}

#[test]
fn a_renamed_dependency_is_named_throughout() {
    let body = quote!(let mut x = q[0]; for i in 0..self.n { x *= v[0] } x);
    for (engine, body) in [(quote!(expanded), quote!(q[0].sin() * v[0])), (quote!(auto), body)] {
        let attribute = quote!(rule = [midpoint, gauss], derivatives = #engine, crate = mechanics);
        let expanded = rayleigh_system(Runtime::STD, attribute, system(body.clone())).to_string();
        assert!(expanded.contains("mechanics :: ") && !expanded.contains("compile_error"), "{expanded}");
        assert!(!expanded.contains("dalembert"), "{expanded}");
        // The control.
        let attribute = quote!(rule = [midpoint, gauss], derivatives = #engine);
        let expanded = rayleigh_system(Runtime::STD, attribute, system(body)).to_string();
        assert!(expanded.contains(":: dalembert ::"), "{expanded}");
    }
}

#[test]
fn a_system_named_like_the_number_of_lanes_keeps_its_name() {
    let block = |name: TokenStream| quote!(impl #name { fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 { v[0] * v[0] - self.k * q[0] } });
    let lanes = |name| rayleigh_system(Runtime::STD, quote!(rule = gauss), block(name)).to_string();
    assert!(lanes(quote!(S)).contains("const S_ : usize"));
    assert!(lanes(quote!(T)).contains("const S : usize"));
}
