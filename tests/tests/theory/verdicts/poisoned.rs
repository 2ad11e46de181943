//! False claims on poisoned samples, step sizes, tolerances and runs: none gets a yes.

use dalembert::exact::{Exact, ExactError, ExistenceVerdict};
use dalembert::nalgebra::{SVector, vector};
use dalembert::noether::Generator;
use dalembert::rayleigh::{Comparison, Condition, Potential, Resplit, dissipation, structure};
use dalembert::samples::{Finding, Pair, TangentPoint, Tolerance, segments, tangent_points};
use dalembert::step::Step;
use dalembert::{Discrete, Discretise, Midpoint, State, StepError, Trapezoidal, rayleigh_system};

/// Nothing that is asked of it holds: no symmetry, a force with curls that drives, R that drives.
struct Wrong;

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl Wrong {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + 1.3 * v[1] * v[1])
            - 0.3 * q[0].powi(4)
            - 0.2 * q[0] * q[1]
            - 0.5 * q[1] * q[1]
            - 0.4 * q[1]
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        -0.2 * (v[0] * v[0] + v[1] * v[1]) - 0.1 * v[0].powi(4)
    }

    fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        [0.5 * q[1] + 0.1 * v[1] * v[1] - 0.3, -0.5 * q[0] + 0.3 * v[0] * v[0] + 0.6]
    }
}

/// All that is asked of it holds.
#[rayleigh_system(rule = [midpoint, trapezoidal])]
fn right(_q: [f64; 2], v: [f64; 2], c: f64) -> (f64, f64) {
    (0.5 * (v[0] * v[0] + v[1] * v[1]), 0.5 * c * (v[0] * v[0] + v[1] * v[1]))
}

const H: f64 = 0.1;
const ROUNDING: f64 = 1024.0 * f64::EPSILON;

type Segments = Vec<Pair<f64, 2>>;

/// Segments of a set; the more, the longer each takes without optimisation.
const COUNT: usize = if cfg!(debug_assertions) { 8 } else { 24 };

fn clean() -> Segments {
    segments([-1.0; 2], [1.0; 2], [0.2; 2], COUNT)
}

