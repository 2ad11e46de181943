//! Motions with closed forms, drawn at random over wide ranges: a result within what it claims, or an error
//! of the right name, within the evaluations that one question may take.

use std::cell::Cell;

use dalembert::exact::{Exact, ExactError};
use dalembert::nalgebra::{SMatrix, SVector, vector};
use dalembert::system::ActingForce;
use dalembert::system::Derivatives;
use dalembert::{Lagrangian, Rayleigh, State, rayleigh_system};
use dalembert_tests::draws::Draws;

type Vector = SVector<f64, 1>;

/// m q″ = −kq − rq′, whose evaluations are counted.
struct Counted {
    m: f64,
    k: f64,
    r: f64,
    evaluations: Cell<usize>,
}

impl Lagrangian<1> for Counted {
    type Scalar = f64;

    fn lagrangian(&self, q: &Vector, v: &Vector) -> f64 {
        0.5 * self.m * v[0] * v[0] - 0.5 * self.k * q[0] * q[0]
    }

    fn lagrangian_derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<f64, 1> {
        self.evaluations.set(self.evaluations.get() + 1);
        Derivatives {
            value: self.lagrangian(q, v),
            d1: q * -self.k,
            d2: v * self.m,
            d11: SMatrix::from_element(-self.k),
            d12: SMatrix::zeros(),
            d22: SMatrix::from_element(self.m),
        }
    }
}

impl Rayleigh<1> for Counted {
    fn rayleigh(&self, _q: &Vector, v: &Vector) -> f64 {
        0.5 * self.r * v[0] * v[0]
    }

    fn rayleigh_derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<f64, 1> {
        Derivatives {
            value: self.rayleigh(q, v),
            d1: SVector::zeros(),
            d2: v * self.r,
            d11: SMatrix::zeros(),
            d12: SMatrix::zeros(),
            d22: SMatrix::from_element(self.r),
        }
    }
}

impl ActingForce<1> for Counted {
    const HAS_RAYLEIGH: bool = true;

    fn dissipation_derivatives(&self, q: &Vector, v: &Vector) -> Derivatives<f64, 1> {
        self.rayleigh_derivatives(q, v)
    }
}

impl Counted {
    fn new(m: f64, k: f64, r: f64) -> Self {
        Self { m, k, r, evaluations: Cell::new(0) }
    }

    /// The evaluations since the last question, which are bounded.
    fn evaluations(&self) -> usize {
        let count = self.evaluations.take();
        // The start of a motion asks once or twice beside what is counted.
        assert!(count <= (1 << 22) + 100, "{count}");
        count
    }

    /// a = r/2m and the square of ω.
    fn rates(&self) -> (f64, f64) {
        let a = self.r / (2.0 * self.m);
        (a, self.k / self.m - a * a)
    }

    /// Velocities at both ends of the motion from q0 to q1 in the time h.
    fn ends(&self, q0: f64, q1: f64, h: f64) -> [f64; 2] {
        if h < 0.0 {
            let [v1, v0] = self.ends(q1, q0, -h);
            return [v0, v1];
        }
        let (a, square) = self.rates();
        if square > 0.0 {
            let omega = square.sqrt();
            let (sin, cos) = (omega * h).sin_cos();
            let v0 = omega * (q1 * (a * h).exp() - q0 * cos) / sin - a * q0;
            let v1 = -omega * (q0 * (-a * h).exp() - q1 * cos) / sin - a * q1;
            [v0, v1]
        } else {
            // By the exponentials e^{λt} with 0 ≥ λ₁ > λ₂, none of which overflows where r > 0.
            let kappa = (-square).sqrt();
            let fast = -a - kappa;
            let slow = -self.k / self.m / (a + kappa);
            let shrinkage = (-2.0 * kappa * h).exp();
            let one_less = -(-2.0 * kappa * h).exp_m1();
            let at_end = q1 * (-slow * h).exp();
            let (of_slow, of_fast) = ((at_end - q0 * shrinkage) / one_less, (q0 - at_end) / one_less);
            [
                slow * of_slow + fast * of_fast,
                slow * of_slow * (slow * h).exp() + fast * of_fast * (fast * h).exp(),
            ]
        }
    }

