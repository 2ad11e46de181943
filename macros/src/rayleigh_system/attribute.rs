//! The options of the attribute: `rule = midpoint`, `rule = [midpoint, trapezoidal]`.

use proc_macro2::TokenStream;
use syn::parse::{Parse, ParseStream, Parser};
use syn::punctuated::Punctuated;
use syn::{Ident, Token, bracketed, token};

use super::diagnostics::{Mistake, Report};
use super::model::Rule;

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

/// The rules listed, midpoint unless said.
pub fn rules(attribute: TokenStream, report: &mut Report) -> Vec<Rule> {
    if attribute.is_empty() {
        return vec![Rule::Midpoint];
    }
    let settings = match Punctuated::<Setting, Token![,]>::parse_terminated.parse2(attribute) {
        Ok(settings) => settings,
        Err(error) => {
            report.at_span(error.span(), Mistake::UnknownOption);
            return vec![Rule::Midpoint];
        }
    };
    let mut rules = Vec::new();
    for setting in settings {
        if setting.name != "rule" {
            report.at(&setting.name, Mistake::UnknownOption);
            continue;
        }
        if setting.values.is_empty() {
            report.at(&setting.name, Mistake::NoRule);
        }
        for value in setting.values {
            let rule = match value.to_string().as_str() {
                "midpoint" => Rule::Midpoint,
                "trapezoidal" => Rule::Trapezoidal,
                other => {
                    report.at(&value, Mistake::UnknownRule(other.to_owned()));
                    continue;
                }
            };
            if rules.contains(&rule) {
                report.at(&value, Mistake::RepeatedRule(value.to_string()));
            } else {
                rules.push(rule);
            }
        }
    }
    rules
}
