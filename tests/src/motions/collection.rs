//! The collection: families of motions with parameters at random.

use std::f64::consts::{PI, TAU};

use dalembert::tolerance::{WithGauss, WithSplittings};
use dalembert::{State, Trapezoidal};
use double_double::DoubleDouble;

use super::Motion;
use super::measured::Reference;
use super::reference::{Phase, extrapolated};
use super::systems::{
    Chain, DoublePendulum, Falling, Forced, HenonHeiles, Kepler, LINKS, Mathieu, Oscillator, Pair, Pendulum,
    ShakenPivot, Struck, Swing, TwoSprings,
};

/// All methods, of systems with explicit steps; those of others.
const EXPLICIT: WithGauss<WithSplittings<Trapezoidal>> = WithGauss(WithSplittings(Trapezoidal));
const IMPLICIT: WithGauss<Trapezoidal> = WithGauss(Trapezoidal);

/// Random numbers (G. Steele, D. Lea and C. Flood 2014).
pub struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn within(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn of_size(&mut self, from: f64, to: f64) -> f64 {
        self.within(from.ln(), to.ln()).exp()
    }

    /// A phase: any, or at one of four turns exactly.
    fn phase(&mut self) -> f64 {
        match self.next() % 3 {
            0 => PI / 2.0 * (self.next() % 4) as f64,
            _ => self.within(0.0, TAU),
        }
    }
}

fn double(x: f64) -> DoubleDouble {
    DoubleDouble::from(x)
}

fn nearest<const N: usize>([q, p]: Phase<N>) -> State<f64, N> {
    State { q: q.map(|x| x.high).into(), p: p.map(|x| x.high).into() }
}