    /// ∂(q, v)(h)/∂(q, v)(0).
    fn flow(&self, h: f64) -> [[f64; 2]; 2] {
        let (a, square) = self.rates();
        let (c, s) = if square > 0.0 {
            let omega = square.sqrt();
            ((omega * h).cos() * (-a * h).exp(), (omega * h).sin() / omega * (-a * h).exp())
        } else {
            let kappa = (-square).sqrt();
            let (slow, fast) = (((kappa - a) * h).exp(), ((-kappa - a) * h).exp());
            let s = if kappa * h.abs() < 1e-6 { h * (-a * h).exp() } else { 0.5 * (slow - fast) / kappa };
            (0.5 * (slow + fast), s)
        };
        [[c + a * s, s], [-self.k / self.m * s, c - a * s]]
    }
}

fn oscillator(draws: &mut Draws) -> (Counted, f64) {
    let m = draws.scale(1e-2, 1e2);
    let h = draws.sign() * draws.scale(1e-3, 20.0);
    let system = match draws.below(4) {
        // Weakly damped, damped beyond the critical, stiffly damped, near the critical.
        0 => {
            let omega = draws.scale(1e-2, 400.0 / h.abs());
            Counted::new(m, m * omega * omega, m * draws.between(0.0, 20.0_f64.min(20.0 / h.abs())))
        }
        1 => {
            let r = draws.scale(0.1, 50.0) / h.abs();
            Counted::new(m, m * r * r * draws.between(0.0, 0.2), m * r)
        }
        2 => {
            let r = draws.scale(1e2, 1e5) / h.abs();
            Counted::new(m, m * r * draws.scale(1e-3, 3.0) / h.abs(), m * r)
        }
        _ => {
            let r = draws.scale(0.1, 10.0) / h.abs();
            Counted::new(m, m * 0.25 * r * r * (1.0 + draws.between(-0.1, 0.1)), m * r)
        }
    };
    (system, h)
}

#[test]
fn segments_of_random_damped_oscillators() {
    let mut draws = Draws::new(11);
    let (mut found, mut errors, mut most, mut worst) = (0, Vec::new(), 0, 0.0_f64);
    let all = if cfg!(debug_assertions) { 12 } else { 400 };
    for draw in 0..all {
        let (system, h) = oscillator(&mut draws);
        let (q0, q1) = (draws.between(-1.0, 1.0), draws.between(-1.0, 1.0));
        let result = Exact::new(&system).segment([q0], [q1], h);
        most = most.max(system.evaluations());
        let (a, square) = system.rates();
        let what =
            format!("{draw}: m = {}, k = {}, r = {}, h = {h}, {q0} to {q1}", system.m, system.k, system.r);
        let phase = if square > 0.0 { (square.sqrt() * h).sin().abs() } else { 1.0 };
        match result {
            Ok(segment) => {
                found += 1;
                let [v0, v1] = system.ends(q0, q1, h);
                // The fastest of the motion; the closed form itself loses digits where its arguments are
                // large, or close to a zero.
                let fastest =
                    v0.abs().max(v1.abs()).max(a.abs().max(square.abs().sqrt()) * q0.abs().max(q1.abs()));
                let of_closed_form =
                    4.0 * f64::EPSILON * (1.0 + square.abs().sqrt().max(a) * h.abs() / phase) / phase;
                let tolerance = (100.0 * segment.report.error() + of_closed_form) * fastest;
                let error = (segment.v0[0] - v0).abs().max((segment.v1[0] - v1).abs());
                assert!(error <= tolerance, "{what}: {error:e} > {tolerance:e}\n{segment}");
                let p = [segment.p0.value[0] - system.m * v0, segment.p1.value[0] - system.m * v1];
                assert!(p[0].abs().max(p[1].abs()) <= system.m * tolerance, "{what}\n{segment}");
                worst = worst.max(segment.report.error());
            }
            Err(error) => {
                let right = match error {
                    ExactError::ConjugatePoints { .. } => phase < 1e-6,
                    // An undamped end that the other cannot tell: many periods, or close to a conjugate
                    // point.
                    ExactError::IllConditioned { .. } => square > 0.0 && (a * h).abs() > 1.0,
                    _ => false,
                };
                assert!(right, "{what}: {error}");
                errors.push(error);
            }
        }
    }
    println!("{found} segments, worst error claimed {worst:.1e}, at most {most} evaluations; {errors:?}");
    assert!(found > all * 19 / 20);
}

