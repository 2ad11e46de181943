//! The page.

use std::fmt::Write;

use dalembert_tests::motions::{Clock, Outcome, Verdict};

use crate::{Run, TOLERANCES};

/// All runs of a collection.
pub struct Collection {
    /// What motions they are.
    pub title: String,
    /// How many of them are compared to all fixed step sizes.
    pub compared: usize,
    /// Its runs.
    pub runs: Vec<Run>,
}

/// How many of some runs ended how.
#[derive(Default)]
struct Counts {
    all: usize,
    kept: usize,
    /// More than asked for, and less than twice that, without a word.
    passed: usize,
    silent: usize,
    late: usize,
    right: usize,
    wrong: usize,
    refused: usize,
    /// Ends asked for: kept, passed by less than twice, by more in silence, none.
    reached: [usize; 4],
    /// The runs of those that there are.
    runs: u32,
}

impl Counts {
    fn of<'a>(runs: impl Iterator<Item = &'a Run>) -> Self {
        let mut counts = Self::default();
        for Run { chosen: outcome, reached: (reached, runs), .. } in runs {
            counts.all += 1;
            match reached.verdict {
                Verdict::Silent if reached.error > 2.0 => counts.reached[2] += 1,
                Verdict::Silent if reached.error > 1.0 => counts.reached[1] += 1,
                Verdict::Silent => counts.reached[0] += 1,
                Verdict::Breach(_) | Verdict::Refused => counts.reached[3] += 1,
            }
            counts.runs += runs;
            match outcome.verdict {
                Verdict::Refused => counts.refused += 1,
                Verdict::Silent if outcome.error > 2.0 => counts.silent += 1,
                Verdict::Silent if outcome.error > 1.0 => counts.passed += 1,
                Verdict::Silent => counts.kept += 1,
                Verdict::Breach(_) if outcome.is_false_breach() => counts.wrong += 1,
                Verdict::Breach(_) => {
                    counts.right += 1;
                    counts.late += usize::from(outcome.before > 2.0);
                }
            }
        }
        counts
    }

    fn row(&self, name: &str) -> String {
        let Self { all, kept, passed, silent, late, right, wrong, refused, reached, runs } = self;
        let [ends, beyond, astray, none] = reached;
        let each = f64::from(*runs) / (ends + beyond + astray).max(1) as f64;
        format!(
            "| {name} | {all} | {kept} | {passed} | **{silent}** | {right} | {late} | {wrong} | {refused} \
             | {ends} | {beyond} | **{astray}** | {none} | {each:.2} |\n"
        )
    }
}

fn quantiles(mut of: Vec<f64>) -> String {
    of.retain(|x| x.is_finite());
    of.sort_by(f64::total_cmp);
    let at = |share: f64| of.get((share * (of.len().saturating_sub(1)) as f64).round() as usize);
    match (at(0.5), at(0.9)) {
        (Some(median), Some(tenth)) => format!("{median:.2} | {tenth:.2} | {}", of.len()),
        _ => String::from("– | – | 0"),
    }
}

const HEAD: &str = "# How reliably a tolerance is met

What `dalembert::tolerance` promised and kept, over random motions. Written by
`cargo study tolerance_study`; do not edit it.

**Promise.** At every step of the run |δqᵢ| ≤ ε and |δpᵢ| w ≤ ε, or a breach or an error says that it is not so. ε is the tolerance, w
weighs momenta like the coordinates that they move (`dalembert::tolerance` has the formula). The guard reports a breach
where the error that it expects passes 1.35 ε.

**Motions.** Families in turn, parameters, phases and times at random from the seed (`tests/src/motions`). References: closed forms in numbers of
twice the digits, or extrapolation of order 20 in such numbers, local error 1e-19. Errors are taken at 40 to 80 of the steps and at the end.
Collections 1, 2 and 5 were used for tuning; 3, 4 and 6 are held out.

| column | |
|---|---|
| kept | no breach, error at most ε on the whole way |
| (ε, 2ε] | no breach, and the error came to more than ε, to 2 ε at most |
| silent | no breach, no error, and the error passed 2 ε |
| right | a breach, and the error passed ε |
| late | of these: it passed 2 ε before the step at which the breach was reported |
| wrong | a breach, though the error was at most ε to the end |
| refused | no method chosen, or a step failed with its error |
| end kept | the end asked for (`TimedRequest::end`), by a run whose error was at most ε on the whole way |
| end (ε, 2ε] | such a run whose error came to more, to 2 ε at most |
| end silent | such a run whose error passed 2 ε |
| no end | an error says that no run that was tried keeps ε |
| runs | of an end that there is, the mean |
";

