dalembert_c::parameters! {
    /// A cart with a switch.
    pub struct Cart {
        /// Mass.
        pub m: f64,
        /// Whether the brake is on.
        pub brake: bool,
    }
}

fn main() {}