#[test]
fn flows_of_random_damped_oscillators() {
    let mut draws = Draws::new(12);
    let (mut found, mut ill, mut overflow, mut most) = (0, 0, 0, 0);
    let all = if cfg!(debug_assertions) { 16 } else { 400 };
    for draw in 0..all {
        let (system, h) = oscillator(&mut draws);
        let (q, v) = (draws.between(-1.0, 1.0), draws.between(-1.0, 1.0));
        let start = State { q: vector![q], p: vector![system.m * v] };
        let result = Exact::new(&system).flow(&start, h);
        most = most.max(system.evaluations());
        let flow = system.flow(h);
        let (q1, v1) = (flow[0][0] * q + flow[0][1] * v, flow[1][0] * q + flow[1][1] * v);
        let (a, square) = system.rates();
        let rate = square.abs().sqrt().max(a);
        // What rounding of the start and of the closed form's arguments makes.
        let by_q = (flow[0][0] * q).abs() + (flow[0][1] * v).abs();
        let by_v = (flow[1][0] * q).abs() + (flow[1][1] * v).abs();
        let rounding = f64::EPSILON * (10.0 + rate * h.abs());
        let what = format!("{draw}: m = {}, k = {}, r = {}, h = {h}", system.m, system.k, system.r);
        match result {
            Ok(end) => {
                found += 1;
                let (largest_q, largest_v) =
                    (q.abs().max(q1.abs()), v.abs().max(v1.abs()).max(rate * q.abs()));
                assert!(
                    (end.q[0] - q1).abs() <= 20.0 * rounding * (by_q + largest_q + v.abs() * h.abs()),
                    "{what}: {end:?} {q1}"
                );
                assert!(
                    (end.p[0] / system.m - v1).abs() <= 20.0 * rounding * (by_v + largest_v),
                    "{what}: {end:?} {v1}"
                );
            }
            Err(ExactError::IllConditioned { error, .. }) => {
                ill += 1;
                let largest = q.abs().max(q1.abs());
                assert!(f64::EPSILON * by_q.max(by_v / rate) > 1e-8 * largest.min(by_q), "{what}: {error:e}");
            }
            Err(error @ (ExactError::MotionNotFinite { .. } | ExactError::Unresolved { .. })) => {
                overflow += 1;
                assert!(
                    !(q1.is_finite() && v1.is_finite() && (a + rate) * h.abs() < 330.0),
                    "{what}: {error}"
                );
            }
            Err(error) => panic!("{what}: {error}"),
        }
    }
    println!("{found} flows, {ill} ill conditioned, {overflow} beyond √f64::MAX, at most {most} evaluations");
    assert!(found > all * 5 / 8);
}

/// Quadratic drag by R = r v³/3, which accelerates backward motion.
#[rayleigh_system]
fn cubic(_q: [f64; 1], v: [f64; 1], m: f64, r: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0], r * v[0].powi(3) / 3.0)
}

#[test]
fn flows_of_random_cubic_drag() {
    let mut draws = Draws::new(13);
    let (mut found, mut escaped) = (0, 0);
    let all = if cfg!(debug_assertions) { 25 } else { 200 };
    for draw in 0..all {
        let (m, r) = (draws.scale(1e-2, 1e2), draws.scale(1e-2, 1e2));
        let (v, h) = (draws.sign() * draws.scale(1e-2, 1e2), draws.sign() * draws.scale(1e-3, 1e2));
        let system = Cubic { m, r };
        let growth = r * v * h / m;
        let result = Exact::new(&system).flow(&State { q: vector![0.3], p: vector![m * v] }, h);
        let what = format!("{draw}: m = {m}, r = {r}, v = {v}, h = {h}");
        match result {
            Ok(end) => {
                found += 1;
                let (q1, v1) = (0.3 + m / r * growth.ln_1p(), v / (1.0 + growth));
                // One rounding of v moves 1 + rvh/m by as much.
                let sensitive = 1.0 + growth.abs() / (1.0 + growth);
                let way = 0.3 + (q1 - 0.3).abs() + m / r * growth.abs() / (1.0 + growth);
                assert!((end.q[0] - q1).abs() <= 2e-14 * way, "{what}: {end:?} {q1}");
                assert!(
                    (end.p[0] - m * v1).abs() <= 2e-14 * m * v.abs().max(v1.abs()) * sensitive,
                    "{what}: {end:?}"
                );
            }
            Err(ExactError::MotionNotFinite { time }) => {
                escaped += 1;
                // v is infinite at t = −m/(rv).
                assert!(growth < -0.999 && (time * r * v / m + 1.0).abs() < 1e-3, "{what}: {time}");
            }
            Err(error) => panic!("{what}: {error}"),
        }
    }
    println!("{found} flows, {escaped} escapes");
    assert!(found > all * 2 / 5 && escaped > all / 10, "{found} {escaped}");
}

