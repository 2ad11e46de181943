//! Springs and sliders in series: coordinates without mass that dry friction alone holds.

use core::f64::consts::{FRAC_PI_2, PI};

use dalembert::nalgebra::{Vector3, Vector4, vector};
use dalembert::run::stick_slip::Change;
use dalembert::{Discretise, Proximal, State, StepError, rayleigh_system};
use dalembert_tests::draws::Draws;
use dalembert_tests::hysteresis::{Iwan, Motion, SLIDERS};

/// A mass on a spring that ends in a slider.
const JENKIN: Iwan =
    Iwan { m: 1.0, k0: 0.0, load: 0.0, k: [4.0; SLIDERS], mu: [0.7, 0.0, 0.0], at_mass: [1.0; SLIDERS] };

/// Three springs that end in sliders, pulled to and fro by x sin t.
#[derive(Clone, Copy)]
struct Pulled {
    x: f64,
    k: [f64; 3],
    mu: [f64; 3],
}

const PULLED: Pulled = Pulled { x: 1.0, k: [1.0, 2.0, 3.0], mu: [0.8, 0.6, 0.3] };

#[allow(clippy::needless_range_loop, reason = "indices as in the formula")]
#[rayleigh_system(rule = proximal)]
impl Pulled {
    fn lagrangian(&self, q: [f64; 3], _v: [f64; 3], t: f64) -> f64 {
        let mut sum = 0.0;
        for j in 0..3 {
            sum -= 0.5 * self.k[j] * (self.x * t.sin() - q[j]).powi(2);
        }
        sum
    }

    fn rayleigh(&self, v: [f64; 3]) -> f64 {
        self.mu[0] * v[0].abs() + self.mu[1] * v[1].abs() + self.mu[2] * v[2].abs()
    }
}

impl Pulled {
    fn force(&self, t: f64, q: &Vector3<f64>) -> f64 {
        (0..3).map(|j| self.k[j] * (self.x * t.sin() - q[j])).sum()
    }

    /// The force on the first way, from rest, and by G. Masing's rule (1926) all others.
    fn skeleton(&self, x: f64) -> f64 {
        (0..3).map(|j| (self.k[j] * x).clamp(-self.mu[j], self.mu[j])).sum()
    }
}

/// The loop of hysteresis, whose ways back and forth are the first one twice as large, to rounding: steps end
/// where the pull turns. Friction takes 4 Σ μ (x − μ/k) in a period.
#[test]
fn masing() -> Result<(), StepError> {
    let quarter = 50;
    let h = FRAC_PI_2 / f64::from(quarter);
    let start = State { q: Vector3::zeros(), p: Vector3::zeros() };
    let off = |pulled: Pulled| -> Result<[f64; 2], StepError> {
        let (mut off, mut work, mut last) = (0.0_f64, 0.0, 0.0);
        for (i, step) in (1..=5 * quarter).zip(pulled.at_time(0.0).by(Proximal, h).run(start)) {
            let (t, state) = (f64::from(i) * h, step?.state);
            assert_eq!(state.p, Vector3::zeros());
            let (x, force) = (t.sin(), pulled.force(t, &state.q));
            let exact = match i / quarter {
                0 => PULLED.skeleton(x),
                1 | 2 if i <= 3 * quarter => PULLED.skeleton(1.0) - 2.0 * PULLED.skeleton(0.5 * (1.0 - x)),
                _ => -PULLED.skeleton(1.0) + 2.0 * PULLED.skeleton(0.5 * (1.0 + x)),
            };
            off = off.max((force - exact).abs());
            if i > quarter {
                work += 0.5 * (force + last) * (x - (t - h).sin());
            }
            last = force;
        }
        let taken: f64 = (0..3).map(|j| 4.0 * PULLED.mu[j] * (1.0 - PULLED.mu[j] / PULLED.k[j])).sum();
        Ok([off, (work / taken - 1.0).abs()])
    };
    let [of_loop, of_work] = off(PULLED)?;
    assert!(of_loop < 1e-13 && of_work < 1e-3, "{of_loop:e} {of_work:e}");
    // The control.
    let [of_loop, of_work] = off(Pulled { mu: [0.8, 0.6, 0.303], ..PULLED })?;
    assert!(of_loop > 2e-3 && of_work > 2e-3, "{of_loop:e} {of_work:e}");
    Ok(())
}

