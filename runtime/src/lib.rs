#![cfg_attr(all(doc, feature = "theory"), doc = include_str!("guide/pictures/ring.link"))]
#![cfg_attr(feature = "theory", doc = include_str!("guide/front_page.md"))]
#![cfg_attr(feature = "theory", doc = "")]
#![cfg_attr(feature = "theory", doc = include_str!("guide/chapters.md"))]
#![cfg_attr(feature = "theory", doc = "")]
#![cfg_attr(
    feature = "theory",
    doc = "The documentation of the attribute is the reference: what L and R may contain, and all options."
)]
#![cfg_attr(
    all(feature = "std", not(feature = "theory")),
    doc = "Structure-preserving integrators for mechanical systems, without the checkers of the theory."
)]
#![cfg_attr(
    not(feature = "std"),
    doc = "Structure-preserving integrators for mechanical systems, without std: the step, and systems whose derivatives are written out."
)]
#![cfg_attr(not(feature = "std"), no_std)]

extern crate self as dalembert;

/// `Debug` of an error as its `Display`: `main` that returns it and `unwrap` print what is wrong.
macro_rules! debug_by_display {
    ($error:ident) => {
        impl core::fmt::Debug for $error {
            /// The text of `Display`.
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                core::fmt::Display::fmt(self, f)
            }
        }
    };
}

pub mod derivative;
pub mod generated;
#[cfg(all(any(doc, doctest), feature = "theory"))]
pub mod guide;
pub mod nalgebra;
mod numbers;
pub mod rules;
pub mod run;
pub mod step;
pub mod system;
mod theory;

#[doc(inline)]
pub use run::tolerance;
#[cfg(feature = "theory")]
pub use theory::{exact, hamilton_jacobi, noether, rayleigh, samples};

/// Its code blocks are tests.
#[cfg(all(doctest, feature = "theory"))]
#[doc = include_str!("../README.md")]
struct ReadMe;

/// The attributes that fit the features of this crate, which a macro cannot see.
mod attributes {
    #[cfg(feature = "std")]
    pub use dalembert_macros::differentiable;
    #[cfg(not(feature = "std"))]
    pub use dalembert_macros::differentiable_core as differentiable;
    #[cfg(all(feature = "std", not(feature = "libm")))]
    pub use dalembert_macros::rayleigh_system;
    #[cfg(not(feature = "std"))]
    pub use dalembert_macros::rayleigh_system_core as rayleigh_system;
    #[cfg(all(feature = "std", feature = "libm"))]
    pub use dalembert_macros::rayleigh_system_portable as rayleigh_system;
}

