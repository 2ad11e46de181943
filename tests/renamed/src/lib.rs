//! A crate that knows dalembert as `mechanics`: the attribute is told by `crate = mechanics`, and whatever it
//! generated under the old name would not compile here.

#[cfg(test)]
mod tests {
    use mechanics::nalgebra::{Matrix2, matrix, vector};
    use mechanics::{Discretise, Gauss, Midpoint, State, differentiable, rayleigh_system};

    struct Pendulum {
        m: f64,
        r: f64,
    }

    /// With an input, the time, parameters and second derivatives, so that all that can be generated is.
    #[rayleigh_system(
        rule = [midpoint, trapezoidal, gauss],
        parameters = [m, r],
        step_derivatives = second,
        crate = mechanics
    )]
    impl Pendulum {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
            0.5 * self.m * v[0] * v[0] + (1.0 + 0.1 * t.sin()) * q[0].cos()
        }

        fn rayleigh(&self, v: [f64; 1]) -> f64 {
            0.5 * self.r * v[0] * v[0]
        }

        fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
            u
        }
    }

    struct Oscillator {
        k: f64,
    }

    #[rayleigh_system(rule = [midpoint, fitted, one_sided], crate = mechanics)]
    impl Oscillator {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            0.5 * v[0] * v[0] - 0.5 * self.k * q[0] * q[0]
        }

        fn rayleigh(&self, v: [f64; 1]) -> f64 {
            0.05 * v[0] * v[0]
        }
    }

    struct ByDuals {
        k: f64,
    }

    #[rayleigh_system(derivatives = num_dual, crate = mechanics)]
    impl ByDuals {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            0.5 * v[0] * v[0] - 0.5 * self.k * q[0] * q[0]
        }
    }

    #[differentiable(crate = mechanics)]
    fn rotation(q: [f64; 2], rate: f64) -> [f64; 2] {
        [-rate * q[1], rate * q[0]]
    }

    #[test]
    fn systems_of_a_renamed_dependency_step() {
        let pendulum = Pendulum { m: 2.0, r: 0.1 };
        let view = pendulum.driven([0.0], 0.0);
        let start = State::from_velocity(&view, [0.3], [0.0]).expect("a regular start");
        let by_midpoint = view.by(Midpoint, 0.01).step(&start).expect("a short step");
        let by_gauss = view.by(Gauss::<2>, 0.01).step(&start).expect("a short step");
        assert!((by_midpoint.state.q[0] - by_gauss.state.q[0]).abs() < 1e-7);
        let [oscillator, by_duals] = [
            Oscillator { k: 1.0 }.by(Midpoint, 0.1).run(start).nth(9),
            ByDuals { k: 1.0 }.by(Midpoint, 0.1).run(start).nth(9),
        ]
        .map(|step| step.expect("a run goes on").expect("a short step").state.q[0]);
        // The one is damped.
        assert!((oscillator - by_duals).abs() > 1e-4 && (oscillator - by_duals).abs() < 0.05);
    }

    #[test]
    fn fields_of_a_renamed_dependency_have_derivatives() {
        use mechanics::VectorField;
        let jacobian = Rotation { rate: 0.7 }.jacobian(&[0.2, 0.5].into());
        assert_eq!(jacobian, mechanics::nalgebra::Matrix2::new(0.0, -0.7, 0.7, 0.0));
    }

    /// nalgebra's own macros name a crate that this one does not depend on.
    #[test]
    fn vectors_and_matrices_are_written_without_nalgebra() {
        const M: Matrix2<f64> = matrix![1.0, 2.0; 3.0, 4.0];
        let start = State { q: vector![0.3], p: vector![-0.1] };
        let step = Oscillator { k: 1.0 }.by(Midpoint, 0.1).near(&vector![-0.1]).step(&start).unwrap();
        assert!(step.state.q[0] < 0.3 && M[(0, 1)] == 2.0 && (M * vector![1.0, 0.0])[1] == 3.0);
    }
}