/// The page.
pub fn text(collections: &[Collection]) -> String {
    let mut page = String::from(HEAD);
    for (i, Collection { title, compared, runs }) in collections.iter().enumerate() {
        let motions = runs.len() / TOLERANCES.len();
        let _ =
            write!(page, "\n## Collection {}, {title}: {motions} motions, {} runs\n\n", i + 1, runs.len());
        page.push_str("| | asked | kept | (ε, 2ε] | silent | right | late | wrong | refused | end kept | end (ε, 2ε] | end silent | no end | runs |\n");
        page.push_str("|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
        page.push_str(&Counts::of(runs.iter()).row("all"));
        for tolerance in TOLERANCES {
            let of = runs.iter().filter(|run| run.tolerance == tolerance);
            page.push_str(&Counts::of(of).row(&format!("ε = {tolerance:.0e}")));
        }
        let mut families: Vec<&str> = Vec::new();
        for run in runs {
            if !families.contains(&run.family) {
                families.push(run.family);
            }
        }
        for family in families {
            let of = runs.iter().filter(|run| run.family == family);
            page.push_str(&Counts::of(of).row(family));
        }
        page.push_str("\nCost, in evaluations of the forces as `MethodStep` counts them; of runs that reached their end without a breach.\n\n");
        page.push_str("| | median | nine of ten below | runs |\n|---|--:|--:|--:|\n");
        let whole: Vec<&Run> = runs.iter().filter(|run| run.chosen.verdict == Verdict::Silent).collect();
        let share = |of: &[&Run], part: usize| {
            quantiles(of.iter().map(|run| run.chosen.evaluations[part] / run.chosen.evaluations[0]).collect())
        };
        let between = |from: u64, to: u64| -> Vec<&Run> {
            whole.iter().copied().filter(|run| (from..to).contains(&run.chosen.steps)).collect()
        };
        for (from, to, name) in [
            (100, 200, "100 to 199 steps"),
            (200, 500, "200 to 499 steps"),
            (500, u64::MAX, "500 steps and more"),
        ] {
            let of = between(from, to);
            let _ = writeln!(page, "| choosing / run, {name} | {} |", share(&of, 2));
            let _ = writeln!(page, "| guard / run, {name} | {} |", share(&of, 1));
        }
        let to_best = |part: fn(&Outcome) -> f64| {
            quantiles(
                whole.iter().filter_map(|run| run.cheapest.map(|best| part(&run.chosen) / best)).collect(),
            )
        };
        if *compared == 0 {
            continue;
        }
        let _ = writeln!(
            page,
            "| run / cheapest fixed method and step, first {compared} motions | {} |",
            to_best(|outcome| outcome.evaluations[0])
        );
        let _ = writeln!(
            page,
            "| the same with guard and choosing | {} |",
            to_best(|outcome| outcome.evaluations.iter().sum())
        );
    }
    clocks(&mut page, collections);
    page.push_str(TAIL);
    page
}

/// The price by the clock, of all that was timed.
fn clocks(page: &mut String, collections: &[Collection]) {
    let all: Vec<Clock> =
        collections.iter().flat_map(|of| of.runs.iter().filter_map(|run| run.clock)).collect();
    page.push_str(
        "\n## By the clock\n\nThe motions that are compared to fixed choices, of all collections: each the least of five times, \
         one after the other in one run, where the end is reached. The cheapest fixed choice is that by evaluations.\n\n\
         | | median | nine of ten below | runs |\n|---|--:|--:|--:|\n",
    );
    for (from, to, name) in [
        (1, 20, "fewer than 20 steps"),
        (20, 100, "20 to 99 steps"),
        (100, 300, "100 to 299 steps"),
        (300, u64::MAX, "300 steps and more"),
    ] {
        let of = |value: fn(&Clock) -> f64| {
            quantiles(all.iter().filter(|clock| (from..to).contains(&clock.steps)).map(value).collect())
        };
        let _ = writeln!(page, "| choosing / run, {name} | {} |", of(|clock| clock.choice / clock.runs[0]));
        let _ =
            writeln!(page, "| guard / run, {name} | {} |", of(|clock| clock.runs[1] / clock.runs[0] - 1.0));
        let _ = writeln!(
            page,
            "| end / cheapest fixed choice, {name} | {} |",
            of(|clock| clock.end / clock.fixed)
        );
    }
}

const TAIL: &str = "
The cheapest fixed choice is the one of which all shorter steps of its method keep the error as well. A step of a Gauss method by Newton's
method counts the derivatives and the matrix of all its stages.

## What falls short

- Runs of fewer than 100 steps are looked at in every step, by Gauss methods twelve times where nothing takes the time: there the guard costs
  some three times the run by the clock, six where steps are cheap. Of longer runs those of two and three coordinates by splittings, whose errors
  turn fast beside cheap steps, pay one to four times the run; the end of these costs four times the best fixed choice in the median.
- With more than three coordinates and cheap steps (splittings) the error itself is carried by two steps of the rule side by side, a quarter of
  the run's cost in the median and up to the whole where the step is long. What it may be besides is carried over many steps at once,
  without growth.
- Where a splitting turns a fast mode by radians in each step, the few local errors that are looked at differ much: the guard's estimate of a
  stiff pair's error can be three times too small (collection 5).
- Near the smallest errors that can be had rounding is taken for random; where forces are stiff a method's rounding can have one sign.
- Local errors of longer runs are taken at one step in 40, or twelve times. Between them those of a Gauss method are told by what it
  leaves unresolved, of other methods they are taken to be like their neighbours.
- In the counts a derivative of the motion is two evaluations; the algebra of the matrices that carry an error is not counted, for two
  coordinates about as much as a step of a splitting. What a guard costs is told by the clock.
- A breach can come late: where the error arises within one step between two looks (a kink that the energy does not show, a pulse of a step's
  length) it is reported at the next look.
- A pulse that lies between the nodes of all steps is seen by no method that evaluates forces: say when it comes (`breaking_at`), or how long it
  lasts (`longest_step`).
- Kinks, chaotic motions and passages that the first steps do not show end in breaches rather than in a choice that serves. `Breach::instead`
  is the tolerance to ask for then; where the end is what counts, `TimedRequest::end` runs again by itself until the error is kept.
";
