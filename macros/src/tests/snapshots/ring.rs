impl Ring {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let s = q[0] * q[0] + q[1] * q[1];
        0.5 * (v[0] * v[0] + v[1] * v[1]) - s * (s - 1.0).powi(2)
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.k * (v[0] * v[0] + v[1] * v[1])
    }
}
::dalembert::generated::described! {
    Ring : f64, 2; described_Ring $
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
    impl ::dalembert::generated::PlainFields for Ring {
        #[cold]
        fn first_no_number(
            &self,
        ) -> ::core::option::Option<(::dalembert::generated::Quantity, usize)> {
            let fields: [(&'static str, &dyn ::dalembert::generated::Plain<f64>); 1] = [
                ("k", &(self.k)),
            ];
            ::dalembert::generated::missing::field(&fields)
        }
    }
    /// Known at compile time:
    /// - Derivatives are written out.
    /// - L = T(v) − V(q).
    /// - The mass matrix ∂²L/∂v² is constant.
    /// - The damping force −∂R/∂v is linear in v with constant coefficients.
    /// - By the rule `Midpoint` the Newton matrix changes with the state.
    #[automatically_derived]
    impl Lagrangian<2> for Ring {
        type Scalar = f64;
        const STRUCTURE: ::dalembert::generated::Structure = ::dalembert::generated::Structure::UNKNOWN
            .with_engine(::dalembert::generated::Engine::Expanded)
            .with_constant_mass_matrix()
            .with_separable_lagrangian()
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
            let s = q[0] * q[0] + q[1] * q[1];
            let t1 = s - 1.0;
            let t1_squared = t1 * t1;
            let t2 = t1_squared + 2.0 * s * t1;
            Gradient {
                value: 0.5 * (v[0] * v[0] + v[1] * v[1]) - s * t1_squared,
                d1: SVector::from([-2.0 * q[0] * t2, -2.0 * q[1] * t2]),
                d2: SVector::from([v[0], v[1]]),
            }
        }
        #[inline]
        fn lagrangian_derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<f64, 2> {
            let s = q[0] * q[0] + q[1] * q[1];
            let t1 = s - 1.0;
            let t1_squared = t1 * t1;
            let t2 = 2.0 * q[1];
            let t3 = 2.0 * q[0];
            let t4 = 2.0 * s;
            let t5 = t4 + 4.0 * t1;
            let t6 = t2 * t5;
            let t7 = -t3 * t6;
            let t8 = t1_squared + t1 * t4;
            let t9 = 2.0 * t8;
            Derivatives {
                value: 0.5 * (v[0] * v[0] + v[1] * v[1]) - s * t1_squared,
                d1: SVector::from([-t3 * t8, -t2 * t8]),
                d2: SVector::from([v[0], v[1]]),
                d11: SMatrix::from([[-(t9 + t3 * t3 * t5), t7], [t7, -(t2 * t6 + t9)]]),
                d12: SMatrix::zeros(),
                d22: SMatrix::from([[1.0, 0.0], [0.0, 1.0]]),
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
    impl Rayleigh<2> for Ring {
        #[inline]
        fn rayleigh(&self, _q: &Vector, v: &Vector) -> f64 {
            self.rayleigh((*v).into())
        }
        #[inline]
        fn rayleigh_gradient(&self, _q: &Vector, v: &Vector) -> Gradient<f64, 2> {
            let k = self.k;
            Gradient {
                value: 0.5 * k * (v[0] * v[0] + v[1] * v[1]),
                d1: SVector::zeros(),
                d2: SVector::from([k * v[0], k * v[1]]),
            }
        }
        #[inline]
        fn rayleigh_derivatives(&self, _q: &Vector, v: &Vector) -> Derivatives<f64, 2> {
            let k = self.k;
            Derivatives {
                value: 0.5 * k * (v[0] * v[0] + v[1] * v[1]),
                d1: SVector::zeros(),
                d2: SVector::from([k * v[0], k * v[1]]),
                d11: SMatrix::zeros(),
                d12: SMatrix::zeros(),
                d22: SMatrix::from([[k, 0.0], [0.0, k]]),
            }
        }
    }
    #[automatically_derived]
    impl ActingForce<2> for Ring {
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
    impl Fused<Midpoint, 2> for Ring {
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
            let s = q[0] * q[0] + q[1] * q[1];
            let t1 = s - 1.0;
            let k = self.k;
            let t2 = 2.0 * q[1];
            let t3 = 2.0 * q[0];
            let t4 = 2.0 * s;
            let t5 = t4 + 4.0 * t1;
            let t6 = t2 * t5;
            let t7 = 1.0 + k * half;
            let t8 = half * half;
            let t9 = t1 * (t1 + t4);
            let t10 = 2.0 * t9;
            let t11 = t8 * t3 * t6;
            StepKernel {
                p0: SVector::from([
                    v[0] + half * (k * v[0] + t3 * t9),
                    v[1] + half * (k * v[1] + t2 * t9),
                ]),
                matrix: SMatrix::from([
                    [t7 + t8 * (t3 * t3 * t5 + t10), t11],
                    [t11, t7 + t8 * (t2 * t6 + t10)],
                ]),
            }
        }
        /// p0 = −D1 L_d − f_d⁻ and p1 = D2 L_d + f_d⁺.
        #[inline]
        fn momenta(&self, segment: &Segment<f64, 2>) -> Momenta<f64, 2> {
            let (q0, v, h) = (&segment.q0, &segment.v, segment.h);
            let half = 0.5 * h;
            let q = [q0[0] + half * v[0], q0[1] + half * v[1]];
            let s = q[0] * q[0] + q[1] * q[1];
            let t1 = s - 1.0;
            let k = self.k;
            let t2 = t1 * (t1 + 2.0 * s);
            let t3 = half * (k * v[0] + 2.0 * q[0] * t2);
            let t4 = half * (k * v[1] + 2.0 * q[1] * t2);
            Momenta {
                p0: SVector::from([v[0] + t3, v[1] + t4]),
                p1: SVector::from([v[0] - t3, v[1] - t4]),
            }
        }
    }
    #[automatically_derived]
    impl ::dalembert::generated::OffersMethods<2> for Ring {
        type Methods = Midpoint;
    }
};
