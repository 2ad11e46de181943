//! One R written in many ways: kinks are seen in all of them, and the motion is that of |v|.

use dalembert::nalgebra::SVector;
use dalembert::{Discretise, Proximal, State, StepError, rayleigh_system};

/// Systems of N coordinates on a spring under a load, with these R; the states of their runs.
macro_rules! written {
    ($run:ident, $n:literal, [$a:literal, $b:literal]; $($name:ident: |$this:ident, $v:ident| $r:expr),+ $(,)?) => {
        mod $run {
            use super::*;

            $(
                #[allow(dead_code, reason = "not all read both")]
                pub struct $name {
                    a: f64,
                    b: f64,
                    load: f64,
                }

                #[rayleigh_system(rule = proximal)]
                impl $name {
                    fn lagrangian(&self, q: [f64; $n], v: [f64; $n]) -> f64 {
                        let mut sum = 0.0;
                        for i in 0..$n {
                            sum += 0.5 * v[i] * v[i] - 0.5 * q[i] * q[i] + self.load * q[i];
                        }
                        sum
                    }

                    fn rayleigh(&self, $v: [f64; $n]) -> f64 {
                        let $this = self;
                        $r
                    }
                }
            )+

            pub fn runs(load: f64, start: State<f64, $n>, steps: usize) -> Vec<(&'static str, Vec<State<f64, $n>>)> {
                vec![$((stringify!($name), {
                    let system = $name { a: $a, b: $b, load };
                    let run = system.by(Proximal, 0.02).run(start).take(steps);
                    let states: Result<Vec<_>, StepError> = run.map(|step| Ok(step?.state)).collect();
                    states.unwrap_or_else(|error| panic!("{}: {error}", stringify!($name)))
                })),+]
            }
        }
    };
}

// Friction that grows with the velocity up to a limit, and quadratic drag.
written! { one, 1, [0.25, 0.025];
    Abs: |this, v| this.a * v[0].abs() - this.b * (-v[0].abs()).exp(),
    Max: |this, v| this.a * v[0].max(-v[0]) - this.b * (-v[0].abs()).exp(),
    MaxOfZero: |this, v| 2.0 * this.a * v[0].max(0.0) - this.a * v[0] - this.b * (-v[0].abs()).exp(),
    Root: |this, v| this.a * (v[0] * v[0]).sqrt() - this.b * (-(v[0] * v[0]).sqrt()).exp(),
    Norm: |this, v| this.a * v[0].hypot(0.0) - this.b * (-v[0].hypot(0.0)).exp(),
    Branch: |this, v| {
        let force = if v[0] > 0.0 { this.a * v[0] } else { -this.a * v[0] };
        force - this.b * (-v[0].abs()).exp()
    },
    Sign: |this, v| this.a * v[0].copysign(1.0) - this.b * (-v[0] * v[0].signum()).exp(),
}

written! { drag, 1, [0.25, 0.3];
    Cubed: |this, v| this.a * v[0].abs() + this.b * v[0].abs().powi(3),
    Beside: |this, v| this.a * v[0].abs() + this.b * v[0] * v[0] * v[0].abs(),
    Maximal: |this, v| (this.a + this.b * v[0] * v[0]) * v[0].max(-v[0]),
}

// Friction that differs by direction.
written! { plane, 2, [4.0, 0.5];
    Lengths: |_this, v| 0.2 * ((2.0 * v[0]).powi(2) + (v[1] / 2.0_f64.sqrt()).powi(2)).sqrt(),
    Fields: |this, v| 0.2 * (this.a * v[0] * v[0] + this.b * (v[1] * v[1])).sqrt(),
    Quotients: |this, v| 0.2 * (v[0] * v[0] / 0.25 + v[1] * v[1] / this.a * 2.0).sqrt(),
    Whole: |_this, v| 0.2 * (0.5 * (8.0 * v[0] * v[0] + v[1] * v[1])).sqrt(),
    InALoop: |this, v| {
        let mut sum = 0.0;
        let weights = [this.a, this.b];
        for i in 0..2 {
            sum += weights[i] * v[i] * v[i];
        }
        0.2 * sum.powf(0.5)
    },
}

/// How far two runs are apart at most.
fn apart<const N: usize>(a: &[State<f64, N>], b: &[State<f64, N>]) -> f64 {
    let of = |a: &SVector<f64, N>, b: &SVector<f64, N>| (a - b).amax();
    a.iter().zip(b).map(|(a, b)| of(&a.q, &b.q).max(of(&a.p, &b.p))).fold(0.0, f64::max)
}

fn alike<const N: usize>(runs: &[(&str, Vec<State<f64, N>>)]) {
    let (first, expected) = &runs[0];
    for (name, run) in runs {
        let apart = apart(run, expected);
        assert!(apart < 1e-12, "{name} and {first}: {apart:e}");
        // At rest, to the last bit.
        let [.., before, last] = &run[..] else { unreachable!() };
        assert!(last == before && last.p.amax() == 0.0, "{name}: {last:?}");
    }
}

#[test]
fn a_kink_is_one_however_it_is_written() {
    for (load, q, v) in [(0.0, 1.8, 0.4), (0.2, 0.0, 0.0), (0.276, 0.0, -0.0), (0.3, 0.1, -0.5)] {
        let start = |v| State { q: [q].into(), p: [v].into() };
        alike(&one::runs(load, start(v), 600));
        alike(&drag::runs(load, start(v), 600));
        alike(&plane::runs(load, State { q: [q, 0.3].into(), p: [v, -v].into() }, 800));
    }
    // The control.
    let start = State { q: [1.8].into(), p: [0.4].into() };
    let (a, b) = (one::runs(0.0, start, 300), drag::runs(0.0, start, 300));
    assert!(apart(&a[0].1, &b[0].1) > 1e-3);
}
