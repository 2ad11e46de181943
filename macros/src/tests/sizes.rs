//! Sums over many pairs: written out as far as rustc compiles them well, else refused at the loop, without a
//! deep stack.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use crate::rayleigh_system::{Runtime, rayleigh_system};

/// n bodies on a line, with a Lennard-Jones potential between each two.
fn pairs(n: usize) -> TokenStream {
    quote! {
        impl System {
            fn lagrangian(&self, q: [f64; #n], v: [f64; #n]) -> f64 {
                let mut l = 0.0;
                for i in 0..#n {
                    l += 0.5 * self.m * v[i] * v[i];
                    for j in 0..i {
                        let r = q[i] - q[j];
                        let s = (self.sigma / r).powi(6);
                        l -= 4.0 * self.epsilon * (s * s - s);
                    }
                }
                l
            }
        }
    }
}

fn expansion(rule: &str, item: TokenStream) -> String {
    let rule = format_ident!("{rule}");
    rayleigh_system(Runtime::STD, quote!(derivatives = expanded, rule = #rule), item).to_string()
}

#[test]
fn sums_over_the_pairs_of_30_bodies_are_written_out_by_every_rule() {
    for rule in ["midpoint", "trapezoidal", "gauss"] {
        let expanded = expansion(rule, pairs(30));
        assert!(!expanded.contains("compile_error"), "{rule}: {expanded}");
    }
}

/// Runs on the stack of a small thread.
fn on_a_small_stack(run: impl FnOnce() + Send + 'static) {
    std::thread::Builder::new().stack_size(1 << 20).spawn(run).unwrap().join().unwrap();
}

#[test]
fn longer_sums_over_pairs_are_refused_at_their_loop_with_its_operations() {
    // Too long with its derivatives; too long as it stands.
    for (n, said) in [(60, "one function of straight-line code is"), (100, "before any derivative")] {
        on_a_small_stack(move || {
            let item = pairs(n);
            let expanded = expansion("midpoint", item.clone());
            assert!(expanded.contains("compile_error") && expanded.contains(said), "{n}: {expanded}");
            assert!(expanded.contains("of the operations of `lagrangian`"), "{n}: {expanded}");
            assert!(expanded.contains("it may have 20000") || expanded.contains("which may have 20000"));
            // The range of the outer loop is what is shown.
            let left = rayleigh_system(Runtime::STD, quote!(rule = midpoint), item).to_string();
            assert!(left.contains(&format!("\"0 .. {n}usize\"")), "{n}: {left}");
        });
    }
}

#[test]
fn expressions_thousands_deep_do_not_overflow_the_stack() {
    let bodies = [
        quote!(let mut s = 0.0; for i in 0..1500 { s += (q[0] * self.c[i]).sin() * v[0]; } s),
        quote!(let mut p = v[0]; for i in 0..1500 { p *= self.c[i] + q[0]; } p),
        quote!(let mut x = v[0]; for i in 0..400 { x = if x < self.c[i] * q[0] { x } else { q[0] }; } x),
        quote!(let mut x = v[0]; for i in 0..60 { x = x * x; } x * q[0] * 0.1 + 0.3 * x),
    ];
    for body in bodies.map(|body| body.to_string()) {
        on_a_small_stack(move || {
            let body: TokenStream = body.parse().expect("tokens");
            let item = quote! {
                impl System { fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 { #body } }
            };
            let expanded = expansion("midpoint", item);
            assert!(!expanded.contains("compile_error"), "{body}: {expanded}");
        });
    }
}
