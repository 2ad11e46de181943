//! Steps each scene 200 times, and reports the bits it ends with, the instructions of a step and the stack
//! used.

#![no_std]
#![no_main]

#[cfg_attr(target_arch = "arm", path = "arm.rs")]
#[cfg_attr(target_arch = "riscv32", path = "riscv.rs")]
mod machine;
mod report;

use core::hint::black_box;
use core::panic::PanicInfo;
use core::ptr;
use dalembert::step::{ClosedForm, Flow, Segment};

use dalembert::run::DrivenTrajectory;
use dalembert::{Discretise, Elementary, Midpoint, Proximal, State};
use firmware_scenes::{STEPS, Stepped, digest, double, single};
use report::Line;

/// What an unused word of the stack holds.
const PAINT: u32 = 0xa5c3_96e1;

unsafe extern "C" {
    /// Defined nowhere: a program with a panic in it does not link.
    fn a_panic_is_left_in_the_program() -> !;
    static stack_limit: u32;
    static stack_top: u32;
}

#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    // SAFETY: never linked, hence never called.
    unsafe { a_panic_is_left_in_the_program() }
}

/// Bytes of the stack below `stack_top` that were ever written.
fn stack_used() -> u32 {
    let (limit, top) = (&raw const stack_limit, &raw const stack_top);
    let mut word = limit;
    // SAFETY: words of the stack's memory, between the two symbols of the linker script.
    while word < top && unsafe { ptr::read_volatile(word) } == PAINT {
        // SAFETY: as above.
        word = unsafe { word.add(1) };
    }
    (top as usize - word as usize) as u32
}

/// Steps `system` from `start` and reports; false where a step failed.
fn run<L, S>(name: &str, counter: &machine::Counter, system: &L, start: State<S, 2>, h: S) -> bool
where
    L: ClosedForm<Midpoint, 2, Scalar = S>,
    S: Elementary,
{
    let mut trajectory = system.by(Midpoint, h).run(start);
    let (mut sum, mut first, mut worst, mut iterations, mut hash) = (0, 0, 0, 0, 0);
    let mut succeeded = true;
    for index in 0..STEPS {
        let mut step = None;
        let instructions = counter.instructions(|| step = black_box(&mut trajectory).next());
        sum += instructions;
        // The first step finds its guess, and holds the values generated against the functions as written.
        if index == 0 {
            first = instructions;
        } else {
            worst = worst.max(instructions);
        }
        match step {
            Some(Ok(step)) => {
                iterations += step.report.iterations;
                hash = digest(hash, &step.state);
            }
            _ => succeeded = false,
        }
    }
    let line = Line::new("scene").word(name).bits(hash);
    line.number(sum / STEPS).number(worst).number(iterations).write();
    Line::new("part").word(name).word("first_step").number(first).write();
    // What a step is made of.
    let (q, v) = (black_box(start.q), black_box(trajectory.state().p));
    let part = |part: &str, work: &dyn Fn()| {
        Line::new("part").word(name).word(part).number(counter.instructions(work)).write();
    };
    part("sin_cos", &|| _ = black_box(Elementary::sin_cos(q[0])));
    part("step_kernel", &|| _ = black_box(system.step_kernel(&Segment { q0: q, v, h })));
    part("momenta", &|| _ = black_box(system.momenta(&Segment { q0: q, v, h })));
    // What a failing step costs, and its stack: no state is near, and none is a number.
    for q in [S::constant(1e30), S::constant(f64::NAN)] {
        let mut start = start;
        start.q[0] = q;
        start.p[0] = S::constant(1e25);
        let instructions =
            counter.instructions(|| _ = black_box(system.by(Midpoint, S::constant(1e20)).step(&start)));
        Line::new("failing").word(name).number(instructions).write();
    }
    succeeded
}

