//! The expansions of two scenes, committed: they guard form, and are there to be read.
//!
//! `BLESS=1 cargo test -p dalembert-macros snapshots` writes them anew.

use std::path::Path;

use proc_macro2::TokenStream;
use quote::quote;

use crate::rayleigh_system::rayleigh_system;

fn ring() -> TokenStream {
    quote! {
        impl Ring {
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let s = q[0] * q[0] + q[1] * q[1];
                0.5 * (v[0] * v[0] + v[1] * v[1]) - s * (s - 1.0).powi(2)
            }

            fn rayleigh(&self, v: [f64; 2]) -> f64 {
                0.5 * self.k * (v[0] * v[0] + v[1] * v[1])
            }
        }
    }
}

fn double_pendulum() -> TokenStream {
    quote! {
        impl DoublePendulum {
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let [m1, m2] = self.m;
                let [l1, l2] = self.l;
                let kinetic = 0.5 * (m1 + m2) * l1 * l1 * v[0] * v[0]
                    + 0.5 * m2 * l2 * l2 * v[1] * v[1]
                    + m2 * l1 * l2 * (q[0] - q[1]).cos() * v[0] * v[1];
                let potential = -(m1 + m2) * self.g * l1 * q[0].cos() - m2 * self.g * l2 * q[1].cos();
                kinetic - potential
            }

            fn rayleigh(&self, v: [f64; 2]) -> f64 {
                let relative = v[1] - v[0];
                0.5 * self.c[0] * v[0] * v[0] + 0.5 * self.c[1] * relative * relative
            }
        }
    }
}

fn expansion(item: TokenStream) -> String {
    let expansion = rayleigh_system(quote!(derivatives = expanded), item);
    prettyplease::unparse(&syn::parse2(expansion).expect("the expansion is a file of items"))
}

fn compare(name: &str, item: TokenStream) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("snapshots").join(name);
    let expansion = expansion(item);
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(&path, &expansion).expect("the snapshot can be written");
    }
    let committed = std::fs::read_to_string(&path).expect("the snapshot is committed");
    assert!(committed == expansion, "{name} differs from its snapshot; see the module's docs\n{expansion}");
}

#[test]
fn ring_is_as_committed() {
    compare("ring.rs", ring());
}

#[test]
fn double_pendulum_is_as_committed() {
    compare("double_pendulum.rs", double_pendulum());
}

#[test]
fn equal_systems_give_equal_text() {
    assert_eq!(expansion(ring()), expansion(ring()));
    assert_eq!(expansion(double_pendulum()), expansion(double_pendulum()));
}
