//! Coordinates without mass, whose velocity friction determines: against motions known otherwise.
//!
//! ```text
//! M v̇ + C v + K q = 0        M = 0 in some coordinates, C > 0 there
//! ```
//!
//! What is left of q and of the velocities with mass obeys ẋ = B x: by B's exponential the motion is known,
//! and by (1 − hB/2)⁻¹(1 + hB/2) the midpoint rule's.

use dalembert::derivative::PhaseMatrix;
use dalembert::nalgebra::{DMatrix, DVector, Matrix4, SVector, Vector4, vector};
use dalembert::{
    Discretise, Fitted, Gauss, Midpoint, Proximal, State, StepError, Trapezoidal, rayleigh_system,
};

use dalembert_tests::draws::Draws;

/// A mass on a spring that ends in a dashpot.
#[rayleigh_system(rule = [midpoint, gauss, trapezoidal, fitted])]
fn maxwell(q: [f64; 2], v: [f64; 2], m: [f64; 2], k: f64, c: f64) -> (f64, f64) {
    let kinetic = 0.5 * m[0] * v[0] * v[0] + 0.5 * m[1] * v[1] * v[1];
    (kinetic - 0.5 * k * (q[0] - q[1]).powi(2), 0.5 * c * v[1] * v[1])
}

/// One that dry friction holds beside: of the mass, or of the end of the spring.
#[rayleigh_system(rule = proximal)]
fn braked(q: [f64; 2], v: [f64; 2], m: [f64; 2], k: f64, c: f64, limits: [f64; 2]) -> (f64, f64) {
    let kinetic = 0.5 * m[0] * v[0] * v[0] + 0.5 * m[1] * v[1] * v[1];
    let dry = limits[0] * v[0].abs() + limits[1] * v[1].abs();
    (kinetic - 0.5 * k * (q[0] - q[1]).powi(2), 0.5 * c * v[1] * v[1] + dry)
}

const BRAKED: Braked = Braked { m: [1.0, 0.0], k: 4.0, c: 3.0, limits: [0.0, 0.0] };

const MAXWELL: Maxwell = Maxwell { m: [1.0, 0.0], k: 4.0, c: 3.0 };

/// Its motion from (1, 0) at t = 5, by the exponential of its matrix in 40 digits: q and v.
const AT_5: [[f64; 2]; 2] = [
    [-0.035_715_576_430_753_7, -8.355_759_448_769_41e-5],
    [2.506_727_834_630_82e-4, -0.047_509_358_448_354_7],
];

#[test]
fn a_spring_and_a_dashpot_in_series() -> Result<(), StepError> {
    // The velocity that is given there does not matter.
    let start = State::from_velocity(&MAXWELL, [1.0, 0.0], [0.0, 7.0])?;
    assert_eq!(start.p, vector![0.0, 0.0]);
    assert_eq!(start.velocity(&MAXWELL)?, vector![0.0, 4.0 / 3.0]);
    assert_eq!(start.energy(&MAXWELL)?, 2.0);
    let off = |state: State<f64, 2>| -> Result<[f64; 2], StepError> {
        let [q, v] = AT_5.map(SVector::from);
        Ok([(state.q - q).amax(), (state.velocity(&MAXWELL)? - v).amax()])
    };
    let end = MAXWELL.by(Gauss::<4>, 0.1).run(start).nth(49).unwrap()?.state;
    assert!(off(end)?.into_iter().all(|off| off < 1e-13), "{:?}", off(end));
    let by_midpoint = |steps: usize| {
        off(MAXWELL.by(Midpoint, 5.0 / steps as f64).run(start).nth(steps - 1).unwrap()?.state)
    };
    let by_proximal =
        |steps: usize| off(BRAKED.by(Proximal, 5.0 / steps as f64).run(start).nth(steps - 1).unwrap()?.state);
    for (coarse, fine) in [(by_midpoint(500)?, by_midpoint(1000)?), (by_proximal(500)?, by_proximal(1000)?)] {
        for i in 0..2 {
            assert!(coarse[i] < 1e-4 && (coarse[i] / fine[i] - 4.0).abs() < 0.05, "{coarse:?} {fine:?}");
        }
    }
    Ok(())
}

