//! Runs in lanes: every member's state is bit by bit that of its own run, whatever runs beside it, in
//! however many lanes, at once or in parts; and a member that fails has none.

use dalembert::nalgebra::{SMatrix, SVector, vector};
use dalembert::run::events::{Watch, Watched};
use dalembert::run::{LaneRuns, Run, ToldRun};
use dalembert::step::FlowInLanes;
use dalembert::{Composition, Discretise, Splitting, State, StepError, Trapezoidal, rayleigh_system};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// The ring potential of the examples.
#[derive(Clone, Debug)]
struct Ring {
    k: f64,
    height: f64,
}

#[rayleigh_system(rule = trapezoidal, lanes = explicit)]
impl Ring {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let s = q[0] * q[0] + q[1] * q[1];
        0.5 * (v[0] * v[0] + v[1] * v[1]) - self.height * s * (s - 1.0).powi(2)
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.k * (v[0] * v[0] + v[1] * v[1])
    }
}

/// No field at all.
#[derive(Clone, Debug)]
struct HenonHeiles;

#[rayleigh_system(rule = [midpoint, trapezoidal], lanes = explicit)]
impl HenonHeiles {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let potential = 0.5 * (q[0] * q[0] + q[1] * q[1]) + q[0] * q[0] * q[1] - q[1].powi(3) / 3.0;
        0.5 * (v[0] * v[0] + v[1] * v[1]) - potential
    }
}

/// Masses of their own, a tilted floor, friction that pushes at rest: nothing of the matrices is 1 or 0.
#[derive(Clone, Debug)]
struct Pendulums {
    m: [f64; 2],
    g: f64,
    spring: f64,
    /// Of ∂L/∂v at rest.
    drift: f64,
    /// Of ∂R/∂v at rest.
    thrust: f64,
    r: f64,
}

#[rayleigh_system(rule = trapezoidal, lanes = explicit)]
impl Pendulums {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let mut l = self.drift * v[0];
        for i in 0..2 {
            l += 0.5 * self.m[i] * v[i] * v[i] + self.m[i] * self.g * q[i].cos();
        }
        l - self.spring * (1.0 - (q[0] - q[1]).cos() * (0.1 * q[0].sin()).exp())
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.r * (v[0] * v[0] + 2.0 * v[1] * v[1]) + self.thrust * v[1]
    }
}

/// Six masses, each coupled to every other by inertia and friction.
#[derive(Clone, Debug)]
struct Coupled {
    mass: [[f64; 6]; 6],
    damping: [[f64; 6]; 6],
    spring: f64,
}

#[rayleigh_system(rule = trapezoidal, lanes = explicit)]
impl Coupled {
    fn lagrangian(&self, q: [f64; 6], v: [f64; 6]) -> f64 {
        let mut l = 0.0;
        for i in 0..6 {
            for j in 0..6 {
                l += 0.5 * self.mass[i][j] * v[i] * v[j];
            }
        }
        for i in 0..5 {
            let d = q[i + 1] - q[i];
            l -= self.spring * (0.5 * d * d + 0.25 * d.powi(4));
        }
        l - 0.5 * q[0] * q[0]
    }

    fn rayleigh(&self, v: [f64; 6]) -> f64 {
        let mut r = 0.0;
        for i in 0..6 {
            for j in 0..6 {
                r += 0.5 * self.damping[i][j] * v[i] * v[j];
            }
        }
        r
    }
}

/// A wall, a ramp, and fields that are no numbers.
#[derive(Clone, Debug)]
struct Branchy {
    floor: Floor,
    has_wall: bool,
    teeth: u32,
    wind: Option<f64>,
}

#[derive(Clone, Copy, Debug)]
enum Floor {
    Flat,
    Ramp(f64),
}

#[rayleigh_system(rule = trapezoidal, lanes = explicit)]
impl Branchy {
    const STIFFNESS: f64 = 3.0;

    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        let mut potential = match self.floor {
            Floor::Flat => 0.0,
            Floor::Ramp(slope) => slope * q[0],
        };
        if self.has_wall && q[0] > 1.0 {
            potential += Self::STIFFNESS * (q[0] - 1.0).powi(2);
        } else if q[0].abs() < 0.3 || q[0] < -1.5 {
            potential += 0.1 * (3.0 * q[0]).sin() - 0.7 * q[0].min(-1.6);
        }
        0.5 * v[0] * v[0] - potential - 0.2 * q[0].powi(4) + (f64::from(self.teeth) * q[0]).cos()
    }

    fn force(&self, q: [f64; 1], _v: [f64; 1]) -> [f64; 1] {
        [if q[0].is_sign_negative() { self.wind.unwrap_or(0.0) } else { -0.1 }]
    }
}

/// Every function, comparison and question that a body may hold.
#[derive(Clone, Debug)]
struct Everything {
    k: f64,
    is_on: bool,
}

