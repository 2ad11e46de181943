//! An order barrier: where friction and springs do not commute, a method of order above 2 has no R_d as a map
//! of (q, p). In q alone order 4 can be had.
//!
//! A step with A = [[a, b], [·, d]] has L_d and R_d if and only if a bᵀ and bᵀd are symmetric. For M = I the
//! exact motion has
//!
//! ```text
//! a bᵀ − b aᵀ = −(h⁴/12)(CK − KC) + …,     bᵀd − dᵀb = +(h⁴/12)(CK − KC) + …
//! ```
//!
//! and so has every method of order above 3; the error of one of order 3 adds to both with the same sign, so
//! that it cannot cancel them. Drawn are both asymmetries of all methods for one pair of springs with CK ≠
//! KC. The discrete Rayleigh system of order 4 in q has none: its p is M v less (h²/12) CM⁻¹∇V, so that as a
//! map of (q, M v) it would be of order 4, and has no R_d. The table below says what it is worth.
//!
//! ```text
//! cargo run --release --example order_barrier [picture.svg]
//! ```

use anyhow::Result;
use dalembert::nalgebra::{Matrix2, SVector, Vector2, matrix, vector};
use dalembert::rayleigh::{OrderFour, PotentialEnergy, RayleighStep};
use dalembert::step::Flow;
use dalembert::{
    Composition, Discretise, Fitted, FittedTrapezoidal, Gauss, Midpoint, OneSided, Splitting, State,
    Trapezoidal, rayleigh_system,
};
use dalembert_examples::picture::{self, Curve, Dash, Mark, Panel, RGBColor, colour, logarithmic};

/// M = I, C = diag(0.8, 0.2), K = [[2, −0.7], [−0.7, 1]]: (CK − KC)₁₀ = 0.42.
#[rayleigh_system(rule = [midpoint, trapezoidal, gauss, fitted, fitted_trapezoidal, one_sided])]
fn springs(q: [f64; 2], v: [f64; 2]) -> (f64, f64) {
    let potential = q[0] * q[0] - 0.7 * q[0] * q[1] + 0.5 * q[1] * q[1];
    (0.5 * (v[0] * v[0] + v[1] * v[1]) - potential, 0.4 * v[0] * v[0] + 0.1 * v[1] * v[1])
}

const BRACKET: f64 = 0.42;
const DAMPING: Matrix2<f64> = matrix![0.8, 0.0; 0.0, 0.2];
const STIFFNESS: Matrix2<f64> = matrix![2.0, -0.7; -0.7, 1.0];

/// V of the same springs, by hand.
#[derive(Clone, Copy)]
struct Potential;

impl PotentialEnergy<2> for Potential {
    fn value(&self, q: &Vector2<f64>) -> f64 {
        0.5 * q.dot(&(STIFFNESS * q))
    }
    fn gradient(&self, q: &Vector2<f64>) -> Vector2<f64> {
        STIFFNESS * q
    }
    fn hessian(&self, _q: &Vector2<f64>) -> Matrix2<f64> {
        STIFFNESS
    }
    fn third(&self, _q: &Vector2<f64>, _w: &Vector2<f64>) -> Matrix2<f64> {
        Matrix2::zeros()
    }
}

/// Where the motions of the table start: q, and v = p.
const START: [SVector<f64, 2>; 2] = [vector![0.3, -0.4], vector![0.1, 0.2]];

fn order_four(h: f64) -> Result<OrderFour<Potential, 2>> {
    Ok(OrderFour::new(Matrix2::identity(), DAMPING, Potential, h)?)
}

/// An entry (1, 0) with what counts as 0 of it.
#[derive(Clone, Copy)]
struct Asymmetry {
    h: f64,
    size: f64,
    tolerance: f64,
}

impl Asymmetry {
    fn vanishes(&self) -> bool {
        self.size <= self.tolerance
    }
}

/// |a bᵀ − b aᵀ| and |bᵀd − dᵀb| at all step sizes.
struct Method {
    name: &'static str,
    look: (RGBColor, Mark),
    ends: [Vec<Asymmetry>; 2],
}

