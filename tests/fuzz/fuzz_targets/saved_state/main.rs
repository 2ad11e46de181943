//! Any text read as a saved run: an error, or a checkpoint that goes on, writes the same text again, and does
//! not panic.

#![no_main]

use dalembert::{Checkpoint, Midpoint, State, Trajectory, rayleigh_system};
use libfuzzer_sys::fuzz_target;

/// A pendulum on a spring.
#[rayleigh_system]
fn spring_pendulum(q: [f64; 2], v: [f64; 2], k: f64) -> (f64, f64) {
    let length = (q[0] * q[0] + q[1] * q[1]).sqrt();
    (0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.5 * k * (length - 1.0).powi(2) - q[1], 0.01 * v[0] * v[0])
}

fuzz_target!(|text: &[u8]| {
    if let Ok(checkpoint) = serde_json::from_slice::<Checkpoint<f64, 2>>(text) {
        // What was read is what is written and read again.
        if let Ok(again) = serde_json::to_string(&checkpoint)
            && let Ok(again) = serde_json::from_str::<Checkpoint<f64, 2>>(&again)
        {
            assert_eq!(again, checkpoint);
        }
        let mut run = Trajectory::resume(&SpringPendulum { k: 9.0 }, Midpoint, checkpoint);
        let _ = run.time();
        for step in run.by_ref().take(3) {
            assert!(
                step.is_err() || step.is_ok_and(|step| step.state.q.iter().all(|entry| entry.is_finite()))
            );
        }
        let _ = run.next_in_parts(2);
    }
    let _ = serde_json::from_slice::<State<f32, 3>>(text);
    let _ = serde_json::from_slice::<Checkpoint<f32, 1>>(text);
});
