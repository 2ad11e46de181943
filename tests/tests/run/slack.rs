//! Stages solved no further than an error asks for: how far that moves the end, and what it saves.

use dalembert::nalgebra::SVector;
use dalembert::system::ForcedLagrangian;
use dalembert::{Discretise, Gauss, State, Trapezoidal, rayleigh_system};
use dalembert_tests::systems::DoublePendulum;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// Two coordinates coupled by a mass that depends on both, in a potential that is not harmonic, with friction
/// that depends on them as well.
#[rayleigh_system(rule = [trapezoidal, gauss])]
impl Coupled {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let mass = 1.0 + self.a * q[0].cos();
        0.5 * (mass * v[0] * v[0] + v[1] * v[1]) + self.b * v[0] * v[1] * (q[0] - q[1]).sin()
            - 0.5 * self.k * (q[0] * q[0] + q[1] * q[1])
            - 0.25 * q[1] * q[1] * q[1] * q[1]
    }
    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * self.r * (1.0 + q[1] * q[1]) * v[0] * v[0]
    }
}

#[derive(Clone, Copy)]
struct Coupled {
    a: f64,
    b: f64,
    k: f64,
    r: f64,
}

/// What is compared at an end: q and, weighed by the changes over a step, p.
fn far<const N: usize>(a: &State<f64, N>, b: &State<f64, N>, weight: f64) -> f64 {
    (a.q - b.q).amax().max((a.p - b.p).amax() * weight)
}

/// A run to rounding, and how its end is moved by stages solved for an error; both in units of a hundredth of
/// that error, by an error at the start of this size for the growth.
struct Moved {
    by_slack: f64,
    by_start: f64,
    sweeps: [u64; 2],
}

fn moved<L, const N: usize, const S: usize>(
    system: &L,
    start: State<f64, N>,
    h: f64,
    steps: usize,
    [error, asked]: [f64; 2],
) -> Option<Moved>
where
    L: ForcedLagrangian<N, Scalar = f64>,
{
    let method = system.by(Gauss::<S>, h);
    let (mut sweeps, mut weight, mut state) = ([0, 0], [0.0_f64, 0.0], start);
    for step in method.run(start).take(steps) {
        let next = step.ok()?;
        sweeps[0] += u64::from(next.report.iterations);
        weight[0] = weight[0].max((next.state.q - state.q).amax());
        weight[1] = weight[1].max((next.state.p - state.p).amax());
        state = next.state;
    }
    let weight = weight[0] / weight[1];
    let mut run = method.run(start).solved_for(asked, h * steps as f64);
    for step in run.by_ref().take(steps) {
        sweeps[1] += u64::from(step.ok()?.report.iterations);
    }
    let share = error / 100.0;
    let by_slack = far(run.state(), &state, weight) / share;
    // Growth: of errors in every direction, from the start and from the middle.
    let mut by_start = 1.0_f64;
    let middle = method.run(start).nth(steps / 2)?.ok()?.state;
    for (from, steps, of) in [(start, steps, state), (middle, steps - steps / 2 - 1, state)] {
        for direction in 0..2 * N {
            let (mut beside, size) = (from, 1e-7);
            if direction < N {
                beside.q[direction] += size;
            } else {
                beside.p[direction - N] += size / weight;
            }
            let end = method.run(beside).nth(steps - 1)?.ok()?.state;
            by_start = by_start.max(far(&end, &of, weight) / size);
        }
    }
    Some(Moved { by_slack, by_start, sweeps })
}

/// A random motion by a method of S stages, with an error from 1e-9 to 10^`largest`, solved for as if it were
/// larger by `factor`.
fn at_random<const S: usize>(random: &mut StdRng, largest: f64, factor: f64) -> Option<Moved> {
    let mut draw = |from: f64, to: f64| random.random_range(from..to);
    let error = 10_f64.powf(draw(-9.0, largest));
    let (time, h) = (draw(4.0, 12.0), draw(0.05, 0.25));
    let (steps, errors) = ((time / h) as usize, [error, factor * error]);
    let q = SVector::from([draw(-1.2, 1.2), draw(-1.2, 1.2)]);
    let v = SVector::from([draw(-1.0, 1.0), draw(-1.0, 1.0)]);
    if draw(0.0, 1.0) < 0.5 {
        let system = DoublePendulum::EXAMPLE;
        let start = State::from_velocity(&system, q * 0.5, v).ok()?;
        moved::<_, 2, S>(&system, start, h, steps, errors)
    } else {
        let system = Coupled { a: draw(0.0, 0.6), b: draw(0.0, 0.4), k: draw(0.5, 4.0), r: draw(0.0, 0.4) };
        let start = State::from_velocity(&system, q, v).ok()?;
        moved::<_, 2, S>(&system, start, h, steps, errors)
    }
}

