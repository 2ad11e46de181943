use dalembert::differentiable;

use dalembert::VectorField;
use dalembert::nalgebra::vector;

#[differentiable]
fn rotation(q: [f64; 2], k: f64) -> [f64; 2] {
    let wrapped = q[0] % 6.28;
    [-speed(q[1]), k * q[0].floor() + wrapped]
}

fn speed(x: f64) -> f64 {
    x * x
}

fn main() {
    let _ = Rotation { k: speed(1.0) }.vector(&vector![0.0, 0.0]);
}
