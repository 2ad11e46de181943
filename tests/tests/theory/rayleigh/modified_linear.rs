//! The modified system of a linear system by any method: log A.

use dalembert::nalgebra::{DMatrix, Matrix2, SMatrix, Vector2, vector};
use dalembert::rayleigh::modified::{ModifiedLinearSystem, ModifiedLinearSystemError};
use dalembert::step::Flow;
use dalembert::{
    Composition, Discretise, Fitted, FittedTrapezoidal, Gauss, Midpoint, Splitting, State, Trapezoidal,
    rayleigh_system,
};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// M q̈ + C q̇ + K q = 0, entries (0, 0), (0, 1), (1, 1) of each.
#[derive(Clone, Copy, Debug)]
struct Pair {
    m: [f64; 3],
    c: [f64; 3],
    k: [f64; 3],
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss, fitted, fitted_trapezoidal])]
impl Pair {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let ([a, b, c], [d, e, f]) = (self.m, self.k);
        0.5 * (a * v[0] * v[0] + 2.0 * b * v[0] * v[1] + c * v[1] * v[1])
            - 0.5 * (d * q[0] * q[0] + 2.0 * e * q[0] * q[1] + f * q[1] * q[1])
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        let [a, b, c] = self.c;
        0.5 * (a * v[0] * v[0] + 2.0 * b * v[0] * v[1] + c * v[1] * v[1])
    }
}

fn full([a, b, c]: [f64; 3]) -> Matrix2<f64> {
    Matrix2::new(a, b, b, c)
}

/// A positive definite matrix.
fn definite(random: &mut StdRng, size: f64) -> [f64; 3] {
    let [a, b, c] = [0.4..1.5, -0.5..0.5, 0.4..1.5].map(|range| random.random_range(range));
    [a * a * size, a * b * size, (b * b + c * c) * size]
}

fn draw(random: &mut StdRng) -> Pair {
    Pair { m: definite(random, 1.0), c: definite(random, 0.2), k: definite(random, 1.0) }
}

fn states(random: &mut StdRng) -> [State<f64, 2>; 2] {
    let mut entry = || random.random_range(-1.0..1.0);
    [0; 2].map(|_| State { q: vector![entry(), entry()], p: vector![entry(), entry()] })
}

/// exp(`matrix`) by Taylor's series of an eighth of it, squared three times.
fn exponential(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let (n, small) = (matrix.nrows(), matrix / 8.0);
    let (mut sum, mut term) = (DMatrix::identity(n, n), DMatrix::identity(n, n));
    for k in 1..60 {
        term = term * &small / f64::from(k);
        sum += &term;
    }
    (0..3).fold(sum, |sum, _| &sum * &sum)
}

/// The largest difference between the q of a run and the motion of M̃q̈ + C̃q̇ + K̃q = 0 through them, by the
/// matrix exponential of its companion matrix.
fn off_the_motion<M>(
    system: &Pair,
    method: M,
    h: f64,
    start: State<f64, 2>,
    modified: &ModifiedLinearSystem<2>,
) -> f64
where
    Pair: Flow<M, 2, Scalar = f64>,
{
    let inverse = modified.mass.try_inverse().unwrap();
    let mut companion = DMatrix::zeros(4, 4);
    companion.view_mut((0, 2), (2, 2)).copy_from(&Matrix2::<f64>::identity());
    companion.view_mut((2, 0), (2, 2)).copy_from(&-(inverse * modified.stiffness));
    companion.view_mut((2, 2), (2, 2)).copy_from(&-(inverse * modified.damping));
    let step = exponential(&(companion * h));
    let v = modified.velocity(&start);
    let mut motion = DMatrix::from_column_slice(4, 1, &[start.q[0], start.q[1], v[0], v[1]]);
    let mut worst: f64 = 0.0;
    for state in system.by(method, h).run(start).take(40).map(|step| step.unwrap().state) {
        motion = &step * motion;
        worst = worst.max((state.q - Vector2::new(motion[0], motion[1])).amax());
    }
    worst
}

/// What is found of a method: the modified system, how far the run is off its motion, and C̃ and K̃ by the
/// formulas that hold for methods with BA symmetric, B = [[C, I], [I, 0]].
struct Case {
    name: &'static str,
    found: Result<(ModifiedLinearSystem<2>, f64), ModifiedLinearSystemError>,
}

