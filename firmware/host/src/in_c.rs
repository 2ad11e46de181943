//! What a step costs through the functions of C, beside the same step in Rust.

/// Most instructions of a step in C, in percent of those in Rust; at opt-level s the step is inlined less in
/// C.
fn most(level: &str) -> u32 {
    if level == "3" { 103 } else { 110 }
}

/// What is wrong with the `mean` of a step in C where it takes `in_rust` in Rust; nothing if it holds.
pub fn mistake(level: &str, name: &str, mean: Option<u32>, in_rust: Option<u32>) -> Option<String> {
    let (Some(mean), Some(in_rust)) = (mean, in_rust) else {
        return Some(format!("{name} in C: no count was reported, of it or of Rust"));
    };
    let most = most(level);
    (100 * mean > most * in_rust)
        .then(|| format!("{name} in C: {mean} instructions a step, {in_rust} in Rust: above {most} %"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_in_c_may_cost_little_more() {
        assert_eq!(mistake("3", "cart_pole", Some(1030), Some(1000)), None);
        assert!(mistake("3", "cart_pole", Some(1031), Some(1000)).is_some_and(|text| text.contains("1031")));
        assert!(mistake("s", "cart_pole", Some(1101), Some(1000)).is_some());
        assert!(mistake("3", "cart_pole", Some(1000), None).is_some());
    }
}
