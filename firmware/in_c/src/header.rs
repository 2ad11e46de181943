//! Prints the header of one of the systems that C steps: `firmware-header cart_pole_f32`.

use std::process::ExitCode;

#[path = "lib.rs"]
mod systems;

fn main() -> ExitCode {
    let headers = [systems::single::cart_pole_f32::HEADER, systems::double::cart_pole_f64::HEADER];
    let asked = std::env::args().nth(1);
    let Some(header) = headers.iter().find(|header| Some(header.prefix) == asked.as_deref()) else {
        eprintln!("firmware-header cart_pole_f32, or cart_pole_f64");
        return ExitCode::FAILURE;
    };
    print!("{header}");
    ExitCode::SUCCESS
}
