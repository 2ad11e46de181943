//! What this machine says of the module: `host interface` prints how the page's script finds its way in it,
//! `host runs` the runs of the page, bit by bit.

mod interface;
#[path = "../lib.rs"]
mod model;
mod runs;

use std::process::ExitCode;

use dalembert::StepError;

fn main() -> Result<ExitCode, StepError> {
    match std::env::args().nth(1).as_deref() {
        Some("interface") => interface::print(),
        Some("runs") => runs::print()?,
        _ => {
            eprintln!("usage: host interface | runs");
            return Ok(ExitCode::FAILURE);
        }
    }
    Ok(ExitCode::SUCCESS)
}