fn cases(system: &Pair, h: f64, states: &[State<f64, 2>; 2]) -> Vec<Case> {
    fn of<M: Copy>(name: &'static str, system: &Pair, method: M, h: f64, states: &[State<f64, 2>; 2]) -> Case
    where
        Pair: Flow<M, 2, Scalar = f64>,
    {
        let found = system.by(method, h).modified_linear_system(states).map(|modified| {
            let off = off_the_motion(system, method, h, states[0], &modified);
            (modified, off)
        });
        Case { name, found }
    }
    vec![
        of("midpoint", system, Midpoint, h, states),
        of("trapezoidal", system, Trapezoidal, h, states),
        of("Gauss 1", system, Gauss::<1>, h, states),
        of("Gauss 2", system, Gauss::<2>, h, states),
        of("Gauss 3", system, Gauss::<3>, h, states),
        of("Gauss 4", system, Gauss::<4>, h, states),
        of("Gauss 5", system, Gauss::<5>, h, states),
        of("Gauss 6", system, Gauss::<6>, h, states),
        of("Gauss 7", system, Gauss::<7>, h, states),
        of("Gauss 8", system, Gauss::<8>, h, states),
        of("fitted trapezoidal", system, FittedTrapezoidal, h, states),
        of("Blanes–Moan 4", system, Splitting::blanes_moan_4(), h, states),
        of("Blanes–Moan 6", system, Splitting::blanes_moan_6(), h, states),
        of("Kahan–Li 6", system, Composition::kahan_li_6(Midpoint), h, states),
        of("Kahan–Li 8", system, Composition::kahan_li_8(Trapezoidal), h, states),
        of("Kahan–Li 6 of fitted", system, Composition::kahan_li_6(FittedTrapezoidal), h, states),
    ]
}

/// Every method, every damping: a Rayleigh system, and the q of the run on its motion.
#[test]
fn runs_of_linear_systems_lie_on_motions_of_rayleigh_systems() {
    let mut random = StdRng::seed_from_u64(11);
    let (mut held, mut ringing, mut furthest, mut most) = (0, 0, 0.0_f64, 0.0_f64);
    let systems = if cfg!(debug_assertions) { 3 } else { 15 };
    for _ in 0..systems {
        let (system, states) = (draw(&mut random), states(&mut random));
        for Case { name, found } in cases(&system, 0.2, &states) {
            match found {
                Ok((modified, off)) => {
                    held += 1;
                    assert!(modified.is_rayleigh(), "{name} of {system:?}\n{modified}");
                    // The checkers' allowance of roundings, for each of 40 steps.
                    assert!(off < 40.0 * 1024.0 * f64::EPSILON, "{name} of {system:?}: {off:e}");
                    furthest = furthest.max(off);
                    let asymmetries = [modified.of_mass, modified.of_damping, modified.of_stiffness];
                    most = asymmetries.iter().fold(most, |most, found| most.max(found.value.abs()));
                    // C̃ = C − b⁻¹a − aᵀb⁻¹, K̃ = aᵀb⁻¹a − Ca − c.
                    let (c, field, m) = (full(system.c), modified.field, modified.mass);
                    let (a, size) = (field.q_by_q, 1.0 / 0.2 / 0.2);
                    let damping = c - m * a - a.transpose() * m;
                    let stiffness = a.transpose() * m * a - c * a - field.p_by_q;
                    assert!((damping - modified.damping).amax() < 1e-12 * size, "{name} of {system:?}");
                    assert!((stiffness - modified.stiffness).amax() < 1e-12 * size, "{name} of {system:?}");
                }
                // Where hr > 2m for some mode.
                Err(ModifiedLinearSystemError::NegativeEigenvalue { eigenvalue }) => {
                    ringing += 1;
                    assert!(eigenvalue < 0.0, "{name}");
                }
                Err(error) => panic!("{name} of {system:?}: {error}"),
            }
        }
    }
    println!("{held} held, off by {furthest:.1e} at most, asymmetry {most:.1e}; {ringing} ring");
    assert!(held > 15 * systems);
    // The control: a motion of the system itself.
    let (system, states) = (draw(&mut random), states(&mut random));
    let mut modified = system.by(Midpoint, 0.4).modified_linear_system(&states).unwrap();
    modified.damping = full(system.c);
    assert!(off_the_motion(&system, Midpoint, 0.4, states[0], &modified) > 1e-4);
}

/// One coordinate, in closed form: with μ the eigenvalue of X and μ̃ = (2/h) artanh(hμ/2), log A/h = α + βX.
#[test]
fn one_coordinate_in_closed_form() {
    #[rayleigh_system]
    fn single(q: [f64; 1], v: [f64; 1], m: f64, r: f64, k: f64) -> (f64, f64) {
        (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
    }
    let states = [0.3, -0.7].map(|q| State { q: vector![q], p: vector![0.2] });
    // Midpoint turns by less than π in steps of any size: hω = 45 in the last.
    for (m, r, k, h) in
        [(1.3, 0.4, 2.0, 0.5), (2.0, 0.0, 1.0, 1.5), (0.7, 0.1, 3.0, 4.0), (1.0, 0.01, 2000.0, 1.0)]
    {
        let modified = Single { m, r, k }.by(Midpoint, h).modified_linear_system(&states).unwrap();
        let (decay, frequency) = (-r / (2.0 * m), (k / m - r * r / (4.0 * m * m)).sqrt());
        // artanh z = ½ ln((1 + z)/(1 − z)).
        let (x, y) = (0.5 * h * decay, 0.5 * h * frequency);
        let magnitude = 0.5 * (((1.0 + x).powi(2) + y * y) / ((1.0 - x).powi(2) + y * y)).ln();
        let angle = y.atan2(1.0 + x) + y.atan2(1.0 - x);
        let (decay, rate) = (magnitude / h, angle / h);
        let mass = m * frequency / rate;
        let expected = [mass, -2.0 * decay * mass, (decay * decay + rate * rate) * mass];
        let found = [modified.mass[0], modified.damping[0], modified.stiffness[0]];
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12 * expected.abs().max(k), "{found} {expected}");
        }
        assert!(modified.is_rayleigh() && modified.is_dissipative());
    }
}

