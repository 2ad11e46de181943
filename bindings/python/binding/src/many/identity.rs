//! Hashes by which parts of an ensemble are told from those of others.

use std::panic::{AssertUnwindSafe, catch_unwind};

use dalembert::nalgebra::SVector;
use dalembert::system::sampled_forces;
use dalembert_face::{Described, Fields, Number};
use twox_hash::XxHash3_128;

use super::Asked;
use crate::system::System;

/// States at which a model is asked for its forces.
const STATES: usize = 2048;

/// The hash that tells a model from one that was edited, whatever its fields and members: of its forces with
/// fields and inputs that are always these.
pub fn model<S: System<N>, const N: usize>() -> String {
    let mut given = S::Fields::ZERO.given();
    let mut number = 0.7;
    for (field, about) in S::Fields::FIELDS.iter().enumerate() {
        let entries: usize = about.dimensions.iter().product();
        // Of a table the y alone: its x stay in order.
        for index in if about.is_table { entries / 2 } else { 0 }..entries {
            let Some(zero) = given.entry(field, index) else { break };
            // No two alike.
            number = (number + 0.618_033_988_749_894_9) % 1.0;
            given.change_entry(field, index, one_like(zero, 0.5 + number));
        }
    }
    let fields = S::Fields::of(&given).unwrap_or(S::Fields::ZERO);
    let inputs: Vec<f64> = (0..S::Fields::INPUTS).map(|k| 0.3 / (1.0 + k as f64)).collect();
    let mut hash = XxHash3_128::new();
    let asked = catch_unwind(AssertUnwindSafe(|| {
        let (q, v) = (SVector::repeat(0.1), SVector::repeat(0.2));
        let system = S::view(&fields, &inputs, 0.0);
        sampled_forces(&system, (&q, &v), 1, STATES).for_each(|force| hash.write(&force.to_le_bytes()));
    }));
    asked.map_or_else(|_| "panics".to_owned(), |()| format!("{:032x}", hash.finish_128()))
}

/// A number of the type of another: 1 where that is a whole one.
fn one_like(like: Number, value: f64) -> Number {
    match like {
        Number::F64(_) => Number::F64(value),
        Number::F32(_) => Number::F32(value as f32),
        Number::I8(_) => Number::I8(1),
        Number::I16(_) => Number::I16(1),
        Number::I32(_) => Number::I32(1),
        Number::I64(_) => Number::I64(1),
        Number::U8(_) => Number::U8(1),
        Number::U16(_) => Number::U16(1),
        Number::U32(_) => Number::U32(1),
        Number::U64(_) => Number::U64(1),
    }
}

/// The hash that tells a member from others: of its fields, start and input.
pub fn digest<F: Fields>(fields: &[F], asked: &Asked<'_>, member: usize) -> u128 {
    let mut hash = XxHash3_128::new();
    hash.write(&[u8::from(asked.is_velocity)]);
    hash.write(&asked.time.to_le_bytes());
    let fields = &fields[if fields.len() == 1 { 0 } else { member }];
    for field in 0..F::FIELDS.len() {
        for entry in (0..).map_while(|index| fields.entry(field, index)) {
            hash.write(&bytes(entry));
        }
    }
    for row in [asked.q, asked.other, asked.inputs] {
        row.of(member).iter().for_each(|number| hash.write(&number.to_le_bytes()));
    }
    hash.finish_128()
}

fn bytes(number: Number) -> [u8; 8] {
    match number {
        Number::F64(value) => value.to_le_bytes(),
        Number::F32(value) => f64::from(value).to_le_bytes(),
        Number::I8(value) => i64::from(value).to_le_bytes(),
        Number::I16(value) => i64::from(value).to_le_bytes(),
        Number::I32(value) => i64::from(value).to_le_bytes(),
        Number::I64(value) => value.to_le_bytes(),
        Number::U8(value) => u64::from(value).to_le_bytes(),
        Number::U16(value) => u64::from(value).to_le_bytes(),
        Number::U32(value) => u64::from(value).to_le_bytes(),
        Number::U64(value) => value.to_le_bytes(),
    }
}
