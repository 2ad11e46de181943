//! The guide's pictures. rustdoc copies no files, so that its documentation holds them: before each chapter
//! stands a definition of the picture's link as a `data:` address. The chapter ends with a definition by the
//! picture's own file, in `docs/`, which GitHub follows; of two definitions the first one counts.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use xshell::Shell;

use crate::project;

const GUIDE: &str = "runtime/src/guide/";

/// Where chapters are included.
const INCLUDE: [&str; 2] = ["runtime/src/lib.rs", "runtime/src/guide.rs"];

/// A picture of a chapter.
struct Picture {
    /// The file with the definition, as the chapter's neighbour.
    link: String,
    /// The definition as it has to be.
    definition: String,
}

/// The pictures of a chapter, by the definitions at its end.
fn pictures(chapter: &str) -> Result<Vec<Picture>> {
    let folder = Path::new(GUIDE);
    let definitions = chapter.lines().filter_map(|line| {
        let (name, target) = line.strip_prefix('[')?.split_once("]: ")?;
        target.ends_with(".svg").then_some((name, target))
    });
    definitions
        .map(|(name, target)| {
            let svg = project::text(folder.join(target))?;
            ensure!(!svg.contains("\n\n"), "{target} has an empty line");
            let definition = format!("[{name}]: data:image/svg+xml;charset=utf-8,{}\n\n", encoded(&svg));
            Ok(Picture { link: format!("pictures/{name}.link"), definition })
        })
        .collect()
}

/// Text as a part of an address, without what ends one in Markdown.
fn encoded(text: &str) -> String {
    let is_plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-._~/:=;,".contains(&byte);
    text.trim_end()
        .bytes()
        .map(|byte| if is_plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") })
        .collect()
}

/// Chapters by their names, without those that are only parts of pages.
fn chapters(shell: &Shell) -> Result<Vec<(String, String)>> {
    let paths = project::files(shell, ".md")?.into_iter().filter(|path| path.starts_with(GUIDE));
    let chapters = paths.map(|path| Ok((path[GUIDE.len()..].to_owned(), project::text(&path)?)));
    chapters.collect()
}

/// Pictures that differ from their files, or that documentation does not include.
pub fn check(shell: &Shell) -> Result<Vec<String>> {
    let sources = INCLUDE.map(project::text).into_iter().collect::<Result<Vec<_>>>()?.concat();
    let (mut found, mut count) = (Vec::new(), 0);
    for (name, chapter) in chapters(shell)? {
        for Picture { link, definition } in pictures(&chapter)? {
            count += 1;
            if project::text(format!("{GUIDE}{link}")).ok().as_ref() != Some(&definition) {
                found.push(format!(
                    "{GUIDE}{link} is not the picture: `cargo xtask bless pictures` writes it"
                ));
            }
            let place = |file: &str| sources.find(&format!("include_str!(\"guide/{file}\")"));
            if place(&link).is_none_or(|at| place(&name).is_none_or(|chapter| at > chapter)) {
                found.push(format!("{link} is not included before {name}"));
            }
        }
    }
    ensure!(count > 3, "{count} pictures alone were looked at");
    Ok(found)
}

/// Writes the definitions anew.
pub fn write(shell: &Shell) -> Result<()> {
    for (_, chapter) in chapters(shell)? {
        for Picture { link, definition } in pictures(&chapter)? {
            let path = project::root().join(GUIDE).join(link);
            fs::write(&path, definition).with_context(|| path.display().to_string())?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_has_nothing_that_ends_it_in_markdown() {
        assert_eq!(encoded("<a b=\"(1,2)\">é</a>\n"), "%3Ca%20b=%22%281,2%29%22%3E%C3%A9%3C/a%3E");
    }

    #[test]
    fn pictures_are_the_definitions_that_lead_to_some() -> Result<()> {
        let chapter = "Text, [a link][other].\n\n[ring]: ../../../docs/ring.svg\n[other]: other.md\n";
        let found = pictures(chapter)?;
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].link, "pictures/ring.link");
        assert!(found[0].definition.starts_with("[ring]: data:image/svg+xml;charset=utf-8,%3Csvg%20"));
        assert!(found[0].definition.ends_with("%3C/svg%3E\n\n"));
        assert!(pictures("[gone]: gone.svg").is_err());
        Ok(())
    }
}
