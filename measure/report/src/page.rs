//! The page: what to take for which error first, then figures and tables, then how they were measured.

use std::fmt::Write;
use std::path::Path;

use anyhow::Result;
use dalembert_examples::results;

use crate::measured::{BATCH, Measured, QUANTITIES, SCENES};
use crate::{figures, long_run, section};

const LEVELS: [f64; 6] = [1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12];
const COORDINATES: [u32; 5] = [2, 4, 8, 16, 32];

/// Writes the page and its figures into `docs`.
///
/// # Errors
/// A file cannot be written.
pub fn write(docs: &Path, measured: &Measured<'_>) -> Result<()> {
    figures::write(&docs.join("speed-against-error"), measured)?;
    results::save(&docs.join("speed-against-error.md"), &text(measured)?)
}

fn text(measured: &Measured<'_>) -> Result<String> {
    let mut page = String::new();
    writeln!(page, "# Speed against error\n")?;
    writeln!(
        page,
        "What one trajectory costs to a given error: this project's methods and others', in one run, in turns, on one core.\n\
         Written by `cargo speed-against-error` (settings and machine: [below](#how-it-was-measured)); do not edit it.\n"
    )?;
    writeln!(page, "## Which method for which error\n")?;
    writeln!(
        page,
        "The fastest method for one trajectory, with its time in µs; below it this project's best and its factor to the\n\
         fastest. Ratios below 1.3 are ties. Error: of the position, at the end.\n"
    )?;
    choice(&mut page, measured)?;
    fastest_where(&mut page, measured)?;
    writeln!(page, "{}", measured.reading.trim_end())?;
    writeln!(page, "\n### Aimed at, and reached\n")?;
    aims(&mut page, measured)?;
    writeln!(
        page,
        "\n## Figure\n\nNine of the methods on four of the scenes, this project's in colour, others in black and grey; all are in the tables.\n"
    )?;
    let [(quantity, _), ..] = QUANTITIES;
    writeln!(
        page,
        "![Error of the {quantity} over the time of one trajectory, for four scenes](speed-against-error/{quantity}.svg)\n"
    )?;
    writeln!(
        page,
        "## Tables\n\nµs of one trajectory; – where no run reaches the error. A method without a row reaches none, or cannot step the scene.\n"
    )?;
    for scene in SCENES {
        table(&mut page, measured, scene)?;
    }
    writeln!(page, "## The long run: bounded energy error\n")?;
    if measured.long.is_empty() {
        writeln!(page, "Not measured in this run: `cargo speed-against-error long-run`.")?;
    } else {
        writeln!(
            page,
            "The ring with drag k = 1e-5 over 20 000 units of time, some 5 000 rounds.\n\n\
             ![Energy error along the long run, and its largest value over cost](speed-against-error/long-run.svg)\n"
        )?;
        long(&mut page, measured)?;
    }
    writeln!(page, "\n## A section\n")?;
    if measured.crossings.is_empty() {
        writeln!(page, "Not measured in this run: `cargo speed-against-error section`.")?;
    } else {
        section::table(&mut page, measured.crossings)?;
    }
    writeln!(page, "\n## Growth with n\n")?;
    growth(&mut page, measured)?;
    writeln!(page, "\n## How it was measured\n")?;
    page.push_str(include_str!("method.md"));
    writeln!(page, "\n{}", measured.setting.trim_end())?;
    Ok(page)
}

/// One row a scene, one column an error.
fn choice(page: &mut String, measured: &Measured<'_>) -> Result<()> {
    heading(page, "scene", LEVELS.map(level))?;
    for scene in SCENES {
        write!(page, "| {scene} |")?;
        for error in LEVELS {
            let all = measured.fastest(scene, error, |method| method != BATCH);
            let ours = measured.fastest(scene, error, |method| measured.is_ours(method));
            match (all, ours) {
                (Some((best, time)), Some((own, own_time))) if best != own => {
                    write!(page, " {best} {}<br>ours: {own} ×{:.1} |", microseconds(time), own_time / time)?
                }
                (Some((best, time)), Some(_)) => write!(page, " **{best}** {} |", microseconds(time))?,
                (Some((best, time)), None) => {
                    write!(page, " {best} {}<br>ours: not reached |", microseconds(time))?;
                }
                (None, _) => write!(page, " – |")?,
            }
        }
        writeln!(page)?;
    }
    writeln!(page)?;
    Ok(())
}

