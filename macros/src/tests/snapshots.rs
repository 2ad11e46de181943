//! Expansions as committed: they guard the form of the generated code, not its correctness.
//!
//! After a change that is meant, write them anew and read them:
//! `UPDATE_SNAPSHOTS=1 cargo test -p dalembert-macros snapshots`.

use std::path::Path;

use proc_macro2::TokenStream;
use quote::quote;

use crate::rayleigh_system::{Runtime, differentiable, rayleigh_system};

fn formatted(tokens: proc_macro2::TokenStream) -> String {
    prettyplease::unparse(&syn::parse2(tokens).expect("the expansion is a sequence of items"))
}

fn assert_snapshot(name: &str, actual: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/tests/snapshots").join(name);
    if std::env::var_os("UPDATE_SNAPSHOTS").is_some() {
        std::fs::write(&path, actual).expect("the folder of snapshots is writable");
    }
    let expected = std::fs::read_to_string(&path).unwrap_or_default();
    let first = expected.lines().zip(actual.lines()).position(|(expected, actual)| expected != actual);
    assert!(
        expected == actual,
        "the expansion differs from {name}, first in line {:?}; if that is meant, run with UPDATE_SNAPSHOTS=1 and read it",
        first.map(|line| line + 1)
    );
}

#[test]
fn ring() {
    let expansion = rayleigh_system(
        Runtime::STD,
        quote!(),
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
        },
    );
    assert_snapshot("ring.rs", &formatted(expansion));
}

#[test]
fn characteristic() {
    let item = quote! {
        impl Follower {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                let lift = self.cam.at(q[0]);
                0.5 * v[0] * v[0] - 0.5 * self.k * lift * lift
            }
            fn rayleigh(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                0.5 * Self::DRAG.at(q[0]) * v[0] * v[0]
            }
        }
    };
    assert_snapshot("characteristic.rs", &formatted(rayleigh_system(Runtime::STD, quote!(), item.clone())));
    // In lanes: each member's own curve, and one that all have.
    assert_snapshot("characteristic_in_lanes.rs", &of_members(quote!(lanes = midpoint), item));
}

#[test]
fn time_scale() {
    let expansion = rayleigh_system(
        Runtime::STD,
        quote!(rule = gauss),
        quote! {
            impl Kepler {
                fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                    0.5 * (v[0] * v[0] + v[1] * v[1]) + 1.0 / Self::distance(q)
                }
                fn time_scale(&self, q: [f64; 2]) -> f64 {
                    let r = Self::distance(q);
                    r * r.sqrt()
                }
                fn distance(q: [f64; 2]) -> f64 {
                    (q[0] * q[0] + q[1] * q[1]).sqrt()
                }
            }
        },
    );
    assert_snapshot("time_scale.rs", &formatted(expansion));
}

#[test]
fn double_pendulum() {
    let item = quote! {
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
    };
    let expansion = formatted(rayleigh_system(Runtime::STD, quote!(derivatives = expanded), item.clone()));
    assert_snapshot("double_pendulum.rs", &expansion);
    // Equal systems give equal text.
    assert_eq!(expansion, formatted(rayleigh_system(Runtime::STD, quote!(derivatives = expanded), item)));
}

/// A system with an input and a time: R needs neither and stands on the system, and so does L; the rest on
/// the view.
#[test]
fn driven() {
    let item = quote! {
        impl Arm {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                0.5 * self.m * v[0] * v[0] + q[0].cos()
            }
            fn rayleigh(&self, v: [f64; 1]) -> f64 {
                0.5 * self.c * v[0] * v[0]
            }
            fn force(&self, q: [f64; 1], _v: [f64; 1], u: [f64; 1], t: f64) -> [f64; 1] {
                [self.gain * u[0] * q[0].cos() + (Self::RATE * t).sin()]
            }
        }
    };
    let expansion = rayleigh_system(Runtime::STD, quote!(), item.clone());
    assert_snapshot("driven.rs", &formatted(expansion));
    let expansion = rayleigh_system(Runtime::STD, quote!(derivatives = num_dual), item);
    assert_snapshot("driven_by_num_dual.rs", &formatted(expansion));
}

