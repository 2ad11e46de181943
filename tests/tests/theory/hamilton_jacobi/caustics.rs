//! Caustics are found and located between steps, double ones too, and none where there is none.

use dalembert::hamilton_jacobi::{Characteristic, Section};
use dalembert::nalgebra::{SMatrix, SVector, vector};
use dalembert::{Discretise, Midpoint, rayleigh_system};
use dalembert_tests::damped_oscillator::{CompleteSolution, DAMPED, H};
use dalembert_tests::draws::Draws;

/// γ(q) = M q + l.
struct Linear<const N: usize> {
    matrix: SMatrix<f64, N, N>,
    shift: SVector<f64, N>,
}

impl<const N: usize> Section<N> for Linear<N> {
    type Scalar = f64;

    fn covector(&self, q: &SVector<f64, N>) -> SVector<f64, N> {
        self.matrix * q + self.shift
    }

    fn jacobian(&self, _q: &SVector<f64, N>) -> SMatrix<f64, N, N> {
        self.matrix
    }
}

#[test]
fn the_oscillators_are_where_the_closed_form_says() {
    let closed = CompleteSolution::new(&DAMPED, H, -0.3, 0.7);
    let theory = DAMPED.by(Midpoint, H).hamilton_jacobi();
    let steps = 60;
    let caustics = theory.carry(&closed.function(0), &vector![0.9], steps).unwrap().caustics;
    let expected: Vec<usize> =
        (0..steps).filter(|k| closed.angle(*k).cos() * closed.angle(k + 1).cos() < 0.0).collect();
    assert!(expected.len() >= 4);
    assert_eq!(caustics.iter().map(|caustic| caustic.step).collect::<Vec<_>>(), expected);
    for caustic in &caustics {
        let (from, to) = (closed.frame(caustic.step), closed.frame(caustic.step + 1));
        assert!((caustic.fraction - from / (from - to)).abs() < 1e-11, "{caustic}");
        assert_eq!(caustic.multiplicity, 1);
    }
}

/// On which side of the node rounding puts the zero differs from node to node.
#[test]
fn one_on_a_node_is_reported_once() {
    let theory = DAMPED.by(Midpoint, H).hamilton_jacobi();
    for node in 1..12 {
        for lambda in [0.7, -0.2] {
            let mut closed = CompleteSolution::new(&DAMPED, H, 0.0, lambda);
            closed.phase = std::f64::consts::FRAC_PI_2 - node as f64 * closed.theta;
            let caustics = theory.carry(&closed.function(0), &vector![0.9], 12).unwrap().caustics;
            assert_eq!(caustics.len(), 1, "{caustics:?}");
            let caustic = caustics[0];
            assert_eq!((caustic.step, caustic.fraction, caustic.multiplicity), (node - 1, 1.0, 1));
            assert!(closed.frame(node).abs() < 1e-14 && closed.frame(node + 1) < -0.01);
        }
    }
}

/// m_i = 1; stiffness matrix K with the given eigenvalues, turned by an angle so that nothing is diagonal.
struct Plane {
    stiffness: [f64; 2],
    angle: f64,
    friction: f64,
}

#[rayleigh_system]
impl Plane {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let (a, b) = (self.along(q), self.across(q));
        0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.5 * (self.stiffness[0] * a * a + self.stiffness[1] * b * b)
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.friction * (v[0] * v[0] + v[1] * v[1])
    }

    fn along(&self, q: [f64; 2]) -> f64 {
        self.angle.cos() * q[0] + self.angle.sin() * q[1]
    }

    fn across(&self, q: [f64; 2]) -> f64 {
        self.angle.cos() * q[1] - self.angle.sin() * q[0]
    }
}

const STEPS: usize = 60;

fn carried(system: &Plane) -> Characteristic<f64, 2> {
    let section = Linear { matrix: SMatrix::zeros(), shift: vector![0.3, -0.1] };
    system.by(Midpoint, H).hamilton_jacobi().carry(&section, &vector![0.9, 0.4], STEPS).unwrap()
}

/// Focal points in (k, k + 1] by discrete Sturm theory: negative eigenvalues of Q_kᵀ (∂p0/∂q1) Q_{k+1}.
fn focal_points(system: &Plane, characteristic: &Characteristic<f64, 2>, k: usize) -> usize {
    let [from, to] = [characteristic.states[k].q, characteristic.states[k + 1].q];
    let segment = system.by(Midpoint, H).segment(&from, &to).unwrap();
    let newton = segment.legendre_derivatives().unwrap().p0_by_q1;
    let form = characteristic.frames[k].q.transpose() * newton * characteristic.frames[k + 1].q;
    assert!((form - form.transpose()).amax() < 1e-12);
    form.symmetric_eigenvalues().iter().filter(|value| **value < 0.0).count()
}