/// A line an error: which method is the fastest on which scenes.
fn fastest_where(page: &mut String, measured: &Measured<'_>) -> Result<()> {
    writeln!(page, "The fastest for one trajectory, by error:\n")?;
    for error in LEVELS {
        let mut fastest: Vec<(&str, Vec<&str>)> = Vec::new();
        for scene in SCENES {
            let Some((method, _)) = measured.fastest(scene, error, |method| method != BATCH) else {
                continue;
            };
            match fastest.iter_mut().find(|(known, _)| *known == method) {
                Some((_, scenes)) => scenes.push(scene),
                None => fastest.push((method, vec![scene])),
            }
        }
        let said: Vec<String> = fastest
            .into_iter()
            .map(|(method, scenes)| {
                let mark = if measured.is_ours(method) { "**" } else { "" };
                format!("{mark}{method}{mark} ({})", scenes.join(", "))
            })
            .collect();
        writeln!(page, "- {}: {}", level(error), said.join("; "))?;
    }
    writeln!(page, "\nThis project's methods in bold.\n")?;
    Ok(())
}

/// The aims of the project, with what this run says of them.
fn aims(page: &mut String, measured: &Measured<'_>) -> Result<()> {
    writeln!(page, "| aim | reached | |\n|---|---|---|")?;
    let is_rust = |method: &str| {
        !measured.is_ours(method) && !method.starts_with("heyoka") && !method.starts_with("scipy")
    };
    let mut row = |aim: &str, factors: Vec<(String, Option<f64>)>, limit: f64| -> Result<()> {
        let met = factors.iter().all(|(_, factor)| factor.is_some_and(|factor| factor <= limit));
        let said: Vec<String> = factors
            .into_iter()
            .map(|(what, factor)| match factor {
                Some(factor) => format!("{what} {factor:.2}"),
                None => format!("{what} not reached"),
            })
            .collect();
        writeln!(page, "| {aim} | {} | {} |", said.join(", "), if met { "met" } else { "**missed**" })?;
        Ok(())
    };
    let worst = |levels: &[f64], which: &dyn Fn(&str) -> bool| -> Vec<(String, Option<f64>)> {
        SCENES
            .iter()
            .map(|scene| {
                let factors = levels.iter().filter_map(|&error| {
                    let (_, time) = measured.fastest(scene, error, which)?;
                    let own = measured.fastest(scene, error, |method| measured.is_ours(method));
                    Some(own.map(|(_, own)| own / time))
                });
                let worst = factors.reduce(|a, b| Some(f64::max(a?, b?)));
                ((*scene).into(), worst.flatten())
            })
            .collect()
    };
    row(
        "position errors 1e-8 to 1e-12: at most 1.15 × the fastest peer in Rust",
        worst(&[1e-8, 1e-10, 1e-12], &is_rust),
        1.15,
    )?;
    row(
        "1e-3 and 1e-6: at most 2.5 × the fastest of all",
        worst(&[1e-3, 1e-6], &|method| method != BATCH && !measured.is_ours(method)),
        2.5,
    )?;
    let against_heyoka = |levels: &[f64]| -> Vec<(String, Option<f64>)> {
        let factor = |&error: &f64| {
            let heyoka = measured.time("ring", "heyoka", error, QUANTITIES[0].1);
            let own = measured.fastest("ring", error, |method| measured.is_ours(method));
            (level(error), own.zip(heyoka).map(|((_, own), heyoka)| own / heyoka))
        };
        levels.iter().map(factor).collect()
    };
    row(
        "the ring, 1e-8 to 1e-12: at most 0.67 × heyoka, scalar",
        against_heyoka(&[1e-8, 1e-10, 1e-12]),
        1.0 / 1.5,
    )?;
    row("the ring, larger errors: the same", against_heyoka(&[1e-3, 1e-4, 1e-6]), 1.0 / 1.5)?;
    row(
        "beyond: the fastest of all at every error on every scene",
        worst(&LEVELS, &|method| method != BATCH && !measured.is_ours(method)),
        1.0,
    )?;
    if measured.long.is_empty() {
        return Ok(());
    }
    let own = measured.fastest_long(4e-3, 2, |method| measured.is_ours(method));
    let peer = measured.fastest_long(4e-3, 2, |method| !measured.is_ours(method) && method != BATCH);
    let factor = own.zip(peer).map(|((_, own), (_, peer))| own / peer);
    row(
        "energy within 4e-3 over the long run: at most 0.2 × every non-variational method",
        vec![("to the fastest".into(), factor)],
        0.2,
    )
}

/// All methods on one scene.
fn table(page: &mut String, measured: &Measured<'_>, scene: &str) -> Result<()> {
    writeln!(page, "### {}\n", capitalised(scene))?;
    let columns = QUANTITIES.iter().flat_map(|(quantity, _)| {
        LEVELS
            .iter()
            .filter(|error| **error != 1e-4)
            .map(move |&error| format!("{} {}", &quantity[..3], level(error)))
    });
    heading(page, "method", columns)?;
    for method in measured.methods() {
        let errors = || LEVELS.into_iter().filter(|error| *error != 1e-4);
        let cells = QUANTITIES.iter().flat_map(|&(_, of)| errors().map(move |error| (error, of)));
        row(
            page,
            method,
            cells.map(|(error, of)| measured.time(scene, method, error, of).map(microseconds)),
        )?;
    }
    writeln!(page)?;
    Ok(())
}

