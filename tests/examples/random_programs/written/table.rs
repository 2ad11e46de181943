//! Tables of numbers with straight pieces between them, and where arrays are kept.

use super::draft::Draft;
use super::manner::Manner;

impl Draft {
    /// An array of numbers: a constant of the module or of the block, a field or a local.
    pub fn array(&mut self, entries: &str, length: usize, lines: &mut Vec<String>) -> String {
        let ty = format!("[{}; {length}]", self.scalar);
        match self.random.below(8) {
            0..=3 => {
                let name = self.constant();
                let kind = if self.random.chance(80) { "const" } else { "static" };
                self.items.push(format!("pub {kind} {name}: {ty} = {entries};"));
                name
            }
            4 => {
                self.used.insert(Manner::BlockConstants);
                let name = self.constant();
                self.block.push(format!("const {name}: {ty} = {entries};"));
                format!("Self::{name}")
            }
            5 | 6 => format!("self.{}", self.field(&["heights", "table", "d", "t", "entries"], &ty, entries)),
            _ => {
                let name = self.local();
                lines.push(format!("let {name}: {ty} = {entries};"));
                name
            }
        }
    }

    /// Straight pieces between five heights, from −2 to 2.
    pub fn table(&mut self, x: &str, lines: &mut Vec<String>) -> String {
        self.used.insert(Manner::Tables);
        let scalar = self.scalar;
        let heights: Vec<String> = (0..5).map(|_| self.number(0.0, 2.0)).collect();
        let entries = format!("[{}]", heights.join(", "));
        let of_letter = self.may(Manner::LetterTables, 70);
        let (table, along) = if of_letter {
            let name = self.item(&["T", "D"]);
            self.items.push(format!("pub const {name}: [{scalar}; 5] = {entries};"));
            let along = self.small_letter(&name);
            (name, along)
        } else {
            let table = self.array(&entries, 5, lines);
            let along = self.local();
            (table, along)
        };
        let height = self.local();
        lines.push(format!("let mut {height}: {scalar} = 0.0;"));
        let body = match if of_letter { 0 } else { self.random.below(5) } {
            0 => format!(
                "for i in 0..4 {{\n    let {along} = {x} + 2.0 - i as {scalar};\n    if {along} >= 0.0 && {along} < 1.0 {{\n        \
                 {height} = {table}[i] * (1.0 - {along}) + {table}[i + 1] * {along};\n    }}\n}}"
            ),
            1 => format!(
                "for i in 0..{table}.len() - 1 {{\n    let {along} = (({x}) - (i as {scalar} - 2.0)).clamp(0.0, 1.0);\n    \
                 {height} += ({table}[i + 1] - {table}[i]) * {along};\n}}"
            ),
            2 => {
                let pair = self.local();
                format!(
                    "for (i, {pair}) in {table}.windows(2).enumerate() {{\n    let {along} = ({x}) + 2.0 - i as {scalar};\n    \
                     if (0.0..1.0).contains(&{along}) {{\n        {height} = {pair}[0] + {along} * ({pair}[1] - {pair}[0]);\n    }}\n}}"
                )
            }
            3 => {
                // Bells at the places, as a sum over iterators.
                let entry = self.local();
                format!(
                    "let {along} = ({x}) + 2.0;\n{height} += {table}.iter().enumerate().map(|(i, {entry})| {entry} * (-({along} - i as {scalar}).powi(2)).exp()).sum::<{scalar}>();"
                )
            }
            _ => {
                let slope = self.local();
                format!(
                    "let {along} = ({x}).max(-2.0).min(2.0);\nfor i in 0..4_usize {{\n    let {slope} = {table}[i + 1] - {table}[i];\n    \
                     let left = i as {scalar} - 2.0;\n    if {along} > left && {along} <= left + 1.0 {{\n        {height} = {slope}.mul_add({along} - left, {table}[i]);\n    }}\n}}"
                )
            }
        };
        let is_indexed = body.contains(&format!("{table}[")) && !body.contains(".len()");
        let body = if is_indexed { body } else { self.followed(&table, 5, &body, lines) };
        lines.push(body);
        height
    }

    /// The text, mostly of a local with a type in the array's place: the macro sees no other length.
    pub fn followed(&mut self, array: &str, length: usize, text: &str, lines: &mut Vec<String>) -> String {
        if lines.iter().any(|line| line.starts_with(&format!("let {array}:"))) || self.random.chance(10) {
            return text.to_owned();
        }
        let (local, scalar) = (self.local(), self.scalar);
        lines.push(format!("let {local}: [{scalar}; {length}] = {array};"));
        text.replace(array, &local)
    }
}
