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
        Rayleigh, StepKernel, Variations,
    };
    #[automatically_derived]
    impl Lagrangian<2> for DoublePendulum {
        type Scalar = f64;
        #[inline]
        fn lagrangian(&self, q: &SVector<f64, 2>, v: &SVector<f64, 2>) -> f64 {
            self.lagrangian((*q).into(), (*v).into())
        }
        #[inline]
        fn lagrangian_gradient(
            &self,
            q: &SVector<f64, 2>,
            v: &SVector<f64, 2>,
        ) -> Gradient<f64, 2> {
            let m2 = self.m[1];
            let t1 = self.m[0] + m2;
            let l1 = self.l[0];
            let t2 = v[0] * (l1 * (0.5 * t1 * l1));
            let l2 = self.l[1];
            let t3 = v[1] * (l2 * (0.5 * m2 * l2));
            let t4 = q[0] - q[1];
            let t5 = l2 * (m2 * l1);
            let t6 = t4.cos() * t5;
            let t7 = v[0] * t6;
            let kinetic = v[0] * t2 + v[1] * t3 + v[1] * t7;
            let g = self.g;
            let t8 = l1 * (-t1 * g);
            let t9 = l2 * (m2 * g);
            let potential = q[0].cos() * t8 - q[1].cos() * t9;
            let t10 = t5 * (v[0] * v[1]) * t4.sin();
            Gradient {
                value: kinetic - potential,
                d1: SVector::from([t8 * q[0].sin() - t10, t10 - t9 * q[1].sin()]),
                d2: SVector::from([t2 + (t2 + v[1] * t6), t3 + (t3 + t7)]),
            }
        }
        #[inline]
        fn lagrangian_derivatives(
            &self,
            q: &SVector<f64, 2>,
            v: &SVector<f64, 2>,
        ) -> Derivatives<f64, 2> {
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
            let g = self.g;
            let t12 = l1 * (-t1 * g);
            let t13 = q[0].cos() * t12;
            let t14 = l2 * (m2 * g);
            let t15 = q[1].cos() * t14;
            let potential = t13 - t15;
            let t16 = t9 * (v[0] * v[1]);
            let t17 = t16 * t8;
            let t18 = t8 * (v[1] * t9);
            let t19 = t8 * (v[0] * t9);
            let t20 = t7 * t16;
            Derivatives {
                value: kinetic - potential,
                d1: SVector::from([t12 * q[0].sin() - t17, t17 - t14 * q[1].sin()]),
                d2: SVector::from([t3 + (t3 + v[1] * t10), t5 + (t5 + t11)]),
                d11: SMatrix::from([[t13 - t20, t20], [t20, -(t15 + t20)]]),
                d12: SMatrix::from([[-t18, t18], [-t19, t19]]),
                d22: SMatrix::from([[2.0 * t2, t10], [t10, 2.0 * t4]]),
            }
        }
        #[inline]
        fn lagrangian_variations(
            &self,
            q: &SVector<f64, 2>,
            v: &SVector<f64, 2>,
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
            let g = self.g;
            let t11 = l1 * (-t1 * g);
            let t12 = l2 * (m2 * g);
            let t13 = t9 * (v[0] * v[1]);
            let t14 = t13 * t8;
            let t15 = t11 * q[0].sin() - t14;
            let t16 = t14 - t12 * q[1].sin();
            let t17 = t5 + (t5 + v[0] * t10);
            let t18 = t3 + (t3 + v[1] * t10);
            let t19 = t8 * (v[1] * t9);
            let t20 = t8 * (v[0] * t9);
            let t21 = t7 * t13;
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
                        2.0 * t2 * t22 - t26 - t27 + (q[0].cos() * t11 - t21) * t25,
                        t27 + (t28 - t29) + t30,
                    ],
                    [
                        t30 + (t26 + t28 - t31),
                        t31 + (t29 + 2.0 * t4 * t22) - (q[1].cos() * t12 + t21) * t25,
                    ],
                ]),
            }
        }
    }
    #[automatically_derived]
    impl Rayleigh<2> for DoublePendulum {
        #[inline]
        fn rayleigh(&self, _q: &SVector<f64, 2>, v: &SVector<f64, 2>) -> f64 {
            self.rayleigh((*v).into())
        }
        #[inline]
        fn rayleigh_gradient(
            &self,
            _q: &SVector<f64, 2>,
            v: &SVector<f64, 2>,
        ) -> Gradient<f64, 2> {
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
        fn rayleigh_derivatives(
            &self,
            _q: &SVector<f64, 2>,
            v: &SVector<f64, 2>,
        ) -> Derivatives<f64, 2> {
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
            _q: &SVector<f64, 2>,
            v: &SVector<f64, 2>,
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
        /// L_d(q0, q1, h).
        fn discrete_lagrangian(
            &self,
            q0: &SVector<f64, 2>,
            q1: &SVector<f64, 2>,
            h: f64,
        ) -> f64 {
            Midpoint::discrete_lagrangian(self, q0, q1, h)
        }
        /// L_d with D1, D2, D11, D12, D22.
        fn discrete_lagrangian_derivatives(
            &self,
            q0: &SVector<f64, 2>,
            q1: &SVector<f64, 2>,
            h: f64,
        ) -> Derivatives<f64, 2> {
            Midpoint::discrete_lagrangian_derivatives(self, q0, q1, h)
        }
        /// f_d = (f_d⁻, f_d⁺).
        fn discrete_force(
            &self,
            q0: &SVector<f64, 2>,
            q1: &SVector<f64, 2>,
            h: f64,
        ) -> DiscreteForce<f64, 2> {
            Midpoint::rayleigh_force(self, q0, q1, h)
        }
        /// f_d with its derivatives by q0 and q1.
        fn discrete_force_derivatives(
            &self,
            q0: &SVector<f64, 2>,
            q1: &SVector<f64, 2>,
            h: f64,
        ) -> DiscreteForceDerivatives<f64, 2> {
            Midpoint::rayleigh_force_derivatives(self, q0, q1, h)
        }
        /// p0 = −D1 L_d − f_d⁻ and ∂p0/∂v̄, at q1 = q0 + h v̄.
        #[inline]
        fn step_kernel(
            &self,
            q0: &SVector<f64, 2>,
            v: &SVector<f64, 2>,
            h: f64,
        ) -> StepKernel<f64, 2> {
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
            let g = self.g;
            let t11 = l1 * (-t1 * g);
            let t12 = l2 * (m2 * g);
            let relative = v[1] - v[0];
            let t13 = 0.5 * self.c[0];
            let t14 = 0.5 * self.c[1];
            let t15 = t9 * (v[0] * v[1]);
            let t16 = t15 * t8;
            let t17 = t7 * t15;
            let t18 = half;
            let t19 = 2.0 * (t14 * t18);
            let dk_drelative = relative * t14 * t18 + t14 * (relative * t18);
            let t20 = t10 - t19;
            let t21 = t18 * t18;
            let t22 = t8 * (v[1] * t9) * t18;
            let t23 = t8 * (v[0] * t9) * t18;
            let t24 = t17 * t21;
            StepKernel {
                p0: SVector::from([
                    t3
                        + (t3
                            + (v[1] * t10
                                + (v[0] * t13 * t18 + t13 * (v[0] * t18) - dk_drelative)))
                        - (t11 * q[0].sin() - t16) * t18,
                    t5 + (t5 + (v[0] * t10 + dk_drelative))
                        - (t16 - t12 * q[1].sin()) * t18,
                ]),
                matrix: SMatrix::from([
                    [
                        t22 + (2.0 * t2 + (t19 + 2.0 * (t13 * t18)) - t22)
                            - (q[0].cos() * t11 - t17) * t21,
                        t20 - t23 - t22 - t24,
                    ],
                    [
                        t23 + (t20 + t22) - t24,
                        2.0 * t4 + t19 + t23 - t23 + (q[1].cos() * t12 + t17) * t21,
                    ],
                ]),
            }
        }
        /// p0 = −D1 L_d − f_d⁻ and p1 = D2 L_d + f_d⁺, at q1 = q0 + h v̄.
        #[inline]
        fn momenta(
            &self,
            q0: &SVector<f64, 2>,
            v: &SVector<f64, 2>,
            h: f64,
        ) -> Momenta<f64, 2> {
            let half = 0.5 * h;
            let q = [q0[0] + half * v[0], q0[1] + half * v[1]];
            let m2 = self.m[1];
            let t1 = self.m[0] + m2;
            let l1 = self.l[0];
            let t2 = v[0] * (l1 * (0.5 * t1 * l1));
            let l2 = self.l[1];
            let t3 = v[1] * (l2 * (0.5 * m2 * l2));
            let t4 = q[0] - q[1];
            let t5 = l2 * (m2 * l1);
            let t6 = t4.cos() * t5;
            let g = self.g;
            let relative = v[1] - v[0];
            let t7 = t5 * (v[0] * v[1]) * t4.sin();
            let t8 = t3 + (t3 + v[0] * t6);
            let t9 = t2 + (t2 + v[1] * t6);
            let dr_drelative = 2.0 * (relative * (0.5 * self.c[1]));
            let t10 = half;
            let t11 = (l1 * (-t1 * g) * q[0].sin() - t7) * t10;
            let t12 = (t7 - l2 * (m2 * g) * q[1].sin()) * t10;
            let t13 = (2.0 * (v[0] * (0.5 * self.c[0])) - dr_drelative) * t10;
            let t14 = dr_drelative * t10;
            Momenta {
                p0: SVector::from([t9 + t13 - t11, t8 + t14 - t12]),
                p1: SVector::from([t11 + (t9 - t13), t12 + (t8 - t14)]),
            }
        }
        /// E_L on the segment.
        fn segment_energy(
            &self,
            q0: &SVector<f64, 2>,
            q1: &SVector<f64, 2>,
            h: f64,
        ) -> f64 {
            Midpoint::segment_energy(self, q0, q1, h)
        }
    }
    #[automatically_derived]
    impl DiscreteRayleigh<Midpoint, 2> for DoublePendulum {
        /// R_d(q0, q1, h).
        fn discrete_rayleigh(
            &self,
            q0: &SVector<f64, 2>,
            q1: &SVector<f64, 2>,
            h: f64,
        ) -> f64 {
            Midpoint::discrete_rayleigh(self, q0, q1, h)
        }
        /// R_d with D1, D2, D11, D12, D22.
        fn discrete_rayleigh_derivatives(
            &self,
            q0: &SVector<f64, 2>,
            q1: &SVector<f64, 2>,
            h: f64,
        ) -> Derivatives<f64, 2> {
            Midpoint::discrete_rayleigh_derivatives(self, q0, q1, h)
        }
    }
};