/// What a system has on request: derivatives by parameters, and what second derivatives of its step need.
#[test]
fn sensitivities() {
    let expansion = rayleigh_system(
        Runtime::STD,
        quote!(parameters = [l, c[0]], step_derivatives = second),
        quote! {
            impl Joint {
                fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                    0.5 * self.l * self.l * v[0] * v[0] + self.l * q[0].cos()
                }
                fn rayleigh(&self, v: [f64; 1]) -> f64 {
                    0.25 * self.c[0] * v[0].powi(4)
                }
                fn force(&self, q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
                    [u[0] * q[0].cos()]
                }
            }
        },
    );
    assert_snapshot("sensitivities.rs", &formatted(expansion));
}

/// Gauss alone, with an input that is one number for all lanes, a time that is each lane's own, and a
/// parameter.
#[test]
fn gauss_driven() {
    let expansion = rayleigh_system(
        Runtime::STD,
        quote!(rule = gauss, parameters = gain, step_derivatives = second),
        quote! {
            impl Arm {
                fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                    0.5 * self.m * v[0] * v[0] + q[0].cos()
                }
                fn force(&self, q: [f64; 1], v: [f64; 1], u: [f64; 1], t: f64) -> [f64; 1] {
                    let push = if u[0] > 0.0 { self.gain * u[0] } else { 0.0 };
                    [push * q[0].cos() - v[0] + (Self::RATE * t).sin()]
                }
            }
        },
    );
    assert_snapshot("gauss_driven.rs", &formatted(expansion));
}

/// Gauss alone: lanes, a mass matrix that depends on q, a selection, a force.
#[test]
fn gauss() {
    let item = quote! {
        impl Cart {
            fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
                let reach = self.l * q[1].cos();
                let kinetic = 0.5 * self.m * v[0] * v[0] + reach * v[0] * v[1] + 0.5 * self.l.powi(2) * v[1] * v[1];
                let stop = if q[0] > self.end { 0.5 * self.k * (q[0] - self.end).powi(2) } else { 0.0 };
                kinetic + reach - stop
            }
            fn rayleigh(&self, v: [f64; 2]) -> f64 {
                0.5 * self.c * v[1] * v[1]
            }
            fn force(&self, q: [f64; 2], _v: [f64; 2]) -> [f64; 2] {
                [self.a.powf(q[0]), 0.0]
            }
        }
    };
    let expansion = rayleigh_system(Runtime::STD, quote!(rule = gauss), item.clone());
    assert_snapshot("gauss.rs", &formatted(expansion));
    // In lanes: the same for several members, one stage at a time, in two functions.
    assert_snapshot("cart_in_lanes.rs", &of_members(quote!(rule = gauss, lanes = gauss), item.clone()));
    // Its sums rounded with the products in them.
    let fused = quote!(rule = gauss, lanes = gauss, multiply_add = fused);
    assert_snapshot("cart_fused_in_lanes.rs", &of_members(fused, item.clone()));
    // By the midpoint rule, its equation.
    assert_snapshot("cart_at_midpoint_in_lanes.rs", &of_members(quote!(lanes = midpoint), item.clone()));
    // Nothing of it without the rule.
    let other = formatted(rayleigh_system(Runtime::STD, quote!(rule = midpoint), item));
    for word in ["Lanes", "Stages", "ForcedLagrangian"] {
        assert!(!other.contains(word), "{word}");
    }
}

