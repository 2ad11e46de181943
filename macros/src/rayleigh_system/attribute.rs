//! The options of the attribute: `rule = midpoint`, `rule = [midpoint, trapezoidal]`, `derivatives =
//! expanded`, `parameters = [m, c[0]]`, `step_derivatives = second`, `lanes = [explicit,
//! gauss]`, `multiply_add = fused`, `crate = mechanics`.

use proc_macro2::{TokenStream, TokenTree};
use syn::ext::IdentExt;
use syn::parse::{Parse, ParseStream};
use syn::punctuated::Punctuated;
use syn::{Expr, Ident, Path, Token, bracketed, token};

use super::diagnostics::{Mistake, Report};
use super::model::{Engine, Lanes, Runtime};
use super::rules::{GAUSS, Rule, Rules};

/// One option, `name = value` or `name = [value, …]`.
struct Setting {
    name: Ident,
    values: Values,
}

/// Words, fields of the system, or a path.
enum Values {
    Words(Vec<Ident>),
    Fields(Vec<Expr>),
    Path(Path),
}

impl Parse for Setting {
    fn parse(input: ParseStream) -> syn::Result<Self> {
        let name = input.call(Ident::parse_any)?;
        if !input.peek(Token![=]) {
            return Err(syn::Error::new(name.span(), Mistake::UnknownOption));
        }
        input.parse::<Token![=]>()?;
        let values = match name.to_string().as_str() {
            "parameters" => Values::Fields(list(input)?),
            "crate" => Values::Path(input.parse()?),
            _ => Values::Words(list(input)?),
        };
        Ok(Self { name, values })
    }
}

/// One value, or several in brackets.
fn list<T: Parse>(input: ParseStream) -> syn::Result<Vec<T>> {
    if !input.peek(token::Bracket) {
        return Ok(vec![input.parse()?]);
    }
    let list;
    bracketed!(list in input);
    Ok(Punctuated::<T, Token![,]>::parse_terminated(&list)?.into_iter().collect())
}

/// The options of the attribute.
#[derive(Default)]
pub struct Options {
    /// Midpoint unless said.
    pub rules: Rules,
    /// Whichever can, unless said.
    pub engine: Engine,
    /// Fields that the step is differentiated by.
    pub parameters: Vec<Expr>,
    /// Whether the step is differentiated twice.
    pub second: bool,
    /// Which steps of several members at once are asked for.
    pub lanes: Lanes,
    /// Whether a product and the sum that it stands in are rounded once, by its word.
    pub fused: Option<Ident>,
    /// The runtime, where the user's crate has another name for it.
    pub runtime: Option<Path>,
}

/// The options said, and defaults for the others.
pub fn options(attribute: TokenStream, runtime: Runtime, report: &mut Report) -> Options {
    let mut options = Options::default();
    let settings = settings(attribute, report);
    let mut said: Vec<Ident> = Vec::new();
    for setting in settings {
        let Setting { name, values } = setting;
        if said.contains(&name) {
            report.at(&name, Mistake::RepeatedOption(name.to_string()));
            continue;
        }
        said.push(name.clone());
        match values {
            Values::Fields(fields) => {
                if fields.is_empty() {
                    report.at(&name, Mistake::NoParameters);
                }
                options.parameters = fields;
            }
            Values::Path(path) => options.runtime = Some(path),
            Values::Words(words) if name == "rule" => {
                rules(&name, words, &mut options.rules, report);
            }
            Values::Words(words) if name == "derivatives" => {
                engine(&name, &words, runtime, &mut options.engine, report);
            }
            Values::Words(words) if name == "step_derivatives" => {
                order(&name, &words, &mut options.second, report);
            }
            Values::Words(words) if name == "lanes" => lanes(&name, words, &mut options.lanes, report),
            Values::Words(words) if name == "multiply_add" => {
                multiply_add(&name, words, runtime, &mut options.fused, report);
            }
            Values::Words(_) => report.at(&name, Mistake::UnknownOption),
        }
    }
    if options.engine == Engine::NumDual
        && let Some(parameter) = options.parameters.first()
    {
        report.at(parameter, Mistake::ParametersByNumDual);
    }
    if options.engine == Engine::NumDual
        && let Some(word) = &options.fused
    {
        report.at(word, Mistake::FusedByNumDual);
    }
    if !said.iter().any(|name| name == "rule") {
        options.rules.of_displacement.push(Rule::Midpoint);
    }
    options
}

