//! The header of the template for microcontrollers is that of its model.

#[path = "../../../examples/firmware-c/src/lib.rs"]
mod template;

#[test]
fn the_template_s_header_is_that_of_its_model() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/firmware-c/include/cart_pole.h");
    let written = template::cart_pole::HEADER.to_string();
    if std::env::var_os("UPDATE_SNAPSHOTS").is_some() {
        std::fs::write(path, &written).expect("a header");
    }
    let committed = std::fs::read_to_string(path).expect("a header");
    assert!(committed == written, "with UPDATE_SNAPSHOTS=1 this test writes it anew");
}
