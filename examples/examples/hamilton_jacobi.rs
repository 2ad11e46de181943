//! The Hamilton–Jacobi problem with friction: characteristics, sections, caustics.
//!
//! ```text
//! cargo run --release --example hamilton_jacobi
//! ```
//!
//! In the first row, the damped oscillator m q̈ + r q̇ + k q = 0 by the midpoint rule, whose complete
//! solution S_k = ½ s_k q² + λ_k q is known in closed form: all characteristics pass through one point. In
//! the second, a damped pendulum released at rest: the caustic is a curve with a cusp, and the carried
//! section folds over. Prints what holds of the paper's equations as printed and of the corrected ones.
//!
//! In the third row, two dimensions: a plane wave S_0 = λ·q passes a hollow under friction C = 2aM. The
//! trapezoidal rule is conformally symplectic there, so that S_k is carried by S_{k+1}∘F_k = cS_k + G; its
//! level sets, the wave fronts, have cusps on the caustic. Prints Jacobi's constants c^{−k} ∂S_k/∂λ.

use anyhow::Result;
use dalembert::hamilton_jacobi::{
    Caustic, Characteristic, ConformalHamiltonJacobi, FamilyMember, GeneratingFamily, HamiltonJacobi,
};
use dalembert::{Discretise, Midpoint, ScalarField, State, Trapezoidal, rayleigh_system};
use dalembert_examples::picture::{self, Curve, Dash, Mark, Panel, colour, linear};
use nalgebra::{SMatrix, SVector, vector};

#[rayleigh_system]
fn oscillator(q: [f64; 1], v: [f64; 1], m: f64, k: f64, r: f64) -> (f64, f64) {
    (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0], 0.5 * r * v[0] * v[0])
}

#[rayleigh_system]
fn pendulum(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
}

/// S_k = ½ s q² + λ q + c.
struct Quadratic {
    s: f64,
    lambda: f64,
    constant: f64,
}

impl ScalarField<1> for Quadratic {
    type Scalar = f64;

    fn value(&self, q: &SVector<f64, 1>) -> f64 {
        0.5 * self.s * q[0] * q[0] + self.lambda * q[0] + self.constant
    }

    fn gradient(&self, q: &SVector<f64, 1>) -> SVector<f64, 1> {
        vector![self.s * q[0] + self.lambda]
    }

    fn hessian(&self, _q: &SVector<f64, 1>) -> SMatrix<f64, 1, 1> {
        SMatrix::from_element(self.s)
    }
}

/// The oscillator's S_0, …, S_K with the parameters λ_0 = `lambda` and ϕ_0 = `phase`.
fn complete_solution(system: &Oscillator, h: f64, phase: f64, lambda: f64, steps: usize) -> Vec<Quadratic> {
    let Oscillator { m, k, r } = *system;
    let (alpha, beta, rho) = (m / h - k * h / 4.0, m / h + k * h / 4.0, r / 2.0);
    let omega = (k * m - rho * rho).sqrt();
    let shrinkage = ((beta - rho) / (beta + rho)).sqrt();
    let angle = |k: usize| phase + k as f64 * omega.atan2(alpha);
    let mut constant = 0.0;
    (0..=steps)
        .map(|k| {
            let s = |k: usize| -rho - omega * angle(k).tan();
            let lambda = |k: usize| lambda * shrinkage.powi(k as i32) * phase.cos() / angle(k).cos();
            let function = Quadratic { s: s(k), lambda: lambda(k), constant };
            let mu = lambda(k) / (beta + rho);
            constant += 0.5 * (alpha - s(k + 1)) * mu * mu - lambda(k + 1) * mu;
            function
        })
        .collect()
}

/// Friction C = 2aM on a plane with a hollow.
#[rayleigh_system(rule = trapezoidal)]
fn hollow(q: [f64; 2], v: [f64; 2], a: f64) -> (f64, f64) {
    let kinetic = 0.5 * (v[0] * v[0] + v[1] * v[1]);
    let potential = -(-2.0 * ((q[0] - 1.0) * (q[0] - 1.0) + q[1] * q[1])).exp();
    (kinetic - potential, 2.0 * a * kinetic)
}

