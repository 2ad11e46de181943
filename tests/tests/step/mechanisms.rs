//! Mechanisms of points, rods and bars: each step beside a second program in twice the precision. The study
//! `mechanisms` takes more of them.

use dalembert::{Discretise, Midpoint, State, StepError};
use dalembert_tests::mechanism;
use dalembert_tests::mechanisms::{
    Curve, Drawn, JudgedSystem, Kind, MOST, MOST_OFF, Mechanism, Outcome, Problem, Rule, Values, off, run,
    start,
};

mechanism! {
    /// A four-bar of two points.
    FourBar: 4 coordinates, 2 of a body in 2, 3 joints, 1 forces,
    square [(0: 0 1)] length [] ground [(1: 0)(2: 1)] plane [] hinge [] pin []
    spring [(0: 0 1)] tether [] twist []
}
mechanism! {
    /// A loop of three bars.
    Bars: 9 coordinates, 3 of a body in 2, 8 joints, 2 forces,
    square [] length [] ground [] plane [] hinge [(0 1: 0 1)(2 3: 1 2)] pin [(4 5: 0)(6 7: 2)]
    spring [] tether [(0: 1)] twist [(1: 0 1)]
}
mechanism! {
    /// A chain in space.
    Chain: 9 coordinates, 3 of a body in 3, 3 joints, 1 forces,
    square [(0: 0 1)] length [(1: 1 2)] ground [(2: 0)] plane [] hinge [] pin []
    spring [(0: 0 2)] tether [] twist []
}
mechanism! {
    /// A braced square with one rod too many.
    Net: 8 coordinates, 2 of a body in 2, 7 joints, 2 forces,
    square [(0: 0 1)(1: 1 2)(2: 0 3)(3: 1 3)(4: 2 3)] length [(5: 0 2)] ground [(6: 0)] plane [] hinge [] pin []
    spring [(0: 0 2)] tether [(1: 3)] twist []
}
mechanism! {
    /// Two triangles on a rod, side by side.
    Strip: 8 coordinates, 2 of a body in 2, 6 joints, 1 forces,
    square [(0: 0 1)(1: 0 2)(2: 1 3)] length [(3: 1 2)(4: 2 3)] ground [(5: 0)] plane [] hinge [] pin []
    spring [] tether [(0: 3)] twist []
}
mechanism! {
    /// A triangle on a rod.
    Triangle: 6 coordinates, 2 of a body in 2, 4 joints, 0 forces,
    square [(0: 0 1)(1: 1 2)(2: 2 0)] length [] ground [(3: 0)] plane [] hinge [] pin []
    spring [] tether [] twist []
}

/// The first run of this kind from the seed on.
fn drawn<L: Mechanism<N, M>, const N: usize, const M: usize>(kind: Kind, seed: u64) -> Drawn {
    let all = (seed..).map(|seed| Drawn::of(&L::SHAPE, N, seed));
    let mut drawn = all.filter(|drawn| drawn.kind == kind && !drawn.is_composed);
    drawn.next().expect("seeds do not end")
}

/// Runs of these kinds, of a few steps.
fn hold<L: JudgedSystem<N, M>, const N: usize, const M: usize>(kinds: &[Kind], seed: u64) {
    for &kind in kinds {
        let mut drawn = drawn::<L, N, M>(kind, seed);
        drawn.steps = if cfg!(debug_assertions) { 6 } else { 60 };
        let outcome = run::<L, N, M>(&drawn);
        assert!(outcome.is_sound(), "{} {kind:?}: {outcome:?}", L::SHAPE.name);
        assert!(outcome.no_start.is_none() && outcome.judged > 0, "{} {kind:?}: {outcome:?}", L::SHAPE.name);
    }
}

#[test]
fn runs_step_as_a_second_program_does() {
    hold::<FourBar, 4, 3>(&[Kind::Plain, Kind::Units, Kind::Light, Kind::HeavilyDamped], 1);
    // At a dead point, from rest: what is far from the root was once taken for rounding.
    hold::<FourBar, 4, 3>(&[Kind::Stretched], 204);
    hold::<Bars, 9, 8>(&[Kind::Plain, Kind::Light, Kind::HeavilyDamped, Kind::ToRest], 2);
    hold::<Chain, 9, 3>(&[Kind::Plain, Kind::Units, Kind::Light, Kind::Stretched], 3);
    hold::<Net, 8, 7>(&[Kind::Plain, Kind::Units, Kind::Light, Kind::HeavilyDamped], 4);
    // Flat to 10⁻⁵: in a hundredth of that the lengths as rounded leave open how flat.
    hold::<Net, 8, 7>(&[Kind::Stretched], 26);
    // Where five of six rods hold on two branches, and the sixth on one.
    hold::<Net, 8, 7>(&[Kind::Stretched], 117_000_037);
    hold::<Triangle, 6, 4>(&[Kind::Plain, Kind::Light, Kind::Stretched, Kind::ToRest], 5);
}

