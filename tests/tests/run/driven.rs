//! Runs whose input changes from step to step: each step is that of the system with its input, cold, up to
//! rounding; what a step gives by state, input and parameters; errors, corrections, checkpoints.

use dalembert::nalgebra::{SVector, vector};
use dalembert::rules::Quadrature;
use dalembert::run::DrivenTrajectory;
use dalembert::step::Flow;
use dalembert::{
    Composition, Discretise, Gauss, Midpoint, Splitting, State, StepError, Trapezoidal, rayleigh_system,
};
use dalembert_tests::simpson::Simpson;
use rand::{RngExt, SeedableRng, rngs::StdRng};

/// Links with motors: the mass depends on q.
struct Links {
    c: f64,
    g: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss], parameters = [c, g])]
impl Links {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        v[0] * v[0]
            + 0.5 * v[1] * v[1]
            + (q[0] - q[1]).cos() * v[0] * v[1]
            + self.g * (2.0 * q[0].cos() + q[1].cos())
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.c * (v[0] * v[0] + (v[1] - v[0]).powi(2))
    }
    fn force(&self, _q: [f64; 2], v: [f64; 2], u: [f64; 2]) -> [f64; 2] {
        [u[0] - u[1] * v[1], u[1]]
    }
}

/// Springs in a row whose equation is linear, the input in its matrix: `u[1]` brakes.
struct Brakes {
    k: f64,
}

#[rayleigh_system(rule = [midpoint, gauss])]
impl Brakes {
    fn lagrangian(&self, q: [f64; 4], v: [f64; 4]) -> f64 {
        let mut l = 0.0;
        for i in 0..4 {
            let left = if i > 0 { q[i - 1] } else { 0.0 };
            l += 0.5 * v[i] * v[i] - 0.5 * self.k * (q[i] - left) * (q[i] - left);
        }
        l
    }
    fn force(&self, _q: [f64; 4], v: [f64; 4], u: [f64; 2]) -> [f64; 4] {
        [u[0] - u[1] * v[0], -u[1] * v[1], 0.0, -u[1] * v[3]]
    }
}

/// Explicit by the trapezoidal rule: pushed where it stands.
struct Pushed {
    r: f64,
}

#[rayleigh_system(rule = trapezoidal)]
impl Pushed {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * v[0] * v[0] + v[1] * v[1] + q[0].cos() - 0.5 * (q[1] - q[0]).powi(2)
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.r * v[0] * v[0]
    }
    fn force(&self, q: [f64; 2], _v: [f64; 2], u: [f64; 2]) -> [f64; 2] {
        [u[0] * (1.0 + 0.1 * q[0]), u[1]]
    }
}

/// Pushed at its own time.
struct Tide;

#[rayleigh_system(rule = [midpoint, gauss])]
impl Tide {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] + q[0].cos()
    }
    fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1], t: f64) -> [f64; 1] {
        [u[0] * t.sin()]
    }
}

/// The largest distance of a run's states from those of cold steps, in units of the state, and the least
/// distance from those of cold steps with the input before.
macro_rules! against_cold {
    ($random:ident, $system:ident, $method:expr, $h:expr, $n:literal, $u:expr) => {{
        let start = State {
            q: SVector::<f64, $n>::from_fn(|_, _| $random.random_range(-1.0..1.0)),
            p: SVector::<f64, $n>::from_fn(|_, _| $random.random_range(-1.0..1.0)),
        };
        let mut held = [0.0; 2];
        let mut run = $system.driven(held).by($method, $h).run_with_inputs(start);
        let (mut worst, mut least) = (0.0_f64, f64::INFINITY);
        for k in 0..60 {
            let before = *run.state();
            let cold = |u: [f64; 2]| $system.driven(u).by($method, $h).step(&before).unwrap().state;
            let u = $u(k, &mut $random);
            let end = run.advance(&$system.driven(u)).unwrap().state;
            assert_eq!(end, *run.state());
            let size = 1.0 + end.q.amax().max(end.p.amax());
            let distance =
                |other: State<f64, $n>| (end.q - other.q).amax().max((end.p - other.p).amax()) / size;
            worst = worst.max(distance(cold(u)));
            least = least.min(distance(cold(held)));
            held = u;
        }
        [worst, least]
    }};
}

