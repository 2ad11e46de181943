//! Fields are differentiated by num-dual, which needs std.

use dalembert_macros::differentiable_core as differentiable;

#[differentiable]
fn rotation(q: [f64; 2]) -> [f64; 2] {
    [-q[1], q[0]]
}

fn main() {}