/// As long as it is pulled, the end of a spring that slides follows its beginning.
#[test]
fn what_slides_follows() -> Result<(), StepError> {
    let at = |t: f64| -> Result<Vector3<f64>, StepError> {
        let steps = (t / 1e-2).round() as usize;
        let start = State { q: Vector3::zeros(), p: Vector3::zeros() };
        let end = PULLED.at_time(0.0).by(Proximal, t / steps as f64).run(start).nth(steps - 1).unwrap()?;
        end.state.velocity(&PULLED.at_time(t))
    };
    let v = at(0.5)?;
    assert!(v[0] == 0.0 && (v - vector![0.0, 0.5_f64.cos(), 0.5_f64.cos()]).amax() < 1e-9, "{v}");
    let v = at(PI + 0.1)?;
    assert!(v[0] == 0.0 && (v[2] + 0.1_f64.cos()).abs() < 1e-9, "{v}");
    Ok(())
}

/// Masses with several sliders, of either end of a spring, against their motion from event to event: none is
/// refused, order 2, and velocities of what slides and holds.
#[test]
fn random_systems_have_their_motion() -> Result<(), StepError> {
    let mut draws = Draws::new(0x6877_616e);
    let (count, time) = (if cfg!(debug_assertions) { 12 } else { 1000 }, 5.0);
    let (mut events, mut slide, mut seen, mut controls) = (0, 0, 0, 0);
    let (mut off, mut sums) = ([0.0_f64; 2], [0.0_f64; 2]);
    for number in 0..count {
        let iwan = Iwan::drawn(&mut draws);
        let (q, v) = (draws.between(-1.0, 1.0), draws.between(-2.0, 2.0));
        let forces = std::array::from_fn(|j| iwan.mu[j] * draws.between(-1.0, 1.0));
        let mut motion = Motion::new(iwan, q, v, forces);
        let start = State::from_velocity(&iwan, motion.place(), [v, 7.0, 7.0, 7.0])?;
        assert_eq!(start.p, vector![iwan.m * v, 0.0, 0.0, 0.0]);
        motion.advance(0.95 * time);
        let slid = motion.slides;
        motion.advance(0.05 * time);
        events += motion.events;
        slide += motion.slides.iter().filter(|slides| **slides).count();
        let mut error = |iwan: Iwan, steps: usize| -> Result<f64, StepError> {
            let by = iwan.by(Proximal, time / steps as f64);
            let (mut state, mut remainder, mut taken) = (start, 0.0_f64, 0.0);
            for step in by.run(start).take(steps) {
                let next = step?.state;
                let entry = by.ledger(&state, &next)?;
                remainder = remainder.max(entry.remainder().abs());
                assert!(entry.dissipated > -1e-11, "{number}: {entry:?}");
                taken += entry.dissipated;
                state = next;
            }
            let v = state.velocity(&iwan)?;
            for j in 0..SLIDERS {
                // At an event the steps may be on the other side of it.
                let room = iwan.mu[j] - motion.forces[j].abs();
                if motion.v.abs() < 0.05 || motion.slides[j] != slid[j] || !slid[j] && room < 0.05 {
                    continue;
                }
                seen += 1;
                let expected = if (iwan.at_mass[j] == 1.0) == motion.slides[j] { v[0] } else { 0.0 };
                assert!((v[j + 1] - expected).abs() < 1e-9, "{number}, slider {j}: {v} {motion:?}");
            }
            let forces = iwan.forces(&state.q);
            assert!((0..SLIDERS).all(|j| forces[j].abs() <= iwan.mu[j] * (1.0 + 1e-12)));
            assert!(remainder < 1e-12, "{number}: {remainder:e}");
            let of_forces = forces.iter().zip(motion.forces).map(|(a, b)| (a - b).abs());
            let of_mass = (state.q[0] - motion.q).abs().max((v[0] - motion.v).abs());
            let off = of_forces.fold(of_mass, f64::max);
            Ok(off.max((taken - motion.dissipated).abs()))
        };
        let found = [error(iwan, 100)?, error(iwan, 400)?];
        off = [off[0].max(found[0]), off[1].max(found[1])];
        sums = [sums[0] + found[0], sums[1] + found[1]];
        let other = Iwan { mu: iwan.mu.map(|mu| 1.01 * mu), ..iwan };
        // Where nothing comes to its limit friction does not matter.
        if motion.events > 4 && other.by(Proximal, 0.1).step(&start).is_ok() {
            let mut other_motion = Motion::new(other, q, v, forces);
            other_motion.advance(time);
            controls += usize::from((other_motion.q - motion.q).abs() > 2.0 * found[1]);
        }
    }
    let order = (sums[0] / sums[1]).log2() / 2.0;
    println!("{off:?}, order {order}, {events} events, {seen} velocities, {controls} tell 1 % of friction");
    assert!(seen > 2 * count && events > 5 * count && slide > count / 4 && controls > count / 2);
    assert!(off[0] < 0.1 && off[1] < 7e-3 && (order - 2.0).abs() < 0.1, "{off:?} {order}");
    Ok(())
}