/// S_0 = λ·q: plane waves.
struct PlaneWaves;

impl GeneratingFamily<2> for PlaneWaves {
    type Scalar = f64;

    fn value(&self, q: &SVector<f64, 2>, lambda: &SVector<f64, 2>) -> f64 {
        lambda.dot(q)
    }

    fn gradient(&self, _q: &SVector<f64, 2>, lambda: &SVector<f64, 2>) -> SVector<f64, 2> {
        *lambda
    }

    fn hessian(&self, _q: &SVector<f64, 2>, _lambda: &SVector<f64, 2>) -> SMatrix<f64, 2, 2> {
        SMatrix::zeros()
    }

    fn by_parameters(&self, q: &SVector<f64, 2>, _lambda: &SVector<f64, 2>) -> SVector<f64, 2> {
        *q
    }

    fn mixed(&self, _q: &SVector<f64, 2>, _lambda: &SVector<f64, 2>) -> SMatrix<f64, 2, 2> {
        SMatrix::identity()
    }
}

type Waves<'a> = ConformalHamiltonJacobi<'a, Hollow, Trapezoidal, 2>;

const LAMBDA: SVector<f64, 2> = vector![1.5, 0.0];

/// Points of the level set of S_k that passes through the middle characteristic: for each height y the label
/// (x, y) with that value, by Newton's method, as dS_k∘c_k = p_kᵀ Q_k.
fn front(waves: &Waves<'_>, k: usize, heights: &[f64]) -> Result<Vec<(f64, f64)>> {
    let wave = FamilyMember { family: &PlaneWaves, lambda: LAMBDA };
    let level = waves.carry(&wave, &vector![0.0, 0.0], k)?.value();
    let mut label = vector![0.0, 0.0];
    let at = |&y: &f64| {
        label[1] = y;
        loop {
            let carried = waves.carry(&wave, &label, k)?;
            let slope = carried.characteristic.frames[k].q.tr_mul(&carried.end().p)[0];
            let miss = level - carried.value();
            if miss.abs() < 1e-9 {
                return Ok((carried.end().q[0], carried.end().q[1]));
            }
            label[0] += miss / slope;
        }
    };
    heights.iter().map(at).collect()
}

/// `count` numbers from `from` to `to`.
fn spread(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..count).map(|i| from + (to - from) * i as f64 / (count - 1) as f64).collect()
}

