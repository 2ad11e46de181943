//! The functions of the standard library.

use super::Elementary;
use super::functions::functions;

macro_rules! platform {
    ($float:ident: $($(#[$doc:meta])* $name:ident($($argument:ident: $type:tt),*) = $double:path, $single:path;)*) => {
        impl Elementary for $float {
            $(
                #[cfg_attr(not(debug_assertions), inline(always))]
                fn $name(self $(, $argument: $type)*) -> Self {
                    $float::$name(self $(, $argument)*)
                }
            )*

            #[cfg_attr(not(debug_assertions), inline(always))]
            fn sin_cos(self) -> (Self, Self) {
                $float::sin_cos(self)
            }
        }
    };
}

functions!(platform!(f64:));
functions!(platform!(f32:));
