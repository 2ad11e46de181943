use dalembert::differentiable;

struct Rotation;

#[differentiable]
impl Rotation {
    fn vector(&self, q: [f64; 2]) -> [f64; 2] {
        q
    }
}

fn main() {
    let _ = Rotation.vector([0.0; 2]);
}