/// Free fall with drag c|v|v.
#[rayleigh_system]
fn falling(q: [f64; 1], v: [f64; 1], m: f64, g: f64, c: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0] - m * g * q[0], c * v[0].abs().powi(3) / 3.0)
}

#[test]
fn falls_with_drag_from_rest() {
    let mut draws = Draws::new(14);
    for draw in 0..if cfg!(debug_assertions) { 12 } else { 100 } {
        let (m, g, c) = (draws.scale(1e-2, 1e2), draws.scale(0.1, 1e2), draws.scale(1e-3, 1e2));
        let terminal = (m * g / c).sqrt();
        let h = draws.scale(1e-2, 50.0) * terminal / g;
        let system = Falling { m, g, c };
        let end = Exact::new(&system).flow(&State { q: vector![0.0], p: vector![0.0] }, h).unwrap();
        let x = g * h / terminal;
        let way = terminal * terminal / g * (x - std::f64::consts::LN_2 + (-2.0 * x).exp().ln_1p());
        assert!(
            (end.q[0] + way).abs() < 1e-13 * terminal * terminal / g * (1.0 + x),
            "{draw}: {end:?} {way}"
        );
        assert!((end.p[0] / (m * terminal) + x.tanh()).abs() < 1e-13, "{draw}: {end:?}");
    }
}

/// A force F cos(wt).
struct Forced {
    m: f64,
    k: f64,
    amplitude: f64,
    w: f64,
}

#[rayleigh_system]
impl Forced {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * self.m * v[0] * v[0] - 0.5 * self.k * q[0] * q[0]
    }

    fn force(&self, _q: [f64; 1], _v: [f64; 1], t: f64) -> [f64; 1] {
        [self.amplitude * (self.w * t).cos()]
    }
}

#[test]
fn oscillators_forced_in_time() {
    let mut draws = Draws::new(15);
    for draw in 0..if cfg!(debug_assertions) { 10 } else { 150 } {
        let (m, omega) = (draws.scale(0.1, 10.0), draws.scale(0.1, 10.0));
        let w = omega * [draws.between(0.1, 0.8), draws.between(1.2, 4.0)][draws.below(2)];
        let system = Forced { m, k: m * omega * omega, amplitude: draws.between(0.1, 2.0), w };
        let (t0, h) = (draws.between(-5.0, 5.0), draws.sign() * draws.scale(1e-2, 20.0));
        let (q, v) = (draws.between(-1.0, 1.0), draws.between(-1.0, 1.0));
        let share = system.amplitude / (m * (omega * omega - w * w));
        let (b, c) = (q - share * (w * t0).cos(), (v + share * w * (w * t0).sin()) / omega);
        let (sin, cos) = (omega * h).sin_cos();
        let q1 = b * cos + c * sin + share * (w * (t0 + h)).cos();
        let v1 = omega * (c * cos - b * sin) - share * w * (w * (t0 + h)).sin();
        let view = system.at_time(t0);
        let exact = Exact::new(&view);
        let end = exact.flow(&State { q: vector![q], p: vector![m * v] }, h).unwrap();
        let size = b.abs() + c.abs() + share.abs();
        let tolerance = 1e-14 * (1.0 + (omega + w) * (h.abs() + t0.abs())) * size;
        assert!((end.q[0] - q1).abs() < tolerance, "{draw}: {end:?} {q1}");
        assert!((end.p[0] / m - v1).abs() < tolerance * (omega + w), "{draw}: {end:?} {v1}");
        if sin.abs() > 0.1 {
            let segment = exact.segment([q], [q1], h).unwrap();
            assert!((segment.v0[0] - v).abs() < 100.0 * tolerance * (omega + w), "{draw}: {segment} {v}");
        }
    }
}

