//! With the features `std` and `libm`, every way to a value takes the runtime's elementary functions, none
//! the platform's.

use dalembert::nalgebra::SVector;
use dalembert::run::{Explicit, LaneRuns};
use dalembert::step::FlowInLanes;
use dalembert::system::Scalar;
use dalembert::{
    Discretise, Elementary, Force, Gauss, Lagrangian, Midpoint, Rayleigh, Splitting, State, Trapezoidal,
    rayleigh_system,
};
use firmware_scenes::language::{Double, DoubleMembers, Single, SingleMembers};

/// The same body by both engines: one sum of functions in which libm and the platform's library differ
/// somewhere.
macro_rules! both_engines {
    ($expanded:ident $by_num_dual:ident $float:ident) => {
        both_engines!(@engine $expanded expanded $float);
        both_engines!(@engine $by_num_dual num_dual $float);
    };
    (@engine $name:ident $engine:ident $float:ident) => {
        struct $name;

        #[rayleigh_system(derivatives = $engine)]
        impl $name {
            fn lagrangian(&self, q: [$float; 1], v: [$float; 1]) -> $float {
                0.5 * v[0] * v[0] + q[0].sin() + q.iter().map(|x| x.cos()).sum::<$float>() + Self::more(q[0])
            }

            fn more(x: $float) -> $float {
                $float::tan(x) + x.exp() + $float::powf(2.0 + x.tanh(), 0.3) + x.mul_add(2.0, x.asinh())
            }
        }
    };
}
both_engines!(Expanded ByNumDual f64);
both_engines!(ExpandedSingle ByNumDualSingle f32);

/// What the bodies above say, by functions of the runtime named one by one.
fn explicit<S: Elementary>(x: S, v: S) -> S {
    let [half, two, exponent] = [0.5, 2.0, 0.3].map(S::constant);
    let more = Elementary::tan(x)
        + Elementary::exp(x)
        + Elementary::powf(two + Elementary::tanh(x), exponent)
        + Elementary::mul_add(x, two, Elementary::asinh(x));
    half * v * v + Elementary::sin(x) + Elementary::cos(x) + more
}

fn points() -> impl Iterator<Item = f64> {
    (0..2000).map(|i| -9.0 + 0.009_013 * f64::from(i))
}

#[test]
fn both_engines_and_the_plain_function_are_the_runtimes() {
    let mut differs = 0;
    for x in points() {
        let expected = explicit(x, 0.3);
        let (q, v) = (SVector::from([x]), SVector::from([0.3]));
        assert_eq!(Expanded.lagrangian([x], [0.3]), expected);
        assert_eq!(Lagrangian::lagrangian(&Expanded, &q, &v), expected);
        assert_eq!(Expanded.lagrangian_gradient(&q, &v).value, expected);
        assert_eq!(Expanded.lagrangian_derivatives(&q, &v).value, expected);
        assert_eq!(ByNumDual.lagrangian([x], [0.3]), expected);
        assert_eq!(ByNumDual.lagrangian_gradient(&q, &v).value, expected);
        // Positive control: the platform's functions give other bits somewhere.
        let more = x.tan() + x.exp() + f64::powf(2.0 + x.tanh(), 0.3) + x.mul_add(2.0, x.asinh());
        differs += u32::from(0.5 * 0.3 * 0.3 + x.sin() + x.cos() + more != expected);
    }
    assert!(differs > 0);
}

#[test]
fn so_they_are_in_single_precision() {
    for x in points().map(|x| x as f32) {
        let expected = explicit(x, 0.3);
        let (q, v) = (SVector::from([x]), SVector::from([0.3]));
        assert_eq!(ExpandedSingle.lagrangian([x], [0.3]), expected);
        assert_eq!(ExpandedSingle.lagrangian_gradient(&q, &v).value, expected);
        assert_eq!(ByNumDualSingle.lagrangian([x], [0.3]), expected);
    }
}

#[test]
fn every_way_to_call_a_function_gives_one_value() {
    macro_rules! one_value {
        ($system:expr, $float:ident) => {
            for x in points().map(|x| x as $float) {
                let (q, v) = ([x, 0.4 - x], [0.2, -0.7]);
                let (at, moving) = (SVector::from(q), SVector::from(v));
                let plain = $system.lagrangian(q, v);
                assert!(plain.is_finite());
                assert_eq!(plain, $system.lagrangian_gradient(&at, &moving).value);
                assert_eq!(plain, $system.lagrangian_derivatives(&at, &moving).value);
                assert_eq!($system.rayleigh(q, v), $system.rayleigh_gradient(&at, &moving).value);
                assert_eq!(SVector::from($system.force(q, v)), $system.force_derivatives(&at, &moving).value);
            }
        };
    }
    one_value!(Double { k: 1.5 }, f64);
    one_value!(Single { k: 1.5 }, f32);
}

