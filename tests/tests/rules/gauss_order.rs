//! `Gauss<S>` is of order 2S, also where masses, friction and force depend on q.
//!
//! Reference: another method (Dormand–Prince 8(5,3)) on accelerations derived on paper.

use dalembert::nalgebra::SVector;
use dalembert::system::{ActingForce, CovectorDerivatives, Derivatives, ForcedLagrangian};
use dalembert::{Discrete, Discretise, Gauss, Lagrangian, State};
use dalembert_tests::by_hand::ByHand;
use dalembert_tests::convergence::Convergence;
use dalembert_tests::reference;
use dalembert_tests::systems::{Bead, Charge, DoublePendulum, Follower};

/// Errors below this are rounding and the reference's.
const PLATEAU: f64 = 2e-13;

/// Times at which errors are taken: at one alone the leading term may happen to vanish.
const TIMES: [f64; 3] = [1.0, 2.0, 3.0];

/// A motion's states at 0 and at [`TIMES`] in units of `unit`, by the reference.
struct Motion<const N: usize> {
    start: State<f64, N>,
    exact: [State<f64, N>; TIMES.len()],
    unit: f64,
}

impl<const N: usize> Motion<N> {
    fn new<S: ByHand<N>>(system: &S, [q, v]: [[f64; N]; 2], unit: f64) -> Self {
        let state = |q: [f64; N], v| State { q: q.into(), p: system.momentum(q, v) };
        let (mut at, mut before) = ((q, v), 0.0);
        let exact = TIMES.map(|time| {
            at = reference::motion(system, at.0, at.1, (time - before) * unit);
            before = time;
            state(at.0, at.1)
        });
        Self { start: state(q, v), exact, unit }
    }
}

/// Observed order over ever smaller steps, until the error reaches the plateau.
fn order<L, const N: usize, const STAGES: usize>(motion: &Motion<N>, system: impl Fn(f64) -> L) -> f64
where
    L: Discrete<Gauss<STAGES>, N, Scalar = f64>,
{
    let Motion { start, exact, unit } = motion;
    let mut convergence = Convergence::default();
    let mut steps = (*unit as u32).max(2);
    let most = if cfg!(debug_assertions) { (16.0 * unit).max(200.0) as u32 } else { 2000 };
    loop {
        let h = unit * TIMES[0] / f64::from(steps);
        let system = system(h);
        let mut run = system.by(Gauss::<STAGES>, h).run(*start);
        let error = exact.iter().fold(0.0, |sum, exact| {
            let state = run.by_ref().take(steps as usize).last().unwrap().unwrap().state;
            sum + (state.q - exact.q).norm_squared() + (state.p - exact.p).norm_squared()
        });
        convergence.push(h, error.sqrt());
        if error.sqrt() < PLATEAU || steps > most {
            return convergence.order(PLATEAU);
        }
        // The high orders show on few steps, just above the plateau.
        steps += (steps / if STAGES < 4 { 4 } else { 8 }).max(1);
    }
}

fn has_order<S, const N: usize, const STAGES: usize>(system: &S, motion: &Motion<N>)
where
    S: Discrete<Gauss<STAGES>, N, Scalar = f64> + Copy,
{
    let (order, expected) = (order(motion, |_| *system), 2.0 * STAGES as f64);
    println!("S = {STAGES}: order {order:.2}");
    // The few steps of the high orders are not all that small.
    assert!((order - expected).abs() <= 0.1 * expected, "S = {STAGES}: order {order:.3}");
}

macro_rules! order_2s {
    ($($name:ident: $system:expr, $q:expr, $v:expr, $unit:expr, $($s:literal)*;)*) => {$(
        #[test]
            fn $name() {
            let motion = Motion::new(&$system, [$q, $v], $unit);
            $(has_order::<_, _, $s>(&$system, &motion);)*
        }
    )*};
}
// The high orders show on long motions alone: on short ones, errors above rounding need steps that are not
// small.
order_2s! {
    bead_with_mass_and_friction_that_depend_on_q: Bead::EXAMPLE, [0.8], [1.3], 2.0, 1 2 3 4;
    bead_for_long: Bead { r: 0.01, c: 0.02, ..Bead::EXAMPLE }, [0.3], [0.5], 20.0, 1 2 3 4 5 6;
    double_pendulum: DoublePendulum::EXAMPLE, [1.1, -0.6], [0.3, 1.2], 2.0, 1 2 3 4;
    double_pendulum_for_long: DoublePendulum { r: [0.01, 0.02], ..DoublePendulum::EXAMPLE }, [0.5, -0.3], [0.2, 0.4], 20.0, 2 3 4 5;
    charge_with_friction_and_general_force: Charge::EXAMPLE, [0.9, -0.4, 0.6], [0.2, 1.1, -0.7], 2.0, 1 2 3 4 5 6;
    follower_with_general_force_alone: Follower::EXAMPLE, [0.6, -0.9], [0.8, 0.5], 2.0, 1 2 3 4;
}

/// Positive control: the charge with a force that is off by h⁴ times itself, as a wrong quadrature would make
/// it.
struct Altered {
    share: f64,
}

impl Lagrangian<3> for Altered {
    type Scalar = f64;

    fn lagrangian(&self, q: &SVector<f64, 3>, v: &SVector<f64, 3>) -> f64 {
        Lagrangian::lagrangian(&Charge::EXAMPLE, q, v)
    }

    fn lagrangian_derivatives(&self, q: &SVector<f64, 3>, v: &SVector<f64, 3>) -> Derivatives<f64, 3> {
        Charge::EXAMPLE.lagrangian_derivatives(q, v)
    }
}

impl ActingForce<3> for Altered {
    const HAS_FORCE: bool = true;

    fn general_force_derivatives(
        &self,
        q: &SVector<f64, 3>,
        v: &SVector<f64, 3>,
    ) -> CovectorDerivatives<f64, 3> {
        Charge::EXAMPLE.acting_force_derivatives(q, v) * (1.0 + self.share)
    }
}

impl ForcedLagrangian<3> for Altered {
    type Anchors<const S: usize> = ();
}

#[test]
fn a_force_that_is_off_by_the_fourth_power_of_h_leaves_order_4() {
    let (q, v) = ([0.9, -0.4, 0.6], [0.2, 1.1, -0.7]);
    let altered = |h: f64| Altered { share: h.powi(4) };
    let order = order::<_, 3, 3>(&Motion::new(&Charge::EXAMPLE, [q, v], 2.0), altered);
    assert!((order - 4.0).abs() < 0.2, "{order}");
}