/// Friction in L alone: L = e^{ct}(½v² − ½kq²) moves as q″ = −kq − cq′ does.
struct Shrinking {
    k: f64,
    c: f64,
}

#[rayleigh_system]
impl Shrinking {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
        (self.c * t).exp() * (0.5 * v[0] * v[0] - 0.5 * self.k * q[0] * q[0])
    }
}

#[test]
fn a_mass_that_grows_with_time_damps() {
    let mut draws = Draws::new(16);
    for draw in 0..if cfg!(debug_assertions) { 15 } else { 150 } {
        let (k, c) = (draws.scale(1e-2, 10.0), draws.between(-1.0, 2.0));
        let (t0, h) = (draws.between(-2.0, 2.0), draws.sign() * draws.scale(1e-2, 4.0));
        let (q, v) = (draws.between(-1.0, 1.0), draws.between(-1.0, 1.0));
        let flow = Counted::new(1.0, k, c).flow(h);
        let (q1, v1) = (flow[0][0] * q + flow[0][1] * v, flow[1][0] * q + flow[1][1] * v);
        let system = Shrinking { k, c };
        let view = system.at_time(t0);
        let mass = |t: f64| (c * t).exp();
        let end = Exact::unforced(&view).flow(&State { q: vector![q], p: vector![mass(t0) * v] }, h).unwrap();
        let size = flow.iter().flatten().fold(1.0_f64, |size, entry| size.max(entry.abs()));
        assert!((end.q[0] - q1).abs() < 1e-13 * size, "{draw}: {end:?} {q1}");
        assert!((end.p[0] / mass(t0 + h) - v1).abs() < 1e-13 * size, "{draw}: {end:?} {v1}");
    }
}

#[test]
fn motions_that_were_refused_or_took_long() {
    // Cubic drag from v = 2 over h = 10: q = ln 21.
    let end = Exact::new(&Cubic { m: 1.0, r: 1.0 }).flow(&State { q: vector![0.0], p: vector![2.0] }, 10.0);
    assert!((end.unwrap().q[0] - 21.0_f64.ln()).abs() < 1e-14);
    // A stiff spring, 80 periods.
    let system = Counted::new(1.0, 1e4, 1.0);
    let end = Exact::new(&system).flow(&State { q: vector![0.4], p: vector![0.3] }, 5.0).unwrap();
    let flow = system.flow(5.0);
    assert!((end.q[0] - flow[0][0] * 0.4 - flow[0][1] * 0.3).abs() < 1e-13);
    // Damping that is stiff, seen backwards: told by the end.
    let far: &[f64] = if cfg!(debug_assertions) { &[] } else { &[-0.2, -0.3, -0.5, -5.0] };
    for &h in [-0.1].iter().chain(far) {
        let system = Counted::new(1.0, 1.0, 1e3);
        let segment = Exact::new(&system).segment([0.3], [0.5], h).unwrap();
        let evaluations = system.evaluations();
        let [v0, v1] = system.ends(0.3, 0.5, h);
        assert!(
            (segment.v0[0] - v0).abs() < 1e-12 * v1.abs() && (segment.v1[0] - v1).abs() < 1e-12 * v1.abs()
        );
        println!("h = {h}: {evaluations} evaluations, {}", segment.report);
        // The flow has no other end to be told by.
        let start = State { q: vector![0.3], p: vector![0.2] };
        let error = Exact::new(&system).flow(&start, h);
        println!("{error:?}");
    }
}

#[test]
#[cfg_attr(debug_assertions, ignore = "minutes without optimisation: cargo test --release")]
fn work_is_bounded_and_said() {
    // 10⁷ periods.
    let system = Counted::new(1.0, 1.0, 0.0);
    let error = Exact::new(&system).flow(&State { q: vector![0.3], p: vector![0.2] }, 6e7).unwrap_err();
    assert!(matches!(error, ExactError::TooMuchWork { time, .. } if time > 0.0 && time < 6e7), "{error}");
    assert!(system.evaluations() > 1 << 19);
    let error = Exact::new(&system).segment([0.3], [0.2], 6e7).unwrap_err();
    assert!(matches!(error, ExactError::TooMuchWork { .. }), "{error}");
    system.evaluations();
}
