//! Each wrong call is refused by the status that says why, and changes no byte; the right call beside it is
//! not.

use core::mem::MaybeUninit;
use core::ptr::{null, null_mut};

use dalembert_c::face::Fields;
use dalembert_c::{CReport, Status};

use crate::systems::{CartPole, Ring, cart_pole, ring, winch};
use crate::{Memory, PARAMETERS, bits, bytes, init};

/// An address inside `object` that is no multiple of its alignment.
fn askew<T>(object: &mut MaybeUninit<[T; 2]>) -> *mut T {
    object.as_mut_ptr().cast::<u8>().wrapping_add(1).cast()
}

/// A run some steps on its way.
fn under_way() -> Memory {
    let mut memory = Memory::zeroed();
    assert_eq!(init(&mut memory, &PARAMETERS, 0.01, [0.0, 0.2], [0.1, 0.0]), Status::Ok);
    for _ in 0..5 {
        assert_eq!(unsafe { cart_pole::step(memory.as_mut_ptr(), &[0.3], null_mut()) }, Status::Ok);
    }
    memory
}

#[test]
fn init_refuses_what_is_wrong_and_leaves_the_memory_as_it_was() {
    use Status::{
        MassNotPositiveDefinite, Misaligned, NotFinite, NullPointer, ParameterNan, StepSize, WrongMemory,
    };
    let (size, layout) = (size_of::<Memory>(), cart_pole::HEADER.layout);
    let (q, v, h) = ([0.0, 0.2], [0.1, 0.0], 0.01);
    let nan = CartPole { friction: [0.3, f64::NAN], ..PARAMETERS };
    let (mut pair, mut parameters) = (MaybeUninit::zeroed(), MaybeUninit::zeroed());
    let (vector, odd) =
        (askew::<[f64; 2]>(&mut pair).cast_const(), askew::<CartPole>(&mut parameters).cast_const().cast());
    let (good, nan) = (PARAMETERS.given(), nan.given());
    for mut memory in [Memory::zeroed(), under_way()] {
        let before = bytes(&memory);
        let mut call = |size, layout, parameters: *const _, h, q: *const _, v: *const _| unsafe {
            cart_pole::init_with(memory.as_mut_ptr(), size, layout, parameters, h, q, v)
        };
        for (status, expected) in [
            (call(size - 1, layout, &good, h, &q, &v), WrongMemory),
            (call(0, layout, &good, h, &q, &v), WrongMemory),
            (call(size, layout ^ 1, &good, h, &q, &v), WrongMemory),
            (call(size, ring::HEADER.layout, &good, h, &q, &v), WrongMemory),
            (call(size, layout, null(), h, &q, &v), NullPointer),
            (call(size, layout, &good, h, null(), &v), NullPointer),
            (call(size, layout, &good, h, &q, null()), NullPointer),
            (call(size, layout, odd, h, &q, &v), Misaligned),
            (call(size, layout, &good, h, vector, &v), Misaligned),
            (call(size, layout, &good, h, &q, vector), Misaligned),
            (call(size, layout, &nan, h, &q, &v), ParameterNan),
            (
                call(size, layout, &CartPole { cart: -1.0, ..PARAMETERS }.given(), h, &q, &v),
                MassNotPositiveDefinite,
            ),
            (call(size, layout, &good, 0.0, &q, &v), StepSize),
            (call(size, layout, &good, f64::NAN, &q, &v), StepSize),
            (call(size, layout, &good, f64::INFINITY, &q, &v), StepSize),
            (call(size, layout, &good, h, &[f64::NAN, 0.0], &v), NotFinite),
            (call(size, layout, &good, h, &q, &[0.0, f64::INFINITY]), NotFinite),
        ] {
            assert_eq!(status, expected);
        }
        assert_eq!(bytes(&memory), before);
        let call = |memory| unsafe { cart_pole::init_with(memory, size, layout, &good, h, &q, &v) };
        assert_eq!(call(null_mut()), NullPointer);
        assert_eq!(call(memory.as_mut_ptr().wrapping_byte_add(4)), Misaligned);
        assert_eq!(bytes(&memory), before);
        assert_eq!(call(memory.as_mut_ptr()), Status::Ok);
        assert!(cfg!(miri) || bytes(&memory) != before, "what is compared can differ");
    }
}

