impl Pendulum {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        use ::dalembert::generated::Elementary as _;
        0.5 * v[0].elementary().powi(2) - self.height(q[0])
    }
    fn height(&self, angle: f64) -> f64 {
        self.g * (1.0 - <f64 as ::dalembert::generated::Elementary>::cos(angle))
    }
    fn period(&self) -> f64 {
        6.0 / self.g
    }
}
::dalembert::generated::described! {
    Pendulum : f64, 1; described_Pendulum $
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
        Segment, StepKernel,
    };
    use ::dalembert::generated::Elementary as _;
    type Vector = SVector<f64, 1>;
    impl ::dalembert::generated::PlainFields for Pendulum {
        #[cold]
        fn first_no_number(
            &self,
        ) -> ::core::option::Option<(::dalembert::generated::Quantity, usize)> {
            let fields: [(&'static str, &dyn ::dalembert::generated::Plain<f64>); 1] = [
                ("g", &(self.g)),
            ];
            ::dalembert::generated::missing::field(&fields)
        }
    }
    /// Known at compile time:
    /// - Derivatives are written out.
    /// - L = T(v) − V(q).
    /// - The mass matrix ∂²L/∂v² is constant.
    /// - By the rule `Midpoint` the Newton matrix changes with the state.
    #[automatically_derived]
    impl Lagrangian<1> for Pendulum {
        type Scalar = f64;
        const STRUCTURE: ::dalembert::generated::Structure = ::dalembert::generated::Structure::UNKNOWN
            .with_engine(::dalembert::generated::Engine::Expanded)
            .with_constant_mass_matrix()
            .with_separable_lagrangian()
            .with_damping(::dalembert::generated::Damping::Absent)
            .with_newton_matrices(
                &[::dalembert::generated::NewtonStructure::new("Midpoint", false, 0)],
            );
        #[inline]
        fn lagrangian(&self, q: &Vector, v: &Vector) -> f64 {
            self.lagrangian((*q).into(), (*v).into())
        }
        #[inline]
        fn lagrangian_gradient(&self, q: &Vector, v: &Vector) -> Gradient<f64, 1> {
            let (sin_q0, cos_q0) = q[0].elementary().sin_cos();
            let g = self.g;
            Gradient {
                value: 0.5 * (v[0] * v[0]) - g * (1.0 - cos_q0),
                d1: SVector::from([-g * sin_q0]),
                d2: SVector::from([v[0]]),
            }
        }
        #[inline]
        fn lagrangian_derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<f64, 1> {
            let (sin_q0, cos_q0) = q[0].elementary().sin_cos();
            let g = self.g;
            Derivatives {
                value: 0.5 * (v[0] * v[0]) - g * (1.0 - cos_q0),
                d1: SVector::from([-g * sin_q0]),
                d2: SVector::from([v[0]]),
                d11: SMatrix::from([[-g * cos_q0]]),
                d12: SMatrix::zeros(),
                d22: SMatrix::from([[1.0]]),
            }
        }
        fn verify_generated(
            &self,
            q: &Vector,
            v: &Vector,
        ) -> ::core::result::Result<(), ::dalembert::generated::GeneratedDiffers> {
            ::dalembert::generated::verification::lagrangian(self, q, v)
        }
        fn verify_slopes(
            &self,
            q: &Vector,
            v: &Vector,
        ) -> ::core::result::Result<(), ::dalembert::generated::GeneratedDiffers> {
            ::dalembert::generated::verification::lagrangian_slope(self, q, v)
        }
        #[cold]
        fn non_finite_value(
            &self,
        ) -> ::core::option::Option<(::dalembert::generated::Quantity, usize)> {
            ::dalembert::generated::PlainFields::first_no_number(self)
        }
    }
    #[automatically_derived]
    impl ActingForce<1> for Pendulum {}
    #[automatically_derived]
    impl Fused<Midpoint, 1> for Pendulum {
        type Matrix = SMatrix<f64, 1, 1>;
        type Memory = ::dalembert::generated::VelocityHistory<f64, 1>;
        type Border = ::dalembert::generated::Free;
        const WRITTEN_OUT: bool = true;
        /// p0 = −D1 L_d − f_d⁻ and ∂p0/∂v̄.
        #[inline]
        fn step_kernel(&self, segment: &Segment<f64, 1>) -> StepKernel<f64, 1> {
            let (q0, v, h) = (&segment.q0, &segment.v, segment.h);
            let half = 0.5 * h;
            let q = [q0[0] + half * v[0]];
            let (sin_q0, cos_q0) = q[0].elementary().sin_cos();
            let t1 = self.g * half;
            StepKernel {
                p0: SVector::from([v[0] + t1 * sin_q0]),
                matrix: SMatrix::from([[1.0 + half * t1 * cos_q0]]),
            }
        }
        /// p0 = −D1 L_d − f_d⁻ and p1 = D2 L_d + f_d⁺.
        #[inline]
        fn momenta(&self, segment: &Segment<f64, 1>) -> Momenta<f64, 1> {
            let (q0, v, h) = (&segment.q0, &segment.v, segment.h);
            let half = 0.5 * h;
            let q = [q0[0] + half * v[0]];
            let t1 = self.g * half * q[0].elementary().sin();
            Momenta {
                p0: SVector::from([v[0] + t1]),
                p1: SVector::from([v[0] - t1]),
            }
        }
    }
    #[automatically_derived]
    impl ::dalembert::generated::OffersMethods<1> for Pendulum {
        type Methods = Midpoint;
    }
};