/// Of triangles that are flat to 10⁻⁷, 10⁻⁸ is left of a gradient beside the others, and nothing of its
/// square, which is all that the Schur complement has of it.
#[test]
fn flat_triangles_keep_their_digits() {
    let (mut flat, mut seed) = (0, 0);
    while flat < 12 {
        let mut drawn = drawn::<Strip, 8, 6>(Kind::Stretched, seed);
        seed += 14;
        let sides = |of: [usize; 3]| of.map(|joint| drawn.values.joints[joint].length);
        let height = [[0, 1, 3], [2, 3, 4]].map(|of| height(sides(of))).into_iter().fold(1.0, f64::min);
        if height >= 1e-5 {
            continue;
        }
        flat += 1;
        drawn.steps = if cfg!(debug_assertions) { 6 } else { 60 };
        let outcome = run::<Strip, 8, 6>(&drawn);
        // To which of two roots as near a step of such a triangle leads is not known.
        let sound = Outcome { followed: [0; 2], ..outcome.clone() };
        assert!(sound.is_sound() && sound.no_start.is_none(), "{seed} {height:e}: {outcome:?}");
        // Steps that lost their digits were off by hundreds of bounds.
        assert!(outcome.judged > 0 && outcome.ratios.iter().all(|ratio| *ratio < 6.0), "{seed}: {outcome:?}");
    }
}

/// The height of a triangle over its longest side, beside that side.
fn height(sides: [f64; 3]) -> f64 {
    let (sum, longest) = (sides.iter().sum::<f64>(), sides.into_iter().fold(0.0, f64::max));
    let square = sides.iter().fold(sum, |product, side| product * (sum - 2.0 * side));
    0.5 * square.max(0.0).sqrt() / (longest * longest)
}

/// A step of the mechanism with these values, and the problem that it has to solve.
fn step<L: JudgedSystem<N, M>, const N: usize, const M: usize>(
    drawn: &Drawn,
) -> Result<(State<f64, N>, dalembert::step::Step<f64, N>), StepError> {
    let system = L::of(&drawn.values);
    let state = start::<L, N, M>(&system, drawn)?;
    Ok((state, system.by(Midpoint, drawn.h).step(&state)?))
}

fn problem<'a, const N: usize>(
    shape: &'a dalembert_tests::mechanisms::Shape,
    drawn: &'a Drawn,
    state: &'a State<f64, N>,
) -> Problem<'a> {
    let (q, p) = (state.q.as_slice(), state.p.as_slice());
    Problem { shape, values: &drawn.values, rule: Rule::Midpoint, q, p, h: drawn.h }
}

/// Positive controls: what is broken is found.
#[test]
fn a_step_that_is_broken_is_found() -> Result<(), StepError> {
    let shape = Bars::SHAPE;
    let mut drawn = drawn::<Bars, 9, 8>(Kind::Plain, 7);
    // Without forces, so that M⁻¹p is the step without reactions.
    drawn.values.gravity = [0.0; 3];
    drawn.values.forces.iter_mut().for_each(|force| force.numbers = [0.0; 3]);
    for friction in [&mut drawn.values.drag, &mut drawn.values.cubic] {
        friction.fill(0.0);
    }
    (drawn.v, drawn.h) = ((0..9).map(|i| 0.3 + 0.1 * f64::from(i)).collect(), 0.02);
    let (state, step) = step::<Bars, 9, 8>(&drawn)?;
    let problem = problem(&shape, &drawn, &state);
    let (v, p1) = (step.velocity, step.state.p);
    let judge = |v: &[f64], p1: &[f64]| {
        let judged = problem.judged(v, p1);
        (judged.velocity.unwrap_or(f64::INFINITY), judged.momentum)
    };
    let (velocity, momentum) = judge(v.as_slice(), p1.as_slice());
    assert!(velocity <= MOST && momentum <= MOST, "{velocity} {momentum}");
    let values = (&shape, &drawn.values);
    assert!(off(values, step.state.q.as_slice()) <= MOST_OFF);

    // v̄ and p1 off by 10⁻⁹, in one coordinate.
    let (mut moved, mut pushed) = (v, p1);
    moved[4] *= 1.0 + 1e-9;
    pushed[4] *= 1.0 + 1e-9;
    assert!(judge(moved.as_slice(), p1.as_slice()).0 > MOST);
    assert!(judge(v.as_slice(), pushed.as_slice()).1 > MOST);
    // q1 off by 10⁻⁹.
    assert!(off(values, (step.state.q + (moved - v) * drawn.h).as_slice()) > MOST_OFF);
    // Reactions of the other sign.
    let free =
        state.p.zip_map(&dalembert::nalgebra::SVector::from_fn(|i, _| drawn.values.mass[i]), |p, m| p / m);
    assert!(judge((free * 2.0 - v).as_slice(), p1.as_slice()).0 > MOST);
    // A momentum that is not projected: that of the state.
    assert!(judge(v.as_slice(), state.p.as_slice()).1 > MOST);
    // A length that differs by 10⁻⁹.
    let mut other = drawn.clone();
    other.values.joints[4].along[0] *= 1.0 + 1e-9;
    assert!(off((&shape, &other.values), step.state.q.as_slice()) > MOST_OFF);
    Ok(())
}