/// A family and how one of its motions is made.
type Family = (&'static str, fn(&mut Random) -> Motion);

/// The families of a collection.
const FAMILIES: [Family; 14] = [
    ("oscillator", oscillator),
    ("oscillator, damped", damped_oscillator),
    ("pendulum", pendulum),
    ("pendulum, damped", damped_pendulum),
    ("Kepler", kepler),
    ("stiff pair", pair),
    ("kink", two_springs),
    ("pulse", struck),
    ("driven pendulum", forced),
    ("double pendulum", double_pendulum),
    ("double pendulum, chaotic", chaotic_double_pendulum),
    ("Hénon–Heiles", henon_heiles),
    ("Hénon–Heiles, chaotic", chaotic_henon_heiles),
    ("chain of 6", chain),
];

/// Those of another: what the motion's derivative does is told by the time, or its size by the motion alone.
const DRIVEN: [Family; 4] =
    [("Mathieu", mathieu), ("shaken pivot", shaken_pivot), ("swing", swing), ("falling from rest", falling)];

fn of(families: &[Family], seed: u64, count: usize) -> Vec<Motion> {
    let mut random = Random(seed);
    families.iter().cycle().take(count).map(|family| (family.1)(&mut random)).collect()
}

/// `count` motions, of each family in turn, from `seed`.
pub fn collection(seed: u64, count: usize) -> Vec<Motion> {
    of(&FAMILIES, seed, count)
}

/// `count` motions under parametric drives or from rest, of each of their families in turn, from `seed`.
pub fn driven(seed: u64, count: usize) -> Vec<Motion> {
    of(&DRIVEN, seed, count)
}

/// `count` motions of one family from `seed`; none where there is no such family.
pub fn of_family(name: &str, seed: u64, count: usize) -> Vec<Motion> {
    let of_name = FAMILIES.iter().chain(&DRIVEN).find(|family| family.0 == name);
    of_name.map_or_else(Vec::new, |&family| of(&[family], seed, count))
}

fn oscillator(random: &mut Random) -> Motion {
    let (m, k, a, phase) =
        (random.of_size(0.2, 5.0), random.of_size(0.2, 5.0), random.of_size(0.05, 3.0), random.phase());
    let frequency = (double(k) / double(m)).sqrt();
    let omega = frequency.high;
    let time =
        if random.next().is_multiple_of(3) { 32.0 * PI } else { random.of_size(1.0, 40.0) * TAU / omega };
    let (q, p) = (a * phase.cos(), -m * omega * a * phase.sin());
    let start = State {
        q: [if q.abs() < 1e-12 { 0.0 } else { q }].into(),
        p: [if p.abs() < 1e-12 { 0.0 } else { p }].into(),
    };
    let reference: Reference<1> = Box::new(move |times| {
        let (q0, p0) = (double(start.q[0]), double(start.p[0]));
        let at = |&t: &f64| {
            let (s, c) = (frequency * double(t)).sin_cos();
            let impedance = double(m) * frequency;
            nearest([[q0 * c + p0 / impedance * s], [p0 * c - q0 * impedance * s]])
        };
        times.iter().map(at).collect()
    });
    let what = format!("m {m:.3}, k {k:.3}, a {a:.3}, phase {phase:.3}, T {time:.2}");
    Motion::new("oscillator", what, Oscillator { m, k, r: 0.0 }, EXPLICIT, start, time, reference)
}

fn damped_oscillator(random: &mut Random) -> Motion {
    let (m, k, r) = (random.of_size(0.3, 3.0), random.of_size(0.3, 3.0), random.of_size(0.003, 10.0));
    let start = State { q: [random.within(-1.0, 1.0)].into(), p: [random.within(-1.0, 1.0)].into() };
    let time = random.of_size(2.0, 100.0);
    let acceleration = move |[q]: [DoubleDouble; 1], [v]: [DoubleDouble; 1], _| {
        [-(double(k) * q + double(r) * v) / double(m)]
    };
    let from = [[double(start.q[0])], [double(start.p[0]) / double(m)]];
    let reference: Reference<1> = Box::new(move |times| {
        let longest = (m / r).min(1.0);
        let states = extrapolated(&acceleration, from, times, longest);
        states.into_iter().map(|[q, [v]]| nearest([q, [v * double(m)]])).collect()
    });
    let what = format!("m {m:.3}, k {k:.3}, r {r:.3}, T {time:.2}");
    Motion::new("oscillator, damped", what, Oscillator { m, k, r }, EXPLICIT, start, time, reference)
}

fn pendulum_of(family: &'static str, r: f64, random: &mut Random) -> Motion {
    let start = match random.next() % 3 {
        0 => State { q: [random.within(-2.8, 2.8)].into(), p: [0.0].into() },
        1 => State { q: [0.0].into(), p: [random.within(-2.6, 2.6)].into() },
        _ => State { q: [random.within(-2.0, 2.0)].into(), p: [random.within(-2.0, 2.0)].into() },
    };
    let time = random.of_size(5.0, 200.0);
    let acceleration =
        move |[q]: [DoubleDouble; 1], [v]: [DoubleDouble; 1], _| [-q.sin_cos().0 - double(r) * v];
    let reference: Reference<1> = Box::new(move |times| {
        let from = [[double(start.q[0])], [double(start.p[0])]];
        extrapolated(&acceleration, from, times, 2.0).into_iter().map(nearest).collect()
    });
    let what = format!("r {r:.3}, q {:.3}, p {:.3}, T {time:.2}", start.q[0], start.p[0]);
    Motion::new(family, what, Pendulum { r }, EXPLICIT, start, time, reference)
}

fn pendulum(random: &mut Random) -> Motion {
    pendulum_of("pendulum", 0.0, random)
}

fn damped_pendulum(random: &mut Random) -> Motion {
    let r = random.of_size(0.003, 1.0);
    pendulum_of("pendulum, damped", r, random)
}

fn kepler(random: &mut Random) -> Motion {
    let (e, from) = (random.within(0.0, 0.9), random.within(0.0, TAU));
    let from = match random.next() % 3 {
        0 => 0.0,
        1 => PI,
        _ => from,
    };
    let time = random.of_size(0.5, 16.0) * TAU;
    // At the eccentric anomaly `from` of an orbit with semi-major axis 1.
    let (s, c) = from.sin_cos();
    let (s, c) = if from == 0.0 {
        (0.0, 1.0)
    } else if from == PI {
        (0.0, -1.0)
    } else {
        (s, c)
    };
    let b = (1.0 - e * e).sqrt();
    let r = 1.0 - e * c;
    let start = State { q: [c - e, b * s].into(), p: [-s / r, b * c / r].into() };
    let acceleration = |q: [DoubleDouble; 2], _: [DoubleDouble; 2], _| {
        let square = q[0] * q[0] + q[1] * q[1];
        let cube = square * square.sqrt();
        [-q[0] / cube, -q[1] / cube]
    };
    let reference: Reference<2> = Box::new(move |times| {
        let from = [[double(start.q[0]), double(start.q[1])], [double(start.p[0]), double(start.p[1])]];
        extrapolated(&acceleration, from, times, 2.0).into_iter().map(nearest).collect()
    });
    let what = format!("e {e:.3}, from {from:.3}, T {time:.2}");
    Motion::new("Kepler", what, Kepler {}, EXPLICIT, start, time, reference)
}

fn pair(random: &mut Random) -> Motion {
    let (kappa, angle) = (random.of_size(3.0, 200.0), random.phase());
    let (s, c) = angle.sin_cos();
    // What the matrix of the springs is to rounding is what the system has.
    let slow = [random.within(-1.0, 1.0), random.within(-1.0, 1.0)];
    let share = if random.next().is_multiple_of(3) { 0.0 } else { random.of_size(1e-4, 1.0) };
    let fast = [share * random.within(-1.0, 1.0) / kappa, share * random.within(-1.0, 1.0)];
    let start = State {
        q: [c * slow[0] - s * fast[0], s * slow[0] + c * fast[0]].into(),
        p: [c * slow[1] - s * fast[1], s * slow[1] + c * fast[1]].into(),
    };
    let time = random.of_size(3.0, 60.0);
    let reference: Reference<2> = Box::new(move |times| {
        // Modes of the very matrix: A = a aᵀ + κ² b bᵀ, a = (c, s), b = (−s, c), where c² + s² is 1 to
        // rounding alone.
        let (c, s) = (double(c), double(s));
        let square = double(kappa) * double(kappa);
        let [a, b, d] = [c * c + square * s * s, (double(1.0) - square) * c * s, s * s + square * c * c];
        let (half, mean) = ((d - a) * double(0.5), (a + d) * double(0.5));
        let root = (half * half + b * b).sqrt();
        let upper = mean + root;
        let lower = (a * d - b * b) / upper;
        // The mode of the upper value, by the longer of two expressions.
        let vector = |value: DoubleDouble| {
            let (x, y) = ([b, value - a], [value - d, b]);
            let length = |v: [DoubleDouble; 2]| v[0] * v[0] + v[1] * v[1];
            let v = if length(x).high > length(y).high { x } else { y };
            let size = length(v).sqrt();
            [v[0] / size, v[1] / size]
        };
        let modes = [(upper.sqrt(), vector(upper)), (lower.sqrt(), vector(lower))];
        let at = |&t: &f64| {
            let mut phase: Phase<2> = [[double(0.0); 2]; 2];
            for (frequency, mode) in modes {
                let along = |x: [f64; 2]| mode[0] * double(x[0]) + mode[1] * double(x[1]);
                let (q0, p0) = (along(start.q.into()), along(start.p.into()));
                let (s, c) = (frequency * double(t)).sin_cos();
                let (q, p) = (q0 * c + p0 / frequency * s, p0 * c - q0 * frequency * s);
                for i in 0..2 {
                    phase[0][i] = phase[0][i] + mode[i] * q;
                    phase[1][i] = phase[1][i] + mode[i] * p;
                }
            }
            nearest(phase)
        };
        times.iter().map(at).collect()
    });
    let what = format!("kappa {kappa:.2}, angle {angle:.3}, fast {share:.1e}, T {time:.2}");
    Motion::new("stiff pair", what, Pair { kappa, c, s }, EXPLICIT, start, time, reference)
}

fn two_springs(random: &mut Random) -> Motion {
    let k = random.of_size(1.1, 50.0);
    let (a, is_rest) = (random.of_size(0.1, 2.0), random.next().is_multiple_of(2));
    let q = if is_rest { -a } else { a * random.within(-1.0, 1.0) };
    let p = if is_rest { 0.0 } else { random.within(-1.0, 1.0) };
    let start = State { q: [q].into(), p: [p].into() };
    let time = random.of_size(2.0, 100.0);
    let reference: Reference<1> = Box::new(move |times| {
        // Half turns, right and left.
        let pi = double(PI) + double(1.224_646_799_147_353_2e-16);
        let (mut q, mut p) = (double(q), double(p));
        let mut t = double(0.0);
        let mut states = Vec::new();
        for &end in times {
            loop {
                let is_right = q.high > 0.0 || (q.high == 0.0 && p.high > 0.0);
                let frequency = if is_right { double(k).sqrt() } else { double(1.0) };
                // q = 0 next where the phase of (q, p/ω) reaches it: by the angle from there, found by
                // Newton's method.
                let side = if is_right { double(1.0) } else { double(-1.0) };
                let (x, y) = (side * q * frequency, side * p);
                let mut angle = double(y.high.atan2(x.high) + PI / 2.0);
                for _ in 0..3 {
                    let (s, c) = angle.sin_cos();
                    angle = angle - (x * c + y * s) / (y * c - x * s);
                }
                if angle.high <= 0.0 {
                    angle = angle + pi;
                }
                let until = t + angle / frequency;
                let left = double(end) - t;
                let ends = until.high >= end;
                let step = if ends { left } else { until - t };
                let (s, c) = (frequency * step).sin_cos();
                (q, p) = (q * c + p / frequency * s, p * c - q * frequency * s);
                if ends {
                    t = double(end);
                    break;
                }
                (q, t) = (double(0.0), until);
            }
            states.push(nearest([[q], [p]]));
        }
        states
    });
    let what = format!("k {k:.2}, q {:.3}, p {:.3}, T {time:.2}", start.q[0], start.p[0]);
    Motion::new("kink", what, TwoSprings { k }, EXPLICIT, start, time, reference)
}

fn struck(random: &mut Random) -> Motion {
    let time = random.of_size(10.0, 100.0);
    let at = if random.next().is_multiple_of(2) { 0.5 * time } else { random.within(0.2, 0.9) * time };
    let (force, width) = (random.of_size(0.1, 10.0), random.of_size(0.1, 2.0));
    let r = if random.next().is_multiple_of(2) { 0.0 } else { random.of_size(0.01, 0.3) };
    let start = State { q: [random.within(-1.5, 1.5)].into(), p: [random.within(-1.0, 1.0)].into() };
    let acceleration = move |[q]: [DoubleDouble; 1], [v]: [DoubleDouble; 1], t: DoubleDouble| {
        let x = (t - double(at)) / double(width);
        [double(force) * (-(x * x)).exp() - q.sin_cos().0 - double(r) * v]
    };
    let reference: Reference<1> = Box::new(move |times| {
        let from = [[double(start.q[0])], [double(start.p[0])]];
        extrapolated(&acceleration, from, times, 0.5 * width).into_iter().map(nearest).collect()
    });
    let what = format!("force {force:.2}, width {width:.2}, at {at:.2}, r {r:.2}, T {time:.2}");
    let system: &'static Struck = Box::leak(Box::new(Struck { r, force, at, width }));
    Motion::new("pulse", what, system.at_time(0.0), IMPLICIT, start, time, reference)
}

fn forced(random: &mut Random) -> Motion {
    let (r, force, frequency) =
        (random.of_size(0.02, 0.5), random.of_size(0.05, 1.0), random.of_size(0.3, 4.0));
    let start = State { q: [random.within(-1.5, 1.5)].into(), p: [random.within(-1.0, 1.0)].into() };
    let time = random.of_size(5.0, 60.0);
    let acceleration = move |[q]: [DoubleDouble; 1], [v]: [DoubleDouble; 1], t: DoubleDouble| {
        [double(force) * (double(frequency) * t).sin_cos().1 - q.sin_cos().0 - double(r) * v]
    };
    let reference: Reference<1> = Box::new(move |times| {
        let from = [[double(start.q[0])], [double(start.p[0])]];
        extrapolated(&acceleration, from, times, 2.0).into_iter().map(nearest).collect()
    });
    let what = format!("r {r:.2}, force {force:.2}, frequency {frequency:.2}, T {time:.2}");
    let system: &'static Forced = Box::leak(Box::new(Forced { r, force, frequency }));
    Motion::new("driven pendulum", what, system.at_time(0.0), IMPLICIT, start, time, reference)
}

fn double_pendulum_of(family: &'static str, size: f64, time: f64, random: &mut Random) -> Motion {
    let q = [random.within(-size, size), random.within(-size, size)];
    let v = if random.next().is_multiple_of(2) {
        [0.0; 2]
    } else {
        [random.within(-1.0, 1.0), random.within(-1.0, 1.0)]
    };
    let coupling = (q[0] - q[1]).cos();
    let start = State { q: q.into(), p: [2.0 * v[0] + coupling * v[1], v[1] + coupling * v[0]].into() };
    // From (q, p), so that what rounding makes of p at the start is no error.
    let reference: Reference<2> = Box::new(move |times| {
        let (s, c) = (double(start.q[0]) - double(start.q[1])).sin_cos();
        let _ = s;
        let determinant = double(2.0) - c * c;
        let (p0, p1) = (double(start.p[0]), double(start.p[1]));
        let v = [(p0 - c * p1) / determinant, (double(2.0) * p1 - c * p0) / determinant];
        let acceleration = |q: [DoubleDouble; 2], v: [DoubleDouble; 2], _: DoubleDouble| {
            let (s, c) = (q[0] - q[1]).sin_cos();
            let f0 = -(s * v[1] * v[1]) - double(2.0) * q[0].sin_cos().0;
            let f1 = s * v[0] * v[0] - q[1].sin_cos().0;
            let determinant = double(2.0) - c * c;
            [(f0 - c * f1) / determinant, (double(2.0) * f1 - c * f0) / determinant]
        };
        let from = [[double(start.q[0]), double(start.q[1])], v];
        let states = extrapolated(&acceleration, from, times, 1.0);
        let to_state = |[q, v]: Phase<2>| {
            let c = (q[0] - q[1]).sin_cos().1;
            nearest([q, [double(2.0) * v[0] + c * v[1], v[1] + c * v[0]]])
        };
        states.into_iter().map(to_state).collect()
    });
    let what = format!("q {:.3} {:.3}, v {:.3} {:.3}, T {time:.2}", q[0], q[1], v[0], v[1]);
    Motion::new(family, what, DoublePendulum {}, IMPLICIT, start, time, reference)
}

fn double_pendulum(random: &mut Random) -> Motion {
    let time = random.of_size(3.0, 60.0);
    double_pendulum_of("double pendulum", 0.7, time, random)
}

fn chaotic_double_pendulum(random: &mut Random) -> Motion {
    let time = random.of_size(3.0, 25.0);
    double_pendulum_of("double pendulum, chaotic", 3.0, time, random)
}

fn henon_heiles_of(family: &'static str, energy: f64, time: f64, random: &mut Random) -> Motion {
    let q = [random.within(-0.3, 0.3), random.within(-0.3, 0.3)];
    let potential = 0.5 * (q[0] * q[0] + q[1] * q[1]) + q[0] * q[0] * q[1] - q[1].powi(3) / 3.0;
    let speed = (2.0 * (energy - potential)).max(0.0).sqrt();
    let (s, c) = random.within(0.0, TAU).sin_cos();
    let start = State { q: q.into(), p: [speed * c, speed * s].into() };
    let acceleration = |q: [DoubleDouble; 2], _: [DoubleDouble; 2], _| {
        [-q[0] - double(2.0) * q[0] * q[1], -q[1] - q[0] * q[0] + q[1] * q[1]]
    };
    let reference: Reference<2> = Box::new(move |times| {
        let from = [[double(start.q[0]), double(start.q[1])], [double(start.p[0]), double(start.p[1])]];
        extrapolated(&acceleration, from, times, 2.0).into_iter().map(nearest).collect()
    });
    let what = format!("E {energy:.3}, q {:.3} {:.3}, T {time:.2}", q[0], q[1]);
    Motion::new(family, what, HenonHeiles {}, EXPLICIT, start, time, reference)
}

fn henon_heiles(random: &mut Random) -> Motion {
    let (energy, time) = (random.within(0.01, 0.1), random.of_size(10.0, 200.0));
    henon_heiles_of("Hénon–Heiles", energy, time, random)
}

fn chaotic_henon_heiles(random: &mut Random) -> Motion {
    let (energy, time) = (random.within(0.14, 0.165), random.of_size(10.0, 120.0));
    henon_heiles_of("Hénon–Heiles, chaotic", energy, time, random)
}

fn chain(random: &mut Random) -> Motion {
    let beta = random.of_size(0.1, 2.0);
    let r = if random.next().is_multiple_of(2) { 0.0 } else { random.of_size(0.003, 0.3) };
    let q: [f64; LINKS] = std::array::from_fn(|_| random.within(-1.0, 1.0));
    let p: [f64; LINKS] = std::array::from_fn(|_| random.within(-1.0, 1.0));
    let start = State { q: q.into(), p: p.into() };
    let time = random.of_size(5.0, 100.0);
    let acceleration = move |q: [DoubleDouble; LINKS], v: [DoubleDouble; LINKS], _: DoubleDouble| {
        let spring = |d: DoubleDouble| d + double(beta) * d * d * d;
        std::array::from_fn(|i| {
            let left = if i == 0 { q[0] } else { q[i] - q[i - 1] };
            let right = if i + 1 == LINKS { -q[i] } else { q[i + 1] - q[i] };
            spring(right) - spring(left) - double(r) * v[i]
        })
    };
    let reference: Reference<LINKS> = Box::new(move |times| {
        extrapolated(&acceleration, [q.map(double), p.map(double)], times, 1.0)
            .into_iter()
            .map(nearest)
            .collect()
    });
    let what = format!("beta {beta:.2}, r {r:.3}, T {time:.2}");
    Motion::new("chain of 6", what, Chain { beta, r }, EXPLICIT, start, time, reference)
}

/// A drive by its frequency, from that of the motion to 300 times as fast, and the time: 2000 radians of the
/// drive at most.
fn drive(random: &mut Random) -> [f64; 2] {
    let frequency = random.of_size(1.0, 300.0);
    [frequency, random.of_size(3.0, 60.0).min(2000.0 / frequency)]
}

fn mathieu(random: &mut Random) -> Motion {
    let [frequency, time] = drive(random);
    let a = random.of_size(0.05, 1.0) * if frequency > 3.0 { frequency } else { 1.0 };
    let r = if random.next().is_multiple_of(2) { 0.0 } else { random.of_size(0.003, 0.3) };
    let start = State { q: [random.within(-1.0, 1.0)].into(), p: [random.within(-1.0, 1.0)].into() };
    let acceleration = move |[q]: [DoubleDouble; 1], [v]: [DoubleDouble; 1], t: DoubleDouble| {
        let stiffness = double(1.0) + double(a) * (double(frequency) * t).sin_cos().1;
        [-(stiffness * q) - double(r) * v]
    };
    let reference: Reference<1> = Box::new(move |times| {
        let from = [[double(start.q[0])], [double(start.p[0])]];
        extrapolated(&acceleration, from, times, 2.0 / frequency).into_iter().map(nearest).collect()
    });
    let what = format!("a {a:.3}, frequency {frequency:.2}, r {r:.3}, T {time:.2}");
    let system: &'static Mathieu = Box::leak(Box::new(Mathieu { a, frequency, r }));
    Motion::new("Mathieu", what, system.at_time(0.0), IMPLICIT, start, time, reference)
}

fn shaken_pivot(random: &mut Random) -> Motion {
    let [frequency, time] = drive(random);
    // The upper equilibrium is stable from aΩ = √2 on.
    let a = random.of_size(0.1, 4.0) / frequency;
    let r = if random.next().is_multiple_of(2) { 0.0 } else { random.of_size(0.003, 0.3) };
    let around = if random.next().is_multiple_of(2) { 0.0 } else { PI };
    let start = State { q: [around + random.within(-1.0, 1.0)].into(), p: [random.within(-1.0, 1.0)].into() };
    // sin Ωt is 0 at the start, so that p is v there.
    let speed = move |t: DoubleDouble| -(double(a) * double(frequency) * (double(frequency) * t).sin_cos().0);
    let acceleration = move |[q]: [DoubleDouble; 1], [v]: [DoubleDouble; 1], t: DoubleDouble| {
        let push = double(a) * double(frequency) * double(frequency) * (double(frequency) * t).sin_cos().1;
        [(push - double(1.0)) * q.sin_cos().0 - double(r) * v]
    };
    let reference: Reference<1> = Box::new(move |times| {
        let from = [[double(start.q[0])], [double(start.p[0])]];
        let states = extrapolated(&acceleration, from, times, 2.0 / frequency).into_iter().zip(times);
        let to_state =
            |([[q], [v]], &t): (Phase<1>, &f64)| nearest([[q], [v + speed(double(t)) * q.sin_cos().0]]);
        states.map(to_state).collect()
    });
    let what = format!("a {a:.3}, frequency {frequency:.2}, r {r:.3}, about {around:.2}, T {time:.2}");
    let system: &'static ShakenPivot = Box::leak(Box::new(ShakenPivot { a, frequency, r }));
    Motion::new("shaken pivot", what, system.at_time(0.0), IMPLICIT, start, time, reference)
}

fn swing(random: &mut Random) -> Motion {
    let [frequency, time] = drive(random);
    let b = random.of_size(0.003, 0.3) / frequency.sqrt();
    let start = State { q: [random.within(-1.5, 1.5)].into(), p: [random.within(-1.0, 1.0)].into() };
    let length = move |t: DoubleDouble| {
        let (s, c) = (double(frequency) * t).sin_cos();
        [double(1.0) + double(b) * s, double(b) * double(frequency) * c]
    };
    let acceleration = move |[q]: [DoubleDouble; 1], [v]: [DoubleDouble; 1], t: DoubleDouble| {
        let [length, rate] = length(t);
        [-(q.sin_cos().0 + double(2.0) * rate * v) / length]
    };
    let reference: Reference<1> = Box::new(move |times| {
        let from = [[double(start.q[0])], [double(start.p[0])]];
        let states = extrapolated(&acceleration, from, times, 2.0 / frequency).into_iter().zip(times);
        let to_state = |([[q], [v]], &t): (Phase<1>, &f64)| {
            let [length, _] = length(double(t));
            nearest([[q], [length * length * v]])
        };
        states.map(to_state).collect()
    });
    let what = format!("b {b:.4}, frequency {frequency:.2}, T {time:.2}");
    let system: &'static Swing = Box::leak(Box::new(Swing { b, frequency }));
    Motion::new("swing", what, system.at_time(0.0), IMPLICIT, start, time, reference)
}

fn falling(random: &mut Random) -> Motion {
    let (g, c) = (random.of_size(0.1, 100.0), random.of_size(1e-3, 1.0));
    // At the origin, where its size is that of the motion alone, or elsewhere.
    let q = if random.next().is_multiple_of(2) { 0.0 } else { random.within(-10.0, 10.0) };
    let start = State { q: [q].into(), p: [0.0].into() };
    // Up to 30 times the time in which it comes to its final speed.
    let time = random.of_size(0.3, 30.0) / (g * c).sqrt();
    let acceleration = move |_: [DoubleDouble; 1], [v]: [DoubleDouble; 1], _: DoubleDouble| {
        let drag = double(c) * v * v;
        [if v.high < 0.0 { drag - double(g) } else { -drag - double(g) }]
    };
    let reference: Reference<1> = Box::new(move |times| {
        let longest = 1.0 / (g * c).sqrt();
        extrapolated(&acceleration, [[double(q)], [double(0.0)]], times, longest)
            .into_iter()
            .map(nearest)
            .collect()
    });
    let what = format!("g {g:.3}, c {c:.4}, from {q:.2}, T {time:.2}");
    Motion::new("falling from rest", what, Falling { g, c }, IMPLICIT, start, time, reference)
}
