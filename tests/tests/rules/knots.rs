//! Order across knots of a table in L: a force whose k-th derivative jumps leaves order k + 1 of higher ones;
//! a run that ends its steps at the knots keeps its own.
//!
//! Reference: the time to a place by the energy, t = ∫ dq/√(2(E − V)), by quadrature between the knots.

use dalembert::step::Flow;
use dalembert::system::Table;
use dalembert::{Discretise, Gauss, Midpoint, State, rayleigh_system};
use dalembert_tests::convergence::Convergence;

#[derive(Clone, Copy)]
struct Hill {
    height: Table<6>,
}

#[rayleigh_system(rule = [midpoint, gauss])]
impl Hill {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - self.height.at(q[0]) - 0.5 * q[0].cos()
    }
}

const X: [f64; 6] = [-1.3, -0.71, -0.13, 0.52, 1.07, 1.6];
const Y: [f64; 6] = [0.4, 0.1, 0.5, 0.2, 0.6, 0.3];
/// Two knots are between.
const ENDS: [f64; 2] = [-0.5, 0.9];
const ENERGY: f64 = 2.0;

impl Hill {
    fn speed(&self, q: f64) -> f64 {
        (2.0 * (ENERGY - self.height.at(q) - 0.5 * q.cos())).sqrt()
    }

    /// The time from one end to the other, by Simpson's rule of 2000 parts of each piece.
    fn time(&self, from: f64) -> f64 {
        let places = [from, X[2], X[3], ENDS[1]];
        let parts = 2000;
        let of_piece = |ends: &[f64]| {
            let width = (ends[1] - ends[0]) / f64::from(parts);
            let weight = |i: i32| if i == 0 || i == parts { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
            // A rounding within, so that the ends are of this piece.
            let place = |i: i32| (ends[0] + f64::from(i) * width).clamp(ends[0], ends[1].next_down());
            (0..=parts).map(|i| weight(i) / self.speed(place(i))).sum::<f64>() * width / 3.0
        };
        places.windows(2).map(of_piece).sum()
    }

    /// The order of the error at the far end, a mean over starts; ending steps at the knots or not.
    fn order<M: Copy>(self, method: M, stops: bool) -> f64
    where
        Self: Flow<M, 1, Scalar = f64>,
    {
        let mut convergence = Convergence::default();
        for steps in [1, 2, 4, 8, 16, 32, 64] {
            let errors = (0..3).map(|i| {
                let from = ENDS[0] + 0.1 * f64::from(i);
                let (start, time) =
                    (State { q: [from].into(), p: [self.speed(from)].into() }, self.time(from));
                let h = time / f64::from(steps);
                let mut run = self.by(method, h).run(start);
                let mut watch = run.watch(|at| [X[2], X[3]].map(|knot| at.q[0] - knot)).until(time);
                if stops {
                    watch = watch.terminal([true; 2]);
                }
                let mut seen = 0;
                while let Some(event) = watch.next() {
                    let state = event.expect("a passage").state;
                    seen += 1;
                    if stops {
                        watch.restart(state);
                    }
                }
                assert_eq!(seen, 2);
                let end = run.state();
                (end.q[0] - ENDS[1]).abs() + (end.p[0] - self.speed(ENDS[1])).abs()
            });
            convergence.push(1.0 / f64::from(steps), errors.sum::<f64>() / 3.0);
        }
        convergence.order(1e-12)
    }
}

/// Orders by midpoint, Gauss 4 and Gauss 6, without and with stops.
fn orders(height: Table<6>) -> [[f64; 2]; 3] {
    let hill = Hill { height };
    [
        [false, true].map(|stops| hill.order(Midpoint, stops)),
        [false, true].map(|stops| hill.order(Gauss::<2>, stops)),
        [false, true].map(|stops| hill.order(Gauss::<3>, stops)),
    ]
}

#[test]
fn a_jump_in_the_k_th_derivative_of_the_force_leaves_order_k_plus_1() {
    let cases = [(Table::monotone(X, Y), [2.0, 2.0, 2.0]), (Table::spline(X, Y), [2.0, 3.0, 3.0])];
    for (table, across) in cases {
        let seen = orders(table.unwrap());
        for ((own, across), [plain, stopping]) in [2.0, 4.0, 6.0].into_iter().zip(across).zip(seen) {
            assert!((plain - across).abs() < 0.3, "{plain} in place of {across}: {seen:?}");
            assert!((stopping - own).abs() < 0.3, "{stopping} in place of {own}: {seen:?}");
        }
    }
}
