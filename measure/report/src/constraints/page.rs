//! The page: what each method comes to within given times, the least errors first.

use std::fmt::Write;

use anyhow::Result;

use super::{HORIZONS, NAME, Record, runs};

/// Processor times of a unit of time of the motion, s.
const BUDGETS: [f64; 3] = [1e-5, 1e-4, 1e-3];

/// What a run is judged by.
pub type Quantity = (&'static str, fn(&Record) -> Option<f64>);

/// Off the constraints, and the errors.
pub const QUANTITIES: [Quantity; 4] = [
    ("off the constraints, m", |record| Some(record.off)),
    ("energy, J", |record| Some(record.energy_error)),
    ("vertical momentum, N m s", |record| record.momentum_error),
    ("q at T, m or rad", |record| Some(record.position_error)),
];

/// The page's text.
///
/// # Errors
/// None but of writing.
pub fn text(records: &[Record], setting: &str) -> Result<String> {
    let mut page = include_str!("introduction.md").to_owned();
    writeln!(page, "\n## The least errors\n\n{}", include_str!("least.md"))?;
    for quantity in [QUANTITIES[3], QUANTITIES[1], QUANTITIES[0]] {
        least(&mut page, records, quantity)?;
    }
    page.push_str(include_str!("reading.md"));
    writeln!(
        page,
        "\n![Errors of q, of the energy and of the constraints over time, for three mechanisms]({NAME}/errors.svg)\n"
    )?;
    writeln!(page, "## All methods\n\n{}", include_str!("tables.md"))?;
    for horizon in HORIZONS {
        for mechanism in names(records, |record| &record.mechanism) {
            let runs: Vec<&Record> = records
                .iter()
                .filter(|record| record.mechanism == mechanism && record.horizon == horizon.time)
                .collect();
            if !runs.is_empty() {
                writeln!(page, "### {mechanism}, T = {} s\n", horizon.time)?;
                table(&mut page, &runs)?;
            }
        }
    }
    writeln!(page, "{}", setting.trim_end())?;
    Ok(page)
}

/// The names that records have, in their order.
fn names<'a>(records: &'a [Record], name: impl Fn(&'a Record) -> &'a str) -> Vec<&'a str> {
    let mut names = Vec::new();
    for name in records.iter().map(name) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

/// Whether a method is this project's.
pub fn is_ours(method: &str) -> bool {
    runs::names().contains(&method)
}

/// A method with the way its constraints are stabilised.
pub fn label(record: &Record) -> String {
    let stabilised = if record.alpha > 0.0 { ", stabilised" } else { "" };
    format!("{}{stabilised}", record.method)
}

/// The least value within a time, and of which run.
fn best<'a>(
    runs: impl Iterator<Item = &'a Record>,
    budget: f64,
    value: fn(&Record) -> Option<f64>,
) -> Option<(f64, &'a Record)> {
    let within = runs.filter(|record| record.seconds <= budget);
    within
        .filter_map(|record| Some((value(record)?, record)))
        .filter(|(value, _)| value.is_finite())
        .min_by(|a, b| a.0.total_cmp(&b.0))
}

/// A row a motion, a column a time: the method of the least error, and of this project's the least.
fn least(page: &mut String, records: &[Record], (name, value): Quantity) -> Result<()> {
    write!(page, "| {name} |")?;
    for budget in BUDGETS {
        write!(page, " {:.0} µs |", budget * 1e6)?;
    }
    writeln!(page, "\n|---|{}", "---|".repeat(BUDGETS.len()))?;
    for mechanism in names(records, |record| &record.mechanism) {
        for horizon in HORIZONS {
            let runs = || {
                let of =
                    move |record: &&Record| record.mechanism == mechanism && record.horizon == horizon.time;
                records.iter().filter(of)
            };
            if runs().next().is_none() {
                continue;
            }
            write!(page, "| {mechanism}, T = {} |", horizon.time)?;
            for budget in BUDGETS {
                let ours = best(runs().filter(|record| is_ours(&record.method)), budget, value);
                let others = best(runs().filter(|record| is_other(&record.method)), budget, value);
                let cell = |found: Option<(f64, &Record)>, mark: &str| match found {
                    Some((error, record)) => format!("{mark}{}{mark} {error:.0e}", label(record)),
                    None => "–".into(),
                };
                let (ours, others) = (cell(ours, "**"), cell(others, ""));
                write!(page, " {ours}<br>{others} |")?;
            }
            writeln!(page)?;
        }
    }
    writeln!(page)?;
    Ok(())
}

/// Whether a method is another's and has constraints: in joint angles there are none, or one.
fn is_other(method: &str) -> bool {
    !is_ours(method) && !method.contains("in joints")
}

/// A row a method, a column a quantity, each with a value for each time.
fn table(page: &mut String, runs: &[&Record]) -> Result<()> {
    let shown: Vec<Quantity> =
        QUANTITIES.into_iter().filter(|(_, value)| runs.iter().any(|run| value(run).is_some())).collect();
    write!(page, "| |")?;
    for (name, _) in &shown {
        write!(page, " {name} |")?;
    }
    writeln!(page, "\n|---|{}", "---|".repeat(shown.len()))?;
    let mut labels: Vec<String> = Vec::new();
    for run in runs {
        if !labels.contains(&label(run)) {
            labels.push(label(run));
        }
    }
    for of in labels {
        let own: Vec<&Record> = runs.iter().copied().filter(|run| label(run) == of).collect();
        let mark = if own.iter().any(|run| is_ours(&run.method)) { "**" } else { "" };
        write!(page, "| {mark}{of}{mark} |")?;
        for (_, value) in &shown {
            let cells = BUDGETS.map(|budget| {
                best(own.iter().copied(), budget, *value)
                    .map_or("–".to_owned(), |(value, _)| format!("{value:.0e}"))
            });
            write!(page, " {} |", cells.join(", "))?;
        }
        writeln!(page)?;
    }
    writeln!(page)?;
    Ok(())
}