/// To O(h⁴), what the midpoint rule has for any V: M̃ = M + (h²/12)(K − CM⁻¹C), C̃ = C − (h²/12)(CM⁻¹K +
/// KM⁻¹C), K̃ = K − (h²/12)KM⁻¹K. And a method of order p is off by hᵖ.
#[test]
fn the_modified_matrices_by_powers_of_h() {
    let mut random = StdRng::seed_from_u64(12);
    for _ in 0..5 {
        let (system, states) = (draw(&mut random), states(&mut random));
        let [m, c, k] = [system.m, system.c, system.k].map(full);
        let inverse = m.try_inverse().unwrap();
        let of = |h: f64, share: f64| {
            let modified = system.by(Midpoint, h).modified_linear_system(&states).unwrap();
            let twelfth = share * h * h / 12.0;
            let mass = m + (k - c * inverse * c) * twelfth;
            let damping = c - (c * inverse * k + k * inverse * c) * twelfth;
            let stiffness = k - k * inverse * k * twelfth;
            [modified.mass - mass, modified.damping - damping, modified.stiffness - stiffness]
                .map(|d| d.norm())
        };
        // h ‖K‖^½ small beside 1.
        let h = 0.1 / (inverse * k).norm().sqrt().max((inverse * c).norm());
        for (share, order) in [(1.0, 4.0), (0.0, 2.0)] {
            for (coarse, fine) in of(h, share).iter().zip(of(0.5 * h, share)) {
                let slope = (coarse / fine).log2();
                assert!((slope - order).abs() < 0.1, "{slope} at {share}");
            }
        }
        let of_gauss = |h: f64| {
            let modified = system.by(Gauss::<2>, h).modified_linear_system(&states).unwrap();
            (modified.damping - c).norm()
        };
        let slope = (of_gauss(2.0 * h) / of_gauss(h)).log2();
        assert!((slope - 4.0).abs() < 0.1, "{slope}");
    }
}

/// Velocities and positions that are forces beside friction and springs.
struct Turned {
    of: Pair,
    gyroscopic: f64,
    circulatory: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss])]
impl Turned {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let ([a, b, c], [d, e, f]) = (self.of.m, self.of.k);
        0.5 * (a * v[0] * v[0] + 2.0 * b * v[0] * v[1] + c * v[1] * v[1])
            - 0.5 * (d * q[0] * q[0] + 2.0 * e * q[0] * q[1] + f * q[1] * q[1])
    }
    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        let [a, b, c] = self.of.c;
        0.5 * (a * v[0] * v[0] + 2.0 * b * v[0] * v[1] + c * v[1] * v[1])
    }
    fn force(&self, q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        let (g, c) = (self.gyroscopic, self.circulatory);
        [g * v[1] + c * q[1], -g * v[0] - c * q[0]]
    }
}

