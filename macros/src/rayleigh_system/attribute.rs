//! The options of the attribute: `rule = midpoint`, `rule = [midpoint, trapezoidal]`, `derivatives = expanded`.

use proc_macro2::TokenStream;
use syn::parse::{Parse, ParseStream, Parser};
use syn::punctuated::Punctuated;
use syn::{Ident, Token, bracketed, token};

use super::Runtime;
use super::diagnostics::{Mistake, Report};
use super::model::{Engine, Rule, Rules};

/// One option, `name = value` or `name = [value, …]`.
struct Setting {
    name: Ident,
    values: Vec<Ident>,
}

impl Parse for Setting {
    fn parse(input: ParseStream) -> syn::Result<Self> {
        let name: Ident = input.parse()?;
        if !input.peek(Token![=]) {
            return Err(syn::Error::new(name.span(), Mistake::UnknownOption));
        }
        input.parse::<Token![=]>()?;
        let values = if input.peek(token::Bracket) {
            let list;
            bracketed!(list in input);
            Punctuated::<Ident, Token![,]>::parse_terminated(&list)?.into_iter().collect()
        } else {
            vec![input.parse()?]
        };
        Ok(Self { name, values })
    }
}

/// What the attribute asks for.
pub struct Options {
    /// Midpoint unless said.
    pub rules: Rules,
    /// Those of them that take L and R together, where they stand.
    pub joint: Vec<(Ident, Rule)>,
    /// Whichever can, unless said.
    pub engine: Engine,
}

/// The options said, and defaults for the others.
pub fn options(attribute: TokenStream, runtime: Runtime, report: &mut Report) -> Options {
    let mut options = Options { rules: Rules::default(), joint: Vec::new(), engine: Engine::Auto };
    let settings = match Punctuated::<Setting, Token![,]>::parse_terminated.parse2(attribute) {
        Ok(settings) => settings,
        Err(error) => {
            report.at_span(error.span(), Mistake::UnknownOption);
            return options;
        }
    };
    let mut says_rule = false;
    for setting in settings {
        if setting.name == "rule" {
            says_rule = true;
            rules(setting, &mut options, report);
        } else if setting.name == "derivatives" {
            engine(setting, runtime, &mut options.engine, report);
        } else {
            report.at(&setting.name, Mistake::UnknownOption);
        }
    }
    if !says_rule {
        options.rules.of_displacement.push(Rule::Midpoint);
    }
    options
}

/// `derivatives = expanded`
fn engine(setting: Setting, runtime: Runtime, engine: &mut Engine, report: &mut Report) {
    let [value] = &setting.values[..] else {
        report.at(&setting.name, Mistake::UnknownEngine(String::new()));
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
fn rules(setting: Setting, options: &mut Options, report: &mut Report) {
    if setting.values.is_empty() {
        report.at(&setting.name, Mistake::NoRule);
    }
    for value in setting.values {
        let rule = match value.to_string().as_str() {
            "midpoint" => Rule::Midpoint,
            "trapezoidal" => Rule::Trapezoidal,
            "gauss" => {
                if options.rules.gauss {
                    report.at(&value, Mistake::RepeatedRule(value.to_string()));
                }
                options.rules.gauss = true;
                continue;
            }
            "fitted" => Rule::Fitted,
            "fitted_trapezoidal" => Rule::FittedTrapezoidal,
            "one_sided" => Rule::OneSided,
            other => {
                report.at(&value, Mistake::UnknownRule(other.to_owned()));
                continue;
            }
        };
        if rule.is_joint() {
            options.joint.push((value.clone(), rule));
        }
        let rules = &mut options.rules.of_displacement;
        if rules.contains(&rule) {
            report.at(&value, Mistake::RepeatedRule(value.to_string()));
        } else {
            rules.push(rule);
        }
    }
}
