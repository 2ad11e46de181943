use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::{Draft, PartsError, Put, Way, host, link, rename, sweep};
use crate::parts::names;

/// A folder of this test, empty.
fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("dalembert-draft-{name}-{}", std::process::id()));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

fn written(place: &Path, text: &str) -> Draft {
    let mut draft = Draft::of(place).unwrap();
    draft.file.write_all(text.as_bytes()).unwrap();
    draft
}

/// A file system that does not know a way.
fn unknown(_: &Path, _: &Path) -> io::Result<()> {
    Err(io::Error::from_raw_os_error(1))
}

#[test]
fn a_file_is_put_once_and_replaces_none() {
    let folder = folder("once");
    let ways: [&[Way]; 3] = [&[link, rename], &[link], &[unknown, rename]];
    for (k, ways) in ways.into_iter().enumerate() {
        let place = folder.join(format!("place {k}"));
        let (one, other) = (written(&place, "one"), written(&place, "other"));
        // Where a rename that replaces nothing is not known, that is said.
        let is_renamed = cfg!(all(target_os = "linux", target_env = "gnu"));
        if k == 2 && !is_renamed {
            continue;
        }
        assert_eq!(one.put_by(ways).unwrap(), Put::Placed);
        assert_eq!(other.put_by(ways).unwrap(), Put::Taken);
        assert_eq!(fs::read_to_string(place).unwrap(), "one");
    }
    let place = folder.join("nowhere");
    let error = written(&place, "one").put_by(&[unknown, unknown]).unwrap_err();
    assert!(
        matches!(&error, PartsError::MayReplace { .. }) && error.to_string().contains("another"),
        "{error}"
    );
    // No draft is left.
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 3);
    fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_draft_that_is_removed_says_so() {
    let folder = folder("removed");
    let place = folder.join("place");
    let draft = written(&place, "one");
    fs::remove_file(&draft.path).unwrap();
    assert_eq!(draft.put().unwrap(), Put::Removed);
    let draft = written(&place, "one");
    fs::remove_file(&draft.path).unwrap();
    fs::write(&place, "other").unwrap();
    assert_eq!(draft.put().unwrap(), Put::Taken);
    fs::remove_dir_all(folder).unwrap();
}

/// Drafts of a living writer, a dead one, one of another host, and two whose file is there.
#[test]
fn a_draft_is_removed_when_nobody_needs_it() {
    let folder = folder("swept");
    let place = |k: u64| names::path(&folder, &(100 * k..100 * k + 100));
    let leave = |k: u64, host: &str| {
        let path = names::draft(&place(k), 7, host);
        fs::write(&path, "half").unwrap();
        path
    };
    let host = host().unwrap();
    let living = Draft::of(&place(0)).unwrap();
    let (dead, elsewhere) = (leave(1, host), leave(2, "elsewhere"));
    let done = [leave(3, host), leave(4, "elsewhere")];
    (3..5).for_each(|k| fs::write(place(k), "a part").unwrap());
    let not_asked_for = leave(5, host);
    let users = [".members-000000000000-000000000100.parquet.h3Kz9Q", ".notes@home", "notes.txt"];
    users.iter().for_each(|name| fs::write(folder.join(name), "half").unwrap());

    let is_ours = |name: &str| names::members(name).is_some_and(|part| part.end <= 500);
    assert_eq!(sweep(&folder, is_ours).unwrap(), 2);
    assert!(living.path.exists() && elsewhere.exists() && not_asked_for.exists());
    assert!(!dead.exists() && !done.iter().any(|path| path.exists()));
    assert!(users.iter().all(|name| folder.join(name).exists()));
    assert_eq!(living.put().unwrap(), Put::Placed);

    // The control: the living one's own draft is removed as soon as it is not locked.
    let left = leave(0, host);
    fs::remove_file(place(0)).unwrap();
    assert_eq!(sweep(&folder, is_ours).unwrap(), 1);
    assert!(!left.exists());
    fs::remove_dir_all(folder).unwrap();
}
