//! Declarations that the header of a system with constraints has besides.

use core::fmt::{self, Display};

use super::{Header, Time};
use crate::Status;

/// The type that such headers share.
const SHARED: &str = include_str!("../constrained.h");

impl Header {
    /// The function that begins a run, in words.
    pub(super) fn start(&self) -> &'static str {
        if self.constraints == 0 {
            "Begins a run at configuration q and velocity v, with step size h."
        } else {
            "Begins a run at configuration q and velocity v, which are on all constraints, with step size h."
        }
    }

    /// Statuses of constraints, once in a program: by macros, so that the enumeration is the same everywhere.
    pub(super) fn shared_on_constraints(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.constraints == 0 {
            return Ok(());
        }
        let mut all = Status::ALL.iter().filter(|status| status.is_of_constraints());
        writeln!(f, "#ifndef {}", Status::OffConstraint.name())?;
        f.write_str("/* How calls of a system with constraints end besides. */\n")?;
        all.try_for_each(|status| {
            let (name, number) = (status.name(), *status as i32);
            writeln!(f, "#define {name} ((dalembert_status){number}) /**< {status} */")
        })?;
        write!(f, "\n{SHARED}#endif\n\n")
    }

    pub(super) fn functions_on_constraints(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { prefix, scalar, coordinates: n, constraints: m, .. } = *self;
        let time = Time(self);
        if m == 0 {
            return Ok(());
        }
        writeln!(
            f,
            "/** The first constraint that (q, v) violates by more than rounding, and by how much: why init refuses them. */\n\
             dalembert_status {prefix}_violation(const {prefix}_parameters *parameters{time}, const {scalar} q[{n}], const {scalar} v[{n}],\n    \
             dalembert_violation *violation);\n\n\
             /** The configuration and velocity on all constraints that are nearest to (q, v), in the metric of the mass: what init takes. */\n\
             dalembert_status {prefix}_nearest(const {prefix}_parameters *parameters{time}, const {scalar} q[{n}], const {scalar} v[{n}],\n    \
             {scalar} nearest_q[{n}], {scalar} nearest_v[{n}]);\n\n\
             /**\n * The multipliers of the last step, one for each constraint: its force on coordinate i is lambda times the derivative of the\n \
             * constraint by q[i]. In N where the constraint is a length, in N m where it is an angle.\n */\n\
             dalembert_status {prefix}_reactions(const {prefix}_memory *memory, {scalar} lambda[{m}]);\n"
        )
    }
}

/// The functions of constraints in C++, where there are some.
pub(super) struct OnConstraints<'a>(pub(super) &'a Header);

impl Display for OnConstraints<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Header { prefix, scalar, constraints: m, takes_time, .. } = *self.0;
        let (time, t) = (Time(self.0), if takes_time { ", t" } else { "" });
        if m == 0 {
            return Ok(());
        }
        write!(
            f,
            r"    [[nodiscard]] static dalembert_status violation(const {prefix}_parameters &parameters{time}, const vector &q, const vector &v, dalembert_violation &violation) noexcept
    {{
        return {prefix}_violation(&parameters{t}, q.data(), v.data(), &violation);
    }}
    [[nodiscard]] static dalembert_status nearest(const {prefix}_parameters &parameters{time}, const vector &q, const vector &v, vector &nearest_q, vector &nearest_v) noexcept
    {{
        return {prefix}_nearest(&parameters{t}, q.data(), v.data(), nearest_q.data(), nearest_v.data());
    }}
    [[nodiscard]] dalembert_status reactions(std::array<{scalar}, {m}> &lambda) const noexcept {{ return {prefix}_reactions(&memory_, lambda.data()); }}
"
        )
    }
}
