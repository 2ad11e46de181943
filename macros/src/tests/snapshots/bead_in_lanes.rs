impl Bead {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        let push = if self.has_wall && q[0] > Self::WALL {
            self.k * (q[0] - Self::WALL)
        } else {
            0.0
        };
        0.5 * self.m * v[0] * v[0] + self.m * self.g * q[0].cos() - push * push
    }
    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.5 * self.r * v[0] * v[0]
    }
}
::dalembert::generated::described! {
    Bead : f64, 1; described_Bead $
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
        ActingForce, Derivatives, Fused, Gradient, Lagrangian, Mask, MemberVector,
        Members, Momenta, Rayleigh, Segment, StepKernel, Trapezoidal,
    };
    use ::dalembert::generated::Elementary as _;
    type Vector = SVector<f64, 1>;
    impl ::dalembert::generated::PlainFields for Bead {
        fn plain_fields<Never>(&self) {
            let _: [&dyn ::dalembert::generated::Plain<bool>; 1] = [&(self.has_wall)];
        }
        #[cold]
        fn first_no_number(
            &self,
        ) -> ::core::option::Option<(::dalembert::generated::Quantity, usize)> {
            let fields: [(&'static str, &dyn ::dalembert::generated::Plain<f64>); 5] = [
                ("WALL", &(Self::WALL)),
                ("k", &(self.k)),
                ("m", &(self.m)),
                ("g", &(self.g)),
                ("r", &(self.r)),
            ];
            ::dalembert::generated::missing::field(&fields)
        }
    }
    /// Known at compile time:
    /// - Derivatives are written out.
    /// - L = T(v) − V(q).
    /// - The mass matrix ∂²L/∂v² is constant.
    /// - The damping force −∂R/∂v is linear in v with constant coefficients.
    /// - By the rule `Trapezoidal` the Newton matrix is constant: a step is one linear solve.
    #[automatically_derived]
    impl Lagrangian<1> for Bead {
        type Scalar = f64;
        const STRUCTURE: ::dalembert::generated::Structure = ::dalembert::generated::Structure::UNKNOWN
            .with_engine(::dalembert::generated::Engine::Expanded)
            .with_constant_mass_matrix()
            .with_separable_lagrangian()
            .with_damping(::dalembert::generated::Damping::Linear)
            .with_newton_matrices(
                &[::dalembert::generated::NewtonStructure::new("Trapezoidal", true, 0)],
            );
        #[inline]
        fn lagrangian(&self, q: &Vector, v: &Vector) -> f64 {
            self.lagrangian((*q).into(), (*v).into())
        }
        #[inline]
        fn lagrangian_gradient(&self, q: &Vector, v: &Vector) -> Gradient<f64, 1> {
            let wall = Self::WALL;
            let t1 = self.has_wall && q[0] > wall;
            let k = self.k;
            let push = if t1 { k * (q[0] - wall) } else { 0.0 };
            let m = self.m;
            let (sin_q0, cos_q0) = q[0].sin_cos();
            let t2 = m * self.g;
            let t3 = if t1 { -2.0 * k * push } else { 0.0 };
            Gradient {
                value: 0.5 * m * v[0] * v[0] + t2 * cos_q0 - push * push,
                d1: SVector::from([t3 - t2 * sin_q0]),
                d2: SVector::from([m * v[0]]),
            }
        }
        #[inline]
        fn lagrangian_derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<f64, 1> {
            let wall = Self::WALL;
            let t1 = self.has_wall && q[0] > wall;
            let k = self.k;
            let push = if t1 { k * (q[0] - wall) } else { 0.0 };
            let m = self.m;
            let (sin_q0, cos_q0) = q[0].sin_cos();
            let t2 = m * self.g;
            let t3 = t2 * cos_q0;
            let t4 = 2.0 * k;
            let t5 = if t1 { -k * t4 } else { 0.0 };
            let t6 = if t1 { -t4 * push } else { 0.0 };
            Derivatives {
                value: 0.5 * m * v[0] * v[0] + t3 - push * push,
                d1: SVector::from([t6 - t2 * sin_q0]),
                d2: SVector::from([m * v[0]]),
                d11: SMatrix::from([[t5 - t3]]),
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
            ::core::option::Option::Some(
                ActingForce::acting_force_derivatives(self, q, v),
            )
        }
    }
    #[automatically_derived]
    impl Rayleigh<1> for Bead {
        #[inline]
        fn rayleigh(&self, _q: &Vector, v: &Vector) -> f64 {
            self.rayleigh((*v).into())
        }
        #[inline]
        fn rayleigh_gradient(&self, _q: &Vector, v: &Vector) -> Gradient<f64, 1> {
            let r = self.r;
            Gradient {
                value: 0.5 * r * v[0] * v[0],
                d1: SVector::zeros(),
                d2: SVector::from([r * v[0]]),
            }
        }
        #[inline]
        fn rayleigh_derivatives(&self, _q: &Vector, v: &Vector) -> Derivatives<f64, 1> {
            let r = self.r;
            Derivatives {
                value: 0.5 * r * v[0] * v[0],
                d1: SVector::zeros(),
                d2: SVector::from([r * v[0]]),
                d11: SMatrix::zeros(),
                d12: SMatrix::zeros(),
                d22: SMatrix::from([[r]]),
            }
        }
    }
    #[automatically_derived]
    impl ActingForce<1> for Bead {
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
    impl Fused<Trapezoidal, 1> for Bead {
        type Matrix = SMatrix<f64, 1, 1>;
        type Memory = ::dalembert::generated::ExplicitMemory<f64, Self::Matrix, 1>;
        type Border = ::dalembert::generated::Free;
        const LINEAR: bool = true;
        const WRITTEN_OUT: bool = true;
        /// p0 = −D1 L_d − f_d⁻ and ∂p0/∂v̄.
        #[inline]
        fn step_kernel(&self, segment: &Segment<f64, 1>) -> StepKernel<f64, 1> {
            let (q0, v, h) = (&segment.q0, &segment.v, segment.h);
            let half = 0.5 * h;
            let wall = Self::WALL;
            let k = self.k;
            let m = self.m;
            let t1 = self.has_wall && q0[0] > wall;
            let push_start = if t1 { k * (q0[0] - wall) } else { 0.0 };
            let t2 = m + self.r * half;
            let t3 = if t1 { -2.0 * k * push_start } else { 0.0 };
            StepKernel {
                p0: SVector::from([t2 * v[0] - half * (t3 - m * self.g * q0[0].sin())]),
                matrix: SMatrix::from([[t2]]),
            }
        }
        /// p0 = −D1 L_d − f_d⁻ and p1 = D2 L_d + f_d⁺.
        #[inline]
        fn momenta(&self, segment: &Segment<f64, 1>) -> Momenta<f64, 1> {
            let (q0, v, h) = (&segment.q0, &segment.v, segment.h);
            let half = 0.5 * h;
            let q1 = [q0[0] + h * v[0]];
            let t1 = self.has_wall;
            let wall = Self::WALL;
            let k = self.k;
            let m = self.m;
            let t2 = m * self.g;
            let t3 = 2.0 * k;
            let t4 = m * v[0];
            let t5 = t1 && q0[0] > wall;
            let push_start = if t5 { k * (q0[0] - wall) } else { 0.0 };
            let t6 = t1 && q1[0] > wall;
            let push_end = if t6 { k * (q1[0] - wall) } else { 0.0 };
            let t7 = if t5 { -t3 * push_start } else { 0.0 };
            let t8 = self.r * half * v[0];
            let t9 = if t6 { -t3 * push_end } else { 0.0 };
            Momenta {
                p0: SVector::from([t4 + t8 - half * (t7 - t2 * q0[0].sin())]),
                p1: SVector::from([t4 + half * (t9 - t2 * q1[0].sin()) - t8]),
            }
        }
    }
    #[automatically_derived]
    impl ::dalembert::generated::Explicit<1> for Bead {
        #[inline]
        fn step_matrix(&self, h: f64) -> <Self as Fused<Trapezoidal, 1>>::Matrix {
            let half = 0.5 * h;
            SMatrix::from([[self.m + self.r * half]])
        }
        #[inline]
        fn velocity_momenta(&self, v: &Vector, h: f64) -> Momenta<f64, 1> {
            let half = 0.5 * h;
            let t1 = self.m * v[0];
            let t2 = self.r * half * v[0];
            Momenta {
                p0: SVector::from([t1 + t2]),
                p1: SVector::from([t1 - t2]),
            }
        }
        #[inline]
        fn configuration_force(&self, q: &Vector) -> Vector {
            let wall = Self::WALL;
            let t1 = self.has_wall && q[0] > wall;
            let k = self.k;
            let push = if t1 { k * (q[0] - wall) } else { 0.0 };
            let t2 = if t1 { -2.0 * k * push } else { 0.0 };
            SVector::from([t2 - self.m * self.g * q[0].branch_free().sin()])
        }
    }
    #[automatically_derived]
    impl ::dalembert::generated::Gathered<1> for Bead {
        type Fields<'s, const W: usize> = ([Members<f64, W>; 5], [Mask<W>; 1])
        where
            Self: 's;
        fn fields<const W: usize>(systems: [&Self; W]) -> Self::Fields<'_, W> {
            (
                Members::of_each(
                    systems
                        .map(|system| {
                            let k = system.k;
                            let m = system.m;
                            [k, m, m * system.g, system.r, 2.0 * k]
                        }),
                ),
                Mask::of_each(systems.map(|system| [system.has_wall])),
            )
        }
    }
    #[automatically_derived]
    impl ::dalembert::generated::ExplicitInLanes<1> for Bead {
        #[inline(always)]
        fn velocity_momenta_in_lanes<'s, const W: usize>(
            fields: &Self::Fields<'s, W>,
            v: &MemberVector<f64, 1, W>,
            h: f64,
        ) -> [MemberVector<f64, 1, W>; 2]
        where
            Self: 's,
        {
            let ([_, m, _, r, _], [_]) = *fields;
            let half = 0.5 * h;
            let t1 = m * v[0];
            let t2 = r * half * v[0];
            [[t1 + t2], [t1 - t2]]
        }
        #[inline(always)]
        fn configuration_force_in_lanes<'s, const W: usize>(
            fields: &Self::Fields<'s, W>,
            q: &MemberVector<f64, 1, W>,
        ) -> MemberVector<f64, 1, W>
        where
            Self: 's,
        {
            let ([k, _, t2, _, t3], [t1]) = *fields;
            let wall = Self::WALL;
            let t4 = t1 & Members::<f64, W>::splat(wall).less(q[0]);
            let push = Members::select(
                t4,
                k * (q[0] - wall),
                Members::<f64, W>::splat(0.0),
            );
            let t5 = Members::select(t4, -t3 * push, Members::<f64, W>::splat(0.0));
            [t5 - t2 * q[0].sin()]
        }
    }
    #[automatically_derived]
    impl ::dalembert::generated::OffersMethods<1> for Bead {
        type Methods = ::dalembert::generated::WithSplittings<Trapezoidal>;
    }
};