/// The settings between commas. One that is none hides none of the others, nor what is wrong with the item.
fn settings(attribute: TokenStream, report: &mut Report) -> Vec<Setting> {
    let tokens: Vec<TokenTree> = attribute.into_iter().collect();
    let is_comma = |token: &TokenTree| matches!(token, TokenTree::Punct(punct) if punct.as_char() == ',');
    let mut settings = Vec::new();
    for part in tokens.split_inclusive(is_comma) {
        let (comma, words) = match part.split_last() {
            Some((last, words)) if is_comma(last) => (Some(last), words),
            _ => (None, part),
        };
        match syn::parse2(words.iter().cloned().collect()) {
            Ok(setting) => settings.push(setting),
            Err(error) => {
                let span = comma.filter(|_| words.is_empty()).map_or_else(|| error.span(), TokenTree::span);
                report.at_span(span, Mistake::UnknownOption);
            }
        }
    }
    settings
}

/// The one option of a field, `crate = mechanics`.
pub fn of_field(attribute: TokenStream, report: &mut Report) -> Option<Path> {
    if attribute.is_empty() {
        return None;
    }
    match syn::parse2(attribute.clone()) {
        Ok(Setting { values: Values::Path(path), .. }) => Some(path),
        _ => {
            report.at(&attribute, Mistake::FieldOption);
            None
        }
    }
}

/// `step_derivatives = second`
fn order(name: &Ident, values: &[Ident], second: &mut bool, report: &mut Report) {
    match values {
        [value] if value == "first" => *second = false,
        [value] if value == "second" => *second = true,
        [value] => report.at(value, Mistake::UnknownOrder),
        _ => report.at(name, Mistake::UnknownOrder),
    }
}

/// `multiply_add = fused`
fn multiply_add(
    name: &Ident,
    words: Vec<Ident>,
    runtime: Runtime,
    fused: &mut Option<Ident>,
    report: &mut Report,
) {
    match <[Ident; 1]>::try_from(words) {
        Ok([word]) if word == "fused" => {
            if runtime.is_portable {
                report.at(&word, Mistake::FusedByLibm);
            }
            *fused = Some(word);
        }
        Ok([word]) => report.at(&word, Mistake::UnknownMultiplyAdd),
        Err(_) => report.at(name, Mistake::UnknownMultiplyAdd),
    }
}

/// `lanes = [explicit, midpoint, gauss]`
fn lanes(name: &Ident, words: Vec<Ident>, lanes: &mut Lanes, report: &mut Report) {
    if words.is_empty() {
        report.at(name, Mistake::UnknownLanes);
    }
    for word in words {
        let option = match word.to_string().as_str() {
            "explicit" => &mut lanes.explicit,
            "midpoint" => &mut lanes.midpoint,
            GAUSS => &mut lanes.gauss,
            _ => {
                report.at(&word, Mistake::UnknownLanes);
                continue;
            }
        };
        if option.is_some() {
            report.at(&word, Mistake::RepeatedLanes(word.to_string()));
        }
        *option = Some(word);
    }
}

/// `derivatives = expanded`
fn engine(name: &Ident, values: &[Ident], runtime: Runtime, engine: &mut Engine, report: &mut Report) {
    let [value] = values else {
        report.at(name, Mistake::UnknownEngine(String::new()));
        return;
    };
    *engine = match value.to_string().as_str() {
        "auto" => Engine::Auto,
        "expanded" => Engine::Expanded,
        "num_dual" => {
            if !runtime.has_std {
                report.at(value, Mistake::NumDualWithoutStd);
            }
            Engine::NumDual
        }
        other => {
            report.at(value, Mistake::UnknownEngine(other.to_owned()));
            return;
        }
    };
}

/// `rule = [midpoint, trapezoidal]`
fn rules(name: &Ident, words: Vec<Ident>, rules: &mut Rules, report: &mut Report) {
    if words.is_empty() {
        report.at(name, Mistake::NoRule);
    }
    for word in words {
        let is_known = if word == GAUSS {
            rules.others.push(word.clone());
            std::mem::replace(&mut rules.gauss, true)
        } else {
            let Some(rule) = Rule::named(&word.to_string()) else {
                report.at(&word, Mistake::UnknownRule(word.to_string()));
                continue;
            };
            if rule.joint().is_some() {
                rules.joint.push((word.clone(), rule));
            }
            if rule == Rule::Proximal {
                rules.proximal = Some(word.clone());
            } else {
                rules.others.push(word.clone());
            }
            let is_known = rules.of_displacement.contains(&rule);
            if !is_known {
                rules.of_displacement.push(rule);
            }
            is_known
        };
        if is_known {
            report.at(&word, Mistake::RepeatedRule(word.to_string()));
        }
    }
}
