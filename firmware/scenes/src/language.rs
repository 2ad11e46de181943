//! Every way in which a body may call an elementary function, in one system for each scalar type, and systems
//! whose members are stepped in lanes: the same source compiles with the standard library and without.

macro_rules! every_way {
    ($(#[$doc:meta])* $name:ident $float:ident) => {
        $(#[$doc])*
        pub struct $name {
            /// A positive number.
            pub k: $float,
        }

        #[dalembert::rayleigh_system(rule = [midpoint, trapezoidal])]
        impl $name {
            /// L.
            pub fn lagrangian(&self, q: [$float; 2], v: [$float; 2]) -> $float {
                let kinetic: $float = v.iter().map(|v| 0.5 * v.powi(2)).sum();
                kinetic - Self::roots(self.k + q[0] * q[0]) - self.periodic(&q) - Self::growing(q[1] / (1.0 + q[1].abs()))
            }

            /// R.
            pub fn rayleigh(&self, q: [$float; 2], v: [$float; 2]) -> $float {
                let weights = q.map($float::cosh);
                0.5 * self.k.sqrt() * weights.into_iter().zip(v).map(|(weight, v)| weight * v * v).sum::<$float>()
            }

            /// f.
            pub fn force(&self, q: [$float; 2], v: [$float; 2]) -> [$float; 2] {
                [$float::tanh(v[1]), -$float::atan2(v[0], 2.0 + q[1].sin())]
            }

            fn roots(x: $float) -> $float {
                x.sqrt() + x.cbrt() + x.powf(1.5) + x.hypot(1.0) + x.ln() + x.log2() + x.log10() + x.ln_1p() + x.log(3.0)
            }

            fn periodic(&self, q: &[$float; 2]) -> $float {
                let (sine, cosine) = (q[0] + q[1]).sin_cos();
                let squares: $float = q.iter().map(|x| x.sin() * x.cos()).sum();
                sine * cosine + squares + (0.1 * sine).tan() + (0.5 * sine).asin() + (0.5 * cosine).acos() + q[0].atan()
            }

            fn growing(x: $float) -> $float {
                let sum = x.exp() + x.exp2() + x.exp_m1() + x.sinh() + x.cosh() + x.tanh();
                x.mul_add(0.5, sum) + x.asinh() + (2.0 + x).acosh() + (0.5 * x).atanh()
            }
        }
    };
}

every_way! {
    /// In `f64`.
    Double f64
}
every_way! {
    /// In `f32`.
    Single f32
}

macro_rules! in_lanes {
    ($(#[$doc:meta])* $name:ident $float:ident) => {
        $(#[$doc])*
        pub struct $name {
            /// A mass.
            pub m: $float,
        }

        #[dalembert::rayleigh_system(rule = [midpoint, trapezoidal, gauss], lanes = [explicit, midpoint, gauss])]
        impl $name {
            /// L.
            pub fn lagrangian(&self, q: [$float; 2], v: [$float; 2]) -> $float {
                0.5 * self.m * (v[0] * v[0] + v[1] * v[1]) + q[0].cos() - q[1].exp()
            }

            /// R.
            pub fn rayleigh(&self, v: [$float; 2]) -> $float {
                0.5 * self.m * v[1] * v[1]
            }
        }
    };
}

in_lanes! {
    /// Members in `f64`.
    DoubleMembers f64
}
in_lanes! {
    /// Members in `f32`.
    SingleMembers f32
}
