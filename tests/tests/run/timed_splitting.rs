//! Explicit steps of systems that take the time: splittings, Störmer–Verlet and its compositions, beside the
//! same system with the time as one more coordinate, whose steps ask for no clock.

use dalembert::nalgebra::vector;
use dalembert::step::{Flow, ForceWork};
use dalembert::{Composition, Discretise, Gauss, Splitting, State, Trajectory, Trapezoidal, rayleigh_system};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// A force that changes with time, on a damped pendulum coupled to a mass.
#[derive(Clone, Debug)]
struct Pushed {
    k: f64,
    r: [f64; 2],
    rate: f64,
}

#[rayleigh_system(rule = [trapezoidal, gauss])]
impl Pushed {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * v[0] * v[0] + 0.8 * v[1] * v[1] - 0.5 * (q[0] - q[1]).powi(2)
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * (self.r[0] * v[0] * v[0] + self.r[1] * v[1] * v[1])
    }

    fn force(&self, q: [f64; 2], _v: [f64; 2], t: f64) -> [f64; 2] {
        let (k, rate) = (self.k, self.rate);
        [(rate * t).sin() * q[0].cos() - q[0].sin(), -k * q[1] * (1.0 + 0.4 * (0.7 * t).cos()) + 0.1 * t]
    }
}

/// The same with the time as the third coordinate, which moves freely.
struct Autonomous(Pushed);

#[rayleigh_system(rule = trapezoidal)]
impl Autonomous {
    fn lagrangian(&self, q: [f64; 3], v: [f64; 3]) -> f64 {
        0.5 * v[0] * v[0] + 0.8 * v[1] * v[1] + 0.5 * v[2] * v[2] - 0.5 * (q[0] - q[1]).powi(2)
    }

    fn rayleigh(&self, v: [f64; 3]) -> f64 {
        0.5 * (self.0.r[0] * v[0] * v[0] + self.0.r[1] * v[1] * v[1])
    }

    fn force(&self, q: [f64; 3], _v: [f64; 3]) -> [f64; 3] {
        let (k, rate, t) = (self.0.k, self.0.rate, q[2]);
        [(rate * t).sin() * q[0].cos() - q[0].sin(), -k * q[1] * (1.0 + 0.4 * (0.7 * t).cos()) + 0.1 * t, 0.0]
    }
}

fn pushed(random: &mut StdRng) -> Pushed {
    let mut any = |low: f64, high: f64| random.random_range(low..high);
    Pushed { k: any(0.2, 2.0), r: [any(0.0, 0.4), any(0.0, 0.4)], rate: any(0.5, 3.0) }
}

/// The state with the time beside it.
fn beside(state: &State<f64, 2>, t: f64) -> State<f64, 3> {
    State { q: vector![state.q[0], state.q[1], t], p: vector![state.p[0], state.p[1], 1.0] }
}

/// How far runs with a clock are from those with a coordinate, over so many random systems; `late` is added
/// to the clock.
fn apart<M>(method: M, h: f64, late: f64) -> f64
where
    M: Copy,
    for<'s> PushedAtTime<'s>: Flow<M, 2, Scalar = f64> + ForceWork<M, 2>,
    Autonomous: Flow<M, 3, Scalar = f64> + ForceWork<M, 3>,
{
    let mut random = StdRng::seed_from_u64(31);
    let mut apart = 0.0_f64;
    for _ in 0..if cfg!(debug_assertions) { 10 } else { 40 } {
        let system = pushed(&mut random);
        let t = random.random_range(-5.0..5.0);
        let mut any = || random.random_range(-1.0..1.0);
        let start: State<f64, 2> = State { q: vector![any(), any()], p: vector![any(), any()] };
        let twin = Autonomous(system.clone());
        let view = system.at_time(t + late);
        let run = view.by(method, h).run(start).zip(twin.by(method, h).run(beside(&start, t))).take(60);
        for (step, by_twin) in run {
            let (end, by_twin) = (step.unwrap().state, by_twin.unwrap().state);
            let away = |of: &State<f64, 3>| {
                (end.q - of.q.fixed_rows::<2>(0)).amax().max((end.p - of.p.fixed_rows::<2>(0)).amax())
            };
            apart = apart.max(away(&by_twin));
        }
        // The derivative of a step, and what forces do over it.
        let (by, by_twin) = (view.by(method, h), twin.by(method, h));
        let from = beside(&start, t);
        let (step, of) = by.linearized_step(&start).unwrap();
        let (twins, of_twin) = by_twin.linearized_step(&from).unwrap();
        for (block, of_twin) in
            [(of.q_by_q, of_twin.q_by_q), (of.p_by_q, of_twin.p_by_q), (of.p_by_p, of_twin.p_by_p)]
        {
            apart = apart.max((block - of_twin.fixed_view::<2, 2>(0, 0)).amax());
        }
        let [own, twins] =
            [by.ledger(&start, &step.state).unwrap(), by_twin.ledger(&from, &twins.state).unwrap()];
        apart = apart.max((own.work - twins.work).abs()).max((own.dissipated - twins.dissipated).abs());
    }
    apart
}

