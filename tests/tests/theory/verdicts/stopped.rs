//! Every check that goes from sample to sample ends where the caller says so.

use std::fmt::Display;
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use dalembert::exact::Exact;
use dalembert::hamilton_jacobi::{FamilyMember, GeneratingFamily};
use dalembert::nalgebra::{Matrix2, SVector, Vector2, vector};
use dalembert::noether::Generator;
use dalembert::rayleigh::{Comparison, Potential, Resplit};
use dalembert::run::Stop;
use dalembert::samples::{Pair, region, segments};
use dalembert::{Discretise, Midpoint, State, Trapezoidal, rayleigh_system};

/// A spring along the first coordinate, none along the second; friction as the inertia.
#[rayleigh_system(rule = [trapezoidal, midpoint])]
fn cart(q: [f64; 2], v: [f64; 2], a: f64) -> (f64, f64) {
    let kinetic = 0.5 * (v[0] * v[0] + v[1] * v[1]);
    (kinetic - 0.5 * q[0] * q[0], 2.0 * a * kinetic)
}

const CART: Cart = Cart { a: 0.1 };
const H: f64 = 0.1;

/// S(q; λ) = λ·q.
struct Lines;

impl GeneratingFamily<2> for Lines {
    type Scalar = f64;
    fn value(&self, q: &Vector2<f64>, lambda: &Vector2<f64>) -> f64 {
        lambda.dot(q)
    }
    fn gradient(&self, _q: &Vector2<f64>, lambda: &Vector2<f64>) -> Vector2<f64> {
        *lambda
    }
    fn hessian(&self, _q: &Vector2<f64>, _lambda: &Vector2<f64>) -> Matrix2<f64> {
        Matrix2::zeros()
    }
    fn by_parameters(&self, q: &Vector2<f64>, _lambda: &Vector2<f64>) -> Vector2<f64> {
        *q
    }
    fn mixed(&self, _q: &Vector2<f64>, _lambda: &Vector2<f64>) -> Matrix2<f64> {
        Matrix2::identity()
    }
}

/// Samples of all kinds, so many of each.
struct Samples {
    segments: Vec<Pair<f64, 2>>,
    states: Vec<State<f64, 2>>,
    points: Vec<SVector<f64, 2>>,
    count: usize,
}

impl Samples {
    fn new(count: usize) -> Self {
        let segments = segments([-1.0; 2], [1.0; 2], [0.2; 2], count);
        let state = |segment: &Pair<f64, 2>| State { q: segment.q0, p: (segment.q1 - segment.q0) / H };
        let states = segments.iter().map(state).collect();
        Self { segments, states, points: region([-1.0; 2], [1.0; 2], count), count }
    }
}

/// The text of an error, that a check has ended early.
type Checked = Result<(), String>;

fn checked<T, E: Display>(result: Result<T, E>) -> Checked {
    result.map(drop).map_err(|error| error.to_string())
}

type Check = (&'static str, fn(&Samples, Stop<'_>) -> Checked);

const GENERATORS: fn() -> [Generator<f64, 2>; 2] =
    || [Generator::translation("x", [1.0, 0.0]), Generator::translation("y", [0.0, 1.0])];

