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
const _: () = ::core::assert!(
    1 <= 32,
    "with more than 32 coordinates dual numbers can overflow the stack of a thread; have the derivatives written out: `derivatives = expanded` says what stands in the way"
);
::dalembert::generated::described! {
    Oscillator : f64, 1; described_Oscillator $
}
#[allow(
    clippy::all,
    clippy::pedantic,
    clippy::nursery,
    deprecated,
    nonstandard_style,
    unreachable_code,
    unused
)]
const _: () = {
    use ::dalembert::generated::dual::{self, Dual, Real};
    #[allow(dead_code)]
    impl Oscillator {
        /// `oscillator` over plain and dual numbers.
        #[inline(always)]
        fn oscillator_over<D: Dual<f64>>(
            q: [Real<D>; 1],
            v: [Real<D>; 1],
            m: Real<D>,
            k: Real<D>,
            r: Real<D>,
        ) -> (Real<D>, Real<D>) {
            (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
        }
        /// L over plain and dual numbers.
        #[inline(always)]
        fn lagrangian_over<D: Dual<f64>>(
            &self,
            q: [Real<D>; 1],
            v: [Real<D>; 1],
        ) -> Real<D> {
            Self::oscillator_over(
                    q,
                    v,
                    D::lift(self.m),
                    D::lift(self.k),
                    D::lift(self.r),
                )
                .0
        }
        /// The Rayleigh function over plain and dual numbers.
        #[inline(always)]
        fn rayleigh_over<D: Dual<f64>>(
            &self,
            q: [Real<D>; 1],
            v: [Real<D>; 1],
        ) -> Real<D> {
            Self::oscillator_over(
                    q,
                    v,
                    D::lift(self.m),
                    D::lift(self.k),
                    D::lift(self.r),
                )
                .1
        }
    }
};
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
        ActingForce, Derivatives, Direction, DisplacementRule, Fused, Gradient,
        Lagrangian, Midpoint, Momenta, Rayleigh, Segment, StepKernel, Variations, dual,
    };
    type Vector = SVector<f64, 1>;
    /// Known at compile time:
    /// - Derivatives are made by dual numbers, as asked.
    #[automatically_derived]
    impl Lagrangian<1> for Oscillator {
        type Scalar = f64;
        const STRUCTURE: ::dalembert::generated::Structure = ::dalembert::generated::Structure::UNKNOWN
            .with_engine(::dalembert::generated::Engine::NumDual {
                refusal: ::core::option::Option::None,
            });
        #[inline]
        fn lagrangian(&self, q: &Vector, v: &Vector) -> f64 {
            oscillator((*q).into(), (*v).into(), self.m, self.k, self.r).0
        }
        fn lagrangian_gradient(&self, q: &Vector, v: &Vector) -> Gradient<f64, 1> {
            dual::gradient(
                q,
                v,
                |q, v| self.lagrangian_over(q, v),
                |q, v| self.lagrangian_over(q, v),
            )
        }
        fn lagrangian_derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<f64, 1> {
            dual::derivatives::<
                f64,
                1,
                2,
            >(q, v, |q, v| self.lagrangian_over(q, v), |q, v| self.lagrangian_over(q, v))
        }
        fn lagrangian_variations(
            &self,
            q: &Vector,
            v: &Vector,
            minus: Direction<f64>,
            plus: Direction<f64>,
        ) -> Variations<f64, 1> {
            dual::variations(
                q,
                v,
                minus,
                plus,
                |q, v| self.lagrangian_over(q, v),
                |q, v| self.lagrangian_over(q, v),
            )
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
        fn without_derivative(
            &self,
            q: &Vector,
            v: &Vector,
        ) -> ::core::option::Option<::dalembert::generated::NoDerivative> {
            ::dalembert::generated::missing::lagrangian(self, q, v)
                .or_else(|| ::dalembert::generated::missing::rayleigh(self, q, v))
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
        fn rayleigh_gradient(&self, q: &Vector, v: &Vector) -> Gradient<f64, 1> {
            dual::gradient(
                q,
                v,
                |q, v| self.rayleigh_over(q, v),
                |q, v| self.rayleigh_over(q, v),
            )
        }
        fn rayleigh_derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<f64, 1> {
            dual::derivatives::<
                f64,
                1,
                2,
            >(q, v, |q, v| self.rayleigh_over(q, v), |q, v| self.rayleigh_over(q, v))
        }
        fn rayleigh_variations(
            &self,
            q: &Vector,
            v: &Vector,
            minus: Direction<f64>,
            plus: Direction<f64>,
        ) -> Variations<f64, 1> {
            dual::variations(
                q,
                v,
                minus,
                plus,
                |q, v| self.rayleigh_over(q, v),
                |q, v| self.rayleigh_over(q, v),
            )
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
        /// Sizes of the terms that cancel in ∂L/∂v and in ∂L/∂q + f_L, at rest for instance.
        #[cold]
        fn cancelling_terms(
            &self,
            q: &Vector,
            v: &Vector,
        ) -> ::dalembert::generated::CancellingTerms<f64, 1> {
            let mut terms = dual::terms_of_lagrangian::<
                f64,
                1,
                2,
            >(q, v, |q, v| self.lagrangian_over(q, v));
            terms.rate
                += dual::terms_of_rayleigh::<
                    f64,
                    1,
                    2,
                >(q, v, |q, v| self.rayleigh_over(q, v));
            terms
        }
    }
    #[automatically_derived]
    impl Fused<Midpoint, 1> for Oscillator {
        type Matrix = SMatrix<f64, 1, 1>;
        type Memory = ::dalembert::generated::VelocityHistory<f64, 1>;
        type Border = ::dalembert::generated::Free;
        /// p0 = −D1 L_d − f_d⁻ and ∂p0/∂v̄.
        #[inline]
        fn step_kernel(&self, segment: &Segment<f64, 1>) -> StepKernel<f64, 1> {
            Midpoint::lagrangian_kernel(self, segment)
                + Midpoint::rayleigh_kernel(self, segment)
        }
        /// p0 = −D1 L_d − f_d⁻ and p1 = D2 L_d + f_d⁺.
        #[inline]
        fn momenta(&self, segment: &Segment<f64, 1>) -> Momenta<f64, 1> {
            Midpoint::lagrangian_momenta(self, segment)
                + Midpoint::rayleigh_momenta(self, segment)
        }
        /// Sizes of the terms that cancel in p0, at rest for instance.
        #[cold]
        fn cancelling_terms(&self, segment: &Segment<f64, 1>) -> Vector {
            Midpoint::cancelling_terms(self, segment)
        }
    }
    #[automatically_derived]
    impl ::dalembert::generated::OffersMethods<1> for Oscillator {
        type Methods = Midpoint;
    }
};
