//! Random systems at random samples, good and poor: no checker says yes of a statement that does not hold,
//! and each says yes of one that does on good samples. Whether it holds is known in closed form.

use std::collections::BTreeMap;

use dalembert::derivative::PhaseMatrix;
use dalembert::nalgebra::{SMatrix, SVector};
use dalembert::rayleigh::ConformalStep;
use dalembert::rayleigh::modified::ModifiedLinearSystem;
use dalembert::samples;
use dalembert::step::DiscreteRayleigh;
use dalembert::{Discretise, Midpoint, State, Trapezoidal, rayleigh_system};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

const H: f64 = 0.2;

/// Terms of a system in one coordinate or two.
#[derive(Clone, Copy, Debug)]
struct Terms {
    m: [f64; 2],
    /// Of ½q₀², q₀q₁, ½q₁².
    k: [f64; 3],
    bend: f64,
    /// C = friction × M, and more of the second coordinate.
    friction: f64,
    uneven: f64,
    /// R ∝ v⁴, R ∝ q²v².
    cubic: f64,
    rough: f64,
    gyroscopic: f64,
    /// Growth with time of the springs, the friction, a push.
    stiffening: f64,
    drying: f64,
    push: f64,
}

struct Single(Terms);

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl Single {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        let x = q[0];
        0.5 * self.0.m[0] * v[0] * v[0]
            - 0.5 * self.0.k[0] * x * x
            - self.0.bend * (x * x * x * x + x * x * x)
    }
    fn rayleigh(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        let u = v[0] * v[0];
        0.5 * self.0.friction * self.0.m[0] * u + self.0.cubic * u * u + self.0.rough * q[0] * q[0] * u
    }
}

struct TimedSingle(Terms);

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl TimedSingle {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
        let x = q[0];
        0.5 * self.0.m[0] * v[0] * v[0]
            - 0.5 * self.0.k[0] * (1.0 + self.0.stiffening * t) * x * x
            - self.0.bend * (x * x * x * x + x * x * x)
            + self.0.push * t * x
    }
    fn rayleigh(&self, q: [f64; 1], v: [f64; 1], t: f64) -> f64 {
        let u = v[0] * v[0];
        (0.5 * self.0.friction * self.0.m[0] * u + self.0.cubic * u * u + self.0.rough * q[0] * q[0] * u)
            * (1.0 + self.0.drying * t)
    }
}

struct Pair(Terms);

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl Pair {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let (m, k, [x, y]) = (self.0.m, self.0.k, q);
        0.5 * (m[0] * v[0] * v[0] + m[1] * v[1] * v[1])
            - 0.5 * (k[0] * x * x + 2.0 * k[1] * x * y + k[2] * y * y)
            - self.0.bend * (x * x * x * x + x * x * x)
    }
    fn force(&self, _q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        [self.0.gyroscopic * v[1], -self.0.gyroscopic * v[0]]
    }
    fn rayleigh(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let (m, u, w) = (self.0.m, v[0] * v[0], v[1] * v[1]);
        0.5 * self.0.friction * (m[0] * u + m[1] * w)
            + 0.5 * self.0.uneven * w
            + self.0.cubic * u * u
            + self.0.rough * q[0] * q[0] * u
    }
}

struct TimedPair(Terms);

