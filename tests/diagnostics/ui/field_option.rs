use dalembert::differentiable;

#[differentiable(rule = midpoint)]
fn rotation(q: [f64; 2]) -> [f64; 2] {
    [-q[1], q[0]]
}

fn main() {
    let _ = rotation([0.0; 2]);
}
