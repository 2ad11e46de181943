//! Packs the unit: `cargo run --release` writes cart_pole.fmu, or the file that is named.

fn main() -> std::io::Result<()> {
    let file = std::env::args_os().nth(1).unwrap_or_else(|| "cart_pole.fmu".into());
    cart_pole_unit::UNIT.pack(file)
}
