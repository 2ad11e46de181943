//! A damped double pendulum and a cart-pole with friction, in `f64` and in `f32`.

macro_rules! scenes {
    ($(#[$doc:meta])* $module:ident $float:ident) => {
        $(#[$doc])*
        pub mod $module {
            use dalembert::{State, StepError, rayleigh_system};

            /// Two pendulums of point masses, one hung from the other; angles from the vertical, friction in both joints.
            pub struct DoublePendulum {
                /// Masses in kg.
                pub m: [$float; 2],
                /// Lengths in m.
                pub l: [$float; 2],
                /// Acceleration of gravity in m/s².
                pub g: $float,
                /// Friction in the joints in N m s.
                pub c: [$float; 2],
            }

            #[rayleigh_system(derivatives = expanded)]
            impl DoublePendulum {
                fn lagrangian(&self, q: [$float; 2], v: [$float; 2]) -> $float {
                    let [m1, m2] = self.m;
                    let [l1, l2] = self.l;
                    let kinetic = 0.5 * (m1 + m2) * (l1 * v[0]).powi(2)
                        + 0.5 * m2 * (l2 * v[1]).powi(2)
                        + m2 * l1 * l2 * v[0] * v[1] * (q[0] - q[1]).cos();
                    kinetic + self.g * ((m1 + m2) * l1 * q[0].cos() + m2 * l2 * q[1].cos())
                }

                fn rayleigh(&self, v: [$float; 2]) -> $float {
                    0.5 * self.c[0] * v[0].powi(2) + 0.5 * self.c[1] * (v[1] - v[0]).powi(2)
                }
            }

            /// A pole hinged on a cart: q is the cart's position and the pole's angle from the upright; friction in both.
            pub struct CartPole {
                /// Mass of the cart in kg.
                pub cart: $float,
                /// Mass of the pole in kg.
                pub pole: $float,
                /// From the hinge to the pole's centre of mass, in m.
                pub half_length: $float,
                /// Acceleration of gravity in m/s².
                pub g: $float,
                /// Friction of the cart in N s/m, and of the hinge in N m s.
                pub c: [$float; 2],
            }

            #[rayleigh_system(derivatives = expanded)]
            impl CartPole {
                fn lagrangian(&self, q: [$float; 2], v: [$float; 2]) -> $float {
                    let (sine, cosine) = q[1].sin_cos();
                    // The centre of mass, and a slender rod's inertia about it.
                    let [x, y] = [v[0] + self.half_length * cosine * v[1], -self.half_length * sine * v[1]];
                    let spin = self.half_length * v[1];
                    0.5 * self.cart * v[0].powi(2) + 0.5 * self.pole * (x * x + y * y) + self.pole * spin * spin / 6.0
                        - self.pole * self.g * self.half_length * cosine
                }

                fn rayleigh(&self, v: [$float; 2]) -> $float {
                    0.5 * (self.c[0] * v[0].powi(2) + self.c[1] * v[1].powi(2))
                }
            }

            impl DoublePendulum {
                /// Step size in s.
                pub const STEP: $float = 0.01;
                /// The pendulum that all machines step.
                pub const SCENE: Self = Self { m: [1.0, 0.5], l: [1.0, 0.75], g: 9.81, c: [0.05, 0.02] };

                /// Swung out, the second arm turning.
                ///
                /// # Errors
                /// None, with the masses of the scene.
                pub fn start(&self) -> Result<State<$float, 2>, StepError> {
                    State::from_velocity(self, [1.2, 2.0], [0.0, -1.5])
                }
            }

            impl CartPole {
                /// Step size in s.
                pub const STEP: $float = 0.01;
                /// The cart that all machines step.
                pub const SCENE: Self = Self { cart: 1.0, pole: 0.2, half_length: 0.4, g: 9.81, c: [0.3, 0.01] };

                /// Near the upright, falling.
                ///
                /// # Errors
                /// None, with the masses of the scene.
                pub fn start(&self) -> Result<State<$float, 2>, StepError> {
                    State::from_velocity(self, [0.0, 0.1], [0.2, 0.0])
                }
            }
        }
    };
}

scenes! {
    /// In `f64`.
    double f64
}
scenes! {
    /// In `f32`.
    single f32
}
