//! A unit, as `fmu!` states it.

use dalembert_face::{Described, Field, Fields, Interface, layout};

/// A system with its step size and start, as a unit.
///
/// [`fmu!`](crate::fmu) makes it.
pub struct Unit<I: Interface<N>, const N: usize> {
    pub(crate) name: &'static str,
    pub(crate) rule: &'static str,
    pub(crate) layout: u64,
    pub(crate) library: &'static str,
    pub(crate) step_size: I::Scalar,
    pub(crate) parameters: I::System,
    /// (q, v).
    pub(crate) start: [[I::Scalar; N]; 2],
}

/// The names that are not left for fields.
const TAKEN: [&str; 7] = ["time", "step_size", "u", "q", "v", "p", "energy"];

impl<I: Interface<N>, const N: usize> Unit<I, N> {
    /// The unit of a system in the library of this name. It does not compile where a field has the name of
    /// another variable.
    #[doc(hidden)]
    pub const fn new(
        [name, rule]: [&'static str; 2],
        library: &'static str,
        step_size: I::Scalar,
        parameters: I::System,
        start: [[I::Scalar; N]; 2],
    ) -> Self {
        let fields: &[Field] = I::System::FIELDS;
        let mut i = 0;
        while i < fields.len() {
            let mut j = 0;
            while j < TAKEN.len() {
                assert!(
                    !equal(fields[i].name, TAKEN[j]),
                    "a field has the name of another variable of the unit: time, step_size, u, q, v, p or energy"
                );
                j += 1;
            }
            let of_constraints = I::System::CONSTRAINTS > 0 && equal(fields[i].name, "lambda");
            assert!(!of_constraints, "a field has the name of the reactions of constraints, lambda");
            let of_outputs = I::System::OUTPUTS > 0 && equal(fields[i].name, "y");
            assert!(!of_outputs, "a field has the name of the outputs, y");
            i += 1;
        }
        let layout = layout::<I::System, N>(name, rule);
        Self { name, rule, layout, library, step_size, parameters, start }
    }

    /// The token by which an importer shows that it has read the description of this unit.
    #[must_use]
    pub fn token(&self) -> String {
        format!("dalembert-{}-{:016x}", env!("CARGO_PKG_VERSION"), self.layout)
    }
}

const fn equal(one: &str, other: &str) -> bool {
    let (one, other) = (one.as_bytes(), other.as_bytes());
    let mut i = 0;
    while i < one.len() && i < other.len() && one[i] == other[i] {
        i += 1;
    }
    i == one.len() && i == other.len()
}
