//! No name is taken from a user: systems may be named like anything that generated code is made of, bodies
//! may hold types and constants with such names, and the prelude's names may mean something else where the
//! system stands.

/// A driven pendulum named `$name`, stepped once.
macro_rules! pendulums {
    ($($case:ident by $rule:ident, $engine:ident, $by:ty: $($name:ident)*;)*) => {
        $(mod $case {
            $(#[allow(non_snake_case, reason = "named after the system")]
            mod $name {
                /// What the prelude calls so is something else here.
                #[allow(dead_code)]
                type Result<T> = core::result::Result<T, StepError>;
                #[allow(dead_code)]
                type Option<T, U> = (T, U);
                #[allow(non_snake_case, dead_code)]
                fn Ok<T>(_: T) {}
                #[allow(dead_code)]
                struct Some;

                use dalembert::{Discretise as _, State, StepError};

                pub struct $name { c: f64, g: f64 }

                #[dalembert::rayleigh_system(derivatives = $engine, rule = $rule)]
                impl $name {
                    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                        0.5 * v[0] * v[0] + self.g * q[0].cos()
                    }
                    fn rayleigh(&self, v: [f64; 1]) -> f64 {
                        0.5 * self.c * v[0] * v[0]
                    }
                    fn force(&self, q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
                        [u[0] * q[0]]
                    }
                }

                #[test]
                fn steps_as_under_any_name() {
                    let system = $name { c: 0.2, g: 9.81 };
                    let state: State<f64, 1> = State::from_velocity(&system, [0.4], [1.0]).unwrap();
                    let q = system.driven([0.7]).by(<$by>::default(), 0.1).step(&state).unwrap().state.q[0];
                    // By the Runge–Kutta method of order 4, h = 1e-4.
                    assert!((q - 0.4802).abs() < 1e-3, "{q}");
                }
            })*
        })*
    };
}

pendulums! {
    expanded by midpoint, expanded, dalembert::Midpoint: CovectorDerivatives D Derivatives Direction Discrete DiscreteDriven
        DiscreteForce DiscreteForceDerivatives DisplacementRule Driven Force Gradient Hessian Lagrangian Midpoint Momenta
        MomentaBy Parameters Rayleigh Real SMatrix SVector StepKernel T Trapezoidal Variations Vector;
    gauss by gauss, expanded, dalembert::Gauss<1>: ForcedLagrangian LaneVector Lanes Mask Stages;
    num_dual by midpoint, num_dual, dalembert::Midpoint: D Discrete Dual Force Gradient Real Vector;
}

/// Names of generated code for what a body reads.
#[allow(nonstandard_style, reason = "a local may be named like a generated type")]
mod in_bodies {
    use dalembert::nalgebra::vector;
    use dalembert::{Lagrangian as _, Rayleigh as _, rayleigh_system};

    #[derive(Clone, Copy)]
    pub enum Force {
        Gradient,
        Momenta { Vector: f64 },
    }
    const D: f64 = 3.0;
    mod dual {
        pub const Real: f64 = 0.25;
    }

    pub struct Mask {
        law: Force,
        SVector: Option<f64>,
    }

    macro_rules! mask {
        ($engine:ident, $module:ident) => {
            mod $module {
                #[allow(unused_imports)]
                use super::{D, Force, dual};

                pub struct Mask;
                #[super::rayleigh_system(derivatives = $engine)]
                impl Mask {
                    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                        let within = if (-1.0..4.0).contains(&q[0]) { D } else { 0.0 };
                        let Lanes = within * v[0] * v[0];
                        Lanes - dual::Real * q[0].powi(2)
                    }
                }
            }
        };
    }
    mask!(expanded, expanded);
    mask!(num_dual, num_dual);

    #[rayleigh_system(derivatives = expanded)]
    impl Mask {
        fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
            D * v[0] * v[0] - self.SVector.map_or(0.0, |Hessian| Hessian * q[0].powi(2))
        }
        fn rayleigh(&self, v: [f64; 1]) -> f64 {
            match self.law {
                Force::Gradient => 0.0,
                Force::Momenta { Vector: Dual } => 0.5 * Dual * v[0] * v[0],
            }
        }
    }

    #[test]
    fn mean_what_they_mean_to_the_user() {
        let (q, v) = (vector![2.0], vector![1.0]);
        let mask = Mask { law: Force::Momenta { Vector: 0.5 }, SVector: Some(2.0) };
        assert_eq!(
            (mask.lagrangian_gradient(&q, &v).d1[0], mask.rayleigh_gradient(&q, &v).d2[0]),
            (-8.0, 0.5)
        );
        assert_eq!(mask.lagrangian_gradient(&q, &v).d2[0], 6.0);
        let free = Mask { law: Force::Gradient, SVector: None };
        assert_eq!(
            (free.lagrangian_gradient(&q, &v).d1[0], free.rayleigh_gradient(&q, &v).d2[0]),
            (0.0, 0.0)
        );
        for gradient in
            [expanded::Mask.lagrangian_gradient(&q, &v), num_dual::Mask.lagrangian_gradient(&q, &v)]
        {
            assert_eq!((gradient.d1[0], gradient.d2[0]), (-1.0, 6.0));
        }
    }
}