/// Names and answers: what says yes to a claim that is false of [`Wrong`].
type Answers = Vec<(&'static str, bool)>;

/// Every verdict on segments. Errors are no yes.
fn answers<L>(system: &L, claims: &L, segments: &[Pair<f64, 2>], h: f64, relative: f64) -> Answers
where
    L: Discrete<Midpoint, 2, Scalar = f64> + Discrete<Trapezoidal, 2>,
{
    let mut answers = Answers::new();
    let noether = system.by(Midpoint, h).noether().with_tolerance(relative);
    let (x, rotation) = (Generator::translation("x", [1.0, 0.0]), Generator::rotation(0, 1));
    for generator in [x.clone(), rotation.clone(), x.clone() + rotation.clone() * 0.7] {
        if let Ok(found) = noether.symmetry(&generator, segments) {
            answers.extend([
                ("is_symmetry_of_lagrangian", found.is_symmetry_of_lagrangian()),
                ("force_does_work", !found.force_does_work()),
                ("is_conserved", found.is_conserved()),
                ("lagrangian.vanishes", found.lagrangian.vanishes()),
                ("force.vanishes", found.force.vanishes()),
                ("defect.vanishes", found.defect.vanishes()),
                ("is_consistent", found.is_consistent() && found.is_conserved()),
                ("J is conserved", found.to_string().contains("J is conserved")),
            ]);
        }
    }
    if let Ok(found) = noether.subalgebra(&[x.clone(), rotation], segments) {
        for (name, space) in [
            ("lagrangian", &found.lagrangian),
            ("conserved", &found.conserved),
            ("invariant", &found.invariant),
        ] {
            answers.push((name, space.dimension() > 0 && space.decision.is_clear()));
        }
        answers.push(("premise_holds", found.premise_holds()));
        answers.push(("is_closed", found.closure.is_closed()));
    }
    // The other verdicts state their own tolerance.
    if relative == ROUNDING {
        if let Ok(found) = structure(system, Midpoint, h, segments) {
            answers.extend([
                ("is_rayleigh", found.is_rayleigh()),
                ("allows_resplit", found.allows_resplit()),
                ("minus.holds", found.minus.holds()),
                ("plus.holds", found.plus.holds()),
                ("mixed.holds", found.mixed.holds()),
                ("f_d is Rayleigh", found.to_string().contains("f_d is Rayleigh")),
            ]);
        }
        let base = Pair::new([0.13, -0.2], [0.13, -0.2]);
        if let Ok(found) = Potential::new(system, Midpoint, h, base).check(segments) {
            answers.push(("recovery", found.exists() || found.path_dependence.vanishes()));
        }
        if let Ok(found) = Resplit::new(system, Midpoint, h, [0.13, -0.2]).check(segments) {
            answers.push(("resplit", found.exists()));
        }
        let compared = Comparison::new((system, Midpoint), (claims, Trapezoidal), h, [0.13, -0.2]);
        if let Ok(found) = compared.check(segments) {
            answers.push(("has_same_equations", found.has_same_equations()));
            answers.push(("is_gauge", found.is_gauge()));
        }
    }
    answers
}

/// Ways to poison samples.
fn poisoned() -> Vec<(String, Segments)> {
    let mut samples: Vec<(String, Segments)> = vec![("none".into(), vec![])];
    let resting = |at: [f64; 2]| Pair::new(at, at);
    samples.push((
        "at rest".into(),
        clean().iter().map(|segment| Pair { q1: segment.q0, ..*segment }).collect(),
    ));
    samples.push(("at rest at 0".into(), vec![resting([0.0; 2]); 12]));
    samples.push(("one, many times".into(), vec![clean()[3]; COUNT]));
    for poison in [
        f64::INFINITY,
        f64::NAN,
        f64::NEG_INFINITY,
        f64::MAX,
        1e200,
        -1e160,
        1e150,
        1e80,
        1e30,
        5e-324,
        -1e-310,
        1e-200,
        1e-160,
    ] {
        for end in 0..2 {
            let put = |segment: &mut Pair<f64, 2>| match end {
                0 => segment.q0[0] = poison,
                _ => segment.q1[1] = poison,
            };
            let mut one = clean();
            put(&mut one[7]);
            samples.push((format!("one {poison:e} at end {end}"), one));
            let mut all = clean();
            all.iter_mut().for_each(put);
            samples.push((format!("all {poison:e} at end {end}"), all));
        }
        let scaled = |scale: f64| {
            let all = clean().into_iter();
            all.map(|segment| Pair { q0: segment.q0 * scale, q1: segment.q1 * scale }).collect::<Segments>()
        };
        samples.push((format!("all times {poison:e}"), scaled(poison)));
        let mut one = clean();
        one[5] = scaled(poison)[5];
        samples.push((format!("one times {poison:e}"), one));
    }
    samples
}

/// Names of the answers that are yes.
fn yes(answers: &Answers) -> Vec<&'static str> {
    answers.iter().filter(|(_, yes)| *yes).map(|(name, _)| *name).collect()
}

#[test]
fn clean_samples_tell_right_from_wrong() {
    // Positive control, on both sides: every verdict is reached, no on the one system and yes on the other.
    let right = Right { c: 0.0 };
    let found = answers(&right, &right, &clean(), H, ROUNDING);
    let no: Vec<_> = found.iter().filter(|(name, yes)| !*yes && *name != "is_closed").collect();
    assert!(no.is_empty() && found.len() >= 35, "{no:?}");
    let found = answers(&Wrong, &Wrong, &clean(), H, ROUNDING);
    assert!(yes(&found).is_empty() && found.len() >= 35, "{:?}", yes(&found));
    assert!(
        dissipation(&Right { c: 0.3 }, &tangent_points([-1.0; 2], [1.0; 2], [1.0; 2], 20))
            .unwrap()
            .is_dissipative()
    );
}

#[test]
fn poisoned_samples_get_no_yes() {
    let mut tried = 0;
    // Not by the six kinds of each poison: all kinds are to be among them.
    let every = if cfg!(debug_assertions) { 11 } else { 1 };
    for (name, segments) in poisoned().into_iter().step_by(every) {
        let found = answers(&Wrong, &Wrong, &segments, H, ROUNDING);
        // What the samples cannot show is not asked of them: far out and close to 0 one part of the system is
        // all there is.
        let degenerate = name.starts_with("all");
        let yes = yes(&found);
        assert!(
            yes.is_empty() || (degenerate && !name.contains("NaN") && !name.contains("inf")),
            "{name}: {yes:?}"
        );
        if degenerate && !yes.is_empty() {
            println!("{name}: {yes:?}");
        }
        tried += 1;
        // Whatever holds, holds with finite figures.
        let points: Vec<_> = segments
            .iter()
            .map(|segment| TangentPoint { q: segment.q0, v: segment.q1 - segment.q0 })
            .collect();
        let dissipative = dissipation(&Wrong, &points).is_ok_and(|found| found.is_dissipative());
        assert!(!dissipative, "{name}");
    }
    println!("{tried} poisoned sets of samples");
    assert!(tried > 80 / every);
}