#[test]
fn no_call_takes_a_memory_that_holds_no_run_of_its_system() {
    let mut zeroed = Memory::zeroed();
    let mut other = MaybeUninit::<[ring::CMemory; 2]>::zeroed();
    let parameters = Ring { name: 1, k: 0.1, weights: [[1.0; 3], [0.0; 3]], turns: [0; 3] };
    let (size, layout) = (size_of::<ring::CMemory>(), ring::HEADER.layout);
    let started = unsafe {
        ring::init_with(
            other.as_mut_ptr().cast(),
            size,
            layout,
            &parameters.given(),
            0.1,
            &[0.0, 1.2],
            &[0.5, 0.0],
        )
    };
    assert_eq!(started, Status::Ok);
    assert!(size_of_val(&other) >= size_of::<Memory>());
    let mut run = under_way();
    for (memory, expected) in [
        (null_mut(), Status::NullPointer),
        (run.as_mut_ptr().wrapping_byte_add(4), Status::Misaligned),
        (zeroed.as_mut_ptr(), Status::NotInitialised),
        (other.as_mut_ptr().cast(), Status::NotInitialised),
    ] {
        let (mut q, mut p, mut one) = ([7.0; 2], [7.0; 2], 7.0);
        let mut report = CReport { time: 7.0, residual: 7.0, floor: 7.0, iterations: 7, damped: 7 };
        let mut linearized =
            cart_pole::CLinearized { by_state: [[7.0; 4]; 4], by_input: [[7.0]; 4], by_parameters: [[]; 4] };
        let before = [bytes(&zeroed), bytes(&other), bytes(&run)];
        let statuses = unsafe {
            [
                cart_pole::step(memory, &[0.0], &mut report),
                cart_pole::step_linearized(memory, &[0.0], &mut report, &mut linearized),
                cart_pole::state(memory, &mut q, &mut p),
                cart_pole::velocity(memory, &mut q),
                cart_pole::energy(memory, &mut one),
                cart_pole::time(memory, &mut one),
                cart_pole::state_after(memory, &[0.0], 0.1, &mut q, &mut p),
                cart_pole::set_state(memory, &[0.0; 2], &[0.0; 2]),
                cart_pole::set_parameters(memory, &PARAMETERS.given()),
                cart_pole::set_step_size(memory, 0.1),
            ]
        };
        assert_eq!(statuses, [expected; 10]);
        assert_eq!([bytes(&zeroed), bytes(&other), bytes(&run)], before);
        assert_eq!((q, p, one), ([7.0; 2], [7.0; 2], 7.0));
        assert_eq!(linearized.by_state, [[7.0; 4]; 4]);
        assert_eq!(report, CReport { time: 7.0, residual: 7.0, floor: 7.0, iterations: 7, damped: 7 });
    }
    // The control: the same calls on a run.
    let (memory, mut q, mut p, mut one) = (run.as_mut_ptr(), [7.0; 2], [7.0; 2], 7.0);
    let mut linearized =
        cart_pole::CLinearized { by_state: [[7.0; 4]; 4], by_input: [[7.0]; 4], by_parameters: [[]; 4] };
    let statuses = unsafe {
        [
            cart_pole::step(memory, &[0.0], null_mut()),
            cart_pole::step_linearized(memory, &[0.0], null_mut(), &mut linearized),
            cart_pole::state(memory, &mut q, null_mut()),
            cart_pole::state(memory, null_mut(), &mut p),
            cart_pole::velocity(memory, &mut q),
            cart_pole::energy(memory, &mut one),
            cart_pole::time(memory, &mut one),
            cart_pole::state_after(memory, &[0.0], 0.0, &mut q, &mut p),
            cart_pole::set_state(memory, &q, &p),
            cart_pole::set_parameters(memory, &PARAMETERS.given()),
            cart_pole::set_step_size(memory, 0.1),
        ]
    };
    assert_eq!(statuses, [Status::Ok; 11]);
    assert!((one - 0.07).abs() < 1e-15 && q != [7.0; 2] && p != [7.0; 2]);
    assert!(linearized.by_state.as_flattened().iter().all(|entry| *entry != 7.0));
}