/// Structs named after functions and fields.
mod of_functions {
    use dalembert::nalgebra::vector;
    use dalembert::{Lagrangian as _, VectorField as _, differentiable, rayleigh_system};

    #[rayleigh_system]
    fn gradient(q: [f64; 1], v: [f64; 1], k: f64) -> (f64, f64) {
        (0.5 * (v[0] * v[0] - k * q[0] * q[0]), 0.0 * v[0])
    }

    #[differentiable]
    fn vector_field(q: [f64; 2]) -> [f64; 2] {
        [-q[1], q[0]]
    }

    #[test]
    fn are_structs_of_the_users() {
        assert_eq!(Gradient { k: 2.0 }.lagrangian_gradient(&vector![3.0], &vector![1.0]).d1[0], -6.0);
        assert_eq!(VectorField.vector(&vector![1.0, 2.0]), vector![-2.0, 1.0]);
    }
}

/// A body's constants are named by one letter as generated code's types are, and its locals by the same
/// letter in lower case, which is what temporaries are named after that hold an entry of the constant.
#[allow(clippy::manual_range_contains, reason = "the body that was reported")]
mod letters {
    use dalembert::nalgebra::vector;
    use dalembert::{Discretise as _, Gauss, Midpoint, State, rayleigh_system};

    /// A mass on a track through five heights, straight between them.
    macro_rules! track {
        ($name:ident, $heights:ident, $local:ident, $derivatives:ident) => {
            pub struct $name;
            const _: () = {
                const $heights: [f64; 5] = [0.0, 0.3, 1.1, 0.7, 2.0];
                #[rayleigh_system(rule = [midpoint, gauss], derivatives = $derivatives)]
                impl $name {
                    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
                        let mut y = 0.0;
                        for i in 0..4 {
                            let $local = q[0] - i as f64;
                            if $local >= 0.0 && $local < 1.0 {
                                y = $heights[i] * (1.0 - $local) + $heights[i + 1] * $local;
                            }
                        }
                        0.5 * v[0] * v[0] - y
                    }
                }
            };
        };
    }
    track!(Plain, HEIGHTS, along, expanded);
    track!(AsTime, T, t, expanded);
    track!(AsDual, D, d, expanded);
    track!(AsDualByDuals, D, d, num_dual);

    #[test]
    fn are_no_locals() {
        fn check<L>(system: L)
        where
            L: dalembert::Discrete<Midpoint, 1, Scalar = f64>
                + dalembert::step::Flow<Gauss<2>, 1>
                + dalembert::Discrete<Gauss<2>, 1>,
        {
            // Midpoint, h = 0.01, from (0.2, 2): at 50 steps the mass is on the third piece, q, p as of an
            // own program.
            let state = State { q: vector![0.2], p: vector![2.0] };
            let mut run = system.by(Midpoint, 0.01).run(state);
            let end = run.nth(49).unwrap().unwrap().state;
            assert!((end.q[0] - 1.160475).abs() < 1e-6 && (end.p[0] - 1.805).abs() < 1e-12, "{end:?}");
            for q in [0.2, 1.3, 2.9, 3.5] {
                let slope = system.lagrangian_gradient(&vector![q], &vector![1.0]).d1[0];
                let expected = [-0.3, -0.8, 0.4, -1.3][q as usize];
                assert!((slope - expected).abs() < 1e-15, "{q} {slope}");
            }
            // Straight pieces: what Gauss's stages see is the same.
            let end = system.by(Gauss::<2>, 0.01).step(&state).unwrap().state;
            assert!((end.p[0] - (2.0 - 0.3 * 0.01)).abs() < 1e-14, "{end:?}");
        }
        check(Plain);
        check(AsTime);
        check(AsDual);
        check(AsDualByDuals);
    }
}
