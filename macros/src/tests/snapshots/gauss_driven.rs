impl Arm {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * self.m * v[0] * v[0] + q[0].cos()
    }
    fn force(&self, q: [f64; 1], v: [f64; 1], u: [f64; 1], t: f64) -> [f64; 1] {
        let push = if u[0] > 0.0 { self.gain * u[0] } else { 0.0 };
        [push * q[0].cos() - v[0] + (Self::RATE * t).sin()]
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
    Arm[DrivenArm driven] : f64, 1, input u 1, time t, parameters["gain"]; described_Arm
    $
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
        ActingForce, CovectorDerivatives, Derivatives, Direction, Driven, Force,
        ForcedLagrangian, Gradient, GradientBy, Hessian, Lagrangian, LaneVector, Lanes,
        Parameters, SecondOrder, Stages, Variations,
    };
    type Vector = SVector<f64, 1>;
    impl ::dalembert::generated::PlainFields for Arm {
        #[cold]
        fn first_no_number(
            &self,
        ) -> ::core::option::Option<(::dalembert::generated::Quantity, usize)> {
            let fields: [(&'static str, &dyn ::dalembert::generated::Plain<f64>); 3] = [
                ("gain", &(self.gain)),
                ("m", &(self.m)),
                ("RATE", &(Self::RATE)),
            ];
            ::dalembert::generated::missing::field(&fields)
        }
    }
    /// Known at compile time:
    /// - Derivatives are written out.
    /// - L = T(v) − V(q).
    /// - The mass matrix ∂²L/∂v² is constant.
    #[automatically_derived]
    impl Lagrangian<1> for Arm {
        type Scalar = f64;
        const STRUCTURE: ::dalembert::generated::Structure = ::dalembert::generated::Structure::UNKNOWN
            .with_engine(::dalembert::generated::Engine::Expanded)
            .with_constant_mass_matrix()
            .with_separable_lagrangian()
            .with_damping(::dalembert::generated::Damping::Absent)
            .with_newton_matrices(&[]);
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
            ::dalembert::generated::verification::force(self, q, v)
        }
        fn verify_slopes(
            &self,
            q: &Vector,
            v: &Vector,
        ) -> ::core::result::Result<(), ::dalembert::generated::GeneratedDiffers> {
            ::dalembert::generated::verification::lagrangian_slope(self, q, v)?;
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
    impl Force<1> for DrivenArm<'_> {
        #[inline]
        fn force(&self, q: &Vector, v: &Vector) -> Vector {
            self.system.force((*q).into(), (*v).into(), self.u, self.t).into()
        }
        #[inline]
        fn force_derivatives(
            &self,
            q: &Vector,
            v: &Vector,
        ) -> CovectorDerivatives<f64, 1> {
            let t = self.t;
            let u = self.u;
            let (sin_q0, cos_q0) = q[0].sin_cos();
            let push = if u[0] > 0.0 { self.system.gain * u[0] } else { 0.0 };
            CovectorDerivatives {
                value: SVector::from([cos_q0 * push - v[0] + (t * Arm::RATE).sin()]),
                d1: SMatrix::from([[-push * sin_q0]]),
                d2: SMatrix::from([[-1.0]]),
            }
        }
    }
    #[automatically_derived]
    impl ActingForce<1> for DrivenArm<'_> {
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
            let gain = self.system.gain;
            let (sin_q0, cos_q0) = q[0].sin_cos();
            let t1 = u[0] > 0.0;
            let t2 = gain * u[0];
            let push = if t1 { t2 } else { 0.0 };
            let t3 = cos_q0 * push;
            let t4 = t3 - v[0];
            let t5 = t4 + (t * Arm::RATE).sin();
            let t6 = if t1 { t2.abs() + gain.abs() * u[0].abs() } else { 0.0 };
            ::dalembert::generated::CancellingTerms {
                momentum: SVector::zeros(),
                rate: SVector::from([
                    t3.abs() + cos_q0.abs() * (t6 + push.abs()) + t4.abs() + t5.abs()
                        + (t5 - sin_q0).abs(),
                ]),
            }
        }
    }
    #[automatically_derived]
    impl ForcedLagrangian<1> for DrivenArm<'_> {
        type Anchors<const S: usize> = [::dalembert::generated::Angle<Lanes<f64, S>>; 2];
        /// G, P − ∂L/∂v and (∂²L/∂v²)⁻¹ (P − ∂L/∂v) at all stages, each at its own time.
        fn stages_in_time<const S: usize>(
            &self,
            angles: &mut Self::Anchors<S>,
            elapsed: &Lanes<f64, S>,
            q: &LaneVector<f64, 1, S>,
            v: &LaneVector<f64, 1, S>,
            momenta: impl FnOnce(&LaneVector<f64, 1, S>) -> LaneVector<f64, 1, S>,
        ) -> Stages<f64, 1, S> {
            let u = self.u;
            let t = *elapsed + self.t;
            let m = self.system.m;
            let (sin_q0, cos_q0) = angles[0].sin_cos(q[0]);
            let push = if u[0] > 0.0 { self.system.gain * u[0] } else { 0.0 };
            let t1 = angles[1].sin_cos(t * Arm::RATE).0;
            let rate = [cos_q0 * push - v[0] + t1 - sin_q0];
            let p = momenta(&rate);
            let residual0 = p[0] - m * v[0];
            Stages {
                rate,
                residual: [residual0],
                correction: [1.0 / m * residual0],
            }
        }
    }
    #[automatically_derived]
    impl Driven<1, 1> for DrivenArm<'_> {
        #[inline]
        fn force_by_input(&self, q: &Vector, _v: &Vector) -> SMatrix<f64, 1, 1> {
            let u = self.u;
            let t1 = if u[0] > 0.0 { self.system.gain * q[0].cos() } else { 0.0 };
            SMatrix::from([[t1]])
        }
    }
    #[automatically_derived]
    impl Parameters<1, 1> for DrivenArm<'_> {
        const PARAMETERS: [&'static str; 1] = ["gain"];
        #[inline]
        fn lagrangian_by_parameters(
            &self,
            _q: &Vector,
            _v: &Vector,
        ) -> GradientBy<f64, 1, 1> {
            GradientBy {
                d1: SMatrix::zeros(),
                d2: SMatrix::zeros(),
            }
        }
        #[inline]
        fn force_by_parameters(&self, q: &Vector, _v: &Vector) -> SMatrix<f64, 1, 1> {
            let u = self.u;
            let t1 = if u[0] > 0.0 { u[0] * q[0].cos() } else { 0.0 };
            SMatrix::from([[t1]])
        }
    }
    #[automatically_derived]
    impl SecondOrder<1, 1> for DrivenArm<'_> {
        #[inline]
        fn lagrangian_along(
            &self,
            q: &Vector,
            _v: &Vector,
            a: &Vector,
            _b: &Vector,
        ) -> Hessian<f64, 1, 1> {
            Hessian {
                d11: SMatrix::from([[a[0] * q[0].sin()]]),
                d12: SMatrix::zeros(),
                d22: SMatrix::zeros(),
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
            let gain = self.system.gain;
            let (sin_q0, cos_q0) = q[0].sin_cos();
            let t1 = u[0] > 0.0;
            let push = if t1 { gain * u[0] } else { 0.0 };
            let d_dpush = vector[0] * cos_q0;
            let t2 = if t1 { vector[0] * gain } else { 0.0 };
            Hessian {
                d11: SMatrix::from([[-push * d_dpush]]),
                d12: SMatrix::zeros(),
                d22: SMatrix::zeros(),
                d1u: SMatrix::from([[-sin_q0 * t2]]),
                d2u: SMatrix::zeros(),
                duu: SMatrix::zeros(),
            }
        }
        #[inline]
        fn force_slope_by_input(&self, q: &Vector, v: &Vector) -> SMatrix<f64, 1, 1> {
            self.force_by_input(q, v)
        }
    }
};