/// A linear system of four coordinates.
#[derive(Clone, Copy)]
struct Linear {
    mass: [[f64; 4]; 4],
    damping: [[f64; 4]; 4],
    stiffness: [[f64; 4]; 4],
}

#[rayleigh_system(rule = [midpoint, gauss])]
impl Linear {
    fn lagrangian(&self, q: [f64; 4], v: [f64; 4]) -> f64 {
        let (mut kinetic, mut potential) = (0.0, 0.0);
        for i in 0..4 {
            for j in 0..4 {
                kinetic += 0.5 * self.mass[i][j] * v[i] * v[j];
                potential += 0.5 * self.stiffness[i][j] * q[i] * q[j];
            }
        }
        kinetic - potential
    }

    fn rayleigh(&self, v: [f64; 4]) -> f64 {
        let mut power = 0.0;
        for i in 0..4 {
            for j in 0..4 {
                power += 0.5 * self.damping[i][j] * v[i] * v[j];
            }
        }
        power
    }
}

/// G Gᵀ of a random G, with 0 in the rows and columns that are left out.
fn positive(random: &mut Draws, ridge: f64, is_in: impl Fn(usize) -> bool) -> [[f64; 4]; 4] {
    let root = Matrix4::from_fn(|_, _| random.between(-1.0, 1.0));
    let matrix = root * root.transpose() + Matrix4::identity() * ridge;
    std::array::from_fn(|i| std::array::from_fn(|j| if is_in(i) && is_in(j) { matrix[(i, j)] } else { 0.0 }))
}

impl Linear {
    /// Coordinates without mass are those of `massless`.
    fn random(random: &mut Draws, massless: [bool; 4]) -> Self {
        // Some without damping where there is mass.
        let damped: [bool; 4] = massless.map(|is_massless| is_massless || random.below(2) == 0);
        Self {
            mass: positive(random, 0.2, |i| !massless[i]),
            damping: positive(random, 0.2, |i| damped[i]),
            stiffness: positive(random, 0.0, |_| true),
        }
    }

    /// B, of x = (q, velocities with mass), and the coordinates of these.
    fn reduced(&self) -> (DMatrix<f64>, Vec<usize>) {
        let heavy: Vec<usize> = (0..4).filter(|&i| self.mass[i][i] > 0.0).collect();
        let light: Vec<usize> = (0..4).filter(|&i| self.mass[i][i] == 0.0).collect();
        let part = |of: &[[f64; 4]; 4], rows: &[usize], columns: &[usize]| {
            DMatrix::from_fn(rows.len(), columns.len(), |i, j| of[rows[i]][columns[j]])
        };
        let all = [0, 1, 2, 3];
        let (n, of_v) = (heavy.len(), 4);
        // v of the light ones, as a matrix times x.
        let mut forces = DMatrix::zeros(light.len(), 4 + n);
        forces.columns_mut(0, 4).copy_from(&part(&self.stiffness, &light, &all));
        forces.columns_mut(of_v, n).copy_from(&part(&self.damping, &light, &heavy));
        let light_v = if light.is_empty() {
            forces
        } else {
            -(part(&self.damping, &light, &light).try_inverse().unwrap() * forces)
        };
        let mut rates = DMatrix::zeros(4 + n, 4 + n);
        for (row, &i) in heavy.iter().enumerate() {
            rates[(i, of_v + row)] = 1.0;
        }
        for (row, &i) in light.iter().enumerate() {
            rates.row_mut(i).copy_from(&light_v.row(row));
        }
        if n > 0 {
            let velocities = rates.rows(0, 4).into_owned();
            let mut pulls = part(&self.damping, &heavy, &all) * velocities;
            let spring = part(&self.stiffness, &heavy, &all);
            let own = pulls.columns(0, 4) + spring;
            pulls.columns_mut(0, 4).copy_from(&own);
            let accelerations = -(part(&self.mass, &heavy, &heavy).try_inverse().unwrap() * pulls);
            rates.rows_mut(of_v, n).copy_from(&accelerations);
        }
        (rates, heavy)
    }

