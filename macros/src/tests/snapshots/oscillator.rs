/// L and R of a damped oscillator.
pub fn oscillator(q: [f64; 1], v: [f64; 1], m: f64, k: f64, r: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
}
/// The mechanical system of [`oscillator`], with its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(dead_code)]
pub struct Oscillator {
    /// Parameter `m` of [`oscillator`].
    pub m: f64,
    /// Parameter `k` of [`oscillator`].
    pub k: f64,
    /// Parameter `r` of [`oscillator`].
    pub r: f64,
}
::dalembert::generated::described! {
    Oscillator : f64, 1; described_Oscillator $
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
        Rayleigh, Segment, StepKernel, Trapezoidal,
    };
    type Vector = SVector<f64, 1>;
    impl ::dalembert::generated::PlainFields for Oscillator {
        #[cold]
        fn first_no_number(
            &self,
        ) -> ::core::option::Option<(::dalembert::generated::Quantity, usize)> {
            let fields: [(&'static str, &dyn ::dalembert::generated::Plain<f64>); 3] = [
                ("m", &(self.m)),
                ("k", &(self.k)),
                ("r", &(self.r)),
            ];
            ::dalembert::generated::missing::field(&fields)
        }
    }
    /// Known at compile time:
    /// - Derivatives are written out.
    /// - L = T(v) − V(q), of degree at most 2.
    /// - The mass matrix ∂²L/∂v² is constant.
    /// - The damping force −∂R/∂v is linear in v with constant coefficients.
    /// - By the rule `Midpoint` the Newton matrix is constant: a step is one linear solve.
    /// - By the rule `Trapezoidal` the Newton matrix is constant: a step is one linear solve.
    #[automatically_derived]
    impl Lagrangian<1> for Oscillator {
        type Scalar = f64;
        const STRUCTURE: ::dalembert::generated::Structure = ::dalembert::generated::Structure::UNKNOWN
            .with_engine(::dalembert::generated::Engine::Expanded)
            .with_constant_mass_matrix()
            .with_quadratic_lagrangian()
            .with_separable_lagrangian()
            .with_damping(::dalembert::generated::Damping::Linear)
            .with_newton_matrices(
                &[
                    ::dalembert::generated::NewtonStructure::new("Midpoint", true, 0),
                    ::dalembert::generated::NewtonStructure::new("Trapezoidal", true, 0),
                ],
            );
        #[inline]
        fn lagrangian(&self, q: &Vector, v: &Vector) -> f64 {
            oscillator((*q).into(), (*v).into(), self.m, self.k, self.r).0
        }
        #[inline]
        fn lagrangian_gradient(&self, q: &Vector, v: &Vector) -> Gradient<f64, 1> {
            let m = self.m;
            let k = self.k;
            Gradient {
                value: 0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0],
                d1: SVector::from([-k * q[0]]),
                d2: SVector::from([m * v[0]]),
            }
        }
        #[inline]
        fn lagrangian_derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<f64, 1> {
            let m = self.m;
            let k = self.k;
            Derivatives {
                value: 0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0],
                d1: SVector::from([-k * q[0]]),
                d2: SVector::from([m * v[0]]),
                d11: SMatrix::from([[-k]]),
                d12: SMatrix::zeros(),
                d22: SMatrix::from([[m]]),
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
            ::dalembert::generated::CovectorDerivatives<f64, 1>,
        > {
            ::core::option::Option::Some(
                ActingForce::acting_force_derivatives(self, q, v),
            )
        }
    }
    #[automatically_derived]
    impl Rayleigh<1> for Oscillator {
        #[inline]
        fn rayleigh(&self, q: &Vector, v: &Vector) -> f64 {
            oscillator((*q).into(), (*v).into(), self.m, self.k, self.r).1
        }
        #[inline]
        fn rayleigh_gradient(&self, _q: &Vector, v: &Vector) -> Gradient<f64, 1> {
            let r = self.r;
            Gradient {
                value: 0.5 * r * v[0] * v[0],
                d1: SVector::zeros(),
                d2: SVector::from([r * v[0]]),
            }
        }
        #[inline]
        fn rayleigh_derivatives(&self, _q: &Vector, v: &Vector) -> Derivatives<f64, 1> {
            let r = self.r;
            Derivatives {
                value: 0.5 * r * v[0] * v[0],
                d1: SVector::zeros(),
                d2: SVector::from([r * v[0]]),
                d11: SMatrix::zeros(),
                d12: SMatrix::zeros(),
                d22: SMatrix::from([[r]]),
            }
        }
    }
    #[automatically_derived]
    impl ActingForce<1> for Oscillator {
        const HAS_RAYLEIGH: bool = true;
        #[inline]
        fn dissipation(&self, q: &Vector, v: &Vector) -> Gradient<f64, 1> {
            self.rayleigh_gradient(q, v)
        }
        #[inline]
        fn dissipation_derivatives(
            &self,
            q: &Vector,
            v: &Vector,
        ) -> Derivatives<f64, 1> {
            self.rayleigh_derivatives(q, v)
        }
    }
    #[automatically_derived]
    impl Fused<Midpoint, 1> for Oscillator {
        type Matrix = SMatrix<f64, 1, 1>;
        type Memory = ::dalembert::generated::KeptMatrix<f64, Self::Matrix, 1>;
        type Border = ::dalembert::generated::Free;
        const LINEAR: bool = true;
        const WRITTEN_OUT: bool = true;
        /// p0 = −D1 L_d − f_d⁻ and ∂p0/∂v̄.
        #[inline]
        fn step_kernel(&self, segment: &Segment<f64, 1>) -> StepKernel<f64, 1> {
            let (q0, v, h) = (&segment.q0, &segment.v, segment.h);
            let half = 0.5 * h;
            let q = [q0[0] + half * v[0]];
            let m = self.m;
            let k = self.k;
            let r = self.r;
            StepKernel {
                p0: SVector::from([m * v[0] + half * (k * q[0] + r * v[0])]),
                matrix: SMatrix::from([[m + half * (r + k * half)]]),
            }
        }
        /// p0 = −D1 L_d − f_d⁻ and p1 = D2 L_d + f_d⁺.
        #[inline]
        fn momenta(&self, segment: &Segment<f64, 1>) -> Momenta<f64, 1> {
            let (q0, v, h) = (&segment.q0, &segment.v, segment.h);
            let half = 0.5 * h;
            let q = [q0[0] + half * v[0]];
            let t1 = self.m * v[0];
            let t2 = half * (self.k * q[0] + self.r * v[0]);
            Momenta {
                p0: SVector::from([t1 + t2]),
                p1: SVector::from([t1 - t2]),
            }
        }
    }
    #[automatically_derived]
    impl Fused<Trapezoidal, 1> for Oscillator {
        type Matrix = SMatrix<f64, 1, 1>;
        type Memory = ::dalembert::generated::ExplicitMemory<f64, Self::Matrix, 1>;
        type Border = ::dalembert::generated::Free;
        const LINEAR: bool = true;
        const WRITTEN_OUT: bool = true;
        /// p0 = −D1 L_d − f_d⁻ and ∂p0/∂v̄.
        #[inline]
        fn step_kernel(&self, segment: &Segment<f64, 1>) -> StepKernel<f64, 1> {
            let (q0, v, h) = (&segment.q0, &segment.v, segment.h);
            let half = 0.5 * h;
            let t1 = self.m + self.r * half;
            StepKernel {
                p0: SVector::from([self.k * half * q0[0] + t1 * v[0]]),
                matrix: SMatrix::from([[t1]]),
            }
        }
        /// p0 = −D1 L_d − f_d⁻ and p1 = D2 L_d + f_d⁺.
        #[inline]
        fn momenta(&self, segment: &Segment<f64, 1>) -> Momenta<f64, 1> {
            let (q0, v, h) = (&segment.q0, &segment.v, segment.h);
            let half = 0.5 * h;
            let q1 = [q0[0] + h * v[0]];
            let t1 = self.m * v[0];
            let t2 = self.k * half;
            let t3 = self.r * half * v[0];
            Momenta {
                p0: SVector::from([t1 + t2 * q0[0] + t3]),
                p1: SVector::from([t1 - t3 - t2 * q1[0]]),
            }
        }
    }
    #[automatically_derived]
    impl ::dalembert::generated::Explicit<1> for Oscillator {
        #[inline]
        fn step_matrix(&self, h: f64) -> <Self as Fused<Trapezoidal, 1>>::Matrix {
            let half = 0.5 * h;
            SMatrix::from([[self.m + self.r * half]])
        }
        #[inline]
        fn velocity_momenta(&self, v: &Vector, h: f64) -> Momenta<f64, 1> {
            let half = 0.5 * h;
            let t1 = self.m * v[0];
            let t2 = self.r * half * v[0];
            Momenta {
                p0: SVector::from([t1 + t2]),
                p1: SVector::from([t1 - t2]),
            }
        }
        #[inline]
        fn configuration_force(&self, q: &Vector) -> Vector {
            SVector::from([-self.k * q[0]])
        }
    }
    #[automatically_derived]
    impl ::dalembert::generated::OffersMethods<1> for Oscillator {
        type Methods = ::dalembert::generated::WithSplittings<Trapezoidal>;
    }
};
