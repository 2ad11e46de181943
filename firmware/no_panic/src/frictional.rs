//! Bodies held by dry friction: a block on a belt, and a puck on a table beside a block that rubs against it.

use core::hint::black_box;

use dalembert::{Discretise, Proximal, State, rayleigh_system};

macro_rules! pucks {
    ($($name:ident $float:ident)*) => {
        $(
            /// A puck on a table, and a block that rubs against it and against a belt.
            struct $name {
                mu: $float,
                belt: $float,
            }

            #[rayleigh_system(rule = proximal)]
            impl $name {
                fn lagrangian(&self, q: [$float; 3], v: [$float; 3]) -> $float {
                    0.5 * (v[0] * v[0] + v[1] * v[1] + 2.0 * v[2] * v[2])
                        - 0.5 * (q[0] * q[0] + q[1] * q[1] + (q[2] - q[0]) * (q[2] - q[0]))
                }

                fn rayleigh(&self, q: [$float; 3], v: [$float; 3]) -> $float {
                    let over = self.mu * (1.0 + q[0] * q[0]) * v[0].hypot(v[1]);
                    over + self.mu * (v[2] - v[0]).abs() + self.mu * (v[2] - self.belt).abs() + 0.05 * v[1] * v[1]
                }

                fn force(&self, q: [$float; 3], v: [$float; 3], u: [$float; 1]) -> [$float; 3] {
                    [u[0], -0.1 * v[1] * q[1], 0.0]
                }
            }

            impl $name {
                /// How many ways of stepping fail.
                fn failures() -> i32 {
                    let system = black_box(Self { mu: 0.2, belt: 0.1 });
                    let driven = system.driven(black_box([0.01]));
                    let h = black_box(0.01);
                    let Ok(start) = State::from_velocity(&system, black_box([0.1, 0.0, 0.3]), black_box([0.1; 3])) else {
                        return 1;
                    };
                    let by = driven.by(Proximal, h);
                    let single = [by.step(&start).is_err(), by.step_within(&start, 3).is_err()];
                    let derivative = by.linearized_step(&start);
                    let mut run = by.run(start);
                    let steps = run.by_ref().take(3).filter(Result::is_err).count();
                    black_box((run.state(), &derivative));
                    single.iter().filter(|failed| **failed).count() as i32 + steps as i32
                }
            }
        )*

        /// How many steps fail, of these systems.
        pub fn step_all() -> i32 {
            0 $(+ $name::failures())*
        }
    };
}

pucks! { DoublePuck f64 SinglePuck f32 }
