//! How the page's script finds its way in the module: what the headers say to C.

use crate::model::{
    double_pendulum_gauss, double_pendulum_midpoint, double_pendulum_reference, double_pendulum_trapezoidal,
    ring_gauss, ring_midpoint, ring_reference, ring_trapezoidal,
};
use dalembert_c::Header;

const HEADERS: [Header; 8] = [
    ring_midpoint::HEADER,
    ring_trapezoidal::HEADER,
    ring_gauss::HEADER,
    ring_reference::HEADER,
    double_pendulum_midpoint::HEADER,
    double_pendulum_trapezoidal::HEADER,
    double_pendulum_gauss::HEADER,
    double_pendulum_reference::HEADER,
];

pub fn print() {
    println!("// Written by `cargo run --release interface`: change the Rust source, and write it again.");
    println!(
        "// Of each run: bytes of its memory, its layout, bytes of its parameters and where each of them begins."
    );
    println!("export const interfaces = {{");
    for Header { prefix, memory_size, layout, parameters_size, fields, .. } in HEADERS {
        let offsets: Vec<_> =
            fields.iter().map(|field| format!("{}: {}", field.name, field.offset)).collect();
        println!("    {prefix}: {{");
        println!("        memory: {},", memory_size());
        println!("        layout: {layout:#018x}n,");
        println!("        parameters: {{ size: {parameters_size}, offsets: {{ {} }} }},", offsets.join(", "));
        println!("    }},");
    }
    println!("}};");
}
