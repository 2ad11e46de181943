//! Work against precision of the Gauss rules on the ring: microseconds for one trajectory and its error, over stages and step sizes.
//!
//! `RUSTFLAGS="-C target-cpu=native" cargo bench -p dalembert-benches --bench gauss`
//!
//! The stages are lanes of vector instructions, as wide as the target has them: without `target-cpu=native` x86-64 has two.

use std::hint::black_box;

use dalembert::{Discrete, Gauss, State, Trajectory, rayleigh_system};
use dalembert_benches::interleaved;

struct Ring {
    k: f64,
}

#[rayleigh_system(rule = gauss, derivatives = expanded)]
impl Ring {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let s = q[0] * q[0] + q[1] * q[1];
        0.5 * (v[0] * v[0] + v[1] * v[1]) - s * (s - 1.0).powi(2)
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.k * (v[0] * v[0] + v[1] * v[1])
    }
}

fn median<L, const N: usize, const S: usize>(
    system: &L,
    start: &State<f64, N>,
    time: f64,
    steps: u32,
    end: &[f64; N],
) -> (f64, f64, f64)
where
    L: Discrete<Gauss<S>, N, Scalar = f64>,
{
    let h = time / f64::from(steps);
    let run = || {
        let mut trajectory = Trajectory::new(system, Gauss::<S>, h, black_box(*start));
        let mut iterations = 0;
        for _ in 0..steps {
            match trajectory.next() {
                Some(Ok(step)) => iterations += step.report.iterations,
                other => panic!("{other:?}"),
            }
        }
        (*trajectory.state(), iterations)
    };
    let (last, iterations) = run();
    let error = (0..N).map(|a| (last.q[a] - end[a]).powi(2)).sum::<f64>().sqrt();
    let [seconds] = interleaved([&|| {
        black_box(run());
    }]);
    (seconds * 1e6, error, f64::from(iterations) / f64::from(steps))
}

fn main() {
    let ring = Ring { k: 1e-3 };
    let start = State::from_velocity(&ring, [0.0, 1.15549918674982], [0.5, 0.0]).unwrap();
    let end: [f64; 2] =
        Trajectory::new(&ring, Gauss::<8>, 0.05, start).take(2000).last().unwrap().unwrap().state.q.into();
    macro_rules! scan {
        ($($s:literal)*) => {$(
            for steps in [100, 140, 200, 280, 400, 560, 800, 1120, 1600] {
                let (us, error, its) = median::<_, 2, $s>(&ring, &start, 100.0, steps, &end);
                println!("ring S={} h={:.3} {us:8.1} us error {error:.1e} iterations {its:.1} {:.0} ns/iteration", $s, 100.0 / f64::from(steps), us * 1e3 / f64::from(steps) / its);
            }
        )*};
    }
    scan!(4 6 8);
}
