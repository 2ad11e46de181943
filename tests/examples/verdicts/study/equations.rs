//! The equations of every rule, written down again: residuals of what a step returned, in twice the
//! precision, each with its bound of rounding. Nothing here is the runtime's.

use dalembert::State;
use dalembert::step::Step;

use dalembert_tests::rounded::Rounded;
use double_double::DoubleDouble;

/// A covector or vector of N coordinates.
pub type Vector<const N: usize> = [Rounded; N];

/// ∂L/∂q, ∂L/∂v, ∂R/∂v at a point.
#[derive(Clone, Copy, Debug)]
pub struct Slopes<const N: usize> {
    /// ∂L/∂q.
    pub force: Vector<N>,
    /// ∂L/∂v.
    pub momentum: Vector<N>,
    /// ∂R/∂v.
    pub drag: Vector<N>,
}

/// A system whose first derivatives are written down a second time.
pub trait Reference<const N: usize> {
    /// The slopes at (q, v).
    fn slopes(&self, q: &Vector<N>, v: &Vector<N>) -> Slopes<N>;

    /// m and r, where L = ½m|v|² − V(q) and R = ½r|v|²; of other systems nothing that means anything.
    fn mass_and_damping(&self) -> [Rounded; 2];
}

/// A residual may be this many times the first-order bound of the rounding in its equation, with unit ε/2.
///
/// A residual as computed may be 4 floors of 4ε = 32 units for each of the terms in a floor; the bound has a
/// unit for each of them. The difference to the residual as it is, and what p1 and q1 are rounded by, make a
/// few more.
pub const MOST: f64 = 36.0;

/// How a step is held against the equations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judged {
    /// The largest residual over its bound.
    pub ratio: f64,
    /// Whether the bound is above a thousandth of the terms of its equation, so that rounding decides it.
    pub is_undecided: bool,
    /// Whether the equation overflows as it is written down here, so that nothing is said.
    pub is_beyond: bool,
}

impl Judged {
    /// Of a step that was not looked at.
    pub const NOTHING: Self = Self { ratio: 0.0, is_undecided: false, is_beyond: false };

    /// Whether the step violates the definition.
    pub fn is_violation(&self) -> bool {
        self.ratio.is_nan() || self.ratio > MOST
    }

    fn hold(&mut self, residual: Rounded, terms: f64) {
        let (size, bound) = (residual.value.high.abs(), residual.error + 4.0 * f64::MIN_POSITIVE);
        if !bound.is_finite() || !size.is_finite() {
            self.is_beyond = true;
            return;
        }
        self.ratio = self.ratio.max(size / bound);
        let decidable = 1e-3 * terms + 8.0 * f64::MIN_POSITIVE;
        self.is_undecided |= decidable.is_nan() || bound > decidable;
    }
}

/// The rules of one stage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OneStage {
    /// One node in the middle.
    Midpoint,
    /// One at each end.
    Trapezoidal,
}

fn inputs<const N: usize>(vector: &nalgebra::SVector<f64, N>) -> Vector<N> {
    std::array::from_fn(|i| Rounded::input(vector[i]))
}

fn combined<const N: usize>(of: impl Fn(usize) -> Rounded) -> Vector<N> {
    std::array::from_fn(of)
}

/// p0 and p1 of the segment, with the size of the terms of p0.
fn momenta<S: Reference<N>, const N: usize>(
    rule: OneStage,
    system: &S,
    q: &Vector<N>,
    v: &Vector<N>,
    h: Rounded,
) -> (Vector<N>, Vector<N>, [f64; N]) {
    let at = |share: f64| system.slopes(&combined(|i| q[i] + h * share * v[i]), v);
    let (momentum, before, after, drag): (_, _, _, Vector<N>) = match rule {
        OneStage::Midpoint => {
            let m = at(0.5);
            let drag = combined(|i| m.drag[i] * 0.5);
            let force = combined(|i| m.force[i] * 0.5);
            (m.momentum, force, force, drag)
        }
        OneStage::Trapezoidal => {
            let (start, end) = (at(0.0), at(1.0));
            let drag = combined(|i| (start.drag[i] + end.drag[i]) * 0.25);
            let momentum = combined(|i| (start.momentum[i] + end.momentum[i]) * 0.5);
            (momentum, start.force.map(|f| f * 0.5), end.force.map(|f| f * 0.5), drag)
        }
    };
    let p0 = combined(|i| momentum[i] - h * before[i] + h * drag[i]);
    let p1 = combined(|i| momentum[i] + h * after[i] - h * drag[i]);
    let terms = std::array::from_fn(|i| momentum[i].size() + (h * before[i]).size() + (h * drag[i]).size());
    (p0, p1, terms)
}

