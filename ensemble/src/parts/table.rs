//! The rows of a part, column by column.

use dalembert::nalgebra::SVector;
use dalembert::system::Scalar;
use dalembert::{Lagrangian, State};

use crate::member::caught;

/// A column's name, and its value of a member's number and system.
pub(super) type Column<'s, L> = (String, Box<dyn Fn(u64, &L) -> f64 + Sync + 's>);

/// One row.
#[derive(Clone, Debug)]
pub(super) struct Row<const N: usize> {
    pub(super) number: u64,
    /// Of no columns where there is no system.
    pub(super) fields: Vec<f64>,
    pub(super) time: Option<f64>,
    pub(super) state: Option<[SVector<f64, N>; 2]>,
    pub(super) energy: Option<f64>,
    /// The event function that vanishes there.
    pub(super) event: Option<usize>,
    pub(super) error: Option<String>,
}

impl<const N: usize> Row<N> {
    pub(super) fn of<L: Lagrangian<N>>(
        number: u64,
        system: &L,
        columns: &[Column<'_, L>],
        time: f64,
        state: &State<L::Scalar, N>,
    ) -> Self {
        let widened = |vector: &SVector<L::Scalar, N>| vector.map(Scalar::widen);
        let energy = |system: &L| state.energy(system);
        Self {
            number,
            fields: columns.iter().map(|(_, value)| value(number, system)).collect(),
            time: Some(time),
            state: Some([widened(&state.q), widened(&state.p)]),
            // Of a member that panics there is none.
            energy: caught(|| system.later(Scalar::constant(time), energy))
                .ok()
                .and_then(Result::ok)
                .map(Scalar::widen),
            event: None,
            error: None,
        }
    }

    pub(super) fn without_start(number: u64) -> Self {
        let fields = Vec::new();
        Self { number, fields, time: None, state: None, energy: None, event: None, error: None }
    }
}

/// Numbers that may be missing: the values that there are, and 1 or 0 for each row.
#[derive(Clone, Debug, Default)]
pub(super) struct Numbers {
    pub(super) name: String,
    pub(super) values: Vec<f64>,
    pub(super) present: Vec<i16>,
}

impl Numbers {
    fn push(&mut self, value: Option<f64>) {
        self.present.push(i16::from(value.is_some()));
        self.values.extend(value);
    }
}

/// All rows.
pub(super) struct Table {
    pub(super) members: Vec<i64>,
    /// The fields, t, q, p, energy.
    pub(super) numbers: Vec<Numbers>,
    /// The event functions that vanish, of members that are watched.
    pub(super) events: Option<Vec<Option<i32>>>,
    pub(super) errors: Vec<Option<String>>,
    fields: usize,
}

impl Table {
    pub(super) fn new(fields: &[&str], coordinates: usize, has_events: bool) -> Self {
        let of = |symbol: char| (0..coordinates).map(move |i| format!("{symbol}{i}"));
        let names = fields.iter().map(|name| (*name).to_owned());
        let names = names.chain(["t".to_owned()]).chain(of('q')).chain(of('p')).chain(["energy".to_owned()]);
        let numbers = names.map(|name| Numbers { name, ..Numbers::default() }).collect();
        let events = has_events.then(Vec::new);
        Self { members: Vec::new(), numbers, events, errors: Vec::new(), fields: fields.len() }
    }

    pub(super) fn push<const N: usize>(&mut self, row: Row<N>) {
        self.members.push(row.number.cast_signed());
        let fields = (0..self.fields).map(|i| row.fields.get(i).copied());
        let coordinates = (0..2 * N).map(|i| row.state.as_ref().map(|state| state[i / N][i % N]));
        let values = fields.chain([row.time]).chain(coordinates).chain([row.energy]);
        self.numbers.iter_mut().zip(values).for_each(|(column, value)| column.push(value));
        if let Some(events) = &mut self.events {
            events.push(row.event.and_then(|event| i32::try_from(event).ok()));
        }
        self.errors.push(row.error);
    }

    /// Puts the rows of `other` behind these.
    pub(super) fn append(&mut self, mut other: Self) {
        self.members.append(&mut other.members);
        self.errors.append(&mut other.errors);
        if let (Some(events), Some(more)) = (&mut self.events, &mut other.events) {
            events.append(more);
        }
        for (column, more) in self.numbers.iter_mut().zip(&mut other.numbers) {
            column.values.append(&mut more.values);
            column.present.append(&mut more.present);
        }
    }
}
