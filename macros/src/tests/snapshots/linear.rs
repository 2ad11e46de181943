fn linear(q: [f64; 2], v: [f64; 2], k: f64, c: f64) -> (f64, f64) {
    let d = q[1] - q[0];
    (
        0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.5 * k * (q[0] * q[0] + d * d),
        0.5 * c * v[1] * v[1],
    )
}
/// The mechanical system of [`linear`], with its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(dead_code)]
struct Linear {
    /// Parameter `k` of [`linear`].
    k: f64,
    /// Parameter `c` of [`linear`].
    c: f64,
}
::dalembert::generated::described! {
    Linear : f64, 2; described_Linear $
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
    impl ::dalembert::generated::PlainFields for Linear {
        #[cold]
        fn first_no_number(
            &self,
        ) -> ::core::option::Option<(::dalembert::generated::Quantity, usize)> {
            let fields: [(&'static str, &dyn ::dalembert::generated::Plain<f64>); 2] = [
                ("k", &(self.k)),
                ("c", &(self.c)),
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
    #[automatically_derived]
    impl Lagrangian<2> for Linear {
        type Scalar = f64;
        const STRUCTURE: ::dalembert::generated::Structure = ::dalembert::generated::Structure::UNKNOWN
            .with_engine(::dalembert::generated::Engine::Expanded)
            .with_constant_mass_matrix()
            .with_quadratic_lagrangian()
            .with_separable_lagrangian()
            .with_damping(::dalembert::generated::Damping::Linear)
            .with_newton_matrices(
                &[::dalembert::generated::NewtonStructure::new("Midpoint", true, 1)],
            );
        #[inline]
        fn lagrangian(&self, q: &Vector, v: &Vector) -> f64 {
            linear((*q).into(), (*v).into(), self.k, self.c).0
        }
        #[inline]
        fn lagrangian_gradient(&self, q: &Vector, v: &Vector) -> Gradient<f64, 2> {
            let d = q[1] - q[0];
            let k = self.k;
            let t1 = k * d;
            let dl_dd = -t1;
            Gradient {
                value: 0.5 * (v[0] * v[0] + v[1] * v[1])
                    - 0.5 * k * (q[0] * q[0] + d * d),
                d1: SVector::from([t1 - k * q[0], dl_dd]),
                d2: SVector::from([v[0], v[1]]),
            }
        }
        #[inline]
        fn lagrangian_derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<f64, 2> {
            let d = q[1] - q[0];
            let k = self.k;
            let t1 = k * d;
            let dl_dd = -t1;
            Derivatives {
                value: 0.5 * (v[0] * v[0] + v[1] * v[1])
                    - 0.5 * k * (q[0] * q[0] + d * d),
                d1: SVector::from([t1 - k * q[0], dl_dd]),
                d2: SVector::from([v[0], v[1]]),
                d11: SMatrix::from([[-2.0 * k, k], [k, -k]]),
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
    impl Rayleigh<2> for Linear {
        #[inline]
        fn rayleigh(&self, q: &Vector, v: &Vector) -> f64 {
            linear((*q).into(), (*v).into(), self.k, self.c).1
        }
        #[inline]
        fn rayleigh_gradient(&self, _q: &Vector, v: &Vector) -> Gradient<f64, 2> {
            let c = self.c;
            Gradient {
                value: 0.5 * c * v[1] * v[1],
                d1: SVector::zeros(),
                d2: SVector::from([0.0, c * v[1]]),
            }
        }
        #[inline]
        fn rayleigh_derivatives(&self, _q: &Vector, v: &Vector) -> Derivatives<f64, 2> {
            let c = self.c;
            Derivatives {
                value: 0.5 * c * v[1] * v[1],
                d1: SVector::zeros(),
                d2: SVector::from([0.0, c * v[1]]),
                d11: SMatrix::zeros(),
                d12: SMatrix::zeros(),
                d22: SMatrix::from([[0.0, 0.0], [0.0, c]]),
            }
        }
    }
    #[automatically_derived]
    impl ActingForce<2> for Linear {
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
    impl Fused<Midpoint, 2> for Linear {
        type Matrix = SMatrix<f64, 2, 2>;
        type Memory = ::dalembert::generated::KeptMatrix<f64, Self::Matrix, 2>;
        type Border = ::dalembert::generated::Free;
        const LINEAR: bool = true;
        const WRITTEN_OUT: bool = true;
        /// p0 = −D1 L_d − f_d⁻ and ∂p0/∂v̄.
        #[inline]
        fn step_kernel(&self, segment: &Segment<f64, 2>) -> StepKernel<f64, 2> {
            let (q0, v, h) = (&segment.q0, &segment.v, segment.h);
            let half = 0.5 * h;
            let q = [q0[0] + half * v[0], q0[1] + half * v[1]];
            let d = q[1] - q[0];
            let k = self.k;
            let c = self.c;
            let t1 = k * d;
            let t2 = half * half;
            let t3 = k * t2;
            let t4 = -t3;
            StepKernel {
                p0: SVector::from([
                    v[0] - half * (t1 - k * q[0]),
                    v[1] + half * (t1 + c * v[1]),
                ]),
                matrix: SMatrix::from([
                    [1.0 + 2.0 * k * t2, t4],
                    [t4, 1.0 + c * half + t3],
                ]),
            }
        }
        /// p0 = −D1 L_d − f_d⁻ and p1 = D2 L_d + f_d⁺.
        #[inline]
        fn momenta(&self, segment: &Segment<f64, 2>) -> Momenta<f64, 2> {
            let (q0, v, h) = (&segment.q0, &segment.v, segment.h);
            let half = 0.5 * h;
            let q = [q0[0] + half * v[0], q0[1] + half * v[1]];
            let d = q[1] - q[0];
            let k = self.k;
            let t1 = k * d;
            let t2 = half * (t1 - k * q[0]);
            let t3 = half * (t1 + self.c * v[1]);
            Momenta {
                p0: SVector::from([v[0] - t2, v[1] + t3]),
                p1: SVector::from([v[0] + t2, v[1] - t3]),
            }
        }
    }
    #[automatically_derived]
    impl ::dalembert::generated::OffersMethods<2> for Linear {
        type Methods = Midpoint;
    }
};
