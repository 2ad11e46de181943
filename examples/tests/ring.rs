//! The figures of the scene `ring` against computations that share no code with it; and what the README says
//! that its program prints.

use std::cell::RefCell;

thread_local! {
    /// What the program has printed.
    static PRINTED: RefCell<String> = const { RefCell::new(String::new()) };
}

/// The program's `println!`.
macro_rules! println {
    ($($text:tt)*) => {{
        let line = format!($($text)*);
        crate::PRINTED.with_borrow_mut(|printed| *printed += &(line + "\n"));
    }};
}

mod readme {
    include!("../examples/readme/program.rs");

    pub fn run() -> Result<(), dalembert::StepError> {
        main()
    }
}

#[path = "../examples/ring.rs"]
#[expect(dead_code, reason = "of the scene, what it computes is tested here, not what it prints")]
mod ring;

use dalembert_examples::baseline::Method;
use indicatif::ProgressBar;
use ring::{H, Motion, Ring, STEPS, start};

/// A block of a page between fences of that kind: the first from `from` on.
fn block<'a>(page: &'a str, from: &str, fence: &str) -> &'a str {
    let text = &page[page.find(from).unwrap()..];
    text.split_once(fence).unwrap().1.split_once("```").unwrap().0
}

#[test]
fn first_pages_have_the_program_and_what_it_prints() {
    readme::run().unwrap();
    let printed = PRINTED.take();
    let pages = [
        (include_str!("../../README.md"), "```rust\n"),
        (include_str!("../../runtime/src/guide/front_page.md"), "```\n"),
    ];
    for (page, fence) in pages {
        assert!(page.contains(&[fence, include_str!("../examples/readme/program.rs"), "```\n"].concat()));
        let said = block(page, "prints", "```text\n");
        assert_eq!(printed, said);
        // Positive control: another motion prints something else.
        assert_ne!(printed, said.replacen("0.", "0.1", 1));
    }
}

const RING: Ring = Ring { k: 1e-3 };

fn variational_midpoint() -> Motion {
    ring::variational_midpoint(&RING, start(&RING).unwrap(), &ProgressBar::hidden()).unwrap().0
}

fn standard_method(method: Method) -> Motion {
    ring::standard_method(&RING, method, 1, start(&RING).unwrap(), &ProgressBar::hidden()).unwrap()
}

fn reference() -> Motion {
    standard_method(Method::DormandPrince853(1e-13))
}

/// E(2000) of the exact motion, by Taylor series of order 24 in steps of 0.1 with 30 digits (mpmath).
const EXACT_ENERGY: f64 = 0.016291413218940473;
/// E(2000) by the classical Runge–Kutta method and by the variational midpoint rule, h = 0.2, both written
/// out in NumPy.
const RUNGE_KUTTA_ENERGY: f64 = 0.0030525408796330603;
const MIDPOINT_ENERGY: f64 = 0.017815102495656848;

#[test]
#[cfg_attr(debug_assertions, ignore = "long without optimisation: cargo test --release")]
fn the_methods_end_with_the_energies_of_independent_computations() {
    let [reference, runge_kutta, midpoint] =
        [reference(), standard_method(Method::RungeKutta4), variational_midpoint()]
            .map(|motion| motion.energy[STEPS]);
    // Rounding of 10⁴ steps, and for the reference its tolerance, over a motion whose phase errors grow with
    // t.
    assert!((reference - EXACT_ENERGY).abs() < 1e-12, "{reference}");
    assert!((runge_kutta - RUNGE_KUTTA_ENERGY).abs() < 1e-12, "{runge_kutta}");
    assert!((midpoint - MIDPOINT_ENERGY).abs() < 1e-11, "{midpoint}");
    // Positive control: a reference with a tolerance of 1e-6 is found out.
    let rough = standard_method(Method::DormandPrince853(1e-6)).energy[STEPS];
    assert!((rough - EXACT_ENERGY).abs() > 1e-11, "{rough}");
}

#[test]
fn the_motion_starts_with_the_energy_of_the_paper() {
    // E = 11/40 to the digits of the initial q.
    assert!((start(&RING).unwrap().energy(&RING).unwrap() - 11.0 / 40.0).abs() < 1e-13);
}

#[test]
#[cfg_attr(debug_assertions, ignore = "long without optimisation: cargo test --release")]
fn the_angular_momentum_of_the_reference_decays_exactly() {
    let j = reference().angular_momentum;
    for (step, &value) in j.iter().enumerate() {
        let exact = j[0] * (-RING.k * step as f64 * H).exp();
        assert!((value - exact).abs() < 1e-12, "step {step}");
    }
}

/// What figure 2 of the paper shows: the variational midpoint loses energy to drag alone, Runge–Kutta by
/// itself as well.
#[test]
#[cfg_attr(debug_assertions, ignore = "long without optimisation: cargo test --release")]
fn the_midpoint_follows_the_energy_and_runge_kutta_does_not() {
    let (reference, midpoint) = (reference(), variational_midpoint());
    let runge_kutta = standard_method(Method::RungeKutta4);
    let largest_error = |motion: &Motion| {
        let errors =
            motion.energy.iter().zip(&reference.energy).map(|(energy, exact)| (energy - exact).abs());
        errors.fold(0.0, f64::max)
    };
    let by_itself = |motion: &Motion| motion.energy_lost() - motion.drag_work();
    assert!(7.0 * largest_error(&midpoint) < largest_error(&runge_kutta));
    assert!(100.0 * by_itself(&midpoint).abs() < by_itself(&runge_kutta));
    // The trapezoidal sum itself, on the reference.
    assert!(by_itself(&reference).abs() < 1e-6);
}

/// E is lost as friction takes it to O(h²), Ẽ to O(h⁴), and R̃ takes energy at every node.
#[test]
fn the_modified_energy_is_lost_as_friction_takes_it() {
    let worst = [(0.1, 200), (0.05, 400), (0.025, 800)].map(|(h, steps)| {
        let balances = ring::energies(&RING, start(&RING).unwrap(), h, steps).unwrap();
        assert!(balances[1].loss.iter().all(|&loss| loss > 0.0));
        balances.map(|balance| balance.worst(h))
    });
    for halving in worst.windows(2) {
        let [plain, modified] = [0, 1].map(|of| (halving[0][of] / halving[1][of]).log2());
        assert!((plain - 2.0).abs() < 0.1 && (modified - 4.0).abs() < 0.1, "{plain} {modified}");
    }
    // At the scene's own step the run does not add to it: that of T = 40 is that of T = 20.
    let of = |steps| ring::energies(&RING, start(&RING).unwrap(), H, steps).unwrap()[1].worst(H);
    assert_eq!(of(200), of(100));
}