#[test]
fn each_step_is_that_of_its_input() {
    let mut random = StdRng::seed_from_u64(20_261_123);
    let uniform =
        |_: i32, random: &mut StdRng| -> [f64; 2] { [(); 2].map(|()| random.random_range(-2.0..2.0)) };
    // A brake that is slammed and let go: the matrix changes by any factor.
    let brake = |k: i32, random: &mut StdRng| -> [f64; 2] {
        [
            random.random_range(-2.0..2.0),
            if k % 7 == 0 { 10_f64.powf(random.random_range(0.0..9.0)) } else { 0.0 },
        ]
    };
    for _ in 0..if cfg!(debug_assertions) { 5 } else { 20 } {
        let h = random.random_range(0.01..0.15);
        let links = Links { c: random.random_range(0.0..1.0), g: random.random_range(0.0..5.0) };
        let brakes = Brakes { k: random.random_range(0.1..10.0) };
        let check = |[worst, least]: [f64; 2]| {
            assert!(worst < 2e-13, "{worst:e}");
            // Positive control: the step of the input before is another.
            assert!(least > 1e-9, "{least:e}");
        };
        check(against_cold!(random, links, Midpoint, h, 2, uniform));
        check(against_cold!(random, links, Trapezoidal, h, 2, uniform));
        check(against_cold!(random, links, Quadrature(Simpson), h, 2, uniform));
        check(against_cold!(random, links, Gauss::<1>, h, 2, uniform));
        check(against_cold!(random, links, Gauss::<3>, h, 2, uniform));
        check(against_cold!(random, links, Composition::kahan_li_6(Midpoint), h, 2, uniform));
        let pushed = Pushed { r: random.random_range(0.0..1.0) };
        check(against_cold!(random, pushed, Trapezoidal, h, 2, uniform));
        check(against_cold!(random, pushed, Splitting::blanes_moan_6(), h, 2, uniform));
        check(against_cold!(random, pushed, Splitting::blanes_casas_escorihuela_8(), h, 2, uniform));
        check(against_cold!(random, pushed, Composition::kahan_li_8(Trapezoidal), h, 2, uniform));
        check(against_cold!(random, brakes, Midpoint, h, 4, brake));
        check(against_cold!(random, brakes, Gauss::<2>, h, 4, brake));
    }
}

/// With one input all along it is the run of the system that holds it; resumed, it goes on bit by bit.
#[test]
fn with_one_input_it_is_the_run_of_that_system() {
    fn same<L, M: Copy, const N: usize>(view: &L, method: M, start: State<f64, N>)
    where
        L: Flow<M, N, Scalar = f64>,
    {
        let mut held = view.by(method, 0.05).run(start);
        let mut given = view.by(method, 0.05).run_with_inputs(start);
        for _ in 0..50 {
            let (held, given) = (held.next().unwrap().unwrap().state, given.advance(view).unwrap().state);
            assert!((held.q - given.q).amax().max((held.p - given.p).amax()) < 1e-12);
        }
        assert_eq!(held.time(), given.time());
        let mut resumed = DrivenTrajectory::<L, M, N>::resume(given.checkpoint());
        for _ in 0..5 {
            assert_eq!(resumed.advance(view).unwrap(), given.advance(view).unwrap());
        }
    }
    let links = Links { c: 0.1, g: 3.0 };
    let view = links.driven([0.4, -0.2]);
    let start = State { q: vector![0.3, 0.9], p: vector![0.1, -0.4] };
    same(&view, Midpoint, start);
    same(&view, Trapezoidal, start);
    same(&view, Gauss::<4>, start);
    same(&view, Composition::kahan_li_6(Midpoint), start);
}

