//! The methods that an error is asked of: one entry holds all that a choice knows of one.

use core::fmt;

use nalgebra::ComplexField;

/// All that a choice knows of a method before it tries it.
struct Entry {
    /// Its name in messages.
    name: &'static str,
    order: u32,
    /// The evaluations of a step.
    work: Work,
    /// Roundings of q in a step.
    roundings: f64,
    /// The error by radian of an oscillator is `error` (hω)^order, for hω up to `longest`.
    error: f64,
    longest: f64,
}

/// The evaluations of a step, where equations are solved in few iterations.
#[derive(Clone, Copy)]
enum Work {
    /// Of a rule, so many times.
    Substeps(f64),
    /// A kick is one.
    Kicks(f64),
    /// Of the stages of a Gauss method; they show what a step does not resolve.
    Stages(f64),
}

/// Declares the methods, one entry each.
macro_rules! methods {
    ($($(#[$doc:meta])* $method:ident { $name:literal, $($field:ident: $value:expr),* })*) => {
        /// A method of constant step: a self-adjoint rule of order 2, alone or composed, a splitting, or a
        /// Gauss method.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[non_exhaustive]
        pub enum Method {
            $($(#[$doc])* $method,)*
        }

        impl Method {
            /// All of them.
            pub const ALL: [Self; [$($name),*].len()] = [$(Self::$method),*];

            const fn entry(self) -> Entry {
                match self {
                    $(Self::$method => Entry { name: $name, $($field: $value),* },)*
                }
            }
        }
    };
}

methods! {
    /// The rule alone, order 2.
    Rule {
        "order 2, the rule alone",
        order: 2, work: Work::Substeps(1.0), roundings: 1.0, error: 5e-2, longest: 1.0
    }
    /// [`Composition::kahan_li_6`](crate::Composition::kahan_li_6) of it.
    KahanLi6 {
        "order 6 in 9 substeps",
        order: 6, work: Work::Substeps(9.0), roundings: 9.0, error: 1e-3, longest: 1.5
    }
    /// [`Composition::kahan_li_8`](crate::Composition::kahan_li_8) of it.
    KahanLi8 {
        "order 8 in 17 substeps",
        order: 8, work: Work::Substeps(17.0), roundings: 17.0, error: 1e-4, longest: 2.0
    }
    /// [`Splitting::blanes_moan_4`](crate::Splitting::blanes_moan_4).
    BlanesMoan4 {
        "order 4, splitting with 6 kicks",
        order: 4, work: Work::Kicks(6.0), roundings: 6.0, error: 1e-4, longest: 2.5
    }
    /// [`Splitting::blanes_moan_6`](crate::Splitting::blanes_moan_6).
    BlanesMoan6 {
        "order 6, splitting with 11 kicks",
        order: 6, work: Work::Kicks(11.0), roundings: 11.0, error: 2e-6, longest: 3.0
    }
    /// [`Splitting::blanes_casas_escorihuela_8`](crate::Splitting::blanes_casas_escorihuela_8).
    BlanesCasasEscorihuela8 {
        "order 8, splitting with 19 kicks",
        order: 8, work: Work::Kicks(19.0), roundings: 19.0, error: 5e-7, longest: 3.0
    }
    // Sums of Gauss methods are compensated: the rounding is that of the increment.
    /// [`Gauss<4>`](crate::Gauss), order 8.
    Gauss4 {
        "order 8, Gauss with 4 stages",
        order: 8, work: Work::Stages(4.0), roundings: 0.1, error: 4e-8, longest: 3.0
    }
    /// [`Gauss<8>`](crate::Gauss), order 16.
    Gauss8 {
        "order 16, Gauss with 8 stages",
        order: 16, work: Work::Stages(8.0), roundings: 0.1, error: 2e-19, longest: 5.0
    }
}

impl Method {
    /// The order p.
    #[must_use]
    pub const fn order(self) -> u32 {
        self.entry().order
    }

    /// Whether its steps show what they do not resolve.
    pub(super) const fn is_gauss(self) -> bool {
        matches!(self.entry().work, Work::Stages(_))
    }

    /// Roundings of q in a step.
    pub(super) const fn roundings(self) -> f64 {
        self.entry().roundings
    }

    /// The angle hω at which the method's error by radian of an oscillator is `relative`.
    pub(super) fn usual_angle(self, relative: f64) -> f64 {
        let Entry { order, error, longest, .. } = self.entry();
        ComplexField::powf(relative / error, 1.0 / f64::from(order)).min(longest)
    }

    /// The evaluations of such a step.
    pub(super) fn usual_step(self, relative: f64, is_explicit: bool) -> f64 {
        match self.entry().work {
            Work::Substeps(substeps) => substeps * if is_explicit { 2.0 } else { 9.0 },
            Work::Kicks(kicks) => kicks,
            Work::Stages(stages) => stages * (8.0 + 6.0 * self.usual_angle(relative)),
        }
    }

    /// The evaluations by radian with this step.
    pub(super) fn usual_cost(self, relative: f64, is_explicit: bool) -> f64 {
        self.usual_step(relative, is_explicit) / self.usual_angle(relative)
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.entry().name)
    }
}
