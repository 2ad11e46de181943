//! No step is taken that does not solve its equations: a part of the study of the example `verdicts`, and
//! what it can see.

use dalembert::nalgebra::SVector;
use dalembert::rules::StageHistory;
use dalembert::step::{Memory, Step};
use dalembert::{Discretise, Fitted, Gauss, Midpoint, State, Trapezoidal};
use dalembert_tests::hard::TwoPendulums;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

#[path = "../../../examples/verdicts/study/mod.rs"]
#[allow(dead_code, reason = "the example steps all systems of the study")]
mod study;

use study::equations::{OneStage, fitted, gauss, one_stage};
use study::steps::{Job, Tally, study, study_all, study_composed, study_fitted};
use study::systems::{
    Barrier, DoublePendulum, Exponential, Kepler, KeplerDrag, LennardJones, Morse, Pendulum, Polar,
    Saturating, Studied, TodaByDual, Units,
};
use study::tableau::Tableau;

const ONE: Units = Units { action: 1.0, length: 1.0, speed: 1.0, rate: 1.0 };

fn state<const N: usize>(q: [f64; N], p: [f64; N]) -> State<f64, N> {
    State { q: q.into(), p: p.into() }
}

#[test]
fn no_step_of_any_rule_violates_its_equations() {
    const JOBS: [Job; 6] = [
        study::<Pendulum, 1, 5>,
        study::<LennardJones, 1, 1>,
        study::<Exponential, 1, 4>,
        study::<KeplerDrag, 3, 2>,
        study_composed::<LennardJones, 1>,
        study_fitted::<Kepler, 2>,
    ];
    let draws = if cfg!(debug_assertions) { 20 } else { 500 };
    let rows = study_all(&JOBS, draws, 2024);
    let examples: Vec<&String> = rows.iter().flat_map(|row| &row.examples).collect();
    assert!(examples.is_empty(), "{examples:#?}");
    let sum = rows.iter().flat_map(|row| row.tallies).fold(Tally::NONE, Tally::plus);
    assert!(
        sum.asked > 60 * u64::from(draws) && sum.taken > sum.asked * 3 / 5 && sum.beyond < sum.taken / 100,
        "{sum:?}"
    );
}

/// The control: a step that is off by some 10⁻¹² of its velocity is seen, by the equations of each rule.
#[test]
fn a_step_that_is_off_is_seen() {
    let system = Pendulum::new(1.3, 0.2, ONE);
    let start = state([0.7], [0.4]);
    let off = |v: SVector<f64, 1>| v * (1.0 + 1e-12);
    let mut step = system.by(Midpoint, 0.3).step(&start).unwrap();
    assert!(!one_stage(OneStage::Midpoint, &system, &start, 0.3, &step).is_violation());
    // Another rule's equations are not those.
    assert!(one_stage(OneStage::Trapezoidal, &system, &start, 0.3, &step).is_violation());
    step.velocity = off(step.velocity);
    assert!(one_stage(OneStage::Midpoint, &system, &start, 0.3, &step).is_violation());
    let mut step = system.by(Trapezoidal, 0.3).step(&start).unwrap();
    assert!(!one_stage(OneStage::Trapezoidal, &system, &start, 0.3, &step).is_violation());
    step.state.p *= 1.0 + 1e-12;
    assert!(one_stage(OneStage::Trapezoidal, &system, &start, 0.3, &step).is_violation());
    let mut memory = StageHistory::<f64, 1, 3>::default();
    let step = Memory::<_, Gauss<3>, 1>::advance(&mut memory, &system, &start, 0.3).unwrap();
    let (tableau, mut v) = (Tableau::new(3), memory.velocities());
    assert!(!gauss(&tableau, &system, &start, 0.3, &v, &step.state).is_violation());
    v[1] = off(v[1]);
    assert!(gauss(&tableau, &system, &start, 0.3, &v, &step.state).is_violation());
    // A number that is none is not judged, and that is counted.
    v[1][0] = f64::NAN;
    assert!(gauss(&tableau, &system, &start, 0.3, &v, &step.state).is_beyond);
}