#[test]
fn a_double_caustic_leaves_the_sign_of_the_determinant_and_is_found() {
    for friction in [0.0, 0.5] {
        let system = Plane { stiffness: [1.0, 1.0], angle: 0.6, friction };
        let characteristic = carried(&system);
        let caustics = &characteristic.caustics;
        // Positive control: a look at signs finds none.
        assert!(characteristic.frames.iter().all(|frame| frame.q.determinant() > 0.0));
        assert!(caustics.len() >= 4);
        for caustic in caustics {
            assert_eq!(caustic.multiplicity, 2, "{caustic}");
            assert_eq!(focal_points(&system, &characteristic, caustic.step), 2);
        }
        // The same in one degree of freedom.
        let single = dalembert_tests::damped_oscillator::Oscillator { m: 1.0, k: 1.0, r: friction };
        let section = Linear { matrix: SMatrix::zeros(), shift: vector![0.2] };
        let single =
            single.by(Midpoint, H).hamilton_jacobi().carry(&section, &vector![0.5], STEPS).unwrap().caustics;
        assert_eq!(single.len(), caustics.len());
        for (one, two) in single.iter().zip(caustics) {
            assert_eq!(one.step, two.step);
            assert!((one.fraction - two.fraction).abs() < 1e-6, "{one} {two}");
        }
    }
}

#[test]
fn unequal_stiffnesses_split_it_into_simple_ones_as_sturm_theory_counts() {
    let system = Plane { stiffness: [1.0, 1.7], angle: 0.6, friction: 0.5 };
    let characteristic = carried(&system);
    let mut found = [0; STEPS];
    for caustic in &characteristic.caustics {
        found[caustic.step] += caustic.multiplicity;
    }
    for (k, found) in found.iter().enumerate() {
        assert_eq!(*found, focal_points(&system, &characteristic, k), "k = {k}");
    }
    assert!(found.iter().sum::<usize>() >= 8);
    assert!(characteristic.caustics.iter().all(|caustic| caustic.multiplicity == 1));
}

/// What a direction that moves for itself opens by, x_k of the map of one oscillator from x = 1, p = slope:
/// the midpoint rule solved by hand.
fn openings(stiffness: f64, friction: f64, slope: f64, h: f64, steps: usize) -> Vec<f64> {
    let (mut x, mut p) = (1.0, slope);
    let mut openings = vec![x];
    for _ in 0..steps {
        let v = (p - 0.5 * h * stiffness * x) / (1.0 + 0.5 * h * friction + 0.25 * h * h * stiffness);
        p -= h * (stiffness * (x + 0.5 * h * v) + friction * v);
        x += h * v;
        openings.push(x);
    }
    openings
}

/// Step and fraction of every sign change, and whether rounding decides none of them.
fn sign_changes(openings: &[f64]) -> (Vec<f64>, bool) {
    let mut places = Vec::new();
    let mut is_clear = true;
    for (k, pair) in openings.windows(2).enumerate() {
        let fraction = pair[0] / (pair[0] - pair[1]);
        is_clear &= pair.iter().all(|x| x.abs() > 1e-6 * pair[0].abs().max(pair[1].abs()));
        if pair[0] * pair[1] < 0.0 {
            places.push(k as f64 + fraction);
        }
    }
    (places, is_clear)
}

