impl Chain {
    fn lagrangian(&self, q: [f64; 4], v: [f64; 4]) -> f64 {
        let kinetic = v.iter().map(|v| 0.5 * v * v).sum::<f64>();
        let springs: f64 = q
            .windows(2)
            .map(|q| Self::spring(self.beta, q[1] - q[0]))
            .sum();
        kinetic - springs
    }
    fn spring(beta: f64, d: f64) -> f64 {
        let square = d * d;
        0.5 * square + 0.25 * beta * square * square
    }
}
::dalembert::generated::described! {
    Chain : f64, 4; described_Chain $
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
        Segment, StepKernel,
    };
    type Vector = SVector<f64, 4>;
    impl ::dalembert::generated::PlainFields for Chain {
        fn plain_fields<Never>(&self) {
            use ::dalembert::generated::SliceMethods as _;
            let _: [::dalembert::generated::OfSlice; 2] = [
                [0f64; 4].iter(),
                [0f64; 4].windows(),
            ];
        }
        #[cold]
        fn first_no_number(
            &self,
        ) -> ::core::option::Option<(::dalembert::generated::Quantity, usize)> {
            let fields: [(&'static str, &dyn ::dalembert::generated::Plain<f64>); 1] = [
                ("beta", &(self.beta)),
            ];
            ::dalembert::generated::missing::field(&fields)
        }
    }
    /// Known at compile time:
    /// - Derivatives are written out.
    /// - L = T(v) − V(q).
    /// - The mass matrix ∂²L/∂v² is constant.
    /// - By the rule `Midpoint` the Newton matrix is tridiagonal and changes with the state.
    #[automatically_derived]
    impl Lagrangian<4> for Chain {
        type Scalar = f64;
        const STRUCTURE: ::dalembert::generated::Structure = ::dalembert::generated::Structure::UNKNOWN
            .with_engine(::dalembert::generated::Engine::Expanded)
            .with_constant_mass_matrix()
            .with_separable_lagrangian()
            .with_damping(::dalembert::generated::Damping::Absent)
            .with_newton_matrices(
                &[::dalembert::generated::NewtonStructure::new("Midpoint", false, 1)],
            );
        #[inline]
        fn lagrangian(&self, q: &Vector, v: &Vector) -> f64 {
            self.lagrangian((*q).into(), (*v).into())
        }
        #[inline]
        fn lagrangian_gradient(&self, q: &Vector, v: &Vector) -> Gradient<f64, 4> {
            let kinetic = 0.5 * v[0] * v[0] + 0.5 * v[1] * v[1] + 0.5 * v[2] * v[2]
                + 0.5 * v[3] * v[3];
            let d = q[1] - q[0];
            let square = d * d;
            let beta = self.beta;
            let t1 = 0.25 * beta;
            let d_2 = q[2] - q[1];
            let square_2 = d_2 * d_2;
            let d_3 = q[3] - q[2];
            let square_3 = d_3 * d_3;
            let springs = 0.5 * square_3 + t1 * square_3 * square_3
                + (0.5 * square + t1 * square * square
                    + (0.5 * square_2 + t1 * square_2 * square_2));
            let t2 = 0.5 * beta;
            let dl_dsquare = -(0.5 + t2 * square_3);
            let dl_dd = 2.0 * d_3 * dl_dsquare;
            let dl_dsquare_2 = -(0.5 + t2 * square_2);
            let dl_dd_2 = 2.0 * d_2 * dl_dsquare_2;
            let dl_dsquare_3 = -(0.5 + t2 * square);
            let dl_dd_3 = 2.0 * d * dl_dsquare_3;
            Gradient {
                value: kinetic - springs,
                d1: SVector::from([-dl_dd_3, dl_dd_3 - dl_dd_2, dl_dd_2 - dl_dd, dl_dd]),
                d2: SVector::from([v[0], v[1], v[2], v[3]]),
            }
        }
        #[inline]
        fn lagrangian_derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<f64, 4> {
            let kinetic = 0.5 * v[0] * v[0] + 0.5 * v[1] * v[1] + 0.5 * v[2] * v[2]
                + 0.5 * v[3] * v[3];
            let d = q[1] - q[0];
            let square = d * d;
            let beta = self.beta;
            let t1 = 0.25 * beta;
            let d_2 = q[2] - q[1];
            let square_2 = d_2 * d_2;
            let d_3 = q[3] - q[2];
            let square_3 = d_3 * d_3;
            let springs = 0.5 * square_3 + t1 * square_3 * square_3
                + (0.5 * square + t1 * square * square
                    + (0.5 * square_2 + t1 * square_2 * square_2));
            let t2 = 2.0 * d_3;
            let t3 = 2.0 * d_2;
            let t4 = 2.0 * d;
            let t5 = 0.5 * beta;
            let dl_dsquare = -(0.5 + t5 * square_3);
            let dl_dd = t2 * dl_dsquare;
            let dl_dsquare_2 = -(0.5 + t5 * square_2);
            let dl_dd_2 = t3 * dl_dsquare_2;
            let dl_dsquare_3 = -(0.5 + t5 * square);
            let dl_dd_3 = t4 * dl_dsquare_3;
            let t6 = 2.0 * dl_dsquare - beta * d_3 * t2;
            let t7 = -t6;
            let t8 = 2.0 * dl_dsquare_2 - beta * d_2 * t3;
            let t9 = -t8;
            let t10 = 2.0 * dl_dsquare_3 - beta * d * t4;
            let t11 = -t10;
            Derivatives {
                value: kinetic - springs,
                d1: SVector::from([-dl_dd_3, dl_dd_3 - dl_dd_2, dl_dd_2 - dl_dd, dl_dd]),
                d2: SVector::from([v[0], v[1], v[2], v[3]]),
                d11: SMatrix::from([
                    [t10, t11, 0.0, 0.0],
                    [t11, t8 + t10, t9, 0.0],
                    [0.0, t9, t6 + t8, t7],
                    [0.0, 0.0, t7, t6],
                ]),
                d12: SMatrix::zeros(),
                d22: SMatrix::from([
                    [1.0, 0.0, 0.0, 0.0],
                    [0.0, 1.0, 0.0, 0.0],
                    [0.0, 0.0, 1.0, 0.0],
                    [0.0, 0.0, 0.0, 1.0],
                ]),
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
    }
    #[automatically_derived]
    impl ActingForce<4> for Chain {}
    #[automatically_derived]
    impl Fused<Midpoint, 4> for Chain {
        type Matrix = ::dalembert::generated::Banded<f64, 4, 3>;
        type Memory = ::dalembert::generated::KeptMatrix<f64, Self::Matrix, 4>;
        type Border = ::dalembert::generated::Free;
        const WRITTEN_OUT: bool = true;
        /// p0 = −D1 L_d − f_d⁻ and ∂p0/∂v̄.
        #[inline]
        fn step_kernel(
            &self,
            segment: &Segment<f64, 4>,
        ) -> StepKernel<f64, 4, Self::Matrix> {
            let (q0, v, h) = (&segment.q0, &segment.v, segment.h);
            let half = 0.5 * h;
            let q = [
                q0[0] + half * v[0],
                q0[1] + half * v[1],
                q0[2] + half * v[2],
                q0[3] + half * v[3],
            ];
            let d = q[1] - q[0];
            let square = d * d;
            let beta = self.beta;
            let d_2 = q[2] - q[1];
            let square_2 = d_2 * d_2;
            let d_3 = q[3] - q[2];
            let square_3 = d_3 * d_3;
            let t1 = 2.0 * d_3;
            let t2 = 2.0 * d_2;
            let t3 = 2.0 * d;
            let t4 = 0.5 * beta;
            let dl_dsquare = -(0.5 + t4 * square_3);
            let dl_dd = t1 * dl_dsquare;
            let dl_dsquare_2 = -(0.5 + t4 * square_2);
            let dl_dd_2 = t2 * dl_dsquare_2;
            let dl_dsquare_3 = -(0.5 + t4 * square);
            let dl_dd_3 = t3 * dl_dsquare_3;
            let t5 = 2.0 * dl_dsquare - beta * d_3 * t1;
            let t6 = 2.0 * dl_dsquare_2 - beta * d_2 * t2;
            let t7 = 2.0 * dl_dsquare_3 - beta * d * t3;
            let t8 = half * half;
            let t9 = t8 * t7;
            let t10 = t8 * t6;
            let t11 = t8 * t5;
            StepKernel {
                p0: SVector::from([
                    v[0] + half * dl_dd_3,
                    v[1] - half * (dl_dd_3 - dl_dd_2),
                    v[2] - half * (dl_dd_2 - dl_dd),
                    v[3] - half * dl_dd,
                ]),
                matrix: ::dalembert::generated::Banded {
                    rows: [
                        [0.0, 1.0 - t9, t9],
                        [t9, 1.0 - t8 * (t6 + t7), t10],
                        [t10, 1.0 - t8 * (t5 + t6), t11],
                        [t11, 1.0 - t11, 0.0],
                    ],
                },
            }
        }
        /// p0 = −D1 L_d − f_d⁻ and p1 = D2 L_d + f_d⁺.
        #[inline]
        fn momenta(&self, segment: &Segment<f64, 4>) -> Momenta<f64, 4> {
            let (q0, v, h) = (&segment.q0, &segment.v, segment.h);
            let half = 0.5 * h;
            let q = [
                q0[0] + half * v[0],
                q0[1] + half * v[1],
                q0[2] + half * v[2],
                q0[3] + half * v[3],
            ];
            let d = q[1] - q[0];
            let square = d * d;
            let d_2 = q[2] - q[1];
            let square_2 = d_2 * d_2;
            let d_3 = q[3] - q[2];
            let square_3 = d_3 * d_3;
            let t1 = 0.5 * self.beta;
            let dl_dsquare = -(0.5 + t1 * square_3);
            let dl_dd = 2.0 * d_3 * dl_dsquare;
            let dl_dsquare_2 = -(0.5 + t1 * square_2);
            let dl_dd_2 = 2.0 * d_2 * dl_dsquare_2;
            let dl_dsquare_3 = -(0.5 + t1 * square);
            let dl_dd_3 = 2.0 * d * dl_dsquare_3;
            let t2 = half * dl_dd_3;
            let t3 = half * (dl_dd_3 - dl_dd_2);
            let t4 = half * (dl_dd_2 - dl_dd);
            let t5 = half * dl_dd;
            Momenta {
                p0: SVector::from([v[0] + t2, v[1] - t3, v[2] - t4, v[3] - t5]),
                p1: SVector::from([v[0] - t2, v[1] + t3, v[2] + t4, v[3] + t5]),
            }
        }
    }
    #[automatically_derived]
    impl ::dalembert::generated::OffersMethods<4> for Chain {
        type Methods = Midpoint;
    }
};
