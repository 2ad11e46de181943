//! The branch that a certificate tells, on both sides of folds and of conjugate points.
//!
//! Two oracles that know nothing of the certificate's matrix. Of linear systems y′ = Xy the equations of all
//! stages have the determinant Π D_S(hλ) det M^S, λ the eigenvalues of X and D_S the denominator of the
//! diagonal Padé approximant of order S. Of any system the branch of the flow is what steps from small h on,
//! each from the one before, lead to without a jump.

use dalembert::nalgebra::{SMatrix, SVector, vector};
use dalembert::system::ForcedLagrangian;
use dalembert::{Discrete, Discretise, Gauss, Midpoint, State, Trapezoidal, rayleigh_system};

use dalembert_tests::draws::Draws;

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
fn oscillator(q: [f64; 1], v: [f64; 1], m: f64, k: f64, r: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
}

/// Two oscillators x = a q₀ + b q₁, y = c q₀ + d q₁ that do not know of each other.
#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
fn mixed(q: [f64; 2], v: [f64; 2], a: [f64; 4], k: [f64; 2], r: [f64; 2]) -> (f64, f64) {
    let (x, y) = (a[0] * q[0] + a[1] * q[1], a[2] * q[0] + a[3] * q[1]);
    let (vx, vy) = (a[0] * v[0] + a[1] * v[1], a[2] * v[0] + a[3] * v[1]);
    (0.5 * (vx * vx + vy * vy) - 0.5 * (k[0] * x * x + k[1] * y * y), 0.5 * (r[0] * vx * vx + r[1] * vy * vy))
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
fn pendulum(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
fn double_well(q: [f64; 2], v: [f64; 2], r: f64) -> (f64, f64) {
    let inertia = 1.5 + 0.5 * q[0].sin();
    (
        0.5 * (inertia * v[0] * v[0] + v[1] * v[1]) - 0.25 * (q[0] * q[0] - 1.0).powi(2) - 0.5 * q[1] * q[1]
            + 0.2 * q[0] * q[1],
        0.5 * r * (v[0] * v[0] + v[0] * v[1] + v[1] * v[1]),
    )
}

/// Drag v²: p = v̄ + hr v̄²/2 by every rule of one node.
#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
fn squared(_q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0], r * v[0].powi(3) / 3.0)
}

fn on_the_branch<L, R: Copy, const N: usize>(
    system: &L,
    rule: R,
    state: &State<f64, N>,
    h: f64,
) -> Option<bool>
where
    L: Discrete<R, N, Scalar = f64>,
{
    let step = system.by(rule, h).step(state).ok()?;
    let certificate = system.by(rule, h).certificate(state, &step).ok()?;
    // The step's own equation is solved, whichever of several segments joins its ends.
    assert!(certificate.correction < 1e-6, "{certificate:?}");
    Some(certificate.on_the_branch_of_the_flow)
}

/// D_S(z) = Σ (2S − j)! S! / ((2S)! j! (S − j)!) (−z)ʲ, for z = x + iy: its real and imaginary part.
fn denominator(stages: u32, x: f64, y: f64) -> (f64, f64) {
    let (mut re, mut im) = (0.0, 0.0);
    let (mut power, mut coefficient) = ((1.0, 0.0), 1.0);
    for j in 0..=stages {
        re += coefficient * power.0;
        im += coefficient * power.1;
        power = (-power.0 * x + power.1 * y, -power.0 * y - power.1 * x);
        coefficient *= f64::from(stages - j) / f64::from((2 * stages - j) * (j + 1)).max(1.0);
    }
    (re, im)
}

/// The eigenvalues of q″ = −kq − rq′, and the sign of Π D_S(hλ); `None` near a zero.
fn sign(stages: u32, k: f64, r: f64, h: f64) -> Option<bool> {
    let discriminant = r * r - 4.0 * k;
    if discriminant < 0.0 {
        return Some(true);
    }
    let product =
        [1.0, -1.0].map(|sign| denominator(stages, 0.5 * h * (sign * discriminant.sqrt() - r), 0.0).0);
    (product[0].abs().min(product[1].abs()) > 1e-3).then_some(product[0] * product[1] > 0.0)
}

/// Compares, and counts the answers of each kind.
fn count(counts: &mut [usize; 2], found: Option<bool>, expected: Option<bool>, what: &str) {
    if let (Some(found), Some(expected)) = (found, expected) {
        assert_eq!(found, expected, "{what}");
        counts[usize::from(found)] += 1;
    }
}

/// Systems drawn by each rule.
const LINEAR: usize = if cfg!(debug_assertions) { 80 } else { 400 };