#[test]
fn the_end_is_moved_by_a_hundredth_of_the_error_at_most() {
    let mut random = StdRng::seed_from_u64(20);
    let (mut tried, mut sweeps) = (0, [0; 2]);
    let cases = if cfg!(debug_assertions) { 9 } else { 30 };
    for case in 0..cases {
        let moved = match case % 3 {
            0 => at_random::<4>(&mut random, -3.0, 1.0),
            1 => at_random::<5>(&mut random, -3.0, 1.0),
            _ => at_random::<8>(&mut random, -3.0, 1.0),
        };
        let Some(moved) = moved else { continue };
        assert!(moved.by_slack <= moved.by_start, "{case}: {} {}", moved.by_slack, moved.by_start);
        tried += 1;
        sweeps = [sweeps[0] + moved.sweeps[0], sweeps[1] + moved.sweeps[1]];
    }
    assert!(6 * tried >= 5 * cases, "{tried}");
    // It saves what it is for.
    assert!(sweeps[1] * 4 < sweeps[0] * 3, "{sweeps:?}");
    // Positive control: solved for a thousand times the error, most ends are moved by more.
    let mut random = StdRng::seed_from_u64(20);
    let caught = (0..cases / 2).filter_map(|_| at_random::<5>(&mut random, -6.0, 1000.0));
    let caught = caught.filter(|moved| moved.by_slack > moved.by_start).count();
    assert!(4 * caught >= cases, "{caught}");
}

#[test]
fn steps_after_the_time_asked_for_are_solved_to_rounding() {
    let system = DoublePendulum::EXAMPLE;
    let start = State::from_velocity(&system, [0.8, -0.4], [0.0, 0.5]).unwrap();
    let method = system.by(Gauss::<6>, 0.2);
    let mut run = method.run(start).solved_for(1e-4, 4.0);
    let residuals: Vec<f64> = run.by_ref().take(40).map(|step| step.unwrap().report.residual).collect();
    // The first is no guess's; the last are none of the time.
    let (first, loose, later) = (residuals[0], &residuals[1..20], &residuals[20..]);
    assert!(first < 1e-13 && later.iter().all(|&residual| residual < 1e-13), "{first:e} {later:?}");
    assert!(loose.iter().all(|&residual| residual < 1e-4), "{loose:?}");
    assert!(loose.iter().filter(|&&residual| residual > 1e-12).count() > 15, "{loose:?}");
    // An error below rounding changes nothing, bit by bit.
    let ends = |run: &mut dyn Iterator<Item = Result<dalembert::step::Step<f64, 2>, _>>| run.nth(39).unwrap();
    assert_eq!(ends(&mut method.run(start).solved_for(1e-16, 8.0)), ends(&mut method.run(start)));
    // A checkpoint ends it, for both runs.
    let mut run = method.run(start).solved_for(1e-4, 8.0);
    assert!(run.by_ref().take(5).all(|step| step.is_ok()));
    run.checkpoint();
    assert!(run.take(10).all(|step| step.unwrap().report.residual < 1e-13));
}

#[test]
fn a_choice_solves_as_far_as_its_error_needs_and_says_so() {
    let system = DoublePendulum::EXAMPLE;
    let start = State::from_velocity(&system, [0.8, -0.4], [0.0, 0.5]).unwrap();
    let choice = system.to_error(1e-6).until(20.0).choice(&start).unwrap();
    let slack = choice.slack().unwrap();
    assert!((slack - 1e-8 / choice.steps() as f64).abs() < 1e-12 * slack);
    assert!(choice.to_string().contains(&format!("stages solved to {slack:.1e} a step")), "{choice}");
    let sweeps = |run: &mut dyn Iterator<Item = Result<dalembert::step::Step<f64, 2>, _>>| -> u32 {
        run.map(|step| step.unwrap().report.iterations).sum()
    };
    let loose = sweeps(&mut choice.trajectory());
    // Every Gauss method that a choice offers.
    let steps = choice.steps() as usize;
    let solved = match choice.method() {
        dalembert::tolerance::Method::Gauss4 => {
            sweeps(&mut system.by(Gauss::<4>, choice.step_size()).run(start).take(steps))
        }
        _ => sweeps(&mut system.by(Gauss::<8>, choice.step_size()).run(start).take(steps)),
    };
    assert!(loose * 4 < solved * 3, "{loose} {solved}");
    // Control: what is solved to rounding has no slack to speak of.
    let rule = system.to_error(1e-2).among(Trapezoidal).until(20.0).choice(&start).unwrap();
    assert!(rule.slack().is_none() && !rule.to_string().contains("stages"), "{rule}");
}
