//! Prints the header that include/ holds: `make` writes it anew when the model has changed.

#[path = "lib.rs"]
mod model;

fn main() {
    print!("{}", model::cart_pole::HEADER);
}
