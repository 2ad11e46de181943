use dalembert::{Midpoint};

dalembert_c::parameters! {
    /// A cart.
    pub struct Cart {
        /// Mass.
        pub m: f64,
    }
}

dalembert_c::c_api! { cart: Cart, rule: Midpoint }

fn main() {}
