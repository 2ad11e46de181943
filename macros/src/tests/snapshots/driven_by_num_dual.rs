impl Arm {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * self.m * v[0] * v[0] + q[0].cos()
    }
    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.5 * self.c * v[0] * v[0]
    }
    fn force(&self, q: [f64; 1], _v: [f64; 1], u: [f64; 1], t: f64) -> [f64; 1] {
        [self.gain * u[0] * q[0].cos() + (Self::RATE * t).sin()]
    }
}
const _: () = ::core::assert!(
    1 <= 32,
    "with more than 32 coordinates dual numbers can overflow the stack of a thread; have the derivatives written out: `derivatives = expanded` says what stands in the way"
);
/// [`Arm`] with its input held over a step that starts at a given time; see [`Arm::driven`].
#[derive(Clone, Copy)]
#[allow(dead_code)]
pub struct DrivenArm<'a> {
    system: &'a Arm,
    u: [f64; 1],
    t: f64,
}
#[allow(dead_code)]
impl Arm {
    /// The system with the input `u` held over the step that starts at time `t`.
    #[inline]
    #[must_use]
    pub fn driven(
        &self,
        u: impl ::dalembert::generated::Input<f64, 1>,
        t: f64,
    ) -> DrivenArm<'_> {
        DrivenArm {
            system: self,
            u: ::dalembert::generated::Input::entries(u),
            t,
        }
    }
}
::dalembert::generated::described! {
    Arm[DrivenArm driven] : f64, 1, input u 1, time t; described_Arm $
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
    impl Arm {
        /// `lagrangian` over plain and dual numbers.
        #[inline(always)]
        fn lagrangian_over<D: Dual<f64>>(
            &self,
            q: [Real<D>; 1],
            v: [Real<D>; 1],
        ) -> Real<D> {
            let m = D::lift(self.m);
            0.5 * m * v[0] * v[0] + q[0].cos()
        }
        /// `rayleigh` over plain and dual numbers.
        #[inline(always)]
        fn rayleigh_over<D: Dual<f64>>(&self, v: [Real<D>; 1]) -> Real<D> {
            let c = D::lift(self.c);
            0.5 * c * v[0] * v[0]
        }
        /// `force` over plain and dual numbers.
        #[inline(always)]
        fn force_over<D: Dual<f64>>(
            &self,
            q: [Real<D>; 1],
            _v: [Real<D>; 1],
            u: [Real<D>; 1],
            t: Real<D>,
        ) -> [Real<D>; 1] {
            let gain = D::lift(self.gain);
            [gain * u[0] * q[0].cos() + (D::lift(Self::RATE) * t).sin()]
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
        ActingForce, CovectorDerivatives, Derivatives, Direction, DisplacementRule,
        Driven, Force, Fused, Gradient, Lagrangian, Midpoint, Momenta, Rayleigh, Segment,
        StepKernel, Variations, dual,
    };
    type Vector = SVector<f64, 1>;
    /// Known at compile time:
    /// - Derivatives are made by dual numbers, as asked.
    #[automatically_derived]
    impl Lagrangian<1> for Arm {
        type Scalar = f64;
        const STRUCTURE: ::dalembert::generated::Structure = ::dalembert::generated::Structure::UNKNOWN
            .with_engine(::dalembert::generated::Engine::NumDual {
                refusal: ::core::option::Option::None,
            });
        #[inline]
        fn lagrangian(&self, q: &Vector, v: &Vector) -> f64 {
            self.lagrangian((*q).into(), (*v).into())
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
            ::core::option::Option::None
        }
    }
    #[automatically_derived]
    impl Lagrangian<1> for DrivenArm<'_> {
        type Scalar = f64;
        const STRUCTURE: ::dalembert::generated::Structure = <Arm as Lagrangian<
            1,
        >>::STRUCTURE;
        #[inline]
        fn lagrangian(&self, q: &Vector, v: &Vector) -> f64 {
            Lagrangian::lagrangian(self.system, q, v)
        }
        #[inline]
        fn lagrangian_gradient(&self, q: &Vector, v: &Vector) -> Gradient<f64, 1> {
            Lagrangian::lagrangian_gradient(self.system, q, v)
        }
        #[inline]
        fn lagrangian_derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<f64, 1> {
            Lagrangian::lagrangian_derivatives(self.system, q, v)
        }
        #[inline]
        fn lagrangian_variations(
            &self,
            q: &Vector,
            v: &Vector,
            minus: Direction<f64>,
            plus: Direction<f64>,
        ) -> Variations<f64, 1> {
            Lagrangian::lagrangian_variations(self.system, q, v, minus, plus)
        }
        fn verify_generated(
            &self,
            q: &Vector,
            v: &Vector,
        ) -> ::core::result::Result<(), ::dalembert::generated::GeneratedDiffers> {
            ::dalembert::generated::verification::lagrangian(self, q, v)?;
            ::dalembert::generated::verification::rayleigh(self, q, v)?;
            ::dalembert::generated::verification::force(self, q, v)
        }
        fn verify_slopes(
            &self,
            q: &Vector,
            v: &Vector,
        ) -> ::core::result::Result<(), ::dalembert::generated::GeneratedDiffers> {
            ::dalembert::generated::verification::lagrangian_slope(self, q, v)?;
            ::dalembert::generated::verification::rayleigh_slope(self, q, v)?;
            ::dalembert::generated::verification::force_slope(self, q, v)
        }
        #[cold]
        fn without_derivative(
            &self,
            q: &Vector,
            v: &Vector,
        ) -> ::core::option::Option<::dalembert::generated::NoDerivative> {
            ::dalembert::generated::missing::lagrangian(self, q, v)
                .or_else(|| ::dalembert::generated::missing::rayleigh(self, q, v))
                .or_else(|| ::dalembert::generated::missing::force(self, q, v))
        }
        #[cold]
        fn non_finite_value(
            &self,
        ) -> ::core::option::Option<(::dalembert::generated::Quantity, usize)> {
            ::dalembert::generated::missing::input(&self.u)
                .or_else(|| ::dalembert::generated::missing::time(self.t))
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
        #[inline]
        fn later<T>(&self, elapsed: f64, evaluate: impl FnOnce(&Self) -> T) -> T {
            evaluate(
                &Self {
                    t: self.t + elapsed,
                    ..*self
                },
            )
        }
    }
    #[automatically_derived]
    impl Rayleigh<1> for Arm {
        #[inline]
        fn rayleigh(&self, _q: &Vector, v: &Vector) -> f64 {
            self.rayleigh((*v).into())
        }
        fn rayleigh_gradient(&self, q: &Vector, v: &Vector) -> Gradient<f64, 1> {
            dual::gradient(
                q,
                v,
                |_, v| self.rayleigh_over(v),
                |_, v| self.rayleigh_over(v),
            )
        }
        fn rayleigh_derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<f64, 1> {
            dual::derivatives::<
                f64,
                1,
                2,
            >(q, v, |_, v| self.rayleigh_over(v), |_, v| self.rayleigh_over(v))
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
                |_, v| self.rayleigh_over(v),
                |_, v| self.rayleigh_over(v),
            )
        }
    }
    #[automatically_derived]
    impl Rayleigh<1> for DrivenArm<'_> {
        #[inline]
        fn rayleigh(&self, q: &Vector, v: &Vector) -> f64 {
            Rayleigh::rayleigh(self.system, q, v)
        }
        #[inline]
        fn rayleigh_gradient(&self, q: &Vector, v: &Vector) -> Gradient<f64, 1> {
            Rayleigh::rayleigh_gradient(self.system, q, v)
        }
        #[inline]
        fn rayleigh_derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<f64, 1> {
            Rayleigh::rayleigh_derivatives(self.system, q, v)
        }
        #[inline]
        fn rayleigh_variations(
            &self,
            q: &Vector,
            v: &Vector,
            minus: Direction<f64>,
            plus: Direction<f64>,
        ) -> Variations<f64, 1> {
            Rayleigh::rayleigh_variations(self.system, q, v, minus, plus)
        }
    }
    #[automatically_derived]
    impl Force<1> for DrivenArm<'_> {
        #[inline]
        fn force(&self, q: &Vector, v: &Vector) -> Vector {
            self.system.force((*q).into(), (*v).into(), self.u, self.t).into()
        }
        fn force_derivatives(
            &self,
            q: &Vector,
            v: &Vector,
        ) -> CovectorDerivatives<f64, 1> {
            dual::covector_derivatives::<
                f64,
                1,
                2,
            >(
                q,
                v,
                |q, v| {
                    self.system.force_over(q, v, dual::lift(self.u), dual::lift(self.t))
                },
                |q, v| {
                    self.system.force_over(q, v, dual::lift(self.u), dual::lift(self.t))
                },
            )
        }
        fn force_variation(
            &self,
            q: &Vector,
            v: &Vector,
            direction: Direction<f64>,
        ) -> (Vector, SMatrix<f64, 1, 1>) {
            dual::covector_variation(
                q,
                v,
                direction,
                |q, v| {
                    self.system.force_over(q, v, dual::lift(self.u), dual::lift(self.t))
                },
                |q, v| {
                    self.system.force_over(q, v, dual::lift(self.u), dual::lift(self.t))
                },
            )
        }
    }
    #[automatically_derived]
    impl ActingForce<1> for DrivenArm<'_> {
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
        const HAS_FORCE: bool = true;
        #[inline]
        fn general_force(&self, q: &Vector, v: &Vector) -> Vector {
            Force::force(self, q, v)
        }
        #[inline]
        fn general_force_derivatives(
            &self,
            q: &Vector,
            v: &Vector,
        ) -> CovectorDerivatives<f64, 1> {
            self.force_derivatives(q, v)
        }
        const IS_TIMED: bool = true;
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
            >(q, v, |q, v| self.system.lagrangian_over(q, v));
            terms.rate
                += dual::terms_of_rayleigh::<
                    f64,
                    1,
                    2,
                >(q, v, |_, v| self.system.rayleigh_over(v));
            terms.rate
                += dual::terms_of_force::<
                    f64,
                    1,
                    2,
                >(
                    q,
                    v,
                    |q, v| {
                        self
                            .system
                            .force_over(q, v, dual::lift(self.u), dual::lift(self.t))
                    },
                );
            terms
        }
    }
    #[automatically_derived]
    impl Driven<1, 1> for DrivenArm<'_> {
        fn force_by_input(&self, q: &Vector, v: &Vector) -> SMatrix<f64, 1, 1> {
            dual::by_input(
                q,
                v,
                &self.u,
                |q, v, u| self.system.force_over(q, v, u, dual::lift(self.t)),
            )
        }
    }
    #[automatically_derived]
    impl Fused<Midpoint, 1> for DrivenArm<'_> {
        type Matrix = SMatrix<f64, 1, 1>;
        type Memory = ::dalembert::generated::VelocityHistory<f64, 1>;
        type Border = ::dalembert::generated::Free;
        /// p0 = −D1 L_d − f_d⁻ and ∂p0/∂v̄.
        #[inline]
        fn step_kernel(&self, segment: &Segment<f64, 1>) -> StepKernel<f64, 1> {
            Midpoint::lagrangian_kernel(self, segment)
                + Midpoint::rayleigh_kernel(self, segment)
                + Midpoint::force_kernel(self, segment)
        }
        /// p0 = −D1 L_d − f_d⁻ and p1 = D2 L_d + f_d⁺.
        #[inline]
        fn momenta(&self, segment: &Segment<f64, 1>) -> Momenta<f64, 1> {
            Midpoint::lagrangian_momenta(self, segment)
                + Midpoint::rayleigh_momenta(self, segment)
                + Midpoint::force_momenta(self, segment)
        }
        /// Sizes of the terms that cancel in p0, at rest for instance.
        #[cold]
        fn cancelling_terms(&self, segment: &Segment<f64, 1>) -> Vector {
            Midpoint::cancelling_terms(self, segment)
        }
    }
    #[automatically_derived]
    impl ::dalembert::generated::OffersMethods<1> for DrivenArm<'_> {
        type Methods = Midpoint;
    }
};
