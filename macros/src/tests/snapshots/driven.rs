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
    nonstandard_style,
    unused_variables,
    unreachable_patterns
)]
const _: () = {
    use ::dalembert::nalgebra::{SMatrix, SVector};
    use ::dalembert::generated::{
        ActingForce, CovectorDerivatives, Derivatives, Direction, DisplacementRule,
        Driven, Force, Fused, Gradient, Lagrangian, Midpoint, Momenta, Rayleigh, Segment,
        StepKernel, Variations,
    };
    type Vector = SVector<f64, 1>;
    impl ::dalembert::generated::PlainFields for Arm {
        #[cold]
        fn first_no_number(
            &self,
        ) -> ::core::option::Option<(::dalembert::generated::Quantity, usize)> {
            let fields: [(&'static str, &dyn ::dalembert::generated::Plain<f64>); 4] = [
                ("m", &(self.m)),
                ("c", &(self.c)),
                ("gain", &(self.gain)),
                ("RATE", &(Self::RATE)),
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
    impl Lagrangian<1> for Arm {
        type Scalar = f64;
        const STRUCTURE: ::dalembert::generated::Structure = ::dalembert::generated::Structure::UNKNOWN
            .with_engine(::dalembert::generated::Engine::Expanded)
            .with_constant_mass_matrix()
            .with_separable_lagrangian()
            .with_damping(::dalembert::generated::Damping::Linear)
            .with_newton_matrices(
                &[::dalembert::generated::NewtonStructure::new("Midpoint", false, 0)],
            );
        #[inline]
        fn lagrangian(&self, q: &Vector, v: &Vector) -> f64 {
            self.lagrangian((*q).into(), (*v).into())
        }
        #[inline]
        fn lagrangian_gradient(&self, q: &Vector, v: &Vector) -> Gradient<f64, 1> {
            let m = self.m;
            let (sin_q0, cos_q0) = q[0].sin_cos();
            Gradient {
                value: 0.5 * m * v[0] * v[0] + cos_q0,
                d1: SVector::from([-sin_q0]),
                d2: SVector::from([m * v[0]]),
            }
        }
        #[inline]
        fn lagrangian_derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<f64, 1> {
            let m = self.m;
            let (sin_q0, cos_q0) = q[0].sin_cos();
            Derivatives {
                value: 0.5 * m * v[0] * v[0] + cos_q0,
                d1: SVector::from([-sin_q0]),
                d2: SVector::from([m * v[0]]),
                d11: SMatrix::from([[-cos_q0]]),
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
        fn non_finite_value(
            &self,
        ) -> ::core::option::Option<(::dalembert::generated::Quantity, usize)> {
            ::dalembert::generated::missing::input(&self.u)
                .or_else(|| ::dalembert::generated::missing::time(self.t))
                .or_else(|| ::dalembert::generated::PlainFields::first_no_number(
                    self.system,
                ))
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
        #[inline]
        fn rayleigh_gradient(&self, _q: &Vector, v: &Vector) -> Gradient<f64, 1> {
            let c = self.c;
            Gradient {
                value: 0.5 * c * v[0] * v[0],
                d1: SVector::zeros(),
                d2: SVector::from([c * v[0]]),
            }
        }
        #[inline]
        fn rayleigh_derivatives(&self, _q: &Vector, v: &Vector) -> Derivatives<f64, 1> {
            let c = self.c;
            Derivatives {
                value: 0.5 * c * v[0] * v[0],
                d1: SVector::zeros(),
                d2: SVector::from([c * v[0]]),
                d11: SMatrix::zeros(),
                d12: SMatrix::zeros(),
                d22: SMatrix::from([[c]]),
            }
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
        #[inline]
        fn force_derivatives(
            &self,
            q: &Vector,
            _v: &Vector,
        ) -> CovectorDerivatives<f64, 1> {
            let t = self.t;
            let u = self.u;
            let (sin_q0, cos_q0) = q[0].sin_cos();
            let t1 = self.system.gain * u[0];
            CovectorDerivatives {
                value: SVector::from([cos_q0 * t1 + (t * Arm::RATE).sin()]),
                d1: SMatrix::from([[-t1 * sin_q0]]),
                d2: SMatrix::zeros(),
            }
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
            let t = self.t;
            let u = self.u;
            let (sin_q0, cos_q0) = q[0].sin_cos();
            let t1 = self.system.gain * u[0];
            let t2 = cos_q0 * t1;
            let t3 = t2 + (t * Arm::RATE).sin();
            ::dalembert::generated::CancellingTerms {
                momentum: SVector::zeros(),
                rate: SVector::from([
                    t2.abs() + 2.0 * (cos_q0.abs() * t1.abs()) + t3.abs()
                        + (t3 - sin_q0 - self.system.c * v[0]).abs(),
                ]),
            }
        }
    }
    #[automatically_derived]
    impl Driven<1, 1> for DrivenArm<'_> {
        #[inline]
        fn force_by_input(&self, q: &Vector, _v: &Vector) -> SMatrix<f64, 1, 1> {
            SMatrix::from([[self.system.gain * q[0].cos()]])
        }
    }
    #[automatically_derived]
    impl Fused<Midpoint, 1> for DrivenArm<'_> {
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
            let t = self.t + half;
            let u = self.u;
            let m = self.system.m;
            let (sin_q0, cos_q0) = q[0].sin_cos();
            let c = self.system.c;
            let t1 = self.system.gain * u[0];
            StepKernel {
                p0: SVector::from([
                    m * v[0]
                        - half
                            * (cos_q0 * t1 + (t * Arm::RATE).sin() - sin_q0 - c * v[0]),
                ]),
                matrix: SMatrix::from([[m + half * (c + half * (cos_q0 + t1 * sin_q0))]]),
            }
        }
        /// p0 = −D1 L_d − f_d⁻ and p1 = D2 L_d + f_d⁺.
        #[inline]
        fn momenta(&self, segment: &Segment<f64, 1>) -> Momenta<f64, 1> {
            let (q0, v, h) = (&segment.q0, &segment.v, segment.h);
            let half = 0.5 * h;
            let q = [q0[0] + half * v[0]];
            let t = self.t + half;
            let u = self.u;
            let (sin_q0, cos_q0) = q[0].sin_cos();
            let t1 = self.system.m * v[0];
            let t2 = half
                * (self.system.gain * u[0] * cos_q0 + (t * Arm::RATE).sin() - sin_q0
                    - self.system.c * v[0]);
            Momenta {
                p0: SVector::from([t1 - t2]),
                p1: SVector::from([t1 + t2]),
            }
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
