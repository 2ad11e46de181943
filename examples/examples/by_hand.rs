//! The scene `ring` with and without the macro: the same L and R, derivatives by hand, the same trajectory.
//!
//! The system written by hand is `src/by_hand.rs`. A test holds the two equal.
//!
//! ```text
//! cargo run --release --example by_hand
//! ```

use anyhow::{Result, ensure};
use dalembert::{Discrete, Discretise, Midpoint, State};
use dalembert_examples::by_hand::RingByHand;

#[path = "ring.rs"]
#[expect(dead_code, reason = "of the scene, the system and its start are used here")]
mod ring;

fn main() -> Result<()> {
    let (generated, by_hand) = (ring::Ring { k: 1e-3 }, RingByHand { k: 1e-3 });
    let start = ring::start(&generated)?;
    let (mut of_macro, mut of_hand) = (start, start);
    let mut largest = 0.0_f64;

    println!("     t         q, by the macro         p, by the macro   |difference from by hand|");
    for step in 1..=10 {
        of_macro = next(&generated, &of_macro)?;
        of_hand = next(&by_hand, &of_hand)?;
        let State { q, p } = of_macro;
        let difference = (q - of_hand.q).amax().max((p - of_hand.p).amax());
        largest = largest.max(difference);
        let t = f64::from(step) * ring::H;
        println!("{t:6.1} {:11.8} {:11.8} {:11.8} {:11.8} {difference:25.1e}", q[0], q[1], p[0], p[1]);
    }
    // Ten steps, each with a few roundings of numbers about 1.
    ensure!(largest < 1e-14, "the macro and the hand differ by {largest:.1e}");
    println!("\nThe macro and the hand agree to rounding: {largest:.1e} at most.");
    Ok(())
}

/// The next state; the macro and the hand implement the same traits.
fn next(system: &impl Discrete<Midpoint, 2, Scalar = f64>, state: &State<f64, 2>) -> Result<State<f64, 2>> {
    Ok(system.by(Midpoint, ring::H).step(state)?.state)
}
