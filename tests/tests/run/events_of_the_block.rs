//! Event functions that the block of a system states: values, fields, input and time.

use dalembert::run::events::{Crossing, Event};
use dalembert::system::{Described, EventFunctions};
use dalembert::{Discretise, Gauss, Lagrangian, Midpoint, State, StepError, rayleigh_system};
use dalembert_tests::draws::Draws;

/// A mass on a spring with drag, pushed; its events are those of a line that moves, and of the speed.
struct Cart {
    k: f64,
    line: [f64; 2],
    speed: f64,
}

#[rayleigh_system(rule = [midpoint, gauss], parameters = [k])]
impl Cart {
    fn lagrangian(&self, q: [f64; 1], v: [f64; 1]) -> f64 {
        0.5 * v[0] * v[0] - 0.5 * self.k * q[0] * q[0]
    }

    fn rayleigh(&self, v: [f64; 1]) -> f64 {
        0.05 * v[0] * v[0]
    }

    fn force(&self, _q: [f64; 1], _v: [f64; 1], u: [f64; 1]) -> [f64; 1] {
        u
    }

    fn events(&self, q: [f64; 1], v: [f64; 1], t: f64) -> [f64; 2] {
        // No lowering of this body: it branches, calls, and counts.
        let mut line = 0.0;
        for (power, coefficient) in (0..).zip(self.line) {
            line += coefficient * t.powi(power);
        }
        [q[0] - line, if v[0] < 0.0 { -v[0] - self.speed } else { v[0] - self.speed }]
    }
}

/// Held in one dimension, without input and time: its events stand on the system itself.
struct Ring {
    radius: f64,
}

#[rayleigh_system(derivatives = num_dual)]
impl Ring {
    fn lagrangian(&self, q: [f64; 2], v: [f64; 2]) -> f64 {
        0.5 * (v[0] * v[0] + v[1] * v[1]) - 0.5 * (q[0] * q[0] + 2.0 * q[1] * q[1])
    }

    fn events(&self, q: [f64; 2], _v: [f64; 2]) -> [f64; 1] {
        [q[0].hypot(q[1]) - self.radius]
    }
}

type Found = Vec<(usize, f64, State<f64, 1>)>;

fn listed(events: impl Iterator<Item = Event<f64, 1>>) -> Found {
    events.map(|event| (event.index, event.time, event.state)).collect()
}

/// The events of the block, and those of a function that says the same here.
fn both(
    cart: &Cart,
    u: f64,
    t: f64,
    start: State<f64, 1>,
) -> Result<[Found; 2], Box<dyn core::error::Error>> {
    let view = cart.driven([u], t);
    let crossings = [Crossing::Either, Crossing::Rising];
    let mut run = view.by(Gauss::<4>, 0.2).run(start);
    let of_block =
        run.watch(|at| at.events()).crossing(crossings).until(12.0).collect::<Result<Vec<_>, _>>()?;
    let ([a, b], speed) = (cart.line, cart.speed);
    let mut run = view.by(Gauss::<4>, 0.2).run(start);
    let here = run
        .watch(|at| [at.q[0] - (a + b * (t + at.time)), at.velocity()[0].abs() - speed])
        .crossing(crossings)
        .until(12.0)
        .collect::<Result<Vec<_>, _>>()?;
    Ok([listed(of_block.into_iter()), listed(here.into_iter())])
}

#[test]
fn they_are_those_of_a_function_that_says_the_same() -> Result<(), Box<dyn core::error::Error>> {
    let mut random = Draws::new(11);
    let (mut found, mut moved) = (0, 0);
    for _ in 0..if cfg!(debug_assertions) { 40 } else { 400 } {
        let mut cart = Cart {
            k: random.between(0.5, 4.0),
            line: [random.between(-0.5, 0.5), random.between(-0.1, 0.1)],
            speed: random.between(0.2, 1.0),
        };
        let start = State { q: [random.between(-1.0, 1.0)].into(), p: [random.between(-1.0, 1.0)].into() };
        let (u, t) = (random.between(-0.5, 0.5), random.between(-3.0, 3.0));
        let [of_block, here] = both(&cart, u, t, start)?;
        assert_eq!(of_block.len(), here.len());
        for (one, other) in of_block.iter().zip(&here) {
            assert!(one.0 == other.0 && (one.1 - other.1).abs() < 1e-11, "{one:?} {other:?}");
        }
        found += of_block.len();
        // Control: fields and the time are read.
        cart.line[0] += 0.01;
        moved += usize::from(both(&cart, u, t, start)?[0] != of_block);
    }
    assert!(found > 200 && moved > 30, "{found} {moved}");
    Ok(())
}

#[test]
fn their_time_is_that_of_the_system() -> Result<(), StepError> {
    let cart = Cart { k: 1.0, line: [0.25, -2.0], speed: 0.5 };
    let values = |t| EventFunctions::<1, 2>::events(&cart.driven([0.0], t), &[1.0].into(), &[-0.75].into());
    assert_eq!(values(0.0), [0.75, 0.25]);
    assert_eq!(values(3.0), [6.75, 0.25]);
    let later =
        |system: &DrivenCart<'_>| EventFunctions::<1, 2>::events(system, &[1.0].into(), &[0.0].into());
    assert_eq!(cart.driven([0.0], 1.0).later(2.0, later), [6.75, -0.5]);
    const { assert!(<Cart as Described<1>>::EVENTS == 2 && <Ring as Described<2>>::EVENTS == 1) };
    Ok(())
}

#[test]
fn a_system_by_dual_numbers_has_them_too() -> Result<(), Box<dyn core::error::Error>> {
    // From the x axis both coordinates are harmonic: the radius is that of the start at every half turn of x.
    let ring = Ring { radius: 0.5 };
    let start = State::from_velocity(&ring, [1.0, 0.0], [0.0, 0.0])?;
    let mut run = ring.by(Midpoint, 0.01).run(start);
    let found = run.watch(|at| at.events::<1>()).until(6.0).collect::<Result<Vec<_>, _>>()?;
    assert_eq!(found.len(), 4);
    for (event, turns) in found.iter().zip([1.0, 2.0, 4.0, 5.0]) {
        assert!((event.time - turns * core::f64::consts::FRAC_PI_3).abs() < 1e-3, "{event:?}");
        assert!((event.state.q.norm() - 0.5).abs() < 1e-14);
    }
    Ok(())
}