#[test]
fn poisoned_step_sizes_and_tolerances_get_no_yes() {
    for h in [0.0, -0.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 5e-324, -1e-310, f64::MAX, 1e200, 1e-200]
    {
        let found = answers(&Wrong, &Wrong, &clean(), h, ROUNDING);
        assert!(yes(&found).is_empty(), "{h:e}: {:?}", yes(&found));
    }
    for relative in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 1.0, 2.0, 1e300, f64::MAX] {
        let found = answers(&Wrong, &Wrong, &clean(), H, relative);
        assert!(yes(&found).is_empty(), "{relative:e}: {:?}", yes(&found));
        let right = Right { c: 0.0 };
        let found = answers(&right, &right, &clean(), H, relative);
        let claimed: Vec<_> = yes(&found);
        assert!(claimed.is_empty(), "{relative:e}: {claimed:?}");
    }
}

#[test]
fn figures_that_are_not_finite_are_no_verdict() {
    let at = clean()[0];
    for poison in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for other in [0.0, 1e-20, 1.0, f64::MAX, f64::INFINITY, f64::NAN] {
            for (value, scale) in [(poison, other), (other, poison)] {
                let worst = Finding::relative(value, Tolerance { relative: 1e-10, scale }, at);
                assert!(!worst.vanishes(), "{value} {scale}");
                assert!(!Condition { worst, entry: (0, 0) }.holds());
                assert!(!Finding::bounded(value, scale, 1.0, at).vanishes());
            }
            assert!(!Finding::bounded(0.0, 1.0, poison, at).vanishes() || poison == f64::INFINITY);
        }
        assert!(!Finding::relative(0.0, Tolerance { relative: poison, scale: 1.0 }, at).vanishes());
    }
    assert!(Finding::relative(1e-11, Tolerance { relative: 1e-10, scale: 1.0 }, at).vanishes());
    assert!(Finding::bounded(1e-11, 1e-10, 1.0, at).vanishes());
}

/// Steps of one system, judged by another.
fn steps(count: usize) -> (State<f64, 2>, Vec<Result<Step<f64, 2>, StepError>>) {
    let start = State { q: vector![0.3, -0.2], p: vector![0.5, 0.4] };
    (start, Right { c: 0.2 }.by(Midpoint, H).run(start).take(count).collect())
}

#[test]
fn poisoned_runs_are_not_balanced() {
    let rotation = Generator::rotation(0, 1);
    let (start, clean) = steps(10);
    let right = Right { c: 0.2 };
    let balanced = |start: &State<f64, 2>, run: &[Result<Step<f64, 2>, StepError>]| {
        let found = right.by(Midpoint, H).noether().balance(&rotation, start, run.iter().copied());
        found.is_ok_and(|found| found.is_balanced() || found.to_string().contains("within"))
    };
    assert!(balanced(&start, &clean));
    assert!(!balanced(&start, &[]));
    assert!(
        !Wrong
            .by(Midpoint, H)
            .noether()
            .balance(&rotation, &start, clean.iter().copied())
            .unwrap()
            .is_balanced()
    );
    for poison in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e200, 1e300] {
        let mut bad = start;
        bad.p[1] = poison;
        assert!(!balanced(&bad, &clean), "{poison}");
        for place in [0, 4, 9] {
            for part in 0..3 {
                let mut run = clean.clone();
                let step = run[place].as_mut().unwrap();
                match part {
                    0 => step.state.q[0] = poison,
                    1 => step.state.p[0] = poison,
                    _ => step.report.residual = poison,
                }
                assert!(!balanced(&start, &run), "{poison} at {place}, part {part}");
            }
        }
    }
    // Two stretches, the second of which holds a NaN.
    let noether = right.by(Midpoint, H).noether();
    let good = noether.balance(&rotation, &start, clean.iter().copied()).unwrap();
    let mut run = clean.clone();
    run[3].as_mut().unwrap().state.p[0] = f64::NAN;
    let bad = noether.balance(&rotation, &start, run).unwrap();
    for sum in [good.clone() + bad.clone(), bad.clone() + good.clone()] {
        assert!(!sum.is_balanced() && sum.worst_step.0.is_nan(), "{sum}");
    }
}