/// Generates the discrete mechanical system of a Lagrangian and a Rayleigh function, written as plain
/// Rust.
///
/// ```
/// use dalembert::nalgebra::vector;
/// use dalembert::{Discretise, Lagrangian, Midpoint, rayleigh_system};
///
/// struct Ring {
///     k: f64,
/// }
///
/// #[rayleigh_system] // rule = midpoint unless said; rule = [midpoint, trapezoidal] generates both
/// impl Ring {
///     fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
///         let s = q[0] * q[0] + q[1] * q[1];
///         0.5 * (v[0] * v[0] + v[1] * v[1]) - s * (s - 1.0).powi(2)
///     }
///     fn rayleigh(&self, v: [f64; 2]) -> f64 {
///         0.5 * self.k * (v[0] * v[0] + v[1] * v[1])
///     }
/// }
///
/// let ring = Ring { k: 1e-3 };
/// assert_eq!(ring.rayleigh([1.0, 0.0]), 5e-4); // still a plain function
/// assert_eq!(ring.energy(&vector![0.0, 1.0], &vector![0.5, 0.0]), 0.125);
/// let p = ring.by(Midpoint, 0.1).legendre_minus(&vector![0.0, 1.0], &vector![0.0, 1.0]).p;
/// assert_eq!(p, vector![0.0, 0.0]); // the bottom of the ring is an equilibrium
/// ```
///
/// # The block
///
/// | function | |
/// |---|---|
/// | `fn lagrangian(&self, q: [f64; N], v: [f64; N]) -> f64` | L; its array type says N, a number or a constant |
/// | `fn rayleigh(&self, v: [f64; N]) -> f64`, or `(&self, q, v)` | R, if there is dissipation: the force is −∂R/∂v |
/// | `fn force(&self, q: [f64; N], v: [f64; N]) -> [f64; N]` | a general force, if there is one; `(&self, q, v, u: [f64; M])` with an input |
/// | `fn constraints(&self, q: [f64; N]) -> [f64; M]` | holonomic constraints g(q) = 0, if there are any: [below](#constraints) |
/// | `fn velocity_constraints(&self, q, v: [f64; N]) -> [f64; M]` | constraints linear in v, as in rolling |
/// | `fn events(&self, q, v: [f64; N]) -> [f64; K]` | [event functions](system::EventFunctions) |
/// | `fn outputs(&self, q, v: [f64; N]) -> [f64; K]` | [outputs](system::OutputFunctions); `u` may follow |
/// | `fn time_scale(&self, q: [f64; N]) -> f64` | σ > 0, if steps are to follow the motion: [`in_scaled_time`](Trajectory::in_scaled_time) |
/// | any other | a helper: differentiated if one of these calls it, untouched otherwise |
///
/// `f32` in place of `f64` makes a system in single precision.
///
/// L, R, the force, constraints, event functions and outputs may take a time `t: f64` after their other
/// parameters. Arguments go by their place, whatever they are called: q, v, u, t. Any of these names at the
/// place of another is an error, and so is a number after v that is not called `t` or `time`.
///
/// # Inputs and time
///
/// A system whose force takes an input u, or one of whose functions takes the time t, is stepped through
/// a view of it: with the input held over the step, and with the time at which the step starts. The rule
/// evaluates each of its nodes at that node's own time, and a [`Trajectory`] of a view carries its time
/// on. Whatever needs neither u nor t, such as L and its energy here, the system itself has as well.
///
/// | the system takes | its view | |
/// |---|---|---|
/// | u | `system.driven(u)` | `u` an array or an `SVector`: an [`Input`](system::Input) |
/// | t | `system.at_time(t)` | |
/// | u and t | `system.driven(u, t)` | |
///
/// ```
/// use dalembert::nalgebra::vector;
/// use dalembert::{Discretise, Midpoint, State, StepError, rayleigh_system};
///
/// struct Arm {
///     c: f64,
/// }
///
/// #[rayleigh_system]
/// impl Arm {
///     fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
///         0.5 * v[0] * v[0] + q[0].cos()
///     }
///     fn rayleigh(&self, v: [f64; 1]) -> f64 {
///         0.5 * self.c * v[0] * v[0]
///     }
///     fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
///         u
///     }
/// }
///
/// let (arm, h) = (Arm { c: 0.1 }, 0.01);
/// let mut state = State::from_velocity(&arm, [0.0], [0.0])?;
/// for _ in 0..2000 {
///     let u = 0.5_f64.sin() - 2.0 * (state.q[0] - 0.5) - state.velocity(&arm)?[0];
///     state = arm.driven([u]).by(Midpoint, h).step(&state)?.state;
/// }
/// assert!((state.q[0] - 0.5).abs() < 1e-3);
///
/// // The next step with A = ∂(q1, p1)/∂(q0, p0) and B = ∂(q1, p1)/∂u.
/// let driven = arm.driven([0.5_f64.sin()]);
/// let step = driven.by(Midpoint, h).linearized(&state)?;
/// let (a, b) = (step.by_state()?, step.by_input::<1>()?);
/// assert!((a.q_by_p[0] / h - 1.0).abs() < 1e-3 && (b.p[0] / h - 1.0).abs() < 1e-3);
/// # Ok::<(), StepError>(())
/// ```
///
/// # Constraints
///
/// Steps on constraints keep g(q) = 0 to rounding, by `midpoint` and `trapezoidal` and by
/// [`Composition`]s of them: no stabilisation, nothing to tune. Coordinates may be as many as are
/// convenient, those of each body for itself, and constraints may be redundant, as the last one of a closed
/// loop often is; one that is a number times another is an error.
///
/// ```
/// use dalembert::{Discretise, Midpoint, State, StepError, rayleigh_system};
///
/// /// A bob on a rod, in the plane.
/// struct Pendulum {
///     m: f64,
///     length: f64,
///     c: f64,
/// }
///
/// #[rayleigh_system]
/// impl Pendulum {
///     fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
///         0.5 * self.m * (v[0] * v[0] + v[1] * v[1]) - self.m * 9.81 * q[1]
///     }
///     fn rayleigh(&self, v: [f64; 2]) -> f64 {
///         0.5 * self.c * (v[0] * v[0] + v[1] * v[1])
///     }
///     fn constraints(&self, q: [f64; 2]) -> [f64; 1] {
///         [(q[0] * q[0] + q[1] * q[1]).sqrt() - self.length]
///     }
/// }
///
/// let pendulum = Pendulum { m: 2.0, length: 0.8, c: 0.1 };
/// // q has to be on the constraints and v along them: `from_velocity` refuses what is not.
/// let off = State::from_velocity(&pendulum, [0.5, -0.6], [0.0, 0.0]);
/// assert!(matches!(off, Err(StepError::OffConstraint { constraint: 0, .. })));
/// let start = State::nearest(&pendulum, [0.5, -0.6], [0.0, 0.0])?;
///
/// let by = pendulum.by(Midpoint, 0.01);
/// let end = by.run(start).nth(999).unwrap()?.state;
/// assert!((end.q.norm() - 0.8).abs() < 1e-15);
/// // The force in the rod, in N.
/// let tension = -by.reactions(&end, &by.step(&end)?)?[0];
/// assert!(tension > 0.0 && tension < 3.0 * 2.0 * 9.81);
/// # Ok::<(), StepError>(())
/// ```
///
/// Constraints that depend on time prescribe motion: g(q, t) = 0 drives a hoist, and v has to follow the rope
/// as it is then, ∂g/∂q·v + ∂g/∂t = 0. Such a system has its constraints as a view, `system.at_time(t)`.
///
/// `velocity_constraints` hold v: ψ(q̄, v̄) = 0 in each step, at q̄ = (q0 + q1)/2, with the reaction along
/// ∂ψ/∂v; v at the end of each step satisfies ψ as well. Order is that of the rule. Such a step is not
/// symplectic, and has no discrete Lagrangian of its own: over a long run without friction energy may stay,
/// as that of a skate over 100 000 steps, or drift, as that of a cart with its load ahead of the axle (the
/// scene `rolling`), less by a method of higher order. A coin that rolls:
///
/// ```
/// use dalembert::{Discretise, Midpoint, State, StepError, rayleigh_system};
///
/// struct Coin {
///     slope: f64,
/// }
///
/// #[rayleigh_system]
/// impl Coin {
///     // Its place, its heading and its angle.
///     fn lagrangian(&self, q: [f64; 4], v: [f64; 4]) -> f64 {
///         0.5 * (v[0] * v[0] + v[1] * v[1] + 0.25 * v[2] * v[2] + 0.5 * v[3] * v[3]) + self.slope * q[0]
///     }
///     fn velocity_constraints(&self, q: [f64; 4], v: [f64; 4]) -> [f64; 2] {
///         [v[0] - q[2].cos() * v[3], v[1] - q[2].sin() * v[3]]
///     }
/// }
///
/// let coin = Coin { slope: 1.5 };
/// let start = State::from_velocity(&coin, [0.0; 4], [0.0, 0.0, 1.0, 0.0])?;
/// let end = coin.by(Midpoint, 0.01).run(start).nth(399).unwrap()?.state;
/// // It goes across the slope, in arcs: x = ½ sin²t.
/// assert!((end.q[0] - 0.5 * 4.0_f64.sin().powi(2)).abs() < 1e-4);
/// # Ok::<(), StepError>(())
/// ```
///
/// A, B and derivatives by parameters are those of the step that [`State::nearest`] extends to states off
/// the constraints, 2N×2N. Constraints do not go with other rules, `lanes`, `time_scale`, `step_derivatives`
/// and `derivatives = num_dual`, and their steps have no certificate. Of the checkers `noether`,
/// `rayleigh_step` and `rayleigh_structure` take holonomic ones, and `dissipation` and `ledger` any.
///
/// # Rules
///
/// | `rule = ` | | asks for |
/// |---|---|---|
/// | `midpoint` | [`Midpoint`], order 2, self-adjoint | |
/// | `trapezoidal` | [`Trapezoidal`], order 2, self-adjoint; explicit where L = ½vᵀMv − V(q), with [`Splitting`]s of order 4 and 6 then | |
/// | `gauss` | [`Gauss<S>`](Gauss), order 2S for S = 1…8, self-adjoint; for small errors | |
/// | `fitted` | [`Fitted`], order 2, self-adjoint; does not ring under stiff damping | L = ½vᵀMv − V(q) with constant M, linear damping, no force, input, time, `parameters` or `step_derivatives` |
/// | `fitted_trapezoidal` | [`FittedTrapezoidal`], the same made explicit; exact law of phase volume | as `fitted` |
/// | `proximal` | [`Proximal`], order 2 while it slides; for dry friction: what sticks, sticks to the last bit | kinks of R, such as \|v\|, of what is linear in v; no constraints, `time_scale`, `parameters` or `step_derivatives` |
/// | `one_sided` | [`OneSided`], order 1; for stiff damping that is not linear: velocities as the balance of forces has them | R smooth and convex in v; no `step_derivatives` |
///
/// Kinks of R are an error at their tokens under every other rule, which has no step where the motion stops:
/// |v|³, v|v| and √(v² + ε²) are none. `derivatives = num_dual`, and `auto` where it falls back on that, does
/// not see them: there a step at a kink fails when the program runs, with
/// [`NoDerivative`](StepError::NoDerivative) or [`NoRealSolution`](StepError::NoRealSolution).
///
/// # Options
///
/// | option | |
/// |---|---|
/// | `rule = midpoint`, `rule = [midpoint, trapezoidal]` | the rules; midpoint unless said |
/// | `derivatives = auto`, `expanded`, `num_dual` | who makes the derivatives; written out where that can be, up to 20 000 operations in one function, unless said |
/// | `parameters = [m, c[0]]` | fields by which the step is differentiated: [`by_parameters`](derivative::StepTaken::by_parameters); written out only |
/// | `step_derivatives = second` | second derivatives of the step: [`StepHessian`](derivative::StepHessian) |
/// | `lanes = explicit` | explicit steps of many members at once, each with fields, an input and a time of its own: [`LaneRuns`](run::LaneRuns); written out only. Sine, cosine and exponential of the force are then the branch-free ones of [`Lanes`](generated::Lanes), for one member too |
/// | `lanes = midpoint`, `lanes = gauss` | the same of the midpoint rule and of Gauss rules; `lanes = [explicit, gauss]` for both |
/// | `multiply_add = fused` | products are rounded with the sums that they stand in: in derivatives, and in the sums over stages of Gauss rules; written out only. Members in lanes and their own runs have the same bits. In a build for any x86-64, with AVX2, Gauss rules in lanes take 0.89 to 0.95 of the time and explicit methods gain nothing; a run of its own takes 9 times the time there, as a function stands for the instruction, which a warning says where there are no lanes, and 0.9 in a native build |
/// | `crate = mechanics` | the path of this crate, where Cargo.toml gives it another name: `mechanics = { package = "dalembert" }`; also of [`differentiable`](macro@differentiable) |
///
/// Where `auto` cannot write the derivatives out, dual numbers make them when the program runs: twice as
/// slow for two coordinates, hundreds of times for nine, and a compile-time error beyond 32 (8 with
/// `step_derivatives = second`), where the stack of a thread might overflow. A warning at the token that
/// cannot be followed says why. It is rustc's `deprecated`: `derivatives = num_dual` or
/// `#[allow(deprecated)]` beside the attribute silence it, `derivatives = expanded` or `-D warnings`
/// make it an error.
///
/// # One free function
///
/// The parameters after q and v become the fields of a struct named after the function:
///
/// ```
/// use dalembert::{Lagrangian, nalgebra::vector, rayleigh_system};
///
/// #[rayleigh_system]
/// fn oscillator(q: [f64; 1], v: [f64; 1], m: f64, k: f64, r: f64) -> (f64, f64) {
///     (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
/// }
///
/// let system = Oscillator { m: 2.0, k: 8.0, r: 0.5 };
/// assert_eq!(system.energy(&vector![1.0], &vector![0.0]), 4.0);
/// ```
///
/// `-> (f64, f64)` is (L, R), `-> f64` is L alone. Every parameter after v is a field, also one called
/// `t`: systems with an input or a time are blocks.
///
/// # What bodies may contain
///
/// One language for `auto`, `expanded` and `num_dual`, with Rust's semantics; the value is bit by bit
/// that of the same code outside the macro.
///
/// - Fields that are `f64`, integers, `bool`, arrays or tuples of them, `Option`s, and enums and structs
///   of your own, and with `*` references to such; constants of the standard library, the module and the
///   block; functions of the block.
/// - `let`, `let … else`, `mut` locals, arrays, tuples, references, closures that change nothing
///   outside, loops and iterators, `for x in a.iter_mut()`, `swap`, labels and blocks that `break` ends,
///   `if`, `if let`, `match` with guards, patterns with `|`, `matches!`, early return.
/// - `is_some`, `is_none`, `unwrap_or`, `map_or`, `is_some_and` and their like of an `Option`. What a
///   pattern matches, rustc decides: the pattern is written out, and each arm is differentiated for
///   itself.
/// - `self.drag.at(x)`, at any x, of a field or constant that is a [`Table`](system::Table) or another
///   [`Curve`](system::Curve).
/// - Integers, with the types that Rust infers: what overflows is refused, `as` wraps, truncates and
///   rounds.
///
/// ```
/// use dalembert::{Rayleigh, nalgebra::vector, rayleigh_system};
///
/// enum Friction {
///     None,
///     Linear(f64),
///     Quadratic { c: f64 },
/// }
///
/// struct Slider {
///     law: Friction,
///     k3: Option<f64>,
/// }
///
/// #[rayleigh_system]
/// impl Slider {
///     fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
///         0.5 * (v[0] * v[0] - q[0] * q[0]) - self.k3.map_or(0.0, |k| 0.25 * k * q[0].powi(4))
///     }
///     fn rayleigh(&self, v: [f64; 1]) -> f64 {
///         match self.law {
///             Friction::None => 0.0,
///             Friction::Linear(c) => 0.5 * c * v[0] * v[0],
///             Friction::Quadratic { c } => c * v[0].abs().powi(3) / 3.0,
///         }
///     }
/// }
///
/// let slope = |law| Slider { law, k3: None }.rayleigh_gradient(&vector![0.0], &vector![2.0]).d2[0];
/// assert_eq!([Friction::None, Friction::Linear(0.5), Friction::Quadratic { c: 0.5 }].map(slope), [0.0, 1.0, 2.0]);
/// ```
///
/// | methods of floating-point numbers, as `x.sin()`, `f64::sin(x)` or `.map(f64::sin)` | |
/// |---|---|
#[doc = concat!("| those of [`Elementary`] | ", functions!(names!()), "`sin_cos` |")]
/// | other powers and units | `recip` `to_radians` `to_degrees` |
/// | piecewise | `abs` `signum` `copysign` `min` `max` `clamp` |
/// | sums | `midpoint`, `sum()` and `product()` of iterators |
/// | of fields and constants alone | `floor` `ceil` `round` `trunc` `fract` `rem_euclid` `div_euclid`, `%` |
/// | questions, on the value alone | `is_nan` `is_finite` `is_infinite` `is_normal` `is_subnormal` `is_sign_positive` `is_sign_negative` `total_cmp`, `==` `<` `partial_cmp` |
///
/// `hypot` guards against overflow and costs 1.5 times as much as `sqrt` of a sum of squares, which
/// serves where the squares stay between 1e-300 and 1e300.
///
/// Without the feature `std` the same source compiles: elementary functions are those of [`Elementary`].
/// With `std` and `libm` they are so too, and a host repeats a microcontroller bit by bit. Other
/// functions of the block, and code of your own, import [`Elementary`] to call them. Bodies must then be
/// such that their derivatives can be written out.
///
/// Where a derivative does not exist, it is what the table of [`Real`](generated::dual::Real) says.
///
/// `auto` leaves to dual numbers, which take no enum, and `expanded` refuses:
///
/// - loops whose turns depend on numbers or fields, `break` and `continue` among them;
/// - closures, and blocks with a label that numbers decide to leave, which change a local outside;
/// - `&mut` but for `for x in &mut a` and `std::mem::swap`, and `iter_mut` but with `enumerate` and `zip`;
/// - `sort_by`, `partial_cmp`, `total_cmp`, `min_by`, `max_by`, `find`, `position`, `last`, `nth`, `scan`,
///   `take_while`, and `reduce` without an `unwrap` behind it;
/// - a `Vec`, and an `Option` made in the body;
/// - methods of traits and structs of your own on fields and constants alone. On coordinates they have no
///   derivative over dual numbers either, unless the trait is one of any number: a function of the block has.
///
/// Bodies that programs write may be 6 000 operators and brackets deep, as a sum of 5 000 terms is, or 100
/// where the compiler runs on other processors than x86-64 and AArch64; deeper ones are refused.
///
/// Refused, with a message at the token: `#[cfg]` inside the item, type aliases, items and macros inside
/// a body, functions outside the block, generic helpers, assignment to a field, casts of coordinates to
/// integers, `%` and rounding and bit methods on them, integers that overflow or whose value depends on
/// a type that is not known.
pub use attributes::rayleigh_system;

