use dalembert::rayleigh_system;
use dalembert::system::Table;

struct Parameter {
    drag: Table<4>,
}

#[rayleigh_system(parameters = [drag])]
impl Parameter {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - self.drag.at(q[0])
    }
}

enum Law {
    Free,
    Tabled(Table<4>),
}

struct Bound {
    law: Law,
}

#[rayleigh_system(derivatives = expanded)]
impl Bound {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        let potential = match &self.law {
            Law::Free => 0.0,
            Law::Tabled(table) => table.at(q[0]),
        };
        0.5 * v[0] * v[0] - potential
    }
}

fn main() {}
