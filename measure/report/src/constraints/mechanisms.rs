//! The mechanisms: what is stepped, what peers integrate, and what is looked at along the motion.

use anyhow::Result;
use dalembert::nalgebra::SVector;
use dalembert::system::Constrained;
use dalembert_scenes::four_bar::{FourBar, Redundant};

use super::reduced::{OnBars, OnRods, OnSphere};
use super::systems::{self, SphericalPendulum, TwoRods};
use super::{Horizon, Record};
use crate::peers::python::Python;

/// A mechanism in N coordinates.
pub struct Mechanism<S, A, const N: usize> {
    pub name: &'static str,
    /// The name of its motion in `references.txt`.
    pub motion: &'static str,
    pub system: S,
    /// Its accelerations, stabilised at this rate.
    pub reduced: fn(f64) -> A,
    /// The distances off the constraints, the largest.
    pub off: fn(&[f64; N]) -> f64,
    /// A momentum that friction alone changes, and its rate of decay, 1/s.
    pub momentum: Option<(Momentum<N>, f64)>,
}

/// A momentum of (q, v).
pub type Momentum<const N: usize> = fn(&[f64; N], &[f64; N]) -> f64;

const DRAG: f64 = 1e-3;

// Without a motor.
static WITHOUT_FRICTION: FourBar = FourBar { friction: 0.0 };
static WITH_FRICTION: FourBar = FourBar { friction: 5e-6 };
static ONCE_MORE: Redundant = Redundant { friction: 0.0 };

/// Measures all over one time, and hands what there is to `keep` after each.
///
/// # Errors
/// A reference is missing.
pub fn all(
    horizon: Horizon,
    python: &Python,
    records: &mut Vec<Record>,
    keep: impl Fn(&[Record]) -> Result<()>,
) -> Result<()> {
    macro_rules! sphere {
        ($name:literal, $drag:expr) => {
            let pendulum = Mechanism {
                name: $name,
                motion: $name,
                system: SphericalPendulum { drag: $drag },
                reduced: |alpha| OnSphere { drag: $drag, alpha },
                off: |q| (q[0].hypot(q[1]).hypot(q[2]) - 1.0).abs(),
                momentum: Some((|q, v| q[0] * v[1] - q[1] * v[0], $drag)),
            };
            pendulum.measure::<6>(horizon, python, records)?;
            keep(records)?;
        };
    }
    sphere!("spherical pendulum", 0.0);
    sphere!("spherical pendulum, drag", DRAG);
    let rods = Mechanism {
        name: "two rods",
        motion: "two rods",
        system: TwoRods {},
        reduced: |alpha| OnRods { alpha },
        off: |q| {
            let first = q[0].hypot(q[1]) - systems::LENGTHS[0];
            let second = (q[2] - q[0]).hypot(q[3] - q[1]) - systems::LENGTHS[1];
            first.abs().max(second.abs())
        },
        momentum: None,
    };
    rods.measure::<8>(horizon, python, records)?;
    keep(records)?;
    macro_rules! bars {
        ($name:literal, $motion:literal, $linkage:ident, $count:literal) => {
            let bars = Mechanism {
                name: $name,
                motion: $motion,
                system: $linkage.driven([0.0]),
                reduced: |alpha| OnBars::<$count> { friction: $linkage.friction, alpha },
                off: |q| {
                    let off: SVector<f64, $count> = $linkage.driven([0.0]).constraints(&(*q).into());
                    off.amax()
                },
                momentum: None,
            };
            bars.measure::<18>(horizon, python, records)?;
            keep(records)?;
        };
    }
    bars!("four-bar", "four-bar", WITHOUT_FRICTION, 8);
    bars!("four-bar, friction", "four-bar, friction", WITH_FRICTION, 8);
    bars!("four-bar, nine constraints", "four-bar", ONCE_MORE, 9);
    Ok(())
}
