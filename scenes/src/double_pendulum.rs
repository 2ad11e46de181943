//! The plane double pendulum, angles from the vertical: a mass matrix that depends on q.
//!
//! ```text
//! L = ½(m1 + m2) l1² v1² + ½m2 l2² v2² + m2 l1 l2 v1 v2 cos(q1 − q2) + (m1 + m2) g l1 cos q1 + m2 g l2 cos q2
//! R = ½c1 v1² + ½c2 (v2 − v1)²
//! ```

macro_rules! double_pendulum {
    (
        $name:ident: $float:ident, $engine:ident, [$($rule:ident),*] $(, lanes = [$($lanes:ident),*])?
        $(, multiply_add = $multiply_add:ident)?
    ) => {
        /// Two point masses on massless rods, one hung from the other, with friction in both joints.
        #[derive(Clone, Copy, Debug)]
        pub struct $name {
            /// Masses.
            pub m: [$float; 2],
            /// Lengths.
            pub l: [$float; 2],
            /// Acceleration of gravity.
            pub g: $float,
            /// Friction coefficients of the joints.
            pub c: [$float; 2],
        }

        impl $name {
            /// The pendulum on which speed is measured.
            pub const MEASURED: Self = Self { m: [1.0, 0.7], l: [1.0, 0.8], g: 9.81, c: [0.05, 0.03] };
        }

        #[dalembert::rayleigh_system(
            rule = [$($rule),*], derivatives = $engine $(, lanes = [$($lanes),*])? $(, multiply_add = $multiply_add)?
        )]
        impl $name {
            fn lagrangian(&self, q: [$float; 2], v: [$float; 2]) -> $float {
                let [m1, m2] = self.m;
                let [l1, l2] = self.l;
                let kinetic = 0.5 * (m1 + m2) * (l1 * v[0]).powi(2)
                    + 0.5 * m2 * (l2 * v[1]).powi(2)
                    + m2 * l1 * l2 * v[0] * v[1] * (q[0] - q[1]).cos();
                kinetic + self.g * ((m1 + m2) * l1 * q[0].cos() + m2 * l2 * q[1].cos())
            }

            fn rayleigh(&self, v: [$float; 2]) -> $float {
                0.5 * self.c[0] * v[0].powi(2) + 0.5 * self.c[1] * (v[1] - v[0]).powi(2)
            }
        }
    };
}

impl crate::DoublePendulum {
    /// Parameters without accidental coincidences.
    pub const EXAMPLE: Self = Self { m: [1.3, 0.6], l: [0.9, 1.1], g: 2.3, c: [0.25, 0.15] };
    /// The example without friction.
    pub const FREE: Self = Self { c: [0.0, 0.0], ..Self::EXAMPLE };

    /// Masses, lengths and gravity 1, with one friction coefficient.
    #[must_use]
    pub const fn of_units(c: f64) -> Self {
        Self { m: [1.0; 2], l: [1.0; 2], g: 1.0, c: [c; 2] }
    }
}
