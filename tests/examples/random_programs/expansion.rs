//! The macro, called as a function: whether it accepts a program, and with which words it refuses.

use std::panic::{AssertUnwindSafe, catch_unwind};

use super::rayleigh_system::{Runtime, rayleigh_system};

/// What the macro does with a block.
#[derive(Clone, Debug, PartialEq)]
pub enum Reaction {
    Accepted,
    /// With its first message.
    Refused(String),
    Panicked(String),
}

pub fn of(block: &str, options: &str, runtime: Runtime) -> Reaction {
    let expansion = catch_unwind(AssertUnwindSafe(|| {
        let options = options.parse().expect("options are tokens");
        let item = block.parse().expect("programs are tokens");
        rayleigh_system(runtime, options, item).to_string()
    }));
    match expansion {
        Err(panic) => {
            let message = panic.downcast_ref::<String>().cloned();
            let message = message.or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned()));
            Reaction::Panicked(message.unwrap_or_default())
        }
        Ok(text) => match text.split_once("compile_error ! {") {
            Some((_, rest)) => Reaction::Refused(rest.split('"').nth(1).unwrap_or_default().to_owned()),
            None => Reaction::Accepted,
        },
    }
}
