//! Engines of the study, as the attribute and the runtime know them.

/// The options of the attribute that an engine of the study asks for.
pub fn options(engine: &str) -> String {
    let derivatives = match engine {
        "portable" | "renamed" | "one_word" => "expanded",
        "fused" => "expanded, multiply_add = fused",
        engine => engine,
    };
    format!("derivatives = {derivatives}")
}

/// The features of the runtime that an engine asks for.
pub fn features(engine: &str) -> &'static str {
    if engine == "portable" { "\"std\", \"libm\"" } else { "\"std\"" }
}