#[test]
fn a_wrong_rule_is_not_equal_to_rounding() {
    // The trapezoidal rule is none of the exact objects, also from rest, where its errors are 5e-3.
    let exact = Exact::new(&Wrong);
    let velocities = [[0.0, 0.0], [5e-324, 0.0], [1e-200, 0.0], [0.4, -0.3]];
    let steps = [&[0.4, 0.2, 0.1][..], &[0.4, 0.4, -0.4], &[0.4], &[]];
    let all = velocities.iter().flat_map(|v| steps.map(|steps| (v, steps)));
    // Each of them once without optimisation.
    for (&v, steps) in all.step_by(if cfg!(debug_assertions) { 5 } else { 1 }) {
        let report = exact.order(Trapezoidal, vector![0.8, -0.6], SVector::from(v), steps).unwrap();
        assert!(!report.to_string().contains("equal to rounding"), "{v:?} {steps:?}: {report}");
        assert!(steps.is_empty() || report.samples[0].p0 > 1e3 * report.samples[0].floors[3], "{report}");
    }
    for h in [0.0, f64::NAN, f64::INFINITY] {
        assert!(exact.order(Trapezoidal, [0.8, -0.6], [0.1, 0.1], &[0.1, h]).is_err());
    }
    // Positive control: a free mass is its own discrete system.
    let report =
        Exact::unforced(&Right { c: 0.0 }).order(Midpoint, [0.8, -0.6], [0.3, 0.1], &[0.4, 0.2]).unwrap();
    assert!(report.p0.to_string().contains("equal to rounding"), "{report}");
}

#[test]
fn no_exact_force_is_rayleigh_that_is_not() {
    let exact = Exact::new(&Wrong);
    let found = exact.existence([0.3, -0.2], [0.5, 0.1], 0.4).unwrap();
    assert_ne!(found.verdict(), ExistenceVerdict::Holds, "{found}");
    for (q0, q1, h) in [
        ([f64::NAN, 0.0], [0.1, 0.0], 0.4),
        ([0.3, 0.0], [0.1, f64::INFINITY], 0.4),
        ([0.3, 0.0], [0.1, 0.0], f64::NAN),
        ([0.3, 0.0], [0.1, 0.0], f64::INFINITY),
        ([0.3, 0.0], [0.1, 0.0], 0.0),
        ([1e200, 0.0], [0.1, 0.0], 0.4),
        ([0.3, 0.0], [0.1, 0.0], 1e200),
        ([0.3, -0.2], [0.5, 0.1], 1e-200),
        ([0.3, -0.2], [0.5, 0.1], 5e-324),
        ([1e-200, 0.0], [1e-200, 3e-200], 0.4),
    ] {
        let found = exact.existence(q0, q1, h);
        assert!(found.is_err() || found.unwrap().verdict() != ExistenceVerdict::Holds, "{q0:?} {q1:?} {h:e}");
    }
    assert!(matches!(exact.existence([0.1, 0.0], [0.2, 0.0], 0.0), Err(ExactError::StepSize { .. })));
}

#[test]
fn no_poisoned_step_is_on_the_branch() {
    let state = State { q: vector![0.3, -0.2], p: vector![0.5, 0.4] };
    let step = Wrong.by(Midpoint, H).step(&state).unwrap();
    let on = |state: &State<f64, 2>, step: &Step<f64, 2>, h: f64| {
        Wrong.by(Midpoint, h).certificate(state, step).is_ok_and(|found| {
            found.on_the_branch_of_the_flow && found.condition.is_finite() && found.correction < 1e-3
        })
    };
    assert!(on(&state, &step, H));
    for poison in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e200] {
        let (mut bad_step, mut bad_state) = (step, state);
        bad_step.velocity[0] = poison;
        bad_state.q[1] = poison;
        assert!(
            !on(&state, &bad_step, H) && !on(&bad_state, &step, H) && !on(&state, &step, poison),
            "{poison}"
        );
        let mut bad_state = state;
        bad_state.p[1] = poison;
        assert!(!on(&bad_state, &step, H), "{poison}");
    }
}