/// Steps a system whose step has more to solve than p0(v̄) = p0; false where a step failed.
fn run_bordered<L, M, S, const N: usize>(
    name: &str,
    counter: &machine::Counter,
    (system, method): (&L, M),
    start: State<S, N>,
    h: S,
) -> bool
where
    L: Flow<M, N, Scalar = S>,
    S: Elementary,
{
    let mut trajectory = system.by(method, h).run(start);
    let (mut sum, mut worst, mut hash, mut succeeded) = (0, 0, 0, true);
    for index in 0..STEPS {
        let mut step = None;
        let instructions = counter.instructions(|| step = black_box(&mut trajectory).next());
        sum += instructions;
        worst = if index == 0 { 0 } else { instructions.max(worst) };
        match step {
            Some(Ok(step)) => hash = digest(hash, &step.state),
            _ => succeeded = false,
        }
    }
    Line::new("bordered").word(name).bits(hash).number(sum / STEPS).number(worst).write();
    succeeded
}

/// Steps a cart-pole with an input each, as `in_c/main.c` does; false where a step failed.
macro_rules! push {
    ($name:literal $module:ident $counter:ident) => {{
        #[inline(never)]
        fn push(counter: &machine::Counter) -> bool {
            use $module::{DrivenPushedCartPole, PushedCartPole};
            let system = black_box(PushedCartPole::SCENE);
            let Ok(start) = system.start() else { return false };
            let h = PushedCartPole::STEP;
            let mut run = DrivenTrajectory::<DrivenPushedCartPole<'static>, Midpoint, 2>::new(h, start);
            let (mut sum, mut worst, mut iterations, mut hash, mut succeeded) = (0, 0, 0, 0, true);
            for index in 0..STEPS {
                let (u, mut copy) = (black_box(PushedCartPole::input(index)), run.clone());
                let instructions = counter.instructions(|| {
                    succeeded &= black_box(&mut run).advance(&system.driven(u)).is_ok();
                });
                sum += instructions;
                worst = if index == 0 { 0 } else { instructions.max(worst) };
                let report = copy.advance(&system.driven(u)).map(|step| step.report);
                iterations += report.map_or(0, |report| report.iterations);
                hash = digest(hash, run.state());
            }
            let line = Line::new("scene").word($name).bits(hash);
            line.number(sum / STEPS).number(worst).number(iterations).write();
            succeeded
        }
        push(&$counter)
    }};
}

/// Called by the start-up code.
#[unsafe(no_mangle)]
pub extern "C" fn start() -> ! {
    let counter = machine::Counter::new();
    let mut succeeded = true;
    macro_rules! scene {
        ($name:literal $module:ident $system:ident) => {
            let system = black_box($module::$system::SCENE);
            succeeded &= match system.start() {
                Ok(start) => run($name, &counter, &system, start, $module::$system::STEP),
                Err(_) => false,
            };
        };
    }
    scene!("double_pendulum_f32" single DoublePendulum);
    scene!("cart_pole_f32" single CartPole);
    Line::new("stack").word("f32").number(stack_used()).write();
    scene!("double_pendulum_f64" double DoublePendulum);
    scene!("cart_pole_f64" double CartPole);
    Line::new("stack").word("f64").number(stack_used()).write();
    succeeded &= push!("pushed_cart_pole_f32" single counter);
    succeeded &= push!("pushed_cart_pole_f64" double counter);
    macro_rules! bordered {
        ($name:literal $module:ident $system:ident $rule:ident) => {
            let system = black_box($module::$system::SCENE);
            succeeded &= match system.start() {
                Ok(start) => run_bordered($name, &counter, (&system, $rule), start, $module::$system::STEP),
                Err(_) => false,
            };
        };
    }
    bordered!("bob_f32" single Bob Midpoint);
    bordered!("block_f32" single Block Proximal);
    bordered!("bob_f64" double Bob Midpoint);
    bordered!("block_f64" double Block Proximal);
    Line::new("stack").word("bordered").number(stack_used()).write();
    #[cfg(feature = "may-panic")]
    Line::new("control").number([1, 2, 3][stack_used() as usize]).write();
    machine::exit(if succeeded { 0 } else { 2 })
}
