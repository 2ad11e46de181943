//! Packs the unit, of FMI 3.0 and of FMI 2.0: `cargo run --release` writes cart_pole.fmu and
//! cart_pole_fmi2.fmu.

fn main() -> std::io::Result<()> {
    cart_pole_unit::UNIT.pack("cart_pole.fmu")?;
    cart_pole_unit::UNIT.pack_fmi2("cart_pole_fmi2.fmu")
}