#[test]
fn sine_and_cosine_together_are_those_alone() {
    for x in points() {
        assert_eq!(Elementary::sin_cos(x), (Elementary::sin(x), Elementary::cos(x)));
        let x = x as f32;
        assert_eq!(Elementary::sin_cos(x), (Elementary::sin(x), Elementary::cos(x)));
    }
}

/// Bits of numbers, those of NaN being one.
fn bits<S: Copy + Into<f64>, const K: usize>(numbers: [S; K]) -> [u64; K] {
    numbers.map(|x| if x.into().is_nan() { f64::NAN.to_bits() } else { x.into().to_bits() })
}

/// Beyond the range of their branch-free forms: libm's, whoever asks, and not the platform's.
#[test]
fn branch_free_functions_leave_what_is_beyond_their_range_to_libm() {
    let mut differs = [0; 2];
    let angles = (0..4000).map(|i| 1e6 + 7e11 * f64::from(i).sin());
    for x in angles.filter(|x| x.abs() > 1e6).chain([f64::NAN, f64::INFINITY, f64::NEG_INFINITY]) {
        let free = [x.branch_free().sin(), x.branch_free().cos()];
        assert_eq!(bits(free), bits([Elementary::sin(x), Elementary::cos(x)]), "{x}");
        let force = DoubleMembers { m: 1.0 }.configuration_force(&SVector::from([x, 0.0]));
        assert_eq!(bits([force[0]]), bits([-Elementary::sin(x)]), "{x}");
        // Positive control: the platform's functions give other bits somewhere.
        differs[0] += u32::from(bits(free) != bits([x.sin(), x.cos()]));
    }
    let exponents = (0..4000).map(|i| 700.5 + 0.002 * f64::from(i)).flat_map(|x| [x, -x]);
    for x in exponents.chain([f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 800.0, -800.0]) {
        let free = x.branch_free().exp();
        assert_eq!(bits([free]), bits([Elementary::exp(x)]), "{x}");
        let force = DoubleMembers { m: 1.0 }.configuration_force(&SVector::from([0.0, x]));
        assert_eq!(bits([force[1]]), bits([-Elementary::exp(x)]), "{x}");
        differs[1] += u32::from(bits([free]) != bits([x.exp()]));
    }
    assert!(differs.iter().all(|&differs| differs > 0), "{differs:?}");
}

/// Members in lanes, ordinary ones and some whose numbers are huge or none: each bit by bit its own run.
#[test]
fn lanes_compute_what_each_member_does_alone() {
    fn agree<L, M>(method: M, members: &[L; 6], starts: &[State<L::Scalar, 2>; 6])
    where
        L: FlowInLanes<M, 2, Scalar: Into<f64>>,
        M: Copy,
    {
        let h = L::Scalar::constant(0.05);
        let mut runs = LaneRuns::new(method, members.each_ref(), starts, h);
        runs.advance(12);
        let entries = |state: State<L::Scalar, 2>| bits([state.q[0], state.q[1], state.p[0], state.p[1]]);
        let alone: Vec<_> = (0..6)
            .map(|lane| {
                let end = members[lane].by(method, h).run(starts[lane]).nth(11)?;
                end.ok().map(|step| entries(step.state))
            })
            .collect();
        let in_lanes: Vec<_> = (0..6).map(|lane| runs.state(lane).map(entries)).collect();
        assert_eq!(in_lanes, alone);
        // Positive controls: some end, not all do, and they move.
        assert!(alone.iter().flatten().count() >= 4 && alone[5].is_none());
        assert_ne!(alone[0], Some(entries(starts[0])));
    }
    macro_rules! agree_by_every_method {
        ($members:ident $float:ident) => {{
            let masses: [$float; 6] = [0.7, 1.0, 1.3, 2.0, 1.1, 1.0];
            let members = masses.map(|m| $members { m });
            let places: [[$float; 2]; 6] =
                [[0.5, -1.0], [-2.0, 0.1], [3e7, -2.0], [-4e6, 0.3], [1.0, -710.0], [<$float>::NAN, 0.0]];
            let starts = places.map(|q| State { q: q.into(), p: [0.3, -0.2].into() });
            agree(Trapezoidal, &members, &starts);
            agree(Splitting::blanes_moan_6(), &members, &starts);
            agree(Midpoint, &members, &starts);
            agree(Gauss::<3>, &members, &starts);
        }};
    }
    agree_by_every_method!(DoubleMembers f64);
    agree_by_every_method!(SingleMembers f32);
}