/// ms of the whole long run for energy errors up to three horizons.
fn long(page: &mut String, measured: &Measured<'_>) -> Result<()> {
    const ERRORS: [f64; 3] = [4e-3, 1e-4, 1e-6];
    writeln!(
        page,
        "Growth with T: µs per unit of time, at the largest step or tolerance that keeps the energy within the error up to T.\n"
    )?;
    let columns = ERRORS
        .iter()
        .flat_map(|error| long_run::HORIZONS.map(move |horizon| format!("{error:e}, T = {horizon}")));
    heading(page, "method", columns)?;
    for method in measured.methods() {
        let cells = ERRORS.iter().flat_map(|&error| (0..3).map(move |horizon| (error, horizon)));
        let unit = |seconds: f64| format!("{:.3}", seconds * 1e6 / long_run::HORIZONS[2]);
        let time = |(error, horizon)| measured.fastest_long(error, horizon, |other| other == method);
        row(page, method, cells.map(|cell| time(cell).map(|(_, seconds)| unit(seconds))))?;
    }
    Ok(())
}

/// The chain with more and more masses.
fn growth(page: &mut String, measured: &Measured<'_>) -> Result<()> {
    writeln!(page, "The FPUT chain of n masses, T = 50: µs to a position error of 1e-6 and 1e-10.\n")?;
    let columns = [1e-6, 1e-10]
        .into_iter()
        .flat_map(|error| COORDINATES.map(move |n| format!("{}, n = {n}", level(error))));
    heading(page, "method", columns)?;
    for method in measured.methods() {
        let cells = [1e-6, 1e-10].into_iter().flat_map(|error| COORDINATES.map(|n| (error, n)));
        let time =
            |(error, n)| measured.time(&format!("FPUT chain, n = {n}"), method, error, QUANTITIES[0].1);
        row(page, method, cells.map(|cell| time(cell).map(microseconds)))?;
    }
    Ok(())
}

/// What a method reaches; no row where that is nothing.
fn row(page: &mut String, method: &str, cells: impl Iterator<Item = Option<String>>) -> Result<()> {
    let cells: Vec<_> = cells.collect();
    if cells.iter().any(Option::is_some) {
        let shown: Vec<_> = cells.iter().map(|cell| cell.as_deref().unwrap_or("–")).collect();
        writeln!(page, "| {method} | {} |", shown.join(" | "))?;
    }
    Ok(())
}

fn heading(page: &mut String, first: &str, columns: impl IntoIterator<Item = String>) -> Result<()> {
    let columns: Vec<String> = columns.into_iter().collect();
    writeln!(page, "| {first} | {} |", columns.join(" | "))?;
    writeln!(page, "|---|{}", "---|".repeat(columns.len()))?;
    Ok(())
}

fn level(error: f64) -> String {
    format!("{error:e}")
}

/// Three figures.
fn microseconds(seconds: f64) -> String {
    let value = seconds * 1e6;
    if value < 100.0 { format!("{value:.1}") } else { format!("{value:.0}") }
}

fn capitalised(name: &str) -> String {
    let mut letters = name.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

/// What the processor's widest vectors are called.
fn widest_vectors() -> &'static str {
    #[cfg(target_arch = "x86_64")]
    let widest = match (is_x86_feature_detected!("avx512f"), is_x86_feature_detected!("avx2")) {
        (true, _) => "AVX-512",
        (false, true) => "AVX2",
        (false, false) => "SSE2",
    };
    #[cfg(not(target_arch = "x86_64"))]
    let widest = std::env::consts::ARCH;
    widest
}

/// Kept beside the figures: which machine, which versions, what is missing.
pub fn setting(python: Option<&crate::peers::python::Python>) -> String {
    let processor = std::fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| {
        let line = text.lines().find(|line| line.starts_with("model name"))?;
        Some(line.split_once(": ")?.1.to_owned())
    });
    let built = if cfg!(target_feature = "avx") { "with `-C target-cpu=native`" } else { "for any x86-64" };
    let vectors = widest_vectors();
    let processor = processor.unwrap_or_else(|| "unknown".into());
    let mut text = format!("- Processor: {processor}, with {vectors}; built {built}.\n");
    if let Some(python) = python {
        for version in &python.versions {
            let _ = writeln!(text, "- {version}");
        }
        for missing in &python.missing {
            let _ = writeln!(text, "- Not installed, so not measured: {missing}");
        }
    } else {
        let _ = writeln!(text, "- No Python interpreter: heyoka and SciPy were not measured.");
    }
    text
}
