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
    Discretise, Fitted, Gauss, Midpoint, OneSided, Proximal, State, StepError, Trapezoidal, rayleigh_system,
};

use dalembert_tests::draws::Draws;

/// A mass on a spring that ends in a dashpot.
#[rayleigh_system(rule = [midpoint, gauss, trapezoidal, fitted, one_sided])]
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
    // Its damping has no mass to slow down, so that this rule is of order 2 here.
    let by_one_sided = |steps: usize| {
        off(MAXWELL.by(OneSided, 5.0 / steps as f64).run(start).nth(steps - 1).unwrap()?.state)
    };
    let found = [
        (by_midpoint(500)?, by_midpoint(1000)?),
        (by_proximal(500)?, by_proximal(1000)?),
        (by_one_sided(500)?, by_one_sided(1000)?),
    ];
    for (coarse, fine) in found {
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

/// With a mass of 10⁻⁹ to 10⁻³ in its place, q and v at t = 5 from rest at (1, 0), by eigenvectors in 60
/// digits.
const NEARLY: [(f64, [f64; 4]); 4] = [
    (
        1e-9,
        [
            -0.035_715_576_400_757_48,
            -8.355_762_479_215_343e-5,
            2.506_729_218_858_187e-4,
            -0.047_509_358_389_180_45,
        ],
    ),
    (
        1e-7,
        [
            -0.035_715_573_431_129,
            -8.356_062_493_364_99e-5,
            2.506_866_257_362_028e-4,
            -0.047_509_352_530_928_75,
        ],
    ),
    (
        1e-5,
        [
            -0.035_715_276_466_314_28,
            -8.386_063_933_776_402e-5,
            2.520_570_056_803_433e-4,
            -0.047_508_766_705_128_21,
        ],
    ),
    (
        1e-3,
        [
            -0.035_685_560_305_750_93,
            -1.138_646_277_153_634e-4,
            3.890_440_609_435_789e-4,
            -0.047_450_177_797_488_83,
        ],
    ),
];

/// Steps that do not resolve how the velocity of a mass so light decays, from a start that asks for it: q is
/// that of the motion, v by `Fitted` alone, to ½h v̇. By the others v alternates about it for ever: the
/// control.
#[test]
fn coordinates_with_nearly_no_mass() -> Result<(), StepError> {
    for (mass, [q0, q1, v0, v1]) in NEARLY {
        let (system, braked) = (Maxwell { m: [1.0, mass], ..MAXWELL }, Braked { m: [1.0, mass], ..BRAKED });
        let start = State::from_velocity(&system, [1.0, 0.0], [0.0, 0.0])?;
        let h = 1.0 / 1024.0;
        let ends = [
            system.by(Midpoint, h).run(start).nth(5119).unwrap()?.state,
            braked.by(Proximal, h).run(start).nth(5119).unwrap()?.state,
            system.by(Gauss::<4>, 16.0 * h).run(start).nth(319).unwrap()?.state,
            system.by(Fitted, h).run(start).nth(5119).unwrap()?.state,
        ];
        for (i, end) in ends.into_iter().enumerate() {
            let off =
                [end.q - vector![q0, q1], end.velocity(&system)? - vector![v0, v1]].map(|off| off.amax());
            assert!(off[0] < 1e-6, "rule {i}, mass {mass:e}: {off:?}");
            assert!(i < 3 || off[1] < 5e-5, "mass {mass:e}: {off:?}");
            assert!(i == 3 || mass > 1e-6 || off[1] > 0.1, "rule {i}, mass {mass:e}: {off:?}");
        }
    }
    Ok(())
}

/// A bead without inertia on a spring, pulled by an input; at c > 0 in a fluid, at `dry` on a dashpot whose
/// force grows with the square of the velocity.
struct Bead {
    k: f64,
    c: f64,
    dry: f64,
}

#[rayleigh_system(rule = [midpoint, gauss])]
impl Bead {
    fn lagrangian(&self, q: [f64; 1], _v: [f64; 1]) -> f64 {
        -0.5 * self.k * q[0] * q[0]
    }

    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.5 * self.c * v[0] * v[0] + self.dry / 3.0 * v[0] * v[0] * v[0].abs()
    }

    fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
        u
    }
}

