//! One run for all methods: a first guess, samples, derivatives of the step, and a guarded run that is saved.

use dalembert::nalgebra::{Matrix4, SVector, vector};
use dalembert::rules::{DisplacementRule, Node, Quadrature};
use dalembert::step::{Flow, PhaseMatrix};
use dalembert::tolerance::{GuardedCheckpoint, GuardedTrajectory, ToleranceError};
use dalembert::{
    Composition, Discretise, Gauss, Midpoint, Splitting, State, StepError, Trajectory, Trapezoidal,
    rayleigh_system,
};
use dalembert_tests::simpson::Simpson;
use dalembert_tests::systems::{Charge, DoublePendulum};

#[derive(Clone, Copy)]
struct Well {
    r: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
impl Well {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + 2.0 * v[1] * v[1]) - (q[0] * q[0] * q[1]).cosh() - q[1].powi(4)
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.r * (v[0] * v[0] + v[0] * v[1] + v[1] * v[1])
    }
    fn force(&self, q: [f64; 2], _v: [f64; 2]) -> [f64; 2] {
        [-0.1 * q[1], 0.2 * q[0].sin()]
    }
}

const WELL: Well = Well { r: 0.3 };
const START: State<f64, 2> = State { q: vector![0.7, -0.4], p: vector![0.5, 1.1] };

/// The first step of a run starts where it was told to, as a step does.
#[test]
fn a_run_takes_a_first_guess() {
    fn first<L, M: Copy, const N: usize>(system: &L, method: M, start: State<f64, N>) -> [u32; 2]
    where
        L: Flow<M, N, Scalar = f64>,
    {
        let by = system.by(method, 0.05);
        let near = by.step(&start).unwrap().velocity;
        let [cold, warm] = [by, by.near(&near)].map(|by| by.run(start).next().unwrap().unwrap());
        assert_eq!(warm, by.near(&near).step(&start).unwrap());
        assert!((warm.state.q - cold.state.q).amax() < 1e-14);
        [cold, warm].map(|step| step.report.iterations)
    }
    let pendulum = DoublePendulum::EXAMPLE;
    let start = State::from_velocity(&pendulum, [1.1, -0.6], [0.3, 1.2]).unwrap();
    for [cold, warm] in [
        first(&pendulum, Midpoint, start),
        first(&pendulum, Trapezoidal, start),
        first(&pendulum, Quadrature(Simpson), start),
        first(&WELL, Midpoint, START),
    ] {
        assert!(warm < cold, "{warm} {cold}");
    }
    // A guess of one velocity is none for all stages; it is taken all the same.
    first(&pendulum, Gauss::<3>, start);
    // Nothing is solved here: the guess changes nothing.
    let by = WELL.by(Splitting::blanes_moan_4(), 0.05);
    assert_eq!(by.near(&vector![1e9, 1e9]).run(START).next(), by.run(START).next());
}

/// Against central differences of order 6 of the step itself.
#[test]
fn every_method_is_differentiated() {
    fn off<L, M: Copy>(system: &L, method: M) -> f64
    where
        L: Flow<M, 2, Scalar = f64>,
    {
        let by = system.by(method, 0.2);
        let (step, of_step) = by.linearized_step(&START).unwrap();
        let whole = by.step(&START).unwrap();
        assert!(
            (step.state.q - whole.state.q).amax() < 1e-14 && (step.state.p - whole.state.p).amax() < 1e-14
        );
        let a: Matrix4<f64> = of_step.assembled();
        let delta = 1e-2;
        (0..4).fold(0.0, |worst: f64, column| {
            let at = |multiple: f64| -> SVector<f64, 4> {
                let mut state = START;
                let of = if column < 2 { &mut state.q } else { &mut state.p };
                of[column % 2] += multiple * delta;
                let State { q, p } = by.step(&state).unwrap().state;
                vector![q[0], q[1], p[0], p[1]]
            };
            let odd = |multiple: f64| at(multiple) - at(-multiple);
            let difference = (odd(1.0) * 45.0 - odd(2.0) * 9.0 + odd(3.0)) / (60.0 * delta);
            worst.max((a.column(column) - difference).amax())
        })
    }
    for off in [
        off(&WELL, Composition::kahan_li_6(Midpoint)),
        off(&WELL, Composition::kahan_li_8(Trapezoidal)),
        off(&WELL, Composition::kahan_li_6(Gauss::<2>)),
        off(&WELL, Splitting::blanes_moan_4()),
        off(&WELL, Splitting::blanes_moan_6()),
        off(&WELL, Splitting::blanes_casas_escorihuela_8()),
        off(&WELL, Quadrature(Simpson)),
    ] {
        assert!(off < 1e-9, "{off:e}");
    }
    // The control: without the friction, another derivative.
    let [with, without] = [WELL, Well { r: 0.0 }].map(|system| {
        let (_, a) = system.by(Splitting::blanes_moan_4(), 0.2).linearized_step(&START).unwrap();
        a.assembled::<4>()
    });
    assert!((with - without).amax() > 1e-2);
    assert_eq!(PhaseMatrix::<f64, 2>::identity().assembled::<4>(), Matrix4::identity());
}

/// The nodes of rules that the attribute writes out.
#[derive(Clone, Copy)]
struct Middle;

impl DisplacementRule for Middle {
    const NODES: &'static [Node] = Midpoint::NODES;
}