fn main() -> Result<()> {
    let (h, steps) = (0.25, 20);
    let system = Oscillator { m: 1.0, k: 1.0, r: 0.5 };
    let theory = system.by(Midpoint, h).hamilton_jacobi();
    let family = complete_solution(&system, h, -0.4, 0.7, steps);
    let carry = |q: f64| theory.carry(&family[0], &vector![q], steps);
    let fan = spread(-2.0, 2.0, 17).into_iter().map(carry).collect::<Result<Vec<_>, _>>()?;
    println!("Damped oscillator, m = k = 1, r = 1/2, h = 1/4, closed-form S_k, k = 0 … {steps}\n");
    let samples = spread(-2.0, 2.0, 9).into_iter().map(|q| vector![q]).collect::<Vec<_>>();
    println!("{}", theory.check_generating_functions(&family, &samples)?);
    println!("{}", theory.characteristics_report(&fan)?);
    let trajectory: Vec<_> = fan[12].states.iter().map(|state| state.q).collect();
    println!("The same S_k in the equations as the paper prints them, on the characteristic from q = 1:\n");
    println!("{}", theory.as_printed(&family, &trajectory)?);
    println!("{}", theory.along_trajectory(&trajectory)?);
    println!("{}", theory.hamilton_equations(&trajectory)?);

    let (rest, swings) = (Quadratic { s: 0.0, lambda: 0.0, constant: 0.0 }, 40);
    let swinging = Pendulum { r: 0.1 };
    let swing = swinging.by(Midpoint, 0.1).hamilton_jacobi();
    let swing_carry = |q: f64| swing.carry(&rest, &vector![q], swings);
    let swing_fan = spread(-2.9, 2.9, 41).into_iter().map(swing_carry).collect::<Result<Vec<_>, _>>()?;
    println!("Damped pendulum, r = 1/10, h = 1/10, released at rest\n");
    println!("{}", swing.characteristics_report(&swing_fan)?);
    let dense = spread(-2.9, 2.9, 401).into_iter().map(swing_carry).collect::<Result<Vec<_>, _>>()?;

    let plane = Hollow { a: 0.1 };
    let states = [State { q: vector![0.0, 0.0], p: LAMBDA }];
    let waves = plane.by(Trapezoidal, 0.1).conformal_hamilton_jacobi(&states)?;
    let constants = waves.jacobi_constants(&PlaneWaves, &LAMBDA, &vector![0.0, 0.4], 12, 0.01)?;
    println!("Plane wave past a hollow, C = 2aM, a = h = 1/10: c = {:.15}", waves.factor());
    println!(
        "  c^−k ∂S_k/∂λ along one trajectory, k = 0 … 12: off by {:.1e}, with an error of {:.1e}\n",
        constants.drift(),
        constants.difference_error
    );

    let past = ([("t = 0", 0), ("t = 0.8", 8), ("t = 1.6", 16), ("t = 2.2", 22), ("t = 2.8", 28)], 0, 30);
    let behind =
        ([("t = 1.1", 11), ("t = 1.3", 13), ("t = 1.5", 15), ("t = 1.7", 17), ("t = 1.9", 19)], 10, 20);
    let theory = plane.by(Trapezoidal, 0.1).hamilton_jacobi();

    // Lines of the sections in closed form, over the range that the fan covers at that time.
    let lines = [("t = 0", 0), ("t = 1", 4), ("t = 2", 8), ("t = 2.25", 9), ("t = 3.5", 14)];
    let carried = lines.map(|(_, k)| section_points(&fan, k));
    let lines = lines.map(|(label, k)| {
        let on_line = |characteristic: &Characteristic<f64, 1>| {
            let q = characteristic.states[k].q;
            (q[0], family[k].gradient(&q)[0])
        };
        (label, [&fan[0], &fan[fan.len() - 1]].map(on_line).to_vec())
    });
    let folds = [("t = 0", 0), ("t = 1", 10), ("t = 1.6", 16), ("t = 2", 20), ("t = 3", 30)]
        .map(|(label, k)| (label, section_points(&dense, k)));
    let path = picture::write(
        "hamilton_jacobi",
        [1240, 1740],
        2,
        &[
            fan_panel("Damped oscillator: all characteristics meet", h, &fan, &caustics(&fan)),
            section_panel("Its sections: carried points on closed-form lines", lines, carried),
            fan_panel("Damped pendulum from rest: a caustic with a cusp", 0.1, &swing_fan, &caustics(&dense)),
            section_panel("Its sections fold over beyond the caustic", folds, Default::default()),
            wave_panel("A plane wave past a hollow: fronts S_k = const", &waves, &theory, 1.5, past)?,
            wave_panel(
                "Behind the focus the fronts have cusps, on the caustic",
                &waves,
                &theory,
                0.7,
                behind,
            )?,
        ],
    )?;
    println!("picture: {}", path.display());
    Ok(())
}

fn caustics(fan: &[Characteristic<f64, 1>]) -> Vec<Caustic<1>> {
    fan.iter().flat_map(|characteristic| characteristic.caustics.clone()).collect()
}

/// (q_k, p_k) on every characteristic.
fn section_points(fan: &[Characteristic<f64, 1>], k: usize) -> Vec<(f64, f64)> {
    fan.iter().map(|characteristic| (characteristic.states[k].q[0], characteristic.states[k].p[0])).collect()
}