/// Between its limits a slider is a rod: the mass swings for ever, whichever end of the spring slides.
#[test]
fn what_holds_takes_nothing() -> Result<(), StepError> {
    for at_mass in [0.0, 1.0] {
        let held = Iwan { mu: [1e3; SLIDERS], at_mass: [at_mass; SLIDERS], ..JENKIN };
        let start = State::from_velocity(&held, [0.0; 4], [1.0, 0.0, 0.0, 0.0])?;
        let end = held.by(Proximal, 0.05).run(start).nth(1_999).unwrap()?.state;
        assert!((end.energy(&held)? / start.energy(&held)? - 1.0).abs() < 1e-6, "{end:?}");
    }
    Ok(())
}

/// A mass that rubs itself, and drags a slider behind a spring.
#[derive(Clone, Copy)]
struct Dragging {
    own: f64,
    mu: f64,
}

#[rayleigh_system(rule = proximal)]
impl Dragging {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * v[0] * v[0] - 2.0 * (q[0] - q[1]).powi(2)
    }

    fn rayleigh(&self, v: [f64; 2]) -> f64 {
        self.own * v[0].abs() + self.mu * v[1].abs()
    }
}

/// It stops with the slider at its limit, where it stays to the last bit; from where nothing bears the spring
/// the slider goes at once to where it does.
#[test]
fn at_rest_at_its_limit() -> Result<(), StepError> {
    let system = Dragging { own: 0.5, mu: 0.3 };
    let start = State::from_velocity(&system, [0.0, 0.0], [2.0, 0.0])?;
    let mut run = system.by(Proximal, 0.01).run(start);
    let rest = run.nth(999).unwrap()?.state;
    assert!(rest.p == vector![0.0, 0.0] && (4.0 * (rest.q[0] - rest.q[1]) - 0.3).abs() < 4e-15, "{rest:?}");
    assert_eq!(rest.velocity(&system)?, vector![0.0, 0.0]);
    assert_eq!(run.nth(4_999).unwrap()?.state, rest);

    let far = State { q: vector![0.0, -1.0], p: vector![0.0, 0.0] };
    let step = system.by(Proximal, 0.01).step(&far)?;
    assert!((step.state.q[1] + 0.3 / 4.0).abs() < 1e-15 && step.state.q[0] == 0.0, "{step:?}");
    Ok(())
}

/// It slides from where the spring has its limit, by (μ/k, √(v² − μ²/k)), and sticks where the mass turns.
#[test]
fn it_is_told_when_sliders_slip_and_stick() -> Result<(), StepError> {
    let start = State::from_velocity(&JENKIN, [0.0; 4], [1.0, 0.0, 0.0, 0.0])?;
    let slips = (2.0_f64 * 0.7 / 4.0).asin() / 2.0;
    let sticks = slips + (1.0_f64 - 0.49 / 4.0).sqrt() / 0.7;
    let off = |steps: usize| -> Result<[f64; 2], StepError> {
        let mut run = JENKIN.by(Proximal, 2.0 / steps as f64).run(start);
        let events = run.stick_slip(2.0).collect::<Result<Vec<_>, _>>()?;
        let of_first: Vec<_> = events.iter().filter(|event| event.element == 0).collect();
        assert!(of_first.len() == 2 && of_first[0].change == Change::Slips, "{events:?}");
        Ok([(of_first[0].time - slips).abs(), (of_first[1].time - sticks).abs()])
    };
    let (coarse, fine) = (off(100)?, off(400)?);
    assert!((0..2).all(|i| coarse[i] < 1e-3 && fine[i] < coarse[i] / 8.0), "{coarse:?} {fine:?}");
    Ok(())
}

