//! Bodies on constraints: a bob on a sphere, and two rods of which each has coordinates of its own, one
//! constraint of theirs twice.

use core::hint::black_box;

use dalembert::{Composition, Discretise, Midpoint, State, Trapezoidal, rayleigh_system};

macro_rules! bobs {
    ($($name:ident $float:ident)*) => {
        $(
            /// A bob on a sphere.
            struct $name {
                friction: $float,
            }

            #[rayleigh_system(rule = [midpoint, trapezoidal])]
            impl $name {
                fn lagrangian(&self, q: [$float; 3], v: [$float; 3]) -> $float {
                    0.5 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) - 9.81 * q[2]
                }

                fn rayleigh(&self, v: [$float; 3]) -> $float {
                    0.5 * self.friction * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
                }

                fn constraints(&self, q: [$float; 3]) -> [$float; 1] {
                    [q[0] * q[0] + q[1] * q[1] + q[2] * q[2] - 1.0]
                }
            }

            impl $name {
                /// How many ways of stepping fail.
                fn failures() -> i32 {
                    let system = black_box(Self { friction: 0.1 });
                    let h = black_box(0.01);
                    let Ok(start) = State::nearest(&system, black_box([0.6, 0.0, -0.8]), black_box([0.1, 0.3, 0.0]))
                    else {
                        return 1;
                    };
                    let by = system.by(Midpoint, h);
                    let Ok(step) = by.step(&start) else { return 1 };
                    let others = [
                        by.linearized_step(&start).is_err(),
                        by.reactions(&start, &step).is_err(),
                        by.step_within(&start, 3).is_err(),
                        system.by(Trapezoidal, h).step(&start).is_err(),
                        State::from_velocity(&system, start.q, start.p).is_err(),
                    ];
                    let mut run = by.run(start);
                    let steps = run.by_ref().take(3).filter(Result::is_err).count();
                    let mut composed = system.by(Composition::kahan_li_6(Midpoint), h).run(start);
                    let steps = steps + composed.by_ref().take(3).filter(Result::is_err).count();
                    black_box((run.state(), composed.state()));
                    others.iter().filter(|failed| **failed).count() as i32 + steps as i32
                }
            }
        )*

        /// How many steps fail, of these systems.
        fn step_bobs() -> i32 {
            0 $(+ $name::failures())*
        }
    };
}

bobs! { DoubleBob f64 SingleBob f32 }

/// Two rods in a plane, each by its middle and its angle, coupled by springs to their supports.
struct Rods {
    stiffness: f64,
}

#[rayleigh_system]
impl Rods {
    fn lagrangian(&self, q: [f64; 6], v: [f64; 6]) -> f64 {
        let mut sum = -0.5 * self.stiffness * (q[2] * q[2] + (q[5] - q[2]).powi(2));
        for i in 0..2 {
            sum += 0.5 * (v[3 * i] * v[3 * i] + v[3 * i + 1] * v[3 * i + 1])
                + v[3 * i + 2] * v[3 * i + 2] / 24.0;
        }
        sum
    }

    fn constraints(&self, q: [f64; 6]) -> [f64; 5] {
        let (a, b) = (q[2], q[5]);
        [
            q[0] - 0.5 * a.sin(),
            q[1] + 0.5 * a.cos(),
            q[3] - q[0] - 0.5 * a.sin() - 0.5 * b.sin(),
            q[4] - q[1] + 0.5 * a.cos() + 0.5 * b.cos(),
            q[3] - a.sin() - 0.5 * b.sin(),
        ]
    }
}

/// How many steps of the rods fail.
fn step_rods() -> i32 {
    let system = black_box(Rods { stiffness: 0.3 });
    let Ok(start) = State::nearest(&system, black_box([0.5, 0.0, 1.5, 1.5, 0.0, 1.6]), [0.0; 6]) else {
        return 1;
    };
    let mut run = system.by(Midpoint, black_box(0.01)).run(start);
    let failed = run.by_ref().take(3).filter(Result::is_err).count();
    black_box(run.state());
    failed as i32
}

/// How many ways of stepping fail, of all systems.
pub fn step_all() -> i32 {
    step_bobs() + step_rods()
}