fn linear<const S: usize>(draws: &mut Draws, counts: &mut [usize; 2])
where
    Oscillator: ForcedLagrangian<1, Scalar = f64>,
{
    for _ in 0..LINEAR {
        let h = draws.between(0.2, 8.0);
        let (k, r, m) = (draws.between(-1.0, 3.0), draws.between(-3.0, 3.0), draws.scale(1e-3, 1e3));
        let state = State { q: vector![draws.between(-1.0, 1.0)], p: vector![m * draws.between(-1.0, 1.0)] };
        let system = Oscillator { m, k: k * m, r: r * m };
        let expected = sign(S as u32, k, r, h);
        let what = format!("Gauss<{S}>, k = {k}, r = {r}, h = {h}");
        count(counts, on_the_branch(&system, Gauss::<S>, &state, h), expected, &what);

        let (k2, r2) = (draws.between(-1.0, 3.0), draws.between(-3.0, 3.0));
        let a = [1.0, draws.between(-0.7, 0.7), draws.between(-0.7, 0.7), 1.3];
        let mixed = Mixed { a, k: [k, k2], r: [r, r2] };
        let state = State {
            q: vector![draws.between(-1.0, 1.0), draws.between(-1.0, 1.0)],
            p: vector![draws.between(-1.0, 1.0), draws.between(-1.0, 1.0)],
        };
        let expected = expected.zip(sign(S as u32, k2, r2, h)).map(|(a, b)| a == b);
        count(counts, on_the_branch(&mixed, Gauss::<S>, &state, h), expected, &format!("{what}, {k2}, {r2}"));
    }
}

#[test]
fn of_linear_systems_the_branch_is_that_of_the_pade_denominator() {
    let mut draws = Draws::new(1);
    let mut counts = [[0; 2]; 9];
    linear::<1>(&mut draws, &mut counts[1]);
    linear::<2>(&mut draws, &mut counts[2]);
    linear::<3>(&mut draws, &mut counts[3]);
    linear::<4>(&mut draws, &mut counts[4]);
    linear::<6>(&mut draws, &mut counts[6]);
    linear::<7>(&mut draws, &mut counts[7]);
    println!("{counts:?}");
    for (stages, [past, on]) in counts.into_iter().enumerate().filter(|(_, counts)| counts[1] > 0) {
        // D_S has a real zero for odd S, and none for even S.
        assert!(on > LINEAR && (past > LINEAR / 20) == (stages % 2 == 1), "{stages}: {past} {on}");
    }
    // One equation alone: midpoint as Gauss<1>, and trapezoidal, where det = m + hr/2.
    let mut counts = [[0; 2]; 2];
    for _ in 0..1000 {
        let (h, k, r) = (draws.between(0.2, 8.0), draws.between(-1.0, 3.0), draws.between(-3.0, 3.0));
        let state = State { q: vector![draws.between(-1.0, 1.0)], p: vector![draws.between(-1.0, 1.0)] };
        let system = Oscillator { m: 1.0, k, r };
        count(&mut counts[0], on_the_branch(&system, Midpoint, &state, h), sign(1, k, r, h), "midpoint");
        let expected = (1.0 + 0.5 * h * r).abs() > 1e-3;
        let expected = expected.then_some(1.0 + 0.5 * h * r > 0.0);
        count(&mut counts[1], on_the_branch(&system, Trapezoidal, &state, h), expected, "trapezoidal");
    }
    println!("{counts:?}");
    assert!(counts.iter().flatten().all(|&count| count > 150), "{counts:?}");
}

#[test]
fn past_a_conjugate_point_a_step_is_on_the_branch() {
    let system = Oscillator { m: 1.0, k: 1.0, r: 0.0 };
    let state = State { q: vector![0.3], p: vector![-0.2] };
    for h in [3.0, 3.3, 4.0, 5.0, 6.0, 6.2, 6.5, 9.0] {
        let step = system.by(Gauss::<6>, h).step(&state).unwrap();
        let certificate = system.by(Gauss::<6>, h).certificate(&state, &step).unwrap();
        assert!(certificate.on_the_branch_of_the_flow, "{h}: {certificate:?}");
        // Positive control of the case: ∂p0/∂v̄ has the sign of h/sin h.
        let segment = system.by(Gauss::<6>, h).segment(&state.q, &step.state.q).unwrap();
        assert_eq!(segment.legendre_derivatives().unwrap().p0_by_q1[0] > 0.0, h.sin() > 0.0, "{h}");
    }
}

/// The step at h that steps from small h on lead to, each from the one before; `None` where one fails, or
/// jumps.
fn continued<L, R, const N: usize>(system: &L, state: &State<f64, N>, h: f64) -> Option<SVector<f64, N>>
where
    L: Discrete<R, N, Scalar = f64>,
{
    const STEPS: u32 = 400;
    let mut velocity = system.step(state, h / f64::from(STEPS), None).ok()?.velocity;
    for k in 2..=STEPS {
        let next = system.step(state, h * f64::from(k) / f64::from(STEPS), Some(&velocity)).ok()?.velocity;
        if (next - velocity).norm() > 0.05 * (1.0 + velocity.norm()) {
            return None;
        }
        velocity = next;
    }
    Some(velocity)
}