/// A and derivatives by parameters, against differences; at its limit, where a slider does not slide on,
/// there are none.
#[test]
fn steps_are_differentiated() {
    const FIELDS: [fn(&mut Iwan) -> &mut f64; 7] = [
        |iwan| &mut iwan.m,
        |iwan| &mut iwan.k0,
        |iwan| &mut iwan.load,
        |iwan| &mut iwan.k[0],
        |iwan| &mut iwan.k[1],
        |iwan| &mut iwan.mu[0],
        |iwan| &mut iwan.mu[1],
    ];
    let (h, by) = (0.05, 1e-7);
    let mut draws = Draws::new(12);
    let (mut refused, mut kinds) = (0, [0; 4]);
    let count = if cfg!(debug_assertions) { 60 } else { 1000 };
    for number in 0..count {
        let iwan = Iwan::drawn(&mut draws);
        let forces = std::array::from_fn(|j| iwan.mu[j] * draws.between(-1.0, 1.0));
        let mut motion = Motion::new(iwan, draws.between(-1.0, 1.0), draws.between(-2.0, 2.0), forces);
        motion.advance(draws.between(0.0, 5.0));
        let start = State { q: motion.place(), p: vector![iwan.m * motion.v, 0.0, 0.0, 0.0] };
        let taken = match iwan.by(Proximal, h).linearized(&start) {
            Ok(taken) => taken,
            Err(error) => {
                assert!(matches!(error, StepError::AtLimitOfFriction { .. }), "{number}: {error}");
                refused += 1;
                continue;
            }
        };
        let end = taken.step().state;
        // Differences look beyond an edge that is so near.
        let is_near = |q: &Vector4<f64>| {
            let forces = iwan.forces(q);
            (0..SLIDERS).any(|j| (1e-12..1e-4).contains(&(1.0 - forces[j].abs() / iwan.mu[j])))
        };
        if is_near(&start.q)
            || is_near(&end.q)
            || is_near(&(0.5 * (start.q + end.q)))
            || end.p[0].abs() < 1e-4
        {
            continue;
        }
        for j in 0..SLIDERS {
            kinds[2 * usize::from(motion.slides[j]) + usize::from(iwan.at_mass[j] == 1.0)] += 1;
        }
        let step = |iwan: Iwan, state: &State<f64, 4>| iwan.by(Proximal, h).step(state).unwrap().state;
        let difference = |at: &dyn Fn(f64) -> State<f64, 4>| {
            let (ahead, behind) = (at(by), at(-by));
            [(ahead.q - behind.q) / (2.0 * by), (ahead.p - behind.p) / (2.0 * by)]
        };
        let a = taken.by_state().unwrap();
        for index in 0..5 {
            let moved = |by: f64| {
                let mut state = start;
                *(if index < 4 { &mut state.q[index] } else { &mut state.p[0] }) += by;
                step(iwan, &state)
            };
            let (q, p) = if index < 4 { (&a.q_by_q, &a.p_by_q) } else { (&a.q_by_p, &a.p_by_p) };
            let [of_q, of_p] = difference(&moved);
            let off = (of_q - q.column(index % 4)).amax().max((of_p - p.column(index % 4)).amax());
            assert!(off < 1e-6, "{number}, {index}: {off:e} {motion:?}");
        }
        let b = taken.by_parameters::<7>().unwrap();
        for (index, field) in FIELDS.into_iter().enumerate() {
            let moved = |by: f64| {
                let mut other = iwan;
                *field(&mut other) += by;
                step(other, &start)
            };
            let [of_q, of_p] = difference(&moved);
            let off = (of_q - b.q.column(index)).amax().max((of_p - b.p.column(index)).amax());
            assert!(off < 1e-6, "{number}, parameter {index}: {off:e} {motion:?}");
        }
    }
    println!("{refused} refused, {kinds:?}");
    assert!(refused < count / 10 && kinds.iter().all(|&kind| kind > count / 12), "{refused} {kinds:?}");
}