/// The controls: a gyroscopic or a circulatory force shows where it belongs, by what it is to O(h²).
#[test]
fn forces_that_are_no_friction_are_found() {
    fn check<M: Copy>(method: M, h: f64)
    where
        Turned: Flow<M, 2, Scalar = f64>,
    {
        let mut random = StdRng::seed_from_u64(13);
        for _ in 0..10 {
            let (of, states) = (draw(&mut random), states(&mut random));
            let modified = |gyroscopic: f64, circulatory: f64| {
                let system = Turned { of, gyroscopic, circulatory };
                system.by(method, h).modified_linear_system(&states).unwrap()
            };
            assert!(modified(0.0, 0.0).is_rayleigh());
            let (gyroscopic, circulatory) = (modified(0.1, 0.0), modified(0.0, 0.1));
            assert!(!gyroscopic.is_rayleigh() && !circulatory.is_rayleigh());
            // Entry (1, 0) less entry (0, 1); the force is on the right of the equation.
            assert!((gyroscopic.of_damping.value - 0.2).abs() < 0.01, "{gyroscopic}");
            assert!((circulatory.of_stiffness.value - 0.2).abs() < 0.01, "{circulatory}");
            assert!(circulatory.to_string().starts_with("the modified system is not a Rayleigh system"));
        }
    }
    check(Midpoint, 0.02);
    check(Trapezoidal, 0.02);
    check(Gauss::<3>, 0.02);
    // By the fitted rule, whose force is no Rayleigh force for C that is no multiple of M, the method itself.
    let mut random = StdRng::seed_from_u64(14);
    let (system, states) = (draw(&mut random), states(&mut random));
    assert!(!system.by(Fitted, 0.1).modified_linear_system(&states).unwrap().is_rayleigh());
    let even = Pair { c: system.m.map(|entry| 0.3 * entry), ..system };
    assert!(even.by(Fitted, 0.1).modified_linear_system(&states).unwrap().is_rayleigh());
}

/// M̃, C̃ and K̃ are symmetric if and only if the matrices of K10 q₀ + (K11 − K00) q₁ − K01 q₂ = 0 are.
#[test]
fn symmetric_equations_of_motion_and_symmetric_modified_systems_are_one() {
    let mut random = StdRng::seed_from_u64(15);
    let mut counts = [0; 2];
    for case in 0..40 {
        let mut matrix =
            |size: f64| SMatrix::<f64, 3, 3>::from_fn(|_, _| size * random.random_range(-1.0..1.0));
        let symmetric = |m: SMatrix<f64, 3, 3>| (m + m.transpose()) * 0.5;
        let identity = SMatrix::<f64, 3, 3>::identity();
        // Near K01 = K11 = I, K00 = K10 = −I: a free motion of unit mass, h = 1.
        let mut k01 = identity + symmetric(matrix(0.1));
        let mut k10 = symmetric(matrix(0.1)) - identity;
        let k00 = matrix(0.1) - identity;
        let mut k11 = k00 + identity * 2.0 + symmetric(matrix(0.1));
        let broken = [&mut k01, &mut k10, &mut k11].into_iter().nth(case % 4);
        if let Some(broken) = broken {
            *broken += matrix(0.1);
        }
        let b = k01.try_inverse().unwrap();
        let derivative = dalembert::derivative::PhaseMatrix {
            q_by_q: -b * k00,
            q_by_p: b,
            p_by_q: k10 - k11 * b * k00,
            p_by_p: k11 * b,
        };
        match ModifiedLinearSystem::of(&derivative, 1.0, None) {
            Ok(modified) => {
                assert_eq!(modified.is_rayleigh(), case % 4 == 3, "{case}: {modified}");
                counts[usize::from(modified.is_rayleigh())] += 1;
            }
            Err(error) => assert!(
                matches!(error, ModifiedLinearSystemError::NegativeEigenvalue { .. }),
                "{case}: {error}"
            ),
        }
    }
    println!("{} symmetric, {} not", counts[1], counts[0]);
    assert!(counts[0] > 15 && counts[1] > 5);
}

