use dalembert::Lagrangian;

struct System;

fn integrate<L: Lagrangian<1>>(_: &L) {}

fn main() {
    integrate(&System);
}
