impl Cart {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let reach = self.l * q[1].cos();
        let kinetic = 0.5 * self.m * v[0] * v[0] + reach * v[0] * v[1]
            + 0.5 * self.l.powi(2) * v[1] * v[1];
        let stop = if q[0] > self.end {
            0.5 * self.k * (q[0] - self.end).powi(2)
        } else {
            0.0
        };
        kinetic + reach - stop
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.c * v[1] * v[1]
    }
    fn force(&self, q: [f64; 2], _v: [f64; 2]) -> [f64; 2] {
        [self.a.powf(q[0]), 0.0]
    }
}
::dalembert::generated::described! {
    Cart : f64, 2; described_Cart $
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
        ActingForce, CovectorDerivatives, Derivatives, Force, ForcedLagrangian, Gradient,
        Lagrangian, LaneVector, Lanes, Rayleigh, Stages,
    };
    type Vector = SVector<f64, 2>;
    impl ::dalembert::generated::PlainFields for Cart {
        #[cold]
        fn first_no_number(
            &self,
        ) -> ::core::option::Option<(::dalembert::generated::Quantity, usize)> {
            let fields: [(&'static str, &dyn ::dalembert::generated::Plain<f64>); 6] = [
                ("l", &(self.l)),
                ("m", &(self.m)),
                ("end", &(self.end)),
                ("k", &(self.k)),
                ("c", &(self.c)),
                ("a", &(self.a)),
            ];
            ::dalembert::generated::missing::field(&fields)
        }
    }
    /// Known at compile time:
    /// - Derivatives are written out.
    /// - The damping force −∂R/∂v is linear in v with constant coefficients.
    #[automatically_derived]
    impl Lagrangian<2> for Cart {
        type Scalar = f64;
        const STRUCTURE: ::dalembert::generated::Structure = ::dalembert::generated::Structure::UNKNOWN
            .with_engine(::dalembert::generated::Engine::Expanded)
            .with_damping(::dalembert::generated::Damping::Linear)
            .with_newton_matrices(&[]);
        #[inline]
        fn lagrangian(&self, q: &Vector, v: &Vector) -> f64 {
            self.lagrangian((*q).into(), (*v).into())
        }
        #[inline]
        fn lagrangian_gradient(&self, q: &Vector, v: &Vector) -> Gradient<f64, 2> {
            let (sin_q1, cos_q1) = q[1].sin_cos();
            let l = self.l;
            let reach = l * cos_q1;
            let m = self.m;
            let t1 = v[0] * reach;
            let l_squared = l * l;
            let kinetic = 0.5 * m * v[0] * v[0] + v[1] * t1
                + 0.5 * l_squared * v[1] * v[1];
            let end = self.end;
            let t2 = q[0] > end;
            let k = self.k;
            let t3 = q[0] - end;
            let stop = if t2 { 0.5 * k * (t3 * t3) } else { 0.0 };
            let t4 = if t2 { -k * t3 } else { 0.0 };
            let dl_dreach = 1.0 + v[0] * v[1];
            Gradient {
                value: reach + kinetic - stop,
                d1: SVector::from([t4, -l * dl_dreach * sin_q1]),
                d2: SVector::from([v[1] * reach + m * v[0], t1 + l_squared * v[1]]),
            }
        }
        #[inline]
        fn lagrangian_derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<f64, 2> {
            let (sin_q1, cos_q1) = q[1].sin_cos();
            let l = self.l;
            let reach = l * cos_q1;
            let m = self.m;
            let t1 = v[0] * reach;
            let l_squared = l * l;
            let kinetic = 0.5 * m * v[0] * v[0] + v[1] * t1
                + 0.5 * l_squared * v[1] * v[1];
            let end = self.end;
            let t2 = q[0] > end;
            let k = self.k;
            let t3 = q[0] - end;
            let stop = if t2 { 0.5 * k * (t3 * t3) } else { 0.0 };
            let t4 = if t2 { -k * t3 } else { 0.0 };
            let dl_dreach = 1.0 + v[0] * v[1];
            let t5 = if t2 { -k } else { 0.0 };
            Derivatives {
                value: reach + kinetic - stop,
                d1: SVector::from([t4, -l * dl_dreach * sin_q1]),
                d2: SVector::from([v[1] * reach + m * v[0], t1 + l_squared * v[1]]),
                d11: SMatrix::from([[t5, 0.0], [0.0, -reach * dl_dreach]]),
                d12: SMatrix::from([
                    [0.0, -l * v[1] * sin_q1],
                    [0.0, -l * v[0] * sin_q1],
                ]),
                d22: SMatrix::from([[m, reach], [reach, l_squared]]),
            }
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
        /// The first operation that has no derivative there, as √s at s = 0.
        #[cold]
        fn place_without_derivative(
            &self,
            function: ::dalembert::generated::Function,
            q: &Vector,
            _v: &Vector,
        ) -> ::core::option::Option<::dalembert::generated::Place> {
            match function {
                ::dalembert::generated::Function::Force { index: 0 } => {
                    ::dalembert::generated::Place::first(
                        &[
                            (
                                &::dalembert::generated::Written {
                                    operation: ::dalembert::generated::Operation::Power,
                                    text: "self.a.powf(q[0])",
                                },
                                [self.a, q[0]],
                            ),
                        ],
                    )
                }
                _ => ::core::option::Option::None,
            }
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
    impl Rayleigh<2> for Cart {
        #[inline]
        fn rayleigh(&self, _q: &Vector, v: &Vector) -> f64 {
            self.rayleigh((*v).into())
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
    impl Force<2> for Cart {
        #[inline]
        fn force(&self, q: &Vector, v: &Vector) -> Vector {
            self.force((*q).into(), (*v).into()).into()
        }
        #[inline]
        fn force_derivatives(
            &self,
            q: &Vector,
            _v: &Vector,
        ) -> CovectorDerivatives<f64, 2> {
            let a = self.a;
            let t1 = a.powf(q[0]);
            CovectorDerivatives {
                value: SVector::from([t1, 0.0]),
                d1: SMatrix::from([[a.ln() * t1, 0.0], [0.0, 0.0]]),
                d2: SMatrix::zeros(),
            }
        }
    }
    #[automatically_derived]
    impl ActingForce<2> for Cart {
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
        ) -> CovectorDerivatives<f64, 2> {
            self.force_derivatives(q, v)
        }
        /// Sizes of the terms that cancel in ∂L/∂v and in ∂L/∂q + f_L, at rest for instance.
        #[cold]
        fn cancelling_terms(
            &self,
            q: &Vector,
            _v: &Vector,
        ) -> ::dalembert::generated::CancellingTerms<f64, 2> {
            let end = self.end;
            let t1 = q[0] > end;
            let k = self.k;
            let t2 = q[0] - end;
            let t3 = self.a.powf(q[0]);
            let t4 = k * t2;
            let t5 = if t1 { -t4 } else { 0.0 };
            let t6 = if t1 { t4.abs() + k.abs() * t2.abs() } else { 0.0 };
            ::dalembert::generated::CancellingTerms {
                momentum: SVector::zeros(),
                rate: SVector::from([t3.abs() + t6 + (t3 + t5).abs(), 0.0]),
            }
        }
    }
    #[automatically_derived]
    impl ForcedLagrangian<2> for Cart {
        type Anchors<const S: usize> = (
            [::dalembert::generated::Angle<Lanes<f64, S>>; 1],
            [::dalembert::generated::Reciprocal<Lanes<f64, S>>; 1],
        );
        /// G, P − ∂L/∂v and (∂²L/∂v²)⁻¹ (P − ∂L/∂v) at all stages.
        fn stages<const S: usize>(
            &self,
            anchors: &mut Self::Anchors<S>,
            q: &LaneVector<f64, 2, S>,
            v: &LaneVector<f64, 2, S>,
            momenta: impl FnOnce(&LaneVector<f64, 2, S>) -> LaneVector<f64, 2, S>,
        ) -> Stages<f64, 2, S> {
            let (angles, reciprocals) = anchors;
            let (sin_q1, cos_q1) = angles[0].sin_cos(q[1]);
            let l = self.l;
            let reach = l * cos_q1;
            let m = self.m;
            let l_squared = l * l;
            let end = self.end;
            let t1 = Lanes::<f64, S>::splat(end)
                .less(q[0])
                .select(-self.k * (q[0] - end), Lanes::<f64, S>::splat(0.0));
            let dl_dreach = 1.0 + v[0] * v[1];
            let t2 = 1.0 / m;
            let t3 = t2 * reach;
            let t4 = reciprocals[0].of(l_squared - reach * t3);
            let rate = [
                Lanes::<f64, S>::splat(self.a).powf(q[0]) + t1,
                -(l * dl_dreach * sin_q1 + self.c * v[1]),
            ];
            let p = momenta(&rate);
            let residual0 = p[0] - m * v[0] - v[1] * reach;
            let residual1 = p[1] - v[0] * reach - l_squared * v[1];
            let t5 = t4 * (residual1 - t3 * residual0);
            Stages {
                rate,
                residual: [residual0, residual1],
                correction: [t2 * residual0 - t3 * t5, t5],
            }
        }
    }
};
