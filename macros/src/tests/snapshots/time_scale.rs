impl Kepler {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) + 1.0 / Self::distance(q)
    }
    fn time_scale(&self, q: [f64; 2]) -> f64 {
        let r = Self::distance(q);
        r * r.sqrt()
    }
    fn distance(q: [f64; 2]) -> f64 {
        (q[0] * q[0] + q[1] * q[1]).sqrt()
    }
}
::dalembert::generated::described! {
    Kepler : f64, 2; described_Kepler $
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
        ActingForce, Derivatives, ForcedLagrangian, Gradient, Lagrangian, LaneVector,
        Stages,
    };
    type Vector = SVector<f64, 2>;
    /// Known at compile time:
    /// - Derivatives are written out.
    /// - L = T(v) − V(q).
    /// - The mass matrix ∂²L/∂v² is constant.
    #[automatically_derived]
    impl Lagrangian<2> for Kepler {
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
        fn lagrangian_gradient(&self, q: &Vector, v: &Vector) -> Gradient<f64, 2> {
            let r = (q[0] * q[0] + q[1] * q[1]).sqrt();
            let t1 = 1.0 / r;
            let t2 = t1 * t1 * (0.5 / r);
            Gradient {
                value: 0.5 * (v[0] * v[0] + v[1] * v[1]) + t1,
                d1: SVector::from([-2.0 * q[0] * t2, -2.0 * q[1] * t2]),
                d2: SVector::from([v[0], v[1]]),
            }
        }
        #[inline]
        fn lagrangian_derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<f64, 2> {
            let t1 = q[0] * q[0] + q[1] * q[1];
            let r = t1.sqrt();
            let t2 = 1.0 / r;
            let t2_squared = t2 * t2;
            let t3 = 0.5 / r;
            let t4 = t2_squared * t3;
            let t5 = 2.0 * q[1];
            let t6 = 2.0 * q[0];
            let t7 = 2.0 * t4;
            let t8 = t2_squared * (0.5 * (t3 / t1) + 2.0 * t2 * t3 * t3);
            let t9 = t5 * t8;
            let t10 = t6 * t9;
            Derivatives {
                value: 0.5 * (v[0] * v[0] + v[1] * v[1]) + t2,
                d1: SVector::from([-t4 * t6, -t4 * t5]),
                d2: SVector::from([v[0], v[1]]),
                d11: SMatrix::from([[t6 * t6 * t8 - t7, t10], [t10, t5 * t9 - t7]]),
                d12: SMatrix::zeros(),
                d22: SMatrix::from([[1.0, 0.0], [0.0, 1.0]]),
            }
        }
        fn verify_generated(
            &self,
            q: &Vector,
            v: &Vector,
        ) -> ::core::result::Result<(), ::dalembert::generated::GeneratedDiffers> {
            ::dalembert::generated::verification::time_scale(self, q)?;
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
        fn without_derivative(
            &self,
            q: &Vector,
            v: &Vector,
        ) -> ::core::option::Option<::dalembert::generated::NoDerivative> {
            ::dalembert::generated::missing::lagrangian(self, q, v)
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
                ::dalembert::generated::Function::Lagrangian => {
                    let t1 = q[0] * q[0] + q[1] * q[1];
                    let r = t1.sqrt();
                    ::dalembert::generated::Place::first(
                        &[
                            (
                                &::dalembert::generated::Written {
                                    operation: ::dalembert::generated::Operation::SquareRoot,
                                    text: "(q[0] * q[0] + q[1] * q[1]).sqrt()",
                                },
                                [t1, 0.0],
                            ),
                            (
                                &::dalembert::generated::Written {
                                    operation: ::dalembert::generated::Operation::Division,
                                    text: "1.0 / r",
                                },
                                [r, 0.0],
                            ),
                        ],
                    )
                }
                _ => ::core::option::Option::None,
            }
        }
    }
    #[automatically_derived]
    impl ::dalembert::generated::TimeScale<2> for Kepler {
        fn time_scale(&self, q: &Vector) -> f64 {
            self.time_scale((*q).into())
        }
        fn time_scale_gradient(&self, q: &Vector) -> (f64, Vector) {
            let r = (q[0] * q[0] + q[1] * q[1]).sqrt();
            let sqrt_r = r.sqrt();
            let t1 = 0.5 / r * (sqrt_r + 0.5 / sqrt_r * r);
            (r * sqrt_r, SVector::from([2.0 * q[0] * t1, 2.0 * q[1] * t1]))
        }
    }
    #[automatically_derived]
    impl ActingForce<2> for Kepler {}
    #[automatically_derived]
    impl ForcedLagrangian<2> for Kepler {
        type Anchors<const S: usize> = ();
        /// G, P − ∂L/∂v and (∂²L/∂v²)⁻¹ (P − ∂L/∂v) at all stages.
        #[inline]
        fn stages<const S: usize>(
            &self,
            _anchors: &mut Self::Anchors<S>,
            q: &LaneVector<f64, 2, S>,
            v: &LaneVector<f64, 2, S>,
            momenta: impl FnOnce(&LaneVector<f64, 2, S>) -> LaneVector<f64, 2, S>,
        ) -> Stages<f64, 2, S> {
            let r = (q[0] * q[0] + q[1] * q[1]).sqrt();
            let t1 = 1.0 / r;
            let t2 = t1 * t1 * (0.5 / r);
            let rate = [-2.0 * q[0] * t2, -2.0 * q[1] * t2];
            let p = momenta(&rate);
            let residual0 = p[0] - v[0];
            let residual1 = p[1] - v[1];
            Stages {
                rate,
                residual: [residual0, residual1],
                correction: [residual0, residual1],
            }
        }
    }
};
