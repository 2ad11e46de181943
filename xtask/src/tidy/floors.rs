//! The runtime's floors: a module uses those below its own, none above. Circles on one floor are found by
//! `circles.rs`.

use std::collections::{BTreeMap, BTreeSet};

use anyhow::{Context, Result, ensure};

use super::kept;
use super::paths::{self, Segments};
use crate::project;

/// A crate: how its files name its root, and its floors from the lowest up. What stands side by side does not
/// use each other.
struct Crate {
    root: &'static [&'static str],
    levels: &'static [&'static [&'static str]],
}

const RUNTIME: Crate = Crate {
    root: &["crate", "dalembert"],
    levels: &[&["numbers"], &["system"], &["step"], &["rules"], &["run", "derivative"], &["theory"]],
};

impl Crate {
    fn level(&self, floor: &str) -> Option<usize> {
        self.levels.iter().position(|floors| floors.contains(&floor))
    }
}

/// A record of who uses whom.
struct Plan {
    /// For each module, as (floor, module): the modules of its floor that it uses, each with the file and
    /// path that say so.
    within: BTreeMap<(String, String), BTreeMap<String, String>>,
    /// For each floor: the floors that it uses, each with the names.
    between: BTreeMap<String, BTreeMap<String, BTreeSet<String>>>,
    refused: Vec<String>,
}

impl Plan {
    /// Of files given as their paths, `floor/module.rs` and below, and their texts.
    fn of(of: &'static Crate, files: &[(String, String)]) -> Result<Self> {
        let mut plan = Self { within: BTreeMap::new(), between: BTreeMap::new(), refused: Vec::new() };
        let module_of =
            |path: &str| -> Segments { path.trim_end_matches(".rs").split('/').map(str::to_owned).collect() };
        // What a floor shows of its modules: name by name, as `pub use state::State` in its file.
        let mut shown = BTreeMap::<(String, String), String>::new();
        for (path, text) in files {
            let [floor] = &module_of(path)[..] else { continue };
            for item in syn::parse_file(text).with_context(|| path.clone())?.items {
                match item {
                    syn::Item::Mod(module) => {
                        let module = module.ident.to_string();
                        plan.within.entry((floor.clone(), module.clone())).or_default();
                        shown.insert((floor.clone(), module.clone()), module);
                    }
                    syn::Item::Use(item) => {
                        for (path, _) in paths::of_use(&item.tree) {
                            // What it shows of floors below is no module of its own.
                            if let [module, .., name] = &path[..]
                                && module != "crate"
                            {
                                shown.insert((floor.clone(), name.clone()), module.clone());
                            }
                        }
                    }
                    _ => {}
                }
            }
        }
        for (path, text) in files {
            let module = module_of(path);
            let from = &module[0];
            let Some(own) = of.level(from) else {
                plan.refused.push(format!("{path}: stands on no floor"));
                continue;
            };
            let file = syn::parse_file(text).with_context(|| path.clone())?;
            let named = paths::of_file(module.clone(), &file);
            for used in named.iter().filter_map(|path| path.in_crate(of.root)) {
                let said = format!("{path}: crate::{}", used.join("::"));
                let to = &used[0];
                match of.level(to) {
                    None => plan.refused.push(format!("{said} goes through the root: name the floor")),
                    Some(_) if to == from => plan.use_within(from, module.get(1), &used, &shown, said),
                    Some(other) if other < own => {
                        let names =
                            plan.between.entry(from.clone()).or_default().entry(to.clone()).or_default();
                        names.extend(used.get(1).cloned());
                    }
                    Some(other) if other == own => {
                        plan.refused.push(format!("{said} goes from {from} to {to} beside it"))
                    }
                    Some(_) => plan.refused.push(format!("{said} climbs from {from} to {to}")),
                }
            }
        }
        Ok(plan)
    }

    fn use_within(
        &mut self,
        floor: &str,
        module: Option<&String>,
        used: &[String],
        shown: &BTreeMap<(String, String), String>,
        said: String,
    ) {
        // The floor's own file, which shows what its modules have.
        let Some(module) = module else { return };
        let Some(name) = used.get(1) else { return };
        match shown.get(&(floor.to_owned(), name.clone())) {
            None => self.refused.push(format!("{said} is nothing that {floor}.rs shows")),
            Some(other) if other == module => {}
            Some(other) => {
                let uses = self.within.entry((floor.to_owned(), module.clone())).or_default();
                uses.entry(other.clone()).or_insert(said);
            }
        }
    }
}

/// Uses that climb, go sideways or go through the root.
pub fn check() -> Result<Vec<String>> {
    let root = project::root().join("runtime/src");
    let mut files = project::sources(&root, &root)?;
    // The root itself shows what the floors have, to users and to generated code, and nalgebra beside them;
    // the guide is documentation alone.
    files.retain(|(path, _)| !["lib.rs", "generated.rs", "guide.rs", "nalgebra.rs"].contains(&path.as_str()));
    kept::of("floors", &files, || of_runtime(&files))
}

fn of_runtime(files: &[(String, String)]) -> Result<Vec<String>> {
    let plan = Plan::of(&RUNTIME, files)?;
    let scalar = plan.between["step"]["numbers"].contains("Scalar");
    let newton = plan.within[&("step".into(), "legendre".into())].contains_key("newton");
    ensure!(scalar && newton, "uses that are there were not seen");
    Ok(plan.refused)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floors_use_what_is_below_them() {
        assert_eq!(check().unwrap(), [""; 0]);
    }

    /// Uses that are refused in a tree of files.
    fn refused(files: &[(&str, &str)]) -> Vec<String> {
        let files: Vec<_> = files.iter().map(|&(path, text)| (path.to_owned(), text.to_owned())).collect();
        Plan::of(&RUNTIME, &files).unwrap().refused
    }

    #[test]
    fn climbs_are_refused() {
        let below = ("numbers.rs", "mod scalar; pub use scalar::Scalar;");
        let above = ("step.rs", "mod error; mod state; pub use error::StepError; pub use state::State;");
        let error = ("step/error.rs", "use crate::numbers::Scalar; pub struct StepError;");
        let state = ("step/state.rs", "use super::StepError; pub struct State;");
        let scalar =
            ("numbers/scalar.rs", "pub trait Scalar {} #[cfg(test)] mod tests { use crate::step::State; }");
        assert_eq!(refused(&[below, above, error, state, scalar]), [""; 0]);

        let climbing = |text| refused(&[below, above, error, state, ("numbers/scalar.rs", text)]);
        let message = "numbers/scalar.rs: crate::step::State climbs from numbers to step";
        assert_eq!(climbing("use crate::{step::State};"), [message]);
        assert_eq!(climbing("fn of(_: crate::step::State) {}"), [message]);
        assert_eq!(climbing("macro_rules! of { () => { $crate::step::State } }"), [message]);
        assert_eq!(climbing("mod inner { use super::super::super::step::State; }"), [message]);

        let through = refused(&[below, above, error, scalar, ("step/state.rs", "use crate::{Scalar};")]);
        let message = "step/state.rs: crate::Scalar goes through the root: name the floor";
        assert_eq!(through, [message]);
        let text = "macro_rules! of { () => { $crate::Scalar } }";
        assert_eq!(refused(&[below, above, error, scalar, ("step/state.rs", text)]), [message]);

        let beside = ("run.rs", "mod trajectory; use crate::derivative::Certificate;");
        assert_eq!(
            refused(&[beside]),
            ["run.rs: crate::derivative::Certificate goes from run to derivative beside it"]
        );
    }
}
