//! Pages in Markdown: their blocks of code, headings and links.

/// A block of code between fences.
#[derive(Debug, PartialEq)]
pub struct Block<'p> {
    /// The heading of the second level that it stands under.
    pub chapter: Option<&'p str>,
    /// The word behind the opening fence.
    pub language: &'p str,
    /// Its lines.
    pub code: String,
}

/// A line of a page.
enum Line<'p> {
    /// An opening fence, with the word behind it.
    Opens(&'p str),
    Code(&'p str),
    Closes,
    Text(&'p str),
}

fn lines(page: &str) -> impl Iterator<Item = Line<'_>> {
    let mut fence = None;
    page.lines().map(move |line| {
        let text = line.trim_start();
        match fence {
            Some(opened) if text.trim_end() == opened => {
                fence = None;
                Line::Closes
            }
            Some(_) => Line::Code(line),
            None => match ["```", "~~~"].into_iter().find(|fence| text.starts_with(fence)) {
                Some(opened) => {
                    fence = Some(opened);
                    Line::Opens(text[opened.len()..].trim())
                }
                None => Line::Text(line),
            },
        }
    })
}

/// The blocks of a page, in its order.
pub fn blocks(page: &str) -> Vec<Block<'_>> {
    let (mut found, mut chapter) = (Vec::<Block>::new(), None);
    for line in lines(page) {
        match line {
            Line::Opens(language) => found.push(Block { chapter, language, code: String::new() }),
            Line::Code(line) => found.last_mut().expect("an opened block").code += &format!("{line}\n"),
            Line::Closes => {}
            Line::Text(line) => chapter = line.strip_prefix("## ").or(chapter),
        }
    }
    found
}

/// The commands of a page, or of one of its chapters, block by block.
pub fn commands(page: &str, chapter: Option<&str>) -> Vec<String> {
    let of_chapter = |block: &Block| chapter.is_none() || block.chapter == chapter;
    let blocks = blocks(page).into_iter().filter(|block| block.language == "sh" && of_chapter(block));
    blocks.map(|block| block.code).collect()
}

/// The lines of a page that are no code, from 1, without what stands between back-quotes.
fn prose(page: &str) -> impl Iterator<Item = (usize, String)> {
    let of_text = |(index, line)| match line {
        Line::Text(line) => {
            let parts: Vec<_> = line.split('`').collect();
            // An odd back-quote quotes nothing.
            let is_quoted = |index| index % 2 == 1 && index + 1 < parts.len();
            let kept =
                parts.iter().enumerate().map(|(index, part)| if is_quoted(index) { "" } else { *part });
            Some((index + 1, kept.collect::<Vec<_>>().join("`")))
        }
        _ => None,
    };
    lines(page).enumerate().filter_map(of_text)
}

/// The targets of a page's links and pictures, each with its line, from 1.
pub fn links(page: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    for (number, line) in prose(page) {
        let mut add = |target: &str| found.push((number, target.trim().to_owned()));
        for rest in line.split("](").skip(1) {
            add(rest.split([')', ' ']).next().unwrap_or(rest));
        }
        for opening in ["href=\"", "src=\""] {
            line.split(opening).skip(1).filter_map(|rest| rest.split('"').next()).for_each(&mut add);
        }
        if line.starts_with('[')
            && let Some((_, target)) = line.split_once("]: ")
        {
            add(target);
        }
    }
    found
}

/// The anchors of a page's headings, as GitHub makes them.
pub fn anchors(page: &str) -> Vec<String> {
    let mut found = Vec::<String>::new();
    for line in lines(page) {
        let Line::Text(line) = line else { continue };
        let heading = line.trim_start_matches('#');
        if heading.len() == line.len() || !heading.starts_with(' ') {
            continue;
        }
        let kept = |c: &char| c.is_alphanumeric() || [' ', '-', '_'].contains(c);
        let anchor = heading.trim().to_lowercase().chars().filter(kept).collect::<String>().replace(' ', "-");
        let before = found.iter().filter(|other| **other == anchor).count();
        found.push(if before == 0 { anchor } else { format!("{anchor}-{before}") });
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: &str = "\
# Title

```sh
first
```

## In C

Text with [a link](other.md#there), `[code](none.md)` and ![a picture](it.png).

```sh
second

## no heading
```

```c
int third;
```

## In C++, *twice*

  ```sh
  fourth
  ```

~~~sh
```
fifth
~~~

## In C

[name]: https://example.org
<img src=\"small.svg\">
";

    #[test]
    fn blocks_have_chapters_and_languages() {
        let all: Vec<_> = blocks(PAGE).into_iter().map(|block| (block.chapter, block.language)).collect();
        let twice = Some("In C++, *twice*");
        let c = Some("In C");
        assert_eq!(all, [(None, "sh"), (c, "sh"), (c, "c"), (twice, "sh"), (twice, "sh")]);
    }

    #[test]
    fn commands_are_those_of_the_chapter_as_they_are_written() {
        assert_eq!(commands(PAGE, Some("In C")), ["second\n\n## no heading\n"]);
        assert_eq!(commands(PAGE, Some("In C++, *twice*")), ["  fourth\n", "```\nfifth\n"]);
        assert_eq!(commands(PAGE, None).len(), 4);
        assert_eq!(commands(PAGE, Some("In D")), [""; 0]);
    }

    #[test]
    fn links_in_code_are_none() {
        let targets = [(9, "other.md#there"), (9, "it.png"), (34, "https://example.org"), (35, "small.svg")];
        assert_eq!(links(PAGE), targets.map(|(line, target)| (line, target.to_owned())));
        assert_eq!(links("`[a](b)` ` [c](d)"), [(1, "d".to_owned())]);
    }

    #[test]
    fn anchors_are_lower_case_and_differ() {
        assert_eq!(anchors(PAGE), ["title", "in-c", "in-c-twice", "in-c-1"]);
        assert_eq!(anchors("## `L_d`: what it is"), ["l_d-what-it-is"]);
    }
}
