//! The functions of systems with constraints: wrong calls are refused and change no byte, where results go
//! either.

use core::mem::MaybeUninit;
use core::ptr::{null, null_mut};

use dalembert_c::face::Fields;
use dalembert_c::{CViolation, Status};

use crate::bytes;
use crate::systems::constrained::{Rods, rods};

const PARAMETERS: Rods = Rods { m: [1.0, 0.7] };
const START: [[f64; 4]; 2] = [[0.6, -0.8, 0.6, -1.6], [0.0; 4]];

type Memory = MaybeUninit<rods::CMemory>;

fn init(memory: &mut Memory, [q, v]: &[[f64; 4]; 2]) -> Status {
    let (size, layout) = (size_of::<Memory>(), rods::HEADER.layout);
    unsafe { rods::init_with(memory.as_mut_ptr(), size, layout, &PARAMETERS.given(), 0.01, q, v) }
}

#[test]
fn wrong_calls_are_refused_and_write_nothing() {
    use Status::{Misaligned, NotFinite, NullPointer, ParameterNan};
    let [q, v] = &START;
    let (good, nan) = (PARAMETERS.given(), Rods { m: [f64::NAN, 1.0] }.given());
    let (mut room, mut found) = ([[7.0; 4]; 3], CViolation { amount: 7.0, status: 7, constraint: 7 });
    let [near_q, near_v, _] = &mut room;
    let odd = core::ptr::from_mut(near_v).wrapping_byte_add(4);
    let violation = |parameters, q, v, to| unsafe { rods::violation(parameters, q, v, to) };
    let nearest = |parameters, q, v, to_q, to_v| unsafe { rods::nearest(parameters, q, v, to_q, to_v) };
    for (status, expected) in [
        (violation(null(), q, v, &mut found), NullPointer),
        (violation(&good, null(), v, &mut found), NullPointer),
        (violation(&good, q, odd.cast_const(), &mut found), Misaligned),
        (violation(&nan, q, v, &mut found), ParameterNan),
        (violation(&good, &[f64::NAN; 4], v, &mut found), NotFinite),
        (violation(&good, q, v, null_mut()), NullPointer),
        (nearest(null(), q, v, near_q, near_v), NullPointer),
        (nearest(&good, q, null(), near_q, near_v), NullPointer),
        (nearest(&nan, q, v, near_q, near_v), ParameterNan),
        (nearest(&good, q, &[f64::INFINITY; 4], near_q, near_v), NotFinite),
        (nearest(&good, q, v, null_mut(), near_v), NullPointer),
        (nearest(&good, q, v, near_q, odd), Misaligned),
        // Both bobs at one place: no direction leads to a rod.
        (nearest(&good, &[0.0; 4], v, near_q, near_v), Status::NoDerivativeOfConstraint),
    ] {
        assert_eq!(status, expected);
    }
    assert_eq!(room, [[7.0; 4]; 3]);
    assert_eq!(found, CViolation { amount: 7.0, status: 7, constraint: 7 });
    // The control: right calls write there.
    let [near_q, near_v, _] = &mut room;
    assert_eq!(nearest(&good, q, v, near_q, near_v), Status::Ok);
    assert_eq!(violation(&good, q, &[0.0, 0.0, 0.0, 1.0], &mut found), Status::Ok);
    assert!((room[0][1] - q[1]).abs() < 1e-15 && found.status == Status::LeavesConstraint as i32);
    assert_eq!((found.constraint, found.amount), (1, -1.0));
}

#[test]
fn reactions_are_those_of_the_last_step_alone() {
    let mut memory = Memory::zeroed();
    let mut lambda = [7.0; 2];
    assert_eq!(unsafe { rods::reactions(memory.as_ptr(), &mut lambda) }, Status::NotInitialised);
    assert_eq!(init(&mut memory, &START), Status::Ok);
    let at = memory.as_mut_ptr();
    assert_eq!(unsafe { rods::reactions(at, &mut lambda) }, Status::NoStep);
    assert_eq!(unsafe { rods::step(at, &[0.0; 2], null_mut()) }, Status::Ok);
    let before = bytes(&memory);
    assert_eq!(unsafe { rods::reactions(at, null_mut()) }, Status::NullPointer);
    assert_eq!(lambda, [7.0; 2]);
    assert_eq!(unsafe { rods::reactions(at, &mut lambda) }, Status::Ok);
    assert_eq!(bytes(&memory), before, "looking changes nothing");
    assert!(lambda.iter().all(|&lambda| lambda < 0.0), "both rods pull: {lambda:?}");
    // A start that is refused changes nothing, the step that is asked among it.
    assert_eq!(init(&mut memory, &[[0.6, -0.8, 0.6, -1.7], [0.0; 4]]), Status::OffConstraint);
    assert_eq!(bytes(&memory), before);
    assert_eq!(init(&mut memory, &START), Status::Ok);
    assert_eq!(unsafe { rods::reactions(at, &mut lambda) }, Status::NoStep);
}
