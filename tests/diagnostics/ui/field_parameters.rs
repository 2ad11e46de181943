use dalembert::differentiable;

#[differentiable]
fn nothing() -> f64 {
    1.0
}

#[differentiable]
fn number(q: f64) -> f64 {
    q
}

#[differentiable]
fn reference(q: [f64; 1], k: &f64) -> f64 {
    q[0] * k
}

fn main() {
    let _ = (nothing(), number(1.0), reference([1.0], &1.0));
}
