//! Order and step size from a requested error, and a guard along the run.

mod display;
mod guard;
mod methods;

use nalgebra::ComplexField;

use crate::{Lagrangian, Scalar, State, StepError};
pub use guard::{Breach, GuardedTrajectory};
pub use methods::{Composed, GaussOr, MethodRun, Methods, SplitOr, WithGauss, WithSplittings};

/// A method of constant step: a self-adjoint rule of order 2, alone or composed, a splitting, or a Gauss method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Method {
    /// The rule alone, order 2.
    Rule,
    /// [`Composition::kahan_li_6`](crate::Composition::kahan_li_6) of it.
    KahanLi6,
    /// [`Composition::kahan_li_8`](crate::Composition::kahan_li_8) of it.
    KahanLi8,
    /// [`Splitting::blanes_moan_4`](crate::Splitting::blanes_moan_4).
    BlanesMoan4,
    /// [`Splitting::blanes_moan_6`](crate::Splitting::blanes_moan_6).
    BlanesMoan6,
    /// [`Gauss<4>`](crate::Gauss), order 8.
    Gauss4,
    /// [`Gauss<8>`](crate::Gauss), order 16.
    Gauss8,
}

/// What the start says of one method.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Trial {
    /// The method.
    pub method: Method,
    /// The step size that the error asks for; `None` if no step tried on the way shows the method's order above round-off.
    pub step_size: Option<f64>,
    /// The cost over the whole time, in substeps of the rule. A kick and a drift of a splitting count as half a one; of a Gauss
    /// method an iteration for S stages counts as S/2: two stages at once, as in the narrowest vector registers.
    pub substeps: f64,
    /// Error expected at the end.
    pub expected: f64,
}

/// A method and a step size, with the reasons.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Choice {
    /// The method chosen: the one of least cost.
    pub method: Method,
    /// The step size, a whole fraction of the time.
    pub step_size: f64,
    /// Steps over the whole time.
    pub steps: u64,
    /// The error asked for.
    pub tolerance: f64,
    /// The error expected at the end.
    pub expected: f64,
    /// Largest difference between one step and two half ones at the start, to which a [`GuardedTrajectory`] compares.
    pub local: f64,
    /// What was found of every method, in the order of [`Method::ALL`]; `None` where the system was not asked for it.
    pub trials: [Option<Trial>; 7],
}

/// Why no method was chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ToleranceError {
    /// The time or the tolerance is not a finite number above 0.
    Request {
        /// The time given.
        time: f64,
        /// The tolerance given.
        tolerance: f64,
    },
    /// No method reaches the error: none showed its order, or rounding over so many steps exceeds it.
    OutOfReach {
        /// The method that comes closest; `None` where none showed its order.
        closest: Option<Trial>,
    },
    /// A step at the chosen size failed at the start.
    Step(StepError),
}

/// The share of the time that is tried out.
const WINDOW: f64 = 1.0 / 16.0;

/// Steps of the coarsest trial over the window, and how often they are halved.
const COARSEST: u64 = 4;
const HALVINGS: u32 = 14;

/// The share of the tolerance that the estimate may fill: it looks at the start alone.
const SAFETY: f64 = 0.25;

/// How far the order observed may stay below the method's; of high orders, which rounding hides before they show in full, this
/// share of the order, with which the step is then shortened.
const ORDER_SLACK: f64 = 0.7;
const ORDER_SHARE: f64 = 0.75;

