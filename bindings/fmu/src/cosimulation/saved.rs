//! The state of an instance as bytes, the same on every machine: words of eight bytes, little-endian.
//!
//! The solver's memory of earlier steps is left out, so that a state read back goes on within rounding.

use dalembert::State;
use dalembert::run::{Checkpoint, DrivenTrajectory};
use dalembert::system::Scalar;
use dalembert_face::{Described, Fields, Interface, Number};

use super::CoSimulation;
use crate::refusal::{Mode, Refusal};
use crate::variables::Place;

/// The state of an instance.
pub fn bytes<I: Interface<N>, const N: usize>(of: &CoSimulation<I, N>) -> Vec<u8> {
    let mut words = vec![of.unit.layout, of.mode as u64, of.start_time.to_bits()];
    let mut scalar = |value: I::Scalar| words.push(value.widen().to_bits());
    scalar(of.step_size);
    of.input.iter().chain(of.start.as_flattened()).for_each(|&value| scalar(value));
    for (field, index, _) in parameters(of) {
        words.push(of.given.entry(field, index).map_or(0, bits));
    }
    if let Some(run) = &of.run {
        let Checkpoint { state, step_size, origin, steps } = run.present();
        words.extend([step_size.widen().to_bits(), origin.to_bits(), steps]);
        words.extend(state.q.iter().chain(&state.p).map(|value| value.widen().to_bits()));
        if I::System::CONSTRAINTS > 0 {
            words.push(of.reactions.len() as u64);
            words.extend(of.reactions.iter().map(|value| value.widen().to_bits()));
        }
    }
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

/// The instance with the state of these bytes.
pub fn read<I: Interface<N>, const N: usize>(
    like: &CoSimulation<I, N>,
    bytes: &[u8],
) -> Result<CoSimulation<I, N>, Refusal> {
    let (words, rest) = bytes.as_chunks::<8>();
    let mut words = words.iter().map(|word| u64::from_le_bytes(*word));
    let mut next = || words.next().ok_or(Refusal::Bytes);
    if next()? != like.unit.layout || !rest.is_empty() {
        return Err(Refusal::Bytes);
    }
    let mut read = like.clone();
    (read.run, read.last, read.reactions) = (None, None, Vec::new());
    read.mode = match next()? {
        0 => Mode::Instantiated,
        1 => Mode::Initialization,
        2 => Mode::Step,
        3 => Mode::Terminated,
        _ => return Err(Refusal::Bytes),
    };
    let finite =
        |bits: u64| Some(f64::from_bits(bits)).filter(|value| value.is_finite()).ok_or(Refusal::Bytes);
    read.start_time = finite(next()?)?;
    let scalar = |bits: u64| finite(bits).map(I::Scalar::constant);
    read.step_size = scalar(next()?)?;
    for value in read.input.iter_mut().chain(read.start.as_flattened_mut()) {
        *value = scalar(next()?)?;
    }
    for (field, index, start) in parameters(like) {
        read.change_parameter(field, index, of_bits(start, next()?));
    }
    read.make_tables(like);
    let is_wrong = read.wrong.is_some() && matches!(read.mode, Mode::Step | Mode::Terminated);
    if is_wrong || read.given.has_nan() || read.step_size.widen() <= 0.0 {
        return Err(Refusal::Bytes);
    }
    if matches!(read.mode, Mode::Step | Mode::Terminated) {
        let (step_size, origin, steps) = (scalar(next()?)?, finite(next()?)?, next()?);
        let mut state = State { q: read.start[0].into(), p: read.start[1].into() };
        for value in state.q.iter_mut().chain(state.p.iter_mut()) {
            *value = scalar(next()?)?;
        }
        read.run = Some(DrivenTrajectory::resume(Checkpoint { state, step_size, origin, steps }));
        let length = if I::System::CONSTRAINTS > 0 { next()? } else { 0 };
        if length != 0 && length != I::System::CONSTRAINTS as u64 {
            return Err(Refusal::Bytes);
        }
        read.reactions = (0..length).map(|_| scalar(next()?)).collect::<Result<_, _>>()?;
    }
    if next().is_ok() { Err(Refusal::Bytes) } else { Ok(read) }
}

/// Field, index and a number of its type, of each parameter.
fn parameters<I: Interface<N>, const N: usize>(
    of: &CoSimulation<I, N>,
) -> impl Iterator<Item = (usize, usize, Number)> + '_ {
    of.variables.iter().filter_map(|variable| match variable.place {
        Place::Parameter { field, index } => Some((field, index, variable.start)),
        _ => None,
    })
}

/// The bits of a number; integers of fewer than eight bytes with their sign.
fn bits(number: Number) -> u64 {
    match number {
        Number::F64(value) => value.to_bits(),
        Number::F32(value) => value.to_bits().into(),
        Number::I8(value) => value as u64,
        Number::I16(value) => value as u64,
        Number::I32(value) => value as u64,
        Number::I64(value) => value as u64,
        Number::U8(value) => value.into(),
        Number::U16(value) => value.into(),
        Number::U32(value) => value.into(),
        Number::U64(value) => value,
    }
}

/// The number with these bits, of the type of `like`.
fn of_bits(like: Number, bits: u64) -> Number {
    match like {
        Number::F64(_) => Number::F64(f64::from_bits(bits)),
        Number::F32(_) => Number::F32(f32::from_bits(bits as u32)),
        Number::I8(_) => Number::I8(bits as i8),
        Number::I16(_) => Number::I16(bits as i16),
        Number::I32(_) => Number::I32(bits as i32),
        Number::I64(_) => Number::I64(bits as i64),
        Number::U8(_) => Number::U8(bits as u8),
        Number::U16(_) => Number::U16(bits as u16),
        Number::U32(_) => Number::U32(bits as u32),
        Number::U64(_) => Number::U64(bits),
    }
}
