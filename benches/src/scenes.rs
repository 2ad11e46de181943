//! The systems measured, each as its user would write it, by either engine.

#[macro_use]
mod arm;
#[macro_use]
mod double_pendulum;
#[macro_use]
mod fput_chain;
#[macro_use]
mod pendulum_chain;
#[macro_use]
mod ring;
#[macro_use]
mod spring_chain;

/// Every scene, with the engine named.
macro_rules! scenes {
    ($engine:ident) => {
        use dalembert::rayleigh_system;

        ring!($engine);
        double_pendulum!($engine);
        fput_chain!($engine, 8);
        arm!($engine);
        pendulum_chain!($engine, 16);
        spring_chain!($engine, 16);
    };
}

/// Derivatives written out at compile time.
pub mod expanded {
    scenes!(expanded);
}

/// Derivatives by dual numbers when the program runs.
pub mod num_dual {
    scenes!(num_dual);
}

/// The chains of 8 masses.
pub mod of_8 {
    use dalembert::rayleigh_system;
    fput_chain!(expanded, 8);
    spring_chain!(expanded, 8);
}

/// The chains of 32 masses.
pub mod of_32 {
    use dalembert::rayleigh_system;
    fput_chain!(expanded, 32);
    spring_chain!(expanded, 32);
}
