use dalembert::differentiable;

#[differentiable]
fn lengths(q: [f64; 2]) -> [f64; 3] {
    [q[0], q[1], 0.0]
}

#[differentiable]
fn pair(q: [f64; 2]) -> (f64, f64) {
    (q[0], q[1])
}

fn main() {
    let _ = (lengths([0.0; 2]), pair([0.0; 2]));
}