/// Long steps have no root on the curve from h = 0: those are refused, and a tenth of them is taken.
#[test]
fn a_step_is_refused_where_the_curve_of_roots_ends() {
    let (mut ends, mut taken) = (0, 0);
    for seed in 0..12 {
        let mut drawn = drawn::<FourBar, 4, 3>(Kind::LongSteps, 100 * seed);
        (drawn.rule, drawn.steps) = (Rule::Midpoint, 12);
        let outcome = run::<FourBar, 4, 3>(&drawn);
        let Some(refused) = outcome.refused else { continue };
        let end = refused.root.expect_err("the step is refused falsely");
        assert!(end.share < 1.0 && end.pivot < 0.1, "{end:?}");
        ends += 1;
        let system = FourBar::of(&drawn.values);
        let state = State {
            q: dalembert::nalgebra::SVector::from_column_slice(&refused.q),
            p: dalembert::nalgebra::SVector::from_column_slice(&refused.p),
        };
        drawn.h = 0.1 * end.share * refused.h;
        let curve = problem(&FourBar::SHAPE, &drawn, &state).followed();
        assert!(matches!(curve, Curve::Root(_)));
        taken += usize::from(system.by(Midpoint, drawn.h).step(&state).is_ok());
    }
    assert!(ends > 2 && taken == ends, "{ends} {taken}");
}

/// A point without mass has no velocity: the error says so, and a point of 10⁻⁹ of the mass is stepped.
#[test]
fn a_point_without_mass_is_refused_by_name() -> Result<(), StepError> {
    let mut drawn = drawn::<Triangle, 6, 4>(Kind::Plain, 1);
    let weighed = |mass: f64, values: &mut Values| values.mass[2..4].fill(mass);
    weighed(1e-9, &mut drawn.values);
    step::<Triangle, 6, 4>(&drawn)?;
    weighed(0.0, &mut drawn.values);
    let error = step::<Triangle, 6, 4>(&drawn).unwrap_err();
    assert!(matches!(error, StepError::DegenerateLagrangian { column: 2 }), "{error}");
    Ok(())
}

/// A rope that is taut between two places of the ground: the last rod depends on the others, and is named.
#[test]
fn a_taut_rope_is_singular_and_its_last_rod_is_named() {
    let mut drawn = drawn::<FourBar, 4, 3>(Kind::Plain, 1);
    for (joint, place) in drawn.values.joints.iter_mut().zip([0.0, 0.0, 3.0]) {
        (joint.length, joint.place) = (1.0, [place, 0.0, 0.0]);
    }
    drawn.values.forces[0].numbers = [0.0; 3];
    drawn.values.gravity = [0.0, -9.81, 0.0];
    (drawn.q, drawn.v, drawn.h) = (vec![1.0, 0.0, 2.0, 0.0], vec![0.0; 4], 0.01);
    let error = step::<FourBar, 4, 3>(&drawn).unwrap_err();
    assert_eq!(error, StepError::DependentConstraints { constraint: 2 });
    // Positive control: with a longer rod it hangs, and is stepped.
    drawn.values.joints[0].length = 1.2;
    drawn.q = vec![0.9, -0.4, 2.1, -0.4];
    assert!(step::<FourBar, 4, 3>(&drawn).is_ok());
}
