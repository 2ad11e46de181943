//! The source of a program: all items, and the block as it is or within `macro_rules`.

use super::draft::Draft;
use super::functions::Seen;
use super::manner::Manner;
use super::scene::Scene;
use super::{ATTRIBUTE, Written};

/// The program of a seed.
pub fn program(seed: u64) -> Written {
    let mut draft = Draft::new(seed);
    let scene = *draft.random.choice(&Scene::ALL);
    draft.n = scene.coordinates();
    let mut seen = Seen {
        rayleigh: draft.random.chance(50),
        rayleigh_of_both: draft.random.chance(40),
        ..Seen::default()
    };
    seen.input = draft.may(Manner::Inputs, 100);
    seen.force = seen.input || draft.random.chance(30);
    if draft.may(Manner::Times, 100) {
        draft.take("t");
        seen.timed = [true, seen.rayleigh && draft.random.chance(50), seen.force && draft.random.chance(50)];
    }
    let mut functions = vec![draft.lagrangian(scene, &seen)];
    if seen.rayleigh {
        functions.push(draft.rayleigh(&seen));
    }
    if seen.force {
        functions.push(draft.force(&seen));
    }
    if draft.may(Manner::Imports, 60) {
        let name = draft.item(&["N", "COUNT", "S"]);
        draft.items.push(format!("pub const {name}: usize = {};", draft.n));
        let array = |n: &str| format!("[{}; {n}]", draft.scalar);
        let looped = |n: &str| format!("for i in 0..{n} {{");
        let n = draft.n.to_string();
        for function in &mut functions {
            *function = function.replace(&array(&n), &array(&name)).replace(&looped(&n), &looped(&name));
        }
    }
    let place = draft.random.below(functions.len() + 1);
    let helpers = std::mem::take(&mut draft.block);
    functions.splice(place..place, helpers);
    let block = block(&mut draft, &functions.join("\n"));
    let text = format!("{}\n{block}", surroundings(&draft));
    Written { seed, text, single: draft.scalar == "f32", n: draft.n, seen, manners: draft.used }
}

/// Types, constants, and the constructor of the system.
fn surroundings(draft: &Draft) -> String {
    let mut text = draft.items.join("\n");
    let mut fields = draft.fields.clone();
    for (ty, members) in &draft.parts {
        let declared: String =
            members.iter().map(|(name, ty, _)| format!("    pub {name}: {ty},\n")).collect();
        let values: Vec<String> = members.iter().map(|(name, _, value)| format!("{name}: {value}")).collect();
        text += &format!("\n#[derive(Clone, Copy)]\npub struct {ty} {{\n{declared}}}");
        fields.push((ty.to_lowercase(), ty.clone(), format!("{ty} {{ {} }}", values.join(", "))));
    }
    let declared: String = fields.iter().map(|(name, ty, _)| format!("    pub {name}: {ty},\n")).collect();
    let values: String =
        fields.iter().map(|(name, _, value)| format!("        {name}: {value},\n")).collect();
    text + &format!(
        "\npub struct System {{\n{declared}}}\npub fn system() -> System {{\n    System {{\n{values}    }}\n}}"
    )
}

/// The annotated block.
fn block(draft: &mut Draft, functions: &str) -> String {
    let is_within = !draft.fragments.is_empty() || !draft.callers.is_empty();
    if !is_within && !draft.may(Manner::MacroAround, 100) {
        return format!("{ATTRIBUTE}\nimpl System {{\n{functions}\n}}\n");
    }
    if !is_within && draft.random.chance(40) {
        return format!(
            "macro_rules! annotated {{\n    ($name:ident: $($functions:tt)*) => {{\n{ATTRIBUTE}\nimpl $name {{ $($functions)* }}\n    }};\n}}\n\
             annotated! {{ System:\n{functions}\n}}\n"
        );
    }
    let mut parameters = vec!["$name:ident".to_owned()];
    let mut given = vec!["System".to_owned()];
    let mut functions = functions.to_owned();
    if draft.random.chance(40) {
        parameters.push("$n:literal".to_owned());
        given.push(draft.n.to_string());
        let array = |n: &str| format!("[{}; {n}], v: [", draft.scalar);
        functions = functions.replace(&array(&draft.n.to_string()), &array("$n"));
    }
    if draft.random.chance(30) {
        parameters.push("$number:ty".to_owned());
        given.push(draft.scalar.to_owned());
        functions = functions.replace(&format!("q: [{};", draft.scalar), "q: [$number;");
    }
    for (index, fragment) in draft.fragments.iter().enumerate() {
        parameters.push(format!("$e{index}:expr"));
        given.push(fragment.clone());
    }
    for (local, expression) in &draft.callers {
        parameters.extend(["$k:ident".to_owned(), "$f:expr".to_owned()]);
        given.extend([local.clone(), expression.clone()]);
    }
    draft.used.insert(Manner::MacroAround);
    format!(
        "macro_rules! annotated {{\n    ({}) => {{\n{ATTRIBUTE}\nimpl $name {{\n{functions}\n}}\n    }};\n}}\nannotated!({});\n",
        parameters.join(", "),
        given.join(", ")
    )
}