#[rayleigh_system(rule = trapezoidal, lanes = explicit)]
impl Everything {
    const IS_MEANT: bool = true;

    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        let x = 0.3 * q[0].sin();
        let y = 1.5 + 0.5 * q[1].cos();
        let roots =
            y.sqrt() + y.cbrt() + y.recip() + y.powi(5) + y.powi(-3) + y.powf(self.k) + self.k.powf(x);
        let exponentials = x.exp() + x.exp2() + x.exp_m1() + y.ln() + y.log2() + y.log10() + x.ln_1p();
        let circular = x.tan() + x.asin() + x.acos() + x.atan() + x.atan2(y) + y.atan2(self.k);
        let hyperbolic = x.sinh() + x.cosh() + x.tanh() + x.asinh() + (1.5 + y).acosh() + x.atanh();
        let pieces = x.abs() + x.signum() * y + y.copysign(x) + x.min(0.1) + x.max(-0.1) + x.clamp(-0.2, 0.2);
        let pairs = x.hypot(self.k) + x.mul_add(y, self.k) + y.log(3.0) + 2.0_f64.powf(x) + 0.5_f64.hypot(y);
        let mut potential = 0.05 * (roots + exponentials + circular + hyperbolic + pieces + pairs);
        if (x.is_nan() || y.is_infinite()) && !self.is_on {
            potential += 1.0;
        }
        if x.is_finite() && (q[0].is_sign_positive() || q[1] != 0.5) && q[0] >= -2.0 {
            potential += 0.1 * x * x;
        }
        if self.k <= 1.0 || (self.is_on && q[1].is_sign_negative()) {
            potential -= 0.2 * y;
        }
        if Self::IS_MEANT && self.k == 1.0 {
            potential += x;
        }
        0.5 * (v[0] * v[0] + v[1] * v[1]) - potential - 0.5 * (q[0] * q[0] + q[1] * q[1])
    }
}

/// More coordinates than are unrolled, a band of three: at rest but for the first, floors rise as the others
/// begin to move.
#[derive(Clone, Debug)]
pub(crate) struct Chain {
    pub(crate) k: f64,
    pub(crate) r: f64,
}

#[rayleigh_system(rule = [midpoint, trapezoidal, gauss], lanes = [explicit, gauss, midpoint])]
impl Chain {
    fn lagrangian(&self, q: [f64; 18], v: [f64; 18]) -> f64 {
        let (mut l, mut before) = (0.0, 0.0);
        for i in 0..18 {
            let d = q[i] - before;
            l += 0.5 * v[i] * v[i] - self.k * (0.5 * d * d + 0.25 * d.powi(4));
            before = q[i];
        }
        l
    }

    fn rayleigh(&self, v: [f64; 18]) -> f64 {
        let mut r = 0.0;
        for v in v {
            r += 0.5 * self.r * v * v;
        }
        r
    }
}

/// Neighbours coupled by inertia: a matrix with a band of three.
#[derive(Clone, Debug)]
struct Band {
    coupling: f64,
    r: f64,
}

#[rayleigh_system(rule = trapezoidal, lanes = explicit)]
impl Band {
    fn lagrangian(&self, q: [f64; 5], v: [f64; 5]) -> f64 {
        let mut l = 0.0;
        for i in 0..5 {
            l += 0.5 * v[i] * v[i] + q[i].cos();
        }
        for i in 0..4 {
            l += self.coupling * v[i] * v[i + 1];
        }
        l
    }

    fn rayleigh(&self, v: [f64; 5]) -> f64 {
        0.5 * self.r * (v[0] * v[0] + (v[1] - v[2]) * (v[1] - v[2]))
    }
}

/// Pushed by an input, in a way of its own.
#[derive(Clone, Debug)]
struct Pushed {
    m: f64,
    r: f64,
    is_blunt: bool,
}

#[rayleigh_system(rule = [midpoint, trapezoidal], lanes = explicit)]
impl Pushed {
    const GAIN: f64 = 0.7;

    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * self.m * v[0] * v[0] + 0.5 * v[1] * v[1] + self.m * q[0].cos() - 0.5 * (q[0] - q[1]).powi(2)
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        0.5 * self.r * (v[0] * v[0] + v[1] * v[1])
    }

    fn force(&self, q: [f64; 2], _v: [f64; 2], u: [f64; 2]) -> [f64; 2] {
        let turned = if self.is_blunt { u[1].abs() } else { u[1] };
        [Self::GAIN * u[0] - self.m * u[1] * q[1], turned * q[0].sin()]
    }
}