/// Where ∂²L/∂v² goes to 0, entries of the matrix that hardly change change what it corrects: p of 2.15,
/// where none exceeds 1, passed for noise.
#[test]
fn near_a_singular_mass_a_curve_is_no_noise() {
    let near = [(2.9574338188089047, 0.01105076913078537, -2.450789377612768, 0.9992754278196713)];
    let drawn = (0..200).map(|k| {
        let share = |by: f64| (0.5 + by * f64::from(k)).fract();
        (1.0 + 4.0 * share(0.618), 0.02 * share(0.414), 6.0 * share(0.732) - 3.0, 1.9 * share(0.236) - 0.95)
    });
    let mut taken = 0;
    for (a, c, q, p) in near.into_iter().chain(drawn) {
        let system = Saturating::new(a, c, ONE);
        let start = state([q], [p]);
        let h = 1.7243659365410346;
        let mut memory = StageHistory::<f64, 1, 5>::default();
        let Ok(step) = Memory::<_, Gauss<5>, 1>::advance(&mut memory, &system, &start, h) else { continue };
        let judged = gauss(&Tableau::new(5), &system, &start, h, &memory.velocities(), &step.state);
        assert!(!judged.is_violation(), "{a} {c} {q} {p}: {judged:?} {step:?}");
        taken += 1;
    }
    assert!(taken > 20, "{taken}");
}

/// Far out multiples of q round by more than the equation has terms: by dual numbers they passed for terms,
/// beside which a residual of 10²⁶, with p between 10⁹ and 10²⁵, was rounding.
#[test]
fn far_out_the_rounding_of_coordinates_is_no_term() {
    let units = Units {
        action: 0.017983726916010193,
        length: 0.0038830669471445227,
        speed: 1843071938199.8918,
        rate: 2.1068450268615512e-15,
    };
    let system = TodaByDual::new(0.17838036438629892, 0.02006520845869391, units);
    let start = state(
        [746.9887333697836, 251.24404554342945, -417.11995250733634],
        [6297961633.696036, 382939359797.1918, -1472049622.3902483],
    );
    let h = 5228048093648828.0;
    let mut memory = StageHistory::<f64, 3, 2>::default();
    let step = Memory::<_, Gauss<2>, 3>::advance(&mut memory, &system, &start, h).unwrap();
    let judged = gauss(&Tableau::new(2), &system, &start, h, &memory.velocities(), &step.state);
    assert!(!judged.is_violation() && step.state.p.amax() < 1e13, "{judged:?} {step:?}");
}

/// In units where h² overflows, everything was near beside what is infinite, and any residual noise: p went
/// from 1 to 224 units. Multiplied out, the step is that in units of 1.
#[test]
fn where_the_square_of_the_step_overflows_no_residual_is_noise() {
    let units = Units {
        action: 2.0_f64.powi(-62),
        length: 2.0_f64.powi(-333),
        speed: 2.0_f64.powi(181),
        rate: 2.0_f64.powi(-514),
    };
    let [one, scaled] = [ONE, units].map(|units| Barrier::new(0.6946535334868458, 0.0, units));
    let [h, unit_of_p] = [units.speed / units.length, units.action * units.speed];
    assert!((0.437 * h).powi(2).is_infinite());
    let by = |system: &Barrier, q: f64, p: f64, h: f64| {
        let mut memory = StageHistory::<f64, 1, 8>::default();
        Memory::<_, Gauss<8>, 1>::advance(&mut memory, system, &state([q], [p]), h)
    };
    let mut compared = 0;
    for k in 0..40 {
        let (q, p) = (0.9 + 0.02 * f64::from(k), 1.09 - 0.05 * f64::from(k));
        let (Ok(expected), Ok(step)) =
            (by(&one, q, p, 0.437), by(&scaled, q / units.length, p * unit_of_p, 0.437 * h))
        else {
            continue;
        };
        let off = (step.state.p[0] / unit_of_p - expected.state.p[0]).abs();
        assert!(off < 1e-9, "{q} {p}: {step:?}, {expected:?}");
        compared += 1;
    }
    assert!(compared > 20, "{compared}");
}

/// The floor of the guess, next to the wall of 10⁶⁰, was taken for that of the root: q1 = 8.35e6, with a last
/// correction of 1.5e7.
#[test]
fn a_wall_at_the_guess_does_not_lower_the_demands() {
    let system = LennardJones::new(1.0, 0.0, ONE);
    let (start, h) = (state([0.891_896_227_692_668_9], [-2.987_401_675_911_929_3]), 0.550_108_962_073_416_6);
    let mut memory = StageHistory::<f64, 1, 1>::default();
    if let Ok(step) = Memory::<_, Gauss<1>, 1>::advance(&mut memory, &system, &start, h) {
        let judged = gauss(&Tableau::new(1), &system, &start, h, &memory.velocities(), &step.state);
        assert!(!judged.is_violation() && step.state.q.amax() < 10.0, "{step:?} {judged:?}");
    }
}

