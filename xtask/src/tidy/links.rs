//! Links of pages lead to files that exist, and to headings in them.

use std::path::{Component, Path, PathBuf};

use anyhow::{Result, ensure};
use xshell::Shell;

use crate::{markdown, project};

/// Pages of rustdoc, whose links it checks itself: they lead to items, or to pages that it makes.
const OF_RUSTDOC: &str = "runtime/src/guide/";

/// Folders with parts of pages, and those into which programs write the pages: links lead from there.
const PARTS: [(&str, &str); 6] = [
    ("docs/speed-against-error/", "docs"),
    ("measure/report/src/constraints/", "docs/evidence"),
    ("measure/report/", "docs"),
    ("measure/benches/", "docs/evidence"),
    ("tests/examples/hard_cases/", "docs"),
    ("tests/examples/", "docs/evidence"),
];

/// Links that lead nowhere.
pub fn check(shell: &Shell) -> Result<Vec<String>> {
    let (mut dead, mut links) = (Vec::new(), 0);
    for page in project::files(shell, ".md")? {
        // A package's copy of a page leads from where that stands.
        if page.starts_with(OF_RUSTDOC) || project::root().join(&page).is_symlink() {
            continue;
        }
        let text = project::text(&page)?;
        for (line, target) in markdown::links(&text) {
            links += 1;
            if !leads_somewhere(&page, &target)? {
                dead.push(format!("{page}:{line}: {target} is not there"));
            }
        }
    }
    ensure!(links > 100, "{links} links alone were looked at");
    Ok(dead)
}

/// Whether a link on a page leads to another site, or to a file, and to a heading in it if it names one.
fn leads_somewhere(page: &str, target: &str) -> Result<bool> {
    if ["https://", "http://", "mailto:"].iter().any(|scheme| target.starts_with(scheme)) {
        return Ok(true);
    }
    let (path, anchor) = target.split_once('#').map_or((target, None), |(path, anchor)| (path, Some(anchor)));
    let own = Path::new(page).parent().unwrap_or(Path::new(""));
    let of_part = PARTS.iter().find(|(part, _)| page.starts_with(part));
    let folder = of_part.map_or(own, |(_, folder)| Path::new(folder));
    let file = if path.is_empty() { PathBuf::from(page) } else { normal(&folder.join(path)) };
    if !project::root().join(&file).exists() {
        return Ok(false);
    }
    let has = |anchor: &str| -> Result<bool> {
        Ok(markdown::anchors(&project::text(&file)?).iter().any(|of| of == anchor))
    };
    match anchor {
        Some(anchor) if file.extension().is_some_and(|extension| extension == "md") => has(anchor),
        _ => Ok(true),
    }
}

/// The path without `..`.
fn normal(path: &Path) -> PathBuf {
    let mut normal = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => drop(normal.pop()),
            Component::CurDir => {}
            part => normal.push(part),
        }
    }
    normal
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_link_leads_somewhere() {
        assert_eq!(check(&project::shell().unwrap()).unwrap(), [""; 0]);
    }

    #[test]
    fn dead_links_are_seen() {
        let leads = |page, target| leads_somewhere(page, target).unwrap();
        assert!(leads("README.md", "docs/embedding.md#in-c") && leads("docs/python.md", "../README.md"));
        assert!(leads("docs/embedding.md", "#in-c") && leads("README.md", "https://example.org/none"));
        assert!(!leads("README.md", "docs/no_such_page.md") && !leads("docs/python.md", "README.md"));
        assert!(
            !leads("README.md", "docs/embedding.md#in-cobol") && !leads("docs/embedding.md", "#in-cobol")
        );
    }
}
