use dalembert::nalgebra::vector;
use dalembert::{Lagrangian, Trajectory};

struct System;

fn main() {
    let _ = Lagrangian::<1>::lagrangian(&System, &vector![0.0], &vector![1.0]);
}