/// The characteristics over time, and the caustic over them.
fn fan_panel<'a>(
    title: &'a str,
    h: f64,
    fan: &[Characteristic<f64, 1>],
    caustics: &[Caustic<1>],
) -> Panel<'a> {
    // Few long steps: lines from state to state would be taken for the motion.
    let has_dots = fan.len() < 20;
    let mut curves: Vec<_> = fan
        .iter()
        .enumerate()
        .map(|(index, characteristic)| {
            let label = if index > 0 {
                ""
            } else if has_dots {
                "characteristics, a dot a step"
            } else {
                "characteristics"
            };
            let states = characteristic.states.iter().enumerate();
            let points = states.map(|(k, state)| (k as f64 * h, state.q[0])).collect();
            let curve = Curve::line(label, colour::VARIATIONAL, 1, points);
            if has_dots { curve.marked(Mark::Dot, 1) } else { curve }
        })
        .collect();
    let points = caustics.iter().map(|c| ((c.step as f64 + c.fraction) * h, c.q[0])).collect();
    let caustic = Curve::line("caustic, det Q = 0", colour::RUNGE_KUTTA, 4, points);
    // One that is a single point needs a mark.
    curves.push(if fan.len() == caustics.len() { caustic.marked(Mark::Circle, 1) } else { caustic });
    Panel::new(
        title,
        linear("time t = kh (dimensionless)"),
        linear("configuration q (dimensionless)"),
        curves,
    )
}

/// Sections in the phase plane, and on them the points of a carried fan.
fn section_panel<'a>(
    title: &'a str,
    lines: [(&'a str, Vec<(f64, f64)>); 5],
    carried: [Vec<(f64, f64)>; 5],
) -> Panel<'a> {
    let styles = [
        (colour::REFERENCE, Dash::Solid, Mark::Disc),
        (colour::VARIATIONAL, Dash::Dashed, Mark::Circle),
        (colour::EULER, Dash::DashDotted, Mark::Triangle),
        (colour::FOURTH, Dash::Dotted, Mark::Square),
        (colour::RUNGE_KUTTA, Dash::Solid, Mark::Cross),
    ];
    let mut curves = Vec::new();
    for (((label, points), carried), (colour, dash, mark)) in lines.into_iter().zip(carried).zip(styles) {
        curves.push(Curve::line(label, colour, 2, points).dashed(dash));
        curves.push(Curve::marks("", colour, mark, carried));
    }
    Panel::new(title, linear("configuration q (dimensionless)"), linear("momentum p (dimensionless)"), curves)
}

/// The fronts at `ks`, over characteristics from a line of labels or without, and the caustic.
fn wave_panel<'a>(
    title: &'a str,
    waves: &Waves<'_>,
    theory: &HamiltonJacobi<'_, Hollow, Trapezoidal, 2>,
    reach: f64,
    (fronts, from, steps): ([(&'a str, usize); 5], usize, usize),
) -> Result<Panel<'a>> {
    let wave = FamilyMember { family: &PlaneWaves, lambda: LAMBDA };
    let fan = |count: usize, steps: usize| {
        let carry = |y: f64| theory.carry(&wave, &vector![0.0, y], steps);
        spread(-reach, reach, count).into_iter().map(carry).collect::<Result<Vec<_>, _>>()
    };
    let mut curves = Vec::new();
    for (index, characteristic) in fan(41, steps)?.iter().enumerate() {
        let label = if index == 0 { "characteristics" } else { "" };
        let states = characteristic.states.iter().skip(from);
        let points = states.map(|state| (state.q[0], state.q[1])).collect();
        curves.push(Curve::line(label, colour::GREY, 1, points));
    }
    let styles = [
        (colour::REFERENCE, Dash::Solid),
        (colour::FOURTH, Dash::Solid),
        (colour::EULER, Dash::Dashed),
        (colour::VARIATIONAL, Dash::Solid),
        (colour::FIFTH, Dash::DashDotted),
    ];
    for ((label, k), (colour, dash)) in fronts.into_iter().zip(styles) {
        let points = front(waves, k, &spread(-reach, reach, 241))?;
        curves.push(Curve::line(label, colour, 3, points).dashed(dash));
    }
    let dense = fan(1601, steps)?;
    let caustic = dense.iter().flat_map(|characteristic| &characteristic.caustics);
    let points = caustic.map(|caustic| (caustic.q[0], caustic.q[1])).collect();
    curves.push(Curve::line("caustic, det Q = 0", colour::RUNGE_KUTTA, 4, points));
    let (x, y) = (linear("q₀ (dimensionless)"), linear("q₁ (dimensionless)"));
    Ok(Panel::new(title, x, y, curves).to_equal_scale())
}