/// After some thousand turns the ends of a step are known to the last places of the angles alone. Where what
/// their errors do cancels if both ends are moved together, no move of q shows it: one step of 80 000 by the
/// trapezoidal rule was refused as `LostPrecision`.
#[test]
fn far_from_zero_steps_are_taken_and_solve_their_equations() {
    let refused = [
        (0.05, [5508.315763157829, 8474.05867093307], [2.7712947546995834, -0.6070401968951322]),
        (0.02, [19922.654511939854, 27814.280558479204], [0.596438567851395, 3.0605127649630886]),
    ];
    for (h, q, p) in refused {
        let step = TwoPendulums { r: 0.0 }.by(Trapezoidal, h).step(&state(q, p));
        let report = step.unwrap().report;
        assert!(report.residual <= 4.0 * report.floor && report.floor < 1e-11, "{report:?}");
    }
    let mut random = StdRng::seed_from_u64(9);
    let system = DoublePendulum::new(1.0, 0.0, ONE);
    let mut worst = 0.0_f64;
    for _ in 0..if cfg!(debug_assertions) { 5_000 } else { 20_000 } {
        let far = 10.0_f64.powf(random.random_range(3.0..7.0));
        let q = [0; 2].map(|_| random.random_range(-far..far));
        let start = State::from_velocity(&system, q, [0; 2].map(|_| random.random_range(-4.0..4.0))).unwrap();
        let h = random.random_range(0.01..0.1);
        let step = system.by(Trapezoidal, h).step(&start).unwrap();
        let judged = one_stage(OneStage::Trapezoidal, &system, &start, h, &step);
        assert!(!judged.is_violation(), "{start:?} {h} {step:?} {judged:?}");
        worst = worst.max(judged.ratio);
        // The control: another end, off by more than the places of q explain.
        let velocity = step.velocity + SVector::repeat(1e3 * f64::EPSILON * far / h);
        let end = State { q: start.q + velocity * h, ..step.state };
        let off = Step { velocity, state: end, ..step };
        assert!(one_stage(OneStage::Trapezoidal, &system, &start, h, &off).is_violation(), "{start:?}");
    }
    assert!(worst > 0.1, "{worst}");
}

/// The momentum M v̄ was taken for a term of the equation, in which damping backwards in time leaves 10⁻⁴⁰ of
/// it: v̄ = −4.8e15.
#[test]
fn rounding_is_that_of_the_mass_in_the_equation() {
    let system = LennardJones::new(0.960_253_461_252_024_7, 6.307_264_923_699_201, ONE);
    let start = state([2.382_968_107_756_109], [17.497_777_886_413_957]);
    for h in [-14.244_555_914_221_378, -1e-2] {
        let step = system.by(Fitted, h).step(&start);
        assert!(step.is_ok() || h < -10.0, "{step:?}");
        if let Ok(step) = step {
            let judged = fitted(false, &system, &start, h, &step);
            assert!(!judged.is_violation() && !judged.is_beyond, "{step:?} {judged:?}");
        }
    }
}

/// Polar coordinates: in every other iteration the residual stays, and one that takes off much says nothing
/// of the next.
#[test]
fn an_iteration_that_takes_off_much_is_not_the_last() {
    let system = Polar::new(0.217_066_546_343_400_7, 0.0, ONE);
    let start = state([666.729_536_924_603_5, 431.728_048_985_053_4], [0.0, -109_811.583_149_229_85]);
    let h = 0.007_380_510_379_919_571;
    let mut memory = StageHistory::<f64, 2, 7>::default();
    let step = Memory::<_, Gauss<7>, 2>::advance(&mut memory, &system, &start, h).unwrap();
    let judged = gauss(&Tableau::new(7), &system, &start, h, &memory.velocities(), &step.state);
    assert!(!judged.is_violation() && !judged.is_beyond, "{step:?} {judged:?}");
}

