//! A run as a line of a study.

use super::{Drawn, MOST, MOST_OFF, Outcome, run, run::Judged};

impl Outcome {
    /// Whether nothing is wrong with the run.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        let is_refused_falsely = self.refused.as_ref().is_some_and(|refused| refused.root.is_ok());
        self.off <= MOST_OFF
            && self.ratios.iter().all(|ratio| *ratio <= MOST)
            && self.rootless == 0
            && self.followed[1] == 0
            && !is_refused_falsely
    }
}

/// Makes the run, and says in one line how it went: words before `|` are counted, what follows is to be read.
#[must_use]
pub fn report<L: Judged<N, M>, const N: usize, const M: usize>(
    family: &str,
    seed: u64,
    drawn: &Drawn,
) -> String {
    let outcome = run::<L, N, M>(drawn);
    let refused = match &outcome.refused {
        None => "none",
        Some(refused) if refused.root.is_err() => "rightly",
        Some(refused) if refused.is_taken_alone => "in_run",
        Some(_) => "falsely",
    };
    let Outcome { steps, off, judged, ratios: [velocity, momentum], relative, rootless, followed, .. } =
        outcome;
    let family = family.replace(' ', "_");
    let kind = drawn.kind.name().replace(' ', "_");
    let by = if drawn.is_composed { "composed" } else { "plain" };
    let started = outcome.no_start.is_none();
    let mut line = format!(
        "{family} {kind} {by} {started} {steps} {off:.2} {judged} {velocity:.2} {momentum:.2} {relative:.1e} {rootless} {} {} \
         {refused} {} {} | {} {seed} {:?} h = {:e}",
        followed[0],
        followed[1],
        outcome.has_gained,
        outcome.is_at_rest,
        L::SHAPE.name,
        drawn.rule,
        drawn.h
    );
    if let Some(refused) = &outcome.refused {
        line += &format!(", {}, {:?}", refused.error, refused.root);
    }
    if let Some(error) = &outcome.no_start {
        line += &format!(", no start: {error}");
    }
    line
}
