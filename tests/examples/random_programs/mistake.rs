//! The classes of mistakes that were once made, told from the smallest program that shows one.

/// What the text of a smallest program shows.
pub fn of(text: &str) -> &'static str {
    let body = text.split_once("impl System").map_or(text, |(_, body)| body);
    let holds = |words: &[&str]| words.iter().any(|word| body.contains(word));
    if text.contains(": cfg:") {
        "`#[cfg]` inside the block is ignored"
    } else if holds(&[".by_ref()"]) {
        "`by_ref` does not advance its iterator"
    } else if holds(&["_f32 as", "f32"]) && holds(&["as f64"]) {
        "an `f32` is widened as if it had been an f64"
    } else if holds(&["saturating_"]) {
        "`saturating_sub` stops at 0"
    } else if holds(&["&&", "||"]) && holds(&["+=", "-="]) {
        "what stands right of `&&` and `||` always happens"
    } else if holds(&["] += ", "] -= "]) && holds(&["[{"]) {
        "the index of a compound assignment runs twice"
    } else if holds(&["match ", "if let"]) && holds(&["SIZE_"]) {
        "a constant as a pattern matches everything"
    } else if holds(&[
        "as i8", "as i16", "as i32", "as i64", "as u8", "as u16", "as u32", "as u64", "as usize", "as isize",
        "as u128", "as i128",
    ]) {
        "casts between integers do not wrap"
    } else {
        "another"
    }
}