/// Makes a function of the configuration a field with derivatives: a [`VectorField`] if it returns
/// `[f64; N]`, such as the generator of a symmetry, a [`ScalarField`] if it returns `f64`, such as a
/// generating function.
///
/// Parameters after q become the fields of a struct named after the function, which stays callable.
/// Bodies may contain what those of [`rayleigh_system`](macro@rayleigh_system) may, with closures for
/// helpers. Needs the feature `std`.
///
/// ```
/// use dalembert::nalgebra::{matrix, vector};
/// use dalembert::{ScalarField, VectorField, differentiable};
///
/// #[differentiable]
/// fn rotation(q: [f64; 2]) -> [f64; 2] {
///     [-q[1], q[0]]
/// }
///
/// #[differentiable]
/// fn generating(q: [f64; 1], s: f64) -> f64 {
///     0.5 * s * q[0] * q[0]
/// }
///
/// assert_eq!(Rotation.jacobian(&vector![3.0, 4.0]), matrix![0.0, -1.0; 1.0, 0.0]);
/// assert_eq!(Generating { s: 2.0 }.gradient(&vector![3.0]), vector![6.0]);
/// ```
pub use attributes::differentiable;

pub use numbers::Elementary;
use numbers::{functions, names};
#[doc(inline)]
pub use rules::{Fitted, FittedTrapezoidal, Gauss, Midpoint, OneSided, Proximal, Trapezoidal};
#[doc(inline)]
pub use run::{Checkpoint, Composition, Discretise, Splitting, Trajectory};
#[doc(inline)]
pub use step::{Discrete, Discretised, State, StepError};
#[doc(inline)]
pub use system::{Force, Lagrangian, Rayleigh, ScalarField, VectorField};
pub use theory::{EnergyEntries, EnergyLedger};
