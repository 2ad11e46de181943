impl Follower {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        let lift = self.cam.at(q[0]);
        0.5 * v[0] * v[0] - 0.5 * self.k * lift * lift
    }
    fn rayleigh(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * Self::DRAG.at(q[0]) * v[0] * v[0]
    }
}
::dalembert::generated::described! {
    Follower : f64, 1; described_Follower $
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
        ActingForce, Curve, Derivatives, Fused, Gradient, Lagrangian, Midpoint, Momenta,
        Rayleigh, Segment, StepKernel,
    };
    type Vector = SVector<f64, 1>;
    impl ::dalembert::generated::PlainFields for Follower {
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
    /// - The damping force −∂R/∂v is linear in v with coefficients that depend on q.
    /// - By the rule `Midpoint` the Newton matrix changes with the state.
    #[automatically_derived]
    impl Lagrangian<1> for Follower {
        type Scalar = f64;
        const STRUCTURE: ::dalembert::generated::Structure = ::dalembert::generated::Structure::UNKNOWN
            .with_engine(::dalembert::generated::Engine::Expanded)
            .with_constant_mass_matrix()
            .with_separable_lagrangian()
            .with_damping(::dalembert::generated::Damping::LinearByConfiguration)
            .with_newton_matrices(
                &[::dalembert::generated::NewtonStructure::new("Midpoint", false, 0)],
            );
        #[inline]
        fn lagrangian(&self, q: &Vector, v: &Vector) -> f64 {
            self.lagrangian((*q).into(), (*v).into())
        }
        #[inline]
        fn lagrangian_gradient(&self, q: &Vector, v: &Vector) -> Gradient<f64, 1> {
            let [lift, cam_slope, ..] = Curve::<f64>::derivatives(&self.cam, q[0]);
            let k = self.k;
            Gradient {
                value: 0.5 * v[0] * v[0] - 0.5 * k * lift * lift,
                d1: SVector::from([-k * lift * cam_slope]),
                d2: SVector::from([v[0]]),
            }
        }
        #[inline]
        fn lagrangian_derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<f64, 1> {
            let [lift, cam_slope, cam_curvature, ..] = Curve::<
                f64,
            >::derivatives(&self.cam, q[0]);
            let k = self.k;
            let t1 = k * lift;
            Derivatives {
                value: 0.5 * v[0] * v[0] - 0.5 * k * lift * lift,
                d1: SVector::from([-cam_slope * t1]),
                d2: SVector::from([v[0]]),
                d11: SMatrix::from([
                    [-(k * cam_slope * cam_slope + cam_curvature * t1)],
                ]),
                d12: SMatrix::zeros(),
                d22: SMatrix::from([[1.0]]),
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
    impl Rayleigh<1> for Follower {
        #[inline]
        fn rayleigh(&self, q: &Vector, v: &Vector) -> f64 {
            self.rayleigh((*q).into(), (*v).into())
        }
        #[inline]
        fn rayleigh_gradient(&self, q: &Vector, v: &Vector) -> Gradient<f64, 1> {
            let [drag, drag_slope, ..] = Curve::<f64>::derivatives(&Self::DRAG, q[0]);
            Gradient {
                value: 0.5 * drag * v[0] * v[0],
                d1: SVector::from([0.5 * v[0] * v[0] * drag_slope]),
                d2: SVector::from([v[0] * drag]),
            }
        }
        #[inline]
        fn rayleigh_derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<f64, 1> {
            let t1 = 0.5 * v[0] * v[0];
            let [drag, drag_slope, drag_curvature, ..] = Curve::<
                f64,
            >::derivatives(&Self::DRAG, q[0]);
            Derivatives {
                value: 0.5 * drag * v[0] * v[0],
                d1: SVector::from([t1 * drag_slope]),
                d2: SVector::from([v[0] * drag]),
                d11: SMatrix::from([[t1 * drag_curvature]]),
                d12: SMatrix::from([[v[0] * drag_slope]]),
                d22: SMatrix::from([[drag]]),
            }
        }
    }
    #[automatically_derived]
    impl ActingForce<1> for Follower {
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
    impl Fused<Midpoint, 1> for Follower {
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
            let [lift, cam_slope, cam_curvature, ..] = Curve::<
                f64,
            >::derivatives(&self.cam, q[0]);
            let t1 = 0.5 * v[0] * v[0];
            let k = self.k;
            let [drag, drag_slope, drag_curvature, ..] = Curve::<
                f64,
            >::derivatives(&Self::DRAG, q[0]);
            let t2 = k * lift;
            let t3 = half * half;
            StepKernel {
                p0: SVector::from([
                    v[0] - t3 * t1 * drag_slope + half * (cam_slope * t2 + v[0] * drag),
                ]),
                matrix: SMatrix::from([
                    [
                        1.0 + half * drag
                            - t3
                                * (half * t1 * drag_curvature - k * cam_slope * cam_slope
                                    - cam_curvature * t2),
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
            let [lift, cam_slope, ..] = Curve::<f64>::derivatives(&self.cam, q[0]);
            let [drag, drag_slope, ..] = Curve::<f64>::derivatives(&Self::DRAG, q[0]);
            let t1 = half * (self.k * lift * cam_slope + v[0] * drag);
            let t2 = v[0] - 0.5 * half * half * v[0] * v[0] * drag_slope;
            Momenta {
                p0: SVector::from([t1 + t2]),
                p1: SVector::from([t2 - t1]),
            }
        }
    }
    #[automatically_derived]
    impl ::dalembert::generated::OffersMethods<1> for Follower {
        type Methods = Midpoint;
    }
};
