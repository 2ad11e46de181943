//! Prints runs of the systems of the Python package, a record a line, for `python/tests` to hold the
//! package's against: a name, and t, q, v, p and energy as bits, or the reactions of a step.

use dalembert::run::DrivenTrajectory;
use dalembert::step::{Flow, MethodOf};
use dalembert::system::{Interpolation, Table};
use dalembert::{Discretise, Gauss, Lagrangian, Midpoint, Splitting, State, StepError, Trapezoidal};

#[path = "../../python/src/cart_pole.rs"]
mod cart_pole;
#[path = "../../python/src/oscillator.rs"]
mod oscillator;
#[path = "../../python/src/ring.rs"]
mod ring;
#[path = "../../python/src/rocket.rs"]
mod rocket;
#[path = "../../python/src/spherical_pendulum.rs"]
mod spherical_pendulum;

use cart_pole::{CartPole, DrivenCartPole};
use dalembert_face::fields as parameters;
use oscillator::ShakenOscillator;
use ring::Ring;
use rocket::Rocket;
use spherical_pendulum::SphericalPendulum;

const RING: Ring = Ring { k: 1e-3 };

fn print<L: Lagrangian<N, Scalar = f64>, const N: usize>(
    name: &str,
    system: &L,
    t: f64,
    state: &State<f64, N>,
) -> Result<(), StepError> {
    let (v, energy) = (state.velocity(system)?, state.energy(system)?);
    print!("{name}");
    let numbers = [t].into_iter().chain(state.q.iter().copied()).chain(v.iter().copied());
    for number in numbers.chain(state.p.iter().copied()).chain([energy]) {
        print!(" {:016x}", number.to_bits());
    }
    println!();
    Ok(())
}

/// 1000 steps of 0.2, every 7th printed, and the last.
fn by<M>(name: &str, method: M) -> Result<(), StepError>
where
    Ring: Flow<M, 2, Scalar = f64>,
    M: MethodOf<Ring, 2>,
{
    let start = State::from_velocity(&RING, [0.0, 1.15549918674982], [0.5, 0.0])?;
    let mut run = RING.by(method, 0.2).run(start);
    print(name, &RING, 0.0, &start)?;
    for k in 1..=1000 {
        run.next().transpose()?;
        if k % 7 == 0 || k == 1000 {
            print(name, &RING, run.time(), run.state())?;
        }
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    by("midpoint", Midpoint)?;
    by("trapezoidal", Trapezoidal)?;
    by("gauss_2", Gauss::<2>)?;
    by("gauss_4", Gauss::<4>)?;
    by("gauss_6", Gauss::<6>)?;
    by("gauss_8", Gauss::<8>)?;
    by("blanes_moan_4", Splitting::blanes_moan_4())?;
    by("blanes_moan_6", Splitting::blanes_moan_6())?;
    by("blanes_casas_escorihuela_8", Splitting::blanes_casas_escorihuela_8())?;

    let start = State::from_velocity(&RING, [0.0, 1.15549918674982], [0.5, 0.0])?;
    let mut run = RING.to_error(1e-9).until(50.0).run(start)?;
    print("to_error", &RING, 0.0, &start)?;
    let mut steps = 0;
    while let Some(step) = run.next() {
        step?;
        steps += 1;
        if steps % 3 == 0 {
            print("to_error", &RING, run.time(), run.state())?;
        }
    }
    if steps % 3 != 0 {
        print("to_error", &RING, run.time(), run.state())?;
    }

    let start = State::from_velocity(&RING, [0.0, 1.15549918674982], [0.5, 0.0])?;
    let mut run = RING.by(Midpoint, 0.2).run(start);
    print("until", &RING, 0.0, &start)?;
    while let Some(step) = run.until(1.5).next() {
        step?;
        print("until", &RING, run.time(), run.state())?;
    }
    let mut run = RING.by(Midpoint, 0.2).run(start);
    for sample in run.sample_at([0.0, 0.05, 0.4, 0.41, 0.41, 1.1]) {
        let sample = sample?;
        print("times", &RING, sample.time, &sample.state)?;
    }

    let shaken = ShakenOscillator { m: 1.3, k: 2.0, r: 0.1, a: 0.5, omega: 1.7 };
    let view = shaken.at_time(3.0);
    let start = State::from_velocity(&view, [1.0], [0.0])?;
    let mut run = view.by(Midpoint, 0.1).run(start);
    print("shaken", &view, 3.0, &start)?;
    for _ in 0..200 {
        run.next().transpose()?;
        print("shaken", &view, 3.0 + run.time(), run.state())?;
    }

    let cart = CartPole { cart: 1.0, rod: 0.1, half_length: 0.25, friction: [0.1, 0.002] };
    let start = State::from_velocity(&cart, [0.0, 0.1], [0.0, 0.0])?;
    let mut run = DrivenTrajectory::<DrivenCartPole<'static>, Midpoint, 2>::new(0.01, start);
    print("driven", &cart, 0.0, &start)?;
    for k in 0..200 {
        run.advance(&cart.driven([(0.1 * f64::from(k)).sin()]))?;
        print("driven", &cart, run.time(), run.state())?;
    }

    let bob = SphericalPendulum { m: 1.3, l: 0.7, g: 9.81, c: 0.4 };
    let nearest = State::nearest(&bob, [0.0, 0.3, -0.4], [0.5, 1.0, 1.0])?;
    let start = State::from_velocity(&bob, nearest.q, nearest.velocity(&bob)?)?;
    let mut run = DrivenTrajectory::<SphericalPendulum, Midpoint, 3>::new(0.01, start);
    print("spherical", &bob, 0.0, &start)?;
    for _ in 0..200 {
        let before = *run.state();
        let step = run.advance(&bob)?;
        print("spherical", &bob, run.time(), run.state())?;
        let lambda = bob.by(Midpoint, 0.01).reactions::<1>(&before, &step)?;
        println!("spherical_reactions {:016x}", lambda[0].to_bits());
    }
    for of in Interpolation::ALL {
        rocket(of)?;
    }
    Ok(())
}

/// A rocket with tables of an interpolation, the drag straight beyond where it does not repeat itself.
fn rocket(of: Interpolation) -> Result<(), Box<dyn std::error::Error>> {
    let name = format!("rocket_{of}");
    let drag = Table::through(of, [0.0, 10.0, 20.0, 35.0, 50.0, 80.0], [0.0, 4.0, 15.0, 40.0, 45.0, 0.0])?;
    let rocket = Rocket {
        mass: 2.0,
        thrust: Table::through(of, [0.0, 0.25, 2.0, 2.25], [0.0, 60.0, 45.0, 0.0])?,
        drag: if of == Interpolation::Periodic { drag } else { drag.straight_beyond() },
    };
    let view = rocket.at_time(0.25);
    let start = State::from_velocity(&view, [0.0], [5.0])?;
    let mut run = view.by(Midpoint, 0.05).run(start);
    print(&name, &view, 0.25, &start)?;
    for _ in 0..100 {
        run.next().transpose()?;
        print(&name, &view, 0.25 + run.time(), run.state())?;
    }
    Ok(())
}
