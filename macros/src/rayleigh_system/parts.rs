//! The functions of a block that the attribute knows by their names. One entry holds all that the macro knows
//! of a function's signature; the others read it.

/// A function that the attribute knows.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Part {
    Lagrangian,
    Rayleigh,
    Force,
    TimeScale,
    Constraints,
    VelocityConstraints,
    Events,
    Outputs,
}

/// A choice of the arguments that there are, which stand in this order.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub struct Arguments {
    pub q: bool,
    pub v: bool,
    pub u: bool,
    pub t: bool,
}

impl Arguments {
    const Q: Self = Self { q: true, v: false, u: false, t: false };
    const V: Self = Self { q: false, v: true, ..Self::Q };
    const Q_T: Self = Self { t: true, ..Self::Q };
    const Q_V: Self = Self { v: true, ..Self::Q };
    const Q_V_T: Self = Self { t: true, ..Self::Q_V };
    const Q_V_U_T: Self = Self { u: true, ..Self::Q_V_T };

    /// Whether so many can stand after q and v.
    pub fn has_after(self, count: usize) -> bool {
        count <= usize::from(self.u) + usize::from(self.t)
    }

    /// The ones of `of` that are chosen: what belongs to q, v, u and t.
    pub fn choose<T>(self, of: [T; 4]) -> impl Iterator<Item = T> {
        let chosen = [self.q, self.v, self.u, self.t];
        of.into_iter().zip(chosen).filter_map(|(of, is_chosen)| is_chosen.then_some(of))
    }
}

/// The kind of a function's result.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Returns {
    Number,
    /// A covector at q, with N entries.
    Covector,
    /// Numbers, as many as its type says.
    Numbers,
}

/// All that the macro knows of a function's signature.
pub struct Entry {
    /// Its name in the block.
    pub name: &'static str,
    /// The arguments that it takes in any case.
    pub takes: Arguments,
    /// All the arguments that it may take.
    pub may_take: Arguments,
    pub returns: Returns,
    /// Its parameters, in words.
    pub parameters: &'static str,
    /// Whether it is a term of the equations of motion.
    pub is_term: bool,
    /// Whether its body is differentiated: of others the values are asked for alone.
    pub is_differentiated: bool,
}

impl Part {
    /// In the order in which their signatures are checked and their bodies lowered.
    pub const ALL: [Self; 8] = [
        Self::Lagrangian,
        Self::Rayleigh,
        Self::Force,
        Self::TimeScale,
        Self::Constraints,
        Self::VelocityConstraints,
        Self::Events,
        Self::Outputs,
    ];

    /// Constraints, in the order of their rows.
    pub const CONSTRAINTS: [Self; 2] = [Self::Constraints, Self::VelocityConstraints];

    /// Functions whose values are asked for as the user wrote them.
    pub const VALUES: [Self; 2] = [Self::Events, Self::Outputs];

    /// The name of the function.
    pub fn name(self) -> &'static str {
        self.entry().name
    }

    /// All that is known of it.
    pub fn entry(self) -> Entry {
        match self {
            Self::Lagrangian => Entry {
                name: "lagrangian",
                takes: Arguments::Q_V,
                may_take: Arguments::Q_V_T,
                returns: Returns::Number,
                parameters: "`(&self, q: [f64; N], v: [f64; N])`, and `t: f64` after them if it depends on time",
                is_term: true,
                is_differentiated: true,
            },
            Self::Rayleigh => Entry {
                name: "rayleigh",
                takes: Arguments::V,
                may_take: Arguments::Q_V_T,
                returns: Returns::Number,
                parameters: "`(&self, v: [f64; N])` or `(&self, q: [f64; N], v: [f64; N])`, and `t: f64` after them if it depends on time",
                is_term: true,
                is_differentiated: true,
            },
            Self::Force => Entry {
                name: "force",
                takes: Arguments::Q_V,
                may_take: Arguments::Q_V_U_T,
                returns: Returns::Covector,
                parameters: "`(&self, q: [f64; N], v: [f64; N])`, and after them an input `u: [f64; M]`, a time `t: f64` or both",
                is_term: true,
                is_differentiated: true,
            },
            Self::TimeScale => Entry {
                name: "time_scale",
                takes: Arguments::Q,
                may_take: Arguments::Q,
                returns: Returns::Number,
                parameters: "`(&self, q: [f64; N])` alone: steps follow the configuration",
                is_term: false,
                is_differentiated: true,
            },
            Self::Constraints => Entry {
                name: "constraints",
                takes: Arguments::Q,
                may_take: Arguments::Q_T,
                returns: Returns::Numbers,
                parameters: "`(&self, q: [f64; N])`, and `t: f64` after it if they depend on time; `velocity_constraints` hold v",
                is_term: false,
                is_differentiated: true,
            },
            Self::VelocityConstraints => Entry {
                name: "velocity_constraints",
                takes: Arguments::Q_V,
                may_take: Arguments::Q_V_T,
                returns: Returns::Numbers,
                parameters: "`(&self, q: [f64; N], v: [f64; N])`, and `t: f64` after them if they depend on time",
                is_term: false,
                is_differentiated: true,
            },
            Self::Events => Entry {
                name: "events",
                takes: Arguments::Q_V,
                may_take: Arguments::Q_V_T,
                returns: Returns::Numbers,
                parameters: "`(&self, q: [f64; N], v: [f64; N])`, and `t: f64` after them if they depend on time",
                is_term: false,
                is_differentiated: false,
            },
            Self::Outputs => Entry {
                name: "outputs",
                takes: Arguments::Q_V,
                may_take: Arguments::Q_V_U_T,
                returns: Returns::Numbers,
                parameters: "`(&self, q: [f64; N], v: [f64; N])`, and after them the input `u: [f64; M]`, a time `t: f64` or both",
                is_term: false,
                is_differentiated: false,
            },
        }
    }
}
