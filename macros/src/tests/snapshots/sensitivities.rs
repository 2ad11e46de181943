impl Joint {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * self.l * self.l * v[0] * v[0] + self.l * q[0].cos()
    }
    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.25 * self.c[0] * v[0].powi(4)
    }
    fn force(&self, q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
        [u[0] * q[0].cos()]
    }
}
/// [`Joint`] with its input held over a step; see [`Joint::driven`].
#[derive(Clone, Copy)]
#[allow(dead_code)]
pub struct DrivenJoint<'a> {
    system: &'a Joint,
    u: [f64; 1],
}
#[allow(dead_code)]
impl Joint {
    /// The system with the input `u` held over the step.
    #[inline]
    #[must_use]
    pub fn driven(
        &self,
        u: impl ::dalembert::generated::Input<f64, 1>,
    ) -> DrivenJoint<'_> {
        DrivenJoint {
            system: self,
            u: ::dalembert::generated::Input::entries(u),
        }
    }
}
::dalembert::generated::described! {
    Joint[DrivenJoint driven] : f64, 1, input u 1, parameters["l", "c[0]"];
    described_Joint $
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
        ActingForce, CovectorDerivatives, Derivatives, Direction, Driven, Force, Fused,
        Gradient, GradientBy, Hessian, Lagrangian, Midpoint, Momenta, Parameters,
        Rayleigh, SecondOrder, Segment, StepKernel, Variations,
    };
    type Vector = SVector<f64, 1>;
    impl ::dalembert::generated::PlainFields for Joint {
        #[cold]
        fn first_no_number(
            &self,
        ) -> ::core::option::Option<(::dalembert::generated::Quantity, usize)> {
            let fields: [(&'static str, &dyn ::dalembert::generated::Plain<f64>); 2] = [
                ("l", &(self.l)),
                ("c[0]", &(self.c[0])),
            ];
            ::dalembert::generated::missing::field(&fields)
        }
    }
    /// Known at compile time:
    /// - Derivatives are written out.
    /// - L = T(v) − V(q).
    /// - The damping force −∂R/∂v is not linear in v.
    /// - By the rule `Midpoint` the Newton matrix changes with the state.
    #[automatically_derived]
    impl Lagrangian<1> for Joint {
        type Scalar = f64;
        const STRUCTURE: ::dalembert::generated::Structure = ::dalembert::generated::Structure::UNKNOWN
            .with_engine(::dalembert::generated::Engine::Expanded)
            .with_separable_lagrangian()
            .with_damping(::dalembert::generated::Damping::Nonlinear)
            .with_newton_matrices(
                &[::dalembert::generated::NewtonStructure::new("Midpoint", false, 0)],
            );
        #[inline]
        fn lagrangian(&self, q: &Vector, v: &Vector) -> f64 {
            self.lagrangian((*q).into(), (*v).into())
        }
        #[inline]
        fn lagrangian_gradient(&self, q: &Vector, v: &Vector) -> Gradient<f64, 1> {
            let l = self.l;
            let (sin_q0, cos_q0) = q[0].sin_cos();
            Gradient {
                value: 0.5 * l * l * v[0] * v[0] + l * cos_q0,
                d1: SVector::from([-l * sin_q0]),
                d2: SVector::from([l * l * v[0]]),
            }
        }
        #[inline]
        fn lagrangian_derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<f64, 1> {
            let l = self.l;
            let (sin_q0, cos_q0) = q[0].sin_cos();
            let t1 = l * cos_q0;
            let l_squared = l * l;
            Derivatives {
                value: 0.5 * l * l * v[0] * v[0] + t1,
                d1: SVector::from([-l * sin_q0]),
                d2: SVector::from([v[0] * l_squared]),
                d11: SMatrix::from([[-t1]]),
                d12: SMatrix::zeros(),
                d22: SMatrix::from([[l_squared]]),
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
    impl Lagrangian<1> for DrivenJoint<'_> {
        type Scalar = f64;
        const STRUCTURE: ::dalembert::generated::Structure = <Joint as Lagrangian<
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
    }
    #[automatically_derived]
    impl Rayleigh<1> for Joint {
        #[inline]
        fn rayleigh(&self, _q: &Vector, v: &Vector) -> f64 {
            self.rayleigh((*v).into())
        }
        #[inline]
        fn rayleigh_gradient(&self, _q: &Vector, v: &Vector) -> Gradient<f64, 1> {
            let c_0 = self.c[0];
            Gradient {
                value: 0.25 * c_0 * v[0].powi(4),
                d1: SVector::zeros(),
                d2: SVector::from([c_0 * v[0] * v[0] * v[0]]),
            }
        }
        #[inline]
        fn rayleigh_derivatives(&self, _q: &Vector, v: &Vector) -> Derivatives<f64, 1> {
            let c_0 = self.c[0];
            let v0_squared = v[0] * v[0];
            Derivatives {
                value: 0.25 * c_0 * v[0].powi(4),
                d1: SVector::zeros(),
                d2: SVector::from([c_0 * v[0] * v0_squared]),
                d11: SMatrix::zeros(),
                d12: SMatrix::zeros(),
                d22: SMatrix::from([[3.0 * c_0 * v0_squared]]),
            }
        }
    }
    #[automatically_derived]
    impl Rayleigh<1> for DrivenJoint<'_> {
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
    impl Force<1> for DrivenJoint<'_> {
        #[inline]
        fn force(&self, q: &Vector, v: &Vector) -> Vector {
            self.system.force((*q).into(), (*v).into(), self.u).into()
        }
        #[inline]
        fn force_derivatives(
            &self,
            q: &Vector,
            _v: &Vector,
        ) -> CovectorDerivatives<f64, 1> {
            let u = self.u;
            let (sin_q0, cos_q0) = q[0].sin_cos();
            CovectorDerivatives {
                value: SVector::from([u[0] * cos_q0]),
                d1: SMatrix::from([[-u[0] * sin_q0]]),
                d2: SMatrix::zeros(),
            }
        }
    }
    #[automatically_derived]
    impl ActingForce<1> for DrivenJoint<'_> {
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
    }
    #[automatically_derived]
    impl Driven<1, 1> for DrivenJoint<'_> {
        #[inline]
        fn force_by_input(&self, q: &Vector, _v: &Vector) -> SMatrix<f64, 1, 1> {
            SMatrix::from([[q[0].cos()]])
        }
    }
    #[automatically_derived]
    impl Parameters<1, 2> for DrivenJoint<'_> {
        const PARAMETERS: [&'static str; 2] = ["l", "c[0]"];
        #[inline]
        fn lagrangian_by_parameters(
            &self,
            q: &Vector,
            v: &Vector,
        ) -> GradientBy<f64, 1, 2> {
            GradientBy {
                d1: SMatrix::from([[-q[0].sin()], [0.0]]),
                d2: SMatrix::from([[2.0 * self.system.l * v[0]], [0.0]]),
            }
        }
        #[inline]
        fn rayleigh_by_parameters(
            &self,
            _q: &Vector,
            v: &Vector,
        ) -> GradientBy<f64, 1, 2> {
            GradientBy {
                d1: SMatrix::zeros(),
                d2: SMatrix::from([[0.0], [v[0] * v[0] * v[0]]]),
            }
        }
        #[inline]
        fn force_by_parameters(&self, _q: &Vector, _v: &Vector) -> SMatrix<f64, 1, 2> {
            SMatrix::zeros()
        }
    }
    #[automatically_derived]
    impl SecondOrder<1, 1> for DrivenJoint<'_> {
        #[inline]
        fn lagrangian_along(
            &self,
            q: &Vector,
            _v: &Vector,
            a: &Vector,
            _b: &Vector,
        ) -> Hessian<f64, 1, 1> {
            Hessian {
                d11: SMatrix::from([[a[0] * self.system.l * q[0].sin()]]),
                d12: SMatrix::zeros(),
                d22: SMatrix::zeros(),
                ..Hessian::zero()
            }
        }
        #[inline]
        fn rayleigh_along(
            &self,
            _q: &Vector,
            v: &Vector,
            _a: &Vector,
            b: &Vector,
        ) -> Hessian<f64, 1, 1> {
            Hessian {
                d11: SMatrix::zeros(),
                d12: SMatrix::zeros(),
                d22: SMatrix::from([[6.0 * b[0] * self.system.c[0] * v[0]]]),
                ..Hessian::zero()
            }
        }
        #[inline]
        fn force_along(
            &self,
            q: &Vector,
            _v: &Vector,
            vector: &Vector,
        ) -> Hessian<f64, 1, 1> {
            let u = self.u;
            let (sin_q0, cos_q0) = q[0].sin_cos();
            Hessian {
                d11: SMatrix::from([[-vector[0] * u[0] * cos_q0]]),
                d12: SMatrix::zeros(),
                d22: SMatrix::zeros(),
                d1u: SMatrix::from([[-vector[0] * sin_q0]]),
                d2u: SMatrix::zeros(),
                duu: SMatrix::zeros(),
            }
        }
        #[inline]
        fn force_slope_by_input(&self, q: &Vector, v: &Vector) -> SMatrix<f64, 1, 1> {
            self.force_by_input(q, v)
        }
    }
    #[automatically_derived]
    impl Fused<Midpoint, 1> for DrivenJoint<'_> {
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
            let u = self.u;
            let l = self.system.l;
            let c_0 = self.system.c[0];
            let (sin_q0, cos_q0) = q[0].sin_cos();
            let v0_squared = v[0] * v[0];
            let l_squared = l * l;
            StepKernel {
                p0: SVector::from([
                    v[0] * l_squared
                        - half * (u[0] * cos_q0 - l * sin_q0 - c_0 * v[0] * v0_squared),
                ]),
                matrix: SMatrix::from([
                    [
                        l_squared
                            + half
                                * (3.0 * c_0 * v0_squared
                                    + half * (l * cos_q0 + u[0] * sin_q0)),
                    ],
                ]),
            }
        }
        /// p0 = −D1 L_d − f_d⁻ and p1 = D2 L_d + f_d⁺.
        #[inline]
        fn momenta(&self, segment: &Segment<f64, 1>) -> Momenta<f64, 1> {
            let (q0, v, h) = (&segment.q0, &segment.v, segment.h);
            let half = 0.5 * h;
            let q = [q0[0] + half * v[0]];
            let u = self.u;
            let l = self.system.l;
            let (sin_q0, cos_q0) = q[0].sin_cos();
            let t1 = l * l * v[0];
            let t2 = half
                * (u[0] * cos_q0 - l * sin_q0 - self.system.c[0] * v[0] * v[0] * v[0]);
            Momenta {
                p0: SVector::from([t1 - t2]),
                p1: SVector::from([t1 + t2]),
            }
        }
    }
    #[automatically_derived]
    impl ::dalembert::generated::OffersMethods<1> for DrivenJoint<'_> {
        type Methods = Midpoint;
    }
};