impl Method {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Rule,
        Self::KahanLi6,
        Self::KahanLi8,
        Self::BlanesMoan4,
        Self::BlanesMoan6,
        Self::Gauss4,
        Self::Gauss8,
    ];

    /// The order p.
    #[must_use]
    pub const fn order(self) -> u32 {
        match self {
            Self::Rule => 2,
            Self::BlanesMoan4 => 4,
            Self::KahanLi6 | Self::BlanesMoan6 => 6,
            Self::KahanLi8 | Self::Gauss4 => 8,
            Self::Gauss8 => 16,
        }
    }

    const fn is_gauss(self) -> bool {
        matches!(self, Self::Gauss4 | Self::Gauss8)
    }

    /// The method and step size of least cost for an error of q of at most `tolerance` (largest coordinate, absolute) after
    /// `time`.
    ///
    /// `methods` is the rule of order 2, which stands for itself and its compositions; [`WithSplittings`] of it adds splittings,
    /// where the trapezoidal rule is explicit, and [`WithGauss`] Gauss methods, where the system has `rule = [trapezoidal, gauss]`.
    ///
    /// **Estimate.** Each method runs over the first sixteenth of the time with halved steps until the differences
    /// d(h) = |q_h − q_{h/2}| fall as its order p says. Then the error over that window is d(h)·2ᵖ/(2ᵖ − 1); it is expected to
    /// grow linearly with time and as hᵖ, and may fill a quarter of the tolerance. Costs are substeps, those of a Gauss method from the
    /// iterations that it took over that window ([`Trial::substeps`]). Rounding is expected to add ε|q|√substeps.
    /// An error that grows faster, as on chaotic motions, or a fast passage after the first sixteenth, is not seen from the
    /// start: run the choice by [`Choice::trajectory`], whose guard reports the latter.
    ///
    /// The step size stays constant along the run, so that the structure is kept.
    ///
    /// ```
    /// use dalembert::{Method, State, Trapezoidal, WithGauss, WithSplittings, rayleigh_system};
    ///
    /// #[rayleigh_system(rule = [trapezoidal, gauss])]
    /// fn pendulum(q: [f64; 1], v: [f64; 1], r: f64) -> (f64, f64) {
    ///     (0.5 * v[0] * v[0] + q[0].cos(), 0.5 * r * v[0] * v[0])
    /// }
    ///
    /// let system = Pendulum { r: 0.01 };
    /// let start = State::from_velocity(&system, [1.0], [0.0])?;
    /// let methods = WithGauss(WithSplittings(Trapezoidal));
    /// let choice = Method::for_tolerance(&system, methods, &start, 100.0, 1e-9)?;
    /// println!("{choice}"); // order 16, Gauss with 8 stages, h = …
    /// let mut run = choice.trajectory(&system, methods, start);
    /// for state in &mut run {
    ///     state?;
    /// }
    /// assert!(run.breach().is_none());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// A [`ToleranceError`].
    pub fn for_tolerance<L, M, const N: usize>(
        system: &L,
        methods: M,
        start: &State<L::Scalar, N>,
        time: f64,
        tolerance: f64,
    ) -> Result<Choice, ToleranceError>
    where
        L: Lagrangian<N>,
        M: Methods<L, N>,
    {
        let valid = |x: f64| x.is_finite() && x > 0.0;
        if !valid(time) || !valid(tolerance) {
            return Err(ToleranceError::Request { time, tolerance });
        }
        let trials = Self::ALL
            .map(|method| M::offers(method).then(|| method.trial(system, methods, start, time, tolerance)));
        let best = trials
            .iter()
            .flatten()
            .filter(|trial| trial.step_size.is_some() && trial.expected <= tolerance)
            .min_by(|a, b| a.substeps.total_cmp(&b.substeps));
        let Some(&Trial { method, step_size: Some(h), expected, .. }) = best else {
            let shown = trials.iter().flatten().filter(|trial| trial.step_size.is_some());
            let closest = shown.min_by(|a, b| a.expected.total_cmp(&b.expected)).copied();
            return Err(ToleranceError::OutOfReach { closest });
        };
        let steps = ComplexField::round(time / h).max(1.0);
        let mut choice =
            Choice { method, step_size: h, steps: steps as u64, tolerance, expected, local: 0.0, trials };
        // The largest local error over as many steps as the window has, a sample of them.
        let mut run = choice.trajectory(system, methods, *start);
        let window = ComplexField::ceil(steps * WINDOW).max(1.0) as u64;
        let stride = window.div_ceil(64);
        for step in 0..window {
            if step % stride == 0 {
                choice.local =
                    choice.local.max(run.local_error(run.state(), step).map_err(ToleranceError::Step)?);
            }
            run.advance().map_err(ToleranceError::Step)?;
        }
        Ok(choice)
    }

    fn trial<L, M, const N: usize>(
        self,
        system: &L,
        methods: M,
        start: &State<L::Scalar, N>,
        time: f64,
        tolerance: f64,
    ) -> Trial
    where
        L: Lagrangian<N>,
        M: Methods<L, N>,
    {
        let none = Trial { method: self, step_size: None, substeps: f64::INFINITY, expected: f64::INFINITY };
        let p = f64::from(self.order());
        let window = time * WINDOW;
        // Where so many steps lead, and what each costs.
        let end = |steps: u64| {
            let h = L::Scalar::constant(window / steps as f64);
            let mut run = methods.run(self, system, h, *start);
            let cost = (0..steps).try_fold(0.0, |sum, _| run.advance().map(|cost| sum + cost)).ok()?;
            Some((run.state().q, cost / steps as f64))
        };
        let size = start.q.amax().widen().max(f64::MIN_POSITIVE);
        let (mut coarse, mut last) = (end(COARSEST), None::<f64>);
        for k in 0..HALVINGS {
            let steps = COARSEST << k;
            let fine = end(2 * steps);
            let difference = coarse.zip(fine).map(|(a, b)| (a.0 - b.0).amax().widen());
            let cost = coarse.map_or(f64::INFINITY, |(_, cost)| cost);
            coarse = fine;
            let (Some(before), Some(here)) = (last, difference) else {
                last = difference;
                continue;
            };
            last = difference;
            let observed = ComplexField::log2(before / here);
            let rounding = L::Scalar::EPSILON.widen() * size * ComplexField::sqrt(steps as f64);
            if here <= 16.0 * rounding {
                // Nothing but rounding is left: the step before is fine enough, and no finer one shows more.
                let tried = Tried { h: window / (steps / 2) as f64, error: before.max(rounding), cost };
                return self.extrapolated(time, tolerance, tried, size, none);
            }
            let shows = if self.is_gauss() { p * ORDER_SHARE } else { p - ORDER_SLACK };
            if observed >= shows {
                let error = here * 2_f64.powi(p as i32) / (2_f64.powi(p as i32) - 1.0);
                let tried = Tried { h: window / steps as f64, error, cost };
                return self.extrapolated(time, tolerance, tried, size, none);
            }
        }
        none
    }

    /// The step for the tolerance, from one tried; never longer than twice that.
    fn extrapolated(self, time: f64, tolerance: f64, tried: Tried, size: f64, none: Trial) -> Trial {
        let p = f64::from(self.order());
        let over_time = tried.error / WINDOW;
        let ratio = SAFETY * tolerance / over_time;
        // Taken to be lower where a Gauss method's step has to be shortened, as it may not have shown in full.
        let p = if self.is_gauss() && ratio < 1.0 { p * ORDER_SHARE } else { p };
        let factor = ComplexField::powf(ratio, 1.0 / p).min(2.0);
        let steps = ComplexField::ceil(time / (tried.h * factor));
        let h_chosen = time / steps;
        if !h_chosen.is_finite() || h_chosen <= 0.0 {
            return none;
        }
        let substeps = steps * tried.cost;
        let rounding = f64::EPSILON * size * ComplexField::sqrt(substeps);
        let expected = over_time * ComplexField::powf(h_chosen / tried.h, p) + rounding;
        Trial { method: self, step_size: Some(h_chosen), substeps, expected }
    }
}

/// What a step size led to over the window.
#[derive(Clone, Copy)]
struct Tried {
    h: f64,
    error: f64,
    /// Substeps of one step.
    cost: f64,
}

impl Choice {
    /// The run of this choice, with its guard.
    pub fn trajectory<'a, L, M, const N: usize>(
        &self,
        system: &'a L,
        methods: M,
        start: State<L::Scalar, N>,
    ) -> GuardedTrajectory<'a, L, M, N>
    where
        L: Lagrangian<N>,
        M: Methods<L, N>,
    {
        GuardedTrajectory::new(*self, system, methods, start)
    }
}