/// A step of a rule of one stage: 𝔽⁻, q1 and 𝔽⁺.
pub fn one_stage<S: Reference<N>, const N: usize>(
    rule: OneStage,
    system: &S,
    state: &State<f64, N>,
    h: f64,
    step: &Step<f64, N>,
) -> Judged {
    let (q, p, v) = (inputs(&state.q), inputs(&state.p), inputs(&step.velocity));
    let size = Rounded::input(h);
    let (p0, p1, terms) = momenta(rule, system, &q, &v, size);
    ends(state, size, step, |i| {
        let terms = terms[i] + p[i].size();
        [(p0[i], terms), (p1[i], terms)]
    })
}

/// A step with the damping implicit at both ends, from the velocity `v1` at its end: 𝔽⁻, q1, the equation for
/// v1, and p1.
pub fn both_ends<S: Reference<N>, const N: usize>(
    system: &S,
    state: &State<f64, N>,
    h: f64,
    step: &Step<f64, N>,
    v1: &nalgebra::SVector<f64, N>,
) -> Judged {
    let (q, v, v1) = (inputs(&state.q), inputs(&step.velocity), inputs(v1));
    let half = Rounded::input(h) * 0.5;
    let middle = combined(|i| q[i] + half * v[i]);
    let (m, drag) = (system.slopes(&middle, &v), system.slopes(&middle, &v1).drag);
    let momentum = system.slopes(&inputs(&step.state.q), &v1).momentum;
    let mut judged = ends(state, Rounded::input(h), step, |i| {
        let (force, own) = (half * m.force[i], half * m.drag[i]);
        let terms = m.momentum[i].size() + force.size() + own.size() + state.p[i].abs();
        [(m.momentum[i] - force + own, terms), (momentum[i], momentum[i].size())]
    });
    for i in 0..N {
        let (force, own) = (half * m.force[i], half * drag[i]);
        let terms = m.momentum[i].size() + force.size() + own.size() + momentum[i].size();
        judged.hold(m.momentum[i] + force - momentum[i] - own, terms);
    }
    judged
}

/// Both ends of a step: 𝔽⁻ and 𝔽⁺ by the momenta that its mean velocity has there, each with the size of its
/// terms, and q1.
fn ends<const N: usize>(
    state: &State<f64, N>,
    h: Rounded,
    step: &Step<f64, N>,
    momenta: impl Fn(usize) -> [(Rounded, f64); 2],
) -> Judged {
    let mut judged = Judged::NOTHING;
    for i in 0..N {
        let [(p0, terms), (p1, terms_after)] = momenta(i);
        judged.hold(p0 - Rounded::input(state.p[i]), terms);
        let q0 = Rounded::input(state.q[i]);
        let q1 = q0 + h * Rounded::input(step.velocity[i]);
        judged.hold(q1 - Rounded::input(step.state.q[i]), q1.size() + q0.size());
        // p1 = p + (p1 − p0): the rounding of both.
        let mut p1 = p1 - Rounded::input(step.state.p[i]);
        p1.error += p0.error;
        judged.hold(p1, terms_after);
    }
    judged
}

/// Of z the function `f`, by which an error grows at most `growth` times.
fn function(z: Rounded, growth: f64, f: impl Fn(DoubleDouble) -> DoubleDouble) -> Rounded {
    let value = f(z.value);
    let carried = if z.size() > 0.0 { z.error / z.size() } else { 0.0 };
    Rounded { value, error: (carried * growth + f64::EPSILON) * value.high.abs() }
}

/// z(coth z + 1) = 2z/(1 − e⁻²ᶻ).
fn before(z: Rounded) -> Rounded {
    function(z, 1.0 + 2.0 * z.size(), |z| {
        let twice = z + z;
        // Beyond, what is left out is below the last digit.
        match z.high {
            0.0 => DoubleDouble::new(1.0),
            40.0.. => twice,
            ..-40.0 => -twice * twice.exp(),
            _ => twice / -(-twice).exp_m1(),
        }
    })
}

/// The function of Langevin, coth z − 1/z.
fn langevin(z: Rounded) -> Rounded {
    function(z, 1.0, |z| {
        let one = DoubleDouble::new(1.0);
        if z.high.abs() < 1e-4 {
            // The next term is 10⁻¹⁸ of it.
            return z / DoubleDouble::new(3.0) - z * z * z / DoubleDouble::new(45.0);
        }
        one / z.tanh() - one / z
    })
}

