impl DoublePendulum {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let [m1, m2] = self.m;
        let [l1, l2] = self.l;
        let kinetic = 0.5 * (m1 + m2) * l1 * l1 * v[0] * v[0]
            + 0.5 * m2 * l2 * l2 * v[1] * v[1]
            + m2 * l1 * l2 * (q[0] - q[1]).cos() * v[0] * v[1];
        let potential = -(m1 + m2) * self.g * l1 * q[0].cos()
            - m2 * self.g * l2 * q[1].cos();
        kinetic - potential
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        let relative = v[1] - v[0];
        0.5 * self.c[0] * v[0] * v[0] + 0.5 * self.c[1] * relative * relative
    }
}
const _: () = {
    use ::dalembert::nalgebra::{SMatrix, SVector};
    use ::dalembert::{
        Derivatives, Direction, Discrete, DiscreteForce, DiscreteForceDerivatives,
        DiscreteRayleigh, DisplacementRule, Gradient, Lagrangian, Midpoint, Momenta,
        Rayleigh, StepKernel, Variations, VelocityHistory,
    };
    type Vector = SVector<f64, 2>;
    #[automatically_derived]
    impl Lagrangian<2> for DoublePendulum {
        type Scalar = f64;
        #[inline]
        fn lagrangian(&self, q: &Vector, v: &Vector) -> f64 {
            self.lagrangian((*q).into(), (*v).into())
        }
        #[inline]
        fn lagrangian_gradient(&self, q: &Vector, v: &Vector) -> Gradient<f64, 2> {
            let m2 = self.m[1];
            let t1 = self.m[0] + m2;
            let l1 = self.l[0];
            let t2 = v[0] * (l1 * (0.5 * t1 * l1));
            let l2 = self.l[1];
            let t3 = v[1] * (l2 * (0.5 * m2 * l2));
            let t4 = q[0] - q[1];
            let (t6, t5) = t4.sin_cos();
            let t7 = l2 * (m2 * l1);
            let t8 = t5 * t7;
            let t9 = v[0] * t8;
            let kinetic = v[0] * t2 + v[1] * t3 + v[1] * t9;
            let (sin_q0, cos_q0) = q[0].sin_cos();
            let g = self.g;
            let t10 = l1 * (-t1 * g);
            let (sin_q1, cos_q1) = q[1].sin_cos();
            let t11 = l2 * (m2 * g);
            let potential = cos_q0 * t10 - cos_q1 * t11;
            let t12 = t7 * (v[0] * v[1]) * t6;
            Gradient {
                value: kinetic - potential,
                d1: SVector::from([t10 * sin_q0 - t12, t12 - t11 * sin_q1]),
                d2: SVector::from([t2 + (t2 + v[1] * t8), t3 + (t3 + t9)]),
            }
        }
        #[inline]
        fn lagrangian_derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<f64, 2> {
            let m2 = self.m[1];
            let t1 = self.m[0] + m2;
            let l1 = self.l[0];
            let t2 = l1 * (0.5 * t1 * l1);
            let t3 = v[0] * t2;
            let l2 = self.l[1];
            let t4 = l2 * (0.5 * m2 * l2);
            let t5 = v[1] * t4;
            let t6 = q[0] - q[1];
            let (t8, t7) = t6.sin_cos();
            let t9 = l2 * (m2 * l1);
            let t10 = t7 * t9;
            let t11 = v[0] * t10;
            let kinetic = v[0] * t3 + v[1] * t5 + v[1] * t11;
            let (sin_q0, cos_q0) = q[0].sin_cos();
            let g = self.g;
            let t12 = l1 * (-t1 * g);
            let t13 = cos_q0 * t12;
            let (sin_q1, cos_q1) = q[1].sin_cos();
            let t14 = l2 * (m2 * g);
            let t15 = cos_q1 * t14;
            let potential = t13 - t15;
            let t16 = v[0] * v[1];
            let t17 = t9 * t16 * t8;
            let t18 = t8 * (v[1] * t9);
            let t19 = t8 * (v[0] * t9);
            let t20 = t10 * t16;
            Derivatives {
                value: kinetic - potential,
                d1: SVector::from([t12 * sin_q0 - t17, t17 - t14 * sin_q1]),
                d2: SVector::from([t3 + (t3 + v[1] * t10), t5 + (t5 + t11)]),
                d11: SMatrix::from([[t13 - t20, t20], [t20, -(t15 + t20)]]),
                d12: SMatrix::from([[-t18, t18], [-t19, t19]]),
                d22: SMatrix::from([[2.0 * t2, t10], [t10, 2.0 * t4]]),
            }
        }
        #[inline]
        fn lagrangian_variations(
            &self,
            q: &Vector,
            v: &Vector,
            minus: Direction<f64>,
            plus: Direction<f64>,
        ) -> Variations<f64, 2> {
            let m2 = self.m[1];
            let t1 = self.m[0] + m2;
            let l1 = self.l[0];
            let t2 = l1 * (0.5 * t1 * l1);
            let t3 = v[0] * t2;
            let l2 = self.l[1];
            let t4 = l2 * (0.5 * m2 * l2);
            let t5 = v[1] * t4;
            let t6 = q[0] - q[1];
            let (t8, t7) = t6.sin_cos();
            let t9 = l2 * (m2 * l1);
            let t10 = t7 * t9;
            let (sin_q0, cos_q0) = q[0].sin_cos();
            let g = self.g;
            let t11 = l1 * (-t1 * g);
            let (sin_q1, cos_q1) = q[1].sin_cos();
            let t12 = l2 * (m2 * g);
            let t13 = v[0] * v[1];
            let t14 = t9 * t13 * t8;
            let t15 = t11 * sin_q0 - t14;
            let t16 = t14 - t12 * sin_q1;
            let t17 = t5 + (t5 + v[0] * t10);
            let t18 = t3 + (t3 + v[1] * t10);
            let t19 = t8 * (v[1] * t9);
            let t20 = t8 * (v[0] * t9);
            let t21 = t10 * t13;
            let minus_first = minus.first;
            let minus_second = minus.second;
            let plus_first = plus.first;
            let plus_second = plus.second;
            let t22 = minus_second * plus_second;
            let t23 = minus_second * plus_first;
            let t24 = minus_first * plus_second;
            let t25 = minus_first * plus_first;
            let t26 = t19 * t23;
            let t27 = t19 * t24;
            let t28 = t10 * t22;
            let t29 = t20 * t23;
            let t30 = t21 * t25;
            let t31 = t20 * t24;
            Variations {
                minus: SVector::from([
                    t18 * minus_second + t15 * minus_first,
                    t17 * minus_second + t16 * minus_first,
                ]),
                plus: SVector::from([
                    t18 * plus_second + t15 * plus_first,
                    t17 * plus_second + t16 * plus_first,
                ]),
                mixed: SMatrix::from([
                    [
                        2.0 * t2 * t22 - t26 - t27 + (cos_q0 * t11 - t21) * t25,
                        t27 + (t28 - t29) + t30,
                    ],
                    [
                        t30 + (t26 + t28 - t31),
                        t31 + (t29 + 2.0 * t4 * t22) - (cos_q1 * t12 + t21) * t25,
                    ],
                ]),
            }
        }
    }
    #[automatically_derived]
    impl Rayleigh<2> for DoublePendulum {
        #[inline]
        fn rayleigh(&self, _q: &Vector, v: &Vector) -> f64 {
            self.rayleigh((*v).into())
        }
        #[inline]
        fn rayleigh_gradient(&self, _q: &Vector, v: &Vector) -> Gradient<f64, 2> {
            let relative = v[1] - v[0];
            let t1 = v[0] * (0.5 * self.c[0]);
            let t2 = relative * (0.5 * self.c[1]);
            let dr_drelative = 2.0 * t2;
            Gradient {
                value: v[0] * t1 + relative * t2,
                d1: SVector::from([0.0, 0.0]),
                d2: SVector::from([2.0 * t1 - dr_drelative, dr_drelative]),
            }
        }
        #[inline]
        fn rayleigh_derivatives(&self, _q: &Vector, v: &Vector) -> Derivatives<f64, 2> {
            let relative = v[1] - v[0];
            let c_0 = self.c[0];
            let t1 = v[0] * (0.5 * c_0);
            let c_1 = self.c[1];
            let t2 = relative * (0.5 * c_1);
            let dr_drelative = 2.0 * t2;
            let t3 = -c_1;
            Derivatives {
                value: v[0] * t1 + relative * t2,
                d1: SVector::from([0.0, 0.0]),
                d2: SVector::from([2.0 * t1 - dr_drelative, dr_drelative]),
                d11: SMatrix::from([[0.0, 0.0], [0.0, 0.0]]),
                d12: SMatrix::from([[0.0, 0.0], [0.0, 0.0]]),
                d22: SMatrix::from([[c_0 + c_1, t3], [t3, c_1]]),
            }
        }
        #[inline]
        fn rayleigh_variations(
            &self,
            _q: &Vector,
            v: &Vector,
            minus: Direction<f64>,
            plus: Direction<f64>,
        ) -> Variations<f64, 2> {
            let relative = v[1] - v[0];
            let c_0 = self.c[0];
            let c_1 = self.c[1];
            let minus_second = minus.second;
            let plus_second = plus.second;
            let t1 = minus_second * plus_second;
            let dr_drelative = 2.0 * (relative * (0.5 * c_1));
            let t2 = 2.0 * (v[0] * (0.5 * c_0)) - dr_drelative;
            let t3 = c_1 * t1;
            let t4 = -t3;
            Variations {
                minus: SVector::from([minus_second * t2, minus_second * dr_drelative]),
                plus: SVector::from([plus_second * t2, plus_second * dr_drelative]),
                mixed: SMatrix::from([[t1 * (c_0 + c_1), t4], [t4, t3]]),
            }
        }
    }
    #[automatically_derived]
    impl Discrete<Midpoint, 2> for DoublePendulum {
        type Matrix = SMatrix<f64, 2, 2>;
        type Memory = VelocityHistory<f64, 2>;
        /// L_d = h L(q̄, v̄), with q̄ = (q0 + q1)/2 and v̄ = (q1 − q0)/h.
        fn discrete_lagrangian(&self, q0: &Vector, q1: &Vector, h: f64) -> f64 {
            Midpoint::discrete_lagrangian(self, q0, q1, h)
        }
        /// L_d with D1, D2, D11, D12, D22.
        fn discrete_lagrangian_derivatives(
            &self,
            q0: &Vector,
            q1: &Vector,
            h: f64,
        ) -> Derivatives<f64, 2> {
            Midpoint::discrete_lagrangian_derivatives(self, q0, q1, h)
        }
        /// f_d⁻ = D1 R_d, f_d⁺ = −D2 R_d.
        fn discrete_force(
            &self,
            q0: &Vector,
            q1: &Vector,
            h: f64,
        ) -> DiscreteForce<f64, 2> {
            Midpoint::rayleigh_force(self, q0, q1, h)
        }
        /// f_d with its derivatives by q0 and q1.
        fn discrete_force_derivatives(
            &self,
            q0: &Vector,
            q1: &Vector,
            h: f64,
        ) -> DiscreteForceDerivatives<f64, 2> {
            Midpoint::rayleigh_force_derivatives(self, q0, q1, h)
        }
        /// p0 = −D1 L_d − f_d⁻ and ∂p0/∂v̄, at q1 = q0 + h v̄.
        #[inline]
        fn step_kernel(&self, q0: &Vector, v: &Vector, h: f64) -> StepKernel<f64, 2> {
            let half = 0.5 * h;
            let q = [q0[0] + half * v[0], q0[1] + half * v[1]];
            let m2 = self.m[1];
            let t1 = self.m[0] + m2;
            let l1 = self.l[0];
            let t2 = l1 * (0.5 * t1 * l1);
            let t3 = v[0] * t2;
            let l2 = self.l[1];
            let t4 = l2 * (0.5 * m2 * l2);
            let t5 = v[1] * t4;
            let t6 = q[0] - q[1];
            let (t8, t7) = t6.sin_cos();
            let t9 = l2 * (m2 * l1);
            let t10 = t7 * t9;
            let (sin_q0, cos_q0) = q[0].sin_cos();
            let g = self.g;
            let t11 = l1 * (-t1 * g);
            let (sin_q1, cos_q1) = q[1].sin_cos();
            let t12 = l2 * (m2 * g);
            let relative = v[1] - v[0];
            let c_0 = self.c[0];
            let c_1 = self.c[1];
            let t13 = v[0] * v[1];
            let t14 = t9 * t13 * t8;
            let t15 = t10 * t13;
            let dr_drelative = 2.0 * (relative * (0.5 * c_1));
            let t16 = c_1 * half;
            let t17 = t10 - t16;
            let t18 = half * half;
            let t19 = t8 * (v[0] * t9) * half;
            let t20 = t8 * (v[1] * t9) * half;
            let t21 = t15 * t18;
            StepKernel {
                p0: SVector::from([
                    t3 + (t3 + v[1] * t10)
                        + (2.0 * (v[0] * (0.5 * c_0)) - dr_drelative) * half
                        - (t11 * sin_q0 - t14) * half,
                    t5 + (t5 + v[0] * t10) + dr_drelative * half
                        - (t14 - t12 * sin_q1) * half,
                ]),
                matrix: SMatrix::from([
                    [
                        2.0 * t2 + (c_0 + c_1) * half - (cos_q0 * t11 - t15) * t18,
                        t17 - t19 - t20 - t21,
                    ],
                    [
                        t19 + (t17 + t20) - t21,
                        2.0 * t4 + t16 + (cos_q1 * t12 + t15) * t18,
                    ],
                ]),
            }
        }
        /// p0 = −D1 L_d − f_d⁻ and p1 = D2 L_d + f_d⁺, at q1 = q0 + h v̄.
        #[inline]
        fn momenta(&self, q0: &Vector, v: &Vector, h: f64) -> Momenta<f64, 2> {
            let half = 0.5 * h;
            let q = [q0[0] + half * v[0], q0[1] + half * v[1]];
            let m2 = self.m[1];
            let t1 = self.m[0] + m2;
            let l1 = self.l[0];
            let t2 = v[0] * (l1 * (0.5 * t1 * l1));
            let l2 = self.l[1];
            let t3 = v[1] * (l2 * (0.5 * m2 * l2));
            let t4 = q[0] - q[1];
            let (t6, t5) = t4.sin_cos();
            let t7 = l2 * (m2 * l1);
            let t8 = t5 * t7;
            let g = self.g;
            let relative = v[1] - v[0];
            let t9 = t7 * (v[0] * v[1]) * t6;
            let t10 = t3 + (t3 + v[0] * t8);
            let t11 = t2 + (t2 + v[1] * t8);
            let dr_drelative = 2.0 * (relative * (0.5 * self.c[1]));
            let t12 = (2.0 * (v[0] * (0.5 * self.c[0])) - dr_drelative) * half;
            let t13 = dr_drelative * half;
            let t14 = (l1 * (-t1 * g) * q[0].sin() - t9) * half;
            let t15 = (t9 - l2 * (m2 * g) * q[1].sin()) * half;
            Momenta {
                p0: SVector::from([t11 + t12 - t14, t10 + t13 - t15]),
                p1: SVector::from([t11 - t12 + t14, t10 - t13 + t15]),
            }
        }
        /// E_L on the segment.
        fn segment_energy(&self, q0: &Vector, q1: &Vector, h: f64) -> f64 {
            Midpoint::segment_energy(self, q0, q1, h)
        }
    }
    #[automatically_derived]
    impl DiscreteRayleigh<Midpoint, 2> for DoublePendulum {
        /// R_d = (h²/2) R(q̄, v̄), with q̄ = (q0 + q1)/2 and v̄ = (q1 − q0)/h.
        fn discrete_rayleigh(&self, q0: &Vector, q1: &Vector, h: f64) -> f64 {
            Midpoint::discrete_rayleigh(self, q0, q1, h)
        }
        /// R_d with D1, D2, D11, D12, D22.
        fn discrete_rayleigh_derivatives(
            &self,
            q0: &Vector,
            q1: &Vector,
            h: f64,
        ) -> Derivatives<f64, 2> {
            Midpoint::discrete_rayleigh_derivatives(self, q0, q1, h)
        }
    }
};