/// In single precision.
#[rayleigh_system(rule = trapezoidal, lanes = explicit)]
fn single(q: [f32; 1], v: [f32; 1], m: f32, k: f32, r: f32) -> (f32, f32) {
    (0.5 * m * v[0] * v[0] - 0.5 * k * q[0] * q[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
}

/// The bits of a state: −0 is not 0.
pub fn bits<const N: usize>(state: &State<f64, N>) -> Vec<u64> {
    state.q.iter().chain(&state.p).map(|entry| entry.to_bits()).collect()
}

/// The state after so many steps, alone.
fn alone<L, M, const N: usize>(
    method: M,
    system: &L,
    start: State<f64, N>,
    h: f64,
    steps: u64,
) -> Result<State<f64, N>, StepError>
where
    L: FlowInLanes<M, N, Scalar = f64>,
{
    let mut run = system.by(method, h).run(start);
    for _ in 0..steps {
        if let Some(Err(error)) = run.next() {
            return Err(error);
        }
    }
    Ok(*run.state())
}

/// Runs on by so many steps: one copy of what is inlined wherever it is called, and long to compile.
#[inline(never)]
pub fn forward<L, M, const N: usize, const W: usize>(runs: &mut LaneRuns<'_, L, M, N, W>, steps: u64)
where
    L: FlowInLanes<M, N>,
{
    runs.advance(steps);
}

/// Steps of [`agree`] after the third.
const MORE: u64 = if cfg!(debug_assertions) { 6 } else { 18 };

/// Members in W lanes beside each alone, after 1, 3 and more steps; how many members had an end.
pub fn agree<L, M, const N: usize, const W: usize>(method: M, members: &[(L, State<f64, N>)], h: f64) -> usize
where
    L: FlowInLanes<M, N, Scalar = f64>,
    M: Copy,
{
    let mut ends = 0;
    for chunk in members.chunks(W) {
        // The last chunk is filled with its first member.
        let member = |lane: usize| chunk.get(lane).unwrap_or(&chunk[0]);
        let systems: [&L; W] = std::array::from_fn(|lane| &member(lane).0);
        let starts: [State<f64, N>; W] = std::array::from_fn(|lane| member(lane).1);
        let mut runs = LaneRuns::new(method, systems, &starts, h);
        let mut at_once = runs;
        forward(&mut at_once, 3 + MORE);
        let mut steps = 0;
        for more in [0, 1, 2, MORE] {
            forward(&mut runs, more);
            steps += more;
            for lane in 0..W {
                match (runs.state(lane), alone(method, systems[lane], starts[lane], h, steps)) {
                    (Some(in_lanes), Ok(alone)) => {
                        assert_eq!(bits(&in_lanes), bits(&alone), "lane {lane}, h = {h}");
                    }
                    // At its start no run has failed yet; it does in its first step.
                    (None, Ok(_)) => {
                        let next = alone(method, systems[lane], starts[lane], h, 1);
                        assert!(steps == 0 && next.is_err(), "lane {lane} has no state, its run has");
                    }
                    (None, Err(_)) => {}
                    (Some(_), Err(error)) => panic!("lane {lane} has a state; its run: {error}"),
                }
            }
        }
        for lane in 0..W {
            assert_eq!(runs.state(lane).map(|of| bits(&of)), at_once.state(lane).map(|of| bits(&of)));
            ends += usize::from(lane < chunk.len() && runs.state(lane).is_some());
        }
        assert_eq!(runs.state(W), None);
    }
    ends
}

/// In every number of lanes.
pub fn agree_in_all<L, M, const N: usize>(method: M, members: &[(L, State<f64, N>)], h: f64) -> usize
where
    L: FlowInLanes<M, N, Scalar = f64>,
    M: Copy,
{
    let ends = [
        agree::<L, M, N, 1>(method, members, h),
        agree::<L, M, N, 2>(method, members, h),
        agree::<L, M, N, 8>(method, members, h),
        agree::<L, M, N, 32>(method, members, h),
    ];
    assert_eq!(ends, [agree_in_two(method, members, h); 4]);
    ends[0]
}

/// In an odd number of lanes and in an even one: each is another copy of the step to compile.
pub fn agree_in_two<L, M, const N: usize>(method: M, members: &[(L, State<f64, N>)], h: f64) -> usize
where
    L: FlowInLanes<M, N, Scalar = f64>,
    M: Copy,
{
    let ends = [agree::<L, M, N, 3>(method, members, h), agree::<L, M, N, 16>(method, members, h)];
    assert_eq!(ends[0], ends[1]);
    ends[0]
}

pub fn start<const N: usize>(random: &mut StdRng) -> State<f64, N> {
    let mut entry = |_, _| random.random_range(-1.2..1.2);
    State { q: SVector::from_fn(&mut entry), p: SVector::from_fn(&mut entry) }
}

/// So many members, of fields and states at random.
pub fn members<L, const N: usize>(
    count: usize,
    seed: u64,
    system: impl Fn(&mut StdRng) -> L,
) -> Vec<(L, State<f64, N>)> {
    let mut random = StdRng::seed_from_u64(seed);
    (0..count).map(|_| (system(&mut random), start(&mut random))).collect()
}

/// 0 for a third of the members, −0 for some.
pub fn damping(random: &mut StdRng) -> f64 {
    match random.random_range(0..9) {
        0..2 => 0.0,
        2 => -0.0,
        _ => random.random_range(1e-3..0.8),
    }
}

#[test]
fn rings_are_bit_by_bit_their_own_runs() {
    let ring = |random: &mut StdRng| Ring { k: damping(random), height: random.random_range(0.5..2.0) };
    let mut all = members(37, 1, ring);
    // At rest on the axes, zeros of either sign.
    all[3].1 = State { q: vector![0.0, -0.0], p: vector![-0.0, 0.0] };
    all[4].1 = State { q: vector![-0.0, 1.0], p: vector![-0.0, -0.0] };
    assert_eq!(agree_in_all(Splitting::blanes_moan_6(), &all, 0.09), 37);
    assert_eq!(agree_in_two(Splitting::blanes_casas_escorihuela_8(), &all, 0.09), 37);
    assert_eq!(agree::<_, _, 2, 8>(Splitting::blanes_casas_escorihuela_8().compensated(), &all, 0.09), 37);
    assert_eq!(agree::<_, _, 2, 8>(Splitting::blanes_moan_6().compensated(), &all, 0.09), 37);
    assert_eq!(agree::<_, _, 2, 8>(Splitting::blanes_moan_4(), &all, 0.02), 37);
    assert_eq!(agree::<_, _, 2, 16>(Splitting::blanes_moan_4(), &all, -0.05), 37);
    // Undamped ones alone take a way of their own.
    let undamped: Vec<_> = all.into_iter().filter(|(ring, _)| ring.k == 0.0).collect();
    assert!(undamped.len() > 5);
    assert_eq!(agree::<_, _, 2, 4>(Splitting::blanes_moan_6(), &undamped, 0.1), undamped.len());
    assert_eq!(agree::<_, _, 2, 8>(Splitting::blanes_casas_escorihuela_8(), &undamped, 0.1), undamped.len());
    assert_eq!(agree::<_, _, 2, 8>(Splitting::blanes_moan_4().compensated(), &undamped, 0.1), undamped.len());
}

#[test]
fn members_without_fields_and_in_other_functions() {
    let mut all = members(19, 2, |_| HenonHeiles);
    // Half of them stay near the bottom; of the others some escape, and overflow.
    for (_, state) in &mut all[..10] {
        (state.q, state.p) = (state.q * 0.2, state.p * 0.2);
    }
    let ends = agree_in_two(Splitting::blanes_moan_6(), &all, 0.4);
    assert!((10..19).contains(&ends), "{ends}");
    let pendulums = |random: &mut StdRng| Pendulums {
        m: [random.random_range(0.5..2.0), random.random_range(0.5..2.0)],
        g: random.random_range(0.0..9.81),
        spring: random.random_range(0.0..3.0),
        drift: if random.random() { 0.0 } else { random.random_range(-1.0..1.0) },
        thrust: if random.random() { 0.0 } else { random.random_range(-0.1..0.1) },
        r: damping(random),
    };
    let all = members(35, 3, pendulums);
    assert_eq!(agree_in_two(Splitting::blanes_moan_6(), &all, 0.1), 35);
    assert_eq!(agree::<_, _, 2, 8>(Splitting::blanes_moan_4(), &all, 0.03), 35);
    assert_eq!(agree::<_, _, 2, 8>(Splitting::blanes_casas_escorihuela_8(), &all, 0.1), 35);
    assert_eq!(agree::<_, _, 2, 8>(Splitting::blanes_moan_6().compensated(), &all, 0.1), 35);
}

#[test]
fn every_function_is_that_of_numbers() {
    let of = |random: &mut StdRng| Everything {
        k: if random.random_range(0..5) == 0 { 1.0 } else { random.random_range(0.5..1.5) },
        is_on: random.random(),
    };
    let mut all = members(27, 14, of);
    all[0].1.q = vector![0.0, -0.0];
    assert_eq!(agree::<_, _, 2, 8>(Splitting::blanes_moan_6(), &all, 0.3), 27);
    assert_eq!(agree::<_, _, 2, 3>(Trapezoidal, &all, 0.05), 27);
}

#[test]
fn chains_longer_than_what_is_unrolled() {
    let chain = |random: &mut StdRng| Chain { k: random.random_range(0.5..2.0), r: damping(random) };
    let all = members(11, 8, chain);
    assert_eq!(agree::<_, _, 18, 8>(Splitting::blanes_moan_6(), &all, 0.2), 11);
    assert_eq!(agree::<_, _, 18, 3>(Splitting::blanes_moan_4(), &all, 0.1), 11);
}

#[test]
fn full_matrices_beside_diagonal_ones() {
    let coupled = |random: &mut StdRng| {
        let (is_diagonal, r) = (random.random_range(0..4) == 0, damping(random));
        let mut symmetric = |scale: f64| {
            let w = SMatrix::<f64, 6, 6>::from_fn(|_, _| random.random_range(-1.0..1.0));
            let full = (w * w.transpose() + SMatrix::identity()) * scale;
            let full = (full + full.transpose()) * 0.5;
            let kept = if is_diagonal { SMatrix::from_diagonal(&full.diagonal()) } else { full };
            std::array::from_fn(|i| std::array::from_fn(|j| kept[(i, j)]))
        };
        let (mass, damping) = (symmetric(1.0), symmetric(r));
        Coupled { mass, damping, spring: random.random_range(0.5..2.0) }
    };
    let mut all = members(11, 4, coupled);
    all[2].1 = State { q: SVector::zeros(), p: -SVector::<f64, 6>::zeros() };
    let is_diagonal = |of: &Coupled| of.mass[0][1] == 0.0;
    let diagonal = all.iter().filter(|(of, _)| is_diagonal(of)).count();
    assert!((2..9).contains(&diagonal), "{diagonal} of 11 are diagonal");
    assert_eq!(agree::<_, _, 6, 1>(Splitting::blanes_moan_6(), &all, 0.1), 11);
    assert_eq!(agree::<_, _, 6, 3>(Splitting::blanes_moan_4(), &all, 0.1), 11);
    assert_eq!(agree::<_, _, 6, 4>(Splitting::blanes_moan_6(), &all, 0.2), 11);
    assert_eq!(agree::<_, _, 6, 3>(Splitting::blanes_casas_escorihuela_8(), &all, 0.2), 11);
    assert_eq!(agree::<_, _, 6, 4>(Splitting::blanes_moan_6().compensated(), &all, 0.2), 11);
    assert_eq!(agree::<_, _, 6, 3>(Splitting::blanes_casas_escorihuela_8().compensated(), &all, 0.2), 11);
}

#[test]
fn every_member_takes_its_own_branches() {
    let branchy = |random: &mut StdRng| Branchy {
        floor: if random.random() { Floor::Flat } else { Floor::Ramp(random.random_range(-1.0..1.0)) },
        has_wall: random.random(),
        teeth: random.random_range(0..4),
        wind: random.random::<bool>().then(|| random.random_range(-0.3..0.3)),
    };
    let mut all = members(41, 5, branchy);
    for (of, (_, state)) in all.iter_mut().enumerate() {
        state.q *= 2.0;
        if of % 7 == 0 {
            state.q[0] = -0.0;
        }
    }
    assert_eq!(agree_in_two(Splitting::blanes_moan_6(), &all, 0.15), 41);
    assert_eq!(agree::<_, _, 1, 8>(Splitting::blanes_moan_4(), &all, 0.05), 41);
}

#[test]
fn members_are_driven_each_by_its_own_input() {
    let pushed = |random: &mut StdRng| Pushed {
        m: random.random_range(0.5..2.0),
        r: damping(random),
        is_blunt: random.random(),
    };
    let systems = members(41, 24, pushed);
    let mut random = StdRng::seed_from_u64(25);
    let mut input = || std::array::from_fn::<f64, 2, _>(|_| random.random_range(-1.0..1.0));
    let mut driven: Vec<_> = systems.iter().map(|(system, start)| (system.driven(input()), *start)).collect();
    // An input that is no number is that member's fault alone.
    driven[7].0 = systems[7].0.driven([f64::NAN, 0.0]);
    assert_eq!(agree_in_two(Splitting::blanes_moan_6(), &driven, 0.2), 40);
    assert_eq!(agree_in_two(Trapezoidal, &driven, 0.05), 40);
    assert_eq!(agree::<_, _, 2, 8>(Splitting::blanes_casas_escorihuela_8(), &driven, 0.2), 40);
    assert_eq!(agree::<_, _, 2, 8>(Composition::kahan_li_6(Trapezoidal), &driven, 0.1), 40);
    assert_eq!(refilled::<_, _, 2, 8>(Trapezoidal, &driven, 0.05, 10), 40);
    assert_eq!(refilled::<_, _, 2, 4>(Splitting::blanes_moan_4(), &driven, 0.05, 11), 40);
    // The input is seen.
    let still = alone(Trapezoidal, &systems[0].0.driven([0.0, 0.0]), driven[0].1, 0.05, 20).unwrap();
    let moved = alone(Trapezoidal, &driven[0].0, driven[0].1, 0.05, 20).unwrap();
    assert!((still.q - moved.q).amax() > 1e-3);
}

#[test]
fn single_precision_agrees_too() {
    let mut random = StdRng::seed_from_u64(6);
    let systems: [Single; 8] = std::array::from_fn(|_| Single {
        m: random.random_range(0.5..2.0),
        k: random.random_range(0.0..2.0),
        r: damping(&mut random) as f32,
    });
    let starts: [State<f32, 1>; 8] = std::array::from_fn(|_| State {
        q: vector![random.random_range(-2.0..2.0)],
        p: vector![random.random_range(-2.0..2.0)],
    });
    let mut runs = LaneRuns::new(Splitting::blanes_moan_4(), systems.each_ref(), &starts, 0.1);
    forward(&mut runs, 50);
    for lane in 0..8 {
        let alone = systems[lane].by(Splitting::blanes_moan_4(), 0.1).run(starts[lane]).nth(49);
        let (alone, in_lanes) = (alone.unwrap().unwrap().state, runs.state(lane).unwrap());
        assert_eq!(
            (alone.q[0].to_bits(), alone.p[0].to_bits()),
            (in_lanes.q[0].to_bits(), in_lanes.p[0].to_bits())
        );
    }
}

#[test]
fn members_that_fail_leave_the_others_as_they_are() {
    let good = State { q: vector![0.1, 1.1], p: vector![0.5, 0.0] };
    let ring = |k| Ring { k, height: 1.0 };
    let far = State { q: vector![1e80, 0.0], ..good };
    let none = State { q: vector![f64::NAN, 0.0], ..good };
    let endless = State { p: vector![0.0, f64::INFINITY], ..good };
    let late = State { p: vector![4e3, 0.0], ..good };
    // Damping that overflows over a drift backwards, and none at all.
    let all = [
        (ring(0.1), good),
        (ring(0.1), none),
        (ring(0.0), far),
        (ring(f64::NAN), good),
        (ring(0.0), good),
        (ring(1e9), good),
        (ring(0.2), endless),
        (ring(0.2), good),
        (ring(0.0), late),
    ];
    assert_eq!(agree_in_all(Splitting::blanes_moan_6(), &all, 0.09), 3);
    let systems: [&Ring; 9] = std::array::from_fn(|lane| &all[lane].0);
    let starts = std::array::from_fn(|lane| all[lane].1);
    let mut runs = LaneRuns::new(Splitting::blanes_moan_6(), systems, &starts, 0.09);
    forward(&mut runs, 10);
    let has_state: [bool; 9] = std::array::from_fn(|lane| runs.state(lane).is_some());
    assert_eq!(has_state, [true, false, false, false, true, false, false, true, false]);
    // No step at all, by a step size that is none.
    for h in [0.0, f64::NAN, f64::INFINITY] {
        let runs = LaneRuns::new(Splitting::blanes_moan_6(), systems, &starts, h);
        assert!((0..9).all(|lane| runs.state(lane).is_none()), "h = {h}");
    }
}

#[test]
fn masses_that_are_none_have_no_state() {
    let mut all = members(6, 7, |random| Pendulums {
        m: [1.0, random.random_range(0.5..2.0)],
        g: 9.81,
        spring: 1.0,
        drift: 0.0,
        thrust: 0.0,
        r: 0.1,
    });
    all[1].0.m[1] = -1.0;
    all[4].0.m[0] = 0.0;
    assert_eq!(agree_in_two(Splitting::blanes_moan_6(), &all, 0.05), 4);
}

/// Störmer–Verlet and its compositions, by every form of the matrix.
#[test]
fn explicit_steps_are_bit_by_bit_their_own_runs() {
    let ring = |random: &mut StdRng| Ring { k: damping(random), height: random.random_range(0.5..2.0) };
    let mut all = members(13, 9, ring);
    all[3].1 = State { q: vector![0.0, -0.0], p: vector![-0.0, 0.0] };
    assert_eq!(agree_in_all(Trapezoidal, &all, 0.03), 13);
    assert_eq!(agree::<_, _, 2, 8>(Composition::kahan_li_8(Trapezoidal), &all, 0.1), 13);
    let pendulums = |random: &mut StdRng| Pendulums {
        m: [random.random_range(0.5..2.0), random.random_range(0.5..2.0)],
        g: random.random_range(0.0..9.81),
        spring: random.random_range(0.0..3.0),
        drift: random.random_range(-1.0..1.0),
        thrust: random.random_range(-0.1..0.1),
        r: damping(random),
    };
    let all = members(13, 10, pendulums);
    assert_eq!(agree::<_, _, 2, 3>(Trapezoidal, &all, 0.02), 13);
    assert_eq!(agree::<_, _, 2, 8>(Composition::kahan_li_6(Trapezoidal), &all, 0.05), 13);
    let coupled = |random: &mut StdRng| {
        let r = damping(random);
        let mut symmetric = |scale: f64| {
            let w = SMatrix::<f64, 6, 6>::from_fn(|_, _| random.random_range(-1.0..1.0));
            let full = (w * w.transpose() + SMatrix::identity()) * scale;
            std::array::from_fn(|i| std::array::from_fn(|j| 0.5 * (full[(i, j)] + full[(j, i)])))
        };
        let (mass, damping) = (symmetric(1.0), symmetric(r));
        Coupled { mass, damping, spring: random.random_range(0.5..2.0) }
    };
    let all = members(9, 11, coupled);
    assert_eq!(agree::<_, _, 6, 4>(Trapezoidal, &all, 0.05), 9);
    let chain = |random: &mut StdRng| Chain { k: random.random_range(0.5..2.0), r: damping(random) };
    let all = members(9, 12, chain);
    assert_eq!(agree::<_, _, 18, 4>(Trapezoidal, &all, 0.05), 9);
    let band = |random: &mut StdRng| Band { coupling: random.random_range(-0.4..0.4), r: damping(random) };
    let all = members(9, 13, band);
    assert_eq!(agree::<_, _, 5, 8>(Trapezoidal, &all, 0.05), 9);
    assert_eq!(agree::<_, _, 5, 2>(Composition::kahan_li_6(Trapezoidal), &all, 0.1), 9);
}

#[test]
fn explicit_members_that_fail_leave_the_others_as_they_are() {
    let good = State { q: vector![0.1, 1.1], p: vector![0.5, 0.0] };
    let ring = |k| Ring { k, height: 1.0 };
    let all = [
        (ring(0.1), good),
        (ring(0.1), State { q: vector![f64::NAN, 0.0], ..good }),
        (ring(0.0), State { q: vector![1e80, 0.0], ..good }),
        (ring(f64::NAN), good),
        (ring(0.0), State { p: vector![4e3, 0.0], ..good }),
        // The matrix 1/h + k/2 has no inverse.
        (ring(-2.0 / 0.0625), good),
        (ring(0.2), good),
    ];
    assert_eq!(agree_in_all(Trapezoidal, &all, 0.0625), 2);
    assert_eq!(agree::<_, _, 2, 8>(Composition::kahan_li_6(Trapezoidal), &all[..5], 0.0625), 1);
}

/// Members put into lanes at random moments, each until a step of its own; how many had an end.
pub fn refilled<L, M, const N: usize, const W: usize>(
    method: M,
    members: &[(L, State<f64, N>)],
    h: f64,
    seed: u64,
) -> usize
where
    L: FlowInLanes<M, N, Scalar = f64>,
    M: Copy,
{
    let mut random = StdRng::seed_from_u64(seed);
    let mut waiting = members.iter().skip(W);
    let mut lanes: [_; W] = std::array::from_fn(|lane| (&members[lane], 0, random.random_range(0..12)));
    let (systems, starts) = (lanes.map(|(member, ..)| &member.0), lanes.map(|(member, ..)| member.1));
    let mut runs = LaneRuns::new(method, systems, &starts, h);
    let (mut ends, mut seen) = (0, 0);
    while seen < members.len() {
        let (mut arriving, mut from) = ([None; W], starts);
        for (lane, (of, steps, end)) in lanes.iter_mut().enumerate() {
            if steps < end {
                continue;
            }
            let (system, start) = *of;
            match alone(method, system, *start, h, *steps) {
                Ok(alone) if runs.state(lane).is_some() => {
                    assert_eq!(
                        runs.state(lane).map(|of| bits(&of)),
                        Some(bits(&alone)),
                        "lane {lane}, {steps}"
                    );
                    ends += 1;
                }
                // At its start no run has failed yet.
                Ok(_) => assert!(*steps == 0 && alone(method, system, *start, h, 1).is_err(), "lane {lane}"),
                Err(error) => assert_eq!(runs.state(lane), None, "lane {lane}: {error}"),
            }
            seen += 1;
            // A lane without another member runs on.
            (*steps, *end) = (0, u64::MAX);
            if let Some(next) = waiting.next() {
                (*of, *end) = (next, random.random_range(0..12));
                (arriving[lane], from[lane]) = (Some(&next.0), next.1);
            }
        }
        runs.refill(arriving, &from);
        let part =
            random.random_range(1..4).min(lanes.iter().map(|(_, steps, end)| end - steps).min().unwrap());
        forward(&mut runs, part);
        lanes.iter_mut().for_each(|(_, steps, _)| *steps += part);
    }
    ends
}

#[test]
fn members_in_lanes_that_others_have_left_are_their_own_runs() {
    // Damped and undamped members, and some that fail: at their start, in their first step and later.
    let ring = |random: &mut StdRng| Ring { k: damping(random), height: random.random_range(0.5..2.0) };
    let mut all = members(150, 21, ring);
    for (of, (ring, state)) in all.iter_mut().enumerate() {
        match of % 17 {
            3 => state.q[0] = f64::NAN,
            5 => *state = State { q: vector![0.0, -0.0], p: vector![-0.0, 0.0] },
            8 => ring.k = f64::NAN,
            11 => state.q[0] = 1e80,
            13 => state.p[0] = 4e3,
            _ => {}
        }
    }
    let ends = [
        refilled::<_, _, 2, 1>(Splitting::blanes_moan_6(), &all, 0.09, 1),
        refilled::<_, _, 2, 8>(Splitting::blanes_moan_6(), &all, 0.09, 2),
        refilled::<_, _, 2, 32>(Splitting::blanes_moan_4(), &all, 0.03, 3),
        refilled::<_, _, 2, 8>(Splitting::blanes_casas_escorihuela_8(), &all, 0.09, 4),
        refilled::<_, _, 2, 8>(Splitting::blanes_casas_escorihuela_8().compensated(), &all, 0.09, 5),
        refilled::<_, _, 2, 8>(Trapezoidal, &all, 0.03, 5),
        refilled::<_, _, 2, 3>(Composition::kahan_li_6(Trapezoidal), &all, 0.06, 6),
    ];
    assert!(ends.iter().all(|ends| (110..150).contains(ends)), "{ends:?}");

    // The drifts take a wider form on the way: without damping, diagonal, full.
    let mut random = StdRng::seed_from_u64(22);
    let mut all = members(40, 23, |_| Coupled { mass: [[0.0; 6]; 6], damping: [[0.0; 6]; 6], spring: 1.0 });
    for (of, (coupled, _)) in all.iter_mut().enumerate() {
        for i in 0..6 {
            coupled.mass[i][i] = random.random_range(1.0..2.0);
            coupled.damping[i][i] = if of < 12 || of % 3 == 0 { 0.0 } else { random.random_range(0.0..0.5) };
        }
        if of > 24 && of % 2 == 0 {
            (coupled.mass[0][3], coupled.mass[3][0]) = (0.2, 0.2);
        }
    }
    all[9].1 = State { q: SVector::zeros(), p: -SVector::<f64, 6>::zeros() };
    assert_eq!(refilled::<_, _, 6, 4>(Splitting::blanes_moan_6(), &all, 0.1, 7), 40);
    assert_eq!(refilled::<_, _, 6, 3>(Splitting::blanes_casas_escorihuela_8(), &all, 0.1, 8), 40);
    assert_eq!(refilled::<_, _, 6, 4>(Trapezoidal, &all, 0.05, 9), 40);
}

/// The control: another order of the same operations, or another sine, is seen by the bits.
#[test]
fn bits_see_another_rounding() {
    let ring = Ring { k: 0.1, height: 1.3 };
    let start = State { q: vector![0.1, 1.1], p: vector![0.5, 0.0] };
    let mut runs = LaneRuns::new(Splitting::blanes_moan_6(), [&ring; 2], &[start; 2], 0.09);
    forward(&mut runs, 21);
    let other = Ring { height: f64::from_bits(1.3_f64.to_bits() + 1), ..ring.clone() };
    let other = alone(Splitting::blanes_moan_6(), &other, start, 0.09, 21).unwrap();
    assert_ne!(bits(&runs.state(0).unwrap()), bits(&other));
    assert!((runs.state(0).unwrap().q - other.q).amax() < 1e-12);
}

/// A run that is told the states of a lane has the events of its own run, and ends where that does.
#[test]
fn a_run_that_is_told_its_states_is_watched_as_its_own() {
    let (ring, method, h) = (Ring { k: 0.01, height: 1.0 }, Splitting::blanes_moan_6(), 0.2);
    let start = State { q: vector![0.3, 1.0], p: vector![0.5, -0.1] };
    let radius = |q: &SVector<f64, 2>| q.norm() - 1.0;
    for end in [57.0, 57.31] {
        let mut own = ring.by(method, h).run(start);
        let mut watch = own.watch(|at| [radius(&at.q)]).until(end);
        let mut expected = Vec::new();
        while let Some(item) = watch.advance() {
            let time = watch.run().time();
            expected.push(match item.unwrap() {
                Watched::Event(event) => (event.time, event.state, true),
                Watched::Step(step) => (time, step.state, false),
            });
        }
        let mut lanes = LaneRuns::new(method, [&ring; 2], &[start; 2], h);
        let mut told = ToldRun::new(method, &ring, start, h);
        let mut watch = Watch::new(&mut told, |at| [radius(&at.q)]).until(end);
        let mut found = Vec::new();
        'run: loop {
            lanes.advance(1);
            watch.run().tell(lanes.state(1).unwrap());
            loop {
                let item = watch.advance();
                let time = watch.run().time();
                match item {
                    Some(Ok(Watched::Event(event))) => found.push((event.time, event.state, true)),
                    Some(Ok(Watched::Step(step))) => {
                        found.push((time, step.state, false));
                        if time == end {
                            break 'run;
                        }
                        break;
                    }
                    Some(Err(error)) => panic!("{error}"),
                    None => break 'run,
                }
            }
        }
        assert!(expected.iter().filter(|item| item.2).count() > 3, "{expected:?}");
        assert_eq!(expected.len(), found.len(), "{:?} {:?}", expected.last(), found.last());
        for (found, expected) in found.iter().zip(&expected) {
            let off = (found.0 - expected.0).abs().max((found.1.q - expected.1.q).amax());
            assert!(found.2 == expected.2 && off < 1e-13, "{found:?} {expected:?}");
        }
        assert_eq!(found.last().unwrap().0, end);
        // The control: a lane of another ring has other events.
        let mut lanes = LaneRuns::new(method, [&Ring { k: 0.01, height: 1.5 }; 2], &[start; 2], h);
        lanes.advance(1);
        assert!((lanes.state(1).unwrap().q - found[0].1.q).amax() > 1e-4);
    }
}
