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
        ActingForce, Derivatives, Discrete, DiscreteForce, DiscreteForceDerivatives,
        DiscreteRayleigh, DisplacementRule, Gradient, Lagrangian, Midpoint, Momenta,
        Rayleigh, StepKernel,
    };
    type Vector = SVector<f64, 2>;
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
            let (t4, t3) = t2.sin_cos();
            let t5 = l2 * (m2 * l1);
            let t6 = t3 * t5;
            let t7 = v[0] * t6;
            let kinetic = v[0] * (v[0] * (l1 * (0.5 * t1 * l1)))
                + v[1] * (v[1] * (l2 * (0.5 * m2 * l2))) + v[1] * t7;
            let (sin_q0, cos_q0) = q[0].sin_cos();
            let g = self.g;
            let t8 = l1 * (-t1 * g);
            let (sin_q1, cos_q1) = q[1].sin_cos();
            let t9 = l2 * (m2 * g);
            let potential = cos_q0 * t8 - cos_q1 * t9;
            let t10 = t4 * (v[1] * (v[0] * t5));
            Gradient {
                value: kinetic - potential,
                d1: SVector::from([t8 * sin_q0 - t10, t10 - t9 * sin_q1]),
                d2: SVector::from([
                    v[1] * t6 + v[0] * (l1 * (t1 * l1)),
                    t7 + v[1] * (l2 * (m2 * l2)),
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
            let (t4, t3) = t2.sin_cos();
            let t5 = l2 * (m2 * l1);
            let t6 = t3 * t5;
            let t7 = v[0] * t6;
            let kinetic = v[0] * (v[0] * (l1 * (0.5 * t1 * l1)))
                + v[1] * (v[1] * (l2 * (0.5 * m2 * l2))) + v[1] * t7;
            let (sin_q0, cos_q0) = q[0].sin_cos();
            let g = self.g;
            let t8 = l1 * (-t1 * g);
            let t9 = cos_q0 * t8;
            let (sin_q1, cos_q1) = q[1].sin_cos();
            let t10 = l2 * (m2 * g);
            let t11 = cos_q1 * t10;
            let potential = t9 - t11;
            let t12 = v[0] * v[1];
            let t13 = t5 * t12 * t4;
            let t14 = t4 * (v[1] * t5);
            let t15 = t4 * (v[0] * t5);
            let t16 = t6 * t12;
            let t17 = l2 * (m2 * l2);
            let t18 = l1 * (t1 * l1);
            Derivatives {
                value: kinetic - potential,
                d1: SVector::from([t8 * sin_q0 - t13, t13 - t10 * sin_q1]),
                d2: SVector::from([v[1] * t6 + v[0] * t18, t7 + v[1] * t17]),
                d11: SMatrix::from([[t9 - t16, t16], [t16, -(t11 + t16)]]),
                d12: SMatrix::from([[-t14, t14], [-t15, t15]]),
                d22: SMatrix::from([[t18, t6], [t6, t17]]),
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
            let dr_drelative = relative * c_1;
            Gradient {
                value: v[0] * (v[0] * (0.5 * c_0)) + relative * (relative * (0.5 * c_1)),
                d1: SVector::from([0.0, 0.0]),
                d2: SVector::from([v[0] * c_0 - dr_drelative, dr_drelative]),
            }
        }
        #[inline]
        fn rayleigh_derivatives(&self, _q: &Vector, v: &Vector) -> Derivatives<f64, 2> {
            let relative = v[1] - v[0];
            let c_0 = self.c[0];
            let c_1 = self.c[1];
            let t1 = -c_1;
            let dr_drelative = relative * c_1;
            Derivatives {
                value: v[0] * (v[0] * (0.5 * c_0)) + relative * (relative * (0.5 * c_1)),
                d1: SVector::from([0.0, 0.0]),
                d2: SVector::from([v[0] * c_0 - dr_drelative, dr_drelative]),
                d11: SMatrix::from([[0.0, 0.0], [0.0, 0.0]]),
                d12: SMatrix::from([[0.0, 0.0], [0.0, 0.0]]),
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
    impl Discrete<Midpoint, 2> for DoublePendulum {
        type Matrix = SMatrix<f64, 2, 2>;
        type Memory = ::dalembert::generated::VelocityHistory<f64, 2>;
        /// L_d = h L(q̄, v̄), with q̄ = (q0 + q1)/2 and v̄ = (q1 − q0)/h.
        fn discrete_lagrangian(&self, q0: &Vector, q1: &Vector, h: f64) -> f64 {
            Midpoint::discrete_lagrangian(self, q0, q1, h)
        }
        /// L_d with D1, D2, D11, D12, D22.
        fn discrete_lagrangian_derivatives(
            &self,
            q0: &Vector,
            q1: &Vector,
            h: f64,
        ) -> Derivatives<f64, 2> {
            Midpoint::discrete_lagrangian_derivatives(self, q0, q1, h)
        }
        /// f_d⁻ = D1 R_d, f_d⁺ = −D2 R_d.
        fn discrete_force(
            &self,
            q0: &Vector,
            q1: &Vector,
            h: f64,
        ) -> DiscreteForce<f64, 2> {
            Midpoint::rayleigh_force(self, q0, q1, h)
        }
        /// f_d with its derivatives by q0 and q1.
        fn discrete_force_derivatives(
            &self,
            q0: &Vector,
            q1: &Vector,
            h: f64,
        ) -> DiscreteForceDerivatives<f64, 2> {
            Midpoint::rayleigh_force_derivatives(self, q0, q1, h)
        }
        /// p0 = −D1 L_d − f_d⁻ and ∂p0/∂v̄, at q1 = q0 + h v̄.
        #[inline]
        fn step_kernel(&self, q0: &Vector, v: &Vector, h: f64) -> StepKernel<f64, 2> {
            let half = 0.5 * h;
            let q = [q0[0] + half * v[0], q0[1] + half * v[1]];
            let m2 = self.m[1];
            let t1 = self.m[0] + m2;
            let l1 = self.l[0];
            let l2 = self.l[1];
            let t2 = q[0] - q[1];
            let (t4, t3) = t2.sin_cos();
            let t5 = l2 * (m2 * l1);
            let t6 = t3 * t5;
            let (sin_q0, cos_q0) = q[0].sin_cos();
            let g = self.g;
            let t7 = l1 * (-t1 * g);
            let (sin_q1, cos_q1) = q[1].sin_cos();
            let t8 = l2 * (m2 * g);
            let relative = v[1] - v[0];
            let c_0 = self.c[0];
            let c_1 = self.c[1];
            let t9 = v[0] * v[1];
            let t10 = t5 * t9 * t4;
            let t11 = t6 * t9;
            let t12 = l2 * (m2 * l2);
            let t13 = l1 * (t1 * l1);
            let dr_drelative = relative * c_1;
            let t14 = c_1 * half;
            let t15 = t6 - t14;
            let t16 = half * half;
            let t17 = t11 * t16;
            let t18 = t5 * half;
            let t19 = t4 * (v[0] * t18);
            let t20 = t4 * (v[1] * t18);
            StepKernel {
                p0: SVector::from([
                    v[1] * t6 + v[0] * t13
                        - half * (dr_drelative + (t7 * sin_q0 - t10 - v[0] * c_0)),
                    v[0] * t6 + v[1] * t12 - half * (t10 - t8 * sin_q1 - dr_drelative),
                ]),
                matrix: SMatrix::from([
                    [
                        t13 + (c_0 + c_1) * half - (cos_q0 * t7 - t11) * t16,
                        t15 - t19 - t20 - t17,
                    ],
                    [t20 + (t15 + t19) - t17, (cos_q1 * t8 + t11) * t16 + (t12 + t14)],
                ]),
            }
        }
        /// p0 = −D1 L_d − f_d⁻ and p1 = D2 L_d + f_d⁺, at q1 = q0 + h v̄.
        #[inline]
        fn momenta(&self, q0: &Vector, v: &Vector, h: f64) -> Momenta<f64, 2> {
            let half = 0.5 * h;
            let q = [q0[0] + half * v[0], q0[1] + half * v[1]];
            let m2 = self.m[1];
            let l1 = self.l[0];
            let l2 = self.l[1];
            let t1 = q[0] - q[1];
            let (t3, t2) = t1.sin_cos();
            let t4 = l2 * (m2 * l1);
            let t5 = t2 * t4;
            let g = self.g;
            let relative = v[1] - v[0];
            let t6 = t3 * (v[1] * (v[0] * t4));
            let t7 = m2 * l2;
            let t8 = v[0] * t5 + v[1] * (l2 * t7);
            let t9 = (self.m[0] + m2) * l1;
            let t10 = v[1] * t5 + v[0] * (l1 * t9);
            let dr_drelative = relative * self.c[1];
            let t11 = half
                * (dr_drelative - q[0].sin() * (g * t9) - t6 - v[0] * self.c[0]);
            let t12 = half * (t6 - q[1].sin() * (g * t7) - dr_drelative);
            Momenta {
                p0: SVector::from([t10 - t11, t8 - t12]),
                p1: SVector::from([t10 + t11, t8 + t12]),
            }
        }
        /// E_L on the segment.
        fn segment_energy(&self, q0: &Vector, q1: &Vector, h: f64) -> f64 {
            Midpoint::segment_energy(self, q0, q1, h)
        }
        fn verify_segment(
            &self,
            q0: &Vector,
            v: &Vector,
            h: f64,
        ) -> ::core::result::Result<(), ::dalembert::generated::GeneratedDiffers> {
            Midpoint::verify_segment(self, q0, v, h)
        }
    }
    #[automatically_derived]
    impl DiscreteRayleigh<Midpoint, 2> for DoublePendulum {
        /// R_d = (h²/2) R(q̄, v̄), with q̄ = (q0 + q1)/2 and v̄ = (q1 − q0)/h.
        fn discrete_rayleigh(&self, q0: &Vector, q1: &Vector, h: f64) -> f64 {
            Midpoint::discrete_rayleigh(self, q0, q1, h)
        }
        /// R_d with D1, D2, D11, D12, D22.
        fn discrete_rayleigh_derivatives(
            &self,
            q0: &Vector,
            q1: &Vector,
            h: f64,
        ) -> Derivatives<f64, 2> {
            Midpoint::discrete_rayleigh_derivatives(self, q0, q1, h)
        }
    }
    #[automatically_derived]
    impl ::dalembert::generated::OffersMethods<2> for DoublePendulum {
        type Methods = Midpoint;
    }
};
