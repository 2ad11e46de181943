//! A driven chain by Gauss rules, in time: steps, trajectories, and all derivatives of a step, of two or
//! three stages.

use core::hint::black_box;

use dalembert::{Discretise, Gauss, State, rayleigh_system};

macro_rules! chains {
    ($($name:ident $driven:ident $n:literal $float:ident $stages:literal)*) => {
        $(
            /// A chain of pendulums on a common support, pushed at its ends.
            struct $name {
                stiffness: $float,
                friction: $float,
            }

            #[rayleigh_system(
                rule = gauss,
                derivatives = expanded,
                parameters = [stiffness, friction],
                step_derivatives = second
            )]
            impl $name {
                fn lagrangian(&self, q: [$float; $n], v: [$float; $n], t: $float) -> $float {
                    let total: $float = v.iter().zip(q).map(|(v, q)| v * q.cos()).sum();
                    let mut energy = 0.5 * total * total;
                    for i in 0..$n {
                        energy += 0.5 * v[i] * v[i] + self.stiffness * (1.0 + 0.1 * t) * q[i].sin();
                    }
                    energy
                }

                fn rayleigh(&self, v: [$float; $n]) -> $float {
                    v.iter().map(|v| 0.5 * self.friction * v * v).sum()
                }

                fn force(&self, q: [$float; $n], v: [$float; $n], u: [$float; 1], t: $float) -> [$float; $n] {
                    let mut force = q;
                    for i in 0..$n {
                        force[i] = -0.01 * q[i];
                    }
                    force[0] = u[0] * t - (0.1 * v[0]).tanh();
                    force[$n - 1] += u[0] * u[0];
                    force
                }
            }

            impl $name {
                /// How many ways fail, with S stages.
                fn failures<const S: usize>() -> i32 {
                    let system = black_box(Self { stiffness: 0.3, friction: 0.1 });
                    let view: $driven<'_> = system.driven([black_box(0.2)], black_box(0.4));
                    let by = view.by(Gauss::<S>, black_box(0.01));
                    let Ok(start) = State::from_velocity(&view, black_box([0.1; $n]), black_box([0.2; $n])) else {
                        return 1;
                    };
                    let Ok(step) = by.step(&start) else { return 1 };
                    let ends = (&start.q, &step.state.q);
                    let mut trajectory = by.run(start);
                    let steps = trajectory.by_ref().take(3).filter(Result::is_err).count();
                    let mut given = by.run_with_inputs(start);
                    let advanced = given.advance(&system.driven([black_box(0.3)], 0.4)).is_ok();
                    given.correct(start);
                    let taken = given.advance_linearized(&view).is_ok_and(|taken| {
                        black_box(taken.by_state()).is_ok()
                            && black_box(taken.by_input::<1>()).is_ok()
                            && black_box(taken.by_parameters::<2>()).is_ok()
                    });
                    let of_step = by.linearized(&start).is_ok_and(|step| {
                        black_box(step.by_state()).is_ok()
                            && black_box(step.by_input::<1>()).is_ok()
                            && black_box(step.hessian::<1>(&start)).is_ok()
                    });
                    let segment = by.segment(ends.0, ends.1).and_then(|segment| segment.linearized());
                    let of_ends = segment.is_ok_and(|step| {
                        black_box(step.by_state()).is_ok()
                            && black_box(step.by_parameters::<2>()).is_ok()
                    });
                    black_box(trajectory.state());
                    i32::from(!advanced || !taken)
                        + i32::from(!of_step)
                        + i32::from(!of_ends)
                        + steps as i32
                }
            }
        )*

        /// How many ways fail, of all chains.
        pub fn step_all() -> i32 {
            0 $(+ $name::failures::<$stages>())*
        }
    };
}

chains! {
    Double1 DrivenDouble1 1 f64 3
    Double3 DrivenDouble3 3 f64 2
    Single2 DrivenSingle2 2 f32 3
}
