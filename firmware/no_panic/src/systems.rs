//! Chains of n coordinates: with full mass matrices that depend on q; with coupling of neighbours alone,
//! whose Newton matrices are banded; and with linear damping, for the rules fitted to it.

use core::hint::black_box;

use dalembert::{
    Composition, Discretise, Fitted, FittedTrapezoidal, Midpoint, OneSided, Splitting, State, Trapezoidal,
    rayleigh_system,
};

macro_rules! chains {
    ($($name:ident $n:literal $float:ident)*) => {
        $(
            /// A chain of pendulums on a common support.
            struct $name {
                stiffness: $float,
                friction: $float,
            }

            #[rayleigh_system(derivatives = expanded, rule = [midpoint, trapezoidal])]
            impl $name {
                fn lagrangian(&self, q: [$float; $n], v: [$float; $n]) -> $float {
                    let total: $float = v.iter().zip(q).map(|(v, q)| v * q.cos()).sum();
                    let mut energy = 0.5 * total * total;
                    for i in 0..$n {
                        energy += 0.5 * v[i] * v[i] + self.stiffness * q[i].sin();
                    }
                    for i in 1..$n {
                        energy -= self.stiffness * (1.0 + (q[i] - q[i - 1]).powi(2)).sqrt();
                    }
                    energy
                }

                fn rayleigh(&self, v: [$float; $n]) -> $float {
                    v.iter().map(|v| 0.5 * self.friction * v * v).sum()
                }

                fn force(&self, q: [$float; $n], v: [$float; $n]) -> [$float; $n] {
                    let mut force = q;
                    force[0] = -(0.1 * v[0]).tanh();
                    for i in 1..$n {
                        force[i] = -0.01 * q[i];
                    }
                    force
                }
            }

            impl $name {
                /// How many ways of stepping fail.
                fn failures() -> i32 {
                    let system = black_box(Self { stiffness: 0.3, friction: 0.1 });
                    let h = black_box(0.01);
                    let Ok(start) = State::from_velocity(&system, black_box([0.1; $n]), black_box([0.2; $n])) else {
                        return 1;
                    };
                    let midpoint = system.by(Midpoint, h).step(&start);
                    let trapezoidal = system.by(Trapezoidal, h).step(&start);
                    let by_configurations = midpoint.and_then(|step| {
                        system.by(Midpoint, h).near(&step.velocity).step_configurations(&start.q, &step.state.q)
                    });
                    let bounded = system.by(Midpoint, h).step_within(&start, 3);
                    let mut trajectory = system.by(Midpoint, h).run(start);
                    let steps = trajectory.by_ref().take(3).filter(Result::is_err).count();
                    black_box(&bounded);
                    black_box((&midpoint, &trapezoidal, &by_configurations, trajectory.state()));
                    i32::from(midpoint.is_err())
                        + i32::from(trapezoidal.is_err())
                        + i32::from(by_configurations.is_err())
                        + i32::from(bounded.is_err())
                        + steps as i32
                }
            }
        )*

        /// How many ways of stepping fail, of these systems.
        fn step_full() -> i32 {
            0 $(+ $name::failures())*
        }
    };
}

chains! {
    Double1 1 f64 Double2 2 f64 Double3 3 f64 Double4 4 f64 Double5 5 f64 Double6 6 f64 Double7 7 f64 Double8 8 f64
    Single1 1 f32 Single2 2 f32 Single3 3 f32 Single4 4 f32 Single5 5 f32 Single6 6 f32 Single7 7 f32 Single8 8 f32
}

macro_rules! bands {
    ($($name:ident $n:literal $float:ident)*) => {
        $(
            /// Springs between neighbours, with a cubic part.
            struct $name {
                stiffness: $float,
            }

            #[rayleigh_system(derivatives = expanded)]
            impl $name {
                fn lagrangian(&self, q: [$float; $n], v: [$float; $n]) -> $float {
                    let mut energy = -0.5 * q[0] * q[0];
                    for i in 0..$n {
                        energy += 0.5 * v[i] * v[i];
                    }
                    for i in 1..$n {
                        let stretch = q[i] - q[i - 1];
                        energy -= self.stiffness * (0.5 * stretch * stretch + 0.25 * stretch.powi(4));
                    }
                    energy
                }

                fn rayleigh(&self, v: [$float; $n]) -> $float {
                    v.windows(2).map(|pair| 0.05 * (pair[1] - pair[0]).powi(2)).sum()
                }
            }

            impl $name {
                /// How many steps fail.
                fn failures() -> i32 {
                    let system = black_box(Self { stiffness: 0.3 });
                    let Ok(start) = State::from_velocity(&system, black_box([0.1; $n]), black_box([0.2; $n])) else {
                        return 1;
                    };
                    let mut trajectory = system.by(Midpoint, black_box(0.01)).run(start);
                    let failed = trajectory.by_ref().take(3).filter(Result::is_err).count();
                    black_box(trajectory.state());
                    failed as i32
                }
            }
        )*

        /// How many steps fail, of these systems.
        fn step_bands() -> i32 {
            0 $(+ $name::failures())*
        }
    };
}

