//! The page is what the cases find: the quick ones are run again.

use std::collections::BTreeSet;
use std::fs;

use super::{frictional, page, text};

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

/// The cases that take no time, run again: the page has what they find. Long ones are of the same run as
/// these.
#[test]
fn quick_cases_find_what_the_page_says() {
    let page = the_page();
    let command = "cargo study hard_cases";
    let quick = [
        ("overdamped", frictional::overdamped().unwrap()),
        ("stick-slip", frictional::stick_slip().unwrap()),
        ("fold", frictional::fold().unwrap()),
        ("limit-cycle", frictional::limit_cycle().unwrap()),
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
