//! The README's table of speed says what it is copied from.

use std::fs;
use std::path::Path;

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
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let readme = fs::read_to_string(root.join("README.md")).unwrap();
    let performance = fs::read_to_string(root.join("docs/performance.md")).unwrap();
    let heading = "| scene | n | by hand, ns | generated, ns | generated / by hand | num-dual, ns |";
    let in_readme = rows_of_scenes(&readme, heading);
    assert_eq!(in_readme.len(), 6);
    assert_eq!(in_readme, rows_of_scenes(&performance, heading));
    // The control: a figure that is another.
    let other = readme.replacen("| ring | 2 | ", "| ring | 2 | 1", 1);
    assert_ne!(rows_of_scenes(&other, heading), in_readme);
}