/// First order in time: q = (u/k)(1 − e^(−kt/c)), and √q falls evenly where the force is that of v².
#[test]
fn a_bead_without_inertia() -> Result<(), StepError> {
    let bead = Bead { k: 2.0, c: 0.5, dry: 0.0 };
    // Without the input the start is known, and the velocity is not.
    let start = State::from_velocity(&bead, [0.0], [0.0])?;
    assert_eq!(start.velocity(&bead), Err(StepError::DegenerateLagrangian { column: 0 }));
    let pulled = bead.driven([3.0]);
    assert_eq!(start.velocity(&pulled)?, vector![6.0]);
    let end = pulled.by(Gauss::<4>, 0.05).run(start).nth(19).unwrap()?.state;
    assert!((end.q[0] - 1.5 * (1.0 - f64::exp(-4.0))).abs() < 1e-12, "{end:?}");
    assert!((end.velocity(&pulled)?[0] - 6.0 * f64::exp(-4.0)).abs() < 1e-12);
    // It rests where nothing pulls, and where the spring holds the input.
    assert_eq!(bead.driven([0.0]).by(Gauss::<2>, 0.1).step(&start)?.state, start);
    let held = State { q: vector![1.5], ..start };
    assert_eq!(pulled.by(Gauss::<2>, 0.1).step(&held)?.state, held);

    let bead = Bead { k: 2.0, c: 0.0, dry: 0.5 };
    let (free, start) = (bead.driven([0.0]), State { q: vector![1.0], p: vector![0.0] });
    assert!((start.velocity(&free)?[0] + 2.0).abs() < 1e-15);
    let exact = |t: f64| (1.0 - t).powi(2);
    let end = free.by(Gauss::<4>, 0.05).run(start).nth(9).unwrap()?.state;
    assert!((end.q[0] - exact(0.5)).abs() < 1e-9 && (end.velocity(&free)?[0] + 1.0).abs() < 1e-9, "{end:?}");
    let off = |steps: usize| -> Result<f64, StepError> {
        let end = free.by(Midpoint, 0.5 / steps as f64).run(start).nth(steps - 1).unwrap()?.state;
        Ok((end.q[0] - exact(0.5)).abs())
    };
    assert!(off(20)? < 1e-3 && (off(20)? / off(40)? - 4.0).abs() < 0.1);
    Ok(())
}

/// Dry friction at the end of a spring without mass: it holds, or it slides by the force beyond its limit.
#[test]
fn dry_friction_without_mass() -> Result<(), StepError> {
    let start = State { q: vector![1.0, 0.0], p: vector![0.0, 0.0] };
    let held = Braked { limits: [0.0, 5.0], ..BRAKED };
    let off = |steps: usize| -> Result<f64, StepError> {
        let end = held.by(Proximal, 1.0 / steps as f64).run(start).nth(steps - 1).unwrap()?.state;
        assert!(end.q[1] == 0.0 && end.p[1] == 0.0, "{end:?}");
        Ok((end.q[0] - f64::cos(2.0)).abs())
    };
    assert!((off(200)? / off(400)? - 4.0).abs() < 0.05);

    // ẋ = B x + b of x = (q₀, q₁, v₀), as long as it slides forwards.
    let limit = 1.0;
    let slides = Braked { limits: [0.0, limit], ..BRAKED };
    let rates = Matrix4::new(
        0.0,
        0.0,
        1.0,
        0.0, //
        4.0 / 3.0,
        -4.0 / 3.0,
        0.0,
        -limit / 3.0, //
        -4.0,
        4.0,
        0.0,
        0.0, //
        0.0,
        0.0,
        0.0,
        0.0,
    );
    let exact = (rates * 0.3).exp() * Vector4::new(1.0, 0.0, 0.0, 1.0);
    let off = |steps: usize| -> Result<f64, StepError> {
        let end = slides.by(Proximal, 0.3 / steps as f64).run(start).nth(steps - 1).unwrap()?.state;
        assert!(end.p[1] == 0.0);
        let of_v = (end.velocity(&slides)?[1] - (4.0 * (exact[0] - exact[1]) - limit) / 3.0).abs();
        Ok((end.q - vector![exact[0], exact[1]]).amax().max((end.p[0] - exact[2]).abs()).max(of_v))
    };
    assert!(off(100)? < 1e-5 && (off(100)? / off(200)? - 4.0).abs() < 0.1);
    Ok(())
}

