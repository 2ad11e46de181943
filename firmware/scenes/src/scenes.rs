//! What the machines step: the double pendulum that all packages share, a cart-pole with friction, left alone
//! and pushed, a bob on a constraint, and a block that dry friction holds.

use dalembert::{Discrete, Midpoint, State, StepError, rayleigh_system};

/// A system as every machine steps it.
pub trait Stepped: Discrete<Midpoint, 2> + Sized {
    /// Step size in s.
    const STEP: Self::Scalar;
    /// With the parameters that it has on every machine, in SI units.
    const SCENE: Self;

    /// Where it starts.
    ///
    /// # Errors
    /// None, with the masses of the scene.
    fn start(&self) -> Result<State<Self::Scalar, 2>, StepError>;
}

/// A cart-pole, whose cart a force may push: declared so that C can fill it in.
macro_rules! cart_pole {
    ($name:ident $float:ident $($force:item)?) => {
        dalembert_c::parameters! {
            /// A pole hinged on a cart: q is the cart's position and the pole's angle from the upright; friction in both.
            pub struct $name {
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
        }

        #[rayleigh_system(derivatives = expanded)]
        impl $name {
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

            $($force)?
        }
    };
}

/// Systems of whose steps more than p0(v̄) = p0 is to be solved.
macro_rules! bordered {
    ($float:ident) => {
        /// A bob on a rod, in Cartesian coordinates.
        pub struct Bob {
            /// Mass in kg, length in m, acceleration of gravity in m/s², friction in N s/m.
            pub of: [$float; 4],
        }

        #[rayleigh_system(derivatives = expanded)]
        impl Bob {
            fn lagrangian(&self, q: [$float; 2], v: [$float; 2]) -> $float {
                let [m, _, g, _] = self.of;
                0.5 * m * (v[0] * v[0] + v[1] * v[1]) - m * g * q[1]
            }

            fn rayleigh(&self, v: [$float; 2]) -> $float {
                0.5 * self.of[3] * (v[0] * v[0] + v[1] * v[1])
            }

            fn constraints(&self, q: [$float; 2]) -> [$float; 1] {
                [q[0] * q[0] + q[1] * q[1] - self.of[1] * self.of[1]]
            }
        }

        impl Bob {
            /// Step size in s.
            pub const STEP: $float = 0.01;
            /// With the parameters that it has on every machine.
            pub const SCENE: Self = Self { of: [1.0, 0.5, 9.81, 0.1] };

            /// Where it starts: drawn to the side, and let go.
            ///
            /// # Errors
            /// None, on its rod.
            pub fn start(&self) -> Result<State<$float, 2>, StepError> {
                State::from_velocity(self, [0.3, -0.4], [0.0, 0.0])
            }
        }

        /// A block on a spring, which dry friction stops within the 200 steps, and holds.
        pub struct Block {
            /// Mass in kg, stiffness in N/m, dry friction in N, viscous friction in N s/m.
            pub of: [$float; 4],
        }

        #[rayleigh_system(rule = proximal, derivatives = expanded)]
        impl Block {
            fn lagrangian(&self, q: [$float; 1], v: [$float; 1]) -> $float {
                0.5 * self.of[0] * v[0] * v[0] - 0.5 * self.of[1] * q[0] * q[0]
            }

            fn rayleigh(&self, v: [$float; 1]) -> $float {
                self.of[2] * v[0].abs() + 0.5 * self.of[3] * v[0] * v[0]
            }
        }

        impl Block {
            /// Step size in s.
            pub const STEP: $float = 0.05;
            /// With the parameters that it has on every machine.
            pub const SCENE: Self = Self { of: [1.0, 1.0, 0.2, 0.05] };

            /// Where it starts: drawn aside, and let go.
            ///
            /// # Errors
            /// None, with a mass.
            pub fn start(&self) -> Result<State<$float, 1>, StepError> {
                State::from_velocity(self, [1.0], [0.0])
            }
        }
    };
}

macro_rules! scenes {
    ($(#[$doc:meta])* $module:ident $float:ident $double_pendulum:path) => {
        $(#[$doc])*
        pub mod $module {
            use super::{State, StepError, Stepped, rayleigh_system};

            pub use $double_pendulum;

            bordered! { $float }
            cart_pole! { CartPole $float }
            cart_pole! {
                PushedCartPole $float
                fn force(&self, _q: [$float; 2], _v: [$float; 2], u: [$float; 1]) -> [$float; 2] {
                    [u[0], 0.0]
                }
            }

            /// Swung out, the second arm turning.
            impl Stepped for DoublePendulum {
                const STEP: $float = 0.01;
                const SCENE: Self = Self { m: [1.0, 0.5], l: [1.0, 0.75], g: 9.81, c: [0.05, 0.02] };

                fn start(&self) -> Result<State<$float, 2>, StepError> {
                    State::from_velocity(self, [1.2, 2.0], [0.0, -1.5])
                }
            }

            /// Near the upright, falling.
            impl Stepped for CartPole {
                const STEP: $float = 0.01;
                const SCENE: Self = Self { cart: 1.0, pole: 0.2, half_length: 0.4, g: 9.81, c: [0.3, 0.01] };

                fn start(&self) -> Result<State<$float, 2>, StepError> {
                    State::from_velocity(self, [0.0, 0.1], [0.2, 0.0])
                }
            }

            /// The same while it is pushed and pulled: what a controller in C steps, and one in Rust.
            impl PushedCartPole {
                /// Step size in s.
                pub const STEP: $float = CartPole::STEP;
                /// With the parameters of the cart-pole.
                pub const SCENE: Self = Self { cart: 1.0, pole: 0.2, half_length: 0.4, g: 9.81, c: [0.3, 0.01] };

                /// Where it starts.
                ///
                /// # Errors
                /// None, with the masses of the scene.
                pub fn start(&self) -> Result<State<$float, 2>, StepError> {
                    State::from_velocity(&self.driven([0.0]), [0.0, 0.1], [0.2, 0.0])
                }

                /// The force on the cart in step `index`, in N.
                #[must_use]
                pub fn input(index: u32) -> [$float; 1] {
                    [0.25 * (index % 5) as $float - 0.5]
                }
            }
        }
    };
}

scenes! {
    /// In `f64`.
    double f64 dalembert_scenes::DoublePendulum
}
scenes! {
    /// In `f32`.
    single f32 dalembert_scenes::single::DoublePendulum
}