#[rayleigh_system(rule = [midpoint, trapezoidal])]
impl TimedPair {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2], t: f64) -> f64 {
        let (m, k, [x, y]) = (self.0.m, self.0.k, q);
        0.5 * (m[0] * v[0] * v[0] + m[1] * v[1] * v[1])
            - 0.5 * (k[0] * x * x + 2.0 * k[1] * x * y + k[2] * y * y) * (1.0 + self.0.stiffening * t)
            - self.0.bend * (x * x * x * x + x * x * x)
            + self.0.push * t * x
    }
    fn force(&self, _q: [f64; 2], v: [f64; 2]) -> [f64; 2] {
        [self.0.gyroscopic * v[1], -self.0.gyroscopic * v[0]]
    }
    fn rayleigh(&self, q: [f64; 2], v: [f64; 2], t: f64) -> f64 {
        let (m, u, w) = (self.0.m, v[0] * v[0], v[1] * v[1]);
        (0.5 * self.0.friction * (m[0] * u + m[1] * w)
            + 0.5 * self.0.uneven * w
            + self.0.cubic * u * u
            + self.0.rough * q[0] * q[0] * u)
            * (1.0 + self.0.drying * t)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Statement {
    Conformal,
    Proportional,
    Linear,
    RayleighStep,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Rule {
    Midpoint,
    Trapezoidal,
}

impl Terms {
    /// Terms of which each is there or not, by chance; friction mostly.
    fn draw(random: &mut StdRng, is_timed: bool) -> Self {
        let mut some = |share: f64| {
            let value = random.random_range(0.4..1.0);
            if random.random_bool(share) { value } else { 0.0 }
        };
        let timed = if is_timed { 0.4 } else { 0.0 };
        Self {
            m: [some(1.0), some(1.0)],
            k: [some(1.0), 0.3 * some(1.0), 1.0 + some(1.0)],
            bend: some(0.3),
            friction: some(0.8),
            uneven: some(0.3),
            cubic: some(0.2),
            rough: some(0.2),
            gyroscopic: some(0.2),
            stiffening: some(timed),
            drying: some(timed),
            push: some(timed),
        }
    }

    /// Whether the statement holds in `n` coordinates.
    ///
    /// - Linear: no term of another degree, and none that changes. Every rule of order 2 then has a modified
    ///   Rayleigh system.
    /// - Conformal, Proportional: D1D2R_d = κ D1D2L_d. By the trapezoidal rule D1D2L_d = −M/h, so that C is
    ///   to be 2aM for good. By the midpoint rule D1D2L_d = −M/h − hV″/4: in one coordinate V″ has to be
    ///   constant too, and in two never is a multiple of M here. Without friction κ = 0.
    /// - Rayleigh step: L and R have L_d and R_d. A gyroscopic force has none of these.
    fn holds(&self, statement: Statement, rule: Rule, n: usize) -> bool {
        let is_turned = n > 1 && self.gyroscopic != 0.0;
        let is_bent = self.bend != 0.0 || self.stiffening != 0.0;
        let is_plain = self.cubic == 0.0 && self.rough == 0.0;
        let is_uneven = n > 1 && self.uneven != 0.0;
        let has_friction = self.friction != 0.0 || is_uneven || !is_plain;
        let dries = self.drying != 0.0 && has_friction;
        !is_turned
            && match statement {
                Statement::RayleighStep => true,
                Statement::Linear => is_plain && !is_bent && !dries && self.push == 0.0,
                Statement::Conformal | Statement::Proportional => {
                    let is_even = is_plain && !is_uneven && !dries;
                    !has_friction || is_even && (rule == Rule::Trapezoidal || n == 1 && !is_bent)
                }
            }
    }
}

/// States, and whether they can tell.
fn samples<const N: usize>(random: &mut StdRng) -> Vec<(&'static str, bool, Vec<State<f64, N>>)> {
    let mut vector = |size: f64| SVector::<f64, N>::from_fn(|_, _| size * random.random_range(0.3..1.0));
    let mut state = |size: f64| State { q: vector(size), p: vector(-0.7 * size) };
    let (x, y, mut z) = (state(1.0), state(-0.8), state(0.6));
    z.q[0] = -z.q[0];
    let moved = |by: &State<f64, N>, share: f64| State { q: x.q + by.q * share, p: x.p + by.p * share };
    let rest = |state: State<f64, N>| State { p: SVector::zeros(), ..state };
    let zero = State { q: SVector::zeros(), p: SVector::zeros() };
    let small = |size: f64| State { q: y.q * size, p: y.p * size };
    let mut first_alone = x;
    first_alone.q[0] = y.q[0];
    vec![
        ("three", true, vec![x, y, z]),
        ("two", true, vec![z, x]),
        ("on a line", true, vec![x, moved(&y, 0.5), moved(&y, 1.0), moved(&y, -0.4)]),
        ("on an axis", true, vec![x, first_alone]),
        ("at rest", true, vec![rest(x), rest(y), rest(z)]),
        ("mirrored", true, vec![x, State { q: -x.q, p: -x.p }]),
        ("alone", N > 1, vec![x]),
        ("equal", false, vec![x; 3]),
        ("nearly equal", false, vec![x, moved(&y, 1e-12), moved(&z, 3e-13)]),
        ("at an equilibrium", false, vec![zero; 2]),
        ("nearly at one", false, vec![zero, small(1e-12), small(-3e-12)]),
        ("small", false, vec![small(1e-9), small(2e-9)]),
    ]
}

/// Answers of the checkers, and of what they say by the derivatives at the states alone, at one time.
struct Answers {
    with_the_rule: [(Statement, bool); 4],
    without: [(Statement, bool); 2],
}

fn ask<L, R, const N: usize>(system: &L, rule: R, states: &[State<f64, N>]) -> Answers
where
    L: DiscreteRayleigh<R, N, Scalar = f64>,
    R: Copy,
{
    let by = system.by(rule, H);
    let segments: Vec<_> =
        states.iter().map(|state| samples::Pair::new(state.q, state.q + state.p * H)).collect();
    let all: Vec<PhaseMatrix<f64, N>> =
        states.iter().map(|state| by.linearized_step(state).unwrap().1).collect();
    let is_one = all.iter().all(|a| {
        let apart = |x: &SMatrix<f64, N, N>, y: &SMatrix<f64, N, N>| (x - y).amax() < 1e-13;
        apart(&a.q_by_q, &all[0].q_by_q) && apart(&a.p_by_q, &all[0].p_by_q)
    });
    let modified = ModifiedLinearSystem::of(&all[0], H, None);
    Answers {
        with_the_rule: [
            (Statement::Conformal, by.conformal_step(states).is_ok_and(|found| found.is_conformal())),
            (Statement::Proportional, by.proportion(&segments).is_ok_and(|found| found.is_constant())),
            (Statement::Linear, by.modified_linear_system(states).is_ok_and(|found| found.is_rayleigh())),
            (Statement::RayleighStep, by.rayleigh_step(states).is_ok_and(|found| found.is_rayleigh())),
        ],
        without: [
            (Statement::Conformal, ConformalStep::of(&all, None).is_ok_and(|found| found.is_conformal())),
            (Statement::Linear, all.len() > 1 && is_one && modified.is_ok_and(|found| found.is_rayleigh())),
        ],
    }
}

/// Yes where the statement fails, and no yes where it holds and the samples can tell.
#[derive(Default)]
struct Wrong {
    asked: usize,
    true_yes: usize,
    false_yes: BTreeMap<String, usize>,
    false_no: BTreeMap<String, usize>,
}

impl Wrong {
    fn take(&mut self, name: &str, statement: Statement, (holds, is_good): (bool, bool), yes: bool) {
        self.asked += 1;
        self.true_yes += usize::from(yes && holds);
        let list = match (yes, holds) {
            (true, false) => &mut self.false_yes,
            (false, true) if is_good => &mut self.false_no,
            _ => return,
        };
        *list.entry(format!("{statement:?}, {name}")).or_default() += 1;
    }
}

#[test]
fn random_samples_get_no_false_answer() {
    let mut random = StdRng::seed_from_u64(31);
    let (mut wrong, mut without) = (Wrong::default(), Wrong::default());
    let mut look = |n: usize, terms: &Terms, rule: Rule, (name, is_good): (&str, bool), answers: Answers| {
        for (statement, yes) in answers.with_the_rule {
            // One state tells of linearity nothing, in any dimension, and segments at rest nothing of a
            // force.
            let is_poor = matches!(
                (statement, name),
                (Statement::Linear, "alone") | (Statement::Proportional, "at rest")
            );
            let is_good = is_good && !is_poor;
            wrong.take(name, statement, (terms.holds(statement, rule, n), is_good), yes);
        }
        for (statement, yes) in answers.without {
            without.take(name, statement, (terms.holds(statement, rule, n), is_good), yes);
        }
    };
    for case in 0..if cfg!(debug_assertions) { 6 } else { 400 } {
        let is_timed = case % 2 == 1;
        let terms = Terms::draw(&mut random, is_timed);
        for (name, is_good, states) in samples::<1>(&mut random) {
            let (midpoint, trapezoidal) = if is_timed {
                let (system, t) = (TimedSingle(terms), random.random_range(0.0..0.5));
                (ask(&system.at_time(t), Midpoint, &states), ask(&system.at_time(t), Trapezoidal, &states))
            } else {
                (ask(&Single(terms), Midpoint, &states), ask(&Single(terms), Trapezoidal, &states))
            };
            look(1, &terms, Rule::Midpoint, (name, is_good), midpoint);
            look(1, &terms, Rule::Trapezoidal, (name, is_good), trapezoidal);
        }
        for (name, is_good, states) in samples::<2>(&mut random) {
            let (midpoint, trapezoidal) = if is_timed {
                let (system, t) = (TimedPair(terms), random.random_range(0.0..0.5));
                (ask(&system.at_time(t), Midpoint, &states), ask(&system.at_time(t), Trapezoidal, &states))
            } else {
                (ask(&Pair(terms), Midpoint, &states), ask(&Pair(terms), Trapezoidal, &states))
            };
            look(2, &terms, Rule::Midpoint, (name, is_good), midpoint);
            look(2, &terms, Rule::Trapezoidal, (name, is_good), trapezoidal);
        }
    }
    let count = |list: &BTreeMap<String, usize>| list.values().sum::<usize>();
    println!(
        "{} answers, {} true yes, {} false yes, {} false no; without the rule {} answers, {} false yes",
        wrong.asked,
        wrong.true_yes,
        count(&wrong.false_yes),
        count(&wrong.false_no),
        without.asked,
        count(&without.false_yes),
    );
    let lists = (&wrong.false_yes, &wrong.false_no);
    assert!(wrong.false_yes.is_empty() && wrong.false_no.is_empty(), "false yes and no: {lists:#?}");
    // The control: the rule is what does it.
    assert!(
        wrong.true_yes > wrong.asked / 5 && count(&without.false_yes) > wrong.asked / 40,
        "{:?}",
        without.false_yes
    );
}