#[test]
fn the_clock_is_one_more_coordinate() {
    fn check<M>(method: M, h: f64)
    where
        M: Copy,
        for<'s> PushedAtTime<'s>: Flow<M, 2, Scalar = f64> + ForceWork<M, 2>,
        Autonomous: Flow<M, 3, Scalar = f64> + ForceWork<M, 3>,
    {
        let found = apart(method, h, 0.0);
        assert!(found < 1e-11, "{found:e}");
        // The control: a clock that is late by a thousandth of a step shows.
        let late = apart(method, h, 1e-3 * h);
        assert!(late > 1e-6, "{late:e}");
    }
    check(Splitting::blanes_moan_4(), 0.1);
    check(Splitting::blanes_moan_6(), 0.3);
    check(Splitting::blanes_casas_escorihuela_8(), -0.3);
    check(Trapezoidal, 0.05);
    check(Composition::kahan_li_6(Trapezoidal), 0.2);
    check(Composition::kahan_li_8(Trapezoidal), 0.3);
}

/// Against fine steps of a Gauss rule.
#[test]
fn the_order_is_that_without_time() {
    let system = Pushed { k: 1.1, r: [0.05, 0.2], rate: 1.7 };
    let view = system.at_time(0.4);
    let start = State { q: vector![0.9, -0.4], p: vector![0.3, 0.5] };
    let fine = view.by(Gauss::<8>, 0.05).run(start).nth(159).unwrap().unwrap().state;
    fn error<L: Flow<M, 2, Scalar = f64>, M>(
        view: &L,
        method: M,
        steps: usize,
        start: State<f64, 2>,
        fine: &State<f64, 2>,
    ) -> f64 {
        let end = view.by(method, 8.0 / steps as f64).run(start).nth(steps - 1).unwrap().unwrap().state;
        (end.q - fine.q).norm() + (end.p - fine.p).norm()
    }
    let order = |of: &dyn Fn(usize) -> f64, steps: usize| (of(steps) / of(2 * steps)).log2();
    let orders = [
        order(&|steps| error(&view, Splitting::blanes_moan_4(), steps, start, &fine), 64),
        order(&|steps| error(&view, Splitting::blanes_moan_6(), steps, start, &fine), 40),
        order(&|steps| error(&view, Splitting::blanes_casas_escorihuela_8(), steps, start, &fine), 24),
        order(&|steps| error(&view, Trapezoidal, steps, start, &fine), 200),
    ];
    for (found, expected) in orders.into_iter().zip([4.0, 6.0, 8.0, 2.0]) {
        assert!((found - expected).abs() < 0.4, "{orders:?}");
    }
}

/// What is kept from step to step decides nothing: a run that is saved and resumed goes on bit by bit.
#[test]
fn a_run_is_resumed_at_its_time() {
    fn check<M: Copy>(method: M)
    where
        for<'s> PushedAtTime<'s>: Flow<M, 2, Scalar = f64>,
    {
        let system = Pushed { k: 1.1, r: [0.05, 0.2], rate: 1.7 };
        let view = system.at_time(1.3);
        let start = State { q: vector![0.9, -0.4], p: vector![0.3, 0.5] };
        let mut run = view.by(method, 0.07).run(start);
        run.by_ref().take(17).last().unwrap().unwrap();
        let mut resumed = Trajectory::resume(&view, method, run.checkpoint());
        let [end, again] = [&mut run, &mut resumed].map(|run| run.take(20).last().unwrap().unwrap().state);
        assert_eq!(end, again);
    }
    check(Splitting::blanes_moan_4());
    check(Splitting::blanes_moan_6());
    check(Splitting::blanes_casas_escorihuela_8());
}

/// A method for a tolerance may be a splitting.
#[test]
fn an_error_asked_for_is_kept() {
    let system = Pushed { k: 1.1, r: [0.05, 0.2], rate: 1.7 };
    let start = State { q: vector![0.9, -0.4], p: vector![0.3, 0.5] };
    for t in [0.0, 3.0] {
        let view = system.at_time(t);
        let fine = view.by(Gauss::<8>, 0.05).run(start).nth(399).unwrap().unwrap().state;
        for error in [1e-4, 1e-8, 1e-11] {
            let asked = view.to_error(error).until(20.0);
            let end = asked.run(start).unwrap().last().unwrap().unwrap().state;
            assert!((end.q - fine.q).amax() <= error, "{error:e}: {:e}", (end.q - fine.q).amax());
        }
    }
}