#[test]
fn random_fans_fold_where_each_of_their_directions_does() {
    let mut draws = Draws::new(1);
    let (mut fans, mut folds, mut doubles) = (0, 0, 0);
    let all = if cfg!(debug_assertions) { 80 } else { 4000 };
    for _ in 0..all {
        let h = draws.scale(0.02, 1.5);
        let friction = draws.between(-0.2, 1.0);
        let mut stiffness = [draws.between(-1.0, 4.0), draws.between(-1.0, 4.0)];
        let mut slopes = [draws.between(-3.0, 3.0), draws.between(-3.0, 3.0)];
        if draws.below(4) == 0 {
            (stiffness[1], slopes[1]) = (stiffness[0], slopes[0]);
        }
        let steps = 40;
        let [first, second] =
            [0, 1].map(|i| sign_changes(&openings(stiffness[i], friction, slopes[i], h, steps)));
        if !first.1 || !second.1 {
            continue;
        }
        let mut expected = [first.0, second.0].concat();
        expected.sort_by(f64::total_cmp);

        let system = Plane { stiffness, angle: draws.between(0.0, 3.0), friction };
        let (sine, cosine) = system.angle.sin_cos();
        let turn = SMatrix::<f64, 2, 2>::new(cosine, -sine, sine, cosine);
        let matrix = turn * SMatrix::from_diagonal(&SVector::from(slopes)) * turn.transpose();
        let section = Linear { matrix, shift: vector![0.3, -0.1] };
        let label = vector![draws.between(-1.0, 1.0), draws.between(-1.0, 1.0)];
        let carried = system.by(Midpoint, h).hamilton_jacobi().carry(&section, &label, steps).unwrap();
        let caustics = carried.caustics;
        doubles += caustics.iter().filter(|caustic| caustic.multiplicity == 2).count();
        let found: Vec<f64> = caustics
            .iter()
            .flat_map(|caustic| vec![caustic.step as f64 + caustic.fraction; caustic.multiplicity])
            .collect();
        assert_eq!(
            found.len(),
            expected.len(),
            "{stiffness:?} {slopes:?} {friction} {h}: {found:?} {expected:?}"
        );
        for (found, expected) in found.iter().zip(&expected) {
            assert!(
                (found - expected).abs() < 1e-6,
                "{stiffness:?} {slopes:?} {friction} {h}: {found} {expected}"
            );
        }
        fans += 1;
        folds += found.len();
    }
    println!("{fans} fans, {folds} folds, {doubles} of them double");
    assert!(fans > all * 39 / 40 && folds > all as usize * 5 / 4 && doubles > all as usize / 8);
}

/// A pendulum: neighbouring characteristics cross in the step that the frame says.
#[test]
fn neighbours_of_a_nonlinear_fan_cross_where_the_caustic_is() {
    #[rayleigh_system]
    fn pendulum(q: [f64; 1], v: [f64; 1], friction: f64) -> (f64, f64) {
        (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * friction * v[0] * v[0])
    }
    let system = Pendulum { friction: 0.1 };
    let theory = system.by(Midpoint, 0.2).hamilton_jacobi();
    let section = Linear { matrix: SMatrix::zeros(), shift: vector![0.4] };
    let (width, steps) = (1e-6, 60);
    let mut places = Vec::new();
    for label in [-2.0, -1.0, 0.3, 1.4] {
        let middle = theory.carry(&section, &vector![label], steps).unwrap();
        let [left, right] = [label - width, label + width]
            .map(|label| theory.carry(&section, &vector![label], steps).unwrap());
        let gap = |k: usize| right.states[k].q[0] - left.states[k].q[0];
        let crossings: Vec<usize> = (0..steps).filter(|k| gap(*k) * gap(k + 1) < 0.0).collect();
        let caustics = middle.caustics;
        assert_eq!(caustics.iter().map(|caustic| caustic.step).collect::<Vec<_>>(), crossings, "{label}");
        for caustic in &caustics {
            let fraction = gap(caustic.step) / (gap(caustic.step) - gap(caustic.step + 1));
            assert!((caustic.fraction - fraction).abs() < 1e-5, "{caustic} {fraction}");
        }
        places.push(caustics[0].step);
    }
    // Positive control: it is no point focus, the place depends on the label.
    assert!(places.iter().any(|place| *place != places[0]), "{places:?}");
}

#[test]
fn a_spreading_fan_has_none() {
    #[rayleigh_system]
    fn free(_q: [f64; 1], v: [f64; 1], friction: f64) -> (f64, f64) {
        (0.5 * v[0] * v[0], 0.5 * friction * v[0] * v[0])
    }
    let system = Free { friction: 0.3 };
    let theory = system.by(Midpoint, 0.2).hamilton_jacobi();
    let caustics = |slope: f64| {
        let section = Linear { matrix: SMatrix::from_element(slope), shift: vector![0.4] };
        theory.carry(&section, &vector![1.0], 100).unwrap().caustics
    };
    assert!(caustics(0.5).is_empty());
    // Damped motion covers p/r: a slope of −r just fails to focus, a steeper one does.
    assert!(caustics(-0.29).is_empty());
    assert_eq!(caustics(-0.5).len(), 1);
}
