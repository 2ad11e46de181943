//! Tables of each kind in L, R and f, in fields and in slices; points as an array; single precision; tables
//! made of points that are known when the program runs, as C gives them.

use core::hint::black_box;

use dalembert::system::{Curve, Interpolation, Table, TableSlice};
use dalembert::{Discretise, Gauss, Midpoint, State, rayleigh_system};

const X: [f64; 5] = [-1.0, -0.3, 0.2, 0.9, 2.0];
const Y: [f64; 5] = [0.4, 0.1, 0.3, 0.2, 0.4];

/// The tables are made while the program is compiled.
const fn made(table: Result<Table<5>, dalembert::system::TableError>) -> Table<5> {
    match table {
        Ok(table) => table,
        Err(_) => panic!("not increasing"),
    }
}

const SPLINE: Table<5> = made(Table::spline(X, Y));
const MONOTONE: Table<5> = made(Table::monotone(X, Y)).straight_beyond();
const PERIODIC: Table<5> = made(Table::periodic(X, Y));
const SINGLE: Table<5, f32> = match SPLINE.single() {
    Ok(table) => table,
    Err(_) => panic!("too close"),
};

struct Cart {
    spring: TableSlice<'static>,
    drag: Table<5>,
    wind: Table<5>,
    push: [[f64; 2]; 3],
}

#[rayleigh_system(rule = [midpoint, gauss])]
impl Cart {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - self.spring.at(q[0]) - self.wind.at(q[1] - q[0])
    }

    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * self.drag.at(q[0]) * v[0] * v[0]
    }

    fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        [0.0, self.push.at(v[1]) - q[1]]
    }
}

struct SingleCart {
    spring: Table<5, f32>,
}

#[rayleigh_system]
impl SingleCart {
    fn lagrangian(&self, q: [f32; 1], v: [f32; 1]) -> f32 {
        0.5 * v[0] * v[0] - self.spring.at(q[0])
    }
}

/// How many of these points are no table, in either precision and in slices.
fn not_made() -> usize {
    let (x, y) = (black_box(X), black_box(Y));
    let table = Table::through(black_box(Interpolation::Spline), x, y);
    let mut room = black_box([[0.0; 4]; 5]);
    let pieces = room.get_mut(..black_box(5)).unwrap_or_default();
    let slice = TableSlice::through(black_box(Interpolation::Periodic), &x, &y, pieces);
    [table.is_err(), table.and_then(|table| table.single()).is_err(), slice.is_err()]
        .iter()
        .filter(|is_wrong| **is_wrong)
        .count()
}

/// How many steps fail, and points that are no table.
pub fn step_all() -> i32 {
    static SPRING: Table<5> = SPLINE;
    let push = black_box([[-1.0, 0.3], [0.0, 0.0], [1.0, -0.2]]);
    let system = black_box(Cart { spring: SPRING.as_slice(), drag: MONOTONE, wind: PERIODIC, push });
    let state = black_box(State { q: [0.1, -0.4].into(), p: [0.3, 0.2].into() });
    let single = black_box(SingleCart { spring: SINGLE });
    let single_state = black_box(State { q: [0.1].into(), p: [0.3].into() });
    let failed = [
        system.by(Midpoint, black_box(0.01)).step(&state).is_err(),
        system.by(Midpoint, 0.01).linearized_step(&state).is_err(),
        system.by(Gauss::<2>, black_box(0.01)).step(&state).is_err(),
        single.by(Midpoint, black_box(0.01)).step(&single_state).is_err(),
        black_box(SPLINE).at(black_box(f64::NAN)) == 0.0,
    ];
    (failed.iter().filter(|failed| **failed).count() + not_made()) as i32
}