#[test]
fn arguments_that_are_wrong_are_refused_and_nothing_is_changed() {
    use Status::{
        DerivativesNotFinite, InputNotFinite, Misaligned, NotFinite, NullPointer, ParameterNan, StepSize,
    };
    let mut run = under_way();
    let before = bytes(&run);
    let now = bits(&run);
    let (mut pair, mut reports, mut many) =
        (MaybeUninit::zeroed(), MaybeUninit::zeroed(), MaybeUninit::zeroed());
    let (mut numbers, mut systems) = (MaybeUninit::zeroed(), MaybeUninit::zeroed());
    let (vector, report) = (askew::<[f64; 2]>(&mut pair), askew::<CReport>(&mut reports));
    let linearized = askew::<cart_pole::CLinearized>(&mut many);
    let (number, system) = (askew::<f64>(&mut numbers), askew::<CartPole>(&mut systems));
    let input = number.cast::<[f64; 1]>().cast_const();
    let mut derivatives = MaybeUninit::uninit();
    let nan = CartPole { cart: f64::NAN, ..PARAMETERS };
    let (mut q, mut p, good, bad) = ([7.0; 2], [7.0; 2], [0.1; 2], [0.1, f64::NAN]);
    let memory = run.as_mut_ptr();
    let checks = unsafe {
        [
            (cart_pole::step(memory, null(), null_mut()), NullPointer),
            (cart_pole::step(memory, input, null_mut()), Misaligned),
            (cart_pole::step(memory, &[0.0], report), Misaligned),
            (cart_pole::step(memory, &[f64::NAN], null_mut()), InputNotFinite),
            (cart_pole::step(memory, &[f64::INFINITY], null_mut()), InputNotFinite),
            (cart_pole::step(memory, &[1e200], null_mut()), DerivativesNotFinite),
            (cart_pole::step_linearized(memory, &[0.0], null_mut(), null_mut()), NullPointer),
            (cart_pole::step_linearized(memory, &[0.0], null_mut(), linearized), Misaligned),
            (cart_pole::step_linearized(memory, &[0.0], report, derivatives.as_mut_ptr()), Misaligned),
            (cart_pole::step_linearized(memory, null(), null_mut(), derivatives.as_mut_ptr()), NullPointer),
            (
                cart_pole::step_linearized(memory, &[f64::NAN], null_mut(), derivatives.as_mut_ptr()),
                InputNotFinite,
            ),
            (cart_pole::state(memory, vector, &mut p), Misaligned),
            (cart_pole::state(memory, &mut q, vector), Misaligned),
            (cart_pole::velocity(memory, null_mut()), NullPointer),
            (cart_pole::velocity(memory, vector), Misaligned),
            (cart_pole::energy(memory, null_mut()), NullPointer),
            (cart_pole::energy(memory, number), Misaligned),
            (cart_pole::time(memory, null_mut()), NullPointer),
            (cart_pole::time(memory, number), Misaligned),
            (cart_pole::state_after(memory, null(), 0.1, &mut q, &mut p), NullPointer),
            (cart_pole::state_after(memory, &[f64::NAN], 0.1, &mut q, &mut p), InputNotFinite),
            (cart_pole::state_after(memory, &[0.0], f64::NAN, &mut q, &mut p), StepSize),
            (cart_pole::state_after(memory, &[0.0], 0.1, &mut q, vector), Misaligned),
            (cart_pole::set_state(memory, null(), &good), NullPointer),
            (cart_pole::set_state(memory, &good, null()), NullPointer),
            (cart_pole::set_state(memory, vector, &good), Misaligned),
            (cart_pole::set_state(memory, &bad, &good), NotFinite),
            (cart_pole::set_state(memory, &good, &bad), NotFinite),
            (cart_pole::set_parameters(memory, null()), NullPointer),
            (cart_pole::set_parameters(memory, system.cast()), Misaligned),
            (cart_pole::set_parameters(memory, &nan.given()), ParameterNan),
            (cart_pole::set_step_size(memory, 0.0), StepSize),
            (cart_pole::set_step_size(memory, f64::NAN), StepSize),
        ]
    };
    for (i, (status, expected)) in checks.into_iter().enumerate() {
        assert_eq!(status, expected, "check {i}");
    }
    assert_eq!(bytes(&run), before);
    assert_eq!((q, p, bits(&run)), ([7.0; 2], [7.0; 2], now));
    assert_eq!(bytes(&pair), vec![0; bytes(&pair).len()]);
}