/// A measured rounding that overflows explained any residual: p1 = 2.8e307.
#[test]
fn rounding_that_overflows_explains_no_residual() {
    let system = Exponential::new(3.013_205_946_524_166_7, 0.0, ONE);
    let (start, h) = (state([8.978_349_375_816_547], [-23.327_069_555_445_46]), 20.794_962_731_357_785);
    for (rule, step) in [
        (OneStage::Midpoint, system.by(Midpoint, h).step(&start)),
        (OneStage::Trapezoidal, system.by(Trapezoidal, h).step(&start)),
    ] {
        if let Ok(step) = step {
            assert!(step.state.p.amax() < 1e6, "{step:?}");
            let judged = one_stage(rule, &system, &start, h, &step);
            assert!(!judged.is_violation() && !judged.is_beyond, "{step:?} {judged:?}");
        }
    }
    // The control: a shorter step is taken.
    assert!(system.by(Midpoint, 0.1).step(&start).is_ok());
}

/// The rounding of a velocity was taken to be that of the largest of all stages: a planet that passes close
/// to the sun within the step, in polar coordinates, turns there 10³ times as fast as at the others, and that
/// explained residuals of 98 bounds.
#[test]
fn a_stage_is_not_rounded_like_the_fastest_of_all() {
    let system = Polar::new(0.104_987_439_222_101_35, 0.027_496_817_774_202_36, ONE);
    let start = state(
        [0.238_635_845_124_582_8, 0.491_436_495_476_913_76],
        [-0.254_783_132_313_496_6, 0.009_667_065_044_785_622],
    );
    let stepped = |h: f64| {
        let mut memory = StageHistory::<f64, 2, 7>::default();
        let step = Memory::<_, Gauss<7>, 2>::advance(&mut memory, &system, &start, h).ok()?;
        Some(gauss(&Tableau::new(7), &system, &start, h, &memory.velocities(), &step.state))
    };
    let violates = stepped(4.727_446_111_859_283).is_some_and(|judged| judged.is_violation());
    assert!(!violates);
    // The control: a shorter step is taken.
    assert!(!stepped(0.01).unwrap().is_violation());
}

/// A potential so flat that a force underflows where it is multiplied by the action before the length: the
/// reference, which multiplies the other way round, allows for it, and for no more.
#[test]
fn what_underflows_on_the_way_is_allowed_for() {
    let units = Units { action: 2.67e-86, length: 4.05e111, speed: 1.96e50, rate: 2.07e61 };
    let system = Morse::new(0.147, 2.5, units);
    let (start, h) = (state([1.47e-109], [0.0]), -1.55e-64);
    let mut memory = StageHistory::<f64, 1, 3>::default();
    let step = Memory::<_, Gauss<3>, 1>::advance(&mut memory, &system, &start, h).unwrap();
    let mut v = memory.velocities();
    assert!(!gauss(&Tableau::new(3), &system, &start, h, &v, &step.state).is_violation());
    v[1][0] = 1e-170;
    assert!(gauss(&Tableau::new(3), &system, &start, h, &v, &step.state).is_violation());
}

/// From the velocity of the state Newton's method leads away from the wall, or into it; part by part in h it
/// is led to the root. What it finds is on the branch of the flow.
#[test]
fn a_root_that_the_state_alone_misses_is_led_to() {
    let system = LennardJones::new(0.5, 0.0, ONE);
    for (q, p, h) in [(0.9, -2.5, 2.0), (0.9, 0.5, 2.0), (1.0, -4.0, 0.5), (1.0, -2.0, 1.0)] {
        let (start, by) = (state([q], [p]), system.by(Midpoint, h));
        // The control: the velocity as a guess is left to itself.
        assert!(by.near(&start.velocity(&system).unwrap()).step(&start).is_err(), "{q} {p} {h}");
        let step = by.step(&start).unwrap();
        assert!(!one_stage(OneStage::Midpoint, &system, &start, h, &step).is_violation(), "{step:?}");
        assert!(by.certificate(&start, &step).unwrap().on_the_branch_of_the_flow, "{step:?}");
    }
    for (q, p, h) in [(0.9, -5.5, 0.2), (0.9, -4.0, 1.0), (0.9, 0.0, 2.0)] {
        let (start, by) = (state([q], [p]), system.by(Gauss::<2>, h));
        assert!(by.near(&start.velocity(&system).unwrap()).step(&start).is_err(), "{q} {p} {h}");
        let mut memory = StageHistory::<f64, 1, 2>::default();
        let step = Memory::<_, Gauss<2>, 1>::advance(&mut memory, &system, &start, h).unwrap();
        let judged = gauss(&Tableau::new(2), &system, &start, h, &memory.velocities(), &step.state);
        assert!(!judged.is_violation(), "{step:?}");
        assert!(by.certificate(&start, &step).unwrap().on_the_branch_of_the_flow, "{step:?}");
    }
}
