impl DoublePendulum {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let [m1, m2] = self.m;
        let [l1, l2] = self.l;
        let kinetic = 0.5 * (m1 + m2) * l1 * l1 * v[0] * v[0]
            + 0.5 * m2 * l2 * l2 * v[1] * v[1]
            + m2 * l1 * l2 * (q[0] - q[1]).cos() * v[0] * v[1];
        let potential = -(m1 + m2) * self.g * l1 * q[0].cos()
            - m2 * self.g * l2 * q[1].cos();
        kinetic - potential
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        let relative = v[1] - v[0];
        0.5 * self.c[0] * v[0] * v[0] + 0.5 * self.c[1] * relative * relative
    }
}
::dalembert::generated::described! {
    DoublePendulum : f64, 2; described_DoublePendulum $
}
#[allow(
    clippy::all,
    clippy::pedantic,
    clippy::nursery,
    nonstandard_style,
    unused_variables,
    unreachable_patterns
)]
const _: () = {
    use ::dalembert::nalgebra::{SMatrix, SVector};
    use ::dalembert::generated::{
        ActingForce, Derivatives, Fused, Gradient, Lagrangian, Midpoint, Momenta,
        Rayleigh, Segment, StepKernel,
    };
    type Vector = SVector<f64, 2>;
    impl ::dalembert::generated::PlainFields for DoublePendulum {
        #[cold]
        fn first_no_number(
            &self,
        ) -> ::core::option::Option<(::dalembert::generated::Quantity, usize)> {
            let fields: [(&'static str, &dyn ::dalembert::generated::Plain<f64>); 7] = [
                ("m[0]", &(self.m[0])),
                ("m[1]", &(self.m[1])),
                ("l[0]", &(self.l[0])),
                ("l[1]", &(self.l[1])),
                ("g", &(self.g)),
                ("c[0]", &(self.c[0])),
                ("c[1]", &(self.c[1])),
            ];
            ::dalembert::generated::missing::field(&fields)
        }
    }
    /// Known at compile time:
    /// - Derivatives are written out.
    /// - The damping force −∂R/∂v is linear in v with constant coefficients.
    /// - By the rule `Midpoint` the Newton matrix changes with the state.
    #[automatically_derived]
    impl Lagrangian<2> for DoublePendulum {
        type Scalar = f64;
        const STRUCTURE: ::dalembert::generated::Structure = ::dalembert::generated::Structure::UNKNOWN
            .with_engine(::dalembert::generated::Engine::Expanded)
            .with_damping(::dalembert::generated::Damping::Linear)
            .with_newton_matrices(
                &[::dalembert::generated::NewtonStructure::new("Midpoint", false, 1)],
            );
        #[inline]
        fn lagrangian(&self, q: &Vector, v: &Vector) -> f64 {
            self.lagrangian((*q).into(), (*v).into())
        }
        #[inline]
        fn lagrangian_gradient(&self, q: &Vector, v: &Vector) -> Gradient<f64, 2> {
            let m2 = self.m[1];
            let t1 = self.m[0] + m2;
            let l1 = self.l[0];
            let l2 = self.l[1];
            let t2 = q[0] - q[1];
            let (sin_t2, cos_t2) = t2.sin_cos();
            let t3 = m2 * l1 * l2;
            let t4 = t3 * cos_t2;
            let t5 = v[0] * t4;
            let kinetic = 0.5 * t1 * l1 * l1 * v[0] * v[0]
                + 0.5 * m2 * l2 * l2 * v[1] * v[1] + v[1] * t5;
            let (sin_q0, cos_q0) = q[0].sin_cos();
            let g = self.g;
            let t6 = -t1 * g * l1;
            let (sin_q1, cos_q1) = q[1].sin_cos();
            let t7 = m2 * g * l2;
            let potential = t6 * cos_q0 - t7 * cos_q1;
            let t8 = t3 * v[0] * v[1] * sin_t2;
            Gradient {
                value: kinetic - potential,
                d1: SVector::from([t6 * sin_q0 - t8, t8 - t7 * sin_q1]),
                d2: SVector::from([
                    v[1] * t4 + t1 * l1 * l1 * v[0],
                    t5 + m2 * l2 * l2 * v[1],
                ]),
            }
        }
        #[inline]
        fn lagrangian_derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<f64, 2> {
            let m2 = self.m[1];
            let t1 = self.m[0] + m2;
            let l1 = self.l[0];
            let l2 = self.l[1];
            let t2 = q[0] - q[1];
            let (sin_t2, cos_t2) = t2.sin_cos();
            let t3 = m2 * l1 * l2;
            let t4 = t3 * cos_t2;
            let t5 = v[0] * t4;
            let kinetic = 0.5 * t1 * l1 * l1 * v[0] * v[0]
                + 0.5 * m2 * l2 * l2 * v[1] * v[1] + v[1] * t5;
            let (sin_q0, cos_q0) = q[0].sin_cos();
            let g = self.g;
            let t6 = -t1 * g * l1;
            let t7 = t6 * cos_q0;
            let (sin_q1, cos_q1) = q[1].sin_cos();
            let t8 = m2 * g * l2;
            let t9 = t8 * cos_q1;
            let potential = t7 - t9;
            let t10 = v[0] * v[1];
            let t11 = t3 * t10 * sin_t2;
            let t12 = t3 * v[1] * sin_t2;
            let t13 = t3 * v[0] * sin_t2;
            let t14 = t4 * t10;
            let t15 = m2 * l2 * l2;
            let t16 = t1 * l1 * l1;
            Derivatives {
                value: kinetic - potential,
                d1: SVector::from([t6 * sin_q0 - t11, t11 - t8 * sin_q1]),
                d2: SVector::from([v[1] * t4 + t16 * v[0], t5 + t15 * v[1]]),
                d11: SMatrix::from([[t7 - t14, t14], [t14, -(t9 + t14)]]),
                d12: SMatrix::from([[-t12, t12], [-t13, t13]]),
                d22: SMatrix::from([[t16, t4], [t4, t15]]),
            }
        }
        fn verify_generated(
            &self,
            q: &Vector,
            v: &Vector,
        ) -> ::core::result::Result<(), ::dalembert::generated::GeneratedDiffers> {
            ::dalembert::generated::verification::lagrangian(self, q, v)?;
            ::dalembert::generated::verification::rayleigh(self, q, v)
        }
        fn verify_slopes(
            &self,
            q: &Vector,
            v: &Vector,
        ) -> ::core::result::Result<(), ::dalembert::generated::GeneratedDiffers> {
            ::dalembert::generated::verification::lagrangian_slope(self, q, v)?;
            ::dalembert::generated::verification::rayleigh_slope(self, q, v)
        }
        #[cold]
        fn non_finite_value(
            &self,
        ) -> ::core::option::Option<(::dalembert::generated::Quantity, usize)> {
            ::dalembert::generated::PlainFields::first_no_number(self)
        }
        #[cold]
        fn massless_force(
            &self,
            q: &Vector,
            v: &Vector,
        ) -> ::core::option::Option<
            ::dalembert::generated::CovectorDerivatives<f64, 2>,
        > {
            ::core::option::Option::Some(
                ActingForce::acting_force_derivatives(self, q, v),
            )
        }
    }
    #[automatically_derived]
    impl Rayleigh<2> for DoublePendulum {
        #[inline]
        fn rayleigh(&self, _q: &Vector, v: &Vector) -> f64 {
            self.rayleigh((*v).into())
        }
        #[inline]
        fn rayleigh_gradient(&self, _q: &Vector, v: &Vector) -> Gradient<f64, 2> {
            let relative = v[1] - v[0];
            let c_0 = self.c[0];
            let c_1 = self.c[1];
            let dr_drelative = c_1 * relative;
            Gradient {
                value: 0.5 * c_0 * v[0] * v[0] + 0.5 * c_1 * relative * relative,
                d1: SVector::zeros(),
                d2: SVector::from([c_0 * v[0] - dr_drelative, dr_drelative]),
            }
        }
        #[inline]
        fn rayleigh_derivatives(&self, _q: &Vector, v: &Vector) -> Derivatives<f64, 2> {
            let relative = v[1] - v[0];
            let c_0 = self.c[0];
            let c_1 = self.c[1];
            let t1 = -c_1;
            let dr_drelative = c_1 * relative;
            Derivatives {
                value: 0.5 * c_0 * v[0] * v[0] + 0.5 * c_1 * relative * relative,
                d1: SVector::zeros(),
                d2: SVector::from([c_0 * v[0] - dr_drelative, dr_drelative]),
                d11: SMatrix::zeros(),
                d12: SMatrix::zeros(),
                d22: SMatrix::from([[c_0 + c_1, t1], [t1, c_1]]),
            }
        }
    }
    #[automatically_derived]
    impl ActingForce<2> for DoublePendulum {
        const HAS_RAYLEIGH: bool = true;
        #[inline]
        fn dissipation(&self, q: &Vector, v: &Vector) -> Gradient<f64, 2> {
            self.rayleigh_gradient(q, v)
        }
        #[inline]
        fn dissipation_derivatives(
            &self,
            q: &Vector,
            v: &Vector,
        ) -> Derivatives<f64, 2> {
            self.rayleigh_derivatives(q, v)
        }
    }
    #[automatically_derived]
    impl Fused<Midpoint, 2> for DoublePendulum {
        type Matrix = SMatrix<f64, 2, 2>;
        type Memory = ::dalembert::generated::VelocityHistory<f64, 2>;
        type Border = ::dalembert::generated::Free;
        const WRITTEN_OUT: bool = true;
        /// p0 = −D1 L_d − f_d⁻ and ∂p0/∂v̄.
        #[inline]
        fn step_kernel(&self, segment: &Segment<f64, 2>) -> StepKernel<f64, 2> {
            let (q0, v, h) = (&segment.q0, &segment.v, segment.h);
            let half = 0.5 * h;
            let q = [q0[0] + half * v[0], q0[1] + half * v[1]];
            let m2 = self.m[1];
            let t1 = self.m[0] + m2;
            let l1 = self.l[0];
            let l2 = self.l[1];
            let t2 = q[0] - q[1];
            let (sin_t2, cos_t2) = t2.sin_cos();
            let t3 = m2 * l1 * l2;
            let t4 = t3 * cos_t2;
            let (sin_q0, cos_q0) = q[0].sin_cos();
            let g = self.g;
            let t5 = -t1 * g * l1;
            let (sin_q1, cos_q1) = q[1].sin_cos();
            let t6 = m2 * g * l2;
            let relative = v[1] - v[0];
            let c_0 = self.c[0];
            let c_1 = self.c[1];
            let t7 = v[0] * v[1];
            let t8 = t3 * t7 * sin_t2;
            let t9 = t4 * t7;
            let t10 = m2 * l2 * l2;
            let t11 = t1 * l1 * l1;
            let dr_drelative = c_1 * relative;
            let t12 = c_1 * half;
            let t13 = t4 - t12;
            let t14 = half * half;
            let t15 = t14 * t9;
            let t16 = t3 * half;
            let t17 = t16 * v[0] * sin_t2;
            let t18 = t16 * v[1] * sin_t2;
            StepKernel {
                p0: SVector::from([
                    v[1] * t4 + t11 * v[0]
                        - half * (t5 * sin_q0 - t8 - c_0 * v[0] + dr_drelative),
                    v[0] * t4 + t10 * v[1] - half * (t8 - t6 * sin_q1 - dr_drelative),
                ]),
                matrix: SMatrix::from([
                    [
                        t11 + (c_0 + c_1) * half - t14 * (t5 * cos_q0 - t9),
                        t13 - t17 - t18 - t15,
                    ],
                    [t13 + t17 + t18 - t15, t14 * (t6 * cos_q1 + t9) + (t10 + t12)],
                ]),
            }
        }
        /// p0 = −D1 L_d − f_d⁻ and p1 = D2 L_d + f_d⁺.
        #[inline]
        fn momenta(&self, segment: &Segment<f64, 2>) -> Momenta<f64, 2> {
            let (q0, v, h) = (&segment.q0, &segment.v, segment.h);
            let half = 0.5 * h;
            let q = [q0[0] + half * v[0], q0[1] + half * v[1]];
            let m2 = self.m[1];
            let l1 = self.l[0];
            let l2 = self.l[1];
            let t1 = q[0] - q[1];
            let (sin_t1, cos_t1) = t1.sin_cos();
            let t2 = m2 * l1 * l2;
            let t3 = t2 * cos_t1;
            let g = self.g;
            let relative = v[1] - v[0];
            let t4 = t2 * v[0] * v[1] * sin_t1;
            let t5 = m2 * l2;
            let t6 = v[0] * t3 + l2 * t5 * v[1];
            let t7 = (self.m[0] + m2) * l1;
            let t8 = v[1] * t3 + l1 * t7 * v[0];
            let dr_drelative = self.c[1] * relative;
            let t9 = half * (dr_drelative - g * t7 * q[0].sin() - t4 - self.c[0] * v[0]);
            let t10 = half * (t4 - g * t5 * q[1].sin() - dr_drelative);
            Momenta {
                p0: SVector::from([t8 - t9, t6 - t10]),
                p1: SVector::from([t8 + t9, t6 + t10]),
            }
        }
    }
    #[automatically_derived]
    impl ::dalembert::generated::OffersMethods<2> for DoublePendulum {
        type Methods = Midpoint;
    }
};