/// Ẽ falls by ∫2R̃ along the motion.
#[test]
fn the_modified_energy_falls_by_the_modified_friction() {
    let mut random = StdRng::seed_from_u64(16);
    let h = 0.3;
    for _ in 0..10 {
        let (system, states) = (draw(&mut random), states(&mut random));
        let modified = system.by(Gauss::<2>, h).modified_linear_system(&states).unwrap();
        let field = DMatrix::from_fn(4, 4, |i, j| {
            let f = &modified.field;
            [[f.q_by_q, f.q_by_p], [f.p_by_q, f.p_by_p]][i / 2][j / 2][(i % 2, j % 2)]
        });
        let at = |t: f64| {
            let z =
                DMatrix::from_column_slice(4, 1, &[states[0].q.as_slice(), states[0].p.as_slice()].concat());
            let z = exponential(&(&field * t)) * z;
            let state = State { q: vector![z[0], z[1]], p: vector![z[2], z[3]] };
            (state.q, modified.velocity(&state))
        };
        let energy = |(q, v): (Vector2<f64>, Vector2<f64>)| modified.energy(&q, &v);
        // Boole's rule on 16 parts.
        let weight = |k: usize| match k % 4 {
            _ if k == 0 || k == 64 => 7.0,
            0 => 14.0,
            2 => 12.0,
            _ => 32.0,
        };
        let loss: f64 =
            (0..=64).map(|k| weight(k) * 2.0 * modified.rayleigh(&at(h * k as f64 / 64.0).1)).sum::<f64>()
                * h
                * 4.0
                / 64.0
                / 90.0;
        let change = energy(at(h)) - energy(at(0.0));
        assert!((change + loss).abs() < 1e-12, "{change} {loss}");
        assert!(loss > 0.0);
    }
}

/// The trapezoidal rule has the modified system of the midpoint rule with M − (h²/4)K in the place of M.
#[test]
fn the_trapezoidal_rule_is_a_midpoint_rule_of_another_mass() {
    let mut random = StdRng::seed_from_u64(19);
    let h = 0.3;
    for _ in 0..10 {
        let (system, states) = (draw(&mut random), states(&mut random));
        let m = [0, 1, 2].map(|i| system.m[i] - h * h / 4.0 * system.k[i]);
        let trapezoidal = system.by(Trapezoidal, h).modified_linear_system(&states).unwrap();
        let midpoint = Pair { m, ..system }.by(Midpoint, h).modified_linear_system(&states).unwrap();
        for (one, other) in [
            (trapezoidal.mass, midpoint.mass),
            (trapezoidal.damping, midpoint.damping),
            (trapezoidal.stiffness, midpoint.stiffness),
        ] {
            assert!((one - other).amax() < 1e-12, "{one} {other}");
        }
        // The control: its own mass.
        let own = system.by(Midpoint, h).modified_linear_system(&states).unwrap();
        assert!((own.damping - midpoint.damping).amax() > 1e-5);
    }
}

/// Friction on one combination of the coordinates: R̃ ≥ 0 by the midpoint and the trapezoidal rules whatever
/// the step size; by Gauss rules R̃ has either sign, however small the step.
#[test]
fn the_modified_friction_where_not_all_coordinates_have_friction() {
    fn is_dissipative<M>(system: &Pair, method: M, h: f64, states: &[State<f64, 2>]) -> Option<bool>
    where
        Pair: Flow<M, 2, Scalar = f64>,
    {
        let modified = system.by(method, h).modified_linear_system(states).ok()?;
        assert!(modified.is_rayleigh());
        Some(modified.is_dissipative())
    }
    let mut random = StdRng::seed_from_u64(18);
    let mut counts = [0; 2];
    for _ in 0..15 {
        let (mut system, states) = (draw(&mut random), states(&mut random));
        let (x, y) = (random.random_range(0.2..0.5), random.random_range(0.2..0.5_f64));
        system.c = [x * x, x * y, y * y];
        for h in [0.3, 1.0, 3.0] {
            for found in [
                is_dissipative(&system, Midpoint, h, &states),
                is_dissipative(&system, Trapezoidal, h, &states),
                is_dissipative(&system, FittedTrapezoidal, h, &states),
            ] {
                counts[0] += usize::from(found.is_some());
                assert_ne!(found, Some(false), "{system:?} {h}");
            }
        }
        for found in [
            is_dissipative(&system, Gauss::<2>, 0.3, &states),
            is_dissipative(&system, Gauss::<3>, 0.6, &states),
        ] {
            counts[1] += usize::from(found == Some(false));
        }
        // The control: every method, where friction is that of the mass.
        system.c = system.m.map(|entry| 0.2 * entry);
        assert_eq!(is_dissipative(&system, Gauss::<2>, 0.3, &states), Some(true));
    }
    println!(
        "R̃ ≥ 0 in {} of {} systems by rules of order 2, not in {} of 30 by Gauss rules",
        counts[0], counts[0], counts[1]
    );
    assert!(counts[0] > 80 && counts[1] > 25);
}