/// The same system with num-dual's derivatives.
#[test]
fn oscillator_by_num_dual() {
    let expansion = rayleigh_system(
        Runtime::STD,
        quote!(derivatives = num_dual),
        quote! {
            pub fn oscillator(q: [f64; 1], v: [f64; 1], m: f64, k: f64, r: f64) -> (f64, f64) {
                (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
            }
        },
    );
    assert_snapshot("oscillator_by_num_dual.rs", &formatted(expansion));
}

#[test]
fn oscillator() {
    let expansion = rayleigh_system(
        Runtime::STD,
        quote!(rule = [midpoint, trapezoidal]),
        quote! {
            /// L and R of a damped oscillator.
            pub fn oscillator(q: [f64; 1], v: [f64; 1], m: f64, k: f64, r: f64) -> (f64, f64) {
                (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
            }
        },
    );
    assert_snapshot("oscillator.rs", &formatted(expansion));
}

/// A Newton matrix of three diagonals, kept from step to step.
#[test]
fn chain() {
    let expansion = rayleigh_system(
        Runtime::STD,
        quote!(derivatives = expanded),
        quote! {
            impl Chain {
                fn lagrangian(&self, q: [f64; 4], v: [f64; 4]) -> f64 {
                    let kinetic = v.iter().map(|v| 0.5 * v * v).sum::<f64>();
                    let springs: f64 = q.windows(2).map(|q| Self::spring(self.beta, q[1] - q[0])).sum();
                    kinetic - springs
                }
                fn spring(beta: f64, d: f64) -> f64 {
                    let square = d * d;
                    0.5 * square + 0.25 * beta * square * square
                }
            }
        },
    );
    assert_snapshot("chain.rs", &formatted(expansion));
}

/// A constant Newton matrix: each step is one solve.
#[test]
fn linear_oscillators() {
    let expansion = rayleigh_system(
        Runtime::STD,
        quote!(),
        quote! {
            fn linear(q: [f64; 2], v: [f64; 2], k: f64, c: f64) -> (f64, f64) {
                let d = q[1] - q[0];
                (0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.5 * k * (q[0] * q[0] + d * d), 0.5 * c * v[1] * v[1])
            }
        },
    );
    assert_snapshot("linear.rs", &formatted(expansion));
}

/// Störmer–Verlet with linear drag.
#[test]
fn explicit_ring() {
    let expansion = rayleigh_system(
        Runtime::STD,
        quote!(rule = trapezoidal),
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
        },
    );
    assert_snapshot("explicit_ring.rs", &formatted(expansion));
}

/// The traits of several members at once, from the expansion.
fn of_members(options: TokenStream, item: TokenStream) -> String {
    let expansion = formatted(rayleigh_system(Runtime::STD, options, item));
    let start = expansion.find("impl ::dalembert::generated::Gathered").expect("it is written");
    let end = expansion.find("impl ::dalembert::generated::OffersMethods").unwrap_or(expansion.len());
    expansion[start..end].trim_end().trim_end_matches("#[automatically_derived]").trim_end().to_owned()
}

/// Beside its own force, that of several members at once, with their fields and branches.
#[test]
fn bead_in_lanes() {
    let expansion = rayleigh_system(
        Runtime::STD,
        quote!(rule = trapezoidal, lanes = explicit),
        quote! {
            impl Bead {
                fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                    let push = if self.has_wall && q[0] > Self::WALL { self.k * (q[0] - Self::WALL) } else { 0.0 };
                    0.5 * self.m * v[0] * v[0] + self.m * self.g * q[0].cos() - push * push
                }
                fn rayleigh(&self, v: [f64; 1]) -> f64 {
                    0.5 * self.r * v[0] * v[0]
                }
            }
        },
    );
    assert_snapshot("bead_in_lanes.rs", &formatted(expansion));
}

