//! Pages that are written or copied say what they are written or copied from: `docs/hard-cases.md`, the README's table of speed.

#[path = "../examples/hard_cases/conservative.rs"]
#[expect(dead_code, reason = "the long cases")]
mod conservative;
#[path = "../examples/hard_cases/frictional.rs"]
#[expect(dead_code, reason = "the long cases")]
mod frictional;
#[path = "../examples/hard_cases/page.rs"]
#[expect(dead_code, reason = "what writes")]
mod page;
#[path = "../examples/hard_cases/text.rs"]
mod text;

use std::collections::BTreeSet;
use std::fs;

fn the_page() -> String {
    fs::read_to_string(page::documents().join("hard-cases.md")).unwrap()
}

#[test]
fn the_page_ends_with_what_has_no_figures() {
    let text = text::without_figures();
    for heading in [text::FIRST_HEADING, "## Faults", "## Random and broken input", "## What was once wrong"]
    {
        assert!(text.contains(heading), "{heading}");
    }
    assert!(!text.contains("<!--"));
    let command = "cargo study hard_cases text";
    assert!(the_page().ends_with(&text), "run `{command}`");
}

/// The cases that take no time, run again: the page has what they find. Long ones are of the same run as these.
#[test]
fn quick_cases_find_what_the_page_says() {
    let page = the_page();
    let command = "cargo study hard_cases";
    let quick = [
        ("overdamped", frictional::overdamped().unwrap()),
        ("stick-slip", frictional::stick_slip().unwrap()),
        ("fold", frictional::fold().unwrap()),
    ];
    for (name, case) in quick {
        let text = case.text(name);
        assert!(page.contains(&text), "{name} finds something else now; run `{command}`:\n{text}");
        // The control: a figure that is another.
        let (at, digit) = text.char_indices().rfind(|(_, letter)| letter.is_ascii_digit()).unwrap();
        let other = if digit == '9' { "8" } else { "9" };
        assert!(!page.contains(&format!("{}{other}{}", &text[..at], &text[at + 1..])));
    }
}

#[test]
fn every_picture_is_on_the_page() {
    let page = the_page();
    let shown: BTreeSet<String> =
        page.split("](hard-cases/").skip(1).map(|rest| rest.split(')').next().unwrap().to_owned()).collect();
    let drawn: BTreeSet<String> = fs::read_dir(page::documents().join("hard-cases"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    assert!(shown.len() >= 8);
    assert_eq!(shown, drawn);
}

/// The README's columns of the rows of scenes in the table under `heading`.
fn rows_of_scenes(page: &str, heading: &str) -> Vec<String> {
    let table = page.split_once(heading).expect("the table").1;
    let scenes = ["ring", "double pendulum", "FPUT chain", "spring chain", "pendulum chain", "arm"];
    let rows = table.lines().skip(2).take_while(|line| line.starts_with('|'));
    let cells = rows.map(|row| row.split('|').map(str::trim).skip(1).take(6).collect::<Vec<_>>());
    cells.filter(|cells| scenes.contains(&cells[0])).map(|cells| cells.join(" | ")).collect()
}

/// The README's table of speed has the rows of the page of performance, which the bench prints.
#[test]
fn the_readme_has_the_speeds_of_their_page() {
    let root = page::documents();
    let readme = fs::read_to_string(root.with_file_name("README.md")).unwrap();
    let performance = fs::read_to_string(root.join("performance.md")).unwrap();
    let heading = "| scene | n | by hand, ns | generated, ns | generated / by hand | num-dual, ns |";
    let in_readme = rows_of_scenes(&readme, heading);
    assert_eq!(in_readme.len(), 6);
    assert_eq!(in_readme, rows_of_scenes(&performance, heading));
    // The control: a figure that is another.
    let other = readme.replacen("| ring | 2 | 7", "| ring | 2 | 8", 1);
    assert_ne!(rows_of_scenes(&other, heading), in_readme);
}
