impl Ring {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        use ::dalembert::dual;
        dual::lower(self.lagrangian_over::<f64>(dual::lift(q), dual::lift(v)))
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        use ::dalembert::dual;
        dual::lower(self.rayleigh_over::<f64>(dual::lift(v)))
    }
}
const _: () = {
    use ::dalembert::dual::{self, Dual, Real};
    #[allow(dead_code)]
    impl Ring {
        /// `lagrangian` over plain and dual numbers.
        #[inline(always)]
        fn lagrangian_over<D: Dual<f64>>(
            &self,
            q: [Real<D>; 2],
            v: [Real<D>; 2],
        ) -> Real<D> {
            let s = q[0] * q[0] + q[1] * q[1];
            0.5 * (v[0] * v[0] + v[1] * v[1]) - s * (s - 1.0).powi(2)
        }
        /// `rayleigh` over plain and dual numbers.
        #[inline(always)]
        fn rayleigh_over<D: Dual<f64>>(&self, v: [Real<D>; 2]) -> Real<D> {
            let k = D::lift(self.k);
            0.5 * k * (v[0] * v[0] + v[1] * v[1])
        }
    }
};
const _: () = {
    use ::dalembert::nalgebra::SVector;
    use ::dalembert::{
        Derivatives, Direction, Discrete, DiscreteForce, DiscreteForceDerivatives,
        DiscreteRayleigh, DisplacementRule, Gradient, Lagrangian, Midpoint, Momenta,
        Rayleigh, StepKernel, Variations, dual,
    };
    type Vector = SVector<f64, 2>;
    #[automatically_derived]
    impl Lagrangian<2> for Ring {
        type Scalar = f64;
        fn lagrangian(&self, q: &Vector, v: &Vector) -> f64 {
            self.lagrangian((*q).into(), (*v).into())
        }
        fn lagrangian_gradient(&self, q: &Vector, v: &Vector) -> Gradient<f64, 2> {
            dual::gradient(q, v, |q, v| self.lagrangian_over(q, v))
        }
        fn lagrangian_derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<f64, 2> {
            dual::derivatives::<f64, 2, 4>(q, v, |q, v| self.lagrangian_over(q, v))
        }
        fn lagrangian_variations(
            &self,
            q: &Vector,
            v: &Vector,
            minus: Direction<f64>,
            plus: Direction<f64>,
        ) -> Variations<f64, 2> {
            dual::variations(q, v, minus, plus, |q, v| self.lagrangian_over(q, v))
        }
    }
    #[automatically_derived]
    impl Rayleigh<2> for Ring {
        fn rayleigh(&self, _q: &Vector, v: &Vector) -> f64 {
            self.rayleigh((*v).into())
        }
        fn rayleigh_gradient(&self, q: &Vector, v: &Vector) -> Gradient<f64, 2> {
            dual::gradient(q, v, |_, v| self.rayleigh_over(v))
        }
        fn rayleigh_derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<f64, 2> {
            dual::derivatives::<f64, 2, 4>(q, v, |_, v| self.rayleigh_over(v))
        }
        fn rayleigh_variations(
            &self,
            q: &Vector,
            v: &Vector,
            minus: Direction<f64>,
            plus: Direction<f64>,
        ) -> Variations<f64, 2> {
            dual::variations(q, v, minus, plus, |_, v| self.rayleigh_over(v))
        }
    }
    #[automatically_derived]
    impl Discrete<Midpoint, 2> for Ring {
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
        fn step_kernel(&self, q0: &Vector, v: &Vector, h: f64) -> StepKernel<f64, 2> {
            Midpoint::lagrangian_kernel(self, q0, v, h)
                + Midpoint::rayleigh_kernel(self, q0, v, h)
        }
        /// p0 = −D1 L_d − f_d⁻ and p1 = D2 L_d + f_d⁺, at q1 = q0 + h v̄.
        fn momenta(&self, q0: &Vector, v: &Vector, h: f64) -> Momenta<f64, 2> {
            Midpoint::lagrangian_momenta(self, q0, v, h)
                + Midpoint::rayleigh_momenta(self, q0, v, h)
        }
        /// E_L on the segment.
        fn segment_energy(&self, q0: &Vector, q1: &Vector, h: f64) -> f64 {
            Midpoint::segment_energy(self, q0, q1, h)
        }
    }
    #[automatically_derived]
    impl DiscreteRayleigh<Midpoint, 2> for Ring {
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