#[derive(Default)]
struct Followed {
    on_the_branch: usize,
    /// Steps that the continuation leads to, past a change of sign of ∂p0/∂v̄.
    past_a_conjugate_point: usize,
}

fn follow<L, R: Copy, const N: usize>(
    system: &L,
    rule: R,
    state: &State<f64, N>,
    h: f64,
    followed: &mut Followed,
) where
    L: Discrete<R, N, Scalar = f64>,
{
    let Some(velocity) = continued::<L, R, N>(system, state, h) else { return };
    let Ok(step) = system.by(rule, h).step(state) else { return };
    if (step.velocity - velocity).norm() > 1e-9 * (1.0 + velocity.norm()) {
        return;
    }
    let Ok(certificate) = system.by(rule, h).certificate(state, &step) else { return };
    assert!(certificate.on_the_branch_of_the_flow, "{h} {state:?} {certificate:?}");
    followed.on_the_branch += 1;
    // Between two ends there may be another segment than the step's, or none that is found.
    let Ok(segment) = system.by(rule, h).segment(&state.q, &step.state.q) else { return };
    let Ok(k) = segment.legendre_derivatives() else { return };
    let matrix = k.p0_by_q1;
    followed.past_a_conjugate_point += usize::from(is_negative(matrix));
}

#[test]
fn what_small_steps_lead_to_is_on_the_branch() {
    let mut draws = Draws::new(2);
    let mut followed: [Followed; 5] = Default::default();
    let all = if cfg!(debug_assertions) { 8 } else { 120 };
    for _ in 0..all {
        let (h, r) = (draws.between(0.2, 6.0), draws.between(-0.3, 0.8));
        let (pendulum, state) = (
            Pendulum { r },
            State { q: vector![draws.between(-2.0, 2.0)], p: vector![draws.between(-1.0, 1.0)] },
        );
        follow(&pendulum, Midpoint, &state, h, &mut followed[0]);
        follow(&pendulum, Trapezoidal, &state, h, &mut followed[1]);
        follow(&pendulum, Gauss::<2>, &state, h, &mut followed[2]);
        follow(&pendulum, Gauss::<5>, &state, h, &mut followed[3]);
        let state = State {
            q: vector![draws.between(-1.5, 1.5), draws.between(-1.0, 1.0)],
            p: vector![draws.between(-1.0, 1.0), draws.between(-1.0, 1.0)],
        };
        follow(&DoubleWell { r }, Midpoint, &state, 0.5 * h, &mut followed[0]);
        follow(&DoubleWell { r }, Gauss::<4>, &state, h, &mut followed[4]);
    }
    for (index, Followed { on_the_branch, past_a_conjugate_point }) in followed.iter().enumerate() {
        println!("{index}: {on_the_branch} followed, {past_a_conjugate_point} past a conjugate point");
        assert!(*on_the_branch > all / 3, "{index}");
    }
    assert!(followed[2..].iter().all(|followed| followed.past_a_conjugate_point > all / 24));
}

#[test]
fn of_two_roots_one_is_on_the_branch() {
    let mut draws = Draws::new(3);
    for _ in 0..300 {
        let (r, h) = (draws.between(0.2, 2.0), draws.between(0.1, 1.0));
        // p = v̄ + hr v̄²/2 has the roots (−1 ± √(1 + 2hrp))/hr.
        let p = draws.between(-0.45, 2.0) / (h * r);
        let (system, state) = (Squared { r }, State { q: vector![0.0], p: vector![p] });
        let root = (1.0 + 2.0 * h * r * p).sqrt();
        for (velocity, expected) in [((root - 1.0) / (h * r), true), ((-1.0 - root) / (h * r), false)] {
            let guess = vector![velocity];
            check(&system, Midpoint, &state, &guess, h, expected);
            check(&system, Trapezoidal, &state, &guess, h, expected);
            check(&system, Gauss::<1>, &state, &guess, h, expected);
        }
    }
}

fn check<R: Copy>(
    system: &Squared,
    rule: R,
    state: &State<f64, 1>,
    guess: &SVector<f64, 1>,
    h: f64,
    expected: bool,
) where
    Squared: Discrete<R, 1, Scalar = f64>,
{
    let step = system.by(rule, h).near(guess).step(state).unwrap();
    assert!((step.velocity - guess).norm() < 1e-9 * guess.norm());
    let certificate = system.by(rule, h).certificate(state, &step).unwrap();
    assert_eq!(certificate.on_the_branch_of_the_flow, expected, "{h} {state:?} {step:?}");
}

/// Whether the determinant of a matrix of one or two rows is negative.
fn is_negative<const N: usize>(matrix: SMatrix<f64, N, N>) -> bool {
    match N {
        1 => matrix[0] < 0.0,
        _ => matrix[(0, 0)] * matrix[(1, 1)] < matrix[(0, 1)] * matrix[(1, 0)],
    }
}
