//! A pendulum against a stop that keeps 85 % of its speed at an impact, with friction in its joint: where its
//! energy goes. Each impact ends the run at its own time, to rounding, and starts it anew; steps and the
//! parts of steps up to impacts each have their ledger, and all together close to rounding. All quantities
//! are dimensionless.
//!
//! ```text
//! cargo run --release --example bouncing -- [picture.svg]
//! ```

use anyhow::{Context, Result};
use dalembert::run::events::{Crossing, Watched};
use dalembert::{Discretise, EnergyLedger, Gauss, State, rayleigh_system};
use dalembert_examples::picture::{self, Curve, Dash, Mark, Panel, colour, linear};

/// L = ½v² + cos q, R = ½rv².
#[rayleigh_system(rule = gauss)]
fn pendulum(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
}

/// Friction of the joint.
const R: f64 = 0.02;
/// The angle of the stop, short of the bottom: the pendulum comes to lie against it.
pub const STOP: f64 = 0.15;
/// What an impact leaves of the speed.
const RESTITUTION: f64 = 0.85;
/// The step size.
const H: f64 = 0.1;
/// Where it begins, at rest.
const START: f64 = 1.4;
/// Impacts.
pub const IMPACTS: usize = 30;

/// The energy's account at one time.
#[derive(Clone, Copy)]
pub struct Account {
    /// The time.
    pub time: f64,
    /// The angle.
    pub angle: f64,
    /// The energy above that at rest against the stop.
    pub energy: f64,
    /// What friction and impacts have taken.
    pub taken: [f64; 2],
}

/// The bouncing pendulum: all its steps and impacts, and which of them are impacts.
pub struct Bouncing {
    /// After every step, and before and after every impact.
    pub accounts: Vec<Account>,
    /// Times of the impacts.
    pub impacts: Vec<f64>,
    /// What the method did, that neither friction nor impacts took, at most.
    pub remainder: f64,
}

fn main() -> Result<()> {
    let bouncing = bounce()?;
    println!("impact      time t   energy before   friction took   impacts took     not closed");
    let total = bouncing.accounts[0].energy;
    for (number, time) in bouncing.impacts.iter().enumerate().filter(|(number, _)| number % 3 == 0) {
        let account = bouncing.accounts.iter().find(|account| account.time == *time).context("an impact")?;
        let [friction, impacts] = account.taken;
        let open = account.energy + friction + impacts - total;
        println!(
            "{:>6} {time:>11.6} {:>15.9} {friction:>15.9} {impacts:>14.9} {open:>14.1e}",
            number + 1,
            account.energy
        );
    }
    println!("\nNot closed at any time: {:.1e} at most, of an energy of {total:.3}.", bouncing.remainder);
    println!("\nPicture: {}", draw(&bouncing)?.display());
    Ok(())
}

/// The run, by Gauss<8>.
pub fn bounce() -> Result<Bouncing> {
    let system = Pendulum { r: R };
    let by = system.by(Gauss::<8>, H);
    let mut from = State::from_velocity(&system, [START], [0.0])?;
    let mut run = by.run(from);
    let mut watch = run.watch(|at| [at.q[0] - STOP]).crossing([Crossing::Falling]).terminal([true]);
    let (mut friction, mut taken) = (0.0, 0.0);
    let account = |time, state: &State<f64, 1>, taken| -> Result<Account> {
        Ok(Account { time, angle: state.q[0], energy: state.energy(&system)? + STOP.cos(), taken })
    };
    let mut bouncing =
        Bouncing { accounts: vec![account(0.0, &from, [0.0, 0.0])?], impacts: Vec::new(), remainder: 0.0 };
    while bouncing.impacts.len() < IMPACTS {
        match watch.advance().context("a run without end")?? {
            Watched::Step(step) => {
                let ledger: EnergyLedger<f64> = by.ledger(&from, &step.state)?;
                friction += ledger.dissipated;
                from = step.state;
                bouncing.accounts.push(account(watch.run().time(), &from, [friction, taken])?);
            }
            Watched::Event(impact) => {
                // The part of the step up to here.
                friction += by.with_step(impact.elapsed).ledger(&impact.from, &impact.state)?.dissipated;
                bouncing.accounts.push(account(impact.time, &impact.state, [friction, taken])?);
                bouncing.impacts.push(impact.time);
                from = State { q: impact.state.q, p: -RESTITUTION * impact.state.p };
                taken += impact.state.energy(&system)? - from.energy(&system)?;
                bouncing.accounts.push(account(impact.time, &from, [friction, taken])?);
                watch.restart(from);
            }
        }
    }
    let total = bouncing.accounts[0].energy;
    let open = |account: &Account| (account.energy + account.taken[0] + account.taken[1] - total).abs();
    bouncing.remainder = bouncing.accounts.iter().map(open).fold(0.0, f64::max);
    Ok(bouncing)
}

fn draw(bouncing: &Bouncing) -> Result<std::path::PathBuf> {
    let of = |value: &dyn Fn(&Account) -> f64| -> Vec<(f64, f64)> {
        bouncing.accounts.iter().map(|account| (account.time, value(account))).collect()
    };
    let end = bouncing.accounts.last().map_or(0.0, |account| account.time);
    let angle = vec![
        Curve::line("the pendulum", colour::VARIATIONAL, 2, of(&|account| account.angle)),
        Curve::marks(
            "impacts",
            colour::RUNGE_KUTTA,
            Mark::Disc,
            bouncing.impacts.iter().map(|&time| (time, STOP)).collect(),
        ),
        Curve::line("the stop", colour::REFERENCE, 2, vec![(0.0, STOP), (end, STOP)]).dashed(Dash::Dashed),
    ];
    let total = bouncing.accounts[0].energy;
    let band = |low: &dyn Fn(&Account) -> f64, high: &dyn Fn(&Account) -> f64| -> Vec<(f64, [f64; 2])> {
        bouncing.accounts.iter().map(|account| (account.time, [low(account), high(account)])).collect()
    };
    let energy = vec![
        Curve::band("left to the pendulum", colour::SIXTH, &band(&|_| 0.0, &|account| account.energy)),
        Curve::band(
            "taken by friction",
            colour::FIFTH,
            &band(&|account| account.energy, &|account| account.energy + account.taken[0]),
        ),
        Curve::band(
            "taken by impacts",
            colour::RUNGE_KUTTA,
            &band(&|account| account.energy + account.taken[0], &|account| {
                account.energy + account.taken[0] + account.taken[1]
            }),
        ),
        Curve::line("energy at the start", colour::REFERENCE, 2, vec![(0.0, total), (end, total)])
            .dashed(Dash::Dashed),
    ];
    let panels = [
        Panel::new(
            "A pendulum bounces off a stop and comes to rest",
            linear("time t (dimensionless)"),
            linear("angle (rad)"),
            angle,
        ),
        Panel::new(
            "Impacts take most of its energy",
            linear("time t (dimensionless)"),
            linear("energy above rest (dimensionless)"),
            energy,
        ),
    ];
    picture::write("bouncing", [1240, 560], 2, &panels)
}