/// All of them.
const CHECKS: [Check; 24] = [
    ("Noether::symmetry", |samples, stop| {
        checked(CART.by(Midpoint, H).stopped_by(stop).noether().symmetry(&GENERATORS()[1], &samples.segments))
    }),
    ("Noether::subalgebra", |samples, stop| {
        checked(CART.by(Midpoint, H).stopped_by(stop).noether().subalgebra(&GENERATORS(), &samples.segments))
    }),
    ("Discretised::rayleigh_structure", |samples, stop| {
        checked(CART.by(Midpoint, H).stopped_by(stop).rayleigh_structure(&samples.segments))
    }),
    ("Potential::check", |samples, stop| {
        let base = Pair::new([0.1; 2], [0.0; 2]);
        checked(Potential::new(&CART, Midpoint, H, base).stopped_by(stop).check(&samples.segments))
    }),
    ("Resplit::check", |samples, stop| {
        checked(Resplit::new(&CART, Midpoint, H, [0.1; 2]).stopped_by(stop).check(&samples.segments))
    }),
    ("Comparison::check", |samples, stop| {
        let compared = Comparison::new((&CART, Midpoint), (&CART, Trapezoidal), H, [0.1; 2]);
        checked(compared.stopped_by(stop).check(&samples.segments))
    }),
    ("Discretised::proportion", |samples, stop| {
        checked(CART.by(Trapezoidal, H).stopped_by(stop).proportion(&samples.segments))
    }),
    ("Discretised::conformal_step", |samples, stop| {
        checked(CART.by(Trapezoidal, H).stopped_by(stop).conformal_step(&samples.states))
    }),
    ("Discretised::rayleigh_equation", |samples, stop| {
        checked(CART.by(Midpoint, H).stopped_by(stop).rayleigh_equation(&samples.states))
    }),
    ("Discretised::rayleigh_step", |samples, stop| {
        checked(CART.by(Midpoint, H).stopped_by(stop).rayleigh_step(&samples.states))
    }),
    ("Discretised::modified_linear_system", |samples, stop| {
        checked(CART.by(Midpoint, H).stopped_by(stop).modified_linear_system(&samples.states))
    }),
    ("Discretised::routh", |samples, stop| {
        checked(CART.by(Midpoint, H).stopped_by(stop).routh::<1>(1, &samples.segments))
    }),
    ("HamiltonJacobi::hamilton_equations", |samples, stop| {
        checked(CART.by(Midpoint, H).stopped_by(stop).hamilton_jacobi().hamilton_equations(&samples.points))
    }),
    ("HamiltonJacobi::hamilton_equations_rayleigh", |samples, stop| {
        let theory = CART.by(Midpoint, H).stopped_by(stop).hamilton_jacobi();
        checked(theory.hamilton_equations_rayleigh(&samples.points))
    }),
    ("HamiltonJacobi::as_printed", |samples, stop| {
        let theory = CART.by(Midpoint, H).stopped_by(stop).hamilton_jacobi();
        let family: Vec<_> = samples.points.iter().map(|_| LINE).collect();
        checked(theory.as_printed(&family, &samples.points))
    }),
    ("HamiltonJacobi::along_trajectory", |samples, stop| {
        checked(CART.by(Midpoint, H).stopped_by(stop).hamilton_jacobi().along_trajectory(&samples.points))
    }),
    ("HamiltonJacobi::right_equation_everywhere", |samples, stop| {
        let theory = CART.by(Midpoint, H).stopped_by(stop).hamilton_jacobi();
        checked(theory.right_equation_everywhere(&[LINE; 3], &samples.points))
    }),
    ("HamiltonJacobi::check_sections", |samples, stop| {
        let theory = CART.by(Midpoint, H).stopped_by(stop).hamilton_jacobi();
        checked(theory.check_sections(&[LINE; 2], &samples.points))
    }),
    ("HamiltonJacobi::check_generating_functions", |samples, stop| {
        let theory = CART.by(Midpoint, H).stopped_by(stop).hamilton_jacobi();
        checked(theory.check_generating_functions(&[LINE; 2], &samples.points))
    }),
    ("HamiltonJacobi::carry", |samples, stop| {
        let theory = CART.by(Midpoint, H).stopped_by(stop).hamilton_jacobi();
        checked(theory.carry(&LINE, &vector![0.3, 0.1], samples.count))
    }),
    ("HamiltonJacobi::characteristics_report", |samples, stop| {
        let by = CART.by(Midpoint, H);
        let carried = by.hamilton_jacobi().carry(&LINE, &vector![0.3, 0.1], samples.count).unwrap();
        checked(by.stopped_by(stop).hamilton_jacobi().characteristics_report(&[carried]))
    }),
    ("HamiltonJacobi::carried_generating_function", |samples, stop| {
        let theory = CART.by(Midpoint, H).stopped_by(stop).hamilton_jacobi();
        let (reference, label) = (vector![0.0, 0.0], vector![0.3, 0.1]);
        let nodes = NonZeroUsize::MIN;
        checked(theory.carried_generating_function(&LINE, &reference, &label, samples.count, nodes))
    }),
    ("ConformalHamiltonJacobi::jacobi_constants", |samples, stop| {
        let by = CART.by(Trapezoidal, H).stopped_by(stop);
        let constants = by.conformal_hamilton_jacobi(&samples.states).and_then(|theory| {
            theory.jacobi_constants(&Lines, &LAMBDA, &vector![0.3, 0.1], samples.count.min(4), 0.05)
        });
        checked(constants)
    }),
    ("Exact::order", |samples, stop| {
        let sizes: Vec<f64> = (1..=samples.count).map(|k| 1.0 / k as f64).collect();
        let order = Exact::new(&CART).stopped_by(stop).order(Midpoint, [0.3, 0.1], [0.5, 0.2], &sizes);
        checked(order)
    }),
];

const LAMBDA: Vector2<f64> = Vector2::new(0.5, -0.2);
const LINE: FamilyMember<'static, Lines, f64, 2> = FamilyMember { family: &Lines, lambda: LAMBDA };

#[test]
fn checks_end_at_whichever_look_they_are_told_to() {
    let (samples, trials) = (Samples::new(12), if cfg!(debug_assertions) { 3 } else { 100 });
    for (name, check) in CHECKS {
        let looks = AtomicU64::new(0);
        let count = || {
            looks.fetch_add(1, Ordering::Relaxed);
            false
        };
        // Control: looked at and not told to end, it comes to an end of its own.
        assert_eq!(check(&samples, Stop::when(&count)), Ok(()), "{name}");
        let all = looks.load(Ordering::Relaxed);
        assert!(all >= 10, "{name}: {all}");
        for last in (0..all).step_by(1 + all as usize / trials) {
            looks.store(0, Ordering::Relaxed);
            let is_asked = || looks.fetch_add(1, Ordering::Relaxed) >= last;
            let stopped = check(&samples, Stop::when(&is_asked));
            assert_eq!(stopped, Err("the check was ended by its caller".to_owned()), "{name} at look {last}");
            // Attempts that follow one another each look once.
            assert!(looks.load(Ordering::Relaxed) < last + 200, "{name}");
        }
    }
}

/// How long each takes for many samples, and until it ends when told to after a tenth of a second.
#[test]
#[ignore = "a table of times, to be read"]
fn times_of_checks() {
    let samples = Samples::new(std::env::var("SAMPLES").map_or(100_000, |count| count.parse().unwrap()));
    for (name, check) in CHECKS {
        let begun = Instant::now();
        let is_late = || begun.elapsed().as_secs_f64() > 0.1;
        let stopped = check(&samples, Stop::when(&is_late));
        println!("{name:<46}{:.3} s, {stopped:?}", begun.elapsed().as_secs_f64());
    }
}