impl Method {
    fn of<M: Copy>(name: &'static str, look: (RGBColor, Mark), method: M) -> Result<Self>
    where
        Springs: Flow<M, 2, Scalar = f64>,
    {
        // The motion is linear: any state does.
        let state = [State { q: START[0], p: START[1] }];
        Self::judged(name, look, |h| Ok(Springs {}.by(method, h).rayleigh_step(&state)?))
    }

    fn judged(
        name: &'static str,
        look: (RGBColor, Mark),
        judge: impl Fn(f64) -> Result<RayleighStep>,
    ) -> Result<Self> {
        let mut ends = [Vec::new(), Vec::new()];
        for h in step_sizes() {
            let found = judge(h)?;
            for (end, found) in ends.iter_mut().zip([found.at_start, found.at_end]) {
                end.push(Asymmetry { h, size: found.value.abs(), tolerance: found.tolerance });
            }
        }
        Ok(Self { name, look, ends })
    }
}

const TIME: f64 = 4.0;

/// From 0.4 down to 0.0125, eight to a factor 4.
fn step_sizes() -> impl Iterator<Item = f64> {
    (0..=20).map(|k| 0.4 * 0.5_f64.powf(0.25 * f64::from(k)))
}

fn main() -> Result<()> {
    let methods = [
        Method::of("one-sided (order 1)", (colour::SIXTH, Mark::Disc), OneSided)?,
        Method::of("midpoint (2)", (colour::VARIATIONAL, Mark::Circle), Midpoint)?,
        Method::of("trapezoidal (2)", (colour::EULER, Mark::Square), Trapezoidal)?,
        Method::of("fitted trapezoidal (2)", (colour::REFERENCE, Mark::Cross), FittedTrapezoidal)?,
        Method::of("fitted (2)", (colour::EULER, Mark::Triangle), Fitted)?,
        Method::of("Gauss 2 (order 4)", (colour::RUNGE_KUTTA, Mark::Circle), Gauss::<2>)?,
        Method::of("Gauss 3 (6)", (colour::VARIATIONAL, Mark::Square), Gauss::<3>)?,
        Method::of("splitting (6)", (colour::FIFTH, Mark::Cross), Splitting::blanes_moan_6())?,
        Method::of("composition (8)", (colour::FOURTH, Mark::Disc), Composition::kahan_li_8(Midpoint))?,
        Method::judged("order 4 in q", (colour::FIFTH, Mark::Triangle), |h| {
            let system = order_four(h)?;
            Ok(RayleighStep::of(&[system.step_matrix(&system.start(START[0], START[1]))?], None)?)
        })?,
    ];
    report(&methods);
    errors()?;
    let titles =
        ["Start, a bᵀ − b aᵀ: 0 up to order 2, or ∝ h⁴", "End, bᵀd − dᵀb: one-sided is off too, ∝ h⁴"];
    let panels = [0, 1].map(|end| panel(titles[end], &methods, end));
    let path = picture::write("order_barrier", [1240, 800], 2, &panels)?;
    println!("\nPicture: {}", path.display());
    Ok(())
}

fn report(methods: &[Method]) {
    println!(
        "Two coordinates, M = I, CK ≠ KC: is a bᵀ symmetric, and bᵀd? At h = 0.025; all dimensionless\n"
    );
    println!("method (order)           |a bᵀ − b aᵀ|   slope   |bᵀd − dᵀb|   slope   R_d");
    for Method { name, ends, .. } in methods {
        let column = |end: &[Asymmetry]| {
            let (at, half) = (end[16], end[20]);
            let slope = (at.size / half.size).log2();
            if at.vanishes() {
                "0 to rounding      —".into()
            } else {
                format!("{:13.3e}   {slope:4.2}", at.size)
            }
        };
        let has_one = ends.iter().flatten().all(Asymmetry::vanishes);
        let answer = if has_one { "yes" } else { "no" };
        println!("{name:24} {}   {}   {answer}", column(&ends[0]), column(&ends[1]));
    }
    println!("{:24} {:13.3e}   4.00 {:15.3e}   4.00", "(h⁴/12)|CK − KC|", leading(0.025), leading(0.025));
}

/// Errors after t = 4 by three methods, held against Gauss with four stages in short steps.
fn errors() -> Result<()> {
    fn end<M: Copy>(method: M, h: f64) -> Result<[SVector<f64, 2>; 2]>
    where
        Springs: Flow<M, 2, Scalar = f64>,
    {
        let state = State { q: START[0], p: START[1] };
        let steps = (TIME / h).round() as usize;
        let end = Springs {}.by(method, h).run(state).take(steps).last().expect("steps are taken")?.state;
        Ok([end.q, end.p])
    }
    let [q, p] = end(Gauss::<4>, 0.01)?;
    println!("\nErrors of q and of M v at t = {TIME}, largest component; all dimensionless\n");
    println!("              midpoint, has an R_d   order 4 in q, has an R_d    Gauss 2, has none");
    println!("     h            q        M v            q        M v            q        M v");
    for h in [0.4, 0.2, 0.1, 0.05] {
        let system = order_four(h)?;
        let mut state = system.start(START[0], START[1]);
        for _ in 0..(TIME / h).round() as usize {
            state = system.step(&state)?;
        }
        let ends = [end(Midpoint, h)?, [state.q, system.velocity(&state)?], end(Gauss::<2>, h)?];
        let errors =
            ends.map(|[of_q, of_p]| format!("{:8.1e}   {:8.1e}", (of_q - q).amax(), (of_p - p).amax()));
        println!("{h:6.2}     {}", errors.join("     "));
    }
    Ok(())
}

fn leading(h: f64) -> f64 {
    h.powi(4) / 12.0 * BRACKET
}

fn panel<'a>(title: &'a str, methods: &[Method], end: usize) -> Panel<'a> {
    let points = step_sizes().map(|h| (h, leading(h))).collect();
    let mut curves = vec![Curve::line("(h⁴/12)|CK − KC|", colour::GREY, 3, points)];
    for (index, Method { name, look: (colour, mark), ends }) in methods.iter().enumerate() {
        // Many are one line: each has its marks at step sizes of its own.
        let points = ends[end].iter().skip(index % 4).step_by(4);
        curves.push(Curve::marks(name, *colour, *mark, points.map(|at| (at.h, at.size)).collect()));
    }
    let tolerance = methods[1].ends[end].iter().map(|at| (at.h, at.tolerance)).collect();
    curves.push(Curve::line("below: counts as 0", colour::GREY, 3, tolerance).dashed(Dash::Dotted));
    Panel::new(
        title,
        logarithmic("step size h (dimensionless)"),
        // Exact zeros stand at the floor.
        logarithmic("asymmetry (dimensionless)").with_floor(1e-20),
        curves,
    )
}