/// A step of a linear system is linear: A of it maps the state to its end. By `Proximal` p1 is 0 there, and
/// by the others what p0 is, but for its sign.
#[test]
fn derivatives_without_mass() -> Result<(), StepError> {
    let state = State { q: vector![0.7, -0.2], p: vector![0.4, 0.0] };
    let x = Vector4::new(0.7, -0.2, 0.4, 0.0);
    let by_midpoint = MAXWELL.by(Midpoint, 0.1).linearized(&state)?;
    let by_gauss = MAXWELL.by(Gauss::<2>, 0.1).linearized(&state)?;
    let by_proximal = BRAKED.by(Proximal, 0.1).linearized(&state)?;
    let found = [
        (by_midpoint.by_state()?, by_midpoint.step().state, -1.0),
        (by_gauss.by_state()?, by_gauss.step().state, 1.0),
        (by_proximal.by_state()?, by_proximal.step().state, 0.0),
    ];
    for (a, end, own) in found {
        let a = a.assembled::<4>();
        assert!((a * x - Vector4::new(end.q[0], end.q[1], end.p[0], end.p[1])).amax() < 1e-15);
        assert!((a[(3, 3)] - own).abs() < 1e-14 && a.row(3).columns(0, 3).amax() < 1e-15);
    }
    let to_velocity = PhaseMatrix::to_velocity(&MAXWELL, &state.q, &state.velocity(&MAXWELL)?)?;
    let pull = 4.0 / 3.0;
    assert_eq!(to_velocity.p_by_q, dalembert::nalgebra::matrix![0.0, 0.0; pull, -pull]);
    assert_eq!(to_velocity.p_by_p, dalembert::nalgebra::matrix![1.0, 0.0; 0.0, 0.0]);
    Ok(())
}

/// The branch of the flow is told by the friction in place of the mass; friction that pushes harder than the
/// spring pulls leaves it: the control, by Gauss rules of an odd number of stages. What forces took and what
/// the energy lost agree to rounding.
#[test]
fn certificate_and_ledger_without_mass() -> Result<(), StepError> {
    let start = State::from_velocity(&MAXWELL, [1.0, 0.0], [0.0, 0.0])?;
    for (c, is_on) in [(3.0, true), (-0.05, false)] {
        let system = Maxwell { c, ..MAXWELL };
        let (by_midpoint, by_gauss) = (system.by(Midpoint, 0.1), system.by(Gauss::<3>, 0.1));
        for certificate in [
            by_midpoint.certificate(&start, &by_midpoint.step(&start)?)?,
            by_gauss.certificate(&start, &by_gauss.step(&start)?)?,
        ] {
            assert_eq!(certificate.on_the_branch_of_the_flow, is_on, "{c}: {certificate:?}");
            assert!(certificate.condition < 100.0 && certificate.correction < 1e-14);
        }
    }
    let by = MAXWELL.by(Midpoint, 0.1);
    let end = by.step(&start)?.state;
    let ledger = by.ledger(&start, &end)?;
    assert!(ledger.dissipated > 0.01 && ledger.remainder().abs() < 1e-15, "{ledger:?}");
    Ok(())
}

/// A mass that is 0 at one configuration alone is none of these: at its pole a damped sphere has singular
/// coordinates.
#[test]
fn a_pole_is_no_coordinate_without_mass() {
    #[rayleigh_system(rule = midpoint)]
    fn sphere(q: [f64; 2], v: [f64; 2], c: f64) -> (f64, f64) {
        let turning = q[0].sin() * v[1];
        (0.5 * (v[0] * v[0] + turning * turning) - q[0].cos(), 0.5 * c * (v[0] * v[0] + v[1] * v[1]))
    }
    let found = State::from_velocity(&Sphere { c: 0.1 }, [0.0, 0.3], [0.1, 0.2]);
    assert_eq!(found, Err(StepError::SingularCoordinates { column: 1 }));
    let state = State { q: vector![0.0, 0.3], p: vector![0.1, 0.0] };
    let error = Sphere { c: 0.1 }.by(Midpoint, 0.1).step(&state).unwrap_err();
    assert_eq!(error, StepError::SingularCoordinates { column: 1 });
}
