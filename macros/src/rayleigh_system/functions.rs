//! Elementary functions, as methods of numbers. One row holds all that the macro knows of a function but its
//! derivatives, which `differentiate/partials.rs` has.

/// Where a function may lack a derivative.
#[derive(Clone, Copy)]
pub struct Singularity {
    /// The operation's name in the runtime.
    pub name: &'static str,
    /// An argument at which it has one.
    pub regular: f64,
}

/// The zeros of a function of one number, and what becomes of the digits of its argument.
#[derive(Clone, Copy)]
pub enum Zeros {
    /// At 0, if that is an argument, and digits are lost elsewhere, as by sin x.
    AtZero,
    /// At 0 alone, and digits are kept, as by √x.
    OfRoot,
    /// Nowhere, as of eˣ.
    Nowhere,
    /// Elsewhere, as of cos x.
    Elsewhere,
}

/// Makes a set of methods of `f64`. A row is a name and the method's; its [`Zeros`] unless they are at 0; and
/// if it may lack a derivative its [`Singularity`].
macro_rules! methods {
    ($(#[$doc:meta])* $set:ident: $type:ty {
        $(
            $name:ident $method:ident
            $(, zeros $zeros:ident)? $(, singular as $singular:ident, regular at $regular:literal)?;
        )*
    }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum $set {
            $($name),*
        }

        #[allow(dead_code, reason = "a set needs not all")]
        impl $set {
            /// Every one.
            pub const ALL: &[Self] = &[$(Self::$name),*];

            /// The method's name.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$name => stringify!($method)),*
                }
            }

            /// The method of that name.
            pub fn named(name: &str) -> Option<Self> {
                Self::ALL.iter().copied().find(|method| method.name() == name)
            }

            /// The method on numbers.
            pub fn method(self) -> $type {
                match self {
                    $(Self::$name => f64::$method),*
                }
            }

            /// Where it is 0.
            pub fn zeros(self) -> Zeros {
                match self {
                    $($(Self::$name => Zeros::$zeros,)?)*
                    _ => Zeros::AtZero,
                }
            }

            /// Where it may lack a derivative.
            pub fn singularity(self) -> Option<Singularity> {
                match self {
                    $($(Self::$name => {
                        Some(Singularity { name: stringify!($singular), regular: $regular })
                    })?)*
                    _ => None,
                }
            }
        }
    };
}

methods! {
    /// Elementary functions of one number.
    Function: fn(f64) -> f64 {
        Recip recip, zeros Nowhere, singular as Division, regular at 1.0;
        Exp exp, zeros Nowhere;
        Exp2 exp2, zeros Nowhere;
        ExpM1 exp_m1;
        Ln ln, zeros Elsewhere, singular as Logarithm, regular at 1.0;
        Log2 log2, zeros Elsewhere, singular as Logarithm, regular at 1.0;
        Log10 log10, zeros Elsewhere, singular as Logarithm, regular at 1.0;
        Ln1p ln_1p, singular as LogarithmOfSum, regular at 1.0;
        Sin sin;
        Cos cos, zeros Elsewhere;
        Tan tan;
        Asin asin, singular as ArcSine, regular at 0.0;
        Acos acos, zeros Elsewhere, singular as ArcSine, regular at 0.0;
        Atan atan;
        Sinh sinh;
        Cosh cosh, zeros Nowhere;
        Tanh tanh;
        Asinh asinh;
        Acosh acosh, singular as AreaCosine, regular at 2.0;
        Atanh atanh, singular as AreaTangent, regular at 0.0;
        Sqrt sqrt, zeros OfRoot, singular as SquareRoot, regular at 1.0;
        Cbrt cbrt, zeros OfRoot, singular as CubeRoot, regular at 1.0;
        Abs abs, zeros OfRoot;
        Signum signum, zeros Nowhere;
    }
}

methods! {
    /// Elementary functions of two numbers.
    PairFunction: fn(f64, f64) -> f64 {
        Powf powf, singular as Power, regular at 1.0;
        Atan2 atan2, singular as Angle, regular at 1.0;
        Hypot hypot, singular as Length, regular at 1.0;
        Copysign copysign;
    }
}

methods! {
    /// Questions about a number.
    Predicate: fn(f64) -> bool {
        Nan is_nan;
        Finite is_finite;
        Infinite is_infinite;
        SignNegative is_sign_negative;
        SignPositive is_sign_positive;
    }
}

/// Whether a method of floating-point numbers has a row.
fn has_row(method: &str) -> bool {
    Function::named(method).is_some() || PairFunction::named(method).is_some()
}

/// Whether it is a method of floating-point numbers that bodies may call on coordinates, and that a user may
/// call like a function, as in C.
pub fn is_known(method: &str) -> bool {
    const OF_OPERATIONS: [&str; 9] =
        ["clamp", "log", "max", "min", "mul_add", "powi", "sin_cos", "to_degrees", "to_radians"];
    has_row(method) || OF_OPERATIONS.contains(&method)
}

/// Whether it is a method that the standard library has and `core` has not: those of the runtime's
/// `Elementary`.
pub fn is_elementary(method: &str) -> bool {
    const OF_CORE: [&str; 4] = ["abs", "copysign", "recip", "signum"];
    const OTHERS: [&str; 4] = ["log", "mul_add", "powi", "sin_cos"];
    (has_row(method) && !OF_CORE.contains(&method)) || OTHERS.contains(&method)
}