/// The fields that any kind of lanes reads are gathered once, in one order for all.
#[test]
fn fields_are_gathered_once() {
    let item = quote! {
        impl Bead {
            fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                0.5 * self.m * v[0] * v[0] + self.g * q[0].cos()
            }
            fn rayleigh(&self, v: [f64; 1]) -> f64 {
                0.5 * self.r * v[0] * v[0]
            }
        }
    };
    let gathered = |options| of_members(options, item.clone()).matches("fn fields<").count();
    assert_eq!(gathered(quote!(rule = [midpoint, trapezoidal, gauss], lanes = explicit)), 1);
    let all = quote!(rule = [midpoint, trapezoidal, gauss], lanes = [explicit, midpoint, gauss]);
    assert_eq!(gathered(all.clone()), 1);
    let text = of_members(all, item.clone());
    let kinds = ["ExplicitInLanes<1>", "DiscreteInLanes<", "ForcedLagrangianInLanes<1>"];
    assert!(kinds.iter().all(|kind| text.contains(kind)), "{text}");
    assert!(
        text.contains("let [_, g, _, _] = *fields") && text.contains("let [m, _, r, _] = *fields"),
        "{text}"
    );
}

/// The time of each member beside its fields: read by the force of an explicit step, by the rates of a stage,
/// and handed to what corrects where the mass holds it.
#[test]
fn members_with_a_time() {
    let explicit = of_members(
        quote!(rule = trapezoidal, lanes = explicit),
        quote! {
            impl Shaken {
                fn lagrangian(&self, q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
                    0.5 * self.m * v[0] * v[0] + (1.0 + self.a * t.sin()) * q[0].cos()
                }
                fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
                    u
                }
            }
        },
    );
    let gauss = of_members(
        quote!(rule = gauss, lanes = gauss),
        quote! {
            impl Growing {
                fn lagrangian(&self, q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
                    0.5 * (self.m + t * t) * v[0] * v[0] + q[0].cos()
                }
            }
        },
    );
    assert_snapshot("members_with_a_time.rs", &format!("{explicit}\n{gauss}"));
}

/// What is known is said to whoever reads the documentation.
#[test]
fn findings_are_documented() {
    let expansion = rayleigh_system(
        Runtime::STD,
        quote!(),
        quote! {
            fn polar(q: [f64; 3], v: [f64; 3], r: f64) -> (f64, f64) {
                (0.5 * (v[0] * v[0] + q[0] * q[0] * v[1] * v[1] + v[2] * v[2]), r * v[2] * v[2])
            }
        },
    );
    let expansion = formatted(expansion);
    for sentence in [
        "Derivatives are written out.",
        "The damping force −∂R/∂v is linear in v with constant coefficients.",
        "By the rule `Midpoint` the Newton matrix is tridiagonal and changes with the state.",
        "q₁ is cyclic: the momentum p₁ = ∂L/∂v₁ is conserved, by every rule.",
        "q₂ is cyclic, but R acts on it: the momentum p₂ = ∂L/∂v₂ is not conserved in general.",
    ] {
        assert!(expansion.contains(&format!("/// - {sentence}\n")), "{sentence}\n{expansion}");
    }
    assert!(!expansion.contains("mass matrix ∂²L/∂v² is constant") && !expansion.contains("q₀ is cyclic"));
}

#[test]
fn rotation() {
    let expansion = differentiable(
        Runtime::STD,
        quote!(),
        quote! {
            fn rotation(q: [f64; 2], speed: f64) -> [f64; 2] {
                [-speed * q[1], speed * q[0]]
            }
        },
    );
    assert_snapshot("rotation.rs", &formatted(expansion));
}

#[test]
fn pendulum_on_core() {
    let expansion = rayleigh_system(
        Runtime::CORE,
        quote!(),
        quote! {
            impl Pendulum {
                fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                    0.5 * v[0].powi(2) - self.height(q[0])
                }
                fn height(&self, angle: f64) -> f64 {
                    self.g * (1.0 - f64::cos(angle))
                }
                fn period(&self) -> f64 {
                    6.0 / self.g
                }
            }
        },
    );
    assert_snapshot("pendulum_on_core.rs", &formatted(expansion));
}
