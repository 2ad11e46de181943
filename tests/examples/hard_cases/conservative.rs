//! Cases without friction: what must stay, stays.

use std::f64::consts::TAU;

use anyhow::Result;
use dalembert::system::ForcedLagrangian;
use dalembert::{
    Composition, Discrete, Discretise, Gauss, Midpoint, Splitting, State, StepError, Trapezoidal,
};
use dalembert_examples::baseline::{self, Method};
use dalembert_examples::picture::{Curve, Dash, Mark, Panel, colour, linear, logarithmic};
use dalembert_tests::hard::{
    Arm, Effort, FERMI, Fermi, HenonHeiles, Kepler, MathewsLakshmanan, Progress, SpringPendulum,
    TwoPendulums, UniformField, drive, drive_composed,
};

use crate::page::Case;

/// Kahan and Li's composition of the midpoint rule.
pub const ORDER_6: Composition<Midpoint, 9> = Composition::kahan_li_6(Midpoint);

/// The splitting that explicit systems have as well.
pub const SPLITTING_6: Splitting<11> = Splitting::blanes_moan_6();

/// What is looked at on the way.
type Look<'a, const N: usize> = &'a mut dyn FnMut(Progress<N>);

/// The run of `steps` steps by each method, with what `measure` made of its states: the largest value.
fn by_each<S, const N: usize>(
    system: &S,
    h: f64,
    start: State<f64, N>,
    steps: u64,
    measure: impl Fn(&Progress<N>) -> f64,
) -> [(&'static str, f64, Effort); 4]
where
    S: Discrete<Midpoint, N, Scalar = f64> + Discrete<Trapezoidal, N> + ForcedLagrangian<N, Scalar = f64>,
{
    let watched = |run: &dyn Fn(Look<'_, N>) -> Effort| {
        let mut largest = 0.0_f64;
        let effort = run(&mut |at| largest = largest.max(measure(&at)));
        (largest, effort)
    };
    let count = [steps, 1];
    [
        ("midpoint", watched(&|look| drive(system, Midpoint, h, start, count, look))),
        ("trapezoidal", watched(&|look| drive(system, Trapezoidal, h, start, count, look))),
        ("Gauss, 3 stages", watched(&|look| drive(system, Gauss::<3>, h, start, count, look))),
        (
            "composition, order 6",
            watched(&|look| drive_composed(system.by(ORDER_6, h).run(start), steps, look)),
        ),
    ]
    .map(|(name, (largest, effort))| (name, largest, effort))
}

/// The end of a run, in words.
pub fn outcome(effort: &Effort) -> String {
    match effort.stopped {
        None => "–".to_owned(),
        Some(error) => {
            let name = match error {
                StepError::NonFinite { .. } => "NonFinite",
                StepError::Overflow { .. } => "Overflow",
                StepError::NoDerivative { .. } => "NoDerivative",
                StepError::NoRealSolution { .. } => "NoRealSolution",
                StepError::SingularNewtonMatrix { .. } => "SingularNewtonMatrix",
                StepError::LostPrecision { .. } => "LostPrecision",
                StepError::NotConverged { .. } => "NotConverged",
                _ => "StepError",
            };
            format!("`{name}` after {} steps", effort.steps)
        }
    }
}

/// Energy and angular momentum on orbits that almost collide.
pub fn kepler() -> Result<Case> {
    let free = Kepler { k: 0.0 };
    fn row<R: Copy>(name: &str, rule: R, e: f64, steps: u64, rows: &mut Vec<Vec<String>>)
    where
        Kepler: Discrete<R, 2, Scalar = f64>,
    {
        let start = Kepler::aphelion(e);
        let j = Kepler::angular_momentum(&start);
        let (mut energy, mut momentum) = (0.0_f64, 0.0_f64);
        let effort = drive(&Kepler { k: 0.0 }, rule, TAU / steps as f64, start, [10 * steps, 1], |at| {
            energy = energy.max((Kepler::energy_of(&at.state) + 0.5).abs());
            momentum = momentum.max((Kepler::angular_momentum(&at.state) / j - 1.0).abs());
        });
        rows.push(vec![
            format!("{e}"),
            format!("{steps}"),
            name.to_owned(),
            format!("{energy:.1e}"),
            format!("{momentum:.1e}"),
            outcome(&effort),
        ]);
    }
    let mut rows = Vec::new();
    for e in [0.9, 0.99, 0.999] {
        for steps in [1_000, 10_000, 100_000, 1_000_000] {
            row("midpoint", Midpoint, e, steps, &mut rows);
            row("trapezoidal", Trapezoidal, e, steps, &mut rows);
            row("Gauss, 3 stages", Gauss::<3>, e, steps, &mut rows);
        }
    }
    let (h, orbits) = (TAU / 10_000.0, 10);
    let start = Kepler::aphelion(0.9);
    let mut panels = Vec::new();
    let own = |energy: bool| {
        let mut points = Vec::new();
        drive(&free, Midpoint, h, start, [orbits * 10_000, 50], |at| {
            let error = if energy {
                Kepler::energy_of(&at.state) + 0.5
            } else {
                Kepler::angular_momentum(&at.state) / Kepler::angular_momentum(&start) - 1.0
            };
            points.push((at.time / TAU, error.abs()));
        });
        points
    };
    let other = |energy: bool, method| -> Result<Vec<(f64, f64)>> {
        let states = baseline::states(&free, method, h, start)?.take(orbits as usize * 10_000);
        let mut points = Vec::new();
        for (k, state) in states.enumerate() {
            let state = state?;
            if (k + 1) % 50 == 0 {
                let error = if energy {
                    Kepler::energy_of(&state) + 0.5
                } else {
                    Kepler::angular_momentum(&state) / Kepler::angular_momentum(&start) - 1.0
                };
                points.push(((k + 1) as f64 / 10_000.0, error.abs()));
            }
        }
        Ok(points)
    };
    for (energy, title, y) in [
        (
            true,
            "Energy, e = 0.9: midpoint's error comes back",
            logarithmic("|E − E₀| (dimensionless)").with_floor(1e-12).from_to(1e-12, 10.0),
        ),
        (
            false,
            "Angular momentum: midpoint's error is rounding",
            logarithmic("|J/J₀ − 1| (dimensionless)").with_floor(1e-18).from_to(1e-18, 10.0),
        ),
    ] {
        let curves = vec![
            Curve::line("explicit Euler", colour::EULER, 2, other(energy, Method::Euler)?)
                .dashed(Dash::DashDotted),
            Curve::line("Runge–Kutta 4", colour::RUNGE_KUTTA, 2, other(energy, Method::RungeKutta4)?)
                .dashed(Dash::Dashed),
            Curve::line("variational midpoint", colour::VARIATIONAL, 2, own(energy)),
        ];
        panels.push(Panel::new(title, linear("time (orbits)"), y, curves));
    }
    Ok(Case {
        title: "Kepler orbits that almost collide",
        breaks: "At e = 0.999 the force grows by (1 + e)²/(1 − e)² = 4e6 within a thousandth of the period. A fixed step jumps over the \
                 near side; energy and angular momentum are lost there once and for good.",
        ours: "Angular momentum is kept to rounding at every step size, by every rule, also where the orbit is nonsense (where a \
               step of the trapezoidal rule throws the body far out, that rounding is that of a large q × p). The energy error \
               is of the rule's order once the near side is resolved (some 1/(1 − e)^{3/2} steps an orbit, times 100). An implicit step over the \
               collision has no real solution and says so; the trapezoidal rule, which is explicit here, takes it and shows it in E alone.",
        head: &["e", "steps an orbit", "rule", "largest \\|E − E₀\\|", "largest \\|J/J₀ − 1\\|", "stopped"],
        rows,
        panels,
        test: "kepler.rs",
    })
}

/// A million steps of a chaotic double pendulum.
pub fn double_pendulum() -> Result<Case> {
    let system = TwoPendulums { r: 0.0 };
    let start = system.high_energy();
    let energy = start.energy(&system)?;
    let mut rows = Vec::new();
    /// The largest error within each 10 000 steps, against millions of steps.
    fn largest(errors: impl Iterator<Item = f64>) -> Vec<(f64, f64)> {
        let errors: Vec<f64> = errors.collect();
        let largest = errors.chunks(WINDOW).map(|chunk| chunk.iter().fold(0.0, |a: f64, b| a.max(b.abs())));
        largest.enumerate().map(|(k, error)| ((k as f64 + 0.5) * WINDOW as f64 / 1e6, error)).collect()
    }
    const WINDOW: usize = 10_000;
    fn run<R: Copy>(rule: R, h: f64) -> Vec<(f64, f64)>
    where
        TwoPendulums: Discrete<R, 2, Scalar = f64>,
    {
        let system = TwoPendulums { r: 0.0 };
        let mut errors = Vec::new();
        drive(&system, rule, h, system.high_energy(), [1_000_000, 1], |at| {
            errors.push(at.state.energy(&system).map_or(f64::NAN, |energy| energy - 7.0));
        });
        largest(errors.into_iter())
    }
    for h in [0.05, 0.02, 0.01] {
        let error = |at: &Progress<2>| at.state.energy(&system).map_or(f64::NAN, |now| (now - energy).abs());
        for (name, largest, effort) in by_each(&system, h, start, 1_000_000, error) {
            let iterations = effort.iterations as f64 / effort.steps.max(1) as f64;
            let solver = effort.iterations > 0;
            rows.push(vec![
                format!("{h}"),
                name.to_owned(),
                format!("{largest:.1e}"),
                if solver { format!("{iterations:.2}") } else { "–".to_owned() },
                if solver { format!("{:.1}", effort.worst_residual) } else { "–".to_owned() },
                outcome(&effort),
            ]);
        }
    }
    let h = 0.02;
    let runge_kutta = baseline::states(&system, Method::RungeKutta4, h, start)?
        .take(1_000_000)
        .map(|state| Ok(state?.energy(&system)? - energy))
        .collect::<Result<Vec<f64>>>()?;
    let panels = vec![Panel::new(
        "Energy error at equal h: only Runge–Kutta 4 drifts",
        linear("steps of h = 0.02 (millions)"),
        logarithmic("|E − 7|, largest of 10 000 steps (dimensionless)").from_to(1e-9, 10.0),
        vec![
            Curve::line("Runge–Kutta 4", colour::RUNGE_KUTTA, 3, largest(runge_kutta.into_iter()))
                .dashed(Dash::Dashed),
            Curve::line("trapezoidal", colour::FOURTH, 3, run(Trapezoidal, h)).dashed(Dash::DashDotted),
            Curve::line("variational midpoint", colour::VARIATIONAL, 3, run(Midpoint, h)),
            Curve::line("Gauss, 3 stages", colour::EULER, 3, run(Gauss::<3>, h)).dashed(Dash::Dotted),
        ],
    )];
    Ok(Case {
        title: "Chaotic double pendulum at high energy, a million steps",
        breaks: "Neighbouring motions part by a factor of ten in four units of time; only the energy can be asked for. Methods that do not \
                 come from a Lagrangian lose or gain it steadily. Both arms turn over thousands of times, so that digits of the angles go.",
        ours: "The energy error is bounded and of the rule's order, and does not grow over 1e6 steps. Residuals end at their round-off floor, \
               which grows with the angles.",
        head: &[
            "h",
            "rule",
            "largest \\|E − 7\\|",
            "Newton iterations a step",
            "largest residual, in floors",
            "stopped",
        ],
        rows,
        panels,
        test: "chaotic.rs",
    })
}

/// Frequency ratios up to 1e8.
pub fn spring_pendulum() -> Result<Case> {
    let mut rows = Vec::new();
    for h in [0.01, 0.001] {
        for exponent in 2..=8 {
            let ratio = 10.0_f64.powi(exponent);
            let system = SpringPendulum { k: ratio * ratio, r: 0.0 };
            let start = system.at_angle(1.0);
            let energy = system.energy_of(&start);
            for is_gauss in [false, true] {
                let (mut worst, mut angle) = (0.0_f64, 0.0_f64);
                let look = |at: Progress<2>| {
                    worst = worst.max((system.energy_of(&at.state) - energy).abs());
                    angle = angle.max(SpringPendulum::angle(&at.state).abs());
                };
                let count = [(100.0 / h) as u64, 1];
                let effort = if is_gauss {
                    drive(&system, Gauss::<3>, h, start, count, look)
                } else {
                    drive(&system, Midpoint, h, start, count, look)
                };
                rows.push(vec![
                    format!("{ratio:.0e}"),
                    format!("{h}"),
                    format!("{:.0e}", ratio * h * h),
                    if is_gauss { "Gauss, 3 stages" } else { "midpoint" }.to_owned(),
                    format!("{worst:.1e}"),
                    format!("{angle:.3}"),
                    format!("{:.2}", effort.iterations as f64 / effort.steps.max(1) as f64),
                    outcome(&effort),
                ]);
            }
        }
    }
    Ok(Case {
        title: "Spring pendulum, stiffness ratios 1e2 to 1e8",
        breaks: "Explicit methods need h below the spring's period. Newton's method with a plain residual test refuses the step: the \
                 residual of a stiff spring grows with the square of a sideways step before it falls. A tolerance on the residual that knows of rounding \
                 accepts a pendulum that stands still.",
        ours: "By the midpoint rule the spring has its length at the middle of the chord: while ωh² ≤ 1 the motion is that of the rigid pendulum, with h a \
               hundred times the spring's period and more. Beyond, the rule is unstable (U. M. Ascher and S. Reich, 1999): the energy shows it, the largest \
               angle leaves 1, and steps end with an error. Gauss with 3 stages holds the chord at three points: ωh² = 10 passes, with the energy right \
               to the rounding of the spring's; 100 does not, and the energy or an error says so. Take an angle as coordinate there.",
        head: &[
            "ω",
            "h",
            "ωh²",
            "rule",
            "largest \\|E − E₀\\| to t = 100",
            "largest angle",
            "Newton iterations a step",
            "stopped",
        ],
        rows,
        panels: Vec::new(),
        test: "stiff.rs",
    })
}

/// The energy of escape.
pub fn henon_heiles() -> Result<Case> {
    let system = HenonHeiles { r: 0.0 };
    let mut rows = Vec::new();
    for h in [0.1, 0.05, 0.02] {
        let start = HenonHeiles::start(1.0 / 6.0, -0.1, 0.1);
        let error = |at: &Progress<2>| (HenonHeiles::energy_of(&at.state) - 1.0 / 6.0).abs();
        let mut row = |name: &str, worst: f64, effort: &Effort| {
            rows.push(vec![format!("{h}"), name.to_owned(), format!("{worst:.1e}"), outcome(effort)]);
        };
        for (name, worst, effort) in by_each(&system, h, start, 1_000_000, error) {
            row(name, worst, &effort);
        }
        let mut worst = 0.0_f64;
        let run = system.by(SPLITTING_6, h).run(start);
        let effort = drive_composed(run, 1_000_000, |at| worst = worst.max(error(&at)));
        row("splitting, order 6", worst, &effort);
    }
    let section = |energy: f64, (y, v_y): (f64, f64), most: usize| {
        let mut points = Vec::new();
        let mut trajectory = system.by(Midpoint, 0.02).run(HenonHeiles::start(energy, y, v_y));
        let mut before = *trajectory.state();
        while points.len() < most {
            let Some(Ok(step)) = trajectory.next() else { break };
            let now: State<f64, 2> = step.state;
            if before.q[0] < 0.0 && now.q[0] >= 0.0 {
                let share = before.q[0] / (before.q[0] - now.q[0]);
                let between = |a: f64, b: f64| a + share * (b - a);
                points.push((between(before.q[1], now.q[1]), between(before.p[1], now.p[1])));
            }
            before = now;
        }
        points
    };
    let panel =
        |title, curves| Panel::new(title, linear("y (dimensionless)"), linear("p_y (dimensionless)"), curves);
    let orbits = [
        ("from (y, p_y) = (0.05, 0)", (0.05, 0.0), colour::REFERENCE, Mark::Circle),
        ("(0.15, 0)", (0.15, 0.0), colour::VARIATIONAL, Mark::Disc),
        ("(0.2, 0)", (0.2, 0.0), colour::RUNGE_KUTTA, Mark::Triangle),
        ("(−0.1, 0.1)", (-0.1, 0.1), colour::FOURTH, Mark::Cross),
        ("(−0.2, 0.2)", (-0.2, 0.2), colour::FIFTH, Mark::Disc),
        ("(0, 0.3)", (0.0, 0.3), colour::EULER, Mark::Square),
    ];
    let ordered = orbits
        .map(|(name, start, colour, mark)| Curve::marks(name, colour, mark, section(1.0 / 12.0, start, 120)));
    let one = section(1.0 / 6.0, (-0.1, 0.1), 1_200);
    let panels = vec![
        panel("Section x = 0, E = 1/12: six orbits in order", ordered.to_vec()),
        panel(
            "Section x = 0, E = 1/6: one orbit, chaos",
            vec![Curve::marks("from (−0.1, 0.1)", colour::VARIATIONAL, Mark::Dot, one)],
        ),
    ];
    Ok(Case {
        title: "Hénon–Heiles at the energy of escape",
        breaks: "At E = 1/6 the well's rim is at the energy of the motion: a method that gains a little leaves the well and runs to infinity.",
        ours: "A million steps within the well, with an energy error that is bounded and of the rule's order. The trapezoidal rule's error, of the same order, is \
               large enough to cross the rim at h = 0.05 and 0.1: beyond it the motion runs to infinity, and a step says so.",
        head: &["h", "rule", "largest \\|E − 1/6\\| in 1e6 steps", "stopped"],
        rows,
        panels,
        test: "chaotic.rs",
    })
}

/// Stiff energies of the chain.
pub fn fermi() -> Result<Case> {
    let system = Fermi { omega: 50.0, r: 0.0 };
    let start = system.start();
    let energy = start.energy(&system)?;
    let mut rows = Vec::new();
    // 1e5 periods of a stiff spring.
    let end = 1e5 * TAU / 50.0;
    for h in [0.02, 0.01, 0.005] {
        let mut row = |name: &str, run: &dyn Fn(Look<'_, 6>) -> Effort| {
            let (mut worst, mut sums) = (0.0_f64, [f64::INFINITY, 0.0_f64]);
            let effort = run(&mut |at| {
                let sum: f64 = system.stiff_energies(&at.state).iter().sum();
                sums = [sums[0].min(sum), sums[1].max(sum)];
                worst = worst.max(at.state.energy(&system).map_or(f64::NAN, |now| (now - energy).abs()));
            });
            rows.push(vec![
                format!("{h}"),
                format!("{:.2}", 50.0 * h),
                name.to_owned(),
                format!("{worst:.1e}"),
                format!("{:.3} … {:.3}", sums[0], sums[1]),
                outcome(&effort),
            ]);
        };
        let steps = (end / h) as u64;
        row("midpoint", &|look| drive(&system, Midpoint, h, start, [steps, 1], look));
        // The others cost several times as much; two step sizes show their order.
        if h > 0.005 {
            row("Gauss, 3 stages", &|look| drive(&system, Gauss::<3>, h, start, [steps, 1], look));
            row("composition, order 6", &|look| {
                drive_composed(system.by(ORDER_6, h).run(start), steps, look)
            });
        }
        row("splitting, order 6", &|look| drive_composed(system.by(SPLITTING_6, h).run(start), steps, look));
    }
    let exchange =
        |states: &mut dyn Iterator<Item = Result<State<f64, 6>>>, h: f64| -> Result<Vec<[f64; FERMI]>> {
            let window = (1.0 / h).round() as usize;
            let (mut means, mut sum, mut count) = (Vec::new(), [0.0; FERMI], 0);
            for state in states {
                let energies = system.stiff_energies(&state?);
                (0..FERMI).for_each(|j| sum[j] += energies[j] / window as f64);
                count += 1;
                if count == window {
                    means.push(sum);
                    (sum, count) = ([0.0; FERMI], 0);
                }
            }
            Ok(means)
        };
    let run = |h: f64| {
        let steps = system.by(Midpoint, h).run(start).take((200.0 / h).round() as usize);
        exchange(&mut steps.map(|step| Ok(step?.state)), h)
    };
    let exact = baseline::states(&system, Method::DormandPrince853(1e-12), 0.01, start)?.take(20_000);
    let exact = exchange(&mut { exact }, 0.01)?;
    let panel = |title, own: Vec<[f64; FERMI]>| {
        let points = |rows: &[[f64; FERMI]], j: usize| {
            rows.iter().enumerate().map(|(k, row)| (k as f64 + 0.5, row[j])).collect::<Vec<_>>()
        };
        let looks = [
            (["I₁, accurate", "I₂, accurate", "I₃, accurate"], Dash::Solid, 2),
            (["I₁, midpoint", "I₂, midpoint", "I₃, midpoint"], Dash::Dashed, 3),
        ];
        let colours = [colour::REFERENCE, colour::RUNGE_KUTTA, colour::VARIATIONAL];
        let mut curves = Vec::new();
        for ((labels, dash, width), rows) in looks.into_iter().zip([&exact, &own]) {
            for (j, (label, colour)) in labels.into_iter().zip(colours).enumerate() {
                curves.push(Curve::line(label, colour, width, points(rows, j)).dashed(dash));
            }
        }
        Panel::new(
            title,
            linear("time t (dimensionless)"),
            linear("energy of each stiff spring (dimensionless)"),
            curves,
        )
    };
    let panels = vec![
        panel("h = 0.005, ωh = 0.25: the exchange is right", run(0.005)?),
        panel("h = 0.03, ωh = 1.5: at another pace", run(0.03)?),
    ];
    Ok(Case {
        title: "The chain of Fermi, Pasta, Ulam and Tsingou, ω = 50",
        breaks: "The stiff springs hand energy on to each other over hundreds of their periods, driven by terms 1/ω of the rest: a method can \
                 keep the energy and hand it on wrongly. Its start has coordinates at rest without a force, whose residual has no scale.",
        ours: "Total energy and the sum of the stiff energies stay over 1e5 periods, by every method. The midpoint rule's exchange is right, to order 2, for ωh ≪ 1; at \
               ωh = 1.5 the midpoint rule hands energy on at another pace (E. Hairer, C. Lubich and G. Wanner, chapter XIII): with a step \
               beyond the stiff period the sum is to be trusted, the single energies are not. The picture shows I₁, I₂, I₃, the energies of the three stiff \
               springs, as means over one unit of time; accurate: Dormand and Prince's method of order 8 to 1e-12.",
        head: &[
            "h",
            "ωh",
            "rule",
            "largest \\|E − E₀\\|, 1e5 periods",
            "I₁ + I₂ + I₃ (starts at 1)",
            "stopped",
        ],
        rows,
        panels,
        test: "stiff.rs",
    })
}

/// Mathews–Lakshmanan up to its singularity, an arm near alignment.
pub fn singular_mass() -> Result<Case> {
    let mut rows = Vec::new();
    let system = MathewsLakshmanan { lambda: -1.0, r: 0.0 };
    for a in [0.9, 0.99, 0.999, 0.9999] {
        let omega = system.frequency(a);
        let steps = 10_000;
        let h = TAU / omega / steps as f64;
        let error = |at: &Progress<1>| (at.state.q[0] - a * (omega * at.time).sin()).abs();
        for (name, worst, effort) in by_each(&system, h, system.start(a), 10 * steps, error) {
            rows.push(vec![
                format!("oscillator, A = {a}"),
                format!("mass × {:.0e}", 1.0 / (1.0 - a * a)),
                name.to_owned(),
                format!("{worst:.1e} (position, 10 periods)"),
                outcome(&effort),
            ]);
        }
    }
    for (m, share) in [(1e-2, 0.02), (1e-4, 0.02), (1e-6, 0.02), (1e-8, 0.02), (1e-8, 0.005)] {
        let system = Arm { m, r: 0.0 };
        let start = State::from_velocity(&system, [0.3, 0.31], [0.2, 0.25])?;
        let energy = start.energy(&system)?;
        let error = |at: &Progress<2>| at.state.energy(&system).map_or(f64::NAN, |now| (now - energy).abs());
        for (name, worst, effort) in by_each(&system, share * f64::sqrt(m), start, 200_000, error) {
            rows.push(vec![
                format!("arm, upper mass {m:.0e}"),
                format!("det ≥ {m:.0e}"),
                name.to_owned(),
                format!("{worst:.1e} (energy, 2e5 steps of {share} √m)"),
                outcome(&effort),
            ]);
        }
    }
    Ok(Case {
        title: "Nearly singular masses",
        breaks: "The oscillator of Mathews and Lakshmanan, L = ½(v² − q²)/(1 − q²), has a mass that grows without bound; a double \
                 pendulum with a light upper mass has a mass matrix that all but loses its rank where the arms align.",
        ours: "The step solves for v̄ and never inverts the mass matrix by itself; pivots are held against their own rounding, not against a \
               fixed number. At the singularity itself the error is `NoDerivative` or `SingularCoordinates`. The arm with the lightest mass turns too far within a \
               step of the implicit rules of order 2: the energy shows it, and the run ends with an error; a quarter of the step passes.",
        head: &["system", "mass", "rule", "largest error", "stopped"],
        rows,
        panels: Vec::new(),
        test: "singular.rs",
    })
}

/// A charge in a strong field.
pub fn magnetic() -> Result<Case> {
    let mut rows = Vec::new();
    let h = 0.1;
    for b in [1.0, 1e2, 1e4, 1e6] {
        let system = UniformField { b, r: 0.0 };
        let speed = 1.0 / (1.0 + (0.5 * h * b).powi(2)).sqrt();
        let mut worst = 0.0_f64;
        let mut trajectory = system.by(Midpoint, h).run(UniformField::start());
        for _ in 0..1_000_000 {
            let step = trajectory.next().transpose()?;
            worst = worst.max(step.map_or(f64::NAN, |step| (step.velocity.norm() / speed - 1.0).abs()));
        }
        let mut growth = 0.0_f64;
        let effort = drive(&system, Trapezoidal, h, UniformField::start(), [1_000_000, 1], |at| {
            let [x, y] = system.velocity_of(&at.state);
            growth = growth.max(x.hypot(y));
        });
        rows.push(vec![
            format!("{:.0e}", h * b),
            format!("{worst:.1e}"),
            format!("{growth:.2}"),
            outcome(&effort),
        ]);
    }
    Ok(Case {
        title: "Magnetic terms, far faster than the step",
        breaks: "Terms linear in v make explicit methods unstable at hb > 2 and let others spiral.",
        ours: "Midpoint and trapezoidal rule turn v by 2 arctan(hb/2) a step and keep the speed, at any hb.",
        head: &[
            "hb",
            "midpoint: largest \\|v̄\\| error in 1e6 steps",
            "trapezoidal: largest \\|v\\| (starts at 1)",
            "stopped",
        ],
        rows,
        panels: Vec::new(),
        test: "damping.rs",
    })
}
