//! Random programs over the language of `#[rayleigh_system]`: refused with a message, or computed as rustc
//! does.
//!
//! ```sh
//! cargo study random_programs -- <count> <seed>             # graphs evaluated
//! cargo study random_programs -- <count> <seed> compiled    # built by rustc
//! cargo study random_programs -- <count> <seed> written     # as people write them, built by rustc
//! cargo study random_programs -- mutations                  # mistakes put back
//! cargo study random_programs -- page                       # docs/evidence/random-programs.md
//! ```
//!
//! `compiled` may be followed by an engine: `expanded` unless said, `auto`, `num_dual`, `fused` for sums
//! rounded with their products, `portable` for the elementary functions of the runtime, `renamed` for
//! programs under the names of generated code, `one_word` for one such name, or `lanes`, `midpoint_lanes` and
//! `gauss_lanes`: several members at once, from the seed 1000000 on every other program with fused sums.
//! `written` may be followed by one of the first five, `midpoint_lanes` or `gauss_lanes`. `show <seed>`
//! prints a program, with an engine under its names, `shrink <seed>` the smallest part of it that fails.

mod batch;
mod beside;
mod class;
mod computed;
mod engine;
mod expansion;
mod expected;
mod generate;
mod interpret;
mod lowered;
mod members;
mod mistake;
mod mutation;
mod number;
mod page;
mod point;
mod print;
mod random;
mod rebuilt;
mod renamed;
mod run;
mod shrink;
mod syntax;
mod tally;
mod trial;
mod types;
mod verdict;
mod visit;
mod written;

#[allow(dead_code, reason = "the macro's stages, of which some are for the macro alone")]
#[path = "../../../macros/src"]
mod macros {
    pub mod rayleigh_system;
}
use macros::rayleigh_system;

use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let number = |word: &str| word.parse::<u64>().ok();
    // Panics of the macro are results here.
    std::panic::set_hook(Box::new(|_| {}));
    let failures = match words[..] {
        ["show", seed] => {
            let program = generate::program(number(seed).unwrap_or(1));
            println!("{}", print::formatted(&program, "expanded"));
            println!("// {:?}", trial::by_graph(&program));
            Ok(0)
        }
        ["shrink", seed] => {
            let program = generate::program(number(seed).unwrap_or(1));
            println!("{}", run::smallest(&program));
            Ok(0)
        }
        ["mistakes", count, seed] => {
            run::mistakes(number(count).unwrap_or(300), number(seed).unwrap_or(1));
            Ok(0)
        }
        ["until", count, seed] => {
            run::until(number(count).unwrap_or(300), number(seed).unwrap_or(1));
            Ok(0)
        }
        ["mutations"] => mutation::try_all(),
        ["page"] => page::write(),
        ["with", macros] => rebuilt::study(std::path::Path::new(macros), &[]).map(|program| {
            println!("{}", program.display());
            0
        }),
        ["show", seed, "written"] => {
            println!("{}", written::program(number(seed).unwrap_or(1)).annotated("expanded"));
            Ok(0)
        }
        ["show", seed, engine] => {
            let program = generate::program(number(seed).unwrap_or(1));
            let text = print::formatted(&program, engine);
            println!("{}", renamed::by(engine).map_or(text.clone(), |rename| rename(&text, program.seed)));
            Ok(0)
        }
        [count, seed, "written"] => {
            written::run::compiled(number(count).unwrap_or(100), number(seed).unwrap_or(1), "expanded")
        }
        [count, seed, "written", engine] => {
            written::run::compiled(number(count).unwrap_or(100), number(seed).unwrap_or(1), engine)
        }
        [count, seed] if number(count).is_some() => mutation::are_current()
            .and_then(|()| run::by_graph(number(count).unwrap_or(300), number(seed).unwrap_or(1))),
        [count, seed, "compiled"] => {
            run::compiled(number(count).unwrap_or(300), number(seed).unwrap_or(1), "expanded")
        }
        [count, seed, "compiled", engine] => {
            run::compiled(number(count).unwrap_or(300), number(seed).unwrap_or(1), engine)
        }
        _ => Err("write `<count> <seed>`, and `compiled` to have them built by rustc".to_owned()),
    };
    match failures {
        Ok(0) => ExitCode::SUCCESS,
        Ok(failures) => {
            eprintln!("{failures} programs fail");
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
