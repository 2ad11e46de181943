//! The values of L, R and f as generated are those of the functions as written, bit by bit, at whatever
//! optimisation level the two are compiled: `--config 'profile.test.package.dalembert-tests.opt-level=0'` and
//! the like.

use dalembert::Lagrangian;
use dalembert::system::GeneratedDiffers;
use nalgebra::SVector;

use super::{Spread, expanded, generator};

/// `verify_generated` at a point: q, v and the coefficients.
type Verify = fn(&[f64]) -> Result<(), GeneratedDiffers>;

macro_rules! verify {
    ($name:ident, $n:literal, [$($rayleigh:ident)?], [$($force:ident)?]) => {
        ($n, |at| {
            let system = expanded::$name { c: std::array::from_fn(|k| at[2 * $n + k]) };
            system.verify_generated(&SVector::from_fn(|i, _| at[i]), &SVector::from_fn(|i, _| at[$n + i]))
        })
    };
}

fn every_verification() -> [(usize, Verify); generator::SYSTEMS] {
    every_system!(verify)
}

/// Numbers at which operations are special.
const SPECIAL: [f64; 16] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    -2.0,
    1e-300,
    -1e-300,
    1e300,
    -1e300,
    5e-324,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
    f64::MIN_POSITIVE,
    -0.75,
];

#[test]
fn generated_values_are_those_written_to_the_bit() {
    let mut tried = 0;
    for (index, (n, verify)) in every_verification().into_iter().enumerate() {
        let mut random = Spread(1000 + index as u64);
        for round in 0..400 {
            let mut point = random.point(n);
            if round >= 100 {
                // One to all of q, v and the coefficients at special values.
                let share = 0.25 * f64::from(1 + round % 4);
                for x in &mut point {
                    if random.next() < share {
                        *x = SPECIAL[(random.next() * SPECIAL.len() as f64) as usize];
                    }
                }
            }
            let verdict = verify(&point);
            assert!(verdict.is_ok(), "System{index} at {point:?}: {verdict:?}");
            tried += 1;
        }
    }
    println!("{tried} points of {} systems", generator::SYSTEMS);
}