/// A step that turns too far, rings, or is of no linear system.
#[test]
fn hypotheses_that_fail_have_names() {
    use ModifiedLinearSystemError as Error;
    #[rayleigh_system(rule = [midpoint, gauss])]
    fn single(q: [f64; 1], v: [f64; 1], r: f64, k: f64, quartic: f64) -> (f64, f64) {
        let v2 = v[0] * v[0];
        (0.5 * v2 - 0.5 * k * q[0] * q[0] - quartic * q[0].powi(4), 0.5 * r * v2)
    }
    let states = [0.3, -0.7].map(|q| State { q: vector![q], p: vector![0.2] });
    let spring = Single { r: 0.01, k: 1.0, quartic: 0.0 };
    // Gauss 2 turns by π at hω = √12.
    assert!(spring.by(Gauss::<2>, 3.4).modified_linear_system(&states).is_ok());
    let error = spring.by(Gauss::<2>, 3.6).modified_linear_system(&states).unwrap_err();
    let Error::AnotherBranch { angle } = error else { panic!("{error}") };
    // tan(θ/2) = (y/2)/(1 − y²/12).
    assert!((angle - 2.0 * (1.8_f64).atan2(1.0 - 3.6 * 3.6 / 12.0)).abs() < 1e-3, "{angle}");
    // From A alone it is not told: another system's.
    let (_, by) = spring.by(Gauss::<2>, 3.6).linearized_step(&states[0]).unwrap();
    assert!(ModifiedLinearSystem::of(&by, 3.6, None).unwrap().mass[0] < 0.0);
    // Under the midpoint rule a free mass rings for hr > 2m, and stands for hr = 2m.
    let of = |r: f64| Single { r, k: 0.0, quartic: 0.0 }.by(Midpoint, 1.0).modified_linear_system(&states);
    assert!(of(1.9).unwrap().is_dissipative());
    assert!(
        matches!(of(3.0), Err(Error::NegativeEigenvalue { eigenvalue }) if (eigenvalue + 0.2).abs() < 1e-14)
    );
    assert_eq!(of(2.0), Err(Error::ZeroEigenvalue));
    let bent = Single { quartic: 0.1, ..spring };
    assert!(matches!(
        bent.by(Midpoint, 0.1).modified_linear_system(&states),
        Err(Error::NotLinear { sample: 1, .. })
    ));
    let by = spring.by(Midpoint, 0.1);
    assert_eq!(by.modified_linear_system(&states[..1]), Err(Error::TooFewStates));
    let lost = [states[0], State { q: vector![f64::NAN], p: vector![0.0] }];
    assert!(matches!(by.modified_linear_system(&lost), Err(Error::Step { sample: 1, .. })));
    let mut a = by.linearized_step(&states[0]).unwrap().1;
    assert_eq!(ModifiedLinearSystem::of(&a, 0.0, None), Err(Error::StepSize { h: 0.0 }));
    a.q_by_p[0] = f64::NAN;
    assert_eq!(ModifiedLinearSystem::of(&a, 0.1, None), Err(Error::NonFinite { sample: 0 }));
    let identity = dalembert::derivative::PhaseMatrix::<f64, 1>::identity();
    assert_eq!(ModifiedLinearSystem::of(&identity, 0.1, None), Err(Error::Degenerate));
}

/// Coordinates in units that differ by 10⁶ have the same verdicts.
#[test]
fn units_do_not_matter() {
    let mut random = StdRng::seed_from_u64(17);
    for _ in 0..10 {
        let (system, states) = (draw(&mut random), states(&mut random));
        let scale = |[a, b, c]: [f64; 3]| [a, b * 1e-6, c * 1e-12];
        let small = Pair { m: scale(system.m), c: scale(system.c), k: scale(system.k) };
        let (plain, scaled) = (
            system.by(Gauss::<2>, 0.2).modified_linear_system(&states).unwrap(),
            small.by(Gauss::<2>, 0.2).modified_linear_system(&states).unwrap(),
        );
        assert!(scaled.is_rayleigh() && scaled.is_dissipative() == plain.is_dissipative());
        assert!((scaled.damping[(0, 1)] * 1e6 - plain.damping[(0, 1)]).abs() < 1e-12);
        let turned = Turned { of: small, gyroscopic: 0.0, circulatory: 1e-8 };
        assert!(!turned.by(Midpoint, 0.2).modified_linear_system(&states).unwrap().is_rayleigh());
    }
}