bands! {
    DoubleBand4 4 f64 DoubleBand5 5 f64 DoubleBand6 6 f64 DoubleBand7 7 f64 DoubleBand8 8 f64
    SingleBand4 4 f32 SingleBand5 5 f32 SingleBand6 6 f32 SingleBand7 7 f32 SingleBand8 8 f32
}

macro_rules! damped {
    ($($name:ident $n:literal $float:ident)*) => {
        $(
            /// Masses that are coupled, on hardening springs, with damping that is no multiple of the mass.
            struct $name {
                mass: $float,
                friction: $float,
            }

            #[rayleigh_system(derivatives = expanded, rule = [trapezoidal, fitted, fitted_trapezoidal, one_sided])]
            impl $name {
                fn lagrangian(&self, q: [$float; $n], v: [$float; $n]) -> $float {
                    let total: $float = v.iter().sum();
                    let mut energy = 0.05 * self.mass * total * total;
                    for i in 0..$n {
                        energy += 0.5 * self.mass * v[i] * v[i] - 0.5 * q[i] * q[i] - 0.25 * q[i].powi(4);
                    }
                    energy
                }

                fn rayleigh(&self, v: [$float; $n]) -> $float {
                    let ends = v[0] - v[$n - 1];
                    0.5 * self.friction * (v[0] * v[0] + ends * ends)
                }
            }

            impl $name {
                /// How many ways of stepping fail.
                fn failures() -> i32 {
                    let system = black_box(Self { mass: 1.3, friction: 0.7 });
                    let h = black_box(0.01);
                    let Ok(start) = State::from_velocity(&system, black_box([0.1; $n]), black_box([0.2; $n])) else {
                        return 1;
                    };
                    let single = [
                        system.by(Fitted, h).near(&start.p).step(&start),
                        system.by(FittedTrapezoidal, h).step(&start),
                        system.by(OneSided, h).step(&start),
                    ];
                    let bounded = system.by(Fitted, h).step_within(&start, 3);
                    let mut fitted = system.by(Fitted, h).run(start);
                    let mut explicit = system.by(FittedTrapezoidal, h).run(start);
                    let steps = fitted.by_ref().take(3).chain(explicit.by_ref().take(3)).filter(Result::is_err).count();
                    black_box((&single, &bounded, fitted.state(), explicit.state()));
                    let mut verlet = system.by(Trapezoidal, h).run(start);
                    let steps = steps + verlet.by_ref().take(3).filter(Result::is_err).count();
                    let mut split = system.by(Splitting::blanes_moan_6(), h).run(start);
                    let steps = steps + split.by_ref().take(3).filter(Result::is_err).count();
                    let mut composed = system.by(Composition::kahan_li_6(Trapezoidal), h).run(start);
                    let steps = steps + composed.by_ref().take(3).filter(Result::is_err).count();
                    black_box((verlet.state(), split.state(), composed.state()));
                    single.iter().filter(|step| step.is_err()).count() as i32
                        + i32::from(bounded.is_err())
                        + steps as i32
                }
            }
        )*

        /// How many ways of stepping fail, of these systems.
        fn step_damped() -> i32 {
            0 $(+ $name::failures())*
        }
    };
}

damped! {
    DoubleDamped1 1 f64 DoubleDamped2 2 f64 DoubleDamped3 3 f64 DoubleDamped4 4 f64
    DoubleDamped5 5 f64 DoubleDamped6 6 f64 DoubleDamped7 7 f64 DoubleDamped8 8 f64
    SingleDamped1 1 f32 SingleDamped2 2 f32 SingleDamped3 3 f32 SingleDamped4 4 f32
    SingleDamped5 5 f32 SingleDamped6 6 f32 SingleDamped7 7 f32 SingleDamped8 8 f32
}

/// How many ways of stepping fail, of all systems.
pub fn step_all() -> i32 {
    step_full() + step_bands() + step_damped()
}