/// A, B and θ of a step of a run: those of the cold step, and of central differences.
#[test]
fn a_step_tells_how_it_follows_state_input_and_parameters() {
    let mut random = StdRng::seed_from_u64(5);
    for _ in 0..if cfg!(debug_assertions) { 4 } else { 10 } {
        let links = Links { c: random.random_range(0.0..1.0), g: random.random_range(0.0..5.0) };
        macro_rules! checked {
            ($($method:expr),*) => {$({
                let start = State { q: vector![0.3, 0.9], p: vector![0.1, -0.4] };
                let mut run = links.driven([0.0; 2]).by($method, 0.1).run_with_inputs(start);
                for _ in 0..12 {
                    let u = [(); 2].map(|()| random.random_range(-2.0..2.0));
                    let before = *run.state();
                    let view = links.driven(u);
                    let taken = run.advance_linearized(&view).unwrap();
                    let cold = view.by($method, 0.1).linearized(&before).unwrap();
                    let (a, b) = (taken.by_state().unwrap(), taken.by_input::<2>().unwrap());
                    let theta = taken.by_parameters::<2>().unwrap();
                    let of_cold = cold.by_state().unwrap();
                    assert!((a.assembled::<4>() - of_cold.assembled::<4>()).amax() < 1e-11);
                    let of_cold = cold.by_input::<2>().unwrap();
                    assert!((b.assembled::<4>() - of_cold.assembled::<4>()).amax() < 1e-11);
                    let of_cold = cold.by_parameters::<2>().unwrap();
                    assert!((theta.assembled::<4>() - of_cold.assembled::<4>()).amax() < 1e-11);
                    // By differences, of the step as it is taken.
                    let end = |links: &Links, u: [f64; 2]| {
                        links.driven(u).by($method, 0.1).step(&before).unwrap().state
                    };
                    let d = 1e-5;
                    let (up, down) = (end(&links, [u[0] + d, u[1]]), end(&links, [u[0] - d, u[1]]));
                    let slope = (up.q - down.q) / (2.0 * d);
                    assert!((slope - b.q.column(0)).amax() < 1e-8, "{slope} {}", b.q);
                    let at = |c: f64| end(&Links { c, ..links }, u);
                    let slope = (at(links.c + d).p - at(links.c - d).p) / (2.0 * d);
                    assert!((slope - theta.p.column(0)).amax() < 1e-8, "{slope} {}", theta.p);
                    assert_eq!(taken.step().state, *run.state());
                }
            })*};
        }
        checked!(Midpoint, Trapezoidal, Quadrature(Simpson), Gauss::<2>, Gauss::<4>);
    }
}

/// An error leaves the state, and a better input goes on from there.
#[test]
fn an_error_leaves_the_state_and_the_run_goes_on() {
    let links = Links { c: 0.1, g: 1.0 };
    let start = State { q: vector![0.3, 0.9], p: vector![0.1, -0.4] };
    let mut run = links.driven([0.0; 2]).by(Midpoint, 0.1).run_with_inputs(start);
    run.advance(&links.driven([0.1, 0.0])).unwrap();
    let (state, time) = (*run.state(), run.time());
    assert!(matches!(run.advance(&links.driven([f64::NAN, 0.0])), Err(StepError::NonFinite { .. })));
    assert!(run.advance_linearized(&links.driven([f64::INFINITY, 0.0])).is_err());
    assert!(run.advance_in_parts(&links.driven([f64::NAN, 0.0]), 3).is_err());
    assert_eq!((*run.state(), run.time()), (state, time));
    let expected = links.driven([0.2, 0.0]).by(Midpoint, 0.1).step(&state).unwrap().state;
    let step = run.advance(&links.driven([0.2, 0.0])).unwrap();
    assert!((step.state.q - expected.q).amax() < 1e-14 && run.time() == 0.2);

    // A state that is none is refused, and the next correction mends it.
    run.correct(State { q: vector![f64::NAN, 0.0], ..start });
    assert!(matches!(run.advance(&links.driven([0.0; 2])), Err(StepError::NonFinite { .. })));
    run.correct(state);
    assert!(run.advance(&links.driven([0.0; 2])).is_ok());
    run.change_step_size(0.0);
    assert!(matches!(run.advance(&links.driven([0.0; 2])), Err(StepError::StepSize { .. })));
    run.change_step_size(0.05);
    assert_eq!(run.advance_in_parts(&links.driven([0.0; 2]), 3).unwrap().parts, 1);
    assert_eq!(run.time(), 0.1_f64.mul_add(3.0, 0.05));
}