#[test]
fn a_time_that_is_not_finite_is_refused() {
    let mut memory = MaybeUninit::<winch::CMemory>::zeroed();
    let (size, layout) = (size_of_val(&memory), winch::HEADER.layout);
    let parameters = crate::systems::Winch { c: 0.1, a: 0.2 };
    let mut start = |t| unsafe {
        winch::init_with(memory.as_mut_ptr(), size, layout, &parameters.given(), 0.1, t, &[0.3], &[0.0])
    };
    assert_eq!(start(f64::NAN), Status::InputNotFinite);
    assert_eq!(start(2.0), Status::Ok);
    let (mut v, memory) = ([7.0], memory.as_mut_ptr());
    let refused = unsafe {
        [
            winch::step(memory, &[0.0; 2], f64::INFINITY, null_mut()),
            winch::velocity(memory, f64::NAN, &mut v),
            winch::energy(memory, f64::NAN, &mut v[0]),
            winch::step(memory, &[0.0, f64::NAN], 0.0, null_mut()),
        ]
    };
    assert_eq!((refused, v), ([Status::InputNotFinite; 4], [7.0]));
    assert_eq!(unsafe { winch::step(memory, &[0.0; 2], 2.0, null_mut()) }, Status::Ok);
}

#[test]
fn every_status_has_a_text_that_ends_and_a_number_that_stays() {
    for (i, status) in Status::ALL.iter().enumerate() {
        assert_eq!(*status as usize, i);
        let text = unsafe { core::ffi::CStr::from_ptr(cart_pole::text(*status as i32)) };
        assert_eq!(text.to_str(), Ok(status.to_string().as_str()));
        assert!(text.to_bytes().is_ascii());
    }
    for number in [-1, Status::ALL.len() as i32, i32::MAX] {
        let text = unsafe { core::ffi::CStr::from_ptr(cart_pole::text(number)) };
        assert_eq!(text.to_str(), Ok("no status of this library"));
    }
}

#[test]
fn an_energy_that_is_no_number_is_refused() {
    // The kinetic energy overflows at the second speed, its momentum does not.
    for (speed, expected) in [(1e100, Status::Ok), (1e160, Status::DerivativesNotFinite)] {
        let (mut memory, mut energy) = (Memory::zeroed(), 7.0);
        assert_eq!(init(&mut memory, &PARAMETERS, 0.01, [0.0, 0.2], [speed, 0.0]), Status::Ok);
        assert_eq!(unsafe { cart_pole::energy(memory.as_ptr(), &mut energy) }, expected);
        assert!((energy == 7.0) == (expected != Status::Ok) && energy.is_finite());
    }
}
