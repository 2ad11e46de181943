//! The class that the header has for C++.

use core::fmt::{self, Display};

use super::constrained::OnConstraints;
use super::tables::OnTables;
use super::{Given, Header, Time};

impl Header {
    /// A class for C++, which does no more than hold the memory and name its system once.
    pub(super) fn wrapper(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { prefix, scalar, coordinates: n, .. } = *self;
        let (given, passed) = (Given(self), Passed(self));
        writeln!(
            f,
            r"#ifdef __cplusplus
#include <array>

/** {prefix} in C++17: a run that holds its memory. Copies are runs of their own. */
class {prefix}_run {{
public:
    using vector = std::array<{scalar}, {n}>;

    /** Begins a run; the state is unusable unless this returns DALEMBERT_OK. */
    [[nodiscard]] dalembert_status init(const {prefix}_parameters &parameters, {scalar} h{time}, const vector &q, const vector &v) noexcept
    {{
        return {prefix}_init(&memory_, &parameters, h{t}, q.data(), v.data());
    }}
    [[nodiscard]] dalembert_status step({given_first}dalembert_report *report = nullptr) noexcept
    {{
        return {prefix}_step(&memory_{passed}, report);
    }}
    [[nodiscard]] dalembert_status step({given_first}{prefix}_linearized &linearized, dalembert_report *report = nullptr) noexcept
    {{
        return {prefix}_step_linearized(&memory_{passed}, report, &linearized);
    }}
    [[nodiscard]] dalembert_status state(vector &q, vector &p) const noexcept {{ return {prefix}_state(&memory_, q.data(), p.data()); }}
    [[nodiscard]] dalembert_status velocity({time_first}vector &v) const noexcept {{ return {prefix}_velocity(&memory_{t}, v.data()); }}
    [[nodiscard]] dalembert_status energy({time_first}{scalar} &energy) const noexcept {{ return {prefix}_energy(&memory_{t}, &energy); }}
    [[nodiscard]] dalembert_status time(double &time) const noexcept {{ return {prefix}_time(&memory_, &time); }}
    [[nodiscard]] dalembert_status state_after({given_first}{scalar} after, vector &q, vector &p) const noexcept
    {{
        return {prefix}_state_after(&memory_{passed}, after, q.data(), p.data());
    }}
    [[nodiscard]] dalembert_status set_state(const vector &q, const vector &p) noexcept
    {{
        return {prefix}_set_state(&memory_, q.data(), p.data());
    }}
    [[nodiscard]] dalembert_status set_parameters(const {prefix}_parameters &parameters) noexcept
    {{
        return {prefix}_set_parameters(&memory_, &parameters);
    }}
    [[nodiscard]] dalembert_status set_step_size({scalar} h) noexcept {{ return {prefix}_set_step_size(&memory_, h); }}
{on_constraints}{on_tables}
private:
    {prefix}_memory memory_{{}};
}};
#endif
",
            given_first = GivenFirst(given),
            on_constraints = OnConstraints(self),
            on_tables = OnTables(self),
            time = Time(self),
            time_first = TimeFirst(self),
            t = if self.takes_time { ", t" } else { "" },
        )
    }
}

/// [`Given`] in C++, ended by a comma.
struct GivenFirst<'a>(Given<'a>);

impl Display for GivenFirst<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Given(header) = self.0;
        if header.inputs > 0 {
            write!(f, "const std::array<{}, {}> &u, ", header.scalar, header.inputs)?;
        }
        TimeFirst(header).fmt(f)
    }
}

/// `double t, `, where the system takes the time.
struct TimeFirst<'a>(&'a Header);

impl Display for TimeFirst<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.takes_time { write!(f, "{} t, ", self.0.scalar) } else { Ok(()) }
    }
}

/// The arguments that C++ passes on to C.
struct Passed<'a>(&'a Header);

impl Display for Passed<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.0.inputs > 0 { ", u.data()" } else { "" })?;
        f.write_str(if self.0.takes_time { ", t" } else { "" })
    }
}