/// With friction that depends on q, gyroscopic terms and a general force: all terms are there.
#[test]
fn a_rule_of_ones_own_is_the_rule_of_its_nodes() {
    let charge = Charge::EXAMPLE;
    let start = State::from_velocity(&charge, [0.4, -0.7, 0.3], [0.9, 0.2, -0.5]).unwrap();
    let [written, own] =
        [charge.by(Midpoint, 0.1).step(&start), charge.by(Quadrature(Middle), 0.1).step(&start)]
            .map(|step| step.unwrap().state);
    assert!((written.q - own.q).amax() < 1e-15 && (written.p - own.p).amax() < 1e-15);
    let (q0, q1) = (start.q, own.q);
    let (l, f) = (charge.by(Midpoint, 0.1), charge.by(Quadrature(Middle), 0.1));
    assert!((l.discrete_force(&q0, &q1).minus - f.discrete_force(&q0, &q1).minus).amax() < 1e-16);
    assert!((l.discrete_rayleigh(&q0, &q1) - f.discrete_rayleigh(&q0, &q1)).abs() < 1e-17);
    let [a, b] = [
        l.segment(&q0, &q1).unwrap().legendre_derivatives(),
        f.segment(&q0, &q1).unwrap().legendre_derivatives(),
    ];
    assert!((a.unwrap().p0_by_q1 - b.unwrap().p0_by_q1).amax() < 1e-13);
    // The control: other nodes, another step.
    let other = charge.by(Quadrature(Simpson), 0.1).step(&start).unwrap().state;
    assert!((written.q - other.q).amax() > 1e-6);
    // In order 2 all the same, and 6 composed.
    let end = |h: f64, steps: usize| {
        charge.by(Quadrature(Simpson), h).run(start).nth(steps - 1).unwrap().unwrap().state
    };
    let fine = |h: f64, steps: usize| {
        let composition = Composition::kahan_li_6(Quadrature(Simpson));
        charge.by(composition, h).run(start).nth(steps - 1).unwrap().unwrap().state
    };
    let exact = charge.by(Gauss::<6>, 0.05).run(start).nth(19).unwrap().unwrap().state;
    let order = |coarse: State<f64, 3>, fine: State<f64, 3>| {
        ((coarse.q - exact.q).norm() / (fine.q - exact.q).norm()).log2()
    };
    let two = order(end(0.05, 20), end(0.025, 40));
    let six = order(fine(0.25, 4), fine(0.125, 8));
    assert!((two - 2.0).abs() < 0.1 && (six - 6.0).abs() < 0.5, "{two} {six}");
}

/// What Gauss rules do not find between two ends is an error that says so.
#[test]
fn a_segment_without_a_solution_is_an_error() {
    #[rayleigh_system(rule = [midpoint, gauss])]
    fn cliff(q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - (20.0 * q[0]).exp()
    }
    let (q0, q1) = (vector![0.0], vector![0.01]);
    let found = Cliff {}.by(Gauss::<4>, 0.01).segment(&q0, &q1).unwrap();
    assert!(found.discrete_lagrangian().unwrap().is_finite());
    // Ten times as long on the way: Newton's method does not get there.
    let error = Cliff {}.by(Gauss::<4>, 0.1).segment(&q0, &q1).err().unwrap();
    assert!(matches!(error, StepError::NoRealSolution { .. }), "{error}");
}

#[test]
fn a_guarded_run_is_sampled_and_saved() {
    let pendulum = DoublePendulum::EXAMPLE;
    let start = State::from_velocity(&pendulum, [1.1, -0.6], [0.3, 1.2]).unwrap();
    let asked = pendulum.to_error(1e-7).until(8.0);
    let mut whole = asked.run(start).unwrap();
    let steps: Vec<_> = whole.by_ref().map(|step| step.unwrap().state).collect();
    let mut sampled = asked.run(start).unwrap();
    let samples: Vec<_> = sampled.sample_every(7).map(Result::unwrap).collect();
    assert_eq!(samples.len(), steps.len().div_ceil(7));
    for (k, sample) in samples.iter().enumerate() {
        assert_eq!(sample.state, steps[(7 * k + 6).min(steps.len() - 1)]);
    }
    assert_eq!(samples.last().unwrap().time, whole.time());

    // Both go on alike: states, the error expected, and what all has cost.
    let mut run = asked.run(start).unwrap();
    run.by_ref().take(steps.len() / 2).for_each(|step| assert!(step.is_ok()));
    let text = serde_json::to_string(&run.checkpoint()).unwrap();
    let checkpoint: GuardedCheckpoint<f64, 2> = serde_json::from_str(&text).unwrap();
    let mut resumed = GuardedTrajectory::resume(&pendulum, &checkpoint).unwrap();
    assert!(resumed.by_ref().eq(run.by_ref()));
    assert_eq!((resumed.expected(), resumed.time()), (run.expected(), run.time()));
    assert_eq!(resumed.evaluations(), run.evaluations());
    assert_eq!(resumed.breach(), run.breach());
    // The guard of a run that starts anew where this one stood knows of no error so far.
    let anew =
        pendulum.to_error(1e-7).until(4.0).run(*Trajectory::state(&pendulum.by(Midpoint, 0.1).run(start)));
    assert!(anew.unwrap().expected() < resumed.expected());

    #[rayleigh_system(rule = midpoint)]
    fn other(q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - q[0] * q[0] - q[1] * q[1]
    }
    let refused = GuardedTrajectory::resume(&Other {}, &checkpoint).err().unwrap();
    assert!(matches!(refused, ToleranceError::NotOffered { .. }), "{refused}");
}