    /// q and v of x.
    fn seen(&self, (rates, _): &(DMatrix<f64>, Vec<usize>), x: &DVector<f64>) -> [Vector4<f64>; 2] {
        let v = rates.rows(0, 4) * x;
        [Vector4::from_fn(|i, _| x[i]), Vector4::from_fn(|i, _| v[i])]
    }
}

/// Random systems with random coordinates without mass, up to all of them: none is refused, and each has the
/// motion that its matrices have.
#[test]
fn random_systems_have_their_motion() -> Result<(), StepError> {
    let mut random = Draws::new(0x6d61_7373_6c65_7373);
    let mut most = [0.0_f64; 4];
    for number in 0..if cfg!(debug_assertions) { 15 } else { 1500 } {
        let massless = std::array::from_fn(|i| (number % 15 + 1) >> i & 1 == 1);
        let system = Linear::random(&mut random, massless);
        let reduced = system.reduced();
        let (rates, heavy) = &reduced;
        let x = DVector::from_fn(4 + heavy.len(), |_, _| random.between(-1.0, 1.0));
        let [q, v] = system.seen(&reduced, &x);
        let start = State::from_velocity(&system, q, v.map(|v| if v == 0.0 { 1.0 } else { v }))?;
        assert!((start.velocity(&system)? - v).amax() < 1e-12 * (1.0 + v.amax()));
        let (h, steps) = (0.05, 20);
        let exact = system.seen(&reduced, &((rates * (h * steps as f64)).exp() * &x));
        let one = DMatrix::identity(x.len(), x.len());
        let step = (&one - rates * (0.5 * h)).lu().solve(&(&one + rates * (0.5 * h))).unwrap();
        let of_midpoint = (0..steps).fold(x, |x, _| &step * x);
        let of_midpoint = system.seen(&reduced, &of_midpoint);
        let ends = [
            (system.by(Gauss::<4>, h).run(start).nth(steps - 1).unwrap()?.state, exact),
            (system.by(Midpoint, h).run(start).nth(steps - 1).unwrap()?.state, of_midpoint),
        ];
        for (i, (end, [q, v])) in ends.into_iter().enumerate() {
            let size = q.amax().max(v.amax()).max(1.0);
            most[2 * i] = most[2 * i].max((end.q - q).amax() / size);
            most[2 * i + 1] = most[2 * i + 1].max((end.velocity(&system)? - v).amax() / size);
        }
    }
    println!("{most:?}");
    assert!(most.into_iter().all(|off| off < 1e-9), "{most:?}");
    Ok(())
}

/// Where neither mass nor friction acts, nothing determines the velocity: the coordinate is named, by every
/// rule, and by those that do not take coordinates without mass where friction acts too.
#[test]
fn what_nothing_determines_is_refused() {
    let mut random = Draws::new(0x6e65_6974_6865_7220);
    for open in 0..4 {
        let mut system = Linear::random(&mut random, [true; 4]);
        for i in 0..4 {
            (system.damping[open][i], system.damping[i][open]) = (0.0, 0.0);
        }
        let refused = StepError::DegenerateLagrangian { column: open };
        let state = State { q: vector![0.1, 0.2, 0.3, 0.4], p: SVector::zeros() };
        assert_eq!(State::from_velocity(&system, state.q, [0.0; 4]), Err(refused));
        assert_eq!(state.velocity(&system), Err(refused));
        assert_eq!(system.by(Midpoint, 0.1).step(&state).unwrap_err(), refused);
        assert_eq!(system.by(Gauss::<2>, 0.1).step(&state).unwrap_err(), refused);
    }
    let start = State::from_velocity(&MAXWELL, [1.0, 0.0], [0.0, 0.0]).unwrap();
    let refused = StepError::DegenerateLagrangian { column: 1 };
    let error = MAXWELL.by(Trapezoidal, 0.1).step(&start).unwrap_err();
    assert_eq!(error, refused);
    assert!(error.to_string().contains("`Midpoint`"), "{error}");
    assert_eq!(MAXWELL.by(Trapezoidal, 0.1).run(start).next().unwrap().unwrap_err(), refused);
    assert_eq!(MAXWELL.by(Fitted, 0.1).step(&start).unwrap_err(), refused);
}