/// A step of a rule fitted to linear damping: the midpoint rule or, `is_explicit`, the trapezoidal rule. For
/// mass and damping that are numbers, z = hr/2m:
///
/// ```text
/// p0 = m z (coth z + 1) v̄ + (h/2)(1 + ℒ(z)) ∇V(q̄)        p0 = m z (coth z + 1) v̄ + (h/2) ∇V(q0)
/// p1 = m z (coth z − 1) v̄ − (h/2)(1 − ℒ(z)) ∇V(q̄)        p1 = m z (coth z − 1) v̄ − (h/2) ∇V(q1)
/// ```
pub fn fitted<S: Reference<N>, const N: usize>(
    is_explicit: bool,
    system: &S,
    state: &State<f64, N>,
    h: f64,
    step: &Step<f64, N>,
) -> Judged {
    let (q, p, v) = (inputs(&state.q), inputs(&state.p), inputs(&step.velocity));
    let h = Rounded::input(h);
    let [mass, damping] = system.mass_and_damping();
    let z = h * damping / mass * 0.5;
    let force = |share: f64| {
        let at = combined(|i| q[i] + h * share * v[i]);
        system.slopes(&at, &[Rounded::ZERO; N]).force.map(|f| h * 0.5 * f)
    };
    let (start, end) = if is_explicit {
        (force(0.0), force(1.0))
    } else {
        let (middle, lag) = (force(0.5), langevin(z));
        (middle.map(|f| (lag + 1.0) * f), middle.map(|f| (-lag + 1.0) * f))
    };
    ends(state, h, step, |i| {
        let of_velocity = [mass * before(z) * v[i], mass * before(-z) * v[i]];
        let terms = of_velocity[0].size() + start[i].size() + p[i].size();
        let terms_after = terms + of_velocity[1].size() + end[i].size();
        [(of_velocity[0] - start[i], terms), (of_velocity[1] + end[i], terms_after)]
    })
}

/// The velocity of a state: ∂L/∂v(q, v) = p.
pub fn velocity<S: Reference<N>, const N: usize>(
    system: &S,
    state: &State<f64, N>,
    v: &nalgebra::SVector<f64, N>,
) -> Judged {
    let slopes = system.slopes(&inputs(&state.q), &inputs(v));
    let mut judged = Judged::NOTHING;
    for i in 0..N {
        let p = Rounded::input(state.p[i]);
        judged.hold(slopes.momentum[i] - p, slopes.momentum[i].size() + p.size());
    }
    judged
}

/// A step of a Gauss rule with the velocities `v` at its stages: the equations of all stages, q1 and p1.
pub fn gauss<S: Reference<N>, const N: usize, const STAGES: usize>(
    tableau: &super::tableau::Tableau,
    system: &S,
    state: &State<f64, N>,
    h: f64,
    v: &[nalgebra::SVector<f64, N>; STAGES],
    end: &State<f64, N>,
) -> Judged {
    let (q0, p0) = (inputs(&state.q), inputs(&state.p));
    let v: [Vector<N>; STAGES] = std::array::from_fn(|i| inputs(&v[i]));
    let h = Rounded::input(h);
    let coefficient = |value: DoubleDouble| h * Rounded::coefficient(value);
    let sum = |start: &Vector<N>, weights: &[DoubleDouble], of: &[Vector<N>; STAGES]| -> Vector<N> {
        combined(|a| weights.iter().zip(of).fold(start[a], |sum, (w, x)| sum + coefficient(*w) * x[a]))
    };
    let slopes: [Slopes<N>; STAGES] =
        std::array::from_fn(|i| system.slopes(&sum(&q0, &tableau.a[i], &v), &v[i]));
    let rates = slopes.map(|at| combined(|a| at.force[a] - at.drag[a]));
    let mut judged = Judged::NOTHING;
    let largest: [f64; N] =
        std::array::from_fn(|a| rates.iter().fold(p0[a].size(), |size, rate| size.max((h * rate[a]).size())));
    // A residual at a stage is p of a stage: its rounding is that of the largest.
    let mut floor = [0.0_f64; N];
    let momenta: [Vector<N>; STAGES] = std::array::from_fn(|i| sum(&p0, &tableau.a[i], &rates));
    for (at, p) in slopes.iter().zip(&momenta) {
        for a in 0..N {
            floor[a] = floor[a].max((at.momentum[a] - p[a]).error);
        }
    }
    for (at, p) in slopes.iter().zip(&momenta) {
        for a in 0..N {
            let residual = Rounded { error: floor[a], ..(at.momentum[a] - p[a]) };
            judged.hold(residual, at.momentum[a].size() + largest[a]);
        }
    }
    let (q1, p1) = (sum(&q0, &tableau.b, &v), sum(&p0, &tableau.b, &rates));
    for a in 0..N {
        let scale = v.iter().fold(q0[a].size(), |size, v| size.max((h * v[a]).size()));
        judged.hold(q1[a] - Rounded::input(end.q[a]), scale);
        let mut p1 = p1[a] - Rounded::input(end.p[a]);
        p1.error += floor[a];
        judged.hold(p1, largest[a]);
    }
    judged
}
