//! The struct of a system's parameters, the same in Rust and in C, but for tables: C has their points.

/// Declares the struct of a system whose fields C is to fill in, and the one that C fills in for it.
///
/// Fields are numbers (`f64`, `f32`, `i8` … `u64`), arrays of them, of one or two dimensions, or
/// [`Table`](dalembert::system::Table)s, which C gives as points with the interpolation between them; their
/// documentation goes into the header. There is at least one, as C has no empty struct.
///
/// ```
/// dalembert_c::parameters! {
///     /// A pole hinged on a cart.
///     pub struct CartPole {
///         /// Mass of the cart in kg.
///         pub cart: f64,
///         /// Friction of the cart in N s/m, and of the hinge in N m s.
///         pub friction: [f64; 2],
///     }
/// }
/// ```
#[macro_export]
macro_rules! parameters {
    (
        $(#[doc = $doc:expr])*
        $vis:vis struct $name:ident { $($(#[doc = $field_doc:expr])* pub $field:ident: $kind:ty),+ $(,)? }
    ) => {
        $crate::face::fields! {
            @plain $crate::boundary::Plain;
            $(#[doc = $doc])*
            $vis struct $name { $($(#[doc = $field_doc])* pub $field: $kind),+ }
        }
    };
}
