//! The build of long tests alone leaves out no file that needs it.

use std::fs;
use std::path::{Path, PathBuf};

const LEFT_OUT: &str = "#![cfg(not(feature = \"only-long-tests\"))]";
/// What tests ask that are ignored, or take fewer cases, without optimisation.
const OPTIMISATION: &str = "debug_assertions";

/// The files under `folder` that are left out and ask for optimisation; a file leaves out the folder of its modules.
fn left_out(folder: &Path, with_folder: bool, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let source = fs::read_to_string(path.with_extension("rs")).unwrap_or_default();
        let is_left_out = with_folder || source.contains(LEFT_OUT);
        if path.is_dir() {
            left_out(&path, is_left_out, found);
        } else if is_left_out && source.contains(OPTIMISATION) {
            found.push(path);
        }
    }
}

#[test]
fn none_that_needs_optimisation_is_left_out() {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    let (mut found, mut long) = (Vec::new(), Vec::new());
    for floor in ["rules", "run", "step", "theory"] {
        left_out(&tests.join(floor), false, &mut found);
        // The control: were all left out, those that need it would be found.
        left_out(&tests.join(floor), true, &mut long);
    }
    assert!(found.is_empty(), "{found:?}");
    assert!(long.len() > 15, "{long:?}");
}
