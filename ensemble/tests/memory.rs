//! Memory is bounded by the threads, whatever the number of members.

#![cfg(target_os = "linux")]

use dalembert::{Splitting, State, StepError, rayleigh_system};
use dalembert_ensemble::Ensemble;
use rayon::ThreadPoolBuilder;

#[rayleigh_system(rule = trapezoidal, lanes = explicit)]
fn spring(q: [f64; 1], v: [f64; 1], k: f64) -> f64 {
    0.5 * v[0] * v[0] - 0.5 * k * q[0] * q[0]
}

fn member(number: u64) -> Result<(Spring, State<f64, 1>), StepError> {
    Ok((Spring { k: 1.0 + 1e-7 * number as f64 }, State { q: [1.0].into(), p: [0.0].into() }))
}

/// The most memory that this process has had, in MiB.
fn peak() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap();
    line.trim().trim_end_matches(" kB").parse::<f64>().unwrap() / 1024.0
}

/// The only test of this program: the peak is that of all of it.
#[test]
fn a_reduction_of_many_members_takes_no_more_memory_than_one_of_few() {
    let many = if cfg!(debug_assertions) { 100_000 } else { 1_000_000 };
    let pool = ThreadPoolBuilder::new().num_threads(2).build().unwrap();
    pool.install(|| {
        let study = || Ensemble::new(member).by(Splitting::blanes_moan_4(), 0.1).steps(1);
        let sum = |members, in_lanes| {
            let add =
                |sum: &mut f64, outcome: dalembert_ensemble::Outcome<f64, f64, 1>| *sum += outcome.value;
            let (value, study) = (|_| 0.0, study());
            if in_lanes {
                study.in_lanes().reduce(0..members, value, |q, record| *q = record.state.q[0], 0.0, add)
            } else {
                study.reduce(0..members, value, |q, record| *q = record.state.q[0], 0.0, add)
            }
            .unwrap()
        };
        let of_few = (sum(10_000, true) + sum(10_000, false), peak()).1;
        let of_many = (sum(many, true) + sum(many, false), peak()).1;
        // At most 16 384 members a thread, some 100 bytes each, are held besides.
        assert!(of_many < of_few + 10.0, "{of_few} MiB, then {of_many}");
        // The control: what is kept of each member is seen.
        let ends = study().in_lanes().ends(0..many).unwrap();
        let of_ends = peak();
        assert!(of_ends > of_many + 32.0 * many as f64 / 1048576.0, "{of_many} MiB, then {of_ends}");
        assert_eq!(ends.len() as u64, many);
    });
}