/// An estimator corrects the state at each step: the steps are those from the corrected states, and a Gauss
/// rule's guess saves sweeps.
#[test]
fn a_corrected_run_goes_on_from_the_corrected_state() {
    fn corrected<L, M: Copy>(view: &L, method: M) -> [u32; 2]
    where
        L: Flow<M, 2, Scalar = f64>,
    {
        let mut random = StdRng::seed_from_u64(9);
        let start = State { q: vector![0.3, 0.9], p: vector![0.1, -0.4] };
        let mut run = view.by(method, 0.02).run_with_inputs(start);
        let mut iterations = [0, 0];
        for _ in 0..100 {
            let State { q, p } = *run.state();
            let noise = [(); 4].map(|()| random.random_range(-1e-4..1e-4));
            let state = State { q: q + vector![noise[0], noise[1]], p: p + vector![noise[2], noise[3]] };
            run.correct(state);
            assert_eq!(*run.state(), state);
            let cold = view.by(method, 0.02).step(&state).unwrap();
            let step = run.advance(view).unwrap();
            assert!((step.state.q - cold.state.q).amax().max((step.state.p - cold.state.p).amax()) < 1e-13);
            iterations = [iterations[0] + step.report.iterations, iterations[1] + cold.report.iterations];
        }
        iterations
    }
    let links = Links { c: 0.1, g: 3.0 };
    let view = links.driven([0.5, 0.1]);
    corrected(&view, Midpoint);
    let [kept, cold] = corrected(&view, Gauss::<4>);
    assert!(kept + 100 < cold, "{kept} {cold}");
    corrected(&view, Composition::kahan_li_6(Midpoint));
    let pushed = Pushed { r: 0.1 };
    let view = pushed.driven([0.5, 0.1]);
    corrected(&view, Trapezoidal);
    corrected(&view, Splitting::blanes_moan_4());
    corrected(&view, Composition::kahan_li_6(Trapezoidal));
}

/// Time is the view's: the run says which.
#[test]
fn time_is_that_of_the_view() {
    let start = State { q: vector![0.3], p: vector![0.0] };
    let mut run = Tide.driven([0.0], 0.0).by(Gauss::<3>, 0.1).run_with_inputs(start);
    let view = Tide.driven([0.7], 0.0);
    let mut held = view.by(Gauss::<3>, 0.1).run(start);
    for _ in 0..40 {
        let step = run.advance(&Tide.driven([0.7], run.time())).unwrap();
        assert!((step.state.q - held.next().unwrap().unwrap().state.q).amax() < 1e-14);
    }
}

/// A controller that owns its machine and its model.
#[test]
fn a_run_is_a_field_of_a_controller() {
    struct Controller {
        machine: Links,
        model: DrivenTrajectory<DrivenLinks<'static>, Midpoint, 2>,
    }
    impl Controller {
        fn period(&mut self, u: [f64; 2]) -> Result<f64, StepError> {
            let view = self.machine.driven(u);
            let taken = self.model.advance_linearized(&view)?;
            Ok(taken.by_input::<2>()?.q[(0, 0)])
        }
    }
    let machine = Links { c: 0.1, g: 1.0 };
    let start = State::from_velocity(&machine, [0.1, 0.2], [0.0, 0.0]).unwrap();
    let model = DrivenTrajectory::new(0.01, start);
    let mut controller = Controller { machine, model };
    assert!(controller.period([1.0, 0.0]).unwrap() > 0.0);
}
